/*
 * What is asked about the answer of the contact solver at an accepted
 * increment: how far it is from the solution, and what makes it doubtful.
 *
 * The error is the bound of accuracy.h,
 * in energy units and relative to the energy norm of the body. The interior
 * follows the contact nodes exactly, so that the error of the whole body has
 * the energy of that of the condensed problem.
 */
#include "base/memory.h"
#include "base/timer.h"
#include "run/history/loop.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

const char *const error_bound_indefinite =
    "the matrix is not symmetric and positive semidefinite";
static const double DOUBT = 0.1;        /* -, relative error                  */
static const double UNLOADED = 0x1p-60; /* -, of the largest energy           */
static const char weakly_held[] =
    "supports hold a body by lever arms of next to nothing";

void error_bound_set(const solver_error *found, double energy, error_bound *e) {
  *e = (error_bound){.asked = 1,
                     .energy = 0.5 * found->norm * found->norm,
                     .relative = 0.0,
                     .rate = found->rate,
                     .why = found->why};
  if (found->why != NULL || found->norm > 0.0)
    e->relative = energy > 0.0 ? found->norm / sqrt(2.0 * energy) : NAN;
}

int error_bound_doubts(const error_bound *e, double share) {
  if (share * e->hidden > DOUBT) return 1;
  return e->asked && e->why == NULL && share * e->relative > DOUBT;
}

static status force_energy(void *ctx, const double *d, double *square) {
  return condensed_force_energy(ctx, d, square);
}

/* The factor of the body; 0: the motions that contact alone holds are not
 * known. */
static int choose_inverse(run *r, inverse_energy *out) {
  *out = (inverse_energy){.ctx = r->c,
                          .square = force_energy,
                          .condition = condensed_condition(r->c)};
  out->n_kernel = condensed_kernel(r->c, &out->kernel);
  return out->n_kernel >= 0;
}

/* Error of the mesh and the share of each element, from r->result.stress. */
static status estimate_mesh(run *r) {
  status st = OK;
  double cpu = timer_cpu();
  space_error found;
  r->errors.mesh_error.asked = r->step->mesh_error;
  if (!r->step->mesh_error) return OK;
  if (r->errors.recovery == NULL)
    TRY(space_recovery_new(&r->body.d, &r->errors.recovery));
  TRY(space_estimate(r->errors.recovery, r->result.stress, r->errors.elem_error,
                     &found));
  r->errors.mesh_error.relative = found.relative;
  double whole = hypot(found.norm, found.error);
  for (int e = 0; e < r->msh->n_elem; ++e)
    r->errors.elem_error[e] =
        whole > 0.0 ? r->errors.elem_error[e] / whole : 0.0;
  r->errors.mesh_error.cpu += timer_cpu() - cpu;
done:
  return st;
}

static status estimate_solver(run *r) {
  status st = OK;
  solver_error found = {.norm = NAN, .why = weakly_held};
  inverse_energy inverse;
  double cpu = timer_cpu();
  r->errors.error = (error_bound){0};
  if (r->nodes.n == 0 || r->step->no_solver_error) return OK;
  timer_enter(STAGE_ESTIMATE);
  if (choose_inverse(r, &inverse))
    TRY(solver_error_bound(&r->problem.cp, &inverse, run_rows(r, 0, r->now.uc),
                           run_rows(r, 1, r->now.rc), &r->solving.rate,
                           &found));
  error_bound_set(&found, r->now.energy.strain, &r->errors.error);
  r->errors.error.cpu = r->errors.bound_cpu += timer_cpu() - cpu;
done:
  timer_leave(STAGE_ESTIMATE);
  return st;
}

void estimate_unloaded(run *r) {
  const energies *e = &r->now.energy;
  if (rounding_is_all(r)) {
    r->errors.mesh_error.relative = r->errors.time_error.relative = 0.0;
    if (r->errors.error.why == NULL) r->errors.error.relative = 0.0;
    r->errors.error.hidden = 0.0;
    return;
  }
  if (!(e->strain < UNLOADED * e->largest)) return;
  double share = sqrt(fmax(e->strain, 0.0) / e->largest);
  r->errors.mesh_error.relative *= share;
  r->errors.time_error.relative *= share;
  if (r->errors.error.asked && r->errors.error.why == NULL)
    r->errors.error.relative = sqrt(r->errors.error.energy / e->largest);
}

