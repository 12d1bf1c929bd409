/*
 * Bodies in contact with each other, or tied: the coupling of their surfaces
 * (src/contact/mortar), nodal forces of the contact on both sides, and the
 * moment that is left of the forces on both sides. They act at places a gap
 * apart; only where a tangential force crosses a gap is there a moment.
 */
#include "effects/plan/effect.h"

#include "run/column_row.h"

typedef struct pair_forces {
  double *force;  /* [dim*n_node] of the contact on the bodies, N */
  double *moment; /* [n_contact] left by both sides, N m */
} pair_forces;

static int requires_pairs(const model *m, const reason *why) {
  for (int i = 0; i < m->n.contact; ++i)
    if (m->contacts[i].is_pair)
      return plan_at(why, &m->contacts[i].at, "%s, NAME=%s",
                     contact_card(&m->contacts[i]), m->contacts[i].name);
  if (m->n.tie > 0)
    return plan_at(why, &m->ties[0].at, "*TIE, NAME=%s", m->ties[0].name);
  return plan_says(0, why, "no *CONTACT PAIR, no *TIE");
}

/* Faces of a group that two surfaces search for partners. */
static double faces_of(const plan_sizes *s, const surface_pair *p) {
  return s->msh->group[p->slave_id].n_item + s->msh->group[p->master_id].n_item;
}

static effect_work expected(const plan_sizes *s) {
  double n = 0.0;
  for (int i = 0; i < s->m->n.contact; ++i)
    if (s->m->contacts[i].is_pair) n += faces_of(s, &s->m->contacts[i].pair);
  for (int i = 0; i < s->m->n.tie; ++i) n += faces_of(s, &s->m->ties[i].pair);
  return (effect_work){n, "faces", 1.0, n * (s->is_flat ? 2e3 : 2e4)};
}

static status pairs_new(run *r, void **self) {
  pair_forces *own = *self;
  PASS_NEW_ALL(OF(own->force, r->n_dof), OF(own->moment, r->m->n.contact));
  return OK;
}

/* arm[dim] += by times the place at which a node was coupled. */
static void add_place(const run *r, int contact_id, int node_id, double by,
                      double *arm) {
  const surface_input *in = &r->faces.input;
  const int moved = in->pairs[contact_id].update && in->u != NULL;
  for (int c = 0; c < r->msh->dim; ++c) {
    const int k = r->msh->dim * node_id + c;
    arm[c] += by * (r->msh->x[k] + (moved ? in->u[k] : 0.0));
  }
}

/* Arm of row a of contact node i, from its master's place to its own, m. */
static void find_arm(const run *r, int i, int a, double *arm) {
  const contact_surface *s = r->surface;
  const node_links *l = s->master;
  const int id = surface_contact_of(s, i, a);
  double whole = 0.0;
  CLEAR(arm, 3);
  for (size_t e = l->start[i]; e < l->start[i + 1]; ++e) {
    const double part = l->part[s->dim * e + a];
    whole += part;
    add_place(r, id, l->master[e], -part, arm);
  }
  if (whole > 0.0) add_place(r, id, s->node_id[i], 1.0, arm);
}

/* The moment of the forces of one row on both sides. */
static void add_moment(const run *r, int i, int a, double *moment) {
  const contact_surface *s = r->surface;
  const int dim = s->dim;
  double arm[3], f[3] = {0.0, 0.0, 0.0};
  find_arm(r, i, a, arm);
  for (int c = 0; c < dim; ++c)
    f[c] = s->frame[dim * (dim * i + a) + c] * r->now.rc[dim * i + a] /
           surface_share(s, i, a);
  for (int c = 0; c < 3; ++c) {
    const int j = (c + 1) % 3, k = (c + 2) % 3;
    moment[c] += arm[j] * f[k] - arm[k] * f[j];
  }
}

static status find_forces(run *r, void *self) {
  pair_forces *own = self;
  const contact_surface *s = r->surface;
  CLEAR(own->force, r->n_dof);
  CLEAR(own->moment, r->m->n.contact);
  if (r->nodes.n == 0) return OK;
  surface_spread(s, 1.0, r->now.rc, own->force);
  if (s->master == NULL) return OK;
  for (int id = 0; id < r->m->n.contact; ++id) {
    double moment[3] = {0.0, 0.0, 0.0};
    for (int i = 0; i < r->nodes.n; ++i)
      for (int a = 0; a < s->dim; ++a)
        if (surface_contact_of(s, i, a) == id) add_moment(r, i, a, moment);
    own->moment[id] = sqrt(moment[0] * moment[0] + moment[1] * moment[1] +
                           moment[2] * moment[2]);
  }
  return OK;
}

static const pair_forces *forces_of(const view *v) {
  return effect_state(v->s->effects, &pairs_effect);
}

VALUE(contact_force, forces_of(v)->force[at(v->msh->dim, id, part)])
VALUE(moment_left, forces_of(v)->moment[id])

/* clang-format off */
#define FORCE(name, scene, part) \
  {name, "force", PER_NODE, AS_REAL, PRINT_NODES, C, scene, 0, \
   "contact_force", part, contact_force, NULL, \
   "nodal force of the contacts on the body, on both sides of pairs"}
static const column columns[] = {
FORCE("contact_x", CART, 0), FORCE("contact_r", SCENE_AXI, 0),
FORCE("contact_y", CART, 1), FORCE("contact_z", SCENE_AXI, 1),
FORCE("contact_z", SCENE_SOLID, 2),
{"moment_of_both", J, PER_CONTACT, AS_REAL, PRINT_TOTALS, C, CART,
 NEEDS_TOTALS, "moment_of_both", 0, moment_left, NULL,
 "moment left by the forces on both sides of a pair: tangential forces across "
 "a gap"}};

const effect_ops pairs_effect = {
  .name = "bodies in contact", .bit = NO_BIT, .required = requires_pairs,
  .expected = expected, .own = STAGE_COUPLING,
  .size = sizeof(pair_forces), .copy_as = COPY_IS_NEW,
  .on = {.create = pairs_new, .accept = find_forces},
  COLUMNS_OF(columns)};
/* clang-format on */
