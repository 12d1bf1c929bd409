/*
 * One equilibrium: loads and obstacles at time t, condensed load, sliding
 * limit, contact solver, recovery of the interior (CPR98, problem S_i^n).
 */
#include "run/run.h"

#include "base/memory.h"
#include "base/timer.h"

#include <math.h>
#include <string.h>

/* A contact unknown that *BOUNDARY prescribes: its value now, m. */
static double held_value(const run *r, int i, int a) {
  const contact_surface *s = r->surface;
  int dim = s->dim;
  double u = 0.0;
  for (int c = 0; c < dim; ++c)
    u += s->frame[dim * dim * i + dim * a + c] * r->ud[dim * s->node_id[i] + c];
  return u;
}

/* 1 if the sliding limit of a node can be above zero. */
static int can_stick(const run *r, int i) {
  const sparse_rows *B = &r->limit.B;
  if (r->limit.g0[i] > 0.0) return 1;
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
  int fresh = r->step->kind == STEP_STATIC && !r->relaxing;
  int history = (r->m->effects & EFFECT_HISTORY) != 0;
  if (r->ut0 == NULL) return OK;
  if (history) timer_enter(STAGE_HISTORY);
  for (int i = 0; i < r->n; ++i)
    for (int a = 1; a < dim; ++a) {
      int k = dim * i + a;
      double from = fresh ? 0.0 : r->old.uc[k] - r->old.motion[k];
      double stick = from + r->now.motion[k];
      if (r->surface->held[k]) {
        double to = held_value(r, i, a);
        TRY(check_held(r, i, a, stick, to));
        stick = to;
      }
      r->ut0[(dim - 1) * i + a - 1] = stick;
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
  int friction = (r->m->effects & EFFECT_FRICTION) != 0;
  r->cp = (contact_problem){
      .dim = r->msh->dim,
      .n = r->n,
      .m = r->n_c,
      .A = condensed_matrix(r->c),
      .f = r->f,
      .gap = r->gap,
      .ut0 = r->ut0,
      .g0 = friction ? r->limit.g0 : NULL,
      .B = friction ? limit_matrix(r) : NULL,
      .side_gap = has_side_gap(r->surface) ? r->side_gap : NULL,
      .held = has_held(r->surface) ? r->surface->held : NULL,
      .floating = condensed_floating(r->c)};
}

static status load_at(run *r, double t) {
  status st = OK;
  timer_enter(STAGE_LOAD);
  st = load_forces(r->m, r->msh, r->step, t, r->now.F);
  if (st == OK) st = load_prescribed(r->m, r->msh, r->step, t, r->start, r->ud);
  timer_leave(STAGE_LOAD);
  return st;
}

static status pose_contact(run *r, double t) {
  status st = OK;
  timer_enter(STAGE_SURFACE);
  st = surface_gap(r->surface, &r->input, t, r->gap, r->side_gap);
  memcpy(r->now.motion, r->old.motion, (size_t)r->n_c * sizeof *r->now.motion);
  surface_drift(r->surface, &r->input, r->old.t, t, r->now.motion);
  timer_leave(STAGE_SURFACE);
  TRY(st);
  TRY(limit_update(r, t));
  TRY(set_stick_position(r));
  set_problem(r);
done:
  return st;
}

/* Condensed load and contact problem under the forces F. */
static status pose(run *r, const double *F) {
  status st = OK;
  r->report = (solver_report){.outcome = CONVERGED, .solver = "linear"};
  TRY(condense_load(r->c, F, r->ud, r->f));
  if (r->n > 0) TRY(pose_contact(r, r->now.t));
done:
  return st;
}

status increment_begin(run *r, double t) {
  status st = OK;
  r->now.t = t;
  TRY(load_at(r, t));
  TRY(strains_update(r));
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

status increment_equilibrium(run *r, const double *F) {
  status st = OK;
  int iterations = 0;
  TRY(pose(r, F));
  while (r->n > 0) {
    TRY(forms_solve(r));
    iterations += r->report.iterations;
    r->report.iterations = iterations;
    if (!limit_follow_zone(r)) break;
  }
  TRY(condense_recover(r->c, r->now.uc, r->now.u));
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
