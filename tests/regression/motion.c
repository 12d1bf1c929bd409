/*
 * Obstacles that shift and turn: the loops of one node on a spring in closed
 * form, a node on a turntable, whole scenes turned in space, and the round cone
 * of friction for every direction of slip.
 */
#include "scenes/mesh.h"
#include "support/grid.h"
#include "support/job.h"
#include "support/turned_mesh.h"
#include "support/unit.h"

const int job_without_fields = 1;

/* ---- one node ----------------------------------------------------------- */

/* The free vertex at the origin of a triangle (area 1) or tetrahedron (volume
 * sqrt(3)/4) that is clamped at the height 1: tangential stiffness G times
 * area or volume, not coupled with the normal one. */
static const char triangle[] =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n4\n"
    "0 1 \"CLAMPED\"\n0 2 \"TIP\"\n1 3 \"FOOT\"\n2 4 \"BODY\"\n"
    "$EndPhysicalNames\n$Nodes\n3\n1 -1 1 0\n2 1 1 0\n3 0 0 0\n$EndNodes\n"
    "$Elements\n5\n1 15 2 1 1 1\n2 15 2 1 2 2\n3 15 2 2 3 3\n"
    "4 1 2 3 1 1 3\n5 2 2 4 1 3 2 1\n$EndElements\n";
static const char tetrahedron[] =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n4\n"
    "0 1 \"CLAMPED\"\n0 2 \"TIP\"\n2 3 \"FOOT\"\n3 4 \"BODY\"\n"
    "$EndPhysicalNames\n$Nodes\n4\n1 1 0 1\n2 -.5 .86602540378443865 1\n"
    "3 -.5 -.86602540378443865 1\n4 0 0 0\n$EndNodes\n"
    "$Elements\n6\n1 15 2 1 1 1\n2 15 2 1 2 2\n3 15 2 1 3 3\n4 15 2 2 4 4\n"
    "5 2 2 3 1 1 2 4\n6 4 2 4 1 1 2 3 4\n$EndElements\n";

typedef struct spring {
  int dim;
  double k, N, mu; /* N/m, N, -                                              */
} spring;

/* One node on an obstacle given by its card, then what follows "*CLOAD". */
static job run_node(const spring *s, const char *shape, const char *force_card,
                    const char *steps) {
  job j = job_begin("node");
  double G = s->k / (s->dim == 3 ? sqrt(3.0) / 4 : 1.0);
  job_write(&j, "node.msh", "%s", s->dim == 3 ? tetrahedron : triangle);
  job_write(&j, "node.inp",
            "*MESH, FILE=node.msh\n*MATERIAL, NAME=M\n*ELASTIC\n%.17g, 0.3\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*AMPLITUDE, NAME=CYCLE, TIME=TOTAL TIME\n"
            "0., 0., 1., 1., 3., -1., 5., 1., 7., -1.\n*OBSTACLE, NAME=O, %s\n"
            "*CONTACT, NAME=C, GROUP=FOOT, OBSTACLE=O, NORMAL=OBSTACLE\n"
            "*FRICTION, CONTACT=C, LAW=COULOMB\n%.17g\n"
            "*STEP\n*STATIC\n1E-9\n*BOUNDARY\nCLAMPED, 1, %d\n"
            "*CLOAD\nTIP, %d, %.17g\n*SOLVER, TOL=1E-13\n*END STEP\n"
            "*STEP\n%s%s*PRINT, CONTACT, ENERGY\n*END STEP\n",
            2.6 * G, shape, s->mu, s->dim, s->dim, -s->N, steps, force_card);
  CK_EXIT(job_run(&j, ""), 0, j);
  return j;
}

/* Dissipation between the ends of increments a and b (from 1) of step 2. */
static double dissipated(const job *j, int a, int b) {
  DAT p = job_table(j, "ENERGY", a - 1), q = job_table(j, "ENERGY", b - 1);
  double work =
      dat_at(&q, 0, "friction_work_end") - dat_at(&p, 0, "friction_work_end");
  ck_assert_double_le(fabs(dat_at(&q, 0, "energy_defect_relative")), 1e-10);
  return work;
}

static const spring springs[] = {
    {2, 1000, 10, 0.3}, {2, 730, 4, 0.45}, {3, 1000, 10, 0.3}};

