/*
 * Which effects a deck calls for. What is off is neither allocated nor
 * computed.
 */
#include "model/facts.h"

const char *effect_name(int bit) {
#define EFFECT_TEXT(name, text) text,
  static const char *const names[] = {EFFECT_LIST(EFFECT_TEXT)};
  return names[bit];
}

static int has_friction(const model *m) {
  const contact *of;
  return facts_first_rule(m, rule_has_friction, &of) != NULL;
}

static int has_average(const model *m) {
  const contact *of;
  return facts_first_rule(m, rule_has_average, &of) != NULL;
}

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

static int has_given(const model *m) { return facts_first_given(m) != NULL; }

static int has_start(const model *m) { return m->start.given; }

/* The normals of a second obstacle are tangents of the first. */
static int has_tangents(const model *m) {
  return m->n_contact > 0 &&
         (has_friction(m) || m->corner_id >= 0 ||
          facts_first_whole(m) != NULL || facts_neglects_friction(m));
}

static int has_mesh(const model *m) { return !m->has_problem; }

static int has_contact(const model *m) { return m->n_contact > 0; }

static int has_slip_history(const model *m) {
  return has_friction(m) && has_history(m);
}

static int has_body(const model *m) { return facts_first_body_load(m) != NULL; }

static int has_thermal(const model *m) {
  return (facts_first_temperature(m) != NULL && facts_has_expansion(m)) ||
         facts_has_warm_law(m) || facts_has_warm_moduli(m);
}

static int has_stress(const model *m) {
  place at;
  return facts_first_print(m, PRINT_ELEMENTS, &at) != NULL ||
         facts_first_fields(m) != NULL;
}

/* Reactions are computed when printed, or where a support does work. */
static int has_reaction(const model *m) {
  place at;
  return facts_first_print(m, PRINT_REACTIONS, &at) != NULL ||
         facts_first_fields(m) != NULL || facts_moving_support(m) != NULL;
}

static int has_mesh_error(const model *m) {
  return facts_first_step(m, facts_asks_mesh_error) != NULL;
}

static int has_time_error(const model *m) {
  return facts_first_step(m, facts_asks_time_error) != NULL;
}

static int has_theory(const model *m) {
  return facts_first_step(m, facts_asks_theory) != NULL && m->n_contact > 0;
}

static int has_reference(const model *m) { return m->ref.n > 0; }

static int (*const is_on[EFFECT_COUNT])(const model *m) = {
    [EFFECT_BIT_MESH] = has_mesh,
    [EFFECT_BIT_CONTACT] = has_contact,
    [EFFECT_BIT_FRICTION] = has_friction,
    [EFFECT_BIT_TANGENTS] = has_tangents,
    [EFFECT_BIT_GIVEN] = has_given,
    [EFFECT_BIT_NONLOCAL] = has_average,
    [EFFECT_BIT_START] = has_start,
    [EFFECT_BIT_HISTORY] = has_slip_history,
    [EFFECT_BIT_INELASTIC] = facts_has_inelastic,
    [EFFECT_BIT_THERMAL] = has_thermal,
    [EFFECT_BIT_BODY] = has_body,
    [EFFECT_BIT_STRESS] = has_stress,
    [EFFECT_BIT_REACTION] = has_reaction,
    [EFFECT_BIT_MESH_ERROR] = has_mesh_error,
    [EFFECT_BIT_TIME_ERROR] = has_time_error,
    [EFFECT_BIT_ESTIMATES] = has_estimates,
    [EFFECT_BIT_REFERENCE] = has_reference,
    [EFFECT_BIT_THEORY] = has_theory};

void model_find_effects(model *m) {
  m->effects = 0;
  for (int bit = 0; bit < EFFECT_COUNT; ++bit)
    if (is_on[bit] != NULL && is_on[bit](m)) m->effects |= 1u << bit;
  m->effects &= ~(unsigned)(EFFECTS_WITHOUT);
}

void model_fit_problem(model *m, int dim, int friction) {
  m->dim = dim;
  m->problem_friction = friction;
  m->effects = EFFECT_CONTACT | (friction ? EFFECT_FRICTION : 0u);
  if (dim > 1 && has_estimates(m)) m->effects |= EFFECT_ESTIMATES;
}
