/*
 * The model as the trials read it: scales of the deck, laws at a point; effects
 * out of it for a run, and back into it.
 */
#include "effects/plan/effect.h"
#include "effects/reduction/parts.h"

const double reduction_share = 0.1;

double reduction_load_stress(const model *m, const mesh *msh, double young) {
  double most = 0.0;
  for (int i = 0; i < m->n.step; ++i)
    for (EACH(const load, l, m->steps[i].loads.item, m->steps[i].loads.n)) {
      double value = fabs(l->value.number);
      if (l->kind == LOAD_TEMPERATURE) continue;
      if (l->value.formula != NULL || l->kind == LOAD_POINT ||
          l->kind == LOAD_BODY || l->kind == LOAD_GRAVITY)
        return 0.0;
      if (l->kind == LOAD_FIXING) value *= young / msh->size;
      most = fmax(most, value);
    }
  return most;
}

double reduction_young(const material *mat) {
  double C = 0.0;
  for (int i = 0; i < 3; ++i) C = fmax(C, mat->C[7 * i]);
  return C;
}

int reduction_has_initial(const model *m) {
  for (int i = 0; i < m->n.initial; ++i)
    if (m->initial.lines[i].type != INITIAL_TEMPERATURE) return 1;
  return m->initial.start.given;
}

omitted *reduction_row(model *m, int bit, int id) {
  if (m->reduction.n == OMITTED_MAX) return NULL;
  omitted *row = &m->reduction.row[m->reduction.n++];
  *row = (omitted){.bit = bit, .id = id};
  return row;
}

int reduction_kinematics(const model *m, int material_id) {
  for (int i = 0; i < m->n.section; ++i)
    if (m->sections[i].material_id == material_id) return m->sections[i].kin;
  return -1;
}

double reduction_increments(const step *s, double dt) {
  return s->kind == STEP_STATIC ? 1.0 : ceil(s->total / dt);
}

/* Each friction rule of the model once. */
static void each_rule(model *m, void (*change)(friction_rule *rule)) {
  for (int i = 0; i < m->n.contact; ++i) change(&m->contacts[i].friction);
  for (int i = 0; i < m->n.step; ++i)
    for (int k = 0; k < m->steps[i].friction.n; ++k)
      change(&m->steps[i].friction.changes[k].rule);
}

static void make_local(friction_rule *rule) {
  if (rule->law == NULL || rule->law->average == NULL) return;
  rule->aside = rule->law;
  rule->law = &coulomb_friction;
}

static void take_out(friction_rule *rule) {
  if (rule->law == NULL) return;
  rule->aside = rule->law;
  rule->law = NULL;
}

static void put_back(friction_rule *rule) {
  if (rule->aside == NULL) return;
  rule->law = rule->aside;
  rule->aside = NULL;
}

/* Exchange the constants of *ELASTIC in force with the others. */
static void change_constants(material *mat) {
  char text[256];
  const elastic_constants now = mat->elastic.set[0];
  mat->elastic.set[0] = mat->elastic_aside;
  mat->elastic_aside = now;
  elastic_at(&mat->elastic, 0.0, mat->C, text, (int)sizeof text);
  mat->is_relaxed = !mat->is_relaxed;
}

void reduction_leave_out(model *m) {
  for (EACH(omitted, row, m->reduction.row, m->reduction.n)) {
    if (row->back) continue;
    row->bound = row->local = row->change = 0.0;
    row->checked = row->again = 0;
    if (row->bit == EFFECT_BIT_NONLOCAL) each_rule(m, make_local);
    if (row->bit == EFFECT_BIT_FRICTION) each_rule(m, take_out);
    if (row->bit != EFFECT_BIT_INELASTIC) continue;
    m->materials[row->id].is_still = row->some > 0;
    if (row->some > 0) continue;
    m->materials[row->id].law_aside = m->materials[row->id].law.ops;
    m->materials[row->id].law.ops = NULL;
    if (row->time > 0.0) change_constants(&m->materials[row->id]);
  }
  m->effects = effects_required(m);
  for (int i = 0; i < m->reduction.n; ++i)
    if (m->reduction.row[i].bit == EFFECT_BIT_THERMAL &&
        !m->reduction.row[i].back)
      m->effects &= ~EFFECT_THERMAL;
}

void reduction_restore(model *m) {
  each_rule(m, put_back);
  for (EACH(material, mat, m->materials, m->n.material)) {
    if (mat->law_aside != NULL) mat->law.ops = mat->law_aside;
    mat->law_aside = NULL;
    mat->is_still = 0;
    if (mat->is_relaxed) change_constants(mat);
  }
  m->effects = effects_required(m);
}
