/*
 * Strains that carry no stress, e0 = e_th of the temperature + e^i of the
 * inelastic laws, sigma = E (e - e0): kept for the elements that can have any,
 * and for them alone.
 *
 * For e^i: what the integrators of src/scheme ask of the body, the tangent
 * matrices they need, their steps and what limits them (CPR98 3.14-3.20: each
 * stress of a given e^i is one contact problem, with the slip counted from the
 * last accepted increment).
 */
#include "base/memory.h"
#include "base/timer.h"
#include "history/run.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SLOTS = 4 };

struct visco {
  flow x;
  int *place; /* [x.n] of a point in r->eigen                                */
  int *elem;  /* [x.n]                                                       */
  flow_state old, now;
  flow_state middle; /* between two halves of a step                         */
  double *fine;      /* [ns*x.n] e^i after them                              */
  scheme_work *work;
  scheme_result result;
  matrices slot[SLOTS]; /* constant tangents; the last used are kept         */
  matrices fresh;       /* a tangent of its own                              */
  long clock;
  double length[SLOTS]; /* of the last different steps, s                     */
  unsigned n_length;
  double *E;       /* [ns*ns*(n_section + x.n)] of a tangent                  */
  double *stress;  /* [ns*r->eigen.n] Pa                                      */
  int *section_id; /* [n_elem] sections of their own for the points     */
  kinematics *kin; /* [n_section + x.n]                                 */
  double *thickness; /* the same                                          */
  double largest;    /* largest norm of the elastic strains so far        */
  const step *told;  /* step whose ringing has been told                  */
};

/* ---- which elements --------------------------------------------------------
 */

