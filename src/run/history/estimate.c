/*
 * Checks of the contact solution at an accepted increment: its errors, by the
 * effects that estimate them, and reasons for doubt.
 */
#include "run/history/loop.h"

const char *const error_bound_indefinite =
    "the matrix is not symmetric and positive semidefinite";
static const double DOUBT = 0.1;        /* -, relative error */
static const double UNLOADED = 0x1p-60; /* -, of the largest energy */
void error_bound_set(const solver_error *found, double energy, error_bound *e) {
  *e = (error_bound){.asked = 1,
                     .energy = 0.5 * found->norm * found->norm,
                     .relative = 0.0,
                     .rate = found->rate,
                     .why = found->why};
  if (found->why != NULL || found->norm > 0.0)
    e->relative = energy > 0.0 ? found->norm / sqrt(2.0 * energy) : NAN;
}

double error_bound_before(const error_bound *e) {
  return e->before > 0.0 ? e->relative * e->before / sqrt(2.0 * e->energy)
                         : 0.0;
}

int error_bound_doubts(const error_bound *e, double share) {
  if (share * e->hidden > DOUBT) return 1;
  return e->asked && e->why == NULL &&
         share * (e->relative - error_bound_before(e)) > DOUBT;
}

static void take_left(run *r, double left) {
  double *whole = &r->errors.mesh_error.relative, *part = r->errors.elem_error;
  const double entered = r->errors.mesh_error.entered;
  r->errors.left = left;
  if (entered > 0.0)
    left =
        fmax(left, sqrt(entered / (entered + r->now.energy.largest)) / *whole);
  *whole = left > 0.0 ? left * *whole : 0.0;
  if (!(left > 0.0)) r->errors.mesh_error.why = NULL;
  for (int e = 0; r->errors.mesh_error.asked && e < r->msh->n_elem; ++e)
    part[e] = left > 0.0 ? left * part[e] : 0.0;
}

/* The bound of a body without stress, of that energy: relative to the strains
 * that it has left, by all increments so far; 0: it has none. */
static double bound_of_strains(const run *r, double energy) {
  const double left = rounding_strain_left(r),
               scale = left > 0.0 ? fmin(left, r->now.energy.largest) : 0.0;
  return scale > 0.0 ? sqrt(energy / scale) : 0.0;
}

/* Those of an unloaded body, whose state is rounding, are relative to the
 * largest energy so far; a body in free motion has none. Inelastic strains that
 * are left have the errors of the increments before. */
static void estimate_unloaded(run *r) {
  energies *e = &r->now.energy;
  error_bound *b = &r->errors.error;
  r->errors.left = 1.0;
  if (rounding_is_all(r)) {
    take_left(r, 0.0);
    if (b->why != NULL && !(rounding_strain_left(r) > 0.0)) {
      b->why = NULL;
      b->energy = 0.0;
    }
    if (b->why == NULL) b->relative = bound_of_strains(r, b->energy);
    b->hidden = 0.0;
    e->rounding = fmax(e->rounding, rounding_of_works(r));
    if (e->largest <= e->rounding) e->defect = 0.0;
    return;
  }
  if (!(e->strain < UNLOADED * e->largest)) return;
  take_left(r, sqrt(fmax(e->strain, 0.0) / e->largest));
  b->hidden *= r->errors.left;
  if (b->asked && b->why == NULL)
    b->relative =
        fmax(sqrt(b->energy / e->largest), bound_of_strains(r, b->energy));
}

status estimate_evaluate(run *r) {
  r->now.energy.strain = domain_strain_energy(&r->body.d, r->now.u);
  domain_stress(&r->body.d, r->now.u, NULL, r->result.stress);
  PASS(effects_estimate(r));
  r->errors.evaluated = 1;
  return OK;
}

/* The bound is relative to the exact discrete solution, without rounding. */
static void add_rounding(run *r) {
  const error_bound was = r->errors.error;
  const solver_error e = {
      .norm = sqrt(2.0 * was.energy) + r->errors.rounding.norm,
      .rate = was.rate};
  if (!r->errors.rounding.found || !was.asked || was.why != NULL) return;
  error_bound_set(&e, r->now.energy.strain, &r->errors.error);
  r->errors.error.before = was.before;
  r->errors.error.cpu = was.cpu;
}

status estimate_increment(run *r) {
  PASS(rounding_find(r));
  if (!r->errors.evaluated) PASS(effects_estimate(r));
  add_rounding(r);
  PASS(rounding_hidden(r, &r->errors.error.hidden));
  r->errors.evaluated = 0;
  estimate_unloaded(r);
  return OK;
}

status estimate_within(run *copy) {
  PASS(effects_estimate(copy));
  estimate_unloaded(copy);
  return OK;
}

/* What solutions_by_statuses refuses, at its card. */
static status refuse_all(const step *s, status st) {
  if (st != ERR_DECK) return st;
  RAISE(ERR_DECK, "%s:%d: *SOLVER, CHECK=ALL: %s; use CHECK=YES",
        PLACE(s->solver_at), status_message());
}

status check_possible(const step *s, int dim, int n, int corner) {
  if (s->check != CHECK_ALL || n == 0) return OK;
  return refuse_all(s, solutions_can_try(dim, n, corner));
}

status check_problem(const step *s, const contact_problem *cp,
                     const solver_report *report, const double *u,
                     const double *r, solution_set *out) {
  solution_set_free(out);
  if (s->check == CHECK_NONE || cp->m == 0) return OK;
  TIMED(STAGE_CHECK);
  if (s->check == CHECK_SOLVERS)
    return solutions_by_solvers(cp, s->solver.tol, report, u, r, out);
  return refuse_all(s, solutions_by_statuses(cp, s->solver.tol, u, r, out));
}
