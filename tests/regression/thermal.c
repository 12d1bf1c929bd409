/*
 * Thermal strain: bars and blocks held between contacts (exact on every mesh),
 * a turned cylinder and a strip against their closed forms, gaps that close by
 * heat alone, temperatures that run through steps.
 *
 * E = 2e5, alpha = 1.2e-5, nu = 0.3 unless said otherwise: E alpha = 2.4.
 */
#include "support/job.h"
#include "support/unit.h"

#include <hdf5.h>

typedef struct scene {
  const char *geo, *numbers; /* mesh and lines for *PARAMETER                */
  double nu;
  const char *expansion, *section; /* card with its line; TYPE=               */
  const char *model, *steps;       /* cards of the model, and from *STEP on   */
} scene;

static job run_scene(const scene *s) {
  job j = job_begin("thermal");
  PRINTED(path, "tests/regression/mesh/%s", s->geo);
  job_copy(&j, path);
  job_write(&j, "thermal.inp",
            "*PARAMETER\n%s\n*MESH, FILE=%s\n*MATERIAL, NAME=M\n"
            "*ELASTIC\n2.E5, %.17g\n%s"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=%s\n%s%s",
            s->numbers, s->geo, s->nu, s->expansion, s->section, s->model,
            s->steps);
  CK_EXIT(job_run(&j, "--no-timing"), 0, j);
  return j;
}

#define ALPHA "*EXPANSION\n1.2E-5\n"
#define FLOOR                            \
  "*OBSTACLE, NAME=O, TYPE=CONFORMING\n" \
  "*CONTACT, NAME=F, GROUP=BOTTOM, OBSTACLE=O\n"
#define CEILING "*CONTACT, NAME=G, GROUP=TOP, OBSTACLE=O\n"
#define HEAT(dT) "*TEMPERATURE\nBODY, " #dT "\n"
#define STEP(cards)                           \
  "*STEP\n*STATIC\n" cards                    \
  "*PRINT, ELEMENTS, NODES, ENERGY, TOTALS\n" \
  "*END STEP\n"

/* Every element of the last table has that value, to 1e-10 of the scale. */
static void all_equal(const job *j, const char *column, double expected,
                      double scale) {
  DAT d = job_table(j, "ELEMENTS", -1);
  for (int i = 0; i < d.n_row; ++i)
    ck_assert_double_eq_tol(dat_at(&d, i, column), expected, 1e-10 * scale);
}

static void balanced(const job *j) {
  ck_assert_double_le(
      fabs(job_value(j, "ENERGY", -1, "energy_defect_relative")), 1e-10);
}

/* The forces of a body that expands freely on a floor are the rounding of those
 * of its heat: they lift nothing. */
TESTS(heat_alone_lifts_no_body, 2) {
  static const char *const size[] = {"N = 3", "N = 4"};
  scene s = {"square.geo",
             size[_i],
             0.3,
             ALPHA,
             "CPS3",
             FLOOR,
             "*STEP\n*QUASISTATIC\n0.25, 1.\n*BOUNDARY\nLEFT, 1\n" HEAT(
                 100.) "*PRINT, ELEMENTS\n*END STEP\n"};
  JOB j = run_scene(&s);
  all_equal(&j, "strain_yy", 1.2e-3, 1.2e-3);
  all_equal(&j, "stress_yy", 0, 240);
}

/* A free bar reaches a wall at the end of an increment: there the force is the
 * rounding of the gap, and later E (alpha dT - gap / length) by its height. */
