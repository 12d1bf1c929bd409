/*
 * The augmented forces F(z), the states of the nodes they stand for, and the
 * residual of (u, F) (auglag.c).
 */
#include "solver/augmented/parts.h"

#include <cblas.h>
#include <math.h>

double auglag_rho(const auglag_run *s, int dof) {
  return s->rho * s->w->diagonal[dof];
}

/* F in the tangent plane of a node. */
static void tangent_force(auglag_run *s, int node_id) {
  const contact_problem *cp = s->cp;
  auglag_work *w = s->w;
  double size = 0.0, g = contact_node_limit(cp, w->F, node_id);
  tangent now = FREE;
  for (int dof = node_id * cp->dim + 1; dof < (node_id + 1) * cp->dim; ++dof)
    if (w->part[dof] == IN_DISC) size += w->z[dof] * w->z[dof];
  size = sqrt(size);
  if (g > 0.0) now = size > g ? SLIP : STICK;
  w->share[node_id] = now == FREE ? 0.0 : now == SLIP ? g / size : 1.0;
  for (int dof = node_id * cp->dim + 1; dof < (node_id + 1) * cp->dim; ++dof) {
    if (w->part[dof] != IN_DISC) continue;
    double e = size > 0.0 ? w->z[dof] / size : 0.0;
    w->F[dof] = w->share[node_id] * w->z[dof];
    if (now == SLIP && e * w->e[dof] < 0.0) ++s->changes;
    w->e[dof] = e;
  }
  s->changes += now != w->mode[node_id];
  s->bent = s->bent || (now == SLIP && cp->dim == 3);
  w->mode[node_id] = (unsigned char)now;
}

void auglag_evaluate(auglag_run *s, const double *base) {
  const contact_problem *cp = s->cp;
  auglag_work *w = s->w;
  s->changes = s->bent = 0;
  for (int dof = 0; dof < cp->m; ++dof) {
    w->F[dof] = 0.0;
    if (w->part[dof] == NO_FORCE) continue;
    w->z[dof] = base[dof] - auglag_rho(s, dof) * (s->u[dof] - w->origin[dof]);
    if (w->part[dof] != PUSH) continue;
    contact_state now = w->z[dof] < 0.0 ? CLOSED : OPEN;
    if (now == CLOSED) w->F[dof] = w->z[dof];
    s->changes += now != w->closed[dof];
    w->closed[dof] = (unsigned char)now;
  }
  for (int i = 0; i < cp->n && cp->g0 != NULL; ++i) tangent_force(s, i);
  if (s->changes > 0 || s->bent) s->factored = 0;
}

int auglag_slips(const auglag_run *s, int dof) {
  return s->w->part[dof] == IN_DISC && s->w->mode[dof / s->cp->dim] == SLIP;
}

int auglag_is_fixed(const auglag_run *s, int dof) {
  if (s->w->part[dof] == PUSH) return s->w->closed[dof] == CLOSED;
  return s->w->part[dof] == IN_DISC && s->w->mode[dof / s->cp->dim] == STICK;
}

double auglag_turning(const auglag_run *s, int a, int b) {
  const auglag_work *w = s->w;
  if (s->cp->dim == 2 || !auglag_slips(s, a) || !auglag_slips(s, b)) return 0.0;
  return w->share[a / s->cp->dim] * ((a == b) - w->e[a] * w->e[b]);
}

void auglag_take_states(auglag_run *s) {
  auglag_work *w = s->w;
  int dim = s->cp->dim;
  s->turned = 0;
  for (int node_id = 0; node_id < s->cp->n; ++node_id) {
    int differs = 0;
    for (int dof = node_id * dim; dof < (node_id + 1) * dim; ++dof) {
      int sign = auglag_slips(s, dof) && w->e[dof] > 0.0;
      unsigned char now =
          (unsigned char)(w->closed[dof] | w->mode[node_id] << 1 | sign << 3);
      differs = differs || now != w->state[dof];
      w->state[dof] = now;
    }
    s->turned += differs;
  }
}

double auglag_judge(auglag_run *s) {
  const contact_problem *cp = s->cp;
  auglag_work *w = s->w;
  double residual = contact_mismatch(cp, s->scale, s->u, w->F, w->y);
  solver_keep_best(&w->best, cp->m, residual, s->u, w->F);
  solver_tell_states(s->control, "auglag", s->steps, residual, s->turned,
                     s->cycle);
  return residual;
}

void auglag_move(auglag_run *s, double a) {
  cblas_daxpy(s->cp->m, a, s->w->du, 1, s->u, 1);
  cblas_daxpy(s->cp->m, a, s->w->dy, 1, s->w->y, 1);
}
