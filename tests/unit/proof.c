/*
 * src/solver/choice/proof.c: no equilibrium is said where an inequality proves
 * it and only there, by every method, on both sides of the limit.
 */
#include "base/sparse.h"
#include "solver/choice/choice.h"
#include "support/solver_rows.h"
#include "support/unit.h"

#include <cblas.h>

/* ---- bodies -------------------------------------------------------------- */

static void add_spring(contact_case *c, int i, int j, const double *x) {
  int dim = c->cp.dim, m = c->cp.m;
  double d[3], length = 0.0;
  for (int k = 0; k < dim; ++k) {
    d[k] = x[j * dim + k] - x[i * dim + k];
    length += d[k] * d[k];
  }
  for (int a = 0; a < 2 * dim; ++a)
    for (int b = 0; b < 2 * dim; ++b) {
      double sign = a / dim == b / dim ? 1.0 : -1.0;
      int row = (a < dim ? i : j) * dim + a % dim;
      int column = (b < dim ? i : j) * dim + b % dim;
      c->A[row + m * column] += sign * d[a % dim] * d[b % dim] / length;
    }
}

/* Row a of the stiffness in the frame of its node. */
static void turn(contact_case *c, const double *frame) {
  int dim = c->cp.dim, m = c->cp.m;
  FREED double *A = calloc((size_t)m * (size_t)m, sizeof *A);
  for (int a = 0; a < m; ++a)
    for (int b = 0; b < m; ++b)
      for (int k = 0; k < dim * dim; ++k)
        A[a + m * b] +=
            frame[a * dim + k / dim] * frame[b * dim + k % dim] *
            c->A[a / dim * dim + k / dim + m * (b / dim * dim + k % dim)];
  memcpy(c->A, A, sizeof *A * (size_t)m * (size_t)m);
}

/* n nodes at random places, all joined; normals off the first axis by up to
 * "tilt", rad. */
static contact_case body(int dim, int n, double mu, double tilt,
                         unsigned long long *seed) {
  double x[72], frame[216] = {0.0};
  contact_case c = case_new(dim, n, mu);
  for (int i = 0; i < n * dim; ++i) x[i] = case_random(seed);
  for (int i = 0; i < n; ++i) {
    double a = tilt * (2.0 * case_random(seed) - 1.0);
    double *f = frame + i * dim * dim;
    f[0] = f[dim + 1] = cos(a);
    f[1] = sin(a);
    f[dim] = -sin(a);
    f[dim * dim - 1] = dim == 3 ? 1.0 : cos(a);
    for (int j = i + 1; j < n; ++j) add_spring(&c, i, j, x);
  }
  turn(&c, frame);
  c.cp.floating = 1;
  return c;
}

static int is_proved(const contact_case *c) {
  anchor an = {0};
  int proved = 0;
  ck_assert_int_eq(proof_find(&c->cp, &an, &proved), OK);
  anchor_free(&an);
  return proved;
}

/* Forces of the nodes hold the body, though all be at their limit. */
TEST(balanced_load_has_no_proof) {
  unsigned long long seed = 77;
  for (int k = 0; k < 400; ++k) {
    int dim = 2 + k % 2, n = 3 + k % 20;
    CONTACT_CASE c = body(dim, n, 0.1 + 0.7 * case_random(&seed), 1.5, &seed);
    if (k % 4 > 1) case_average(&c, 2, 0.5);
    for (int i = 0; i < n; ++i) {
      c.g0[i] = 0.2 * case_random(&seed);
      c.r[i * dim] = -case_random(&seed);
      c.f[i * dim] = -c.r[i * dim];
    }
    for (int i = 0; i < n; ++i) {
      double a = 6.3 * case_random(&seed);
      double g = contact_node_limit(&c.cp, c.r, i);
      c.f[i * dim + 1] = g * (dim == 3 ? cos(a) : a > 3.0 ? 1.0 : -1.0);
      if (dim == 3) c.f[i * dim + 2] = g * sin(a);
    }
    ck_assert_msg(!is_proved(&c), "%d", k);
  }
}

/* A pull is one, unless it is below the rounding of the loads to come, or of
 * the motion so far. */
