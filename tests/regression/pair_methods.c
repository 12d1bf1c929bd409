/*
 * Bodies against each other: all methods, and bodies that pairs alone hold.
 */
#include "support/job.h"
#include "support/unit.h"

const int job_without_fields = 1;

#define PAIR "*CONTACT PAIR, NAME=P\nUNDER, OVER\n"

/* ---- methods ------------------------------------------------------------- */

static const char *const methods[] = {"LEMKE",  "SOR",      "AITKEN",
                                      "PCG",    "LAGRANGE", "AUGLAG",
                                      "NEWTON", "PROXIMAL", "AUTO"};

/* A block narrower than the other, pressed and pushed, both elastic: the edges
 * slip, nodes beyond them have no partner; in space all of it. */
static job run_punch(const char *method, int solid) {
  job j = job_with(
      "punch",
      solid ? "tests/regression/mesh/pair3.geo"
            : "tests/regression/mesh/pair.geo",
      "*PARAMETER\n%s\n*MESH, FILE=%s.geo\n*MATERIAL, NAME=M\n"
      "*ELASTIC\n1000., 0.3\n*SOLID SECTION, ELSET=LOWER, MATERIAL=M\n"
      "*SOLID SECTION, ELSET=UPPER, MATERIAL=M\n"
      "*CONTACT PAIR, NAME=P, SLAVE=FIRST\nUNDER, OVER\n"
      "*FRICTION, CONTACT=P, LAW=COULOMB\n0.3\n"
      "*STEP\n*QUASISTATIC\n0.5, 1.\n*BOUNDARY\nBOTTOM, 1, %d\n*DSLOAD\n"
      "TOP, P, \"3 + 2*x\"\nTOP, TX, 0.5\n"
      "*SOLVER, METHOD=%s, TOL=1E-10\n"
      "*PRINT, CONTACT, TOTALS\n*END STEP\n",
      solid ? "N = 2\nM = 3" : "N = 8\nM = 7\nC = 0.3",
      solid ? "pair3" : "pair", solid ? 3 : 2, method);
  int code = job_run(&j, "--no-timing");
  ck_assert_msg(code == 0, "%s: exit %d: %s", method, code, j.errors);
  return j;
}

static void check_method(const char *method, int solid, const dat *y) {
  JOB j = run_punch(method, solid);
  DAT x = job_table(&j, "CONTACT", -1), t = job_table(&j, "TOTALS", -1);
  const double width = solid ? 1 : 0.4;
  int n_slip = 0;
  for (int i = 0; i < x.n_row; ++i) {
    ck_assert_double_eq_tol(dat_at(&x, i, "f_n"), dat_at(y, i, "f_n"), 1e-7);
    n_slip += dat_at(&x, i, "status") == 1;
  }
  ck_assert_int_gt(n_slip, 0);
  ck_assert_int_lt(n_slip, x.n_row);
  ck_assert_double_eq_tol(dat_at(&t, 0, "normal"), 4 * width, 1e-7);
  ck_assert_double_eq_tol(dat_at(&t, 0, "force_x"), 0.5 * width, 1e-7);
}

TESTS(all_methods_agree, 2) {
  JOB j = run_punch("NEWTON", _i);
  DAT y = job_table(&j, "CONTACT", -1);
  for (size_t k = 0; k < sizeof methods / sizeof *methods; ++k)
    check_method(methods[k], _i, &y);
}

/* ---- bodies that pairs alone hold ----------------------------------------
 */

/* A block on an incline of the slope 0.1, pushed up by F times its weight: it
 * moves from F = (0.1 + mu)/(1 - 0.1 mu) on (NAFEMS CGS-4). */
static int push_up(job *j, double factor) {
  const double mu = 0.3, F = factor * (0.1 + mu) / (1 - 0.1 * mu);
  *j = job_with("wedge", "tests/regression/mesh/pair.geo",
                "*PARAMETER\nN = 5\nM = 3\nA = \"atan(0.1)*180/pi\"\n"
                "*MESH, FILE=pair.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1.E5, 0.3\n"
                "*SOLID SECTION, ELSET=LOWER, MATERIAL=M\n"
                "*SOLID SECTION, ELSET=UPPER, MATERIAL=M\n" PAIR
                "*FRICTION, CONTACT=P, LAW=COULOMB\n%.17g\n"
                "*STEP\n*STATIC\n*BOUNDARY\nBOTTOM, 1, 2\n*DLOAD\n"
                "UPPER, BX, %.17g\nUPPER, BY, -1.\n*PRINT, TOTALS\n*END STEP\n",
                mu, F);
  return job_run(j, "--no-timing");
}

TEST(wedge_moves_at_its_limit) {
  JOB below, above;
  ck_assert_int_eq(push_up(&below, 0.999), 0);
  ck_assert_int_eq(push_up(&above, 1.001), 6);
  ck_assert_ptr_nonnull(strstr(above.errors, "no equilibrium"));
}

/* Blocks of 1 x 1 and the weight 1 on each other, the top one pushed by Q: it
 * slides from mu on, all others carry more. */
