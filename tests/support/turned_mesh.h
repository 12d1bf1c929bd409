/*
 * Scenes turned in space as a whole: vectors and the mesh file of a grid.
 */
#pragma once

#include "mesh/mesh.h"
#include "support/job.h"

typedef struct turn {
  double axis[3], angle; /* unit, rad                                        */
} turn;

/* v := R v */
void turn_vector(const turn *t, double v[3]);
/* The grid turned as turned.msh in the folder of the job, with its groups BODY,
 * FOOT (below: BOTTOM in the plane, FRONT in space) and HEAD (opposite). */
void turned_mesh_write(const job *j, const mesh *m, const turn *t);
