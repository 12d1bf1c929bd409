/*
 * *REFERENCE: the true error against closed forms. Uniform stress, which the
 * elements have exactly: no error against itself, 1/5 in every norm against
 * 5/4 of it. A block without lateral strain against a field of second order:
 * integrals of polynomials, below. Hertz's half plane, whose stresses the
 * example has in closed form: the estimate beside the true error.
 */
#include "support/job.h"
#include "support/unit.h"

typedef struct scene {
  const char *geo, *section, *nu, *reference, *supports;
} scene;

static job run_scene(const scene *s, const char *factor) {
  job j = job_begin("truth");
  PRINTED(path, "tests/regression/mesh/%s", s->geo);
  job_copy(&j, path);
  job_write(&j, "truth.inp",
            "*PARAMETER\nF = %s\nN = 3 + 0*<F>\n*MESH, FILE=%s\n"
            "*MATERIAL, NAME=M\n*ELASTIC\n1000., %s\n*SOLID SECTION, "
            "ELSET=BODY, MATERIAL=M%s\n"
            "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
            "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
            "*REFERENCE\n%s*STEP\n*STATIC\n*BOUNDARY\n%s"
            "*DSLOAD\nTOP, P, 10.\n*ACCURACY, MESH=YES\n*END STEP\n",
            factor, s->geo, s->nu, s->section, s->reference, s->supports);
  CK_EXIT(job_run(&j, ""), 0, j);
  return j;
}

/* nu = 0.3, E = 1000, pressed by 10. */
static const scene uniform[] = {
    {"square.geo", "", "0.3",
     "u_x, \"F*3.9E-3*x\"\nu_y, \"-F*9.1E-3*y\"\npressure, \"F*10\"\n"
     "stress_xx, 0\nstress_yy, \"-F*10\"\nstress_zz, \"-F*3\"\nstress_xy, 0\n",
     "LEFT, 1\n"},
    {"square.geo", ", TYPE=CPS3", "0.3",
     "u_x, \"F*3E-3*x\"\nu_y, \"-F*1E-2*y\"\npressure, \"F*10\"\n"
     "stress_xx, 0\nstress_yy, \"-F*10\"\nstress_zz, 0\nstress_xy, 0\n",
     "LEFT, 1\n"},
    {"square.geo", ", TYPE=CAX3", "0.3",
     "u_r, \"F*3E-3*x\"\nu_z, \"-F*1E-2*y\"\npressure, \"F*10\"\n"
     "stress_rr, 0\nstress_zz, \"-F*10\"\nstress_tt, 0\nstress_rz, 0\n",
     "LEFT, 1\n"},
    {"cube.geo", "", "0.3",
     "u_x, \"F*3E-3*x\"\nu_y, \"F*3E-3*y\"\nu_z, \"-F*1E-2*z\"\n"
     "pressure, \"F*10\"\nstress_xx, 0\nstress_yy, 0\nstress_zz, \"-F*10\"\n"
     "stress_xy, 0\nstress_yz, 0\nstress_zx, 0\n",
     "LEFT, 1\nFRONT, 2\n"}};
static const char *const norms[] = {
    "true_error_percent", "true_displacement_error_percent",
    "true_stress_error_percent", "true_pressure_error_percent"};

static const char *const listed_norms[] = {"energy norm", "displacement",
                                           "stress", "contact pressure"};

/* Part of the true error in the listing, %. */
static double listed(const job *j, const char *norm) {
  char *lst = job_file(j, "lst"), *at = strstr(lst, "  true error: ");
  ck_assert_ptr_nonnull(at);
  at = strstr(at, norm);
  ck_assert_ptr_nonnull(at);
  double value = strtod(at + strlen(norm), NULL);
  free(lst);
  return value;
}

TEST(uniform_stress_has_the_error_of_its_factor) {
  for (size_t k = 0; k < sizeof uniform / sizeof *uniform; ++k) {
    JOB exact = run_scene(&uniform[k], "1"),
        other = run_scene(&uniform[k], "1.25");
    for (int i = 0; i < 4; ++i) {
      ck_assert_double_le(0.01 * job_told(&exact, norms[i]), 1e-9);
      ck_assert_double_eq_tol(0.01 * job_told(&other, norms[i]), 0.2, 1e-9);
      ck_assert_double_eq_tol(listed(&other, listed_norms[i]), 20, 1e-6);
    }
  }
}

