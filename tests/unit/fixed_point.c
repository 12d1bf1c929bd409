/* src/solver/fixed_point.c: the loops on the sliding limit. */
#include "solver/fixed_point.h"
#include "support/solver_rows.h"
#include "support/unit.h"

/* The contraction of the fixed point on the limit is mu/mu_crit while the node
 * slips against its coupling; mu_crit = (2 (1-nu) gt^2 + (1-2 nu) gn^2)/|gt
 * gn|, 1.8 for this triangle. */
TEST(fixed_point_contracts_by_mu_over_its_critical_value) {
  for (int k = 1; k < 8; ++k) {
    double param[PARAM_SIZE / sizeof(double)] = {0.0}, mu = 0.2 * k;
    CONTACT_CASE c = case_triangle(.3, mu, -1, .3);
    const solver_ops *sor = solver_find("sor");
    set_option(sor, param, "FRICTION", "FIXED_POINT");
    solver_choice choice = {.ops = sor, .param = param, .tol = 1e-11};
    ENDS_BY(contact_solver_free) contact_solver *s = NULL;
    solver_report rep;
    ck_assert_int_eq(contact_solver_new(&choice, &s), OK);
    ck_assert_int_eq(contact_solve(s, &c.cp, NULL, c.u, c.r, &rep), OK);
    ck_assert_int_eq(rep.outcome, CONVERGED);
    ck_assert_int_gt(rep.limit_updates, 2);
    ck_assert_double_eq_tol(rep.rate, mu / 1.8, 1e-6);
  }
}

TEST(auto_solves_the_block_for_any_friction) {
  static const double mus[] = {2, 5, 20, 100, 1e4, 1e6};
  for (int k = 0; k < 6; ++k) {
    CONTACT_CASE c = case_published(32 + 16 * k, mus[k]);
    solver_report rep = solve_by(NULL, &c, 1e-12, c.u, c.r);
    ck_assert_msg(rep.outcome == CONVERGED, "mu = %g: %s", mus[k],
                  outcome_text(rep.outcome));
    ck_assert_double_lt(case_violation(&c, c.u, c.r), 1e-10);
  }
}

TEST(fallback_is_logged) {
  CONTACT_CASE c = case_published(unit_whole() ? 256 : 128, 100.0);
  solver_choice choice = {.tol = 1e-10};
  ENDS_BY(contact_solver_free) contact_solver *s = NULL;
  solver_report rep;
  ck_assert_int_eq(contact_solver_new(&choice, &s), OK);
  ck_assert_int_eq(contact_solve(s, &c.cp, NULL, c.u, c.r, &rep), OK);
  ck_assert_int_eq(rep.outcome, CONVERGED);
  ck_assert_ptr_nonnull(strstr(contact_solver_log(s), "newton: "));
  ck_assert_ptr_nonnull(strstr(contact_solver_log(s), "converged"));
}

/* A solver of Tresca problems that stops at a residual of 4e-11 after many
 * iterations if more is asked; the answer is that of NEWTON. */
static status rough_solve(const contact_problem *cp, const void *par,
                          void *work, const solver_control *control, double *u,
                          double *r, solver_report *rep) {
  solver_control fine = *control;
  fine.tol = 1e-13;
  status st = newton_solver.solve(cp, par, work, &fine, u, r, rep);
  if (control->tol >= 4e-11) return st;
  rep->outcome = STOPPED_STAGNATION;
  rep->iterations = 1000;
  rep->residual = 4e-11;
  return st;
}

TEST(rounding_of_the_inner_solver_is_met_once) {
  solver_ops rough = newton_solver;
  rough.solve = rough_solve;
  CONTACT_CASE c = case_any(2, 12, 0.5, 0, 12);
  double param[PARAM_SIZE / sizeof(double)] = {0.0};
  OWNED void *work = NULL;
  OWNED fixed_point *fp = NULL;
  solver_control control = {.tol = 1e-10};
  solver_report rep;
  option_defaults(newton_solver.options, param);
  ck_assert_int_eq(solver_set_up(&newton_solver, &c.cp, param, &work), OK);
  ck_assert_int_eq(fixed_point_new(c.cp.n, &fp), OK);
  inner_solver inner = {&rough, param, work};
  ck_assert_int_eq(
      fixed_point_solve(fp, &c.cp, &inner, &control, c.u, c.r, &rep), OK);
  ck_assert_int_eq(rep.outcome, CONVERGED);
  ck_assert_int_gt(rep.iterations, 1000);
  ck_assert_int_lt(rep.iterations, 2000);
}

UNIT_MAIN("fixed_point")
