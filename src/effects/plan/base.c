/*
 * Rows of every body, and of effects in other files of the run: their expected
 * work and their stages.
 */
#include "effects/plan/plan.h"
#include "effects/rows.h"
#include "model/facts.h"
#include "run/column_row.h"

#include <math.h>

static status elements(const plan_sizes *s, effect_work *w) {
  double n = s->elements, entries = work_factor_entries(s);
  double assembly = n * (s->is_flat ? 500.0 : 2500.0);
  double ordering = s->nodes * (s->is_flat ? 700.0 : 3000.0);
  double factor = work_factor_flops(s) / PLAN_SPARSE + entries;
  double solves = s->equilibria * 2.0 * entries;
  double energy = s->increments * n * plan_element_work(s);
  *w = (effect_work){
      n, "elements", s->factors,
      s->factors * (assembly + ordering + factor) + solves + energy};
  return OK;
}

static status unilateral(const plan_sizes *s, effect_work *w) {
  double n = s->contact;
  *w = (effect_work){n, "nodes", s->equilibria,
                     plan_contact_work(s, n) + 500.0 * n};
  return OK;
}

static status tangents(const plan_sizes *s, effect_work *w) {
  double all = plan_contact_work(s, plan_contact_unknowns(s));
  *w = (effect_work){s->tangents, "unknowns", s->equilibria,
                     all - plan_contact_work(s, s->contact)};
  return OK;
}

status plan_rule_nodes(const plan_sizes *s,
                       int (*is)(const friction_rule *rule), double *n) {
  if (s->msh != NULL) return plan_contact_nodes(s, is, n);
  *n = is == rule_has_friction ? s->contact : 0.0;
  return OK;
}

static status body(const plan_sizes *s, effect_work *w) {
  double n = 0.0;
  for (int i = 0; s->msh != NULL && i < s->m->n.step; ++i) {
    double here = 0.0;
    const load_list *l = &s->m->steps[i].loads;
    for (int k = 0; k < l->n; ++k)
      if (l->item[k].kind == LOAD_BODY || l->item[k].kind == LOAD_GRAVITY)
        here += s->msh->group[l->item[k].group_id].n_item;
    n = fmax(n, here);
  }
  *w = (effect_work){n, "elements", -1.0,
                     s->equilibria * n * 4.0 * plan_element_work(s)};
  return OK;
}

static status stresses(const plan_sizes *s, effect_work *w) {
  *w = (effect_work){s->elements, "elements", s->shown,
                     s->shown * s->elements * plan_element_work(s)};
  return OK;
}

static status reactions(const plan_sizes *s, effect_work *w) {
  double unknowns;
  *w = (effect_work){
      .kind = "nodes",
      .calls = s->increments,
      .operations = s->increments * s->elements * plan_element_work(s)};
  return s->msh == NULL ? OK : plan_held(s, &unknowns, &w->items);
}

/* ---- the cards that require them ----------------------------------------
 */

static int requires_mesh(const model *m, char *why, size_t size) {
  return plan_says(!m->problem.given, why, size, "*MESH, %s:%d",
                   PLACE(m->mesh.at));
}

static int requires_contact(const model *m, char *why, size_t size) {
  if (m->n.contact == 0) return plan_says(0, why, size, "no *CONTACT card");
  return plan_says(1, why, size, "%s, NAME=%s, %s:%d",
                   contact_card(&m->contacts[0]), m->contacts[0].name,
                   PLACE(m->contacts[0].at));
}

int plan_requires_rule(const model *m, int (*is)(const friction_rule *rule),
                       const char *none, char *why, size_t size) {
  const contact *c = NULL;
  const friction_rule *rule = facts_first_rule(m, is, &c);
  if (rule == NULL) return plan_says(0, why, size, "%s", none);
  return plan_says(1, why, size, "*FRICTION, LAW=%s on contact %s, %s:%d",
                   rule->law->name, c->name, PLACE(rule->at));
}

/* The normals of a second obstacle are tangents of the first. */
static int requires_tangents(const model *m, char *why, size_t size) {
  const step *s = facts_first_whole(m);
  if (m->n.contact == 0 || friction_effect.required(m, NULL, 0))
    return friction_effect.required(m, why, size);
  if (m->mesh.corner_id >= 0)
    return plan_says(1, why, size, "contact %s meets another, %s:%d",
                     m->contacts[m->mesh.corner_id].name,
                     PLACE(m->contacts[m->mesh.corner_id].at));
  if (s == NULL && facts_omits_friction(m))
    return plan_says(1, why, size, "friction left out is checked, %s:%d",
                     PLACE(m->reduction.at));
  if (s == NULL)
    return plan_says(0, why, size, "mu = 0: only normals are condensed");
  if (s->output.condensed >= 0)
    return plan_says(1, why, size, "*OUTPUT, CONDENSED=FCLIB, %s:%d",
                     PLACE(s->output.at));
  if (s->check != CHECK_NONE)
    return plan_says(1, why, size, "*SOLVER, CHECK=, %s:%d",
                     PLACE(s->solver_at));
  return plan_says(1, why, size, "*ACCURACY, THEORY=YES, %s:%d",
                   PLACE(s->accuracy.at));
}

