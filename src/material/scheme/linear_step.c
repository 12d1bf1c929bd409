/*
 * Steps of linear laws with constant coefficients: the maps of the points (of
 * linear.c), applied in blocks that stay in the cache.
 */
#include "material/scheme/work.h"

#include "base/base.h"
#include "material/voigt.h"

status linear_map_new(int ns, size_t n, linear_map *m) {
  PASS_NEW_ALL(OF(m->P, n * n), OF(m->Q0, n * ns), OF(m->Q1, n * ns),
               OF(m->Q, n * ns));
  return OK;
}

/* Deviator and mean are treated separately if the elasticity is isotropic. */
static int is_series(const flow_kind *k) {
  law_unit unit;
  const law_point p = flow_kind_point(k);
  if (k->law->ops->series == NULL) return 0;
  return k->elastic.isotropic ||
         k->law->ops->series(&p, 0, 0, &unit) == LAW_WHOLE;
}

status linear_map_make(const flow_kind *k, const scheme_step *p, int exact,
                       linear_map *m, double *D) {
  const int ns = k->elastic.ns, n = ns + k->n_alpha, series = is_series(k);
  const int general = !series && k->law->ops->relaxing == NULL;
  m->n = n;
  if (series)
    PASS(series_map(k, p, exact, m, D));
  else if (!general)
    PASS(relaxing_map(k, p, exact, m, D));
  else
    PASS(general_map(k, p, exact, m, D));
  if (!general && k->elastic.plane_stress)
    PASS(plane_stress_map(&k->elastic, m, D));
  sum_scaled(n * ns, m->Q0, 1.0, m->Q1, m->Q);
  return OK;
}

static status linear_maps(const flow *x, const scheme_step *p, int exact,
                          scheme_work *w) {
  size_t square = x->ns * x->ns;
  const linear_key key = {p->dt, p->theta, exact};
  if (w->made.dt == key.dt && w->made.theta == key.theta &&
      w->made.exact == exact)
    return OK;
  w->made.dt = 0.0;
  if (w->map == NULL) {
    OWNS(w);
    PASS_NEW_ALL(OF(w->map, x->n_kind), OF(w->D_kind, square * x->n_kind));
    for (int i = 0; i < x->n_kind; ++i)
      PASS(linear_map_new(x->ns, x->ns + x->kind[i].n_alpha, &w->map[i]));
  }
  for (int i = 0; i < x->n_kind; ++i)
    PASS(linear_map_make(&x->kind[i], p, exact, &w->map[i],
                         w->D_kind + square * i));
  w->made = key;
  return OK;
}

static inline void mean(int n, double th, const double *a, const double *b,
                        double *y) {
  for (int i = 0; i < n; ++i) y[i] = (1.0 - th) * a[i] + th * b[i];
}

/* y[n] += A[n*m] v[m] */
static void add_product(int n, int m, const double *restrict A,
                        const double *restrict v, double *restrict y) {
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < n; ++i) y[i] += A[i + n * j] * v[j];
}

/* y[n] = P (e^i, alpha) of point k; without alpha in its own tensors. */
static inline void map_state(int ns, const flow *x, const linear_map *m, int k,
                             const flow_state *s, double *y) {
  const double *ei = s->ei + (size_t)ns * k;
  if (m->n == ns) {
    voigt_product(ns, m->P, ei, y);
    return;
  }
  CLEAR(y, m->n);
  add_product(m->n, ns, m->P, ei, y);
  add_product(m->n, m->n - ns, m->P + m->n * ns, s->alpha + x->alpha_at[k], y);
}

/* y[n] += Q e */
static inline void map_strain(int ns, const linear_map *m, const double *Q,
                              const double *e, double *y) {
  if (m->n == ns)
    voigt_add(ns, Q, e, y);
  else
    add_product(m->n, ns, Q, e, y);
}

void linear_at(const flow *x, const linear_map *m, int k, const flow_state *old,
               const double *e, double *y) {
  map_state(x->ns, x, m, k, old, y);
  map_strain(x->ns, m, m->Q0, old->e + (size_t)x->ns * k, y);
  map_strain(x->ns, m, m->Q1, e, y);
}

/* Point k of a state: e^i, alpha and the stress at the strain e[ns]. */
static inline void put_point(int ns, const flow *x, const linear_map *m, int k,
                             const double *y, const double *e, flow_state *s) {
  const size_t at = (size_t)ns * k;
  double elastic[6], *alpha = s->alpha + x->alpha_at[k];
  for (int i = 0; i < ns; ++i) elastic[i] = e[i] - y[i];
  for (int i = 0; i < ns; ++i) s->ei[at + i] = y[i];
  for (int i = ns; i < m->n; ++i) alpha[i - ns] = y[i];
  voigt_product(ns, x->kind[x->kind_id[k]].elastic.E, elastic, s->sigma + at);
}

