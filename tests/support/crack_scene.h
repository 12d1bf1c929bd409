/*
 * Bodies with a plane crack and displacements that are known on both sides.
 */
#pragma once

#include "base/memory.h"
#include "fracture/fracture.h"

/* A vector at y[3], coordinates in which the mesh was made: the crack is where
 * the last one (2-D: y[1], 3-D: y[2]) has a constant value. side: 1 above it,
 * -1 below. */
typedef void crack_field(const void *ctx, const double *y, int side,
                         double *value);

typedef struct crack_scene {
  mesh *m;
  mesh_crack crack;
  fracture_material material[2];
  int *section;   /* [n_elem] 0 */
  double *y;      /* [3*n_node] where the mesh was made */
  int *side;      /* [n_node] */
  double turn[9]; /* x = turn y, row by row */
  double *u, *sigma, *traction;
  double *force; /* [dim*n_elem], NULL: none */
} crack_scene;

/* Take over a mesh with the crack CRACK at that height, open and turn it; turn
 * NULL: not. A crack OTHER is opened too. Aborts on failure. */
void scene_start(crack_scene *s, mesh *m, double height,
                 const fracture_material *material, const double *turn);
/* u of the nodes, and the stresses that Hooke's law gives in each element. */
void scene_move(crack_scene *s, crack_field *field, const void *ctx);
/* Tractions from those on a plane with the normal upward. */
void scene_load(crack_scene *s, crack_field *field, const void *ctx);
/* The factors at all points, new (free). */
fracture_factors *scene_factors(const crack_scene *s, int *n,
                                fracture_point **points);
void scene_end(crack_scene *s);
/* CRACK_SCENE s = ...: ends where the name does. */
#define CRACK_SCENE ENDS_BY(scene_end) crack_scene
