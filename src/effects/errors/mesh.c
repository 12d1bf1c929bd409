/*
 * *ACCURACY, MESH=: the error of the mesh by recovered stresses, of the body
 * and of each element.
 */
#include "effects/plan/effect.h"
#include "effects/shared.h"

#include "run/column_row.h"

static const double EXACT = 1e-10; /* -, errors of rounding alone */
static const double SEEN = 0.0625; /* -, of the energy on free sides */

typedef struct mesh_estimate {
  space_recovery *recovery; /* NULL until the first estimate */
  long elastic_no;          /* of the run, that it is made of */
  double *elem_error;       /* [n_elem] share of each element, - */
  int n_side, *side;        /* [n_side] of mesh_border */
} mesh_estimate;

static status estimate_new(run *r, void **self) {
  mesh_estimate *own = *self;
  PASS_NEW(own->elem_error, r->msh->n_elem);
  r->errors.elem_error = own->elem_error;
  return OK;
}

static int is_recovery_known(const run *r, const mesh_estimate *own) {
  return own->recovery != NULL && own->elastic_no == r->body.elastic_no;
}

static status recover(const run *r, mesh_estimate *own) {
  if (is_recovery_known(r, own)) return OK;
  FORGET(own->recovery);
  FORGET(own->side);
  TIMED(STAGE_MESH_ERROR);
  OWNS(own);
  PASS(space_recovery_new(&r->body.d, &own->recovery));
  PASS(mesh_border(r->msh, &own->n_side, &own->side));
  if (r->m->n.goal > 0) PASS(space_keep(own->recovery));
  own->elastic_no = r->body.elastic_no;
  return OK;
}

status mesh_recovery(const run *r, space_recovery **out) {
  mesh_estimate *own = effect_state(&r->effects, &mesh_error_effect);
  *out = NULL;
  if (own == NULL) return OK;
  PASS(recover(r, own));
  *out = own->recovery;
  return OK;
}

/* Why the estimate may be too small, and how deep the mesh is: as if it had no
 * element where the stress across free sides tells more of an error. */
static void doubt(mesh_estimate *own, const space_error *found, double bare,
                  error_share *out) {
  const double rounding = EXACT * found->norm;
  const int unseen =
      SEEN * bare > fmax(found->error * found->error, rounding * rounding);
  out->depth = unseen ? 0.0 : space_depth(own->recovery);
  out->why = NULL;
  if (unseen)
    out->why =
        "stress across sides is not their load: "
        "it may be many times as large";
  else if (out->entered > 0.0)
    out->why =
        "an obstacle is in the body between its nodes: it may be twice as "
        "large";
  else if (found->relative > EXACT && space_is_coarse(out->depth))
    out->why = "few nodes inside the body: it may be twice as large";
}

/* Where an obstacle is in the body between the nodes that is the error, unless
 * stresses tell of it. */
static status add_entered(run *r, mesh_estimate *own, space_error *found) {
  double sum = 0.0;
  const double rounding = EXACT * found->norm;
  OWNED_NEW(double, energy, r->msh->n_elem);
  PASS(entered_energy(r, energy));
  for (int e = 0; e < r->msh->n_elem; ++e) {
    const double square = own->elem_error[e] * own->elem_error[e];
    const double whole = 2.0 * energy[e];
    if (!(SEEN * whole > fmax(square, rounding * rounding))) continue;
    own->elem_error[e] = sqrt(whole);
    sum += whole - square;
  }
  r->errors.mesh_error.entered = 0.5 * sum;
  found->error = sqrt(found->error * found->error + sum);
  if (sum > 0.0)
    found->relative = found->error / hypot(found->norm, found->error);
  return OK;
}

static status find(run *r, mesh_estimate *own, space_error *found,
                   double *bare) {
  PASS(space_estimate(own->recovery, r->result.stress, own->elem_error, found));
  PASS(free_sides_energy(r, own->n_side, own->side, bare));
  return add_entered(r, own, found);
}

/* From r->result.stress. */
static status estimate(run *r, void *self) {
  mesh_estimate *own = self;
  double cpu = timer_cpu(), bare;
  space_error found;
  r->errors.mesh_error.asked = run_finds_mesh_error(r);
  r->errors.mesh_error.entered = 0.0;
  if (!r->errors.mesh_error.asked) return OK;
  PASS(recover(r, own));
  PASS_TIMED(STAGE_MESH_ERROR, find(r, own, &found, &bare));
  r->errors.mesh_error.relative = found.relative;
  doubt(own, &found, bare, &r->errors.mesh_error);
  double whole = hypot(found.norm, found.error);
  for (int e = 0; e < r->msh->n_elem; ++e)
    own->elem_error[e] = whole > 0.0 ? own->elem_error[e] / whole : 0.0;
  r->errors.mesh_error.cpu += timer_cpu() - cpu;
  return OK;
}

/* The nodal averages are made now: costs from here on are of the other run. */
static status keep(run *r, void *self, archive *a) {
  int made = is_recovery_known(r, self);
  PASS(archive_ints(a, "recovery", &made, 1));
  return archive_reads(a) && made ? recover(r, self) : OK;
}

static effect_work expected(const plan_sizes *s) {
  const double passes = s->is_flat ? 3.0 : 6.0;
  double n = 0.0;
  for (EACH(const step, p, s->m->steps, s->m->n.step)) {
    if (p->accuracy.mesh == MESH_ERROR_YES) n += step_increments(p);
    n += p->accuracy.mesh == MESH_ERROR_END;
  }
  return (effect_work){s->elements, "elements", 1.0 + n,
                       n * s->elements * passes * plan_element_work(s)};
}

static int is_at_each_increment(const step *s) {
  return s->accuracy.mesh == MESH_ERROR_YES;
}

static int is_estimated(const step *s) { return s->accuracy.mesh; }

static int requires_mesh_error(const model *m, const reason *why) {
  if (facts_first_step(m, is_at_each_increment) != NULL)
    return plan_requires_accuracy(m, "MESH", is_at_each_increment, why);
  if (m->accuracy.mesh_price > 0.0)
    return plan_says(
        0, why,
        "expected %.2g %% of the run, more than %.0f %%; *ACCURACY, "
        "MESH=YES requires it",
        100 * m->accuracy.mesh_price, 100 * PLAN_CHEAP);
  if (facts_first_step(m, is_estimated) != NULL)
    return plan_says(1, why,
                     "default, end of step; *ACCURACY, MESH=NO leaves it out");
  return plan_says(0, why, "*ACCURACY, MESH=NO");
}

VALUE(mesh_error, v->s->errors.mesh_error.asked
                      ? 100 * v->s->errors.mesh_error.relative
                      : NAN)

/* clang-format off */
static const column columns[] = {
{"mesh_error", "%", INC, 0, ON(MESH_ERROR), ANY, "mesh_error", 0, mesh_error,
 NULL, "estimate of the error of the mesh in the energy norm, of that of the "
 "solution; NaN: not required"}};

const effect_ops mesh_error_effect = {
  .name = "error of mesh", .bit = EFFECT_BIT_MESH_ERROR,
  .required = requires_mesh_error, .expected = expected,
  .own = STAGE_MESH_ERROR, .inside = 1, .size = sizeof(mesh_estimate),
  .copy_as = COPY_IS_NEW,
  .on = {.create = estimate_new, .estimate = estimate, .keep = keep},
  COLUMNS_OF(columns)};
/* clang-format on */
