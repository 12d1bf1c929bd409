/* What the files of the contact problem share. */
#pragma once

#include "contact/contact.h"
#include "contact/surface.h"

#include <math.h>

enum { CHUNK = 64 }; /* rows and columns of a product kept on the stack */

/* The larger, the smaller of two, NaN if one is. */
static inline double larger(double a, double b) {
  return b <= a ? a : b > a ? b : a + b;
}
static inline double smaller(double a, double b) {
  return b >= a ? a : b < a ? b : a + b;
}
/* The largest diagonal entry. */
double contact_largest_diagonal(const contact_problem *cp);
/* Stiffness of a node along its normal and in its tangent plane, N/m; the
 * largest diagonal where it has none. */
typedef struct node_step {
  double n, t;
} node_step;
node_step contact_step(const contact_problem *cp, int node_id,
                       double largest_diagonal);
/* Length of v[n], n = 0, 1 or 2; hypot, which takes five times the time, where
 * squares might over- or underflow. */
static inline double contact_length(int n, const double *v) {
  if (n < 2 || v[1] == 0.0) return n > 0 ? fabs(v[0]) : 0.0;
  const double square = v[0] * v[0] + v[1] * v[1];
  if (square > 0x1p-960 && square < 0x1p960) return sqrt(square);
  return hypot(v[0], v[1]);
}

/*
 * The contact frame of one node: rows n, t1[, t2] in two or three dimensions,
 * with the directions that *BOUNDARY fixes as tangents, and with the normals
 * of a second and third obstacle in place of tangents at a corner.
 */

/* Take the fixed components (bit c: component c) out of v[dim] and make it a
 * unit vector. Returns the length that was left over the length before; 0 and
 * v = 0 if nothing was left. */
double frame_project(int dim, unsigned fixed, double *v);

/* Tangents of the first row n of a frame: in 2-D n turned by 90 degrees; in 3-D
 * x (or y, where n is near x) projected, and the cross product. */
void frame_tangents(int dim, double *frame);

/*
 * Complete a frame whose first n_normal rows are unit normals orthogonal to the
 * fixed components. held[dim] is set to 1 for the rows that are fixed
 * directions. Frames of one normal are orthonormal and, but for two fixed
 * components, right handed. 0; -1 if the normals and the fixed directions are
 * (nearly) dependent.
 */
int frame_complete(int dim, int n_normal, unsigned fixed, double *frame,
                   unsigned char *held);

/* 1: two normals, not of unit length, less than 45 degrees apart. */
int frame_is_smooth(int dim, const double *a, const double *b);
/* 1: two unit normals that depend on each other and point to one side. */
int frame_is_same(int dim, const double *a, const double *b);

/* basis[dim*dim], column major: inverse of frame (rows). An orthonormal frame
 * is its own inverse, transposed: no arithmetic then. */
void frame_invert(int dim, int orthonormal, const double *frame, double *basis);

/* Planes at an end of the mesh that hold all their nodes, at least a face,
 * where not all of the mesh is held. */
typedef struct mirrors {
  unsigned planes; /* bit 2c, 2c+1: least, greatest x_c is one */
  double low[3], high[3];
} mirrors;
void mirrors_find(const surface_input *in, mirrors *out);
/* 1: what holds the node is a plane of symmetry, where the normals of its own
 * faces, half of those around it, lean. */
int mirrors_have(const mirrors *s, const surface_input *in, int node_id);
/* at[n_node]: bit c: such a plane across direction c has the node. */
void mirrors_mark(const surface_input *in, unsigned char *at);
/* 1: a surface of the unit normal n at the node is smooth across that plane:
 * the faces next to those of the node lean more. */
int mirrors_bend(const mesh *m, const mesh_group *g, int node_id,
                 unsigned fixed, const double *n);
/* 1: the contact leans where it meets such a plane: the obstacle, if it has a
 * normal of its own, else the body, if it does not bend. */
int mirrors_lean(const surface_input *in, const contact_pair *p, int node_id,
                 const double *normal);

/*
 * Pairs of two surfaces of the mesh in a contact surface: what their nodes are
 * relative to. Private to src/contact.
 */

/* Part of the unit normal that must be left when the fixed components are
 * taken out of it. */
#define PAIR_FIXED_SINE 1e-3

/* The coupling of which a normal of a node is, and its row there. */
typedef struct pair_row {
  const mortar *of; /* NULL: of an obstacle */
  int row;
  int normal; /* which of the node's */
} pair_row;

/* The row of a node of *TIE, -1: it is none. */
int surface_tied(const surface_input *in, int node_id);
/* 1: the normals of two pairs at one node, their rows q and r, are too near to
 * each other for one frame; of one slave surface: smooth. */
int pair_same_normal(int dim, const contact_pair *a, int q,
                     const contact_pair *b, int r);

/* Entries of the rows so far, and room for them; all-zero before. */
typedef struct pair_links {
  int n, n_part, capacity, part_capacity;
} pair_links;

/* The row of contact node i, of the last ones before: its n normals, rows[m] of
 * which those of one normal are for two masters side by side, their mean by
 * area. Its tangents are relative to the master of the first, if it has no
 * other; to none at corners, and where supports hold them but not the masters.
 * ERR_MEMORY. */
status pair_add_row(contact_surface *s, const surface_input *in, int i, int n,
                    int m, const pair_row *rows, pair_links *links);
/* Gap of a row of the coupling along n[dim], at time 0, m. */
double pair_apart(const surface_input *in, const contact_pair *p, int row,
                  const double *n);

/* A row of the frame of a contact node. */
typedef struct surface_row {
  const contact_pair *of;
  int dim;
  const double *x, *normal; /* [dim] place of the node, m; direction */
  double apart;             /* gap of a pair at time 0, m */
} surface_row;

/* Gap of a row, to its obstacle or to the master of its pair, m. */
double pair_row_gap(const surface_row *at, double t);
/* 1: the gap to the obstacle of a contact can change with time. */
int pair_moves(const contact_pair *p);
