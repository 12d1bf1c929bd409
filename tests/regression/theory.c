/*
 * *ACCURACY, THEORY=YES: limits of mu of the GRECO block on crossed squares and
 * of the triangle, bounds of increments, the rate of inelastic laws under given
 * friction (Theorem 3.2), the inequality on every example.
 */
#include "support/job.h"
#include "support/unit.h"

#include <glob.h>

const int job_without_fields = 1;

enum { LINE = 512, MESH_BYTES = 400000 };

/* ---- a block of crossed squares ----------------------------------------- */

/* One line of n segments of a side: nodes from, from + step, ... */
static char *add_side(char *to, int group, int n, int from, int step) {
  for (int i = 0; i < n; ++i)
    to += sprintf(to, "%d 1 2 %d %d %d %d\n", 1000 * group + i, group, group,
                  from + i * step, from + (i + 1) * step);
  return to;
}

/* Four triangles round the centre of each square. */
static char *add_squares(char *to, int n) {
  int corners = (n + 1) * (n + 1), no = 100000;
  for (int j = 0; j < n; ++j)
    for (int i = 0; i < n; ++i) {
      int a = j * (n + 1) + i + 1, c = corners + j * n + i + 1;
      int q[5] = {a, a + 1, a + n + 2, a + n + 1, a};
      for (int k = 0; k < 4; ++k)
        to += sprintf(to, "%d 2 2 5 5 %d %d %d\n", no++, q[k], q[k + 1], c);
    }
  return to;
}

/* 40 x 40, n x n crossed squares: CONTACT below, SYMMETRY right, TOP, LEFT. */
static void write_crossed(const job *j, int n) {
  char *text = malloc(MESH_BYTES), *to = text;
  int corners = (n + 1) * (n + 1);
  double h = 40.0 / n;
  ck_assert_ptr_nonnull(text);
  to += sprintf(to,
                "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n5\n"
                "1 1 \"CONTACT\"\n1 2 \"SYMMETRY\"\n1 3 \"TOP\"\n"
                "1 4 \"LEFT\"\n2 5 \"BODY\"\n$EndPhysicalNames\n$Nodes\n");
  to += sprintf(to, "%d\n", corners + n * n);
  for (int k = 0; k < corners; ++k)
    to += sprintf(to, "%d %.17g %.17g 0\n", k + 1, k % (n + 1) * h,
                  k / (n + 1) * h);
  for (int k = 0; k < n * n; ++k)
    to += sprintf(to, "%d %.17g %.17g 0\n", corners + k + 1, (k % n + 0.5) * h,
                  (k / n + 0.5) * h);
  to += sprintf(to, "$EndNodes\n$Elements\n%d\n", 4 * n + 4 * n * n);
  to = add_side(to, 1, n, 1, 1);
  to = add_side(to, 2, n, n + 1, n + 1);
  to = add_side(to, 3, n, corners - n, 1);
  to = add_side(to, 4, n, 1, n + 1);
  to = add_squares(to, n);
  to += sprintf(to, "$EndElements\n");
  ck_assert_int_lt(to - text, MESH_BYTES);
  job_write(j, "crossed.msh", "%s", text);
  free(text);
}

static const char block_text[] =
    "*MESH, FILE=crossed.msh\n*MATERIAL, NAME=M\n*ELASTIC\n130.D3, 0.2\n"
    "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
    "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
    "*CONTACT, NAME=FOOT, GROUP=CONTACT, OBSTACLE=O\n";

static job run_text(int n, const char *cards, const char *words) {
  job j = job_begin("block");
  write_crossed(&j, n);
  job_write(&j, "block.inp", "%s%s", block_text, cards);
  CK_EXIT(job_run(&j, words), 0, j);
  return j;
}

/* ---- JOB.json ----------------------------------------------------------- */

/* The value of a key, at its k-th place (from 0; -1 the last); NAN: not there
 * or null. */
static double json_value(const char *json, const char *key, int k) {
  const char *found = NULL, *at = json;
  PRINTED(quoted, "\"%s\": ", key);
  for (int i = 0; (at = strstr(at, quoted)) != NULL && (k < 0 || i <= k); ++i)
    found = at += strlen(quoted);
  if (found == NULL || strncmp(found, "null", 4) == 0) return NAN;
  return strtod(found, NULL);
}

