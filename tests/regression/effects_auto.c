/*
 * *EFFECTS, MODE=AUTO: the answer is that of MODE=CALLED within TOL, with what
 * was left out and what was taken back.
 */
#include "support/block_file.h"
#include "support/job.h"
#include "support/unit.h"

const int job_without_fields = 1;

/* A block of one material, pressed with 50 MPa from above in a *VISCO step. */
typedef struct scene {
  const char *material; /* cards below *MATERIAL                              */
  const char *law;      /* of friction, with its data line                    */
  const char *loads;    /* cards of the step                                  */
  const char *effects;  /* the card *EFFECTS                                  */
  double nu;
  const char *dt; /* NULL: 0.25                                               */
} scene;

static const char *touching = "CONTACT"; /* group of the contact            */
static const char *held = "SYMMETRY, 1, 1";
static double height = 30.0;
static int two = 0; /* 1: the upper half is ELSET=UPPER                   */

static job try_scene(const scene *s, int *code) {
  job j = job_begin("block");
  block_file_write(&j, (int[]){8, 6}, (double[]){40.0, height}, two);
  job_write(&j, "block.inp",
            "*MESH, FILE=block.msh\n*MATERIAL, NAME=STEEL\n*ELASTIC\n"
            "130.D3, %.17g\n%s"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=STEEL, TYPE=CPE3\n"
            "*AMPLITUDE, NAME=ON\n0., 1., 1., 1.\n"
            "*OBSTACLE, NAME=FLOOR, TYPE=CONFORMING\n"
            "*CONTACT, NAME=FOOT, GROUP=%s, OBSTACLE=FLOOR\n%s%s"
            "*STEP\n*VISCO, INTEGRATOR=BACKWARD\n%s, 1.0\n"
            "*BOUNDARY\n%s\n*DSLOAD\nTOP, P, 50.\n%s"
            "*PRINT, CONTACT, TOTALS, ENERGY, FREQUENCY=0\n"
            "*OUTPUT, HDF5=NO\n*END STEP\n",
            s->nu, s->material, touching, s->law == NULL ? "" : s->law,
            s->effects, s->dt == NULL ? "0.25" : s->dt, held, s->loads);
  *code = job_run(&j, "");
  return j;
}

static job run_scene(const scene *s) {
  int code;
  job j = try_scene(s, &code);
  ck_assert_msg(code == 0, "exit %d: %s", code, j.errors);
  return j;
}

/* 1: left out, -1: taken back, 0: not tried. */
static int fate(const job *j, const char *effect) {
  char key[80], *text = job_file(j, "lst");
  int answer = 0;
  snprintf(key, sizeof key, "\n  left out: %s: ", effect);
  if (strstr(text, key) != NULL) answer = 1;
  snprintf(key, sizeof key, "\n  not left out: %s: ", effect);
  if (strstr(text, key) != NULL) answer = -1;
  free(text);
  return answer;
}

static double total_of(const job *j, const char *column) {
  return job_sum(j, "TOTALS", -1, column);
}

/* Pressures of the nodes, resultants and energy of both, in parts of their
 * scales; the largest difference. */
static double difference(const job *a, const job *b) {
  dat p = job_table(a, "CONTACT", -1), q = job_table(b, "CONTACT", -1);
  double scale = dat_max(&q, "pressure"), worst = 0.0;
  ck_assert_int_eq(p.n_row, q.n_row);
  for (int i = 0; i < p.n_row; ++i)
    worst = fmax(
        worst,
        fabs(dat_at(&p, i, "pressure") - dat_at(&q, i, "pressure")) / scale);
  dat_free(&p);
  dat_free(&q);
  double force = fabs(total_of(b, "normal"));
  worst =
      fmax(worst,
           fabs(total_of(a, "tangential") - total_of(b, "tangential")) / force);
  p = job_table(a, "ENERGY", -1);
  q = job_table(b, "ENERGY", -1);
  double energy = dat_at(&q, 0, "strain_energy");
  worst = fmax(worst, fabs(dat_at(&p, 0, "strain_energy") - energy) / energy);
  dat_free(&p);
  dat_free(&q);
  return worst;
}

