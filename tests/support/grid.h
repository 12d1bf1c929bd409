/*
 * Meshes made in memory for the tests: a rectangle of triangles or a box of
 * tetrahedra (six per cell), node ids running x first, then y, then z.
 *
 * Groups: BODY (all elements) and the sides LEFT, RIGHT (x), BOTTOM, TOP (y),
 * FRONT, BACK (z, 3-D only), each with faces (outward) and nodes.
 */
#pragma once

#include "mesh/mesh.h"

/* n[d] cells over [0, length[d]] in each of dim directions; NULL without
 * memory. Free with memory_free. */
mesh *make_grid_2d(const int n[2], const double length[2]);
mesh *make_grid_3d(const int n[3], const double length[3]);
/* Both meshes side by side in one, nodes of b (moved by shift[dim]) after
 * those of a; BODY covers both, no other group. a and b stay the caller's. */
mesh *grid_join(const mesh *a, const mesh *b, const double *shift);
