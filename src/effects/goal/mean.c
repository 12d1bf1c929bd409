/*
 * Means of a displacement: over the area of the faces of a group, or the volume
 * of its elements, as a unit traction over it would do work; over the nodes of
 * a group that has nothing else.
 */
#include "effects/goal/parts.h"

/* ---- at the nodes -------------------------------------------------------- */

/* Integrals of the P1 functions of a group for a component; the whole. */
static status weights_of(const run *r, int group_id, int component,
                         double *weight, double *whole) {
  const mesh_group *g = &r->msh->group[group_id];
  load unit = {.kind = g->dim == r->msh->dim ? LOAD_BODY : LOAD_TRACTION,
               .run = RUN_DIRECT,
               .group = g->name,
               .group_id = group_id,
               .component = component,
               .value = {.number = 1.0},
               .at = r->step->at};
  step s = *r->step;
  s.loads = (load_list){.n = 1, .item = &unit};
  PASS(load_forces(r->m, r->msh, &s, r->now.t, weight));
  *whole = 0.0;
  for (int k = 0; k < g->n_node; ++k)
    *whole += weight[r->msh->dim * g->node_id[k] + component];
  return OK;
}

/* Adds the mean with these weights of a component; NULL: all are 1. */
static void add_weighted(const run *r, const mesh_group *g, int component,
                         const double *weight, double factor, goal_form *f) {
  for (int k = 0; k < g->n_node; ++k) {
    const int at = r->msh->dim * g->node_id[k] + component;
    const double part = factor * (weight != NULL ? weight[at] : 1.0);
    f->load[at] += part;
    f->value += part * r->now.u[at];
    f->size += fabs(part * r->now.u[at]);
  }
}

status goal_add_mean(const run *r, int group_id, int component, double sign,
                     goal_form *f) {
  const mesh_group *g = &r->msh->group[group_id];
  OWNED double *weight = NULL;
  double whole = 0.0, before = f->value, beyond = 0.0;
  if (g->n_item > 0) {
    PASS_NEW(weight, r->n_dof);
    PASS(weights_of(r, group_id, component, weight, &whole));
  }
  if (!(whole > 0.0)) {
    add_weighted(r, g, component, NULL, sign / g->n_node, f);
    return OK;
  }
  add_weighted(r, g, component, weight, sign / whole, f);
  const goal_mean m = {group_id, component, sign / whole};
  PASS(goal_beyond_mean(r, &m, (f->value - before) / sign, &beyond));
  f->curved += beyond;
  f->mean[f->n_mean++] = m;
  return OK;
}

/* ---- between them -------------------------------------------------------- */

/* Integral of the bubble of the edge from corner a to b over a face or an
 * element v[n]. */
static double bubble_integral(const run *r, const int *v, int n, int a, int b,
                              double measure) {
  static const double share[5] = {[2] = 2.0 / 3.0, [3] = 1.0 / 3.0, [4] = 0.2};
  double radius = 0.0;
  if (r->m->sections[0].kin != AXISYMMETRIC) return share[n] * measure;
  for (int k = 0; k < n; ++k)
    radius += (k == a || k == b ? 2.0 : 1.0) * r->msh->x[2 * v[k]];
  return share[n] * measure * 2.0 * M_PI * radius / (n == 2 ? 4.0 : 5.0);
}

/* Of one face or element, with the measure times the thickness. */
static double item_bubbles(const run *r, const goal_estimator *e,
                           const goal_mean *w, int item) {
  const mesh *m = r->msh;
  const int of_faces = m->group[w->group_id].dim < m->dim;
  const int elem = of_faces ? m->face_elem[item] : item;
  const int n = of_faces ? m->dim : m->dim + 1;
  const int *v = of_faces ? m->face + n * item : m->elem + n * item;
  double normal[3], d[3], sum = 0.0;
  const double measure = (of_faces ? mesh_face_normal(m, item, normal)
                                   : mesh_elem_measure(m, item)) *
                         r->m->sections[r->m->elem_section[elem]].thickness;
  for (int a = 0; a < n; ++a)
    for (int b = a + 1; b < n; ++b) {
      goal_estimator_bubble(e, elem, v[a], v[b], d);
      sum += d[w->component] * bubble_integral(r, v, n, a, b, measure);
    }
  return sum;
}

double goal_mean_bubbles(const run *r, const goal_estimator *e,
                         const goal_form *f) {
  double sum = 0.0;
  for (int i = 0; i < f->n_mean; ++i) {
    const mesh_group *g = &r->msh->group[f->mean[i].group_id];
    for (int k = 0; k < g->n_item; ++k)
      sum += f->mean[i].factor * item_bubbles(r, e, &f->mean[i], g->item_id[k]);
  }
  return sum;
}

int goal_has_one_thickness(const run *r, int contact_id) {
  const mesh_group *of = r->faces.pairs[contact_id].group;
  const double *thickness = r->faces.face_weight;
  for (int k = 0; k < of->n_item; ++k)
    if (thickness[of->item_id[k]] != thickness[of->item_id[0]]) return 0;
  return 1;
}
