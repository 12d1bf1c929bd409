/*
 * Decks with LAW=NONLOCAL: closed forms of the uniform pressure, the average of
 * the printed pressures summed up again, the local limit, the zone, contacts
 * apart, mu(t), and that other laws pay nothing.
 */
#include "solver/solver.h"
#include "support/job.h"
#include "support/unit.h"

const int job_without_fields = 1;

/* Block [0, 1] x [0, height] with n segments along its base, TYPE as given. */
typedef struct block {
  int n;
  double height, nu;
  const char *type, *friction; /* rest of *FRICTION with the value line      */
  const char *steps;
} block;

static job run_block_as(const block *b, const char *name) {
  job j = job_begin(name);
  PRINTED(file, "%s.inp", name);
  job_copy(&j, "tests/regression/mesh/square.geo");
  job_write(&j, file,
            "*PARAMETER\nN = %d\nLY = %g\n*MESH, FILE=square.geo\n"
            "*MATERIAL, NAME=M\n*ELASTIC\n1000., %g\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=%s\n"
            "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\n"
            "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
            "*FRICTION, CONTACT=C, %s\n%s"
            "*PRINT, CONTACT, TOTALS, ENERGY\n*END STEP\n",
            b->n, b->height, b->nu, b->type, b->friction, b->steps);
  CK_EXIT(job_run(&j, "--no-timing"), 0, j);
  return j;
}

static job run_block(const block *b) { return run_block_as(b, "block"); }

/* Pressed by 10; the base is held, so that the pressure is uniform and the
 * limit is all that friction has to say. */
#define PRESSED \
  "*STEP\n*STATIC\n*BOUNDARY\nBOTTOM, 1\nTOP, 1\n*DSLOAD\nTOP, P, 10.\n"
/* Pressed and pushed from the left: open, slipping and sticking nodes. */
#define PUSHED                                          \
  "*STEP\n*QUASISTATIC\n0.5, 1.\n*BOUNDARY\nRIGHT, 1\n" \
  "*DSLOAD\nTOP, P, 5.\nLEFT, P, 15.\n"

/* The top is moved down and aside: no method minds a body that is held. */
#define HELD                                                    \
  "*STEP\n*QUASISTATIC\n0.5, 1.\n*BOUNDARY\nTOP, 1, 1, 0.006\n" \
  "TOP, 2, 2, -0.01\n*DSLOAD\nLEFT, P, 20.\n"

/* ---- uniform pressure -------------------------------------------------- */

/* m1 of the bump is 0.33445: T/(mu p L) = 1 - m1 rho/L, and the course of the
 * limit from the edge inwards. */
TEST(uniform_pressure_has_its_closed_form) {
  static const double radius[] = {0.2, 0.1, 0.05},
                      expected[] = {0.933109200, 0.966554600, 0.983277300},
                      course[] = {0.5, 0.7027446459, 0.8770327167, 0.9839947499,
                                  1.0};
  for (int q = 0; q < 3; ++q) {
    PRINTED(friction, "LAW=NONLOCAL, RADIUS=%g\n0.3\n", radius[q]);
    block b = {160, 0.05, 0, "CPE3", friction, PRESSED};
    JOB j = run_block(&b);
    DAT d = job_table(&j, "CONTACT", -1);
    double total = dat_sum(&d, "limit") / (0.3 * 10.0);
    double h = 1.0 / b.n, error = 0.15 * h * h / radius[q];
    ck_assert_double_eq_tol(total, expected[q], error);
    for (int k = 0; k < 10; ++k) {
      double x = k < 5 ? k : 4 * (1 / radius[q]) + 5 - k;
      int row = dat_row_near(&d, "x", 0.25 * radius[q] * x);
      double limit = dat_at(&d, row, "limit"), f = dat_at(&d, row, "f_n");
      ck_assert_double_eq_tol(limit / (0.3 * f), course[k < 5 ? k : k - 5],
                              1e-6);
    }
  }
}

