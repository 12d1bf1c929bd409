/*
 * Data that persist while the supports are unchanged: contact surface, its
 * active nodes, condensed stiffness, solver.
 */
#include "run/setup/setup.h"

#include "base/base.h"

/*
 * Contact nodes whose gap is wider than what the step can close are left out of
 * the condensed problem: they are free nodes of the interior, without force.
 * After each solution none of them may penetrate; otherwise, or where no
 * equilibrium was found, more nodes are taken and the problem is solved again.
 * The solution is thus that of all nodes; only its cost depends on the estimate
 * of the distance.
 */
enum { FEWEST = 16 };               /* contact nodes */
static const double GENEROUS = 4.0; /* -, of what loads move a compact body */

/* 1: no force on a node that does not touch, nothing but loads and supports
 * moves the body, and the current problem is that of all increments. */
static int may_leave_out(const run *r, int n_motion) {
  const unsigned effects = r->m->effects;
  if ((effects & EFFECT_TANGENTS) &&
      (!model_rubs_locally(r->m) || (effects & EFFECT_TIME_ERROR)))
    return 0;
  return n_motion == 0 && r->nodes.n >= FEWEST && !effects_reach_far(r) &&
         r->m->n.points == 0 && r->m->reduction.n == 0;
}

int run_least_nodes(const run *r) {
  return may_leave_out(r, 0) ? 0 : r->nodes.n;
}

/* Least diagonal entry of the moduli, Pa, times the section's thickness or the
 * size of the mesh: a body of that size deforms by force over this, N/m. */
static double least_stiffness(const run *r) {
  const domain *d = &r->body.d;
  const int ns = d->ns, flat = d->mesh->dim == 2;
  double least = HUGE_VAL;
  for (int e = 0; e < d->mesh->n_elem; ++e) {
    const int s = d->section_id[e];
    const double *E = d->E + (size_t)(ns * ns) * s;
    double size =
        flat && d->kin[s] != AXISYMMETRIC ? d->thickness[s] : d->mesh->size;
    for (int c = 0; c < d->mesh->dim; ++c)
      least = fmin(least, E[c * (ns + 1)] * size);
  }
  return least;
}

/* Upper estimate of the displacement of the contact nodes in the step, m. */
static status find_active(run *r) {
  double force = 0.0, motion = 0.0, end = r->step->start + r->step->total;
  PASS(load_forces(r->m, r->msh, r->step, end, r->now.F));
  PASS(
      load_prescribed(r->m, r->msh, r->step, end, r->loads.start, r->loads.ud));
  for (size_t k = 0; k < r->n_dof; ++k) {
    force += fabs(r->now.F[k]);
    motion = fmax(motion, fabs(r->old.u[k]));
    if (r->body.fixed[k]) motion = fmax(motion, fabs(r->loads.ud[k]));
  }
  r->nodes.active.distance =
      2.0 * motion + GENEROUS * force / least_stiffness(r);
  return OK;
}

/* The active nodes at the start or the end of the step. */
static status choose_nodes(run *r, int n_motion) {
  r->nodes.active.passes = 0;
  if (!may_leave_out(r, n_motion)) return OK;
  TIMED(STAGE_SURFACE);
  OWNED_NEW(double, gap, r->nodes.n);
  PASS(find_active(r));
  PASS(surface_gap(r->surface, &r->faces.input, r->step->start + r->step->total,
                   gap, NULL));
  for (int i = 0; i < r->nodes.n; ++i) gap[i] = fmin(gap[i], r->problem.gap[i]);
  PASS(active_choose(&r->nodes.active, r->nodes.n, gap));
  run_take_nodes(r);
  return run_room_for_part(r);
}

static status report_ready(run *r) {
  if (r->sink->ready == NULL) return OK;
  setup_facts facts = {
      .choice = r->body.choice,
      .info = condensed_info(r->c),
      .condition = condensed_condition(r->c),
      .digits = condensed_digits(r->c),
      .floating = condensed_floating(r->c),
      .n_contact_node = r->nodes.n,
      .n_left_out = r->nodes.n - active_count(&r->nodes.active, r->nodes.n)};
  effects_describe(r, &facts);
  return r->sink->ready(r->sink->ctx, &facts, r->surface);
}

