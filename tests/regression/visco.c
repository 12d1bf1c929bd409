/*
 * Inelastic strains: homogeneous bodies, exact in space, against closed forms
 * (E = 1000, nu = 0.3, relaxation time 2 unless said otherwise), energies, and
 * what elastic groups cost.
 */
#include "support/square_case.h"
#include "support/unit.h"

const int job_without_fields = 1;

#define WALLS SYMMETRY "RIGHT, 1\n"
#define PULL(t) "*DSLOAD\nTOP, TY, " #t "\n"

/* Values of a column at table numbers k, of scale "scale". */
typedef struct closed_form {
  square_case s;
  const char *column;
  int n, k[4];
  double value[4], tolerance;
} closed_form;

/* clang-format off */
static const closed_form forms[] = {
  /* held strain, the whole stress relaxes */
  {{STEEL, PROPORTIONAL, "CPS3", "", HELD,
    "*VISCO, INTEGRATOR=EXPONENTIAL\n0.5, 10.\n"}, "stress_yy",
   4, {0, 2, 4, 20}, {1, .6065306597, .3678794412, .0067379470}, 1e-9},
  /* its deviator, the sides free */
  {{STEEL, DEVIATORIC, "CPS3", "", HELD,
    "*VISCO, INTEGRATOR=RK4\n0.1, 10.\n"}, "stress_yy",
   4, {0, 10, 20, 100}, {1, .6483443410, .4203503845, .0131237287}, 1e-7},
  /* confined */
  {{STEEL, DEVIATORIC, "CPE3", "", WALLS "TOP, 2, 2, 1.E-3\n",
    "*VISCO, INTEGRATOR=EXPONENTIAL\n0.5, 10.\n"}, "stress_yy",
   4, {0, 2, 4, 20}, {1.3461538462, 1.1443746973, 1.0219894570, .8367886908},
   1e-9},
  {{STEEL, DEVIATORIC, "CPE3", "", WALLS "TOP, 2, 2, 1.E-3\n",
    "*VISCO, INTEGRATOR=EXPONENTIAL\n0.5, 10.\n"}, "stress_xx",
   4, {0, 2, 4, 20}, {.5769230769, .6778126514, .7390052715, .8316056547},
   1e-9},
  /* creep: the rate is constant, Euler exact */
  {{STEEL, DEVIATORIC, "CPS3", "", SYMMETRY PULL(1.),
    "*VISCO, INTEGRATOR=EULER\n1., 10.\n"}, "strain_yy",
   4, {0, 1, 2, 10}, {.001, .0014333333333, .0018666666667, .0053333333333},
   1e-12},
  /* creep, confined */
  {{STEEL, DEVIATORIC, "CPE3", "", WALLS PULL(1.),
    "*VISCO, INTEGRATOR=RK4\n0.1, 10.\n"}, "strain_yy",
   4, {0, 10, 20, 100},
   {7.428571e-4, 8.645502629e-4, 9.538482242e-4, 1.179307779e-3}, 1e-9},
  /* creep in plane strain */
  {{STEEL, DEVIATORIC, "CPE3", "", SYMMETRY PULL(1.),
    "*VISCO, INTEGRATOR=RK4\n0.1, 10.\n"}, "stress_zz",
   4, {0, 10, 20, 100}, {.3, .3703311318, .4159299231, .4973752543}, 1e-6},
  {{STEEL, DEVIATORIC, "CPE3", "", SYMMETRY PULL(1.),
    "*VISCO, INTEGRATOR=RK4\n0.1, 10.\n"}, "strain_yy",
   4, {0, 10, 20, 100}, {9.1e-4, 1.249066226e-3, 1.583185985e-3,
   4.199475051e-3}, 1e-9},
  /* strain of constant rate 1e-3 */
  {{STEEL, PROPORTIONAL, "CPS3", "", SYMMETRY "TOP, 2\n",
    "*VISCO, INTEGRATOR=EXPONENTIAL\n0.5, 10.\n*BOUNDARY\nTOP, 2, 2, 1.E-2\n"},
   "stress_yy", 3, {2, 4, 20}, {.7869386806, 1.2642411177, 1.9865241060},
   1e-8},
  /* Zener: E1 = 500, eta1 = 3000 */
  {{STEEL, "*INELASTIC, LAW=ZENER\n500., 3000.\n", "CPS3", "",
    SYMMETRY PULL(1.), "*VISCO, INTEGRATOR=RK4\n0.25, 30.\n"}, "strain_yy",
   4, {0, 4, 24, 120}, {.001, .00130703655, .00226424112, .00298652411}, 1e-9},
  {{STEEL, "*INELASTIC, LAW=ZENER\n500., 3000.\n", "CPS3", "", HELD,
    "*VISCO, INTEGRATOR=EXPONENTIAL\n0.25, 30.\n"}, "stress_yy",
   4, {0, 4, 24, 120}, {1, .7376871065, .3665247122, .3333335373}, 1e-9},
  /* power law: E = 1e5, A = 1e-15, n = 5, from 100 */
  {{"1.E5, 0.3", "*INELASTIC, LAW=NORTON\n1.E-15, 5.\n", "CPS3", "", HELD,
    "*VISCO, INTEGRATOR=RK4\n1., 100.\n"}, "stress_yy",
   4, {0, 1, 10, 100},
   {100, 99.024273574257, 91.932271522492, 66.874030497642}, 1e-5},
  {{"1.E5, 0.3", "*INELASTIC, LAW=NORTON\n1.E-15, 5.\n", "CPS3", "", HELD,
    "*VISCO, INTEGRATOR=MIDPOINT\n1., 100.\n"}, "stress_yy",
   4, {0, 1, 10, 100},
   {100, 99.024273574257, 91.932271522492, 66.874030497642}, 1e-3},
  {{"1.E5, 0.3", "*INELASTIC, LAW=NORTON\n1.E-15, 5.\n", "CPS3", "",
    SYMMETRY PULL(100.), "*VISCO, INTEGRATOR=BACKWARD\n25., 100.\n"},
   "strain_yy", 2, {0, 4}, {1e-3, 2e-3}, 1e-11},
};
/* clang-format on */

