/*
 * *WEAR against closed forms: depth k p v t under a block that a belt passes,
 * and the flat that a cylinder gets.
 */
#include "support/traced.h"
#include "support/unit.h"

#include <signal.h>

const int job_without_fields = 1;

/* A body pressed by 3 on a belt, E = 1000, nu = 0, 1 s at rest and 10 s at
 * "way"/10 a second; k = 1e-4. "cards" before the
 * steps. */
static int run_block(job *j, const char *geo, const char *type, const char *way,
                     const char *cards, const char *words) {
  const int solid = strstr(geo, "cube") != NULL;
  PRINTED(path, "tests/regression/mesh/%s.geo", geo);
  job_copy(j, path);
  job_write(j, "block.inp",
            "*PARAMETER\nN = 2\nDT = 1.\n*MESH, FILE=%s.geo\n"
            "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M%s%s\n"
            "*AMPLITUDE, NAME=RUN, TIME=TOTAL TIME\n0, 0, 1, 0, 11, 1\n"
            "*OBSTACLE, NAME=BELT, TYPE=PLANE, AMPLITUDE=RUN\n0, 0%s\n0, %s\n"
            "MOVE, %s\n*CONTACT, NAME=FOOT, GROUP=BOTTOM, OBSTACLE=BELT\n%s"
            "*STEP\n*QUASISTATIC\n1., 1.\n*BOUNDARY\nLEFT, 1\n%s"
            "*DSLOAD\nTOP, P, 3.\n*PRINT, TOTALS, ENERGY, CONTACT%s\n"
            "*RESTART\n*END STEP\n"
            "*STEP\n*QUASISTATIC\n<DT>, 10.\n"
            "*PRINT, TOTALS, ENERGY, CONTACT%s\n*RESTART\n*END STEP\n",
            geo, type[0] != '\0' ? ", TYPE=" : "", type, solid ? ", 0" : "",
            solid ? "0, 1" : "1", way, cards, solid ? "FRONT, 2\n" : "",
            strstr(cards, "*WEAR") != NULL ? ", WEAR" : "",
            strstr(cards, "*TIME") != NULL
                ? ", WEAR\n*PRINT, WEAR, TIME POINTS=T"
            : strstr(cards, "*WEAR") != NULL ? ", WEAR"
                                             : "");
  return job_run(j, words);
}

#define WORN "*WEAR, CONTACT=FOOT, COEFFICIENT=1.E-4\n"

static void check_depth(const job *j, double expected) {
  DAT w = job_table(j, "WEAR", -1), all = job_table(j, "TOTALS", -1);
  ck_assert_int_gt(w.n_row, 2);
  for (int i = 0; i < w.n_row; ++i)
    ck_assert_double_eq_tol(dat_at(&w, i, "depth"), expected, 1e-10 * expected);
  ck_assert_double_eq_tol(dat_sum(&w, "volume"), expected, 1e-10 * expected);
  ck_assert_double_eq_tol(dat_at(&all, 0, "worn_volume"), expected,
                          1e-10 * expected);
}

TESTS(depth_under_a_belt, 2) {
  static const struct {
    const char *geo, *type, *way;
  } scenes[] = {{"square", "CPE3", "10, 0"}, {"cube", "", "6, -8, 0"}};
  JOB j = job_begin("block");
  int code = run_block(&j, scenes[_i].geo, scenes[_i].type, scenes[_i].way,
                       WORN, "--no-timing");
  ck_assert_msg(code == 0, "%s", j.errors);
  check_depth(&j, 1e-4 * 3 * 10);
  FREED char *lst = job_file(&j, "lst"); /* of the mesh there is no error */
  ck_assert_ptr_nonnull(strstr(lst, "unknown without *ACCURACY, TIME=YES"));
  /* The obstacle takes the work p depth, less what it put in at first. */
  DAT e = job_table(&j, "ENERGY", -1), first = job_table(&j, "ENERGY", 0);
  ck_assert_double_eq_tol(
      dat_at(&first, 0, "normal_work") - dat_at(&e, 0, "normal_work"),
      3 * 1e-4 * 3 * 9, 1e-10);
  ck_assert_double_le(fabs(dat_at(&e, 0, "energy_defect")), 1e-13);
}

