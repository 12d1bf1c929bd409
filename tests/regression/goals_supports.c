/*
 * *GOAL under prescribed displacements, next to ends of supports, and in bodies
 * of two materials or temperatures, against limits of meshes, each with four
 * times the elements of the one before; the radius of a pressure next to a
 * plane of symmetry.
 */
#include "base/base.h"
#include "scenes/mesh.h"
#include "support/job.h"
#include "support/unit.h"

#define PLANE "PLANE\n0., 0.\n0., 1."
#define ENERGY "*GOAL, NAME=E, QUANTITY=ENERGY\n"
#define NORMAL "*GOAL, NAME=N, QUANTITY=FORCE, CONTACT=C\n"
#define PRESSED "*STEP\n*STATIC\n*BOUNDARY\nTOP, 1\nTOP, 2, 2, -0.01\n"
#define CLAMPED "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1, 2\n*DSLOAD\nTOP, P, 10.\n"

static void write_mesh(const job *j, const char *words,
                       const mesh_change *change) {
  char path[200];
  int *number = NULL;
  snprintf(path, sizeof path, "%s/block.msh", j->dir);
  FILE *f = fopen(path, "w");
  ck_assert_ptr_nonnull(f);
  ck_assert(scene_mesh_write(f, words, change, &number));
  fclose(f);
  free(number);
}

/* A body of these words (scenes/mesh.h) with contact cards. */
static job of_type(const char *type, const char *words, const char *cards) {
  const mesh_change change = {.scale = 1.0};
  job j = job_begin("block");
  write_mesh(&j, words, &change);
  job_write(&j, "block.inp",
            "*MESH, FILE=block.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M%s\n"
            "*OBSTACLE, NAME=O, TYPE=%s*PRINT, GOALS\n*END STEP\n",
            type, cards);
  const int code = job_run(&j, "");
  ck_assert_msg(code == 0, "exit %d: %s", code, j.errors);
  return j;
}

static job of_body(const char *words, const char *cards) {
  return of_type("", words, cards);
}

#define CONTACT "\n*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"

/* A block of 2 x 1 with n x n squares on an obstacle. */
static job of_block(int n, const char *on, const char *cards) {
  char words[40], all[800];
  snprintf(words, sizeof words, "rect %d %d 2 1 alternate", n, n);
  snprintf(all, sizeof all, "%s" CONTACT "%s", on, cards);
  return of_body(words, all);
}

/* A goal: its estimate is from "least" to "most" of its error, which is in the
 * band, and the band at most "wide" of the error. */
static void check_row(const job *j, int row, double exact, double least,
                      double most, double wide) {
  dat t = job_table(j, "GOALS", -1);
  const double is = exact - dat_at(&t, row, "value");
  const double told = dat_at(&t, row, "error"), band = dat_at(&t, row, "band");
  ck_assert_msg(told / is > least && told / is < most,
                "error %g, estimate %g of it", is, told / is);
  ck_assert_msg(fabs(is - told) <= band && band <= wide * fabs(is),
                "error %g, estimate %g, band %g", is, told, band);
  dat_free(&t);
}

static void check(const job *j, double exact, double least, double most,
                  double wide) {
  check_row(j, 0, exact, least, most, wide);
}

static int has_verdict(const job *j, const char *goal, const char *word) {
  char wanted[80], *json = job_file(j, "json");
  snprintf(wanted, sizeof wanted, "\"goal\": \"%s\"", goal);
  char *at = strstr(json, wanted);
  ck_assert_msg(at != NULL, "no %s", wanted);
  *strchr(at, '}') = '\0';
  snprintf(wanted, sizeof wanted, "\"verdict\": \"%s\"", word);
  const int has = strstr(at, wanted) != NULL;
  free(json);
  return has;
}

/* By supports alone the energy of a mesh is too large, by loads too small; by
 * both, and along supports that bend, by a part of each. */
START_TEST(energies_by_loads_and_by_supports) {
  static const struct {
    const char *on, *step;
    double exact, wide;
  } rows[] = {
      {PLANE, PRESSED, 0.11559331, 4.0},
      {PLANE, CLAMPED, 0.079099874, 2.0},
      {PLANE,
       "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1\nRIGHT, 1\n"
       "TOP, 2, 2, \"-0.01*(1+0.5*cos(pi*x/2))\"\n",
       0.14957821, 3.0},
      {PLANE,
       "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1\nTOP, 2, 2, -0.005\n"
       "RIGHT, 1, 1, 0.002\n*DLOAD\nBODY, BX, \"40*sin(2*x)\"\n",
       0.19257777, 1.0},
      {"GAP\n\"0.01*x^2\"",
       "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1\nRIGHT, 1\nTOP, 2, 2, -0.005\n",
       0.0065382663, 3.0}};
  for (int k = 0; k < 5; ++k) {
    char cards[400];
    snprintf(cards, sizeof cards, ENERGY "%s", rows[k].step);
    job j = of_block(16, rows[k].on, cards);
    check(&j, rows[k].exact, 0.6, 1.3, rows[k].wide);
    job_end(&j);
  }
}
END_TEST

/* Next to the corners of a clamp stresses are infinite, and at the edge of a
 * roller in a straight side; not where it has all of the side. */
