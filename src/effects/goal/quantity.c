/*
 * Quantities of *GOAL and their derivatives; of pressures: pressure.c.
 */
#include "effects/goal/parts.h"

#include <cblas.h>

status goal_form_new(const run *r, goal_form *f) {
  PASS_NEW(f->load, r->n_dof);
  PASS_NEW_REALS(r->nodes.n_c, &f->rows, &f->psi);
  for (int i = 0; i < r->m->n.goal; ++i) {
    const goal_quantity q = r->m->accuracy.goals[i].quantity;
    if ((q == GOAL_STRESS || q == GOAL_ENERGY) && f->tau == NULL)
      PASS_NEW(f->tau, (size_t)r->m->ns * r->msh->n_elem);
  }
  return OK;
}

static void clear(const run *r, goal_form *f) {
  const size_t n_c = r->nodes.n_c;
  CLEAR(f->load, r->n_dof);
  CLEAR(f->rows, n_c);
  CLEAR(f->psi, n_c);
  if (f->has_tau) CLEAR(f->tau, (size_t)r->m->ns * r->msh->n_elem);
  fracture_linear_free(&f->factor);
  memset(f->spin, 0, sizeof f->spin);
  f->value = f->curved = f->beyond = f->size = f->held = f->rough = 0.0;
  f->n_mean = 0;
  f->has_tau = f->is_field = f->is_square = f->is_coarse = f->is_front =
      f->sums = f->is_still = 0;
  f->why = GOAL_RELIABLE;
}

/* Moment about the point of the goal of a unit force f[dim] at x[dim]. */
static double moment_of(const goal_card *g, int dim, const double *x,
                        const double *f) {
  double arm[3] = {0.0}, force[3] = {0.0};
  const int a = (g->component + 1) % 3, b = (g->component + 2) % 3;
  for (int c = 0; c < dim; ++c) {
    arm[c] = x[c] - g->point[0][c];
    force[c] = f[c];
  }
  return arm[a] * force[b] - arm[b] * force[a];
}

/* Part of row a of contact node i in the force or moment. */
static double share_of(const run *r, const goal_card *g, int i, int a) {
  const contact_surface *s = r->surface;
  const int dim = s->dim;
  const int is_normal = surface_normal_of(s, i, a) >= 0;
  if (surface_contact_of(s, i, a) != g->contact_id) return 0.0;
  if (g->quantity == GOAL_MOMENT)
    return moment_of(g, dim, surface_place(s, i, a),
                     s->frame + dim * dim * i + dim * a);
  if (g->component == GOAL_NORMAL) return is_normal ? -1.0 : 0.0;
  if (g->component == GOAL_TANGENT) return a == 1 && !is_normal ? 1.0 : 0.0;
  return s->frame[dim * dim * i + dim * a + g->component];
}

/* Of the traction at node k of a face that friction has by its other nodes
 * q[dim], along row a of k: times the integral of the P1 functions of both. */
static double held_part(const run *r, int face, const int *q, int k, int a) {
  const contact_surface *s = r->surface;
  const int dim = s->dim;
  const double *along = s->frame + dim * dim * q[k] + dim * a;
  double normal[3], sum = 0.0;
  const double weight = mesh_face_normal(r->msh, face, normal) *
                        r->faces.face_weight[face] / (dim * (dim + 1));
  for (int l = 0; l < dim; ++l) {
    const double turn = r->faces.input.axisymmetric
                            ? M_PI * (s->x[dim * q[k]] + s->x[dim * q[l]])
                            : 1.0;
    for (int b = 1; b < dim && l != k; ++b)
      sum +=
          weight * turn * r->now.rc[dim * q[l] + b] / s->area[q[l]] *
          cblas_ddot(dim, along, 1, s->frame + dim * dim * q[l] + dim * b, 1);
  }
  return sum;
}

/* Of a held row without a force of its own: held_part. Next to slip, and not on
 * a plane of symmetry, the traction may be that of the neighbours up to the
 * node: up to thrice. */
static void add_row(const run *r, int face, const int *q, int k, int a,
                    goal_form *f) {
  const int row = r->msh->dim * q[k] + a;
  int open_end = !goal_is_mirrored(r, q[k]);
  if (!r->surface->held[row] || r->now.rc[row] != 0.0) return;
  for (int l = 0; l < r->msh->dim; ++l) open_end |= goal_slides(r, q[l]);
  const double part = f->psi[row] * held_part(r, face, q, k, a);
  f->curved += part;
  if (open_end) f->held += 3.0 * fabs(part);
}

