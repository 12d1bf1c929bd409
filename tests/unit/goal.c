/*
 * src/accuracy/goal/adjoint.c: the adjoint of a contact problem
 * against solutions under changed loads and from changed positions of stick,
 * and its error against disturbed solutions; an operator against its matrix.
 */
#include "accuracy/goal/goal.h"

#include "accuracy/accuracy.h"
#include "effects/goal/parts.h"
#include "support/solver_rows.h"
#include "support/unit.h"

#include <lapacke.h>

enum { NODES = 12, MOST = 3 * NODES };
static const double TOL = 1e-14;

/* J = j'u + psi'r at a solution, and its adjoint. */
typedef struct goal_case {
  contact_case c;
  double j[MOST], psi[MOST], y[MOST], stick[MOST], solver;
} goal_case;

static double value(const goal_case *g, const double *u, const double *r) {
  double sum = 0.0;
  for (int k = 0; k < g->c.cp.m; ++k) sum += g->j[k] * u[k] + g->psi[k] * r[k];
  return sum;
}

static void find_adjoint(goal_case *g, const double *u, const double *r) {
  OWNED contact_adjoint *a = NULL;
  ck_assert_int_eq(contact_adjoint_new(&g->c.cp, u, r, &a), OK);
  ck_assert_ptr_nonnull(a);
  ck_assert_int_eq(contact_adjoint_solve(a, g->j, g->psi, g->y, &g->solver),
                   OK);
  memcpy(g->stick, contact_adjoint_stick(a),
         (size_t)g->c.cp.m * sizeof *g->stick);
}

/* 1: a force acts on the unknown. */
static int carries(const goal_case *g, int dof) {
  contact_status s[NODES];
  contact_classify(&g->c.cp, g->c.u, g->c.r, s);
  if (dof % g->c.cp.dim > 0 && g->c.cp.g0 == NULL) return 0;
  return s[dof / g->c.cp.dim] != CONTACT_OPEN;
}

/* A random problem, solved; average: a nonlocal limit. psi where forces act. */
static goal_case goal_new(int dim, double mu, int average,
                          unsigned long long seed) {
  goal_case g = {.c = case_any(dim, NODES, mu, (int)(seed % 2), seed)};
  if (average) case_average(&g.c, 2, mu);
  solver_report rep = solve_by(NULL, &g.c, TOL, g.c.u, g.c.r);
  ck_assert_int_gt(rep.outcome, 0);
  for (int k = 0; k < g.c.cp.m; ++k) {
    g.j[k] = case_random(&seed) - 0.5;
    g.psi[k] = carries(&g, k) ? case_random(&seed) - 0.5 : 0.0;
  }
  find_adjoint(&g, g.c.u, g.c.r);
  return g;
}

/* 1: the same nodes are open, slip and stick. */
static int same_states(const goal_case *g, const double *u, const double *r) {
  contact_status a[NODES], b[NODES];
  contact_classify(&g->c.cp, g->c.u, g->c.r, a);
  contact_classify(&g->c.cp, u, r, b);
  return memcmp(a, b, sizeof a) == 0;
}

/* The same from positions of stick that are "sign" times ds[m] further. */
static int solve_moved(goal_case *g, const double *ds, double sign, double *J) {
  double u[MOST], r[MOST];
  const int dim = g->c.cp.dim;
  memcpy(u, g->c.u, (size_t)g->c.cp.m * sizeof *u);
  memcpy(r, g->c.r, (size_t)g->c.cp.m * sizeof *r);
  for (int pass = 0; pass < 2; ++pass) {
    const double by = pass == 0 ? sign : -sign;
    for (int i = 0; i < NODES; ++i)
      for (int a = 1; a < dim; ++a)
        g->c.ut0[(dim - 1) * i + a - 1] += by * ds[dim * i + a];
    if (pass == 0) solve_by(NULL, &g->c, TOL, u, r);
  }
  *J = value(g, u, r);
  return same_states(g, u, r);
}

