/*
 * Initial displacements: a compatible start goes on as if the load had led to
 * it, an incompatible one is refused with its defect in N or relaxed; the end
 * of another run is a start on the same mesh.
 *
 * Unit square, nu = 0, E = 1000, G = 500, pressed by 10 on a floor with
 * mu = 0.4: u_y = -0.01 y.
 */
#include "support/job.h"
#include "support/unit.h"

#include <hdf5.h>

/* Cards before the steps, the steps; the exit code. */
static int write_and_run(job *j, int n, const char *before, const char *steps) {
  job_copy(j, "tests/regression/mesh/square.geo");
  PRINTED(deck, "%s.inp", j->name);
  job_write(j, deck,
            "*PARAMETER\nN = %d\n*MESH, FILE=square.geo\n*MATERIAL, NAME=M\n"
            "*ELASTIC\n1000., 0.\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
            "*CONTACT, NAME=F, GROUP=BOTTOM, OBSTACLE=O\n"
            "*FRICTION, CONTACT=F, LAW=COULOMB\n0.4\n%s%s",
            n, before, steps);
  return job_run(j, "--no-timing");
}

#define PRINT "*PRINT, NODES, CONTACT, ENERGY\n*END STEP\n"
/* The load is there at time 0 and stays; then the top is sheared by it. */
#define HOLD                                                    \
  "*STEP\n*QUASISTATIC\n0.5, 1.\n*DSLOAD\nTOP, P, \"10+0*t\"\n" \
  "TOP, TX, 2.\nRIGHT, TY, 2.\nLEFT, TY, -2.\n" PRINT

#define PRESSED                              \
  "*INITIAL CONDITIONS, TYPE=DISPLACEMENT\n" \
  "BODY, 2, \"-0.01*y\"\n"

/* Sheared by 2 < mu p: stick, u_x = 2 y / 500. The strain energy starts with
 * 1/2 p^2 / E = 0.05, and the balance counts from there. */
TEST(compatible_start_goes_on) {
  JOB j = job_begin("start");
  ck_assert_int_eq(write_and_run(&j, 4, PRESSED, HOLD), 0);
  ck_assert(job_tells(&j, "\n  compatible\n"));
  for (int k = 0; k < 2; ++k) {
    DAT u = job_table(&j, "NODES", k), e = job_table(&j, "ENERGY", k);
    for (int i = 0; i < u.n_row; ++i) {
      double y = dat_at(&u, i, "y");
      ck_assert_double_eq_tol(dat_at(&u, i, "u_y"), -0.01 * y, 1e-12);
      ck_assert_double_eq_tol(dat_at(&u, i, "u_x"), (k + 1) * y / 500, 1e-12);
    }
    double tau = k + 1;
    ck_assert_double_eq_tol(dat_at(&e, 0, "strain_energy"),
                            0.05 + tau * tau / 1000, 1e-12);
    ck_assert_double_eq_tol(dat_at(&e, 0, "external_work"), tau * tau / 1000,
                            1e-12);
    ck_assert_double_le(fabs(dat_at(&e, 0, "energy_defect_relative")), 1e-10);
  }
}

/* Where the foot was dragged to before: it sticks there, which the friction of
 * a start at the origin would not know. */
TEST(start_remembers_where_the_foot_is) {
  JOB j = job_begin("start");
  ck_assert_int_eq(
      write_and_run(&j, 4, PRESSED "BODY, 1, \"0.003 + 1*y/500\"\n",
                    "*STEP\n*QUASISTATIC\n1., 1.\n*DSLOAD\n"
                    "TOP, P, \"10+0*t\"\nTOP, TX, \"1+0*t\"\n"
                    "RIGHT, TY, \"1+0*t\"\nLEFT, TY, \"-1+0*t\"\n" PRINT),
      0);
  DAT c = job_table(&j, "CONTACT", -1);
  for (int i = 0; i < c.n_row; ++i) {
    ck_assert_double_eq_tol(dat_at(&c, i, "u_t"), 0.003, 1e-12);
    ck_assert_double_eq_tol(dat_at(&c, i, "slip"), 0, 1e-12);
    ck_assert_double_eq_tol(dat_at(&c, i, "traction_t"), -1, 1e-8);
  }
}

