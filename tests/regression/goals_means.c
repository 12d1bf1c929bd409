/*
 * *GOAL, QUANTITY=DISPLACEMENT, GROUP=: the mean over the area of faces, the
 * volume of elements, on meshes whose edges are 1:8, of fields that all the
 * border prescribes; goals of mirror images; pressures that are no parabola
 * round their largest and no root at the end of the zone.
 */
#include "scenes/mesh.h"
#include "support/block_file.h"
#include "support/job.h"
#include "support/unit.h"

const int job_without_fields = 1;

/* The unit square, and the cube on it; fine at one corner. */
#define SQUARE                                                              \
  "Point(1) = {0, 0, 0, 0.05}; Point(2) = {1, 0, 0, 0.4};\n"                \
  "Point(3) = {1, 1, 0, 0.4}; Point(4) = {0, 1, 0, 0.05};\n"                \
  "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};" \
  "\nCurve Loop(1) = {1:4}; Plane Surface(1) = {1};\n"
#define PLANE                                                             \
  SQUARE                                                                  \
  "Physical Surface(\"BODY\") = {1}; Physical Curve(\"BORDER\") = {1:4};" \
  "\nPhysical Curve(\"TOP\") = {3};\n"
#define CUBE                                                            \
  SQUARE                                                                \
  "e[] = Extrude {0, 0, 1} { Surface{1}; };\n"                          \
  "Physical Volume(\"BODY\") = {e[1]};\n"                               \
  "Physical Surface(\"BORDER\") = {1, e[0], e[2], e[3], e[4], e[5]};\n" \
  "Physical Surface(\"TOP\") = {e[4]};\n"
/* A quarter of a ring from radius 1 to 2. */
#define RING                                                                 \
  "Point(1) = {0, 0, 0}; Point(2) = {1, 0, 0}; Point(3) = {2, 0, 0};\n"      \
  "Point(4) = {0, 2, 0}; Point(5) = {0, 1, 0};\n"                            \
  "Line(1) = {2, 3}; Circle(2) = {3, 1, 4}; Line(3) = {4, 5};\n"             \
  "Circle(4) = {5, 1, 2}; Curve Loop(1) = {1:4};\n"                          \
  "Plane Surface(1) = {1}; Mesh.MeshSizeMax = 0.25;\n"                       \
  "Transfinite Curve{4} = 9 Using Progression 1.2;\n"                        \
  "Physical Surface(\"BODY\") = {1}; Physical Curve(\"BORDER\") = {2, 4};\n" \
  "Physical Curve(\"TOP\") = {4}; Physical Curve(\"BOTTOM\") = {1};\n"       \
  "Physical Curve(\"LEFT\") = {3};\n"

/* A body, a displacement on its border, the others zero or as told; its means
 * over TOP and BODY (NAN: not known). */
typedef struct field {
  const char *geo, *section, *cards;
  double top, body;
  int component; /* from 0 */
} field;

static job run_field(const field *f) {
  job j = job_begin("means");
  job_write(&j, "means.geo", "%s", f->geo);
  job_write(&j, "means.inp",
            "*MESH, FILE=means.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
            "*EXPANSION\n1.E-3\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M%s\n"
            "*GOAL, NAME=T, QUANTITY=DISPLACEMENT, COMPONENT=%d, GROUP=TOP\n"
            "*GOAL, NAME=B, QUANTITY=DISPLACEMENT, COMPONENT=%d, GROUP=BODY\n"
            "*GOAL, NAME=D, QUANTITY=DISPLACEMENT, COMPONENT=%d, GROUP=TOP, "
            "FROM=BODY\n"
            "*STEP\n*STATIC\n%s*PRINT, GOALS\n*END STEP\n",
            f->section, f->component + 1, f->component + 1, f->component + 1,
            f->cards);
  CK_EXIT(job_run(&j, ""), 0, j);
  return j;
}

#define GIVEN(u, last) \
  "*BOUNDARY\nBORDER, 1, 1, \"" u "\"\nBORDER, 2, " #last ", 0\n"