TESTS(closed_forms, (int)(sizeof forms / sizeof *forms)) {
  const closed_form *f = &forms[_i];
  JOB j = square_run(&f->s, 0);
  for (int i = 0; i < f->n; ++i)
    square_all_have(&j, f->k[i], f->column, f->value[i], f->tolerance);
  for (int k = 0; k < 3; ++k)
    ck_assert_double_le(fabs(square_energy(&j, k, "energy_defect_relative")),
                        1e-10);
}

/* Bingham, E = 1e5, threshold 100, hardening and viscosity 1e4, strained at
 * 1e-2: elastic up to t = 0.1. */
TEST(viscoplastic_pull) {
  square_case s = {"1.E5, 0.3",
                   "*INELASTIC, LAW=PERZYNA\n100., 1.E4, 1.E4\n",
                   "CPS3",
                   "",
                   SYMMETRY "TOP, 2\n",
                   "*VISCO, INTEGRATOR=RK4\n0.005, 1.\n"
                   "*BOUNDARY\nTOP, 2, 2, 1.E-2\n"};
  JOB j = square_run(&s, 0);
  square_all_have(&j, 10, "stress_yy", 50.0, 1e-9);
  square_all_have(&j, 30, "stress_yy", 139.5082801338, 1e-5);
  square_all_have(&j, 40, "stress_yy", 164.2255302729, 1e-5);
  square_all_have(&j, 100, "stress_yy", 217.9936082725, 1e-5);
  square_all_have(&j, 200, "stress_yy", 264.4586632494, 1e-5);
}

#define SLIDES FLOOR(0.1), PRESS(10.)
#define SUPPORTED "", SYMMETRY PULL(-10.)

/*
 * The stresses work on inelastic strains, by the trapezoidal rule, what the
 * laws dissipate in the quadrature of the integrator and store. The difference
 * of a step of length h under constant loads, rates f:
 *
 * EULER: 1/2 h^2 f'A f if the stresses answer by d sigma = -A d e^i, order 1.
 * MIDPOINT: none.
 * HEUN, with the changes p of the stress by the predictor and d from there on,
 * f* the rates at the predictor: 1/4 h (d'(f* + f) - p'(f* - f)), which for a
 * symmetric A is -1/8 h^2 (f* - f)'A (f* - f), order 3. Friction makes A
 * unsymmetric: order 2 is left, with a small factor.
 */
static const struct {
  const char *integrator, *model, *load;
  double least, most; /* order; 0: no difference                              */
} balances[] = {{"EULER", SLIDES, 0.9, 1.1},
                {"HEUN", SUPPORTED, 2.9, 3.1},
                {"HEUN", SLIDES, 1.9, 3.1},
                {"MIDPOINT", SLIDES, 0, 0}};
enum { N_BALANCE = sizeof balances / sizeof *balances };

/* Work less what is lost and stored, over the work, after n increments; the
 * laws lose in each, and the balance of the body closes. */
static double unbalanced(square_case s, const char *integrator, int n) {
  PRINTED(visco, "*VISCO, INTEGRATOR=%s\n%.17g, 2.\n", integrator, 2.0 / n);
  s.visco = visco;
  JOB j = square_run(&s, 0);
  double lost = 0;
  for (int i = 1; i <= n; ++i) {
    double now = square_energy(&j, i, "viscous_dissipation");
    ck_assert_double_ge(now, lost);
    ck_assert_double_le(fabs(square_energy(&j, i, "energy_defect_relative")),
                        1e-10);
    lost = now;
  }
  ck_assert_double_gt(lost, 0);
  double work = square_energy(&j, -1, "inelastic_work");
  double gap = work - lost - square_energy(&j, -1, "inelastic_stored");
  return gap / work;
}

TESTS(work_is_lost_to_the_order_of_the_quadrature, N_BALANCE) {
  const char *integrator = balances[_i].integrator;
  const square_case s = {
      STEEL, DEVIATORIC, "CPE3", balances[_i].model, balances[_i].load, NULL};
  double a = unbalanced(s, integrator, 16);
  ck_assert_double_le(fabs(a), balances[_i].most == 0 ? 1e-10 : 0.1);
  if (balances[_i].most == 0) return;
  double order = log2(a / unbalanced(s, integrator, 32));
  ck_assert_double_ge(order, balances[_i].least);
  ck_assert_double_le(order, balances[_i].most);
}

