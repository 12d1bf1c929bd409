/*
 * Viscoplasticity of von Mises type with a threshold:
 *   dp/dt = <(q - R(p))/K>^n,   q = J(sigma - X),   d(e^i)/dt = dp/dt 3/2 s/q,
 *   R = sigma_y + H p + Q (1 - exp(-b p)),   X = sum_k X_k,
 *   X_k = 2/3 C_k a_k,   d(a_k)/dt = d(e^i)/dt - gamma_k a_k dp/dt
 * with s the deviator of sigma - X. alpha = p, a_1, a_2, ...
 *   BINGHAM   n = 1, H = Q = 0, no X              (Bingham 1922)
 *   PERZYNA   no X                                (Perzyna 1966)
 *   CHABOCHE  H = 0                 (Armstrong, Frederick 1966; Chaboche 1989)
 */
#include "material/law/law.h"

#include "base/base.h"

#include <lapacke.h>

/* Fields in the order of the line; those a law lacks are zero. */
typedef struct yield {
  double sigma_y, K, n, H, Q, b;
} yield;
typedef struct bingham_value {
  double sigma_y, eta;
} bingham_value;
typedef struct perzyna_value {
  double sigma_y, eta, H, n, Q, b;
} perzyna_value;
typedef struct chaboche_value {
  double sigma_y, K, n, Q, b;
} chaboche_value;
typedef struct back_stress {
  double C, gamma;
} back_stress;

#define STRESS "force/length^2"
#define YIELD_STRESS(struct_)                                        \
  OPTION_REAL(struct_, sigma_y, "sigma_y", 0, DBL_MAX, NULL, STRESS, \
              "equivalent stress that flow begins at")
#define VOCE_Q(struct_)                                        \
  OPTION_REAL(struct_, Q, "Q", -DBL_MAX, DBL_MAX, "0", STRESS, \
              "rise of the threshold at the end, < 0: softening")
#define VOCE_B(struct_)                              \
  OPTION_REAL(struct_, b, "b", 0, DBL_MAX, "0", "-", \
              "how fast it rises: Q (1 - exp(-b p))")
#define EXPONENT(struct_, initial)                    \
  OPTION_REAL(struct_, n, "n", 1, 1000, initial, "-", \
              "exponent of the overstress")

OPTIONS(bingham_fields, YIELD_STRESS(bingham_value),
        OPTION_REAL(bingham_value, eta, "eta", DBL_MIN, DBL_MAX, NULL,
                    STRESS " time", "viscosity: dp/dt = overstress/eta"));
OPTIONS(perzyna_fields, YIELD_STRESS(perzyna_value),
        OPTION_REAL(perzyna_value, eta, "eta", DBL_MIN, DBL_MAX, NULL,
                    STRESS " time^(1/n)", "dp/dt = (overstress/eta)^n"),
        OPTION_REAL(perzyna_value, H, "H", 0, DBL_MAX, "0", STRESS,
                    "rise of the threshold with p"),
        EXPONENT(perzyna_value, "1"), VOCE_Q(perzyna_value),
        VOCE_B(perzyna_value));
OPTIONS(chaboche_fields, YIELD_STRESS(chaboche_value),
        OPTION_REAL(chaboche_value, K, "K", DBL_MIN, DBL_MAX, NULL,
                    STRESS " time^(1/n)", "dp/dt = (overstress/K)^n"),
        EXPONENT(chaboche_value, NULL), VOCE_Q(chaboche_value),
        VOCE_B(chaboche_value));
OPTIONS(chaboche_terms,
        OPTION_REAL(back_stress, C, "C_k", 0, DBL_MAX, NULL, STRESS,
                    "modulus of the back stress at its start"),
        OPTION_REAL(back_stress, gamma, "gamma_k", 0, DBL_MAX, "0", "-",
                    "recall: the back stress ends at C_k/gamma_k"));

static yield yield_of(const law_point *p) {
  if (p->law->ops == &chaboche_law) {
    const chaboche_value *v = (const void *)p->value;
    return (yield){v->sigma_y, v->K, v->n, 0, v->Q, v->b};
  }
  if (p->law->ops == &perzyna_law) {
    const perzyna_value *v = (const void *)p->value;
    return (yield){v->sigma_y, v->eta, v->n, v->H, v->Q, v->b};
  }
  const bingham_value *v = (const void *)p->value;
  return (yield){v->sigma_y, v->eta, 1, 0, 0, 0};
}

/* State of a point. */
typedef struct flow {
  yield y;
  int ns, n_back;
  const back_stress *back; /* [n_back] */
  const double *a;         /* [ns*n_back] */
  double p;
  double q, rate;   /* J(sigma - X), Pa; dp/dt, 1/s */
  double slope;     /* d(rate)/dq, 1/(Pa s) */
  double hardening; /* dR/dp, Pa */
  double n[6];      /* [ns] 3/2 s/q, shears doubled */
} flow;

