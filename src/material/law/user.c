/*
 * Creep by a formula of the deck: dp/dt = f(q, p, temp, t), not negative, with
 * the equivalent stress q, the creep strain p = alpha[0], the temperature and
 * the time; d(e^i)/dt = dp/dt 3/2 s/q.
 *
 * The slopes of f are central differences of order 4, of relative error 1e-12
 * or so for powers; the rates themselves are exact.
 */
#include "material/law/law.h"

#include <math.h>

const char *const law_formula_names[4] = {"Q", "P", "TEMP", "T"};

static int n_alpha(const law_card *law, int ns) {
  (void)law;
  (void)ns;
  return 1;
}

/* The formula; negative values count as zero, no number stays none. */
static double formula(const law_point *point, double q, double p) {
  const double x[3] = {q, p, point->temperature};
  const double f = expression_value(point->law->formula, x, point->t);
  return f < 0 ? 0 : f;
}

/* Slope in q (which = 0) or p (which = 1) with the step h. */
static double slope(const law_point *point, double q, double p, int which,
                    double h) {
  double f[4];
  static const double at[] = {-2, -1, 1, 2};
  for (int i = 0; i < 4; ++i)
    f[i] = formula(point, q + (which == 0 ? at[i] * h : 0),
                   p + (which == 1 ? at[i] * h : 0));
  return (8 * (f[2] - f[1]) - (f[3] - f[0])) / (12 * h);
}

static const double step = 1e-3; /* of q, and of p or the elastic strain */

static double slope_q(const law_point *p, double q) {
  return slope(p, q, p->alpha[0], 0, step * q);
}

static double slope_p(const law_point *p, double q) {
  const double scale = fmax(p->alpha[0], q / p->elastic->young);
  return slope(p, q, p->alpha[0], 1, step * scale);
}

/* Equivalent stress and direction of flow. */
static double direction(const law_point *p, double *n) {
  return tensor_flow(p->elastic->ns, p->sigma, n);
}

static void rate(const law_point *p, double *ei_rate, double *alpha_rate) {
  double n[6];
  const double q = direction(p, n);
  if (!(q > 0)) return;
  alpha_rate[0] = formula(p, q, p->alpha[0]);
  for (int i = 0; i < p->elastic->ns; ++i) ei_rate[i] = alpha_rate[0] * n[i];
}

static void jacobian(const law_point *p, law_jacobian *j) {
  const int ns = p->elastic->ns;
  double n[6];
  const double q = direction(p, n);
  if (!(q > 0)) return;
  const double by_q = slope_q(p, q), by_p = slope_p(p, q);
  tensor_add_flow(ns, n, formula(p, q, p->alpha[0]) / q, by_q, j->ei_sigma, ns);
  for (int i = 0; i < ns; ++i) {
    j->ei_alpha[i] = by_p * n[i];
    j->alpha_sigma[i] = by_q * n[i];
  }
  j->alpha_alpha[0] = by_p;
}

/* Held strain: (e^i along n, p) has the rates -3 G f_q + f_p and 0. */
static double fastest_rate(const law_point *p) {
  double n[6];
  const double q = direction(p, n), shear = 3 * p->elastic->shear;
  if (!(q > 0)) return 0;
  return fmax(fabs(shear * slope_q(p, q) - slope_p(p, q)),
              shear * formula(p, q, p->alpha[0]) / q);
}

static int flows(const law_point *p) {
  double n[6];
  const double q = direction(p, n);
  return q > 0 && formula(p, q, p->alpha[0]) != 0;
}

static double dissipation(const law_point *p) {
  double n[6];
  const double q = direction(p, n);
  return q > 0 ? q * formula(p, q, p->alpha[0]) : 0;
}

/* clang-format off */
const law_ops user_law = {
  .name = "USER", .reference = "rate from the deck",
  .help = "creep of which the rate of strain is a formula of q, p, temp, t",
  .example = "\"2E-15*q^5/(1 + 100*p)\"",
  .needs_formula = 1, .n_alpha = n_alpha, .rate = rate, .jacobian = jacobian,
  .fastest_rate = fastest_rate, .flows = flows, .dissipation = dissipation};
/* clang-format on */
