/*
 * Points whose law flows: their state, rates, limits and norms.
 */
#include "material/scheme/work.h"

#include "base/base.h"
#include "material/voigt.h"

status flow_new_kind(flow_kind *k, const law_card *law,
                     const law_elastic *elastic) {
  k->law = law;
  k->elastic = *elastic;
  k->n_alpha = law_n_alpha(law, elastic->ns);
  k->varies = law_varies(law);
  if (elastic->table != NULL) k->varies |= LAW_VARIES_TEMPERATURE;
  if (law_n_value(law) > FLOW_VALUE_MAX ||
      elastic->ns + k->n_alpha > FLOW_VALUE_MAX)
    RAISE(ERR_DECK, "law %s: more than %d coefficients or internal variables",
          law->ops->name, FLOW_VALUE_MAX);
  PASS_NEW(k->value, law_n_value(law));
  k->speed = 1.0;
  if (k->varies == 0) PASS(law_values(law, 0.0, 0.0, k->value));
  return OK;
}

status flow_new_points(flow *x, int n, const int *kind_id) {
  x->n = n;
  PASS_NEW_ALL(OF(x->kind_id, n), OF(x->alpha_at, n + 1), OF(x->weight, n),
               OF(x->tally, 1));
  for (int k = 0; k < n; ++k) {
    int n_alpha = x->kind[kind_id[k]].n_alpha;
    x->kind_id[k] = kind_id[k];
    x->alpha_at[k + 1] = x->alpha_at[k] + n_alpha;
    if (n_alpha > x->most_alpha) x->most_alpha = n_alpha;
  }
  return OK;
}

static size_t components(const flow *x) { return (size_t)x->ns * x->n; }

status flow_state_new(const flow *x, flow_state *s) {
  PASS_NEW_ALL(OF(s->e, components(x)), OF(s->ei, components(x)),
               OF(s->sigma, components(x)), OF(s->alpha, x->alpha_at[x->n]),
               OF(s->temperature, x->n));
  return OK;
}

void flow_state_copy(const flow *x, const flow_state *from, flow_state *to) {
  to->t = from->t;
  COPY(to->e, from->e, components(x));
  COPY(to->ei, from->ei, components(x));
  COPY(to->sigma, from->sigma, components(x));
  COPY(to->alpha, from->alpha, x->alpha_at[x->n]);
  COPY(to->temperature, from->temperature, x->n);
}

status flow_heat(flow_kind *kind, double temperature) {
  law_elastic *el = &kind->elastic;
  if (el->table == NULL || el->temperature == temperature) return OK;
  return law_elastic_read(el->table, temperature, el->kin, el);
}

void law_sample_free(law_sample *x) { FORGET(x->kind.value); }

status law_sample_at(const elastic_table *elastic, const law_card *law,
                     kinematics kin, double t, law_sample *x) {
  static const double zero[FLOW_VALUE_MAX];
  law_elastic e;
  law_sample_free(x);
  PASS(law_elastic_read(elastic, 0.0, kin, &e));
  PASS(flow_new_kind(&x->kind, law, &e));
  PASS(flow_coefficients(&x->kind, t, 0.0, x->value, &x->p));
  x->p.ei = x->p.alpha = zero;
  return OK;
}

status flow_coefficients(flow_kind *kind, double t, double temperature,
                         double *value, law_point *p) {
  PASS(flow_heat(kind, temperature));
  *p = flow_kind_point(kind);
  p->t = t;
  p->temperature = temperature;
  if (kind->varies != 0) {
    PASS(law_values(kind->law, t, temperature, value));
    p->value = value;
    p->speed = law_speed(kind->law, temperature);
  }
  return OK;
}

status flow_at_point(flow_kind *kind, double t, double temperature,
                     double *value, law_point *p) {
  const char *wrong = kind->varies & LAW_VARIES_TEMPERATURE
                          ? law_too_cold(kind->law, temperature)
                          : NULL;
  if (wrong != NULL)
    RAISE(ERR_DECK, LAW_FORM "time %g: %s", LAW_ARGS(kind->law), t, wrong);
  return flow_coefficients(kind, t, temperature, value, p);
}

/* Point k of a state into p. */
static void take_state(const flow *x, int k, const flow_state *s,
                       law_point *p) {
  size_t at = (size_t)x->ns * k;
  p->sigma = s->sigma + at;
  p->ei = s->ei + at;
  p->alpha = s->alpha + x->alpha_at[k];
}

/* Point k of a state for the law. */
static status flow_point(const flow *x, int k, const flow_state *s, double dt,
                         double *value, law_point *p) {
  PASS(flow_at_point(&x->kind[x->kind_id[k]], s->t, s->temperature[k], value,
                     p));
  p->dt = dt;
  take_state(x, k, s, p);
  return OK;
}

