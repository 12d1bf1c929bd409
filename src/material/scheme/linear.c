/*
 * Maps of implicit steps of linear laws with constant coefficients. With
 * y = (e^i, alpha) and the strain e (less the thermal one) of a point,
 *   y' = L y + G e,   sigma = E (e - e^i),
 * a step is
 *   y_new = P y_old + Q0 e_old + Q1 e_new
 * with matrices that depend on the law and dt alone, so that the body has the
 * constant elasticity D = E (I - Q1_ei) and needs one equilibrium:
 *   THETA        y_new = y_old + dt (L y_th + G e_th),
 *                x_th = (1-theta) x_old + theta x_new
 *   EXPONENTIAL  the exact solution for e linear in time over the step:
 *                exp(dt L), dt phi_1(dt L) G, dt phi_2(dt L) G
 */
#include "material/scheme/work.h"

#include "base/memory.h"

#include <lapacke.h>
#include <math.h>
#include <string.h>

/* C[n*m] += a A[n*k] B[k*m], column major */
static void multiply(int n, int k, int m, double a, const double *A,
                     const double *B, double *C) {
  for (int j = 0; j < m; ++j)
    for (int q = 0; q < k; ++q) {
      double factor = a * B[q + k * j];
      for (int i = 0; i < n && factor != 0.0; ++i)
        C[i + n * j] += factor * A[i + n * q];
    }
}

static void put_block(int rows, int columns, const double *A, double *M,
                      int ld) {
  for (int j = 0; j < columns; ++j)
    for (int i = 0; i < rows; ++i) M[i + ld * j] += A[i + rows * j];
}

/* Blocks of the Jacobian of the point p in one array, new. */
static status new_jacobian(const law_point *p, int na, law_jacobian *j) {
  int ns = p->elastic->ns;
  PASS_NEW(j->ei_sigma, 2 * ns * ns + 2 * ns * na + na * na);
  j->ei_ei = j->ei_sigma + ns * ns;
  j->ei_alpha = j->ei_ei + ns * ns;
  j->alpha_sigma = j->ei_alpha + ns * na;
  j->alpha_alpha = j->alpha_sigma + na * ns;
  law_jacobian_at(p, j);
  return OK;
}

/* y' = L y + G e of a linear law, L[n*n], G[n*ns]. */
static status linear_law(const flow_kind *k, double *L, double *G) {
  status st = OK;
  const law_elastic *el = &k->elastic;
  const int ns = el->ns, na = k->n_alpha, n = ns + na;
  law_jacobian j = {0};
  double *zero = NULL, *top = NULL;
  NEW(zero, n);
  NEW(top, n * ns);
  law_point p = {.law = k->law,
                 .elastic = el,
                 .value = k->value,
                 .speed = k->speed,
                 .sigma = zero,
                 .ei = zero,
                 .alpha = zero};
  TRY(new_jacobian(&p, na, &j));
  put_block(ns, ns, j.ei_sigma, top, n);
  put_block(na, ns, j.alpha_sigma, top + ns, n);
  multiply(n, ns, ns, 1.0, top, el->E, G);
  for (int i = 0; i < n * ns; ++i) L[i] = -G[i];
  put_block(ns, ns, j.ei_ei, L, n);
  put_block(ns, na, j.ei_alpha, L + n * ns, n);
  put_block(na, na, j.alpha_alpha, L + n * ns + ns, n);
done:
  RELEASE(j.ei_sigma, zero, top);
  return st;
}

/* X[n*m] := inv(M) X; M is destroyed. */
static status solve(int n, int m, double *M, double *X) {
  OWNED int *pivot = NULL;
  PASS_NEW(pivot, n);
  if (LAPACKE_dgesv(LAPACK_COL_MAJOR, n, m, M, n, pivot, X, n) != 0)
    RAISE(ERR_SINGULAR, "the step of an inelastic law has no solution");
  return OK;
}

