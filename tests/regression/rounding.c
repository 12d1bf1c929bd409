/*
 * What rounding takes of an answer, on bodies of uniform strain, for which the
 * error of the stresses is known: contrasts of stiffness, nu near 1/2 and thin
 * elements, held by supports or by contact alone, meshes of unequal triangles;
 * bodies that are led far before they touch, or do not touch at all.
 * What the listing tells is the error within a factor of ten; nothing is told
 * where nothing is lost; without a digit the run ends with exit code 6.
 */
#include "scenes/mesh.h"
#include "support/block_file.h"
#include "support/job.h"
#include "support/unit.h"

const int job_without_fields = 1;

static const char wavy_x[] = "x + 0.05*sin(3.14159265358979*x)*sin(9*y)";
static const char wavy_y[] = "y + 0.05*sin(6.28318530717959*y)*cos(7*x)";

static const mesh_change as_it_is;
static const double NOISE = 1e-9; /* -, refined answers are better than that */

static void begin(job *j, const char *grid, const mesh_change *change) {
  FREED int *number = NULL;
  *j = job_begin("pressed");
  PRINTED(path, "%s/pressed.msh", j->dir);
  FILE *f = fopen(path, "w");
  ck_assert_ptr_nonnull(f);
  ck_assert_int_eq(scene_mesh_write(f, grid, change, &number), 1);
  fclose(f);
}

/* A block of the mesh pressed by 1/64 onto the plane below it, which is rough
 * where nothing else holds the block. */
static int run_pressed(job *j, const char *grid, const mesh_change *change,
                       const char *materials, const char *supports) {
  begin(j, grid, change);
  job_write(j, "pressed.inp",
            "*MESH, FILE=pressed.msh\n%s"
            "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\n"
            "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
            "*FRICTION, CONTACT=C, LAW=COULOMB\n%d\n*STEP\n*STATIC\n%s"
            "*DSLOAD\nTOP, P, 0.015625\n"
            "*PRINT, ELEMENTS, NODES, CONTACT\n*END STEP\n",
            materials, supports[0] == '\0', supports);
  return job_run(j, "--no-timing");
}

/* Loss of the stresses that the listing tells, -; 0: none. All it tells is that
 * of JOB.json to one digit. */
static double told(const job *j) {
  static const char *const name[] = {"rounding_energy_percent",
                                     "rounding_stress_percent",
                                     "rounding_displacement_percent"};
  FREED char *text = job_file(j, "lst");
  const char *line = strstr(text, "\n  rounding: ");
  double part[3] = {0.0};
  if (line != NULL)
    ck_assert_int_eq(sscanf(line,
                            " rounding: %lf %% of the energy norm, %lf %% of "
                            "the largest stress, %lf %% of the largest "
                            "displacement",
                            &part[0], &part[1], &part[2]),
                     3);
  for (int i = 0; i < 3 && line != NULL; ++i) {
    const double all = job_told(j, name[i]);
    ck_assert_msg(fabs(part[i] - all) <= 0.34 * all, "%s: %g, listed %g",
                  name[i], all, part[i]);
  }
  return 0.01 * part[1];
}

/* Largest error of the stresses, over those of uniform pressure. */
static double stress_error(const job *j) {
  DAT e = job_table(j, "ELEMENTS", -1);
  double worst = 0.0;
  for (int i = 0; i < e.n_row; ++i) {
    worst = fmax(worst, fabs(dat_at(&e, i, "stress_yy") + 1.0 / 64));
    worst = fmax(worst, fabs(dat_at(&e, i, "stress_xx")));
  }
  return 64 * worst;
}

/* Root mean square of the errors of the stresses, over the same. */
static double norm_error(const job *j) {
  DAT e = job_table(j, "ELEMENTS", -1);
  double sum = 0.0;
  for (int i = 0; i < e.n_row; ++i)
    sum += pow(dat_at(&e, i, "stress_yy") + 1.0 / 64, 2) +
           pow(dat_at(&e, i, "stress_xx"), 2) +
           2.0 * pow(dat_at(&e, i, "stress_xy"), 2);
  double mean = sum / e.n_row;
  return 64 * sqrt(mean);
}

static const char layers[] =
    "*MATERIAL, NAME=S\n*ELASTIC\n1., 0.\n"
    "*MATERIAL, NAME=H\n*ELASTIC\n%s, 0.\n"
    "*SOLID SECTION, ELSET=SOFT, MATERIAL=S\n"
    "*SOLID SECTION, ELSET=HARD, MATERIAL=H\n";

