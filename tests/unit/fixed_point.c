/* src/solver/fixed_point.c: the loops on the sliding limit. */
#include "support/solver_rows.h"
#include "support/unit.h"

#include <math.h>
#include <string.h>

/* The contraction of the fixed point on the limit is mu/mu_crit while the node
 * slips against its coupling; mu_crit = (2 (1-nu) gt^2 + (1-2 nu) gn^2)/|gt
 * gn|, 1.8 for this triangle. */
START_TEST(fixed_point_contracts_by_mu_over_its_critical_value) {
  for (int k = 1; k < 8; ++k) {
    double param[PARAM_SIZE / sizeof(double)] = {0.0}, mu = 0.2 * k;
    contact_case c = case_triangle(.3, mu, -1, .3);
    const solver_ops *sor = solver_find("sor");
    set_option(sor, param, "FRICTION", "FIXED_POINT");
    solver_choice choice = {.ops = sor, .param = param, .tol = 1e-11};
    contact_solver *s = NULL;
    solver_report rep;
    ck_assert_int_eq(contact_solver_new(&choice, &s), OK);
    ck_assert_int_eq(contact_solve(s, &c.cp, NULL, c.u, c.r, &rep), OK);
    ck_assert_int_eq(rep.outcome, CONVERGED);
    ck_assert_int_gt(rep.limit_updates, 2);
    ck_assert_double_eq_tol(rep.rate, mu / 1.8, 1e-6);
    contact_solver_free(s);
    case_free(&c);
  }
}
END_TEST

START_TEST(auto_solves_the_block_for_any_friction) {
  static const double mus[] = {2, 5, 20, 100, 1e4, 1e6};
  for (int k = 0; k < 6; ++k) {
    contact_case c = case_published(32 + 16 * k, mus[k]);
    solver_report rep = solve_by(NULL, &c, 1e-12, c.u, c.r);
    ck_assert_msg(rep.outcome == CONVERGED, "mu = %g: %s", mus[k],
                  outcome_text(rep.outcome));
    ck_assert_double_lt(case_violation(&c, c.u, c.r), 1e-10);
    case_free(&c);
  }
}
END_TEST

START_TEST(fallback_is_logged) {
  contact_case c = case_published(256, 20.0);
  solver_choice choice = {.tol = 1e-10};
  contact_solver *s = NULL;
  solver_report rep;
  ck_assert_int_eq(contact_solver_new(&choice, &s), OK);
  ck_assert_int_eq(contact_solve(s, &c.cp, NULL, c.u, c.r, &rep), OK);
  ck_assert_int_eq(rep.outcome, CONVERGED);
  ck_assert_ptr_nonnull(strstr(contact_solver_log(s), "newton: "));
  ck_assert_ptr_nonnull(strstr(contact_solver_log(s), "converged"));
  contact_solver_free(s);
  case_free(&c);
}
END_TEST

UNIT_MAIN("fixed_point", fixed_point_contracts_by_mu_over_its_critical_value,
          auto_solves_the_block_for_any_friction, fallback_is_logged)
