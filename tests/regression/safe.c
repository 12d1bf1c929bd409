/*
 * protis --safe: what a deck names is read only where it is a plain file below
 * the folder of the deck, and never runs.
 */
#include "support/fclib_file.h"
#include "support/job.h"
#include "support/unit.h"

#include <sys/stat.h>
#include <unistd.h>

/* Decks that read FILE, by each card that names one. */
static const struct {
  const char *card, *file, *deck;
} readers[] = {
#define BODY                                                 \
  "*MATERIAL, NAME=M\n*ELASTIC\n1., 0.\n*EXPANSION\n1.E-5\n" \
  "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
#define STEP "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1, 2\n*OUTPUT, HDF5=NO\n"
    {"INCLUDE", "part.inc",
     "*MESH, FILE=square.msh\n*INCLUDE, INPUT=%s\n" BODY STEP "*END STEP\n"},
    {"MESH", "square.msh", "*MESH, FILE=%s\n" BODY STEP "*END STEP\n"},
    {"TEMPERATURE", "field.h5",
     "*MESH, FILE=square.msh\n" BODY STEP
     "*TEMPERATURE, FILE=%s\nBODY\n*END STEP\n"},
    {"INITIAL CONDITIONS", "start.h5",
     "*MESH, FILE=square.msh\n" BODY
     "*INITIAL CONDITIONS, TYPE=DISPLACEMENT, FILE=%s\n" STEP "*END STEP\n"},
    {"CONDENSED PROBLEM", "problem.h5",
     "*CONDENSED PROBLEM, FILE=%s\n*STEP\n*STATIC\n*END STEP\n"},
    {"CONDENSED PROBLEM", "problem.txt",
     "*CONDENSED PROBLEM, FILE=%s\n*STEP\n*STATIC\n*END STEP\n"}};
enum { N_READER = sizeof readers / sizeof *readers };

static void write_field(const job *j) {
  int no[100];
  double value[100] = {0};
  for (int i = 0; i < 100; ++i) no[i] = i + 1;
  PRINTED(path, "%s/field.h5", j->dir);
  hid_t file = fclib_begin(path);
  fclib_ints(file, "/node_no", 100, no);
  fclib_reals(file, "/temperature", 100, value);
  fclib_end(file);
}

static void write_problem(const job *j) {
  const double W[4] = {1, 0, 0, 1}, q[2] = {1, 0}, mu = 0.5;
  PRINTED(path, "%s/problem.h5", j->dir);
  fclib_local(path, STORE_TRIPLET, 2, 1, W, q, &mu);
}

/* A folder with all the files, and the end of a run. */
static job begin(void) {
  job j = job_begin("start");
  job_copy(&j, "tests/regression/bad/square.msh");
  job_write(&j, "part.inc", "** nothing\n");
  job_write(&j, "problem.txt", "1\n1 -1\n");
  job_write(&j, "start.inp",
            "*MESH, FILE=square.msh\n" BODY
            "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1, 2\n*END STEP\n");
  write_field(&j);
  write_problem(&j);
  CK_EXIT(job_run(&j, "--safe"), 0, j);
  return j;
}

static int run(job *j, int reader, const char *file, const char *words) {
  snprintf(j->name, sizeof j->name, "job");
  job_write(j, "job.inp", readers[reader].deck, file);
  return job_run(j, words);
}

TEST(plain_files_below_the_deck_are_read) {
  JOB j = begin();
  for (int k = 0; k < N_READER; ++k)
    for (int up = 0; up < 2; ++up) {
      PRINTED(folder, "%s/sub", j.dir);
      mkdir(folder, 0777);
      PRINTED(file, "%s%s", up ? "sub/../" : "", readers[k].file);
      int code = run(&j, k, file, "--safe");
      ck_assert_msg(code == 0, "%s, %s: exit %d: %s", readers[k].card, file,
                    code, j.errors);
    }
}

/* Each way out of the folder, for each card: refused, and nothing waits. */
TEST(nothing_else_is_read) {
  static const char *const ways[] = {"link", "away/", "../", "full", "fifo"};
  JOB j = begin(), k = begin();
  char from[600], to[400];
  snprintf(from, sizeof from, "%s/away", j.dir);
  ck_assert_int_eq(symlink(k.dir, from), 0);
  for (int c = 0; c < N_READER; ++c)
    for (int w = 0; w < 5; ++w) {
      const char *file = readers[c].file, *dot = strrchr(file, '.');
      char name[500];
      snprintf(name, sizeof name, "way%d_%d%s", c, w, dot);
      snprintf(from, sizeof from, "%s/%s", j.dir, name);
      snprintf(to, sizeof to, "%s/%s", k.dir, file);
      if (w == 0) ck_assert_int_eq(symlink(to, from), 0);
      if (w == 1) snprintf(name, sizeof name, "away/%s", file);
      if (w == 2)
        snprintf(name, sizeof name, "../%s/%s", strrchr(k.dir, '/') + 1, file);
      if (w == 3) snprintf(name, sizeof name, "%s", to);
      if (w == 4) ck_assert_int_eq(mkfifo(from, 0666), 0);
      int code = run(&j, c, name, "--safe");
      ck_assert_msg(code >= 2 && code <= 4, "%s, %s %s: exit %d: %s",
                    readers[c].card, ways[w], name, code, j.errors);
      if (w < 4) { /* without --safe all of them are there                   */
        code = run(&j, c, name, "");
        ck_assert_msg(code == 0, "%s, %s: exit %d: %s", readers[c].card, name,
                      code, j.errors);
      }
    }
}

/* A geometry is a program; what bears another name is data. */
TEST(a_mesh_is_a_msh) {
  static const char *const names[] = {"square.geo", "square.GEO", "square.step",
                                      "square.msh.opt", "square"};
  JOB j = begin();
  for (int i = 0; i < 5; ++i) {
    job_write(&j, names[i], "SystemCall \"touch %s/job.ran\";\n", j.dir);
    ck_assert_int_eq(run(&j, 1, names[i], "--safe"), i < 2 ? 2 : 3);
    ck_assert_ptr_nonnull(strstr(
        j.errors, i < 2 ? "the mesh must be a .msh" : "is no .geo and does"));
    ck_assert(!job_has(&j, "ran"));
  }
}

UNIT_MAIN("safe")