static const field linear[] = {
    {PLANE, ", TYPE=CPE3", GIVEN("0.3*x+0.1*y", 2), 0.25, 0.2, 0},
    {PLANE, ", TYPE=CAX3", GIVEN("0.3*x", 2), 0.2, 0.2, 0},
    {CUBE, "", GIVEN("0.3*x+0.1*z", 3), 0.2, 0.2, 0}};

TESTS(means_of_linear_fields_are_exact, 3) {
  JOB j = run_field(&linear[_i]);
  DAT t = job_table(&j, "GOALS", -1);
  const double is[3] = {linear[_i].top, linear[_i].body,
                        linear[_i].top - linear[_i].body};
  for (int k = 0; k < 3; ++k) {
    ck_assert_double_eq_tol(dat_at(&t, k, "value"), is[k], 1e-10);
    ck_assert_double_eq_tol(dat_at(&t, k, "error"), 0.0, 1e-10);
  }
}

/* Goal D is T less B, and so is its error. */
static void check_difference(const dat *t) {
  double error[3];
  for (int k = 0; k < 3; ++k) error[k] = dat_at(t, k, "error");
  ck_assert_double_eq_tol(error[2], error[0] - error[1],
                          1e-10 * (fabs(error[0]) + fabs(error[1])));
}

/* What the border prescribes between the nodes is in the error; with the body
 * force of that field its mean over the body is known too. */
#define FORCED(u, last, force) \
  GIVEN(u, last) "*DLOAD\nBODY, BX, \"-" force "*700/(1.3*0.4)\"\n"
static const field square[] = {
    {PLANE, ", TYPE=CPE3\n0.5", FORCED("x^2", 2, "2"), 1.0 / 3.0, 1.0 / 3.0, 0},
    {PLANE, ", TYPE=CAX3", FORCED("x^2", 2, "3"), 0.5, 0.5, 0},
    {CUBE, "",
     "*BOUNDARY\nBORDER, 1, 2, 0\nBORDER, 3, 3, \"x^2+y^2\"\n"
     "*DLOAD\nBODY, BZ, \"-4*1000/2.6\"\n",
     4.0 / 3.0, 2.0 / 3.0, 2}};

TESTS(errors_of_means_have_what_is_between_the_nodes, 3) {
  JOB j = run_field(&square[_i]);
  DAT t = job_table(&j, "GOALS", -1);
  const double found = dat_at(&t, 0, "value"), is = square[_i].top;
  ck_assert_double_gt(fabs(found - is), 1e-3);
  ck_assert_double_eq_tol(found + dat_at(&t, 0, "error"), is, 1e-10);
  const double lacks = square[_i].body - dat_at(&t, 1, "value");
  ck_assert_double_eq_tol(dat_at(&t, 1, "error"), lacks, 0.05 * fabs(lacks));
  check_difference(&t);
}

/* A ring that is warmed grows by u = x/100, which elements have: the mean over
 * an arc, not over its chords. */
#define WARMED "*BOUNDARY\nBOTTOM, 2\nLEFT, 1\n*TEMPERATURE\nBODY, 10.\n"
static const field round_ones[] = {
    {RING, ", TYPE=CPS3", WARMED, 0.02 / M_PI, 0.28 / 9.0 / M_PI, 0},
    {RING, ", TYPE=CAX3", WARMED, M_PI / 400.0, 0.45 * M_PI / 112.0, 0}};

TESTS(errors_of_means_have_what_is_beyond_chords, 2) {
  JOB j = run_field(&round_ones[_i]);
  DAT t = job_table(&j, "GOALS", -1);
  for (int k = 0; k < 2; ++k) {
    const double is = k == 0 ? round_ones[_i].top : round_ones[_i].body;
    const double lacks = is - dat_at(&t, k, "value");
    ck_assert_double_gt(fabs(lacks), 1e-6);
    ck_assert_double_eq_tol(dat_at(&t, k, "error"), lacks, 0.08 * fabs(lacks));
  }
  check_difference(&t);
}

/* ---- mirror images ------------------------------------------------------- */

enum { GOALS = 18 };

/* The verdicts of all goals, one after the other. */
static void take_verdicts(const job *j, char *text, size_t size) {
  static const char name[] = "\"verdict\": ";
  FREED char *json = job_file(j, "json");
  text[0] = '\0';
  for (char *at = json; (at = strstr(at, name)) != NULL;) {
    at += strlen(name);
    snprintf(text + strlen(text), size - strlen(text), "%.*s ",
             (int)strcspn(at, ",}\n"), at);
  }
}

