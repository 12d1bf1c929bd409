/*
 * Runs that are stopped by SIGINT or SIGTERM and gone on with, against the run
 * that was not stopped: all files equal, byte by byte. Every method, every
 * integrator, every kind of effect that has a memory, at small and large
 * friction. The stops are counted in changes of files, so that nothing depends
 * on time.
 */
#include "material/scheme/scheme.h"
#include "support/kept_mesh.h"
#include "support/points.h"
#include "support/small_job.h"
#include "support/solver_rows.h"
#include "support/traced.h"
#include "support/unit.h"

#include <ctype.h>
#include <signal.h>

static const char *const nothing[] = {NULL, NULL};
static const char *const again[] = {"--restart", NULL};

static int stop(job *j, int at, int signal_no) {
  traced t = {.action = TRACE_SIGNAL, .at = at, .number = signal_no};
  return traced_run(j, nothing, &t);
}

/* NULL, or what is wrong with a run that was stopped and went on. A signal
 * during the last increment comes too late: the run ends as it would. While
 * the lock is taken it is not yet caught. */
static const char *fault(const job *whole, job *j, int code, int signal_no,
                         int stopped) {
  int early = stopped == 1000 + signal_no && !job_has(j, "sta");
  if (stopped != 128 + signal_no && !early)
    return stopped == code ? NULL : "stop: exit code";
  if (traced_run(j, again, NULL) != code) return "restart: exit code";
  return traced_difference(whole, j) == NULL ? NULL : "restart: other files";
}

/* Stops of a job, spread over its changes of files; frees both. Two equal jobs,
 * one of which is not stopped. The answer: 0, the deck is not for this row. */
static int stop_and_go_on(points *t, job *whole, job *j, const char *what,
                          double mu) {
  traced usual = {.action = TRACE_COUNT};
  long n = points_number(1, 0.0003);
  kept_mesh(whole);
  int code = traced_run(whole, nothing, &usual);
  int taken = code == 0 || code == 1;
  for (long k = 0; taken && k < n; ++k) {
    int at = (int)points_spread(k, n, usual.changes);
    int signal_no = t->tried % 2 == 0 ? SIGINT : SIGTERM;
    job_clear(j);
    const char *wrong =
        fault(whole, j, code, signal_no, stop(j, at, signal_no));
    points_try(t);
    if (wrong != NULL)
      points_lose(t, "%s, mu %g: stopped at change %d of %d: %s (%s): %.200s",
                  what, mu, at, usual.changes, wrong,
                  wrong[0] == 'r' && traced_difference(whole, j) != NULL
                      ? traced_difference(whole, j)
                      : "-",
                  j->errors);
  }
  ck_assert_msg(taken || code == 2 || code == 6, "%s: exit %d: %s", what, code,
                whole->errors);
  kept_mesh(NULL);
  job_end(whole);
  job_end(j);
  return taken;
}

/* Of case k: both in the long run; else one of them for the first of every
 * "few" cases. */
static int takes(int k, int few, double mu) {
  if (points_all()) return 1;
  return k % few == 0 && (k / few % 2 == 0) == (mu < 1.0);
}

static const double friction[] = {0.1, 10.0};

static void in_capitals(const char *name, char text[32]) {
  snprintf(text, 32, "%s", name);
  for (char *p = text; *p != '\0'; ++p) *p = (char)toupper((unsigned char)*p);
}

static void each_method(points *t, int few,
                        job (*make)(double, const char *, const char *)) {
  int taken = 0;
  char name[32];
  EACH_SOLVER(i, ops)
  for (int m = 0; m < 2; ++m) {
    if (!takes(i, few, friction[m])) continue;
    in_capitals(row_name(ops), name);
    job whole = make(friction[m], "", name), j = make(friction[m], "", name);
    taken += stop_and_go_on(t, &whole, &j, name, friction[m]);
  }
  ck_assert_int_ge(taken, 2);
}