/* Nodes that supports hold along the normal are no contact nodes: the traction
 * of the others of a face up to them is in no force. */
static void add_lost(const run *r, int face, const int *q, goal_form *f) {
  const int dim = r->msh->dim;
  double normal[3];
  const double weight =
      mesh_face_normal(r->msh, face, normal) * r->faces.face_weight[face] / dim;
  int lost = 0, left = 0;
  for (int k = 0; k < dim; ++k) ++*(q[k] < 0 ? &lost : &left);
  for (int k = 0; k < dim; ++k) {
    const double turn = r->faces.input.axisymmetric && q[k] >= 0
                            ? 2.0 * M_PI * r->surface->x[dim * q[k]]
                            : 1.0;
    for (int a = 0; a < dim && q[k] >= 0; ++a) {
      const double part = f->psi[dim * q[k] + a] * r->now.rc[dim * q[k] + a] *
                          weight * turn * lost / left / r->surface->area[q[k]];
      f->curved += part;
      f->held += fabs(part);
    }
  }
}

/* A node that a plane of symmetry holds has no friction along its normal, and
 * its part of the surface up to the other nodes is in no force: that of a
 * traction that is zero at it and linear. */
static status add_held(const run *r, const goal_card *g, goal_form *f) {
  const mesh *m = r->msh;
  const contact *on = &r->m->contacts[g->contact_id];
  if (on->is_pair) return OK;
  const mesh_group *of = r->faces.pairs[g->contact_id].group;
  OWNED_OF(int, where, goal_places(r, &where));
  for (int i = 0; i < of->n_item; ++i) {
    const int *v = m->face + m->dim * of->item_id[i];
    int q[3] = {0}, all = 1, none = 1;
    for (int k = 0; k < m->dim; ++k) {
      q[k] = where[v[k]];
      all = all && q[k] >= 0 && r->surface->area[q[k]] > 0.0;
      none = none && (q[k] < 0 || !(r->surface->area[q[k]] > 0.0));
    }
    for (int k = 0; k < m->dim && all; ++k)
      for (int a = 1; a < m->dim; ++a) add_row(r, of->item_id[i], q, k, a, f);
    if (!all && !none) add_lost(r, of->item_id[i], q, f);
  }
  return OK;
}

static status set_force(const run *r, const goal_card *g, goal_form *f) {
  const int dim = r->msh->dim;
  f->is_field = g->quantity == GOAL_MOMENT || g->component < GOAL_NORMAL;
  if (g->quantity == GOAL_MOMENT) f->spin[g->component] = 1.0;
  for (int i = 0; i < r->nodes.n; ++i)
    for (int a = 0; a < dim; ++a) {
      f->psi[dim * i + a] = share_of(r, g, i, a);
      const double part = f->psi[dim * i + a] * r->now.rc[dim * i + a];
      f->value += part;
      f->size += fabs(part);
    }
  return add_held(r, g, f);
}

/* Dissipated so far, by the limits at the ends; derivative: of the last. */
static status set_friction(const run *r, const goal_card *g, goal_form *f) {
  const int dim = r->msh->dim;
  f->value = r->now.energy.friction_end;
  f->sums = 1;
  f->is_still = !(f->value > 0.0) && r->problem.cp.g0 != NULL;
  for (int i = 0; i < r->nodes.n; ++i)
    for (int a = 1; a < dim; ++a) {
      const int k = (dim - 1) * i + a - 1;
      if (r->surface->side_id[k] >= 0) continue;
      f->rows[dim * i + a] = -r->now.rc[dim * i + a];
      f->psi[dim * i + a] = -r->result.slip[k];
    }
  return OK;
}

/* Adds the displacement of a node or the mean of a group times a sign. */
static status add_place(const run *r, int node_id, int group_id, int component,
                        double sign, goal_form *f) {
  if (node_id < 0) return goal_add_mean(r, group_id, component, sign, f);
  const int at = r->msh->dim * node_id + component;
  f->load[at] += sign;
  f->value += sign * r->now.u[at];
  f->size += fabs(r->now.u[at]);
  return OK;
}