/* Not even tried: the run is that of CALLED. */
static void stays(const scene *s, const char *effect) {
  scene automatic = *s;
  automatic.effects = "*EFFECTS, MODE=AUTO\n";
  JOB j = run_scene(&automatic);
  ck_assert_int_eq(fate(&j, effect), 0);
}

/* Both modes; what became of the effect, and that the answers agree. */
static void compare(const scene *s, const char *effect, int expected,
                    double tol) {
  scene called = *s, automatic = *s;
  called.effects = "";
  automatic.effects = "*EFFECTS, MODE=AUTO\n";
  JOB a = run_scene(&automatic), b = run_scene(&called);
  ck_assert_msg(fate(&a, effect) == expected, "%s, %s%s: %d", effect,
                s->material, s->loads, fate(&a, effect));
  ck_assert_int_eq(fate(&b, effect), 0);
  double found = difference(&a, &b);
  ck_assert_msg(found <= tol, "%s, %s%s: %g", effect, s->material, s->loads,
                found);
}

static const char coulomb[] = "*FRICTION, CONTACT=FOOT, LAW=COULOMB\n0.3\n";

/* The strain of 50 MPa is 3.8e-4: 1e-4 of it is 3.2e-3 K at 1.2e-5/K. */
TEST(small_thermal_strain_is_left_out) {
  const scene small = {"*EXPANSION\n1.2D-5\n",
                       coulomb,
                       "*TEMPERATURE\nBODY, 1.D-4\n",
                       "",
                       0.2,
                       NULL};
  scene above = small, large = small, beside = small;
  above.loads = "*TEMPERATURE\nBODY, 2.5D-3\n";
  large.loads = "*TEMPERATURE\nBODY, 1.D-2\n"; /* along x alone */
  large.material = "*EXPANSION, TYPE=ORTHO\n1.2D-5, 0., 0.\n";
  compare(&small, "thermal strain", 1, 1e-3);
  compare(&above, "thermal strain", -1, 1e-12);
  stays(&large, "thermal strain");
  /* Heat is taken back, the law is not. */
  beside.material = "*EXPANSION\n1.2D-5\n*INELASTIC, LAW=MAXWELL\n1.D6\n";
  beside.loads = above.loads;
  compare(&beside, "inelastic strain", 1, 1e-5);
}

/* A support that moves the top by 0.5 strains the block, 40 long and 30 high,
 * by 0.5/40; heat by 1.2e-9. */
TEST(strain_of_a_moved_support_is_over_the_size) {
  const scene s = {"*EXPANSION\n1.2D-5\n",
                   coulomb,
                   "*BOUNDARY\nTOP, 2, 2, -0.5\n*TEMPERATURE\nBODY, 1.D-4\n",
                   "*EFFECTS, MODE=AUTO\n",
                   0.2,
                   NULL};
  JOB j = run_scene(&s);
  char *text = job_file(&j, "lst"), *at = strstr(text, "left out: thermal");
  ck_assert_ptr_nonnull(at);
  ck_assert_ptr_nonnull(at = strstr(at, "at most "));
  ck_assert_double_eq_tol(strtod(at + 8, NULL), 9.6e-8, 1e-15);
  free(text);
}

/* Without lateral contraction heat alone makes the block rub: little beside
 * the pressure, all of the friction. */
TEST(heat_that_makes_all_friction_stays) {
  const scene s = {"*EXPANSION\n1.2D-5\n",
                   "*FRICTION, CONTACT=FOOT, LAW=TRESCA\n15.\n",
                   "*TEMPERATURE\nBODY, 1.D-4\n",
                   "",
                   0.0,
                   NULL};
  compare(&s, "thermal strain", -1, 1e-12);
}

TEST(slow_relaxation_is_left_out) {
  const scene slow = {
      "*INELASTIC, LAW=MAXWELL\n1.D6\n", coulomb, "", "", 0.2, NULL};
  scene fast = slow;
  fast.material = "*INELASTIC, LAW=MAXWELL\n1.D2\n";
  compare(&slow, "inelastic strain", 1, 1e-3);
  stays(&fast, "inelastic strain");
  /* What has crept before stays with its law. */
  scene crept = slow;
  crept.law = "*INITIAL CONDITIONS, TYPE=INELASTIC STRAIN\nBODY, 1, 1.E-6\n";
  stays(&crept, "inelastic strain");
}