/* Half of the body: no edge at x = 0, the other edge as before. */
TEST(mirror_takes_the_edge_away) {
  block b = {
      40,     0.1, 0, "CPE3", "LAW=NONLOCAL, RADIUS=0.2, MIRROR_X=MIN\n0.3\n",
      PRESSED};
  JOB j = run_block(&b);
  DAT d = job_table(&j, "CONTACT", -1);
  for (int i = 0; i < d.n_row; ++i) {
    double x = dat_at(&d, i, "x");
    double W = dat_at(&d, i, "limit") / (0.3 * dat_at(&d, i, "f_n"));
    if (x < 0.79) ck_assert_double_eq_tol(W, 1.0, 1e-10);
    if (x > 0.81) ck_assert_double_lt(W, 0.9999);
    if (x == 1.0) ck_assert_double_eq_tol(W, 0.5, 1e-6);
  }
}

TEST(normalized_edges_keep_a_uniform_pressure) {
  static const char *const types[] = {"CPE3", "CAX3"};
  for (int k = 0; k < 2; ++k) {
    block b = {20,
               0.2,
               0,
               types[k],
               "LAW=NONLOCAL, RADIUS=0.3, EDGE=NORMALIZED\n0.3\n",
               PRESSED};
    JOB j = run_block(&b);
    DAT d = job_table(&j, "CONTACT", -1);
    for (int i = 0; i < d.n_row; ++i)
      ck_assert_double_eq_tol(dat_at(&d, i, "limit"),
                              0.3 * dat_at(&d, i, "f_n"), 1e-9);
  }
}

/* ---- the average of the printed pressures ------------------------------ */

static double bump(double s) {
  return fabs(s) < 1.0 ? exp(1.0 / (s * s - 1.0)) / 0.44399381616808 : 0.0;
}

static double cone(double s) { return fmax(0.0, 1.0 - fabs(s)); }

/* Integral of the kernel times the pressure linear between the nodes: nodes
 * n equal parts of [0, 1] in order of x. */
static double average_at(const double *p, int n, double x, double radius,
                         double (*kernel)(double)) {
  enum { PARTS = 40 };
  double sum = 0.0;
  for (int k = 0; k < n * PARTS; ++k) {
    double y = (k + 0.5) / (n * PARTS), s = (k % PARTS + 0.5) / PARTS;
    double value = (1 - s) * p[k / PARTS] + s * p[k / PARTS + 1];
    sum += value * kernel((x - y) / radius) / radius;
  }
  return sum / (n * PARTS);
}

/* Any pressure: the nodes slip at, or stick within, mu times that integral;
 * open ones too. The symmetric matrix differs by O(h^2) from the integral. */
static void expect_average(const char *friction, double radius,
                           double (*kernel)(double), double tolerance) {
  enum { N = 64 };
  block b = {N, 1, 0.2, "CPE3", friction, PUSHED};
  double p[N + 1], limit[N + 1], t[N + 1], top = 0.0;
  int n_open = 0;
  JOB j = run_block(&b);
  DAT d = job_table(&j, "CONTACT", -1);
  for (int i = 0; i <= N; ++i) {
    int row = dat_row_near(&d, "x", (double)i / N);
    double length = (i == 0 || i == N ? 0.5 : 1.0) / N;
    p[i] = dat_at(&d, row, "f_n") / length;
    limit[i] = dat_at(&d, row, "limit") / length;
    t[i] = dat_at(&d, row, "f_t") / length;
    n_open += dat_at(&d, row, "status") == 0;
    if (p[i] > top) top = p[i];
  }
  ck_assert_int_gt(n_open, 2);
  for (int i = 0; i <= N; ++i) {
    double expected = average_at(p, N, (double)i / N, radius, kernel);
    ck_assert_msg(fabs(limit[i] - expected) <= tolerance * top,
                  "%s node %d: %g, expected %g", friction, i, limit[i],
                  expected);
    ck_assert_double_le(fabs(t[i]), limit[i] + 1e-8 * top);
  }
}

TEST(limit_is_the_average_of_the_pressures) {
  expect_average("LAW=NONLOCAL, RADIUS=0.125\n1.\n", 0.125, bump, 6e-3);
  expect_average("LAW=NONLOCAL, RADIUS=0.25\n1.\n", 0.25, bump, 3e-3);
  expect_average("LAW=NONLOCAL, RADIUS=0.25, DISTANCE=GEODESIC\n1.\n", 0.25,
                 bump, 3e-3);
  expect_average("LAW=NONLOCAL, RADIUS=0.2, KERNEL=CONE\n1.\n", 0.2, cone,
                 3e-3);
}

/* Beyond the pressed zone friction acts on separated points; with ZONE=CONTACT
 * it does not, and the other nodes have the average as before. */
