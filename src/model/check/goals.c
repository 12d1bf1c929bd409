/*
 * The places of *GOAL in the mesh.
 */
#include "model/check/parts.h"

#include <math.h>

static const double NEAR = 1e-6; /* -, of the size of the mesh */

/* The node nearest to a point, and how far it is, m. */
static int nearest_node(const mesh *msh, const double *x, double *distance) {
  int best = -1;
  *distance = HUGE_VAL;
  for (int i = 0; i < msh->n_node; ++i) {
    double d = 0.0;
    for (int c = 0; c < msh->dim; ++c)
      d = hypot(d, msh->x[msh->dim * i + c] - x[c]);
    if (d >= *distance) continue;
    *distance = d;
    best = i;
  }
  return best;
}

static void find_point(const model *m, const mesh *msh, goal_card *g) {
  double distance;
  g->node_id = nearest_node(msh, g->point, &distance);
  const double *x = msh->x + msh->dim * g->node_id;
  if (distance > NEAR * msh->size && g->quantity == GOAL_DISPLACEMENT)
    message_add(m->log, P2021, &g->point_at,
                "*GOAL %s: no node of the mesh is at this point, the nearest "
                "is %zu at (%g, %g, %g)%s",
                g->name, msh->node_no[g->node_id], x[0], x[1],
                msh->dim == 3 ? x[2] : msh->z,
                model_has_target(m) ? "; TARGET= meshes again: make it a "
                                      "Point of the .geo"
                                    : "");
}

static void check_goal(const model *m, const mesh *msh, goal_card *g) {
  const int tensor = g->component - GOAL_TENSOR;
  if (g->has_point) find_point(m, msh, g);
  if (g->group != NULL && g->quantity == GOAL_STRESS)
    g->group_id = check_group_of(m, msh, g->group, msh->dim, &g->group_at);
  else if (g->group != NULL)
    g->group_id = check_group(m, msh, g->group, &g->group_at);
  if (tensor >= m->ns ||
      (g->component < GOAL_NORMAL && g->component >= msh->dim))
    message_add(m->log, P2024, &g->at,
                "*GOAL %s: a mesh in %d-D has no such component", g->name,
                msh->dim);
}

void check_goals(model *m, const mesh *msh) {
  for (int i = 0; i < m->n.goal; ++i) check_goal(m, msh, &m->accuracy.goals[i]);
}
