/*
 * Loads of sides that meet. The tractions t, t' of two sides with the normals
 * n, n' belong to one stress where t.n' = t'.n, on a smooth side where t = t'.
 * Elsewhere the stress is another from each direction, or infinite as the
 * logarithm of the distance, and recovered gradients miss it: where a load
 * ends, where a shear ends in a corner.
 */
#include "base/base.h"
#include "effects/goal/parts.h"

/* Beyond rounding. */
static const double SAME = 1e-6; /* -, of the tractions */

/* Side of an element that is a face of the mesh. */
static int side_of(const mesh *m, int face) {
  const int dim = m->dim, first = (dim + 1) * m->face_elem[face];
  int id = first - 1, same = 0;
  while (same < dim && ++id < first + dim + 1) {
    int v[3];
    mesh_side_nodes(m, id, v);
    same = 0;
    for (int i = 0; i < dim; ++i)
      for (int k = 0; k < dim; ++k) same += v[i] == m->face[dim * face + k];
  }
  return id;
}

/* pull[dim] of a side. */
static void add_load(const run *r, const load *l, int side, goal_pull *pull) {
  const int dim = r->msh->dim;
  int v[3];
  mesh_side_nodes(r->msh, side, v);
  for (int a = 0; a < dim; ++a) {
    const double value = load_at_node(l, r->msh, r->step, v[a], r->now.t);
    goal_pull *to = &pull[a];
    *(l->kind == LOAD_PRESSURE ? &to->pressure : &to->traction[l->component]) +=
        value;
  }
}

status goal_pulls_new(const run *r, const goal_border *b, goal_pull **pull) {
  const mesh *m = r->msh;
  const int dim = m->dim;
  OWNED_NEW(int, row, (dim + 1) * m->n_elem);
  PASS_NEW(*pull, dim * b->n);
  for (int k = 0; k < b->n; ++k) row[b->side[k]] = k + 1;
  for (EACH(const load, l, r->step->loads.item, r->step->loads.n)) {
    const mesh_group *g = &m->group[l->group_id];
    if (l->kind != LOAD_PRESSURE && l->kind != LOAD_TRACTION) continue;
    for (int k = 0; k < g->n_item; ++k) {
      const int side = side_of(m, g->item_id[k]), at = row[side];
      if (at > 0) add_load(r, l, side, *pull + dim * (at - 1));
    }
  }
  return OK;
}

/* Its traction along m[dim], on a side with the normal n[dim]. */
static double along(int dim, const goal_pull *p, const double *n,
                    const double *m) {
  return dot(dim, p->traction, m) - p->pressure * dot(dim, n, m);
}

int goal_is_torn(int dim, const goal_pull *p, const double *n,
                 const goal_pull *q, const double *m, int smooth) {
  double jump = 0.0, size = hypot(p->pressure, q->pressure);
  for (int c = 0; c < dim; ++c) {
    size = hypot(size, hypot(p->traction[c], q->traction[c]));
    jump = hypot(jump, p->traction[c] - q->traction[c]);
  }
  jump = smooth ? hypot(jump, p->pressure - q->pressure)
                : fabs(along(dim, p, n, m) - along(dim, q, m, n));
  return jump > SAME * size;
}
