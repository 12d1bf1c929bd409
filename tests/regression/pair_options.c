/*
 * Bodies against each other under all that a deck may ask for: forms,
 * integrators, laws, estimates, targets, reduction, files of condensed
 * problems; bodies between others, corners where pairs meet.
 */
#include "support/job.h"
#include "support/unit.h"

const int job_without_fields = 1;

/* ---- one scene, all options ----------------------------------------------
 */

typedef struct option {
  const char *law, *step, *cards, *in_step;
} option;

/* A block pressed on another and pushed to the right, the upper one narrower;
 * law: cards of the material, LAW=... of friction. */
static int press(job *j, const option *o) {
  *j = job_with("press", "tests/regression/mesh/pair.geo",
                "*PARAMETER\nN = 8\nM = 7\nC = 0.2\n*MESH, FILE=pair.geo\n"
                "*MATERIAL, NAME=A\n*ELASTIC\n1000, 0.3\n%s"
                "*MATERIAL, NAME=B\n*ELASTIC\n1500, 0.25\n"
                "*SOLID SECTION, ELSET=LOWER, MATERIAL=A\n"
                "*SOLID SECTION, ELSET=UPPER, MATERIAL=B\n"
                "*CONTACT PAIR, NAME=P, SLAVE=FIRST\nUNDER, OVER\n"
                "*FRICTION, CONTACT=P, LAW=%s*STEP\n%s"
                "*BOUNDARY\nBOTTOM, 1, 2\n"
                "*DSLOAD\nTOP, P, \"3 + 2*x\"\nTOP, TX, 0.4\n%s"
                "*PRINT, CONTACT, TOTALS, ENERGY\n*END STEP\n",
                o->cards, o->law, o->step, o->in_step);
  return job_run(j, "");
}

#define COULOMB "COULOMB\n0.3\n"
#define INCREMENTS "*QUASISTATIC\n0.5, 1.\n"
#define MAXWELL "*INELASTIC, LAW=MAXWELL\n2.\n"
#define VISCO(by) "*VISCO, INTEGRATOR=" by "\n0.25, 1.\n"

static const option options[] = {
    {COULOMB, INCREMENTS, "", ""},
    {COULOMB, "*STATIC\n", "", ""},
    {COULOMB, "*QUASISTATIC, FORM=VELOCITY\n0.5, 1.\n", "", ""},
    {"TRESCA\n1.\n", INCREMENTS, "", ""},
    {"NONLOCAL, RADIUS=0.5\n0.3\n", INCREMENTS, "", ""},
    {COULOMB, VISCO("EULER"), MAXWELL, ""},
    {COULOMB, VISCO("HEUN"), MAXWELL, ""},
    {COULOMB, VISCO("RK4"), MAXWELL, ""},
    {COULOMB, VISCO("MIDPOINT"), MAXWELL, ""},
    {COULOMB, VISCO("BACKWARD"), MAXWELL, ""},
    {COULOMB, VISCO("EXPONENTIAL"), MAXWELL, ""},
    {COULOMB, VISCO("THETA, THETA=0.6"), MAXWELL, ""},
    {COULOMB, VISCO("MIDPOINT, TOLERANCE=1.E-3"), MAXWELL, ""},
    {COULOMB, VISCO("BACKWARD"), "*INELASTIC, LAW=NORTON\n1.E-6, 3\n", ""},
    {COULOMB, INCREMENTS, "", "*EFFECTS, MODE=AUTO\n"},
    {COULOMB, INCREMENTS, "", "*ACCURACY, MESH=YES, TIME=YES, THEORY=YES\n"},
    {COULOMB, INCREMENTS, "", "*ACCURACY, TARGET=8\n"}};

/* The contact carries the loads 2.4 and 0.24 of the upper block, energies
 * balance. */
TESTS(loads_and_energies_balance, sizeof options / sizeof *options) {
  JOB j;
  CK_EXIT(press(&j, &options[_i]), 0, j);
  ck_assert_double_eq_tol(job_value(&j, "TOTALS", -1, "normal"), 2.4, 1e-8);
  ck_assert_double_eq_tol(job_value(&j, "TOTALS", -1, "force_x"), 0.24, 1e-8);
  ck_assert_double_eq_tol(job_value(&j, "TOTALS", -1, "force_y"), -2.4, 1e-8);
  /* 3 + 2 x over [0.2, 0.8], 0.4 at y = 2 */
  ck_assert_double_eq_tol(job_value(&j, "TOTALS", -1, "moment_z"),
                          -(0.9 + 0.336) - 2 * 0.24, 1e-8);
  ck_assert_double_le(
      fabs(job_value(&j, "ENERGY", -1, "energy_defect_relative")), 1e-10);
}

/* Given normal forces do not balance the loads: who holds the bodies does. */
TEST(given_forces_need_supports) {
  job j;
  option o = {COULOMB "*CONTACT FORCE, CONTACT=P\n4.\n", INCREMENTS, "", ""};
  ck_assert_int_eq(press(&j, &o), 6);
  ck_assert_ptr_nonnull(strstr(j.errors, "nothing holds the body"));
  job_end(&j);
  o.in_step = "*BOUNDARY\nTOP, 2\n";
  ck_assert_int_eq(press(&j, &o), 0);
  ck_assert_double_eq_tol(job_value(&j, "TOTALS", -1, "normal"), 4 * 0.6,
                          1e-12);
  ck_assert_double_eq_tol(job_value(&j, "TOTALS", -1, "force_x"), 0.24, 1e-9);
  job_end(&j);
}