/* W = 4 mu N (F0 - mu N) / K, whatever the increments between reversals. */
TEST(loop_of_a_force) {
  static const int n[] = {1, 3, 10};
  for (int c = 0; c < 9; ++c) {
    const spring *s = &springs[c % 3];
    double F0 = 5;
    PRINTED(load, "*CLOAD\nTIP, 1, %.17g, CYCLE\n", F0);
    PRINTED(steps, "*QUASISTATIC\n%.17g, 5.\n", 1.0 / n[c / 3]);
    JOB j = run_node(s,
                     s->dim == 3 ? "TYPE=PLANE\n0., 0., 0.\n0., 0., 1."
                                 : "TYPE=PLANE\n0., 0.\n0., 1.",
                     load, steps);
    double W = 4 * s->mu * s->N * (F0 - s->mu * s->N) / s->k;
    ck_assert_double_eq_tol(dissipated(&j, n[c / 3], 5 * n[c / 3]), W,
                            1e-6 * W);
  }
}

/* The obstacle alone moves, by U to and fro: a plane shifted, a roller turned,
 * a plane far from its axis, W = 4 mu N (U - mu N / k). */
TEST(loop_of_an_obstacle) {
  static const char *const shape[] = {
      "TYPE=PLANE, AMPLITUDE=CYCLE\n0., 0.\n0., 1.\nMOVE, %.17g, 0.",
      "TYPE=CYLINDER, RADIUS=2, AMPLITUDE=CYCLE\n0., -2.\n"
      "ROTATE, 0., -2., \"-%.17g/2\"",
      "TYPE=PLANE, AMPLITUDE=CYCLE\n0., 0., 0.\n0., 0., 1.\n"
      "ROTATE, 0., -3., \"-%.17g/3\""};
  for (int c = 0; c < 9; ++c) {
    spring s = {c % 3 == 2 ? 3 : 2, 500, 10, c < 3 ? 0.3 : 0.55};
    double U = c < 6 ? 0.02 : 0.05;
    PRINTED(card, shape[c % 3], U);
    PRINTED(steps, "*QUASISTATIC\n%.17g, 5.\n", 1.0 / (1 + c));
    JOB j = run_node(&s, card, "", steps);
    double W = 4 * s.mu * s.N * (U - s.mu * s.N / s.k);
    ck_assert_double_eq_tol(dissipated(&j, 1 + c, 5 * (1 + c)), W, 1e-6 * W);
  }
}

/* A turntable whose axis is rho from the node passes below it by rho times the
 * angle: after two turns the node is drawn along by mu N / k across the arm,
 * and mu N (rho angle - mu N / k) has become heat. */
TEST(node_on_a_turntable) {
  const spring s = {3, 400, 7, 0.6};
  const double rho = 1.5, limit = s.mu * s.N, turns = 4 * acos(-1.0);
  for (int k = 0; k < 4; ++k) {
    double beta = 0.9 * k - 0.4;
    PRINTED(card,
            "TYPE=PLANE\n0., 0., 0.\n0., 0., 1.\n"
            "ROTATE, %.17g, %.17g, 0., 0., 0., 2., \"4*pi*t\"",
            -rho * cos(beta), -rho * sin(beta));
    PRINTED(steps, "*QUASISTATIC\n%.17g, 1.\n", 1.0 / (5 + k));
    JOB j = run_node(&s, card, "", steps);
    DAT c = job_table(&j, "CONTACT", -1), e = job_table(&j, "ENERGY", -1);
    ck_assert_int_eq(c.n_row, 1);
    ck_assert_double_eq_tol(dat_at(&c, 0, "f_x"), -limit * sin(beta), 1e-9);
    ck_assert_double_eq_tol(dat_at(&c, 0, "f_y"), limit * cos(beta), 1e-9);
    ck_assert_double_eq_tol(dat_at(&e, 0, "friction_work_end"),
                            limit * (rho * turns - limit / s.k), 1e-6);
    ck_assert_double_le(fabs(dat_at(&e, 0, "energy_defect_relative")), 1e-10);
  }
}

/* ---- scenes turned as a whole -------------------------------------------- */

/* The obstacle below: rises by 0.01, then runs once round a circle (2-D: to and
 * fro) and turns by 0.5 about its normal (2-D: tilts by 0.001). */
