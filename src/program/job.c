/*
 * One pass: the stages in their order; and *EFFECTS, MODE=AUTO: the run without
 * some effects, with its checks, and the decision.
 */
#include "program/job.h"

#include "base/base.h"
#include "base/system/blas.h"
#include "base/system/input.h"
#include "effects/reduction/reduction.h"
#include "effects/rows.h"
#include "model/check/check.h"
#include "model/keyword/keyword.h"
#include "program/inform.h"
#include "run/setup/setup.h"

#include <unistd.h>

/* Surfaces in contact, names[2*n.contact]; not cracks, which are straight
 * between their nodes. */
static int find_rounds(const model *m, const char **names) {
  int n = 0;
  for (EACH(const contact, c, m->contacts, m->n.contact)) {
    if (c->is_crack) continue;
    names[n++] = c->is_pair ? c->pair.group[0] : c->group;
    if (c->is_pair) names[n++] = c->pair.group[1];
  }
  return n;
}

/* Numbers of the deck go to a .geo under their own names. */
static status read_mesh(const job_mesh *other, job_input *in) {
  const model *m = in->m;
  double cpu = timer_cpu();
  int n = 0;
  /* --safe: a mesh that is a program is not run. */
  if (input_is_confined() && job_is_geo(m))
    message_add(m->log, P5021, &m->mesh.at,
                "--safe: the mesh must be a .msh, not \"%s\"", m->mesh.file);
  PASS(message_status(m->log, ERR_DECK));
  OWNED_NEW(mesh_number, numbers, m->deck->n_symbol);
  for (int i = 0; i < m->deck->n_symbol; ++i)
    if (m->deck->symbols[i].in_geometry)
      numbers[n++] =
          (mesh_number){m->deck->symbols[i].typed, m->deck->symbols[i].value,
                        m->deck->symbols[i].used};
  OWNED_NEW(const char *, rounds, 2 * m->n.contact);
  TIMED(STAGE_MESH);
  if ((model_has_target(m) || m->steps[0].nested) && job_is_geo(m))
    mesh_gmsh_load();
  in->library_cpu = timer_cpu() - cpu;
  mesh_source source = {.file = m->mesh.file,
                        .scale = m->mesh.scale,
                        .n_number = n,
                        .numbers = numbers,
                        .n_round = find_rounds(m, rounds),
                        .rounds = rounds,
                        .meets = model_has_pairs(m)};
  if (other != NULL) memcpy(source.sizes, other->sizes, sizeof source.sizes);
  return mesh_read_gmsh(&source, &m->mesh.at, m->log, &in->msh);
}

/* A problem from a file instead of a mesh. */
static status read_problem(model *m, exchange_problem **problem) {
  TIMED(STAGE_PROBLEM);
  PASS(exchange_read(m->problem.file, m->problem.type, &m->problem.at, m->log,
                     problem));
  model_fit_problem(m, (*problem)->dim, (*problem)->cp.g0 != NULL,
                    effects_required);
  return message_status(m->log, ERR_DECK);
}

static status read_deck(const command *c, message_log *log, job_input *in) {
  TIMED(STAGE_DECK);
  status code = ERR_DECK;
  message_view w;
  status st = deck_read(c->deck_file, c->n_define, c->defines, log, &in->d);
  if (st == OK || st == ERR_DECK) st = model_from_deck(in->d, log, &in->m);
  if (st != ERR_DECK) PASS(st);
  for (int k = 0; message_get(log, k, &w); ++k)
    if (w.id == P1001) code = ERR_FILE; /* that of an *INCLUDE */
  return message_status(log, code);
}

status job_read(const command *c, const job_mesh *other, message_log *log,
                job_input *in) {
  PASS(read_deck(c, log, in));
  if (in->m->problem.given) return read_problem(in->m, &in->problem);
  if (other != NULL && other->same != NULL)
    in->msh = other->same;
  else
    PASS(read_mesh(other, in));
  PASS(model_open_cracks(in->m, in->msh));
  PASS(model_check(in->m, in->msh, effects_required));
  PASS(plan_leave_out(in->m, in->msh));
  return setup_adjust(in->m, in->msh);
}

int job_is_geo(const model *m) {
  return m->mesh.file != NULL && mesh_is_program(m->mesh.file);
}

int job_keeps_mesh(const model *m) {
  return !job_is_geo(m) && (m->n.field > 0 || m->initial.start.file != NULL);
}

status job_keep_contact(coarser *to, const state *s) {
  const state_contacts *c = &s->contacts;
  if (c->surface == NULL) return OK;
  return coarser_add(to, c->surface,
                     &(contact_view){s->t, c->rc, c->gap, c->slip, c->contact});
}

void job_input_free(job_input *in) {
  RELEASE(in->problem, in->contact, in->msh, in->m, in->d, in->first, in->log);
  free(in->closing);
  *in = (job_input){0};
}

