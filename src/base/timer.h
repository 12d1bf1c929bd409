/*
 * What each stage of a run costs: calls, CPU seconds (user and system) and
 * bytes requested. Stages nest; a stage is charged for its own work only, not
 * for the stages entered inside it.
 */
#pragma once

#include <stddef.h>

/* clang-format off */
#define STAGE_LIST(X)                                      \
  X(DECK,        "deck and model")                         \
  X(MESH,        "mesh")                                   \
  X(PROBLEM,     "condensed problem from a file")          \
  X(SURFACE,     "contact surface")                        \
  X(COUPLING,    "coupling of surfaces")                   \
  X(CLUSTER,     "clusters of elements")                   \
  X(ASSEMBLY,    "stiffness assembly")                     \
  X(ORDERING,    "ordering and symbolic factor")           \
  X(FACTOR,      "factorisation")                          \
  X(CONDENSE,    "condensed stiffness")                    \
  X(LOAD,        "loads")                                  \
  X(BODY,        "body forces")                            \
  X(LIMIT,       "sliding limit")                          \
  X(NONLOCAL,    "nonlocal average")                       \
  X(VELOCITY,    "velocity form")                          \
  X(CONTACT,     "contact solver")                         \
  X(RECOVERY,    "interior solves")                        \
  X(STRESS,      "stresses")                               \
  X(REACTION,    "reactions")                              \
  X(ENERGY,      "energies")                               \
  X(INELASTIC,   "inelastic strains")                      \
  X(THERMAL,     "thermal strains")                        \
  X(BETWEEN,     "states between increments")              \
  X(ZONES,       "zones of stick and slip")                \
  X(MESH_ERROR,  "error of mesh")                          \
  X(TIME_ERROR,  "error of steps")                         \
  X(ESTIMATE,    "error of solver")                        \
  X(REFERENCE,   "closed form")                            \
  X(CHECK,       "second solutions, jumps")                \
  X(THEORY,      "theorems")                               \
  X(LISTING,     "listing, .sta, .cvg")                    \
  X(HDF5,        "HDF5 output")                            \
  X(FCLIB,       "condensed problems to files")            \
  X(RESTART,     "restart")
/* clang-format on */

/* Those of the list, which files before the effects enter or whose rows have
 * another name; then those of the other rows, named when needed
 * (timer_own_stage). */
#define STAGE_ENUM(name, text) STAGE_##name,
typedef enum {
  STAGE_LIST(STAGE_ENUM) STAGE_LISTED,
  STAGE_COUNT = STAGE_LISTED + 64,
  STAGE_NONE
} stage;

typedef struct stage_cost {
  long calls;   /* - */
  double cpu;   /* CPU time, s */
  size_t bytes; /* requested */
} stage_cost;

void timer_enter(stage s);
enum {
  STAGE_WHOLE = 1,  /* a shadow run: stages entered before it is left are part
                       of it, their own costs and calls are not counted */
  STAGE_NO_CALL = 2 /* what prepares calls of the stage */
};
void timer_enter_as(stage s, unsigned how); /* the same; bits of these */
void timer_leave(stage s); /* must match the last timer_enter */
/* TIMED(s): stage s, none if STAGE_NONE, from here to the end of the block. */
#define TIMED(s)                                                   \
  const stage timed_ __attribute__((cleanup(timer_end), unused)) = \
      timer_begin(s)
/* PASS of a call in stage s. */
#define PASS_TIMED(s, call)         \
  do {                              \
    timer_enter(s);                 \
    const status in_time_ = (call); \
    timer_leave(s);                 \
    PASS(in_time_);                 \
  } while (0)
stage timer_begin(stage s);
void timer_end(const stage *s);
stage_cost timer_cost(stage s);  /* so far, running stages included */
const char *timer_name(stage s); /* NULL: one that has not been named */
/* Stage number k, from 0, of those that are not listed; name is borrowed. */
stage timer_own_stage(int k, const char *name);
double timer_cpu(void);       /* of the process and its ended children, s */
void timer_child_ended(void); /* after each of them */
void timer_reset(void);
/* The process continues the run of another one, which had spent this: its calls
 * are those of the whole from here on, the rest is added. */
void timer_resume(const stage_cost before[STAGE_COUNT]);