TESTS(gap_closed_by_heat_at_an_increment, 3) {
  const double length[] = {1, 2, 5}, alpha[] = {1e-5, 1e-5, 2e-5};
  for (int n = 1; n <= 4; n *= 2) {
    const double gap = alpha[_i] * 125 * length[_i];
    JOB j =
        job_with("wall", "tests/regression/mesh/square.geo",
                 "*PARAMETER\nN = %d\nLX = %g\nKIND = 1\n"
                 "*MESH, FILE=square.geo\n*MATERIAL, NAME=M\n*ELASTIC\n"
                 "1000., 0.\n*EXPANSION\n%g\n"
                 "*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=CPS3\n"
                 "*OBSTACLE, NAME=O, TYPE=PLANE\n%.12g, 0.\n-1., 0.\n"
                 "*CONTACT, NAME=C, GROUP=RIGHT, OBSTACLE=O\n*STEP\n"
                 "*QUASISTATIC\n0.25, 1.\n*BOUNDARY\nLEFT, 1\nBOTTOM, 2\n"
                 "*TEMPERATURE\nBODY, \"500*t\"\n*PRINT, TOTALS\n*END STEP\n",
                 n, length[_i], alpha[_i], length[_i] + gap);
    int code = job_run(&j, "");
    ck_assert_msg(code == 0, "N = %d: exit %d: %s", n, code, j.errors);
    for (int k = 0; k < 4; ++k) {
      ck_assert_double_eq_tol(fabs(job_value(&j, "TOTALS", k, "force_x")),
                              1000 * alpha[_i] * 125 * k, 1e-9);
    }
  }
}

/* A bar between contacts carries -E alpha dT; the force is its height. */
TEST(bar_between_contacts) {
  scene s = {"square.geo",
             "N = 4",
             0.3,
             ALPHA,
             "CPS3",
             FLOOR CEILING,
             STEP("*BOUNDARY\nLEFT, 1\n" HEAT(100.))};
  JOB j = run_scene(&s);
  all_equal(&j, "stress_yy", -240.0, 240.0);
  all_equal(&j, "stress_xx", 0.0, 240.0);
  /* e_xx = alpha dT (1 + nu); e_zz the same. */
  all_equal(&j, "strain_xx", 1.56e-3, 1e-3);
  all_equal(&j, "strain_zz", 1.56e-3, 1e-3);
  DAT t = job_table(&j, "TOTALS", -1);
  for (int i = 0; i < 2; ++i)
    ck_assert_double_eq_tol(dat_at(&t, i, "normal"), 240.0, 1e-8);
  balanced(&j);
}

TEST(held_on_all_sides) {
  scene s = {"square.geo",
             "N = 4",
             0.3,
             ALPHA,
             "CPS3",
             FLOOR CEILING,
             STEP("*BOUNDARY\nLEFT, 1\nRIGHT, 1\n" HEAT(100.))};
  JOB biaxial = run_scene(&s);
  all_equal(&biaxial, "stress_xx", -240.0 / 0.7, 240.0);
  all_equal(&biaxial, "stress_yy", -240.0 / 0.7, 240.0);
  balanced(&biaxial);
  s.section = "CPE3";
  JOB confined = run_scene(&s);
  all_equal(&confined, "stress_xx", -600.0, 600.0);
  all_equal(&confined, "stress_yy", -600.0, 600.0);
  all_equal(&confined, "stress_zz", -600.0, 600.0);
  balanced(&confined);
  /* Its reactions where no stress is shown: of a quarter of a side. */
  s.steps = "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1\nRIGHT, 1\n" HEAT(
      100.) "*PRINT, REACTIONS\n*OUTPUT, HDF5=NO\n"
            "*ACCURACY, MESH=NO, SOLVER=NO\n*END STEP\n";
  JOB alone = run_scene(&s);
  ck_assert_double_eq_tol(job_max(&alone, "REACTIONS", -1, "reaction_x"), 150.0,
                          1e-9);
}

/* Nothing holds it back: strain without stress, also with one coefficient for
 * each axis and in a turned body. */
TEST(free_expansion_has_no_stress) {
  scene s = {"square.geo",
             "N = 4",
             0.3,
             "*EXPANSION, TYPE=ORTHO\n"
             "1.E-5, 2.E-5, 3.E-5\n",
             "CPS3",
             "",
             STEP("*BOUNDARY\nLEFT, 1\nBOTTOM, 2\n" HEAT(100.))};
  JOB j = run_scene(&s);
  static const char *const strain[] = {"strain_xx", "strain_yy", "strain_zz"};
  for (int c = 0; c < 3; ++c) {
    all_equal(&j, strain[c], 1e-3 * (c + 1), 1e-3);
    all_equal(&j, c == 0 ? "stress_xx" : "stress_yy", 0.0, 200.0);
  }
  s.expansion = ALPHA;
  s.section = "CAX3";
  s.steps = STEP("*BOUNDARY\nBOTTOM, 2\n" HEAT(100.));
  JOB axi = run_scene(&s);
  all_equal(&axi, "strain_tt", 1.2e-3, 1e-3);
  all_equal(&axi, "stress_tt", 0.0, 240.0);
}