/* ---- condensed problems in files ----------------------------------------- */

static int by_value(const void *a, const void *b) {
  const double x = *(const double *)a, y = *(const double *)b;
  return (x > y) - (x < y);
}

/* A column in ascending order; caller frees. */
static double *sorted(const job *j, const char *name, int *n) {
  DAT t = job_table(j, "CONTACT", -1);
  double *v = calloc((size_t)t.n_row, sizeof *v);
  *n = t.n_row;
  for (int i = 0; i < t.n_row; ++i) v[i] = dat_at(&t, i, name);
  qsort(v, (size_t)t.n_row, sizeof *v, by_value);
  return v;
}

/* What the file of the last increment holds has the same forces. */
TEST(condensed_problem_has_the_same_forces) {
  static const char *const names[] = {"f_n", "f_t", "gap"};
  const option o = {COULOMB, INCREMENTS, "",
                    "*OUTPUT, CONDENSED=FCLIB\n*SOLVER, TOL=1E-13\n"};
  JOB j;
  double *mesh_forces[3];
  int n[3], m;
  ck_assert_int_eq(press(&j, &o), 0);
  for (int k = 0; k < 3; ++k) mesh_forces[k] = sorted(&j, names[k], &n[k]);
  snprintf(j.name, sizeof j.name, "again");
  job_write(&j, "again.inp",
            "*CONDENSED PROBLEM, FILE=press_condensed_00002.h5\n*STEP\n"
            "*STATIC\n*SOLVER, TOL=1E-13\n*PRINT, CONTACT\n*END STEP\n");
  ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
  for (int k = 0; k < 3; ++k) {
    FREED double *v = sorted(&j, names[k], &m);
    ck_assert_int_eq(m, n[k]);
    for (int i = 0; i < m; ++i)
      ck_assert_double_eq_tol(v[i], mesh_forces[k][i], 1e-11);
    free(mesh_forces[k]);
  }
}

/* ---- estimates ----------------------------------------------------------- */

#define SAME(group)                               \
  group ", 1, 1, \"A*sin(x)*cos(y - 1)\"\n" group \
        ", 2, 2, \"A*cos(x)*sin(y - 1)\"\n"
#define FORCE(group)                                \
  group ", BX, \"2*E*A*sin(x)*cos(y - 1)\"\n" group \
        ", BY, \"2*E*A*cos(x)*sin(y - 1)\"\n"

/* nu = 0, u = A (sin x cos(y - 1), cos x sin(y - 1)): at y = 1 no shear, the
 * pressure -E A cos x. Estimated over true error near 1, both with the first
 * order. */
TEST(error_of_the_mesh_is_estimated) {
  static const char *const words[] = {"-D N=8 -D M=11", "-D N=16 -D M=12",
                                      "-D N=16 -D M=22"};
  double is[3];
  for (int k = 0; k < 3; ++k) {
    JOB j = job_with("smooth", "tests/regression/mesh/pair.geo",
                     "*PARAMETER\nA = -0.01\nE = 1000.\n*MESH, FILE=pair.geo\n"
                     "*MATERIAL, NAME=M\n*ELASTIC\n<E>, 0\n"
                     "*SOLID SECTION, ELSET=LOWER, MATERIAL=M\n"
                     "*SOLID SECTION, ELSET=UPPER, MATERIAL=M\n"
                     "*CONTACT PAIR, NAME=P\nUNDER, OVER\n"
                     "*REFERENCE\nu_x, \"A*sin(x)*cos(y - 1)\"\n"
                     "u_y, \"A*cos(x)*sin(y - 1)\"\npressure, \"-E*A*cos(x)\"\n"
                     "*STEP\n*STATIC\n*BOUNDARY\n" SAME("LEFT") SAME("RIGHT")
                         SAME("TOP") SAME("BOTTOM") "*DLOAD\n" FORCE("LOWER")
                             FORCE("UPPER") "*ACCURACY, MESH=YES\n*END STEP\n");
    ck_assert_msg(job_run(&j, words[k]) == 0, "%s", j.errors);
    is[k] = job_told(&j, "true_error_percent");
    const double ratio = job_told(&j, "mesh_error_percent") / is[k];
    ck_assert_msg(ratio > 0.9 && ratio < 1.1, "effectivity %g", ratio);
  }
  ck_assert_double_eq_tol(is[2] / is[0], 0.5, 0.05);
}

/* ---- many bodies --------------------------------------------------------- */

/* Two blocks between base and roof, pressed from above by 3 and together by 1,
 * with friction 0.3 in five pairs. */
static int press_four(job *j, const char *pairs) {
  *j =
      job_with("four", "tests/regression/mesh/four.geo",
               "*MESH, FILE=four.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
               "*SOLID SECTION, ELSET=BODIES, MATERIAL=M\n%s"
               "*STEP\n*QUASISTATIC\n0.5, 1.\n*BOUNDARY\nFLOOR, 1, 2\n*DSLOAD\n"
               "TOP, P, 3.\nLEFT OUT, P, 1.\nRIGHT OUT, P, 1.\n"
               "*PRINT, TOTALS, NODES, ENERGY\n*END STEP\n",
               pairs);
  return job_run(j, "");
}

