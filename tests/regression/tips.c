/*
 * Bodies of one contact node and one stress in closed form: limits per area,
 * static problems, starts of inelastic strains and internal variables, heat
 * with coefficients that vary, works that balance.
 */
#include "support/block_file.h"
#include "support/grid.h"
#include "support/tips.h"
#include "support/turned_mesh.h"
#include "support/unit.h"

const int job_without_fields = 1;

static const double G = 500, area = 0.70710678118654752; /* half an edge */

#define FLOOR                                       \
  "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\n" \
  "*CONTACT, NAME=A, GROUP=FOOT1, OBSTACLE=O, NORMAL=OBSTACLE\n"

/* Cards below *MATERIAL, then those from *OBSTACLE on. */
static job run(const char *material, const char *cards) {
  job j = tips_new(G, "", cards);
  tips_material(&j, material);
  CK_EXIT(job_run(&j, ""), 0, j);
  return j;
}

/* ---- forces ----------------------------------------------------------------
 */

/* Pulled by 5 along the floor: the limit, a stress of 4, holds 4 area of it. */
TEST(limit_of_tresca_is_a_stress) {
  JOB j = run("", FLOOR
              "*FRICTION, CONTACT=A, LAW=TRESCA\n4.\n*STEP\n*STATIC\n"
              "*BOUNDARY\nCLAMPED, 1, 2\n*CLOAD\nTIPS, 1, 5.\nTIPS, 2, -10.\n"
              "*SOLVER, TOL=1E-13\n*PRINT, CONTACT\n*END STEP\n");
  DAT c = job_table(&j, "CONTACT", -1);
  ck_assert_double_eq_tol(dat_at(&c, 0, "f_t"), -4 * area, 1e-10);
  ck_assert_double_eq_tol(dat_at(&c, 0, "traction_t"), -4, 1e-10);
  ck_assert_double_eq_tol(dat_at(&c, 0, "u_t"), (5 - 4 * area) / G, 1e-12);
}

/* Given p = 6 in the place of the floor: N = 6 area pushes up, T = mu N. */
TEST(given_pressure_pushes) {
  JOB j =
      run("", FLOOR
          "*CONTACT FORCE, CONTACT=A\n6.\n"
          "*FRICTION, CONTACT=A, LAW=COULOMB\n0.3\n*STEP\n*QUASISTATIC\n"
          "0.5, 1.\n*BOUNDARY\nCLAMPED, 1, 2\n*CLOAD\nTIPS, 1, 5.\n"
          "TIPS, 2, -10.\n*SOLVER, TOL=1E-13\n*PRINT, CONTACT\n*END STEP\n");
  DAT c = job_table(&j, "CONTACT", -1);
  const double N = 6 * area;
  ck_assert_double_eq_tol(dat_at(&c, 0, "f_n"), N, 1e-10);
  ck_assert_double_eq_tol(dat_at(&c, 0, "u_n"), (10 - N) / (3.5 * G), 1e-12);
  ck_assert_double_eq_tol(dat_at(&c, 0, "f_t"), -0.3 * N, 1e-10);
}

/* On a foot of many nodes: each has the same pressure, those at the ends half
 * the area. */
TEST(given_pressure_goes_by_area) {
  const turn none = {{0, 0, 1}, 0};
  JOB j = job_begin("turned");
  OWNED mesh *m = make_grid_2d((int[]){4, 2}, (double[]){2, 1});
  turned_mesh_write(&j, m, &none);
  job_write(&j, "turned.inp",
            "*MESH, FILE=turned.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
            "*CONTACT, NAME=C, GROUP=FOOT, OBSTACLE=O\n"
            "*CONTACT FORCE, CONTACT=C\n6.\n*STEP\n*STATIC\n*BOUNDARY\n"
            "HEAD, 1, 2\n*PRINT, CONTACT, TOTALS\n*END STEP\n");
  CK_EXIT(job_run(&j, ""), 0, j);
  DAT c = job_table(&j, "CONTACT", -1), t = job_table(&j, "TOTALS", -1);
  for (int i = 0; i < c.n_row; ++i)
    ck_assert_double_eq_tol(dat_at(&c, i, "pressure"), 6, 1e-10);
  ck_assert_double_eq_tol(dat_at(&t, 0, "normal"), 12, 1e-10);
}

