/* src/solver/newton: the steps of Newton's method on the states. */
#include "solver/newton/system.h"
#include "solver/solver.h"
#include "support/contact_case.h"
#include "support/unit.h"

enum { NODES = 100, SLIPPING = 60 };

/* A row of pressed nodes joined by springs of stiffness 1 along t1, the last
 * one tied to a wall; the first is pulled by F and each can hold g. */
static contact_case pulled_row(int dim, double F, double g) {
  double mu = 0.25;
  contact_case c = case_new(dim, NODES, mu);
  int m = c.cp.m;
  for (int i = 0; i < NODES; ++i) {
    for (int k = 0; k < dim; ++k) {
      int dof = i * dim + k;
      c.A[dof + m * dof] = k == 1 ? (i == 0 ? 1.0 : 2.0) : 3.0;
      if (k == 1 && i > 0)
        c.A[dof + m * (dof - dim)] = c.A[dof - dim + m * dof] = -1.0;
    }
    c.f[i * dim] = g / mu;
  }
  c.f[1] = F;
  return c;
}

static solver_report solve_to(double tol, contact_case *c) {
  double param[8] = {0.0};
  solver_control control = {.tol = tol};
  solver_report rep;
  OWNED void *work = NULL;
  ck_assert(newton_solver.param_size <= sizeof param);
  option_defaults(newton_solver.options, param);
  ck_assert_int_eq(solver_set_up(&newton_solver, &c->cp, param, &work), OK);
  ck_assert_int_eq(
      newton_solver.solve(&c->cp, param, work, &control, c->u, c->r, &rep), OK);
  return rep;
}

static solver_report solve(contact_case *c) { return solve_to(1e-12, c); }

/* The force that passes node i is F - (i + 1) g: a node more slips at each
 * step, SLIPPING of them, more than an attempt has steps at first. */
TEST(front_of_slip_is_followed_to_its_end) {
  for (int dim = 2; dim <= 3; ++dim) {
    double g = 0.5, F = (SLIPPING + 0.5) * g, u = 0.0;
    CONTACT_CASE c = pulled_row(dim, F, g);
    solver_report rep = solve(&c);
    ck_assert_int_eq(rep.outcome, CONVERGED);
    ck_assert_int_gt(rep.iterations, 40);
    ck_assert_int_le(rep.iterations, SLIPPING + 2);
    for (int i = NODES - 1; i >= 0; --i) {
      if (i < SLIPPING) u += F - (i + 1) * g;
      double T = i < SLIPPING ? g : i == SLIPPING ? 0.5 * g : 0.0;
      ck_assert_double_eq_tol(c.u[i * dim + 1], u, 1e-9 * F);
      ck_assert_double_eq_tol(c.r[i * dim + 1], -T, 1e-10 * F);
    }
  }
}

/* The same state again: nothing to do; a larger pull: the front goes on. */
TEST(front_goes_on_from_where_it_was) {
  double g = 0.5;
  CONTACT_CASE c = pulled_row(2, 20.5 * g, g);
  ck_assert_int_eq(solve(&c).outcome, CONVERGED);
  c.f[1] = 23.5 * g;
  solver_report rep = solve(&c);
  ck_assert_int_eq(rep.outcome, CONVERGED);
  ck_assert_int_le(rep.iterations, 5);
  ck_assert_double_eq_tol(c.r[2 * 22 + 1], -g, 1e-12);
  ck_assert_double_eq_tol(c.r[2 * 23 + 1], -0.5 * g, 1e-12);
}

/* The same row by its compliance: node j moves node i through the springs
 * between the farther one and the wall. */
static void turn_to_compliance(contact_case *c, double *W, double *q) {
  int m = c->cp.m, dim = c->cp.dim;
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < m; ++j) {
      int a = i / dim, b = j / dim, along = i % dim == 1 && j % dim == 1;
      W[i + m * j] = along ? NODES - (a > b ? a : b) : i == j ? 1.0 / 3.0 : 0.0;
    }
  contact_product(m, W, c->f, q);
  c->cp.A = NULL;
  c->cp.W = W;
  c->cp.f = q;
}

