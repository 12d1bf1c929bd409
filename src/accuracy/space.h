/*
 * Error of the mesh, estimated from recovered stresses: the stress of P1
 * elements jumps from element to element, a polynomial fitted to it round each
 * node does not; their difference measures the error of the elements in the
 * energy norm (Zienkiewicz, Zhu 1992, Int. J. Num. Meth. Eng. 33, 1331-1364 and
 * 1365-1382). Fits stay on one side of an interface between materials, where
 * the stress of the solution jumps itself.
 */
#pragma once

#include "fem/fem.h"

typedef struct space_recovery space_recovery; /* data of the mesh */

/* Energy norms, sqrt(J): |v|^2 = integral of sigma' inv(E) sigma. */
typedef struct space_error {
  double error;    /* estimated |u - u_h|, sqrt(J) */
  double norm;     /* |u_h|, sqrt(J) */
  double relative; /* error / sqrt(norm^2 + error^2), -; 0 without stress */
} space_error;

/* S[ns*ns] = inv(E) of a section over the components that carry stress, 1/Pa,
 * else zero: plane stress leaves zz out. */
status space_compliance(const domain *d, int section, double *S);

/* Patches of elements for the domain (borrowed); *out is new. ERR_MEMORY. */
status space_recovery_new(const domain *d, space_recovery **out);

/*
 * Estimate for the stresses sigma[ns*n_elem] (domain_stress), Pa, with the
 * moduli of the domain now. eta[n_elem] or NULL: contribution of each element
 * to |u - u_h|, sqrt(J). ERR_INTERNAL: moduli that are not positive definite.
 */
status space_estimate(space_recovery *s, const double *sigma, double *eta,
                      space_error *out);

/* Elements across the body, by the share of the nodes inside it; 1: so few that
 * most fits lie on one side of their node, the estimate may have half of the
 * error. */
double space_depth(space_recovery *s);
int space_is_coarse(double depth);

/* For other errors by the same patches. Sets of sections of one material, which
 * an element belongs to; nodal values value[nq*n_node] recovered from
 * q[nq*n_elem] at the nodes of one. */
int space_regions(const space_recovery *s);
int space_region(const space_recovery *s, int elem_id);
void space_recover(space_recovery *s, int region, int nq, const double *q,
                   double *value);
/* For many of them: the fits are made once. ERR_MEMORY. */
status space_keep(space_recovery *s);
/* A stress and what is recovered from it in the region of an element: [ns] per
 * element and node, Pa. */
typedef struct space_field {
  const double *element, *node;
} space_field;
/* The moduli of the domain now, for the products; ERR_INTERNAL as above. */
status space_moduli(space_recovery *s);
/* S[ns*ns] of space_compliance for an element, of the moduli then. */
const double *space_compliance_of(const space_recovery *s, int elem_id);
/* Integral of d_a' inv(E) d_b over an element, d recovered less own, J; that of
 * d_b' inv(E) d_b in *square. */
double space_product(const space_recovery *s, int elem_id, const space_field *a,
                     const space_field *b, double *square);

/*
 * Lengths size[n_node] of the elements of the next mesh for which |u - u_h| is
 * to become "target" with the fewest elements, from eta[n_elem], both sqrt(J).
 * No length changes by more than a factor of 4 down (10 if the error is
 * within a factor of 8 of the target) or 2 up.
 */
void space_sizes(const mesh *m, const double *eta, double target, double *size);
/* The lengths size[n_node] that it has. */
void space_lengths(const mesh *m, double *size);
/* How many times the elements a mesh of these sizes has, about, -; that with
 * the fewest for which |u - u_h| is "target", which passes come to. */
double space_growth(const mesh *m, const double *size);
double space_growth_to(const mesh *m, const double *eta, double target);