static double result(const job *j, const char *key, int k) {
  FREED char *json = job_file(j, "json");
  ck_assert_ptr_nonnull(json);
  return json_value(json, key, k);
}

/* How often a text stands in JOB.suffix. */
static int count(const job *j, const char *suffix, const char *text) {
  int n = 0;
  FREED char *all = job_file(j, suffix);
  ck_assert_ptr_nonnull(all);
  for (const char *at = all; (at = strstr(at, text)) != NULL; ++at) ++n;
  return n;
}

/* ---- limits ------------------------------------------------------------- */

static const char greco_cards[] =
    "*PARAMETER\nMU = 1.\n*FRICTION, CONTACT=FOOT, LAW=COULOMB\n<MU>\n"
    "*STEP\n*QUASISTATIC\n0.5, 1.0\n*BOUNDARY\nSYMMETRY, 1, 1, 0.\n"
    "*DSLOAD\nTOP, P, 50.\nLEFT, P, 150.\n*ACCURACY, THEORY=YES\n*END STEP\n";

TEST(greco_has_the_guaranteed_limits_of_the_table) {
  static const int n[] = {8, 16, 32};
  static const double limit[] = {0.2380, 0.1717, 0.1232};
  for (int k = 0; k < 3; ++k) {
    JOB j = run_text(n[k], greco_cards, "");
    ck_assert_double_eq_tol(result(&j, "mu_unique", -1), limit[k],
                            0.01 * limit[k]);
    ck_assert_int_eq(count(&j, "lst", "largest eigenvalues"), 1);
    ck_assert_int_eq(count(&j, "lst", "between: above 1/C_h"), 2);
    ck_assert_int_eq(count(&j, "lst", "VIOLATED"), 0);
  }
}

/* Contraction per iteration of an independent program at n = 32; for small mu
 * it was read after a few iterations. */
TEST(greco_contracts_as_measured_elsewhere) {
  static const double mu[] = {1.0, 1.5, 2.0}, rate[] = {0.341, 0.517, 0.666};
  static const double tol[] = {0.05, 0.01, 0.01};
  for (int k = 0; k < 3; ++k) {
    PRINTED(words, "-D MU=%g", mu[k]);
    JOB j = run_text(32, greco_cards, words);
    double found = 0.0;
    FREED char *json = job_file(&j, "json");
    const char *at = strrchr(json, '['); /* contacts of the last increment */
    found = json_value(at, "contraction", 0);
    ck_assert_double_eq_tol(found, rate[k], tol[k] * rate[k]);
    ck_assert_double_eq_tol(result(&j, "mu_contraction", -1), mu[k] / found,
                            1e-9);
  }
}

static const char triangle_mesh[] =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n4\n"
    "0 1 \"CLAMPED\"\n0 2 \"TIP\"\n1 3 \"FOOT\"\n2 4 \"BODY\"\n"
    "$EndPhysicalNames\n$Nodes\n3\n1 -1 1 0\n2 1 3 0\n3 0 0 0\n$EndNodes\n"
    "$Elements\n5\n1 15 2 1 1 1\n2 15 2 1 2 2\n3 15 2 2 3 3\n"
    "4 1 2 3 1 1 3\n5 2 2 4 1 3 2 1\n$EndElements\n";

TEST(triangle_gives_both_limits) {
  static const double mu[] = {0.5, 1.0};
  static const char *const words[] = {"unique: under 1/C_h",
                                      "between: above 1/C_h"};
  for (int k = 0; k < 2; ++k) {
    JOB j = job_begin("triangle");
    job_write(&j, "triangle.msh", "%s", triangle_mesh);
    job_write(&j, "triangle.inp",
              "*MESH, FILE=triangle.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1., 0.3\n"
              "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
              "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\n"
              "*CONTACT, NAME=C, GROUP=FOOT, OBSTACLE=O\n"
              "*FRICTION, CONTACT=C, LAW=COULOMB\n%g\n*STEP\n*STATIC\n"
              "*BOUNDARY\nCLAMPED, 1, 2\n*CLOAD\nTIP, 1, -1\nTIP, 2, 0.3\n"
              "*ACCURACY, THEORY=YES\n*END STEP\n",
              mu[k]);
    ck_assert_int_eq(job_run(&j, ""), 0);
    double K = 0.8653846154, cross = -0.4807692308;
    double limit = sqrt(K * K - cross * cross) / K;
    ck_assert_double_eq_tol(result(&j, "mu_unique", -1), limit, 1e-9);
    ck_assert_double_eq_tol(result(&j, "mu_contraction", -1), 1.8, 1e-8);
    ck_assert_int_eq(count(&j, "lst", words[k]), 1);
    ck_assert_int_eq(count(&j, "lst", "(3.9) |u|: no bound"), k);
    ck_assert_int_eq(count(&j, "lst", "VIOLATED"), 0);
  }
}

