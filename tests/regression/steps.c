/*
 * What changes from step to step: supports set again, gravity that turns, force
 * left to a support, a contact whose body has no friction of its own.
 */
#include "support/job.h"
#include "support/unit.h"

/* Unit square, nu = 0, E = 1000, density 1; the cards after the material. */
static job run_cards(const char *cards, int expected) {
  job j =
      job_with("steps", "tests/regression/mesh/square.geo",
               "*PARAMETER\nN = 4\n*MESH, FILE=square.geo\n*MATERIAL, NAME=M\n"
               "*ELASTIC\n1000., 0.\n*DENSITY\n1.\n"
               "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n%s",
               cards);
  CK_EXIT(job_run(&j, ""), expected, j);
  return j;
}

/* Stretched by 20 to u_x = 0.02, then led back to 0 in two increments. */
TEST(component_fixed_anew_starts_where_it_is) {
  JOB j = run_cards(
      "*STEP\n*QUASISTATIC\n1., 1.\n*BOUNDARY\nLEFT, 1, 2\n"
      "*DSLOAD\nRIGHT, TX, 20.\n*PRINT, NODES, ENERGY\n*END STEP\n"
      "*STEP\n*QUASISTATIC\n0.5, 1.\n*BOUNDARY\nRIGHT, 1, 1, 0.\n*END STEP\n",
      0);
  static const double expected[] = {0.02, 0.01, 0.0};
  for (int k = 0; k < 3; ++k) {
    DAT u = job_table(&j, "NODES", k), e = job_table(&j, "ENERGY", k);
    ck_assert_double_eq_tol(dat_at(&u, dat_row_near(&u, "x", 1.0), "u_x"),
                            expected[k], 1e-12);
    ck_assert_double_le(fabs(dat_at(&e, 0, "energy_defect")), 1e-13);
  }
}

/* nu = 0: PART and SIDE are BODY and RIGHT under other names. Each temperature
 * and displacement runs from what the body has to the new value. */
TEST(values_start_from_those_of_the_step_before) {
  JOB j = job_begin("steps");
  job_copy(&j, "tests/regression/mesh/square.geo");
  job_write(&j, "two.geo",
            "Include \"square.geo\";\nPhysical Surface(\"PART\") = {1};\n"
            "Physical Curve(\"SIDE\") = {2};\n");
  job_write(&j, "steps.inp",
            "*MESH, FILE=two.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n"
            "*EXPANSION\n1.E-3\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*STEP\n*QUASISTATIC\n0.5, 1.\n*BOUNDARY\nLEFT, 1\nBOTTOM, 2\n"
            "RIGHT, 1, 1, 0.1\n*TEMPERATURE\nBODY, 100.\n*PRINT, NODES\n"
            "*END STEP\n*STEP\n*QUASISTATIC\n0.5, 1.\n"
            "*BOUNDARY\nSIDE, 1, 1, 0.05\n*TEMPERATURE\nPART, 50.\n*END STEP\n"
            "*STEP\n*QUASISTATIC\n0.5, 1.\n"
            "*BOUNDARY\nRIGHT, 1, 1, 0.08\n*TEMPERATURE\nPART, 0.\nBODY, 80.\n"
            "*END STEP\n*STEP\n*QUASISTATIC\n0.5, 1.\n*TEMPERATURE, OP=NEW\n"
            "*END STEP\n");
  ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
  static const double u[][2] = {{0.05, 0.05}, {0.1, 0.1},     {0.075, 0.075},
                                {0.05, 0.05}, {0.065, 0.065}, {0.08, 0.08},
                                {0.08, 0.04}, {0.08, 0.0}};
  for (int k = 0; k < 8; ++k) {
    DAT n = job_table(&j, "NODES", k);
    ck_assert_double_eq_tol(dat_max(&n, "u_x"), u[k][0], 1e-12);
    ck_assert_double_eq_tol(dat_max(&n, "u_y"), u[k][1], 1e-12);
  }
}

