/*
 * Which effects a deck calls for. What is off is neither allocated nor
 * computed; the listing says for each effect why it is on or off.
 */
#include "base/memory.h"
#include "model/model.h"

#include <stdio.h>
#include <string.h>

const char *effect_name(int bit) {
#define EFFECT_TEXT(name, text) text,
  static const char *const names[] = {EFFECT_LIST(EFFECT_TEXT)};
  return names[bit];
}

const char *place_file(const place *at) {
  const char *file = at->file != NULL ? at->file : "deck";
  const char *slash = strrchr(file, '/');
  return slash != NULL ? slash + 1 : file;
}

/* For "%s:%d": file without folder, line. */
#define PLACE(at) place_file(&(at)), (at).line_no

const friction_rule *friction_in_force(const model *m, int step_id,
                                       int contact_id) {
  for (int i = step_id; i >= 0; --i)
    for (int k = 0; k < m->steps[i].n_change; ++k)
      if (m->steps[i].changes[k].contact_id == contact_id)
        return &m->steps[i].changes[k].rule;
  return &m->contacts[contact_id].friction;
}

int rule_has_friction(const friction_rule *rule) {
  if (rule->law == NULL || rule->law->value_name == NULL) return 0;
  const quantity *q = &rule->card.value;
  return q->formula != NULL || q->number != 0.0;
}

int rule_has_average(const friction_rule *rule) {
  return rule_has_friction(rule) && rule->law->average != NULL;
}

/* The first rule in any step that is like that, and its contact; or NULL. */
static const friction_rule *first_rule(const model *m,
                                       int (*is)(const friction_rule *rule),
                                       const contact **of) {
  for (int i = 0; i < m->n_contact; ++i)
    for (int k = 0; k < m->n_step; ++k) {
      const friction_rule *rule = friction_in_force(m, k, i);
      *of = &m->contacts[i];
      if (is(rule)) return rule;
    }
  return NULL;
}

static int has_friction(const model *m) {
  const contact *of;
  return first_rule(m, rule_has_friction, &of) != NULL;
}

static int has_average(const model *m) {
  const contact *of;
  return first_rule(m, rule_has_average, &of) != NULL;
}

static const contact *first_given(const model *m) {
  for (int i = 0; i < m->n_contact; ++i)
    if (m->contacts[i].force.given) return &m->contacts[i];
  return NULL;
}

static const load *first_body_load(const model *m) {
  for (int i = 0; i < m->n_step; ++i)
    for (int k = 0; k < m->steps[i].loads.n; ++k) {
      const load *l = &m->steps[i].loads.item[k];
      if (l->kind == LOAD_BODY || l->kind == LOAD_GRAVITY) return l;
    }
  return NULL;
}

static const load *first_temperature(const model *m) {
  for (int i = 0; i < m->n_step; ++i)
    for (int k = 0; k < m->steps[i].loads.n; ++k)
      if (m->steps[i].loads.item[k].kind == LOAD_TEMPERATURE)
        return &m->steps[i].loads.item[k];
  return NULL;
}

static int has_expansion(const model *m) {
  for (int i = 0; i < m->n_material; ++i)
    if (m->materials[i].used && m->materials[i].expand.given) return 1;
  return 0;
}

static const step *first_print(const model *m, int table, place *at) {
  for (int i = 0; i < m->n_step; ++i)
    for (int k = 0; k < m->steps[i].n_print; ++k)
      if (m->steps[i].prints[k].table & table) {
        *at = m->steps[i].prints[k].at;
        return &m->steps[i];
      }
  return NULL;
}

int model_prints(const model *m, int tables) {
  place at;
  return first_print(m, tables, &at) != NULL;
}

int model_has_axis(const model *m) {
  int any = 0;
  for (int i = 0; i < m->n_contact; ++i) any |= m->contacts[i].has_axis;
  return any;
}

static const step *first_fields(const model *m) {
  for (int i = 0; i < m->n_step; ++i)
    if (m->steps[i].output_frequency >= 0) return &m->steps[i];
  return NULL;
}

int model_writes_fields(const model *m) { return first_fields(m) != NULL; }

static int has_estimates(const model *m) {
  for (int i = 0; i < m->n_step; ++i)
    if (!m->steps[i].no_solver_error) return m->n_contact > 0 || m->has_problem;
  return 0;
}