/* ---- bounds ------------------------------------------------------------- */

/* Clamped on top, pressed and sheared, then let go; mu under 1/C_h. */
static const char led[] =
    "*STEP\n*QUASISTATIC\n0.25, 1.\n*BOUNDARY\nTOP, 1, 1, 0.01\n"
    "TOP, 2, 2, -0.02\n*ACCURACY, THEORY=YES\n*END STEP\n"
    "*STEP\n*QUASISTATIC\n0.25, 1.\n*BOUNDARY\nTOP, 1, 1, -0.01\n"
    "TOP, 2, 2, -0.01\n*END STEP\n";

/* The sides of the inequalities of a listing, in its digits. */
static void sides_are_shown_in_order(const job *j, int n) {
  FREED char *listing = job_file(j, "lst");
  int found = 0;
  for (char *at = listing; (at = strstr(at, "  theory: (3.")) != NULL; ++at) {
    double left, right;
    if (sscanf(at, "  theory: (3.%*d) %*s %lf <= %lf", &left, &right) != 2)
      continue;
    ck_assert_double_le(left, right);
    ++found;
  }
  ck_assert_int_eq(found, n);
}

TEST(bounds_hold_at_every_increment) {
  static const char *const laws[] = {
      "*FRICTION, CONTACT=FOOT, LAW=COULOMB\n0.1\n",
      "*FRICTION, CONTACT=FOOT, LAW=COULOMB\n\"0.1 - 0.04*t\"\n",
      "*FRICTION, CONTACT=FOOT, LAW=NONLOCAL, RADIUS=12.\n0.1\n",
      "*FRICTION, CONTACT=FOOT, LAW=TRESCA\n5.\n", ""};
  for (size_t k = 0; k < sizeof laws / sizeof *laws; ++k) {
    PRINTED(cards, "%s%s", laws[k], led);
    JOB j = run_text(8, cards, "");
    ck_assert_int_eq(count(&j, "lst", "(3.9) |u|: "), 8);
    ck_assert_int_eq(count(&j, "lst", "(3.10) |du|: "), 8);
    ck_assert_int_eq(count(&j, "lst", "no bound"), 0);
    ck_assert_int_eq(count(&j, "lst", "VIOLATED"), 0);
    ck_assert_int_eq(count(&j, "json", "\"violated\": true"), 0);
    int idle = 0; /* increments in which all stick move nothing */
    for (int i = 0; i < 16; ++i) {
      double left = result(&j, "left", i), right = result(&j, "right", i);
      ck_assert_double_le(left, right);
      idle += !(left > 0.01 * right);
    }
    ck_assert_int_le(idle, 3);
    sides_are_shown_in_order(&j, 16);
  }
}

/* A wider average of the pressure lets friction do less. */
TEST(average_raises_the_guaranteed_limit) {
  double last = 0.0;
  static const char *const laws[] = {"COULOMB", "NONLOCAL, RADIUS=8.",
                                     "NONLOCAL, RADIUS=20."};
  for (int k = 0; k < 3; ++k) {
    PRINTED(cards, "*FRICTION, CONTACT=FOOT, LAW=%s\n0.1\n%s", laws[k], led);
    JOB j = run_text(8, cards, "");
    double limit = result(&j, "mu_unique", -1);
    ck_assert_double_gt(limit, 1.05 * last);
    last = limit;
  }
}

