/*
 * Histories of a material point against CVODE (SUNDIALS, BDF, relative
 * tolerance 1e-12): the right-hand sides stand here, written with tensors from
 * the equations of the papers, and share nothing with src/material/law. The
 * integrators of src/material/scheme must come to the answer of CVODE with
 * their order, under given strains, given stresses, and a bar that is pulled
 * and twisted.
 */
#include "support/point_body.h"
#include "support/unit.h"

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

enum { MOST = 24 };

/* Symmetric tensors as xx, yy, zz, xy, yz, zx; shears are tensor components. */
typedef struct setting {
  const struct history *of;
  const point_drive *drive;
} setting;

/* y' of the internal strains y for the stress s and the strain e at t. */
typedef void rate_fn(double t, const double *s, const double *e,
                     const double *y, double *dy);
/* e^i of y. */
typedef void strain_fn(const double *y, double *ei);

typedef struct history {
  const char *name;
  point_input in;
  double time, scale; /* scale: of the strains                                */
  int n;              /* of y                                                 */
  rate_fn *rate;
  strain_fn *strain;
  int linear;
} history;

static const double nu = 0.3;

static double trace(const double *a) { return a[0] + a[1] + a[2]; }

static double contract(const double *a, const double *b) {
  double sum = 0;
  for (int i = 0; i < 6; ++i) sum += (i < 3 ? 1 : 2) * a[i] * b[i];
  return sum;
}

static void deviator(const double *a, double *d) {
  for (int i = 0; i < 6; ++i) d[i] = a[i] - (i < 3 ? trace(a) / 3 : 0);
}

/* Hooke's law with Young's modulus 1: (1 + nu) s - nu tr(s) I. */
static void compliance(const double *s, double *e) {
  for (int i = 0; i < 6; ++i)
    e[i] = (1 + nu) * s[i] - (i < 3 ? nu * trace(s) : 0);
}

static void first_six(const double *y, double *ei) {
  memcpy(ei, y, 6 * sizeof *ei);
}

/* e = (1 + nu) s/E ..., flow s/tau by Hooke's law. */
static void maxwell(double t, const double *s, const double *e, const double *y,
                    double *dy) {
  (void)t, (void)e, (void)y;
  compliance(s, dy);
  for (int i = 0; i < 6; ++i) dy[i] /= 1000 * 2;
}

/* Dashpots of viscosity 2 G tau in shear and 3 K tau_b in bulk. */
static void maxwell_dev(double t, const double *s, const double *e,
                        const double *y, double *dy) {
  const double G = 1000 / 2.6, K = 1000 / 1.2;
  (void)t, (void)e, (void)y;
  deviator(s, dy);
  for (int i = 0; i < 6; ++i)
    dy[i] = dy[i] / (2 * G * 2) + (i < 3 ? trace(s) / 3 / (3 * K * 5) : 0);
}

/* One Kelvin-Voigt unit E1, eta with Poisson's ratio of the spring. */
static void voigt(const double *s, double E1, double eta, const double *y,
                  double *dy) {
  double c[6];
  compliance(s, c);
  for (int i = 0; i < 6; ++i) dy[i] = (c[i] - E1 * y[i]) / eta;
}
static void zener(double t, const double *s, const double *e, const double *y,
                  double *dy) {
  (void)t, (void)e;
  voigt(s, 500, 3000, y, dy);
}
static void kelvin(double t, const double *s, const double *e, const double *y,
                   double *dy) {
  (void)t, (void)e;
  voigt(s, 500, 3000, y, dy);
  voigt(s, 2000, 900, y + 6, dy + 6);
}
static void burgers(double t, const double *s, const double *e, const double *y,
                    double *dy) {
  (void)t, (void)e;
  voigt(s, 500, 3000, y, dy);
  voigt(s, 0, 8000, y + 6, dy + 6);
}
static void sum_of_two(const double *y, double *ei) {
  for (int i = 0; i < 6; ++i) ei[i] = y[i] + y[6 + i];
}

/* Relaxation moduli G(t), K(t) as sums of exponentials: strains of dampers. */
static const double prony_term[2][3] = {{0.3, 0.1, 0.5}, {0.2, 0.15, 4}};
static void prony(double t, const double *s, const double *e, const double *y,
                  double *dy) {
  (void)t, (void)s;
  for (int k = 0; k < 2; ++k)
    for (int i = 0; i < 6; ++i)
      dy[6 * k + i] = (e[i] - y[6 * k + i]) / prony_term[k][2];
}
static void prony_strain(const double *y, double *ei) {
  memset(ei, 0, 6 * sizeof *ei);
  for (int k = 0; k < 2; ++k)
    for (int i = 0; i < 6; ++i) {
      const double mean = i < 3 ? trace(y + 6 * k) / 3 : 0;
      ei[i] +=
          prony_term[k][0] * (y[6 * k + i] - mean) + prony_term[k][1] * mean;
    }
}

