/*
 * Warnings of a run whose equations are solved and whose answer is doubtful:
 * on stderr, in the listing, in JSON, each once. A run that is gone on with
 * after its last increment writes the same listing.
 */
#include "scenes/mesh.h"
#include "support/job.h"
#include "support/unit.h"

const int job_without_fields = 1;

/* A block held in x above a plane, pressed in ten increments; E is 1000. */
static job run_block(double gap, const char *law, const char *cards) {
  static const mesh_change none;
  FREED int *number = NULL;
  job j = job_begin("block");
  PRINTED(path, "%s/block.msh", j.dir);
  FILE *f = fopen(path, "w");
  ck_assert_ptr_nonnull(f);
  ck_assert_int_eq(scene_mesh_write(f, "rect 4 4 1 1", &none, &number), 1);
  fclose(f);
  job_write(&j, "block.inp",
            "*MESH, FILE=block.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n%s"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=PLANE\n0., %.17g\n0., 1.\n"
            "*CONTACT, NAME=FOOT, GROUP=BOTTOM, OBSTACLE=O\n*STEP\n%s"
            "*PRINT, TOTALS\n*END STEP\n",
            law, -gap, cards);
  ck_assert_msg(job_run(&j, "--no-timing") == 0, "%s", j.errors);
  return j;
}

static int count(const char *text, const char *what) {
  int n = 0;
  for (const char *p = text; (p = strstr(p, what)) != NULL; ++p) ++n;
  return n;
}

/* Told n times, 0 or 1, everywhere. */
static void ck_told(const job *j, const char *number, const char *what, int n) {
  static const char *const files[] = {"lst", "json"};
  ck_assert_msg(count(j->errors, what) == n, "%s: %s", what, j->errors);
  ck_assert_int_eq(count(j->errors, number) > 0, n);
  for (int k = 0; k < 2; ++k) {
    FREED char *text = job_file(j, files[k]);
    ck_assert_msg(count(text, what) == n, "%s: %s", files[k], what);
  }
}

#define PRESSED(p) \
  "*QUASISTATIC\n0.1, 1.\n*BOUNDARY\nLEFT, 1\n*DSLOAD\nTOP, P, " p "\n"

TEST(strains_above_five_percent_are_told) {
  job j = run_block(0.0, "", PRESSED("49.9"));
  ck_told(&j, "P4019", "strains are taken as small", 0);
  job_end(&j);
  j = run_block(0.0, "", PRESSED("52."));
  ck_told(&j, "P4019", "step 1, increment 10, time 1: the strain of", 1);
  ck_told(&j, "P4020", "inside out", 0);
  job_end(&j);
}

/* The end of a beam of length 10 and height 1 turns by 1.5 v / 10 where it is
 * moved by v; the strain is 0.015 v. */
TEST(rotations_above_a_tenth_are_told) {
  static const double v[] = {0.6, 0.75};
  for (int i = 0; i < 2; ++i) {
    JOB j = job_with(
        "beam", "tests/regression/mesh/square.geo",
        "*PARAMETER\nN = 12\nKIND = 2\nLX = 10\n"
        "*MESH, FILE=square.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n"
        "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n*STEP\n*STATIC\n1.\n"
        "*BOUNDARY\nLEFT, 1, 2\nRIGHT, 2, 2, %g\n*END STEP\n",
        v[i]);
    ck_assert_msg(job_run(&j, "--no-timing") == 0, "%s", j.errors);
    ck_told(&j, "P4039", "step 1, increment 1, time 1: the rotation of", i);
    ck_told(&j, "P4019", "strains are taken as small", 0);
  }
}

TEST(elements_inside_out_are_told) {
  job j = run_block(0.0, "", PRESSED("990."));
  ck_told(&j, "P4020", "inside out", 0);
  job_end(&j);
  j = run_block(0.0, "", PRESSED("1050."));
  ck_told(&j, "P4020", "step 1, increment 10, time 1: the displacements turn",
          1);
  job_end(&j);
}

/* Pressed on a cylinder or a plane, then the one or the other moves aside by
 * less or more than a face: a plane is the same everywhere, an obstacle that
 * moves is met where it is, and along a zone of 0.4 to each side a slip of 0.07
 * changes the gap by (0.07 / 0.4)^2 = 3 % of what it varies by; along a shorter
 * one by more. */