/* Plates of thickness 1 and 3 touch over 1: the friction of a given limit, and
 * the pressure, whichever is the slave. Another contact comes first. */
TEST(plates_touch_over_the_thinner_one) {
  for (int k = 0; k < 4; ++k) {
    JOB j = job_with(
        "plates", "tests/regression/mesh/pair.geo",
        "*PARAMETER\nN = 8\nM = 7\nC = 0.2\n*MESH, FILE=pair.geo\n"
        "*MATERIAL, NAME=A\n*ELASTIC\n1000, 0.\n"
        "*SOLID SECTION, ELSET=LOWER, MATERIAL=A, THICKNESS=%d\n"
        "*SOLID SECTION, ELSET=UPPER, MATERIAL=A, THICKNESS=%d\n"
        "*OBSTACLE, NAME=FAR, TYPE=GAP\n9.\n"
        "*CONTACT, NAME=LID, GROUP=TOP, OBSTACLE=FAR\n"
        "*CONTACT PAIR, NAME=P, SLAVE=%s\nUNDER, OVER\n"
        "*FRICTION, CONTACT=P, LAW=TRESCA\n1.\n*STEP\n*STATIC\n"
        "*BOUNDARY\nBOTTOM, 1, 2\nTOP, 1, 1, 0.1\n*DSLOAD\nTOP, P, 10\n"
        "*PRINT, TOTALS, ZONES\n*END STEP\n",
        k % 2 ? 1 : 3, k % 2 ? 3 : 1, k < 2 ? "FIRST" : "SECOND");
    CK_EXIT(job_run(&j, ""), 0, j);
    DAT t = job_table(&j, "TOTALS", -1);
    ck_assert_double_eq_tol(dat_at(&t, 1, "normal"), k % 2 ? 18 : 6, 1e-9);
    ck_assert_double_eq_tol(fabs(dat_at(&t, 1, "tangential")), 0.6, 1e-9);
    ck_assert_double_le(dat_at(&t, 1, "closed_area"), 0.6 + 1e-9);
    DAT z = job_table(&j, "ZONES", -1);
    ck_assert_int_gt(z.n_row, 1);
    for (int i = 0; i < z.n_row; ++i) /* the first is that of LID */
      ck_assert_double_eq_tol(
          dat_at(&z, i, "area"),
          (i == 0 && k % 2 ? 3 : 1) * dat_at(&z, i, "extent"), 1e-9);
  }
}

#define FIVE(name, groups, options)                                            \
  "*CONTACT PAIR, NAME=" name options "\n" groups "\n*FRICTION, CONTACT=" name \
  ", LAW=COULOMB\n0.3\n"

/* The base is slave of two pairs side by side, the roof too; the blocks are
 * masters of all; or slaves below and master above; or one pair for both. Each
 * body is in equilibrium. */
TESTS(bodies_between_others_balance, 3) {
  static const char *const pairs[] = {
      FIVE("A", "BASE, LEFT DOWN", "") FIVE("B", "BASE, RIGHT DOWN", "")
          FIVE("C", "LEFT UP, ROOF", "") FIVE("D", "RIGHT UP, ROOF", "")
              FIVE("E", "LEFT IN, RIGHT IN", ""),
      FIVE("A", "LEFT DOWN, BASE", ", SLAVE=FIRST")
          FIVE("B", "RIGHT DOWN, BASE", ", SLAVE=FIRST")
              FIVE("C", "ROOF, LEFT UP", ", SLAVE=FIRST")
                  FIVE("D", "ROOF, RIGHT UP", ", SLAVE=FIRST")
                      FIVE("E", "LEFT IN, RIGHT IN", ""),
      FIVE("A", "DOWN, BASE", "") FIVE("C", "LEFT UP, ROOF", ", SLAVE=FIRST")
          FIVE("D", "RIGHT UP, ROOF", ", SLAVE=SECOND")
              FIVE("E", "LEFT IN, RIGHT IN", ", SLAVE=FIRST")};
  JOB j;
  CK_EXIT(press_four(&j, pairs[_i]), 0, j);
  DAT n = job_table(&j, "NODES", -1), t = job_table(&j, "TOTALS", -1);
  double up = 0;
  for (int k = 0; k < t.n_row; ++k) /* all but the last stand upright */
    if (k < t.n_row - 1) up += dat_at(&t, k, "normal");
  ck_assert_double_eq_tol(up, 2 * 6, 1e-9);
  for (int k = 0; k < 2; ++k)
    ck_assert_double_eq_tol(dat_sum(&n, k == 0 ? "contact_x" : "contact_y"), 0,
                            1e-11);
  ck_assert_double_le(
      fabs(job_value(&j, "ENERGY", -1, "energy_defect_relative")), 1e-10);
  ck_assert_double_eq(job_told(&j, "bodies"), 4);
}

/* At (1, 2) the roof, the right and the left block follow each other, by pairs
 * or by a tie. */
