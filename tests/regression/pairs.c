/*
 * Bodies against each other: patch tests through meshes that do not match,
 * ties, a held master against the rigid plane, interference, and what is
 * refused.
 */
#include "scenes/mesh.h"
#include "support/job.h"
#include "support/traced.h"
#include "support/unit.h"

#include <signal.h>

const int job_without_fields = 1;

/* Two blocks of pair.geo or pair3.geo: E and nu of both, cards of the contact,
 * supports, loads. */
typedef struct scene {
  const char *geo, *numbers, *type;
  double E[2], nu;
  const char *joint, *supports, *loads;
} scene;

static job run_scene(const scene *s, const char *words) {
  job j = job_begin("pair");
  PRINTED(path, "tests/regression/mesh/%s.geo", s->geo);
  job_copy(&j, path);
  job_write(&j, "pair.inp",
            "*PARAMETER\n%s\n*MESH, FILE=%s.geo\n"
            "*MATERIAL, NAME=A\n*ELASTIC\n%.17g, %.17g\n"
            "*MATERIAL, NAME=B\n*ELASTIC\n%.17g, %.17g\n"
            "*SOLID SECTION, ELSET=LOWER, MATERIAL=A%s\n"
            "*SOLID SECTION, ELSET=UPPER, MATERIAL=B%s\n%s"
            "*STEP\n*STATIC\n*BOUNDARY\n%s*DSLOAD\n%s"
            "*SOLVER, TOL=1E-13\n"
            "*PRINT, NODES, ELEMENTS, ENERGY%s\n*END STEP\n",
            s->numbers, s->geo, s->E[0], s->nu, s->E[1], s->nu, s->type,
            s->type, s->joint, s->supports, s->loads,
            strstr(s->joint, "*CONTACT") != NULL ? ", CONTACT, TOTALS" : "");
  CK_EXIT(job_run(&j, words), 0, j);
  return j;
}

#define PAIR "*CONTACT PAIR, NAME=P\nUNDER, OVER\n"
#define STICK PAIR "*FRICTION, CONTACT=P, LAW=COULOMB\n0.5\n"
#define WALL(rest)                                         \
  "*OBSTACLE, NAME=W, TYPE=PLANE\n0, 0" rest "\n1, 0" rest \
  "\n*CONTACT, NAME=W, GROUP=LEFT, OBSTACLE=W\n"
#define TIE "*TIE, NAME=P\nUNDER, OVER\n"
/* Pressed by 3 along y, or by 3 and sheared by 1 in axes turned by 30 degrees:
 * c = 0.866, s = 0.5; traction (-s p' + c t, c p' + s t) with p' = -3, t = 1 on
 * top, t times (-s, c) and against it on the sides. */
#define PRESSED "TOP, P, 3.\n"
#define TURNED                                                      \
  "TOP, TX, 2.3660254037844388\nTOP, TY, -2.0980762113533160\n"     \
  "RIGHT, TX, -0.5\nRIGHT, TY, 0.8660254037844386\nLEFT, TX, 0.5\n" \
  "LEFT, TY, -0.8660254037844386\n"
#define ROLLERS "BOTTOM, 2\nLEFT, 1\n"

