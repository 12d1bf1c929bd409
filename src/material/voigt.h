/*
 * Products of tensors in Voigt components, 4 of them in the plane and 6 in
 * space: no loop whose length is not known, for what is done once per element.
 */
#ifndef PROTIS_MATERIAL_VOIGT_H
#define PROTIS_MATERIAL_VOIGT_H

/* y = A x, A[ns*ns] column major; y is neither A nor x */
static inline void voigt_product(int ns, const double *restrict A,
                                 const double *restrict x, double *restrict y) {
  if (ns == 4) {
    for (int i = 0; i < 4; ++i)
      y[i] = A[i] * x[0] + A[i + 4] * x[1] + A[i + 8] * x[2] + A[i + 12] * x[3];
  } else {
    for (int i = 0; i < 6; ++i)
      y[i] = A[i] * x[0] + A[i + 6] * x[1] + A[i + 12] * x[2] +
             A[i + 18] * x[3] + A[i + 24] * x[4] + A[i + 30] * x[5];
  }
}

/* y += A x */
static inline void voigt_add(int ns, const double *restrict A,
                             const double *restrict x, double *restrict y) {
  double more[6];
  voigt_product(ns, A, x, more);
  for (int i = 0; i < 4; ++i) y[i] += more[i];
  for (int i = 4; i < ns; ++i) y[i] += more[i];
}

/* a' b */
static inline double voigt_dot(int ns, const double *a, const double *b) {
  double sum = a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3];
  if (ns == 6) sum += a[4] * b[4] + a[5] * b[5];
  return sum;
}

#endif