/* Laws that store energy, and such with a threshold, lose some in every
 * increment too. */
TESTS(laws_that_store_dissipate, 5) {
  static const char *const laws[] = {
      "*INELASTIC, LAW=KELVIN\n1000., 2000.\n3000., 1000.\n",
      "*INELASTIC, LAW=PRONY\n0.5, 0.1, 2.\n0.2, 0., 5.\n",
      "*INELASTIC, LAW=NORTON\n2.E-6, 3.\n",
      "*INELASTIC, LAW=PERZYNA\n4., 1.E4, 100., 1.5, 1., 10.\n",
      "*INELASTIC, LAW=CHABOCHE\n3., 100., 2., 1., 10.\n200., 10.\n"};
  const square_case s = {STEEL, laws[_i], "CPE3", SLIDES, NULL};
  ck_assert_double_lt(fabs(unbalanced(s, "BACKWARD", 8)), 0.2);
}

/* Radial displacement of the bore in its table number k, and the time. */
static double bore(const job *j, int k, double *t) {
  DAT d = job_table(j, "NODES", k), e = job_table(j, "ENERGY", k);
  double u = dat_sum(&d, "u_r") / d.n_row;
  *t = dat_at(&e, 0, "time");
  return u;
}

/* The bore of the elastic tube, and how fast that of the steady state grows:
 * sqrt(3)/2 A q^n a with the equivalent stress q there. */
static void check_bore(const job *j, int n, double A) {
  const double power = pow(2, 2.0 / n);
  const double q = sqrt(3) * 100 / n * power / (power - 1);
  const double rate = sqrt(3) / 2 * A * pow(q, n);
  double t[2];
  FREED char *text = job_file(j, "dat");
  int last = -1;
  ck_assert_ptr_nonnull(text);
  for (const char *at = text; (at = strstr(at, "table NODES")) != NULL; ++at)
    ++last;
  double start = bore(j, 0, t);
  double before = bore(j, last - 1, t), now = bore(j, last, t + 1);
  ck_assert_double_eq_tol(start, 1.906666667e-3, 0.001 * 1.906666667e-3);
  ck_assert_double_eq_tol((now - before) / (t[1] - t[0]), rate, 0.01 * rate);
  if (n == 5) ck_assert_double_eq_tol(rate / A, 5.1896212233e10, 1e2);
}

/* Stress of the steady state at three radii: mean of two elements each. */
static void steady_ring(int n, double A, const double *expected) {
  static const char *const column[] = {"stress_tt", "stress_rr", "stress_tt"};
  JOB j = job_with(
      "visco", "tests/regression/mesh/strips.geo",
      "*PARAMETER\nN = 75\nX0 = 1\nLY = 1/75\n"
      "*MESH, FILE=strips.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1.E5, 0.3\n"
      "*INELASTIC, LAW=NORTON\n%g, %d\n"
      "*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=CAX3\n"
      "*STEP\n*STATIC\n*BOUNDARY\nBOTTOM, 2\nTOP, 2\n"
      "*DSLOAD\nLEFT, P, 100.\n*PRINT, ELEMENTS, GROUP=FIRST\n"
      "*PRINT, ELEMENTS, GROUP=MIDDLE\n*PRINT, ELEMENTS, GROUP=LAST\n"
      "*PRINT, NODES, GROUP=LEFT\n*PRINT, ENERGY\n"
      "*OUTPUT, HDF5=NO\n*END STEP\n"
      "*STEP\n*VISCO, INTEGRATOR=BACKWARD, TOLERANCE=0.01\n1., 3000.\n"
      "*PRINT, ELEMENTS, GROUP=FIRST, FREQUENCY=0\n"
      "*PRINT, ELEMENTS, GROUP=MIDDLE, FREQUENCY=0\n"
      "*PRINT, ELEMENTS, GROUP=LAST, FREQUENCY=0\n"
      "*PRINT, NODES, GROUP=LEFT\n*PRINT, ENERGY\n*END STEP\n",
      A, n);
  int code = job_run(&j, "");
  ck_assert_msg(code == 0, "n = %d: exit %d: %s", n, code, j.errors);
  for (int k = 0; k < 3; ++k) {
    DAT d = job_table(&j, "ELEMENTS", 3 + k);
    ck_assert_double_eq_tol(dat_sum(&d, column[k]) / d.n_row, expected[k],
                            0.01 * 100);
  }
  check_bore(&j, n, A);
}

/* Tube, radii 1 and 2, inner pressure 100: hoop stress inside, radial stress
 * at 1.5, hoop stress outside; growth of the bore. */
TEST(steady_creep_of_a_tube) {
  static const double third[] = {80.16095893, -35.99137724, 113.49429226};
  static const double fifth[] = {65.19251841, -38.16967948, 125.19251841};
  steady_ring(3, 1e-11, third);
  steady_ring(5, 1e-15, fifth);
}

/* One factor for the elastic body and one for the tangent of a linear law, as
 * long as its coefficients stay; three or four in an increment of a power law;
 * none with initial stresses. */
