/*
 * First increments that start from the contact of a coarser mesh: *SOLVER,
 * NESTED=YES, and the passes of *ACCURACY, TARGET=. Fewer steps, the same
 * answer.
 */
#include "support/job.h"
#include "support/small_job.h"
#include "support/traced.h"
#include "support/unit.h"

#include <signal.h>

const int job_without_fields = 1;

static const char told[] = "started from the coarser mesh";

/* Iterations of the first increment in a listing. */
static int first_steps(const job *j) {
  int n = -1;
  FREED char *lst = job_file(j, "lst");
  const char *at = strstr(lst, "converged, iterations ");
  ck_assert_ptr_nonnull(at);
  ck_assert_int_eq(sscanf(at, "converged, iterations %d", &n), 1);
  return n;
}

static int tells(const job *j) {
  FREED char *lst = job_file(j, "lst");
  return strstr(lst, told) != NULL;
}

/* Elements twice as long: half to a quarter of the contact nodes. */
static void must_be_coarser(const job *j) {
  int coarse, other, all;
  FREED char *lst = job_file(j, "lst");
  const char *at = strstr(lst, told);
  ck_assert_ptr_nonnull(at);
  ck_assert_int_eq(
      sscanf(at + strlen(told), " (%d contact node%*[s)]: %d of %d", &coarse,
             &other, &all),
      3);
  ck_assert_msg(coarse >= 0.2 * all && coarse <= 0.71 * all, "%d of %d", coarse,
                all);
}

/* Forces at the end, of the largest. */
static double apart(const job *a, const job *b, const char *column) {
  DAT x = job_table(a, "CONTACT", -1), y = job_table(b, "CONTACT", -1);
  double most = dat_max(&x, column), worst = 0;
  ck_assert_int_eq(x.n_row, y.n_row);
  for (int i = 0; i < x.n_row; ++i)
    worst = fmax(worst, fabs(dat_at(&x, i, column) - dat_at(&y, i, column)));
  return worst / most;
}

/* A deck of the sources cold and nested: at most "most" steps in the place of
 * "least". */
static void must_save(const char *deck, const char *words, int least,
                      int most) {
  JOB cold, nested;
  ck_assert_int_eq(job_run_with(&cold, deck, "", 1, words), 0);
  CK_EXIT(job_run_with(&nested, deck, "*SOLVER, NESTED=YES\n", 1, words), 0,
          nested);
  int without = first_steps(&cold), with = first_steps(&nested);
  ck_assert_msg(without >= least && without <= 14 && with <= most,
                "%s: %d steps, cold %d", deck, with, without);
  ck_assert(!tells(&cold));
  must_be_coarser(&nested);
  ck_assert_double_le(apart(&cold, &nested, "f_n"), 1e-9);
}

TEST(coarser_mesh_saves_steps) {
  must_save("input/greco/greco", "-D N=64", 9, 3);
  must_save("input/hertz_line/hertz_line", "-D NC=32", 8, 3);
  must_save("input/hertz_sphere/hertz_sphere_3d", "", 8, 3);
}

/* The first increment alone starts there: a run that goes on needs no mesh. */
TEST(nested_run_goes_on) {
  int changes, all;
  job both[2];
  const char *const words[] = {NULL, NULL};
  for (int k = 0; k < 2; ++k) both[k] = small_flat(0.4, "", "AUTO, NESTED=YES");
  traced t = {.action = TRACE_SIGNAL, .number = SIGINT};
  ck_assert_int_eq(traced_run(&both[0], words, &t), 0);
  all = t.changes;
  t = (traced){.action = TRACE_SIGNAL, .at = 2 * all / 3, .number = SIGINT};
  ck_assert_int_eq(traced_run(&both[1], words, &t), 130);
  changes = t.changes;
  ck_assert_int_lt(changes, all);
  ck_assert(tells(&both[1]));
  ck_assert_int_eq(job_run(&both[1], "--restart --no-timing"), 0);
  const char *file = traced_difference(&both[0], &both[1]);
  ck_assert_msg(file == NULL, ".%s differs", file);
  for (int k = 0; k < 2; ++k) job_end(&both[k]);
}

/* The second pass starts from the first. */
TEST(passes_start_from_the_last) {
  JOB cold, j;
  const char *deck = "input/hertz_line/hertz_line";
  ck_assert_int_eq(job_run_with(&cold, deck, "", 1, "-D NC=8"), 0);
  CK_EXIT(job_run_with(&j, deck, "*ACCURACY, TARGET=4\n", 1, "-D NC=4"), 0, j);
  ck_assert(tells(&j) && !tells(&cold));
  ck_assert_msg(first_steps(&j) <= 4 && first_steps(&cold) >= 6,
                "%d steps, cold %d", first_steps(&j), first_steps(&cold));
}

UNIT_MAIN("nested")
