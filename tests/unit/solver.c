/* src/solver: every row of the table on the same problems. */
#include "base/archive/archive.h"
#include "manual/manual.h"
#include "support/folder.h"
#include "support/solver_rows.h"
#include "support/unit.h"

TEST(table_is_complete) {
  FREED char *text = NULL;
  size_t size;
  FILE *f = open_memstream(&text, &size);
  int i = 0;
  for (; solver_list[i] != NULL; ++i) {
    const solver_ops *s = solver_list[i];
    ck_assert_ptr_eq(solver_find(s->name), s);
    ck_assert_str_eq(solver_family(s->name), s->family);
    ck_assert(s->setup != NULL && s->solve != NULL);
    ck_assert(s->handles & SOLVES_TRESCA);
  }
  ck_assert_ptr_null(solver_find("nosuch"));
  ck_assert_str_eq(solver_family(NULL), "direct");
  /* Each with its text, which list_print looks for. */
  ck_assert(list_print("solvers", f));
  fclose(f);
  ck_assert_uint_gt(size, 400 * (size_t)(i + 1));
}

/* ---- one triangle: clamped at two corners, the third on the floor -------- */

/* u_t, N and T of the answer of a row; 0: it said it has none, as a fixed point
 * on the limit may for large friction. */
static int triangle_answer(const solver_ops *ops, contact_case *c, double *ut,
                           double *N, double *T) {
  solver_report rep = solve_by(ops, c, 1e-12, c->u, c->r);
  if (ops == NULL || (ops->handles & SOLVES_COULOMB))
    ck_assert_msg(rep.outcome == CONVERGED, "%s", row_name(ops));
  *ut = c->u[1];
  *N = -c->r[0];
  *T = c->r[1];
  return rep.outcome == CONVERGED;
}

TEST(one_triangle_slips_sticks_and_opens) {
  static const struct {
    double fx, fy, ut, N, T;
  } expected[] = {
      {0, -1, 0, 1, 0},
      {-1, .3, -.9657142857142857, .1642857142857143, .1642857142857143},
      {1.9, -1, 2.2471428571428571, 0, 0},
      {1, .01, NAN, 0, 0}};
  EACH_SOLVER(i, ops)
  for (int k = 0; k < 4; ++k) {
    CONTACT_CASE c = case_triangle(.3, 1.0, expected[k].fx, expected[k].fy);
    double ut, N, T;
    ck_assert(triangle_answer(ops, &c, &ut, &N, &T));
    if (!isnan(expected[k].ut))
      ck_assert_double_eq_tol(ut, expected[k].ut, 1e-10);
    ck_assert_double_eq_tol(N, expected[k].N, 1e-10);
    ck_assert_double_eq_tol(T, expected[k].T, 1e-10);
  }
}

/* mu = 2 > mu_crit = 1.8: free, stick and slip are all solutions of
 * F = (1.9, -1). From the neighbourhood of each a solver may find any. */
TEST(one_triangle_has_three_solutions_for_large_friction) {
  static const double ut[] = {2.2471428571428571, 0, 1.04};
  static const double rt[] = {0, -1.9, -1.0}, rn[] = {0, -1, -.5};
  int found[3] = {0};
  EACH_SOLVER(i, ops)
  for (int start = 0; start < 3; ++start) {
    CONTACT_CASE c = case_triangle(.3, 2.0, 1.9, -1);
    c.u[1] = ut[start] * 1.01;
    c.u[0] = start == 0 ? -.09 : 0.0;
    c.r[0] = rn[start] * 0.99;
    c.r[1] = rt[start];
    double u, N, T;
    int answered = triangle_answer(ops, &c, &u, &N, &T);
    int which = -1;
    for (int k = 0; k < 3; ++k)
      if (fabs(u - ut[k]) < 1e-9 && fabs(T - rt[k]) < 1e-9 &&
          fabs(N + rn[k]) < 1e-9)
        which = k;
    ck_assert_msg(!answered || which >= 0, "%s: u_t = %g is none of three",
                  row_name(ops), u);
    if (answered) ++found[which];
  }
  for (int k = 0; k < 3; ++k) ck_assert_int_gt(found[k], 0);
}

