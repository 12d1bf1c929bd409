/*
 * The writers of this folder, and the open job that output.c and saved.c share.
 * Private to src/output.
 */
#pragma once

#include "output/hdf5/hdf5.h"
#include "model/keyword/keyword.h"
#include "output/output.h"

#include <stdint.h>
#include <stdio.h>

typedef struct tabular tabular;
/* NULL in *out if no step requires a table. length: of the file to continue;
 * -1: a new one. */
status tabular_open(const model *m, const mesh *msh, const char *dir,
                    long length, tabular **out);
status tabular_sync(tabular *t, long *length); /* NULL: -1 */
status tabular_increment(tabular *t, const state *s);
status tabular_close(tabular *t); /* frees t; accepts NULL */

/* ---- status_file.c ---------------------------------------------------- */
status sta_header(const output_options *o, text_file *sta);
/* why: NULL for an accepted increment. */
status sta_line(const output_options *o, const state *s, const char *why,
                text_file *sta);
void cvg_header(const output_options *o, text_file *cvg);
/* s at an attempt at increment total_no. */
typedef struct cvg_place {
  int total_no, attempt;
} cvg_place;
void cvg_line(const output_options *o, cvg_place at, const solver_step *s,
              text_file *cvg);
/* How the iterations of an attempt ended: a comment line. */
void cvg_end(int total_no, int attempt, const state *s, text_file *cvg);
/* One line on the terminal, rewritten; "" clears it. */
void progress_line(const char *text);
/* "seconds" of "done" increments give an estimate for the rest. */
void progress_show(const model *m, const state *s, double seconds, int done);
/* Where the results are (files), exit, contacts, errors, cost. */
void closing_lines(const job *j, const char *files, FILE *f);

/* ---- json.c ----------------------------------------------------------- */
/* Written to a temporary file and renamed: a program sees all of it or
 * nothing. */
status json_write(const job *j, const char *path);

/* ---- fclib.c ---------------------------------------------------------- */
/* The problem cp; node_no[n], and its solution u[m], r[m], unless NULL. Written
 * to a temporary file and renamed. ERR_DECK: the layout has no place for such a
 * problem. */
status fclib_write(const contact_problem *cp, const size_t *node_no,
                   const double *u, const double *r, const char *title,
                   const char *description, const char *path);

/* The end of JOB.rst.inc: bytes, and a checksum of all of them. */
typedef struct saved_end {
  long length;
  uint64_t checksum;
} saved_end;

/* The summaries of the increments in that file (saved.c). */
typedef struct saved_increments {
  text_file file;
  int n; /* increments in it */
  saved_end end;
  char *read; /* what stood in it when the run went on: reasons in
                 run.increments point into it */
} saved_increments;

struct output {
  const model *m;
  const mesh *msh;
  output_options o;
  char *json, *xdmf;
  text_file lst, sta, cvg;
  tabular *dat;
  hdf5_file *h5;
  run_summary run;
  effect_plan *plan;
  job job;                  /* what the writers take of these */
  int n_xdmf;               /* records named in JOB.xdmf */
  double xdmf_at, xdmf_cpu; /* when, and the cost so far, s */
  int attempt;              /* of the increment now tried */
  int progress;
  double shown_at, began_at; /* line on the terminal; end of the setup, s */
  int n_done;                /* increments since then */
  int quiet;                 /* 1: the first facts stand in the listing
                                already */
  saved_increments saved;
};

/* Lengths of the text files, bytes, -1: there is none; rows of JOB.h5. */
typedef struct file_ends {
  long lst, sta, cvg, dat;
  saved_end increments;
  int has_h5;
  hdf5_count h5;
} file_ends;

/* saved.c: an increment that has ended. */
status output_remember(output *o, const state *s);
/* Data saved by output_keep, and the ends of the files then. */
status output_read(output *o, archive *a, file_ends *ends);
