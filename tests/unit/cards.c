/*
 * src/model/cards: what the cards say is in the model, in its own place: no
 * number is there twice, and none is that of a default.
 */
#include "material/scheme/scheme.h"
#include "support/text_model.h"
#include "support/unit.h"

/* Each number and what it is to be. */
static void check_pairs(size_t n, const double *pair) {
  for (size_t i = 0; i < n; i += 2)
    ck_assert_msg(pair[i] == pair[i + 1], "number %zu: %g, not %g", i / 2,
                  pair[i], pair[i + 1]);
}
#define PAIRS(...)                                              \
  check_pairs(sizeof((double[]){__VA_ARGS__}) / sizeof(double), \
              (double[]){__VA_ARGS__})

static mesh *square(void) {
  const int n[] = {3, 2};
  const double length[] = {6.0, 4.0};
  return make_grid_2d(n, length);
}

static void read_steps(text_model *s, const char *steps) {
  PRINTED(text,
          "*MESH, FILE=none.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
          "*INELASTIC, LAW=NORTON\n1e-9, 3.\n"
          "*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=CPE3\n"
          "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\n"
          "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
          "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n%s",
          steps);
  *s = text_model_read(text, square());
  ck_assert_int_eq(s->st, OK);
}

TEST(increments_of_a_step) {
  TEXT_MODEL s;
  read_steps(&s,
             "*STEP\n*QUASISTATIC, FORM=VELOCITY\n0.25, 3., 0.125, 0.5\n"
             "*BOUNDARY\nTOP, 1, 2\n*END STEP\n"
             "*STEP\n*QUASISTATIC\n0.75, 7.\n*END STEP\n"
             "*STEP\n*VISCO, INTEGRATOR=THETA, THETA=0.75, "
             "ITERATION=INITIAL, TOLERANCE=0.01\n2., 11., , 5.\n*END STEP\n"
             "*STEP\n*VISCO, INTEGRATOR=EULER, SUBSTEPS=AUTO\n"
             "2., 13., 0.625\n*END STEP\n"
             "*STEP\n*STATIC\n17.\n*END STEP\n");
  const step *a = s.m->steps;
  ck_assert_int_eq(s.m->n.step, 5);
  PAIRS(a[0].kind, STEP_QUASISTATIC, a[2].kind, STEP_VISCO, a[4].kind,
        STEP_STATIC);
  PAIRS(a[0].form, 1, a[1].form, 0);
  PAIRS(a[0].dt, 0.25, a[0].total, 3, a[0].dt_min, 0.125, a[0].dt_max, 0.5);
  PAIRS(a[1].dt, 0.75, a[1].total, 7, a[1].dt_min, 0.75 / 16, a[1].dt_max,
        HUGE_VAL);
  PAIRS(a[2].dt, 2, a[2].total, 11, a[2].dt_max, 5);
  ck_assert_double_eq_tol(a[2].dt_min, 2e-6, 1e-20);
  PAIRS(a[3].dt_min, 0.625, a[4].total, 17);
  PAIRS(a[1].start, 3, a[2].start, 10, a[4].start, 34);
  ck_assert_str_eq(a[2].visco.integrator->name, "THETA");
  ck_assert_str_eq(a[3].visco.integrator->name, "EULER");
  PAIRS(a[2].visco.theta, 0.75, a[2].visco.tolerance, 0.01, a[2].visco.initial,
        1, a[2].visco.substeps, 1);
  PAIRS(a[3].visco.theta, 0, a[3].visco.tolerance, 0, a[3].visco.initial, 0,
        a[3].visco.substeps, 1);
}

