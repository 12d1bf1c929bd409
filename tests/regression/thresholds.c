/*
 * Thresholds and verdicts tried on both sides closely: what is just below is
 * taken, what is just above is refused.
 */
#include "support/tips.h"
#include "support/unit.h"

static const double G = 500;

/* The exit code, and a word of the message if there is one. */
static void check_run(job *j, int code, const char *word) {
  int is = job_run(j, "");
  ck_assert_msg(is == code, "exit %d, not %d: %s", is, code, j->errors);
  if (word != NULL) ck_assert_msg(strstr(j->errors, word), "%s", j->errors);
  job_end(j);
}

/* ---- is a start compatible? --------------------------------------------- */

/* A floor 0.001 below and a wall 0.002 aside of the first tip. All is moved as
 * one by (x, y); the tips carry the loads. */
static void start_from(double x, double y, double pull, double push, int code,
                       const char *word) {
  PRINTED(cards,
          "*AMPLITUDE, NAME=ON\n0., 1., 1., 1.\n"
          "*OBSTACLE, NAME=FLOOR, TYPE=PLANE\n0., -0.001\n0., 1.\n"
          "*OBSTACLE, NAME=WALL, TYPE=PLANE\n0.002, 0.\n-1., 0.\n"
          "*CONTACT, NAME=FLOOR, GROUP=FOOT1, OBSTACLE=FLOOR, "
          "NORMAL=OBSTACLE\n"
          "*CONTACT, NAME=WALL, GROUP=SIDE1, OBSTACLE=WALL, NORMAL=OBSTACLE\n"
          "*CONTACT, NAME=OTHER, GROUP=FOOT2, OBSTACLE=FLOOR, "
          "NORMAL=OBSTACLE\n"
          "*FRICTION, CONTACT=OTHER, LAW=COULOMB\n0.3\n"
          "*INITIAL CONDITIONS, TYPE=DISPLACEMENT\n"
          "BODY, 1, %.17g\nBODY, 2, %.17g\n*STEP\n*QUASISTATIC\n1., 1.\n"
          "*BOUNDARY\nCLAMPED, 1, 1, %.17g, ON\nCLAMPED, 2, 2, %.17g, ON\n"
          "*CLOAD\nTIPS, 1, %.17g, ON\nTIPS, 2, %.17g, ON\n*END STEP\n",
          x, y, x, y, pull, -push);
  job j = tips_new(G, "", cards);
  check_run(&j, code, word);
}

/* In parts of the largest force, 10: of the limit of friction, of the wall,
 * which cannot pull, of the floor, and of what is driven into them. */
TEST(start_is_compatible_to_a_millionth) {
  static const struct {
    double x, y, pull, push;
  } cases[] = {{2e-3, -1e-3, 3, 10}, {2e-3, -1e-3, 0, 10}};
  for (int below = 0; below < 2; ++below) {
    const double d = (below ? 0.7e-6 : 1.4e-6) * 10;
    const int code = below ? 0 : 2;
    start_from(cases[0].x, cases[0].y, cases[0].pull + d, 10, code,
               below ? NULL : "sliding limit");
    start_from(cases[1].x, cases[1].y, -d, 10, code,
               below ? NULL : "unilateral condition");
    start_from(2e-3 + d / G, -1e-3, 0, 10, code,
               below ? NULL : "unilateral condition");
    start_from(2e-3, -1e-3 - d / (3.5 * G), 0, 10, code,
               below ? NULL : "unilateral condition");
  }
}

/* ---- is it the end of a run on this mesh? -------------------------------- */

#define LOADED                                                   \
  "*OBSTACLE, NAME=FLOOR, TYPE=CONFORMING\n"                     \
  "*CONTACT, NAME=FLOOR, GROUP=FOOT1, OBSTACLE=FLOOR\n%s*STEP\n" \
  "*QUASISTATIC\n0.5, 1.\n*BOUNDARY\nCLAMPED, 1, 2\n*CLOAD\n"    \
  "TIPS, 2, \"-10%s\"\n*OUTPUT\n*END STEP\n"

