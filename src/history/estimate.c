/*
 * What is asked about the answer of the contact solver at an accepted
 * increment: how far it is from the solution, and whether it is the only one
 * (for large friction uniqueness is not known).
 *
 * The error is the bound of accuracy.h,
 * in energy units and relative to the energy norm of the body. The interior
 * follows the contact nodes exactly, so that the error of the whole body has
 * the energy of that of the condensed problem.
 */
#include "base/memory.h"
#include "base/timer.h"
#include "history/run.h"

#include <math.h>
#include <stdio.h>

const char *const error_bound_indefinite =
    "the matrix is not symmetric and positive semidefinite";

void error_bound_set(const solver_error *found, double energy, error_bound *e) {
  *e = (error_bound){.asked = 1,
                     .energy = 0.5 * found->norm * found->norm,
                     .relative = 0.0,
                     .rate = found->rate,
                     .why = found->why};
  if (found->why != NULL || found->norm > 0.0)
    e->relative = found->norm / sqrt(2.0 * energy);
}

static status force_energy(void *ctx, const double *d, double *square) {
  return condensed_force_energy(ctx, d, square);
}

/* The factor of the body, or of A where contact alone holds a body. *out->ctx
 * NULL: A has none. */
static status choose_inverse(run *r, inverse_energy *out) {
  status st = OK;
  *out =
      (inverse_energy){r->c, force_energy, condensed_condition(r->c), 0, NULL};
  if (!r->cp.floating) goto done;
  out->ctx = NULL;
  if (!r->dense_known) TRY(dense_inverse_new(r->cp.m, r->cp.A, &r->dense));
  r->dense_known = 1;
  if (r->dense != NULL) *out = dense_inverse_energy(r->dense);
done:
  return st;
}

/* Error of the mesh and the share of each element, from r->stress. */
static status estimate_mesh(run *r) {
  status st = OK;
  double cpu = timer_cpu();
  space_error found;
  r->mesh_error.asked = r->step->mesh_error;
  if (!r->step->mesh_error) return OK;
  if (r->recovery == NULL) TRY(space_recovery_new(&r->d, &r->recovery));
  space_estimate(r->recovery, r->stress, r->elem_error, &found);
  r->mesh_error.relative = found.relative;
  double whole = hypot(found.norm, found.error);
  for (int e = 0; e < r->msh->n_elem; ++e)
    r->elem_error[e] = whole > 0.0 ? r->elem_error[e] / whole : 0.0;
  r->mesh_error.cpu += timer_cpu() - cpu;
done:
  return st;
}

static status estimate_solver(run *r) {
  status st = OK;
  solver_error found = {.norm = NAN, .why = error_bound_indefinite};
  inverse_energy inverse;
  double cpu = timer_cpu();
  r->error = (error_bound){0};
  if (r->n == 0 || r->step->no_solver_error) return OK;
  timer_enter(STAGE_ESTIMATE);
  TRY(choose_inverse(r, &inverse));
  if (!r->limit_known) known_rate_forget(&r->rate);
  if (inverse.ctx != NULL)
    TRY(solver_error_bound(&r->cp, &inverse, r->now.uc, r->now.rc, &r->rate,
                           &found));
  error_bound_set(&found, r->now.energy.strain, &r->error);
  r->error.cpu = r->bound_cpu += timer_cpu() - cpu;
done:
  timer_leave(STAGE_ESTIMATE);
  return st;
}

status estimate_increment(run *r) {
  status st = OK;
  TRY(estimate_solver(r));
  TRY(estimate_mesh(r));
done:
  return st;
}

/* ---- other solutions ---------------------------------------------------- */

status check_problem(const step *s, const contact_problem *cp,
                     const solver_report *report, const double *u,
                     const double *r, solution_set *out) {
  status st = OK;
  solution_set_free(out);
  if (s->check == CHECK_NONE || cp->m == 0) return OK;
  timer_enter(STAGE_CHECK);
  if (s->check == CHECK_SOLVERS) {
    TRY(solutions_by_solvers(cp, s->solver.tol, report, u, r, out));
    goto done;
  }
  st = solutions_by_statuses(cp, s->solver.tol, u, r, out);
  if (st == ERR_DECK) {
    char why[256];
    snprintf(why, sizeof why, "%s", status_message());
    FAIL(ERR_DECK, "deck line %d: *SOLVER, CHECK=ALL: %s; use CHECK=YES",
         s->solver_at.line_no, why);
  }
  TRY(st);
done:
  timer_leave(STAGE_CHECK);
  return st;
}

status check_increment(run *r) {
  return check_problem(r->step, &r->cp, &r->report, r->now.uc, r->now.rc,
                       &r->solutions);
}
