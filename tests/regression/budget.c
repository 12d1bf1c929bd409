/*
 * The error budget of a run against the true errors: of the increments against
 * a path of many, of the mesh against a fine one by the potential energy.
 */
#include "support/square_case.h"
#include "support/unit.h"

const int job_without_fields = 1;

/* A column of the last line of JOB.sta, counted from 0; NAN for "-". */
static double last_of(const job *j, int column) {
  char *sta = job_file(j, "sta"), *line = sta, *word;
  for (char *p = sta; (p = strchr(p, '\n')) != NULL && p[1] != '\0';)
    line = ++p;
  word = strtok(line, " \n");
  for (int k = 0; k < column; ++k) word = strtok(NULL, " \n");
  ck_assert_ptr_nonnull(word);
  double value = strcmp(word, "-") == 0 ? NAN : atof(word);
  free(sta);
  return value;
}
enum { MESH_COLUMN = 11, TIME_COLUMN, SOLVER_COLUMN };

/* The cylinder of hertz_line with friction in n increments. */
static job roll(int n, const char *accuracy) {
  job j = job_with(
      "cylinder", "input/hertz_line/hertz_line.geo",
      "*PARAMETER\nR = 10.\nE = 210.D3\nNU = 0.3\n"
      "A = 0.2348908547\nNC = 12\n"
      "*MESH, FILE=hertz_line.geo\n*MATERIAL, NAME=M\n*ELASTIC\n"
      "<E>, <NU>\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
      "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\n"
      "*CONTACT, NAME=C, GROUP=CONTACT, OBSTACLE=O, NORMAL=OBSTACLE\n"
      "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n*STEP\n*QUASISTATIC\n"
      "%.17g, 1.\n*BOUNDARY\nSYMMETRY, 1, 1, 0.\n*DSLOAD\nTOP, P, 50.\n"
      "%s*PRINT, CONTACT, ENERGY, FREQUENCY=0\n*END STEP\n",
      1.0 / n, accuracy);
  CK_EXIT(job_run(&j, ""), 0, j);
  return j;
}

TEST(error_of_the_steps_is_near_the_true_one) {
  JOB fine = roll(160, "");
  ck_assert(isnan(last_of(&fine, TIME_COLUMN)));
  for (int n = 1; n <= 10; n = 2 * n + n / 2) { /* 1, 2, 5 */
    JOB j = roll(n, "*ACCURACY, TIME=YES, MESH=NO\n");
    double told = last_of(&j, TIME_COLUMN), is = job_difference(&j, &fine, -1);
    ck_assert_msg(told > 0.7 * is && told < 1.5 * is, "%d: told %g, is %g", n,
                  told, is);
    ck_assert(isnan(last_of(&j, MESH_COLUMN)));
  }
}

/* What the solver does in the increments is told, not only in the first. */
TEST(every_increment_stands_in_the_log_of_the_solver) {
  JOB j = roll(3, "*ACCURACY, TIME=YES\n");
  FREED char *cvg = job_file(&j, "cvg");
  for (int k = 1; k <= 3; ++k) {
    PRINTED(row, "\n%7d   1 ", k);
    ck_assert_msg(strstr(cvg, row) != NULL, "no increment %d in %s", k, cvg);
  }
}

/* Steps that add no error of their own, each with a path of its own. */
TEST(error_of_the_steps_is_that_of_all_steps) {
  static const char still[] =
      "*ACCURACY, TIME=YES\n*PRINT, ENERGY\n*END STEP\n*STEP\n*STATIC\n"
      "*END STEP\n*STEP\n*QUASISTATIC\n1., 1.\n";
  char more[400];
  double norm[3];
  for (int k = 0; k < 3; ++k) {
    snprintf(more, sizeof more, "%s%s*ACCURACY, TIME=YES\n", k > 0 ? still : "",
             k > 1 ? still : "");
    JOB j = roll(1, more);
    DAT e = job_table(&j, "ENERGY", -1);
    const double part = 0.01 * job_told(&j, "time_error_percent");
    norm[k] =
        part * sqrt(2 * dat_at(&e, 0, "strain_energy") / (1 - part * part));
  }
  ck_assert_double_gt(norm[0], 0);
  ck_assert_double_ge(norm[1], 0.999999 * norm[0]);
  ck_assert_double_ge(norm[2], 0.999999 * norm[1]);
}

