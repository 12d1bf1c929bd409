/*
 * A column of the tables and fields: its name, its tables and the function that
 * evaluates it in an accepted increment.
 */
#ifndef PROTIS_RUN_COLUMN_H
#define PROTIS_RUN_COLUMN_H

#include "run/state.h"

typedef enum {
  PER_INCREMENT,
  PER_CONTACT_NODE,
  PER_CONTACT,
  PER_NODE,
  PER_ELEMENT,
  PER_ZONE,
  PER_TIP,
  PER_GOAL
} entity;

/* Scenes differ in dimension and in the names of the components. */
enum {
  SCENE_PLANE = 1, /* x, y */
  SCENE_AXI = 2,   /* r, z */
  SCENE_SOLID = 4, /* x, y, z */
  SCENE_LCP = 8,   /* a plain LCP from a file: rows */
  SCENE_FLAT = SCENE_PLANE | SCENE_AXI,
  SCENE_ALL = SCENE_FLAT | SCENE_SOLID
};

/* Arrays of struct state a column reads; without them it is left out. */
enum {
  NEEDS_STRAIN = 1,
  NEEDS_STRESS = 2,
  NEEDS_REACTION = 4,
  NEEDS_SURFACE = 8,
  NEEDS_LIMIT = 16,
  NEEDS_TOTALS = 32,
  NEEDS_PLACE = 64, /* a surface with coordinates, normals, areas */
  NEEDS_DISTANCE = 128,
  NEEDS_TORQUE = 256, /* some contact has an axis */
  NEEDS_ELEM_ERROR = 2048,
  NEEDS_FLOW = 4096,    /* elements whose law flows */
  NEEDS_ALPHA = 8192,   /* that many internal variables */
  NEEDS_SEVERAL = 16384 /* more than one contact */
};

/* Input of a value function. */
typedef struct view {
  const model *m;
  const mesh *msh;
  const state *s;
} view;

typedef enum { AS_REAL, AS_COUNT, AS_WORD } column_form;

/* Of "tables": bits of PRINT_*; above them the place of an effect's column. */
enum { COLUMN_PLACE = 24, COLUMN_TABLES = (1 << COLUMN_PLACE) - 1 };

typedef struct column {
  const char *name; /* header of the table */
  const char *unit; /* "length", "force/length^2", "s", "-" for none */
  entity of;
  column_form form;
  unsigned tables;   /* bits PRINT_* of its tables; 0: none; and AT of
                        column_row.h */
  unsigned effects;  /* shown only if the model has them all */
  unsigned scenes;   /* bits SCENE_* */
  unsigned needs;    /* bits NEEDS_* */
  const char *field; /* dataset of JOB.h5; NULL: none (mesh data, words) */
  int part;          /* component: handed to value, place in the dataset */
  double (*value)(const view *v, int id, int part);
  /* AS_WORD; else NULL */
  const char *(*word)(const view *v, int id);
  const char *help;
} column;

#endif