/* A block that is pressed together by 0.01 wears with forces 10 exp(-t), of
 * which half the increments tell the error; one under the load 10 t, by k s its
 * mean, whatever the increments, at forces that have no error. At a corner the
 * slip over each side is not known for halves. */
static double steps_of(int n, const char *top, const char *cards, double *depth,
                       double *pressure) {
  char kind[40] = "*STATIC\n";
  if (n > 0) snprintf(kind, sizeof kind, "*QUASISTATIC\n%g, ", 1.0 / n);
  JOB j = job_with("block", "tests/regression/mesh/square.geo",
                   "*PARAMETER\nN = 1\n*MESH, FILE=square.geo\n"
                   "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n"
                   "*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=CPE3\n"
                   "*AMPLITUDE, NAME=RUN, TIME=TOTAL TIME\n0, 0, 1, 0, 2, 1\n"
                   "*OBSTACLE, NAME=BELT, TYPE=PLANE, AMPLITUDE=RUN\n0, 0\n"
                   "0, 1\nMOVE, 1, 0\n"
                   "*CONTACT, NAME=FOOT, GROUP=BOTTOM, OBSTACLE=BELT\n%s"
                   "*WEAR, CONTACT=FOOT, COEFFICIENT=1.E-3\n"
                   "*STEP\n*QUASISTATIC\n1., 1.\n*BOUNDARY\nLEFT, 1\n%s"
                   "*END STEP\n*STEP\n%s1.\n"
                   "*ACCURACY, TIME=YES\n*PRINT, WEAR, CONTACT\n*END STEP\n",
                   cards, top, kind);
  CK_EXIT(job_run(&j, "--no-timing"), 0, j);
  DAT w = job_table(&j, "WEAR", -1), c = job_table(&j, "CONTACT", -1);
  *depth = dat_at(&w, 0, "depth");
  *pressure = dat_at(&c, 0, "pressure");
  return 0.01 * job_told(&j, "time_error_percent");
}

TEST(half_the_increments_tell_the_error_of_wear) {
  double depth, p;
  for (int n = 4; n <= 16; n *= 4) {
    const double told = steps_of(n, "TOP, 2, 2, -0.01\n", "", &depth, &p);
    const double is = (p - 10 * exp(-1.0)) / p;
    ck_assert_msg(told > 0.9 * is && told < 1.3 * is, "%g, told %g", is, told);
  }
  const double told =
      steps_of(4, "*DSLOAD\nTOP, P, \"max(0,10*(t-1))\"\n", "", &depth, &p);
  const double is = depth / 5e-3 - 1;
  ck_assert_double_eq_tol(p, 10.0, 1e-10);
  ck_assert_msg(told > 0.7 * is && told < 1.3 * is, "%g, told %g", is, told);
}

TEST(wear_at_corners_and_at_once_has_no_error_of_steps) {
  double depth, p;
  ck_assert(isnan(steps_of(0, "TOP, 2, 2, -0.01\n", "", &depth, &p)));
  const double told =
      steps_of(2, "*DSLOAD\nTOP, P, 3.\n",
               "*OBSTACLE, NAME=SIDE, TYPE=PLANE\n1, 0\n-1, 0\n"
               "*CONTACT, NAME=WALL, GROUP=RIGHT, OBSTACLE=SIDE\n",
               &depth, &p);
  ck_assert(isnan(told));
}

