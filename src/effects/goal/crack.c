/*
 * Goals of a crack: a stress intensity factor by its domain integral
 * (fracture/fracture.h), linear in the displacements within the domain and in
 * the contact forces on the lips, which are tractions over their areas.
 */
#include "effects/goal/parts.h"
#include "effects/shared.h"

#include "base/memory.h"

#include <math.h>

/* In space virtual growth changes along the front, where linear elements and
 * the quadrature miss that part of K, times their length over the radius of the
 * domain: 0.2 to 0.26 of it for a disc that is pressed apart. */
static const double ROUGH = 0.25; /* - */

/* The point at the node of the goal, or that of the largest factor; -1: none
 * has one. */
static int find_point(const goal_card *g, const crack_factors *k) {
  int best = -1;
  double most = -1.0;
  for (int i = 0; i < k->n; ++i) {
    const double K = k->at[i].K[g->component];
    if (isnan(K)) continue;
    if (g->n_point > 0 ? k->points[i].node != g->node_id : fabs(K) <= most)
      continue;
    best = i;
    most = fabs(K);
  }
  return best;
}

status goal_set_factor(run *r, const goal_card *g, goal_form *f) {
  const size_t n = r->n_dof;
  crack_factors k;
  f->value = NAN;
  PASS(cracks_factors(r, g->crack_id, &k));
  const int point = find_point(g, &k);
  f->why = point < 0 ? GOAL_NO_FACTOR : GOAL_RELIABLE;
  if (point < 0) return OK;
  f->value = k.at[point].K[g->component];
  if (!k.is_linear) f->why = GOAL_NOT_COVERED;
  if (!k.is_linear) return OK;
  PASS(cracks_derive(r, g->crack_id, point, g->component, &f->factor));
  if (r->msh->dim == 3)
    f->rough =
        ROUGH * fabs(f->value) * k.points[point].size / k.points[point].radius;
  for (size_t i = 0; i < n; ++i) f->load[i] = f->factor.by_u[i];
  cracks_by_forces(r, f->factor.by_traction);
  if (r->nodes.n > 0)
    surface_relative(r->surface, f->factor.by_traction, f->psi);
  return OK;
}