static status theta_map(const flow_kind *k, const scheme_step *p,
                        const double *L, const double *G, linear_map *m) {
  const int n = m->n, ns = k->elastic.ns, columns = n + 2 * ns;
  const double in = p->theta * p->dt, out = (1.0 - p->theta) * p->dt;
  OWNED double *M = NULL, *X = NULL;
  PASS_NEW(M, n * n);
  PASS_NEW(X, n * columns);
  for (int i = 0; i < n * n; ++i) {
    double one = i % (n + 1) == 0;
    M[i] = one - in * L[i];
    X[i] = one + out * L[i];
  }
  for (int i = 0; i < n * ns; ++i) {
    X[n * n + i] = out * G[i];
    X[n * (n + ns) + i] = in * G[i];
  }
  PASS(solve(n, columns, M, X));
  memcpy(m->P, X, (size_t)(n * n) * sizeof *X);
  memcpy(m->Q0, X + n * n, (size_t)(n * ns) * sizeof *X);
  memcpy(m->Q1, X + n * (n + ns), (size_t)(n * ns) * sizeof *X);
  return OK;
}

/* X = exp(A) - I for A[n*n] of any size: Taylor below 2^-6, then squaring in
 * the form X <- 2 X + X X, which preserves slow rates next to fast ones. */
status exponential_less_one(int n, const double *A, double *X) {
  enum { TERMS = 12 };
  OWNED double *power = NULL, *next = NULL;
  double largest = 0.0;
  size_t square = (size_t)n * (size_t)n;
  int halvings = 0;
  PASS_NEW(power, square);
  PASS_NEW(next, square);
  for (int i = 0; i < n; ++i) {
    double row = 0.0;
    for (int j = 0; j < n; ++j) row += fabs(A[i + n * j]);
    largest = fmax(largest, row);
  }
  if (largest > 0.0) frexp(largest * 64.0, &halvings);
  if (halvings < 0) halvings = 0;
  for (size_t i = 0; i < square; ++i) X[i] = power[i] = ldexp(A[i], -halvings);
  for (int k = 2; k <= TERMS; ++k) {
    memset(next, 0, square * sizeof *next);
    multiply(n, n, n, ldexp(1.0 / k, -halvings), A, power, next);
    for (size_t i = 0; i < square; ++i) X[i] += power[i] = next[i];
  }
  for (; halvings > 0; --halvings) {
    for (size_t i = 0; i < square; ++i) next[i] = 2.0 * X[i];
    multiply(n, n, n, 1.0, X, X, next);
    memcpy(X, next, square * sizeof *X);
  }
  return OK;
}

/* exp of [dt L, dt G, 0; 0, 0, I; 0, 0, 0]: its first row is exp(dt L),
 * dt phi_1 G, dt phi_2 G. */
static status exponential_map(const flow_kind *k, const scheme_step *p,
                              const double *L, const double *G, linear_map *m) {
  const int n = m->n, ns = k->elastic.ns, N = n + 2 * ns;
  OWNED double *A = NULL, *X = NULL;
  PASS_NEW(A, N * N);
  PASS_NEW(X, N * N);
  put_block(n, n, L, A, N);
  put_block(n, ns, G, A + N * n, N);
  for (int i = 0; i < N * N; ++i) A[i] *= p->dt;
  for (int i = 0; i < ns; ++i) A[n + i + N * (n + ns + i)] = 1.0;
  PASS(exponential_less_one(N, A, X));
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) m->P[i + n * j] = X[i + N * j] + (i == j);
  for (int j = 0; j < ns; ++j)
    for (int i = 0; i < n; ++i) {
      m->Q1[i + n * j] = X[i + N * (n + ns + j)];
      m->Q0[i + n * j] = X[i + N * (n + j)] - m->Q1[i + n * j];
    }
  return OK;
}

/* D = E (I - Q1) with the rows of e^i. */
static void remains(const law_elastic *el, const linear_map *m, double *D) {
  const int ns = el->ns;
  double top[36];
  for (int j = 0; j < ns; ++j)
    for (int i = 0; i < ns; ++i) top[i + ns * j] = m->Q1[i + m->n * j];
  memcpy(D, el->E, (size_t)(ns * ns) * sizeof *D);
  multiply(ns, ns, ns, -1.0, el->E, top, D);
}

/* The general case: from L and G. */
status general_map(const flow_kind *k, const scheme_step *p, int exact,
                   linear_map *m, double *D) {
  OWNED double *L = NULL, *G = NULL;
  PASS_NEW(L, m->n * m->n);
  PASS_NEW(G, m->n * k->elastic.ns);
  PASS(linear_law(k, L, G));
  PASS(exact ? exponential_map(k, p, L, G, m) : theta_map(k, p, L, G, m));
  remains(&k->elastic, m, D);
  return OK;
}
