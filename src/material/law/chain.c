/*
 * Elastic spring and Kelvin-Voigt units in series:
 *   ZENER    one unit        d(e^i)/dt = (E0 Q sigma - E1 e^i)/eta1
 *   KELVIN   any number      d(a_k)/dt = (E0 Q sigma - E_k a_k)/eta_k,
 *                            e^i = a_1 + a_2 + ...
 *   BURGERS  and a dashpot   e^i = a_1 + b,  d(b)/dt = E0 Q sigma/eta_M.
 * E0 is Young's modulus of *ELASTIC. PROPORTIONAL: Q = inv(E), so that every
 * unit has Poisson's ratio of the spring, and the scalars are those of a bar;
 * DEVIATORIC: Q = P' inv(E) P with the projection P on deviators.
 */
#include "material/law/law.h"

#include "base/base.h"

typedef struct chain_param {
  int type;
} chain_param;
enum { PROPORTIONAL, DEVIATORIC };

typedef struct unit {
  double modulus, viscosity; /* Pa, Pa s */
} unit;
typedef struct burgers_value {
  double dashpot; /* Pa s */
  unit kelvin;
} burgers_value;

#define MODULUS(struct_, field, name)                                   \
  OPTION_REAL(struct_, field, name, 0, DBL_MAX, NULL, "force/length^2", \
              "modulus of the spring parallel to the dashpot")
#define VISCOSITY(struct_, field, name, help)               \
  OPTION_REAL(struct_, field, name, DBL_MIN, DBL_MAX, NULL, \
              "force/length^2 time", help)

OPTIONS(options, OPTION_CHOICE(chain_param, type, "TYPE",
                               "PROPORTIONAL|DEVIATORIC", "PROPORTIONAL",
                               "the whole strain is delayed, or its deviator"));
OPTIONS(zener_fields, MODULUS(unit, modulus, "E1"),
        VISCOSITY(unit, viscosity, "eta1", "viscosity of the dashpot"));
OPTIONS(kelvin_terms, MODULUS(unit, modulus, "E_k"),
        VISCOSITY(unit, viscosity, "eta_k", "viscosity of the dashpot"));
OPTIONS(burgers_fields,
        VISCOSITY(burgers_value, dashpot, "eta_M",
                  "viscosity of the single dashpot"),
        MODULUS(burgers_value, kelvin.modulus, "E_K"),
        VISCOSITY(burgers_value, kelvin.viscosity, "eta_K",
                  "viscosity parallel to the spring"));

/* The units of a point, whatever the law. */
typedef struct chain {
  int n, ns;
  const unit *k;   /* [n] */
  double fluidity; /* of the single dashpot, 1/(Pa s) */
  double Q[36];    /* [ns*ns] times E0, - */
  const double *a; /* [ns*n] strains of the units */
} chain;

static chain chain_of(const law_point *p) {
  const law_ops *ops = p->law->ops;
  const law_elastic *el = p->elastic;
  const int ns = el->ns;
  chain c = {.n = 1, .ns = ns, .a = p->alpha};
  if (ops == &burgers_law) {
    const burgers_value *v = (const void *)p->value;
    c.k = &v->kelvin;
    c.fluidity = 1 / v->dashpot;
  } else {
    c.k = (const void *)p->value;
  }
  if (ops == &kelvin_law) c.n = p->law->n_term;
  if (ops == &zener_law) c.a = p->ei;
  if (((const chain_param *)p->law->param)->type == DEVIATORIC)
    tensor_add_part(ns, el->S, 1, el->young, c.Q);
  else
    for (int i = 0; i < ns * ns; ++i) c.Q[i] = el->young * el->S[i];
  return c;
}

static int n_alpha(const law_card *law, int ns) {
  if (law->ops == &zener_law) return 0;
  return ns * (law->ops == &kelvin_law ? law->n_term : 1);
}

/* Rate of unit k from e = E0 Q sigma. */
static void unit_rate(const chain *c, int k, const double *e, double *a_rate) {
  const double *a = c->a + c->ns * k;
  for (int i = 0; i < c->ns; ++i)
    a_rate[i] = (e[i] - c->k[k].modulus * a[i]) / c->k[k].viscosity;
}

static void rate(const law_point *p, double *ei_rate, double *alpha_rate) {
  const chain c = chain_of(p);
  double e[6], a_rate[6];
  tensor_product(c.ns, c.Q, p->sigma, e);
  for (int i = 0; i < c.ns; ++i) ei_rate[i] = c.fluidity * e[i];
  for (int k = 0; k < c.n; ++k) {
    unit_rate(&c, k, e, a_rate);
    for (int i = 0; i < c.ns; ++i) ei_rate[i] += a_rate[i];
    for (int i = 0; i < c.ns && p->law->ops != &zener_law; ++i)
      alpha_rate[c.ns * k + i] = a_rate[i];
  }
}

static void jacobian(const law_point *p, law_jacobian *j) {
  const chain c = chain_of(p);
  const int ns = c.ns, na = n_alpha(p->law, ns);
  for (int i = 0; i < ns * ns; ++i) j->ei_sigma[i] = c.fluidity * c.Q[i];
  for (int k = 0; k < c.n; ++k) {
    const double decay = c.k[k].modulus / c.k[k].viscosity;
    for (int i = 0; i < ns * ns; ++i)
      j->ei_sigma[i] += c.Q[i] / c.k[k].viscosity;
    for (int i = 0; i < ns; ++i) {
      const int at = ns * k + i;
      if (na == 0) {
        j->ei_ei[i + ns * i] = -decay;
        continue;
      }
      j->ei_alpha[i + ns * at] = -decay;
      j->alpha_alpha[at + na * at] = -decay;
      for (int m = 0; m < ns; ++m)
        j->alpha_sigma[at + na * m] = c.Q[i + ns * m] / c.k[k].viscosity;
    }
  }
}

