/*
 * Inelastic strains over an increment: the equilibria that the integrators of
 * src/material/scheme require, their steps and limits (CPR98 3.14-3.20: each
 * stress of a given e^i is one contact problem, with the slip counted from the
 * last accepted increment).
 */
#include "run/visco.h"

#include "base/system/blas.h"
#include "model/check/check.h"

/* The error of the midpoint rule in its difference to the trapezoidal one. */
static const double SIMPSON = 3.0;

/* The laws of the points have few rows, the contact between their calls as
 * many as there are. */
static void leave_laws(const run *r) {
  timer_leave(STAGE_INELASTIC);
  blas_rows(r->problem.cp.m);
}

static void enter_laws(void) {
  timer_enter(STAGE_INELASTIC);
  blas_rows(0);
}

static status equilibrium_of(void *ctx, flow_state *s, int *settled) {
  run *r = ctx;
  leave_laws(r);
  const status st = increment_solve(r, s->t);
  enter_laws();
  PASS(st);
  visco_temperatures(r, &r->now, s);
  visco_strains(r, &r->now, s);
  *settled = r->solving.report.outcome > 0;
  return OK;
}

static status begin(void *ctx, flow_state *s) {
  run *r = ctx;
  leave_laws(r);
  status st = increment_load(r, s->t);
  enter_laws();
  if (st == OK) visco_temperatures(r, &r->now, s);
  return st;
}

/* The iteration on stresses may not converge below the residual of contact:
 * TOL=BALANCED does not loosen that, and the iteration may lower it. */
static status linear(void *ctx, const flow_tangent *law, flow_state *s,
                     int *settled) {
  run *r = ctx;
  const double tol = r->solving.tol;
  leave_laws(r);
  r->solving.tol = r->step->solver.tol;
  if (law->tol > 0.0) r->solving.tol = fmin(r->solving.tol, law->tol);
  status st = tangent_solve(r, law);
  r->solving.tol = tol;
  enter_laws();
  if (st == OK) visco_strains(r, &r->now, s);
  *settled = r->solving.report.outcome > 0;
  return st;
}

/* Sums are valid if they contain all contributions of an increment, except
 * those at the start, which count from zero. */
static status constant(void *ctx, const flow_tangent *law, const scheme_call *a,
                       int *settled) {
  run *r = ctx;
  visco *v = r->strains.visco;
  leave_laws(r);
  status st = tangent_step(r, law, a);
  enter_laws();
  *settled = r->solving.report.outcome > 0;
  v->sums.known = r->body.moduli.n_own == 0 &&
                  (r->body.d.cluster == NULL || v->x.n == r->strains.eigen.n) &&
                  (r->course.total_no > 0 || strains_kept(r) == 0);
  return st;
}

static double rounding(void *ctx) {
  return strains_rounding(ctx, strains_lost(ctx));
}

void visco_rest(run *r) {
  visco *v = r->strains.visco;
  if (v != NULL) flow_state_copy(&v->x, &v->old, &v->now);
}

status visco_begin_step(run *r) {
  visco *v = r->strains.visco;
  if (v == NULL) return OK;
  TIMED(STAGE_INELASTIC);
  visco_temperatures(r, &r->old, &v->old);
  visco_strains(r, &r->old, &v->old);
  v->old.t = r->old.t;
  v->sums.known = 0;
  return OK;
}

/* Length of the step to t; one that differs by the rounding of the times only
 * from one before is the same, and so are its matrices. */
static double step_length(run *r, double t) {
  visco *v = r->strains.visco;
  double dt = t - r->old.t, rounding = 4e-16 * (fabs(t) + fabs(r->old.t));
  for (int i = 0; i < SLOTS; ++i)
    if (fabs(v->length[i] - dt) <= rounding) return v->length[i];
  v->length[v->n_length++ % SLOTS] = dt;
  return dt;
}

static status advance(run *r, double t) {
  visco *v = r->strains.visco;
  const flow_body body = {r, equilibrium_of, begin, linear, constant, rounding};
  scheme_step p = {.t = t,
                   .dt = step_length(r, t),
                   .theta = r->step->visco.theta,
                   .fastest = step_fastest(r->step, t, t - r->old.t),
                   .initial = r->step->visco.initial,
                   .tol = r->step->solver.tol};
  v->result = (scheme_result){.settled = 1, .error = -1.0};
  v->old.t = r->old.t;
  v->sums.known = 0;
  const scheme_call call = {&v->x,   &p,      &body,     v->work,
                            &v->old, &v->now, &v->result};
  const int rows = blas_rows(0);
  const status st = r->step->visco.integrator->advance(&call);
  blas_rows(rows);
  PASS(st);
  v->now.t = t;
  if (v->sums.known && r->now.e0 != NULL)
    r->strains.eigen.e0 = r->now.e0;
  else
    strains_collect(r);
  v->stages = fmax(v->stages, v->result.unstable);
  if (!v->result.settled && r->solving.report.outcome > 0)
    r->solving.report.outcome =
        v->result.unstable > 0.0 ? STOPPED_UNSTABLE : STOPPED_ITERATIONS;
  return OK;
}