/* A given force in balance with the load is a start too. */
TEST(given_force_goes_on) {
  JOB j = job_begin("start");
  CK_EXIT(write_and_run(&j, 4, "*CONTACT FORCE, CONTACT=F\n10.\n" PRESSED,
                        "*STEP\n*QUASISTATIC\n0.5, 1.\n*BOUNDARY\nLEFT, 1\n"
                        "TOP, 2, 2, \"-0.01+0*t\"\n" PRINT),
          0, j);
  ck_assert(job_tells(&j, "\n  compatible\n"));
  DAT u = job_table(&j, "NODES", -1);
  for (int i = 0; i < u.n_row; ++i)
    ck_assert_double_eq_tol(dat_at(&u, i, "u_y"), -0.01 * dat_at(&u, i, "y"),
                            1e-12);
}

/* A cube above a floor at -0.3 that has moved by 0.15 towards one of two walls,
 * whose gaps are 0.1 and 0.2: to the far one it may. */
TEST(walls_of_a_corner_have_gaps_of_their_own) {
  static const char walls[] = "xy";
  for (int far = 0; far < 2; ++far)
    for (int moved = 0; moved < 2; ++moved) {
      JOB j = job_with(
          "corner", "tests/regression/mesh/cube.geo",
          "*PARAMETER\nN = 1\n*MESH, FILE=cube.geo\n*MATERIAL, NAME=M\n"
          "*ELASTIC\n1000., 0.\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
          "*OBSTACLE, NAME=Z, TYPE=PLANE\n0., 0., -0.3\n0., 0., 1.\n"
          "*OBSTACLE, NAME=X, TYPE=PLANE\n%g, 0., 0.\n1., 0., 0.\n"
          "*OBSTACLE, NAME=Y, TYPE=PLANE\n0., %g, 0.\n0., 1., 0.\n"
          "*CONTACT, NAME=Z, GROUP=BOTTOM, OBSTACLE=Z\n"
          "*CONTACT, NAME=X, GROUP=LEFT, OBSTACLE=X\n"
          "*CONTACT, NAME=Y, GROUP=FRONT, OBSTACLE=Y\n"
          "*INITIAL CONDITIONS, TYPE=DISPLACEMENT\nBODY, %d, -0.15\n"
          "*STEP\n*QUASISTATIC\n1., 1.\n*BOUNDARY\nTOP, 1, 3\n"
          "TOP, %d, %d, \"-0.15+0*t\"\n*PRINT, NODES\n*END STEP\n",
          far == 0 ? -0.2 : -0.1, far == 1 ? -0.2 : -0.1, moved + 1, moved + 1,
          moved + 1);
      int code = job_run(&j, "");
      ck_assert_msg(code == (far == moved ? 0 : 2), "far %c, moved %c: %d: %s",
                    walls[far], walls[moved], code, j.errors);
      ck_assert(job_tells(&j, "\n  compatible\n") == (far == moved));
    }
}

#define STEP(loads) "*STEP\n*QUASISTATIC\n0.5, 1.\n" loads PRINT

/* A figure of the initial state in the listing. */
static double start_figure(const job *j, const char *name) {
  char *lst = job_file(j, "lst"), *at = strstr(lst, name);
  ck_assert_ptr_nonnull(at);
  double value = strtod(at + strlen(name), NULL);
  free(lst);
  return value;
}

