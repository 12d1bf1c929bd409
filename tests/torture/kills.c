/*
 * kill -9 at changes of files: what JOB.sta tells stands in JOB.h5, and
 * --restart, killed itself or not, ends with the files of a run that nobody
 * disturbed. So it is after a second SIGINT, which ends a run at once.
 */
#include "support/kept_mesh.h"
#include "support/points.h"
#include "support/small_job.h"
#include "support/traced.h"
#include "support/unit.h"

#include <hdf5.h>
#include <signal.h>

enum { MOST = 1000 };

static const char *const nothing[] = {NULL, NULL};
static const char *const again[] = {"--restart", NULL};

/* Increments told in JOB.sta: whole lines after the header; 0 without it. */
static int told(const job *j) {
  FREED char *sta = job_file(j, "sta");
  int n = -1;
  for (char *p = sta; p != NULL && (p = strchr(p, '\n')) != NULL; ++p) ++n;
  return n < 0 ? 0 : n;
}

/* Increments in JOB.h5; -1: it cannot be read. */
static int kept(const job *j) {
  static double t[MOST];
  int n = 0;
  PRINTED(path, "%s/%s.h5", j->dir, j->name);
  H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
  hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  hid_t set = file < 0 ? -1 : H5Dopen2(file, "/history/time", H5P_DEFAULT);
  int bad = set < 0 || H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL,
                               H5P_DEFAULT, t) < 0;
  if (set >= 0) H5Dclose(set);
  if (file >= 0) H5Fclose(file);
  while (!bad && n < MOST && !isnan(t[n])) ++n;
  return bad ? -1 : n;
}

static int can_restart(const job *j) {
  return job_has(j, "rst.h5") || job_has(j, "rst.old.h5");
}

static int run(job *j, const char *const *words, int at, int *changes) {
  traced t = {.action = TRACE_SIGNAL, .at = at, .timed = 1, .number = SIGKILL};
  int code = traced_run(j, words, &t);
  if (changes != NULL) *changes = t.changes;
  return code;
}

/* Killed at a change; how often JOB.xdmf is rewritten goes by time, so that the
 * last may not come: then at one in the middle. */
static int run_killed(job *j, int at) {
  int made, code = run(j, nothing, at, &made);
  if (made >= at) return code;
  job_clear(j);
  return run(j, nothing, made / 2, NULL);
}

/* To the end from what a killed run left; NULL or what is wrong. */
static const char *go_on(const job *whole, job *j) {
  if (traced_run(j, again, NULL) != 0) return "restart: exit code";
  return traced_difference(whole, j) == NULL ? NULL : "wrong files";
}

static const char *after_kill(const job *j, int code) {
  if (code != KILLED) return "not killed";
  return told(j) > 0 && kept(j) < told(j) ? "increment of .sta lost" : NULL;
}

typedef job make_job(double mu, const char *cards, const char *method);

/* n kills of a job, each followed by "again" kills of its restarts. */
static void kill_often(points *t, points *twice, make_job *make,
                       const char *method, double mu, long n) {
  JOB whole = make(mu, "*RESTART\n", method);
  JOB j = make(mu, "*RESTART\n", method);
  int changes, rest;
  kept_mesh(&whole);
  ck_assert_int_eq(run(&whole, nothing, 0, &changes), 0);
  for (long k = 0; k < n && k < changes; ++k) {
    int at = (int)points_spread(k, n, changes);
    job_clear(&j);
    const char *wrong = after_kill(&j, run_killed(&j, at));
    points_try(t);
    if (k % 7 == 1 && wrong == NULL && can_restart(&j)) {
      int part = 1 + (int)(k * 7 % (changes / 2));
      int code = run(&j, again, part, &rest);
      points_try(twice);
      if (code == KILLED) wrong = after_kill(&j, code);
      if (wrong != NULL)
        points_lose(twice, "%s: killed at change %d, its restart at %d: %s",
                    j.name, at, part, wrong);
    }
    if (wrong == NULL) wrong = go_on(&whole, &j);
    if (wrong != NULL)
      points_lose(t, "%s: killed at change %d of %d: %s: %.200s", j.name, at,
                  changes, wrong, j.errors);
  }
  kept_mesh(NULL);
}

TEST(killed_run_goes_on) {
  points t = {.kind = "killed runs"}, twice = {.kind = "killed restarts"};
  long n = points_number(2, 0.0375);
  kill_often(&t, &twice, small_flat, "AUTO", 0.1, n);
  kill_often(&t, &twice, small_flat, "NEWTON", 10.0, n);
  kill_often(&t, &twice, small_solid, "SOR", 0.4, n);
  kill_often(&t, &twice, small_creep, "INTEGRATOR=MIDPOINT", 1.0, n);
  points_end(&t);
  points_end(&twice);
}