/* Held by friction all the time, without any slip. */
TEST(contact_that_holds_is_one_that_touches) {
  JOB j = run("", FLOOR
              "*FRICTION, CONTACT=A, LAW=COULOMB\n1.\n*STEP\n*STATIC\n"
              "*BOUNDARY\nCLAMPED, 1, 2\n*CLOAD\nTIPS, 1, 5.\nTIPS, 2, -10.\n"
              "*END STEP\n");
  ck_assert_ptr_null(strstr(j.errors, "P4021"));
}

/* Two static problems of the same loads: the slip, and its work, are those from
 * the origin in both. */
TEST(static_problems_slip_from_the_origin) {
  JOB j = run("", FLOOR
              "*FRICTION, CONTACT=A, LAW=COULOMB\n0.3\n*STEP\n*STATIC\n"
              "*BOUNDARY\nCLAMPED, 1, 2\n*CLOAD\nTIPS, 1, 5.\nTIPS, 2, -10.\n"
              "*SOLVER, TOL=1E-13\n*PRINT, CONTACT, ENERGY\n*END STEP\n"
              "*STEP\n*STATIC\n*END STEP\n");
  const double slip = (5 - 3) / G;
  for (int k = 0; k < 2; ++k) {
    DAT c = job_table(&j, "CONTACT", k), e = job_table(&j, "ENERGY", k);
    ck_assert_double_eq_tol(dat_at(&c, 0, "slip"), slip, 1e-12);
    ck_assert_double_eq_tol(dat_at(&c, 0, "slip_distance"), slip, 1e-12);
    ck_assert_double_eq_tol(dat_at(&e, 0, "friction_work_end"), 3 * slip,
                            1e-11);
  }
}

/* ---- starts -----------------------------------------------------------------
 */

#define HELD                                                    \
  "*STEP\n*VISCO, INTEGRATOR=BACKWARD\n1E-3, 1E-3\n*BOUNDARY\n" \
  "CLAMPED, 1, 2\nTIPS, 1, 2\n*PRINT, ELEMENTS\n*END STEP\n"

/* Held by its supports, e^i gives the stress -C e^i; it hardly relaxes. */
TEST(inelastic_strains_start_by_component) {
  JOB j = run("*INELASTIC, LAW=MAXWELL\n1E9\n",
              "*INITIAL CONDITIONS, TYPE=INELASTIC STRAIN\n"
              "BODY, 2, 1E-3\nBODY, 4, 3E-3\n" HELD);
  static const char *const name[] = {"ei_xx", "ei_yy", "ei_zz", "ei_xy"};
  static const double ei[] = {0, 1e-3, 0, 3e-3};
  DAT e = job_table(&j, "ELEMENTS", -1);
  const double lambda = G * 0.6 / 0.4;
  for (int i = 0; i < e.n_row; ++i) {
    for (int k = 0; k < 4; ++k)
      ck_assert_double_eq_tol(dat_at(&e, i, name[k]), ei[k], 1e-10);
    ck_assert_double_eq_tol(dat_at(&e, i, "stress_xx"), -lambda * 1e-3, 1e-8);
    ck_assert_double_eq_tol(dat_at(&e, i, "stress_yy"),
                            -(lambda + 2 * G) * 1e-3, 1e-8);
    ck_assert_double_eq_tol(dat_at(&e, i, "stress_xy"), -G * 3e-3, 1e-8);
  }
}

