/* The hooks of the active effects, each under the stage of its row. */
#include "run/effect.h"

#include "run/run.h"

int effect_is_on(const effect_ops *e, const model *m) {
  if (e->bit != NO_BIT) return (m->effects >> e->bit & 1u) != 0;
  return e->required(m, NULL);
}

void *effect_state(const effect_list *list, const effect_ops *e) {
  for (int i = 0; list != NULL && i < list->n; ++i)
    if (list->on[i].ops == e) return list->on[i].state;
  return NULL;
}

enum { PREPARES = STAGE_NO_CALL, ACTS = 0 };

static void enter(const run *r, int k, unsigned how) {
  const effect_ops *e = r->effects.on[k].ops;
  const stage s = r->effects.on[k].stage;
  if (s == STAGE_NONE || e->inside) return;
  timer_enter_as(s, how | (e->shadow ? STAGE_WHOLE : 0));
}

static void leave(const run *r, int k) {
  const stage s = r->effects.on[k].stage;
  if (s != STAGE_NONE && !r->effects.on[k].ops->inside) timer_leave(s);
}

static int is_due(const run *r, int k) {
  const effect_ops *e = r->effects.on[k].ops;
  return !r->effects.on[k].borrowed && (e->on.due == NULL || e->on.due(r));
}

static size_t size_of(const run *r, const effect_ops *e) {
  return e->size * (e->count == NULL ? 1 : e->count(r));
}

static status new_state(const run *r, const effect_ops *e, void **own) {
  char *bytes = NULL;
  *own = NULL;
  if (e->size > 0) PASS_NEW(bytes, size_of(r, e));
  *own = bytes;
  return OK;
}

static status create(run *r, const effect_ops *e, void **own) {
  PASS(new_state(r, e, own));
  OWNS(*own);
  return e->on.create == NULL ? OK : e->on.create(r, own);
}

status effects_create(run *r, const effect_ops *const *table) {
  effect_list *list = &r->effects;
  for (int k = 0; table[k] != NULL; ++k) {
    const effect_ops *e = table[k];
    if (!effect_is_on(e, r->m)) continue;
    list->on[list->n].ops = e;
    list->on[list->n].stage =
        e->own != 0 ? e->own : timer_own_stage(k, e->name);
    void **own = &list->on[list->n++].state;
    enter(r, list->n - 1, PREPARES);
    const status st = create(r, e, own);
    leave(r, list->n - 1);
    PASS(st);
  }
  return OK;
}

int effects_sum_up(const run *r) {
  for (int k = 0; k < r->effects.n; ++k)
    if (r->effects.on[k].ops->sums_up) return 1;
  return 0;
}

/* effects_HOOK: "call" for each effect e that has the hook and for which "if_"
 * holds, own its state. */
#define FOR_HOOK(hook, parameters, use, if_, call) \
  status effects_##hook parameters {               \
    for (int k = 0; k < r->effects.n; ++k) {       \
      const effect_ops *e = r->effects.on[k].ops;  \
      void *own = r->effects.on[k].state;          \
      if (e->on.hook == NULL || !(if_)) continue;  \
      enter(r, k, use);                            \
      const status st = call;                      \
      leave(r, k);                                 \
      if (st != OK) return st;                     \
    }                                              \
    return OK;                                     \
  }

FOR_HOOK(check, (run * r), PREPARES, 1, e->on.check(r, own))
FOR_HOOK(prepare, (run * r), PREPARES, 1, e->on.prepare(r, own))
FOR_HOOK(begin_step, (run * r), ACTS, 1, e->on.begin_step(r, own))
FOR_HOOK(start, (run * r), ACTS, 1, e->on.start(r, own))
FOR_HOOK(make_step, (run * r, int *made), ACTS, !*made,
         e->on.make_step(r, own, made))
FOR_HOOK(attempt, (run * r, double t), ACTS, 1, e->on.attempt(r, own, t))
FOR_HOOK(solve, (run * r, double t, int *made), ACTS, !*made,
         e->on.solve(r, own, t, made))
