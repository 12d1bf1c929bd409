/*
 * *SOLVER, TOL=BALANCED. The error of the contact solver need not be smaller
 * than a share of those of the mesh and of the increments. Both are measured in
 * the energy norm, while a solver stops at a residual: the ratio of the two is
 * estimated from the bounds at the increments before. If the bound of a
 * solution is above the share, the solver continues from it to a smaller
 * residual. Where the errors of the increments add up, each may take of what
 * is left of the share the part that it has of the time left.
 *
 * An increment starts from the line through the last two equilibria if its
 * residual is lower than the last: with few digits that may be the answer.
 *
 * What was saved is reckoned from the digits of the residual that are missing
 * to the default, and the iterations that a digit took so far; methods that end
 * at once when their active set is found (Newton, pivoting) save a step.
 */
#include "effects/plan/effect.h"
#include "run/history/loop.h"

enum { PASSES = 8 };
static const double FIRST_TOL = 3e-2; /* -, before an error is known */
static const double MOST_TOL = 0.1;   /* - */
static const double SAFETY = 0.7;     /* -, of the share, for another pass */
static const double SHARPEST = 1e-3;  /* -, change of the residual in a pass */

typedef struct balance {
  double mesh, time;      /* -, errors at the last increment; mesh 0: unknown */
  double before;          /* -, bound of the solver of the increments so far */
  double per_residual;    /* -, error of the solver over the residual */
  double per_digit;       /* iterations for a digit of the residual */
  double iterations, cpu; /* all so far; s */
  double t;               /* s, of the equilibrium before r->old */
  /* [m] of that; room */
  double *u, *rc, *guess_u, *guess_r;
  int m, known; /* 1: u, rc are there */
  balance_report report;
} balance;

static int is_balanced(const run *r) {
  return r->step->balanced && r->nodes.n > 0;
}

static status begin_step(run *r, void *self) {
  balance *b = self;
  r->solving.guess_u = r->solving.guess_r = NULL;
  b->known = 0;
  b->report = (balance_report){0};
  if (!is_balanced(r) || b->m == r->nodes.n_c) return OK;
  RELEASE(b->u, b->rc, b->guess_u, b->guess_r);
  *b = (balance){.m = r->nodes.n_c};
  OWNS(b);
  PASS_NEW_REALS(b->m, &b->u, &b->rc, &b->guess_u, &b->guess_r);
  return OK;
}

/* The line through the last two equilibria, at t; without an earlier one in
 * this step none. */
static void guess(run *r, balance *b, double t) {
  double span = r->old.t - b->t, w = (t - r->old.t) / span;
  r->solving.guess_u = r->solving.guess_r = NULL;
  if (!b->known || !(span > 0.0)) return;
  for (int i = 0; i < b->m; ++i) {
    b->guess_u[i] = r->old.uc[i] + w * (r->old.uc[i] - b->u[i]);
    b->guess_r[i] = r->old.rc[i] + w * (r->old.rc[i] - b->rc[i]);
  }
  r->solving.guess_u = b->guess_u;
  r->solving.guess_r = b->guess_r;
}

/* Of the increment that ends at t, after those of the error "before". */
static double wanted_error(const run *r, const balance *b, double before,
                           double t) {
  const step *last = &r->m->steps[r->m->n.step - 1];
  const double whole = r->step->share * (b->mesh + b->time);
  if (!run_inherits(r)) return whole;
  const double left = fmax(0.0, whole - before);
  return left * (t - r->old.t) / (last->start + last->total - r->old.t);
}

static double own_error(const error_bound *e) {
  return e->relative - error_bound_before(e);
}

/* Residual required: the one that gave that error before. */
static double wanted_tolerance(const run *r, const balance *b, double t) {
  double tol = FIRST_TOL;
  if (b->mesh > 0.0 && b->per_residual > 0.0)
    tol = wanted_error(r, b, b->before, t) / b->per_residual;
  return fmin(fmax(tol, r->step->solver.tol), MOST_TOL);
}

/* Errors of r->now: 1 if a lower residual is needed, *tol then. */
static status check_increment(run *r, balance *b, double *tol, int *again) {
  double least = r->step->solver.tol,
         at = fmin(*tol, r->solving.report.residual);
  *again = 0;
  PASS(estimate_evaluate(r));
  if (isfinite(r->errors.mesh_error.relative))
    b->mesh = r->errors.mesh_error.relative;
  const double wanted =
      wanted_error(r, b, error_bound_before(&r->errors.error), r->now.t);
  const double error = own_error(&r->errors.error);
  int unknown = !isfinite(error);
  if (!unknown && error <= wanted) return OK;
  if (*tol <= least || r->solving.report.residual <= least) return OK;
  double factor = unknown ? 0.0 : SAFETY * wanted / error;
  *tol = unknown ? least : fmax(least, at * fmax(factor, SHARPEST));
  *again = 1;
  return OK;
}