status estimate_judge(run *r) {
  status st = OK;
  r->now.energy.strain = domain_strain_energy(&r->body.d, r->now.u);
  domain_stress(&r->body.d, r->now.u, NULL, r->result.stress);
  TRY(estimate_solver(r));
  TRY(estimate_mesh(r));
  r->errors.judged = 1;
done:
  return st;
}

/* The bound counts from the discrete solution, which rounding has missed. */
static void add_rounding(run *r) {
  solver_error e = {.rate = r->errors.error.rate, .why = r->errors.error.why};
  double cpu = r->errors.error.cpu;
  if (!r->errors.rounding.found || !r->errors.error.asked || e.why != NULL)
    return;
  e.norm = sqrt(2.0 * r->errors.error.energy) + r->errors.rounding.norm;
  error_bound_set(&e, r->now.energy.strain, &r->errors.error);
  r->errors.error.cpu = cpu;
}

status estimate_increment(run *r) {
  status st = OK;
  TRY(rounding_find(r));
  if (!r->errors.judged) {
    TRY(estimate_solver(r));
    TRY(estimate_mesh(r));
  }
  add_rounding(r);
  TRY(rounding_hidden(r, &r->errors.error.hidden));
  r->errors.judged = 0;
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

/* ---- warnings -----------------------------------------------------------
 *
 * What makes an answer doubtful though its equations are solved: strains that
 * are not small, elements turned inside out by the displacements, a contact
 * that no node ever touched. Each is told once a run.
 */

static const double LARGE = 0.05; /* -, strain                                */

static const char *section_of(const run *r, int elem_id) {
  return r->m->sections[r->m->elem_section[elem_id]].elset;
}

static void warn_deformation(run *r, int increment_no) {
  deformation x;
  if (r->course.told.strain && r->course.told.folded) return;
  domain_deformation(&r->body.d, r->now.u, &x);
  if (!r->course.told.strain && x.strain > LARGE) {
    r->course.told.strain = 1;
    message_add(r->m->log, P4019, &r->step->at,
                "step %d, increment %d, time %g: the strain of element %zu "
                "(group %s) is %.3g %%; strains are taken as small",
                run_step_id(r) + 1, increment_no, r->now.t,
                r->msh->elem_no[x.strain_elem], section_of(r, x.strain_elem),
                100.0 * x.strain);
  }
  if (!r->course.told.folded && x.volume <= 0.0) {
    r->course.told.folded = 1;
    message_add(r->m->log, P4020, &r->step->at,
                "step %d, increment %d, time %g: the displacements turn "
                "element %zu (group %s) inside out",
                run_step_id(r) + 1, increment_no, r->now.t,
                r->msh->elem_no[x.volume_elem], section_of(r, x.volume_elem));
  }
}

/* Which contacts touch; the listing tells when one does that did not. */
static void note_touches(run *r) {
  for (int i = 0; i < r->m->n_contact; ++i) {
    const contact_total *t = &r->result.totals[i];
    const size_t used = strlen(r->course.note);
    if (r->course.told.touched[i] || t->n_slip + t->n_stick == 0) continue;
    r->course.told.touched[i] = 1;
    if (r->course.total_no > 1)
      snprintf(r->course.note + used, sizeof r->course.note - used,
               "  contact %s touches for the first time\n",
               r->m->contacts[i].name);
  }
}

void warn_increment(run *r, int increment_no) {
  note_touches(r);
  if (r->solving.report.outcome > 0) warn_deformation(r, increment_no);
}

/* The least gap left of a contact, m; HUGE_VAL: it has no node. */
static double least_gap(const run *r, int contact_id) {
  double least = HUGE_VAL;
  for (int i = 0; i < r->nodes.n; ++i)
    if (r->surface->contact_id[i] == contact_id)
      least = fmin(least, r->result.open_gap[i]);
  return least;
}

void warn_end(run *r) {
  for (int i = 0; i < r->m->n_contact; ++i) {
    const contact *c = &r->m->contacts[i];
    if (r->course.told.touched[i] || c->force.given) continue;
    message_add(r->m->log, P4021, &c->at,
                "*CONTACT %s: no node touched obstacle %s in the run; the "
                "least gap at its end is %.3g",
                c->name, c->obstacle_name, least_gap(r, i));
  }
}