/* Each condition broken alone; forces of uniform stress on nodes 1/4 apart. */
TEST(incompatible_start_is_refused_with_its_defect) {
  static const struct {
    const char *lines, *steps, *kind;
    double worst; /* N, 0: depends on the mesh                                */
  } cases[] = {   /* The pressure of 10 is not there yet. */
               {"BODY, 2, \"-0.01*y\"\n",
                STEP("*BOUNDARY\nTOP, 1\n*DSLOAD\nTOP, P, 10.\n"),
                "not in equilibrium with the loads", 2.5},
               /* Stretched by 10 towards the top: the floor would pull. */
               {"BODY, 2, \"0.01*y\"\n",
                STEP("*BOUNDARY\nTOP, 1\n*DSLOAD\nTOP, P, \"-10+0*t\"\n"),
                "unilateral condition not met", 2.5},
               /* Sheared by 5, mu p = 4. */
               {"BODY, 2, \"-0.01*y\"\nBODY, 1, \"5*y/500\"\n",
                STEP("*DSLOAD\nTOP, P, \"10+0*t\"\nTOP, TX, \"5+0*t\"\n"
                     "RIGHT, TY, \"5+0*t\"\nLEFT, TY, \"-5+0*t\"\n"),
                "tangential force above the sliding limit", 0.25},
               {"", STEP("*BOUNDARY\nTOP, 1, 1, \"0.002+0*t\"\nTOP, 2\n"),
                "not at its support", 0},
               {"BODY, 2, -0.001\n", STEP("*BOUNDARY\nTOP, 1\n"),
                "unilateral condition not met", 0}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    JOB j = job_begin("start");
    PRINTED(lines, "*INITIAL CONDITIONS, TYPE=DISPLACEMENT\n%s",
            cases[k].lines);
    int code = write_and_run(&j, 4, lines, cases[k].steps);
    ck_assert_msg(code == 2, "case %zu: exit %d: %s", k, code, j.errors);
    ck_assert_ptr_nonnull(strstr(j.errors, "P4014"));
    ck_assert_msg(strstr(j.errors, cases[k].kind) != NULL, "%s", j.errors);
    ck_assert(job_tells(&j, "\n  REFUSED\n"));
    double force = start_figure(&j, "largest force");
    double defect = start_figure(&j, "largest defect");
    ck_assert_double_ge(force, defect);
    ck_assert_double_gt(defect, 0);
    ck_assert_double_eq_tol(start_figure(&j, "defect, relative"),
                            defect / force, 5e-3);
    if (cases[k].worst > 0)
      ck_assert_double_eq_tol(strtod(strstr(j.errors, "defect ") + 7, NULL),
                              cases[k].worst, 6e-3);
  }
}

/* Sheared too far: relaxed, the foot slips until sigma_xy = mu p = 4, that is
 * to 0.01 - 4/500, and stays. */
TEST(incompatible_start_is_relaxed) {
  static const char *const procedures[] = {"*QUASISTATIC\n0.5, 1.\n",
                                           "*STATIC\n"};
  for (int p = 0; p < 2; ++p) {
    JOB j = job_begin("start");
    PRINTED(steps,
            "*STEP\n%s*BOUNDARY\nTOP, 1, 1, \"0.01+0*t\"\n*DSLOAD\n"
            "TOP, P, \"10+0*t\"\nRIGHT, TY, \"4+0*t\"\n"
            "LEFT, TY, \"-4+0*t\"\n" PRINT,
            procedures[p]);
    ck_assert_int_eq(write_and_run(&j, 4,
                                   "*INITIAL CONDITIONS, TYPE=DISPLACEMENT, "
                                   "INCOMPATIBLE=RELAX\nBODY, 2, \"-0.01*y\"\n"
                                   "BODY, 1, \"0.01*y\"\n",
                                   steps),
                     0);
    ck_assert(job_tells(&j, "step 1  increment 0  time 0.0"));
    for (int k = 0; k < 2; ++k) {
      DAT c = job_table(&j, "CONTACT", k), e = job_table(&j, "ENERGY", k);
      for (int i = 0; i < c.n_row; ++i) {
        ck_assert_double_eq_tol(dat_at(&c, i, "u_t"), 0.002, 1e-10);
        ck_assert_double_eq_tol(dat_at(&c, i, "traction_t"), -4, 1e-8);
      }
      ck_assert_double_le(fabs(dat_at(&e, 0, "energy_defect_relative")), 1e-10);
      ck_assert_double_eq_tol(dat_at(&e, 0, "strain_energy"),
                              0.05 + 16.0 / 1000, 1e-10);
      ck_assert_double_eq_tol(dat_at(&e, 0, "external_work"), 0, 1e-12);
    }
  }
}

/* Carried aside and into the floor as a whole, then held in its place without
 * load: no method needs forces, nor a step. */