/* Last figure of that name in JOB.json, %. */
static double figure(const job *j, const char *name) {
  char wanted[80], *json = job_file(j, "json"), *last = NULL;
  double value = NAN;
  snprintf(wanted, sizeof wanted, "\"%s\": ", name);
  for (char *at = json; (at = strstr(at, wanted)) != NULL;)
    last = at += strlen(wanted);
  ck_assert_ptr_nonnull(last);
  sscanf(last, "%lf", &value);
  free(json);
  return value;
}

/* Balanced with the error of the mesh: increments below what it asks for, fewer
 * of them for a larger share, and the error told is the true one. */
TEST(increments_are_balanced_with_the_mesh) {
  JOB fine = roll(160, "");
  double made[2];
  const char *const cards[] = {"*ACCURACY, TIME=BALANCED, TIME_SHARE=0.05\n",
                               "*ACCURACY, TIME=BALANCED, TIME_SHARE=0.005\n"};
  for (int k = 0; k < 2; ++k) {
    JOB j = roll(20, cards[k]);
    double told = last_of(&j, TIME_COLUMN), is = job_difference(&j, &fine, -1);
    double others = last_of(&j, MESH_COLUMN);
    ck_assert_msg(is < (k == 0 ? 0.05 : 0.005) * others, "%d: %g of %g", k, is,
                  others);
    ck_assert_msg(told > 0.4 * is && told < 2.5 * is, "%d: told %g, is %g", k,
                  told, is);
    made[k] = figure(&j, "balanced_increments");
    ck_assert_double_eq(figure(&j, "balanced_increments_of_deck"), 20);
  }
  ck_assert_msg(made[0] < made[1] && made[0] < 20, "%g %g", made[0], made[1]);
}

/* A law that flows, from a first increment that is much too long: the error at
 * the end is below its share of a mesh error that is known from TIME=YES. */
TEST(increments_of_flow_are_balanced) {
  JOB j =
      job_with("held", "input/creep_block/creep_block.geo",
               "*PARAMETER\nN = 8\n*MESH, FILE=creep_block.geo\n*MATERIAL, "
               "NAME=M\n*ELASTIC\n130.D3, 0.2\n*INELASTIC, LAW=MAXWELL, "
               "TYPE=DEVIATORIC\n1.\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
               "*OBSTACLE, NAME=O, TYPE=CONFORMING\n*CONTACT, NAME=C, "
               "GROUP=CONTACT, OBSTACLE=O\n*FRICTION, CONTACT=C, LAW=COULOMB\n"
               "1.0\n*STEP\n*VISCO, INTEGRATOR=BACKWARD\n1., 4., 1.E-4\n"
               "*BOUNDARY\nSYMMETRY, 1\nTOP, 2, 2, -0.02\n"
               "*ACCURACY, TIME=BALANCED\n*END STEP\n");
  ck_assert_int_eq(job_run(&j, ""), 0);
  double told = last_of(&j, TIME_COLUMN), others = last_of(&j, MESH_COLUMN);
  ck_assert_msg(told > 0 && told < 0.11 * others, "%g of %g", told, others);
  ck_assert_double_gt(figure(&j, "balanced_increments"), 4);
  FREED char *sta = job_file(&j, "sta");
  ck_assert_ptr_nonnull(strstr(sta, "error of the steps above its share"));
}

