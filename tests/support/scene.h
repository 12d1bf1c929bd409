/*
 * A domain built by hand for the tests of src/fem: one section on a mesh,
 * supports and contact nodes as wanted.
 */
#pragma once

#include "base/memory.h"
#include "fem/fem.h"
#include "support/grid.h"

typedef struct scene {
  mesh *m; /* owned */
  domain d;
  contact_surface surface;
  int *section_id;
  unsigned char *fixed;
  kinematics kin[1];
  double thickness[1], C[36], E[36];
} scene;

/* Takes the mesh over. E = young, nu = 0.3, no support, no contact. */
scene *scene_new(mesh *m, kinematics kin, double young);
void scene_free(scene *s);
/* SCENE *s = ...: freed where the name ends. */
void scene_leave(scene *const *s);
#define SCENE ENDS_BY(scene_leave) scene
/* Fix component c of the nodes of a side group. */
void scene_fix(scene *s, const char *group, int c);
void scene_fix_node(scene *s, int node_id, int c);
/* Contact on the nodes of a group (added to those before, kept ascending),
 * outward normal n[dim]; "slant" tilts the tangents to an oblique frame. */
void scene_contact(scene *s, const char *group, const double *n, double slant);
/* New frame rows [dim*dim] of contact node q. */
void scene_frame(scene *s, int q, const double *rows);

/* Stiffness of all components by dense B' E B, each node in its local frame
 * (contact nodes: u = basis a): K[N*N], N = dim*n_node. */
void scene_dense(const scene *s, double *K);
/* What is unknown: 1 on the local components that are not prescribed. */
void scene_unknowns(const scene *s, unsigned char *unknown);
/* Reproducible numbers in [-1, 1]. */
double scene_random(unsigned *seed);

/* Two blocks of 3 x 3 squares side by side, clamped, their feet in contact. */
scene *scene_two_bodies(void);
/* A box that nothing but its contact holds. */
scene *scene_floating_3d(void);
/* Stiffness, condensation, recovery; work[3*dim*n_node]: load, condensed load,
 * solution. *condition of the condensed matrix, or NULL. */
status scene_whole_way(const domain *d, double *work, double *condition);