static int count(const goal_case *g, contact_status what) {
  contact_status s[NODES];
  int n = 0;
  contact_classify(&g->c.cp, g->c.u, g->c.r, s);
  for (int i = 0; i < NODES; ++i) n += s[i] == what;
  return n;
}

/* dJ of the load f + df, by a solution, into *dJ; 0: other states. */
static int solve_changed(goal_case *g, const double *df, double sign,
                         double *J) {
  double u[MOST], r[MOST];
  const size_t bytes = (size_t)g->c.cp.m * sizeof *u;
  memcpy(u, g->c.u, bytes);
  memcpy(r, g->c.r, bytes);
  for (int k = 0; k < g->c.cp.m; ++k) g->c.f[k] += sign * df[k];
  solve_by(NULL, &g->c, TOL, u, r);
  for (int k = 0; k < g->c.cp.m; ++k) g->c.f[k] -= sign * df[k];
  *J = value(g, u, r);
  return same_states(g, u, r);
}

/* Cases of two and three dimensions: without friction, local, nonlocal. */
TESTS(adjoint_is_the_derivative_by_the_load, 6) {
  static const double eps = 1e-6;
  const int dim = 2 + _i % 2, kind = _i / 2;
  int slip = 0, stick = 0, open = 0, checked = 0;
  for (unsigned long long seed = 1; seed <= 12; ++seed) {
    goal_case g = goal_new(dim, kind == 0 ? 0.0 : 0.4, kind == 2, seed);
    double df[MOST], by_adjoint = 0.0, size = 0.0, J[2];
    unsigned long long dice = seed + 100;
    for (int k = 0; k < g.c.cp.m; ++k) {
      df[k] = eps * (case_random(&dice) - 0.5);
      by_adjoint += g.y[k] * df[k];
      size += fabs(g.y[k] * df[k]);
    }
    if (solve_changed(&g, df, 1.0, &J[0]) &&
        solve_changed(&g, df, -1.0, &J[1])) {
      const double is = 0.5 * (J[0] - J[1]);
      ck_assert_msg(fabs(is - by_adjoint) < 1e-4 * size,
                    "seed %llu: %.9g, by the adjoint %.9g of %g", seed, is,
                    by_adjoint, size);
      ++checked;
    }
    slip += count(&g, CONTACT_SLIP);
    stick += count(&g, CONTACT_STICK);
    open += count(&g, CONTACT_OPEN);
    case_free(&g.c);
  }
  ck_assert_int_ge(checked, 8);
  ck_assert_int_gt(open, 0);
  ck_assert_int_gt(slip, 0);
  ck_assert_int_eq(stick > 0, kind > 0);
}

/* Local and nonlocal friction in two and three dimensions: where an increment
 * before has left the nodes. */
TESTS(adjoint_is_the_derivative_by_the_positions_of_stick, 4) {
  static const double eps = 1e-6;
  const int dim = 2 + _i % 2;
  int checked = 0;
  for (unsigned long long seed = 1; seed <= 12; ++seed) {
    goal_case g = goal_new(dim, 0.4, _i / 2, seed);
    double ds[MOST] = {0.0}, by_adjoint = 0.0, size = 0.0, J[2];
    unsigned long long dice = seed + 100;
    for (int k = 0; k < g.c.cp.m; ++k) {
      if (k % dim > 0) ds[k] = eps * (case_random(&dice) - 0.5);
      by_adjoint += g.stick[k] * ds[k];
      size += fabs(g.stick[k] * ds[k]);
    }
    if (count(&g, CONTACT_STICK) > 0 && solve_moved(&g, ds, 1.0, &J[0]) &&
        solve_moved(&g, ds, -1.0, &J[1])) {
      const double is = 0.5 * (J[0] - J[1]);
      ck_assert_msg(fabs(is - by_adjoint) < 1e-4 * size,
                    "seed %llu: %.9g, by the adjoint %.9g of %g", seed, is,
                    by_adjoint, size);
      ++checked;
    }
    case_free(&g.c);
  }
  ck_assert_int_ge(checked, 6);
}