/* A block between two planes of symmetry, pressed on its foot, with pressures
 * next to the planes and to the edges, or its image in x, y or both: other
 * nodes are first. */
static void mirrored(int image, double of[GOALS][4], char verdicts[999]) {
  static const char *const columns[] = {"value", "error", "band",
                                        "contact_ends"};
  const int flip[2] = {image % 2, image / 2};
  const mesh_change change = {
      .map = {flip[0] ? "1-x^1.3" : "x^1.3", flip[1] ? "1-y^1.2" : "y^1.2"}};
  char path[100], goals[GOALS * 100] = "";
  FREED int *number = NULL;
  JOB j = job_begin("mirrored");
  snprintf(path, sizeof path, "%s/mirrored.msh", j.dir);
  FILE *f = fopen(path, "w");
  ck_assert_ptr_nonnull(f);
  ck_assert(scene_mesh_write(f, "box 6 6 2 1 1 0.5", &change, &number));
  fclose(f);
  for (int i = 0; i < GOALS - 2; ++i) {
    const double x = 0.26 * (i % 4) + 0.05, y = 0.95 - 0.26 * (i / 4);
    snprintf(goals + strlen(goals), sizeof goals - strlen(goals),
             "*GOAL, NAME=P%d, QUANTITY=PRESSURE, CONTACT=C, RADIUS=%g\n"
             "%g, %g, 0.\n",
             i, 0.24 + 0.012 * i, flip[0] ? 1 - x : x, flip[1] ? 1 - y : y);
  }
  snprintf(goals + strlen(goals), sizeof goals - strlen(goals),
           "*GOAL, NAME=H, QUANTITY=PRESSURE, CONTACT=C\n%d, %d, 0.\n", flip[0],
           !flip[1]);
  job_write(&j, "mirrored.inp",
            "*MESH, FILE=mirrored.msh\n*MATERIAL, NAME=M\n*ELASTIC\n"
            "1000., 0.3\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0., 0.\n0., 0., 1.\n"
            "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n%s"
            "*GOAL, NAME=N, QUANTITY=FORCE, CONTACT=C\n*STEP\n*STATIC\n"
            "*BOUNDARY\nLEFT, 1\nBACK, 2\n*DSLOAD\nTOP, P, \"1+(%s)*(%s)\"\n"
            "*PRINT, GOALS\n*END STEP\n",
            goals, flip[0] ? "1-x" : "x", flip[1] ? "1-y" : "y");
  ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
  DAT t = job_table(&j, "GOALS", -1);
  ck_assert_int_eq(t.n_row, GOALS);
  take_verdicts(&j, verdicts, 999);
  for (int i = 0; i < GOALS; ++i)
    for (int k = 0; k < 4; ++k) of[i][k] = dat_at(&t, i, columns[k]);
}

TEST(goals_of_mirror_images_are_the_same) {
  double of[4][GOALS][4];
  char verdicts[4][999];
  int known = 0;
  for (int k = 0; k < 4; ++k) mirrored(k, of[k], verdicts[k]);
  for (int k = 1; k < 4; ++k) ck_assert_str_eq(verdicts[0], verdicts[k]);
  for (int i = 0; i < GOALS * 4; ++i) {
    const double a = of[0][i / 4][i % 4];
    known += i % 4 == 1 && !isnan(a);
    for (int k = 1; k < 4; ++k) {
      const double b = of[k][i / 4][i % 4];
      ck_assert_msg((isnan(a) && isnan(b)) || fabs(a - b) <= 1e-8 * fabs(a),
                    "goal %d, number %d: %.12g, %.12g", i / 4, i % 4, a, b);
    }
  }
  ck_assert_int_ge(known, GOALS / 3);
}

/* ---- halves and thicknesses ---------------------------------------------- */

enum { HALF_GOALS = 5 };

/* A block 1 high that its foot presses on a bump, from its plane of symmetry on
 * or on both sides of it; value, error and band of pressures at it, beyond it
 * and beside it, of the largest one, and of the width. */