/* Penetration d taken back by a force with u_t = 0: locked for mu >= .5556. */
TEST(wedged_triangle_is_locked_by_friction) {
  EACH_SOLVER(i, ops)
  for (int locked = 0; locked < 2; ++locked) {
    CONTACT_CASE c = case_triangle(.3, locked ? .56 : .55, 0, 0);
    c.gap[0] = -0.1;
    double ut, N, T;
    ck_assert(triangle_answer(ops, &c, &ut, &N, &T));
    if (locked)
      ck_assert_double_eq_tol(N, .1 * c.A[0], 1e-12);
    else
      ck_assert_double_eq_tol(fabs(T), .55 * N, 1e-12);
    ck_assert_int_eq(fabs(ut) < 1e-11, locked);
  }
}

/* Its load is taken away: the wedge stays, though no force solves it too. */
TEST(wedge_stays_without_a_load) {
  static const double A[] = {1, -0.8, -0.8, 1};
  EACH_SOLVER(i, ops) {
    CONTACT_CASE c = case_new(2, 1, 2.0);
    memcpy(c.A, A, sizeof A);
    c.ut0[0] = c.u[1] = c.r[1] = 1;
    c.r[0] = -0.9;
    solver_report rep = solve_by(ops, &c, 1e-12, c.u, c.r);
    ck_assert_int_eq(rep.outcome, CONVERGED);
    ck_assert_double_eq_tol(c.u[1], 1, 1e-11);
    ck_assert_double_eq_tol(c.r[0], -0.8, 1e-11);
  }
}

/* ---- degenerate problems ------------------------------------------------ */

TEST(no_load_costs_nothing) {
  const solver_ops *ops;
  for (int dim = 2; dim <= 3; ++dim)
    for (int i = 0; solver_row(i, &ops); ++i) {
      CONTACT_CASE c = case_any(dim, 9, 0.4, 0, 3);
      int m = c.cp.m;
      memset(c.f, 0, (size_t)m * sizeof *c.f);
      memset(c.ut0, 0, (size_t)(m - 9) * sizeof *c.ut0);
      for (int j = 0; j < 9; ++j) c.gap[j] = fabs(c.gap[j]);
      for (int j = 0; j < m; ++j)
        c.u[j] = -0.1 * (j % 3); /* from any state   */
      solver_report rep = solve_by(ops, &c, 1e-10, c.u, c.r);
      ck_assert_int_eq(rep.outcome, CONVERGED);
      ck_assert_int_eq(rep.iterations, 0);
      for (int j = 0; j < m; ++j) ck_assert(c.u[j] == 0.0 && c.r[j] == 0.0);
    }
}

TEST(no_node_is_solved) {
  EACH_SOLVER(i, ops) {
    CONTACT_CASE c = case_new(2, 0, 0.3);
    solver_report rep = solve_by(ops, &c, 1e-10, c.u, c.r);
    ck_assert_int_eq(rep.outcome, CONVERGED);
  }
}

/* Choose the answer (all open or all sticking); the load follows from it. */
static void choose_answer(contact_case *c, int stick, double *want) {
  int m = c->cp.m, dim = c->cp.dim;
  for (int j = 0; j < m; ++j) {
    int node = j / dim, k = j % dim;
    if (stick)
      want[j] = k == 0 ? c->gap[node] : c->ut0[node * (dim - 1) + k - 1];
    else
      want[j] = k == 0 ? c->gap[node] - 0.1 - 0.01 * j : 0.1 * j;
  }
  contact_product(m, c->A, want, c->f);
  for (int j = 0; stick && j < m; ++j) c->f[j] += j % dim == 0 ? 1 : 0.5;
}

static void check_answer(const contact_case *c, int stick, const double *want) {
  int dim = c->cp.dim;
  for (int j = 0; j < c->cp.m; ++j) {
    double r = !stick ? 0.0 : j % dim == 0 ? -1.0 : -0.5;
    ck_assert_double_eq_tol(c->u[j], want[j], 1e-10);
    ck_assert_double_eq_tol(c->r[j], r, stick ? 1e-10 : 1e-11);
  }
}

TEST(all_open_and_all_stick_are_exact) {
  const solver_ops *ops;
  for (int dim = 2; dim <= 3; ++dim)
    for (int i = 0; solver_row(i, &ops); ++i)
      for (int stick = 0; stick < 2; ++stick) {
        CONTACT_CASE c = case_any(dim, 12, stick ? 1e6 : 0.3, 0, 11);
        int m = c.cp.m;
        ck_assert_int_gt(m, 0);
        FREED double *want = calloc((size_t)m, sizeof *want);
        choose_answer(&c, stick, want);
        memset(c.u, 0, (size_t)m * sizeof *c.u);
        solver_report rep = solve_by(ops, &c, 1e-12, c.u, c.r);
        ck_assert_msg(rep.outcome == CONVERGED, "%s", row_name(ops));
        check_answer(&c, stick, want);
      }
}

