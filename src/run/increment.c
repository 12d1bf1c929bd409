/*
 * One equilibrium: loads and obstacles at time t, condensed load, sliding
 * limit, contact solver, recovery of the interior (CPR98, problem S_i^n).
 * The problem goes to the solver in the form the deck asks for: with given
 * normal forces taken out (*CONTACT FORCE), in the displacement or in its
 * change (*QUASISTATIC, FORM=).
 */
#include "run/run.h"

#include "base/memory.h"
#include "base/sparse.h"
#include "base/timer.h"
#include "contact/formulation/form.h"

#include <math.h>
#include <string.h>

struct forms {
  velocity_form *velocity; /* NULL until asked for */
  given_form *given; /* NULL until asked for                             */
  int n, *node;      /* [n] contact nodes with a given normal force      */
  double *force;     /* [n] N, >= 0                                      */
};

void forms_free(forms *f) {
  if (f == NULL) return;
  velocity_form_free(f->velocity);
  given_form_free(f->given);
  memory_free(f->node);
  memory_free(f->force);
  memory_free(f);
}

static const given_force *force_of(const run *r, int i) {
  return &r->m->contacts[r->surface->contact_id[i]].force;
}

/* The contact with a given force among those that meet in a corner, or -1. */
static int forced_corner(const run *r, int i) {
  const contact_surface *s = r->surface;
  int id = s->contact_id[i];
  if (!surface_is_corner(s, i)) return -1;
  for (int k = 0; k < s->dim - 1 && !r->m->contacts[id].force.given; ++k)
    if (s->side_id[(s->dim - 1) * i + k] >= 0)
      id = s->side_id[(s->dim - 1) * i + k];
  return r->m->contacts[id].force.given ? id : -1;
}

/* Two contacts at one node take its normals for unilateral conditions. */
static status check_corners(const run *r) {
  status st = OK;
  for (int i = 0; i < r->nodes.n; ++i) {
    int id = forced_corner(r, i);
    if (id < 0) continue;
    message_add(r->m->log, P4012, &r->m->contacts[id].force.at,
                "contact %s meets another contact at node %zu",
                r->m->contacts[id].name, r->surface->node_no[i]);
    FAIL(ERR_DECK, "*CONTACT FORCE at a corner of two contacts");
  }
done:
  return st;
}

status forms_new(run *r) {
  status st = OK;
  forms_free(r->problem.forms);
  r->problem.forms = NULL;
  NEW(r->problem.forms, 1);
  if (!(r->m->effects & EFFECT_GIVEN)) goto done;
  forms *f = r->problem.forms;
  TRY(check_corners(r));
  NEW(f->node, r->nodes.n);
  for (int i = 0; i < r->nodes.n; ++i)
    if (force_of(r, i)->given) f->node[f->n++] = i;
  NEW(f->force, f->n);
done:
  return st;
}

/* The unknown of a row of r->problem.cp among those of all contact nodes. */
static int unknown_of(const run *r, int row) {
  int i = row / r->nodes.rows;
  return r->msh->dim * (r->nodes.reach.in != NULL ? r->nodes.reach.in[i] : i) +
         row % r->nodes.rows;
}

double *run_rows(const run *r, int k, double *v) {
  if (r->nodes.n_row == r->nodes.n_c) return v;
  for (int i = 0; i < r->nodes.n_row; ++i)
    r->problem.row[k][i] = v[unknown_of(r, i)];
  return r->problem.row[k];
}

/* The answer u, r of r->problem.cp: other forces are zero. */
static void put_rows(const run *r, const double *u, const double *force) {
  if (r->nodes.n_row == r->nodes.n_c) return;
  memset(r->now.rc, 0, (size_t)r->nodes.n_c * sizeof *r->now.rc);
  for (int i = 0; i < r->nodes.n_row; ++i) {
    r->now.uc[unknown_of(r, i)] = u[i];
    r->now.rc[unknown_of(r, i)] = force[i];
  }
}

