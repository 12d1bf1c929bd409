/*
 * Whether a solution with friction is unique (CHECK=), and whether a continuous
 * path leads to it: for large friction neither is known.
 *
 * Where the fixed point on the sliding limit contracts with rate k, the motion
 * of an increment is at most 1/(1 - k) times the change of its load, both in
 * the energy norm, and the states in between form a path. An increment that
 * moves by more, or in whose slip k is 1 or more, is examined: states at times
 * in between are solved, always in the middle of the part that moves most. A
 * part with the same statuses at both ends holds no jump. The motion of a path
 * falls with the length of the part, that of a jump does not. AUTO solves, also
 * where the method of the deck did not converge; an increment that starts from
 * a state far from equilibrium is not examined.
 */
#include "effects/plan/effect.h"
#include "run/history/loop.h"
#include "run/setup/setup.h"

typedef struct checked {
  int asked;              /* 1: by CHECK= of the step */
  int jumps;              /* 1: the equilibrium jumps in the increment */
  double jump_t;          /* s, there */
  int lost;               /* 1: the last state is none of equilibrium, by far */
  solution_set solutions; /* found by CHECK= in the increment */
} checked;

enum { DEPTH = 16, /* halvings of the increment */ POINTS = 80 };
static const double SUSPECT = 2.0; /* -, motion over load */
static const double LEFT = 0x1p-6; /* -, of the motion, in 2^-16 of the load */
static const double RATE = 0.98;   /* -, of a measured rate: it may be 1 */
static const double NEAR = 1e-2;   /* -, residual of a state near the path */
static const double STILL = 0x1p-30; /* -, of the largest slip: none */

/* |a - b|_A of contact displacements; workspace[2*n_c]. */
static double distance(const run *r, const double *a, const double *b,
                       double *workspace) {
  double *Ad = workspace + r->nodes.n_c;
  vector_of(r->nodes.n_c, b, a, workspace);
  const double *d = run_rows(r, 0, workspace);
  contact_apply(&r->problem.cp, d, Ad);
  return sqrt(fmax(dot(r->nodes.n_row, d, Ad), 0.0));
}

/* What the obstacles and the load, less the forces of the state before, can
 * move, in the energy norm; workspace[2*n_c]. */
static status load_change(run *r, double *workspace, double *size) {
  double *more = workspace + r->nodes.n_c, square;
  *size = r->now.motion == NULL
              ? 0.0
              : distance(r, r->now.motion, r->old.motion, workspace);
  contact_apply(&r->problem.cp, run_rows(r, 0, r->old.uc), more);
  const double *rc = run_rows(r, 1, r->old.rc);
  for (int i = 0; i < r->nodes.n_row; ++i)
    more[i] = r->problem.f[i] + rc[i] - more[i];
  PASS(condensed_force_energy(r->c, more, &square));
  *size += sqrt(square);
  return OK;
}

/* ---- slip through the increment ------------------------------------------ */

/* The state in which every node that has moved, and touches at one end of the
 * increment, slides: u[m], q[m]. */
static void set_sliding(const contact_problem *cp, const double *before,
                        double *u, double *q) {
  double most = 0.0;
  for (int i = 0; i < cp->n; ++i) {
    int normal = i * cp->dim;
    q[normal] = fmin(before[normal], q[normal]);
    if (q[normal] < 0.0) u[normal] = cp->gap[i];
    most = fmax(most, contact_slip_of(cp, u, i));
  }
  for (int i = 0; i < cp->n; ++i) {
    double slip = contact_slip_of(cp, u, i), g = contact_node_limit(cp, q, i);
    for (int k = 1; k < cp->dim; ++k) {
      int dof = i * cp->dim + k;
      int moves = slip > STILL * most && !contact_held(cp, dof);
      q[dof] = moves ? -g * (u[dof] - contact_stick(cp, dof)) / slip : 0.0;
    }
  }
}

static status sliding_rate(run *r, double *rate) {
  const contact_problem *cp = &r->problem.cp;
  size_t m = cp->m;
  OWNED double *u = NULL, *q = NULL, *before = NULL;
  PASS_NEW_REALS(m, &u, &q, &before);
  COPY(before, run_rows(r, 1, r->old.rc), m);
  COPY(u, run_rows(r, 0, r->now.uc), m);
  COPY(q, run_rows(r, 1, r->now.rc), m);
  set_sliding(cp, before, u, q);
  return contraction_rate(cp, u, q, &r->solving.rate, rate);
}

