/*
 * Contact with stick and slip side by side, against closed forms for other
 * Poisson's ratios and friction coefficients than the examples: indentation
 * (Spence), shear (Cattaneo, Mindlin), torsion (Lubkin), sliding (Johnson 8.3).
 */
#include "support/job.h"
#include "support/unit.h"

const int job_without_fields = 1;

static const double young = 210e3, radius = 10;

/* Half-width of Hertz under P, plane. */
static double hertz_line(double P, double nu) {
  return sqrt(4 * P * radius * (1 - nu * nu) / (acos(-1.0) * young));
}

/* Self-similar indentation: c/a and P/P_Hertz(a) of the full coupling. */
TEST(stick_grows_with_the_indentation) {
  static const struct {
    double nu, mu, k, load;
  } cases[] = {{0.3, 0.2, 0.360385, 1.0355},
               {0.2, 0.3, 0.429805, 1.0687},
               {0.0, 0.5, 0.521908, 1.1465},
               {0.2, 0.5, 0.802495, 1.0970}};
  for (int i = unit_whole() ? 0 : 3; i < 4; ++i) {
    PRINTED(words, "-D NU=%g -D MU=%g%s", cases[i].nu, cases[i].mu,
            unit_whole() ? "" : " -D NC=32");
    JOB j = job_deck("input/spence/spence", words);
    DAT z = job_table(&j, "ZONES", -1), t = job_table(&j, "TOTALS", -1);
    double hertz = hertz_line(2 * dat_at(&t, 0, "force_y"), cases[i].nu);
    double a = hertz / sqrt(cases[i].load);
    int stick = dat_zone(&z, 2), slip = dat_zone(&z, 1);
    ck_assert_double_eq_tol(dat_at(&z, stick, "x_to"), cases[i].k * a,
                            5e-3 * cases[i].k * a);
    ck_assert_double_eq_tol(dat_at(&z, slip, "x_to"), a, 5e-3 * a);
    ck_assert_double_eq(dat_at(&z, slip, "direction"), -1.0);
  }
}

/* c/a = sqrt(1 - Q/(mu P)), heat per cycle W E* / (mu P)^2. */
TEST(shear_cycle_gives_its_heat) {
  static const struct {
    double share, W, nu, mu;
  } cases[] = {{0.25, 3.805007e-3, 0.1, 0.15},
               {0.5, 0.036193629, 0.2, 0.6},
               {0.9, 0.337079335, 0.0, 0.3}};
  for (int i = unit_whole() ? 0 : 2; i < 3; ++i) {
    double nu = cases[i].nu, muP = 1000 * cases[i].mu;
    PRINTED(words, "-D SHARE=%g -D NU=%g -D MU=%g -D DT=0.25%s", cases[i].share,
            nu, cases[i].mu, unit_whole() ? "" : " -D NC=20");
    JOB j = job_deck("input/mindlin_loop/mindlin_loop", words);
    DAT z = job_table(&j, "ZONES", -1), l = job_table(&j, "LOOP", -1);
    double a = hertz_line(1000, nu);
    double W = cases[i].W * muP * muP * (1 - nu * nu) / young;
    ck_assert_double_eq_tol(dat_at(&l, 0, "loop_area"), W, 0.02 * W);
    ck_assert_double_eq_tol(dat_at(&z, dat_zone(&z, 2), "extent") / 2,
                            a * sqrt(1 - cases[i].share), 0.02 * a);
  }
}

/* K - E of the modulus sqrt(1 - s^2) by the mean of Gauss; 0 for s = 1. */
static double elliptic(double s) {
  double a = 1, b = s, square = 0.5 * (1 - s * s), power = 1;
  for (int i = 0; i < 60 && a != b; ++i) {
    double c = 0.5 * (a - b), mean = 0.5 * (a + b);
    b = sqrt(a * b);
    a = mean;
    square += power * c * c;
    power *= 2;
  }
  return acos(-1.0) / (2 * a) * square;
}

/* Torque of torsion over mu P a at the stick radius c (contact radius 1): discs
 * of all radii from c on have turned by d(K - E). */
