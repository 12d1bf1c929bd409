/*
 * Given normal forces (*CONTACT FORCE; CPR98, problem D3) by every method, in
 * both forms, against closed forms and against unilateral contact.
 *
 * Block of unit height, nu = 0, E = 1000, G = 500, held at the top at u_y = 0
 * and u_x = U; p pushes from below: u_y = p (1 - y) / E, and the foot is at
 * U - mu p / G where it slips (the sides carry mu p), at 0 where it sticks.
 */
#include "solver/solver.h"
#include "support/job.h"
#include "support/unit.h"

const int job_without_fields = 1;

static job run_block(const char *cards, const char *step, const char *method) {
  job j = job_with(
      "block", "tests/regression/mesh/square.geo",
      "*PARAMETER\nN = 4\n*MESH, FILE=square.geo\n*MATERIAL, NAME=M\n"
      "*ELASTIC\n1000., 0.\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
      "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
      "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n%s*STEP\n%s"
      "*SOLVER, METHOD=%s\n*PRINT, CONTACT, NODES, ENERGY\n*END STEP\n",
      cards, step, method);
  int code = job_run(&j, "");
  ck_assert_msg(code == 0, "%s: exit %d: %s", method, code, j.errors);
  return j;
}

/* Each node of block k: pressure p, shear traction and place of the foot. */
static void check_foot(const job *j, int k, double p, double shear, double u_t,
                       const char *what) {
  DAT c = job_table(j, "CONTACT", k), e = job_table(j, "ENERGY", k);
  for (int i = 0; i < c.n_row; ++i) {
    double miss[] = {dat_at(&c, i, "pressure") - p,
                     dat_at(&c, i, "traction_t") + shear,
                     1000 * (dat_at(&c, i, "u_n") + p / 1000),
                     1000 * (dat_at(&c, i, "gap") - p / 1000),
                     1000 * (dat_at(&c, i, "u_t") - u_t)};
    for (int a = 0; a < 5; ++a)
      ck_assert_msg(fabs(miss[a]) < 1e-6,
                    "%s, block %d, row %d: value %d off "
                    "by %g",
                    what, k, i, a, miss[a]);
  }
  ck_assert_double_le(fabs(dat_at(&e, 0, "energy_defect_relative")), 1e-10);
}

#define DRAG(u, tau)                                                    \
  "*BOUNDARY\nTOP, 2\nTOP, 1, 1, \"" u "\"\n*DSLOAD\nRIGHT, TY, \"" tau \
  "\"\nLEFT, TY, \"-(" tau ")\"\n"

/* p(t) = 10 t by expression, amplitude, table. Static at t = 1 and in
 * increments, both forms. Coulomb with mu = 0.3, Tresca with g = 3 t, an
 * average of what is uniform: slip. */
TEST(slip_under_a_given_force_by_every_method) {
  static const char *const cards[] = {
      "*CONTACT FORCE, CONTACT=C\n\"10*t\"\n"
      "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n",
      "*AMPLITUDE, NAME=A\n0., 0., 1., 1.\n"
      "*CONTACT FORCE, CONTACT=C, AMPLITUDE=A\n10.\n"
      "*FRICTION, CONTACT=C, LAW=TRESCA\n\"3*t\"\n",
      "*CONTACT FORCE, CONTACT=C, TABLE=T\n0., 0., 1., 10.\n"
      "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n",
      "*CONTACT FORCE, CONTACT=C\n\"10*t\"\n*FRICTION, CONTACT=C, "
      "LAW=NONLOCAL, RADIUS=0.6, EDGE=NORMALIZED\n0.3\n"};
  static const char *const procedures[] = {
      "*STATIC\n" DRAG("0.01*t", "3*t"),
      "*QUASISTATIC\n0.5, 1.\n" DRAG("0.01*t", "3*t"),
      "*QUASISTATIC, FORM=VELOCITY\n0.5, 1.\n" DRAG("0.01*t", "3*t")};
  for (int k = 0; solver_list[k] != NULL; ++k) {
    const char *method = solver_list[k]->name;
    JOB j = run_block(cards[k % 4], procedures[(k + k / 3) % 3], method);
    check_foot(&j, -1, 10, 3, 0.01 - 0.006, method);
  }
  for (int k = 0; k < 12; ++k) {
    JOB j = run_block(cards[k / 3], procedures[k % 3], "AUTO");
    check_foot(&j, -1, 10, 3, 0.01 - 0.006, "AUTO");
    if (k % 3 > 0) check_foot(&j, 0, 5, 1.5, 0.005 - 0.003, "AUTO");
  }
}

