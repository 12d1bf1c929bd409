/*
 * Pairs of bodies that supports hold or drive along the contact: friction, wear
 * and the slave that AUTO chooses.
 */
#include "support/job.h"
#include "support/unit.h"

const int job_without_fields = 1;

/* Two wedges without friction on each other, the lower one held at its right
 * side and its foot, the upper one at its left side: action is reaction, and
 * the supports bear the slope of the load. */
TESTS(wedges_between_walls_bear_the_slope_of_the_load, 2) {
  const double slope = 0.1, load = 5.0;
  JOB j = job_begin("wedges");
  job_write(&j, "wedges.geo",
            "Macro Quad\n"
            "  q = newp; Point(q) = {0, y[0], 0}; Point(q+1) = {1, y[1], 0};\n"
            "  Point(q+2) = {1, y[2], 0}; Point(q+3) = {0, y[3], 0};\n"
            "  l = newl; For i In {0:3}\n"
            "    Line(l+i) = {q+i, q+(i+1)%%4};\n"
            "    Transfinite Curve{l+i} = n + 1;\n  EndFor\n"
            "  Curve Loop(l) = {l:l+3}; Plane Surface(l) = {l};\n"
            "  Transfinite Surface{l};\nReturn\n"
            "y[] = {-1, -1, %g, 0}; n = 4;\nCall Quad;\na = l;\n"
            "y[] = {0, %g, 1, 1}; n = 3;\nCall Quad;\nb = l;\n"
            "Physical Surface(\"LOWER\") = {a};\n"
            "Physical Surface(\"UPPER\") = {b};\n"
            "Physical Curve(\"FOOT\") = {a};\n"
            "Physical Curve(\"RIGHT\") = {a+1};\n"
            "Physical Curve(\"UNDER\") = {a+2};\n"
            "Physical Curve(\"OVER\") = {b};\n"
            "Physical Curve(\"TOP\") = {b+2};\n"
            "Physical Curve(\"LEFT\") = {b+3};\n",
            slope, slope);
  job_write(&j, "wedges.inp",
            "*MESH, FILE=wedges.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
            "*SOLID SECTION, ELSET=LOWER, MATERIAL=M\n"
            "*SOLID SECTION, ELSET=UPPER, MATERIAL=M\n"
            "*CONTACT PAIR, NAME=P, SLAVE=%s\nUNDER, OVER\n*STEP\n*STATIC\n"
            "*BOUNDARY\nFOOT, 2\nRIGHT, 1\nLEFT, 1\n*DSLOAD\nTOP, P, %g\n"
            "*PRINT, TOTALS, NODES, REACTIONS\n*END STEP\n",
            _i ? "SECOND" : "FIRST", load);
  ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
  DAT all = job_table(&j, "TOTALS", -1), s = job_table(&j, "REACTIONS", -1);
  ck_assert_double_eq_tol(dat_sum(&s, "reaction_x"), 0.0, 1e-11);
  ck_assert_double_eq_tol(fabs(dat_at(&all, 0, "force_x")), slope * load,
                          1e-11);
  ck_assert_double_eq_tol(dat_sum(&s, "reaction_y"), load, 1e-11);
  ck_assert_double_eq_tol(dat_at(&all, 0, "normal"), load * hypot(1, slope),
                          1e-11);
  ck_assert_double_eq_tol(dat_at(&all, 0, "tangential"), 0.0, 1e-11);
}

/* A slider that its side, or all of it, drives over an elastic body drags it by
 * mu N; two bodies held along the contact wear by their motion, whichever is
 * the slave. */
