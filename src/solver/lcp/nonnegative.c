/* Least squares without negative factors (nonnegative.h). */
#include "solver/lcp/nonnegative.h"

#include "base/memory.h"

#include <cblas.h>
#include <lapacke.h>
#include <string.h>

status nonnegative_new(int rows, nonnegative *s) {
  size_t n = (size_t)rows;
  *s = (nonnegative){.rows = rows};
  PASS_NEW(s->b, n);
  PASS_NEW(s->rest, n);
  PASS_NEW(s->G, n * n);
  PASS_NEW(s->Q, n * n);
  PASS_NEW(s->x, n);
  PASS_NEW(s->y, n);
  PASS_NEW(s->work, 4 * n);
  return OK;
}

void nonnegative_free(nonnegative *s) {
  RELEASE(s->b, s->rest, s->G, s->Q, s->x, s->y, s->work);
}

void nonnegative_begin(nonnegative *s) {
  s->n = 0;
  memcpy(s->rest, s->b, (size_t)s->rows * sizeof *s->rest);
}

double *nonnegative_next(const nonnegative *s) {
  return s->n < s->rows ? s->G + (size_t)s->rows * (size_t)s->n : NULL;
}

/* y[n]: factors of the columns for b[rows] by least squares; 0: not possible.
 */
static int fit(nonnegative *s, const double *b) {
  int rows = s->rows;
  memcpy(s->Q, s->G, (size_t)rows * (size_t)s->n * sizeof *s->Q);
  memcpy(s->y, b, (size_t)rows * sizeof *s->y);
  return LAPACKE_dgels_work(LAPACK_COL_MAJOR, 'N', rows, s->n, 1, s->Q, rows,
                            s->y, rows, s->work, 4 * rows) == 0;
}

static void drop(nonnegative *s, int j) {
  size_t rows = (size_t)s->rows;
  --s->n;
  memmove(s->G + rows * (size_t)j, s->G + rows * (size_t)(j + 1),
          rows * (size_t)(s->n - j) * sizeof *s->G);
  memmove(s->x + j, s->x + j + 1, (size_t)(s->n - j) * sizeof *s->x);
}

/* From x towards y while no factor is negative; factors that become zero are
 * dropped. 1: y is reached. */
static int go(nonnegative *s) {
  double share = 1.0;
  int end = -1;
  for (int j = 0; j < s->n; ++j) {
    double may = s->y[j] < 0.0 ? s->x[j] / (s->x[j] - s->y[j]) : 1.0;
    if (!(s->y[j] < 0.0) || (end >= 0 && !(may < share))) continue;
    share = may;
    end = j;
  }
  for (int j = 0; j < s->n; ++j) s->x[j] += share * (s->y[j] - s->x[j]);
  if (end < 0) return 1;
  drop(s, end);
  return s->n == 0;
}

static void subtract(nonnegative *s, const double *x) {
  cblas_dgemv(CblasColMajor, CblasNoTrans, s->rows, s->n, -1.0, s->G, s->rows,
              x, 1, 1.0, s->rest, 1);
}

/* The rest is made normal to the columns twice, for its direction where little
 * is left. */
int nonnegative_take(nonnegative *s) {
  if (s->n == s->rows) return 0;
  s->x[s->n++] = 0.0;
  do {
    if (!fit(s, s->b)) return 0;
  } while (!go(s));
  memcpy(s->rest, s->b, (size_t)s->rows * sizeof *s->rest);
  subtract(s, s->x);
  if (s->n > 0 && fit(s, s->rest)) subtract(s, s->y);
  return 1;
}
