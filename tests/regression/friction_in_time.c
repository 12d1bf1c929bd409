/*
 * Friction that varies: in time by table, amplitude and expression, by another
 * *FRICTION card in a step, in space, by group; jumps are told.
 *
 * Unit square, nu = 0, E = 1000, G = 500, pressed by 10 and dragged along by
 * u_x = U at the top while its foot slips: sigma_xy = mu p everywhere (the side
 * faces carry it), the foot is at U - mu p / G.
 */
#include "support/job.h"
#include "support/unit.h"

const int job_without_fields = 1;

#define PRESS                                                             \
  "*STEP\n*QUASISTATIC\n1., 1.\n*BOUNDARY\nTOP, 2, 2, -0.01\nTOP, 1, 1\n" \
  "*PRINT, CONTACT, TOTALS\n*END STEP\n"

/* friction: the card before the steps; tau: side traction in the second step,
 * t from 1 to 2, U = 0.1 (t - 1); then the rest of the deck. */
static job run_drag(const char *friction, const char *tau, const char *rest) {
  job j =
      job_with("drag", "tests/regression/mesh/square.geo",
               "*PARAMETER\nN = 4\n*MESH, FILE=square.geo\n*MATERIAL, NAME=M\n"
               "*ELASTIC\n1000., 0.\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
               "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
               "*CONTACT, NAME=F, GROUP=BOTTOM, OBSTACLE=O\n%s" PRESS
               "*STEP\n*QUASISTATIC\n0.25, 1.\n*BOUNDARY\n"
               "TOP, 1, 1, \"0.1*(t-1)\"\n*DSLOAD\nRIGHT, TY, \"%s\"\n"
               "LEFT, TY, \"-(%s)\"\n%s",
               friction, tau, tau, rest);
  CK_EXIT(job_run(&j, "--no-timing"), 0, j);
  return j;
}

/* Increment k slips with coefficient mu at time t. */
static void check_slip(const job *j, int k, double t, double mu) {
  DAT c = job_table(j, "CONTACT", k);
  for (int i = 0; i < c.n_row; ++i) {
    ck_assert_double_eq(dat_at(&c, i, "status"), 1.0);
    ck_assert_double_eq_tol(dat_at(&c, i, "pressure"), 10.0, 1e-8);
    ck_assert_double_eq_tol(dat_at(&c, i, "traction_t"), -10 * mu, 1e-8);
    ck_assert_double_eq_tol(dat_at(&c, i, "u_t"), 0.1 * (t - 1) - 10 * mu / 500,
                            1e-10);
  }
}

/* mu from 0.2 at t = 1 to 0.4 at t = 2, said in four ways. */
TEST(mu_of_time_in_every_way) {
  static const char *const cards[] = {
      "*FRICTION, CONTACT=F, LAW=COULOMB, TABLE=T\n0., 0.2, 1., 0.2\n2., 0.4\n",
      "*AMPLITUDE, NAME=A, TIME=TOTAL TIME\n0., 1., 1., 1., 2., 2.\n"
      "*FRICTION, CONTACT=F, LAW=COULOMB, AMPLITUDE=A\n0.2\n",
      "*AMPLITUDE, NAME=A, TIME=TOTAL TIME\n\"max(1, t)\"\n"
      "*FRICTION, CONTACT=F, LAW=COULOMB, AMPLITUDE=A\n0.2\n",
      "*FRICTION, CONTACT=F, LAW=COULOMB\n\"0.2*max(1, t)\"\n",
      "*FRICTION, CONTACT=F, LAW=TRESCA\n\"2*max(1, t)\"\n",
      "*FRICTION, CONTACT=F, LAW=TRESCA, TABLE=T\n1., 2., 2., 4.\n"};
  for (size_t k = 0; k < sizeof cards / sizeof *cards; ++k) {
    JOB j = run_drag(cards[k], "2*t", "*END STEP\n");
    for (int i = 1; i <= 4; ++i) {
      double t = 1 + 0.25 * i;
      check_slip(&j, i, t, 0.2 * t);
    }
    ck_assert(!job_tells(&j, "jumps at"));
  }
}

/* A constant in quotes is a course too; the floor that moves by a number gets
 * there at the end of the first step, as a load does, and stays. */
