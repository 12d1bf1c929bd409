/*
 * The theta-method for any law, one equilibrium at the end of the step:
 *   y_new = y_old + dt f(x_th),   x_th = (1 - theta) x_old + theta x_new,
 * x = (sigma, e^i, alpha) and the time and temperature likewise. The points
 * follow their strains (point_step.c); the body is solved with their consistent
 * tangents until the stresses of the points are those of the linear law:
 * quadratic convergence; or with D = E, never factored again. Points of linear
 * laws whose coefficients vary have the map of the step instead (linear.c) with
 * those of the theta-point, unless their elasticity varies too.
 */
#include "material/scheme/point_step.h"
#include "material/scheme/work.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

enum { MOST_TANGENT = 40, MOST_INITIAL = 2000 };

/* Workspace of one point. */
typedef struct point_work {
  point_step l;
  linear_map map; /* of a linear law, made when first needed */
  double D[36];   /* [ns*ns] that it leaves, Pa */
} point_work;

static void point_work_free(point_work *r) {
  point_step_free(&r->l);
  linear_map_free(&r->map);
}

static int has_map(const flow *x, int k) {
  const flow_kind *kind = &x->kind[x->kind_id[k]];
  return kind->law->ops->linear && kind->elastic.table == NULL;
}

/* Point k by the map: r->l.y and r->D. */
static status follow_map(const scheme_call *a, int k, point_work *r) {
  const flow *x = a->x;
  const size_t ns = (size_t)x->ns, n = ns + (size_t)x->most_alpha;
  point_step *l = &r->l;
  flow_kind now = x->kind[x->kind_id[k]];
  if (now.varies != 0) {
    now.value = l->value;
    now.speed = l->p.speed;
  }
  PASS(need(&r->map.P, n * n));
  PASS(need(&r->map.Q0, n * ns));
  PASS(need(&r->map.Q1, n * ns));
  PASS(need(&r->map.Q, n * ns));
  PASS(linear_map_make(&now, a->p, 0, &r->map, r->D));
  linear_at(x, &r->map, k, a->old, l->e, l->y);
  return OK;
}

/* Point k for now->e: r->l.y, and into D[ns*ns] unless it is NULL. */
static status follow_point(const scheme_call *a, int k, point_work *r,
                           double *D) {
  const size_t ns = (size_t)a->x->ns, bytes = ns * ns * sizeof *D;
  const double *sigma_old = a->old->sigma + ns * (size_t)k;
  point_step *l = &r->l;
  PASS(point_step_begin(a->x, a->p, k, a->old, a->now, l));
  const int maps = has_map(a->x, k);
  const int rests = !maps && point_step_rests(a->x, a->p, sigma_old, l);
  if (maps)
    PASS(follow_map(a, k, r));
  else if (!rests)
    point_step_solve(a->p, sigma_old, l, &a->out->settled);
  a->out->stuck = a->out->settled ? 0 : k + 1;
  if (!a->out->settled) return OK;
  point_step_place(a->p, sigma_old, l->y, l);
  if (D == NULL) return OK;
  if (maps || rests)
    memcpy(D, maps ? r->D : l->E, bytes);
  else
    PASS(point_step_tangent(a->p, l, D));
  return OK;
}

/* All points for now->e: ei, alpha, sigma, the power of the step; w->D[ns*ns*n]
 * unless the iteration is that of initial stresses. */
static status solve_points(const scheme_call *a, point_work *r) {
  const flow *x = a->x;
  const size_t ns = (size_t)x->ns;
  point_step *l = &r->l;
  a->out->dissipated = 0.0;
  for (int k = 0; k < x->n; ++k) {
    const size_t at = ns * (size_t)k;
    double elastic[6];
    PASS(follow_point(a, k, r, a->p->initial ? NULL : a->w->D + ns * at));
    if (!a->out->settled) return OK;
    a->out->dissipated += a->p->dt * x->weight[k] * law_dissipation(&l->p);
    memcpy(a->now->ei + at, l->y, ns * sizeof *l->y);
    memcpy(a->now->alpha + x->alpha_at[k], l->y + ns,
           (size_t)l->na * sizeof *l->y);
    for (size_t i = 0; i < ns; ++i) elastic[i] = l->e[i] - l->y[i];
    tensor_product(x->ns, l->E, elastic, a->now->sigma + at);
  }
  return OK;
}

/* Stresses of the linear law at now->e: linear[ns*n]; the scale of their
 * misfit, from them and from the elastic stresses of the strains. */
static status linear_stress(const flow *x, const flow_tangent *law,
                            const flow_state *now, double *linear,
                            double *scale) {
  const int ns = x->ns;
  double sum = 0.0;
  for (int k = 0; k < x->n; ++k) {
    const size_t at = (size_t)ns * (size_t)k;
    flow_kind *kind = &x->kind[x->kind_id[k]];
    PASS(flow_heat(kind, now->temperature[k]));
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
  return OK;
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

static status need_workspace(const flow *x, const scheme_step *p,
                             scheme_work *w) {
  size_t n = (size_t)x->ns * (size_t)x->n;
  PASS(need(&w->sigma_k, n));
  PASS(need(&w->e_k, n));
  PASS(need(&w->linear, n));
  if (!p->initial) PASS(need(&w->D, n * (size_t)x->ns));
  return OK;
}

status newton_advance(const scheme_call *a) {
  status st = OK;
  const flow *x = a->x;
  const scheme_step *p = a->p;
  const size_t bytes = (size_t)x->ns * (size_t)x->n * sizeof(double);
  const int most = p->initial ? MOST_INITIAL : MOST_TANGENT;
  scheme_work *w = a->w;
  scheme_result *out = a->out;
  point_work r = {0};
  TRY(point_step_new(x, &r.l));
  TRY(need_workspace(x, p, w));
  a->now->t = p->t;
  TRY(a->b->begin(a->b->ctx, a->now));
  memcpy(a->now->e, a->old->e, bytes);
  flow_tangent law = {
      .elastic = p->initial, .D = w->D, .sigma = w->sigma_k, .e = w->e_k};
  TRY(solve_points(a, &r));
  while (out->settled && out->iterations < most) {
    memcpy(w->sigma_k, a->now->sigma, bytes);
    memcpy(w->e_k, a->now->e, bytes);
    TRY(a->b->linear(a->b->ctx, &law, a->now, &out->settled));
    ++out->iterations;
    if (!out->settled) goto done;
    double scale = 0.0;
    TRY(linear_stress(x, &law, a->now, w->linear, &scale));
    TRY(solve_points(a, &r));
    if (!out->settled || misfit(x, a->now, w->linear, scale) <= p->tol)
      goto done;
  }
  out->settled = 0;
done:
  point_work_free(&r);
  return st;
}