TEST(solver_and_accuracy_of_a_step) {
  TEXT_MODEL s;
  read_steps(&s,
             "*STEP\n*QUASISTATIC\n1., 4.\n*BOUNDARY\nTOP, 1, 2\n"
             "*SOLVER, METHOD=SOR, TOL=1e-7, MAX_ITER=17, LIMIT_MAX_ITER=19, "
             "CHECK=ALL, STIFFNESS=DENSE\n"
             "*ACCURACY, MESH=NO, TIME=YES, SOLVER=NO, THEORY=YES\n*END STEP\n"
             "*STEP\n*QUASISTATIC\n1., 4.\n"
             "*SOLVER, MAX_MEMORY=23\n"
             "*ACCURACY, MESH=NO, TIME=BALANCED, TIME_SHARE=0.375\n"
             "*END STEP\n"
             "*STEP\n*QUASISTATIC\n1., 4.\n*ACCURACY, MESH=NO, TARGET=29, "
             "MAX_CPU=31, MAX_MEMORY=37, MAX_PASSES=5\n*END STEP\n"
             "*STEP\n*QUASISTATIC\n1., 4.\n*SOLVER, TOL=BALANCED, SHARE=0.25\n"
             "*ACCURACY, MESH=NO, SOLVER=NO\n*END STEP\n");
  const step *a = s.m->steps;
  ck_assert_str_eq(a[0].solver.ops->name, "sor");
  PAIRS(a[0].solver.tol, 1e-7, a[0].solver.max_iter, 17,
        a[0].solver.limit_max_iter, 19, a[0].check, CHECK_ALL,
        a[0].solver.stiffness, STIFFNESS_DENSE, a[0].balanced, 0);
  PAIRS(a[0].accuracy.mesh, MESH_ERROR_NO, a[0].accuracy.time, 1,
        a[0].accuracy.no_solver, 1, a[0].accuracy.theorems, 1,
        a[0].accuracy.time_balanced, 0);
  PAIRS(a[3].balanced, 1, a[3].share, 0.25, a[3].accuracy.mesh, MESH_ERROR_YES,
        a[3].accuracy.no_solver, 0);
  PAIRS(a[1].solver.ops == NULL, 1, a[1].balanced, 0, a[1].solver.max_memory,
        23, a[1].solver.max_iter, 0, a[1].check, CHECK_NONE);
  PAIRS(a[1].accuracy.mesh, MESH_ERROR_YES, a[1].accuracy.time, 1,
        a[1].accuracy.time_balanced, 1, a[1].accuracy.time_share, 0.375,
        a[1].accuracy.no_solver, 0, a[1].accuracy.theorems, 0);
  PAIRS(a[2].accuracy.mesh, MESH_ERROR_YES, a[2].accuracy.time, 1,
        a[2].accuracy.time_balanced, 0);
  const accuracy_target *t = &s.m->accuracy.target;
  PAIRS(t->percent, 29, t->max_cpu, 31, t->max_memory, 37, t->max_passes, 5);
}

/* What a step does not say is as it was in the step before, and where. */
TEST(a_step_of_nothing_is_like_the_one_before) {
  static const char *const said[] = {
      "*SOLVER, METHOD=SOR, TOL=1e-7, MAX_ITER=17, LIMIT_MAX_ITER=19, "
      "CHECK=ALL, STIFFNESS=DENSE\n"
      "*ACCURACY, MESH=NO, TIME=YES, SOLVER=NO, THEORY=YES\n"
      "*OUTPUT, FREQUENCY=5, CONDENSED=FCLIB\n*RESTART, FREQUENCY=7\n",
      "*SOLVER, TOL=BALANCED, SHARE=0.25\n"
      "*ACCURACY, MESH=YES, TIME=BALANCED, TIME_SHARE=0.375\n"};
  for (int k = 0; k < 2; ++k) {
    TEXT_MODEL s;
    PRINTED(text,
            "*STEP\n*QUASISTATIC\n1., 4.\n*BOUNDARY\nTOP, 1, 2\n%s*END STEP\n"
            "*STEP\n*QUASISTATIC\n1., 4.\n*END STEP\n",
            said[k]);
    read_steps(&s, text);
    const step *a = s.m->steps, *b = a + 1;
    ck_assert_int_eq(a->accuracy.at.line_no, 20);
    PAIRS(b->solver.ops == a->solver.ops, 1, b->solver.tol, a->solver.tol,
          b->solver.max_iter, a->solver.max_iter, b->solver.limit_max_iter,
          a->solver.limit_max_iter, b->solver.stiffness, a->solver.stiffness,
          b->check, a->check, b->balanced, a->balanced, b->share, a->share);
    PAIRS(b->accuracy.no_solver, a->accuracy.no_solver, b->accuracy.mesh,
          a->accuracy.mesh, b->accuracy.time, a->accuracy.time,
          b->accuracy.time_balanced, a->accuracy.time_balanced,
          b->accuracy.time_share, a->accuracy.time_share, b->accuracy.theorems,
          a->accuracy.theorems, b->accuracy.at.line_no, a->accuracy.at.line_no);
    PAIRS(b->output.frequency, a->output.frequency, b->output.condensed,
          a->output.condensed, b->output.at.line_no, a->output.at.line_no,
          b->restart.frequency, a->restart.frequency);
    if (k == 1) /* as no card says: fields of each increment, nothing else */
      PAIRS(a->output.frequency, 1, a->output.condensed, -1,
            a->restart.frequency, -1);
  }
}