status visco_between(run *r, double t, flow_state *s, double *dissipated) {
  visco *v = r->strains.visco;
  const scheme_step p = {
      .t = r->now.t, .dt = r->now.t - v->old.t, .theta = r->step->visco.theta};
  const scheme_call call = {&v->x,   &p,      NULL,      v->work,
                            &v->old, &v->now, &v->result};
  TIMED(STAGE_INELASTIC);
  s->t = t;
  PASS(r->step->visco.integrator->between(&call, s));
  return scheme_dissipated(&call, t, dissipated);
}

/* v->now at an equilibrium whose inelastic strains it has. */
static void take_strains(run *r, const equilibrium *e) {
  visco *v = r->strains.visco;
  v->now.t = e->t;
  v->sums.known = 0;
  visco_temperatures(r, e, &v->now);
  visco_strains(r, e, &v->now);
}

void visco_take(run *r) { take_strains(r, &r->now); }

status visco_advance(run *r, double t) {
  if (r->strains.visco == NULL) return increment_solve(r, t);
  TIMED(STAGE_INELASTIC);
  return advance(r, t);
}

/* From another state than that of the run, which stays. */
static status advance_from(run *r, flow_state *from, double t) {
  visco *v = r->strains.visco;
  flow_state keep = v->old;
  v->old = *from;
  status st = advance(r, t);
  *from = v->old;
  v->old = keep;
  v->sums.known = 0;
  return st;
}

status visco_advance_from(run *r, flow_state *from, double t, flow_state *to) {
  visco *v = r->strains.visco;
  if (v == NULL) return increment_solve(r, t);
  TIMED(STAGE_INELASTIC);
  PASS(advance_from(r, from, t));
  flow_state_copy(&v->x, &v->now, to);
  return OK;
}

status visco_settle_from(run *r, const flow_state *from, double t,
                         flow_state *to) {
  visco *v = r->strains.visco;
  if (v != NULL) flow_state_copy(&v->x, from, &v->now);
  PASS(increment_solve(r, t));
  if (v == NULL) return OK;
  TIMED(STAGE_INELASTIC);
  take_strains(r, &r->now);
  flow_state_copy(&v->x, &v->now, to);
  return OK;
}

status start_point_new(const run *r, start_point *p) {
  PASS_NEW_REALS(r->nodes.n_c, &p->uc, &p->rc);
  if (r->old.motion != NULL) PASS_NEW(p->motion, r->nodes.n_c);
  return OK;
}

void start_point_copy(const run *r, const equilibrium *e, start_point *p) {
  p->t = e->t;
  if (r->nodes.n_c == 0) return;
  COPY(p->uc, e->uc, r->nodes.n_c);
  COPY(p->rc, e->rc, r->nodes.n_c);
  if (p->motion != NULL) COPY(p->motion, e->motion, r->nodes.n_c);
}

equilibrium start_point_use(run *r, const start_point *p) {
  equilibrium keep = r->old;
  r->old.t = p->t;
  r->old.uc = p->uc;
  r->old.rc = p->rc;
  r->old.motion = p->motion;
  return keep;
}

/* From r->now, which is temporarily the accepted state, to t. */
static status second_half(run *r, double t) {
  visco *v = r->strains.visco;
  OWNED_PARTS(start_point, p, start_point_new(r, &p));
  start_point_copy(r, &r->now, &p);
  flow_state_copy(&v->x, &v->now, &v->middle);
  equilibrium keep = start_point_use(r, &p);
  const status st = advance_from(r, &v->middle, t);
  r->old = keep;
  return st;
}

/* Two halves into v->fine[ns*n]; r->solving.report says if they were found. */
static status two_halves(run *r, double t) {
  visco *v = r->strains.visco;
  size_t n = visco_at(r, v->x.n);
  if (v->fine == NULL) {
    OWNS(v);
    PASS_NEW(v->fine, n);
    PASS(flow_state_new(&v->x, &v->middle));
  }
  r->course.shadow = 1;
  status st = advance(r, 0.5 * (r->old.t + t));
  if (st == OK && r->solving.report.outcome > 0) st = second_half(r, t);
  r->course.shadow = 0;
  PASS(st);
  COPY(v->fine, v->now.ei, n);
  return OK;
}

int visco_order(const step *s) {
  const scheme *of = s->visco.integrator;
  return of->has_theta && s->visco.theta == 0.5 ? 2 : of->order;
}

/* The difference to the halves, with Richardson's factor. */
static double halves_error(const run *r) {
  visco *v = r->strains.visco;
  double power = ldexp(1.0, visco_order(r->step));
  size_t n = visco_at(r, v->x.n);
  for (size_t i = 0; i < n; ++i) v->fine[i] -= v->now.ei[i];
  return power / (power - 1.0) * flow_norm(&v->x, v->fine);
}

status visco_turning(const run *r, double **d) {
  const visco *v = r->strains.visco;
  const scheme *of = r->step->visco.integrator;
  const int blind = of->limit > 0.0
                        ? of->order == 1
                        : !of->linear_only && r->step->visco.theta < 1.0;
  *d = NULL;
  if (!blind) return OK;
  PASS_NEW(*d, visco_at(r, v->x.n));
  return flow_turning(&v->x, &v->old, &v->now, *d);
}