/* The same push is below mu p: the foot stays where it is. */
TEST(stick_under_a_given_force) {
  for (int k = 0; solver_list[k] != NULL; ++k) {
    const char *method = solver_list[k]->name;
    JOB j = run_block(
        "*CONTACT FORCE, CONTACT=C\n10.\n"
        "*FRICTION, CONTACT=C, LAW=COULOMB\n0.6\n",
        "*QUASISTATIC\n1., 1.\n" DRAG("0.01*t", "5*t"), method);
    check_foot(&j, -1, 10, 5, 0, method);
  }
}

/* No friction: the force alone, the foot follows the top. */
TEST(given_force_without_friction) {
  JOB j = run_block("*CONTACT FORCE, CONTACT=C\n10.\n",
                    "*STATIC\n" DRAG("0.01*t", "0"), "AUTO");
  check_foot(&j, -1, 10, 0, 0.01, "frictionless");
}

/*
 * Pressures of a unilateral problem with friction, all nodes closed, put back
 * as given forces give the same displacements: D3 with F_N = R_N of N2, for a
 * material that couples both directions.
 */
TEST(pressures_of_contact_given_back) {
  static const char deck[] =
      "*PARAMETER\nN = 8\n*MESH, FILE=square.geo\n*MATERIAL, NAME=M\n"
      "*ELASTIC\n1000., 0.3\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
      "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
      "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
      "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n%s"
      "*STEP\n*QUASISTATIC\n1., 1.\n*BOUNDARY\nTOP, 1, 1, 2.E-3\n"
      "TOP, 2, 2, -0.01\n*PRINT, CONTACT, NODES\n*END STEP\n";
  char cards[4000] = "*CONTACT FORCE, CONTACT=C, TABLE=X\n";
  JOB a = job_begin("free"), b = job_begin("given");
  job_copy(&a, "tests/regression/mesh/square.geo");
  job_copy(&b, "tests/regression/mesh/square.geo");
  job_write(&a, "free.inp", deck, "");
  ck_assert_int_eq(job_run(&a, ""), 0);
  DAT c = job_table(&a, "CONTACT", -1);
  double last = -1.0;
  for (int n = 0; n < c.n_row; ++n) { /* in the order of x                    */
    int next = -1;
    for (int i = 0; i < c.n_row; ++i)
      if (dat_at(&c, i, "x") > last &&
          (next < 0 || dat_at(&c, i, "x") < dat_at(&c, next, "x")))
        next = i;
    last = dat_at(&c, next, "x");
    ck_assert_double_gt(dat_at(&c, next, "pressure"), 0.0);
    snprintf(cards + strlen(cards), sizeof cards - strlen(cards),
             "%.17g, %.17g\n", last, dat_at(&c, next, "pressure"));
  }
  job_write(&b, "given.inp", deck, cards);
  ck_assert_int_eq(job_run(&b, ""), 0);
  DAT u = job_table(&a, "NODES", -1), v = job_table(&b, "NODES", -1);
  DAT d = job_table(&b, "CONTACT", -1);
  for (int i = 0; i < u.n_row; ++i) {
    ck_assert_double_eq_tol(dat_at(&u, i, "u_x"), dat_at(&v, i, "u_x"), 1e-10);
    ck_assert_double_eq_tol(dat_at(&u, i, "u_y"), dat_at(&v, i, "u_y"), 1e-10);
  }
  for (int i = 0; i < c.n_row; ++i) {
    ck_assert_double_eq(dat_at(&c, i, "status"), dat_at(&d, i, "status"));
    ck_assert_double_eq_tol(dat_at(&c, i, "f_t"), dat_at(&d, i, "f_t"), 1e-8);
  }
}

