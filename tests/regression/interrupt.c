/*
 * A run that is stopped: by signals, by JOB.stop, by a limit on the size of
 * files; the files are whole up to the last line of JOB.sta. Two runs of one
 * name. A run of many increments is watched through its JOB.sta, so that
 * nothing depends on time.
 */
#include "scenes/mesh.h"
#include "support/job.h"
#include "support/kept_mesh.h"
#include "support/unit.h"

#include <errno.h>
#include <fcntl.h>
#include <hdf5.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

enum { MANY = 200000, SOME = 5 };

/* A block under friction in so many increments. */
static job block(int increments) {
  job j = job_with(
      "block", "input/greco/greco.geo",
      "*PARAMETER\nN = 4\n*MESH, FILE=greco.geo\n*MATERIAL, NAME=M\n"
      "*ELASTIC\n130.D3, 0.2\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
      "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
      "*CONTACT, NAME=C, GROUP=CONTACT, OBSTACLE=O\n"
      "*FRICTION, CONTACT=C, LAW=COULOMB\n1.0\n*STEP\n*QUASISTATIC\n"
      "%.17g, 1.\n*BOUNDARY\nSYMMETRY, 1\n*DSLOAD\nTOP, P, 50.\n"
      "LEFT, P, 150.\n*PRINT, TOTALS\n*OUTPUT, FREQUENCY=0\n*END STEP\n",
      1.0 / increments);
  return j;
}

static void into(const job *j, const char *file, int fd) {
  PRINTED(path, "%s/%s", j->dir, file);
  int to = open(path, O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (to < 0 || dup2(to, fd) < 0) _exit(99);
}

/* What a batch system or a lost terminal sends. */
static const struct {
  int number, code;
  const char *told;
} requests[] = {{SIGHUP, 129, "interrupted by SIGHUP"},
                {SIGUSR1, 138, "interrupted by SIGUSR1"},
                {SIGUSR2, 140, "interrupted by SIGUSR2"},
                {SIGXCPU, 152, "interrupted by SIGXCPU"},
                {SIGINT, 130, "interrupted by SIGINT"},
                {SIGTERM, 143, "interrupted by SIGTERM"}};

/* So many of them are ignored at the start of the next job: nohup. */
static size_t n_ignored;

/* Start the job; file_limit: bytes, 0 none. */
static pid_t start(const job *j, rlim_t file_limit) {
  PRINTED(deck, "%s/%s", j->dir, j->name);
  pid_t pid = fork();
  ck_assert_int_ge(pid, 0);
  if (pid > 0) return pid;
  into(j, "stdout.txt", STDOUT_FILENO);
  into(j, "stderr.txt", STDERR_FILENO);
  struct rlimit limit = {file_limit, file_limit};
  if (file_limit > 0 && setrlimit(RLIMIT_FSIZE, &limit) != 0) _exit(99);
  for (size_t k = 0; k < sizeof requests / sizeof *requests; ++k)
    signal(requests[k].number, k < n_ignored ? SIG_IGN : SIG_DFL);
  kept_mesh_preload("");
  execl(job_program(), job_program(), deck, "--no-timing", (char *)NULL);
  _exit(99);
}

/* Exit code, or 1000 + signal. */
static int finish(pid_t pid) {
  int code;
  ck_assert_int_eq(waitpid(pid, &code, 0), pid);
  return WIFEXITED(code) ? WEXITSTATUS(code) : 1000 + WTERMSIG(code);
}

/* Increments in JOB.sta; *last is the number of the last one. */
static int lines_of(const job *j, int *last) {
  FREED char *sta = job_file(j, "sta");
  int n = 0;
  *last = 0;
  for (char *p = sta; p != NULL && (p = strchr(p, '\n')) != NULL && p[1];) {
    ++p;
    if (strchr(p, '\n') == NULL) break;
    ++n;
    sscanf(p, "%*d %d", last);
  }
  return n;
}

static void wait_for(const job *j, pid_t pid, int lines) {
  int last;
  while (lines_of(j, &last) < lines) {
    ck_assert_int_eq(waitpid(pid, NULL, WNOHANG), 0);
    usleep(1000);
  }
}

/* So that the next run is not taken for this one. */
static void remove_sta(const job *j) {
  PRINTED(path, "%s/%s.sta", j->dir, j->name);
  ck_assert_int_eq(unlink(path), 0);
}

static char *errors_of(const job *j) {
  job e = *j;
  snprintf(e.name, sizeof e.name, "stderr");
  return job_file(&e, "txt");
}

/* Rows of /history/time that were reached. */
static int rows_of(const job *j) {
  int n = 0;
  PRINTED(path, "%s/%s.h5", j->dir, j->name);
  hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  ck_assert_int_ge(file, 0);
  hid_t set = H5Dopen2(file, "/history/time", H5P_DEFAULT);
  static double t[MANY];
  ck_assert_int_ge(
      H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, t), 0);
  while (n < MANY && !isnan(t[n])) ++n;
  H5Dclose(set);
  H5Fclose(file);
  return n;
}