static void expect_zone(const char *steps) {
  block b = {64, 1, 0.2, "CPE3", "LAW=NONLOCAL, RADIUS=0.2\n1.\n", steps};
  JOB free_zone = run_block(&b);
  b.friction = "LAW=NONLOCAL, RADIUS=0.2, ZONE=CONTACT\n1.\n";
  JOB closed_zone = run_block_as(&b, "zone");
  DAT f = job_table(&free_zone, "CONTACT", -1);
  DAT c = job_table(&closed_zone, "CONTACT", -1);
  double separated = 0.0;
  int touching = 0;
  for (int i = 0; i < f.n_row; ++i) {
    if (dat_at(&f, i, "status") == 0) separated += fabs(dat_at(&f, i, "f_t"));
    if (dat_at(&c, i, "status") == 0) {
      ck_assert_double_eq(dat_at(&c, i, "f_t"), 0.0);
      ck_assert_double_eq(dat_at(&c, i, "limit"), 0.0);
    } else {
      ck_assert_double_gt(dat_at(&c, i, "limit"), 0.0);
      ++touching;
    }
  }
  ck_assert_double_gt(separated, 0.01);
  ck_assert_int_gt(touching, 30);
  ck_assert_int_lt(touching, 65);
}

/* A node at the edge that opens with friction and touches without ends without:
 * the search for the zone ends, with a force on no open node. */
TEST(node_that_comes_and_goes_has_no_friction) {
  JOB j = job_begin("edge");
  ck_assert_int_eq(job_run_deck(&j, "input/nonlocal_slider/nonlocal_hertz",
                                "-D NC=16 -D RHO=0.05"),
                   0);
  DAT c = job_table(&j, "CONTACT", -1);
  for (int i = 0; i < c.n_row; ++i)
    if (dat_at(&c, i, "status") == 0)
      ck_assert_double_eq(dat_at(&c, i, "f_t"), 0.0);
}

/* Found in one increment, or from the zone of the one before. */
TEST(zone_confines_friction_to_the_contact) {
  expect_zone(PUSHED);
  expect_zone(
      "*STEP\n*STATIC\n*BOUNDARY\nRIGHT, 1\n"
      "*DSLOAD\nTOP, P, 5.\nLEFT, P, 15.\n");
}

/* The zone of the increment before is where an increment begins: with nothing
 * new, one solution each. */
TEST(zone_that_stays_is_found_at_once) {
  long calls[2];
  for (int k = 0; k < 2; ++k) {
    PRINTED(steps, "%s*END STEP\n*STEP\n*QUASISTATIC\n%g, 1.\n", PUSHED,
            k == 0 ? 1.0 : 0.1);
    block b = {
        32,   1, 0.2, "CPE3", "LAW=NONLOCAL, RADIUS=0.2, ZONE=CONTACT\n1.\n",
        steps};
    JOB j = run_block(&b);
    calls[k] = job_stage(&j, "contact solver", NULL);
  }
  ck_assert_int_eq(calls[1] - calls[0], 9);
}

/* ---- local limit, other laws ------------------------------------------- */

static void expect_same(const job *a, const job *b, double tolerance) {
  static const char *const names[] = {"u_n", "u_t", "f_n", "f_t", "limit"};
  for (int k = 0; k < 2; ++k) {
    DAT p = job_table(a, "CONTACT", k), q = job_table(b, "CONTACT", k);
    ck_assert_int_eq(p.n_row, q.n_row);
    for (size_t c = 0; c < sizeof names / sizeof *names; ++c) {
      if (!dat_has(&p, names[c])) continue;
      double scale = dat_max(&p, names[c]);
      if (c == 0) scale = fmax(scale, dat_max(&p, "u_t"));
      for (int i = 0; i < p.n_row; ++i)
        ck_assert_msg(fabs(dat_at(&p, i, names[c]) - dat_at(&q, i, names[c])) <=
                          tolerance * scale,
                      "block %d, row %d, %s: %.17g, %.17g", k, i, names[c],
                      dat_at(&p, i, names[c]), dat_at(&q, i, names[c]));
    }
  }
}

