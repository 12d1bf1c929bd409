/*
 * METHOD=AUTO. The choice depends on quantities without unit: whether there is
 * friction, which form is given, whether it can be inverted, the dimension and
 * the number of unknowns m.
 *
 * No friction: the tangential unknowns are eliminated and the normal ones are
 * solved for by active sets, of the opening nodes only, and by NEWTON where
 * these do not converge. The full problem is taken for the first steps from a
 * warm start, which often suffice, and where the normal form fails.
 *
 * Stiffness given: NEWTON. The number of its steps does not grow with m or with
 * the condition of A, and its factor is reused from step to step and from
 * problem to problem. Then NEWTON along a friction path, for large mu; then
 * SOR, which needs no factor; LEMKE; PROXIMAL last, for a stiffness that is
 * nearly singular under large mu. In 3-D with a loose tolerance (TOL=BALANCED)
 * sweeps of SOR first, as many as cost less than some steps of NEWTON.
 *
 * Stiffness as an operator: after NEWTON what works by products and solves too,
 * AUGLAG, PROXIMAL, PCG; its entries are formed for SOR and LEMKE alone.
 *
 * Compliance given: in 3-D first sweeps of SOR, while their rate predicts the
 * solution at less cost than the steps of NEWTON; of few contacts always. Then
 * NEWTON for the forces, if the compliance is regular, more sweeps and NEWTON
 * along a friction path; PCG, PROXIMAL, LAGRANGE, SOR and LEMKE work on a
 * singular one. Of rigid bodies PCG solves
 * many in some hundred iterations, the others rarely: then PROXIMAL, in some
 * ten to a thousand steps, and PCG without the short limit.
 *
 * Compliance in sparse blocks: the operations of each method are estimated from
 * the contacts n and the entries e of the blocks,
 *
 *   a sweep         4 e + 100 dim^2 n
 *   PROXIMAL       16 steps of 500 e (a sparse factor)
 *   PCG           800 steps of 3 e + 650 n
 *
 * (counts and factors measured on the public problems of FCLIB). Sweeps of
 * AITKEN go first, no more of them than the cheapest of the others costs, while
 * their rate predicts the solution within 1.5 times that. The others follow in
 * the order of their cost, then the methods with longer limits.
 *
 * A method that is not "warm" starts cold, on the same problem. Each has a
 * limit of iterations that bounds its cost (allowance).
 */
#include "solver/choice/choice.h"

#include "base/base.h"

enum {
  WARM_STEPS = 3,      /* of NEWTON before the normal form is made */
  ROUND = 10,          /* sweeps from one check of their rate to the next */
  SPARSE_ROUND = 32,   /* the same of sparse blocks */
  SWEEP_SHARE = 4,     /* m over it: sweeps that cost less than an inverse */
  STEPS = 6,           /* of NEWTON, compared with the cost of sweeps */
  LEAST_ROUNDS = 3,    /* least number for a trial */
  TINY_SIZE = 30,      /* m: up to here they cost less than STEPS of NEWTON */
  LEAST_TRIAL = 100,   /* sweeps where NEWTON has failed */
  READ = 8,            /* solves whose arithmetic takes the time of reading the
                          matrix */
  FULL_SIZE = 1000,    /* m: up to here a method has all its iterations */
  SMALL_SIZE = 200,    /* m: up to here factorisations cost like products */
  LEAST_FACTORS = 80,  /* iterations with a factorisation, on large problems */
  MOST_FACTORS = 4000, /* on small ones */
  LEAST_SWEEPS = 1000, /* iterations with a product */
  MOST_SWEEPS = 20000
};

static const double LENIENT = 1.5; /* sweeps expected over those allowed */

/* A method, its loop, and where it applies. */
typedef struct link {
  const solver_ops *ops;
  drive how;
  int compliance; /* 1: only where no stiffness is given, -1: where one is */
  int factors;    /* 1: an iteration costs a factorisation, else a product */
  int most;       /* iterations, 0: as many as the cost allows */
  int warm;       /* 1: starts where the method before it ended */
} link;

enum { BY_NEWTON = -1 /* as many sweeps as NEWTON costs */ };
static const link dense_chain[] = {
    {&sor_solver, WHILE_PROMISING, 1, 0, BY_NEWTON, 1},
    {&newton_solver, PLAIN, 0, 1, 0, 1},
    {&sor_solver, WHILE_PROMISING, 1, 0, 0, 0},
    {&newton_solver, ALONG_PATH, 0, 1, 0, 0},
    {&pcg_solver, PLAIN, 1, 0, 1000, 0},
    {&proximal_solver, PLAIN, 1, 1, 0, 0},
    {&pcg_solver, PLAIN, 1, 0, 0, 0},
    {&lagrange_solver, PLAIN, 1, 0, 0, 0},
    {&sor_solver, PLAIN, 0, 0, 0, 0},
    {&lemke_solver, PLAIN, 0, 0, 0, 0},
    {&proximal_solver, PLAIN, -1, 1, 0, 0}};