/* Pulled by 20, then by 40: u_x = 0.04, strain energy 0.8. */
TEST(a_table_ends_and_the_others_stay) {
  JOB j = run_cards(
      "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1, 2\n"
      "*DSLOAD\nRIGHT, TX, 20.\n*PRINT, NODES, ENERGY\n*END STEP\n"
      "*STEP\n*STATIC\n*DSLOAD\nRIGHT, TX, 40.\n"
      "*PRINT, NODES=NO\n*END STEP\n",
      0);
  DAT n = job_table(&j, "NODES", -1), e = job_table(&j, "ENERGY", -1);
  ck_assert_double_eq_tol(dat_max(&n, "u_x"), 0.02, 1e-12);
  ck_assert_double_eq_tol(dat_at(&e, 0, "strain_energy"), 0.8, 1e-12);
}

/* Weight 8 down, then 8 to the right: half way the one has half gone. */
TEST(gravity_turns_from_one_direction_to_the_other) {
  JOB j = run_cards(
      "*STEP\n*QUASISTATIC\n1., 1.\n*BOUNDARY\nLEFT, 1, 2\n"
      "*DLOAD\nBODY, GRAV, 8., 0., -1.\n*PRINT, REACTIONS\n*END STEP\n"
      "*STEP\n*QUASISTATIC\n0.5, 1.\n*DLOAD\nBODY, GRAV, 8., 1., 0.\n"
      "*END STEP\n",
      0);
  static const double expected[][2] = {{0, 8}, {-4, 4}, {-8, 0}};
  for (int k = 0; k < 3; ++k) {
    DAT r = job_table(&j, "REACTIONS", k);
    ck_assert_double_eq_tol(dat_sum(&r, "reaction_x"), expected[k][0], 1e-10);
    ck_assert_double_eq_tol(dat_sum(&r, "reaction_y"), expected[k][1], 1e-10);
  }
}

/* Floor with friction and a smooth wall: at the corner node each contact has
 * its own force, and no more friction than mu times its pressure. */
TEST(corner_forces_belong_to_their_contacts) {
  JOB j = run_cards(
      "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
      "*CONTACT, NAME=F, GROUP=BOTTOM, OBSTACLE=O\n"
      "*CONTACT, NAME=W, GROUP=LEFT, OBSTACLE=O\n"
      "*FRICTION, CONTACT=F, LAW=COULOMB\n0.4\n"
      "*STEP\n*STATIC\n*DSLOAD\nTOP, P, 10.\nRIGHT, P, 20.\n"
      "*PRINT, TOTALS\n*END STEP\n",
      0);
  DAT t = job_table(&j, "TOTALS", -1);
  ck_assert_double_eq_tol(dat_at(&t, 0, "normal"), 10.0, 1e-9);
  ck_assert_double_eq_tol(dat_at(&t, 0, "force_x") + dat_at(&t, 1, "force_x"),
                          20.0, 1e-9);
  ck_assert_double_le(fabs(dat_at(&t, 0, "tangential")), 4.0 * (1 + 1e-9));
  ck_assert_double_eq_tol(dat_at(&t, 1, "normal"), dat_at(&t, 1, "force_x"),
                          1e-9);
}

/* Both contacts have all of their face, nodes, pressure and zone, corner and
 * all. */
TEST(corner_belongs_to_the_areas_of_both_contacts) {
  JOB j = run_cards(
      "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
      "*CONTACT, NAME=F, GROUP=BOTTOM, OBSTACLE=O\n"
      "*CONTACT, NAME=W, GROUP=LEFT, OBSTACLE=O\n"
      "*STEP\n*STATIC\n*DSLOAD\nTOP, P, 10.\nRIGHT, P, \"20+10*(y<1E-9)\"\n"
      "*PRINT, TOTALS, ZONES\n*END STEP\n",
      0);
  DAT t = job_table(&j, "TOTALS", -1), z = job_table(&j, "ZONES", -1);
  ck_assert_int_eq(z.n_row, 2);
  for (int i = 0; i < 2; ++i) {
    ck_assert_double_eq_tol(dat_at(&t, i, "closed_area"), 1.0, 1e-12);
    ck_assert_double_eq_tol(dat_at(&z, i, "extent"), 1.0, 1e-12);
  }
  ck_assert_double_eq(dat_at(&t, 0, "slip"), dat_at(&t, 1, "slip"));
  ck_assert_double_ge(dat_at(&t, 1, "pressure_max"), 22.0);
}

