/*
 * *ACCURACY, TARGET=: when a next pass is made, from the table of the passes.
 */
#include "support/block_file.h"
#include "support/job.h"
#include "support/unit.h"

const int job_without_fields = 1;

enum { MOST = 12 };

typedef struct passes {
  int n;
  double unknowns[MOST], mesh[MOST], total[MOST], cpu[MOST];
} passes;

static double next_number(char **at, const char *key) {
  *at = strstr(*at, key);
  ck_assert_ptr_nonnull(*at);
  return strtod(*at + strlen(key), at);
}

static passes passes_of(const job *j) {
  passes p = {0};
  char *json = job_file(j, "json"), *at = strstr(json, "\"passes\"");
  for (; p.n < MOST && strstr(at, "\"unknowns\": ") != NULL; ++p.n) {
    p.unknowns[p.n] = next_number(&at, "\"unknowns\": ");
    p.mesh[p.n] = next_number(&at, "\"mesh_error_percent\": ");
    p.total[p.n] = next_number(&at, "\"total_error_percent\": ");
    p.cpu[p.n] = next_number(&at, "\"cpu\": ");
  }
  free(json);
  return p;
}

/*
 * No mesh resolves the temperatures: errors scatter from pass to pass. Two in a
 * row that gain less than 5 % of the error end it, if their mesh has more than
 * twice the unknowns of the last that gained; one does not, though it asks for
 * half the square of the error. Where the estimate counts twice nothing is
 * known of the gain.
 */
TEST(two_passes_in_a_row_without_a_gain_end_it) {
  JOB j = job_begin("noise");
  int in_a_row = 0, longest = 0, single = 0;
  block_file_write(&j, (int[]){1, 1}, (double[]){1.0, 1.0}, 0);
  job_write(&j, "noise.inp",
            "*MESH, FILE=block.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1., 0.3\n"
            "*EXPANSION\n1.E-3\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*STEP\n*STATIC\n*BOUNDARY\nCONTACT, 1, 2\n*TEMPERATURE\n"
            "BODY, \"sin(766549*x+17267*y)\"\n"
            "*ACCURACY, TARGET=52, MAX_PASSES=%d\n*END STEP\n",
            MOST);
  double cpu = -job_cpu(), gained = 0.0;
  ck_assert_int_eq(job_run(&j, ""), 1);
  cpu += job_cpu();
  ck_assert_ptr_nonnull(strstr(j.errors, "finer has no smaller error"));
  const passes p = passes_of(&j);
  for (int k = 0; k < p.n; ++k) {
    const int vain = k > 0 && p.total[k] < 1.5 * p.mesh[k] &&
                     p.mesh[k] > 0.95 * p.mesh[k - 1];
    single += in_a_row == 1 && !vain;
    if (in_a_row == 1 && k > 0)
      ck_assert_double_gt(p.unknowns[k], 2.0 * p.unknowns[k - 1]);
    in_a_row = vain ? in_a_row + 1 : 0;
    if (!vain) gained = p.unknowns[k];
    longest = in_a_row > longest ? in_a_row : longest;
    ck_assert_int_eq(in_a_row > 1 && p.unknowns[k] > 2 * gained, k == p.n - 1);
    cpu -= p.cpu[k];
  }
  ck_assert_int_eq(longest, 2);
  ck_assert_int_gt(single, 0);
  ck_assert_double_ge(cpu, 0.0);
}

/* A block on an inclined floor whose mesh has its share of 12 %, the solver
 * more. */
static passes run_slanted(job *j, const char *before, const char *step,
                          const char *accuracy) {
  *j = job_begin("block");
  block_file_write(j, (int[]){10, 10}, (double[]){1.0, 1.0}, 0);
  job_write(j, "block.inp",
            "*MESH, FILE=block.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=GAP\n\"0.002 - 0.01*x\"\n"
            "*CONTACT, NAME=C, GROUP=CONTACT, OBSTACLE=O\n"
            "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n%s"
            "*STEP\n*%s\n*BOUNDARY\nTOP, 1, 1, 0.002\n"
            "TOP, 2, 2, -0.005\n*SOLVER, METHOD=SOR, TOL=0.1\n*ACCURACY, %s\n"
            "*END STEP\n",
            before, step, accuracy);
  ck_assert_msg(job_run(j, "") == 1, "%s", j->errors);
  return passes_of(j);
}

/* Seconds of a next pass, which has the same mesh, are those of this one, and
 * come after them. */
TEST(seconds_that_a_pass_has_taken_count) {
  static const char says[] = "done after about ";
  JOB j;
  const passes p = run_slanted(&j, "", "STATIC", "TARGET=12, MAX_CPU=1E-9");
  const char *at = strstr(j.errors, says);
  ck_assert_msg(p.n == 1 && at != NULL, "%s", j.errors);
  ck_assert_double_gt(atof(at + strlen(says)), 1.8 * p.cpu[0]);
}

/* No other pass would know it. */
TEST(pass_whose_error_is_unknown_is_the_last) {
  JOB j;
  const passes p = run_slanted(&j,
                               "*STEP\n*QUASISTATIC\n1., 1.\n*BOUNDARY\n"
                               "TOP, 1, 2\n*ACCURACY, SOLVER=NO\n*END STEP\n",
                               "QUASISTATIC\n1., 1.", "TARGET=12");
  ck_assert_int_eq(p.n, 1);
  ck_assert_msg(strstr(j.errors,
                       "the error is unknown, the target 12 %: the "
                       "solver has no bound of its error") != NULL,
                "%s", j.errors);
}

UNIT_MAIN("passes")