TEST(methods_go_on) {
  points t = {.kind = "restarts, methods"};
  each_method(&t, 1, small_flat);
  each_method(&t, 3, small_solid);
  points_end(&t);
}

TEST(integrators_go_on) {
  points t = {.kind = "restarts, integrators"};
  char words[64];
  for (int i = 0; scheme_list[i] != NULL; ++i)
    for (int m = 0; m < 2; ++m) {
      if (!takes(i, 2, friction[m])) continue;
      snprintf(words, sizeof words, "INTEGRATOR=%s", scheme_list[i]->name);
      job whole = small_creep(friction[m], "", words);
      job j = small_creep(friction[m], "", words);
      ck_assert_msg(stop_and_go_on(&t, &whole, &j, words, friction[m]), "%s",
                    words);
    }
  points_end(&t);
}

/* ---- effects ------------------------------------------------------------- */

#define FLOOR "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
#define MAXWELL "*INELASTIC, LAW=MAXWELL\n4.\n"
#define DEVIATOR "*INELASTIC, LAW=MAXWELL, TYPE=DEVIATORIC\n0.4\n"
#define NORTON "*INELASTIC, LAW=NORTON\n1E-8, 3.\n"
#define LATER "*STEP\n*QUASISTATIC\n0.5, 2.\n"

/* clang-format off */
static const struct {
  const char *name, *material, *section, *obstacle, *law, *more, *second, *held;
} scenes[] = {
    {"adaptive HEUN", MAXWELL, "", FLOOR, "COULOMB", "",
     "*STEP\n*VISCO, INTEGRATOR=HEUN, TOLERANCE=1E-3\n0.1, 2.\n", ""},
    {"adaptive MIDPOINT", NORTON, "", FLOOR, "COULOMB", "",
     "*STEP\n*VISCO, INTEGRATOR=MIDPOINT, TOLERANCE=1E-4\n0.1, 2.\n", ""},
    {"time points", MAXWELL, "", FLOOR, "COULOMB",
     "*TIME POINTS, NAME=T, GENERATE, TIME=TOTAL TIME\n1.1, 2.9, 0.2\n",
     "*STEP\n*VISCO, INTEGRATOR=MIDPOINT\n0.25, 2.\n"
     "*PRINT, CONTACT, ENERGY, TIME POINTS=T\n", ""},
    {"averaged", DEVIATOR, ", FORMULATION=AVERAGED", FLOOR, "COULOMB", "",
     "*STEP\n*VISCO, INTEGRATOR=BACKWARD\n0.25, 2.\n", ""},
    {"locking", DEVIATOR, "", FLOOR, "COULOMB", "",
     "*STEP\n*VISCO, INTEGRATOR=BACKWARD\n0.25, 4.\n", ""},
    {"pieces", MAXWELL, "", FLOOR, "COULOMB", "",
     "*STEP\n*VISCO, INTEGRATOR=EULER, SUBSTEPS=AUTO\n4., 12.\n", ""},
    {"error of steps", MAXWELL, "", FLOOR, "COULOMB", "",
     "*STEP\n*VISCO, INTEGRATOR=HEUN\n0.25, 2.\n*ACCURACY, TIME=YES\n", ""},
    {"turning loads", MAXWELL, "", FLOOR, "COULOMB", "",
     "*STEP\n*VISCO, INTEGRATOR=THETA, THETA=0.8\n0.5, 3.\n*DSLOAD\n"
     "TOP, P, \"50+20*sin(5*t)\"\nLEFT, P, \"150+60*sin(4*t)\"\n"
     "*ACCURACY, TIME=YES\n", ""},
    {"balanced", "", "", FLOOR, "COULOMB", "",
     LATER "*ACCURACY, MESH=YES, TIME=BALANCED\n", ""},
    {"thermal", "*EXPANSION\n1.2E-5\n", "", FLOOR, "COULOMB", "",
     LATER "*TEMPERATURE\nBODY, \"9*x*sin(2*t)\"\n", ""},
    {"softening", "*ELASTIC\n130.D3, 0.2, 0.\n65.D3, 0.3, 500.\n"
     "*EXPANSION\n1.2E-5\n", "", FLOOR, "COULOMB", "",
     LATER "*TEMPERATURE\nBODY, \"9*x*t\"\n", ""},
    {"nonlocal", "", "", FLOOR, "NONLOCAL, RADIUS=8.", "", LATER, ""},
    {"nonlocal creep", MAXWELL, "", FLOOR, "NONLOCAL, RADIUS=8.", "",
     "*STEP\n*VISCO, INTEGRATOR=MIDPOINT\n0.25, 2.\n", ""},
    {"other radius", "", "", FLOOR, "NONLOCAL, RADIUS=8.", "",
     LATER "*FRICTION, CONTACT=C, LAW=NONLOCAL, RADIUS=20.\n0.4\n", ""},
    {"moving obstacle", "", "",
     "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0., 0.\n0., 1., 0.\n"
     "MOVE, \"2e-2*t\", \"1e-2*sin(t)\", 0.\n", "COULOMB", "", LATER, ""},
    {"velocities", "", "", FLOOR, "COULOMB", "",
     "*STEP\n*QUASISTATIC, FORM=VELOCITY\n0.25, 2.\n", ""},
    {"given force", "", "", FLOOR, "COULOMB",
     "*CONTACT FORCE, CONTACT=C\n\"40*t+9*sin(t)\"\n", LATER, "TOP, 2\n"},
    {"zones, loops", "", "", FLOOR, "COULOMB", "",
     LATER "*DSLOAD\nLEFT, P, -150.\n*PRINT, ZONES, LOOP, REACTIONS\n", ""},
    {"static last", "", "", FLOOR, "COULOMB", "",
     LATER "*END STEP\n*STEP\n*STATIC\n1.\n", ""}};