TEST(rounding_of_the_load_proves_nothing) {
  unsigned long long seed = 5;
  for (int k = 0; k < 64; ++k) {
    const int dim = 2 + k % 2, n = 3 + k % 9, tiny = k / 2 % 2,
              known = k / 4 % 2;
    CONTACT_CASE c = body(dim, n, 0.3, 0.0, &seed);
    for (int i = 0; i < n; ++i) c.f[i * dim] = tiny ? -1e-15 : -1e-13;
    if (k < 32)
      c.cp.load = known;
    else
      c.cp.moved = 2.0 * known / contact_diagonal(&c.cp, 0);
    ck_assert_int_eq(is_proved(&c), !(tiny && known));
  }
}

/* All nodes on one plane, the load at each outside its limit by a little, or
 * inside, in any direction of the plane. */
TEST(limit_of_friction_is_met_from_both_sides) {
  static const double off[] = {1e-1, 1e-3, 1e-6, 1e-8};
  unsigned long long seed = 4;
  for (int k = 0; k < 64; ++k) {
    double mu = 0.1 + case_random(&seed), a = 6.3 * case_random(&seed);
    int dim = 2 + k / 8 % 2, n = 12, outside = k / 4 % 2;
    CONTACT_CASE c = body(dim, n, mu, 0.0, &seed);
    for (int i = 0; i < n; ++i) {
      c.g0[i] = k < 32 ? 0.0 : 0.1 * i;
      c.f[i * dim] = 1.0;
      double g = (1.0 + (outside ? off[k % 4] : -off[k % 4])) * (c.g0[i] + mu);
      c.f[i * dim + 1] = g * (dim == 3 ? cos(a) : a > 3.0 ? 1.0 : -1.0);
      if (dim == 3) c.f[i * dim + 2] = g * sin(a);
    }
    ck_assert_msg(is_proved(&c) == outside, "%d", k);
  }
}

/* ---- compliances --------------------------------------------------------- */

/* A node that is open, sticks or slips, mu = 0.5. */
static void plant(double *u, double *r, unsigned long long *seed) {
  double a = 6.3 * case_random(seed), p = case_random(seed);
  int state = (int)(3.0 * case_random(seed));
  double s = state == 2 ? case_random(seed) : 0.0;
  double T = state == 2 ? 0.5 * p : 0.3 * p;
  u[0] = state == 0 ? -p : 0.0;
  u[1] = state == 0 ? p : s * cos(a);
  u[2] = state == 0 ? a : s * sin(a);
  r[0] = state == 0 ? 0.0 : -p;
  r[1] = state == 0 ? 0.0 : -T * cos(a);
  r[2] = state == 0 ? 0.0 : -T * sin(a);
}

/* A solution is planted into W of a rank below m, unsymmetric by "share". */
static contact_case planted(int n, double share, unsigned long long *seed) {
  contact_case c = case_new(3, n, 0.5);
  int m = c.cp.m, rank = 1 + m / 2;
  double *G = calloc((size_t)(m * rank), sizeof *G), *u = c.u, *r = c.r;
  for (int i = 0; i < m * rank; ++i) G[i] = case_random(seed) - 0.5;
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < m; ++j) {
      for (int k = 0; k < rank; ++k)
        c.A[i + m * j] += G[i * rank + k] * G[j * rank + k];
      c.A[i + m * j] *= 1.0 + share * (case_random(seed) - 0.5);
    }
  for (int i = 0; i < n; ++i) plant(u + 3 * i, r + 3 * i, seed);
  contact_product(m, c.A, r, c.f);
  for (int i = 0; i < m; ++i) c.f[i] = u[i] - c.f[i];
  c.cp.W = c.A;
  c.cp.A = NULL;
  free(G);
  return c;
}

/* Node 0 slides away under no pressure, but the limit of its friction grows
 * with the pressure at node 1, which moves away by 0.2 only: a force there
 * holds both from a share of 0.2 on. */
TEST(pressure_elsewhere_holds_a_slip) {
  const double v[] = {-1.0, 1.0, -0.2, 0.0};
  double workspace[3 * 4];
  CONTACT_CASE c = case_new(2, 2, 0.3);
  c.cp.floating = 1;
  c.f[1] = 1.0;
  c.B->col[0] = 1;
  c.B->col[1] = 0;
  for (int k = 0; k < 8; ++k) {
    c.B->val[0] = 0.05 * k;
    ck_assert_int_eq(proof_holds(&c.cp, v, workspace), k <= 4);
  }
}

