/*
 * *QUASISTATIC, FORM=VELOCITY: the solver's unknown is the displacement of the
 * increment (CPR98, problem N3).
 */
#include "contact/formulation.h"
#include "effects/plan/effect.h"

typedef struct velocity {
  velocity_form *form;    /* NULL until needed */
  int m;                  /* unknowns that form is made for */
  contact_problem before; /* what was rewritten last */
} velocity;

/* The last equilibrium, from which the increment and its slip are counted:
 * start values may be others. Normals with a given force are uncoupled, at
 * 0. */
static void put_old(run *r, double *u_old) {
  run_take_rows(r, r->old.uc, u_old);
  for (int i = 0; i < r->nodes.n && r->problem.given != NULL; ++i)
    if (r->problem.given[i] >= 0.0) u_old[r->nodes.rows * i] = 0.0;
}

static status take(run *r, void *self, contact_problem *cp, double **u,
                   double *force) {
  velocity *own = self;
  own->before = *cp;
  if (own->m != cp->m) /* other nodes, by the supports or within reach */
    FORGET(own->form);
  own->m = cp->m;
  OWNS(own);
  if (own->form == NULL) PASS(velocity_form_new(cp, &own->form));
  put_old(r, velocity_form_old(own->form));
  velocity_form_set(own->form, &own->before, force, cp, u);
  return OK;
}

static void give(run *r, void *self, contact_problem *cp, double *u,
                 double *force) {
  const velocity *own = self;
  velocity_form_apply(own->form, &own->before, u);
}

static int due(const run *r) { return r->step->form == FORM_VELOCITY; }

static effect_work expected(const plan_sizes *s) {
  return (effect_work){s->contact, "nodes", s->equilibria,
                       20.0 * s->equilibria * s->contact};
}

static int requires_velocity(const model *m, const reason *why) {
  for (int i = 0; i < m->n.step; ++i)
    if (m->steps[i].form == FORM_VELOCITY)
      return plan_says(1, why, "*QUASISTATIC, FORM=VELOCITY of %s:%d",
                       PLACE(m->steps[i].at));
  return plan_says(0, why, "no *QUASISTATIC, FORM=VELOCITY");
}

/* clang-format off */
const effect_ops velocity_effect = {
  .name = "velocity form", .bit = NO_BIT, .required = requires_velocity,
  .expected = expected, .own = STAGE_VELOCITY,
  .size = sizeof(velocity), .copy_as = COPY_IS_NEW,
  .on = {.due = due, .rewrite = take, .restore = give}};
/* clang-format on */