/* Flow along the deviator with the equivalent rate f(q). */
static double flow_of(const double *s, double *direction) {
  double d[6];
  deviator(s, d);
  const double q = sqrt(1.5 * contract(d, d));
  for (int i = 0; i < 6; ++i) direction[i] = q > 0 ? 1.5 * d[i] / q : 0;
  return q;
}

static void norton(double t, const double *s, const double *e, const double *y,
                   double *dy) {
  const double q = flow_of(s, dy);
  (void)e, (void)y;
  for (int i = 0; i < 6; ++i) dy[i] *= 3e-14 * pow(q, 5) * pow(t, -0.3);
}

/* p = A q^n t^(1 + m)/(1 + m), t eliminated; y[6] = p. */
static void norton_strain(double t, const double *s, const double *e,
                          const double *y, double *dy) {
  const double q = flow_of(s, dy), m = -0.3, a = 3e-14 * pow(q, 5);
  (void)t, (void)e;
  const double rate = pow(a, 1 / (1 + m)) * pow((1 + m) * y[6], m / (1 + m));
  for (int i = 0; i < 6; ++i) dy[i] *= rate;
  dy[6] = rate;
}

static void user(double t, const double *s, const double *e, const double *y,
                 double *dy) {
  const double q = flow_of(s, dy), rate = 5e-14 * pow(q, 5) / (1 + 100 * y[6]);
  (void)t, (void)e;
  for (int i = 0; i < 6; ++i) dy[i] *= rate;
  dy[6] = rate;
}

/* Overstress over a threshold, to a power. */
static double over(double q, double threshold, double K, double n) {
  return q > threshold ? pow((q - threshold) / K, n) : 0;
}

static void bingham(double t, const double *s, const double *e, const double *y,
                    double *dy) {
  const double q = flow_of(s, dy), rate = over(q, 100, 1e4, 1);
  (void)t, (void)e, (void)y;
  for (int i = 0; i < 6; ++i) dy[i] *= rate;
}

static void perzyna(double t, const double *s, const double *e, const double *y,
                    double *dy) {
  const double p = y[6], q = flow_of(s, dy);
  const double rate =
      over(q, 80 + 1e4 * p + 30 * (1 - exp(-100 * p)), 1e4, 1.5);
  (void)t, (void)e;
  for (int i = 0; i < 6; ++i) dy[i] *= rate;
  dy[6] = rate;
}

/* y: e^i, p, two tensors a_k with the back stresses 2/3 C_k a_k. */
static void chaboche(double t, const double *s, const double *e,
                     const double *y, double *dy) {
  static const double C[] = {2e4, 5e3}, gamma[] = {100, 20};
  double relative[6];
  (void)t, (void)e;
  for (int i = 0; i < 6; ++i)
    relative[i] = s[i] - 2 / 3. * (C[0] * y[7 + i] + C[1] * y[13 + i]);
  const double q = flow_of(relative, dy);
  const double rate = over(q, 60 + 20 * (1 - exp(-50 * y[6])), 300, 3);
  for (int i = 0; i < 6; ++i) dy[i] *= rate;
  dy[6] = rate;
  for (int k = 0; k < 2; ++k)
    for (int i = 0; i < 6; ++i)
      dy[7 + 6 * k + i] = dy[i] - gamma[k] * y[7 + 6 * k + i] * rate;
}

