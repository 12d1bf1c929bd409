/*
 * The list of integrators and their workspace.
 *
 * The theta-method takes the rates at the theta-point, x_th = (1 - theta) x_old
 * + theta x_new: theta = 1/2 is the implicit midpoint rule on the line between
 * the ends of the step (MIDPOINT), theta = 1 implicit Euler (BACKWARD).
 */
#include "base/base.h"
#include "material/scheme/work.h"
#include "material/voigt.h"

#include <strings.h>

/*
 * Explicit integrators: rates at known states, one equilibrium per stage.
 *   EULER  y1 = y0 + dt f(y0)
 *   HEUN   y1 = y0 + dt/2 (f(y0) + f(y0 + dt f(y0)))
 *   RK4    the classical method of order 4
 * The difference of HEUN and EULER is the estimate of the error of HEUN.
 */

/* now = old + sum of factor[i] times rates of stage i, at old->t + dt. */
static status add_stage(const scheme_call *a, double dt, const double *factor) {
  const scheme_work *w = a->w;
  size_t n = (size_t)a->x->ns * a->x->n, na = a->x->alpha_at[a->x->n];
  int settled = 1;
  if (!a->out->settled) return OK;
  sum_scaled(n, a->old->ei, factor[0], w->ei_rate[0], a->now->ei);
  sum_scaled(na, a->old->alpha, factor[0], w->alpha_rate[0], a->now->alpha);
  for (int i = 1; i < STAGES; ++i) {
    if (factor[i] == 0.0) continue;
    sum_scaled(n, a->now->ei, factor[i], w->ei_rate[i], a->now->ei);
    sum_scaled(na, a->now->alpha, factor[i], w->alpha_rate[i], a->now->alpha);
  }
  a->now->t = dt == a->p->dt ? a->p->t : a->old->t + dt;
  PASS(a->b->equilibrium(a->b->ctx, a->now, &settled));
  if (!settled) a->out->settled = 0;
  return OK;
}

/* Rates of a state into stage i; its power counts with the weight "part". A
 * threshold or a power may pass the limit here alone, not at the start. */
static status rates(const scheme_call *a, const flow_state *s, int i,
                    double part) {
  scheme_work *w = a->w;
  double power, rate = 0;
  if (!a->out->settled) return OK;
  if (i > 0 && !flow_is_constant(a->x))
    PASS(flow_fastest(a->x, s, a->p->dt, &rate));
  if (rate > a->p->fastest) {
    a->out->unstable = rate;
    a->out->settled = 0;
    return OK;
  }
  PASS(need(w, &w->ei_rate[i], (size_t)a->x->ns * a->x->n));
  PASS(need(w, &w->alpha_rate[i], a->x->alpha_at[a->x->n]));
  PASS(flow_rates(a->x, s, a->p->dt, w->ei_rate[i], w->alpha_rate[i], &power));
  a->out->dissipated += part * power;
  return OK;
}

static status euler_advance(const scheme_call *a) {
  const double h = a->p->dt;
  PASS(rates(a, a->old, 0, h));
  return add_stage(a, h, (double[STAGES]){h});
}

static status heun_advance(const scheme_call *a) {
  const double h = a->p->dt;
  const size_t n = (size_t)a->x->ns * a->x->n;
  scheme_work *w = a->w;
  PASS(rates(a, a->old, 0, h / 2));
  PASS(add_stage(a, h, (double[STAGES]){h}));
  PASS(rates(a, a->now, 1, h / 2));
  PASS(add_stage(a, h, (double[STAGES]){h / 2, h / 2}));
  if (!a->out->settled) return OK;
  PASS(need(w, &w->e_k, n));
  sum_scaled(n, w->ei_rate[1], -1, w->ei_rate[0], w->e_k);
  a->out->error = h / 2 * flow_norm(a->x, w->e_k);
  return OK;
}

static status rk4_advance(const scheme_call *a) {
  const double h = a->p->dt;
  PASS(rates(a, a->old, 0, h / 6));
  PASS(add_stage(a, h / 2, (double[STAGES]){h / 2}));
  PASS(rates(a, a->now, 1, h / 3));
  PASS(add_stage(a, h / 2, (double[STAGES]){0, h / 2}));
  PASS(rates(a, a->now, 2, h / 3));
  PASS(add_stage(a, h, (double[STAGES]){0, 0, h}));
  PASS(rates(a, a->now, 3, h / 6));
  return add_stage(a, h, (double[STAGES]){h / 6, h / 3, h / 3, h / 6});
}

/*
 * States within a step that has been made (dense output). With the part s of
 * the step, the change D = y_new - y_old and the rates f at both ends,
 *   y(s) = y_old + s D + s (1 - s) ((1 - s) d_old - s d_new),
 *   d_old = dt f_old - D,  d_new = dt f_new - D
 * is the cubic of Hermite, wrong by dt^4: no integrator loses its order. The
 * rates of parts that relax within less than the step do not describe it: d_old
 * and d_new count up to the magnitude of D, so that y(s) of one component is
 * monotone from y_old to y_new; smooth solutions stay below as dt falls but for
 * the step in which a rate turns its sign.
 */

/* Rates of a state, its power. */
static status end_rates(const scheme_call *a, const flow_state *s, int i,
                        double *power) {
  scheme_work *w = a->w;
  PASS(need(w, &w->ei_rate[i], (size_t)a->x->ns * a->x->n));
  PASS(need(w, &w->alpha_rate[i], a->x->alpha_at[a->x->n]));
  return flow_rates(a->x, s, a->p->dt, w->ei_rate[i], w->alpha_rate[i], power);
}

/* d[n] limited by a change of this magnitude. */
static double bounded(double magnitude, double most) {
  return magnitude > most ? most / magnitude : 1.0;
}