/* Largest defect of A u = f + r, by a plain product. */
static double equation_defect(const contact_case *c) {
  double defect = 0.0;
  for (int j = 0; j < c->cp.m; ++j) {
    double sum = -c->f[j] - c->r[j];
    for (int l = 0; l < c->cp.m; ++l) sum += c->A[j + c->cp.m * l] * c->u[l];
    defect = fmax(defect, fabs(sum));
  }
  return defect;
}

/* At the floor and at a wall; the wall pushes in one case only. With friction
 * of the others all nodes have been somewhere else. */
TEST(corner_node_meets_both_obstacles) {
  for (int dim = 2; dim <= 3; ++dim)
    for (int push = 0; push < 3; ++push) {
      CONTACT_CASE c = case_any(dim, 5, push == 2 ? 0.3 : 0.0, 0, 21);
      double *side = c.side_gap = calloc((size_t)(5 * (dim - 1)), sizeof *side);
      for (int j = 0; j < 5 * (dim - 1); ++j) side[j] = HUGE_VAL;
      side[2 * (dim - 1)] = 0.05;
      if (dim == 3) side[2 * (dim - 1) + 1] = 0.02;
      c.cp.side_gap = side;
      for (int j = 0; j < 5 * dim; ++j) c.f[j] = j % dim == 0 ? 1.0 : 0.1;
      for (int k = 1; k < dim; ++k) c.f[2 * dim + k] = push ? 9.0 : -9.0;
      EACH_SOLVER(i, ops) {
        case_cold(&c);
        solver_report rep = solve_by(ops, &c, 1e-12, c.u, c.r);
        ck_assert_msg(rep.outcome == CONVERGED, "%s", row_name(ops));
        for (int k = 1; k < dim; ++k) {
          double room = side[2 * (dim - 1) + k - 1] - c.u[2 * dim + k];
          double force = -c.r[2 * dim + k];
          ck_assert_double_ge_tol(room, 0.0, 1e-11);
          ck_assert_double_ge_tol(force, 0.0, 1e-11);
          ck_assert_double_le_tol(fmin(room, force), 0.0, 1e-11);
          if (push) ck_assert_double_gt(force, 1.0);
          if (!push) ck_assert_double_gt(room, 0.1);
        }
        ck_assert_double_le_tol(c.u[0], c.gap[0], 1e-11);
        ck_assert_double_lt(equation_defect(&c), 1e-10);
      }
    }
}

TEST(held_tangents_stay_where_they_are_put) {
  for (int dim = 2; dim <= 3; ++dim) {
    CONTACT_CASE c = case_any(dim, 8, 0.5, 0, 31);
    unsigned char *held = c.held = calloc((size_t)c.cp.m, 1);
    int m = c.cp.m, dof = 3 * dim + 1;
    held[dof] = 1;
    c.cp.held = held;
    for (int j = 0; j < m; ++j)
      c.A[dof + m * j] = c.A[j + m * dof] = j == dof ? 4.0 : 0.0;
    c.f[dof] = 4.0 * 0.125;
    for (int j = 0; j < 8; ++j) c.f[j * dim] = fabs(c.f[j * dim]) + 0.3;
    all_rows_solve(&c, "held", 1e-9);
    ck_assert_double_eq_tol(c.u[dof], 0.125, 1e-12);
    ck_assert_double_eq_tol(c.r[dof], 0.0, 1e-12);
  }
}

TEST(touching_without_force_is_solved) {
  CONTACT_CASE c = case_any(2, 10, 0.3, 0, 41);
  for (int j = 0; j < 20; ++j) c.u[j] = j % 2 == 0 ? c.gap[j / 2] : 0.05 * j;
  contact_reaction(&c.cp, c.u, c.r);
  for (int j = 0; j < 20; ++j) c.f[j] += c.r[j]; /* A u = f exactly           */
  all_rows_solve(&c, "touching", 1e-9);
}