static const scene patches[] = {
    {"pair", "N = 4", ", TYPE=CPE3", {1e3, 1e3}, 0.3, PAIR, ROLLERS, PRESSED},
    {"pair",
     "N = 7\nM = 4",
     ", TYPE=CPS3",
     {1e3, 1e3},
     0.3,
     PAIR,
     ROLLERS,
     PRESSED},
    {"pair",
     "N = 3\nM = 31",
     ", TYPE=CAX3",
     {1e3, 1e3},
     0.3,
     PAIR,
     ROLLERS,
     PRESSED},
    {"pair",
     "N = 5\nA = 30",
     ", TYPE=CPE3",
     {1e3, 2e3},
     0,
     STICK,
     "BOTTOM, 1, 2\n",
     TURNED},
    {"pair", "N = 5", ", TYPE=CPE3", {1e6, 1}, 0, PAIR, ROLLERS, PRESSED},
    {"pair", "N = 5", ", TYPE=CPE3", {1e3, 1e3}, 0.3, TIE, ROLLERS, PRESSED},
    {"pair",
     "N = 5\nA = 30",
     ", TYPE=CPE3",
     {1e3, 2e3},
     0,
     TIE,
     "BOTTOM, 1, 2\n",
     TURNED},
    {"pair3",
     "N = 2\nM = 3.1",
     "",
     {1e3, 1e3},
     0.3,
     PAIR,
     "BOTTOM, 3\nLEFT, 1\nFRONT, 2\n",
     PRESSED},
    {"pair3",
     "N = 3\nM = 2",
     "",
     {1e3, 2e3},
     0,
     STICK,
     "BOTTOM, 1, 3\n",
     "TOP, P, 3.\nTOP, TX, 1.\nRIGHT, TZ, 1.\nLEFT, TZ, -1.\n"},
    {"pair3",
     "N = 3\nM = 2",
     "",
     {1e3, 2e3},
     0,
     TIE,
     "BOTTOM, 1, 3\n",
     "TOP, P, 3.\nTOP, TX, 1.\nRIGHT, TZ, 1.\nLEFT, TZ, -1.\n"},
    /* nodes whose supports hold both components */
    {"pair",
     "N = 5",
     ", TYPE=CPE3",
     {1e3, 1e3},
     0,
     PAIR,
     "BOTTOM, 2\nLEFT, 1\nLEFT, 2, 2, \"-0.003*y\"\n",
     PRESSED},
    {"pair",
     "N = 5",
     ", TYPE=CPE3",
     {1e3, 1e3},
     0,
     TIE,
     "BOTTOM, 2\nLEFT, 1\nLEFT, 2, 2, \"-0.003*y\"\n",
     PRESSED},
    /* nodes of a pair and an obstacle; a symmetry plane and friction */
    {"pair",
     "N = 4",
     ", TYPE=CPE3",
     {1e3, 1e3},
     0.3,
     PAIR WALL(""),
     "BOTTOM, 2\n",
     "TOP, P, 3.\nRIGHT, P, 1.\n"},
    {"pair",
     "N = 7\nM = 4",
     ", TYPE=CPE3",
     {1e3, 1e3},
     0.3,
     WALL("") PAIR,
     "BOTTOM, 2\n",
     "TOP, P, 3.\nRIGHT, P, 1.\n"},
    {"pair3",
     "N = 2\nM = 3",
     "",
     {1e3, 1e3},
     0.3,
     PAIR WALL(", 0"),
     "BOTTOM, 3\nFRONT, 2\n",
     "TOP, P, 3.\nRIGHT, P, 1.\n"},
    {"pair3",
     "N = 2\nM = 3",
     "",
     {1e3, 1e3},
     0.3,
     STICK,
     "BOTTOM, 3\nLEFT, 1\nFRONT, 2\n",
     PRESSED}};

/* Stress of the patch: [0] for names, [1] values. */
static void check_stress(const scene *s, const job *j) {
  DAT e = job_table(j, "ELEMENTS", -1);
  const int solid = strcmp(s->geo, "pair3") == 0;
  const int axi = strstr(s->type, "CAX3") != NULL;
  const int turned = s->loads[strlen("TOP, ")] == 'T';
  const int sheared = turned || strstr(s->loads, "TZ") != NULL;
  double normal = -3, shear = sheared ? 1 : 0;
  if (turned) { /* sigma = -3 n n + (n t + t n), n = (-s, c), t = (c, s) */
    const double c = sqrt(0.75), q = 0.5;
    normal = -3 * c * c + 2 * c * q;
    shear = 3 * c * q + (c * c - q * q);
  }
  const char *const along = solid ? "stress_zz"
                            : axi ? "stress_zz"
                                  : "stress_yy";
  const char *const across = solid ? "stress_zx"
                             : axi ? "stress_rz"
                                   : "stress_xy";
  for (int i = 0; i < e.n_row; ++i) {
    ck_assert_double_eq_tol(dat_at(&e, i, along), normal, 1e-10 * 3);
    ck_assert_double_eq_tol(dat_at(&e, i, across), shear, 1e-10 * 3);
  }
}

TESTS(patch, sizeof patches / sizeof *patches) {
  const scene *s = &patches[_i];
  JOB j = run_scene(s, "--no-timing");
  check_stress(s, &j);
  DAT e = job_table(&j, "ENERGY", -1);
  ck_assert_double_le(fabs(dat_at(&e, 0, "energy_defect")),
                      1e-12 * dat_at(&e, 0, "external_work"));
  if (strstr(s->joint, "*CONTACT") != NULL) {
    DAT n = job_table(&j, "NODES", -1), t = job_table(&j, "TOTALS", -1);
    static const char *const names[] = {"contact_x", "contact_y", "contact_z",
                                        "contact_r"};
    const int wall = strstr(s->joint, "NAME=W") != NULL; /* bears 2 */
    for (int k = 0; k < 4; ++k)
      if (dat_has(&n, names[k]))
        ck_assert_double_eq_tol(dat_sum(&n, names[k]), wall && k == 0 ? 2 : 0,
                                1e-12 * 3 * 4);
    /* once around the axis moments cancel */
    ck_assert_int_eq(dat_has(&t, "moment_of_both"),
                     strstr(s->type, "CAX3") == NULL);
    if (dat_has(&t, "moment_of_both"))
      ck_assert_double_le(dat_at(&t, 0, "moment_of_both"), 1e-10 * 3);
  }
}

/* ---- ties ---------------------------------------------------------------- */

/* The component that a support holds is its own: the upper block is carried
 * sideways, without shear. */