#define NEXT "*END STEP\n*STEP\n"

/* A ramp of 1 s in four increments: strain lags behind by the creep of the
 * last 0.1 ms of 0.25 s. In the place of the law E E1/(E + E1). */
TEST(law_at_its_end_is_left_out) {
  const scene fast = {"*INELASTIC, LAW=ZENER\n65.D3, 0.65\n",
                      coulomb,
                      "LEFT, P, 20.\n",
                      "",
                      0.2,
                      NULL};
  scene series = fast, sudden = fast, slow = fast, fluid = fast;
  scene just = fast, beyond = fast; /* tried up to 2.5e-5 of time */
  scene at_once = fast, middle = fast;
  just.material = "*INELASTIC, LAW=ZENER\n65.D3, 1.6\n";
  beyond.material = "*INELASTIC, LAW=ZENER\n65.D3, 1.65\n";
  beyond.loads = "LEFT, P, 20.\n" NEXT "*VISCO, INTEGRATOR=BACKWARD\n1., 1.\n";
  at_once.loads = "LEFT, P, 20.\n" NEXT "*QUASISTATIC\n0.5, 1.\n";
  middle.loads = "LEFT, P, 20.\n" NEXT "*VISCO, INTEGRATOR=MIDPOINT\n0.5, 1.\n";
  series.material = "*INELASTIC, LAW=PRONY\n0.3, 0.2, 1.D-6\n0.4, 0., 1.D-9\n";
  sudden.loads =
      "LEFT, P, 20.\n*TEMPERATURE\nBODY, 0.\n*DSLOAD, AMPLITUDE=ON\n"
      "LEFT, TY, -1.\n";
  slow.material = "*INELASTIC, LAW=ZENER\n65.D3, 65.\n";
  fluid.material = "*INELASTIC, LAW=MAXWELL\n1.D-6\n";
  compare(&fast, "inelastic strain", 1, 1e-3);
  compare(&series, "inelastic strain", 1, 1e-3);
  compare(&just, "inelastic strain", -1, 1e-12);
  stays(&beyond, "inelastic strain");
  stays(&at_once, "inelastic strain");
  stays(&middle, "inelastic strain");
  compare(&sudden, "inelastic strain", -1, 1e-12);
  stays(&slow, "inelastic strain");
  stays(&fluid, "inelastic strain");
}

/* Sheared along its side, the block passes a threshold that the loads do not.
 */
TEST(law_below_its_threshold_is_left_out) {
  const scene below = {
      "*INELASTIC, LAW=BINGHAM\n200., 1.D3\n", coulomb, "", "", 0.2, NULL};
  scene corner = below;
  corner.material = "*INELASTIC, LAW=BINGHAM\n60., 1.D3\n";
  corner.loads = "LEFT, TY, 49.\n";
  compare(&below, "inelastic strain", 1, 1e-12);
  compare(&corner, "inelastic strain", -1, 1e-12);
}

/* Flow near a corner only: the law is left out elsewhere, and all is the same,
 * also below an elastic material. */
TEST(elements_below_the_threshold_are_left_out) {
  const scene corner = {"*INELASTIC, LAW=BINGHAM\n100., 1.D5\n",
                        coulomb,
                        "LEFT, TY, -120.\n",
                        "",
                        0.2,
                        "0.02"};
  scene everywhere = corner, lower = corner;
  everywhere.material = "*INELASTIC, LAW=BINGHAM\n20., 1.D5\n";
  lower.material =
      "*INELASTIC, LAW=BINGHAM\n100., 1.D5\n"
      "*MATERIAL, NAME=LEAD\n*ELASTIC\n130.D3, 0.2\n"
      "*SOLID SECTION, ELSET=UPPER, MATERIAL=LEAD, TYPE=CPE3\n";
  compare(&corner, "inelastic strain", 1, 1e-8);
  stays(&everywhere, "inelastic strain");
  two = 1;
  compare(&lower, "inelastic strain", 1, 1e-8);
}

