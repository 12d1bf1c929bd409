/*
 * Increments chosen by *VISCO, TOLERANCE=: the error follows the tolerance for
 * each integrator, a rejected increment leaves nothing behind, a smallest
 * increment that is too long is told by the exit code.
 */
#include "support/square_case.h"
#include "support/unit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static job run_deck(const char *contact, const char *load, const char *visco,
                    int expected) {
  const square_case s = {STEEL, DEVIATORIC, "CPS3", contact, load, visco};
  return square_run(&s, expected);
}

typedef struct row {
  const char *integrator;
  int order;
} row;

static const row rows[] = {{"EULER", 1},    {"HEUN", 2},
                           {"RK4", 4},      {"MIDPOINT", 2},
                           {"BACKWARD", 1}, {"EXPONENTIAL", 2}};

/* Held strain, free sides: the stress after one relaxation time, 2 s. */
START_TEST(error_follows_the_tolerance) {
  static const double tolerance[] = {1e-2, 1e-3, 1e-4};
  for (int k = 0; k < 3; ++k) {
    char visco[160];
    snprintf(visco, sizeof visco,
             "*VISCO, INTEGRATOR=%s, TOLERANCE=%g\n2., 2.\n",
             rows[_i].integrator, tolerance[k]);
    job j = run_deck("", HELD, visco, 0);
    dat d = job_table(&j, "ELEMENTS", -1);
    double error = fabs(dat_at(&d, 0, "stress_yy") - .4203503845);
    /* An increment of length h errs by h^(order + 1), all of them together
     * by h^order. */
    double power = rows[_i].order / (rows[_i].order + 1.0);
    ck_assert_double_le(error, 0.3 * pow(tolerance[k], power));
    dat_free(&d);
    job_end(&j);
  }
}
END_TEST

/* First attempt and length of the first accepted increment of step 2. */
static double first_length(const job *j, int *attempt) {
  char *sta = job_file(j, "sta"), *line = sta;
  double dt = 0.0;
  while ((line = strchr(line, '\n')) != NULL && *++line != '\0') {
    int step, increment, tries;
    double t, length;
    if (sscanf(line, "%d %d %d %lf %lf", &step, &increment, &tries, &t,
               &length) == 5 &&
        step == 2 && strstr(line, "TOLERANCE") == NULL) {
      dt = length;
      *attempt = tries;
      break;
    }
  }
  free(sta);
  return dt;
}

/* A run whose first increments are refused gives the bytes of one that starts
 * with the length that was accepted. */
START_TEST(rejected_increments_leave_nothing_behind) {
  char visco[160];
  int attempt = 1, again = 0;
  job a = run_deck(FLOOR(0.2), PRESS(10.),
                   "*VISCO, INTEGRATOR=BACKWARD, TOLERANCE=1E-3\n1., 1.\n", 0);
  double dt = first_length(&a, &attempt);
  int halvings = (int)lround(-log2(dt));
  ck_assert_int_ge(attempt, 2);
  ck_assert_double_eq_tol(dt, ldexp(1.0, -halvings), 1e-4 * dt);
  snprintf(visco, sizeof visco,
           "*VISCO, INTEGRATOR=BACKWARD, TOLERANCE=1E-3\n%.17g, 1., %.17g\n",
           ldexp(1.0, -halvings), 1e-6);
  job b = run_deck(FLOOR(0.2), PRESS(10.), visco, 0);
  first_length(&b, &again);
  ck_assert_int_eq(again, 1);
  char *first = job_file(&a, "dat"), *second = job_file(&b, "dat");
  ck_assert_uint_gt(strlen(first), 5000);
  ck_assert_str_eq(first, second);
  free(first);
  free(second);
  job_end(&a);
  job_end(&b);
}
END_TEST

START_TEST(missed_tolerance_is_told) {
  job j = run_deck(
      FLOOR(0.2), PRESS(10.),
      "*VISCO, INTEGRATOR=BACKWARD, TOLERANCE=1E-9\n0.5, 1., 0.25\n", 1);
  dat e = job_table(&j, "ENERGY", -1);
  ck_assert_double_eq_tol(dat_at(&e, 0, "time"), 2.0, 1e-12);
  dat_free(&e);
  job_end(&j);
}
END_TEST

/* Explicit integrators are kept below their limit, tau = 2, at any tolerance.
 */
START_TEST(increments_stay_stable) {
  job j = run_deck("", HELD,
                   "*VISCO, INTEGRATOR=HEUN, TOLERANCE=1.\n50., 100.\n", 0);
  dat d = job_table(&j, "ELEMENTS", -1);
  ck_assert_double_le(dat_max(&d, "stress_yy"), 1e-6);
  dat_free(&d);
  job_end(&j);
}
END_TEST

int main(void) {
  Suite *suite = suite_create("adaptive");
  TCase *tests = tcase_create("adaptive");
  tcase_set_timeout(tests, UNIT_SECONDS);
  tcase_add_loop_test(tests, error_follows_the_tolerance, 0,
                      (int)(sizeof rows / sizeof *rows));
  tcase_add_test(tests, rejected_increments_leave_nothing_behind);
  tcase_add_test(tests, missed_tolerance_is_told);
  tcase_add_test(tests, increments_stay_stable);
  suite_add_tcase(suite, tests);
  SRunner *runner = srunner_create(suite);
  srunner_run_all(runner, CK_NORMAL);
  const int failed = srunner_ntests_failed(runner);
  srunner_free(runner);
  return failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