/* Pressed on a floor, then the foot is fixed where it is: what the floor bore
 * is left to the support, and the energies still balance. */
TEST(support_takes_over_from_contact) {
  JOB j = run_cards(
      "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
      "*CONTACT, NAME=F, GROUP=BOTTOM, OBSTACLE=O\n"
      "*STEP\n*QUASISTATIC\n1., 1.\n*BOUNDARY\nLEFT, 1\n*DSLOAD\nTOP, P, 10.\n"
      "*PRINT, ENERGY\n*END STEP\n"
      "*STEP\n*QUASISTATIC\n0.5, 1.\n*BOUNDARY\nRIGHT, 1, 2, 0.\n*END STEP\n",
      0);
  for (int k = 0; k < 3; ++k) {
    ck_assert_double_le(
        fabs(job_value(&j, "ENERGY", k, "energy_defect_relative")), 1e-10);
  }
}

/* Pressed without friction, then unloaded: nothing is left but rounding, which
 * is small against what was there. */
TEST(balance_is_that_of_the_largest_work) {
  JOB j = run_cards(
      "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
      "*CONTACT, NAME=F, GROUP=BOTTOM, OBSTACLE=O\n"
      "*STEP\n*QUASISTATIC\n0.3, 1.\n*BOUNDARY\nLEFT, 1\n"
      "*DSLOAD\nTOP, P, \"1+7*x^2\"\n*PRINT, ENERGY\n*END STEP\n"
      "*STEP\n*QUASISTATIC\n0.3, 1.\n*DSLOAD\nTOP, P, 0.\n*END STEP\n",
      0);
  for (int k = 0; k < 8; ++k) {
    ck_assert_double_le(
        fabs(job_value(&j, "ENERGY", k, "energy_defect_relative")), 1e-12);
  }
}

/* Supports that move work in increments without a table too: on averaged
 * elements, and on nodes that carry what is tied to them. */
TEST(supports_work_between_tables) {
  static const char *const of[][2] = {
      {"", "*CONTACT PAIR, NAME=P\nUNDER, OVER\n"},
      {"", "*TIE, NAME=P\nUNDER, OVER\n"},
      {", FORMULATION=AVERAGED", "*CONTACT PAIR, NAME=P\nUNDER, OVER\n"}};
  for (int k = 0; k < 3; ++k) {
    JOB j = job_with(
        "steps", "tests/regression/mesh/pair.geo",
        "*PARAMETER\nN = 4\n*MESH, FILE=pair.geo\n*MATERIAL, NAME=M\n"
        "*ELASTIC\n1000., 0.49\n*SOLID SECTION, ELSET=LOWER, MATERIAL=M%s\n"
        "*SOLID SECTION, ELSET=UPPER, MATERIAL=M%s\n%s"
        "*STEP\n*QUASISTATIC\n0.25, 1.\n*BOUNDARY\nBOTTOM, 2\n"
        "LEFT, 1, 1, -0.01\nRIGHT, 1, 1, \"-0.02*y\"\n"
        "*DSLOAD\nTOP, P, 9.\n*PRINT, ENERGY, FREQUENCY=0\n"
        "*OUTPUT, HDF5=NO\n*END STEP\n",
        of[k][0], of[k][0], of[k][1]);
    ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
    DAT e = job_table(&j, "ENERGY", -1);
    ck_assert_double_ge(fabs(dat_at(&e, 0, "external_work")), 1e-3);
    ck_assert_double_le(fabs(dat_at(&e, 0, "energy_defect_relative")), 1e-10);
  }
}

