/*
 * Files that cannot be written: at a change of a file (opening, writing,
 * syncing, closing, renaming, cutting, removing) the system answers with an
 * error, once or from there on, or writes half.
 *
 * The run ends with a message that names a file and exit code 4 (or 5: no
 * memory), or it did without and all files are those of an undisturbed run.
 * After a failure --restart gives these files too.
 */
#include "support/kept_mesh.h"
#include "support/points.h"
#include "support/small_job.h"
#include "support/traced.h"
#include "support/unit.h"

#include <errno.h>

static const char *const nothing[] = {NULL, NULL};
static const char *const again[] = {"--restart", NULL};

static const struct {
  const char *kind;
  traced how;
} faults[] = {
    {"files, disk full", {.action = TRACE_ERROR, .number = ENOSPC}},
    {"files, disk full from one on",
     {.action = TRACE_ERROR, .number = ENOSPC, .always = 1}},
    {"files, I/O error", {.action = TRACE_ERROR, .number = EIO}},
    {"files, I/O error from one on",
     {.action = TRACE_ERROR, .number = EIO, .always = 1}},
    {"files, no right to write from one on",
     {.action = TRACE_ERROR, .number = EACCES, .always = 1}},
    {"files, interrupted call", {.action = TRACE_ERROR, .number = EINTR}},
    {"files, short write", {.action = TRACE_SHORT}},
};

/* NULL, or what is wrong after the restart of a run that failed. */
static const char *restart_fault(const job *whole, job *j) {
  if (traced_run(j, again, NULL) != 0) return "restart: exit code";
  return traced_difference(whole, j) == NULL ? NULL : "restart: wrong files";
}

/* last: nothing can be changed from the fault on, not even JSON, which is
 * written before the exit code in the listing. */
static const char *fault(const job *whole, job *j, int code, int last) {
  if (code == 0)
    return traced_difference(whole, j) == NULL ? NULL : "wrong files";
  if (code != 4 && code != 5) return "exit code";
  if (strstr(j->errors, "error") == NULL) return "no message";
  if (strstr(j->errors, j->name) == NULL) return "file not named";
  if (!last && job_contradiction(j, code) != NULL)
    return "another exit code in a file";
  return restart_fault(whole, j);
}

/* The job under one fault at n changes. */
static void disturb(points *t, traced how, job *whole, job *j, long n) {
  traced usual = {.action = TRACE_COUNT, .timed = 1};
  char errors[200];
  how.timed = 1;
  kept_mesh(whole);
  ck_assert_int_eq(traced_run(whole, nothing, &usual), 0);
  for (long k = 0; k < n && k < usual.changes; ++k) {
    how.at = (int)points_spread(k, n, usual.changes);
    job_clear(j);
    int code = traced_run(j, nothing, &how);
    if (how.changes < how.at) { /* JOB.xdmf is rewritten by time */
      how.at = how.changes / 2;
      job_clear(j);
      code = traced_run(j, nothing, &how);
    }
    snprintf(errors, sizeof errors, "%.190s", j->errors);
    const char *wrong = fault(whole, j, code, how.always);
    points_try(t);
    if (wrong != NULL)
      points_lose(t, "%s: change %d of %d: %s; exit %d: %s", j->name, how.at,
                  usual.changes, wrong, code, errors);
  }
  kept_mesh(NULL);
}

TESTS(file_cannot_be_changed, sizeof faults / sizeof *faults) {
  points t = {.kind = faults[_i].kind};
  long n = points_number(1, 0.035 / (sizeof faults / sizeof *faults));
  const char *cards = "*RESTART\n";
  job whole[] = {small_flat(0.4, cards, "AUTO"), small_solid(0.4, cards, "SOR"),
                 small_creep(0.4, cards, "INTEGRATOR=MIDPOINT")};
  job cut[] = {small_flat(0.4, cards, "AUTO"), small_solid(0.4, cards, "SOR"),
               small_creep(0.4, cards, "INTEGRATOR=MIDPOINT")};
  for (int k = 0; k < 3; ++k) {
    if (points_all() || k == _i % 3)
      disturb(&t, faults[_i].how, &whole[k], &cut[k], n);
    job_end(&whole[k]);
    job_end(&cut[k]);
  }
  points_end(&t);
}

UNIT_MAIN_FOR("files", 10 * UNIT_SECONDS)
