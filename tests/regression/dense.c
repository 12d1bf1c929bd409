/*
 * Tables at *TIME POINTS, which increments need not end at: the order of each
 * integrator, what contact and friction do there, stiff laws, and that the run
 * itself stays as it is. E = 1000, nu = 0.3, relaxation time 2.
 */
#include "support/block_file.h"
#include "support/square_case.h"
#include "support/unit.h"

const int job_without_fields = 1;

static const struct {
  const char *integrator;
  int order;
} rows[] = {{"EULER", 1},      {"HEUN", 2},
            {"RK4", 4},        {"THETA, THETA=0.75", 1},
            {"MIDPOINT", 2},   {"BACKWARD", 1},
            {"EXPONENTIAL", 0}};
enum { N_ROW = sizeof rows / sizeof *rows, N_POINT = 20 };

/* Times 1.01 + 0.099 k of the points: none is the end of an increment. */
#define POINTS \
  "*TIME POINTS, NAME=T, GENERATE, TIME=TOTAL TIME\n1.01, 2.891, 0.099\n"

/* Root mean square error of the stress that relaxes, n increments over 2. */
static double error_of(const char *integrator, int n) {
  double sum = 0;
  PRINTED(visco,
          "*VISCO, INTEGRATOR=%s\n%.17g, 2.\n"
          "*PRINT, ELEMENTS, ENERGY, TIME POINTS=T\n*OUTPUT, HDF5=NO\n",
          integrator, 2.0 / n);
  square_case s = {STEEL, PROPORTIONAL, "CPS3", POINTS, HELD, visco};
  JOB j = square_run(&s, 0);
  for (int k = 0; k < N_POINT; ++k) {
    DAT d = job_table(&j, "ELEMENTS", 1 + k);
    double t = 1.01 + 0.099 * k;
    ck_assert_double_eq_tol(square_energy(&j, 1 + k, "time"), t, 1e-12);
    sum += pow(dat_at(&d, 0, "stress_yy") - exp(-(t - 1) / 2), 2);
  }
  return sqrt(sum / N_POINT);
}

TESTS(points_have_the_order_of_the_integrator, N_ROW) {
  double coarse = error_of(rows[_i].integrator, 16);
  double fine = error_of(rows[_i].integrator, 32);
  if (rows[_i].order == 0) { /* held strains: exact                           */
    ck_assert_double_le(coarse, 1e-14);
    return;
  }
  ck_assert_double_eq_tol(log2(coarse / fine), rows[_i].order, 0.1);
}

/* Energies at a point are those of an increment that ends there: the balance
 * closes, and what is dissipated lies between the ends. */
TEST(energies_balance_at_points) {
  square_case s = {STEEL,
                   DEVIATORIC,
                   "CPE3",
                   FLOOR(0.1) "*TIME POINTS, NAME=T\n0.1, 0.2, 0.4, 0.5, 0.7\n",
                   PRESS(10.),
                   "*VISCO, INTEGRATOR=MIDPOINT\n0.5, 1.\n"
                   "*PRINT, ENERGY, TIME POINTS=T\n*PRINT, ENERGY\n"};
  JOB j = square_run(&s, 0);
  double lost = 0;
  /* Step 1; three points, the first increment, once for both requests ... */
  static const double time[] = {1, 1.1, 1.2, 1.4, 1.5, 1.7, 2};
  for (int k = 0; k < 7; ++k) {
    ck_assert_double_eq_tol(square_energy(&j, k, "time"), time[k], 1e-12);
    ck_assert_double_le(fabs(square_energy(&j, k, "energy_defect_relative")),
                        1e-10);
    double now = square_energy(&j, k, "viscous_dissipation");
    if (k > 0) ck_assert_double_gt(now, lost);
    lost = now;
  }
}

/* Increments of twenty relaxation times: the stress falls all the way. */
TEST(stiff_points_lie_between_the_ends) {
  square_case s = {STEEL,
                   PROPORTIONAL,
                   "CPS3",
                   "*TIME POINTS, NAME=T, GENERATE\n2., 80., 2.\n",
                   HELD,
                   "*VISCO, INTEGRATOR=BACKWARD\n40., 80.\n"
                   "*PRINT, ELEMENTS, TIME POINTS=T\n"};
  JOB j = square_run(&s, 0);
  double last = 1;
  for (int k = 1; k <= 40; ++k) {
    DAT d = job_table(&j, "ELEMENTS", k);
    double now = dat_at(&d, 0, "stress_yy");
    ck_assert_double_lt(now, last);
    ck_assert_double_gt(now, 0);
    last = now;
  }
}

/* The strains of two Kelvin units are internal variables, their sum is that of
 * the body: at the points as at the ends of the increments. */
