/* src/solver/lcp.c, lemke.c: complementary pivoting. */
#include "base/memory.h"
#include "solver/lcp.h"
#include "support/contact_case.h"
#include "support/unit.h"

#include <math.h>
#include <string.h>

/* ---- plain problems ------------------------------------------------------ */

enum { MOST = 12 };

/* Largest violation of z >= 0, w >= 0, z w = 0 over max |q|. */
static double violation(int n, const double *M, const double *q,
                        const double *z) {
  double worst = 0.0, size = 1e-300;
  for (int i = 0; i < n; ++i) {
    double w = q[i];
    for (int j = 0; j < n; ++j) w += M[i + n * j] * z[j];
    size = fmax(size, fabs(q[i]));
    worst = fmax(worst, fmax(-w, -z[i]));
    worst = fmax(worst, fmin(fabs(w), fabs(z[i])));
  }
  return worst / size;
}

/* Gaussian elimination with row exchange; 0: singular. A[n][n+1] */
static int eliminate(int n, double A[MOST][MOST + 1]) {
  for (int k = 0; k < n; ++k) {
    int best = k;
    for (int i = k; i < n; ++i)
      if (fabs(A[i][k]) > fabs(A[best][k])) best = i;
    if (fabs(A[best][k]) < 1e-11) return 0;
    for (int j = 0; j <= n; ++j) {
      double t = A[k][j];
      A[k][j] = A[best][j];
      A[best][j] = t;
    }
    for (int i = 0; i < n; ++i) {
      if (i == k) continue;
      double l = A[i][k] / A[k][k];
      for (int j = k; j <= n; ++j) A[i][j] -= l * A[k][j];
    }
  }
  return 1;
}

/* All sets of basic z tried. Returns the number of solutions found with a
 * regular basis; the first one in z. */
static int enumerate(int n, const double *M, const double *q, double *z) {
  int found = 0;
  for (int set = 0; set < 1 << n; ++set) {
    int id[MOST], k = 0, good = 1;
    double A[MOST][MOST + 1], x[MOST] = {0.0};
    for (int i = 0; i < n; ++i)
      if (set >> i & 1) id[k++] = i;
    for (int a = 0; a < k; ++a) {
      for (int b = 0; b < k; ++b) A[a][b] = M[id[a] + n * id[b]];
      A[a][k] = -q[id[a]];
    }
    if (!eliminate(k, A)) continue;
    for (int a = 0; a < k; ++a) {
      x[id[a]] = A[a][k] / A[a][a];
      good = good && x[id[a]] > -1e-9;
    }
    if (good && violation(n, M, q, x) < 1e-8 && found++ == 0)
      memcpy(z, x, (size_t)n * sizeof *z);
  }
  return found;
}

START_TEST(murty_matrix_takes_four_pivots) {
  const double M[] = {1, 0, 2, 2, 1, 0, 0, 2, 1}, q[] = {-1, -1, -1};
  double z[3];
  lcp_report rep;
  ck_assert_int_eq(lcp_lemke(3, M, q, 0, z, &rep), OK);
  ck_assert_int_eq(rep.outcome, CONVERGED);
  for (int i = 0; i < 3; ++i) ck_assert_double_eq_tol(z[i], 1.0 / 3.0, 1e-15);
  ck_assert_int_eq(rep.pivots, 4);
}
END_TEST

START_TEST(exponential_example_takes_two_to_the_n_pivots) {
  for (int n = 4; n <= 10; n += n == 4 ? 4 : 2) {
    double M[100] = {0.0}, q[10], z[10];
    lcp_report rep;
    for (int i = 0; i < n; ++i) {
      q[i] = -1.0;
      M[i + n * i] = 1.0;
      for (int j = 0; j < i; ++j) M[i + n * j] = 2.0;
    }
    ck_assert_int_eq(lcp_lemke(n, M, q, 0, z, &rep), OK);
    ck_assert_int_eq(rep.outcome, CONVERGED);
    ck_assert_int_eq(rep.pivots, 1 << n);
    ck_assert(rep.residual < 1e-14);
    ck_assert_int_eq(lcp_lemke(n, M, q, 10, z, &rep), OK);
    ck_assert_int_eq(rep.outcome, STOPPED_ITERATIONS);
    ck_assert_int_eq(rep.pivots, 10);
  }
}
END_TEST

/* The matrix on which the active-set Newton method cycles. */
START_TEST(newton_cycle_matrix_takes_three_pivots) {
  const double M[] = {3, 2, 0, -1, 1, -3, 1, 1, 1}, q[] = {2, -3, -1};
  double z[3];
  lcp_report rep;
  ck_assert_int_eq(lcp_lemke(3, M, q, 0, z, &rep), OK);
  ck_assert_int_eq(rep.outcome, CONVERGED);
  ck_assert_int_eq(rep.pivots, 3);
  ck_assert(z[0] == 0.0);
  ck_assert_double_eq_tol(z[1], 0.5, 1e-15);
  ck_assert_double_eq_tol(z[2], 2.5, 1e-15);
}
END_TEST