/* One node: open, sticking, slipping to any side, in a corner of its disc. */
TEST(one_node_is_solved_in_every_state) {
  for (int k = 0; k < 120; ++k) {
    CONTACT_CASE c = case_any(2 + k % 2, 1, 0.25 * (k % 4), k / 8 % 2,
                              (unsigned long long)(3000 + k));
    all_rows_solve(&c, "one node", 1e-9);
  }
}

/* All open, all stick, touching without force, one node (kind 0 to 3). */
static contact_case special_case(int dim, int kind, unsigned long long seed) {
  contact_case c =
      case_any(dim, kind == 3 ? 1 : 7, kind == 1 ? 1e6 : 0.3, 0, seed);
  int m = c.cp.m;
  FREED double *want = calloc((size_t)m + 1, sizeof *want);
  if (kind < 2) choose_answer(&c, kind, want);
  for (int j = 0; j < m; ++j) want[j] = j % dim ? 0.05 * j : c.gap[j / dim];
  if (kind == 2) contact_product(m, c.A, want, c.f);
  return c;
}

TEST(special_cases_are_solved_from_the_compliance) {
  for (int k = 0; k < 32; ++k) {
    CONTACT_CASE c = special_case(2 + k % 2, k / 2 % 4, 600u + (unsigned)k);
    size_t m = (size_t)c.cp.m;
    FREED double *W = calloc(m * m, sizeof *W), *q = calloc(m, sizeof *q);
    ck_assert(case_inverse(c.cp.m, c.A, W));
    contact_product(c.cp.m, W, c.f, q);
    contact_case given = c;
    given.cp.A = NULL;
    given.cp.W = W;
    given.cp.f = q;
    EACH_SOLVER(i, ops) {
      case_cold(&c);
      solver_report rep = solve_by(ops, &given, 1e-11, c.u, c.r);
      ck_assert_msg(rep.outcome == CONVERGED, "%s: case %d: %s", row_name(ops),
                    k, outcome_text(rep.outcome));
      ck_assert_msg(case_violation(&c, c.u, c.r) < 1e-8, "%s: case %d",
                    row_name(ops), k);
    }
  }
}

/* W alone, of half the rank but for 1e-9 or (with u = 0 where it is flat)
 * nothing at all, and a q that it can take back. */
TEST(nearly_singular_compliance_is_solved) {
  for (int k = 0; k < 24; ++k) {
    int dim = 2 + k % 2, n = 3 + k % 7, m = dim * n, rank = m / 2;
    unsigned long long seed = 4000 + (unsigned)k;
    CONTACT_CASE c = case_new(dim, n, 0.2 * (k % 3));
    double G[30 * 15], v[15];
    for (int j = 0; j < rank; ++j) v[j] = case_random(&seed) - 0.5;
    for (int i = 0; i < m * rank; ++i) G[i] = case_random(&seed) - 0.5;
    for (int i = 0; i < m; ++i)
      for (int a = 0; a < rank; ++a) {
        c.f[i] += G[i + m * a] * v[a];
        for (int j = 0; j < m; ++j)
          c.A[i + m * j] += G[i + m * a] * G[j + m * a];
      }
    for (int i = 0; i < m; ++i) c.A[i + m * i] += k % 4 < 2 ? 1e-9 : 0.0;
    c.cp.W = c.A;
    c.cp.A = NULL;
    EACH_SOLVER(i, ops) {
      case_cold(&c);
      solver_report rep = solve_by(ops, &c, 1e-8, c.u, c.r);
      if (ops != NULL && (ops->handles & NEEDS_STIFFNESS) &&
          rep.outcome != CONVERGED)
        continue; /* it needs an inverse                                      */
      ck_assert_msg(rep.outcome == CONVERGED, "%s: problem %d: %s",
                    row_name(ops), k, outcome_text(rep.outcome));
      ck_assert(contact_residual(&c.cp, c.u, c.r) <= 1e-8);
    }
  }
}

/* Active sets cycle on this P-matrix LCP (w = M z + q): u = -z, gap = 0,
 * w = -r; solution z = (0, 1/2, 5/2). */
TEST(auto_solves_the_cycling_p_matrix) {
  static const double M[3][3] = {{3, 1, -1}, {2, 1, 1}, {0, -3, 1}};
  static const double q[3] = {2, -3, -1}, z[3] = {0, 0.5, 2.5};
  CONTACT_CASE c = case_new(2, 3, 0.0);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) c.A[2 * i + 6 * (2 * j)] = M[i][j];
    c.A[(2 * i + 1) * 7] = 1.0;
    c.f[2 * i] = q[i];
  }
  solver_report rep = solve_by(NULL, &c, 1e-12, c.u, c.r);
  ck_assert_int_eq(rep.outcome, CONVERGED);
  for (int i = 0; i < 3; ++i) ck_assert_double_eq_tol(-c.u[2 * i], z[i], 1e-12);
}

