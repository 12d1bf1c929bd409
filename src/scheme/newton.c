/*
 * The theta-method for any law, one equilibrium at the end of the step:
 *   y_new = y_old + dt f(x_th),   x_th = (1 - theta) x_old + theta x_new,
 * x = (sigma, e^i, alpha) and the time and temperature likewise. The points
 * follow their strains (point_step.c); the body is solved with their consistent
 * tangents until the stresses of the points are those of the linear law:
 * quadratic convergence; or with D = E, never factored again.
 */
#include "scheme/point_step.h"
#include "scheme/work.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

enum { MOST_TANGENT = 40, MOST_INITIAL = 2000 };

/* All points for now->e: ei, alpha, sigma, the power of the step; w->D[ns*ns*n]
 * unless the iteration is that of initial stresses. */
static status solve_points(const scheme_call *a, point_step *l) {
  status st = OK;
  const flow *x = a->x;
  const size_t ns = (size_t)x->ns;
  a->out->dissipated = 0.0;
  for (int k = 0; k < x->n; ++k) {
    const size_t at = ns * (size_t)k;
    double elastic[6];
    TRY(point_step_begin(x, a->p, k, a->old, a->now, l));
    int rests = point_step_rests(a->p, a->old->sigma + at, l);
    if (!rests) point_step_solve(a->p, a->old->sigma + at, l, &a->out->settled);
    if (!a->out->settled) goto done;
    point_step_place(a->p, a->old->sigma + at, l->y, l);
    a->out->dissipated += a->p->dt * x->weight[k] * law_dissipation(&l->p);
    memcpy(a->now->ei + at, l->y, ns * sizeof *l->y);
    memcpy(a->now->alpha + x->alpha_at[k], l->y + ns,
           (size_t)l->na * sizeof *l->y);
    for (size_t i = 0; i < ns; ++i) elastic[i] = l->e[i] - l->y[i];
    tensor_product(x->ns, l->E, elastic, a->now->sigma + at);
    if (a->p->initial) continue;
    if (rests)
      memcpy(a->w->D + ns * at, l->E, ns * ns * sizeof *l->E);
    else
      TRY(point_step_tangent(a->p, l, a->w->D + ns * at));
  }
done:
  return st;
}

/* Stresses of the linear law at now->e: linear[ns*n]; the scale of their
 * misfit, from them and from the elastic stresses of the strains. */
static status linear_stress(const flow *x, const flow_tangent *law,
                            const flow_state *now, double *linear,
                            double *scale) {
  status st = OK;
  const int ns = x->ns;
  double sum = 0.0;
  for (int k = 0; k < x->n; ++k) {
    const size_t at = (size_t)ns * (size_t)k;
    flow_kind *kind = &x->kind[x->kind_id[k]];
    TRY(flow_heat(kind, now->temperature[k]));
    const double *E = kind->elastic.E;
    const double *D = law->elastic ? E : law->D + (size_t)ns * at;
    double step[6], change[6], whole[6];
    for (size_t i = 0; i < (size_t)ns; ++i)
      step[i] = now->e[at + i] - law->e[at + i];
    tensor_product(ns, D, step, change);
    tensor_product(ns, E, now->e + at, whole);
    add_scaled((size_t)ns, law->sigma + at, 1.0, change, linear + at);
    sum += x->weight[k] * (tensor_dot(ns, whole, whole) +
                           tensor_dot(ns, linear + at, linear + at));
  }
  *scale = sqrt(sum);
done:
  return st;
}

/* Misfit of the stresses and of those of the linear law, over the scale. */
static double misfit(const flow *x, const flow_state *now, const double *linear,
                     double scale) {
  double sum = 0.0;
  for (int k = 0; k < x->n; ++k)
    for (size_t i = 0; i < (size_t)x->ns; ++i) {
      size_t at = (size_t)x->ns * (size_t)k + i;
      double d = now->sigma[at] - linear[at];
      sum += x->weight[k] * d * d;
    }
  return scale > 0.0 ? sqrt(sum) / scale : 0.0;
}

static status need_room(const flow *x, const scheme_step *p, scheme_work *w) {
  status st = OK;
  size_t n = (size_t)x->ns * (size_t)x->n;
  TRY(need(&w->sigma_k, n));
  TRY(need(&w->e_k, n));
  TRY(need(&w->linear, n));
  if (!p->initial) TRY(need(&w->D, n * (size_t)x->ns));
done:
  return st;
}

status newton_advance(const scheme_call *a) {
  status st = OK;
  const flow *x = a->x;
  const scheme_step *p = a->p;
  const size_t bytes = (size_t)x->ns * (size_t)x->n * sizeof(double);
  const int most = p->initial ? MOST_INITIAL : MOST_TANGENT;
  scheme_work *w = a->w;
  scheme_result *out = a->out;
  point_step l = {0};
  TRY(point_step_new(x, &l));
  TRY(need_room(x, p, w));
  a->now->t = p->t;
  TRY(a->b->begin(a->b->ctx, a->now));
  memcpy(a->now->e, a->old->e, bytes);
  flow_tangent law = {
      .elastic = p->initial, .D = w->D, .sigma = w->sigma_k, .e = w->e_k};
  TRY(solve_points(a, &l));
  while (out->settled && out->iterations < most) {
    memcpy(w->sigma_k, a->now->sigma, bytes);
    memcpy(w->e_k, a->now->e, bytes);
    TRY(a->b->linear(a->b->ctx, &law, a->now, &out->settled));
    ++out->iterations;
    if (!out->settled) goto done;
    double scale = 0.0;
    TRY(linear_stress(x, &law, a->now, w->linear, &scale));
    TRY(solve_points(a, &l));
    if (!out->settled || misfit(x, a->now, w->linear, scale) <= p->tol)
      goto done;
  }
  out->settled = 0;
done:
  point_step_free(&l);
  return st;
}
