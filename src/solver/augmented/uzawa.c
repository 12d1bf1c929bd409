/*
 * VARIANT=UZAWA: displacement and multiplier in turn (auglag.c).
 */
#include "solver/augmented/parts.h"

#include <lapacke.h>
#include <math.h>
#include <string.h>

static const double RHO_UZAWA = 0x1p4; /* -, of diag A                       */
static const double PROGRESS = 0.9; /* -, of the residual, in PATIENCE steps */
static const double START_TOL = 1e-3; /* -, of pressures for a first limit   */
static const double FLATTER = 0.5; /* -, slope that ends a search           */
static const double SPRING = 0x1p-36; /* -, of the diagonal                  */

enum {
  INNER_STEPS = 60, /* Newton steps of one multiplier step                    */
  PATIENCE = 20     /* multiplier steps without a lower residual              */
};

/* Cholesky factor of power (A + F' rho); springs where nothing holds the body.
 */
static int uzawa_factor(auglag_run *s) {
  const contact_problem *cp = s->cp;
  auglag_work *w = s->w;
  size_t m = (size_t)cp->m;
  for (int attempt = 0; attempt < 2; ++attempt) {
    memcpy(w->K, cp->A, m * m * sizeof *w->K);
    for (int dof = 0; dof < cp->m; ++dof) {
      double *column = w->K + m * (size_t)dof;
      if (auglag_is_fixed(s, dof)) column[dof] += auglag_rho(s, dof);
      if (attempt > 0) column[dof] += SPRING * w->diagonal[dof];
      int end = (dof / cp->dim + 1) * cp->dim;
      for (int b = dof; auglag_slips(s, dof) && b < end; ++b)
        column[b] += auglag_rho(s, dof) * auglag_turning(s, dof, b);
    }
    for (size_t i = 0; i < m * m; ++i) w->K[i] *= w->power;
    s->singular = attempt;
    if (LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'L', cp->m, w->K, cp->m) == 0) {
      s->factored = 1;
      return 1;
    }
  }
  return 0;
}

/* Slope of the augmented Lagrangian along du at the present u, N m. */
static double slope(auglag_run *s) {
  double sum = 0.0;
  auglag_evaluate(s, s->w->lambda);
  for (int i = 0; i < s->cp->m; ++i)
    sum += s->w->du[i] * (s->w->y[i] - s->w->F[i]);
  return sum;
}

/* Move along du to where the slope is small: the whole step, or less. */
static void search(auglag_run *s) {
  double low = 0.0, high = 1.0, at = 1.0, first = slope(s);
  auglag_move(s, 1.0);
  double now = slope(s), low_slope = first, high_slope = now;
  for (int k = 0; k < SHORTENINGS && now > FLATTER * fabs(first); ++k) {
    double next = low + (high - low) * low_slope / (low_slope - high_slope);
    next = fmax(next, low + 0.1 * (high - low));
    next = fmin(next, high - 0.1 * (high - low));
    auglag_move(s, next - at);
    at = next;
    now = slope(s);
    if (now > 0.0) {
      high = at;
      high_slope = now;
    } else {
      low = at;
      low_slope = now;
      if (now >= -FLATTER * fabs(first)) break;
    }
  }
}

/* |lambda - F| and |A u - f - F|, the largest, N. */
static void defects(const auglag_run *s, double *multiplier, double *balance) {
  const auglag_work *w = s->w;
  *multiplier = *balance = 0.0;
  for (int i = 0; i < s->cp->m; ++i) {
    *multiplier = fmax(*multiplier, fabs(w->lambda[i] - w->F[i]));
    *balance = fmax(*balance, fabs(w->y[i] - w->F[i]));
  }
}

/* Minimise over u. */
static outcome minimise(auglag_run *s) {
  const contact_problem *cp = s->cp;
  auglag_work *w = s->w;
  double multiplier, balance;
  auglag_evaluate(s, w->lambda);
  for (int k = 0;; ++k) {
    auglag_take_states(s);
    double residual = auglag_judge(s);
    if (isnan(residual)) return STOPPED_NAN;
    if (residual <= s->control->tol) return CONVERGED;
    if (s->steps >= s->limit) return STOPPED_ITERATIONS;
    defects(s, &multiplier, &balance);
    if (k > 0 && (balance <= 0.01 * multiplier ||
                  balance <= 0.1 * s->control->tol * s->scale))
      return RUNNING;
    if (k >= INNER_STEPS) return s->singular ? STOPPED_RAY : RUNNING;
    ++s->steps;
    if (!s->factored && !uzawa_factor(s)) return STOPPED_SINGULAR;
    for (int i = 0; i < cp->m; ++i) w->du[i] = w->power * (w->F[i] - w->y[i]);
    LAPACKE_dpotrs_work(LAPACK_COL_MAJOR, 'L', cp->m, 1, w->K, cp->m, w->du,
                        cp->m);
    contact_product(cp->m, cp->A, w->du, w->dy);
    search(s);
    contact_reaction(cp, s->u, w->y);
    auglag_evaluate(s, w->lambda);
  }
}

outcome auglag_uzawa(auglag_run *s) {
  auglag_work *w = s->w;
  size_t bytes = (size_t)s->cp->m * sizeof *s->u;
  double mark = HUGE_VAL;
  int since = 0;
  outcome o;
  s->rho = RHO_UZAWA;
  s->cycle = 0;
  s->factored = 0;
  memcpy(w->lambda, s->r, bytes);
  contact_reaction(s->cp, s->u, w->y);
  while ((o = minimise(s)) == RUNNING) {
    memcpy(w->lambda, w->F, bytes);
    ++since;
    if (w->best.residual < PROGRESS * mark) {
      mark = w->best.residual;
      since = 0;
    }
    if (since > PATIENCE) return s->singular ? STOPPED_RAY : STOPPED_STAGNATION;
  }
  return o;
}

void auglag_start_bonded(auglag_run *s) {
  const contact_problem *cp = s->cp;
  contact_problem bonded = *cp;
  for (int i = 0; i < cp->n; ++i) {
    if (contact_node_limit(cp, s->r, i) > 0.0) return;
    s->w->bonded[i] = HUGE_VAL;
  }
  bonded.B = NULL;
  bonded.g0 = s->w->bonded;
  auglag_run start = *s;
  solver_control coarse = *s->control;
  coarse.tol = fmax(coarse.tol, START_TOL);
  start.cp = &bonded;
  start.control = &coarse;
  s->w->best.residual = HUGE_VAL;
  auglag_uzawa(&start);
  s->steps = start.steps;
  solver_take_best(&s->w->best, cp->m, s->u, s->r);
}