START_TEST(ends_of_supports_are_not_reliable) {
  job j = of_block(8, PLANE, NORMAL ENERGY PRESSED);
  ck_assert(has_verdict(&j, "N", "support_end"));
  ck_assert(has_verdict(&j, "E", "support_end"));
  check(&j, 23.118663, 0.3, 1.0, 3.0);
  job_end(&j);
  j = of_block(
      8, PLANE,
      "*GOAL, NAME=U, QUANTITY=DISPLACEMENT, COMPONENT=1\n2., 1.\n" CLAMPED);
  ck_assert(has_verdict(&j, "U", "support_end"));
  check(&j, 0.0070721533, 0.3, 1.0, 3.0);
  job_end(&j);
  j = of_block(16, PLANE,
               ENERGY
               "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1\n*DSLOAD\n"
               "TOP, P, \"10*(1+cos(pi*x/2))\"\n");
  ck_assert(has_verdict(&j, "E", "reliable"));
  check(&j, 0.13444394, 0.8, 1.2, 0.5);
  job_end(&j);
}
END_TEST

/* The same along the edges of a cube. */
START_TEST(ends_of_supports_in_space) {
  static const char on[] = "PLANE\n0., 0., 0.\n0., 0., 1." CONTACT NORMAL;
  static const char *const hold[] = {"TOP, 1, 2\n", "LEFT, 1\nFRONT, 2\n"};
  for (int k = 0; k < 2; ++k) {
    char cards[400];
    snprintf(cards, sizeof cards,
             "%s*STEP\n*STATIC\n*BOUNDARY\nTOP, 3, 3, -0.01\n%s", on, hold[k]);
    job j = of_body("box 4 4 4 1 1 1", cards);
    ck_assert(has_verdict(&j, "N", k == 0 ? "support_end" : "reliable"));
    if (k == 0) check(&j, 10.3045, 0.3, 1.0, 3.0);
    job_end(&j);
  }
}
END_TEST

/* All of the base slips, at 0.5 whatever the pressure: the force is 1. A node
 * that a support holds has a part of it, which along the normal is lost. */
START_TEST(nodes_of_supports_have_a_part_of_the_force) {
  static const char *const hold[] = {
      "LEFT, 2, 2, -0.002\n", "LEFT, 1, 1, 0.05\n", "CORNER, 1, 1, 0.05\n", ""};
  for (int k = 0; k < 4; ++k) {
    char cards[500];
    snprintf(cards, sizeof cards,
             "*FRICTION, CONTACT=C, LAW=TRESCA\n0.5\n"
             "*GOAL, NAME=T, QUANTITY=FORCE, CONTACT=C, COMPONENT=TANGENT\n"
             "*STEP\n*QUASISTATIC\n1., 1.\n*BOUNDARY\nTOP, 1, 1, 0.05\n"
             "TOP, 2, 2, -0.01\n%s",
             hold[k]);
    job j = of_block(8, "GAP\n\"-0.005\"", cards);
    dat t = job_table(&j, "GOALS", -1);
    const double off = -1.0 - dat_at(&t, 0, "corrected");
    const double band = dat_at(&t, 0, "band");
    ck_assert_msg(fabs(off) <= band, "row %d: %g off, band %g", k, off, band);
    ck_assert_int_eq(has_verdict(&j, "T", "reliable"), k > 0);
    ck_assert(k == 0 ? band > 0.01 : band < 1e-12 && band > 1e-14);
    dat_free(&t);
    job_end(&j);
  }
}
END_TEST

/* Where a coarse mesh sticks, and a sum whose terms cancel. */
START_TEST(zeros_are_not_exact) {
  job j = of_block(8, PLANE,
                   "*FRICTION, CONTACT=C, LAW=COULOMB\n5.\n"
                   "*GOAL, NAME=W, QUANTITY=FRICTION WORK\n"
                   "*STEP\n*QUASISTATIC\n1., 1.\n*BOUNDARY\nLEFT, 1\n"
                   "*DSLOAD\nTOP, P, 10.\n");
  ck_assert(has_verdict(&j, "W", "no_slip"));
  job_end(&j);
  j = of_block(
      8, PLANE,
      "*GOAL, NAME=S, QUANTITY=STRESS, COMPONENT=XX, GROUP=BODY\n" CLAMPED);
  dat t = job_table(&j, "GOALS", -1);
  ck_assert_double_le(fabs(dat_at(&t, 0, "corrected")), dat_at(&t, 0, "band"));
  dat_free(&t);
  job_end(&j);
}
END_TEST

/* ---- two materials ------------------------------------------------------- */

#define SIDES "*BOUNDARY\nLEFT, 1\nBOTTOM, 2\n"
#define WALLS SIDES "RIGHT, 1\n"
#define LOAD "*DSLOAD\nTOP, P, 20.\n"
#define WAVE "*DSLOAD\nTOP, P, \"20*(1+cos(pi*x))\"\n"
#define HEAT "*TEMPERATURE\nSOFT, 10.\nHARD, -5.\n"

/* The unit square of 12 x 12 squares, or what y is mapped to, of two materials,
 * the upper one "ratio" times as stiff. */
typedef struct layers {
  double ratio, expansion; /* of the upper one */
  const char *type, *y;
} layers;