TEST(supports_hold_components_of_tied_nodes) {
  const scene s = {"pair",
                   "N = 5\nM = 4",
                   ", TYPE=CPE3",
                   {1e3, 2e3},
                   0,
                   "*TIE, NAME=P, SLAVE=SECOND\nUNDER, OVER\n",
                   "BOTTOM, 1, 2\nOVER, 1, 1, 0.001\n",
                   PRESSED};
  JOB j = run_scene(&s, "--no-timing");
  check_stress(&s, &j);
  DAT n = job_table(&j, "NODES", -1);
  ck_assert_double_eq_tol(dat_max(&n, "u_x"), 0.001, 1e-15);
  /* below, above and with the nodes of both: 6 by 6, 5 by 5 at least */
  ck_assert_double_ge(dat_sum(&n, "u_x"), 25 * 0.001 - 1e-12);
}

/* The supports of a body carry what is tied to it: a block of 1 x 1 pressed by
 * 3 and moved by (0.01, 0.02). */
TEST(reactions_of_a_tied_body_are_at_its_master) {
  const scene s = {"pair",
                   "N = 3\nM = 5",
                   ", TYPE=CPE3",
                   {1e3, 1e3},
                   0.3,
                   "*TIE, NAME=P, SLAVE=SECOND\nUNDER, OVER\n",
                   "LOWER, 1, 1, 0.01\nLOWER, 2, 2, 0.02\n",
                   "TOP, P, 3.\nTOP, TX, 1.\n*PRINT, REACTIONS\n"};
  JOB j = run_scene(&s, "--no-timing");
  DAT n = job_table(&j, "REACTIONS", -1), e = job_table(&j, "ENERGY", -1);
  ck_assert_double_eq_tol(dat_sum(&n, "reaction_x"), -1, 1e-12);
  ck_assert_double_eq_tol(dat_sum(&n, "reaction_y"), 3, 1e-12);
  ck_assert_double_le(fabs(dat_at(&e, 0, "energy_defect")),
                      1e-12 * dat_at(&e, 0, "strain_energy"));
}

/* Given as the solution of the tied bodies they are the start, with a contact
 * and without. */
TESTS(initial_displacements_of_tied_bodies_are_compatible, 2) {
  JOB j = job_with("start", "tests/regression/mesh/pair.geo",
                   "*PARAMETER\nN = 4\nM = 6\n*MESH, FILE=pair.geo\n"
                   "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n"
                   "*SOLID SECTION, ELSET=LOWER, MATERIAL=M\n"
                   "*SOLID SECTION, ELSET=UPPER, MATERIAL=M\n"
                   "*TIE, NAME=P\nUNDER, OVER\n%s"
                   "*INITIAL CONDITIONS, TYPE=DISPLACEMENT\n"
                   "LOWER, 2, \"-0.003*y\"\nUPPER, 2, \"-0.003*y\"\n"
                   "*STEP\n*QUASISTATIC\n1., 1.\n*BOUNDARY\nBOTTOM, 1, 2\n"
                   "*DSLOAD\nTOP, P, \"3 + 0*t\"\n*PRINT, NODES\n*END STEP\n",
                   _i ? WALL("") : "");
  CK_EXIT(job_run(&j, "--no-timing"), 0, j);
  DAT n = job_table(&j, "NODES", -1);
  for (int i = 0; i < n.n_row; ++i)
    ck_assert_double_eq_tol(dat_at(&n, i, "u_y"), -3e-3 * dat_at(&n, i, "y"),
                            1e-14);
}

/* A block with one above and one beside it under pressure from all sides, the
 * nodes of their common edge in two ties, also of another number of nodes. */
TESTS(node_of_two_ties_is_of_the_first, 4) {
  static const char *const ties[] = {
      "*TIE, NAME=P, SLAVE=FIRST\nUP, ABOVE\n",
      "*TIE, NAME=Q, SLAVE=FIRST\nASIDE, BESIDE\n",
      "*TIE, NAME=Q, SLAVE=SECOND\nASIDE, BESIDE\n"};
  const int other = _i < 2 ? 1 : 2;
  JOB j = job_with(
      "corner", "tests/regression/mesh/corner.geo",
      "*MESH, FILE=corner.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
      "*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=CPE3\n%s%s*STEP\n"
      "*STATIC\n*BOUNDARY\nBOTTOM, 2\nRIGHT, 1\n*DSLOAD\n"
      "OUTSIDE, P, 3.\n*SOLVER, TOL=1E-13\n*PRINT, ELEMENTS\n*END STEP\n",
      ties[_i % 2 * other], ties[(1 - _i % 2) * other]);
  CK_EXIT(job_run(&j, "--no-timing"), 0, j);
  DAT e = job_table(&j, "ELEMENTS", -1);
  for (int i = 0; i < e.n_row; ++i) {
    ck_assert_double_eq_tol(dat_at(&e, i, "stress_xx"), -3, 3e-10);
    ck_assert_double_eq_tol(dat_at(&e, i, "stress_yy"), -3, 3e-10);
    ck_assert_double_eq_tol(dat_at(&e, i, "stress_xy"), 0, 3e-10);
  }
}

