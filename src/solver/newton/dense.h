/* A dense matrix and its factor in the same array: Cholesky or LU. */
#pragma once

#include "base/status.h"

typedef struct dense {
  double *a;          /* [n*n] lower triangle or all, then the factor */
  int n, full;        /* unknowns; 1: LU, 0: Cholesky */
  int *pivot, *iwork; /* [capacity] */
  double *work;       /* [4 capacity] */
} dense;

status dense_new(int capacity, dense *d);
void dense_free(dense *d);
/* 1: M[m*m] equals its transpose within "apart". */
int dense_is_symmetric(int m, const double *M, double apart);
/* The upper triangle of M[m*m] from the lower. */
void dense_mirror(int m, double *M);
/* power_to_one of the largest diagonal entry of M[m*m]. */
double dense_power(int m, const double *M);
/* N[m*(m-rank)], zero before: null vectors of L[m*m], a factor of rank "rank"
 * in the order "pivot" (from 1): one unknown beyond the rank is 1, those before
 * follow. y[rank]: workspace. */
void dense_null(int m, int rank, const double *L, const int *pivot, double *y,
                double *N);
/* 0: singular to rounding, which is tested only if "doubt". */
int dense_factor(dense *d, int doubt);
/* The inverse in place of the factor, all of it; 0: not possible. */
int dense_invert(dense *d);
/* x[n, n_rhs], distance ld, from the right sides. */
void dense_solve(const dense *d, int n_rhs, double *x, int ld);
/* GMRES: the rotations c, s [j] and one more on column h[j+2] of the Hessenberg
 * matrix and the right side g; returns what is left of it. */
double dense_rotate(int j, double *h, double *c, double *s, double *g);
