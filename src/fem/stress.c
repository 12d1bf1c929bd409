/*
 * Strains, stresses, internal forces and strain energy of a displacement.
 */
#include "base/timer.h"
#include "fem/element.h"

#include <string.h>

/* Strain of one element: e[ns]. */
static void strain_at(const domain *d, int elem_id, const double *u,
                      const element_shape *s, double *e) {
  const int dim = d->mesh->dim;
  const int *v = d->mesh->elem + (size_t)(dim + 1) * (size_t)elem_id;
  memset(e, 0, (size_t)d->ns * sizeof *e);
  for (int a = 0; a <= dim; ++a) {
    const double *g = s->grad + dim * a;
    const double *ua = u + (size_t)dim * (size_t)v[a];
    e[0] += g[0] * ua[0];
    e[1] += g[1] * ua[1];
    e[3] += g[1] * ua[0] + g[0] * ua[1];
    if (dim == 2) {
      e[2] += s->hoop * ua[0];
    } else {
      e[2] += g[2] * ua[2];
      e[4] += g[2] * ua[1] + g[1] * ua[2];
      e[5] += g[2] * ua[0] + g[0] * ua[2];
    }
  }
}

static void stress_at(const domain *d, int elem_id, const double *e,
                      double *sigma) {
  const int ns = d->ns;
  const double *E = d->E + (size_t)(ns * ns) * (size_t)d->section_id[elem_id];
  for (int i = 0; i < ns; ++i) {
    sigma[i] = 0;
    for (int k = 0; k < ns; ++k) sigma[i] += E[ns * k + i] * e[k];
  }
}

void domain_stress(const domain *d, const double *u, double *e, double *sigma) {
  const size_t ns = (size_t)d->ns;
  timer_enter(STAGE_STRESS);
  for (int k = 0; k < d->mesh->n_elem; ++k) {
    const int section = d->section_id[k];
    element_shape s;
    double strain[6];
    element_shape_at(d, k, &s);
    strain_at(d, k, u, &s, strain);
    if (sigma != NULL) stress_at(d, k, strain, sigma + ns * (size_t)k);
    if (d->kin[section] == PLANE_STRESS && d->C != NULL)
      elastic_zz_strain(d->C + (size_t)36 * (size_t)section, strain);
    if (e != NULL) memcpy(e + ns * (size_t)k, strain, ns * sizeof *e);
  }
  timer_leave(STAGE_STRESS);
}

void domain_internal_force(const domain *d, const double *sigma, double *F) {
  const int dim = d->mesh->dim, ns = d->ns;
  timer_enter(STAGE_STRESS);
  memset(F, 0, (size_t)dim * (size_t)d->mesh->n_node * sizeof *F);
  for (int k = 0; k < d->mesh->n_elem; ++k) {
    const int *v = d->mesh->elem + (size_t)(dim + 1) * (size_t)k;
    const double *t = sigma + (size_t)ns * (size_t)k;
    element_shape s;
    element_shape_at(d, k, &s);
    for (int a = 0; a <= dim; ++a) {
      const double *g = s.grad + dim * a, w = s.weight;
      double *f = F + (size_t)dim * (size_t)v[a];
      if (dim == 2) {
        f[0] += w * (g[0] * t[0] + s.hoop * t[2] + g[1] * t[3]);
        f[1] += w * (g[1] * t[1] + g[0] * t[3]);
      } else {
        f[0] += w * (g[0] * t[0] + g[1] * t[3] + g[2] * t[5]);
        f[1] += w * (g[1] * t[1] + g[0] * t[3] + g[2] * t[4]);
        f[2] += w * (g[2] * t[2] + g[1] * t[4] + g[0] * t[5]);
      }
    }
  }
  timer_leave(STAGE_STRESS);
}

double domain_strain_energy(const domain *d, const double *u) {
  double sum = 0;
  timer_enter(STAGE_ENERGY);
  for (int k = 0; k < d->mesh->n_elem; ++k) {
    element_shape s;
    double e[6], t[6], density = 0;
    element_shape_at(d, k, &s);
    strain_at(d, k, u, &s, e);
    stress_at(d, k, e, t);
    for (int i = 0; i < d->ns; ++i) density += e[i] * t[i];
    sum += 0.5 * s.weight * density;
  }
  timer_leave(STAGE_ENERGY);
  return sum;
}
