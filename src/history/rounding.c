/*
 * What rounding has taken of an answer. Where the condition number is far above
 * that of a plain mesh, or inelastic strains far above the elastic ones, which
 * are the difference of two large numbers then, the forces of the elements at
 * the answer are compared with loads and contact forces. With d what is missing
 * to equilibrium, the exact answer is w = inv(K) d away: its energy norm and
 * its stresses are those of the error. Beside laws that flow K is that of the
 * elastic body all the same: of all stresses that carry d, those of w have the
 * least energy. They are as rounded as the answer itself, and show so. An
 * answer without one correct digit ends the run.
 */
#include "base/memory.h"
#include "base/timer.h"
#include "history/loop.h"

#include <math.h>

static const double LAST_DIGIT = 0.1; /* -, an error that leaves none         */
/* -, the same where the condition leaves none to the factor that measures */
static const double IN_DOUBT = 0.01;
static const double FLOWN = 1e6; /* -, work of creep over the strain energy   */

static double largest(size_t n, const double *v) {
  double most = 0.0;
  for (size_t i = 0; i < n; ++i) most = fmax(most, fabs(v[i]));
  return most;
}

static status check(const run *r, const condensed *c) {
  status st = OK;
  const rounding_loss *loss = &r->rounding;
  const double most = fmax(fmax(loss->energy, loss->stress), loss->u);
  if (most < (condensed_digits(c) > 0 ? LAST_DIGIT : IN_DOUBT)) goto done;
  FAIL(ERR_SINGULAR,
       "step %d, time %g: rounding leaves no digit of the answer: the energy "
       "norm is wrong by about %.1g of itself, stresses by %.1g and "
       "displacements by %.1g of the largest (condition %.1e); contrasts of "
       "stiffness, slivers, nu near 1/2, supports that hardly hold and creep "
       "strains far above the elastic ones cost digits",
       run_step_id(r) + 1, r->now.t, loss->energy, loss->stress, loss->u,
       condensed_condition(c));
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
  r->now.peak_stress = fmax(r->now.peak_stress, largest(n, r->stress));
  if (wrong > 0.0) r->rounding.stress = wrong / r->now.peak_stress;
done:
  memory_free(stress);
  return st;
}

/* A body led through the air, without load and contact force: its stresses, of
 * which nothing but rounding is there, are no loss. */
static int moves_alone(const run *r) {
  return r->rounding.u < 1e-10 && largest(r->n_dof, r->now.F) == 0.0 &&
         largest((size_t)r->n_c, r->now.rc) == 0.0;
}

static status find(run *r) {
  status st = OK;
  condensed *c = r->elastic.c != NULL ? r->elastic.c : r->c;
  double *rest = NULL, *w = NULL, square = 0.0;
  NEW(rest, r->n_dof);
  NEW(w, r->n_dof);
  domain_stress(&r->d, r->now.u, r->strain, r->stress);
  domain_internal_force(&r->d, r->stress, rest);
  for (size_t i = 0; i < r->n_dof; ++i) rest[i] = r->now.F[i] - rest[i];
  TRY(condensed_misfit(c, rest, run_rows(r, 1, r->now.rc), w, &square));
  r->rounding.found = 1;
  r->rounding.norm = sqrt(square);
  if (square > 0.0)
    r->rounding.energy = sqrt(square / (2.0 * r->now.peak_energy));
  TRY(compare_stresses(r, w));
  if (square > 0.0)
    r->rounding.u = largest(r->n_dof, w) / largest(r->n_dof, r->now.u);
  if (moves_alone(r)) r->rounding = (rounding_loss){0};
  TRY(check(r, c));
done:
  memory_free(rest);
  memory_free(w);
  return st;
}

static int is_doubtful(const run *r) {
  if (condensed_costs_digits(r->c)) return 1;
  return fabs(r->now.energy.inelastic) > FLOWN * r->now.peak_energy;
}

status rounding_find(run *r) {
  status st = OK;
  r->rounding = (rounding_loss){0};
  r->now.peak_energy = fmax(r->old.peak_energy, r->now.energy.strain);
  r->now.peak_stress = r->old.peak_stress;
  if (!is_doubtful(r) || r->report.outcome <= 0) return OK;
  timer_enter(STAGE_RECOVERY);
  st = find(r);
  timer_leave(STAGE_RECOVERY);
  return st;
}
