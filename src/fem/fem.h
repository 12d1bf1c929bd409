/*
 * P1 finite elements: stiffness, its condensation to the contact nodes with
 * one sparse factor, interior solves with the same factor, strains, stresses,
 * internal forces and the exact load vectors of P1 data.
 *
 * Degrees of freedom: dim per node, global components, except that a contact
 * node counts in its contact frame (n, t1[, t2]; u = basis a).
 */
#pragma once

#include "fem/cluster/cluster.h"
#include "base/archive/archive.h"
#include "contact/operator.h"
#include "contact/surface.h"
#include "material/material.h"

/* Strains without stress (thermal, inelastic) of some elements:
 * sigma = E (e - e0). The others have none. */
typedef struct eigenstrain {
  int n;
  const int *elem_id; /* [n] ascending */
  const double *e0;   /* [ns*n] -; NULL: 0 (eigen_stress) */
} eigenstrain;

/* Nodes with unknowns in the order of a factor of the whole stiffness, and what
 * that takes. */
typedef struct whole_order {
  int n, *node;     /* [n], owned */
  const char *name; /* of the method */
  double flops, entries;
  double contact_flops, contact_entries; /* where contact unknowns have part */
  double interior_entries; /* the same without their rows and columns, about */
} whole_order;

/* What the elements are made of. */
typedef struct domain {
  const mesh *mesh;
  const contact_surface *surface; /* NULL: no contact */
  int ns;                         /* 4 or 6 */
  const int *section_id;          /* [n_elem] */
  const int *origin;              /* [n_section] one it is of one material with,
                                     itself or before it; NULL: not known */
  const int *zone;                /* [n_elem] from 0: thermal strains may jump
                                     where it changes; NULL: nowhere */
  const kinematics *kin;          /* [n_section] */
  const double *thickness;        /* [n_section] m; 1 in 3-D and axisymmetric */
  const double *E;                /* [ns*ns*n_section] Pa */
  const double *C;                /* [36*n_section] Pa, for e_zz of plane
                                     stress; NULL: 0 */
  const unsigned char *fixed;     /* [dim*n_node] 1: prescribed (global
                                     components) */
  const eigenstrain *eigen;       /* NULL: none. Counts in stresses and
                                     energy; condense_load has it from F
                                     (eigen_force) */
  /* Elements whose change of volume is averaged, as strains and stresses here
   * always are; NULL: none. Its means are overwritten. */
  cluster_set *cluster;
  const tie_set *ties; /* NULL: none */
  const unsigned char
      *rubs;  /* [n_contact] 1: there is friction; NULL: at all */
  int rows;   /* contact unknowns of a node that are condensed, the normal
                 first: 1 (its tangents count in the interior) or dim; 0:
                 dim */
  int sparse; /* 1: the condensed matrix is not formed: an operator */
  const whole_order *order; /* for it, borrowed; NULL: not known */
  int n_in;      /* contact nodes that are condensed; the others are interior */
  const int *in; /* [n_in] ascending; NULL: all */
} domain;

/* B of one element, nothing averaged: e = B u_e, B[ns*(dim+1)*dim] column
 * major; returns the weight (volume, thickness or 2 pi r included). */
double element_strain(const domain *d, int elem_id, double *B);
double element_weight(const domain *d, int elem_id);
/* sigma[ns] = E e of an element. */
void element_stress(const domain *d, int elem_id, const double *e,
                    double *sigma);

typedef struct stiffness stiffness; /* sparse K of the free unknowns */
typedef struct condensed condensed; /* factor and condensed matrix */

/* The stiffness of the domain; *out is new (memory_free), NULL on failure.
 * ERR_MESH: an element beyond the axis or without volume. ERR_MEMORY. */
status stiffness_assemble(const domain *d, stiffness **out);

/* Order of all nodes with unknowns, contact or not; x[dim*n_node]. o->node is
 * new (memory_free). ERR_MEMORY. */
