/*
 * *GOAL, QUANTITY=SIF: stress intensity factors with their errors against
 * closed forms: open cracks in the middle of a plate and at its edge, a slanted
 * one that slips with friction, the unit disc in space; a target for one.
 */
#include "support/job.h"
#include "support/unit.h"

const int job_without_fields = 1;

static const double pi = 3.14159265358979324;

/* A deck on a mesh of input/crack or of tests/regression/mesh: numbers for it,
 * cards behind *CRACK, supports and loads. */
static job run_crack(const char *geo, const char *numbers, const char *cards,
                     const char *loads) {
  job j = job_begin("crack");
  const int plate = strcmp(geo, "crack") == 0;
  const int disc = strcmp(geo, "penny") == 0;
  PRINTED(path, "%s/%s.geo", plate ? "input/crack" : "tests/regression/mesh",
          geo);
  job_copy(&j, path);
  job_write(&j, "crack.inp",
            "*PARAMETER\n%s\n*MESH, FILE=%s.geo\n*MATERIAL, NAME=M\n"
            "*ELASTIC\n1000., 0.3\n*SOLID SECTION, ELSET=%s, MATERIAL=M\n"
            "*CRACK, NAME=C, GROUP=%s\n%s*STEP\n*STATIC\n%s"
            "*PRINT, SIF, GOALS\n*OUTPUT, HDF5=NO\n*END STEP\n",
            numbers, geo, disc ? "BALL" : "PLATE", disc ? "DISC" : "LINE",
            cards, loads);
  CK_EXIT(job_run(&j, "--no-timing"), 0, j);
  return j;
}

#define PULLED "*DSLOAD\nTOP, P, -1.\nBOTTOM, P, -1.\n"
#define HELD "*BOUNDARY\nPIN, 1, 2\nEND, 2\n"
#define SIF "*GOAL, QUANTITY=SIF, CRACK=C, "

static int has_word(const job *j, const char *word) {
  char wanted[80], *json = job_file(j, "json");
  snprintf(wanted, sizeof wanted, "\"verdict\": \"%s\"", word);
  const int has = strstr(json, wanted) != NULL;
  free(json);
  return has;
}

/* Goal "row": its estimate is that part of the error, the truth within "wide"
 * bands. */
static void check_goal(const job *j, int row, double exact, double least,
                       double most, double wide) {
  dat t = job_table(j, "GOALS", -1);
  const double value = dat_at(&t, row, "value"), e = dat_at(&t, row, "error");
  const double band = dat_at(&t, row, "band");
  const double ratio = e / (exact - value);
  ck_assert_msg(
      ratio > least && ratio < most && fabs(exact - value - e) <= wide * band,
      "goal %d: %.6g, exact %.6g, estimate %g is %g of the error, "
      "%g off, band %g",
      row, value, exact, e, ratio, exact - value - e, band);
  dat_free(&t);
}

/* The value is that of the table SIF, at the tip of the point; K_II is that of
 * the plus lip, which at the left moves back. Of tips that differ in sign alone
 * the positive one is taken. */
TEST(open_crack_in_a_plate) {
  JOB j = run_crack("crack", "N = 12\nANGLE = 30.\nGROWTH = 0.2\nW = 200.",
                    SIF "NAME=ONE, COMPONENT=1\n" SIF
                        "NAME=TWO, "
                        "COMPONENT=2\n" SIF
                        "NAME=LEFT, COMPONENT=2\n"
                        "\"-cos(pi/6)\", -0.5\n",
                    HELD PULLED);
  const double c = cos(pi / 6), s = 0.5;
  check_goal(&j, 0, c * c * sqrt(pi), 0.7, 1.3, 1.2);
  check_goal(&j, 1, c * s * sqrt(pi), 0.6, 1.3, 1.2);
  check_goal(&j, 2, -c * s * sqrt(pi), 0.6, 1.3, 1.2);
  ck_assert(has_word(&j, "reliable"));
  DAT t = job_table(&j, "SIF", -1), g = job_table(&j, "GOALS", -1);
  const int left = dat_row_near(&t, "x", -c);
  ck_assert_double_eq(dat_at(&g, 2, "value"), dat_at(&t, left, "K_II"));
  ck_assert_double_eq(dat_at(&g, 0, "value"),
                      fmax(dat_at(&t, 0, "K_I"), dat_at(&t, 1, "K_I")));
}

