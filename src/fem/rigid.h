/*
 * Rigid motions that *BOUNDARY leaves free, and what they require of the
 * condensed problem: no force for a motion, A R_c = 0, and the same resultant
 * of the loads, R_c' f_c = R' F. Springs and factor violate both by rounding,
 * which a contrast of stiffness in the body magnifies. Private to src/fem.
 *
 * R: displacement of all unknowns in the motions, R_c: of the contact ones,
 * which are relative displacements at pairs (contact/mortar/mortar.h).
 */
#pragma once

#include "fem/stiffness.h"

/* Motion of a piece: u(x) = t + w x p, p = (x - centre)/size, as rotations and
 * translations (2-D: w, tx, ty; axisymmetric: ty; 3-D: wx, wy, wz, tx, ..). */
typedef struct rigid_modes {
  int dim, modes; /* coefficients per piece: 3, 1 or 6 */
  double centre[3], size;
} rigid_modes;

/* Coefficients of the displacement along "direction" at x: row[modes]. */
void modes_row(const rigid_modes *r, const double *x, const double *direction,
               double *row);
/* Name the motion v[modes]: "translation along x", "rotation about (1, 2)". */
void modes_text(const rigid_modes *at, const double *v, char *text,
                size_t size);

/* One component of a node: direction . (u(node) - sum part u(master)). */
typedef struct component {
  int node, c;
  double direction[3];
  const node_links *links; /* its masters: row "row"; NULL: none */
  int row;
} component;

/* Component c of node i, contact node q or -1: in the frame of q, relative
 * where q is. */
component node_component(const domain *d, int i, int q, int c);
/* Terms of the sum: the node, then its masters. */
int component_terms(const component *x);
/* Node of term t, and its factor; 0: no such term in this component. */
double component_term(const component *x, int t, int *node);

/* Bodies joined by pairs and ties (sets.h) with motions that supports, hinges
 * and ties leave. */
typedef struct rigid_set {
  int n;           /* coefficients: those of its pieces one after the other */
  int n_motion, k; /* motions left; those left to rounding */
  double weakest;  /* resistance to one of the others, of the largest */
  double *Y;       /* [n*k] the latter */
  int *owner;      /* [n] body of a coefficient */
  int n_node;      /* nodes with unknowns that move with it: its own, and */
  int *node;       /* nodes at rest that have masters in it */
  double *load;    /* [n] resultants of the pieces */
  int first;       /* of its columns in Q */
} rigid_set;

typedef struct rigid_motions {
  rigid_modes *at; /* [n_body] */
  int *body;       /* [n_node] body of a node, -1 */
  int *column;     /* [n_node] first coefficient of its piece in those of the
                      set, -1: at rest */
  int n_body, n_set, capacity;
  rigid_set *set;
  int m, k;  /* contact unknowns; motions of all sets */
  double *Q; /* [m*k] R_c of orthonormal motions */
} rigid_motions;

/* The motions that supports, hinges and ties leave; r: all-zero before, filled
 * with the sets that have some. */
status rigid_find(const domain *d, rigid_motions *r);

/* Choose the motions Y so that their R_c is orthonormal, and store it.
 * ERR_SINGULAR: one of them moves no contact unknown. */
status rigid_orthonormalise(const stiffness *k, const domain *d,
                            rigid_motions *r);
/* Contact unknowns to hold a set, as many as its motions and as independent as
 * possible: pinned[m] set to 1. */
status rigid_pin(const rigid_motions *r, const rigid_set *s,
                 unsigned char *pinned);
/* A <- (I - Q Q') A (I - Q Q'), symmetric to the last bit; upper triangle
 * read. */
status rigid_project(const rigid_motions *r, double *A);
/* Gather R' F for rigid_balance: load[dim*n_node] forces at the unknowns, T'F
 * (stiffness.h) in local components. */
void rigid_loads(const stiffness *k, const domain *d, rigid_motions *r,
                 const double *load);
/* f_c += Q (R' F - Q' f_c). */
void rigid_balance(const rigid_motions *r, double *f_c);
