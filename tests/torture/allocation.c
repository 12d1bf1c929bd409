/*
 * Requests for memory that are refused, one at a time or from one on, in whole
 * runs: of the program, its libraries, the C library (tests/preload/refuse.c).
 *
 * Where the program itself or a solver of its linear systems is refused, it
 * ends with exit code 5, says so and leaves nothing allocated. Elsewhere the
 * library may do without (then all files are those of an undisturbed run) or
 * give up: 4, 5 or 7 with a message.
 */
#include "support/kept_mesh.h"
#include "support/points.h"
#include "support/small_job.h"
#include "support/traced.h"
#include "support/unit.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

typedef struct refusal {
  long at;
  int always, in_child;
  int own; /* 1: counted are the requests of the program itself             */
} refusal;

typedef struct outcome_of_run {
  int code;      /* 1000 + signal                                            */
  long requests; /* of the run; -1: it did not come to its end               */
  long leaked;
  char by; /* who was refused first: P the program, L a library        */
} outcome_of_run;

static const char *setting(const char *name, const char *usual) {
  const char *p = getenv(name);
  return p == NULL ? usual : p;
}

static void set_number(const char *name, long value) {
  PRINTED(text, "%ld", value);
  setenv(name, text, 1);
}

static void become_job(const job *j, const refusal *r) {
  PRINTED(deck, "%s/%s", j->dir, j->name);
  PRINTED(told, "%s/told", j->dir);
  PRINTED(errors, "%s/stderr.txt", j->dir);
  int to = open(errors, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (dup2(to, STDERR_FILENO) < 0 || dup2(to, STDOUT_FILENO) < 0) _exit(99);
  set_number("REFUSE_AT", r->at);
  set_number("REFUSE_ALWAYS", r->always);
  set_number("REFUSE_CHILD", r->in_child);
  set_number("REFUSE_OWN", r->own);
  setenv("REFUSE_TOLD", told, 1);
  kept_mesh_preload(
      setting("PROTIS_REFUSE", "build/release/tests/preload/refuse.so"));
  alarm(UNIT_SECONDS / 2);
  const char *program = setting("PROTIS", "build/release/protis");
  execl(program, program, deck, "--no-timing", (char *)NULL);
  _exit(99);
}

static outcome_of_run run(job *j, const refusal *r) {
  outcome_of_run o = {.requests = -1, .by = '-'};
  job told = *j;
  int code;
  snprintf(told.name, sizeof told.name, "told");
  char path[200];
  snprintf(path, sizeof path, "%s/told.by", j->dir);
  unlink(path);
  snprintf(path, sizeof path, "%s/told.end", j->dir);
  unlink(path);
  pid_t pid = fork();
  ck_assert_int_ge(pid, 0);
  if (pid == 0) become_job(j, r);
  ck_assert_int_eq(waitpid(pid, &code, 0), pid);
  o.code = WIFEXITED(code) ? WEXITSTATUS(code) : 1000 + WTERMSIG(code);
  char *by = job_file(&told, "by"), *end = job_file(&told, "end");
  if (by != NULL) o.by = by[0];
  if (end != NULL) sscanf(end, "%ld %ld", &o.requests, &o.leaked);
  free(by);
  free(end);
  snprintf(told.name, sizeof told.name, "stderr");
  free(j->errors);
  j->errors = job_file(&told, "txt");
  return o;
}

/* NULL, or what is wrong with the end of a disturbed run. */
static const char *fault(const job *whole, const job *j,
                         const outcome_of_run *o) {
  static const int mild[] = {4, 5, 7};
  int ended = 0;
  if (o->code == 0)
    return traced_difference(whole, j) == NULL ? NULL : "wrong files";
  if (strstr(j->errors, "error") == NULL) return "no message";
  if (o->leaked > 0) return "leak";
  if (o->by == 'P') {
    if (o->code != 5) return "not exit 5";
    return strstr(j->errors, "emory") == NULL ? "memory not named" : NULL;
  }
  for (size_t k = 0; k < sizeof mild / sizeof *mild; ++k)
    ended |= o->code == mild[k];
  return ended ? NULL : "exit code";
}

typedef job make_job(double mu, const char *cards, const char *method);

static const struct {
  const char *kind;
  make_job *make;
  const char *method;
} jobs[] = {{"plane, NEWTON", small_flat, "AUTO"},
            {"space, SOR", small_solid, "SOR"},
            {"flow, MIDPOINT", small_creep, "INTEGRATOR=MIDPOINT"}};

static void starve(points *t, size_t which, refusal r, long n) {
  static const char once[] = "*RESTART, FREQUENCY=0\n";
  job whole = jobs[which].make(0.4, once, jobs[which].method);
  job j = jobs[which].make(0.4, once, jobs[which].method);
  kept_mesh(&whole);
  r.at = 0;
  outcome_of_run usual = run(&whole, &r);
  ck_assert_int_eq(usual.code, 0);
  ck_assert_int_gt(usual.requests, 0);
  ck_assert_int_eq(usual.leaked, 0);
  for (long k = 0; k < n && k < usual.requests; ++k) {
    r.at = points_spread(k, n, usual.requests);
    outcome_of_run o = run(&j, &r);
    const char *wrong = fault(&whole, &j, &o);
    points_try(t);
    if (wrong != NULL)
      points_lose(t, "%s: request %ld of %ld by %c: %s; exit %d: %.200s",
                  jobs[which].kind, r.at, usual.requests, o.by, wrong, o.code,
                  j.errors);
  }
  kept_mesh(NULL);
  job_end(&whole);
  job_end(&j);
}

static const struct {
  const char *kind;
  refusal how;
  long few;
  double share;
} kinds[] = {{"memory, program, one request", {.own = 1}, 3, 0.15},
             {"memory, program, from one on", {.own = 1, .always = 1}, 3, 0.15},
             {"memory, libraries, one request", {.own = 0}, 2, 0.115},
             {"memory, libraries, from one on", {.always = 1}, 2, 0.115}};

TESTS(requests_are_refused, sizeof kinds / sizeof *kinds) {
  points t = {.kind = kinds[_i].kind};
  for (size_t k = 0; k < sizeof jobs / sizeof *jobs; ++k)
    starve(&t, k, kinds[_i].how, points_number(kinds[_i].few, kinds[_i].share));
  points_end(&t);
}

/* In the process that reads the mesh: a failure of the mesh reader or want of
 * memory, or the mesh is as it was. */
TEST(mesh_reader_is_starved) {
  points t = {.kind = "memory, mesh reader"};
  kept_mesh(NULL);
  long n = points_number(4, 0.01);
  job whole = small_flat(0.4, "", "AUTO"), j = small_flat(0.4, "", "AUTO");
  ck_assert_int_eq(run(&whole, &(refusal){0}).code, 0);
  for (long k = 0; k < n; ++k) {
    refusal r = {.at = 1 + k * k * 200000 / (n * n),
                 .always = k % 2 == 1,
                 .in_child = 1};
    outcome_of_run o = run(&j, &r);
    points_try(&t);
    int fine = o.code == 3 || o.code == 5
                   ? strstr(j.errors, "error") != NULL
                   : o.code == 0 && traced_difference(&whole, &j) == NULL;
    if (!fine)
      points_lose(&t, "request %ld: exit %d: %.200s", r.at, o.code, j.errors);
  }
  points_end(&t);
  job_end(&whole);
  job_end(&j);
}

/* Where HDF5 is linked into the program, its requests are not the program's:
 * the first and the last of its functions. */
static void tell_library(void) {
  char line[500], range[80] = "";
  const char *program = setting("PROTIS", "build/release/protis");
  snprintf(line, sizeof line,
           "nm -n '%s' | grep -v cold | grep ' [tT] H5' | "
           "sed -n '1s/ .*//p;$s/ .*//p' | tr '\\n' ' '",
           program);
  FILE *f = popen(line, "r");
  if (f != NULL && fgets(range, sizeof range, f) != NULL)
    setenv("REFUSE_LIBRARY", range, 1);
  if (f != NULL) pclose(f);
}

int main(void) {
  tell_library();
  return unit_run("allocation", 100 * UNIT_SECONDS);
}