TEST(constant_amplitude_and_motion) {
  JOB j =
      job_with("push", "tests/regression/mesh/square.geo",
               "*PARAMETER\nN = 4\n*MESH, FILE=square.geo\n*MATERIAL, NAME=M\n"
               "*ELASTIC\n1000., 0.\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
               "*AMPLITUDE, NAME=A, TIME=TOTAL TIME\n\"2*0.1\"\n"
               "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\nMOVE, 0., 0.01\n"
               "*CONTACT, NAME=F, GROUP=BOTTOM, OBSTACLE=O\n"
               "*FRICTION, CONTACT=F, LAW=COULOMB, AMPLITUDE=A\n1.5\n"
               "*STEP\n*QUASISTATIC\n0.5, 2.\n*BOUNDARY\nTOP, 1, 2\n"
               "*PRINT, CONTACT\n*END STEP\n*STEP\n*QUASISTATIC\n0.5, 1.\n"
               "*END STEP\n");
  CK_EXIT(job_run(&j, ""), 0, j);
  for (int k = 0; k < 6; ++k) {
    double p = fmin(10.0, 2.5 * (k + 1));
    DAT c = job_table(&j, "CONTACT", k);
    for (int i = 0; i < c.n_row; ++i) {
      ck_assert_double_eq_tol(dat_at(&c, i, "pressure"), p, 1e-8);
      ck_assert_double_eq_tol(dat_at(&c, i, "limit"),
                              0.3 * dat_at(&c, i, "f_n"), 1e-12);
    }
  }
}

/* The jump of the expression, or of that of an amplitude, at t = 1.6 is found
 * between two increments. */
TEST(jump_of_an_expression_is_told) {
  static const char *const cards[] = {
      "*FRICTION, CONTACT=F, LAW=COULOMB\n\"if(t < 1.6, 0.2, 0.3)\"\n",
      "*AMPLITUDE, NAME=A, TIME=TOTAL TIME\n\"if(t < 1.6, 1, 1.5)\"\n"
      "*FRICTION, CONTACT=F, LAW=COULOMB, AMPLITUDE=A\n0.2\n"};
  for (int k = 0; k < 2; ++k) {
    JOB j = run_drag(cards[k], "if(t < 1.6, 2, 3)", "*END STEP\n");
    for (int i = 1; i <= 4; ++i)
      check_slip(&j, i, 1 + 0.25 * i, i < 3 ? 0.2 : 0.3);
    ck_assert(job_tells(
        &j, "  mu of contact F jumps at t = 1.6 from 0.2 to 0.3, node 1\n"));
  }
}

/* A course that comes to zero at the end of an increment has no jump. */
TEST(course_down_to_zero_is_no_jump) {
  JOB j = run_drag("*FRICTION, CONTACT=F, LAW=COULOMB\n\"0.4*(2 - t)\"\n",
                   "4*(2 - t)", "*END STEP\n");
  for (int i = 1; i <= 4; ++i) check_slip(&j, i, 1 + 0.25 * i, 0.4 - 0.1 * i);
  ck_assert(!job_tells(&j, "jumps at"));
}

/* Another card in a step counts from there on, in later steps too. */
TEST(friction_card_in_a_step_takes_over) {
  JOB j = run_drag("*FRICTION, CONTACT=F, LAW=COULOMB\n0.8\n", "2+0*t",
                   "*FRICTION, CONTACT=F, LAW=COULOMB\n0.2\n*END STEP\n"
                   "*STEP\n*QUASISTATIC\n0.5, 1.\n*END STEP\n"
                   "*STEP\n*QUASISTATIC\n0.5, 1.\n"
                   "*FRICTION, CONTACT=F, LAW=TRESCA\n3.\n"
                   "*DSLOAD\nRIGHT, TY, \"3+0*t\"\nLEFT, TY, \"-3-0*t\"\n"
                   "*BOUNDARY\nTOP, 1, 1, \"0.1*(t-1)\"\n*END STEP\n");
  for (int i = 1; i <= 6; ++i)
    check_slip(&j, i, i < 5 ? 1 + 0.25 * i : 2 + 0.5 * (i - 4), 0.2);
  ck_assert(job_tells(
      &j, "  mu of contact F jumps at t = 1 from 0.8 to 0.2, node 1\n"));
  check_slip(&j, 7, 3.5, 0.3);
  check_slip(&j, 8, 4, 0.3);
  ck_assert(job_tells(
      &j, "  friction of contact F changes at t = 3 from COULOMB to TRESCA\n"));
}

