/*
 * Error of the steps: the path of slip and the inelastic strains depend on the
 * increments. Beside the run goes a second one of half the increments, contact
 * forces, slip and inelastic strains its own; the two meet at the end of each
 * increment, where the loads are the same.
 *
 * Without inelastic strains their difference d has the energy d' A d of the
 * condensed stiffness. With them the stresses differ by E (B du - de^i), whose
 * energy counts against that of the stresses, and the strains by B du, against
 * the strains: at constant stress a body creeps all the same. The larger of the
 * two relative differences is told.
 *
 * The error of the run is that difference times 2^p/(2^p - 1) for an integrator
 * of order p (Richardson), where nothing rubs; zones of stick and slip that
 * grow lie between order 1 and 2: 5/3, or more for an integrator of order 1.
 */
#include "run/visco.h"

#include "base/memory.h"
#include "base/timer.h"

#include <math.h>
#include <string.h>

static const double EXTRAPOLATION = 5.0 / 3.0; /* -, of growing zones         */
static const double STRAIGHT = 10.0; /* -, of the tolerance of the solver     */

typedef struct waypoint { /* what an increment starts from, of one path       */
  start_point start;
  flow_state flow; /* of the points whose law flows; empty: none              */
} waypoint;

struct finer_path {
  int lost; /* 1: it found no equilibrium                                   */
  int measured; /* 1: "error" is that of the attempt                          */
  double error; /* sqrt(J)                                                    */
  int flows; /* 1: made in a *VISCO step                                     */
  waypoint at, middle, end; /* accepted; of the attempt now made */
  double *d, *Ad; /* [m] difference of the paths, m; N               */
  double *u, *e0; /* [dim*n_node] m, [ns*eigen.n] at the end; NULL: no law
                     flows */
};

static status waypoint_new(const run *r, waypoint *w) {
  status st = OK;
  TRY(start_point_new(r, &w->start));
  if (r->strains.visco != NULL)
    TRY(flow_state_new(&r->strains.visco->x, &w->flow));
done:
  return st;
}

static void waypoint_free(waypoint *w) {
  start_point_free(&w->start);
  flow_state_free(&w->flow);
}

static void waypoint_copy(const run *r, const equilibrium *e, waypoint *w) {
  if (e == &r->old && r->strains.visco != NULL)
    flow_state_copy(&r->strains.visco->x, &r->strains.visco->old, &w->flow);
  start_point_copy(r, e, &w->start);
}

static status path_new(const run *r, finer_path **out) {
  status st = OK;
  finer_path *p = NULL;
  NEW(p, 1);
  *out = p;
  p->flows = r->step->kind == STEP_VISCO;
  TRY(waypoint_new(r, &p->at));
  TRY(waypoint_new(r, &p->middle));
  TRY(waypoint_new(r, &p->end));
  NEW(p->d, r->nodes.n_c);
  NEW(p->Ad, r->nodes.n_c);
  if (r->strains.visco != NULL) {
    NEW(p->u, r->n_dof);
    NEW(p->e0, visco_at(r, r->strains.eigen.n));
  }
  waypoint_copy(r, &r->old, &p->at);
done:
  return st;
}

static void path_free(finer_path *p) {
  if (p == NULL) return;
  waypoint_free(&p->at);
  waypoint_free(&p->middle);
  waypoint_free(&p->end);
  memory_free(p->d);
  memory_free(p->Ad);
  memory_free(p->u);
  memory_free(p->e0);
  memory_free(p);
}

/* The equilibrium at t from where "from" stands, into "to". */
static status half(run *r, waypoint *from, double t, waypoint *to) {
  status st = OK;
  equilibrium keep = start_point_use(r, &from->start);
  if (r->step->kind == STEP_VISCO)
    st = visco_advance_from(r, &from->flow, t, &to->flow);
  else
    st = increment_solve(r, t);
  r->old = keep;
  TRY(st);
  waypoint_copy(r, &r->now, to);
done:
  return st;
}

/* Only slip in increments and inelastic strains remember their path. */
int path_exists(const run *r) {
  if (effects_sum_up(r) != NULL) return 0;
  int kind = r->step->kind, slips = r->nodes.n > 0 && r->problem.ut0 != NULL;
  if (kind == STEP_VISCO) return slips || r->strains.visco != NULL;
  return slips && kind == STEP_QUASISTATIC;
}

/* Both halves of the increment that ends at t; lost where there is none. */
static status try_halves(run *r, finer_path *p, double t) {
  status st = OK;
  p->measured = 0;
  if (p->lost) return OK;
  TRY(half(r, &p->at, 0.5 * (p->at.start.t + t), &p->middle));
  p->lost = r->solving.report.outcome <= 0;
  if (p->lost) return OK;
  TRY(half(r, &p->middle, t, &p->end));
  p->lost = r->solving.report.outcome <= 0;
  if (p->lost || p->u == NULL) return OK;
  memcpy(p->u, r->now.u, r->n_dof * sizeof *p->u);
  memcpy(p->e0, r->strains.eigen.e0,
         visco_at(r, r->strains.eigen.n) * sizeof *p->e0);
done:
  return st;
}

status path_try(run *r, double t) {
  status st = OK;
  double cpu = timer_cpu();
  if (!r->step->time_error || !path_exists(r)) return OK;
  timer_enter_whole(STAGE_TIME_ERROR);
  r->course.beside = 1;
  if (r->paths.path != NULL &&
      (r->paths.path->at.start.t != r->old.t ||
       r->paths.path->flows != (r->step->kind == STEP_VISCO)))
    path_restart(r);
  if (r->paths.path == NULL) TRY(path_new(r, &r->paths.path));
  TRY(try_halves(r, r->paths.path, t));
done:
  r->course.beside = 0;
  timer_leave(STAGE_TIME_ERROR);
  r->errors.time_error.cpu += timer_cpu() - cpu;
  return st;
}

