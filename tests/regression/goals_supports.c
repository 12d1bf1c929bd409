/*
 * *GOAL under prescribed displacements, next to ends of supports, and in bodies
 * of two materials or temperatures, against limits of meshes, each with four
 * times the elements of the one before; the radius of a pressure next to a
 * plane of symmetry.
 */
#include "support/goal_body.h"
#include "support/unit.h"

const int job_without_fields = 1;

#define ENERGY "*GOAL, NAME=E, QUANTITY=ENERGY\n"
#define PRESSED "*STEP\n*STATIC\n*BOUNDARY\nTOP, 1\nTOP, 2, 2, -0.01\n"
#define CLAMPED "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1, 2\n*DSLOAD\nTOP, P, 10.\n"

/* By supports alone the energy of a mesh is too large, by loads too small; by
 * both, along supports that bend, or where friction rubs, by a part of each. */
TEST(energies_by_loads_and_by_supports) {
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
       0.0065382663, 3.0},
      /* values of 64 x 64 and 128 x 128 squares, extrapolated */
      {PLANE,
       "*FRICTION, CONTACT=C, LAW=COULOMB\n0.02\n"
       "*STEP\n*QUASISTATIC\n1., 1.\n*BOUNDARY\nLEFT, 1\nRIGHT, 1\n"
       "TOP, 2, 2, \"-0.01*(1+0.5*cos(pi*x/2))\"\n",
       0.14964158, 3.0}};
  for (int k = 0; k < 6; ++k) {
    PRINTED(cards, ENERGY "%s", rows[k].step);
    JOB j = body_of_block(16, rows[k].on, cards);
    goal_check(&j, rows[k].exact, 0.6, 1.3, rows[k].wide);
  }
}

/* In a ring the hoop strains vary within the elements, which is no error. */
TEST(energy_of_a_ring_that_is_pressed) {
  JOB j = body_of_type(", TYPE=CAX3", "rect 16 16 1 1 alternate at 1 0",
                       PLANE CONTACT ENERGY
                       "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1\n"
                       "TOP, 2, 2, -0.002\n");
  goal_check(&j, 0.01944272377, 0.8, 1.2, 3.0);
}

/* Next to the corners of a clamp stresses are infinite, and at the edge of a
 * roller in a straight side; not where it has all of the side. */
TEST(ends_of_supports_are_not_reliable) {
  job j = body_of_block(8, PLANE, NORMAL ENERGY PRESSED);
  ck_assert(goal_has_verdict(&j, "N", "support_end"));
  ck_assert(goal_has_verdict(&j, "E", "support_end"));
  goal_check(&j, 23.118663, 0.3, 1.0, 3.0);
  job_end(&j);
  j = body_of_block(
      8, PLANE,
      "*GOAL, NAME=U, QUANTITY=DISPLACEMENT, COMPONENT=1\n2., 1.\n" CLAMPED);
  ck_assert(goal_has_verdict(&j, "U", "support_end"));
  goal_check(&j, 0.0070721533, 0.3, 1.0, 3.0);
  job_end(&j);
  j = body_of_block(16, PLANE,
                    ENERGY
                    "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1\n*DSLOAD\n"
                    "TOP, P, \"10*(1+cos(pi*x/2))\"\n");
  ck_assert(goal_has_verdict(&j, "E", "reliable"));
  goal_check(&j, 0.13444394, 0.8, 1.2, 0.5);
  job_end(&j);
}

/* The same along the edges of a cube. */
TEST(ends_of_supports_in_space) {
  static const char on[] = "PLANE\n0., 0., 0.\n0., 0., 1." CONTACT NORMAL;
  static const char *const hold[] = {"TOP, 1, 2\n", "TOP, 1\nFRONT, 2\n",
                                     "LEFT, 1\nFRONT, 2\n"};
  for (int k = 0; k < 3; ++k) {
    PRINTED(cards, "%s*STEP\n*STATIC\n*BOUNDARY\nTOP, 3, 3, -0.01\n%s", on,
            hold[k]);
    JOB j = body_of("box 4 4 4 1 1 1", cards);
    ck_assert(goal_has_verdict(&j, "N", k < 2 ? "support_end" : "reliable"));
    if (k == 0) goal_check(&j, 10.3045, 0.3, 1.0, 3.0);
  }
}

