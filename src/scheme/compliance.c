/*
 * What the laws of the points make of a change of the stresses of a step, in
 * the norms of energy (CPR98, Theorem 3.2): |Q ds|_E <= q |ds|_inv(E) with the
 * largest singular value q of R Q R, R R = E.
 */
#include "scheme/point_step.h"

#include "base/memory.h"

#include <lapacke.h>
#include <math.h>
#include <string.h>

/* R[n*n] with R R = E, symmetric and positive semidefinite. */
static int square_root(int n, const double *E, double *R) {
  double V[36], w[6];
  memcpy(V, E, (size_t)(n * n) * sizeof *V);
  memset(R, 0, (size_t)(n * n) * sizeof *R);
  if (LAPACKE_dsyev(LAPACK_COL_MAJOR, 'V', 'U', n, V, n, w) != 0) return 0;
  for (int q = 0; q < n; ++q)
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i)
        R[i + n * j] += V[i + n * q] * sqrt(fmax(w[q], 0.0)) * V[j + n * q];
  return 1;
}

/* The largest singular value of R Q R. */
static status energy_size(int n, const double *E, const double *Q,
                          double *size) {
  status st = OK;
  double R[36], QR[36], N[36], w[6], unused[6];
  int known = square_root(n, E, R);
  for (int j = 0; j < n; ++j) tensor_product(n, Q, R + n * j, QR + n * j);
  for (int j = 0; j < n; ++j) tensor_product(n, R, QR + n * j, N + n * j);
  if (!known || LAPACKE_dgesvd(LAPACK_COL_MAJOR, 'N', 'N', n, n, N, n, w, NULL,
                               1, NULL, 1, unused) != 0)
    FAIL(ERR_SINGULAR, "the compliance of an inelastic law is no number");
  *size = w[0];
done:
  return st;
}

status flow_compliance(const flow *x, const scheme_step *p,
                       const flow_state *old, const flow_state *now, double *Q,
                       double *largest) {
  status st = OK;
  const size_t square = (size_t)(x->ns * x->ns);
  point_step l = {0};
  *largest = 0.0;
  TRY(point_step_new(x, &l));
  for (int k = 0; k < x->n; ++k) {
    double size = 0.0, *own = Q + square * (size_t)k;
    TRY(point_step_compliance(x, p, k, old, now, &l, own));
    TRY(energy_size(x->ns, l.E, own, &size));
    *largest = fmax(*largest, size);
  }
done:
  point_step_free(&l);
  return st;
}