/* A rigid box on four feet: W has rank 6 of 12, forces are not unique. */
TEST(rigid_body_is_solved_in_compliance_form) {
  CONTACT_CASE c = case_new(3, 4, 0.5);
  double load[6] = {0.3, 0.1, -1, 0.1, -0.2, 0.05}, force[6] = {0};
  static const double axis[3][3] = {{0, 0, -1}, {1, 0, 0}, {0, 1, 0}};
  double H[12][6];
  for (int i = 0; i < 12; ++i) {
    const double *d = axis[i % 3];
    double p[3] = {i / 3 % 2 ? 1.0 : -1.0, i / 6 ? 1.0 : -1.0, -1.0};
    for (int k = 0; k < 3; ++k) {
      H[i][k] = d[k];
      H[i][3 + k] =
          p[(k + 1) % 3] * d[(k + 2) % 3] - p[(k + 2) % 3] * d[(k + 1) % 3];
    }
  }
  for (int i = 0; i < 12; ++i)
    for (int k = 0; k < 6; ++k) {
      c.f[i] += H[i][k] * load[k];
      for (int j = 0; j < 12; ++j) c.A[i + 12 * j] += H[i][k] * H[j][k];
    }
  c.cp.W = c.A;
  c.cp.A = NULL;
  solver_report rep = solve_by(NULL, &c, 1e-10, c.u, c.r);
  ck_assert_int_eq(rep.outcome, CONVERGED);
  for (int i = 0; i < 12; ++i)
    for (int k = 0; k < 6; ++k) force[k] += H[i][k] * c.r[i];
  for (int k = 0; k < 6; ++k) /* it stands still                              */
    ck_assert_double_eq_tol(force[k] + load[k], 0.0, 1e-9);
}

/* ---- precision ---------------------------------------------------------- */

TEST(slip_turns_with_the_load_at_any_angle) {
  const solver_ops *ops;
  for (int degree = 0; degree < 360; degree += 17)
    for (int i = 0; solver_row(i, &ops); ++i) {
      if (ops != NULL && !(ops->handles & SOLVES_3D)) continue;
      CONTACT_CASE c = case_any(3, 6, 0.4, 0, 51);
      double a = degree * acos(-1.0) / 180.0;
      memset(c.ut0, 0, 12 * sizeof *c.ut0);
      for (int j = 0; j < 6; ++j) {
        c.gap[j] = 0.0;
        c.f[3 * j] = 2.0;
        c.f[3 * j + 1] = 3.0 * cos(a);
        c.f[3 * j + 2] = 3.0 * sin(a);
      }
      solver_report rep = solve_by(ops, &c, 1e-12, c.u, c.r);
      ck_assert_msg(rep.outcome == CONVERGED, "%s", row_name(ops));
      int slipping = 0;
      for (int j = 0; j < 6; ++j) {
        const double *u = c.u + 3 * j, *r = c.r + 3 * j;
        double s = hypot(u[1], u[2]), t = hypot(r[1], r[2]);
        if (s < 1e-3 || t < 1e-3) continue;
        ++slipping;
        ck_assert_double_eq_tol(t, -0.4 * r[0], 1e-10);
        ck_assert_msg(fabs(1.0 + (u[1] * r[1] + u[2] * r[2]) / (s * t)) < 1e-10,
                      "%s", row_name(ops));
        ck_assert_double_eq_tol((u[1] * r[2] - u[2] * r[1]) / (s * t), 0.0,
                                1e-9);
      }
      ck_assert_int_gt(slipping, 2);
    }
}

TEST(tolerance_1e_12_is_reached) {
  for (int k = 0; k < 40; ++k) {
    CONTACT_CASE c = case_any(2 + k % 2, 10 + k, 0.4, k / 2 % 2,
                              (unsigned long long)(900 + k));
    solver_report rep = solve_by(NULL, &c, 1e-12, c.u, c.r);
    ck_assert_int_eq(rep.outcome, CONVERGED);
    ck_assert(rep.residual <= 1e-12);
  }
}

