/*
 * Steps one after the other: their loads, with those that stay from the steps
 * before, their solver, tables and fields.
 */
#include "model/keyword/parts.h"

#include "base/memory.h"

#include <float.h>
#include <math.h>
#include <string.h>

static const double CLOCK = 0x1p-42; /* -, least increment of the time        */

static double step_end(const step *s) { return s->start + s->total; }

/* Loads of one place and kind: gravity may have another direction. */
static int same_place(const load *a, const load *b) {
  return a->kind == b->kind && a->component == b->component &&
         strcmp(a->group, b->group) == 0;
}

/* Same thing said again: the new value replaces the old. */
static int same_load(const load *a, const load *b) {
  return same_place(a, b) &&
         memcmp(a->direction, b->direction, sizeof a->direction) == 0;
}

/* How a load of the card runs in its step. */
static void start_load(const model *m, const step *s, load *l) {
  l->run = RUN_RAMP;
  if (l->amplitude_name != NULL) {
    l->amplitude_id = find_amplitude(m, l->amplitude_name, &l->amplitude_at);
    if (l->amplitude_id < 0) return;
    const amplitude *a = &m->amplitudes[l->amplitude_id];
    l->value.factor = &a->table;
    l->value.factor_start = a->total_time ? 0.0 : s->start;
  }
  if (quantity_variables(&l->value) & 8u) l->run = RUN_DIRECT;
}

/* How it goes on in the step after "old". */
static load kept_load(const model *m, const step *old, const load *l) {
  load kept = *l;
  kept.has_before = 0;
  int step_time =
      l->amplitude_id >= 0 && !m->amplitudes[l->amplitude_id].total_time;
  if (l->run == RUN_HELD) return kept;
  if (l->run == RUN_DIRECT && !step_time) return kept;
  kept.run = RUN_HELD;
  kept.before_t = step_end(old);
  return kept;
}

/* Where a load that replaces "l" (or ends it) starts from. */
static void set_before(load *now, const step *old, const load *l) {
  now->before = l->value;
  now->before_file = l->file;
  now->has_before = 1;
  now->before_t = l->run == RUN_HELD ? l->before_t : step_end(old);
}

static load ended_load(const step *old, const load *l) {
  load end = *l;
  end.value = (quantity){.number = 0.0};
  end.run = RUN_RAMP;
  end.amplitude_id = -1;
  end.removed = 1;
  set_before(&end, old, l);
  return end;
}

/* Loads of the step before that its own cards neither replace nor end. */
static status carry_loads(const model *m, const step *old, step *s,
                          load_list *all) {
  for (int i = 0; i < old->loads.n; ++i) {
    const load *l = &old->loads.item[i];
    int again = 0, renewed = (s->renewed >> l->kind & 1u) != 0;
    if (l->removed) continue;
    for (int k = 0; k < s->loads.n; ++k) {
      load *own = &s->loads.item[k];
      int same = same_load(l, own);
      again |= same;
      /* Gravity in another direction takes the place of the old, which ends. */
      renewed |= !same && same_place(l, own);
      if (same && own->run == RUN_RAMP) set_before(own, old, l);
    }
    if (again || (renewed && l->kind == LOAD_FIXING)) continue;
    PASS_GROW(all->item, all->n, all->cap);
    all->item[all->n++] = renewed ? ended_load(old, l) : kept_load(m, old, l);
  }
  return OK;
}

static status append_loads(load_list *all, const load_list *own) {
  for (int i = 0; i < own->n; ++i) {
    PASS_GROW(all->item, all->n, all->cap);
    all->item[all->n++] = own->item[i];
  }
  return OK;
}

static int same_value(const load *a, const load *b) {
  return a->value.formula == NULL && b->value.formula == NULL &&
         a->value.number == b->value.number &&
         a->amplitude_name == b->amplitude_name;
}

