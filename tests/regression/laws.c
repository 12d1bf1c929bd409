/*
 * Numbers of the inelastic laws as a deck gets them, beyond those of visco.c:
 * a square in homogeneous stress, exact on its mesh, so that errors are
 * those of time; E = 1000, nu = 0.3 and times near 2 unless said otherwise.
 */
#include "support/block_file.h"
#include "support/job.h"
#include "support/unit.h"

const int job_without_fields = 1;

typedef struct scene {
  const char *elastic, *law; /* line of *ELASTIC; cards of the law            */
  const char *section;       /* TYPE=                                         */
  const char *model;         /* cards before the first step                   */
  const char *load;          /* cards of the first step, *STATIC; NULL: none  */
  const char *visco;         /* from *VISCO on, its line and cards            */
} scene;

#define TABLES "*PRINT, ELEMENTS, ENERGY\n*OUTPUT, HDF5=NO\n"

static job run_scene(const scene *s, int expected) {
  job j = job_begin("laws");
  char first[1024] = "";
  job_copy(&j, "tests/regression/bad/square.msh");
  if (s->load != NULL)
    snprintf(first, sizeof first, "*STEP\n*STATIC\n%s" TABLES "*END STEP\n",
             s->load);
  job_write(&j, "laws.inp",
            "*MESH, FILE=square.msh\n*MATERIAL, NAME=M\n*ELASTIC\n%s\n%s"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=%s\n%s%s"
            "*STEP\n%s" TABLES "*END STEP\n",
            s->elastic, s->law, s->section, s->model, first, s->visco);
  CK_EXIT(job_run(&j, "--no-timing"), expected, j);
  return j;
}

/* Table number k of the elements: all have that value. */
static void all_have(const job *j, int k, const char *column, double expected,
                     double tolerance) {
  DAT d = job_table(j, "ELEMENTS", k);
  for (int i = 0; i < d.n_row; ++i)
    ck_assert_msg(fabs(dat_at(&d, i, column) - expected) <= tolerance,
                  "%s of table %d: %.12g, expected %.12g to %g", column, k,
                  dat_at(&d, i, column), expected, tolerance);
}

#define SOFT "1000., 0.3"
#define HARD "1.E5, 0.3"
#define ZENER "*INELASTIC, LAW=ZENER\n500., 3000.\n"
#define KELVIN "*INELASTIC, LAW=KELVIN\n500., 3000.\n"
#define BURGERS "*INELASTIC, LAW=BURGERS\n8000., 500., 3000.\n"
#define DEVIATORIC "*INELASTIC, LAW=MAXWELL, TYPE=DEVIATORIC\n2.\n"
#define SYMMETRY "*BOUNDARY\nLEFT, 1\nBOTTOM, 2\n"
#define HELD SYMMETRY "TOP, 2, 2, 1.E-3\n"
#define PULL(t) SYMMETRY "*DSLOAD\nTOP, TY, " #t "\n"
#define WALLS SYMMETRY "RIGHT, 1\n*DSLOAD\nTOP, TY, 1.\n"
#define WARM "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nBODY, 50.\n"
/* 2 at 50 degrees: times 10^(17.44*30/81.6) at 20 */
#define TAU "5161723.080836164\n"

/* Values of a column at table numbers k. */
typedef struct closed_form {
  scene s;
  const char *column;
  int n, k[4];
  double value[4], tolerance;
} closed_form;

