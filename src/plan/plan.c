/*
 * The rows of the plan: a table of the effects, what is on of them, and on how
 * many nodes or elements of the mesh they work.
 */
#include "plan/plan.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

#define PLACE(at) place_file(&(at)), (at).line_no

/* The card that asks for an output, or why there is none; 1: it is on. */
typedef int asked_fn(const model *m, int table, char *why, size_t size);

static int asks_table(const model *m, int table, char *why, size_t size) {
  static const char *const words[] = {"CONTACT",  "TOTALS", "NODES",
                                      "ELEMENTS", "ENERGY", "REACTIONS",
                                      "ZONES",    "LOOP"};
  int k = 0;
  while (table >> k != 1) ++k;
  for (int i = 0; i < m->n_step; ++i)
    for (int q = 0; q < m->steps[i].n_print; ++q) {
      const print_request *p = &m->steps[i].prints[q];
      if (p->table != table) continue;
      snprintf(why, size, "*PRINT, %s, %s:%d", words[k], PLACE(p->at));
      return 1;
    }
  snprintf(why, size, "no *PRINT, %s", words[k]);
  return 0;
}

static int asks_fields(const model *m, int none, char *why, size_t size) {
  (void)none;
  for (int i = 0; i < m->n_step; ++i) {
    const step *s = &m->steps[i];
    if (s->output_frequency < 0) continue;
    if (s->has_output)
      snprintf(why, size, "*OUTPUT, %s:%d", PLACE(s->output_at));
    else
      snprintf(why, size, "default; *OUTPUT, HDF5=NO leaves them out");
    return 1;
  }
  snprintf(why, size, "*OUTPUT, HDF5=NO");
  return 0;
}

static int asks_condensed(const model *m, int none, char *why, size_t size) {
  (void)none;
  for (int i = 0; i < m->n_step; ++i) {
    const step *s = &m->steps[i];
    if (s->condensed_frequency < 0) continue;
    snprintf(why, size, "*OUTPUT, CONDENSED=FCLIB, %s:%d", PLACE(s->output_at));
    return 1;
  }
  snprintf(why, size, "no *OUTPUT, CONDENSED=FCLIB");
  return 0;
}

static int asks_restart(const model *m, int none, char *why, size_t size) {
  (void)none;
  for (int i = 0; i < m->n_step; ++i) {
    const step *s = &m->steps[i];
    if (s->restart_frequency < 0) continue;
    snprintf(why, size, "*RESTART, %s:%d", PLACE(s->restart_at));
    return 1;
  }
  snprintf(why, size, "no *RESTART card");
  return 0;
}

static int asks_velocity(const model *m, int none, char *why, size_t size) {
  (void)none;
  for (int i = 0; i < m->n_step; ++i) {
    if (m->steps[i].form != FORM_VELOCITY) continue;
    snprintf(why, size, "*QUASISTATIC, FORM=VELOCITY of %s:%d",
             PLACE(m->steps[i].at));
    return 1;
  }
  snprintf(why, size, "no *QUASISTATIC, FORM=VELOCITY");
  return 0;
}

/* Jumps are looked for where friction makes a path of increments. */
static int asks_check(const model *m, int none, char *why, size_t size) {
  (void)none;
  for (int i = 0; i < m->n_step; ++i) {
    const step *s = &m->steps[i];
    if (s->check == CHECK_NONE) continue;
    snprintf(why, size, "*SOLVER, CHECK=, %s:%d", PLACE(s->solver_at));
    return 1;
  }
  for (int i = 0; i < m->n_step && (m->effects & EFFECT_FRICTION); ++i) {
    const step *s = &m->steps[i];
    if (s->kind != STEP_QUASISTATIC) continue;
    snprintf(why, size, "friction in *QUASISTATIC of %s:%d may jump",
             PLACE(s->at));
    return 1;
  }
  snprintf(why, size, "no *SOLVER, CHECK=, no path of friction");
  return 0;
}