TEST(slip_along_a_bent_obstacle_is_told) {
  static const struct {
    int n, radius; /* segments; 0: a plane */
    double body, obstacle;
    int told;
  } rows[] = {{4, 1, 0.24, 0.0, 0},  {4, 1, 0.35, 0.0, 1},
              {4, 1, 0.0, -0.35, 0}, {4, 0, 0.35, 0.0, 0},
              {16, 1, 0.07, 0.0, 1}, {16, 100, 0.07, 0.0, 0}};
  for (size_t i = 0; i < sizeof rows / sizeof rows[0]; ++i) {
    char shape[40] = "PLANE";
    JOB j = job_begin("aside");
    if (rows[i].radius > 0)
      snprintf(shape, sizeof shape, "CYLINDER, RADIUS=%d", rows[i].radius);
    job_copy(&j, "tests/regression/mesh/square.geo");
    job_write(&j, "aside.inp",
              "*PARAMETER\nN = %d\n*MESH, FILE=square.geo\n"
              "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n"
              "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
              "*AMPLITUDE, NAME=A, TIME=TOTAL TIME\n0., 0., 1., 0., 2., 1.\n"
              "*OBSTACLE, NAME=O, TYPE=%s, AMPLITUDE=A\n0.5, %d\n%s"
              "MOVE, %g, 0.\n"
              "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O, NORMAL=OBSTACLE\n"
              "*STEP\n*STATIC\n1.\n*BOUNDARY\nTOP, 1\nTOP, 2, 2, -0.002\n"
              "*END STEP\n*STEP\n*QUASISTATIC\n0.5, 1.\n*BOUNDARY\n"
              "TOP, 1, 1, %g\n*END STEP\n",
              rows[i].n, shape, -rows[i].radius,
              rows[i].radius > 0 ? "" : "0., 1.\n", rows[i].obstacle,
              rows[i].body);
    ck_assert_msg(job_run(&j, "--no-timing") == 0, "%s", j.errors);
    ck_told(&j, "P4038", "step 2, increment 2, time 2: *CONTACT C: node ",
            rows[i].told);
  }
}

#define CARRIED                                                   \
  "*BOUNDARY\nFIXED, 1, 1, 0.7\n*END STEP\n*STEP\n*QUASISTATIC\n" \
  "1., 1.\n*BOUNDARY\nFIXED, 1, 1, 0.7\n*DSLOAD\n"

/* A column of the width 1 and the height 2 on longer faces, pressed by 1 and
 * pushed by s at its top: the pressures act at 0.5 + 2 s. Where nodes of the
 * column are the slave it tips. With UPDATE=STEP all of it is carried along
 * before. */
TEST(pressures_beyond_the_end_of_the_master_are_told) {
  static const struct {
    const char *push, *slave, *carried;
    int code;
    const char *told;
  } rows[] = {
      {"0.24", "AUTO", "", 0, NULL},
      {"0.255", "AUTO", "", 0, "acts 0.01 beyond the end of the master UP"},
      {"-0.26", "AUTO", "", 0, "acts 0.02 beyond the end of the master UP"},
      {"0.24", "AUTO, UPDATE=STEP", CARRIED, 0, NULL},
      {"0.255", "AUTO, UPDATE=STEP", CARRIED, 0,
       "step 2, increment 1, time 2: *CONTACT PAIR C: the resultant of the "
       "pressures acts 0.01 beyond"},
      {"0.255", "SECOND", "", 6, NULL}};
  for (size_t i = 0; i < sizeof rows / sizeof rows[0]; ++i) {
    JOB j = job_begin("column");
    job_write(&j, "column.msh",
              "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n5\n"
              "1 1 \"LOW\"\n1 2 \"UP\"\n1 3 \"TOP\"\n1 4 \"FIXED\"\n"
              "2 5 \"BODY\"\n$EndPhysicalNames\n$Nodes\n13\n"
              "1 -0.6 0 0\n2 0.2 0 0\n3 0.8 0 0\n4 1.6 0 0\n"
              "5 -0.6 1 0\n6 0.2 1 0\n7 0.8 1 0\n8 1.6 1 0\n"
              "9 0 1 0\n10 0.5 1 0\n11 1 1 0\n12 0 3 0\n13 1 3 0\n"
              "$EndNodes\n$Elements\n18\n"
              "1 1 2 4 4 1 2\n2 1 2 4 4 2 3\n3 1 2 4 4 3 4\n"
              "4 1 2 1 1 5 6\n5 1 2 1 1 6 7\n6 1 2 1 1 7 8\n"
              "7 1 2 2 2 9 10\n8 1 2 2 2 10 11\n9 1 2 3 3 12 13\n"
              "10 2 2 5 5 1 2 6\n11 2 2 5 5 1 6 5\n12 2 2 5 5 2 3 7\n"
              "13 2 2 5 5 2 7 6\n14 2 2 5 5 3 4 8\n15 2 2 5 5 3 8 7\n"
              "16 2 2 5 5 9 10 12\n17 2 2 5 5 10 11 13\n"
              "18 2 2 5 5 10 13 12\n$EndElements\n");
    job_write(&j, "column.inp",
              "*MESH, FILE=column.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n"
              "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
              "*CONTACT PAIR, NAME=C, SLAVE=%s\nLOW, UP\n"
              "*FRICTION, CONTACT=C, LAW=COULOMB\n1.\n*STEP\n*STATIC\n"
              "*BOUNDARY\nFIXED, 1, 2\n*DSLOAD\nTOP, P, 1.\n%sTOP, TX, %s\n"
              "*END STEP\n",
              rows[i].slave, rows[i].carried, rows[i].push);
    const int code = job_run(&j, "--no-timing");
    ck_assert_msg(code == rows[i].code, "%d: exit %d: %s", (int)i, code,
                  j.errors);
    ck_told(&j, "P4042", rows[i].told == NULL ? "beyond the end" : rows[i].told,
            rows[i].told != NULL);
  }
}

