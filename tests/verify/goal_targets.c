/*
 * TARGET= of *GOAL: the peak of the sphere of Hertz in space from a coarse mesh
 * to 1 %, and the unknowns of meshes for a goal beside those of meshes for the
 * energy norm, both with the same |error| + band.
 */
#include "support/job.h"
#include "support/unit.h"

/* The deck of an example with some text replaced. */
static job run_deck(const char *deck, const char *old, const char *by,
                    const char *in_step, const char *words) {
  FREED char *text = job_deck_text(deck);
  job j = job_begin("goals");
  job_copy_meshes(&j, deck);
  char *at = strstr(text, old), *end = strstr(text, "*END STEP");
  ck_assert(at != NULL && end > at);
  const char *rest = at + strlen(old);
  job_write(&j, "goals.inp", "%.*s%s%.*s%s%s", (int)(at - text), text, by,
            (int)(end - rest), rest, in_step, end);
  CK_EXIT(job_run(&j, words), 0, j);
  return j;
}

TEST(peak_of_the_sphere_to_one_percent) {
  JOB j = run_deck("input/hertz_sphere/hertz_sphere_3d", "*STEP",
                   "*GOAL, NAME=PEAK, QUANTITY=PRESSURE, CONTACT=POLE, "
                   "TARGET=1 %\n*STEP",
                   "*ACCURACY, MAX_CPU=60\n*PRINT, GOALS\n", "-D NC=2");
  const double error = job_value(&j, "GOALS", -1, "value") / 4688.3 - 1.0;
  printf(
      "\nsphere in space, TARGET=1 %%: true error %.2g %%, %.0f unknowns, "
      "%.3g s\n",
      100 * error, job_told(&j, "unknowns"), job_told(&j, "cpu"));
  ck_assert_double_lt(fabs(error), 0.01);
}

static double off_of(const job *j, int row) {
  dat t = job_table(j, "GOALS", -1);
  const double off = fabs(dat_at(&t, row, "error")) + dat_at(&t, row, "band");
  dat_free(&t);
  return off;
}

static const char *const goals[] = {"PEAK", "WIDE", "TOP", "SIDE"};

TEST(meshes_for_a_goal_are_smaller) {
  static const char deck[] = "input/hertz_line/hertz_goals";
  JOB e = run_deck(deck, "*STEP", "*STEP", "*ACCURACY, TARGET=1\n", "-D N=4");
  const double norm = job_told(&e, "unknowns");
  double product = 1.0;
  printf("half plane: %.0f unknowns of TARGET=1 in the energy norm\n", norm);
  for (int k = 0; k < 4; ++k) {
    PRINTED(old, "NAME=%s,", goals[k]);
    PRINTED(by, "%s TARGET=%.9g,", old, off_of(&e, k));
    JOB j = run_deck(deck, old, by, "", "-D N=4");
    const double own = job_told(&j, "unknowns");
    printf("  %-5s %8.0f unknowns for the same |error| + band: 1/%.2f\n",
           goals[k], own, norm / own);
    product *= norm / own;
  }
  ck_assert_double_gt(sqrt(sqrt(product)), 2.0);
}

UNIT_MAIN("goal_targets")
