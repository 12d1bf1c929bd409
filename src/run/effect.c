/*
 * The hooks of the effects that are on, each under the stage of its row.
 */
#include "run/effect.h"

#include "run/run.h"

#include <string.h>

const effect_ops *effect_find(const char *name) {
  for (int k = 0; effect_table[k] != NULL; ++k)
    if (strcmp(effect_table[k]->name, name) == 0) return effect_table[k];
  return NULL;
}

const effect_ops *effect_of_column(const column *c) {
  for (int k = 0; effect_table[k] != NULL; ++k) {
    const effect_ops *e = effect_table[k];
    if (c >= e->columns && c < e->columns + e->n_column) return e;
  }
  return NULL;
}

int effect_is_on(const effect_ops *e, const model *m) {
  if (e->bit != NO_BIT) return (m->effects >> e->bit & 1u) != 0;
  return e->called_for(m, NULL, 0);
}

stage effect_stage(const effect_ops *e) {
  int k = 0;
  if (e->own != 0) return e->own;
  while (effect_table[k] != e) ++k;
  return timer_own_stage(k, e->name);
}

void *effect_state(const effect_list *list, const effect_ops *e) {
  for (int i = 0; list != NULL && i < list->n; ++i)
    if (list->on[i].ops == e) return list->on[i].state;
  return NULL;
}

static void enter(const effect_ops *e) {
  const stage s = effect_stage(e);
  if (s == STAGE_NONE) return;
  if (e->beside)
    timer_enter_whole(s);
  else
    timer_enter(s);
}

static void leave(const effect_ops *e) {
  const stage s = effect_stage(e);
  if (s != STAGE_NONE) timer_leave(s);
}

static int is_due(const run *r, int k) {
  const effect_ops *e = r->effects.on[k].ops;
  return !r->effects.on[k].borrowed && (e->due == NULL || e->due(r));
}

/* Calls CALL with the hook of each effect e that has it and its state. */
#define EACH(run_, hook, if_, call)                   \
  for (int k_ = 0; k_ < (run_)->effects.n; ++k_) {    \
    const effect_ops *e = (run_)->effects.on[k_].ops; \
    void *state_ = (run_)->effects.on[k_].state;      \
    if (e->hook == NULL || !(if_)) continue;          \
    enter(e);                                         \
    st = (call);                                      \
    leave(e);                                         \
    if (st != OK) break;                              \
  }

status effects_create(run *r) {
  status st = OK;
  effect_list *list = &r->effects;
  for (int k = 0; effect_table[k] != NULL && st == OK; ++k) {
    const effect_ops *e = effect_table[k];
    if (e->create == NULL || !effect_is_on(e, r->m)) continue;
    list->on[list->n].ops = e;
    st = e->create(r, &list->on[list->n++].state);
  }
  return st;
}

const char *effects_sum_up(const run *r) {
  for (int k = 0; k < r->effects.n; ++k)
    if (r->effects.on[k].ops->sums_up != NULL)
      return r->effects.on[k].ops->sums_up;
  return NULL;
}

status effects_begin_step(run *r) {
  status st = OK;
  EACH(r, begin_step, 1, e->begin_step(r, state_))
  return st;
}

status effects_initial(run *r) {
  status st = OK;
  EACH(r, initial, is_due(r, k_), e->initial(r, state_))
  return st;
}

status effects_pose(run *r, double t) {
  status st = OK;
  EACH(r, pose, 1, e->pose(r, state_, t))
  return st;
}

status effects_found(run *r, int *again) {
  status st = OK;
  *again = 0;
  EACH(r, found, 1, e->found(r, state_, again))
  return st;
}

status effects_examine(run *r, double t) {
  status st = OK;
  EACH(r, examine, 1, e->examine(r, state_, t))
  return st;
}

status effects_accept(run *r) {
  status st = OK;
  EACH(r, accept, is_due(r, k_), e->accept(r, state_))
  return st;
}

void effects_show(const run *r, state *s) {
  for (int k = 0; k < r->effects.n; ++k)
    if (r->effects.on[k].ops->show != NULL && is_due(r, k))
      r->effects.on[k].ops->show(r->effects.on[k].state, s);
}

status effects_keep(run *r, archive *a) {
  status st = OK;
  for (int k = 0; k < r->effects.n && st == OK; ++k) {
    const effect_ops *e = r->effects.on[k].ops;
    if (e->keep == NULL) continue;
    archive_enter(a, e->name);
    st = e->keep(r, r->effects.on[k].state, a);
    archive_leave(a);
  }
  return st;
}

status effects_copy(const run *from, run *copy) {
  status st = OK;
  effect_list *list = &copy->effects;
  list->n = 0;
  for (int k = 0; k < from->effects.n && st == OK; ++k) {
    const effect_ops *e = from->effects.on[k].ops;
    void *own = from->effects.on[k].state;
    list->on[list->n].ops = e;
    list->on[list->n].borrowed = e->copy == NULL;
    list->on[list->n].state = e->copy == NULL ? own : NULL;
    if (e->copy != NULL) st = e->copy(from, own, &list->on[list->n].state);
    ++list->n;
  }
  return st;
}

void effects_release(run *r) {
  for (int k = 0; k < r->effects.n; ++k)
    if (!r->effects.on[k].borrowed && r->effects.on[k].ops->release != NULL)
      r->effects.on[k].ops->release(r->effects.on[k].state);
  r->effects.n = 0;
}
