/*
 * The same deck said otherwise: its answer must be the same.
 */
#pragma once

#include "decks/judge.h"

typedef enum {
  THREADS_,  /* two threads                                                  */
  POWERS,    /* units that are powers of two                                 */
  THOUSANDS, /* units as mm and kN                                          */
  NUMBERS,   /* nodes and elements numbered again                             */
  TURNS,     /* x y change places, x y z go round; not in axisymmetric decks */
  METHODS,   /* another method of *SOLVER                                    */
  TWINS
} twin_kind;
extern const char *const twin_name[TWINS];

/* Under limits of CPU time; exit code or 1000 + signal. */
int twin_run(job *j, const char *words);

typedef enum { TWIN_SAME, TWIN_OTHER, TWIN_REFUSED, TWIN_LOST } twin_answer;

/* Runs it in a folder of its own and compares with "base", whose tables are
 * "own". TWIN_OTHER: another answer that is one too. what[400]: how it differs.
 */
twin_answer twin_check(const random_deck *d, twin_kind kind, const job *base,
                       const tables *own, char what[400]);
/* Stops a run in its middle and goes on: all files equal. 1: they are. */
int twin_restart(const random_deck *d, char what[400]);
