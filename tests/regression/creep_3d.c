/*
 * Bodies in space that creep and warm up against contact and friction, exact on
 * every mesh of tetrahedra, and their fields read back from JOB.h5; a body
 * under given normal forces and sliding limits that starts with inelastic
 * strains (problem Q3 of CPR98, its compatibility (3.26)).
 *
 * Unit cube or square, nu = 0, E = 1000, G = 500, relaxation time 2.
 */
#include "support/job.h"
#include "support/unit.h"

#include <hdf5.h>

#define ANGLE (17.0 * acos(-1.0) / 180.0)

static job run_cube(const char *cards, const char *model, const char *steps) {
  job j =
      job_with("cube", "tests/regression/mesh/cube.geo",
               "*PARAMETER\nN = 2\n*MESH, FILE=cube.geo\n*MATERIAL, NAME=M\n"
               "*ELASTIC\n1000., 0.\n%s*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
               "%s%s",
               cards, model, steps);
  CK_EXIT(job_run(&j, "--no-timing"), 0, j);
  return j;
}

#define MAXWELL "*INELASTIC, LAW=MAXWELL\n2.\n"
#define FLOOR                            \
  "*OBSTACLE, NAME=O, TYPE=CONFORMING\n" \
  "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
#define ROUGH FLOOR "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n"

/* Nodes of the floor: slip along the angle, friction 0.3 of the force. */
static void slips(const job *j, int k, double slip, double force) {
  DAT d = job_table(j, "CONTACT", k);
  double c = cos(ANGLE), s = sin(ANGLE), all = 0;
  for (int i = 0; i < d.n_row; ++i) {
    double n = dat_at(&d, i, "f_n");
    ck_assert_double_eq_tol(hypot(dat_at(&d, i, "u_t1"), dat_at(&d, i, "u_t2")),
                            slip, 1e-10);
    ck_assert_double_eq_tol(dat_at(&d, i, "f_x"), -0.3 * c * n, 1e-9);
    ck_assert_double_eq_tol(dat_at(&d, i, "f_y"), -0.3 * s * n, 1e-9);
    all += n;
  }
  ck_assert_double_eq_tol(all, force, 1e-8);
}

/* Every element of the last table. */
static void all_have(const job *j, const char *column, double expected) {
  DAT d = job_table(j, "ELEMENTS", -1);
  for (int i = 0; i < d.n_row; ++i)
    ck_assert_double_eq_tol(dat_at(&d, i, column), expected, 1e-8);
}

/* Tractions of the sides, and the top moved along the angle. */
static void patch(char *text, size_t size, const char *traction, double Ux,
                  const char *motion) {
  double c = cos(ANGLE), s = sin(ANGLE);
  snprintf(text, size,
           "*BOUNDARY\nTOP, 1, 1, \"%.17g*(%.17g%s)\"\nTOP, 2, 2, "
           "\"%.17g*(%.17g%s)\"\n*DSLOAD\nRIGHT, TZ, \"%.17g*%s\"\n"
           "LEFT, TZ, \"-%.17g*%s\"\nBACK, TZ, \"%.17g*%s\"\n"
           "FRONT, TZ, \"-%.17g*%s\"\n*PRINT, CONTACT, ENERGY, ELEMENTS\n"
           "*END STEP\n",
           c, Ux, motion, s, Ux, motion, 3 * c, traction, 3 * c, traction,
           3 * s, traction, 3 * s, traction);
}

/* Pressed by 0.01, sheared by 3 = mu p, slip 0.004; then held in height while
 * all stresses relax and the top goes on by 0.005 a second: the shear strain
 * stays, and the foot goes on as the top does. */
TEST(cone_with_relaxing_pressure) {
  char first[1024], then[1024];
  patch(first, sizeof first, "t", 0.01, "*t");
  patch(then, sizeof then, "exp(-(t - 1)/2)", 0.01, " + 0.005*(t - 1)");
  PRINTED(steps,
          "*STEP\n*QUASISTATIC\n1., 1.\n*BOUNDARY\nTOP, 3, 3, -0.01\n%s"
          "*STEP\n*VISCO, INTEGRATOR=EXPONENTIAL\n0.5, 2.\n%s",
          first, then);
  JOB j = run_cube(MAXWELL, ROUGH, steps);
  slips(&j, 0, 0.004, 10);
  for (int k = 1; k <= 4; ++k)
    slips(&j, k, 0.004 + 0.0025 * k, 10 * exp(-0.25 * k));
  all_have(&j, "stress_zz", -10 * exp(-1.0));
  all_have(&j, "ei_zz", -0.01 * (1 - exp(-1.0)));
  ck_assert_double_le(
      fabs(job_value(&j, "ENERGY", -1, "energy_defect_relative")), 1e-10);
}