/* clang-format off */
static const history histories[] = {
  {"MAXWELL", {"MAXWELL", "2.", 0, 1e3, 0.3, 0},
   2, 1e-3, 6, maxwell, first_six, 1},
  {"MAXWELL deviatoric", {"MAXWELL", "2., 5.", 1, 1e3, 0.3, 0},
   2, 1e-3, 6, maxwell_dev, first_six, 1},
  {"ZENER", {"ZENER", "500., 3000.", 0, 1e3, 0.3, 0},
   2, 1e-3, 6, zener, first_six, 1},
  {"KELVIN", {"KELVIN", "500., 3000.\n2000., 900.", 0, 1e3, 0.3, 0},
   1, 1e-3, 12, kelvin, sum_of_two, 1},
  {"BURGERS", {"BURGERS", "8000., 500., 3000.", 0, 1e3, 0.3, 0},
   2, 1e-3, 12, burgers, sum_of_two, 1},
  {"PRONY", {"PRONY", "0.3, 0.1, 0.5\n0.2, 0.15, 4.", 0, 1e3, 0.3, 0},
   1, 1e-3, 12, prony, prony_strain, 1},
  {"NORTON time", {"NORTON", "3E-14, 5., -0.3", 0, 1e5, 0.3, 1},
   2, 1e-3, 6, norton, first_six, 0},
  {"NORTON strain", {"NORTON", "3E-14, 5., -0.3", 1, 1e5, 0.3, 1},
   2, 1e-3, 7, norton_strain, first_six, 0},
  {"BINGHAM", {"BINGHAM", "100., 1E4", 0, 1e5, 0.3, 0},
   0.1, 2e-3, 6, bingham, first_six, 0},
  {"PERZYNA", {"PERZYNA", "80., 1E4, 1E4, 1.5, 30., 100.", 0, 1e5, 0.3, 0},
   0.5, 2e-3, 7, perzyna, first_six, 0},
  {"CHABOCHE",
   {"CHABOCHE", "60., 300., 3., 20., 50.\n2E4, 100.\n5E3, 20.", 0, 1e5,
    0.3, 0},
   0.02, 2e-3, 19, chaboche, first_six, 0},
  {"USER", {"USER", "\"5E-14*q^5/(1 + 100*p)\"", 0, 1e5, 0.3, 1},
   2, 1e-3, 7, user, first_six, 0}};
/* clang-format on */
enum { N_HISTORY = sizeof histories / sizeof *histories };

/* x[3] of the rows A x = b with A[i][3] = b. */
static void eliminate(double A[3][4], double *x) {
  for (int k = 0; k < 3; ++k)
    for (int i = 0; i < 3; ++i) {
      if (i == k) continue;
      const double factor = A[i][k] / A[k][k];
      for (int j = 0; j < 4; ++j) A[i][j] -= factor * A[k][j];
    }
  for (int i = 0; i < 3; ++i) x[i] = A[i][3] / A[i][i];
}

/* Strains (tensor components) and stresses of a drive at t for e^i: Hooke's law
 * for the elastic strains x, known where strains are held. */
static void settle(const point_drive *d, double young, double t,
                   const double *ei, double *s, double *e) {
  const double lame = young * nu / ((1 + nu) * (1 - 2 * nu));
  const double G = young / (2 * (1 + nu));
  double x[6], A[3][4];
  for (int i = 0; i < 6; ++i) {
    const double stress = d->sigma[i] + t * d->sigma_rate[i];
    const double strain = d->e[i] + t * d->e_rate[i];
    x[i] = d->held[i] ? (i < 3 ? 1 : 0.5) * strain - ei[i] : stress / (2 * G);
    if (i >= 3) continue;
    A[i][3] = d->held[i] ? x[i] : stress;
    for (int j = 0; j < 3; ++j)
      A[i][j] = (i == j) * (d->held[i] ? 1 : 2 * G) + !d->held[i] * lame;
  }
  eliminate(A, x);
  for (int i = 0; i < 6; ++i) {
    s[i] = 2 * G * x[i] + (i < 3 ? lame * trace(x) : 0);
    e[i] = x[i] + ei[i];
  }
}

static int rhs(realtype t, N_Vector y_, N_Vector dy_, void *data) {
  const setting *c = data;
  const double *y = N_VGetArrayPointer(y_);
  double ei[6], s[6], e[6];
  c->of->strain(y, ei);
  settle(c->drive, c->of->in.young, t, ei, s, e);
  c->of->rate(t, s, e, y, N_VGetArrayPointer(dy_));
  return 0;
}

/* y at the end of the history, y0 at its start. */
static void by_cvode(const history *h, const point_drive *d, const double *y0,
                     double *y) {
  SUNContext sun;
  setting c = {h, d};
  realtype reached;
  ck_assert_int_eq(SUNContext_Create(NULL, &sun), 0);
  N_Vector v = N_VNew_Serial(h->n, sun);
  memcpy(N_VGetArrayPointer(v), y0, (size_t)h->n * sizeof *y0);
  SUNMatrix A = SUNDenseMatrix(h->n, h->n, sun);
  SUNLinearSolver ls = SUNLinSol_Dense(v, A, sun);
  void *cv = CVodeCreate(CV_BDF, sun);
  ck_assert_int_eq(CVodeInit(cv, rhs, h->in.t, v), 0);
  ck_assert_int_eq(CVodeSStolerances(cv, 1e-12, 1e-13 * h->scale), 0);
  ck_assert_int_eq(CVodeSetUserData(cv, &c), 0);
  ck_assert_int_eq(CVodeSetLinearSolver(cv, ls, A), 0);
  ck_assert_int_eq(CVodeSetMaxNumSteps(cv, 1000000), 0);
  ck_assert_int_eq(CVodeSetStopTime(cv, h->in.t + h->time), 0);
  ck_assert_int_ge(CVode(cv, h->in.t + h->time, v, &reached, CV_NORMAL), 0);
  memcpy(y, N_VGetArrayPointer(v), (size_t)h->n * sizeof *y);
  CVodeFree(&cv);
  SUNLinSolFree(ls);
  SUNMatDestroy(A);
  N_VDestroy(v);
  SUNContext_Free(&sun);
}

