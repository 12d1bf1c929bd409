/*
 * METHOD=AUTO. The choice depends on quantities without unit: whether there is
 * friction, which form is given, whether it can be inverted, the dimension and
 * the number of unknowns m.
 *
 * No friction: the tangential unknowns are eliminated and the normal ones are
 * solved for by active sets, of the opening nodes only, and by
 * NEWTON where these do not converge. The full problem is taken for the first
 * steps from a warm start, which often suffice, and where the normal form
 * fails.
 *
 * Stiffness given: NEWTON. The number of its steps does not grow with m or with
 * the condition of A, and its factor is reused from step to step and from
 * problem to problem. Then NEWTON along a friction path, for large mu; then
 * SOR, which needs no factor; LEMKE; PROXIMAL last, for a stiffness that is
 * nearly singular under large mu. In 3-D with a loose tolerance (TOL=BALANCED)
 * sweeps of SOR first, as many as cost less than some steps of NEWTON.
 *
 * Compliance given: in 3-D first sweeps of SOR, while their rate predicts the
 * solution at less cost than the steps of NEWTON. Then the same, with NEWTON
 * for the forces, if the compliance is regular; sweeps again, PCG, PROXIMAL,
 * LAGRANGE, SOR and LEMKE work on a singular one. Of rigid bodies PCG solves
 * many in some hundred iterations, the others rarely: then PROXIMAL, in some
 * ten to a thousand steps, and PCG without the short limit.
 *
 * After the first each method of the chain starts cold, on the same problem,
 * with a limit of iterations that bounds its cost (allowance).
 */
#include "solver/choice/choice.h"

#include "base/option.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* clang-format off */
const char auto_help[] =
  "Chooses a method by the problem and falls back to others on the same\n"
  "problem. Without friction the tangential unknowns are eliminated and\n"
  "NEWTON solves in the normal ones. With friction, and the stiffness known\n"
  "(every deck with a mesh), it is NEWTON, then NEWTON along a friction path\n"
  "(the coefficient grows to its value, each solution the start of the\n"
  "next), then SOR, then LEMKE, then PROXIMAL; in 3-D with TOL above 1e-4\n"
  "sweeps of SOR go first. Of a problem that comes as a compliance\n"
  "(*CONDENSED PROBLEM) such sweeps go first in 3-D, while their rate\n"
  "predicts the solution at less cost than NEWTON; then the same chain with\n"
  "such sweeps, PCG, PROXIMAL, PCG with more iterations and LAGRANGE before\n"
  "SOR, for compliances that are singular. The first starts from the last\n"
  "increment, the others cold; each has a limit of iterations that bounds\n"
  "its cost, or MAX_ITER if that is less. A result is accepted only by the\n"
  "residual of the given problem; the listing says which methods were tried,\n"
  "why each stopped and which converged. It has no options. Choose another\n"
  "method to compare, or where one is known to be faster.";
/* clang-format on */

enum {
  WARM_STEPS = 3,      /* of NEWTON before the normal form is made */
  ROUND = 10,          /* sweeps from one check of their rate to the next */
  SWEEP_SHARE = 4,     /* m over it: sweeps that cost less than an inverse */
  STEPS = 6,           /* of NEWTON, compared with the cost of sweeps */
  LEAST_ROUNDS = 3,    /* least number for a trial */
  READ = 8,            /* solves whose arithmetic takes the time of reading the
                          matrix */
  FULL_SIZE = 1000,    /* m: up to here a method has all its iterations */
  SMALL_SIZE = 200,    /* m: up to here factorisations cost like products */
  LEAST_FACTORS = 80,  /* iterations with a factorisation, on large problems */
  MOST_FACTORS = 4000, /* on small ones */
  LEAST_SWEEPS = 1000, /* iterations with a product */
  MOST_SWEEPS = 20000
};

