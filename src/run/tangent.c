/*
 * Equilibria of the body with the linear laws of the implicit integrators:
 * their matrices, of which the constant ones are stored, and loads.
 */
#include "base/base.h"
#include "material/voigt.h"
#include "run/visco.h"

static const double TRACE = 0x1p-40; /* -, of the elasticity */

void visco_forget(run *r) {
  visco *v = r->strains.visco;
  if (v == NULL) return;
  for (int i = 0; i < SLOTS; ++i) matrices_free(&v->slot[i]);
  matrices_free(&v->fresh);
  v->E_is_fresh = 0;
}

static void forget_solver(matrices *m) {
  contact_solver_free(&m->solver);
  m->solver = NULL;
  m->from = NULL;
}

void visco_new_solvers(run *r) {
  visco *v = r->strains.visco;
  if (v == NULL) return;
  for (int i = 0; i < SLOTS; ++i) forget_solver(&v->slot[i]);
  forget_solver(&v->fresh);
}

static status factor(const domain *d, matrices *m) {
  matrices keep = *m;
  m->E = NULL;
  matrices_free(m);
  m->E = keep.E;
  if (keep.c == NULL) { /* as it was before a restart */
    m->from = keep.from;
    memcpy(m->group, keep.group, sizeof m->group);
  }
  PASS(stiffness_assemble(d, &m->k));
  return condense(m->k, d, &m->c);
}

/* Those of before a restart again, without counting them. */
static status factor_again(const domain *d, matrices *m) {
  stage_cost before[STAGE_COUNT] = {{0}};
  for (int i = 0; i < STAGE_COUNT; ++i)
    before[i].calls = timer_cost((stage)i).calls;
  status st = factor(d, m);
  if (st == OK) st = matrices_follow(m);
  timer_resume(before);
  return st;
}

/* Sections as they are, with the tangents of their kinds, in *E, which the
 * matrices of the domain go on reading. */
static status constant_domain(const run *r, const flow_tangent *law, double **E,
                              domain *d) {
  size_t square = visco_at(r, r->m->ns), n = r->body.moduli.n;
  int kind = 0;
  if (*E == NULL) PASS_NEW(*E, square * n);
  COPY(*E, r->body.moduli.E, square * n);
  for (int i = 0; i < r->m->n.section; ++i) {
    const material *mat = &r->m->materials[r->m->sections[i].material_id];
    if (mat->law.ops == NULL) continue;
    COPY(*E + square * i, law->D + square * kind++, square);
  }
  *d = r->body.d;
  d->E = *E;
  return OK;
}

/* The matrices of m->E. A group that has relaxed within the step may be so soft
 * that the others are free to rounding: it gets a small share of its elasticity
 * in the matrix, not in its stresses. The error of that is found by
 * rounding_find as a residual of equilibrium. */
static status factor_constant(run *r, int again, const domain *d, matrices *m) {
  const size_t square = visco_at(r, r->m->ns);
  status st = again ? factor_again(d, m) : factor(d, m);
  if (st != ERR_SINGULAR) return st;
  for (int i = 0; i < r->m->n.section; ++i) {
    const size_t at = square * i;
    const material *mat = &r->m->materials[r->m->sections[i].material_id];
    for (size_t k = at; k < at + square && mat->law.ops != NULL; ++k)
      m->E[k] += TRACE * r->body.moduli.E[k];
  }
  return again ? factor_again(d, m) : factor(d, m);
}

/* Each point a section of its own, with room for its E. */
static status new_sections(run *r) {
  visco *v = r->strains.visco;
  const moduli *own = &r->body.moduli;
  int n = own->n + v->x.n;
  OWNS(v->work);
  PASS_NEW_ALL(OF(v->section_id, r->msh->n_elem), OF(v->kin, n),
               OF(v->thickness, n), OF(v->E, visco_at(r, r->m->ns) * n));
  COPY(v->section_id, r->body.d.section_id, r->msh->n_elem);
  COPY(v->kin, own->kin, own->n);
  COPY(v->thickness, own->thickness, own->n);
  for (int k = 0; k < v->x.n; ++k) {
    int e = v->elem[k], entry = own->n + k;
    v->kin[entry] = own->kin[v->section_id[e]];
    v->thickness[entry] = own->thickness[v->section_id[e]];
    v->section_id[e] = entry;
  }
  return OK;
}

