/*
 * Examples of input/ whose bodies creep, over time: against closed forms, and
 * against ordinary differential equations solved by SciPy to 1e-8 or better.
 */
#include "base/base.h"
#include "support/job.h"
#include "support/unit.h"

static job run_example(const char *name, const char *words) {
  char deck[96];
  job j = job_begin(name);
  snprintf(deck, sizeof deck, "input/%s/%s", name, name);
  int code = job_run_deck(&j, deck, words);
  ck_assert_msg(code == 0, "%s: exit %d: %s", name, code, j.errors);
  return j;
}

/* First row of table number k. */
static double first_of(const job *j, const char *table, int k,
                       const char *column) {
  dat d = job_table(j, table, k);
  double value = dat_at(&d, 0, column);
  dat_free(&d);
  return value;
}

/* Half-width of the contact, a^2 = 4 P R (1 + t/tau)/(pi E*), 40 increments of
 * 0.25 after the press. */
START_TEST(lee_radok_grows_like_the_compliance) {
  static const struct {
    int table;
    double a;
  } at[] = {
      {1, 0.1141700}, {4, 0.1318321652}, {8, 0.1522266722}, {40, 0.2636643304}};
  job j = run_example("lee_radok", "");
  for (size_t i = 0; i < sizeof at / sizeof *at; ++i)
    ck_assert_double_eq_tol(first_of(&j, "ZONES", at[i].table, "x_to"), at[i].a,
                            0.01 * at[i].a);
  job_end(&j);
}
END_TEST

/* Steady stresses of a power law at every radius; their scale is p. */
static void steady_tube(const char *words, double n) {
  job j = run_example("norton_ring", words);
  dat d = job_table(&j, "ELEMENTS", -1);
  const double p = 100, down = pow(2, 2 / n) - 1;
  for (int i = 0; i < d.n_row; ++i) {
    double power = pow(2 / dat_at(&d, i, "r"), 2 / n);
    double rr = -p * (power - 1) / down;
    double tt = p * (1 - (1 - 2 / n) * power) / down;
    ck_assert_double_eq_tol(dat_at(&d, i, "stress_rr"), rr, 0.01 * p);
    ck_assert_double_eq_tol(dat_at(&d, i, "stress_tt"), tt, 0.01 * p);
    ck_assert_double_eq_tol(dat_at(&d, i, "stress_zz"), 0.5 * (rr + tt),
                            0.01 * p);
  }
  ck_assert_int_gt(d.n_row, 79);
  dat_free(&d);
  job_end(&j);
}

START_TEST(norton_ring_reaches_the_steady_state) {
  steady_tube("", 5);
  steady_tube("-D EXPONENT=3 -D A=1E-11", 3);
}
END_TEST

/* 80 increments a cycle: peaks of the first and the tenth, and ends. */
START_TEST(chaboche_cycles) {
  static const struct {
    int table;
    double stress, p;
  } at[] = {{19, 158.206082382848, 0.00341793917617152},
            {59, -173.5536836491167, 0.010170287760614367},
            {79, 95.7920336668121, 0.012547822224613},
            {339, 177.70981177721313, 0.05612988793031968},
            {779, -179.04055116891456, 0.12758889382413002},
            {799, 107.33080676002308, 0.12979617764350623}};
  double high = 0, low = 0;
  job j = run_example("chaboche_cycle", "");
  for (size_t i = 0; i < sizeof at / sizeof *at; ++i) {
    ck_assert_double_eq_tol(first_of(&j, "ELEMENTS", at[i].table, "stress_yy"),
                            at[i].stress, 1e-3 * 180);
    ck_assert_double_eq_tol(first_of(&j, "ELEMENTS", at[i].table, "alpha_1"),
                            at[i].p, 1e-3 * at[i].p);
  }
  for (int k = 720; k < 800; ++k) {
    double stress = first_of(&j, "ELEMENTS", k, "stress_yy");
    high = fmax(high, stress), low = fmin(low, stress);
  }
  ck_assert_double_eq_tol(high, 184.34035916957623, 1e-3 * 180);
  ck_assert_double_eq_tol(low, -184.4860144136457, 1e-3 * 180);
  job_end(&j);
}
END_TEST

