/*
 * Reading the result: zones with their ends between the nodes, slip distance
 * and direction, torque about an axis, loops of friction per contact.
 */
#include "support/job.h"
#include "support/unit.h"

const int job_without_fields = 1;

/* a = sqrt(4 P R / (pi E*)) of the line, cbrt(3 P R / (4 E*)) of the sphere. */
TEST(radius_of_hertz_is_found_between_the_nodes) {
  const double pi = acos(-1.0), Es = 210e3 / 0.91;
  const double line = sqrt(4 * 1000.0 * 10 / (pi * Es));
  const double ball = cbrt(3 * 1000.0 * 10 / (4 * Es));
  /* Meshes whose nodes lie elsewhere against the edge of the contact. */
  static const double part[] = {1.0, 1.013, 1.03, 1.045};
  for (int k = 0; k < 4; ++k) {
    PRINTED(words, "-D NC=24 -D A=%.17g", line * part[k]);
    JOB j = job_deck("input/hertz_line/hertz_block", words);
    DAT z = job_table(&j, "ZONES", -1);
    ck_assert_int_eq(z.n_row, 2);
    int closed = dat_zone(&z, 1);
    ck_assert_double_eq_tol(dat_at(&z, closed, "x_from"), 0.0, 1e-12);
    ck_assert_double_eq_tol(dat_at(&z, closed, "x_to"), line, 0.2 * line / 24);
    ck_assert_double_eq_tol(dat_at(&z, closed, "extent"),
                            dat_at(&z, closed, "area"), 1e-12);
  }
  job j = job_deck("input/hertz_sphere/hertz_sphere", "-D NC=24");
  dat z = job_table(&j, "ZONES", -1);
  double r = dat_at(&z, dat_zone(&z, 1), "r_to");
  ck_assert_double_eq_tol(r, ball, 0.3 * ball / 24);
  ck_assert_double_eq_tol(dat_at(&z, dat_zone(&z, 1), "area"), pi * r * r,
                          3e-3 * r * r);
  dat_free(&z);
  job_end(&j);
  j = job_deck("input/hertz_sphere/hertz_sphere_3d", "");
  z = job_table(&j, "ZONES", -1);
  ck_assert_int_eq(z.n_row, 3);
  double area = pi * ball * ball / 4;
  ck_assert_double_eq_tol(dat_at(&z, dat_zone(&z, 1), "area"), area,
                          0.03 * area);
  ck_assert_double_eq(dat_at(&z, dat_zone(&z, 2), "area"), 0.0);
  dat_free(&z);
  job_end(&j);
}

/* Square of the side 1 with the foot on a plane that moves by "way" along x,
 * pressed by p = 1, glued to its head; and what follows *STEP. */
static job run_square(const char *shape, const char *pair, double mu,
                      const char *step) {
  job j =
      job_with("square", "tests/regression/mesh/square.geo",
               "*PARAMETER\nN = 6\n*MESH, FILE=square.geo\n*MATERIAL, NAME=M\n"
               "*ELASTIC\n1000., 0.\n*SOLID SECTION, ELSET=BODY, MATERIAL=M, "
               "THICKNESS=2\n*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\n%s"
               "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n%s"
               "*FRICTION, CONTACT=C, LAW=COULOMB\n%.17g\n"
               "*STEP\n*STATIC\n1E-9\n*BOUNDARY\nTOP, 1, 1\nTOP, 2, 2, -0.001\n"
               "*END STEP\n*STEP\n%s*PRINT, CONTACT, TOTALS, ZONES, LOOP\n"
               "*END STEP\n",
               shape, pair, mu, step);
  CK_EXIT(job_run(&j, ""), 0, j);
  return j;
}

/* Nothing slips: one zone over the whole foot, twice as large as long for the
 * thickness 2. */
TEST(one_zone_reaches_from_end_to_end) {
  JOB j = run_square("", "", 1.0, "*QUASISTATIC\n1., 1.\n");
  DAT z = job_table(&j, "ZONES", -1);
  ck_assert_int_eq(z.n_row, 1);
  ck_assert_double_eq(dat_at(&z, 0, "zone"), 2.0);
  ck_assert_double_eq_tol(dat_at(&z, 0, "x_from"), 0.0, 1e-14);
  ck_assert_double_eq_tol(dat_at(&z, 0, "x_to"), 1.0, 1e-14);
  ck_assert_double_eq_tol(dat_at(&z, 0, "extent"), 1.0, 1e-14);
  ck_assert_double_eq_tol(dat_at(&z, 0, "area"), 2.0, 1e-14);
}

