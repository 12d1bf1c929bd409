/*
 * Moduli that depend on temperature: the stress is that of the strain from the
 * free state with the moduli of now, sigma = E(T) (e - e^i - e^th(T)), whatever
 * way the temperature took. Homogeneous bodies, exact on every mesh.
 *
 * E falls from 2e5 at 0 to 1e5 at 200 degrees, nu = 0.3, unless said otherwise.
 */
#include "support/job.h"
#include "support/unit.h"

const int job_without_fields = 1;

typedef struct scene {
  const char *geo, *elastic, *more; /* mesh; lines of *ELASTIC; cards         */
  const char *section, *model;      /* TYPE=; cards before the first step     */
  const char *steps;                /* from *STEP on                          */
} scene;

static job run_scene(const scene *s, int expected) {
  job j = job_begin("moduli");
  PRINTED(path, "tests/regression/mesh/%s", s->geo);
  job_copy(&j, path);
  job_write(&j, "moduli.inp",
            "*PARAMETER\nN = 2\n*MESH, FILE=%s\n*MATERIAL, NAME=M\n*ELASTIC\n"
            "%s\n%s*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=%s\n%s%s",
            s->geo, s->elastic, s->more, s->section, s->model, s->steps);
  CK_EXIT(job_run(&j, "--no-timing"), expected, j);
  return j;
}

#define SOFTENING "2.E5, 0.3, 0.\n1.E5, 0.3, 200."
#define ALPHA "*EXPANSION\n1.2E-5\n"
#define JAWS                                     \
  "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"         \
  "*CONTACT, NAME=F, GROUP=BOTTOM, OBSTACLE=O\n" \
  "*CONTACT, NAME=G, GROUP=TOP, OBSTACLE=O\n"
#define TABLES "*PRINT, ELEMENTS, NODES, ENERGY, TOTALS\n"
#define SYMMETRY "*BOUNDARY\nLEFT, 1\nBOTTOM, 2\n"

/* All elements of table number k, to 1e-10 of the scale. */
static void all_are(const job *j, int k, const char *column, double expected,
                    double tolerance) {
  DAT d = job_table(j, "ELEMENTS", k);
  for (int i = 0; i < d.n_row; ++i)
    ck_assert_msg(fabs(dat_at(&d, i, column) - expected) <= tolerance,
                  "%s of table %d: %.12g, expected %.12g", column, k,
                  dat_at(&d, i, column), expected);
}

static void balanced(const job *j, int k) {
  ck_assert_double_le(fabs(job_value(j, "ENERGY", k, "energy_defect_relative")),
                      1e-10);
}

static double bar_stress(double T) {
  return -(2e5 - 1e5 * fmin(fmax(T, 0), 200) / 200) * 1.2e-5 * T;
}

/* Up to 200, back to 50 and to 0, in steps of each kind; an increment in the
 * middle of each. Nothing is left of what the hot body has seen. */
TEST(a_bar_forgets_the_way_of_its_temperature) {
  static const char *const kinds[] = {
      "*QUASISTATIC\n0.5, 1.\n", "*QUASISTATIC, FORM=VELOCITY\n0.5, 1.\n",
      "*VISCO, INTEGRATOR=MIDPOINT\n0.5, 1.\n", "*STATIC\n"};
  static const double T[] = {100, 200, 125, 50, 25, 0};
  for (size_t k = 0; k < sizeof kinds / sizeof *kinds; ++k) {
    int whole = strcmp(kinds[k], "*STATIC\n") == 0;
    PRINTED(steps,
            "*STEP\n%s*BOUNDARY\nLEFT, 1\n*TEMPERATURE\nBODY, 200.\n" TABLES
            "*END STEP\n*STEP\n%s*TEMPERATURE\nBODY, 50.\n" TABLES
            "*END STEP\n*STEP\n%s*TEMPERATURE\nBODY, 0.\n" TABLES "*END STEP\n",
            kinds[k], kinds[k], kinds[k]);
    scene s = {"square.geo", SOFTENING, ALPHA, "CPS3", JAWS, steps};
    JOB j = run_scene(&s, 0);
    for (int i = 0; i < (whole ? 3 : 6); ++i) {
      double at = T[whole ? 2 * i + 1 : i];
      all_are(&j, i, "stress_yy", bar_stress(at), 1e-8);
      all_are(&j, i, "stress_xx", 0, 1e-8);
      all_are(&j, i, "strain_xx", 1.2e-5 * 1.3 * at, 1e-12);
      balanced(&j, i);
    }
    ck_assert_double_eq_tol(job_value(&j, "TOTALS", 0, "normal"),
                            -bar_stress(T[whole]), 1e-8);
  }
}