/* ---- which side is the slave --------------------------------------------- */

TESTS(slave_is_chosen, 30) {
  static const struct {
    const char *numbers;
    double E[2];
    const char *card, *supports, *told;
  } cases[] = {
      {"N = 4\nM = 5", {1, 1}, "", ROLLERS, "slave UNDER (coarser)"},
      {"N = 5\nM = 4", {1, 1}, "", ROLLERS, "slave OVER (coarser)"},
      {"N = 4\nM = 4", {1, 1}, "", ROLLERS, "slave UNDER (of equal size"},
      {"N = 5\nM = 4", {1, 2.9}, "", ROLLERS, "slave OVER (coarser)"},
      {"N = 5\nM = 4", {1, 3.1}, "", ROLLERS, "slave UNDER (softer)"},
      {"N = 4\nM = 5", {2.9, 1}, "", ROLLERS, "slave UNDER (coarser)"},
      {"N = 4\nM = 5", {3.1, 1}, "", ROLLERS, "slave OVER (softer)"},
      {"N = 4\nM = 5",
       {1, 9},
       "",
       "LOWER, 1, 2\nTOP, 1\n",
       "slave OVER (the other is held)"},
      {"N = 5\nM = 4",
       {9, 1},
       "",
       "UPPER, 1, 2\nBOTTOM, 1, 2\n",
       "slave UNDER (the other is held)"},
      {"N = 4\nM = 5",
       {1, 9},
       ", SLAVE=SECOND",
       ROLLERS,
       "slave OVER (by SLAVE=)"},
      {"N = 5\nM = 4",
       {9, 1},
       ", SLAVE=FIRST",
       ROLLERS,
       "slave UNDER (by SLAVE=)"},
      {"N = 4\nM = 5",
       {1, 9},
       "",
       "LOWER, 1\nBOTTOM, 2\nTOP, 1\n",
       "slave OVER (the other is held)"},
      {"N = 5\nM = 4",
       {9, 1},
       "",
       "UPPER, 1\nBOTTOM, 1, 2\n",
       "slave UNDER (the other is held)"},
      {"N = 4\nM = 5",
       {1, 1},
       "",
       "LOWER, 1, 2\nLEFT, 1\nRIGHT, 2\n",
       "slave OVER (the other is held)"},
      {"N = 4\nM = 5",
       {1, 9},
       ", SLAVE=FIRST",
       "LOWER, 1\nBOTTOM, 2\nTOP, 1\n",
       "slave UNDER (by SLAVE=)"}};
  const int led = strcmp(cases[_i / 2].card, ", SLAVE=FIRST") == 0 &&
                  cases[_i / 2].E[1] > 1;
  PRINTED(joint, "*%s, NAME=P%s\nUNDER, OVER\n",
          _i % 2 ? "TIE" : "CONTACT PAIR", cases[_i / 2].card);
  const scene s = {"pair",
                   cases[_i / 2].numbers,
                   ", TYPE=CPE3",
                   {cases[_i / 2].E[0], cases[_i / 2].E[1]},
                   0.3,
                   joint,
                   cases[_i / 2].supports,
                   "TOP, P, 1e-3\n"};
  JOB j = run_scene(&s, "--no-timing");
  FREED char *text = job_file(&j, "lst");
  ck_assert_msg(strstr(text, cases[_i / 2].told) != NULL, "%s: %s",
                cases[_i / 2].told, strstr(text, "slave"));
  ck_assert_msg(led == (strstr(text, _i % 2 ? "P4032" : "P4031") != NULL), "%s",
                j.errors);
}

/* ---- a held master is the rigid plane ------------------------------------ */

/* A block pressed on one side more than on the other, then passed by a plane
 * or by a held block that moves as it does. */