TEST(factors_are_kept) {
  static const struct {
    const char *law, *visco;
    int least, most;
  } cases[] = {
      {DEVIATORIC, "*VISCO, INTEGRATOR=MIDPOINT\n0.1, 1.\n", 2, 2},
      {DEVIATORIC, "*VISCO, INTEGRATOR=EXPONENTIAL\n0.1, 1.\n", 2, 2},
      {DEVIATORIC, "*VISCO, INTEGRATOR=RK4\n0.1, 1.\n", 1, 1},
      {"*INELASTIC, LAW=NORTON\n1., 5.\n",
       "*VISCO, INTEGRATOR=BACKWARD\n0.1, 1.\n", 21, 61},
      {"*INELASTIC, LAW=NORTON\n0.01, 5.\n",
       "*VISCO, INTEGRATOR=BACKWARD, ITERATION=INITIAL\n0.1, 1.\n", 1, 1},
      /* a coefficient that could vary in time: it stays, changes once (the
       * first increments and the rest), or always */
      {"*INELASTIC, LAW=MAXWELL\n\"2 + 0*t\"\n",
       "*VISCO, INTEGRATOR=BACKWARD\n0.1, 1.\n", 2, 2},
      {"*INELASTIC, LAW=MAXWELL\n\"2 + min(1, max(0, 1E9*(t - 1.55)))\"\n",
       "*VISCO, INTEGRATOR=BACKWARD\n0.1, 1.\n", 3, 3},
      {"*INELASTIC, LAW=MAXWELL\n\"2 + t\"\n",
       "*VISCO, INTEGRATOR=BACKWARD\n0.1, 1.\n", 11, 11},
      /* steps with the same THETA dt share a factor, EXPONENTIAL has its own */
      {DEVIATORIC,
       "*VISCO, INTEGRATOR=BACKWARD\n0.1, 1.\n*END STEP\n*STEP\n"
       "*VISCO, INTEGRATOR=MIDPOINT\n0.2, 1.\n*END STEP\n*STEP\n"
       "*VISCO, INTEGRATOR=EXPONENTIAL\n0.1, 1.\n",
       3, 3}};
  for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
    square_case s = {STEEL,
                     cases[i].law,
                     "CPE3",
                     FLOOR(0.1),
                     "*BOUNDARY\nLEFT, 1\n*DSLOAD\nTOP, P, 1.\n",
                     cases[i].visco};
    JOB j = square_run(&s, 0);
    long calls = job_stage(&j, "factorisation", NULL);
    ck_assert_msg(calls >= cases[i].least && calls <= cases[i].most,
                  "case %zu: %ld factors", i, calls);
  }
}

typedef struct counts {
  long factors, solves, contacts;
} counts;

/* Calls of the stages in a run of steps with friction that slips. */
static counts counts_of(const char *method, const char *visco) {
  PRINTED(cards,
          "*SOLVER, METHOD=%s\n*BOUNDARY\nLEFT, 1\n*DSLOAD\nTOP, P, 1.\n",
          method);
  square_case s = {STEEL, PROPORTIONAL, "CPE3", FLOOR(0.1), cards, visco};
  JOB j = square_run(&s, 0);
  counts c = {job_stage(&j, "factorisation", NULL),
              job_stage(&j, "interior solves", NULL),
              job_stage(&j, "contact solver", NULL)};
  return c;
}

#define MIDPOINT(dt, t) "*VISCO, INTEGRATOR=MIDPOINT\n" dt ", " t "\n"
#define NEXT "*END STEP\n*STEP\n"

/* The elastic body and each THETA dt are factored once, whatever solves the
 * contact; an increment more is a forward and a back solve more. */
TEST(increments_of_one_length_share_a_factor) {
  static const char *const method[] = {"AUTO", "NEWTON", "AITKEN"};
  for (int i = 0; i < 3; ++i) {
    const counts few = counts_of(method[i], MIDPOINT("0.1", "1.")),
                 many = counts_of(method[i], MIDPOINT("0.1", "2.")),
                 other = counts_of(
                     method[i], MIDPOINT("0.1", "0.2") NEXT MIDPOINT(
                                    "0.05", "0.1") NEXT MIDPOINT("0.1", "0.2"));
    ck_assert_int_eq(few.factors, 2);
    ck_assert_int_eq(many.factors, 2);
    ck_assert_int_eq(other.factors, 3);
    ck_assert_int_eq(many.solves - few.solves, 2 * 10);
    ck_assert_int_eq(many.contacts - few.contacts, 10);
  }
}

/* Steps of one THETA dt, which share their matrix but not what they do. */
TEST(each_step_has_its_own_integrator) {
  square_case s = {STEEL,
                   PROPORTIONAL,
                   "CPS3",
                   "",
                   HELD,
                   "*VISCO, INTEGRATOR=BACKWARD\n1., 1.\n*END STEP\n"
                   "*STEP\n*VISCO, INTEGRATOR=MIDPOINT\n2., 2.\n"
                   "*END STEP\n*STEP\n*VISCO, INTEGRATOR=EXPONENTIAL\n"
                   "1., 1.\n*END STEP\n*STEP\n"
                   "*VISCO, INTEGRATOR=THETA, THETA=0.25\n4., 4.\n"};
  JOB j = square_run(&s, 0);
  const double factor[] = {1 / 1.5, 0.5 / 1.5, exp(-0.5), -0.5 / 1.5};
  double stress = 1;
  for (int k = 0; k < 4; ++k) {
    stress *= factor[k];
    square_all_have(&j, k + 1, "stress_yy", stress, 1e-12);
  }
}