/* p and a back stress of a body without load: only what was given. */
TEST(internal_variables_start_by_component) {
  JOB j = run("*INELASTIC, LAW=CHABOCHE\n60., 150., 3., 20., 50.\n2E4, 100.\n",
              "*INITIAL CONDITIONS, TYPE=INTERNAL\nBODY, 1, 0.02\n"
              "BODY, 3, 1E-4\n" HELD);
  DAT e = job_table(&j, "ELEMENTS", -1);
  for (int i = 0; i < e.n_row; ++i) {
    ck_assert_double_eq_tol(dat_at(&e, i, "alpha_1"), 0.02, 1e-14);
    ck_assert_double_eq_tol(dat_at(&e, i, "alpha_2"), 0, 1e-14);
    ck_assert_double_eq_tol(dat_at(&e, i, "alpha_3"), 1e-4, 1e-14);
  }
}

/* ---- heat -------------------------------------------------------------------
 */

/* alpha = 1e-5 at 0 to 3e-5 at 100, secants from 20; from 50 to 90 in a body
 * that cannot move: -3 K (alpha(90) 70 - alpha(50) 30). */
TEST(secants_count_from_their_zero) {
  JOB j = run("*EXPANSION, ZERO=20.\n1E-5, 0.\n3E-5, 100.\n",
              "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nBODY, 50.\n"
              "*STEP\n*STATIC\n*BOUNDARY\nCLAMPED, 1, 2\nTIPS, 1, 2\n"
              "*TEMPERATURE\nBODY, 90.\n*PRINT, ELEMENTS\n*END STEP\n");
  DAT e = job_table(&j, "ELEMENTS", -1);
  const double K = 2.6 * G / (3 * 0.4);
  const double strain = 2.8e-5 * 70 - 2e-5 * 30;
  for (int i = 0; i < e.n_row; ++i)
    ck_assert_double_eq_tol(dat_at(&e, i, "stress_zz"), -3 * K * strain, 1e-9);
}

/* Node k has 10 k, written in another order; an element the mean of its nodes:
 * 1, 2, 3 and 4, 5, 6. */
TEST(field_of_temperatures_goes_by_numbers) {
  JOB j = tips_new(G, "",
                   "*STEP\n*STATIC\n*BOUNDARY\nCLAMPED, 1, 2\n"
                   "TIPS, 1, 2\n*TEMPERATURE, FILE=heat.msh\nBODY\n"
                   "*PRINT, ELEMENTS\n*END STEP\n");
  job_write(&j, "heat.msh",
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$NodeData\n1\n\"T\"\n1\n0.\n"
            "3\n0\n1\n6\n6 60.\n2 20.\n4 40.\n1 10.\n5 50.\n3 30.\n"
            "$EndNodeData\n");
  tips_material(&j, "*EXPANSION\n1E-5\n");
  CK_EXIT(job_run(&j, ""), 0, j);
  DAT e = job_table(&j, "ELEMENTS", -1);
  const double K = 2.6 * G / (3 * 0.4);
  for (int i = 0; i < 2; ++i)
    ck_assert_double_eq_tol(dat_at(&e, i, "stress_zz"),
                            -3 * K * 1e-5 * (20 + 30 * i), 1e-9);
}

