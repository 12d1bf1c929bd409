/*
 * Error of the steps: the path of slip, the inelastic strains and wear depend
 * on the increments. A shadow run of half the increments has its own contact
 * forces, slip, inelastic strains and depths; the two meet at the end of each
 * increment, where the loads are the same.
 *
 * Without inelastic strains their difference d has the energy d' A d of the
 * condensed stiffness. With them the stresses differ by E (B du - de^i), whose
 * energy is relative to that of the stresses, and the strains by B du, relative
 * to the strains: at constant stress a body still creeps. The larger of the two
 * relative differences is reported; of a body that has no stress left, that of
 * the strains, with those of the steps before. Depths that differ count in the
 * same manner: a load that moves a body on wears it at constant forces.
 *
 * The error of the run is that difference times 2^p/(2^p - 1) for an integrator
 * of order p (Richardson), without friction; zones of stick and slip that grow
 * lie between order 1 and 2: 5/3, or more for an integrator of order 1, as
 * wear.
 */
#include "effects/plan/effect.h"
#include "effects/shared.h"
#include "run/history/loop.h"
#include "run/visco.h"

#include <cblas.h>

#include "run/column_row.h"

static const double EXTRAPOLATION = 5.0 / 3.0; /* -, of growing zones */
static const double STRAIGHT = 10.0; /* -, of the tolerance of the solver */

/* What an increment starts from, of one path. */
typedef struct waypoint {
  start_point start;
  flow_state flow; /* of the points whose law flows; empty: none */
  double *depth;   /* of wear_depths, or NULL */
} waypoint;

/* Errors, sqrt(J). */
typedef struct path_error {
  double norm;   /* of the stresses, or as large relative to them */
  double strain; /* of the strains, of laws that flow */
} path_error;

typedef struct finer_path {
  const char *lost; /* why there is none; NULL: there is one */
  int measured;     /* 1: "error" is that of the attempt */
  path_error error;
  double factor;    /* largest of extrapolation() so far */
  int sudden;       /* 1: what is applied at the start of the step is to come */
  waypoint at, end; /* accepted; of the attempt now made */
  double *d, *Ad;   /* [m] difference of the paths, m; N */
  double *u, *e0;   /* [dim*n_node] m, [ns*eigen.n] at the end; NULL: no
                       law flows */
} finer_path;

typedef struct paths {
  finer_path *path;       /* NULL: none made */
  path_error before, now; /* of finished paths; of this one */
  int unknown;            /* 1: also those of increments without a path */
} paths;

static status waypoint_new(const run *r, waypoint *w) {
  size_t n;
  PASS(start_point_new(r, &w->start));
  if (wear_depths(r, &n) != NULL) PASS_NEW(w->depth, n);
  if (r->strains.visco != NULL)
    PASS(flow_state_new(&r->strains.visco->x, &w->flow));
  return OK;
}

static status path_new(const run *r, finer_path *p) {
  OWNS(p);
  PASS(waypoint_new(r, &p->at));
  PASS(waypoint_new(r, &p->end));
  PASS_NEW_REALS(r->nodes.n_c, &p->d, &p->Ad);
  if (r->strains.visco != NULL) {
    PASS_NEW(p->u, r->n_dof);
    PASS_NEW(p->e0, visco_at(r, r->strains.eigen.n));
    flow_state_copy(&r->strains.visco->x, &r->strains.visco->old, &p->at.flow);
  }
  start_point_copy(r, &r->old, &p->at.start);
  size_t n;
  const double *depth = wear_depths(r, &n);
  if (depth != NULL) COPY(p->at.depth, depth, n);
  return OK;
}

static status path_begin(const run *r, paths *own) {
  if (own->path != NULL) return OK;
  OWNS(own);
  PASS_NEW(own->path, 1);
  return path_new(r, own->path);
}

static status lose(finer_path *p, const char *why) {
  p->lost = why;
  return OK;
}

