/*
 * Bodies that hardly touch: they fall through a gap under loads that grow from
 * nothing, start inside the floor by rounding, are led by their supports. Their
 * forces are those of the load to what rounding of the motion leaves, and
 * increments do not follow that rounding.
 */
#include "scenes/mesh.h"
#include "support/job.h"
#include "support/unit.h"

const int job_without_fields = 1;

static const mesh_change wavy = {
    .map = {"x + 0.05*sin(3.14159265358979*x)*sin(9*y)",
            "y + 0.05*sin(6.28318530717959*y)*cos(7*x)"}};
/* A round foot, 1e-12 inside the floor. */
static const mesh_change sunk = {
    .map = {NULL, "y + 0.1*(1 - y)*(x - 0.45)^2 - 0.00025 - 1e-12"}};

#define MAXWELL "*INELASTIC, LAW=MAXWELL\n2.\n"
#define CHABOCHE \
  "*INELASTIC, LAW=CHABOCHE\n0.3, 0.7, 3., 0.1, 50.\n100., 100.\n"

typedef struct fall {
  const mesh_change *mesh;
  double gap, load;
  const char *law, *step, *supports, *method;
} fall;

static int run_fall(job *j, const fall *f) {
  FREED int *number = NULL;
  *j = job_begin("fall");
  PRINTED(path, "%s/fall.msh", j->dir);
  FILE *out = fopen(path, "w");
  ck_assert_ptr_nonnull(out);
  ck_assert_int_eq(scene_mesh_write(out, "rect 6 4 1 1", f->mesh, &number), 1);
  fclose(out);
  job_write(j, "fall.inp",
            "*MESH, FILE=fall.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n%s"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=PLANE\n0., %.17g\n0., 1.\n"
            "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
            "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n*STEP\n%s\n%s"
            "*DSLOAD\nTOP, P, %.17g\n*SOLVER, METHOD=%s\n*PRINT, TOTALS\n"
            "*END STEP\n",
            f->law, -f->gap, f->step, f->supports, f->load, f->method);
  return job_run(j, "--no-timing --quiet");
}

/* All increments settled, few of them, the load carried in the end. */
static void ck_carried(const fall *f, int most, double tol) {
  JOB j;
  const int code = run_fall(&j, f);
  ck_assert_msg(code == 0, "gap %g, load %g, %s: exit %d: %s", f->gap, f->load,
                f->method, code, j.errors);
  const double normal = job_value(&j, "TOTALS", -1, "normal");
  ck_assert_msg(fabs(normal - f->load) <= tol * f->load,
                "gap %g, load %g, %s: %.17g", f->gap, f->load, f->method,
                normal);
  ck_assert_int_le((int)job_told(&j, "increment"), most);
}

static const char in_ten[] = "*QUASISTATIC\n0.1, 1.";
static const char held[] = "*BOUNDARY\nLEFT, 1\n";

#define SWEEPS_FALL "SOR", "AITKEN", "AITKEN, ACCELERATION=ANDERSON"

TESTS(next_to_no_load_is_carried, 9) {
  static const char *const methods[] = {
      "AUTO", "LEMKE", "PCG", "AUGLAG", "PROXIMAL", "LAGRANGE", SWEEPS_FALL};
  static const double loads[] = {1e-2, 1e-5, 1e-7};
  for (int k = 0; k < 3; ++k) {
    const fall f = {&wavy, 1e-3, loads[k], "", in_ten, held, methods[_i]};
    ck_carried(&f, 10, 1e-6);
  }
}

TESTS(chosen_increments_do_not_follow_the_fall, 36) {
  static const struct {
    const char *law, *step;
  } made[] = {{MAXWELL, "*VISCO, INTEGRATOR=BACKWARD, TOLERANCE=1.E-3\n1., 1."},
              {MAXWELL, "*VISCO, INTEGRATOR=RK4, TOLERANCE=1.E-3\n1., 1."},
              {CHABOCHE, "*VISCO, INTEGRATOR=RK4, TOLERANCE=1.E-3\n1., 20."}};
  static const double loads[] = {1e-2, 1e-3, 1e-5};
  static const char *const methods[] = {"AUTO", SWEEPS_FALL};
  const fall f = {&wavy,
                  1e-3,
                  loads[_i % 3],
                  made[_i / 3 % 3].law,
                  made[_i / 3 % 3].step,
                  held,
                  methods[_i / 9]};
  ck_carried(&f, 80, 1e-6);
}

/* No digit of the first increments, four of the last. */
TEST(rounding_counts_against_the_loads_of_the_step) {
  const fall f = {&wavy,
                  1.0,
                  3e-8,
                  MAXWELL,
                  "*VISCO, INTEGRATOR=BACKWARD, TOLERANCE=1.E-3\n1., 1.",
                  held,
                  "AUTO"};
  ck_carried(&f, 80, 1e-2);
}

