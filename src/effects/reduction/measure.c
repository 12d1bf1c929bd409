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

enum { SAFETY = 2 };

/* a / b; 0 if a is 0. */
static double part_of(double a, double b) {
  return a == 0.0 ? 0.0 : b > 0.0 ? a / b : HUGE_VAL;
}

const material *reduction_material(const reduction *n, int elem_id) {
  const model *m = n->m;
  return &m->materials[m->sections[m->elem_section[elem_id]].material_id];
}

/* 1: the row leaves out the law of that element. */
static int is_about(const reduction *n, const omitted *row, int elem_id) {
  return reduction_material(n, elem_id) == &n->m->materials[row->id] &&
         (row->some == 0 || n->m->reduction.still[elem_id]);
}

/* Coefficient of the friction left out at contact node i. */
static double coefficient_of(const reduction *n, const state *s, int i) {
  const contact_surface *c = s->contacts.surface;
  const friction_rule *rule =
      friction_in_force(n->m, s->step_no - 1, c->contact_id[i]);
  double x[3] = {0.0, 0.0, 0.0};
  if (rule->aside == NULL) return 0.0;
  COPY(x, c->x + c->dim * i, c->dim);
  return quantity_value(&rule->card.value, x, s->t);
}

status reduction_new(const model *m, const mesh *msh, reduction **out) {
  const size_t strains = (size_t)m->ns * msh->n_elem;
  MAKES(reduction, n, out);
  n->m = m;
  n->msh = msh;
  n->d.mesh = msh;
  PASS(moduli_new(m, msh, NULL, &n->moduli));
  moduli_domain(&n->moduli, m, &n->d);
  PASS_NEW(n->fixed, msh->dim * msh->n_node);
  n->d.fixed = n->fixed;
  PASS_NEW(n->sigma, strains);
  PASS_NEW_REALS(msh->n_elem, &n->T0, &n->T);
  PASS_NEW_REALS(strains, &n->heat, &n->flow.strain, &n->flow.strain_rate,
                 &n->strain);
  PASS_NEW(n->elem_id, msh->n_elem);
  PASS_NEW(n->slip, (msh->dim - 1) * msh->n_node);
  PASS_NEW_REALS(msh->dim * msh->n_node, &n->force, &n->u);
  for (int e = 0; e < msh->n_elem; ++e) n->elem_id[e] = e;
  PASS_NEW_REALS(msh->n_elem, &n->flow.stress, &n->flow.rate);
  return load_temperature_initial(m, msh, n->T0);
}

/* ---- scales ------------------------------------------------------------- */

/* Largest contact pressure, or stress of an element, Pa. */
static double stress_scale(const reduction *n, const state *s) {
  double most = 0.0;
  const contact_surface *c = s->contacts.surface;
  for (int i = 0; c != NULL && i < c->n; ++i)
    if (c->area[i] > 0.0)
      most = fmax(most, -s->contacts.rc[c->dim * i] / c->area[i]);
  size_t size = (size_t)n->m->ns * n->msh->n_elem;
  if (most > 0.0) return most;
  return largest_entry(size, n->sigma);
}

/* e' E e of a strain; its largest stress into *stress. */
static double energy_of(const reduction *n, int elem_id, const double *e,
                        double *stress) {
  double held[6];
  element_stress(&n->d, elem_id, e, held);
  *stress = largest_entry(n->m->ns, held);
  return dot(n->m->ns, held, e);
}

