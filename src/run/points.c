/*
 * The elements whose law flows, as points of src/material/scheme: their laws,
 * initial state, and their state at an equilibrium of the body.
 */
#include "base/base.h"
#include "material/voigt.h"
#include "model/check/check.h"
#include "run/visco.h"

/* One kind for each section whose material has a law. */
static status new_kinds(const run *r, flow *x, int *kind_of) {
  const model *m = r->m;
  x->ns = m->ns;
  PASS_NEW(x->kind, m->n.section);
  for (int i = 0; i < m->n.section; ++i) {
    const material *mat = &m->materials[m->sections[i].material_id];
    law_elastic elastic;
    kind_of[i] = -1;
    if (mat->law.ops == NULL) continue;
    PASS(law_elastic_read(&mat->elastic, 0.0, (kinematics)m->sections[i].kin,
                          &elastic));
    kind_of[i] = x->n_kind++;
    PASS(flow_new_kind(&x->kind[kind_of[i]], &mat->law, &elastic));
  }
  return OK;
}

static status new_points(run *r, visco *v, const int *kind_of) {
  int n = 0;
  OWNED_NEW(int, kind_id, r->strains.eigen.n);
  PASS_NEW(v->place, r->strains.eigen.n);
  PASS_NEW(v->elem, r->strains.eigen.n);
  for (int k = 0; k < r->strains.eigen.n; ++k) {
    int kind = kind_of[r->m->elem_section[r->strains.elem[k]]];
    if (kind < 0 || !model_flows(r->m, r->strains.elem[k])) continue;
    v->place[n] = k;
    v->elem[n] = r->strains.elem[k];
    kind_id[n++] = kind;
  }
  PASS(flow_new_points(&v->x, n, kind_id));
  for (int k = 0; k < n; ++k)
    v->x.weight[k] = element_weight(&r->body.d, v->elem[k]);
  return OK;
}

/* One line of *INITIAL CONDITIONS into both states. */
static status take_initial(const run *r, visco *v, const initial *c) {
  const mesh_group *g = &r->msh->group[c->group_id];
  size_t ns = r->m->ns, part = c->component;
  for (int i = 0; i < g->n_item; ++i) {
    double value;
    const int point = number_find(g->item_id[i], v->elem, v->x.n);
    const size_t k = point;
    if (point < 0) continue;
    PASS(load_initial(r->m, r->msh, c, v->elem[k], &value));
    if (c->type == INITIAL_STRAIN)
      v->old.ei[ns * k + part] = v->now.ei[ns * k + part] = value;
    else
      v->old.alpha[v->x.alpha_at[k] + part] =
          v->now.alpha[v->x.alpha_at[k] + part] = value;
  }
  return OK;
}

status visco_new(run *r) {
  visco *v = NULL;
  TIMED(STAGE_INELASTIC);
  PASS_NEW(v, 1);
  r->strains.visco = v;
  OWNS(v);
  OWNED_NEW(int, kind_of, r->m->n.section);
  PASS(new_kinds(r, &v->x, kind_of));
  PASS(new_points(r, v, kind_of));
  PASS(flow_state_new(&v->x, &v->old));
  PASS(flow_state_new(&v->x, &v->now));
  for (EACH(const initial, c, r->m->initial.lines, r->m->n.initial))
    if (c->type == INITIAL_STRAIN || c->type == INITIAL_INTERNAL)
      PASS(take_initial(r, v, c));
  PASS(scheme_work_new(&v->work));
  PASS_NEW(v->stress, (size_t)r->m->ns * r->strains.eigen.n);
  return OK;
}

void visco_add_strains(const run *r, double *e0) {
  const visco *v = r->strains.visco;
  for (int k = 0; k < v->x.n; ++k)
    for (size_t i = 0; i < (size_t)r->m->ns; ++i)
      e0[visco_at(r, v->place[k]) + i] += v->now.ei[visco_at(r, k) + i];
}

void visco_temperatures(const run *r, const equilibrium *e, flow_state *s) {
  for (int k = 0; k < r->strains.visco->x.n && e->temperature != NULL; ++k)
    s->temperature[k] = e->temperature[r->strains.visco->elem[k]];
}

void visco_strains(run *r, const equilibrium *e, flow_state *s) {
  visco *v = r->strains.visco;
  const eigenstrain thermal = {r->strains.eigen.n, r->strains.elem, e->thermal};
  eigen_stress(&r->body.d, &thermal, e->u, v->stress, NULL);
  for (int k = 0; k < v->x.n; ++k) {
    const double *E = run_elasticity(r, v->elem[k]);
    double elastic[6];
    COPY(s->e + visco_at(r, k), v->stress + visco_at(r, v->place[k]),
         visco_at(r, 1));
    for (size_t i = 0; i < visco_at(r, 1); ++i)
      elastic[i] = s->e[visco_at(r, k) + i] - s->ei[visco_at(r, k) + i];
    tensor_product(r->m->ns, E, elastic, s->sigma + visco_at(r, k));
  }
}