TEST(small_radius_is_local_friction) {
  static const char *const types[] = {"CPE3", "CPS3", "CAX3"};
  static const char *const small[] = {"1E-9", "1E-3", "0.06"};
  for (int k = 0; k < 3; ++k) {
    block b = {16, 1, 0.2, types[k], "LAW=COULOMB\n1.\n", PUSHED};
    if (k == 2)
      b.steps =
          "*STEP\n*QUASISTATIC\n0.5, 1.\n*DSLOAD\nTOP, P, 5.\n"
          "RIGHT, P, 4.\n";
    JOB local = run_block(&b);
    PRINTED(friction, "LAW=NONLOCAL, RADIUS=%s\n1.\n", small[k]);
    b.friction = friction;
    JOB other = run_block_as(&b, "small");
    expect_same(&local, &other, 1e-13);
  }
}

static void stage_cost_of(const job *j, const char *name, long *calls,
                          long *bytes) {
  FREED char *list = job_file(j, "lst");
  const char *at = list;
  double cpu;
  while ((at = strstr(at, name)) != NULL &&
         sscanf(at + strlen(name), " %ld %lf %ld", calls, &cpu, bytes) != 3)
    ++at;
  ck_assert_ptr_nonnull(at);
}

/* The whole run without --no-timing, for the cost table. */
static void cost_with(const char *friction, long *calls, long *bytes) {
  JOB j = job_with("cost", "tests/regression/mesh/square.geo",
                   "*PARAMETER\nN = 8\n*MESH, FILE=square.geo\n"
                   "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.2\n"
                   "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
                   "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\n"
                   "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
                   "*FRICTION, CONTACT=C, %s\n" PUSHED "*END STEP\n",
                   friction);
  ck_assert_int_eq(job_run(&j, ""), 0);
  stage_cost_of(&j, "nonlocal average", calls, bytes);
}

TEST(only_the_nonlocal_law_pays) {
  static const char *const free_of_it[] = {"LAW=COULOMB\n0.3\n",
                                           "LAW=TRESCA\n1.\n", "LAW=NONE\n",
                                           "LAW=NONLOCAL, RADIUS=0.5\n0.\n"};
  long calls = -1, bytes = -1;
  for (int k = 0; k < 4; ++k) {
    cost_with(free_of_it[k], &calls, &bytes);
    ck_assert_int_eq(calls, 0);
    ck_assert_int_eq(bytes, 0);
  }
  cost_with("LAW=NONLOCAL, RADIUS=0.5\n0.3\n", &calls, &bytes);
  ck_assert_int_eq(calls, 1);
  ck_assert_int_gt(bytes, 1000);
  /* mu changes in every increment, the average is kept. */
  cost_with("LAW=NONLOCAL, RADIUS=0.5\n\"0.3*t\"\n", &calls, &bytes);
  ck_assert_int_eq(calls, 1);
}

/* mu(t) that is 0.4 at the end of both increments, and mu(x) = 0.4. */
TEST(mu_multiplies_the_average) {
  block b = {20, 1, 0.2, "CPE3", "LAW=NONLOCAL, RADIUS=0.3\n0.4\n", PUSHED};
  JOB constant = run_block(&b);
  b.friction =
      "LAW=NONLOCAL, RADIUS=0.3\n\"0.4 + 8*(t - 0.5)*(t - 1) + 0*x\"\n";
  JOB course = run_block_as(&b, "course");
  expect_same(&constant, &course, 1e-13);
}

/* ---- solvers ----------------------------------------------------------- */

TEST(every_method_gives_the_same_answer) {
  char steps[400];
  block b = {24, 1, 0.2, "CPE3", "LAW=NONLOCAL, RADIUS=0.25\n0.6\n", HELD};
  JOB first = run_block(&b);
  for (int k = 0; solver_list[k] != NULL; ++k) {
    snprintf(steps, sizeof steps, "%s*SOLVER, METHOD=%s, TOL=1E-11\n", HELD,
             solver_list[k]->name);
    b.steps = steps;
    JOB other = run_block_as(&b, "other");
    expect_same(&first, &other, 1e-7);
  }
}

/* ---- contacts apart ---------------------------------------------------- */

/* The left and the right half of a base as two contacts: each average ends
 * where its contact ends. */
