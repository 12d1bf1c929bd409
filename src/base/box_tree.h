/*
 * Search for the items (faces, edges, points) near a point or along a line: a
 * balanced tree of bounding boxes, which serves items of any size.
 */
#pragma once

#include "base/status.h"

typedef struct box_tree {
  int dim, n;  /* 2 or 3; items */
  int *item;   /* [n] in the order of the leaves */
  double *box; /* [2*dim*nodes] least, then largest corner */
  double *of;  /* [2*dim*n] boxes of the items */
} box_tree;

/* n items of "corners" points each, one after the other: x[dim*corners*n]. */
status box_tree_new(int dim, int n, int corners, const double *x,
                    box_tree *out);
/* The items whose boxes are nearer than r to x: found[n], their number. */
int box_tree_near(const box_tree *t, const double *x, double r, int *found);

/* The points y with low <= axis.y <= high for each of n_slab directions: a
 * prism along one direction if the others span the plane across it. */
typedef struct box_beam {
  int n_slab; /* up to 3 */
  double axis[3][3];
  double low[3], high[3]; /* length times that of the axis */
} box_beam;

/* The items whose boxes meet each slab: found[n], their number. */
int box_tree_along(const box_tree *t, const box_beam *beam, int *found);
