/*
 * The error of the contact solver: the bound of accuracy.h, in energy units and
 * relative to the energy norm of the body. The interior follows the contact
 * nodes exactly, so that the error of the whole body has the energy of that of
 * the condensed problem.
 *
 * An increment starts from the slip and the inelastic strains that the one
 * before has left, and their errors stay in it: with a given limit of friction
 * the solution moves, in the energy norm, by no more than where it starts. So
 * the bounds of the increments are added.
 */
#include "effects/plan/effect.h"
#include "run/history/loop.h"

#include "run/column_row.h"

static const char weakly_held[] =
    "supports hold a body by negligible lever arms";

static const char earlier[] = "an increment before this one has none";

/* Bounds, sqrt(J); NAN: none. */
typedef struct bounds {
  double before, now; /* of the increments so far; with the attempt in r->now */
  double cpu;         /* s, spent so far */
} bounds;

static status force_energy(void *ctx, const double *d, double *square) {
  return condensed_force_energy(ctx, d, square);
}

/* The factor of the body; 0: the motions that contact alone holds are not
 * known. */
static int choose_inverse(run *r, double *diagonal, inverse_energy *out) {
  condensed_diagonal(r->c, diagonal);
  *out = (inverse_energy){.ctx = r->c,
                          .square = force_energy,
                          .condition = condensed_condition(r->c),
                          .diagonal = diagonal};
  out->n_kernel = condensed_kernel(r->c, &out->kernel);
  return out->n_kernel >= 0;
}

static status estimate(run *r, void *self) {
  solver_error found = {.norm = NAN, .why = weakly_held};
  inverse_energy inverse;
  bounds *own = self;
  const double cpu = timer_cpu(), before = run_inherits(r) ? own->before : 0.0;
  r->errors.error = (error_bound){0};
  own->now = r->nodes.n == 0 ? before : NAN;
  if (r->nodes.n == 0 || r->step->accuracy.no_solver) return OK;
  TIMED(STAGE_ESTIMATE);
  OWNED_NEW(double, diagonal, r->problem.cp.m);
  if (choose_inverse(r, diagonal, &inverse))
    PASS(solver_error_bound(&r->problem.cp, &inverse, run_rows(r, 0, r->now.uc),
                            run_rows(r, 1, r->now.rc), &r->solving.rate,
                            &found));
  found.norm += before;
  if (found.why == NULL && isnan(before)) found.why = earlier;
  own->now = found.why == NULL ? found.norm : NAN;
  error_bound_set(&found, r->now.energy.strain, &r->errors.error);
  r->errors.error.before = before;
  r->errors.error.cpu = own->cpu += timer_cpu() - cpu;
  return OK;
}

static status accept(run *r, void *self) {
  bounds *own = self;
  own->before = own->now;
  return OK;
}

static status keep(run *r, void *self, archive *a) {
  bounds *own = self;
  return archive_reals(a, "before", &own->before, 1);
}

static effect_work expected(const plan_sizes *s) {
  double m = plan_contact_unknowns(s), solve = 0.5 * work_factor_entries(s);
  double factor = s->tangents > 0.0 ? 0.1 * m * m * m / 3.0 / PLAN_DENSE : 0.0;
  return (effect_work){s->contact, "nodes", s->increments,
                       s->increments * (3.0 * m * m + solve + factor)};
}

static int requires_bound(const model *m, const reason *why) {
  int any = 0;
  for (int i = 0; i < m->n.step; ++i) any |= !m->steps[i].accuracy.no_solver;
  if (m->problem.given && !m->steps[0].accuracy.given)
    return plan_says(any, why, "no *ACCURACY card, which requires it");
  if (m->problem.given && any)
    return plan_at(why, &m->steps[0].accuracy.at, "*ACCURACY");
  if (m->n.contact == 0 && !m->problem.given)
    return plan_says(0, why, "no *CONTACT card");
  if (!any) return plan_says(0, why, "*ACCURACY, SOLVER=NO");
  return plan_says(1, why, "default; *ACCURACY, SOLVER=NO leaves it out");
}

VALUE(bound_error, 100 * v->s->errors.error.relative)
VALUE(solver_error_energy, v->s->errors.error.energy)
VALUE(contraction, v->s->errors.error.rate)

/* clang-format off */
static const column columns[] = {
{"solver_error", "%", INC, AT(2), C | ON(ESTIMATES), ANY, "solver_error", 0,
 bound_error, NULL, "bound of the error of the contact solver in the energy "
 "norm, with those before it, of that of the solution; NaN: no bound"},
{"solver_error_energy", J, INC, AT(2), C | ON(ESTIMATES), ANY,
 "solver_error_energy", 0, solver_error_energy, NULL,
 "bound of the energy of that error"},
{"contraction", "-", INC, AT(2), F | ON(ESTIMATES), ANY, "contraction", 0,
 contraction, NULL, "rate of the fixed point on the sliding limit"}};

const effect_ops solver_error_effect = {
  .name = "error of solver", .bit = EFFECT_BIT_ESTIMATES,
  .required = requires_bound, .expected = expected, .own = STAGE_ESTIMATE,
  .inside = 1, .of_state = 1, .size = sizeof(bounds),
  .on = {.estimate = estimate, .accept = accept, .keep = keep},
  COLUMNS_OF(columns)};
/* clang-format on */
