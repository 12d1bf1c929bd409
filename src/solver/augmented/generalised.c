/*
 * VARIANT=NEWTON: the generalised Newton method for both equations at once
 * (auglag.c).
 */
#include "solver/augmented/parts.h"

#include <lapacke.h>
#include <math.h>
#include <string.h>

static const double RHO_NEWTON = 0x1p-2; /* -, of diag A                     */
static const double DESCENT = 1e-4; /* -, share of the slope                 */
enum { MEMORY = 4 /* steps |Phi| is compared with */ };

/* Row of (A - F'(A - rho)) d of a free unknown; v = A d, d[m]. */
static double newton_row(const auglag_run *s, int row, const double *v,
                         const double *d) {
  const contact_problem *cp = s->cp;
  const auglag_work *w = s->w;
  int node_id = row / cp->dim, first = node_id * cp->dim;
  double value = v[row];
  if (!auglag_slips(s, row)) return value;
  for (int b = first + 1; b < first + cp->dim; ++b)
    value -= auglag_turning(s, row, b) * (v[b] - auglag_rho(s, b) * d[b]);
  if (cp->B == NULL) return value;
  for (int k = cp->B->start[node_id]; k < cp->B->start[node_id + 1]; ++k) {
    int n = cp->B->col[k] * cp->dim;
    if (w->closed[n] == CLOSED)
      value += w->e[row] * cp->B->val[k] * (v[n] - auglag_rho(s, n) * d[n]);
  }
  return value;
}

/* What the states fix goes into du, the rest is listed; returns how many. */
static int known_steps(auglag_run *s) {
  auglag_work *w = s->w;
  int n = 0;
  for (int dof = 0; dof < s->cp->m; ++dof) {
    w->du[dof] = 0.0;
    if (auglag_is_fixed(s, dof))
      w->du[dof] = (w->F[dof] - w->y[dof]) / auglag_rho(s, dof);
    else
      w->free_id[n++] = dof;
  }
  return n;
}

/* Rows and columns of the n free unknowns, times power; returns the number of
 * rows that slip. */
static int newton_matrix(auglag_run *s, int n) {
  const contact_problem *cp = s->cp;
  auglag_work *w = s->w;
  double *unit = w->z;
  int slipping = 0;
  memset(unit, 0, (size_t)cp->m * sizeof *unit);
  for (int j = 0; j < n; ++j) {
    const double *column = cp->A + (size_t)cp->m * (size_t)w->free_id[j];
    double *to = w->K + (size_t)n * (size_t)j;
    for (int i = 0; i < n; ++i) to[i] = w->power * column[w->free_id[i]];
    slipping += auglag_slips(s, w->free_id[j]);
  }
  for (int j = 0; j < n && slipping > 0; ++j) {
    int dof = w->free_id[j];
    const double *column = cp->A + (size_t)cp->m * (size_t)dof;
    unit[dof] = 1.0;
    for (int i = 0; i < n; ++i)
      if (auglag_slips(s, w->free_id[i]))
        w->K[(size_t)i + (size_t)n * (size_t)j] =
            w->power * newton_row(s, w->free_id[i], column, unit);
    unit[dof] = 0.0;
  }
  return slipping;
}

/* du of a Newton step; 0: the matrix is singular. */
static int newton_direction(auglag_run *s) {
  const contact_problem *cp = s->cp;
  auglag_work *w = s->w;
  int n = known_steps(s), info = 0;
  contact_product(cp->m, cp->A, w->du, w->dy);
  for (int i = 0; i < n; ++i) {
    int dof = w->free_id[i];
    w->lambda[i] =
        w->power * (w->F[dof] - w->y[dof] - newton_row(s, dof, w->dy, w->du));
  }
  if (n > 0 && newton_matrix(s, n) > 0)
    info = LAPACKE_dgesv_work(LAPACK_COL_MAJOR, n, 1, w->K, n, w->pivot,
                              w->lambda, n);
  else if (n > 0)
    info =
        LAPACKE_dposv_work(LAPACK_COL_MAJOR, 'L', n, 1, w->K, n, w->lambda, n);
  if (info != 0) return 0;
  for (int i = 0; i < n; ++i) w->du[w->free_id[i]] = w->lambda[i];
  contact_product(cp->m, cp->A, w->du, w->dy);
  return 1;
}

/* |Phi|^2 in the metric of the diagonal, N m. */
static double merit(const auglag_run *s) {
  const auglag_work *w = s->w;
  double sum = 0.0;
  for (int i = 0; i < s->cp->m; ++i) {
    double d = w->y[i] - w->F[i];
    if (d != 0.0) sum += d * d / w->diagonal[i];
  }
  return sum;
}

/* Shorten the step until |Phi| is below the largest of the last ones. */
static double shorten(auglag_run *s, double reference) {
  double a = 1.0, now;
  auglag_move(s, 1.0);
  auglag_evaluate(s, s->w->y);
  now = merit(s);
  for (int k = 0; k < SHORTENINGS; ++k) {
    if (now <= (1.0 - DESCENT * a) * reference) break;
    auglag_move(s, -0.5 * a);
    a *= 0.5;
    auglag_evaluate(s, s->w->y);
    now = merit(s);
  }
  return now;
}

/* 1: the states after step k are others than before it, and were met. FNV-1a.
 */
static int met_before(const auglag_run *s, int k) {
  auglag_work *w = s->w;
  uint64_t h = 1469598103934665603u;
  int met = 0;
  for (int i = 0; i < s->cp->m; ++i) h = (h ^ w->state[i]) * 1099511628211u;
  for (int j = 0; j + 1 < k; ++j) met = met || w->seen[j] == h;
  w->seen[k] = h;
  return met && s->turned > 0;
}

outcome auglag_newton(auglag_run *s) {
  auglag_work *w = s->w;
  int met = 0;
  double past[MEMORY], residual;
  s->rho = RHO_NEWTON;
  contact_reaction(s->cp, s->u, w->y);
  auglag_evaluate(s, w->y);
  for (int k = 0; k < MEMORY; ++k) past[k] = merit(s);
  for (int k = 0;; ++k) {
    auglag_take_states(s);
    s->cycle = met_before(s, k);
    met += s->cycle;
    residual = auglag_judge(s);
    if (isnan(residual)) return STOPPED_NAN;
    if (residual <= s->control->tol) return CONVERGED;
    if (s->steps >= s->limit) return STOPPED_ITERATIONS;
    if (k == NEWTON_STEPS)
      return 2 * met > k ? STOPPED_CYCLE : STOPPED_ITERATIONS;
    ++s->steps;
    if (!newton_direction(s)) return STOPPED_SINGULAR;
    double reference = past[0];
    for (int i = 1; i < MEMORY; ++i) reference = fmax(reference, past[i]);
    past[k % MEMORY] = shorten(s, reference);
    contact_reaction(s->cp, s->u, w->y);
    auglag_evaluate(s, w->y);
  }
}