static void write_deck(const job *j, int dim, const turn *t) {
  double n[3] = {0, dim == 2, dim == 3}, e1[3] = {1, 0, 0};
  double e2[3] = {0, dim == 3, 0}, pivot[3] = {0.4, dim == 3 ? 0.7 : 0, 0};
  double axis[3] = {0, 0, 1};
  turn_vector(t, n);
  turn_vector(t, e1);
  turn_vector(t, e2);
  turn_vector(t, pivot);
  turn_vector(t, axis);
  char shift[3][200];
  for (int c = 0; c < 3; ++c)
    snprintf(shift[c], sizeof shift[c],
             "\"0.01*min(t,1)*(%.17g) + 0.03*sin(2*pi*max(t-1,0))*(%.17g) + "
             "0.03*(1-cos(2*pi*max(t-1,0)))*(%.17g)\"",
             n[c], e1[c], e2[c]);
  job_write(j, "turned.inp",
            "*MESH, FILE=turned.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0., 0.\n%.17g, %.17g, %.17g\n"
            "MOVE, %s,\n%s,\n%s\n"
            "ROTATE, %.17g, %.17g, %.17g, %.17g, %.17g, %.17g,\n"
            "\"%g*max(t-1,0)\"\n"
            "*CONTACT, NAME=C, GROUP=FOOT, OBSTACLE=O\n"
            "*FRICTION, CONTACT=C, LAW=COULOMB\n0.4\n"
            "*STEP\n*QUASISTATIC\n0.125, 2.\n*BOUNDARY\nHEAD, 1, %d\n"
            "*SOLVER, TOL=1E-13\n*PRINT, CONTACT, ENERGY\n*END STEP\n",
            n[0], n[1], n[2], shift[0], shift[1], shift[2], pivot[0], pivot[1],
            pivot[2], axis[0], axis[1], axis[2], dim == 3 ? 0.5 : 1e-3, dim);
}

static job run_turned(int dim, const turn *t) {
  const int n2[] = {8, 4}, n3[] = {4, 4, 2};
  const double length2[] = {2, 1}, length3[] = {2, 1.5, 1};
  job j = job_begin("turned");
  OWNED mesh *m =
      dim == 3 ? make_grid_3d(n3, length3) : make_grid_2d(n2, length2);
  ck_assert_ptr_nonnull(m);
  turned_mesh_write(&j, m, t);
  write_deck(&j, dim, t);
  CK_EXIT(job_run(&j, ""), 0, j);
  return j;
}

static void force(const dat *c, int row, int dim, double f[3]) {
  f[0] = dat_at(c, row, "f_x");
  f[1] = dat_at(c, row, "f_y");
  f[2] = dim == 3 ? dat_at(c, row, "f_z") : 0.0;
}

static void same_forces(const job *a, const job *b, int dim, const turn *t,
                        int block) {
  DAT p = job_table(a, "CONTACT", block), q = job_table(b, "CONTACT", block);
  double scale = dat_max(&p, "f_n");
  ck_assert_int_eq(p.n_row, q.n_row);
  for (int i = 0; i < p.n_row; ++i) {
    double f[3], g[3];
    force(&p, i, dim, f);
    force(&q, i, dim, g);
    turn_vector(t, f);
    for (int c = 0; c < 3; ++c)
      ck_assert_double_eq_tol(g[c], f[c], 1e-9 * scale);
    ck_assert_double_eq(dat_at(&p, i, "status"), dat_at(&q, i, "status"));
  }
}

TEST(scene_turned_as_a_whole_gives_the_answer_turned) {
  static const turn turns[] = {{{0, 0, 1}, 0.0},
                               {{0, 0, 1}, 2.0},
                               {{0.48, 0.6, 0.64}, 1.1},
                               {{0, 0.8, -0.6}, -2.7}};
  for (int dim = 2; dim <= 3; ++dim) {
    JOB plain = run_turned(dim, &turns[0]);
    for (int k = 1; k < (dim == 3 ? 4 : 2); ++k) {
      JOB other = run_turned(dim, &turns[k]);
      for (int block = 0; block < 16; ++block)
        same_forces(&plain, &other, dim, &turns[k], block);
    }
  }
}

/* At every slipping node of every increment |r_t| = mu r_n and r_t points
 * against the slip, for a slip that turns once round and with the turntable. */