/* The equilibrium at t from where "from" stands, r->now; *known: wear_take. */
static status advance_from(run *r, waypoint *from, double t, waypoint *to,
                           int *known) {
  const int wears = from->depth != NULL;
  equilibrium keep = start_point_use(r, &from->start);
  status st = r->step->kind == STEP_VISCO && t > from->start.t
                  ? visco_advance_from(r, &from->flow, t, &to->flow)
                  : visco_settle_from(r, &from->flow, t, &to->flow);
  if (st == OK && wears && r->solving.report.outcome > 0)
    st = wear_take(r, known);
  r->old = keep;
  return st;
}

/* The same into "to", which may be the same; lost where there is none. */
static status half(run *r, finer_path *p, waypoint *from, double t,
                   waypoint *to) {
  size_t n;
  int known = 1;
  if (p->lost) return OK;
  double *depth = wear_depths(r, &n);
  /* The effect has the depths of the half while that is made. */
  if (depth != NULL) {
    memmove(to->depth, from->depth, n * sizeof *depth);
    cblas_dswap((int)n, depth, 1, to->depth, 1);
  }
  const status st = advance_from(r, from, t, to, &known);
  if (depth != NULL) cblas_dswap((int)n, depth, 1, to->depth, 1);
  PASS(st);
  start_point_copy(r, &r->now, &to->start);
  if (!known) return lose(p, "wear at corners of half the increments");
  return r->solving.report.outcome > 0
             ? OK
             : lose(p, "no equilibrium in half an increment");
}

/* The next increment starts from what is in r->old. */
static void restart(paths *own) {
  FORGET(own->path);
  own->before.norm += own->now.norm;
  own->before.strain += own->now.strain;
  own->now = (path_error){0};
}

/* Only slip in increments and inelastic strains, those of steps before too,
 * depend on their path. */
static int path_exists(const run *r) {
  return run_inherits(r) &&
         (!effects_sum_up(r) || r->step->kind != STEP_STATIC);
}

/* The attempt is accepted: the next one starts at its end. */
static void advance(finer_path *p) {
  waypoint w = p->at;
  p->at = p->end;
  p->end = w;
}

/* *sudden = 1: the increment is the first of a step in which the body does not
 * begin with what acts on it before. */
static status jumps(run *r, const finer_path *p, int *sudden) {
  const step *s = r->step;
  if (s->kind == STEP_VISCO && r->strains.visco != NULL) return OK;
  if (r->at.increment_no > 0 || p->at.start.t > s->start) return OK;
  PASS(increment_begin(r, s->start));
  *sudden = !loop_starts_smoothly(r);
  return OK;
}

/* From p->at to p->end at t by the times between, at least the middle. */
static status pass_turns(run *r, finer_path *p, double t) {
  turn_list list;
  int all;
  if (p->lost) return OK;
  PASS(loop_turns(r, p->at.start.t, t, &list, &all));
  if (!all) return lose(p, "the loads turn too often in an increment");
  waypoint *from = &p->at;
  for (int i = 0; i <= list.n; ++i) {
    PASS(half(r, p, from, i < list.n ? list.at[i] : t, &p->end));
    from = &p->end;
  }
  return OK;
}

/* Both halves of the increment that ends at t. */
static status try_halves(run *r, finer_path *p, double t) {
  p->measured = 0;
  p->lost = NULL;
  if (!p->sudden) PASS(jumps(r, p, &p->sudden));
  if (p->sudden) PASS(half(r, p, &p->at, p->at.start.t, &p->end));
  if (p->sudden && !p->lost) advance(p);
  p->sudden &= p->lost != NULL;
  PASS(pass_turns(r, p, t));
  if (p->lost || p->u == NULL) return OK;
  COPY(p->u, r->now.u, r->n_dof);
  COPY(p->e0, r->strains.eigen.e0, visco_at(r, r->strains.eigen.n));
  return OK;
}

static status try_path(run *r, void *self, double t) {
  status st = OK;
  paths *own = self;
  double cpu = timer_cpu();
  if (!r->step->accuracy.time || !path_exists(r)) return OK;
  timer_enter_as(STAGE_TIME_ERROR, STAGE_WHOLE);
  r->course.shadow = 1;
  if (own->path != NULL && own->path->at.start.t != r->old.t) restart(own);
  TRY(path_begin(r, own));
  TRY(try_halves(r, own->path, t));
  if (r->step->kind != STEP_VISCO) visco_rest(r);
done:
  r->course.shadow = 0;
  timer_leave(STAGE_TIME_ERROR);
  r->errors.time_error.cpu += timer_cpu() - cpu;
  return st;
}

