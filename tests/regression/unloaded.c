/*
 * Bodies whose load has ended, or that their floor has left: they stay where
 * they were, without forces, by every method.
 */
#include "support/job.h"
#include "support/unit.h"

const int job_without_fields = 1;

typedef struct lid {
  const char *mesh; /* square.geo, cube.geo */
  const char *method;
  double E;
} lid;

/* Ends with the lid above the body: its displacement of node 1 into u[3]. */
static void run_lid(const lid *s, double u[3]) {
  const int space = strcmp(s->mesh, "cube.geo") == 0;
  const char *zero = space ? "0., 0., " : "0., ";
  JOB j = job_begin("lid");
  PRINTED(path, "tests/regression/mesh/%s", s->mesh);
  job_copy(&j, path);
  job_write(&j, "lid.inp",
            "*PARAMETER\nN = 3\n*MESH, FILE=%s\n*MATERIAL, NAME=M\n*ELASTIC\n"
            "%g, 0.3\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=PLANE\n%s0.\n%s1.\n"
            "*OBSTACLE, NAME=LID, TYPE=PLANE\n%s1.\n%s-1.\n"
            "MOVE, %s\"-0.01*(if(t < 1, t, 2 - t)) + 0.005*max(0, t - 1)\"\n"
            "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
            "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n"
            "*CONTACT, NAME=L, GROUP=TOP, OBSTACLE=LID\n"
            "*FRICTION, CONTACT=L, LAW=COULOMB\n0.3\n"
            "*STEP\n*QUASISTATIC\n0.5, 1.\n*SOLVER, METHOD=%s\n*END "
            "STEP\n*STEP\n*QUASISTATIC\n"
            "0.5, 1.\n*PRINT, NODES, TOTALS, FREQUENCY=0\n*END STEP\n",
            s->mesh, s->E, zero, zero, zero, zero, zero, s->method);
  int code = job_run(&j, "");
  ck_assert_msg(code == 0, "E = %g, %s: exit %d: %s", s->E, s->method, code,
                j.errors);
  DAT d = job_table(&j, "NODES", -1);
  for (int c = 0; c < 2 + space; ++c)
    u[c] = dat_at(&d, 0, ((const char *[]){"u_x", "u_y", "u_z"})[c]);
}

/* Its place is that where it was left, on the floor: motions are given alone,
 * so it depends neither on the modulus nor on the method. */
TEST(body_that_is_left_stays_where_it_was) {
  static const char *const methods[] = {"AUTO", "NEWTON", "LEMKE", "SOR",
                                        "PROXIMAL"};
  static const double E[] = {1.0, 3.0, 2e5};
  for (int space = 0; space < 2; ++space) {
    double first[3] = {0}, u[3];
    for (int k = 0; k < (space ? 3 : 7); ++k) {
      const lid s = {space ? "cube.geo" : "square.geo",
                     methods[k < 3 ? 0 : k - 2], E[k % 3]};
      run_lid(&s, u);
      if (k == 0) memcpy(first, u, sizeof u);
      for (int c = 0; c < 2 + space; ++c) {
        ck_assert_msg(fabs(u[c]) < 1e-4, "%s, E = %g, %s: u[%d] = %g", s.mesh,
                      s.E, s.method, c, u[c]);
        ck_assert_msg(fabs(u[c] - first[c]) < 1e-8, "%s, E = %g, %s: u[%d]",
                      s.mesh, s.E, s.method, c);
      }
    }
  }
}

typedef struct squeezed {
  int n;
  const char *nu, *mu[2], *dt, *down; /* of the lid, over t */
  const char *form;
} squeezed;

/* Between a floor and a lid that moves along it too by "along"; u[2] of node
 * 1. 1: all errors of the solver have a bound, as rounding has that is left
 * without forces. */
