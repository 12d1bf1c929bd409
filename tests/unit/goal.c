/*
 * src/accuracy/goal/adjoint.c: the adjoint of a contact problem against
 * solutions under changed loads, and its error against disturbed solutions.
 */
#include "accuracy/goal/goal.h"
#include "support/solver_rows.h"
#include "support/unit.h"

#include <math.h>
#include <string.h>

enum { NODES = 12, MOST = 3 * NODES };
static const double TOL = 1e-14;

/* J = j'u + psi'r at a solution, and its adjoint. */
typedef struct goal_case {
  contact_case c;
  double j[MOST], psi[MOST], y[MOST], solver;
} goal_case;

static double value(const goal_case *g, const double *u, const double *r) {
  double sum = 0.0;
  for (int k = 0; k < g->c.cp.m; ++k) sum += g->j[k] * u[k] + g->psi[k] * r[k];
  return sum;
}

static void find_adjoint(goal_case *g, const double *u, const double *r) {
  contact_adjoint *a = NULL;
  ck_assert_int_eq(contact_adjoint_new(&g->c.cp, u, r, &a), OK);
  ck_assert_ptr_nonnull(a);
  contact_adjoint_solve(a, g->j, g->psi, g->y, &g->solver);
  contact_adjoint_free(a);
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
START_TEST(adjoint_is_the_derivative_by_the_load) {
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
END_TEST

/* Displacements and forces that miss equations and conditions a little. */
START_TEST(error_of_the_solver_is_that_of_a_disturbed_solution) {
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
END_TEST

int main(void) {
  TCase *tests = tcase_create("goal");
  tcase_set_timeout(tests, UNIT_SECONDS);
  tcase_add_loop_test(tests, adjoint_is_the_derivative_by_the_load, 0, 6);
  tcase_add_loop_test(
      tests, error_of_the_solver_is_that_of_a_disturbed_solution, 0, 6);
  return unit_run("goal", tests);
}
