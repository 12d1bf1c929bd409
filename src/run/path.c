/*
 * Error of the steps: the path of slip depends on the increments. Beside the
 * run goes a second one of half the increments, contact forces and slip its
 * own; the two meet at the end of each increment, where the loads are the same,
 * so that their difference d has the energy d' A d of the condensed stiffness.
 * The error of the run is 2 |d| if it falls with the increment, 4/3 |d| if with
 * its square (Richardson); zones of stick and slip that grow lie between: 5/3
 * |d| is told.
 */
#include "run/run.h"

#include "base/memory.h"
#include "base/timer.h"

#include <math.h>
#include <string.h>

static const double EXTRAPOLATION = 5.0 / 3.0; /* -                           */

typedef struct waypoint { /* what an increment starts from, of one path       */
  double t;
  double *uc, *rc, *motion; /* [m] m, N, m                                   */
} waypoint;

struct finer_path {
  int lost; /* 1: it found no equilibrium                      */
  waypoint at, middle, end; /* accepted; of the attempt now made */
  double *d, *Ad; /* [m] difference of the paths, m; N               */
};

static status waypoint_new(int m, waypoint *w) {
  status st = OK;
  NEW(w->uc, m);
  NEW(w->rc, m);
  NEW(w->motion, m);
done:
  return st;
}

static void waypoint_free(waypoint *w) {
  memory_free(w->uc);
  memory_free(w->rc);
  memory_free(w->motion);
}

static void waypoint_copy(int m, const equilibrium *e, waypoint *w) {
  size_t bytes = (size_t)m * sizeof *w->uc;
  w->t = e->t;
  memcpy(w->uc, e->uc, bytes);
  memcpy(w->rc, e->rc, bytes);
  memcpy(w->motion, e->motion, bytes);
}

static status path_new(const run *r, finer_path **out) {
  status st = OK;
  finer_path *p = NULL;
  NEW(p, 1);
  *out = p;
  TRY(waypoint_new(r->n_c, &p->at));
  TRY(waypoint_new(r->n_c, &p->middle));
  TRY(waypoint_new(r->n_c, &p->end));
  NEW(p->d, r->n_c);
  NEW(p->Ad, r->n_c);
  waypoint_copy(r->n_c, &r->old, &p->at);
done:
  return st;
}

void path_free(finer_path *p) {
  if (p == NULL) return;
  waypoint_free(&p->at);
  waypoint_free(&p->middle);
  waypoint_free(&p->end);
  memory_free(p->d);
  memory_free(p->Ad);
  memory_free(p);
}

/* The equilibrium at t from where "from" stands, into "to". */
static status half(run *r, const waypoint *from, double t, waypoint *to) {
  status st = OK;
  equilibrium keep = r->old;
  r->old.t = from->t;
  r->old.uc = from->uc;
  r->old.rc = from->rc;
  r->old.motion = from->motion;
  st = increment_solve(r, t);
  r->old = keep;
  TRY(st);
  waypoint_copy(r->n_c, &r->now, to);
done:
  return st;
}

/* Only slip in increments remembers its path. */
static int has_path(const run *r) {
  return r->n > 0 && r->ut0 != NULL && r->step->kind == STEP_QUASISTATIC;
}

/* Both halves of the increment that ends at t; lost where there is none. */
static status try_halves(run *r, finer_path *p, double t) {
  status st = OK;
  if (p->lost) return OK;
  TRY(half(r, &p->at, 0.5 * (p->at.t + t), &p->middle));
  p->lost = r->report.outcome <= 0;
  if (p->lost) return OK;
  TRY(half(r, &p->middle, t, &p->end));
  p->lost = r->report.outcome <= 0;
done:
  return st;
}

status path_try(run *r, double t) {
  status st = OK;
  double cpu = timer_cpu();
  if (!r->step->time_error || !has_path(r)) return OK;
  timer_enter(STAGE_ESTIMATE);
  r->beside = 1;
  if (r->path != NULL && r->path->at.t != r->old.t) path_restart(r);
  if (r->path == NULL) TRY(path_new(r, &r->path));
  TRY(try_halves(r, r->path, t));
done:
  r->beside = 0;
  timer_leave(STAGE_ESTIMATE);
  r->time_error.cpu += timer_cpu() - cpu;
  return st;
}

/* Energy norm of the error at the end of an accepted increment, sqrt(J). */
static double error_norm(run *r, finer_path *p) {
  double square = 0.0;
  for (int k = 0; k < r->n_c; ++k) p->d[k] = r->now.uc[k] - p->end.uc[k];
  contact_product(r->n_c, condensed_matrix(r->c), p->d, p->Ad);
  for (int k = 0; k < r->n_c; ++k) square += p->d[k] * p->Ad[k];
  return EXTRAPOLATION * sqrt(fmax(square, 0.0));
}

/* The attempt is accepted: the next one starts at its end. */
static void advance(finer_path *p) {
  waypoint w = p->at;
  p->at = p->end;
  p->end = w;
}

void path_compare(run *r) {
  error_share *e = &r->time_error;
  e->asked = r->step->time_error;
  e->relative = 0.0;
  e->why = NULL;
  if (!e->asked) return;
  if (r->step->kind == STEP_VISCO) {
    e->relative = NAN;
    e->why = "not estimated in *VISCO steps, whose TOLERANCE= bounds it";
    return;
  }
  if (!has_path(r)) {
    e->why = r->step->kind == STEP_STATIC ? "one static problem, no path"
                                          : "no friction, no path";
    return;
  }
  double energy = r->now.energy.strain;
  if (r->path->lost) {
    e->relative = NAN;
    e->why = "no equilibrium in half an increment";
    return;
  }
  r->path_error = error_norm(r, r->path);
  double norm = r->path_before + r->path_error;
  if (norm > 0.0) e->relative = norm / sqrt(norm * norm + 2.0 * energy);
  advance(r->path);
}

static status keep_waypoint(int m, waypoint *w, archive *a) {
  status st = OK;
  TRY(archive_reals(a, "path_t", &w->t, 1));
  TRY(archive_reals(a, "path_uc", w->uc, (size_t)m));
  TRY(archive_reals(a, "path_rc", w->rc, (size_t)m));
  TRY(archive_reals(a, "path_motion", w->motion, (size_t)m));
done:
  return st;
}

status path_keep(run *r, archive *a) {
  status st = OK;
  int there = r->path != NULL;
  TRY(archive_ints(a, "path", &there, 1));
  if (archive_reads(a)) path_restart(r);
  TRY(archive_reals(a, "path_before", &r->path_before, 1));
  TRY(archive_reals(a, "path_error", &r->path_error, 1));
  if (!there) goto done;
  if (r->path == NULL) TRY(path_new(r, &r->path));
  TRY(archive_ints(a, "path_lost", &r->path->lost, 1));
  TRY(keep_waypoint(r->n_c, &r->path->at, a));
done:
  return st;
}

void path_restart(run *r) {
  path_free(r->path);
  r->path = NULL;
  r->path_before += r->path_error;
  r->path_error = 0.0;
}