/* Energy norm of the difference of the paths without inelastic strains,
 * sqrt(J). */
static double condensed_difference(const run *r, finer_path *p) {
  vector_of(r->nodes.n_c, p->end.start.uc, r->now.uc, p->Ad);
  run_take_rows(r, p->Ad, p->d);
  condensed_product(r->c, p->d, p->Ad);
  return sqrt(fmax(dot(r->nodes.n_row, p->d, p->Ad), 0.0));
}

/* sqrt(2 E) of displacements and strains without stress (NULL: none). */
static double field_norm(const run *r, const double *u, const double *e0) {
  domain d = r->body.d;
  eigenstrain x = r->strains.eigen;
  x.e0 = e0;
  d.eigen = e0 != NULL ? &x : NULL;
  return sqrt(2.0 * fmax(domain_strain_energy(&d, u), 0.0));
}

/* p->e0 becomes the difference of the strains; where there is none, flow that
 * begins so late in the increment that neither path has it. */
static status subtract_strains(run *r, finer_path *p) {
  visco *v = r->strains.visco;
  const size_t ns = visco_at(r, 1);
  for (size_t k = 0; k < visco_at(r, r->strains.eigen.n); ++k)
    p->e0[k] -= r->strains.eigen.e0[k];
  if (r->step->kind != STEP_VISCO) return OK;
  OWNED_OF(double, turning, visco_turning(r, &turning));
  for (int k = 0; k < v->x.n && turning != NULL; ++k) {
    double *e0 = p->e0 + visco_at(r, v->place[k]);
    if (largest_entry(ns, e0) == 0.0) COPY(e0, turning + visco_at(r, k), ns);
  }
  return OK;
}

/* The same with them: "norm" as large as the larger relative difference. p->u
 * becomes a difference, p->e0 is one. */
static path_error field_difference(const run *r, finer_path *p) {
  double stress = sqrt(2.0 * fmax(r->now.energy.strain, 0.0));
  double strain = field_norm(r, r->now.u, NULL);
  for (size_t k = 0; k < r->n_dof; ++k) p->u[k] -= r->now.u[k];
  double of_stress = field_norm(r, p->u, p->e0);
  double of_strain = field_norm(r, p->u, NULL);
  const double larger =
      strain > 0.0 ? fmax(of_stress, of_strain * (stress / strain)) : of_stress;
  return (path_error){larger, of_strain};
}

/* From the difference to half the increments to the error. */
static double extrapolation(const run *r) {
  if (effects_sum_up(r)) return 2.0;
  if (r->step->kind != STEP_VISCO || r->strains.visco == NULL)
    return EXTRAPOLATION;
  if (visco_order(r->step) < 2) return 2.0;
  return r->problem.ut0 != NULL ? EXTRAPOLATION : 4.0 / 3.0;
}

static const char *why_no_path(const run *r) {
  if (r->step->kind == STEP_STATIC) return "one static problem, no path";
  return r->step->kind == STEP_VISCO ? "no friction, no law flows: no path"
                                     : "no friction, no path";
}

/* Error of the increments so far, sqrt(J); that with the attempt in r->now,
 * whose energy is known. HUGE_VAL: the path is lost. */
static double total_error(const paths *own) {
  return own->before.norm + own->now.norm;
}

static status measure(run *r, paths *own, double *norm) {
  finer_path *p = own->path;
  *norm = HUGE_VAL;
  if (p == NULL || p->lost) return OK;
  if (!p->measured) {
    if (p->u != NULL) PASS(subtract_strains(r, p));
    p->error = p->u != NULL ? field_difference(r, p)
                            : (path_error){condensed_difference(r, p), 0.0};
    p->factor = fmax(p->factor, extrapolation(r));
    if (p->end.depth != NULL)
      p->error.norm =
          fmax(p->error.norm, wear_difference(r, p->end.depth) *
                                  sqrt(2.0 * fmax(r->now.energy.strain, 0.0)));
    p->error.norm *= p->factor;
    p->error.strain *= p->factor;
  }
  p->measured = 1;
  *norm = own->before.norm + p->error.norm;
  return OK;
}