/* Without a point the largest factor is taken, which may be negative: pulled
 * more on the left. */
TEST(largest_factor_is_negative) {
  job j = run_crack("crack", "N = 4\nANGLE = 30.\nGROWTH = 0.4\nW = 3.",
                    SIF "NAME=TWO, COMPONENT=2\n",
                    HELD
                    "*DSLOAD\nTOP, P, \"x-5\"\n"
                    "BOTTOM, P, \"x-5\"\n");
  dat t = job_table(&j, "SIF", -1), g = job_table(&j, "GOALS", -1);
  const double left = dat_at(&t, dat_row_near(&t, "x", -cos(pi / 6)), "K_II");
  ck_assert_double_lt(left, -2.0);
  ck_assert_double_eq(dat_at(&g, 0, "value"), left);
  dat_free(&t);
  dat_free(&g);
  job_end(&j);
}

/* K = sqrt(pi) of a pressure of 1, half of it more and less by one of x: 2.5 at
 * the right tip and 1.5 at the left; the shear of 0.4 of one lip adds its force
 * times (kappa-1)/(kappa+1)/(2 sqrt(pi)), kappa = 1.8 (Tada, Paris, Irwin). */
TEST(crack_loaded_on_its_lips) {
  JOB j = run_crack("crack", "N = 25\nANGLE = 0.\nW = 200.",
                    SIF "NAME=ONE, COMPONENT=1\n1., 0.\n" SIF
                        "NAME=OTHER, COMPONENT=1\n-1., 0.\n",
                    HELD
                    "*DSLOAD\nLINE+, P, \"2+x\"\nLINE-, P, \"2+x\"\n"
                    "LINE+, TX, 0.4\n");
  const double more = 0.4 * 0.8 / 2.8 / sqrt(pi);
  check_goal(&j, 0, 2.5 * sqrt(pi) + more, 0.6, 1.3, 1.0);
  check_goal(&j, 1, 1.5 * sqrt(pi) - more, 0.7, 1.3, 1.0);
}

/* A pressure of x opens it from -1/3 to 1 alone (Bui): the estimate follows how
 * far, whatever the lengths of neighbouring elements. */
TEST(crack_that_is_closed_in_part) {
  static const char *const sizes[] = {"N = 50", "N = 100"};
  for (int i = 0; i < 2; ++i) {
    PRINTED(numbers, "%s\nANGLE = 0.\nW = 200.", sizes[i]);
    JOB j = run_crack("crack", numbers, SIF "NAME=ONE, COMPONENT=1\n",
                      HELD "*DSLOAD\nLINE+, P, \"x\"\nLINE-, P, \"x\"\n");
    check_goal(&j, 0, 2.0 / 3.0 * sqrt(2.0 / 3.0 * pi), 0.5, 2.0, 1.0);
  }
}

TEST(crack_at_an_edge) {
  JOB j = run_crack("edge", "N = 20\nW = 300.", SIF "NAME=ONE, COMPONENT=1\n",
                    "*BOUNDARY\nPIN, 1, 2\nEND, 1\n" PULLED);
  check_goal(&j, 0, 1.12152 * sqrt(pi), 0.7, 1.3, 1.2);
}

/* A factor of the only tip is taken whatever its sign and its size, and is
 * linear in the load while the crack is open. */
