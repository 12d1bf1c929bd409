/*
 * How an iteration ended: above zero the result is usable, below zero the
 * reason why not.
 */
#ifndef PROTIS_BASE_OUTCOME_H
#define PROTIS_BASE_OUTCOME_H

typedef enum {
  CONVERGED = 1,
  RUNNING = 0,
  STOPPED_ITERATIONS = -1, /* limit of iterations */
  STOPPED_STAGNATION = -2, /* no progress above the rounding level */
  STOPPED_RAY = -3,        /* no equilibrium: a secondary ray */
  STOPPED_NAN = -4,
  STOPPED_CYCLE = -5,    /* a status pattern was repeated */
  STOPPED_SINGULAR = -6, /* a linear system of the method has no solution */
  STOPPED_UNFIT = -7     /* the method cannot treat the problem at all */
} outcome;
/* In a few words, for listings and messages. */
const char *outcome_text(outcome o);
/* In a word, for programs: CONVERGED, ITERATIONS, STAGNATION, RAY, NAN, CYCLE,
 * SINGULAR, UNFIT. */
const char *outcome_code(outcome o);
/* 1 if there is no result to continue with: a ray, singular, not a number, a
 * method that does not apply. */
int outcome_is_fatal(outcome o);

#endif
