/*
 * Strains that carry no stress: of temperature, e_th (sigma = E (e - e_th)).
 * Kept for the elements that have any, and for them alone.
 */
#include "history/run.h"

#include "base/memory.h"
#include "base/timer.h"

#include <string.h>

static const material *material_of(const run *r, int elem_id) {
  const model *m = r->m;
  return &m->materials[m->sections[m->elem_section[elem_id]].material_id];
}

static int expands(const run *r, int elem_id) {
  return material_of(r, elem_id)->expand.given;
}

static status new_strains(const run *r, equilibrium *e) {
  status st = OK;
  size_t n = (size_t)r->m->ns * (size_t)r->eigen.n;
  NEW(e->temperature, r->msh->n_elem);
  memcpy(e->temperature, r->temperature0,
         (size_t)r->msh->n_elem * sizeof *e->temperature);
  NEW(e->thermal, n);
  NEW(e->e0, n);
  NEW(e->sigma, n);
done:
  return st;
}

status thermal_new(run *r) {
  status st = OK;
  int n = 0;
  timer_enter(STAGE_THERMAL);
  for (int e = 0; e < r->msh->n_elem; ++e) r->eigen.n += expands(r, e);
  NEW(r->eigen_elem, r->eigen.n);
  for (int e = 0; e < r->msh->n_elem; ++e)
    if (expands(r, e)) r->eigen_elem[n++] = e;
  r->eigen.elem_id = r->eigen_elem;
  NEW(r->temperature0, r->msh->n_elem);
  NEW(r->eigen_load, r->n_dof);
  TRY(load_temperature_initial(r->m, r->msh, r->temperature0));
  TRY(new_strains(r, &r->old));
  TRY(new_strains(r, &r->now));
  r->d.eigen = &r->eigen;
done:
  timer_leave(STAGE_THERMAL);
  return st;
}

void thermal_free(run *r) {
  memory_free(r->eigen_elem);
  memory_free(r->temperature0);
  memory_free(r->eigen_load);
}

status thermal_update(run *r) {
  status st = OK;
  equilibrium *now = &r->now;
  size_t ns = (size_t)r->m->ns;
  if (r->eigen.n == 0) return OK;
  timer_enter(STAGE_THERMAL);
  TRY(load_temperature(r->m, r->msh, r->step, now->t, r->temperature0,
                       now->temperature));
  for (int k = 0; k < r->eigen.n; ++k) {
    int e = r->eigen_elem[k];
    expansion_strain(&material_of(r, e)->expand, now->temperature[e],
                     r->temperature0[e], now->thermal + ns * (size_t)k);
  }
  memcpy(now->e0, now->thermal, ns * (size_t)r->eigen.n * sizeof *now->e0);
  r->eigen.e0 = now->e0;
done:
  timer_leave(STAGE_THERMAL);
  return st;
}

const double *thermal_load(run *r) {
  if (r->eigen.n == 0) return r->now.F;
  timer_enter(STAGE_THERMAL);
  memcpy(r->eigen_load, r->now.F, r->n_dof * sizeof *r->eigen_load);
  eigen_force(&r->d, &r->eigen, r->eigen_load);
  timer_leave(STAGE_THERMAL);
  return r->eigen_load;
}

double thermal_work(run *r) {
  const equilibrium *a = &r->old, *b = &r->now;
  size_t ns = (size_t)r->m->ns;
  double sum = 0.0;
  if (r->eigen.n == 0) return 0.0;
  timer_enter(STAGE_THERMAL);
  eigen_stress(&r->d, &r->eigen, b->u, b->sigma);
  for (int k = 0; k < r->eigen.n; ++k) {
    double w = element_weight(&r->d, r->eigen_elem[k]), density = 0.0;
    for (size_t i = ns * (size_t)k; i < ns * (size_t)(k + 1); ++i)
      density +=
          0.5 * (a->sigma[i] + b->sigma[i]) * (b->thermal[i] - a->thermal[i]);
    sum += w * density;
  }
  timer_leave(STAGE_THERMAL);
  return sum;
}