static status set_displacement(const run *r, const goal_card *g, goal_form *f) {
  PASS(add_place(r, g->node_id, g->group_id, g->component, 1.0, f));
  if (g->from_node_id >= 0 || g->from_id >= 0)
    PASS(add_place(r, g->from_node_id, g->from_id, g->component, -1.0, f));
  return OK;
}

/* Of the body beyond the faces of an element. */
static void add_beyond(double part, goal_form *f) {
  f->curved += part;
  f->beyond += fabs(part);
}

/* beyond[n_elem] m3, by curved surfaces and interfaces. */
static status find_beyond(const run *r, const goal_form *f, double *beyond) {
  PASS(goal_volumes_beyond(r, beyond));
  if (f->of_all.volume != NULL)
    add_scaled(r->msh->n_elem, 1.0, f->of_all.volume, beyond);
  return OK;
}

/* With f->tau. */
static void add_interfaces(const run *r, goal_form *f) {
  const int n = r->m->ns * r->msh->n_elem;
  if (f->of_all.strain != NULL)
    add_beyond(cblas_ddot(n, f->tau, 1, f->of_all.strain, 1), f);
}

static status set_stress(const run *r, const goal_card *g, goal_form *f) {
  const domain *d = &r->body.d;
  const mesh_group *of = &r->msh->group[g->group_id];
  const size_t ns = d->ns, c = g->component - GOAL_TENSOR;
  double whole = 0.0;
  OWNED_NEW(double, beyond, r->msh->n_elem);
  OWNED_NEW(double, all, ns * r->msh->n_elem);
  domain strained = *d;
  strained.eigen = NULL;
  domain_stress(&strained, r->now.u, NULL, all);
  PASS(find_beyond(r, f, beyond));
  PASS(goal_volumes_of(r, of, f->of_all.region, beyond));
  for (int k = 0; k < of->n_item; ++k)
    whole += element_weight(d, of->item_id[k]);
  for (int k = 0; k < of->n_item; ++k) {
    const size_t e = of->item_id[k];
    const double *E = d->E + ns * ns * d->section_id[e];
    const double share = element_weight(d, (int)e) / whole;
    f->value += share * r->result.stress[ns * e + c];
    f->size +=
        share * fmax(fabs(r->result.stress[ns * e + c]), fabs(all[ns * e + c]));
    for (size_t i = 0; i < ns; ++i) f->tau[ns * e + i] = E[ns * i + c] / whole;
  }
  for (int k = 0; k < of->n_item; ++k) {
    const size_t e = of->item_id[k];
    add_beyond(beyond[e] / whole * (r->result.stress[ns * e + c] - f->value),
               f);
    if (f->of_all.rest != NULL)
      f->curved -= goal_thermal_rest(r, (int)e, f->of_all.rest, (int)c) / whole;
  }
  f->has_tau = 1;
  add_interfaces(r, f);
  return OK;
}

/* 1/2 sigma : inv(E) sigma of an element, J/m3. */
static status energy_density(const run *r, int elem_id, double *density) {
  const domain *d = &r->body.d;
  const double *sigma = r->result.stress + (size_t)d->ns * elem_id;
  double S[36] = {0.0};
  PASS(space_compliance(d, d->section_id[elem_id], S));
  *density = 0.0;
  for (int i = 0; i < d->ns; ++i)
    for (int k = 0; k < d->ns; ++k)
      *density += 0.5 * sigma[i] * S[i + d->ns * k] * sigma[k];
  return OK;
}

static status set_energy(const run *r, const goal_card *g, goal_form *f) {
  OWNED_NEW(double, beyond, r->msh->n_elem);
  PASS(find_beyond(r, f, beyond));
  for (int e = 0; e < r->msh->n_elem; ++e) {
    double density = 0.0;
    if (beyond[e] != 0.0) PASS(energy_density(r, e, &density));
    add_beyond(beyond[e] * density, f);
    if (f->of_all.rest != NULL)
      f->curved -= cblas_ddot(3, r->result.stress + r->m->ns * e, 1,
                              f->of_all.rest + 3 * e, 1);
  }
  f->value = r->now.energy.strain;
  f->has_tau = f->is_square = 1;
  COPY(f->tau, r->result.stress, (size_t)r->m->ns * r->msh->n_elem);
  add_interfaces(r, f);
  return OK;
}

