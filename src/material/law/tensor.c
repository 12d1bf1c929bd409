/*
 * Deviators, equivalent stress and flow directions in Voigt components.
 */
#include "material/law/law.h"
#include "material/voigt.h"

#include <math.h>

double tensor_trace(const double *v) { return v[0] + v[1] + v[2]; }

void tensor_deviator(int ns, const double *v, double *d) {
  const double mean = tensor_trace(v) / 3;
  for (int i = 0; i < ns; ++i) d[i] = i < 3 ? v[i] - mean : v[i];
}

double tensor_mises(int ns, const double *s) {
  double largest = 0, sum = 0;
  for (int i = 0; i < ns; ++i) largest = fmax(largest, fabs(s[i]));
  if (!(largest > 0)) return largest;
  for (int i = 0; i < ns; ++i) {
    const double x = s[i] / largest;
    sum += i < 3 ? x * x : 2 * x * x;
  }
  return largest * sqrt(1.5 * sum);
}

double tensor_dot(int ns, const double *a, const double *b) {
  double sum = 0;
  for (int i = 0; i < ns; ++i) sum += a[i] * b[i];
  return sum;
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
    for (int i = 0; i < ns; ++i) {
      if (deviatoric)
        v[i] -= i < 3 ? mean : 0;
      else
        v[i] = i < 3 ? mean : 0;
    }
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