static void run_block(job *j, int pair, const char *cards, const char *solver) {
  *j = job_begin(pair ? "held" : "plane");
  job_copy(j, "tests/regression/mesh/pair.geo");
  job_write(j, pair ? "held.inp" : "plane.inp",
            "*PARAMETER\nN = 3\nM = 8\n*MESH, FILE=pair.geo\n"
            "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
            "*SOLID SECTION, ELSET=LOWER, MATERIAL=M, TYPE=CPE3\n"
            "*SOLID SECTION, ELSET=UPPER, MATERIAL=M, TYPE=CPE3\n"
            "*AMPLITUDE, NAME=RUN, TIME=TOTAL TIME\n0, 0, 1, 0, 2, 1\n%s%s"
            "*STEP\n*QUASISTATIC\n0.5, 1.\n*BOUNDARY\nLOWER, 1, 2\nTOP, 1\n"
            "*DSLOAD\nTOP, P, \"1 + 4*x\"\n%s*PRINT, CONTACT, TOTALS, ENERGY\n"
            "*END STEP\n"
            "*STEP\n*QUASISTATIC\n0.25, 1.\n*BOUNDARY\nLOWER, 1, 1, 0.004\n"
            "*END STEP\n",
            pair ? "*CONTACT PAIR, NAME=P\nUNDER, OVER\n"
                 : "*OBSTACLE, NAME=O, TYPE=PLANE, AMPLITUDE=RUN\n0, 1\n0, 1\n"
                   "MOVE, 0.004, 0\n*CONTACT, NAME=P, GROUP=OVER, OBSTACLE=O\n",
            cards, solver);
  CK_EXIT(job_run(j, "--no-timing"), 0, *j);
}

static void check_same(const job *a, const job *b, double tol) {
  static const char *const names[] = {"f_n", "f_t", "gap"};
  for (int k = 0; k < 6; ++k) {
    DAT x = job_table(a, "CONTACT", k), y = job_table(b, "CONTACT", k);
    ck_assert_int_eq(x.n_row, y.n_row);
    for (int i = 0; i < x.n_row; ++i) {
      for (int c = 0; c < 3; ++c)
        ck_assert_double_eq_tol(dat_at(&x, i, names[c]),
                                dat_at(&y, i, names[c]), tol);
      ck_assert_double_eq(dat_at(&x, i, "status"), dat_at(&y, i, "status"));
    }
  }
}

TESTS(held_master_is_a_plane, 6) {
  static const char *const laws[] = {
      "",
      "*FRICTION, CONTACT=P, LAW=COULOMB\n0.3\n",
      "*FRICTION, CONTACT=P, LAW=TRESCA\n0.5\n",
      "*FRICTION, CONTACT=P, LAW=NONLOCAL, RADIUS=0.3\n0.3\n",
      "*FRICTION, CONTACT=P, LAW=COULOMB\n0.3\n"
      "*CONTACT FORCE, CONTACT=P\n2.\n*BOUNDARY\nTOP, 2\n",
      "*FRICTION, CONTACT=P, LAW=COULOMB\n0.3\n"
      "*WEAR, CONTACT=P, COEFFICIENT=1.E-3\n"};
  JOB pair, plane;
  run_block(&pair, 1, laws[_i], "*SOLVER, TOL=1E-13\n");
  run_block(&plane, 0, laws[_i], "*SOLVER, TOL=1E-13\n");
  check_same(&pair, &plane, 1e-9);
}

/* Stopped half way and gone on with: the same files. */
TEST(restart_is_bit_for_bit) {
  static const char *const words[] = {"--no-timing", NULL};
  static const char *const cards =
      "*FRICTION, CONTACT=P, LAW=NONLOCAL, RADIUS=0.3\n0.3\n"
      "*WEAR, CONTACT=P, COEFFICIENT=1.E-3\n";
  traced t = {.action = TRACE_SIGNAL, .number = SIGTERM};
  JOB whole, stopped;
  run_block(&whole, 1, cards, "*RESTART\n*OUTPUT\n");
  run_block(&stopped, 1, cards, "*RESTART\n*OUTPUT\n");
  job_clear(&stopped);
  ck_assert_int_eq(traced_run(&stopped, words, &t), 0);
  t.at = t.changes / 2;
  job_clear(&stopped);
  ck_assert_int_ne(traced_run(&stopped, words, &t), 0);
  ck_assert_int_eq(job_run(&stopped, "--restart --no-timing"), 0);
  const char *differs = traced_difference(&whole, &stopped);
  ck_assert_msg(differs == NULL, ".%s differs", differs);
}

/* ---- gaps ---------------------------------------------------------------- */

/* Columns without lateral strain, clamped at both ends: of the interference d
 * each takes its part, p = d/(1/E1 + 1/E2); a clearance comes off first. */
TESTS(interference_and_clearance, 4) {
  static const struct {
    const char *line;
    double gap, motion;
  } cases[] = {{"INTERFERENCE, 0.002\n", -0.002, 0},
               {"INTERFERENCE, \"0.002*t\"\n", -0.002, 0},
               {"CLEARANCE, 0.001\n", 0.001, -0.003},
               {"CLEARANCE, \"0.001 + 0*x\"\n", 0.001, -0.003}};
  PRINTED(joint, "%s%s", PAIR, cases[_i].line);
  PRINTED(supports, "BOTTOM, 2\nLEFT, 1\nTOP, 2, 2, %g\n", cases[_i].motion);
  const scene s = {"pair", "N = 3", ", TYPE=CPE3", {1e3, 2e3},
                   0,      joint,   supports,      "TOP, P, 0.\n"};
  const double p = -(cases[_i].gap + cases[_i].motion) / (1e-3 + 0.5e-3);
  JOB j = run_scene(&s, "--no-timing");
  DAT t = job_table(&j, "TOTALS", -1), c = job_table(&j, "CONTACT", -1);
  ck_assert_double_eq_tol(dat_at(&t, 0, "normal"), p, 1e-10);
  for (int i = 0; i < c.n_row; ++i) {
    ck_assert_double_eq_tol(dat_at(&c, i, "pressure"), p, 1e-10);
    ck_assert_double_eq_tol(dat_at(&c, i, "gap"), 0, 1e-15);
  }
}

