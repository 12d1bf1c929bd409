/*
 * TOL=BALANCED: the contact solver stops at a share of the other errors. The
 * error it leaves is measured against the answer to 1E-10 on the same mesh, in
 * the energy norm; iterations are counted, never seconds.
 */
#include "support/job.h"
#include "support/unit.h"

const int job_without_fields = 1;

/* The block of greco with N = 16 in increments of dt. */
static job run_block(double dt, const char *solver, const char *more) {
  job j =
      job_with("balanced", "input/greco/greco.geo",
               "*PARAMETER\nN = 16\n*MESH, FILE=greco.geo\n*MATERIAL, NAME=M\n"
               "*ELASTIC\n130.D3, 0.2\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
               "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
               "*CONTACT, NAME=C, GROUP=CONTACT, OBSTACLE=O\n"
               "*FRICTION, CONTACT=C, LAW=COULOMB\n1.0\n*AMPLITUDE, NAME=A\n"
               "\"sin(2*t)\"\n*STEP\n*QUASISTATIC\n%g, 1.0\n*BOUNDARY\n"
               "SYMMETRY, 1\n*DSLOAD\nTOP, P, 50.\nLEFT, P, 150., A\n"
               "*SOLVER, %s\n%s*PRINT, CONTACT, ENERGY\n*END STEP\n",
               dt, solver, more);
  int code = job_run(&j, "");
  ck_assert_msg(code == 0, "%s: exit %d: %s", solver, code, j.errors);
  return j;
}

static double figure(const job *j, const char *name) {
  char wanted[80], *json = job_file(j, "json");
  double value = NAN;
  snprintf(wanted, sizeof wanted, "\"%s\": ", name);
  char *at = strstr(json, wanted);
  ck_assert_msg(at != NULL, "%s is not told", name);
  sscanf(at + strlen(wanted), "%lf", &value);
  free(json);
  return value;
}

static double iterations(const job *j) {
  FREED char *json = job_file(j, "json");
  double sum = 0;
  for (char *at = json; (at = strstr(at, "\"iterations\": ")) != NULL; ++at)
    sum += atof(at + strlen("\"iterations\": "));
  return sum;
}

static const char *const methods[] = {"METHOD=SOR", "METHOD=AITKEN",
                                      "METHOD=AUTO"};

/* The error left is at most the share of that of the mesh. Methods that relax
 * make less than half the iterations, AUTO (Newton) not more. */
TEST(error_left_is_the_share_of_the_mesh) {
  for (int i = 0; i < 3; ++i) {
    JOB exact = run_block(0.1, methods[i], "");
    PRINTED(words, "%s, TOL=BALANCED", methods[i]);
    JOB j = run_block(0.1, words, "");
    double others = figure(&j, "mesh_error_percent");
    for (int k = 0; k < 10; ++k)
      ck_assert_msg(job_difference(&j, &exact, k) < 0.07 * others,
                    "%s %d: %g of %g %%", words, k,
                    job_difference(&j, &exact, k), others);
    double full = iterations(&exact), made = iterations(&j);
    ck_assert_msg(made <= (i < 2 ? 0.5 : 1.0) * full, "%s: %g of %g", words,
                  made, full);
  }
}

/* Examples with AUTO: the iterations made, over those of the default, and
 * the growth of the total error, of mesh and solver. */
static void check_example(const char *deck, const char *words, double most) {
  JOB exact, j;
  ck_assert_int_eq(job_run_with(&exact, deck, "", 0, words), 0);
  ck_assert_int_eq(job_run_with(&j, deck, "*SOLVER, TOL=BALANCED\n", 0, words),
                   0);
  double others = figure(&j, "mesh_error_worst_percent");
  double solver = figure(&j, "solver_error_worst_percent");
  double full = iterations(&exact), made = iterations(&j);
  ck_assert_msg(made <= most * full, "%s: %g of %g", deck, made, full);
  ck_assert_msg(solver <= 0.05 * others, "%s: %g of %g %%", deck, solver,
                others);
}

/* The bounds of all increments, of twenty here, are within the share. */
TEST(examples_save_a_part_of_the_steps) {
  check_example("input/hertz_line/hertz_line_friction", "", 0.8);
  check_example("input/greco/greco", "-D N=16", 0.7);
  check_example("input/creep_block/creep_block", "-D N=16", 0.7);
}

/* Against the closed form: the true error of what relaxation leaves undone, and
 * of Newton's method, is that of the mesh. */
TEST(true_error_grows_by_less_than_a_tenth) {
  static const char *const hertz = "input/hertz_line/hertz_exact";
  for (int i = 0; i < 3; ++i) {
    JOB exact, j;
    PRINTED(full, "*SOLVER, %s\n", methods[i]);
    PRINTED(words, "*SOLVER, %s, TOL=BALANCED\n", methods[i]);
    ck_assert_int_eq(job_run_with(&exact, hertz, full, 0, "-D N=6"), 0);
    ck_assert_int_eq(job_run_with(&j, hertz, words, 0, "-D N=6"), 0);
    double before = figure(&exact, "true_error_percent");
    double now = figure(&j, "true_error_percent");
    ck_assert_msg(now <= 1.1 * before, "%s: %g %g", words, now, before);
    ck_assert_double_le(iterations(&j), (i < 2 ? 0.7 : 1) * iterations(&exact));
  }
}

