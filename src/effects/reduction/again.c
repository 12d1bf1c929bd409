/*
 * The increment solved once more with an effect that is left out, with its
 * strains and forces at the current state: its change to first order, in
 * displacements, in the forces of the nodes and in their sums. The bounds of
 * measure.c speak of energies; a slender body may move far for little energy,
 * and friction may be a small part of the forces.
 */
#include "effects/reduction/parts.h"

#include "base/memory.h"
#include "base/sparse.h"

#include <math.h>
#include <string.h>

/* Strains of the row of the elements it is about into n->strain. */
static void take_strains(reduction *n, const omitted *row) {
  const int ns = n->m->ns, heat = row->bit == EFFECT_BIT_THERMAL;
  const double *from = heat ? n->heat : n->flow.strain;
  for (int e = 0; e < n->msh->n_elem; ++e) {
    const int own = heat || reduction_is_about(n, row, e);
    for (int i = 0; i < ns; ++i)
      n->strain[ns * e + i] = own ? from[ns * e + i] : 0.0;
  }
}

/* Friction at node i against a displacement: at most its limit, and the force
 * that returns the node alone, N. */
static double friction_force(const reduction *n, const state *s, int i,
                             double way) {
  const contact_problem *cp = s->contacts.problem;
  const int k = cp->dim * i;
  double held = 0.0;
  for (int a = 1; a < cp->dim; ++a)
    held = fmax(held, contact_diagonal(cp, k + a));
  return fmin(reduction_coefficient(n, s, i) * fmax(-s->contacts.rc[k], 0.0),
              held * way);
}

/* Friction against the displacement of each node into n->force, N. */
static void take_friction(reduction *n, const state *s) {
  const contact_surface *c = s->contacts.surface;
  const int sides = n->msh->dim - 1;
  for (int i = 0; c != NULL && i < c->n; ++i) {
    const double *way = n->way + sides * c->node_id[i];
    const double length = sides == 2 ? hypot(way[0], way[1]) : fabs(way[0]);
    if (!(length > 0.0)) continue;
    const double force = friction_force(n, s, i, length);
    for (int a = 0; a < sides; ++a)
      surface_spread_row(c, i, a + 1, -(force * way[a] / length), n->force);
  }
}

static void take_forces(reduction *n, const state *s, const omitted *row) {
  const eigenstrain x = {n->msh->n_elem, n->elem_id, n->strain};
  memset(n->force, 0,
         (size_t)(n->msh->dim * n->msh->n_node) * sizeof *n->force);
  if (row->bit == EFFECT_BIT_FRICTION) {
    take_friction(n, s);
    return;
  }
  take_strains(n, row);
  eigen_force(&n->d, &x, n->force);
}

/* ---- changes ------------------------------------------------------------ */

/* Largest of a - b. */
static double distance(size_t n, const double *a, const double *b) {
  double most = 0.0;
  for (size_t i = 0; i < n; ++i) most = fmax(most, fabs(a[i] - b[i]));
  return most;
}

/* Of the nodes: largest normal and tangential force, sum of each direction of
 * all nodes. */
typedef struct force_sizes {
  double node[2], sum[3];
} force_sizes;

/* Of rc, or of rc - from. */
static force_sizes sizes_of(const contact_surface *c, const double *rc,
                            const double *from) {
  force_sizes f = {{0.0, 0.0}, {0.0, 0.0, 0.0}};
  for (int i = 0; i < c->n; ++i) {
    double side = 0.0;
    for (int a = 0; a < c->dim; ++a) {
      const int k = c->dim * i + a;
      const double value = rc[k] - (from != NULL ? from[k] : 0.0);
      f.sum[a] += value;
      if (a == 0) f.node[0] = fmax(f.node[0], fabs(value));
      if (a > 0) side = hypot(side, value);
    }
    f.node[1] = fmax(f.node[1], side);
  }
  return f;
}

/* The forces against those of the increment; of friction against its largest
 * so far. */
static double force_change(reduction *n, const state *s, const double *rc) {
  const force_sizes now = sizes_of(s->contacts.surface, s->contacts.rc, NULL);
  const force_sizes d = sizes_of(s->contacts.surface, rc, s->contacts.rc);
  double worst = reduction_part(d.node[0], now.node[0]);
  worst = fmax(worst, reduction_part(fabs(d.sum[0]), fabs(now.sum[0])));
  if (!(n->m->effects & EFFECT_FRICTION)) return worst;
  worst = fmax(worst, reduction_part(d.node[1], n->tangential));
  return fmax(worst, reduction_part(hypot(d.sum[1], d.sum[2]), n->total));
}

static void grow_scales(reduction *n, const state *s) {
  if (s->contacts.surface == NULL) return;
  const force_sizes now = sizes_of(s->contacts.surface, s->contacts.rc, NULL);
  n->tangential = fmax(n->tangential, now.node[1]);
  n->total = fmax(n->total, hypot(now.sum[1], now.sum[2]));
}

status reduction_again(reduction *n, const state *s, int k, double bound,
                       omitted *row) {
  OWNED double *rc = NULL;
  int solved = 0;
  const size_t dofs = (size_t)(n->msh->dim * n->msh->n_node);
  grow_scales(n, s);
  if (row->bit == EFFECT_BIT_NONLOCAL || bound == 0.0) return OK;
  if (!s->end_of_step && bound <= 2.0 * n->seen[k]) return OK;
  n->seen[k] = fmax(bound, n->seen[k]);
  if (s->contacts.surface != NULL)
    PASS_NEW(rc, s->contacts.surface->dim * s->contacts.surface->n);
  take_forces(n, s, row);
  PASS(s->again.solve(s->again.run, n->force, n->u, rc, &solved));
  double change = solved ? reduction_part(distance(dofs, n->u, s->body.u),
                                          largest_entry(dofs, s->body.u))
                         : HUGE_VAL;
  if (rc != NULL) change = fmax(change, force_change(n, s, rc));
  if (!(change <= row->change)) row->change = change;
  ++row->again;
  return OK;
}