/* From old to mid with strains that are linear over the step. */
static status map_between(const scheme_call *a, int kind, linear_map *m,
                          double *D, flow_state *mid) {
  const flow *x = a->x;
  const double whole = a->now->t - a->old->t;
  scheme_step part = *a->p;
  part.t = mid->t;
  part.dt = mid->t - a->old->t;
  PASS(linear_map_new(x->ns, x->ns + x->kind[kind].n_alpha, m));
  PASS(linear_map_make(&x->kind[kind], &part, 1, m, D));
  for (int k = 0; k < x->n; ++k) {
    const size_t at = (size_t)x->ns * k;
    double y[FLOW_VALUE_MAX];
    if (x->kind_id[k] != kind) continue;
    mean(x->ns, part.dt / whole, a->old->e + at, a->now->e + at, mid->e + at);
    linear_at(x, m, k, a->old, mid->e + at, y);
    put_point(x->ns, x, m, k, y, mid->e + at, mid);
  }
  return OK;
}

status exponential_between(const scheme_call *a, flow_state *mid) {
  double D[36];
  for (int i = 0; i < a->x->n_kind; ++i) {
    OWNED_PARTS(linear_map, m, map_between(a, i, &m, D, mid));
  }
  return OK;
}

static inline void predict(int ns, const scheme_call *a, int from, int to) {
  const flow *x = a->x;
  double y[FLOW_VALUE_MAX];
  for (int k = from; k < to; ++k) {
    const linear_map *m = &a->w->map[x->kind_id[k]];
    const double *e = a->old->e + (size_t)ns * k;
    map_state(ns, x, m, k, a->old, y);
    map_strain(ns, m, m->Q, e, y);
    put_point(ns, x, m, k, y, e, a->now);
  }
}

void linear_predict(const scheme_call *a, int from, int to) {
  if (a->x->ns == 4)
    predict(4, a, from, to);
  else
    predict(6, a, from, to);
}

/* The rest for now->e, Q1 (e - e_old) and D (e - e_old) more. */
static inline void follow(int ns, const scheme_call *a, int k) {
  const int kind = a->x->kind_id[k];
  const linear_map *m = &a->w->map[kind];
  const size_t at = (size_t)ns * k;
  double de[6], y[FLOW_VALUE_MAX], *alpha = a->now->alpha + a->x->alpha_at[k];
  for (int i = 0; i < ns; ++i) de[i] = a->now->e[at + i] - a->old->e[at + i];
  voigt_add(ns, a->w->D_kind + ns * ns * kind, de, a->now->sigma + at);
  if (m->n == ns) {
    voigt_add(ns, m->Q1, de, a->now->ei + at);
    return;
  }
  CLEAR(y, m->n);
  add_product(m->n, ns, m->Q1, de, y);
  for (int i = 0; i < ns; ++i) a->now->ei[at + i] += y[i];
  for (int i = ns; i < m->n; ++i) alpha[i - ns] += y[i];
}

/* Power of point k in the middle between two states; p: its law. */
static inline double middle_power(int ns, const scheme_call *a, int k,
                                  law_point *p) {
  const flow *x = a->x;
  const flow_state *old = a->old, *now = a->now;
  const double th = a->p->theta;
  const size_t at = (size_t)ns * k, al = x->alpha_at[k];
  double sigma[6], ei[6], alpha[FLOW_VALUE_MAX];
  mean(ns, th, old->sigma + at, now->sigma + at, sigma);
  mean(ns, th, old->ei + at, now->ei + at, ei);
  mean((int)(x->alpha_at[k + 1] - al), th, old->alpha + al, now->alpha + al,
       alpha);
  p->sigma = sigma;
  p->ei = ei;
  p->alpha = alpha;
  return law_flows(p) ? x->weight[k] * law_dissipation(p) : 0.0;
}

static inline double follow_points(int ns, const scheme_call *a, int from,
                                   int to) {
  const flow *x = a->x;
  double power = 0.0;
  for (int k = from; k < to; ++k) {
    law_point p = flow_kind_point(&x->kind[x->kind_id[k]]);
    p.dt = a->p->dt;
    follow(ns, a, k);
    power += middle_power(ns, a, k, &p);
  }
  return power;
}

void linear_follow(const scheme_call *a, int from, int to) {
  a->out->dissipated +=
      a->p->dt * (a->x->ns == 4 ? follow_points(4, a, from, to)
                                : follow_points(6, a, from, to));
}

status linear_advance(const scheme_call *a, int exact) {
  const flow_body *b = a->b;
  PASS(linear_maps(a->x, a->p, exact, a->w));
  a->now->t = a->p->t;
  PASS(b->begin(b->ctx, a->now));
  const flow_tangent law = {.key = (exact ? 1.0 : a->p->theta) * a->p->dt,
                            .exact = exact,
                            .D = a->w->D_kind};
  PASS(b->step(b->ctx, &law, a, &a->out->settled));
  a->out->iterations = 1;
  return OK;
}