TEST(start_without_load_is_relaxed_to_rest) {
  static const char *const all[] = {"AUTO",   "NEWTON",   "LEMKE",
                                    "SOR",    "AITKEN",   "PCG",
                                    "AUGLAG", "LAGRANGE", "PROXIMAL"};
  for (size_t m = 0; m < sizeof all / sizeof *all; ++m) {
    JOB j =
        job_with("rest", "tests/regression/mesh/square.geo",
                 "*PARAMETER\nN = 5\n*MESH, FILE=square.geo\n"
                 "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.385\n"
                 "*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=CAX3\n"
                 "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
                 "*CONTACT, NAME=F, GROUP=BOTTOM, OBSTACLE=O\n"
                 "*FRICTION, CONTACT=F, LAW=COULOMB\n0.4\n"
                 "*INITIAL CONDITIONS, TYPE=DISPLACEMENT, INCOMPATIBLE=RELAX\n"
                 "BODY, 1, 7E-4\nBODY, 2, -8E-4\n*STEP\n*QUASISTATIC\n0.5, 1.\n"
                 "*BOUNDARY\nLEFT, 1, 1, \"0*t\"\nTOP, 2, 2, \"-0.01*t\"\n"
                 "*SOLVER, METHOD=%s\n" PRINT,
                 all[m]);
    const int code = job_run(&j, "--no-timing");
    ck_assert_msg(code == 0, "%s: exit %d: %s", all[m], code, j.errors);
    DAT u = job_table(&j, "NODES", 0), c = job_table(&j, "CONTACT", 0);
    ck_assert(dat_max(&u, "u_r") == 0 && dat_max(&u, "u_z") == 0);
    ck_assert(dat_max(&c, "f_n") == 0 && dat_max(&c, "f_t") == 0);
    ck_assert(job_tells(&j, "iterations 0,"));
  }
}

#define DRAG(u) "*BOUNDARY\nTOP, 1, 1, " u "\n"

/* Dragged one way and back: in one run of two steps, and in two runs, the
 * second from the end of the first. */
TEST(end_of_a_run_is_a_start) {
  JOB one = job_begin("one"), two = job_begin("two");
  const char *first =
      "*STEP\n*QUASISTATIC\n0.25, 1.\n*DSLOAD\nTOP, P, \"10*min(1, t)\"\n" DRAG(
          "0.01") PRINT;
  const char *back = "*STEP\n*QUASISTATIC\n0.25, 1.\n" DRAG("-0.01") PRINT;
  PRINTED(both, "%s%s", first, back);
  ck_assert_int_eq(write_and_run(&one, 6, "", both), 0);
  ck_assert_int_eq(write_and_run(&two, 6, "", first), 0);
  snprintf(two.name, sizeof two.name, "back");
  CK_EXIT(
      write_and_run(
          &two, 6, "*INITIAL CONDITIONS, TYPE=DISPLACEMENT, FILE=two.h5\n",
          "*STEP\n*QUASISTATIC\n0.25, 1.\n*DSLOAD\nTOP, P, \"10+0*t\"\n" DRAG(
              "-0.01") PRINT),
      0, two);
  ck_assert(job_tells(&two, "initial state: end of two.h5, time 1.0"));
  for (int k = 0; k < 4; ++k) {
    DAT a = job_table(&one, "NODES", 4 + k), b = job_table(&two, "NODES", k);
    for (int i = 0; i < a.n_row; ++i) {
      ck_assert_double_eq_tol(dat_at(&a, i, "u_x"), dat_at(&b, i, "u_x"),
                              1e-10);
      ck_assert_double_eq_tol(dat_at(&a, i, "u_y"), dat_at(&b, i, "u_y"),
                              1e-10);
    }
    ck_assert_double_le(
        fabs(job_value(&two, "ENERGY", k, "energy_defect_relative")), 1e-8);
  }
}

/* The last of 4 records of JOB.h5 becomes one of six digits. */
static void make_long(const job *j, int n) {
  const hsize_t size = (hsize_t)n;
  FREED double *t = malloc((size_t)n * sizeof *t);
  ck_assert_ptr_nonnull(t);
  for (int i = 0; i < n; ++i) t[i] = (i + 1.0) / n;
  PRINTED(path, "%s/%s.h5", j->dir, j->name);
  PRINTED(last, "/fields/u/%d", n);
  hid_t file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT);
  hid_t space = H5Screate_simple(1, &size, NULL);
  ck_assert_int_ge(H5Ldelete(file, "/fields/time", H5P_DEFAULT), 0);
  hid_t set = H5Dcreate2(file, "/fields/time", H5T_NATIVE_DOUBLE, space,
                         H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  ck_assert_int_ge(
      H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, t), 0);
  ck_assert_int_ge(
      H5Lmove(file, "/fields/u/00004", file, last, H5P_DEFAULT, H5P_DEFAULT),
      0);
  H5Dclose(set);
  H5Sclose(space);
  ck_assert_int_ge(H5Fclose(file), 0);
}

