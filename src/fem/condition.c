/*
 * Condition number of a factored body: two steps of inverse iteration and the
 * largest row sum. An estimate from below by a factor of a few.
 */
#include "base/memory.h"
#include "fem/factor.h"

#include <math.h>

/* Largest sum of magnitudes in a row of the scaled matrix; sum[dim*n_node] is
 * zero before. */
static double largest_row_sum(const stiffness *k, const body_factor *f,
                              double *sum) {
  const int dim = k->dim;
  const double scale = ldexp(1, -f->exponent);
  double most = 0;
  for (int q = 0; q < f->n_node; ++q) {
    const int j = f->node[q];
    for (size_t p = k->start[j]; p < k->start[j + 1]; ++p) {
      const double *b = k->block + (size_t)(dim * dim) * p;
      const int i = k->row[p];
      for (int c = 0; c < dim; ++c)
        for (int r = 0; r < dim; ++r) {
          const size_t row = (size_t)dim * (size_t)i + (size_t)r;
          const size_t col = (size_t)dim * (size_t)j + (size_t)c;
          if (!(k->free[i] >> r & 1) || !(k->free[j] >> c & 1)) continue;
          sum[row] += scale * fabs(b[dim * c + r]);
          if (i != j) sum[col] += scale * fabs(b[dim * c + r]);
        }
    }
  }
  for (long p = 0; p < f->n; ++p) most = fmax(most, sum[f->unknown[p]]);
  return most + f->spring;
}

static double norm(long n, const double *v) {
  double sum = 0;
  for (long i = 0; i < n; ++i) sum += v[i] * v[i];
  return sqrt(sum);
}

/* |inv(K)| by inverse iteration from a vector of ones with a slow ripple. */
static double inverse_norm(const body_factor *f, cholmod_common *cm) {
  double growth = 0;
  cholmod_dense *v = cholmod_l_zeros((size_t)f->n, 1, CHOLMOD_REAL, cm);
  if (v == NULL) return 0;
  double *x = v->x;
  for (long p = 0; p < f->n; ++p) x[p] = 1 + 0.25 * (double)(f->unknown[p] % 7);
  for (int pass = 0; pass < 2; ++pass) {
    const double size = norm(f->n, x);
    for (long p = 0; p < f->n; ++p) x[p] /= size;
    if (!cholmod_l_super_lsolve(f->L, v, f->work, cm) ||
        !cholmod_l_super_ltsolve(f->L, v, f->work, cm))
      break;
    growth = norm(f->n, x);
  }
  cholmod_l_free_dense(&v, cm);
  return growth;
}

double body_factor_condition(const stiffness *k, const body_factor *f,
                             cholmod_common *cm) {
  double *sum = memory_new((size_t)k->dim * (size_t)k->n_node, sizeof *sum);
  double estimate = 0;
  if (sum != NULL) estimate = largest_row_sum(k, f, sum) * inverse_norm(f, cm);
  memory_free(sum);
  return estimate;
}