int flow_goes_on(const flow *x, const law_point *p) {
  const int goes = law_flows(p);
  if (p->law->ops->flows == NULL) return goes;
  ++x->tally->asked;
  if (!goes) ++x->tally->resting;
  return goes;
}

status flow_rates(const flow *x, const flow_state *s, double dt,
                  double *ei_rate, double *alpha_rate, double *power) {
  double value[FLOW_VALUE_MAX];
  *power = 0.0;
  CLEAR(ei_rate, components(x));
  CLEAR(alpha_rate, x->alpha_at[x->n]);
  for (int k = 0; k < x->n; ++k) {
    law_point p;
    PASS(flow_point(x, k, s, dt, value, &p));
    if (!flow_goes_on(x, &p)) continue;
    law_rate(&p, ei_rate + (size_t)x->ns * k, alpha_rate + x->alpha_at[k]);
    *power += x->weight[k] * law_dissipation(&p);
  }
  return OK;
}

status flow_turning(const flow *x, const flow_state *old, const flow_state *now,
                    double *d) {
  double value[2][FLOW_VALUE_MAX];
  const double dt = now->t - old->t;
  OWNED_NEW(double, alpha_rate, x->alpha_at[x->n]);
  for (int k = 0; k < x->n; ++k) {
    const size_t at = (size_t)x->ns * k;
    law_point from, to;
    if (x->kind[x->kind_id[k]].law->ops->flows == NULL) continue;
    PASS(flow_point(x, k, old, dt, value[0], &from));
    const int flowed = law_flows(&from);
    PASS(flow_point(x, k, now, dt, value[1], &to));
    if (law_flows(&to) == flowed) continue;
    if (flowed) PASS(flow_point(x, k, old, dt, value[0], &from));
    law_rate(flowed ? &from : &to, d + at, alpha_rate + x->alpha_at[k]);
    for (size_t i = at; i < at + x->ns; ++i)
      d[i] = 0.5 * dt * d[i] - now->ei[i] + old->ei[i];
  }
  return OK;
}

status flow_fastest(const flow *x, const flow_state *s, double dt,
                    double *rate) {
  double value[FLOW_VALUE_MAX];
  const int constant = flow_is_constant(x);
  *rate = 0.0;
  for (int k = 0, last = -1; k < x->n; ++k) {
    law_point p;
    double own;
    if (constant && x->kind_id[k] == last) continue; /* the same rate */
    last = x->kind_id[k];
    PASS(flow_point(x, k, s, dt, value, &p));
    PASS(law_fastest_rate(&p, &own));
    *rate = fmax(*rate, own);
  }
  return OK;
}

status flow_add_stored(const flow *x, const flow_state *s, int from, int to,
                       double *energy) {
  double value[FLOW_VALUE_MAX];
  for (int k = from; k < to; ++k) {
    law_point p;
    flow_kind *kind = &x->kind[x->kind_id[k]];
    if (kind->law->ops->stored == NULL) continue;
    PASS(flow_coefficients(kind, s->t, s->temperature[k], value, &p));
    take_state(x, k, s, &p);
    *energy += x->weight[k] * law_stored(&p);
  }
  return OK;
}

double flow_root(const flow *x, double sum) {
  double volume = 0.0;
  for (int k = 0; k < x->n; ++k) volume += x->weight[k];
  return volume > 0.0 ? sqrt(sum / volume) : 0.0;
}

double flow_norm(const flow *x, const double *v) {
  double sum = 0.0;
  for (int k = 0; k < x->n; ++k) {
    const double *own = v + (size_t)x->ns * k;
    sum += x->weight[k] * voigt_strain_square(x->ns, own);
  }
  return flow_root(x, sum);
}

status flow_add_elastic(const flow *x, const flow_state *s, int from, int to,
                        double *sum) {
  for (int k = from; k < to; ++k) {
    flow_kind *kind = &x->kind[x->kind_id[k]];
    const size_t at = (size_t)x->ns * k;
    double e[6] = {0};
    for (int i = 0; i < x->ns; ++i) e[i] = s->e[at + i] - s->ei[at + i];
    if (kind->elastic.plane_stress) { /* zz: from the stress alone */
      PASS(flow_heat(kind, s->temperature[k]));
      voigt_product(x->ns, kind->elastic.S, s->sigma + at, e);
    }
    *sum += x->weight[k] * voigt_strain_square(x->ns, e);
  }
  return OK;
}

int flow_is_constant(const flow *x) {
  for (int i = 0; i < x->n_kind; ++i)
    if (x->kind[i].varies != 0 || !x->kind[i].law->ops->linear) return 0;
  return 1;
}

void sum_scaled(size_t n, const double *x, double a, const double *v,
                double *y) {
  for (size_t i = 0; i < n; ++i) y[i] = x[i] + a * v[i];
}

status need(scheme_work *w, double **array, size_t n) {
  OWNS(w);
  if (*array == NULL) PASS_NEW(*array, n);
  return OK;
}