#define START_STRAIN \
  "*INITIAL CONDITIONS, TYPE=INELASTIC STRAIN\nBODY, 1, 1.E-3\n"

/* Inelastic strain from before between two walls: a stress that is there at
 * once and dies out; without a *VISCO step it stays. */
TEST(initial_strain_is_a_stress_that_relaxes) {
  square_case s = {STEEL,  PROPORTIONAL,
                   "CPS3", START_STRAIN,
                   WALLS,  "*VISCO, INTEGRATOR=EXPONENTIAL\n1., 2.\n"};
  job j = square_run(&s, 0);
  for (int k = 0; k < 3; ++k) {
    square_all_have(&j, k, "stress_xx", -exp(-0.5 * k), 1e-9);
    square_all_have(&j, k, "stress_yy", 0.0, 1e-9);
    ck_assert_double_le(fabs(square_energy(&j, k, "energy_defect_relative")),
                        1e-10);
  }
  job_end(&j);
  s.visco = "*STATIC\n";
  j = square_run(&s, 0);
  square_all_have(&j, 1, "stress_xx", -1.0, 1e-9);
  job_end(&j);
}

/* A body free of forces: each unit goes back by itself, and what the deck does
 * not give follows from the rest. E = 1000, e^i_yy after 1 s. */
#define INTERNAL(lines) "*INITIAL CONDITIONS, TYPE=INTERNAL\n" lines
#define STRAINED(lines) "*INITIAL CONDITIONS, TYPE=INELASTIC STRAIN\n" lines
#define ONE_UNIT "*INELASTIC, LAW=KELVIN\n700., 500.\n"
#define TWO_UNITS ONE_UNIT "700., 1000.\n"
#define ONE_TERM "*INELASTIC, LAW=PRONY\n0.4, 0.4, 2.\n"
#define BURGERS "*INELASTIC, LAW=BURGERS\n1.E4, 700., 500.\n"
static const struct {
  const char *law, *start;
  double expected; /* / 1e-3; < 0: refused */
} units[] = {
    {"*INELASTIC, LAW=ZENER\n700., 500.\n", STRAINED("BODY, 2, 1.E-3\n"),
     0.246596963941606},
    {ONE_UNIT, STRAINED("BODY, 2, 1.E-3\n"), 0.246596963941606},
    {ONE_UNIT, INTERNAL("BODY, 2, 1.E-3\n"), 0.246596963941606},
    {ONE_TERM, STRAINED("BODY, 2, 1.E-3\n"), 0.740818220681718},
    {ONE_TERM, INTERNAL("BODY, 2, 2.5E-3\n"), 0.740818220681718},
    /* 0.4 and 0.6 of it in the two units: 0.4 exp(-1.4) + 0.6 exp(-0.7) */
    {TWO_UNITS, INTERNAL("BODY, 2, 4.E-4\nBODY, 6, 6.E-4\n"),
     0.396589967857488},
    {TWO_UNITS,
     STRAINED("BODY, 2, 1.E-3\n") INTERNAL("BODY, 2, 4.E-4\nBODY, 6, 6.E-4\n"),
     0.396589967857488},
    {BURGERS, INTERNAL("BODY, 2, 1.E-3\n"), 0.246596963941606},
    {BURGERS, STRAINED("BODY, 2, 1.E-3\n"), 1},
    {BURGERS, STRAINED("BODY, 2, 1.E-3\n") INTERNAL("BODY, 2, 4.E-4\n"),
     0.6 + 0.4 * 0.246596963941606},
    {TWO_UNITS, STRAINED("BODY, 2, 1.E-3\n"), -1},
    {TWO_UNITS, STRAINED("BODY, 2, 1.E-3\n") INTERNAL("BODY, 2, 4.E-4\n"), -1},
    {TWO_UNITS, STRAINED("BODY, 2, 1.E-3\n") INTERNAL("BODY, 2, 1.4E-3\n"), -1},
    {"*INELASTIC, LAW=PRONY\n0.4, 0., 2.\n",
     STRAINED("BODY, 1, 1.E-3\nBODY, 2, 1.E-3\nBODY, 3, 1.E-3\n"), -1}};

TESTS(strains_of_units_and_their_sum_agree,
      (int)(sizeof units / sizeof *units)) {
  const int refused = units[_i].expected < 0;
  const square_case s = {"1000., 0.", units[_i].law,
                         "CPE3",      units[_i].start,
                         SYMMETRY,    "*VISCO, INTEGRATOR=RK4\n0.01, 1.\n"};
  JOB j = square_run(&s, refused ? 2 : 0);
  if (refused) {
    ck_assert_ptr_nonnull(strstr(j.errors, "error P2063: *INITIAL CONDITIONS"));
    ck_assert_int_eq(job_run(&j, "--check"), 2);
  } else {
    square_all_have(&j, 100, "ei_yy", 1e-3 * units[_i].expected, 1e-12);
    square_all_have(&j, 100, "stress_yy", 0, 1e-12);
  }
}

