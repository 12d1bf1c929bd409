/* A value at each node of a mesh, from the file of another program. */
#ifndef PROTIS_FIELD_FIELD_H
#define PROTIS_FIELD_FIELD_H

#include "mesh/mesh.h"

/*
 * *value[n_node] is new (memory_free), NULL on failure. The file is a .msh of
 * gmsh (2.2 or 4.1, ASCII or binary) whose last $NodeData counts, or HDF5 with
 * the datasets /node_no and /temperature. Nodes go by their number in the mesh
 * file; numbers that the mesh does not have are skipped. ERR_FILE: it cannot be
 * read; ERR_DECK: no field of one component, a node of the mesh without value,
 * a value that is not finite.
 */
status nodal_field_read(const char *path, const mesh *msh, double **value);

#endif
