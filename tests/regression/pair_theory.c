/*
 * Bodies against each other, against closed forms: Hertz, Cattaneo and Mindlin,
 * two half planes with friction, the rigid obstacle as limit, Lame's rings
 * under heat, creep and a course of the interference, a tied cantilever.
 */
#include "support/job.h"
#include "support/unit.h"

const int job_without_fields = 1;

static job run_deck(const char *geo, const char *deck, const char *words) {
  job j = job_with("pair", geo, "%s", deck);
  CK_EXIT(job_run(&j, words), 0, j);
  return j;
}

static void ck_near(const char *what, double is, double expected, double tol) {
  ck_assert_msg(fabs(is - expected) <= tol * fabs(expected),
                "%s: %.10g, expected %.10g within %g %%", what, is, expected,
                100 * tol);
}

static double largest_defect(const job *j, int n_block) {
  double most = 0;
  for (int k = 0; k < n_block; ++k)
    most =
        fmax(most, fabs(job_value(j, "ENERGY", k, "energy_defect_relative")));
  return most;
}

#define ROLLERS "input/roller/rollers.geo"
#define RINGS "input/press_fit/press_fit.geo"

/* ---- Hertz ---------------------------------------------------------------
 */

static const char spheres[] =
    "*PARAMETER\nP = 100.\nRA = 10.\nRB = 15.\nE1 = 70.D3\nE2 = 210.D3\n"
    "R1 = \"RA\"\nR2 = \"RB\"\nN1 = 20\nN2 = 28\nHALF = 1\n"
    "A = \"(3*P*RA*RB/(RA + RB)/4*0.91*(1/E1 + 1/E2))^(1/3)\"\n"
    "*MESH, FILE=rollers.geo\n*MATERIAL, NAME=A\n*ELASTIC\n<E1>, 0.3\n"
    "*MATERIAL, NAME=B\n*ELASTIC\n<E2>, 0.3\n"
    "*SOLID SECTION, ELSET=LOWER, MATERIAL=A, TYPE=CAX3\n"
    "*SOLID SECTION, ELSET=UPPER, MATERIAL=B, TYPE=CAX3\n"
    "*CONTACT PAIR, NAME=POLE\nLOWER SURFACE, UPPER SURFACE\n"
    "*STEP\n*STATIC\n*BOUNDARY\nAXIS, 1\nBOTTOM, 2\n*DSLOAD\n"
    "TOP, P, \"P/(pi*RB^2)\"\n*PRINT, CONTACT, TOTALS, ZONES, ENERGY\n"
    "*END STEP\n";

/* a^3 = 3 P R/(4 E*), p0 = 3 P/(2 pi a^2), p = p0 sqrt(1 - r^2/a^2). */
TESTS(spheres_of_two_materials, 3) {
  const struct {
    const char *words;
    double E1, E2;
  } cases[] = {{"", 70e3, 210e3},
               {"-D E1=210.D3 -D E2=70.D3", 210e3, 70e3},
               {"-D N1=28 -D N2=20", 70e3, 210e3}};
  const double pi = acos(-1.0), P = 100, R = 6;
  const double Es = 1 / (0.91 * (1 / cases[_i].E1 + 1 / cases[_i].E2));
  const double a = cbrt(3 * P * R / (4 * Es)), p0 = 3 * P / (2 * pi * a * a);
  JOB j = run_deck(ROLLERS, spheres, cases[_i].words);
  DAT z = job_table(&j, "ZONES", -1), c = job_table(&j, "CONTACT", -1);
  const int slip = dat_zone(&z, 1);
  ck_near("a", fmax(dat_at(&z, slip, "r_from"), dat_at(&z, slip, "r_to")), a,
          0.005);
  ck_near("p0", job_value(&j, "TOTALS", -1, "pressure_max"), p0, 0.01);
  for (int i = 0; i < c.n_row; ++i) {
    const double r = dat_at(&c, i, "r") / a;
    if (r < 0.9)
      ck_assert_double_eq_tol(dat_at(&c, i, "pressure") / p0, sqrt(1 - r * r),
                              0.015);
  }
  ck_near("P", job_value(&j, "TOTALS", -1, "force_z"), -P * (_i == 1 ? -1 : 1),
          1e-9);
}

/* ---- friction between half planes ----------------------------------------
 */

/* Two equal rollers, pressed, then pushed up to Q = 0.9 mu P in ten increments
 * (Cattaneo, Mindlin): the middle sticks up to b sqrt(1 - Q/(mu P)), to half
 * an element at both ends. */
