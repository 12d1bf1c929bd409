/*
 * The writers of this folder. Private to src/output.
 */
#ifndef PROTIS_OUTPUT_WRITERS_H
#define PROTIS_OUTPUT_WRITERS_H

#include "base/text.h"
#include "output/hdf5/hdf5.h"
#include "model/keyword/keyword.h"
#include "output/listing/listing.h"
#include "output/output.h"

#include <stdio.h>

/* ---- tabular.c: JOB.dat ----------------------------------------------- */

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
/* The problem cp, and its solution u[m], r[m] unless NULL. Written to a
 * temporary file and renamed. ERR_DECK: the layout has no place for such a
 * problem. */
status fclib_write(const contact_problem *cp, const double *u, const double *r,
                   const char *title, const char *description,
                   const char *path);

#endif