TEST(cone_is_round_for_every_direction_of_slip) {
  const turn t = {{0.48, 0.6, 0.64}, 1.1};
  int slipping = 0;
  JOB j = run_turned(3, &t);
  for (int block = 0; block < 16; ++block) {
    DAT c = job_table(&j, "CONTACT", block), e = job_table(&j, "ENERGY", block);
    double scale = dat_max(&c, "f_n");
    for (int i = 0; i < c.n_row; ++i) {
      double n = dat_at(&c, i, "f_n"), s1 = dat_at(&c, i, "slip_1");
      double s2 = dat_at(&c, i, "slip_2"), s = hypot(s1, s2);
      double t1 = dat_at(&c, i, "f_t1"), t2 = dat_at(&c, i, "f_t2");
      if (dat_at(&c, i, "status") != 1.0) continue;
      ++slipping;
      ck_assert_double_eq_tol(hypot(t1, t2), 0.4 * n, 1e-10 * scale);
      ck_assert_double_eq_tol(t1, -0.4 * n * s1 / s, 1e-10 * scale);
      ck_assert_double_eq_tol(t2, -0.4 * n * s2 / s, 1e-10 * scale);
    }
    ck_assert_double_le(fabs(dat_at(&e, 0, "energy_defect_relative")), 1e-10);
  }
  ck_assert_int_gt(slipping, 100);
}

/* ---- supports that hold contact nodes ------------------------------------ */

/* A block (side 1) pressed by t: friction on nodes that supports hold along the
 * floor is mu N of them too, against their motion; what stops keeps it. */
typedef struct carried {
  int dim;
  const char *floor, *law, *supports;
  double end;        /* of the step, s; N then */
  double x, y, work; /* NAN: not known */
} carried;

#define COULOMB "COULOMB\n0.3\n"
static const carried carried_blocks[] = {
    {2, "MOVE, \"0.02*t\", 0.\n", COULOMB, "LEFT, 1\n", 1, 0.3, 0, NAN},
    {2, "", COULOMB, "RIGHT, 1, 1, 0.02\n", 1, -0.3, 0, NAN},
    {2, "", COULOMB, "BODY, 1, 1, 0.02\n", 1, -0.3, 0, 3e-3},
    {2, "MOVE, \"0.02*min(t,2-t)\", 0.\n", COULOMB, "BODY, 1\n", 2, -0.6, 0,
     NAN},
    {2, "MOVE, \"0.02*min(t,1)\", 0.\n", COULOMB, "BODY, 1\n", 2, 0.3, 0, 3e-3},
    {2, "MOVE, \"0.02*t\", 0.\n", "TRESCA\n0.2\n", "BODY, 1\n", 1, 0.2, 0, NAN},
    {3, "MOVE, \"0.02*t\", \"0.01*t\", 0.\n", COULOMB, "BODY, 1, 2\n", 1,
     0.26832815729997476, 0.13416407864998738, NAN}};

static void check_carried(const carried *c, const char *kind,
                          const char *method) {
  const int solid = c->dim == 3;
  JOB j = job_with(
      "carried",
      solid ? "tests/regression/mesh/cube.geo"
            : "tests/regression/mesh/square.geo",
      "*PARAMETER\nN = 2\n*MESH, FILE=%s.geo\n*MATERIAL, NAME=M\n"
      "*ELASTIC\n1000., 0.3\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
      "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.%s\n%s*CONTACT, NAME=C, "
      "GROUP=BOTTOM, OBSTACLE=O\n*FRICTION, CONTACT=C, LAW=%s"
      "*AMPLITUDE, NAME=RISE\n0., 0., 9., 9.\n"
      "*GOAL, QUANTITY=FORCE, NAME=DRAG, CONTACT=C, COMPONENT=1\n"
      "*STEP\n*%s"
      "*BOUNDARY\n%s*DSLOAD\nTOP, P, 1., RISE\n*SOLVER, METHOD=%s\n"
      "*PRINT, TOTALS, CONTACT, ENERGY, REACTIONS, GOALS\n*END STEP\n",
      solid ? "cube" : "square", solid ? ", 0.\n0., 0., 1." : "\n0., 1.",
      c->floor, c->law, kind, c->supports, method);
  ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
  ck_assert_ptr_null(strstr(j.errors, "warning"));
  DAT all = job_table(&j, "TOTALS", -1), n = job_table(&j, "CONTACT", -1);
  DAT e = job_table(&j, "ENERGY", -1), s = job_table(&j, "REACTIONS", -1);
  DAT drag = job_table(&j, "GOALS", -1);
  ck_assert_double_eq_tol(dat_at(&drag, 0, "value"), c->x, 1e-12);
  ck_assert_double_le(fabs(dat_at(&drag, 0, "error")), 1e-12);
  ck_assert_double_le(dat_at(&drag, 0, "band"), 1e-10);
  ck_assert_double_eq_tol(dat_at(&all, 0, "force_x"), c->x, 1e-12);
  ck_assert_double_eq_tol(dat_at(&all, 0, "force_y"), solid ? c->y : c->end,
                          1e-12);
  ck_assert_double_eq_tol(dat_sum(&s, "reaction_x"), -c->x, 1e-12);
  ck_assert_double_le(fabs(dat_at(&e, 0, "energy_defect_relative")), 1e-12);
  if (!isnan(c->work) && strstr(kind, "STATIC\n") != kind)
    ck_assert_double_eq_tol(dat_at(&e, 0, "friction_work"), c->work, 1e-12);
  for (int i = 0; i < n.n_row; ++i)
    ck_assert_double_eq(dat_at(&n, i, "status"),
                        strstr(c->floor, "min(t,1)") == NULL ? 1 : 2);
}

