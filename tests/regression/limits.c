/*
 * Limit cases of a run: nothing loaded, a load repeated, all open, first touch
 * exactly at the end of an increment, friction from none to sticking, large
 * contrast of stiffness, paths against short cuts, turning shear.
 */
#include "solver/solver.h"
#include "support/job.h"
#include "support/unit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const int job_without_fields = 1;

/* Square on a plane at y = -gap under friction mu, with the cards of steps. */
static job run_square(double gap, double nu, double mu, const char *steps,
                      int expected) {
  job j = job_begin("square");
  job_copy(&j, "tests/regression/mesh/square.geo");
  job_write(&j, "square.inp",
            "*PARAMETER\nN = 6\n*MESH, FILE=square.geo\n"
            "*MATERIAL, NAME=M\n*ELASTIC\n1000., %.17g\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=PLANE\n0., %.17g\n0., 1.\n"
            "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
            "*FRICTION, CONTACT=C, LAW=COULOMB\n%.17g\n%s",
            nu, -gap, mu, steps);
  int code = job_run(&j, "--no-timing");
  ck_assert_msg(code == expected, "exit %d: %s", code, j.errors);
  return j;
}

#define END "*PRINT, CONTACT, NODES, TOTALS, ENERGY\n*END STEP\n"

START_TEST(no_load_no_motion) {
  job j =
      run_square(0, 0.3, 0.5,
                 "*STEP\n*QUASISTATIC\n0.5, 1.\n*BOUNDARY\nRIGHT, 1\n" END, 0);
  dat u = job_table(&j, "NODES", -1), c = job_table(&j, "CONTACT", -1);
  ck_assert_double_eq(dat_max(&u, "u_x"), 0.0);
  ck_assert_double_eq(dat_max(&u, "u_y"), 0.0);
  ck_assert_double_eq(dat_max(&c, "f_n"), 0.0);
  dat_free(&u);
  dat_free(&c);
  job_end(&j);
}
END_TEST

/* A step that changes nothing: no motion, statuses kept, at most 2 iterations
 * of the solver in each increment. */
START_TEST(constant_load_keeps_everything) {
  job j = run_square(0, 0.2, 1.0,
                     "*STEP\n*QUASISTATIC\n1., 1.\n*BOUNDARY\nRIGHT, 1\n"
                     "*DSLOAD\nTOP, P, 5.\nLEFT, P, 15.\n" END
                     "*STEP\n*QUASISTATIC\n0.25, 1.\n*END STEP\n",
                     0);
  dat a = job_table(&j, "CONTACT", 0);
  for (int k = 1; k < 5; ++k) {
    dat b = job_table(&j, "CONTACT", k);
    double scale = dat_max(&a, "u_t");
    for (int i = 0; i < a.n_row; ++i) {
      ck_assert_double_le(fabs(dat_at(&a, i, "u_t") - dat_at(&b, i, "u_t")),
                          1e-13 * scale);
      ck_assert_double_eq(dat_at(&b, i, "limit") > 0,
                          dat_at(&a, i, "limit") > 0);
    }
    dat_free(&b);
  }
  char *sta = job_file(&j, "sta"), *line = sta;
  int increments = 0;
  while ((line = strchr(line, '\n')) != NULL && *++line != '\0') {
    int step, inc, attempt, open, slip, stick, iterations;
    double t, dt;
    char solver[32];
    ck_assert_int_eq(
        sscanf(line, "%d %d %d %lf %lf %d %d %d %31s %d", &step, &inc, &attempt,
               &t, &dt, &open, &slip, &stick, solver, &iterations),
        10);
    if (step == 2) ck_assert_int_le(iterations, 2);
    increments += step == 2;
  }
  ck_assert_int_eq(increments, 4);
  free(sta);
  dat_free(&a);
  job_end(&j);
}
END_TEST

/* The same under every method, each in a step of its own. */
START_TEST(rest_costs_at_most_two_iterations_with_any_method) {
  char steps[2000];
  int used = snprintf(steps, sizeof steps,
                      "*STEP\n*QUASISTATIC\n1., 1.\n*BOUNDARY\nRIGHT, 1\n"
                      "*DSLOAD\nTOP, P, 5.\nLEFT, P, 15.\n" END);
  for (int i = 0; solver_list[i] != NULL; ++i)
    used += snprintf(steps + used, sizeof steps - (size_t)used,
                     "*STEP\n*QUASISTATIC\n0.5, 1.\n*SOLVER, METHOD=%s\n"
                     "*END STEP\n",
                     solver_list[i]->name);
  job j = run_square(0, 0.2, 1.0, steps, 0);
  char *sta = job_file(&j, "sta"), *line = sta;
  int increments = 0;
  while ((line = strchr(line, '\n')) != NULL && *++line != '\0') {
    int step, iterations;
    char solver[32];
    ck_assert_int_eq(sscanf(line, "%d %*s %*s %*s %*s %*s %*s %*s %31s %d",
                            &step, solver, &iterations),
                     3);
    if (step > 1) ck_assert_msg(iterations <= 2, "%s: %d", solver, iterations);
    ++increments;
  }
  ck_assert_int_ge(increments, 17);
  free(sta);
  job_end(&j);
}
END_TEST