/* The first SORTED after the sweeps are put in the order of their cost. */
static const link sparse_chain[] = {
    {&aitken_solver, WHILE_PROMISING, 1, 0, 0, 1},
    {&proximal_solver, PLAIN, 1, 1, 512, 0},
    {&pcg_solver, PLAIN, 1, 0, 1000, 0},
    {&newton_solver, PLAIN, 1, 1, 0, 0},
    {&newton_solver, ALONG_PATH, 1, 1, 0, 0},
    {&proximal_solver, PLAIN, 1, 1, 0, 0},
    {&pcg_solver, PLAIN, 1, 0, 0, 0},
    {&lagrange_solver, PLAIN, 1, 0, 0, 0},
    {&aitken_solver, PLAIN, 1, 0, 0, 0},
    {&sor_solver, PLAIN, 1, 0, 0, 0},
    {&lemke_solver, PLAIN, 1, 0, 0, 0}};
/* Of an operator: the last two have its entries formed. */
static const link operator_chain[] = {{&newton_solver, PLAIN, 0, 1, 0, 1},
                                      {&newton_solver, ALONG_PATH, 0, 1, 0, 0},
                                      {&auglag_solver, PLAIN, 0, 1, 0, 0},
                                      {&proximal_solver, PLAIN, 0, 1, 0, 0},
                                      {&pcg_solver, PLAIN, 0, 0, 1000, 0},
                                      {&sor_solver, PLAIN, 0, 0, 0, 0},
                                      {&lemke_solver, PLAIN, 0, 0, 0, 0}};
enum {
  N_OPERATOR = sizeof operator_chain / sizeof *operator_chain,
  N_DENSE = sizeof dense_chain / sizeof *dense_chain,
  N_SPARSE = sizeof sparse_chain / sizeof *sparse_chain,
  MOST_LINKS = N_DENSE > N_SPARSE ? N_DENSE : N_SPARSE,
  SORTED = 2
};

/* ---- cost of a method on sparse blocks, operations ----------------------- */

static double entries_of(const contact_problem *cp) {
  return (double)cp->blocks->start[cp->n] * cp->dim * cp->dim;
}

static double cost_of(const contact_problem *cp, const solver_ops *ops) {
  const double e = entries_of(cp);
  if (ops == &proximal_solver) return 16.0 * 500.0 * e;
  return 800.0 * (3.0 * e + 650.0 * cp->n);
}

/* The methods in their order, order[MOST_LINKS]; their number. */
static int order_links(const contact_problem *cp, const link **order) {
  const int sparse = cp->blocks != NULL;
  const link *chain = cp->op != NULL ? operator_chain
                      : sparse       ? sparse_chain
                                     : dense_chain;
  const int n = cp->op != NULL ? N_OPERATOR : sparse ? N_SPARSE : N_DENSE;
  for (int i = 0; i < n; ++i) order[i] = chain + i;
  for (int i = 2; sparse && i <= SORTED; ++i) {
    const link *one = order[i];
    int k = i;
    for (; k > 1 && cost_of(cp, order[k - 1]->ops) > cost_of(cp, one->ops); --k)
      order[k] = order[k - 1];
    order[k] = one;
  }
  return n;
}

/* Sweeps at the cost of NEWTON for the forces of the nodes that would penetrate
 * without forces, all slipping. */
static int sweeps_of_newton(const contact_problem *cp) {
  double n = 0.0, m = cp->m;
  for (int i = 0; i < cp->n; ++i) n += cp->f[i * cp->dim] > cp->gap[i];
  n *= cp->dim - 1;
  double most = STEPS * 2.0 / 3.0 * n * n * n / (READ * 2.0 * m * m);
  if (most >= LEAST_ROUNDS * ROUND) return (int)most;
  return cp->m <= TINY_SIZE ? LEAST_ROUNDS * ROUND : 0;
}

/* Sweeps at the cost of the cheapest other method. */
static int sweeps_of_others(const contact_problem *cp) {
  double least = HUGE_VAL;
  for (int i = 1; i <= SORTED; ++i)
    least = fmin(least, cost_of(cp, sparse_chain[i].ops));
  return (int)fmin(
      least / (4.0 * entries_of(cp) + 100.0 * cp->dim * cp->dim * cp->n),
      MOST_SWEEPS);
}

