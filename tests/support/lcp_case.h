/*
 * Linear complementarity problems w = q + M z of all kinds, for the tests of
 * the solvers, and a check of an answer that shares nothing with the program.
 */
#pragma once

#include "base/memory.h"

typedef enum {
  LCP_TIES_IN_TURN, /* 1 and 2 beside it, q = -1: first-index rules cycle   */
  LCP_MURTY,        /* lower triangle of twos: 2^n pivots                   */
  LCP_FATHI,        /* the same, symmetric positive definite                */
  LCP_DEFINITE,     /* G G', G random                                       */
  LCP_SEMIDEFINITE, /* G G' of half the rank, solution planted              */
  LCP_COPOSITIVE,   /* the same plus a skew part                            */
  LCP_BIMATRIX,     /* [0 A; B' 0], A, B > 0, q = -1: a game of two         */
  LCP_TRIANGULAR,   /* P-matrix: unit lower triangle                        */
  LCP_OBSTACLE,     /* second difference, string over an obstacle           */
  LCP_PROGRAM,      /* skew: a linear programme, solution planted           */
  LCP_SCALED,       /* definite, rows and columns over eight decades        */
  LCP_Z_MATRIX,     /* 1 and negative entries                               */
  LCP_FRICTION,     /* rigid contacts with the facets of the cone           */
  LCP_INDEFINITE,   /* random, solution planted: may be missed              */
  LCP_NEGATIVE,     /* the same with a negative diagonal                    */
  LCP_INFEASIBLE,   /* a row that no z >= 0 makes positive                  */
  LCP_FLAT,         /* g g', g of both signs, q = -1: infeasible            */
  LCP_FAMILIES
} lcp_family;
/* Families before LCP_INDEFINITE have a solution; those from LCP_INFEASIBLE
 * have none. */

typedef struct lcp_case {
  int n;
  double *M, *q; /* [n*n] column major, [n]                                   */
  double *z, *w; /* [n] for answers                                           */
} lcp_case;

lcp_case lcp_make(lcp_family family, int n, unsigned long long seed);
void lcp_case_free(lcp_case *c);
/* LCP_CASE c = ...: freed where the name ends. */
#define LCP_CASE ENDS_BY(lcp_case_free) lcp_case
const char *lcp_name(lcp_family family);
/* Largest violation of w = q + M z, w >= 0, z >= 0, w z = 0; w in units of
 * the largest |q|, z in those of the largest |q| over that of |M|. */
double lcp_violation(const lcp_case *c, const double *z);
