/*
 * UPDATE=STEP: partners of a pair found again where the bodies have come to.
 */
#include "support/job.h"
#include "support/traced.h"
#include "support/unit.h"

#include <signal.h>

const int job_without_fields = 1;

/* A block that was pressed, carried by 0.25 along the other and pressed more
 * has the forces of one that was meshed there. */
static job run_carried(const char *update, const char *way, const char *D) {
  job j =
      job_with("carried", "tests/regression/mesh/pair.geo",
               "*PARAMETER\nN = 10\nM = 7\nC = 0.3\nD = %s\n"
               "*MESH, FILE=pair.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1.E6, 0.3\n"
               "*SOLID SECTION, ELSET=LOWER, MATERIAL=M\n"
               "*SOLID SECTION, ELSET=UPPER, MATERIAL=M\n"
               "*CONTACT PAIR, NAME=P, SLAVE=FIRST%s\nUNDER, OVER\n"
               "*STEP\n*STATIC\n*BOUNDARY\nBOTTOM, 1, 2\nTOP, 1\n"
               "*DSLOAD\nTOP, P, 1.\n*RESTART\n*END STEP\n"
               "*STEP\n*STATIC\n*BOUNDARY\nTOP, 1, 1, %s\n*END STEP\n"
               "*STEP\n*QUASISTATIC\n0.1, 1.\n*DSLOAD\nTOP, P, 2.\n"
               "*PRINT, CONTACT, TOTALS, ENERGY\n*END STEP\n",
               D, update, way);
  return j;
}

TEST(carried_block_finds_its_partners) {
  JOB moved = run_carried(", UPDATE=STEP", "0.25", "0"),
      there = run_carried("", "0", "0.25");
  ck_assert_int_eq(job_run(&moved, "--no-timing"), 0);
  ck_assert_int_eq(job_run(&there, "--no-timing"), 0);
  ck_assert_ptr_nonnull(strstr(moved.errors, "at the start of the step"));
  DAT x = job_table(&moved, "CONTACT", -1),
      y = job_table(&there, "CONTACT", -1), t = job_table(&moved, "TOTALS", -1);
  ck_assert_int_eq(x.n_row, y.n_row);
  for (int i = 0; i < x.n_row; ++i) {
    ck_assert_double_eq_tol(dat_at(&x, i, "x"), dat_at(&y, i, "x"), 1e-9);
    ck_assert_double_eq_tol(dat_at(&x, i, "f_n"), dat_at(&y, i, "f_n"), 1e-4);
  }
  ck_assert_double_eq_tol(dat_at(&t, 0, "normal"), 2 * 0.4, 1e-9);
  ck_assert_double_lt(dat_at(&t, 0, "moment_of_both"), 1e-6);
  /* Gone on with within the last step: the same files. */
  static const char *const words[] = {"--no-timing", NULL};
  traced s = {.action = TRACE_SIGNAL, .number = SIGTERM};
  JOB stopped = run_carried(", UPDATE=STEP", "0.25", "0");
  ck_assert_int_eq(traced_run(&stopped, words, &s), 0);
  s.at = s.changes / 2;
  job_clear(&stopped);
  ck_assert_int_ne(traced_run(&stopped, words, &s), 0);
  ck_assert_int_eq(job_run(&stopped, "--restart --no-timing"), 0);
  const char *differs = traced_difference(&moved, &stopped);
  ck_assert_msg(differs == NULL, ".%s differs", differs);
}

/* Carried by less than a face, which is 0.1 long, and farther; in a step. */
TEST(slip_on_the_partners_found_last_is_told) {
  static const char *const way[] = {"0.09", "0.11"};
  static const char *const of[] = {"what it met at time 0\n",
                                   "at the start of the step"};
  for (int i = 0; i < 4; ++i) {
    JOB j = run_carried(i / 2 == 0 ? "" : ", UPDATE=STEP", way[i % 2], "0");
    ck_assert_int_eq(job_run(&j, ""), 0);
    ck_assert_msg((strstr(j.errors,
                          "P4038: step 2, increment 1, time 2: "
                          "*CONTACT PAIR P: node ") != NULL) == i % 2 &&
                      (strstr(j.errors, of[i / 2]) != NULL) == i % 2,
                  "%s", j.errors);
  }
  JOB j = run_carried(", UPDATE=STEP",
                      "0.09\n*END STEP\n*STEP\n*STATIC\n*BOUNDARY\n"
                      "TOP, 1, 1, 0.18",
                      "0");
  ck_assert_int_eq(job_run(&j, ""), 0);
  ck_assert_ptr_null(strstr(j.errors, "P4038"));
}

/* Nothing jumps where partners are found again under friction. */
TEST(partners_of_a_sheared_block_stay) {
  JOB j =
      job_with("shear", "tests/regression/mesh/pair.geo",
               "*PARAMETER\nN = 10\nM = 7\nC = 0.3\n*MESH, FILE=pair.geo\n"
               "*MATERIAL, NAME=M\n*ELASTIC\n1.E6, 0.3\n"
               "*SOLID SECTION, ELSET=LOWER, MATERIAL=M\n"
               "*SOLID SECTION, ELSET=UPPER, MATERIAL=M\n"
               "*CONTACT PAIR, NAME=P, SLAVE=FIRST, UPDATE=STEP\nUNDER, OVER\n"
               "*FRICTION, CONTACT=P, LAW=COULOMB\n0.4\n"
               "*STEP\n*QUASISTATIC\n0.25, 1.\n*BOUNDARY\nBOTTOM, 1, 2\n"
               "*DSLOAD\nTOP, P, 1.\nTOP, TX, 0.2\n"
               "*PRINT, CONTACT, ENERGY\n*END STEP\n"
               "*STEP\n*QUASISTATIC\n0.5, 1.\n*END STEP\n");
  ck_assert_int_eq(job_run(&j, "--no-timing"), 0);
  DAT x = job_table(&j, "CONTACT", 3), y = job_table(&j, "CONTACT", 4),
      e = job_table(&j, "ENERGY", -1);
  for (int i = 0; i < x.n_row; ++i) {
    ck_assert_double_eq_tol(dat_at(&x, i, "f_n"), dat_at(&y, i, "f_n"), 1e-5);
    ck_assert_double_eq_tol(dat_at(&x, i, "f_t"), dat_at(&y, i, "f_t"), 1e-5);
  }
  ck_assert_double_le(fabs(dat_at(&e, 0, "energy_defect")),
                      1e-6 * dat_at(&e, 0, "external_work"));
}

UNIT_MAIN("pair_update")