/* The path at the end of an accepted increment. */
static status compare_path(run *r, paths *own, error_share *e) {
  finer_path *p = own->path;
  double norm;
  if (p == NULL || (!p->lost && p->end.start.t != r->now.t)) {
    e->why = "the body answers at once";
    return OK;
  }
  if (p->lost) {
    own->unknown = 1;
    e->why = p->lost;
    return OK;
  }
  PASS(measure(r, own, &norm));
  own->now = p->error;
  advance(p);
  return OK;
}

/* An error in a norm over the solution with it, whose energy is known. */
static double share_of(double norm, double energy) {
  return norm > 0.0 ? norm / sqrt(norm * norm + 2.0 * energy) : 0.0;
}

/* 1: paths without stress differ by more than the rounding of their motion. */
static int differs(const run *r, double norm) {
  return 0.5 * norm * norm > fmax(r->now.energy.rounding, rounding_of_works(r));
}

/* That of all paths so far. Of a body without stress, which the other path may
 * have: of the largest energy so far, and of the strains that are left. */
static double share_of_paths(const run *r, const paths *own) {
  const energies *e = &r->now.energy;
  const double left = r->errors.left;
  if (left >= 1.0) return share_of(total_error(own), e->strain);
  const double norm = left > 0.0 ? total_error(own) : own->now.norm,
               strain = rounding_strain_left(r);
  return fmax(differs(r, norm) ? share_of(norm, e->largest) : 0.0,
              strain > 0.0
                  ? share_of(own->before.strain + own->now.strain, strain)
                  : 0.0);
}

static status compare(run *r, void *self) {
  paths *own = self;
  error_share *e = &r->errors.time_error;
  e->asked = r->step->accuracy.time;
  e->relative = 0.0;
  e->why = NULL;
  if (!e->asked) return OK;
  if (effects_sum_up(r) && !path_exists(r)) e->relative = NAN;
  if (path_exists(r))
    PASS(compare_path(r, own, e));
  else
    e->why = why_no_path(r);
  if (own->unknown) e->relative = NAN;
  if (own->unknown && e->why == NULL) e->why = "that of an increment before is";
  if (!run_inherits(r) || isnan(e->relative)) return OK;
  e->relative = share_of_paths(r, own);
  if (e->relative > STRAIGHT * r->solving.tol)
    e->why = NULL;
  else if (e->why == NULL)
    e->why = "the path is straight: half the increments give the same";
  return OK;
}

static void forget(run *r, void *self) { restart(self); }

static status begin_step(run *r, void *self) {
  finer_path *p = ((paths *)self)->path;
  if (p != NULL)
    p->sudden = r->step->kind == STEP_VISCO && r->strains.visco != NULL;
  return OK;
}

static status keep_waypoint(const run *r, waypoint *w, archive *a) {
  size_t m = r->nodes.n_c;
  PASS(archive_reals(a, "path_t", &w->start.t, 1));
  PASS(archive_reals(a, "path_uc", w->start.uc, m));
  PASS(archive_reals(a, "path_rc", w->start.rc, m));
  PASS(archive_reals(a, "path_motion", w->start.motion,
                     w->start.motion == NULL ? 0 : m));
  if (r->strains.visco != NULL)
    PASS(visco_keep_flow(&r->strains.visco->x, &w->flow, a, "path_flow"));
  size_t n;
  return wear_depths(r, &n) == NULL
             ? OK
             : archive_reals(a, "path_depth", w->depth, n);
}

static status keep(run *r, void *self, archive *a) {
  paths *own = self;
  int there = own->path != NULL;
  PASS(archive_ints(a, "path", &there, 1));
  if (archive_reads(a)) restart(own);
  PASS(archive_ints(a, "path_unknown", &own->unknown, 1));
  PASS(archive_reals(a, "path_before", &own->before.norm, 1));
  PASS(archive_reals(a, "path_error", &own->now.norm, 1));
  PASS(archive_reals(a, "path_strain_before", &own->before.strain, 1));
  PASS(archive_reals(a, "path_strain", &own->now.strain, 1));
  if (!there) return OK;
  PASS(path_begin(r, own));
  PASS(archive_ints(a, "path_sudden", &own->path->sudden, 1));
  PASS(archive_reals(a, "path_factor", &own->path->factor, 1));
  return keep_waypoint(r, &own->path->at, a);
}