/* All files hold the increments of JOB.sta and end with a whole line. */
static void check_files(const job *j) {
  int last, n = lines_of(j, &last);
  ck_assert_int_ge(n, SOME);
  ck_assert_int_lt(n, MANY);
  ck_assert_int_eq(rows_of(j), n);
  static const char *const texts[] = {"lst", "sta", "cvg", "dat"};
  for (size_t k = 0; k < sizeof texts / sizeof *texts; ++k) {
    FREED char *text = job_file(j, texts[k]);
    ck_assert_ptr_nonnull(text);
    ck_assert_int_eq(text[strlen(text) - 1], '\n');
  }
  char *tables = job_file(j, "dat"), *at = strrchr(tables, '#'), block_of[60];
  while (at > tables && strncmp(at, "# step", 6) != 0) --at;
  snprintf(block_of, sizeof block_of, "# step 1 increment %d ", last);
  ck_assert_int_eq(strncmp(at, block_of, strlen(block_of)), 0);
  free(tables);
}

static void check_told(const job *j, const char *by, int code) {
  char wanted[120];
  int last;
  lines_of(j, &last);
  FREED char *errors = errors_of(j), *json = job_file(j, "json");
  snprintf(wanted, sizeof wanted, "after step 1, increment %d, time", last);
  ck_assert_msg(strstr(errors, by) != NULL && strstr(errors, wanted) != NULL,
                "%s; wanted %s, %s", errors, by, wanted);
  snprintf(wanted, sizeof wanted, "\"code\": %d", code);
  ck_assert_msg(strstr(json, wanted) != NULL, "%s", json);
  ck_assert(job_has(j, "rst.h5"));
}

static void signal_ends(int signal_no, const char *name, int code) {
  JOB j = block(MANY);
  pid_t pid = start(&j, 0);
  wait_for(&j, pid, SOME);
  kill(pid, signal_no);
  ck_assert_int_eq(finish(pid), code);
  check_told(&j, name, code);
  check_files(&j);
}

TEST(signals_end_after_an_increment) {
  for (size_t k = 0; k < sizeof requests / sizeof *requests; ++k)
    signal_ends(requests[k].number, requests[k].told, requests[k].code);
}

/* SIGXCPU comes every second, SIGTERM follows a hangup: the first counts, the
 * files are closed. */
TEST(signals_come_together) {
  JOB j = block(MANY);
  pid_t pid = start(&j, 0);
  wait_for(&j, pid, SOME);
  kill(pid, SIGXCPU);
  kill(pid, SIGHUP);
  kill(pid, SIGXCPU);
  kill(pid, SIGTERM);
  int code = finish(pid);
  ck_assert_msg(code == 152 || code == 129 || code == 143, "exit %d", code);
  ck_assert(job_has(&j, "json") && job_has(&j, "rst.h5"));
}

/* Nor does a folder of the name of the file end the run. */
TEST(ignored_signals_stay_ignored) {
  JOB j = block(MANY);
  PRINTED(folder, "%s/block.stop", j.dir);
  n_ignored = 4;
  pid_t pid = start(&j, 0);
  n_ignored = 0;
  wait_for(&j, pid, SOME);
  for (size_t k = 0; k < 4; ++k) kill(pid, requests[k].number);
  ck_assert_int_eq(mkdir(folder, 0777), 0);
  int last, before = lines_of(&j, &last);
  wait_for(&j, pid, before + SOME);
  kill(pid, SIGTERM);
  ck_assert_int_eq(finish(pid), 143);
}

