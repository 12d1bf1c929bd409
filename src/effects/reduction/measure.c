/*
 * Bounds of the change by an effect left out, from the solution without it;
 * a(.,.) is the energy of the body, |.| its norm.
 *
 *   thermal strain e    |du| <= |e|_E of the current strain; with friction,
 * which depends on the path, of all its changes summed (twice) inelastic strain
 * |du| <= |e^i|_E <= sum of dt times the larger of |rate|_E at both ends,
 * internal variables at their start, and twice that for the stress it relaxes
 *   law at its end      |du| <= |lag|_E of the strain that R sigma has grown by
 *                       and that has not crept yet, twice
 *   friction both inequalities tested with the other solution:
 *                       a(du, du) <= j(u) - j(u') <= sum g |slip| of the
 * solution without friction; square roots added up over the increments, twice
 *
 * over |u| of the increment. "local" is the largest stress E e of an element
 * over the largest contact pressure, or stress where nothing touches.
 */
#include "effects/reduction/parts.h"

#include "base/memory.h"
#include "fem/fem.h"

#include <math.h>
#include <string.h>

enum { SAFETY = 2 };

static status new_domain(reduction *n) {
  const model *m = n->m;
  size_t square = (size_t)(m->ns * m->ns);
  PASS_NEW(n->kin, m->n.section);
  PASS_NEW(n->thickness, m->n.section);
  PASS_NEW(n->E, square * (size_t)m->n.section);
  PASS_NEW(n->C, 36 * (size_t)m->n.section);
  PASS_NEW(n->fixed, n->msh->dim * n->msh->n_node);
  for (int i = 0; i < m->n.section; ++i) {
    const section *s = &m->sections[i];
    const double *C = m->materials[s->material_id].C;
    n->kin[i] = (kinematics)s->kin;
    n->thickness[i] = s->thickness;
    memcpy(n->C + 36 * (size_t)i, C, 36 * sizeof *C);
    elastic_reduce(C, n->kin[i], n->E + square * (size_t)i);
  }
  n->d = (domain){.mesh = n->msh,
                  .ns = m->ns,
                  .section_id = m->elem_section,
                  .kin = n->kin,
                  .thickness = n->thickness,
                  .E = n->E,
                  .C = n->C,
                  .fixed = n->fixed};
  return OK;
}

status reduction_new(const model *m, const mesh *msh, reduction **out) {
  status st = OK;
  reduction *n = NULL;
  const size_t strains = (size_t)m->ns * (size_t)msh->n_elem;
  *out = NULL;
  NEW(n, 1);
  n->m = m;
  n->msh = msh;
  TRY(new_domain(n));
  NEW(n->sigma, strains);
  NEW(n->T0, msh->n_elem);
  NEW(n->T, msh->n_elem);
  NEW(n->heat, strains);
  NEW(n->flow.strain, strains);
  NEW(n->flow.strain_rate, strains);
  NEW(n->strain, strains);
  NEW(n->elem_id, msh->n_elem);
  NEW(n->way, (msh->dim - 1) * msh->n_node);
  NEW(n->force, msh->dim * msh->n_node);
  NEW(n->u, msh->dim * msh->n_node);
  for (int e = 0; e < msh->n_elem; ++e) n->elem_id[e] = e;
  NEW(n->flow.stress, msh->n_elem);
  NEW(n->flow.rate, msh->n_elem);
  TRY(load_temperature_initial(m, msh, n->T0));
  *out = n;
  n = NULL;
done:
  reduction_free(n);
  return st;
}

void reduction_free(reduction *n) {
  if (n == NULL) return;
  double *const arrays[] = {n->thickness, n->E,
                            n->C,         n->sigma,
                            n->T0,        n->T,
                            n->heat,      n->flow.stress,
                            n->flow.rate, n->flow.strain,
                            n->strain,    n->way,
                            n->force,     n->flow.strain_rate,
                            n->u};
  for (size_t i = 0; i < sizeof arrays / sizeof *arrays; ++i)
    memory_free(arrays[i]);
  memory_free(n->kin);
  memory_free(n->elem_id);
  memory_free(n->fixed);
  memory_free(n);
}

/* ---- scales ------------------------------------------------------------- */

/* Largest contact pressure, or stress of an element, Pa. */
static double stress_scale(const reduction *n, const state *s) {
  double most = 0.0;
  const contact_surface *c = s->contacts.surface;
  for (int i = 0; c != NULL && i < c->n; ++i)
    if (c->area[i] > 0.0)
      most = fmax(most, -s->contacts.rc[c->dim * i] / c->area[i]);
  size_t size = (size_t)n->m->ns * (size_t)n->msh->n_elem;
  if (most > 0.0) return most;
  for (size_t i = 0; i < size; ++i) most = fmax(most, fabs(n->sigma[i]));
  return most;
}

