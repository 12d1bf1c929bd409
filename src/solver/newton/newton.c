/*
 * Semismooth Newton method of the natural map (Alart, Curnier 1991) written as
 * a primal-dual active set (Hueber, Stadler, Wohlmuth 2008).
 *
 * Each step guesses the state of every unknown and solves one linear system in
 * the unknowns that are free under the guess:
 *   closed      u_n = gap             known
 *   open        r_n = 0               A u - f = 0
 *   stick       u_t = ut0             known
 *   slip        r_t = g e - kappa (I - e e') (u_t - ut0),  g = g0 - B r_n
 * with e the direction of z = r_t - c (u_t - ut0) and kappa = c g/(|z| - g),
 * the exact derivative of the projection on the disc; in 2-D e = +-1. Without B
 * in it the system is symmetric (Cholesky), else LU. c is the diagonal of A.
 *
 * The guess for the next step follows from the solution. A repeated pattern, or
 * no progress, starts the method again from another guess (stick, then that of
 * some sweeps of relaxation); on small problems then one state is changed at a
 * time, the least index first (Murty), which ends for every P-matrix. A
 * singular system (the body is free under the guess) is made regular by weak
 * springs for the step; if the final pattern is singular, that is the outcome.
 *
 * Where only the compliance is known a step solves for the unknown forces of
 * the guess (system.h); a singular system then ends the method.
 */
#include "base/base.h"
#include "solver/local.h"
#include "solver/newton/system.h"
#include "solver/single.h"

typedef struct newton {
  int steps; /* of one attempt; 0: chosen by the program */
} newton;

OPTIONS(newton_options,
        OPTION_INT(newton, steps, "STEPS", 0, 10000, "0", "-",
                   "steps of one attempt; 0: chosen by the program"));

enum {
  HISTORY = 64,    /* patterns remembered */
  FULL_STEPS = 40, /* of an attempt; more while the residual falls */
  MOST_STEPS = 1000,
  PATIENCE = 25,    /* steps without a lower residual */
  SMALL = 400,      /* unknowns: the cost of a step is negligible */
  MANY_STEPS = 100, /* of an attempt that makes a part of the changes */
  SWEEPS = 100      /* of relaxation before another attempt */
};
static const double SETTLING = 0.5; /* -, residual after a step with springs */
static const uint64_t DICE_START = 88172645463325252u;

typedef struct newton_work {
  states states;
  newton_system *system;         /* where A is known, else NULL */
  operated_system *operated;     /* where it is an operator, else NULL */
  compliance_system *compliance; /* where only W is known, else NULL */
  node_blocks *blocks;           /* NULL: not used yet */
  best_iterate best;
  uint64_t seen[HISTORY]; /* hashes of the patterns of the attempt */
} newton_work;

static status newton_setup(const contact_problem *cp, const void *par,
                           void *work) {
  newton_work *w = work;
  PASS(states_new(cp, &w->states));
  if (cp->op != NULL)
    PASS(operated_system_new(cp, &w->operated));
  else if (cp->A != NULL)
    PASS(newton_system_new(cp, &w->system));
  else
    PASS(compliance_system_new(cp, &w->compliance));
  return best_iterate_new(cp->m, &w->best);
}

typedef struct run {
  const contact_problem *cp;
  newton_work *w;
  states *st;
  const solver_control *control;
  double *u, *r;
  double scale;       /* contact_scale, N (m) */
  int steps;          /* made so far */
  int singular;       /* the last system needed springs */
  status failed;      /* of a step or sweeps, ERR_MEMORY: the method ends */
  linear_work linear; /* of a step, where somebody listens */
} run;

/* raw from u, or r. */
static void set_raw(const run *s) {
  const contact_problem *cp = s->cp;
  if (contact_has_stiffness(cp))
    contact_reaction(cp, s->u, s->st->raw);
  else
    compliance_displace(cp, s->r, s->st->raw);
}

static double mismatch(const run *s) {
  states_clean(s->st);
  return contact_mismatch(s->cp, s->scale, s->u, s->r, s->st->raw);
}

/* What a sum of reactions calls solved is measured by the reaction of u. */
static double residual_of(const run *s) {
  const double residual = mismatch(s);
  if (!operated_system_sums(s->w->operated) || residual > s->control->tol)
    return residual;
  set_raw(s);
  return mismatch(s);
}

/* 1: the pattern occurred before in this attempt. */
static int met_before(const run *s, int step) {
  uint64_t h = states_hash(s->st);
  int met = 0;
  for (int j = 0; j < step && j < HISTORY; ++j) met = met || s->w->seen[j] == h;
  s->w->seen[step % HISTORY] = h;
  return met;
}

