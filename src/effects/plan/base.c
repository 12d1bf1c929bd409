/*
 * Rows of every body, of tables, fields and files, and of effects in other
 * files of the run: their expected work and their stages.
 */
#include "effects/plan/effect.h"

#include "run/column_row.h"

static effect_work elements(const plan_sizes *s) {
  double n = s->elements, entries = work_factor_entries(s);
  double assembly = n * (s->is_flat ? 500.0 : 2500.0);
  double ordering = s->nodes * (s->is_flat ? 700.0 : 3000.0);
  double factor = work_factor_flops(s) / PLAN_SPARSE + entries;
  double solves = s->equilibria * 2.0 * entries;
  double energy = s->increments * n * plan_element_work(s);
  return (effect_work){
      n, "elements", s->factors,
      s->factors * (assembly + ordering + factor) + solves + energy};
}

static effect_work unilateral(const plan_sizes *s) {
  double n = s->contact;
  return (effect_work){n, "nodes", s->equilibria,
                       plan_contact_work(s, n) + 500.0 * n};
}

static effect_work tangents(const plan_sizes *s) {
  double all = plan_contact_work(s, plan_contact_unknowns(s));
  return (effect_work){s->tangents, "unknowns", s->equilibria,
                       all - plan_contact_work(s, s->contact)};
}

static effect_work body(const plan_sizes *s) {
  double n = 0.0;
  for (int i = 0; s->msh != NULL && i < s->m->n.step; ++i) {
    double here = 0.0;
    const load_list *l = &s->m->steps[i].loads;
    for (int k = 0; k < l->n; ++k)
      if (l->item[k].kind == LOAD_BODY || l->item[k].kind == LOAD_GRAVITY)
        here += s->msh->group[l->item[k].group_id].n_item;
    n = fmax(n, here);
  }
  return (effect_work){n, "elements", -1.0,
                       s->equilibria * n * 4.0 * plan_element_work(s)};
}

static effect_work stresses(const plan_sizes *s) {
  return (effect_work){s->elements, "elements", s->shown,
                       s->shown * s->elements * plan_element_work(s)};
}

/* Of all elements in increments that are shown, else of those at supports. */
static effect_work reactions(const plan_sizes *s) {
  enum { AROUND = 4 }; /* elements a node of the border */
  const double there = fmin(s->elements, AROUND * s->held);
  return (effect_work){
      s->held, "nodes", s->increments,
      (s->shown * s->elements + (s->increments - s->shown) * there) *
          plan_element_work(s)};
}

/* ---- the cards that require them ----------------------------------------- */

static int requires_mesh(const model *m, const reason *why) {
  return plan_says(!m->problem.given, why, "*MESH, %s:%d", PLACE(m->mesh.at));
}

static int requires_contact(const model *m, const reason *why) {
  if (m->n.contact == 0) return plan_says(0, why, "no *CONTACT card");
  return plan_at(why, &m->contacts[0].at, "%s, NAME=%s",
                 contact_card(&m->contacts[0]), m->contacts[0].name);
}

int plan_requires_rule(const model *m, int (*is)(const friction_rule *rule),
                       const char *none, const reason *why) {
  for (EACH(const contact, c, m->contacts, m->n.contact))
    for (int k = 0; k < m->n.step; ++k) {
      const friction_rule *rule =
          friction_in_force(m, k, (int)(c - m->contacts));
      if (is(rule))
        return plan_at(why, &rule->at, "*FRICTION, LAW=%s on contact %s",
                       rule->law->name, c->name);
    }
  return plan_says(0, why, "%s", none);
}

/* 1: *EFFECTS leaves friction out and bounds what it would have changed. */
static int omits_friction(const model *m) {
  int any = 0;
  for (int i = 0; i < m->reduction.n; ++i)
    any |= m->reduction.row[i].bit == EFFECT_BIT_FRICTION &&
           !m->reduction.row[i].back;
  return any;
}