/* Within the fifth increment of the belt: what four and a half have worn. */
TEST(depth_at_a_time_point_counts_from_the_start) {
  JOB j = job_begin("block");
  ck_assert_int_eq(run_block(&j, "square", "CPE3", "10, 0",
                             WORN "*TIME POINTS, NAME=T\n4.5\n", ""),
                   0);
  DAT w = job_table(&j, "WEAR", 1 + 4);
  ck_assert_int_gt(w.n_row, 2);
  for (int i = 0; i < w.n_row; ++i)
    ck_assert_double_eq_tol(dat_at(&w, i, "depth"), 1e-4 * 3 * 4.5, 1e-12);
}

/* Archard at a corner: floor and wall each lose k F s of their own force,
 * pressed with 3 and 1, where the belt passes along both by 1. The block rubs
 * on each by half of what the other presses it together, F/E, before. */
TEST(each_side_of_a_corner_wears_by_its_own_force) {
  JOB j =
      job_with("block", "tests/regression/mesh/cube.geo",
               "*PARAMETER\nN = 2\n*MESH, FILE=cube.geo\n*MATERIAL, NAME=M\n"
               "*ELASTIC\n1000., 0.\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
               "*AMPLITUDE, NAME=RUN, TIME=TOTAL TIME\n0, 0, 1, 0, 2, 1\n"
               "*OBSTACLE, NAME=BELT, TYPE=PLANE, AMPLITUDE=RUN\n0, 0, 0\n"
               "0, 0, 1\nMOVE, 0, 1, 0\n"
               "*OBSTACLE, NAME=SIDE, TYPE=PLANE, AMPLITUDE=RUN\n0, 0, 0\n"
               "1, 0, 0\nMOVE, 0, 1, 0\n"
               "*CONTACT, NAME=FOOT, GROUP=BOTTOM, OBSTACLE=BELT\n"
               "*CONTACT, NAME=WALL, GROUP=LEFT, OBSTACLE=SIDE\n" WORN
               "*WEAR, CONTACT=WALL, COEFFICIENT=1.E-4\n"
               "*STEP\n*QUASISTATIC\n1., 1.\n*BOUNDARY\nFRONT, 2\n"
               "*DSLOAD\nTOP, P, 3.\nRIGHT, P, 1.\n*END STEP\n"
               "*STEP\n*QUASISTATIC\n1., 1.\n*PRINT, TOTALS, CONTACT\n"
               "*END STEP\n");
  CK_EXIT(job_run(&j, "--no-timing"), 0, j);
  DAT t = job_table(&j, "TOTALS", -1);
  for (int i = 0; i < 2; ++i)
    ck_assert_double_eq_tol(dat_at(&t, i, "worn_volume"),
                            1e-4 * (i == 0 ? 3 * (1 + 0.5e-3) : 1 + 1.5e-3),
                            1e-12);
}

/* The same in the plane, faces of 0.5 on the floor and 2 at the wall, passed by
 * 1 and 2: the block follows what has worn off, at the corner too. */
TEST(block_follows_the_wear_of_a_corner) {
  JOB j = job_with(
      "block", "tests/regression/mesh/square.geo",
      "*PARAMETER\nN = 2\nLY = 4\nKIND = 1\n*MESH, FILE=square.geo\n"
      "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n"
      "*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=CPE3\n"
      "*AMPLITUDE, NAME=RUN, TIME=TOTAL TIME\n0, 0, 1, 0, 2, 1\n"
      "*OBSTACLE, NAME=BELT, TYPE=PLANE, AMPLITUDE=RUN\n0, 0\n0, 1\n"
      "MOVE, 1, 0\n*OBSTACLE, NAME=SIDE, TYPE=PLANE, AMPLITUDE=RUN\n0, 0\n"
      "1, 0\nMOVE, 0, 2\n*CONTACT, NAME=FOOT, GROUP=BOTTOM, OBSTACLE=BELT\n"
      "*CONTACT, NAME=WALL, GROUP=LEFT, OBSTACLE=SIDE\n" WORN
      "*WEAR, CONTACT=WALL, COEFFICIENT=1.E-4\n*STEP\n*QUASISTATIC\n1., 1.\n"
      "*DSLOAD\nTOP, P, 3.\nRIGHT, P, 1.\n*END STEP\n*STEP\n*QUASISTATIC\n"
      "1., 1.\n*END STEP\n*STEP\n*QUASISTATIC\n1., 1.\n"
      "*PRINT, NODES, WEAR\n*END STEP\n");
  CK_EXIT(job_run(&j, "--no-timing"), 0, j);
  DAT n = job_table(&j, "NODES", -1), w = job_table(&j, "WEAR", -1);
  for (int i = 0; i < n.n_row; ++i) {
    if (dat_at(&n, i, "y") == 0)
      ck_assert_double_eq_tol(dat_at(&n, i, "u_y"), -3e-4, 1e-6);
    if (dat_at(&n, i, "x") == 0)
      ck_assert_double_eq_tol(dat_at(&n, i, "u_x"), -2e-4, 3e-6);
  }
  ck_assert_double_eq_tol(dat_sum(&w, "volume"), 3e-4 + 4 * 2e-4, 1e-5);
  const int foot = dat_row_near(&w, "x", 1);
  ck_assert_double_eq_tol(dat_at(&w, foot, "volume"), 0.25 * 3e-4, 1e-7);
}

