/*
 * The linear complementarity problem
 *
 *   w = q + M z,   w >= 0,  z >= 0,  w'z = 0,
 *
 * by complementary pivoting (Lemke 1965; Cottle, Pang, Stone 1992, 4.4): the
 * problem w = q + M z + d z0 with a covering vector d >= 0 is followed from
 * large z0 to z0 = 0. Ties are decided by the lexicographic rule, so that no
 * basis is repeated. The inverse of the basis is kept for the rows and columns
 * that differ from the start only (at most rank + 1) and updated: a pivot costs
 * two products with it, one rank-one change and one product with M.
 */
#pragma once

#include "base/status.h"

typedef struct lcp_report {
  outcome outcome; /* CONVERGED; STOPPED_RAY: a secondary ray;
                      STOPPED_ITERATIONS, STOPPED_SINGULAR (of the basis),
                      STOPPED_NAN */
  int pivots;      /* with the first, which brings z0 in */
  double residual; /* largest |min(z, w)|, in units of q; plain form only */
} lcp_report;

/*
 * Plain form: M[n*n] column major, q[n], d = 1. z[n] receives the solution, on
 * STOPPED_RAY the direction of the ray: y >= 0 with M y >= -y0, y0 >= 0; for a
 * positive semidefinite M it proves that there is no z >= 0 with w >= 0 (M'y <=
 * 0, q'y < 0). max_pivots 0: chosen by the program. Errors: ERR_MEMORY.
 */
status lcp_lemke(int n, const double *M, const double *q, int max_pivots,
                 double *z, lcp_report *rep);

/* ---- the same for a matrix that is not formed ---------------------------- */

typedef struct lcp_problem {
  int n;
  const double *q, *d; /* [n]; d >= 0, positive where q < 0 */
  int max_pivots;      /* 0: chosen by the program */
  /* y[n] = sum over k of x[k] M(:, id[k]); largest |M| of order 1 */
  void (*product)(const void *ctx, int n_id, const int *id, const double *x,
                  double *y);
  /* row[k] = M(i, id[k]) */
  void (*row)(const void *ctx, int i, int n_id, const int *id, double *row);
  void (*each)(const void *ctx, int pivot, double z0); /* or NULL */
  const void *ctx;
} lcp_problem;

typedef struct lcp_work lcp_work;
/* Allocates for n unknowns, of which at most "rank" (of M) are basic at a
 * time. */
status lcp_new(int n, int rank, lcp_work **out);
/* Solve p; rep->residual is unchanged. Allocates nothing. */
void lcp_run(lcp_work *w, const lcp_problem *p, lcp_report *rep);
/* z[n] of the last run. */
void lcp_values(const lcp_work *w, double *z);
/* y[n], y0 of the ray of the last run. */
double lcp_ray(const lcp_work *w, double *y);
/* 1: w_i is zero by the final basis (nonbasic). */
int lcp_row_is_tight(const lcp_work *w, int i);
/* dz[n]: change of the basic z that takes defect[n] out of the tight rows. */
void lcp_correction(lcp_work *w, const double *defect, double *dz);