/* Sheared to slip one way; then a static problem with half the motion. Stick
 * and slip of it are from the origin: sigma_xy = mu p = 4, G = 500, so that the
 * foot has slipped 0.01 - 4/500 = 0.002 from the origin, and friction_work_end
 * is 4 * 0.002; the quasistatic step before ends at 0.02 - 0.008 = 0.012. */
TEST(static_problem_slips_from_the_origin) {
  JOB j = run_cards(
      "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
      "*CONTACT, NAME=F, GROUP=BOTTOM, OBSTACLE=O\n"
      "*FRICTION, CONTACT=F, LAW=COULOMB\n0.4\n"
      "*STEP\n*QUASISTATIC\n0.5, 1.\n*BOUNDARY\nTOP, 2, 2, -0.01\n"
      "TOP, 1, 1, 0.02\n*DSLOAD\nRIGHT, TY, \"4*min(1, t)\"\n"
      "LEFT, TY, \"-4*min(1, t)\"\n*PRINT, CONTACT, ENERGY\n*END STEP\n"
      "*STEP\n*STATIC\n*BOUNDARY\nTOP, 1, 1, 0.01\n*END STEP\n",
      0);
  static const double slip[] = {0.012, 0.002};
  for (int k = 0; k < 2; ++k) {
    DAT c = job_table(&j, "CONTACT", k + 1), e = job_table(&j, "ENERGY", k + 1);
    for (int i = 0; i < c.n_row; ++i) {
      ck_assert_double_eq_tol(dat_at(&c, i, "pressure"), 10, 1e-9);
      ck_assert_double_eq_tol(dat_at(&c, i, "u_t"), slip[k], 1e-10);
      if (k == 1)
        ck_assert_double_eq_tol(dat_at(&c, i, "slip"), slip[k], 1e-10);
    }
    if (k == 1)
      ck_assert_double_eq_tol(dat_at(&e, 0, "friction_work_end"), 4 * slip[k],
                              1e-10);
    ck_assert_double_le(fabs(dat_at(&e, 0, "energy_defect_relative")), 1e-10);
  }
}

/* The way slipped is the sum of the slips of all increments that touch, also
 * where the supports change and the contact surface is made again, with a node
 * more. */
TEST(slip_distance_goes_on_with_other_supports) {
  JOB j = run_cards(
      "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
      "*CONTACT, NAME=F, GROUP=BOTTOM, OBSTACLE=O\n"
      "*FRICTION, CONTACT=F, LAW=COULOMB\n0.4\n"
      "*STEP\n*QUASISTATIC\n0.5, 1.\n*BOUNDARY\nTOP, 2, 2, -0.01\n"
      "TOP, 1, 1, 0.02\nLEFT, 2, 2\n*PRINT, CONTACT\n*END STEP\n"
      "*STEP\n*QUASISTATIC\n0.5, 1.\n*BOUNDARY, OP=NEW\nTOP, 1, 1, 0.03\n"
      "*DSLOAD\nTOP, P, 10.\n*END STEP\n",
      0);
  double way[32] = {0};
  for (int k = 0; k < 4; ++k) {
    DAT c = job_table(&j, "CONTACT", k);
    ck_assert_int_eq(c.n_row, k < 2 ? 4 : 5);
    for (int i = 0; i < c.n_row; ++i) {
      double *own = &way[(int)dat_at(&c, i, "node_no") % 32];
      if (dat_at(&c, i, "pressure") > 0) *own += fabs(dat_at(&c, i, "slip"));
      ck_assert_double_eq_tol(dat_at(&c, i, "slip_distance"), *own, 1e-12);
    }
    if (k == 1) ck_assert_double_ge(way[2], 0.002);
  }
}

TEST(same_contact_twice_is_refused) {
  JOB j = run_cards(
      "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
      "*CONTACT, NAME=F, GROUP=BOTTOM, OBSTACLE=O\n"
      "*CONTACT, NAME=G, GROUP=BOTTOM, OBSTACLE=O\n"
      "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1\n*END STEP\n",
      2);
  ck_assert_ptr_nonnull(strstr(j.errors, "P2011"));
}