/*
 * Held strain: the matrix diag(E_k/eta_k) + (E0/eta_k) 1' has the largest
 * eigenvalue where sum_k (E0/eta_k)/(x - E_k/eta_k) falls to 1, above the
 * largest E_k/eta_k; the single dashpot is a unit with E_k = 0.
 */
static double fastest_rate(const law_point *p) {
  const chain c = chain_of(p);
  const double young = p->elastic->young;
  double low = 0, high = young * c.fluidity;
  for (int k = 0; k < c.n; ++k) {
    low = fmax(low, c.k[k].modulus / c.k[k].viscosity);
    high += young / c.k[k].viscosity;
  }
  high += low;
  for (double x = low + (high - low) / 2; x > low && x < high;
       x = low + (high - low) / 2) {
    double sum = young * c.fluidity / x;
    for (int k = 0; k < c.n; ++k)
      sum += young / (x * c.k[k].viscosity - c.k[k].modulus);
    if (sum > 1)
      low = x;
    else
      high = x;
  }
  return high;
}

static double relaxed(const law_point *p, double *R) {
  const chain c = chain_of(p);
  double sum = 0, slowest = 0;
  if (c.fluidity > 0) return -1;
  for (int k = 0; k < c.n; ++k) {
    if (!(c.k[k].modulus > 0)) return -1;
    sum += 1 / c.k[k].modulus;
    slowest = fmax(slowest, c.k[k].viscosity / c.k[k].modulus);
  }
  for (int i = 0; i < c.ns * c.ns; ++i) R[i] = sum * c.Q[i];
  return slowest;
}

static int series(const law_point *p, int part, int k, law_unit *u) {
  const chain c = chain_of(p);
  const double young = p->elastic->young;
  const int first = p->law->ops == &zener_law ? 0 : 1;
  if (part > 0) return LAW_NO_PART;
  *u = (law_unit){.flow = k == 0 ? young * c.fluidity : 0};
  if (k >= first) {
    const struct unit *own = &c.k[k - first];
    *u = (law_unit){young / own->viscosity, own->modulus / young};
  }
  return ((const chain_param *)p->law->param)->type == DEVIATORIC ? LAW_DEVIATOR
                                                                  : LAW_WHOLE;
}

static int units(const law_point *p, double *only, double *sum) {
  const chain c = chain_of(p);
  const int dashpot = c.fluidity > 0;
  for (int i = 0; i < c.ns && only != NULL && c.n == 1 && !dashpot; ++i)
    only[i] = p->ei[i];
  for (int i = 0; i < c.ns * c.n; ++i) sum[i % c.ns] += c.a[i];
  return dashpot;
}

/* x . unit stiffness . y, J/m3 over Pa: isotropic, or the whole of it. */
static double unit_energy(const law_point *p, const double *x,
                          const double *y) {
  double Cy[6];
  tensor_product(p->elastic->ns, p->elastic->C, y, Cy);
  return dot(p->elastic->ns, x, Cy) / p->elastic->young;
}

static double dissipation(const law_point *p) {
  const chain c = chain_of(p);
  double e[6], a_rate[6];
  tensor_product(c.ns, c.Q, p->sigma, e);
  double lost = c.fluidity * dot(c.ns, p->sigma, e);
  for (int k = 0; k < c.n; ++k) {
    unit_rate(&c, k, e, a_rate);
    lost += c.k[k].viscosity * unit_energy(p, a_rate, a_rate);
  }
  return lost;
}

static double stored(const law_point *p) {
  const chain c = chain_of(p);
  double kept = 0;
  for (int k = 0; k < c.n; ++k) {
    const double *a = c.a + c.ns * k;
    kept += 0.5 * c.k[k].modulus * unit_energy(p, a, a);
  }
  return kept;
}

static const char *check(const law_card *law, elastic_type type,
                         const double *value, char *text, size_t size) {
  if (type == ELASTIC_ISO ||
      ((const chain_param *)law->param)->type == PROPORTIONAL)
    return NULL;
  snprintf(text, size, "TYPE=DEVIATORIC needs *ELASTIC, TYPE=ISO");
  return text;
}

#define CHAIN_COMMON                                                  \
  .param_size = sizeof(chain_param), .options = options, .linear = 1, \
  .n_alpha = n_alpha, .rate = rate, .jacobian = jacobian,             \
  .fastest_rate = fastest_rate, .relaxed = relaxed, .series = series, \
  .dissipation = dissipation, .stored = stored, .check = check

/* clang-format off */
const law_ops zener_law = {
  .name = "ZENER", .reference = "Zener 1948",
  .help = "standard linear solid: a spring and a Kelvin-Voigt unit in series",
  .example = "5E4, 1E5",
  .fields = zener_fields, .uses_ei = 1, CHAIN_COMMON};

const law_ops kelvin_law = {
  .name = "KELVIN", .reference = "Thomson 1865; Voigt 1892",
  .help = "a spring and Kelvin-Voigt units in series, a unit a line",
  .example = "5E4, 1E5\n2E5, 3E6",
  .terms = kelvin_terms, .units = units, CHAIN_COMMON};

const law_ops burgers_law = {
  .name = "BURGERS", .reference = "Burgers 1935",
  .help = "a spring, a dashpot and a Kelvin-Voigt unit in series",
  .example = "2E6, 5E4, 1E5",
  .fields = burgers_fields, .units = units, CHAIN_COMMON};
/* clang-format on */
