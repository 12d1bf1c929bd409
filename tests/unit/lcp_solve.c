/* src/solver/lcp/lcp_solve.c: plain complementarity
 * problems of all kinds. */
#include "base/base.h"
#include "solver/lcp/lcp_solve.h"
#include "support/lcp_case.h"
#include "support/unit.h"

static lcp_verdict solve(lcp_case *c, const lcp_control *control) {
  lcp_data p = {c->n, c->M, c->q};
  lcp_verdict v;
  memset(c->z, 0, (size_t)c->n * sizeof *c->z);
  ck_assert_int_eq(lcp_solve(&p, control, c->z, c->w, &v), OK);
  return v;
}

static const lcp_control usual = {.tol = 1e-8};

/* w[n] belongs to z, and a claim holds by the test's own measure. */
static void check_claim(const lcp_case *c, const lcp_verdict *v) {
  for (int i = 0; i < c->n; ++i) {
    double w = c->q[i], terms = fabs(w);
    for (int j = 0; j < c->n; ++j) {
      w += c->M[i + c->n * j] * c->z[j];
      terms += fabs(c->M[i + c->n * j] * c->z[j]);
    }
    ck_assert(fabs(w - c->w[i]) <= 1e-14 * terms);
  }
  if (v->outcome != CONVERGED) return;
  double bad = lcp_violation(c, c->z);
  ck_assert_msg(bad <= 1e-8, "violation %g, residual %g", bad, v->residual);
}

START_TEST(families_with_a_solution_are_solved) {
  static const int sizes[] = {2, 3, 5, 8, 16, 40};
  for (int family = 0; family < LCP_INDEFINITE; ++family)
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; ++k)
      for (unsigned long long seed = 1; seed <= 4; ++seed) {
        lcp_case c = lcp_make((lcp_family)family, sizes[k], seed);
        lcp_verdict v = solve(&c, &usual);
        ck_assert_msg(v.outcome == CONVERGED, "%s, n = %d, seed %llu: %s",
                      lcp_name((lcp_family)family), c.n, seed,
                      outcome_text(v.outcome));
        check_claim(&c, &v);
        lcp_case_free(&c);
      }
}
END_TEST

START_TEST(planted_solutions_of_small_problems_are_found) {
  int solved = 0, tried = 0;
  for (int family = LCP_INDEFINITE; family <= LCP_NEGATIVE; ++family)
    for (unsigned long long seed = 1; seed <= 60; ++seed) {
      lcp_case c = lcp_make((lcp_family)family, 2 + (int)seed % 9, seed);
      lcp_verdict v = solve(&c, &usual);
      ck_assert_int_ne(v.outcome, STOPPED_RAY); /* there is a solution        */
      check_claim(&c, &v);
      solved += v.outcome == CONVERGED;
      ++tried;
      lcp_case_free(&c);
    }
  ck_assert_int_eq(solved, tried);
}
END_TEST

START_TEST(problems_without_solution_are_proved_to_have_none) {
  static const int sizes[] = {2, 3, 7, 20, 60};
  for (int family = LCP_INFEASIBLE; family < LCP_FAMILIES; ++family)
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; ++k)
      for (unsigned long long seed = 1; seed <= 4; ++seed) {
        lcp_case c = lcp_make((lcp_family)family, sizes[k], seed);
        lcp_verdict v = solve(&c, &usual);
        ck_assert_msg(v.outcome == STOPPED_RAY, "%s, n = %d: %s (%s)",
                      lcp_name((lcp_family)family), c.n,
                      outcome_text(v.outcome), v.log);
        check_claim(&c, &v);
        lcp_case_free(&c);
      }
}
END_TEST

/* w_1 = z_2 - 1, w_2 = 1 - z_1: z = (0, z_2) needs w_1 = 0 where z_1 > 0 only.
 * z_1 w_1 = 0 and z_2 w_2 = 0 with w_1 >= 0: z_2 >= 1, so w_2 = 0, z_1 = 1,
 * w_1 = 0: z = (1, 1). M is indefinite, and pivoting finds a ray. */
/* The first tries, short where others follow, end before a ray. */
START_TEST(proof_is_looked_for_after_short_tries) {
  lcp_case c = lcp_make(LCP_INFEASIBLE, 160, 257);
  const lcp_control control = {.tol = 1e-8};
  lcp_data p = {c.n, c.M, c.q};
  lcp_verdict v;
  ck_assert_int_eq(lcp_solve(&p, &control, c.z, c.w, &v), OK);
  ck_assert_int_eq(v.outcome, STOPPED_RAY);
  lcp_case_free(&c);
}
END_TEST