TEST(file_ends_after_an_increment) {
  JOB j = block(MANY);
  pid_t pid = start(&j, 0);
  wait_for(&j, pid, SOME);
  job_write(&j, "block.stop", "\n");
  ck_assert_int_eq(finish(pid), 130);
  check_told(&j, "block.stop", 130);
  check_files(&j);
  ck_assert(!job_has(&j, "stop"));
}

/* One that is there does not count and stays; it counts when it is touched. */
TEST(earlier_file_stays) {
  JOB j = block(MANY);
  job_write(&j, "block.stop", "notes\n");
  pid_t pid = start(&j, 0);
  wait_for(&j, pid, SOME);
  ck_assert(job_has(&j, "stop"));
  job_write(&j, "block.stop", "more notes\n");
  ck_assert_int_eq(finish(pid), 130);
  check_told(&j, "block.stop", 130);
  FREED char *stop = job_file(&j, "stop");
  ck_assert_str_eq(stop, "more notes\n");
}

/* Both signals reach the process at once: it ends without closing the files. */
TEST(second_signal_ends_at_once) {
  JOB j = block(MANY);
  pid_t pid = start(&j, 0);
  wait_for(&j, pid, SOME);
  kill(pid, SIGSTOP);
  kill(pid, SIGINT);
  kill(pid, SIGTERM);
  kill(pid, SIGCONT);
  int code = finish(pid), last;
  ck_assert_msg(code == 130 || code == 143, "exit %d", code);
  char *json = job_file(&j, "json"), *errors = errors_of(&j);
  ck_assert_ptr_null(json);
  ck_assert_str_eq(errors, "");
  ck_assert_int_ge(rows_of(&j), lines_of(&j, &last));
  free(errors);
}

TEST(file_size_limit_is_a_failed_write) {
  JOB j = block(MANY);
  pid_t pid = start(&j, 20000);
  ck_assert_int_eq(finish(pid), 4);
  FREED char *errors = errors_of(&j);
  ck_assert_msg(strstr(errors, "block.") != NULL, "%s", errors);
}

/* The second pass of TARGET= has larger files: it fails, in which increment or
 * file whatever, and leaves the results of the first, which are removed where
 * it ends. */
TEST(a_pass_that_fails_leaves_the_one_before) {
  JOB j = block(5);
  char *deck = job_file(&j, "inp"), *at = strstr(deck, "*PRINT, TOTALS");
  ck_assert_ptr_nonnull(at);
  *at = '\0';
  job_write(&j, "block.inp",
            "%s*ACCURACY, TARGET=3 %%\n*OUTPUT, FREQUENCY=0\n*END STEP\n",
            deck);
  free(deck);
  ck_assert_int_eq(finish(start(&j, 100000)), 4);
  FREED char *errors = errors_of(&j), *json = job_file(&j, "pass/block.json");
  ck_assert_msg(strstr(errors, "the files of pass 1 are in ") != NULL &&
                    strstr(errors, "/block.pass") != NULL,
                "%s", errors);
  ck_assert_ptr_nonnull(json);
  ck_assert_ptr_nonnull(strstr(json, "\"code\": 0"));
  ck_assert(job_has(&j, "pass/block.h5") && job_has(&j, "pass/block.lst"));
  ck_assert_int_eq(job_run(&j, ""), 0);
  ck_assert(job_has(&j, "h5") && !job_has(&j, "pass"));
}

TEST(second_job_of_the_name_is_refused) {
  JOB j = block(MANY);
  pid_t pid = start(&j, 0);
  wait_for(&j, pid, SOME);
  ck_assert_int_eq(job_run(&j, ""), 4);
  ck_assert_ptr_nonnull(strstr(j.errors, "block.lock"));
  PRINTED(owner, "process %d", (int)pid);
  ck_assert_ptr_nonnull(strstr(j.errors, owner));
  ck_assert_int_eq(job_run(&j, "--check"), 0); /* writes nothing */
  wait_for(&j, pid, SOME + 1);
  kill(pid, SIGKILL);
  ck_assert_int_eq(finish(pid), 1000 + SIGKILL);
  char *lock = job_file(&j, "lock");
  ck_assert_ptr_nonnull(lock); /* left behind, and no lock */
  free(lock);
  remove_sta(&j);
  pid = start(&j, 0);
  wait_for(&j, pid, SOME);
  kill(pid, SIGTERM);
  ck_assert_int_eq(finish(pid), 143);
  lock = job_file(&j, "lock");
  ck_assert_ptr_null(lock);
}

