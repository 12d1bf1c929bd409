/*
 * Input without effect is reported, as it is seldom intended.
 */
#include "model/check/parts.h"

#include <math.h>

/* 1 if the temperature changes something of the material. */
static int feels_heat(const material *mat) {
  return mat->expand.given || mat->elastic.n > 1 ||
         (mat->law.ops != NULL &&
          (law_varies(&mat->law) & LAW_VARIES_TEMPERATURE));
}

/* Data of a material over temperature where no temperature is given. */
static void check_material(const model *m, const material *mat) {
  if (!mat->used || (m->effects & EFFECT_THERMAL)) return;
  if (mat->expand.given)
    message_add(m->log, P2058, &mat->at,
                "material %s: *EXPANSION does nothing, as no temperature is "
                "given",
                mat->name);
  if (mat->law.ops != NULL &&
      (law_varies(&mat->law) & LAW_VARIES_TEMPERATURE) != 0)
    message_add(m->log, P2049, &mat->at,
                "material %s: its law depends on temperature, but no "
                "temperature is given: what it is at 0 is taken",
                mat->name);
}

/* A step in which strains could flow. */
static void check_flow(const model *m, const step *s) {
  if (s->kind != STEP_VISCO) return;
  for (int i = 0; i < m->n.material; ++i)
    if (m->materials[i].used && m->materials[i].law.ops != NULL) return;
  message_add(m->log, P2058, &s->at,
              "*VISCO: no material has a law that flows; the step is "
              "*QUASISTATIC");
}

/* 1 if some element of a group depends on the temperature. */
static int group_feels_heat(const model *m, const mesh_group *g) {
  for (int k = 0; k < g->n_item; ++k) {
    const section *s = &m->sections[m->elem_section[g->item_id[k]]];
    if (feels_heat(&m->materials[s->material_id])) return 1;
  }
  return 0;
}

/* A temperature that a card gives to a group. */
static void check_heat(const model *m, const mesh *msh, const char *name,
                       int group_id, const place *at) {
  if (group_id < 0 || group_feels_heat(m, &msh->group[group_id])) return;
  message_add(m->log, P2058, at,
              "*%s on group %s does nothing: no material there has "
              "*EXPANSION, *TRS or moduli over temperature",
              name, msh->group[group_id].name);
}

/* z is zero in the plane, whatever the mesh has. */
static void check_z(const model *m, const mesh *msh, const quantity *q,
                    const char *name, const place *at) {
  if (msh->dim == 3 || (quantity_variables(q) & 4u) == 0) return;
  message_add(
      m->log, P2058, at,
      "*%s: the value depends on z, which is the same everywhere in 2-D", name);
}

static const char *card_of(const load *l) {
  switch ((load_kind)l->kind) {
    case LOAD_PRESSURE:
    case LOAD_TRACTION:
      return "DSLOAD";
    case LOAD_BODY:
    case LOAD_GRAVITY:
      return "DLOAD";
    case LOAD_TEMPERATURE:
      return "TEMPERATURE";
    case LOAD_POINT:
      return "CLOAD";
    default:
      return "BOUNDARY";
  }
}

/* On the axis u_r = 0, or the hoop strain u_r/r is without limit. */
static void check_axis(const model *m, const mesh *msh, const step *s,
                       const load *l) {
  static const double rounding = 1e-9; /* of the size of the mesh */
  if (l->kind != LOAD_FIXING || l->component != 0 || l->group_id < 0) return;
  const mesh_group *g = &msh->group[l->group_id];
  for (int k = 0; k < g->n_node; ++k) {
    int node = g->node_id[k];
    if (msh->x[(size_t)msh->dim * (size_t)node] > rounding * msh->size)
      continue;
    double u = load_at_node(l, msh, s, node, s->start + s->total);
    if (u == 0.0) continue;
    message_add(m->log, P2059, &l->at,
                "*BOUNDARY: u_r = %g at node %zu on the axis of symmetry", u,
                msh->node_no[node]);
    return;
  }
}

/* 1 if a time is in a step that prints at these times. */
static int is_printed(const model *m, const time_points *p, double t) {
  for (int i = 0; i < m->n.step; ++i) {
    const step *s = &m->steps[i];
    double first = p->total_time ? s->start : 0.0;
    double rounding = 1e-9 * s->total;
    if (t < first - rounding || t > first + s->total + rounding) continue;
    for (int k = 0; k < s->print.n; ++k)
      if (s->print.requests[k].points == p) return 1;
  }
  return 0;
}

