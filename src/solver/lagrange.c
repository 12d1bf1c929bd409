/*
 * Lagrangian method for contact with a given sliding limit (CPR98, 3.3; Uzawa
 * 1958; Glowinski, Lions, Tremolieres 1976): the forces of contact are the
 * multipliers of the conditions on u, found by steps of gradient projection,
 *
 *   A u_k = f + y_k,
 *   r_k+1 = P(y_k - rho D (u_k - o)),
 *   y_k+1 = r_k+1 + theta_k (r_k+1 - r_k),
 *
 * P the projection on r_n <= 0, |r_t| <= g, o the gap and the stick position, D
 * the inverse diagonal of W = inv(A). theta = 0 is Uzawa's method; with
 * Nesterov's theta_k (1983), begun again when a step turns against the gradient
 * (O'Donoghue, Candes 2015), the number of steps grows with the square root of
 * the condition of D W only. u is carried by the combination of r, so a step is
 * one product with W.
 *
 * The step rho is 1/largest eigenvalue of D W. The power method gives it a
 * little too large; every step checks what descent needs,
 *
 *   (r - y)'W (r - y) <= (r - y)'inv(D) (r - y)/rho,
 *
 * and shortens rho, never below the bound of Collatz and Wielandt.
 */
#include "contact/force_set.h"
#include "solver/solver.h"

typedef struct lagrange {
  int acceleration; /* acceleration_kind */
} lagrange;

typedef enum { BY_NESTEROV, BY_NOTHING } acceleration_kind;

OPTIONS(lagrange_options,
        OPTION_CHOICE(lagrange, acceleration, "ACCELERATION", "NESTEROV|NONE",
                      "NESTEROV",
                      "extrapolation of the forces between the steps"));

enum {
  STEPS = 100000, /* default limit */
  PATIENCE = 2000 /* steps without a lower residual */
};
static const double ROUNDING = 0x1p-30; /* -, of |r|^2: below is rounding */
static const double LONGER = 0.98;      /* share of the eigenvalue seen */

typedef struct lagrange_work {
  force_set *set;
  double step;       /* -, rho of the next problem */
  double *x, *old_x; /* [m] u - o at r, and at the r before */
  double *y, *y_x;   /* [m] N; u - o there. After the step y is r - y */
  double *c;         /* [m] x = W r + c, m */
  double *old_r;     /* [m] N */
  best_iterate best;
} lagrange_work;

static status lagrange_setup(const contact_problem *cp, const void *par,
                             void *work) {
  lagrange_work *w = work;
  PASS(force_set_new(cp, &w->set));
  PASS_NEW_REALS(cp->m, &w->x, &w->old_x, &w->y, &w->y_x, &w->c, &w->old_r);
  PASS(best_iterate_new(cp->m, &w->best));
  PASS(force_set_fit(w->set, cp));
  const double largest = force_set_spectrum(w->set, w->y, w->y_x);
  w->step = fmax(w->set->step, largest > 0.0 ? LONGER / largest : 0.0);
  return OK;
}

typedef struct run {
  const contact_problem *cp;
  lagrange_work *w;
  const solver_control *control;
  double *u, *r;
  double scale, mark; /* residual at the last progress */
  double t;           /* of Nesterov's sequence, - */
  int accelerated, since;
} run;

/* u and x again from r, as exactly as A allows; c = u - o - W r. */
static void refresh(run *s) {
  lagrange_work *w = s->w;
  force_set_displacement(w->set, s->r, s->u);
  force_set_product(w->set, s->r, w->c);
  for (int i = 0; i < s->cp->m; ++i) {
    w->x[i] = s->u[i] - w->set->origin[i];
    w->c[i] = w->x[i] - w->c[i];
  }
}

/* Residual at (r, x), reported and checked; RUNNING: continue. */
static outcome check(run *s, int k) {
  const contact_problem *cp = s->cp;
  for (int i = 0; i < cp->m; ++i) s->u[i] = s->w->x[i] + s->w->set->origin[i];
  double residual = contact_mismatch(cp, s->scale, s->u, s->r, NULL);
  if (residual <= s->control->tol) {
    refresh(s);
    residual = contact_mismatch(cp, s->scale, s->u, s->r, NULL);
  }
  solver_keep_best(&s->w->best, cp->m, residual, s->u, s->r);
  solver_report_step(s->control, "lagrange", k, residual);
  if (isnan(residual)) return STOPPED_NAN;
  if (residual <= s->control->tol) return CONVERGED;
  if (solver_progresses(&s->mark, residual)) s->since = k;
  return k - s->since > PATIENCE ? STOPPED_STAGNATION : RUNNING;
}