/* The path of a proportional load is straight: no error, any increments. */
TEST(proportional_load_has_no_error_of_steps) {
  JOB j = job_with(
      "greco", "input/greco/greco.geo",
      "*MESH, FILE=greco.geo\n*MATERIAL, NAME=M\n*ELASTIC\n130.D3, 0.2\n"
      "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
      "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
      "*CONTACT, NAME=C, GROUP=CONTACT, OBSTACLE=O\n"
      "*FRICTION, CONTACT=C, LAW=COULOMB\n1.0\n*STEP\n*QUASISTATIC\n"
      "0.5, 1.0\n*BOUNDARY\nSYMMETRY, 1\n*DSLOAD\nTOP, P, 50.\n"
      "LEFT, P, 150.\n*ACCURACY, TIME=YES\n*END STEP\n"
      "*STEP\n*STATIC\n*END STEP\n");
  ck_assert_int_eq(job_run(&j, ""), 0);
  FREED char *lst = job_file(&j, "lst"), *sta = job_file(&j, "sta");
  double told = NAN;
  sscanf(strstr(sta, "\n") + 1,
         "%*d %*d %*d %*s %*s %*d %*d %*d %*s %*d %*s %*s %lf", &told);
  ck_assert_double_le(told, 1e-9);
  ck_assert_ptr_nonnull(strstr(lst, "one static problem, no path"));
  ck_assert_double_eq(last_of(&j, TIME_COLUMN), 0.0);
}

/* A square of one stress: the error is that of the steps alone. E = 1000, the
 * first step, to t = 1, is elastic. */
static job flow(const char *law, const char *reference, const char *load,
                const char *visco) {
  job j = job_with(
      "flow", "tests/regression/mesh/square.geo",
      "*PARAMETER\nN = 2\n*MESH, FILE=square.geo\n*MATERIAL, NAME=M\n"
      "*ELASTIC\n1000., 0.3\n%s*SOLID SECTION, ELSET=BODY, MATERIAL=M, "
      "TYPE=CPS3\n*REFERENCE\n%s*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1\n"
      "BOTTOM, 2\n%s*END STEP\n*STEP\n%s*ACCURACY, TIME=YES\n"
      "*END STEP\n",
      law, reference, load, visco);
  CK_EXIT(job_run(&j, ""), 0, j);
  return j;
}

/* Told over true error of the steps; half the steps, and it falls. */
static void check_flow(const char *law, const char *reference, const char *load,
                       const char *integrator) {
  double before = HUGE_VAL;
  for (int n = 4; n <= 8; n *= 2) {
    PRINTED(visco, "*VISCO, INTEGRATOR=%s\n%g, 2.\n", integrator, 2.0 / n);
    JOB j = flow(law, reference, load, visco);
    double told = figure(&j, "time_error_percent");
    double is = figure(&j, "true_error_percent");
    ck_assert_msg(told > 0.8 * is && told < 1.25 * is, "%s %d: told %g, is %g",
                  integrator, n, told, is);
    ck_assert_double_lt(told, 0.6 * before);
    before = told;
  }
}

/* Held strain, sigma = exp(-t/tau): the error of the stress. Constant stress,
 * e = 1/E0 + (1 - exp(-t E1/eta))/E1: that of the strain. */
TEST(error_of_the_steps_is_told_where_a_law_flows) {
  static const char *const integrators[] = {"EULER", "HEUN",
                                            "THETA, THETA=0.5"};
  for (int i = 0; i < 3; ++i) {
    check_flow("*INELASTIC, LAW=MAXWELL\n2.\n",
               "stress_xx, 0\nstress_yy, \"exp(-max(0, t - 1)/2)\"\n"
               "stress_zz, 0\nstress_xy, 0\n",
               "TOP, 2, 2, 1.E-3\n", integrators[i]);
    check_flow("*INELASTIC, LAW=ZENER\n500., 1000.\n",
               "u_x, \"-0.3*x*(1E-3 + 2E-3*(1 - exp(-max(0, t - 1)/2)))\"\n"
               "u_y, \"y*(1E-3 + 2E-3*(1 - exp(-max(0, t - 1)/2)))\"\n",
               "*DSLOAD\nTOP, TY, 1.\n", integrators[i]);
  }
}

#define NEXT "*ACCURACY, TIME=YES, MESH=NO\n*END STEP\n*STEP\n"

/* The top is drawn to the side at once at the start of the second *VISCO step,
 * where all slips, and goes back: the body answers as fast, nothing flows. */