/* Confined: -E/(1 - 2 nu) alpha dT with nu from 0.3 to 0.4 as well, and secants
 * alpha from 1.2e-5 to 2.4e-5; in plane strain, axisymmetry and 3-D. */
TEST(confined_bodies) {
  static const char *const geo[] = {"square.geo", "square.geo", "cube.geo"};
  static const char *const section[] = {"CPE3", "CAX3", "C3D4"};
  static const char *const walls[] = {
      "LEFT, 1\nRIGHT, 1\nBOTTOM, 2\nTOP, 2\n", "RIGHT, 1\nBOTTOM, 2\nTOP, 2\n",
      "LEFT, 1\nRIGHT, 1\nFRONT, 2\nBACK, 2\nBOTTOM, 3\nTOP, 3\n"};
  static const double T[] = {75, 150};
  for (int k = 0; k < 3; ++k) {
    PRINTED(steps,
            "*STEP\n*QUASISTATIC\n0.5, 1.\n*BOUNDARY\n%s*TEMPERATURE\n"
            "BODY, 150.\n*PRINT, ELEMENTS, ENERGY\n*END STEP\n",
            walls[k]);
    scene s = {geo[k],
               "2.E5, 0.3, 0.\n1.E5, 0.4, 200.",
               "*EXPANSION\n1.2E-5, 0.\n2.4E-5, 200.\n",
               section[k],
               "",
               steps};
    JOB j = run_scene(&s, 0);
    for (int i = 0; i < 2; ++i) {
      double part = T[i] / 200, E = 2e5 - 1e5 * part, nu = 0.3 + 0.1 * part;
      double p = -E / (1 - 2 * nu) * 1.2e-5 * (1 + part) * T[i];
      all_are(&j, i, k == 1 ? "stress_rr" : "stress_xx", p, 1e-10 * fabs(p));
      all_are(&j, i, k == 1 ? "stress_tt" : "stress_zz", p, 1e-10 * fabs(p));
      balanced(&j, i);
    }
  }
}

/* A held load: the body gives way as it gets soft; no expansion. */
TEST(a_loaded_bar_gives_way) {
  scene s = {"square.geo",
             SOFTENING,
             "",
             "CPS3",
             "",
             "*STEP\n*STATIC\n" SYMMETRY "*DSLOAD\nTOP, TY, 100.\n" TABLES
             "*END STEP\n*STEP\n*QUASISTATIC\n0.25, 1.\n*TEMPERATURE\n"
             "BODY, 400.\n" TABLES
             "*END STEP\n*STEP\n*QUASISTATIC\n"
             "0.25, 1.\n*TEMPERATURE\nBODY, 0.\n" TABLES "*END STEP\n"};
  static const double E[] = {2e5, 1.5e5, 1e5, 1e5, 1e5, 1e5, 1e5, 1.5e5, 2e5};
  JOB j = run_scene(&s, 0);
  for (int i = 0; i < 9; ++i) {
    all_are(&j, i, "stress_yy", 100, 1e-8);
    all_are(&j, i, "strain_yy", 100 / E[i], 1e-13);
    balanced(&j, i);
  }
  /* One factor for each change: 0, 100 and 200 degrees, back to 100 and
   * 0; none beyond. */
  ck_assert_int_eq(job_stage(&j, "factorisation", NULL), 5);
}

/* Layers of other temperatures and thicknesses, 1 and 3, that expand across
 * alone: the force f is that of both, sum of h (f/(E thickness) + alpha T) = 0.
 */
