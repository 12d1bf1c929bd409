/*
 * Strains that carry no stress, e0 = e_th of the temperature + e^i of the
 * inelastic laws, sigma = E (e - e0): stored for elements that can have it.
 */
#include "base/base.h"
#include "model/facts.h"
#include "run/visco.h"

static size_t at(const run *r, int k) { return (size_t)r->m->ns * k; }

size_t strains_kept(const run *r) {
  /* The first work is from zero. */
  int all = r->strains.temperature0 != NULL || facts_starts_strained(r->m);
  return all ? at(r, r->strains.eigen.n) : 0;
}

/* The only strain without stress is e^i, which the points have. */
static int is_flow(const run *r) {
  return r->strains.visco != NULL && strains_kept(r) == 0;
}

static status new_strains(const run *r, equilibrium *e) {
  size_t n = strains_kept(r);
  if (r->strains.temperature0 != NULL) {
    PASS_NEW(e->temperature, r->msh->n_elem);
    COPY(e->temperature, r->strains.temperature0, r->msh->n_elem);
  }
  if (n == 0) return OK;
  PASS_NEW_REALS(n, &e->thermal, &e->e0, &e->sigma);
  if (r->body.moduli.n_own > 0) PASS_NEW(e->elastic, n);
  return OK;
}

status strains_new(run *r) {
  PASS(moduli_new(r->m, r->msh, r->strains.temperature0, &r->body.moduli));
  moduli_domain(&r->body.moduli, r->m, &r->body.d);
  if (!(r->m->effects & (EFFECT_THERMAL | EFFECT_INELASTIC))) return OK;
  int n = 0;
  for (int e = 0; e < r->msh->n_elem; ++e)
    r->strains.eigen.n += effects_strain(r, e);
  PASS_NEW(r->strains.elem, r->strains.eigen.n);
  for (int e = 0; e < r->msh->n_elem; ++e)
    if (effects_strain(r, e)) r->strains.elem[n++] = e;
  r->strains.eigen.elem_id = r->strains.elem;
  PASS_NEW(r->strains.load, r->n_dof);
  PASS(new_strains(r, &r->old));
  PASS(new_strains(r, &r->now));
  if (r->m->effects & EFFECT_INELASTIC) PASS(visco_new(r));
  r->body.d.eigen = &r->strains.eigen;
  return OK;
}

void strains_collect(run *r) {
  equilibrium *now = &r->now;
  if (r->strains.eigen.n == 0) return;
  if (is_flow(r)) {
    r->strains.eigen.e0 = r->strains.visco->now.ei;
    return;
  }
  COPY(now->e0, now->thermal, (size_t)r->m->ns * r->strains.eigen.n);
  if (r->strains.visco != NULL) visco_add_strains(r, now->e0);
  r->strains.eigen.e0 = now->e0;
}

const double *strains_load(run *r) {
  if (r->strains.eigen.n == 0) return r->now.F;
  COPY(r->strains.load, r->now.F, r->n_dof);
  eigen_force(&r->body.d, &r->strains.eigen, r->strains.load);
  return r->strains.load;
}

/* Item k of r->strains.eigen: energy per volume set free by the change of the
 * moduli, exact as the trapezoidal works are: 1/2 e_old (E_old - E) e. */
static double softened(const run *r, int k) {
  const equilibrium *a = &r->old, *b = &r->now;
  if (a->elastic == NULL) return 0.0;
  return 0.5 * (dot(r->m->ns, a->sigma + at(r, k), b->elastic + at(r, k)) -
                dot(r->m->ns, b->sigma + at(r, k), a->elastic + at(r, k)));
}

/* Stresses of the items and their strains without stress, thermal ones apart
 * (NULL: none), at both ends of the increment. */
typedef struct item_ends {
  double *sigma[2], *e0[2], *thermal[2];
} item_ends;