/* The larger of both differences. */
static status blind_error(const run *r, double *error) {
  *error = halves_error(r);
  OWNED_OF(double, d, visco_turning(r, &d));
  if (d != NULL)
    *error = fmax(*error, flow_norm(&r->strains.visco->x, d) /
                              (visco_order(r->step) > 1 ? SIMPSON : 1.0));
  return OK;
}

/* Root mean square of the elastic strains of v->now. */
static status elastic_norm(const visco *v, double *norm) {
  double sum = v->sums.elastic;
  if (!v->sums.known) {
    sum = 0.0;
    PASS(flow_add_elastic(&v->x, &v->now, 0, v->x.n, &sum));
  }
  *norm = flow_root(&v->x, sum);
  return OK;
}

status visco_try(run *r, double t, double *error) {
  TIMED(STAGE_INELASTIC);
  visco *v = r->strains.visco;
  int estimates = r->step->visco.integrator->estimates;
  *error = HUGE_VAL;
  if (!estimates) PASS(two_halves(r, t));
  if (!estimates && r->solving.report.outcome <= 0) return OK;
  PASS(advance(r, t));
  if (r->solving.report.outcome <= 0) return OK;
  double norm = 0.0;
  if (estimates)
    *error = v->result.error;
  else
    PASS(blind_error(r, error));
  PASS(elastic_norm(v, &norm));
  if (*error > 0.0) *error /= fmax(v->largest, norm);
  return OK;
}

status visco_level(run *r, double dt, int *level) {
  visco *v = r->strains.visco;
  double rate;
  *level = 0;
  if (v == NULL || r->step->kind != STEP_VISCO || !step_has_limit(r->step))
    return OK;
  TIMED(STAGE_INELASTIC);
  PASS(flow_fastest(&v->x, &v->old, dt, &rate));
  *level =
      step_level(r->m, r->step, r->old.t, dt, fmax(rate, v->stages),
                 v->reported.ringing != r->step && !flow_is_constant(&v->x));
  v->reported.ringing = r->step;
  if (*level < 0)
    RAISE(ERR_DECK, "step %d: the increment is not stable", run_step_id(r) + 1);
  return OK;
}

status visco_energies(run *r, energies *e) {
  visco *v = r->strains.visco;
  TIMED(STAGE_INELASTIC);
  e->dissipated += v->result.dissipated;
  e->stored = v->sums.stored;
  if (v->sums.known) return OK;
  e->stored = 0.0;
  return flow_add_stored(&v->x, &v->now, 0, v->x.n, &e->stored);
}

status visco_accept(run *r) {
  visco *v = r->strains.visco;
  double norm = 0.0;
  const int flows = r->step->kind == STEP_VISCO && r->old.t > r->now.t;
  v->result.dissipated = 0.0;
  v->stages = 0.0;
  TIMED(STAGE_INELASTIC);
  if (!flows) take_strains(r, &r->old);
  PASS(elastic_norm(v, &norm));
  v->largest = fmax(v->largest, norm);
  if (flows && r->errors.left > 0.0) visco_warn_locking(r);
  const flow_state old = v->old;
  v->old = v->now;
  v->now = old; /* to be overwritten */
  v->sums.known = 0;
  return OK;
}

status visco_keep_flow(const flow *x, flow_state *s, archive *a,
                       const char *group) {
  size_t n = (size_t)x->ns * x->n;
  IN_GROUP(a, group);
  PASS(archive_reals(a, "t", &s->t, 1));
  PASS(archive_reals(a, "e", s->e, n));
  PASS(archive_reals(a, "ei", s->ei, n));
  PASS(archive_reals(a, "sigma", s->sigma, n));
  PASS(archive_reals(a, "alpha", s->alpha, x->alpha_at[x->n]));
  return archive_reals(a, "temperature", s->temperature, x->n);
}

status visco_keep(run *r, archive *a) {
  visco *v = r->strains.visco;
  int reported = v->reported.ringing == r->step;
  PASS(visco_keep_flow(&v->x, &v->old, a, "old"));
  PASS(visco_keep_flow(&v->x, &v->now, a, "now"));
  PASS(archive_reals(a, "largest", &v->largest, 1));
  PASS(archive_reals(a, "stages", &v->stages, 1));
  PASS(archive_reals(a, "length", v->length, SLOTS));
  PASS(archive_bytes(a, "n_length", &v->n_length, sizeof v->n_length));
  PASS(archive_reals(a, "asked", &v->x.tally->asked, 1));
  PASS(archive_reals(a, "resting", &v->x.tally->resting, 1));
  PASS(archive_ints(a, "told", &reported, 1));
  v->reported.ringing = reported ? r->step : NULL;
  PASS(archive_ints(a, "told_locking", &v->reported.locking, 1));
  PASS(archive_ints(a, "told_stuck", &v->reported.stuck, 1));
  return tangent_keep(r, a);
}