/* Nodes are 5 apart, those of the side of a high block 10. */
TEST(average_within_an_element_is_local) {
  const scene within = {
      "",
      "*FRICTION, CONTACT=FOOT, LAW=NONLOCAL, RADIUS=4.9\n0.3\n",
      "LEFT, P, 20.\n",
      "",
      0.2,
      NULL};
  scene beyond = within;
  beyond.law = "*FRICTION, CONTACT=FOOT, LAW=NONLOCAL, RADIUS=5.1\n0.3\n";
  compare(&within, "nonlocal average", 1, 1e-12);
  stays(&beyond, "nonlocal average");
  scene side = within;
  side.law = "*FRICTION, CONTACT=FOOT, LAW=NONLOCAL, RADIUS=9.9\n0.3\n";
  side.loads = "*BOUNDARY\nCONTACT, 2\n";
  touching = "LEFT";
  height = 60.0;
  compare(&side, "nonlocal average", 1, 1e-12);
}

/* Without lateral expansion nothing slips, unless it is pushed. */
TEST(friction_without_slip_is_left_out) {
  const scene still = {"", coulomb, "", "", 0.0, NULL};
  scene pushed = still, expands = still;
  pushed.loads = "LEFT, P, 20.\n";
  expands.nu = 0.2;
  /* tried for a sum of mu over the increments of up to 4e-8 */
  scene small = expands, twice = expands;
  small.law = "*FRICTION, CONTACT=FOOT, LAW=COULOMB\n0.9E-8\n";
  twice.law = "*FRICTION, CONTACT=FOOT, LAW=COULOMB\n1.1E-8\n";
  compare(&still, "friction", 1, 1e-12);
  compare(&pushed, "friction", -1, 1e-12);
  stays(&expands, "friction");
  compare(&small, "friction", -1, 1e-12);
  stays(&twice, "friction");
  small.loads = "*END STEP\n*STEP\n*QUASISTATIC\n1., 1.\n"; /* five of them */
  stays(&small, "friction");
  pushed.loads =
      "*END STEP\n*STEP\n*QUASISTATIC\n1., 1.\n*FRICTION, "
      "CONTACT=FOOT, LAW=COULOMB\n0.2\n*DSLOAD\nLEFT, P, 20.\n";
  compare(&pushed, "friction", -1, 1e-12);
  held = "TOP, 2, 2, -0.01"; /* sideways by friction alone */
  stays(&still, "friction");
}

/* The increment in which a body responds at once to what flows then ends no
 * step: FREQUENCY=0 has one table. */
TEST(response_at_once_ends_no_step) {
  const scene s = {"*INELASTIC, LAW=MAXWELL\n4.\n",
                   coulomb,
                   "LEFT, P, 5., ON\n",
                   "",
                   0.2,
                   NULL};
  JOB j = run_scene(&s);
  FREED char *text = job_file(&j, "dat");
  const char *first = strstr(text, "increment 5 time 1.0000000000000000E+000 ");
  ck_assert_msg(first != NULL, "%.300s", text);
  ck_assert_ptr_eq(strstr(text, "table ENERGY"), strstr(first, "table ENERGY"));
}

TEST(nothing_is_left_out_unless_asked) {
  const scene s = {
      "*EXPANSION\n1.2D-5\n",    coulomb, "*TEMPERATURE\nBODY, 1.D-6\n",
      "*EFFECTS, MODE=CALLED\n", 0.2,     NULL};
  JOB j = run_scene(&s);
  ck_assert_int_eq(fate(&j, "thermal strain"), 0);
}

/* Two equal increments without friction, f and u in the end: its bound is twice
 * the roots of the work on the slip, sqrt(W/4) + sqrt(W/2) for W the sum of
 * mu f |u|, over the root of twice the strain energy. */
static void bound_is_that_of_the_work(const job *j, double mu) {
  DAT c = job_table(j, "CONTACT", -1), e = job_table(j, "ENERGY", -1);
  const int plane = dat_has(&c, "u_t");
  double work = 0.0;
  for (int i = 0; i < c.n_row; ++i) {
    double slip = dat_at(&c, i, plane ? "u_t" : "u_t1");
    if (!plane) slip = hypot(slip, dat_at(&c, i, "u_t2"));
    work += mu * dat_at(&c, i, "f_n") * fabs(slip);
  }
  work /= 2.0 * dat_at(&e, 0, "strain_energy");
  ck_assert_int_eq(fate(j, "friction"), 1);
  ck_assert_double_eq_tol(
      job_told(j, "bound") / (2.0 * (0.5 + sqrt(0.5)) * sqrt(work)), 1, 1e-6);
}