/* Displacements of the contact nodes that were found with the interior. */
static void take_interior(const run *r) {
  const contact_surface *s = r->surface;
  int dim = r->msh->dim, next = 0;
  if (r->nodes.n_row == r->nodes.n_c) return;
  for (int i = 0; i < r->nodes.n; ++i) {
    int is_in = r->nodes.reach.in == NULL ||
                (next < r->nodes.reach.n_in && r->nodes.reach.in[next] == i);
    next += is_in;
    for (int a = is_in ? r->nodes.rows : 0; a < dim; ++a) {
      double sum = 0.0;
      for (int c = 0; c < dim; ++c)
        sum += s->frame[dim * (dim * i + a) + c] *
               r->now.u[dim * s->node_id[i] + c];
      r->now.uc[dim * i + a] = sum;
    }
  }
}

/* The given pressures at time t times the areas of the nodes. */
static status set_forces(run *r, double t) {
  status st = OK;
  forms *f = r->problem.forms;
  const contact_surface *s = r->surface;
  for (int k = 0; k < f->n; ++k) {
    int i = f->node[k];
    double x[3] = {0.0, 0.0, 0.0};
    memcpy(x, s->x + s->dim * i, (size_t)s->dim * sizeof *x);
    const given_force *given = force_of(r, i);
    double p = quantity_value(&given->value, x, t);
    f->force[k] = p * s->area[i];
    if (isfinite(p) && p >= 0.0) continue;
    message_add(r->m->log, P2041, &given->value_at,
                "*CONTACT FORCE: value %g at node %zu (%g, %g, %g), time %g; "
                "expected a number that is not negative",
                p, s->node_no[i], x[0], x[1], x[2], t);
    FAIL(ERR_DECK, "%s:%d: a given contact force is negative or no number",
         given->value_at.file, given->value_at.line_no);
  }
done:
  return st;
}

status forms_given(run *r, double t, double *given) {
  status st = OK;
  const forms *f = r->problem.forms;
  for (int i = 0; i < r->nodes.n; ++i) given[i] = -1.0;
  TRY(set_forces(r, t));
  for (int k = 0; k < f->n; ++k) given[f->node[k]] = f->force[k];
done:
  return st;
}

/* *cp with the given normal forces in the place of the unilateral condition;
 * u, rc hold the start values. */
static status take_given(run *r, double *u, double *rc, contact_problem *cp) {
  status st = OK;
  forms *f = r->problem.forms;
  contact_problem own = *cp;
  timer_enter(STAGE_GIVEN);
  TRY(set_forces(r, r->now.t));
  if (f->given == NULL) TRY(given_form_new(cp, f->n, f->node, &f->given));
  TRY(given_form_set(f->given, &own, f->force, r->msh->size, u, rc, cp));
done:
  timer_leave(STAGE_GIVEN);
  return st;
}

/* The last equilibrium, from which the increment and its slip are counted:
 * start values may be others. Normals with a given force stand apart, at 0. */
static void put_old(const run *r, double *u_old) {
  const forms *f = r->problem.forms;
  for (int i = 0; i < r->nodes.n_row; ++i)
    u_old[i] = r->old.uc[unknown_of(r, i)];
  for (int k = 0; k < f->n; ++k) u_old[r->nodes.rows * f->node[k]] = 0.0;
}

/* *cp in the displacement of the increment; *u: start values of the unknown
 * before in, of that out. */
static status take_velocity(run *r, contact_problem *cp, double **u) {
  status st = OK;
  forms *f = r->problem.forms;
  contact_problem own = *cp;
  timer_enter(STAGE_VELOCITY);
  if (f->velocity == NULL) TRY(velocity_form_new(cp, &f->velocity));
  put_old(r, velocity_form_old(f->velocity));
  velocity_form_set(f->velocity, &own, cp, u);
done:
  timer_leave(STAGE_VELOCITY);
  return st;
}

static double residual_of(run *r, double *u, double *rc) {
  return contact_residual(&r->problem.cp, run_rows(r, 0, u),
                          run_rows(r, 1, rc));
}

