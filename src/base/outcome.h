/*
 * How an iteration ended: above zero the result is usable, below zero the
 * reason why not.
 */
#pragma once

/* clang-format off */
#define OUTCOME_LIST(X)                                                       \
  X(CONVERGED,           1, "CONVERGED",  "converged")                        \
  X(RUNNING,             0, "RUNNING",    "running")                          \
  X(STOPPED_ITERATIONS, -1, "ITERATIONS", "limit of iterations")              \
  X(STOPPED_STAGNATION, -2, "STAGNATION", "no further progress")              \
  X(STOPPED_RAY,        -3, "RAY",        "no equilibrium")                   \
  X(STOPPED_NAN,        -4, "NAN",        "not a number")                     \
  X(STOPPED_CYCLE,      -5, "CYCLE",      "cycle of states")                  \
  X(STOPPED_SINGULAR,   -6, "SINGULAR",   "singular")                         \
  X(STOPPED_UNFIT,      -7, "UNFIT", "method does not apply to the problem")   \
  X(STOPPED_UNSTABLE,   -8, "UNSTABLE",   "increment not stable")
/* clang-format on */
/* Stagnation: no progress above the rounding level; a ray: there is no
 * equilibrium; a cycle: a pattern of statuses came again; singular: a linear
 * system of the method has no solution; unstable: an explicit integrator met
 * rates beyond its limit. */
#define OUTCOME_ENUM(name, value, code, text) name = value,
typedef enum { OUTCOME_LIST(OUTCOME_ENUM) } outcome;
/* In a few words, for listings and messages. */
const char *outcome_text(outcome o);
/* In a word, for programs. */
const char *outcome_code(outcome o);
/* 1 if there is no result to continue with: a ray, singular, not a number, a
 * method that does not apply. */
int outcome_is_fatal(outcome o);
