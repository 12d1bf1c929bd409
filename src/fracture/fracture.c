/* Points and factors: what the caller sees. */
#include "fracture/fracture.h"

#include "base/base.h"
#include "fracture/parts.h"

status fracture_new(const fracture_body *body, fracture **out) {
  MAKES(fracture, f, out);
  f->body = *body;
  const mesh *m = f->body.mesh;
  for (EACH(const mesh_crack, c, body->crack, body->n_crack))
    f->n += c->front_start[c->n_front];
  PASS_NEW_ALL(OF(f->point, f->n), OF(f->elem_seen, m->n_elem),
               OF(f->node_seen, m->n_node), OF(f->elem_list, m->n_elem),
               OF(f->node_list, m->n_node));
  PASS(mesh_node_elements(m, &f->start, &f->elem));
  return points_find(f);
}

int fracture_count(const fracture *f) { return f->n; }

const fracture_point *fracture_points(const fracture *f) { return f->point; }

/* Middle and half of the range over the domains; NAN: one has no number. */
static void compare(const integrals *of, int part, double factor, double *value,
                    double *scatter) {
  double low = HUGE_VAL, high = -HUGE_VAL, sum = 0;
  for (int k = 0; k < DOMAINS; ++k) {
    const double here = factor * of->I[k][part] / of->length[k];
    low = fmin(low, here);
    high = fmax(high, here);
    sum += here;
  }
  *value = isnan(sum) ? NAN : (low + high) / 2;
  *scatter = isnan(sum) ? NAN : (high - low) / 2;
}

static elasticity elasticity_at(const fracture *f, const fracture_point *p) {
  elasticity x = {0};
  if (p->section >= 0 && f->body.material[p->section].E > 0) {
    const fracture_material *of = &f->body.material[p->section];
    x.G = of->E / (2 * (1 + of->nu));
    x.kappa = of->plane_stress ? (3 - of->nu) / (1 + of->nu) : 3 - 4 * of->nu;
  }
  return x;
}

/* K over the integral: half of E' = 8 G / (kappa + 1), in plane stress and
 * plane strain. */
static double factor_of(const elasticity *x, int mode) {
  return mode < 2 ? 4 * x->G / (x->kappa + 1) : x->G;
}

static void find_point(fracture *f, const fracture_state *s,
                       const fracture_point *p, fracture_factors *out) {
  const elasticity x = elasticity_at(f, p);
  integrals sum;
  integrals_find(f, s, p, &x, &sum);
  out->pointed = sum.pointed;
  compare(&sum, MODES, 1, &out->J, &out->J_scatter);
  for (int mode = 0; mode < MODES && x.G > 0; ++mode)
    compare(&sum, mode, factor_of(&x, mode), &out->K[mode],
            &out->K_scatter[mode]);
}

void fracture_find(fracture *f, const fracture_state *s,
                   fracture_factors *out) {
  for (int i = 0; i < f->n; ++i) {
    out[i] = (fracture_factors){{NAN, NAN, NAN}, {NAN, NAN, NAN}, NAN, NAN, 0};
    if (f->point[i].radius > 0) find_point(f, s, &f->point[i], &out[i]);
  }
}

/* Half of the domain that gives the least, half of that with the most. */
static void share_domains(const integrals *of, int mode, double factor,
                          double *part) {
  int low = 0, high = 0;
  for (int k = 1; k < DOMAINS; ++k) {
    const double here = of->I[k][mode] / of->length[k];
    if (here < of->I[low][mode] / of->length[low]) low = k;
    if (here > of->I[high][mode] / of->length[high]) high = k;
  }
  for (int k = 0; k < DOMAINS; ++k)
    part[k] = factor / of->length[k] * ((k == low) + (k == high)) / 2;
}

status fracture_derive(fracture *f, const fracture_state *s, int point,
                       int mode, fracture_linear *out) {
  const mesh *m = f->body.mesh;
  const size_t n_dof = (size_t)m->dim * m->n_node;
  const fracture_point *p = &f->point[point];
  const elasticity x = elasticity_at(f, p);
  integrals sum;
  double part[DOMAINS];
  *out = (fracture_linear){0};
  integrals_find(f, s, p, &x, &sum);
  share_domains(&sum, mode, factor_of(&x, mode), part);
  PASS_NEW_REALS(n_dof, &out->by_u, &out->by_traction);
  return integrals_derive(f, s, p, &x, mode, part, out);
}

void fracture_linear_free(fracture_linear *l) {
  RELEASE(l->by_u, l->by_traction, l->elem, l->flux);
  *l = (fracture_linear){0};
}
