/*
 * The list of inelastic laws, deviators, equivalent stress and flow directions
 * in Voigt components, the elasticity they are coupled with, and their
 * evaluation at a point.
 */
#include "material/law/law.h"

#include "base/base.h"
#include "material/voigt.h"

#include <lapacke.h>
#include <strings.h>

double tensor_trace(const double *v) { return v[0] + v[1] + v[2]; }

void tensor_deviator(int ns, const double *v, double *d) {
  const double mean = tensor_trace(v) / 3;
  for (int i = 0; i < ns; ++i) d[i] = i < 3 ? v[i] - mean : v[i];
}

double tensor_mises(int ns, const double *s) {
  const double largest = largest_entry(ns, s);
  double sum = 0;
  if (!(largest > 0)) return largest;
  for (int i = 0; i < ns; ++i) {
    const double x = s[i] / largest;
    sum += i < 3 ? x * x : 2 * x * x;
  }
  return largest * sqrt(1.5 * sum);
}

void tensor_product(int ns, const double *A, const double *x, double *y) {
  voigt_product(ns, A, x, y);
}

void tensor_direction(int ns, const double *s, double q, double *n) {
  for (int i = 0; i < ns; ++i) n[i] = (i < 3 ? 1.5 : 3.0) * (s[i] / q);
}

double tensor_flow(int ns, const double *sigma, double *n) {
  double s[6];
  tensor_deviator(ns, sigma, s);
  const double q = tensor_mises(ns, s);
  for (int i = 0; i < ns; ++i) n[i] = 0;
  if (q > 0) tensor_direction(ns, s, q, n);
  return q;
}

void tensor_add_flow(int ns, const double *n, double a, double b, double *J,
                     int ld) {
  for (int j = 0; j < ns; ++j) {
    for (int i = 0; i < ns; ++i) J[i + ld * j] += (b - a) * n[i] * n[j];
    if (j >= 3) J[j + ld * j] += 3 * a;
    for (int i = 0; i < 3 && j < 3; ++i)
      J[i + ld * j] += a * (i == j ? 1.0 : -0.5);
  }
}

/* Deviator of every column, or what it leaves: the mean. */
static void project_columns(int ns, int deviatoric, double *Q) {
  for (int j = 0; j < ns; ++j) {
    double *v = Q + ns * j;
    const double mean = tensor_trace(v) / 3;
    for (int i = 0; i < ns; ++i)
      if (deviatoric)
        v[i] -= i < 3 ? mean : 0;
      else
        v[i] = i < 3 ? mean : 0;
  }
}

static void transpose(int ns, double *Q) {
  for (int j = 0; j < ns; ++j)
    for (int i = 0; i < j; ++i) {
      const double keep = Q[i + ns * j];
      Q[i + ns * j] = Q[j + ns * i];
      Q[j + ns * i] = keep;
    }
}

void tensor_add_part(int ns, const double *S, int deviatoric, double a,
                     double *Q) {
  double part[36];
  for (int i = 0; i < ns * ns; ++i) part[i] = S[i];
  project_columns(ns, deviatoric, part);
  transpose(ns, part);
  project_columns(ns, deviatoric, part);
  for (int i = 0; i < ns * ns; ++i) Q[i] += a * part[i];
}

#define LAW_ROW(name) &name##_law,
const law_ops *const law_list[] = {LAW_LIST(LAW_ROW) NULL};

const law_ops *law_find(const char *name) {
  for (int k = 0; law_list[k] != NULL; ++k)
    if (strcasecmp(law_list[k]->name, name) == 0) return law_list[k];
  return NULL;
}

/* Inverse of a symmetric positive definite matrix in place (Gauss-Jordan). */
static void invert(int n, double *A) {
  for (int k = 0; k < n; ++k) {
    const double pivot = A[k + n * k];
    A[k + n * k] = 1;
    for (int j = 0; j < n; ++j) A[k + n * j] /= pivot;
    for (int i = 0; i < n; ++i) {
      if (i == k) continue;
      const double factor = A[i + n * k];
      A[i + n * k] = 0;
      for (int j = 0; j < n; ++j) A[i + n * j] -= factor * A[k + n * j];
    }
  }
}

void law_elastic_set(const double C6[36], elastic_type type, kinematics kin,
                     law_elastic *out) {
  double full[36];
  const int ns = kin == SOLID_3D ? 6 : 4;
  memset(out, 0, sizeof *out);
  out->ns = ns;
  out->kin = kin;
  out->isotropic = type == ELASTIC_ISO;
  out->plane_stress = kin == PLANE_STRESS;
  elastic_reduce(C6, kin, out->E);
  COPY(out->S, out->E, ns * ns);
  if (kin == PLANE_STRESS) {
    memcpy(full, C6, sizeof full);
    invert(6, full);
    /* The xx, yy, zz, xy block of a 6x6 matrix. */
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 4; ++i) out->S[i + 4 * j] = full[i + 6 * j];
  } else {
    invert(ns, out->S);
  }
  COPY(out->C, out->S, ns * ns);
  if (kin == PLANE_STRESS)
    invert(ns, out->C);
  else
    COPY(out->C, out->E, ns * ns);
  out->young = 1 / out->S[0];
  out->shear = out->C[3 + ns * 3];
}

