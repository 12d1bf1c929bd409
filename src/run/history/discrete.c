/*
 * A problem from a file: one solve, passed to the outputs as one increment. A
 * plain LCP goes to lcp_solve.
 */
#include "run/history/history.h"

#include "solver/lcp/lcp_solve.h"

#include <strings.h>

enum {
  LOG = 512,
  MOST_WHOLE = 2000 /* unknowns: all of a sparse compliance is inverted */
};

/* One solve with all its arrays. */
typedef struct discrete {
  const step *step;
  const exchange_problem *p;
  contact_problem cp;    /* p->cp, with its bodies after the solve; dim 1:
                            0 */
  contact_problem whole; /* the same with all of the matrix */
  double *full;          /* [m*m] of a compliance in blocks, or NULL */
  contact_bodies *bodies;
  contact_surface surface; /* numbers only */
  double *u, *r;           /* [m] start and solution; LCP: w, z */
  double *gap, *slip, *g;  /* [n], [n*(dim-1)], [n] */
  contact_status *contact; /* [n] */
  solver_report report;
  error_bound error;
  solution_set solutions;
  char log[LOG];
} discrete;

static status discrete_new(discrete *d) {
  const exchange_problem *p = d->p;
  PASS_NEW(d->surface.node_no, p->n);
  PASS_NEW_REALS(p->m, &d->u, &d->r);
  PASS_NEW_ALL(OF(d->gap, p->n), OF(d->slip, (size_t)p->n * (p->dim - 1)),
               OF(d->g, p->n), OF(d->contact, p->n));
  d->surface.dim = p->dim;
  d->surface.n = p->n;
  for (int i = 0; i < p->n; ++i) d->surface.node_no[i] = (size_t)i + 1;
  return OK;
}

static void discrete_free(discrete *d) {
  RELEASE(d->surface.node_no, d->u, d->r, d->gap, d->slip, d->g, d->contact,
          d->full, d->bodies);
  solution_set_free(&d->solutions);
}

/* Energy x' M x/2 of the condensed solution. */
static status condensed_energy(const contact_problem *cp, const double *u,
                               const double *r, double *energy) {
  const double *x = contact_has_stiffness(cp) ? u : r;
  OWNED_NEW(double, y, cp->m);
  contact_apply(cp, x, y);
  *energy = 0.0;
  for (int i = 0; i < cp->m; ++i) *energy += 0.5 * x[i] * y[i];
  return OK;
}

/* The bound by the inverse of the matrix given; where that is a definite
 * compliance with Coulomb friction, A[m*m] is computed for its rate. */
static status bound_error(const contact_problem *cp, dense_inverse *dense,
                          const double *u, const double *r,
                          solver_error *found) {
  inverse_energy inverse = dense_inverse_energy(dense);
  contact_problem stiff = *cp;
  OWNED double *A = NULL;
  int made = 0;
  if (!contact_has_stiffness(cp) && cp->B != NULL) {
    PASS_NEW(A, (size_t)cp->m * cp->m);
    dense_inverse_fill(dense, A, &made);
    stiff.A = A;
    inverse.stiffness = made ? &stiff : NULL;
  }
  return solver_error_bound(cp, &inverse, u, r, NULL, found);
}

/* Of a compliance in blocks all of it, for the bound and the checks. */
static status fill_up(discrete *d) {
  const size_t m = d->p->m;
  const int bound = !d->step->accuracy.no_solver && d->p->m <= MOST_WHOLE;
  d->whole = d->cp;
  if (d->cp.blocks == NULL || (!bound && d->step->check == CHECK_NONE))
    return OK;
  PASS(memory_require((double)(m * m * sizeof *d->full), "the compliance"));
  PASS_NEW(d->full, m * m);
  contact_dense(&d->cp, d->full);
  d->whole.W = d->full;
  d->whole.blocks = NULL;
  return OK;
}

static status find_error(const step *s, const contact_problem *cp,
                         const double *u, const double *r, error_bound *e) {
  solver_error found = {.norm = NAN, .why = error_bound_indefinite};
  dense_inverse *dense = NULL;
  double energy = 0.0;
  *e = (error_bound){.hidden = contact_hidden(cp, u, r, NULL)};
  if (cp->m == 0 || s->accuracy.no_solver) return OK;
  TIMED(STAGE_ESTIMATE);
  PASS(condensed_energy(cp, u, r, &energy));
  status st = OK;
  if (cp->blocks != NULL)
    found.why = "its inverse would need all of a large sparse matrix";
  else
    st = dense_inverse_new(cp->m, contact_matrix(cp), &dense);
  if (st == OK && dense != NULL) st = bound_error(cp, dense, u, r, &found);
  memory_free(dense);
  PASS(st);
  const double hidden = e->hidden;
  error_bound_set(&found, energy, e);
  e->hidden = hidden;
  return OK;
}