/* Stiffness by 2^a, lengths by 2^b: the same bits. */
TEST(factors_of_two_change_no_bit_of_the_answer) {
  static const int powers[][2] = {{40, 0}, {-40, 0}, {0, 13}, {7, -21}};
  const solver_ops *ops;
  for (int k = 0; k < 32; ++k)
    for (int i = 0; solver_row(i, &ops); ++i) {
      CONTACT_CASE c = case_any(2 + k % 2, 1 + k, k % 3 ? 0.6 : 0.0, k / 2 % 2,
                                (unsigned long long)(300 + k));
      CONTACT_CASE d = case_any(2 + k % 2, 1 + k, k % 3 ? 0.6 : 0.0, k / 2 % 2,
                                (unsigned long long)(300 + k));
      int m = c.cp.m, n = c.cp.n, a = powers[k % 4][0], b = powers[k % 4][1];
      for (int j = 0; j < m * m; ++j) d.A[j] = ldexp(c.A[j], a);
      for (int j = 0; j < m; ++j) d.f[j] = ldexp(c.f[j], a + b);
      for (int j = 0; j < n; ++j) d.gap[j] = ldexp(c.gap[j], b);
      for (int j = 0; j < m - n; ++j) d.ut0[j] = ldexp(c.ut0[j], b);
      solver_report one = solve_by(ops, &c, 1e-10, c.u, c.r);
      solver_report two = solve_by(ops, &d, 1e-10, d.u, d.r);
      ck_assert_int_eq(one.outcome, two.outcome);
      ck_assert_int_eq(one.iterations, two.iterations);
      for (int j = 0; j < m; ++j) {
        ck_assert_msg(d.u[j] == ldexp(c.u[j], b), "%s: problem %d",
                      row_name(ops), k);
        ck_assert(d.r[j] == ldexp(c.r[j], a + b));
      }
    }
}

/* ---- behaviour ---------------------------------------------------------- */

TEST(solved_state_is_kept_and_a_near_one_is_cheap) {
  for (int k = 0; k < 20; ++k) {
    CONTACT_CASE c =
        case_any(2 + k % 2, 40, 0.4, k / 2 % 2, (unsigned long long)(700 + k));
    solver_choice choice = {.tol = 1e-10};
    ENDS_BY(contact_solver_free) contact_solver *s = NULL;
    solver_report rep;
    int m = c.cp.m;
    FREED double *u = calloc((size_t)m, sizeof *u);
    ck_assert_int_eq(contact_solver_new(&choice, &s), OK);
    ck_assert_int_eq(contact_solve(s, &c.cp, NULL, c.u, c.r, &rep), OK);
    memcpy(u, c.u, (size_t)m * sizeof *u);
    ck_assert_int_eq(contact_solve(s, &c.cp, NULL, c.u, c.r, &rep), OK);
    ck_assert_int_eq(rep.iterations, 0);
    ck_assert(memcmp(u, c.u, (size_t)m * sizeof *u) == 0);
    for (int j = 0; j < m; ++j) c.f[j] *= 1.0 + 1e-4;
    ck_assert_int_eq(contact_solve(s, &c.cp, NULL, c.u, c.r, &rep), OK);
    ck_assert_int_eq(rep.outcome, CONVERGED);
    ck_assert_int_le(rep.iterations, 4);
  }
}

/* What persists from one solution to the next, through a file. */
static void pass_on(const solver_ops *ops, void *from, void *to) {
  archive *a = NULL;
  FOLDER(folder);
  PRINTED(path, "%s/work", folder);
  PRINTED(before, "%s/before", folder);
  ck_assert_int_eq(archive_new(&a), OK);
  ck_assert_int_eq(ops->keep(from, a), OK);
  ck_assert_msg(archive_write(a, path, before) == OK, "%s", status_message());
  archive_free(&a);
  ck_assert_int_eq(archive_read(path, &a), OK);
  ck_assert_int_eq(ops->keep(to, a), OK);
  archive_free(&a);
}