static status fresh_domain(run *r, const flow_tangent *law, domain *d) {
  visco *v = r->strains.visco;
  size_t square = visco_at(r, r->m->ns), n = r->body.moduli.n;
  if (v->E == NULL) PASS(new_sections(r));
  COPY(v->E, r->body.moduli.E, square * n);
  COPY(v->E + square * n, law->D, square * v->x.n);
  v->E_is_fresh = 1;
  *d = r->body.d;
  d->section_id = v->section_id;
  d->origin = NULL;
  d->kin = v->kin;
  d->thickness = v->thickness;
  d->E = v->E;
  d->C = NULL;
  return OK;
}

/* Tangents of this solve alone: their symbolic factor is kept. */
static status use_fresh(run *r, const flow_tangent *law) {
  visco *v = r->strains.visco;
  domain d;
  /* 1 if the tangents of the points are those of the last solve of its kind. */
  const size_t square = visco_at(r, r->m->ns);
  int same = v->E_is_fresh && memcmp(v->E + square * r->body.moduli.n, law->D,
                                     square * v->x.n * sizeof *v->E) == 0;
  if (same && v->fresh.c != NULL) return OK;
  PASS(fresh_domain(r, law, &d));
  r->c = NULL;
  if (!same) {
    run_forget_estimates(r);
    v->fresh.from = NULL;
  }
  PASS(same ? factor_again(&d, &v->fresh) : factor(&d, &v->fresh));
  v->fresh.key = RUN_FRESH_KEY;
  return OK;
}

/* The matrices of a tangent: those of its key if they are still there. */
static status find_matrices(run *r, const flow_tangent *law, matrices **out) {
  visco *v = r->strains.visco;
  matrices *m = &v->slot[0];
  domain d;
  *out = law->elastic ? &r->elastic : &v->fresh;
  if (law->elastic) return OK;
  if (law->key == 0.0) {
    PASS(use_fresh(r, law));
    return OK;
  }
  int there = 0;
  for (int i = 0; i < SLOTS && !there; ++i) {
    matrices *own = &v->slot[i];
    there = own->key == law->key && own->exact == law->exact;
    if (there || own->used < m->used) m = own;
  }
  if (!there) m->from = NULL;
  if (!there || m->c == NULL) {
    PASS(constant_domain(r, law, &m->E, &d));
    if (r->c == m->c) r->c = NULL;
    PASS(factor_constant(r, there, &d, m));
    m->key = law->key;
    m->exact = law->exact;
  }
  m->used = ++v->clock;
  *out = m;
  return OK;
}

/* v->stress from its start: of the items of a part, what sigma = sigma_k + D (e
 * - e_k) and the thermal strains add to the loads; sigma[ns*x.n], e[ns*x.n]. */
static void part_stress(run *r, const flow_tangent *law, const double *sigma,
                        const double *e, const visco_part *p) {
  visco *v = r->strains.visco;
  const int ns = r->m->ns, end = p->point + p->n_point;
  for (int k = 0, point = p->point; k < p->n_item; ++k) {
    const int item = p->item + k, elem_id = r->strains.elem[item];
    double *stress = v->stress + visco_at(r, k), e_k[6];
    if (point == end || v->place[point] != item) {
      voigt_product(ns, run_elasticity(r, elem_id),
                    r->now.thermal + visco_at(r, item), stress);
      continue;
    }
    const int kind = v->x.kind_id[point];
    const size_t at = visco_at(r, point);
    const double *D =
        law->elastic
            ? run_elasticity(r, elem_id)
            : law->D + visco_at(r, ns * (law->key > 0.0 ? kind : point));
    for (int i = 0; i < ns; ++i) e_k[i] = e[at + i];
    for (int i = 0; i < ns && r->now.thermal != NULL; ++i)
      e_k[i] += r->now.thermal[visco_at(r, item) + i];
    voigt_product(ns, D, e_k, stress);
    for (int i = 0; i < ns; ++i) stress[i] -= sigma[at + i];
    ++point;
  }
}

/* r->strains.load: the loads with what the linear law and the thermal strains
 * add to them. */