TEST(solvable_problem_is_never_said_to_have_no_equilibrium) {
  const solver_ops *ops;
  unsigned long long seed = 11;
  for (int k = 0; k < 60; ++k) {
    CONTACT_CASE c = planted(2 + k % 12, k % 2 ? 2e-2 : 1e-3, &seed);
    ck_assert_double_lt(contact_residual(&c.cp, c.u, c.r), 1e-13);
    for (int i = 0; solver_row(i, &ops); ++i) {
      case_cold(&c);
      solver_report rep = solve_by(ops, &c, 1e-9, c.u, c.r);
      ck_assert_msg(rep.outcome != STOPPED_RAY && rep.outcome != STOPPED_NAN,
                    "%s: %d: %s", row_name(ops), k, outcome_text(rep.outcome));
    }
  }
}

/* A rigid body between two walls that are as far apart as it is thick, but for
 * "thick"; it slides along them. */
static contact_case between_walls(int dim, double thick) {
  contact_case c = case_new(dim, 2, 0.3);
  for (int i = 0; i < 2 * dim; ++i)
    for (int j = 0; j < 2 * dim; ++j)
      if (i % dim == j % dim)
        c.A[i + 2 * dim * j] = i % dim == 0 && i != j ? -2.0 : 2.0;
  c.f[0] = 1.0;
  c.f[dim] = -1.0 + thick;
  c.f[1] = c.f[dim + 1] = 0.1;
  c.cp.W = c.A;
  c.cp.A = NULL;
  return c;
}

TEST(body_too_thick_for_its_gap_has_no_equilibrium) {
  static const double off[] = {1.0, 1e-3, 1e-6, 0.0, -1e-6, -1e-3};
  const solver_ops *ops;
  for (int k = 0; k < 12; ++k) {
    double thick = off[k % 6];
    CONTACT_CASE c = between_walls(2 + k / 6, thick);
    for (int i = 0; solver_row(i, &ops); ++i) {
      case_cold(&c);
      solver_report rep = solve_by(ops, &c, 1e-9, c.u, c.r);
      ck_assert_msg((rep.outcome == STOPPED_RAY) == (thick > 0.0), "%s: %g: %s",
                    row_name(ops), thick, outcome_text(rep.outcome));
    }
  }
}

/* Nor does it matter how far it slides. */
TEST(slip_is_no_part_of_the_proof) {
  static const double off[] = {1.0, 1e-3, -1e-3};
  for (int k = 0; k < 12; ++k) {
    CONTACT_CASE c = between_walls(2 + k / 6, off[k % 3]);
    for (int i = 0; i < c.cp.m; ++i)
      if (i % c.cp.dim > 0) c.f[i] = k / 3 % 2 ? 5.0 : -5.0;
    ck_assert_msg(is_proved(&c) == (off[k % 3] > 0.0), "%d", k);
  }
}

/* Forces so large that they lose the penetration in r - c (u - gap). */
TEST(forces_without_bound_do_not_hide_a_body_too_thick) {
  for (double size = 0x1p10; size <= 0x1p80; size *= 2.0) {
    CONTACT_CASE c = between_walls(2, 0x1p-10);
    c.r[0] = c.r[2] = -size;
    memcpy(c.u, c.f, 4 * sizeof *c.u);
    c.cp.g0 = NULL;
    ck_assert_msg(contact_residual(&c.cp, c.u, c.r) > 1e-9, "%g", size);
  }
}

/* Forces that move their nodes as they push are none, in any unit. */
TEST(forces_that_move_nodes_prove_nothing) {
  const double force[] = {1, 0, 1, 0};
  for (double unit = 0x1p-200; unit <= 0x1p200; unit *= 0x1p100)
    for (int walls = 0; walls < 2; ++walls) {
      double workspace[12];
      CONTACT_CASE c = between_walls(2, 0.5);
      if (!walls)
        for (int i = 0; i < 16; ++i) c.A[i] = fmax(c.A[i], 0.0);
      cblas_dscal(16, unit, c.A, 1);
      cblas_dscal(4, unit, c.f, 1);
      ck_assert_int_eq(proof_holds(&c.cp, force, workspace), walls);
    }
}