/* Number of an increment, from 0. */
static double figure_at(const job *j, const char *name, int increment) {
  char wanted[80], *json = job_file(j, "json"), *at = json;
  snprintf(wanted, sizeof wanted, "\"%s\": ", name);
  at = strstr(at, "\"increments\": [");
  for (int k = 0; at != NULL && k <= increment; ++k)
    at = strstr(at + 1, wanted);
  ck_assert_msg(at != NULL, "%s is not told", name);
  double value = atof(at + strlen(wanted));
  free(json);
  return value;
}

/* What is said to be saved is what the other run makes more, to a half. */
TEST(saved_iterations_are_those_of_the_default) {
  JOB exact = run_block(0.1, methods[0], "");
  JOB j = run_block(0.1, "METHOD=SOR, TOL=BALANCED", "");
  double told = figure(&j, "balanced_saved_iterations");
  double is = iterations(&exact) - iterations(&j);
  ck_assert_msg(told > 0.5 * is && told < 1.5 * is, "told %g, is %g", told, is);
  /* each takes as long as one that was made, as far as clocks tell */
  FREED char *json = job_file(&j, "json");
  const char *line = strstr(json, "\"stage\": \"contact solver\"");
  ck_assert_ptr_nonnull(line);
  const double spent = atof(strstr(line, "\"cpu\": ") + strlen("\"cpu\": "));
  ck_assert_double_lt(figure(&j, "balanced_saved_cpu"),
                      3 * spent * told / iterations(&j));
  char *lst = job_file(&j, "lst");
  ck_assert_ptr_nonnull(strstr(lst, "stopping balanced with the other errors"));
  const char *last = NULL, *next = lst;
  while ((next = strstr(next, "  balanced: ")) != NULL) last = next++;
  ck_assert_ptr_nonnull(last);
  double last_wanted = figure_at(&j, "balanced_wanted_percent", 9);
  ck_assert_double_eq_tol(
      strtod(last + strlen("  balanced: "), NULL) / last_wanted, 1, 0.1);
  free(lst);
}

static double energy_at(const job *j, int k) {
  return job_value(j, "ENERGY", k, "strain_energy");
}

/* A smaller share: a smaller error; the error of increments counts too, that of
 * the last one known. Of what those before have left of it each increment has
 * its part by time. */
TEST(share_is_that_of_the_deck) {
  JOB few = run_block(0.25, "METHOD=SOR, TOL=BALANCED, SHARE=0.5", "");
  JOB many = run_block(0.25, "METHOD=SOR, TOL=BALANCED, SHARE=0.005",
                       "*ACCURACY, TIME=YES\n");
  double others = figure(&few, "mesh_error_percent");
  ck_assert_double_le(figure(&few, "solver_error_worst_percent"), 0.5 * others);
  ck_assert_double_le(
      figure(&many, "solver_error_percent"),
      0.005 * (others + 2 * figure(&many, "time_error_worst_percent")));
  ck_assert_double_lt(iterations(&few), iterations(&many));
  for (int k = 2; k < 4; ++k) { /* before that nothing slips */
    double of_mesh = figure_at(&many, "mesh_error_percent", k);
    double of_time = figure_at(&many, "time_error_percent", k - 1);
    double before = figure_at(&many, "solver_error_percent", k - 1) *
                    sqrt(energy_at(&many, k - 1) / energy_at(&many, k));
    ck_assert_double_gt(of_time, 0.05 * of_mesh);
    ck_assert_double_eq_tol(figure_at(&many, "balanced_wanted_percent", k),
                            (0.005 * (of_mesh + of_time) - before) / (4 - k),
                            1e-6 * of_mesh);
  }
}

/* A patch that the elements have exactly has no error to balance with. */
TEST(without_other_errors_the_default_counts) {
  JOB j = job_with(
      "patch", "tests/regression/mesh/square.geo",
      "*MESH, FILE=square.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n"
      "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
      "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
      "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
      "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n*STEP\n*STATIC\n"
      "*BOUNDARY\nLEFT, 1\n*DSLOAD\nTOP, P, 10.\n"
      "*SOLVER, METHOD=SOR, TOL=BALANCED\n*END STEP\n");
  ck_assert_int_eq(job_run(&j, ""), 0);
  ck_assert_double_le(figure(&j, "residual_worst"), 1e-10);
}

/* Bodies that creep by a nonlinear law are in equilibrium: over the square, of
 * equal elements, the stress along the load has the mean of the load. */
TEST(nonlinear_laws_are_in_equilibrium) {
  static const char *const iteration[] = {"TANGENT", "INITIAL"};
  for (int k = 0; k < 2; ++k) {
    JOB j = job_with("creep", "tests/regression/mesh/square.geo",
                     "*PARAMETER\nN = 4\nKIND = 1\n*MESH, FILE=square.geo\n"
                     "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
                     "*INELASTIC, LAW=NORTON\n1.E-5, 3.\n"
                     "*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=CPS3\n"
                     "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
                     "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
                     "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n*STEP\n"
                     "*VISCO, INTEGRATOR=BACKWARD, ITERATION=%s\n0.5, 1.\n"
                     "*BOUNDARY\nLEFT, 1\n*DSLOAD\nTOP, P, \"10+0*t\"\n"
                     "*SOLVER, TOL=BALANCED\n*PRINT, ELEMENTS\n*END STEP\n",
                     iteration[k]);
    ck_assert_int_eq(job_run(&j, ""), 0);
    for (int i = 0; i < 3; ++i) {
      DAT e = job_table(&j, "ELEMENTS", i);
      ck_assert_double_eq_tol(dat_sum(&e, "stress_yy") / e.n_row, -10.0, 1e-7);
    }
  }
}

UNIT_MAIN("balanced")