TEST(bound_of_friction_is_that_of_the_work_at_its_nodes) {
  const scene s = {"",
                   "*FRICTION, CONTACT=FOOT, LAW=COULOMB\n1.D-8\n",
                   "LEFT, P, 20.\n",
                   "*EFFECTS, MODE=AUTO, TOL=0.01\n",
                   0.2,
                   "0.5"};
  JOB j = run_scene(&s);
  bound_is_that_of_the_work(&j, 1e-8);
}

/* Messages of trials are not those of the run: once each, and its exit code. */
static void is_free(const scene *s) {
  int code;
  JOB j = try_scene(s, &code);
  ck_assert_msg(code == 6, "exit %d: %s", code, j.errors);
  ck_assert_ptr_nonnull(strstr(j.errors, "\n1 error"));
}

TEST(body_that_is_free_to_move_ends_all_trials) {
  const scene small = {
      "*EXPANSION\n1.2D-5\n",  "",  "*TEMPERATURE\nBODY, 1.D-4\n",
      "*EFFECTS, MODE=AUTO\n", 0.2, NULL};
  scene threshold = small;
  threshold.material = "*INELASTIC, LAW=BINGHAM\n20., 1.D5\n";
  threshold.loads = "";
  threshold.dt = "0.02";
  held = "TOP, 2, 2, -0.01";
  is_free(&small);
  is_free(&threshold);
}

static job run_cube(const char *effects) {
  job j =
      job_with("cube", "tests/regression/mesh/cube.geo",
               "*MESH, FILE=cube.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
               "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
               "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
               "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
               "*FRICTION, CONTACT=C, LAW=COULOMB\n1.D-8\n"
               "%s*AMPLITUDE, NAME=ON\n"
               "0., 0., 1., 1.\n*STEP\n*QUASISTATIC\n0.5, 1.\n*BOUNDARY\n"
               "TOP, 1, 1, 1.D-3, ON\nTOP, 2, 2, 5.D-3, ON\n"
               "TOP, 3, 3, -0.01, ON\n*PRINT, CONTACT, ENERGY, FREQUENCY=0\n"
               "*END STEP\n",
               effects);
  CK_EXIT(job_run(&j, ""), 0, j);
  return j;
}

/* The same in space, of slip along both directions of the contact. The change
 * is that of the nodes that slip, over the largest motion, 0.01. */
TEST(bound_of_friction_is_that_of_the_work_in_space) {
  static const char *const columns[] = {"u_t1", "u_t2"};
  JOB j = run_cube("*EFFECTS, MODE=AUTO, TOL=0.01\n"), called = run_cube("");
  DAT without = job_table(&j, "CONTACT", -1),
      with = job_table(&called, "CONTACT", -1);
  double most = 0;
  bound_is_that_of_the_work(&j, 1e-8);
  for (int i = 0; i < with.n_row; ++i)
    for (int k = 0; k < 2; ++k)
      most = fmax(most, fabs(dat_at(&with, i, columns[k]) -
                             dat_at(&without, i, columns[k])));
  ck_assert_double_eq_tol(job_told(&j, "change") / (most / 0.01), 1, 0.01);
}

/* Strips pressed down by 0.01, some of them warm. */
typedef struct strips {
  double nu, shear;
  const char *friction, *warm; /* card with its line; group, temperature */
} strips;

static job run_strips(const strips *s, int automatic) {
  job j = job_with(
      "strips", "tests/regression/mesh/strips.geo",
      "*PARAMETER\nN = 5\n*MESH, FILE=strips.geo\n*MATERIAL, NAME=M\n"
      "*ELASTIC\n1000., %.17g\n*EXPANSION\n1.2E-5\n"
      "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
      "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
      "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n%s%s*STEP\n*STATIC\n"
      "*BOUNDARY\nTOP, 1, 1, %.17g\nTOP, 2, 2, -0.01\n*TEMPERATURE\n"
      "%s\n*PRINT, CONTACT\n*END STEP\n",
      s->nu, s->friction, automatic ? "*EFFECTS, MODE=AUTO\n" : "", s->shear,
      s->warm);
  CK_EXIT(job_run(&j, ""), 0, j);
  return j;
}

