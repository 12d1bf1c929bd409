/*
 * Names to ids once all cards are read, and the loads of each step: those of
 * the card, and those that stay from the steps before.
 */
#include "model/keyword.h"

#include "base/memory.h"

#include <string.h>

/* A list of names for the search and for "did you mean". */
typedef struct names {
  const model *m;
  const char *(*next)(const void *m, int i);
} names;

static const char *amplitude_at(const void *ctx, int i) {
  const model *m = ctx;
  return i < m->n_amplitude ? m->amplitudes[i].name : NULL;
}

static const char *material_at(const void *ctx, int i) {
  const model *m = ctx;
  return i < m->n_material ? m->materials[i].name : NULL;
}

static const char *obstacle_at(const void *ctx, int i) {
  const model *m = ctx;
  return i < m->n_obstacle ? m->obstacles[i].name : NULL;
}

/* Id of a name, or -1 and an error that names the card to write. */
static int find_name(const model *m, const char *name, const char *title,
                     const char *(*next)(const void *, int), const place *at) {
  const char *candidate;
  for (int i = 0; (candidate = next(m, i)) != NULL; ++i)
    if (same_word(candidate, name)) return i;
  const char *near = nearest_word(name, next, m);
  if (near != NULL)
    message_add(m->log, P2012, at, "there is no *%s, NAME=%s; did you mean %s?",
                title, name, near);
  else
    message_add(m->log, P2012, at, "there is no *%s, NAME=%s", title, name);
  return -1;
}

static void resolve_materials(model *m) {
  for (int i = 0; i < m->n_section; ++i) {
    section *s = &m->sections[i];
    if (s->material_name[0] == '\0') continue;
    s->material_id =
        find_name(m, s->material_name, "MATERIAL", material_at, &s->at);
  }
  for (int i = 0; i < m->n_material; ++i)
    if (m->materials[i].n_constant == 0)
      message_add(m->log, P2014, &m->materials[i].at,
                  "material %s has no *ELASTIC card, or one with errors",
                  m->materials[i].name);
}

static void resolve_contacts(model *m) {
  for (int i = 0; i < m->n_contact; ++i) {
    contact *c = &m->contacts[i];
    if (c->obstacle_name[0] != '\0')
      c->obstacle_id =
          find_name(m, c->obstacle_name, "OBSTACLE", obstacle_at, &c->at);
    if (c->obstacle_normal < 0)
      c->obstacle_normal = c->obstacle_id >= 0 &&
                           m->obstacles[c->obstacle_id].shape == OBSTACLE_PLANE;
    /* The array of contacts has reached its place: point into it now. */
    if (c->friction.value.factor != NULL)
      c->friction.value.factor = &c->position;
    if (c->amplitude_name == NULL) continue;
    int a = find_name(m, c->amplitude_name, "AMPLITUDE", amplitude_at,
                      &c->friction_at);
    if (a < 0) continue;
    if (c->friction.value.factor != NULL)
      message_add(m->log, P2033, &c->friction_at,
                  "*FRICTION: TABLE= and AMPLITUDE= exclude each other");
    c->friction.value.factor = &m->amplitudes[a].table;
  }
  for (int i = 0; i < m->n_obstacle; ++i) {
    if (m->moves[i].amplitude_name == NULL) continue;
    int a = find_name(m, m->moves[i].amplitude_name, "AMPLITUDE", amplitude_at,
                      &m->moves[i].at);
    if (a < 0) continue;
    for (int k = 0; k < 3; ++k)
      m->obstacles[i].motion[k].factor = &m->amplitudes[a].table;
  }
}

static double step_end(const step *s) { return s->start + s->total; }

/* Same thing said again: the new value replaces the old. */
static int same_load(const load *a, const load *b) {
  return a->kind == b->kind && a->component == b->component &&
         strcmp(a->group, b->group) == 0;
}

/* How a load of the card runs in its step. */
static void start_load(const model *m, const step *s, load *l) {
  l->run = RUN_RAMP;
  if (l->amplitude_name != NULL) {
    l->amplitude_id =
        find_name(m, l->amplitude_name, "AMPLITUDE", amplitude_at, &l->at);
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
  status st = OK;
  for (int i = 0; i < old->loads.n; ++i) {
    const load *l = &old->loads.item[i];
    int again = 0, renewed = (s->renewed >> l->kind & 1u) != 0;
    if (l->removed) continue;
    for (int k = 0; k < s->loads.n; ++k)
      if (same_load(l, &s->loads.item[k])) {
        again = 1;
        if (s->loads.item[k].run == RUN_RAMP)
          set_before(&s->loads.item[k], old, l);
      }
    if (again || (renewed && l->kind == LOAD_FIXING)) continue;
    GROW(all->item, all->n, all->cap);
    all->item[all->n++] = renewed ? ended_load(old, l) : kept_load(m, old, l);
  }
done:
  return st;
}

static status append_loads(load_list *all, const load_list *own) {
  status st = OK;
  for (int i = 0; i < own->n; ++i) {
    GROW(all->item, all->n, all->cap);
    all->item[all->n++] = own->item[i];
  }
done:
  return st;
}

/* Within one step the last card that says the same thing counts. */
static void drop_repeated(load_list *own) {
  int n = 0;
  for (int i = 0; i < own->n; ++i) {
    int later = 0;
    for (int k = i + 1; k < own->n; ++k)
      later |= same_load(&own->item[i], &own->item[k]);
    if (!later) own->item[n++] = own->item[i];
  }
  own->n = n;
}

static status resolve_loads(model *m, const step *old, step *s) {
  status st = OK;
  load_list all = {0};
  drop_repeated(&s->loads);
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

/* Solver, tables and fields stay until changed. */
static status carry_choices(const step *old, step *s) {
  status st = OK;
  if (s->solver_at.file == NULL) s->solver = old->solver;
  if (!s->has_output) {
    s->output_frequency = old->output_frequency;
    s->condensed_frequency = old->condensed_frequency;
  }
  for (int i = 0; i < old->n_print && !s->has_print; ++i) {
    GROW(s->prints, s->n_print, s->cap_print);
    s->prints[s->n_print++] = old->prints[i];
  }
done:
  return st;
}

status model_resolve(model *m) {
  status st = OK;
  resolve_materials(m);
  resolve_contacts(m);
  step before = {.solver = default_solver,
                 .loads = m->supports,
                 .condensed_frequency = -1};
  for (int i = 0; i < before.loads.n; ++i)
    start_load(m, &before, &before.loads.item[i]);
  const step *old = &before;
  for (int i = 0; i < m->n_step; ++i) {
    step *s = &m->steps[i];
    s->start = step_end(old);
    TRY(resolve_loads(m, old, s));
    TRY(carry_choices(old, s));
    old = s;
  }
done:
  return st;
}