/* Neither the lock of the job nor one of HDF5 ends a run. The sanitisers must
 * be the first that is loaded. */
TEST(file_system_without_locks_is_no_matter) {
#ifndef __SANITIZE_ADDRESS__
  static const int errors[] = {ENOLCK, EOPNOTSUPP, ENOSYS, EINVAL};
  char number[20], seen[200];
  job_preload("nolocks");
  for (size_t k = 0; k < sizeof errors / sizeof *errors; ++k) {
    JOB j = block(3);
    snprintf(number, sizeof number, "%d", errors[k]);
    snprintf(seen, sizeof seen, "%s/locks.seen", j.dir);
    setenv("NOLOCKS", number, 1);
    setenv("NOLOCKS_SEEN", seen, 1);
    ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
    ck_assert_msg(access(seen, F_OK) == 0, "no lock was asked for");
    ck_assert(job_has(&j, "h5") && !job_has(&j, "lock"));
    ck_assert_msg(job_run(&j, "--restart") == 0, "%s", j.errors);
  }
  unsetenv("LD_PRELOAD");
#endif
}

TEST(other_file_of_that_name_stays) {
  JOB j = block(2);
  job_write(&j, "block.lock", "my notes\n");
  ck_assert_int_eq(job_run(&j, ""), 4);
  ck_assert_ptr_nonnull(strstr(j.errors, "block.lock is no lock"));
  FREED char *lock = job_file(&j, "lock");
  ck_assert_str_eq(lock, "my notes\n");
}

/* Bits of the standard streams that are closed, once for gmsh too. */
TEST(closed_streams_are_no_matter) {
  static const unsigned closed[] = {7, 3, 5, 6};
  for (size_t k = 0; k < sizeof closed / sizeof *closed; ++k) {
    JOB j = block(2);
    PRINTED(deck, "%s/%s", j.dir, j.name);
    pid_t pid = fork();
    ck_assert_int_ge(pid, 0);
    if (pid == 0) {
      for (int fd = 0; fd < 3; ++fd)
        if (closed[k] >> fd & 1) close(fd);
      if (k > 0) kept_mesh_preload("");
      execl(job_program(), job_program(), deck, (char *)NULL);
      _exit(99);
    }
    ck_assert_int_eq(finish(pid), 0);
  }
}

/* What is printed to a closed stream is lost. */
TEST(closed_output_is_a_failed_write) {
  pid_t pid = fork();
  ck_assert_int_ge(pid, 0);
  if (pid == 0) {
    close(STDOUT_FILENO);
    execl(job_program(), job_program(), "--list", "solvers", (char *)NULL);
    _exit(99);
  }
  ck_assert_int_eq(finish(pid), 4);
}

/* With a limit and a minute. */
static int finish_below(const job *j, int what, struct rlimit most,
                        const char *threads) {
  PRINTED(deck, "%s/%s", j->dir, j->name);
  pid_t pid = fork();
  ck_assert_int_ge(pid, 0);
  if (pid > 0) return finish(pid);
  into(j, "stderr.txt", STDERR_FILENO);
  into(j, "stdout.txt", STDOUT_FILENO);
  signal(SIGALRM, SIG_DFL);
  alarm(UNIT_SECONDS / 10);
  setrlimit(what, &most);
  execl(job_program(), job_program(), deck, "--threads", threads, (char *)NULL);
  _exit(99);
}

/* With so many bytes of addresses. */
static int finish_within(const job *j, rlim_t bytes, const char *threads) {
  return finish_below(j, RLIMIT_AS, (struct rlimit){bytes, bytes}, threads);
}

/* Of the CPU time the child that meshes has as much as the run: at the soft
 * limit it is ended by SIGXCPU, at the hard one by SIGKILL. */
