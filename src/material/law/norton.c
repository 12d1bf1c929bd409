/*
 * Power law creep with the equivalent stress q and creep strain p:
 *   d(e^i)/dt = dp/dt 3/2 s/q
 *   HARDENING=TIME    dp/dt = A q^n t^m
 *   HARDENING=STRAIN  dp/dt = (A q^n ((m + 1) p)^m)^(1/(m + 1)),
 * the same under constant stress (Norton 1929; Abaqus, creep laws TIME and
 * STRAIN); -1 < m.
 *
 * STRAIN keeps w = p^(1/(m + 1)), whose rate (A q^n/(m + 1))^(1/(m + 1)) is
 * regular at p = 0. There, and at t = 0, m < 0 makes dp/dt infinite though its
 * integral is not: dp/dt is at most its mean over a step dt from there, which
 * is more than any later step of that length makes.
 */
#include "material/law/law.h"

#include <float.h>
#include <math.h>

typedef struct norton {
  int hardening;
} norton;
enum { TIME, STRAIN };

typedef struct norton_value {
  double A, n, m;
} norton_value;

/* clang-format off */
static const option options[] = {
  OPTION_CHOICE(norton, hardening, "HARDENING", "TIME|STRAIN", "TIME",
                "what slows the creep down if m < 0"),
  OPTION_END};
static const option fields[] = {
  OPTION_REAL(norton_value, A, "A", 0, DBL_MAX, NULL,
              "stress^-n time^-(1+m)", "factor"),
  OPTION_REAL(norton_value, n, "n", 1, 1000, NULL, "-",
              "exponent of the equivalent stress"),
  OPTION_REAL(norton_value, m, "m", -0.99, 100, "0", "-",
              "exponent of hardening, in general from -1 to 0"),
  OPTION_END};
/* clang-format on */

static const norton_value *values(const law_point *p) {
  return (const norton_value *)(const void *)p->value;
}

static int hardening_of(const law_point *p) {
  return ((const norton *)p->law->param)->hardening;
}

/* (A q^n)^k without overflow in between. */
static double power_law(const norton_value *v, double q, double k) {
  return pow(pow(v->A, 1 / v->n) * q, v->n * k);
}

typedef struct creep {
  double rate;   /* dp/dt, 1/s */
  double n;      /* d(rate)/dq = n rate/q */
  double w_rate; /* of STRAIN, d(w_rate)/dq = n_w w_rate/q */
  double n_w;
  int follows_w; /* 0: its mean over the step */
} creep;

static creep strain_hardening(const law_point *p, double q) {
  const norton_value *v = values(p);
  const double k = 1 / (1 + v->m), w = fmax(p->alpha[0], 0);
  creep c = {.n = v->n * k, .n_w = v->n * k};
  c.w_rate = power_law(v, q, k) * pow(k, k);
  const double mean = pow(c.w_rate, 1 + v->m) * pow(p->dt, v->m);
  if (c.w_rate > 0) c.rate = (1 + v->m) * pow(w, v->m) * c.w_rate;
  c.follows_w = !(v->m < 0 && c.rate > mean);
  if (!c.follows_w) c.rate = mean;
  if (!c.follows_w) c.n = v->n;
  return c;
}

static creep creep_of(const law_point *p, double q) {
  const norton_value *v = values(p);
  if (hardening_of(p) == STRAIN) return strain_hardening(p, q);
  creep c = {.rate = power_law(v, q, 1), .n = v->n};
  if (v->m == 0 || !(c.rate > 0)) return c;
  const double mean = pow(p->dt, v->m) / (1 + v->m);
  const double slowed = pow(p->t, v->m);
  c.rate *= v->m < 0 && slowed > mean ? mean : slowed;
  return c;
}

/* Slope of rate c(q) q^n; in q = 0 its limit if that is finite, else 0. */
static double slope(double rate, double q, double n, double rate_of_one) {
  if (q > 0) return n * rate / q;
  return n == 1 ? rate_of_one : 0;
}

static int n_alpha(const law_card *law, int ns) {
  (void)ns;
  return ((const norton *)law->param)->hardening == STRAIN;
}

static void rate(const law_point *p, double *ei_rate, double *alpha_rate) {
  const int ns = p->elastic->ns;
  double n[6];
  const double q = tensor_flow(ns, p->sigma, n);
  if (!(q > 0)) return;
  const creep c = creep_of(p, q);
  for (int i = 0; i < ns; ++i) ei_rate[i] = c.rate * n[i];
  if (hardening_of(p) == STRAIN) alpha_rate[0] = c.w_rate;
}

static void jacobian(const law_point *p, law_jacobian *j) {
  const int ns = p->elastic->ns;
  double n[6];
  const double q = tensor_flow(ns, p->sigma, n);
  const creep c = creep_of(p, q), one = creep_of(p, 1);
  tensor_add_flow(ns, n, q > 0 ? c.rate / q : slope(0, 0, c.n, one.rate),
                  slope(c.rate, q, c.n, one.rate), j->ei_sigma, ns);
  if (hardening_of(p) != STRAIN || !(q > 0)) return;
  const double w = p->alpha[0];
  for (int i = 0; i < ns; ++i) {
    j->alpha_sigma[i] = slope(c.w_rate, q, c.n_w, 0) * n[i];
    if (c.follows_w && w > 0) j->ei_alpha[i] = values(p)->m * c.rate / w * n[i];
  }
}

/*
 * Held strain: a change along n decays with 3 G d(rate)/dq, one across with
 * 3 G rate/q; with STRAIN the first is coupled with w by a 2x2 matrix.
 */
static double fastest_rate(const law_point *p) {
  const double shear = p->elastic->shear;
  double n[6];
  const double q = tensor_flow(p->elastic->ns, p->sigma, n);
  const creep c = creep_of(p, q), one = creep_of(p, 1);
  const double radial = 3 * shear * slope(c.rate, q, c.n, one.rate);
  const double turning =
      q > 0 ? 3 * shear * c.rate / q : 3 * shear * slope(0, 0, c.n, one.rate);
  double rate_w = radial;
  if (hardening_of(p) == STRAIN && q > 0 && c.follows_w && p->alpha[0] > 0) {
    /* [-radial, b; -d, 0] on (strain along n, w) */
    const double b = values(p)->m * c.rate / p->alpha[0];
    const double d = 3 * shear * slope(c.w_rate, q, c.n_w, 0);
    const double root = radial * radial / 4 - b * d;
    rate_w = root >= 0 ? radial / 2 + sqrt(root) : sqrt(b * d);
  }
  return fmax(rate_w, turning);
}

static double dissipation(const law_point *p) {
  double n[6];
  const double q = tensor_flow(p->elastic->ns, p->sigma, n);
  return q > 0 ? q * creep_of(p, q).rate : 0;
}

/* clang-format off */
const law_ops norton_law = {
  .name = "NORTON",
  .reference = "Norton 1929; Abaqus, creep laws TIME and STRAIN",
  .help = "power law creep, with time or strain hardening",
  .example = "1E-15, 5., -0.3",
  .param_size = sizeof(norton), .options = options, .fields = fields,
  .n_alpha = n_alpha, .rate = rate, .jacobian = jacobian,
  .fastest_rate = fastest_rate, .dissipation = dissipation};
/* clang-format on */