static double lubkin_torque(double c) {
  int n = 1000;
  double sum = c * c * c * elliptic(c);
  for (int i = 0; i < n; ++i) {
    double s = c + (1 - c) * (i + 0.5) / n;
    sum += 3 * s * s * elliptic(s) * (1 - c) / n;
  }
  return 4 / acos(-1.0) * sum;
}

/* Angle 3 mu P / (4 pi G a^2) (K - E); full slip 3 pi / 16 mu P a. */
TEST(torsion_gives_its_torque) {
  const double stick = 0.75, mu = 0.6;
  ck_assert_double_eq_tol(lubkin_torque(1e-9), 3 * acos(-1.0) / 16, 1e-6);
  PRINTED(words, "-D KE=%.12g -D MU=%g -D DT=0.2 -D NC=6", elliptic(stick), mu);
  JOB j = job_deck("input/torsion_sphere_3d/torsion_sphere_3d", words);
  DAT t = job_table(&j, "TOTALS", -1), l = job_table(&j, "LOOP", -1);
  double P = dat_at(&t, 0, "normal"), Es = young / 0.91, G = young / 2.6;
  double a = cbrt(3 * P * radius / (4 * Es)), low = 1e-9, high = 1;
  /* The stick radius that belongs to the angle under the force found. */
  double ke =
      dat_at(&l, 0, "angle") * 4 * acos(-1.0) * G * a * a / (3 * mu * P);
  for (int k = 0; k < 60; ++k) {
    double c = 0.5 * (low + high);
    *(elliptic(c) > ke ? &low : &high) = c;
  }
  double T = mu * P * a * lubkin_torque(low);
  ck_assert_double_eq_tol(P, 1000, 20);
  ck_assert_double_eq_tol(low, stick, 0.01);
  ck_assert_double_eq_tol(dat_at(&t, 0, "torque"), T, 0.015 * T);
}

/* tan(pi e) = mu (1 - 2 nu)/(2 - 2 nu); pressure of Johnson 8.3. The
 * elements next to the steep end, a/40 long, are left out. */
TEST(sliding_contact_is_shifted_by_friction) {
  static const double nu[] = {0.3, 0.3, 0.0, 0.1}, mu[] = {0.5, 1.0, 0.4, 0.8};
  static const double known[] = {0.04516724, 0.08858553, 0.0, 0.0};
  for (int i = unit_whole() ? 0 : 1; i < (unit_whole() ? 4 : 2); ++i) {
    const double pi = acos(-1.0), Es = young / (1 - nu[i] * nu[i]);
    double e = atan(mu[i] * (1 - 2 * nu[i]) / (2 - 2 * nu[i])) / pi;
    PRINTED(words, "-D NU=%g -D MU=0.2 -D DMU=%.17g", nu[i], mu[i] - 0.2);
    if (known[i] > 0) ck_assert_double_eq_tol(e, known[i], 1e-8);
    JOB j = job_deck("input/belt/belt", words);
    DAT c = job_table(&j, "CONTACT", -1), z = job_table(&j, "ZONES", -1);
    DAT t = job_table(&j, "TOTALS", -1);
    double N = dat_at(&t, 0, "normal");
    double l = hertz_line(N, nu[i]) / sqrt(1 - 4 * e * e);
    ck_assert_double_eq_tol(dat_at(&t, 0, "force_x"), mu[i] * N, 1e-8 * N);
    int row = dat_zone(&z, 1);
    double from = dat_at(&z, row, "x_from"), to = dat_at(&z, row, "x_to");
    ck_assert_double_eq_tol(0.5 * (to - from), l, 0.01 * l);
    ck_assert_double_eq_tol(0.5 * (to + from), -2 * e * l, 0.01 * l);
    for (int k = 0; k < c.n_row; ++k) {
      double s = dat_at(&c, k, "x") + 2 * e * l;
      if (fabs(s) > 0.75 * l) continue;
      double p = Es * cos(pi * e) / (2 * radius) * pow(l - s, 0.5 + e) *
                 pow(l + s, 0.5 - e);
      ck_assert_double_eq_tol(dat_at(&c, k, "pressure"), p,
                              0.01 * Es * l / (2 * radius));
    }
  }
}

UNIT_MAIN("partial_slip")
