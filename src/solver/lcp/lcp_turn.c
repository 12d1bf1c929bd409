/*
 * Principal transform of a linear complementarity problem (lcp_solve.h): z_i
 * and w_i change places for a set of unknowns that grows by single ones with a
 * good pivot on the diagonal, or by pairs with two beside it.
 */
#include "solver/lcp/lcp_solve.h"

#include <cblas.h>
#include <math.h>

static const double GOOD = 0x1p-7; /* -, of the largest entry of the row */

static double entry(int n, const double *M, int i, int j) {
  return M[(size_t)i + (size_t)n * (size_t)j];
}

/* y_r and x_c of y = q + M x change places. row[n] */
static void exchange(int n, int r, int c, double *M, double *q, double *row) {
  size_t ld = (size_t)n;
  double *column = M + ld * (size_t)c, pivot = column[r], q_r = q[r];
  cblas_dcopy(n, M + r, n, row, 1);
  cblas_dscal(n, 1.0 / pivot, column, 1);
  for (int j = 0; j < n; ++j)
    if (j != c) cblas_daxpy(n, -row[j], column, 1, M + ld * (size_t)j, 1);
  cblas_daxpy(n, -q_r, column, 1, q, 1);
  for (int j = 0; j < n; ++j) M[(size_t)r + ld * (size_t)j] = -row[j] / pivot;
  column[r] = 1.0 / pivot;
  q[r] = -q_r / pivot;
}

static int is_good(int n, const double *M, int i, int j) {
  double largest = fabs(entry(n, M, i, (int)cblas_idamax(n, M + i, n)));
  return fabs(entry(n, M, i, j)) > GOOD * largest;
}

static int draw(unsigned *seed, int count) {
  *seed = *seed * 1664525u + 1013904223u;
  return (int)((double)(*seed >> 8) * 0x1p-24 * count);
}

/* Column to exchange with row i: i itself, or the partner j for which both
 * entries are good, drawn at random; -1: none. */
static int partner(int n, int i, unsigned *seed, const double *M,
                   const unsigned char *turned) {
  int found = -1, count = 0;
  if (is_good(n, M, i, i)) return i;
  for (int j = 0; j < n; ++j) {
    if (j == i || turned[j] || !is_good(n, M, i, j) || !is_good(n, M, j, i))
      continue;
    if (draw(seed, ++count) == 0) found = j;
  }
  return found;
}

/* z_i, z_j with w_i, w_j by the entries beside the diagonal. */
static void exchange_pair(int n, int i, int j, double *M, double *q,
                          double *row) {
  size_t ld = (size_t)n;
  exchange(n, i, j, M, q, row);
  exchange(n, j, i, M, q, row);
  double keep = q[i];
  q[i] = q[j];
  q[j] = keep;
  cblas_dswap(n, M + i, n, M + j, n);
  cblas_dswap(n, M + ld * (size_t)i, 1, M + ld * (size_t)j, 1);
}

void lcp_turn(int n, int want, unsigned *seed, double *M, double *q,
              unsigned char *turned, double *row) {
  for (int k = 0; k < want; ++k) {
    int i = draw(seed, n);
    if (turned[i]) continue;
    int j = partner(n, i, seed, M, turned);
    if (j < 0) continue;
    if (j == i)
      exchange(n, i, i, M, q, row);
    else
      exchange_pair(n, i, j, M, q, row);
    turned[i] = turned[j] = 1;
  }
}
