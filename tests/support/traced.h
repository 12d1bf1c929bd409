/*
 * Runs of the program under a tracer: something is done to it at a chosen
 * change of a file of its folder, counted from 1, so that nothing depends on
 * time. Changes are opening for writing, writing, syncing, closing what was
 * written, renaming, cutting and removing; what goes to stderr does not count.
 */
#pragma once

#include "support/job.h"

enum { KILLED = 1000 + 9 /* exit code of a run that SIGKILL ended */ };

typedef enum {
  TRACE_COUNT,  /* nothing                                                 */
  TRACE_SIGNAL, /* the signal, before the change                           */
  TRACE_ERROR,  /* the call fails with the error number, nothing is done   */
  TRACE_SHORT   /* half of it is written, and told so                      */
} trace_action;

typedef struct traced {
  trace_action action;
  int at;     /* the change it happens at                                  */
  int always; /* 1: and at every later one                                 */
  int timed;  /* 1: changes of JOB.xdmf count, which is rewritten by time  */
  const char *of; /* only those of files with this in their names; NULL: all */
  int number;   /* signal or errno                                           */
  int changes;  /* out: changes of files in all                             */
  int restarts; /* out: restart files that a new one replaced               */
  int synced;   /* out: those after which the folder itself was synced      */
} traced;

/* protis JOB --no-timing with further words (at most two, ended by NULL);
 * messages go to stderr.txt of the folder and to j->errors. Exit code, or
 * 1000 + signal. t NULL: without the tracer. */
int traced_run(job *j, const char *const *words, traced *t);

/* All result files of a and b are equal, byte by byte; else the first that
 * differs. NULL: all are. */
const char *traced_difference(const job *a, const job *b);