/* Each node slips as before a new card: the contraction, of an error that is
 * bounded, is that of its mu, to which it is proportional. */
TEST(contraction_is_that_of_the_card) {
  JOB j = run_drag("*FRICTION, CONTACT=F, LAW=COULOMB\n0.1\n", "1+0*t",
                   "*END STEP\n*STEP\n*QUASISTATIC\n0.5, 0.5\n"
                   "*FRICTION, CONTACT=F, LAW=COULOMB\n0.2\n"
                   "*DSLOAD\nRIGHT, TY, \"2+0*t\"\nLEFT, TY, \"-2-0*t\"\n"
                   "*END STEP\n");
  char *json = job_file(&j, "json"), *at = json;
  double rate = 0.0, before = 0.0;
  check_slip(&j, 5, 2.5, 0.2);
  while ((at = strstr(at, "\"contraction\": ")) != NULL) {
    before = rate;
    rate = atof(at += strlen("\"contraction\": "));
  }
  ck_assert_double_gt(before, 0.0);
  ck_assert_double_eq_tol(rate, 2.0 * before, 0.1 * before);
  free(json);
}

/* No friction on the left half: each node has its own limit. */
TEST(mu_is_zero_in_places) {
  JOB j = run_drag(
      "*FRICTION, CONTACT=F, LAW=COULOMB\n"
      "\"if(x < 0.4, 0, 0.3)\"\n",
      "3*x*x", "*END STEP\n");
  DAT c = job_table(&j, "CONTACT", -1);
  for (int i = 0; i < c.n_row; ++i) {
    double mu = dat_at(&c, i, "x") < 0.4 ? 0.0 : 0.3;
    ck_assert_double_eq(dat_at(&c, i, "status"), 1.0);
    ck_assert_double_gt(dat_at(&c, i, "f_n"), 0.0);
    ck_assert_double_eq_tol(dat_at(&c, i, "f_t"), -mu * dat_at(&c, i, "f_n"),
                            1e-9);
  }
}

/* Two groups on one floor, each with its own mu: both slip, the resultants
 * tell. */
TEST(mu_by_group) {
  JOB j = job_begin("groups");
  job_write(&j, "groups.geo",
            "h = 0.25;\nPoint(1)={0,0,0,h};Point(2)={.5,0,0,h};"
            "Point(3)={1,0,0,h};Point(4)={1,1,0,h};Point(5)={0,1,0,h};"
            "Line(1)={1,2};Line(2)={2,3};Line(3)={3,4};Line(4)={4,5};"
            "Line(5)={5,1};\nCurve Loop(1)={1:5};Plane Surface(1)={1};"
            "Physical Surface(\"BODY\")={1};Physical Curve(\"ICE\")={1};"
            "Physical Curve(\"RUBBER\")={2};Physical Curve(\"TOP\")={4};\n");
  job_write(&j, "groups.inp",
            "*MESH, FILE=groups.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
            "*CONTACT, NAME=A, GROUP=ICE, OBSTACLE=O\n"
            "*CONTACT, NAME=B, GROUP=RUBBER, OBSTACLE=O\n"
            "*FRICTION, CONTACT=A, LAW=COULOMB\n0.05\n"
            "*FRICTION, CONTACT=B, LAW=COULOMB\n0.7\n*STEP\n*QUASISTATIC\n"
            "0.5, 1.\n*BOUNDARY\nTOP, 2, 2, -0.01\nTOP, 1, 1, 0.1\n"
            "*PRINT, TOTALS\n*END STEP\n*STEP\n*QUASISTATIC\n1., 1.\n"
            "*FRICTION, CONTACT=B, LAW=COULOMB\n0.6\n"
            "*BOUNDARY\nTOP, 1, 1, 0.2\n*END STEP\n");
  ck_assert_int_eq(job_run(&j, ""), 0);
  ck_assert(job_tells(&j, "  mu of contact B jumps at t = 1 from 0.7 to 0.6"));
  ck_assert(!job_tells(&j, "contact A jumps"));
  DAT t = job_table(&j, "TOTALS", -1);
  for (int k = 0; k < 2; ++k) {
    ck_assert_double_gt(dat_at(&t, k, "normal"), 1.0);
    ck_assert_double_eq_tol(dat_at(&t, k, "tangential"),
                            -(k == 0 ? 0.05 : 0.6) * dat_at(&t, k, "normal"),
                            1e-9);
  }
}