/* Two contacts: each on its own, and both together, which is not more. */
TEST(two_contacts_have_rows_of_their_own) {
  static const char cards[] =
      "*CONTACT, NAME=WALL, GROUP=LEFT, OBSTACLE=O\n"
      "*FRICTION, CONTACT=FOOT, LAW=COULOMB\n\"0.1+0.01*y\"\n"
      "*FRICTION, CONTACT=WALL, LAW=COULOMB\n0.05\n"
      "*STEP\n*QUASISTATIC\n0.5, 1.\n*BOUNDARY\nTOP, 1, 1, -0.01\n"
      "TOP, 2, 2, -0.02\n*ACCURACY, THEORY=YES\n*END STEP\n";
  JOB j = run_text(8, cards, "");
  double foot = result(&j, "factor", 0), wall = result(&j, "factor", 1);
  double all = result(&j, "factor", 2);
  ck_assert_int_eq(count(&j, "lst", "\n  FOOT  "), 2);
  ck_assert_int_eq(count(&j, "lst", "\n  WALL  "), 2);
  ck_assert_int_eq(count(&j, "lst", "\n  (all)  "), 2);
  ck_assert_double_ge(all, 0.999999 * fmax(foot, wall));
  ck_assert_double_gt(foot, wall);
  ck_assert_double_eq_tol(result(&j, "mu_unique", 0) * foot, 0.1, 1e-9);
  ck_assert_double_eq_tol(result(&j, "mu_unique", 2) * all, 0.1, 1e-9);
}

/* Friction that vanishes at the last nodes of a contact is friction. */
TEST(friction_of_a_part_has_a_limit) {
  static const char cards[] =
      "*FRICTION, CONTACT=FOOT, LAW=COULOMB\n\"if(x < 20, 0.02, 0)\"\n"
      "*STEP\n*QUASISTATIC\n1., 1.\n*BOUNDARY\nTOP, 1, 1, -0.01\n"
      "TOP, 2, 2, -0.02\n*ACCURACY, THEORY=YES\n*END STEP\n";
  JOB j = run_text(4, cards, "");
  ck_assert_double_eq_tol(result(&j, "mu_unique", 0) * result(&j, "factor", 0),
                          0.02, 1e-9);
  ck_assert_int_eq(count(&j, "lst", "\n  FOOT  "), 1);
}

/* ---- Theorem 3.2 -------------------------------------------------------- */

/* The block of 4 x 4 squares pressed and pushed, then let creep. */
static job run_law(const char *law, const char *contact, const char *visco,
                   double dt) {
  job j = job_begin("block");
  write_crossed(&j, 4);
  job_write(&j, "block.inp",
            "*MESH, FILE=crossed.msh\n*MATERIAL, NAME=M\n*ELASTIC\n"
            "130.D3, 0.2\n*INELASTIC, LAW=%s\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
            "*CONTACT, NAME=FOOT, GROUP=CONTACT, OBSTACLE=O\n%s"
            "*STEP\n*QUASISTATIC\n0.5, 1.\n*BOUNDARY\nSYMMETRY, 1, 1\n"
            "TOP, 2, 2, -0.02\n*DSLOAD\nLEFT, P, 50.\n"
            "*ACCURACY, THEORY=YES\n*END STEP\n"
            "*STEP\n*VISCO, %s\n%g, %g\n*PRINT, ELEMENTS\n*END STEP\n",
            law, contact, visco, dt, 3.0 * dt);
  int code = job_run(&j, "");
  ck_assert_msg(code == 0, "%s, %s: exit %d: %s", law, visco, code, j.errors);
  ck_assert_int_eq(count(&j, "lst", "VIOLATED"), 0);
  ck_assert_int_eq(count(&j, "json", "\"theorem_3_2\""), 3);
  return j;
}

static const char rough[] = "*FRICTION, CONTACT=FOOT, LAW=COULOMB\n0.3\n";

/* The largest eigenvalue of a proportional law is that of a bar, whatever the
 * mesh and the contact: theta dt/tau of MAXWELL, z/(1 + z E1/E0) with z =
 * theta dt E0/eta1 of ZENER. */