TEST(contacts_do_not_see_each_other) {
  JOB j = job_begin("pair");
  job_write(
      &j, "pair.geo",
      "DefineConstant[ N = 20 ];\n"
      "Point(1) = {0, 0, 0, 1/N}; Point(2) = {1, 0, 0, 1/N};\n"
      "Point(3) = {2, 0, 0, 1/N}; Point(4) = {2, 0.2, 0, 1/N};\n"
      "Point(5) = {0, 0.2, 0, 1/N};\n"
      "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4};\n"
      "Line(4) = {4, 5}; Line(5) = {5, 1};\n"
      "Curve Loop(1) = {1 ... 5}; Plane Surface(1) = {1};\n"
      "Transfinite Curve{1, 2} = N + 1;\n"
      "Physical Curve(\"A\") = {1}; Physical Curve(\"B\") = {2};\n"
      "Physical Curve(\"TOP\") = {4}; Physical Surface(\"BODY\") = {1};\n");
  job_write(&j, "pair.inp",
            "*MESH, FILE=pair.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\n"
            "*CONTACT, NAME=A, GROUP=A, OBSTACLE=O\n"
            "*CONTACT, NAME=B, GROUP=B, OBSTACLE=O\n"
            "*FRICTION, CONTACT=A, LAW=NONLOCAL, RADIUS=0.4\n0.5\n"
            "*FRICTION, CONTACT=B, LAW=NONLOCAL, RADIUS=0.2\n0.1\n"
            "*STEP\n*STATIC\n*BOUNDARY\nA, 1\nB, 1\nTOP, 1\n"
            "*DSLOAD\nTOP, P, 1.\n*PRINT, CONTACT\n*END STEP\n");
  int code = job_run(&j, "");
  ck_assert_msg(code == 0, "%s", j.errors);
  DAT d = job_table(&j, "CONTACT", -1);
  static const double course[] = {0.5, 0.7027446459, 0.8770327167, 0.9839947499,
                                  1.0};
  for (int k = 1; k <= 4; ++k) {
    int a = dat_row_near(&d, "x", 1.0 - 0.1 * k);
    int b = dat_row_near(&d, "x", 1.0 + 0.05 * k);
    ck_assert_double_eq_tol(
        dat_at(&d, a, "limit") / (0.5 * dat_at(&d, a, "f_n")), course[k], 1e-6);
    ck_assert_double_eq_tol(
        dat_at(&d, b, "limit") / (0.1 * dat_at(&d, b, "f_n")), course[k], 1e-6);
  }
}

/* ---- three dimensions, rings ------------------------------------------- */

/* Box on its base, nu = 0, held tangentially: the limit is mu p W times the
 * area, by cubature of the bump over the square base. */
static double square_mass(double x, double y, double radius) {
  enum { STEPS = 120 };
  double sum = 0.0, h = 1.0 / STEPS;
  for (int i = 0; i < STEPS; ++i)
    for (int j = 0; j < STEPS; ++j) {
      double a = x - (i + 0.5) * h, b = y - (j + 0.5) * h;
      double s = (a * a + b * b) / (radius * radius);
      if (s < 1.0) sum += exp(1.0 / (s - 1.0));
    }
  return sum * h * h / (0.46651239317833 * radius * radius);
}

static job run_box(const char *friction, const char *steps) {
  job j = job_with(
      "box", "tests/regression/mesh/cube.geo",
      "*PARAMETER\nN = 7\nLZ = 0.3\n*MESH, FILE=cube.geo\n"
      "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n"
      "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
      "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0., 0.\n0., 0., 1.\n"
      "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
      "*FRICTION, CONTACT=C, %s\n%s*PRINT, CONTACT, TOTALS\n*END STEP\n",
      friction, steps);
  CK_EXIT(job_run(&j, ""), 0, j);
  return j;
}

TEST(square_base_has_the_mass_of_the_kernel) {
  JOB j = run_box("LAW=NONLOCAL, RADIUS=0.35\n0.3\n",
                  "*STEP\n*STATIC\n*BOUNDARY\nBOTTOM, 1, 2\n*DSLOAD\n"
                  "TOP, P, 10.\n");
  DAT d = job_table(&j, "CONTACT", -1);
  int inside = 0, corner = 0;
  for (int i = 0; i < d.n_row; ++i) {
    double x = dat_at(&d, i, "x"), y = dat_at(&d, i, "y");
    double W = dat_at(&d, i, "limit") / (0.3 * dat_at(&d, i, "f_n"));
    double miss = W - square_mass(x, y, 0.35);
    ck_assert_msg(fabs(miss) < 1e-3, "%g %g: %g", x, y, miss);
    if (fabs(x - 0.5) < 0.14 && fabs(y - 0.5) < 0.14) {
      ck_assert_double_eq_tol(W, 1.0, 1e-10);
      ++inside;
    }
    corner += fabs(W - 0.25) < 1e-5;
  }
  ck_assert_int_gt(inside, 0);
  ck_assert_int_eq(corner, 4);
}