/* Facets enter each other by up to 5 % of their size, about 0.3, and by a tenth
 * of an interference; so far they gape. */
TEST(depth_is_told_beyond_that_of_facets) {
  static const struct {
    const char *numbers, *joint, *told;
  } rows[] = {
      {"N = 2\nM = 2\nDEEP = 0.01", PAIR, NULL},
      {"N = 2\nM = 2\nDEEP = 0.02", PAIR, "of the size of the mesh, at"},
      {"N = 2\nM = 2\nDEEP = 0.01", PAIR "INTERFERENCE, 0.11\n", NULL},
      {"N = 2\nM = 2\nDEEP = 0.01", PAIR "INTERFERENCE, 0.005\n",
       "of the size of the mesh, 2 times the INTERFERENCE, at"},
      {"N = 2\nM = 2\nDEEP = -0.01", PAIR, NULL},
      {"N = 2\nM = 2\nDEEP = -0.01", PAIR "INTERFERENCE, 0.005\n",
       " away, 2 times the INTERFERENCE, at"},
      {"N = 2\nM = 2\nDEEP = 0.01", PAIR "CLEARANCE, 0.05\n",
       "of the size of the mesh, 0.2 times the CLEARANCE, at"}};
  for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
    const scene s = {"pair3",
                     rows[k].numbers,
                     "",
                     {1e3, 1e3},
                     0,
                     rows[k].joint,
                     "BOTTOM, 3\nLEFT, 1\nFRONT, 2\n",
                     "TOP, P, 1.\n"};
    JOB j = run_scene(&s, "--check");
    const char *told = rows[k].told == NULL ? "P4004" : rows[k].told;
    ck_assert_msg((strstr(j.errors, told) != NULL) == (rows[k].told != NULL),
                  "%s", j.errors);
  }
}

/* The seat of a ring, facets within those of the bore, is moved by up to 0.03:
 * what is left of the gap, but for a clearance of 1, is a thousandth of it. */
TEST(adjusted_nodes_are_on_the_master) {
  JOB j =
      job_with("seat", "input/press_fit/press_fit.geo",
               "*PARAMETER\nN = 8\nM = 11\n*MESH, FILE=press_fit.geo\n"
               "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
               "*SOLID SECTION, ELSET=RING, MATERIAL=M\n"
               "*SOLID SECTION, ELSET=HUB, MATERIAL=M\n"
               "*CONTACT PAIR, NAME=P, ADJUST=YES\nSEAT, BORE\nCLEARANCE, 1.\n"
               "*STEP\n*STATIC\n*BOUNDARY\nFLAT X, 1\nFLAT Y, 2\n"
               "*PRINT, CONTACT\n*END STEP\n");
  CK_EXIT(job_run(&j, "--no-timing"), 0, j);
  char *lst = job_file(&j, "lst"), *pair = strstr(lst, " slave SEAT (");
  ck_assert_ptr_nonnull(pair);
  pair = strstr(pair, "), master BORE, nodes moved by up to 0.0");
  ck_assert_ptr_nonnull(pair);
  free(lst);
  DAT c = job_table(&j, "CONTACT", -1);
  ck_assert_int_eq(c.n_row, 9);
  for (int i = 0; i < c.n_row; ++i)
    ck_assert_double_eq_tol(dat_at(&c, i, "gap"), 1, 3e-5);
  for (int i = 0; i < c.n_row; ++i) { /* planes of symmetry stay */
    const double x = dat_at(&c, i, "x"), y = dat_at(&c, i, "y");
    ck_assert(fmin(x, y) == 0 || fmin(x, y) > 1);
  }
}

/* The seat of a tie is moved as that of a pair. */
TEST(adjusted_nodes_are_tied) {
  JOB j =
      job_with("tied", "input/press_fit/press_fit.geo",
               "*PARAMETER\nN = 8\nM = 11\n*MESH, FILE=press_fit.geo\n"
               "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
               "*SOLID SECTION, ELSET=RING, MATERIAL=M\n"
               "*SOLID SECTION, ELSET=HUB, MATERIAL=M\n"
               "*TIE, NAME=P, ADJUST=YES\nSEAT, BORE\n*STEP\n*STATIC\n"
               "*BOUNDARY\nFLAT X, 1\nFLAT Y, 2\n*PRINT, NODES\n*END STEP\n");
  ck_assert_int_eq(job_run(&j, "--no-timing"), 0);
  FREED char *text = job_file(&j, "lst");
  ck_assert_ptr_nonnull(strstr(text, "nodes moved by up to 0.0302"));
}