/* State of an attempt. */
typedef struct course {
  double lowest;      /* residual, - */
  double before;      /* of the last step */
  int at, best_at;    /* this step, the one of the lowest residual */
  int changes, cycle; /* states that would change; pattern occurred before */
  int settled;        /* the step before was within the tolerance */
} course;

/* 1: solved, and a further step would change nothing or little, or is more than
 * the tolerance requires. On the round cone of three dimensions one within the
 * tolerance is still quadratic: it turns the forces of slipping nodes exactly
 * against their slip, unless nothing is left. */
static int solved(const run *s, course *c, double residual) {
  const int within = residual <= s->control->tol;
  const int linear =
      s->cp->dim < 3 || !memchr(s->st->guess.mode, SLIP, s->cp->n);
  if (solver_few_digits(s->control->tol)) return within;
  int rests = (linear && c->changes == 0) || c->settled;
  c->settled = within;
  return within && (rests || residual == 0.0);
}

/* 1: no lower residual for long. */
static int stuck(course *c, double residual) {
  if (residual < 0.99 * c->lowest) {
    c->lowest = residual;
    c->best_at = c->at;
  }
  return c->at - c->best_at > PATIENCE;
}

/* A step under the guess; s->singular 1: the system is. */
static status step(run *s) {
  states *st = s->st;
  const newton_work *w = s->w;
  if (w->operated != NULL)
    return operated_system_step(w->operated, s->cp, &st->guess, s->u, st->raw,
                                &s->singular);
  s->singular = w->system != NULL
                    ? newton_system_step(w->system, &st->guess, s->u, st->raw)
                    : compliance_system_step(w->compliance, s->cp, &st->guess,
                                             s->r, st->raw);
  return OK;
}

/* A step, with its work. */
static void tell_step(run *s) {
  const newton_work *w = s->w;
  const double cpu = s->control->listener != NULL ? timer_cpu() : 0.0;
  s->failed = step(s);
  if (s->failed != OK || s->control->listener == NULL) return;
  if (w->operated != NULL)
    s->linear = operated_system_work(w->operated, s->cp);
  else if (w->system != NULL)
    s->linear = newton_system_work(w->system);
  s->linear.cpu = timer_cpu() - cpu;
}

/* 1: springs carry part of the load, less with each step. */
static int settles(const run *s, course *c, double residual) {
  double before = c->before;
  c->before = residual;
  return c->changes == 0 && s->singular && residual < SETTLING * before;
}

/* 1: the last step was not exact, the next is. */
static int may_refresh(const newton_work *w) {
  return newton_system_refresh(w->system) ||
         operated_system_refresh(w->operated);
}

/* RUNNING, or why the attempt ends without a solution. In the plane a repeated
 * pattern is a cycle; in 3-D directions change while the states stay. */
static outcome verdict(const run *s, course *c, double residual) {
  int all = s->st->dice == 0, full = all && !s->st->careful;
  int still = stuck(c, residual), plane = s->cp->dim < 3;
  if (c->changes == 0 && (plane || (full && still))) {
    if (may_refresh(s->w)) return RUNNING;
    return s->singular ? STOPPED_RAY : STOPPED_STAGNATION;
  }
  if (all && c->cycle && (plane || still)) return STOPPED_CYCLE;
  return full && still ? STOPPED_STAGNATION : RUNNING;
}

/* 1: the limit of steps is reached. */
static int used_up(const run *s) {
  return s->control->max_iter > 0 && s->steps >= s->control->max_iter;
}

/* 1: the attempt may continue: within its steps, or the residual still falls (a
 * few states change per step, at little cost). */
static int goes_on(const run *s, const course *c, int limit) {
  if (used_up(s)) return 0;
  return c->at < limit ||
         (limit == FULL_STEPS && c->at < MOST_STEPS && c->at - c->best_at <= 2);
}

/* Steps from the present guess until solved, without progress, cycling or
 * "limit". */
static outcome attempt(run *s, int limit) {
  course c = {.lowest = HUGE_VAL, .before = HUGE_VAL};
  int m = s->cp->m;
  for (c.at = 0; goes_on(s, &c, limit); ++c.at) {
    c.cycle = met_before(s, c.at);
    tell_step(s);
    if (s->failed != OK) return STOPPED_NAN;
    ++s->steps;
    if (s->singular && !contact_has_stiffness(s->cp)) return STOPPED_SINGULAR;
    double residual = residual_of(s);
    if (isnan(residual)) return STOPPED_NAN;
    solver_keep_best(&s->w->best, m, residual, s->u, s->r);
    c.changes = states_next(s->st, 0);
    solver_report_all(s->control, &(solver_step){.solver = "newton",
                                                 .iteration = s->steps,
                                                 .residual = residual,
                                                 .status_changes = c.changes,
                                                 .cycle = c.cycle,
                                                 .linear = s->linear});
    if (solved(s, &c, residual)) return CONVERGED;
    outcome o = settles(s, &c, residual) ? RUNNING : verdict(s, &c, residual);
    if (o != RUNNING) return o;
  }
  return STOPPED_ITERATIONS;
}