/* ---- sizes -------------------------------------------------------------- */

/* Nodes that a set of contacts has, each once; "is" NULL: all contacts. */
static status contact_nodes(const model *m, const mesh *msh,
                            int (*is)(const friction_rule *rule), double *n) {
  status st = OK;
  unsigned char *seen = NULL;
  *n = 0.0;
  NEW(seen, msh->n_node);
  for (int i = 0; i < m->n_contact; ++i) {
    const mesh_group *g = &msh->group[m->contacts[i].group_id];
    int counts = is == NULL;
    for (int k = 0; k < m->n_step && !counts; ++k)
      counts = is(friction_in_force(m, k, i));
    for (int k = 0; k < g->n_node && counts; ++k) {
      *n += !seen[g->node_id[k]];
      seen[g->node_id[k]] = 1;
    }
  }
done:
  memory_free(seen);
  return st;
}

static double given_nodes(const model *m, const mesh *msh) {
  double n = 0.0;
  for (int i = 0; i < m->n_contact; ++i)
    if (m->contacts[i].force.given)
      n += msh->group[m->contacts[i].group_id].n_node;
  return n;
}

/* Elements of a section. */
static double section_elements(const model *m, const mesh *msh, int id) {
  double n = 0.0;
  for (int e = 0; e < msh->n_elem; ++e) n += m->elem_section[e] == id;
  return n;
}

static const material *material_of(const model *m, int section_id) {
  static const material unknown;
  int id = m->sections[section_id].material_id;
  return id >= 0 ? &m->materials[id] : &unknown;
}

static double heated_elements(const model *m, const mesh *msh) {
  double n = 0.0;
  for (int i = 0; i < m->n_section; ++i) {
    const material *mat = material_of(m, i);
    if (mat->expand.given || (mat->law.ops != NULL &&
                              (law_varies(&mat->law) & LAW_VARIES_TEMPERATURE)))
      n += section_elements(m, msh, i);
  }
  return n;
}

static double loaded_elements(const model *m, const mesh *msh) {
  double n = 0.0;
  for (int i = 0; i < m->n_step; ++i) {
    double here = 0.0;
    const load_list *l = &m->steps[i].loads;
    for (int k = 0; k < l->n; ++k)
      if (l->item[k].kind == LOAD_BODY || l->item[k].kind == LOAD_GRAVITY)
        here += msh->group[l->item[k].group_id].n_item;
    n = fmax(n, here);
  }
  return n;
}

static status held_unknowns(const model *m, const mesh *msh, double *unknowns,
                            double *nodes) {
  status st = OK;
  int dim = msh->dim;
  unsigned char *fixed = NULL;
  *unknowns = *nodes = 0.0;
  NEW(fixed, dim * msh->n_node);
  if (m->n_step > 0) load_fixed(m, msh, &m->steps[0], fixed);
  for (int i = 0; i < msh->n_node; ++i) {
    int any = 0;
    for (int c = 0; c < dim; ++c) any += fixed[dim * i + c] != 0;
    *unknowns += any;
    *nodes += any > 0;
  }
done:
  memory_free(fixed);
  return st;
}

enum { ADAPTED = 50 }; /* increments of a step with a tolerance, at most      */

static double step_increments(const step *s) {
  if (s->kind == STEP_STATIC || !(s->dt > 0.0)) return 1.0;
  double n = ceil(s->total / s->dt * (1.0 - 1e-9));
  return s->tolerance > 0.0 ? fmin(n, ADAPTED) : n;
}

/* Increments that an output with this frequency shows. */
static double shown_of(const step *s, int frequency) {
  if (frequency < 0) return 0.0;
  return frequency == 0 ? 1.0 : ceil(step_increments(s) / frequency);
}