/* All of the base slips, at 0.5 whatever the pressure: the force is 1. A node
 * that a support holds has a part of it, which along the normal is lost. */
TEST(nodes_of_supports_have_a_part_of_the_force) {
  static const char *const hold[] = {
      "LEFT, 2, 2, -0.002\n", "LEFT, 1, 1, 0.05\n", "CORNER, 1, 1, 0.05\n", ""};
  for (int k = 0; k < 4; ++k) {
    PRINTED(cards,
            "*FRICTION, CONTACT=C, LAW=TRESCA\n0.5\n"
            "*GOAL, NAME=T, QUANTITY=FORCE, CONTACT=C, COMPONENT=TANGENT\n"
            "*STEP\n*QUASISTATIC\n1., 1.\n*BOUNDARY\nTOP, 1, 1, 0.05\n"
            "TOP, 2, 2, -0.01\n%s",
            hold[k]);
    JOB j = body_of_block(8, "GAP\n\"-0.005\"", cards);
    DAT t = job_table(&j, "GOALS", -1);
    const double off = -1.0 - dat_at(&t, 0, "corrected");
    const double band = dat_at(&t, 0, "band");
    ck_assert_msg(fabs(off) <= band, "row %d: %g off, band %g", k, off, band);
    ck_assert_int_eq(goal_has_verdict(&j, "T", "reliable"), k > 0);
    ck_assert(k == 0 ? band > 0.01 : band < 1e-12 && band > 1e-14);
  }
}

/* Where a coarse mesh sticks, and a sum whose terms cancel. */
TEST(zeros_are_not_exact) {
  job j = body_of_block(8, PLANE,
                        "*FRICTION, CONTACT=C, LAW=COULOMB\n5.\n"
                        "*GOAL, NAME=W, QUANTITY=FRICTION WORK\n"
                        "*STEP\n*QUASISTATIC\n1., 1.\n*BOUNDARY\nLEFT, 1\n"
                        "*DSLOAD\nTOP, P, 10.\n");
  ck_assert(goal_has_verdict(&j, "W", "no_slip"));
  job_end(&j);
  j = body_of_block(
      8, PLANE,
      "*GOAL, NAME=S, QUANTITY=STRESS, COMPONENT=XX, GROUP=BODY\n" CLAMPED);
  DAT t = job_table(&j, "GOALS", -1);
  ck_assert_double_le(fabs(dat_at(&t, 0, "corrected")), dat_at(&t, 0, "band"));
  job_end(&j);
}

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
  body_write_mesh(&j, "rect 12 12 1 1 alternate layers", &change);
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
  CK_EXIT(job_run(&j, ""), 0, j);
  return j;
}

/* A row of the goals U, V, M, S, P, E. */
typedef struct expected {
  int row;
  double exact, least, most, wide;
} expected;

/* At a free side stresses are infinite; the mean over TOP and that over RIGHT
 * have the same part of their errors, by the theorem of Betti. The energy under
 * the pressure is half of it times the mean over TOP: its part is near that. */
TEST(materials_that_meet_at_a_free_side) {
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
        {5, 0.4108281, 0.6, 0.75, 1.0}}},
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
    JOB j = of_layers(rows[k].of, rows[k].cards);
    ck_assert(goal_has_verdict(&j, "S", "support_end"));
    for (int i = 0; i < 4 && rows[k].is[i].wide > 0.0; ++i) {
      const expected *e = &rows[k].is[i];
      goal_check_row(&j, e->row, e->exact, e->least, e->most, e->wide);
    }
  }
}

/* Not where a plane of symmetry is normal to the interface, and within, but
 * where that turns. */
TEST(materials_that_meet_smoothly) {
  job j = of_layers((layers){3.0, 0.0, "CPE3", NULL}, WALLS WAVE);
  ck_assert(goal_has_verdict(&j, "P", "reliable"));
  ck_assert(goal_has_verdict(&j, "E", "reliable"));
  goal_check_row(&j, 4, -0.015275949, 0.9, 1.1, 0.3);
  goal_check_row(&j, 5, 0.12590357, 0.9, 1.1, 0.3);
  job_end(&j);
  j = of_layers((layers){3.0, 0.0, "CAX3", NULL},
                "*BOUNDARY\nRIGHT, 1\nBOTTOM, 2\n" WAVE);
  ck_assert(!goal_has_verdict(&j, "E", "support_end"));
  job_end(&j);
  j = of_layers((layers){3.0, 0.0, "CPE3", "y+0.5*y*(1-y)*abs(cos(pi*x))"},
                WALLS WAVE);
  ck_assert(goal_has_verdict(&j, "E", "support_end"));
  goal_check_row(&j, 5, 0.13734705, 0.85, 1.1, 0.4);
  job_end(&j);
}