FOR_HOOK(initial, (run * r), ACTS, is_due(r, k), e->on.initial(r, own))
FOR_HOOK(load, (run * r, double t), ACTS, 1, e->on.load(r, own, t))
FOR_HOOK(pose, (run * r, double t), ACTS, 1, e->on.pose(r, own, t))
FOR_HOOK(rewrite, (run * r, contact_problem *cp, double **u, double *force),
         ACTS, is_due(r, k), e->on.rewrite(r, own, cp, u, force))
FOR_HOOK(found, (run * r, int *again), ACTS, !*again,
         e->on.found(r, own, again))
FOR_HOOK(examine, (run * r, double t), ACTS, 1, e->on.examine(r, own, t))
FOR_HOOK(estimate, (run * r), ACTS, !r->effects.on[k].borrowed,
         e->on.estimate(r, own))
FOR_HOOK(accept, (run * r), ACTS, is_due(r, k), e->on.accept(r, own))

void effects_restore(run *r, contact_problem *cp, double *u, double *force) {
  for (int k = r->effects.n - 1; k >= 0; --k)
    if (r->effects.on[k].ops->on.restore != NULL && is_due(r, k))
      r->effects.on[k].ops->on.restore(r, r->effects.on[k].state, cp, u, force);
}

void effects_describe(const run *r, setup_facts *f) {
  for (int k = 0; k < r->effects.n; ++k)
    if (r->effects.on[k].ops->on.describe != NULL)
      r->effects.on[k].ops->on.describe(r, r->effects.on[k].state, f);
}

void effects_forget(run *r) {
  for (int k = 0; k < r->effects.n; ++k) {
    const effect_ops *e = r->effects.on[k].ops;
    void *own = r->effects.on[k].state;
    const int stateless = e->size == 0 && e->on.create == NULL;
    if (e->on.forget != NULL && (own != NULL || stateless))
      e->on.forget(r, own);
  }
}

int effects_strain(const run *r, int elem_id) {
  int any = 0;
  for (int k = 0; k < r->effects.n && !any; ++k) {
    const effect_ops *e = r->effects.on[k].ops;
    any = e->strains != NULL && e->strains(r->m, elem_id);
  }
  return any;
}

void effects_end(run *r) {
  for (int k = 0; k < r->effects.n; ++k)
    if (r->effects.on[k].ops->on.end != NULL)
      r->effects.on[k].ops->on.end(r, r->effects.on[k].state);
}

int effects_reach_far(const run *r) {
  int any = 0;
  for (int k = 0; k < r->effects.n; ++k) any |= r->effects.on[k].ops->far;
  return any;
}

void effects_show(const run *r, state *s) {
  for (int k = 0; k < r->effects.n; ++k)
    if (r->effects.on[k].ops->on.show != NULL && is_due(r, k))
      r->effects.on[k].ops->on.show(r->effects.on[k].state, s);
}

status effects_keep(run *r, archive *a) {
  for (int k = 0; k < r->effects.n; ++k) {
    const effect_ops *e = r->effects.on[k].ops;
    if (e->on.keep == NULL) continue;
    IN_GROUP(a, e->name);
    PASS(e->on.keep(r, r->effects.on[k].state, a));
  }
  return OK;
}

status effects_copy(const run *from, run *copy) {
  effect_list *list = &copy->effects;
  list->n = 0;
  for (int k = 0; k < from->effects.n; ++k) {
    const effect_ops *e = from->effects.on[k].ops;
    void *of = from->effects.on[k].state, **own = &list->on[k].state;
    list->on[list->n++] = from->effects.on[k];
    list->on[k].borrowed = e->copy_as == COPY_BORROWS && e->on.copy == NULL;
    if (list->on[k].borrowed) continue;
    PASS(new_state(from, e, own));
    OWNS(*own);
    if (e->copy_as == COPY_IS_NEW && e->on.create != NULL)
      PASS(e->on.create(copy, own));
    if (e->copy_as == COPY_IS_EQUAL) memcpy(*own, of, size_of(from, e));
    if (e->on.copy != NULL) PASS(e->on.copy(from, of, copy, own));
  }
  return OK;
}