/* The same of all steps: of a table, or of all tables and fields. */
static double shown_in_all(const model *m, int table) {
  double n = 0.0;
  for (int i = 0; i < m->n_step; ++i) {
    const step *s = &m->steps[i];
    double here = table != 0 ? 0.0 : shown_of(s, s->output_frequency);
    for (int k = 0; k < s->n_print; ++k)
      if (table == 0 || s->prints[k].table == table)
        here = fmax(here, shown_of(s, s->prints[k].frequency));
    n += here;
  }
  return n;
}

/* 1 if all laws that flow have a constant Jacobian. */
static int flows_linearly(const model *m) {
  for (int i = 0; i < m->n_section; ++i) {
    const law_card *law = &material_of(m, i)->law;
    if (law->ops != NULL && !law->ops->linear) return 0;
  }
  return 1;
}

enum { NEWTON_STEPS = 4 }; /* of an implicit step of a law that is not linear */

/* Contact problems of an increment of a step. */
static double problems_of(const model *m, const step *s) {
  if (s->kind != STEP_VISCO || !(m->effects & EFFECT_INELASTIC)) return 1.0;
  const scheme *i = s->integrator;
  if (!i->has_theta && i->theta == 0.0 && !i->linear_only) return i->order;
  return flows_linearly(m) ? 1.0 : NEWTON_STEPS;
}

static double factors_of(const model *m, const step *s) {
  if (s->kind != STEP_VISCO || !(m->effects & EFFECT_INELASTIC)) return 0.0;
  const scheme *i = s->integrator;
  if (!i->has_theta && i->theta == 0.0 && !i->linear_only) return 0.0;
  if (flows_linearly(m)) return 1.0;
  return s->initial ? 0.0 : NEWTON_STEPS * step_increments(s);
}

static void count_increments(const model *m, plan_sizes *s) {
  s->factors = 1.0;
  s->flows_linearly = flows_linearly(m);
  for (int i = 0; i < m->n_step; ++i) {
    double n = step_increments(&m->steps[i]);
    s->increments += n;
    s->equilibria += n * problems_of(m, &m->steps[i]);
    s->factors += factors_of(m, &m->steps[i]);
  }
}

static status find_sizes(const model *m, const mesh *msh, int n,
                         plan_sizes *s) {
  status st = OK;
  double held, nodes;
  *s = (plan_sizes){.dim = m->dim, .ns = m->ns, .is_flat = m->dim < 3};
  count_increments(m, s);
  s->contact = n;
  if (msh != NULL) {
    s->nodes = msh->n_node;
    s->elements = msh->n_elem;
    TRY(held_unknowns(m, msh, &held, &nodes));
    s->unknowns = (double)msh->dim * msh->n_node - held;
    TRY(contact_nodes(m, msh, NULL, &s->contact));
  }
  if (m->effects & EFFECT_TANGENTS) s->tangents = (s->dim - 1) * s->contact;
done:
  return st;
}

/* ---- items: nodes, elements or rows that an effect works on -------------- */

typedef status items_fn(const model *m, const mesh *msh, const plan_sizes *s,
                        double *n);

static status of_elements(const model *m, const mesh *msh, const plan_sizes *s,
                          double *n) {
  (void)m;
  (void)msh;
  *n = s->elements;
  return OK;
}

static status of_nodes(const model *m, const mesh *msh, const plan_sizes *s,
                       double *n) {
  (void)m;
  (void)msh;
  *n = s->nodes;
  return OK;
}

static status of_contact(const model *m, const mesh *msh, const plan_sizes *s,
                         double *n) {
  (void)m;
  (void)msh;
  *n = s->contact;
  return OK;
}

static status of_tangents(const model *m, const mesh *msh, const plan_sizes *s,
                          double *n) {
  (void)m;
  (void)msh;
  *n = s->tangents;
  return OK;
}

static status of_friction(const model *m, const mesh *msh, const plan_sizes *s,
                          double *n) {
  *n = s->contact;
  return msh == NULL ? OK : contact_nodes(m, msh, rule_has_friction, n);
}