static item_ends ends_of(const run *r) {
  const equilibrium *a = &r->old, *b = &r->now;
  const visco *v = r->strains.visco;
  if (is_flow(r))
    return (item_ends){
        {v->old.sigma, v->now.sigma}, {v->old.ei, v->now.ei}, {NULL, NULL}};
  return (item_ends){
      {a->sigma, b->sigma}, {a->e0, b->e0}, {a->thermal, b->thermal}};
}

/* Item k of r->strains.eigen. */
static void item_work(const run *r, const item_ends *x, int k, energies *e,
                      double *held) {
  double w = element_weight(&r->body.d, r->strains.elem[k]);
  double thermal = 0.0, all = 0.0, stress[6];
  for (size_t i = at(r, k); i < at(r, k + 1); ++i) {
    double sigma = 0.5 * (x->sigma[0][i] + x->sigma[1][i]);
    if (x->thermal[0] != NULL)
      thermal += sigma * (x->thermal[1][i] - x->thermal[0][i]);
    all += sigma * (x->e0[1][i] - x->e0[0][i]);
  }
  e->thermal += w * (thermal + softened(r, k));
  e->inelastic += w * (all - thermal);
  tensor_product(r->m->ns, run_elasticity(r, r->strains.elem[k]),
                 x->e0[1] + at(r, k), stress);
  *held += 0.5 * w * dot(r->m->ns, x->e0[1] + at(r, k), stress);
}

/* Items from, ..., to - 1, which hold whole clusters. */
static void items_work(run *r, int from, int to, energies *e, double *held) {
  const item_ends ends = ends_of(r);
  double *elastic = r->now.elastic;
  const eigenstrain x = {to - from, r->strains.elem + from,
                         ends.e0[1] + at(r, from)};
  eigen_stress(&r->body.d, &x, r->now.u,
               elastic == NULL ? NULL : elastic + at(r, from),
               ends.sigma[1] + at(r, from));
  for (int k = from; k < to; ++k) item_work(r, &ends, k, e, held);
}

void strains_start(run *r, equilibrium *e) {
  const size_t bytes = strains_kept(r) * sizeof *e->e0;
  if (bytes == 0) return;
  if (e != &r->now) {
    memcpy(e->e0, r->now.e0, bytes);
    memcpy(e->thermal, r->now.thermal, bytes);
  }
  const eigenstrain x = {r->strains.eigen.n, r->strains.elem, e->e0};
  eigen_stress(&r->body.d, &x, e->u, e->elastic, e->sigma);
}

void strains_work(run *r, energies *e) {
  const visco *v = r->strains.visco;
  const int known = v != NULL && v->sums.known;
  double held = 0.0;
  if (r->strains.eigen.n == 0) return;
  TIMED(STAGE_ENERGY);
  if (known) {
    e->thermal += v->sums.thermal;
    e->inelastic += v->sums.inelastic;
    held = v->sums.held;
    /* The items that are no points whose sums are known. */
    int from = 0;
    for (int k = 0; k < v->x.n && v->x.n < r->strains.eigen.n; ++k) {
      if (v->place[k] > from) items_work(r, from, v->place[k], e, &held);
      from = v->place[k] + 1;
    }
    if (v->x.n < r->strains.eigen.n && from < r->strains.eigen.n)
      items_work(r, from, r->strains.eigen.n, e, &held);
  } else {
    items_work(r, 0, r->strains.eigen.n, e, &held);
  }
  e->largest = fmax(e->largest, held);
}

double strains_energy(const run *r) {
  const visco *v = r->strains.visco;
  if (v == NULL || !v->sums.known)
    return domain_strain_energy(&r->body.d, r->now.u);
  return v->sums.strain +
         domain_energy_without(&r->body.d, v->x.n, v->elem, r->now.u);
}

double strains_lost(const run *r) {
  return RUN_CARRIED * largest_entry(r->n_dof, r->now.u);
}

double strains_rounding(const run *r, double u) {
  return r->msh->n_node * condensed_stiffest(r->c) * u * u;
}
