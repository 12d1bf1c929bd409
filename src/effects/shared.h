/* What one effect takes from another. */
#pragma once

#include "fracture/fracture.h"
#include "run/run.h"

/* nonlocal.c: [n*n] - of a contact whose law has an average. */
const sparse_rows *nonlocal_average(const run *r, int contact_id);

/* wear.c: the depths so far, *n reals; NULL: nothing wears. */
double *wear_depths(const run *r, size_t *n);
/* To them, what wears off from r->old to r->now; *known = 0: it has a part at
 * corners, which is that from the last increment. ERR_MEMORY. */
status wear_take(run *r, int *known);
/* -, what other depths are else, in the mean square over the surface. */
double wear_difference(const run *r, const double *depth);

/* mesh.c: the patches of elements of r->body.d, made with the elastic matrix of
 * now; borrowed until that changes. *out NULL: the run has no error of the
 * mesh. ERR_MEMORY. */
status mesh_recovery(const run *r, space_recovery **out);

/* sides.c: what loads give at a node of a side, Pa. */
typedef struct side_load {
  double pressure, traction[3];
} side_load;
/* *out, new: [dim*n] of side[n] of mesh_border, node by node. ERR_MEMORY. */
status side_loads_new(const run *r, int n, const int *side, side_load **out);
/* Of what r->result.stress has more or less than loads give on those of side[n]
 * that nothing holds or touches, over the elements behind, J: all of it is
 * error. ERR_MEMORY. */
status free_sides_energy(const run *r, int n, const int *side, double *energy);
/* energy[n_elem]: what obstacles that are in the body between the nodes of
 * their contacts would deform the elements by, or lift it, J. ERR_MEMORY. */
status entered_energy(const run *r, double *energy);

/* sides.c: faces round each node. */
typedef struct smooth_faces {
  size_t *start; /* of number_places */
  int *face;
} smooth_faces;
/* All-zero r is new. ERR_MEMORY. */
status smooth_faces_new(const mesh *m, smooth_faces *r);
/* The sum n[dim] of normals like "own" at a node goes on behind a plane that
 * holds it, but not where it is clamped. */
void smooth_mirror(int dim, const unsigned char *held, const double *own,
                   double *n);
/* Normal n[dim] of the surface at a node of a face with the unit normal own. */
void smooth_normal(const run *r, const smooth_faces *rings, int node,
                   const double *own, double *n);
/* out[dim]: from the middle of an edge of nodes v[2] of a face to the surface
 * of the body, m. */
void smooth_bulge(const run *r, const smooth_faces *rings, int face,
                  const int *v, double *out);

/* The factors of a crack at r->now. */
typedef struct crack_factors {
  int n;
  const fracture_point *points; /* [n] borrowed */
  const fracture_factors *at; /* [n] borrowed until the next ones; NAN: none */
  int is_linear;              /* 1: in displacements and contact forces */
} crack_factors;
/* ERR_MEMORY. */
status cracks_factors(run *r, int crack_id, crack_factors *out);
/* K of a mode, which the point has, as a linear function; after
 * cracks_factors. ERR_MEMORY. */
status cracks_derive(const run *r, int crack_id, int point, int mode,
                     fracture_linear *out);
/* by[dim*n_node]: a derivative by tractions at the lips becomes that by the
 * forces there. */
void cracks_by_forces(const run *r, double *by);
