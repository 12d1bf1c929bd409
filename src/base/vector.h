/* Products of vectors in space. */
#ifndef PROTIS_BASE_VECTOR_H
#define PROTIS_BASE_VECTOR_H

static inline double vector_dot(const double *a, const double *b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* c = a x b; c is neither. */
static inline void vector_cross(const double *a, const double *b, double *c) {
  c[0] = a[1] * b[2] - a[2] * b[1];
  c[1] = a[2] * b[0] - a[0] * b[2];
  c[2] = a[0] * b[1] - a[1] * b[0];
}

#endif
