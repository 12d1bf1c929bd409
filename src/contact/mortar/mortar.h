/*
 * Coupling of a slave and a master surface of P1 faces (2-D: edges, 3-D:
 * triangles) by the mortar method with a dual basis: Wohlmuth, Acta Numerica 20
 * (2011); Popp, Gee, Wall, IJNME 79 (2009).
 *
 * For each slave face the master faces are projected along its normal into its
 * plane and clipped with it. On the covered part of the face
 *   int psi_j phi_k = delta_jk int phi_j,   sum psi = 1,
 * also where only a part is covered (Cichosz, Bischoff, CMAME 200 (2011)), and
 *   D_j = int phi_j,   P_jl = int psi_j phi_l / D_j,   sum_l P_jl = 1.
 *
 * The partner of a point of the slave is the nearest face on the line through
 * the point in the direction of the slave's normal, on either side of it, if
 * that is a face of the master that opposes the slave face: the product of the
 * unit normals is below 0 by more than rounding. Other faces hide what is
 * behind them on their side: those of the master that do not oppose, and those
 * of the slave but for the face itself and its neighbours. So the back of a
 * thin body or the far side of a ring is no partner, provided that the groups
 * hold the faces in between. Nothing is a partner beyond the diagonal of the
 * box round the larger surface.
 *
 * A node carries no multiplier if the caller says so, if both surfaces have it,
 * or if less than 1 % of its area is covered. On the faces around it the
 * multipliers of the other nodes take over (sum psi = 1), and it is in P
 * among the masters: int psi_j is then more than D_j. A face without any node
 * left carries nothing.
 */
#ifndef PROTIS_MORTAR_MORTAR_H
#define PROTIS_MORTAR_MORTAR_H

#include "contact/mortar/links.h"
#include "mesh/mesh.h"

typedef struct mortar_input {
  const mesh *mesh;
  int n_slave, n_master;     /* faces */
  const int *slave, *master; /* face ids of mesh->face, each once */
  const double *x;           /* [dim*n_node] places of the nodes, m */
  const double *face_weight; /* [n_face] thickness, m; 1 in 3-D and
                                axisymmetric bodies */
  int axisymmetric;          /* once around the axis: weight 2 pi r */
  int slave_normal;          /* 1: normals of the slave alone; 0: mean of both
                                sides */
  const unsigned char *dropped; /* [n_node] 1: carries no multiplier; NULL */
} mortar_input;

typedef struct mortar {
  int n;          /* slave nodes with a multiplier; 0: nothing in common */
  int *node_id;   /* [n] ascending */
  double *area;   /* [n] D_j, m2 */
  double *share;  /* [n] int psi_j / D_j, - */
  double *lever;  /* [dim*n] int psi_j x / D_j, m */
  double *normal; /* [dim*n] outward of the slave, unit length */
  double *gap;    /* [dim*n] sum P_jl x_l - x_j, m */
  node_links to;  /* row q: node_id[q]; parts alike for all components */
  /* For messages */
  int n_dropped;   /* slave nodes left out: said by the caller, or common */
  int n_scant;     /* covered, but by less than 1 % */
  int n_uncovered; /* without any partner */
  int n_bare;      /* faces covered but without a node that carries */
  int scant_node;  /* one of n_scant, -1: none */
  double covered;  /* area of the slave that has a partner, m2 */
  double slave_area, master_area;
  double size_ratio; /* mean size of master faces over that of slave faces,
                        where they are coupled, -; 0 if nothing is */
  long clips;        /* pairs of faces clipped */
} mortar;

/* *out is new, also if n = 0. ERR_MEMORY. */
status mortar_couple(const mortar_input *in, mortar **out);
void mortar_free(mortar *m); /* accepts NULL */

#endif