static job of_layers(layers l, const char *cards) {
  const mesh_change change = {.scale = 1.0, .map = {NULL, l.y, NULL}};
  job j = job_begin("block");
  write_mesh(&j, "rect 12 12 1 1 alternate layers", &change);
  job_write(&j, "block.inp",
            "*MESH, FILE=block.msh\n*MATERIAL, NAME=A\n*ELASTIC\n1000., 0.3\n"
            "*EXPANSION\n1e-3\n*MATERIAL, NAME=B\n*ELASTIC\n%g, 0.3\n"
            "*EXPANSION\n%g\n*SOLID SECTION, ELSET=SOFT, MATERIAL=A, TYPE=%s\n"
            "*SOLID SECTION, ELSET=HARD, MATERIAL=B, TYPE=%s\n"
            "*GOAL, NAME=U, QUANTITY=DISPLACEMENT, COMPONENT=2, GROUP=TOP\n"
            "*GOAL, NAME=V, QUANTITY=DISPLACEMENT, COMPONENT=1, GROUP=RIGHT\n"
            "*GOAL, NAME=M, QUANTITY=DISPLACEMENT, COMPONENT=2, GROUP=SOFT\n"
            "*GOAL, NAME=S, QUANTITY=STRESS, GROUP=HARD, COMPONENT=XX\n"
            "*GOAL, NAME=P, QUANTITY=DISPLACEMENT, COMPONENT=2\n0., 1.\n" ENERGY
            "*STEP\n*STATIC\n%s*PRINT, GOALS\n*END STEP\n",
            1000.0 * l.ratio, l.expansion, l.type, l.type, cards);
  const int code = job_run(&j, "");
  ck_assert_msg(code == 0, "exit %d: %s", code, j.errors);
  return j;
}

/* A row of the goals U, V, M, S, P, E. */
typedef struct expected {
  int row;
  double exact, least, most, wide;
} expected;

/* At a free side stresses are infinite; the mean over TOP and that over RIGHT
 * have the same part of their errors, by the theorem of Betti. */
START_TEST(materials_that_meet_at_a_free_side) {
  static const struct {
    layers of;
    const char *cards;
    expected is[4];
  } rows[] = {
      {{3.0, 0.0, "CPE3", NULL},
       SIDES LOAD,
       {{0, -0.011908365, 0.68, 0.73, 0.6},
        {1, 0.0046750736, 0.68, 0.73, 0.6},
        {3, 1.7305265, 0.66, 0.75, 0.6},
        {5, 0.11908365, 0.75, 0.9, 0.8}}},
      {{3.0, 0.0, "CAX3", NULL},
       SIDES LOAD,
       {{0, -0.013077065, 0.54, 0.6, 0.8},
        {1, 0.0037010199, 0.54, 0.6, 0.8},
        {3, 1.0729641, 0.5, 0.6, 0.8},
        {5, 0.4108281, 0.75, 0.9, 1.0}}},
      {{1.0, -5e-4, "CPE3", NULL},
       SIDES "*TEMPERATURE\nSOFT, 10.\nHARD, 10.\n",
       {{2, 0.0035564393, 0.95, 1.05, 0.8}, {3, 4.3105328, 0.68, 0.78, 0.6}}},
      {{1.0, 1e-3, "CPE3", NULL},
       SIDES HEAT,
       {{2, 0.0035564393, 0.95, 1.05, 0.8}, {3, 4.3105328, 0.68, 0.78, 0.6}}},
      {{1.0, 1e-3, "CAX3", NULL},
       SIDES LOAD HEAT,
       {{2, -0.002234232, 0.95, 1.05, 1.3}, {3, 2.5251199, 0.54, 0.65, 0.8}}}};
  for (int k = 0; k < 5; ++k) {
    job j = of_layers(rows[k].of, rows[k].cards);
    ck_assert(has_verdict(&j, "S", "support_end"));
    for (int i = 0; i < 4 && rows[k].is[i].wide > 0.0; ++i) {
      const expected *e = &rows[k].is[i];
      check_row(&j, e->row, e->exact, e->least, e->most, e->wide);
    }
    job_end(&j);
  }
}
END_TEST

/* Not where a plane of symmetry is normal to the interface, and within, but
 * where that turns. */
START_TEST(materials_that_meet_smoothly) {
  job j = of_layers((layers){3.0, 0.0, "CPE3", NULL}, WALLS WAVE);
  ck_assert(has_verdict(&j, "P", "reliable"));
  ck_assert(has_verdict(&j, "E", "reliable"));
  check_row(&j, 4, -0.015275949, 0.9, 1.1, 0.3);
  check_row(&j, 5, 0.12590357, 0.9, 1.1, 0.3);
  job_end(&j);
  j = of_layers((layers){3.0, 0.0, "CAX3", NULL},
                "*BOUNDARY\nRIGHT, 1\nBOTTOM, 2\n" WAVE);
  ck_assert(!has_verdict(&j, "E", "support_end"));
  job_end(&j);
  j = of_layers((layers){3.0, 0.0, "CPE3", "y+0.5*y*(1-y)*abs(cos(pi*x))"},
                WALLS WAVE);
  ck_assert(has_verdict(&j, "E", "support_end"));
  check_row(&j, 5, 0.13734705, 0.85, 1.1, 0.4);
  job_end(&j);
}
END_TEST

/* One temperature that two cards give is one: the goals of a body that expands
 * freely have the errors of the cold one. */