static void layers_push(const job *j, int k, double f) {
  DAT e = job_table(j, "ELEMENTS", k), t = job_table(j, "TOTALS", k);
  for (int i = 0; i < e.n_row; ++i)
    ck_assert_double_eq_tol(dat_at(&e, i, "stress_yy"),
                            dat_at(&e, i, "y") > 0.5 ? f / 3 : f, 1e-8);
  ck_assert_double_eq_tol(dat_at(&t, 0, "normal"), -f, 1e-8);
}

TEST(each_element_has_its_temperature) {
  JOB j = job_with(
      "moduli", "tests/regression/mesh/layers.geo",
      "*PARAMETER\nN = 4\n*MESH, FILE=layers.geo\n*MATERIAL, NAME=M\n"
      "*ELASTIC\n2.E5, 0., 0.\n1.E5, 0., 200.\n"
      "*EXPANSION, TYPE=ORTHO\n0., 1.2E-5, 0.\n"
      "*SOLID SECTION, ELSET=SOFT, MATERIAL=M\n"
      "*SOLID SECTION, ELSET=HARD, MATERIAL=M, THICKNESS=3.\n" JAWS
      "*STEP\n*QUASISTATIC\n0.5, 1.\n*BOUNDARY\nLEFT, 1\n*TEMPERATURE\n"
      "SOFT, 200.\nHARD, 40.\n*PRINT, ELEMENTS, TOTALS, ENERGY\n"
      "*ACCURACY, MESH=YES\n*END STEP\n");
  CK_EXIT(job_run(&j, "--no-timing"), 0, j);
  layers_push(&j, 1, -1.2e-5 * 240 / (1 / 1e5 + 1 / 1.8e5 / 3));
  layers_push(&j, 0, -1.2e-5 * 120 / (1 / 1.5e5 + 1 / 1.9e5 / 3));
  balanced(&j, 1);
}

/* Slip patch (nu = 0, top moved by 0.01, pressed by 0.01, mu = 0.3) heated from
 * E = 2000 to 1000: at 2000 with shear 6 the foot slips by 0.004, and stays
 * where it is while all forces fall to half. */
TEST(friction_follows_the_moduli) {
  scene s = {"square.geo",
             "2000., 0., 0.\n1000., 0., 100.",
             "",
             "CPE3",
             "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
             "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
             "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n",
             "*STEP\n*QUASISTATIC\n1., 1.\n*BOUNDARY\nTOP, 1, 1, 0.01\n"
             "TOP, 2, 2, -0.01\n*DSLOAD\nRIGHT, TY, 6.\nLEFT, TY, -6.\n"
             "*END STEP\n*STEP\n*QUASISTATIC\n0.2, 1.\n*TEMPERATURE\nBODY, "
             "100.\n*DSLOAD\nRIGHT, TY, 3.\nLEFT, TY, -3.\n"
             "*PRINT, CONTACT, ENERGY, ELEMENTS\n*END STEP\n"};
  JOB j = run_scene(&s, 0);
  for (int k = 0; k < 5; ++k) {
    double half = 1 - 0.1 * (k + 1);
    DAT c = job_table(&j, "CONTACT", k);
    for (int i = 0; i < c.n_row; ++i) {
      ck_assert_double_eq_tol(dat_at(&c, i, "u_t"), 0.004, 1e-10);
      ck_assert_double_eq_tol(dat_at(&c, i, "f_x"), -0.3 * dat_at(&c, i, "f_n"),
                              1e-9);
    }
    all_are(&j, k, "stress_yy", -20 * half, 1e-9);
    balanced(&j, k);
  }
  FREED char *lst = job_file(&j, "lst");
  ck_assert_ptr_null(strstr(lst, "JUMP"));
}

/* Maxwell body, tau = 2, held strain: e - e^i = e exp(-t/tau) whatever E does,
 * so that sigma = E(T) e exp(-t/tau); under a held stress s, de^i/dt =
 * s/(E tau). 100 degrees in 2 s: E = 2e5 (1 - t/8). */
