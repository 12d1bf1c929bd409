/*
 * contact_solve: one solver or AUTO on a problem, in a suitable form, with data
 * of the matrix reused (solver/solver.h).
 */
#include "solver/choice/choice.h"

#include "base/base.h"
#include "solver/local.h"

/* ---- final correction of a solution ---- */

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

/* Distance of an unknown to its bound, m; 0: it is not pressed. */
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
  COPY(s, r, cp->m);
  if (contact_has_stiffness(cp)) contact_apply(cp, move, v);
  for (int i = 0; i < cp->m; ++i) {
    if (contact_has_stiffness(cp) && move[i] != 0.0) s[i] += v[i];
    v[i] = u[i] + move[i];
  }
  return 1;
}

status polish_touch(const contact_problem *cp, double scale, double tol,
                    double *u, double *r, double *residual) {
  OWNED double *v = NULL, *s = NULL, *move = NULL;
  PASS_NEW_ALL(OF(v, cp->m), OF(s, cp->m), OF(move, cp->m));
  if (!touch(cp, u, r, v, s, move)) return OK;
  double reached = contact_residual_at(cp, scale, v, s);
  if (!(reached <= tol)) return OK;
  *residual = reached;
  COPY(u, v, cp->m);
  COPY(r, s, cp->m);
  return OK;
}

status polish_slip(const contact_problem *cp, double tol, int most, double *u,
                   double *r, int *sweeps) {
  double least = slip_misdirection(cp, u, r);
  *sweeps = 0;
  if (!(least > tol) || most <= 0 || cp->op != NULL) return OK;
  OWNED_NEW(double, at, 2 * cp->m);
  OWNED_OF(node_blocks, blocks, node_blocks_new(cp, &blocks));
  relaxation s = {cp, blocks, .u = at, .r = at + cp->m, .omega = 1.0};
  COPY(s.u, u, cp->m);
  COPY(s.r, r, cp->m);
  relaxation_start(&s);
  relaxation_refresh(&s);
  while (least > tol && *sweeps < SWEEPS && *sweeps < most) {
    relaxation_sweep(&s, 0);
    relaxation_refresh(&s);
    ++*sweeps;
    double now = slip_misdirection(cp, s.u, s.r);
    if (!(now < least) || !(contact_residual(cp, s.u, s.r) <= tol)) continue;
    least = now;
    COPY(u, s.u, cp->m);
    COPY(r, s.r, cp->m);
  }
  return OK;
}

status contact_solver_new(const solver_choice *choice, contact_solver **out) {
  size_t size = 1;
  MAKES(contact_solver, s, out);
  s->choice = *choice;
  for (int i = 0; solver_list[i] != NULL; ++i)
    if (solver_list[i]->param_size > size) size = solver_list[i]->param_size;
  s->param_size = size;
  PASS_GET(s->param, memory_new(1, size));
  return OK;
}

/* A (or W) has changed: discard factors. */
static void forget_factors(contact_solver *s) {
  for (int i = 0; i <= N_SOLVER; ++i) FORGET(s->work[i]);
  FORGET(s->fixed);
  FORGET(s->path);
  RELEASE(s->other.matrix, s->other.load);
  s->other = (other_form){0};
  s->inverse_wanted = 0;
  normal_form_free(&s->normal);
  anchor_free(&s->held);
  FORGET(s->bodies);
  RELEASE(s->best_u, s->best_r, s->full);
  s->best_u = s->best_r = s->full = NULL;
  s->last = (contact_problem){0};
  s->from = NULL;
}

void contact_solver_free(contact_solver **p) {
  contact_solver *s = *p;
  if (s == NULL) return;
  forget_factors(s);
  RELEASE(s->param, s);
}

void contact_solver_tolerance(contact_solver *s, double tol) {
  s->choice.tol = tol;
}

const char *contact_solver_log(const contact_solver *s) { return s->log; }

static int fits(const contact_solver *s, const contact_problem *cp) {
  const contact_problem *of = &s->last;
  return of->A == cp->A && of->op == cp->op && of->W == cp->W &&
         of->blocks == cp->blocks && of->m == cp->m && of->n == cp->n &&
         s->best_u != NULL;
}

static status fit(contact_solver *s, const contact_problem *cp) {
  if (fits(s, cp)) return OK;
  archive *from = s->best_u == NULL ? s->from : NULL;
  forget_factors(s);
  s->from = from;
  if (from != NULL) {
    archive_go(from, s->group);
    const status st = normal_form_keep(&s->normal, from);
    archive_go(from, "");
    PASS(st);
  }
  PASS(contact_bodies_new(cp, &s->bodies));
  PASS_NEW_ALL(OF(s->best_u, cp->m), OF(s->best_r, cp->m));
  s->last = *cp;
  return OK;
}

/* ---- saved data ------------------------------------------------- */

