/*
 * Inelastic strain of materials with a law: which elements have it, and *VISCO
 * steps whose increments follow from the estimate of the error of the strains
 * (TOLERANCE=). The state of the elements and the equilibria that an integrator
 * requires are those of the run (run/visco.h): states within an increment, the
 * error of the steps and theorem 3.2 need them too.
 */
#include "effects/plan/effect.h"
#include "run/history/loop.h"
#include "run/visco.h"

#include "run/column_row.h"

static const double ROUNDING = 0x1p-48; /* -, of the time */

/* The next increment after one of length dt with this error, of length
 * "planned" but for the points of a table; implicit integrators keep to halves
 * and doubles of that, which they have factored. */
static double next_length(const step *s, double dt, double planned,
                          double error) {
  const scheme *of = s->visco.integrator;
  const int order = of->estimates ? 1 : visco_order(s);
  const double most = fmax(4.0, planned / dt);
  double factor = most;
  if (error > 0.0)
    factor = 0.9 * pow(s->visco.tolerance / error, 1.0 / (order + 1));
  factor = fmin(most, fmax(0.2, factor)) * (dt / planned);
  if (of->limit == 0.0) factor = ldexp(1.0, (int)floor(log2(factor)));
  return fmin(planned * factor, s->dt_max);
}

/* The smallest increment: one that moves the time. */
static double least_length(const run *r) {
  return fmax(r->step->dt_min, ROUNDING * fabs(r->old.t));
}

/* End of the next increment: not a sliver before the end of the step. */
static double next_end(const run *r, double dt) {
  double end = r->step->start + r->step->total, left = end - r->old.t;
  if (dt >= left * (1.0 - 1e-9)) return end;
  return r->old.t + (dt > 0.5 * left && r->step->visco.integrator->limit > 0.0
                         ? 0.5 * left
                         : dt);
}

/* A body in free motion or barely touching: its strains are rounding. */
static status forget_rounding(run *r, double *error) {
  int hides = 0;
  r->now.energy.strain = domain_strain_energy(&r->body.d, r->now.u);
  PASS(rounding_hides_strains(r, &hides));
  if (hides) *error = 0.0;
  return OK;
}

/* The increment to t is accepted, whatever its first half, tried before it, has
 * come to. */
static status finish_attempt(run *r, double t) {
  if (r->now.t < t) {
    PASS(visco_advance(r, t));
    r->course.missed = r->solving.report.outcome > 0;
  }
  return outcome_is_fatal(r->solving.report.outcome) ? loop_no_equilibrium(r)
                                                     : OK;
}

/* One attempt at an increment of a step with a tolerance. */
static status attempt_adapted(run *r) {
  status st = OK;
  const step *s = r->step;
  progress *p = &r->at;
  const double least = least_length(r);
  double end = s->start + s->total, error = 0.0;
  double cpu = timer_cpu(), t = next_end(r, p->dt), planned, tried;
  int deeper, attempt = p->attempt;
  TRY(visco_level(r, t - r->old.t, &deeper));
  if (deeper > 0) t = next_end(r, ldexp(t - r->old.t, -deeper));
  planned = t - r->old.t;
  t = loop_end(r, t, s->visco.tolerance);
  tried = t - r->old.t;
  TRY(effects_attempt(r, t));
  TRY(visco_try(r, t, &error));
  int settled = r->solving.report.outcome > 0;
  if (settled && error > s->visco.tolerance) TRY(forget_rounding(r, &error));
  r->course.missed = settled && error > s->visco.tolerance;
  if (r->solving.report.outcome == STOPPED_UNSTABLE ||
      ((!settled || r->course.missed) && fmin(tried, p->dt) > least &&
       loop_cut_helps(r))) {
    TRY(loop_reject(r, attempt, p->increment_no + 1,
                    settled ? "strain error above TOLERANCE"
                            : outcome_text(r->solving.report.outcome)));
    p->dt = fmax(least, fmin(0.5 * tried, next_length(s, tried, tried, error)));
    ++p->attempt;
    goto done;
  }
  TRY(finish_attempt(r, t));
  if (r->solving.report.outcome == STOPPED_STAGNATION) tried *= 2.0;
  p->attempt = 1;
  ++p->increment_no;
  TRY(loop_accept(r, attempt, p->increment_no, t == end, cpu));
  p->dt = fmax(least_length(r), settled ? next_length(s, tried, planned, error)
                                        : fmin(tried, s->dt_max));
done:
  r->course.missed = 0;
  return st;
}

static status adapt(run *r, void *self, int *made) {
  double end = r->step->start + r->step->total;
  /* TIME=BALANCED goes before TOLERANCE=, where it can. */
  int balanced = r->step->accuracy.time_balanced && !effects_sum_up(r);
  if (balanced || !(r->step->visco.tolerance > 0.0)) return OK;
  *made = 1;
  while (r->old.t < end) {
    PASS(loop_pause(r));
    PASS(attempt_adapted(r));
  }
  return OK;
}

