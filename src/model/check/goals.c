/*
 * The places of *GOAL in the mesh.
 */
#include "model/check/parts.h"

#include <math.h>

static const double NEAR = 1e-6; /* -, of the size of the mesh */

static double distance_to(const mesh *msh, int node_id, const double *x) {
  double d = 0.0;
  for (int c = 0; c < msh->dim; ++c)
    d = hypot(d, msh->x[msh->dim * node_id + c] - x[c]);
  return d;
}

/* The node nearest to a point, and how far it is, m. */
static int nearest_node(const mesh *msh, const double *x, double *distance) {
  int best = -1;
  *distance = HUGE_VAL;
  for (int i = 0; i < msh->n_node; ++i) {
    const double d = distance_to(msh, i, x);
    if (d >= *distance) continue;
    *distance = d;
    best = i;
  }
  return best;
}

/* The node of point k of a goal. */
static int find_point(const model *m, const mesh *msh, const goal_card *g,
                      int k) {
  double distance;
  const int id = nearest_node(msh, g->point[k], &distance);
  const double *x = msh->x + msh->dim * id;
  if (distance > NEAR * msh->size && g->quantity == GOAL_DISPLACEMENT)
    message_add(m->log, P2021, &g->point_at[k],
                "*GOAL %s: no node of the mesh is at this point, the nearest "
                "is %zu at (%g, %g, %g)%s",
                g->name, msh->node_no[id], x[0], x[1],
                msh->dim == 3 ? x[2] : msh->z,
                model_has_target(m) ? "; TARGET= meshes again: make it a "
                                      "Point of the .geo"
                                    : "");
  return id;
}

/* The node of the front nearest to the point of a goal; P2021 if the point is
 * further from it than the next node is. */
static int find_front(const model *m, const mesh *msh, const goal_card *g) {
  const mesh_crack *c = &msh->crack[g->crack_id];
  const int dim = msh->dim, n = c->front_start[c->n_front];
  int best = -1;
  double least = HUGE_VAL, reach = NEAR * msh->size;
  for (int i = 0; i < n; ++i) {
    const double d = distance_to(msh, c->front_node[i], g->point[0]);
    if (d < least) best = i;
    least = fmin(d, least);
  }
  for (int i = best < 1 ? 0 : best - 1; dim == 3 && i <= best && i < n - 1; ++i)
    if (best >= 0 && c->front_face[i] >= 0)
      reach = fmax(reach, distance_to(msh, c->front_node[i],
                                      msh->x + dim * c->front_node[i + 1]));
  if (best >= 0 && least <= reach) return c->front_node[best];
  message_add(m->log, P2021, &g->point_at[0],
              "*GOAL %s: the front of *CRACK %s does not pass this point",
              g->name, m->mesh.cracks[g->crack_id].name);
  return -1;
}

/* 1: a mesh of this dimension has the component; in the plane moments turn
 * about z, and on an axis there are none. */
static int has_component(const model *m, const mesh *msh, const goal_card *g) {
  if (g->component - GOAL_TENSOR >= m->ns) return 0;
  if (g->component >= GOAL_NORMAL) return 1;
  if (g->quantity == GOAL_MOMENT && msh->dim == 2 && m->n.section > 0)
    return g->component == 2 && m->sections[0].kin != AXISYMMETRIC;
  return g->component < msh->dim;
}

static void check_goal(const model *m, const mesh *msh, goal_card *g) {
  if (g->quantity == GOAL_SIF && g->crack_id < 0) return;
  if (g->n_point > 0)
    g->node_id = g->quantity == GOAL_SIF ? find_front(m, msh, g)
                                         : find_point(m, msh, g, 0);
  if (g->n_point > 1) g->from_node_id = find_point(m, msh, g, 1);
  if (g->from != NULL) g->from_id = check_group(m, msh, g->from, &g->from_at);
  if (g->group != NULL && g->quantity == GOAL_STRESS)
    g->group_id = check_group_of(m, msh, g->group, msh->dim, &g->group_at);
  else if (g->group != NULL)
    g->group_id = check_group(m, msh, g->group, &g->group_at);
  if (g->quantity == GOAL_SIF && m->n.section > 0 &&
      m->sections[0].kin == AXISYMMETRIC)
    message_add(m->log, P2024, &g->at,
                "*GOAL %s: there are no stress intensity factors of "
                "axisymmetric bodies",
                g->name);
  else if (!has_component(m, msh, g))
    message_add(m->log, P2024, &g->at,
                "*GOAL %s: a mesh in %d-D has no such component", g->name,
                msh->dim);
}

void check_goals(model *m, const mesh *msh) {
  for (int i = 0; i < m->n.goal; ++i) check_goal(m, msh, &m->accuracy.goals[i]);
}