/* After slip nodes are at their limit and at rest: on whichever side of it
 * rounding puts them. The contraction is that of nodes that go on. */
TESTS(nodes_at_rest_have_one_adjoint, 4) {
  const int dim = 2 + _i % 2;
  int slipped = 0;
  for (unsigned long long seed = 1; seed <= 12; ++seed) {
    goal_case g = goal_new(dim, 0.4, _i / 2, seed);
    double y[MOST], u[MOST], most = 0.0, rate[2];
    unsigned long long dice = seed;
    slipped += count(&g, CONTACT_SLIP);
    contraction_rate(&g.c.cp, g.c.u, g.c.r, NULL, &rate[0]);
    for (int k = 0; k < g.c.cp.m; ++k) {
      if (k % dim > 0) g.c.ut0[(dim - 1) * (k / dim) + k % dim - 1] = g.c.u[k];
      u[k] = g.c.u[k] * (1.0 + 1e-15 * (case_random(&dice) - 0.5));
    }
    find_adjoint(&g, g.c.u, g.c.r);
    memcpy(y, g.y, sizeof y);
    find_adjoint(&g, u, g.c.r);
    contraction_rate(&g.c.cp, u, g.c.r, NULL, &rate[1]);
    if (dim == 2) ck_assert_double_eq_tol(rate[1], rate[0], 1e-9);
    for (int k = 0; k < g.c.cp.m; ++k) most = fmax(most, fabs(y[k]));
    for (int k = 0; k < g.c.cp.m; ++k)
      ck_assert_double_eq_tol(g.y[k], y[k], 1e-9 * most);
    case_free(&g.c);
  }
  ck_assert_int_gt(slipped, 0);
}

/* A block that slides on one node of its foot may turn about it, but for
 * rounding. */
TESTS(a_block_that_rocks_has_no_adjoint, 6) {
  const case_block_data d = {.columns = 4,
                             .layers = 2 + _i,
                             .nu = 0.2,
                             .mu = 0.3,
                             .top = {0.0, -1e-3}};
  CONTACT_CASE c = case_block(&d);
  contact_adjoint *a = NULL;
  double rate;
  for (int i = 0; i <= d.columns; ++i) c.u[2 * i] = -1.0;
  for (int k = 0; k < c.cp.m; ++k) c.A[k * (c.cp.m + 1)] *= 1.0 + 1e-14;
  c.u[4] = 0.0;
  c.u[5] = -1.0;
  c.r[4] = -1e-3;
  c.r[5] = 0.3e-3;
  ck_assert_int_eq(contact_adjoint_new(&c.cp, c.u, c.r, &a), OK);
  ck_assert_ptr_null(a);
  ck_assert_int_eq(contraction_rate(&c.cp, c.u, c.r, NULL, &rate), OK);
  ck_assert(rate == HUGE_VAL);
}

/* du, and with it J, by loads df and sticks ds: the transpose of the adjoint.
 */
static double change_of(const goal_case *g, const double *df, const double *ds,
                        double *du) {
  OWNED contact_adjoint *a = NULL;
  double sum = 0.0, dr[MOST];
  ck_assert_int_eq(contact_adjoint_new(&g->c.cp, g->c.u, g->c.r, &a), OK);
  ck_assert_int_eq(contact_adjoint_change(a, df, ds, du), OK);
  contact_apply(&g->c.cp, du, dr);
  for (int k = 0; k < g->c.cp.m; ++k)
    sum += g->j[k] * du[k] + g->psi[k] * (dr[k] - df[k]);
  return sum;
}