TEST(factor_may_be_large_and_negative) {
  double K[3];
  for (int k = 0; k < 3; ++k) {
    PRINTED(loads,
            "*BOUNDARY\nPIN, 1, 2\nEND, 1\n*DSLOAD\nTOP, P, -60.\n"
            "BOTTOM, P, -60.\nTOP, TX, %d\nBOTTOM, TX, %d\n",
            20 * (k - 1), 20 * (1 - k));
    JOB j = run_crack("edge", "N = 6\nW = 5.", SIF "NAME=TWO, COMPONENT=2\n",
                      loads);
    K[k] = job_value(&j, "GOALS", -1, "value");
  }
  ck_assert_double_lt(fmin(K[0], K[2]), -2.0);
  ck_assert_double_gt(fmax(K[0], K[2]), 2.0);
  ck_assert_double_eq_tol(0.5 * (K[0] + K[2]), K[1], 1e-9);
}

/* Three and four elements on half a crack: the estimate has half of the error
 * and is not called reliable; the band has it. */
TEST(few_elements_round_the_tip) {
  for (int n = 3; n <= 4; ++n) {
    PRINTED(numbers, "N = %d\nANGLE = 0.\nGROWTH = 0.4\nW = 200.", n);
    JOB j =
        run_crack("crack", numbers, SIF "NAME=ONE, COMPONENT=1\n", HELD PULLED);
    check_goal(&j, 0, sqrt(pi), 0.4, 0.6, 1.0);
    ck_assert(has_word(&j, "few_elements"));
  }
}

/* The plate turned by its supports: the same factors and errors. */
TEST(plate_that_turns) {
  static const char *const supports[] = {
      "*BOUNDARY\nPIN, 1, 2\nEND, 1\n",
      "*BOUNDARY\nPIN, 1, 2\nEND, 1, 1, 5.\n"};
  double value[2][2], error[2][2];
  for (int k = 0; k < 2; ++k) {
    PRINTED(loads, "%s%s", supports[k], PULLED);
    JOB j = run_crack(
        "edge", "N = 6\nW = 5.",
        SIF "NAME=ONE, COMPONENT=1\n" SIF "NAME=TWO, COMPONENT=2\n", loads);
    DAT t = job_table(&j, "GOALS", -1);
    for (int i = 0; i < 2; ++i) {
      value[k][i] = dat_at(&t, i, "value");
      error[k][i] = dat_at(&t, i, "error");
    }
  }
  ck_assert_double_gt(value[0][0], 1.9);
  for (int i = 0; i < 2; ++i) {
    ck_assert_double_eq_tol(value[1][i], value[0][i], 1e-9);
    ck_assert_double_eq_tol(error[1][i], error[0][i], 1e-9);
  }
}

/* A strip of half the width W and a crack of half the length 1: lengths of the
 * elements beside it and at its tips. */
static job run_strip(double W, double beside, double at_tip) {
  job j = job_begin("crack");
  job_write(
      &j, "strip.geo",
      "W = %g; A = %g; B = %g;\n"
      "Point(1) = {-W, -3*W, 0, A}; Point(2) = {W, -3*W, 0, A};\n"
      "Point(3) = {W, 3*W, 0, A}; Point(4) = {-W, 3*W, 0, A};\n"
      "Point(5) = {-1, 0, 0, B}; Point(6) = {1, 0, 0, B};\n"
      "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4};\n"
      "Line(4) = {4, 1}; Line(5) = {5, 6}; Curve Loop(1) = {1, 2, 3, 4};\n"
      "Plane Surface(1) = {1}; Line{5} In Surface{1};\n"
      "Physical Curve(\"BOTTOM\") = {1}; Physical Curve(\"TOP\") = {3};\n"
      "Physical Curve(\"LINE\") = {5}; Physical Surface(\"PLATE\") = {1};\n"
      "Physical Point(\"PIN\") = {1}; Physical Point(\"END\") = {2};\n",
      W, beside, at_tip);
  job_write(&j, "crack.inp",
            "*MESH, FILE=strip.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
            "*SOLID SECTION, ELSET=PLATE, MATERIAL=M\n"
            "*CRACK, NAME=C, GROUP=LINE\n" SIF
            "NAME=RIGHT, COMPONENT=1\n1., 0.\n" SIF
            "NAME=LEFT, COMPONENT=1\n-1., 0.\n"
            "*STEP\n*STATIC\n" HELD PULLED
            "*PRINT, GOALS\n*OUTPUT, HDF5=NO\n*END STEP\n");
  ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
  return j;
}