TEST(limit_of_time_counts_while_gmsh_works) {
  JOB j = block(2);
  job_write(
      &j, "greco.geo",
      "DefineConstant[ N = 1 ];\nFor i In {1:100000000}\n  x = N;\nEndFor\n");
  for (rlim_t hard = 1; hard <= 2; ++hard) {
    const int code =
        finish_below(&j, RLIMIT_CPU, (struct rlimit){1, hard}, "1");
    FREED char *errors = errors_of(&j);
    ck_assert_msg(code == 152, "exit %d: %s", code, errors);
    ck_assert_ptr_nonnull(strstr(errors, "limit of CPU time"));
  }
}

/* Too few addresses for the linear algebra: told, and not waited for. */
TEST(few_addresses_are_told) {
  JOB j = block(2);
  ck_assert_int_eq(finish_within(&j, (rlim_t)150 << 20, "1"), 5);
  FREED char *errors = errors_of(&j);
  ck_assert_ptr_nonnull(strstr(errors, "ulimit -v"));
}

/* Enough to start, not enough for a body of 14,641 nodes, or just enough. */
TEST(few_addresses_are_not_waited_for) {
  const mesh_change as_it_is = {.map = {NULL}};
  int *number = NULL, refused = 0;
  JOB j = job_begin("block");
  PRINTED(path, "%s/block.msh", j.dir);
  FILE *f = fopen(path, "w");
  ck_assert_ptr_nonnull(f);
  ck_assert_int_eq(scene_mesh_write(f, "rect 120 120 1 1", &as_it_is, &number),
                   1);
  fclose(f);
  free(number);
  job_write(&j, "block.inp",
            "*MESH, FILE=block.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
            "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
            "*FRICTION, CONTACT=C, LAW=COULOMB\n0.4\n*STEP\n*STATIC\n"
            "*BOUNDARY\nTOP, 1, 1, 0.002\nTOP, 2, 2, -0.01\n"
            "*OUTPUT, HDF5=NO\n*END STEP\n");
  for (rlim_t kb = 168000; kb < 200000; kb += 2000) {
    const int code = finish_within(&j, kb << 10, "1");
    FREED char *errors = errors_of(&j);
    ck_assert_msg(code == 0 || code == 5, "%d kB: exit %d: %s", (int)kb, code,
                  errors);
    refused += code == 5;
  }
  ck_assert_int_gt(refused, 0);
}

/* Threads of the linear algebra without room for their buffers: one runs. */
TEST(few_addresses_leave_one_thread) {
  JOB j = job_begin("square");
  job_write(
      &j, "square.msh",
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n"
      "1 2 \"FOOT\"\n2 1 \"BODY\"\n$EndPhysicalNames\n$Nodes\n4\n1 0 0 0\n"
      "2 1 0 0\n3 1 1 0\n4 0 1 0\n$EndNodes\n$Elements\n3\n"
      "1 1 2 2 1 1 2\n2 2 2 1 1 1 2 3\n3 2 2 1 1 1 3 4\n"
      "$EndElements\n");
  job_write(&j, "square.inp",
            "*MESH, FILE=square.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1., 0.3\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n*STEP\n*STATIC\n"
            "*BOUNDARY\nFOOT, 1, 2\n*DLOAD\nBODY, BY, -1.\n*END STEP\n");
  int code = finish_within(&j, (rlim_t)240 << 20, "2");
  FREED char *errors = errors_of(&j);
  ck_assert_msg(code == 0, "exit %d: %s", code, errors);
  ck_assert_ptr_nonnull(strstr(errors, "P5020"));
}

/* An option, or a deck behind "--" or with its folder. */
TEST(deck_may_begin_with_a_dash) {
  JOB j = block(2);
  PRINTED(line, "mv '%s/block.inp' '%s/-x.inp'", j.dir, j.dir);
  ck_assert_int_eq(system(line), 0);
  snprintf(j.name, sizeof j.name, "-x.inp");
  ck_assert_int_eq(job_run(&j, ""), 2);
  ck_assert_ptr_nonnull(strstr(j.errors, "./-x.inp"));
  snprintf(j.name, sizeof j.name, "-- -x");
  ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
  snprintf(j.name, sizeof j.name, "-x");
  ck_assert(job_has(&j, "lst") && job_has(&j, "h5"));
}

UNIT_MAIN("interrupt")