/* The order of the methods, their loops, and where they apply. */
static const struct {
  const solver_ops *ops;
  drive how;
  int compliance; /* 1: only where no stiffness is given, -1: where one is */
  int factors;    /* 1: an iteration costs a factorisation, else a product */
  int most;       /* iterations, 0: as many as the cost allows */
} auto_chain[] = {{&newton_solver, PLAIN, 0, 1, 0},
                  {&newton_solver, ALONG_PATH, 0, 1, 0},
                  {&sor_solver, WHILE_PROMISING, 1, 0, 0},
                  {&pcg_solver, PLAIN, 1, 0, 1000},
                  {&proximal_solver, PLAIN, 1, 1, 0},
                  {&pcg_solver, PLAIN, 1, 0, 0},
                  {&lagrange_solver, PLAIN, 1, 0, 0},
                  {&sor_solver, PLAIN, 0, 0, 0},
                  {&lemke_solver, PLAIN, 0, 0, 0},
                  {&proximal_solver, PLAIN, -1, 1, 0}};

/* Limit of the iterations of a method: such that its cost is at most that of a
 * problem with FULL_SIZE unknowns, but at least LEAST. For a body held by
 * contact alone the last method is limited, as there may be no solution. */
static int allowance(const contact_solver *s, const contact_problem *cp,
                     int i) {
  double size = fmax(1.0, (double)cp->m / FULL_SIZE);
  int factors = auto_chain[i].factors;
  int promising = auto_chain[i].how == WHILE_PROMISING;
  double most = factors ? MOST_FACTORS / (size * size * size)
                        : MOST_SWEEPS / (size * size);
  int own = (int)fmax(most, factors ? LEAST_FACTORS : LEAST_SWEEPS);
  int asked = s->choice.max_iter, limit = auto_chain[i].most;
  if (auto_chain[i].compliance < 0 && cp->floating) {
    size = fmax(1.0, (double)cp->m / SMALL_SIZE);
    own = (int)fmax(MOST_SWEEPS / (size * size * size), LEAST_FACTORS);
  }
  if (limit > 0 && limit < own) own = limit;
  if (promising) own = cp->m / SWEEP_SHARE;
  return asked > 0 && asked < own ? asked : own;
}

/* Append to the log how an attempt ended. */
static void note(contact_solver *s, const solver_report *rep,
                 const attempt *a) {
  size_t used = strlen(s->log);
  int cut = rep->outcome == STOPPED_ITERATIONS && a->max_iter > 0;
  if (rep->outcome == STOPPED_UNFIT) return; /* attempt_run did */
  snprintf(s->log + used, LOG_SIZE - used, "%s%s%s: %s", used > 0 ? ", " : "",
           rep->solver, a->how == ALONG_PATH ? " along a friction path" : "",
           outcome_text(rep->outcome));
  used = strlen(s->log);
  if (cut)
    snprintf(s->log + used, LOG_SIZE - used, " (%d of %d allowed)",
             rep->iterations, a->max_iter);
}

/* Significance of a failure; a singular compliance has none, a method that does
 * not apply less. */
static int weight(const contact_problem *cp, outcome o) {
  if (o == STOPPED_UNFIT) return -1;
  return o == STOPPED_SINGULAR && cp->A != NULL;
}

/* The more significant of two failures: singular, then the lower residual. */
static int says_more(const contact_problem *cp, const solver_report *a,
                     const solver_report *b) {
  int ra = weight(cp, a->outcome), rb = weight(cp, b->outcome);
  if (ra != rb) return ra > rb;
  return !(a->residual >= b->residual);
}

/* 1: sweeps may be fast. */
static int sweeps_fit(const contact_problem *cp) {
  return cp->A == NULL && cp->dim == 3 && cp->B != NULL;
}

/* 1 if a method of the chain does not apply: a friction path without Coulomb
 * friction, a method for problems of which only the compliance is known. */
