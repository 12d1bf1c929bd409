/*
 * The open job, shared by output.c and saved.c.
 */
#ifndef PROTIS_OUTPUT_OPEN_H
#define PROTIS_OUTPUT_OPEN_H

#include "output/writers.h"

#include <stdint.h>

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

#endif
