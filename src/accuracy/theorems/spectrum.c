/* The largest eigenvalue of a symmetric positive semidefinite map. */
#include "accuracy/theorems/theorems.h"

#include "base/memory.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <string.h>

enum { STEPS = 160, EVERY = 8 };
static const double CLOSE = 1e-10; /* -, residual of Lanczos over the value */

/* H from its columns, then dsyevr for the last eigenvalue. */
static status dense_largest(const symmetric_map *map, double *largest) {
  OWNED int *iwork = NULL;
  int n = map->n, found, support[2];
  size_t ld = (size_t)n;
  OWNED double *H = NULL, *x = NULL, *w = NULL, *work = NULL;
  PASS_NEW(H, ld * ld);
  PASS_NEW(x, ld);
  PASS_NEW(w, ld);
  PASS_NEW(work, 26 * ld);
  PASS_NEW(iwork, 10 * ld);
  for (size_t j = 0; j < ld; ++j) {
    x[j] = 1.0;
    map->apply(map->ctx, x, H + ld * j);
    x[j] = 0.0;
  }
  if (LAPACKE_dsyevr_work(LAPACK_COL_MAJOR, 'N', 'I', 'L', n, H, n, 0.0, 0.0, n,
                          n, 0.0, &found, w, NULL, 1, support, work, 26 * n,
                          iwork, 10 * n) != 0)
    RAISE(ERR_INTERNAL, "eigenvalue of order %d not found", n);
  *largest = fmax(w[0], 0.0);
  return OK;
}

typedef struct lanczos {
  int n, k;             /* order; vectors so far */
  double *Q;            /* [n*STEPS] */
  double *alpha, *beta; /* [STEPS] the tridiagonal matrix */
  double *d, *e, *Z,
      *work; /* [STEPS], [STEPS], [STEPS^2], [2*STEPS] workspace */
} lanczos;

/* Largest eigenvalue of the tridiagonal matrix, and its residual added. */
static double ritz(lanczos *s, double *residual) {
  int k = s->k;
  memcpy(s->d, s->alpha, (size_t)k * sizeof *s->d);
  memcpy(s->e, s->beta, (size_t)k * sizeof *s->e);
  LAPACKE_dstev_work(LAPACK_COL_MAJOR, 'V', k, s->d, s->e, s->Z, k, s->work);
  *residual = s->beta[k - 1] * fabs(s->Z[(size_t)(k * k) - 1]);
  return s->d[k - 1];
}

/* The next vector: H q less what lies along the vectors so far, twice. */
static void lanczos_step(const symmetric_map *map, lanczos *s, double *v) {
  const double *q = s->Q + (size_t)s->n * (size_t)s->k;
  map->apply(map->ctx, q, v);
  s->alpha[s->k] = cblas_ddot(s->n, q, 1, v, 1);
  ++s->k;
  for (int twice = 0; twice < 2; ++twice) {
    cblas_dgemv(CblasColMajor, CblasTrans, s->n, s->k, 1.0, s->Q, s->n, v, 1,
                0.0, s->work, 1);
    cblas_dgemv(CblasColMajor, CblasNoTrans, s->n, s->k, -1.0, s->Q, s->n,
                s->work, 1, 1.0, v, 1);
  }
  s->beta[s->k - 1] = cblas_dnrm2(s->n, v, 1);
}

/*
 * Added at the end: the residual, or what the last half of the steps has still
 * added if that is more. Where eigenvalues crowd at the top, as those of
 * springs in a row, the error falls with the square of the steps and is a third
 * of it.
 */
static status lanczos_run(const symmetric_map *map, lanczos *s, double *v,
                          double *largest) {
  double residual = 0.0, history[STEPS / EVERY + 1] = {0.0};
  int last = s->n < STEPS ? s->n : STEPS;
  *largest = 0.0;
  for (int i = 0; i < s->n; ++i) s->Q[i] = 1.0 + 0.5 * sin(1.0 + 2.0 * i);
  cblas_dscal(s->n, 1.0 / cblas_dnrm2(s->n, s->Q, 1), s->Q, 1);
  for (;;) {
    lanczos_step(map, s, v);
    double beta = s->beta[s->k - 1];
    int stop = s->k == last || !(beta > 1e-14 * s->alpha[0]);
    if (stop || s->k % EVERY == 0) {
      *largest = history[s->k / EVERY] = ritz(s, &residual);
      if (stop || !(residual > CLOSE * *largest)) break;
    }
    double *next = s->Q + (size_t)s->n * (size_t)s->k;
    for (int i = 0; i < s->n; ++i) next[i] = v[i] / beta;
  }
  if (residual > CLOSE * *largest)
    residual = fmax(residual, *largest - history[s->k / EVERY / 2]);
  if (s->k < s->n) *largest += residual;
  return OK;
}

status lanczos_largest(const symmetric_map *map, double *largest) {
  status st = OK;
  lanczos s = {.n = map->n};
  double *v = NULL;
  NEW(s.Q, (size_t)map->n * STEPS);
  NEW(s.alpha, STEPS);
  NEW(s.beta, STEPS);
  NEW(s.d, STEPS);
  NEW(s.e, STEPS);
  NEW(s.Z, (size_t)STEPS * STEPS);
  NEW(s.work, 2 * STEPS);
  NEW(v, map->n);
  TRY(lanczos_run(map, &s, v, largest));
done:
  RELEASE(s.Q, s.alpha, s.beta, s.d, s.e, s.Z, s.work, v);
  return st;
}

status largest_eigenvalue(const symmetric_map *map, double *largest) {
  return map->n <= DENSE_ORDER ? dense_largest(map, largest)
                               : lanczos_largest(map, largest);
}