static int run_squeezed(const squeezed *s, double along, const char *method,
                        double u[2]) {
  JOB j = job_with("squeezed", "tests/regression/mesh/square.geo",
                   "*PARAMETER\nN = %d\n*MESH, FILE=square.geo\n"
                   "*MATERIAL, NAME=M\n*ELASTIC\n1., %s\n"
                   "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
                   "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\n"
                   "*OBSTACLE, NAME=LID, TYPE=PLANE\n0., 1.\n0., -1.\n"
                   "MOVE, \"%g*t\", \"-0.01*%s\"\n"
                   "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
                   "*FRICTION, CONTACT=C, LAW=COULOMB\n%s\n"
                   "*CONTACT, NAME=L, GROUP=TOP, OBSTACLE=LID\n"
                   "*FRICTION, CONTACT=L, LAW=COULOMB\n%s\n"
                   "*STEP\n*QUASISTATIC, FORM=%s\n%s, 1.\n*SOLVER, METHOD=%s\n"
                   "*PRINT, NODES\n*END STEP\n",
                   s->n, s->nu, along, s->down, s->mu[0], s->mu[1], s->form,
                   s->dt, method);
  int code = job_run(&j, "");
  ck_assert_msg(code == 0, "%s: exit %d: %s", method, code, j.errors);
  DAT d = job_table(&j, "NODES", -1);
  for (int c = 0; c < 2; ++c)
    u[c] = dat_at(&d, 0, ((const char *[]){"u_x", "u_y"})[c]);
  FREED char *lst = job_file(&j, "lst");
  return strstr(lst, "no bound") == NULL;
}

/* What the tolerance leaves at all nodes of a body that its lid leaves may be
 * the force of one. */
TESTS(squeezed_body_is_left_by_sweeps_as_by_others, 8) {
  static const squeezed cases[] = {
      {2, "0.499", {"0.1", "1."}, "0.5", "sin(4*t)", "DISPLACEMENT"},
      {4, "0.3", {"0.3", "0.1"}, "0.2", "sin(4*t)", "DISPLACEMENT"},
      {12, "0.3", {"0.3", "0.1"}, "0.5", "sin(4*t)", "DISPLACEMENT"},
      {12, "0.3", {"0.1", "1."}, "0.2", "sin(4*t)", "DISPLACEMENT"}};
  static const char *const methods[] = {"SOR", "AITKEN"};
  const squeezed *s = &cases[_i / 2];
  double first[2], u[2];
  run_squeezed(s, 0.01 * (_i % 2), "AUTO", first);
  for (int k = 0; k < 2; ++k) {
    ck_assert_int_eq(run_squeezed(s, 0.01 * (_i % 2), methods[k], u), 1);
    for (int c = 0; c < 2; ++c)
      ck_assert_msg(fabs(u[c] - first[c]) < 1e-9, "%s: u[%d] = %g, %g",
                    methods[k], c, u[c], first[c]);
  }
}

/* The velocity form solves for the forces that the increment takes away. */
TESTS(squeezed_body_is_left_in_the_velocity_form, 2) {
  static const char *const methods[] = {"SOR",    "AITKEN",   "PCG",
                                        "AUGLAG", "LAGRANGE", "PROXIMAL"};
  const squeezed s = {2,     "0.3",      {_i == 0 ? "0." : "0.3", "0.2"},
                      "0.5", "sin(4*t)", "VELOCITY"};
  double first[2], u[2];
  run_squeezed(&s, 0.0, "AUTO", first);
  for (int k = 0; k < 6; ++k) {
    run_squeezed(&s, 0.0, methods[k], u);
    for (int c = 0; c < 2; ++c)
      ck_assert_msg(fabs(u[c] - first[c]) < 1e-8, "%s: u[%d] = %g, %g",
                    methods[k], c, u[c], first[c]);
  }
}

/* Even where the tolerance times their number is the whole force. */
TEST(body_still_squeezed_is_held_to_any_tolerance) {
  const squeezed s = {40, "0.3", {"0.3", "0.1"}, "0.2", "t", "DISPLACEMENT"};
  double fine[2], coarse[2];
  run_squeezed(&s, 0.01, "AUTO", fine);
  run_squeezed(&s, 0.01, "AUTO, TOL=1E-2", coarse);
  for (int c = 0; c < 2; ++c) ck_assert_double_eq_tol(coarse[c], fine[c], 1e-4);
}

