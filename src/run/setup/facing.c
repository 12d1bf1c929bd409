/*
 * The faces of a contact that face its obstacle.
 *
 * Where faces of a group meet at an edge of the body, those count that lean
 * about as little from the obstacle as the one that leans least: the foot of a
 * block and not its sides, but both sides of a wedge on its tip. Else the sides
 * would have their part in areas and normals of the edge.
 */
#include "base/base.h"
#include "run/setup/setup.h"

static double lean_of(const mesh *m, const obstacle *o, int face_id, int k) {
  const int node_id = m->face[m->dim * face_id + k];
  double normal[3];
  mesh_face_normal(m, face_id, normal);
  return obstacle_lean(o, m->dim, &m->x[m->dim * node_id], normal);
}

/* 1: on the axis of symmetry, where there is no surface. */
static int is_axis(const mesh *m, int axisymmetric, int face_id) {
  const int *node = &m->face[m->dim * face_id];
  return axisymmetric && m->x[2 * node[0]] == 0.0 && m->x[2 * node[1]] == 0.0;
}

/* least[n_node]: the least angle of its faces, rad. */
static void find_least(const mesh *m, const obstacle *o, const mesh_group *g,
                       double *least) {
  for (int i = 0; i < m->n_node; ++i) least[i] = HUGE_VAL;
  for (int i = 0; i < g->n_item; ++i)
    for (int k = 0; k < m->dim; ++k) {
      double *of = &least[m->face[m->dim * g->item_id[i] + k]];
      *of = fmin(*of, lean_of(m, o, g->item_id[i], k));
    }
}

static int counts(const mesh *m, const obstacle *o, int face_id,
                  const double *least) {
  static const double sharp = 0.7; /* rad */
  for (int k = 0; k < m->dim; ++k)
    if (lean_of(m, o, face_id, k) >
        least[m->face[m->dim * face_id + k]] + sharp)
      return 0;
  return 1;
}

/* Shapes without a normal have that of the body, which is one at an edge. */
static status warn_edges(const mesh *m, const contact_pair *p,
                         message_log *log) {
  static const double sharp = 0.5; /* rad, from the mean of both sides */
  const mesh_group *g = p->group;
  double normal[3], most = 0.0;
  int node_id = -1;
  OWNED_NEW(double, mean, m->dim * m->n_node);
  for (int i = 0; i < g->n_item; ++i) {
    const double measure = mesh_face_normal(m, g->item_id[i], normal);
    for (int k = 0; k < m->dim; ++k)
      for (int c = 0; c < m->dim; ++c)
        mean[m->dim * m->face[m->dim * g->item_id[i] + k] + c] +=
            measure * normal[c];
  }
  for (int i = 0; i < g->n_item; ++i)
    for (int k = 0; k < m->dim; ++k) {
      const int id = m->face[m->dim * g->item_id[i] + k];
      const double *v = &mean[m->dim * id];
      mesh_face_normal(m, g->item_id[i], normal);
      const double lean = acos(
          fmax(-1, fmin(1, dot(m->dim, v, normal) / sqrt(dot(m->dim, v, v)))));
      if (lean > most) most = lean, node_id = id;
    }
  if (most > sharp)
    message_add(log, P4037, &p->at,
                "%s %s: faces of group %s lean by %.2g rad from their mean, "
                "along which contact is, at node %zu: a *CONTACT for each side "
                "of the edge has both normals",
                p->card, p->name, g->name, most, m->node_no[node_id]);
  return OK;
}

status setup_facing(const run *r, contact_pair *p) {
  const mesh *m = r->msh;
  const mesh_group *all = p->group;
  mesh_group *g = NULL;
  if (all->dim != m->dim - 1) return OK;
  OWNED_NEW(double, least, m->n_node);
  find_least(m, p->support, all, least);
  PASS_NEW(g, 1);
  *g = (mesh_group){.name = all->name, .dim = all->dim, .tag = all->tag};
  PASS_NEW_ALL(OF(g->item_id, all->n_item), OF(g->node_id, all->n_node));
  p->group = g;
  for (int i = 0; i < all->n_item; ++i)
    if (counts(m, p->support, all->item_id[i], least) &&
        !is_axis(m, r->faces.input.axisymmetric, all->item_id[i]))
      g->item_id[g->n_item++] = all->item_id[i];
  for (int i = 0; i < g->n_item; ++i)
    for (int k = 0; k < m->dim; ++k)
      least[m->face[m->dim * g->item_id[i] + k]] = -1.0;
  for (int i = 0; i < all->n_node; ++i)
    if (least[all->node_id[i]] < 0.0) g->node_id[g->n_node++] = all->node_id[i];
  if (p->support->shape != OBSTACLE_GAP &&
      p->support->shape != OBSTACLE_CONFORMING)
    return OK;
  return warn_edges(m, p, r->m->log);
}