/* Start values: the last equilibrium, or the guess if it is nearer. */
static void take_start(run *r) {
  size_t bytes = (size_t)r->nodes.n_c * sizeof *r->now.uc;
  const double *u = r->old.uc, *rc = r->old.rc;
  if (r->solving.guess_u != NULL && !r->course.beside &&
      residual_of(r, r->solving.guess_u, r->solving.guess_r) <
          residual_of(r, r->old.uc, r->old.rc)) {
    u = r->solving.guess_u;
    rc = r->solving.guess_r;
  }
  memcpy(r->now.uc, u, bytes);
  memcpy(r->now.rc, rc, bytes);
}

static int is_open(const run *r, const double *uc) {
  for (int i = 0; i < r->nodes.n; ++i)
    if (!(r->problem.gap[i] > uc[r->msh->dim * i])) return 0;
  return 1;
}

/*
 * A body in the air: the answer without contact forces, if its residual,
 * written to *residual, is not above that. The tolerance of a method, of
 * forces in the scale of the motion (contact_scale), would leave forces that
 * no contact carries.
 */
static status drop_reactions(const run *r, double *residual, double *u,
                             double *rc) {
  status st = OK;
  double *q = NULL, *zero = NULL;
  if (r->course.beside || r->problem.forms->n > 0 || condensed_floating(r->c))
    goto done;
  NEW(q, r->nodes.n_row);
  NEW(zero, r->nodes.n_row);
  TRY(condensed_untouched(r->c, r->problem.cp.f, q));
  double left = contact_residual(&r->problem.cp, q, zero);
  if (!(left <= *residual)) goto done;
  *residual = left;
  memcpy(u, q, (size_t)r->nodes.n_row * sizeof *u);
  memset(rc, 0, (size_t)r->nodes.n_row * sizeof *rc);
done:
  memory_free(q);
  memory_free(zero);
  return st;
}

/* r->problem.cp solved in the form asked for, from r->old into r->now. */
static status forms_solve(run *r) {
  status st = OK;
  const solver_listener listener = {r->sink->iteration, r->sink->ctx};
  const solver_listener *told =
      listener.step == NULL || r->course.beside ? NULL : &listener;
  int given = r->problem.forms->n > 0, in_du = r->step->form == FORM_VELOCITY;
  contact_problem whole = r->problem.cp, cp;
  take_start(r);
  double *own_u = run_rows(r, 0, r->now.uc), *u = own_u;
  double *rc = run_rows(r, 1, r->now.rc);
  double tol = r->solving.tol;
  if (is_open(r, r->old.uc) &&
      largest_entry((size_t)r->nodes.n_c, r->old.rc) == 0.0)
    TRY(drop_reactions(r, &tol, u, rc));
  if (given) TRY(take_given(r, u, rc, &whole));
  cp = whole;
  if (in_du) TRY(take_velocity(r, &cp, &u));
  timer_enter(STAGE_CONTACT);
  contact_solver_tolerance(r->solver, r->solving.tol);
  st = contact_solve(r->solver, &cp, told, u, rc, &r->solving.report);
  timer_leave(STAGE_CONTACT);
  TRY(st);
  r->problem.cp.bodies = contact_solver_bodies(r->solver, &cp);
  if (in_du) velocity_form_apply(r->problem.forms->velocity, &whole, own_u);
  if (given)
    given_form_apply(r->problem.forms->given, &r->problem.cp, own_u, rc);
  put_rows(r, own_u, rc);
  if (is_open(r, r->now.uc) &&
      largest_entry((size_t)r->nodes.n_c, r->now.rc) > 0.0) {
    TRY(drop_reactions(r, &r->solving.report.residual, own_u, rc));
    put_rows(r, own_u, rc);
  }
done:
  return st;
}

/* ---- the problem ------------------------------------------------------- */

/* A contact unknown that *BOUNDARY prescribes: its value now, m. */
static double held_value(const run *r, int i, int a) {
  const contact_surface *s = r->surface;
  int dim = s->dim;
  double u = 0.0;
  for (int c = 0; c < dim; ++c)
    u += s->frame[dim * dim * i + dim * a + c] *
         r->loads.ud[dim * s->node_id[i] + c];
  return u;
}

/* 1 if the sliding limit of a node can be above zero. */
static int can_stick(const run *r, int i) {
  const sparse_rows *B = &r->friction.limit.B;
  if (r->friction.limit.g0[i] > 0.0) return 1;
  for (int e = B->start == NULL ? 0 : B->start[i];
       B->start != NULL && e < B->start[i + 1]; ++e)
    if (B->val[e] > 0.0) return 1;
  return 0;
}