static void check_times(const model *m, const time_points *p) {
  int missed = 0, first = -1;
  if (!p->used) return;
  for (int i = 0; i < p->n; ++i) {
    if (is_printed(m, p, p->t[i])) continue;
    if (missed++ == 0) first = i;
  }
  if (missed > 0)
    message_add(m->log, P2058, &p->at,
                "*TIME POINTS, NAME=%s: %d of %d times, the first %g, in no "
                "step that prints at them",
                p->name, missed, p->n, p->t[first]);
}

static void check_friction(const model *m, const mesh *msh,
                           const friction_rule *rule) {
  if (rule->law == NULL) return;
  check_z(m, msh, &rule->card.value, "FRICTION", &rule->value_at);
  if (rule->law->value_name != NULL && !rule_has_friction(rule))
    message_add(m->log, P2058, &rule->value_at,
                "*FRICTION, LAW=%s: %s = 0 is no friction", rule->law->name,
                rule->law->value_name);
}

static void check_contact(const model *m, const mesh *msh, const contact *c) {
  check_friction(m, msh, &c->friction);
  if (c->force.given)
    check_z(m, msh, &c->force.value, "CONTACT FORCE", &c->force.value_at);
  if (c->change.given)
    check_z(m, msh, &c->change.value, "CONTACT PAIR", &c->change.at);
}

static void check_tables(const model *m, const step *s) {
  const effect_card *wear = model_effect_card(m, "WEAR", -1);
  if (wear != NULL && s->accuracy.time_balanced)
    message_add(m->log, P2058, &s->accuracy.at,
                "*ACCURACY, TIME=BALANCED: the increments stay those of the "
                "step, as their error under *WEAR, line %d, is not known",
                wear->at.line_no);
  for (int k = 0; k < s->print.n; ++k)
    if (s->print.requests[k].table == PRINT_WEAR &&
        model_effect_card(m, "WEAR", -1) == NULL)
      message_add(m->log, P2058, &s->print.requests[k].at,
                  "*PRINT, WEAR: no contact has *WEAR");
    else if (s->print.requests[k].table == PRINT_GOALS && m->n.goal == 0)
      message_add(m->log, P2058, &s->print.requests[k].at,
                  "*PRINT, GOALS: there is no *GOAL");
    else if (s->print.requests[k].table == PRINT_SIF && m->n.crack == 0)
      message_add(m->log, P2058, &s->print.requests[k].at,
                  "*PRINT, SIF: there is no *CRACK");
    else if (s->print.requests[k].table == PRINT_SIF &&
             m->sections[0].kin == AXISYMMETRIC)
      message_add(m->log, P2058, &s->print.requests[k].at,
                  "*PRINT, SIF: there are no factors of axisymmetric bodies");
}

void check_no_effect(const model *m, const mesh *msh) {
  int axisymmetric = m->n.section > 0 && m->sections[0].kin == AXISYMMETRIC;
  for (int i = 0; i < m->n.points; ++i) check_times(m, &m->time.points[i]);
  for (int i = 0; i < m->n.material; ++i) check_material(m, &m->materials[i]);
  for (int i = 0; i < m->n.initial; ++i)
    if (m->initial.lines[i].type == INITIAL_TEMPERATURE)
      check_heat(m, msh, "INITIAL CONDITIONS", m->initial.lines[i].group_id,
                 &m->initial.lines[i].at);
  for (int i = 0; i < m->n.contact; ++i) check_contact(m, msh, &m->contacts[i]);
  for (int i = 0; i < m->n.step; ++i) {
    const step *s = &m->steps[i];
    check_flow(m, s);
    check_tables(m, s);
    for (int k = 0; k < s->friction.n; ++k)
      check_friction(m, msh, &s->friction.changes[k].rule);
    for (int k = 0; k < s->loads.n; ++k) {
      const load *l = &s->loads.item[k];
      if (l->removed) continue;
      if (l->kind == LOAD_TEMPERATURE)
        check_heat(m, msh, "TEMPERATURE", l->group_id, &l->at);
      check_z(m, msh, &l->value, card_of(l), &l->at);
      if (axisymmetric) check_axis(m, msh, s, l);
    }
  }
}
