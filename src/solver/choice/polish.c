/* Final correction of a solution (polish.h). */
#include "solver/choice/choice.h"

#include "base/memory.h"
#include "solver/local.h"

#include <math.h>
#include <string.h>

enum { SWEEPS = 20 };

/* Stiffness in the tangent plane, N/m, and what turns a force into the unit of
 * the scale: 1, or m/N where the compliance is given. */
static double tangent_stiffness(const contact_problem *cp, int node_id,
                                double *unit) {
  double sum = 0.0;
  for (int k = 1; k < cp->dim; ++k)
    sum += contact_diagonal(cp, node_id * cp->dim + k) / (cp->dim - 1);
  *unit = contact_has_stiffness(cp) ? 1.0 : sum;
  return contact_has_stiffness(cp) ? sum : sum > 0.0 ? 1.0 / sum : 0.0;
}

/* Of one node, N. */
static double misdirection(const contact_problem *cp, const double *u,
                           const double *r, int node_id, double c) {
  double s[2], slip = 0.0, force = 0.0, apart = 0.0;
  int first = node_id * 3 + 1;
  for (int k = 0; k < 2; ++k) {
    if (contact_held(cp, first + k)) return 0.0;
    s[k] = u[first + k] - contact_stick(cp, first + k);
    slip = hypot(slip, s[k]);
    force = hypot(force, r[first + k]);
  }
  if (!(slip > 0.0)) return 0.0;
  for (int k = 0; k < 2; ++k)
    apart = hypot(apart, r[first + k] + force * (s[k] / slip));
  return fmin(c * slip, apart);
}

double slip_misdirection(const contact_problem *cp, const double *u,
                         const double *r) {
  double worst = 0.0;
  if (cp->dim != 3 || cp->g0 == NULL) return 0.0;
  for (int i = 0; i < cp->n; ++i) {
    double unit, c = tangent_stiffness(cp, i, &unit);
    worst = fmax(worst, unit * misdirection(cp, u, r, i, c));
  }
  double scale = worst > 0.0 ? contact_scale(cp) : 0.0;
  return scale > 0.0 ? worst / scale : 0.0;
}

/* Distance of an unknown to its bound at the obstacle, m; 0: it is not
 * pressed. */
static double distance_to_bound(const contact_problem *cp, const double *u,
                                const double *r, int dof) {
  double own = contact_diagonal(cp, dof);
  double c = contact_has_stiffness(cp) ? own : 1.0 / own,
         bound = contact_bound(cp, dof);
  if (bound == HUGE_VAL || !(own > 0.0)) return 0.0;
  return r[dof] - c * (u[dof] - bound) < 0.0 ? bound - u[dof] : 0.0;
}

/* The same of a sticking node, move[dim], without the normal. */
static void distances_to_stick(const contact_problem *cp, const double *u,
                               const double *r, int node_id, double *move) {
  double unit, c = tangent_stiffness(cp, node_id, &unit), size = 0.0;
  int first = node_id * cp->dim;
  if (cp->g0 == NULL || contact_has_side(cp, node_id)) return;
  for (int k = 1; k < cp->dim; ++k) {
    move[k] = contact_stick(cp, first + k) - u[first + k];
    if (contact_held(cp, first + k)) move[k] = 0.0;
    size = hypot(size, r[first + k] + c * move[k]);
  }
  if (size < contact_node_limit(cp, r, node_id)) return;
  for (int k = 1; k < cp->dim; ++k) move[k] = 0.0;
}

/* v = u on the bounds, s = r with the corresponding forces. */
static int touch(const contact_problem *cp, const double *u, const double *r,
                 double *v, double *s, double *move) {
  int changed = 0;
  for (int i = 0; i < cp->n; ++i) {
    double *own = move + i * cp->dim;
    for (int k = 0; k < cp->dim; ++k)
      own[k] = distance_to_bound(cp, u, r, i * cp->dim + k);
    distances_to_stick(cp, u, r, i, own);
  }
  for (int i = 0; i < cp->m; ++i) changed |= move[i] != 0.0;
  if (!changed) return 0;
  memcpy(s, r, (size_t)cp->m * sizeof *s);
  if (contact_has_stiffness(cp)) contact_apply(cp, move, v);
  for (int i = 0; i < cp->m; ++i) {
    if (contact_has_stiffness(cp) && move[i] != 0.0) s[i] += v[i];
    v[i] = u[i] + move[i];
  }
  return 1;
}

status polish_touch(const contact_problem *cp, double scale, double tol,
                    double *u, double *r, double *residual) {
  size_t bytes = (size_t)cp->m * sizeof *u;
  OWNED double *v = NULL, *s = NULL, *move = NULL;
  PASS_NEW_ALL(OF(v, cp->m), OF(s, cp->m), OF(move, cp->m));
  if (!touch(cp, u, r, v, s, move)) return OK;
  double reached = contact_residual_at(cp, scale, v, s);
  if (!(reached <= tol)) return OK;
  *residual = reached;
  memcpy(u, v, bytes);
  memcpy(r, s, bytes);
  return OK;
}

status polish_slip(const contact_problem *cp, double tol, int most, double *u,
                   double *r, int *sweeps) {
  status st = OK;
  relaxation s = {.cp = cp, .omega = 1.0};
  size_t bytes = (size_t)cp->m * sizeof *u;
  double least = slip_misdirection(cp, u, r);
  *sweeps = 0;
  if (!(least > tol) || most <= 0 || cp->op != NULL) goto done;
  NEW_ALL(OF(s.u, cp->m), OF(s.r, cp->m));
  TRY(node_blocks_new(cp, &s.blocks));
  memcpy(s.u, u, bytes);
  memcpy(s.r, r, bytes);
  relaxation_start(&s);
  relaxation_refresh(&s);
  while (least > tol && *sweeps < SWEEPS && *sweeps < most) {
    relaxation_sweep(&s, 0);
    relaxation_refresh(&s);
    ++*sweeps;
    double now = slip_misdirection(cp, s.u, s.r);
    if (!(now < least) || !(contact_residual(cp, s.u, s.r) <= tol)) continue;
    least = now;
    memcpy(u, s.u, bytes);
    memcpy(r, s.r, bytes);
  }
done:
  node_blocks_free(s.blocks);
  RELEASE(s.u, s.r);
  return st;
}
