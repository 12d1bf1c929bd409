/*
 * One equilibrium: loads and obstacles at time t, condensed load, contact
 * problem, contact solver, recovery of the interior (CPR98, problem S_i^n).
 */
#include "run/run.h"
#include "solver/choice/rest.h"

/* The unknown of a row of r->problem.cp among those of all contact nodes. */
static int unknown_of(const run *r, int row) {
  int i = row / r->nodes.rows;
  return r->msh->dim *
             (r->nodes.active.in != NULL ? r->nodes.active.in[i] : i) +
         row % r->nodes.rows;
}

void run_take_rows(const run *r, const double *v, double *rows) {
  for (int i = 0; i < r->nodes.n_row; ++i) rows[i] = v[unknown_of(r, i)];
}

double *run_rows(const run *r, int k, double *v) {
  double *rows = r->problem.row[k];
  if (rows == NULL) return v;
  run_take_rows(r, v, rows);
  for (int i = 0; k == 1 && i < r->nodes.n_row; ++i)
    if (r->surface->held[unknown_of(r, i)]) rows[i] = 0.0;
  return rows;
}

/* The solution u, r of r->problem.cp: other forces are zero. */
static void put_rows(const run *r, const double *u, const double *force) {
  if (u == r->now.uc) return;
  CLEAR(r->now.rc, r->nodes.n_c);
  for (int i = 0; i < r->nodes.n_row; ++i) {
    r->now.uc[unknown_of(r, i)] = u[i];
    r->now.rc[unknown_of(r, i)] = force[i];
  }
}

/* Displacements of the contact nodes that were found with the interior. */
static status take_interior(const run *r) {
  int dim = r->msh->dim, next = 0;
  if (r->nodes.n_row == r->nodes.n_c) return OK;
  OWNED_NEW(double, w, r->nodes.n_c);
  surface_relative(r->surface, r->now.u, w);
  for (int i = 0; i < r->nodes.n; ++i) {
    int is_in = r->nodes.active.in == NULL ||
                (next < r->nodes.active.n_in && r->nodes.active.in[next] == i);
    next += is_in;
    for (int a = is_in ? r->nodes.rows : 0; a < dim; ++a)
      r->now.uc[dim * i + a] = w[dim * i + a];
  }
  return OK;
}

static double residual_of(run *r, double *u, double *rc) {
  return contact_residual(&r->problem.cp, run_rows(r, 0, u),
                          run_rows(r, 1, rc));
}

/* Start values: the last equilibrium, or what is put in its place, or the guess
 * if it is nearer. */
static void take_start(run *r) {
  const int own = r->course.shadow;
  double *u = r->old.uc, *rc = r->old.rc;
  if (r->solving.start_u != NULL && !own) {
    u = r->solving.start_u;
    rc = r->solving.start_r;
  }
  if (r->solving.guess_u != NULL && !own &&
      residual_of(r, r->solving.guess_u, r->solving.guess_r) <
          residual_of(r, u, rc)) {
    u = r->solving.guess_u;
    rc = r->solving.guess_r;
  }
  COPY(r->now.uc, u, r->nodes.n_c);
  COPY(r->now.rc, rc, r->nodes.n_c);
}

static int is_open(const run *r, const double *uc) {
  for (int i = 0; i < r->nodes.n; ++i)
    if (!(r->problem.gap[i] > uc[r->msh->dim * i])) return 0;
  return 1;
}

/*
 * A body in free motion: the solution without contact forces, if its residual,
 * written to *residual, is not above that. The tolerance of a method, relative
 * to the scale of the motion (contact_scale), would leave spurious contact
 * forces.
 */
static status drop_reactions(const run *r, double *residual, double *u,
                             double *rc) {
  OWNED double *q = NULL, *zero = NULL;
  if (r->course.shadow || r->problem.given != NULL || condensed_floating(r->c))
    return OK;
  PASS_NEW_REALS(r->nodes.n_row, &q, &zero);
  PASS(condensed_untouched(r->c, r->problem.cp.f, q));
  double left = contact_residual(&r->problem.cp, q, zero);
  if (!(left <= *residual)) return OK;
  *residual = left;
  COPY(u, q, r->nodes.n_row);
  CLEAR(rc, r->nodes.n_row);
  return OK;
}

/* The system of an iteration is counted. */
static void see_iteration(void *ctx, const solver_step *s) {
  run *r = ctx;
  observed_work *seen = &r->solving.seen;
  if (s->linear.unknowns > 0.0) ++seen->now;
  if (s->linear.unknowns > 0.0 && r->problem.cp.op != NULL) {
    ++seen->factors;
    seen->solves += s->linear.solves;
  }
  if (r->sink->iteration != NULL) r->sink->iteration(r->sink->ctx, s);
}

