/*
 * The open job, shared by output.c, sink.c and summary.c.
 */
#ifndef PROTIS_OUTPUT_OPEN_H
#define PROTIS_OUTPUT_OPEN_H

#include "output/writers.h"

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
  int n_xdmf;               /* records named in JOB.xdmf */
  double xdmf_at, xdmf_cpu; /* when, and the cost so far, s */
  int attempt;              /* of the increment now tried */
  int progress;
  double shown_at, began_at; /* line on the terminal; end of the setup, s */
  int n_done;                /* increments since then */
  int quiet;                 /* 1: the first facts stand in the listing
                                already */
  increment_summary *kept;   /* [n_increment] of output_keep */
  solution_facts *facts;     /* all their solutions */
  char *whys;                /* lines: their reasons */
  char *reasons;             /* of the restart file: some of run.increments
                                point to them */
};

job job_of(const output *o); /* borrows from o */

/* sink.c: JOB.xdmf with the records so far; "all": even if it was written just
 * before. */
status output_show_records(output *o, int all);

/* Lengths of the text files, bytes, -1: there is none; rows of JOB.h5. */
typedef struct file_ends {
  long lst, sta, cvg, dat;
  int has_h5;
  hdf5_count h5;
} file_ends;

/* summary.c: an increment that has ended. */
status output_remember(output *o, const state *s);
/* Data saved by output_keep, and the ends of the files then. */
status output_read(output *o, archive *a, file_ends *ends);

#endif
