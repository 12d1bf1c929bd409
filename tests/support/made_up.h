/*
 * A made-up run for the tests of the writers: a small block with the contact
 * FOOT on its side BOTTOM, a support on TOP, and states whose numbers are
 * formulas of the increment, so that what stands in a file can be checked
 * without a solver. Node numbers run against the ids.
 */
#pragma once

#include "base/memory.h"
#include "run/effect.h"
#include "run/history/history.h"

enum {
  MADE_U,
  MADE_STRAIN,
  MADE_STRESS,
  MADE_REACTION,
  MADE_UC,
  MADE_RC,
  MADE_GAP,
  MADE_SLIP,
  MADE_LIMIT,
  MADE_DISTANCE,
  MADE_ARRAYS
};

typedef struct made_up {
  mesh *msh;
  model m;
  contact foot;
  section body;
  step steps[1];
  load support;
  print_request prints[8]; /* CONTACT TOTALS NODES ELEMENTS ENERGY REACTIONS
                              ZONES LOOP                                     */
  contact_surface surface;
  setup_facts facts;
  contact_total totals[1];
  contact_loop loops[1];
  double torque[1];
  contact_zone zones[2];
  zone_list zone_list;
  effect_list effects;
  double *array[MADE_ARRAYS];
  int count[MADE_ARRAYS]; /* items of each array                          */
  contact_status *status;
  state s;
} made_up;

/* dim 2 or 3, cells per side, increments expected; the program ends without
 * memory. All tables at every increment, fields at every increment. */
made_up *made_up_new(int dim, int cells, int n_increment);
void made_up_free(made_up *run);
/* MADE_UP *run = ...: freed where the name ends. */
void made_up_leave(made_up *const *run);
#define MADE_UP ENDS_BY(made_up_leave) made_up
/* The state of increment total_no, from 1; the last ends the step. */
void made_up_advance(made_up *run, int total_no);
/* What the state holds in item of an array. */
double made_up_value(int array, int item, int total_no);
