/*
 * *EFFECTS, MODE=AUTO against MODE=CALLED on random scenes: where AUTO ends
 * with exit code 0, displacements, pressures, friction forces and the strain
 * energy of every increment are those of CALLED within TOL of their largest.
 * Effects are drawn near the size that matters: loads that rise, fall, vanish
 * and change sign, heat in one increment in the middle, moving obstacles, mu
 * that changes in time and from step to step, increments that are cut, slender
 * and round blocks, laws with terms of very different times.
 *
 * EFFECTS_SCENES=n,first: how many, from which on.
 */
#include "support/block_file.h"
#include "support/job.h"
#include "support/unit.h"

enum { ROOM = 6000 };

typedef struct scene {
  unsigned seed;
  char text[2][ROOM]; /* before and after *EFFECTS                            */
  int used[2], part;
  int round;     /* 1: axisymmetric                                           */
  double radius; /* of friction averages, length                              */
  double tol;
} scene;

static double uniform(scene *s) {
  s->seed = s->seed * 1664525u + 1013904223u;
  return (double)(s->seed >> 8) / 16777216.0;
}

static int pick(scene *s, int n) { return (int)(uniform(s) * n); }

static double power(scene *s, double from, double to) {
  return pow(10.0, from + (to - from) * uniform(s));
}

static void add(scene *s, const char *format, ...)
    __attribute__((format(printf, 2, 3)));
static void add(scene *s, const char *format, ...) {
  va_list list;
  int *used = &s->used[s->part];
  va_start(list, format);
  *used +=
      vsnprintf(s->text[s->part] + *used, (size_t)(ROOM - *used), format, list);
  va_end(list);
  ck_assert_int_lt(*used, ROOM);
}

/* ---- cards: E = 1e5, load 50, a step lasts 1 ------------------------------
 */

static void add_amplitudes(scene *s) {
  static const char *const course[] = {"0, 0, 0.5, 1, 1, 0.1",
                                       "0, 0, 0.25, 1, 0.75, 1e-3, 1, 0",
                                       "0, 0, 0.4, 0, 0.5, 1, 0.6, 0, 1, 0",
                                       "0, 1, 1, 0.3",
                                       "\"1.05 + sin(2*pi*t)\"",
                                       "\"1.05 + sin(6*pi*t)\"",
                                       "0, 0, 0.5, 1, 1, -1",
                                       "0, 0, 0.05, 1, 0.1, 0, 1, 0",
                                       "0, 1, 1, 1e-6",
                                       "0, 1, 1, 1"};
  for (int k = 0; k < 3; ++k)
    add(s, "*AMPLITUDE, NAME=A%d\n%s\n", k, course[pick(s, 10)]);
  add(s, "*AMPLITUDE, NAME=WEAR, TIME=TOTAL TIME\n0, 1, 0.5, 0.2, 2, 1\n");
}

/* Terms of times from far below the increment to far beyond the step. */
static void add_spectrum(scene *s, double dt) {
  const int n = 2 + pick(s, 3);
  add(s, "*INELASTIC, LAW=PRONY\n");
  for (int k = 0; k < n; ++k)
    add(s, "%g, %g, %g\n", 0.9 / n * uniform(s), 0.9 / n * uniform(s),
        dt * power(s, -8, 8));
}

/* Units of one time or of two decades around it. */
static void add_units(scene *s, double tau) {
  const int n = 1 + pick(s, 3);
  add(s, "*INELASTIC, LAW=KELVIN\n");
  for (int k = 0; k < n; ++k) {
    const double E = 1e5 * power(s, -1, 2);
    add(s, "%g, %g\n", E, E * tau * power(s, -2, 0));
  }
}