int visco_next_part(const run *r, visco_part *p) {
  enum { PART = 64 };
  const visco *v = r->strains.visco;
  const int most = r->body.d.cluster == NULL ? PART : r->strains.eigen.n;
  p->item += p->n_item;
  p->point += p->n_point;
  p->n_item =
      r->strains.eigen.n - p->item < most ? r->strains.eigen.n - p->item : most;
  p->n_point = p->n_item;
  if (v->x.n == r->strains.eigen.n) return p->n_item > 0;
  const int end = p->item + p->n_item;
  p->n_point = 0;
  while (p->point + p->n_point < v->x.n &&
         v->place[p->point + p->n_point] < end)
    ++p->n_point;
  return p->n_item > 0;
}

/* Values of the items of a part, from[ns*n_item], to those of its points. */
static void to_points(const run *r, const visco_part *p, const double *from,
                      double *to) {
  const int *item = r->strains.visco->place;
  for (int k = p->point; k < p->point + p->n_point; ++k)
    COPY(to + visco_at(r, k), from + visco_at(r, item[k] - p->item),
         visco_at(r, 1));
}

void visco_part_strains(run *r, const visco_part *p) {
  visco *v = r->strains.visco;
  const int all = p->n_point == p->n_item;
  double *e = v->now.e + visco_at(r, p->point);
  const double *thermal = r->now.thermal;
  if (thermal != NULL) thermal += visco_at(r, p->item);
  const eigenstrain x = {p->n_item, r->strains.elem + p->item, thermal};
  eigen_stress(&r->body.d, &x, r->now.u, all ? e : v->stress, NULL);
  if (!all) to_points(r, p, v->stress, v->now.e);
}

/* Points that are not averaged, over their volume. */
typedef struct locking_sums {
  double stress, strain; /* square of the deviators, J Pa, m3 */
  double growth;         /* m3, square of the inelastic change of volume */
} locking_sums;

/* Square of the deviator of a stress, or of a strain whose shears are doubled:
 * shear 2 or 1/2. */
static inline double deviator_square(int ns, const double *t, double shear) {
  const double mean = (t[0] + t[1] + t[2]) / 3.0;
  double sum = 0.0;
  for (int i = 0; i < 3; ++i) sum += (t[i] - mean) * (t[i] - mean);
  for (int i = 3; i < ns; ++i) sum += shear * t[i] * t[i];
  return sum;
}

static int can_lock(const run *r, int k) {
  const visco *v = r->strains.visco;
  return !v->x.kind[v->x.kind_id[k]].elastic.plane_stress &&
         (r->body.d.cluster == NULL || r->body.d.cluster->of[v->elem[k]] < 0);
}

/* Of v->now. */
static inline locking_sums sum_locking(int ns, const run *r) {
  const visco *v = r->strains.visco;
  locking_sums sum = {0};
  for (int k = 0; k < v->x.n; ++k) {
    const size_t at = (size_t)ns * k;
    const double w = v->x.weight[k], *ei = v->now.ei + at;
    const double growth = ei[0] + ei[1] + ei[2];
    if (!can_lock(r, k)) continue;
    sum.stress += w * deviator_square(ns, v->now.sigma + at, 2.0);
    sum.strain += w * deviator_square(ns, v->now.e + at, 0.5);
    sum.growth += w * growth * growth;
  }
  return sum;
}

/* Mean of the bulk moduli, Pa. */
static double mean_bulk(const run *r) {
  const visco *v = r->strains.visco;
  double bulk = 0.0, volume = 0.0;
  for (int k = 0; k < v->x.n; ++k) {
    const double *E = run_elasticity(r, v->elem[k]), w = v->x.weight[k];
    if (!can_lock(r, k)) continue;
    for (int i = 0; i < 9; ++i) bulk += w * E[r->m->ns * (i / 3) + i % 3] / 9.0;
    volume += w;
  }
  return bulk / volume;
}

/*
 * Apparent Poisson ratio of the points that are not averaged: bulk modulus K,
 * shear modulus G from |s| = 2 G |dev e| over the volume, s and e those of now.
 * -1 if there are none, or if they flow in volume too.
 */
static double apparent_ratio(const run *r) {
  /* loops of a length that the compiler knows */
  const locking_sums sum =
      r->m->ns == 4 ? sum_locking(4, r) : sum_locking(6, r);
  if (sum.strain == 0.0 || sum.growth > 1e-6 * sum.strain) return -1.0;
  double K = mean_bulk(r), G = 0.5 * sqrt(sum.stress / sum.strain);
  return (3.0 * K - 2.0 * G) / (2.0 * (3.0 * K + G));
}