/* Friction along a face whose nodes are held across: supports, contact and
 * loads are in balance, each component by itself. */
TEST(supports_of_contact_nodes_balance) {
  static const char *const cards[] = {"LEFT, 1\nTOP, 1\nTOP, 2, 2, 0.02\n",
                                      "FRONT, 2\nTOP, 2\nTOP, 1, 1, 0.02\n"};
  static const char *const part[][2] = {{"reaction_x", "force_x"},
                                        {"reaction_y", "force_y"},
                                        {"reaction_z", "force_z"}};
  for (int k = 0; k < 2; ++k) {
    JOB j = job_with(
        "cube", "tests/regression/mesh/cube.geo",
        "*PARAMETER\nN = 2\n*MESH, FILE=cube.geo\n*MATERIAL, NAME=M\n"
        "*ELASTIC\n1000., 0.3\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
        "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
        "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
        "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n*STEP\n*STATIC\n"
        "*BOUNDARY\nTOP, 3, 3, -0.01\n%s*DSLOAD\nRIGHT, TX, 3.\n"
        "*PRINT, TOTALS, REACTIONS\n*END STEP\n",
        cards[k]);
    ck_assert_int_eq(job_run(&j, ""), 0);
    DAT r = job_table(&j, "REACTIONS", -1), t = job_table(&j, "TOTALS", -1);
    ck_assert_double_ge(fabs(dat_at(&t, 0, part[1 - k][1])), 1);
    for (int c = 0; c < 3; ++c)
      ck_assert_double_eq_tol(
          dat_sum(&r, part[c][0]) + dat_at(&t, 0, part[c][1]), c == 0 ? -3 : 0,
          1e-8);
  }
}

/* What deck and mesh tell of a later step ends --check, and a run before its
 * first increment. A cube on a rough floor, its sides held along x. */
#define SIDES "*BOUNDARY\nLEFT, 1\nRIGHT, 1\n*DSLOAD\nTOP, P, 3.\n"
#define LEFT_HALF "*FRICTION, CONTACT=C, LAW=COULOMB\n\"if(x < 0.6, 0.3, 0)\"\n"
#define ONE "*STEP\n*QUASISTATIC\n.5, 1.\n"
#define TWO "*END STEP\n" ONE
static const struct {
  int dim;
  const char *obstacle, *cards; /* MOVE; of the steps */
  const char *text;             /* NULL: the run is fine */
  int checked, code;
} late[] = {
    {3, "MOVE, \"0.001*max(t-1,0)\", 0, 0\n", ONE SIDES TWO "*END STEP\n",
     "error P4015: ", 2, 2},
    /* back at the end of the step */
    {3, "MOVE, \"0.001*max(t-1,0)*max(2-t,0)\", 0, 0\n",
     ONE SIDES TWO "*END STEP\n", "error P4015: ", 2, 2},
    {3, "", ONE SIDES TWO "*BOUNDARY\nRIGHT, 1, 1, .001\n*END STEP\n",
     "error P4015: ", 2, 2},
    /* along what nothing holds; supports that stay */
    {3, "MOVE, 0, \"0.001*max(t-1,0)\", 0\n", ONE SIDES TWO "*END STEP\n", NULL,
     0, 0},
    {3, "", ONE SIDES "*BOUNDARY\nFRONT, 2\n" TWO "*END STEP\n", NULL, 0, 0},
    /* friction in one half, motion in the other, or in the same */
    {3, "", ONE LEFT_HALF SIDES TWO "*BOUNDARY\nRIGHT, 1, 1, .001\n*END STEP\n",
     NULL, 0, 0},
    {3, "", ONE LEFT_HALF SIDES TWO "*BOUNDARY\nLEFT, 1, 1, .001\n*END STEP\n",
     "error P4015: ", 2, 2},
    /* to 0 from where it is, which only the run tells */
    {3, "", ONE SIDES TWO "*BOUNDARY\nFRONT, 2, 2, 0.\n*END STEP\n",
     "error P4015: ", 0, 2},
    {3, "", ONE SIDES TWO "*SOLVER, CHECK=ALL\n*END STEP\n",
     "late.inp:24: *SOLVER, CHECK=ALL: all statuses can be tried for up to 10",
     2, 2},
    {2, "", ONE SIDES TWO "*SOLVER, CHECK=ALL\n*END STEP\n", NULL, 0, 0},
    {2, "", ONE SIDES TWO "*BOUNDARY, OP=NEW\nBOTTOM, 2\n*END STEP\n",
     "error P4010: ", 2, 2}};