/* Fast laws need integrators that damp: 1 if this is one. */
static int add_law(scene *s, double dt) {
  const int fast = pick(s, 3) == 0;
  const double tau = fast ? dt * power(s, -8, -3) : power(s, 0, 8);
  const double E1 = 1e5 * power(s, -1, 2), strain = 5e-4 / tau;
  switch (pick(s, fast ? 4 : 12)) {
    case 0:
      add(s, "*INELASTIC, LAW=ZENER\n%g, %g\n", E1, E1 * tau);
      break;
    case 1:
      add(s, "*INELASTIC, LAW=PRONY\n%g, %g, %g\n%g, 0., %g\n",
          0.5 * uniform(s), 0.5 * uniform(s), tau, 0.4 * uniform(s),
          tau * power(s, -2, 0));
      break;
    case 2:
      add_units(s, tau);
      break;
    case 3:
      add_spectrum(s, dt);
      return 1;
    case 4:
      add(s, "*INELASTIC, LAW=MAXWELL\n%g\n", tau);
      break;
    case 5:
      add(s, "*INELASTIC, LAW=MAXWELL, TYPE=DEVIATORIC\n%g\n", tau);
      break;
    case 6:
      add(s, "*INELASTIC, LAW=NORTON\n%g, 5.\n", strain / pow(50.0, 5.0));
      break;
    case 7:
      add(s, "*INELASTIC, LAW=HYPERBOLIC\n%g, 0.02, 3.\n", strain);
      break;
    case 8:
      add(s, "*INELASTIC, LAW=BINGHAM\n%g, %g\n", 50.0 * power(s, -0.3, 1),
          1e5 * tau);
      break;
    case 9:
      add(s, "*INELASTIC, LAW=BURGERS\n%g, %g, %g\n", 1e5 * tau, E1,
          E1 * tau * power(s, -3, 3));
      break;
    case 10:
      add(s, "*INELASTIC, LAW=PERZYNA\n%g, %g, 1e4, 1.5\n",
          50.0 * power(s, -0.3, 1), 1e4 * power(s, -1, 3));
      break;
    default:
      add(s, "*INELASTIC, LAW=CHABOCHE\n%g, %g, 3., -10., 10.\n1e4, 100.\n",
          50.0 * power(s, -0.3, 1), 100.0 * power(s, 0, 3));
  }
  return fast;
}

/* A law of friction or none. */
static void add_friction(scene *s) {
  const double mu = pick(s, 2) ? 0.1 + 0.7 * uniform(s) : power(s, -9, -2);
  switch (pick(s, 5)) {
    case 0:
      break;
    case 1:
      add(s, "*FRICTION, CONTACT=FOOT, LAW=NONLOCAL, RADIUS=%g\n%g\n",
          s->radius, mu);
      break;
    case 2:
      add(s, "*FRICTION, CONTACT=FOOT, LAW=TRESCA\n%g\n", 50.0 * mu);
      break;
    case 3:
      add(s, "*FRICTION, CONTACT=FOOT, LAW=COULOMB, AMPLITUDE=WEAR\n%g\n", mu);
      break;
    default:
      add(s, "*FRICTION, CONTACT=FOOT, LAW=COULOMB\n%g\n", mu);
  }
}

static void add_contact(scene *s) {
  if (pick(s, 4) == 0)
    add(s,
        "*OBSTACLE, NAME=FLOOR, TYPE=PLANE, AMPLITUDE=A0\n0., 0.\n0., 1.\n"
        "MOVE, 0., %g\n",
        0.02 * power(s, -3, 0));
  else
    add(s, "*OBSTACLE, NAME=FLOOR, TYPE=CONFORMING\n");
  add(s, "*CONTACT, NAME=FOOT, GROUP=CONTACT, OBSTACLE=FLOOR\n");
  add_friction(s);
}

static void add_loads(scene *s) {
  static const char *const after[] = {"", ", AMPLITUDE=A1"};
  add(s, "*DSLOAD%s\nTOP, P, 50.\n", after[pick(s, 2)]);
  if (pick(s, 2))
    add(s, "%s, P, %g\n", s->round ? "SYMMETRY" : "LEFT",
        50.0 * power(s, -6, 0));
  add(s, "*TEMPERATURE%s\nBODY, %g\n", pick(s, 2) ? ", AMPLITUDE=A2" : "",
      40.0 * power(s, -7, -2));
}

