/*
 * Histories of a material point against closed forms and, for Chaboche cycles
 * and Burgers, against numbers of scipy (solve_ivp, DOP853, rtol 1e-12).
 * E = 1000, nu = 0.3, tau = 2 unless said.
 */
#include "support/law_case.h"
#include "support/unit.h"

static law_case c;

static void start(const char *name, int words, const char *data, double young,
                  double nu, kinematics kin) {
  const law_ops *ops = law_find(name);
  ck_assert_ptr_nonnull(ops);
  ck_assert_int_eq(law_case_new(ops, words, data, young, nu, kin, &c), 1);
}

static void near(double a, double b, double tol) {
  ck_assert_msg(fabs(a - b) <= tol * fabs(b), "%.12g, expected %.12g", a, b);
}

static const law_drive hold_x = {.held = {1}};
static const law_drive hold_none = {.held = {0}};
static const law_drive hold_normal = {.held = {1, 1, 1}};

/* Strain e along x at once, the other stresses zero; then held. */
static void stretch(double e) {
  law_drive d = hold_x;
  d.e_rate[0] = e;
  law_case_jump(&c, &d);
}

static void load(double stress) {
  law_drive d = hold_none;
  d.sigma_rate[0] = stress;
  law_case_jump(&c, &d);
}

/* One entry of the state at given times, to 1e-9. */
static void follow(const law_drive *d, const double *x, int n, const double *t,
                   const double *expected, int steps) {
  near(*x, expected[0], 1e-9);
  for (int i = 1; i < n; ++i) {
    law_case_run(&c, d, t[i] - t[i - 1], steps);
    near(*x, expected[i], 1e-9);
  }
}

/* Stretched by 1e-3 and held: sigma_xx at four times; the case ends. */
static void relaxes(const double *t, const double *expected, int steps) {
  stretch(1e-3);
  follow(&hold_x, &c.sigma[0], 4, t, expected, steps);
  law_case_free(&c);
}

static const double at[] = {0, 1, 2, 10};

TEST(maxwell_relaxes) {
  start("MAXWELL", 0, "2.", 1000, .3, SOLID_3D);
  relaxes(
      at,
      (double[]){1, .6065306597126334, .36787944117144233, .006737946999085467},
      400);
  start("MAXWELL", 1, "2.", 1000, .3, AXISYMMETRIC);
  const double r = 2 * 1.3 / (3 * 2);
  relaxes(at, (double[]){1, exp(-r), exp(-2 * r), exp(-10 * r)}, 400);
}

/* Deviatoric flow, e_xx held, the others zero: the mean stress stays. */
TEST(confined_maxwell_keeps_the_mean_stress) {
  const double K = 1000 / 1.2, G = 1000 / 2.6;
  start("MAXWELL", 1, "2.", 1000, .3, PLANE_STRAIN);
  law_drive d = hold_normal;
  d.e_rate[0] = 1e-3;
  law_case_jump(&c, &d);
  for (int i = 1; i < 4; ++i) {
    law_case_run(&c, &hold_normal, at[i] - at[i - 1], 400);
    const double s = 4e-3 * G / 3 * exp(-at[i] / 2);
    near(c.sigma[0], K * 1e-3 + s, 1e-9);
    near(c.sigma[1], K * 1e-3 - s / 2, 1e-9);
    near(c.sigma[2], K * 1e-3 - s / 2, 1e-9);
  }
  near(c.sigma[0], .8367886908, 1e-9);
  near(c.sigma[1], .8316056547, 1e-9);
  law_case_free(&c);
}

TEST(confined_maxwell_creeps_to_the_bulk) {
  start("MAXWELL", 1, "2.", 1000, .3, SOLID_3D);
  law_drive d = {.held = {0, 1, 1}, .sigma_rate = {1}};
  law_case_jump(&c, &d);
  d.sigma_rate[0] = 0;
  follow(&d, &c.e[0], 4, at,
         (double[]){7.428571428571e-4, 8.645502629e-4, 9.538482242e-4,
                    1.179307779e-3},
         400);
  near(c.sigma[1] / c.sigma[0], .9741347234, 1e-9);
  law_case_free(&c);
}