TESTS(supports_bear_the_friction_of_the_nodes_they_hold, 7) {
  const carried *c = &carried_blocks[_i];
  char kind[80];
  for (int velocity = 0; velocity < 2; ++velocity) {
    snprintf(kind, sizeof kind, "QUASISTATIC%s\n0.25, %g\n",
             velocity ? ", FORM=VELOCITY" : "", c->end);
    check_carried(c, kind, "AUTO");
  }
  if (_i < 2) check_carried(c, kind, _i ? "SOR" : "LEMKE");
  if (_i < 3) check_carried(c, "STATIC\n1.\n", "AUTO");
}

/* A block on a slope, carried over it by its supports or the slope below it,
 * which follows the body or is a plane of its own: it rises by the slope times
 * the way, and the supports bear the part of the normal force along them. */
TESTS(supports_carry_a_block_up_a_slope, 2) {
  static const struct {
    const char *supports, *moves;
    int follows;
  } cases[] = {{"BODY, 1, 1, 0.02\n", "", 0},
               {"BODY, 1\n", "MOVE, \"-0.02*t\", 0.\n", 0},
               {"BODY, 1, 1, 0.02\n", "", 1},
               {"BODY, 1\n", "MOVE, \"-0.02*t\", 0.\n", 1},
               {"RIGHT, 1, 1, 0.02\n", "", 0},
               {"RIGHT, 1\n", "MOVE, \"-0.02*t\", 0.\n", 0},
               {"RIGHT, 1, 1, 0.02\n", "", 1},
               {"RIGHT, 1\n", "MOVE, \"-0.02*t\", 0.\n", 1},
               {"BODY, 1\n", "", 0},
               {"LEFT, 1\n", "", 0},
               {"LEFT, 1\n", "", 1}};
  const double length = sqrt(1 + 0.05 * 0.05), drag = _i ? 0.2 * length : 0.0;
  double rise[11], force[11];
  for (int k = 0; k < 11; ++k) {
    JOB j = job_begin("slope");
    job_write(
        &j, "slope.geo",
        "Point(1) = {0, 0, 0}; Point(2) = {1, 0.05, 0};\n"
        "Point(3) = {1, 1, 0}; Point(4) = {0, 1, 0};\n"
        "For i In {1:4}\n  Line(i) = {i, i %% 4 + 1};\n"
        "  Transfinite Curve{i} = 3;\nEndFor\n"
        "Curve Loop(1) = {1:4}; Plane Surface(1) = {1};\n"
        "Transfinite Surface{1};\nPhysical Curve(\"FOOT\") = {1};\n"
        "Physical Curve(\"RIGHT\") = {2};\nPhysical Curve(\"TOP\") = {3};\n"
        "Physical Curve(\"LEFT\") = {4};\n"
        "Physical Surface(\"BODY\") = {1};\n");
    job_write(&j, "slope.inp",
              "*MESH, FILE=slope.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
              "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
              "*OBSTACLE, NAME=O, TYPE=%s%s*CONTACT, NAME=C, GROUP=FOOT, "
              "OBSTACLE=O\n%s*STEP\n*QUASISTATIC\n0.25, 1.\n*BOUNDARY\n%s"
              "*DSLOAD\nTOP, P, 1.\n*PRINT, TOTALS, NODES, REACTIONS, ENERGY\n"
              "*END STEP\n",
              cases[k].follows ? "GAP\n0.\n" : "PLANE\n0., 0.\n-0.05, 1.\n",
              cases[k].moves,
              _i ? "*FRICTION, CONTACT=C, LAW=COULOMB\n0.2\n" : "",
              cases[k].supports);
    ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
    DAT all = job_table(&j, "TOTALS", -1), u = job_table(&j, "NODES", -1);
    DAT s = job_table(&j, "REACTIONS", -1), e = job_table(&j, "ENERGY", -1);
    rise[k] = dat_sum(&u, "u_y") / u.n_row;
    force[k] = dat_at(&all, 0, "force_x");
    ck_assert_double_eq_tol(dat_sum(&s, "reaction_x"), -force[k], 1e-12);
    ck_assert_double_le(fabs(dat_at(&e, 0, "energy_defect_relative")), 1e-11);
    if (_i && k < 4)
      ck_assert_double_eq_tol(dat_at(&e, 0, "friction_work"), 0.01 * drag,
                              1e-12);
    if (!_i || k < 4) {
      ck_assert_double_eq_tol(dat_at(&all, 0, "normal"), length, 1e-12);
      ck_assert_double_eq_tol(fabs(dat_at(&all, 0, "tangential")), drag, 1e-12);
    }
  }
  for (int k = 0; k < 4; ++k) {
    ck_assert_double_eq_tol(rise[k], rise[8] + 0.001, 1e-12);
    ck_assert_double_eq_tol(force[k], -0.05 - drag, 1e-12);
  }
  for (int k = 4; k < 8; ++k) {
    ck_assert_double_eq_tol(rise[k], rise[4], 1e-12);
    ck_assert_double_eq_tol(force[k], force[4], 1e-12);
  }
  for (int k = 4; k < 11 && !_i; ++k)
    ck_assert_double_eq_tol(force[k], -0.05, 1e-12);
}

