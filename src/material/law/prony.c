/*
 * Prony series of the relaxation moduli (generalised Maxwell body):
 *   G(t) = G0 (1 - sum_k g_k (1 - exp(-t/tau_k))),  K(t) with k_k,
 * with the moduli G0, K0 of *ELASTIC at once. Each term has a strain v_k that
 * follows the total strain e = inv(E) sigma + e^i:
 *   d(v_k)/dt = (e - v_k)/tau_k,   e^i = sum_k (g_k dev + k_k vol) v_k.
 */
#include "material/law/law.h"

#include "base/base.h"

typedef struct prony_term {
  double g, k, tau;
} prony_term;

OPTIONS(terms,
        OPTION_REAL(prony_term, g, "g_i", 0, 1, "0", "-",
                    "part of the shear modulus that relaxes"),
        OPTION_REAL(prony_term, k, "k_i", 0, 1, "0", "-",
                    "part of the bulk modulus that relaxes"),
        OPTION_REAL(prony_term, tau, "tau_i", DBL_MIN, DBL_MAX, NULL, "time",
                    "relaxation time"));

static const prony_term *terms_of(const law_point *p) {
  return (const void *)p->value;
}

static int n_alpha(const law_card *law, int ns) { return ns * law->n_term; }

/* out += (g dev + k vol) v */
static void add_share(int ns, const prony_term *term, const double *v,
                      double *out) {
  const double mean = tensor_trace(v) / 3;
  for (int i = 0; i < ns; ++i)
    out[i] += i < 3 ? term->g * (v[i] - mean) + term->k * mean : term->g * v[i];
}

/* Adds the inelastic strain of the terms. */
static void shares(const law_point *p, double *ei) {
  const int ns = p->elastic->ns;
  for (int k = 0; k < p->law->n_term; ++k)
    add_share(ns, &terms_of(p)[k], p->alpha + ns * k, ei);
}

/* v of the only term: without what e^i has of a part that the term has not. */
static void set_only(const law_point *p, double *v) {
  const prony_term *term = terms_of(p);
  const double g = term->g > 0 ? 1 / term->g : 0;
  const double k = term->k > 0 ? 1 / term->k : 0;
  const double mean = tensor_trace(p->ei) / 3;
  for (int i = 0; i < p->elastic->ns; ++i)
    v[i] = i < 3 ? g * (p->ei[i] - mean) + k * mean : g * p->ei[i];
}

static int units(const law_point *p, double *only, double *sum) {
  if (only != NULL && p->law->n_term == 1) set_only(p, only);
  shares(p, sum);
  return 0;
}

/* Total strain less the part of e^i that is not in the terms. */
static void total_strain(const law_point *p, double *e) {
  double ei[6] = {0};
  shares(p, ei);
  tensor_product(p->elastic->ns, p->elastic->S, p->sigma, e);
  for (int i = 0; i < p->elastic->ns; ++i) e[i] += ei[i];
}

static void rate(const law_point *p, double *ei_rate, double *alpha_rate) {
  const int ns = p->elastic->ns;
  double e[6];
  total_strain(p, e);
  for (int k = 0; k < p->law->n_term; ++k) {
    const prony_term *term = &terms_of(p)[k];
    double *v_rate = alpha_rate + ns * k;
    for (int i = 0; i < ns; ++i)
      v_rate[i] = (e[i] - p->alpha[ns * k + i]) / term->tau;
    add_share(ns, term, v_rate, ei_rate);
  }
}

/* ei[ns*ns columns] += the share of every column of A, rows of v_k. */
static void add_column_shares(const law_point *p, const double *A, int na,
                              int columns, double *ei) {
  const int ns = p->elastic->ns;
  for (int j = 0; j < columns; ++j)
    for (int k = 0; k < p->law->n_term; ++k)
      add_share(ns, &terms_of(p)[k], A + (size_t)na * j + ns * k, ei + ns * j);
}

static void jacobian(const law_point *p, law_jacobian *j) {
  const int ns = p->elastic->ns, n = p->law->n_term, na = ns * n;
  const prony_term *term = terms_of(p);
  for (int k = 0; k < n; ++k)
    for (int m = 0; m < ns; ++m) {
      double unit[6] = {0};
      unit[m] = 1;
      for (int i = 0; i < ns; ++i)
        j->alpha_sigma[ns * k + i + na * m] =
            p->elastic->S[i + ns * m] / term[k].tau;
      for (int l = 0; l < n; ++l) { /* e depends on v_l by its share */
        double share[6] = {0};
        add_share(ns, &term[l], unit, share);
        for (int i = 0; i < ns; ++i)
          j->alpha_alpha[ns * k + i + na * (ns * l + m)] =
              (share[i] - (l == k) * unit[i]) / term[k].tau;
      }
    }
  add_column_shares(p, j->alpha_sigma, na, ns, j->ei_sigma);
  add_column_shares(p, j->alpha_alpha, na, na, j->ei_alpha);
}