/*
 * A stress intensity factor by its domain integral (fracture/fracture.h),
 * linear in the displacements within the domain and in the contact forces on
 * the lips, which are tractions over their areas.
 */

/* In space virtual growth changes along the front, where linear elements and
 * the quadrature miss that part of K, times their length over the radius of the
 * domain: 0.2 to 0.26 of it for a disc that is pressed apart. In the plane the
 * estimate misses that part times the square, 0.2 of it in the middle, 0.4 in
 * nine of ten cases of 3 to 8 elements on half a crack; below FEWEST across the
 * domain a third of the estimates was not within a factor of two. */
static const double ROUGH = 0.25; /* - */
static const double FEWEST = 5.0; /* - */

/* K_II and K_III at the two ends of a crack may differ in sign alone: so that
 * the mesh does not choose, a negative one counts as so much of its size. */
static const double NEGATIVE = 0.9; /* - */

/* The point at the node of the goal, or of the largest factor; -1: none. */
static int point_of(const goal_card *g, const crack_factors *k) {
  int best = -1;
  double most = -1.0;
  for (int i = 0; i < k->n; ++i) {
    const double K = k->at[i].K[g->component];
    if (isnan(K)) continue;
    const double size = K < 0.0 ? -NEGATIVE * K : K;
    if (g->n_point > 0 ? k->points[i].node != g->node_id : size <= most)
      continue;
    best = i;
    most = size;
  }
  return best;
}

/* 1: an edge of an element of its domains is longer than their radius. */
static int outgrows(const mesh *m, const fracture_linear *l, double radius) {
  for (int i = 0; i < l->n; ++i) {
    const int *v = m->elem + 3 * l->elem[i];
    for (int a = 0; a < 3; ++a) {
      const double *x = m->x + 2 * v[a], *y = m->x + 2 * v[(a + 1) % 3];
      if (hypot(x[0] - y[0], x[1] - y[1]) > radius) return 1;
    }
  }
  return 0;
}

static status set_factor(run *r, const goal_card *g, goal_form *f) {
  const size_t n = r->n_dof;
  crack_factors k;
  f->value = NAN;
  PASS(cracks_factors(r, g->crack_id, &k));
  const int point = point_of(g, &k);
  f->why = point < 0 ? GOAL_NO_FACTOR : GOAL_RELIABLE;
  if (point < 0) return OK;
  f->value = k.at[point].K[g->component];
  if (!k.is_linear || (k.at[point].pointed >> g->component & 1u) != 0)
    f->why = GOAL_NOT_COVERED;
  if (f->why == GOAL_NOT_COVERED) return OK;
  PASS(cracks_derive(r, g->crack_id, point, g->component, &f->factor));
  const double part = k.points[point].size / k.points[point].radius;
  f->is_front = r->msh->dim == 3;
  f->radius = f->is_front ? 0.0 : k.points[point].radius;
  f->factors = hypot(k.at[point].K[0], k.at[point].K[1]);
  f->is_coarse =
      !f->is_front && (part * FEWEST > 1.0 ||
                       outgrows(r->msh, &f->factor, k.points[point].radius));
  f->rough = ROUGH * fabs(f->value) * (f->is_front ? part : part * part);
  for (size_t i = 0; i < n; ++i) f->load[i] = f->factor.by_u[i];
  cracks_by_forces(r, f->factor.by_traction);
  if (r->nodes.n > 0)
    surface_relative(r->surface, f->factor.by_traction, f->psi);
  return OK;
}

status goal_form_set(run *r, const goal_card *g, goal_form *f) {
  static status (*const set[])(const run *r, const goal_card *g,
                               goal_form *f) = {
      [GOAL_FORCE] = set_force,       [GOAL_PRESSURE] = goal_set_pressure,
      [GOAL_WIDTH] = goal_set_width,  [GOAL_DISPLACEMENT] = set_displacement,
      [GOAL_STRESS] = set_stress,     [GOAL_ENERGY] = set_energy,
      [GOAL_FRICTION] = set_friction, [GOAL_MOMENT] = set_force};
  clear(r, f);
  if (g->quantity == GOAL_SIF) return set_factor(r, g, f);
  PASS(set[g->quantity](r, g, f));
  if (f->has_tau) domain_internal_force(&r->body.d, f->tau, f->load);
  return OK;
}