/* e' E e of a strain; its largest stress into *stress. */
static double energy_of(const reduction *n, int elem_id, const double *e,
                        double *stress) {
  double held[6], sum = 0.0;
  int ns = n->m->ns;
  const double *E =
      n->E + (size_t)(ns * ns) * (size_t)n->m->elem_section[elem_id];
  *stress = 0.0;
  for (int i = 0; i < ns; ++i) {
    held[i] = 0.0;
    for (int k = 0; k < ns; ++k) held[i] += E[ns * k + i] * e[k];
    sum += held[i] * e[i];
    *stress = fmax(*stress, fabs(held[i]));
  }
  return sum;
}

/* Stresses of the run into n->sigma: its thermal strains and those of the laws
 * in force carry none. */
status reduction_stress(reduction *n, const state *s) {
  const model *m = n->m;
  const int ns = m->ns, warm = (m->effects & EFFECT_THERMAL) != 0;
  const eigenstrain x = {n->msh->n_elem, n->elem_id, n->strain};
  if (warm)
    PASS(load_temperature(m, n->msh, &m->steps[s->step_no - 1], s->t, n->T0,
                          n->T));
  for (int e = 0; e < n->msh->n_elem; ++e) {
    double *own = n->strain + (size_t)(ns * e);
    for (int i = 0; i < ns; ++i) own[i] = 0.0;
    if (warm && reduction_material(n, e)->expand.given)
      expansion_strain(&reduction_material(n, e)->expand, n->T[e], n->T0[e],
                       own);
  }
  for (int k = 0; s->body.flow != NULL && k < s->body.flow->n; ++k)
    for (int i = 0; i < ns; ++i)
      n->strain[ns * s->body.flow_elem[k] + i] +=
          s->body.inelastic->ei[ns * k + i];
  n->d.eigen = &x;
  domain_stress(&n->d, s->body.u, NULL, n->sigma);
  n->d.eigen = NULL;
  return OK;
}

/* ---- the effects -------------------------------------------------------- */

static status measure_thermal(reduction *n, const state *s, double *sum,
                              double *norm, double *stress) {
  double now = 0.0, change = 0.0;
  int ns = n->m->ns;
  *stress = 0.0;
  PASS(load_temperature(n->m, n->msh, &n->m->steps[s->step_no - 1], s->t, n->T0,
                        n->T));
  for (int e = 0; e < n->msh->n_elem; ++e) {
    double strain[6] = {0.0}, moved[6] = {0.0}, own, none;
    const material *mat = reduction_material(n, e);
    if (!mat->expand.given) continue;
    double w = element_weight(&n->d, e);
    expansion_strain(&mat->expand, n->T[e], n->T0[e], strain);
    for (int i = 0; i < 3; ++i) {
      moved[i] = strain[i] - n->heat[ns * e + i];
      n->heat[ns * e + i] = strain[i];
    }
    now += w * energy_of(n, e, strain, &own);
    change += w * energy_of(n, e, moved, &none);
    *stress = fmax(*stress, own);
  }
  *sum += sqrt(change);
  *norm = n->m->effects & EFFECT_FRICTION ? SAFETY * *sum : sqrt(now);
  return OK;
}

/*
 * The law at its end, e^i = R sigma. Where that moves by d(R sigma) in an
 * increment, the strain lags behind by what is left of
 *   lag = (lag_old + d(R sigma)) exp(-dt/time), at most / (1 + dt/time),
 * which an implicit Euler step has exactly; not at all where the law does not
 * flow, nor where a load is applied at once (dt = 0).
 */
static void measure_relaxed(reduction *n, const omitted *row, double dt,
                            double *norm, double *stress) {
  const int ns = n->m->ns;
  const material *mat = &n->m->materials[row->id];
  const double left = 1.0 / (1.0 + dt / row->time);
  double sum = 0.0;
  *stress = 0.0;
  for (int e = 0; e < n->msh->n_elem; ++e) {
    double ended[6], own;
    double *before = n->flow.strain_rate + (size_t)(ns * e);
    double *lag = n->flow.strain + (size_t)(ns * e);
    if (!reduction_is_about(n, row, e)) continue;
    tensor_product(ns, mat->relaxed, n->sigma + (size_t)(ns * e), ended);
    for (int i = 0; i < ns; ++i) {
      lag[i] = left * (lag[i] - (ended[i] - before[i]));
      before[i] = ended[i];
    }
    sum += element_weight(&n->d, e) * energy_of(n, e, lag, &own);
    *stress = fmax(*stress, SAFETY * own);
  }
  *norm = SAFETY * sqrt(sum);
}

/* Rates of one material under the current stresses: their norm; n->stress of
 * its elements grows by dt. */