static int run_layers(job *j, const char *contrast, const char *supports) {
  const mesh_change wavy = {.map = {wavy_x, wavy_y}};
  PRINTED(text, layers, contrast);
  return run_pressed(j, "rect 6 8 1 1 layers", &wavy, text, supports);
}

/* The same on a support in the place of the plane. */
static int run_supported_layers(job *j, const char *contrast) {
  const mesh_change wavy = {.map = {wavy_x, wavy_y}};
  PRINTED(text, layers, contrast);
  begin(j, "rect 6 8 1 1 layers", &wavy);
  job_write(j, "pressed.inp",
            "*MESH, FILE=pressed.msh\n%s*STEP\n*STATIC\n*BOUNDARY\n"
            "LEFT, 1\nBOTTOM, 2\n*DSLOAD\nTOP, P, 0.015625\n"
            "*PRINT, ELEMENTS, NODES\n*END STEP\n",
            text);
  return job_run(j, "--no-timing");
}

/* Largest error of the displacements of the soft layer below the hard one of
 * that contrast, over the largest. */
static double displacement_error(const job *j, double contrast) {
  DAT n = job_table(j, "NODES", -1);
  double worst = 0.0;
  for (int i = 0; i < n.n_row; ++i) {
    const double y = dat_at(&n, i, "y");
    const double exact = -fmin(y, 0.5) - fmax(y - 0.5, 0.0) / contrast;
    worst = fmax(worst, fabs(64 * dat_at(&n, i, "u_y") - exact) / 0.5);
    worst = fmax(worst, fabs(64 * dat_at(&n, i, "u_x")) / 0.5);
  }
  return worst;
}

static int run_stiff(job *j, const char *nu, const char *formulation) {
  const mesh_change wavy = {.map = {wavy_x, wavy_y}};
  PRINTED(text,
          "*MATERIAL, NAME=M\n*ELASTIC\n1., %s\n"
          "*SOLID SECTION, ELSET=BODY, MATERIAL=M, FORMULATION=%s\n",
          nu, formulation);
  return run_pressed(j, "rect 6 6 1 1", &wavy, text, "*BOUNDARY\nLEFT, 1\n");
}

/* A block that its top leads down by way + 1/1024, the plane way below it: the
 * strain is 1/1024, the stress 1/64. */
static int run_led(job *j, double way) {
  const mesh_change wavy = {.map = {wavy_x, wavy_y}};
  begin(j, "rect 6 6 1 1", &wavy);
  job_write(j, "pressed.inp",
            "*MESH, FILE=pressed.msh\n"
            "*MATERIAL, NAME=M\n*ELASTIC\n16., 0.\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=PLANE\n0., %.17g\n0., 1.\n"
            "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n*STEP\n*STATIC\n"
            "*BOUNDARY\nLEFT, 1\nTOP, 2, 2, %.17g\n"
            "*PRINT, ELEMENTS, NODES, CONTACT\n*END STEP\n",
            -way, -way - 1.0 / 1024);
  return job_run(j, "--no-timing");
}

/* A block beside a wall that it does not reach: supports, and by them a stress
 * (yy) of -1/64, without a force on the block. */
static int run_apart(job *j, const char *materials, const char *supports) {
  const mesh_change wavy = {.map = {wavy_x, wavy_y}};
  begin(j, "rect 6 8 1 1 layers", &wavy);
  job_write(j, "pressed.inp",
            "*MESH, FILE=pressed.msh\n%s*OBSTACLE, NAME=O, TYPE=PLANE\n"
            "4., 0.\n-1., 0.\n*CONTACT, NAME=C, GROUP=RIGHT, OBSTACLE=O\n"
            "*STEP\n*STATIC\n*BOUNDARY\n%s*PRINT, ELEMENTS, NODES\n"
            "*END STEP\n",
            materials, supports);
  return job_run(j, "--no-timing");
}

/* Carried by its supports, which press it by 1/1024. */
static int run_carried(job *j, double way) {
  PRINTED(supports, "LEFT, 1\nBOTTOM, 2, 2, %.17g\nTOP, 2, 2, %.17g\n", way,
          way - 1.0 / 1024);
  return run_apart(j,
                   "*MATERIAL, NAME=M\n*ELASTIC\n16., 0.\n*SOLID SECTION, "
                   "ELSET=SOFT, MATERIAL=M\n*SOLID SECTION, ELSET=HARD, "
                   "MATERIAL=M\n",
                   supports);
}

/* The bound of the solver counts what rounding has missed. */
static void ck_counted(const job *j) {
  FREED char *json = job_file(j, "json");
  const int both = strstr(json, "\"rounding_energy_percent\"") != NULL &&
                   strstr(json, "\"solver_error_percent\"") != NULL;
  if (!both || isnan(job_told(j, "solver_error_percent"))) return;
  ck_assert_double_ge(job_told(j, "solver_error_percent"),
                      0.999 * job_told(j, "rounding_energy_percent"));
}