TESTS(changes_are_the_transpose_of_the_adjoint, 6) {
  const int dim = 2 + _i % 2, kind = _i / 2;
  for (unsigned long long seed = 1; seed <= 6; ++seed) {
    goal_case g = goal_new(dim, kind == 0 ? 0.0 : 0.4, kind == 2, seed);
    double df[MOST], ds[MOST] = {0.0}, du[MOST], sum = 0.0, size = 0.0;
    unsigned long long dice = seed + 100;
    for (int k = 0; k < g.c.cp.m; ++k) {
      df[k] = case_random(&dice) - 0.5;
      if (k % dim > 0) ds[k] = case_random(&dice) - 0.5;
      sum += g.y[k] * df[k] + g.stick[k] * ds[k];
      size += fabs(g.y[k] * df[k]) + fabs(g.stick[k] * ds[k]);
    }
    const double is = change_of(&g, df, ds, du);
    ck_assert_msg(fabs(is - sum) < 1e-11 * size, "seed %llu: %.12g, %.12g",
                  seed, is, sum);
    case_free(&g.c);
  }
}

/* ---- an operator in the place of the matrix ------------------------------ */

/* A by products, and by solves with a factor of its own. */
typedef struct by_solves {
  const contact_problem *cp;
  unsigned char known[MOST];
  double added[3 * MOST], diagonal[MOST];
} by_solves;

static void apply(void *ctx, const double *u, double *Au, double *size) {
  const by_solves *b = ctx;
  contact_product(b->cp->m, b->cp->A, u, Au);
}

static status set_rows(void *ctx, const known_rows *rows, int *singular) {
  by_solves *b = ctx;
  memcpy(b->known, rows->known, (size_t)b->cp->m);
  memcpy(b->added, rows->added,
         (size_t)(b->cp->dim * b->cp->m) * sizeof *b->added);
  *singular = 0;
  return OK;
}

static void solve(void *ctx, const double *rhs, double *x, double *Ax) {
  const by_solves *b = ctx;
  const int m = b->cp->m, dim = b->cp->dim;
  static double M[MOST * MOST];
  lapack_int pivot[MOST];
  for (int i = 0; i < m; ++i) {
    if (!b->known[i]) x[i] = rhs[i];
    for (int j = 0; j < m; ++j) {
      M[i + m * j] = b->known[i] ? i == j : b->cp->A[i + m * j];
      if (!b->known[i] && i / dim == j / dim)
        M[i + m * j] += b->added[dim * i + j % dim];
    }
  }
  LAPACKE_dgesv(LAPACK_COL_MAJOR, m, 1, M, m, pivot, x, m);
  contact_product(m, b->cp->A, x, Ax);
}

TESTS(an_operator_gives_what_its_matrix_does, 6) {
  const int dim = 2 + _i % 2, kind = _i / 2;
  for (unsigned long long seed = 1; seed <= 6; ++seed) {
    goal_case g = goal_new(dim, kind == 0 ? 0.0 : 0.4, kind == 2, seed);
    const contact_problem matrix = g.c.cp;
    by_solves b = {.cp = &matrix};
    double workspace[2 * MOST];
    const contact_operator op = {.ctx = &b,
                                 .diagonal = b.diagonal,
                                 .workspace = workspace,
                                 .apply = apply,
                                 .set_rows = set_rows,
                                 .solve = solve};
    double y[MOST], stick[MOST], df[MOST], ds[MOST] = {0.0}, du[2][MOST];
    unsigned long long dice = seed;
    for (int k = 0; k < matrix.m; ++k) {
      b.diagonal[k] = matrix.A[k + matrix.m * k];
      df[k] = case_random(&dice) - 0.5;
      if (k % dim > 0) ds[k] = case_random(&dice) - 0.5;
    }
    memcpy(y, g.y, sizeof y);
    memcpy(stick, g.stick, sizeof stick);
    change_of(&g, df, ds, du[0]);
    g.c.cp.A = NULL;
    g.c.cp.op = &op;
    find_adjoint(&g, g.c.u, g.c.r);
    change_of(&g, df, ds, du[1]);
    double most[3] = {0.0};
    for (int k = 0; k < matrix.m; ++k) {
      most[0] = fmax(most[0], fabs(y[k]));
      most[1] = fmax(most[1], fabs(stick[k]));
      most[2] = fmax(most[2], fabs(du[0][k]));
    }
    for (int k = 0; k < matrix.m; ++k) {
      ck_assert_double_eq_tol(g.y[k], y[k], 1e-10 * most[0]);
      ck_assert_double_eq_tol(g.stick[k], stick[k], 1e-10 * most[1] + 1e-300);
      ck_assert_double_eq_tol(du[1][k], du[0][k], 1e-10 * most[2]);
    }
    g.c.cp = matrix;
    case_free(&g.c);
  }
}