status law_elastic_read(const elastic_table *table, double temperature,
                        kinematics kin, law_elastic *out) {
  double C[36] = {0};
  char text[256];
  const char *wrong = elastic_at(table, temperature, C, text, sizeof text);
  if (wrong != NULL)
    RAISE(ERR_DECK, "*ELASTIC at the temperature %g: %s", temperature, wrong);
  law_elastic_set(C, table->type, kin, out);
  out->temperature = temperature;
  if (table->n > 1) out->table = table;
  return OK;
}

int law_n_alpha(const law_card *law, int ns) {
  return law->ops->n_alpha == NULL ? 0 : law->ops->n_alpha(law, ns);
}

static void clear(double *x, int n) {
  if (n > 0) CLEAR(x, n);
}

static void multiply(double *x, int n, double factor) {
  if (factor == 1) return;
  for (int i = 0; i < n; ++i) x[i] *= factor;
}

void law_rate(const law_point *p, double *ei_rate, double *alpha_rate) {
  const int ns = p->elastic->ns, na = law_n_alpha(p->law, ns);
  clear(ei_rate, ns);
  clear(alpha_rate, na);
  p->law->ops->rate(p, ei_rate, alpha_rate);
  multiply(ei_rate, ns, p->speed);
  multiply(alpha_rate, na, p->speed);
}

void law_jacobian_at(const law_point *p, law_jacobian *j) {
  const int ns = p->elastic->ns, na = law_n_alpha(p->law, ns);
  double *const block[] = {j->ei_sigma, j->ei_ei, j->ei_alpha, j->alpha_sigma,
                           j->alpha_alpha};
  const int size[] = {ns * ns, ns * ns, ns * na, na * ns, na * na};
  for (int k = 0; k < 5; ++k) clear(block[k], size[k]);
  p->law->ops->jacobian(p, j);
  for (int k = 0; k < 5; ++k) multiply(block[k], size[k], p->speed);
}

int law_flows(const law_point *p) {
  return p->speed > 0 && (p->law->ops->flows == NULL || p->law->ops->flows(p));
}

double law_dissipation(const law_point *p) {
  return p->speed * p->law->ops->dissipation(p);
}

double law_stored(const law_point *p) {
  return p->law->ops->stored == NULL ? 0 : p->law->ops->stored(p);
}

/* M[n*n] += -A E with A[rows*ns] at row "first": stress under held strain. */
static void subtract_elastic(const law_elastic *el, const double *A, int rows,
                             int first, double *M, int n) {
  for (int j = 0; j < el->ns; ++j)
    for (int k = 0; k < el->ns; ++k)
      for (int i = 0; i < rows; ++i)
        M[first + i + n * j] -= A[i + rows * k] * el->E[k + el->ns * j];
}

static void copy_block(const double *A, int rows, int columns, double *M,
                       int n) {
  for (int j = 0; j < columns; ++j)
    for (int i = 0; i < rows; ++i) M[i + n * j] += A[i + rows * j];
}

/* Matrix of d(e^i, alpha)/dt under held strain, [n*n]. */
static status coupled_matrix(const law_point *p, int na, double *M) {
  const int ns = p->elastic->ns, n = ns + na;
  law_jacobian j;
  OWNED_NEW(double, work, 2 * ns * ns + 2 * ns * na + na * na);
  j.ei_sigma = work;
  j.ei_ei = j.ei_sigma + ns * ns;
  j.ei_alpha = j.ei_ei + ns * ns;
  j.alpha_sigma = j.ei_alpha + ns * na;
  j.alpha_alpha = j.alpha_sigma + ns * na;
  law_jacobian_at(p, &j);
  subtract_elastic(p->elastic, j.ei_sigma, ns, 0, M, n);
  subtract_elastic(p->elastic, j.alpha_sigma, na, ns, M, n);
  copy_block(j.ei_ei, ns, ns, M, n);
  copy_block(j.ei_alpha, ns, na, M + n * ns, n);
  copy_block(j.alpha_alpha, na, na, M + n * ns + ns, n);
  return OK;
}

/* The largest magnitude of an eigenvalue of M[n*n], which is destroyed. */
static status spectral_radius(const law_point *p, double *M, int n,
                              double *radius) {
  OWNED_NEW(double, re, 6 * n);
  for (int i = 0; i < n * n; ++i)
    if (!isfinite(M[i]))
      RAISE(ERR_SINGULAR,
            LAW_FORM "the derivative of law %s is not a number at time %g",
            LAW_ARGS(p->law), p->law->ops->name, p->t);
  if (LAPACKE_dgeev_work(LAPACK_COL_MAJOR, 'N', 'N', n, M, n, re, re + n, NULL,
                         1, NULL, 1, re + 2 * n, 4 * n) != 0)
    RAISE(ERR_SINGULAR,
          LAW_FORM "the rates of law %s have no eigenvalues at time %g",
          LAW_ARGS(p->law), p->law->ops->name, p->t);
  *radius = 0;
  for (int i = 0; i < n; ++i) *radius = fmax(*radius, hypot(re[i], re[n + i]));
  return OK;
}

status law_fastest_rate(const law_point *p, double *rate) {
  const law_elastic *el = p->elastic;
  *rate = 0;
  if (!law_flows(p)) return OK;
  if (p->law->ops->fastest_rate != NULL && el->isotropic && !el->plane_stress)
    *rate = p->speed * p->law->ops->fastest_rate(p);
  else
    *rate = -1;
  if (!(*rate < 0)) return OK;
  const int na = law_n_alpha(p->law, el->ns), n = el->ns + na;
  OWNED_NEW(double, M, (n * n));
  PASS(coupled_matrix(p, na, M));
  return spectral_radius(p, M, n, rate);
}