/* clang-format off */
static const closed_form forms[] = {
  /* lateral over axial stress of confined creep */
  {{SOFT, DEVIATORIC, "CPE3", "", WALLS, "*VISCO, INTEGRATOR=RK4\n0.1, 10.\n"},
   "stress_xx", 4, {0, 10, 20, 100},
   {.4285714286, .5806878287, .6923102802, .9741347234}, 1e-8},
  /* the strain of the Kelvin-Voigt unit alone, in both spellings */
  {{SOFT, KELVIN, "CPS3", "", PULL(1.), "*VISCO, INTEGRATOR=RK4\n0.25, 30.\n"},
   "ei_yy", 4, {0, 4, 24, 120},
   {0, 3.0703655e-4, 1.26424112e-3, 1.98652411e-3}, 1e-9},
  {{SOFT, ZENER, "CPS3", "", PULL(1.), "*VISCO, INTEGRATOR=RK4\n0.25, 30.\n"},
   "ei_yy", 4, {0, 4, 24, 120},
   {0, 3.0703655e-4, 1.26424112e-3, 1.98652411e-3}, 1e-9},
  {{SOFT, KELVIN, "CPS3", "", HELD,
    "*VISCO, INTEGRATOR=EXPONENTIAL\n0.25, 30.\n"}, "stress_yy",
   4, {0, 4, 24, 120}, {1, .7376871065, .3665247122, .3333335373}, 1e-9},
  /* behind a spring as stiff as none: implicit steps only */
  {{"1.E12, 0.3", KELVIN, "CPS3", "", PULL(1.),
    "*VISCO, INTEGRATOR=BACKWARD\n0.05, 6.\n"}, "strain_yy",
   2, {0, 120}, {1e-12, 1.26424112e-3}, 5e-6},
  /* 1/E + t/eta_M + (1 - exp(-t E_K/eta_K))/E_K, and its ei */
  {{SOFT, BURGERS, "CPS3", "", PULL(2.), "*VISCO, INTEGRATOR=RK4\n0.25, 6.\n"},
   "strain_yy", 2, {0, 24}, {2e-3, 2*(1e-3 + 6/8000. + 0.63212055883/500)},
   1e-9},
  /* by the exponential of the 2x2 matrix (scipy) */
  {{SOFT, BURGERS, "CPS3", "", HELD,
    "*VISCO, INTEGRATOR=EXPONENTIAL\n0.25, 30.\n"}, "stress_yy",
   4, {0, 4, 24, 120},
   {1, 0.6518331298418, 0.2138496165521, 0.08209058469504}, 1e-9},
  /* Prony in shear: G = 1000 after all has relaxed, 2000 at once */
  {{"2600., 0.3", "*VISCOELASTIC, TIME=PRONY\n0.3, 0., 0.5\n0.2, 0., 4.\n",
    "CPE3", "", "*BOUNDARY\nBOTTOM, 1, 2\nTOP, 1, 1, 1.E-3\nTOP, 2\nLEFT, 2\n"
    "RIGHT, 2\n", "*VISCO, INTEGRATOR=EXPONENTIAL\n0.5, 3.\n"}, "stress_xy",
   2, {0, 6}, {2, 2*(0.5 + .3*0.00247875217667 + .2*0.47236655274101)}, 1e-8},
  /* plane stress: J/3 of the shear plus J/9 of the volume, which relax by
   * other parts, so that the lateral strain does not keep its ratio */
  {{SOFT, "*INELASTIC, LAW=PRONY\n0.5, 0.2, 2.\n", "CPS3", "", PULL(1.),
    "*VISCO, INTEGRATOR=MIDPOINT\n0.1, 10.\n"}, "strain_yy",
   4, {0, 10, 20, 100},
   {1e-3, 1.2026953198e-3, 1.3593624628e-3, 1.8282491466e-3}, 1e-7},
  {{SOFT, "*INELASTIC, LAW=PRONY\n0.5, 0.2, 2.\n", "CPS3", "", PULL(1.),
    "*VISCO, INTEGRATOR=EXPONENTIAL\n0.1, 10.\n"}, "strain_yy",
   4, {0, 10, 20, 100},
   {1e-3, 1.2026953198e-3, 1.3593624628e-3, 1.8282491466e-3}, 1e-7},
  /* and over thirty decades: 0.5 + 0.2 exp(-t) */
  {{SOFT, "*INELASTIC, LAW=PRONY\n0.3, 0.3, 1E-15\n0.2, 0.2, 1.\n"
    "0.1, 0.1, 1E15\n", "CPS3", "", HELD,
    "*VISCO, INTEGRATOR=EXPONENTIAL\n0.5, 2.\n"}, "stress_yy",
   2, {2, 4}, {.5735758882, .5270670566}, 1e-9},
  /* a fluid as thin as water beside the increment keeps its pressure, also
   * where its time follows the temperature: K (e_xx + e_yy + e_zz) */
  {{SOFT, "*INELASTIC, LAW=MAXWELL, TYPE=DEVIATORIC\n1E-10\n", "CPE3", "",
    HELD "RIGHT, 1\n", "*VISCO, INTEGRATOR=EXPONENTIAL\n0.5, 2.\n"},
   "stress_yy", 2, {2, 4}, {.8333333333, .8333333333}, 1e-9},
  {{SOFT, "*INELASTIC, LAW=MAXWELL, TYPE=DEVIATORIC, SHIFT=WLF, T_REF=20.,"
    " C1=17.44, C2=51.6\n2E-4\n", "CPE3", WARM, HELD "RIGHT, 1\n",
    "*VISCO, INTEGRATOR=BACKWARD\n0.5, 2.\n*TEMPERATURE\nBODY, 50.1\n"},
   "stress_yy", 2, {2, 4}, {.8333333333, .8333333333}, 1e-9},
  /* units of 1E-15, 1 and 1E15 s, each a 1/500 (1 + 0.5/tau)^-n short */
  {{SOFT, "*INELASTIC, LAW=KELVIN\n500., 5E-13\n500., 500.\n500., 5E17\n",
    "CPS3", "", PULL(1.), "*VISCO, INTEGRATOR=BACKWARD\n0.5, 2.\n"},
   "strain_yy", 2, {2, 4}, {4.1111111111e-3, 4.6049382716e-3}, 1e-12},
  {{SOFT, "*INELASTIC, LAW=KELVIN\n500., 5E-13\n500., 500.\n500., 5E17\n",
    "CPS3", "", PULL(1.), "*VISCO, INTEGRATOR=EXPONENTIAL\n0.5, 2.\n"},
   "strain_yy", 2, {2, 4}, {4.2642411177e-3, 4.7293294335e-3}, 1e-12},
  /* from 200 the overstress goes: s = 200 - (100/1.1)(1 - exp(-11 t)) */
  {{HARD, "*INELASTIC, LAW=PERZYNA\n100., 1.E4, 1.E4\n", "CPS3", "",
    SYMMETRY "TOP, 2, 2, 2.E-3\n", "*VISCO, INTEGRATOR=RK4\n0.01, 2.\n"},
   "stress_yy", 3, {0, 10, 200},
   {200, 109.0909090909 + 90.9090909091*0.33287108369808, 109.0909090909},
   1e-4},
  /* relaxation times 2 at 50 degrees by WLF from 20 */
  {{SOFT, "*INELASTIC, LAW=MAXWELL, SHIFT=WLF, T_REF=20., C1=17.44, C2=51.6\n"
    TAU, "CPS3", WARM, HELD, "*VISCO, INTEGRATOR=RK4\n0.1, 2.\n"},
   "stress_yy", 1, {20}, {.3678794412}, 1e-7},
  {{SOFT, "*INELASTIC, LAW=MAXWELL\n" TAU "*TRS, DEFINITION=WLF\n"
    "20., 17.44, 51.6\n", "CPS3", WARM, HELD,
    "*VISCO, INTEGRATOR=RK4\n0.1, 2.\n"},
   "stress_yy", 1, {20}, {.3678794412}, 1e-7},
  {{SOFT, "*VISCOELASTIC, TIME=PRONY\n0.5, 0.5, " TAU
    "*TRS\n20., 17.44, 51.6\n", "CPS3", WARM, HELD,
    "*VISCO, INTEGRATOR=RK4\n0.1, 2.\n"},
   "stress_yy", 2, {0, 20}, {2, 1 + .3678794412}, 1e-6},
  {{SOFT, "*VISCOELASTIC, TIME=PRONY\n0.5, 0.5, " TAU
    "*TRS\n20., 17.44, 51.6\n", "CPS3", WARM, HELD,
    "*VISCO, INTEGRATOR=BACKWARD\n0.25, 2.\n"},
   "stress_yy", 2, {0, 8}, {2, 1 + 0.3897443431}, 1e-8},
  /* hyperbolic sine: 1e-4 sinh(1)^3 under 100, in both spellings */
  {{HARD, "*CREEP, LAW=HYPERB\n1.E-4, 0.01, 3., 0., 8.314\n", "CPS3", "",
    PULL(100.), "*VISCO, INTEGRATOR=EULER\n0.5, 2.\n"}, "ei_yy",
   2, {0, 4}, {0, 2e-4*1.6230678366}, 1e-10},
  /* with exp(-1) at 50 degrees: dH = R T, T = 323.15 */
  {{HARD, "*INELASTIC, LAW=HYPERBOLIC, T_ZERO=-273.15\n"
    "1.E-4, 0.01, 3., 2686.6691, 8.314\n", "CPS3", WARM, PULL(100.),
    "*VISCO, INTEGRATOR=EULER\n0.5, 2.\n"}, "ei_yy",
   2, {0, 4}, {0, 2e-4*1.6230678366*.3678794412}, 1e-10},
  /* relaxation for n = 1: tanh(B s/2) = tanh(B s0/2) exp(-E A B t) */
  {{HARD, "*CREEP, LAW=HYPERB\n1.E-3, 0.01, 1., 0., 8.314\n", "CPS3", "", HELD,
    "*VISCO, INTEGRATOR=RK4\n0.02, 2.\n"}, "stress_yy",
   2, {0, 100}, {100, 12.524497555}, 1e-5},
};
/* clang-format on */

