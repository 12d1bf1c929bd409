/*
 * Explicit integrators: rates at known states, one equilibrium per stage.
 *   EULER  y1 = y0 + dt f(y0)
 *   HEUN   y1 = y0 + dt/2 (f(y0) + f(y0 + dt f(y0)))
 *   RK4    the classical method of order 4
 * The difference of HEUN and EULER is the estimate of the error of HEUN.
 */
#include "material/scheme/work.h"

/* now = old + sum of factor[i] times the rates of stage i, at old->t + dt, and
 * its equilibrium. */
static status stage(const scheme_call *a, double dt, const double *factor) {
  const scheme_work *w = a->w;
  size_t n = (size_t)a->x->ns * (size_t)a->x->n, na = a->x->alpha_at[a->x->n];
  int settled = 1;
  add_scaled(n, a->old->ei, factor[0], w->ei_rate[0], a->now->ei);
  add_scaled(na, a->old->alpha, factor[0], w->alpha_rate[0], a->now->alpha);
  for (int i = 1; i < STAGES; ++i) {
    if (factor[i] == 0.0) continue;
    add_scaled(n, a->now->ei, factor[i], w->ei_rate[i], a->now->ei);
    add_scaled(na, a->now->alpha, factor[i], w->alpha_rate[i], a->now->alpha);
  }
  a->now->t = dt == a->p->dt ? a->p->t : a->old->t + dt;
  PASS(a->b->equilibrium(a->b->ctx, a->now, &settled));
  if (!settled) a->out->settled = 0;
  return OK;
}

/* Rates of a state into stage i; its power counts with the weight "part". */
static status rates(const scheme_call *a, const flow_state *s, int i,
                    double part) {
  scheme_work *w = a->w;
  double power;
  PASS(need(&w->ei_rate[i], (size_t)a->x->ns * (size_t)a->x->n));
  PASS(need(&w->alpha_rate[i], a->x->alpha_at[a->x->n]));
  PASS(flow_rates(a->x, s, a->p->dt, w->ei_rate[i], w->alpha_rate[i], &power));
  a->out->dissipated += part * power;
  return OK;
}

status euler_advance(const scheme_call *a) {
  const double h = a->p->dt;
  PASS(rates(a, a->old, 0, h));
  PASS(stage(a, h, (double[STAGES]){h}));
  return OK;
}

status heun_advance(const scheme_call *a) {
  const double h = a->p->dt;
  const size_t n = (size_t)a->x->ns * (size_t)a->x->n;
  scheme_work *w = a->w;
  PASS(rates(a, a->old, 0, h / 2));
  PASS(stage(a, h, (double[STAGES]){h}));
  if (!a->out->settled) return OK;
  PASS(rates(a, a->now, 1, h / 2));
  PASS(stage(a, h, (double[STAGES]){h / 2, h / 2}));
  PASS(need(&w->e_k, n));
  add_scaled(n, w->ei_rate[1], -1, w->ei_rate[0], w->e_k);
  a->out->error = h / 2 * flow_norm(a->x, w->e_k);
  return OK;
}

status rk4_advance(const scheme_call *a) {
  const double h = a->p->dt;
  PASS(rates(a, a->old, 0, h / 6));
  PASS(stage(a, h / 2, (double[STAGES]){h / 2}));
  if (!a->out->settled) return OK;
  PASS(rates(a, a->now, 1, h / 3));
  PASS(stage(a, h / 2, (double[STAGES]){0, h / 2}));
  if (!a->out->settled) return OK;
  PASS(rates(a, a->now, 2, h / 3));
  PASS(stage(a, h, (double[STAGES]){0, 0, h}));
  if (!a->out->settled) return OK;
  PASS(rates(a, a->now, 3, h / 6));
  PASS(stage(a, h, (double[STAGES]){h / 6, h / 3, h / 3, h / 6}));
  return OK;
}