/*
 * u_y = -0.01 y (in 3-D u_z = -0.01 z) is found; 0.001 y^2 more is the closed
 * form, over 0 < y < 1:
 * energy: sqrt(4/3 0.001^2 / (0.01^2 - 2 0.01 0.001 + 4/3 0.001^2)), and the
 * same of the stress; displacement: sqrt(0.001^2/5 / (0.01^2/3 - 0.01 0.001/2 +
 * 0.001^2/5)).
 */
static void check_quadratic(const char *geo, const char *reference,
                            double displacement, double stress) {
  const char *supports = geo[0] == 's' ? "LEFT, 1\n" : "LEFT, 1\nFRONT, 2\n";
  const scene s = {geo, "", "0", reference, supports};
  const double a = 0.01, b = 0.001;
  JOB j = run_scene(&s, "1");
  double energy = sqrt(4 * b * b / 3 / (a * a - 2 * a * b + 4 * b * b / 3));
  ck_assert_double_eq_tol(0.01 * job_told(&j, norms[0]), energy, 1e-9);
  if (displacement > 0)
    ck_assert_double_eq_tol(
        0.01 * job_told(&j, norms[1]),
        sqrt(b * b / 5 / (a * a / 3 - a * b / 2 + b * b / 5)), 1e-9);
  else
    ck_assert(isnan(0.01 * job_told(&j, norms[1])));
  if (stress > 0)
    ck_assert_double_eq_tol(0.01 * job_told(&j, norms[2]), energy, 1e-9);
  else
    ck_assert(isnan(0.01 * job_told(&j, norms[2])));
  ck_assert(isnan(0.01 * job_told(&j, norms[3])));
}

TEST(integrals_of_a_quadratic_field) {
  check_quadratic("square.geo", "u_x, 0\nu_y, \"-0.01*y + 0.001*y^2\"\n", 1, 0);
  check_quadratic("square.geo",
                  "stress_xx, 0\nstress_yy, \"-10 + 2*y\"\nstress_zz, 0\n"
                  "stress_xy, 0\n",
                  0, 1);
  check_quadratic("cube.geo", "u_x, 0\nu_y, 0\nu_z, \"-0.01*z + 0.001*z^2\"\n",
                  1, 0);
  check_quadratic("cube.geo",
                  "stress_xx, 0\nstress_yy, 0\nstress_zz, \"-10 + 2*z\"\n"
                  "stress_xy, 0\nstress_yz, 0\nstress_zx, 0\n",
                  0, 1);
}

/* Strains of all components, each with a rotation, given at all nodes: the
 * closed form F times as large. */
static const struct {
  const char *geo, *type, *cards, *supports;
} sheared[] = {
    {"square.geo", "CPE3",
     "u_x, \"F*1E-3*(x + 2*y)\"\nu_y, \"F*1E-3*(4*x - y)\"\n"
     "stress_xx, \"F\"\nstress_yy, \"-F\"\nstress_zz, 0\n"
     "stress_xy, \"3*F\"\n",
     "BODY, 1, 1, \"1E-3*(x + 2*y)\"\nBODY, 2, 2, \"1E-3*(4*x - y)\"\n"},
    {"square.geo", "CAX3",
     "u_r, \"F*1E-3*x\"\nu_z, \"F*1E-3*(4*x - y)\"\n"
     "stress_rr, \"F\"\nstress_zz, \"-F\"\nstress_tt, \"F\"\n"
     "stress_rz, \"2*F\"\n",
     "BODY, 1, 1, \"1E-3*x\"\nBODY, 2, 2, \"1E-3*(4*x - y)\"\n"},
    {"cube.geo", NULL,
     "u_x, \"F*1E-3*(x + 2*y - 3*z)\"\nu_y, \"F*1E-3*(4*x - y + 5*z)\"\n"
     "u_z, \"F*1E-3*(2*z + y - 6*x)\"\n"
     "stress_xx, \"F\"\nstress_yy, \"-F\"\nstress_zz, \"2*F\"\n"
     "stress_xy, \"3*F\"\nstress_yz, \"3*F\"\nstress_zx, \"-4.5*F\"\n",
     "BODY, 1, 1, \"1E-3*(x + 2*y - 3*z)\"\n"
     "BODY, 2, 2, \"1E-3*(4*x - y + 5*z)\"\n"
     "BODY, 3, 3, \"1E-3*(2*z + y - 6*x)\"\n"}};