/* A wall in x pushes the block of nu = 0 along the floor, LEFT held. */
TEST(corner_wears_where_a_wall_pushes_it) {
  JOB j = job_begin("block");
  const char *const cards =
      "*OBSTACLE, NAME=PUSH, TYPE=PLANE, AMPLITUDE=RUN\n1, 0\n-1, 0\n"
      "MOVE, -0.01, 0\n*CONTACT, NAME=SIDE, GROUP=RIGHT, OBSTACLE=PUSH\n" WORN;
  ck_assert_int_eq(run_block(&j, "square", "CPE3", "0, 0", cards, ""), 0);
  DAT w = job_table(&j, "WEAR", -1);
  for (int i = 0; i < w.n_row; ++i)
    ck_assert_double_eq_tol(
        dat_at(&w, i, "depth"),
        (dat_at(&w, i, "y") > 0 ? 0 : 1e-4 * 3 * 0.01 * dat_at(&w, i, "x")),
        1e-8);
}

/* The block beside a wall, or below a roof, that it does not touch. */
static job run_beside(int solid, int wall, const char *method) {
  job j = job_begin("block");
  const char *const last = solid ? ", 0" : "";
  job_copy(&j, solid ? "tests/regression/mesh/cube.geo"
                     : "tests/regression/mesh/square.geo");
  job_write(&j, "block.inp",
            "*PARAMETER\nN = 2\n*MESH, FILE=%s.geo\n*MATERIAL, NAME=M\n"
            "*ELASTIC\n1000., 0.3\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=BELT, TYPE=PLANE\n0, 0%s\n0%s, 1\n"
            "MOVE, \"0.1*t\", 0%s\n*OBSTACLE, NAME=STONE, TYPE=PLANE\n%s\n"
            "*CONTACT, NAME=FOOT, GROUP=BOTTOM, OBSTACLE=BELT\n"
            "*CONTACT, NAME=SIDE, GROUP=%s, OBSTACLE=STONE\n"
            "*FRICTION, CONTACT=SIDE, LAW=COULOMB\n0.3\n" WORN
            "*STEP\n*QUASISTATIC\n0.5, 1.\n*BOUNDARY\nLEFT, 1\n%s"
            "*DSLOAD\nTOP, P, \"3*(1 + x)\"\n*SOLVER, METHOD=%s\n"
            "*PRINT, CONTACT, TOTALS, LOOP, WEAR\n*END STEP\n",
            solid ? "cube" : "square", last, last, last,
            wall && solid ? "1.5, 0, 0\n-1, 0, 0.4"
            : wall        ? "1.5, 0\n-1, 0.4"
            : solid       ? "0, 0, 1.5\n0, 0, -1"
                          : "0, 1.5\n0, -1",
            wall ? "RIGHT" : "TOP", solid ? "FRONT, 2\n" : "", method);
  ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
  return j;
}