/* sigma_zz goes to half the stress; e_yy is the free one. */
TEST(plane_strain_maxwell_carries_zz) {
  start("MAXWELL", 1, "2.", 1000, .3, PLANE_STRAIN);
  law_drive d = {.held = {0, 0, 1}, .sigma_rate = {0, 1}};
  law_case_jump(&c, &d);
  d.sigma_rate[1] = 0;
  follow(&d, &c.sigma[2], 4, at,
         (double[]){.3, .3703311318, .4159299231, .4973752543}, 400);
  near(c.e[1], 4.199475051e-3, 1e-9);
  law_case_free(&c);
}

TEST(maxwell_stress_at_constant_rate_levels_off) {
  start("MAXWELL", 0, "2.", 1000, .3, SOLID_3D);
  law_drive d = hold_x;
  d.e_rate[0] = 1e-3;
  law_case_run(&c, &d, 1, 400);
  near(c.sigma[0], .7869386806, 1e-9);
  law_case_run(&c, &d, 9, 4000);
  near(c.sigma[0], 1.9865241060, 1e-9);
  law_case_free(&c);
}

/* Bulk relaxation: hydrostatic strain decays with tau_bulk. */
TEST(maxwell_bulk_relaxes_if_asked) {
  start("MAXWELL", 1, "2., 5.", 1000, .3, SOLID_3D);
  law_drive d = hold_normal;
  for (int i = 0; i < 3; ++i) d.e_rate[i] = 1e-3;
  law_case_jump(&c, &d);
  law_case_run(&c, &hold_normal, 4, 400);
  near(c.sigma[0], 3e-3 * 1000 / 1.2 * exp(-4 / 5.), 1e-9);
  law_case_free(&c);
}

static const double zener_at[] = {0, 1, 6, 30};

/* KELVIN of one unit is ZENER. */
TEST(zener_creeps_and_relaxes) {
  static const char *const names[] = {"ZENER", "KELVIN"};
  for (int k = 0; k < 2; ++k) {
    start(names[k], 0, "500., 3000.", 1000, .3, SOLID_3D);
    load(1);
    follow(&hold_none, &c.e[0], 4, zener_at,
           (double[]){1e-3, 1.3070365502e-3, 2.2642411177e-3, 2.98652410600e-3},
           400);
    near(c.ei[0], 1.986524106e-3, 1e-9); /* Kelvin-Voigt alone               */
    law_case_free(&c);
    start(names[k], 0, "500., 3000.", 1000, .3, SOLID_3D);
    stretch(1e-3);
    follow(&hold_x, &c.sigma[0], 4, zener_at,
           (double[]){1, .7376871065, .3665247122, .3333335373}, 800);
    law_case_free(&c);
  }
}

/* Creep: 1/E + t/eta_M + (1 - exp(-t E_K/eta_K))/E_K. */
TEST(burgers_creeps_as_the_sum_of_its_parts) {
  start("BURGERS", 0, "8000., 500., 3000.", 1000, .3, PLANE_STRESS);
  load(2);
  law_case_run(&c, &hold_none, 6, 400);
  near(c.e[0], 2 * (1e-3 + 6 / 8000. + (1 - exp(-1.)) / 500), 1e-10);
  near(c.e[1], -.3 * c.e[0], 1e-12);
  near(c.e[2], -.3 * c.e[0], 1e-12);
  law_case_free(&c);
}

/* By the exponential of the 2x2 matrix (scipy). */
TEST(burgers_relaxes_to_zero) {
  static const double t[] = {0, 1, 6, 30};
  start("BURGERS", 0, "8000., 500., 3000.", 1000, .3, SOLID_3D);
  relaxes(t, (double[]){1, 0.6518331298418, 0.2138496165521, 0.08209058469504},
          800);
}

/* All in one shear and one bulk test: the moduli are the series. */
TEST(prony_moduli_are_the_series) {
  const char *data = "0.3, 0.1, 0.5\n0.2, 0., 4.\n0.25, 0.3, 200.";
  const double G = 1000 / 2.6, K = 1000 / 1.2, t = 3;
  const double g =
      1 - .3 * (1 - exp(-6)) - .2 * (1 - exp(-.75)) - .25 * (1 - exp(-.015));
  const double k = 1 - .1 * (1 - exp(-6)) - .3 * (1 - exp(-.015));
  start("PRONY", 0, data, 1000, .3, SOLID_3D);
  law_drive d = {.held = {1, 1, 1, 1, 1, 1}, .e_rate = {1, 1, 1, 1, 0, 2}};
  law_case_jump(&c, &d);
  memset(d.e_rate, 0, sizeof d.e_rate);
  law_case_run(&c, &d, t, 600);
  near(c.sigma[0], 3 * K * k, 1e-9);
  near(c.sigma[3], G * g, 1e-9);
  near(c.sigma[5], 2 * G * g, 1e-9);
  law_case_free(&c);
}

