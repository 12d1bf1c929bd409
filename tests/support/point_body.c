/*
 * A body of one material point.
 */
#include "support/point_body.h"

#include "base/base.h"

#include <check.h>

/* x := inv(A) x, A[n*n] column major, by elimination with pivots. */
static void solve(int n, double *A, double *x) {
  for (int k = 0; k < n; ++k) {
    int p = k;
    for (int i = k + 1; i < n; ++i)
      if (fabs(A[i + n * k]) > fabs(A[p + n * k])) p = i;
    for (int j = 0; j < n && p != k; ++j) {
      const double keep = A[k + n * j];
      A[k + n * j] = A[p + n * j];
      A[p + n * j] = keep;
    }
    const double keep = x[k];
    x[k] = x[p];
    x[p] = keep;
    for (int i = k + 1; i < n; ++i) {
      const double factor = A[i + n * k] / A[k + n * k];
      for (int j = k; j < n; ++j) A[i + n * j] -= factor * A[k + n * j];
      x[i] -= factor * x[k];
    }
  }
  for (int k = n - 1; k >= 0; --k) {
    for (int j = k + 1; j < n; ++j) x[k] -= A[k + n * j] * x[j];
    x[k] /= A[k + n * k];
  }
}

/* Strains e with the stresses base + D (e - at) where they are given. */
static void balance(const point_drive *d, double t, const double *D,
                    const double *base, const double *at, double *e) {
  int free[6], n = 0;
  double A[36], x[6];
  for (int i = 0; i < 6; ++i) {
    e[i] = d->held[i] ? d->e[i] + t * d->e_rate[i] : at[i];
    if (!d->held[i]) free[n++] = i;
  }
  for (int i = 0; i < n; ++i) {
    x[i] = d->sigma[free[i]] + t * d->sigma_rate[free[i]] - base[free[i]];
    for (int j = 0; j < 6; ++j) x[i] -= D[free[i] + 6 * j] * (e[j] - at[j]);
    for (int j = 0; j < n; ++j) A[i + n * j] = D[free[i] + 6 * free[j]];
  }
  solve(n, A, x);
  for (int i = 0; i < n; ++i) e[free[i]] += x[i];
}

static void take_stress(const point_body *b, flow_state *s) {
  double elastic[6];
  for (int i = 0; i < 6; ++i) elastic[i] = s->e[i] - s->ei[i];
  tensor_product(6, b->c.elastic.E, elastic, s->sigma);
}

static status equilibrium(void *ctx, flow_state *s, int *settled) {
  static const double zero[6];
  point_body *b = ctx;
  ++b->n_equilibrium;
  balance(&b->drive, s->t, b->c.elastic.E, zero, s->ei, s->e);
  take_stress(b, s);
  *settled = 1;
  return OK;
}

static status begin(void *ctx, flow_state *s) { return OK; }

static status linear(void *ctx, const flow_tangent *law, flow_state *s,
                     int *settled) {
  point_body *b = ctx;
  ++b->n_linear;
  balance(&b->drive, s->t, law->elastic ? b->c.elastic.E : law->D, law->sigma,
          law->e, s->e);
  take_stress(b, s);
  *settled = 1;
  return OK;
}

static status step(void *ctx, const flow_tangent *law, const scheme_call *a,
                   int *settled) {
  point_body *b = ctx;
  ++b->n_linear;
  linear_predict(a, 0, a->x->n);
  balance(&b->drive, a->now->t, law->D, a->now->sigma, a->old->e, a->now->e);
  linear_follow(a, 0, a->x->n);
  *settled = 1;
  return OK;
}

static void all_right(status st) {
  ck_assert_msg(st == OK, "%s", status_message());
}

void point_body_new(const point_input *in, const point_drive *drive,
                    point_body *b) {
  const int kind_id = 0;
  const law_ops *ops = law_find(in->law);
  int settled;
  memset(b, 0, sizeof *b);
  ck_assert_msg(ops != NULL, "%s", in->law);
  ck_assert_int_eq(law_case_new(ops, in->words, in->data, in->young, in->nu,
                                SOLID_3D, &b->c),
                   1);
  b->drive = *drive;
  b->parts = memory_new(1, 1);
  OWNS(b->parts);
  b->x.ns = 6;
  b->x.n_kind = 1;
  b->x.kind = memory_new(1, sizeof *b->x.kind);
  all_right(flow_new_kind(&b->x.kind[0], &b->c.card, &b->c.elastic));
  all_right(flow_new_points(&b->x, 1, &kind_id));
  b->x.weight[0] = 1;
  all_right(flow_state_new(&b->x, &b->old));
  all_right(flow_state_new(&b->x, &b->now));
  all_right(scheme_work_new(&b->work));
  b->old.t = in->t;
  all_right(equilibrium(b, &b->old, &settled));
  flow_state_copy(&b->x, &b->old, &b->now);
}

void point_body_free(point_body *b) {
  memory_free(b->parts);
  law_case_free(&b->c);
}

static double exact(void *ctx) {
  (void)ctx;
  return 0.0;
}

void point_body_run(point_body *b, const scheme *s, double theta, double t,
                    int n, double *estimates) {
  const flow_body body = {b, equilibrium, begin, linear, step, exact};
  const double start = b->old.t, dt = (t - start) / n;
  for (int k = 0; k < n; ++k) {
    const scheme_step p = {.t = k == n - 1 ? t : start + (k + 1) * dt,
                           .dt = dt,
                           .theta = theta,
                           .fastest = HUGE_VAL,
                           .tol = 1e-12};
    const scheme_call call = {&b->x,   &p,      &body,     b->work,
                              &b->old, &b->now, &b->result};
    b->result = (scheme_result){.settled = 1, .error = -1};
    all_right(s->advance(&call));
    ck_assert_int_eq(b->result.settled, 1);
    b->now.t = p.t;
    if (estimates != NULL) estimates[k] = b->result.error;
    flow_state_copy(&b->x, &b->now, &b->old);
  }
}
