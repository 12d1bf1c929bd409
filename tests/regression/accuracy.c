/*
 * The error of the solver in the results of a run. A state (u, r) that a coarse
 * tolerance leaves is compared with one solved to rounding: both satisfy
 * A u = f + r, so that the energy of the error is (u - u*)'(r - r*)/2, from
 * the tables.
 */
#include "support/job.h"
#include "support/unit.h"

const int job_without_fields = 1;

static job run_block(const char *law, const char *cards, const char *solver) {
  job j = job_with("block", "tests/regression/mesh/square.geo",
                   "*PARAMETER\nN = 12\n*MESH, FILE=square.geo\n"
                   "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
                   "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n%s"
                   "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
                   "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
                   "*FRICTION, CONTACT=C, LAW=%s\n"
                   "*STEP\n*STATIC\n*DSLOAD\nTOP, P, 10.\nLEFT, P, \"4*y\"\n"
                   "*SOLVER, %s\n*PRINT, CONTACT, ENERGY\n*END STEP\n",
                   cards, law, solver);
  CK_EXIT(job_run(&j, ""), 0, j);
  return j;
}

/* Column "error[%]" of the last line, NAN for "-". */
static double told_error(const job *j) {
  char *sta = job_file(j, "sta"), word[32] = "";
  ck_assert_ptr_nonnull(strstr(sta, " error[%] "));
  sta[strlen(sta) - 1] = '\0';
  int found =
      sscanf(strrchr(sta, '\n') + 1,
             "%*d %*d %*d %*s %*s %*d %*d %*d %*s %*d %*s %*s %*s %31s", word);
  ck_assert_int_eq(found, 1);
  free(sta);
  return strcmp(word, "-") == 0 ? NAN : atof(word);
}

/* sqrt((u - u*)'(r - r*)) over the energy norm of the body, in %. */
static double true_error(const job *a, const job *b) {
  DAT x = job_table(a, "CONTACT", -1), y = job_table(b, "CONTACT", -1);
  double sum = 0.0;
  ck_assert_int_eq(x.n_row, y.n_row);
  for (int i = 0; i < x.n_row; ++i) {
    sum -= (dat_at(&x, i, "u_n") - dat_at(&y, i, "u_n")) *
           (dat_at(&x, i, "f_n") - dat_at(&y, i, "f_n"));
    sum += (dat_at(&x, i, "u_t") - dat_at(&y, i, "u_t")) *
           (dat_at(&x, i, "f_t") - dat_at(&y, i, "f_t"));
  }
  double size = 2.0 * job_value(b, "ENERGY", -1, "strain_energy");
  return 100.0 * sqrt(fabs(sum) / size);
}

/* Held on the left, or by the contact alone. */
static const char *const supports[] = {"*BOUNDARY\nRIGHT, 1, 2\n", ""};

TEST(told_error_bounds_the_true_one) {
  static const char *const law[] = {"TRESCA\n\"4-3.5*x\"", "COULOMB\n0.3"};
  static const char *const coarse[] = {
      "METHOD=SOR, TOL=1E-2", "METHOD=SOR, TOL=1E-4", "METHOD=SOR, TOL=1E-6"};
  for (int k = 0; k < 12; ++k) {
    int held = k % 2, level = k / 2 % 3;
    JOB exact =
        run_block(law[k / 6], supports[held], "METHOD=NEWTON, TOL=1E-12");
    JOB j = run_block(law[k / 6], supports[held], coarse[level]);
    double bound = told_error(&j), error = true_error(&j, &exact);
    ck_assert_double_lt(told_error(&exact), 1e-8);
    ck_assert_msg(error > 0.0 && bound >= error && bound <= 50 * error,
                  "case %d: told %g %%, is %g %%", k, bound, error);
  }
}

/* Two steps of sliding, the first to "coarse"; both in two increments. */
static job run_steps(const char *law, const char *coarse) {
  job j = job_with("steps", "tests/regression/mesh/square.geo",
                   "*PARAMETER\nN = 12\n*MESH, FILE=square.geo\n"
                   "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
                   "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
                   "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
                   "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
                   "*FRICTION, CONTACT=C, LAW=%s\n"
                   "*STEP\n*QUASISTATIC\n.5, 1.\n*BOUNDARY\nRIGHT, 1, 2\n"
                   "*DSLOAD\nTOP, P, 10.\nLEFT, P, \"4*y*min(t,1.2-.2*t)\"\n"
                   "*SOLVER, %s\n*END STEP\n"
                   "*STEP\n*QUASISTATIC\n.5, 1.\n"
                   "*SOLVER, METHOD=NEWTON, TOL=1E-12\n"
                   "*PRINT, CONTACT, ENERGY\n*END STEP\n",
                   law, coarse);
  CK_EXIT(job_run(&j, ""), 0, j);
  return j;
}