TEST(end_of_a_long_run_is_a_start) {
  JOB j = job_begin("long");
  ck_assert_int_eq(
      write_and_run(&j, 2, "",
                    "*STEP\n*QUASISTATIC\n0.25, 1.\n*DSLOAD\nTOP, P, 10.\n"
                    "*OUTPUT\n" PRINT),
      0);
  make_long(&j, 100001);
  snprintf(j.name, sizeof j.name, "next");
  CK_EXIT(write_and_run(
              &j, 2, "*INITIAL CONDITIONS, TYPE=DISPLACEMENT, FILE=long.h5\n",
              STEP("*DSLOAD\nTOP, P, \"10+0*t\"\n")),
          0, j);
}

/* Another mesh, no such file, the file of the run itself. */
TEST(wrong_files_are_refused) {
  static const struct {
    const char *name, *file, *says;
    int n, code;
  } cases[] = {{"other", "first.h5", "has another mesh", 5, 2},
               {"other", "nothing.h5", "No such file", 4, 4},
               {"other", "other.inp", "is no HDF5 file", 4, 4},
               {"first", "first.h5", "would overwrite", 4, 2}};
  JOB j = job_begin("first");
  ck_assert_int_eq(write_and_run(&j, 4, "", STEP("*DSLOAD\nTOP, P, 10.\n")), 0);
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    PRINTED(lines, "*INITIAL CONDITIONS, TYPE=DISPLACEMENT, FILE=%s\n",
            cases[k].file);
    snprintf(j.name, sizeof j.name, "%s", cases[k].name);
    int code = write_and_run(&j, cases[k].n, lines,
                             STEP("*DSLOAD\nTOP, P, \"10+0*t\"\n"));
    ck_assert_msg(code == cases[k].code, "case %zu: exit %d: %s", k, code,
                  j.errors);
    ck_assert_msg(strstr(j.errors, cases[k].says) != NULL, "%s", j.errors);
  }
}

/* The square held at its top, E = 1000: from a start under strain, relaxed or
 * not, or by an inelastic strain under no stress, to a strain of -1.5e-3, less
 * 1.5e-4 of heat, in half of a relaxation time by the midpoint rule. */
static const struct {
  const char *start, *law, *step;
  double stress, work; /* mean of both ends; on the inelastic strain, J */
} held[] = {{"\nBODY, 2, \"-0.001*y\"\n", "", "QUASISTATIC", -1.325, 0},
            {", INCOMPATIBLE=RELAX\nBODY, 2, \"-0.001*y*y\"\n", "",
             "QUASISTATIC", -1.325, 0},
            {"\nBODY, 2, \"-0.001*y\"\n", "*INELASTIC, LAW=MAXWELL\n1.\n",
             "VISCO, INTEGRATOR=MIDPOINT", -1.06, 5.618e-4},
            {"\nBODY, 2, \"0.001*y\"\n"
             "*INITIAL CONDITIONS, TYPE=INELASTIC STRAIN\nBODY, 2, 0.001\n",
             "*INELASTIC, LAW=MAXWELL\n1.\n", "VISCO, INTEGRATOR=MIDPOINT",
             -1.06, 5.618e-4}};

TEST(works_count_from_the_stress_of_the_start) {
  for (size_t k = 0; k < sizeof held / sizeof *held; ++k) {
    JOB j = job_with(
        "held", "tests/regression/mesh/square.geo",
        "*PARAMETER\nN = 2\n*MESH, FILE=square.geo\n*MATERIAL, NAME=M\n"
        "*ELASTIC\n1000., 0.\n*EXPANSION\n1.E-5\n%s"
        "*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=CPS3\n"
        "*INITIAL CONDITIONS, TYPE=DISPLACEMENT%s*STEP\n*%s\n0.5, 0.5\n"
        "*BOUNDARY\nBOTTOM, 2\nLEFT, 1\nTOP, 2, 2, -0.0015\n"
        "*TEMPERATURE\nBODY, 15.\n*PRINT, ENERGY\n*END STEP\n",
        held[k].law, held[k].start, held[k].step);
    const int code = job_run(&j, "");
    ck_assert_msg(code == 0, "%zu: exit %d: %s", k, code, j.errors);
    DAT e = job_table(&j, "ENERGY", -1);
    ck_assert_double_eq_tol(dat_at(&e, 0, "thermal_work"),
                            held[k].stress * 1.5e-4, 1e-15);
    if (held[k].work > 0)
      ck_assert_double_eq_tol(dat_at(&e, 0, "inelastic_work"), held[k].work,
                              1e-15);
    ck_assert_double_le(fabs(dat_at(&e, 0, "energy_defect_relative")), 1e-12);
  }
}

UNIT_MAIN("start")
