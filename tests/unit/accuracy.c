/*
 * src/accuracy: bounds of the error of the solver against solutions that
 * another method has brought to rounding, at every level of error.
 */
#include "accuracy/accuracy.h"
#include "solver/solver.h"
#include "support/operated_case.h"
#include "support/unit.h"

enum { PARAM_SIZE = 512 };

static solver_report solve(contact_case *c, const char *name, double tol) {
  double param[PARAM_SIZE / sizeof(double)] = {0.0};
  const solver_ops *ops = solver_find(name);
  ENDS_BY(contact_solver_free) contact_solver *s = NULL;
  solver_report rep;
  option_defaults(ops->options, param);
  solver_choice choice = {.ops = ops, .param = param, .tol = tol};
  ck_assert_int_eq(contact_solver_new(&choice, &s), OK);
  ck_assert_int_eq(contact_solve(s, &c->cp, NULL, c->u, c->r, &rep), OK);
  return rep;
}

static double energy_norm(int m, const double *M, const double *a,
                          const double *b) {
  double sum = 0.0;
  for (int j = 0; j < m; ++j)
    for (int i = 0; i < m; ++i)
      sum += (a[i] - b[i]) * M[i + m * j] * (a[j] - b[j]);
  return sqrt(fmax(sum, 0.0));
}

static solver_error bound_of(const contact_problem *cp, const double *u,
                             const double *r) {
  OWNED dense_inverse *inverse = NULL;
  contact_problem stiff = *cp;
  FREED double *A = calloc((size_t)cp->m * (size_t)cp->m, sizeof *A);
  solver_error e;
  int made = 0;
  ck_assert_int_eq(
      dense_inverse_new(cp->m, cp->A != NULL ? cp->A : cp->W, &inverse), OK);
  ck_assert_ptr_nonnull(inverse);
  inverse_energy energy = dense_inverse_energy(inverse);
  if (cp->A == NULL) dense_inverse_fill(inverse, A, &made);
  stiff.A = A;
  if (made) energy.stiffness = &stiff;
  ck_assert_int_eq(solver_error_bound(cp, &energy, u, r, NULL, &e), OK);
  return e;
}

static void make_tresca(contact_case *c) {
  for (int i = 0; i < c->cp.n; ++i) c->g0[i] = 0.15 * (i % 4);
  c->cp.B = NULL;
}

/* How good the bounds were. */
typedef struct quality {
  int n, loose;
} quality;

/* Errors of all sizes: solved to 10^-level, or disturbed at random. */
static void try_levels(contact_case *c, double *exact, quality *q, int k) {
  int m = c->cp.m;
  size_t bytes = (size_t)m * sizeof *exact;
  FREED double *zero = calloc((size_t)m, sizeof *zero);
  unsigned long long seed = 77 + (unsigned long long)k;
  double size = energy_norm(m, c->A, exact, zero);
  for (int level = 1; level <= 11; ++level) {
    double tol = pow(10, -level);
    if (k % 3 < 2) {
      memset(c->u, 0, bytes);
      memset(c->r, 0, bytes);
      solve(c, k % 3 == 0 ? "sor" : "pcg", tol);
    } else {
      for (int i = 0; i < m; ++i)
        c->u[i] = exact[i] + tol * (case_random(&seed) - 0.5);
      contact_reaction(&c->cp, c->u, c->r);
    }
    double error = energy_norm(m, c->A, c->u, exact);
    solver_error e = bound_of(&c->cp, c->u, c->r);
    if (e.why != NULL) continue;
    ck_assert_msg(e.norm >= error * (1 - 1e-6) - 1e-14 * size,
                  "problem %d, level %d: bound %g of the error %g", k, level,
                  e.norm, error);
    ++q->n;
    q->loose += e.norm > 10 * error && e.norm > 1e-11 * size;
  }
}

static quality try_problems(int count, double mu, int tresca) {
  quality q = {0, 0};
  for (int k = 0; k < count; ++k) {
    CONTACT_CASE c = case_any(2 + k % 2, 1 + k % 13, mu, k / 2 % 2,
                              (unsigned long long)(4000 + k));
    if (tresca) make_tresca(&c);
    ck_assert_int_eq(solve(&c, "newton", 1e-14).outcome > 0 ||
                         contact_residual(&c.cp, c.u, c.r) < 1e-12,
                     1);
    FREED double *exact = malloc((size_t)c.cp.m * sizeof *exact);
    memcpy(exact, c.u, (size_t)c.cp.m * sizeof *exact);
    try_levels(&c, exact, &q, k);
  }
  return q;
}

TEST(bound_holds_for_a_given_limit_and_is_not_absurd) {
  quality q = try_problems(200, 0.5, 1);
  ck_assert_int_eq(q.n, 200 * 11);
  ck_assert_msg(q.loose * 20 < q.n, "%d of %d beyond ten times the error",
                q.loose, q.n);
}