/*
 * *ACCURACY, TIME=BALANCED: increments whose error is a share of that of the
 * mesh. The finer path gives at each time t of the step the difference from
 * increments of half the length. With B the share of the error of the mesh at
 * the end of the step, in the energy norm, an increment is taken if
 *
 *   error(t) <= error at the start of the step + B sqrt((t - start)/total),
 *   or its own part of the error <= B dt/total:
 *
 * a contact that grows from a point makes most of its error at first, whatever
 * the increment. The norm of the solution at the end is estimated from its
 * change in the increment. The next increment is that for which a part that
 * goes like dt^2 would meet the bound.
 */
static const double SAFETY = 0.8, LONGER = 2.0, SHORTER = 0.25; /* - */
static const double ROUNDING = 0x1p-40; /* -, of the largest energy norm */
static const double FLAT = 1e-3;        /* -, of tables that count as smooth */

/* End of the next increment: not a sliver before the end of the step. */
static double next_end(const run *r) {
  double end = r->step->start + r->step->total, left = end - r->old.t;
  double dt = r->at.dt;
  if (dt >= left * (1.0 - 1e-9)) return end;
  return r->old.t + (dt > 0.6 * left ? 0.5 * left : dt);
}

/* B, sqrt(J). */
static double share_at_end(const run *r) {
  const step *s = r->step;
  double now = sqrt(2.0 * r->now.energy.strain);
  double old = sqrt(2.0 * r->old.energy.strain);
  double left = s->start + s->total - r->now.t, dt = r->now.t - r->old.t;
  double end = fmax(now + (now - old) * left / dt, 0.5 * now);
  return s->accuracy.time_share * r->errors.mesh_error.relative * end;
}

/* The part of the error this increment may make, sqrt(J). */
static double allowed_part(const run *r, double before) {
  const step *s = r->step;
  double share = share_at_end(r), dt = r->now.t - r->old.t;
  double sum = r->at.error + share * sqrt((r->now.t - s->start) / s->total);
  double largest = fmax(r->old.energy.largest, r->now.energy.strain);
  return fmax(fmax(sum - before, share * dt / s->total),
              ROUNDING * sqrt(2.0 * largest));
}

/* What of its loads an increment may miss, -, as of its error. */
static double share_of_loads(const run *r) {
  return fmax(FLAT,
              r->step->accuracy.time_share * r->errors.mesh_error.relative);
}

/* Length of the next increment after one of dt, of "planned" but for the points
 * of a table; implicit integrators keep to halves and doubles of that, which
 * they have factored. */
static double next_length(const run *r, double dt, double planned, double part,
                          double allowed) {
  const step *s = r->step;
  const double most = fmax(LONGER, planned / dt);
  double factor = part > 0.0 ? SAFETY * sqrt(allowed / part) : most;
  factor = fmin(most, fmax(SHORTER, factor)) * (dt / planned);
  if (s->visco.integrator != NULL && s->visco.integrator->limit == 0.0)
    factor = ldexp(1.0, (int)floor(log2(factor)));
  return fmax(s->dt_min, fmin(planned * factor, s->dt_max));
}

/* The attempt is rejected: r->at.dt the next time. */
static status refuse(run *r, double tried, double dt, const char *why) {
  progress *p = &r->at;
  PASS(loop_reject(r, p->attempt, p->increment_no + 1, why));
  p->dt = fmax(r->step->dt_min, fmin(0.5 * tried, dt));
  ++p->attempt;
  return OK;
}

/* What the attempt adds to the error of strains left without stress, -. */
static double strain_part(const run *r, const paths *own) {
  const double left = rounding_strain_left(r);
  if (own->path == NULL || own->path->lost || !(left > 0.0)) return 0.0;
  return share_of(own->path->error.strain - own->now.strain, left);
}

/* 1: no shorter increment would find an equilibrium (loop_cut_helps). */
static int is_stuck(const run *r) {
  return r->solving.report.outcome == STOPPED_STAGNATION;
}