START_TEST(ray_of_an_indefinite_problem_is_no_verdict) {
  lcp_case c = lcp_make(LCP_INDEFINITE, 2, 1);
  const double M[4] = {0.0, -1.0, 1.0, 0.0}, q[2] = {-1.0, 1.0};
  for (int flip = 0; flip <= 1; ++flip) {
    memcpy(c.M, M, sizeof M);
    memcpy(c.q, q, sizeof q);
    c.M[1] = flip ? 1.0 : -1.0; /* flip: w_2 = z_1 + 1 is never zero          */
    lcp_verdict v = solve(&c, &usual);
    ck_assert_int_eq(v.outcome, flip ? STOPPED_RAY : CONVERGED);
    ck_assert_int_le(v.iterations, 100);
    if (!flip)
      for (int i = 0; i < 2; ++i) ck_assert_double_eq_tol(c.z[i], 1.0, 1e-15);
  }
  lcp_case_free(&c);
}
END_TEST

/* Two 2^n pivots long: the first try ends early. */
START_TEST(long_paths_are_left_early) {
  for (int family = LCP_MURTY; family <= LCP_FATHI; ++family)
    for (int n = 60; n <= 120; n += 60) {
      lcp_case c = lcp_make((lcp_family)family, n, 1);
      lcp_verdict v = solve(&c, &usual);
      ck_assert_int_eq(v.outcome, CONVERGED);
      ck_assert_int_le(v.iterations, 20 * n);
      check_claim(&c, &v);
      lcp_case_free(&c);
    }
}
END_TEST

/* No solution but a z >= 0 with w >= 0: only all bases tell; a little more, and
 * there is one. */
START_TEST(all_bases_decide_from_both_sides) {
  static const double off[] = {1.0, 1e-3, 1e-6};
  for (int k = 0; k < 6; ++k) {
    int none = k % 2, n = 2 + k;
    lcp_case c = lcp_make(LCP_DEFINITE, n, 5);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < 2; ++j) c.M[i + n * j] = c.M[j + n * i] = 0.0;
    c.M[1] = c.M[n] = 1.0; /* w_1 = z_2 - 1, w_2 = z_1 + q_2                  */
    c.q[0] = -1.0;
    c.q[1] = none ? off[k / 2] : -off[k / 2];
    lcp_verdict v = solve(&c, &usual);
    ck_assert_msg(v.outcome == (none ? STOPPED_RAY : CONVERGED), "%d: %s (%s)",
                  k, outcome_text(v.outcome), v.log);
    check_claim(&c, &v);
    lcp_case_free(&c);
  }
}
END_TEST

/* The method that was asked for is the only one; its limit is told. */
START_TEST(limit_of_pivots_is_told) {
  const lcp_control few = {.tol = 1e-8, .max_iter = 3, .pivoting_only = 1};
  lcp_case c = lcp_make(LCP_DEFINITE, 30, 1);
  lcp_verdict v = solve(&c, &few);
  ck_assert_int_eq(v.outcome, STOPPED_ITERATIONS);
  ck_assert(v.residual > 1e-8);
  ck_assert_ptr_nonnull(strstr(v.log, "limit of iterations"));
  ck_assert_int_le(v.iterations, few.max_iter);
  lcp_case_free(&c);
  const lcp_control some = {.tol = 1e-8, .max_iter = 150};
  c = lcp_make(LCP_INDEFINITE, 40, 1);
  v = solve(&c, &some);
  ck_assert_int_eq(v.outcome, STOPPED_ITERATIONS);
  ck_assert_int_le(v.iterations, some.max_iter);
  lcp_case_free(&c);
  c = lcp_make(LCP_MURTY, 40, 1);
  v = solve(&c, &usual);
  ck_assert_int_eq(v.outcome, CONVERGED);
  ck_assert_str_eq(v.method, "newton");
  ck_assert_ptr_nonnull(strstr(v.log, "lemke: limit of iterations"));
  lcp_case_free(&c);
}
END_TEST

/* Strictly upper triangular: of every basis M_BB is singular, and solutions are
 * a continuum; pivoting ends on rays. */