/* The secants are counted from ZERO; the body has no strain at its initial
 * temperature: 2e-5 (120 - 20) - 1.5e-5 (70 - 20). */
TEST(secants_over_the_temperature) {
  scene s = {"square.geo",
             "N = 2",
             0.0,
             "*EXPANSION, ZERO=20.\n1.E-5, 20.\n"
             "2.E-5, 120.\n",
             "CPS3",
             "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nBODY, 70.\n",
             "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1\nBOTTOM, 2\n"
             "*TEMPERATURE\nBODY, 120.\n*PRINT, ELEMENTS\n*END STEP\n"
             "*STEP\n*STATIC\n*TEMPERATURE, OP=NEW\n*END STEP\n"};
  JOB j = run_scene(&s);
  DAT hot = job_table(&j, "ELEMENTS", 0), back = job_table(&j, "ELEMENTS", 1);
  ck_assert_double_eq_tol(dat_at(&hot, 0, "strain_yy"), 1.25e-3, 1e-15);
  ck_assert_double_eq_tol(dat_at(&hot, 0, "temperature"), 120.0, 1e-12);
  ck_assert_double_eq_tol(dat_at(&back, 0, "strain_yy"), 0.0, 1e-15);
  ck_assert_double_eq_tol(dat_at(&back, 0, "temperature"), 70.0, 1e-12);
}

/* Temperatures that are never the same: each element counts from its own, also
 * where the first elements do not expand. All of HARD gains 50 degrees. */
TEST(each_element_counts_from_its_own_temperature) {
  JOB j = job_with(
      "thermal", "tests/regression/mesh/layers.geo",
      "*PARAMETER\nN = 4\n*MESH, FILE=layers.geo\n*MATERIAL, NAME=COLD\n"
      "*ELASTIC\n2.E5, 0.\n*MATERIAL, NAME=M\n*ELASTIC\n2.E5, 0.\n"
      "*EXPANSION, TYPE=ORTHO\n0., 1.2E-5, 0.\n"
      "*SOLID SECTION, ELSET=SOFT, MATERIAL=COLD\n"
      "*SOLID SECTION, ELSET=HARD, MATERIAL=M\n"
      "*INITIAL CONDITIONS, TYPE=TEMPERATURE\n"
      "SOFT, \"300*x\"\nHARD, \"100*x + 70*y\"\n"
      "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1\nBOTTOM, 2\n*TEMPERATURE\n"
      "SOFT, 7.\nHARD, \"50 + 100*x + 70*y\"\n*PRINT, ELEMENTS\n"
      "*END STEP\n");
  CK_EXIT(job_run(&j, "--no-timing"), 0, j);
  all_equal(&j, "stress_yy", 0.0, 240.0);
  DAT d = job_table(&j, "ELEMENTS", -1);
  for (int i = 0; i < d.n_row; ++i)
    ck_assert_double_eq_tol(dat_at(&d, i, "strain_yy"),
                            dat_at(&d, i, "y") > 0.5 ? 6e-4 : 0.0, 1e-14);
}

/* From 10 to 30 in a step of 1 by default, then with an amplitude to 60 and
 * back, kept in the step that says nothing. */
TEST(temperatures_run_through_the_steps) {
  scene s = {"square.geo",
             "N = 2",
             0.0,
             ALPHA,
             "CPS3",
             "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nBODY, \"10 + 0*x\"\n"
             "*AMPLITUDE, NAME=A\n0., 0.5, 1., 1.\n",
             "*STEP\n*QUASISTATIC\n0.5, 1.\n*BOUNDARY\nLEFT, 1\nBOTTOM, 2\n"
             "*TEMPERATURE\nBODY, 30.\n*PRINT, ELEMENTS, ENERGY\n*END STEP\n"
             "*STEP\n*QUASISTATIC\n0.5, 1.\n*TEMPERATURE, AMPLITUDE=A\n"
             "BODY, 60.\n*END STEP\n"
             "*STEP\n*STATIC\n*END STEP\n"
             "*STEP\n*QUASISTATIC\n0.5, 1.\n*TEMPERATURE\nBODY, 20.\n"
             "*END STEP\n"};
  static const double expected[] = {20, 30, 45, 60, 60, 40, 20};
  JOB j = run_scene(&s);
  for (int k = 0; k < 7; ++k) {
    DAT d = job_table(&j, "ELEMENTS", k);
    ck_assert_double_eq_tol(dat_at(&d, 0, "temperature"), expected[k], 1e-11);
    ck_assert_double_eq_tol(dat_at(&d, 0, "strain_xx"),
                            1.2e-5 * (expected[k] - 10.0), 1e-14);
  }
}