/* One temperature that two cards give is one: the goals of a body that expands
 * freely have the errors of the cold one. */
TEST(temperatures_that_do_not_meet) {
  static const char *const heat[] = {"",
                                     "*TEMPERATURE\nSOFT, 10.\nHARD, 10.\n"};
  double error[2], band[2];
  for (int k = 0; k < 2; ++k) {
    PRINTED(cards, "%s%s", SIDES WAVE, heat[k]);
    JOB j = of_layers((layers){1.0, 1e-3, "CPE3", NULL}, cards);
    DAT t = job_table(&j, "GOALS", -1);
    error[k] = dat_at(&t, 4, "error");
    band[k] = dat_at(&t, 4, "band");
  }
  ck_assert_double_eq_tol(error[1], error[0], 1e-9 * fabs(error[0]));
  ck_assert_double_eq_tol(band[1], band[0], 1e-9 * fabs(band[0]));
}

#define BOTH "*TEMPERATURE\nSOFT, 10.\nHARD, 10.\n"
#define SLOPES "*TEMPERATURE\nSOFT, \"20*(1-x)\"\nHARD, \"5*x-7.5\"\n"

/* Strains without stress count as what supports prescribe: they make the energy
 * of a mesh too large, loads too small, and one does no work on the other. */
TEST(energies_by_loads_and_by_temperatures) {
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
    JOB j = of_layers(rows[k].of, rows[k].cards);
    const expected *e = &rows[k].is;
    goal_check_row(&j, e->row, e->exact, e->least, e->most, e->wide);
  }
}

/* What temperatures are within the elements more than their means: T(y) between
 * walls all round and T(r) of a cylinder between two have closed forms. */
TEST(temperatures_that_vary_within_elements) {
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
      {{1.0, 1e-3, "CAX3", NULL},
       SIDES "TOP, 2\n*DLOAD\nSOFT, BX, \"100*x\"\nHARD, BX, \"100*x\"\n"
             "*TEMPERATURE\nSOFT, \"20*(1-x)\"\nHARD, \"20*(1-x)\"\n",
       {{5, 1.4336633, 0.9, 1.1, 1.5}}},
      {{2.0, 1e-3, "CAX3", NULL},
       WALLS WAVE SLOPES,
       {{0, -0.0043053987, 0.9, 1.1, 0.5}, {2, 0.00088629567, 0.5, 1.5, 3.0}}}};
  for (int k = 0; k < 5; ++k) {
    JOB j = of_layers(rows[k].of, rows[k].cards);
    for (int i = 0; i < 3 && rows[k].is[i].wide > 0.0; ++i) {
      const expected *e = &rows[k].is[i];
      goal_check_row(&j, e->row, e->exact, e->least, e->most, e->wide);
    }
  }
}

/* A disc that a temperature linear in y bends without stress onto an obstacle
 * of that shape, and a pressure: with hardly any friction as without. */
TESTS(energy_of_a_disc_that_heat_bends, 2) {
  JOB j = job_begin("block");
  body_write_mesh(&j, "rect 12 12 1 1 alternate", &(mesh_change){.scale = 1.0});
  job_write(&j, "block.inp",
            "*MESH, FILE=block.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
            "*EXPANSION\n1e-3\n*SOLID SECTION, ELSET=BODY, MATERIAL=M, "
            "TYPE=CAX3\n*OBSTACLE, NAME=O, TYPE=GAP\n\"-0.01*x^2\"\n*CONTACT, "
            "NAME=C, GROUP=BOTTOM, OBSTACLE=O\n*FRICTION, CONTACT=C, "
            "LAW=COULOMB\n%g\n" ENERGY
            "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1\n"
            "*DSLOAD\nTOP, P, 1.\n*TEMPERATURE\nBODY, \"-20*y\"\n"
            "*PRINT, GOALS\n*END STEP\n",
            _i * 1e-6);
  CK_EXIT(job_run(&j, ""), 0, j);
  goal_check_row(&j, 0, M_PI_2 * 1e-3, 0.9, 1.15, 1.0);
}

