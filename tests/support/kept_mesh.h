/*
 * Runs of a small job whose mesh is read once: with PROTIS_MESH, the path of
 * tests/preload/mesh.so, later runs get what the mesh reader sent the first.
 */
#pragma once

#include "support/job.h"

/* From here on the mesh is the one kept in the folder of this job, or of all
 * tests (PROTIS_MESHES), where a first run keeps it; NULL: meshes are read
 * again. */
void kept_mesh(const job *j);
/* In the process that becomes the program: load other libraries, "" or their
 * paths joined by colons, and that of the mesh if there is need. */
void kept_mesh_preload(const char *others);