/* What an increment leaves stays in the slip of those after it. */
TEST(told_error_has_the_increments_before) {
  static const char *const law[] = {"TRESCA\n\"4-3.5*x\"", "COULOMB\n0.3"};
  for (int k = 0; k < 2; ++k) {
    JOB exact = run_steps(law[k], "METHOD=NEWTON, TOL=1E-12");
    JOB j = run_steps(law[k], "METHOD=SOR, TOL=1E-2");
    double bound = told_error(&j), error = true_error(&j, &exact);
    ck_assert_double_lt(told_error(&exact), 1e-8);
    ck_assert_msg(error > 1e-6 && bound >= error && bound <= 100 * error,
                  "case %d: told %g %%, is %g %%", k, bound, error);
  }
}

static void must_say(const job *j, const char *suffix, const char *text) {
  FREED char *all = job_file(j, suffix);
  ck_assert_msg(strstr(all, text) != NULL, "no '%s' in .%s", text, suffix);
}

/* The first step has no bound, so those after it have none. */
TEST(no_error_is_told_after_one_that_is_not_known) {
  JOB j = run_steps("COULOMB\n0.3",
                    "METHOD=NEWTON\n*ACCURACY, SOLVER=NO\n*END STEP\n"
                    "*STEP\n*QUASISTATIC\n1., 1.\n*ACCURACY");
  ck_assert(isnan(told_error(&j)));
  must_say(&j, "lst", "no bound, an increment before this one has none");
}

TEST(error_stands_in_every_result) {
  JOB j = run_block("COULOMB\n0.3", supports[0], "METHOD=NEWTON");
  must_say(&j, "lst", "  error of the solver: at most ");
  must_say(&j, "lst", "; contraction ");
  must_say(&j, "lst", "error in the energy norm");
  must_say(&j, "json", "\"solver_error_percent\": ");
  must_say(&j, "json", "\"solver_error_worst_percent\": ");
}

/* Switched off, nothing of it is entered or shown. */
TEST(not_asked_for_not_computed) {
  JOB j = run_block("COULOMB\n0.3", supports[0],
                    "METHOD=NEWTON\n*ACCURACY, SOLVER=NO");
  char *lst = job_file(&j, "lst"), line[64];
  ck_assert_ptr_null(strstr(lst, "error of the solver"));
  snprintf(line, sizeof line, "  %-30s %8d", "error of solver", 0);
  ck_assert_ptr_nonnull(strstr(lst, line));
  ck_assert(isnan(told_error(&j)));
  free(lst);
}

/* A creeping block, pressed and moved on a rough floor and raised again. */
static job run_raised(const char *solver) {
  job j = job_with("raised", "tests/regression/mesh/square.geo",
                   "*PARAMETER\nN = 4\n*MESH, FILE=square.geo\n"
                   "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
                   "*INELASTIC, LAW=MAXWELL\n2.\n"
                   "*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=CPS3\n"
                   "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
                   "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
                   "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n*STEP\n"
                   "*VISCO, INTEGRATOR=BACKWARD\n0.2, 2.\n"
                   "*BOUNDARY\nTOP, 2, 2, -0.01\nTOP, 1, 1, 0.002\n"
                   "*SOLVER, %s\n*PRINT, NODES\n*END STEP\n*STEP\n"
                   "*VISCO, INTEGRATOR=BACKWARD\n0.2, 2.\n*BOUNDARY\nTOP, 2\n"
                   "*END STEP\n",
                   solver);
  const int code = job_run(&j, "");
  ck_assert_msg(code <= 1, "exit %d: %s", code, j.errors);
  return j;
}

/* Largest difference of u_y over the largest u_y, %. */
static double raised_error(const job *a, const job *b) {
  DAT x = job_table(a, "NODES", -1), y = job_table(b, "NODES", -1);
  double most = 0.0, worst = 0.0;
  for (int i = 0; i < x.n_row; ++i) {
    const double right = dat_at(&y, i, "u_y");
    most = fmax(most, fabs(right));
    worst = fmax(worst, fabs(dat_at(&x, i, "u_y") - right));
  }
  return 100 * worst / most;
}

/* What a loose TOL= has left is in the strains that the block keeps when it has
 * no stress. */
TEST(strain_that_is_left_has_the_bound_of_the_solver) {
  static const char *const loose[] = {"METHOD=SOR, TOL=0.1",
                                      "METHOD=LAGRANGE, TOL=0.1"};
  JOB b = run_raised("METHOD=AUTO");
  ck_assert_double_le(told_error(&b), 1e-6);
  for (int i = 0; i < 2; ++i) {
    JOB a = run_raised(loose[i]);
    const double error = raised_error(&a, &b), told = told_error(&a);
    ck_assert_double_gt(error, 0.01);
    ck_assert_msg(told >= error, "told %g %%, error %g %%", told, error);
  }
}

UNIT_MAIN("accuracy")