TEST(stress_contracts_with_the_rate_of_a_bar) {
  static const char given[] =
      "*CONTACT FORCE, CONTACT=FOOT\n60.\n"
      "*FRICTION, CONTACT=FOOT, LAW=TRESCA\n10.\n";
  static const struct {
    const char *law, *contact, *visco;
    double dt, rate;
  } row[] = {
      {"MAXWELL\n4.", rough, "INTEGRATOR=BACKWARD", 1.0, 0.25},
      {"MAXWELL\n4.", rough, "INTEGRATOR=MIDPOINT", 1.0, 0.125},
      {"MAXWELL\n4.", rough, "INTEGRATOR=THETA, THETA=0.8", 2.0, 0.4},
      {"MAXWELL\n4.", "", "INTEGRATOR=EULER", 2.0, 0.25},
      {"MAXWELL\n4.", given, "INTEGRATOR=EXPONENTIAL", 2.0, 0.25},
      {"MAXWELL\n4.", rough, "INTEGRATOR=BACKWARD", 12.0, 3.0},
      {"MAXWELL\n\"4.+0*t\"", rough, "INTEGRATOR=BACKWARD", 1.0, 0.25},
      {"ZENER\n65.D3, 390.D3", given, "INTEGRATOR=BACKWARD", 1.0, 2.0 / 7.0}};
  for (size_t k = 0; k < sizeof row / sizeof *row; ++k) {
    JOB j = run_law(row[k].law, row[k].contact, row[k].visco, row[k].dt);
    for (int i = 0; i < 3; ++i) {
      ck_assert_double_eq_tol(result(&j, "stress_bound", i), row[k].rate, 1e-9);
      ck_assert_double_eq_tol(result(&j, "stress_contraction", i), row[k].rate,
                              1e-6);
      ck_assert_double_eq_tol(
          result(&j, "dt_contraction", i) * row[k].rate / row[k].dt, 1, 1e-9);
    }
    ck_assert_int_eq(count(&j, "lst", "not below 1"), row[k].rate > 1 ? 3 : 0);
  }
}

/* Elements that expand without a law come before those that creep: as long as
 * their temperature does not change, the rates are those without expansion. */
TEST(rates_beside_a_group_that_expands) {
  double rate[2];
  for (int k = 0; k < 2; ++k) {
    JOB j =
        job_with("layers", "tests/regression/mesh/layers.geo",
                 "*PARAMETER\nN = 2\n*MESH, FILE=layers.geo\n"
                 "*MATERIAL, NAME=M\n*ELASTIC\n130.D3, 0.2\n"
                 "*INELASTIC, LAW=MAXWELL\n4.\n"
                 "*MATERIAL, NAME=E\n*ELASTIC\n200.D3, 0.1\n%s"
                 "*SOLID SECTION, ELSET=SOFT, MATERIAL=E\n"
                 "*SOLID SECTION, ELSET=HARD, MATERIAL=M\n"
                 "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
                 "*CONTACT, NAME=FOOT, GROUP=BOTTOM, OBSTACLE=O\n"
                 "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nSOFT, 20.\n"
                 "*STEP\n*VISCO, INTEGRATOR=BACKWARD\n1., 1.\n"
                 "*BOUNDARY\nLEFT, 1\nTOP, 2, 2, -1.E-3\n"
                 "*TEMPERATURE\nSOFT, 20.\n*ACCURACY, THEORY=YES\n*END STEP\n",
                 k == 0 ? "" : "*EXPANSION\n1.E-5\n");
    CK_EXIT(job_run(&j, ""), 0, j);
    rate[k] = result(&j, "stress_contraction", 0);
  }
  ck_assert_double_gt(rate[0], 0.05);
  ck_assert_double_lt(rate[0], 0.25);
  ck_assert_double_eq_tol(rate[1], rate[0], 1e-6);
}

/* A triangle in plane stress with a determinate support: its stress does not
 * depend on its strains, s does not move, until a contact closes; then there is
 * one stress without load, with the rate of a bar. */
static const char held_mesh[] =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n5\n"
    "0 1 \"CLAMPED\"\n0 2 \"GUIDED\"\n1 3 \"FOOT\"\n0 4 \"TIP\"\n"
    "2 5 \"BODY\"\n$EndPhysicalNames\n$Nodes\n3\n1 -1 1 0\n2 1 3 0\n"
    "3 0 0 0\n$EndNodes\n$Elements\n5\n1 15 2 1 1 1\n2 15 2 2 2 2\n"
    "3 15 2 4 4 3\n4 1 2 3 1 1 3\n5 2 2 5 1 3 2 1\n$EndElements\n";

