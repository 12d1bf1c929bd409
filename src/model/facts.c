/*
 * Facts of the deck: the first card or step of a kind, if any.
 */
#include "base/base.h"
#include "model/facts.h"

const char *place_file(const place *at) {
  const char *file = at->file != NULL ? at->file : "deck";
  const char *slash = strrchr(file, '/');
  return slash != NULL ? slash + 1 : file;
}

const friction_rule *friction_in_force(const model *m, int step_id,
                                       int contact_id) {
  for (int i = step_id; i >= 0; --i)
    for (int k = 0; k < m->steps[i].friction.n; ++k)
      if (m->steps[i].friction.changes[k].contact_id == contact_id)
        return &m->steps[i].friction.changes[k].rule;
  return &m->contacts[contact_id].friction;
}

const effect_card *model_effect_card(const model *m, const char *keyword,
                                     int contact_id) {
  for (int i = m->n.effect_card - 1; i >= 0; --i) {
    const effect_card *c = &m->effect_cards[i];
    if (strcmp(c->keyword, keyword) == 0 &&
        (contact_id < 0 || c->contact_id < 0 || c->contact_id == contact_id))
      return c;
  }
  return NULL;
}

int rule_has_friction(const friction_rule *rule) {
  if (rule->law == NULL || rule->law->value_name == NULL) return 0;
  const quantity *q = &rule->card.value;
  return q->formula != NULL || q->number != 0.0;
}

int rule_has_average(const friction_rule *rule) {
  return rule_has_friction(rule) && rule->law->average != NULL;
}

int model_is_axisymmetric(const model *m) {
  return m->n.section > 0 && m->sections[0].kin == AXISYMMETRIC;
}

int model_has_axis(const model *m) {
  int any = 0;
  for (int i = 0; i < m->n.contact; ++i) any |= m->contacts[i].has_axis;
  return any;
}

int model_writes_fields(const model *m) {
  for (int i = 0; i < m->n.step; ++i)
    if (m->steps[i].output.frequency >= 0) return 1;
  return 0;
}

/* 1 if the step before holds the same component of the same group. */
static int held_before(const model *m, int step_id, const load *l) {
  if (step_id == 0) return 1;
  const load_list *old = &m->steps[step_id - 1].loads;
  for (int k = 0; k < old->n; ++k)
    if (old->item[k].kind == LOAD_FIXING &&
        old->item[k].component == l->component &&
        old->item[k].group_id == l->group_id)
      return 1;
  return 0;
}

const load *facts_moving_support(const model *m) {
  for (int i = 0; i < m->n.step; ++i)
    for (EACH(const load, l, m->steps[i].loads.item, m->steps[i].loads.n)) {
      if (l->kind != LOAD_FIXING) continue;
      int let_go = i + 1 < m->n.step &&
                   (m->steps[i + 1].renewed >> LOAD_FIXING & 1u) != 0;
      if (l->value.formula != NULL || l->value.number != 0.0 || l->has_before ||
          let_go || !held_before(m, i, l))
        return l;
    }
  return NULL;
}

const section *facts_first_inelastic(const model *m) {
  for (int i = 0; i < m->n.section; ++i) {
    const int id = m->sections[i].material_id;
    if (id >= 0 && id < m->n.material && m->materials[id].law.ops != NULL)
      return &m->sections[i];
  }
  return NULL;
}

int facts_has_initial(const model *m, int type) {
  for (int i = 0; i < m->n.initial; ++i)
    if (m->initial.lines[i].type == type) return 1;
  return 0;
}

int facts_starts_strained(const model *m) {
  int units = 0;
  for (EACH(const material, mat, m->materials, m->n.material))
    units |= mat->used && mat->law.ops != NULL && mat->law.ops->units != NULL;
  return facts_has_initial(m, INITIAL_STRAIN) ||
         (units && facts_has_initial(m, INITIAL_INTERNAL));
}

int facts_has_inelastic(const model *m) {
  return facts_first_inelastic(m) != NULL &&
         (has_card(m, "VISCO") || facts_starts_strained(m));
}

int model_flows(const model *m, int elem_id) {
  const section *s = &m->sections[m->elem_section[elem_id]];
  const material *mat = &m->materials[s->material_id];
  return mat->law.ops != NULL &&
         !(mat->is_still && m->reduction.still[elem_id]);
}

const step *facts_first_step(const model *m, int (*is)(const step *s)) {
  for (int i = 0; i < m->n.step; ++i)
    if (is(&m->steps[i])) return &m->steps[i];
  return NULL;
}

const char *facts_reads_entries(const model *m, const step *s) {
  if (s->solver.ops != NULL && s->solver.ops->entries != NULL)
    return s->solver.ops->entries;
  if (s->check != CHECK_NONE) return "CHECK of *SOLVER";
  if (s->accuracy.theorems) return "THEORY of *ACCURACY";
  if (s->output.condensed >= 0) return "CONDENSED of *OUTPUT";
  return m->effects & EFFECT_GIVEN ? "*CONTACT FORCE" : NULL;
}