/* One term with g = k = 1 is the proportional Maxwell body. */
TEST(prony_of_one_full_term_is_maxwell) {
  start("PRONY", 0, "1., 1., 2.", 1000, .3, SOLID_3D);
  stretch(1e-3);
  law_case_run(&c, &hold_x, 2, 400);
  near(c.sigma[0], exp(-1.), 1e-9);
  law_case_free(&c);
}

TEST(norton_relaxes) {
  static const double t[] = {0, 1, 10, 100, 1000};
  start("NORTON", 0, "1E-15, 5.", 1e5, .3, SOLID_3D);
  stretch(1e-3);
  follow(&hold_x, &c.sigma[0], 5, t,
         (double[]){100, 99.024273574257, 91.932271522492, 66.874030497642,
                    39.518826132440},
         400);
  law_case_free(&c);
  start("NORTON", 0, "1E-15, 5.", 1e5, .3, PLANE_STRESS);
  load(100);
  law_case_run(&c, &hold_none, 10, 1);
  near(c.e[0], .001 + 1e-4, 1e-12);
  law_case_free(&c);
}

/* Both hardenings give A q^n t^(1+m)/(1+m) under constant stress. The rate is
 * infinite at t = 0: the mean over the first step stands for it there. */
TEST(hardening_slows_norton_down) {
  for (int words = 0; words < 2; ++words) {
    start("NORTON", words, "1E-15, 5., -0.5", 1e5, .3, SOLID_3D);
    load(100);
    c.t = 0;
    c.dt = 1e-2;
    law_point p = law_case_point(&c);
    double ei_rate[6], alpha_rate[1];
    law_rate(&p, ei_rate, alpha_rate);
    near(ei_rate[0] * c.dt, 1e-5 * 2 * sqrt(c.dt), 1e-12);
    c.t = 1;
    c.ei[0] = 2e-5;
    if (words == 1) c.alpha[0] = pow(2e-5, 2);
    law_case_run(&c, &hold_none, 8, 400);
    near(c.ei[0], 2e-5 * 3, 1e-9);
    law_case_free(&c);
  }
}

/* The same by a formula; with strain hardening ((1 + m) p)^(m/(1 + m)). */
TEST(formulas_relax_and_harden) {
  static const double t[] = {0, 1, 10, 100};
  start("USER", 0, "\"1E-15*q^5\"", 1e5, .3, SOLID_3D);
  relaxes(t, (double[]){100, 99.024273574257, 91.932271522492, 66.874030497642},
          400);
  start("USER", 0, "\"(1E-15*q^5)^2/(0.5*p)\"", 1e5, .3, SOLID_3D);
  load(100);
  c.t = 1;
  c.ei[0] = c.alpha[0] = 2e-5;
  law_case_run(&c, &hold_none, 8, 800);
  near(c.ei[0], 2e-5 * 3, 1e-9);
  law_case_free(&c);
  start("USER", 0, "\"1E-9*q*t*temp\"", 1e5, .3, SOLID_3D);
  load(100);
  c.temperature = 50;
  law_case_run(&c, &hold_none, 2, 10);
  near(c.ei[0], 1e-7 * 50 * 2, 1e-12);
  law_case_free(&c);
}

/* Terms over 30 decades of relaxation time: each is where it must be. */
TEST(thirty_decades_of_relaxation_times) {
  char data[1000];
  size_t n = 0;
  double limit;
  for (int k = 0; k < 20; ++k)
    n += (size_t)snprintf(data + n, sizeof data - n, "%s0.04, 0.02, 1E%d",
                          k == 0 ? "" : "\n", -15 + 30 * k / 19);
  start("PRONY", 0, data, 1000, .3, SOLID_3D);
  law_drive d = {.held = {1, 1, 1, 1, 1, 1}, .e_rate = {0, 0, 0, 1}};
  law_case_jump(&c, &d);
  law_point p = law_case_point(&c);
  ck_assert_int_eq(law_fastest_rate(&p, &limit), OK);
  near(limit, 1e15, 1e-12);
  c.elastic.isotropic = 0; /* by LAPACK                                       */
  ck_assert_int_eq(law_fastest_rate(&p, &limit), OK);
  near(limit, 1e15, 1e-9);
  /* The terms below 1e-3 s are at rest, the rest has not moved. */
  double left = 1;
  for (int k = 0; k < 20; ++k)
    if (-15 + 30 * k / 19 <= -3) {
      c.alpha[6 * k + 3] = c.e[3];
      left -= .04;
    }
  for (int k = 0; k < 20; ++k) c.ei[3] += .04 * c.alpha[6 * k + 3];
  law_drive hold = {.held = {1, 1, 1, 1, 1, 1}};
  law_case_jump(&c, &hold);
  near(c.sigma[3], 1000 / 2.6 * left, 1e-12);
  double ei_rate[6], alpha_rate[LAW_ALPHA_MAX];
  p = law_case_point(&c);
  law_rate(&p, ei_rate, alpha_rate);
  ck_assert(isfinite(ei_rate[3]));
  law_case_free(&c);
}

