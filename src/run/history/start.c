/*
 * What comes before the increments of a step: the initial displacements of
 * *INITIAL CONDITIONS and their test, what a *VISCO step puts on suddenly.
 */
#include "base/memory.h"
#include "base/timer.h"
#include "run/history/loop.h"

#include <math.h>
#include <string.h>

/* K u_0 - F into R, the largest of both into *largest; diagonal of K. */
static status start_forces(run *r, double *R, double *diagonal,
                           double *largest) {
  status st = OK;
  double *sigma = NULL;
  NEW(sigma, (size_t)r->m->ns * (size_t)r->msh->n_elem);
  domain_stress(&r->body.d, r->old.u, NULL, sigma);
  domain_internal_force(&r->body.d, sigma, R);
  for (size_t k = 0; k < r->n_dof; ++k) {
    *largest = fmax(*largest, fmax(fabs(R[k]), fabs(r->now.F[k])));
    R[k] -= r->now.F[k];
  }
  start_stiffness(&r->body.d, diagonal);
done:
  memory_free(sigma);
  return st;
}

/* The start is the old equilibrium of the first increment. */
static void accept_start(run *r) {
  memcpy(r->old.F, r->now.F, r->n_dof * sizeof *r->old.F);
  result_start(r, &r->old);
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
  memcpy(r->loads.start, r->old.u, r->n_dof * sizeof *r->loads.start);
done:
  r->course.relaxing = 0;
  return st;
}

static status judge_start(run *r) {
  status st = OK;
  const start_card *asked = &r->m->start;
  start_report *s = &r->course.first;
  s->relaxed = s->n_bad > 0 && asked->relax;
  if (r->sink->start != NULL) TRY(r->sink->start(r->sink->ctx, s));
  if (s->n_bad > 0 && !s->relaxed) {
    message_add(r->m->log, P4014, &asked->at,
                "the start is not compatible: defect %.3g (%.2g of the largest "
                "force) at node %zu, %s; %d node%s above %.0e",
                s->worst, s->ratio, r->msh->node_no[s->node_id],
                defect_text(s->kind[s->node_id]), s->n_bad,
                s->n_bad == 1 ? "" : "s", start_tolerance);
    FAIL(ERR_DECK, "the initial displacements are not compatible");
  }
  if (s->relaxed)
    TRY(relax_start(r));
  else
    accept_start(r);
done:
  return st;
}

/* Test the initial displacements against the loads of time 0. */
static status test_start(run *r) {
  status st = OK;
  double *R = NULL, *diagonal = NULL, largest = 0.0;
  timer_enter(STAGE_START);
  NEW(R, r->n_dof);
  NEW(diagonal, r->n_dof);
  TRY(increment_pose(r, 0.0));
  TRY(start_forces(r, R, diagonal, &largest));
  const start_input in = {.mesh = r->msh,
                          .fixed = r->body.fixed,
                          .u = r->old.u,
                          .ud = r->loads.ud,
                          .R = R,
                          .stiffness = diagonal,
                          .surface = r->nodes.n > 0 ? r->surface : NULL,
                          .cp = &r->problem.cp,
                          .uc = r->old.uc,
                          .given = r->problem.given,
                          .load = largest};
  start_test(&in, r->old.rc, r->old.reaction, &r->course.first);
  TRY(effects_initial(r));
done:
  timer_leave(STAGE_START);
  memory_free(R);
  memory_free(diagonal);
  return st;
}

status start_read(run *r) {
  status st = OK;
  if (!(r->m->effects & EFFECT_START)) goto done;
  timer_enter(STAGE_START);
  st = start_report_new(r->msh, &r->course.first);
  if (st == OK)
    st = start_displacements(r->m, r->msh, r->old.u, &r->course.first);
  timer_leave(STAGE_START);
done:
  return st;
}

/* 1 if a is b to rounding. */
static int same_vector(size_t n, const double *a, const double *b) {
  double largest = 0.0, worst = 0.0;
  for (size_t i = 0; i < n; ++i) {
    largest = fmax(largest, fmax(fabs(a[i]), fabs(b[i])));
    worst = fmax(worst, fabs(a[i] - b[i]));
  }
  return worst <= 1e-12 * largest;
}

/* 1 if nothing acts at the start of the step that did not act before. */
static int starts_smoothly(const run *r) {
  if (r->course.total_no == 0 && r->nodes.n > 0) return 0;
  for (size_t i = 0; i < r->n_dof; ++i)
    if (r->body.fixed[i] &&
        fabs(r->loads.ud[i] - r->old.u[i]) > 1e-12 * fabs(r->loads.ud[i]))
      return 0;
  if (r->body.moduli.n_own > 0 &&
      !same_vector((size_t)r->msh->n_elem, r->now.temperature,
                   r->old.temperature))
    return 0;
  return same_vector(r->n_dof, r->now.F, r->old.F) &&
         same_vector(strains_kept(r), r->now.e0, r->old.e0);
}

/* 1: a law flows, or would if *EFFECTS had not left it out. */
static int has_law(const run *r) {
  int any = r->strains.visco != NULL;
  for (int i = 0; i < r->m->n_material; ++i)
    any |= r->m->materials[i].law_aside != NULL;
  return any;
}

/*
 * The body answers at once to what is applied suddenly at the start of a *VISCO
 * step: an increment without length of its own.
 */
static status start_visco(run *r, int *increment_no) {
  status st = OK;
  double cpu = timer_cpu();
  if (r->step->kind != STEP_VISCO) return OK;
  if (!has_law(r)) return OK;
  TRY(increment_begin(r, r->step->start));
  if (!starts_smoothly(r)) {
    TRY(increment_solve(r, r->step->start));
    if (outcome_is_fatal(r->solving.report.outcome))
      TRY(loop_no_equilibrium(r));
    if (!same_vector(r->n_dof, r->now.u, r->old.u))
      TRY(loop_accept(r, 1, ++*increment_no, 0, cpu));
  }
  TRY(visco_begin_step(r));
done:
  return st;
}

status start_step(run *r) {
  status st = OK;
  visco_rest(r);
  if (run_step_id(r) == 0 && (r->m->effects & EFFECT_START)) {
    TRY(test_start(r));
    TRY(judge_start(r));
  }
  TRY(start_visco(r, &r->at.increment_no));
done:
  return st;
}