TEST(outputs_of_a_step) {
  TEXT_MODEL s;
  read_steps(&s,
             "*TIME POINTS, NAME=P\n0.5, 1.5\n"
             "*STEP\n*QUASISTATIC\n1., 4.\n*BOUNDARY\nTOP, 1, 2\n"
             "*PRINT, NODES, FREQUENCY=3, GROUP=TOP\n"
             "*PRINT, ENERGY, TIME POINTS=P\n"
             "*OUTPUT, FREQUENCY=5, CONDENSED=FCLIB\n"
             "*RESTART, FREQUENCY=7\n*END STEP\n"
             "*STEP\n*QUASISTATIC\n1., 4.\n*OUTPUT, HDF5=NO, CONDENSED=FCLIB, "
             "FREQUENCY=11\n*END STEP\n"
             "*STEP\n*QUASISTATIC\n1., 4.\n*OUTPUT, FREQUENCY=13\n"
             "*END STEP\n");
  const step *a = s.m->steps;
  const print_request *q = a[0].print.requests;
  ck_assert_int_eq(a[0].print.n, 2);
  PAIRS(q[0].table, PRINT_NODES, q[0].frequency, 3);
  ck_assert_str_eq(q[0].group, "TOP");
  PAIRS(q[0].group_id >= 0, 1, q[0].points_name == NULL, 1);
  PAIRS(q[1].table, PRINT_ENERGY, q[1].group == NULL, 1);
  ck_assert_str_eq(q[1].points_name, "P");
  PAIRS(a[0].output.frequency, 5, a[0].output.condensed, 5,
        a[0].restart.frequency, 7);
  PAIRS(a[1].output.frequency, -1, a[1].output.condensed, 11);
  PAIRS(a[2].output.frequency, 13, a[2].output.condensed, -1);
}

/* The numbers of a vector. */
static void check_vector(const double *v, double x, double y, double z) {
  ck_assert_double_eq_tol(v[0], x, 1e-15);
  ck_assert_double_eq_tol(v[1], y, 1e-15);
  ck_assert_double_eq_tol(v[2], z, 1e-15);
}

static void read_in_space(text_model *s, const char *cards) {
  const int n[] = {2, 2, 2};
  const double length[] = {2.0, 3.0, 4.0};
  PRINTED(text,
          "*MESH, FILE=none.msh\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
          "*MATERIAL, NAME=M\n%s*STEP\n*QUASISTATIC\n1., 4.\n"
          "*BOUNDARY\nTOP, 1, 3\n*END STEP\n",
          cards);
  *s = text_model_read(text, make_grid_3d(n, length));
  ck_assert_int_eq(s->st, OK);
}

TEST(obstacles_and_contacts) {
  TEXT_MODEL s;
  read_in_space(&s,
                "*ELASTIC\n1000., 0.3\n*AMPLITUDE, NAME=R\n0., 0., 9., 9.\n"
                "*OBSTACLE, NAME=A, TYPE=CYLINDER, RADIUS=0.5, SIDE=INSIDE\n"
                "1., 2., 5.\n3., 0., 4.\nMOVE, 6., 7., 8.\n"
                "ROTATE, 9., 10., 11., 0., 6., -8., 0.25\n"
                "*OBSTACLE, NAME=B, TYPE=SPHERE, RADIUS=0.75\n12., 13., 14.\n"
                "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=A, NORMAL=OBSTACLE\n"
                "AXIS, 15., 16., 17., 6., 8., 0.\n"
                "*CONTACT, NAME=D, GROUP=LEFT, OBSTACLE=B, NORMAL=BODY\n");
  const obstacle *a = &s.m->obstacles[0], *b = &s.m->obstacles[1];
  PAIRS(a->inside, 1, a->radius, 0.5, a->turns, 1);
  check_vector(a->point, 1, 2, 5);
  check_vector(a->direction, 0.6, 0, 0.8);
  for (int k = 0; k < 3; ++k) ck_assert(a->motion[k].number == 6 + k);
  check_vector(a->pivot, 9, 10, 11);
  check_vector(a->axis, 0, 0.6, -0.8);
  ck_assert(a->angle.number == 0.25);
  PAIRS(b->inside, 0, b->radius, 0.75, b->turns, 0);
  check_vector(b->point, 12, 13, 14);
  const contact *c = s.m->contacts;
  PAIRS(c[0].obstacle_id, 0, c[1].obstacle_id, 1);
  PAIRS(c[0].obstacle_normal, 1, c[1].obstacle_normal, 0);
  PAIRS(c[0].has_axis, 1, c[1].has_axis, 0, c[0].axis_of_obstacle, 0);
  check_vector(c[0].axis_point, 15, 16, 17);
  check_vector(c[0].axis, 0.6, 0.8, 0);
}