/* Moduli of a table, at its middle, are their mean in each kind of section. */
TEST(moduli_of_a_table_in_plane_strain_and_stress) {
  static const char *const elastic[] = {
      "*ELASTIC\n1000., 0.3\n", "*ELASTIC\n900., 0.3, 0.\n1100., 0.3, 100.\n"};
  dat u[2];
  for (int k = 0; k < 2; ++k) {
    JOB j = job_begin("block");
    block_file_write(&j, (int[]){4, 4}, (double[]){2, 2}, 1);
    job_write(&j, "block.inp",
              "*MESH, FILE=block.msh\n*MATERIAL, NAME=M\n%s"
              "*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=CPE3\n"
              "*SOLID SECTION, ELSET=UPPER, MATERIAL=M, TYPE=CPS3\n"
              "*STEP\n*STATIC\n*BOUNDARY\nCONTACT, 1, 2\n*DSLOAD\n"
              "TOP, P, 30.\nTOP, TX, 5.\n*TEMPERATURE\nBODY, 50.\nUPPER, 50.\n"
              "*PRINT, NODES, ELEMENTS\n*END STEP\n",
              elastic[k]);
    CK_EXIT(job_run(&j, ""), 0, j);
    u[k] = job_table(&j, "NODES", -1);
    DAT e = job_table(&j, "ELEMENTS", -1);
    for (int i = 0; i < e.n_row; ++i) {
      double flat = dat_at(&e, i, "stress_xx") + dat_at(&e, i, "stress_yy");
      ck_assert_double_eq_tol(dat_at(&e, i, "stress_zz"),
                              dat_at(&e, i, "y") < 1 ? 0.3 * flat : 0, 1e-9);
    }
  }
  const double size = dat_max(&u[0], "u_y");
  for (int i = 0; i < u[0].n_row; ++i) {
    ck_assert_double_eq_tol(dat_at(&u[0], i, "u_x"), dat_at(&u[1], i, "u_x"),
                            1e-10 * size);
    ck_assert_double_eq_tol(dat_at(&u[0], i, "u_y"), dat_at(&u[1], i, "u_y"),
                            1e-10 * size);
  }
  dat_free(&u[0]);
  dat_free(&u[1]);
}

/* Loads, heat and creep together and heat alone: works balance, and the heat is
 * told. */
TEST(works_of_heat_and_creep_balance) {
  static const char *const law[] = {"", "*INELASTIC, LAW=MAXWELL\n0.7\n",
                                    "*INELASTIC, LAW=ZENER\n800., 500.\n"};
  for (int k = 0; k < 3; ++k) {
    PRINTED(material, "*EXPANSION\n1E-5\n%s", law[k]);
    JOB j = run(material,
                "*STEP\n*VISCO, INTEGRATOR=BACKWARD\n0.25, 1.\n*BOUNDARY\n"
                "CLAMPED, 1, 2\n*CLOAD\nTIPS, 1, \"3*t\"\nTIPS, 2, 2.\n"
                "*TEMPERATURE\nBODY, \"90*t*t\"\n*PRINT, ENERGY\n*END STEP\n");
    DAT e = job_table(&j, "ENERGY", -1);
    ck_assert_double_le(fabs(dat_at(&e, 0, "energy_defect_relative")), 1e-10);
    ck_assert_double_gt(fabs(dat_at(&e, 0, "thermal_work")), 1e-6);
    if (k > 0)
      ck_assert_double_gt(dat_at(&e, 0, "inelastic_work"), 1e-6);
    else
      ck_assert_double_eq_tol(
          dat_at(&e, 0, "thermal_work"),
          dat_at(&e, 0, "external_work") - dat_at(&e, 0, "strain_energy"),
          1e-12);
  }
}

/* Held strain, tau = 1: stress and loss at times within the increments. */
TEST(points_lie_within_increments) {
  static const double point[] = {0.1, 0.245, 0.4, 0.75};
  JOB j = run(
      "*INELASTIC, LAW=MAXWELL\n1.\n",
      "*TIME POINTS, NAME=P\n0.1, 0.245, 0.4, 0.75\n*STEP\n*VISCO, "
      "INTEGRATOR=RK4\n0.25, 1.\n*BOUNDARY\nCLAMPED, 1, 2\n"
      "TIPS, 1\nTIPS, 2, 2, \"-0.01 + 0*t\"\n*PRINT, ENERGY, TIME POINTS=P\n"
      "*END STEP\n");
  for (int k = 0; k < 4; ++k) {
    DAT e = job_table(&j, "ENERGY", k);
    const double whole = 2 * 0.5 * 3.5 * G * 1e-4, left = exp(-2 * point[k]);
    ck_assert_double_eq_tol(dat_at(&e, 0, "time"), point[k], 1e-12);
    ck_assert_double_eq_tol(dat_at(&e, 0, "strain_energy"), whole * left,
                            2e-4 * whole);
    ck_assert_double_eq_tol(dat_at(&e, 0, "viscous_dissipation"),
                            whole * (1 - left), 2e-4 * whole);
  }
}