static status of_average(const model *m, const mesh *msh, const plan_sizes *s,
                         double *n) {
  (void)s;
  *n = 0.0;
  return msh == NULL ? OK : contact_nodes(m, msh, rule_has_average, n);
}

static status of_given(const model *m, const mesh *msh, const plan_sizes *s,
                       double *n) {
  (void)s;
  *n = msh == NULL ? 0.0 : given_nodes(m, msh);
  return OK;
}

static status of_heated(const model *m, const mesh *msh, const plan_sizes *s,
                        double *n) {
  (void)s;
  *n = msh == NULL ? 0.0 : heated_elements(m, msh);
  return OK;
}

static status of_loaded(const model *m, const mesh *msh, const plan_sizes *s,
                        double *n) {
  (void)s;
  *n = msh == NULL ? 0.0 : loaded_elements(m, msh);
  return OK;
}

static status of_held(const model *m, const mesh *msh, const plan_sizes *s,
                      double *n) {
  double unknowns;
  (void)s;
  *n = 0.0;
  return msh == NULL ? OK : held_unknowns(m, msh, &unknowns, n);
}

static status of_contacts(const model *m, const mesh *msh, const plan_sizes *s,
                          double *n) {
  (void)msh;
  (void)s;
  *n = m->n_contact;
  return OK;
}

static status of_one(const model *m, const mesh *msh, const plan_sizes *s,
                     double *n) {
  (void)m;
  (void)msh;
  (void)s;
  *n = 1.0;
  return OK;
}

/* ---- the table ---------------------------------------------------------- */

