/*
 * Calls of the C library and of HDF5 that fail, in small runs of every kind:
 * memory refused, files that cannot be opened, written, closed, renamed,
 * objects of HDF5 that cannot be made. Each way on which a failure is handed up
 * is gone once (preload/failing.h); the tests of every day try some of them,
 * with PROTIS_CALLS in the environment all.
 *
 * The run ends with the exit code of what failed (5 memory; 2, 3, 4 the deck,
 * the mesh, another file) and a message, or it did without and its files are
 * those of an undisturbed run. It holds no memory and no object of HDF5, leaves
 * no file it made aside, no lock, and whole files of results.
 */
#include "preload/failing.h"
#include "support/call_decks.h"
#include "support/points.h"
#include "support/small_job.h"
#include "support/traced.h"
#include "support/unit.h"

#include <errno.h>
#include <glob.h>

enum { PATH = 300, WORDS = 20 };

/* ---- runs ---- */

/* The program on the job with these words; what it says into j->errors. */
static int run(job *j, const char *words, failing_end *end) {
  char deck[PATH];
  char *argv[WORDS] = {"protis", deck, "--no-timing"}, *save = NULL;
  int argc = 3;
  snprintf(deck, sizeof deck, "%s/%s.inp", j->dir, j->name);
  PRINTED(told, "%s/stderr.txt", j->dir);
  PRINTED(text, "%s", words);
  for (char *w = strtok_r(text, " ", &save); w != NULL && argc < WORDS - 1;
       w = strtok_r(NULL, " ", &save))
    argv[argc++] = w;
  int code = failing_run(argc, argv, told, end);
  job said = *j;
  snprintf(said.name, sizeof said.name, "stderr");
  free(j->errors);
  j->errors = job_file(&said, "txt");
  return code;
}

static void command(const job *j, const char *what) {
  PRINTED(line, "cd '%s' && %s", j->dir, what);
  ck_assert_int_eq(system(line), 0);
}

/* ---- scenes ---- */

static job flat(void) {
  return small_flat(0.4, "*RESTART\n*ACCURACY, THEORY=YES\n",
                    "AUTO, CHECK=YES");
}

static job solid(void) { return small_solid(0.4, "*RESTART\n", "SOR"); }

static job creep(void) {
  return small_creep(0.4, "*RESTART\n", "INTEGRATOR=MIDPOINT");
}

/* Stopped by a file that could not be written: what is there is kept. */
static job stopped(job j) {
  failing_end end;
  failing_at(&(failing_point){FAILING_rename, 5});
  ck_assert_int_eq(run(&j, "", &end), 4);
  failing_at(NULL);
  ck_assert_int_eq(end.reached, 1);
  ck_assert(job_has(&j, "rst.h5"));
  command(&j, "mkdir kept && cp -p *.* kept/");
  return j;
}

static job stopped_flat(void) {
  return stopped(small_flat(0.4, "*RESTART\n", "AUTO, CHECK=YES"));
}

static job stopped_creep(void) { return stopped(creep()); }

/* A problem that another run has written. */
static job discrete(void) {
  job j = small_flat(0.4, "*OUTPUT, CONDENSED=FCLIB\n", "AUTO");
  failing_end end;
  ck_assert_msg(run(&j, "", &end) == 0, "%s", j.errors);
  snprintf(j.name, sizeof j.name, "back");
  job_write(&j, "back.inp",
            "*CONDENSED PROBLEM, FILE=block_condensed_00002.h5\n*STEP\n"
            "*SOLVER, TOL=1e-10\n*OUTPUT, CONDENSED=FCLIB\n*END STEP\n");
  return j;
}

static job example(const char *deck) {
  job j = job_begin(strrchr(deck, '/') + 1);
  PRINTED(path, "%s.inp", deck);
  job_copy(&j, path);
  job_copy_meshes(&j, deck);
  return j;
}

static const struct {
  const char *kind;  /* or the deck of an example                            */
  job (*make)(void); /* NULL: the example                                    */
  const char *words;
} scenes[] = {
    {"plane", flat, ""},
    {"space", solid, ""},
    {"flow", creep, ""},
    {"restart", stopped_flat, "--restart"},
    {"restart of a flow", stopped_creep, "--restart"},
    {"problem", discrete, ""},
    {"input/hild_triangle/hild_triangle", NULL, ""},
    {"input/norton_ring/norton_ring", NULL, "-D N=6"},
    {"input/spence/spence", NULL, "-D NC=4"},
};

/* ---- what is expected ---- */

/* NULL, or what the run left behind. */
static const char *litter(const job *j) {
  static const char *const patterns[] = {"*.tmp", "*.lock"};
  static const char *const suffixes[] = {"h5", "rst.h5", "rst.old.h5"};
  char path[PATH];
  for (size_t k = 0; k < sizeof patterns / sizeof *patterns; ++k) {
    glob_t found;
    snprintf(path, sizeof path, "%s/%s", j->dir, patterns[k]);
    int there = glob(path, 0, NULL, &found) == 0;
    globfree(&found);
    if (there) return patterns[k];
  }
  for (size_t k = 0; k < sizeof suffixes / sizeof *suffixes; ++k) {
    if (!job_has(j, suffixes[k])) continue;
    snprintf(path, sizeof path, "%s/%s.%s", j->dir, j->name, suffixes[k]);
    hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    if (file < 0) return suffixes[k];
    H5Fclose(file);
  }
  return NULL;
}