/* A cylinder of which the hoop is softer than the radius, under a pressure, or
 * expands otherwise by heat: stresses are infinite on the axis. With nu = 0 the
 * first moves by r^k, k^2 the ratio of the moduli (Lekhnitskii), the second by
 * r log r. */
TESTS(materials_that_differ_round_the_axis, 2) {
  static const struct {
    double hoop, energy;
    const char *alpha, *cards;
  } rows[] = {
      {400., 0.49672941, "0., 0., 0.", "*DSLOAD\nRIGHT, P, 10.\n"},
      {1000., 0.039269908, "1E-3, 0., 0.", "*TEMPERATURE\nBODY, 10.\n"}};
  JOB j = job_begin("block");
  body_write_mesh(&j, "rect 12 12 1 1 alternate", &(mesh_change){.scale = 1.0});
  job_write(&j, "block.inp",
            "*MESH, FILE=block.msh\n*MATERIAL, NAME=M\n*ELASTIC, TYPE=ORTHO\n"
            "1000., 1000., %g, 0., 0., 0., 500., 500.,\n500.\n*EXPANSION, "
            "TYPE=ORTHO\n%s\n*SOLID SECTION, ELSET=BODY, MATERIAL=M, "
            "TYPE=CAX3\n" ENERGY
            "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1\n"
            "BOTTOM, 2\n%s*PRINT, GOALS\n*END STEP\n",
            rows[_i].hoop, rows[_i].alpha, rows[_i].cards);
  CK_EXIT(job_run(&j, ""), 0, j);
  ck_assert(goal_has_verdict(&j, "E", "support_end"));
  goal_check_row(&j, 0, rows[_i].energy, 0.3, 1.1, 4.0);
}

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

TEST(materials_that_meet_in_space) {
  static const struct {
    double height;
    const char *hold;
    int sharp;
  } rows[] = {{0.62, "RIGHT, 1\n", 0}, {0.5, "", 1}, {0.67, "RIGHT, 1\n", 1}};
  for (int k = 0; k < 3; ++k) {
    JOB j = job_begin("prism");
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
    CK_EXIT(job_run(&j, ""), 0, j);
    ck_assert_int_eq(goal_has_verdict(&j, "E", "support_end"), rows[k].sharp);
  }
}

/* ---- pressures next to a plane of symmetry ------------------------------- */

static job of_peak(const char *words, const char *gap, const char *radius,
                   const char *hold) {
  PRINTED(on, "GAP\n\"%s\"" CONTACT, gap);
  PRINTED(cards,
          "%s*GOAL, NAME=P, QUANTITY=PRESSURE, CONTACT=C%s\n*STEP\n*STATIC\n"
          "*BOUNDARY\nRIGHT, 1\n%s*PRINT, CONTACT\n",
          on, radius, hold);
  return body_of(words, cards);
}

/* The largest pressure is inside, and the zone grows to the plane at RIGHT: the
 * mean is the same part of it before and after. */
TEST(peaks_do_not_jump_where_a_zone_reaches_a_plane) {
  static const char *const hold[] = {"TOP, 2, 2, -0.029\n",
                                     "TOP, 2, 2, -0.030\n"};
  double part[2];
  for (int k = 0; k < 2; ++k) {
    JOB j =
        of_peak("rect 40 20 1 0.5 alternate", "0.1*(x-0.75)^2", "", hold[k]);
    DAT t = job_table(&j, "GOALS", -1), c = job_table(&j, "CONTACT", -1);
    const double end = dat_at(&c, dat_row_near(&c, "x", 1.0), "pressure");
    ck_assert_int_eq(end > 0.0, k == 1);
    part[k] = dat_at(&t, 0, "corrected") / dat_max(&c, "pressure");
  }
  ck_assert_double_eq_tol(part[1], part[0], 0.003);
}

/* On elements that no smaller mean fits, the largest pressure may be that of
 * its node. */