/* Solvers are those of the step. */
static status prepare(run *r, void *self) {
  visco_new_solvers(r);
  return OK;
}

static void forget(run *r, void *self) { visco_forget(r); }

static status keep(run *r, void *self, archive *a) { return visco_keep(r, a); }

static int point_of(const view *v, int elem_id) {
  return number_find(elem_id, v->s->body.flow_elem, v->s->body.flow->n);
}

/* Inelastic strain; 0 where no law flows. */
static double inelastic(const view *v, int id, int part) {
  int k = point_of(v, id);
  return k < 0 ? 0 : v->s->body.inelastic->ei[at(v->m->ns, k, part)];
}

/* Internal variable; 0 where the law has fewer. */
static double internal(const view *v, int id, int part) {
  int k = point_of(v, id);
  const size_t *start = v->s->body.flow->alpha_at;
  if (k < 0 || start[k] + part >= start[k + 1]) return 0;
  return v->s->body.inelastic->alpha[start[k] + part];
}

VALUE(inelastic_work, v->s->energy.inelastic)
VALUE(dissipated, v->s->energy.dissipated)
VALUE(inelastic_stored, v->s->energy.stored)

/* clang-format off */
#define ELEM  PER_ELEMENT, AS_REAL
#define FLOW(scenes) \
  PRINT_ELEMENTS, ON(STRESS) | ON(INELASTIC), scenes, NEEDS_FLOW
#define EI(name, scenes, part, help) \
  {name, "-", ELEM, FLOW(scenes), name, part, inelastic, NULL, help}
#define EXTENSION "inelastic strain"
#define SHEAR "inelastic shear strain, engineering"
#define ALPHA(no) \
  {"alpha_" #no, "-", ELEM, PRINT_ELEMENTS, ON(STRESS) | ON(INELASTIC), \
   SCENE_ALL, NEEDS_FLOW | NEEDS_ALPHA, "alpha_" #no, no - 1, internal, NULL, \
   "internal variable of the law, in its unit"}
static const column columns[] = {
EI("ei_xx", CART, 0, EXTENSION),
EI("ei_yy", CART, 1, EXTENSION),
EI("ei_zz", CART, 2, EXTENSION),
EI("ei_xy", CART, 3, SHEAR),
EI("ei_yz", SCENE_SOLID, 4, SHEAR),
EI("ei_zx", SCENE_SOLID, 5, SHEAR),
EI("ei_rr", SCENE_AXI, 0, EXTENSION),
EI("ei_zz", SCENE_AXI, 1, EXTENSION),
EI("ei_tt", SCENE_AXI, 2, EXTENSION),
EI("ei_rz", SCENE_AXI, 3, SHEAR),
ALPHA(1), ALPHA(2), ALPHA(3), ALPHA(4), ALPHA(5), ALPHA(6),
ALPHA(7), ALPHA(8), ALPHA(9), ALPHA(10), ALPHA(11), ALPHA(12),
{"inelastic_work", J, INC, PRINT_ENERGY | AT(5), ON(INELASTIC), ANY,
 "inelastic_work", 0, inelastic_work, NULL,
 "work of the stresses on inelastic strains so far, trapezoidal"},
{"viscous_dissipation", J, INC, PRINT_ENERGY | AT(5), ON(INELASTIC), ANY,
 "viscous_dissipation", 0, dissipated, NULL,
 "dissipated of it by the laws so far, in the quadrature of the integrator"},
{"inelastic_stored", J, INC, PRINT_ENERGY | AT(5), ON(INELASTIC), ANY,
 "inelastic_stored", 0, inelastic_stored, NULL,
 "stored of it by the internal variables"}};
/* clang-format on */

static effect_work expected(const plan_sizes *s) {
  double law = s->flows_linearly ? 4.0 : 40.0;
  return (effect_work){
      s->elements, "elements", -1.0,
      law * s->equilibria * s->elements * plan_element_work(s)};
}

static int requires_inelastic(const model *m, const reason *why) {
  const section *s = facts_first_inelastic(m);
  if (s == NULL) return plan_says(0, why, "no material has *INELASTIC");
  const law_card *law = &m->materials[s->material_id].law;
  return plan_says(facts_has_inelastic(m), why, "%s of group %s, %s:%d%s",
                   law->ops->name, s->elset, PLACE(law->at),
                   has_card(m, "VISCO") ? "" : ", but no step is *VISCO");
}

/* clang-format off */
const effect_ops inelastic_effect = {
  .name = "inelastic strain", .bit = EFFECT_BIT_INELASTIC,
  .required = requires_inelastic, .expected = expected, .own = STAGE_INELASTIC,
  .inside = 1, .far = 1, .strains = model_flows,
  .on = {.prepare = prepare, .make_step = adapt, .forget = forget,
         .keep = keep},
  COLUMNS_OF(columns)};
/* clang-format on */