/* Forces, stiffness and displacements are squared and multiplied. */
static const double LEAST = 1.0 / NUMBER_MOST, MOST = NUMBER_MOST;
static int in_range(double x) { return x == 0.0 || (x > LEAST && x < MOST); }

static status check_range(const run *r) {
  double least = HUGE_VAL, most = 0.0, width = 1.0;
  for (int e = 0; e < r->msh->n_elem; ++e) {
    least = fmin(least, run_elasticity(r, e)[0]);
    most = fmax(most, run_elasticity(r, e)[0]);
  }
  for (int k = 2; k < r->msh->dim; ++k) width *= r->msh->size;
  if (!in_range(r->loads.largest) || !in_range(least) || !in_range(most) ||
      !in_range(r->loads.largest / (least * width)))
    RAISE(
        ERR_DECK,
        "step %d: the largest nodal load is %.3g, the moduli are %.3g to %.3g: "
        "their squares leave the range of the numbers; use other units",
        run_step_id(r) + 1, r->loads.largest, least, most);
  const double moved = largest_entry(r->n_dof, r->loads.ud);
  if (!isfinite(moved * moved * most))
    RAISE(ERR_SINGULAR,
          "step %d: the largest displacement of *BOUNDARY is %.3g, the moduli "
          "are up to %.3g: the energies leave the range of the numbers; use "
          "other units",
          run_step_id(r) + 1, moved, most);
  return OK;
}

/* The first load of the run that is in range, at the increments of its steps: a
 * step with almost no load is scaled with it. */
static status find_load_of_run(run *r) {
  for (EACH(const step, s, r->m->steps, r->m->n.step)) {
    const double dt = s->dt > 0.0 ? s->dt : s->total;
    for (int i = 1; (i - 0.5) * dt < s->total; ++i) {
      PASS(load_forces(r->m, r->msh, s, s->start + i * dt, r->now.F));
      r->loads.largest =
          fmax(r->loads.largest, increment_free_load(r, r->now.F));
      if (r->loads.largest > LEAST) return OK;
    }
  }
  return OK;
}

status run_check_range(run *r) {
  const double end = r->step->start + r->step->total;
  PASS(load_forces(r->m, r->msh, r->step, end, r->now.F));
  PASS(load_prescribed(r->m, r->msh, r->step, end, NULL, r->loads.ud));
  r->loads.largest =
      fmax(increment_free_load(r, r->old.F), increment_free_load(r, r->now.F));
  if (r->loads.largest > 0.0 && r->loads.largest <= LEAST)
    PASS(find_load_of_run(r));
  return check_range(r);
}

/* Surface, matrices for r->body.fixed; chosen: as r->body.choice. */
static status make_matrices(run *r, int chosen) {
  int motions = 0;
  PASS(run_build_ties(r));
  if (r->m->effects & EFFECT_CONTACT)
    PASS(run_build_surface(r));
  else
    run_free_surface(r);
  r->body.d.surface = r->surface;
  PASS(setup_check_circles(r));
  PASS(run_check_supports(r, &motions));
  PASS(choose_nodes(r, motions));
  r->problem.n_before = r->nodes.n_row;
  r->nodes.n_reported = active_count(&r->nodes.active, r->nodes.n);
  r->c = NULL;
  matrices_free(&r->elastic);
  PASS(chosen ? run_take_stiffness(r) : run_choose_stiffness(r));
  if (r->sink->expect != NULL)
    PASS(r->sink->expect(r->sink->ctx, r->nodes.n_reported, &r->body.choice));
  PASS(run_renew_elastic(r));
  r->c = r->elastic.c;
  return OK;
}

/* Pairs are coupled at the displacements that the step starts from: those of
 * the archive where the run goes on within it, as the kind of stiffness is. */