/* Held above the floor: the answer is that of linear elasticity without the
 * contact cards. */
START_TEST(all_open_is_linear_elasticity) {
  static const char steps[] =
      "*STEP\n*STATIC\n*BOUNDARY\nTOP, 1, 2\n*DSLOAD\nLEFT, P, 3.\n"
      "*PRINT, NODES\n*END STEP\n";
  job j = run_square(1e-1, 0.3, 0.4, steps, 0), k = job_begin("linear");
  job_copy(&k, "tests/regression/mesh/square.geo");
  job_write(&k, "linear.inp",
            "*PARAMETER\nN = 6\n*MESH, FILE=square.geo\n"
            "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n%s",
            steps);
  ck_assert_int_eq(job_run(&k, ""), 0);
  dat a = job_table(&j, "NODES", -1), b = job_table(&k, "NODES", -1);
  double scale = dat_max(&b, "u_x");
  ck_assert_double_gt(scale, 0.0);
  for (int i = 0; i < a.n_row; ++i) {
    ck_assert_double_le(fabs(dat_at(&a, i, "u_x") - dat_at(&b, i, "u_x")),
                        1e-12 * scale);
    ck_assert_double_le(fabs(dat_at(&a, i, "u_y") - dat_at(&b, i, "u_y")),
                        1e-12 * scale);
  }
  dat_free(&a);
  dat_free(&b);
  job_end(&j);
  job_end(&k);
}
END_TEST

/*
 * nu = 0, the top goes down by d: touch when d = gap = 1/8, at the end of the
 * increment. Before: rigid motion without stress. After: strain -(d - gap).
 */
START_TEST(first_touch_at_the_end_of_an_increment) {
  job j = run_square(0.125, 0.0, 0.3,
                     "*STEP\n*QUASISTATIC\n0.25, 1.\n*BOUNDARY\nLEFT, 1\n"
                     "TOP, 2, 2, -0.25\n" END,
                     0);
  for (int k = 0; k < 4; ++k) {
    dat t = job_table(&j, "TOTALS", k), u = job_table(&j, "NODES", k);
    double d = 0.0625 * (k + 1), strain = fmax(0.0, d - 0.125);
    ck_assert_double_eq_tol(dat_at(&t, 0, "force_y"), 1000.0 * strain, 1e-9);
    for (int i = 0; i < u.n_row; ++i)
      ck_assert_double_eq_tol(
          dat_at(&u, i, "u_y"),
          strain > 0 ? -0.125 - strain * dat_at(&u, i, "y") : -d, 1e-12);
    dat_free(&t);
    dat_free(&u);
  }
  job_end(&j);
}
END_TEST

/* Friction grows: the foot moves less; mu = 1e6 sticks wherever it is closed.
 */
START_TEST(friction_from_none_to_sticking) {
  static const double mu[] = {0.0, 1e-8, 0.1, 0.5, 1.0, 5.0, 20.0, 1e6};
  double last = HUGE_VAL;
  for (int k = 0; k < 8; ++k) {
    job j = run_square(0, 0.2, mu[k],
                       "*STEP\n*STATIC\n*BOUNDARY\nRIGHT, 1\n"
                       "*DSLOAD\nTOP, P, 5.\nLEFT, P, 15.\n" END,
                       0);
    dat c = job_table(&j, "CONTACT", -1);
    int corner = dat_row_near(&c, "x", 0.0);
    double moved = dat_at(&c, corner, "u_t");
    ck_assert_double_le(fabs(moved), last * (1 + 1e-6));
    last = fabs(moved);
    for (int i = 0; i < c.n_row; ++i) {
      double n = dat_at(&c, i, "f_n"), t = dat_at(&c, i, "f_t");
      ck_assert_double_ge(n, 0.0);
      ck_assert_double_le(fabs(t), mu[k] * n * (1 + 1e-9) + 1e-9);
      ck_assert_double_ge(dat_at(&c, i, "gap"), -1e-12);
    }
    dat_free(&c);
    job_end(&j);
  }
}
END_TEST