/* clang-format on */
enum { N_SCENE = sizeof scenes / sizeof *scenes };

static job scene_job(int k, double mu) {
  job j = job_begin("scene");
  const char *material = scenes[k].material;
  job_copy(&j, "input/creep_block/creep_block.geo");
  job_write(
      &j, "scene.inp",
      "*PARAMETER\nN = 8\n*MESH, FILE=creep_block.geo\n"
      "*MATERIAL, NAME=M\n%s%s*SOLID SECTION, ELSET=BODY, MATERIAL=M%s\n"
      "%s*CONTACT, NAME=C, GROUP=CONTACT, OBSTACLE=O\n"
      "*FRICTION, CONTACT=C, LAW=%s\n%g\n%s*STEP\n*QUASISTATIC\n"
      "0.5, 1.\n*BOUNDARY\nSYMMETRY, 1\n%s*DSLOAD\nTOP, P, 50.\n"
      "LEFT, P, 150.\n*PRINT, CONTACT, ENERGY\n*OUTPUT\n*END STEP\n"
      "%s*END STEP\n",
      strncmp(material, "*ELASTIC", 8) == 0 ? "" : "*ELASTIC\n130.D3, 0.2\n",
      material, scenes[k].section, scenes[k].obstacle, scenes[k].law, mu,
      scenes[k].more, scenes[k].held, scenes[k].second);
  return j;
}

TEST(effects_go_on) {
  points t = {.kind = "restarts, effects"};
  for (int k = 0; k < N_SCENE; ++k)
    for (int m = 0; m < 2; ++m) {
      if (!takes(k, 1, friction[m])) continue;
      job whole = scene_job(k, friction[m]), j = scene_job(k, friction[m]);
      ck_assert_msg(stop_and_go_on(&t, &whole, &j, scenes[k].name, friction[m]),
                    "%s", scenes[k].name);
    }
  points_end(&t);
}

UNIT_MAIN_FOR("restarts", 100 * UNIT_SECONDS)