static void ck_told(job *j, int code) {
  ck_assert_msg(code == 0, "exit %d: %s", code, j->errors);
  double error = stress_error(j), loss = told(j);
  ck_assert_msg(loss >= 0.1 * error && loss <= 10.0 * error + NOISE,
                "told %g, error %g", loss, error);
  ck_counted(j);
  job_end(j);
}

static void ck_refused(job *j, int code) {
  ck_assert_msg(code == 6, "exit %d: %s", code, j->errors);
  ck_assert_msg(strstr(j->errors, "rounding leaves no correct digit") != NULL,
                "%s", j->errors);
  job_end(j);
}

TESTS(loss_by_contrast_is_told, 6) {
  static const char *const supports[] = {"*BOUNDARY\nLEFT, 1\n", ""};
  static const char *const contrasts[] = {"1.E8", "1.E10", "1.E12"};
  job j;
  int code = run_layers(&j, contrasts[_i % 3], supports[_i / 3]);
  ck_told(&j, code);
}

TESTS(no_digit_is_left_of_too_much_contrast, 2) {
  job j;
  int code = run_layers(&j, "1.E15", _i == 0 ? "*BOUNDARY\nLEFT, 1\n" : "");
  ck_refused(&j, code);
}

TESTS(loss_without_contact_is_told, 4) {
  static const char *const contrasts[] = {"1.E8", "1.E10", "1.E12", "1.E13"};
  job j;
  int code = run_supported_layers(&j, contrasts[_i]);
  double error = displacement_error(&j, strtod(contrasts[_i], NULL));
  double loss = 0.01 * job_told(&j, "rounding_displacement_percent");
  ck_assert_msg(loss >= 0.1 * error && loss <= 10.0 * error + NOISE,
                "told %g, error %g", loss, error);
  ck_told(&j, code);
}

TEST(no_digit_is_left_without_contact) {
  job j;
  int code = run_supported_layers(&j, "1.E15");
  ck_refused(&j, code);
}

TESTS(loss_near_incompressibility_is_told, 6) {
  static const char *const nus[] = {"0.49999999", "0.49999999999",
                                    "0.4999999999999"};
  job j;
  int code = run_stiff(&j, nus[_i % 3], _i < 3 ? "STANDARD" : "AVERAGED");
  ck_told(&j, code);
}

TESTS(loss_of_thin_elements_is_told, 4) {
  static const char *const meshes[] = {"rect 6 6 1e4 1", "rect 6 6 1 1e4",
                                       "rect 6 6 1e6 1", "rect 6 6 1 1e7"};
  job j;
  int code = run_pressed(&j, meshes[_i], &as_it_is,
                         "*MATERIAL, NAME=M\n*ELASTIC\n1., 0.3\n"
                         "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n",
                         "*BOUNDARY\nLEFT, 1\n");
  ck_told(&j, code);
}

TEST(no_digit_is_left_of_needles) {
  job j;
  int code = run_pressed(&j, "rect 6 6 1 1e8", &as_it_is,
                         "*MATERIAL, NAME=M\n*ELASTIC\n1., 0.3\n"
                         "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n",
                         "*BOUNDARY\nLEFT, 1\n");
  ck_refused(&j, code);
}

/* Without lateral strain the energy norm is that of the stresses. */
TESTS(loss_of_a_body_led_far_is_told, 4) {
  job j;
  int code = run_led(&j, ldexp(1.0, 22 + 3 * _i));
  ck_assert_msg(code == 0, "exit %d: %s", code, j.errors);
  double error = norm_error(&j);
  double loss = 0.01 * job_told(&j, "rounding_energy_percent");
  ck_assert_msg(loss >= 0.1 * error && loss <= 10.0 * error + NOISE,
                "told %g, error %g", loss, error);
  ck_told(&j, code);
}

TESTS(no_digit_is_left_of_a_body_led_too_far, 2) {
  job j;
  int code = run_led(&j, ldexp(1.0, 38 + 4 * _i));
  ck_refused(&j, code);
}

TESTS(loss_of_a_body_carried_far_is_told, 4) {
  job j;
  int code = run_carried(&j, ldexp(1.0, 20 + 4 * _i));
  ck_told(&j, code);
}

TESTS(no_digit_is_left_of_a_body_carried_too_far, 2) {
  job j;
  int code = run_carried(&j, ldexp(1.0, 38 + 2 * _i));
  ck_refused(&j, code);
}