/* Continue from the state with the lowest residual. */
static void return_to_best(run *s) {
  solver_take_best(&s->w->best, s->cp->m, s->u, s->r);
  set_raw(s);
  states_next(s->st, 1);
}

/* The guess after some sweeps of relaxation, each node solved exactly. */
static status relax(run *s) {
  OWNS(s->w);
  if (s->w->blocks == NULL) PASS(node_blocks_new(s->cp, &s->w->blocks));
  relaxation x = {
      .cp = s->cp, .blocks = s->w->blocks, .u = s->u, .r = s->r, .omega = 1.0};
  solver_take_best(&s->w->best, s->cp->m, s->u, s->r);
  relaxation_start(&x);
  relaxation_refresh(&x);
  for (int k = 0; k < SWEEPS; ++k) relaxation_sweep(&x, 0);
  set_raw(s);
  states_next(s->st, 1);
  return OK;
}

/* 1: no further attempt; without B the problem is convex. */
static int final(const run *s, outcome o) {
  return o == CONVERGED || o == STOPPED_NAN || o == STOPPED_SINGULAR ||
         used_up(s) || (o == STOPPED_RAY && s->cp->B == NULL);
}

/* Attempts one after the other; the outcome of an attempt with all changes made
 * (no equilibrium, cycle) has priority over later ones. */
static outcome newton_run(run *s, const newton *p) {
  int limit = p->steps > 0 ? p->steps : FULL_STEPS;
  int many = s->cp->m <= SMALL ? MANY_STEPS : limit;
  states_next(s->st, 1);
  uint64_t begun = states_hash(s->st);
  outcome o = attempt(s, limit), first = o;
  if (s->control->no_restart || final(s, o)) return o;
  states_all_stick(s->st);
  if (states_hash(s->st) != begun) o = first = attempt(s, limit);
  if (final(s, o)) return o;
  if (s->cp->op == NULL) {
    s->failed = relax(s);
    if (s->failed != OK) return STOPPED_NAN;
    o = attempt(s, limit);
    if (final(s, o)) return o;
  }
  return_to_best(s);
  s->st->dice = DICE_START;
  o = attempt(s, many);
  s->st->dice = 0;
  if (final(s, o)) return o;
  return_to_best(s);
  s->st->careful = 1;
  o = attempt(s, many);
  return final(s, o) ? o : first;
}

static void begin(run *s) {
  const contact_problem *cp = s->cp;
  s->st->cp = cp;
  s->st->u = s->u;
  s->st->r = s->r;
  s->scale = s->control->scale > 0.0 ? s->control->scale : contact_scale(cp);
  s->st->careful = 0;
  s->st->dice = 0;
  memset(s->st->guess.closed, 0, cp->m);
  memset(s->st->guess.mode, FREE, cp->n);
  set_raw(s);
  if (s->w->operated != NULL)
    operated_system_fit(s->w->operated);
  else if (s->w->system != NULL)
    newton_system_fit(s->w->system, cp);
  else
    memcpy(s->u, s->st->raw, cp->m * sizeof *s->u);
  s->w->best.residual = HUGE_VAL;
}

static status newton_solve(const contact_problem *cp, const void *par,
                           void *work, const solver_control *control, double *u,
                           double *r, solver_report *rep) {
  newton_work *w = work;
  run s = {
      .cp = cp, .w = w, .st = &w->states, .control = control, .u = u, .r = r};
  *rep = (solver_report){.outcome = CONVERGED, .iterations = 1};
  begin(&s);
  if (cp->n == 1 && cp->op == NULL &&
      single_solve(cp, s.scale, control->tol, u, r, &rep->residual)) {
    solver_report_step(control, "newton", 1, rep->residual);
    return OK;
  }
  rep->outcome = newton_run(&s, par);
  PASS(s.failed);
  if (rep->outcome != CONVERGED && used_up(&s))
    rep->outcome = STOPPED_ITERATIONS;
  rep->iterations = s.steps;
  rep->residual = solver_take_best(&w->best, cp->m, u, r);
  return OK;
}

static status newton_keep(void *work, archive *a) {
  newton_work *w = work;
  return w->system == NULL ? OK : newton_system_keep(w->system, a);
}

const solver_ops newton_solver = {
    SOLVER_OF(newton), .family = "Newton",
    .handles = SOLVES_TRESCA | SOLVES_COULOMB | SOLVES_3D | NEEDS_STIFFNESS |
               REGULAR_COMPLIANCE | SOLVES_FLOATING,
    .keep = newton_keep};