/* Displacements and forces that miss equations and conditions a little. */
TESTS(error_of_the_solver_is_that_of_a_disturbed_solution, 6) {
  static const double eps = 1e-8;
  const int dim = 2 + _i % 2, kind = _i / 2;
  for (unsigned long long seed = 1; seed <= 12; ++seed) {
    goal_case g = goal_new(dim, kind == 0 ? 0.0 : 0.4, kind == 2, seed);
    double u[MOST], r[MOST], most = 0.0;
    unsigned long long dice = seed + 100;
    for (int k = 0; k < g.c.cp.m; ++k) {
      u[k] = g.c.u[k] + eps * (case_random(&dice) - 0.5);
      r[k] = g.c.r[k];
      if (carries(&g, k)) r[k] += eps * (case_random(&dice) - 0.5);
      most = fmax(most, fabs(g.y[k]));
    }
    const double is = value(&g, g.c.u, g.c.r) - value(&g, u, r);
    find_adjoint(&g, u, r);
    if (same_states(&g, u, r))
      ck_assert_msg(fabs(g.solver - is) < 1e-3 * (fabs(is) + eps * most),
                    "seed %llu: %g, told %g", seed, is, g.solver);
    case_free(&g.c);
  }
}

/* Close to each limit, on both sides of it. */
TEST(verdicts_change_at_their_limits) {
  static const struct {
    double error, ends, supports;
    double few, near;
    goal_verdict verdict;
  } cases[] = {{0.051, 0.029, 0.0, 0.0, 0.0, GOAL_RELIABLE},
               {-0.051, 0.0, 0.0, 0.029, 0.029, GOAL_RELIABLE},
               {0.051, 0.029, 0.0, 0.031, 0.0, GOAL_FEW_NODES},
               {-0.051, 0.031, 0.0, 1.0, 0.0, GOAL_FEW_NODES},
               {0.051, 0.031, 0.015, 0.0, 0.0, GOAL_CONTACT_END},
               {0.051, 0.031, 0.0, 0.0, 0.9, GOAL_CONTACT_END},
               {0.051, 0.031, 0.016, 0.0, 0.0, GOAL_SUPPORT_END},
               {0.051, 0.02, 0.0, 0.0, 0.011, GOAL_SUPPORT_END},
               {-0.049, 0.029, 0.0, 0.0, 0.0, GOAL_CANCELS},
               {0.049, 0.0, 0.0, 0.0, 0.0, GOAL_CANCELS}};
  for (int k = 0; k < 10; ++k) {
    const goal_estimate e = {.error = 2.0 * cases[k].error,
                             .magnitude = 2.0,
                             .product = 5.0,
                             .ends = 5.0 * cases[k].ends,
                             .supports = 5.0 * cases[k].supports,
                             .near = 5.0 * cases[k].near,
                             .few = 2.0 * fabs(cases[k].error) * cases[k].few};
    ck_assert_int_eq(goal_evaluate(&e).verdict, cases[k].verdict);
  }
}

