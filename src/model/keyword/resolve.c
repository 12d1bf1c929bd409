/*
 * Names to ids once all cards are read.
 */
#include "model/keyword/parts.h"

#include "base/memory.h"

#include <string.h>

static const char *material_at(const void *ctx, int i) {
  const model *m = ctx;
  return i < m->n_material ? m->materials[i].name : NULL;
}

static const char *obstacle_at(const void *ctx, int i) {
  const model *m = ctx;
  return i < m->n_obstacle ? m->obstacles[i].name : NULL;
}

static const char *points_at(const void *ctx, int i) {
  const model *m = ctx;
  return i < m->n_points ? m->points[i].name : NULL;
}

int name_is_lost(const model *m, const char *name) {
  for (int i = 0; i < m->deck->n_card; ++i) {
    const card *c = &m->deck->cards[i];
    const parameter *p = card_parameter(c, "NAME");
    if (p != NULL && p->has_value && same_word(p->value.text, name) &&
        keyword_find(c->name) == NULL)
      return 1;
  }
  return 0;
}

/* find_name, silent if the name is lost. */
static int find_known(const model *m, const char *name, const char *title,
                      const char *(*next)(const void *, int), const place *at) {
  const char *word;
  for (int i = 0; (word = next(m, i)) != NULL; ++i)
    if (same_word(name, word)) return i;
  return name_is_lost(m, name) ? -1 : find_name(m, name, title, next, at);
}

void find_points(const model *m, print_request *p) {
  if (p->points_name == NULL) return;
  int i =
      find_known(m, p->points_name, "TIME POINTS", points_at, &p->points_at);
  if (i < 0) return;
  m->points[i].used = 1;
  p->points = &m->points[i];
}

static status resolve_laws(model *m, int lost) {
  for (int i = 0; i < m->n_material; ++i)
    PASS(material_resolve_law(m, &m->materials[i]));
  if (lost || m->n_step == 0 || has_card(m, "VISCO") ||
      message_count(m->log, ERROR) > 0)
    return OK;
  for (int i = 0; i < m->n_material; ++i)
    if (m->materials[i].law.ops != NULL && m->materials[i].used)
      message_add(m->log, P2048, &m->steps[0].at,
                  "material %s has the law %s, but no step is *VISCO",
                  m->materials[i].name, m->materials[i].law.ops->name);
  return OK;
}

static void resolve_materials(model *m, int lost) {
  for (int i = 0; i < m->n_section; ++i) {
    section *s = &m->sections[i];
    if (s->material_name[0] == '\0') continue;
    s->material_id = find_known(m, s->material_name, "MATERIAL", material_at,
                                &s->material_at);
    if (s->material_id >= 0) m->materials[s->material_id].used = 1;
  }
  for (int i = 0; i < m->n_material; ++i)
    if (!m->materials[i].has_elastic && !lost)
      message_add(m->log, P2014, &m->materials[i].at,
                  "material %s has no *ELASTIC card", m->materials[i].name);
}

/* An amplitude that multiplies a value of the model: it counts total time. */
static const value_table *total_amplitude(const model *m, const char *name,
                                          const place *at) {
  int a = find_amplitude(m, name, at);
  if (a < 0) return NULL;
  if (m->n_step > 1 && !m->amplitudes[a].total_time)
    message_add(
        m->log, P2044, at,
        "amplitude %s counts the total time here, whatever its TIME=", name);
  return &m->amplitudes[a].table;
}

/* The value of a card, its TABLE= or AMPLITUDE=. */
static void resolve_value(const model *m, const char *card_name,
                          quantity *value, const value_table *position,
                          const char *amplitude_name, const place *at) {
  /* What holds them has reached its place: point into it now. */
  if (value->factor != NULL) value->factor = position;
  if (amplitude_name == NULL) return;
  const value_table *t = total_amplitude(m, amplitude_name, at);
  if (t == NULL) return;
  if (value->factor != NULL)
    message_add(m->log, P2033, at,
                "*%s: TABLE= and AMPLITUDE= exclude each "
                "other",
                card_name);
  value->factor = t;
}

void resolve_friction(const model *m, friction_rule *rule) {
  resolve_value(m, "FRICTION", &rule->card.value, &rule->position,
                rule->amplitude_name, &rule->amplitude_at);
  if (rule->law != NULL && rule->law->value_name == NULL &&
      rule->amplitude_name != NULL)
    message_add(
        m->log, P2037, &rule->amplitude_at,
        "*FRICTION, LAW=%s has no value for AMPLITUDE=", rule->law->name);
}

static void resolve_force(const model *m, given_force *f) {
  resolve_value(m, "CONTACT FORCE", &f->value, &f->position, f->amplitude_name,
                &f->amplitude_at);
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
  for (int i = 0; i < m->n_contact; ++i) {
    contact *c = &m->contacts[i];
    resolve_friction(m, &c->friction);
    resolve_force(m, &c->force);
    if (c->obstacle_name[0] == '\0') continue;
    c->obstacle_id = find_known(m, c->obstacle_name, "OBSTACLE", obstacle_at,
                                &c->obstacle_at);
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

/* The ramp of motions that nothing else leads. */
static status make_first_step(model *m) {
  value_table *t = &m->first_step;
  if (m->n_step == 0 || m->n_obstacle == 0) return OK;
  PASS_NEW(t->at, 2);
  PASS_NEW(t->value, 2);
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
  else if (m->first_step.n > 0 && q->formula == NULL && q->number != 0.0)
    q->factor = &m->first_step;
}

static status resolve_moves(model *m) {
  PASS(make_first_step(m));
  for (int i = 0; i < m->n_obstacle; ++i) {
    const move *of = &m->moves[i];
    const value_table *t = NULL;
    if (of->amplitude_name != NULL)
      t = total_amplitude(m, of->amplitude_name, &of->amplitude_at);
    for (int k = 0; k < 3; ++k) lead(m, t, &m->obstacles[i].motion[k]);
    lead(m, t, &m->obstacles[i].angle);
  }
  return OK;
}

/* A name that nothing refers to is often a misspelled reference. */
static void warn_unused(const model *m) {
  static const char text[] = "*%s, NAME=%s is never used";
  for (int i = 0; i < m->n_amplitude; ++i)
    if (!m->amplitudes[i].used)
      message_add(m->log, P2036, &m->amplitudes[i].at, text, "AMPLITUDE",
                  m->amplitudes[i].name);
  for (int i = 0; i < m->n_points; ++i)
    if (!m->points[i].used)
      message_add(m->log, P2036, &m->points[i].at, text, "TIME POINTS",
                  m->points[i].name);
  for (int i = 0; i < m->n_material; ++i)
    if (!m->materials[i].used)
      message_add(m->log, P2036, &m->materials[i].at, text, "MATERIAL",
                  m->materials[i].name);
  for (int i = 0; i < m->n_obstacle; ++i)
    if (!m->moves[i].used)
      message_add(m->log, P2036, &m->moves[i].at, text, "OBSTACLE",
                  m->obstacles[i].name);
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