/* Mean of a column over the last table of the elements of a group: the tables
 * of the groups follow each other, "back" of them from the end. */
static double group_mean(const job *j, const char *column, int back) {
  DAT d = job_table(j, "ELEMENTS", 2 - back);
  return dat_sum(&d, column) / d.n_row;
}

#define THREE_PLACES                                                \
  "*PRINT, ELEMENTS, GROUP=FIRST\n*PRINT, ELEMENTS, GROUP=MIDDLE\n" \
  "*PRINT, ELEMENTS, GROUP=LAST\n*END STEP\n"

/* Radii 1 and 2, 100 degrees inside, none outside, plane strain (Timoshenko,
 * Goodier 1970, article 151). */
TEST(cylinder_with_a_logarithmic_profile) {
  scene s = {"strips.geo",
             "N = 201\nX0 = 1\nLY = 1/201",
             0.3,
             ALPHA,
             "CAX3",
             "",
             "*STEP\n*STATIC\n*BOUNDARY\nBOTTOM, 2\nTOP, 2\n"
             "*TEMPERATURE\nBODY, \"100*log(2/x)/log(2)\"\n" THREE_PLACES};
  JOB j = run_scene(&s);
  const double scale = 209.82370728;
  ck_assert_double_eq_tol(group_mean(&j, "stress_tt", 2), -209.82370728,
                          0.01 * scale);
  ck_assert_double_eq_tol(group_mean(&j, "stress_tt", 1), 17.43970555,
                          0.01 * scale);
  ck_assert_double_eq_tol(group_mean(&j, "stress_rr", 1), -26.70484115,
                          0.002 * scale);
  ck_assert_double_eq_tol(group_mean(&j, "stress_tt", 0), 133.03343558,
                          0.01 * scale);
}

/* Half of a free strip of height 2, temperature 100 (1 - x^2) across: the
 * stress along it is 240 (x^2 - 1/3), tension at the cold surface: +160, -80.
 * Its far end is free: five heights away. */
TEST(strip_with_a_parabolic_profile) {
  scene s = {"strips.geo",
             "N = 101\nM = 60\nLY = 5",
             0.3,
             ALPHA,
             "CPS3",
             "",
             "*STEP\n*STATIC\n*BOUNDARY\nBOTTOM, 2\nLEFT, 1\n"
             "*TEMPERATURE\nBODY, \"100*(1 - x^2)\"\n"
             "*PRINT, ELEMENTS, GROUP=FIRST\n*PRINT, ELEMENTS, GROUP=LAST\n"
             "*END STEP\n"};
  JOB j = run_scene(&s);
  DAT centre = job_table(&j, "ELEMENTS", 0), top = job_table(&j, "ELEMENTS", 1);
  double at_centre = 0.0, at_surface = 0.0;
  for (int i = 0; i < centre.n_row; ++i)
    at_centre = fmin(at_centre, dat_at(&centre, i, "stress_yy"));
  for (int i = 0; i < top.n_row; ++i)
    at_surface = fmax(at_surface, dat_at(&top, i, "stress_yy"));
  ck_assert_double_eq_tol(at_centre, -80.0, 0.02 * 160.0);
  ck_assert_double_eq_tol(at_surface, 160.0, 0.02 * 160.0);
}

/* Block of height 1 under a fixed top, "gap" above the floor, heated by dT:
 * -E (alpha dT - gap) where that is positive. */
