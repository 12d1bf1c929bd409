/*
 * Texts for the outcomes of an iteration.
 */
#include "base/outcome.h"

const char *outcome_text(outcome o) {
  switch (o) {
    case CONVERGED:
      return "converged";
    case RUNNING:
      return "running";
    case STOPPED_ITERATIONS:
      return "limit of iterations";
    case STOPPED_STAGNATION:
      return "no further progress";
    case STOPPED_RAY:
      return "no equilibrium";
    case STOPPED_NAN:
      return "not a number";
    case STOPPED_CYCLE:
      return "cycle of states";
    case STOPPED_SINGULAR:
      return "singular";
    case STOPPED_UNFIT:
      return "method does not apply to the problem";
  }
  return "?";
}

const char *outcome_code(outcome o) {
  switch (o) {
    case CONVERGED:
      return "CONVERGED";
    case RUNNING:
      return "RUNNING";
    case STOPPED_ITERATIONS:
      return "ITERATIONS";
    case STOPPED_STAGNATION:
      return "STAGNATION";
    case STOPPED_RAY:
      return "RAY";
    case STOPPED_NAN:
      return "NAN";
    case STOPPED_CYCLE:
      return "CYCLE";
    case STOPPED_SINGULAR:
      return "SINGULAR";
    case STOPPED_UNFIT:
      return "UNFIT";
  }
  return "?";
}

int outcome_is_fatal(outcome o) {
  return o == STOPPED_NAN || o == STOPPED_RAY || o == STOPPED_SINGULAR ||
         o == STOPPED_UNFIT;
}