TEST(closed_contact_makes_the_stress_depend_on_strains) {
  static const char *const level[] = {"-1.", "0."};
  for (int k = 0; k < 2; ++k) {
    JOB j = job_begin("triangle");
    job_write(&j, "triangle.msh", "%s", held_mesh);
    job_write(&j, "triangle.inp",
              "*MESH, FILE=triangle.msh\n*MATERIAL, NAME=M\n*ELASTIC\n"
              "1000., 0.3\n*INELASTIC, LAW=MAXWELL\n4.\n"
              "*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=CPS3\n"
              "*OBSTACLE, NAME=O, TYPE=PLANE\n0., %s\n0., 1.\n"
              "*CONTACT, NAME=C, GROUP=FOOT, OBSTACLE=O\n*STEP\n"
              "*VISCO, INTEGRATOR=BACKWARD\n1., 2.\n*BOUNDARY\n"
              "CLAMPED, 1, 2\nGUIDED, 2\n*CLOAD\nTIP, 2, -1\n"
              "*ACCURACY, THEORY=YES\n*END STEP\n",
              level[k]);
    ck_assert_int_eq(job_run(&j, ""), 0);
    ck_assert_double_eq_tol(result(&j, "stress_contraction", -1), 0.25 * k,
                            1e-9);
    ck_assert_double_eq_tol(result(&j, "stress_bound", -1), 0.25, 1e-9);
  }
}

/* Passes over a time T: the least k with (L T)^k/k! < 1. At L T = 1, 2, 3:
 * 1, 1/2; 2, 2, 4/3, 2/3; ..., 3^6/6! = 1.01, 3^7/7! = 0.43. */
TEST(longer_times_need_more_passes) {
  static const double passes[] = {2.0, 4.0, 7.0};
  JOB j = run_law("MAXWELL\n4.", rough, "INTEGRATOR=BACKWARD", 4.0);
  for (int i = 0; i < 3; ++i) {
    ck_assert_double_eq(result(&j, "maps_to_contract", i), passes[i]);
    ck_assert_double_eq_tol(result(&j, "lipschitz", i), 0.25, 1e-9);
    ck_assert_double_eq_tol(result(&j, "dt_contraction", i), 4.0, 1e-8);
  }
}

/* Largest equivalent stress of the elements of a block of JOB.dat. */
static double largest_mises(const job *j, int block) {
  return job_max(j, "ELEMENTS", block, "mises");
}

/* Only the deviator flows: 3 G d(dp/dt)/dq = 3 G n A q^(n-1) bounds it, reached
 * where a field of strains of the mesh may be so. */
TEST(power_law_is_bounded_at_its_largest_stress) {
  const double G = 130e3 / 2.4, A = 1e-11, n = 3.0, dt = 1.0;
  JOB j = run_law("NORTON\n1E-11, 3.", rough, "INTEGRATOR=BACKWARD", dt);
  for (int i = 0; i < 3; ++i) {
    double q = largest_mises(&j, i);
    double bound = result(&j, "stress_bound", i);
    ck_assert_double_eq_tol(bound / (dt * 3.0 * G * n * A * q * q), 1.0, 1e-6);
    ck_assert_double_gt(result(&j, "stress_contraction", i), 0.3 * bound);
  }
}

/* ---- start, given forces, what is not asked for ------------------------- */

TEST(initial_state_is_tested_against_3_8) {
  PRINTED(cards,
          "*FRICTION, CONTACT=FOOT, LAW=COULOMB\n0.1\n"
          "*INITIAL CONDITIONS, TYPE=DISPLACEMENT\nBODY, 1, 0.\n%s",
          led);
  JOB j = run_text(4, cards, "");
  ck_assert_int_eq(count(&j, "lst", "(3.8) of the initial state"), 1);
  ck_assert_double_ge(result(&j, "start_least", 0), 0.0);
  ck_assert_int_eq(count(&j, "lst", "no bound"), 0);
}

TEST(given_forces_are_loads) {
  PRINTED(cards,
          "*CONTACT FORCE, CONTACT=FOOT\n20.\n"
          "*FRICTION, CONTACT=FOOT, LAW=COULOMB\n0.3\n%s",
          led);
  JOB j = run_text(6, cards, "");
  ck_assert_int_eq(count(&j, "lst", "VIOLATED"), 0);
  ck_assert_int_eq(count(&j, "lst", "no bound"), 0);
  ck_assert_double_ge(result(&j, "inequality_least", -1), -1e-10);
}

/* Friction under a given force beside a contact has a given limit, wherever the
 * obstacle is: limits and bounds are those of Tresca friction. */
