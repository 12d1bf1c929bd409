/*
 * Observed orders of convergence of displacement, pressure, ends of zones and
 * dissipation for the half planes of Hertz, Spence and Cattaneo-Mindlin: all of
 * the mesh is refined by two, four times. How good an end is depends on where
 * it falls in its element, so each mesh is used in four widths, a little
 * smaller each, and the error is the root mean square over them.
 *
 * Where there is a closed form the errors are against it, else (Spence, but for
 * the ends) they are changes from mesh to mesh at the nodes of the coarsest,
 * one fewer. Errors are relative to the largest value.
 *
 * Expected of P1 elements with tractions like the root of the distance from the
 * ends: 3/2 or more for the displacement of the surface, 1 for the tractions at
 * its nodes, the ends of the zones and the dissipation.
 */
#include "support/job.h"
#include "support/unit.h"

enum { MESHES = 4, WIDTHS = 4, RUNS = MESHES * WIDTHS, COARSEST = 10 };
enum { NODES = 2 * COARSEST + 1 };
static const double widths[WIDTHS] = {1, 0.987, 0.971, 0.952};

static const double radius = 10, load = 1000, young = 210e3;

/* One deck on all meshes: run k is mesh k / WIDTHS in width k % WIDTHS. */
typedef struct series {
  const char *name;
  double a, p0; /* of Hertz, mm, MPa                                         */
  double nu;
  job j[RUNS];
  dat contact[RUNS], zones[RUNS], loop[RUNS];
} series;

/* The edge of the contact is expected at part times that of Hertz. */
static series run_series(const char *name, const char *deck, double nu,
                         double part, const char *words) {
  const double pi = acos(-1.0);
  series s = {.name = name, .nu = nu};
  s.a = sqrt(4 * load * radius * (1 - nu * nu) / (pi * young));
  s.p0 = 2 * load / (pi * s.a);
  for (int k = 0; k < RUNS; ++k) {
    int n = COARSEST << k / WIDTHS;
    PRINTED(all, "%s -D SIZE=100 -D NU=%g -D A=%.17g -D NC=%d -D GROWTH=%.6g",
            words, nu, part * s.a * widths[k % WIDTHS], n, 5.0 / n);
    s.j[k] = job_begin("verify");
    int code = job_run_deck(&s.j[k], deck, all);
    ck_assert_msg(code == 0, "%s: exit %d: %s", deck, code, s.j[k].errors);
    s.contact[k] = job_table(&s.j[k], "CONTACT", -1);
    s.zones[k] = job_table(&s.j[k], "ZONES", -1);
    s.loop[k] = job_table(&s.j[k], "LOOP", -1);
  }
  return s;
}

static void free_series(series *s) {
  for (int k = 0; k < RUNS; ++k) {
    dat_free(&s->contact[k]);
    dat_free(&s->zones[k]);
    dat_free(&s->loop[k]);
    job_end(&s->j[k]);
  }
}

