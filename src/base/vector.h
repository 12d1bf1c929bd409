/* Vectors, most of two or three components. */
#pragma once

#include <math.h>
#include <stddef.h>

static inline double dot(int dim, const double *a, const double *b) {
  double sum = 0.0;
  for (int c = 0; c < dim; ++c) sum += a[c] * b[c];
  return sum;
}

static inline double norm(int dim, const double *a) {
  return sqrt(dot(dim, a, a));
}

/* |a - b| */
static inline double distance_of(int dim, const double *a, const double *b) {
  double sum = 0.0;
  for (int c = 0; c < dim; ++c) sum += (a[c] - b[c]) * (a[c] - b[c]);
  return sqrt(sum);
}

/* d = b - a */
static inline void vector_of(int dim, const double *a, const double *b,
                             double *d) {
  for (int c = 0; c < dim; ++c) d[c] = b[c] - a[c];
}

/* To length 1, unless that is 0; the length. */
static inline double make_unit(int dim, double *v) {
  const double length = norm(dim, v);
  for (int c = 0; c < dim && length > 0.0; ++c) v[c] /= length;
  return length;
}

static inline int is_zero(int n, const double *v) {
  for (int i = 0; i < n; ++i)
    if (v[i] != 0.0) return 0;
  return 1;
}

/* c = a x b, in space */
static inline void cross(const double *a, const double *b, double *c) {
  c[0] = a[1] * b[2] - a[2] * b[1];
  c[1] = a[2] * b[0] - a[0] * b[2];
  c[2] = a[0] * b[1] - a[1] * b[0];
}

/* n normal to the triangle of corners x[9]; |n|, twice the area. */
static inline double triangle_normal(const double *x, double *n) {
  double a[3], b[3];
  vector_of(3, x, x + 3, a);
  vector_of(3, x, x + 6, b);
  cross(a, b, n);
  return norm(3, n);
}

/* Twice the area between the first two edges e, six times the volume of all. */
static inline double determinant(int dim, double (*e)[3]) {
  double c[3];
  if (dim == 2) return e[0][0] * e[1][1] - e[0][1] * e[1][0];
  cross(e[1], e[2], c);
  return dot(3, e[0], c);
}

/* to += factor v */
static inline void add_scaled(int dim, double factor, const double *v,
                              double *to) {
  for (int c = 0; c < dim; ++c) to[c] += factor * v[c];
}

/* Largest |v_i| of v[n]; 0 for n = 0. NaN is passed over. */
static inline double largest_entry(size_t n, const double *v) {
  double most = 0.0;
  for (size_t i = 0; i < n; ++i)
    if (fabs(v[i]) > most) most = fabs(v[i]);
  return most;
}

/* Power of two that brings "largest" to order 1; 1 for 0 and what is no number:
 * results then keep their bits under a change of units by such powers. */
static inline double power_to_one(double largest) {
  int exponent = 0;
  if (largest > 0.0 && largest < HUGE_VAL) frexp(largest, &exponent);
  return ldexp(1.0, -exponent);
}