static status solve_contact(discrete *d, const history_sink *sink) {
  ENDS_BY(contact_solver_free) contact_solver *solver = NULL;
  contact_problem *cp = &d->cp;
  const solver_listener listener = {sink->iteration, sink->ctx};
  PASS(contact_bodies_new(cp, &d->bodies));
  cp->bodies = d->bodies;
  if (!contact_has_stiffness(cp)) COPY(d->u, cp->f, cp->m);
  PASS(contact_solver_new(&d->step->solver, &solver));
  PASS(contact_solve(solver, cp, listener.step == NULL ? NULL : &listener, d->u,
                     d->r, &d->report));
  snprintf(d->log, sizeof d->log, "%s", contact_solver_log(solver));
  contact_classify(cp, d->u, d->r, d->contact);
  if (cp->g0 != NULL) contact_limit(cp, d->r, d->g);
  for (int i = 0; i < cp->n; ++i) {
    d->gap[i] = cp->gap[i] - d->u[cp->dim * i];
    for (int k = 1; k < cp->dim; ++k) {
      int s = i * (cp->dim - 1) + k - 1;
      d->slip[s] = d->u[cp->dim * i + k] - (cp->ut0 == NULL ? 0.0 : cp->ut0[s]);
    }
  }
  return OK;
}

static status solve_lcp(discrete *d) {
  const double start = timer_cpu();
  const solver_choice *choice = &d->step->solver;
  lcp_data p = {d->p->n, d->p->matrix, d->p->load};
  lcp_control control = {choice->tol, choice->max_iter, choice->ops != NULL};
  lcp_verdict v;
  PASS(lcp_solve(&p, &control, d->r, d->u, &v));
  d->report = (solver_report){.outcome = v.outcome,
                              .iterations = v.iterations,
                              .residual = v.residual,
                              .cpu = timer_cpu() - start,
                              .solver = v.method};
  snprintf(d->log, sizeof d->log, "%s", v.log);
  for (int i = 0; i < p.n; ++i) {
    d->contact[i] = d->r[i] > 0.0 ? CONTACT_SLIP : CONTACT_OPEN;
    d->gap[i] = d->u[i];
  }
  return OK;
}

static state state_of(const discrete *d) {
  const contact_problem *cp = d->p->dim > 1 ? &d->cp : NULL;
  const int doubt = error_bound_doubts(&d->error, 1.0);
  /* clang-format off */
  state s = {
      .step_no = 1, .increment_no = 1, .total_no = 1, .attempt = 1,
      .t = d->step->total, .dt = d->step->total, .end_of_step = 1,
      .contacts = {.problem = cp, .surface = &d->surface, .uc = d->u,
                   .rc = d->r, .gap = d->gap, .slip = d->slip,
                   .limit = cp != NULL && cp->g0 != NULL ? d->g : NULL,
                   .contact = d->contact},
      .report = d->report, .solver_log = d->log,
      .settled = d->report.outcome > 0 && !doubt,
      .errors = {.error = d->error, .in_doubt = doubt,
                 .solutions =
                     d->step->check != CHECK_NONE ? &d->solutions : NULL}};
  /* clang-format on */
  for (int i = 0; i < d->p->n; ++i) {
    s.contacts.n_open += d->contact[i] == CONTACT_OPEN;
    s.contacts.n_slip += d->contact[i] == CONTACT_SLIP;
    s.contacts.n_stick += d->contact[i] == CONTACT_STICK;
  }
  return s;
}

static status report_ready(const discrete *d, const history_sink *sink) {
  const exchange_problem *p = d->p;
  setup_facts facts = {
      .info = {.unknowns = p->unknowns, .contact_unknowns = p->m},
      .condition = NAN,
      .digits = NAN,
      .floating = p->cp.floating,
      .n_contact_node = p->n};
  if (sink->ready == NULL) return OK;
  return sink->ready(sink->ctx, &facts, &d->surface);
}

static status report_solution(discrete *d, const history_sink *sink, double cpu,
                              int *unsettled) {
  state s = state_of(d);
  const char *why = outcome_text(d->report.outcome);
  s.cpu = timer_cpu() - cpu;
  *unsettled = !s.settled;
  if (!outcome_is_fatal(d->report.outcome)) {
    if (sink->increment != NULL) PASS(sink->increment(sink->ctx, &s));
    return OK;
  }
  s.contacts.n_open = s.contacts.n_slip = s.contacts.n_stick = 0;
  if (sink->rejected != NULL) PASS(sink->rejected(sink->ctx, &s, why));
  if (d->report.outcome == STOPPED_UNFIT)
    RAISE(ERR_SINGULAR,
          "the method cannot treat this problem: %s; use METHOD=AUTO or "
          "PROXIMAL",
          d->log);
  RAISE(ERR_SINGULAR, "no solution found: %s%s%s%s", why,
        d->log[0] == '\0' ? "" : " (", d->log, d->log[0] == '\0' ? "" : ")");
}

status condensed_run(const model *m, const exchange_problem *p,
                     const history_sink *sink, int *unsettled) {
  ENDS_BY(discrete_free)
  discrete d = {.step = &m->steps[0], .p = p, .cp = p->cp};
  double cpu = timer_cpu();
  *unsettled = 0;
  PASS(discrete_new(&d));
  PASS(report_ready(&d, sink));
  PASS_TIMED(STAGE_CONTACT,
             p->dim == 1 ? solve_lcp(&d) : solve_contact(&d, sink));
  if (p->dim > 1 && !outcome_is_fatal(d.report.outcome)) {
    PASS(fill_up(&d));
    PASS(find_error(d.step, &d.whole, d.u, d.r, &d.error));
    PASS(check_problem(d.step, &d.whole, &d.report, d.u, d.r, &d.solutions));
  }
  return report_solution(&d, sink, cpu, unsettled);
}