/* A threshold of 100 that hardens by 1e4 p: with p = 0.01 from before 150 does
 * not flow. */
TEST(initial_hardening_counts) {
  square_case s = {"1.E5, 0.3",
                   "*INELASTIC, LAW=PERZYNA\n100., 1.E4, 1.E4\n",
                   "CPS3",
                   "*INITIAL CONDITIONS, TYPE=INTERNAL\nBODY, 1, 0.01\n",
                   SYMMETRY "TOP, 2, 2, 1.5E-3\n",
                   "*VISCO, INTEGRATOR=BACKWARD\n10., 20.\n"};
  job j = square_run(&s, 0);
  square_all_have(&j, 2, "stress_yy", 150.0, 1e-8);
  square_all_have(&j, 2, "alpha_1", 0.01, 1e-15);
  job_end(&j);
  s.model = "";
  j = square_run(&s, 0);
  DAT d = job_table(&j, "ELEMENTS", 2);
  ck_assert_double_lt(dat_at(&d, 0, "stress_yy"), 110.0);
  job_end(&j);
}

/* What changes at once at the start of a *VISCO step: temperatures of a body
 * that is held, its modulus, the end of a support, the rate of a law;
 * relaxation time 1, E = 1000, 2000 when hot. */
#define ONE_SECOND "*INELASTIC, LAW=MAXWELL\n1.\n"
#define SUDDEN "*AMPLITUDE, NAME=ON\n\"1\"\n"
#define HEAT_AT_ONCE "*TEMPERATURE\nBODY, 100., ON\n"
static const struct {
  square_case scene;
  const char *column;
  double expected;
} sudden[] = {
    {{"1000., 0.", "*EXPANSION\n1.E-5\n" ONE_SECOND, "CPS3", SUDDEN,
      SYMMETRY "TOP, 2\n", "*VISCO, INTEGRATOR=HEUN\n0.01, 1.\n" HEAT_AT_ONCE},
     "stress_yy",
     -0.3678794},
    {{"1000., 0., 0.\n2000., 0., 100.", ONE_SECOND, "CPS3", SUDDEN, HELD,
      "*VISCO, INTEGRATOR=HEUN\n0.01, 1.\n" HEAT_AT_ONCE},
     "stress_yy",
     2 * 0.3678794},
    {{"1000., 0.", ONE_SECOND, "CPS3", "", HELD,
      "*VISCO, INTEGRATOR=HEUN\n0.5, 1.\n*BOUNDARY, OP=NEW\nLEFT, 1\n"
      "BOTTOM, 2\n"},
     "strain_yy",
     0.0},
    {{"1000., 0.",
      "*INELASTIC, LAW=MAXWELL, SHIFT=WLF, T_REF=50., C1=2., C2=50.\n10.\n",
      "CPS3", SUDDEN "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nBODY, 50.\n",
      SYMMETRY "*DSLOAD\nTOP, P, -1.\n",
      "*VISCO, INTEGRATOR=HEUN\n0.5, 1.\n*DSLOAD\nTOP, P, -1., "
      "ON\n" HEAT_AT_ONCE},
     "strain_yy",
     2e-3}};

TESTS(what_is_sudden_acts_at_once, (int)(sizeof sudden / sizeof *sudden)) {
  JOB j = square_run(&sudden[_i].scene, 0);
  DAT d = job_table(&j, "ELEMENTS", -1);
  for (int i = 0; i < d.n_row; ++i)
    ck_assert_double_eq_tol(dat_at(&d, i, sudden[_i].column),
                            sudden[_i].expected,
                            3e-5 * fmax(fabs(sudden[_i].expected), 1e-3));
}

/* A foot that stuck slips at once where its friction falls: creep of few
 * increments is that of many. */
TEST(sudden_slip_acts_at_once) {
  double shear[2];
  for (int k = 0; k < 2; ++k) {
    PRINTED(visco,
            "*VISCO, INTEGRATOR=HEUN\n%g, 1.\n"
            "*FRICTION, CONTACT=C, LAW=COULOMB\n0.05\n",
            k == 0 ? 0.1 : 0.01);
    const square_case s = {STEEL,
                           ONE_SECOND,
                           "CPE3",
                           FLOOR(0.8),
                           "*BOUNDARY\nTOP, 1, 1, 0.004\nTOP, 2, 2, -0.01\n",
                           visco};
    JOB j = square_run(&s, 0);
    DAT d = job_table(&j, "ELEMENTS", -1);
    shear[k] = dat_max(&d, "gamma_xy");
  }
  ck_assert_double_eq_tol(shear[0], shear[1], 0.005 * shear[1]);
}

/* A sudden load that friction carries where it acts moves nothing: no increment
 * at the start by any method, whatever their rounding. */