static void closing(double gap, const char *heat, double expected) {
  PRINTED(model,
          "*OBSTACLE, NAME=O, TYPE=PLANE\n0., %.17g\n0., 1.\n"
          "*CONTACT, NAME=F, GROUP=BOTTOM, OBSTACLE=O\n",
          -gap);
  PRINTED(steps,
          "*STEP\n*STATIC\n*BOUNDARY\nTOP, 2\nLEFT, 1\n%s"
          "*PRINT, ELEMENTS, CONTACT, ENERGY\n*END STEP\n",
          heat);
  scene s = {"square.geo", "N = 4", 0.0, ALPHA, "CPE3", model, steps};
  JOB j = run_scene(&s);
  /* Held by the plane strain too, zz does not matter: nu = 0. */
  all_equal(&j, "stress_yy", expected, 240.0);
  DAT c = job_table(&j, "CONTACT", -1);
  ck_assert_double_eq_tol(dat_sum(&c, "f_n"), -expected, 1e-7);
  for (int i = 0; i < c.n_row; ++i)
    ck_assert_double_eq_tol(dat_at(&c, i, "gap"), 0.0, 1e-13);
}

/* Temperature x in plane strain: u = (1 + nu) alpha (x^2 - y^2, 2 x y)/2 has no
 * stress in the plane. Without compressibility the pressures must not take the
 * differences within a cluster for strain. */
TESTS(linear_temperature_leaves_averaged_bodies_free, 4) {
  static const double nu[] = {0.3, 0.45, 0.499, 0.4999};
  PRINTED(steps,
          STEP("*BOUNDARY\nBOTTOM, 2\n"
               "LEFT, 1, 1, \"-0.6E-5*(1 + %g)*y^2\"\n"
               "*TEMPERATURE\nBODY, \"x\"\n"),
          nu[_i]);
  scene s = {"square.geo", "N = 8", nu[_i], ALPHA, "CPE3, FORMULATION=AVERAGED",
             "",           steps};
  JOB j = run_scene(&s);
  DAT d = job_table(&j, "ELEMENTS", -1);
  for (int i = 0; i < d.n_row; ++i) { /* of E alpha, an eighth each element */
    ck_assert_double_eq_tol(dat_at(&d, i, "stress_xx"), 0, 0.1 * 2.4);
    ck_assert_double_eq_tol(dat_at(&d, i, "stress_yy"), 0, 0.1 * 2.4);
  }
  balanced(&j);
}

TEST(heat_closes_the_gap) {
  closing(1e-3, HEAT(100.), -40.0);
  closing(1e-3, "*TEMPERATURE\nBODY, \"1e-3/1.2e-5\"\n", 0.0);
}

TEST(penetration_at_the_start) { closing(-1e-4, "", -20.0); }

enum { N_NODE = 9 };

/* 100 + 10 number of the node, as text, as gmsh writes binary, as HDF5. */
static void write_text_field(const char *path) {
  FILE *f = fopen(path, "w");
  ck_assert_ptr_nonnull(f);
  fputs(
      "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$NodeData\n1\n\"T\"\n1\n0.0\n"
      "3\n0\n1\n9\n",
      f);
  for (int i = N_NODE; i > 0; --i) fprintf(f, "%d %d\n", i, 100 + 10 * i);
  fputs("$EndNodeData\n", f);
  fclose(f);
}

static void write_binary_field(const char *path) {
  const int one = 1;
  FILE *f = fopen(path, "wb");
  ck_assert_ptr_nonnull(f);
  fputs("$MeshFormat\n2.2 1 8\n", f);
  fwrite(&one, sizeof one, 1, f);
  fputs("\n$EndMeshFormat\n$NodeData\n1\n\"T\"\n1\n0.0\n3\n0\n1\n9\n", f);
  for (int i = 1; i <= N_NODE; ++i) {
    const double value = 100 + 10 * i;
    fwrite(&i, sizeof i, 1, f);
    fwrite(&value, sizeof value, 1, f);
  }
  fputs("\n$EndNodeData\n", f);
  fclose(f);
}

static void write_items(hid_t file, const char *name, hid_t type, int n,
                        const void *items) {
  const hsize_t size = (hsize_t)n;
  hid_t space = H5Screate_simple(1, &size, NULL);
  hid_t set = H5Dcreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT,
                         H5P_DEFAULT);
  H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, items);
  H5Dclose(set);
  H5Sclose(space);
}