status job_solve(const command *c, job_input *in, const job_watch *watch,
                 archive *from, int *unsettled) {
  static const mesh no_mesh;
  status st;
  restart_writer restart = {c, in, NULL, NULL};
  OWNED char *files = NULL;
  const output_options options = {
      .dir = c->dir,
      .no_timing = c->no_timing,
      .version = PROTIS_VERSION,
      .kernel = blas_kernel(),
      .threads = c->threads,
      .from = from,
      .n_problem = in->problem != NULL ? in->problem->n : 0,
      .closing = &in->closing,
      .progress = !c->quiet && isatty(STDERR_FILENO),
      .first = watch != NULL ? watch->first
                             : (history_sink){.ctx = &restart,
                                              .checkpoint = restart_write}};
  free(in->closing); /* of the pass before */
  in->closing = NULL;
  if (watch == NULL && in->problem == NULL) PASS(restart_files(in, &files));
  restart.files = files;
  PASS(output_open(in->m, in->problem == NULL ? in->msh : &no_mesh, &options,
                   &restart.out));
  history_sink sink = output_sink(restart.out);
  st = in->problem == NULL
           ? history_continue(in->m, in->msh, effect_table, from, &sink,
                              unsettled)
           : condensed_run(in->m, in->problem, &sink, unsettled);
  if (watch != NULL && watch->finished != NULL)
    st = watch->finished(watch->first.ctx, st, restart.out);
  if (st == OK) st = message_status(in->m->log, ERR_INTERNAL);
  status closed = output_close(restart.out, st, *unsettled);
  if (st == OK && closed != ERR_UNSETTLED) st = closed;
  return st;
}

/* ---- the start from a coarser mesh --------------------------------------- */

/* Keeps the first increment and ends the run. */
static status keep_first(void *to, const state *s) {
  PASS(job_keep_contact(to, s));
  RAISE(ERR_UNSETTLED, "the first increment is all that is needed");
}

/* On the mesh with these sizes, into *to. */
static status solve_first(const command *c, const mesh_sizes *sizes,
                          coarser *to) {
  int unsettled = 0;
  job_input other ENDS_BY(job_input_free) = {0};
  const history_sink sink = {.ctx = to, .increment = keep_first};
  PASS(message_log_new(&other.log));
  PASS(job_read(c, &(job_mesh){.sizes = {*sizes}}, other.log, &other));
  /* Without what the start does not depend on. */
  step *s = other.m->steps;
  s->accuracy.mesh = 0;
  s->accuracy.time = s->accuracy.time_balanced = s->accuracy.theorems = 0;
  s->accuracy.no_solver = 1;
  s->check = CHECK_NONE;
  other.m->n.goal = 0;
  other.m->effects &= ~(EFFECT_MESH_ERROR | EFFECT_TIME_ERROR |
                        EFFECT_ESTIMATES | EFFECT_REFERENCE | EFFECT_THEORY);
  return history_run(other.m, other.msh, effect_table, &sink, &unsettled);
}

status job_solve_coarser(const command *c, job_input *in) {
  OWNED_NEW(double, size, in->msh->n_node);
  space_lengths(in->msh, size);
  for (int i = 0; i < in->msh->n_node; ++i) size[i] *= 2.0;
  PASS(coarser_new(&in->contact));
  const status st = solve_first(c, &(mesh_sizes){in->msh, size}, in->contact);
  if (st == ERR_MEMORY || status_is_request(st)) return st;
  status_clear();
  in->m->accuracy.coarser = in->contact;
  return OK;
}

typedef struct watcher {
  model *m;
  reduction *n;
  int refuted; /* 1: the run was ended, a bound does not hold */
} watcher;

static status see_increment(void *ctx, const state *s) {
  watcher *w = ctx;
  PASS(reduction_measure(w->n, s, w->m->reduction.row));
  w->refuted = reduction_refuted(w->m);
  if (w->refuted)
    RAISE(ERR_UNSETTLED, "time %g: what was left out matters", s->t);
  return OK;
}

/* A run without the rows that are not back; *again: some are now. */
static status try_without(watcher *w, const command *c, job_input *in,
                          int *unsettled, int *again) {
  const job_watch watch = {.first = {.ctx = w, .increment = see_increment}};
  reduction_restore(in->m);
  reduction_leave_out(in->m);
  FORGET(w->n);
  PASS(reduction_new(in->m, in->msh, &w->n));
  w->refuted = 0;
  const message_mark before = message_now(in->m->log);
  const status st = job_solve(c, in, &watch, NULL, unsettled);
  /* The run gave no answer to measure, or one that did not converge. */
  const int failed = !w->refuted && (st != OK || *unsettled > 0);
  *again = !status_is_request(st) && st != ERR_MEMORY && st != ERR_FILE &&
           reduction_take_back(in->m, failed) > 0;
  if (*again) message_forget(in->m->log, before);
  return st;
}

/* Rows that are left out. */
static int left_out(const model *m) {
  int n = 0;
  for (int i = 0; i < m->reduction.n; ++i) n += !m->reduction.row[i].back;
  return n;
}

status job_solve_auto(const command *c, job_input *in, int *unsettled) {
  status st = OK;
  watcher w = {.m = in->m};
  int again = 1;
  PASS(reduction_choose(in->m, in->msh));
  while (again && left_out(in->m) > 0)
    st = try_without(&w, c, in, unsettled, &again);
  if (again) {
    reduction_restore(in->m);
    st = job_solve(c, in, NULL, NULL, unsettled);
  }
  memory_free(w.n);
  reduction_restore(in->m);
  return st;
}