/* 1: strains without stress outgrow their share. */
static int flows_on(const run *r, const paths *own, int hides) {
  return hides && !is_stuck(r) &&
         strain_part(r, own) > r->step->accuracy.time_share;
}

/* What an attempt adds to the error of the stresses, sqrt(J): none where they
 * are rounding, in both paths. */
static double part_of(const run *r, double more, int hides) {
  const int none = hides && !differs(r, fmax(more, 0.0));
  return none || is_stuck(r) ? 0.0 : more;
}

static status attempt_balanced(run *r, paths *own) {
  const step *s = r->step;
  progress *p = &r->at;
  double cpu = timer_cpu(), t = next_end(r), planned = t - r->old.t;
  double before = total_error(own), part, allowed;
  int deeper, hides, attempt = p->attempt;
  PASS(visco_level(r, planned, &deeper));
  if (deeper > 0) {
    p->dt = ldexp(planned, -deeper);
    return OK;
  }
  t = loop_end(r, t, share_of_loads(r));
  const double tried = t - r->old.t;
  PASS(effects_attempt(r, t));
  PASS(loop_solve(r, t));
  int settled = r->solving.report.outcome > 0, shorter = p->dt > s->dt_min;
  if (r->solving.report.outcome == STOPPED_UNSTABLE ||
      (!settled && shorter && loop_cut_helps(r))) {
    PASS(refuse(r, tried, tried, outcome_text(r->solving.report.outcome)));
    return OK;
  }
  if (outcome_is_fatal(r->solving.report.outcome)) PASS(loop_no_equilibrium(r));
  if (!r->errors.evaluated) PASS(estimate_evaluate(r));
  PASS(measure(r, own, &part));
  PASS(rounding_hides_stresses(r, &hides));
  part = part_of(r, part - before, hides);
  const int flows = flows_on(r, own, hides);
  allowed = allowed_part(r, before);
  double dt = next_length(r, tried, planned, part, allowed);
  if (flows) dt = SHORTER * tried;
  if ((part > allowed || flows) && shorter) {
    PASS(refuse(r, tried, dt, "error of the steps above its share"));
    return OK;
  }
  p->attempt = 1;
  ++p->increment_no;
  PASS(loop_accept(r, attempt, p->increment_no, t == s->start + s->total, cpu));
  p->dt = dt;
  return OK;
}

static status march(run *r, void *self, int *made) {
  paths *own = self;
  double end = r->step->start + r->step->total;
  if (!r->step->accuracy.time_balanced || effects_sum_up(r) ||
      !path_exists(r) || !run_remembers(r))
    return OK;
  *made = 1;
  if (r->at.increment_no == 0) r->at.error = total_error(own);
  while (r->old.t < end) {
    PASS(loop_pause(r));
    PASS(attempt_balanced(r, own));
  }
  return OK;
}

static effect_work expected(const plan_sizes *s) {
  double m = plan_contact_unknowns(s);
  return (effect_work){
      s->contact, "nodes", s->increments,
      2.0 * s->increments *
          (4.0 * work_factor_entries(s) + PLAN_STEPS * 2.0 * m * m)};
}

static int is_estimated(const step *s) { return s->accuracy.time; }

static int requires_time_error(const model *m, const reason *why) {
  return plan_requires_accuracy(m, "TIME", is_estimated, why);
}

VALUE(time_error, v->s->errors.time_error.asked
                      ? 100 * v->s->errors.time_error.relative
                      : NAN)

/* clang-format off */
static const column columns[] = {
{"time_error", "%", INC, 0, ON(TIME_ERROR), ANY, "time_error", 0, time_error,
 NULL, "estimate of the error of the increments in that norm; NaN: not "
 "required, or unknown"}};

const effect_ops time_error_effect = {
  .name = "error of steps", .bit = EFFECT_BIT_TIME_ERROR,
  .required = requires_time_error, .expected = expected,
  .own = STAGE_TIME_ERROR, .inside = 1, .size = sizeof(paths),
  .on = {.begin_step = begin_step, .make_step = march, .attempt = try_path,
         .accept = compare, .forget = forget, .keep = keep},
  COLUMNS_OF(columns)};
/* clang-format on */