void visco_warn_locking(run *r) {
  enum { COARSE = 16, FINE = 64 };
  visco *v = r->strains.visco;
  if (v->reported.locking) return;
  double nu = apparent_ratio(r);
  if (nu <= 0.49) return;
  v->reported.locking = 1;
  message_add(r->m->log, P4016, &r->step->at,
              "step %d, time %g: creep has brought Poisson's ratio to an "
              "apparent %.4g; linear elements lock: expect displacements too "
              "small by some %.2g %% with %d elements across a wall, %.2g %% "
              "with %d, and more from here on",
              run_step_id(r) + 1, v->now.t, nu,
              100.0 * model_locking_error(nu, COARSE), COARSE,
              100.0 * model_locking_error(nu, FINE), FINE);
}

void visco_warn_stuck(run *r) {
  visco *v = r->strains.visco;
  if (v == NULL || v->result.stuck == 0 || v->reported.stuck) return;
  const int e = v->elem[v->result.stuck - 1];
  const material *mat = run_material(r, e);
  v->reported.stuck = 1;
  message_add(r->m->log, P4017, &r->step->at,
              "step %d, time %g: law %s of material %s finds no state of "
              "element %zu (group %s) at the end of an increment of %g: its "
              "rates grow too fast with the stress; give a smaller dt_min, a "
              "smaller exponent or a larger K; the increment is not settled",
              run_step_id(r) + 1, r->now.t, mat->law.ops->name, mat->name,
              r->msh->elem_no[e], r->m->sections[r->m->elem_section[e]].elset,
              r->now.t - r->old.t);
}

/* Works and energies of point k. */
static inline void add_works(int ns, const run *r, int k, point_sums *sum) {
  const visco *v = r->strains.visco;
  const size_t at = visco_at(r, k);
  const double w = v->x.weight[k], *sigma = v->now.sigma + at;
  const double *ei[] = {v->old.ei + at, v->now.ei + at};
  double middle[6], creep[6], elastic[6], held[6];
  for (int i = 0; i < ns; ++i) {
    middle[i] = 0.5 * (v->old.sigma[at + i] + sigma[i]);
    creep[i] = ei[1][i] - ei[0][i];
    elastic[i] = v->now.e[at + i] - ei[1][i];
  }
  voigt_product(ns, v->x.kind[v->x.kind_id[k]].elastic.E, ei[1], held);
  sum->inelastic += w * voigt_dot(ns, middle, creep);
  sum->held += 0.5 * w * voigt_dot(ns, ei[1], held);
  sum->strain += 0.5 * w * voigt_dot(ns, elastic, sigma);
}

/* What thermal strains add to them; e0 and sigma of r->now. */
static void add_thermal(const run *r, int k, point_sums *sum) {
  const visco *v = r->strains.visco;
  const int ns = r->m->ns;
  const size_t at = visco_at(r, k), item = visco_at(r, v->place[k]);
  const double *ei = v->now.ei + at, *sigma = v->now.sigma + at;
  const double w = v->x.weight[k], *thermal = r->now.thermal + item;
  double twice[6], stress[6], middle[6], warm[6];
  for (int i = 0; i < ns; ++i) {
    const size_t j = item + i;
    middle[i] = 0.5 * (v->old.sigma[at + i] + sigma[i]);
    warm[i] = thermal[i] - r->old.thermal[j];
    twice[i] = thermal[i] + 2.0 * ei[i];
    r->now.e0[j] = thermal[i] + ei[i];
    r->now.sigma[j] = sigma[i];
  }
  voigt_product(ns, v->x.kind[v->x.kind_id[k]].elastic.E, twice, stress);
  sum->thermal += w * voigt_dot(ns, middle, warm);
  sum->held += 0.5 * w * voigt_dot(ns, thermal, stress);
}

static inline void add_points(int ns, const run *r, const visco_part *p,
                              point_sums *sum) {
  const int end = p->point + p->n_point;
  for (int k = p->point; k < end; ++k) add_works(ns, r, k, sum);
  for (int k = p->point; k < end && r->now.thermal != NULL; ++k)
    add_thermal(r, k, sum);
}

status visco_part_sums(run *r, const visco_part *p) {
  visco *v = r->strains.visco;
  const int end = p->point + p->n_point;
  point_sums sum = v->sums;
  if (p->n_point < p->n_item)
    COPY(r->now.e0 + visco_at(r, p->item),
         r->now.thermal + visco_at(r, p->item), visco_at(r, p->n_item));
  if (r->m->ns == 4)
    add_points(4, r, p, &sum);
  else
    add_points(6, r, p, &sum);
  PASS(flow_add_stored(&v->x, &v->now, p->point, end, &sum.stored));
  PASS(flow_add_elastic(&v->x, &v->now, p->point, end, &sum.elastic));
  v->sums = sum;
  return OK;
}

void visco_show(const run *r, state *s) {
  s->body.flow = &r->strains.visco->x;
  s->body.flow_elem = r->strains.visco->elem;
  s->body.inelastic = &r->strains.visco->now;
}
