/* Names to ids once all cards are read. */
#include "base/base.h"
#include "mesh/msh/geo.h"
#include "model/keyword/keyword.h"

int name_is_lost(const model *m, const char *name) {
  for (EACH(const card, c, m->deck->cards, m->deck->n_card)) {
    const parameter *p = card_parameter(c, "NAME");
    if (p != NULL && p->has_value && same_word(p->value.text, name) &&
        keyword_find(c->name) == NULL)
      return 1;
  }
  return 0;
}

/* find_name, silent if the name is lost. */
static int find_known(const model *m, const char *name, const char *title,
                      const name_list *names, const place *at) {
  const int i = rank_of_name(names, name);
  if (i >= 0 || name_is_lost(m, name)) return i;
  return find_name(m, name, title, names, at);
}

/* The points of a *PRINT that names some; an error if there are none. */
static void find_points(const model *m, print_request *p) {
  if (p->points_name == NULL) return;
  int i = find_known(m, p->points_name, "TIME POINTS",
                     NAMES(m->time.points, m->n.points), &p->points_at);
  if (i < 0) return;
  m->time.points[i].used = 1;
  p->points = &m->time.points[i];
}

static status resolve_laws(model *m, int lost) {
  for (int i = 0; i < m->n.material; ++i)
    PASS(material_resolve_law(m, &m->materials[i]));
  if (lost || m->n.step == 0 || has_card(m, "VISCO") ||
      message_count(m->log, ERROR) > 0)
    return OK;
  for (int i = 0; i < m->n.material; ++i)
    if (m->materials[i].law.ops != NULL && m->materials[i].used)
      message_add(m->log, P2048, &m->steps[0].at,
                  "material %s has the law %s, but no step is *VISCO",
                  m->materials[i].name, m->materials[i].law.ops->name);
  return OK;
}

static void resolve_materials(model *m, int lost) {
  for (EACH(section, s, m->sections, m->n.section)) {
    if (s->material_name[0] == '\0') continue;
    s->material_id =
        find_known(m, s->material_name, "MATERIAL",
                   NAMES(m->materials, m->n.material), &s->material_at);
    if (s->material_id >= 0) m->materials[s->material_id].used = 1;
  }
  for (int i = 0; i < m->n.material; ++i)
    if (!m->materials[i].has_elastic && !lost)
      message_add(m->log, P2014, &m->materials[i].at,
                  "material %s has no *ELASTIC card", m->materials[i].name);
}

/* An amplitude that multiplies a value of the model: it counts total time. */
static const value_table *total_amplitude(const model *m, const char *name,
                                          const place *at) {
  int a = find_amplitude(m, name, at);
  if (a < 0) return NULL;
  if (m->n.step > 1 && !m->time.amplitudes[a].total_time)
    message_add(
        m->log, P2044, at,
        "amplitude %s counts the total time here, whatever its TIME=", name);
  return &m->time.amplitudes[a].table;
}

/* The value of a card, its TABLE= or AMPLITUDE=. */
static void resolve_value(const model *m, const char *card_name,
                          quantity *value, const value_table *position,
                          const char *amplitude_name, const place *at) {
  /* Their owner is final: point into it now. */
  if (value->factor != NULL) value->factor = position;
  if (amplitude_name == NULL) return;
  const value_table *t = total_amplitude(m, amplitude_name, at);
  if (t == NULL) return;
  if (value->factor != NULL)
    message_add(m->log, P2033, at,
                "*%s: TABLE= and AMPLITUDE= exclude each other", card_name);
  value->factor = t;
}

/* Amplitudes and tables of a rule. */
static void resolve_friction(const model *m, friction_rule *rule) {
  resolve_value(m, "FRICTION", &rule->card.value, &rule->position,
                rule->amplitude_name, &rule->amplitude_at);
  if (rule->law != NULL && rule->law->value_name == NULL &&
      rule->amplitude_name != NULL)
    message_add(
        m->log, P2037, &rule->amplitude_at,
        "*FRICTION, LAW=%s has no value for AMPLITUDE=", rule->law->name);
}

