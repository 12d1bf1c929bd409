/*
 * Scales of the deck and of the run that the criteria and the bounds share.
 */
#include "effects/reduction/parts.h"

#include <math.h>

const double reduction_share = 0.1;

double reduction_load_stress(const model *m, const mesh *msh, double young) {
  double most = 0.0;
  for (int i = 0; i < m->n.step; ++i)
    for (int k = 0; k < m->steps[i].loads.n; ++k) {
      const load *l = &m->steps[i].loads.item[k];
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
  if (m->reduction.n == NEGLECT_MAX) return NULL;
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

double reduction_part(double a, double b) {
  return a == 0.0 ? 0.0 : b > 0.0 ? a / b : HUGE_VAL;
}

const material *reduction_material(const reduction *n, int elem_id) {
  const model *m = n->m;
  return &m->materials[m->sections[m->elem_section[elem_id]].material_id];
}

int reduction_is_about(const reduction *n, const omitted *row, int elem_id) {
  return reduction_material(n, elem_id) == &n->m->materials[row->id] &&
         (row->some == 0 || n->m->reduction.still[elem_id]);
}

/* The rule that was left out. */
double reduction_coefficient(const reduction *n, const state *s, int i) {
  const contact_surface *c = s->contacts.surface;
  const friction_rule *rule =
      friction_in_force(n->m, s->step_no - 1, c->contact_id[i]);
  double x[3] = {0.0, 0.0, 0.0};
  if (rule->aside == NULL) return 0.0;
  for (int k = 0; k < c->dim; ++k) x[k] = c->x[c->dim * i + k];
  return quantity_value(&rule->card.value, x, s->t);
}