/* A pressed bar that creeps until its elastic strains are no more than the
 * rounding of all: the stresses, whatever rounding makes of them, 0 too. */
TESTS(no_digit_is_left_of_a_bar_that_crept_too_far, 3) {
  static const char *const tau[] = {"1E-16", "1E-20", "1E-100"};
  job j;
  begin(&j, "rect 2 2 1 1", &as_it_is);
  job_write(&j, "pressed.inp",
            "*MESH, FILE=pressed.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1E3, 0.\n"
            "*INELASTIC, LAW=MAXWELL\n%s\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n*STEP\n"
            "*VISCO, INTEGRATOR=BACKWARD\n0.5, 1.\n*BOUNDARY\n"
            "LEFT, 1\nBOTTOM, 2\n*DSLOAD\nTOP, P, 10.\n*END STEP\n",
            tau[_i]);
  int code = job_run(&j, "");
  ck_refused(&j, code);
}

/* A hard layer on a soft one, shifted or turned by the supports of the soft one
 * alone: no stress at all, and displacements right to some digits. */
TESTS(rigid_motion_is_right_to_its_digits, 6) {
  static const char *const contrasts[] = {"1.E4", "1.E8", "1.E12"};
  static const char *const supports[] = {
      "BOTTOM, 1\nBOTTOM, 2, 2, 0.3125\n",
      "BOTTOM, 1, 1, \"-0.25*(y - 1)\"\nBOTTOM, 2, 2, \"0.25*(x - 3)\"\n"};
  const int turned = _i / 3;
  const double most = turned ? 0.75 : 0.3125;
  JOB j;
  PRINTED(text, layers, contrasts[_i % 3]);
  CK_EXIT(run_apart(&j, text, supports[turned]), 0, j);
  DAT n = job_table(&j, "NODES", -1);
  double error = 0.0;
  for (int i = 0; i < n.n_row; ++i) {
    const double x = dat_at(&n, i, "x"), y = dat_at(&n, i, "y");
    const double u = turned ? -0.25 * (y - 1) : 0.0;
    const double v = turned ? 0.25 * (x - 3) : 0.3125;
    error = fmax(error, fabs(dat_at(&n, i, "u_x") - u) / most);
    error = fmax(error, fabs(dat_at(&n, i, "u_y") - v) / most);
  }
  FREED char *json = job_file(&j, "json");
  const int said = strstr(json, "rounding_displacement_percent") != NULL;
  const double loss =
      said ? 0.01 * job_told(&j, "rounding_displacement_percent") : 0.0;
  ck_assert_msg(loss >= 0.1 * error - NOISE && loss <= 10.0 * error + NOISE,
                "told %g, error %g", loss, error);
}

/* Led through the air by its support, a body of many nodes keeps no stress:
 * what it creeps by, and the works, are rounding, so two increments are enough,
 * near nu = 1/2 too. */
TESTS(creep_in_free_motion_is_rounding, 3) {
  static const char *const nu[] = {"0.3", "0.499", "0.4999999"};
  const int n = _i == 0 ? 40 : 8;
  JOB j;
  PRINTED(grid, "rect %d %d 1 1", n, n);
  begin(&j, grid, &(mesh_change){.map = {wavy_x, wavy_y}});
  job_write(&j, "pressed.inp",
            "*MESH, FILE=pressed.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., %s\n"
            "*INELASTIC, LAW=MAXWELL\n1.\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n*STEP\n"
            "*VISCO, INTEGRATOR=BACKWARD, TOLERANCE=1E-3\n0.25, 1.\n*BOUNDARY\n"
            "TOP, 1, 1, \"1.3*sin(t)\"\nTOP, 2, 2, \"0.7*t\"\n"
            "*ACCURACY, TIME=YES\n*PRINT, ENERGY\n*END STEP\n",
            nu[_i]);
  ck_assert_int_eq(job_run(&j, ""), 0);
  ck_assert_double_eq(job_told(&j, "time_error_percent"), 0);
  DAT e = job_table(&j, "ENERGY", -1);
  ck_assert_double_le(dat_at(&e, 0, "increment"), 3);
  ck_assert_double_eq(dat_at(&e, 0, "energy_defect_relative"), 0);
}

