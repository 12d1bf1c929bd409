/*
 * The integrators of inelastic strains: what each makes of a held stress in a
 * step, how far the explicit ones are stable, and their order of convergence
 * for a block that creeps on a floor with friction. E = 1000, nu = 0.3,
 * relaxation time 2.
 */
#include "support/creep_case.h"
#include "support/square_case.h"
#include "support/unit.h"

const int job_without_fields = 1;

typedef struct scheme_row {
  const char *integrator;
  double (*factor)(double z); /* stress after a step z = dt/tau, held strain  */
  int order;
} scheme_row;

static double by_euler(double z) { return 1 - z; }
static double by_heun(double z) { return 1 - z + z * z / 2; }
static double by_rk4(double z) {
  return 1 - z + z * z / 2 - z * z * z / 6 + z * z * z * z / 24;
}
static double by_theta(double z) { return (1 - 0.25 * z) / (1 + 0.75 * z); }
static double by_midpoint(double z) { return (1 - 0.5 * z) / (1 + 0.5 * z); }
static double by_backward(double z) { return 1 / (1 + z); }
static double by_exponential(double z) { return exp(-z); }

static const scheme_row schemes[] = {
    {"EULER", by_euler, 1},
    {"HEUN", by_heun, 2},
    {"RK4", by_rk4, 4},
    {"THETA, THETA=0.75", by_theta, 1},
    {"MIDPOINT", by_midpoint, 2},
    {"BACKWARD", by_backward, 1},
    {"BACKWARD, ITERATION=INITIAL", by_backward, 1},
    {"EXPONENTIAL", by_exponential, 2}};
enum { N_SCHEME = sizeof schemes / sizeof *schemes };

TESTS(held_stress_is_multiplied_by_the_factor_of_the_scheme, N_SCHEME) {
  const scheme_row *r = &schemes[_i];
  static const double dt[] = {0.2, 1.0, 3.0};
  for (int k = 0; k < 3; ++k) {
    PRINTED(visco, "*VISCO, INTEGRATOR=%s\n%g, %g\n", r->integrator, dt[k],
            5 * dt[k]);
    square_case s = {STEEL, PROPORTIONAL, "CPE3", "", HELD, visco};
    JOB j = square_run(&s, 0);
    double stress = 1.0 / (1 - 0.09);
    for (int i = 0; i < 6; ++i) {
      square_all_have(&j, i, "stress_yy", stress, 1e-9);
      stress *= r->factor(dt[k] / 2.0);
    }
  }
}

/* Explicit integrators are stable up to twice the relaxation time, whatever
 * the mesh, the supports and the contact: there the stress changes its sign. */
TEST(limit_is_twice_the_relaxation_time) {
  square_case s = {STEEL,
                   PROPORTIONAL,
                   "CPE3",
                   FLOOR(0.5),
                   "*BOUNDARY\nLEFT, 1\nTOP, 1, 1, 1.E-4\nTOP, 2, 2, -1.E-3\n",
                   "*VISCO, INTEGRATOR=EULER\n4., 40.\n"};
  job j = square_run(&s, 0);
  DAT a = job_table(&j, "ELEMENTS", 1), b = job_table(&j, "ELEMENTS", 10);
  for (int i = 0; i < a.n_row; ++i)
    ck_assert_double_eq_tol(dat_at(&a, i, "stress_yy"),
                            -dat_at(&b, i, "stress_yy"), 1e-8);
  job_end(&j);
  s.visco = "*VISCO, INTEGRATOR=HEUN\n4.001, 40.01\n";
  j = square_run(&s, 2);
  ck_assert_ptr_nonnull(strstr(j.errors, "P2050"));
  ck_assert_ptr_nonnull(strstr(j.errors, "stable up to dt = 4 "));
  ck_assert_ptr_nonnull(strstr(j.errors, "SUBSTEPS=AUTO"));
  job_end(&j);
}