START_TEST(temperatures_that_do_not_meet) {
  static const char *const heat[] = {"",
                                     "*TEMPERATURE\nSOFT, 10.\nHARD, 10.\n"};
  double error[2], band[2];
  for (int k = 0; k < 2; ++k) {
    char cards[200];
    snprintf(cards, sizeof cards, "%s%s", SIDES WAVE, heat[k]);
    job j = of_layers((layers){1.0, 1e-3, "CPE3", NULL}, cards);
    dat t = job_table(&j, "GOALS", -1);
    error[k] = dat_at(&t, 4, "error");
    band[k] = dat_at(&t, 4, "band");
    dat_free(&t);
    job_end(&j);
  }
  ck_assert_double_eq_tol(error[1], error[0], 1e-9 * fabs(error[0]));
  ck_assert_double_eq_tol(band[1], band[0], 1e-9 * fabs(band[0]));
}
END_TEST

#define BOTH "*TEMPERATURE\nSOFT, 10.\nHARD, 10.\n"
#define SLOPES "*TEMPERATURE\nSOFT, \"20*(1-x)\"\nHARD, \"5*x-7.5\"\n"

/* Strains without stress count as what supports prescribe: they make the energy
 * of a mesh too large, loads too small, and one does no work on the other. */
START_TEST(energies_by_loads_and_by_temperatures) {
  static const struct {
    layers of;
    const char *cards;
    expected is;
  } rows[] = {
      {{1.0, 1e-3, "CPE3", NULL},
       SIDES LOAD HEAT,
       {5, 0.23426385, 0.7, 0.85, 1}},
      {{1.0, 1e-3, "CAX3", NULL},
       SIDES LOAD HEAT,
       {5, 0.70167593, 0.7, 0.85, 1}},
      {{1.0, 1e-3, "CPE3", NULL},
       "*BOUNDARY\nBOTTOM, 1, 2\n" LOAD BOTH,
       {5, 0.23977081, 0.7, 0.85, 2}},
      {{1.0, 1e-3, "CPE3", NULL}, WALLS SLOPES, {5, 0.11457827, 0.85, 1.0, 3}},
      {{1.0, 1e-3, "CAX3", NULL},
       WALLS "TOP, 2, 2, \"-0.005*(1+cos(pi*x))\"\n" BOTH,
       {5, 1.458333, 0.9, 1.1, 0.5}},
      {{1.0, 1e-3, "CPE3", NULL},
       WALLS WAVE SLOPES,
       {5, 0.31954276, 0.9, 1, 0.3}}};
  for (int k = 0; k < 6; ++k) {
    job j = of_layers(rows[k].of, rows[k].cards);
    const expected *e = &rows[k].is;
    check_row(&j, e->row, e->exact, e->least, e->most, e->wide);
    job_end(&j);
  }
}
END_TEST

/* What temperatures are within the elements more than their means: T(y) between
 * walls all round and T(r) of a cylinder between two have closed forms. */
START_TEST(temperatures_that_vary_within_elements) {
  static const struct {
    layers of;
    const char *cards;
    expected is[3];
  } rows[] = {
      {{1.0, 1e-3, "CPE3", NULL},
       WALLS "TOP, 2\n*TEMPERATURE\nSOFT, \"100*y^2\"\n"
             "HARD, \"100*y^2\"\n",
       {{2, -0.013541667, 0.9, 1.1, 0.5}, {3, -119.047619, 0.9, 1.1, 0.5}}},
      {{3.0, 1e-3, "CPE3", NULL},
       WALLS WAVE "*TEMPERATURE\nSOFT, \"10*cos(pi*x)\"\n"
                  "HARD, \"-5*cos(pi*x)\"\n",
       {{5, 0.18727039, 0.9, 1.1, 0.5}}},
      {{1.0, 1e-3, "CAX3", NULL},
       SIDES "TOP, 2\n*TEMPERATURE\nSOFT, \"20*(1-x)\"\n"
             "HARD, \"20*(1-x)\"\n",
       {{1, 0.026 / 3.0, 0.9, 1.1, 0.5}}},
      {{2.0, 1e-3, "CAX3", NULL},
       WALLS WAVE SLOPES,
       {{0, -0.0043053987, 0.9, 1.1, 0.5}, {2, 0.00088629567, 0.5, 1.5, 3.0}}}};
  for (int k = 0; k < 4; ++k) {
    job j = of_layers(rows[k].of, rows[k].cards);
    for (int i = 0; i < 3 && rows[k].is[i].wide > 0.0; ++i) {
      const expected *e = &rows[k].is[i];
      check_row(&j, e->row, e->exact, e->least, e->most, e->wide);
    }
    job_end(&j);
  }
}
END_TEST

/* A prism from z = 0 to 1 with an interface at y = 1/2, in the middle at
 * "height". */