/* A contact without an axis of its own has that of its obstacle. */
static void resolve_axis(const model *m, contact *c) {
  const obstacle *o = &m->obstacles[c->obstacle_id];
  if (c->has_axis || !o->turns) return;
  c->has_axis = c->axis_of_obstacle = 1;
  memcpy(c->axis_point, o->pivot, sizeof c->axis_point);
  memcpy(c->axis, o->axis, sizeof c->axis);
}

static void resolve_contacts(model *m) {
  for (EACH(contact, c, m->contacts, m->n.contact)) {
    resolve_friction(m, &c->friction);
    given_force *f = &c->force;
    resolve_value(m, "CONTACT FORCE", &f->value, &f->position,
                  f->amplitude_name, &f->amplitude_at);
    if (c->is_pair || c->obstacle_name[0] == '\0') continue;
    c->obstacle_id =
        find_known(m, c->obstacle_name, "OBSTACLE",
                   NAMES(m->obstacles, m->n.obstacle), &c->obstacle_at);
    if (c->obstacle_id < 0) continue;
    m->moves[c->obstacle_id].used = 1;
    resolve_axis(m, c);
    int shape = m->obstacles[c->obstacle_id].shape;
    if (c->obstacle_normal < 0) c->obstacle_normal = shape == OBSTACLE_PLANE;
    if (c->obstacle_normal &&
        (shape == OBSTACLE_CONFORMING || shape == OBSTACLE_GAP))
      message_add(m->log, P2004, &c->at,
                  "*CONTACT, NORMAL=OBSTACLE: obstacle %s has no normal of its "
                  "own; a plane, cylinder or sphere has",
                  c->obstacle_name);
  }
}

/* The ramp of motions without amplitude. */
static status make_first_step(model *m) {
  value_table *t = &m->time.first_step;
  if (m->n.step == 0 || (m->n.obstacle == 0 && !model_has_pairs(m))) return OK;
  PASS_NEW_REALS(2, &t->at, &t->value);
  t->variable = TABLE_T;
  t->n = 2;
  t->at[1] = m->steps[0].total;
  t->value[1] = 1.0;
  return OK;
}

/* A number without amplitude is reached at the end of the first step, as loads
 * are. */
static void lead(const model *m, const value_table *t, quantity *q) {
  if (t != NULL)
    q->factor = t;
  else if (m->time.first_step.n > 0 && q->formula == NULL && q->number != 0.0)
    q->factor = &m->time.first_step;
}

/* An interference is a motion, a clearance is there from the start. */
static void resolve_change(const model *m, gap_change *c) {
  const value_table *t = NULL;
  if (!c->given) return;
  if (c->amplitude_name != NULL)
    t = total_amplitude(m, c->amplitude_name, &c->amplitude_at);
  if (t != NULL || c->interferes) lead(m, t, &c->value);
}

static status resolve_moves(model *m) {
  PASS(make_first_step(m));
  for (int i = 0; i < m->n.obstacle; ++i) {
    const move *of = &m->moves[i];
    const value_table *t = NULL;
    if (of->amplitude_name != NULL)
      t = total_amplitude(m, of->amplitude_name, &of->amplitude_at);
    for (int k = 0; k < 3; ++k) lead(m, t, &m->obstacles[i].motion[k]);
    lead(m, t, &m->obstacles[i].angle);
  }
  for (int i = 0; i < m->n.contact; ++i)
    resolve_change(m, &m->contacts[i].change);
  return OK;
}

/* A name that nothing refers to is often a misspelled reference. */
static void warn_unused(const model *m) {
  static const char text[] = "*%s, NAME=%s is never used";
  for (int i = 0; i < m->n.amplitude; ++i)
    if (!m->time.amplitudes[i].used)
      message_add(m->log, P2036, &m->time.amplitudes[i].at, text, "AMPLITUDE",
                  m->time.amplitudes[i].name);
  for (int i = 0; i < m->n.points; ++i)
    if (!m->time.points[i].used)
      message_add(m->log, P2036, &m->time.points[i].at, text, "TIME POINTS",
                  m->time.points[i].name);
  for (int i = 0; i < m->n.material; ++i)
    if (!m->materials[i].used)
      message_add(m->log, P2036, &m->materials[i].at, text, "MATERIAL",
                  m->materials[i].name);
  for (int i = 0; i < m->n.obstacle; ++i)
    if (!m->moves[i].used)
      message_add(m->log, P2036, &m->moves[i].at, text, "OBSTACLE",
                  m->obstacles[i].name);
}