/* The same slip under the pressure of heat: expansion along z alone, 1e-4 times
 * 100 degrees between the top and the floor. */
TEST(cone_with_the_pressure_of_heat) {
  char step[1024];
  patch(step, sizeof step, "t", 0.01, "*t");
  PRINTED(steps,
          "*STEP\n*QUASISTATIC\n0.5, 1.\n*TEMPERATURE\nBODY, 100.\n"
          "*BOUNDARY\nTOP, 3\n%s",
          step);
  JOB j = run_cube("*EXPANSION, TYPE=ORTHO\n0., 0., 1.E-4\n", ROUGH, steps);
  slips(&j, 0, 0.002, 5);
  slips(&j, 1, 0.004, 10);
  all_have(&j, "stress_zz", -10);
}

/* Heat closes a gap of 0.004 and presses, sigma = -E (0.01 - 0.004); held, the
 * pressure relaxes; cooled, the gap opens again. */
TEST(gap_closes_relaxes_and_opens) {
  JOB j = run_cube(
      MAXWELL "*EXPANSION, TYPE=ORTHO\n0., 0., 1.E-4\n",
      "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0., -0.004\n0., 0., 1.\n"
      "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n",
      "*STEP\n*QUASISTATIC\n0.5, 1.\n*BOUNDARY\nTOP, 3\nLEFT, 1\nFRONT, 2\n"
      "*TEMPERATURE\nBODY, 100.\n*PRINT, TOTALS, ELEMENTS\n*END STEP\n"
      "*STEP\n*VISCO, INTEGRATOR=EXPONENTIAL\n1., 4.\n*END STEP\n"
      "*STEP\n*QUASISTATIC\n1., 1.\n*TEMPERATURE\nBODY, 0.\n*END STEP\n");
  static const double p[] = {1, 6};
  for (int k = 0; k < 7; ++k) {
    DAT t = job_table(&j, "TOTALS", k);
    double expected = k < 2 ? p[k] : k < 6 ? 6 * exp(-0.5 * (k - 1)) : 0;
    ck_assert_double_eq_tol(dat_at(&t, 0, "normal"), expected, 1e-9);
  }
  all_have(&j, "stress_zz", 0);
  all_have(&j, "ei_zz", -0.006 * (1 - exp(-2.0)));
}

/* Numbers of a dataset of JOB.h5 into x[n]; how many it has. */
static int read_field(const job *j, const char *name, double *x, int n) {
  PRINTED(path, "%s/%s.h5", j->dir, j->name);
  hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  ck_assert(file >= 0);
  hid_t set = H5Dopen2(file, name, H5P_DEFAULT);
  ck_assert_msg(set >= 0, "no %s", name);
  hid_t space = H5Dget_space(set);
  int found = (int)H5Sget_simple_extent_npoints(space);
  ck_assert_int_le(found, n);
  ck_assert(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, x) >=
            0);
  H5Sclose(space);
  H5Dclose(set);
  H5Fclose(file);
  return found;
}

/* The deck is one text of JOB.h5, which has that. */
static void deck_has(const job *j, const char *words) {
  char path[128], text[8192] = "";
  snprintf(path, sizeof path, "%s/%s.h5", j->dir, j->name);
  hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  hid_t set = H5Dopen2(file, "/deck", H5P_DEFAULT);
  hid_t type = H5Dget_type(set), space = H5Dget_space(set);
  ck_assert_int_eq(H5Sget_simple_extent_npoints(space), 1);
  ck_assert_uint_lt(H5Tget_size(type), sizeof text);
  ck_assert(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text) >= 0);
  ck_assert_ptr_nonnull(strstr(text, words));
  H5Sclose(space);
  H5Tclose(type);
  H5Dclose(set);
  H5Fclose(file);
}

/* Pulled by 1, the lower half has a Kelvin-Voigt unit: its strain, which is
 * its alpha, is (1 - exp(-1))/500 at t = 6; the upper half has none. */
