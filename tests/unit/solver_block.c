/* src/solver: blocks on a floor, sliding, as published, and lying free. */
#include "support/solver_rows.h"
#include "support/unit.h"

/* ---- blocks ------------------------------------------------------------- */

/* 100 nodes (200 in the long run), numbered along the sliding direction,
 * mu = 0.3. */
TEST(plain_block_slides_for_every_row) {
  for (int tall = 0; tall < 2; ++tall) {
    case_block_data d = {.columns = unit_whole() ? 199 : 99,
                         .layers = tall ? 60 : 8,
                         .clamped = 1,
                         .nu = 0.3,
                         .mu = 0.3,
                         .left = {2e-3, 0}};
    CONTACT_CASE c = case_block(&d);
    int m = c.cp.m;
    FREED double *top = calloc((size_t)m, sizeof *top);
    for (int i = 0; i < c.cp.n; ++i) { /* the clamped top moves              */
      top[2 * i] = 1e-3;
      top[2 * i + 1] = 4e-4;
    }
    for (int i = 0; i < m; ++i)
      for (int j = 0; j < m; ++j) c.f[i] += c.A[i + m * j] * top[j];
    all_rows_solve(&c, "sliding block", 1e-9);
    /* and in compliance form, where relaxation is known to cycle */
    FREED double *W = calloc((size_t)m * (size_t)m, sizeof *W);
    ck_assert(case_inverse(m, c.A, W));
    contact_case w = c;
    FREED double *q = calloc((size_t)m, sizeof *q);
    contact_product(m, W, c.f, q);
    w.cp.A = NULL;
    w.cp.W = W;
    w.cp.f = q;
    EACH_SOLVER(i, ops) {
      case_cold(&c);
      solver_report rep = solve_by(ops, &w, 1e-10, c.u, c.r);
      ck_assert_msg(rep.outcome == CONVERGED, "%s: %s", row_name(ops),
                    outcome_text(rep.outcome));
      ck_assert_double_lt(case_violation(&c, c.u, c.r), 1e-7);
    }
  }
}

TEST(published_block_is_met) {
  contact_case c = case_published(32, 1.0);
  double um = 40.0 / 32 * 1e3;
  all_rows_solve(&c, "block", 1e-9);
  ck_assert_double_eq_tol(um * c.u[1], 28.60, 0.09);
  ck_assert_double_eq_tol(um * c.u[2 * 4 + 1], 22.86, 0.07);
  ck_assert_double_eq_tol(um * c.u[2 * 9 + 1], 15.41, 0.05);
  case_free(&c);
  c = case_published(32, 0.0);
  all_rows_solve(&c, "block without friction", 1e-9);
  ck_assert_double_eq_tol(um * c.u[1], 40.615, 0.01);
  case_free(&c);
}

/* ---- bodies that contact alone holds ------------------------------------ */

/* A block 32 x 16 with tractions on its top. */
static contact_case lying_block(double mu, double push, double shear) {
  case_block_data d = {.columns = 32,
                       .layers = 16,
                       .nu = 0.2,
                       .mu = mu,
                       .top = {shear * 1e-3, -push * 1e-3}};
  return case_block(&d);
}

TEST(lying_block_is_held_by_contact_and_friction) {
  static const double shears[] = {0.0, 0.1, 0.29};
  const solver_ops *ops;
  for (int k = 0; k < 3; ++k) {
    CONTACT_CASE c = lying_block(0.3, 1.0, shears[k]);
    for (int i = 0; solver_row(i, &ops); ++i) {
      case_cold(&c);
      solver_report rep = solve_by(ops, &c, 1e-10, c.u, c.r);
      ck_assert_msg(rep.outcome == CONVERGED, "%s: %s", row_name(ops),
                    outcome_text(rep.outcome));
      double N = 0.0, T = 0.0, M = 0.0;
      for (int j = 0; j < c.cp.n; ++j) {
        N -= c.r[2 * j];
        T += c.r[2 * j + 1];
        M -= c.r[2 * j] * j;
      }
      double P = 0.032;
      ck_assert_double_eq_tol(N, P, 1e-10 * P * 33);
      ck_assert_double_eq_tol(T, -shears[k] * P, 1e-10 * P * 33);
      /* shear at height 16 moves the resultant of the pressure */
      ck_assert_double_eq_tol(M, 16 * P + 16 * shears[k] * P, 1e-8 * P);
    }
  }
}

TEST(no_equilibrium_is_said_never_numbers) {
  static const struct {
    double mu, push, shear;
  } hopeless[] = {{0.3, -1, 0}, {0, -1, 0},  {0.3, 1, 0.4},
                  {0, 1, 0.1},  {3, 1, 1.2}, {1, 1, 1.01}};
  const solver_ops *ops;
  for (int k = 0; k < 6; ++k) {
    CONTACT_CASE c =
        lying_block(hopeless[k].mu, hopeless[k].push, hopeless[k].shear);
    for (int i = 0; solver_row(i, &ops); ++i) {
      case_cold(&c);
      solver_report rep = solve_by(ops, &c, 1e-10, c.u, c.r);
      ck_assert_int_lt(rep.outcome, 0);
      if (ops == NULL) ck_assert_int_eq(rep.outcome, STOPPED_RAY);
    }
  }
}

TEST(motion_that_nothing_fixes_is_smallest) {
  CONTACT_CASE c = lying_block(0.0, 1.0, 0.0);
  solver_report rep = solve_by(NULL, &c, 1e-10, c.u, c.r);
  ck_assert_int_eq(rep.outcome, CONVERGED);
  double mean = 0.0, largest = 0.0;
  for (int i = 0; i < c.cp.n; ++i) {
    mean += c.u[2 * i + 1] / c.cp.n;
    largest = fmax(largest, fabs(c.u[2 * i + 1]));
  }
  ck_assert_double_gt(largest, 0.0);
  ck_assert_double_lt(fabs(mean), 1e-3 * largest);
}

UNIT_MAIN("solver_block")
