/*
 * Creep by a hyperbolic sine of the equivalent stress q (Garofalo 1963; the
 * creep law HYPERB of Abaqus):
 *   dp/dt = A sinh(B q)^n exp(-dH/(R (T - T_ZERO))),  d(e^i)/dt = dp/dt 3/2 s/q
 * with the absolute zero T_ZERO of the card. The power law at small stresses,
 * an exponential at large ones.
 */
#include "material/law/law.h"

#include <float.h>
#include <math.h>

typedef struct hyperbolic_value {
  double A, B, n, dH, R;
} hyperbolic_value;

/* clang-format off */
static const option fields[] = {
  OPTION_REAL(hyperbolic_value, A, "A", 0, DBL_MAX, NULL, "1/time",
              "factor"),
  OPTION_REAL(hyperbolic_value, B, "B", DBL_MIN, DBL_MAX, NULL,
              "length^2/force", "1/B: stress at which the power law ends"),
  OPTION_REAL(hyperbolic_value, n, "n", 1, 1000, NULL, "-",
              "exponent of the hyperbolic sine"),
  OPTION_REAL(hyperbolic_value, dH, "dH", 0, DBL_MAX, "0", "unit of R T",
              "activation energy"),
  OPTION_REAL(hyperbolic_value, R, "R", DBL_MIN, DBL_MAX, "8.314462618",
              "dH/temperature", "gas constant"),
  OPTION_END};
/* clang-format on */

static const hyperbolic_value *values(const law_point *p) {
  return (const hyperbolic_value *)(const void *)p->value;
}

/* dH/(R T) with the absolute temperature; infinite at absolute zero. */
static double exponent(const law_point *p) {
  const hyperbolic_value *v = values(p);
  const double T = p->temperature - p->law->shift.zero;
  if (v->dH == 0) return 0;
  return T > 0 ? v->dH / v->R / T : HUGE_VAL;
}

/* log(sinh(x)), x > 0, without overflow. */
static double log_sinh(double x) {
  if (x < 1) return log(sinh(x));
  return x + log1p(-exp(-2 * x)) - log(2);
}

/* dp/dt; its slope in q. In q = 0 the limit of the slope, zero if n > 1. */
static double rate_of(const law_point *p, double q, double *slope) {
  const hyperbolic_value *v = values(p);
  *slope = 0;
  if (!(v->A > 0)) return 0;
  const double scale = log(v->A) - exponent(p);
  if (!(q > 0)) {
    if (v->n == 1) *slope = v->B * exp(scale);
    return 0;
  }
  const double rate = exp(scale + v->n * log_sinh(v->B * q));
  *slope = v->n * v->B / tanh(v->B * q) * rate;
  return rate;
}

static void rate(const law_point *p, double *ei_rate, double *alpha_rate) {
  double n[6], slope;
  const double q = tensor_flow(p->elastic->ns, p->sigma, n);
  const double size = rate_of(p, q, &slope);
  (void)alpha_rate;
  for (int i = 0; i < p->elastic->ns; ++i) ei_rate[i] = size * n[i];
}

static void jacobian(const law_point *p, law_jacobian *j) {
  const int ns = p->elastic->ns;
  double n[6], slope;
  const double q = tensor_flow(ns, p->sigma, n);
  const double size = rate_of(p, q, &slope);
  tensor_add_flow(ns, n, q > 0 ? size / q : slope, slope, j->ei_sigma, ns);
}

/* Held strain: along n 3 G times the slope, which is not below rate/q, the one
 * across. */
static double fastest_rate(const law_point *p) {
  double n[6], slope;
  rate_of(p, tensor_flow(p->elastic->ns, p->sigma, n), &slope);
  return 3 * p->elastic->shear * slope;
}

static int flows(const law_point *p) {
  double n[6], slope;
  return rate_of(p, tensor_flow(p->elastic->ns, p->sigma, n), &slope) > 0;
}

static double dissipation(const law_point *p) {
  double n[6], slope;
  const double q = tensor_flow(p->elastic->ns, p->sigma, n);
  return q * rate_of(p, q, &slope);
}

/* dH is the fourth field of every set. */
static int is_warm(const law_card *law) {
  int warm = 0;
  for (int i = 0; i < law->n_set; ++i) {
    const quantity *dH = &law->value[i * law_n_value(law) + 3];
    warm |= dH->formula != NULL || dH->number > 0;
  }
  return warm;
}

/* clang-format off */
const law_ops hyperbolic_law = {
  .name = "HYPERBOLIC",
  .reference = "Garofalo 1963; Abaqus, creep law HYPERB",
  .help = "creep by a hyperbolic sine of the stress and an Arrhenius factor",
  .example = "1E-3, 0.02, 3.",
  .fields = fields, .is_warm = is_warm, .rate = rate, .jacobian = jacobian,
  .fastest_rate = fastest_rate, .flows = flows, .dissipation = dissipation};
/* clang-format on */