#define PRISM                                                                  \
  "Point(1) = {0, 0, 0}; Point(2) = {2, 0, 0}; Point(3) = {2, 0.5, 0};\n"      \
  "Point(4) = {1.5, 0.5, 0}; Point(5) = {1, %g, 0};\n"                         \
  "Point(6) = {0.5, 0.5, 0}; Point(7) = {0, 0.5, 0}; Point(8) = {2, 1, 0};\n"  \
  "Point(9) = {0, 1, 0}; Line(1) = {1, 2}; Line(2) = {2, 3};\n"                \
  "Line(3) = {3, 4}; Line(4) = {4, 5}; Line(5) = {5, 6}; Line(6) = {6, 7};\n"  \
  "Line(7) = {7, 1}; Line(8) = {3, 8}; Line(9) = {8, 9}; Line(10) = {9, 7};\n" \
  "Curve Loop(1) = {1:7}; Plane Surface(1) = {1};\n"                           \
  "Curve Loop(2) = {8, 9, 10, -6, -5, -4, -3}; Plane Surface(2) = {2};\n"      \
  "Mesh.MeshSizeMax = 0.25;\n"                                                 \
  "a[] = Extrude {0, 0, 1} { Surface{1}; Layers{4}; };\n"                      \
  "b[] = Extrude {0, 0, 1} { Surface{2}; Layers{4}; };\n"                      \
  "Physical Volume(\"SOFT\") = {a[1]}; Physical Volume(\"HARD\") = {b[1]};\n"  \
  "Physical Surface(\"BOTTOM\") = {a[2]};\n"                                   \
  "Physical Surface(\"RIGHT\") = {a[3], b[2]};\n"                              \
  "Physical Surface(\"LEFT\") = {a[8], b[4]};\n"                               \
  "Physical Surface(\"TOP\") = {b[3]};\n"                                      \
  "Physical Surface(\"ENDS\") = {1, 2, a[0], b[0]};\n"

START_TEST(materials_that_meet_in_space) {
  static const struct {
    double height;
    const char *hold;
    int sharp;
  } rows[] = {{0.62, "RIGHT, 1\n", 0}, {0.5, "", 1}, {0.67, "RIGHT, 1\n", 1}};
  for (int k = 0; k < 3; ++k) {
    job j = job_begin("prism");
    job_write(&j, "prism.geo", PRISM, rows[k].height);
    job_write(&j, "prism.inp",
              "*MESH, FILE=prism.geo\n*MATERIAL, NAME=A\n*ELASTIC\n1000., 0.3\n"
              "*MATERIAL, NAME=B\n*ELASTIC\n5000., 0.3\n"
              "*SOLID SECTION, ELSET=SOFT, MATERIAL=A\n"
              "*SOLID SECTION, ELSET=HARD, MATERIAL=B\n" ENERGY
              "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1\nBOTTOM, 2\nENDS, 3\n%s"
              "*DSLOAD\nTOP, P, \"20*(1+cos(pi*x))\"\n*PRINT, GOALS\n"
              "*END STEP\n",
              rows[k].hold);
    const int code = job_run(&j, "");
    ck_assert_msg(code == 0, "exit %d: %s", code, j.errors);
    ck_assert_int_eq(has_verdict(&j, "E", "support_end"), rows[k].sharp);
    job_end(&j);
  }
}
END_TEST

/* ---- pressures next to a plane of symmetry ------------------------------- */

static job of_peak(const char *words, const char *gap, const char *radius,
                   const char *hold) {
  char on[100], cards[400];
  snprintf(on, sizeof on, "GAP\n\"%s\"" CONTACT, gap);
  snprintf(cards, sizeof cards,
           "%s*GOAL, NAME=P, QUANTITY=PRESSURE, CONTACT=C%s\n*STEP\n*STATIC\n"
           "*BOUNDARY\nRIGHT, 1\n%s*PRINT, CONTACT\n",
           on, radius, hold);
  return of_body(words, cards);
}

/* The largest pressure is inside, and the zone grows to the plane at RIGHT: the
 * mean is the same part of it before and after. */
START_TEST(peaks_do_not_jump_where_a_zone_reaches_a_plane) {
  static const char *const hold[] = {"TOP, 2, 2, -0.029\n",
                                     "TOP, 2, 2, -0.030\n"};
  double part[2];
  for (int k = 0; k < 2; ++k) {
    job j =
        of_peak("rect 40 20 1 0.5 alternate", "0.1*(x-0.75)^2", "", hold[k]);
    dat t = job_table(&j, "GOALS", -1), c = job_table(&j, "CONTACT", -1);
    const double end = dat_at(&c, dat_row_near(&c, "x", 1.0), "pressure");
    ck_assert_int_eq(end > 0.0, k == 1);
    part[k] = dat_at(&t, 0, "corrected") / dat_max(&c, "pressure");
    dat_free(&t);
    dat_free(&c);
    job_end(&j);
  }
  ck_assert_double_eq_tol(part[1], part[0], 0.003);
}
END_TEST

/* In space the area is larger by what of it is behind each plane: as much as
 * the pressure there is of the largest. */
