/*
 * protis: reads the command line, runs the stages in order, prints what went
 * wrong and chooses the exit code.
 */
#include "base/memory.h"
#include "base/timer.h"
#include "command.h"
#include "discrete/discrete.h"
#include "fem/fem.h"
#include "inform.h"
#include "output/output.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

/* Numbers of the deck go to a .geo under their own names. */
static status read_mesh(const model *m, mesh **msh) {
  status st = OK;
  mesh_number *numbers = NULL;
  NEW(numbers, m->deck->n_symbol);
  for (int i = 0; i < m->deck->n_symbol; ++i) {
    numbers[i].name = m->deck->symbols[i].name;
    numbers[i].value = m->deck->symbols[i].value;
  }
  timer_enter(STAGE_MESH);
  st = mesh_read_gmsh(&(mesh_source){.file = m->mesh_file,
                                     .scale = m->mesh_scale,
                                     .n_number = m->deck->n_symbol,
                                     .numbers = numbers},
                      &m->mesh_at, m->log, msh);
  timer_leave(STAGE_MESH);
done:
  memory_free(numbers);
  return st;
}

/* A problem from a file in the place of a mesh. */
static status read_problem(model *m, exchange_problem **problem) {
  status st = OK;
  timer_enter(STAGE_PROBLEM);
  st = exchange_read(m->problem_file, m->problem_type, &m->problem_at, m->log,
                     problem);
  timer_leave(STAGE_PROBLEM);
  if (st == OK)
    model_fit_problem(m, (*problem)->dim, (*problem)->cp.g0 != NULL);
  return st;
}

/* Everything up to the first number that is solved for. */
static status read_input(const command *c, deck **d, model **m, mesh **msh,
                         exchange_problem **problem, message_log *log) {
  status st = OK;
  timer_enter(STAGE_DECK);
  st = deck_read(c->deck_file, c->n_define, c->defines, log, d);
  if (st == OK || st == ERR_DECK) st = model_from_deck(*d, log, m);
  timer_leave(STAGE_DECK);
  TRY(st);
  TRY(message_status(log, ERR_DECK));
  if ((*m)->has_problem) {
    TRY(read_problem(*m, problem));
  } else {
    TRY(read_mesh(*m, msh));
    TRY(model_check(*m, *msh));
  }
done:
  return st;
}

static status solve(const command *c, model *m, const mesh *msh,
                    const exchange_problem *problem, int *unsettled) {
  static const mesh no_mesh;
  status st = OK;
  output *out = NULL;
  const output_options options = {
      .dir = c->dir,
      .no_timing = c->no_timing,
      .version = PROTIS_VERSION,
      .kernel = blas_kernel(),
      .threads = c->threads > 0 ? c->threads : 1,
      .progress = !c->quiet && isatty(STDERR_FILENO)};
  if (mkdir(c->dir, 0777) != 0 && errno != EEXIST)
    FAIL(ERR_FILE, "cannot make the folder %s: %s", c->dir, strerror(errno));
  TRY(output_open(m, problem == NULL ? msh : &no_mesh, &options, &out));
  history_sink sink = output_sink(out);
  st = problem == NULL ? history_run(m, msh, &sink, unsettled)
                       : condensed_run(m, problem, &sink, unsettled);
  status closed = output_close(out, st, *unsettled);
  if (st == OK && closed != ERR_UNSETTLED) st = closed;
done:
  return st;
}

static status run_job(const command *c, message_log *log, int *unsettled) {
  status st = OK;
  deck *d = NULL;
  model *m = NULL;
  mesh *msh = NULL;
  exchange_problem *problem = NULL;
  TRY(read_input(c, &d, &m, &msh, &problem, log));
  if (c->check_only && problem != NULL)
    inform_check_problem(m, problem);
  else if (c->check_only)
    TRY(inform_check(m, msh));
  else
    TRY(solve(c, m, msh, problem, unsettled));
done:
  exchange_free(problem);
  mesh_free(msh);
  model_free(m);
  message_print(log, stderr);
  deck_free(d);
  return st;
}

/* Messages with a place have been printed; what is left is the record. */
static int report(status st, const message_log *log, int unsettled) {
  int told = log != NULL && message_count(log, ERROR) > 0 && st != ERR_MEMORY &&
             st != ERR_INTERNAL;
  if (st != OK && !told)
    fprintf(stderr, "protis: error: %s\n", status_message());
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

int main(int argc, char **argv) {
  command c;
  message_log *log = NULL;
  int exit_code, unsettled = 0;
  blas_choose_kernel(argv);
  if (!command_read(argc, argv, &c, &exit_code)) return exit_code;
  if (c.threads > 0) blas_set_threads(c.threads);
  status st = message_log_new(&log);
  if (st == OK) st = run_job(&c, log, &unsettled);
  exit_code = report(st, log, unsettled);
  message_log_free(log);
  command_free(&c);
  return exit_code;
}
