/*
 * Sides of the border of the bodies: what loads give there, and what the stress
 * across those that nothing holds or touches has more or less. A mesh of few
 * elements may have one and the same stress everywhere, as that of a layer
 * between plates: what is recovered from it is the same too and tells no error,
 * but those sides do.
 */
#include "base/base.h"
#include "effects/shared.h"

#include <cblas.h>

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

/* to[dim] of a side. */
static void add_load(const run *r, const load *l, int side, side_load *to) {
  const int dim = r->msh->dim;
  int v[3];
  mesh_side_nodes(r->msh, side, v);
  for (int a = 0; a < dim; ++a) {
    const double value = load_at_node(l, r->msh, r->step, v[a], r->now.t);
    *(l->kind == LOAD_PRESSURE ? &to[a].pressure
                               : &to[a].traction[l->component]) += value;
  }
}

status side_loads_new(const run *r, int n, const int *side, side_load **out) {
  const mesh *m = r->msh;
  const int dim = m->dim;
  OWNED_NEW(int, row, (dim + 1) * m->n_elem);
  PASS_NEW(*out, dim * n);
  for (int k = 0; k < n; ++k) row[side[k]] = k + 1;
  for (EACH(const load, l, r->step->loads.item, r->step->loads.n)) {
    const mesh_group *g = &m->group[l->group_id];
    if (l->kind != LOAD_PRESSURE && l->kind != LOAD_TRACTION) continue;
    for (int k = 0; k < g->n_item; ++k) {
      const int of = side_of(m, g->item_id[k]), at = row[of];
      if (at > 0) add_load(r, l, of, *out + dim * (at - 1));
    }
  }
  return OK;
}

/* ---- free sides ---------------------------------------------------------- */

/* Sides with all nodes in the group are none. */
static status take(const mesh *m, int group_id, int n, const int *side,
                   unsigned char *taken) {
  if (group_id < 0) return OK;
  const mesh_group *g = &m->group[group_id];
  OWNED_NEW(unsigned char, in, m->n_node);
  for (int k = 0; k < g->n_node; ++k) in[g->node_id[k]] = 1;
  for (int k = 0; k < n; ++k) {
    int v[3], inside = 0;
    mesh_side_nodes(m, side[k], v);
    for (int a = 0; a < m->dim; ++a) inside += in[v[a]];
    if (inside == m->dim) taken[k] = 1;
  }
  return OK;
}

static status take_pair(const mesh *m, const surface_pair *p, int n,
                        const int *side, unsigned char *taken) {
  PASS(take(m, p->slave_id, n, side, taken));
  return take(m, p->master_id, n, side, taken);
}

static status take_all(const run *r, int n, const int *side,
                       unsigned char *taken) {
  const mesh *m = r->msh;
  for (EACH(const load, l, r->step->loads.item, r->step->loads.n))
    if (l->kind == LOAD_FIXING || l->kind == LOAD_POINT)
      PASS(take(m, l->group_id, n, side, taken));
  for (EACH(const contact, c, r->m->contacts, r->m->n.contact))
    PASS(c->is_pair ? take_pair(m, &c->pair, n, side, taken)
                    : take(m, c->group_id, n, side, taken));
  for (EACH(const tie, t, r->m->ties, r->m->n.tie))
    PASS(take_pair(m, &t->pair, n, side, taken));
  return OK;
}

/* Its outward normal n[dim], which falls from the node across at the greatest
 * rate; 0 on the axis. */
static void normal_of(const run *r, int side, double n[3]) {
  const mesh *m = r->msh;
  const int dim = m->dim, elem = side / (dim + 1);
  const int *w = m->elem + (dim + 1) * elem;
  double g[12], from_axis = 0.0;
  int v[3], far = 0, sum = 0;
  mesh_side_nodes(m, side, v);
  for (int a = 0; a <= dim; ++a) sum += w[a];
  for (int a = 0; a < dim; ++a) {
    sum -= v[a];
    from_axis = fmax(from_axis, fabs(m->x[dim * v[a]]));
  }
  while (w[far] != sum) ++far;
  mesh_elem_gradients(m, elem, g);
  for (int c = 0; c < dim; ++c) n[c] = -g[dim * far + c];
  const int on_axis =
      r->body.d.kin[r->body.d.section_id[elem]] == AXISYMMETRIC &&
      from_axis == 0.0;
  cblas_dscal(dim, on_axis ? 0.0 : 1.0 / cblas_dnrm2(dim, n, 1), n, 1);
}

/* Square of the stress across a side less its mean load, Pa^2. */
static double across(const run *r, int side, const side_load *loads) {
  static const int voigt[2][3][3] = {{{0, 3}, {3, 1}},
                                     {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}}};
  const int dim = r->msh->dim;
  const double *sigma =
      r->result.stress + (size_t)r->m->ns * (side / (dim + 1));
  double n[3], square = 0.0;
  normal_of(r, side, n);
  for (int i = 0; i < dim; ++i) {
    double t = 0.0;
    for (int j = 0; j < dim; ++j) t += sigma[voigt[dim - 2][i][j]] * n[j];
    for (int a = 0; a < dim; ++a)
      t -= (loads[a].traction[i] - loads[a].pressure * n[i]) / dim;
    square += t * t;
  }
  return square;
}

status free_sides_energy(const run *r, int n, const int *side, double *energy) {
  const domain *d = &r->body.d;
  OWNED_NEW(unsigned char, taken, n);
  OWNED_OF(side_load, loads, side_loads_new(r, n, side, &loads));
  *energy = 0.0;
  PASS(take_all(r, n, side, taken));
  for (int k = 0; k < n; ++k) {
    const int elem = side[k] / (r->msh->dim + 1);
    const double *E = d->E + (size_t)d->ns * d->ns * d->section_id[elem];
    if (!taken[k])
      *energy += across(r, side[k], loads + r->msh->dim * k) / E[0] *
                 element_weight(d, elem);
  }
  return OK;
}
