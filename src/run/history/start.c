/*
 * What comes before the increments of a step: hooks of the effects, and sudden
 * loads of a *VISCO step.
 */
#include "base/timer.h"
#include "run/history/loop.h"

#include <math.h>

/* 1 if a is b to rounding. */
static int same_vector(size_t n, const double *a, const double *b) {
  double largest = 0.0, worst = 0.0;
  for (size_t i = 0; i < n; ++i) {
    largest = fmax(largest, fmax(fabs(a[i]), fabs(b[i])));
    worst = fmax(worst, fabs(a[i] - b[i]));
  }
  return worst <= 1e-12 * largest;
}

/* 1 if nothing acts at the start of the step that did not act before. */
static int starts_smoothly(const run *r) {
  if (r->course.total_no == 0 && r->nodes.n > 0) return 0;
  for (size_t i = 0; i < r->n_dof; ++i)
    if (r->body.fixed[i] &&
        fabs(r->loads.ud[i] - r->old.u[i]) > 1e-12 * fabs(r->loads.ud[i]))
      return 0;
  if (r->body.moduli.n_own > 0 &&
      !same_vector((size_t)r->msh->n_elem, r->now.temperature,
                   r->old.temperature))
    return 0;
  return same_vector(r->n_dof, r->now.F, r->old.F) &&
         same_vector(strains_kept(r), r->now.e0, r->old.e0);
}

/* 1: a law flows, or would without *EFFECTS. */
static int has_law(const run *r) {
  int any = r->strains.visco != NULL;
  for (int i = 0; i < r->m->n.material; ++i)
    any |= r->m->materials[i].law_aside != NULL;
  return any;
}

/*
 * The body responds at once to what is applied suddenly at the start of a
 * *VISCO step: an increment without length of its own.
 */
static status start_visco(run *r, int *increment_no) {
  status st = OK;
  double cpu = timer_cpu();
  if (r->step->kind != STEP_VISCO) return OK;
  if (!has_law(r)) return OK;
  TRY(increment_begin(r, r->step->start));
  if (!starts_smoothly(r)) {
    TRY(increment_solve(r, r->step->start));
    if (outcome_is_fatal(r->solving.report.outcome))
      TRY(loop_no_equilibrium(r));
    if (!same_vector(r->n_dof, r->now.u, r->old.u))
      TRY(loop_accept(r, 1, ++*increment_no, 0, cpu));
  }
  TRY(visco_begin_step(r));
done:
  return st;
}

status start_step(run *r) {
  status st = OK;
  visco_rest(r);
  TRY(effects_start(r));
  TRY(start_visco(r, &r->at.increment_no));
done:
  return st;
}