static void check_sheared(int id, int stress, const char *factor,
                          double error) {
  JOB j = job_begin("truth");
  char path[80], type[20] = "", cards[400], *rest;
  snprintf(path, sizeof path, "tests/regression/mesh/%s", sheared[id].geo);
  job_copy(&j, path);
  if (sheared[id].type != NULL)
    snprintf(type, sizeof type, ", TYPE=%s", sheared[id].type);
  snprintf(cards, sizeof cards, "%s", sheared[id].cards);
  rest = strstr(cards, "stress");
  job_write(&j, "truth.inp",
            "*PARAMETER\nF = %s\nN = 2\n*MESH, FILE=%s\n*MATERIAL, NAME=M\n"
            "*ELASTIC\n1000., 0.\n*SOLID SECTION, ELSET=BODY, MATERIAL=M%s\n"
            "*REFERENCE\n%.*s*STEP\n*STATIC\n*BOUNDARY\n%s*END STEP\n",
            factor, sheared[id].geo, type,
            stress ? (int)strlen(rest) : (int)(rest - cards),
            stress ? rest : cards, sheared[id].supports);
  ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
  ck_assert_double_eq_tol(0.01 * job_told(&j, norms[0]), error, 1e-8);
  ck_assert_double_eq_tol(0.01 * job_told(&j, norms[1 + stress]), error, 1e-8);
}

TEST(all_strains_have_the_error_of_their_factor) {
  for (int k = 0; k < 6; ++k) {
    check_sheared(k / 2, k % 2, "1", 0.0);
    check_sheared(k / 2, k % 2, "1.25", 0.2);
  }
}

/* Both layers are stretched to the stress 1; the closed form says 2 of the
 * upper one, which is three times as thick, and as much of its displacement. */
TEST(thick_parts_count_more) {
  JOB j = job_with(
      "truth", "tests/regression/mesh/layers.geo",
      "*PARAMETER\nN = 2\n*MESH, FILE=layers.geo\n*MATERIAL, NAME=M\n"
      "*ELASTIC\n1000., 0.\n"
      "*SOLID SECTION, ELSET=SOFT, MATERIAL=M\n"
      "*SOLID SECTION, ELSET=HARD, MATERIAL=M, THICKNESS=3.\n"
      "*REFERENCE\nu_x, \"1E-3*x*(1 + (y>0.5))\"\nu_y, 0\n"
      "stress_xx, \"1 + (y>0.5)\"\nstress_yy, 0\nstress_zz, 0\n"
      "stress_xy, 0\n*STEP\n*STATIC\n*BOUNDARY\nSOFT, 1, 1, \"1E-3*x\"\n"
      "HARD, 1, 1, \"1E-3*x\"\nSOFT, 2\nHARD, 2\n*END STEP\n");
  CK_EXIT(job_run(&j, ""), 0, j);
  for (int i = 0; i < 3; ++i)
    ck_assert_double_eq_tol(0.01 * job_told(&j, norms[i]), sqrt(3 / 13.), 1e-9);
}

TEST(estimate_beside_the_true_error_of_hertz) {
  double before = 1;
  for (int n = 4; n <= 8; n *= 2) {
    JOB j = job_begin("hertz");
    PRINTED(words, "-D N=%d", n);
    ck_assert_int_eq(job_run_deck(&j, "input/hertz_line/hertz_exact", words),
                     0);
    double effectivity = 100 * 0.01 * job_told(&j, "effectivity");
    double error = 0.01 * job_told(&j, norms[0]),
           estimate = 0.01 * job_told(&j, "mesh_error_percent");
    ck_assert_double_eq_tol(effectivity, estimate / error, 1e-3);
    ck_assert_msg(effectivity > 0.9 && effectivity < 1.1, "%g", effectivity);
    ck_assert_double_lt(error, 0.6 * before);
    before = error;
    FREED char *lst = job_file(&j, "lst");
    ck_assert_ptr_nonnull(strstr(lst, "  true error: energy norm "));
    ck_assert_ptr_nonnull(strstr(lst, "  estimated over true error: "));
  }
}

/* Tube under pressure, radii 1 and 2, nu = 0.4999 (Lame), 8 segments through
 * its wall: clusters of elements see the mean of their change of volume, and so
 * does the error. */