/* In space: the drag at 30 degrees, the friction opposite to it; each method
 * that knows three dimensions. */
TEST(slip_in_space_is_opposite_to_the_drag) {
  const double c = cos(acos(-1.0) / 6), s = 0.5;
  for (int k = 0; solver_list[k] != NULL; ++k) {
    if (!(solver_list[k]->handles & SOLVES_3D)) continue;
    JOB j =
        job_with("cube", "tests/regression/mesh/cube.geo",
                 "*PARAMETER\nN = 2\n*MESH, FILE=cube.geo\n*MATERIAL, NAME=M\n"
                 "*ELASTIC\n1000., 0.\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
                 "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
                 "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
                 "*CONTACT FORCE, CONTACT=C\n10.\n"
                 "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n*STEP\n*QUASISTATIC\n"
                 "0.5, 1.\n*BOUNDARY\nTOP, 3\nTOP, 1, 1, %.17g\n"
                 "TOP, 2, 2, %.17g\n*DSLOAD\nRIGHT, TZ, \"%.17g+0*t\"\n"
                 "LEFT, TZ, \"-%.17g+0*t\"\nBACK, TZ, \"1.5+0*t\"\n"
                 "FRONT, TZ, \"-1.5+0*t\"\n*SOLVER, METHOD=%s\n"
                 "*PRINT, CONTACT\n*END STEP\n",
                 0.1 * c, 0.1 * s, 3 * c, 3 * c, solver_list[k]->name);
    int code = job_run(&j, "");
    ck_assert_msg(code == 0, "%s: exit %d: %s", solver_list[k]->name, code,
                  j.errors);
    DAT d = job_table(&j, "CONTACT", -1);
    for (int i = 0; i < d.n_row; ++i) {
      double a = dat_at(&d, i, "u_t1"), b = dat_at(&d, i, "u_t2");
      double f1 = dat_at(&d, i, "f_t1"), f2 = dat_at(&d, i, "f_t2");
      ck_assert_double_eq_tol(hypot(a, b), 0.1 - 0.006, 1e-10);
      ck_assert_double_eq_tol(hypot(f1, f2), 0.3 * dat_at(&d, i, "f_n"), 1e-8);
      ck_assert_double_eq_tol(f1 * b - f2 * a, 0.0, 1e-10);
      ck_assert_double_eq_tol(dat_at(&d, i, "pressure"), 10, 1e-8);
    }
  }
}

static int mirrored; /* left and right are exchanged: other nodes are first */
static double from_left(double x) { return mirrored ? 1.0 - x : x; }

/* Given on the left half of the foot (JET), a contact with friction on the
 * right (FOOT). */
static job run_halves(const char *floor, const char *law) {
  job j = job_begin("halves");
  job_write(&j, "halves.geo",
            "h = 0.125;\nPoint(1)={0,0,0,h};Point(2)={.5,0,0,h};"
            "Point(3)={1,0,0,h};Point(4)={1,1,0,h};Point(5)={0,1,0,h};"
            "Line(1)={1,2};Line(2)={2,3};Line(3)={3,4};Line(4)={4,5};"
            "Line(5)={5,1};\nCurve Loop(1)={1:5};Plane Surface(1)={1};"
            "Physical Surface(\"BODY\")={1};Physical Curve(\"JET\")={%d};"
            "Physical Curve(\"FOOT\")={%d};Physical Curve(\"TOP\")={4};\n",
            mirrored ? 2 : 1, mirrored ? 1 : 2);
  job_write(&j, "halves.inp",
            "*MESH, FILE=halves.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=%s\n"
            "*CONTACT, NAME=A, GROUP=JET, OBSTACLE=O\n"
            "*CONTACT, NAME=B, GROUP=FOOT, OBSTACLE=O\n"
            "*FRICTION, CONTACT=A, LAW=COULOMB\n0.4\n"
            "*FRICTION, CONTACT=B, LAW=%s\n0.2\n"
            "*CONTACT FORCE, CONTACT=A\n\"%s\"\n*STEP\n*QUASISTATIC\n"
            "0.25, 1.\n*BOUNDARY\nTOP, 2, 2, -0.01\nTOP, 1, 1, %g\n"
            "*PRINT, CONTACT, ENERGY\n*END STEP\n",
            floor, law, mirrored ? "4-x" : "3+x", mirrored ? -0.02 : 0.02);
  ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
  return j;
}