/* So it is where a floor has lifted it and sinks back to its first place. */
TESTS(body_that_a_floor_has_lifted_stays, 7) {
  static const char *const methods[] = {"AUTO",     "NEWTON",   "SOR",   "PCG",
                                        "LAGRANGE", "PROXIMAL", "AUGLAG"};
  JOB j =
      job_with("lifted", "tests/regression/mesh/square.geo",
               "*MESH, FILE=square.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1., 0.3\n"
               "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
               "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\n"
               "MOVE, 0., \"0.1*sin(pi*t)\"\n"
               "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
               "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n"
               "*STEP\n*QUASISTATIC\n0.25, 1.\n*SOLVER, METHOD=%s\n"
               "*PRINT, NODES\n*END STEP\n",
               methods[_i]);
  ck_assert_msg(job_run(&j, "--quiet") == 0, "%s: %s", methods[_i], j.errors);
  DAT d = job_table(&j, "NODES", -1);
  for (int i = 0; i < d.n_row; ++i)
    ck_assert_double_eq_tol(dat_at(&d, i, "u_y"), 0.1, 1e-12);
}

/* Of a body that has been unloaded A u is rounding: no load on the next
 * increment. */
TESTS(unloaded_body_rests_in_the_velocity_form, 2) {
  JOB j = job_with(
      "rests", "tests/regression/mesh/square.geo",
      "*MESH, FILE=square.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1E3, 0.49\n"
      "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
      "*OBSTACLE, NAME=O, TYPE=PLANE\n0., %s\n0., 1.\n"
      "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
      "*FRICTION, CONTACT=C, LAW=COULOMB\n0.1\n"
      "*AMPLITUDE, NAME=A\n0., 0., 0.5, 1., 1., 0.\n"
      "*STEP\n*QUASISTATIC\n0.2, 1.\n*DSLOAD\nTOP, P, 1., A\n"
      "*END STEP\n*STEP\n*QUASISTATIC, FORM=VELOCITY\n0.2, 1.\n"
      "*DSLOAD, OP=NEW\nTOP, P, 0.\n*PRINT, TOTALS\n*END STEP\n",
      _i == 0 ? "0." : "0.001");
  ck_assert_msg(job_run(&j, "--quiet") == 0, "%s", j.errors);
}

/* Pushed out of the floor where one node is inside it: without a force, to any
 * tolerance. */
TESTS(body_pushed_out_of_its_floor_has_no_force, 6) {
  static const char *const gaps[] = {"-1E-3*(x > 0.9)", "0 - 1E-3*x^8",
                                     "0 - 27E-5*x^2"};
  JOB j =
      job_with("inside", "tests/regression/mesh/square.geo",
               "*MESH, FILE=square.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1E3, %s\n"
               "*INELASTIC, LAW=MAXWELL\n1.\n"
               "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
               "*OBSTACLE, NAME=O, TYPE=GAP\n\"%s\"\n"
               "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
               "*FRICTION, CONTACT=C, LAW=COULOMB\n0.1\n"
               "*STEP\n*VISCO, INTEGRATOR=BACKWARD\n0.5, 1.\n"
               "*BOUNDARY\nLEFT, 1\n*DSLOAD\nTOP, P, 0.3\n"
               "*SOLVER, TOL=1E-12\n*PRINT, TOTALS\n*END STEP\n",
               _i < 3 ? "0.3" : "0.49", gaps[_i % 3]);
  ck_assert_msg(job_run(&j, "--quiet") == 0, "%s", j.errors);
}

/* A load that ends 16 digits below its peak is none on a belt. */
TESTS(load_that_ends_as_rounding_is_settled, 2) {
  JOB j =
      job_with("belt", "tests/regression/mesh/square.geo",
               "*MESH, FILE=square.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1E3, 0.3\n"
               "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
               "*OBSTACLE, NAME=O, TYPE=%s\nMOVE, 0.01, 0.\n"
               "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
               "*FRICTION, CONTACT=C, LAW=COULOMB\n0.1\n"
               "*AMPLITUDE, NAME=A, TIME=TOTAL TIME\n"
               "0., 0., 0.5, 1., 1., 1E-16\n"
               "*STEP\n*QUASISTATIC\n0.25, 1.\n*DSLOAD\nTOP, P, 1., A\n"
               "*END STEP\n*STEP\n*QUASISTATIC\n0.25, 1.\n"
               "*DSLOAD, OP=NEW\nTOP, P, 0.\n*PRINT, TOTALS\n*END STEP\n",
               _i == 0 ? "CONFORMING" : "SPHERE, RADIUS=100.\n0.5, -100.");
  ck_assert_msg(job_run(&j, "--quiet") == 0, "%s", j.errors);
}