/* Published for mu = 0 on the GRECO block: u_t(0) = 40.615 um. */
START_TEST(greco_without_friction) {
  job j = job_begin("greco");
  ck_assert_int_eq(job_run_deck(&j, "input/greco/greco", "-D MU=0 -D N=64"), 0);
  dat c = job_table(&j, "CONTACT", -1);
  ck_assert_double_eq_tol(dat_at(&c, dat_row_near(&c, "x", 0), "u_t"),
                          40.615e-3, 40.615e-6);
  dat_free(&c);
  job_end(&j);
}
END_TEST

/* Friction that would hold anything: PROXIMAL finds the answer of AUTO, in
 * steps that do not grow without bound. */
START_TEST(greco_under_huge_friction) {
  double tangential[2];
  for (int k = 0; k < 2; ++k) {
    job j;
    int code = job_run_with(&j, "input/greco/greco",
                            k == 0 ? "*SOLVER, METHOD=PROXIMAL\n" : "", 0,
                            "-D MU=1E6 -D N=32 -D DT=1");
    ck_assert_msg(code == 0, "exit %d: %s", code, j.errors);
    dat t = job_table(&j, "TOTALS", -1);
    tangential[k] = dat_at(&t, 0, "tangential");
    ck_assert_double_le(job_told(&j, "iterations"), 1000);
    dat_free(&t);
    job_end(&j);
  }
  ck_assert_double_eq_tol(tangential[0], tangential[1],
                          1e-8 * fabs(tangential[1]));
}
END_TEST

/* NEWTON, SOR and LEMKE all miss: PROXIMAL comes last, for a body that contact
 * alone holds too. */
START_TEST(auto_comes_to_proximal) {
  job j;
  int code =
      job_run_with(&j, "input/greco/greco", "", 0, "-D MU=1E6 -D N=31 -D DT=1");
  ck_assert_msg(code == 0, "exit %d: %s", code, j.errors);
  char *lst = job_file(&j, "lst");
  ck_assert_ptr_nonnull(
      strstr(lst, "lemke: cycle of states, proximal: converged"));
  free(lst);
  job_end(&j);
}
END_TEST

/*
 * Cylinder on a plane with mu = 0.2, nu = 0.3 (Spence): the zone of stick in
 * half-widths of Hertz, on a mesh of 32 segments per half-width, is 0.125 in
 * one increment, 0.3125 in five, 0.344 in twenty; the static problem is the
 * one increment. The velocity form takes the same path. The pressure at the
 * centre exceeds Hertz's by 1.0818.
 */
START_TEST(path_makes_the_zone_of_stick) {
  static const char *const procedure[] = {
      "*STATIC\n",
      "*QUASISTATIC\n1., 1.\n",
      "*QUASISTATIC\n0.2, 1.\n",
      "*QUASISTATIC\n0.05, 1.\n",
      "*QUASISTATIC, FORM=VELOCITY\n1., 1.\n",
      "*QUASISTATIC, FORM=VELOCITY\n0.05, 1.\n"};
  static const double stick[] = {0.125, 0.125, 0.3125, 0.34375, 0.125, 0.34375};
  const double pi = acos(-1.0), Es = 210e3 / 0.91;
  double a = sqrt(4 * 1000.0 * 10 / (pi * Es)), p0 = 2 * 1000.0 / (pi * a);
  for (int k = 0; k < 6; ++k) {
    job j = job_begin("spence");
    job_copy(&j, "input/hertz_line/hertz_block.geo");
    job_write(&j, "spence.inp",
              "*MESH, FILE=hertz_block.geo\n*MATERIAL, NAME=M\n*ELASTIC\n"
              "210000., 0.3\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
              "*OBSTACLE, NAME=O, TYPE=GAP\n\"x^2/20\"\n"
              "*CONTACT, NAME=C, GROUP=CONTACT, OBSTACLE=O\n"
              "*FRICTION, CONTACT=C, LAW=COULOMB\n0.2\n*STEP\n%s"
              "*BOUNDARY\nSYMMETRY, 1\n*DSLOAD\nTOP, P, %.17g\n"
              "*PRINT, CONTACT, FREQUENCY=0\n*END STEP\n",
              procedure[k], 500.0 / (100 * 0.2348908547));
    ck_assert_int_eq(job_run(&j, ""), 0);
    dat c = job_table(&j, "CONTACT", -1);
    double last = 0.0;
    for (int i = 0; i < c.n_row; ++i)
      if (dat_at(&c, i, "status") == 2.0) last = fmax(last, dat_at(&c, i, "x"));
    ck_assert_double_eq_tol(last / a, stick[k], 0.01);
    if (stick[k] > 0.34) {
      double p = dat_at(&c, dat_row_near(&c, "x", 0.0), "pressure");
      ck_assert_double_eq_tol(p / p0, 1.0818, 5e-3 * 1.0818);
    }
    dat_free(&c);
    job_end(&j);
  }
}
END_TEST