static void add_step(scene *s, int first, int fast, double dt) {
  static const char *const slow[] = {"BACKWARD", "MIDPOINT",
                                     "HEUN, SUBSTEPS=AUTO"};
  static const char *const damped[] = {"BACKWARD", "EXPONENTIAL"};
  const double least = pick(s, 3) ? dt : dt / 8.0;
  add(s, "*STEP\n");
  if (!fast && pick(s, 4) == 0)
    add(s, "*QUASISTATIC\n%g, 1., %g, %g\n", dt, least, dt);
  else
    add(s, "*VISCO, INTEGRATOR=%s\n%g, 1., %g, %g\n",
        fast ? damped[pick(s, 2)] : slow[pick(s, 3)], dt, least, dt);
  if (first) add(s, "*BOUNDARY\n%s, 1, 1\n", s->round ? "LEFT" : "SYMMETRY");
  if (!first && pick(s, 3) == 0) add_friction(s);
  if (first || pick(s, 2)) add_loads(s);
  add(s,
      "*PRINT, CONTACT, TOTALS, NODES, ELEMENTS, ENERGY\n*OUTPUT, HDF5=NO\n"
      "*SOLVER, TOL=1e-12\n*END STEP\n");
}

static void make_scene(scene *s, unsigned number, const job *j) {
  static const double shape[][2] = {{40, 30}, {40, 4}, {10, 40}, {40, 40}};
  static const int increments[] = {1, 2, 5, 40};
  static const char *const kind[] = {"CPE3", "CPS3", "CAX3"};
  *s = (scene){.seed = 2654435761u * (number + 1u)};
  for (int k = 0; k < 8; ++k) uniform(s);
  const double *size = shape[pick(s, 4)], dt = 1.0 / increments[pick(s, 4)];
  const double nu = pick(s, 3) ? 0.45 * uniform(s) : 0.0;
  block_file_write(j, (int[]){8, 4}, size, 0);
  s->tol = pick(s, 3) ? 1e-3 : 1e-2;
  add(s, "*MESH, FILE=block.msh\n");
  add_amplitudes(s);
  add(s, "*MATERIAL, NAME=M\n*ELASTIC\n1e5, %g\n*EXPANSION\n1.2e-5\n", nu);
  const int fast = pick(s, 3) > 0 && add_law(s, dt);
  const int type = pick(s, 3);
  s->round = type == 2;
  s->radius = size[0] / 8.0 * (0.5 + uniform(s));
  add(s, "*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=%s\n", kind[type]);
  add_contact(s);
  s->part = 1;
  const int n = 1 + pick(s, 3);
  for (int k = 0; k < n; ++k) add_step(s, k == 0, fast, dt);
}

/* ---- both runs ------------------------------------------------------------
 */

/* Largest magnitude of a column of the table, of its change. */
typedef struct span {
  double largest, change;
} span;

static span compare(const dat *a, const dat *b, const char *name) {
  span s = {0.0, 0.0};
  for (int i = 0; dat_has(b, name) && i < b->n_row; ++i) {
    const double now = dat_at(b, i, name);
    const double other = dat_has(a, name) ? dat_at(a, i, name) : 0.0;
    s.largest = fmax(s.largest, fabs(now));
    s.change = fmax(s.change, fabs(other - now));
  }
  return s;
}

/* A quantity of the tables over that of the scale, the larger of both; what is
 * not above "rounding" is none. */