TEST(no_load_at_all_ends_with_a_verdict) {
  JOB j;
  const fall f = {&wavy, 1.0, 1e-16, "", in_ten, held, "AUTO"};
  ck_assert_int_eq(run_fall(&j, &f), 6);
  ck_assert_ptr_nonnull(strstr(j.errors, "rounding leaves no correct digit"));
}

TESTS(a_start_inside_the_floor_by_rounding_is_none, 12) {
  static const char *const methods[] = {"AUTO",     "PCG",   "PROXIMAL",
                                        "LAGRANGE", "LEMKE", "SOR"};
  const fall f = {&sunk,
                  0.0,
                  1.0,
                  MAXWELL,
                  "*VISCO, INTEGRATOR=BACKWARD\n0.5, 1.",
                  _i % 2 == 0 ? "" : "*BOUNDARY\nTOP, 1\n",
                  methods[_i / 2]};
  ck_carried(&f, 3, 1e-6);
}

/* No contact: the strains of a body that its supports lead are rounding. */
TEST(chosen_increments_do_not_follow_supports) {
  JOB j = job_begin("led");
  FREED int *number = NULL;
  PRINTED(path, "%s/led.msh", j.dir);
  FILE *out = fopen(path, "w");
  ck_assert_ptr_nonnull(out);
  ck_assert_int_eq(scene_mesh_write(out, "rect 6 4 1 1", &wavy, &number), 1);
  fclose(out);
  job_write(
      &j, "led.inp",
      "*MESH, FILE=led.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n" MAXWELL
      "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n*STEP\n"
      "*VISCO, INTEGRATOR=BACKWARD, TOLERANCE=1.E-3\n0.5, 1.\n"
      "*BOUNDARY\nTOP, 1, 1, 0.3\nTOP, 2, 2, -0.7\n*END STEP\n");
  ck_assert_int_eq(job_run(&j, "--no-timing --quiet"), 0);
  ck_assert_int_le((int)job_told(&j, "increment"), 2);
}

/* The wall carries the traction on its nodes straight: no strain, no loss, nor
 * anything that could flow. */
TESTS(loads_carried_straight_lose_nothing, 2) {
  const mesh_change bent = {
      .map = {NULL, NULL, "z + 0.05*(x - 0.5)^2*(1 - z)"}};
  FREED int *number = NULL;
  JOB j = job_begin("wall");
  PRINTED(path, "%s/wall.msh", j.dir);
  FILE *out = fopen(path, "w");
  ck_assert_ptr_nonnull(out);
  ck_assert_int_eq(scene_mesh_write(out, "box 2 2 2 1 1 1", &bent, &number), 1);
  fclose(out);
  job_write(
      &j, "wall.inp",
      "*MESH, FILE=wall.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.07\n%s"
      "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
      "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
      "*CONTACT, NAME=C, GROUP=RIGHT, OBSTACLE=O\n"
      "*OBSTACLE, NAME=FLOOR, TYPE=SPHERE, RADIUS=12.8\n0.5, 0.45, -12.8\n"
      "*CONTACT, NAME=D, GROUP=BOTTOM, OBSTACLE=FLOOR, NORMAL=OBSTACLE\n"
      "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n"
      "*AMPLITUDE, NAME=NOW\n0., 1.\n1., 1.\n*STEP\n%s"
      "*BOUNDARY\nTOP, 1, 3\n"
      "*DSLOAD\nRIGHT, TX, 0.14, NOW\n*PRINT, TOTALS\n*END STEP\n",
      _i == 0 ? "" : MAXWELL,
      _i == 0 ? "*STATIC\n" : "*VISCO, INTEGRATOR=BACKWARD\n0.5, 1.\n");
  CK_EXIT(job_run(&j, "--no-timing --quiet"), 0, j);
}

/* Open nodes carry the loads by friction while the supports move the body. */
TESTS(loads_carried_straight_by_a_body_led_lose_nothing, 8) {
  JOB j = job_with("led", "tests/regression/mesh/square.geo",
                   "*PARAMETER\nN = %d\n*MESH, FILE=square.geo\n"
                   "*MATERIAL, NAME=M\n*ELASTIC\n1., %g\n%s"
                   "*SOLID SECTION, ELSET=BODY, MATERIAL=M%s\n"
                   "*OBSTACLE, NAME=O, TYPE=PLANE\n0., -1.\n0., 1.\n"
                   "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
                   "*FRICTION, CONTACT=C, LAW=TRESCA\n1.E6\n"
                   "*STEP\n%s\n0.5, 1.\n"
                   "*BOUNDARY\nTOP, 1, 1, 0.\nTOP, 2, 2, -0.7\n%s"
                   "*CLOAD\nBOTTOM, 1, %s\n*SOLVER, METHOD=%s\n*PRINT, TOTALS\n"
                   "*END STEP\n",
                   _i < 6 ? 4 : 16, _i < 6 ? 0.3 : 0.499,
                   _i / 2 != 1 ? "" : MAXWELL, _i < 6 ? "" : ", TYPE=CAX3",
                   _i / 2 != 1 ? "*QUASISTATIC" : "*VISCO, INTEGRATOR=BACKWARD",
                   _i < 6 ? "" : "LEFT, 1\n", _i % 2 == 0 ? "0.1" : "1.E4",
                   _i / 2 != 2 ? "AUTO" : "LAGRANGE");
  ck_assert_msg(job_run(&j, "--no-timing --quiet") == 0, "%s", j.errors);
}

