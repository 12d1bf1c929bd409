/*
 * Creep of equivalent stress q and strain p, d(e^i)/dt = dp/dt 3/2 s/q:
 *   NORTON      HARDENING=TIME    dp/dt = A q^n t^m
 *               HARDENING=STRAIN  dp/dt = (A q^n ((m + 1) p)^m)^(1/(m + 1)),
 *               the same under constant stress (Norton 1929; Abaqus, creep laws
 *               TIME and STRAIN); -1 < m
 *   HYPERBOLIC  dp/dt = A sinh(B q)^n exp(-dH/(R (T - T_ZERO))) with the
 *               absolute zero T_ZERO of the card (Garofalo 1963; the creep law
 *               HYPERB of Abaqus): the power law at small stresses, an
 *               exponential at large ones
 *   USER        dp/dt = f(q, p, temp, t), not negative, a formula of the deck
 *
 * STRAIN keeps w = p^(1/(m + 1)), whose rate (A q^n/(m + 1))^(1/(m + 1)) is
 * regular at p = 0. There, and at t = 0, m < 0 makes dp/dt infinite though its
 * integral is not: dp/dt is at most its mean over a step dt from there, which
 * is more than any later step of that length makes.
 *
 * The slopes of f are central differences of order 4, of relative error 1e-12
 * or so for powers; the rates themselves are exact.
 */
#include "material/law/law.h"

#include "base/base.h"

const char *const law_formula_names[4] = {"Q", "P", "TEMP", "T"};

typedef struct norton {
  int hardening;
} norton;
enum { TIME, STRAIN };

typedef struct norton_value {
  double A, n, m;
} norton_value;
typedef struct hyperbolic_value {
  double A, B, n, dH, R;
} hyperbolic_value;

OPTIONS(norton_options,
        OPTION_CHOICE(norton, hardening, "HARDENING", "TIME|STRAIN", "TIME",
                      "what slows the creep down if m < 0"));
OPTIONS(norton_fields,
        OPTION_REAL(norton_value, A, "A", 0, DBL_MAX, NULL,
                    "stress^-n time^-(1+m)", "factor"),
        OPTION_REAL(norton_value, n, "n", 1, 1000, NULL, "-",
                    "exponent of the equivalent stress"),
        OPTION_REAL(norton_value, m, "m", -0.99, 1, "0", "-",
                    "exponent of hardening, in general from -1 to 0"));
OPTIONS(hyperbolic_fields,
        OPTION_REAL(hyperbolic_value, A, "A", 0, DBL_MAX, NULL, "1/time",
                    "factor"),
        OPTION_REAL(hyperbolic_value, B, "B", DBL_MIN, DBL_MAX, NULL,
                    "length^2/force",
                    "1/B: stress at which the power law ends"),
        OPTION_REAL(hyperbolic_value, n, "n", 1, 1000, NULL, "-",
                    "exponent of the hyperbolic sine"),
        OPTION_REAL(hyperbolic_value, dH, "dH", 0, DBL_MAX, "0", "unit of R T",
                    "activation energy"),
        OPTION_REAL(hyperbolic_value, R, "R", DBL_MIN, DBL_MAX, "8.314462618",
                    "dH/temperature", "gas constant"));

/* Rates at an equivalent stress q; a is the internal variable, if there is. */
typedef struct creep {
  double rate, a_rate; /* dp/dt, 1/s; of a */
  double by_q, a_by_q; /* slopes in q; in q = 0 the limit if finite, else 0,
                          as always for USER */
  double by_a, a_by_a; /* their slopes in a */
} creep;

/* ---- NORTON -------------------------------------------------------------- */

static int hardening_of(const law_card *law) {
  return ((const norton *)law->param)->hardening;
}

/* (A q^n)^k without overflow in between. */
static double power_law(const norton_value *v, double q, double k) {
  return pow(pow(v->A, 1 / v->n) * q, v->n * k);
}

