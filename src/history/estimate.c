/*
 * What is asked about the answer of the contact solver at an accepted
 * increment: how far it is from the solution, whether it is the only one, and
 * whether a path leads to it (for large friction both are not known).
 *
 * The error is the bound of accuracy.h,
 * in energy units and relative to the energy norm of the body. The interior
 * follows the contact nodes exactly, so that the error of the whole body has
 * the energy of that of the condensed problem.
 */
#include "base/memory.h"
#include "base/timer.h"
#include "history/loop.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

const char *const error_bound_indefinite =
    "the matrix is not symmetric and positive semidefinite";
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
  solver_error found = {.norm = NAN, .why = weakly_held};
  inverse_energy inverse;
  double cpu = timer_cpu();
  r->error = (error_bound){0};
  if (r->n == 0 || r->step->no_solver_error) return OK;
  timer_enter(STAGE_ESTIMATE);
  if (!r->limit_known) known_rate_forget(&r->rate);
  if (choose_inverse(r, &inverse))
    TRY(solver_error_bound(&r->cp, &inverse, run_rows(r, 0, r->now.uc),
                           run_rows(r, 1, r->now.rc), &r->rate, &found));
  error_bound_set(&found, r->now.energy.strain, &r->error);
  r->error.cpu = r->bound_cpu += timer_cpu() - cpu;
done:
  timer_leave(STAGE_ESTIMATE);
  return st;
}

void estimate_unloaded(run *r) {
  const energies *e = &r->now.energy;
  if (rounding_is_all(r)) {
    r->mesh_error.relative = r->time_error.relative = 0.0;
    if (r->error.why == NULL) r->error.relative = 0.0;
    return;
  }
  if (!(e->strain < UNLOADED * e->largest)) return;
  double share = sqrt(fmax(e->strain, 0.0) / e->largest);
  r->mesh_error.relative *= share;
  r->time_error.relative *= share;
  if (r->error.asked && r->error.why == NULL)
    r->error.relative = sqrt(r->error.energy / e->largest);
}

static status find_truth(run *r) {
  status st = OK;
  double cpu = timer_cpu();
  const answer_fields a = {r->now.t, r->now.u, r->stress, r->now.rc};
  r->truth.asked = (r->m->effects & EFFECT_REFERENCE) != 0;
  if (!r->truth.asked) return OK;
  TRY(truth_find(&r->m->ref, &r->d, &a, &r->truth));
  r->truth.cpu += timer_cpu() - cpu;
done:
  return st;
}

status estimate_judge(run *r) {
  status st = OK;
  r->now.energy.strain = domain_strain_energy(&r->d, r->now.u);
  domain_stress(&r->d, r->now.u, NULL, r->stress);
  TRY(estimate_solver(r));
  TRY(estimate_mesh(r));
  r->judged = 1;
done:
  return st;
}

/* The bound counts from the discrete solution, which rounding has missed. */
static void add_rounding(run *r) {
  solver_error e = {.rate = r->error.rate, .why = r->error.why};
  double cpu = r->error.cpu;
  if (!r->rounding.found || !r->error.asked || e.why != NULL) return;
  e.norm = sqrt(2.0 * r->error.energy) + r->rounding.norm;
  error_bound_set(&e, r->now.energy.strain, &r->error);
  r->error.cpu = cpu;
}

