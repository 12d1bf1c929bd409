/*
 * Products of tensors in Voigt components, 4 of them in the plane and 6 in
 * space, for what is done once per element: two components at a time, and no
 * loop whose length is not known. Sums of each component as in a plain loop.
 */
#pragma once

/* Two adjacent components in any array of double. */
typedef double voigt_pair
    __attribute__((vector_size(16), aligned(8), may_alias));

/* Components 2 i and 2 i + 1 of A x, A[ns*ns] column major. */
static inline voigt_pair voigt_rows(int ns, const double *A, const double *x,
                                    int i) {
  const voigt_pair *a = (const voigt_pair *)A + i;
  if (ns == 4) return a[0] * x[0] + a[2] * x[1] + a[4] * x[2] + a[6] * x[3];
  return a[0] * x[0] + a[3] * x[1] + a[6] * x[2] + a[9] * x[3] + a[12] * x[4] +
         a[15] * x[5];
}

/* y = A x; y is not x */
static inline void voigt_product(int ns, const double *A, const double *x,
                                 double *y) {
  voigt_pair *out = (voigt_pair *)y;
  out[0] = voigt_rows(ns, A, x, 0);
  out[1] = voigt_rows(ns, A, x, 1);
  if (ns != 4) out[2] = voigt_rows(6, A, x, 2);
}

/* y += A x */
static inline void voigt_add(int ns, const double *A, const double *x,
                             double *y) {
  voigt_pair *out = (voigt_pair *)y;
  out[0] += voigt_rows(ns, A, x, 0);
  out[1] += voigt_rows(ns, A, x, 1);
  if (ns != 4) out[2] += voigt_rows(6, A, x, 2);
}

/* a' b */
static inline double voigt_dot(int ns, const double *a, const double *b) {
  const voigt_pair *p = (const voigt_pair *)a, *q = (const voigt_pair *)b;
  voigt_pair sum = p[0] * q[0] + p[1] * q[1];
  if (ns != 4) sum += p[2] * q[2];
  return sum[0] + sum[1];
}

/* e:e of a strain, its shears those of engineers: twice the tensor's */
static inline double voigt_strain_square(int ns, const double *e) {
  double sum = 0.0;
  for (int i = 0; i < ns; ++i) sum += (i < 3 ? 1.0 : 0.5) * e[i] * e[i];
  return sum;
}
