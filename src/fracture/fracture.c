/*
 * Points and factors: what the caller sees.
 */
#include "fracture/fracture.h"

#include "fracture/parts.h"

#include "base/memory.h"

#include <math.h>

static status prepare(fracture *f) {
  const mesh *m = f->body.mesh;
  f->n = f->body.crack->front_start[f->body.crack->n_front];
  PASS_NEW(f->point, f->n);
  PASS_NEW(f->elem_seen, m->n_elem);
  PASS_NEW(f->node_seen, m->n_node);
  PASS_NEW(f->elem_list, m->n_elem);
  PASS_NEW(f->node_list, m->n_node);
  PASS(mesh_node_elements(m, &f->start, &f->elem));
  return points_find(f);
}

status fracture_new(const fracture_body *body, fracture **out) {
  status st = OK;
  fracture *f = NULL;
  NEW(f, 1);
  f->body = *body;
  TRY(prepare(f));
done:
  if (st != OK) {
    fracture_free(f);
    f = NULL;
  }
  *out = f;
  return st;
}

void fracture_free(fracture *f) {
  if (f == NULL) return;
  RELEASE(f->point, f->start, f->elem, f->elem_seen, f->node_seen, f->elem_list,
          f->node_list, f);
}

int fracture_count(const fracture *f) { return f->n; }

const fracture_point *fracture_points(const fracture *f) { return f->point; }

/* Middle and half of the range over the domains. */
static void compare(const integrals *of, int part, double factor, double *value,
                    double *scatter) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (int k = 0; k < DOMAINS; ++k) {
    const double here = factor * of->I[k][part] / of->length[k];
    low = fmin(low, here);
    high = fmax(high, here);
  }
  *value = (low + high) / 2;
  *scatter = (high - low) / 2;
}

/* E' = 8 G / (kappa + 1), in plane stress and plane strain. */
static void find_point(fracture *f, const fracture_state *s,
                       const fracture_point *p, fracture_factors *out) {
  elasticity x = {0};
  integrals sum;
  if (p->section >= 0 && f->body.material[p->section].E > 0) {
    const fracture_material *of = &f->body.material[p->section];
    x.G = of->E / (2 * (1 + of->nu));
    x.kappa = of->plane_stress ? (3 - of->nu) / (1 + of->nu) : 3 - 4 * of->nu;
  }
  integrals_find(f, s, p, &x, &sum);
  compare(&sum, MODES, 1, &out->J, &out->J_scatter);
  for (int mode = 0; mode < MODES && x.G > 0; ++mode)
    compare(&sum, mode, mode < 2 ? 4 * x.G / (x.kappa + 1) : x.G, &out->K[mode],
            &out->K_scatter[mode]);
}

void fracture_find(fracture *f, const fracture_state *s,
                   fracture_factors *out) {
  for (int i = 0; i < f->n; ++i) {
    out[i] = (fracture_factors){{NAN, NAN, NAN}, {NAN, NAN, NAN}, NAN, NAN};
    if (f->point[i].radius > 0) find_point(f, s, &f->point[i], &out[i]);
  }
}
