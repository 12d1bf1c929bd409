/*
 * What TOL=BALANCED saves of the contact solver on the examples, with AUTO: its
 * iterations and CPU seconds (the least of some runs) beside those of the
 * default, and the worst errors that are left, of the mesh and of the solver.
 * Runs $PROTIS, else build/release/protis.
 */
#include "support/job.h"
#include "support/unit.h"

enum { RUNS = 3 };

static const struct {
  const char *deck, *words;
} examples[] = {{"input/greco/greco", "-D N=128"},
                {"input/hertz_line/hertz_line", "-D NC=64"},
                {"input/hertz_line/hertz_line_friction", "-D NC=64"},
                {"input/creep_block/creep_block", "-D N=128"},
                {"input/creep_block/held_block", "-D N=128"},
                {"input/block_shear_3d/block_shear_3d", ""}};

typedef struct cost {
  double iterations, cpu; /* of all increments, the least of the runs, s      */
  double from_mesh, solver; /* %, worst */
} cost;

/* The number after a name in JSON, from "at" on. */
static double number(const char *at, const char *name) {
  at = at != NULL ? strstr(at, name) : NULL;
  return at != NULL ? atof(at + strlen(name)) : NAN;
}

static cost measure(const char *deck, const char *words, const char *card) {
  cost c = {.cpu = HUGE_VAL};
  for (int k = 0; k < RUNS; ++k) {
    JOB j;
    ck_assert_int_le(job_run_with(&j, deck, card, 0, words), 1);
    FREED char *json = job_file(&j, "json");
    const char *at = strstr(json, "\"stage\": \"contact solver\"");
    c.cpu = fmin(c.cpu, number(at, "\"cpu\": "));
    c.iterations = 0.0;
    for (at = json; (at = strstr(at, "\"iterations\": ")) != NULL; ++at)
      c.iterations += atof(at + strlen("\"iterations\": "));
    c.from_mesh = number(json, "\"mesh_error_worst_percent\": ");
    c.solver = number(json, "\"solver_error_worst_percent\": ");
  }
  return c;
}

TEST(examples_with_and_without) {
  printf("%-36s %10s %9s %10s %9s %8s %9s %9s\n", "TOL=BALANCED", "iterations",
         "cpu[s]", "balanced", "cpu[s]", "saved[%]", "mesh[%]", "solver[%]");
  for (size_t k = 0; k < sizeof examples / sizeof *examples; ++k) {
    const char *deck = examples[k].deck, *words = examples[k].words;
    cost full = measure(deck, words, "");
    cost few = measure(deck, words, "*SOLVER, TOL=BALANCED\n");
    printf("%-36s %10.0f %9.4f %10.0f %9.4f %8.0f %9.2g %9.2g\n", deck,
           full.iterations, full.cpu, few.iterations, few.cpu,
           100.0 * (1.0 - few.cpu / full.cpu), few.from_mesh, few.solver);
    fflush(stdout);
  }
}

UNIT_MAIN_FOR("balanced", 1800)