/* As wide as two cracks, coarse beside them (Tada: within 0.1 %): the estimate
 * lacks a third of the error, which the band has, with few elements at the tips
 * and with many. */
TEST(wide_crack_in_a_coarse_strip) {
  static const double beside[2] = {0.35, 0.7}, at_tip[2] = {1.0 / 6, 1.0 / 20};
  const double F = (1 - 0.025 * 0.25 + 0.06 * 0.0625) / sqrt(cos(pi / 4));
  for (int k = 0; k < 2; ++k) {
    JOB j = run_strip(2.0, beside[k], at_tip[k]);
    for (int i = 0; i < 2; ++i) check_goal(&j, i, F * sqrt(pi), 0.5, 1.3, 1.0);
  }
}

/* Fine at the tips, but with one element from the domain to the surface: an
 * estimate of a third of the error. */
TEST(domain_of_long_elements) {
  JOB j = run_strip(1.43, 0.7, 1.0 / 40);
  ck_assert(has_word(&j, "few_elements"));
  ck_assert(!has_word(&j, "reliable"));
}

/* K_II = (tau - mu sigma) sqrt(pi): contact forces and slip have their part in
 * the adjoint; another goal of the same body has an estimate too. */
TEST(closed_crack_that_slips) {
  const double tau = 0.5 * cos(pi / 6), sigma = 0.25;
  JOB j = run_crack("crack", "N = 12\nANGLE = 30.\nGROWTH = 0.3\nW = 200.",
                    "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n" SIF
                    "NAME=TWO, COMPONENT=2\n"
                    "*GOAL, NAME=SHUT, QUANTITY=FORCE, CONTACT=C\n",
                    HELD "*DSLOAD\nRIGHT, P, 1.\nLEFT, P, 1.\n");
  check_goal(&j, 0, (tau - 0.3 * sigma) * sqrt(pi), 0.5, 1.5, 1.0);
  ck_assert(!has_word(&j, "not_covered"));
}

/* What forces of the contact solver are in error: those on the lips count. */
TEST(error_of_the_solver_in_a_factor) {
  double value[2], solver[2];
  for (int k = 0; k < 2; ++k) {
    JOB j = run_crack("crack", "N = 4\nANGLE = 30.\nGROWTH = 0.3\nW = 3.",
                      "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n" SIF
                      "NAME=TWO, COMPONENT=2\n",
                      k == 0 ? HELD "*DSLOAD\nRIGHT, P, 1.\nLEFT, P, 1.\n"
                             : HELD
                          "*DSLOAD\nRIGHT, P, 1.\nLEFT, P, 1.\n"
                          "*SOLVER, METHOD=SOR, TOL=1E-3\n");
    DAT t = job_table(&j, "GOALS", -1);
    value[k] = dat_at(&t, 0, "value");
    solver[k] = dat_at(&t, 0, "solver_error");
  }
  ck_assert_double_gt(fabs(value[1] - value[0]), 1e-6);
  ck_assert_double_lt(fabs(solver[0]), 1e-9);
  ck_assert_double_eq_tol(solver[1], value[0] - value[1],
                          0.01 * fabs(value[0] - value[1]));
}

/* Where all of a crack sticks the body moves, and is in error, as if there were
 * none. */