TESTS(sudden_load_on_friction_moves_nothing, 3) {
  static const char *const methods[] = {"AUTO", "AUGLAG", "SOR"};
  JOB j =
      job_with("carried", "tests/regression/mesh/square.geo",
               "*PARAMETER\nN = 3\n*MESH, FILE=square.geo\n"
               "*AMPLITUDE, NAME=A, TIME=TOTAL TIME\n\"0.58 + 0.2*sin(t)\"\n"
               "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
               "*INELASTIC, LAW=MAXWELL\n4.\n"
               "*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=CAX3\n"
               "*OBSTACLE, NAME=O, TYPE=GAP\n0.1\n"
               "*CONTACT, NAME=C, GROUP=RIGHT, OBSTACLE=O\n"
               "*FRICTION, CONTACT=C, LAW=TRESCA\n1.\n"
               "*STEP\n*VISCO, INTEGRATOR=BACKWARD\n0.25, 1.\n"
               "*BOUNDARY\nTOP, 1, 2\nLEFT, 1\n*DSLOAD\nRIGHT, TY, -0.3, A\n"
               "*SOLVER, METHOD=%s\n*PRINT, ENERGY\n*END STEP\n",
               methods[_i]);
  ck_assert_msg(job_run(&j, "--quiet") == 0, "%s", j.errors);
  ck_assert_double_eq(square_energy(&j, -1, "increment"), 4);
}

/* Relaxation time 4 at 0 degrees and 1 at 100: at 50 it is 2.5, without any
 * thermal expansion. */
TEST(temperature_sets_the_relaxation_time) {
  square_case s = {STEEL,  "*INELASTIC, LAW=MAXWELL\n4., , 0.\n1., , 100.\n",
                   "CPS3", "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nBODY, 50.\n",
                   HELD,   "*VISCO, INTEGRATOR=MIDPOINT\n0.01, 1.\n"};
  JOB j = square_run(&s, 0);
  square_all_have(&j, 100, "stress_yy", exp(-1 / 2.5), 1e-5);
}

/* Temperatures that a rate with an activation energy cannot have: known before
 * the run, but for what an expression does within a step. */
#define ARRHENIUS \
  "*INELASTIC, LAW=MAXWELL, SHIFT=ARRHENIUS, T_REF=300., ACTIVATION=1000."
#define STARTS_AT(T) "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nBODY, " #T "\n"
#define BACKWARD "*VISCO, INTEGRATOR=BACKWARD\n0.25, 1.\n"
static const struct {
  square_case scene;
  int early;
  const char *text;
} cold[] = {
    {{STEEL, ARRHENIUS "\n10.\n", "CPS3", STARTS_AT(-10.), HELD, BACKWARD},
     1,
     "error P2062: material M, step 2, time 1, element "},
    {{STEEL, ARRHENIUS ", T_ZERO=-273.15\n10.\n", "CPS3", STARTS_AT(20.), HELD,
      BACKWARD "*TEMPERATURE\nBODY, -273.15\n"},
     1,
     ": the temperature -273.15 is not above absolute zero, T_ZERO = -273.15"},
    {{STEEL, "*INELASTIC, LAW=HYPERBOLIC\n1.E-4, 0.01, 3., 100.\n", "CPS3", "",
      HELD, BACKWARD},
     1,
     ": the temperature 0 is not above absolute zero, T_ZERO = 0"},
    {{STEEL, ARRHENIUS "\n10.\n", "CPS3", STARTS_AT(300.), HELD,
      BACKWARD "*TEMPERATURE\nBODY, \"300 - 700*(t > 1.4)*(t < 1.6)\"\n"},
     0,
     "material M: time 1.5: the temperature -400 is not above absolute zero"},
    {{STEEL, ARRHENIUS "\n10.\n", "CPS3", STARTS_AT(300.), HELD,
      "*VISCO, INTEGRATOR=HEUN\n0.25, 1.\n"
      "*TEMPERATURE\nBODY, \"300 - 700*(t > 1.4)*(t < 1.6)\"\n"},
     0,
     "material M: time 1.5: the temperature -400 is not above absolute zero"}};

TESTS(laws_refuse_what_is_not_above_absolute_zero,
      (int)(sizeof cold / sizeof *cold)) {
  JOB j = square_run(&cold[_i].scene, 2);
  ck_assert_msg(strstr(j.errors, cold[_i].text) != NULL, "%s", j.errors);
  ck_assert_int_eq(job_run(&j, "--check"), cold[_i].early ? 2 : 0);
}

/* A group without a law: the answer is that of elasticity, and its elements
 * are neither integrated nor stored. */
TEST(elastic_groups_cost_nothing) {
  long bytes[2] = {0, 0};
  for (int k = 0; k < 2; ++k) {
    JOB j =
        job_with("visco", "tests/regression/mesh/layers.geo",
                 "*MESH, FILE=layers.geo\n*MATERIAL, NAME=M\n*ELASTIC\n" STEEL
                 "\n" DEVIATORIC "*MATERIAL, NAME=E\n*ELASTIC\n" STEEL
                 "\n"
                 "*SOLID SECTION, ELSET=SOFT, MATERIAL=M\n"
                 "*SOLID SECTION, ELSET=HARD, MATERIAL=%s\n"
                 "*STEP\n*VISCO, INTEGRATOR=MIDPOINT\n0.5, 1.\n"
                 "*BOUNDARY\nLEFT, 1\nBOTTOM, 2\nTOP, 2, 2, 1.E-3\n"
                 "*OUTPUT, HDF5=NO\n*PRINT, ELEMENTS, GROUP=HARD\n*END STEP\n",
                 k == 0 ? "M" : "E");
    CK_EXIT(job_run(&j, ""), 0, j);
    DAT d = job_table(&j, "ELEMENTS", -1);
    if (k == 1) ck_assert_double_eq(dat_max(&d, "ei_yy"), 0.0);
    if (k == 0) ck_assert_double_gt(dat_max(&d, "ei_yy"), 1e-5);
    char *lst = job_file(&j, "lst"),
         *at = strstr(lst, "\n  inelastic strains ");
    long calls;
    double cpu;
    ck_assert_ptr_nonnull(at);
    ck_assert_int_eq(sscanf(at + 21, "%ld %lf %ld", &calls, &cpu, &bytes[k]),
                     3);
    free(lst);
  }
  ck_assert_int_le(bytes[1], bytes[0] * 6 / 10);
}