/* Also by a run that goes on where nothing is left to do. */
TEST(a_contact_that_never_touched_is_told) {
  static const char lifted[] =
      "*QUASISTATIC\n0.1, 1.\n*BOUNDARY\nLEFT, 1\nTOP, 2, 2, 0.01\n"
      "*RESTART\n";
  JOB j = run_block(0.125, "", lifted);
  for (int k = 0; k < 2; ++k) {
    ck_told(&j, "P4021", "*CONTACT FOOT: no node touched obstacle O", 1);
    ck_told(&j, "P4021", "0.135", 1);
    ck_assert_int_eq(job_run(&j, "--no-timing --restart"), 0);
  }
}

/* A ball between the nodes, or none of which passes them. */
TEST(a_ball_that_no_normal_meets_is_told) {
  static const char *const ball[] = {"0.0625, -0.001\n", "9., -0.001\n"};
  for (int k = 0; k < 2; ++k) {
    JOB j = job_with(
        "block", "tests/regression/mesh/square.geo",
        "*MESH, FILE=square.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
        "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
        "*OBSTACLE, NAME=O, TYPE=SPHERE, RADIUS=0.001\n%sMOVE, 0., 5E-4\n"
        "*CONTACT, NAME=FOOT, GROUP=BOTTOM, OBSTACLE=O\n*STEP\n"
        "*QUASISTATIC\n1., 1.\n*BOUNDARY\nTOP, 1, 2\n*END STEP\n",
        ball[k]);
    ck_assert_int_eq(job_run(&j, ""), 0);
    ck_told(&j, "P4021", "at its end no normal of a node meets it", 1);
  }
}

/* Two sweeps solve nothing: the nodes that touch in an increment that does not
 * count are none that never touched. */
TEST(a_touch_of_an_increment_that_does_not_count_is_one) {
  JOB j = job_with(
      "block", "tests/regression/mesh/square.geo",
      "*MESH, FILE=square.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
      "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
      "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\n"
      "*CONTACT, NAME=FOOT, GROUP=BOTTOM, OBSTACLE=O\n"
      "*FRICTION, CONTACT=FOOT, LAW=COULOMB\n0.3\n*STEP\n"
      "*QUASISTATIC\n1., 1.\n*BOUNDARY\nTOP, 1, 1, 0.01\nTOP, 2, 2, -0.01\n"
      "*SOLVER, METHOD=SOR, MAX_ITER=2\n*PRINT, TOTALS\n*END STEP\n");
  ck_assert_int_eq(job_run(&j, ""), 1);
  ck_assert_double_gt(job_value(&j, "TOTALS", -1, "normal"), 0);
  ck_told(&j, "P4021", "no node touched", 0);
}

/* Step 1 ends after two sweeps, step 2 is solved: from where it starts counts
 * for slip in increments, not for one static problem. */