typedef struct quantity_row {
  const char *table, *name, *scale;
  double rounding;
} quantity_row;
static const quantity_row quantities[] = {
    {"NODES", "u_x", "u_y", 1e-14},
    {"NODES", "u_y", "u_x", 1e-14},
    {"NODES", "u_r", "u_z", 1e-14},
    {"NODES", "u_z", "u_r", 1e-14},
    {"ELEMENTS", "stress_xx", "mises", 1e-10},
    {"ELEMENTS", "stress_yy", "mises", 1e-10},
    {"ELEMENTS", "stress_xy", "mises", 1e-10},
    {"ELEMENTS", "stress_rr", "mises", 1e-10},
    {"ELEMENTS", "stress_zz", "mises", 1e-10},
    {"ELEMENTS", "stress_rz", "mises", 1e-10},
    {"ELEMENTS", "stress_tt", "mises", 1e-10},
    {"CONTACT", "pressure", NULL, 1e-10},
    {"CONTACT", "traction_t", "pressure", 1e-10},
    {"TOTALS", "normal", NULL, 1e-9},
    {"TOTALS", "tangential", "normal", 1e-9},
    {"ENERGY", "strain_energy", NULL, 1e-12},
};

/* Blocks of a table: times it was printed. */
static int count_blocks(const job *j, const char *table) {
  char *text = job_file(j, "dat"), key[40];
  int n = 0;
  snprintf(key, sizeof key, " table %s\n", table);
  for (const char *at = text; at != NULL && (at = strstr(at, key)) != NULL;
       ++at)
    ++n;
  free(text);
  return n;
}

static double difference(const job *a, const job *b) {
  double worst = 0.0;
  const int n = count_blocks(b, "ENERGY");
  ck_assert_msg(count_blocks(a, "ENERGY") == n, "%s and %s: other increments",
                a->dir, b->dir);
  for (size_t q = 0; q < sizeof quantities / sizeof *quantities; ++q)
    for (int k = 0; k < n; ++k) {
      const quantity_row *row = &quantities[q];
      DAT p = job_table(a, row->table, k), r = job_table(b, row->table, k);
      span own = compare(&p, &r, row->name);
      double scale = own.largest;
      if (row->scale != NULL)
        scale = fmax(scale, compare(&r, &r, row->scale).largest);
      if (own.change > row->rounding) worst = fmax(worst, own.change / scale);
    }
  return worst;
}

static int run(job *j, const scene *s, const char *mode) {
  job_write(j, "block.inp", "%s*EFFECTS, MODE=%s, TOL=%g\n%s", s->text[0], mode,
            s->tol, s->text[1]);
  return job_run(j, "");
}

/* Rows "left out" of the listing. */
static int left_out(const job *j) {
  FREED char *text = job_file(j, "lst");
  int n = 0;
  for (const char *at = text;
       at != NULL && (at = strstr(at, "\n  left out: ")) != NULL; ++at)
    ++n;
  return n;
}

/* How many rows AUTO leaves out. */
static int check_scene(unsigned number) {
  static scene s;
  JOB a = job_begin("block"), b = job_begin("block");
  int n = 0;
  make_scene(&s, number, &a);
  make_scene(&s, number, &b);
  const int code = run(&a, &s, "AUTO"), called = run(&b, &s, "CALLED");
  ck_assert_msg(code == called, "scene %u: exit %d, not %d\n%s", number, code,
                called, a.errors);
  if (code == 0) {
    n = left_out(&a);
    const double found = difference(&a, &b);
    ck_assert_msg(found <= s.tol, "scene %u: %g", number, found);
  }
  return n;
}

TESTS(answers_are_those_of_all_effects, 1) {
  const char *text = getenv("EFFECTS_SCENES");
  unsigned count = 300, first = 0;
  int rows = 0, scenes = 0;
  if (text != NULL) sscanf(text, "%u,%u", &count, &first);
  for (unsigned k = first; k < first + count; ++k) {
    const int n = check_scene(k);
    rows += n;
    scenes += n > 0;
  }
  printf("effects left out: %d in %d of %u scenes\n", rows, scenes, count);
  ck_assert_int_gt(scenes, 0);
}

UNIT_MAIN_FOR("effects_auto", 10 * UNIT_SECONDS)