/* A node that only its friction moves off the wall, u_n = 2 r_t: a limit of 0.5
 * moves it by up to 1. */
TEST(friction_below_its_limit_may_give_way) {
  static const double into[] = {0.9, 1.1}, force[] = {1, 0};
  for (int k = 0; k < 2; ++k) {
    double workspace[6];
    CONTACT_CASE c = case_new(2, 1, 0.3);
    c.cp.W = c.A;
    c.cp.A = NULL;
    c.A[2] = 2.0;
    c.A[3] = 1.0;
    c.f[0] = into[k];
    c.g0[0] = 0.5;
    c.cp.B = NULL;
    ck_assert_int_eq(proof_holds(&c.cp, force, workspace), k);
  }
}

/* Nodes that no force moves, all open: no forces. */
TEST(compliance_of_zero_is_solved_without_forces) {
  const solver_ops *ops;
  for (int dim = 2; dim <= 3; ++dim) {
    CONTACT_CASE c = case_new(dim, 3, 0.3);
    for (int i = 0; i < 3; ++i) c.f[i * dim] = -1.0 - i;
    c.cp.W = c.A;
    c.cp.A = NULL;
    ck_assert_double_eq(contact_residual(&c.cp, c.f, c.r), 0.0);
    for (int i = 0; solver_row(i, &ops); ++i) {
      case_cold(&c);
      solver_report rep = solve_by(ops, &c, 1e-9, c.u, c.r);
      ck_assert_msg(rep.outcome != STOPPED_RAY && rep.outcome != STOPPED_NAN,
                    "%s: %s", row_name(ops), outcome_text(rep.outcome));
      if (ops == NULL) ck_assert_int_eq(rep.outcome, CONVERGED);
      for (int k = 0; k < 3 * dim && rep.outcome > 0; ++k)
        ck_assert_double_eq(c.r[k], 0.0);
    }
  }
}

/* A row of equal bodies pressed together, 2 and -1: a search would make a
 * matrix of all normal unknowns. */
TEST(large_sparse_compliance_is_not_searched) {
  enum { N = 3000, M = 2 * N };
  FREED int *row = calloc(3 * M, sizeof *row),
            *column = calloc(3 * M, sizeof *row);
  FREED double *value = calloc(3 * M, sizeof *value),
               *gap = calloc(N, sizeof *gap);
  double *f = calloc(M, sizeof *f), *u = calloc(M, sizeof *u),
         *r = calloc(M, sizeof *r), param[64] = {0.0};
  const solver_ops *sor = solver_find("sor");
  OWNED sparse_blocks *W = NULL;
  ENDS_BY(contact_solver_free) contact_solver *s = NULL;
  solver_report rep;
  int n = 0;
  for (int i = 0; i < M; ++i)
    for (int j = i - 2; j <= i + 2; j += 2) {
      if (j < 0 || j >= M) continue;
      row[n] = i;
      column[n] = j;
      value[n++] = i == j ? 2.0 : -1.0;
    }
  for (int i = 0; i < M; i += 2) f[i] = i % 3 ? 1.0 : -0.5;
  ck_assert_int_eq(sparse_blocks_new(2, N, n, row, column, value, &W), OK);
  const contact_problem cp = {
      .dim = 2, .n = N, .m = M, .blocks = W, .f = f, .gap = gap};
  option_defaults(sor->options, param);
  memory_limit(memory_in_use() + (size_t)N * N, "the test");
  const solver_choice choice = {
      .ops = sor, .param = param, .tol = 1e-8, .max_iter = 3};
  ck_assert_int_eq(contact_solver_new(&choice, &s), OK);
  const status st = contact_solve(s, &cp, NULL, u, r, &rep);
  memory_limit(SIZE_MAX, "");
  ck_assert_msg(st == OK, "%s", status_message());
  ck_assert_int_eq(rep.outcome, STOPPED_ITERATIONS);
  free(f);
  free(u);
  free(r);
}

UNIT_MAIN("proof")