/* 1: they differ in room that could not be cut off in the end. */
static int keeps_room(const char *suffix, const job *whole, const job *j) {
  struct stat a, b;
  PRINTED(one, "%s/%s.h5", whole->dir, whole->name);
  PRINTED(other, "%s/%s.h5", j->dir, j->name);
  return strcmp(suffix, "h5") == 0 && stat(one, &a) == 0 &&
         stat(other, &b) == 0 && b.st_size > a.st_size;
}

/* 1: a call of the system itself, which leaves its reason. */
static int has_reason(failing_call call) {
  const char *name = failing_name(call);
  return failing_kind_of(call) == FAILING_FILE && call != FAILING_ferror &&
         strncmp(name, "H5", 2) != 0 && strncmp(name, "archive", 7) != 0;
}

/* NULL, or what is wrong with the end of a run that failed. What could not be
 * asked of the system is told as that, not as an answer. */
static const char *wrong_end(failing_call call, const job *j, int code) {
  static const struct {
    int from, to; /* exit codes                                              */
    const char *said, *wrong;
  } ends[] = {
      [FAILING_MEMORY] = {5, 5, "emory", "not exit 5 for want of memory"},
      [FAILING_FILE] = {2, 5, "error", "not exit 2 to 5 with a message"},
      [FAILING_VALUE] = {2, 2, ".inp:", "not exit 2 with its place"},
      [FAILING_SIGNAL] = {130, 130, "interrupted", "not exit 130"},
  };
  const failing_kind kind = failing_kind_of(call);
  if (code < ends[kind].from || code > ends[kind].to ||
      strstr(j->errors, ends[kind].said) == NULL)
    return ends[kind].wrong;
  if (has_reason(call) && code != 5 && strstr(j->errors, strerror(EIO)) == NULL)
    return "reason not told";
  const int named = strstr(j->errors, j->dir) != NULL ||
                    strstr(j->errors, "standard output: ") != NULL;
  return code != 4 || named ? NULL : "file not named";
}

static const char *fault(const job *whole, const job *j, const failing_point *p,
                         int code, const failing_end *end) {
  const char *other = NULL;
  if (!end->reached) return "not reached";
  if (end->held > 0) return "memory is not released";
  if (end->opened > 0) return "objects of HDF5 are not closed";
  if (code == 0)
    other = traced_difference(whole, j);
  else
    other = wrong_end(p->call, j, code);
  if (other != NULL && (code != 0 || !keeps_room(other, whole, j)))
    return other;
  return litter(j);
}

static void restore(const job *j) {
  command(j, "if [ -d kept ]; then cp -p kept/* .; fi");
}

/* The job is ended. */
static void try_scene(points *t, const char *kind, job j, const char *words) {
  const failing_point *list;
  failing_end end;
  job whole = j;
  ck_assert_msg(run(&j, words, &end) == 0, "%s", j.errors);
  /* Its files aside, to compare with. */
  snprintf(whole.dir, sizeof whole.dir, "%.55s/whole", j.dir);
  command(&j, "mkdir whole && cp -p *.* whole/");
  restore(&j);
  failing_watch();
  ck_assert_msg(run(&j, words, &end) == 0, "%s", j.errors);
  int all = failing_points(&list);
  long n = getenv("PROTIS_CALLS") != NULL ? all : points_number(5, 0.02);
  long missed = 0, tried = n < all ? n : all;
  for (long k = 0; k < tried; ++k) {
    const failing_point *p = &list[points_spread(k, n, all) - 1];
    job_clear(&j);
    restore(&j);
    failing_at(p);
    int code = run(&j, words, &end);
    failing_at(NULL);
    /* JOB.xdmf is rewritten by time: there are fewer calls in a quicker run. */
    if (!end.reached && code == 0 && traced_difference(&whole, &j) == NULL) {
      ck_assert_int_le(20 * ++missed, 20 + tried);
      continue;
    }
    const char *wrong = fault(&whole, &j, p, code, &end);
    points_try(t);
    if (wrong != NULL)
      points_lose(t, "%s: %s number %ld: %s; exit %d: %.200s", kind,
                  failing_name(p->call), p->number, wrong, code, j.errors);
    if (wrong != NULL) printf("%s\n", j.errors);
  }
  failing_at(NULL);
  job_end(&j);
}

static job from_deck(const call_deck *d) {
  job j = call_deck_write(d);
  failing_end end;
  if (strcmp(d->words, "--restart") == 0) return stopped(j);
  if (d->first == NULL) return j;
  snprintf(j.name, sizeof j.name, "first");
  ck_assert_msg(run(&j, "", &end) == 0, "%s", j.errors);
  snprintf(j.name, sizeof j.name, "run");
  return j;
}

/* Some of them without PROTIS_CALLS and PROTIS_POINTS. */
static int is_tried(size_t k) {
  enum { OFTEN = 10 };
  return getenv("PROTIS_CALLS") != NULL || getenv("PROTIS_POINTS") != NULL ||
         k % OFTEN == 0;
}

TEST(call_fails) {
  enum { OWN = sizeof scenes / sizeof *scenes };
  points t = {.kind = "calls"};
  JOB meshes = job_begin("meshes");
  failing_setup(meshes.dir);
  for (size_t k = 0; k < OWN; ++k)
    if (is_tried(k))
      try_scene(
          &t, scenes[k].kind,
          scenes[k].make == NULL ? example(scenes[k].kind) : scenes[k].make(),
          scenes[k].words);
  for (size_t k = 0; k < (size_t)n_call_deck; ++k)
    if (is_tried(k + OWN))
      try_scene(&t, call_decks[k].kind, from_deck(&call_decks[k]),
                call_decks[k].words);
  points_end(&t);
}

UNIT_MAIN_FOR("calls", 100 * UNIT_SECONDS)