status contact_solver_keep(contact_solver *s, archive *a) {
  if (archive_reads(a)) {
    forget_factors(s);
    s->from = a;
    snprintf(s->group, sizeof s->group, "%s", archive_group(a));
    return OK;
  }
  if (s->best_u == NULL && s->from != NULL)
    return archive_pass_on(s->from, s->group, a);
  int there = 0;
  for (int i = 0; i < N_SOLVER; ++i) {
    PASS(attempt_archive(s, i, a));
    if (s->work[i] != NULL) there |= 1 << i;
  }
  PASS(archive_ints(a, "works", &there, 1));
  return normal_form_keep(&s->normal, a);
}

/* 1: no force is needed: of a compliance whose nodes do not reach their
 * obstacles, or of a stiffness without load that nothing pressed before, r. */
static int needs_no_force(const contact_problem *cp, const double *r) {
  const int stiffness = contact_has_stiffness(cp);
  for (int dof = 0; dof < cp->m; ++dof) {
    const double *load = cp->f + dof;
    if ((stiffness ? 0.0 : *load) > contact_bound(cp, dof)) return 0;
    if (!stiffness) continue;
    if (*load != 0.0) return 0;
    if (r[dof] < 0.0 && contact_bound(cp, dof) < HUGE_VAL) return 0;
    if (contact_held(cp, dof) && contact_stick(cp, dof) != 0.0) return 0;
  }
  for (int i = 0; i < cp->n && cp->g0 != NULL; ++i)
    if (cp->g0[i] > 0.0) return 0;
  return 1;
}

/* 1: the solution is known without a solver: no node, no load, start solves, no
 * node reaches its obstacle. */
static int known_answer(const contact_solver *s, const contact_problem *cp,
                        double *u, double *r, solver_report *rep) {
  double tol = s->choice.tol, scale = s->scale;
  *rep = (solver_report){.outcome = CONVERGED, .solver = "none"};
  if (cp->m == 0) return 1;
  rep->residual = contact_residual_at(cp, scale, u, r);
  if (rep->residual <= tol) return 1;
  if (scale == 0.0 || needs_no_force(cp, r)) {
    CLEAR(r, cp->m);
    CLEAR(u, cp->m);
    if (!contact_has_stiffness(cp)) COPY(u, cp->f, cp->m);
    rep->residual = contact_residual_at(cp, scale, u, r);
    return rep->residual <= tol;
  }
  if (isnan(rep->residual)) {
    cold_start(cp, u, r);
    rep->residual = contact_residual_at(cp, scale, u, r);
  }
  if (isnan(rep->residual) || !(scale < HUGE_VAL)) {
    rep->outcome = STOPPED_NAN;
    return 1;
  }
  return 0;
}

/* The final correction, within the iterations allowed. */
static status polish(const contact_solver *s, const contact_problem *cp,
                     double *u, double *r, solver_report *rep) {
  double tol = s->choice.tol;
  int sweeps = 0, asked = s->choice.max_iter;
  int most = asked > 0 ? asked - rep->iterations : INT_MAX;
  PASS(polish_touch(cp, s->scale, tol, u, r, &rep->residual));
  PASS(polish_slip(cp, tol, most, u, r, &sweeps));
  rep->iterations += sweeps;
  if (sweeps > 0) rep->residual = contact_residual_at(cp, s->scale, u, r);
  return OK;
}

const contact_bodies *contact_solver_bodies(const contact_solver *s,
                                            const contact_problem *cp) {
  return s != NULL && fits(s, cp) ? s->bodies : NULL;
}

static status solve_apart(contact_solver *s, const contact_problem *cp,
                          double *u, double *r, solver_report *rep) {
  s->scale = contact_scale(cp);
  if (known_answer(s, cp, u, r, rep)) return OK;
  if (s->choice.ops == NULL) {
    PASS(auto_solve(s, cp, u, r, rep));
  } else {
    attempt a = {s->choice.ops, s->choice.param, PLAIN, s->choice.max_iter,
                 NULL};
    PASS(attempt_run(s, cp, &a, u, r, rep));
    attempt_check(s, cp, u, r, rep);
    PASS(attempt_prove(s, cp, rep));
  }
  /* A NaN of a method says nothing about the problem. */
  if (isfinite(rep->residual) &&
      (rep->outcome == STOPPED_NAN || rep->outcome == STOPPED_SINGULAR))
    rep->outcome = STOPPED_STAGNATION;
  if (rep->outcome == CONVERGED) PASS(polish(s, cp, u, r, rep));
  return OK;
}

status contact_solve(contact_solver *s, const contact_problem *cp,
                     const solver_listener *listener, double *u, double *r,
                     solver_report *rep) {
  status st = OK;
  double start = timer_cpu();
  contact_problem apart = *cp;
  s->log[0] = '\0';
  s->sought = s->proved = 0;
  s->listener = listener;
  *rep = (solver_report){.outcome = RUNNING};
  TRY(fit(s, cp));
  if (cp->bodies == NULL) apart.bodies = s->bodies;
  TRY(solve_apart(s, &apart, u, r, rep));
done:
  rep->cpu = timer_cpu() - start;
  return st;
}
