/*
 * Condition number of a factored body, its unknowns scaled to a unit diagonal:
 * that of inv(D) K inv(D), D^2 the diagonal. The rounding of a Cholesky factor
 * does not depend on such a scaling, so that contrasts of stiffness count only
 * where digits are lost. Two steps of inverse iteration and the largest row
 * sum: an estimate, a few times too large or too small.
 */
#include "base/memory.h"
#include "fem/factor.h"

#include <math.h>

/* D of the scaled matrix at the unknowns: root[dim*n_node], 1 elsewhere. */
static void fill_roots(const stiffness *k, const body_factor *f, double *root) {
  const int dim = k->dim;
  const double scale = ldexp(1, -f->exponent);
  for (int q = 0; q < f->n_node; ++q) {
    const int i = f->node[q];
    const double *b = k->block + (size_t)(dim * dim) * k->start[i];
    for (int c = 0; c < dim; ++c) {
      const double spring = body_factor_spring(k, f, (long)dim * i + c);
      root[(size_t)dim * (size_t)i + (size_t)c] =
          k->free[i] >> c & 1 ? sqrt(scale * b[c * (dim + 1)] + spring) : 1;
    }
  }
}

/* Add the magnitudes of the scaled block p = (i, j) to the sums of its rows and
 * columns. */
static void add_magnitudes(const stiffness *k, size_t p, int j,
                           const double *root, double *sum) {
  const int dim = k->dim, i = k->row[p];
  const double *b = k->block + (size_t)(dim * dim) * p;
  for (int c = 0; c < dim; ++c)
    for (int r = 0; r < dim; ++r) {
      const size_t row = (size_t)dim * (size_t)i + (size_t)r;
      const size_t col = (size_t)dim * (size_t)j + (size_t)c;
      if (!(k->free[i] >> r & 1) || !(k->free[j] >> c & 1)) continue;
      if (row == col) continue;
      const double v = fabs(b[dim * c + r]) / (root[row] * root[col]);
      sum[row] += v;
      if (i != j) sum[col] += v;
    }
}

/* Largest sum of magnitudes in a row; sum[dim*n_node] is zero before. */
static double largest_row_sum(const stiffness *k, const body_factor *f,
                              const double *root, double *sum) {
  const double scale = ldexp(1, -f->exponent);
  double most = 0;
  for (int q = 0; q < f->n_own; ++q) {
    const int j = f->node[q];
    for (size_t p = k->start[j]; p < k->start[j + 1]; ++p)
      if (k->free[k->row[p]] != 0) add_magnitudes(k, p, j, root, sum);
  }
  for (long p = 0; p < f->n; ++p) most = fmax(most, sum[f->unknown[p]]);
  return 1 + scale * most;
}

static double norm(long n, const double *v) {
  double sum = 0;
  for (long i = 0; i < n; ++i) sum += v[i] * v[i];
  return sqrt(sum);
}

/* *growth = |D inv(K) D| by inverse iteration from a vector of ones with a
 * ripple. */
static status inverse_norm(const body_factor *f, const double *root,
                           cholmod_common *cm, double *growth) {
  enum { PASSES = 2 };
  status st = OK;
  cholmod_dense *v = cholmod_l_zeros((size_t)f->n, 1, CHOLMOD_REAL, cm);
  if (v == NULL)
    FAIL(ERR_MEMORY, "memory exhausted: condition of %ld unknowns", f->n);
  double *x = v->x;
  for (long p = 0; p < f->n; ++p) x[p] = 1 + 0.25 * (double)(f->unknown[p] % 7);
  for (int pass = 0; pass < PASSES; ++pass) {
    const double size = norm(f->n, x);
    for (long p = 0; p < f->n; ++p) x[p] *= root[f->unknown[p]] / size;
    if (!cholmod_l_super_lsolve(f->L, v, f->work, cm) ||
        !cholmod_l_super_ltsolve(f->L, v, f->work, cm))
      FAIL(ERR_INTERNAL, "solve of %ld unknowns failed", f->n);
    for (long p = 0; p < f->n; ++p) x[p] *= root[f->unknown[p]];
    *growth = norm(f->n, x);
  }
done:
  cholmod_l_free_dense(&v, cm);
  return st;
}

status body_factor_condition(const stiffness *k, const body_factor *f,
                             cholmod_common *cm, double *condition) {
  const size_t n = (size_t)k->dim * (size_t)k->n_node;
  OWNED double *sum = NULL, *root = NULL;
  double growth = 0;
  PASS_NEW(sum, n);
  PASS_NEW(root, n);
  fill_roots(k, f, root);
  PASS(inverse_norm(f, root, cm, &growth));
  *condition = largest_row_sum(k, f, root, sum) * growth;
  return OK;
}
