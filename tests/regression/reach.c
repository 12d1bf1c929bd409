/*
 * Contact nodes that the step cannot bring to their obstacle are left out of
 * the condensed problem; those that come to it all the same are taken in a
 * second pass. The answer is that of the whole problem, which is what is solved
 * where the condensed problem is written (*OUTPUT, CONDENSED=FCLIB).
 */
#include "support/block_file.h"
#include "support/job.h"
#include "support/traced.h"
#include "support/unit.h"

#include <signal.h>

const int job_without_fields = 1;

#define HEAD                                            \
  "*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=CPE3\n" \
  "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
static const char rough[] = "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n";
static const char whole[] = "*OUTPUT, CONDENSED=FCLIB\n";

/* A block, 4 long for 1 high, on a cylinder that touches it in its middle. The
 * cards "first" go on with its material. */
static job in_step(const char *first, const char *friction, const char *step,
                   const char *more) {
  job j = job_begin("cylinder");
  block_file_write(&j, (int[]){80, 10}, (double[]){80.0, 20.0}, 0);
  job_write(&j, "cylinder.inp",
            "*MESH, FILE=block.msh\n" HEAD
            "%s*OBSTACLE, NAME=O, TYPE=CYLINDER, "
            "RADIUS=100.\n40., -100.\n"
            "*CONTACT, NAME=C, GROUP=CONTACT, OBSTACLE=O, NORMAL=OBSTACLE\n"
            "%s*STEP\n*%s\n0.25, 1.0\n*BOUNDARY\nLEFT, 1, 1\n"
            "TOP, 2, 2, -0.1\n*DSLOAD\nSYMMETRY, P, 2.\n"
            "*PRINT, CONTACT, ENERGY\n%s*END STEP\n",
            first, friction, step, more);
  return j;
}

static job on_cylinder(const char *friction, const char *more) {
  return in_step("", friction, "QUASISTATIC", more);
}

/* A cantilever that bends down to a floor, first at its end. */
static job cantilever(const char *friction, const char *more) {
  job j = job_begin("cantilever");
  block_file_write(&j, (int[]){48, 6}, (double[]){8.0, 1.0}, 0);
  job_write(&j, "cantilever.inp",
            "*MESH, FILE=block.msh\n" HEAD
            "*OBSTACLE, NAME=O, TYPE=PLANE\n0., "
            "-0.02\n0., 1.\n"
            "*CONTACT, NAME=C, GROUP=CONTACT, OBSTACLE=O, NORMAL=OBSTACLE\n"
            "%s*STEP\n*QUASISTATIC\n0.125, 1.0, 0.03125, 0.125\n*BOUNDARY\n"
            "LEFT, 1, 2\n*DSLOAD\nTOP, P, 0.08\n*PRINT, CONTACT\n*RESTART\n"
            "%s*END STEP\n",
            friction, more);
  return j;
}

static void run(job *j, int expected) {
  CK_EXIT(job_run(j, "--no-timing"), expected, *j);
}

/* Largest difference of a column of the last table over its largest entry. */
static double apart(const job *a, const job *b, const char *name) {
  double most = 0.0, size = 0.0;
  DAT x = job_table(a, "CONTACT", -1), y = job_table(b, "CONTACT", -1);
  ck_assert_int_eq(x.n_row, y.n_row);
  for (int k = 0; k < x.n_row; ++k) {
    most = fmax(most, fabs(dat_at(&x, k, name) - dat_at(&y, k, name)));
    size = fmax(size, fabs(dat_at(&y, k, name)));
    ck_assert_double_eq(dat_at(&x, k, "status"), dat_at(&y, k, "status"));
  }
  return most / size;
}

static void same_answer(const job *a, const job *b, double tol) {
  static const char *const columns[] = {"u_n", "u_t", "gap", "f_n"};
  for (size_t k = 0; k < sizeof columns / sizeof *columns; ++k) {
    double found = apart(a, b, columns[k]);
    ck_assert_msg(found <= tol, "%s: %.2g", columns[k], found);
  }
}

static int notes(const job *j) {
  FREED char *text = job_file(j, "lst");
  int n = 0;
  for (char *at = text; (at = strstr(at, "inactive contact nodes")); ++at) ++n;
  return n;
}