status stiffness_order(const stiffness *k, const double *x, whole_order *o);

/* What resists a rigid motion that *BOUNDARY leaves free. */
typedef enum {
  HELD_BY_NOTHING,  /* no contact unknown moves with it: no equilibrium */
  HELD_BY_TANGENTS, /* only tangential unknowns without friction do */
  HELD_BY_FRICTION, /* only tangential contact unknowns move with it */
  HELD_BY_CONTACT   /* contact nodes move along their normal (one-sided!) */
} motion_hold;

typedef struct free_motion {
  int set_id;  /* bodies joined by pairs and ties: the first of them */
  int body_id; /* connected set of elements, from 0 in element order; the one
                  that moves most */
  motion_hold held_by;
  size_t elem_no; /* an element of the body, number in the mesh file */
  char text[160]; /* "translation along x", "rotation about (1, 2)" */
} free_motion;

/*
 * The free motions of all bodies without solving anything: how many there are,
 * and those that are held by "most" or less, HELD_BY_NOTHING first in each set
 * of bodies that pairs and ties join; *list[*n] is new (memory_free), NULL if
 * there are none. Joined surfaces count as touching: no gap between them
 * resists a turn of the set.
 */
status domain_free_motions(const domain *d, motion_hold most, int *n_free,
                           int *n, free_motion **list);

/*
 * Order (contact unknowns last), factor K (where contact alone holds a body
 * with springs on as many contact unknowns as it has motions, taken off again),
 * and form
 *   A = K_cc - K_ci inv(K_ii) K_ic   [m*m], m = rows * condensed nodes.
 * Bodies are factored apart. K is borrowed until condensed_free.
 * ERR_SINGULAR: a body that neither supports nor contact hold (the record names
 * one), or K not positive definite. ERR_MEMORY.
 */
status condense(const stiffness *k, const domain *d, condensed **out);
void condensed_free(condensed *c);
/* A [m*m], NULL: d->sparse; then the operator, else NULL. */
const double *condensed_matrix(const condensed *c);
const contact_operator *condensed_operator(const condensed *c);
/* What of the operator follows from its use. */
status condensed_keep(condensed *c, archive *a);
void condensed_product(const condensed *c, const double *u, double *Au);
int condensed_floating(
    const condensed *c); /* 1: a body is held by contact alone */
double condensed_stiffest(const condensed *c); /* largest entry of K, N/m */
/* Estimate of the condition number of K with its unknowns scaled to a unit
 * diagonal (that scaling costs no digits). */
double condensed_condition(const condensed *c);
/* diagonal[m] of the stiffness of the whole body at the contact unknowns, of
 * which condensed_condition is, N/m; of held ones that of the matrix. */
void condensed_diagonal(const condensed *c, double *diagonal);
/* Digits that it leaves at least: 16 less its power of ten, not below 0. */
double condensed_digits(const condensed *c);

typedef struct condense_info {
  long unknowns, contact_unknowns, factor_entries;
  int bodies;
  double flops;
  size_t bytes;
  const char *ordering;
} condense_info;
/* Sizes and work, for the listing. */
condense_info condensed_info(const condensed *c);

/*
 * Condense a load: F[dim*n_node] forces in global components, ud[dim*n_node]
 * prescribed displacements (read where fixed; NULL: all zero). f_c[m]. The
 * forward solve is stored for condense_recover. Where the condition number is
 * far above that of a plain mesh, f_c and u are refined with the forces of the
 * elements (two more solves each; f_c also one back solve), and are then
 * correct to rounding for given u_c.
 */
status condense_load(condensed *c, const double *F, const double *ud,
                     double *f_c);
/* u[dim*n_node] (global components) from u_c[m] for the load last condensed. */
status condense_recover(condensed *c, const double *u_c, double *u);

/* *square = d' inv(A) d of forces d[m], J, by the same factor. Where contact
 * alone holds a body, A is singular: d must be in equilibrium, K'd = 0 with the
 * kernel below. */