static int in_group(const mesh_group *g, int node_id) {
  for (int k = 0; k < g->n_node; ++k)
    if (g->node_id[k] == node_id) return 1;
  return 0;
}

/* The *BOUNDARY that holds contact node i most along its axis a, or NULL. */
static const load *holder(const run *r, int i, int a) {
  const contact_surface *s = r->surface;
  const double *axis = &s->frame[s->dim * s->dim * i + s->dim * a];
  const load *best = NULL;
  for (int k = 0; k < r->step->loads.n; ++k) {
    const load *l = &r->step->loads.item[k];
    if (l->kind != LOAD_FIXING ||
        !in_group(&r->msh->group[l->group_id], s->node_id[i]))
      continue;
    if (best == NULL || fabs(axis[l->component]) > fabs(axis[best->component]))
      best = l;
  }
  return best;
}

/*
 * Friction along t2 where t1 is made to move: the slip direction would depend
 * on the prescribed motion, which the condensed problem does not hold.
 */
static status check_held(const run *r, int i, int a, double from, double to) {
  status st = OK;
  const contact_surface *s = r->surface;
  int other = s->dim == 3 ? 3 - a : a;
  if (s->dim < 3 || from == to || s->held[3 * i + other] || !can_stick(r, i))
    goto done;
  const load *l = holder(r, i, a);
  message_add(r->m->log, P4015, l == NULL ? &r->step->at : &l->at,
              "contact node %zu is led in one tangential direction while "
              "friction acts in the other",
              s->node_no[i]);
  FAIL(ERR_DECK, "*BOUNDARY leads contact node %zu against friction",
       s->node_no[i]);
done:
  return st;
}

/*
 * Position of stick: the tangential displacement at the last equilibrium, moved
 * along by the obstacle (CPR98 S_i^n); for one static problem the origin (P2).
 * A prescribed unknown sticks where it is put: its force is the support's.
 */
static status set_stick_position(run *r) {
  status st = OK;
  int dim = r->msh->dim;
  int fresh = r->step->kind == STEP_STATIC && !r->course.relaxing;
  int history = (r->m->effects & EFFECT_HISTORY) != 0;
  if (r->problem.ut0 == NULL) return OK;
  if (history) timer_enter(STAGE_HISTORY);
  for (int i = 0; i < r->nodes.n; ++i)
    for (int a = 1; a < dim; ++a) {
      int k = dim * i + a;
      double from = fresh ? 0.0 : r->old.uc[k] - r->old.motion[k];
      double stick = from + r->now.motion[k];
      if (r->surface->held[k]) {
        double to = held_value(r, i, a);
        TRY(check_held(r, i, a, stick, to));
        stick = to;
      }
      r->problem.ut0[(dim - 1) * i + a - 1] = stick;
    }
done:
  if (history) timer_leave(STAGE_HISTORY);
  return st;
}

static int has_held(const contact_surface *s) {
  for (int k = 0; k < s->n * s->dim; ++k)
    if (s->held[k]) return 1;
  return 0;
}

static int has_side_gap(const contact_surface *s) {
  for (int i = 0; i < s->n * (s->dim - 1); ++i)
    if (s->side_id[i] >= 0) return 1;
  return 0;
}

static void set_problem(run *r) {
  int friction = (r->m->effects & EFFECT_FRICTION) != 0,
      all = r->nodes.rows > 1;
  r->problem.cp = (contact_problem){
      .dim = r->nodes.rows,
      .n = reach_count(&r->nodes.reach, r->nodes.n),
      .m = r->nodes.n_row,
      .A = condensed_matrix(r->c),
      .f = r->problem.f,
      .f_load =
          largest_entry(r->n_dof, r->loads.ud) > 0.0 ? r->problem.f_load : NULL,
      .gap = r->problem.gap,
      .ut0 = r->problem.ut0,
      .g0 = friction ? r->friction.limit.g0 : NULL,
      .B = friction ? limit_matrix(r) : NULL,
      .side_gap = all && has_side_gap(r->surface) ? r->problem.side_gap : NULL,
      .held = all && has_held(r->surface) ? r->surface->held : NULL,
      .floating = condensed_floating(r->c),
      .load = r->loads.largest};
  if (r->nodes.reach.in != NULL)
    reach_cut(&r->nodes.reach, &r->problem.part, &r->problem.cp);
  r->problem.cp.bodies = contact_solver_bodies(r->solver, &r->problem.cp);
}

