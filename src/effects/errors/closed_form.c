/* *REFERENCE: the true error of each increment against a closed form. */
#include "effects/plan/effect.h"

#include "run/column_row.h"

static int requires_reference(const model *m, char *why, size_t size) {
  if (m->accuracy.ref.n == 0)
    return plan_says(0, why, size, "no *REFERENCE card");
  return plan_says(1, why, size, "*REFERENCE, %s:%d",
                   PLACE(m->accuracy.ref.at));
}

/* Formulas at many points of each element. */
static effect_work expected(const plan_sizes *s) {
  return (effect_work){
      s->elements, "elements", s->increments,
      s->increments * s->elements * 600.0 * plan_element_work(s)};
}

static status exact_new(run *r, void **self) {
  ((true_error *)*self)->asked = 1;
  return OK;
}

static status compare(run *r, const answer_fields *a, true_error *own) {
  const closed_form *ref = &r->m->accuracy.ref;
  const status st = exact_error_find(ref, &r->body.d, a, own);
  if (st != ERR_DECK) return st;
  message_add(r->m->log, P2041, &ref->at, "%s", status_message());
  RAISE(ERR_DECK, "%s:%d: %s", PLACE(ref->at), status_message());
}

static status find(run *r, void *self) {
  true_error *own = self;
  double cpu = timer_cpu();
  const answer_fields a = {r->now.t, r->now.u, r->result.stress, r->now.rc};
  PASS(compare(r, &a, own));
  own->cpu += timer_cpu() - cpu;
  return OK;
}

static void show(const void *own, state *s) {
  s->errors.exact = *(const true_error *)own;
}

static const true_error *exact_of(const view *v) {
  return effect_state(v->s->effects, &closed_form_effect);
}

VALUE(true_energy, 100 * exact_of(v)->energy)
VALUE(true_displacement, 100 * exact_of(v)->displacement)
VALUE(true_stress, 100 * exact_of(v)->stress)
VALUE(true_pressure, 100 * exact_of(v)->pressure)

/* clang-format off */
static const column columns[] = {
{"true_error", "%", INC, 0, ON(REFERENCE), ANY, "true_error", 0, true_energy,
 NULL, "error against *REFERENCE in that norm; NaN: it has no displacement and "
 "no stress"},
{"true_displacement_error", "%", INC, 0, ON(REFERENCE), ANY,
 "true_displacement_error", 0, true_displacement, NULL,
 "the same of the displacement in the L2 norm"},
{"true_stress_error", "%", INC, 0, ON(REFERENCE), ANY, "true_stress_error",
 0, true_stress, NULL, "the same of the stress in the L2 norm"},
{"true_pressure_error", "%", INC, 0, ON(REFERENCE), ANY,
 "true_pressure_error", 0, true_pressure, NULL,
 "the same of the contact pressure in the L2 norm"}};

const effect_ops closed_form_effect = {
  .name = "closed form", .bit = EFFECT_BIT_REFERENCE,
  .required = requires_reference, .expected = expected, .own = STAGE_REFERENCE,
  .size = sizeof(true_error),
  .on = {.create = exact_new, .accept = find, .show = show},
  COLUMNS_OF(columns)};
/* clang-format on */