TEST(circle_of_slaves_names_its_pairs) {
  static const char *const last[] = {
      FIVE("E", "RIGHT IN, LEFT IN", ", SLAVE=FIRST"),
      "**\n**\n**\n*TIE, NAME=E, SLAVE=FIRST\nRIGHT IN, LEFT IN\n",
      FIVE("E", "RIGHT IN, LEFT IN", ", SLAVE=SECOND")};
  static const char rest[] = FIVE("C", "LEFT UP, ROOF", ", SLAVE=FIRST")
      FIVE("D", "ROOF, RIGHT UP", ", SLAVE=FIRST") FIVE("A", "BASE, DOWN", "");
  for (int k = 0; k < 3; ++k) {
    JOB j;
    PRINTED(pairs, "%s%s", rest, last[k]);
    CK_EXIT(press_four(&j, pairs), (k < 2 ? 2 : 0), j);
    ck_assert_int_eq(strstr(j.errors, "P4027") != NULL, k < 2);
    PRINTED(e_told, "E of line %d", k == 0 ? 18 : 21);
    const char *const told[] = {"C of line 6", "D of line 10", e_told};
    for (int i = 0; i < 3 && k < 2; ++i)
      ck_assert_msg(strstr(j.errors, told[i]) != NULL, "%s", j.errors);
    ck_assert_int_eq(strstr(j.errors, "A of line") != NULL, 0);
  }
}

/* A dovetail pulled by 0.8 is held by both claws along the normals (3, 1) of
 * its sides: N = 0.8/(2/sqrt(10)) each. Pushed, nothing holds it. */
static int load_dovetail(job *j, double traction) {
  *j = job_with(
      "dovetail", "tests/regression/mesh/dovetail.geo",
      "*MESH, FILE=dovetail.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1.E4, 0.3\n"
      "*SOLID SECTION, ELSET=BODIES, MATERIAL=M\n"
      "*CONTACT PAIR, NAME=L\nLEFT, LEFT CLAW\n"
      "*CONTACT PAIR, NAME=R\nRIGHT, RIGHT CLAW\n"
      "*STEP\n*STATIC\n*BOUNDARY\nWALLS, 1, 2\n*DSLOAD\nTOP, TY, %g\n"
      "*PRINT, TOTALS\n*END STEP\n",
      traction);
  return job_run(j, "--no-timing");
}

TEST(dovetail_holds_one_way) {
  JOB pulled, pushed;
  ck_assert_int_eq(load_dovetail(&pulled, 1), 0);
  ck_assert_int_eq(load_dovetail(&pushed, -1), 6);
  ck_assert_ptr_nonnull(strstr(pushed.errors, "no equilibrium"));
  DAT t = job_table(&pulled, "TOTALS", -1);
  for (int i = 0; i < 2; ++i)
    ck_assert_double_eq_tol(dat_at(&t, i, "normal"), 0.4 * sqrt(10.0), 1e-9);
}

/* ---- slave of two materials -----------------------------------------------
 */

/* A block of two materials with a face each under one with a face, twice as
 * long: from three times the mean of their moduli on the softer is the slave.
 * That of a cubic material is (9 C_11 + 6 C_12 + 12 C_44)/15, C_nnnn in the
 * mean over all directions n (Voigt 1889).
 */
TESTS(modulus_of_a_surface_is_the_mean_of_its_faces, 10) {
  static const struct {
    double left, right;
    const char *told;
    double shear; /* not 0: a cubic material with C_12 = 0 */
  } cases[] = {
      {1, 5.2, "OVER (softer)", 0},    {5.2, 1, "OVER (softer)", 0},
      {1, 4.8, "OVER (coarser)", 0},   {4.8, 1, "OVER (coarser)", 0},
      {0.1, 0.5, "UNDER (softer)", 0}, {0.5, 0.1, "UNDER (softer)", 0},
      {5, 5, "OVER (softer)", 0.1},    {4.8, 4.8, "OVER (coarser)", 0.1},
      {1, 1, "OVER (softer)", 3.1},    {1, 1, "OVER (coarser)", 2.9}};
  char elastic[2][160];
  const double s = cases[_i].shear;
  for (int k = 0; k < 2; ++k) {
    const double C = k == 0 ? cases[_i].left : cases[_i].right;
    sprintf(elastic[k],
            s == 0 ? "*ELASTIC\n%g, 0\n"
                   : "*ELASTIC, TYPE=ANISO\n%g, 0, %g, 0, 0, %g, 0,\n"
                     "0, 0, %g, 0, 0, 0, 0,\n%g, 0, 0, 0, 0, 0, %g\n",
            C, C, C, s, s, s);
  }
  JOB j = job_begin("mean");
  job_write(&j, "mean.msh",
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
            "$PhysicalNames\n6\n1 1 \"BOTTOM\"\n"
            "1 2 \"UNDER\"\n1 3 \"OVER\"\n2 4 \"LEFT\"\n"
            "2 5 \"RIGHT\"\n2 6 \"UPPER\"\n"
            "$EndPhysicalNames\n$Nodes\n10\n"
            "1 0 0 0\n2 1 0 0\n3 2 0 0\n4 0 1 0\n5 1 1 0\n"
            "6 2 1 0\n7 0 1 0\n8 2 1 0\n9 2 2 0\n10 0 2 0\n"
            "$EndNodes\n$Elements\n11\n"
            "1 1 2 1 1 1 2\n2 1 2 1 1 2 3\n"
            "3 1 2 2 2 6 5\n4 1 2 2 2 5 4\n5 1 2 3 3 7 8\n"
            "6 2 2 4 4 1 2 5\n7 2 2 4 4 1 5 4\n"
            "8 2 2 5 5 2 3 6\n9 2 2 5 5 2 6 5\n"
            "10 2 2 6 6 7 8 9\n11 2 2 6 6 7 9 10\n"
            "$EndElements\n");
  job_write(
      &j, "mean.inp",
      "*MESH, FILE=mean.msh\n*MATERIAL, NAME=L\n%s*MATERIAL, NAME=R\n%s"
      "*MATERIAL, NAME=U\n*ELASTIC\n1., 0\n"
      "*SOLID SECTION, ELSET=LEFT, MATERIAL=L\n"
      "*SOLID SECTION, ELSET=RIGHT, MATERIAL=R\n"
      "*SOLID SECTION, ELSET=UPPER, MATERIAL=U\n"
      "*CONTACT PAIR, NAME=P\nUNDER, OVER\n*STEP\n*STATIC\n"
      "*BOUNDARY\nBOTTOM, 1, 2\nUNDER, 1\nUPPER, 1\n*DLOAD\nUPPER, BY, -1e-3\n"
      "*END STEP\n",
      elastic[0], elastic[1]);
  ck_assert_msg(job_run(&j, "--no-timing") == 0, "%s", j.errors);
  FREED char *text = job_file(&j, "lst");
  ck_assert_msg(strstr(text, cases[_i].told) != NULL, "%s: %.60s",
                cases[_i].told, strstr(text, "slave"));
}