#define NONE (-1)
#define STAGE(name) \
  { STAGE_##name }
#define STAGES(...) \
  { __VA_ARGS__ }

/* clang-format off */
/* bit: of model.effects, or NONE and a function that tells. "stages": end with
 * the deck, which belongs to no effect. */
static const struct {
  const char *name;
  int bit;
  asked_fn *asked;
  int table;
  items_fn *items;
  const char *kind;
  stage stages[8];
  const char *within;
} effects[] = {
  {"finite elements", EFFECT_BIT_MESH, NULL, 0, of_elements, "elements",
   STAGES(STAGE_ASSEMBLY, STAGE_ORDERING, STAGE_FACTOR, STAGE_LOAD,
          STAGE_RECOVERY, STAGE_ENERGY), NULL},
  {"unilateral contact", EFFECT_BIT_CONTACT, NULL, 0, of_contact, "nodes",
   STAGES(STAGE_CONTACT, STAGE_SURFACE, STAGE_CONDENSE, STAGE_PROBLEM), NULL},
  {"friction", EFFECT_BIT_FRICTION, NULL, 0, of_friction, "nodes",
   STAGE(LIMIT), NULL},
  {"tangential unknowns", EFFECT_BIT_TANGENTS, NULL, 0, of_tangents,
   "unknowns", STAGE(DECK),
   "unilateral contact"},
  {"nonlocal average", EFFECT_BIT_NONLOCAL, NULL, 0, of_average, "nodes",
   STAGE(NONLOCAL),
   NULL},
  {"given contact forces", EFFECT_BIT_GIVEN, NULL, 0, of_given, "nodes",
   STAGE(GIVEN),
   NULL},
  {"history of slip", EFFECT_BIT_HISTORY, NULL, 0, of_friction, "nodes",
   STAGE(HISTORY),
   NULL},
  {"velocity form", NONE, asks_velocity, 0, of_contact, "nodes",
   STAGE(VELOCITY), NULL},
  {"initial state", EFFECT_BIT_START, NULL, 0, of_nodes, "nodes",
   STAGE(START), NULL},
  {"inelastic strain", EFFECT_BIT_INELASTIC, NULL, 0, of_elements, "elements",
   STAGE(INELASTIC), NULL},
  {"thermal strain", EFFECT_BIT_THERMAL, NULL, 0, of_heated, "elements",
   STAGE(THERMAL),
   NULL},
  {"body forces", EFFECT_BIT_BODY, NULL, 0, of_loaded, "elements",
   STAGE(BODY), NULL},
  {"stresses", EFFECT_BIT_STRESS, NULL, 0, of_elements, "elements",
   STAGE(STRESS), NULL},
  {"reactions", EFFECT_BIT_REACTION, NULL, 0, of_held, "nodes",
   STAGE(REACTION), NULL},
  {"second solutions, jumps", NONE, asks_check, 0, of_contact, "nodes",
   STAGE(CHECK), NULL},
  {"theory checks", EFFECT_BIT_THEORY, NULL, 0, of_contact, "nodes",
   STAGE(THEORY), NULL},
  {"error of mesh", EFFECT_BIT_MESH_ERROR, NULL, 0, of_elements, "elements",
   STAGE(MESH_ERROR), NULL},
  {"error of steps", EFFECT_BIT_TIME_ERROR, NULL, 0, of_contact, "nodes",
   STAGE(TIME_ERROR), NULL},
  {"error of solver", EFFECT_BIT_ESTIMATES, NULL, 0, of_contact, "nodes",
   STAGE(ESTIMATE),
   NULL},
  {"closed form", EFFECT_BIT_REFERENCE, NULL, 0, of_elements, "elements",
   STAGE(REFERENCE), NULL},
  {"table of contact nodes", NONE, asks_table, PRINT_CONTACT, of_contact,
   "rows",
   STAGE(TABLE_CONTACT), NULL},
  {"table of resultants", NONE, asks_table, PRINT_TOTALS, of_contacts, "rows",
   STAGE(TABLE_TOTALS), NULL},
  {"table of nodes", NONE, asks_table, PRINT_NODES, of_nodes, "rows",
   STAGE(TABLE_NODES), NULL},
  {"table of elements", NONE, asks_table, PRINT_ELEMENTS, of_elements, "rows",
   STAGE(TABLE_ELEMENTS), NULL},
  {"table of energies", NONE, asks_table, PRINT_ENERGY, of_one, "rows",
   STAGE(TABLE_ENERGY), NULL},
  {"table of reactions", NONE, asks_table, PRINT_REACTIONS, of_held, "rows",
   STAGE(TABLE_REACTIONS), NULL},
  {"table of zones", NONE, asks_table, PRINT_ZONES, of_contact, "nodes",
   STAGES(STAGE_ZONES, STAGE_TABLE_ZONES), NULL},
  {"table of loops", NONE, asks_table, PRINT_LOOP, of_contacts, "rows",
   STAGE(TABLE_LOOP), NULL},
  {"fields in JOB.h5", NONE, asks_fields, 0, of_nodes, "nodes", STAGE(HDF5),
   NULL},
  {"condensed problems", NONE, asks_condensed, 0, of_contact, "nodes",
   STAGE(FCLIB), NULL},
  {"restart", NONE, asks_restart, 0, of_nodes, "nodes", STAGE(RESTART), NULL},
  {"listing, .sta, .cvg", NONE, NULL, 0, of_one, NULL, STAGE(LISTING), NULL},
};
/* clang-format on */
enum { N_EFFECT = sizeof effects / sizeof *effects };

/* ---- rows --------------------------------------------------------------- */

/* Rows of a table all of whose requests name a group: of the largest. */
static void confine_rows(const model *m, const mesh *msh, int table,
                         double *items) {
  double most = 0.0;
  for (int i = 0; i < m->n_step && msh != NULL; ++i)
    for (int k = 0; k < m->steps[i].n_print; ++k) {
      const print_request *p = &m->steps[i].prints[k];
      if (p->table != table) continue;
      if (p->group_id < 0) return;
      const mesh_group *g = &msh->group[p->group_id];
      most = fmax(most, table == PRINT_ELEMENTS ? g->n_item : g->n_node);
    }
  if (most > 0.0) *items = fmin(*items, most);
}

static plan_row row_of(const model *m, int k) {
  plan_row r = {.name = effects[k].name,
                .on = 1,
                .kind = effects[k].kind,
                .within = effects[k].within};
  while (effects[k].stages[r.n_stage] != STAGE_DECK) {
    r.stages[r.n_stage] = effects[k].stages[r.n_stage];
    ++r.n_stage;
  }
  if (effects[k].bit != NONE) {
    r.on = (m->effects >> effects[k].bit & 1u) != 0;
    model_effect_reason(m, effects[k].bit, r.why, sizeof r.why);
  } else if (effects[k].asked != NULL) {
    r.on = effects[k].asked(m, effects[k].table, r.why, sizeof r.why);
  } else {
    snprintf(r.why, sizeof r.why, "always");
  }
  return r;
}

static status add_row(effect_plan *p, int *capacity, const plan_row *r) {
  status st = OK;
  GROW(p->rows, p->n, *capacity);
  p->rows[p->n] = *r;
  if (r->on) {
    effect_work w = work_of(r->name, &p->sizes, r->items);
    p->rows[p->n].calls = w.calls;
    p->rows[p->n].work = w.operations;
  } else {
    p->rows[p->n].items = 0.0;
  }
  ++p->n;
done:
  return st;
}

/* Elements of a section whose law counts. */
static double flowing_elements(const model *m, const mesh *msh, int id) {
  int n = 0;
  for (int e = 0; e < msh->n_elem; ++e)
    n += m->elem_section[e] == id && model_flows(m, e);
  return n;
}

/* One row for each group whose material has a law; the first has the stage. */
static status add_laws(const model *m, const mesh *msh, effect_plan *p,
                       int *capacity, const plan_row *all) {
  status st = OK;
  int first = 1;
  for (int i = 0; i < m->n_section && msh != NULL; ++i) {
    const material *mat = material_of(m, i);
    plan_row r = *all;
    if (mat->law.ops == NULL) continue;
    snprintf(r.of, sizeof r.of, "%s", m->sections[i].elset);
    if (r.on)
      snprintf(r.why, sizeof r.why, "%s of material %s, %s:%d",
               mat->law.ops->name, mat->name, PLACE(mat->law.at));
    r.items = flowing_elements(m, msh, i);
    p->sizes.flowing += r.items;
    if (!first) {
      r.n_stage = 0;
      r.within = "the first group";
    }
    first = 0;
    TRY(add_row(p, capacity, &r));
  }
  if (first) TRY(add_row(p, capacity, all));
done:
  return st;
}

static void find_shares(effect_plan *p) {
  double sum = 0.0;
  for (int i = 0; i < p->n; ++i) sum += p->rows[i].work;
  for (int i = 0; i < p->n && sum > 0.0; ++i)
    p->rows[i].share = p->rows[i].work / sum;
}

status plan_new(const model *m, const mesh *msh, int n, effect_plan **out) {
  status st = OK;
  effect_plan *p = NULL;
  int capacity = 0;
  *out = NULL;
  NEW(p, 1);
  TRY(find_sizes(m, msh, n, &p->sizes));
  for (int k = 0; k < N_EFFECT; ++k) {
    plan_row r = row_of(m, k);
    p->sizes.shown = shown_in_all(m, effects[k].table);
    TRY(effects[k].items(m, msh, &p->sizes, &r.items));
    confine_rows(m, msh, effects[k].table, &r.items);
    if (effects[k].bit == EFFECT_BIT_INELASTIC)
      TRY(add_laws(m, msh, p, &capacity, &r));
    else
      TRY(add_row(p, &capacity, &r));
  }
  find_shares(p);
  *out = p;
  p = NULL;
done:
  plan_free(p);
  return st;
}

void plan_free(effect_plan *p) {
  if (p == NULL) return;
  memory_free(p->rows);
  memory_free(p);
}
