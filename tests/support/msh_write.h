/*
 * Meshes of memory as .msh files.
 */
#pragma once

#include "mesh/mesh.h"

/* Version 2.2 in ASCII, of all groups with faces or elements; nodes are
 * numbered from 1 in their order. Aborts on failure. */
void msh_write(const char *path, const mesh *m);
