/*
 * *ACCURACY, TIME=BALANCED: increments whose error is a share of that of the
 * mesh. The finer path (path.c) tells at each time t of the step how far the
 * run is from one of half its increments. With B the share of the error of the
 * mesh at the end of the step, in the energy norm, an increment is taken if
 *
 *   error(t) <= error at the start of the step + B sqrt((t - start)/total),
 *   or its own part of the error <= B dt/total:
 *
 * a contact that grows from a point makes most of its error at first, whatever
 * the increment. The norm of the solution at the end is foreseen from its
 * change in the increment. The next increment is that for which a part that
 * goes like dt^2 would meet the bound.
 */
#include "base/timer.h"
#include "run/history/loop.h"

#include <math.h>

static const double SAFETY = 0.8, LONGER = 2.0, SHORTER = 0.25; /* -          */
static const double ROUNDING = 0x1p-40; /* -, of the largest energy norm      */

/* End of the next increment: not a sliver before the end of the step. */
static double next_end(const run *r) {
  double end = r->step->start + r->step->total, left = end - r->old.t;
  double dt = r->at.dt;
  if (dt >= left * (1.0 - 1e-9)) return end;
  return r->old.t + (dt > 0.6 * left ? 0.5 * left : dt);
}

/* B of the head of this file, sqrt(J). */
static double share_at_end(const run *r) {
  const step *s = r->step;
  double now = sqrt(2.0 * r->now.energy.strain);
  double old = sqrt(2.0 * r->old.energy.strain);
  double left = s->start + s->total - r->now.t, dt = r->now.t - r->old.t;
  double end = fmax(now + (now - old) * left / dt, 0.5 * now);
  return s->time_share * r->errors.mesh_error.relative * end;
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

/* Length of the next increment after one of dt; implicit integrators keep to
 * halves and doubles, which they have factored. */
static double next_length(const run *r, double dt, double part,
                          double allowed) {
  const step *s = r->step;
  double factor = part > 0.0 ? SAFETY * sqrt(allowed / part) : LONGER;
  factor = fmin(LONGER, fmax(SHORTER, factor));
  if (s->integrator != NULL && s->integrator->limit == 0.0)
    factor = ldexp(1.0, (int)floor(log2(factor)));
  return fmax(s->dt_min, fmin(dt * factor, s->dt_max));
}

/* The attempt is not taken: r->at.dt the next time. */
static status refuse(run *r, double tried, double dt, const char *why) {
  status st = OK;
  progress *p = &r->at;
  path_keep_on(r);
  TRY(loop_reject(r, p->attempt, p->increment_no + 1, why));
  p->dt = fmax(r->step->dt_min, fmin(0.5 * tried, dt));
  ++p->attempt;
done:
  return st;
}

static status attempt_balanced(run *r) {
  status st = OK;
  const step *s = r->step;
  progress *p = &r->at;
  double cpu = timer_cpu(), t = next_end(r), tried = t - r->old.t;
  double before = path_total(r), part, allowed;
  int deeper, attempt = p->attempt;
  TRY(visco_level(r, tried, &deeper));
  if (deeper > 0) {
    p->dt = ldexp(tried, -deeper);
    goto done;
  }
  TRY(path_try(r, t));
  TRY(balance_advance(r, t));
  int settled = r->solving.report.outcome > 0, shorter = p->dt > s->dt_min;
  if (!settled && shorter && loop_cut_helps(r)) {
    TRY(refuse(r, tried, 0.0, outcome_text(r->solving.report.outcome)));
    goto done;
  }
  if (outcome_is_fatal(r->solving.report.outcome)) TRY(loop_no_equilibrium(r));
  if (!r->errors.judged) TRY(estimate_judge(r));
  part = rounding_hides_strains(r) ? 0.0 : path_measure(r) - before;
  allowed = allowed_part(r, before);
  double dt = next_length(r, tried, part, allowed);
  if (part > allowed && shorter) {
    TRY(refuse(r, tried, dt, "error of the steps above its share"));
    goto done;
  }
  p->attempt = 1;
  ++p->increment_no;
  TRY(loop_accept(r, attempt, p->increment_no, t == s->start + s->total, cpu));
  p->dt = dt;
done:
  return st;
}

int march_applies(const run *r) {
  return r->step->time_balanced && path_exists(r);
}

status march_run(run *r) {
  status st = OK;
  double end = r->step->start + r->step->total;
  if (r->at.increment_no == 0) r->at.error = path_total(r);
  while (r->old.t < end) {
    TRY(loop_pause(r));
    TRY(attempt_balanced(r));
  }
done:
  return st;
}
