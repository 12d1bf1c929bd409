/*
 * The writers of this folder. Private to src/output.
 */
#ifndef PROTIS_OUTPUT_WRITERS_H
#define PROTIS_OUTPUT_WRITERS_H

#include "base/text.h"
#include "keyword/keyword.h"
#include "listing/listing.h"
#include "output/output.h"

#include <stdio.h>

/* ---- tabular.c: JOB.dat ----------------------------------------------- */

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