/* More than one increment: slip and load have a history. */
static int has_history(const model *m) {
  if (m->n_step > 1) return 1;
  return m->n_step == 1 && m->steps[0].dt < m->steps[0].total;
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

/* Reactions are computed when printed, or where a support does work: it moves,
 * or is taken away under load. */
static const load *moving_support(const model *m) {
  for (int i = 0; i < m->n_step; ++i)
    for (int k = 0; k < m->steps[i].loads.n; ++k) {
      const load *l = &m->steps[i].loads.item[k];
      if (l->kind != LOAD_FIXING) continue;
      int let_go = i + 1 < m->n_step &&
                   (m->steps[i + 1].renewed >> LOAD_FIXING & 1u) != 0;
      if (l->value.formula != NULL || l->value.number != 0.0 || l->has_before ||
          let_go || !held_before(m, i, l))
        return l;
    }
  return NULL;
}

/* First section whose material has an inelastic law, or NULL. */
static const section *first_inelastic(const model *m) {
  for (int i = 0; i < m->n_section; ++i) {
    const int id = m->sections[i].material_id;
    if (id >= 0 && id < m->n_material && m->materials[id].law.ops != NULL)
      return &m->sections[i];
  }
  return NULL;
}

static const initial *first_initial(const model *m, int type) {
  for (int i = 0; i < m->n_initial; ++i)
    if (m->initials[i].type == type) return &m->initials[i];
  return NULL;
}

static int has_inelastic(const model *m) {
  return first_inelastic(m) != NULL &&
         (has_card(m, "VISCO") || first_initial(m, INITIAL_STRAIN) != NULL);
}

int model_flows(const model *m, int elem_id) {
  const section *s = &m->sections[m->elem_section[elem_id]];
  const material *mat = &m->materials[s->material_id];
  return mat->law.ops != NULL && !(mat->is_still && m->still[elem_id]);
}

/* A material whose law depends on temperature. */
static const material *first_warm_law(const model *m) {
  for (int i = 0; i < m->n_material; ++i) {
    const material *mat = &m->materials[i];
    if (mat->used && mat->law.ops != NULL &&
        (law_varies(&mat->law) & LAW_VARIES_TEMPERATURE))
      return mat;
  }
  return NULL;
}

/* 1 if temperatures are given. */
static int has_temperature(const model *m) {
  return first_temperature(m) != NULL ||
         first_initial(m, INITIAL_TEMPERATURE) != NULL;
}

/* A material whose moduli depend on temperature. */
static const material *first_warm_moduli(const model *m) {
  for (int i = 0; i < m->n_material; ++i)
    if (m->materials[i].used && m->materials[i].elastic.n > 1)
      return &m->materials[i];
  return NULL;
}

static int has_warm_moduli(const model *m) {
  return has_temperature(m) && first_warm_moduli(m) != NULL;
}

static int has_warm_law(const model *m) {
  return has_inelastic(m) && has_temperature(m) && first_warm_law(m) != NULL;
}

static void reason_inelastic(const model *m, char *text, size_t size) {
  const section *s = first_inelastic(m);
  if (s == NULL) {
    snprintf(text, size, "no material has *INELASTIC");
    return;
  }
  const law_card *law = &m->materials[s->material_id].law;
  snprintf(text, size, "%s of group %s, %s:%d%s", law->ops->name, s->elset,
           PLACE(law->at),
           has_card(m, "VISCO") ? "" : ", but no step is *VISCO");
}

void model_fit_problem(model *m, int dim, int friction) {
  m->dim = dim;
  m->problem_friction = friction;
  m->effects = EFFECT_CONTACT | (friction ? EFFECT_FRICTION : 0u);
  if (dim > 1 && has_estimates(m)) m->effects |= EFFECT_ESTIMATES;
}

static void reason_estimates(const model *m, char *text, size_t size) {
  if (m->effects & EFFECT_ESTIMATES)
    snprintf(text, size, "default; *ACCURACY, SOLVER=NO leaves it out");
  else if (m->n_contact == 0 && !m->has_problem)
    snprintf(text, size, "no *CONTACT card");
  else
    snprintf(text, size, "*ACCURACY, SOLVER=NO");
}

/* 1: a deck with *CONDENSED PROBLEM; the reason is in text. */
static int reason_problem(const model *m, int bit, char *text, size_t size) {
  if (!m->has_problem) return 0;
  if (bit == EFFECT_BIT_CONTACT)
    snprintf(text, size, "*CONDENSED PROBLEM, %s:%d", PLACE(m->problem_at));
  else if (bit == EFFECT_BIT_FRICTION)
    snprintf(text, size, "mu of *CONDENSED PROBLEM, %s:%d, is %s",
             PLACE(m->problem_at),
             m->problem_friction ? "not zero" : "zero or not there");
  else if (bit == EFFECT_BIT_ESTIMATES && m->dim > 1)
    reason_estimates(m, text, size);
  else
    snprintf(text, size, "not part of a condensed problem");
  return 1;
}

/* 1: the deck calls for it, *EFFECTS leaves it out. */
static int reason_neglected(const model *m, int bit, char *text, size_t size) {
  if (m->effects >> bit & 1u) return 0;
  for (int i = 0; i < m->n_neglected; ++i) {
    const neglected *row = &m->neglected[i];
    if (row->bit != bit || row->back) continue;
    snprintf(text, size, "left out by *EFFECTS, MODE=AUTO, %s:%d",
             PLACE(m->effects_at));
    return 1;
  }
  return 0;
}

static void reason_friction(const model *m, char *text, size_t size) {
  const contact *c = NULL;
  const friction_rule *rule = first_rule(m, rule_has_friction, &c);
  if (rule != NULL)
    snprintf(text, size, "*FRICTION, LAW=%s on contact %s, %s:%d",
             rule->law->name, c->name, PLACE(rule->at));
  else if (m->n_contact == 0)
    snprintf(text, size, "no *CONTACT card");
  else
    snprintf(text, size, "no *FRICTION card with a value above zero");
}

static int has_given(const model *m) { return first_given(m) != NULL; }

static void reason_given(const model *m, char *text, size_t size) {
  const contact *c = first_given(m);
  if (c != NULL)
    snprintf(text, size, "*CONTACT FORCE on contact %s, %s:%d", c->name,
             PLACE(c->force.at));
  else
    snprintf(text, size, "no *CONTACT FORCE card");
}

static void reason_nonlocal(const model *m, char *text, size_t size) {
  const contact *c;
  const friction_rule *rule = first_rule(m, rule_has_average, &c);
  if (rule != NULL)
    snprintf(text, size, "*FRICTION, LAW=%s on contact %s, %s:%d",
             rule->law->name, c->name, PLACE(rule->at));
  else
    snprintf(text, size, "no friction law with an average");
}

static int has_start(const model *m) { return m->start.given; }

static void reason_start(const model *m, char *text, size_t size) {
  if (m->start.given)
    snprintf(text, size, "*INITIAL CONDITIONS, TYPE=DISPLACEMENT, %s:%d",
             PLACE(m->start.at));
  else
    snprintf(text, size, "no *INITIAL CONDITIONS, TYPE=DISPLACEMENT");
}

static void reason_output(const model *m, int table, char *text, size_t size) {
  place at;
  if (first_print(m, table, &at) != NULL)
    snprintf(text, size, "*PRINT, %s:%d", PLACE(at));
  else if (first_fields(m) != NULL)
    snprintf(text, size, "fields in JOB.h5, see below");
  else
    snprintf(text, size, "no output asks for them");
}

static void reason_history(const model *m, char *text, size_t size) {
  if (m->effects & EFFECT_HISTORY)
    snprintf(text, size, "friction over more than one increment, %s:%d",
             PLACE(m->steps[0].at));
  else if (m->effects & EFFECT_FRICTION)
    snprintf(text, size, "one increment only");
  else
    snprintf(text, size, "no friction");
}

static void reason_thermal(const model *m, char *text, size_t size) {
  const load *l = first_temperature(m);
  if (has_warm_law(m))
    snprintf(text, size, "law %s of material %s depends on temperature",
             first_warm_law(m)->law.ops->name, first_warm_law(m)->name);
  else if (has_warm_moduli(m))
    snprintf(text, size, "*ELASTIC of material %s depends on temperature",
             first_warm_moduli(m)->name);
  else if (l == NULL)
    snprintf(text, size, "no *TEMPERATURE card");
  else if (!has_expansion(m))
    snprintf(text, size, "no material in use has *EXPANSION");
  else
    snprintf(text, size, "*TEMPERATURE on group %s, %s:%d", l->group,
             PLACE(l->at));
}

static void reason_mesh(const model *m, char *text, size_t size) {
  snprintf(text, size, "*MESH, %s:%d", PLACE(m->mesh_at));
}

static void reason_contact(const model *m, char *text, size_t size) {
  if (m->n_contact > 0)
    snprintf(text, size, "*CONTACT, NAME=%s, %s:%d", m->contacts[0].name,
             PLACE(m->contacts[0].at));
  else
    snprintf(text, size, "no *CONTACT card");
}

static void reason_body(const model *m, char *text, size_t size) {
  const load *l = first_body_load(m);
  if (l != NULL)
    snprintf(text, size, "*DLOAD on group %s, %s:%d", l->group, PLACE(l->at));
  else
    snprintf(text, size, "no *DLOAD card");
}

static void reason_stress(const model *m, char *text, size_t size) {
  reason_output(m, PRINT_ELEMENTS, text, size);
}

static void reason_reaction(const model *m, char *text, size_t size) {
  const load *l = moving_support(m);
  if (l != NULL)
    snprintf(text, size,
             "work of the support %s, %s:%d, that moves or is let go", l->group,
             PLACE(l->at));
  else
    reason_output(m, PRINT_REACTIONS, text, size);
}

status model_find_corner(model *m, const mesh *msh) {
  status st = OK;
  int *of = NULL;
  m->corner_id = -1;
  NEW(of, msh->n_node);
  for (int i = 0; i < m->n_contact; ++i) {
    if (m->contacts[i].group_id < 0) continue;
    const mesh_group *g = &msh->group[m->contacts[i].group_id];
    for (int k = 0; k < g->n_node; ++k) {
      int *owner = &of[g->node_id[k]];
      if (*owner > 0 && *owner != i + 1) m->corner_id = i;
      *owner = i + 1;
    }
  }
done:
  memory_free(of);
  return st;
}

/* The first step that shows, tries or judges the whole condensed problem. */
static const step *first_whole(const model *m) {
  for (int i = 0; i < m->n_step; ++i) {
    const step *s = &m->steps[i];
    if (s->condensed_frequency >= 0 || s->check != CHECK_NONE || s->theory)
      return s;
  }
  return NULL;
}

/* 1: *EFFECTS leaves friction out and asks what it would have changed. */
static int neglects_friction(const model *m) {
  int any = 0;
  for (int i = 0; i < m->n_neglected; ++i)
    any |= m->neglected[i].bit == EFFECT_BIT_FRICTION && !m->neglected[i].back;
  return any;
}

/* The normals of a second obstacle are tangents of the first. */
static int has_tangents(const model *m) {
  return m->n_contact > 0 && (has_friction(m) || m->corner_id >= 0 ||
                              first_whole(m) != NULL || neglects_friction(m));
}

int model_rubs_locally(const model *m) {
  int local = m->corner_id < 0 && first_whole(m) == NULL;
  for (int i = 0; i < m->n_step; ++i) {
    local = local && m->steps[i].form == FORM_DISPLACEMENT;
    for (int k = 0; k < m->n_contact; ++k) {
      const friction_rule *rule = friction_in_force(m, i, k);
      local =
          local && (!rule_has_friction(rule) || rule->law == &coulomb_friction);
    }
  }
  return local;
}

static void reason_tangents(const model *m, char *text, size_t size) {
  const step *s = first_whole(m);
  if (m->n_contact == 0)
    snprintf(text, size, "no *CONTACT card");
  else if (m->effects & EFFECT_FRICTION)
    reason_friction(m, text, size);
  else if (m->corner_id >= 0)
    snprintf(text, size, "contact %s meets another, %s:%d",
             m->contacts[m->corner_id].name,
             PLACE(m->contacts[m->corner_id].at));
  else if (s != NULL && s->condensed_frequency >= 0)
    snprintf(text, size, "*OUTPUT, CONDENSED=FCLIB, %s:%d",
             PLACE(s->output_at));
  else if (s != NULL && s->check != CHECK_NONE)
    snprintf(text, size, "*SOLVER, CHECK=, %s:%d", PLACE(s->solver_at));
  else if (s == NULL && neglects_friction(m))
    snprintf(text, size, "friction left out is judged, %s:%d",
             PLACE(m->effects_at));
  else if (s != NULL)
    snprintf(text, size, "*ACCURACY, THEORY=YES, %s:%d", PLACE(s->accuracy_at));
  else
    snprintf(text, size, "mu = 0: only normals are condensed");
}

static int has_mesh(const model *m) { return !m->has_problem; }
static int has_contact(const model *m) { return m->n_contact > 0; }
static int has_slip_history(const model *m) {
  return has_friction(m) && has_history(m);
}
static int has_body(const model *m) { return first_body_load(m) != NULL; }
static int has_thermal(const model *m) {
  return (first_temperature(m) != NULL && has_expansion(m)) ||
         has_warm_law(m) || has_warm_moduli(m);
}
static int has_stress(const model *m) {
  place at;
  return first_print(m, PRINT_ELEMENTS, &at) != NULL || first_fields(m) != NULL;
}
static int has_reaction(const model *m) {
  place at;
  return first_print(m, PRINT_REACTIONS, &at) != NULL ||
         first_fields(m) != NULL || moving_support(m) != NULL;
}

/* The first step that "is", or NULL. */
static const step *first_step(const model *m, int (*is)(const step *s)) {
  for (int i = 0; i < m->n_step; ++i)
    if (is(&m->steps[i])) return &m->steps[i];
  return NULL;
}
static int asks_mesh_error(const step *s) { return s->mesh_error; }
static int asks_time_error(const step *s) { return s->time_error; }
static int asks_theory(const step *s) { return s->theory; }
static int has_mesh_error(const model *m) {
  return first_step(m, asks_mesh_error) != NULL;
}
/* The *ACCURACY card of the first step that "is", or that none asks for it. */
static void reason_accuracy(const model *m, const char *word,
                            int (*is)(const step *s), char *text, size_t size) {
  const step *s = first_step(m, is);
  if (s != NULL && m->target.percent > 0.0)
    snprintf(text, size, "*ACCURACY, TARGET=, %s:%d", PLACE(s->accuracy_at));
  else if (s != NULL && s->accuracy_at.file == NULL)
    snprintf(text, size, "*SOLVER, TOL=BALANCED, %s:%d", PLACE(s->solver_at));
  else if (s != NULL)
    snprintf(text, size, "*ACCURACY, %s=YES, %s:%d", word,
             PLACE(s->accuracy_at));
  else
    snprintf(text, size, "no *ACCURACY, %s=YES", word);
}

static void reason_mesh_error(const model *m, char *text, size_t size) {
  reason_accuracy(m, "MESH", asks_mesh_error, text, size);
}
static int has_time_error(const model *m) {
  return first_step(m, asks_time_error) != NULL;
}
static void reason_time_error(const model *m, char *text, size_t size) {
  reason_accuracy(m, "TIME", asks_time_error, text, size);
}

static int has_theory(const model *m) {
  return first_step(m, asks_theory) != NULL && m->n_contact > 0;
}
static void reason_theory(const model *m, char *text, size_t size) {
  if (first_step(m, asks_theory) != NULL && m->n_contact == 0)
    snprintf(text, size, "no *CONTACT card");
  else
    reason_accuracy(m, "THEORY", asks_theory, text, size);
}

static int has_reference(const model *m) { return m->ref.n > 0; }
static void reason_reference(const model *m, char *text, size_t size) {
  if (m->ref.n > 0)
    snprintf(text, size, "*REFERENCE, %s:%d", PLACE(m->ref.at));
  else
    snprintf(text, size, "no *REFERENCE card");
}

/* When an effect is on, and what its line in the plan says. */
static const struct {
  int (*is_on)(const model *m);
  void (*reason)(const model *m, char *text, size_t size);
} rows[EFFECT_COUNT] = {
    [EFFECT_BIT_MESH] = {has_mesh, reason_mesh},
    [EFFECT_BIT_CONTACT] = {has_contact, reason_contact},
    [EFFECT_BIT_FRICTION] = {has_friction, reason_friction},
    [EFFECT_BIT_TANGENTS] = {has_tangents, reason_tangents},
    [EFFECT_BIT_GIVEN] = {has_given, reason_given},
    [EFFECT_BIT_NONLOCAL] = {has_average, reason_nonlocal},
    [EFFECT_BIT_START] = {has_start, reason_start},
    [EFFECT_BIT_HISTORY] = {has_slip_history, reason_history},
    [EFFECT_BIT_INELASTIC] = {has_inelastic, reason_inelastic},
    [EFFECT_BIT_THERMAL] = {has_thermal, reason_thermal},
    [EFFECT_BIT_BODY] = {has_body, reason_body},
    [EFFECT_BIT_STRESS] = {has_stress, reason_stress},
    [EFFECT_BIT_REACTION] = {has_reaction, reason_reaction},
    [EFFECT_BIT_MESH_ERROR] = {has_mesh_error, reason_mesh_error},
    [EFFECT_BIT_TIME_ERROR] = {has_time_error, reason_time_error},
    [EFFECT_BIT_ESTIMATES] = {has_estimates, reason_estimates},
    [EFFECT_BIT_REFERENCE] = {has_reference, reason_reference},
    [EFFECT_BIT_THEORY] = {has_theory, reason_theory}};

void model_find_effects(model *m) {
  m->effects = 0;
  for (int bit = 0; bit < EFFECT_COUNT; ++bit)
    if (rows[bit].is_on != NULL && rows[bit].is_on(m)) m->effects |= 1u << bit;
  m->effects &= ~(unsigned)(EFFECTS_WITHOUT);
}

const char *model_effect_reason(const model *m, int bit, char *text,
                                size_t size) {
  if (reason_problem(m, bit, text, size)) return text;
  if (reason_neglected(m, bit, text, size)) return text;
  if (rows[bit].reason != NULL)
    rows[bit].reason(m, text, size);
  else
    snprintf(text, size, "no card calls for it");
  return text;
}
