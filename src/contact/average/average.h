/*
 * The nonlocal average of the contact pressure as a sparse matrix.
 *
 *   R(p)(x_i) = sum_j G_ij p_j,   p_j nodal values of a P1 pressure,
 *
 * p being zero outside of the patch (CPR98, 2.7). With l_i the integral of the
 * P1 function phi_i over the patch and g_ij the integral of w(|x_i - y|) phi_j,
 *
 *   l_i G_ij = 1/2 (l_i g_ij + l_j g_ji)  (i != j),
 *   G_ii     = W_i - sum of the others,
 *
 * so that l_i G_ij is symmetric and a constant pressure p gives W_i p exactly.
 * W_i is 1 where the disc of radius rho around x_i lies in the patch, and the
 * part of the kernel's mass found in the patch where it does not. Both g_ij and
 * W_i are integrals of the kernel itself. Where the pairs of a node would
 * exceed its mass they are reduced to it, so that no entry is negative and all
 * change continuously with the radius.
 *
 * A node without another node within rho has its own pressure (G_ii = 1): where
 * the mesh is coarser than rho, friction is local.
 */
#ifndef PROTIS_AVERAGE_AVERAGE_H
#define PROTIS_AVERAGE_AVERAGE_H

#include "contact/average/kernel.h"
#include "base/sparse.h"
#include "base/status.h"

/* Part of a contact surface; the arrays are the caller's. */
typedef struct average_patch {
  int dim;          /* 2: lines in the plane; 3: triangles */
  int axisymmetric; /* 1: the lines turn around the axis x[0] = 0 */
  int n_node, n_face;
  const double *x;             /* [dim*n_node] m */
  const int *face;             /* [dim*n_face] nodes */
  const unsigned char *active; /* [n_node] 0: no contact node, p = 0 there */
} average_patch;

/* A plane x[axis] = least or largest of the patch behind which the surface
 * goes on as its mirror image. */
typedef enum { MIRROR_NONE, MIRROR_MIN, MIRROR_MAX } average_mirror;

typedef struct average_rule {
  kernel kernel;
  double radius;            /* rho, m */
  int normalized;           /* 1: G_ij / W_i: a constant pressure is kept at
                               edges too */
  int geodesic;             /* 1: distance along the lines (plane only), else
                               straight */
  average_mirror mirror[3]; /* by axis; not with geodesic, nor of the radius */
} average_rule;

/* What was found, for messages. */
typedef struct average_facts {
  double longest; /* edge of the patch, m */
  int n_active;   /* nodes that carry pressure */
  int n_coarse;   /* of these, with an edge longer than radius/4 */
  int n_local;    /* of these, without another node within the radius */
} average_facts;

/*
 * G [n_node*n_node], rows and columns of nodes that are not active empty.
 * Time: number of pairs, and n log n for the search. ERR_MEMORY.
 */
status average_build(const average_patch *patch, const average_rule *rule,
                     sparse_rows *out, average_facts *facts);

#endif