/* A load on a belt that comes and goes: every method follows the body. */
TESTS(load_that_comes_and_goes_is_settled_by_every_method, 10) {
  static const char *const methods[] = {"PCG", "LEMKE", "AUGLAG", "LAGRANGE",
                                        "PROXIMAL"};
  const int flat = _i % 2;
  JOB j = job_with(
      "goes", "tests/regression/mesh/square.geo",
      "*MESH, FILE=square.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1E3, %s\n"
      "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
      "*OBSTACLE, NAME=O, TYPE=%s\nMOVE, \"0.01*t\", 0.\n"
      "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
      "*FRICTION, CONTACT=C, LAW=COULOMB\n0.1\n"
      "*AMPLITUDE, NAME=A, TIME=TOTAL TIME\n\"sin(pi*t)\"\n"
      "*STEP\n*QUASISTATIC\n0.25, 1.\n*DSLOAD\nTOP, P, 1., A\n"
      "*SOLVER, METHOD=%s\n*PRINT, TOTALS\n*END STEP\n"
      "*STEP\n*QUASISTATIC\n0.25, 1.\n"
      "*DSLOAD, OP=NEW\nTOP, P, 0.\n*END STEP\n",
      flat ? "0." : "0.3",
      flat ? "CONFORMING" : "SPHERE, RADIUS=100\n0.5, -100.", methods[_i / 2]);
  ck_assert_msg(job_run(&j, "--quiet") == 0, "%s", j.errors);
  ck_assert_double_eq_tol(job_value(&j, "TOTALS", 2, "force_y"), sqrt(0.5),
                          1e-8);
}

/* A block on a ball that turns away under it, or pushed along, does not leave
 * it on the way to its place. */
TESTS(block_on_a_ball_is_held, 10) {
  static const struct {
    double radius, shear;
    const char *move, *law, *method;
  } cases[] = {
      {1, 0.1, "0., 0.", "TRESCA\n1.", "AUGLAG, STIFFNESS=DENSE"},
      {1, 0.1, "0., 0.", "TRESCA\n1.", "AUGLAG, STIFFNESS=FACTOR"},
      {1, 0.1, "0.1, 0.1", "COULOMB\n0.5", "AUGLAG"},
      {1, 0.4, "0., 0.", "COULOMB\n0.5", "AUGLAG, STIFFNESS=FACTOR"},
      {10, 0.01, "0.1, 0.", "COULOMB\n0.02", "PCG"},
      {10, 0.01, "0.1, 0.", "TRESCA\n0.05", "PCG, STIFFNESS=FACTOR"},
      {10, 0.01, "0.1, 0.", "TRESCA\n0.05", "LAGRANGE"},
      {10, 0.01, "0.1, 0.", "COULOMB\n0.02", "PROXIMAL"},
      {0.6, -0.1, "0.1, -0.05", "TRESCA\n0.2", "AUGLAG, STIFFNESS=DENSE"},
      {30, -0.1, "0.1, 0.", "TRESCA\n0.2", "AUGLAG, STIFFNESS=FACTOR"}};
  JOB j =
      job_with("ball", "tests/regression/mesh/square.geo",
               "*MESH, FILE=square.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1E3, 0.\n"
               "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
               "*OBSTACLE, NAME=O, TYPE=SPHERE, RADIUS=%g\n0.5, -%g\nMOVE, %s\n"
               "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
               "*FRICTION, CONTACT=C, LAW=%s\n*STEP\n*STATIC\n"
               "*DSLOAD\nTOP, P, 1.\nRIGHT, TX, %g\n*SOLVER, METHOD=%s\n"
               "*PRINT, TOTALS\n*END STEP\n",
               cases[_i].radius, cases[_i].radius, cases[_i].move,
               cases[_i].law, cases[_i].shear, cases[_i].method);
  ck_assert_msg(job_run(&j, "--quiet") == 0, "%s", j.errors);
  DAT t = job_table(&j, "TOTALS", -1);
  ck_assert_double_eq_tol(dat_at(&t, 0, "force_y"), 1.0, 1e-8);
  ck_assert_double_eq_tol(dat_at(&t, 0, "force_x"), -cases[_i].shear, 1e-8);
}

