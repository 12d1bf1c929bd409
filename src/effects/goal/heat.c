/*
 * Thermal strains within the elements. An element has those of its mean
 * temperature, the body those of each point, d0 more: with E d0 the forces
 *
 *   dF v = integral of E d0 : e(v)
 *
 * are in no residual at the nodes, as those of boundary.c, the mean of a stress
 * is less by that of E d0, and the energy by that of sigma : d0.
 */
#include "effects/goal/parts.h"

typedef struct spot {
  double b[4];    /* barycentric */
  int pieces;     /* of an element */
  double *T0, *T; /* [n_elem] */
} spot;

/* d[3] = d0 at a point of element number k of those with strains; 0: none. */
static int strain_at(const run *r, int k, const spot *s, double *d) {
  const int e = r->strains.elem[k];
  const expansion *x = &run_material(r, e)->expand;
  const double *mean = r->now.thermal + (size_t)r->m->ns * k;
  if (!x->given || !isfinite(s->T[e]) || !isfinite(s->T0[e])) return 0;
  expansion_strain(x, s->T[e], s->T0[e], d);
  for (int c = 0; c < 3; ++c) d[c] -= mean[c];
  return 1;
}

/* Forces of a stress t at a point of an element, of this weight; r: its radius,
 * 0: not axisymmetric. */
static void add_force(const mesh *m, int e, const double *b, const double *t,
                      double weight, double r, double *dF) {
  const int dim = m->dim, *v = m->elem + (dim + 1) * e;
  double g[12];
  mesh_elem_gradients(m, e, g);
  for (int a = 0; a <= dim; ++a) {
    const double *h = g + dim * a;
    double *f = dF + dim * v[a];
    for (int c = 0; c < dim; ++c) f[c] += weight * t[c] * h[c];
    f[0] += weight * (t[3] * h[1] + (r > 0.0 ? t[2] * b[a] / r : 0.0));
    f[1] += weight * t[3] * h[0];
    if (dim == 2) continue;
    f[0] += weight * t[5] * h[2];
    f[1] += weight * t[4] * h[2];
    f[2] += weight * (t[4] * h[1] + t[5] * h[0]);
  }
}

/* Of all elements at one point; rest as below. */
static void add_spot(const run *r, const spot *s, double *dF, double *rest) {
  const mesh *m = r->msh;
  const domain *d = &r->body.d;
  const int n = m->dim + 1;
  for (int k = 0; k < r->strains.eigen.n; ++k) {
    const int e = r->strains.elem[k];
    const kinematics kin = d->kin[d->section_id[e]];
    double strain[6] = {0.0}, t[6], radius = 0.0;
    double weight = mesh_elem_measure(m, e) / n / s->pieces;
    if (!strain_at(r, k, s, strain)) continue;
    for (int a = 0; a < n && kin == AXISYMMETRIC; ++a)
      radius += s->b[a] * m->x[2 * m->elem[n * e + a]];
    weight *= kin == AXISYMMETRIC ? 2.0 * M_PI * radius
                                  : d->thickness[d->section_id[e]];
    element_stress(d, e, strain, t);
    add_force(m, e, s->b, t, weight, radius, dF);
    for (int c = 0; c < 3; ++c) rest[3 * (size_t)e + c] += weight * strain[c];
  }
}

static int is_formula(const quantity *q) {
  return (quantity_variables(q) & 7u) != 0;
}

/* 1: temperatures are given by formulas of the place. */
static int varies(const run *r) {
  int any = 0;
  for (EACH(const initial, c, r->m->initial.lines, r->m->n.initial))
    any |= c->type == INITIAL_TEMPERATURE && is_formula(&c->value);
  for (const step *s = r->m->steps; s <= r->step; ++s)
    for (EACH(const load, l, s->loads.item, s->loads.n))
      any |= l->kind == LOAD_TEMPERATURE && is_formula(&l->value);
  return any;
}

status goal_add_thermal(const run *r, double *dF, double **rest) {
  OWNED double *T0 = NULL, *T = NULL;
  if (r->now.thermal == NULL || r->now.temperature == NULL) return OK;
  PASS_NEW(*rest, (size_t)3 * r->msh->n_elem);
  PASS_NEW_REALS(r->msh->n_elem, &T0, &T);
  const int n = r->msh->dim + 1, pieces = varies(r) ? GOAL_PIECES : 1;
  for (int k = 0; k < n * pieces; ++k) {
    spot s = {.pieces = pieces, .T0 = T0, .T = T};
    /* The temperatures at a point of all elements. */
    goal_rule_point(n, k, pieces, s.b);
    load_temperature_initial_at(r->m, r->msh, s.b, s.T0);
    PASS(load_temperature_at(r->m, r->msh, r->step, r->now.t, s.b, s.T0, s.T));
    add_spot(r, &s, dF, *rest);
  }
  return OK;
}

double goal_thermal_rest(const run *r, int elem_id, const double *rest, int c) {
  double d0[6] = {0.0}, t[6];
  COPY(d0, rest + 3 * (size_t)elem_id, 3);
  element_stress(&r->body.d, elem_id, d0, t);
  return t[c];
}