static int is_skipped(const contact_problem *cp, int i) {
  if (auto_chain[i].how == ALONG_PATH && cp->B == NULL) return 1;
  if (auto_chain[i].how == WHILE_PROMISING && !sweeps_fit(cp)) return 1;
  if (auto_chain[i].compliance < 0) return cp->A == NULL;
  return auto_chain[i].compliance && cp->A != NULL;
}

/* 1 if no other method is needed: a solution or a proof. */
static int is_final(outcome o) { return o == CONVERGED || o == STOPPED_RAY; }

/* Start and end of an attempt: u[m], r[m], and its report. */
typedef struct answer {
  double *u, *r;
  solver_report *rep;
} answer;

/* An attempt of few iterations, which need not succeed. */
static status short_try(contact_solver *s, const contact_problem *cp,
                        const solver_ops *ops, int iterations,
                        const solver_listener *listener, const answer *to) {
  status st = OK;
  int asked = s->choice.max_iter;
  attempt a = {ops, s->param, PLAIN,
               asked > 0 && asked < iterations ? asked : iterations};
  memset(s->param, 0, s->param_size);
  option_defaults(ops->options, s->param);
  TRY(attempt_run(s, cp, &a, listener, to->u, to->r, to->rep));
  attempt_check(s, cp, to->u, to->r, to->rep);
done:
  return st;
}

/* Sweeps at the cost of NEWTON for the forces of the nodes that would penetrate
 * without forces, all slipping. */
static int sweeps_of_newton(const contact_problem *cp) {
  double n = 0.0, m = cp->m;
  for (int i = 0; i < cp->n; ++i) n += cp->f[i * cp->dim] > cp->gap[i];
  n *= cp->dim - 1;
  double most = STEPS * 2.0 / 3.0 * n * n * n / (READ * 2.0 * m * m);
  return most < LEAST_ROUNDS * ROUND ? 0 : (int)most;
}

/* Sweeps of SOR on a compliance, while the rate of the last round predicts the
 * solution within "most". rep->outcome CONVERGED: solved. */
static status promising_sweeps(contact_solver *s, const contact_problem *cp,
                               int most, const solver_listener *listener,
                               const answer *to) {
  status st = OK;
  int made = 0;
  double before = HUGE_VAL;
  solver_report *rep = to->rep;
  *rep = (solver_report){.outcome = STOPPED_UNFIT};
  while (made + ROUND <= most) {
    TRY(short_try(s, cp, &sor_solver, ROUND, listener, to));
    made += rep->iterations;
    double rate = rep->residual / before, left = s->choice.tol / rep->residual;
    rep->iterations = made;
    if (rep->outcome != STOPPED_ITERATIONS) break;
    int known = before < HUGE_VAL;
    if (known && !(rate < 1.0 && made + ROUND * log(left) / log(rate) <= most))
      break;
    before = rep->residual;
  }
done:
  return st;
}

static int is_cold(const contact_problem *cp, const double *r) {
  for (int i = 0; i < cp->m; ++i)
    if (r[i] != 0.0) return 0;
  return 1;
}

/* Without friction: in the normal unknowns. *done_well = 1: solved. */
static status solve_normal(contact_solver *s, const contact_problem *cp,
                           const solver_listener *listener, double *u,
                           double *r, solver_report *rep, int *done_well) {
  status st = OK;
  int before = 0;
  solver_control control = {.tol = s->choice.tol,
                            .max_iter = allowance(s, cp, 0),
                            .listener = listener};
  *done_well = 0;
  if (!normal_form_applies(cp)) goto done;
  if (s->normal.wanted++ == 0 && !is_cold(cp, r)) {
    TRY(short_try(s, cp, &newton_solver, WARM_STEPS, listener,
                  &(answer){u, r, rep}));
    *done_well = rep->outcome == CONVERGED;
    if (*done_well) goto done;
    before = rep->iterations;
  }
  TRY(normal_form_opened(&s->normal, cp, &control, u, r, rep));
  rep->iterations += before;
  if (rep->outcome == CONVERGED) {
    attempt_check(s, cp, u, r, rep);
    *done_well = rep->outcome == CONVERGED;
    if (*done_well) goto done;
  }
  before = rep->iterations;
  TRY(normal_form_solve(&s->normal, cp, &control, u, r, rep));
  rep->iterations += before;
  if (rep->outcome != CONVERGED) goto done;
  attempt_check(s, cp, u, r, rep);
  *done_well = rep->outcome == CONVERGED;
done:
  return st;
}