/* Every slipping node is on its cone and slips against its force. */
TEST(cone_is_exact_at_any_angle) {
  static const double angle[] = {0.3, 1.9, 4.4};
  for (int k = 0; k < 3; ++k) {
    int slipping = 0;
    PRINTED(steps,
            "*STEP\n*STATIC\n*BOUNDARY\nTOP, 1, 1, %.17g\nTOP, 2, 2, %.17g\n"
            "TOP, 3, 3, -0.003\n*SOLVER, TOL=1E-12\n",
            0.004 * cos(angle[k]), 0.004 * sin(angle[k]));
    JOB j = run_box("LAW=NONLOCAL, RADIUS=0.4\n0.3\n", steps);
    DAT d = job_table(&j, "CONTACT", -1);
    double scale = dat_max(&d, "limit");
    for (int i = 0; i < d.n_row; ++i) {
      double t1 = dat_at(&d, i, "f_t1"), t2 = dat_at(&d, i, "f_t2");
      double s1 = dat_at(&d, i, "u_t1"), s2 = dat_at(&d, i, "u_t2");
      double limit = dat_at(&d, i, "limit"), slip = hypot(s1, s2);
      if (dat_at(&d, i, "status") != 1) continue;
      ++slipping;
      ck_assert_double_eq_tol(hypot(t1, t2), limit, 1e-10 * scale);
      ck_assert_double_eq_tol(t1 * s1 + t2 * s2, -limit * slip,
                              1e-9 * scale * slip);
    }
    ck_assert_int_gt(slipping, 10);
  }
}

/* A disc of radius 1 under uniform pressure: W at the radius r is the mass of
 * the bump in the plane within the disc. */
TEST(round_base_has_the_mass_of_the_kernel) {
  enum { STEPS = 400 };
  block b = {40,
             0.1,
             0,
             "CAX3",
             "LAW=NONLOCAL, RADIUS=0.3\n0.3\n",
             "*STEP\n*STATIC\n*BOUNDARY\nBOTTOM, 1\nTOP, 1\n*DSLOAD\n"
             "TOP, P, 10.\n"};
  JOB j = run_block(&b);
  DAT d = job_table(&j, "CONTACT", -1);
  for (int i = 0; i < d.n_row; ++i) {
    double r = dat_at(&d, i, "r"), sum = 0.0, h = 0.6 / STEPS;
    double W = dat_at(&d, i, "limit") / (0.3 * dat_at(&d, i, "f_n"));
    for (int p = 0; p < STEPS; ++p)
      for (int q = 0; q < STEPS; ++q) {
        double x = -0.3 + (p + 0.5) * h, y = -0.3 + (q + 0.5) * h;
        double s = (x * x + y * y) / 0.09;
        if (s < 1.0 && (r + x) * (r + x) + y * y < 1.0)
          sum += exp(1.0 / (s - 1.0)) * h * h;
      }
    ck_assert_double_eq_tol(W, sum / (0.46651239317833 * 0.09), 2e-3);
  }
}

/* ---- together with other cards ----------------------------------------- */

/* Given normal forces: the limit is the average of what is given. */
TEST(given_forces_are_averaged) {
  enum { N = 64 };
  double p[N + 1];
  JOB j = job_with("given", "tests/regression/mesh/square.geo",
                   "*PARAMETER\nN = %d\nLY = 0.2\n*MESH, FILE=square.geo\n"
                   "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.2\n"
                   "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
                   "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
                   "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
                   "*CONTACT FORCE, CONTACT=C\n\"1 + x*x\"\n"
                   "*FRICTION, CONTACT=C, LAW=NONLOCAL, RADIUS=0.15\n0.5\n"
                   "*STEP\n*STATIC\n*BOUNDARY\nTOP, 1, 1, 0.01\nTOP, 2, 2\n"
                   "*PRINT, CONTACT\n*END STEP\n",
                   N);
  CK_EXIT(job_run(&j, ""), 0, j);
  DAT d = job_table(&j, "CONTACT", -1);
  for (int i = 0; i <= N; ++i) p[i] = 1 + (double)i * i / (N * N);
  for (int i = 0; i <= N; ++i) {
    int row = dat_row_near(&d, "x", (double)i / N);
    double length = (i == 0 || i == N ? 0.5 : 1.0) / N;
    double expected = 0.5 * average_at(p, N, (double)i / N, 0.15, bump);
    ck_assert_double_eq_tol(dat_at(&d, row, "limit") / length, expected, 2e-3);
    ck_assert_double_eq_tol(fabs(dat_at(&d, row, "f_t")),
                            dat_at(&d, row, "limit"), 1e-10);
  }
}