TEST(units_add_up_at_points) {
  square_case s = {STEEL,
                   "*INELASTIC, LAW=KELVIN\n700., 500.\n700., 1000.\n",
                   "CPS3",
                   "*TIME POINTS, NAME=T, GENERATE\n0.05, 0.5, 0.05\n",
                   SYMMETRY "*DSLOAD\nTOP, TY, 1.\n",
                   "*VISCO, INTEGRATOR=MIDPOINT\n0.25, 0.5\n"
                   "*PRINT, ELEMENTS, TIME POINTS=T\n"};
  JOB j = square_run(&s, 0);
  for (int k = 1; k <= 10; ++k) {
    DAT d = job_table(&j, "ELEMENTS", k);
    const double size = dat_at(&d, 0, "ei_yy");
    ck_assert_double_gt(size, 1e-5);
    for (int i = 0; i < d.n_row; ++i) {
      ck_assert_double_eq_tol(
          dat_at(&d, i, "alpha_1") + dat_at(&d, i, "alpha_5"),
          dat_at(&d, i, "ei_xx"), 1e-9 * size);
      ck_assert_double_eq_tol(
          dat_at(&d, i, "alpha_2") + dat_at(&d, i, "alpha_6"),
          dat_at(&d, i, "ei_yy"), 1e-9 * size);
    }
  }
}

#define SLIDES "*DSLOAD\nRIGHT, P, 6.\n"

static char *contact_table(const job *j, int k) {
  char *text = NULL;
  DAT d = job_table(j, "CONTACT", k);
  size_t size;
  FILE *f = open_memstream(&text, &size);
  ck_assert_int_gt(d.n_row, 2);
  for (int i = 0; i < d.n_row * d.n_col; ++i) fprintf(f, "%.12g ", d.value[i]);
  fclose(f);
  return text;
}

/* Held parts of two materials relax each by its own time. */
TEST(materials_keep_their_times_at_points) {
  JOB j = job_begin("block");
  block_file_write(&j, (int[]){1, 2}, (double[]){1.0, 2.0}, 1);
  job_write(&j, "block.inp",
            "*MESH, FILE=block.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
            "*INELASTIC, LAW=MAXWELL\n2.\n*MATERIAL, NAME=U\n*ELASTIC\n"
            "1000., 0.3\n*INELASTIC, LAW=KELVIN\n1000., 500.\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*SOLID SECTION, ELSET=UPPER, MATERIAL=U\n"
            "*TIME POINTS, NAME=P\n0.5\n*STEP\n"
            "*VISCO, INTEGRATOR=EXPONENTIAL\n1., 1.\n*BOUNDARY\n"
            "CONTACT, 1, 2\nTOP, 1\nTOP, 2, 2, \"-0.002 + 0*t\"\nLEFT, 1\n"
            "LEFT, 2, 2, \"-0.001*y + 0*t\"\nSYMMETRY, 1\n"
            "SYMMETRY, 2, 2, \"-0.001*y + 0*t\"\n"
            "*PRINT, ELEMENTS, TIME POINTS=P\n*END STEP\n");
  CK_EXIT(job_run(&j, ""), 0, j);
  DAT e = job_table(&j, "ELEMENTS", -1);
  const double at_once = -1000 * 0.7 / 1.3 / 0.4 * 1e-3;
  ck_assert_int_eq(e.n_row, 4);
  for (int k = 0; k < 4; ++k) /* E/2 is left of the KELVIN unit, tau 1/4 */
    ck_assert_double_eq_tol(
        dat_at(&e, k, "stress_yy"),
        at_once * (dat_at(&e, k, "y") < 1 ? exp(-0.25) : (1 + exp(-2)) / 2),
        1e-8);
}

/* Without flow the state at a point is that of an increment which ends there:
 * the first of one run with half the length. */
TEST(friction_at_a_point_is_that_of_a_shorter_increment) {
  square_case s = {
      STEEL,
      "",
      "CPE3",
      FLOOR(0.2) "*TIME POINTS, NAME=T\n0.5\n",
      PRESS(10.),
      "*QUASISTATIC\n1., 1.\n" SLIDES "*PRINT, CONTACT, TIME POINTS=T\n"};
  JOB whole = square_run(&s, 0);
  s.visco = "*QUASISTATIC\n0.5, 1.\n" SLIDES "*PRINT, CONTACT, FREQUENCY=1\n";
  s.model = FLOOR(0.2);
  JOB half = square_run(&s, 0);
  FREED char *a = contact_table(&whole, 1), *b = contact_table(&half, 1);
  ck_assert_str_eq(a, b);
}

/* Young's modulus falls with a temperature that rises over the increment. */
TEST(moduli_at_a_point_are_those_of_its_time) {
  square_case s = {"1000., 0.3, 0.\n500., 0.3, 100.",
                   "",
                   "CPS3",
                   "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nBODY, 0.\n"
                   "*TIME POINTS, NAME=T\n0.25, 0.75, 1.\n",
                   HELD,
                   "*QUASISTATIC\n1., 1.\n*TEMPERATURE\nBODY, 100.\n"
                   "*PRINT, ELEMENTS, TIME POINTS=T\n"};
  JOB j = square_run(&s, 0);
  square_all_have(&j, 0, "stress_yy", 1.0, 1e-12);
  square_all_have(&j, 1, "stress_yy", 0.875, 1e-12);
  square_all_have(&j, 2, "stress_yy", 0.625, 1e-12);
  square_all_have(&j, 3, "stress_yy", 0.5, 1e-12);
}

