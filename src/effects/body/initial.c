/*
 * *INITIAL CONDITIONS, TYPE=DISPLACEMENT: the displacements a run starts from,
 * and their test for equilibrium with loads and contact of time 0.
 */
#include "effects/plan/effect.h"
#include "run/history/loop.h"

/* K u_0 - F into R; the largest of both, and of the forces that hold strains
 * back, into *largest; diagonal of K. */
static status start_forces(run *r, double *R, double *diagonal,
                           double *largest) {
  const double *all = strains_load(r);
  OWNED_NEW(double, sigma, (size_t)r->m->ns * r->msh->n_elem);
  domain_stress(&r->body.d, r->old.u, NULL, sigma);
  domain_internal_force(&r->body.d, sigma, R);
  for (size_t k = 0; k < r->n_dof; ++k) {
    const double force = fmax(fabs(r->now.F[k]), fabs(all[k]));
    *largest = fmax(*largest, fmax(fabs(R[k]), force));
    R[k] -= r->now.F[k];
  }
  start_stiffness(&r->body.d, diagonal);
  return OK;
}

static status relax_start(run *r) {
  status st = OK;
  double cpu = timer_cpu();
  r->course.relaxing = 1;
  TRY(increment_solve(r, 0.0));
  if (r->solving.report.outcome <= 0 &&
      outcome_is_fatal(r->solving.report.outcome)) {
    TRY(loop_reject(r, 1, 0, outcome_text(r->solving.report.outcome)));
    TRY(loop_no_equilibrium(r));
  }
  TRY(loop_accept(r, 1, 0, 0, cpu));
  COPY(r->loads.start, r->old.u, r->n_dof);
done:
  r->course.relaxing = 0;
  return st;
}

static status check_start(run *r, start_report *s) {
  const start_card *asked = &r->m->initial.start;
  s->relaxed = s->n_bad > 0 && asked->relax;
  if (r->sink->start != NULL) PASS(r->sink->start(r->sink->ctx, s));
  if (s->n_bad > 0 && !s->relaxed) {
    message_add(r->m->log, P4014, &asked->at,
                "the start is not compatible: defect %.3g (%.2g of the largest "
                "force) at node %zu, %s; %d node%s above %.0e",
                s->worst, s->ratio, r->msh->node_no[s->node_id],
                defect_text(s->kind[s->node_id]), s->n_bad,
                s->n_bad == 1 ? "" : "s", start_tolerance);
    RAISE(ERR_DECK, "the initial displacements are not compatible");
  }
  if (s->relaxed) return relax_start(r);
  /* The start is the old equilibrium of the first increment. */
  COPY(r->old.F, r->now.F, r->n_dof);
  result_start(r, &r->old);
  return OK;
}

/* Test the initial displacements against the loads of time 0. */
static status test_start(run *r, start_report *s) {
  OWNED double *R = NULL, *diagonal = NULL;
  double largest = 0.0;
  TIMED(effect_stage(&initial_state_effect));
  PASS_NEW_REALS(r->n_dof, &R, &diagonal);
  PASS(increment_pose(r, 0.0));
  PASS(start_forces(r, R, diagonal, &largest));
  ties_share(&r->body.ties, R);
  const start_input in = {.mesh = r->msh,
                          .fixed = r->body.fixed,
                          .u = r->old.u,
                          .ud = r->loads.ud,
                          .R = R,
                          .stiffness = diagonal,
                          .surface = r->nodes.n > 0 ? r->surface : NULL,
                          .ties = r->body.d.ties,
                          .cp = &r->problem.cp,
                          .uc = r->old.uc,
                          .given = r->problem.given,
                          .load = largest};
  PASS(start_test(&in, r->old.rc, r->old.reaction, s));
  return effects_initial(r);
}

/* u_0 into r->old, before the contact surface is built. */
static status report_new(run *r, void **self) {
  start_report *own = *self;
  if (r->course.from != NULL || (r->step != NULL && run_step_id(r) > 0))
    return OK;
  TIMED(effect_stage(&initial_state_effect));
  PASS_NEW_ALL(OF(own->defect, r->msh->n_node), OF(own->kind, r->msh->n_node));
  return start_displacements(r->m, r->msh, r->old.u, own);
}

static status start(run *r, void *self) {
  if (run_step_id(r) > 0) return OK;
  PASS(test_start(r, self));
  return check_start(r, self);
}

static effect_work expected(const plan_sizes *s) {
  return (effect_work){s->nodes, "nodes", 2.0,
                       4.0 * s->elements * plan_element_work(s)};
}

static int requires_start(const model *m, const reason *why) {
  if (!m->initial.start.given)
    return plan_says(0, why, "no *INITIAL CONDITIONS, TYPE=DISPLACEMENT");
  return plan_at(why, &m->initial.start.at,
                 "*INITIAL CONDITIONS, TYPE=DISPLACEMENT");
}

/* clang-format off */
const effect_ops initial_state_effect = {
  .name = "initial state", .bit = EFFECT_BIT_START, .required = requires_start,
  .expected = expected, .inside = 1, .far = 1, .size = sizeof(start_report),
  .on = {.create = report_new, .start = start}};
/* clang-format on */