/* Both forms of an increment, with friction confined to the contact. */
TEST(velocity_form_has_the_same_zone) {
  static const char velocity[] =
      "*STEP\n*QUASISTATIC, FORM=VELOCITY\n0.5, 1.\n*BOUNDARY\nRIGHT, 1\n"
      "*DSLOAD\nTOP, P, 5.\nLEFT, P, 15.\n";
  block b = {
      24,    1, 0.2, "CPE3", "LAW=NONLOCAL, RADIUS=0.3, ZONE=CONTACT\n1.\n",
      PUSHED};
  JOB one = run_block(&b);
  b.steps = velocity;
  JOB two = run_block_as(&b, "velocity");
  expect_same(&one, &two, 1e-8);
}

/* Another *FRICTION in a later step: another radius, then local. */
TEST(law_may_change_from_step_to_step) {
  block b = {16,
             1,
             0,
             "CPE3",
             "LAW=NONLOCAL, RADIUS=0.5\n0.3\n",
             PRESSED
             "*PRINT, CONTACT\n*END STEP\n*STEP\n*STATIC\n"
             "*FRICTION, CONTACT=C, LAW=NONLOCAL, RADIUS=0.25\n0.3\n"
             "*PRINT, CONTACT\n*END STEP\n*STEP\n*STATIC\n"
             "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n"};
  JOB j = run_block(&b);
  for (int k = 0; k < 3; ++k) {
    DAT d = job_table(&j, "CONTACT", k);
    static const double expected[] = {0.7027446459, 0.8770327167, 1.0};
    int row = dat_row_near(&d, "x", 0.125);
    ck_assert_double_eq_tol(
        dat_at(&d, row, "limit") / (0.3 * dat_at(&d, row, "f_n")), expected[k],
        1e-6);
  }
}

/* Given pressure p on the length L of an upper block that slides, on a wider
 * and thicker one: with k constant an edge takes mu p rho/4 of the friction,
 * normalised nothing, whichever surface is the slave and wherever its nodes
 * are; nor where the mesh is coarser than the radius. */
TEST(slave_may_end_beyond_its_master) {
  static const char *const ends[] = {"0.25, EDGE=FREE", "0.25, EDGE=NORMALIZED",
                                     "1E-3"};
  for (int k = 0; k < 18; ++k) {
    const double wanted = 0.3 * 2 * (k % 3 > 0 ? 0.6 : 0.6 - 0.5 * 0.25);
    JOB j =
        job_with("wide", "tests/regression/mesh/pair.geo",
                 "*PARAMETER\nN = %d\nM = 20\nC = 0.2\n*MESH, FILE=pair.geo\n"
                 "*MATERIAL, NAME=A\n*ELASTIC\n1000, 0.3\n"
                 "*SOLID SECTION, ELSET=LOWER, MATERIAL=A, THICKNESS=3.\n"
                 "*SOLID SECTION, ELSET=UPPER, MATERIAL=A\n"
                 "*CONTACT PAIR, NAME=P, SLAVE=%s\nUNDER, OVER\n"
                 "*CONTACT FORCE, CONTACT=P\n2.\n"
                 "*FRICTION, CONTACT=P, LAW=NONLOCAL, KERNEL=CONSTANT,\n"
                 "RADIUS=%s\n0.3\n*STEP\n*STATIC\n"
                 "*BOUNDARY\nBOTTOM, 1, 2\nTOP, 1, 1, 0.1\nTOP, 2\n"
                 "*PRINT, TOTALS\n*END STEP\n",
                 (const int[]){31, 33, 34}[k / 6],
                 k / 3 % 2 ? "FIRST" : "SECOND", ends[k % 3]);
    CK_EXIT(job_run(&j, ""), 0, j);
    const double is = fabs(job_value(&j, "TOTALS", -1, "tangential"));
    ck_assert_msg(fabs(is - wanted) < 0.01 * wanted, "%d: %g, not %g", k, is,
                  wanted);
  }
}