TEST(inelastic_strains_under_changing_moduli) {
  static const struct {
    const char *words;
    double tolerance;
  } rows[] = {{"RK4\n0.1", 1e-6},
              {"HEUN\n0.02", 3e-4},
              {"MIDPOINT\n0.02", 1e-4},
              {"MIDPOINT, ITERATION=INITIAL\n0.02", 1e-4},
              {"BACKWARD\n0.01", 1e-2}};
  for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k)
    for (int held = 0; held < 2; ++held) {
      PRINTED(steps,
              "*STEP\n*STATIC\n" SYMMETRY
              "%s*END STEP\n*STEP\n"
              "*VISCO, INTEGRATOR=%s, 2.\n*TEMPERATURE\nBODY, 100.\n"
              "*PRINT, ELEMENTS, ENERGY, FREQUENCY=0\n*END STEP\n",
              held ? "TOP, 2, 2, 1.E-3\n" : "*DSLOAD\nTOP, TY, 200.\n",
              rows[k].words);
      scene s = {"square.geo", SOFTENING, "*INELASTIC, LAW=MAXWELL\n2.\n",
                 "CPS3",       "",        steps};
      JOB j = run_scene(&s, 0);
      if (held)
        all_are(&j, 0, "stress_yy", 1.5e5 * 1e-3 * exp(-1.0),
                rows[k].tolerance * 150 * exp(-1.0));
      else
        all_are(&j, 0, "strain_yy", 200 / 1.5e5 + 200 / 4e5 * 8 * log(4 / 3.),
                rows[k].tolerance * 1e-3);
      balanced(&j, 0);
    }
}

/* One section, 0 degrees below and 200 above, nu = 0, pulled by 200 for as long
 * as its unit or relaxation time: e^i = 200/E1 (1 - exp(-1)) or 200/E, each of
 * its own temperature. */
TESTS(points_of_one_section_have_their_temperatures, 2) {
  JOB j = job_with(
      "moduli", "tests/regression/mesh/layers.geo",
      "*PARAMETER\nN = 2\n*MESH, FILE=layers.geo\n"
      "*MATERIAL, NAME=M\n*ELASTIC\n2.E5, 0., 0.\n"
      "1.E5, 0., 200.\n*INELASTIC, LAW=%s\n"
      "*SOLID SECTION, ELSET=ALL, MATERIAL=M, TYPE=CPS3\n"
      "*STEP\n*STATIC\n" SYMMETRY
      "*DSLOAD\nTOP, TY, 200.\n"
      "*TEMPERATURE\nSOFT, 0.\nHARD, 200.\n*END STEP\n"
      "*STEP\n*VISCO, INTEGRATOR=RK4\n0.1, 1.\n"
      "*PRINT, ELEMENTS, ENERGY, FREQUENCY=0\n*END STEP\n",
      _i == 0 ? "ZENER\n1.E5, 1.E5, 0.\n5.E4, 5.E4, 200." : "MAXWELL\n1.");
  CK_EXIT(job_run(&j, "--no-timing"), 0, j);
  DAT d = job_table(&j, "ELEMENTS", 0);
  const double late = 1 - exp(-1.0), ei = _i == 0 ? 2e-3 * late : 1e-3;
  int n[2] = {0, 0};
  for (int i = 0; i < d.n_row; ++i) {
    const int hot = dat_at(&d, i, "y") > 0.5;
    ck_assert_double_eq_tol(dat_at(&d, i, "strain_yy"),
                            (hot ? 2 : 1) * (1e-3 + ei), 1e-8);
    ++n[hot];
  }
  ck_assert(n[0] > 0 && n[1] > 0);
  ck_assert_double_eq_tol(job_value(&j, "ENERGY", 0, "inelastic_stored"),
                          _i == 0 ? 0.3 * late * late : 0, 1e-6);
  balanced(&j, 0);
}

/* The exponential integrator is not exact for them; sets in the wrong order,
 * one without its temperature, no temperature at all. */
