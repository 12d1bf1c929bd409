/*
 * What an increment of a linear law costs once its matrix is factored, against
 * one forward and back solve of the interior and the contact solver; the aim is
 * a ratio of 1.5. Blocks on a rough floor, in the plane and in space: CPU of
 * whole runs of many increments less that of few, and the same of the two
 * stages; the pair of runs with the median of the ratio.
 */
#include "support/job.h"
#include "support/unit.h"

#include <sys/resource.h>

enum { FEW = 10, MANY = 60, PAIRS = 5 };

typedef struct bench_case {
  const char *law, *integrator;
  int dim, cells; /* along an edge                                          */
} bench_case;

/* CPU of an increment, s. */
typedef struct cost {
  double solves, contact, all;
} cost;

static double child_cpu(void) {
  struct rusage u;
  getrusage(RUSAGE_CHILDREN, &u);
  return (double)(u.ru_utime.tv_sec + u.ru_stime.tv_sec) +
         1e-6 * (double)(u.ru_utime.tv_usec + u.ru_stime.tv_usec);
}

/* CPU of a stage in the closing table of the listing, s. */
static double stage_cpu(const job *j, const char *name) {
  char key[80], *lst = job_file(j, "lst");
  long calls;
  double cpu = 0;
  snprintf(key, sizeof key, "\n  %s ", name);
  const char *table = strstr(lst, "\nCOST\n");
  ck_assert_ptr_nonnull(table);
  const char *at = strstr(table, key);
  ck_assert_msg(at != NULL, "%s", name);
  ck_assert_int_eq(sscanf(at + strlen(key), "%ld %lf", &calls, &cpu), 2);
  free(lst);
  return cpu;
}

/* The supports and loads of a block, faces named by their mesh. */
static const char *cards(int dim) {
  return dim == 2 ? "*BOUNDARY\nSYMMETRY, 1\n*DSLOAD\nTOP, P, 50.\n"
                    "LEFT, P, 150.\n"
                  : "*BOUNDARY\nLEFT, 1\nFRONT, 2\n*DSLOAD\nTOP, P, 50.\n"
                    "RIGHT, P, 60.\nBACK, P, 60.\n";
}

/* A run of n increments. */
static cost run_block(const bench_case *c, int n) {
  JOB j = job_with(
      "increment",
      c->dim == 2 ? "input/creep_block/creep_block.geo"
                  : "tests/regression/mesh/cube.geo",
      "*PARAMETER\nN = %d\n*MESH, FILE=%s\n"
      "*MATERIAL, NAME=LEAD\n*ELASTIC\n130.D3, 0.2\n"
      "*INELASTIC, LAW=%s\n*SOLID SECTION, ELSET=BODY, MATERIAL=LEAD%s\n"
      "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
      "*CONTACT, NAME=FOOT, GROUP=%s, OBSTACLE=O\n"
      "*FRICTION, CONTACT=FOOT, LAW=COULOMB\n0.5\n"
      "*STEP\n*STATIC\n%s*OUTPUT, HDF5=NO\n"
      "*END STEP\n*STEP\n*VISCO, INTEGRATOR=%s\n0.1, %.17g\n"
      "*END STEP\n",
      c->cells, c->dim == 2 ? "creep_block.geo" : "cube.geo", c->law,
      c->dim == 2 ? ", TYPE=CPE3" : "", c->dim == 2 ? "CONTACT" : "BOTTOM",
      cards(c->dim), c->integrator, 0.1 * n);
  double cpu = child_cpu();
  int code = job_run(&j, "");
  cpu = child_cpu() - cpu;
  ck_assert_msg(code == 0, "exit %d: %s", code, j.errors);
  cost k = {stage_cpu(&j, "interior solves"), stage_cpu(&j, "contact solver"),
            cpu - stage_cpu(&j, "mesh")};
  return k;
}

static double ratio(const cost *c) { return c->all / (c->solves + c->contact); }

static int by_ratio(const void *a, const void *b) {
  double x = ratio(a), y = ratio(b);
  return (x > y) - (x < y);
}

static cost pair_of_runs(const bench_case *c) {
  cost few = run_block(c, FEW), many = run_block(c, MANY);
  const double n = MANY - FEW;
  return (cost){(many.solves - few.solves) / n,
                (many.contact - few.contact) / n, (many.all - few.all) / n};
}

TEST(increments_of_a_linear_law) {
  static const bench_case cases[] = {
      {"MAXWELL\n4.", "MIDPOINT", 2, 100},
      {"MAXWELL\n4.", "MIDPOINT", 2, 200},
      {"MAXWELL, TYPE=DEVIATORIC\n4.", "EXPONENTIAL", 2, 200},
      {"ZENER\n100.D3, 400.D3", "BACKWARD", 2, 200},
      {"MAXWELL\n4.", "BACKWARD", 3, 16}};
  printf("%-28s %-12s %9s %9s %9s  %s\n", "law, ms per increment", "integrator",
         "solves", "contact", "all", "all over both (least to most; aim 1.5)");
  for (size_t i = 0; i < sizeof cases / sizeof *cases; ++i) {
    const bench_case *c = &cases[i];
    cost k[PAIRS];
    for (int p = 0; p < PAIRS; ++p) k[p] = pair_of_runs(c);
    qsort(k, PAIRS, sizeof *k, by_ratio);
    const cost *mid = &k[PAIRS / 2];
    PRINTED(name, "%.*s %d^%d", (int)strcspn(c->law, "\n"), c->law, c->cells,
            c->dim);
    printf("%-28s %-12s %9.2f %9.2f %9.2f  %.2f (%.2f to %.2f)\n", name,
           c->integrator, 1e3 * mid->solves, 1e3 * mid->contact, 1e3 * mid->all,
           ratio(mid), ratio(&k[0]), ratio(&k[PAIRS - 1]));
    fflush(stdout);
  }
}

UNIT_MAIN("increment")
