/*
 * Little memory, and many increments: a run under ulimit -v or --max-memory of
 * any size ends with exit code 5 and says so, or with the files of a run
 * without limit; more increments than five digits come to their end.
 */
#include "support/block_file.h"
#include "support/points.h"
#include "support/traced.h"
#include "support/unit.h"

#include <sys/wait.h>

static job block(int squares, int increments) {
  static const double length[2] = {1.0, 1.0};
  job j = job_begin("block");
  block_file_write(&j, (const int[2]){squares, squares}, length, 0);
  job_write(&j, "block.inp",
            "*MESH, FILE=block.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
            "*CONTACT, NAME=C, GROUP=CONTACT, OBSTACLE=O\n"
            "*FRICTION, CONTACT=C, LAW=COULOMB\n0.4\n*STEP\n*QUASISTATIC\n"
            "%.17g, 1.\n*BOUNDARY\nTOP, 1, 1, 0.002\nTOP, 2, 2, -0.01\n"
            "*OUTPUT\n*END STEP\n",
            1.0 / increments);
  return j;
}

/* Behind a command of the shell; exit code, or 1000 + signal. */
static int run_behind(job *j, const char *first, const char *words) {
  const char *program = getenv("PROTIS");
  job told = *j;
  if (program == NULL) program = "build/release/protis";
  PRINTED(line,
          "%s; exec '%s' '%s/%s' --no-timing --quiet %s > '%s/stdout.txt' "
          "2> '%s/stderr.txt'",
          first, program, j->dir, j->name, words, j->dir, j->dir);
  int code = system(line);
  snprintf(told.name, sizeof told.name, "stderr");
  free(j->errors);
  j->errors = job_file(&told, "txt");
  return WIFEXITED(code) ? WEXITSTATUS(code) : 1000 + WTERMSIG(code);
}

/* Too little for the libraries: the program never began. */
static int never_began(const job *j, int code) {
  return code == 127 && strstr(j->errors, "shared librar") != NULL;
}

/* 1: it was refused. */
static int judge(points *t, const job *whole, const job *j, int code,
                 const char *limit) {
  const char *wrong = NULL;
  if (code == 0)
    wrong = traced_difference(whole, j) == NULL ? NULL : "wrong files";
  else if (code != 5 || strstr(j->errors, "emory") == NULL)
    wrong = "exit code or message";
  points_try(t);
  if (wrong != NULL)
    points_lose(t, "%s: %s: exit %d: %.200s", limit, wrong, code, j->errors);
  return code == 5;
}

/* Sizes from what the libraries take to what the run is content with. */
TESTS(little_memory_is_told, 2) {
  points t = {.kind = "little memory"};
  const int squares = _i == 0 ? 6 : 60;
  const long n = points_number(6, 0.01);
  JOB whole = block(squares, 4), j = block(squares, 4);
  char limit[60];
  long refused = 0;
  ck_assert_int_eq(run_behind(&whole, "true", ""), 0);
  for (long k = 0; k < n; ++k) {
    snprintf(limit, sizeof limit, "ulimit -v %ld",
             60000 + 4000 * points_spread(k, n, 150));
    int code = run_behind(&j, limit, "");
    if (!never_began(&j, code)) refused += judge(&t, &whole, &j, code, limit);
    snprintf(limit, sizeof limit, "--max-memory %ld", points_spread(k, n, 60));
    refused += judge(&t, &whole, &j, run_behind(&j, "true", limit), limit);
  }
  points_end(&t);
  ck_assert(refused > 0 && refused < t.tried);
}

/* In the long run alone: minutes. */
TEST(many_increments_end) {
  enum { MANY = 100001 };
  points t = {.kind = "increments, 100,001"};
  int lines = 0;
  if (getenv("PROTIS_POINTS") == NULL) return;
  JOB j = block(1, MANY);
  int code = run_behind(&j, "true", "");
  FREED char *sta = job_file(&j, "sta");
  for (const char *p = sta; p != NULL && *p != '\0'; ++p) lines += *p == '\n';
  points_try(&t);
  if (code != 0 || lines != MANY + 1)
    points_lose(&t, "exit %d, %d lines: %.200s", code, lines, j.errors);
  points_end(&t);
}

UNIT_MAIN_FOR("limits", 100 * UNIT_SECONDS)