static void press_bump(int both, double thickness, double of[HALF_GOALS][3],
                       char verdicts[999]) {
  static const char *const columns[] = {"value", "error", "band"};
  JOB j = job_begin("bump");
  const double at = both;
  block_file_write(&j, (int[]){20 * (1 + both), 6}, (double[]){1.0 + both, 1.0},
                   1);
  job_write(
      &j, "bump.inp",
      "*PARAMETER\nA = %g\n*MESH, FILE=block.msh\n*MATERIAL, NAME=M\n"
      "*ELASTIC\n1000., 0.3\n"
      "*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=CPS3, THICKNESS=%g\n"
      "*SOLID SECTION, ELSET=UPPER, MATERIAL=M, TYPE=CPS3, THICKNESS=%g\n"
      "*OBSTACLE, NAME=O, TYPE=GAP\n\"0.12*(x-A)^2\"\n"
      "*CONTACT, NAME=C, GROUP=TOP, OBSTACLE=O\n"
      "*GOAL, NAME=P, QUANTITY=PRESSURE, CONTACT=C, RADIUS=0.3\n%g, 1.\n"
      "*GOAL, NAME=Q, QUANTITY=PRESSURE, CONTACT=C, RADIUS=0.4\n%g, 1.\n"
      "*GOAL, NAME=R, QUANTITY=PRESSURE, CONTACT=C, RADIUS=0.3\n%g, 1.\n"
      "*GOAL, NAME=S, QUANTITY=PRESSURE, CONTACT=C\n"
      "*GOAL, NAME=W, QUANTITY=WIDTH, CONTACT=C\n*STEP\n*STATIC\n"
      "*BOUNDARY\nCONTACT, 1\nCONTACT, 2, 2, 0.05\n%s*PRINT, GOALS, TOTALS\n"
      "*END STEP\n",
      at, thickness, 2 * thickness, at, at + 0.12, at + 0.35,
      both ? "" : "LEFT, 1\n");
  ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
  DAT t = job_table(&j, "GOALS", -1);
  const double most = job_value(&j, "TOTALS", -1, "pressure_max");
  ck_assert_double_gt(dat_at(&t, 0, "value"), 0.7 * most);
  ck_assert_double_lt(dat_at(&t, 0, "value"), most);
  take_verdicts(&j, verdicts, 999);
  for (int i = 0; i < HALF_GOALS; ++i)
    for (int k = 0; k < 3; ++k)
      of[i][k] = dat_at(&t, i, columns[k]) * (both || i < 4 ? 1.0 : 2.0);
}

/* Errors have more to recover from where there are both, a deeper mesh, and the
 * mean round the largest pressure is as wide as its zone on that side. */
TEST(goals_of_halves_and_of_thick_plates_are_the_same) {
  double half[HALF_GOALS][3], of[HALF_GOALS][3];
  char verdicts[2][999];
  press_bump(0, 1.0, half, verdicts[0]);
  for (int both = 0; both < 2; ++both) {
    press_bump(both, 0.7, of, verdicts[1]);
    if (!both) ck_assert_str_eq(verdicts[0], verdicts[1]);
    for (int i = 0; i < HALF_GOALS; ++i)
      for (int k = 0; k < (!both ? 3 : i != 3); ++k)
        ck_assert_msg(fabs(of[i][k] - half[i][k]) <= 1e-7 * fabs(half[i][k]),
                      "%d: goal %d, number %d: %.12g, %.12g", both, i, k,
                      of[i][k], half[i][k]);
  }
}

