/*
 * Meshes of the hard scenes: grids of triangles or tetrahedra, mapped, turned,
 * mirrored, moved, scaled and numbered at random, written as .msh 2.2.
 *
 * A mesh is told in words: bodies separated by "+", each
 *   rect NX NY LX LY [diagonal|alternate] [at X Y] [layers]
 *   box NX NY NZ LX LY LZ [at X Y Z]
 *   triangle X1 Y1 X2 Y2 X3 Y3
 * Groups: BODY (with layers SOFT below the middle and HARD above), LEFT, RIGHT,
 * BOTTOM, TOP, in 3-D FRONT and BACK, the points CORNER (of least x, y, z) and
 * TIP (of largest); of a triangle CLAMPED (its first side), TIP its third
 * vertex, FOOT the side from vertex 1 to it, SIDE that from vertex 2. From the
 * second body on the names end in its number.
 */
#pragma once

#include <stdio.h>

/* What is done to the nodes, in this order; all zero: nothing. */
typedef struct mesh_change {
  const char *map[3]; /* expressions of x y z: new coordinates, or NULL */
  double scale;     /* 0: 1                                                  */
  int mirror;       /* 1: x -> -x                                            */
  double turn;      /* rad about z                                           */
  double shift;     /* length, added to x and y                              */
  unsigned shuffle; /* seed of a random numbering, 0: in order               */
} mesh_change;

/* The number of node i in the file stands in (*number)[i] (caller frees).
 * 0: the words are not understood. */
int scene_mesh_write(FILE *f, const char *words, const mesh_change *change,
                     int **number);