static void ck_after_a_miss(const char *law, const char *friction,
                            const char *step, int n_ok, int n) {
  JOB j = job_with(
      "block", "tests/regression/mesh/square.geo",
      "*MESH, FILE=square.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n%s"
      "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
      "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\n"
      "*CONTACT, NAME=FOOT, GROUP=BOTTOM, OBSTACLE=O\n%s*STEP\n"
      "*STATIC\n*BOUNDARY\nTOP, 1, 1, 0.01\nTOP, 2, 2, %s\n"
      "*SOLVER, METHOD=SOR, MAX_ITER=2\n*END STEP\n*STEP\n"
      "%s\n*SOLVER, METHOD=AUTO\n*END STEP\n",
      law, friction, friction[0] != '\0' ? "-0.01" : "\"0.02*(0.5 - x)\"",
      step);
  ck_assert_int_eq(job_run(&j, ""), 1);
  FREED char *sta = job_file(&j, "sta"), *lst = job_file(&j, "lst");
  FREED char *json = job_file(&j, "json");
  ck_assert_int_eq(count(sta, " UNSETTLED"), 1);
  ck_assert_int_eq(count(sta, " OK"), n_ok);
  ck_assert_int_eq(count(sta, " OK AFTER_UNSETTLED\n"), n);
  ck_assert_int_eq(count(lst, "DID NOT CONVERGE"), n);
  ck_assert_int_eq(count(json, "\"after_unsettled\": true"), n);
}

TEST(what_goes_on_from_a_miss_says_so) {
  static const char friction[] = "*FRICTION, CONTACT=FOOT, LAW=COULOMB\n0.3\n";
  static const char law[] = "*INELASTIC, LAW=MAXWELL\n1.\n";
  ck_after_a_miss("", friction, "*QUASISTATIC\n0.5, 1.", 2, 2);
  ck_after_a_miss("", friction, "*STATIC", 1, 0);
  ck_after_a_miss(law, "", "*VISCO, INTEGRATOR=BACKWARD\n0.5, 1.", 2, 2);
  ck_after_a_miss(law, "",
                  "*QUASISTATIC\n0.5, 1.\n*SOLVER, METHOD=AUTO\n*END STEP\n"
                  "*STEP\n*VISCO, INTEGRATOR=BACKWARD\n1., 1.",
                  3, 1);
  ck_after_a_miss(law, "",
                  "*VISCO, INTEGRATOR=BACKWARD\n0.5, 1.\n"
                  "*SOLVER, METHOD=AUTO\n*END STEP\n*STEP\n"
                  "*QUASISTATIC\n1., 1.",
                  3, 3);
}

/* Too few iterations leave the body so far away that no stress is right: no
 * verdict on the problem. */
TEST(what_goes_on_from_a_miss_proves_nothing) {
  static const char *const ways[][3] = {{"0.25", "COULOMB\n0.3", "5"},
                                        {"0.25", "COULOMB\n0.3", "8"},
                                        {"0.25", "TRESCA\n1E-6", "2"}};
  for (int k = 0; k < 3; ++k) {
    JOB j =
        job_with("far", "tests/regression/mesh/square.geo",
                 "*PARAMETER\nN = 2\n*MESH, FILE=square.geo\n"
                 "*MATERIAL, NAME=M\n*ELASTIC\n1E3, 0.4999\n"
                 "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
                 "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\n"
                 "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
                 "*FRICTION, CONTACT=C, LAW=%s\n*STEP\n*QUASISTATIC\n%s, 1.\n"
                 "*DSLOAD\nTOP, P, 1.\n*SOLVER, METHOD=NEWTON, MAX_ITER=%s\n"
                 "*PRINT, TOTALS\n*END STEP\n",
                 ways[k][1], ways[k][0], ways[k][2]);
    int code = job_run(&j, "");
    ck_assert_msg(code == 1, "%d: exit %d: %s", k, code, j.errors);
  }
}