TEST(crack_that_sticks_is_none) {
  double error[2];
  for (int k = 0; k < 2; ++k) {
    JOB j = job_with(
        "crack", "input/crack/crack.geo",
        "*PARAMETER\nN = 4\nANGLE = 30.\nGROWTH = 0.3\nW = 3.\n"
        "*MESH, FILE=crack.geo\n*MATERIAL, NAME=M\n"
        "*ELASTIC\n1000., 0.3\n*SOLID SECTION, ELSET=PLATE, MATERIAL=M\n"
        "%s*GOAL, NAME=U, QUANTITY=DISPLACEMENT, COMPONENT=1\n3., -3.\n"
        "*STEP\n*STATIC\n" HELD
        "*DSLOAD\nRIGHT, P, \"2+0.5*y\"\nLEFT, P, \"2+0.5*y\"\n"
        "*PRINT, GOALS\n*OUTPUT, HDF5=NO\n*END STEP\n",
        k == 0 ? ""
               : "*CRACK, NAME=C, GROUP=LINE\n"
                 "*FRICTION, CONTACT=C, LAW=COULOMB\n5.\n");
    ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
    error[k] = job_value(&j, "GOALS", -1, "error");
  }
  ck_assert_double_eq_tol(error[1], error[0], 4e-4 * fabs(error[0]));
}

/* Both lips of a crack have a node at its points: that above counts, of a body
 * that is cut the one with larger x. */
TEST(points_of_a_crack_are_on_the_lip_above) {
  JOB j = job_with(
      "cut", "tests/regression/bad/square.msh",
      "*MESH, FILE=square.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
      "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
      "*CRACK, NAME=C, GROUP=MIDDLE\n"
      "*GOAL, NAME=A, QUANTITY=DISPLACEMENT, COMPONENT=1\n0.5, 0.\n"
      "*GOAL, NAME=B, QUANTITY=DISPLACEMENT, COMPONENT=1\n0.5, 0.5\n"
      "*GOAL, NAME=C, QUANTITY=DISPLACEMENT, COMPONENT=1\n0.5, 1.\n"
      "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1, 2\nRIGHT, 1, 1, 0.1\n"
      "RIGHT, 2, 2\n*PRINT, GOALS\n*OUTPUT, HDF5=NO\n*END STEP\n");
  ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
  DAT t = job_table(&j, "GOALS", -1);
  for (int k = 0; k < 3; ++k)
    ck_assert_double_eq_tol(dat_at(&t, k, "value"), 0.1, 1e-12);
}

/* In space the integral itself lacks some percent: the band has it, and it is
 * not called reliable. */
TEST(disc_in_space) {
  JOB j = run_crack("penny", "N = 8", SIF "NAME=ONE, COMPONENT=1\n1., 0., 0.\n",
                    "*BOUNDARY\nSKIN, 1, 3\n*DSLOAD\nDISC+, P, 1.\n"
                    "DISC-, P, 1.\n");
  check_goal(&j, 0, 2.0 / sqrt(pi), 0.1, 1.5, 1.0);
  ck_assert(has_word(&j, "crack_front"));
}

/* No space for a domain; heat that varies. */
TEST(no_factor_no_estimate) {
  JOB j = run_crack("crack", "N = 1\nANGLE = 0.\nGROWTH = 0.9",
                    SIF "NAME=ONE, COMPONENT=1\n", HELD PULLED);
  ck_assert(has_word(&j, "no_factor"));
}

TEST(target_of_a_factor) {
  JOB j = run_crack("crack", "N = 4\nANGLE = 0.\nGROWTH = 0.3\nW = 200.",
                    SIF "NAME=ONE, COMPONENT=1, TARGET=0.02\n", HELD PULLED);
  check_goal(&j, 0, sqrt(pi), 0.7, 1.3, 1.0);
  ck_assert_double_eq_tol(job_value(&j, "GOALS", -1, "value"), sqrt(pi), 0.02);
  FREED char *json = job_file(&j, "json");
  ck_assert_ptr_nonnull(strstr(json, "\"passes\""));
  ck_assert_ptr_nonnull(strstr(json, "\"unit\": \"force/length^1.5\""));
}

