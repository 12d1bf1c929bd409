/*
 * What rounding has taken of an answer. Where the condition number is far above
 * that of a plain mesh, the forces of the elements at the answer are compared
 * with loads and contact forces. With d what is missing to equilibrium, the
 * exact answer is w = inv(K) d away: its energy norm and its stresses (under
 * the tangents of a law the norm alone) are those of the error. They are as
 * rounded as the answer itself, and show so. An answer without one correct
 * digit ends the run.
 */
#include "base/memory.h"
#include "base/timer.h"
#include "history/loop.h"

#include <math.h>

static const double LAST_DIGIT = 0.1; /* -, an error that leaves none         */

static double largest(size_t n, const double *v) {
  double most = 0.0;
  for (size_t i = 0; i < n; ++i) most = fmax(most, fabs(v[i]));
  return most;
}

static status check(const run *r) {
  status st = OK;
  const rounding_loss *loss = &r->rounding;
  if (loss->energy < LAST_DIGIT && loss->stress < LAST_DIGIT) goto done;
  FAIL(ERR_SINGULAR,
       "step %d, time %g: rounding leaves no digit of the answer: the energy "
       "norm is wrong by about %.1g of itself, stresses by %.1g of the largest "
       "(condition %.1e); contrasts of stiffness, slivers, nu near 1/2 and "
       "supports that hardly hold cost digits",
       run_step_id(r) + 1, r->now.t, loss->energy, loss->stress,
       condensed_condition(r->c));
done:
  return st;
}

/* The stresses of the displacement w[n_dof] alone, over those of the answer. */
static status compare_stresses(run *r, const double *w) {
  status st = OK;
  const size_t n = (size_t)r->m->ns * (size_t)r->msh->n_elem;
  domain plain = r->d;
  double *stress = NULL, wrong;
  plain.eigen = NULL;
  NEW(stress, n);
  domain_stress(&plain, w, NULL, stress);
  wrong = largest(n, stress);
  if (wrong > 0.0) r->rounding.stress = wrong / largest(n, r->stress);
done:
  memory_free(stress);
  return st;
}

static status find(run *r) {
  status st = OK;
  double *rest = NULL, *w = NULL, square = 0.0;
  double energy = fmax(r->now.energy.largest, r->now.energy.strain);
  NEW(rest, r->n_dof);
  NEW(w, r->n_dof);
  domain_stress(&r->d, r->now.u, r->strain, r->stress);
  domain_internal_force(&r->d, r->stress, rest);
  for (size_t i = 0; i < r->n_dof; ++i) rest[i] = r->now.F[i] - rest[i];
  TRY(condensed_misfit(r->c, rest, run_rows(r, 1, r->now.rc), w, &square));
  r->rounding.found = 1;
  r->rounding.norm = sqrt(square);
  if (square > 0.0) r->rounding.energy = sqrt(square / (2.0 * energy));
  if (r->c == r->elastic.c) TRY(compare_stresses(r, w));
  TRY(check(r));
done:
  memory_free(rest);
  memory_free(w);
  return st;
}

status rounding_find(run *r) {
  status st = OK;
  r->rounding = (rounding_loss){0};
  if (!condensed_costs_digits(r->c) || r->report.outcome <= 0) return OK;
  timer_enter(STAGE_RECOVERY);
  st = find(r);
  timer_leave(STAGE_RECOVERY);
  return st;
}