TESTS(closed_forms, (int)(sizeof forms / sizeof *forms)) {
  const closed_form *f = &forms[_i];
  JOB j = run_scene(&f->s, 0);
  for (int i = 0; i < f->n; ++i)
    all_have(&j, f->k[i], f->column, f->value[i], f->tolerance);
  ck_assert_double_le(
      fabs(job_value(&j, "ENERGY", -1, "energy_defect_relative")), 1e-10);
}

/* Simpson's rule for the reduced time: the integral of 10^(c1 (T - T0)/(c2 + T
 * - T0)) while T rises from 20 to 50 in 2 s. */
static double reduced_time(void) {
  double sum = 0;
  enum { N = 2000 };
  for (int i = 0; i <= N; ++i) {
    double over = 30.0 * i / N;
    sum += (i == 0 || i == N ? 1
            : i % 2 == 0     ? 2
                             : 4) *
           pow(10, 17.44 * over / (51.6 + over));
  }
  return sum * 2 / N / 3;
}

/* A held strain while the clock runs faster and faster: exp(-xi/tau). */
TEST(reduced_time_of_a_body_that_warms_up) {
  scene s = {SOFT,
             "*INELASTIC, LAW=MAXWELL\n1.E6\n*TRS, DEFINITION=WLF\n"
             "20., 17.44, 51.6\n",
             "CPS3",
             "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nBODY, 20.\n",
             HELD,
             "*VISCO, INTEGRATOR=MIDPOINT\n0.005, 2.\n"
             "*TEMPERATURE\nBODY, 50.\n"};
  JOB j = run_scene(&s, 0);
  all_have(&j, -1, "stress_yy", exp(-reduced_time() / 1e6), 1e-5);
}

