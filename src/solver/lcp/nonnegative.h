/*
 * A vector b as a sum of columns with factors that are not negative, as near as
 * possible (Lawson, Hanson 1974). The caller hands over the columns one by one,
 * each time the one with the largest work on the rest, b less the sum; a rest
 * on which no column does work separates b from all of them.
 */
#ifndef PROTIS_LCP_NONNEGATIVE_H
#define PROTIS_LCP_NONNEGATIVE_H

#include "base/status.h"

typedef struct nonnegative {
  int rows, n;          /* entries of a column; columns taken, at most rows */
  double *b, *rest;     /* [rows] */
  double *G;            /* [rows*rows] columns taken */
  double *x;            /* [rows] their factors */
  double *y, *Q, *work; /* [rows], [rows*rows], [4*rows] workspace */
} nonnegative;

status nonnegative_new(int rows, nonnegative *s);
void nonnegative_free(nonnegative *s);
/* No column is taken yet; b is set. */
void nonnegative_begin(nonnegative *s);
/* Where the next column[rows] goes; NULL: already as many columns as rows. */
double *nonnegative_next(const nonnegative *s);
/* Take it, drop those with factor zero. 0: no progress. */
int nonnegative_take(nonnegative *s);

#endif