static void check_late(size_t i) {
  job j = job_begin("late");
  const char *solid = late[i].dim == 3 ? "cube" : "square";
  PRINTED(file, "tests/regression/mesh/%s.geo", solid);
  job_copy(&j, file);
  job_write(&j, "late.inp",
            "*PARAMETER\nN = 2\n*MESH, FILE=%s.geo\n*MATERIAL, NAME=M\n"
            "*ELASTIC\n1000., 0.3\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=CONFORMING\n%s"
            "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
            "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n%s",
            solid, late[i].obstacle, late[i].cards);
  const int checked = job_run(&j, "--check"), code = job_run(&j, "");
  ck_assert_msg(checked == late[i].checked && code == late[i].code,
                "case %zu: exit %d, %d: %s", i, checked, code, j.errors);
  if (late[i].text != NULL)
    ck_assert_msg(strstr(j.errors, late[i].text) != NULL, "%s", j.errors);
  if (checked != 0) {
    FREED char *sta = job_file(&j, "sta");
    ck_assert_ptr_null(strstr(sta, "\n     1     1 "));
  }
  job_end(&j);
}

TEST(later_steps_are_checked_before_the_first) {
  for (size_t i = 0; i < sizeof late / sizeof *late; ++i) check_late(i);
}

/* A load is checked on all of its group: the bottom and the face between two
 * layers, both layers, of which one has no density. */
TEST(loads_are_checked_on_all_of_a_group) {
  static const struct {
    const char *soft, *hard, *load, *text; /* density; NULL: fine */
  } rows[] = {{"*DENSITY\n1.\n", "*DENSITY\n1.\n",
               "*DLOAD\nALL, GRAV, 9.81, 0., -1.", NULL},
              {"*DENSITY\n1.\n", "", "*DLOAD\nALL, GRAV, 9.81, 0., -1.",
               "error P2014: GRAV on group ALL: material H has no *DENSITY"},
              {"", "*DENSITY\n1.\n", "*DLOAD\nALL, GRAV, 9.81, 0., -1.",
               "error P2014: GRAV on group ALL: material S has no *DENSITY"},
              {"", "", "*DSLOAD\nBOTTOM, P, 1.", NULL},
              {"", "", "*DSLOAD\nWALLS, P, 1.",
               "error P2035: P on group WALLS: a face "},
              {"", "", "*DSLOAD\nWALLS, TX, 1.", NULL}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
    JOB j = job_with("layers", "tests/regression/mesh/layers.geo",
                     "*PARAMETER\nN = 2\n*MESH, FILE=layers.geo\n"
                     "*MATERIAL, NAME=S\n*ELASTIC\n1., 0.\n%s"
                     "*MATERIAL, NAME=H\n*ELASTIC\n2., 0.\n%s"
                     "*SOLID SECTION, ELSET=SOFT, MATERIAL=S\n"
                     "*SOLID SECTION, ELSET=HARD, MATERIAL=H\n*STEP\n*STATIC\n"
                     "*BOUNDARY\nTOP, 1, 2\n%s\n*END STEP\n",
                     rows[i].soft, rows[i].hard, rows[i].load);
    const int code = job_run(&j, "--check");
    ck_assert_msg(code == (rows[i].text == NULL ? 0 : 2), "case %zu: %d: %s", i,
                  code, j.errors);
    if (rows[i].text != NULL)
      ck_assert_msg(strstr(j.errors, rows[i].text) != NULL, "%s", j.errors);
  }
}

UNIT_MAIN("steps")
