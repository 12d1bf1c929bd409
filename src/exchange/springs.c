/*
 * A global problem whose M is symmetric and singular: bodies that contact alone
 * holds. Springs s between the contact points and their obstacles hold them,
 * and are taken out again:
 *
 *   M v = H r + f,   y = H'v,   Ms = M + s H H',   Ws = H' inv(Ms) H,
 *   A y = r + inv(Ws) H' inv(Ms) f,   A = inv(Ws) - s I.
 *
 * A is the stiffness of the contact points, semidefinite. It needs H of full
 * column rank, and H'z != 0 for every motion z without force.
 */
#include "base/memory.h"
#include "exchange/parts.h"

#include <cblas.h>
#include <lapacke.h>

static const double RCOND = 1e-13; /* -, of Ws, below: H is rank deficient   */

/* Mean diagonal of M over that of H H', where both are not zero. */
static double stiffness(const triplets *M, const triplets *H) {
  double sum = 0.0, squares = 0.0;
  for (long k = 0; k < M->n; ++k)
    if (M->row[k] == M->column[k]) sum += M->value[k] / M->rows;
  for (long k = 0; k < H->n; ++k)
    squares += H->value[k] * H->value[k] / H->columns;
  return squares > 0.0 ? sum / squares : 0.0;
}

/* In one triangle if M is. */
status springs_add(const triplets *M, const triplets *H, double *s,
                   triplets *held) {
  *s = stiffness(M, H);
  OWNED int *start = NULL;
  int triangle = triplets_triangle(M);
  OWNED long *entry = NULL;
  long count = M->n;
  PASS(triplets_by_column(H, &start, &entry));
  for (int j = 0; j < H->columns; ++j) {
    long n = start[j + 1] - start[j];
    count += n * n;
  }
  held->rows = held->columns = M->rows;
  PASS_NEW(held->row, count);
  PASS_NEW(held->column, count);
  PASS_NEW(held->value, count);
  for (; held->n < M->n; ++held->n) {
    held->row[held->n] = M->row[held->n];
    held->column[held->n] = M->column[held->n];
    held->value[held->n] = M->value[held->n];
  }
  for (int j = 0; j < H->columns; ++j)
    for (int a = start[j]; a < start[j + 1]; ++a)
      for (int b = start[j]; b < start[j + 1]; ++b) {
        int row = H->row[entry[a]], column = H->row[entry[b]];
        if (triangle * (column - row) < 0) continue;
        held->row[held->n] = row;
        held->column[held->n] = column;
        held->value[held->n++] = *s * H->value[entry[a]] * H->value[entry[b]];
      }
  return OK;
}

/* inv(W) in place, both triangles; 0: singular. work[3m], iwork[m] */
static int invert(int m, double *W, double *work, int *iwork) {
  double rcond = 0.0;
  double norm = LAPACKE_dlansy_work(LAPACK_COL_MAJOR, '1', 'L', m, W, m, work);
  if (LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'L', m, W, m) != 0) return 0;
  LAPACKE_dpocon_work(LAPACK_COL_MAJOR, 'L', m, W, m, norm, &rcond, work,
                      iwork);
  if (!(rcond > RCOND)) return 0;
  if (LAPACKE_dpotri_work(LAPACK_COL_MAJOR, 'L', m, W, m) != 0) return 0;
  for (size_t j = 0; j < (size_t)m; ++j)
    for (size_t i = 0; i < j; ++i) W[i + (size_t)m * j] = W[j + (size_t)m * i];
  return 1;
}

status springs_condense(const triplets *M, const triplets *H, const double *f,
                        double *A, double *load, int *usable) {
  status st = OK;
  triplets held = {0};
  double *q = NULL, *work = NULL, s = 0.0;
  int *iwork = NULL, m = H->columns;
  NEW(q, m);
  NEW(work, 3 * m);
  NEW(iwork, m);
  TRY(springs_add(M, H, &s, &held));
  TRY(reduce_global(&held, H, f, A, q, usable));
  *usable = *usable && s > 0.0 && invert(m, A, work, iwork);
  if (!*usable) goto done;
  cblas_dsymv(CblasColMajor, CblasLower, m, 1.0, A, m, q, 1, 0.0, load, 1);
  for (size_t i = 0; i < (size_t)m; ++i) A[i * ((size_t)m + 1)] -= s;
done:
  triplets_free(&held);
  RELEASE(q, work, iwork);
  return st;
}
