/*
 * What is asked about the answer of the contact solver at an accepted
 * increment: how far it is from the solution, whether it is the only one, and
 * whether a path leads to it (for large friction both are not known); and what
 * makes it doubtful.
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

status check_increment(run *r) {
  return check_problem(r->step, &r->problem.cp, &r->solving.report, r->now.uc,
                       r->now.rc, &r->errors.solutions);
}

/* ---- jumps --------------------------------------------------------------
 *
 * Where the fixed point on the sliding limit contracts with rate k, the motion
 * of an increment is at most 1/(1 - k) times the change of its load, both in
 * the energy norm, and the states in between form a path. An increment that
 * moves by more, or in whose slip k is 1 or more, is looked into: states at
 * times in between are solved for, always in the middle of the part that moves
 * most. A part with the same statuses at both ends holds no jump. The motion of
 * a path falls with the length of the part, that of a jump does not. AUTO
 * solves, also where the method of the deck has missed the tolerance; nothing
 * is said of an increment that starts from a state far off.
 */

enum { DEPTH = 16, /* halvings of the increment */ POINTS = 80 };
static const double SUSPECT = 2.0; /* -, motion over load                     */
static const double LEFT = 0x1p-6; /* -, of the motion, in 2^-16 of the load  */
static const double RATE = 0.98;   /* -, of a measured rate: it may be 1      */
static const double NEAR = 1e-2;   /* -, residual of a state near the path    */
static const double STILL = 0x1p-30; /* -, of the largest slip: none          */

/* |a - b|_A of contact displacements; room[2*n_c]. */
static double distance(const run *r, const double *a, const double *b,
                       double *room) {
  double sum = 0.0;
  for (int i = 0; i < r->nodes.n_c; ++i) room[i] = a[i] - b[i];
  const double *d = run_rows(r, 0, room);
  contact_product(r->nodes.n_row, r->problem.cp.A, d, room + r->nodes.n_c);
  for (int i = 0; i < r->nodes.n_row; ++i) sum += d[i] * room[r->nodes.n_c + i];
  return sqrt(fmax(sum, 0.0));
}

/* What the load and the obstacles can move, in the energy norm; room[2*n_c]. */
static status load_change(run *r, double *room, double *size) {
  status st = OK;
  double square = 0.0;
  *size = distance(r, r->now.motion, r->old.motion, room);
  for (int i = 0; i < r->nodes.n_row; ++i)
    room[i] = r->problem.f[i] - r->problem.f_before[i];
  if (r->body.moduli.n_own > 0 ||
      r->problem.n_before != r->nodes.n_row) { /* other matrix       */
    const double *rc = run_rows(r, 1, r->old.rc);
    contact_product(r->nodes.n_row, r->problem.cp.A, run_rows(r, 0, r->old.uc),
                    room + r->nodes.n_c);
    for (int i = 0; i < r->nodes.n_row; ++i)
      room[i] = r->problem.f[i] + rc[i] - room[r->nodes.n_c + i];
  }
  if (condensed_floating(r->c))
    square = HUGE_VAL;
  else
    TRY(condensed_force_energy(r->c, room, &square));
  *size += sqrt(square);
done:
  return st;
}

/* ---- slip through the increment ------------------------------------------ */

/* Slip of node i since the last equilibrium, m. */
static double slip_of(const contact_problem *cp, const double *u, int i) {
  double slip = 0.0;
  for (int k = 1; k < cp->dim; ++k) {
    int dof = i * cp->dim + k;
    if (!contact_held(cp, dof))
      slip = hypot(slip, u[dof] - contact_stick(cp, dof));
  }
  return slip;
}

/* The state in which every node that has moved, and touches at one end of the
 * increment, slides: u[m], q[m]. */
static void set_sliding(const contact_problem *cp, const double *before,
                        double *u, double *q) {
  double most = 0.0;
  for (int i = 0; i < cp->n; ++i) {
    int normal = i * cp->dim;
    double push = fmin(before[normal], q[normal]);
    if (push < 0.0) u[normal] = cp->gap[i];
    q[normal] = fmin(push, 0.0);
    most = fmax(most, slip_of(cp, u, i));
  }
  for (int i = 0; i < cp->n; ++i) {
    double slip = slip_of(cp, u, i), g = contact_node_limit(cp, q, i);
    for (int k = 1; k < cp->dim; ++k) {
      int dof = i * cp->dim + k;
      int moves = slip > STILL * most && !contact_held(cp, dof);
      q[dof] = moves ? -g * (u[dof] - contact_stick(cp, dof)) / slip : 0.0;
    }
  }
}

static status sliding_rate(run *r, double *rate) {
  status st = OK;
  const contact_problem *cp = &r->problem.cp;
  size_t m = (size_t)cp->m;
  double *u = NULL, *q = NULL, *before = NULL;
  NEW(u, m);
  NEW(q, m);
  NEW(before, m);
  memcpy(before, run_rows(r, 1, r->old.rc), m * sizeof *before);
  memcpy(u, run_rows(r, 0, r->now.uc), m * sizeof *u);
  memcpy(q, run_rows(r, 1, r->now.rc), m * sizeof *q);
  set_sliding(cp, before, u, q);
  TRY(contraction_rate(cp, u, q, &r->solving.rate, rate));
done:
  memory_free(u);
  memory_free(q);
  memory_free(before);
  return st;
}

/* ---- states in between --------------------------------------------------- */

typedef struct point {
  double t;               /* s                                                */
  double *u;              /* [n_c] m                                          */
  contact_status *status; /* [n] of the nodes of r->problem.cp */
  double motion;          /* to the next point, energy norm                   */
} point;