/* Temperature 30 above the reference: WLF 10^(17.44*30/81.6), Arrhenius. */
TEST(shifts_run_the_clock) {
  start("MAXWELL", 0, "2.", 1000, .3, SOLID_3D);
  c.card.shift = (law_shift){SHIFT_WLF, 20, 0, 17.44, 51.6, 0};
  near(law_speed(&c.card, 50), pow(10, 17.44 * 30 / 81.6), 1e-13);
  ck_assert(law_speed(&c.card, 20) == 1);
  ck_assert(law_speed(&c.card, -40) == 0); /* below the glass                 */
  ck_assert_uint_eq(law_varies(&c.card), LAW_VARIES_TEMPERATURE);
  c.card.shift = (law_shift){SHIFT_ARRHENIUS, 20, -273.15, 0, 0, 1e4};
  const double speed = exp(-1e4 * (1 / 323.15 - 1 / 293.15));
  near(law_speed(&c.card, 50), speed, 1e-12);
  c.temperature = 50;
  stretch(1e-3);
  law_case_run(&c, &hold_x, 2 / speed, 400);
  near(c.sigma[0], exp(-1.), 1e-9);
  law_case_free(&c);
}

/* Hundreds of stress units: A q^n in range though q^n alone is not. */
TEST(large_powers_do_not_overflow) {
  double ei_rate[6], alpha_rate[1];
  start("NORTON", 0, "1E-300, 40.", 1e5, .3, SOLID_3D);
  c.sigma[0] = 1e8;
  law_point p = law_case_point(&c);
  law_rate(&p, ei_rate, alpha_rate);
  near(ei_rate[0], 1e20, 1e-10);
  law_case_free(&c);
}

static const law_drive *pull(double rate) {
  static law_drive d;
  d = hold_x;
  d.e_rate[0] = rate;
  return &d;
}

/* sigma = sy + H p + ..., after the onset at t = 0.1. */
TEST(perzyna_is_pulled_and_relaxes) {
  static const double t[] = {.1, .15, .2, .5, 1};
  start("PERZYNA", 0, "100., 1E4, 1E4", 1e5, .3, SOLID_3D);
  law_case_run(&c, pull(1e-2), .05, 1);
  near(c.sigma[0], 50, 1e-12);
  law_case_run(&c, pull(1e-2), .05, 1);
  follow(pull(1e-2), &c.sigma[0], 5, t,
         (double[]){100, 139.5082801338, 164.2255302729, 217.9936082725,
                    264.4586632494},
         400);
  law_case_free(&c);
  start("PERZYNA", 0, "100., 1E4, 1E4", 1e5, .3, SOLID_3D);
  stretch(2e-3);
  near(c.sigma[0], 200, 1e-12);
  law_case_run(&c, &hold_x, 4, 4000);
  near(c.sigma[0], 109.0909090909, 1e-9);
  law_case_free(&c);
}

TEST(bingham_flows_with_its_overstress) {
  start("BINGHAM", 0, "100., 1E4", 1e5, .3, SOLID_3D);
  load(150);
  law_case_run(&c, &hold_none, 3, 3);
  near(c.ei[0], 3 * 50 / 1e4, 1e-12);
  near(c.ei[1], -1.5 * 50 / 1e4, 1e-12);
  law_case_free(&c);
}

/* dp more of plastic strain in a direction, by Heun's method; overstress K, so
 * that the rate is 1. Returns the back stress of a bar, C a_xx. */