/* Energy norm of the difference of the paths without inelastic strains,
 * sqrt(J). */
static double condensed_difference(const run *r, finer_path *p) {
  double square = 0.0;
  for (int k = 0; k < r->nodes.n_c; ++k)
    p->d[k] = r->now.uc[k] - p->end.start.uc[k];
  contact_product(r->nodes.n_c, condensed_matrix(r->c), p->d, p->Ad);
  for (int k = 0; k < r->nodes.n_c; ++k) square += p->d[k] * p->Ad[k];
  return sqrt(fmax(square, 0.0));
}

/* sqrt(2 E) of displacements and strains without stress (NULL: none). */
static double field_norm(const run *r, const double *u, const double *e0) {
  domain d = r->body.d;
  eigenstrain x = r->strains.eigen;
  x.e0 = e0;
  d.eigen = e0 != NULL ? &x : NULL;
  return sqrt(2.0 * fmax(domain_strain_energy(&d, u), 0.0));
}

/* The same with them: as large as the larger relative difference. p->u and
 * p->e0 become differences. */
static double field_difference(const run *r, finer_path *p) {
  double stress = sqrt(2.0 * fmax(r->now.energy.strain, 0.0));
  double strain = field_norm(r, r->now.u, NULL);
  for (size_t k = 0; k < r->n_dof; ++k) p->u[k] -= r->now.u[k];
  for (size_t k = 0; k < visco_at(r, r->strains.eigen.n); ++k)
    p->e0[k] -= r->strains.eigen.e0[k];
  double of_stress = field_norm(r, p->u, p->e0);
  double of_strain = field_norm(r, p->u, NULL);
  return strain > 0.0 ? fmax(of_stress, of_strain * (stress / strain))
                      : of_stress;
}

/* From the difference to half the increments to the error. */
static double extrapolation(const run *r) {
  const scheme *of = r->step->integrator;
  if (r->step->kind != STEP_VISCO || r->strains.visco == NULL)
    return EXTRAPOLATION;
  int order = of->has_theta && r->step->theta == 0.5 ? 2 : of->order;
  if (order < 2) return 2.0;
  return r->problem.ut0 != NULL ? EXTRAPOLATION : 4.0 / 3.0;
}

/* The attempt is accepted: the next one starts at its end. */
static void advance(finer_path *p) {
  waypoint w = p->at;
  p->at = p->end;
  p->end = w;
}

static const char *why_no_path(const run *r) {
  if (effects_sum_up(r) != NULL) return effects_sum_up(r);
  if (r->step->kind == STEP_STATIC) return "one static problem, no path";
  return r->step->kind == STEP_VISCO ? "no friction, no law flows: no path"
                                     : "no friction, no path";
}

double path_total(const run *r) { return r->paths.before + r->paths.now; }

double path_measure(run *r) {
  finer_path *p = r->paths.path;
  if (p == NULL || p->lost) return HUGE_VAL;
  if (!p->measured)
    p->error = extrapolation(r) * (p->u != NULL ? field_difference(r, p)
                                                : condensed_difference(r, p));
  p->measured = 1;
  return r->paths.before + p->error;
}

void path_keep_on(run *r) {
  if (r->paths.path != NULL) r->paths.path->lost = 0;
}

void path_compare(run *r) {
  error_share *e = &r->errors.time_error;
  finer_path *p = r->paths.path;
  e->asked = r->step->time_error;
  e->relative = 0.0;
  e->why = NULL;
  if (!e->asked) return;
  if (!path_exists(r)) {
    e->why = why_no_path(r);
    if (effects_sum_up(r) != NULL) e->relative = NAN;
    return;
  }
  if (p == NULL || (!p->lost && p->end.start.t != r->now.t)) {
    e->why = "the body answers at once";
    return;
  }
  if (p->lost) {
    e->relative = NAN;
    e->why = "no equilibrium in half an increment";
    return;
  }
  double energy = r->now.energy.strain;
  double norm = path_measure(r);
  r->paths.now = p->error;
  if (norm > 0.0) e->relative = norm / sqrt(norm * norm + 2.0 * energy);
  if (e->relative <= STRAIGHT * r->solving.tol)
    e->why = "the path is straight: half the increments give the same";
  advance(p);
}

static status keep_waypoint(const run *r, waypoint *w, archive *a) {
  status st = OK;
  size_t m = (size_t)r->nodes.n_c;
  TRY(archive_reals(a, "path_t", &w->start.t, 1));
  TRY(archive_reals(a, "path_uc", w->start.uc, m));
  TRY(archive_reals(a, "path_rc", w->start.rc, m));
  TRY(archive_reals(a, "path_motion", w->start.motion, m));
  if (r->strains.visco != NULL)
    TRY(visco_keep_flow(&r->strains.visco->x, &w->flow, a, "path_flow"));
done:
  return st;
}

status path_keep(run *r, archive *a) {
  status st = OK;
  int there = r->paths.path != NULL;
  TRY(archive_ints(a, "path", &there, 1));
  if (archive_reads(a)) path_restart(r);
  TRY(archive_reals(a, "path_before", &r->paths.before, 1));
  TRY(archive_reals(a, "path_error", &r->paths.now, 1));
  if (!there) goto done;
  if (r->paths.path == NULL) TRY(path_new(r, &r->paths.path));
  TRY(archive_ints(a, "path_lost", &r->paths.path->lost, 1));
  TRY(keep_waypoint(r, &r->paths.path->at, a));
done:
  return st;
}

void path_restart(run *r) {
  path_free(r->paths.path);
  r->paths.path = NULL;
  r->paths.before += r->paths.now;
  r->paths.now = 0.0;
}