typedef struct path {
  run *r;
  point p[POINTS];
  int n;
  double shortest, least; /* part that is not halved, s; motion that counts   */
  double *room;           /* [2*n_c]                                          */
} path;

static void path_free(path *s) {
  for (int k = 0; k < s->n; ++k) {
    memory_free(s->p[k].u);
    memory_free(s->p[k].status);
  }
  memory_free(s->room);
}

/* The state u, rc as point number "at". */
static status insert(path *s, int at, double t, const double *u,
                     const double *rc) {
  status st = OK;
  run *r = s->r;
  memmove(s->p + at + 1, s->p + at, (size_t)(s->n - at) * sizeof *s->p);
  s->p[at] = (point){.t = t};
  ++s->n;
  NEW(s->p[at].u, r->nodes.n_c);
  NEW(s->p[at].status, r->nodes.n);
  memcpy(s->p[at].u, u, (size_t)r->nodes.n_c * sizeof *u);
  contact_classify(&r->problem.cp, run_rows(r, 0, s->p[at].u),
                   run_rows(r, 1, (double *)rc), s->p[at].status);
done:
  return st;
}

/* 0 where the statuses at both ends of part k are the same. */
static void measure(path *s, int k) {
  point *a = s->p + k, *b = a + 1;
  size_t bytes = (size_t)s->r->problem.cp.n * sizeof *a->status;
  a->motion = memcmp(a->status, b->status, bytes) == 0
                  ? 0.0
                  : distance(s->r, b->u, a->u, s->room);
}

/* Halve what moves most until it is short, *found, or moves by nothing. */
static status follow(path *s, int *found) {
  status st = OK;
  run *r = s->r;
  *found = -1;
  while (s->n < POINTS) {
    int k = 0;
    for (int j = 1; j + 1 < s->n; ++j)
      if (s->p[j].motion > s->p[k].motion) k = j;
    if (!(s->p[k].motion > s->least)) break;
    if (s->p[k + 1].t - s->p[k].t <= s->shortest) {
      *found = k;
      break;
    }
    double middle = 0.5 * (s->p[k].t + s->p[k + 1].t);
    TRY(increment_solve(r, middle));
    if (r->solving.report.outcome <= 0) break;
    TRY(insert(s, k + 1, middle, r->now.uc, r->now.rc));
    measure(s, k);
    measure(s, k + 1);
  }
done:
  return st;
}

/* AUTO in the place of the method of the deck, so that the answer does not
 * depend on it; *own: that of the deck. */
static status lend_solver(run *r, contact_solver **own) {
  status st = OK;
  solver_choice choice = r->step->solver;
  choice.ops = NULL;
  choice.param = NULL;
  choice.max_iter = 0;
  *own = r->elastic.solver;
  r->elastic.solver = NULL;
  TRY(contact_solver_new(&choice, &r->elastic.solver));
done:
  return st;
}

static void give_back(run *r, contact_solver *own) {
  contact_solver_free(r->elastic.solver);
  r->elastic.solver = own;
  r->solver = own;
}

static void note_jump(run *r, double t, double share) {
  size_t used = strlen(r->course.note);
  r->errors.jumps = 1;
  r->errors.jump_t = t;
  snprintf(r->course.note + used, sizeof r->course.note - used,
           "  JUMP: no path of equilibria leads here: at time %.6g, within "
           "%.0e of the load of the\n  increment, the state changes by %.0f %% "
           "of its motion; the run goes on with another branch\n",
           t, ldexp(1.0, -DEPTH), 100 * share);
}

/* *share of the motion, 0: no jump; *at: its time, s. r->now is lost. */
static status look_into(run *r, double t, double *at, double *share) {
  status st = OK;
  path s = {.r = r, .shortest = ldexp(t - r->old.t, -DEPTH) * 1.5};
  contact_solver *own = NULL;
  int found = -1;
  TRY(lend_solver(r, &own));
  NEW(s.room, 2 * r->nodes.n_c);
  TRY(increment_solve(r, t));
  if (r->solving.report.outcome <= 0) goto done;
  TRY(insert(&s, 0, t, r->now.uc, r->now.rc));
  TRY(insert(&s, 0, r->old.t, r->old.uc, r->old.rc));
  double all = distance(r, s.p[1].u, s.p[0].u, s.room);
  s.least = LEFT * all;
  measure(&s, 0);
  TRY(follow(&s, &found));
  if (found < 0) goto done;
  *at = s.p[found + 1].t;
  *share = s.p[found].motion / all;
done:
  if (own != NULL) give_back(r, own);
  path_free(&s);
  return st;
}

status jump_check(run *r, double t) {
  status st = OK;
  double change = HUGE_VAL, rate = 0.0, share = 0.0, at = 0.0, *room = NULL;
  int missed = r->solving.report.outcome <= 0, lost = r->at.lost;
  r->at.lost = missed && !(r->solving.report.residual <= NEAR);
  if (r->nodes.n == 0 || r->problem.cp.B == NULL || r->problem.cp.floating ||
      lost)
    return OK;
  if (r->step->kind != STEP_QUASISTATIC) return OK;
  timer_enter_whole(STAGE_CHECK);
  NEW(room, 2 * r->nodes.n_c);
  TRY(load_change(r, room, &change));
  int leaps = distance(r, r->now.uc, r->old.uc, room) > SUSPECT * change;
  if (!missed && !leaps) TRY(sliding_rate(r, &rate));
  if (!missed && !leaps && !(rate >= RATE)) goto done;
  TRY(look_into(r, t, &at, &share));
  TRY(increment_solve(r, t));
  if (share > 0.0) note_jump(r, at, share);
done:
  memory_free(room);
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
