/* What the error of the mesh shares with the errors of goals. */
#ifndef PROTIS_EFFECTS_ERRORS_MESH_H
#define PROTIS_EFFECTS_ERRORS_MESH_H

#include "run/run.h"

/* The patches of elements of r->body.d, made with the elastic matrix of now;
 * borrowed until that changes. *out NULL: the run has no error of the mesh.
 * ERR_MEMORY. */
status mesh_recovery(const run *r, space_recovery **out);

#endif
