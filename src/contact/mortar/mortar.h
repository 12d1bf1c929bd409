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
 * of the slave but for the face itself and its neighbours; and the back of the
 * slave's body, where the line leaves it, hides itself and what is behind it
 * (back.c). So the far side of a ring is no partner, provided that the groups
 * hold the faces in between. Nothing is a partner beyond the diagonal of the
 * box round the larger surface.
 *
 * Where partners of a node lie at two heights, one behind a step, the node
 * meets the nearer alone (step.c), as beyond an edge.
 *
 * Where the bodies differ in thickness they touch over the smaller one. The gap
 * is that of curved surfaces, if the faces are those of one (bulge.c): two
 * meshes of one circle have none, up to h^4/R^3, where their faces are apart by
 * h^2/8R.
 *
 * A node carries no multiplier if the caller says so, if both surfaces have it,
 * or if less than 1 % of its area is covered. On the faces around it the
 * multipliers of the other nodes take over (sum psi = 1), and it is in P
 * among the masters: int psi_j is then more than D_j, and what a node is
 * relative to, as an average, is (u_j - sum_l P_jl u_l) D_j / int psi_j. A face
 * without any node left carries nothing.
 */
#pragma once

#include "mesh/mesh.h"

/*
 * Nodes that move with others: the relative displacement of a node takes the
 * place of its own. Row q belongs to one node, component c of it is
 *   w_c = F_c . (u(node) - sum part_c u(master)),
 * F_c the row of its frame (the unit vector c where it has none). The parts of
 * a component sum to 1, or all are 0: then w_c = F_c . u(node).
 */
typedef struct node_links {
  int dim, n;    /* 2 or 3; rows */
  size_t *start; /* [n+1] masters of row q: start[q] .. start[q+1] */
  int *master;   /* [start[n]] mesh nodes */
  double *part;  /* [dim*start[n]] of each component, - */
} node_links;

/* Nodes of *TIE: w = 0, but a component whose parts are 0 is that of a
 * support. */
typedef struct tie_set {
  int n;
  int *node_id;  /* [n] ascending, none a contact node */
  node_links to; /* row q: node_id[q] */
  int *tie_id;   /* [n] its *TIE */
} tie_set;

/* What acts on tied nodes goes to their masters, but for components of
 * supports: F[dim*n_node]. No node may be tied to itself, by any way. */
void ties_share(const tie_set *t, double *F);

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
  int flat;                  /* 1: the gap is that of the faces as they are */
  const unsigned char *dropped; /* [n_node] 1: carries no multiplier; NULL */
  /* [n_node] bit c: in a plane of symmetry across direction c; NULL */
  const unsigned char *mirrored;
} mortar_input;

typedef struct mortar {
  int n;          /* slave nodes with a multiplier; 0: nothing in common */
  int *node_id;   /* [n] ascending */
  double *area;   /* [n] int psi_j, m2 */
  double *share;  /* [n] int psi_j / D_j, - */
  double *whole;  /* [n] D_j if all of its faces were covered, m2 */
  double *lever;  /* [dim*n] int psi_j x / int psi_j, m */
  double *normal; /* [dim*n] outward of the slave, unit length */
  double *gap;   /* [dim*n] (sum P_jl x_l - x_j) D_j / int psi_j, less what both
                    surfaces have beyond their faces, along the normal, m */
  node_links to; /* row q: node_id[q]; parts alike for all components */
  /* For messages */
  int n_dropped;     /* slave nodes left out: said by the caller, or common */
  int n_scant;       /* covered, but by less than 1 % */
  int n_uncovered;   /* without any partner */
  int n_bare;        /* faces covered but without a node that carries */
  int n_cut;         /* faces of which a part has no partner */
  int *cut;          /* [n_cut] of mesh->face */
  double covered;    /* area of the slave that has a partner, m2 */
  double size_ratio; /* mean size of master faces over that of slave faces,
                        where they are coupled, -; 0 if nothing is */
} mortar;

/* *out is new, also if n = 0. ERR_MEMORY. */
status mortar_couple(const mortar_input *in, mortar **out);