/* Of a solution nothing persists but what is saved. */
TEST(nothing_persists_that_is_not_saved) {
  enum { NODES = 24, MOST = 3 * NODES };
  const solver_ops *ops;
  const solver_control control = {.tol = 1e-10};
  for (int k = 0; k < 8; ++k)
    for (int i = 0; solver_row(i, &ops) && ops != NULL; ++i) {
      CONTACT_CASE c = case_any(2 + k % 2, NODES, 0.4, k / 2 % 2,
                                (unsigned long long)(900 + k));
      double param[PARAM_SIZE / sizeof(double)] = {0.0}, W[MOST * MOST];
      double f[MOST], u[MOST] = {0}, r[MOST] = {0};
      const size_t m = (size_t)c.cp.m, bytes = m * sizeof *u;
      void *work[2] = {NULL, NULL};
      solver_report rep[2];
      ck_assert(case_inverse((int)m, c.A, W));
      if (ops->handles & NEEDS_COMPLIANCE) c.cp.W = W;
      option_defaults(ops->options, param);
      for (int a = 0; a < 2; ++a)
        ck_assert_int_eq(solver_set_up(ops, &c.cp, param, &work[a]), OK);
      memcpy(f, c.f, bytes);
      for (size_t j = 0; j < m; ++j) /* another problem, or a near one */
        c.f[j] =
            k < 4 ? -0.7 * f[(j + 3) % m] : f[j] * (1 + 0.2 * sin((double)j));
      ck_assert_int_eq(
          ops->solve(&c.cp, param, work[0], &control, c.u, c.r, &rep[0]), OK);
      if (ops->keep != NULL) pass_on(ops, work[0], work[1]);
      memcpy(c.f, f, bytes);
      case_cold(&c);
      ck_assert_int_eq(
          ops->solve(&c.cp, param, work[0], &control, c.u, c.r, &rep[0]), OK);
      ck_assert_int_eq(
          ops->solve(&c.cp, param, work[1], &control, u, r, &rep[1]), OK);
      ck_assert_msg(rep[0].iterations == rep[1].iterations &&
                        rep[0].outcome == rep[1].outcome &&
                        memcmp(u, c.u, bytes) == 0 &&
                        memcmp(r, c.r, bytes) == 0,
                    "%s, problem %d: %d iterations, not %d", row_name(ops), k,
                    rep[0].iterations, rep[1].iterations);
      for (int a = 0; a < 2; ++a) memory_free(work[a]);
    }
}

/* Increments under the same load, solved to the same tolerance: friction acts
 * against the slip from the state reached. Random bodies, and a block that
 * contact alone holds. */
static contact_case body_under_load(int k) {
  if (k % 4 < 3)
    return case_any(2 + k % 2, 3 + k, 0.3, k / 2 % 2,
                    (unsigned long long)(5000 + k));
  case_block_data d = {.columns = 6 + k,
                       .layers = 4,
                       .nu = 0.2,
                       .mu = 0.4,
                       .top = {k % 3 * 1e-4, -1e-3}};
  return case_block(&d);
}

TEST(body_at_rest_costs_next_to_nothing) {
  const solver_ops *ops;
  for (int k = 0; k < 12; ++k)
    for (int i = 0; solver_row(i, &ops); ++i) {
      CONTACT_CASE c = body_under_load(k);
      int dim = c.cp.dim;
      double tol = k % 2 == 0 ? 1e-10 : 1e-6;
      ck_assert_int_eq(solve_by(ops, &c, tol, c.u, c.r).outcome, CONVERGED);
      for (int increment = 0; increment < 3; ++increment) {
        for (int j = 0; j < c.cp.n; ++j)
          for (int t = 1; t < dim; ++t)
            c.ut0[j * (dim - 1) + t - 1] = c.u[j * dim + t];
        solver_report rep = solve_by(ops, &c, tol, c.u, c.r);
        ck_assert_int_eq(rep.outcome, CONVERGED);
        ck_assert_msg(rep.iterations <= 2, "%s: %d", row_name(ops),
                      rep.iterations);
      }
    }
}

TEST(nan_in_the_data_is_told) {
  EACH_SOLVER(i, ops)
  for (int k = 0; k < 5; ++k) {
    CONTACT_CASE c = case_any(2, 5, 0.3, 0, 61);
    double *where[] = {c.A, c.f, c.gap, c.ut0, c.g0};
    where[k][0] = NAN;
    solver_report rep = solve_by(ops, &c, 1e-10, c.u, c.r);
    ck_assert_int_eq(rep.outcome, STOPPED_NAN);
  }
}

TEST(nan_in_the_start_is_forgotten) {
  EACH_SOLVER(i, ops) {
    CONTACT_CASE c = case_any(2, 5, 0.3, 0, 61);
    c.u[3] = c.r[4] = NAN;
    solver_report rep = solve_by(ops, &c, 1e-10, c.u, c.r);
    ck_assert_int_eq(rep.outcome, CONVERGED);
  }
}