/* A strip, length x 1, of squares 1/n, with contact goals. */
static job strip(int length, int n, const char *gap, const char *cards) {
  job j = job_begin("strip");
  job_write(
      &j, "strip.geo",
      "Point(1) = {0, 0, 0}; Point(2) = {%d, 0, 0};\n"
      "Point(3) = {%d, 1, 0}; Point(4) = {0, 1, 0};\n"
      "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4};\n"
      "Line(4) = {4, 1}; Curve Loop(1) = {1:4};\n"
      "Plane Surface(1) = {1}; Transfinite Surface{1};\n"
      "Transfinite Curve{1, 3} = %d; Transfinite Curve{2, 4} = %d;\n"
      "Physical Surface(\"BODY\") = {1}; Physical Curve(\"FOOT\") = {1};\n"
      "Physical Curve(\"END\") = {2}; Physical Curve(\"TOP\") = {3};\n"
      "Physical Curve(\"LEFT\") = {4};\n",
      length, length, length * n + 1, n + 1);
  job_write(&j, "strip.inp",
            "*MESH, FILE=strip.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=CPS3\n"
            "*OBSTACLE, NAME=O, TYPE=GAP\n\"%s\"\n"
            "*CONTACT, NAME=C, GROUP=FOOT, OBSTACLE=O\n"
            "*GOAL, NAME=WIDE, QUANTITY=WIDTH, CONTACT=C\n"
            "*GOAL, NAME=PEAK, QUANTITY=PRESSURE, CONTACT=C\n"
            "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1\n%s*PRINT, GOALS, ZONES\n"
            "*END STEP\n",
            gap, cards);
  ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
  return j;
}

/* A heavy strip on the floor, lifted at its end: of 60 lengths half is lifted
 * but for a height or two (a beam), and the pressures rise within the last two
 * heights alone, to where nodes begin to be open. */
TEST(width_ends_between_closed_and_open_nodes) {
  JOB j =
      strip(60, 2, "0", "*DLOAD\nBODY, BY, -1E-6\n*DSLOAD\nEND, TY, 1.5E-5\n");
  DAT t = job_table(&j, "GOALS", -1), z = job_table(&j, "ZONES", -1);
  const double at = dat_at(&z, 0, "extent");
  ck_assert_double_eq_tol(at, 30.0, 2.0);
  ck_assert_double_eq_tol(dat_at(&t, 0, "value"), at, 0.5);
  ck_assert_double_ge(dat_at(&t, 0, "band"), 0.5);
}

/* A thin layer on a flat parabola, whose pressure goes to zero along a line: by
 * three quarters of the zone its end is an edge too near. That of squares of
 * 1/8 is at 39.80. */
TEST(width_of_a_thin_layer_ends_at_its_last_nodes) {
  JOB j = strip(60, 2, "1E-6*x^2", "TOP, 1\nTOP, 2, 2, -0.0016\n");
  DAT t = job_table(&j, "GOALS", -1);
  const double band = dat_at(&t, 0, "band");
  ck_assert_double_eq_tol(dat_at(&t, 0, "corrected"), 39.80, band);
  ck_assert(band >= 0.5 && band < 0.7);
}

/* A layer under a flat punch with a rounded edge: the largest pressure, near
 * the edge, is 42.07 by RADIUS=0.08 on squares of 1/48. A mean that half its
 * radius would change is one over few nodes. */
TEST(band_of_the_largest_pressure_has_a_narrow_peak) {
  char verdicts[80];
  for (int fine = 0; fine < 2; ++fine) {
    JOB j = strip(fine ? 3 : 6, fine ? 16 : 8, "0.1*max(0, x - 2)^2",
                  "TOP, 1\nTOP, 2, 2, -0.03\n");
    DAT t = job_table(&j, "GOALS", -1);
    const double off = 42.07 - dat_at(&t, 1, "corrected");
    ck_assert_double_le(fabs(off), dat_at(&t, 1, "band"));
    ck_assert_double_le(dat_at(&t, 1, "band"), 0.3 * 42.07);
    take_verdicts(&j, verdicts, sizeof verdicts);
    ck_assert_int_eq(strstr(verdicts, "few_nodes") != NULL, fine);
  }
}

/* A long strip has the pressure of its loads below it, here with a top of 100
 * that is round at one end, and a pointed one at the other, where a node has
 * more and the mean over 30 less: 101.2 - 0.4*30*105/768. */
TEST(largest_pressure_is_where_the_mean_is) {
  JOB j = strip(60, 2, "0",
                "TOP, 1\nEND, 1\n*DSLOAD\nTOP, P, "
                "\"max(100 - 0.012*x^2, 77.2 + 0.4*x)\"\n");
  DAT t = job_table(&j, "GOALS", -1);
  ck_assert_double_eq_tol(dat_at(&t, 1, "value"), 100.0, 0.05);
}

UNIT_MAIN("goals_means")