TEST(sudden_slip_has_no_error_of_steps) {
  const square_case s = {"1000., 0.",
                         "*INELASTIC, LAW=MAXWELL\n1.E6\n",
                         "CPS3",
                         FLOOR(0.3) "*AMPLITUDE, NAME=BACK\n\"1 - 0.25*t\"\n",
                         "*BOUNDARY\nTOP, 1\nTOP, 2, 2, -1.E-3\n",
                         "*VISCO, INTEGRATOR=BACKWARD\n0.5, 1.\n" NEXT
                         "*VISCO, INTEGRATOR=BACKWARD\n0.25, 1.\n"
                         "*BOUNDARY\nTOP, 1, 1, 1.E-3, BACK\n"};
  JOB j = square_run(&s, 0);
  ck_assert_double_lt(last_of(&j, TIME_COLUMN), 1e-4);
}

/* Without a law, to either side, or by loads: the run has slip less by what
 * goes back within its first increment, and so has that of half its length. */
static job drawn(const char *by, double dt) {
  PRINTED(steps, "*QUASISTATIC\n0.5, 1.\n" NEXT "*QUASISTATIC\n%g, 1.\n%s", dt,
          by);
  const square_case s = {"1000., 0.",
                         "",
                         "CPS3",
                         FLOOR(0.3) "*AMPLITUDE, NAME=BACK\n\"1 - 0.25*t\"\n",
                         "*BOUNDARY\nTOP, 1\nTOP, 2, 2, -1.E-3\n",
                         steps};
  return square_run(&s, 0);
}

TEST(slip_at_the_start_of_a_step_is_in_its_error) {
  static const char *const by[] = {"*BOUNDARY\nTOP, 1, 1, 1.E-3, BACK\n",
                                   "*BOUNDARY\nTOP, 1, 1, -1.E-3, BACK\n",
                                   "*DSLOAD\nRIGHT, P, 0.5, BACK\n"};
  for (int k = 0; k < 3; ++k) {
    JOB j = drawn(by[k], 0.25), fine = drawn(by[k], 1.0 / 64);
    const double told = figure(&j, "time_error_percent");
    const double is = job_difference(&j, &fine, -1);
    ck_assert_msg(told > is && told < 2.0 * is, "told %g, is %g", told, is);
  }
}

/* Supports that turn too often for half increments leave the error unknown, in
 * the increment after them too, which has none of its own. */
TEST(error_of_steps_after_one_without_is_unknown) {
  const square_case s = {
      "1000., 0.",
      "",
      "CPS3",
      FLOOR(0.3) "*AMPLITUDE, NAME=WAVE\n\"if(t < 1.4, sin(400*t), 1)\"\n",
      "*BOUNDARY\nTOP, 1\nTOP, 2, 2, -1.E-3\n",
      "*QUASISTATIC\n0.5, 1.\n*BOUNDARY\nTOP, 1, 1, 1.E-3, WAVE\n"
      "*ACCURACY, TIME=YES, MESH=NO\n"};
  job j = square_run(&s, 0);
  ck_assert(isnan(last_of(&j, TIME_COLUMN)));
  job_end(&j);
}

/* All stresses relax at one rate, and their error with them: one of order 1
 * stays what it is in a step of order 4 that adds almost none. */
TEST(error_of_steps_of_order_1_stays) {
  double told[2];
  for (int k = 0; k < 2; ++k) {
    const square_case s = {STEEL,
                           PROPORTIONAL,
                           "CPS3",
                           "",
                           HELD,
                           k == 0 ? "*VISCO, INTEGRATOR=EULER\n0.25, 1.\n"
                                    "*ACCURACY, TIME=YES, MESH=NO\n"
                                  : "*VISCO, INTEGRATOR=EULER\n0.25, 1.\n" NEXT
                                    "*VISCO, INTEGRATOR=RK4\n0.25, 1.\n"};
    JOB j = square_run(&s, 0);
    told[k] = last_of(&j, TIME_COLUMN);
  }
  ck_assert_msg(fabs(told[1] - told[0]) < 0.02 * told[0], "%g, %g", told[0],
                told[1]);
}