static void end_of_other(const char *scale, int code) {
  char cards[900];
  snprintf(cards, sizeof cards, LOADED, "", "");
  JOB first = tips_new(G, "", cards);
  ck_assert_int_eq(job_run(&first, ""), 0);
  snprintf(cards, sizeof cards, LOADED,
           "*INITIAL CONDITIONS, TYPE=DISPLACEMENT, FILE=end.h5\n", "+0*t");
  job j = tips_new(G, scale, cards);
  PRINTED(command, "cp %s/tips.h5 %s/end.h5", first.dir, j.dir);
  ck_assert_int_eq(system(command), 0);
  check_run(&j, code, code == 0 ? NULL : "has another mesh");
}

TEST(end_of_a_run_is_of_the_same_mesh) {
  end_of_other("", 0);
  end_of_other(", SCALE=1.0000000001", 0);
  end_of_other(", SCALE=1.00000001", 2);
  end_of_other(", SCALE=1.05", 2);
}

/* ---- is an increment short enough? ----------------------------------------
 */

/* What a step of z = dt/tau makes of a held stress. */
static double held_factor(const char *integrator, double z) {
  if (strcmp(integrator, "EULER") == 0) return 1 - z;
  if (strcmp(integrator, "BACKWARD") == 0) return 1 / (1 + z);
  return (1 - z / 2) / (1 + z / 2); /* MIDPOINT                              */
}

/* The error of a step of z in parts of the strain at its start: halves of it
 * with Richardson's factor, or Euler beside Heun. */
static double told_error(const char *integrator, double z) {
  if (strcmp(integrator, "HEUN") == 0) return z * z / 2;
  const double power = strcmp(integrator, "MIDPOINT") == 0 ? 4 : 2;
  const double half = held_factor(integrator, z / 2);
  return power / (power - 1) * fabs(half * half - held_factor(integrator, z));
}

/* Lengths of the first increments that are taken, from the largest strain. */
static void taken(const char *integrator, double tolerance, double dt[2]) {
  PRINTED(cards,
          "*STEP\n*VISCO, INTEGRATOR=BACKWARD\n1E-9, 1E-9\n*BOUNDARY\n"
          "CLAMPED, 1, 2\nTIPS, 2, 2, \"-0.01 + 0*t\"\nTIPS, 1\n*END STEP\n"
          "*STEP\n*VISCO, INTEGRATOR=%s, TOLERANCE=%.17g\n0.1, 1., 1E-3\n"
          "*PRINT, ENERGY\n*END STEP\n",
          integrator, tolerance);
  JOB j = tips_new(G, "", cards);
  tips_material(&j, "*INELASTIC, LAW=MAXWELL\n1.\n");
  CK_EXIT(job_run(&j, ""), 0, j);
  double before = 1e-9;
  for (int k = 0; k < 2; ++k) {
    DAT e = job_table(&j, "ENERGY", k);
    dt[k] = dat_at(&e, 0, "time") - before;
    before += dt[k];
  }
}

TEST(increment_is_taken_up_to_its_tolerance) {
  static const char *const rows[] = {"EULER", "HEUN", "BACKWARD", "MIDPOINT"};
  for (int i = 0; i < 4; ++i) {
    const double error = told_error(rows[i], 0.1);
    double dt[2];
    taken(rows[i], 1.01 * error, dt);
    ck_assert_double_eq_tol(dt[0], 0.1, 1e-8);
    taken(rows[i], 0.99 * error, dt);
    ck_assert_double_le(dt[0], 0.05 + 1e-8);
  }
}

/* An error of half the tolerance: the next increment is 0.9 sqrt(2) as long. */
TEST(next_increment_follows_the_error) {
  double dt[2];
  taken("HEUN", 2 * told_error("HEUN", 0.1), dt);
  ck_assert_double_eq_tol(dt[1], 0.1 * 0.9 * sqrt(2), 1e-6);
}

UNIT_MAIN("thresholds")