static double lowered_force(const char *nu, const char *visco, int by_top) {
  JOB j;
  begin(&j, "rect 4 4 1 1", &as_it_is);
  job_write(&j, "pressed.inp",
            "*MESH, FILE=pressed.msh\n*MATERIAL, NAME=M\n*ELASTIC\n200., %s\n"
            "%s*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=PLANE\n0., -0.02\n0., 1.\n%s"
            "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n*STEP\n"
            "*VISCO, INTEGRATOR=MIDPOINT\n0.2, 1.\n"
            "*BOUNDARY\nTOP, 1\nTOP, 2, 2, %s\n*PRINT, TOTALS\n*END STEP\n",
            nu, visco, by_top ? "" : "MOVE, 0., 0.04\n",
            by_top ? "-0.04" : "0.");
  const int code = job_run(&j, "");
  ck_assert_msg(code == 0, "nu %s: exit %d: %s", nu, code, j.errors);
  ck_assert_ptr_null(strstr(j.errors, "time 0.2:"));
  return job_value(&j, "TOTALS", -1, "normal");
}

/* The body is lowered onto the obstacle, or the obstacle lifted to it: the
 * error bound of what has no stress yet is none. */
TESTS(body_lowered_through_a_gap_is_settled, 6) {
  static const char *const nu[] = {"0.499", "0.49999", "0.4999999"};
  static const char *const law[] = {"*INELASTIC, LAW=MAXWELL\n1.\n",
                                    "*INELASTIC, LAW=NORTON\n1.E-4, 3.\n"};
  const double expected = lowered_force(nu[_i / 2], law[_i % 2], 0);
  ck_assert_double_gt(expected, 1.0);
  ck_assert_double_eq_tol(lowered_force(nu[_i / 2], law[_i % 2], 1), expected,
                          1e-6 * expected);
}

/* Led through the air, back and left there, where it has no displacement that
 * could have a rounding. */
TEST(works_of_free_motion_stay_rounding_at_its_origin) {
  JOB j;
  begin(&j, "rect 4 4 1 1", &(mesh_change){.map = {wavy_x, wavy_y}});
  job_write(
      &j, "pressed.inp",
      "*MESH, FILE=pressed.msh\n*MATERIAL, NAME=M\n*ELASTIC\n59351., 0.177\n"
      "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n*STEP\n*STATIC\n"
      "*BOUNDARY\nTOP, 1, 1, 1.E-4\nTOP, 2, 2, -3.795E-4\n"
      "*PRINT, ENERGY\n*END STEP\n*STEP\n*QUASISTATIC\n1., 3.\n"
      "*BOUNDARY\nTOP, 1, 1, \"3.E-4*max(3 - t, 0)*(t - 1.3)\"\n"
      "TOP, 2, 2, \"-3.795E-4*max(3 - t, 0)\"\n*PRINT, ENERGY\n*END STEP\n");
  CK_EXIT(job_run(&j, ""), 0, j);
  for (int k = 0; k < 4; ++k) {
    DAT e = job_table(&j, "ENERGY", k);
    ck_assert_msg(dat_at(&e, 0, "energy_defect_relative") == 0.0,
                  "time %g: defect %g", dat_at(&e, 0, "time"),
                  dat_at(&e, 0, "energy_defect_relative"));
  }
  FREED char *json = job_file(&j, "json");
  ck_assert_ptr_null(strstr(json, "coarse_mesh"));
}

/* A block that reaches into the one below by the last digit of the coordinates
 * presses nothing at the start. */
TESTS(gaps_of_rounding_make_no_increment, 2) {
  JOB j;
  begin(&j, "rect 2 2 1 1 + rect 3 3 1 1 at 0 0.99999999999999989",
        &(mesh_change){.shift = _i});
  job_write(&j, "pressed.inp",
            "*MESH, FILE=pressed.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
            "*INELASTIC, LAW=MAXWELL\n1.\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*SOLID SECTION, ELSET=BODY2, MATERIAL=M\n"
            "*CONTACT PAIR, NAME=P\nTOP, BOTTOM2\n*STEP\n"
            "*VISCO, INTEGRATOR=BACKWARD\n0.25, 1.\n*BOUNDARY\n"
            "BOTTOM, 1, 2\nTOP2, 1\nTOP2, 2, 2, -1.E-3\n*PRINT, ENERGY\n"
            "*END STEP\n");
  ck_assert_int_eq(job_run(&j, ""), 0);
  ck_assert_double_eq(job_value(&j, "ENERGY", -1, "increment"), 4);
}

/* A block turned against a plane, and 1e6 of its sizes away: its nodes stand
 * from it by the rounding of their coordinates. Where that is more than the
 * load moves them, pressures are wrong and the run says so; in line with the
 * axes nothing is lost. */