/*
 * A belt runs to 0.5, back to -0.5, and again: every node slips along with
 * it, mu p = 0.1, once the block has sheared by at most 0.01. Slip distance is
 * the way less the shearing; heat is force times slip.
 */
TEST(belt_gives_slip_distance_direction_torque_and_loop) {
  job j = run_square("MOVE, \"0.5*(t<1)*t + 0.5*(t>=1)*(2-t)\", 0.\n",
                     "AXIS, 0.25, 2.\n", 0.1, "*QUASISTATIC\n0.05, 3.\n");
  const double N = 2.0, T = 0.2;
  dat c = job_table(&j, "CONTACT", 19), l = job_table(&j, "LOOP", 19);
  DAT t = job_table(&j, "TOTALS", 19), z = job_table(&j, "ZONES", 19);
  double mean = 0.0;
  ck_assert_int_eq(z.n_row, 1);
  for (int i = 0; i < c.n_row; ++i) {
    double u = dat_at(&c, i, "u_t");
    ck_assert_double_eq(dat_at(&c, i, "status"), 1.0);
    ck_assert_double_gt(dat_at(&z, 0, "direction") * dat_at(&c, i, "slip"), 0);
    ck_assert_double_eq_tol(dat_at(&c, i, "slip_distance"), 0.5 - u, 1e-8);
    ck_assert_double_eq(dat_at(&c, i, "slip_dir_x"), -1.0);
    ck_assert_double_eq(dat_at(&c, i, "slip_dir_y"), 0.0);
    mean += u * dat_at(&c, i, "f_n") / N;
  }
  double torque = 0.0;
  for (int i = 0; i < c.n_row; ++i)
    torque += 2.0 * dat_at(&c, i, "f_x") +
              (dat_at(&c, i, "x") - 0.25) * dat_at(&c, i, "f_y");
  ck_assert_double_eq_tol(dat_at(&t, 0, "normal"), N, 1e-8);
  ck_assert_double_eq_tol(dat_at(&t, 0, "torque"), torque, 1e-9);
  ck_assert_double_eq_tol(dat_at(&l, 0, "tangential"), T, 1e-9);
  ck_assert_double_eq_tol(dat_at(&l, 0, "way"), 0.5, 1e-9);
  ck_assert_double_eq_tol(dat_at(&l, 0, "loop_area"), T * (0.5 - mean), 1e-6);
  dat_free(&c);
  dat_free(&l);
  /* Back: the force has turned; all the way has become heat but for the
   * shearing to and fro. */
  l = job_table(&j, "LOOP", -1);
  ck_assert_double_eq_tol(dat_at(&l, 0, "tangential"), -T, 1e-9);
  ck_assert_double_eq_tol(dat_at(&l, 0, "way"), -0.5, 1e-9);
  ck_assert_double_eq_tol(dat_at(&l, 0, "loop_area"), T * (1.5 - 3 * mean),
                          1e-6);
  dat_free(&l);
  job_end(&j);
}

/*
 * A disc in a bore of its own size, pulled down, or to its first node: it
 * touches there and is open on the other side; it sticks in a smaller bore. The
 * contact line is a ring; its zones follow each other, each begins where the
 * one before ends, and add up to the polygon of 64 sides.
 */