/* Held strain: each term runs by itself. */
static double fastest_rate(const law_point *p) {
  double rate_max = 0;
  for (int k = 0; k < p->law->n_term; ++k)
    rate_max = fmax(rate_max, 1 / terms_of(p)[k].tau);
  return rate_max;
}

static double relaxing(const law_point *p, int k, double *W) {
  const int ns = p->elastic->ns;
  for (int j = 0; j < ns; ++j) {
    double unit[6] = {0};
    unit[j] = 1;
    for (int i = 0; i < ns; ++i) W[i + ns * j] = 0;
    add_share(ns, &terms_of(p)[k], unit, W + ns * j);
  }
  return 1 / terms_of(p)[k].tau;
}

/* All terms at the end: e = S sigma + (sum g dev + sum k vol) e. Under a held
 * stress the rates are diag(1/tau) (1 - g'), whose least eigenvalue is at least
 * (1 - sum g)/tau of the longest. */
static double relaxed(const law_point *p, double *R) {
  const int ns = p->elastic->ns;
  const prony_term *term = terms_of(p);
  prony_term all = {0};
  double longest = 0;
  for (int k = 0; k < p->law->n_term; ++k) {
    all.g += term[k].g;
    all.k += term[k].k;
    longest = fmax(longest, term[k].tau);
  }
  const double left = 1 - fmax(all.g, all.k);
  if (!(left > p->law->n_term * DBL_EPSILON)) return -1;
  all.g /= 1 - all.g;
  all.k /= 1 - all.k;
  for (int i = 0; i < ns * ns; ++i) R[i] = 0;
  for (int j = 0; j < ns; ++j)
    add_share(ns, &all, p->elastic->S + ns * j, R + ns * j);
  return longest / left;
}

/* x . C (g dev + k vol) x */
static double share_energy(const law_point *p, int k, const double *x) {
  const int ns = p->elastic->ns;
  double share[6] = {0}, stress[6];
  add_share(ns, &terms_of(p)[k], x, share);
  tensor_product(ns, p->elastic->C, share, stress);
  return dot(ns, x, stress);
}

static double dissipation(const law_point *p) {
  const int ns = p->elastic->ns;
  double e[6], x[6], lost = 0;
  total_strain(p, e);
  for (int k = 0; k < p->law->n_term; ++k) {
    for (int i = 0; i < ns; ++i) x[i] = e[i] - p->alpha[ns * k + i];
    lost += share_energy(p, k, x) / terms_of(p)[k].tau;
  }
  return lost;
}

/* The energy of the springs less 1/2 (e - e^i) C (e - e^i). */
static double stored(const law_point *p) {
  const int ns = p->elastic->ns;
  double ei[6] = {0}, stress[6], kept = 0;
  shares(p, ei);
  tensor_product(ns, p->elastic->C, ei, stress);
  for (int k = 0; k < p->law->n_term; ++k)
    kept += share_energy(p, k, p->alpha + ns * k);
  return 0.5 * (kept - dot(ns, ei, stress));
}

static const char *check(const law_card *law, elastic_type type,
                         const double *value, char *text, size_t size) {
  const prony_term *term = (const void *)value;
  const double rounding = law->n_term * DBL_EPSILON;
  double g = 0, k = 0;
  if (type != ELASTIC_ISO) {
    snprintf(text, size, "a Prony series needs *ELASTIC, TYPE=ISO");
    return text;
  }
  for (int i = 0; i < law->n_term; ++i) {
    g += term[i].g;
    k += term[i].k;
  }
  if (g <= 1 + rounding && k <= 1 + rounding) return NULL;
  snprintf(text, size, "the sum of the %s is %g, above 1",
           g > 1 + rounding ? "g_i" : "k_i", g > 1 + rounding ? g : k);
  return text;
}

/* clang-format off */
const law_ops prony_law = {
  .name = "PRONY",
  .reference = "Prony series as in Abaqus, time domain viscoelasticity",
  .help = "generalised Maxwell body in shear and bulk, a term a line",
  .example = "0.3, 0.1, 0.5\n0.2, 0., 10.\n0.25, 0.3, 200.",
  .terms = terms, .linear = 1, .n_alpha = n_alpha, .rate = rate,
  .units = units, .jacobian = jacobian, .fastest_rate = fastest_rate,
  .relaxing = relaxing, .relaxed = relaxed, .dissipation = dissipation,
  .stored = stored, .check = check};
/* clang-format on */