/* Three blocks 0.1 apart: of the pair that asks for it the nodes are moved, of
 * the other the gap stays. */
TESTS(one_of_two_pairs_is_adjusted, 2) {
  const mesh_change none = {.scale = 0};
  FREED int *number = NULL;
  JOB j = job_begin("stack");
  PRINTED(path, "%s/stack.msh", j.dir);
  FILE *to = fopen(path, "w");
  ck_assert_ptr_nonnull(to);
  ck_assert(scene_mesh_write(to,
                             "rect 4 2 1 1 + rect 4 2 1 1 at 0 1.1 + "
                             "rect 4 2 1 1 at 0 2.2",
                             &none, &number));
  fclose(to);
  job_write(&j, "stack.inp",
            "*MESH, FILE=stack.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*SOLID SECTION, ELSET=BODY2, MATERIAL=M\n"
            "*SOLID SECTION, ELSET=BODY3, MATERIAL=M\n"
            "*CONTACT PAIR, NAME=P%s\nTOP, BOTTOM2\n"
            "*CONTACT PAIR, NAME=Q%s\nTOP2, BOTTOM3\n*STEP\n*STATIC\n"
            "*BOUNDARY\nBOTTOM, 1, 2\nTOP2, 1, 2\nTOP3, 1, 2\n"
            "*PRINT, CONTACT\n*END STEP\n",
            _i == 0 ? ", ADJUST=YES" : "", _i == 1 ? ", ADJUST=YES" : "");
  ck_assert_msg(job_run(&j, "--no-timing") == 0, "%s", j.errors);
  DAT t = job_table(&j, "CONTACT", -1);
  ck_assert_int_eq(t.n_row, 10);
  for (int i = 0; i < 10; ++i)
    ck_assert_double_eq_tol(dat_at(&t, i, "gap"),
                            dat_at(&t, i, "contact_no") == _i + 1 ? 0 : 0.1,
                            1e-12);
}

/* Faces of two meshes of one seat are up to 0.02 apart, the interference is a
 * tenth of that: the pressure is that of Lame all round. */
TEST(a_fit_is_that_of_the_curve_not_of_the_facets) {
  const double a = 10, b = 20, c = 40, stiff = 1000 / (1 - 0.09), fit = 2e-3;
  const double exact = stiff * fit / (2 * b) * (b * b - a * a) *
                       (c * c - b * b) / (b * b * (c * c - a * a));
  JOB j = job_with("seat", "input/press_fit/press_fit.geo",
                   "*PARAMETER\nN = 16\nM = 23\n*MESH, FILE=press_fit.geo\n"
                   "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
                   "*SOLID SECTION, ELSET=RING, MATERIAL=M\n"
                   "*SOLID SECTION, ELSET=HUB, MATERIAL=M\n"
                   "*CONTACT PAIR, NAME=P\nSEAT, BORE\nINTERFERENCE, %g\n"
                   "*STEP\n*STATIC\n*BOUNDARY\nFLAT X, 1\nFLAT Y, 2\n"
                   "*PRINT, CONTACT\n*END STEP\n",
                   fit);
  ck_assert_int_eq(job_run(&j, "--no-timing"), 0);
  DAT t = job_table(&j, "CONTACT", -1);
  for (int i = 0; i < t.n_row; ++i)
    ck_assert_double_eq_tol(dat_at(&t, i, "pressure") / exact, 1.0, 0.06);
}

/* A wedge between the bodies, closed by their interference: the moment that is
 * left, of forces along the mean of both normals, is that of the pair alone,
 * also at the corner that touches the wall first. */
TEST(moment_of_both_sides_is_that_of_the_pair) {
  const scene s = {"pair",
                   "N = 4\nM = 6\nL = 0.02",
                   ", TYPE=CPE3",
                   {1e3, 1e3},
                   0.3,
                   WALL("") "*CONTACT PAIR, NAME=P\nUNDER, OVER\n"
                            "INTERFERENCE, 0.03\n",
                   "BOTTOM, 2\n",
                   "TOP, P, 3.\nRIGHT, P, 1.\n"};
  JOB j = run_scene(&s, "--no-timing");
  DAT t = job_table(&j, "TOTALS", -1);
  ck_assert_int_eq(t.n_row, 2);
  ck_assert_double_eq(dat_at(&t, 0, "moment_of_both"), 0);
  ck_assert_double_gt(dat_at(&t, 1, "moment_of_both"), 1e-5);
}

/* ---- what is refused ----------------------------------------------------- */