TESTS(pressures_below_the_rounding_of_coordinates_are_told, 4) {
  static const struct {
    double turn, load, error;
    int code;
  } rows[] = {{0.7, 1, 1e-4, 0},
              {0.7, 1e-5, 0.2, 0},
              {0.7, 1e-7, 0, 1},
              {0, 1e-7, 1e-4, 0}};
  const double turn = rows[_i].turn, load = rows[_i].load;
  JOB j;
  begin(&j, "rect 4 4 1 1", &(mesh_change){.turn = turn, .shift = 1e6});
  job_write(&j, "pressed.inp",
            "*MESH, FILE=pressed.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=PLANE\n1e6, 1e6\n%.17g, %.17g\n"
            "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
            "*FRICTION, CONTACT=C, LAW=COULOMB\n1.\n*STEP\n*STATIC\n"
            "*DSLOAD\nTOP, P, %g\n*PRINT, CONTACT\n*END STEP\n",
            -sin(turn), cos(turn), load);
  const int code = job_run(&j, "");
  ck_assert_msg(code == rows[_i].code, "exit %d: %s", code, j.errors);
  const double found = job_max(&j, "CONTACT", -1, "pressure") / load;
  if (code == 0)
    ck_assert_double_eq_tol(found, 1, rows[_i].error);
  else
    ck_assert_double_gt(job_told(&j, "rounding_hidden_percent"), 10);
}

/* Friction below the rounding of the pressures is lost, and nothing else is. */
TEST(rounding_may_hide_a_friction_of_next_to_nothing) {
  static const char *const mu[] = {"0", "1E-300", "1E-20", "1E-14", "1E-12"};
  double normal = 0.0;
  for (int k = 0; k < 5; ++k) {
    JOB j = job_begin("slight");
    block_file_write(&j, (int[]){4, 4}, (double[]){1.0, 1.0}, 0);
    job_write(&j, "slight.inp",
              "*MESH, FILE=block.msh\n*MATERIAL, NAME=M\n*ELASTIC\n2.1E5, 0.3\n"
              "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
              "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\nMOVE, 1E-4, 0.\n"
              "*CONTACT, NAME=C, GROUP=CONTACT, OBSTACLE=O\n"
              "*FRICTION, CONTACT=C, LAW=COULOMB\n%s\n*STEP\n*STATIC\n"
              "*BOUNDARY\nLEFT, 1, 2, 0.\n*DSLOAD\nTOP, P, 1.\n"
              "*PRINT, TOTALS\n*END STEP\n",
              mu[k]);
    int code = job_run(&j, "");
    ck_assert_msg(code == 0, "mu = %s: exit %d: %s", mu[k], code, j.errors);
    DAT d = job_table(&j, "TOTALS", -1);
    if (k == 0) normal = dat_at(&d, 0, "normal");
    ck_assert_double_eq_tol(dat_at(&d, 0, "normal") / normal, 1, 1e-9);
  }
}

TESTS(nothing_is_told_of_plain_bodies, 2) {
  JOB j;
  int code = run_layers(&j, "10.", _i == 0 ? "*BOUNDARY\nLEFT, 1\n" : "");
  ck_assert_int_eq(code, 0);
  ck_assert_double_eq(told(&j), 0.0);
  ck_assert_double_gt(job_told(&j, "digits_left"), 11.0);
}

/* Heated in a cavity that it fills, held by supports or by the walls, a body
 * near incompressibility stays in place but for rounding, when it is cooled
 * too. */
TESTS(body_heated_in_its_cavity_is_right, 8) {
  static const char *const nu[] = {"0.49999", "0.4999999"};
  char walls[4 * 160] = "", *to = walls;
  static const char *const wall[][3] = {{"LEFT", "0., 0.", "1., 0."},
                                        {"RIGHT", "1., 1.", "-1., 0."},
                                        {"BOTTOM", "0., 0.", "0., 1."},
                                        {"TOP", "1., 1.", "0., -1."}};
  const double poisson = strtod(nu[_i / 2 % 2], NULL);
  JOB j;
  begin(&j, "rect 3 3 1 1", &as_it_is);
  for (int k = 0; k < 4; ++k)
    to += sprintf(to,
                  "*OBSTACLE, NAME=%s, TYPE=PLANE\n%s\n%s\n"
                  "*CONTACT, NAME=%s, GROUP=%s, OBSTACLE=%s\n",
                  wall[k][0], wall[k][1], wall[k][2], wall[k][0], wall[k][0],
                  wall[k][0]);
  job_write(
      &j, "pressed.inp",
      "*MESH, FILE=pressed.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1., %s\n"
      "*EXPANSION\n1E-5\n*INELASTIC, LAW=MAXWELL, TYPE=DEVIATORIC\n0.3\n"
      "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n%s"
      "*STEP\n*VISCO, INTEGRATOR=BACKWARD\n0.5, 1.\n%s"
      "*TEMPERATURE\nBODY, 100.\n*PRINT, ELEMENTS\n*END STEP\n"
      "*STEP\n*VISCO, INTEGRATOR=BACKWARD\n0.25, 1.\n"
      "*TEMPERATURE\nBODY, %s\n*END STEP\n",
      nu[_i / 2 % 2], _i % 2 == 0 ? "" : walls,
      _i % 2 == 0 ? "*BOUNDARY\nLEFT, 1\nRIGHT, 1\nBOTTOM, 2\nTOP, 2\n" : "",
      _i < 4 ? "0." : "1.E-9");
  CK_EXIT(job_run(&j, ""), 0, j);
  DAT t = job_table(&j, "ELEMENTS", 1);
  for (int k = 0; k < 18; ++k)
    ck_assert_double_eq_tol(dat_at(&t, k, "stress_yy") * (1 - 2 * poisson),
                            -1e-3, 1e-12);
}