/* ---- nodes that are left out ----------------------------------------------
 */

/* A block on another, of which slave nodes carry nothing themselves: one that
 * supports hold, those outside of the master but for 1e-4 of an edge. */
static int leave_out(job *j, const char *shift, const char *more) {
  *j = job_with(
      "left", "tests/regression/mesh/pair.geo",
      "*PARAMETER\nN = 4\nM = 7\nC = %s\n*MESH, FILE=pair.geo\n"
      "*MATERIAL, NAME=A\n*ELASTIC\n1000, 0.3\n"
      "*SOLID SECTION, ELSET=LOWER, MATERIAL=A\n"
      "*SOLID SECTION, ELSET=UPPER, MATERIAL=A\n"
      "*CONTACT PAIR, NAME=P, SLAVE=FIRST\nUNDER, OVER\n"
      "*FRICTION, CONTACT=P, LAW=COULOMB\n0.1\n"
      "*WEAR, CONTACT=P, COEFFICIENT=1.E-4\n*STEP\n*QUASISTATIC\n1., 1.\n"
      "*BOUNDARY\nBOTTOM, 1, 2\n%s*DSLOAD\nTOP, P, \"3 + 2*x\"\n"
      "TOP, TX, 0.8\n*PRINT, CONTACT, TOTALS, WEAR\n*END STEP\n",
      shift, more);
  return job_run(j, "");
}

static void check_sum(const dat *rows, const char *column, const dat *all,
                      const char *total) {
  ck_assert_double_eq_tol(dat_sum(rows, column), dat_at(all, 0, total),
                          1e-12 * (1 + fabs(dat_at(all, 0, "normal"))));
}

/* Rows add up to the resultants, and have the law of friction and of wear
 * each. */
static void check_rows(const job *j) {
  DAT c = job_table(j, "CONTACT", -1), all = job_table(j, "TOTALS", -1);
  DAT w = job_table(j, "WEAR", -1);
  check_sum(&c, "f_n", &all, "normal");
  check_sum(&c, "f_t", &all, "tangential");
  check_sum(&c, "f_x", &all, "force_x");
  check_sum(&c, "f_y", &all, "force_y");
  ck_assert_double_eq_tol(dat_max(&c, "pressure"),
                          dat_at(&all, 0, "pressure_max"), 1e-12);
  double volume = 0.0;
  for (int i = 0; i < c.n_row; ++i) {
    const double f = dat_at(&c, i, "f_n"), limit = dat_at(&c, i, "limit");
    const double slip = dat_at(&c, i, "slip_distance");
    ck_assert_double_eq_tol(limit, 0.1 * f, 1e-9);
    ck_assert_double_le(fabs(dat_at(&c, i, "f_t")), limit + 1e-9);
    ck_assert_double_eq_tol(dat_at(&w, i, "volume"), 1e-4 * f * slip, 1e-12);
    ck_assert_double_eq_tol(dat_at(&c, i, "traction_t") * f,
                            dat_at(&c, i, "pressure") * dat_at(&c, i, "f_t"),
                            1e-9);
    volume += 1e-4 * f * slip;
  }
  ck_assert_double_gt(volume, 1e-8);
  ck_assert_double_eq_tol(dat_at(&all, 0, "worn_volume"), volume, 1e-12);
}

TESTS(rows_add_up_to_the_resultant, 2) {
  static const struct {
    const char *shift, *more;
  } scenes[] = {{"0.2499", "TOP, 1, 1, 0.03\n"}, {"0.", "LEFT, 1, 2\n"}};
  JOB j;
  CK_EXIT(leave_out(&j, scenes[_i].shift, scenes[_i].more), 0, j);
  check_rows(&j);
}

/* Rows with what they carry for a node that a support holds at its place: gap,
 * motion, pressure, wear are those of the others. Blocks of height 1, E = 1000,
 * nu = 0, apart in the mesh; the upper one is moved by (along, up). */
