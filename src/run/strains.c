/*
 * Strains that carry no stress, e0 = e_th of the temperature + e^i of the
 * inelastic laws, sigma = E (e - e0): kept for the elements that can have any,
 * and for them alone.
 */
#include "base/memory.h"
#include "base/timer.h"
#include "run/run.h"

#include <math.h>
#include <string.h>

static size_t at(const run *r, int k) { return (size_t)r->m->ns * (size_t)k; }

const material *run_material(const run *r, int elem_id) {
  const model *m = r->m;
  return &m->materials[m->sections[m->elem_section[elem_id]].material_id];
}

const double *run_elasticity(const run *r, int elem_id) {
  return r->moduli.E +
         at(r, r->m->ns * moduli_entry(&r->moduli, r->m, elem_id));
}

static int flows(const run *r, int elem_id) {
  return (r->m->effects & EFFECT_INELASTIC) &&
         run_material(r, elem_id)->law.ops != NULL;
}

static int expands(const run *r, int elem_id) {
  return (r->m->effects & EFFECT_THERMAL) &&
         run_material(r, elem_id)->expand.given;
}

static int has_strains(const run *r, int elem_id) {
  return expands(r, elem_id) || flows(r, elem_id) ||
         moduli_follows(r->m, elem_id);
}

static status new_strains(const run *r, equilibrium *e) {
  status st = OK;
  size_t n = (size_t)r->m->ns * (size_t)r->eigen.n;
  if (r->temperature0 != NULL) {
    NEW(e->temperature, r->msh->n_elem);
    memcpy(e->temperature, r->temperature0,
           (size_t)r->msh->n_elem * sizeof *e->temperature);
  }
  NEW(e->thermal, n);
  NEW(e->e0, n);
  NEW(e->sigma, n);
  if (r->moduli.n_own > 0) NEW(e->elastic, n);
done:
  return st;
}

static status list_elements(run *r) {
  status st = OK;
  int n = 0;
  for (int e = 0; e < r->msh->n_elem; ++e) r->eigen.n += has_strains(r, e);
  NEW(r->eigen_elem, r->eigen.n);
  for (int e = 0; e < r->msh->n_elem; ++e)
    if (has_strains(r, e)) r->eigen_elem[n++] = e;
  r->eigen.elem_id = r->eigen_elem;
  NEW(r->eigen_load, r->n_dof);
done:
  return st;
}

status strains_new(run *r) {
  status st = OK;
  if (r->m->effects & EFFECT_THERMAL) {
    NEW(r->temperature0, r->msh->n_elem);
    TRY(load_temperature_initial(r->m, r->msh, r->temperature0));
  }
  TRY(moduli_new(r->m, r->msh, r->temperature0, &r->moduli));
  moduli_domain(&r->moduli, r->m, &r->d);
  if (!(r->m->effects & (EFFECT_THERMAL | EFFECT_INELASTIC))) goto done;
  TRY(list_elements(r));
  TRY(new_strains(r, &r->old));
  TRY(new_strains(r, &r->now));
  if (r->m->effects & EFFECT_INELASTIC) TRY(visco_new(r));
  r->d.eigen = &r->eigen;
done:
  return st;
}

void strains_free(run *r) {
  visco_free(r->visco);
  memory_free(r->eigen_elem);
  memory_free(r->temperature0);
  memory_free(r->eigen_load);
}

/* Thermal strains are averaged as the strains are that they are taken off. */
static void average_thermal(run *r) {
  cluster_set *c = r->d.cluster;
  double *thermal = r->now.thermal;
  cluster_begin(c, CLUSTER_STRAIN);
  for (int k = 0; k < r->eigen.n; ++k)
    cluster_add(c, CLUSTER_STRAIN, r->eigen_elem[k], thermal + at(r, k));
  for (int k = 0; k < r->eigen.n; ++k)
    cluster_smooth(c, CLUSTER_STRAIN, r->eigen_elem[k], thermal + at(r, k));
}

/* Temperatures, moduli and thermal strains of r->now. */
static status heat(run *r) {
  status st = OK;
  equilibrium *now = &r->now;
  int changed = 0;
  size_t ns = (size_t)r->m->ns;
  timer_enter(STAGE_THERMAL);
  TRY(load_temperature(r->m, r->msh, r->step, now->t, r->temperature0,
                       now->temperature));
  TRY(moduli_heat(&r->moduli, r->m, now->temperature, &changed));
  if (changed) {
    visco_forget(r);
    r->stale = 1;
    if (r->c != r->elastic.c) r->c = NULL;
  }
  for (int k = 0; k < r->eigen.n; ++k) {
    int e = r->eigen_elem[k];
    if (expands(r, e))
      expansion_strain(&run_material(r, e)->expand, now->temperature[e],
                       r->temperature0[e], now->thermal + ns * (size_t)k);
  }
  average_thermal(r);
done:
  timer_leave(STAGE_THERMAL);
  return st;
}

void strains_collect(run *r) {
  equilibrium *now = &r->now;
  memcpy(now->e0, now->thermal,
         (size_t)r->m->ns * (size_t)r->eigen.n * sizeof *now->e0);
  if (r->visco != NULL) visco_add_strains(r, now->e0);
  r->eigen.e0 = now->e0;
}

status strains_update(run *r) {
  status st = OK;
  if (r->eigen.n == 0) return OK;
  if (r->temperature0 != NULL) TRY(heat(r));
  strains_collect(r);
done:
  return st;
}

const double *strains_load(run *r) {
  if (r->eigen.n == 0) return r->now.F;
  memcpy(r->eigen_load, r->now.F, r->n_dof * sizeof *r->eigen_load);
  eigen_force(&r->d, &r->eigen, r->eigen_load);
  return r->eigen_load;
}

/* Item k of r->eigen: strain energy per volume that the change of the moduli
 * has set free, exact as the trapezoidal works are: 1/2 e_old (E_old - E) e. */
static double softened(const run *r, int k) {
  const equilibrium *a = &r->old, *b = &r->now;
  if (a->elastic == NULL) return 0.0;
  return 0.5 *
         (tensor_dot(r->m->ns, a->sigma + at(r, k), b->elastic + at(r, k)) -
          tensor_dot(r->m->ns, b->sigma + at(r, k), a->elastic + at(r, k)));
}

void strains_work(run *r, energies *e) {
  const equilibrium *a = &r->old, *b = &r->now;
  size_t ns = (size_t)r->m->ns;
  double scale = 0.0;
  if (r->eigen.n == 0) return;
  timer_enter(STAGE_ENERGY);
  eigen_stress(&r->d, &r->eigen, b->u, b->elastic, b->sigma);
  for (int k = 0; k < r->eigen.n; ++k) {
    double w = element_weight(&r->d, r->eigen_elem[k]);
    double thermal = 0.0, all = 0.0, held[6];
    for (size_t i = ns * (size_t)k; i < ns * (size_t)(k + 1); ++i) {
      double sigma = 0.5 * (a->sigma[i] + b->sigma[i]);
      thermal += sigma * (b->thermal[i] - a->thermal[i]);
      all += sigma * (b->e0[i] - a->e0[i]);
    }
    e->thermal += w * (thermal + softened(r, k));
    e->inelastic += w * (all - thermal);
    tensor_product(r->m->ns, run_elasticity(r, r->eigen_elem[k]),
                   b->e0 + at(r, k), held);
    scale += 0.5 * w * tensor_dot(r->m->ns, b->e0 + at(r, k), held);
  }
  e->largest = fmax(e->largest, scale);
  timer_leave(STAGE_ENERGY);
}