static status solve(run *r, void *self, double t, int *made) {
  status st = OK;
  balance *b = self;
  int again = 1, iterations = 0;
  double tol, cpu = timer_cost(STAGE_CONTACT).cpu;
  if (!is_balanced(r)) return OK;
  *made = 1;
  b->report = (balance_report){.asked = 1};
  tol = wanted_tolerance(r, b, t);
  guess(r, b, t);
  for (int k = 1; again && k <= PASSES; ++k) {
    r->solving.tol = k == PASSES ? r->step->solver.tol : tol;
    b->report.passes = k;
    TRY(loop_solve_once(r, t));
    iterations += r->solving.report.iterations;
    if (r->solving.report.outcome <= 0) break;
    TRY(check_increment(r, b, &tol, &again));
    COPY(b->guess_u, r->now.uc, b->m);
    COPY(b->guess_r, r->now.rc, b->m);
    r->solving.guess_u = b->guess_u;
    r->solving.guess_r = b->guess_r;
  }
  r->solving.report.iterations = iterations;
  b->iterations += iterations;
  b->cpu += timer_cost(STAGE_CONTACT).cpu - cpu;
done:
  r->solving.guess_u = r->solving.guess_r = NULL;
  return st;
}

/* ---- what is estimated --------------------------------------------------- */

static int ends_at_once(const solver_report *rep) {
  const char *family = solver_family(rep->solver);
  return strcmp(family, "Newton") == 0 || strcmp(family, "pivoting") == 0 ||
         strcmp(family, "direct") == 0;
}

/* Iterations from the residual reached to the default. */
static double saved_iterations(const run *r, balance *b) {
  const solver_report *rep = &r->solving.report;
  double left = log10(rep->residual / r->step->solver.tol);
  if (!(left > 0.0)) return 0.0;
  if (ends_at_once(rep)) return 1.0;
  double digits = -log10(rep->residual);
  if (rep->iterations > 0 && digits > 0.0)
    b->per_digit = rep->iterations / digits;
  return left * b->per_digit;
}

static void make_report(const run *r, balance *b) {
  balance_report *out = &b->report;
  out->tol = r->solving.tol;
  const error_bound *e = &r->errors.error;
  out->wanted = isfinite(e->relative)
                    ? wanted_error(r, b, error_bound_before(e), r->now.t)
                    : NAN;
  out->saved_iterations = saved_iterations(r, b);
  out->saved_cpu = b->iterations > 0.0
                       ? out->saved_iterations * b->cpu / b->iterations
                       : 0.0;
}

static status learn(run *r, void *self) {
  balance *b = self;
  if (!is_balanced(r)) return OK;
  make_report(r, b);
  if (isfinite(r->errors.mesh_error.relative))
    b->mesh = r->errors.mesh_error.relative;
  b->time =
      r->errors.time_error.asked && isfinite(r->errors.time_error.relative)
          ? r->errors.time_error.relative
          : 0.0;
  const double rate = own_error(&r->errors.error) / r->solving.report.residual;
  if (r->solving.report.residual > 10.0 * r->step->solver.tol && isfinite(rate))
    b->per_residual = rate;
  b->before = r->errors.error.relative;
  b->t = r->old.t;
  b->known = r->now.t > r->old.t;
  COPY(b->u, r->old.uc, b->m);
  COPY(b->rc, r->old.rc, b->m);
  return OK;
}

static status keep(run *r, void *self, archive *a) {
  balance *b = self;
  size_t m = b->m;
  double *learnt[] = {&b->mesh,         &b->time,      &b->before,
                      &b->per_residual, &b->per_digit, &b->iterations,
                      &b->cpu,          &b->t,         &r->solving.tol};
  if (b->m == 0) return OK;
  PASS(archive_ints(a, "known", &b->known, 1));
  for (size_t i = 0; i < sizeof learnt / sizeof *learnt; ++i)
    PASS(archive_reals(a, text_of("learnt%zu", i), learnt[i], 1));
  PASS(archive_reals(a, "u", b->u, m));
  return archive_reals(a, "rc", b->rc, m);
}

static void show(const void *self, state *s) {
  s->errors.balance = ((const balance *)self)->report;
}

static int requires_balance(const model *m, const reason *why) {
  int any = 0;
  for (int i = 0; i < m->n.step; ++i) any |= m->steps[i].balanced;
  return any;
}

/* clang-format off */
const effect_ops balance_effect = {
  .name = "balance", .bit = NO_BIT, .required = requires_balance,
  .own = STAGE_NONE, .size = sizeof(balance),
  .on = {.begin_step = begin_step, .solve = solve, .accept = learn,
         .show = show, .keep = keep}};
/* clang-format on */