const material *run_material(const run *r, int elem_id) {
  const model *m = r->m;
  return &m->materials[m->sections[m->elem_section[elem_id]].material_id];
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
  return expands(r, elem_id) || flows(r, elem_id);
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

/* ---- points that flow ------------------------------------------------------
 */

/* One kind for each section whose material has a law. */
static status new_kinds(const run *r, flow *x, int *kind_of) {
  status st = OK;
  const model *m = r->m;
  x->ns = m->ns;
  NEW(x->kind, m->n_section);
  for (int i = 0; i < m->n_section; ++i) {
    const material *mat = &m->materials[m->sections[i].material_id];
    law_elastic elastic;
    kind_of[i] = -1;
    if (mat->law.ops == NULL) continue;
    law_elastic_set(mat->C, mat->type, (kinematics)m->sections[i].kin,
                    &elastic);
    kind_of[i] = x->n_kind++;
    TRY(flow_new_kind(&x->kind[kind_of[i]], &mat->law, &elastic));
  }
done:
  return st;
}

static status new_points(run *r, visco *v, const int *kind_of) {
  status st = OK;
  int n = 0, *kind_id = NULL;
  NEW(kind_id, r->eigen.n);
  NEW(v->place, r->eigen.n);
  NEW(v->elem, r->eigen.n);
  for (int k = 0; k < r->eigen.n; ++k) {
    int kind = kind_of[r->m->elem_section[r->eigen_elem[k]]];
    if (kind < 0) continue;
    v->place[n] = k;
    v->elem[n] = r->eigen_elem[k];
    kind_id[n++] = kind;
  }
  TRY(flow_new_points(&v->x, n, kind_id));
  for (int k = 0; k < n; ++k)
    v->x.weight[k] = element_weight(&r->d, v->elem[k]);
done:
  memory_free(kind_id);
  return st;
}

static int compare_id(const void *a, const void *b) {
  const int x = *(const int *)a, y = *(const int *)b;
  return (x > y) - (x < y);
}

/* One line of *INITIAL CONDITIONS into both states. */
static status take_initial(const run *r, visco *v, const initial *c) {
  status st = OK;
  const mesh_group *g = &r->msh->group[c->group_id];
  size_t ns = (size_t)r->m->ns, part = (size_t)c->component;
  for (int i = 0; i < g->n_item; ++i) {
    double value;
    const int *found = bsearch(&g->item_id[i], v->elem, (size_t)v->x.n,
                               sizeof *v->elem, compare_id);
    if (found == NULL) continue;
    size_t k = (size_t)(found - v->elem);
    TRY(load_initial(r->m, r->msh, c, *found, &value));
    if (c->type == INITIAL_STRAIN)
      v->old.ei[ns * k + part] = v->now.ei[ns * k + part] = value;
    else
      v->old.alpha[v->x.alpha_at[k] + part] =
          v->now.alpha[v->x.alpha_at[k] + part] = value;
  }
done:
  return st;
}

static status initial_state(const run *r, visco *v) {
  status st = OK;
  for (int i = 0; i < r->m->n_initial; ++i) {
    const initial *c = &r->m->initials[i];
    if (c->type == INITIAL_STRAIN || c->type == INITIAL_INTERNAL)
      TRY(take_initial(r, v, c));
  }
done:
  return st;
}

static status visco_new(run *r) {
  status st = OK;
  int *kind_of = NULL;
  visco *v = NULL;
  timer_enter(STAGE_INELASTIC);
  NEW(v, 1);
  r->visco = v;
  NEW(kind_of, r->m->n_section);
  TRY(new_kinds(r, &v->x, kind_of));
  TRY(new_points(r, v, kind_of));
  TRY(flow_state_new(&v->x, &v->old));
  TRY(flow_state_new(&v->x, &v->now));
  TRY(initial_state(r, v));
  TRY(scheme_work_new(&v->work));
  NEW(v->stress, (size_t)r->m->ns * (size_t)r->eigen.n);
done:
  timer_leave(STAGE_INELASTIC);
  memory_free(kind_of);
  return st;
}

void visco_forget(run *r) {
  visco *v = r->visco;
  if (v == NULL) return;
  for (int i = 0; i < SLOTS; ++i) matrices_free(&v->slot[i]);
  matrices_free(&v->fresh);
}

static void visco_free(visco *v) {
  if (v == NULL) return;
  for (int i = 0; i < SLOTS; ++i) matrices_free(&v->slot[i]);
  matrices_free(&v->fresh);
  flow_state_free(&v->old);
  flow_state_free(&v->now);
  flow_state_free(&v->middle);
  memory_free(v->fine);
  scheme_work_free(v->work);
  flow_free(&v->x);
  memory_free(v->place);
  memory_free(v->elem);
  memory_free(v->E);
  memory_free(v->stress);
  memory_free(v->section_id);
  memory_free(v->kin);
  memory_free(v->thickness);
  memory_free(v);
}

/* ---- between points and elements --------------------------------------- */

static size_t at(const run *r, int k) { return (size_t)r->m->ns * (size_t)k; }

static void visco_add_strains(const run *r, double *e0) {
  const visco *v = r->visco;
  for (int k = 0; k < v->x.n; ++k)
    for (size_t i = 0; i < (size_t)r->m->ns; ++i)
      e0[at(r, v->place[k]) + i] += v->now.ei[at(r, k) + i];
}

static void take_temperatures(const run *r, const equilibrium *e,
                              flow_state *s) {
  const visco *v = r->visco;
  for (int k = 0; k < v->x.n && e->temperature != NULL; ++k)
    s->temperature[k] = e->temperature[v->elem[k]];
}

/* Strains, less the thermal ones, of an equilibrium into s->e; stresses. */
static void take_strains(run *r, const equilibrium *e, flow_state *s) {
  visco *v = r->visco;
  const eigenstrain thermal = {r->eigen.n, r->eigen_elem, e->thermal};
  eigen_stress(&r->d, &thermal, e->u, v->stress, NULL);
  for (int k = 0; k < v->x.n; ++k) {
    const double *E = v->x.kind[v->x.kind_id[k]].elastic.E;
    double elastic[6];
    memcpy(s->e + at(r, k), v->stress + at(r, v->place[k]),
           at(r, 1) * sizeof *s->e);
    for (size_t i = 0; i < at(r, 1); ++i)
      elastic[i] = s->e[at(r, k) + i] - s->ei[at(r, k) + i];
    tensor_product(r->m->ns, E, elastic, s->sigma + at(r, k));
  }
}

/* ---- strains of the equilibrium -------------------------------------------
 */

status strains_new(run *r) {
  status st = OK;
  if (!(r->m->effects & (EFFECT_THERMAL | EFFECT_INELASTIC))) return OK;
  TRY(list_elements(r));
  if (r->m->effects & EFFECT_THERMAL) {
    NEW(r->temperature0, r->msh->n_elem);
    TRY(load_temperature_initial(r->m, r->msh, r->temperature0));
  }
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

/* Temperatures and thermal strains of r->now. */
static status heat(run *r) {
  status st = OK;
  equilibrium *now = &r->now;
  size_t ns = (size_t)r->m->ns;
  timer_enter(STAGE_THERMAL);
  TRY(load_temperature(r->m, r->msh, r->step, now->t, r->temperature0,
                       now->temperature));
  for (int k = 0; k < r->eigen.n; ++k) {
    int e = r->eigen_elem[k];
    if (expands(r, e))
      expansion_strain(&run_material(r, e)->expand, now->temperature[e],
                       r->temperature0[e], now->thermal + ns * (size_t)k);
  }
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

void strains_work(run *r, energies *e) {
  const equilibrium *a = &r->old, *b = &r->now;
  size_t ns = (size_t)r->m->ns;
  double scale = 0.0;
  if (r->eigen.n == 0) return;
  timer_enter(STAGE_ENERGY);
  eigen_stress(&r->d, &r->eigen, b->u, NULL, b->sigma);
  for (int k = 0; k < r->eigen.n; ++k) {
    double w = element_weight(&r->d, r->eigen_elem[k]);
    double thermal = 0.0, all = 0.0, held[6];
    for (size_t i = ns * (size_t)k; i < ns * (size_t)(k + 1); ++i) {
      double sigma = 0.5 * (a->sigma[i] + b->sigma[i]);
      thermal += sigma * (b->thermal[i] - a->thermal[i]);
      all += sigma * (b->e0[i] - a->e0[i]);
    }
    e->thermal += w * thermal;
    e->inelastic += w * (all - thermal);
    tensor_product(
        r->m->ns, r->E + at(r, r->m->ns * r->m->elem_section[r->eigen_elem[k]]),
        b->e0 + at(r, k), held);
    scale += 0.5 * w * tensor_dot(r->m->ns, b->e0 + at(r, k), held);
  }
  e->largest = fmax(e->largest, scale);
  timer_leave(STAGE_ENERGY);
}

/* ---- what the integrators ask ------------------------------------------ */

static status equilibrium_of(void *ctx, flow_state *s, int *settled) {
  status st = OK;
  run *r = ctx;
  timer_leave(STAGE_INELASTIC);
  st = run_use(r, &r->elastic);
  if (st == OK) st = increment_solve(r, s->t);
  timer_enter(STAGE_INELASTIC);
  TRY(st);
  take_temperatures(r, &r->now, s);
  take_strains(r, &r->now, s);
  *settled = r->report.outcome > 0;
done:
  return st;
}

static status begin(void *ctx, flow_state *s) {
  run *r = ctx;
  timer_leave(STAGE_INELASTIC);
  status st = increment_begin(r, s->t);
  timer_enter(STAGE_INELASTIC);
  if (st == OK) take_temperatures(r, &r->now, s);
  return st;
}

static status factor(const domain *d, matrices *m) {
  status st = OK;
  matrices keep = *m;
  matrices_free(m);
  if (keep.c == NULL) { /* as it was before a restart                         */
    m->from = keep.from;
    memcpy(m->group, keep.group, sizeof m->group);
  }
  TRY(stiffness_assemble(d, &m->k));
  TRY(condense(m->k, d, &m->c));
done:
  return st;
}

/* Sections as they are, with the tangents of their kinds. */
static status constant_domain(run *r, const flow_tangent *law, domain *d) {
  status st = OK;
  visco *v = r->visco;
  size_t square = at(r, r->m->ns);
  int kind = 0;
  if (v->E == NULL) NEW(v->E, square * (size_t)(r->m->n_section + v->x.n));
  memcpy(v->E, r->E, square * (size_t)r->m->n_section * sizeof *v->E);
  for (int i = 0; i < r->m->n_section; ++i) {
    const material *mat = &r->m->materials[r->m->sections[i].material_id];
    if (mat->law.ops == NULL) continue;
    memcpy(v->E + square * (size_t)i, law->D + square * (size_t)kind++,
           square * sizeof *v->E);
  }
  *d = r->d;
  d->E = v->E;
done:
  return st;
}

/* Each point a section of its own. */
static status new_sections(run *r) {
  status st = OK;
  visco *v = r->visco;
  int n_section = r->m->n_section, n = n_section + v->x.n;
  NEW(v->section_id, r->msh->n_elem);
  NEW(v->kin, n);
  NEW(v->thickness, n);
  memcpy(v->section_id, r->m->elem_section,
         (size_t)r->msh->n_elem * sizeof *v->section_id);
  memcpy(v->kin, r->kin, (size_t)n_section * sizeof *v->kin);
  memcpy(v->thickness, r->thickness, (size_t)n_section * sizeof *v->thickness);
  for (int k = 0; k < v->x.n; ++k) {
    int e = v->elem[k], own = n_section + k;
    v->kin[own] = r->kin[v->section_id[e]];
    v->thickness[own] = r->thickness[v->section_id[e]];
    v->section_id[e] = own;
  }
done:
  return st;
}

static status fresh_domain(run *r, const flow_tangent *law, domain *d) {
  status st = OK;
  visco *v = r->visco;
  size_t square = at(r, r->m->ns), n_section = (size_t)r->m->n_section;
  if (v->section_id == NULL) TRY(new_sections(r));
  if (v->E == NULL) NEW(v->E, square * (n_section + (size_t)v->x.n));
  memcpy(v->E, r->E, square * n_section * sizeof *v->E);
  memcpy(v->E + square * n_section, law->D,
         square * (size_t)v->x.n * sizeof *v->E);
  *d = r->d;
  d->section_id = v->section_id;
  d->kin = v->kin;
  d->thickness = v->thickness;
  d->E = v->E;
  d->C = NULL;
done:
  return st;
}

/* Those of before a restart anew, which are not counted again. */
static status factor_again(const domain *d, matrices *m) {
  stage_cost before[STAGE_COUNT] = {{0}};
  for (int i = 0; i < STAGE_COUNT; ++i)
    before[i].calls = timer_cost((stage)i).calls;
  status st = factor(d, m);
  timer_resume(before);
  return st;
}

/* The matrices of a tangent: those of its key if they are still there. */
static status find_matrices(run *r, const flow_tangent *law, matrices **out) {
  status st = OK;
  visco *v = r->visco;
  matrices *m = &v->slot[0];
  domain d;
  *out = law->elastic ? &r->elastic : &v->fresh;
  if (law->elastic) goto done;
  if (law->key == 0.0) {
    TRY(fresh_domain(r, law, &d));
    r->c = NULL;
    TRY(factor(&d, &v->fresh));
    goto done;
  }
  for (int i = 0; i < SLOTS; ++i) {
    if (v->slot[i].key == law->key) m = &v->slot[i];
    if (m->key != law->key && v->slot[i].used < m->used) m = &v->slot[i];
  }
  if (m->key != law->key) m->from = NULL;
  if (m->key != law->key || m->c == NULL) {
    TRY(constant_domain(r, law, &d));
    if (r->c == m->c) r->c = NULL;
    TRY(m->key == law->key ? factor_again(&d, m) : factor(&d, m));
    m->key = law->key;
  }
  m->used = ++v->clock;
  *out = m;
done:
  return st;
}

/* r->eigen_load: the loads with what sigma = sigma_k + D (e - e_k) and the
 * thermal strains add to them. */
static const double *tangent_load(run *r, const flow_tangent *law) {
  visco *v = r->visco;
  const double *thermal = r->now.thermal;
  int ns = r->m->ns;
  for (int k = 0, point = 0; k < r->eigen.n; ++k) {
    int e = r->eigen_elem[k];
    if (point == v->x.n || v->place[point] != k) {
      tensor_product(ns, r->E + at(r, ns * r->m->elem_section[e]),
                     thermal + at(r, k), v->stress + at(r, k));
      continue;
    }
    int kind = v->x.kind_id[point];
    const double *D =
        law->elastic ? v->x.kind[kind].elastic.E
                     : law->D + at(r, ns * (law->key > 0.0 ? kind : point));
    double e_k[6];
    for (size_t i = 0; i < at(r, 1); ++i)
      e_k[i] = law->e[at(r, point) + i] + thermal[at(r, k) + i];
    tensor_product(ns, D, e_k, v->stress + at(r, k));
    for (size_t i = 0; i < at(r, 1); ++i)
      v->stress[at(r, k) + i] -= law->sigma[at(r, point) + i];
    ++point;
  }
  memcpy(r->eigen_load, r->now.F, r->n_dof * sizeof *r->eigen_load);
  eigen_add_force(&r->d, r->eigen.n, r->eigen_elem, v->stress, r->eigen_load);
  return r->eigen_load;
}

static status solve_linear(run *r, const flow_tangent *law) {
  status st = OK;
  matrices *m = NULL;
  TRY(find_matrices(r, law, &m));
  TRY(run_use(r, m));
  TRY(increment_equilibrium(r, tangent_load(r, law)));
done:
  return st;
}

static status linear(void *ctx, const flow_tangent *law, flow_state *s,
                     int *settled) {
  run *r = ctx;
  timer_leave(STAGE_INELASTIC);
  status st = solve_linear(r, law);
  timer_enter(STAGE_INELASTIC);
  if (st == OK) take_strains(r, &r->now, s);
  *settled = r->report.outcome > 0;
  return st;
}

/* ---- steps ------------------------------------------------------------- */

status visco_begin_step(run *r) {
  visco *v = r->visco;
  if (v == NULL) return OK;
  timer_enter(STAGE_INELASTIC);
  take_temperatures(r, &r->old, &v->old);
  take_strains(r, &r->old, &v->old);
  v->old.t = r->old.t;
  timer_leave(STAGE_INELASTIC);
  return OK;
}

/* Length of the step to t; one that differs by the rounding of the times only
 * from one before is the same, and so are its matrices. */
static double step_length(run *r, double t) {
  visco *v = r->visco;
  double dt = t - r->old.t, rounding = 4e-16 * (fabs(t) + fabs(r->old.t));
  for (int i = 0; i < SLOTS; ++i)
    if (fabs(v->length[i] - dt) <= rounding) return v->length[i];
  v->length[v->n_length++ % SLOTS] = dt;
  return dt;
}

static status advance(run *r, double t) {
  status st = OK;
  visco *v = r->visco;
  const flow_body body = {r, equilibrium_of, begin, linear};
  scheme_step p = {.t = t,
                   .dt = step_length(r, t),
                   .theta = r->step->theta,
                   .initial = r->step->initial,
                   .tol = r->step->solver.tol};
  v->result = (scheme_result){.settled = 1, .error = -1.0};
  v->old.t = r->old.t;
  const scheme_call call = {&v->x,   &p,      &body,     v->work,
                            &v->old, &v->now, &v->result};
  TRY(r->step->integrator->advance(&call));
  v->now.t = t;
  strains_collect(r);
  if (!v->result.settled && r->report.outcome > 0)
    r->report.outcome = STOPPED_ITERATIONS;
done:
  return st;
}

status visco_advance(run *r, double t) {
  if (r->visco == NULL) return increment_solve(r, t);
  timer_enter(STAGE_INELASTIC);
  status st = advance(r, t);
  timer_leave(STAGE_INELASTIC);
  return st;
}

/* What an increment starts from, of the contact. */
typedef struct start_point {
  double *uc, *rc, *motion; /* [m] m, N, m                                   */
} start_point;

static status start_point_new(const run *r, start_point *p) {
  status st = OK;
  size_t bytes = (size_t)r->n_c * sizeof *p->uc;
  NEW(p->uc, r->n_c);
  NEW(p->rc, r->n_c);
  NEW(p->motion, r->n_c);
  if (r->n_c == 0) goto done;
  memcpy(p->uc, r->now.uc, bytes);
  memcpy(p->rc, r->now.rc, bytes);
  memcpy(p->motion, r->now.motion, bytes);
done:
  return st;
}

/* From r->now, which becomes the accepted state for the while, to t. */
static status second_half(run *r, double t) {
  status st = OK;
  visco *v = r->visco;
  equilibrium keep = r->old;
  start_point p = {0};
  if (v->middle.e == NULL) TRY(flow_state_new(&v->x, &v->middle));
  TRY(start_point_new(r, &p));
  flow_state_copy(&v->x, &v->now, &v->middle);
  flow_state first = v->old;
  r->old.t = r->now.t;
  r->old.uc = p.uc;
  r->old.rc = p.rc;
  r->old.motion = p.motion;
  v->old = v->middle;
  st = advance(r, t);
  v->middle = v->old;
  v->old = first;
  r->old = keep;
done:
  memory_free(p.uc);
  memory_free(p.rc);
  memory_free(p.motion);
  return st;
}

/* Two halves into v->fine[ns*n]; r->report tells if they were found. */
static status two_halves(run *r, double t) {
  status st = OK;
  visco *v = r->visco;
  size_t n = at(r, v->x.n);
  if (v->fine == NULL) NEW(v->fine, n);
  r->beside = 1;
  TRY(advance(r, 0.5 * (r->old.t + t)));
  if (r->report.outcome <= 0) goto done;
  TRY(second_half(r, t));
  memcpy(v->fine, v->now.ei, n * sizeof *v->fine);
done:
  r->beside = 0;
  return st;
}

/* The difference to the halves, with Richardson's factor. */
static double halves_error(const run *r) {
  visco *v = r->visco;
  double power =
      ldexp(1.0, r->step->theta == 0.5 && r->step->integrator->has_theta
                     ? 2
                     : r->step->integrator->order);
  size_t n = at(r, v->x.n);
  for (size_t i = 0; i < n; ++i) v->fine[i] -= v->now.ei[i];
  return power / (power - 1.0) * flow_norm(&v->x, v->fine);
}

static status try_step(run *r, double t, double *error) {
  status st = OK;
  visco *v = r->visco;
  int estimates = r->step->integrator->estimates;
  *error = HUGE_VAL;
  if (!estimates) TRY(two_halves(r, t));
  if (!estimates && r->report.outcome <= 0) goto done;
  TRY(advance(r, t));
  if (r->report.outcome <= 0) goto done;
  *error = estimates ? v->result.error : halves_error(r);
  double scale = fmax(v->largest, flow_elastic_norm(&v->x, &v->now));
  if (*error > 0.0) *error /= scale;
done:
  return st;
}

status visco_try(run *r, double t, double *error) {
  timer_enter(STAGE_INELASTIC);
  status st = try_step(r, t, error);
  timer_leave(STAGE_INELASTIC);
  return st;
}

status visco_level(run *r, double dt, int *level) {
  status st = OK;
  visco *v = r->visco;
  double rate;
  *level = 0;
  if (v == NULL || r->step->kind != STEP_VISCO || !step_has_limit(r->step))
    return OK;
  timer_enter(STAGE_INELASTIC);
  TRY(flow_fastest(&v->x, &v->old, &rate));
  *level = step_level(r->m, r->step, r->old.t, dt, rate,
                      v->told != r->step && !flow_is_constant(&v->x));
  v->told = r->step;
  if (*level < 0)
    FAIL(ERR_DECK, "step %d: the increment is not stable", run_step_id(r) + 1);
done:
  timer_leave(STAGE_INELASTIC);
  return st;
}

status visco_energies(run *r, energies *e) {
  status st = OK;
  visco *v = r->visco;
  timer_enter(STAGE_INELASTIC);
  e->dissipated += v->result.dissipated;
  TRY(flow_stored(&v->x, &v->now, &e->stored));
done:
  timer_leave(STAGE_INELASTIC);
  return st;
}

void visco_accept(run *r) {
  visco *v = r->visco;
  if (r->step->kind != STEP_VISCO) return;
  v->result.dissipated = 0.0;
  timer_enter(STAGE_INELASTIC);
  v->largest = fmax(v->largest, flow_elastic_norm(&v->x, &v->now));
  flow_state_copy(&v->x, &v->now, &v->old);
  timer_leave(STAGE_INELASTIC);
}

void visco_show(const run *r, state *s) {
  s->flow = &r->visco->x;
  s->flow_elem = r->visco->elem;
  s->inelastic = &r->visco->now;
}

/* ---- what a run goes on from -------------------------------------------- */

static status keep_flow(const flow *x, flow_state *s, archive *a,
                        const char *group) {
  status st = OK;
  size_t n = (size_t)x->ns * (size_t)x->n;
  archive_enter(a, group);
  TRY(archive_reals(a, "t", &s->t, 1));
  TRY(archive_reals(a, "e", s->e, n));
  TRY(archive_reals(a, "ei", s->ei, n));
  TRY(archive_reals(a, "sigma", s->sigma, n));
  TRY(archive_reals(a, "alpha", s->alpha, x->alpha_at[x->n]));
  TRY(archive_reals(a, "temperature", s->temperature, (size_t)x->n));
done:
  archive_leave(a);
  return st;
}

/* The keys of the constant tangents, which are made anew when they are used,
 * and which of the matrices is in use. */
static status keep_slots(run *r, archive *a) {
  status st = OK;
  visco *v = r->visco;
  char name[20];
  double known = r->c == r->elastic.c ? r->elastic.key : RUN_OTHER_KEY;
  for (int i = 0; i < SLOTS; ++i) {
    matrices *m = &v->slot[i];
    if (m->c != NULL && m->c == r->c) known = m->key;
    snprintf(name, sizeof name, "slot%d", i);
    archive_enter(a, name);
    TRY(archive_reals(a, "key", &m->key, 1));
    TRY(archive_bytes(a, "used", &m->used, sizeof m->used));
    TRY(matrices_keep(m, a, "solver"));
    archive_leave(a);
  }
  TRY(archive_reals(a, "known_key", &known, 1));
  if (archive_reads(a)) r->known_key = known;
  TRY(archive_bytes(a, "clock", &v->clock, sizeof v->clock));
done:
  return st;
}

status visco_keep(run *r, archive *a) {
  status st = OK;
  visco *v = r->visco;
  int told = v->told == r->step;
  archive_enter(a, "visco");
  TRY(keep_flow(&v->x, &v->old, a, "old"));
  TRY(keep_flow(&v->x, &v->now, a, "now"));
  TRY(archive_reals(a, "largest", &v->largest, 1));
  TRY(archive_ints(a, "told", &told, 1));
  v->told = told ? r->step : NULL;
  TRY(keep_slots(r, a));
done:
  archive_leave(a);
  return st;
}