/* Of the sweeps that are watched. */
static int sweeps_allowed(const contact_problem *cp, const link *l) {
  if (cp->blocks != NULL) return sweeps_of_others(cp);
  if (l->most == BY_NEWTON) return sweeps_of_newton(cp);
  return cp->m > LEAST_TRIAL * SWEEP_SHARE ? cp->m / SWEEP_SHARE : LEAST_TRIAL;
}

/* Limit of the iterations of a method: such that its cost is at most that of a
 * problem with FULL_SIZE unknowns, but at least LEAST. For a body held by
 * contact alone the last method is limited, as there may be no solution. */
static int allowance(const contact_solver *s, const contact_problem *cp,
                     const link *l) {
  double size = fmax(1.0, (double)cp->m / FULL_SIZE);
  double most = l->factors ? MOST_FACTORS / (size * size * size)
                           : MOST_SWEEPS / (size * size);
  int own = (int)fmax(most, l->factors ? LEAST_FACTORS : LEAST_SWEEPS);
  int asked = s->choice.max_iter;
  if (l->compliance < 0 && cp->floating) {
    size = fmax(1.0, (double)cp->m / SMALL_SIZE);
    own = (int)fmax(MOST_SWEEPS / (size * size * size), LEAST_FACTORS);
  }
  if (l->most > 0 && l->most < own) own = l->most;
  if (l->how == WHILE_PROMISING) own = sweeps_allowed(cp, l);
  return asked > 0 && asked < own ? asked : own;
}

/* Append to the log how an attempt ended. */
static void note(contact_solver *s, const solver_report *rep,
                 const attempt *a) {
  int cut = rep->outcome == STOPPED_ITERATIONS && a->max_iter > 0;
  if (rep->outcome == STOPPED_UNFIT) return; /* attempt_run did */
  text_add(s->log, LOG_SIZE, "%s%s%s: %s", s->log[0] != '\0' ? ", " : "",
           rep->solver, a->how == ALONG_PATH ? " along a friction path" : "",
           outcome_text(rep->outcome));
  if (cut)
    text_add(s->log, LOG_SIZE, " (%d of %d allowed)", rep->iterations,
             a->max_iter);
}

/* Significance of a failure; a singular compliance has none, a method that does
 * not apply less. */
static int weight(const contact_problem *cp, outcome o) {
  if (o == STOPPED_UNFIT) return -1;
  return o == STOPPED_SINGULAR && contact_has_stiffness(cp);
}

/* The more significant of two failures: singular, then the lower residual. */
static int says_more(const contact_problem *cp, const solver_report *a,
                     const solver_report *b) {
  int ra = weight(cp, a->outcome), rb = weight(cp, b->outcome);
  if (ra != rb) return ra > rb;
  return !(a->residual >= b->residual);
}

/* 1 if a method of the chain does not apply: a friction path without Coulomb
 * friction, a method for problems of which only the compliance is known, or one
 * that needs all of a large sparse one. */
static int is_skipped(const contact_problem *cp, const link *l) {
  if (l->how == ALONG_PATH && cp->B == NULL) return 1;
  if (cp->blocks != NULL)
    return is_large_sparse(cp) && !(l->ops->handles & SPARSE_COMPLIANCE);
  /* 1: sweeps may be fast. */
  if (l->how == WHILE_PROMISING &&
      !(!contact_has_stiffness(cp) && cp->dim == 3 && cp->B != NULL))
    return 1;
  if (l->compliance < 0) return !contact_has_stiffness(cp);
  return l->compliance && contact_has_stiffness(cp);
}

/* Start and end of an attempt: u[m], r[m], and its report. */
typedef struct answer {
  double *u, *r;
  solver_report *rep;
} answer;

/* An attempt of few iterations, which need not succeed. */
static status short_try(contact_solver *s, const contact_problem *cp,
                        const solver_ops *ops, int iterations,
                        const answer *to) {
  int asked = s->choice.max_iter;
  attempt a = {ops, s->param, PLAIN,
               asked > 0 && asked < iterations ? asked : iterations, NULL};
  memset(s->param, 0, s->param_size);
  option_defaults(ops->options, s->param);
  PASS(attempt_run(s, cp, &a, to->u, to->r, to->rep));
  attempt_check(s, cp, to->u, to->r, to->rep);
  return OK;
}

