/*
 * A linear complementarity problem from a file, whatever its matrix:
 *
 *   w = q + M z,   w >= 0,  z >= 0,  w'z = 0.
 *
 * Complementary pivoting (solver/lcp/lcp.h) comes first. It can end on a ray,
 * or take 2^n pivots, though the problem has a solution; then the question
 * whether any z >= 0 has w >= 0 is posed as a problem that pivoting always
 * decides,
 *
 *   w = 0 - M'y,  v = q + M z,   (z, w), (y, v) complementary,
 *
 * (its matrix is skew), and if there is one: for few unknowns all bases, which
 * decides; the Newton method on the function of Fischer and Burmeister from
 * many starts (De Luca, Facchinei, Kanzow 1996), and pivoting with other units,
 * covering vectors and from other vertices. The first attempt ends early where
 * these follow.
 */
#pragma once

#include "base/status.h"

typedef struct lcp_data {
  int n;
  const double *M, *q; /* [n*n] column major, [n] */
} lcp_data;

typedef struct lcp_control {
  double tol;        /* wanted residual, - */
  int max_iter;      /* pivots and steps of all attempts; 0: each its own
                        limit */
  int pivoting_only; /* 1: no other method */
} lcp_control;

enum { LCP_LOG = 256 };
typedef struct lcp_verdict {
  outcome outcome;    /* CONVERGED; STOPPED_RAY: proved that no z >= 0 has w >=
                         0, or that no basis solves it; STOPPED_ITERATIONS: a
                         limit was reached; STOPPED_STAGNATION: nothing found,
                         nothing proved; STOPPED_NAN */
  int iterations;     /* pivots and steps of all attempts */
  double residual;    /* of z, -: see lcp_solve.c */
  const char *method; /* the last method */
  char log[LCP_LOG];  /* "lemke: no equilibrium, ..."; "" if the first did */
} lcp_verdict;

/* z[n] start value, then the solution or the best found; w[n] = q + M z.
 * Errors: ERR_MEMORY. */
status lcp_solve(const lcp_data *p, const lcp_control *control, double *z,
                 double *w, lcp_verdict *v);

/* ---- lcp_turn.c: private to this folder ---------------------------------- */

/*
 * The problem with z_i and w_i exchanged for "want" of the unknowns (principal
 * transform; Cottle, Pang, Stone 1992, 2.3), in place: pivoting then starts
 * from another vertex. Those exchanged: turned[n] = 1; fewer where the block is
 * nearly singular. row[n] is workspace.
 */
void lcp_turn(int n, int want, unsigned *seed, double *M, double *q,
              unsigned char *turned, double *row);

/*
 * A vector b as a sum of columns with factors that are not negative, as near as
 * possible (Lawson, Hanson 1974). The caller hands over the columns one by one,
 * each time the one with the largest work on the rest, b less the sum; a rest
 * on which no column does work separates b from all of them.
 */
typedef struct nonnegative {
  int rows, n;          /* entries of a column; columns taken, at most rows */
  double *b, *rest;     /* [rows] */
  double *G;            /* [rows*rows] columns taken */
  double *x;            /* [rows] their factors */
  double *y, *Q, *work; /* [rows], [rows*rows], [4*rows] workspace */
} nonnegative;

status nonnegative_new(int rows, nonnegative *s);
/* No column is taken yet; b is set. */
void nonnegative_begin(nonnegative *s);
/* Where the next column[rows] goes; NULL: already as many columns as rows. */
double *nonnegative_next(const nonnegative *s);
/* Take it, drop those with factor zero. 0: no progress. */
int nonnegative_take(nonnegative *s);