/* Where an obstacle is back at its place up to rounding nothing has slid. */
TEST(rounding_of_a_motion_is_no_slip) {
  static const char *const ways[] = {"0.02*sin(2*pi*t)", "0.1*t+0.2*t-0.3*t",
                                     "3*(t/3)-t"};
  for (int k = 0; k < 3; ++k) {
    JOB j = job_with(
        "still", "tests/regression/mesh/square.geo",
        "*PARAMETER\nN = 2\n*MESH, FILE=square.geo\n*MATERIAL, NAME=M\n"
        "*ELASTIC\n1E9, 0.3\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
        "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\n"
        "MOVE, \"%s\", 0.\n*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
        "*FRICTION, CONTACT=C, LAW=COULOMB\n0.9\n*STEP\n*QUASISTATIC\n"
        "%s, 1.\n*BOUNDARY\nBODY, 1\n*DSLOAD\nTOP, P, 1.\n"
        "*PRINT, TOTALS\n*END STEP\n",
        ways[k], k == 0 ? "0.5" : "0.1");
    ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
    for (int b = 0; b < (k == 0 ? 2 : 10); ++b) {
      ck_assert_double_eq(job_value(&j, "TOTALS", b, "force_x"), 0);
    }
  }
}

/* ---- long motions -------------------------------------------------------- */

/* A block pressed by p onto a floor, E = 300 (elastic motion 1e-3), mu = 0.3:
 * the floor moves, or the top of the block is carried; one increment. Exit
 * code; *T: tangential force, *reason: of the increment. */
typedef struct long_motion {
  const char *floor, *top; /* what moves */
  double E, p;
} long_motion;

static int run_long(const long_motion *l, const char *solver, const char *form,
                    double *T, char reason[40]) {
  JOB j = job_with(
      "long", "tests/regression/mesh/square.geo",
      "*MESH, FILE=square.geo\n*MATERIAL, NAME=M\n*ELASTIC\n%.17g, 0.3\n"
      "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
      "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\n%s"
      "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
      "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n"
      "*STEP\n*QUASISTATIC, FORM=%s\n1., 1.\n*BOUNDARY\n%s"
      "*DSLOAD\nTOP, P, %.17g\n*SOLVER, %s\n"
      "*PRINT, TOTALS\n*END STEP\n",
      l->E, l->floor, form, l->top, l->p, solver);
  int code = job_run(&j, "");
  *T = NAN;
  reason[0] = '\0';
  if (code <= 1) {
    DAT t = job_table(&j, "TOTALS", -1);
    *T = dat_at(&t, 0, "force_x");
    char *sta = job_file(&j, "sta"), *last = strrchr(sta, ' ');
    last = strstr(sta, " UNSETTLED") ? strstr(sta, " UNSETTLED") : last;
    sscanf(last, " %39[^\n]", reason);
    free(sta);
  }
  return code;
}