TEST(stick_zone_of_equal_rollers) {
  const double pi = acos(-1.0), mu = 0.2, P = 10;
  const double b = sqrt(4 * P * 8 * 0.91 / (pi * 200));
  JOB j = job_deck("input/roller/two_rollers", "-D Q=1.8 -D N1=10 -D N2=14");
  for (int k = 1; k <= 10; ++k) {
    DAT z = job_table(&j, "ZONES", k);
    const double Q = 0.18 * k, stick = b * sqrt(1 - Q / (mu * P));
    const int row = dat_zone(&z, 2);
    const double ends[] = {dat_at(&z, row, "x_from"), dat_at(&z, row, "x_to")};
    for (int e = 0; e < 2; ++e)
      ck_assert_msg(fabs(fabs(ends[e]) - stick) < b / 20,
                    "Q/(mu P) = %g: %g, expected %g", Q / (mu * P), ends[e],
                    stick);
    ck_assert_double_lt(ends[0] * ends[1], 0);
    ck_near("Q", job_value(&j, "TOTALS", k, "force_x"), Q, 1e-9);
  }
  ck_near("p0", job_value(&j, "TOTALS", -1, "pressure_max"), 2 * P / (pi * b),
          0.005);
  ck_assert_double_le(largest_defect(&j, 11), 1e-10);
}

#define PUSH(factor)                                                   \
  "TOP, TX, \"Q/(2*R)*(" factor ")\"\nTOP, TY, \"1.5*Q/R^2*x*(" factor \
  ")\"\nBOTTOM, TX, \"-Q/(2*R)*(" factor                               \
  ")\"\nBOTTOM, TY, \"1.5*Q/R^2*x*(" factor ")\"\n"

/* The same, pushed to and fro between -mu P/2 and mu P/2: the heat of a cycle
 * is 0.036193629 (mu P)^2/E*, of the relative displacement of two bodies with
 * 1/E* = 2 (1 - nu^2)/E. */
TEST(heat_of_a_cycle) {
  static const char deck[] =
      "*PARAMETER\nR = 8.\nP = 1.\nMU = 0.2\nE = 200.\nQ = \"MU*P/2\"\n"
      "R1 = \"R\"\nR2 = \"R\"\nN1 = 14\nN2 = 20\n"
      "A = \"sqrt(4*P*R*0.91/(pi*E))\"\n"
      "*MESH, FILE=rollers.geo\n*MATERIAL, NAME=M\n*ELASTIC\n<E>, 0.3\n"
      "*SOLID SECTION, ELSET=LOWER, MATERIAL=M, TYPE=CPE3\n"
      "*SOLID SECTION, ELSET=UPPER, MATERIAL=M, TYPE=CPE3\n"
      "*CONTACT PAIR, NAME=LINE\nLOWER SURFACE, UPPER SURFACE\n"
      "*FRICTION, CONTACT=LINE, LAW=COULOMB\n<MU>\n"
      "*STEP\n*STATIC\n*BOUNDARY\nPIN, 1, 2\nEND, 2\n*DSLOAD\n"
      "TOP, P, \"P/(2*R)\"\nBOTTOM, P, \"P/(2*R)\"\n"
      "*PRINT, LOOP, ENERGY\n*END STEP\n"
      "*STEP\n*QUASISTATIC\n0.5, 1.\n*DSLOAD\n" PUSH("t - 1") "*END STEP\n"
      "*STEP\n*QUASISTATIC\n0.5, 4.\n*DSLOAD\n" PUSH("abs(t - 4) - 1")
      "*END STEP\n";
  const double E = 200 / (2 * 0.91), limit = 0.2;
  JOB j = run_deck(ROLLERS, deck, "");
  ck_near("heat", job_value(&j, "LOOP", -1, "loop_area"),
          0.036193629 * limit * limit / E, 0.02);
  ck_assert_double_le(largest_defect(&j, 11), 1e-10);
}

/*
 * Roller and block of different materials (NAFEMS CGS-1) under a load so small
 * that both are half planes, mu = 0.1: surfaces drag each other sideways
 * (Dundurs' beta = 1/7), and pressures above those of Hertz. With pieces of
 * constant traction on the half planes (Flamant's solution, 241 on 2.2 a,
 * friction against the whole slip): p0 1.0191 of Hertz's, a 0.9996, stick up
 * to 0.1506 a.
 */