TEST(bound_holds_without_friction) {
  quality q = try_problems(60, 0.0, 0);
  ck_assert_int_eq(q.n, 60 * 11);
  ck_assert_int_lt(q.loose * 20, q.n);
}

/* Small friction: the fixed point contracts, the solution is unique. */
TEST(bound_holds_with_coulomb_friction) {
  quality q = try_problems(120, 0.15, 0);
  ck_assert_int_gt(q.n, 1000);
  ck_assert_int_lt(q.loose * 20, q.n);
}

/* One triangle that slides: the contraction is mu/mu_crit, mu_crit = 1.8 for
 * nu = 0.3. The force of an error grows with the slip, so an error of the
 * limit is made larger by the whole 1/(1 - mu/mu_crit). */
TEST(rate_of_the_triangle_is_known) {
  static const double mu[] = {0.3, 0.9, 1.7, 1.75};
  for (int k = 0; k < 4; ++k) {
    CONTACT_CASE c = case_triangle(0.3, mu[k], mu[k] + 0.02, -1.0);
    ck_assert_int_eq(solve(&c, "lemke", 1e-12).outcome, CONVERGED);
    double rate, exact[2] = {c.u[0], c.u[1]};
    ck_assert_double_gt(exact[1], 0.01);
    ck_assert_int_eq(contraction_rate(&c.cp, c.u, c.r, NULL, &rate), OK);
    ck_assert_double_eq_tol(rate, mu[k] / 1.8, 1e-12);
    for (int level = 3; level < 9; ++level) {
      c.u[1] = exact[1] * (1.0 + pow(10, -level));
      c.r[0] = c.A[2] * c.u[1] - c.f[0];
      c.r[1] = mu[k] * c.r[0];
      solver_error e = bound_of(&c.cp, c.u, c.r);
      double error = energy_norm(2, c.A, c.u, exact);
      ck_assert_double_ge(e.norm, error * (1.0 - 1e-6));
      ck_assert_double_le(e.norm, 3.0 * error);
    }
  }
}

/* The triangle that slides, and above it a body that has left it: two nodes,
 * joined by springs of which one is stretched by the slip, with two motions.
 * Nothing of it is in the rate, unless a motion slides. */
TEST(body_that_has_left_is_not_in_the_rate) {
  const double mu = 0.9, cosine = 0.8, sine = 0.6;
  for (int slides = 0; slides < 2; ++slides) {
    CONTACT_CASE one = case_triangle(0.3, mu, mu + 0.02, -1.0);
    CONTACT_CASE c = case_new(2, 3, mu);
    double R[12] = {0.0}, rate;
    ck_assert_int_eq(solve(&one, "lemke", 1e-12).outcome, CONVERGED);
    for (int i = 0; i < 2; ++i) {
      const double spring[] = {0.0, i, i == 0, i == 1, -(i == 0), -(i == 1)};
      for (int a = 0; a < 36; ++a) c.A[a] += spring[a % 6] * spring[a / 6];
      for (int a = 0; a < 2; ++a) c.A[a + 6 * i] += one.A[a + 2 * i];
      c.u[i] = one.u[i];
      c.r[i] = one.r[i];
      c.gap[1 + i] = 1.0;
      R[2 + i] = R[4 + i] = sqrt(0.5) * (i == 0 ? cosine : -sine);
      R[8 + i] = R[10 + i] = sqrt(0.5) * (i == 0 ? sine : cosine);
    }
    if (slides) R[1] = 0.1;
    c.cp.n_motion = 2;
    c.cp.motion = R;
    ck_assert_int_eq(contraction_rate(&c.cp, c.u, c.r, NULL, &rate), OK);
    if (slides)
      ck_assert(rate == HUGE_VAL);
    else
      ck_assert_double_eq_tol(rate, mu / 1.8, 1e-12);
  }
}

/* Two states in turn, as at the end of an increment and through it: a factor
 * each, and none while they stay. */
TEST(two_rates_are_remembered) {
  CONTACT_CASE c = case_any(3, 12, 0.25, 0, 901);
  known_rate known = {0};
  double fresh[2], again;
  size_t bytes[2][3];
  ck_assert_int_eq(solve(&c, "newton", 1e-13).outcome, CONVERGED);
  FREED double *other = malloc((size_t)c.cp.m * sizeof *other);
  for (int dof = 0; dof < c.cp.m; ++dof)
    other[dof] = dof % 3 == 0 ? c.u[dof] : -c.u[dof];
  for (int i = 0; i < 6; ++i) {
    const double *u = i % 2 == 0 ? c.u : other;
    size_t before = memory_allocated();
    ck_assert_int_eq(contraction_rate(&c.cp, u, c.r, &known, &again), OK);
    bytes[i % 2][i / 2] = memory_allocated() - before;
    ck_assert_int_eq(contraction_rate(&c.cp, u, c.r, NULL, &fresh[i % 2]), OK);
    ck_assert(again == fresh[i % 2]);
  }
  ck_assert(fresh[0] > 0.0 && fresh[1] > 0.0 && fresh[0] != fresh[1]);
  for (int k = 0; k < 2; ++k) {
    ck_assert_uint_lt(2 * bytes[k][1], bytes[k][0]);
    ck_assert_uint_eq(bytes[k][1], bytes[k][2]);
  }
  known_rate_forget(&known);
}

