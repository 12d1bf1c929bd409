/*
 * A run that is interrupted or killed and then gone on with, against the run
 * that was not: all files equal, byte by byte. The points of interruption are
 * counted in writes (the run is traced), so that nothing depends on time.
 */
#include "support/job.h"
#include "support/unit.h"

#include <fcntl.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <sys/ptrace.h>
#include <sys/syscall.h>
#include <sys/user.h>
#include <sys/wait.h>
#include <unistd.h>

enum { KILLED = 1000 + SIGKILL };

/* ---- a run that is stopped at a write ----------------------------------- */

static const char *program(void) {
  const char *p = getenv("PROTIS");
  return p == NULL ? "build/release/protis" : p;
}

/* The job with further words (at most two), traced. */
static pid_t start(const job *j, const char *const *words) {
  char deck[200];
  snprintf(deck, sizeof deck, "%s/%s", j->dir, j->name);
  pid_t pid = fork();
  ck_assert_int_ge(pid, 0);
  if (pid > 0) return pid;
  char told[200];
  snprintf(told, sizeof told, "%s/stderr.txt", j->dir);
  int to = open(told, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (dup2(to, STDERR_FILENO) < 0 || dup2(to, STDOUT_FILENO) < 0) _exit(99);
  if (ptrace(PTRACE_TRACEME, 0, NULL, NULL) != 0) _exit(98);
  execl(program(), program(), deck, "--no-timing", words[0], words[1],
        (char *)NULL);
  _exit(99);
}

/* 1: a call that changes a file. */
static int changes_file(pid_t pid) {
  struct user_regs_struct regs;
  ck_assert_int_eq(ptrace(PTRACE_GETREGS, pid, NULL, &regs), 0);
  switch (regs.orig_rax) {
    case SYS_write:
    case SYS_pwrite64:
    case SYS_fsync:
    case SYS_rename:
    case SYS_ftruncate:
    case SYS_unlink:
      return 1;
    default:
      return 0;
  }
}

/* Give it the signal at change number "at"; *changes counts all. Exit code, or
 * 1000 + signal. */
static int run_until(const job *j, const char *const *words, int at,
                     int signal_no, int *changes) {
  pid_t pid = start(j, words);
  int code, enters = 0;
  long send = 0;
  *changes = 0;
  ck_assert_int_eq(waitpid(pid, &code, 0), pid);
  ck_assert_msg(WIFSTOPPED(code), "cannot be traced: %x", code);
  ptrace(PTRACE_SETOPTIONS, pid, NULL, PTRACE_O_TRACESYSGOOD);
  while (ptrace(PTRACE_SYSCALL, pid, NULL, send) == 0) {
    ck_assert_int_eq(waitpid(pid, &code, 0), pid);
    if (WIFEXITED(code)) return WEXITSTATUS(code);
    if (WIFSIGNALED(code)) return 1000 + WTERMSIG(code);
    int is_call = WSTOPSIG(code) == (SIGTRAP | 0x80);
    send = is_call ? 0 : WSTOPSIG(code);
    enters = is_call ? !enters : enters;
    if (!is_call || !enters || !changes_file(pid)) continue;
    if (++*changes == at) ck_assert_int_eq(kill(pid, signal_no), 0);
  }
  ck_assert_int_eq(waitpid(pid, &code, 0), pid);
  return WIFEXITED(code) ? WEXITSTATUS(code) : 1000 + WTERMSIG(code);
}

static const char *const nothing[] = {NULL, NULL};

/* ---- comparing ---------------------------------------------------------- */

/* All files of the results are equal, byte by byte. */
static void same_files(const job *a, const job *b, const char *what) {
  static const char *const files[] = {"lst", "sta",  "cvg", "dat",
                                      "h5",  "xdmf", "json"};
  for (size_t k = 0; k < sizeof files / sizeof *files; ++k) {
    char command[300];
    snprintf(command, sizeof command, "cmp %s/%s.%s %s/%s.%s 1>&2", a->dir,
             a->name, files[k], b->dir, b->name, files[k]);
    ck_assert_msg(system(command) == 0, "%s: .%s differs", what, files[k]);
  }
}

/* ---- decks -------------------------------------------------------------- */

/* A block in the plane, pressed and moved to and fro by its top. */
static job flat_block(double mu, const char *cards, const char *method) {
  job j = job_begin("block");
  job_copy(&j, "input/greco/greco.geo");
  job_write(&j, "block.inp",
            "*PARAMETER\nN = 8\n*MESH, FILE=greco.geo\n*MATERIAL, NAME=M\n"
            "*ELASTIC\n130.D3, 0.2\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
            "*CONTACT, NAME=C, GROUP=CONTACT, OBSTACLE=O\n"
            "*FRICTION, CONTACT=C, LAW=COULOMB\n%g\n*STEP\n*QUASISTATIC\n"
            "0.25, 1.\n*BOUNDARY\nTOP, 2, 2, -0.02\nTOP, 1, 1, 0.02\n"
            "*SOLVER, METHOD=%s\n*PRINT, CONTACT, LOOP\n*OUTPUT\n%s"
            "*END STEP\n*STEP\n*QUASISTATIC\n0.25, 1.\n"
            "*BOUNDARY\nTOP, 1, 1, -0.01\n*END STEP\n",
            mu, method, cards);
  return j;
}

/* A block in space, pressed, sheared and turned aside. */
static job solid_block(double mu, const char *cards, const char *method) {
  job j = job_begin("solid");
  job_copy(&j, "input/block_shear_3d/block_shear_3d.geo");
  job_write(&j, "solid.inp",
            "*PARAMETER\nN = 4\nNZ = 2\n*MESH, FILE=block_shear_3d.geo\n"
            "*MATERIAL, NAME=M\n*ELASTIC\n210.D3, 0.3\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0., 0.\n0., 0., 1.\n"
            "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
            "*FRICTION, CONTACT=C, LAW=COULOMB\n%g\n*STEP\n*QUASISTATIC\n"
            "0.5, 1.\n*BOUNDARY\nTOP, 1, 1, 0.03\nTOP, 2, 2, 0.\n"
            "TOP, 3, 3, -0.02\n*SOLVER, METHOD=%s\n*PRINT, CONTACT\n*OUTPUT\n"
            "%s*END STEP\n*STEP\n*QUASISTATIC\n0.25, 1.\n*BOUNDARY\n"
            "TOP, 2, 2, 0.05\n*END STEP\n",
            mu, method, cards);
  return j;
}

/* ---- tests -------------------------------------------------------------- */

static const char *const methods[] = {"AUTO", "NEWTON", "SOR", "PCG"};

/* To the same exit code. */
static void goes_on(job *j, int code, const char *what) {
  int is = job_run(j, "--restart --no-timing");
  ck_assert_msg(is == code, "%s: exit %d, not %d: %s", what, is, code,
                j->errors);
}

static void interrupt_and_go_on(job (*make)(double, const char *, const char *),
                                double mu, const char *method) {
  char what[80];
  int changes, all;
  job whole = make(mu, "", method), cut = make(mu, "", method);
  snprintf(what, sizeof what, "%s mu %g", method, mu);
  int code = run_until(&whole, nothing, 0, 0, &all);
  int stopped = run_until(&cut, nothing, all * 7 / 10, SIGINT, &changes);
  ck_assert_msg(stopped == 130, "%s: exit %d", what, stopped);
  goes_on(&cut, code, what);
  same_files(&whole, &cut, what);
  job_end(&whole);
  job_end(&cut);
}

START_TEST(interrupted_run_goes_on_bit_for_bit) {
  for (size_t k = 0; k < sizeof methods / sizeof *methods; ++k) {
    interrupt_and_go_on(flat_block, 0.1, methods[k]);
    interrupt_and_go_on(flat_block, 10.0, methods[k]);
    interrupt_and_go_on(solid_block, 0.1, methods[k]);
    interrupt_and_go_on(solid_block, 10.0, methods[k]);
  }
}
END_TEST

UNIT_MAIN("restart", interrupted_run_goes_on_bit_for_bit)
