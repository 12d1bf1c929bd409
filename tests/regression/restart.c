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
static const char *const again[] = {"--restart", NULL};

/* ---- comparing ---------------------------------------------------------- */

/* All files of the results are equal, byte by byte. */
static void same_files(const job *a, const job *b, const char *what) {
  static const char *const files[] = {"lst", "sta",  "cvg", "dat",
                                      "h5",  "xdmf", "json"};
  int flows = strcmp(a->name, "creep") == 0; /* calls may differ */
  for (size_t k = 0; k < sizeof files / sizeof *files; ++k) {
    char command[300];
    if (flows && (k == 0 || strcmp(files[k], "json") == 0)) continue;
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
  int stopped = run_until(&cut, nothing, all * 6 / 10, SIGINT, &changes);
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

/* At changes of files spread over the run, those of the restart file too. */
START_TEST(killed_run_goes_on_bit_for_bit) {
  char what[40];
  int changes, all;
  job whole = flat_block(0.4, "*RESTART\n", "AUTO");
  job cut = flat_block(0.4, "*RESTART\n", "AUTO");
  int code = run_until(&whole, nothing, 0, 0, &all);
  for (int k = 0; k < 6; ++k) {
    int at = all / 2 + k * all / 13 + k;
    snprintf(what, sizeof what, "killed at change %d of %d", at, all);
    ck_assert_int_eq(run_until(&cut, nothing, at, SIGKILL, &changes), KILLED);
    int part = changes / 3;
    ck_assert_int_eq(run_until(&cut, again, part, SIGKILL, &changes), KILLED);
    goes_on(&cut, code, what);
    same_files(&whole, &cut, what);
  }
  job_end(&whole);
  job_end(&cut);
}
END_TEST

/* A Maxwell block: inelastic strains, constant tangents. */
static job creep(double mu, const char *cards, const char *method) {
  job j = job_begin("creep");
  job_copy(&j, "input/creep_block/creep_block.geo");
  job_write(&j, "creep.inp",
            "*PARAMETER\nN = 8\n*MESH, FILE=creep_block.geo\n"
            "*MATERIAL, NAME=M\n*ELASTIC\n130.D3, 0.2\n"
            "*INELASTIC, LAW=MAXWELL\n4.\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
            "*CONTACT, NAME=C, GROUP=CONTACT, OBSTACLE=O\n"
            "*FRICTION, CONTACT=C, LAW=COULOMB\n%g\n*STEP\n*QUASISTATIC\n"
            "0.5, 1.\n*BOUNDARY\nSYMMETRY, 1\n*DSLOAD\nTOP, P, 50.\n"
            "LEFT, P, 150.\n*PRINT, CONTACT, ENERGY\n*OUTPUT\n%s*END STEP\n"
            "*STEP\n*VISCO, %s\n0.5, 4.\n*ACCURACY, TIME=YES\n*END STEP\n",
            mu, cards, method);
  return j;
}

START_TEST(flowing_body_goes_on_bit_for_bit) {
  interrupt_and_go_on(creep, 1.0, "INTEGRATOR=MIDPOINT");
  interrupt_and_go_on(creep, 1.0, "INTEGRATOR=BACKWARD");
  interrupt_and_go_on(creep, 1.0, "INTEGRATOR=HEUN");
}
END_TEST

/* ---- refused ------------------------------------------------------------ */

static void refused(job *j, int code, const char *why) {
  int is = job_run(j, "--restart --no-timing");
  ck_assert_msg(is == code && strstr(j->errors, why) != NULL,
                "exit %d, not %d: %s; not: %s", is, code, j->errors, why);
}

/* The deck with one text in the place of another. */
static void edit(const job *j, const char *from, const char *to) {
  char *deck = job_file(j, "inp"), *at = strstr(deck, from), file[40];
  ck_assert_ptr_nonnull(at);
  *at = '\0';
  snprintf(file, sizeof file, "%s.inp", j->name);
  job_write(j, file, "%s%s%s", deck, to, at + strlen(from));
  free(deck);
}

START_TEST(changed_decks_are_refused_by_card) {
  int changes, all;
  job j = flat_block(0.4, "", "AUTO");
  refused(&j, 4, "cannot read");
  run_until(&j, nothing, 0, 0, &all);
  ck_assert_int_eq(run_until(&j, nothing, all * 4 / 10, SIGINT, &changes), 130);
  edit(&j, "130.D3", "131.D3");
  refused(&j, 2, "*ELASTIC");
  edit(&j, "131.D3", "130.D3");
  edit(&j, "TOP, 2, 2, -0.02", "TOP, 2, 2, -0.03");
  refused(&j, 2, "step 1, *BOUNDARY");
  edit(&j, "TOP, 2, 2, -0.03", "TOP, 2, 2, -0.02");
  edit(&j, "*END STEP\n*STEP", "*END STEP\n*STEP\n*STATIC\n*END STEP\n*STEP");
  refused(&j, 2, "*QUASISTATIC");
  edit(&j, "*STATIC\n*END STEP\n*STEP\n", "");
  edit(&j, "N = 8", "N = 9");
  refused(&j, 2, "*PARAMETER");
  edit(&j, "N = 9", "N = 8");
  ck_assert_int_eq(job_run(&j, "--restart"), 2); /* --no-timing is missing */
  ck_assert_ptr_nonnull(strstr(j.errors, "--no-timing"));
  edit(&j, "TOP, 1, 1, -0.01", "TOP, 1, 1, -0.015"); /* of a later step */
  goes_on(&j, 0, "later load");
  job_end(&j);
}
END_TEST

/* Flip a byte in the middle of a file of the folder. */
static void damage(const job *j, const char *suffix) {
  char path[200];
  snprintf(path, sizeof path, "%s/%s.%s", j->dir, j->name, suffix);
  FILE *f = fopen(path, "r+b");
  ck_assert_ptr_nonnull(f);
  fseek(f, 0, SEEK_END);
  long middle = ftell(f) / 2;
  for (int k = 0; k < 64; ++k) {
    fseek(f, middle + k, SEEK_SET);
    int c = fgetc(f);
    fseek(f, middle + k, SEEK_SET);
    fputc(c ^ 0x55, f);
  }
  fclose(f);
}

START_TEST(damaged_files_are_refused) {
  int changes, all;
  job whole = flat_block(0.4, "*RESTART\n", "AUTO");
  job j = flat_block(0.4, "*RESTART\n", "AUTO");
  run_until(&whole, nothing, 0, 0, &all);
  ck_assert_int_eq(run_until(&j, nothing, all * 2 / 3, SIGKILL, &changes),
                   KILLED);
  damage(&j, "rst.h5");
  goes_on(&j, 0, "from the file before");
  ck_assert_ptr_nonnull(strstr(j.errors, "warning"));
  ck_assert_ptr_nonnull(strstr(j.errors, "rst.old.h5"));
  same_files(&whole, &j, "from the file before");
  damage(&j, "rst.h5");
  damage(&j, "rst.old.h5");
  refused(&j, 4, "damaged");
  job_write(&j, "block.rst.h5", "no HDF5\n");
  refused(&j, 4, "no restart file of Protis");
  job_end(&whole);
  job_end(&j);
}
END_TEST

UNIT_MAIN("restart", interrupted_run_goes_on_bit_for_bit,
          killed_run_goes_on_bit_for_bit, flowing_body_goes_on_bit_for_bit,
          changed_decks_are_refused_by_card, damaged_files_are_refused)