/* Stress of a strain like a_k over its factor: 2/3 C, shears halved. */
static double back_factor(const back_stress *b, int i) {
  return (i < 3 ? 2.0 : 1.0) / 3 * b->C;
}

static flow flow_of(const law_point *p) {
  const int ns = p->elastic->ns;
  flow f = {.y = yield_of(p), .ns = ns, .n_back = p->law->n_term};
  double s[6];
  /* The same card has them behind its fields. */
  f.back = (const void *)(p->value + law_n_field(p->law->ops->fields));
  f.p = p->law->ops == &bingham_law ? 0 : p->alpha[0];
  f.a = p->alpha + 1;
  for (int i = 0; i < ns; ++i) {
    s[i] = p->sigma[i];
    for (int k = 0; k < f.n_back; ++k)
      s[i] -= back_factor(&f.back[k], i) * f.a[ns * k + i];
  }
  tensor_deviator(ns, s, s);
  f.q = tensor_mises(ns, s);
  const double faded = f.y.Q != 0 ? f.y.Q * exp(-f.y.b * f.p) : 0;
  const double over =
      (f.q - f.y.sigma_y - f.y.H * f.p - (f.y.Q - faded)) / f.y.K;
  f.hardening = f.y.H + f.y.b * faded;
  if (!(over > 0 && f.q > 0)) return f;
  f.rate = pow(over, f.y.n);
  f.slope = f.y.n * pow(over, f.y.n - 1) / f.y.K;
  tensor_direction(ns, s, f.q, f.n);
  return f;
}

static int n_alpha(const law_card *law, int ns) {
  return law->ops == &bingham_law ? 0 : 1 + ns * law->n_term;
}

static void rate(const law_point *p, double *ei_rate, double *alpha_rate) {
  const flow f = flow_of(p);
  for (int i = 0; i < f.ns; ++i) ei_rate[i] = f.rate * f.n[i];
  if (p->law->ops != &bingham_law) alpha_rate[0] = f.rate;
  for (int k = 0; k < f.n_back; ++k)
    for (int i = 0; i < f.ns; ++i)
      alpha_rate[1 + f.ns * k + i] =
          f.rate * (f.n[i] - f.back[k].gamma * f.a[f.ns * k + i]);
}

/*
 * Derivatives of a vector y' with respect to (sigma, p, a_j), where only
 * y'_sigma[rows*ns] and y'_p[rows] are new: the stress enters as sigma - X,
 * so that those of a_j are -y'_sigma times the factors of X_j.
 */
static void add_back_columns(const flow *f, const double *by_sigma, int rows,
                             int ld_sigma, double *by_alpha, int ld) {
  for (int k = 0; k < f->n_back; ++k)
    for (int j = 0; j < f->ns; ++j)
      for (int i = 0; i < rows; ++i)
        by_alpha[i + ld * (1 + f->ns * k + j)] -=
            by_sigma[i + ld_sigma * j] * back_factor(&f->back[k], j);
}

/* Rows of a_k: those of e^i less the recall gamma_k a_k dp/dt. */
static void back_rows(const flow *f, int k, const law_jacobian *j, int na) {
  const int ns = f->ns, row = 1 + ns * k;
  const double gamma = f->back[k].gamma, *a = f->a + ns * k;
  for (int i = 0; i < ns; ++i) {
    for (int m = 0; m < ns; ++m)
      j->alpha_sigma[row + i + na * m] =
          j->ei_sigma[i + ns * m] - gamma * a[i] * f->slope * f->n[m];
    j->alpha_alpha[row + i] =
        -f->slope * f->hardening * (f->n[i] - gamma * a[i]);
    j->alpha_alpha[row + i + na * (row + i)] = -gamma * f->rate;
  }
}

static void jacobian(const law_point *p, law_jacobian *j) {
  const flow f = flow_of(p);
  const int ns = f.ns, na = n_alpha(p->law, ns);
  if (!(f.rate > 0)) return;
  tensor_add_flow(ns, f.n, f.rate / f.q, f.slope, j->ei_sigma, ns);
  if (na == 0) return;
  for (int i = 0; i < ns; ++i) {
    j->ei_alpha[i] = -f.slope * f.hardening * f.n[i];
    j->alpha_sigma[na * i] = f.slope * f.n[i];
  }
  j->alpha_alpha[0] = -f.slope * f.hardening;
  for (int k = 0; k < f.n_back; ++k) back_rows(&f, k, j, na);
  add_back_columns(&f, j->ei_sigma, ns, ns, j->ei_alpha, ns);
  add_back_columns(&f, j->alpha_sigma, na, na, j->alpha_alpha, na);
}

enum { BACK_MAX = 15 }; /* back stresses of the closed form */

