/*
 * The parts of the goals: quantities as functions of displacements and contact
 * forces (quantity.c), those of a pressure (pressure.c), means (mean.c),
 * the contact surface as the estimate sees it (surface.c). Private to
 * src/effects/goal.
 */
#pragma once

#include "effects/shared.h"

/* A mean over the area or the volume of a group. */
typedef struct goal_mean {
  int group_id, component;
  double factor; /* of the integral, sign included, 1/m2 */
} goal_mean;

/* What forms share; NULL: zero. */
typedef struct goal_shared {
  double *rest;   /* [3*n_elem] of goal_add_thermal */
  int *region;    /* [n_elem] space_region */
  double *volume; /* [n_elem] what interfaces beyond their chords give to an
                     element, m3 */
  double *strain; /* [ns*n_elem] of J that is an integral of stress : strain,
                     what it has by them besides its density times that, m3 */
} goal_shared;

/* A quantity J at r->now, with its derivatives. */
typedef struct goal_form {
  double value;
  double *load; /* [dim*n_node] by displacements of nodes, global components */
  double *rows; /* [dim*n] by contact unknowns */
  double *psi;  /* [dim*n] by contact forces, contact frame */
  double *tau;  /* [ns*n_elem] by strains, per volume; NULL: of no goal */
  fracture_linear factor; /* of a stress intensity factor; all-zero: of none */
  double radius, factors; /* radius and size of goal_result */
  int n_mean;
  goal_mean mean[2]; /* [n_mean] of a displacement */
  int has_tau;
  int sums;           /* 1: a sum over the increments, of which rows are the
                         derivative by the motion of the last */
  int is_field;       /* 1: psi are the components of a vector that is smooth
                         along the surface */
  double spin[3];     /* the axis of a moment, else 0 */
  int is_still;       /* 1: work of friction where nothing slips so far */
  int is_coarse;      /* 1: a mean over less than two elements to each side, or
                         few elements round a tip */
  int is_front;       /* 1: a factor in space */
  int is_square;      /* 1: the energy, whose error has a quadratic part too */
  double curved;      /* contact forces times what psi is between the nodes more
                         than at them; what of the body is beyond its faces */
  double beyond;      /* of the latter the sum of the magnitudes */
  double size;        /* sum of the magnitudes that value is the sum of */
  double held;        /* what forces of held nodes, in none of them, may be */
  double rough;       /* what the integral of a factor lacks, what a pressure or
                         a width is else than its mean */
  goal_shared of_all; /* borrowed */
  goal_verdict why;   /* GOAL_RELIABLE: it has a value */
} goal_form;

/* v[dim] to length 1, unless that is 0, by hypot; the length. */
static inline double goal_make_unit(int dim, double *v) {
  double size = 0.0;
  for (int c = 0; c < dim; ++c) size = hypot(size, v[c]);
  for (int c = 0; c < dim && size > 0.0; ++c) v[c] /= size;
  return size;
}

status goal_form_new(const run *r, goal_form *f);
/* quantity.c: *f of a goal. ERR_MEMORY. */
status goal_form_set(run *r, const goal_card *g, goal_form *f);
/* pressure.c: the mean of a pressure round a point; the width of a zone. */
status goal_set_pressure(const run *r, const goal_card *g, goal_form *f);
status goal_set_width(const run *r, const goal_card *g, goal_form *f);

/* Of edges, faces and elements with data that formulas give. */
enum { GOAL_PIECES = 16 };

/* mean.c: adds a mean times a sign; what of the means is in the bubbles.
 * ERR_MEMORY. */
status goal_add_mean(const run *r, int group_id, int component, double sign,
                     goal_form *f);
double goal_mean_bubbles(const run *r, const goal_estimator *e,
                         const goal_form *f);
/* 1: the faces of a contact have one thickness, so that forces per length are
 * pressures times it. */
int goal_has_one_thickness(const run *r, int contact_id);

/* boundary.c: b[n] barycentric coordinates of point k of n * pieces in a
 * simplex of n corners: Gauss points, n of each of its pieces, of degree 3 on a
 * line, else 2; pieces = 2^i. */
void goal_rule_point(int n, int k, int pieces, double *b);
/* where[n_node]: contact node of a mesh node, or -1; new. */
status goal_places(const run *r, int **where);
/* Adds dF[dim*n_node] of its head. ERR_MEMORY. */
status goal_add_boundary(const run *r, double *dF);
/* The same of curved interfaces between regions, of which the chord moves a
 * part from one to the other; to->region, volume, strain: NULL if there is one
 * region.
 * ERR_MEMORY. */
status goal_add_interfaces(const run *r, const space_recovery *of, double *dF,
                           goal_shared *to);
int goal_load_varies(const load *l); /* 1: from place to place */
/* volume[n_elem] += what of the body is beyond the faces of each element, m3.
 * ERR_MEMORY. */