TESTS(driven_bodies_slide_on_each_other, 8) {
  static const struct {
    const char *pair, *supports;
    double drag, depth;
  } cases[] = {
      {"", "TOP, 1, 2\nFOOT, 1, 1, 0.02\n", 0.15, 0},
      {"", "TOP, 1, 2\nLOWER, 1, 1, 0.02\n", 0.15, 0},
      {", SLAVE=FIRST", "TOP, 2\nUPPER, 1\nLOWER, 1, 1, 0.02\n", 0, 1e-5},
      {", SLAVE=SECOND", "TOP, 2\nUPPER, 1\nLOWER, 1, 1, 0.02\n", 0, 1e-5},
      {", SLAVE=FIRST", "TOP, 2\nUPPER, 1, 1, 0.02\nLOWER, 1\n", 0, 1e-5},
      {", SLAVE=FIRST", "TOP, 2\nUPPER, 1, 1, 0.02\nLOWER, 1\n", 0.15, 0},
      {", SLAVE=SECOND", "TOP, 1, 2\nLOWER, 1, 1, 0.02\n", 0.15, 0},
      {", SLAVE=FIRST", "TOP, 1, 2\nLOWER, 1, 1, 0.02\n", 0, 0}};
  const int wears = cases[_i].depth > 0;
  JOB j = job_begin("driven");
  job_copy(&j, "tests/regression/mesh/pair.geo");
  job_write(&j, "driven.geo",
            "Include \"pair.geo\";\nPhysical Curve(\"FOOT\") = {2};\n");
  job_write(&j, "driven.inp",
            "*PARAMETER\nN = 3\nM = 8\n*MESH, FILE=driven.geo\n"
            "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n"
            "*SOLID SECTION, ELSET=LOWER, MATERIAL=M\n"
            "*SOLID SECTION, ELSET=UPPER, MATERIAL=M\n"
            "*CONTACT PAIR, NAME=P%s\nUNDER, OVER\n%s*STEP\n*QUASISTATIC\n"
            "1., 1.\n*BOUNDARY\n%s*DSLOAD\nBOTTOM, P, 0.5\n"
            "*PRINT, TOTALS, CONTACT%s\n*END STEP\n",
            cases[_i].pair,
            wears ? "*WEAR, CONTACT=P, COEFFICIENT=1E-3\n"
                  : "*FRICTION, CONTACT=P, LAW=COULOMB\n0.3\n",
            cases[_i].supports, wears ? ", WEAR" : "");
  ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
  const char *told = strstr(j.errors, "P4036:");
  ck_assert_int_eq(told != NULL, _i == 7);
  if (told != NULL) ck_assert_ptr_null(strstr(told + 1, "P4036:"));
  DAT all = job_table(&j, "TOTALS", -1), c = job_table(&j, "CONTACT", -1);
  ck_assert_double_eq_tol(fabs(dat_at(&all, 0, "tangential")), cases[_i].drag,
                          1e-9);
  if (wears) {
    DAT w = job_table(&j, "WEAR", -1);
    for (int i = 0; i < w.n_row; ++i) {
      ck_assert_double_eq_tol(dat_at(&w, i, "depth"), cases[_i].depth, 1e-13);
      ck_assert_double_eq_tol(fabs(dat_at(&c, i, "u_t")), 0.02, 1e-14);
    }
    ck_assert_double_eq_tol(dat_at(&all, 0, "worn_volume"), 1e-5, 1e-13);
  }
}

/* Two blocks on a plane of symmetry, the upper one also against a wall, past
 * which the lower one expands: nodes that supports hold have friction if they
 * are those of the master, else it is told. A plane of symmetry is not told,
 * what supports hold beyond the other surface does not choose the slave, what
 * they hold wholly is the master across a gap too. */
TESTS(blocks_slide_past_a_wall, 6) {
  static const struct {
    const char *sizes, *pair, *wall;
    double modulus; /* of the upper one, Pa */
    int lower, told;
  } cases[] = {
      {"", "AUTO", "WALL, 1\n", 300, 1, 0},
      {"", "FIRST", "WALL, 1\n", 300, 1, 0},
      {"", "SECOND", "WALL, 1\n", 300, 0, 1},
      {"", "FIRST", "", 300, 1, 0},
      {"C = 0.2\nD = -0.2\n", "AUTO", "FOOT, 1\n", 5000, 1, 0},
      {"G = 0.5\n", "AUTO", "UPPER, 1\nTOP, 2, 2, -0.51\n", 300, 1, 0}};
  JOB j = job_begin("wall");
  job_copy(&j, "tests/regression/mesh/pair.geo");
  job_write(&j, "wall.geo",
            "Include \"pair.geo\";\nPhysical Curve(\"WALL\") = {12};\n"
            "Physical Curve(\"FOOT\") = {2};\n");
  job_write(&j, "wall.inp",
            "*PARAMETER\nN = 4\nM = 6\n%s*MESH, FILE=wall.geo\n"
            "*MATERIAL, NAME=A\n*ELASTIC\n1000., 0.45\n"
            "*MATERIAL, NAME=B\n*ELASTIC\n%g, 0.3\n"
            "*SOLID SECTION, ELSET=LOWER, MATERIAL=A\n"
            "*SOLID SECTION, ELSET=UPPER, MATERIAL=B\n"
            "*CONTACT PAIR, NAME=P, SLAVE=%s\nUNDER, OVER\n"
            "*FRICTION, CONTACT=P, LAW=COULOMB\n0.5\n*STEP\n*QUASISTATIC\n"
            "0.5, 1.\n*BOUNDARY\nBOTTOM, 2\nLEFT, 1\n%s*DSLOAD\n"
            "TOP, P, 10.\n*PRINT, CONTACT\n*END STEP\n",
            cases[_i].sizes, cases[_i].modulus, cases[_i].pair, cases[_i].wall);
  ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
  ck_assert_int_eq(strstr(j.errors, "P4036:") != NULL, cases[_i].told);
  DAT c = job_table(&j, "CONTACT", -1);
  ck_assert_int_eq(c.n_row <= 5, cases[_i].lower);
  for (int i = 0; i < c.n_row && _i < 3; ++i)
    if (dat_at(&c, i, "x") > 0.99)
      ck_assert_double_eq_tol(fabs(dat_at(&c, i, "f_t")),
                              cases[_i].told ? 0 : 0.5 * dat_at(&c, i, "f_n"),
                              1e-9);
}