START_TEST(radius_of_a_zone_that_planes_halve) {
  static const char words[] = "box 8 8 3 1 1 0.5";
  static const char gap[] = "0.1*((x-0.7)^2+y^2)";
  static const char hold[] = "FRONT, 2\nTOP, 3, 3, -0.04\n";
  char radius[40];
  job j = of_peak(words, gap, "", hold);
  dat t = job_table(&j, "GOALS", -1), c = job_table(&j, "CONTACT", -1);
  const double value = dat_at(&t, 0, "value");
  double area = 0.0, most = 0.0, at[2] = {0.0};
  for (int i = 0; i < c.n_row; ++i) {
    const double p = dat_at(&c, i, "pressure");
    if (p > 0.0) area += fabs(dat_at(&c, i, "f_n")) / p;
    most = fmax(most, p);
    if (dat_at(&c, i, "x") > 0.999) at[0] = fmax(at[0], p);
    if (dat_at(&c, i, "y") < 0.001) at[1] = fmax(at[1], p);
  }
  ck_assert(at[0] > 0.05 * most && at[0] < 0.9 * most);
  snprintf(
      radius, sizeof radius, ", RADIUS=%.15g",
      0.5 * sqrt(area / M_PI * (1.0 + at[0] / most) * (1.0 + at[1] / most)));
  dat_free(&t);
  dat_free(&c);
  job_end(&j);
  j = of_peak(words, gap, radius, hold);
  t = job_table(&j, "GOALS", -1);
  ck_assert_double_eq_tol(dat_at(&t, 0, "value"), value, 1e-8 * value);
  dat_free(&t);
  job_end(&j);
}
END_TEST

/* Also next to ends of a load: a block under a shear that ends at its
 * corners. */
START_TEST(estimates_of_coarse_meshes_are_doubted) {
  for (int n = 3; n <= 4; ++n) {
    job j = of_block(
        n, PLANE,
        "*GOAL, NAME=U, QUANTITY=DISPLACEMENT, GROUP=TOP, COMPONENT=1\n"
        "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1\n"
        "*DSLOAD\nTOP, P, 30.\nTOP, TX, 3.\n");
    ck_assert(has_verdict(&j, "U", "support_end"));
    check(&j, 0.01789396, 0.4, 0.7, 1.4);
    job_end(&j);
  }
}
END_TEST

/* The force acts in one node, so the moment is by chance what it is. */
START_TEST(moment_about_a_single_node_is_not_reliable) {
  job j = of_block(4, "SPHERE, RADIUS=2.\n0.6, -2.",
                   "*GOAL, NAME=M, QUANTITY=MOMENT, CONTACT=C, COMPONENT=3\n"
                   "0., 0.\n" NORMAL
                   "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1\n"
                   "*DSLOAD\nTOP, P, 0.1\n");
  ck_assert(has_verdict(&j, "M", "few_nodes"));
  ck_assert(has_verdict(&j, "N", "reliable"));
  job_end(&j);
}
END_TEST

/* Where normals differ, so do the forces along them by the place of the node.
 */
START_TEST(normal_force_in_a_single_node_is_not_reliable) {
  job j = of_body("rect 4 4 2 1 alternate",
                  "SPHERE, RADIUS=2.\n0.6, -2.\n"
                  "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O, NORMAL=OBSTACLE"
                  "\n" NORMAL
                  "*GOAL, NAME=Y, QUANTITY=FORCE, CONTACT=C, COMPONENT=2\n"
                  "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1\n"
                  "*DSLOAD\nTOP, P, 0.1\n");
  ck_assert(has_verdict(&j, "N", "few_nodes"));
  ck_assert(has_verdict(&j, "Y", "reliable"));
  job_end(&j);
}
END_TEST

/* The radial force is that of the bearing of the ring, the axial one the load.
 */
START_TEST(radial_force_in_a_single_node_is_not_reliable) {
  job j = of_type(", TYPE=CAX3", "rect 2 2 1 0.5",
                  "PLANE\n1., 0.\n-0.05, 1.\n"
                  "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O, NORMAL=OBSTACLE"
                  "\n*GOAL, NAME=R, QUANTITY=FORCE, CONTACT=C, COMPONENT=1\n"
                  "*GOAL, NAME=Z, QUANTITY=FORCE, CONTACT=C, COMPONENT=2\n"
                  "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1\n"
                  "*DSLOAD\nTOP, P, 0.01\n");
  ck_assert(has_verdict(&j, "R", "few_nodes"));
  ck_assert(has_verdict(&j, "Z", "reliable"));
  job_end(&j);
}
END_TEST

/* The adjoint of the force is linear, and has no error: that of the force is
 * the gap between the nodes, of which its bubble lacks a part (Betti: the force
 * is that of the mean of what the gap leaves). */
START_TEST(errors_by_gaps_alone_have_a_band) {
  job j = of_block(16, "GAP\n\"0.001*x^4\"",
                   NORMAL
                   "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1\n"
                   "TOP, 2, 2, -0.05\n");
  check(&j, 1000.0 / (1.0 - 0.3 * 0.3) * (0.1 - 0.001 * 6.4), 0.95, 1.05, 0.2);
  ck_assert(has_verdict(&j, "N", "reliable"));
  job_end(&j);
}
END_TEST

/* There are no products of errors to refine by but rounding, which the
 * thickness changes: it must not change the meshes. */
START_TEST(passes_do_not_refine_by_rounding) {
  int unknowns[2][9], n[2] = {0};
  for (int k = 0; k < 2; ++k) {
    job j = of_type(k == 0 ? ", TYPE=CPS3" : ", TYPE=CPS3, THICKNESS=1.7",
                    "rect 8 8 2 1 alternate",
                    "GAP\n\"0.001*x^4\"" CONTACT
                    "*GOAL, NAME=N, QUANTITY=FORCE, CONTACT=C, TARGET=0.1 %\n"
                    "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1\nTOP, 2, 2, -0.05\n");
    char *json = job_file(&j, "json"), *at = strstr(json, "\"passes\"");
    for (; n[k] < 9 && (at = strstr(at, "\"unknowns\": ")) != NULL; ++n[k])
      unknowns[k][n[k]] = atoi(at += 12);
    free(json);
    job_end(&j);
  }
  ck_assert_int_gt(n[0], 1);
  ck_assert_int_eq(n[1], n[0]);
  ck_assert_mem_eq(unknowns[1], unknowns[0], (size_t)n[0] * sizeof **unknowns);
}
END_TEST