/* The first passes of the map may contract less than those it tends to. */
TEST(rate_is_that_of_the_worst_pass) {
  int above = 0;
  for (int k = 0; k < 40; ++k) {
    CONTACT_CASE c =
        case_any(2 + k % 2, 8, 0.25, k / 2 % 2, (unsigned long long)(900 + k));
    double rate, limit;
    ck_assert_int_eq(solve(&c, "newton", 1e-13).outcome, CONVERGED);
    ck_assert_int_eq(contraction_rate(&c.cp, c.u, c.r, NULL, &rate), OK);
    ck_assert_int_eq(contraction_limit(&c.cp, c.u, c.r, &limit), OK);
    above += rate > 1.05 * limit;
  }
  ck_assert_int_ge(above, 5);
}

/* Two nodes that slip towards each other: the rate is that of the largest
 * eigenvalue of -mu A_nt inv(A_tt) e, times the size of A_nt; by the entries
 * and by products and solves. */
static void check_two_nodes(double size, double expected) {
  static const double nt[2][2] = {{-0.8, 0.3}, {0.2, 0.5}};
  static const double tt[2][2] = {{2.0, -0.6}, {-0.6, 3.0}};
  static const double e[] = {1.0, -1.0}, mu = 0.5;
  CONTACT_CASE c = case_new(2, 2, mu);
  double T[2][2], limit;
  for (int i = 0; i < 2; ++i) {
    c.A[10 * i] = 9.0;
    c.r[2 * i] = -2.0;
    c.r[2 * i + 1] = e[i] * mu * 2.0;
    c.u[2 * i + 1] = -0.1 * e[i];
    for (int k = 0; k < 2; ++k) {
      c.A[2 * i + 1 + 4 * (2 * k + 1)] = tt[i][k];
      c.A[2 * i + 4 * (2 * k + 1)] = c.A[2 * k + 1 + 4 * 2 * i] =
          size * nt[i][k];
    }
  }
  const double det = tt[0][0] * tt[1][1] - tt[0][1] * tt[0][1];
  for (int i = 0; i < 2; ++i) {
    const double *a = nt[i];
    T[i][0] = -mu * (a[0] * tt[1][1] - a[1] * tt[0][1]) / det * e[0];
    T[i][1] = -mu * (a[1] * tt[0][0] - a[0] * tt[0][1]) / det * e[1];
  }
  const double half = 0.5 * (T[0][0] + T[1][1]);
  const double root = sqrt(half * half - T[0][0] * T[1][1] + T[0][1] * T[1][0]);
  for (int k = 0; k < 2; ++k) {
    operated_case *o = k == 0 ? NULL : operated_new(&c);
    ck_assert_int_eq(contraction_limit(&c.cp, c.u, c.r, &limit), OK);
    ck_assert_double_eq_tol(limit, expected * (fabs(half) + root),
                            1e-9 * expected + DBL_MIN);
    if (o != NULL) operated_free(o, &c);
  }
}

/* A product of the size of its rounding contracts to nothing. */
TEST(rate_of_two_nodes_is_an_eigenvalue) {
  check_two_nodes(1.0, 1.0);
  check_two_nodes(0x1p-40, 0x1p-40);
  check_two_nodes(0x1p-56, 0.0);
}

/* Slip to the right by 1.04 at mu = 2 is beyond the critical friction. */
TEST(no_bound_beyond_the_critical_friction) {
  CONTACT_CASE c = case_triangle(0.3, 2.0, 1.9, -1.0);
  c.u[1] = 1.04;
  contact_reaction(&c.cp, c.u, c.r);
  ck_assert_double_lt(contact_residual(&c.cp, c.u, c.r), 1e-12);
  solver_error e = bound_of(&c.cp, c.u, c.r);
  ck_assert_double_eq_tol(e.rate, 2.0 / 1.8, 1e-12);
  ck_assert(isnan(e.norm));
  ck_assert_ptr_nonnull(e.why);
}

