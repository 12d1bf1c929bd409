/*
 * What lcp_run is made of: the inverse of the basis and what it gives
 * (basis.c), who leaves (leaving.c), the change of basis (pivot.c). Private to
 * src/solver/lcp.
 */
#ifndef PROTIS_LCP_PARTS_H
#define PROTIS_LCP_PARTS_H

#include "solver/lcp/lcp.h"

/* Relative to the largest number of the same kind. */
#define TIE 0x1p-42      /* values that count as zero                         */
#define ROUNDING 0x1p-53 /* error of a product, with K: noise */

struct lcp_work {
  int n, cap, s; /* n, cap: of the run, of the blocks */
  double *K;     /* [cap*cap]                                                 */
  double *P;     /* [cap*cap] for a new inverse                               */
  double *lapack; /* [cap]                                                    */
  int *swap; /* [cap]                                                     */
  int *var, *row; /* [cap] columns and rows of P                              */
  int *at_z, *at_w; /* [n+1], [n] their places, -1: none                      */
  double *z, *w;    /* [cap] of var; [n] of the rows not in "row"             */
  double *dz, *dw;  /* the same: change per unit of the entering variable     */
  double *lz, *lw;  /* the same: one column of the inverse                    */
  double *gather, *line; /* [cap]                                             */
  double *column;        /* [n]                                               */
  double *q;             /* [n] scaled                                        */
  int *tie;              /* [n+cap] candidates: a < cap: z; cap + i: w_i      */
  double *key;           /* [n+cap]                                           */
  double power;          /* of two: q of the problem = power q                */
  double size_K;   /* estimate of the largest |K|                         */
  double z0_start; /* z0 after the first pivot                          */
  int entering;    /* k: z_k; -1-k: w_k                                 */
};

/* ---- basis.c ---- */

double lcp_largest(int n, const double *x);
/* to[n] = [M d](:, var) x. While z0 is basic it stands first in var. */
void lcp_expand(lcp_work *w, const lcp_problem *p, const double *x, double *to);
/* to[s] = [M d](i, var) */
void lcp_row_of(const lcp_work *w, const lcp_problem *p, int i, double *to);
/* to[s] = K x[s] */
void lcp_apply_inverse(const lcp_work *w, const double *x, double *to);
/* z = -K q_row, w = q + M z, and the defect of the rows put right once.
 * Returns the defect that was left before, relative. */
double lcp_refresh(lcp_work *w, const lcp_problem *p);
/* A new inverse; 0: P is singular. */
int lcp_invert(lcp_work *w, const lcp_problem *p, lcp_report *rep);
/* Direction of all basic variables for the entering one, corrected once if the
 * inverse has drifted; returns the relative defect before. */
double lcp_direction(lcp_work *w, const lcp_problem *p);

/* ---- leaving.c ---- */

/* What counts as zero beside "size": its share, or what is noise there. */
double lcp_zero(double share, double size, double noise);
/* Candidate that leaves, -1: none (a ray). z0 has the first right: the problem
 * is then solved. */
int lcp_leaving(lcp_work *w, const lcp_problem *p, double *step);

/* ---- pivot.c ---- */

/* One change of basis: c leaves after "step". Sets the next entering one. */
void lcp_pivot(lcp_work *w, const lcp_problem *p, int c, double step);

#endif