/* The stress falls from 100 to 80 at t = 2, m = -1/2, n = 5, A = 1e-15: time
 * hardening goes on with the rate of t = 2, strain hardening with that of the
 * time at which 80 would have led to the same strain, 2 (100/80)^(5/(1 + m)).
 */
TEST(hardening_after_a_change_of_stress) {
  static const char *const law[] = {"TIME", "STRAIN"};
  const double one = 1e-5, two = 1e-5 * pow(0.8, 5);
  const double first = 2 * one * sqrt(2), at = 2 * pow(1.25, 10);
  const double expected[] = {first + 2 * two * (sqrt(4) - sqrt(2)),
                             2 * two * sqrt(at + 2)};
  ck_assert_double_eq_tol(2 * two * sqrt(at), first, 1e-15);
  for (int k = 0; k < 2; ++k) {
    PRINTED(cards, "*CREEP, LAW=%s\n1.E-15, 5., -0.5\n", law[k]);
    scene s = {
        HARD,
        cards,
        "CPS3",
        "",
        NULL,
        "*VISCO, INTEGRATOR=MIDPOINT, TOLERANCE=1.E-5\n1.E-5, 2.\n" SYMMETRY
        "*DSLOAD\nTOP, TY, \"100 + 0*t\"\n*OUTPUT, HDF5=NO\n*END STEP\n"
        "*STEP\n*VISCO, INTEGRATOR=MIDPOINT\n0.01, 2.\n"
        "*DSLOAD\nTOP, TY, \"80 + 0*t\"\n"};
    JOB j = run_scene(&s, 0);
    all_have(&j, -1, "ei_yy", expected[k], 0.01 * expected[k]);
    ck_assert_double_gt(fabs(expected[1] - expected[0]), 0.03 * expected[0]);
  }
}