/* kind 0: M = G'G with G [k*n] of small integers (semidefinite, many ties);
 * 1: G'G + skew + I; 2: random P-matrix (strictly diagonally dominant);
 * 3: skew-symmetric integers plus a semidefinite part. */
static void random_lcp(int kind, int n, unsigned long long *seed, double *M,
                       double *q) {
  double G[MOST][MOST];
  int k = 1 + (int)(case_random(seed) * n);
  for (int i = 0; i < MOST; ++i)
    for (int j = 0; j < MOST; ++j) {
      G[i][j] = 4.0 * case_random(seed) - 2.0;
      if (kind != 1 && kind != 2) G[i][j] = round(G[i][j]);
    }
  for (int i = 0; i < n; ++i) {
    q[i] = 4.0 * case_random(seed) - 2.5;
    if (kind != 1) q[i] = round(q[i]);
    for (int j = 0; j < n; ++j) {
      double sum = 0.0, skew = i < j ? G[i][j] : i > j ? -G[j][i] : 0.0;
      for (int a = 0; a < k; ++a) sum += G[a][i] * G[a][j];
      if (kind == 2) sum = i == j ? 2.1 * n : G[i][j];
      M[i + n * j] =
          sum + (kind == 1 || kind == 3 ? skew : 0.0) + (kind == 1 && i == j);
    }
  }
}

START_TEST(random_problems_agree_with_enumeration) {
  unsigned long long seed = 20240229;
  int solved = 0, rays = 0;
  for (int t = 0; t < 2000; ++t) {
    double M[64], q[8], z[8], x[8];
    int n = 1 + t % 8, kind = t / 8 % 4;
    lcp_report rep;
    random_lcp(kind, n, &seed, M, q);
    ck_assert_int_eq(lcp_lemke(n, M, q, 0, z, &rep), OK);
    int found = enumerate(n, M, q, x);
    if (rep.outcome == CONVERGED) {
      ck_assert_msg(violation(n, M, q, z) < 1e-11, "%d: %g", t,
                    violation(n, M, q, z));
      ck_assert_msg(found > 0, "%d", t);
      for (int i = 0; (kind == 1 || kind == 2) && i < n; ++i)
        ck_assert_double_eq_tol(z[i], x[i], 1e-10);
      ++solved;
      continue;
    }
    /* M is positive semidefinite in the wide sense: the ray is a proof */
    double qy = 0.0, size = 0.0;
    ck_assert_msg(rep.outcome == STOPPED_RAY, "%d: %d", t, rep.outcome);
    ck_assert_msg(found == 0, "%d: ray, but %d solutions", t, found);
    for (int i = 0; i < n; ++i) size = fmax(size, z[i]);
    for (int i = 0; i < n; ++i) {
      double sum = 0.0;
      for (int j = 0; j < n; ++j) sum += M[j + n * i] * z[j];
      ck_assert(z[i] >= 0.0 && sum <= 1e-10 * size);
      qy += q[i] * z[i];
    }
    ck_assert_msg(qy < -1e-6 * size, "%d: q'y = %g", t, qy);
    ++rays;
  }
  ck_assert_int_gt(solved, 1200);
  ck_assert_int_gt(rays, 100);
}
END_TEST

START_TEST(large_random_problems_are_solved) {
  unsigned long long seed = 7;
  for (int n = 50; n <= 200; n += 50) {
    double *M = calloc((size_t)(n * n), sizeof *M);
    double *G = calloc((size_t)(n * n), sizeof *G);
    double *q = calloc((size_t)n, sizeof *q), *z = calloc((size_t)n, sizeof *z);
    lcp_report rep;
    for (int i = 0; i < n * n; ++i) G[i] = case_random(&seed) - 0.5;
    for (int i = 0; i < n; ++i) {
      q[i] = case_random(&seed) - 0.7;
      for (int j = 0; j < n; ++j)
        for (int k = 0; k < n; ++k) M[i + n * j] += G[i + n * k] * G[j + n * k];
    }
    ck_assert_int_eq(lcp_lemke(n, M, q, 0, z, &rep), OK);
    ck_assert_int_eq(rep.outcome, CONVERGED);
    ck_assert_msg(violation(n, M, q, z) < 1e-11, "n = %d", n);
    free(M);
    free(G);
    free(q);
    free(z);
  }
}
END_TEST

UNIT_MAIN("lemke", murty_matrix_takes_four_pivots,
          exponential_example_takes_two_to_the_n_pivots,
          newton_cycle_matrix_takes_three_pivots,
          random_problems_agree_with_enumeration,
          large_random_problems_are_solved)