/* A flowing square pressed on a floor where it sticks moves as one that is held
 * there, and half the steps differ as much: zones of slip may grow, so that the
 * error is 5/3 of that, not 4/3 as for schemes of order 2; 2 for EULER. */
TEST(steps_beside_friction_are_those_of_growing_zones) {
  static const char *const integrators[] = {"EULER", "HEUN",
                                            "THETA, THETA=0.5"};
  static const char *const cards[] = {
      "",
      "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
      "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
      "*FRICTION, CONTACT=C, LAW=COULOMB\n10.\n"};
  for (int i = 0; i < 3; ++i) {
    double told[2];
    for (int k = 0; k < 2; ++k) {
      JOB j = job_with(
          "stuck", "tests/regression/mesh/square.geo",
          "*PARAMETER\nN = 2\n*MESH, FILE=square.geo\n"
          "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
          "*INELASTIC, LAW=ZENER\n500., 1000.\n"
          "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n%s*STEP\n*VISCO, "
          "INTEGRATOR=%s\n0.5, 2.\n%s*DSLOAD\nTOP, P, 1.\n"
          "*ACCURACY, TIME=YES\n*END STEP\n",
          cards[k], integrators[i], k == 0 ? "*BOUNDARY\nBOTTOM, 1, 2\n" : "");
      ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
      told[k] = figure(&j, "time_error_percent");
    }
    ck_assert_double_gt(told[0], 0.01);
    ck_assert_double_eq_tol(told[1] / told[0], i == 0 ? 1.0 : 1.25, 1e-3);
  }
}

/* Block of Hertz without friction, NC segments on the half contact and a mesh
 * that is as much finer everywhere. */
static job press(int nc, const char *accuracy) {
  job j =
      job_with("block", "input/hertz_line/hertz_block.geo",
               "*PARAMETER\nA = 0.2348908547\nNC = %d\nGROWTH = %g\n"
               "*MESH, FILE=hertz_block.geo\n*MATERIAL, NAME=M\n*ELASTIC\n"
               "210.D3, 0.3\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
               "*OBSTACLE, NAME=O, TYPE=GAP\n\"x^2/20\"\n"
               "*CONTACT, NAME=C, GROUP=CONTACT, OBSTACLE=O\n*STEP\n*STATIC\n"
               "*BOUNDARY\nSYMMETRY, 1\n*DSLOAD\nTOP, P, \"500/(100*A)\"\n"
               "%s*PRINT, ENERGY, FREQUENCY=0\n*END STEP\n",
               nc, 0.96 / nc, accuracy);
  CK_EXIT(job_run(&j, ""), 0, j);
  return j;
}

TEST(error_of_the_mesh_is_near_the_true_one) {
  double strain, fine_strain;
  JOB fine = press(16, "");
  double least = job_potential(&fine, &fine_strain);
  for (int nc = 4; nc <= 8; nc *= 2) {
    JOB j = press(nc, "*ACCURACY, MESH=YES, SOLVER=NO\n");
    double told = last_of(&j, MESH_COLUMN);
    double is = 100 * sqrt(2 * (job_potential(&j, &strain) - least)) /
                sqrt(2 * fine_strain);
    ck_assert_msg(told > 0.7 * is && told < 1.5 * is, "%d: told %g, is %g", nc,
                  told, is);
    ck_assert(isnan(last_of(&j, SOLVER_COLUMN)));
  }
}

