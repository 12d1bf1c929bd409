/*
 * What the writers of this folder share: text files, number format, tables,
 * and the state of an open job. Private to src/output.
 */
#ifndef PROTIS_OUTPUT_WRITERS_H
#define PROTIS_OUTPUT_WRITERS_H

#include "base/text.h"
#include "keyword/keyword.h"
#include "output/output.h"
#include "plan/plan.h"

#include <stdio.h>

/* ---- tabular.c: JOB.dat and the tables of the listing ----------------- */

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

typedef struct tabular tabular;
/* NULL in *out if no step asks for a table. length: of the file to go on with;
 * -1: a new one. */
status tabular_open(const model *m, const mesh *msh, const char *dir,
                    long length, tabular **out);
status tabular_sync(tabular *t, long *length); /* NULL: -1                    */
status tabular_increment(tabular *t, const state *s);
status tabular_close(tabular *t); /* frees t; accepts NULL                  */

/* 1: an increment is shown by "every n-th and the last; 0: the last". */
int output_due(int frequency, const state *s);

/* ---- what the listing and JOB.json tell of the run -------------------- */

typedef struct increment_summary {
  int step_no, increment_no, total_no, attempt;
  double t, dt;
  int n_open, n_slip, n_stick, iterations, settled, outcome;
  double residual, defect;
  error_bound error;
  int jumps; /* 1: the equilibrium jumps, at jump_t, s                     */
  double jump_t;
  int checked, n_solution;   /* by CHECK= of *SOLVER                          */
  solution_facts *solutions; /* [n_solution] owned                            */
  error_share mesh_error, time_error;
  true_error truth;
  balance_report balance;
  theory_report theory; /* its contacts are owned                             */
} increment_summary;

typedef struct pass_table {
  double target; /* %                                                         */
  int n;         /* 0: no target                                              */
  const pass_row *rows, *forecast;
  const char *why;
} pass_table;

typedef struct run_summary {
  pass_table passes;
  int facts_known;
  setup_facts facts;
  int n_increment, capacity, n_rejected, n_unsettled;
  increment_summary *increments; /* [n_increment]                          */
  double residual_worst, defect_worst; /* - ; the defect relative           */
  flow_tally tally; /* points with a threshold                              */
  status verdict;
  const char *message; /* of a failed run, or ""                            */
} run_summary;

/* One line of the error budget: what, its last and largest estimate, CPU
 * seconds of the stages whose work decides it, and of estimating it. */
typedef struct budget_row {
  const char *name, *json;
  double last, worst; /* %, of the energy norm; NAN: unknown                  */
  double reached, estimated; /* s                                             */
} budget_row;
enum { BUDGET_ROWS = 4 };

typedef struct job {
  const model *m;
  const mesh *msh;
  const output_options *o;
  const run_summary *run;
  const effect_plan *plan; /* of the effects */
} job;

/* The estimates asked for; how many rows. */
int job_budget(const job *j, budget_row rows[BUDGET_ROWS]);
/* What TOL=BALANCED saved in all increments that were asked. */
typedef struct balance_sum {
  int asked;
  double iterations, saved_iterations, saved_cpu; /* made; about; s           */
} balance_sum;
balance_sum job_balance(const job *j);
/* Increments that dt of the deck would make in the steps with TIME=BALANCED; 0:
 * there is none. Those made in them. */
double job_increments_of_deck(const job *j, int *made);
/* Sum of the estimates over the true error, last increment; NAN: unknown. */
double job_effectivity(const job *j);

/* Sizes of model and equations for listing and JSON, NULL ends; the answer
 * counts those of the model, which come first. */
typedef struct size_row {
  const char *name;
  double value;
} size_row;
enum { SIZE_ROWS = 20 };
int job_sizes(const job *j, size_row rows[SIZE_ROWS]);

/* ---- listing.c -------------------------------------------------------- */
status listing_open(const job *j, text_file *lst);
status listing_ready(const job *j, text_file *lst);
status listing_start(const job *j, const start_report *s, text_file *lst);
status listing_increment(const job *j, const state *s, text_file *lst);
status listing_between(const state *s, text_file *lst);
status listing_rejected(const state *s, const char *why, text_file *lst);
status listing_verdict(const job *j, text_file *lst);

/* ---- status_file.c ---------------------------------------------------- */
status sta_header(const output_options *o, text_file *sta);
/* why: NULL for an accepted increment. */
status sta_line(const output_options *o, const state *s, const char *why,
                text_file *sta);
void cvg_header(text_file *cvg);
void cvg_line(int total_no, int attempt, const solver_step *s, text_file *cvg);
/* How the iterations of an attempt ended: a comment line. */
void cvg_end(int total_no, int attempt, const state *s, text_file *cvg);
/* One line on the terminal, rewritten; "" clears it. */
void progress_line(const char *text);
void progress_show(const state *s);

/* ---- json.c ----------------------------------------------------------- */
/* Written aside and renamed: a program sees the whole or nothing. */
status json_write(const job *j, const char *path);

/* ---- hdf5.c ----------------------------------------------------------- */
typedef struct hdf5_file hdf5_file;

/* A field of JOB.h5: one dataset per record under GROUP/NAME, or one row per
 * increment in GROUP/NAME. */
typedef struct hdf5_field {
  const char *name;
  char group[200]; /* "/fields", "/contact", "/history", "/totals/NAME"      */
  entity of;
  int id;     /* of the contact for "/totals"                         */
  int n_part; /* 1 or 3                                               */
  const column *part[3]; /* NULL: zero                                      */
} hdf5_field;

typedef struct hdf5_count { /* what has been written                         */
  int rows, records;
} hdf5_count;
/* NULL in *out if no step asks for fields. before: go on with the file after
 * these; NULL: a new one. */
status hdf5_open(const model *m, const mesh *msh, const output_options *o,
                 const hdf5_count *before, hdf5_file **out);
/* Hand everything to the disk; h NULL: nothing. */
status hdf5_sync(hdf5_file *h, hdf5_count *n);
/* The increment is in the file when this returns OK. */
status hdf5_increment(hdf5_file *h, const state *s);
/* Cut what was not used if "finished"; frees h; accepts NULL. */
status hdf5_close(hdf5_file *h, int finished);

typedef struct hdf5_shape { /* what JOB.xdmf has to know                      */
  const char *path;
  int n_node, n_elem, corners, n_contact_node, n_contact_face, face_corners;
  int n_field, n_record;
  const hdf5_field *fields; /* [n_field]                                     */
  const double *times;      /* [n_record]                                    */
} hdf5_shape;
void hdf5_shape_of(const hdf5_file *h, hdf5_shape *shape);
/* Name of record i (from 0) below GROUP/NAME. */
void hdf5_record_name(char *text, size_t size, int i);

/* ---- fclib.c ---------------------------------------------------------- */
/* The problem cp, and its solution u[m], r[m] unless NULL. Written aside and
 * renamed. ERR_DECK: the layout has no place for such a problem. */
status fclib_write(const contact_problem *cp, const double *u, const double *r,
                   const char *title, const char *description,
                   const char *path);

/* ---- xdmf.c ----------------------------------------------------------- */
/* Written aside and renamed. */
status xdmf_write(const hdf5_shape *shape, const char *path);

#endif
