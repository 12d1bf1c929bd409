/*
 * Contact of rigid bodies over one step of time, for the tests of the solvers:
 * with the velocities v, the impulses r of the contacts,
 *
 *   M v = H r + f,   u = H' v,   W = H' inv(M) H,   q = H' inv(M) f,
 *
 * per contact (N, T1[, T2]) in the signs of FCLIB (u_N opens, r_N >= 0 pushes).
 * There are more contacts than bodies can move: W is semidefinite, the forces
 * are not unique, the velocities nearly always are.
 */
#pragma once

#include "base/memory.h"
#include "support/contact_case.h"

typedef enum {
  RIGID_BOX,   /* one box on a floor, many contacts below                     */
  RIGID_TOWER, /* boxes one on the other                                      */
  RIGID_WALL,  /* a triangle of boxes, each on two others                     */
  RIGID_ARCH,  /* a half circle of wedges between two supports                */
  RIGID_HEAP,  /* round bodies, touching one another at random                */
  RIGID_KINDS
} rigid_kind;

typedef struct rigid_scene {
  int dim, n, n_v, m;     /* contacts, velocities, dim*n                     */
  double *M, *H, *f;      /* [n_v] diagonal, [n_v*m] column major, [n_v]     */
  double *W, *q, *mu, *w; /* [m*m], [m], [n]; w: [m] zero                    */
} rigid_scene;

/* About "size" bodies (contacts of the box), weight, pushes and velocities from
 * the seed. */
rigid_scene rigid_new(rigid_kind kind, int dim, int size, double mu,
                      unsigned long long seed);
void rigid_free(rigid_scene *s);
/* RIGID_SCENE s = ...: freed where the name ends. */
#define RIGID_SCENE ENDS_BY(rigid_free) rigid_scene
const char *rigid_name(rigid_kind kind);
/* Every entry of W off by up to half the share of it, as in a file whose W is
 * unsymmetric. */
void rigid_disturb(rigid_scene *s, double share, unsigned long long seed);
/* The same with the signs of contact.h, the compliance alone given. */
contact_case rigid_case(const rigid_scene *s);
/* How far u, r of that case miss the conditions in the signs of FCLIB
 * (fclib_violation). */
double rigid_violation(const rigid_scene *s, const contact_case *c);