/* Heat in a group that creeps and, below or above it, in one that does not. */
TESTS(works_beside_an_elastic_group_balance, 2) {
  JOB j = job_with("visco", "tests/regression/mesh/layers.geo",
                   "*MESH, FILE=layers.geo\n*MATERIAL, NAME=M\n*ELASTIC\n" STEEL
                   "\n*EXPANSION\n2E-5\n" DEVIATORIC
                   "*MATERIAL, NAME=E\n*ELASTIC\n" STEEL
                   "\n*EXPANSION\n1E-5\n"
                   "*SOLID SECTION, ELSET=SOFT, MATERIAL=%s\n"
                   "*SOLID SECTION, ELSET=HARD, MATERIAL=%s\n"
                   "*STEP\n*VISCO, INTEGRATOR=BACKWARD\n0.5, 1.\n"
                   "*BOUNDARY\nLEFT, 1\nBOTTOM, 2\nTOP, 2\n"
                   "*TEMPERATURE\nSOFT, \"20*x+10\"\nHARD, \"30-10*y\"\n"
                   "*OUTPUT, HDF5=NO\n*PRINT, ENERGY\n*END STEP\n",
                   _i == 0 ? "M" : "E", _i == 0 ? "E" : "M");
  ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
  DAT e = job_table(&j, "ENERGY", -1);
  ck_assert_double_le(fabs(dat_at(&e, 0, "energy_defect_relative")), 1e-12);
  ck_assert_double_gt(fabs(dat_at(&e, 0, "thermal_work")), 1e-9);
  ck_assert_double_gt(dat_at(&e, 0, "viscous_dissipation"), 1e-9);
}

/* A pull that grows to 10 in four increments, whose rates are taken at 0, 2.5,
 * 5 and 7.5: below the threshold of 4 in two of them. Elements of an elastic
 * group are not looked at. */
TEST(points_at_rest_are_counted) {
  for (int k = 0; k < 2; ++k) {
    JOB j =
        job_with("visco", "tests/regression/mesh/layers.geo",
                 "*MESH, FILE=layers.geo\n*MATERIAL, NAME=M\n*ELASTIC\n" STEEL
                 "\n*INELASTIC, LAW=PERZYNA\n4., 1.E4\n"
                 "*MATERIAL, NAME=E\n*ELASTIC\n" STEEL
                 "\n"
                 "*SOLID SECTION, ELSET=SOFT, MATERIAL=M, TYPE=CPS3\n"
                 "*SOLID SECTION, ELSET=HARD, MATERIAL=%s, TYPE=CPS3\n"
                 "*STEP\n*VISCO, INTEGRATOR=EULER\n0.25, 1.\n"
                 "*BOUNDARY\nLEFT, 1\nBOTTOM, 2\n*DSLOAD\nTOP, TY, 10.\n"
                 "*OUTPUT, HDF5=NO\n*PRINT, ELEMENTS, GROUP=SOFT\n"
                 "*PRINT, ELEMENTS, GROUP=HARD\n*END STEP\n",
                 k == 0 ? "M" : "E");
    ck_assert_int_eq(job_run(&j, ""), 0);
    DAT soft = job_table(&j, "ELEMENTS", 0),
        hard = job_table(&j, "ELEMENTS", 1);
    const int n = soft.n_row + (k == 0 ? hard.n_row : 0);
    ck_assert_int_gt(hard.n_row, 0);
    ck_assert_double_eq(job_told(&j, "threshold_evaluations"), 4 * n);
    ck_assert_double_eq(job_told(&j, "threshold_resting"), 2 * n);
  }
}

/* A body that its support carries has no stress but rounding, which none of the
 * iterations of a step takes away: no increment is cut for it. */
TESTS(carried_bodies_settle, 3) {
  static const char *const laws[] = {PROPORTIONAL, DEVIATORIC,
                                     "*INELASTIC, LAW=KELVIN\n500., 1000.\n"};
  const square_case s = {STEEL,
                         laws[_i],
                         "CPE3",
                         "",
                         "*BOUNDARY\nTOP, 1, 1, 0.\nTOP, 2, 2, 1.E-4\n",
                         "*VISCO, INTEGRATOR=BACKWARD, ITERATION=INITIAL\n"
                         "0.25, 1.\n"};
  JOB j = square_run(&s, 0);
  ck_assert_double_eq(square_energy(&j, -1, "increment"), 4);
}

UNIT_MAIN("visco")