static double flow_along(double direction, double dp, int n) {
  double first[7], from[7], second[7], ei_rate[6];
  const double C = c.value[5], h = dp / n;
  for (int k = 0; k < n; ++k) {
    memcpy(from, c.alpha, sizeof from);
    for (int half = 0; half < 2; ++half) {
      c.sigma[0] = C * c.alpha[1] + direction * c.value[1];
      law_point p = law_case_point(&c);
      law_rate(&p, ei_rate, half == 0 ? first : second);
      near(ei_rate[0], direction, 1e-9);
      for (int i = 0; i < 7; ++i)
        c.alpha[i] =
            from[i] + h * (half == 0 ? first[i] : (first[i] + second[i]) / 2);
    }
  }
  return C * c.alpha[1];
}

/* C/g (1 - exp(-g p)) at first; cycles of width dp of plastic strain end with
 * the amplitude C/g tanh(g dp/2). */
TEST(armstrong_frederick_back_stress) {
  start("CHABOCHE", 0, "0., 1., 1.\n2E4, 100.", 1e5, .3, SOLID_3D);
  (void)law_case_point(&c);
  near(flow_along(1, .01, 1000), 126.4241117657, 1e-6);
  double X = 0;
  for (int k = 0; k < 20; ++k) X = flow_along(k % 2 == 0 ? -1 : 1, .01, 1000);
  near(X, 92.4234314520, 1e-6);
  law_case_free(&c);
}

/* E = 1e5, strain +-1 % at the rate 0.01, two back stresses (scipy). */
TEST(chaboche_cycles) {
  start("CHABOCHE", 0, "60., 150., 3., 20., 50.\n2E4, 100.\n5E3, 20.", 1e5, .3,
        SOLID_3D);
  law_case_run(&c, pull(1e-2), 1, 4000);
  near(c.sigma[0], 239.072962066, 1e-8);
  near(c.alpha[0], 0.00760927037934, 1e-8);
  near(2e4 * c.alpha[1], 106.553383323, 1e-8);
  near(5e3 * c.alpha[7], 35.2927418599, 1e-8);
  for (int k = 0; k < 9; ++k)
    law_case_run(&c, pull(k % 2 == 0 ? -1e-2 : 1e-2), 2, 4000);
  near(c.sigma[0], -272.113562482, 1e-8);
  near(c.alpha[0], 0.13991809025, 1e-8);
  near(2e4 * c.alpha[1], -124.605840355, 1e-8);
  near(5e3 * c.alpha[7], -36.3974215337, 1e-8);
  law_case_free(&c);
}

/* Uniaxial stress in plane stress, axisymmetry and 3-D is that of a bar. */
TEST(a_bar_is_a_bar_in_every_kinematics) {
  static const kinematics kin[] = {SOLID_3D, PLANE_STRESS, AXISYMMETRIC};
  for (int k = 0; law_list[k] != NULL; ++k) {
    double e[3][4];
    for (int i = 0; i < 3; ++i) {
      ck_assert_int_eq(law_case_new(law_list[k], 0, NULL, 1e5, .3, kin[i], &c),
                       1);
      c.t = 1;
      load(150);
      law_case_run(&c, &hold_none, .01, 20);
      memcpy(e[i], c.e, sizeof e[i]);
      law_case_free(&c);
      near(e[i][0], e[0][0], 1e-13);
      near(e[i][1], e[0][1], 1e-13);
      near(e[i][2], e[0][1], 1e-13);
    }
  }
}

/* Tension with shear xy, then compression with shear yz (scipy, 3x3 tensors):
 * stresses xx, yy, zz, xy, yz and p. */
TEST(chaboche_turns_with_the_path) {
  start("CHABOCHE", 0, "60., 150., 3., 20., 50.\n2E4, 100.\n5E3, 20.", 1e5, .3,
        SOLID_3D);
  const law_drive first = {.held = {1, 1, 1, 1, 1, 1},
                           .e_rate = {1e-2, 0, 0, 2e-2}};
  const law_drive then = {.held = {1, 1, 1, 1, 1, 1},
                          .e_rate = {-1e-2, 0, 0, 0, 1e-2}};
  law_case_run(&c, &first, .5, 4000);
  law_case_run(&c, &then, .5, 4000);
  near(c.sigma[0], -48.178260941, 1e-8);
  near(c.sigma[1], 24.08913047, 1e-8);
  near(c.sigma[2], 24.08913047, 1e-8);
  near(c.sigma[3], 51.972608625, 1e-8);
  near(c.sigma[4], 62.120000018, 1e-8);
  near(c.alpha[0], 0.0079002112365, 1e-8);
  law_case_free(&c);
}

UNIT_MAIN("law_history")
