/*
 * Problems with published or closed solutions: the GRECO block (test SSNV128),
 * Hertz line and sphere, Spence's indentation against its one-step shortcut.
 */
#include "support/job.h"
#include "support/unit.h"

const int job_without_fields = 1;

/* u_x at the base in mm; converged values of crossed meshes of 256 squares. */
static const double greco_x[] = {0.0, 1.25, 5.0, 7.5, 11.25};
static const double greco_u[] = {28.6031e-3, 27.2258e-3, 22.8680e-3, 19.8074e-3,
                                 15.4138e-3};

TEST(greco_block_moves_as_published) {
  static const char *const words[] = {"-D N=64", "-D N=64 -D STRUCTURED=1",
                                      "-D N=128"};
  for (int k = 0; k < 3; ++k) {
    JOB j = job_deck("input/greco/greco", words[k]);
    DAT c = job_table(&j, "CONTACT", -1), t = job_table(&j, "TOTALS", -1);
    for (int i = 0; i < 5; ++i) {
      int row = dat_row_near(&c, "x", greco_x[i]);
      ck_assert_double_eq_tol(dat_at(&c, row, "x"), greco_x[i], 1e-6);
      ck_assert_double_eq_tol(dat_at(&c, row, "u_t"), greco_u[i],
                              1e-3 * greco_u[i]);
    }
    /* Statics: 50 MPa on 40 mm; published sum of the tangential forces. */
    ck_assert_double_eq_tol(dat_at(&t, 0, "force_y"), 2000.0, 1e-8);
    ck_assert_double_eq_tol(dat_at(&t, 0, "force_x"), -1405.4, 1.5);
    /* The block lifts off at the pushed corner by 0.590 um. */
    int corner = dat_row_near(&c, "x", 0.0);
    ck_assert_double_eq_tol(dat_at(&c, corner, "gap"), 0.590e-3, 0.03e-3);
  }
}

/* Proportional loads: 1, 5 and 10 increments and the static problem agree. */
TEST(greco_proportional_load_has_no_path) {
  JOB ref = job_deck("input/greco/greco", "-D SIDE=100 -D DT=1.0");
  JOB fine = job_deck("input/greco/greco", "-D SIDE=100 -D DT=0.1");
  JOB still = job_deck("input/greco/greco_static", "");
  DAT a = job_table(&ref, "CONTACT", -1), b = job_table(&fine, "CONTACT", -1);
  DAT c = job_table(&still, "CONTACT", -1);
  DAT t = job_table(&still, "TOTALS", -1);
  double scale = dat_max(&a, "f_n");
  for (int i = 0; i < a.n_row; ++i) {
    ck_assert_double_eq_tol(dat_at(&a, i, "f_t"), dat_at(&b, i, "f_t"),
                            1e-9 * scale);
    ck_assert_double_eq_tol(dat_at(&a, i, "f_n"), dat_at(&c, i, "f_n"),
                            1e-9 * scale);
  }
  /* Three programs on a mesh of 32 segments; other meshes differ by 1e-3. */
  ck_assert_double_eq(dat_at(&t, 0, "open"), 3.0);
  ck_assert_double_eq(dat_at(&t, 0, "slip"), 15.0);
  ck_assert_double_eq(dat_at(&t, 0, "stick"), 15.0);
  ck_assert_double_eq_tol(dat_at(&t, 0, "force_x"), -1080.67, 1.1);
}

/* p^2 = p0^2 (1 - s^2 / a^2) fitted to the nodes under "share" of the largest
 * abscissa in contact; axis nodes (half areas) are left out. */
static void fit_pressure(const dat *d, const char *abscissa, double share,
                         double *p0, double *a) {
  double edge = 0.0, n = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (int i = 0; i < d->n_row; ++i)
    if (dat_at(d, i, "pressure") > 0.0)
      edge = fmax(edge, dat_at(d, i, abscissa));
  for (int i = 0; i < d->n_row; ++i) {
    double s = dat_at(d, i, abscissa), p = dat_at(d, i, "pressure");
    if (s > share * edge || s < 0.02 * edge) continue;
    double x = s * s, y = p * p;
    n += 1, sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  ck_assert_double_ge(n, 5);
  double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
  double top = (sy - slope * sx) / n;
  *p0 = sqrt(top);
  *a = sqrt(-top / slope);
}

/* a = sqrt(4 P R / (pi E*)), p0 = 2 P / (pi a), E* = E / (1 - nu^2). */
TEST(hertz_line_has_its_pressure) {
  const double P = 1000, R = 10, pi = acos(-1.0), Es = 210e3 / 0.91;
  double a_h, p0_h;
  static const char *const decks[] = {"input/hertz_line/hertz_block",
                                      "input/hertz_line/hertz_line",
                                      "input/hertz_line/disc"};
  static const char *const words[] = {"-D NC=24", "-D NC=16", "-D NC=16"};

  static const double tol[] = {2e-3, 2e-3, 3e-3};
  for (int k = 0; k < 3; ++k) {
    JOB j = job_deck(decks[k], words[k]);
    DAT c = job_table(&j, "CONTACT", -1), t = job_table(&j, "TOTALS", -1);
    /* The approach of the disc gives about P; Hertz holds for the force found,
     * of which a symmetric half is in the model of the first two. */
    double force = k < 2 ? P : fabs(dat_at(&t, 0, "force_y"));
    double a = sqrt(4 * force * R / (pi * Es)), p0 = 2 * force / (pi * a);
    ck_assert_double_eq_tol(force, P, 0.02 * P);
    fit_pressure(&c, "x", 0.9, &p0_h, &a_h);
    ck_assert_double_eq_tol(p0_h, p0, tol[k] * p0);
    ck_assert_double_eq_tol(a_h, a, tol[k] * a);
    if (k < 2)
      ck_assert_double_eq_tol(dat_at(&t, 0, "force_y"), P / 2, 1e-9 * P);
  }
}

/* a = (3 P R / 4 E*)^(1/3), p0 = 3 P / (2 pi a^2). */
TEST(hertz_sphere_has_its_pressure) {
  const double P = 1000, R = 10, pi = acos(-1.0), Es = 210e3 / 0.91;
  double a = cbrt(3 * P * R / (4 * Es)), p0 = 1.5 * P / (pi * a * a), a_h, p0_h;
  JOB j = job_deck("input/hertz_sphere/hertz_sphere", "-D NC=32");
  DAT c = job_table(&j, "CONTACT", -1), t = job_table(&j, "TOTALS", -1);
  fit_pressure(&c, "r", 0.9, &p0_h, &a_h);
  ck_assert_double_eq_tol(a_h, a, 5e-3 * a);
  ck_assert_double_eq_tol(p0_h, p0, 5e-3 * p0);
  ck_assert_double_eq_tol(dat_at(&t, 0, "force_z"), P, 1e-9 * P);
}

UNIT_MAIN("published")
