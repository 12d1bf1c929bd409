/* The rows of the solver table for tests that loop over them. */
#include "support/solver_rows.h"

#include "support/unit.h"

int solver_row(int i, const solver_ops **ops) {
  int n = 0;
  while (solver_list[n] != NULL) ++n;
  *ops = i < n ? solver_list[i] : NULL;
  return i <= n;
}

const char *row_name(const solver_ops *ops) {
  return ops == NULL ? "auto" : ops->name;
}

int row_handles(const solver_ops *ops, const contact_problem *cp) {
  if (ops == NULL) return 1;
  return cp->dim == 2 || (ops->handles & SOLVES_3D) != 0;
}

solver_report solve_by(const solver_ops *ops, const contact_case *c, double tol,
                       double *u, double *r) {
  double param[PARAM_SIZE / sizeof(double)] = {0.0};
  solver_choice choice = {.ops = ops, .param = param, .tol = tol};
  contact_solver *s = NULL;
  solver_report rep;
  ck_assert(ops == NULL || ops->param_size <= sizeof param);
  ck_assert_int_eq(contact_solver_new(&choice, &s), OK);
  ck_assert_int_eq(contact_solve(s, &c->cp, NULL, u, r, &rep), OK);
  contact_solver_free(&s);
  return rep;
}

void set_option(const solver_ops *ops, void *param, const char *name,
                const char *text) {
  char why[200];
  const option *row = option_find(ops->options, name);
  ck_assert_ptr_nonnull(row);
  ck_assert_msg(option_read(row, text, param, why, sizeof why) == 0, "%s", why);
}

void case_cold(contact_case *c) {
  memset(c->u, 0, (size_t)c->cp.m * sizeof *c->u);
  memset(c->r, 0, (size_t)c->cp.m * sizeof *c->r);
}

void all_rows_solve(contact_case *c, const char *what, double bad) {
  EACH_SOLVER(i, ops) {
    if (!row_handles(ops, &c->cp)) continue;
    case_cold(c);
    solver_report rep = solve_by(ops, c, 1e-11, c->u, c->r);
    ck_assert_msg(rep.outcome == CONVERGED, "%s: %s: %s", what, row_name(ops),
                  outcome_text(rep.outcome));
    double v = case_violation(c, c->u, c->r);
    ck_assert_msg(v <= bad, "%s: %s: violation %g", what, row_name(ops), v);
  }
}
