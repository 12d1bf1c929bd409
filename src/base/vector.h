/* Vectors, most of two or three components. */
#pragma once

static inline double dot(int dim, const double *a, const double *b) {
  double sum = 0.0;
  for (int c = 0; c < dim; ++c) sum += a[c] * b[c];
  return sum;
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

/* to += factor v */
static inline void add_scaled(int dim, double factor, const double *v,
                              double *to) {
  for (int c = 0; c < dim; ++c) to[c] += factor * v[c];
}
