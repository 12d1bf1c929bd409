/*
 * Thermal strain: temperatures of the elements at each time, the strains of
 * their expansion, the moduli that follow them.
 */
#include "effects/plan/effect.h"

#include "run/column_row.h"

typedef struct thermal_state {
  double *T0; /* [n_elem] before the first step */
  int *zone;  /* [n_elem] of the domain */
} thermal_state;

static status temperatures_new(run *r, void **self) {
  thermal_state *own = *self;
  PASS_NEW_ALL(OF(own->T0, r->msh->n_elem), OF(own->zone, r->msh->n_elem));
  r->strains.temperature0 = own->T0;
  r->body.d.zone = own->zone;
  PASS(load_temperature_zones(r->m, r->msh, own->zone));
  return load_temperature_initial(r->m, r->msh, own->T0);
}

static int expands(const model *m, int elem_id) {
  const section *s = &m->sections[m->elem_section[elem_id]];
  return m->materials[s->material_id].expand.given;
}

static int strains(const model *m, int elem_id) {
  return expands(m, elem_id) || moduli_follows(m, elem_id);
}

static void strain(run *r, const double *T0) {
  const size_t ns = r->m->ns;
  equilibrium *now = &r->now;
  for (int k = 0; k < r->strains.eigen.n; ++k) {
    int e = r->strains.elem[k];
    if (expands(r->m, e))
      expansion_strain(&run_material(r, e)->expand, now->temperature[e], T0[e],
                       now->thermal + ns * k);
  }
  /* Thermal strains are averaged as the strains are that they are taken off. */
  cluster_set *c = r->body.d.cluster;
  double *thermal = r->now.thermal;
  cluster_begin(c, CLUSTER_STRAIN);
  for (int k = 0; k < r->strains.eigen.n; ++k)
    cluster_add(c, CLUSTER_STRAIN, r->strains.elem[k], thermal + ns * k);
  for (int k = 0; k < r->strains.eigen.n; ++k)
    cluster_smooth(c, CLUSTER_STRAIN, r->strains.elem[k], thermal + ns * k);
}

/* Temperatures, moduli and thermal strains of r->now at t. */
static status heat(run *r, void *self, double t) {
  const double *T0 = ((const thermal_state *)self)->T0;
  int changed = 0;
  if (r->strains.eigen.n == 0) return OK;
  PASS(load_temperature(r->m, r->msh, r->step, t, T0, r->now.temperature));
  PASS(moduli_heat(&r->body.moduli, r->m, r->now.temperature, &changed));
  if (changed) run_change_moduli(r);
  strain(r, T0);
  return OK;
}

static effect_work expected(const plan_sizes *s) {
  double n = 0.0;
  for (int i = 0; s->msh != NULL && i < s->m->n.section; ++i) {
    const material *mat = plan_material(s->m, i);
    if (mat->expand.given || (mat->law.ops != NULL &&
                              (law_varies(&mat->law) & LAW_VARIES_TEMPERATURE)))
      n += plan_section_elements(s, i);
  }
  return (effect_work){n, "elements", 1.0 + s->equilibria,
                       s->equilibria * n * 2.0 * plan_element_work(s)};
}

static const load *first_temperature(const model *m) {
  for (int i = 0; i < m->n.step; ++i)
    for (int k = 0; k < m->steps[i].loads.n; ++k)
      if (m->steps[i].loads.item[k].kind == LOAD_TEMPERATURE)
        return &m->steps[i].loads.item[k];
  return NULL;
}

/* Material whose law depends on temperature; whose moduli do. */
static const material *first_warm_law(const model *m) {
  for (EACH(const material, mat, m->materials, m->n.material))
    if (mat->used && mat->law.ops != NULL &&
        (law_varies(&mat->law) & LAW_VARIES_TEMPERATURE))
      return mat;
  return NULL;
}

static const material *first_warm_moduli(const model *m) {
  for (int i = 0; i < m->n.material; ++i)
    if (m->materials[i].used && m->materials[i].elastic.n > 1)
      return &m->materials[i];
  return NULL;
}

static int has_expansion(const model *m) {
  for (int i = 0; i < m->n.material; ++i)
    if (m->materials[i].used && m->materials[i].expand.given) return 1;
  return 0;
}

static int requires_thermal(const model *m, const reason *why) {
  const load *l = first_temperature(m);
  const int given = l != NULL || facts_has_initial(m, INITIAL_TEMPERATURE);
  const material *law = first_warm_law(m), *warm = first_warm_moduli(m);
  if (given && law != NULL && facts_has_inelastic(m))
    return plan_says(1, why, "law %s of material %s depends on temperature",
                     law->law.ops->name, law->name);
  if (given && warm != NULL)
    return plan_says(1, why, "*ELASTIC of material %s depends on temperature",
                     warm->name);
  if (l == NULL) return plan_says(0, why, "no *TEMPERATURE card");
  if (!has_expansion(m))
    return plan_says(0, why, "no material in use has *EXPANSION");
  return plan_at(why, &l->at, "*TEMPERATURE on group %s", l->group);
}

VALUE(thermal_work, v->s->energy.thermal)

/* clang-format off */
static const column columns[] = {
{"thermal_work", J, INC, PRINT_ENERGY | AT(4), ON(THERMAL), ANY,
 "thermal_work", 0, thermal_work, NULL,
 "work of the stresses on thermal strains so far"}};

const effect_ops thermal_effect = {
  .name = "thermal strain", .bit = EFFECT_BIT_THERMAL,
  .required = requires_thermal, .expected = expected, .own = STAGE_THERMAL,
  .far = 1, .strains = strains, .of_state = 1, .size = sizeof(thermal_state),
  .on = {.create = temperatures_new, .load = heat},
  COLUMNS_OF(columns)};
/* clang-format on */