TEST(friction_of_two_materials) {
  const double pi = acos(-1.0), P = 35;
  const double a = sqrt(4 * P * 50 * 0.91 * (1 / 70e3 + 1 / 210e3) / pi);
  JOB j;
  CK_EXIT(job_run_with(&j, "input/roller/roller",
                       "*FRICTION, CONTACT=LINE, LAW=COULOMB\n0.1\n", 0,
                       "-D P=35 -D N1=14 -D N2=20"),
          0, j);
  DAT z = job_table(&j, "ZONES", -1);
  ck_near("p0", job_value(&j, "TOTALS", -1, "pressure_max"),
          1.0191 * 2 * P / (pi * a), 0.005);
  ck_near("stick", fabs(dat_at(&z, dat_zone(&z, 2), "x_from")), 0.1506 * a,
          0.2);
  ck_near("a", fabs(dat_at(&z, dat_zone(&z, 1), "x_from")), 0.9996 * a, 0.005);
}

/* ---- the rigid obstacle as limit -----------------------------------------
 */

#define BLOCKS "tests/regression/mesh/pair.geo"
#define BODIES(E1, E2)                                     \
  "*MESH, FILE=pair.geo\n*MATERIAL, NAME=A\n*ELASTIC\n" E1 \
  ", 0.3\n*MATERIAL, NAME=B\n*ELASTIC\n" E2                \
  ", 0.3\n*SOLID SECTION, ELSET=LOWER, MATERIAL=A\n"       \
  "*SOLID SECTION, ELSET=UPPER, MATERIAL=B\n"
#define FRICTION "*FRICTION, CONTACT=P, LAW=COULOMB\n0.3\n"

/* A block pressed obliquely on one whose E is 1e6 times its own, or on a
 * plane. */
TEST(stiff_master_is_a_plane) {
  static const char step[] = FRICTION
      "*STEP\n*QUASISTATIC\n0.5, 1.\n*BOUNDARY\nBOTTOM, 1, 2\n*DSLOAD\n"
      "TOP, P, \"1 + 4*x\"\nTOP, TX, 0.3\n*PRINT, CONTACT\n*END STEP\n";
  static const char *const contacts[] = {
      "*CONTACT PAIR, NAME=P\nUNDER, OVER\n",
      "*OBSTACLE, NAME=O, TYPE=PLANE\n0, 1\n0, 1\n"
      "*CONTACT, NAME=P, GROUP=OVER, OBSTACLE=O\n"};
  static const char *const names[] = {"f_n", "f_t", "u_t", "gap"};
  job j[2];
  dat c[2];
  for (int k = 0; k < 2; ++k) {
    PRINTED(deck, "*PARAMETER\nN = 6\nM = 8\n%s%s%s", BODIES("1.E9", "1000."),
            contacts[k], step);
    j[k] = run_deck(BLOCKS, deck, "");
    c[k] = job_table(&j[k], "CONTACT", -1);
  }
  ck_assert_int_eq(c[0].n_row, c[1].n_row);
  int n_status[3] = {0};
  for (int i = 0; i < c[0].n_row; ++i) {
    for (int k = 0; k < 4; ++k)
      ck_assert_double_eq_tol(dat_at(&c[0], i, names[k]),
                              dat_at(&c[1], i, names[k]),
                              1e-5 * dat_max(&c[1], names[k]));
    ++n_status[(int)dat_at(&c[0], i, "status")];
  }
  for (int k = 0; k < 3; ++k) ck_assert_int_gt(n_status[k], 0);
  for (int k = 0; k < 2; ++k) {
    dat_free(&c[k]);
    job_end(&j[k]);
  }
}

/* A stiff punch that only the pair holds, its edges on nodes of the block: as
 * master or as slave it does the same. */
TEST(stiff_punch_is_slave_or_master) {
  double energy[2];
  for (int k = 0; k < 2; ++k) {
    PRINTED(deck,
            "*PARAMETER\nN = 20\nM = 10\nC = 0.3\n" BODIES("1000.", "1.E9")
             "*CONTACT PAIR, NAME=P, SLAVE=%s\nUNDER, OVER\n"
             "*STEP\n*STATIC\n*BOUNDARY\nBOTTOM, 1, 2\nTOP, 1\n"
             "*DSLOAD\nTOP, P, \"3 + 2*x\"\n*PRINT, TOTALS, ENERGY\n"
             "*END STEP\n",
             k == 0 ? "FIRST" : "SECOND");
    JOB j = run_deck(BLOCKS, deck, "");
    energy[k] = job_value(&j, "ENERGY", -1, "strain_energy");
    ck_near("force", job_value(&j, "TOTALS", -1, "normal"), 1.6, 1e-9);
  }
  ck_near("energy", energy[1], energy[0], 1e-6);
}