static void count_step(void *ctx, const solver_step *s) {
  int *count = ctx;
  ck_assert_ptr_nonnull(s->solver);
  ck_assert_msg(s->iteration >= 0, "%s", s->solver);
  ++*count;
}

static void keep_step(void *ctx, const solver_step *s) {
  *(solver_step *)ctx = *s;
}

TEST(step_is_heard_as_it_was_told) {
  solver_step heard = {0};
  const solver_listener listener = {keep_step, &heard};
  const solver_control control = {.listener = &listener};
  solver_report_step(&control, "name", 7, 0.25);
  ck_assert_str_eq(heard.solver, "name");
  ck_assert_int_eq(heard.iteration, 7);
  ck_assert_double_eq(heard.residual, 0.25);
  ck_assert_int_eq(heard.status_changes, -1);
}

TEST(best_of_none_leaves_the_start) {
  best_iterate best;
  double u[] = {1.0, 2.0}, r[] = {3.0, 4.0};
  ck_assert_int_eq(best_iterate_new(2, &best), OK);
  solver_keep_best(&best, 2, NAN, u, r);
  solver_take_best(&best, 2, u, r);
  ck_assert(u[0] == 1.0 && u[1] == 2.0 && r[0] == 3.0 && r[1] == 4.0);
  solver_keep_best(&best, 2, 0.5, r, u);
  solver_keep_best(&best, 2, 0.6, u, r);
  solver_take_best(&best, 2, u, r);
  ck_assert(u[0] == 3.0 && u[1] == 4.0 && r[0] == 1.0 && r[1] == 2.0);
  memory_free(best.u);
  memory_free(best.r);
}

TEST(limit_of_iterations_is_honest_and_heard) {
  EACH_SOLVER(i, ops) {
    if (ops == NULL) continue;
    CONTACT_CASE c = case_any(2, 50, 0.8, 1, 71);
    double param[PARAM_SIZE / sizeof(double)] = {0.0};
    int heard = 0;
    solver_listener listener = {count_step, &heard};
    solver_choice choice = {
        .ops = ops, .param = param, .tol = 1e-13, .max_iter = 1};
    ENDS_BY(contact_solver_free) contact_solver *s = NULL;
    solver_report rep;
    ck_assert_int_eq(contact_solver_new(&choice, &s), OK);
    ck_assert_int_eq(contact_solve(s, &c.cp, &listener, c.u, c.r, &rep), OK);
    ck_assert_int_eq(rep.outcome, STOPPED_ITERATIONS);
    ck_assert(rep.residual > 1e-13);
    ck_assert_msg(heard > 0, "%s", row_name(ops));
  }
}

/* Request k refused, for all k: ERR_MEMORY, nothing left behind. */
TEST(refused_memory_is_told_and_given_back) {
  const solver_ops *ops;
  for (int form = 0; form < 2; ++form)
    for (int i = 0; solver_row(i, &ops); ++i) {
      CONTACT_CASE c = case_any(2, 6, 3.0, 0, 81);
      if (form == 1) {
        c.cp.W = c.A;
        c.cp.A = NULL;
      }
      size_t before = memory_in_use();
      int refused = 0;
      for (long k = 1;; ++k) {
        double param[PARAM_SIZE / sizeof(double)] = {0.0};
        solver_choice choice = {.ops = ops, .param = param, .tol = 1e-10};
        contact_solver *s = NULL;
        solver_report rep;
        memset(c.u, 0, 12 * sizeof *c.u);
        memset(c.r, 0, 12 * sizeof *c.r);
        if (ops != NULL && option_find(ops->options, "FRICTION") != NULL)
          set_option(ops, param, "FRICTION", "FIXED_POINT");
        memory_refuse(k, 0);
        status st = contact_solver_new(&choice, &s);
        if (st == OK) st = contact_solve(s, &c.cp, NULL, c.u, c.r, &rep);
        memory_refuse(0, 0);
        contact_solver_free(&s);
        ck_assert_uint_eq(memory_in_use(), before);
        if (st == OK) break;
        ck_assert_int_eq(st, ERR_MEMORY);
        ++refused;
      }
      ck_assert_int_gt(refused, 5);
    }
}

UNIT_MAIN("solver")