status estimate_increment(run *r) {
  status st = OK;
  TRY(rounding_find(r));
  if (!r->judged) {
    TRY(estimate_solver(r));
    TRY(estimate_mesh(r));
  }
  add_rounding(r);
  r->judged = 0;
  TRY(find_truth(r));
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

/* ---- jumps --------------------------------------------------------------
 *
 * Where the fixed point on the sliding limit contracts with rate k, the motion
 * of an increment is at most 1/(1 - k) times the change of its load, both in
 * the energy norm. An increment that moves by more is halved again and again
 * in the half that moves most: the motion of a branch of solutions then falls
 * with the load, that of a jump does not.
 */

enum { HALVINGS = 16 };
static const double SUSPECT = 2.0; /* -, motion over load                     */
static const double LEFT = 0.25;   /* -, of the motion, in 2^-16 of the load  */

/* |a - b|_A of contact displacements; room[2*n_c]. */
static double distance(const run *r, const double *a, const double *b,
                       double *room) {
  double sum = 0.0;
  for (int i = 0; i < r->n_c; ++i) room[i] = a[i] - b[i];
  const double *d = run_rows(r, 0, room);
  contact_product(r->n_row, r->cp.A, d, room + r->n_c);
  for (int i = 0; i < r->n_row; ++i) sum += d[i] * room[r->n_c + i];
  return sqrt(fmax(sum, 0.0));
}

/* What the load and the obstacles can move, in the energy norm; room[2*n_c]. */
static status load_change(run *r, double *room, double *size) {
  status st = OK;
  double square = 0.0;
  *size = distance(r, r->now.motion, r->old.motion, room);
  for (int i = 0; i < r->n_row; ++i) room[i] = r->f[i] - r->f_before[i];
  if (r->moduli.n_own > 0 || r->n_before != r->n_row) { /* other matrix       */
    const double *rc = run_rows(r, 1, r->old.rc);
    contact_product(r->n_row, r->cp.A, run_rows(r, 0, r->old.uc),
                    room + r->n_c);
    for (int i = 0; i < r->n_row; ++i)
      room[i] = r->f[i] + rc[i] - room[r->n_c + i];
  }
  if (condensed_floating(r->c))
    square = HUGE_VAL;
  else
    TRY(condensed_force_energy(r->c, room, &square));
  *size += sqrt(square);
done:
  return st;
}

/* One end of the part of the increment that moves most. */
typedef struct path_end {
  double t;  /* s                                                             */
  double *u; /* [m]                                                           */
} path_end;

/* Halve the increment to the end: *share of the motion that stays. */
static status follow_motion(run *r, path_end *from, path_end *to, double *room,
                            double *share) {
  status st = OK;
  size_t bytes = (size_t)r->n_c * sizeof *from->u;
  double all = distance(r, to->u, from->u, room);
  *share = 1.0;
  for (int k = 0; k<HALVINGS && * share> LEFT; ++k) {
    double middle = 0.5 * (from->t + to->t);
    TRY(increment_solve(r, middle));
    if (r->report.outcome <= 0) break;
    double before = distance(r, r->now.uc, from->u, room);
    double after = distance(r, to->u, r->now.uc, room);
    path_end *end = before >= after ? to : from;
    end->t = middle;
    memcpy(end->u, r->now.uc, bytes);
    *share = fmax(before, after) / all;
  }
done:
  return st;
}

static void note_jump(run *r, double t, double share) {
  size_t used = strlen(r->note);
  r->jumps = 1;
  r->jump_t = t;
  snprintf(r->note + used, sizeof r->note - used,
           "  JUMP: no path of equilibria leads here: at time %.6g, within "
           "%.0e of the load of the\n  increment, the state changes by %.0f %% "
           "of its motion; the run goes on with another branch\n",
           t, ldexp(1.0, -HALVINGS), 100 * share);
}

status jump_check(run *r, double t) {
  status st = OK;
  double change = HUGE_VAL, share = 0.0, *room = NULL;
  path_end from = {r->old.t, NULL}, to = {t, NULL};
  size_t bytes = (size_t)r->n_c * sizeof *room;
  if (r->n == 0 || r->cp.B == NULL || r->cp.floating) return OK;
  if (r->step->kind != STEP_QUASISTATIC) return OK;
  timer_enter_whole(STAGE_CHECK);
  NEW(room, 2 * r->n_c);
  TRY(load_change(r, room, &change));
  if (!(distance(r, r->now.uc, r->old.uc, room) > SUSPECT * change)) goto done;
  NEW(from.u, r->n_c);
  NEW(to.u, r->n_c);
  memcpy(from.u, r->old.uc, bytes);
  memcpy(to.u, r->now.uc, bytes);
  TRY(follow_motion(r, &from, &to, room, &share));
  TRY(increment_solve(r, t));
  if (share > LEFT) note_jump(r, to.t, share);
done:
  memory_free(room);
  memory_free(from.u);
  memory_free(to.u);
  timer_leave(STAGE_CHECK);
  return st;
}