/* A slave node that its support holds has no multiplier, its part of the force
 * is the neighbour's: the resultant of the pair is the load all the same. */
TEST(resultant_with_held_nodes) {
  JOB j = run_deck(BLOCKS,
                   "*PARAMETER\nN = 4\nM = 7\n" BODIES(
                       "1000.",
                       "1000.") "*CONTACT PAIR, NAME=P, SLAVE=FIRST\n"
                                "UNDER, OVER\nAXIS, 0.25, 0.\n" FRICTION
                                "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1, 2\n"
                                "BOTTOM, 1, 2\n*DSLOAD\nTOP, P, \"3 + x\"\n"
                                "*PRINT, TOTALS, NODES, REACTIONS\n*END STEP\n",
                   "");
  DAT n = job_table(&j, "NODES", -1);
  double force[2] = {0, 0}, moment = 0;
  for (int i = 0; i < n.n_row; ++i) {
    const double x = dat_at(&n, i, "x"), y = dat_at(&n, i, "y");
    const double f[] = {dat_at(&n, i, "contact_x"), dat_at(&n, i, "contact_y")};
    if (f[1] > 0) continue;
    force[0] += f[0];
    force[1] += f[1];
    moment += (x - 0.25) * f[1] - y * f[0];
  }
  ck_near("normal", job_value(&j, "TOTALS", -1, "normal"), -force[1], 1e-12);
  ck_near("force_x", job_value(&j, "TOTALS", -1, "force_x"), force[0], 1e-9);
  ck_near("torque", job_value(&j, "TOTALS", -1, "torque"), moment, 1e-9);
  ck_near("area", job_value(&j, "TOTALS", -1, "closed_area"), 1, 1e-9);
}

/* ---- rings ---------------------------------------------------------------
 */

/* Growth of the radius R1 = 20 of a ring up to R0 = 10, or R2 = 40, under the
 * pressure 1 there, plane stress (Lame). */
static double hub_of(double E, double nu) {
  return 20 / E * ((1600. + 400.) / (1600. - 400.) + nu);
}

static double ring_of(double E, double nu) {
  return 20 / E * ((400. + 100.) / (400. - 100.) - nu);
}

#define FIT(ring, hub, type, gap)                           \
  "*PARAMETER\nN = 32\nM = 45\n*MESH, FILE=press_fit.geo\n" \
  "*MATERIAL, NAME=RING\n*ELASTIC\n210.D3, 0.3\n" ring      \
  "*MATERIAL, NAME=HUB\n*ELASTIC\n70.D3, 0.33\n" hub        \
  "*SOLID SECTION, ELSET=RING, MATERIAL=RING, TYPE=" type   \
  "\n*SOLID SECTION, ELSET=HUB, MATERIAL=HUB, TYPE=" type   \
  "\n*AMPLITUDE, NAME=COURSE, TIME=TOTAL TIME\n"            \
  "0, 0, 1, 0.5, 2, 1, 6, 1\n*CONTACT PAIR, NAME=FIT, ADJUST=YES" gap
#define HELD "*BOUNDARY\nFLAT X, 1\nFLAT Y, 2\n"

static void check_fit(const job *j, int k, double p, double mean) {
  const double pi = acos(-1.0);
  DAT c = job_table(j, "CONTACT", k);
  ck_near("mean pressure", job_value(j, "TOTALS", k, "normal"), p * 20 * pi / 2,
          mean);
  for (int i = 0; i < c.n_row; ++i)
    ck_near("pressure", dat_at(&c, i, "pressure"), p, 0.01);
}

/* A ring of steel heated by 80 in a hub of aluminium; plane strain is plane
 * stress with E/(1 - nu^2), nu/(1 - nu), (1 + nu) alpha. */