static status load_at(run *r, double t) {
  status st = OK;
  timer_enter(STAGE_LOAD);
  st = load_forces(r->m, r->msh, r->step, t, r->now.F);
  if (st == OK)
    st = load_prescribed(r->m, r->msh, r->step, t, r->loads.start, r->loads.ud);
  timer_leave(STAGE_LOAD);
  return st;
}

static status pose_contact(run *r, double t) {
  status st = OK;
  timer_enter(STAGE_SURFACE);
  st = surface_gap(r->surface, &r->faces.input, t, r->problem.gap,
                   r->problem.side_gap);
  memcpy(r->now.motion, r->old.motion,
         (size_t)r->nodes.n_c * sizeof *r->now.motion);
  surface_drift(r->surface, &r->faces.input, r->old.t, t, r->now.motion);
  timer_leave(STAGE_SURFACE);
  TRY(st);
  TRY(limit_update(r, t));
  TRY(set_stick_position(r));
  TRY(effects_pose(r, t));
  set_problem(r);
done:
  return st;
}

/* Condensed load and contact problem under the forces F. */
static status pose(run *r, const double *F) {
  status st = OK;
  r->solving.report = (solver_report){.outcome = CONVERGED, .solver = "linear"};
  if (r->nodes.n > 0 && largest_entry(r->n_dof, r->loads.ud) > 0.0)
    TRY(condense_load(r->c, F, NULL, r->problem.f_load));
  TRY(condense_load(r->c, F, r->loads.ud, r->problem.f));
  if (r->nodes.n > 0) TRY(pose_contact(r, r->now.t));
done:
  return st;
}

double increment_free_load(const run *r, const double *F) {
  double most = 0.0;
  for (size_t i = 0; i < r->n_dof; ++i)
    if (!r->body.fixed[i]) most = fmax(most, fabs(F[i]));
  return most;
}

status increment_load(run *r, double t) {
  status st = OK;
  r->now.t = t;
  TRY(load_at(r, t));
  if (r->strains.temperature0 != NULL && r->strains.eigen.n > 0)
    TRY(strains_heat(r));
done:
  return st;
}

status increment_begin(run *r, double t) {
  status st = OK;
  TRY(increment_load(r, t));
  strains_collect(r);
done:
  return st;
}

status increment_pose(run *r, double t) {
  status st = OK;
  TRY(increment_begin(r, t));
  TRY(run_use(r, &r->elastic));
  TRY(pose(r, strains_load(r)));
done:
  return st;
}

/* With the contact nodes at hand; *iterations so far. */
static status solve_with_nodes(run *r, const double *F, int *iterations) {
  status st = OK;
  TRY(pose(r, F));
  while (r->nodes.n > 0) {
    TRY(forms_solve(r));
    *iterations += r->solving.report.iterations;
    r->solving.report.iterations = *iterations;
    int again = limit_follow_zone(r);
    if (!again) TRY(effects_found(r, &again));
    if (!again) break;
  }
  TRY(condense_recover(r->c, run_rows(r, 0, r->now.uc), r->now.u));
  take_interior(r);
done:
  return st;
}

status increment_equilibrium(run *r, const double *F) {
  status st = OK;
  int iterations = 0;
  TRY(solve_with_nodes(r, F, &iterations));
  while (run_misses_nodes(r)) {
    TRY(run_add_nodes(r));
    TRY(solve_with_nodes(r, F, &iterations));
  }
done:
  return st;
}

status increment_solve(run *r, double t) {
  status st = OK;
  TRY(increment_begin(r, t));
  TRY(run_use(r, &r->elastic));
  TRY(increment_equilibrium(r, strains_load(r)));
done:
  return st;
}
