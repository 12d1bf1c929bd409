/*
 * A condensed block on a floor for the benchmarks of the solvers: unit square
 * or cube, E = 1, nu = 0.3, plane strain in 2-D, held at its top, pressed down
 * and pushed from one side, so that a part of the floor opens, a part slips and
 * a part sticks. Ends the program where memory or data fail.
 */
#pragma once

#include "contact/contact.h"
#include "support/scene.h"

typedef struct pressed_block {
  contact_problem cp; /* frictionless until pressed_block_friction           */
  scene *s;
  stiffness *k;
  condensed *c;
  double *F, *ud;   /* loads of the whole body                             */
  double *f;        /* [m] condensed load                                  */
  double *gap, *g0; /* [n] zero                                            */
  double *ut0;      /* [n*(dim-1)] zero                                    */
  sparse_rows B;
} pressed_block;

/* nodes: on the floor (in 3-D the nearest square number). The body has at most
 * "layers" elements over the height. */
void pressed_block_new(pressed_block *b, int dim, int nodes, int layers);
void pressed_block_free(pressed_block *b);
/* Pressure on the side over E; the top moved down by that share of the height.
 */
void pressed_block_load(pressed_block *b, double side, double down);
void pressed_block_friction(pressed_block *b, double mu);