/* Each half of block k keeps its own condition; |f_t| is checked by the limit
 * printed. How many nodes of FOOT touch. */
static int check_halves(const job *j, int k) {
  DAT c = job_table(j, "CONTACT", k), e = job_table(j, "ENERGY", k);
  int given = 0, touching = 0;
  for (int i = 0; i < c.n_row; ++i) {
    double x = from_left(dat_at(&c, i, "x")), n = dat_at(&c, i, "f_n");
    double gap = dat_at(&c, i, "gap");
    if (x < 0.51) {
      ++given;
      ck_assert_double_eq_tol(dat_at(&c, i, "pressure"), 3 + x, 1e-10);
    } else {
      ck_assert_double_ge(n, 0.0);
      ck_assert_double_ge(gap, -1e-12);
      ck_assert_double_le(n * gap, 1e-10);
      touching += n > 0;
    }
    ck_assert_double_le(fabs(dat_at(&c, i, "f_t")),
                        dat_at(&c, i, "limit") + 1e-9);
  }
  ck_assert_int_gt(given, 3);
  ck_assert_double_le(fabs(dat_at(&e, 0, "energy_defect_relative")), 1e-10);
  return touching;
}

TESTS(given_beside_unilateral, 2) {
  mirrored = _i;
  JOB j = run_halves("CONFORMING", "COULOMB");
  check_halves(&j, -1);
  DAT c = job_table(&j, "CONTACT", -1);
  for (int i = 0; i < c.n_row; ++i) {
    double mu = from_left(dat_at(&c, i, "x")) > 0.51 ? 0.2 : 0.4;
    ck_assert_double_le(fabs(dat_at(&c, i, "f_t")),
                        mu * dat_at(&c, i, "f_n") + 1e-9);
  }
}

/* The zone of friction is found by solving again: with the same gaps. No limit
 * where nothing touches. */
TESTS(given_beside_a_zone_that_grows, 2) {
  mirrored = _i;
  JOB j = run_halves("GAP\n\"0.04*(x - 0.5)^2\"",
                     "NONLOCAL, RADIUS=0.3, ZONE=CONTACT");
  int first = check_halves(&j, 0), last = check_halves(&j, -1);
  ck_assert_int_lt(first, last);
  DAT c = job_table(&j, "CONTACT", 0);
  for (int i = 0; i < c.n_row; ++i)
    ck_assert_int_eq(dat_at(&c, i, "limit") > 0.0, dat_at(&c, i, "f_n") > 0.0);
}

