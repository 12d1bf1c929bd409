/*
 * States within a step that has been made (dense output). With the part s of
 * the step, the change D = y_new - y_old and the rates f of the laws at both
 * ends,
 *   y(s) = y_old + s D + s (1 - s) ((1 - s) d_old - s d_new),
 *   d_old = dt f_old - D,  d_new = dt f_new - D
 * is the cubic of Hermite, wrong by dt^4: no integrator loses its order. The
 * rates of parts that relax within less than the step do not describe it: d_old
 * and d_new count up to the magnitude of D, so that y(s) of one component is
 * monotone from y_old to y_new; smooth solutions stay below as dt falls but for
 * the step in which a rate turns its sign.
 */
#include "material/scheme/work.h"

#include <math.h>

/* Rates of a state, its power. */
static status end_rates(const scheme_call *a, const flow_state *s, int i,
                        double *power) {
  scheme_work *w = a->w;
  PASS(need(&w->ei_rate[i], (size_t)a->x->ns * (size_t)a->x->n));
  PASS(need(&w->alpha_rate[i], a->x->alpha_at[a->x->n]));
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

/* Components [n] of one tensor, or one number, from place "at" on. */
static void interpolate(int n, size_t at, double dt, double s,
                        const step_end end[2], double *y) {
  const double *old = end[0].y + at;
  double change[6], d[2][6], in[2];
  for (int i = 0; i < n; ++i) change[i] = end[1].y[at + (size_t)i] - old[i];
  double most = sqrt(tensor_dot(n, change, change));
  for (int k = 0; k < 2; ++k) {
    for (int i = 0; i < n; ++i)
      d[k][i] = dt * end[k].f[at + (size_t)i] - change[i];
    in[k] = bounded(sqrt(tensor_dot(n, d[k], d[k])), most);
  }
  for (int i = 0; i < n; ++i)
    y[at + (size_t)i] =
        old[i] + s * change[i] +
        s * (1 - s) * ((1 - s) * in[0] * d[0][i] - s * in[1] * d[1][i]);
}

/* The part of the step at t. */
static double part_at(const scheme_call *a, double t) {
  return (t - a->old->t) / (a->now->t - a->old->t);
}

status hermite_between(const scheme_call *a, flow_state *mid) {
  const flow *x = a->x;
  const scheme_work *w = a->w;
  const size_t ns = (size_t)x->ns, n = (size_t)x->n;
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
