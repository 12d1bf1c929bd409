/*
 * *REFERENCE: components to their places.
 */
#include "model/check/parts.h"

#include "model/cards/cards.h"

static void check_whole(const model *m, const char *what, int n, int all) {
  if (n > 0 && n < all)
    message_add(m->log, P2056, &m->ref.at,
                "*REFERENCE: %d of %d components of the %s", n, all, what);
}

void check_reference(model *m) {
  closed_form *ref = &m->ref;
  int axi = m->n_section > 0 && m->sections[0].kin == AXISYMMETRIC;
  int n_u = 0, n_stress = 0;
  for (int i = 0; i < ref->n; ++i) {
    const reference_line *l = &ref->line[i];
    int at = reference_place(l->name, m->dim, axi);
    if (at < 0) {
      message_add(m->log, P2024, &l->at, "*REFERENCE: %s has no %s",
                  m->dim == 3 ? "a body in 3-D"
                  : axi       ? "an axisymmetric body"
                              : "a plane body",
                  l->name);
      continue;
    }
    ref->value[at] = l->value;
    n_u += at < REFERENCE_STRESS;
    n_stress += at >= REFERENCE_STRESS && at < REFERENCE_PRESSURE;
    ref->has_pressure |= at == REFERENCE_PRESSURE;
  }
  check_whole(m, "displacement", n_u, m->dim);
  check_whole(m, "stress", n_stress, m->ns);
  ref->has_u = n_u > 0;
  ref->has_stress = n_stress > 0;
}