#define PUSHED "*BOUNDARY\nLEFT, 1\nTOP, 2, 2, -1.E-2\n"

/* Points, also within adaptive increments, change nothing else; nor does the
 * matrix of given forces, which each problem has of its own. */
TEST(points_leave_the_run_alone) {
  static const char *const choice[] = {
      "*VISCO, INTEGRATOR=MIDPOINT, TOLERANCE=1E-3",
      "*VISCO, INTEGRATOR=HEUN, TOLERANCE=1E-3",
      "*VISCO, INTEGRATOR=EXPONENTIAL",
      "*VISCO, INTEGRATOR=BACKWARD, ITERATION=INITIAL", "*QUASISTATIC"};
  for (int i = 0; i < 5; ++i) {
    char *table[2];
    for (int k = 0; k < 2; ++k) {
      PRINTED(visco, "%s\n0.4, 1.\n%s%s", choice[i], "*PRINT, CONTACT\n",
              k == 0 ? "" : "*PRINT, ENERGY, TIME POINTS=T\n");
      static const char points[] = "*TIME POINTS, NAME=T\n0.13, 0.77\n";
      PRINTED(model, FLOOR(0.1) "%s%s", points,
              i < 4 ? "" : "*CONTACT FORCE, CONTACT=C\n\"10 + x\"\n");
      square_case s = {
          STEEL, DEVIATORIC, "CPE3", model, i < 4 ? PRESS(10.) : PUSHED, visco};
      JOB j = square_run(&s, 0);
      table[k] = contact_table(&j, -1);
      if (k == 1) {
        ck_assert_double_eq_tol(square_energy(&j, 1, "time"), 1.13, 1e-12);
        ck_assert_double_eq_tol(square_energy(&j, -1, "time"), 1.77, 1e-12);
      }
    }
    ck_assert_str_eq(table[0], table[1]);
    free(table[0]);
    free(table[1]);
  }
}

/* Errors at a point, of the mesh and of a goal, are those of an increment that
 * ends there, also in the second step, after MESH=END. */
static char *errors_at(const char *dt, const char *table, const char *points) {
  char model[400], steps[600], *text = NULL;
  size_t size;
  const int goals = table[0] == 'G';
  snprintf(model, sizeof model,
           "%s*GOAL, NAME=G, QUANTITY=ENERGY\n"
           "*TIME POINTS, NAME=T, TIME=TOTAL TIME\n2.25\n",
           FLOOR(0.2));
  snprintf(steps, sizeof steps,
           "*QUASISTATIC\n1., 1.\n*ACCURACY, MESH=END\n*END STEP\n*STEP\n"
           "*QUASISTATIC\n%s, 0.5\n*ACCURACY, MESH=YES\n" SLIDES
           "*PRINT, %s%s\n",
           dt, table, points);
  square_case s = {STEEL, "", "CPE3", model, PRESS(10.), steps};
  JOB j = square_run(&s, 0);
  DAT d = job_table(&j, table, points[0] != '\0' ? -1 : goals ? 0 : 2);
  FILE *f = open_memstream(&text, &size);
  for (int i = 0; i < d.n_row; ++i)
    fprintf(f, "%.9g ", dat_at(&d, i, goals ? "error" : "mesh_error"));
  fclose(f);
  ck_assert_double_gt(dat_at(&d, 0, goals ? "band" : "mesh_error"), 0);
  return text;
}

TESTS(errors_at_a_point_are_those_of_its_time, 2) {
  static const char *const table[] = {"ELEMENTS", "GOALS"};
  FREED char *at = errors_at("0.5", table[_i], ", TIME POINTS=T");
  FREED char *end = errors_at("0.25", table[_i], "");
  ck_assert_str_eq(at, end);
}

/* MESH=END of the step before asks for none. */
TEST(no_error_at_a_point_unless_required) {
  square_case s = {STEEL,
                   "",
                   "CPE3",
                   "*TIME POINTS, NAME=T\n0.5\n",
                   HELD "*ACCURACY, MESH=END\n",
                   "*QUASISTATIC\n1., 1.\n*ACCURACY, MESH=END\n"
                   "*PRINT, ELEMENTS, TIME POINTS=T\n"};
  JOB j = square_run(&s, 0);
  DAT before = job_table(&j, "ELEMENTS", 0), at = job_table(&j, "ELEMENTS", 1);
  ck_assert_int_eq(dat_has(&before, "mesh_error"), 1);
  ck_assert_int_eq(dat_has(&at, "mesh_error"), 0);
}

UNIT_MAIN("dense")
