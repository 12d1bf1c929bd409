/*
 * Groups of inner faces for meshes made in memory (grid.h): the sides of
 * elements that a function takes.
 */
#pragma once

#include "mesh/mesh.h"

/* 1: the side with these nodes [dim] belongs to the group. */
typedef int take_side(const mesh *m, const int *node);

/* Add a group of those sides, inner or outer; faces that are there already are
 * taken. Aborts without memory. */
void add_side_group(mesh *m, const char *name, take_side *take);
/* Add a group of n nodes, of dimension 0. */
void add_node_group(mesh *m, const char *name, int n, const int *node);