static status add_rates(reduction *n, const state *s, const omitted *row,
                        double dt, double *norm) {
  status st = OK;
  const material *mat = &n->m->materials[row->id];
  law_card law = mat->law;
  flow_kind kind = {0};
  double value[FLOW_VALUE_MAX], alpha_rate[FLOW_VALUE_MAX], sum = 0.0;
  static const double zero[FLOW_VALUE_MAX];
  int section_id = -1;
  if (row->some == 0) law.ops = mat->law_aside;
  for (int e = 0; e < n->msh->n_elem; ++e) {
    law_point p;
    double ei_rate[6] = {0.0}, stress;
    if (!reduction_is_about(n, row, e)) continue;
    if (section_id != n->m->elem_section[e]) {
      law_elastic elastic;
      section_id = n->m->elem_section[e];
      flow_kind_free(&kind);
      TRY(law_elastic_read(&mat->elastic, 0.0, n->kin[section_id], &elastic));
      TRY(flow_new_kind(&kind, &law, &elastic));
    }
    TRY(flow_coefficients(&kind, s->t, 0.0, value, &p));
    p.sigma = n->sigma + (size_t)n->m->ns * (size_t)e;
    p.ei = p.alpha = zero;
    law_rate(&p, ei_rate, alpha_rate);
    sum += element_weight(&n->d, e) * energy_of(n, e, ei_rate, &stress);
    n->flow.stress[e] += dt * fmax(stress, n->flow.rate[e]);
    n->flow.rate[e] = stress;
    for (int i = 0; i < n->m->ns; ++i) {
      double *before = &n->flow.strain_rate[n->m->ns * e + i];
      n->flow.strain[n->m->ns * e + i] += 0.5 * dt * (*before + ei_rate[i]);
      *before = ei_rate[i];
    }
  }
  *norm = sqrt(sum);
done:
  flow_kind_free(&kind);
  return st;
}

static status measure_inelastic(reduction *n, const state *s, int k,
                                double *norm, double *stress) {
  const omitted *row = &n->m->reduction.row[k];
  double now;
  int flows = n->m->steps[s->step_no - 1].kind == STEP_VISCO;
  if (row->time > 0.0) {
    measure_relaxed(n, row, flows ? s->dt : 0.0, norm, stress);
    return OK;
  }
  PASS(add_rates(n, s, row, flows ? s->dt : 0.0, &now));
  if (flows) n->sum[k] += s->dt * fmax(now, n->last[k]);
  n->last[k] = now;
  *norm = SAFETY * n->sum[k];
  *stress = 0.0;
  for (int e = 0; e < n->msh->n_elem; ++e)
    if (reduction_is_about(n, row, e))
      *stress = fmax(*stress, SAFETY * n->flow.stress[e]);
  return OK;
}

static void measure_friction(reduction *n, const state *s, double *sum,
                             double *norm) {
  const contact_surface *c = s->contacts.surface;
  const int sides = n->msh->dim - 1;
  double work = 0.0;
  for (int i = 0; c != NULL && i < c->n; ++i) {
    double slip = 0.0, p = -s->contacts.rc[c->dim * i];
    for (int k = 0; k < sides; ++k)
      slip = hypot(slip, s->contacts.slip[sides * i + k]);
    for (int k = 0; k < sides; ++k)
      n->way[sides * c->node_id[i] + k] += s->contacts.slip[sides * i + k];
    work += reduction_coefficient(n, s, i) * fmax(p, 0.0) * slip;
  }
  *sum += sqrt(work);
  *norm = SAFETY * *sum;
}

status reduction_measure(reduction *n, const state *s, omitted *rows) {
  double size = sqrt(2.0 * fmax(s->energy.strain, 0.0));
  PASS(reduction_stress(n, s));
  double scale = stress_scale(n, s);
  for (int k = 0; k < n->m->reduction.n; ++k) {
    double norm = 0.0, stress = 0.0;
    omitted *row = &rows[k];
    if (row->back) continue;
    if (row->bit == EFFECT_BIT_THERMAL)
      PASS(measure_thermal(n, s, &n->sum[k], &norm, &stress));
    if (row->bit == EFFECT_BIT_INELASTIC)
      PASS(measure_inelastic(n, s, k, &norm, &stress));
    if (row->bit == EFFECT_BIT_FRICTION)
      measure_friction(n, s, &n->sum[k], &norm);
    double bound = reduction_part(norm, size),
           local = reduction_part(stress, scale);
    PASS(reduction_again(n, s, k, bound, row));
    if (!(bound <= row->bound)) row->bound = bound;
    if (!(local <= row->local)) row->local = local;
    ++row->checked;
  }
  return OK;
}

static int reduction_holds(const model *m, const omitted *row) {
  return row->checked > 0 && row->bound <= reduction_share * m->reduction.tol &&
         row->local <= m->reduction.tol &&
         row->change <= 0.5 * m->reduction.tol;
}

int reduction_refuted(const model *m) {
  for (int k = 0; k < m->reduction.n; ++k)
    if (!m->reduction.row[k].back && m->reduction.row[k].checked > 0 &&
        !reduction_holds(m, &m->reduction.row[k]))
      return 1;
  return 0;
}

int reduction_take_back(model *m, int all) {
  int n = 0;
  for (int k = 0; k < m->reduction.n; ++k) {
    omitted *row = &m->reduction.row[k];
    if (row->back || (reduction_holds(m, row) && !all)) continue;
    row->back = 1;
    row->lost = all;
    ++n;
  }
  return n;
}