static void check_ring(const char *on, const char *pull, const char *across) {
  JOB j = job_begin("ring");
  job_write(&j, "ring.geo",
            "Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {-1, 0, 0};"
            "Circle(1) = {2, 1, 3}; Circle(2) = {3, 1, 2};\n"
            "Curve Loop(1) = {1, 2}; Plane Surface(1) = {1};\n"
            "Point{1} In Surface{1}; Transfinite Curve{1, 2} = 33;\n"
            "Mesh.MeshSizeMax = 0.2;\n"
            "Physical Curve(\"RIM\") = {1, 2}; Physical Point(\"HUB\") = {1};\n"
            "Physical Surface(\"BODY\") = {1};\n");
  job_write(&j, "ring.inp",
            "*MESH, FILE=ring.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=%s\n"
            "*CONTACT, NAME=C, GROUP=RIM, OBSTACLE=O\n"
            "*FRICTION, CONTACT=C, LAW=COULOMB\n0.2\n*STEP\n*STATIC\n"
            "*BOUNDARY\nHUB, %s\n*DLOAD\nBODY, %s\n*PRINT, ZONES\n*END STEP\n",
            on, across, pull);
  CK_EXIT(job_run(&j, ""), 0, j);
  DAT z = job_table(&j, "ZONES", -1);
  ck_assert(on[0] == 'G' ? z.n_row == 1 : z.n_row >= 3);
  for (int i = 0; i < z.n_row; ++i) {
    int next = (i + 1) % z.n_row;
    ck_assert_double_eq_tol(dat_at(&z, i, "x_to"), dat_at(&z, next, "x_from"),
                            1e-12);
    ck_assert_double_eq_tol(dat_at(&z, i, "y_to"), dat_at(&z, next, "y_from"),
                            1e-12);
    ck_assert(i == next || dat_at(&z, i, "zone") != dat_at(&z, next, "zone") ||
              dat_at(&z, i, "direction") != dat_at(&z, next, "direction"));
    if (dat_at(&z, i, "zone") == 0.0)
      ck_assert_double_lt(
          across[0] == '1' ? -dat_at(&z, i, "y_from") : dat_at(&z, i, "x_from"),
          0.5);
  }
  ck_assert_double_eq_tol(dat_sum(&z, "extent"), 128 * sin(acos(-1.0) / 64),
                          1e-9);
}

TEST(zones_of_a_ring_close) {
  check_ring("CONFORMING", "BY, -10.", "1");
  check_ring("CONFORMING", "BX, 10.", "2");
  check_ring("GAP\n-0.01", "BX, 0.1", "2");
}

/* Nothing slips: the zone of stick ends where the contact does, though the
 * limit that is left grows towards the edge. Under an even pressure the square
 * of a limit that ends at x = 0.65 is linear, and so its zone is exact. */
TEST(stick_ends_where_the_contact_or_the_limit_does) {
  static const char *const gap[] = {"0.01*(x - 0.6)", "-0.001"};
  static const char *const mu[] = {"1 + 9*x", "sqrt(max(0, 0.65 - x))"};
  for (int k = 0; k < 2; ++k) {
    JOB j = job_with(
        "cube", "tests/regression/mesh/cube.geo",
        "*MESH, FILE=cube.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n"
        "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
        "*OBSTACLE, NAME=O, TYPE=GAP\n\"%s\"\n"
        "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
        "*FRICTION, CONTACT=C, LAW=COULOMB\n\"%s\"\n*STEP\n*STATIC\n"
        "*BOUNDARY\nTOP, 1, 3\n*PRINT, ZONES\n*END STEP\n",
        gap[k], mu[k]);
    CK_EXIT(job_run(&j, ""), 0, j);
    DAT z = job_table(&j, "ZONES", -1);
    double slip = dat_at(&z, dat_zone(&z, 1), "area");
    double stick = dat_at(&z, dat_zone(&z, 2), "area");
    ck_assert_double_eq_tol(slip, k == 0 ? 0 : 0.35, 1e-12);
    ck_assert_double_eq_tol(stick, k == 0 ? stick : 0.65, 1e-12);
    ck_assert_double_gt(stick, 0.25);
  }
}

/* The same in the plane, towards both ends of the line. */
TESTS(stick_ends_at_either_side, 2) {
  JOB j = job_with(
      "square", "tests/regression/mesh/square.geo",
      "*PARAMETER\nN = 8\nKIND = 1\n*MESH, FILE=square.geo\n"
      "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n"
      "*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=CPE3\n"
      "*OBSTACLE, NAME=O, TYPE=GAP\n-0.001\n"
      "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
      "*FRICTION, CONTACT=C, LAW=COULOMB\n\"sqrt(max(0, %s))\"\n"
      "*STEP\n*STATIC\n*BOUNDARY\nTOP, 1, 2\n*PRINT, ZONES\n*END STEP\n",
      _i == 0 ? "0.65 - x" : "x - 0.35");
  CK_EXIT(job_run(&j, ""), 0, j);
  DAT z = job_table(&j, "ZONES", -1);
  const int stick = dat_zone(&z, 2);
  ck_assert_double_eq_tol(dat_at(&z, stick, "extent"), 0.65, 1e-12);
  ck_assert_double_eq_tol(dat_at(&z, stick, _i == 0 ? "x_to" : "x_from"),
                          _i == 0 ? 0.65 : 0.35, 1e-12);
}

UNIT_MAIN("zones")