enum { PERIOD = 64, PERIODS = 20 };

/* Largest change of the pressure from a period to the next. */
static double change(const double *f, int period) {
  double largest = 0;
  for (int i = 1; i <= PERIOD; ++i)
    largest = fmax(largest,
                   fabs(f[period * PERIOD + i] - f[(period - 1) * PERIOD + i]));
  return largest;
}

/* What differs from the cycle falls by exp(-x) in a period, x the integral of
 * 1/tau over the time of contact, 0.52828 of it: 0.3665. The cycle counts as
 * reached at 1e-6 of the largest pressure; it is that of SciPy. */
START_TEST(periodic_bar_reaches_its_limit_cycle) {
  double f[PERIODS * PERIOD + 1] = {0}, largest = 0;
  int reached = 0, open = 0;
  job j = run_example("periodic_viscous", "");
  for (int k = 1; k <= PERIODS * PERIOD; ++k) {
    f[k] = first_of(&j, "TOTALS", k - 1, "normal");
    if (k <= (PERIODS - 1) * PERIOD) continue;
    largest = fmax(largest, f[k]);
    open += f[k] == 0;
  }
  for (int n = 1; n < PERIODS && reached == 0; ++n)
    if (change(f, n) <= 1e-6 * largest) reached = n;
  ck_assert_int_ge(reached, 13);
  ck_assert_int_le(reached, 16);
  ck_assert_double_eq_tol(change(f, 9) / change(f, 8), 0.3665, 0.02 * 0.3665);
  ck_assert_double_eq_tol(largest, 3.2950371, 1e-3 * 3.3);
  ck_assert_double_eq_tol(f[19 * PERIOD + PERIOD / 2], 0.7856917309,
                          1e-3 * 3.3);
  ck_assert_double_eq_tol(f[19 * PERIOD + 3 * PERIOD / 4], 3.2171948813,
                          1e-3 * 3.3);
  ck_assert_double_eq_tol(open / (double)PERIOD, 0.47172, 1.0 / PERIOD);
  job_end(&j);
}
END_TEST

/* Stress left in the middle of the strip over its height, profile.txt. */
START_TEST(tempered_strip_keeps_its_stresses) {
  double y[64], stress[64], scale = 0;
  int n = 0;
  char text[96];
  FILE *file = fopen("input/tempered_strip/profile.txt", "r");
  ck_assert_ptr_nonnull(file);
  while (n < 64 && fgets(text, sizeof text, file) != NULL)
    if (text[0] != '#' && sscanf(text, "%lf %lf", &y[n], &stress[n]) == 2) ++n;
  fclose(file);
  ck_assert_int_eq(n, 41);
  for (int i = 0; i < n; ++i) scale = fmax(scale, fabs(stress[i]));
  job j = run_example("tempered_strip", "");
  dat d = job_table(&j, "ELEMENTS", -1);
  for (int i = 0; i < d.n_row; ++i) {
    double at = dat_at(&d, i, "y") * (n - 1);
    int k = (int)at;
    double expected = stress[k] + (at - k) * (stress[k + 1] - stress[k]);
    ck_assert_double_eq_tol(dat_at(&d, i, "stress_xx"), expected, 0.01 * scale);
  }
  ck_assert_int_ge(d.n_row, 40);
  dat_free(&d);
  job_end(&j);
}
END_TEST

UNIT_MAIN("creep_examples", lee_radok_grows_like_the_compliance,
          norton_ring_reaches_the_steady_state, chaboche_cycles,
          periodic_bar_reaches_its_limit_cycle,
          tempered_strip_keeps_its_stresses)