TEST(given_forces_of_one_contact_are_loads) {
  static const double gap[] = {0.0, 0.5, -0.01};
  static const char *const law[] = {"COULOMB\n0.3", "TRESCA\n6.",
                                    "COULOMB\n0.3"};
  double found[3][3];
  for (int k = 0; k < 3; ++k) {
    PRINTED(cards,
            "*OBSTACLE, NAME=P, TYPE=GAP\n%g\n"
            "*CONTACT, NAME=LID, GROUP=TOP, OBSTACLE=P\n"
            "*CONTACT FORCE, CONTACT=LID\n20.\n"
            "*FRICTION, CONTACT=LID, LAW=%s\n"
            "*FRICTION, CONTACT=FOOT, LAW=COULOMB\n0.1\n"
            "*STEP\n*QUASISTATIC\n0.5, 1.\n*BOUNDARY\nSYMMETRY, 1, 2\n"
            "*DSLOAD\nLEFT, P, 5.\n*ACCURACY, THEORY=YES\n*END STEP\n",
            gap[k], law[k]);
    JOB j = run_text(6, cards, "");
    ck_assert_int_eq(count(&j, "lst", "VIOLATED"), 0);
    found[k][0] = result(&j, "factor", -1);
    found[k][1] = result(&j, "left", 0);
    found[k][2] = result(&j, "right", 0);
  }
  for (int k = 1; k < 3; ++k)
    for (int i = 0; i < 3; ++i)
      ck_assert_double_eq_tol(found[k][i] / found[0][i], 1, 1e-9);
}

TEST(nothing_is_done_unless_asked_for) {
  char *card;
  long bytes;
  PRINTED(cards, "*FRICTION, CONTACT=FOOT, LAW=COULOMB\n0.1\n%s", led);
  job j = run_text(4, cards, "");
  ck_assert_int_eq(job_stage(&j, "theorems", &bytes), 8);
  ck_assert_int_gt(bytes, 0);
  job_end(&j);
  card = strstr(cards, "THEORY=YES");
  memcpy(card, "THEORY=NO ", 10);
  j = run_text(4, cards, "");
  ck_assert_int_eq(job_stage(&j, "theorems", &bytes), 0);
  ck_assert_int_eq(bytes, 0);
  ck_assert_int_eq(count(&j, "lst", "  theory:"), 0);
  ck_assert_int_eq(count(&j, "json", "\"theory\""), 0);
  job_end(&j);
}

/* ---- every example ------------------------------------------------------ */

/* Copy of a deck with the card in each step. */
static void write_with_theory(const job *j, const char *path) {
  char line[LINE];
  PRINTED(copy, "%s/%s.inp", j->dir, j->name);
  FILE *from = fopen(path, "r"), *to = fopen(copy, "w");
  ck_assert_ptr_nonnull(from);
  ck_assert_ptr_nonnull(to);
  while (fgets(line, sizeof line, from) != NULL) {
    if (strncmp(line, "*END STEP", 9) == 0)
      fputs("*ACCURACY, THEORY=YES\n*OUTPUT, HDF5=NO\n", to);
    if (strncmp(line, "*ACCURACY", 9) == 0) continue;
    if (strncmp(line, "*OUTPUT", 7) == 0) continue;
    fputs(line, to);
  }
  fclose(from);
  ck_assert_int_eq(fclose(to), 0);
}

TEST(inequality_holds_on_every_example) {
  glob_t decks;
  ck_assert_int_eq(glob("input/*/*.inp", 0, NULL, &decks), 0);
  for (size_t i = 0; i < decks.gl_pathc; ++i) {
    const char *path = decks.gl_pathv[i], *name = strrchr(path, '/') + 1;
    char words[LINE];
    JOB j = job_begin("");
    snprintf(j.name, sizeof j.name, "%.*s", (int)(strlen(name) - 4), name);
    job_copy_meshes(&j, path);
    write_with_theory(&j, path);
    job_coarsen(path, words, sizeof words);
    int code = job_run(&j, words);
    ck_assert_msg(code == 0, "%s: exit %d: %s", path, code, j.errors);
    ck_assert_msg(count(&j, "lst", "VIOLATED") == 0, "%s", path);
    FREED char *json = job_file(&j, "json");
    int n = count(&j, "json", "\"inequality_least\"");
    ck_assert_int_eq(n > 0, job_stage(&j, "contact surface", NULL) > 0);
    for (int k = 0; k < n; ++k) {
      double least = json_value(json, "inequality_least", k);
      ck_assert_msg(least >= -1e-10, "%s: %g", path, least);
    }
  }
  ck_assert_uint_gt(decks.gl_pathc, 15);
  globfree(&decks);
}

UNIT_MAIN("theory, whole runs")