TESTS(rows_beside_a_held_node_are_as_others, 5) {
  static const struct {
    const char *line, *more;
    double mesh, gap, along, up;
  } cases[] = {{"INTERFERENCE, 0.002\n", "", 0, -0.002, 0.4, 0},
               {"CLEARANCE, 0.001\n", "", 0.001, 0.002, 0.4, -0.003},
               {"CLEARANCE, 0.001\n", "", 0.001, 0.002, 0.4, 0.002},
               {"", ", UPDATE=STEP", 0.001, 0.001, 0, 0.002},
               {"INTERFERENCE, 0.102\n*FRICTION, CONTACT=P, LAW=COULOMB\n0.1\n",
                "", 0.1, -0.002, 0.4, 0}};
  const double apart = fmax(0.0, cases[_i].gap + cases[_i].up);
  const double p = 500.0 * (apart - cases[_i].gap - cases[_i].up);
  const double low = 1.0 + cases[_i].mesh;
  const int step = strlen(cases[_i].more) > 0;
  JOB j = job_begin("beside");
  job_write(&j, "beside.msh",
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
            "$PhysicalNames\n7\n0 1 \"HELD\"\n1 2 \"BOTTOM\"\n"
            "1 3 \"UNDER\"\n1 4 \"OVER\"\n1 5 \"TOP\"\n"
            "2 6 \"LOWER\"\n2 7 \"UPPER\"\n$EndPhysicalNames\n"
            "$Nodes\n12\n1 0 0 0\n2 1 0 0\n3 2 0 0\n"
            "4 0 1 0\n5 1 1 0\n6 2 1 0\n7 0 %g 0\n8 1 %g 0\n9 2 %g 0\n"
            "10 0 %g 0\n11 1 %g 0\n12 2 %g 0\n$EndNodes\n$Elements\n17\n"
            "1 15 2 1 1 4\n2 1 2 2 2 1 2\n3 1 2 2 2 2 3\n"
            "4 1 2 3 3 6 5\n5 1 2 3 3 5 4\n6 1 2 4 4 7 8\n"
            "7 1 2 4 4 8 9\n8 1 2 5 5 12 11\n9 1 2 5 5 11 10\n"
            "10 2 2 6 6 1 2 5\n11 2 2 6 6 1 5 4\n12 2 2 6 6 2 3 6\n"
            "13 2 2 6 6 2 6 5\n14 2 2 7 7 7 8 11\n15 2 2 7 7 7 11 10\n"
            "16 2 2 7 7 8 9 12\n17 2 2 7 7 8 12 11\n$EndElements\n",
            low, low, low, low + 1.0, low + 1.0, low + 1.0);
  job_write(&j, "beside.inp",
            "*MESH, FILE=beside.msh\n*MATERIAL, NAME=A\n*ELASTIC\n1000., 0\n"
            "*SOLID SECTION, ELSET=LOWER, MATERIAL=A\n"
            "*SOLID SECTION, ELSET=UPPER, MATERIAL=A\n"
            "*CONTACT PAIR, NAME=P, SLAVE=FIRST%s\nUNDER, OVER\n%s"
            "*WEAR, CONTACT=P, COEFFICIENT=1E-4\n*STEP\n*QUASISTATIC\n"
            "1., 1.\n*BOUNDARY\nBOTTOM, 1, 2\nHELD, 2, 2, %.17g\n"
            "TOP, 1, 1, %g\nTOP, 2, 2, %g\n*PRINT, CONTACT, TOTALS, WEAR, "
            "REACTIONS\n*END STEP\n*STEP\n*QUASISTATIC\n1., 1.\n*END STEP\n",
            cases[_i].more, cases[_i].line, -p / 1000.0, cases[_i].along,
            cases[_i].up);
  ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
  DAT c = job_table(&j, "CONTACT", step), all = job_table(&j, "TOTALS", step);
  DAT w = job_table(&j, "WEAR", step), f = job_table(&j, "REACTIONS", step);
  const int slides = strstr(cases[_i].line, "FRICTION") != NULL;
  const double shear = fabs(dat_at(&all, 0, "tangential"));
  ck_assert_int_eq(c.n_row, 2);
  ck_assert_double_eq_tol(dat_at(&all, 0, "moment_of_both"),
                          cases[_i].mesh * shear, 1e-12);
  ck_assert_int_eq(shear > 0.1, slides);
  if (!slides) ck_assert_double_eq_tol(dat_at(&all, 0, "normal"), 2 * p, 1e-12);
  for (int i = 0; i < c.n_row && !slides; ++i) {
    ck_assert_double_eq_tol(dat_at(&c, i, "pressure"), p, 1e-12);
    ck_assert_double_eq_tol(dat_at(&c, i, "gap"), apart, 1e-15);
    ck_assert_double_eq_tol(fabs(dat_at(&c, i, "u_t")), cases[_i].along, 1e-14);
    ck_assert_double_eq_tol(dat_at(&w, i, "depth"), 4e-5 * p, 1e-15);
  }
  if (!slides)
    ck_assert_double_eq_tol(dat_at(&all, 0, "worn_volume"), 8e-5 * p, 1e-15);
  for (int i = 0; i < f.n_row && !slides; ++i)
    if (dat_at(&f, i, "node_no") == 4)
      ck_assert_double_eq_tol(dat_at(&f, i, "reaction_y"), 0, 1e-12);
}

