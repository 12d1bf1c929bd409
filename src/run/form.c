/*
 * The contact problem of an increment to the solver, in the form the deck asks
 * for: with given normal forces taken out (*CONTACT FORCE), in the displacement
 * or in its change (*QUASISTATIC, FORM=).
 */
#include "run/run.h"

#include "base/memory.h"
#include "base/timer.h"
#include "form/form.h"

#include <math.h>
#include <string.h>

struct forms {
  velocity_form *velocity; /* NULL until asked for */
  given_form *given; /* NULL until asked for                             */
  int n, *node;      /* [n] contact nodes with a given normal force      */
  double *force;     /* [n] N, >= 0                                      */
};

void forms_free(forms *f) {
  if (f == NULL) return;
  velocity_form_free(f->velocity);
  given_form_free(f->given);
  memory_free(f->node);
  memory_free(f->force);
  memory_free(f);
}

static const given_force *force_of(const run *r, int i) {
  return &r->m->contacts[r->surface->contact_id[i]].force;
}

/* The contact with a given force among those that meet in a corner, or -1. */
static int forced_corner(const run *r, int i) {
  const contact_surface *s = r->surface;
  int id = s->contact_id[i];
  if (!surface_is_corner(s, i)) return -1;
  for (int k = 0; k < s->dim - 1 && !r->m->contacts[id].force.given; ++k)
    if (s->side_id[(s->dim - 1) * i + k] >= 0)
      id = s->side_id[(s->dim - 1) * i + k];
  return r->m->contacts[id].force.given ? id : -1;
}

/* Two contacts at one node take its normals for unilateral conditions. */
static status check_corners(const run *r) {
  status st = OK;
  for (int i = 0; i < r->n; ++i) {
    int id = forced_corner(r, i);
    if (id < 0) continue;
    message_add(r->m->log, P4012, &r->m->contacts[id].force.at,
                "contact %s meets another contact at node %zu",
                r->m->contacts[id].name, r->surface->node_no[i]);
    FAIL(ERR_DECK, "*CONTACT FORCE at a corner of two contacts");
  }
done:
  return st;
}

status forms_new(run *r) {
  status st = OK;
  forms_free(r->forms);
  r->forms = NULL;
  NEW(r->forms, 1);
  if (!(r->m->effects & EFFECT_GIVEN)) goto done;
  forms *f = r->forms;
  TRY(check_corners(r));
  NEW(f->node, r->n);
  for (int i = 0; i < r->n; ++i)
    if (force_of(r, i)->given) f->node[f->n++] = i;
  NEW(f->force, f->n);
done:
  return st;
}

/* The given pressures at time t times the areas of the nodes. */
static status set_forces(run *r, double t) {
  status st = OK;
  forms *f = r->forms;
  const contact_surface *s = r->surface;
  for (int k = 0; k < f->n; ++k) {
    int i = f->node[k];
    double x[3] = {0.0, 0.0, 0.0};
    memcpy(x, s->x + s->dim * i, (size_t)s->dim * sizeof *x);
    const given_force *given = force_of(r, i);
    double p = quantity_value(&given->value, x, t);
    f->force[k] = p * s->area[i];
    if (isfinite(p) && p >= 0.0) continue;
    message_add(r->m->log, P2041, &given->value_at,
                "*CONTACT FORCE: value %g at node %zu (%g, %g, %g), time %g; "
                "expected a number that is not negative",
                p, s->node_no[i], x[0], x[1], x[2], t);
    FAIL(ERR_DECK, "%s:%d: a given contact force is negative or no number",
         given->value_at.file, given->value_at.line_no);
  }
done:
  return st;
}

status forms_given(run *r, double t, double *given) {
  status st = OK;
  const forms *f = r->forms;
  for (int i = 0; i < r->n; ++i) given[i] = -1.0;
  TRY(set_forces(r, t));
  for (int k = 0; k < f->n; ++k) given[f->node[k]] = f->force[k];
done:
  return st;
}

/* *cp with the given normal forces in the place of the unilateral condition;
 * r->now holds the start values. */
static status take_given(run *r, contact_problem *cp) {
  status st = OK;
  forms *f = r->forms;
  contact_problem own = *cp;
  timer_enter(STAGE_GIVEN);
  TRY(set_forces(r, r->now.t));
  if (f->given == NULL) TRY(given_form_new(cp, f->n, f->node, &f->given));
  TRY(given_form_set(f->given, &own, f->force, r->msh->size, r->now.uc,
                     r->now.rc, cp));
done:
  timer_leave(STAGE_GIVEN);
  return st;
}

/* *cp in the displacement *u of the increment. */
static status take_velocity(run *r, contact_problem *cp, double **u) {
  status st = OK;
  contact_problem own = *cp;
  timer_enter(STAGE_VELOCITY);
  if (r->forms->velocity == NULL)
    TRY(velocity_form_new(cp, &r->forms->velocity));
  velocity_form_set(r->forms->velocity, &own, r->now.uc, r->old.motion,
                    r->now.motion, cp, u);
done:
  timer_leave(STAGE_VELOCITY);
  return st;
}

status forms_solve(run *r) {
  status st = OK;
  const solver_listener listener = {r->sink->iteration, r->sink->ctx};
  const solver_listener *told =
      listener.step == NULL || r->beside ? NULL : &listener;
  int given = r->forms->n > 0, in_du = r->step->form == FORM_VELOCITY;
  contact_problem whole = r->cp, cp;
  double *u = r->now.uc;
  memcpy(r->now.uc, r->old.uc, (size_t)r->n_c * sizeof *r->now.uc);
  memcpy(r->now.rc, r->old.rc, (size_t)r->n_c * sizeof *r->now.rc);
  if (given) TRY(take_given(r, &whole));
  cp = whole;
  if (in_du) TRY(take_velocity(r, &cp, &u));
  timer_enter(STAGE_CONTACT);
  st = contact_solve(r->solver, &cp, told, u, r->now.rc, &r->report);
  timer_leave(STAGE_CONTACT);
  TRY(st);
  if (in_du) velocity_form_apply(r->forms->velocity, &whole, r->now.uc);
  if (given) given_form_apply(r->forms->given, &r->cp, r->now.uc, r->now.rc);
done:
  return st;
}
