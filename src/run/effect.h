/*
 * What a scene may call for beside equilibrium: an effect is one file of
 * src/effects and one row of effect_table. The run calls the hooks of the
 * effects that are on, in the order of the table:
 *
 *   create -> (begin_step -> (pose -> solve -> found)* -> accept)* -> release
 *
 * What the model does not call for is not in the list: nothing of it is
 * allocated, called or counted. Its stage of the timer, its rows in the plan
 * and in COST OF THE EFFECTS, its part of the restart and its columns follow
 * from the row. Any hook may be NULL.
 */
#ifndef PROTIS_RUN_EFFECT_H
#define PROTIS_RUN_EFFECT_H

#include "base/archive/archive.h"
#include "base/timer.h"
#include "run/column.h"

struct run;
typedef struct plan_sizes plan_sizes;   /* src/effects/plan/plan.h            */
typedef struct effect_work effect_work; /* the same                           */

enum { EFFECT_STAGES = 7, NO_BIT = -1 };

typedef struct effect_ops {
  const char *name;
  int bit; /* EFFECT_BIT_... that m->effects keeps the answer of called_for
              under, for others that ask; or NO_BIT                           */
  /* 1: the model calls for it; which card or fact does, or why none does, into
   * why[size]; size 0: not wanted. */
  int (*called_for)(const model *m, char *why, size_t size);
  /* Work expected before anything is solved. ERR_MEMORY. */
  status (*foreseen)(const plan_sizes *s, effect_work *work);
  /* Of the hooks; 0: one of its name is made; STAGE_NONE: they are not timed.
   */
  stage own;
  stage more[EFFECT_STAGES]; /* of run and outputs that count as it, 0 ends   */
  const char *within; /* the effect that it is part of; no stage then         */
  int beside; /* 1: stages entered inside a hook are part of it               */

  /* Why half the increments tell nothing of the error of the steps, where what
   * it adds up over them has a part in it; NULL: none. */
  const char *sums_up;

  /* *own is new and not NULL; it is released also after a failure. */
  status (*create)(struct run *r, void **own);
  /* 0: accept has nothing to do at this increment, and is not counted. */
  int (*due)(const struct run *r);
  /* r->step has a surface, a matrix, and a solver for its contact. */
  status (*begin_step)(struct run *r, void *own);
  /* The initial displacements are r->old, posed in r->problem.cp. */
  status (*initial)(struct run *r, void *own);
  /* Gaps, position of stick and limit of time t are set: what it changes. */
  status (*pose)(struct run *r, void *own, double t);
  /* r->now is an equilibrium; *again = 1: the problem has changed. */
  status (*found)(struct run *r, void *own, int *again);
  /* The increment that ends at t has been solved and will be taken; r->now may
   * be solved again. */
  status (*examine)(struct run *r, void *own, double t);
  /* r->now is an increment of the run, r->old what it started from. */
  status (*accept)(struct run *r, void *own);
  /* What the outputs show of it beside its columns. */
  void (*show)(const void *own, state *s);
  /* Both ways, in a group of its own. */
  status (*keep)(struct run *r, void *own, archive *a);
  /* *out: a state for a copy of the run that solves a state within the
   * increment. Without this hook the copy poses with that of the run and
   * accepts nothing. */
  status (*copy)(const struct run *r, const void *own, void **out);
  void (*release)(void *own);

  const column *columns; /* [n_column]                                        */
  int n_column;
  int (*items)(const void *own); /* rows of its own table                   */
} effect_ops;

/* src/effects/table.c; NULL ends. */
extern const effect_ops *const effect_table[];

const effect_ops *effect_find(const char *name); /* or NULL                   */
/* The effect whose column it is, or NULL. */
const effect_ops *effect_of_column(const column *c);
int effect_is_on(const effect_ops *e, const model *m);
stage effect_stage(const effect_ops *e);

/* The effects of a run that are on. */
enum { EFFECTS_MOST = 40 };
typedef struct effect_list effect_list;
struct effect_list {
  int n;
  struct {
    const effect_ops *ops;
    void *state;
    int borrowed; /* 1: of another run                                        */
  } on[EFFECTS_MOST];
};
/* NULL: not on. */
void *effect_state(const effect_list *list, const effect_ops *e);

#endif