/* A driven body wears one that a plane of symmetry holds: the next *VISCO step,
 * where nothing changes, has no increment without length, although the held
 * node of the slave comes from its masters by rounding. */
TEST(held_slave_starts_a_step_smoothly) {
  JOB j =
      job_with("worn", "tests/regression/mesh/pair.geo",
               "*PARAMETER\nN = 3\nM = 7\nC = -0.3\n*MESH, FILE=pair.geo\n"
               "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
               "*INELASTIC, LAW=MAXWELL\n4.\n"
               "*SOLID SECTION, ELSET=LOWER, MATERIAL=M\n"
               "*SOLID SECTION, ELSET=UPPER, MATERIAL=M\n"
               "*CONTACT PAIR, NAME=P, SLAVE=FIRST\nUNDER, OVER\n"
               "*WEAR, CONTACT=P, COEFFICIENT=1E-5\n"
               "*STEP\n*VISCO, INTEGRATOR=BACKWARD\n0.5, 1.\n*BOUNDARY\n"
               "BOTTOM, 2\nLEFT, 1\nUPPER, 1, 1, 0.0028\nUPPER, 2, 2, -0.0011\n"
               "*PRINT, ENERGY\n*END STEP\n"
               "*STEP\n*VISCO, INTEGRATOR=BACKWARD\n0.5, 1.\n*END STEP\n");
  ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
  ck_assert_double_eq(job_value(&j, "ENERGY", -1, "increment"), 2);
}

/* A block that hangs over the edge of another: whether its own top is among the
 * masters, or that of a third above it too, what is beyond the edge meets
 * nothing. */
TESTS(back_of_a_slave_is_no_partner, 2) {
  static const char *const masters[] = {"under", "under, top", "under, over"};
  double is[3];
  JOB j = job_begin("edge");
  for (int k = 0; k < 3; ++k) {
    job_write(&j, "edge.geo",
              "Macro Quad\n"
              "  q = newp; Point(q) = {a, b, 0}; Point(q+1) = {a+2, b, 0};\n"
              "  Point(q+2) = {a+2, b+1, 0}; Point(q+3) = {a, b+1, 0};\n"
              "  l = newl; Line(l) = {q, q+1}; Line(l+1) = {q+1, q+2};\n"
              "  Line(l+2) = {q+2, q+3}; Line(l+3) = {q+3, q};\n"
              "  Transfinite Curve{l, l+2} = 6;\n"
              "  Transfinite Curve{l+1, l+3} = 4;\n"
              "  Curve Loop(l) = {l:l+3}; Plane Surface(l) = {l};\n"
              "  Transfinite Surface{l}; s[] = {l, l, l+1, l+2, l+3};\n"
              "  If (space)\n"
              "    s[] = Extrude {0, 0, 0.5} { Surface{l}; Layers{1}; };\n"
              "    s[] = {s[1], s[2], s[3], s[4], s[5]};\n  EndIf\nReturn\n"
              "space = %d;\na = 0; b = 0; Call Quad;\n"
              "foot = s[1]; under = s[3]; body[] = {s[0]};\n"
              "a = 0.7; b = 1; Call Quad;\n"
              "bottom = s[1]; top = s[3]; body[] += {s[0]};\n"
              "a = 0.7; b = 2.4; Call Quad;\nover = s[3]; lid = s[1];\n"
              "body[] += {s[0]};\n"
              "Physical %s(\"BODY\") = {body[]};\n"
              "Physical %s(\"FOOT\") = {foot, lid};\n"
              "Physical %s(\"UNDER\") = {%s};\n"
              "Physical %s(\"OVER\") = {bottom};\n"
              "Physical %s(\"TOP\") = {top};\n",
              _i, _i ? "Volume" : "Surface", _i ? "Surface" : "Curve",
              _i ? "Surface" : "Curve", masters[k], _i ? "Surface" : "Curve",
              _i ? "Surface" : "Curve");
    job_write(&j, "edge.inp",
              "*MESH, FILE=edge.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
              "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
              "*CONTACT PAIR, NAME=P, SLAVE=SECOND\nUNDER, OVER\n"
              "*FRICTION, CONTACT=P, LAW=COULOMB\n0.5\n*STEP\n*STATIC\n"
              "*BOUNDARY\nFOOT, 1, %d\n*DSLOAD\nTOP, P, 1.\n"
              "*PRINT, TOTALS, CONTACT\n*END STEP\n",
              2 + _i);
    ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
    ck_assert_ptr_null(strstr(j.errors, "P4004"));
    DAT all = job_table(&j, "TOTALS", -1), c = job_table(&j, "CONTACT", -1);
    ck_assert_double_eq_tol(dat_at(&all, 0, "normal"), _i ? 1.0 : 2.0, 1e-9);
    is[k] = 0.0;
    for (int i = 0; i < c.n_row; ++i)
      is[k] = fmax(is[k], dat_at(&c, i, "pressure"));
    ck_assert_double_eq_tol(is[k], is[0], 1e-9);
  }
}

