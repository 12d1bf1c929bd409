/*
 * Tables at the time points of *PRINT that no increment ends at.
 */
#include "run/history/loop.h"

#include <math.h>

/* The first time point of a table after "after" within the increment. */
static double next_point(const run *r, double after) {
  double next = HUGE_VAL;
  for (int i = 0; i < r->step->print.n; ++i)
    next = fmin(next, print_next(&r->step->print.requests[i], r->step, after,
                                 r->now.t));
  return next;
}

static status show(run *r, double t, int increment_no) {
  status st = OK;
  shadow *b = NULL;
  TRY(shadow_at(r, t, &b));
  run *own = shadow_run(b);
  TRY(effects_accept(own));
  if (own->solving.report.outcome <= 0) ++r->course.unsettled;
  state s = loop_state(own, 1, increment_no);
  s.within = 1;
  TRY(r->sink->between(r->sink->ctx, &s));
done:
  shadow_free(b);
  return st;
}

status dense_show(run *r, int increment_no) {
  status st = OK;
  double t = next_point(r, r->old.t);
  if (r->sink->between == NULL || r->step->kind == STEP_STATIC) return OK;
  for (; isfinite(t); t = next_point(r, t)) TRY(show(r, t, increment_no));
done:
  return st;
}