#define CHABOCHE(K) "*INELASTIC, LAW=CHABOCHE\n50., " #K ", 1.\n2.E4, 100.\n"
#define SAW(low, high)                                    \
  "*AMPLITUDE, NAME=SAW\n\"" #low " + (" #high " - " #low \
  ")*(0.5 + asin(sin(acos(-1)*(t - 0.5)))/acos(-1))\"\n"

/*
 * Armstrong-Frederick back stress X, C/gamma = 200, gamma = 100: X = 200 (1 -
 * exp(-100 p)) while it is pulled for the first time; in closed loops of
 * plastic width dp between -+200 tanh(100 dp/2). alpha: p, then a_xx, a_yy, ...
 */
TEST(armstrong_frederick_loop) {
  enum { HALF = 50 };
  double high = 0, low = 0, p[2] = {0};
  scene s = {HARD,
             CHABOCHE(100.),
             "CPS3",
             SAW(0., 1.),
             NULL,
             "*VISCO, INTEGRATOR=MIDPOINT\n0.02, 11.\n" SYMMETRY
             "*BOUNDARY, AMPLITUDE=SAW\nTOP, 2, 2, 0.012\n"};
  JOB j = run_scene(&s, 0);
  for (int k = 4; k < 11 * HALF; k += k == HALF - 1 ? 8 * HALF : 5) {
    dat d = job_table(&j, "ELEMENTS", k);
    double X = 2e4 * dat_at(&d, 0, "alpha_3"), all = dat_at(&d, 0, "alpha_1");
    dat_free(&d);
    if (k < HALF)
      ck_assert_double_eq_tol(X, 200 * (1 - exp(-100 * all)), 1e-3 * 200);
    if (k == 9 * HALF - 1) p[0] = all, high = low = X;
    p[1] = all;
    if (k >= 9 * HALF - 1) high = fmax(high, X), low = fmin(low, X);
  }
  double expected = 200 * tanh(100 * (p[1] - p[0]) / 4);
  ck_assert_double_gt(expected, 80);
  ck_assert_double_eq_tol(high, expected, 2e-3 * 200);
  ck_assert_double_eq_tol(low, -expected, 2e-3 * 200);
}

/* Stress to and fro between 150 and -100: the bar gets longer in each cycle by
 * 1/100 log((200^2 - 50^2)/(200^2 - 100^2)) (Lemaitre, Chaboche 1990). */
TEST(a_bar_ratchets) {
  enum { CYCLE = 400 };
  scene s = {HARD,
             CHABOCHE(1.),
             "CPS3",
             SAW(-100., 150.),
             NULL,
             "*VISCO, INTEGRATOR=BACKWARD\n0.005, 4.\n" SYMMETRY
             "*DSLOAD, AMPLITUDE=SAW\nTOP, TY, 1.\n"};
  double e[2];
  JOB j = run_scene(&s, 0);
  for (int k = 0; k < 2; ++k) {
    DAT d = job_table(&j, "ELEMENTS", (k + 1) * CYCLE);
    e[k] = dat_at(&d, 0, "ei_yy");
  }
  ck_assert_double_eq_tol(e[1] - e[0], 0.01 * log(1.25), 0.01 * 0.0022314);
}

/* Limits of an explicit step of a bar: power law 2/(n E A s^(n-1)) = 40 under
 * 100, threshold 2 eta/(E + H) = 0.1818 beyond it, Zener 2 eta/(E0 + E1) = 4.
 * For the first two the program bounds it for strains held in the whole plane,
 * lower by 5 %. */
TEST(explicit_limits) {
  static const struct {
    const char *elastic, *law, *load;
    double limit, below;
  } rows[] = {{HARD, "*CREEP, LAW=NORTON\n1.E-15, 5.\n", HELD, 40, 0.94},
              {HARD, "*INELASTIC, LAW=PERZYNA\n100., 1.E4, 1.E4\n",
               SYMMETRY "TOP, 2, 2, 2.E-3\n", 2e4 / 1.1e5, 0.94},
              {SOFT, ZENER, HELD, 4, 0.99}};
  for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k)
    for (int beyond = 0; beyond < 2; ++beyond) {
      double dt = rows[k].limit * (beyond ? 1.01 : rows[k].below);
      PRINTED(visco, "*VISCO, INTEGRATOR=EULER\n%.15g, %.15g\n", dt, dt);
      scene s = {rows[k].elastic, rows[k].law, "CPS3", "", rows[k].load, visco};
      JOB j = run_scene(&s, beyond ? 2 : 0);
      ck_assert_int_eq(strstr(j.errors, "P2050") != NULL, beyond);
    }
}

