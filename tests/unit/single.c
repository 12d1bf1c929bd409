/* src/solver/single.c: the problem of one node, solved directly. */
#include "solver/single.h"
#include "support/solver_rows.h"
#include "support/unit.h"

static const double TOL = 1e-12;

/* M = G G' of the rank, or with "share" unsymmetric. */
static void fill(contact_case *c, int rank, double share,
                 unsigned long long *seed) {
  int m = c->cp.m;
  double G[9];
  for (int i = 0; i < m * rank; ++i) G[i] = case_random(seed) - 0.5;
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < m; ++j) {
      double sum = rank == m && i == j ? 1e-3 : 0.0;
      for (int k = 0; k < rank; ++k) sum += G[i * rank + k] * G[j * rank + k];
      c->A[i + m * j] = sum * (1.0 + share * (case_random(seed) - 0.5));
    }
}

static contact_case any(int dim, double mu, int rank, double share,
                        unsigned long long *seed) {
  contact_case c = case_new(dim, 1, mu);
  fill(&c, rank, share, seed);
  for (int i = 0; i < dim; ++i) c.f[i] = 2.0 * case_random(seed) - 1.0;
  c.gap[0] = 0.2 * (case_random(seed) - 0.5);
  for (int k = 0; k + 1 < dim; ++k) c.ut0[k] = case_random(seed) - 0.5;
  return c;
}

static void must_solve(contact_case *c, int k) {
  static const solver_ops *const rows[] = {&newton_solver, NULL};
  for (int i = 0; i < 2; ++i) {
    case_cold(c);
    solver_report rep = solve_by(rows[i], c, TOL, c->u, c->r);
    ck_assert_msg(rep.outcome == CONVERGED, "%s: %d: %s, residual %g",
                  row_name(rows[i]), k, outcome_text(rep.outcome),
                  rep.residual);
    ck_assert_int_le(rows[i] == NULL ? 0 : rep.iterations, 1);
  }
}

/* There always is a solution; some with friction of a limit of its own. */
TEST(definite_stiffness_is_always_solved) {
  static const double mu[] = {0.05, 0.3, 0.6, 0.7, 1.0, 3.0, 30.0};
  unsigned long long seed = 3;
  for (int k = 0; k < 2100; ++k) {
    int dim = 2 + k % 2;
    CONTACT_CASE c = any(dim, mu[k / 2 % 7], dim, 0.0, &seed);
    if (k % 3 == 0) c.g0[0] = 0.1 * case_random(&seed);
    must_solve(&c, k);
    ck_assert_double_lt(case_violation(&c, c.u, c.r), 1e-9);
  }
}

/* A solution is planted: closed, sticking or slipping. */
TEST(unsymmetric_or_singular_compliance_is_solved) {
  static const double mu[] = {0.1, 0.6, 0.7, 2.0};
  unsigned long long seed = 5;
  for (int k = 0; k < 2000; ++k) {
    int dim = 2 + k % 2, rank = k % 5 == 0 ? dim - 1 : dim;
    CONTACT_CASE c = any(dim, mu[k / 2 % 4], rank, 0.05, &seed);
    double a = 6.3 * case_random(&seed), s = case_random(&seed), Wr[3];
    double T = mu[k / 2 % 4] * (k % 3 == 0 ? 0.5 : 1.0);
    double r[3] = {-1.0, -T * (dim == 3 ? cos(a) : 1.0), -T * sin(a)};
    contact_product(dim, c.A, r, Wr);
    for (int i = 0; i < dim; ++i) {
      double u = i == 0 ? c.gap[0] : c.ut0[i - 1];
      if (i > 0 && k % 3 != 0) u -= s * r[i];
      c.f[i] = u - Wr[i];
    }
    c.cp.W = c.A;
    c.cp.A = NULL;
    must_solve(&c, k);
  }
}

/* The triangle of three solutions: each is found from a start like it. */
TEST(solution_like_the_start_is_taken) {
  static const double slip[] = {0.0, 1.04, 2.2471428571428571};
  CONTACT_CASE c = case_triangle(0.3, 2.0, 1.9, -1.0);
  double scale = contact_scale(&c.cp), residual;
  for (int k = 0; k < 6; ++k) {
    double way = k % 2 ? 1.0 : -1.0, u[2], r[2] = {-1.0, 0.0};
    u[0] = k / 2 == 2 ? -1.0 : 0.0;
    u[1] = k / 2 == 0 ? 0.0 : 9.0 * way;
    if (k / 2 == 1) r[1] = -2.0 * way;
    if (k / 2 == 2) r[0] = 0.0;
    ck_assert(single_solve(&c.cp, scale, TOL, u, r, &residual));
    ck_assert_double_eq_tol(fabs(u[1]), slip[k / 2], 1e-9);
  }
}

UNIT_MAIN("single")