/* A block that is pressed flat moves by its strain times x, the floor by 0.3
 * times that: where its friction turns back at x = 0.3, within an edge, decides
 * on its force. */
START_TEST(friction_that_turns_back_within_an_edge) {
  static const double strain = 0.3 / 0.7 * 0.01, limit = 1e-6;
  for (int n = 8; n <= 16; n *= 2) {
    char cards[500], on[80];
    snprintf(on, sizeof on, PLANE "\nMOVE, %.15g, 0.", 0.3 * strain);
    snprintf(cards, sizeof cards,
             "*FRICTION, CONTACT=C, LAW=TRESCA\n%g\n"
             "*GOAL, NAME=T, QUANTITY=FORCE, CONTACT=C, COMPONENT=1\n" NORMAL
             "*STEP\n*QUASISTATIC\n1., 1.\n*BOUNDARY\nLEFT, 1\n"
             "TOP, 2, 2, -0.01\n",
             limit);
    job j = of_block(n, on, cards);
    dat t = job_table(&j, "GOALS", -1);
    const double off = limit * (0.3 - 1.7) - dat_at(&t, 0, "corrected");
    const double band = dat_at(&t, 0, "band"), edge = 2.0 / n;
    ck_assert_double_gt(fabs(off), 0.1 * limit * edge);
    ck_assert_double_gt(band, fabs(off));
    ck_assert_double_lt(band, 1.2 * limit * edge);
    ck_assert(has_verdict(&j, "T", "contact_end"));
    dat_free(&t);
    job_end(&j);
  }
}
END_TEST

/* On a cylinder that touches one row of nodes the moment about its axis is by
 * chance what it is. */
START_TEST(moment_about_a_row_of_nodes_is_not_reliable) {
  job j = of_body("box 4 4 4 2 2 1",
                  "CYLINDER, RADIUS=2.\n0.6, 0., -2.\n0., 1., 0." CONTACT
                  "*GOAL, NAME=M, QUANTITY=MOMENT, CONTACT=C, COMPONENT=2\n"
                  "0., 0., 0.\n" NORMAL
                  "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1\nFRONT, 2\n"
                  "*DSLOAD\nTOP, P, 0.1\n*PRINT, CONTACT\n");
  dat t = job_table(&j, "CONTACT", -1);
  int closed = 0;
  for (int i = 0; i < t.n_row; ++i) closed += dat_at(&t, i, "f_n") > 0.0;
  ck_assert_int_eq(closed, 5);
  ck_assert(has_verdict(&j, "M", "few_nodes"));
  ck_assert(has_verdict(&j, "N", "reliable"));
  dat_free(&t);
  job_end(&j);
}
END_TEST

/* Three nodes are few, four are not. */
START_TEST(zones_of_three_nodes_are_not_reliable) {
  for (int n = 2; n <= 3; ++n) {
    char words[40];
    snprintf(words, sizeof words, "rect %d 8 2 1 alternate", n);
    job j = of_body(words, PLANE CONTACT
                    "*GOAL, NAME=U, QUANTITY=DISPLACEMENT, GROUP=TOP, "
                    "COMPONENT=2\n*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1\n"
                    "*DSLOAD\nTOP, P, \"3+x^2\"\n");
    ck_assert_int_eq(has_verdict(&j, "U", "few_nodes"), n == 2);
    job_end(&j);
  }
}
END_TEST

/* The node slid and stays where it is: the work is that of its slide, which one
 * node does not have. */
START_TEST(work_of_a_single_node_remains_doubtful) {
  job j = of_block(4, "SPHERE, RADIUS=2.\n0.6, -2.",
                   "*FRICTION, CONTACT=C, LAW=COULOMB\n0.05\n"
                   "*GOAL, NAME=W, QUANTITY=FRICTION WORK\n"
                   "*STEP\n*QUASISTATIC\n1., 2.\n*BOUNDARY\nLEFT, 1\n"
                   "*DSLOAD\nTOP, P, \"0.1*min(t, 1)\"\n");
  dat first = job_table(&j, "GOALS", 0), last = job_table(&j, "GOALS", -1);
  const double work = dat_at(&last, 0, "value");
  ck_assert_double_gt(work, 0.0);
  ck_assert_double_eq_tol(dat_at(&first, 0, "value"), work, 1e-9 * work);
  ck_assert(has_verdict(&j, "W", "few_nodes"));
  dat_free(&first);
  dat_free(&last);
  job_end(&j);
}
END_TEST

