/*
 * The plain form of the problem: a dense matrix, covering vector 1 (lcp.h).
 */
#include "base/memory.h"
#include "solver/lcp/lcp.h"

#include <cblas.h>
#include <math.h>
#include <string.h>

typedef struct plain {
  int n;
  const double *M;
  double factor; /* of two: M times factor is of order 1                      */
} plain;

static void plain_product(const void *ctx, int n_id, const int *id,
                          const double *x, double *y) {
  const plain *m = ctx;
  size_t n = (size_t)m->n;
  memset(y, 0, n * sizeof *y);
  for (int k = 0; k < n_id; ++k)
    if (x[k] != 0.0)
      cblas_daxpy(m->n, m->factor * x[k], m->M + n * (size_t)id[k], 1, y, 1);
}

static void plain_row(const void *ctx, int i, int n_id, const int *id,
                      double *row) {
  const plain *m = ctx;
  for (int k = 0; k < n_id; ++k)
    row[k] = m->factor * m->M[(size_t)i + (size_t)m->n * (size_t)id[k]];
}

static double plain_residual(int n, const double *M, const double *q,
                             const double *z) {
  double worst = 0.0;
  for (size_t i = 0; i < (size_t)n; ++i) {
    double sum = q[i];
    for (size_t j = 0; j < (size_t)n; ++j) sum += M[i + (size_t)n * j] * z[j];
    double miss = fabs(fmin(sum, z[i]));
    if (!(miss <= worst)) worst = miss;
  }
  return worst;
}

status lcp_lemke(int n, const double *M, const double *q, int max_pivots,
                 double *z, lcp_report *rep) {
  status st = OK;
  lcp_work *w = NULL;
  double *d = NULL;
  int exponent = 0;
  double size = 0.0;
  for (size_t i = 0; i < (size_t)n * (size_t)n; ++i)
    size = fmax(size, fabs(M[i]));
  if (size > 0.0 && size < HUGE_VAL) frexp(size, &exponent);
  plain m = {n, M, ldexp(1.0, -exponent)};
  *rep = (lcp_report){.outcome = RUNNING};
  TRY(lcp_new(n, n, &w));
  NEW(d, n);
  for (int i = 0; i < n; ++i) d[i] = 1.0;
  lcp_problem p = {.n = n,
                   .q = q,
                   .d = d,
                   .max_pivots = max_pivots,
                   .product = plain_product,
                   .row = plain_row,
                   .ctx = &m};
  lcp_run(w, &p, rep);
  if (rep->outcome == STOPPED_RAY) {
    lcp_ray(w, z);
  } else {
    lcp_values(w, z);
    for (int i = 0; i < n; ++i) z[i] *= m.factor;
    rep->residual = plain_residual(n, M, q, z);
  }
done:
  lcp_free(w);
  memory_free(d);
  return st;
}
