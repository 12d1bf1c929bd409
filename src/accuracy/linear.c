/* The contact linearised at a state (accuracy.h). */
#include "accuracy/accuracy.h"

int accuracy_rubs(const contact_problem *cp, int dof) {
  int node_id = dof / cp->dim;
  if (cp->g0 == NULL || dof % cp->dim == 0 || contact_held(cp, dof)) return 0;
  return !contact_has_side(cp, node_id);
}

node_stiffness accuracy_stiffness(const contact_problem *cp, int node_id) {
  const double n = contact_diagonal(cp, node_id * cp->dim);
  const double t = contact_tangent_diagonal(cp, node_id, n);
  if (contact_has_stiffness(cp)) return (node_stiffness){n, t};
  return (node_stiffness){1.0 / n, 1.0 / t};
}

/* Friction of node i, which slides: e, kappa. */
static void set_friction(linear_states *s, const double *u, const double *r,
                         int i) {
  const contact_problem *cp = s->cp;
  const int first = i * cp->dim;
  const double g = contact_node_limit(cp, r, i);
  const double c = accuracy_stiffness(cp, i).t;
  double size = 0.0;
  for (int dof = first + 1; dof < first + cp->dim; ++dof) {
    if (!accuracy_rubs(cp, dof)) continue;
    s->e[dof] = r[dof] - c * (u[dof] - contact_stick(cp, dof));
    size = hypot(size, s->e[dof]);
  }
  for (int dof = first + 1; dof < first + cp->dim; ++dof) s->e[dof] /= size;
  s->kappa[i] = size - g > 0x1p-20 * g ? c * g / (size - g) : 0x1p20 * c;
  s->slip[i] = 1;
  ++s->n_slip;
}

status linear_states_new(const contact_problem *cp, const double *u,
                         const double *r, int rests, linear_states *out) {
  linear_states *s = out;
  s->cp = cp;
  OWNED_NEW(unsigned char, stopped, cp->m);
  OWNED_NEW(double, force, cp->m);
  PASS_NEW_ALL(OF(s->free_id, cp->m), OF(s->place, cp->m), OF(s->closed, cp->n),
               OF(s->slip, cp->n), OF(s->e, cp->m), OF(s->kappa, cp->n));
  contact_stops(cp, u, r, rests, force, stopped);
  for (int dof = 0; dof < cp->m; ++dof) {
    const int i = dof / cp->dim;
    const int moves = !stopped[dof] && !contact_held(cp, dof);
    s->place[dof] = moves ? s->n_free : -1;
    if (moves) s->free_id[s->n_free++] = dof;
    if (moves && accuracy_rubs(cp, dof) && !s->slip[i] &&
        contact_node_limit(cp, force, i) > 0.0)
      set_friction(s, u, force, i);
    if (dof % cp->dim > 0) continue;
    s->closed[i] = !moves;
    s->n_closed += !moves;
  }
  if (cp->op != NULL)
    PASS_NEW_ALL(OF(s->known, cp->m), OF(s->added, cp->dim * cp->m));
  return OK;
}

static const double NO_PIVOT = 0x1p-44; /* -, of the diagonal */

int linear_is_regular(const linear_states *s, const double *factor,
                      int cholesky) {
  for (int k = 0; k < s->n_free; ++k) {
    const double pivot = fabs(factor[k * ((size_t)s->n_free + 1)]);
    if (!(pivot * (cholesky ? pivot : 1.0) >
          NO_PIVOT * contact_diagonal(s->cp, s->free_id[k])))
      return 0;
  }
  return 1;
}

double linear_turn(const linear_states *s, int a, int b) {
  return s->kappa[a / s->cp->dim] * ((a == b) - s->e[a] * s->e[b]);
}

status linear_set_rows(const linear_states *s, int *singular) {
  const contact_problem *cp = s->cp;
  const known_rows rows = {s->known, s->added};
  for (int k = 0; k < cp->m; ++k) s->known[k] = s->place[k] < 0;
  for (int t = 0; cp->dim == 3 && t < cp->m; ++t)
    for (int b = 1; t % 3 > 0 && s->slip[t / 3] && b < 3; ++b)
      s->added[3 * t + b] = linear_turn(s, t, t - t % 3 + b);
  return cp->op->set_rows(cp->op->ctx, &rows, singular);
}
