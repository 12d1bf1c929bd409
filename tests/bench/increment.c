/*
 * What an increment of a linear law costs once its matrix is factored, against
 * one forward and back solve of the interior and the contact solver; the aim is
 * a ratio of 1.5. The block of creep_block under MIDPOINT, CPU seconds per
 * increment, from runs of 10 and of 40 increments.
 */
#include "support/job.h"
#include "support/unit.h"

#include <stdio.h>
#include <string.h>

/* CPU of a stage in the closing table of the listing, s. */
static double stage_cpu(const job *j, const char *stage) {
  char key[80], *lst = job_file(j, "lst");
  long calls;
  double cpu = 0;
  snprintf(key, sizeof key, "\n  %s ", stage);
  const char *table = strstr(lst, "\nCOST\n");
  ck_assert_ptr_nonnull(table);
  const char *at = strstr(table, key);
  ck_assert_msg(at != NULL, "%s", stage);
  ck_assert_int_eq(sscanf(at + strlen(key), "%ld %lf", &calls, &cpu), 2);
  free(lst);
  return cpu;
}

static const char *const stages[] = {
    "interior solves", "contact solver",    "loads",          "contact surface",
    "energies",        "inelastic strains", "error of solver"};
enum { N_STAGE = sizeof stages / sizeof *stages };

/* CPU of the stages in a run of n increments with cells*cells squares. */
static void run_block(int cells, int n, double *cpu) {
  job j = job_begin("increment");
  job_copy(&j, "input/creep_block/creep_block.geo");
  job_write(&j, "increment.inp",
            "*PARAMETER\nN = %d\n*MESH, FILE=creep_block.geo\n"
            "*MATERIAL, NAME=LEAD\n*ELASTIC\n130.D3, 0.2\n"
            "*INELASTIC, LAW=MAXWELL\n4.\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=LEAD, TYPE=CPE3\n"
            "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
            "*CONTACT, NAME=FOOT, GROUP=CONTACT, OBSTACLE=O\n"
            "*FRICTION, CONTACT=FOOT, LAW=COULOMB\n1.0\n"
            "*STEP\n*STATIC\n*BOUNDARY\nSYMMETRY, 1\n"
            "*DSLOAD\nTOP, P, 50.\nLEFT, P, 150.\n*OUTPUT, HDF5=NO\n"
            "*END STEP\n*STEP\n*VISCO, INTEGRATOR=MIDPOINT\n0.1, %.17g\n"
            "*END STEP\n",
            cells, 0.1 * n);
  int code = job_run(&j, "");
  ck_assert_msg(code == 0, "exit %d: %s", code, j.errors);
  for (int k = 0; k < N_STAGE; ++k) cpu[k] = stage_cpu(&j, stages[k]);
  job_end(&j);
}

START_TEST(increments_of_a_linear_law) {
  static const int cells[] = {100, 200};
  for (int i = 0; i < 2; ++i) {
    double few[N_STAGE], many[N_STAGE], all = 0;
    run_block(cells[i], 10, few);
    run_block(cells[i], 40, many);
    printf("%d squares, ms per increment\n", cells[i] * cells[i]);
    for (int k = 0; k < N_STAGE; ++k) {
      many[k] = (many[k] - few[k]) / 30;
      all += many[k];
      printf("  %-20s %8.3f\n", stages[k], 1e3 * many[k]);
    }
    printf("  all over solves and contact: %.2f (aim 1.5)\n",
           all / (many[0] + many[1]));
  }
}
END_TEST

UNIT_MAIN("increment", increments_of_a_linear_law)