/* Within one step the last card that says the same thing counts. */
static void drop_repeated(const model *m, load_list *own) {
  int n = 0;
  for (int i = 0; i < own->n; ++i) {
    int later = 0;
    for (int k = i + 1; k < own->n && later == 0; ++k)
      if (same_load(&own->item[i], &own->item[k])) later = k;
    if (later > 0 && !same_value(&own->item[i], &own->item[later]))
      message_add(m->log, P2040, &own->item[i].at,
                  "line %d of the same step gives group %s another value, "
                  "which counts",
                  own->item[later].at.line_no, own->item[i].group);
    if (later == 0) own->item[n++] = own->item[i];
  }
  own->n = n;
}

static status resolve_loads(model *m, const step *old, step *s) {
  status st = OK;
  load_list all = {0};
  drop_repeated(m, &s->loads);
  for (int i = 0; i < s->loads.n; ++i) start_load(m, s, &s->loads.item[i]);
  TRY(carry_loads(m, old, s, &all));
  TRY(append_loads(&all, &s->loads));
  memory_free(s->loads.item);
  s->loads = all;
  all.item = NULL;
done:
  memory_free(all.item);
  return st;
}

static const solver_choice default_solver = {
    .ops = NULL, .param = NULL, .tol = 1e-10, .limit_max_iter = 1000};

/* TOL=BALANCED calls for the estimates it is balanced with. */
static void call_estimates(const model *m, step *s) {
  if (!s->balanced) return;
  if (m->has_problem && s->solver_at.file != NULL)
    message_add(m->log, P2037, &s->solver_at,
                "*SOLVER, TOL=BALANCED needs a mesh, whose error counts");
  s->mesh_error |= m->n_contact > 0;
  s->no_solver_error = 0;
}

/* Solver, tables and fields stay until changed. */
static status carry_choices(const step *old, step *s) {
  if (s->solver_at.file == NULL) {
    s->solver = old->solver;
    s->balanced = old->balanced;
    s->share = old->share;
    s->check = old->check;
  }
  if (!s->has_accuracy) {
    s->no_solver_error = old->no_solver_error;
    s->mesh_error = old->mesh_error;
    s->time_error = old->time_error;
    s->time_balanced = old->time_balanced;
    s->time_share = old->time_share;
    s->theorems = old->theorems;
  }
  if (!s->has_output) {
    s->output_frequency = old->output_frequency;
    s->condensed_frequency = old->condensed_frequency;
  }
  if (!s->has_restart) s->restart_frequency = old->restart_frequency;
  for (int i = 0; i < old->n_print && !s->has_print; ++i) {
    PASS_GROW(s->prints, s->n_print, s->cap_print);
    s->prints[s->n_print++] = old->prints[i];
  }
  return OK;
}

/* Increments that the time of the step can tell apart. */
static void check_clock(const model *m, const step *s) {
  if (s->dt >= CLOCK * fabs(s->start)) return;
  message_add(m->log, P2020, &s->at,
              "increments of %g are lost in the time %g at which the step "
              "starts, whose numbers are %.1g apart; let the steps before it "
              "take less time",
              s->dt, s->start, DBL_EPSILON * fabs(s->start));
}

status resolve_steps(model *m) {
  step before = {.solver = default_solver,
                 .loads = m->supports,
                 .condensed_frequency = -1,
                 .restart_frequency = -1};
  for (int i = 0; i < before.loads.n; ++i)
    start_load(m, &before, &before.loads.item[i]);
  const step *old = &before;
  for (int i = 0; i < m->n_step; ++i) {
    step *s = &m->steps[i];
    s->start = step_end(old);
    check_clock(m, s);
    for (int k = 0; k < s->n_change; ++k)
      resolve_friction(m, &s->changes[k].rule);
    PASS(resolve_loads(m, old, s));
    for (int k = 0; k < s->n_print; ++k) find_points(m, &s->prints[k]);
    PASS(carry_choices(old, s));
    call_estimates(m, s);
    old = s;
  }
  return OK;
}