/* A static problem of the same loads, alone and after a path on which more has
 * slipped: answers, goals and their errors are the same. */
START_TEST(static_problem_knows_no_path) {
#define GOALS                                               \
  "*GOAL, NAME=E, QUANTITY=ENERGY\n"                        \
  "*GOAL, NAME=T, QUANTITY=FORCE, CONTACT=C, COMPONENT=1\n" \
  "*GOAL, NAME=W, QUANTITY=FRICTION WORK\n"
#define PRESSED(kind, side)                                                 \
  "*STEP\n" kind "*BOUNDARY\nRIGHT, 1\n*DSLOAD\nTOP, P, 5.\nLEFT, P, " side \
  "\n*PRINT, CONTACT, NODES, TOTALS, GOALS\n*END STEP\n"
#define LAST PRESSED("*STATIC\n1.\n", "15.")
  static const char *const names[] = {"CONTACT", "NODES", "TOTALS", "GOALS"};
  job a = run_square(0.0, 0.2, 1.0, GOALS LAST, 0);
  job b = run_square(0.0, 0.2, 1.0,
                     GOALS PRESSED("*QUASISTATIC\n0.5, 1.\n", "18.") LAST, 0);
  for (size_t k = 0; k < sizeof names / sizeof *names; ++k) {
    dat x = job_table(&a, names[k], -1), y = job_table(&b, names[k], -1);
    ck_assert(x.n_row == y.n_row && x.n_col == y.n_col && x.n_row > 0);
    for (int c = 0; c < x.n_col; ++c) {
      if (strstr("solver_error slip_distance", x.name[c]) != NULL) continue;
      const double most = dat_max(&x, x.name[c]);
      for (int i = 0; i < x.n_row; ++i) {
        const double is = dat_at(&x, i, x.name[c]);
        const double found = dat_at(&y, i, x.name[c]);
        ck_assert_msg(isnan(is) || fabs(found - is) <= 1e-9 * most + 1e-13,
                      "%s, row %d: %s %.12g, alone %.12g", names[k], i,
                      x.name[c], found, is);
      }
    }
    dat_free(&x);
    dat_free(&y);
  }
  job_end(&a);
  job_end(&b);
}
END_TEST

/* Two layers, E ratio 1e6, nu = 0, p = 1: u_top = -(0.5 + 0.5e-6). */
START_TEST(layers_of_a_million_to_one) {
  job j = job_begin("layers");
  job_write(&j, "layers.geo",
            "h = 0.2;\nPoint(1)={0,0,0,h};Point(2)={1,0,0,h};"
            "Point(3)={1,.5,0,h};Point(4)={0,.5,0,h};Point(5)={1,1,0,h};"
            "Point(6)={0,1,0,h};Line(1)={1,2};Line(2)={2,3};Line(3)={3,4};"
            "Line(4)={4,1};Line(5)={3,5};Line(6)={5,6};Line(7)={6,4};\n"
            "Curve Loop(1)={1,2,3,4};Plane Surface(1)={1};"
            "Curve Loop(2)={-3,5,6,7};Plane Surface(2)={2};\n"
            "Physical Surface(\"LOW\")={1};Physical Surface(\"HIGH\")={2};"
            "Physical Curve(\"BOTTOM\")={1};Physical Curve(\"TOP\")={6};"
            "Physical Curve(\"LEFT\")={4,7};\n");
  job_write(&j, "layers.inp",
            "*MESH, FILE=layers.geo\n*MATERIAL, NAME=SOFT\n*ELASTIC\n1., 0.\n"
            "*MATERIAL, NAME=HARD\n*ELASTIC\n1.E6, 0.\n"
            "*SOLID SECTION, ELSET=LOW, MATERIAL=SOFT\n"
            "*SOLID SECTION, ELSET=HIGH, MATERIAL=HARD\n"
            "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
            "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
            "*FRICTION, CONTACT=C, LAW=COULOMB\n0.5\n"
            "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1\n*DSLOAD\nTOP, P, 1.\n" END);
  ck_assert_int_eq(job_run(&j, ""), 0);
  dat u = job_table(&j, "NODES", -1), t = job_table(&j, "TOTALS", -1);
  int top = dat_row_near(&u, "y", 1.0);
  ck_assert_double_eq_tol(dat_at(&u, top, "u_y"), -(0.5 + 0.5e-6), 1e-8);
  ck_assert_msg(fabs(dat_at(&t, 0, "force_y") - 1.0) < 1e-10, "%.3g",
                dat_at(&t, 0, "force_y") - 1.0);
  dat_free(&u);
  dat_free(&t);
  job_end(&j);
}
END_TEST

