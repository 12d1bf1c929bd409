/* Factor of a dense matrix (dense.h). */
#include "solver/newton/dense.h"

#include "base/sparse.h"

#include <cblas.h>
#include <lapacke.h>

enum { TILE = 32 }; /* for the cache */
static const double SINGULAR_RCOND = 1e-13;
static const double SUSPECT = 0x1p-20; /* -, smallest over largest pivot */

status dense_new(int capacity, dense *d) {
  size_t m = capacity;
  PASS_NEW_ALL(OF(d->a, m * m), OF(d->pivot, m), OF(d->iwork, m),
               OF(d->work, 4 * m));
  return OK;
}

void dense_free(dense *d) { RELEASE(d->a, d->pivot, d->iwork, d->work); }

int dense_is_symmetric(int m, const double *M, double apart) {
  size_t n = m;
  int unlike = 0;
  for (size_t j0 = 0; j0 < n; j0 += TILE)
    for (size_t i0 = 0; i0 <= j0; i0 += TILE)
      for (size_t j = j0; j < n && j < j0 + TILE; ++j)
        for (size_t i = i0; i < j && i < i0 + TILE; ++i)
          unlike |= fabs(M[i + n * j] - M[j + n * i]) > apart;
  return !unlike;
}

void dense_mirror(int m, double *M) {
  size_t n = m;
  for (size_t j0 = 0; j0 < n; j0 += TILE)
    for (size_t i0 = j0; i0 < n; i0 += TILE)
      for (size_t j = j0; j < n && j < j0 + TILE; ++j)
        for (size_t i = i0 > j ? i0 : j + 1; i < n && i < i0 + TILE; ++i)
          M[j + n * i] = M[i + n * j];
}

double dense_power(int m, const double *M) {
  double largest = 0.0;
  size_t n = m;
  for (size_t i = 0; i < n; ++i)
    if (M[i * n + i] > largest) largest = M[i * n + i];
  return power_to_one(largest);
}

/* 1: the pivots leave doubt, and the condition number says singular. */
static int is_singular(dense *d, double norm) {
  size_t n = d->n;
  double least = HUGE_VAL, most = 0.0, rcond = 1.0;
  for (size_t i = 0; i < n; ++i) {
    double pivot = fabs(d->a[i + n * i]);
    least = fmin(least, pivot);
    most = fmax(most, pivot);
  }
  if (!d->full) {
    least *= least;
    most *= most;
  }
  if (least > SUSPECT * most) return 0;
  if (d->full)
    LAPACKE_dgecon_work(LAPACK_COL_MAJOR, '1', d->n, d->a, d->n, norm, &rcond,
                        d->work, d->iwork);
  else
    LAPACKE_dpocon_work(LAPACK_COL_MAJOR, 'L', d->n, d->a, d->n, norm, &rcond,
                        d->work, d->iwork);
  return !(rcond > SINGULAR_RCOND);
}

static double norm_of(dense *d) {
  int n = d->n;
  return d->full ? LAPACKE_dlange_work(LAPACK_COL_MAJOR, '1', n, n, d->a, n,
                                       d->work)
                 : LAPACKE_dlansy_work(LAPACK_COL_MAJOR, '1', 'L', n, d->a, n,
                                       d->work);
}

int dense_factor(dense *d, int doubt) {
  int n = d->n;
  if (n == 0) return 1;
  double norm = doubt ? norm_of(d) : 0.0;
  int info =
      d->full ? LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, n, n, d->a, n, d->pivot)
              : LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'L', n, d->a, n);
  return info == 0 && !(doubt && is_singular(d, norm));
}

int dense_invert(dense *d) {
  int n = d->n;
  if (n == 0) return 1;
  if (d->full)
    return LAPACKE_dgetri_work(LAPACK_COL_MAJOR, n, d->a, n, d->pivot, d->work,
                               4 * n) == 0;
  if (LAPACKE_dpotri_work(LAPACK_COL_MAJOR, 'L', n, d->a, n) != 0) return 0;
  dense_mirror(n, d->a);
  return 1;
}

void dense_solve(const dense *d, int n_rhs, double *x, int ld) {
  int n = d->n;
  if (n == 0 || n_rhs == 0) return;
  if (d->full)
    LAPACKE_dgetrs_work(LAPACK_COL_MAJOR, 'N', n, n_rhs, d->a, n, d->pivot, x,
                        ld);
  else
    LAPACKE_dpotrs_work(LAPACK_COL_MAJOR, 'L', n, n_rhs, d->a, n, x, ld);
}

void dense_null(int m, int rank, const double *L, const int *pivot, double *y,
                double *N) {
  size_t ld = m, r = rank;
  for (size_t k = 0; k < ld - r; ++k) {
    double *v = N + ld * k;
    for (size_t i = 0; i < r; ++i) y[i] = -L[r + k + ld * i];
    if (rank > 0)
      cblas_dtrsv(CblasColMajor, CblasLower, CblasTrans, CblasNonUnit, rank, L,
                  m, y, 1);
    for (size_t i = 0; i < r; ++i) v[pivot[i] - 1] = y[i];
    v[pivot[r + k] - 1] = 1.0;
  }
}

double dense_rotate(int j, double *h, double *c, double *s, double *g) {
  for (int i = 0; i < j; ++i) cblas_drot(1, h + i, 1, h + i + 1, 1, c[i], s[i]);
  double a = h[j], b = h[j + 1];
  cblas_drotg(&a, &b, c + j, s + j);
  h[j] = a;
  h[j + 1] = g[j + 1] = 0.0;
  cblas_drot(1, g + j, 1, g + j + 1, 1, c[j], s[j]);
  return fabs(g[j + 1]);
}