/* Other goals are in error at the tip, beyond its elements too. */
TEST(tip_is_an_end_for_other_goals) {
  JOB j = run_crack("crack", "N = 12\nANGLE = 0.\nGROWTH = 0.3\nW = 3.",
                    "*GOAL, NAME=E, QUANTITY=ENERGY\n", HELD PULLED);
  ck_assert(has_word(&j, "support_end"));
}

/* Between two materials there is no estimate. */
TEST(target_of_an_interface_is_refused) {
  JOB j = job_begin("joint");
  job_write(&j, "joint.geo",
            "For k In {0:2}\nPoint(4*k+1)={0,k,0,.5};Point(4*k+2)={1,k,0,.5};"
            "Point(4*k+3)={2,k,0,.5};Point(4*k+4)={3,k,0,.5};\n"
            "For i In {1:3}\nLine(10*k+i)={4*k+i,4*k+i+1};\nEndFor\nEndFor\n"
            "For k In {0:1}\nLine(40+k)={4*k+1,4*k+5};\n"
            "Line(50+k)={4*k+4,4*k+8};\nLine Loop(k+1)={10*k+1,10*k+2,10*k+3,"
            "50+k,-10*k-13,-10*k-12,-10*k-11,-40-k};\nPlane Surface(k+1)={k+1};"
            "\nEndFor\nPhysical Surface(\"LOW\")={1};\n"
            "Physical Surface(\"HIGH\")={2};\nPhysical Line(\"SLIT\")={12};\n"
            "Physical Line(\"TOP\")={21,22,23};\n"
            "Physical Line(\"FOOT\")={1,2,3};\n");
  job_write(&j, "joint.inp",
            "*MESH, FILE=joint.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
            "*MATERIAL, NAME=N\n*ELASTIC\n2000., 0.3\n"
            "*SOLID SECTION, ELSET=LOW, MATERIAL=M\n"
            "*SOLID SECTION, ELSET=HIGH, MATERIAL=N\n"
            "*CRACK, NAME=C, GROUP=SLIT\n"
            "*GOAL, NAME=E, QUANTITY=ENERGY, TARGET=1 %%\n"
            "*STEP\n*STATIC\n*BOUNDARY\nFOOT, 1, 2\n*DSLOAD\nTOP, P, -1.\n"
            "*END STEP\n");
  ck_assert_int_eq(job_run(&j, ""), 2);
  ck_assert_ptr_nonnull(
      strstr(j.errors, "error P2066: *CRACK between two materials: TARGET="));
}

/* The error scatters by as much as little finer meshes gain. */
TEST(target_on_meshes_that_scatter) {
  JOB j = run_crack("crack", "N = 5\nANGLE = 40.\nGROWTH = 0.2\nW = 200.",
                    "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n" SIF
                    "NAME=TWO, COMPONENT=2, TARGET=1 %\n",
                    HELD "*DSLOAD\nRIGHT, P, 1.\nLEFT, P, 1.\n");
  const double exact = 0.65306258;
  ck_assert_double_eq_tol(job_value(&j, "GOALS", -1, "value"), exact,
                          0.01 * exact);
}

/* Where its elements at the tips were as small as their errors ask for, nodes
 * there opened and closed by turns, and no mesh had a smaller error. */
TEST(target_of_a_closed_crack) {
  JOB j = run_crack("crack", "N = 4\nANGLE = 20.\nGROWTH = 0.3\nW = 200.",
                    "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n" SIF
                    "NAME=TWO, COMPONENT=2, TARGET=0.5 %\n",
                    HELD "*DSLOAD\nRIGHT, P, 1.\nLEFT, P, 1.\n");
  const double exact = 0.50745437;
  ck_assert_double_eq_tol(job_value(&j, "GOALS", -1, "value"), exact,
                          0.005 * exact);
}

UNIT_MAIN("goals_cracks")
