/*
 * Meshes of memory as .msh files.
 */
#ifndef PROTIS_TESTS_MSH_WRITE_H
#define PROTIS_TESTS_MSH_WRITE_H

#include "mesh/mesh.h"

/* Version 2.2 in ASCII, of all groups with faces or elements; nodes are
 * numbered from 1 in their order. Aborts on failure. */
void msh_write(const char *path, const mesh *m);

#endif
