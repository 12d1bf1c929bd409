/* Sizes, surfaces and cells of a refinement. Inside src/mesh/refine only. */
#pragma once

#include "mesh/refine/refine.h"

/* Of the edge a, b. */
static inline uint64_t key_of(int a, int b) {
  return a < b ? table_key(a, b) : table_key(b, a);
}

typedef struct size_grid size_grid;
/* *out is new. ERR_MEMORY. */
status size_grid_new(const refine_sizes *s, size_grid **out);
/* m; beyond the mesh about that of the nearest element. */
double size_grid_at(const size_grid *g, const double *x);

/* Faces of groups that may be curved: lines in the plane, triangles. */
typedef struct surface_faces {
  int n, n_node;   /* faces, nodes of each */
  const int *node; /* [n*n_node] */
} surface_faces;

typedef struct round_surface round_surface;
/* x[3*n_all]; *out is new. ERR_MEMORY. */
status round_surface_new(const surface_faces *f, int n_all, const double *x,
                         round_surface **out);
/* middle[3] of the edge a, b; 1: it is not the mean of both. */
int round_surface_middle(const round_surface *s, int a, int b, double *middle);