status condensed_force_energy(condensed *c, const double *d, double *square);
/* u[m] = inv(A) f of a load f[m], by the same factor: the contact unknowns
 * without contact forces. Nothing floats. ERR_MEMORY. */
status condensed_untouched(condensed *c, const double *f, double *u);
/*
 * Residual of equilibrium by rounding: rest[dim*n_node] = loads less internal
 * forces of the solution, global components; rc[m] the contact forces. With d
 * the residual at the unknowns: w[dim*n_node] = inv(K) d, the error of the
 * displacements, global components, and *square = d' inv(K) d, J, the square of
 * its energy norm.
 */
status condensed_misfit(condensed *c, const double *rest, const double *rc,
                        double *w, double *square);
/* The same where contact holds unknowns, held[m] 1: the residual there is
 * carried by the contact, and w = 0. *square is HUGE_VAL, w untouched, where
 * the others are not held by that. Overwrites what condense_load stores. */
status condensed_misfit_held(condensed *c, const double *rest, const double *rc,
                             const unsigned char *held, double *w,
                             double *square);
/* 1: the condition number is far above that of a plain mesh: the residual
 * matters. */
int condensed_costs_digits(const condensed *c);
/* The motions of whole bodies that contact alone holds, their number: *R[m*k],
 * orthonormal, of the contact unknowns, borrowed. */
int condensed_motions(const condensed *c, const double **R);
/* The motions of the contact unknowns without energy: kernel[m*n], orthonormal,
 * borrowed; returns n, or -1: the supports of a body are negligible (lever arms
 * below 1e-8 of its size). */
int condensed_kernel(const condensed *c, const double **kernel);

/* Strains and stresses of the elements: e[ns*n_elem], sigma[ns*n_elem]; either
 * may be NULL. Plane stress fills e_zz. */
void domain_stress(const domain *d, const double *u, double *e, double *sigma);
/* Internal forces F = sum B' sigma w, global components [dim*n_node]. */
void domain_internal_force(const domain *d, const double *sigma, double *F);
/* The same of the stresses of u, right where held[dim*n_node] is 1: only the
 * elements there are looked at. Not of averaged elements (cluster). */
void domain_held_force(const domain *d, const double *u,
                       const unsigned char *held, double *F);
/* The largest strain, the root of e:e, the largest rotation, of small ones, and
 * the least volume over that of the mesh, not positive where an element is
 * turned inside out, of the elements that might be; 1: none. */
typedef struct deformation {
  double strain, rotation, volume; /* -, rad, - */
  int strain_elem, rotation_elem, volume_elem;
  double gain; /* 1/m, times domain_spread: above strain, rotation, and, below
                  1, no element is turned */
} deformation;
void domain_deformation(const domain *d, const double *u, deformation *out);
/* Largest difference of a displacement between two nodes of an element; largest
 * displacement, where it makes a hoop strain, m. */
double domain_spread(const domain *d, const double *u);
double domain_strain_energy(const domain *d, const double *u); /* J */
/* The same of all elements but n of them, ascending, which hold whole
 * clusters. */
double domain_energy_without(const domain *d, int n, const int *elem_id,
                             const double *u);
/* F += sum B' E e0 w: the forces that hold the strains of x back, global
 * components [dim*n_node], N. */
void eigen_force(const domain *d, const eigenstrain *x, double *F);
/* Strains less e0 and the stresses E times them, of the elements of x alone,
 * which hold whole clusters: e[ns*n] (zz of plane stress not filled),
 * sigma[ns*n], Pa; either may be NULL. */
void eigen_stress(const domain *d, const eigenstrain *x, const double *u,
                  double *e, double *sigma);
/* F += sum B' A sigma w of n elements, which hold whole clusters: sigma[ns*n],
 * Pa; A averages (cluster.h). */
void eigen_add_force(const domain *d, int n, const int *elem_id,
                     const double *sigma, double *F);
