/*
 * The columns of all tables and fields, and tables as text.
 *
 * Adding a column is one row in the table of its entity (increments.c,
 * bodies.c, contact_nodes.c, contacts.c): the tables of JOB.dat and of the
 * listing, the fields and histories of JOB.h5 and JOB.xdmf, and the tests loop
 * over them.
 */
#ifndef PROTIS_COLUMNS_COLUMNS_H
#define PROTIS_COLUMNS_COLUMNS_H

#include "run/history/history.h"

#include <stdio.h>

typedef enum {
  PER_INCREMENT,
  PER_CONTACT_NODE,
  PER_CONTACT,
  PER_NODE,
  PER_ELEMENT,
  PER_ZONE
} entity;

/* Scenes differ in dimension and in the names of the components. */
enum {
  SCENE_PLANE = 1, /* x, y                                                  */
  SCENE_AXI = 2,   /* r, z                                                  */
  SCENE_SOLID = 4, /* x, y, z                                               */
  SCENE_LCP = 8,   /* a plain LCP from a file: rows                         */
  SCENE_FLAT = SCENE_PLANE | SCENE_AXI,
  SCENE_ALL = SCENE_FLAT | SCENE_SOLID
};
unsigned scene_of(const model *m);

/* Arrays of struct state a column reads; without them it is left out. */
enum {
  NEEDS_STRAIN = 1,
  NEEDS_STRESS = 2,
  NEEDS_REACTION = 4,
  NEEDS_SURFACE = 8,
  NEEDS_LIMIT = 16,
  NEEDS_TOTALS = 32,
  NEEDS_PLACE = 64, /* a surface with coordinates, normals, areas           */
  NEEDS_DISTANCE = 128,
  NEEDS_TORQUE = 256, /* some contact has an axis                           */
  NEEDS_LOOP = 512,
  NEEDS_ZONES = 1024,
  NEEDS_ELEM_ERROR = 2048,
  NEEDS_FLOW = 4096,  /* elements whose law flows                            */
  NEEDS_ALPHA = 8192, /* that many internal variables                       */
  NEEDS_SEVERAL = 16384 /* more than one contact                             */
};

/* What a value function sees. */
typedef struct view {
  const model *m;
  const mesh *msh;
  const state *s;
} view;

typedef enum { AS_REAL, AS_COUNT, AS_WORD } column_form;

typedef struct column {
  const char *name; /* header of the table                                  */
  const char *unit; /* "length", "force/length^2", "s", "-" for none        */
  entity of;
  column_form form;
  unsigned tables;   /* bits PRINT_* of the tables it stands in; 0: none    */
  unsigned effects;  /* shown only if the model has them all                */
  unsigned scenes;   /* bits SCENE_*                                        */
  unsigned needs;    /* bits NEEDS_*                                        */
  const char *field; /* dataset of JOB.h5; NULL: none (mesh data, words)    */
  int part;          /* component: handed to value, place in the dataset    */
  double (*value)(const view *v, int id, int part);
  const char *(*word)(const view *v, int id); /* AS_WORD; else NULL         */
  const char *help;
} column;
/* All columns, entity after entity: the first after NULL, NULL after the last.
 */
const column *column_next(const column *c);

/* 1: the model shows the column at all. */
int column_visible(const column *c, const model *m);
/* 1: the arrays it reads are there. */
int column_ready(const column *c, const state *s);
/* Number of items of an entity. */
int column_items(entity of, const view *v);
/* The defect over the largest of the energies so far; 0 if nothing moved yet.
 */
double energy_defect_relative(const energies *e);
/* Unit with the labels of *UNITS: "force/length^2" -> "N/mm^2". */
void column_unit(const char *unit, const model *m, char *text, size_t size);

/* ---- table.c ---- */

/* Columns of a table that the model and the state have. */
typedef struct table {
  int n;
  entity of;
  const column *col[64];
  int width[64];
  int digits; /* after the point                                            */
} table;
void table_choose(table *t, entity of, unsigned print_bit, const view *v,
                  int digits);
/* The header with "lead" before it ("#", " "), and one record. */
void table_header(const table *t, const model *m, const char *lead, FILE *f);
void table_row(const table *t, const view *v, int id, FILE *f);

#endif