/* A bar pulled by 2e-3 that flows from half of that on: nothing moves at the
 * start of the increment, and the rate of its stages is 5.5 times what is
 * stable. With r = (E + H)/eta = 11 the strain that has flowed is E 2e-3/(E +
 * H) (0.5 - (1 - exp(-r/2))/r). Cut increments have an error of their own. */
TEST(stages_beyond_the_limit_cut_the_increment) {
  static const char *const schemes[] = {"HEUN", "RK4", "HEUN, TOLERANCE=0.5",
                                        "RK4, TOLERANCE=0.5"};
  const double flowed = 2e-3 / 1.1 * (0.5 - (1 - exp(-5.5)) / 11);
  for (int k = 0; k < 4; ++k)
    for (int cut = k > 1; cut < 2; ++cut) {
      PRINTED(visco,
              "*VISCO, INTEGRATOR=%s%s\n1., 1.%s\n" SYMMETRY
              "TOP, 2, 2, 2.E-3\n*ACCURACY, TIME=YES, MESH=NO\n",
              schemes[k], cut && k < 2 ? ", SUBSTEPS=AUTO" : "",
              k < 2 ? "" : ", 1.");
      scene s = {HARD,   "*INELASTIC, LAW=PERZYNA\n100., 1.E4, 1.E4\n",
                 "CPS3", "",
                 NULL,   visco};
      JOB j = run_scene(&s, cut ? 0 : 2);
      if (cut) {
        char *sta = job_file(&j, "sta"), *row = strstr(sta, "CUT UNSTABLE");
        all_have(&j, -1, "stress_yy", 1e5 * (2e-3 - flowed), 2);
        ck_assert_ptr_nonnull(row);
        for (; row != NULL; row = strstr(row + 1, "0.000 OK"))
          ck_assert_int_ne(row[-21], '-'); /* steps[%] */
        free(sta);
      } else
        ck_assert_ptr_nonnull(strstr(j.errors, "not with dt = 1; give"));
    }
}

/* A Maxwell bar is held between its floor and 1e-3, lifted within a quarter of
 * its relaxation time and, in a step of its own, pressed to 1e-3 again at once:
 * its stress is what has flowed, in units of E 1e-3
 *   2 s, s = 2 log(1 + exp(-1)/4) the time of the lift until no stress is left.
 * Before that step nothing but strains tells the error of the increments. */
TESTS(error_of_the_steps_goes_through_a_body_without_stress, 2) {
  static const char *const press[] = {"VISCO, INTEGRATOR=BACKWARD",
                                      "QUASISTATIC"};
  PRINTED(visco,
          "*VISCO, INTEGRATOR=BACKWARD\n0.5, 2.5\n*BOUNDARY\nLEFT, 1\n"
          "TOP, 2, 2, -1.E-3, LIFT\n*ACCURACY, TIME=YES, MESH=NO\n" TABLES
          "*END STEP\n*STEP\n*%s\n5.E-7, 1.E-6\n"
          "*BOUNDARY\nTOP, 2, 2, -1.E-3\n",
          press[_i]);
  scene s = {SOFT,
             "*INELASTIC, LAW=MAXWELL\n2.\n",
             "CPS3",
             "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
             "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
             "*AMPLITUDE, NAME=LIFT\n0., 1.\n2., 1.\n2.5, 0.\n",
             NULL,
             visco};
  JOB j = run_scene(&s, 0);
  const double stress = -job_value(&j, "ELEMENTS", -1, "stress_yy");
  const double exact = 4 * log(1 + exp(-1) / 4);
  const double error = 100 * fabs(stress - exact) / stress;
  const double told = job_told(&j, "time_error_percent");
  ck_assert_double_eq_tol(stress, pow(1.25, -4), 1e-6);
  ck_assert_msg(told > 0.5 * error && told < 1.5 * error, "%g told, %g true",
                told, error);
}