/* A load straight onto a wall, in whose corner the body touches a roller askew:
 * the wall takes all of it, and nothing else is there but rounding, or what the
 * solver has left: a loose tolerance may leave strains that are wrong (exit 1),
 * but no rounding. */
TESTS(load_that_contact_takes_at_once_is_right, 16) {
  static const char *const method[] = {"AUTO",
                                       "SOR",
                                       "PROXIMAL",
                                       "LEMKE",
                                       "PROXIMAL, TOL=1E-8",
                                       "PROXIMAL, TOL=1E-6",
                                       "PROXIMAL, TOL=1E-4",
                                       "PCG, TOL=1E-2"};
  const double least =
      _i / 2 < 4 ? 1e-10 : strtod(strchr(method[_i / 2], '=') + 1, NULL);
  JOB j;
  begin(&j, _i % 2 == 0 ? "rect 4 4 1 1" : "rect 7 3 1 1", &as_it_is);
  job_write(&j, "pressed.inp",
            "*MESH, FILE=pressed.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=F, TYPE=CYLINDER, RADIUS=12.7\n0.6, -12.7\n"
            "*OBSTACLE, NAME=W, TYPE=CONFORMING\n"
            "*CONTACT, NAME=F, GROUP=BOTTOM, OBSTACLE=F, NORMAL=OBSTACLE\n"
            "*CONTACT, NAME=W, GROUP=RIGHT, OBSTACLE=W\n*STEP\n*STATIC\n"
            "*BOUNDARY\nTOP, 1, 2\n*DSLOAD\nRIGHT, TX, 0.1416543\n"
            "*SOLVER, METHOD=%s\n*PRINT, TOTALS, REACTIONS\n*END STEP\n",
            method[_i / 2]);
  int code = job_run(&j, "");
  const int loose = strstr(method[_i / 2], "TOL=1E-4") != NULL;
  ck_assert_msg(code == 0 || (loose && code == 1), "%s: exit %d: %s",
                method[_i / 2], code, j.errors);
  DAT t = job_table(&j, "TOTALS", -1), r = job_table(&j, "REACTIONS", -1);
  ck_assert_double_eq_tol(dat_at(&t, 1, "force_x") + dat_sum(&r, "reaction_x"),
                          -0.1416543, least);
  ck_assert_double_eq_tol(dat_at(&t, 0, "normal"), 0.0, least);
}

/* Loads at the nodes of a body that its supports lift, taken at once by the
 * friction of these nodes, which are open: each method leaves forces within its
 * tolerance, or their rounding, at all of them, and no strains else. */
TESTS(load_that_friction_of_open_nodes_takes_is_right, 6) {
  static const char *const methods[] = {"AUTO", "SOR", "AITKEN", "LAGRANGE",
                                        "PROXIMAL"};
  static const struct {
    const char *kind, *nu;
    double lift, load;
  } cases[] = {{"CPE3", "0.3", 0.01, 0.1},   {"CPE3", "0.499", 1., 0.1},
               {"CPE3", "0.499", 1e-4, 0.1}, {"CPE3", "0.499", 0.01, 0.1},
               {"CAX3", "0.499", 1e-4, 0.1}, {"CAX3", "0.499", 1e-4, 1e-3}};
  for (size_t k = 0; k < sizeof methods / sizeof *methods; ++k) {
    JOB j =
        job_with("lifted", "tests/regression/mesh/square.geo",
                 "*PARAMETER\nN = 3\n*MESH, FILE=square.geo\n"
                 "*MATERIAL, NAME=M\n*ELASTIC\n1E3, %s\n"
                 "*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=%s\n"
                 "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\n"
                 "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
                 "*FRICTION, CONTACT=C, LAW=TRESCA\n\"13.*x\"\n"
                 "*STEP\n*QUASISTATIC\n0.5, 1.\n*BOUNDARY\nLEFT, 1\nTOP, 1\n"
                 "TOP, 2, 2, %g\n*CLOAD\nBOTTOM, 1, %g\n*SOLVER, METHOD=%s\n"
                 "*PRINT, CONTACT\n*END STEP\n",
                 cases[_i].nu, cases[_i].kind, cases[_i].lift, cases[_i].load,
                 methods[k]);
    int code = job_run(&j, "--quiet");
    ck_assert_msg(code == 0, "%s: exit %d: %s", methods[k], code, j.errors);
    DAT c = job_table(&j, "CONTACT", -1);
    for (int i = 1; i < c.n_row; ++i)
      ck_assert_double_eq_tol(dat_at(&c, i, "f_t"), -cases[_i].load,
                              1e-8 * cases[_i].load + 1e-9);
  }
}