/* One tangent prescribed, one node between two obstacles. */
TEST(bound_holds_at_held_and_cornered_nodes) {
  for (int k = 0; k < 30; ++k) {
    int dim = 2 + k % 2, n = 4 + k % 5, m = dim * n, dof = dim + 1;
    CONTACT_CASE c = case_any(dim, n, 0.4, 0, (unsigned long long)(1500 + k));
    unsigned char held[64] = {0};
    double side[64], exact[64];
    unsigned long long seed = 5 + (unsigned long long)k;
    held[dof] = 1;
    for (int j = 0; j < m; ++j)
      if (j != dof) c.A[dof + m * j] = c.A[j + m * dof] = 0.0;
    for (int j = 0; j < n * (dim - 1); ++j) side[j] = HUGE_VAL;
    side[2 * (dim - 1)] = 0.02;
    c.f[2 * dim + 1] = k % 4 < 2 ? 3.0 : -3.0;
    make_tresca(&c);
    c.g0[2] = 0.0;
    c.cp.held = held;
    c.cp.side_gap = side;
    ck_assert_int_eq(solve(&c, "newton", 1e-13).outcome, CONVERGED);
    memcpy(exact, c.u, (size_t)m * sizeof *exact);
    for (int level = 0; level < 10; ++level) {
      for (int i = 0; i < m; ++i)
        c.u[i] = exact[i] + pow(10, -level) * (case_random(&seed) - 0.5);
      contact_reaction(&c.cp, c.u, c.r);
      solver_error e = bound_of(&c.cp, c.u, c.r);
      double error = energy_norm(m, c.A, c.u, exact);
      ck_assert_double_ge(e.norm, error);
      ck_assert_double_le(e.norm, 100.0 * error);
    }
  }
}

/* Only the compliance is known: the forces in the norm of W; a given limit,
 * then Coulomb friction whose limit contracts. */
TEST(bound_holds_in_the_compliance_form) {
  for (int k = 0; k < 60; ++k) {
    int coulomb = k >= 30, bounded = 0;
    CONTACT_CASE c = case_any(2 + k % 2, 6, coulomb ? 0.15 : 0.4, k / 2 % 2,
                              (unsigned long long)(1700 + k));
    int m = c.cp.m;
    double W[18 * 18], q[18], exact[18];
    unsigned long long seed = 9 + (unsigned long long)k;
    if (!coulomb) make_tresca(&c);
    ck_assert_int_eq(solve(&c, "newton", 1e-13).outcome, CONVERGED);
    memcpy(exact, c.r, (size_t)m * sizeof *exact);
    ck_assert(case_inverse(m, c.A, W));
    contact_product(m, W, c.f, q);
    c.cp.W = W;
    c.cp.A = NULL;
    c.cp.f = q;
    for (int level = 0; level < 10; ++level) {
      for (int i = 0; i < m; ++i)
        c.r[i] = exact[i] + pow(10, -level) * (case_random(&seed) - 0.5);
      contact_product(m, W, c.r, c.u);
      for (int i = 0; i < m; ++i) c.u[i] += q[i];
      solver_error e = bound_of(&c.cp, c.u, c.r);
      double error = energy_norm(m, W, c.r, exact);
      if (coulomb && e.why != NULL) continue;
      ck_assert_double_ge(e.norm, error);
      ck_assert_double_le(e.norm, 100.0 * error);
      ++bounded;
    }
    ck_assert_int_ge(bounded, coulomb ? 5 : 10);
  }
}

/* Other units by powers of two: sqrt(N m) and nothing else changes. */
TEST(bound_changes_with_the_units_only) {
  for (int k = 0; k < 20; ++k) {
    contact_case c[2];
    double norm[2];
    for (int b = 0; b < 2; ++b) {
      int force = b ? 18 : 0, length = b ? -8 : 0;
      c[b] = case_any(2 + k % 2, 7, 0.2, k / 2 % 2, 2100ull + (unsigned)k);
      case_units(&c[b], length, force);
      solve(&c[b], "sor", 1e-5);
      norm[b] = bound_of(&c[b].cp, c[b].u, c[b].r).norm;
      case_free(&c[b]);
    }
    ck_assert_double_eq_tol(norm[1], ldexp(norm[0], 5), 1e-13 * norm[1]);
  }
}

/* Nothing is missing in the equation, but its sums are rounded. */
TEST(rounding_is_part_of_the_bound) {
  CONTACT_CASE c = case_new(2, 1, 0.0);
  c.A[0] = c.A[3] = 2.0;
  c.f[0] = c.f[1] = 1.0;
  c.u[0] = c.u[1] = 0.5;
  c.gap[0] = 1.0;
  solver_error e = bound_of(&c.cp, c.u, c.r);
  ck_assert_double_gt(e.norm, 0.5e-16);
  ck_assert_double_lt(e.norm, 1e-14);
}

UNIT_MAIN("accuracy")