/* A number of 1 .. all, the next of a row that begins anywhere. */
static int at_random(unsigned long *row, int all) {
  *row = *row * 6364136223846793005u + 1442695040888963407u;
  return 1 + (int)((*row >> 33) % (unsigned long)all);
}

/* Killed, gone on with, killed again until a run comes to its end, which one
 * without kills does in the end; NULL or what is wrong. The first kill is not
 * among the last eighth of the changes: a quicker run makes fewer. */
static const char *chain(const job *whole, job *j, unsigned long row,
                         int changes, int *kills) {
  enum { LONGEST = 40 };
  const char *wrong = NULL;
  job_clear(j);
  int code = run(j, nothing, at_random(&row, changes - changes / 8), NULL);
  for (*kills = 0; code == KILLED && wrong == NULL; ++*kills) {
    wrong = after_kill(j, code);
    int at = *kills < LONGEST ? at_random(&row, changes) : 0;
    if (wrong == NULL) code = run(j, again, at, NULL);
  }
  if (wrong == NULL && code != 0) return "exit code";
  if (wrong == NULL && traced_difference(whole, j) != NULL)
    return "wrong files";
  return wrong;
}

static void kill_in_chains(points *t, make_job *make, const char *method,
                           double mu) {
  JOB whole = make(mu, "*RESTART\n", method);
  JOB j = make(mu, "*RESTART\n", method);
  long n = points_number(1, 0.005);
  int changes, kills, most = 0;
  kept_mesh(&whole);
  ck_assert_int_eq(run(&whole, nothing, 0, &changes), 0);
  for (long k = 0; k < n; ++k) {
    const char *wrong =
        chain(&whole, &j, (unsigned long)(k + t->tried), changes, &kills);
    if (kills > most) most = kills;
    points_try(t);
    if (wrong != NULL)
      points_lose(t, "%s, row %ld, kill %d: %s: %.200s", j.name, k, kills,
                  wrong, j.errors);
  }
  ck_assert_int_ge(most, 1);
  kept_mesh(NULL);
}

TEST(chain_of_kills_goes_on) {
  points t = {.kind = "chains of kills"};
  kill_in_chains(&t, small_flat, "AUTO", 0.1);
  kill_in_chains(&t, small_flat, "NEWTON", 10.0);
  kill_in_chains(&t, small_solid, "SOR", 0.4);
  kill_in_chains(&t, small_creep, "INTEGRATOR=MIDPOINT", 1.0);
  points_end(&t);
}

TEST(killed_over_old_results) {
  points t = {.kind = "killed over old results"};
  JOB j = small_flat(0.4, "*RESTART\n", "AUTO");
  ck_assert_int_eq(run(&j, nothing, 0, NULL), 0);
  for (int at = 1; told(&j) > 0 || at == 1; ++at) {
    const char *wrong = after_kill(&j, run(&j, nothing, at, NULL));
    points_try(&t);
    if (wrong != NULL) points_lose(&t, "killed at change %d: %s", at, wrong);
  }
  points_end(&t);
}

/* SIGINT at a change of a file and at the next one. */
static const char *after_second(const job *j, int at, int *changes) {
  traced t = {.action = TRACE_SIGNAL, .at = at, .number = SIGINT, .always = 1};
  job left = *j;
  left.errors = NULL;
  int code = traced_run(&left, nothing, &t);
  int early = code == 1000 + SIGINT && told(j) == 0; /* not yet caught */
  *changes = t.changes;
  free(left.errors);
  if (code != 130 && !early) return "not ended";
  if (t.changes > at + 1) return "not at once";
  return told(j) > 0 && kept(j) < told(j) ? "increment of .sta lost" : NULL;
}

static void interrupt_twice(points *t, make_job *make, const char *method) {
  JOB whole = make(0.4, "*RESTART\n", method);
  JOB j = make(0.4, "*RESTART\n", method);
  traced usual = {.action = TRACE_COUNT};
  int made;
  long n = points_number(1, 0.005);
  kept_mesh(&whole);
  ck_assert_int_eq(traced_run(&whole, nothing, &usual), 0);
  for (long k = 0; k < n; ++k) {
    int at = (int)points_spread(k, n, usual.changes - 1);
    job_clear(&j);
    const char *wrong = after_second(&j, at, &made);
    if (wrong == NULL) wrong = go_on(&whole, &j);
    points_try(t);
    if (wrong != NULL)
      points_lose(t, "%s: twice SIGINT at change %d of %d, ended at %d: %s",
                  j.name, at, usual.changes, made, wrong);
  }
  kept_mesh(NULL);
}

TEST(second_signal_ends_at_once) {
  points t = {.kind = "second SIGINT"};
  interrupt_twice(&t, small_flat, "AUTO");
  interrupt_twice(&t, small_creep, "INTEGRATOR=MIDPOINT");
  points_end(&t);
}

UNIT_MAIN_FOR("kills", 100 * UNIT_SECONDS)
