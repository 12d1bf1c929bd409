/*
 * Effects out of the model for a run, and back into it.
 */
#include "effects/reduction/reduction.h"
#include "effects/rows.h"

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
  for (int i = 0; i < m->reduction.n; ++i) {
    omitted *row = &m->reduction.row[i];
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
      m->effects &= ~(unsigned)EFFECT_THERMAL;
}

void reduction_restore(model *m) {
  each_rule(m, put_back);
  for (int i = 0; i < m->n.material; ++i) {
    material *mat = &m->materials[i];
    if (mat->law_aside != NULL) mat->law.ops = mat->law_aside;
    mat->law_aside = NULL;
    mat->is_still = 0;
    if (mat->is_relaxed) change_constants(mat);
  }
  m->effects = effects_required(m);
}