TEST(front_of_slip_is_found_from_the_compliance) {
  for (int dim = 2; dim <= 3; ++dim) {
    double g = 0.5, F = (SLIPPING + 0.5) * g;
    CONTACT_CASE c = pulled_row(dim, F, g);
    FREED double *W = calloc((size_t)(c.cp.m * c.cp.m), sizeof *W),
                 *q = calloc((size_t)c.cp.m, sizeof *q);
    turn_to_compliance(&c, W, q);
    solver_report rep = solve(&c);
    ck_assert_int_eq(rep.outcome, CONVERGED);
    ck_assert_int_le(rep.iterations, NODES);
    for (int i = 0; i < NODES; ++i) {
      double T = i < SLIPPING ? g : i == SLIPPING ? 0.5 * g : 0.0;
      ck_assert_double_eq_tol(c.r[i * dim + 1], -T, 1e-10 * F);
    }
  }
}

/* Few nodes in space that yield fifty times more in one tangent than in the
 * other; a solution is planted. What meets a loose tolerance moves as its
 * forces say. */
TEST(nodes_of_uneven_tangents_do_not_cycle) {
  static const double size[] = {0.114, 0.327, 0.047};
  unsigned long long seed = 21;
  for (int k = 0; k < 400; ++k) {
    int n = 1 + k % 4, m = 3 * n;
    CONTACT_CASE c = case_new(3, n, 0.7);
    double G[144], *r = c.r;
    for (int i = 0; i < m * m; ++i)
      G[i] = size[i / m % 3] * ((i % (m + 1) == 0) + case_random(&seed) - 0.5);
    for (int i = 0; i < m * m; ++i)
      for (int j = 0; j < m; ++j) c.A[i] += G[i / m * m + j] * G[i % m * m + j];
    for (int i = 0; i < n; ++i) {
      double a = 6.3 * case_random(&seed), p = 0.1 + case_random(&seed);
      r[3 * i] = -p;
      r[3 * i + 1] = -0.7 * p * cos(a);
      r[3 * i + 2] = -0.7 * p * sin(a);
    }
    contact_product(m, c.A, r, c.u);
    for (int i = 0; i < m; ++i)
      c.f[i] = (i % 3 == 0 ? 0.0 : -0.01 * r[i]) - c.u[i];
    c.cp.W = c.A;
    c.cp.A = NULL;
    memset(c.u, 0, sizeof *c.u * (size_t)m);
    memset(r, 0, sizeof *r * (size_t)m);
    solver_report rep = solve(&c);
    ck_assert_msg(rep.outcome == CONVERGED, "%d: %s, %g", k,
                  outcome_text(rep.outcome), rep.residual);
    memset(c.u, 0, sizeof *c.u * (size_t)m);
    memset(r, 0, sizeof *r * (size_t)m);
    ck_assert_int_eq(solve_to(1e-2, &c).outcome, CONVERGED);
    contact_product(m, c.A, r, G);
    for (int i = 0; i < m; ++i)
      if (c.u[i] != 0) ck_assert_double_eq_tol(c.u[i], G[i] + c.f[i], 1e-14);
  }
}

/* A cycle is one only if a guess comes back: all of two nodes in the plane. */
TEST(every_guess_has_a_hash_of_its_own) {
  enum { EACH = 8, ALL = EACH * EACH }; /* open or closed; free, stuck, slips */
  CONTACT_CASE c = case_new(2, 2, 0.5);
  uint64_t hash[ALL];
  OWNED char *owner = memory_new(1, 1);
  OWNS(owner);
  states s = {.cp = &c.cp};
  ck_assert_int_eq(states_new(&c.cp, &s), OK);
  for (int k = 0; k < ALL; ++k) {
    for (int i = 0, of = k; i < 2; ++i, of /= EACH) {
      s.guess.closed[2 * i] = (unsigned char)(of % 2);
      s.guess.mode[i] = (unsigned char)(of / 2 == 3 ? SLIP : of / 2);
      s.guess.e[i] = of / 2 == 3 ? -1.0 : of / 2 == 2 ? 1.0 : 0.0;
    }
    hash[k] = states_hash(&s);
    for (int l = 0; l < k; ++l) ck_assert(hash[k] != hash[l]);
  }
}

UNIT_MAIN("newton")