/* The normals of a second obstacle are tangents of the first. */
static int requires_tangents(const model *m, const reason *why) {
  const step *s = facts_first_whole(m);
  if (m->n.contact == 0 || friction_effect.required(m, NULL))
    return friction_effect.required(m, why);
  if (m->mesh.corner_id >= 0)
    return plan_at(why, &m->contacts[m->mesh.corner_id].at,
                   "contact %s meets another",
                   m->contacts[m->mesh.corner_id].name);
  if (s == NULL && omits_friction(m))
    return plan_at(why, &m->reduction.at, "friction left out is checked");
  if (s == NULL) return plan_says(0, why, "mu = 0: only normals are condensed");
  if (s->output.condensed >= 0)
    return plan_at(why, &s->output.at, "*OUTPUT, CONDENSED=FCLIB");
  if (s->check != CHECK_NONE)
    return plan_at(why, &s->solver_at, "*SOLVER, CHECK=");
  return plan_at(why, &s->accuracy.at, "*ACCURACY, THEORY=YES");
}

static int requires_body(const model *m, const reason *why) {
  for (int i = 0; i < m->n.step; ++i)
    for (EACH(const load, l, m->steps[i].loads.item, m->steps[i].loads.n))
      if (l->kind == LOAD_BODY || l->kind == LOAD_GRAVITY)
        return plan_at(why, &l->at, "*DLOAD on group %s", l->group);
  return plan_says(0, why, "no *DLOAD card");
}

static int requires_output(const model *m, int table, const reason *why) {
  for (EACH(const step, s, m->steps, m->n.step))
    for (int k = 0; k < s->print.n; ++k)
      if (s->print.requests[k].table & table)
        return plan_at(why, &s->print.requests[k].at, "*PRINT");
  if (model_writes_fields(m))
    return plan_says(1, why, "fields in JOB.h5, see below");
  return plan_says(0, why, "no output requires them");
}

static int requires_stress(const model *m, const reason *why) {
  return requires_output(m, PRINT_ELEMENTS, why);
}

/* Reactions are computed when printed, or where a support does work. */
static int requires_reaction(const model *m, const reason *why) {
  const load *l = facts_moving_support(m);
  if (l == NULL) return requires_output(m, PRINT_REACTIONS, why);
  return plan_says(1, why,
                   "work of the support %s, %s:%d, that moves or is released",
                   l->group, PLACE(l->at));
}

int plan_requires_accuracy(const model *m, const char *word,
                           int (*is)(const step *s), const reason *why) {
  const step *s = facts_first_step(m, is);
  if (s == NULL) return plan_says(0, why, "no *ACCURACY, %s=YES", word);
  if (m->accuracy.target.percent > 0.0)
    return plan_at(why, &s->accuracy.at, "*ACCURACY, TARGET=");
  if (s->accuracy.at.file == NULL || (s->balanced && strcmp(word, "MESH") == 0))
    return plan_at(why, &s->solver_at, "*SOLVER, TOL=BALANCED");
  return plan_at(why, &s->accuracy.at, "*ACCURACY, %s=YES", word);
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

/* ---- tables, fields and files -------------------------------------------- */

static const double TEXT = 250.0; /* operations to write a number */

double plan_rows(const plan_sizes *s, int table, double items) {
  double most = 0.0;
  for (int i = 0; i < s->m->n.step && s->msh != NULL; ++i)
    for (EACH(const print_request, p, s->m->steps[i].print.requests,
              s->m->steps[i].print.n)) {
      if (p->table != table) continue;
      if (p->group == NULL) return items;
      const mesh_group *g = &s->msh->group[p->group_id];
      most = fmax(most, table == PRINT_ELEMENTS ? g->n_item : g->n_node);
    }
  return most > 0.0 ? fmin(items, most) : items;
}

effect_work plan_table(const plan_sizes *s, int table, double all) {
  double n = plan_rows(s, table, all), shown = plan_shown(s->m, table);
  return (effect_work){n, "rows", shown, shown * n * 10.0 * TEXT};
}

int plan_requires_table(const model *m, int table, const reason *why) {
  for (int i = 0; i < m->n.step; ++i)
    for (EACH(const print_request, p, m->steps[i].print.requests,
              m->steps[i].print.n))
      if (p->table == table)
        return plan_at(why, &p->at, "*PRINT, %s", print_word(table));
  return plan_says(0, why, "no *PRINT, %s", print_word(table));
}

/* all: rows of the table of everything. */
#define TABLE(row, text, bit_, of_, all)                         \
  static int requires_##row(const model *m, const reason *why) { \
    return plan_requires_table(m, bit_, why);                    \
  }                                                              \
  static effect_work row##_rows(const plan_sizes *s) {           \
    return plan_table(s, bit_, all);                             \
  }                                                              \
  const effect_ops row##_effect = {.name = text,                 \
                                   .bit = NO_BIT,                \
                                   .required = requires_##row,   \
                                   .expected = row##_rows,       \
                                   .table = {bit_, of_}};