TEST(what_is_refused_or_told) {
  static const struct {
    const char *elastic, *more, *visco, *says;
    int code;
  } rows[] = {
      {SOFTENING, "*INELASTIC, LAW=MAXWELL\n2.\n",
       "*VISCO, INTEGRATOR=EXPONENTIAL\n0.1, 1.\n*TEMPERATURE\nBODY, 9.\n",
       "P2054", 2},
      {"2.E5, 0.3, 20.\n1.E5, 0.3, 10.", "", "*STATIC\n", "P2029", 2},
      {"2.E5, 0.3, 20.\n1.E5, 0.3", "", "*STATIC\n", "P2009", 2},
      {"2.E5, 0.3\n1.E5, 0.3", "", "*STATIC\n", "P2009", 2},
      {"2.E5, 0.3, 20., 7.", "", "*STATIC\n", "P2009", 2},
      {"2.E5, 0.3, 0.\n1.E5, 0.6, 20.", "", "*STATIC\n", "P2013", 2},
      {SOFTENING, "", "*STATIC\n", "P2049", 0}};
  for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
    PRINTED(steps,
            "*STEP\n%s" SYMMETRY
            "*DSLOAD\nTOP, TY, 1.\n*PRINT, ELEMENTS\n"
            "*END STEP\n",
            rows[k].visco);
    scene s = {"square.geo", rows[k].elastic, rows[k].more, "CPS3", "", steps};
    JOB j = run_scene(&s, rows[k].code);
    ck_assert_msg(strstr(j.errors, rows[k].says) != NULL ||
                      strstr(j.text, rows[k].says) != NULL,
                  "row %zu: %s%s", k, j.errors, j.text);
    if (rows[k].code == 0) all_are(&j, 0, "strain_yy", 1 / 2e5, 1e-16);
  }
}

/* One half of a block is a hundred times stiffer when it is warm: the error of
 * the mesh after a cold step is that of a run which was warm from the start. */
TEST(error_of_the_mesh_is_that_of_the_moduli_now) {
  double told[2];
  for (int k = 0; k < 2; ++k) {
    JOB j = job_begin("halves");
    job_write(&j, "halves.geo",
              "h = 0.25;\nPoint(1) = {0, 0, 0, h};\nPoint(2) = {1, 0, 0, h};\n"
              "Point(3) = {2, 0, 0, h};\nPoint(4) = {2, 1, 0, h};\n"
              "Point(5) = {1, 1, 0, h};\nPoint(6) = {0, 1, 0, h};\n"
              "For k In {1 : 6}\n  Line(k) = {k, k %% 6 + 1};\nEndFor\n"
              "Line(7) = {2, 5};\nCurve Loop(1) = {1, 7, 5, 6};\n"
              "Curve Loop(2) = {2, 3, 4, -7};\nPlane Surface(1) = {1};\n"
              "Plane Surface(2) = {2};\nPhysical Surface(\"ONE\") = {1};\n"
              "Physical Surface(\"OTHER\") = {2};\n"
              "Physical Curve(\"FOOT\") = {1, 2};\n"
              "Physical Curve(\"TOP\") = {4, 5};\n");
    job_write(&j, "halves.inp",
              "*MESH, FILE=halves.geo\n*MATERIAL, NAME=M\n*ELASTIC\n"
              "1000., 0.3, 0.\n1.E5, 0.3, 100.\n*MATERIAL, NAME=S\n*ELASTIC\n"
              "1000., 0.3\n*SOLID SECTION, ELSET=ONE, MATERIAL=M\n"
              "*SOLID SECTION, ELSET=OTHER, MATERIAL=S\n%s"
              "*STEP\n*STATIC\n*BOUNDARY\nFOOT, 1, 2\n*DSLOAD\nTOP, P, 1.\n"
              "*TEMPERATURE\nONE, 100.\n*ACCURACY, MESH=YES\n*END STEP\n",
              k == 0 ? ""
                     : "*STEP\n*STATIC\n*BOUNDARY\nFOOT, 1, 2\n*DSLOAD\n"
                       "TOP, P, 1.\n*ACCURACY, MESH=YES\n*END STEP\n");
    ck_assert_int_eq(job_run(&j, ""), 0);
    told[k] = job_told(&j, "mesh_error_percent");
  }
  ck_assert_double_gt(told[0], 1.0);
  ck_assert_double_eq_tol(told[1], told[0], 1e-6 * told[0]);
}

UNIT_MAIN("moduli")