/* 81 candidates, of which 7 lie within 0.2 of the cylinder. */
static void check_cylinder(const char *friction, double unknowns) {
  long few, all;
  JOB a = on_cylinder(friction, ""), b = on_cylinder(friction, whole);
  ck_assert_int_eq(job_run(&a, ""), 0);
  ck_assert_int_eq(job_run(&b, ""), 0);
  ck_assert_double_eq(job_told(&a, "contact_nodes"), 81.0);
  ck_assert_double_le(job_told(&a, "contact_unknowns"), 15.0 * unknowns);
  ck_assert_double_eq(job_told(&b, "contact_unknowns"), 162.0);
  ck_assert_int_eq(job_stage(&a, "condensed stiffness", &few), 1);
  ck_assert_int_eq(job_stage(&b, "condensed stiffness", &all), 1);
  ck_assert_int_lt(20 * few, all);
  ck_assert_int_eq(notes(&a), 0);
  same_answer(&a, &b, 1e-10);
  if (friction[0] != '\0') {
    ck_assert_double_le(apart(&a, &b, "f_t"), 1e-10);
    ck_assert_double_le(apart(&a, &b, "slip_distance"), 1e-9);
  }
}

TEST(long_surface_costs_its_nodes_within_reach) { check_cylinder("", 1.0); }

/* A thin body under thin loads moves as a thick one. */
TEST(nodes_within_reach_are_those_of_any_thickness) {
  double n[2];
  for (int k = 0; k < 2; ++k) {
    JOB j = job_begin("cylinder");
    block_file_write(&j, (int[]){80, 10}, (double[]){80.0, 20.0}, 0);
    job_write(
        &j, "cylinder.inp",
        "*MESH, FILE=block.msh\n*SOLID SECTION, ELSET=BODY, MATERIAL=M, "
        "TYPE=CPE3, THICKNESS=%s\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
        "*OBSTACLE, NAME=O, TYPE=CYLINDER, RADIUS=100.\n40., -100.\n"
        "*CONTACT, NAME=C, GROUP=CONTACT, OBSTACLE=O, NORMAL=OBSTACLE\n"
        "*STEP\n*STATIC\n*BOUNDARY\nTOP, 1, 2\n*DSLOAD\n"
        "CONTACT, P, -2.\n*END STEP\n",
        k == 0 ? "1." : "1E-6");
    ck_assert_int_eq(job_run(&j, ""), 0);
    n[k] = job_told(&j, "contact_unknowns");
  }
  ck_assert_double_lt(n[0], 81.0);
  ck_assert_double_eq(n[1], n[0]);
}

/* Also what rubs where it touches. */
TEST(rough_surface_costs_its_nodes_within_reach) { check_cylinder(rough, 2.0); }

static void check_cantilever(const char *friction, double unknowns) {
  JOB a = cantilever(friction, ""), b = cantilever(friction, whole);
  run(&a, 0);
  run(&b, 0);
  ck_assert_double_le(job_told(&a, "contact_unknowns"), 24.0 * unknowns);
  int passes = notes(&a);
  ck_assert_int_ge(passes, 1);
  ck_assert_int_gt(job_stage(&a, "condensed stiffness", NULL), passes);
  same_answer(&a, &b, 1e-9);
  DAT d = job_table(&a, "CONTACT", -1);
  int touches = 0;
  for (int k = 0; k < d.n_row; ++k) {
    ck_assert_double_ge(dat_at(&d, k, "gap"), 0.0);
    touches += dat_at(&d, k, "f_n") > 0.0;
  }
  ck_assert_int_ge(touches, 2);
}

/* Bending goes far beyond what loads over moduli promise. */
TEST(nodes_that_reach_are_taken_in_a_second_pass) { check_cantilever("", 1.0); }

TEST(rough_nodes_that_reach_are_taken_too) { check_cantilever(rough, 2.0); }

/* Limits given whatever the pressure, or from the pressure around, act on nodes
 * that do not touch, points of time and halved increments have other loads: all
 * stay. */
TEST(other_laws_keep_all_nodes) {
  static const struct {
    const char *law, *more;
    double unknowns;
  } rows[] = {
      {"*FRICTION, CONTACT=C, LAW=TRESCA\n1.\n", "", 162},
      {"*FRICTION, CONTACT=C, LAW=NONLOCAL, RADIUS=2.\n0.3\n", "", 162},
      {"*TIME POINTS, NAME=T\n0.3\n", "*PRINT, CONTACT, TIME POINTS=T\n", 81},
      {rough, "*ACCURACY, TIME=YES\n", 162}};
  for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
    JOB j = on_cylinder(rows[k].law, rows[k].more);
    run(&j, 0);
    ck_assert_double_eq(job_told(&j, "contact_unknowns"), rows[k].unknowns);
  }
}

/* So do those that something else than loads and supports moves or loads. */
TEST(other_effects_keep_all_nodes) {
  static const struct {
    const char *first, *step, *more;
  } rows[] = {
      {"*DENSITY\n1.\n", "QUASISTATIC", "*DLOAD\nBODY, GRAV, 1e-6, 0., -1.\n"},
      {"*EXPANSION\n1e-9\n", "QUASISTATIC", "*TEMPERATURE\nBODY, 1.\n"},
      {"*INELASTIC, LAW=NORTON\n1e-20, 2.\n", "VISCO, INTEGRATOR=EULER", ""},
      {"*INITIAL CONDITIONS, TYPE=DISPLACEMENT\nTOP, 1, 0.\n", "QUASISTATIC",
       ""}};
  for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
    JOB j = in_step(rows[k].first, "", rows[k].step, rows[k].more);
    run(&j, 0);
    ck_assert_double_eq(job_told(&j, "contact_unknowns"), 81);
  }
}