TEST(budget_stands_in_every_result) {
  JOB j = roll(2, "*ACCURACY, MESH=YES, TIME=YES\n*PRINT, ELEMENTS\n");
  FREED char *lst = job_file(&j, "lst"), *json = job_file(&j, "json");
  ck_assert_ptr_nonnull(strstr(lst, "  error of the mesh: about "));
  ck_assert_ptr_nonnull(strstr(lst, "  error of the steps: about "));
  /* Two times behind two errors, each under its heading. */
  const char *table = strstr(lst, "\n  error in the energy norm ");
  double value[4];
  ck_assert_ptr_nonnull(table);
  const size_t width = strcspn(table + 1, "\n");
  const char *row = table + width + 2;
  ck_assert_uint_eq(strcspn(row, "\n"), width);
  ck_assert_int_eq(sscanf(row + 28, "%lf %lf %lf %lf", &value[0], &value[1],
                          &value[2], &value[3]),
                   4);
  ck_assert_ptr_nonnull(strstr(json, "\"mesh_error_worst_percent\": "));
  ck_assert_ptr_nonnull(strstr(json, "\"time_error_estimate_cpu\": "));
  /* The shares of the elements make up the error. */
  DAT e = job_table(&j, "ELEMENTS", -1);
  double sum = 0;
  for (int i = 0; i < e.n_row; ++i) sum += pow(dat_at(&e, i, "mesh_error"), 2);
  ck_assert_double_eq_tol(sqrt(sum) / last_of(&j, MESH_COLUMN), 1, 0.05);
}

/* Word of a line of JOB.sta, the first after the heading being 1: mesh[%]. */
static void mesh_word(const char *sta, int line, char *word) {
  for (int k = 0; k < line; ++k) sta = strchr(sta, '\n') + 1;
  ck_assert_int_eq(sscanf(sta, "%*s%*s%*s%*s%*s%*s%*s%*s%*s%*s%*s%39s", word),
                   1);
}

/* By default the error of the mesh stands at the last increment of each step,
 * where it is that of MESH=YES; MESH=NO has none. */
TEST(error_of_the_mesh_stands_at_the_end_of_a_step) {
  enum { N = 8 };
  static const char two[] = "*END STEP\n*STEP\n*QUASISTATIC\n0.125, 1.\n";
  PRINTED(all, "*ACCURACY, MESH=YES\n%s", two);
  job j[] = {roll(N, two), roll(N, all), roll(N, "*ACCURACY, MESH=NO\n")};
  char *sta[2] = {job_file(&j[0], "sta"), job_file(&j[1], "sta")};
  for (int i = 1; i <= 2 * N; ++i) {
    char word[2][40];
    for (int k = 0; k < 2; ++k) mesh_word(sta[k], i, word[k]);
    ck_assert_str_ne(word[1], "-");
    ck_assert_str_eq(word[0], i % N == 0 ? word[1] : "-");
  }
  ck_assert(isnan(last_of(&j[2], MESH_COLUMN)));
  for (int k = 0; k < 2; ++k) free(sta[k]);
  for (int k = 0; k < 3; ++k) job_end(&j[k]);
}

/* The closing sentence names the largest error and what halving its cause gives
 * and costs; nothing where no error is known. */
TEST(the_error_to_improve_next_is_told) {
  job j[] = {roll(8, ""), roll(2, "*ACCURACY, MESH=NO\n"),
             roll(2, "*ACCURACY, TIME=YES\n*SOLVER, TOL=BALANCED\n")};
  char *lst[3];
  for (int k = 0; k < 3; ++k) lst[k] = job_file(&j[k], "lst");
  PRINTED(of_mesh,
          "improve next: the mesh: half the length of the elements gives "
          "about %.2g %% for up to 5 times the CPU",
          0.5 * figure(&j[0], "mesh_error_percent"));
  ck_assert_msg(strstr(lst[0], of_mesh) != NULL, "%s", of_mesh);
  ck_assert_ptr_nonnull(strstr(lst[0], "the solver is "));
  ck_assert_ptr_nonnull(strstr(lst[0], "the error of the steps is unknown"));
  for (int k = 0; k < 3; ++k)
    ck_assert_int_eq(strstr(lst[k], "unknown without *ACCURACY, TIME=YES") != 0,
                     k < 2);
  ck_assert_ptr_null(strstr(lst[1], "improve next"));
  ck_assert_ptr_nonnull(strstr(lst[2], "improve next: the mesh"));
  ck_assert_ptr_null(strstr(lst[2], "the solver is "));
  for (int k = 0; k < 3; ++k) {
    free(lst[k]);
    job_end(&j[k]);
  }
}

UNIT_MAIN("budget")
