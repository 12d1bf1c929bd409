/* src/solver: every row of the table on the same problems. */
#include "base/memory.h"
#include "solver/solver.h"
#include "support/contact_case.h"
#include "support/unit.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { PARAM_SIZE = 512 };

/* Solve by one row (NULL: AUTO) with its default options. */
static solver_report solve_by(const solver_ops *ops, const contact_case *c,
                              double tol, double *u, double *r) {
  double param[PARAM_SIZE / sizeof(double)] = {0.0};
  solver_choice choice = {.ops = ops, .param = param, .tol = tol};
  contact_solver *s = NULL;
  solver_report rep;
  ck_assert(ops == NULL || ops->param_size <= sizeof param);
  ck_assert_int_eq(contact_solver_new(&choice, &s), OK);
  ck_assert_int_eq(contact_solve(s, &c->cp, NULL, u, r, &rep), OK);
  contact_solver_free(s);
  return rep;
}

static int handles(const solver_ops *ops, const contact_problem *cp) {
  return cp->dim == 2 || (ops->handles & SOLVES_3D) != 0;
}

/* Row i of the table, AUTO after the last. 0: no more. */
static int solver_row(int i, const solver_ops **ops) {
  int n = 0;
  while (solver_list[n] != NULL) ++n;
  *ops = i < n ? solver_list[i] : NULL;
  return i <= n;
}

static const char *row_name(const solver_ops *ops) {
  return ops == NULL ? "auto" : ops->name;
}

START_TEST(table_is_complete) {
  for (int i = 0; solver_list[i] != NULL; ++i) {
    const solver_ops *s = solver_list[i];
    ck_assert_ptr_eq(solver_find(s->name), s);
    ck_assert(strlen(s->reference) > 5 && strlen(s->help) > 200);
    ck_assert(s->setup != NULL && s->solve != NULL && s->release != NULL);
    ck_assert(s->handles & SOLVES_TRESCA);
    s->release(NULL);
  }
  ck_assert_ptr_null(solver_find("nosuch"));
}
END_TEST

/* Every answer must satisfy the conditions; for mu small enough for one
 * solution all rows must agree, beyond nearly always (two answers that both
 * satisfy them are two solutions). */
START_TEST(all_rows_agree_on_random_problems) {
  static const double mus[] = {0.0, 0.1, 0.5, 1.0, 2.0};
  int solved[16] = {0}, tried = 0, others = 0;
  for (int k = 0; k < 600; ++k) {
    int dim = 2 + k % 2, n = 1 + (k * 7) % 60, kind = k / 2 % 2;
    double mu = mus[k / 4 % 5];
    contact_case c = case_any(dim, n, mu, kind, (unsigned long long)k);
    double *first = calloc((size_t)c.cp.m, sizeof *first);
    const solver_ops *ops;
    int have = 0;
    ++tried;
    for (int i = 0; solver_row(i, &ops); ++i) {
      if (ops != NULL && !handles(ops, &c.cp)) continue;
      memset(c.u, 0, (size_t)c.cp.m * sizeof *c.u);
      memset(c.r, 0, (size_t)c.cp.m * sizeof *c.r);
      solver_report rep = solve_by(ops, &c, 1e-11, c.u, c.r);
      if (ops == NULL || mu <= 0.5)
        ck_assert_msg(rep.outcome == CONVERGED, "%s: problem %d: %s",
                      row_name(ops), k, outcome_text(rep.outcome));
      if (rep.outcome != CONVERGED) continue;
      ++solved[i];
      double bad = case_violation(&c, c.u, c.r);
      ck_assert_msg(bad < 1e-9, "%s: problem %d: violation %g", row_name(ops),
                    k, bad);
      double size = 0.0, apart = 0.0;
      for (int j = 0; j < c.cp.m; ++j) {
        size = fmax(size, fabs(c.u[j]));
        apart = fmax(apart, fabs(c.u[j] - first[j]));
      }
      if (!have) {
        memcpy(first, c.u, (size_t)c.cp.m * sizeof *first);
        apart = 0.0;
      }
      if (mu == 1.0) others += apart > 1e-8 * size;
      if (have && mu <= 0.5)
        ck_assert_msg(apart <= 1e-8 * size, "%s: problem %d: apart by %g",
                      row_name(ops), k, apart / size);
      have = 1;
    }
    free(first);
    case_free(&c);
  }
  ck_assert_int_le(others, tried / 100);
  const solver_ops *ops;
  for (int i = 0; solver_row(i, &ops); ++i)
    if (ops == NULL || (ops->handles & SOLVES_3D))
      ck_assert_msg(solved[i] >= 0.97 * tried, "%s: %d of %d", row_name(ops),
                    solved[i], tried);
}
END_TEST

UNIT_MAIN("solver", table_is_complete, all_rows_agree_on_random_problems)