TEST(materials_and_goals) {
  TEXT_MODEL s;
  read_in_space(&s,
                "*ELASTIC, TYPE=ORTHO, MODULI=LONG TERM\n"
                "100., 110., 120., 0.1, 0.11, 0.12, 40., 41., 42.\n"
                "*EXPANSION, TYPE=ORTHO, ZERO=7.\n1e-3, 2e-3, 3e-3\n"
                "*INELASTIC, LAW=NORTON, SHIFT=ARRHENIUS, T_REF=20., "
                "ACTIVATION=300., T_ZERO=-273.\n1e-9, 3.\n*DENSITY\n2.5\n"
                "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nBODY, 21.\n"
                "*GOAL, NAME=U, QUANTITY=DISPLACEMENT, COMPONENT=2, "
                "TARGET=0.125\n0., 0., 2.\n1., 1.5, 4.\n"
                "*GOAL, NAME=S, QUANTITY=STRESS, GROUP=BODY, COMPONENT=ZX, "
                "TARGET=\"3 %\"\n");
  const material *m = s.m->materials;
  double C[36] = {0.0};
  const double E[] = {100, 110, 120}, nu[] = {0.1, 0.11, 0.12};
  for (int i = 0; i < 3; ++i)
    C[7 * i] = 1 / E[i], C[21 + 7 * i] = 1.0 / (40 + i);
  C[1] = C[6] = -nu[0] / E[0];
  C[2] = C[12] = -nu[1] / E[0];
  C[8] = C[13] = -nu[2] / E[1];
  for (int i = 0; i < 6; ++i)
    for (int j = 0; j < 6; ++j) {
      /* shear xy, yz, zx of G12, G23, G13 */
      static const int at[] = {0, 1, 2, 3, 5, 4};
      double sum = 0.0;
      for (int k = 0; k < 6; ++k) sum += m->C[at[i] + 6 * at[k]] * C[k + 6 * j];
      ck_assert_double_eq_tol(sum, i == j, 1e-12);
    }
  PAIRS(m->moduli, MODULI_LONG_TERM, m->density, 2.5);
  ck_assert(m->expand.zero == 7);
  double e[3];
  expansion_strain(&m->expand, 17, 7, e);
  check_vector(e, 1e-2, 2e-2, 3e-2);
  const law_shift *x = &m->law.shift;
  PAIRS(x->kind, SHIFT_ARRHENIUS, x->reference, 20, x->activation, 300, x->zero,
        -273);
  ck_assert(s.m->initial.lines[0].value.number == 21);
  const goal_card *g = s.m->accuracy.goals;
  PAIRS(g[0].component, 1, g[0].target, 0.125, g[0].in_percent, 0, g[0].n_point,
        2);
  check_vector(g[0].point[0], 0, 0, 2);
  check_vector(g[0].point[1], 1, 1.5, 4);
  PAIRS(g[1].component, GOAL_TENSOR + 5, g[1].target, 3, g[1].in_percent, 1,
        g[1].group_id >= 0, 1);
}

/* u_a and stress_ab by the letters of the axes, the shears in their order xy,
 * yz, zx; of others a scene has none. */
TEST(components_of_a_reference_have_the_letters_of_its_scene) {
  static const char *const axes[] = {"xyz", "rzt", "xyz"};
  static const char *const shears[] = {"xyyzzx", "rz"};
  for (int k = 0; k < 3; ++k) {
    const int dim = k < 2 ? 2 : 3;
    for (const char *a = "xyzrt"; *a != '\0'; ++a) {
      char name[16];
      const char *at = strchr(axes[k], *a);
      const int axis = at == NULL ? -1 : (int)(at - axes[k]);
      sprintf(name, "u_%c", *a);
      ck_assert_int_eq(reference_place(name, dim, k == 1),
                       axis < dim ? axis : -1);
      sprintf(name, "stress_%c%c", *a, *a);
      ck_assert_int_eq(reference_place(name, dim, k == 1),
                       axis < 0 ? -1 : 3 + axis);
    }
    for (int s = 0; s < 4; ++s) {
      char name[16];
      sprintf(name, "stress_%.2s", s < 3 ? shears[0] + 2 * s : shears[1]);
      const int has = k == 1 ? s == 3 : s == 0 || (k == 2 && s < 3);
      ck_assert_int_eq(reference_place(name, dim, k == 1),
                       has ? 6 + s % 3 : -1);
    }
  }
}

UNIT_MAIN("cards")