/* r and x after a step of gradient projection from y; 0: the step was too long
 * and is now shorter. */
static int project_step(run *s) {
  lagrange_work *w = s->w;
  const force_set *set = w->set;
  double energy = 0.0, metric = 0.0, size = 0.0;
  for (int i = 0; i < s->cp->m; ++i)
    s->r[i] = w->y[i] - w->step * set->D[i] * w->y_x[i];
  force_set_project(set, 0.0, s->r);
  force_set_product(set, s->r, w->x);
  for (int i = 0; i < s->cp->m; ++i) {
    w->x[i] += w->c[i];
    w->y[i] = s->r[i] - w->y[i];
    energy += w->y[i] * (w->x[i] - w->y_x[i]);
    metric += w->y[i] * w->y[i] / set->D[i];
    size += s->r[i] * s->r[i] / set->D[i];
  }
  if (w->step <= set->step || energy * w->step <= metric) return 1;
  if (metric <= ROUNDING * size) return 1;
  w->step = fmax(set->step, fmin(LONGER * metric / energy, 0.9 * w->step));
  return 0;
}

/* 1: the step leads against the move from the r before. */
static int turns(const run *s) {
  const lagrange_work *w = s->w;
  double sum = 0.0;
  for (int i = 0; i < s->cp->m; ++i)
    sum += w->y[i] * (s->r[i] - w->old_r[i]) / w->set->D[i];
  return sum < 0.0;
}

static outcome steps(run *s, solver_report *rep) {
  lagrange_work *w = s->w;
  int limit = s->control->max_iter > 0 ? s->control->max_iter : STEPS;
  double theta = 0.0;
  force_set_project(w->set, 0.0, s->r);
  refresh(s);
  outcome o = check(s, 0);
  for (int k = 1; k <= limit && o == RUNNING; ++k) {
    rep->iterations = k;
    /* y and its displacement; theta = 0 begins again. */
    for (int i = 0; i < s->cp->m; ++i) {
      w->y[i] = s->r[i] + theta * (s->r[i] - w->old_r[i]);
      w->y_x[i] = w->x[i] + theta * (w->x[i] - w->old_x[i]);
    }
    COPY(w->old_r, s->r, s->cp->m);
    COPY(w->old_x, w->x, s->cp->m);
    if (!project_step(s)) {
      COPY(s->r, w->old_r, s->cp->m);
      COPY(w->x, w->old_x, s->cp->m);
      s->t = 1.0;
      theta = 0.0;
      continue;
    }
    o = check(s, k);
    if (turns(s) || !s->accelerated) s->t = 1.0;
    double next = 0.5 * (1.0 + sqrt(1.0 + 4.0 * s->t * s->t));
    theta = (s->t - 1.0) / next;
    s->t = next;
  }
  return o == RUNNING ? STOPPED_ITERATIONS : o;
}

static status lagrange_solve(const contact_problem *cp, const void *par,
                             void *work, const solver_control *control,
                             double *u, double *r, solver_report *rep) {
  const lagrange *p = par;
  lagrange_work *w = work;
  run s = {.cp = cp,
           .w = w,
           .control = control,
           .u = u,
           .r = r,
           .scale = contact_scale(cp),
           .mark = HUGE_VAL,
           .t = 1.0,
           .accelerated = p->acceleration == BY_NESTEROV};
  *rep = (solver_report){.outcome = RUNNING};
  w->best.residual = HUGE_VAL;
  PASS(force_set_fit(w->set, cp));
  rep->outcome = steps(&s, rep);
  rep->residual = solver_take_best(&w->best, cp->m, u, r);
  return OK;
}

static status lagrange_keep(void *work, archive *a) {
  return archive_reals(a, "step", &((lagrange_work *)work)->step, 1);
}

const solver_ops lagrange_solver = {
    SOLVER_OF(lagrange), .family = "multipliers",
    .handles = SOLVES_TRESCA | SOLVES_3D | NEEDS_COMPLIANCE,
    .keep = lagrange_keep};