/* The rates; *n: slope in q = n rate/q. */
static creep strain_hardening(const law_point *p, double q, double *n) {
  const norton_value *v = (const void *)p->value;
  const double k = 1 / (1 + v->m), w = fmax(p->alpha[0], 0);
  creep c = {.a_rate = power_law(v, q, k) * pow(k, k)};
  const double mean = pow(c.a_rate, 1 + v->m) * pow(p->dt, v->m);
  *n = v->n * k;
  if (c.a_rate > 0) c.rate = (1 + v->m) * pow(w, v->m) * c.a_rate;
  if (q > 0) c.a_by_q = *n * c.a_rate / q;
  if (v->m < 0 && c.rate > mean) {
    c.rate = mean;
    *n = v->n;
  } else if (p->alpha[0] > 0) {
    c.by_a = v->m * c.rate / p->alpha[0];
  }
  return c;
}

static creep time_hardening(const law_point *p, double q) {
  const norton_value *v = (const void *)p->value;
  creep c = {.rate = power_law(v, q, 1)};
  if (v->m == 0 || !(c.rate > 0)) return c;
  const double mean = pow(p->dt, v->m) / (1 + v->m);
  const double slowed = pow(p->t, v->m);
  c.rate *= v->m < 0 && slowed > mean ? mean : slowed;
  return c;
}

static creep norton_creep(const law_point *p, double q) {
  const norton_value *v = (const void *)p->value;
  double n = v->n;
  creep c = hardening_of(p->law) == STRAIN ? strain_hardening(p, q, &n)
                                           : time_hardening(p, q);
  if (q > 0)
    c.by_q = n * c.rate / q;
  else if (n == 1)
    c.by_q = norton_creep(p, 1).rate;
  return c;
}

static int norton_n_alpha(const law_card *law, int ns) {
  return hardening_of(law) == STRAIN;
}

/* ---- HYPERBOLIC ---------------------------------------------------------- */

/* dH/(R T) with the absolute temperature; infinite at absolute zero. */
static double exponent(const law_point *p) {
  const hyperbolic_value *v = (const void *)p->value;
  const double T = p->temperature - p->law->shift.zero;
  if (v->dH == 0) return 0;
  return T > 0 ? v->dH / v->R / T : HUGE_VAL;
}

/* log(sinh(x)), x > 0, without overflow. */
static double log_sinh(double x) {
  if (x < 1) return log(sinh(x));
  return x + log1p(-exp(-2 * x)) - log(2);
}