TESTS(bad_pairs_are_told, 16) {
  static const struct {
    const char *cards, *message;
    int code;
  } cases[] = {
      {"*CONTACT PAIR, NAME=P\nOVER, OVER\n", "P2060", 2},
      {"*TIE, NAME=P\nOVER, OVER\n", "P2060", 2},
      {"*CONTACT PAIR, NAME=P\nTOP, BOTTOM\n", "P4023", 2},
      {"*TIE, NAME=P\nTOP, BOTTOM\n", "P4023", 2},
      {"*CONTACT PAIR, NAME=P\nUNDER, AND\n", "P2021", 2},
      {"*CONTACT PAIR, NAME=P\nUNDER\n", "P2009", 2},
      {"*CONTACT PAIR, NAME=P, AMPLITUDE=A\nUNDER, OVER\n", "P2007", 2},
      {"*CONTACT PAIR, NAME=P\nUNDER, OVER\nCLEARANCE, -1.\n", "P2041", 2},
      {PAIR "*CONTACT PAIR, NAME=Q\nOVER, UNDER\n", "P2011", 2},
      {PAIR "*CONTACT PAIR, NAME=Q, SLAVE=FIRST\nOVER, UNDER\n", "P2011", 2},
      {"*CONTACT PAIR, NAME=P\nUNDER, OVER\nCLEARANCE, 1.\n", "P4021", 0},
      {"*PARAMETER\nN = 20\nM = 2\n*CONTACT PAIR, NAME=P, SLAVE=FIRST\n"
       "UNDER, OVER\n",
       "P4024", 0},
      {"*PARAMETER\nC = 0.3\n*TIE, NAME=P, SLAVE=FIRST\nUNDER, OVER\n",
       "P4025: *TIE P: 2 of 5 nodes of UNDER have no partner on OVER", 0},
      /* a share of 0.16 % of the area of the nodes at the ends */
      {"*PARAMETER\nC = 0.24\n*TIE, NAME=P, SLAVE=FIRST\nUNDER, OVER\n",
       "P4025: *TIE P: 2 of 5 nodes of UNDER have no partner on OVER", 0},
      {"*PARAMETER\nG = -0.3\n*CONTACT PAIR, NAME=P, ADJUST=YES\nUNDER, OVER\n",
       "are up to 0.3 apart", 2},
      /* the sides of one body */
      {"*CONTACT PAIR, NAME=P\nRIGHT, LEFT\n", "P4023", 2}};
  JOB j =
      job_with("bad", "tests/regression/mesh/pair.geo",
               "*MESH, FILE=pair.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1.E5, 0.3\n"
               "*SOLID SECTION, ELSET=LOWER, MATERIAL=M\n"
               "*SOLID SECTION, ELSET=UPPER, MATERIAL=M\n%s"
               "*STEP\n*STATIC\n*BOUNDARY\nBOTTOM, 1, 2\nTOP, 1, 2\n"
               "*DLOAD\nUPPER, BY, -1.\n*PRINT, TOTALS\n*END STEP\n",
               cases[_i].cards);
  int code = job_run(&j, "--no-timing");
  ck_assert_msg(
      code == cases[_i].code && strstr(j.errors, cases[_i].message) != NULL,
      "exit %d: %s", code, j.errors);
}

/* A force of 0.5 along x, or y, across a gap of 0.1 along z. */
TESTS(moment_in_space_is_about_any_axis, 2) {
  JOB j = job_begin("cubes");
  job_write(&j, "cubes.geo",
            "SetFactory(\"OpenCASCADE\");\nBox(1) = {0, 0, 0, 1, 1, 1};\n"
            "Box(2) = {0, 0, 1.1, 1, 1, 1};\n"
            "MeshSize{ PointsOf{ Volume{:}; } } = 0.5;\n"
            "Physical Surface(\"BOTTOM\") = {5};\n"
            "Physical Surface(\"UNDER\") = {6};\n"
            "Physical Surface(\"OVER\") = {11};\n"
            "Physical Surface(\"TOP\") = {12};\n"
            "Physical Volume(\"BODY\") = {1, 2};\n");
  job_write(&j, "cubes.inp",
            "*MESH, FILE=cubes.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*CONTACT PAIR, NAME=P\nOVER, UNDER\nINTERFERENCE, 0.1\n"
            "*FRICTION, CONTACT=P, LAW=COULOMB\n1.\n*STEP\n*STATIC\n"
            "*BOUNDARY\nBOTTOM, 1, 3\n*DSLOAD\nTOP, P, 3.\nTOP, T%c, 0.5\n"
            "*PRINT, TOTALS\n*END STEP\n",
            _i == 0 ? 'X' : 'Y');
  CK_EXIT(job_run(&j, "--no-timing"), 0, j);
  ck_assert_double_eq_tol(job_value(&j, "TOTALS", -1, "moment_of_both"), 0.05,
                          1e-9);
}

UNIT_MAIN("pairs")