/* Slope of log(error) against log(h), least squares over n meshes. */
static double order_of(int n, const double *error) {
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (int k = 0; k < n; ++k) {
    double x = -k * log(2.0), y = log(error[k]);
    sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  return (n * sxy - sx * sy) / (n * sxx - sx * sx);
}

/* A line of the table; check fails far below what is expected. */
static void report(const series *s, const char *what, int n,
                   const double *error, double expected) {
  double order = order_of(n, error);
  printf("%-9s %-22s", s->name, what);
  for (int k = 0; k < MESHES; ++k) {
    if (k < n)
      printf(" %9.2e", error[k]);
    else
      printf(" %9s", "");
  }
  printf("  %5.2f  %5.2f\n", order, expected);
  fflush(stdout);
  ck_assert_msg(order > 0.5 * expected, "%s, %s: order %.2f, expected %.2f",
                s->name, what, order, expected);
}

/* From the squares of the runs first..RUNS to the errors of their meshes. */
static void mean_over_widths(int first, const double *square, double *error) {
  for (int m = 0; m < MESHES - first / WIDTHS; ++m) {
    double sum = 0;
    for (int w = 0; w < WIDTHS; ++w) sum += square[first + m * WIDTHS + w];
    error[m] = sqrt(sum / WIDTHS);
  }
}

/* Mean square over the nodes up to "share" of a on both sides. */
static void field_errors(const series *s, const char *column, double share,
                         double (*exact)(const series *s, double x),
                         double scale, double *error) {
  double square[RUNS];
  for (int k = 0; k < RUNS; ++k) {
    const dat *c = &s->contact[k];
    double sum = 0, n = 0;
    for (int i = 0; i < c->n_row; ++i) {
      double x = dat_at(c, i, "x");
      if (fabs(x) > share * s->a) continue;
      double d = (dat_at(c, i, column) - exact(s, x)) / scale;
      sum += d * d, n += 1;
    }
    square[k] = sum / n;
  }
  mean_over_widths(0, square, error);
}

/* The same between a mesh and the next of one width, at the nodes of the
 * coarsest from 0 up to share*a. */
static void field_changes(const series *s, const char *column, double a,
                          double share, double *change) {
  double last[WIDTHS][NODES] = {{0}}, square[RUNS];
  double scale = dat_max(&s->contact[RUNS - 1], column);
  for (int k = 0; k < RUNS; ++k) {
    double sum = 0, h = a * widths[k % WIDTHS] / COARSEST;
    int n = (int)(share * a / h);
    for (int i = 0; i < n; ++i) {
      const dat *c = &s->contact[k];
      double value = dat_at(c, dat_row_near(c, "x", i * h), column);
      double d = (value - last[k % WIDTHS][i]) / scale;
      sum += d * d;
      last[k % WIDTHS][i] = value;
    }
    square[k] = sum / n;
  }
  mean_over_widths(WIDTHS, square, change);
}

/* End or extent of the zone of a kind (1 SLIP, 2 STICK), over a. */
static void zone_errors(const series *s, int kind, const char *column,
                        double exact, double *error) {
  double square[RUNS];
  for (int k = 0; k < RUNS; ++k) {
    const dat *z = &s->zones[k];
    double d = (dat_at(z, dat_zone(z, kind), column) - exact) / s->a;
    square[k] = d * d;
  }
  mean_over_widths(0, square, error);
}

static double hertz_pressure(const series *s, double x) {
  return s->p0 * sqrt(fmax(1 - x * x / (s->a * s->a), 0));
}

/* du_x/dx = -(1 - 2 nu) (1 + nu)/E p on the surface. */
static double hertz_u(const series *s, double x) {
  double y = x / s->a;
  return -(1 - 2 * s->nu) * (1 + s->nu) / young * s->p0 * s->a / 2 *
         (y * sqrt(1 - y * y) + asin(y));
}

TEST(hertz) {
  double e[MESHES];
  series s = run_series("Hertz", "input/spence/spence", 0.3, 1, "-D MU=0");
  field_errors(&s, "u_t", 0.999, hertz_u, fabs(hertz_u(&s, s.a)), e);
  report(&s, "displacement", MESHES, e, 1.5);
  field_errors(&s, "pressure", 0.9, hertz_pressure, s.p0, e);
  report(&s, "pressure", MESHES, e, 1);
  zone_errors(&s, 1, "x_to", s.a, e);
  report(&s, "end of the contact", MESHES, e, 1);
  free_series(&s);
}

/* nu = 0.3, mu = 0.2: c/a = 0.360385, P over that of Hertz 1.0355. */
TEST(spence) {
  double e[MESHES], square[RUNS], part = 1 / sqrt(1.0355);
  series s = run_series("Spence", "input/spence/spence", 0.3, part, "");
  double a = part * s.a;
  field_changes(&s, "u_t", a, 0.9, e);
  report(&s, "displacement (change)", MESHES - 1, e, 1.5);
  field_changes(&s, "pressure", a, 0.9, e);
  report(&s, "pressure (change)", MESHES - 1, e, 1);
  zone_errors(&s, 1, "x_to", a, e);
  report(&s, "end of the contact", MESHES, e, 1);
  zone_errors(&s, 2, "x_to", 0.360385 * a, e);
  report(&s, "end of the stick", MESHES, e, 1);
  for (int k = WIDTHS; k < RUNS; ++k) {
    double last = dat_at(&s.loop[k - WIDTHS], 0, "friction_work_end");
    double change = dat_at(&s.loop[k], 0, "friction_work_end") / last - 1;
    square[k] = change * change;
  }
  mean_over_widths(WIDTHS, square, e);
  report(&s, "dissipation (change)", MESHES - 1, e, 1);
  free_series(&s);
}

/* Q = 3/4 mu P: c = a/2, heat of a cycle 0.155559836 (mu P)^2 over E*. */
static const double mu = 0.3, stick = 0.5, heat = 0.155559836;

/* mu p less what the stick takes back (Cattaneo). */
static double mindlin_traction(const series *s, double x) {
  double c = stick * s->a;
  return mu * (hertz_pressure(s, x) -
               s->p0 * stick * sqrt(fmax(1 - x * x / (c * c), 0)));
}

/* Displacement by the shear, s(x) = -2 mu p0/(a E*) int_c^x sqrt(t^2 - c^2) dt,
 * in a cycle the same again at its end. */
static double mindlin_slip(const series *s, double x) {
  double c = stick * s->a, y = fabs(x) / c, root = sqrt(fmax(y * y - 1, 0));
  double integral = y <= 1 ? 0 : c * c / 2 * (y * root - log(y + root));
  return -2 * mu * s->p0 * (1 - s->nu * s->nu) / (young * s->a) * integral;
}

/* Displacement of the contact nodes since the end of step 1 instead of u_t. */
static void take_press_off(series *s) {
  for (int k = 0; k < RUNS; ++k) {
    dat press = job_table(&s->j[k], "CONTACT", 0), *c = &s->contact[k];
    int column = dat_column(c, "u_t");
    for (int i = 0; i < c->n_row; ++i)
      c->value[i * c->n_col + column] -= dat_at(&press, i, "u_t");
    dat_free(&press);
  }
}

TEST(mindlin) {
  double e[MESHES], square[RUNS];
  series s = run_series("Mindlin", "input/mindlin_loop/mindlin_loop", 0.3, 1,
                        "-D DT=0.25 -D SHARE=0.75");
  take_press_off(&s);
  field_errors(&s, "u_t", 0.999, mindlin_slip, fabs(mindlin_slip(&s, s.a)), e);
  report(&s, "displacement", MESHES, e, 1.5);
  field_errors(&s, "traction_t", 0.9, mindlin_traction, mu * s.p0, e);
  report(&s, "shear traction", MESHES, e, 1);
  zone_errors(&s, 2, "extent", 2 * stick * s.a, e);
  report(&s, "width of the stick", MESHES, e, 1);
  for (int k = 0; k < RUNS; ++k) {
    double N = dat_at(&s.loop[k], 0, "normal");
    double W = heat * mu * mu * N * N * (1 - s.nu * s.nu) / young;
    square[k] = pow(dat_at(&s.loop[k], 0, "loop_area") / W - 1, 2);
  }
  mean_over_widths(0, square, e);
  report(&s, "dissipation", MESHES, e, 1);
  free_series(&s);
}

/* The table goes first; check prints its own line after it. */
TEST(head) {
  printf("%-9s %-22s", "case", "relative error of");
  for (int k = 0; k < MESHES; ++k) {
    PRINTED(text, "h = a/%d", COARSEST << k);
    printf(" %9s", text);
  }
  printf("  order  expected\n");
  fflush(stdout);
}

UNIT_MAIN("orders")