/* A bar on the upper tread of a step, and above the lower one, which it does
 * not reach: whether that is a master too changes nothing, with a node of the
 * bar above the edge or not. */
TESTS(step_of_a_master_is_no_slope, 3) {
  static const struct {
    double edge;
    int space;
  } cases[] = {{1.03, 0}, {1.0, 0}, {1.03, 1}};
  const char *side = cases[_i].space ? "Surface" : "Curve";
  double is[2];
  JOB j = job_begin("stair");
  for (int k = 0; k < 2; ++k) {
    job_write(
        &j, "stair.geo",
        "e = %g; space = %d; h = 0.25; Point(1) = {0, 0, 0, h};\n"
        "Point(2) = {e, 0, 0, h}; Point(3) = {e, 0.5, 0, h};\n"
        "Point(4) = {0, 0.5, 0, h}; Point(5) = {2, 0, 0, h};\n"
        "Point(6) = {2, 0.4, 0, h}; Point(7) = {e, 0.4, 0, h};\n"
        "Line(1) = {1, 2}; Line(2) = {2, 5}; Line(3) = {5, 6};\n"
        "Line(4) = {6, 7}; Line(5) = {7, 3}; Line(6) = {3, 4};\n"
        "Line(7) = {4, 1}; Curve Loop(1) = {1:7};\n"
        "Plane Surface(1) = {1};\n"
        "Point(11) = {-0.1 * space, 0.5, 0, h}; Point(12) = {2, 0.5, 0, h};\n"
        "Point(13) = {2, 0.8, 0, h}; Point(14) = {-0.1 * space, 0.8, 0, h};\n"
        "Line(11) = {11, 12}; Line(12) = {12, 13};\n"
        "Line(13) = {13, 14}; Line(14) = {14, 11};\n"
        "Transfinite Curve{11, 13} = 9; Curve Loop(2) = {11:14};\n"
        "Plane Surface(2) = {2};\n"
        "body[] = {1, 2}; foot[] = {1, 2}; bar[] = {11}; top[] = {13};\n"
        "tread[] = {6}; low[] = {4};\n"
        "If (space)\n"
        "  a[] = Extrude {0, 0, 0.4} { Surface{1}; Layers{1}; };\n"
        "  b[] = Extrude {0, 0, 0.4} { Surface{2}; Layers{2}; };\n"
        "  body[] = {a[1], b[1]}; foot[] = {a[2], a[3]};\n"
        "  tread[] = {a[7]}; low[] = {a[5]}; bar[] = {b[2]};\n"
        "  top[] = {b[4]};\nEndIf\n"
        "Physical %s(\"BODY\") = {body[]};\n"
        "Physical %s(\"FOOT\") = {foot[]};\n"
        "Physical %s(\"TREAD\") = {tread[]%s};\n"
        "Physical %s(\"BAR\") = {bar[]};\n"
        "Physical %s(\"TOP\") = {top[]};\n",
        cases[_i].edge, cases[_i].space, cases[_i].space ? "Volume" : "Surface",
        side, side, k ? ", low[]" : "", side, side);
    job_write(&j, "stair.inp",
              "*MESH, FILE=stair.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1.E5, 0.3\n"
              "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
              "*CONTACT PAIR, NAME=P, SLAVE=SECOND\nTREAD, BAR\n"
              "*FRICTION, CONTACT=P, LAW=COULOMB\n0.5\n*STEP\n*STATIC\n"
              "*BOUNDARY\nFOOT, 1, %d\n*DSLOAD\nTOP, P, \"2-x\"\n"
              "*PRINT, NODES\n*END STEP\n",
              2 + cases[_i].space);
    ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
    DAT t = job_table(&j, "NODES", -1);
    is[k] = 0.0;
    for (int i = 0; i < t.n_row; ++i)
      if (dat_at(&t, i, "x") > 1.999 && dat_at(&t, i, "y") > 0.79)
        is[k] = dat_at(&t, i, "u_y");
  }
  ck_assert_double_lt(is[0], 0.0);
  ck_assert_double_eq_tol(is[1], is[0], 1e-9 * fabs(is[0]));
}

UNIT_MAIN("pair_supports")
