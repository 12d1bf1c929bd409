/*
 * Equality constraints of FCLIB eliminated:
 *
 *   V'r + R l + s = 0,   u = W r + V l + q,
 *   l = -R+ (V'r + s):   W <- W - V R+ V',   q <- q - V R+ s.
 *
 * R may be unsymmetric, or singular where constraints repeat one another (then
 * l is not unique, u is); constraints that contradict one another are refused.
 */
#include "base/memory.h"
#include "exchange/parts.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <string.h>

static const double RCOND = 1e-12;     /* -, below: repeated                */
static const double CONSISTENT = 1e-8; /* -, of the right-hand side         */

typedef struct room {
  double *R, *X, *rhs; /* [p*p], [p*(m+1)]: least squares for [V' s]          */
  double *spread;      /* [p]                                                 */
} room;

static status room_new(int m, const constraints *c, room *a) {
  size_t p = (size_t)c->p, all = p * ((size_t)m + 1);
  PASS_NEW(a->R, p * p);
  PASS_NEW(a->X, all);
  PASS_NEW(a->rhs, all);
  PASS_NEW(a->spread, p);
  memcpy(a->R, c->R, p * p * sizeof *a->R);
  for (size_t k = 0; k < p; ++k) {
    for (size_t i = 0; i < (size_t)m; ++i)
      a->X[k + p * i] = c->V[i + (size_t)m * k];
    a->X[k + p * (size_t)m] = c->s[k];
  }
  memcpy(a->rhs, a->X, all * sizeof *a->X);
  return OK;
}

static void room_free(room *a) { RELEASE(a->R, a->X, a->rhs, a->spread); }

/* |R X - [V' s]| of the largest entry, relative. */
static double contradiction(int m, const constraints *c, room *a) {
  size_t all = (size_t)c->p * ((size_t)m + 1);
  double size = 0.0, miss = 0.0;
  for (size_t k = 0; k < all; ++k) size = fmax(size, fabs(a->rhs[k]));
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, c->p, m + 1, c->p,
              -1.0, c->R, c->p, a->X, c->p, 1.0, a->rhs, c->p);
  for (size_t k = 0; k < all; ++k) miss = fmax(miss, fabs(a->rhs[k]));
  return size > 0.0 ? miss / size : 0.0;
}

status constraints_eliminate(const char *path, int m, const constraints *c,
                             double *W, double *q) {
  status st = OK;
  room a = {0};
  lapack_int rank = 0;
  if (c->p == 0) goto done;
  TRY(room_new(m, c, &a));
  if (LAPACKE_dgelsd(LAPACK_COL_MAJOR, c->p, c->p, m + 1, a.R, c->p, a.X, c->p,
                     a.spread, RCOND, &rank) != 0)
    FAIL(ERR_SINGULAR, "%s: the equality constraints cannot be eliminated",
         path);
  if (!(contradiction(m, c, &a) <= CONSISTENT))
    FAIL(ERR_SINGULAR,
         "%s: the equality constraints contradict one another: of %d only %d "
         "are independent",
         path, c->p, (int)rank);
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, m, m, c->p, -1.0, c->V,
              m, a.X, c->p, 1.0, W, m);
  cblas_dgemv(CblasColMajor, CblasNoTrans, m, c->p, -1.0, c->V, m,
              a.X + (size_t)c->p * (size_t)m, 1, 1.0, q, 1);
done:
  room_free(&a);
  return st;
}

void constraints_free(constraints *c) { RELEASE(c->V, c->R, c->s); }