/*
 * The top turns at 0.56, between the times that the increments and their halves
 * try, and comes to rest at 0.97 of its way; by expression, by a table, with
 * the obstacle in its place, with both on their way (obstacles count the first
 * step too), from the start of the step.
 */
#define WAY(name, course) "*AMPLITUDE, NAME=" name "\n" course "\n"
static const struct {
  const char *courses, *top, *floor;
} turning[] = {
    {WAY("W", "\"0.1*min(9*t, max(t*(1.12-t)/0.3136, 0.97))\""), "W", NULL},
    {WAY("W", "0., 0., 0.559, 0.097, 0.56, 0.1, 0.561, 0.097"), "W", NULL},
    {WAY("W", "1., 0., 1.5, -0.0985, 1.56, -0.1, 1.62, -0.097"), NULL, "W"},
    {WAY("W", "\"0.2*t\"") WAY(
         "V",
         "\"0.2*(t-1)-0.1*min(9*(t-1), max((t-1)*(2.12-t)/0.3136, 0.97))\""),
     "W", "V"},
    {WAY("W", "0., 0.1, 0.1, 0.097"), "W", NULL},
    {WAY("W", "\"if(t<0.5|t>0.75, 0.1*t, 0.05+0.01*sin(300*(t-0.5)))\""), "W",
     NULL}};
enum { TREMBLING = sizeof turning / sizeof *turning - 1 };

static job run_turning(int k, const char *increment, const char *time) {
  const char *top = turning[k].top, *floor = turning[k].floor;
  char of_top[80] = "*BOUNDARY\nTOP, 1, 1\n";
  job j = job_begin("turning");
  job_copy(&j, "tests/regression/mesh/square.geo");
  if (top != NULL)
    snprintf(of_top, sizeof of_top, "*BOUNDARY, AMPLITUDE=%s\nTOP, 1, 1, 1.\n",
             top);
  job_write(&j, "turning.inp",
            "*PARAMETER\nN = 4\n*MESH, FILE=square.geo\n%s*MATERIAL, NAME=M\n"
            "*ELASTIC\n1000., 0.\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=PLANE%s%s\n0., 0.\n0., 1.\n%s"
            "*CONTACT, NAME=F, GROUP=BOTTOM, OBSTACLE=O\n"
            "*FRICTION, CONTACT=F, LAW=COULOMB\n0.3\n" PRESS
            "*STEP\n*QUASISTATIC\n%s, 1.\n*ACCURACY, TIME=%s\n%s"
            "*PRINT, CONTACT, ENERGY\n*END STEP\n",
            turning[k].courses, floor != NULL ? ", AMPLITUDE=" : "",
            floor != NULL ? floor : "", floor != NULL ? "MOVE, 1., 0.\n" : "",
            increment, time, of_top);
  ck_assert_msg(job_run(&j, "--no-timing") == 0, "%s", j.errors);
  return j;
}

TEST(turn_within_an_increment_is_an_error_of_the_steps) {
  for (int k = 0; k < TREMBLING; ++k) {
    JOB a = run_turning(k, "0.25", "YES"), b = run_turning(k, "0.02", "YES");
    const double right = job_difference(&a, &b, -1),
                 told = job_told(&a, "time_error_percent");
    ck_assert_double_gt(right, 1.0);
    ck_assert_msg(told >= 0.8 * right && told <= 2 * right, "%d: %g, right %g",
                  k, told, right);
  }
}

/* Increments that the program chooses are so short that it is known. */
TEST(balanced_increments_are_as_short_as_turns_require) {
  JOB j = run_turning(TREMBLING, "1.", "BALANCED, MESH=YES");
  ck_assert(!job_tells(&j, "error of the steps: unknown"));
  ck_assert(job_tells(&j, "error of the steps: about"));
}

/* Where it turns too often nothing is told, from there on. */
TEST(turns_without_number_leave_the_error_unknown) {
  JOB j = run_turning(TREMBLING, "0.25", "YES");
  ck_assert(job_tells(&j,
                      "error of the steps: unknown, the loads turn too "
                      "often in an increment"));
  ck_assert(job_tells(&j,
                      "error of the steps: unknown, that of an increment "
                      "before is"));
}

UNIT_MAIN("friction in time")