/* ---- steps one after the other: their loads, with those that stay from the
 * steps before, their solver, tables and fields. */

static const double CLOCK = 0x1p-42; /* -, least increment of the time */

/* Loads of one place and kind: gravity may have another direction. */
static int same_place(const load *a, const load *b) {
  return a->kind == b->kind && a->component == b->component &&
         strcmp(a->group, b->group) == 0;
}

/* The same load again: the new value replaces the old. */
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
    const amplitude *a = &m->time.amplitudes[l->amplitude_id];
    l->value.factor = &a->table;
    l->value.factor_start = a->total_time ? 0.0 : s->start;
  }
  if (quantity_variables(&l->value) & 8u) l->run = RUN_DIRECT;
}

/* How it continues in the step after "old". */
static load kept_load(const model *m, const step *old, const load *l) {
  load kept = *l;
  kept.has_before = 0;
  int step_time =
      l->amplitude_id >= 0 && !m->time.amplitudes[l->amplitude_id].total_time;
  if (l->run == RUN_HELD) return kept;
  if (l->run == RUN_DIRECT && !step_time) return kept;
  kept.run = RUN_HELD;
  kept.before_t = step_end(old);
  return kept;
}

/* Start value of a load that replaces "l" (or ends it); temperatures and
 * displacements start from what elements and nodes have. */
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
  for (EACH(const load, l, old->loads.item, old->loads.n)) {
    int again = 0, renewed = (s->renewed >> l->kind & 1u) != 0;
    if (l->removed) continue;
    for (EACH(load, own, s->loads.item, s->loads.n)) {
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

static int same_value(const load *a, const load *b) {
  return a->value.formula == NULL && b->value.formula == NULL &&
         a->value.number == b->value.number &&
         a->value.factor == b->value.factor;
}

/* Within one step the last card of the same load counts. */
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
  load_list all = {0};
  for (int i = 0; i < s->loads.n; ++i) start_load(m, s, &s->loads.item[i]);
  drop_repeated(m, &s->loads);
  PASS(carry_loads(m, old, s, &all));
  for (int i = 0; i < s->loads.n; ++i) {
    PASS_GROW(all.item, all.n, all.cap);
    all.item[all.n++] = s->loads.item[i];
  }
  memory_free(s->loads.item);
  s->loads = all;
  return OK;
}

static const solver_choice default_solver = {
    .ops = NULL, .param = NULL, .tol = 1e-10, .limit_max_iter = 1000};

/* Solver, tables and fields stay until changed. */
static status carry_choices(const step *old, step *s) {
  if (s->solver_at.file == NULL) {
    s->solver = old->solver;
    s->balanced = old->balanced;
    s->share = old->share;
    s->check = old->check;
  }
  if (!s->accuracy.given) s->accuracy = old->accuracy;
  if (!s->output.given) s->output = old->output;
  if (!s->restart.given) s->restart.frequency = old->restart.frequency;
  for (int i = 0; i < old->print.n && !s->print.given; ++i) {
    if (old->print.requests[i].table & s->print.ended) continue;
    PASS_GROW(s->print.requests, s->print.n, s->print.cap);
    s->print.requests[s->print.n++] = old->print.requests[i];
  }
  return OK;
}

/* Increments that the time of the step can resolve. */
static void check_clock(const model *m, const step *s) {
  if (s->dt >= CLOCK * fabs(s->start)) return;
  message_add(m->log, P2020, &s->at,
              "increments of %g are lost in the time %g at which the step "
              "starts, whose numbers are %.1g apart; let the steps before it "
              "take less time",
              s->dt, s->start, DBL_EPSILON * fabs(s->start));
}

/* steps.c: start, loads, solver and tables of each step, with what persists
 * from the one before. */
static status resolve_steps(model *m) {
  step before = {.solver = default_solver,
                 .loads = m->load.supports,
                 .output.frequency = 1,
                 .output.condensed = -1,
                 .accuracy.mesh = MESH_ERROR_END,
                 .restart.frequency = -1};
  for (int i = 0; i < before.loads.n; ++i)
    start_load(m, &before, &before.loads.item[i]);
  const step *old = &before;
  for (EACH(step, s, m->steps, m->n.step)) {
    s->start = step_end(old);
    check_clock(m, s);
    for (int k = 0; k < s->friction.n; ++k)
      resolve_friction(m, &s->friction.changes[k].rule);
    PASS(resolve_loads(m, old, s));
    for (int k = 0; k < s->print.n; ++k) find_points(m, &s->print.requests[k]);
    PASS(carry_choices(old, s));
    /* TOL=BALANCED requires the estimates it is balanced with. */
    if (s->balanced) {
      if (m->problem.given && s->solver_at.file != NULL)
        message_add(m->log, P2037, &s->solver_at,
                    "*SOLVER, TOL=BALANCED needs a mesh, whose error counts");
      if (m->n.contact > 0) s->accuracy.mesh = MESH_ERROR_YES;
      s->accuracy.no_solver = 0;
    }
    old = s;
  }
  return OK;
}

/* ---- names of *PARAMETER and -D that nothing uses: misspelt ones, which
 * leave the value they were to change as it was. Those of an included file may
 * serve other decks. */

/* The names of a deck but for one. */
typedef struct others {
  const deck *d;
  const symbol *but;
} others;

static const char *other_at(const void *ctx, int i) {
  const others *o = ctx;
  i += i >= o->but - o->d->symbols;
  return i < o->d->n_symbol ? o->d->symbols[i].name : NULL;
}

/* What may be meant: a name of the .geo but for upper and lower case, one of
 * the deck, one of the .geo. */
static const char *nearest_use(const model *m, const geo_text *g,
                               const symbol *s) {
  const char *word;
  for (int i = 0; (word = geo_name(g, i)) != NULL; ++i)
    if (same_word(s->name, word)) return word;
  const others o = {.d = m->deck, .but = s};
  word = nearest_word(s->name, other_at, &o);
  return word != NULL ? word : nearest_word(s->typed, geo_name, g);
}

static void report_unused(const model *m, const geo_text *g, const symbol *s) {
  const place line = {.file = "command line"};
  const char *near = nearest_use(m, g, s);
  message_add(m->log, P2042, s->at.file != NULL ? &s->at : &line,
              "%s%s is used neither in the deck nor in a .geo%s%s%s",
              s->at.file != NULL ? "*PARAMETER " : "-D ", s->typed,
              near != NULL ? "; did you mean " : "", near != NULL ? near : "",
              near != NULL ? "?" : "");
}

/* Names of *PARAMETER and -D that neither the deck nor the .geo uses
 * are errors; the others learn whether the .geo has them. */
static status check_symbols(const model *m) {
  ENDS_BY(geo_free) geo_text g = {0};
  if (m->mesh.file != NULL && mesh_is_program(m->mesh.file))
    PASS(geo_read(m->mesh.file, &g));
  for (int i = 1; i < g.n_file; ++i) PASS(deck_input_copy(m->deck, g.file[i]));
  for (EACH(symbol, s, m->deck->symbols, m->deck->n_symbol)) {
    s->in_geometry = geo_has(&g, s->typed);
    if (!s->used && !s->in_geometry && s->at.from == NULL)
      report_unused(m, &g, s);
  }
  return OK;
}

status model_resolve(model *m, int lost) {
  resolve_materials(m, lost);
  PASS(resolve_laws(m, lost));
  resolve_contacts(m);
  PASS(resolve_moves(m));
  PASS(resolve_steps(m));
  if (!lost && message_count(m->log, ERROR) == 0) {
    warn_unused(m);
    PASS(check_symbols(m));
  }
  return OK;
}
