/*
 * What only the next increment or a run that goes on needs: bodies of one
 * contact node, whose answers are closed forms, in many increments, and stopped
 * within a step and gone on with.
 */
#include "support/tips.h"
#include "support/traced.h"
#include "support/unit.h"

#include <signal.h>

static const double G = 500, N = 10, mu = 0.3;

static job new_job(const char *cards) { return tips_new(G, "", cards); }

static job run_job(const char *cards) {
  job j = new_job(cards);
  CK_EXIT(job_run(&j, "--no-timing"), 0, j);
  return j;
}

/* Stopped at some changes of its files and gone on with: all files the same. */
static void check_stopped(const char *cards) {
  static const char *const none[] = {NULL};
  traced t = {.action = TRACE_COUNT};
  JOB whole = new_job(cards);
  ck_assert_int_eq(traced_run(&whole, none, &t), 0);
  const int all = t.changes;
  for (int k = 3; k <= 4; ++k) {
    JOB j = new_job(cards);
    t = (traced){.action = TRACE_SIGNAL, .at = k * all / 10, .number = SIGINT};
    ck_assert_int_eq(traced_run(&j, none, &t), 130);
    ck_assert_int_gt(t.restarts, 0);
    ck_assert_int_eq(t.synced, t.restarts);
    CK_EXIT(job_run(&j, "--restart --no-timing"), 0, j);
    const char *file = traced_difference(&whole, &j);
    ck_assert_msg(file == NULL, "stopped at %d: .%s differs", k, file);
  }
}

/* ---- two rollers -------------------------------------------------------- */

#define ROLLERS(form)                                                       \
  "*OBSTACLE, NAME=A, TYPE=CYLINDER, RADIUS=2\n0., -2.\n"                   \
  "ROTATE, 0., -2., \"-0.2*t\"\n"                                           \
  "*OBSTACLE, NAME=B, TYPE=CYLINDER, RADIUS=3\n4., -3.\n"                   \
  "ROTATE, 4., -3., \"0.1*t\"\n"                                            \
  "*CONTACT, NAME=A, GROUP=FOOT1, OBSTACLE=A, NORMAL=OBSTACLE\n"            \
  "*CONTACT, NAME=B, GROUP=FOOT2, OBSTACLE=B, NORMAL=OBSTACLE\n"            \
  "*FRICTION, CONTACT=A, LAW=COULOMB\n0.3\n"                                \
  "*FRICTION, CONTACT=B, LAW=COULOMB\n0.3\n"                                \
  "*STEP\n*STATIC\n1E-9\n*BOUNDARY\nCLAMPED, 1, 2\n*CLOAD\nTIPS, 2, -10.\n" \
  "*SOLVER, TOL=1E-13\n*END STEP\n*STEP\n*QUASISTATIC, FORM=" form          \
  "\n0.1, 1.\n"                                                             \
  "*PRINT, CONTACT, LOOP, ENERGY\n*OUTPUT\n*END STEP\n"

/* The surface passes by the radius times the angle; past mu N / G it slips: the
 * rest of the way is slip, and heat, of each roller and of both. */
TESTS(rollers_heat_by_the_way_that_slips, 2) {
  const double drawn = mu * N / G, way[] = {0.4, -0.3}, angle[] = {-0.2, 0.1};
  JOB j = run_job(_i == 0 ? ROLLERS("DISPLACEMENT") : ROLLERS("VELOCITY"));
  double heat = 0;
  for (int k = 0; k < 10; ++k) {
    const double part = 0.1 * (k + 1);
    DAT l = job_table(&j, "LOOP", k), c = job_table(&j, "CONTACT", k);
    DAT e = job_table(&j, "ENERGY", k);
    heat = 0;
    for (int i = 0; i < 2; ++i) {
      const double sign = way[i] > 0 ? 1 : -1;
      const double slip = fabs(part * way[i]) - drawn;
      heat += mu * N * slip;
      ck_assert_double_eq_tol(dat_at(&l, i, "way"), part * way[i], 1e-8);
      ck_assert_double_eq_tol(dat_at(&l, i, "angle"), part * angle[i], 1e-8);
      ck_assert_double_eq_tol(dat_at(&l, i, "mean_u_t"), sign * drawn, 1e-8);
      ck_assert_double_eq_tol(dat_at(&l, i, "loop_area"), mu * N * slip, 1e-6);
      ck_assert_double_eq_tol(dat_at(&c, i, "slip_distance"), slip, 1e-8);
    }
    ck_assert_double_eq_tol(dat_at(&e, 0, "friction_work_end"), heat, 1e-6);
    /* The force grows to mu N in the first increment. */
    const double first = 0.5 * mu * N * (0.1 * 0.7 - 2 * drawn);
    ck_assert_double_eq_tol(dat_at(&e, 0, "friction_work"), heat - first, 1e-6);
    /* What the rollers put in is heat and the springs. */
    ck_assert_double_eq_tol(dat_at(&e, 0, "normal_work"),
                            heat - first + mu * N * drawn, 1e-6);
  }
}

TEST(rollers_go_on) { check_stopped(ROLLERS("DISPLACEMENT")); }

/* ---- u_0 and supports that move on from there --------------------------- */

#define RAMP                                                                   \
  "*OBSTACLE, NAME=A, TYPE=CONFORMING\n"                                       \
  "*CONTACT, NAME=A, GROUP=FOOT1, OBSTACLE=A\n"                                \
  "*FRICTION, CONTACT=A, LAW=COULOMB\n0.3\n"                                   \
  "*INITIAL CONDITIONS, TYPE=DISPLACEMENT\nBODY, 1, 0.003\n"                   \
  "*STEP\n*QUASISTATIC\n0.1, 1.\n*BOUNDARY\nCLAMPED, 1, 1, 0.01\nCLAMPED, 2\n" \
  "TIPS, 2\n*PRINT, NODES, CONTACT\n*OUTPUT\n*END STEP\n"

