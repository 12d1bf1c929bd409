/* A contact problem whose stiffness is an operator (operated_case.h). */
#include "support/operated_case.h"

#include "solver/choice/choice.h"
#include "support/unit.h"

#include <lapacke.h>

static const double LARGER = 1.7; /* -, diagonal said over the true one       */

static void apply(void *ctx, const double *u, double *Au, double *size) {
  const operated_case *o = ctx;
  contact_product(o->of.m, o->of.A, u, Au);
  for (int i = 0; i < o->of.m; ++i)
    if (contact_held(&o->of, i)) Au[i] = o->diagonal[i] * u[i];
  for (int i = 0; i < o->of.m && size != NULL; ++i) {
    size[i] = 0;
    for (int j = 0; j < o->of.m; ++j)
      size[i] += fabs(o->of.A[i + o->of.m * j] * u[j]);
  }
}

/* Row i stays out of the system. */
static int is_out(const operated_case *o, int i) {
  return o->known[i] || contact_held(&o->of, i);
}

/* Springs at as many unknowns as there are motions, where no row is known. */
static void hold_motions(operated_case *o) {
  for (int k = 0; k < o->op.n_kernel; ++k)
    o->M[o->pin[k] * (o->of.m + 1)] += o->diagonal[o->pin[k]];
}

/* Rows that are out have their diagonal alone; all times the power of two that
 * makes a square root free of the unit. */
static void take_out(operated_case *o) {
  const int m = o->of.m;
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < m; ++i) {
      double *entry = o->M + i + m * j;
      if (is_out(o, i) || is_out(o, j)) *entry = i == j ? o->diagonal[i] : 0;
      *entry *= o->power;
    }
}

/* Of the factor, over the entry it comes from. */
static double least_pivot(const operated_case *o) {
  const int m = o->of.m;
  double least = HUGE_VAL;
  for (int i = 0; i < m; ++i)
    least = fmin(least, pow(o->M[i + m * i], 2) / (o->power * o->diagonal[i]));
  return least;
}

static status set_rows(void *ctx, const known_rows *rows, int *singular) {
  operated_case *o = ctx;
  const int m = o->of.m, dim = o->of.dim;
  for (int i = 0; i < m; ++i)
    o->known[i] = rows->known != NULL && rows->known[i];
  memcpy(o->M, o->of.A, (size_t)(m * m) * sizeof *o->M);
  if (rows->known == NULL) hold_motions(o);
  for (int i = 0; i < m && rows->added != NULL; ++i)
    for (int k = 0; k < dim; ++k)
      o->M[i + m * (i / dim * dim + k)] += rows->added[dim * i + k];
  take_out(o);
  *singular = LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', m, o->M, m) != 0 ||
              (o->op.n_kernel > 0 && !(least_pivot(o) > 0x1p-42));
  return OK;
}

static void solve(void *ctx, const double *b, double *x, double *Ax) {
  operated_case *o = ctx;
  const int m = o->of.m;
  for (int i = 0; i < m; ++i) {
    o->y[i] = b[i];
    for (int j = 0; j < m; ++j)
      if (o->known[j] && !contact_held(&o->of, j))
        o->y[i] -= o->of.A[i + m * j] * x[j];
    if (is_out(o, i)) o->y[i] = 0;
  }
  for (int i = 0; i < m; ++i) o->y[i] *= o->power;
  LAPACKE_dpotrs(LAPACK_COL_MAJOR, 'L', m, 1, o->M, m, o->y, m);
  for (int i = 0; i < m; ++i)
    if (!is_out(o, i)) x[i] = o->y[i];
  apply(ctx, x, Ax, NULL);
}

static void set_response(void *ctx, const unsigned char *at) {}

static void response(void *ctx, const double *b, double *x, double *Ax) {
  const operated_case *o = ctx;
  for (int i = 0; i < o->of.m; ++i)
    if (is_out(o, i)) x[i] = 0;
  solve(ctx, b, x, Ax);
}

/* The motions without energy. */
static void find_kernel(operated_case *o) {
  anchor an = {0};
  ck_assert_int_eq(anchor_modes(&o->of, &an), OK);
  o->op.n_kernel = an.n_mode;
  o->op.kernel = o->kernel =
      calloc((size_t)(o->of.m * an.n_mode), sizeof(double));
  memcpy(o->kernel, an.R, (size_t)(o->of.m * an.n_mode) * sizeof(double));
  anchor_free(&an);
}

/* Unknowns whose rows of the motions are independent: elimination, the largest
 * entry first. */
static void choose_pins(operated_case *o) {
  const int m = o->of.m, n = o->op.n_kernel;
  double *R = calloc((size_t)(m * n), sizeof *R);
  memcpy(R, o->kernel, (size_t)(m * n) * sizeof *R);
  for (int k = 0; k < n; ++k) {
    int best = 0;
    for (int i = 1; i < m; ++i)
      if (fabs(R[i + m * k]) > fabs(R[best + m * k])) best = i;
    o->pin[k] = best;
    for (int l = k + 1; l < n; ++l) {
      const double part = R[best + m * l] / R[best + m * k];
      for (int i = 0; i < m; ++i) R[i + m * l] -= part * R[i + m * k];
    }
  }
  free(R);
}

operated_case *operated_new(contact_case *c) {
  operated_case *o = calloc(1, sizeof *o);
  const contact_problem *full = &o->of;
  const size_t m = (size_t)c->cp.m;
  int exponent;
  o->of = c->cp;
  o->known = calloc(m, 1);
  o->M = calloc(m * m, sizeof *o->M);
  o->y = calloc(m, sizeof *o->y);
  o->diagonal = calloc(m, sizeof *o->diagonal);
  o->workspace = calloc(2 * m, sizeof *o->workspace);
  for (size_t i = 0; i < m; ++i)
    o->diagonal[i] =
        (contact_held(full, (int)i) ? 1 : LARGER) * full->A[i * (m + 1)];
  frexp(o->diagonal[0], &exponent);
  o->power = ldexp(1, -exponent);
  ck_assert_int_eq(contact_bodies_new(full, &o->bodies), OK);
  o->op = (contact_operator){.ctx = o,
                             .diagonal = o->diagonal,
                             .body = o->bodies->of,
                             .n_body = o->bodies->n,
                             .workspace = o->workspace,
                             .apply = apply,
                             .set_rows = set_rows,
                             .solve = solve,
                             .set_response = set_response,
                             .response = response};
  if (full->floating) {
    find_kernel(o);
    choose_pins(o);
  }
  c->cp.A = NULL;
  c->cp.op = &o->op;
  return o;
}

void operated_free(operated_case *o, contact_case *c) {
  c->cp.A = o->of.A;
  c->cp.op = NULL;
  memory_free(o->bodies);
  free(o->known);
  free(o->M);
  free(o->y);
  free(o->diagonal);
  free(o->workspace);
  free(o->kernel);
  free(o);
}