status goal_volumes_beyond(const run *r, double *volume);
/* The same of sides of a group of elements to others of their region. */
status goal_volumes_of(const run *r, const mesh_group *g, const int *region,
                       double *volume);
/* What a mean, without its sign, has by the surface beyond the faces. */
status goal_beyond_mean(const run *r, const goal_mean *w, double mean,
                        double *sum);

/* heat.c: adds dF[dim*n_node] of its head; *rest[3*n_elem], new: integrals
 * of d0 over the elements; NULL: no thermal strain. ERR_MEMORY. */
status goal_add_thermal(const run *r, double *dF, double **rest);
/* Component c of the integral of E d0 over an element. */
double goal_thermal_rest(const run *r, int elem_id, const double *rest, int c);

/* The border of the bodies, of a mesh. */
typedef struct goal_border {
  int n, *side;  /* [n] of mesh_border */
  double *angle; /* [n_node] of the body at the nodes, rad; in space NULL */
} goal_border;
status goal_border_new(const mesh *m, goal_border *b); /* support.c */
/* boundary.c: *out is m with more faces, the sides of the border that are none:
 * arrays of faces are new, all else is borrowed. ERR_MEMORY. */
status goal_add_faces(const mesh *m, const goal_border *b, mesh *out);

/* jumps.c */
/* 1: no stress that is continuous at a node has the loads of two sides with
 * normals n[dim], m[dim]; smooth: they are one side. */
int goal_is_torn(int dim, const side_load *p, const double *n,
                 const side_load *q, const double *m, int smooth);
/* 1: node i is on a plane of symmetry along tangent a, or on the axis. */
int goal_is_mirrored(const run *r, int i);
/* corner[n], zero: how sharply the gap turns at closed nodes in the plane, by
 * the pressure that it makes within an edge over the largest of the contact; 0
 * where it turns as much all along. Above GOAL_CORNER it is part of an infinite
 * pressure, or of one that the mesh does not have. */
#define GOAL_CORNER 0.05
status goal_corners(const run *r, const int *where, double *corner);
/* The largest corner above that of a contact within a radius of x[dim]. */
status goal_sharpest(const run *r, int contact_id, const double *x,
                     double radius, double *most);

/* boundary.c: s->bent. */
status goal_add_bent(const run *r, const smooth_faces *rings, goal_surface *s);
/* support.c: s->given, then what supports and interfaces between the regions
 * "of" add to s->ends. */
status goal_add_given(const run *r, goal_surface *s);
status goal_mark_supports(const run *r, const goal_border *border,
                          const space_recovery *of, goal_surface *s);
/* surface.c */
status goal_surface_new(const run *r, const goal_border *border,
                        const space_recovery *of, goal_surface *s);
/* The contact nodes of a plane contact in the order along it. */
typedef struct goal_line {
  int n, peak; /* peak: place of the peak */
  int *node;   /* [n] */
  double *s;   /* [n] along the faces from the peak, m */
  double *at;  /* [contact nodes] the same by node; NAN: not on the line */
} goal_line;
/* Of the nodes on both sides of a peak; new. ERR_MEMORY. */
status goal_line_new(const run *r, const goal_card *g, int peak, goal_line *l);
/* between.c */
/* 1: the friction of contact node q, closed or not, has reached its limit. */
int goal_slides(const run *r, int q);
/* Of an edge: */
/* x[3]: point k of GOAL_PIECES of an edge between a[dim] and b[dim], on the arc
 * that the surface of the body is, out[dim] from the middle of the edge. */
void goal_point_of(int dim, const double *a, const double *b, const double *out,
                   int k, double *x);
/* d[GOAL_PIECES + 1] less the line through its ends. */
void goal_take_line(double *d);
/* The middle of the parabola that is zero at the ends and has the integral of
 * d[GOAL_PIECES + 1]; *rough that of one with the integral of the size of what
 * they differ by. */
double goal_parabola(const double *d, double *rough);
/* Work of the tractions of closed edges along the surface less that of their
 * nodes: *turn, that of their directions on y[dim*n_node], which beyond the
 * chords is by spin more, 1 about the axis [3]; *area, in the plane, that of
 * a given friction on z by the length of the surface more than that of the
 * chords. */
status goal_work_between(const run *r, const goal_surface *s, const double *y,
                         const double *z, const double *spin, double *turn,
                         double *area);
/* Of edges whose nodes slip: by what the friction value is else than linear. */
status goal_value_between(const run *r, const goal_surface *s, const double *z,
                          double *sum);
/* What J, whose derivative by friction is z[dim*n_node], may lack by edges
 * within which friction turns back or may stop, or gap or friction value are
 * rougher than a
 * parabola, F[dim*n_node] the forces of the adjoint: *sum; product[n_elem] or
 * NULL: the elements have it more. */
status goal_add_doubts(const run *r, const goal_surface *s, const double *z,
                       const double *F, double *product, double *sum);
