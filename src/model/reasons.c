/*
 * What the effect plan says of an effect: why it is on or off.
 */
#include "model/facts.h"

#include <stdio.h>

static void reason_inelastic(const model *m, char *text, size_t size) {
  const section *s = facts_first_inelastic(m);
  if (s == NULL) {
    snprintf(text, size, "no material has *INELASTIC");
    return;
  }
  const law_card *law = &m->materials[s->material_id].law;
  snprintf(text, size, "%s of group %s, %s:%d%s", law->ops->name, s->elset,
           PLACE(law->at),
           has_card(m, "VISCO") ? "" : ", but no step is *VISCO");
}

static void reason_estimates(const model *m, char *text, size_t size) {
  if (m->has_problem && !m->steps[0].has_accuracy)
    snprintf(text, size, "no *ACCURACY card, which asks for it");
  else if (m->effects & EFFECT_ESTIMATES && m->has_problem)
    snprintf(text, size, "*ACCURACY, %s:%d", PLACE(m->steps[0].accuracy_at));
  else if (m->effects & EFFECT_ESTIMATES)
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
  const friction_rule *rule = facts_first_rule(m, rule_has_friction, &c);
  if (rule != NULL)
    snprintf(text, size, "*FRICTION, LAW=%s on contact %s, %s:%d",
             rule->law->name, c->name, PLACE(rule->at));
  else if (m->n_contact == 0)
    snprintf(text, size, "no *CONTACT card");
  else
    snprintf(text, size, "no *FRICTION card with a value above zero");
}

static void reason_given(const model *m, char *text, size_t size) {
  const contact *c = facts_first_given(m);
  if (c != NULL)
    snprintf(text, size, "*CONTACT FORCE on contact %s, %s:%d", c->name,
             PLACE(c->force.at));
  else
    snprintf(text, size, "no *CONTACT FORCE card");
}

static void reason_nonlocal(const model *m, char *text, size_t size) {
  const contact *c;
  const friction_rule *rule = facts_first_rule(m, rule_has_average, &c);
  if (rule != NULL)
    snprintf(text, size, "*FRICTION, LAW=%s on contact %s, %s:%d",
             rule->law->name, c->name, PLACE(rule->at));
  else
    snprintf(text, size, "no friction law with an average");
}

static void reason_start(const model *m, char *text, size_t size) {
  if (m->start.given)
    snprintf(text, size, "*INITIAL CONDITIONS, TYPE=DISPLACEMENT, %s:%d",
             PLACE(m->start.at));
  else
    snprintf(text, size, "no *INITIAL CONDITIONS, TYPE=DISPLACEMENT");
}

static void reason_output(const model *m, int table, char *text, size_t size) {
  place at;
  if (facts_first_print(m, table, &at) != NULL)
    snprintf(text, size, "*PRINT, %s:%d", PLACE(at));
  else if (facts_first_fields(m) != NULL)
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
  const load *l = facts_first_temperature(m);
  if (facts_has_warm_law(m))
    snprintf(text, size, "law %s of material %s depends on temperature",
             facts_first_warm_law(m)->law.ops->name,
             facts_first_warm_law(m)->name);
  else if (facts_has_warm_moduli(m))
    snprintf(text, size, "*ELASTIC of material %s depends on temperature",
             facts_first_warm_moduli(m)->name);
  else if (l == NULL)
    snprintf(text, size, "no *TEMPERATURE card");
  else if (!facts_has_expansion(m))
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
  const load *l = facts_first_body_load(m);
  if (l != NULL)
    snprintf(text, size, "*DLOAD on group %s, %s:%d", l->group, PLACE(l->at));
  else
    snprintf(text, size, "no *DLOAD card");
}

static void reason_stress(const model *m, char *text, size_t size) {
  reason_output(m, PRINT_ELEMENTS, text, size);
}

static void reason_reaction(const model *m, char *text, size_t size) {
  const load *l = facts_moving_support(m);
  if (l != NULL)
    snprintf(text, size,
             "work of the support %s, %s:%d, that moves or is let go", l->group,
             PLACE(l->at));
  else
    reason_output(m, PRINT_REACTIONS, text, size);
}

static void reason_tangents(const model *m, char *text, size_t size) {
  const step *s = facts_first_whole(m);
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
  else if (s == NULL && facts_neglects_friction(m))
    snprintf(text, size, "friction left out is judged, %s:%d",
             PLACE(m->effects_at));
  else if (s != NULL)
    snprintf(text, size, "*ACCURACY, THEORY=YES, %s:%d", PLACE(s->accuracy_at));
  else
    snprintf(text, size, "mu = 0: only normals are condensed");
}

/* The *ACCURACY card of the first step that "is", or that none asks for it. */
static void reason_accuracy(const model *m, const char *word,
                            int (*is)(const step *s), char *text, size_t size) {
  const step *s = facts_first_step(m, is);
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
  reason_accuracy(m, "MESH", facts_asks_mesh_error, text, size);
}

static void reason_time_error(const model *m, char *text, size_t size) {
  reason_accuracy(m, "TIME", facts_asks_time_error, text, size);
}

static void reason_theory(const model *m, char *text, size_t size) {
  if (facts_first_step(m, facts_asks_theory) != NULL && m->n_contact == 0)
    snprintf(text, size, "no *CONTACT card");
  else
    reason_accuracy(m, "THEORY", facts_asks_theory, text, size);
}

static void reason_reference(const model *m, char *text, size_t size) {
  if (m->ref.n > 0)
    snprintf(text, size, "*REFERENCE, %s:%d", PLACE(m->ref.at));
  else
    snprintf(text, size, "no *REFERENCE card");
}

static void (*const reasons[EFFECT_COUNT])(const model *m, char *text,
                                           size_t size) = {
    [EFFECT_BIT_MESH] = reason_mesh,
    [EFFECT_BIT_CONTACT] = reason_contact,
    [EFFECT_BIT_FRICTION] = reason_friction,
    [EFFECT_BIT_TANGENTS] = reason_tangents,
    [EFFECT_BIT_GIVEN] = reason_given,
    [EFFECT_BIT_NONLOCAL] = reason_nonlocal,
    [EFFECT_BIT_START] = reason_start,
    [EFFECT_BIT_HISTORY] = reason_history,
    [EFFECT_BIT_INELASTIC] = reason_inelastic,
    [EFFECT_BIT_THERMAL] = reason_thermal,
    [EFFECT_BIT_BODY] = reason_body,
    [EFFECT_BIT_STRESS] = reason_stress,
    [EFFECT_BIT_REACTION] = reason_reaction,
    [EFFECT_BIT_MESH_ERROR] = reason_mesh_error,
    [EFFECT_BIT_TIME_ERROR] = reason_time_error,
    [EFFECT_BIT_ESTIMATES] = reason_estimates,
    [EFFECT_BIT_REFERENCE] = reason_reference,
    [EFFECT_BIT_THEORY] = reason_theory};

const char *model_effect_reason(const model *m, int bit, char *text,
                                size_t size) {
  if (reason_problem(m, bit, text, size)) return text;
  if (reason_neglected(m, bit, text, size)) return text;
  if (reasons[bit] != NULL)
    reasons[bit](m, text, size);
  else
    snprintf(text, size, "no card calls for it");
  return text;
}
