/*
 * *CONTACT FORCE: given normal forces in the place of unilateral contact
 * (CPR98, problem D3). The solver takes a problem without those normals; its
 * solution is transformed back.
 */
#include "contact/formulation.h"
#include "effects/plan/effect.h"

typedef struct given_forces {
  int n, *node;     /* [n] contact nodes with a given normal force */
  double *force;    /* [n] N, >= 0 */
  double *all;      /* [r->nodes.n] the same, -1 where there is none */
  given_form *form; /* NULL until needed */
  long matrix_no;   /* of the run, that form is made of */
} given_forces;

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
static status check_corners(run *r, void *self) {
  for (int i = 0; i < r->nodes.n; ++i) {
    int id = forced_corner(r, i);
    if (id < 0) continue;
    message_add(r->m->log, P4012, &r->m->contacts[id].force.at,
                "contact %s meets another contact at node %zu",
                r->m->contacts[id].name, r->surface->node_no[i]);
    RAISE(ERR_DECK, "*CONTACT FORCE at a corner of two contacts");
  }
  return OK;
}

/* The given pressures at time t times the areas of the nodes. */
static status set_forces(run *r, void *self, double t) {
  given_forces *f = self;
  if (f->n == 0) return OK;
  const contact_surface *s = r->surface;
  for (int k = 0; k < f->n; ++k) {
    int i = f->node[k];
    double x[3] = {0.0, 0.0, 0.0};
    COPY(x, s->x + s->dim * i, s->dim);
    const given_force *given = force_of(r, i);
    double p = quantity_value(&given->value, x, t);
    f->force[k] = f->all[i] = p * s->area[i];
    if (p >= 0.0 && p <= NUMBER_MOST) continue;
    message_add(r->m->log, P2041, &given->value_at,
                "*CONTACT FORCE: value %g at node %zu (%g, %g, %g), time %g; "
                "expected a number that is not negative, up to 3e144",
                p, s->node_no[i], x[0], x[1], x[2], t);
    RAISE(ERR_DECK,
          "%s:%d: a given contact force is negative, too large or no number",
          given->value_at.file, given->value_at.line_no);
  }
  r->problem.given = f->all;
  return OK;
}

static void forget(run *r, void *self) {
  given_forces *own = self;
  RELEASE(own->form, own->node, own->force, own->all);
  *own = (given_forces){0};
  r->problem.given = NULL;
}

static status prepare(run *r, void *self) {
  given_forces *own = self;
  if (own->all != NULL) return OK;
  PASS(check_corners(r, own));
  OWNS(own);
  PASS_NEW_ALL(OF(own->node, r->nodes.n), OF(own->all, r->nodes.n));
  for (int i = 0; i < r->nodes.n; ++i) {
    own->all[i] = -1.0;
    if (force_of(r, i)->given) own->node[own->n++] = i;
  }
  PASS_NEW(own->force, own->n);
  return OK;
}

static status given_copy(const run *r, const void *of, run *copy, void **self) {
  return prepare(copy, *self);
}

/* The form of cp, with a message that names the first card. */
static status new_form(const run *r, given_forces *own,
                       const contact_problem *cp) {
  const status st = given_form_new(cp, own->n, own->node, &own->form);
  if (st == ERR_SINGULAR)
    RAISE(st,
          "%s:%d: *CONTACT FORCE: nothing holds the body against the given "
          "normal forces; hold it with *BOUNDARY or another *CONTACT",
          PLACE(force_of(r, own->node[0])->at));
  return st;
}

static status take(run *r, void *self, contact_problem *cp, double **u,
                   double *force) {
  given_forces *own = self;
  contact_problem before = *cp;
  if (own->n == 0) return OK;
  TIMED(effect_stage(&given_forces_effect));
  if (own->matrix_no != r->solving.matrix_no) FORGET(own->form);
  own->matrix_no = r->solving.matrix_no;
  OWNS(own);
  if (own->form == NULL) PASS(new_form(r, own, cp));
  return given_form_set(own->form, &before, own->force, r->msh->size, *u, force,
                        cp);
}

static void give(run *r, void *self, contact_problem *cp, double *u,
                 double *force) {
  given_forces *own = self;
  if (own->n > 0) given_form_apply(own->form, cp, u, force);
}

static effect_work expected(const plan_sizes *s) {
  double n = 0.0;
  for (int i = 0; s->msh != NULL && i < s->m->n.contact; ++i)
    if (s->m->contacts[i].force.given)
      n += s->msh->group[s->m->contacts[i].group_id].n_node;
  return (effect_work){n, "nodes", s->equilibria, 20.0 * s->equilibria * n};
}

static int requires_given(const model *m, const reason *why) {
  for (EACH(const contact, c, m->contacts, m->n.contact))
    if (c->force.given)
      return plan_at(why, &c->force.at, "*CONTACT FORCE on contact %s",
                     c->name);
  return plan_says(0, why, "no *CONTACT FORCE card");
}

/* clang-format off */
const effect_ops given_forces_effect = {
  .name = "given contact forces", .bit = EFFECT_BIT_GIVEN,
  .required = requires_given, .expected = expected, .inside = 1, .far = 1,
  .size = sizeof(given_forces),
  .on = {.check = check_corners, .prepare = prepare, .pose = set_forces,
         .rewrite = take, .restore = give, .forget = forget,
         .copy = given_copy}};
/* clang-format on */