/* The middle strip of five gets warm: the change is that of the forces of its
 * nodes over the largest force, the others keep theirs. */
TEST(change_is_that_of_the_nodes_it_changes_most) {
  const strips s = {0, 0, "", "MIDDLE, 0.05"};
  JOB a = run_strips(&s, 0), b = run_strips(&s, 1);
  DAT with = job_table(&a, "CONTACT", -1),
      without = job_table(&b, "CONTACT", -1);
  double largest = 0, most = 0;
  for (int i = 0; i < without.n_row; ++i) {
    most =
        fmax(most, fabs(dat_at(&with, i, "f_n") - dat_at(&without, i, "f_n")));
    largest = fmax(largest, dat_at(&without, i, "f_n"));
  }
  ck_assert_double_gt(most, 0);
  ck_assert_double_eq_tol(job_told(&b, "change") / (most / largest), 1, 1e-3);
  /* E alpha T over the pressure, E u */
  ck_assert_double_eq_tol(job_told(&b, "stress") / (1.2e-5 * 0.05 / 0.01), 1,
                          1e-6);
}

/* Friction of both halves is opposite: its sum, of a slight shear, changes by
 * more than the friction of any node. */
TEST(change_is_that_of_the_sum_of_friction) {
  const strips s = {0.3, 1e-4, "*FRICTION, CONTACT=C, LAW=COULOMB\n0.9\n",
                    "LAST, 0.005"};
  JOB a = run_strips(&s, 0), b = run_strips(&s, 1);
  DAT with = job_table(&a, "CONTACT", -1),
      without = job_table(&b, "CONTACT", -1);
  const double sum = dat_sum(&without, "f_t");
  const double change = fabs(dat_sum(&with, "f_t") - sum) / fabs(sum);
  ck_assert_double_gt(change, 1e-5);
  ck_assert_double_eq_tol(job_told(&b, "change") / change, 1, 1e-3);
}

static double uniform(unsigned *seed) {
  *seed = *seed * 1664525u + 1013904223u;
  return (double)(*seed >> 8) / 16777216.0;
}

/* Whatever is left out, the answer is that of CALLED within TOL. */
TEST(random_scenes_agree) {
  unsigned seed = 7;
  for (int k = 0; k < 3; ++k) {
    char material[200];
    double nu = uniform(&seed) < 0.3 ? 0.0 : 0.4 * uniform(&seed);
    snprintf(material, sizeof material,
             "*EXPANSION\n1.2D-5\n*INELASTIC, LAW=%s\n",
             uniform(&seed) < 0.5 ? "MAXWELL" : "NORTON");
    size_t used = strlen(material);
    double rate = pow(10.0, 3.0 + 5.0 * uniform(&seed));
    if (strstr(material, "MAXWELL") != NULL)
      snprintf(material + used, sizeof material - used, "%.6e\n", rate);
    else
      snprintf(material + used, sizeof material - used, "%.6e, 3.\n",
               3.8e-4 / rate / 125e3);
    PRINTED(law, "*FRICTION, CONTACT=FOOT, LAW=COULOMB\n%.6e\n",
            pow(10.0, -8.0 + 8.0 * uniform(&seed)));
    PRINTED(loads, "LEFT, P, %.6f\n*TEMPERATURE\nBODY, %.6e\n",
            20.0 * uniform(&seed), pow(10.0, -6.0 + 5.0 * uniform(&seed)));
    const scene s = {material, law, loads, "", nu, NULL};
    scene automatic = s;
    automatic.effects = "*EFFECTS, MODE=AUTO, TOL=1e-3\n";
    JOB a = run_scene(&automatic), b = run_scene(&s);
    double found = difference(&a, &b);
    ck_assert_msg(found <= 1e-3, "scene %d: %g", k, found);
  }
}

UNIT_MAIN("effects_auto")