static const double *tangent_load(run *r, const flow_tangent *law) {
  const visco_part all = {0, r->strains.eigen.n, 0, r->strains.visco->x.n};
  part_stress(r, law, law->sigma, law->e, &all);
  COPY(r->strains.load, r->now.F, r->n_dof);
  eigen_add_force(&r->body.d, r->strains.eigen.n, r->strains.elem,
                  r->strains.visco->stress, r->strains.load);
  return r->strains.load;
}

/* The same for a step of constant laws, whose points are predicted. */
static const double *step_load(run *r, const flow_tangent *law,
                               const scheme_call *a) {
  visco_part p = {0};
  COPY(r->strains.load, r->now.F, r->n_dof);
  while (visco_next_part(r, &p)) {
    linear_predict(a, p.point, p.point + p.n_point);
    part_stress(r, law, a->now->sigma, a->old->e, &p);
    eigen_add_force(&r->body.d, p.n_item, r->strains.elem + p.item,
                    r->strains.visco->stress, r->strains.load);
  }
  return r->strains.load;
}

/* The points at the equilibrium of a step of constant laws. */
static status step_follow(run *r, const scheme_call *a) {
  visco_part p = {0};
  r->strains.visco->sums = (point_sums){0};
  while (visco_next_part(r, &p)) {
    visco_part_strains(r, &p);
    linear_follow(a, p.point, p.point + p.n_point);
    PASS(visco_part_sums(r, &p));
  }
  return OK;
}

status tangent_solve(run *r, const flow_tangent *law) {
  matrices *m = NULL;
  PASS(find_matrices(r, law, &m));
  PASS(run_use(r, m));
  return increment_equilibrium(r, tangent_load(r, law));
}

status tangent_step(run *r, const flow_tangent *law, const scheme_call *a) {
  matrices *m = NULL;
  PASS(find_matrices(r, law, &m));
  PASS(run_use(r, m));
  timer_enter(STAGE_INELASTIC);
  const double *forces = step_load(r, law, a);
  timer_leave(STAGE_INELASTIC);
  PASS(increment_equilibrium(r, forces));
  TIMED(STAGE_INELASTIC);
  return step_follow(r, a);
}

/* The tangents that v->fresh is made of, and its solver. */
static status keep_fresh(run *r, archive *a) {
  visco *v = r->strains.visco;
  size_t square = visco_at(r, r->m->ns), n = r->body.moduli.n;
  int there = v->E_is_fresh && (v->fresh.c != NULL || v->fresh.from != NULL);
  PASS(archive_ints(a, "fresh", &there, 1));
  if (archive_reads(a)) v->E_is_fresh = there;
  if (!there) return OK;
  if (v->E == NULL) PASS(new_sections(r));
  PASS(archive_reals(a, "tangents", v->E + square * n, square * v->x.n));
  return matrices_keep(&v->fresh, a, "fresh_solver");
}

status tangent_keep(run *r, archive *a) {
  visco *v = r->strains.visco;
  double known = r->c == r->elastic.c ? r->elastic.key : RUN_OTHER_KEY;
  if (v->fresh.c != NULL && v->fresh.c == r->c) known = v->fresh.key;
  for (int i = 0; i < SLOTS; ++i) {
    matrices *m = &v->slot[i];
    if (m->c != NULL && m->c == r->c) known = m->key;
    IN_GROUP(a, text_of("slot%d", i));
    PASS(archive_reals(a, "key", &m->key, 1));
    PASS(archive_ints(a, "exact", &m->exact, 1));
    PASS(archive_bytes(a, "used", &m->used, sizeof m->used));
    PASS(matrices_keep(m, a, "solver"));
  }
  if (r->solving.known_key != RUN_NO_KEY) known = r->solving.known_key;
  PASS(keep_fresh(r, a));
  PASS(archive_reals(a, "known_key", &known, 1));
  if (archive_reads(a)) r->solving.known_key = known;
  return archive_bytes(a, "clock", &v->clock, sizeof v->clock);
}

void run_change_moduli(run *r) {
  visco_forget(r);
  run_forget_estimates(r);
  r->body.stale = 1;
  if (r->c != r->elastic.c) r->c = NULL;
}