static void check_same(const job *a, const job *b, const char *table,
                       const char *const *names) {
  DAT one = job_table(a, table, -1), two = job_table(b, table, -1);
  const int by_node = strcmp(table, "CONTACT") == 0;
  for (int i = 0; i < (by_node ? one.n_row : 1); ++i) {
    int k = 0;
    if (by_node && dat_at(&one, i, names[0]) > 0) continue;
    while (by_node && dat_at(&two, k, "node_no") != dat_at(&one, i, "node_no"))
      ck_assert_int_lt(++k, two.n_row);
    for (int n = 1; names[n] != NULL; ++n)
      ck_assert_msg(
          fabs(dat_at(&one, i, names[n]) - dat_at(&two, k, names[n])) <= 1e-12,
          "%s, row %d, %s: %g for %g", table, i, names[n],
          dat_at(&two, k, names[n]), dat_at(&one, i, names[n]));
  }
}

/* Nodes that may touch a second obstacle have no friction, and but for it all
 * that they would have without the obstacle. */
TESTS(second_obstacle_that_is_not_met_changes_nothing, 2) {
  static const char *const of_nodes[2][12] = {
      {"y", "u_n", "u_t", "slip", "slip_distance", "slip_dir_x", "f_n"},
      {"z", "u_n", "u_t1", "u_t2", "slip_1", "slip_2", "slip_distance",
       "slip_dir_x", "slip_dir_y", "slip_dir_z", "f_n"}};
  static const char *const of_loops[2][8] = {
      {"", "normal", "way", "mean_u_t", "friction_work"},
      {"", "normal", "way_1", "way_2", "mean_u_t1", "mean_u_t2"}};
  static const char *const of_totals[] = {"",     "closed_area", "worn_volume",
                                          "open", "slip",        NULL};
  JOB roof = run_beside(_i, 0, "NEWTON"), wall = run_beside(_i, 1, "NEWTON");
  check_same(&roof, &wall, "CONTACT", of_nodes[_i]);
  check_same(&roof, &wall, "LOOP", of_loops[_i]);
  check_same(&roof, &wall, "TOTALS", of_totals);
}

/* SOR leaves forces of rounding at open obstacles. */
TEST(second_obstacle_that_is_not_met_is_open) {
  JOB j = run_beside(1, 1, "SOR");
  DAT t = job_table(&j, "TOTALS", -1);
  ck_assert(dat_at(&t, 1, "normal") != 0);
  ck_assert(dat_at(&t, 1, "closed_area") == 0);
  ck_assert(dat_at(&t, 1, "slip") == 0);
  ck_assert(dat_at(&t, 1, "open") > 2);
}

/* All of the block slips against friction: wear as the work of the normal
 * forces, whatever the pressures; stopped and gone on with. */
TEST(volume_with_friction_and_restart) {
  JOB j = job_begin("block");
  const char *const cards = "*FRICTION, CONTACT=FOOT, LAW=COULOMB\n0.2\n" WORN;
  ck_assert_int_eq(
      run_block(&j, "square", "CPE3", "10, 0", cards, "--no-timing"), 0);
  double volume = 0;
  for (int k = 0; k <= 10; ++k) {
    DAT c = job_table(&j, "CONTACT", k);
    for (int i = 0; i < c.n_row; ++i)
      volume += 1e-4 * dat_at(&c, i, "f_n") * fabs(dat_at(&c, i, "slip"));
  }
  DAT all = job_table(&j, "TOTALS", -1);
  ck_assert_double_eq_tol(dat_at(&all, 0, "worn_volume"), volume, 1e-12);
  ck_assert_double_eq_tol(volume, 3e-3, 1e-5);
  /* Stopped half way and gone on with: the same files. */
  static const char *const words[] = {"--no-timing", NULL};
  traced t = {.action = TRACE_SIGNAL, .number = SIGTERM};
  JOB stopped = job_begin("block");
  run_block(&stopped, "square", "CPE3", "10, 0", cards, "--check");
  ck_assert_int_eq(traced_run(&stopped, words, &t), 0);
  t.at = t.changes / 2;
  job_clear(&stopped);
  ck_assert_int_ne(traced_run(&stopped, words, &t), 0);
  ck_assert_int_eq(job_run(&stopped, "--restart --no-timing"), 0);
  const char *differs = traced_difference(&j, &stopped);
  ck_assert_msg(differs == NULL, ".%s differs", differs);
}

