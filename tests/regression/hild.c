/*
 * The triangle of input/hild_triangle against its closed forms: the slipping
 * state on several meshes, friction and Poisson's ratios, the solutions beyond
 * the critical friction mu_c = sqrt((1 - nu)/nu), and the continuum at it.
 */
#include "support/job.h"
#include "support/unit.h"

const int job_without_fields = 1;

static const double P0 = 0.01, A = 0.002, C = -0.02;

static job run_hild(double mu, double mu0, double nu, int n, int *code) {
  job j = job_begin("hild");
  PRINTED(words, "-D MU=%.17g -D MU0=%.17g -D NU=%.17g -D N=%d --quiet", mu,
          mu0, nu, n);
  *code = job_run_deck(&j, "input/hild_triangle/hild_triangle", words);
  return j;
}

/* beta of u = u0 + beta (x - 1 + k y, 0). */
static double slip_amount(double mu, double mu0, double nu) {
  double lambda = nu / ((1 + nu) * (1 - 2 * nu));
  return P0 * (mu - mu0) / (lambda * (mu - sqrt((1 - nu) / nu)));
}

static void compare_slip(const job *j, double mu, double mu0, double nu) {
  DAT c = job_table(j, "CONTACT", -1);
  double beta = slip_amount(mu, mu0, nu);
  double lambda = nu / ((1 + nu) * (1 - 2 * nu));
  for (int i = 0; i < c.n_row; ++i) {
    double x = dat_at(&c, i, "x"), p = P0 - lambda * beta;
    ck_assert_double_eq_tol(dat_at(&c, i, "u_t"), A * x + C + beta * (x - 1),
                            1e-12);
    ck_assert_double_eq_tol(dat_at(&c, i, "pressure"), p, 1e-10 * P0);
    ck_assert_double_eq_tol(dat_at(&c, i, "traction_t"), mu * p, 1e-10 * P0);
    ck_assert_double_eq(dat_at(&c, i, "status"), 1.0);
  }
}

TEST(closed_form_agrees_with_the_published_numbers) {
  static const double mu[] = {0.5, 1, 2, 2.59},
                      u[] = {-0.0904, -0.086, -0.064, -0.000682927},
                      N[] = {0.002, 0.0025, 0.005, 0.01219512};
  for (int k = 0; k < 4; ++k) {
    double beta = slip_amount(mu[k], 2.5, 0.1);
    ck_assert_double_eq_tol(C - beta, u[k], 1e-9);
    ck_assert_double_eq_tol(P0 - beta * 0.1 / 0.88, N[k], 1e-8);
  }
}

TEST(slipping_triangle_is_exact_on_every_mesh) {
  static const struct {
    double nu, mu, mu0;
  } scene[] = {{0.1, 0.5, 2.5},  {0.1, 1, 2.5},   {0.1, 2, 2.5},
               {0.1, 2.59, 2.5}, {0.2, 1.5, 1.8}, {0.25, 1.2, 1.5},
               {0.3, 1.0, 1.2}};
  for (size_t s = 0; s < sizeof scene / sizeof *scene; ++s)
    for (int n = 1; n <= 4; n += 3) {
      int code;
      JOB j = run_hild(scene[s].mu, scene[s].mu0, scene[s].nu, n, &code);
      ck_assert_msg(code == 0, "exit %d: %s", code, j.errors);
      compare_slip(&j, scene[s].mu, scene[s].mu0, scene[s].nu);
    }
}

/* Lowest and highest u_t of the solutions in JOB.json; their count. */
static int listed_solutions(const job *j, double *low, double *high) {
  FREED char *json = job_file(j, "json");
  const char *at = strstr(json, "\"solutions\": [");
  int n = 0;
  ck_assert_ptr_nonnull(at);
  while ((at = strstr(at, "\"u_t_lowest\": ")) != NULL) {
    low[n] = atof(at + strlen("\"u_t_lowest\": "));
    at = strstr(at, "\"u_t_highest\": ");
    high[n++] = atof(at + strlen("\"u_t_highest\": "));
  }
  return n;
}

/* Last contact node of n equal segments. */
static double last_x(int n) { return (n - 1.0) / n; }

TEST(beyond_the_critical_friction_there_are_several) {
  for (int n = 1; n <= 4; n += 3) {
    double low[8], high[8], beta = slip_amount(3.5, 3.55, 0.1);
    int code, found = 0;
    JOB j = run_hild(3.5, 3.55, 0.1, n, &code);
    ck_assert_int_eq(code, 0);
    int count = listed_solutions(&j, low, high);
    ck_assert_int_eq(count, 3);
    for (int i = 0; i < count; ++i) {
      double at_a = C - beta, x = last_x(n), last = A * x + C + beta * (x - 1);
      found += fabs(low[i] - fmin(at_a, last)) < 1e-10 &&
               fabs(high[i] - fmax(at_a, last)) < 1e-10;
    }
    ck_assert_int_eq(found, 1);
  }
}

/* alpha = 0.8 beta runs from -0.025 (A comes to rest) to 0.11 (no pressure):
 * u_t(A) = C - 0.8 alpha. */
TEST(at_the_critical_friction_there_is_a_continuum) {
  for (int n = 1; n <= 4; n += 3) {
    double low[8], high[8];
    int code;
    JOB j = run_hild(3, 3, 0.1, n, &code);
    ck_assert_int_eq(code, 0);
    int count = listed_solutions(&j, low, high), rest = 0, open = 0;
    for (int i = 0; i < count; ++i) {
      rest += fabs(high[i]) < 1e-9;
      open += fabs(low[i] - (C - 0.8 * 0.11)) < 1e-9;
    }
    ck_assert_int_eq(rest, 1);
    ck_assert_int_eq(open, 1);
    FREED char *lst = job_file(&j, "lst");
    ck_assert_ptr_nonnull(strstr(lst, "a continuum"));
  }
}

/* Too many nodes for all combinations: said before anything is written. */
TEST(too_many_nodes_are_refused) {
  int code;
  JOB j = run_hild(1, 2.5, 0.1, 16, &code);
  ck_assert_int_eq(code, 2);
  ck_assert_ptr_nonnull(strstr(j.errors, "CHECK=ALL: "));
  ck_assert_ptr_nonnull(strstr(j.errors, "the problem has 16 in 2-D"));
  ck_assert_ptr_nonnull(strstr(j.errors, "use CHECK=YES"));
}

UNIT_MAIN("hild")