/* The shear turns: at each increment the tangential forces lie on the cone or
 * inside, opposite to the slip of the increment; the energies balance. */
START_TEST(slip_turns_with_the_shear) {
  job j = job_begin("turn");
  ck_assert_int_eq(job_run_deck(&j, "input/block_shear_3d/block_shear_3d", ""),
                   0);
  dat c = job_table(&j, "CONTACT", -1), e = job_table(&j, "ENERGY", -1);
  int slipping = 0;
  for (int i = 0; i < c.n_row; ++i) {
    double n = dat_at(&c, i, "f_n"), s1 = dat_at(&c, i, "slip_1");
    double s2 = dat_at(&c, i, "slip_2"), s = hypot(s1, s2);
    double t1 = dat_at(&c, i, "f_t1"), t2 = dat_at(&c, i, "f_t2");
    if (dat_at(&c, i, "status") != 1.0) continue;
    ++slipping;
    ck_assert_double_eq_tol(hypot(t1, t2), 0.4 * n, 1e-10 * n);
    ck_assert_double_eq_tol(t1, -0.4 * n * s1 / s, 1e-11 * n);
    ck_assert_double_eq_tol(t2, -0.4 * n * s2 / s, 1e-11 * n);
  }
  ck_assert_int_gt(slipping, 10);
  ck_assert_double_le(fabs(dat_at(&e, 0, "energy_defect_relative")), 1e-10);
  ck_assert_double_gt(dat_at(&e, 0, "friction_work"), 0.0);
  dat_free(&c);
  dat_free(&e);
  job_end(&j);
}
END_TEST

/* Calls and bytes of a stage in the closing table of a run with timing; -1 if
 * there is no such stage. */
static long stage_cost(const char *listing, const char *stage, long *bytes) {
  long calls = -1;
  double cpu;
  const char *at = listing;
  while ((at = strstr(at, stage)) != NULL) {
    at += strlen(stage);
    if (sscanf(at, " %ld %lf %ld", &calls, &cpu, bytes) == 3) return calls;
  }
  return -1;
}

/* What a deck with plain Coulomb friction does not call for is neither run nor
 * allocated: the nonlocal average, other forms, theorems, inelastic strains. */
START_TEST(local_friction_pays_for_nothing_else) {
  static const char *const needed[] = {"contact solver", "sliding limit"};
  static const char *const unused[] = {
      "nonlocal average", "given contact forces",    "velocity form",
      "initial state",    "inelastic strains",       "thermal strains",
      "restart",          "zones of stick and slip", "second solutions, jumps",
      "theorems",         "moving obstacle"};
  job j = job_begin("greco");
  long bytes = 0;
  ck_assert_int_eq(job_run_deck(&j, "input/greco/greco", "-D N=8"), 0);
  char *listing = job_file(&j, "lst");
  ck_assert_ptr_nonnull(listing);
  for (size_t k = 0; k < sizeof needed / sizeof *needed; ++k) {
    ck_assert_int_gt(stage_cost(listing, needed[k], &bytes), 0);
    ck_assert_int_gt(bytes, 0);
  }
  for (size_t k = 0; k < sizeof unused / sizeof *unused; ++k) {
    long calls = stage_cost(listing, unused[k], &bytes);
    ck_assert_msg(calls <= 0 && (calls < 0 || bytes == 0),
                  "%s: %ld calls, %ld bytes", unused[k], calls, bytes);
    if (strcmp(unused[k], "theorems") != 0) ck_assert_int_eq(calls, 0);
  }
  free(listing);
  job_end(&j);
}
END_TEST

UNIT_MAIN("limits", no_load_no_motion, constant_load_keeps_everything,
          rest_costs_at_most_two_iterations_with_any_method,
          all_open_is_linear_elasticity, first_touch_at_the_end_of_an_increment,
          friction_from_none_to_sticking, greco_without_friction,
          greco_under_huge_friction, auto_comes_to_proximal,
          path_makes_the_zone_of_stick, static_problem_knows_no_path,
          layers_of_a_million_to_one, slip_turns_with_the_shear,
          local_friction_pays_for_nothing_else)
