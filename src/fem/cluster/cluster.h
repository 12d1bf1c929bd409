/*
 * Clusters: disjoint sets of some ten triangles or thirty tetrahedra of one
 * section, over which the change of volume is averaged, so that P1 elements do
 * not lock in a nearly incompressible body. With t = tr e and <t> its mean over
 * the cluster, the strain that the law sees is
 *
 *   A e = e + share/3 (<t> - t) I,          K = sum w B' A E A B.
 *
 * A is symmetric under the weights w, so K is symmetric and, with E, positive
 * definite; A leaves a uniform strain unchanged, so patch tests are passed. The
 * stress in equilibrium with the nodal forces is A sigma.
 *
 * share = 1 makes the pressure one constant per cluster, with P1 displacements
 * (Stenberg, Math. Comp. 42, 1984, 9-23): stable without spurious pressures
 * where at most 3 clusters (4 in 3-D) meet at an inner node, which clusters
 * grown from the stars of nodes that are no neighbours give but for few. A
 * share below 1 keeps the fluctuations within a cluster with a modulus of their
 * own, (1 - share)^2 times that of the volume, of the size of the shear
 * modulus: cluster_share(). Stability is unaffected, and pressures are more
 * accurate.
 */
#pragma once

#include "mesh/mesh.h"

typedef struct cluster_set {
  int n;             /* clusters */
  int *of;           /* [n_elem] cluster of an element, -1: none */
  int *start, *elem; /* [n+1], elements of a cluster ascending */
  int *first, *node; /* [n+1], its nodes ascending */
  double *share;     /* [n] - */
  double *weight;    /* [n_elem] part of its cluster's volume, - */
  double *mean[2];   /* [n] <t> of strains and of stresses, the last added */
} cluster_set;

typedef struct cluster_input {
  const mesh *mesh;
  int axisymmetric;
  int n_section;
  const int *section_id; /* [n_elem] */
  const double *share;   /* [n_section] 0: the section has no clusters */
} cluster_input;

/* *out is new, NULL if no section has any. ERR_MEMORY. */
status cluster_new(const cluster_input *in, cluster_set **out);

/* The share for the elasticity E[ns*ns], Pa: what exceeds the ratio of bulk to
 * shear modulus that nu = 0.4 has; all of it if the section flows. */
double cluster_share(int ns, const double *E, int flows);

/* Averaging of strains or stresses, elements one by one (t[ns], the diagonal
 * first): begin, add all elements of the clusters, then smooth each. c may be
 * NULL: nothing is done. */
typedef enum { CLUSTER_STRAIN, CLUSTER_STRESS } cluster_field;
void cluster_begin(cluster_set *c, cluster_field f);
void cluster_add(cluster_set *c, cluster_field f, int elem_id, const double *t);
void cluster_smooth(const cluster_set *c, cluster_field f, int elem_id,
                    double *t);

/* v[4]: what the law sees, with that share, of a hoop strain that varies by 1
 * within an axisymmetric element and has no mean over it. */
static inline void cluster_hoop(double share, double *v) {
  v[0] = v[1] = -share / 3.0;
  v[2] = 1.0 - share / 3.0;
  v[3] = 0.0;
}