TEST(peaks_on_few_elements_have_that_of_their_node_in_the_band) {
  job j = of_peak("rect 24 12 1 0.5 alternate", "0.1*(x-0.6)^2", "",
                  "TOP, 2, 2, -0.009\n");
  dat t = job_table(&j, "GOALS", -1), c = job_table(&j, "CONTACT", -1);
  const double off = dat_max(&c, "pressure") - dat_at(&t, 0, "value");
  ck_assert_double_ge(dat_at(&t, 0, "band"), fabs(off));
  dat_free(&t);
  dat_free(&c);
  job_end(&j);
}

/* In space the area is larger by what of it is behind each plane: as much as
 * the pressure there is of the largest. */
TEST(radius_of_a_zone_that_planes_halve) {
  static const char words[] = "box 8 8 3 1 1 0.5";
  static const char gap[] = "0.1*((x-0.7)^2+y^2)";
  static const char hold[] = "FRONT, 2\nTOP, 3, 3, -0.04\n";
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
  PRINTED(
      radius, ", RADIUS=%.15g",
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

/* A single closed node, in a plane of symmetry, has neither. */
TEST(single_nodes_have_no_pressure_and_no_width) {
  job j = of_peak("rect 16 8 1 0.5 alternate", "0.1*(x-1)^2",
                  "\n*GOAL, NAME=W, QUANTITY=WIDTH, CONTACT=C",
                  "TOP, 2, 2, -1.E-6\n");
  ck_assert(goal_has_verdict(&j, "P", "no_zone"));
  ck_assert(goal_has_verdict(&j, "W", "no_zone"));
  job_end(&j);
  j = of_peak("box 4 4 2 1 1 0.5", "0.1*((x-1)^2+y^2)", "",
              "FRONT, 2\nTOP, 3, 3, -1.E-6\n");
  ck_assert(goal_has_verdict(&j, "P", "no_zone"));
  job_end(&j);
}

/* Of the border within the radius of a point a part is closed; or it is within
 * that of the node next to it, not of the point. At a node of the border there
 * is no peak. */
TEST(means_end_at_a_border_that_is_closed_in_part) {
  JOB j = of_peak("box 8 8 1 1 1 0.3", "max(0, y-0.13)",
                  ", RADIUS=0.3\n0.15, 0.25, 0.\n"
                  "*GOAL, NAME=Q, QUANTITY=PRESSURE, CONTACT=C, RADIUS=0.18\n"
                  "0.185, 0., 0.\n"
                  "*GOAL, NAME=R, QUANTITY=PRESSURE, CONTACT=C\n0., 0.125, 0.",
                  "FRONT, 2\nTOP, 3, 3, -0.01\n");
  ck_assert(goal_has_verdict(&j, "P", "no_end"));
  ck_assert(!goal_has_verdict(&j, "Q", "no_end"));
  ck_assert(goal_has_verdict(&j, "R", "no_peak"));
}

/* Next to an end of a line that is no plane of symmetry there is no peak, and
 * where nothing is closed no zone, nor a largest pressure. */
TEST(pressures_at_ends_and_of_an_open_contact) {
  static const char *const at[] = {"F1", "0., 0.", "F2", "2., 0.",
                                   "R1", "0., 1.", "R2", "2., 1."};
  char cards[700] = PLANE CONTACT
      "*OBSTACLE, NAME=FAR, TYPE=PLANE\n0., 9.\n0., -1.\n"
      "*CONTACT, NAME=ROOF, GROUP=TOP, OBSTACLE=FAR\n"
      "*GOAL, NAME=OPEN, QUANTITY=PRESSURE, CONTACT=ROOF\n";
  for (int k = 0; k < 4; ++k)
    snprintf(strchr(cards, '\0'), 100,
             "*GOAL, NAME=%s, QUANTITY=PRESSURE, CONTACT=%s\n%s\n", at[2 * k],
             k < 2 ? "C" : "ROOF", at[2 * k + 1]);
  strcat(cards, "*STEP\n*STATIC\n*BOUNDARY\nCORNER, 1\n*DSLOAD\nTOP, P, 1.\n");
  JOB j = body_of("rect 4 2 2 1 alternate", cards);
  ck_assert(goal_has_verdict(&j, "OPEN", "no_zone"));
  for (int k = 0; k < 4; ++k)
    ck_assert_msg(goal_has_verdict(&j, at[2 * k], "no_peak"), "%s", at[2 * k]);
}

UNIT_MAIN("goals_supports")