/* Without friction: in the normal unknowns. *done_well = 1: solved. */
static status solve_normal(contact_solver *s, const contact_problem *cp,
                           const answer *to, int *done_well) {
  double *u = to->u, *r = to->r;
  solver_report *rep = to->rep;
  int before = 0;
  solver_control control = {.tol = s->choice.tol,
                            .max_iter = allowance(s, cp, &dense_chain[1]),
                            .listener = s->listener};
  *done_well = 0;
  if (!normal_form_applies(cp)) return OK;
  if (s->normal.wanted++ == 0 && !is_zero(cp->m, r)) {
    PASS(short_try(s, cp, &newton_solver, WARM_STEPS, to));
    *done_well = rep->outcome == CONVERGED;
    if (*done_well) return OK;
    before = rep->iterations;
  }
  PASS(normal_form_opened(&s->normal, cp, &control, u, r, rep));
  rep->iterations += before;
  if (rep->outcome == CONVERGED) {
    attempt_check(s, cp, u, r, rep);
    *done_well = rep->outcome == CONVERGED;
    if (*done_well) return OK;
  }
  before = rep->iterations;
  PASS(normal_form_solve(&s->normal, cp, &control, u, r, rep));
  rep->iterations += before;
  if (rep->outcome != CONVERGED) return OK;
  attempt_check(s, cp, u, r, rep);
  *done_well = rep->outcome == CONVERGED;
  return OK;
}

/* One method of the chain; its outcome in rep. "first": no other has run. */
static status run_link(contact_solver *s, const contact_problem *cp,
                       const link *l, int first, const answer *to) {
  solver_report *rep = to->rep;
  attempt a = {l->ops, s->param, l->how, allowance(s, cp, l), NULL};
  sweep_promise promise = {
      .every = cp->blocks != NULL ? SPARSE_ROUND : ROUND,
      .most = (cp->blocks != NULL ? LENIENT : 1.0) * a.max_iter};
  *rep = (solver_report){.outcome = STOPPED_UNFIT, .solver = l->ops->name};
  if (l->how == WHILE_PROMISING) {
    if (a.max_iter == 0) return OK;
    a.promise = &promise;
  }
  memset(s->param, 0, s->param_size);
  option_defaults(a.ops->options, s->param);
  if (!l->warm) cold_start(cp, to->u, to->r);
  /* With a nearly singular stiffness its start forces are too large. */
  if (a.ops == &proximal_solver) CLEAR(to->r, cp->m);
  PASS(attempt_run(s, cp, &a, to->u, to->r, rep));
  if (rep->outcome != STOPPED_UNFIT) attempt_check(s, cp, to->u, to->r, rep);
  if (cp->floating || rep->outcome == STOPPED_RAY)
    PASS(attempt_prove(s, cp, rep));
  if (!first || rep->outcome != CONVERGED) note(s, rep, &a);
  return OK;
}

/* Sweeps of SOR on a stiffness in 3-D with a loose tolerance. */
static status coarse_sweeps(contact_solver *s, const contact_problem *cp,
                            const answer *to) {
  to->rep->outcome = STOPPED_UNFIT;
  if (cp->A != NULL && cp->dim == 3 && cp->B != NULL &&
      solver_few_digits(s->choice.tol))
    PASS(short_try(s, cp, &sor_solver, cp->m / SWEEP_SHARE, to));
  return OK;
}

status auto_solve(contact_solver *s, const contact_problem *cp, double *u,
                  double *r, solver_report *rep) {
  const link *order[MOST_LINKS];
  const answer to = {u, r, rep};
  int n = order_links(cp, order), iterations = 0, first = 1, solved = 0;
  solver_report best = {.outcome = RUNNING};
  PASS(solve_normal(s, cp, &to, &solved));
  if (!solved) {
    PASS(coarse_sweeps(s, cp, &to));
    solved = rep->outcome == CONVERGED;
  }
  for (int i = 0; i < n && !solved; ++i) {
    if (is_skipped(cp, order[i])) continue;
    PASS(run_link(s, cp, order[i], first, &to));
    rep->iterations = iterations += rep->iterations;
    solved = rep->outcome == CONVERGED;
    first = first && rep->outcome == STOPPED_UNFIT && s->log[0] == '\0';
    if (best.outcome == RUNNING || says_more(cp, rep, &best)) {
      best = *rep;
      COPY(s->best_u, u, cp->m);
      COPY(s->best_r, r, cp->m);
    }
    if (rep->outcome == STOPPED_RAY) break;
  }
  if (solved) return OK;
  PASS(attempt_prove(s, cp, &best));
  COPY(u, s->best_u, cp->m);
  COPY(r, s->best_r, cp->m);
  *rep = best;
  rep->iterations = iterations;
  return OK;
}