/* Where two masters meet within a face of the slave, its nodes act on both: a
 * block of nu = 0 on held floors, 0.001 lower, has one pressure. */
TESTS(masters_side_by_side_are_one_floor, 6) {
  static const double ends[] = {0.81, 0.9, 0.95, 1.0, 1.19, 1.2};
  const char *more = _i % 2 ? "CLEARANCE, 0.001\n" : "";
  JOB j =
      job_with("floors", "tests/regression/mesh/floors.geo",
               "*PARAMETER\nC = %g\n*MESH, FILE=floors.geo\n*MATERIAL, NAME=M\n"
               "*ELASTIC\n1000., 0.\n*SOLID SECTION, ELSET=BLOCK, MATERIAL=M\n"
               "*SOLID SECTION, ELSET=FLOORS, MATERIAL=M\n"
               "*CONTACT PAIR, NAME=P, SLAVE=FIRST\nUNDER, LEFT FLOOR\n%s"
               "*CONTACT PAIR, NAME=Q, SLAVE=FIRST\nUNDER, RIGHT FLOOR\n%s"
               "*STEP\n*QUASISTATIC\n1., 1.\n*BOUNDARY\nFLOORS, 1, 2\n"
               "TOP, 1\nTOP, 2, 2, %g\n*PRINT, CONTACT, TOTALS\n*END STEP\n",
               ends[_i], more, more, _i % 2 ? -3e-3 : -2e-3);
  ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
  DAT c = job_table(&j, "CONTACT", -1), all = job_table(&j, "TOTALS", -1);
  ck_assert_double_eq_tol(dat_sum(&c, "f_n"), 2, 1e-12);
  for (int i = 0; i < c.n_row; ++i)
    ck_assert_double_eq_tol(dat_at(&c, i, "pressure"), 1, 1e-11);
  ck_assert_double_eq_tol(dat_sum(&all, "closed_area"), 2, 1e-12);
  ck_assert_double_eq_tol(dat_sum(&all, "moment_z"), 2, 1e-12);
}

/* Over a step the lower floor, which is not touched, changes nothing, whichever
 * axis the step is along. */
TESTS(lower_master_beyond_a_step_is_not_met, 2) {
  static const char *const held[] = {"TOP, 1\nTOP, 2, 2, -2E-3\n",
                                     "TOP, 2\nTOP, 1, 1, 2E-3\n"};
  double normal[2];
  for (int k = 0; k < 2; ++k) {
    JOB j = job_with(
        "step", "tests/regression/mesh/floors.geo",
        "*PARAMETER\nC = 0.7\nS = 0.01\nTURN = %d\n*MESH, FILE=floors.geo\n"
        "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n"
        "*SOLID SECTION, ELSET=BLOCK, MATERIAL=M\n"
        "*SOLID SECTION, ELSET=FLOORS, MATERIAL=M\n"
        "*CONTACT PAIR, NAME=P, SLAVE=FIRST\nUNDER, LEFT FLOOR\n%s"
        "*STEP\n*QUASISTATIC\n1., 1.\n*BOUNDARY\nFLOORS, 1, 2\n"
        "%s*PRINT, TOTALS\n*END STEP\n",
        _i, k ? "*CONTACT PAIR, NAME=Q, SLAVE=FIRST\nUNDER, RIGHT FLOOR\n" : "",
        held[_i]);
    ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
    normal[k] = job_value(&j, "TOTALS", -1, "normal");
  }
  ck_assert_double_gt(normal[0], 0.5);
  ck_assert_double_eq_tol(normal[1], normal[0], 1e-12);
}

/* Two blocks tied side by side on a plane. */
typedef struct side {
  const char *tie, *group, *other; /* contact D */
  int m;
  double area; /* of contact C */
} side;

static const side sides[] = {
    {"SLAVE=FIRST", "RIGHT", "", 4, 2},
    {"SLAVE=SECOND", "RIGHT", "", 4, 2},
    {"SLAVE=FIRST", "FOOT", "", 4, 1},
    {"SLAVE=FIRST", "RIGHT", "", 8, 2},
    {"SLAVE=SECOND", "RIGHT", "", 8, 2},
    {"SLAVE=AUTO", "RIGHT", "", 8, 2},
    {"SLAVE=FIRST", "FOOT", "HEEL, OBSTACLE=O", 4, 0.875},
    {"SLAVE=AUTO", "FOOT", "HEEL, OBSTACLE=Q", 8, 1.0625},
    {"SLAVE=FIRST", "FOOT", "OVER, OBSTACLE=FAR", 4, 1}};

/* 1: the block of contact C is the only one on the plane. */
static int alone(const side *of) { return of->area == 1; }