static creep hyperbolic_creep(const law_point *p, double q) {
  const hyperbolic_value *v = (const void *)p->value;
  creep c = {0};
  if (!(v->A > 0)) return c;
  const double scale = log(v->A) - exponent(p);
  if (q > 0) {
    c.rate = exp(scale + v->n * log_sinh(v->B * q));
    c.by_q = v->n * v->B / tanh(v->B * q) * c.rate;
  } else if (v->n == 1) {
    c.by_q = v->B * exp(scale);
  }
  return c;
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

/* ---- USER ---------------------------------------------------------------- */

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

static creep user_creep(const law_point *p, double q, int slopes) {
  static const double step = 1e-3; /* of q, and of p or the elastic strain */
  const double a = p->alpha[0];
  creep c = {0};
  if (!(q > 0)) return c;
  c.rate = c.a_rate = formula(p, q, a);
  if (!slopes) return c;
  c.by_q = c.a_by_q = slope(p, q, a, 0, step * q);
  c.by_a = c.a_by_a = slope(p, q, a, 1, step * fmax(a, q / p->elastic->young));
  return c;
}

static int user_n_alpha(const law_card *law, int ns) { return 1; }

/* ---- all ----------------------------------------------------------------- */

static creep creep_of(const law_point *p, double q, int slopes) {
  if (p->law->ops == &norton_law) return norton_creep(p, q);
  if (p->law->ops == &hyperbolic_law) return hyperbolic_creep(p, q);
  return user_creep(p, q, slopes);
}

static void rate(const law_point *p, double *ei_rate, double *alpha_rate) {
  const int ns = p->elastic->ns;
  double n[6];
  const double q = tensor_flow(ns, p->sigma, n);
  if (!(q > 0)) return;
  const creep c = creep_of(p, q, 0);
  for (int i = 0; i < ns; ++i) ei_rate[i] = c.rate * n[i];
  if (law_n_alpha(p->law, ns) > 0) alpha_rate[0] = c.a_rate;
}

static void jacobian(const law_point *p, law_jacobian *j) {
  const int ns = p->elastic->ns;
  double n[6];
  const double q = tensor_flow(ns, p->sigma, n);
  const creep c = creep_of(p, q, 1);
  tensor_add_flow(ns, n, q > 0 ? c.rate / q : c.by_q, c.by_q, j->ei_sigma, ns);
  if (law_n_alpha(p->law, ns) == 0 || !(q > 0)) return;
  for (int i = 0; i < ns; ++i) {
    j->ei_alpha[i] = c.by_a * n[i];
    j->alpha_sigma[i] = c.a_by_q * n[i];
  }
  j->alpha_alpha[0] = c.a_by_a;
}

/*
 * Held strain: a change across n decays with 3 G rate/q; one along n is coupled
 * with a by [-3 G by_q, by_a; -3 G a_by_q, a_by_a].
 */
static double fastest_rate(const law_point *p) {
  const double shear = 3 * p->elastic->shear;
  double n[6];
  const double q = tensor_flow(p->elastic->ns, p->sigma, n);
  const creep c = creep_of(p, q, 1);
  const double radial = shear * c.by_q, trace = radial - c.a_by_a;
  const double turning = q > 0 ? shear * c.rate / q : radial;
  const double det = shear * c.a_by_q * c.by_a - radial * c.a_by_a;
  const double root = trace * trace / 4 - det;
  if (det == 0) return fmax(fabs(trace), turning);
  return fmax(root >= 0 ? fabs(trace) / 2 + sqrt(root) : sqrt(det), turning);
}

static int flows(const law_point *p) {
  double n[6];
  const double q = tensor_flow(p->elastic->ns, p->sigma, n);
  return q > 0 && creep_of(p, q, 0).rate != 0;
}

static double dissipation(const law_point *p) {
  double n[6];
  const double q = tensor_flow(p->elastic->ns, p->sigma, n);
  return q > 0 ? q * creep_of(p, q, 0).rate : 0;
}

#define CREEP_COMMON                                                \
  .rate = rate, .jacobian = jacobian, .fastest_rate = fastest_rate, \
  .dissipation = dissipation

/* clang-format off */
const law_ops norton_law = {
  .name = "NORTON",
  .reference = "Norton 1929; Abaqus, creep laws TIME and STRAIN",
  .help = "power law creep, with time or strain hardening",
  .example = "1E-15, 5., -0.3",
  .param_size = sizeof(norton), .options = norton_options,
  .fields = norton_fields, .n_alpha = norton_n_alpha, CREEP_COMMON};

const law_ops hyperbolic_law = {
  .name = "HYPERBOLIC",
  .reference = "Garofalo 1963; Abaqus, creep law HYPERB",
  .help = "creep by a hyperbolic sine of the stress and an Arrhenius factor",
  .example = "1E-3, 0.02, 3.",
  .fields = hyperbolic_fields, .is_warm = is_warm, .flows = flows,
  CREEP_COMMON};

const law_ops user_law = {
  .name = "USER", .reference = "rate from the deck",
  .help = "creep of which the rate of strain is a formula of q, p, temp, t",
  .example = "\"2E-15*q^5/(1 + 100*p)\"",
  .needs_formula = 1, .n_alpha = user_n_alpha, .flows = flows, CREEP_COMMON};
/* clang-format on */
