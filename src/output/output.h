/*
 * The files of a run. Every writer is a sink of history_run; the columns of
 * all tables and fields stand once, in columns.c.
 */
#ifndef PROTIS_OUTPUT_OUTPUT_H
#define PROTIS_OUTPUT_OUTPUT_H

#include "history/history.h"

typedef enum {
  PER_INCREMENT,
  PER_CONTACT_NODE,
  PER_CONTACT,
  PER_NODE,
  PER_ELEMENT
} entity;

typedef struct column {
  const char *name; /* header of the table, name of the dataset            */
  const char *unit; /* "length", "force", "force/length^2", "-"            */
  const char *help;
  entity of;
  unsigned tables;  /* bits PRINT_* of the tables it stands in; 0: none    */
  unsigned effects; /* shown only if the model has them all                */
  int min_dim;      /* 3: three-dimensional scenes only                    */
  double (*value)(const model *m, const mesh *msh, const state *s, int id);
} column;
extern const column column_table[]; /* name NULL at the end                   */

typedef struct output_options {
  const char *dir; /* folder of the results                               */
  int no_timing;   /* leave out the cost columns                          */
  int progress;    /* a line on the terminal                              */
} output_options;

typedef struct output output;

/* Open all files of the job (tmp names are not used for text files: they are
 * flushed line by line). ERR_FILE names the file. */
status output_open(const model *m, const mesh *msh, const output_options *o,
                   output **out);
history_sink output_sink(output *o);
/* Close with the verdict of the run; writes the closing tables and JOB.json. */
status output_close(output *o, status run, int unsettled);

#endif