/* A uniform pressure p on a side of two blocks that are tied, of the height 2:
 * with k constant the ends take mu p rho/4 each, in space what the overlap of
 * the face a b with itself moved by d lacks on the mean over the disc of d: (a
 * + b) 4 rho/(3 pi) - rho^2/(2 pi). The joint takes nothing. */
TEST(average_goes_on_across_a_tie) {
  static const struct {
    const char *geo, *way, *held, *distance;
    double lost, near;
  } cases[] = {{"pair", "", "2", "STRAIGHT", 0.2, 1e-3},
               {"pair", "", "2", "GEODESIC", 0.2, 1e-3},
               {"pair3", "0., ", "2, 3", "STRAIGHT", 0.483831, 0.012}};
  for (int k = 0; k < 3; ++k) {
    const int n = k < 2 ? 16 : 5;
    JOB j = job_begin("joint");
    PRINTED(file, "tests/regression/mesh/%s.geo", cases[k].geo);
    job_copy(&j, file);
    job_write(&j, "joint.inp",
              "*PARAMETER\nN = %d\nM = %d\n*MESH, FILE=%s.geo\n"
              "*MATERIAL, NAME=A\n*ELASTIC\n1000., 0.\n"
              "*SOLID SECTION, ELSET=LOWER, MATERIAL=A\n"
              "*SOLID SECTION, ELSET=UPPER, MATERIAL=A\n"
              "*TIE, NAME=T\nUNDER, OVER\n*OBSTACLE, NAME=O, TYPE=PLANE\n"
              "%s0., 0.\n1., %s0.\nMOVE, %s0., 0.1\n"
              "*CONTACT, NAME=P, GROUP=LEFT, OBSTACLE=O\n"
              "*FRICTION, CONTACT=P, LAW=NONLOCAL, KERNEL=CONSTANT,\n"
              "RADIUS=0.4, DISTANCE=%s\n0.3\n*STEP\n*STATIC\n*BOUNDARY\n"
              "LEFT, %s\n*DSLOAD\nRIGHT, P, 10.\n*PRINT, TOTALS\n"
              "*END STEP\n",
              n, n + 2, cases[k].geo, cases[k].way, cases[k].way, cases[k].way,
              cases[k].distance, cases[k].held);
    ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
    const double is =
        job_value(&j, "TOTALS", -1, k < 2 ? "force_y" : "force_z");
    const double wanted = 3 * (2 - cases[k].lost);
    ck_assert_msg(fabs(is - wanted) < cases[k].near * wanted, "%d: %g, not %g",
                  k, is, wanted);
  }
}

/* The tips of a crack under a uniform pressure carry nothing, but the pressure
 * goes on to them: with k constant R(p)/p is 1/2 there and grows by 1/(2 rho).
 */
TEST(average_goes_on_to_the_tips) {
  JOB j = job_with(
      "tips", "input/crack/crack.geo",
      "*PARAMETER\nN = 8\nW = 3\nANGLE = 0.\n*MESH, FILE=crack.geo\n"
      "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n"
      "*SOLID SECTION, ELSET=PLATE, MATERIAL=M\n"
      "*CRACK, NAME=C, GROUP=LINE\n*FRICTION, CONTACT=C, LAW=NONLOCAL,\n"
      "KERNEL=CONSTANT, RADIUS=0.4\n0.3\n*STEP\n*STATIC\n*BOUNDARY\n"
      "PLATE, 1\nBOTTOM, 2\n*DSLOAD\nTOP, P, 5.\n*PRINT, CONTACT\n"
      "*END STEP\n");
  ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
  DAT t = job_table(&j, "CONTACT", -1);
  for (int i = 0; i < t.n_row; ++i) {
    const double left = 1 - fabs(dat_at(&t, i, "x"));
    ck_assert_double_eq_tol(
        dat_at(&t, i, "limit"),
        0.3 * dat_at(&t, i, "f_n") * fmin(1, 0.5 + left / 0.8), 1e-8);
  }
}

UNIT_MAIN("nonlocal")