static void write_temperatures(const char *path, int n) {
  int no[N_NODE];
  double value[N_NODE + 1];
  for (int i = 0; i < n; ++i) value[i] = 110 + 10 * i;
  for (int i = 0; i < N_NODE; ++i) no[i] = i + 1;
  hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  write_items(file, "node_no", H5T_NATIVE_INT, N_NODE, no);
  write_items(file, "temperature", H5T_NATIVE_DOUBLE, n, value);
  H5Fclose(file);
}

static void write_hdf5_field(const char *path) {
  write_temperatures(path, N_NODE);
}

/* Temperatures of a file, half of them in half the step; elements have the
 * mean of their nodes: 1 2 5 make the first, 2 3 6 the third. Copies that a
 * crack makes, the last time, have those of their nodes. */
TEST(temperatures_from_a_file) {
  static const char *const name[] = {"t.msh", "b.msh", "t.h5", "t.msh"};
  static void (*const write[])(const char *) = {
      write_text_field, write_binary_field, write_hdf5_field, write_text_field};
  for (int k = 0; k < 4; ++k) {
    JOB j = job_begin("field");
    job_copy(&j, "tests/regression/bad/square.msh");
    PRINTED(path, "%s/%s", j.dir, name[k]);
    write[k](path);
    job_write(&j, "field.inp",
              "*MESH, FILE=square.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1., 0.\n"
              "*EXPANSION\n1.E-5\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n%s"
              "*STEP\n*QUASISTATIC\n0.5, 1.\n*BOUNDARY\nLEFT, 1, 2\n"
              "RIGHT, 1, 2\n"
              "*TEMPERATURE, FILE=%s\nBODY\n*PRINT, ELEMENTS\n*END STEP\n"
              "*STEP\n*QUASISTATIC\n0.5, 1.\n*TEMPERATURE\nBODY, 0.\n"
              "*END STEP\n"
              "*STEP\n*STATIC\n*TEMPERATURE, FILE=%s\nBODY, 2.\n*END STEP\n",
              k == 3 ? "*CRACK, NAME=C, GROUP=MIDDLE\n" : "", name[k], name[k]);
    int code = job_run(&j, "");
    ck_assert_msg(code == 0, "%s: exit %d: %s", name[k], code, j.errors);
    const double mean[] = {100 + 10 * (1 + 2 + 5) / 3.0,
                           100 + 10 * (2 + 3 + 6) / 3.0};
    static const double part[] = {0.5, 1.0, 0.5, 0.0, 2.0};
    for (int i = 0; i < 10; ++i) {
      dat d = job_table(&j, "ELEMENTS", i / 2);
      double found = dat_at(&d, dat_row_near(&d, "elem_no", 12 + i % 2 * 2),
                            "temperature");
      ck_assert_double_eq_tol(found, part[i / 2] * mean[i % 2], 1e-11);
      dat_free(&d);
    }
  }
}

