/*
 * The rows of the plan: a table of the effects, and what is on of them.
 */
#include "effects/plan/rows.h"

#include "base/memory.h"

#include <math.h>

#define NONE (-1)
#define STAGE(name) \
  { STAGE_##name }
#define STAGES(...) \
  { __VA_ARGS__ }

/* clang-format off */
/* bit: of model.effects, or NONE and what tells. "stages": end with
 * the deck, which belongs to no effect. */
static const struct {
  const char *name;
  int bit;
  asked_kind asked;
  int table;
  items_kind items;
  const char *kind;
  stage stages[8];
  const char *within;
} effects[] = {
  {"finite elements", EFFECT_BIT_MESH, ASKED_ALWAYS, 0, OF_ELEMENTS, "elements",
   STAGES(STAGE_ASSEMBLY, STAGE_ORDERING, STAGE_FACTOR, STAGE_LOAD,
   STAGE_RECOVERY, STAGE_ENERGY), NULL},
  {"unilateral contact", EFFECT_BIT_CONTACT, ASKED_ALWAYS, 0, OF_CONTACT,
   "nodes", STAGES(STAGE_CONTACT, STAGE_SURFACE, STAGE_CONDENSE, STAGE_PROBLEM),
   NULL},
  {"friction", EFFECT_BIT_FRICTION, ASKED_ALWAYS, 0, OF_FRICTION, "nodes",
   STAGE(LIMIT), NULL},
  {"tangential unknowns", EFFECT_BIT_TANGENTS, ASKED_ALWAYS, 0, OF_TANGENTS,
   "unknowns", STAGE(DECK), "unilateral contact"},
  {"nonlocal average", EFFECT_BIT_NONLOCAL, ASKED_ALWAYS, 0, OF_AVERAGE,
   "nodes", STAGE(NONLOCAL), NULL},
  {"given contact forces", EFFECT_BIT_GIVEN, ASKED_ALWAYS, 0, OF_GIVEN, "nodes",
   STAGE(GIVEN), NULL},
  {"history of slip", EFFECT_BIT_HISTORY, ASKED_ALWAYS, 0, OF_FRICTION, "nodes",
   STAGE(HISTORY), NULL},
  {"velocity form", NONE, ASKED_VELOCITY, 0, OF_CONTACT, "nodes",
   STAGE(VELOCITY), NULL},
  {"initial state", EFFECT_BIT_START, ASKED_ALWAYS, 0, OF_NODES, "nodes",
   STAGE(START), NULL},
  {"inelastic strain", EFFECT_BIT_INELASTIC, ASKED_ALWAYS, 0, OF_ELEMENTS,
   "elements", STAGE(INELASTIC), NULL},
  {"thermal strain", EFFECT_BIT_THERMAL, ASKED_ALWAYS, 0, OF_HEATED, "elements",
   STAGE(THERMAL), NULL},
  {"body forces", EFFECT_BIT_BODY, ASKED_ALWAYS, 0, OF_LOADED, "elements",
   STAGE(BODY), NULL},
  {"stresses", EFFECT_BIT_STRESS, ASKED_ALWAYS, 0, OF_ELEMENTS, "elements",
   STAGE(STRESS), NULL},
  {"reactions", EFFECT_BIT_REACTION, ASKED_ALWAYS, 0, OF_HELD, "nodes",
   STAGE(REACTION), NULL},
  {"second solutions, jumps", NONE, ASKED_CHECK, 0, OF_CONTACT, "nodes",
   STAGE(CHECK), NULL},
  {"theory checks", EFFECT_BIT_THEORY, ASKED_ALWAYS, 0, OF_CONTACT, "nodes",
   STAGE(THEORY), NULL},
  {"error of mesh", EFFECT_BIT_MESH_ERROR, ASKED_ALWAYS, 0, OF_ELEMENTS,
   "elements", STAGE(MESH_ERROR), NULL},
  {"error of steps", EFFECT_BIT_TIME_ERROR, ASKED_ALWAYS, 0, OF_CONTACT,
   "nodes", STAGE(TIME_ERROR), NULL},
  {"error of solver", EFFECT_BIT_ESTIMATES, ASKED_ALWAYS, 0, OF_CONTACT,
   "nodes", STAGE(ESTIMATE), NULL},
  {"closed form", EFFECT_BIT_REFERENCE, ASKED_ALWAYS, 0, OF_ELEMENTS,
   "elements", STAGE(REFERENCE), NULL},
  {"table of contact nodes", NONE, ASKED_TABLE, PRINT_CONTACT, OF_CONTACT,
   "rows", STAGE(TABLE_CONTACT), NULL},
  {"table of resultants", NONE, ASKED_TABLE, PRINT_TOTALS, OF_CONTACTS, "rows",
   STAGE(TABLE_TOTALS), NULL},
  {"table of nodes", NONE, ASKED_TABLE, PRINT_NODES, OF_NODES, "rows",
   STAGE(TABLE_NODES), NULL},
  {"table of elements", NONE, ASKED_TABLE, PRINT_ELEMENTS, OF_ELEMENTS, "rows",
   STAGE(TABLE_ELEMENTS), NULL},
  {"table of energies", NONE, ASKED_TABLE, PRINT_ENERGY, OF_ONE, "rows",
   STAGE(TABLE_ENERGY), NULL},
  {"table of reactions", NONE, ASKED_TABLE, PRINT_REACTIONS, OF_HELD, "rows",
   STAGE(TABLE_REACTIONS), NULL},
  {"table of zones", NONE, ASKED_TABLE, PRINT_ZONES, OF_CONTACT, "nodes",
   STAGES(STAGE_ZONES, STAGE_TABLE_ZONES), NULL},
  {"table of loops", NONE, ASKED_TABLE, PRINT_LOOP, OF_CONTACTS, "rows",
   STAGE(TABLE_LOOP), NULL},
  {"fields in JOB.h5", NONE, ASKED_FIELDS, 0, OF_NODES, "nodes", STAGE(HDF5),
   NULL},
  {"condensed problems", NONE, ASKED_CONDENSED, 0, OF_CONTACT, "nodes",
   STAGE(FCLIB), NULL},
  {"restart", NONE, ASKED_RESTART, 0, OF_NODES, "nodes", STAGE(RESTART), NULL},
  {"listing, .sta, .cvg", NONE, ASKED_ALWAYS, 0, OF_ONE, NULL, STAGE(LISTING),
   NULL},
};
/* clang-format on */
enum { N_EFFECT = sizeof effects / sizeof *effects };

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
  } else {
    r.on = asked(effects[k].asked, m, effects[k].table, r.why, sizeof r.why);
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
    const material *mat = plan_material(m, i);
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
  TRY(sizes_find(m, msh, n, &p->sizes));
  for (int k = 0; k < N_EFFECT; ++k) {
    plan_row r = row_of(m, k);
    p->sizes.shown = sizes_shown(m, effects[k].table);
    TRY(items_of(effects[k].items, m, msh, &p->sizes, &r.items));
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