/* One method of the chain; its outcome in rep. */
static status run_link(contact_solver *s, const contact_problem *cp, int i,
                       const solver_listener *listener, double *u, double *r,
                       solver_report *rep) {
  status st = OK;
  attempt a = {auto_chain[i].ops, s->param, auto_chain[i].how,
               allowance(s, cp, i)};
  memset(s->param, 0, s->param_size);
  option_defaults(a.ops->options, s->param);
  if (i > 0) cold_start(cp, u, r);
  /* With a nearly singular stiffness its start forces are too large. */
  if (a.ops == &proximal_solver) memset(r, 0, (size_t)cp->m * sizeof *r);
  if (a.how == WHILE_PROMISING)
    TRY(promising_sweeps(s, cp, a.max_iter, listener, &(answer){u, r, rep}));
  else
    TRY(attempt_run(s, cp, &a, listener, u, r, rep));
  if (rep->outcome != STOPPED_UNFIT) attempt_check(s, cp, u, r, rep);
  if (cp->floating || rep->outcome == STOPPED_RAY)
    TRY(attempt_prove(s, cp, rep));
  if (i > 0 || rep->outcome != CONVERGED) note(s, rep, &a);
done:
  return st;
}

/* Sweeps of SOR on a stiffness in 3-D with a loose tolerance. */
static status coarse_sweeps(contact_solver *s, const contact_problem *cp,
                            const solver_listener *listener, const answer *to) {
  to->rep->outcome = STOPPED_UNFIT;
  if (cp->A != NULL && cp->dim == 3 && cp->B != NULL &&
      solver_few_digits(s->choice.tol))
    PASS(short_try(s, cp, &sor_solver, cp->m / SWEEP_SHARE, listener, to));
  return OK;
}

status auto_solve(contact_solver *s, const contact_problem *cp,
                  const solver_listener *listener, double *u, double *r,
                  solver_report *rep) {
  status st = OK;
  size_t bytes = (size_t)cp->m * sizeof *u;
  int n = (int)(sizeof auto_chain / sizeof *auto_chain), iterations = 0;
  int solved = 0;
  solver_report best = {.outcome = RUNNING};
  TRY(solve_normal(s, cp, listener, u, r, rep, &solved));
  if (!solved && sweeps_fit(cp)) {
    TRY(promising_sweeps(s, cp, sweeps_of_newton(cp), listener,
                         &(answer){u, r, rep}));
    solved = rep->outcome == CONVERGED;
  }
  if (!solved) {
    TRY(coarse_sweeps(s, cp, listener, &(answer){u, r, rep}));
    solved = rep->outcome == CONVERGED;
  }
  for (int i = 0; i < n && !solved; ++i) {
    if (is_skipped(cp, i)) continue;
    TRY(run_link(s, cp, i, listener, u, r, rep));
    iterations += rep->iterations;
    if (best.outcome == RUNNING || rep->outcome == CONVERGED ||
        says_more(cp, rep, &best)) {
      best = *rep;
      memcpy(s->best_u, u, bytes);
      memcpy(s->best_r, r, bytes);
    }
    if (is_final(rep->outcome)) break;
  }
  if (solved) goto done;
  TRY(attempt_prove(s, cp, &best));
  memcpy(u, s->best_u, bytes);
  memcpy(r, s->best_r, bytes);
  *rep = best;
  rep->iterations = iterations;
done:
  return st;
}