/* Led down by 0.01: the gap of 0.0042 closes in the fifth increment. */
TEST(the_first_touch_is_told) {
  static const char led[] =
      "*QUASISTATIC\n0.1, 1.\n*BOUNDARY\nLEFT, 1\nTOP, 2, 2, -0.01\n";
  JOB j = run_block(0.0042, "", led);
  ck_told(&j, "P4021", "no node touched", 0);
  FREED char *lst = job_file(&j, "lst");
  const char *at = strstr(lst, "contact FOOT touches for the first time");
  const char *fifth = strstr(lst, "step 1  increment 5 ");
  const char *sixth = strstr(lst, "step 1  increment 6 ");
  ck_assert(at != NULL && fifth < at && at < sixth);
  ck_assert_int_eq(count(lst, "for the first time"), 1);
}

/* 0: points below their threshold; 1: warnings so far. */
TESTS(a_restart_at_the_end_loses_no_line, 2) {
  static const char *const files[] = {"lst", "json", "sta", "dat"};
  JOB j =
      run_block(0.0, "*INELASTIC, LAW=BINGHAM\n1000., 20.\n",
                _i == 0 ? "*VISCO, INTEGRATOR=BACKWARD\n0.1, 1.\n*BOUNDARY\n"
                          "LEFT, 1\n*DSLOAD\nTOP, P, 30.\n*RESTART\n"
                        : "*VISCO, INTEGRATOR=BACKWARD\n0.1, 1.\n*BOUNDARY\n"
                          "LEFT, 1\n*DSLOAD\nTOP, P, 70.\n*RESTART\n");
  char *text[4];
  for (int k = 0; k < 4; ++k) text[k] = job_file(&j, files[k]);
  ck_assert_ptr_nonnull(strstr(text[0], "points below their threshold"));
  ck_assert_int_eq(count(text[0], "P4019"), _i);
  ck_assert_int_eq(job_run(&j, "--no-timing --restart"), 0);
  for (int k = 0; k < 4; ++k) {
    FREED char *again = job_file(&j, files[k]);
    ck_assert_msg(strcmp(text[k], again) == 0, "JOB.%s differs", files[k]);
    free(text[k]);
  }
  setenv("OPENBLAS_CORETYPE", "Prescott", 1); /* the oldest there is */
  ck_assert_int_eq(job_run(&j, "--no-timing --restart --threads 2"), 0);
  ck_assert_ptr_nonnull(strstr(j.errors, "started with 1 thread and kernel "));
  char *json = job_file(&j, "json"), kernel[40], now[120];
  static const char key[] = "\"blas_kernel\": \"";
  ck_assert_int_eq(sscanf(strstr(json, key) + strlen(key), "%39[^\"]", kernel),
                   1);
  snprintf(now, sizeof now, ", this is 2 and %s: last digits may differ\n",
           kernel);
  ck_assert_ptr_nonnull(strstr(j.errors, now));
  free(json);
}

/* The slanted side of a triangle on a conforming obstacle: where its end at
 * (1, 0) is held in x or y: its friction acts along that, 45 degrees from the
 * side. */
TEST(friction_along_a_held_direction_is_told) {
  for (int k = 0; k < 4; ++k) {
    const int axis = 1 + k % 2, rubs = k / 2;
    JOB j = job_begin("slope");
    job_write(&j, "slope.msh",
              "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n3\n"
              "1 1 \"BOTTOM\"\n1 2 \"SIDE\"\n2 3 \"BODY\"\n$EndPhysicalNames\n"
              "$Nodes\n3\n1 0 0 0\n2 1 0 0\n3 0 1 0\n$EndNodes\n$Elements\n3\n"
              "1 1 2 1 1 1 2\n2 1 2 2 2 2 3\n3 2 2 3 3 1 2 3\n$EndElements\n");
    job_write(&j, "slope.inp",
              "*MESH, FILE=slope.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., .3\n"
              "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
              "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
              "*CONTACT, NAME=FOOT, GROUP=SIDE, OBSTACLE=O\n%s"
              "*STEP\n*STATIC\n*BOUNDARY\nBOTTOM, %d\n"
              "*DSLOAD\nBOTTOM, P, 1.\n*END STEP\n",
              rubs ? "*FRICTION, CONTACT=FOOT, LAW=COULOMB\n0.1\n" : "", axis);
    ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
    ck_told(&j, "P4022", "leans by 0.79 rad from obstacle O", rubs);
    ck_told(&j, "P4022", "at node 2 at (1, 0)", rubs);
    /* Forces that follow from statics have no stiffness of their own. */
    FREED char *lst = job_file(&j, "lst");
    ck_assert_ptr_null(strstr(lst, "no bound"));
  }
}

UNIT_MAIN("warnings")