static status take_places(run *r) {
  if (r->course.from != NULL) PASS(run_keep_choice(r, r->course.from));
  if (run_step_id(r) == 0 || !model_updates_pairs(r->m)) return OK;
  if (r->course.from != NULL) PASS(run_keep_start(r, r->course.from));
  r->faces.input.u = r->loads.start;
  return OK;
}

status run_prepare(run *r) {
  int fresh, other = 0;
  OWNED_NEW(unsigned char, fixed, r->n_dof);
  load_fixed(r->msh, r->step, fixed);
  COPY(r->loads.start, r->old.u, r->n_dof);
  known_rate_forget(&r->solving.rate);
  PASS(take_places(r));
  fresh = r->elastic.c == NULL || memcmp(fixed, r->body.fixed, r->n_dof) != 0 ||
          (run_step_id(r) > 0 && model_updates_pairs(r->m));
  if (!fresh) PASS(run_asks_for_other_stiffness(r, &other));
  if (fresh || other) {
    memcpy(r->body.fixed, fixed, r->n_dof);
    PASS(make_matrices(r, other));
  }
  PASS(run_check_range(r));
  PASS(effects_prepare(r));
  if (fresh || other) PASS(report_ready(r));
  contact_solver_free(&r->elastic.solver);
  r->elastic.solver = NULL;
  r->solving.tol = r->step->solver.tol;
  PASS(run_use(r, &r->elastic));
  return effects_begin_step(r);
}

/* ---- whether supports and contact hold every body, before a solution ---- */

/* Name of the section an element belongs to, by the element's number. */
static const char *body_name(const run *r, size_t elem_no) {
  for (int e = 0; e < r->msh->n_elem; ++e)
    if (r->msh->elem_no[e] == elem_no)
      return r->m->sections[r->m->elem_section[e]].elset;
  return "?";
}

/* Motions that nothing resists go to the log and are ERR_SINGULAR. */
static status refuse_unheld(const run *r, int n, const free_motion *list) {
  int unheld = 0, step_no = run_step_id(r) + 1;
  for (int i = 0; i < n; ++i) {
    if (list[i].held_by >= HELD_BY_FRICTION) continue;
    ++unheld;
    message_add(r->m->log, P4011, &r->step->at,
                "step %d: body %d (%s, element %zu) is free to move: %s; "
                "neither *BOUNDARY nor %s holds it",
                step_no, list[i].body_id + 1, body_name(r, list[i].elem_no),
                list[i].elem_no, list[i].text,
                list[i].held_by == HELD_BY_TANGENTS ? "frictionless contact"
                                                    : "contact");
  }
  if (unheld > 0)
    RAISE(ERR_SINGULAR, "step %d: a body is free to move", step_no);
  return OK;
}

/* The free motions held by "most" or less, by the friction of the step; those
 * that nothing resists are refused. */
static status find_motions(const run *r, motion_hold most, int *n_free, int *n,
                           free_motion **list) {
  domain d = r->body.d;
  OWNED_NEW(unsigned char, rubs, r->m->n.contact);
  for (int i = 0; i < r->m->n.contact; ++i)
    rubs[i] =
        rule_has_friction(friction_in_force(r->m, run_step_id(r), i)) != 0;
  d.rubs = rubs;
  timer_enter_as(STAGE_ORDERING, STAGE_NO_CALL);
  const status st = domain_free_motions(&d, most, n_free, n, list);
  timer_leave(STAGE_ORDERING);
  return st == OK ? refuse_unheld(r, *n, *list) : st;
}

status run_check_supports(const run *r, int *n_free) {
  int n;
  OWNED free_motion *list = NULL;
  return find_motions(r, HELD_BY_TANGENTS, n_free, &n, &list);
}

status run_motions(run *r, int *n, free_motion **list) {
  load_fixed(r->msh, r->step, r->body.fixed);
  PASS(run_build_ties(r));
  if (r->m->effects & EFFECT_CONTACT) PASS(run_build_surface(r));
  r->body.d.surface = r->surface;
  PASS(setup_check_circles(r));
  int n_free;
  PASS(find_motions(r, HELD_BY_CONTACT, &n_free, n, list));
  return effects_prepare(r);
}