status model_find_corner(model *m, const mesh *msh) {
  m->mesh.corner_id = -1;
  OWNED_NEW(int, of, msh->n_node);
  for (int i = 0; i < m->n.contact; ++i) {
    if (m->contacts[i].group_id < 0) continue;
    const mesh_group *g = &msh->group[m->contacts[i].group_id];
    for (int k = 0; k < g->n_node; ++k) {
      int *owner = &of[g->node_id[k]];
      if (*owner > 0 && *owner != i + 1) m->mesh.corner_id = i;
      *owner = i + 1;
    }
  }
  return OK;
}

const char *contact_card(const contact *c) {
  if (c->is_crack) return "*CRACK";
  return c->is_pair ? "*CONTACT PAIR" : "*CONTACT";
}

int model_is_interface(const model *m, const mesh *msh, int contact_id) {
  const int *of = m->elem_section;
  for (int i = 0; i < msh->n_crack; ++i)
    for (int k = 0; k < msh->crack[i].n; ++k)
      if (m->mesh.cracks[i].contact_id == contact_id &&
          of[msh->face_elem[msh->crack[i].plus[k]]] !=
              of[msh->face_elem[msh->crack[i].minus[k]]])
        return 1;
  return 0;
}

int model_has_pairs(const model *m) {
  int any = m->n.tie > 0;
  for (int i = 0; i < m->n.contact; ++i) any |= m->contacts[i].is_pair;
  return any;
}

int model_updates_pairs(const model *m) {
  int any = 0;
  for (int i = 0; i < m->n.contact; ++i) any |= m->contacts[i].update;
  return any;
}

const step *facts_first_whole(const model *m) {
  for (EACH(const step, s, m->steps, m->n.step))
    if (s->output.condensed >= 0 || s->check != CHECK_NONE ||
        s->accuracy.theorems)
      return s;
  return NULL;
}

int model_rubs_locally(const model *m) {
  int local = m->mesh.corner_id < 0 && facts_first_whole(m) == NULL;
  for (int i = 0; i < m->n.step; ++i) {
    local = local && m->steps[i].form == FORM_DISPLACEMENT;
    for (int k = 0; k < m->n.contact; ++k) {
      const friction_rule *rule = friction_in_force(m, i, k);
      local =
          local && (!rule_has_friction(rule) || rule->law == &coulomb_friction);
    }
  }
  return local;
}

int facts_leaves_axis(const model *m, int obstacle_id, double t) {
  const obstacle *o = &m->obstacles[obstacle_id];
  return model_is_axisymmetric(m) && o->shape == OBSTACLE_SPHERE &&
         quantity_value(&o->motion[0], o->point, t) != 0.0;
}

const char *model_unit(const model *m, const char *unit) {
  const char *const words[] = {"length", "force", "time"};
  const char *const labels[] = {m->unit.length, m->unit.force, m->unit.time};
  enum { LABEL = 80 };
  char *text = text_buffer();
  size_t used = 0;
  text[0] = '\0';
  while (*unit != '\0' && used + 1 < LABEL) {
    int k = 0;
    while (k < 3 && strncmp(unit, words[k], strlen(words[k])) != 0) ++k;
    int known = k < 3 && labels[k] != NULL;
    int n = known ? snprintf(text + used, LABEL - used, "%s", labels[k])
                  : snprintf(text + used, LABEL - used, "%c", *unit);
    unit += known ? strlen(words[k]) : 1;
    used += n;
  }
  for (char *p = text; (p = strpbrk(p, " \t\v\f[]")) != NULL;) *p = '_';
  return text;
}

const char *model_goal_unit(const model *m, int id) {
  static const char *const units[] = {
      [GOAL_FORCE] = "force",           [GOAL_PRESSURE] = "force/length^2",
      [GOAL_WIDTH] = "length",          [GOAL_DISPLACEMENT] = "length",
      [GOAL_STRESS] = "force/length^2", [GOAL_ENERGY] = "force*length",
      [GOAL_FRICTION] = "force*length", [GOAL_MOMENT] = "force*length",
      [GOAL_SIF] = "force/length^1.5"};
  return model_unit(m, units[m->accuracy.goals[id].quantity]);
}

const goal_card *model_targeted_goal(const model *m) {
  for (int i = 0; i < m->n.goal; ++i)
    if (m->accuracy.goals[i].target > 0.0) return &m->accuracy.goals[i];
  return NULL;
}

int model_has_target(const model *m) {
  return m->accuracy.target.percent > 0.0 || model_targeted_goal(m) != NULL;
}