/* By a zone of few nodes three times the estimate may be missing. */
TEST(few_nodes_have_a_wider_band) {
  goal_estimate e = {.error = -0.5, .magnitude = 2.0, .product = 5.0};
  const double band = goal_evaluate(&e).band;
  e.few = 0.5;
  ck_assert_double_eq(goal_evaluate(&e).band, band + 1.5);
}

/* Round hollows twice what recovered stresses tell more, or the sum of its
 * magnitudes. */
TEST(hollows_have_a_wider_band) {
  goal_estimate e = {.error = -0.5, .magnitude = 2.0, .product = 5.0};
  const double band = goal_evaluate(&e).band;
  e.twice = -0.125;
  e.hollow = 0.75;
  ck_assert_double_eq(goal_evaluate(&e).band, band + 0.75);
  ck_assert_int_eq(goal_evaluate(&e).verdict, GOAL_FEW_ELEMENTS);
  e.twice = -0.5;
  ck_assert_double_eq(goal_evaluate(&e).band, band + 1.0);
}

/* A zone that began with few nodes has still what they lacked. */
TEST(sums_keep_the_doubts_of_their_parts) {
  const goal_estimate few = {.error = 0.5, .magnitude = 0.5, .few = 0.5};
  goal_estimate sum = {.error = 0.5, .magnitude = 1.0, .product = 5.0};
  ck_assert_int_eq(goal_evaluate(&sum).verdict, GOAL_RELIABLE);
  goal_estimate_add(&few, &sum);
  const goal_result r = goal_evaluate(&sum);
  ck_assert_int_eq(r.verdict, GOAL_FEW_NODES);
  ck_assert_double_eq(r.error, 1.0);
  ck_assert_double_eq_tol(r.band, 0.1 * 1.5 + 1.5, 1e-15);
}

/* Elements without error, as in uniform stress under a curved gap. */
TEST(ends_of_rounding_are_no_ends) {
  const goal_estimate e = {
      .error = 2.0, .magnitude = 2.0, .product = 1e-15, .ends = 1e-15};
  const goal_result r = goal_evaluate(&e);
  ck_assert_int_eq(r.verdict, GOAL_RELIABLE);
  ck_assert_double_eq(r.ends, 0.0);
}

/* A parabola is its own; what has no integral beside it is rough, here by 1.5
 * times the mean 2/pi of |sin|, but for a rule of 16 pieces. */
TEST(parabolas_have_the_integral) {
  for (int k = 0; k < 2; ++k) {
    double d[GOAL_PIECES + 1], rough;
    for (int i = 0; i <= GOAL_PIECES; ++i) {
      const double t = (double)i / GOAL_PIECES;
      d[i] = 12.0 * t * (1.0 - t) + k * sin(2.0 * M_PI * t);
    }
    ck_assert_double_eq_tol(goal_parabola(d, &rough), 3.0, 1e-14);
    ck_assert_double_eq_tol(rough, k * 3.0 / M_PI, 0.02);
  }
}

/* Points of an edge lie on the circle through its ends and its middle. */
TEST(points_of_an_edge_lie_on_its_arc) {
  static const double angle = 1.2, turn = 0.3;
  double ends[2][2], out[2];
  for (int c = 0; c < 2; ++c) {
    for (int k = 0; k < 2; ++k)
      ends[k][c] = cos(turn + (2 * k - 1) * 0.5 * angle - c * 0.5 * M_PI);
    out[c] = (1.0 - cos(0.5 * angle)) * cos(turn - c * 0.5 * M_PI);
  }
  for (int k = 0; k <= GOAL_PIECES; ++k) {
    double x[3];
    goal_point_of(2, ends[0], ends[1], out, k, x);
    ck_assert_double_eq_tol(hypot(x[0], x[1]), 1.0, 1e-14);
  }
}

UNIT_MAIN("goal")
