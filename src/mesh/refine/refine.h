/*
 * A mesh of triangles or tetrahedra made finer by bisection of longest edges
 * (Rivara, Int. J. Num. Meth. Engng. 20 (1984)), before it is checked: groups
 * of all dimensions are split with it, all nodes of the mesh stay.
 */
#pragma once

#include "mesh/msh/raw_mesh.h"

/* Lengths that elements shall have, at the nodes of a mesh; borrowed. */
typedef struct refine_sizes {
  int dim, n_elem;
  const double *x;  /* [dim*n_node] m */
  const int *elem;  /* [(dim+1)*n_elem] */
  const double *at; /* [n_node] m */
} refine_sizes;

typedef struct refine_request {
  refine_sizes sizes;
  double scale;              /* of the coordinates of the raw mesh, - */
  int n_round;               /* groups of faces that may be curved: */
  const char *const *rounds; /* [n_round] their names */
} refine_request;

/*
 * Elements longer than their size, as edges of a regular element of the same
 * measure, are bisected until none is; none is made larger. A new node is the
 * middle of its edge, but on faces of the groups that may be curved, where it
 * is on a curve through the nodes that is exact for circles and spheres. There
 * edges that turn by more than 30 degrees are corners, and what is flat at one
 * end of an edge stays flat. ERR_MEMORY.
 */
status raw_refine(raw_mesh *raw, const refine_request *q);