TEST(increments_too_long_are_refused) {
  JOB j = job_begin("block");
  const char *const card = "*WEAR, CONTACT=FOOT, COEFFICIENT=%g\n";
  PRINTED(cards, card, 0.002);
  ck_assert_int_eq(
      run_block(&j, "square", "CPE3", "10, 0", cards, "--no-timing"), 2);
  double factor, dt;
  const char *told = strstr(j.errors, "of a node by ");
  ck_assert_ptr_nonnull(told);
  ck_assert_int_eq(sscanf(told,
                          "of a node by %lf times their value, above 2 they "
                          "grow without bound: give increments of dt <= %lf",
                          &factor, &dt),
                   2);
  ck_assert_double_eq_tol(dt * factor, 1, 0.01);
  ck_assert_int_eq(
      run_block(&j, "square", "CPE3", "10, 0", cards, "--no-timing -D DT=0.1"),
      0);
  check_depth(&j, 0.002 * 3 * 10);
  ck_assert_str_eq(j.errors, "");
  /* Beyond 1 it wears off more than is pressed together. */
  ck_assert_int_eq(
      run_block(&j, "square", "CPE3", "10, 0", cards, "--no-timing -D DT=0.4"),
      0);
  ck_assert_msg(strstr(j.errors, "warning P2051: step 2, time 1.4") != NULL,
                "%s", j.errors);
  ck_assert_ptr_nonnull(strstr(j.errors, "\n1 warning\n"));
}

/* What did not converge is told as that, whatever it would wear. */
TEST(increments_without_equilibrium_are_not_refused_for_wear) {
  static const char *const limit[] = {
      "", ", METHOD=NEWTON, MAX_ITER=2",
      ", METHOD=NEWTON, MAX_ITER=1\n*END STEP\n*STEP\n*QUASISTATIC\n1., 1.\n"
      "*BOUNDARY\nTOP, 1, 1, 0.02\n*SOLVER, MAX_ITER=0"};
  for (int i = 0; i < 3; ++i) {
    JOB j = job_with(
        "rubbed", "tests/regression/mesh/square.geo",
        "*PARAMETER\nN = 2\n*MESH, FILE=square.geo\n*MATERIAL, NAME=M\n"
        "*ELASTIC\n1000., 0.3\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
        "*OBSTACLE, NAME=FLOOR, TYPE=PLANE\n0, 0\n0, 1\n"
        "*CONTACT, NAME=FOOT, GROUP=BOTTOM, OBSTACLE=FLOOR\n"
        "*FRICTION, CONTACT=FOOT, LAW=COULOMB\n0.3\n"
        "*WEAR, CONTACT=FOOT, COEFFICIENT=1.\n*STEP\n*QUASISTATIC\n"
        "1., 1., 1.\n*BOUNDARY\nTOP, 1, 1, 0.01\nTOP, 2, 2, -0.001\n"
        "*SOLVER%s\n*END STEP\n",
        limit[i]);
    ck_assert_int_eq(job_run(&j, ""), i == 0 ? 2 : 1);
    ck_assert_int_eq(strstr(j.errors, "P2050") != NULL, i == 0);
  }
}

/* Half the increments wear differently: no error of the steps is known, and no
 * sum of errors. */