/* What only carries is not in the scale of the residual: the friction force is
 * right, or the increment is not OK. */
TEST(long_motions_leave_the_forces_right) {
  static const char *const methods[] = {"AUTO",   "NEWTON",   "LEMKE",
                                        "SOR",    "PCG",      "AUGLAG",
                                        "AITKEN", "LAGRANGE", "PROXIMAL"};
  static const long_motion scenes[] = {
      {"MOVE, 1E5, 0.\n", "TOP, 1\n", 300, 1},
      {"MOVE, 1E6, 0.\n", "TOP, 1\n", 300, 1},
      {"MOVE, 1E8, 0.\n", "TOP, 1\n", 300, 1},
      {"", "TOP, 1, 1, -1E3\n", 1, 1e-9},
  };
  for (size_t k = 0; k < 4; ++k)
    for (size_t m = 0; m < sizeof methods / sizeof *methods; ++m)
      for (int velocity = 0; velocity <= (m < 2); ++velocity) {
        char reason[40];
        double T;
        PRINTED(solver, "METHOD=%s", methods[m]);
        int code = run_long(&scenes[k], solver,
                            velocity ? "VELOCITY" : "DISPLACEMENT", &T, reason);
        int ok = code == 0;
        int may_miss = k == 3 ? m > 1 : m == 2; /* LEMKE solves in u         */
        ck_assert_msg(ok || may_miss, "scene %zu, %s: exit %d", k, methods[m],
                      code);
        double expected = 0.3 * scenes[k].p, most = k == 3 ? 0.05 : 1e-8;
        ck_assert_msg(!ok || fabs(T - expected) <= most * expected,
                      "scene %zu, %s: T = %.12g, %s", k, methods[m], T, reason);
      }
}

/* Rounding takes the digits of the forces: the increment does not count, with
 * or without a bound that says so. */
TEST(forces_lost_to_rounding_are_never_ok) {
  static const struct {
    double p;
    const char *solver, *form;
  } run[] = {{5e-10, "METHOD=AUTO", "DISPLACEMENT"},
             {1e-10, "METHOD=AUTO", "DISPLACEMENT"},
             {1e-10, "METHOD=AUTO\n*ACCURACY, SOLVER=NO", "DISPLACEMENT"},
             {5e-11, "METHOD=NEWTON", "VELOCITY"},
             {3e-11, "METHOD=SOR", "DISPLACEMENT"},
             {1e-11, "METHOD=AUTO", "DISPLACEMENT"}};
  for (size_t k = 0; k < sizeof run / sizeof *run; ++k) {
    const long_motion lost = {"", "TOP, 1, 1, 1E3\n", 1, run[k].p};
    double T;
    char reason[40];
    int code = run_long(&lost, run[k].solver, run[k].form, &T, reason);
    ck_assert_msg(code == 1 || code == 6, "p = %g, %s: exit %d, T = %g, %s",
                  lost.p, run[k].solver, code, T, reason);
    ck_assert_msg(code == 6 || strncmp(reason, "UNSETTLED", 9) == 0, "%s",
                  reason);
  }
}

static job begin_two(void) {
  static const mesh_change none;
  FREED int *number = NULL;
  job j = job_begin("two");
  PRINTED(path, "%s/two.msh", j.dir);
  FILE *f = fopen(path, "w");
  ck_assert_ptr_nonnull(f);
  ck_assert(scene_mesh_write(f, "rect 3 3 1 1 + rect 3 3 1 1 at 2 0", &none,
                             &number));
  fclose(f);
  return j;
}

/* Two blocks of moduli 1 and 1e4 on one floor, or one that relaxes: what is
 * counted is right, T = 0.3 N of each, and what is far from rounding counts. */
