/*
 * Points whose law flows, before anything is solved: inelastic strains, those
 * of the units of their laws; temperatures of the steps in which they flow.
 */
#include "base/number.h"
#include "model/facts.h"
#include "run/visco.h"

/* ---- temperatures -------------------------------------------------------- */

/* 1: rates of some law depend on the absolute temperature. */
static int counts_from_zero(const flow *x) {
  for (int i = 0; i < x->n_kind; ++i)
    if (law_too_cold(x->kind[i].law, -HUGE_VAL) != NULL) return 1;
  return 0;
}

/* The first point that is too cold, with temperatures T[n_elem] at a time. */
static status check_cold(const run *r, int step_id, double t, const double *T) {
  const visco *v = r->strains.visco;
  for (int k = 0; k < v->x.n; ++k) {
    const law_card *law = v->x.kind[v->x.kind_id[k]].law;
    const char *wrong = law_too_cold(law, T[v->elem[k]]);
    if (wrong == NULL) continue;
    message_add(r->m->log, P2062, &law->at,
                "material %s, step %d, time %g, element %zu: %s", law->material,
                step_id + 1, t, r->msh->elem_no[v->elem[k]], wrong);
    return message_status(r->m->log, ERR_DECK);
  }
  return OK;
}

/* Temperatures are between those of the ends of the step, or expressions. */
static status check_temperatures(const run *r) {
  const double *T0 = r->strains.temperature0;
  if (!counts_from_zero(&r->strains.visco->x)) return OK;
  OWNED_NEW(double, T, r->msh->n_elem);
  for (int i = 0; i < 2 * r->m->n.step; ++i) {
    const step *s = &r->m->steps[i / 2];
    const double t = s->start + (i % 2) * s->total;
    if (s->kind != STEP_VISCO) continue;
    if (T0 != NULL) PASS(load_temperature(r->m, r->msh, s, t, T0, T));
    PASS(check_cold(r, i / 2, t, T));
  }
  return OK;
}

/* ---- strains of units ---------------------------------------------------- */

enum { STRAIN_GIVEN = 1, UNITS_GIVEN = 2 };

/* What the deck gives of each point, bits[x.n]. */
static void find_given(const run *r, unsigned char *bits) {
  const visco *v = r->strains.visco;
  for (EACH(const initial, c, r->m->initial.lines, r->m->n.initial)) {
    if (c->type != INITIAL_STRAIN && c->type != INITIAL_INTERNAL) continue;
    const mesh_group *g = &r->msh->group[c->group_id];
    for (int k = 0; k < g->n_item; ++k) {
      const int point = number_find(g->item_id[k], v->elem, v->x.n);
      if (point < 0) continue;
      bits[point] |= c->type == INITIAL_STRAIN ? STRAIN_GIVEN : UNITS_GIVEN;
    }
  }
}

/* The last line that gives the inelastic strain of an element. */
static const initial *line_of(const run *r, int elem_id) {
  for (int i = r->m->n.initial - 1; i >= 0; --i) {
    const initial *c = &r->m->initial.lines[i];
    const mesh_group *g = &r->msh->group[c->group_id];
    if (c->type != INITIAL_STRAIN) continue;
    for (int k = 0; k < g->n_item; ++k)
      if (g->item_id[k] == elem_id) return c;
  }
  return NULL;
}

/* The strain that the units make instead of what the deck gives, if these are
 * equal to the digits of a deck; an error in the log otherwise. */
static status take_sum(const run *r, int k, const double *sum) {
  static const double digits = 1e-6;
  const visco *v = r->strains.visco;
  double *ei = v->old.ei + visco_at(r, k), most = 0.0;
  for (int i = 0; i < r->m->ns; ++i)
    most = fmax(most, fmax(fabs(ei[i]), fabs(sum[i])));
  for (int i = 0; i < r->m->ns; ++i) {
    const law_card *law = v->x.kind[v->x.kind_id[k]].law;
    if (fabs(ei[i] - sum[i]) <= digits * most) continue;
    message_add(r->m->log, P2063, &line_of(r, v->elem[k])->at,
                "*INITIAL CONDITIONS: component %d of the inelastic strain of "
                "element %zu is %.9g, but the units of law %s of material %s, "
                "TYPE=INTERNAL, make %.9g",
                i + 1, r->msh->elem_no[v->elem[k]], ei[i], law->ops->name,
                law->material, sum[i]);
    return message_status(r->m->log, ERR_DECK);
  }
  COPY(ei, sum, visco_at(r, 1));
  return OK;
}

/* Strain and units of a point, of which the deck gives some. */
static status settle_point(const run *r, int k, unsigned given) {
  const visco *v = r->strains.visco;
  flow_kind *kind = &v->x.kind[v->x.kind_id[k]];
  const law_ops *ops = kind->law->ops;
  const double *T = r->strains.temperature0;
  double value[FLOW_VALUE_MAX], sum[6] = {0};
  double *ei = v->old.ei + visco_at(r, k);
  double *alpha = v->old.alpha + v->x.alpha_at[k];
  law_point p;
  if (ops->units == NULL || given == 0) return OK;
  PASS(
      flow_coefficients(kind, 0.0, T == NULL ? 0.0 : T[v->elem[k]], value, &p));
  p.ei = ei;
  p.alpha = alpha;
  const int dashpot = ops->units(&p, given == STRAIN_GIVEN ? alpha : NULL, sum);
  if ((given & STRAIN_GIVEN) == 0)
    COPY(ei, sum, visco_at(r, 1));
  else if (!dashpot)
    PASS(take_sum(r, k, sum));
  return OK;
}

static status settle_units(const run *r) {
  visco *v = r->strains.visco;
  if (!facts_starts_strained(r->m)) return OK;
  OWNED_NEW(unsigned char, given, v->x.n);
  find_given(r, given);
  for (int k = 0; k < v->x.n; ++k) PASS(settle_point(r, k, given[k]));
  flow_state_copy(&v->x, &v->old, &v->now);
  return OK;
}

status setup_flow(const run *r) {
  if (r->strains.visco == NULL) return OK;
  PASS(settle_units(r));
  return check_temperatures(r);
}