/* Contact and slight friction alone hold the body upright: pressed by p it is
 * wider by p nu (1 + nu)/E, soft to that for its bulk modulus. */
TEST(free_body_near_incompressibility_is_right) {
  static const double nu = 0.4999999;
  JOB j;
  begin(&j, "rect 4 4 1 1 alternate", &as_it_is);
  job_write(&j, "pressed.inp",
            "*MESH, FILE=pressed.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1., %.7f\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\n"
            "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
            "*FRICTION, CONTACT=C, LAW=COULOMB\n1.E-4\n*STEP\n*QUASISTATIC\n"
            "0.5, 1.\n*BOUNDARY\nLEFT, 1\n*DSLOAD\nTOP, P, 0.01\n"
            "*PRINT, CONTACT\n*END STEP\n",
            nu);
  CK_EXIT(job_run(&j, ""), 0, j);
  DAT c = job_table(&j, "CONTACT", -1);
  for (int i = 0; i < c.n_row; ++i)
    ck_assert_double_eq_tol(dat_at(&c, i, "u_t"),
                            0.01 * nu * (1 + nu) * dat_at(&c, i, "x"), 5e-6);
}

#define CORNER "TOP, 1, 2\nRIGHT, 1, 2\n*DSLOAD\nLEFT, P, 10.\n"
#define PRESSED "LEFT, 1\n*DSLOAD\nTOP, P, 10.\n"
#define NORTON "NORTON\n1.E-3, 1."
/* NORTON with n = 1: tau = 1/(3 G A) = 2 (1 + nu)/(3 E A). */
#define MAXWELL "MAXWELL, TYPE=DEVIATORIC\n0.99999333333333333"
#define BINGHAM "BINGHAM\n3., 1.E3"
#define LONG "BACKWARD\n1.E3, 1.E3"
#define LONGER "BACKWARD\n1.E6, 1.E6"

/* The force on the floor of a body near incompressibility that creeps. */
static double crept_force(const char *law, const char *visco,
                          const char *supports) {
  JOB j;
  begin(&j, "rect 4 4 1 1 alternate", &as_it_is);
  job_write(&j, "pressed.inp",
            "*MESH, FILE=pressed.msh\n*MATERIAL, NAME=M\n*ELASTIC\n"
            "1000., 0.49999\n*INELASTIC, LAW=%s\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\n"
            "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
            "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n*STEP\n"
            "*VISCO, INTEGRATOR=%s\n*BOUNDARY\n%s"
            "*PRINT, TOTALS\n*END STEP\n",
            law, visco, supports);
  const int code = job_run(&j, "");
  ck_assert_msg(code == 0, "%s, %s: exit %d: %s", law, visco, code, j.errors);
  return job_value(&j, "TOTALS", -1, "normal");
}

/* Far beyond the relaxation time, and where parts of the body rest. */
TESTS(creep_near_incompressibility_is_right, 4) {
  static const struct {
    const char *law[2], *visco[2], *supports;
    double tol;
  } cases[] = {{{NORTON, MAXWELL}, {LONG, LONG}, CORNER, 1e-6},
               {{NORTON, MAXWELL}, {LONGER, LONGER}, CORNER, 1e-6},
               {{NORTON, MAXWELL}, {LONG, LONG}, PRESSED, 1e-6},
               {{BINGHAM, BINGHAM},
                {"MIDPOINT\n0.1, 0.5", "HEUN\n0.1, 0.5"},
                CORNER,
                1e-2}};
  double force[2];
  for (int k = 0; k < 2; ++k)
    force[k] =
        crept_force(cases[_i].law[k], cases[_i].visco[k], cases[_i].supports);
  ck_assert_double_gt(force[1], 1.0);
  ck_assert_double_eq_tol(force[0], force[1], cases[_i].tol * force[1]);
}

UNIT_MAIN("rounding")