/* One end of a step: where values and their rates stand there. */
typedef struct step_end {
  const double *y, *f;
} step_end;

/* Components [n] of one strain, or one number, from place "at" on. */
static void interpolate(int n, size_t at, double dt, double s,
                        const step_end end[2], double *y) {
  const double *old = end[0].y + at;
  double change[6] = {0}, d[2][6] = {{0}}, in[2];
  for (int i = 0; i < n; ++i) change[i] = end[1].y[at + i] - old[i];
  double most = sqrt(voigt_strain_square(n, change));
  for (int k = 0; k < 2; ++k) {
    for (int i = 0; i < n; ++i) d[k][i] = dt * end[k].f[at + i] - change[i];
    in[k] = bounded(sqrt(voigt_strain_square(n, d[k])), most);
  }
  for (int i = 0; i < n; ++i)
    y[at + i] = old[i] + s * change[i] +
                s * (1 - s) * ((1 - s) * in[0] * d[0][i] - s * in[1] * d[1][i]);
}

/* The part of the step at t. */
static double part_at(const scheme_call *a, double t) {
  return (t - a->old->t) / (a->now->t - a->old->t);
}

static status hermite_between(const scheme_call *a, flow_state *mid) {
  const flow *x = a->x;
  const scheme_work *w = a->w;
  const size_t ns = x->ns, n = x->n;
  const double s = part_at(a, mid->t), dt = a->p->dt;
  double power;
  PASS(end_rates(a, a->old, 0, &power));
  PASS(end_rates(a, a->now, 1, &power));
  const step_end ei[2] = {{a->old->ei, w->ei_rate[0]},
                          {a->now->ei, w->ei_rate[1]}};
  const step_end alpha[2] = {{a->old->alpha, w->alpha_rate[0]},
                             {a->now->alpha, w->alpha_rate[1]}};
  for (size_t i = 0; i < ns * n; i += ns)
    interpolate(x->ns, i, dt, s, ei, mid->ei);
  for (size_t i = 0; i < x->alpha_at[n]; ++i)
    interpolate(1, i, dt, s, alpha, mid->alpha);
  return OK;
}

status scheme_dissipated(const scheme_call *a, double t, double *energy) {
  double zero = 0.0, power[2];
  PASS(end_rates(a, a->old, 0, &power[0]));
  PASS(end_rates(a, a->now, 1, &power[1]));
  const step_end lost[2] = {{&zero, &power[0]},
                            {&a->out->dissipated, &power[1]}};
  interpolate(1, 0, a->p->dt, part_at(a, t), lost, energy);
  return OK;
}

status scheme_work_new(scheme_work **out) {
  PASS_NEW(*out, 1);
  return OK;
}

static status theta_advance(const scheme_call *a) {
  if (!flow_is_constant(a->x) || a->p->initial) return newton_advance(a);
  return linear_advance(a, 0);
}

static status exponential_advance(const scheme_call *a) {
  return linear_advance(a, 1);
}

/* The real interval of stability of the classical Runge-Kutta method: the root
 * of 1 - z + z^2/2 - z^3/6 + z^4/24 = 1. */
static const double rk4_limit = 2.78529356340528;

/* clang-format off */
static const scheme euler = {
  .name = "EULER", .reference = "CPR98 3.2",
  .help = "explicit, order 1: one equilibrium a step",
  .order = 1, .limit = 2.0, .advance = euler_advance,
  .between = hermite_between};

static const scheme heun = {
  .name = "HEUN", .reference = "Heun 1900",
  .help = "explicit, order 2, with an estimate of its error: two equilibria",
  .order = 2, .limit = 2.0, .estimates = 1, .advance = heun_advance,
  .between = hermite_between};

static const scheme rk4 = {
  .name = "RK4", .reference = "Kutta 1901",
  .help = "explicit, order 4: four equilibria",
  .order = 4, .limit = rk4_limit, .advance = rk4_advance,
  .between = hermite_between};

static const scheme theta = {
  .name = "THETA", .reference = "Dahlquist 1975, one-leg methods",
  .help = "implicit, rates at (1 - THETA) old + THETA new; order 2 if 0.5",
  .order = 1, .has_theta = 1, .advance = theta_advance,
  .between = hermite_between};

static const scheme midpoint = {
  .name = "MIDPOINT", .reference = "Dahlquist 1975, one-leg methods",
  .help = "THETA with 0.5: order 2, no damping of what is fast",
  .order = 2, .theta = 0.5, .advance = theta_advance,
  .between = hermite_between};

static const scheme backward = {
  .name = "BACKWARD", .reference = "implicit Euler",
  .help = "THETA with 1: order 1, damps all that is fast",
  .order = 1, .theta = 1.0, .advance = theta_advance,
  .between = hermite_between};

static const scheme exponential = {
  .name = "EXPONENTIAL",
  .reference = "Zienkiewicz, Watson, King 1968; Taylor, Pister, Goudreau 1970",
  .help = "exact for linear laws if strains are linear over a step; order 2",
  .order = 2, .linear_only = 1, .theta = 0.5, .advance = exponential_advance,
  .between = exponential_between};
/* clang-format on */

const scheme *const scheme_list[] = {&euler,    &heun,     &rk4,         &theta,
                                     &midpoint, &backward, &exponential, NULL};

const scheme *scheme_find(const char *name) {
  for (int k = 0; scheme_list[k] != NULL; ++k)
    if (strcasecmp(scheme_list[k]->name, name) == 0) return scheme_list[k];
  return NULL;
}

double scheme_limit(const scheme *s, double th) {
  if (s->limit > 0.0) return s->limit;
  if (s->linear_only || th >= 0.5) return HUGE_VAL;
  return 2.0 / (1.0 - 2.0 * th);
}