/* What is cheap with the nodes first expected to touch may not fit with all. */
TEST(stiffness_is_chosen_again_for_more_nodes) {
  static const char *const cards[] = {"*SOLVER, MAX_MEMORY=7\n",
                                      "*SOLVER, STIFFNESS=DENSE\n"};
  job j[2];
  for (int k = 0; k < 2; ++k) {
    j[k] = job_begin("thick");
    job_write(&j[k], "block.geo",
              "Point(1) = {0, 0, 0};\n"
              "b[] = Extrude {8, 0, 0} { Point{1}; Layers{300}; };\n"
              "s[] = Extrude {0, 0.48, 0} { Line{b[1]}; Layers{12}; };\n"
              "Physical Curve(\"CONTACT\") = {b[1]};\n"
              "Physical Curve(\"TOP\") = {s[0]};\n"
              "Physical Curve(\"LEFT\") = {s[3]};\n"
              "Physical Surface(\"BODY\") = {s[1]};\n");
    job_write(&j[k], "thick.inp",
              "*MESH, FILE=block.geo\n" HEAD
              "*OBSTACLE, NAME=O, TYPE=PLANE\n0., "
              "-0.02\n0., 1.\n"
              "*CONTACT, NAME=C, GROUP=CONTACT, OBSTACLE=O, NORMAL=OBSTACLE\n"
              "%s*STEP\n*QUASISTATIC\n0.5, 1.0\n*BOUNDARY\nLEFT, 1, 2\n"
              "*DSLOAD\nTOP, P, 0.08\n*PRINT, CONTACT\n%s*END STEP\n",
              rough, cards[k]);
    run(&j[k], 0);
    ck_assert_int_ge(notes(&j[k]), 1);
    FREED char *listing = job_file(&j[k], "lst");
    ck_assert_ptr_nonnull(strstr(listing, " DENSE  "));
  }
  ck_assert_int_eq(job_stage(&j[0], "condensed stiffness", NULL), 1);
  ck_assert_int_eq(job_stage(&j[1], "condensed stiffness", NULL), 2);
  same_answer(&j[0], &j[1], 1e-9);
  for (int k = 0; k < 2; ++k) job_end(&j[k]);
}

/* The most attempts at an increment. */
static int attempts(const job *j) {
  FREED char *text = job_file(j, "sta");
  int most = 0;
  for (char *line = strtok(text, "\n"); line != NULL;
       line = strtok(NULL, "\n")) {
    int step, increment, attempt;
    if (sscanf(line, "%d %d %d", &step, &increment, &attempt) == 3 &&
        attempt > most)
      most = attempt;
  }
  return most;
}

/* Sweeps too few for whole increments: they are cut, and all nodes taken. */
TEST(increments_are_cut_with_all_nodes) {
  JOB a = cantilever("", "*SOLVER, METHOD=SOR, MAX_ITER=300\n");
  JOB b = cantilever("", whole);
  ck_assert_int_le(job_run(&a, "--no-timing"), 1);
  run(&b, 0);
  ck_assert_int_ge(attempts(&a), 2);
  ck_assert_int_ge(job_stage(&a, "condensed stiffness", NULL), 2);
  same_answer(&a, &b, 1e-5);
}

/* Interrupted before and after the second pass and gone on with: the same
 * files, byte by byte. */
static void check_going_on(const char *friction, int interruptions) {
  static const char *const nothing[] = {NULL, NULL};
  static const char *const again[] = {"--restart", NULL};
  JOB a = cantilever(friction, "");
  traced count = {.action = TRACE_SIGNAL};
  ck_assert_int_eq(traced_run(&a, nothing, &count), 0);
  for (int part = 9 - 2 * (interruptions - 1); part < 10; part += 2) {
    JOB b = cantilever(friction, "");
    traced t = {.action = TRACE_SIGNAL,
                .at = count.changes * part / 10,
                .number = SIGINT};
    int code = traced_run(&b, nothing, &t);
    if (code != 130) {
      continue;
    }
    ck_assert_int_eq(traced_run(&b, again, NULL), 0);
    const char *file = traced_difference(&a, &b);
    ck_assert_msg(file == NULL, "part %d: .%s differs", part, file);
  }
}

TEST(run_goes_on_bit_for_bit) { check_going_on("", 3); }

TEST(rough_run_goes_on_bit_for_bit) { check_going_on(rough, 1); }

UNIT_MAIN("reach")