/* MIDPOINT takes all stress of a held bar in an increment of twice its
 * relaxation time, and exp(-2) of it is left in truth: that is the error, in
 * the place of none. Such an increment is cut where they are chosen. */
TESTS(error_of_the_steps_of_stress_relaxed_at_once, 2) {
  PRINTED(visco,
          "*STATIC\n*BOUNDARY\nLEFT, 1\nTOP, %s2, 2, -1.E-3\n*END STEP\n"
          "*STEP\n*VISCO, INTEGRATOR=MIDPOINT\n4., 4.\n"
          "*ACCURACY, MESH=YES, TIME=%s\n",
          _i == 0 ? "" : "1\nTOP, ", _i == 0 ? "YES" : "BALANCED");
  scene s = {SOFT,
             "*INELASTIC, LAW=MAXWELL\n2.\n",
             "CPS3",
             "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
             "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n",
             NULL,
             visco};
  JOB j = run_scene(&s, 0);
  if (_i == 0)
    ck_assert_double_eq_tol(job_told(&j, "time_error_percent"), 100 * exp(-2.0),
                            5);
  else
    ck_assert_double_ge(job_value(&j, "ENERGY", -1, "increment"), 8);
}

/* Creep at constant volume locks linear elements, but not in plane stress; one
 * that swells does not. A step that is not *VISCO says that nothing flows. */
TEST(locking_creep_is_told) {
  static const struct {
    const char *law, *section;
    int locks;
  } rows[] = {{DEVIATORIC, "CPE3", 1},
              {DEVIATORIC, "CPS3", 0},
              {"*CREEP, LAW=NORTON\n1.E-15, 5.\n", "CAX3", 1},
              {"*INELASTIC, LAW=MAXWELL\n2.\n", "CPE3", 0},
              {"*INELASTIC, LAW=PRONY\n0.5, 0.5, 2.\n", "CPE3", 0}};
  for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
    scene s = {SOFT, rows[k].law, rows[k].section,
               "",   HELD,        "*VISCO, INTEGRATOR=MIDPOINT\n0.5, 1.\n"};
    JOB j = run_scene(&s, 0);
    ck_assert_int_eq(strstr(j.errors, "P2055") != NULL, rows[k].locks);
    FREED char *lst = job_file(&j, "lst");
    char *held = strstr(lst, "no inelastic strain grows in this step");
    ck_assert_ptr_nonnull(held);
    ck_assert_ptr_null(strstr(held + 1, "no inelastic strain grows"));
  }
}

/* No increment of the second step comes as far as its contact. */
static job run_without_state(const char *second) {
  job j = job_begin("fast");
  block_file_write(&j, (int[]){2, 2}, (double[]){1.0, 1.0}, 0);
  job_write(&j, "fast.inp",
            "*MESH, FILE=block.msh\n*MATERIAL, NAME=M\n*ELASTIC\n2.1E5, 0.3\n"
            "*CREEP, LAW=STRAIN\n1e-5, 10.\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
            "*CONTACT, NAME=C, GROUP=CONTACT, OBSTACLE=O\n"
            "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n"
            "*STEP\n*STATIC\n1E5\n*BOUNDARY\nLEFT, 1, 1, 0.\n"
            "*DSLOAD\nTOP, P, 2e8\n*END STEP\n*STEP\n"
            "*VISCO, INTEGRATOR=BACKWARD\n%s\n*PRINT, CONTACT\n*END STEP\n",
            second);
  return j;
}

TEST(creep_without_a_state_is_not_settled) {
  JOB j = run_without_state("0.5, 1.");
  CK_EXIT(job_run(&j, ""), 1, j);
  ck_assert_ptr_nonnull(strstr(j.errors, "P4017"));
}

/* Up to 1e11 increments would follow, or 120. */
TEST(increments_that_never_settle_end) {
  JOB j = run_without_state("0.5, 1E5, 1E-6"), k;
  k = run_without_state("0.5, 30., 0.25");
  int code = job_shell(&j, "timeout 100 protis fast");
  ck_assert_msg(code == 6 && strstr(j.errors, "in a row are not settled"),
                "exit %d: %s", code, j.errors);
  ck_assert_int_eq(job_run(&k, ""), 1);
}

UNIT_MAIN("laws")
