/*
 * Inverse of a dense symmetric matrix by Cholesky with pivoting: the matrix is
 * scaled to a unit diagonal; of a semidefinite one the remaining pivots are the
 * unknowns that, held, remove the motions without energy.
 */
#include "accuracy/accuracy.h"

#include "solver/newton/dense.h"

#include <cblas.h>
#include <lapacke.h>

enum { TILE = 32 };
static const double SYMMETRY = 0x1p-40; /* -, of the diagonal */
static const double RANK = 0x1p-38;     /* -, smaller pivots are zero */

struct dense_inverse {
  int m, rank;
  double condition;
  double *L, *unit; /* [m*m] factor of the scaled matrix; [m] its scale */
  int *pivot;       /* [m] unknown of each place, from 1 */
  double *y;        /* [m] */
  double *kernel;   /* [m*(m-rank)] motions without energy */
};

/* Lower triangle of L = D M D, unit diagonal; 0: not symmetric or positive. */
static int scale(const double *M, dense_inverse *d) {
  size_t m = d->m;
  for (size_t i = 0; i < m; ++i) {
    if (!(M[i * (m + 1)] > 0.0)) return 0;
    d->unit[i] = 1.0 / sqrt(M[i * (m + 1)]);
  }
  for (size_t j0 = 0; j0 < m; j0 += TILE)
    for (size_t i0 = j0; i0 < m; i0 += TILE)
      for (size_t j = j0; j < m && j < j0 + TILE; ++j)
        for (size_t i = i0 > j ? i0 : j; i < m && i < i0 + TILE; ++i) {
          double both = d->unit[i] * d->unit[j];
          d->L[i + m * j] = both * M[i + m * j];
          if (fabs(both * (M[i + m * j] - M[j + m * i])) > SYMMETRY) return 0;
        }
  return 1;
}

/* 1-norm of |inv(L')| |inv(L)| estimated: condition of the regular part. */
static int factor(dense_inverse *d, double *work, int *iwork) {
  int m = d->m;
  double rcond = 0.0;
  double norm =
      LAPACKE_dlansy_work(LAPACK_COL_MAJOR, '1', 'L', m, d->L, m, work);
  int info = LAPACKE_dpstrf_work(LAPACK_COL_MAJOR, 'L', m, d->L, m, d->pivot,
                                 &d->rank, RANK, work);
  if (info < 0 || d->rank == 0) return 0;
  LAPACKE_dpocon_work(LAPACK_COL_MAJOR, 'L', d->rank, d->L, m, norm, &rcond,
                      work, iwork);
  d->condition = 1.0 / rcond;
  return d->condition < 1.0 / 0x1p-50;
}

/* Null vectors of L, in the unknowns before the scaling. */
static status find_kernel(dense_inverse *d) {
  size_t m = d->m;
  PASS_NEW(d->kernel, m * (d->m - d->rank));
  dense_null(d->m, d->rank, d->L, d->pivot, d->y, d->kernel);
  for (size_t k = 0; k < m * (d->m - d->rank); ++k)
    d->kernel[k] *= d->unit[k % m];
  return OK;
}

status dense_inverse_new(int m, const double *M, dense_inverse **out) {
  OWNED double *work = NULL;
  OWNED int *iwork = NULL;
  MAKES(dense_inverse, d, out);
  d->m = m;
  PASS_NEW_ALL(OF(d->L, (size_t)m * m), OF(d->unit, m), OF(d->pivot, m),
               OF(d->y, m), OF(work, 3 * m), OF(iwork, m));
  if (scale(M, d) && factor(d, work, iwork)) return find_kernel(d);
  memory_free(d);
  *out = NULL;
  return OK;
}

/* y = inv(L) x in the order of the pivots. */
static void forward(dense_inverse *d, const double *x) {
  for (int j = 0; j < d->rank; ++j) {
    int dof = d->pivot[j] - 1;
    d->y[j] = d->unit[dof] * x[dof];
  }
  cblas_dtrsv(CblasColMajor, CblasLower, CblasNoTrans, CblasNonUnit, d->rank,
              d->L, d->m, d->y, 1);
}

void dense_inverse_solve(dense_inverse *d, const double *x, double *v) {
  forward(d, x);
  cblas_dtrsv(CblasColMajor, CblasLower, CblasTrans, CblasNonUnit, d->rank,
              d->L, d->m, d->y, 1);
  for (int j = 0; j < d->m; ++j) {
    int dof = d->pivot[j] - 1;
    v[dof] = j < d->rank ? d->unit[dof] * d->y[j] : 0.0;
  }
}

void dense_inverse_fill(dense_inverse *d, double *N, int *done) {
  size_t m = d->m;
  *done = d->rank == d->m;
  CLEAR(N, m * m);
  for (size_t j = 0; j < m && *done; ++j) {
    N[j * (m + 1)] = 1.0;
    dense_inverse_solve(d, N + m * j, N + m * j);
  }
}

static status dense_square(void *ctx, const double *x, double *square) {
  dense_inverse *d = ctx;
  forward(d, x);
  *square = cblas_ddot(d->rank, d->y, 1, d->y, 1);
  return OK;
}

inverse_energy dense_inverse_energy(dense_inverse *d) {
  return (inverse_energy){.ctx = d,
                          .square = dense_square,
                          .condition = d->condition,
                          .n_kernel = d->m - d->rank,
                          .kernel = d->kernel};
}