/* ---- states in between --------------------------------------------------- */

typedef struct point {
  double t;               /* s */
  double *u;              /* [n_c] m */
  contact_status *status; /* [n] of the nodes of r->problem.cp */
  double motion;          /* to the next point, energy norm */
} point;

typedef struct path {
  run *r;
  point p[POINTS];
  int n;
  double shortest, least; /* part that is not halved, s; motion that counts */
  double *workspace;      /* [2*n_c] */
} path;

/* The state u, rc as point number "at". */
static status insert(path *s, int at, double t, const double *u,
                     const double *rc) {
  run *r = s->r;
  memmove(s->p + at + 1, s->p + at, (s->n - at) * sizeof *s->p);
  s->p[at] = (point){.t = t};
  ++s->n;
  OWNS(s);
  PASS_NEW_ALL(OF(s->p[at].u, r->nodes.n_c), OF(s->p[at].status, r->nodes.n));
  COPY(s->p[at].u, u, r->nodes.n_c);
  contact_classify(&r->problem.cp, run_rows(r, 0, s->p[at].u),
                   run_rows(r, 1, (double *)rc), s->p[at].status);
  return OK;
}

/* 0 where the statuses at both ends of part k are the same. */
static void measure(path *s, int k) {
  point *a = s->p + k, *b = a + 1;
  size_t bytes = s->r->problem.cp.n * sizeof *a->status;
  a->motion = memcmp(a->status, b->status, bytes) == 0
                  ? 0.0
                  : distance(s->r, b->u, a->u, s->workspace);
}

/* Halve what moves most until it is short, *found, or moves by nothing. */
static status follow(path *s, int *found) {
  run *r = s->r;
  *found = -1;
  while (s->n < POINTS) {
    int k = 0;
    for (int j = 1; j + 1 < s->n; ++j)
      if (s->p[j].motion > s->p[k].motion) k = j;
    if (!(s->p[k].motion > s->least)) break;
    if (s->p[k + 1].t - s->p[k].t <= s->shortest) {
      *found = k;
      break;
    }
    double middle = 0.5 * (s->p[k].t + s->p[k + 1].t);
    PASS(increment_solve(r, middle));
    if (r->solving.report.outcome <= 0) break;
    PASS(insert(s, k + 1, middle, r->now.uc, r->now.rc));
    measure(s, k);
    measure(s, k + 1);
  }
  return OK;
}

/* AUTO in the place of the method of the deck, so that the result does not
 * depend on it, nor on what TOL=BALANCED allows; *own: that of the deck. */
static status lend_solver(run *r, contact_solver **own) {
  const solver_choice choice = {.tol = r->step->solver.tol};
  *own = r->elastic.solver;
  r->elastic.solver = NULL;
  return contact_solver_new(&choice, &r->elastic.solver);
}

static void give_back(run *r, contact_solver *own, double tol) {
  contact_solver_free(&r->elastic.solver);
  r->solving.tol = tol;
  r->elastic.solver = own;
  r->solver = own;
}

static void note_jump(run *r, checked *own, double t, double share) {
  own->jumps = 1;
  own->jump_t = t;
  RUN_NOTE(r,
           "  JUMP: no path of equilibria leads here: at time %.6g, within "
           "%.0e of the load of the\n  increment, the state changes by %.0f %% "
           "of its motion; the run goes on with another branch\n",
           t, ldexp(1.0, -DEPTH), 100 * share);
}

/* *share of the motion, 0: no jump; *at: its time, s. r->now is lost. */
static status look_into(run *r, double t, double *at, double *share) {
  status st = OK;
  OWNED_NEW(path, s, 1);
  OWNED_NEW(double, workspace, 2 * r->nodes.n_c);
  *s = (path){r, .workspace = workspace,
              .shortest = ldexp(t - r->old.t, -DEPTH) * 1.5};
  contact_solver *own = NULL;
  const double tol = r->solving.tol;
  int found = -1;
  r->solving.tol = r->step->solver.tol;
  TRY(lend_solver(r, &own));
  TRY(increment_solve(r, t));
  if (r->solving.report.outcome <= 0) goto done;
  TRY(insert(s, 0, t, r->now.uc, r->now.rc));
  TRY(insert(s, 0, r->old.t, r->old.uc, r->old.rc));
  double all = distance(r, s->p[1].u, s->p[0].u, workspace);
  s->least = LEFT * all;
  measure(s, 0);
  TRY(follow(s, &found));
  if (found < 0) goto done;
  *at = s->p[found + 1].t;
  *share = s->p[found].motion / all;
done:
  if (own != NULL) give_back(r, own, tol);
  return st;
}