TEST(supports_move_on_from_the_start) {
  JOB j = run_job(RAMP);
  for (int k = 0; k < 10; ++k) {
    DAT u = job_table(&j, "NODES", k);
    for (int i = 0; i < u.n_row; ++i)
      if (dat_at(&u, i, "y") > 0.5)
        ck_assert_double_eq_tol(dat_at(&u, i, "u_x"), 0.003 + 7e-4 * (k + 1),
                                1e-12);
  }
}

TEST(supports_move_on_after_a_stop) { check_stopped(RAMP); }

/* ---- a tolerance ----------------------------------------------------------
 */

/* Creep under a load of 1 that falls to some 0.002: errors are told in parts of
 * the largest strain so far, and what the small load lets creep is none. */
TEST(tolerance_is_of_the_largest_strain_so_far) {
  JOB j = new_job(
      "*AMPLITUDE, NAME=A\n"
      "\"if(t < 1, 1, 0.002*(1 + sin(40*(t - 1))))\"\n"
      "*STEP\n*VISCO, INTEGRATOR=BACKWARD, TOLERANCE=1E-3\n"
      "0.125, 2.\n*BOUNDARY\nCLAMPED, 1, 2\n*CLOAD\n"
      "TIPS, 2, -1., A\n*PRINT, ENERGY\n*END STEP\n");
  tips_material(&j, "*INELASTIC, LAW=MAXWELL\n1.\n");
  CK_EXIT(job_run(&j, ""), 0, j);
  FREED char *text = job_file(&j, "dat");
  int late = 0;
  for (char *p = text; (p = strstr(p, " time ")) != NULL; p += 6)
    late += atof(p + 6) > 1.1;
  ck_assert_int_gt(late, 1);
  ck_assert_int_le(late, 20);
}

/* Steps of no more than 0.5 are stable, tau = 0.25: an increment of 1 and the
 * rest, 0.8, are made in halves. */
TEST(rest_of_a_step_is_cut_in_halves) {
  static const double end[] = {0.5, 1, 1.4, 1.8};
  JOB j = new_job(
      "*STEP\n*VISCO, INTEGRATOR=EULER, SUBSTEPS=AUTO\n1., 1.8\n*BOUNDARY\n"
      "CLAMPED, 1, 2\nTIPS, 2, 2, -0.01\n*PRINT, ENERGY\n"
      "*END STEP\n");
  tips_material(&j, "*INELASTIC, LAW=MAXWELL\n0.25\n");
  CK_EXIT(job_run(&j, ""), 0, j);
  for (int k = 0; k < 4; ++k) {
    DAT e = job_table(&j, "ENERGY", k);
    ck_assert_double_eq_tol(dat_at(&e, 0, "time"), end[k], 1e-12);
  }
}

/* ---- a corner ------------------------------------------------------------ */

/* The tip is driven towards a floor 0.002 below and a wall 0.003 aside, loads
 * that would bring it there at a quarter and at half of the step; the wall is
 * *CONTACT number "wall", from 0. */
static void check_corner(const char *form, int wall) {
  static const char *const contact[] = {
      "*CONTACT, NAME=FLOOR, GROUP=FOOT1, OBSTACLE=FLOOR, NORMAL=OBSTACLE\n",
      "*CONTACT, NAME=WALL, GROUP=SIDE1, OBSTACLE=WALL, NORMAL=OBSTACLE\n"};
  const double kn = 2 * G * 0.7 / 0.4;
  PRINTED(cards,
          "*OBSTACLE, NAME=FLOOR, TYPE=PLANE\n0., -0.002\n0., 1.\n"
          "*OBSTACLE, NAME=WALL, TYPE=PLANE\n0.003, 0.\n-1., 0.\n%s%s"
          "*STEP\n*QUASISTATIC, FORM=%s\n0.1, 1.\n*BOUNDARY\nCLAMPED, 1, 2\n"
          "*CLOAD\nTIPS, 1, %.17g\nTIPS, 2, %.17g\n*SOLVER, TOL=1E-13\n"
          "*PRINT, NODES, TOTALS, CONTACT\n*END STEP\n",
          contact[1 - wall], contact[wall], form, 2 * 0.003 * G,
          -4 * 0.002 * kn);
  JOB j = run_job(cards);
  for (int k = 0; k < 10; ++k) {
    const double t = 0.1 * (k + 1);
    DAT u = job_table(&j, "NODES", k), f = job_table(&j, "TOTALS", k);
    DAT c = job_table(&j, "CONTACT", k);
    int tip = 0;
    while (dat_at(&u, tip, "node_no") != 3) ++tip;
    ck_assert_double_eq_tol(dat_at(&u, tip, "u_x"), fmin(0.003, 0.006 * t),
                            1e-12);
    ck_assert_double_eq_tol(dat_at(&u, tip, "u_y"), -fmin(0.002, 0.008 * t),
                            1e-12);
    ck_assert_double_eq_tol(dat_at(&f, 1 - wall, "normal"),
                            fmax(0, kn * (0.008 * t - 0.002)), 1e-9);
    ck_assert_double_eq_tol(dat_at(&f, wall, "normal"),
                            fmax(0, G * (0.006 * t - 0.003)), 1e-9);
    ck_assert_double_eq(dat_at(&c, 0, "f_t"), 0);
  }
}

TEST(corner_closes_one_gap_after_the_other) {
  for (int wall = 0; wall < 2; ++wall) {
    check_corner("DISPLACEMENT", wall);
    check_corner("VELOCITY", wall);
  }
}

UNIT_MAIN("carried")