static int push_stack(job *j, double Q) {
  *j =
      job_with("stack", "tests/regression/mesh/stack.geo",
               "*MESH, FILE=stack.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1.E5, 0.3\n"
               "*SOLID SECTION, ELSET=BLOCKS, MATERIAL=M\n"
               "*OBSTACLE, NAME=O, TYPE=PLANE\n0, 0\n0, 1\n"
               "*CONTACT, NAME=P0, GROUP=BOTTOM 1, OBSTACLE=O\n"
               "*FRICTION, CONTACT=P0, LAW=COULOMB\n0.3\n");
  FILE *f;
  PRINTED(path, "%s/stack.inp", j->dir);
  f = fopen(path, "a");
  for (int k = 1; k < 5; ++k)
    fprintf(f,
            "*CONTACT PAIR, NAME=P%d\nTOP %d, BOTTOM %d\n"
            "*FRICTION, CONTACT=P%d, LAW=COULOMB\n0.3\n",
            k, k, k + 1, k);
  fprintf(f,
          "*STEP\n*STATIC\n*DLOAD\nBLOCKS, BY, -1.\nBLOCK 5, BX, %.17g\n"
          "*PRINT, TOTALS\n*END STEP\n",
          Q);
  fclose(f);
  return job_run(j, "--no-timing");
}

TEST(stack_stands_by_contact_alone) {
  job j;
  ck_assert_int_eq(push_stack(&j, 0.299), 0);
  DAT t = job_table(&j, "TOTALS", -1);
  ck_assert_int_eq(t.n_row, 5);
  for (int k = 0; k < 5; ++k) {
    ck_assert_double_eq_tol(dat_at(&t, k, "normal"), 5 - k, 1e-9);
    ck_assert_double_eq_tol(fabs(dat_at(&t, k, "force_x")), 0.299, 1e-9);
  }
  job_end(&j);
  ck_assert_int_eq(push_stack(&j, 0.301), 6);
  job_end(&j);
}

/* How far a hot block leans on a soft one when its load has ended: the forces
 * of the heat are far above those of the contact, and the tolerance with them.
 */
static double lean(const char *method) {
  JOB j = job_with("soft", "tests/regression/mesh/pair.geo",
                   "*MESH, FILE=pair.geo\n"
                   "*MATERIAL, NAME=M\n*ELASTIC\n1E3, 0.3\n*EXPANSION\n0.01\n"
                   "*MATERIAL, NAME=S\n*ELASTIC\n1E-2, 0.3\n"
                   "*SOLID SECTION, ELSET=UPPER, MATERIAL=M\n"
                   "*SOLID SECTION, ELSET=LOWER, MATERIAL=S\n" PAIR
                   "*FRICTION, CONTACT=P, LAW=TRESCA\n1E-4\n"
                   "*AMPLITUDE, NAME=A\n0., 0., 0.5, 1., 1., 0.\n"
                   "*STEP\n*QUASISTATIC\n0.5, 1.\n*BOUNDARY\nBOTTOM, 1, 2\n"
                   "*TEMPERATURE\nUPPER, 1.\n*DSLOAD\nTOP, P, 1E-5, A\n"
                   "*SOLVER, METHOD=%s\n*PRINT, NODES\n*END STEP\n",
                   method);
  ck_assert_msg(job_run(&j, "--quiet") == 0, "%s: %s", method, j.errors);
  return job_max(&j, "NODES", -1, "u_x");
}

TEST(body_above_a_soft_one_has_its_place_by_every_method) {
  const double far = lean("PCG");
  for (size_t k = 0; k < sizeof methods / sizeof *methods; ++k)
    ck_assert_double_eq_tol(lean(methods[k]), far, 1e-8);
}

/* Rounding of the stresses of the upper block presses the lower one, which has
 * none, where the load has ended. */
TESTS(rounding_of_stresses_is_no_doubt, 4) {
  static const char *const meshes[] = {"N = 4\nM = 7", "N = 3\nM = 5"};
  JOB j = job_with("ended", "tests/regression/mesh/pair.geo",
                   "*PARAMETER\n%s\n*MESH, FILE=pair.geo\n*MATERIAL, NAME=M\n"
                   "*ELASTIC\n1000., 0.3\n*EXPANSION\n0.001\n"
                   "*SOLID SECTION, ELSET=LOWER, MATERIAL=M\n"
                   "*SOLID SECTION, ELSET=UPPER, MATERIAL=M\n" PAIR
                   "INTERFERENCE, 0.01\n*AMPLITUDE, NAME=A, TIME=TOTAL TIME\n"
                   "\"0.3 - 0.3*t\"\n*STEP\n*QUASISTATIC\n0.25, 1.\n"
                   "*BOUNDARY\nBOTTOM, 2\nLEFT, 1\nRIGHT, 1\n*DSLOAD\n"
                   "TOP, P, 20., A\n*TEMPERATURE\nUPPER, 0.1\n"
                   "*SOLVER, METHOD=%s\n*PRINT, TOTALS\n*END STEP\n",
                   meshes[_i % 2], _i < 2 ? "AUTO" : "LEMKE");
  ck_assert_msg(job_run(&j, "--quiet") == 0, "%s", j.errors);
}

UNIT_MAIN("pair_methods")