static status look_for_jump(run *r, void *self, double t) {
  status st = OK;
  checked *own = self;
  double change = HUGE_VAL, rate = 0.0, share = 0.0, at = 0.0,
         *workspace = NULL;
  int missed = r->solving.report.outcome <= 0, lost = own->lost;
  own->jumps = 0;
  own->lost = missed && !(r->solving.report.residual <= NEAR);
  if (r->nodes.n == 0 || r->problem.cp.B == NULL || r->problem.cp.floating ||
      lost)
    return OK;
  if (r->step->kind != STEP_QUASISTATIC) return OK;
  timer_enter_as(STAGE_CHECK, STAGE_WHOLE);
  NEW(workspace, 2 * r->nodes.n_c);
  TRY(load_change(r, workspace, &change));
  int leaps = distance(r, r->now.uc, r->old.uc, workspace) > SUSPECT * change;
  if (!missed && !leaps) TRY(sliding_rate(r, &rate));
  if (!missed && !leaps && !(rate >= RATE)) goto done;
  TRY(look_into(r, t, &at, &share));
  TRY(increment_solve(r, t));
  if (share > 0.0) note_jump(r, own, at, share);
done:
  memory_free(workspace);
  timer_leave(STAGE_CHECK);
  return st;
}

/* Jumps are searched where friction makes increments depend on their
 * history. */
static int requires_check(const model *m, const reason *why) {
  for (int i = 0; i < m->n.step; ++i)
    if (m->steps[i].check != CHECK_NONE)
      return plan_at(why, &m->steps[i].solver_at, "*SOLVER, CHECK=");
  for (int i = 0; i < m->n.step && (m->effects & EFFECT_FRICTION); ++i)
    if (m->steps[i].kind == STEP_QUASISTATIC)
      return plan_says(1, why, "friction in *QUASISTATIC of %s:%d may jump",
                       PLACE(m->steps[i].at));
  return plan_says(0, why, "no *SOLVER, CHECK=, no path of friction");
}

/* Products with the condensed matrix in each increment. */
static effect_work products(const plan_sizes *s) {
  double m = plan_contact_unknowns(s);
  return (effect_work){s->contact, "nodes", -1.0, s->increments * 3.0 * m * m};
}

static status begin_step(run *r, void *self) {
  ((checked *)self)->jumps = 0;
  return OK;
}

static status check_asked(run *r, void *self) {
  int corner = 0;
  for (int i = 0; i < r->nodes.n; ++i)
    corner |= surface_is_corner(r->surface, i);
  return check_possible(r->step, r->msh->dim,
                        r->msh->dim == 3 ? r->nodes.n : run_least_nodes(r),
                        corner);
}

static status find_others(run *r, void *self) {
  OWNS(self);
  ((checked *)self)->asked = r->step->check != CHECK_NONE;
  return check_problem(r->step, &r->problem.cp, &r->solving.report,
                       run_rows(r, 0, r->now.uc), run_rows(r, 1, r->now.rc),
                       &((checked *)self)->solutions);
}

static void show(const void *self, state *s) {
  const checked *own = self;
  s->errors.jumps = own->jumps;
  s->errors.jump_t = own->jump_t;
  if (own->asked) s->errors.solutions = &own->solutions;
}

static status keep(run *r, void *self, archive *a) {
  return archive_ints(a, "lost", &((checked *)self)->lost, 1);
}

/* The hooks enter the stage themselves, where there is something to do. */
/* clang-format off */
const effect_ops second_solutions_effect = {
  .name = "second solutions, jumps", .bit = NO_BIT, .required = requires_check,
  .expected = products, .own = STAGE_NONE, .more = {STAGE_CHECK},
  .size = sizeof(checked),
  .on = {.check = check_asked, .begin_step = begin_step,
         .examine = look_for_jump, .accept = find_others, .show = show,
         .keep = keep}};
/* clang-format on */