START_TEST(singular_bases_are_solved) {
  for (unsigned long long seed = 1; seed <= 8; ++seed) {
    lcp_case c = lcp_make(LCP_TRIANGULAR, 8, seed);
    for (int i = 0; i < c.n; ++i) {
      c.q[i] = i % 2 ? 0.5 : 0.0; /* z = 1, 0, 1, 0 ...                       */
      for (int j = 0; j < i; ++j) {
        c.M[j + c.n * i] = c.M[i + c.n * j];
        c.M[i + c.n * j] = 0.0;
      }
      c.M[i + c.n * i] = 0.0;
    }
    for (int j = 0; j < c.n; j += 2)
      for (int i = 0; i < j; ++i) c.q[i] -= c.M[i + c.n * j];
    lcp_verdict v = solve(&c, &usual);
    ck_assert_msg(v.outcome == CONVERGED, "seed %llu: %s (%s)", seed,
                  outcome_text(v.outcome), v.log);
    check_claim(&c, &v);
    lcp_case_free(&c);
  }
}
END_TEST

/* z and w change places twice: the problem comes back. */
START_TEST(transform_is_its_own_inverse) {
  for (int family = 0; family < LCP_FAMILIES; ++family) {
    int n = 6, any = 0;
    lcp_case c = lcp_make((lcp_family)family, n, 3);
    lcp_case d = lcp_make((lcp_family)family, n, 3);
    unsigned char turned[6] = {0};
    double row[6], z[6], w[6], x[6], y[6];
    unsigned seed = 5;
    lcp_turn(n, 3, &seed, d.M, d.q, turned, row);
    for (int i = 0; i < n; ++i) z[i] = 0.25 * (i + 1) * (i % 2 ? -1.0 : 1.0);
    for (int i = 0; i < n; ++i) {
      w[i] = c.q[i];
      for (int j = 0; j < n; ++j) w[i] += c.M[i + n * j] * z[j];
    }
    for (int i = 0; i < n; ++i) {
      any += turned[i];
      x[i] = turned[i] ? w[i] : z[i];
    }
    for (int i = 0; i < n; ++i) {
      double want = turned[i] ? z[i] : w[i], size = fabs(d.q[i]);
      y[i] = d.q[i];
      for (int j = 0; j < n; ++j) {
        y[i] += d.M[i + n * j] * x[j];
        size += fabs(d.M[i + n * j] * x[j]);
      }
      ck_assert_msg(fabs(y[i] - want) <= 1e-12 * (size + fabs(want)), "%s: %g",
                    lcp_name((lcp_family)family), y[i] - want);
    }
    ck_assert_int_gt(any, 0);
    lcp_case_free(&c);
    lcp_case_free(&d);
  }
}
END_TEST

START_TEST(not_a_number_is_told) {
  lcp_case c = lcp_make(LCP_DEFINITE, 4, 1);
  c.q[2] = NAN;
  ck_assert_int_eq(solve(&c, &usual).outcome, STOPPED_NAN);
  lcp_case_free(&c);
}
END_TEST

START_TEST(every_refused_request_is_reported) {
  static const lcp_family families[] = {LCP_BIMATRIX, LCP_NEGATIVE, LCP_FLAT};
  for (size_t k = 0; k < sizeof families / sizeof *families; ++k) {
    lcp_case c = lcp_make(families[k], 6, 5);
    lcp_data p = {c.n, c.M, c.q};
    size_t before = memory_in_use();
    lcp_verdict v;
    for (long refused = 1;; ++refused) {
      memset(c.z, 0, (size_t)c.n * sizeof *c.z);
      memory_refuse(refused, 0);
      status st = lcp_solve(&p, &usual, c.z, c.w, &v);
      memory_refuse(0, 0);
      ck_assert_uint_eq(memory_in_use(), before);
      if (st == OK) {
        ck_assert_int_gt(refused, 20);
        break;
      }
      ck_assert_int_eq(st, ERR_MEMORY);
    }
    lcp_case_free(&c);
  }
}
END_TEST

UNIT_MAIN("lcp_solve", long_paths_are_left_early,
          all_bases_decide_from_both_sides, families_with_a_solution_are_solved,
          planted_solutions_of_small_problems_are_found,
          problems_without_solution_are_proved_to_have_none,
          proof_is_looked_for_after_short_tries,
          ray_of_an_indefinite_problem_is_no_verdict, limit_of_pivots_is_told,
          singular_bases_are_solved, transform_is_its_own_inverse,
          not_a_number_is_told, every_refused_request_is_reported)