/* Moduli that fall to half over the increments: E = 1000 (1 - t/2). */
TEST(slip_while_the_body_softens) {
  static const char *const forms[] = {"", ", FORM=VELOCITY"};
  for (int k = 0; k < 2; ++k) {
    JOB j = job_with(
        "soft", "tests/regression/mesh/square.geo",
        "*PARAMETER\nN = 4\n*MESH, FILE=square.geo\n"
        "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0., 0.\n500., 0., 100.\n"
        "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
        "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
        "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
        "*CONTACT FORCE, CONTACT=C\n\"10*t\"\n"
        "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n"
        "*STEP\n*QUASISTATIC%s\n0.5, 1.\n" DRAG(
            "0.02*t",
            "3*t") "*TEMPERATURE\nBODY, \"100*t\"\n*PRINT, CONTACT\n*END "
                   "STEP\n",
        forms[k]);
    ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
    for (int i = 0; i < 2; ++i) {
      const double t = 0.5 * (i + 1), E = 1000 * (1 - t / 2), p = 10 * t;
      DAT c = job_table(&j, "CONTACT", i);
      for (int row = 0; row < c.n_row; ++row) {
        ck_assert_double_eq_tol(dat_at(&c, row, "u_n"), -p / E, 1e-9);
        ck_assert_double_eq_tol(dat_at(&c, row, "u_t"),
                                0.02 * t - 0.3 * p / (E / 2), 1e-9);
      }
    }
  }
}

/* Nothing but the given force and the load: the block would fly. */
TEST(unheld_body_is_refused) {
  JOB j =
      job_with("fly", "tests/regression/mesh/square.geo",
               "*PARAMETER\nN = 4\n*MESH, FILE=square.geo\n*MATERIAL, NAME=M\n"
               "*ELASTIC\n1000., 0.\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
               "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
               "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
               "*CONTACT FORCE, CONTACT=C\n10.\n*STEP\n*STATIC\n"
               "*BOUNDARY\nLEFT, 1\n*DSLOAD\nTOP, P, 9.\n*END STEP\n");
  ck_assert_int_eq(job_run(&j, ""), 6);
  ck_assert_ptr_nonnull(strstr(
      j.errors, "fly.inp:10: *CONTACT FORCE: nothing holds the body against"));
}

/* 3 of 8 * 0.375 pushes up, the load 1 down or up, and the heel can only push
 * up. */
TESTS(given_force_that_lifts_the_body_is_named, 2) {
  JOB j = job_begin("lift");
  job_write(&j, "lift.geo",
            "h = 0.25;\nPoint(1) = {0, 0, 0, h};\nPoint(2) = {0.5, 0, 0, h};\n"
            "Point(3) = {1, 0, 0, h};\nPoint(4) = {1, 1, 0, h};\n"
            "Point(5) = {0, 1, 0, h};\nLine(1) = {1, 2};\nLine(2) = {2, 3};\n"
            "Line(3) = {3, 4};\nLine(4) = {4, 5};\nLine(5) = {5, 1};\n"
            "Curve Loop(1) = {1 : 5};\nPlane Surface(1) = {1};\n"
            "Physical Curve(\"HEEL\") = {1};\nPhysical Curve(\"TOE\") = {2};\n"
            "Physical Curve(\"TOP\") = {4};\nPhysical Curve(\"LEFT\") = {5};\n"
            "Physical Surface(\"BODY\") = {1};\n");
  job_write(&j, "lift.inp",
            "*MESH, FILE=lift.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
            "*CONTACT, NAME=HEEL, GROUP=HEEL, OBSTACLE=O\n"
            "*CONTACT, NAME=TOE, GROUP=TOE, OBSTACLE=O\n"
            "*CONTACT FORCE, CONTACT=TOE\n8.\n*STEP\n*STATIC\n"
            "*BOUNDARY\nLEFT, 1\n*DSLOAD\nTOP, P, %s1.\n*END STEP\n",
            _i == 0 ? "" : "-");
  ck_assert_int_eq(job_run(&j, ""), 6);
  ck_assert_msg(strstr(j.errors, "1 at (0, 0)") != NULL &&
                    strstr(j.errors, _i == 0 ? " separate, driven by *CONTACT"
                                             : ", driven by *DSLOAD on TOP") &&
                    strstr(j.errors, "*CONTACT FORCE on TOE (line ") != NULL &&
                    strstr(j.errors, _i == 0 ? "all loads (0, 2)"
                                             : "all loads (0, 4)") != NULL,
                "%s", j.errors);
}

UNIT_MAIN("given force")