/* r->problem.cp solved as the effects rewrite it, from r->old into r->now. */
static status solve_posed(run *r) {
  const solver_listener listener = {see_iteration, r};
  const int before = r->solving.seen.now;
  contact_problem cp = r->problem.cp;
  take_start(r);
  double *own_u = run_rows(r, 0, r->now.uc), *u = own_u;
  double *rc = run_rows(r, 1, r->now.rc);
  double tol = r->solving.tol;
  if (is_open(r, r->old.uc) && largest_entry(r->nodes.n_c, r->old.rc) == 0.0)
    PASS(drop_reactions(r, &tol, u, rc));
  PASS(effects_rewrite(r, &cp, &u, rc));
  contact_solver_tolerance(r->solver, r->solving.tol);
  PASS_TIMED(STAGE_CONTACT,
             contact_solve(r->solver, &cp, r->course.shadow ? NULL : &listener,
                           u, rc, &r->solving.report));
  if (!r->course.shadow && r->solving.report.iterations > 0 &&
      r->solving.seen.now == before)
    r->solving.seen.untold = 1;
  r->problem.cp.bodies = contact_solver_bodies(r->solver, &cp);
  effects_restore(r, &r->problem.cp, own_u, rc);
  if (r->problem.given == NULL)
    contact_drop_roundings(&r->problem.cp, own_u, rc);
  put_rows(r, own_u, rc);
  if (is_open(r, r->now.uc) && largest_entry(r->nodes.n_c, r->now.rc) > 0.0) {
    PASS(drop_reactions(r, &r->solving.report.residual, own_u, rc));
    put_rows(r, own_u, rc);
  }
  return OK;
}

/* 1: a body that contact alone holds has lost all of its contact forces. */
static int is_let_go(const run *r) {
  static const double rounding = 1e-9;
  const contact_problem *cp = &r->problem.cp;
  const size_t n = r->nodes.n_c;
  return cp->floating && cp->B != NULL && r->solving.report.outcome > 0 &&
         r->problem.n_before == r->nodes.n_row &&
         largest_entry(n, r->now.rc) < rounding * largest_entry(n, r->old.rc);
}

/* r->now from the state u, rc [n_c]. */
static status solve_from(run *r, double *u, double *rc) {
  double *const start_u = r->solving.start_u;
  double *const start_r = r->solving.start_r;
  r->solving.start_u = u;
  r->solving.start_r = rc;
  const status st = solve_posed(r);
  r->solving.start_u = start_u;
  r->solving.start_r = start_r;
  return st;
}

/*
 * Friction may keep a body jammed without any load, where it is in equilibrium
 * without contact too. The state that belongs to the path of loads is the one
 * next to that of almost the same load, which is no solution to the tolerance.
 */
static status follow_load(run *r) {
  static const double least = 0x1p-20, most = 0x1p-2, margin = 0x1p10;
  const double almost = fmin(fmax(least, margin * r->solving.tol), most);
  const double *f = r->problem.cp.f;
  const solver_report empty = r->solving.report;
  const size_t bytes = r->nodes.n_c * sizeof *r->now.uc;
  OWNED double *near = NULL, *u = NULL, *rc = NULL;
  PASS_NEW(near, r->nodes.n_row);
  PASS_NEW_REALS(r->nodes.n_c, &u, &rc);
  for (int i = 0; i < r->nodes.n_row; ++i)
    near[i] = f[i] + almost * (r->problem.f_before[i] - f[i]);
  memcpy(u, r->now.uc, bytes);
  memcpy(rc, r->now.rc, bytes);
  r->problem.cp.f = near;
  const status st = solve_posed(r);
  r->problem.cp.f = f;
  PASS(st);
  const int steps = empty.iterations + r->solving.report.iterations;
  if (r->solving.report.outcome > 0) {
    memcpy(u, r->now.uc, bytes);
    memcpy(rc, r->now.rc, bytes);
  }
  PASS(solve_from(r, u, rc));
  r->solving.report.iterations += steps;
  return OK;
}

static status solve_contact(run *r) {
  PASS(solve_posed(r));
  return is_let_go(r) ? follow_load(r) : OK;
}

static int has_side_gap(const contact_surface *s) {
  for (int i = 0; i < s->n * (s->dim - 1); ++i)
    if (s->side_id[i] >= 0) return 1;
  return 0;
}

static void set_problem(run *r) {
  int all = r->nodes.rows > 1;
  r->problem.cp = (contact_problem){
      .dim = r->nodes.rows,
      .n = active_count(&r->nodes.active, r->nodes.n),
      .m = r->nodes.n_row,
      .A = condensed_matrix(r->c),
      .op = condensed_operator(r->c),
      .f = r->problem.f,
      .f_load =
          largest_entry(r->n_dof, r->loads.ud) > 0.0 ? r->problem.f_load : NULL,
      .gap = r->problem.gap,
      .ut0 = r->problem.ut0,
      .g0 = r->problem.limit == NULL ? NULL : r->problem.limit->g0,
      .B = r->problem.B,
      .side_gap = all && has_side_gap(r->surface) ? r->problem.side_gap : NULL,
      .held = all && surface_has_held(r->surface) ? r->surface->held : NULL,
      .floating = condensed_floating(r->c),
      .load = fmax(r->loads.largest, increment_strain_load(r)),
      .moved = largest_entry(r->nodes.n_c, r->old.uc)};
  r->problem.cp.n_motion = condensed_motions(r->c, &r->problem.cp.motion);
  if (r->nodes.active.in != NULL)
    active_cut(&r->nodes.active, &r->problem.part, &r->problem.cp);
  r->problem.cp.bodies = contact_solver_bodies(r->solver, &r->problem.cp);
}