/* So they do on a floor that moves, where a node is far softer than others. */
TESTS(loads_carried_straight_on_a_floor_led_lose_nothing, 4) {
  static const char *const methods[] = {"AUTO", "SOR", "LEMKE", "LAGRANGE"};
  const mesh_change bent = {.map = {"x + 0.05*x*(1 - x)*(1 - z)", NULL, NULL}};
  FREED int *number = NULL;
  JOB j = job_begin("box");
  PRINTED(path, "%s/box.msh", j.dir);
  FILE *out = fopen(path, "w");
  ck_assert_ptr_nonnull(out);
  ck_assert_int_eq(scene_mesh_write(out, "box 3 1 1 1 0.5 1", &bent, &number),
                   1);
  fclose(out);
  job_write(&j, "box.inp",
            "*MESH, FILE=box.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=SPHERE, RADIUS=200.\n0.5, 0.5, -200.\n"
            "MOVE, 0., \"5E-6*sin(2*pi*t)\", 0.\n"
            "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
            "*FRICTION, CONTACT=C, LAW=TRESCA\n0.2\n"
            "*STEP\n*QUASISTATIC\n0.5, 1.\n*BOUNDARY\nTOP, 1, 3\n"
            "*DSLOAD\nRIGHT, P, -6.1E-4\n*SOLVER, METHOD=%s\n"
            "*PRINT, TOTALS\n*END STEP\n",
            methods[_i]);
  ck_assert_msg(job_run(&j, "--no-timing --quiet") == 0, "%s", j.errors);
}

/* Nothing but supports strains the body: its errors are those of any other. */
TEST(supports_alone_leave_an_error_of_the_mesh) {
  JOB j =
      job_with("pulled", "tests/regression/mesh/square.geo",
               "*MESH, FILE=square.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1., 0.3\n"
               "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n*STEP\n"
               "*QUASISTATIC\n0.5, 1.\n*BOUNDARY\n"
               "BOTTOM, 1, 2\nTOP, 1, 1, 0.1\nTOP, 2, 2, 0.1\n*END STEP\n");
  ck_assert_int_eq(job_run(&j, "--no-timing --quiet"), 0);
  ck_assert_double_gt(job_told(&j, "mesh_error_percent"), 1);
}

/* What a loose tolerance leaves between contact forces is nobody's once all
 * nodes are off. */
TESTS(a_body_lifted_off_keeps_no_forces, 4) {
  static const char *const methods[] = {"SOR", "AITKEN", "AUGLAG", "PCG"};
  PRINTED(method, "%s, TOL=1.E-3", methods[_i]);
  const fall f = {&wavy,
                  0,
                  1,
                  "*AMPLITUDE, NAME=A\n0., 0.\n1., -1.\n2., 0.2\n",
                  "*QUASISTATIC\n1., 2.",
                  "*BOUNDARY\nTOP, 1, 1, 0.01, A\nTOP, 2, 2, 0.01, A\n",
                  method};
  JOB j;
  ck_assert_int_eq(run_fall(&j, &f), 0);
  DAT pressed = job_table(&j, "TOTALS", 0), t = job_table(&j, "TOTALS", -1);
  ck_assert_double_gt(dat_at(&pressed, 0, "normal"), 1);
  ck_assert_double_eq(dat_at(&t, 0, "normal"), 0);
  ck_assert_double_eq(dat_at(&t, 0, "tangential"), 0);
}

/* No wall stands where no normal meets the ball: a body led down by three of
 * its sizes has no forces, one that is pressed down has no equilibrium. */
TESTS(a_ball_that_no_normal_meets_holds_nothing, 2) {
  static const char *const by[] = {"TOP, 1, 1, 0.\nTOP, 2, 2, -3.\n",
                                   "LEFT, 1\n*DSLOAD\nTOP, P, 1.\n"};
  JOB j = job_with(
      "ball", "tests/regression/mesh/square.geo",
      "*MESH, FILE=square.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
      "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
      "*OBSTACLE, NAME=O, TYPE=SPHERE, RADIUS=0.001\n9., -5.\n"
      "MOVE, 0., 5E-4\n*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
      "*STEP\n*QUASISTATIC\n0.5, 1.\n*BOUNDARY\n%s"
      "*PRINT, TOTALS\n*END STEP\n",
      by[_i]);
  ck_assert_int_eq(job_run(&j, "--no-timing --quiet"), _i == 0 ? 0 : 6);
  if (_i == 0) {
    ck_assert_double_eq(job_value(&j, "TOTALS", -1, "normal"), 0);
  } else {
    ck_assert_ptr_nonnull(strstr(j.errors, "meets no obstacle"));
  }
}

UNIT_MAIN("falling")