/* The largest magnitude of an eigenvalue of M[n*n], which is destroyed. */
static double radius(double *M, int n) {
  double re[BACK_MAX + 1], im[BACK_MAX + 1], work[4 * (BACK_MAX + 1)],
      largest = 0;
  for (int i = 0; i < n * n; ++i)
    if (!isfinite(M[i])) return fabs(M[i]);
  if (n == 1) return fabs(M[0]);
  if (LAPACKE_dgeev_work(LAPACK_COL_MAJOR, 'N', 'N', n, M, n, re, im, NULL, 1,
                         NULL, 1, work, 4 * n) != 0)
    return -1;
  for (int i = 0; i < n; ++i) largest = fmax(largest, hypot(re[i], im[i]));
  return largest;
}

/* n . a_k of tensors, from components with doubled shears. */
static double along_direction(const flow *f, int k) {
  double sum = 0;
  for (int i = 0; i < f->ns; ++i)
    sum += (i < 3 ? 1 : 0.5) * f->n[i] * f->a[f->ns * k + i];
  return sum;
}

/*
 * Held strain: changes of (e^i, a_k) along n and across n are uncoupled. Each
 * is x' = -c (A x + sum_k C_k y_k), y_k' = r_k x' - gamma_k rate y_k with
 *   along   c = slope,   A = 3 G + dR/dp,  r_k = 1 - gamma_k (2/3) n . a_k
 *   across  c = rate/q,  A = 3 G,          r_k = 1.
 */
static double coupled_rate(const flow *f, double c, double A, int along) {
  double M[(BACK_MAX + 1) * (BACK_MAX + 1)];
  const int n = f->n_back + 1;
  for (int i = 0; i < n; ++i) {
    const back_stress *b = &f->back[i - 1];
    double r = 1;
    if (i > 0 && along) r -= b->gamma * 2 / 3 * along_direction(f, i - 1);
    M[i] = -c * A * r;
    for (int k = 1; k < n; ++k) {
      M[i + n * k] = -c * f->back[k - 1].C * r;
      if (i == k) M[i + n * k] -= b->gamma * f->rate;
    }
  }
  return radius(M, n);
}

static double fastest_rate(const law_point *p) {
  const flow f = flow_of(p);
  const double shear = 3 * p->elastic->shear;
  if (!(f.rate > 0)) return 0;
  if (f.n_back > BACK_MAX) return -1;
  const double along = coupled_rate(&f, f.slope, shear + f.hardening, 1);
  const double across = coupled_rate(&f, f.rate / f.q, shear, 0);
  return along < 0 || across < 0 ? -1 : fmax(along, across);
}

static int flows(const law_point *p) { return flow_of(p).rate > 0; }

/* X_k . a_k */
static double back_energy(const flow *f, int k) {
  double sum = 0;
  for (int i = 0; i < f->ns; ++i) {
    const double a = f->a[f->ns * k + i];
    sum += back_factor(&f->back[k], i) * a * a;
  }
  return sum;
}

static double dissipation(const law_point *p) {
  const flow f = flow_of(p);
  if (!(f.rate > 0)) return 0;
  double stress = f.y.sigma_y + f.y.K * pow(f.rate, 1 / f.y.n);
  for (int k = 0; k < f.n_back; ++k)
    stress += f.back[k].gamma * back_energy(&f, k);
  return stress * f.rate;
}

/* Integral of R - sigma_y over p, and 1/2 X_k . a_k. */
static double stored(const law_point *p) {
  const flow f = flow_of(p);
  double kept = 0.5 * f.y.H * f.p * f.p;
  if (f.y.b > 0) kept += f.y.Q * (f.p + expm1(-f.y.b * f.p) / f.y.b);
  for (int k = 0; k < f.n_back; ++k) kept += 0.5 * back_energy(&f, k);
  return kept;
}

#define YIELD_COMMON                                                      \
  .n_alpha = n_alpha, .rate = rate, .jacobian = jacobian, .flows = flows, \
  .dissipation = dissipation, .stored = stored

/* clang-format off */
const law_ops bingham_law = {
  .name = "BINGHAM", .reference = "Bingham 1922; Hohenemser, Prager 1932",
  .help = "flow beyond a threshold, rate linear in the overstress",
  .example = "100., 1E4",
  .fields = bingham_fields, .fastest_rate = fastest_rate, YIELD_COMMON};

const law_ops perzyna_law = {
  .name = "PERZYNA", .reference = "Perzyna 1966",
  .help = "viscoplasticity with isotropic hardening, power of the overstress",
  .example = "80., 1E4, 1E4, 1.5, 30., 100.",
  .fields = perzyna_fields, .fastest_rate = fastest_rate, YIELD_COMMON};

const law_ops chaboche_law = {
  .name = "CHABOCHE", .reference = "Armstrong, Frederick 1966; Chaboche 1989",
  .help = "viscoplasticity with isotropic and kinematic hardening, a back "
          "stress a line",
  .example = "60., 150., 3., 20., 50.\n2E4, 100.\n5E3, 20.",
  .fields = chaboche_fields, .terms = chaboche_terms,
  .fastest_rate = fastest_rate, YIELD_COMMON};
/* clang-format on */