TEST(substeps_keep_an_explicit_scheme_stable) {
  square_case s = {
      STEEL,  PROPORTIONAL,
      "CPS3", "",
      HELD,   "*VISCO, INTEGRATOR=HEUN, SUBSTEPS=AUTO\n10., 20.\n"};
  JOB j = square_run(&s, 0);
  /* Pieces of 2.5: four to an increment. */
  for (int i = 0; i <= 8; ++i)
    square_all_have(&j, i, "stress_yy", pow(by_heun(1.25), i), 1e-9);
}

/* Power creep, A = 1, n = 4, of a held strain: stress (1 + 3 E A t)^(-1/3) from
 * 1. At first 1/2048 of the increment is stable, at its end all of it. */
TEST(substeps_are_as_long_as_what_they_start_from_allows) {
  square_case s = {STEEL,  "*CREEP, LAW=TIME\n1., 4., 0.\n",
                   "CPS3", "",
                   HELD,   "*VISCO, INTEGRATOR=HEUN, SUBSTEPS=AUTO\n1., 1.\n"};
  JOB j = square_run(&s, 0);
  FREED char *sta = job_file(&j, "sta");
  int n = 0;
  for (const char *at = sta; (at = strstr(at, "\n")) != NULL; ++at) ++n;
  ck_assert_int_lt(n, 100);
  square_all_have(&j, -1, "stress_yy", pow(3001, -1. / 3), 2e-3);
}

/* Hardening, m = -1/2, A = 1e-4, n = 4, a microsecond after it began; by strain
 * under a stress that rises to 1 from a small one within the increment: never
 * more than p of 1 all along, 2e-4 sqrt(t) at t = 2, by a tenth. */
TESTS(little_creep_before_does_not_make_the_rate_large, 8) {
  static const char *const by[] = {"EULER", "HEUN", "RK4", "MIDPOINT"};
  static const char *const how[] = {"STRAIN", "TIME"};
  PRINTED(law, "*CREEP, LAW=%s\n1.E-4, 4., -0.5\n", how[_i % 2]);
  PRINTED(visco,
          "*VISCO, INTEGRATOR=BACKWARD\n1.E-6, 1.E-6\n*END STEP\n"
          "*STEP\n*VISCO, INTEGRATOR=%s\n1., 2.\n*DSLOAD\nTOP, TY, 1.\n"
          "*PRINT, NODES\n",
          by[_i / 2]);
  const char *const load = _i % 2 ? "1.E-6\n" SYMMETRY "*DSLOAD\nTOP, TY, 1.\n"
                                  : SYMMETRY "*DSLOAD\nTOP, TY, 0.01\n";
  square_case s = {STEEL, law, "CPS3", "", load, visco};
  JOB j = square_run(&s, 0);
  DAT d = job_table(&j, "NODES", -1);
  const double p = dat_max(&d, "u_y") - 1e-3;
  ck_assert_double_le(p, 1.1 * 2e-4 * sqrt(2));
  ck_assert_double_ge(p, 0);
}

/* Power creep, n = 3, in one increment of BACKWARD: of a held strain the stress
 * x from 1 with x + 4 x^3 = 1, A = 4e-3; under a stress of 1 the strain 1e-3 +
 * A. TOL= is that of the contact, which the floor makes exact. */
TESTS(tolerance_of_the_contact_is_not_that_of_creep, 4) {
  static const char *const iterate[] = {"", ", ITERATION=INITIAL"};
  static const char *const load[] = {"TOP, 2, 2, -1.E-3\n",
                                     "*DSLOAD\nTOP, P, 1.\n"};
  static const double value[] = {-0.5, -5e-3};
  const int pressed = _i % 2;
  PRINTED(first, "*BOUNDARY\nLEFT, 1\n%s", load[pressed]);
  PRINTED(visco, "*VISCO, INTEGRATOR=BACKWARD%s\n1., 1.\n*SOLVER, TOL=0.1\n",
          iterate[_i / 2]);
  square_case s = {STEEL,  "*INELASTIC, LAW=NORTON\n4.E-3, 3.\n",
                   "CPS3", FLOOR(0.),
                   first,  visco};
  JOB j = square_run(&s, 0);
  square_all_have(&j, -1, pressed ? "strain_yy" : "stress_yy", value[pressed],
                  1e-9);
}