/* The three ways to drive a point, of strains of this size. */
static point_drive drive_of(const history *h, int way) {
  const double e = h->scale, s = e * h->in.young, by = 0.5 / h->time;
  const double t0 = h->in.t;
  static const int held[3][6] = {{1, 1, 1, 1, 1, 1}, {0}, {1, 0, 0, 1, 0, 0}};
  static const double shape[6] = {1, -0.4, -0.2, 0.5, 0.1, -0.3};
  point_drive d;
  memset(&d, 0, sizeof d);
  memcpy(d.held, held[way], sizeof d.held);
  for (int i = 0; i < 6; ++i) {
    const double part = way == 2 && !held[2][i] ? 0 : shape[i];
    d.e_rate[i] = by * e * part;
    d.e[i] = e * part - t0 * d.e_rate[i];
    d.sigma_rate[i] = by * s * part / 2;
    d.sigma[i] = s * part - t0 * d.sigma_rate[i];
  }
  return d;
}

/* p starts above zero where the law divides by it: e^i along the shape. */
static void start_values(const history *h, double *y) {
  memset(y, 0, MOST * sizeof *y);
  if (h->rate == norton_strain) y[6] = 1e-3;
}

/* Distance of e^i and of that of CVODE after n steps. */
static double error_of(const history *h, const point_drive *d, const scheme *s,
                       double theta, int n, const double *ei) {
  POINT_BODY b;
  double sum = 0, y0[MOST];
  start_values(h, y0);
  point_body_new(&h->in, d, &b);
  /* alpha is the p^(1/(1 + m)) that the law integrates. */
  if (h->rate == norton_strain) b.old.alpha[0] = pow(y0[6], 1 / 0.7);
  point_body_run(&b, s, theta, h->in.t + h->time, n, NULL);
  for (int i = 0; i < 6; ++i) {
    const double found = b.now.ei[i] / (i < 3 ? 1 : 2);
    sum += (i < 3 ? 1 : 2) * pow(found - ei[i], 2);
  }
  return sqrt(sum) / h->scale;
}

static const struct {
  const char *name;
  double theta;
  int order, n;
} rows[] = {{"EULER", 0, 1, 200},     {"HEUN", 0, 2, 50},
            {"RK4", 0, 4, 10},        {"THETA", 0.75, 1, 200},
            {"MIDPOINT", 0.5, 2, 50}, {"BACKWARD", 1, 1, 200},
            {"EXPONENTIAL", 0, 2, 25}};
enum { N_ROW = sizeof rows / sizeof *rows };

/* The order of the errors against CVODE within 0.1, once the steps are short
 * enough for it; or errors below what CVODE holds. */
static void check_order(const history *h, const point_drive *d, int row,
                        const double *ei) {
  enum { HALVINGS = 7 };
  const scheme *s = scheme_find(rows[row].name);
  double order = 0, last = 0, now = 0;
  for (int k = 0; k <= HALVINGS; ++k) {
    last = now;
    now = error_of(h, d, s, rows[row].theta, rows[row].n << k, ei);
    if (now <= 3e-9) return;
    order = log2(last / now);
    if (k > 0 && fabs(order - rows[row].order) <= 0.1) return;
  }
  ck_abort_msg("%s, %s: errors %.3g, %.3g, order %.3f", h->name, s->name, last,
               now, order);
}

/* Without PROTIS_PROBLEMS a law and a scheme meet under one of the controls. */
TESTS(every_law_under_every_control, 3 * N_HISTORY) {
  const history *h = &histories[_i / 3];
  const point_drive d = drive_of(h, _i % 3);
  double y0[MOST], y[MOST], ei[6];
  start_values(h, y0);
  by_cvode(h, &d, y0, y);
  h->strain(y, ei);
  ck_assert_double_gt(sqrt(contract(ei, ei)), 0.02 * h->scale);
  for (int k = 0; k < N_ROW; ++k) {
    if (!unit_whole() && (k + _i / 3 + _i) % 3 != 0) continue;
    if (h->linear || !scheme_find(rows[k].name)->linear_only)
      check_order(h, &d, k, ei);
  }
}

UNIT_MAIN_FOR("sundials", 10 * UNIT_SECONDS)