TEST(fields_of_creep_are_read_back) {
  enum { MOST = 500 };
  static double ei[MOST], alpha[MOST], number[MOST];
  const double expected = (1 - exp(-1.0)) / 500;
  int flowing = 0;
  JOB j =
      job_with("fields", "tests/regression/mesh/layers.geo",
               "*PARAMETER\nN = 4\n*MESH, FILE=layers.geo\n*MATERIAL, NAME=M\n"
               "*ELASTIC\n1000., 0.\n*INELASTIC, LAW=KELVIN\n500., 3000.\n"
               "*MATERIAL, NAME=E\n*ELASTIC\n1000., 0.\n"
               "*SOLID SECTION, ELSET=SOFT, MATERIAL=M\n"
               "*SOLID SECTION, ELSET=HARD, MATERIAL=E\n"
               "*STEP\n*VISCO, INTEGRATOR=RK4\n0.25, 6.\n*BOUNDARY\nBOTTOM, 2\n"
               "LEFT, 1\n*DSLOAD\nTOP, TY, \"1 + 0*t\"\n*PRINT, ELEMENTS\n"
               "*OUTPUT, FREQUENCY=0\n*END STEP\n");
  ck_assert_int_eq(job_run(&j, "--no-timing"), 0);
  DAT d = job_table(&j, "ELEMENTS", -1);
  deck_has(&j, "LAW=KELVIN");
  ck_assert_int_eq(read_field(&j, "/fields/ei_yy/00001", ei, MOST), d.n_row);
  ck_assert_int_eq(read_field(&j, "/fields/alpha_2/00001", alpha, MOST),
                   d.n_row);
  ck_assert_int_eq(read_field(&j, "/mesh/elem_no", number, MOST), d.n_row);
  for (int i = 0; i < d.n_row; ++i) {
    int row = dat_row_near(&d, "elem_no", number[i]);
    int flows = dat_at(&d, row, "y") < 0.5;
    flowing += flows;
    ck_assert_double_eq_tol(ei[i], flows ? expected : 0, 1e-9);
    ck_assert_double_eq_tol(alpha[i], flows ? expected : 0, 1e-9);
  }
  ck_assert_int_gt(flowing, 10);
  ck_assert_int_lt(flowing, d.n_row - 10);
}

/*
 * Q3: p = 10 and g = 3 given, the top led. A start with e^i_yy = 0.002 is
 * compatible if u_0 bears the stress (-10, shear 3): u_y = 0.008 (1 - y), u_x =
 * 0.004 + 0.006 y. Then e^i grows by sigma/(E tau) in each second: -0.005 along
 * y, and in shear by 0.003, so that the foot slips by 0.007 a second under a
 * top led by 0.01. Without e^i in u_0 the floor carries 12 in the place of 10.
 */
static int given_friction(job *j, const char *u_y) {
  *j = job_with("given", "tests/regression/mesh/square.geo",
                "*PARAMETER\nN = 4\n*MESH, FILE=square.geo\n*MATERIAL, NAME=M\n"
                "*ELASTIC\n1000., 0.\n" MAXWELL
                "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n" FLOOR
                "*FRICTION, CONTACT=C, LAW=TRESCA\n3.\n"
                "*CONTACT FORCE, CONTACT=C\n10.\n"
                "*INITIAL CONDITIONS, TYPE=DISPLACEMENT\n"
                "BODY, 1, \"0.004 + 0.006*y\"\nBODY, 2, \"%s\"\n"
                "*INITIAL CONDITIONS, TYPE=INELASTIC STRAIN\nBODY, 2, 0.002\n"
                "*STEP\n*VISCO, INTEGRATOR=EULER\n0.5, 2.\n"
                "*BOUNDARY\nTOP, 1, 1, \"0.01 + 0.01*t\"\nTOP, 2\n"
                "*DSLOAD\nRIGHT, TY, \"3 + 0*t\"\nLEFT, TY, \"-3 + 0*t\"\n"
                "*PRINT, CONTACT, ELEMENTS\n*END STEP\n",
                u_y);
  return job_run(j, "--no-timing");
}

TEST(start_of_given_friction_is_compatible) {
  JOB j;
  CK_EXIT(given_friction(&j, "0.008*(1 - y)"), 0, j);
  DAT c = job_table(&j, "CONTACT", -1);
  for (int i = 0; i < c.n_row; ++i) {
    ck_assert_double_eq_tol(fabs(dat_at(&c, i, "u_t")), 0.004 + 0.007 * 2,
                            1e-9);
    ck_assert_double_eq_tol(dat_at(&c, i, "u_n"), -0.008 - 0.005 * 2, 1e-9);
  }
  all_have(&j, "stress_yy", -10);
  all_have(&j, "stress_xy", 3);
  all_have(&j, "ei_yy", 0.002 - 0.005 * 2);
  FREED char *lst = job_file(&j, "lst");
  ck_assert_ptr_nonnull(strstr(lst, "\n  compatible\n"));
}

TEST(start_of_given_friction_is_refused) {
  JOB j;
  ck_assert_int_eq(given_friction(&j, "0.01*(1 - y)"), 2);
  ck_assert_ptr_nonnull(strstr(j.errors, "P4014"));
  /* 12 - 10 on a node that carries a quarter of the floor. */
  ck_assert_msg(strstr(j.errors, "defect 0.5 ") != NULL, "%s", j.errors);
}

UNIT_MAIN("creep_3d")
