/*
 * The files of a run. Every writer is a sink of history_run; the columns of
 * all tables and fields stand once, in columns.c.
 *
 * Adding a column is one row of column_table: the tables of JOB.dat, the
 * fields and histories of JOB.h5 and JOB.xdmf, and the tests loop over it.
 */
#ifndef PROTIS_OUTPUT_OUTPUT_H
#define PROTIS_OUTPUT_OUTPUT_H

#include "history/history.h"

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
  NEEDS_FLOW = 4096, /* elements whose law flows                            */
  NEEDS_ALPHA = 8192 /* that many internal variables                        */
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
extern const column column_table[]; /* name NULL at the end                 */

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

typedef struct output_options {
  const char *dir;     /* folder of the results; NULL or "": the current one */
  int no_timing;       /* leave out the cost columns                         */
  int progress;        /* a line on the terminal, if stderr is one           */
  const char *version; /* of the program, for the results; NULL: ""          */
  const char *kernel;  /* BLAS kernel, for the results; NULL: ""             */
  int threads;         /* threads of the run, for the results                */
  archive *from; /* go on with the files of an earlier run; NULL: new ones    */
  int n_problem; /* contacts of a *CONDENSED PROBLEM */
} output_options;

typedef struct output output;

/* Open all files of the job: the text files, flushed line by line, and JOB.h5
 * with room for all increments foreseen. JOB.xdmf and JOB.json of an earlier
 * run, and its restart files, are removed. ERR_FILE names the file. The options
 * are copied, their strings borrowed. */
status output_open(const model *m, const mesh *msh, const output_options *o,
                   output **out);
history_sink output_sink(output *o);
/* What the files are gone on with from, into an archive that is written before
 * the next increment; all files are handed to the disk. */
status output_keep(output *o, archive *a);
/* A pass towards *ACCURACY, TARGET=. */
enum { MAX_PASS_ROWS = 20 };
typedef struct pass_row {
  double unknowns;
  double mesh, time, solver, total; /* %, estimated errors                    */
  double cpu;                       /* s, of the pass                         */
  char change[80];                  /* what the next pass has changed, ""     */
} pass_row;
/* The passes so far, for listing and JSON; forecast of a tenth of the error;
 * why the target is missed, or "". All borrowed until output_close. */
void output_passes(output *o, double target, int n, const pass_row *rows,
                   const pass_row *forecast, const char *why);
/*
 * Close with the verdict of the run; writes the closing tables and JOB.json,
 * frees o (NULL: nothing to do). The answer is the verdict of the whole: run
 * if it failed; else the failure of a file; else ERR_UNSETTLED if increments
 * missed their tolerance; else OK. The record keeps the message of run.
 */
status output_close(output *o, status run, int unsettled);

#endif