/* rise: of the right end of the second foot. */
static int press_side(job *j, const side *of, double rise) {
  *j = job_begin("side");
  job_copy(j, "tests/regression/mesh/pair.geo");
  job_write(
      j, "side.geo",
      "Geometry.AutoCoherence = 0;\nInclude \"pair.geo\";\n"
      "Translate {0, %g, 0} {Point{13};}\n"
      "Physical Curve(\"FOOT\") = {2};\nPhysical Curve(\"HEEL\") = {12};\n",
      rise);
  job_write(j, "side.inp",
            "*PARAMETER\nA = -90\nN = 4\nM = %d\n*MESH, FILE=side.geo\n"
            "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n"
            "*SOLID SECTION, ELSET=LOWER, MATERIAL=M\n"
            "*SOLID SECTION, ELSET=UPPER, MATERIAL=M\n*TIE, NAME=T, %s\n"
            "UNDER, OVER\n*OBSTACLE, NAME=O, TYPE=PLANE\n0, -1\n0, 1\n"
            "*OBSTACLE, NAME=Q, TYPE=PLANE\n0, -1\n0, 1\n"
            "*OBSTACLE, NAME=FAR, TYPE=PLANE\n-9, 0\n1, 0\n"
            "*CONTACT, NAME=C, GROUP=%s, OBSTACLE=O\n"
            "*FRICTION, CONTACT=C, LAW=TRESCA\n0.25\n%s%s%s*STEP\n*STATIC\n"
            "*BOUNDARY\nLEFT, 1\n%s*DSLOAD\nLEFT, P, 1.\n"
            "*PRINT, CONTACT, TOTALS\n*END STEP\n",
            of->m, of->tie, of->group,
            *of->other ? "*CONTACT, NAME=D, GROUP=" : "", of->other,
            *of->other ? "\n*FRICTION, CONTACT=D, LAW=TRESCA\n0.25\n" : "",
            alone(of) ? "TOP, 2\n" : "");
  return job_run(j, "");
}

/* The blocks stand as one: the area of the tied nodes is that of their masters,
 * also where these have another contact, or of the others of the face where the
 * masters have none with that normal. */
TESTS(tied_nodes_leave_their_area_in_a_contact, 9) {
  const side *of = &sides[_i];
  const int coarse = _i == 3, both = *of->other == 'H';
  JOB j;
  ck_assert_msg(press_side(&j, of, 0) == 0, "%s", j.errors);
  ck_assert_int_eq(strstr(j.errors, "P4002") != NULL, *of->other == 'O');
  ck_assert_int_eq(strstr(j.errors, "P4035") != NULL, coarse);
  DAT c = job_table(&j, "CONTACT", -1), all = job_table(&j, "TOTALS", -1);
  ck_assert_double_eq_tol(dat_at(&all, 0, "closed_area"), of->area, 1e-12);
  for (int i = 0; i <= both; ++i)
    if (!alone(of))
      ck_assert_double_eq_tol(dat_at(&all, i, "normal"),
                              dat_at(&all, i, "closed_area"), 1e-11);
  for (int i = 0; i < c.n_row && !alone(of) && !coarse; ++i)
    ck_assert_double_eq_tol(dat_at(&c, i, "pressure"), 1, 1e-11);
  if (*of->other != 'O') {
    ck_assert_int_eq(c.n_row, alone(of) ? 4 : of->m + 5);
    ck_assert_double_eq_tol(dat_sum(&c, "limit"), alone(of) ? 0.25 : 0.5,
                            1e-12);
  }
}

/* The second foot rises by 22 degrees: with the same obstacle that is one
 * surface, with another one it is not. */
TESTS(tied_area_goes_round_a_blunt_corner, 2) {
  static const side feet[] = {
      {"SLAVE=FIRST", "FOOT", "HEEL, OBSTACLE=O", 4, 0.875},
      {"SLAVE=FIRST", "FOOT", "HEEL, OBSTACLE=Q", 4, 1}};
  JOB j;
  ck_assert_msg(press_side(&j, &feet[_i], 0.4) == 0, "%s", j.errors);
  ck_assert_double_eq_tol(job_value(&j, "TOTALS", -1, "closed_area"),
                          feet[_i].area, 1e-12);
}

/* The pair of a tie again. */
TEST(contact_of_tied_faces_is_told) {
  JOB j = job_with("tied", "tests/regression/mesh/pair.geo",
                   "*PARAMETER\nN = 4\nM = 4\n*MESH, FILE=pair.geo\n"
                   "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n"
                   "*SOLID SECTION, ELSET=LOWER, MATERIAL=M\n"
                   "*SOLID SECTION, ELSET=UPPER, MATERIAL=M\n"
                   "*TIE, NAME=T, SLAVE=FIRST\nUNDER, OVER\n"
                   "*CONTACT PAIR, NAME=P, SLAVE=FIRST\nUNDER, OVER\n"
                   "*STEP\n*STATIC\n*BOUNDARY\nBOTTOM, 1, 2\n*END STEP\n");
  ck_assert_int_eq(job_run(&j, ""), 2);
  ck_assert_ptr_nonnull(strstr(
      j.errors, "P4033: *CONTACT PAIR P: 4 of 4 faces of the slave UNDER"));
  ck_assert_ptr_nonnull(strstr(j.errors, "left out of contact: 5"));
}

/* The nodes of a tip have no row. */
TEST(rows_of_a_crack_add_up_to_its_resultant) {
  JOB j;
  ck_assert_int_eq(job_run_with(&j, "input/crack/partly_closed", "", 0, ""), 0);
  DAT c = job_table(&j, "CONTACT", -1), all = job_table(&j, "TOTALS", -1);
  ck_assert_double_gt(dat_at(&all, 0, "normal"), 0.1);
  check_sum(&c, "f_n", &all, "normal");
  check_sum(&c, "f_y", &all, "force_y");
}

UNIT_MAIN("pair_options")