TEST(shrink_fit_by_heat) {
#define HEAT(type)                                        \
  FIT("*EXPANSION\n1.2D-5\n", "", type, "\nSEAT, BORE\n") \
  "*STEP\n*QUASISTATIC\n0.5, 1.\n" HELD                   \
  "*TEMPERATURE\nRING, 80.\n"                             \
  "*PRINT, CONTACT, TOTALS, ENERGY\n*END STEP\n"
  const double growth = 1.2e-5 * 80 * 20, nu = 0.3, v = 0.33;
  job j = run_deck(RINGS, HEAT("CPS3"), "");
  check_fit(&j, -1, growth / (ring_of(210e3, nu) + hub_of(70e3, v)), 0.001);
  ck_assert_double_le(largest_defect(&j, 2), 1e-12);
  job_end(&j);
  j = run_deck(RINGS, HEAT("CPE3"), "");
  check_fit(&j, -1,
            (1 + nu) * growth /
                (ring_of(210e3 / (1 - nu * nu), nu / (1 - nu)) +
                 hub_of(70e3 / (1 - v * v), v / (1 - v))),
            0.001);
  job_end(&j);
}

/* The interference follows its amplitude, then the hub creeps (Maxwell, tau):
 * (c_ring + c_hub) dp/dt = -c_hub p/tau. Orders of the integrators for a dt of
 * 0.25: first 10 %, second 0.3 %, fourth 0.05 %, what the mesh leaves. */
TESTS(hub_that_creeps, 7) {
  static const struct {
    const char *name;
    double tol;
  } integrators[] = {{"EULER", 0.1},
                     {"HEUN", 3.5e-3},
                     {"RK4", 5e-4},
                     {"MIDPOINT", 3.5e-3},
                     {"BACKWARD", 0.1},
                     {"EXPONENTIAL", 3.5e-3},
                     {"THETA, THETA=0.7", 0.05}};
  const double c_ring = ring_of(210e3, 0.3), c_hub = hub_of(70e3, 0.33);
  const double p0 = 0.02 / (c_ring + c_hub);
  PRINTED(deck, FIT("", "*INELASTIC, LAW=MAXWELL\n2.\n", "CPS3",
               ", AMPLITUDE=COURSE\nSEAT, BORE\nINTERFERENCE, 0.02\n")
           "*STEP\n*QUASISTATIC\n0.5, 2.\n" HELD
           "*PRINT, CONTACT, TOTALS, ENERGY\n*END STEP\n"
           "*STEP\n*VISCO, INTEGRATOR=%s\n0.25, 4.\n*END STEP\n",
           integrators[_i].name);
  JOB j = run_deck(RINGS, deck, "");
  for (int k = 0; k < 4; ++k) check_fit(&j, k, p0 * 0.25 * (k + 1), 0.001);
  ck_near("relaxed", job_value(&j, "TOTALS", -1, "normal"),
          job_value(&j, "TOTALS", 3, "normal") *
              exp(-c_hub / (c_ring + c_hub) * 4. / 2.),
          integrators[_i].tol);
  ck_assert_double_le(largest_defect(&j, 20), 1e-12);
}

/* Whole rings pressed into each other and twisted to 80 % of what friction
 * holds: once the nodes are on the master the forces of both sides leave no
 * moment. */
TEST(twisted_rings_leave_no_moment) {
  JOB j = job_begin("twist");
  job_write(
      &j, "rings.geo",
      "N = 128; M = 180; w = 0.3; h = Pi * 40 / N;\nPoint(1) = {0, 0, 0};\n"
      "r[] = {10, 20, 20, 40}; n[] = {N, N, M, M};\n"
      "For k In {0 : 3}\n  For i In {0 : 3}\n    a = i * Pi / 2;\n"
      "    If (k > 1)\n      a += w;\n    EndIf\n"
      "    Point(10 * k + 10 + i) = {r[k] * Cos(a), r[k] * Sin(a), 0, h};\n"
      "  EndFor\n  For i In {0 : 3}\n"
      "    Circle(10 * k + 10 + i) = {10 * k + 10 + i, 1,"
      " 10 * k + 10 + (i + 1) %% 4};\n"
      "    Transfinite Curve{10 * k + 10 + i} = n[k] / 4 + 1;\n  EndFor\n"
      "  Curve Loop(10 * k + 10) = {10 * k + 10 : 10 * k + 13};\nEndFor\n"
      "Plane Surface(1) = {20, 10}; Plane Surface(2) = {40, 30};\n"
      "Physical Surface(\"RING\") = {1}; Physical Surface(\"HUB\") = {2};\n"
      "Physical Curve(\"SHAFT\") = {10 : 13};\n"
      "Physical Curve(\"SEAT\") = {20 : 23};\n"
      "Physical Curve(\"BORE\") = {30 : 33};\n"
      "Physical Curve(\"RIM\") = {40 : 43};\n");
  job_write(&j, "twist.inp",
            "*MESH, FILE=rings.geo\n*MATERIAL, NAME=M\n*ELASTIC\n210.D3, 0.3\n"
            "*SOLID SECTION, ELSET=RING, MATERIAL=M, TYPE=CPS3\n"
            "*SOLID SECTION, ELSET=HUB, MATERIAL=M, TYPE=CPS3\n"
            "*CONTACT PAIR, NAME=FIT, ADJUST=YES\nSEAT, BORE\n"
            "INTERFERENCE, 0.02\nAXIS, 0, 0\n"
            "*FRICTION, CONTACT=FIT, LAW=COULOMB\n0.3\n"
            "*STEP\n*STATIC\n*BOUNDARY\nRIM, 1, 2\n*PRINT, TOTALS\n*END STEP\n"
            "*STEP\n*QUASISTATIC\n0.5, 1.\n*DSLOAD\nSHAFT, TX, \"-10*y\"\n"
            "SHAFT, TY, \"10*x\"\n*END STEP\n");
  ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
  const double torque = job_value(&j, "TOTALS", -1, "torque");
  /* traction 10 r on r = 10, once around, polygons of 128 edges */
  ck_near("torque", torque, -2 * acos(-1.0) * 1e4, 2e-3);
  ck_assert_double_le(job_value(&j, "TOTALS", -1, "moment_of_both"),
                      1e-9 * fabs(torque));
}