TEST(bodies_and_laws_count_by_their_own_forces) {
  static const struct {
    const char *step, *floor;
    double top, p;
    int solvable; /* 1: exit 0                                            */
  } run[] = {
      {"*QUASISTATIC\n1., 1.\n", "MOVE, 100., 0.\n", 0, 2e-8, 1},
      {"*VISCO, INTEGRATOR=BACKWARD\n1., 1.\n", "MOVE, 100., 0.\n", 0, 2e-8, 1},
      {"*QUASISTATIC\n1., 1.\n", "", 100, 1e-8, 1},
      {"*VISCO, INTEGRATOR=RK4\n1., 1.\n", "", 100, 1e-8, 1},
      {"*QUASISTATIC\n1., 1.\n", "", 1e3, 1e-11, 0},
      {"*VISCO, INTEGRATOR=BACKWARD\n1., 1.\n", "", 1e3, 3e-12, 0},
      {"*VISCO, INTEGRATOR=RK4\n1., 1.\n", "", 1e3, 1e-12, 0}};
  for (size_t k = 0; k < sizeof run / sizeof *run; ++k) {
    int visco = run[k].step[1] == 'V';
    JOB j = begin_two();
    job_write(&j, "two.inp",
              "*MESH, FILE=two.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1., 0.3\n%s"
              "*MATERIAL, NAME=H\n*ELASTIC\n1.E4, 0.3\n%s"
              "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
              "*SOLID SECTION, ELSET=BODY2, MATERIAL=H\n"
              "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\n%s"
              "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
              "*CONTACT, NAME=C2, GROUP=BOTTOM2, OBSTACLE=O\n"
              "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n"
              "*FRICTION, CONTACT=C2, LAW=COULOMB\n0.3\n"
              "*STEP\n%s*BOUNDARY\nTOP, 1, 1, %g\nTOP2, 1, 1, %g\n"
              "*DSLOAD\nTOP, P, %g\nTOP2, P, %g\n"
              "*PRINT, TOTALS\n*END STEP\n",
              visco ? "*INELASTIC, LAW=MAXWELL\n2.\n" : "",
              visco ? "*INELASTIC, LAW=MAXWELL\n2.\n" : "", run[k].floor,
              run[k].step, run[k].top, run[k].top, run[k].p, 1e3 * run[k].p);
    int code = job_run(&j, "");
    ck_assert_msg(code == 0 || !run[k].solvable, "run %zu: exit %d: %s", k,
                  code, j.errors);
    for (int b = 0; b < 2 && code == 0; ++b) {
      DAT t = job_table(&j, "TOTALS", -1);
      double T = 0.3 * run[k].p * (b == 0 ? 1 : 1e3);
      ck_assert_msg(fabs(fabs(dat_at(&t, b, "force_x")) - T) <= 0.05 * T,
                    "run %zu, body %d: %g for %g", k, b,
                    dat_at(&t, b, "force_x"), T);
    }
  }
}

/* A sphere of an axisymmetric model moves along the axis, by any expression
 * that is zero across it; one that is not is refused, between steps too. */
TEST(a_sphere_moves_along_the_axis) {
  static const struct {
    const char *move;
    int code;
  } runs[] = {{"0., 0.1", 0},
              {"\"0*t\", \"0.1*t\"", 0},
              {"\"0.1*t\", \"0.1*t\"", 2},
              {"\"t*(t - 1)\", \"0.1*t\"", 2}};
  double pressed = 0.0;
  for (size_t k = 0; k < sizeof runs / sizeof *runs; ++k) {
    JOB j = job_with(
        "axis", "tests/regression/mesh/square.geo",
        "*MESH, FILE=square.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1., 0.3\n"
        "*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=CAX3\n"
        "*OBSTACLE, NAME=O, TYPE=SPHERE, RADIUS=10.\n0., -10.\n"
        "MOVE, %s\n*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
        "*STEP\n*QUASISTATIC\n0.5, 1.\n*BOUNDARY\nTOP, 1, 2\n"
        "*PRINT, TOTALS\n*END STEP\n",
        runs[k].move);
    ck_assert_int_eq(job_run(&j, "--no-timing --quiet"), runs[k].code);
    if (runs[k].code == 0) {
      DAT t = job_table(&j, "TOTALS", -1);
      if (k == 0) pressed = dat_at(&t, 0, "normal");
      ck_assert_double_gt(pressed, 0.01);
      ck_assert_double_eq(dat_at(&t, 0, "normal"), pressed);
    } else {
      ck_assert_ptr_nonnull(strstr(j.errors, "off the axis of symmetry"));
    }
  }
}

UNIT_MAIN("motion")