/* A field that is cut, or has a node twice, is no field. */
TEST(damaged_fields_are_refused) {
  JOB j =
      job_with("field", "tests/regression/bad/square.msh",
               "*MESH, FILE=square.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1., 0.\n"
               "*EXPANSION\n1.E-5\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
               "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1, 2\n"
               "*TEMPERATURE, FILE=t.msh\nBODY\n*END STEP\n");
  static void (*const write[])(const char *) = {write_text_field,
                                                write_binary_field};
  PRINTED(path, "%s/t.msh", j.dir);
  for (int k = 0; k < 2; ++k) {
    write[k](path);
    char text[1024];
    FILE *whole = fopen(path, "rb");
    size_t size = fread(text, 1, sizeof text, whole);
    fclose(whole);
    ck_assert_int_eq(job_run(&j, "--check"), 0);
    for (size_t cut = size - 30; cut < size - 1; ++cut) {
      FILE *f = fopen(path, "wb");
      fwrite(text, 1, cut, f);
      fclose(f);
      ck_assert_msg(job_run(&j, "--check") == 2, "%d: cut at %zu of %zu", k,
                    cut, size);
    }
  }
  static const struct {
    const char *values, *message;
  } cases[] = {
      {"9\n1 1\n2 2\n3 3\n4 4\n5 5\n6 6\n7 7\n8 8\n8 9\n",
       "t.msh: node 8 is listed twice"},
      {"8\n1 1\n2 2\n3 3\n4 4\n5 5\n6 6\n7 7\n8 8\n9 9\n",
       "t.msh:21: \"9\" where $EndNodeData"},
      {"10\n1 1\n2 2\n3 3\n4 4\n5 5\n6 6\n7 7\n8 8\n9 9\n",
       "t.msh:22: \"$EndNodeData\" where a whole number"},
      {"9\n1 1\n2 2\n3 3\n4 4\n5 5\n6 6\n7 7\n8 8\n9 9.5.1\n",
       "t.msh:21: \"9.5.1\" where a number"},
      {"9\n1 1\n2 2\n3 3\n4 4\n5 5\n6 6\n7 7\n8 8\n9 nan\n",
       "t.msh: the value of node 9 is not a finite number"},
      {"2000000000\n1 1\n", "t.msh:13: 2000000000 values do not fit"},
  };
  for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
    job_write(&j, "t.msh",
              "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$NodeData\n1\n\"T\"\n1\n"
              "0.0\n3\n0\n1\n%s$EndNodeData\n",
              cases[i].values);
    ck_assert_int_eq(job_run(&j, "--check"), 2);
    ck_assert_msg(strstr(j.errors, cases[i].message) != NULL, "%s", j.errors);
  }
  for (int n = N_NODE - 1; n <= N_NODE + 1; n += 2) {
    PRINTED(message, "/node_no has %d items, /temperature %d", N_NODE, n);
    write_temperatures(path, n);
    ck_assert_int_eq(job_run(&j, "--check"), 2);
    ck_assert_msg(strstr(j.errors, message) != NULL, "%s", j.errors);
  }
}

/* Without *TEMPERATURE nothing of it is done or held. */
TEST(costs_nothing_when_not_called) {
  scene s = {"square.geo",
             "N = 2",
             0.3,
             ALPHA,
             "CPE3",
             "",
             STEP("*BOUNDARY\nLEFT, 1, 2\n*DSLOAD\nRIGHT, TX, 1.\n")};
  JOB j = run_scene(&s);
  FREED char *lst = job_file(&j, "lst");
  ck_assert_ptr_nonnull(strstr(lst, "thermal strain"));
  ck_assert_ptr_nonnull(strstr(lst, "no *TEMPERATURE card"));
  const char *line = strstr(lst, "\n  thermal strains ");
  ck_assert_ptr_nonnull(line);
  ck_assert_int_eq(atoi(line + 19), 0);
}

/* Without a load a block that shrinks leaves its floor about its middle, with
 * friction or without. */
TESTS(shrinking_block_keeps_its_place, 2) {
  JOB j =
      job_with("shrinks", "tests/regression/mesh/square.geo",
               "*MESH, FILE=square.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1E3, 0.3\n"
               "*EXPANSION\n0.001\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
               "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
               "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n%s"
               "*AMPLITUDE, NAME=W, TIME=TOTAL TIME\n0., 0., 1., 1., 2., 3.\n"
               "*AMPLITUDE, NAME=A\n0., 0., 0.5, 1., 1., 0.\n"
               "*STEP\n*QUASISTATIC\n0.25, 1.\n*BOUNDARY\nLEFT, 1\n"
               "*DSLOAD\nTOP, P, 0.1, A\n*TEMPERATURE\nBODY, -1., W\n"
               "*PRINT, CONTACT\n*END STEP\n"
               "*STEP\n*QUASISTATIC\n0.5, 1.\n*END STEP\n",
               _i ? "*FRICTION, CONTACT=C, LAW=COULOMB\n0.1\n" : "");
  ck_assert_msg(job_run(&j, "--quiet") == 0, "%s", j.errors);
  DAT c = job_table(&j, "CONTACT", -1);
  for (int i = 0; i < c.n_row; ++i)
    ck_assert_double_eq_tol(dat_at(&c, i, "gap"), 1.44e-3, 2e-6);
}

UNIT_MAIN("thermal")
