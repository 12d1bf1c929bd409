/*
 * protis: reads the command line, runs the stages in order, prints what went
 * wrong and chooses the exit code.
 */
#include "base/base.h"
#include "base/interrupt.h"
#include "base/system/blas.h"
#include "program/inform.h"
#include "program/job.h"

#include <fcntl.h>
#include <unistd.h>

#ifndef PROTIS_COMMIT /* of the sources: told by the Makefile */
#define PROTIS_COMMIT "unknown"
#endif

static status solve(const command *c, job_input *in, int *unsettled) {
  job_lock lock ENDS_BY(job_lock_release) = {0};
  ENDS_BY(archive_free) archive *from = NULL;
  OWNED_GET(char, stop, text_path(c->dir, in->m->name.job, "stop"));
  PASS(output_spare(in->m, c->dir));
  PASS(job_lock_take(c->dir, in->m->name.job, &lock));
  output_drop_aside(in->m, c->dir);
  interrupt_catch(stop);
  if (c->restart) PASS(restart_read(c, in, &from));
  if (in->problem == NULL && in->m->steps[0].nested && from == NULL)
    PASS(job_solve_coarser(c, in));
  if (model_has_target(in->m) && in->problem == NULL)
    return target_reach(c, in, unsettled);
  if (in->m->reduction.is_auto && in->problem == NULL && from == NULL)
    return job_solve_auto(c, in, unsettled);
  return job_solve(c, in, NULL, from, unsettled);
}

static status do_job(const command *c, message_log *log, job_input *in,
                     int *unsettled) {
  PASS(job_read(c, NULL, log, in));
  if (c->check_only && in->problem != NULL)
    return inform_check_problem(in->m, in->problem);
  if (c->check_only) return inform_check(in->m, in->msh);
  if (c->estimate_cost) return forecast_print(c, in);
  return solve(c, in, unsettled);
}

/* Line by line, of which the parts are many. */
static void print_messages(const message_log *log) {
  char line[BUFSIZ];
  setvbuf(stderr, line, _IOLBF, sizeof line);
  message_print(log, stderr);
  fflush(stderr);
  setvbuf(stderr, NULL, _IONBF, 0);
}

static status run_job(const command *c, message_log *log, int *unsettled) {
  job_input in = {0};
  const message_mark before = message_now(log);
  status st = do_job(c, log, &in, unsettled);
  if (in.log != NULL) { /* of the last pass of TARGET=, as its files */
    message_forget(log, before);
    message_take(log, in.log);
  }
  print_messages(log);
  if (in.closing != NULL) fputs(in.closing, stderr);
  job_input_free(&in);
  return st;
}

/* Messages with a place have been printed; what is left is the record. */
static int report(status st, const message_log *log, int unsettled) {
  int reported = log != NULL && message_count(log, ERROR) > 0 &&
                 st != ERR_MEMORY && st != ERR_INTERNAL;
  if (st != OK && !reported)
    fprintf(stderr, "protis: %s%s\n",
            status_is_request(st) ? "" : "error: ", status_message());
  if (st == ERR_MEMORY && memory_hit_limit())
    fprintf(stderr,
            "protis: the memory that %s leaves is too little; --max-memory MB "
            "allows more\n",
            memory_limit_of());
  if (st == ERR_INTERNAL || st == ERR_MEMORY)
    fprintf(stderr, "protis: in %s\n", status_path());
  if (st == OK && unsettled > 0) {
    fprintf(stderr,
            "protis: %d increment%s missed the tolerance; see the "
            "listing\n",
            unsettled, unsettled == 1 ? "" : "s");
    st = ERR_UNSETTLED;
  }
  return status_exit_code(st);
}

/* What was printed must have left: the tables, a manual, a list. */
static int flush_output(int exit_code) {
  if (exit_code != 0 || text_flush_output() == OK) return exit_code;
  fprintf(stderr, "protis: error: %s\n", status_message());
  return status_exit_code(ERR_FILE);
}

/* No file of the job gets the number of a stream that was closed, and what is
 * printed to none is not lost unseen: it cannot be written. HDF5 locks no file:
 * the job does (lock.c), and not every file system can. */
static void prepare_process(void) {
  int fd;
  do {
    fd = open("/dev/null", O_RDWR);
    if (fd == STDOUT_FILENO && close(fd) == 0) fd = open("/dev/null", O_RDONLY);
  } while (fd >= 0 && fd <= STDERR_FILENO);
  if (fd > STDERR_FILENO) close(fd);
  setenv("HDF5_USE_FILE_LOCKING", "FALSE", 1);
}

int main(int argc, char **argv) {
  command c = {.commit = PROTIS_COMMIT};
  message_log *log = NULL;
  int exit_code, unsettled = 0;
  prepare_process();
  interrupt_crashes();
  blas_choose_kernel(argv);
  interrupt_spare_writes();
  if (!command_read(argc, argv, &c, &exit_code)) {
    exit_code = flush_output(exit_code);
    interrupt_over();
    return exit_code;
  }
  status st = message_log_new(&log);
  if (st == OK) st = command_apply(&c, log);
  if (st == OK)
    st = c.table != NULL ? tables_print(&c) : run_job(&c, log, &unsettled);
  exit_code = flush_output(report(st, log, unsettled));
  memory_free(log);
  command_free(&c);
  interrupt_over();
  return exit_code;
}