/* A sphere between two nodes, pressed into the side or below it. */
START_TEST(contact_between_nodes_is_not_none) {
  static const double depth[] = {0.002, -0.05};
  for (int flat = 0; flat < 2; ++flat)
    for (int k = 0; k < 2; ++k) {
      char cards[500];
      snprintf(cards, sizeof cards,
               "SPHERE, RADIUS=2.\n%s%.17g" CONTACT NORMAL
               "*GOAL, NAME=U, QUANTITY=DISPLACEMENT, GROUP=TOP, COMPONENT=1\n"
               "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1\n%s",
               flat ? "0.75, " : "0.75, 0.5, ", depth[k] - 2.0,
               flat ? "TOP, 2, 2, 0.\n" : "FRONT, 2\nTOP, 3, 3, 0.\n");
      job j = of_body(flat ? "rect 4 4 2 1" : "box 4 4 4 2 2 1", cards);
      ck_assert(has_verdict(&j, "N", k == 0 ? "few_nodes" : "reliable"));
      ck_assert(has_verdict(&j, "U", k == 0 ? "few_nodes" : "reliable"));
      job_end(&j);
    }
}
END_TEST

/* A shear that ends at a corner, where no stress fits both sides, next to a
 * free side, to a plane of symmetry, or a pressure on all sides, which fits. */
START_TEST(ends_of_loads_are_not_reliable) {
  static const struct {
    const char *point, *load, *word;
  } flat[] = {
      {"2., 1.", "TOP, P, 3.\nTOP, TX, 3.\n", "support_end"},
      {"0., 1.", "TOP, TX, 3.\n", "support_end"},
      {"2., 1.", "TOP, P, \"3+x^2\"\nRIGHT, P, \"1+y^2\"\n", "reliable"},
      {"2., 1.", "TOP, TX, \"x\"\nRIGHT, TY, \"y\"\n", "support_end"},
      {"2., 1.", "TOP, TX, \"x\"\nRIGHT, TY, \"2*y\"\n", "reliable"}};
  for (int k = 0; k < 5; ++k) {
    char cards[500];
    snprintf(cards, sizeof cards,
             "PLANE\n9., 0.\n-1., 0.\n"
             "*CONTACT, NAME=C, GROUP=RIGHT, OBSTACLE=O\n"
             "*GOAL, NAME=U, QUANTITY=DISPLACEMENT, COMPONENT=2\n%s\n"
             "*STEP\n*STATIC\n*BOUNDARY\nBOTTOM, 2\nLEFT, 1\n*DSLOAD\n%s",
             flat[k].point, flat[k].load);
    job j = of_body("rect 16 16 2 1 alternate", cards);
    ck_assert_msg(has_verdict(&j, "U", flat[k].word), "row %d", k);
    job_end(&j);
  }
}
END_TEST

/* Under a force on a node the displacement grows without end with the elements,
 * in the plane and in space; not where there is none. */
START_TEST(forces_on_nodes_are_not_reliable) {
  static const char *const flat[] = {"rect %d %d 2 1 alternate", "2., 1.", ""};
  static const char *const space[] = {"box %d %d 4 1 1 1", "1., 1., 1.",
                                      "FRONT, 2\n"};
  for (int dim = 2; dim <= 3; ++dim) {
    const char *const *of = dim == 2 ? flat : space;
    double value[2];
    for (int k = 0; k < 3; ++k) {
      char words[40], cards[500];
      const int n = dim == 2 ? 16 : 6;
      snprintf(words, sizeof words, of[0], n << k % 2, n << k % 2);
      snprintf(cards, sizeof cards,
               "GAP\n0." CONTACT
               "*GOAL, NAME=U, QUANTITY=DISPLACEMENT, COMPONENT=1\n%s\n" ENERGY
               "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1\n%s"
               "*DSLOAD\nTOP, P, \"10+x^2\"\n*CLOAD\nTIP, 1, %d\n",
               of[1], of[2], k < 2);
      job j = of_body(words, cards);
      dat t = job_table(&j, "GOALS", -1);
      if (k < 2) value[k] = dat_at(&t, 0, "value");
      ck_assert_int_eq(has_verdict(&j, "U", "support_end"), k < 2);
      ck_assert_int_eq(has_verdict(&j, "E", "support_end"), k < 2);
      dat_free(&t);
      job_end(&j);
    }
    ck_assert_double_gt(value[1], 1.05 * value[0]);
  }
}
END_TEST

UNIT_MAIN("goals_supports", nodes_of_supports_have_a_part_of_the_force,
          zeros_are_not_exact, energies_by_loads_and_by_supports,
          ends_of_supports_are_not_reliable, ends_of_supports_in_space,
          materials_that_meet_at_a_free_side, materials_that_meet_smoothly,
          temperatures_that_do_not_meet, energies_by_loads_and_by_temperatures,
          temperatures_that_vary_within_elements, materials_that_meet_in_space,
          peaks_do_not_jump_where_a_zone_reaches_a_plane,
          radius_of_a_zone_that_planes_halve,
          estimates_of_coarse_meshes_are_doubted,
          moment_about_a_single_node_is_not_reliable,
          normal_force_in_a_single_node_is_not_reliable,
          radial_force_in_a_single_node_is_not_reliable,
          zones_of_three_nodes_are_not_reliable,
          errors_by_gaps_alone_have_a_band, passes_do_not_refine_by_rounding,
          friction_that_turns_back_within_an_edge,
          moment_about_a_row_of_nodes_is_not_reliable,
          work_of_a_single_node_remains_doubtful,
          contact_between_nodes_is_not_none, ends_of_loads_are_not_reliable,
          forces_on_nodes_are_not_reliable)