TEST(averaged_strains_have_the_error_of_the_law) {
  const double E = 1e5, nu = 0.4999, p = 100, k = (1 + nu) / E * p / 3;
  JOB j = job_begin("tube");
  job_write(
      &j, "tube.geo",
      "Point(1) = {1, 0, 0}; Point(2) = {2, 0, 0}; Point(3) = {0, 2, 0};\n"
      "Point(4) = {0, 1, 0}; Point(5) = {0, 0, 0};\n"
      "Line(1) = {1, 2}; Circle(2) = {2, 5, 3}; Line(3) = {3, 4};\n"
      "Circle(4) = {4, 5, 1}; Curve Loop(1) = {1, 2, 3, 4};\n"
      "Plane Surface(1) = {1}; MeshSize{:} = 1/8.;\n"
      "Physical Curve(\"BELOW\") = {1}; Physical Curve(\"LEFT\") = {3};\n"
      "Physical Curve(\"HOLE\") = {4}; Physical Surface(\"BODY\") = {1};\n");
  job_write(&j, "tube.inp",
            "*MESH, FILE=tube.geo\n*MATERIAL, NAME=M\n*ELASTIC\n%g, %g\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M, FORMULATION=AVERAGED\n"
            "*REFERENCE\nu_x, \"%.17g*x + %.17g*x/(x^2 + y^2)\"\n"
            "u_y, \"%.17g*y + %.17g*y/(x^2 + y^2)\"\n*STEP\n*STATIC\n"
            "*BOUNDARY\nBELOW, 2\nLEFT, 1\n*DSLOAD\nHOLE, P, %g\n"
            "*ACCURACY, MESH=YES\n*END STEP\n",
            E, nu, k * (1 - 2 * nu), 4 * k, k * (1 - 2 * nu), 4 * k, p);
  CK_EXIT(job_run(&j, ""), 0, j);
  const double ratio = job_told(&j, "effectivity");
  ck_assert_msg(ratio > 0.9 && ratio < 1.1, "%g", ratio);
}

/* The same tube turned round its axis: the hoop strain, that of the centroid in
 * the stress of an element, is taken where it is, its change of volume as the
 * law sees it. */
static const struct {
  double nu;
  const char *section;
  int by_stress;
} turned[4] = {{0.45, "", 0},
               {0.45, "", 1},
               {0.4999, ", FORMULATION=AVERAGED", 0},
               {0.4999, ", FORMULATION=AVERAGED", 1}};

TESTS(errors_of_a_turned_tube, 4) {
  const double E = 1e5, nu = turned[_i].nu, p = 100, k = (1 + nu) / E * p / 3;
  char exact[400];
  if (turned[_i].by_stress)
    snprintf(exact, sizeof exact,
             "stress_rr, \"100/3*(1 - 4/r^2)\"\nstress_zz, %.17g\n"
             "stress_tt, \"100/3*(1 + 4/r^2)\"\nstress_rz, 0\n",
             nu * 200 / 3);
  else
    snprintf(exact, sizeof exact, "u_r, \"%.17g*r + %.17g/r\"\nu_z, 0\n",
             k * (1 - 2 * nu), 4 * k);
  JOB j = job_begin("tube");
  job_write(
      &j, "tube.geo",
      "Point(1) = {1, 0, 0}; Point(2) = {2, 0, 0};\n"
      "Point(3) = {2, 1, 0}; Point(4) = {1, 1, 0};\n"
      "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4};\n"
      "Line(4) = {4, 1}; Curve Loop(1) = {1:4};\n"
      "Plane Surface(1) = {1}; MeshSize{:} = 1/8.;\n"
      "Physical Curve(\"FACES\") = {1, 3};\n"
      "Physical Curve(\"HOLE\") = {4}; Physical Surface(\"BODY\") = {1};\n");
  job_write(&j, "tube.inp",
            "*MESH, FILE=tube.geo\n*MATERIAL, NAME=M\n*ELASTIC\n%g, %g\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=CAX3%s\n"
            "*REFERENCE\n%s*STEP\n*STATIC\n*BOUNDARY\nFACES, 2\n"
            "*DSLOAD\nHOLE, P, %g\n*ACCURACY, MESH=YES\n*END STEP\n",
            E, nu, turned[_i].section, exact, p);
  ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
  const double ratio = job_told(&j, "effectivity");
  ck_assert_msg(ratio > 0.95 && ratio < 1.05, "%g", ratio);
}

TEST(value_that_is_not_finite_is_an_error) {
  JOB j =
      job_with("truth", "tests/regression/mesh/square.geo",
               "*MESH, FILE=square.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1., 0.\n"
               "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n*REFERENCE\n"
               "u_x, \"log(x - 0.5)\"\nu_y, 0\n*STEP\n*STATIC\n*BOUNDARY\n"
               "BOTTOM, 1, 2\n*DSLOAD\nTOP, P, 1.\n*END STEP\n");
  ck_assert_int_eq(job_run(&j, ""), 2);
  ck_assert_ptr_nonnull(strstr(j.errors, "*REFERENCE: a value is not finite"));
}

UNIT_MAIN("reference")