/* A block that slides: what TOL=0.1 leaves at its foot differs with each
 * iteration on the stresses, which requires less. No increment is cut. */
TEST(creep_iteration_has_the_contact_as_exact_as_it_requires) {
  square_case s = {STEEL,
                   "*INELASTIC, LAW=NORTON\n0.1, 3.\n",
                   "CPS3",
                   FLOOR(0.2),
                   "*BOUNDARY\nTOP, 1, 1, 2.E-3\nTOP, 2, 2, -1.E-3\n",
                   "*VISCO, INTEGRATOR=BACKWARD, ITERATION=INITIAL\n0.5, 1.\n"
                   "*SOLVER, METHOD=LAGRANGE, TOL=0.1\n"};
  JOB j = square_run(&s, 0);
  FREED char *sta = job_file(&j, "sta");
  ck_assert_msg(strstr(sta, "CUT") == NULL, "%s", sta);
}

/* Increments of two lengths in turn have each its matrix. Near nu = 1/2, where
 * solutions are refined, so have the residuals. Strains at a constant stress,
 * (1 - nu^2)/E (1 + t/2). */
TEST(increments_of_several_lengths_have_each_its_moduli) {
  static const double time[] = {0, 2, 3, 5, 7, 8};
  const double nu = 0.499999;
  square_case s = {"1000., 0.499999",
                   PROPORTIONAL,
                   "CPE3",
                   "",
                   SYMMETRY "*DSLOAD\nTOP, TY, 1.\n",
                   "*VISCO, INTEGRATOR=BACKWARD\n2., 2.\n*END STEP\n*STEP\n"
                   "*VISCO, INTEGRATOR=BACKWARD\n1., 1.\n*END STEP\n*STEP\n"
                   "*VISCO, INTEGRATOR=BACKWARD\n2., 4.\n*END STEP\n*STEP\n"
                   "*VISCO, INTEGRATOR=BACKWARD\n1., 1.\n"};
  JOB j = square_run(&s, 0);
  for (int k = 0; k < 6; ++k)
    square_all_have(&j, k, "strain_yy",
                    1e-3 * (1 - nu * nu) * (1 + time[k] / 2), 1e-9);
}

/* dt ten times the relaxation time: MIDPOINT says so, BACKWARD is quiet. */
TEST(ringing_is_told) {
  square_case s = {STEEL,  PROPORTIONAL,
                   "CPS3", "",
                   HELD,   "*VISCO, INTEGRATOR=MIDPOINT\n20., 100.\n"};
  job j = square_run(&s, 0);
  square_all_have(&j, 2, "stress_yy", 4.0 / 9.0, 1e-9);
  ck_assert_ptr_nonnull(strstr(j.errors, "P2051"));
  ck_assert_ptr_nonnull(strstr(j.errors, "-0.6667"));
  job_end(&j);
  s.visco = "*VISCO, INTEGRATOR=BACKWARD\n20., 100.\n";
  j = square_run(&s, 0);
  square_all_have(&j, 1, "stress_yy", 1.0 / 11.0, 1e-9);
  ck_assert_ptr_null(strstr(j.errors, "P2051"));
  job_end(&j);
}

TESTS(order_of_convergence_with_contact_and_friction, N_SCHEME) {
  const scheme_row *r = &schemes[_i];
  /* Order 1 takes longer to show. */
  const int n = r->order == 1 ? 32 : 8;
  const creep_case c = {STEEL,          DEVIATORIC, "",  "", "CPE3",
                        STICK_AND_SLIP, 10,         0.3, 2,  0};
  double found = creep_case_order(&c, r->integrator, n);
  printf("%-28s order %.3f\n", r->integrator, found);
  ck_assert_double_eq_tol(found, r->order, 0.1);
}

UNIT_MAIN("integrators")
