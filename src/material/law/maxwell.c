/*
 * Maxwell body, a spring and a dashpot in series:
 *   PROPORTIONAL  d(e^i)/dt = inv(E) sigma / tau          (Raous: constant nu)
 *   DEVIATORIC    d(e^i)/dt = inv(E) s / tau [+ inv(E) m / tau_bulk]
 * with deviator s and mean stress m of sigma. Held strain: the stress, or its
 * parts, decay as exp(-t/tau).
 */
#include "base/base.h"
#include "material/law/law.h"
#include "material/voigt.h"

typedef struct maxwell {
  int type;
} maxwell;
enum { PROPORTIONAL, DEVIATORIC };

typedef struct maxwell_value {
  double tau, tau_bulk; /* s; tau_bulk 0: the mean stress does not relax */
} maxwell_value;

OPTIONS(options, OPTION_CHOICE(maxwell, type, "TYPE", "PROPORTIONAL|DEVIATORIC",
                               "PROPORTIONAL",
                               "the whole stress relaxes, or its deviator"));
OPTIONS(fields,
        OPTION_REAL(maxwell_value, tau, "tau", DBL_MIN, DBL_MAX, NULL, "time",
                    "relaxation time"),
        OPTION_REAL(maxwell_value, tau_bulk, "tau_bulk", 0, DBL_MAX,
                    OPTION_ABSENT, "time",
                    "of the mean stress with TYPE=DEVIATORIC; absent or 0: "
                    "it does not relax"));

static const maxwell_value *values(const law_point *p) {
  return (const maxwell_value *)(const void *)p->value;
}

static int is_deviatoric(const law_card *law) {
  return ((const maxwell *)law->param)->type == DEVIATORIC;
}

/* Q += d(rate)/d(sigma). */
static void add_fluidity(const law_point *p, double *Q) {
  const int ns = p->elastic->ns;
  const double *S = p->elastic->S;
  const maxwell_value *v = values(p);
  if (!is_deviatoric(p->law)) {
    for (int i = 0; i < ns * ns; ++i) Q[i] += S[i] / v->tau;
    return;
  }
  tensor_add_part(ns, S, 1, 1 / v->tau, Q);
  if (v->tau_bulk > 0) tensor_add_part(ns, S, 0, 1 / v->tau_bulk, Q);
}

static void rate(const law_point *p, double *ei_rate, double *alpha_rate) {
  double Q[36] = {0};
  add_fluidity(p, Q);
  tensor_product(p->elastic->ns, Q, p->sigma, ei_rate);
}

static void jacobian(const law_point *p, law_jacobian *j) {
  add_fluidity(p, j->ei_sigma);
}

static double fastest_rate(const law_point *p) {
  const maxwell_value *v = values(p);
  const double shear = 1 / v->tau;
  if (!is_deviatoric(p->law) || !(v->tau_bulk > 0)) return shear;
  return fmax(shear, 1 / v->tau_bulk);
}

/* x' S x, Pa */
static double square(const law_elastic *el, const double *x) {
  double strain[6];
  voigt_product(el->ns, el->S, x, strain);
  return voigt_dot(el->ns, x, strain);
}

static int series(const law_point *p, int part, int k, law_unit *unit) {
  const maxwell_value *v = values(p);
  const double tau = part == 0 ? v->tau : v->tau_bulk;
  if (part > 1 || !(tau > 0)) return LAW_NO_PART;
  unit->flow = 1 / tau;
  if (!is_deviatoric(p->law)) return part == 0 ? LAW_WHOLE : LAW_NO_PART;
  return part == 0 ? LAW_DEVIATOR : LAW_MEAN;
}

static double dissipation(const law_point *p) {
  const law_elastic *el = p->elastic;
  const maxwell_value *v = values(p);
  double s[6], mean[6];
  if (!is_deviatoric(p->law)) return square(el, p->sigma) / v->tau;
  tensor_deviator(el->ns, p->sigma, s);
  double power = square(el, s) / v->tau;
  for (int i = 0; i < el->ns; ++i) mean[i] = p->sigma[i] - s[i];
  if (v->tau_bulk > 0) power += square(el, mean) / v->tau_bulk;
  return power;
}

static const char *check(const law_card *law, elastic_type type,
                         const double *value, char *text, size_t size) {
  if (is_deviatoric(law) || !(value[1] > 0)) return NULL;
  snprintf(text, size, "tau_bulk needs TYPE=DEVIATORIC");
  return text;
}

/* clang-format off */
const law_ops maxwell_law = {
  .name = "MAXWELL", .reference = "Raous 1981; Cocu, Pratt, Raous 1998, 3.2",
  .help = "linear viscoelastic fluid: a spring and a dashpot in series",
  .example = "2.",
  .param_size = sizeof(maxwell), .options = options, .fields = fields,
  .linear = 1, .rate = rate, .jacobian = jacobian, .fastest_rate = fastest_rate,
  .series = series, .dissipation = dissipation, .check = check};
/* clang-format on */