static int requires_body(const model *m, char *why, size_t size) {
  const load *l = facts_first_body_load(m);
  if (l == NULL) return plan_says(0, why, size, "no *DLOAD card");
  return plan_says(1, why, size, "*DLOAD on group %s, %s:%d", l->group,
                   PLACE(l->at));
}

static int requires_output(const model *m, int table, char *why, size_t size) {
  place at;
  if (facts_first_print(m, table, &at) != NULL)
    return plan_says(1, why, size, "*PRINT, %s:%d", PLACE(at));
  if (facts_first_fields(m) != NULL)
    return plan_says(1, why, size, "fields in JOB.h5, see below");
  return plan_says(0, why, size, "no output requires them");
}

static int requires_stress(const model *m, char *why, size_t size) {
  return requires_output(m, PRINT_ELEMENTS, why, size);
}

/* Reactions are computed when printed, or where a support does work. */
static int requires_reaction(const model *m, char *why, size_t size) {
  const load *l = facts_moving_support(m);
  if (l == NULL) return requires_output(m, PRINT_REACTIONS, why, size);
  return plan_says(1, why, size,
                   "work of the support %s, %s:%d, that moves or is released",
                   l->group, PLACE(l->at));
}

int plan_requires_accuracy(const model *m, const char *word,
                           int (*is)(const step *s), char *why, size_t size) {
  const step *s = facts_first_step(m, is);
  if (s == NULL) return plan_says(0, why, size, "no *ACCURACY, %s=YES", word);
  if (m->accuracy.target.percent > 0.0)
    return plan_says(1, why, size, "*ACCURACY, TARGET=, %s:%d",
                     PLACE(s->accuracy.at));
  if (s->accuracy.at.file == NULL)
    return plan_says(1, why, size, "*SOLVER, TOL=BALANCED, %s:%d",
                     PLACE(s->solver_at));
  return plan_says(1, why, size, "*ACCURACY, %s=YES, %s:%d", word,
                   PLACE(s->accuracy.at));
}

VALUE(reaction, v->s->body.reaction[at(v->msh->dim, id, part)])

/* clang-format off */
#define REACTION(name, scene, part) \
  {name, "force", PER_NODE, AS_REAL, PRINT_REACTIONS, ON(REACTION), scene, \
   NEEDS_REACTION, "reaction", part, reaction, NULL, \
   "force of the support on the body"}
static const column reaction_columns[] = {
REACTION("reaction_x", CART, 0), REACTION("reaction_r", SCENE_AXI, 0),
REACTION("reaction_y", CART, 1), REACTION("reaction_z", SCENE_AXI, 1),
REACTION("reaction_z", SCENE_SOLID, 2)};

const effect_ops finite_elements_effect = {
  .name = "finite elements", .bit = EFFECT_BIT_MESH, .required = requires_mesh,
  .expected = elements, .own = STAGE_ASSEMBLY,
  .more = {STAGE_ORDERING, STAGE_FACTOR, STAGE_LOAD, STAGE_RECOVERY,
           STAGE_ENERGY}};

const effect_ops unilateral_contact_effect = {
  .name = "unilateral contact", .bit = EFFECT_BIT_CONTACT,
  .required = requires_contact, .expected = unilateral, .own = STAGE_CONTACT,
  .more = {STAGE_SURFACE, STAGE_CONDENSE, STAGE_PROBLEM}};

const effect_ops tangents_effect = {
  .name = "tangential unknowns", .bit = EFFECT_BIT_TANGENTS,
  .required = requires_tangents, .expected = tangents, .own = STAGE_NONE,
  .within = "unilateral contact"};

const effect_ops body_forces_effect = {
  .name = "body forces", .bit = EFFECT_BIT_BODY,
  .required = requires_body, .expected = body, .own = STAGE_BODY, .far = 1};

const effect_ops stresses_effect = {
  .name = "stresses", .bit = EFFECT_BIT_STRESS, .required = requires_stress,
  .expected = stresses, .own = STAGE_STRESS};

const effect_ops reactions_effect = {
  .name = "reactions", .bit = EFFECT_BIT_REACTION,
  .required = requires_reaction, .expected = reactions, .own = STAGE_REACTION,
  COLUMNS_OF(reaction_columns)};
/* clang-format on */