TEST(target_of_an_unknown_error_is_refused) {
  JOB j = job_begin("block");
  static const char cards[] = WORN
      "*STEP\n*QUASISTATIC\n0.5, 1.\n*BOUNDARY\nLEFT, 1\n"
      "*DSLOAD\nTOP, P, 3., RUN\n*ACCURACY, TARGET=1\n*END STEP\n";
  ck_assert_int_eq(
      run_block(&j, "square", "CPE3", "10, 0", cards, "--no-timing"), 2);
  ck_assert_ptr_nonnull(strstr(j.errors, "error P2066: *WEAR: TARGET="));
}

TEST(nothing_without_the_card) {
  JOB j = job_begin("block");
  ck_assert_int_eq(run_block(&j, "square", "CPE3", "10, 0", "", "--no-timing"),
                   0);
  DAT all = job_table(&j, "TOTALS", -1);
  ck_assert(!dat_has(&all, "worn_volume"));
  ck_assert_int_eq(job_stage(&j, "wear", NULL), 0);
}

/*
 * A cylinder of steel worn on a plane until the flat is 5 Hertz half-widths a
 * wide. With even pressure P/2b on a half plane (Johnson, Contact Mechanics,
 * 2.30b) the profile that is left conforms if
 *   k P s = b (4 b^2 - 3 a^2)/(6 R),
 * without elasticity 2 b^3/3R. The pressure is the more even the larger b/a.
 */
TEST(flat_of_a_cylinder) {
  JOB j = job_with(
      "pin", "input/hertz_line/hertz_line.geo",
      "*PARAMETER\nR = 10.\nP = 1000.\nE = 210.D3\nNU = 0.3\n"
      "A = \"sqrt(4*P*R*(1 - NU^2)/(pi*E))\"\nB = \"2.5*A\"\nNC = 6\n"
      "K = \"B*(4*B^2 - 3*A^2)/(6*R)/P\"\n*MESH, FILE=hertz_line.geo\n"
      "*MATERIAL, NAME=STEEL\n*ELASTIC\n<E>, <NU>\n"
      "*SOLID SECTION, ELSET=BODY, MATERIAL=STEEL, TYPE=CPE3\n"
      "*AMPLITUDE, NAME=RUN, TIME=TOTAL TIME\n0, 0, 1, 0, 2, 1\n"
      "*OBSTACLE, NAME=PLANE, TYPE=PLANE, AMPLITUDE=RUN\n0, 0\n0, 1\n"
      "MOVE, 1, 0\n*CONTACT, NAME=LINE, GROUP=CONTACT, OBSTACLE=PLANE, "
      "NORMAL=OBSTACLE\n*WEAR, CONTACT=LINE, COEFFICIENT=<K>\n"
      "*STEP\n*QUASISTATIC\n1, 1\n*BOUNDARY\nSYMMETRY, 1\n"
      "*DSLOAD\nTOP, P, \"P/(2*R)\"\n*END STEP\n"
      "*STEP\n*QUASISTATIC\n0.005, 1\n"
      "*PRINT, CONTACT, TOTALS, FREQUENCY=0\n*ACCURACY, TIME=YES\n"
      "*END STEP\n");
  ck_assert_int_eq(job_run(&j, "--no-timing"), 0);
  FREED char *listing = job_file(&j, "lst");
  ck_assert_ptr_nonnull(strstr(listing, "error of the steps: about"));
  const double a = 0.2348908547, b = 2.5 * a;
  DAT all = job_table(&j, "TOTALS", -1), c = job_table(&j, "CONTACT", -1);
  const double volume = b * (4 * b * b - 3 * a * a) / 60;
  ck_assert_double_eq_tol(2 * dat_at(&all, 0, "worn_volume"), volume,
                          2e-3 * volume);
  ck_assert_double_eq_tol(dat_at(&all, 0, "closed_area"), b, 0.04 * b);
  const double mean = 500 / b;
  const double top = dat_at(&c, dat_row_near(&c, "x", 0), "pressure");
  ck_assert_double_ge(top, mean);
  ck_assert_double_le(top, 1.06 * mean);
}

UNIT_MAIN("wear")