TABLE(contact_table, "table of contact nodes", PRINT_CONTACT, PER_CONTACT_NODE,
      s->contact)
TABLE(totals_table, "table of resultants", PRINT_TOTALS, PER_CONTACT,
      s->m->n.contact)
TABLE(nodes_table, "table of nodes", PRINT_NODES, PER_NODE, s->nodes)
TABLE(elements_table, "table of elements", PRINT_ELEMENTS, PER_ELEMENT,
      s->elements)
TABLE(energy_table, "table of energies", PRINT_ENERGY, PER_INCREMENT, 1.0)
TABLE(reactions_table, "table of reactions", PRINT_REACTIONS, PER_NODE, s->held)

static int requires_fields(const model *m, const reason *why) {
  for (int i = 0; i < m->n.step; ++i)
    if (m->steps[i].output.frequency >= 0 && m->steps[i].output.given)
      return plan_at(why, &m->steps[i].output.at, "*OUTPUT");
    else if (m->steps[i].output.frequency >= 0)
      return plan_says(1, why, "default; *OUTPUT, HDF5=NO leaves them out");
  return plan_says(0, why, "*OUTPUT, HDF5=NO");
}

static int requires_condensed(const model *m, const reason *why) {
  for (int i = 0; i < m->n.step; ++i)
    if (m->steps[i].output.condensed >= 0)
      return plan_at(why, &m->steps[i].output.at, "*OUTPUT, CONDENSED=FCLIB");
  return plan_says(0, why, "no *OUTPUT, CONDENSED=FCLIB");
}

static int requires_restart(const model *m, const reason *why) {
  for (int i = 0; i < m->n.step; ++i)
    if (m->steps[i].restart.frequency >= 0)
      return plan_at(why, &m->steps[i].restart.at, "*RESTART");
  return plan_says(0, why, "no *RESTART card");
}

static int requires_always(const model *m, const reason *why) {
  return plan_says(1, why, "always");
}

static effect_work fields(const plan_sizes *s) {
  return (effect_work){s->nodes, "nodes", -1.0,
                       4e6 + s->shown * (4e5 + 20.0 * s->nodes)};
}

static effect_work condensed_problems(const plan_sizes *s) {
  double m = plan_contact_unknowns(s);
  return (effect_work){s->contact, "nodes", -1.0,
                       s->increments * (1e6 + 3.0 * m * m)};
}

static effect_work restart(const plan_sizes *s) {
  return (effect_work){s->nodes, "nodes", -1.0,
                       s->increments * (1e6 + 50.0 * s->nodes)};
}

static effect_work listing(const plan_sizes *s) {
  return (effect_work){1.0, NULL, -1.0, 2e5 + s->increments * 60.0 * TEXT};
}

/* clang-format off */
const effect_ops fields_effect = {
  .name = "fields in JOB.h5", .bit = NO_BIT, .required = requires_fields,
  .expected = fields, .own = STAGE_HDF5};

const effect_ops condensed_problems_effect = {
  .name = "condensed problems", .bit = NO_BIT, .required = requires_condensed,
  .expected = condensed_problems, .own = STAGE_FCLIB};

const effect_ops restart_effect = {
  .name = "restart", .bit = NO_BIT, .required = requires_restart,
  .expected = restart, .own = STAGE_RESTART};

const effect_ops listing_effect = {
  .name = "listing, .sta, .cvg", .bit = NO_BIT, .required = requires_always,
  .expected = listing, .own = STAGE_LISTING};
/* clang-format on */