static status load_at(run *r, double t) {
  TIMED(STAGE_LOAD);
  PASS(load_forces(r->m, r->msh, r->step, t, r->now.F));
  return load_prescribed(r->m, r->msh, r->step, t, r->loads.start, r->loads.ud);
}

/* Condensed load and contact problem under the forces F. */
static status pose(run *r, const double *F) {
  r->solving.report = (solver_report){.outcome = CONVERGED, .solver = "linear"};
  if (r->nodes.n > 0 && largest_entry(r->n_dof, r->loads.ud) > 0.0)
    PASS(condense_load(r->c, F, NULL, r->problem.f_load));
  PASS(condense_load(r->c, F, r->loads.ud, r->problem.f));
  if (r->nodes.n > 0) {
    PASS_TIMED(STAGE_SURFACE, surface_gap(r->surface, &r->faces.input, r->now.t,
                                          r->problem.gap, r->problem.side_gap));
    PASS(effects_pose(r, r->now.t));
    set_problem(r);
  }
  return OK;
}

double increment_free_load(const run *r, const double *F) {
  double most = 0.0;
  for (size_t i = 0; i < r->n_dof; ++i)
    if (!r->body.fixed[i] && fabs(F[i]) > most) most = fabs(F[i]);
  return most;
}

double increment_strain_load(const run *r) {
  if (r->strains.eigen.n == 0) return 0.0;
  return increment_free_load(r, r->strains.load);
}

status increment_load(run *r, double t) {
  r->now.t = t;
  PASS(load_at(r, t));
  return effects_load(r, t);
}

status increment_begin(run *r, double t) {
  PASS(increment_load(r, t));
  strains_collect(r);
  return OK;
}

status increment_pose(run *r, double t) {
  PASS(increment_begin(r, t));
  PASS(run_use(r, &r->elastic));
  return pose(r, strains_load(r));
}

/* Largest force on each row at the last equilibrium, *out NULL if it had other
 * rows. */
static status take_before(const run *r, double **out) {
  if (r->problem.n_before != r->nodes.n_row) return OK;
  PASS_NEW(*out, r->nodes.n_row);
  run_take_rows(r, r->old.rc, *out);
  for (int i = 0; i < r->nodes.n_row; ++i)
    (*out)[i] = fmax(fabs((*out)[i]), fabs(r->problem.f_before[i]));
  return OK;
}

/* Displacements of all nodes; a body that no force holds is put in place. */
static status recover(run *r, const double *F) {
  OWNED double *before = NULL;
  double *u = run_rows(r, 0, r->now.uc), *f = run_rows(r, 1, r->now.rc);
  if (r->nodes.n > 0) PASS(take_before(r, &before));
  const rest_scene at = {.cp = &r->problem.cp,
                         .c = r->c,
                         .n_dof = r->n_dof,
                         .F = F,
                         .old = r->old.u,
                         .now = r->now.u,
                         .before = before,
                         .tol = r->solving.tol};
  PASS(condense_recover(r->c, u, r->now.u));
  r->solving.placed = 0;
  if (r->nodes.n > 0 && r->solving.report.outcome > 0)
    PASS(rest_find(&at, u, f, &r->solving.placed));
  if (!r->solving.placed) return OK;
  put_rows(r, u, f);
  return condense_recover(r->c, u, r->now.u);
}

/* With the current contact nodes; *iterations so far. */
static status solve_with_nodes(run *r, const double *F, int *iterations) {
  PASS(pose(r, F));
  while (r->nodes.n > 0) {
    PASS(solve_contact(r));
    *iterations += r->solving.report.iterations;
    r->solving.report.iterations = *iterations;
    int again = 0;
    PASS(effects_found(r, &again));
    if (!again) break;
  }
  PASS(recover(r, F));
  return take_interior(r);
}

status increment_equilibrium(run *r, const double *F) {
  int iterations = 0;
  PASS(solve_with_nodes(r, F, &iterations));
  while (run_misses_nodes(r)) {
    PASS(run_add_nodes(r));
    PASS(solve_with_nodes(r, F, &iterations));
  }
  return OK;
}

status increment_solve(run *r, double t) {
  PASS(increment_begin(r, t));
  PASS(run_use(r, &r->elastic));
  return increment_equilibrium(r, strains_load(r));
}