/* Sheared alone, tau = 1/99: what is left of G after an increment of 1 is
 * G/100, and with 3 K = 6.5 G nu is 6.48/13.02. */
TEST(creep_in_shear_is_near_the_locking_it_tells) {
  JOB j = run("*INELASTIC, LAW=MAXWELL, TYPE=DEVIATORIC\n0.010101010101\n",
              "*STEP\n*VISCO, INTEGRATOR=BACKWARD\n1., 1.\n*BOUNDARY\n"
              "CLAMPED, 1, 2\nTIPS, 2\nTIPS, 1, 1, 0.001\n*END STEP\n");
  ck_assert_ptr_nonnull(strstr(j.errors, "an apparent 0.4977;"));
}

/* The same law in volume too, pressed: shear and volume weaken alike. */
TEST(creep_in_volume_is_far_from_locking) {
  JOB j = run("*INELASTIC, LAW=MAXWELL\n0.010101010101\n",
              "*STEP\n*VISCO, INTEGRATOR=BACKWARD\n1., 1.\n*BOUNDARY\n"
              "CLAMPED, 1, 2\nTIPS, 1\nTIPS, 2, 2, 0.001\n*END STEP\n");
  ck_assert_ptr_null(strstr(j.errors, "an apparent"));
}

/* ---- what the plan and *EFFECTS tell ----------------------------------------
 */

/* The shares of what is expected are all of it. */
TEST(expected_shares_are_the_whole) {
  JOB j = run("", FLOOR
              "*STEP\n*STATIC\n*BOUNDARY\nCLAMPED, 1, 2\n*CLOAD\n"
              "TIPS, 2, -10.\n*END STEP\n");
  FREED char *json = job_file(&j, "json");
  static const char name[] = "\"expected_cpu_percent\": ";
  double sum = 0;
  for (char *at = json; (at = strstr(at, name)) != NULL;)
    sum += atof(at += sizeof name - 1);
  ck_assert_double_eq_tol(sum, 100, 1e-6);
}

/* A law that is always at its end: springs of E and of 800 in a row, of which
 * both keep energy, whether the law flows or constants stand for it. */
TEST(law_at_its_end_keeps_the_energy_of_its_springs) {
  static const char *const effects[] = {"", "*EFFECTS, MODE=AUTO\n"};
  static const char *const name[] = {"strain_energy", "external_work",
                                     "inelastic_work", "inelastic_stored"};
  double value[2][4];
  for (int k = 0; k < 2; ++k) {
    PRINTED(cards,
            "%s*STEP\n*VISCO, INTEGRATOR=BACKWARD\n0.25, 1.\n*BOUNDARY\n"
            "CLAMPED, 1, 2\nTIPS, 1\nTIPS, 2, 2, -0.01\n*PRINT, ENERGY\n"
            "*END STEP\n",
            effects[k]);
    JOB j = run("*INELASTIC, LAW=ZENER\n800., 1E-4\n", cards);
    FREED char *lst = job_file(&j, "lst");
    ck_assert((strstr(lst, "  left out: ") != NULL) == k);
    DAT e = job_table(&j, "ENERGY", -1);
    for (int i = 0; i < 4; ++i)
      value[k][i] = dat_has(&e, name[i]) ? dat_at(&e, 0, name[i]) : value[0][i];
  }
  for (int i = 0; i < 4; ++i)
    ck_assert_double_eq_tol(value[1][i], value[0][i], 1e-4 * value[0][1]);
}

UNIT_MAIN("tips")