status reduction_stress(reduction *n, const state *s) {
  const model *m = n->m;
  const int ns = m->ns, warm = (m->effects & EFFECT_THERMAL) != 0;
  const eigenstrain x = {n->msh->n_elem, n->elem_id, n->strain};
  if (warm)
    PASS(load_temperature(m, n->msh, &m->steps[s->step_no - 1], s->t, n->T0,
                          n->T));
  for (int e = 0; e < n->msh->n_elem; ++e) {
    double *own = n->strain + ns * e;
    CLEAR(own, ns);
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
      moved[i] = strain[i] - n->heat[n->m->ns * e + i];
      n->heat[n->m->ns * e + i] = strain[i];
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
    double *before = n->flow.strain_rate + ns * e;
    double *lag = n->flow.strain + ns * e;
    if (!is_about(n, row, e)) continue;
    tensor_product(ns, mat->relaxed, n->sigma + ns * e, ended);
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
  const material *mat = &n->m->materials[row->id];
  law_card law = mat->law;
  ENDS_BY(law_sample_free) law_sample x = {0};
  double alpha_rate[FLOW_VALUE_MAX], sum = 0.0;
  int section_id = -1;
  if (row->some == 0) law.ops = mat->law_aside;
  for (int e = 0; e < n->msh->n_elem; ++e) {
    double ei_rate[6] = {0.0}, stress;
    if (!is_about(n, row, e)) continue;
    if (section_id != n->m->elem_section[e]) {
      section_id = n->m->elem_section[e];
      PASS(law_sample_at(&mat->elastic, &law, n->moduli.kin[section_id], s->t,
                         &x));
    }
    x.p.sigma = n->sigma + (size_t)n->m->ns * e;
    law_rate(&x.p, ei_rate, alpha_rate);
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
  return OK;
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
    if (is_about(n, row, e))
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
      n->slip[sides * c->node_id[i] + k] += s->contacts.slip[sides * i + k];
    work += coefficient_of(n, s, i) * fmax(p, 0.0) * slip;
  }
  *sum += sqrt(work);
  *norm = SAFETY * *sum;
}

/*
 * The increment solved once more with an effect that is left out, with its
 * strains and forces at the current state: its change to first order, in
 * displacements, in the forces of the nodes and in their sums. The bounds above
 * are of energies; a slender body may move far for little energy, and friction
 * may be a small part of the forces.
 */

/* Strains of the row of the elements it is about into n->strain. */
static void take_strains(reduction *n, const omitted *row) {
  const int ns = n->m->ns, heat = row->bit == EFFECT_BIT_THERMAL;
  const double *from = heat ? n->heat : n->flow.strain;
  for (int e = 0; e < n->msh->n_elem; ++e) {
    const int own = heat || is_about(n, row, e);
    for (int i = 0; i < ns; ++i)
      n->strain[ns * e + i] = own ? from[ns * e + i] : 0.0;
  }
}

/* Friction at node i against a displacement: at most its limit, and the force
 * that returns the node alone, N. */
static double friction_force(const reduction *n, const state *s, int i,
                             double slip) {
  const contact_problem *cp = s->contacts.problem;
  const int k = cp->dim * i;
  double held = 0.0;
  for (int a = 1; a < cp->dim; ++a)
    held = fmax(held, contact_diagonal(cp, k + a));
  return fmin(coefficient_of(n, s, i) * fmax(-s->contacts.rc[k], 0.0),
              held * slip);
}

/* Friction against the displacement of each node into n->force, N. */
static void take_friction(reduction *n, const state *s) {
  const contact_surface *c = s->contacts.surface;
  const int sides = n->msh->dim - 1;
  for (int i = 0; c != NULL && i < c->n; ++i) {
    const double *slip = n->slip + sides * c->node_id[i];
    const double length = sides == 2 ? hypot(slip[0], slip[1]) : fabs(slip[0]);
    if (!(length > 0.0)) continue;
    const double force = friction_force(n, s, i, length);
    for (int a = 0; a < sides; ++a)
      surface_spread_row(c, i, a + 1, -(force * slip[a] / length), n->force);
  }
}

static void take_forces(reduction *n, const state *s, const omitted *row) {
  const eigenstrain x = {n->msh->n_elem, n->elem_id, n->strain};
  CLEAR(n->force, n->msh->dim * n->msh->n_node);
  if (row->bit == EFFECT_BIT_FRICTION) {
    take_friction(n, s);
    return;
  }
  take_strains(n, row);
  eigen_force(&n->d, &x, n->force);
}

/* Largest of a - b. */
static double distance(size_t n, const double *a, const double *b) {
  double most = 0.0;
  for (size_t i = 0; i < n; ++i) most = fmax(most, fabs(a[i] - b[i]));
  return most;
}

/* Of the nodes: largest normal and tangential force, sum of each direction of
 * all nodes. */
typedef struct force_sizes {
  double node[2], sum[3];
} force_sizes;

/* Of rc, or of rc - from. */
static force_sizes sizes_of(const contact_surface *c, const double *rc,
                            const double *from) {
  force_sizes f = {{0.0, 0.0}, {0.0, 0.0, 0.0}};
  for (int i = 0; i < c->n; ++i) {
    double side = 0.0;
    for (int a = 0; a < c->dim; ++a) {
      const int k = c->dim * i + a;
      const double value = rc[k] - (from != NULL ? from[k] : 0.0);
      f.sum[a] += value;
      if (a == 0) f.node[0] = fmax(f.node[0], fabs(value));
      if (a > 0) side = hypot(side, value);
    }
    f.node[1] = fmax(f.node[1], side);
  }
  return f;
}

/* The forces against those of the increment; of friction against its largest
 * so far. */
static double force_change(reduction *n, const state *s, const double *rc) {
  const force_sizes now = sizes_of(s->contacts.surface, s->contacts.rc, NULL);
  const force_sizes d = sizes_of(s->contacts.surface, rc, s->contacts.rc);
  double worst = part_of(d.node[0], now.node[0]);
  worst = fmax(worst, part_of(fabs(d.sum[0]), fabs(now.sum[0])));
  if (!(n->m->effects & EFFECT_FRICTION)) return worst;
  worst = fmax(worst, part_of(d.node[1], n->tangential));
  return fmax(worst, part_of(hypot(d.sum[1], d.sum[2]), n->total));
}

static void grow_scales(reduction *n, const state *s) {
  if (s->contacts.surface == NULL) return;
  const force_sizes now = sizes_of(s->contacts.surface, s->contacts.rc, NULL);
  n->tangential = fmax(n->tangential, now.node[1]);
  n->total = fmax(n->total, hypot(now.sum[1], now.sum[2]));
}

/* The increment with the effect of row k in force, where the row's "bound" now
 * has doubled since the last time or the step ends. */
static status solve_again(reduction *n, const state *s, int k, double bound,
                          omitted *row) {
  OWNED double *rc = NULL;
  int solved = 0;
  const size_t dofs = n->msh->dim * n->msh->n_node;
  grow_scales(n, s);
  if (row->bit == EFFECT_BIT_NONLOCAL || bound == 0.0) return OK;
  if (!s->end_of_step && bound <= 2.0 * n->seen[k]) return OK;
  n->seen[k] = fmax(bound, n->seen[k]);
  if (s->contacts.surface != NULL)
    PASS_NEW(rc, s->contacts.surface->dim * s->contacts.surface->n);
  take_forces(n, s, row);
  PASS(shadow_with(s->again, n->force, n->u, rc, &solved));
  double change = solved ? part_of(distance(dofs, n->u, s->body.u),
                                   largest_entry(dofs, s->body.u))
                         : HUGE_VAL;
  if (rc != NULL) change = fmax(change, force_change(n, s, rc));
  if (!(change <= row->change)) row->change = change;
  ++row->again;
  return OK;
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
    double bound = part_of(norm, size), local = part_of(stress, scale);
    PASS(solve_again(n, s, k, bound, row));
    if (!(bound <= row->bound)) row->bound = bound;
    if (!(local <= row->local)) row->local = local;
    ++row->checked;
  }
  return OK;
}

static int is_within(const model *m, const omitted *row) {
  return row->checked > 0 && row->bound <= reduction_share * m->reduction.tol &&
         row->local <= m->reduction.tol &&
         row->change <= 0.5 * m->reduction.tol;
}

int reduction_refuted(const model *m) {
  for (int k = 0; k < m->reduction.n; ++k)
    if (!m->reduction.row[k].back && m->reduction.row[k].checked > 0 &&
        !is_within(m, &m->reduction.row[k]))
      return 1;
  return 0;
}

int reduction_take_back(model *m, int all) {
  int n = 0;
  for (EACH(omitted, row, m->reduction.row, m->reduction.n)) {
    if (row->back || (is_within(m, row) && !all)) continue;
    row->back = 1;
    row->lost = all;
    ++n;
  }
  return n;
}