/* ---- ties ----------------------------------------------------------------
 */

/* A cantilever of two meshes tied along an inclined cut, against one mesh of
 * the coarser size all over, and of the finer. */
TEST(tied_cantilever) {
  static const char geo[] =
      "DefineConstant[ N = 8, M = 11, ONE = 0 ];\n"
      "Macro Part\n"
      "  For i In {0 : 3}\n"
      "    Point(k + i) = {x[i], (i == 1 || i == 2), 0, 1 / n};\n  EndFor\n"
      "Return\n"
      "x[] = {0, 0, 4.5, 3.5}; k = 1; n = N; Call Part;\n"
      "x[] = {8, 8, 4.5, 3.5}; k = 11; n = M; Call Part;\n"
      "Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, "
      "1};\n"
      "Line(11) = {11, 12};\n"
      "If (ONE)\n  Line(12) = {12, 3}; Line(14) = {4, 11};\n"
      "  Curve Loop(2) = {11, 12, 3, 14};\n"
      "Else\n  Line(12) = {12, 13}; Line(13) = {13, 14}; Line(14) = {14, 11};\n"
      "  Curve Loop(2) = {11, 12, 13, 14};\n"
      "  Physical Curve(\"A\") = {3}; Physical Curve(\"B\") = {13};\nEndIf\n"
      "Curve Loop(1) = {1, 2, 3, 4};\n"
      "Plane Surface(1) = {1}; Plane Surface(2) = {2};\n"
      "Physical Surface(\"BEAM\") = {1, 2};\n"
      "Physical Curve(\"CLAMP\") = {1}; Physical Curve(\"TIP\") = {11};\n";
  static const char *const words[] = {"-D ONE=1 -D M=8", "", "-D N=11 -D M=8",
                                      "-D ONE=1 -D N=11"};
  double energy[4], condition[4];
  for (int k = 0; k < 4; ++k) {
    JOB j = job_begin("beam");
    job_write(&j, "beam.geo", "%s", geo);
    job_write(&j, "beam.inp",
              "*MESH, FILE=beam.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1.E5, 0.3\n"
              "*SOLID SECTION, ELSET=BEAM, MATERIAL=M\n%s*STEP\n*STATIC\n"
              "*BOUNDARY\nCLAMP, 1, 2\n*DSLOAD\nTIP, TY, 1.\n*PRINT, ENERGY\n"
              "*END STEP\n",
              k % 3 == 0 ? "" : "*TIE, NAME=T\nA, B\n");
    ck_assert_msg(job_run(&j, words[k]) == 0, "%s", j.errors);
    energy[k] = job_value(&j, "ENERGY", -1, "strain_energy");
    FREED char *list = job_file(&j, "lst");
    ck_assert_int_eq(
        sscanf(strstr(list, "  condition "), " condition %lf", &condition[k]),
        1);
  }
  for (int k = 1; k < 3; ++k) {
    ck_near("energy", energy[k], 0.5 * (energy[0] + energy[3]),
            0.6 * (energy[3] / energy[0] - 1));
    /* a mode without energy would have no bound */
    ck_assert_double_le(condition[k], 3 * condition[3]);
  }
}

UNIT_MAIN("pair_theory")