/* Forces within the tolerance of what an increment unloads hold no body that
 * its floor leaves. */
TESTS(forces_within_the_tolerance_hold_no_body, 4) {
  static const char *const tolerances[] = {"1E-10", "1E-6"};
  JOB j =
      job_with("leaves", "tests/regression/mesh/square.geo",
               "*MESH, FILE=square.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1E3, 0.3\n"
               "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
               "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
               "MOVE, 0.01, \"-0.01*t\"\n"
               "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
               "*FRICTION, CONTACT=C, LAW=COULOMB\n0.8\n"
               "*AMPLITUDE, NAME=A\n0., 0., 0.5, 1., 1., 0.\n"
               "*STEP\n*QUASISTATIC, FORM=VELOCITY\n0.5, 1.\n"
               "*BOUNDARY\nLEFT, 1\n*DSLOAD\nTOP, P, 1., A\n"
               "RIGHT, TX, 1E-4\n*SOLVER, METHOD=%s, TOL=%s\n"
               "*PRINT, CONTACT\n*END STEP\n",
               _i < 2 ? "SOR" : "AITKEN", tolerances[_i % 2]);
  ck_assert_msg(job_run(&j, "--quiet") == 0, "%s", j.errors);
  DAT c = job_table(&j, "CONTACT", -1);
  for (int i = 0; i < c.n_row; ++i)
    ck_assert_double_eq_tol(dat_at(&c, i, "gap"), 4.470e-3, 1e-5);
}

/* 0.3 - 0.1*3 is -5.6e-17: no load lifts the body, in this step or the next. */
TESTS(load_that_is_zero_but_for_rounding_lifts_nothing, 12) {
  static const char *const methods[] = {"AUTO", "LEMKE", "SOR"};
  static const char *const courses[] = {"0.3 - 0.1*t", "1 - t*(0.1 + 0.2)/0.9"};
  JOB j =
      job_with("ended", "tests/regression/mesh/square.geo",
               "*MESH, FILE=square.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1E3, 0.3\n"
               "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
               "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
               "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n%s"
               "*AMPLITUDE, NAME=A, TIME=TOTAL TIME\n\"%s\"\n"
               "*STEP\n*QUASISTATIC\n1., 3.\n*BOUNDARY\nLEFT, 1\n"
               "*DSLOAD\nTOP, P, 1., A\n*SOLVER, METHOD=%s\n*END STEP\n"
               "*STEP\n*QUASISTATIC\n0.5, 1.\n*DSLOAD, OP=NEW\nTOP, P, 0.\n"
               "*PRINT, TOTALS\n*END STEP\n",
               _i % 2 == 0 ? "" : "*FRICTION, CONTACT=C, LAW=COULOMB\n0.1\n",
               courses[_i / 2 % 2], methods[_i / 4]);
  ck_assert_msg(job_run(&j, "--quiet") == 0, "%s", j.errors);
}

/* Near incompressibility a body that is led along above its floor creeps by
 * rounding, more with each increment: it is no error of the solver. */
TEST(body_led_along_has_no_error_of_its_rounding) {
  JOB j =
      job_with("led", "tests/regression/mesh/square.geo",
               "*PARAMETER\nN = 6\n*MESH, FILE=square.geo\n"
               "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.4999999\n"
               "*INELASTIC, LAW=MAXWELL, TYPE=DEVIATORIC\n1.\n"
               "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
               "*OBSTACLE, NAME=O, TYPE=PLANE\n0., -0.5\n0., 1.\n"
               "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
               "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n"
               "*STEP\n*VISCO, INTEGRATOR=THETA, THETA=0.8\n0.05, 4.\n"
               "*BOUNDARY\nTOP, 1, 1, \"1.3*sin(t)\"\nTOP, 2, 2, \"0.7*t\"\n"
               "*END STEP\n");
  CK_EXIT(job_run(&j, ""), 0, j);
}

UNIT_MAIN("unloaded")
