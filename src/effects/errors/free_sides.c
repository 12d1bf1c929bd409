/*
 * The stress across sides of the body that nothing holds or touches is what
 * loads give there. A mesh of few elements may have one and the same stress
 * everywhere, as that of a layer between plates: what is recovered from it is
 * the same too and tells no error, but those sides do.
 */
#include "effects/errors/free_sides.h"

#include "base/base.h"

#include <cblas.h>

/* Sides with all nodes in the group. */
static status find(const mesh *m, int group_id, const free_sides *s,
                   unsigned char *in) {
  const mesh_group *g = &m->group[group_id];
  OWNED_NEW(unsigned char, of_group, m->n_node);
  for (int k = 0; k < g->n_node; ++k) of_group[g->node_id[k]] = 1;
  for (int k = 0; k < s->n; ++k) {
    int v[3];
    mesh_side_nodes(m, s->side[k], v);
    in[k] = 1;
    for (int a = 0; a < m->dim; ++a)
      if (!of_group[v[a]]) in[k] = 0;
  }
  return OK;
}

/* They are not free. */
static status take(const mesh *m, int group_id, const free_sides *s,
                   unsigned char *taken) {
  if (group_id < 0) return OK;
  OWNED_NEW(unsigned char, in, s->n);
  PASS(find(m, group_id, s, in));
  for (int k = 0; k < s->n; ++k)
    if (in[k]) taken[k] = 1;
  return OK;
}

static status take_pair(const mesh *m, const surface_pair *p,
                        const free_sides *s, unsigned char *taken) {
  PASS(take(m, p->slave_id, s, taken));
  return take(m, p->master_id, s, taken);
}

static status take_all(const run *r, const free_sides *s,
                       unsigned char *taken) {
  for (EACH(const load, l, r->step->loads.item, r->step->loads.n))
    if (l->kind == LOAD_FIXING || l->kind == LOAD_POINT)
      PASS(take(r->msh, l->group_id, s, taken));
  for (EACH(const contact, c, r->m->contacts, r->m->n.contact))
    PASS(c->is_pair ? take_pair(r->msh, &c->pair, s, taken)
                    : take(r->msh, c->group_id, s, taken));
  for (EACH(const tie, t, r->m->ties, r->m->n.tie))
    PASS(take_pair(r->msh, &t->pair, s, taken));
  return OK;
}

/* Outward unit normal n[3] and middle x[3] of a side; 1: it is on the axis. */
static int place_of(const run *r, int side, double n[3], double x[3]) {
  const mesh *m = r->msh;
  const int dim = m->dim, elem = side / (dim + 1);
  const double *at[3];
  double from_axis = 0.0;
  int v[3];
  mesh_side_nodes(m, side, v);
  CLEAR(n, 3);
  CLEAR(x, 3);
  for (int a = 0; a < dim; ++a) {
    at[a] = m->x + (size_t)dim * v[a];
    from_axis = fmax(from_axis, fabs(at[a][0]));
    for (int c = 0; c < dim; ++c) x[c] += at[a][c] / dim;
  }
  for (int c = 0; c < dim; ++c) {
    const int p = (c + 1) % dim, q = (c + 2) % dim;
    n[c] = dim == 2 ? (c == 0 ? at[1][1] - at[0][1] : at[0][0] - at[1][0])
                    : (at[1][p] - at[0][p]) * (at[2][q] - at[0][q]) -
                          (at[1][q] - at[0][q]) * (at[2][p] - at[0][p]);
  }
  cblas_dscal(3, 1.0 / cblas_dnrm2(3, n, 1), n, 1);
  return r->body.d.kin[r->body.d.section_id[elem]] == AXISYMMETRIC &&
         from_axis == 0.0;
}

/* Takes the tractions of a load off t[3*n]. */
static status give(const run *r, const load *l, const free_sides *s,
                   double *t) {
  OWNED_NEW(unsigned char, in, s->n);
  PASS(find(r->msh, l->group_id, s, in));
  for (int k = 0; k < s->n; ++k) {
    double n[3], x[3];
    if (!in[k]) continue;
    place_of(r, s->side[k], n, x);
    const double value = load_at_point(l, r->step, x, r->now.t);
    if (l->kind == LOAD_TRACTION)
      t[3 * k + l->component] -= value;
    else
      cblas_daxpy(3, value, n, 1, t + 3 * k, 1);
  }
  return OK;
}

/* t[3*n] of the stress less what loads give, Pa; 0 on the axis. */
static status find_tractions(const run *r, const free_sides *s, double *t) {
  static const int voigt[2][3][3] = {{{0, 3}, {3, 1}},
                                     {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}}};
  const int dim = r->msh->dim;
  for (EACH(const load, l, r->step->loads.item, r->step->loads.n))
    if (l->kind == LOAD_PRESSURE || l->kind == LOAD_TRACTION)
      PASS(give(r, l, s, t));
  for (int k = 0; k < s->n; ++k) {
    const double *sigma =
        r->result.stress + (size_t)r->m->ns * (s->side[k] / (dim + 1));
    double n[3], x[3];
    const int on_axis = place_of(r, s->side[k], n, x);
    for (int i = 0; i < dim; ++i)
      for (int j = 0; j < dim; ++j)
        t[3 * k + i] += sigma[voigt[dim - 2][i][j]] * n[j];
    if (on_axis) CLEAR(t + 3 * k, 3);
  }
  return OK;
}

status free_sides_energy(const run *r, const free_sides *s, double *energy) {
  const domain *d = &r->body.d;
  OWNED double *t = NULL;
  OWNED unsigned char *taken = NULL;
  *energy = 0.0;
  PASS_NEW_ALL(OF(t, 3 * s->n), OF(taken, s->n));
  PASS(take_all(r, s, taken));
  PASS(find_tractions(r, s, t));
  for (int k = 0; k < s->n; ++k) {
    const int elem = s->side[k] / (r->msh->dim + 1);
    const double *E = d->E + (size_t)d->ns * d->ns * d->section_id[elem];
    if (!taken[k])
      *energy += cblas_ddot(3, t + 3 * k, 1, t + 3 * k, 1) / E[0] *
                 element_weight(d, elem);
  }
  return OK;
}
