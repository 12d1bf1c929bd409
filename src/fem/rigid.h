/*
 * Rigid motions that *BOUNDARY leaves free, and what they require of the
 * condensed problem: no force for a motion, A R_c = 0, and the same resultant
 * of the loads, R_c' f_c = R' F. Springs and factor violate both by rounding,
 * which a contrast of stiffness in the body magnifies. Private to src/fem.
 *
 * R: displacement of all unknowns in the motions, R_c: of the contact ones.
 */
#ifndef PROTIS_FEM_RIGID_H
#define PROTIS_FEM_RIGID_H

#include "fem/stiffness.h"

/* Motion of a piece: u(x) = t + w x p, p = (x - centre)/size, as rotations and
 * translations (2-D: w, tx, ty; axisymmetric: ty; 3-D: wx, wy, wz, tx, ..). */
typedef struct rigid_modes {
  int dim, modes; /* coefficients per piece: 3, 1 or 6 */
  double centre[3], size;
} rigid_modes;

/* Coefficients of the displacement along "direction" at x: row[modes]. */
void rigid_row(const rigid_modes *r, const double *x, const double *direction,
               double *row);

typedef struct rigid_body {
  int id; /* as in free_motion */
  rigid_modes at;
  int n, k;           /* coefficients (all pieces); free motions */
  double *Y;          /* [n*k] the motions */
  int n_node;         /* nodes of the body */
  int *node, *column; /* [n_node], and the first coefficient of its piece */
  double *load;       /* [n] resultants of the pieces */
  int first;          /* of its columns in Q */
} rigid_body;

typedef struct rigid_set {
  int n_body, capacity;
  rigid_body *body;
  int m, k;  /* contact unknowns; motions of all bodies */
  double *Q; /* [m*k] R_c of orthonormal motions */
} rigid_set;

/* domain_free_motions, and floating[n_node] (or NULL): 1 on the nodes of
 * bodies with such motions. r (or NULL): all-zero before, filled with them in
 * coefficients (support.c), those free to rounding. */
status support_motions(const domain *d, int *n, free_motion **list,
                       unsigned char *floating, rigid_set *r);

void rigid_release(rigid_set *r); /* accepts an all-zero object */
/* Choose the motions Y so that their R_c is orthonormal, and store it. */
status rigid_orthonormalise(const stiffness *k, const domain *d, rigid_set *r);
/* Contact unknowns to hold a body, as many as its motions and as independent as
 * possible: pinned[m] set to 1. */
status rigid_pin(const rigid_set *r, const rigid_body *b,
                 unsigned char *pinned);
/* A <- (I - Q Q') A (I - Q Q'), symmetric to the last bit; upper triangle
 * read. */
status rigid_project(const rigid_set *r, double *A);
/* Gather R' load for rigid_balance: load[dim*n_node] in local components. */
void rigid_loads(const stiffness *k, const domain *d, rigid_set *r,
                 const double *load);
/* f_c += Q (R' load - Q' f_c). */
void rigid_balance(const rigid_set *r, double *f_c);

#endif
