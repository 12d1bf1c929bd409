/*
 * One pass: the stages in their order; and *EFFECTS, MODE=AUTO: the run without
 * some effects, with its checks, and the decision.
 */
#include "program/job.h"

#include "accuracy/space.h"
#include "base/memory.h"
#include "base/system/input.h"
#include "base/timer.h"
#include "effects/plan/plan.h"
#include "effects/reduction/reduction.h"
#include "effects/rows.h"
#include "fem/fem.h"
#include "model/check/check.h"
#include "model/keyword/keyword.h"
#include "program/inform.h"
#include "program/restart.h"
#include "run/setup/setup.h"

#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* --safe: a mesh that is a program is not run. */
static status check_safe_mesh(const model *m) {
  if (input_is_confined() && job_is_geo(m))
    message_add(m->log, P5021, &m->mesh.at,
                "--safe: the mesh must be a .msh, not \"%s\"", m->mesh.file);
  return message_status(m->log, ERR_DECK);
}

/* Surfaces in contact, names[2*n.contact]; not cracks, which are straight
 * between their nodes. */
static int find_rounds(const model *m, const char **names) {
  int n = 0;
  for (int i = 0; i < m->n.contact; ++i) {
    const contact *c = &m->contacts[i];
    if (c->is_crack) continue;
    names[n++] = c->is_pair ? c->pair.group[0] : c->group;
    if (c->is_pair) names[n++] = c->pair.group[1];
  }
  return n;
}

/* Numbers of the deck go to a .geo under their own names. */
static status read_mesh(const job_mesh *other, job_input *in) {
  status st = OK;
  const model *m = in->m;
  double cpu = timer_cpu();
  mesh_number *numbers = NULL;
  const char **rounds = NULL;
  int n = 0;
  TRY(check_safe_mesh(m));
  NEW(numbers, m->deck->n_symbol);
  for (int i = 0; i < m->deck->n_symbol; ++i)
    if (m->deck->symbols[i].in_geometry)
      numbers[n++] =
          (mesh_number){m->deck->symbols[i].typed, m->deck->symbols[i].value};
  NEW(rounds, 2 * m->n.contact);
  timer_enter(STAGE_MESH);
  if ((model_has_target(m) || m->steps[0].nested) && job_is_geo(m))
    mesh_gmsh_load();
  in->library_cpu = timer_cpu() - cpu;
  mesh_source source = {.file = m->mesh.file,
                        .scale = m->mesh.scale,
                        .n_number = n,
                        .numbers = numbers,
                        .meets = model_has_pairs(m)};
  if (other != NULL) memcpy(source.sizes, other->sizes, sizeof source.sizes);
  source.n_round = find_rounds(m, rounds);
  source.rounds = rounds;
  st = mesh_read_gmsh(&source, &m->mesh.at, m->log, &in->msh);
  timer_leave(STAGE_MESH);
done:
  RELEASE(numbers, rounds);
  return st;
}

/* A problem from a file instead of a mesh. */
static status read_problem(model *m, exchange_problem **problem) {
  status st = OK;
  timer_enter(STAGE_PROBLEM);
  st = exchange_read(m->problem.file, m->problem.type, &m->problem.at, m->log,
                     problem);
  timer_leave(STAGE_PROBLEM);
  if (st == OK)
    model_fit_problem(m, (*problem)->dim, (*problem)->cp.g0 != NULL,
                      effects_required);
  return st;
}

status job_read(const command *c, const job_mesh *other, message_log *log,
                job_input *in) {
  status st = OK;
  timer_enter(STAGE_DECK);
  st = deck_read(c->deck_file, c->n_define, c->defines, log, &in->d);
  if (st == OK || st == ERR_DECK) st = model_from_deck(in->d, log, &in->m);
  timer_leave(STAGE_DECK);
  TRY(st);
  TRY(message_status(log, ERR_DECK));
  if (in->m->problem.given) {
    TRY(read_problem(in->m, &in->problem));
  } else {
    if (other != NULL && other->same != NULL)
      in->msh = other->same;
    else
      TRY(read_mesh(other, in));
    TRY(model_open_cracks(in->m, in->msh));
    TRY(model_check(in->m, in->msh, effects_required));
    TRY(plan_leave_out(in->m, in->msh));
    TRY(setup_adjust(in->m, in->msh));
  }
done:
  return st;
}

status job_expect(const job_input *in, int n, const stiffness_choice *choice) {
  plan_bytes b;
  PASS(plan_memory(in->m, in->msh, n, choice, &b));
  return memory_require(b.factor + b.contact + b.rest, "the run");
}

int job_is_geo(const model *m) {
  return m->mesh.file != NULL && mesh_is_program(m->mesh.file);
}

status job_keep_contact(coarser *to, const state *s) {
  const state_contacts *c = &s->contacts;
  if (c->surface == NULL) return OK;
  return coarser_add(to, c->surface,
                     &(contact_view){s->t, c->rc, c->gap, c->slip, c->contact});
}

void job_input_free(job_input *in) {
  exchange_free(in->problem);
  coarser_free(in->contact);
  mesh_free(in->msh);
  model_free(in->m);
  deck_free(in->d);
  deck_free(in->first);
  message_log_free(in->log);
  free(in->closing);
  *in = (job_input){0};
}

/* ---- the outputs and the observer ---------------------------------------- */

typedef struct relay {
  history_sink to;        /* the outputs */
  const job_watch *watch; /* or NULL */
  restart_writer restart;
} relay;

static status relay_expect(void *ctx, int n_node,
                           const stiffness_choice *choice) {
  const relay *r = ctx;
  return job_expect(r->restart.in, n_node, choice);
}

static status relay_ready(void *ctx, const setup_facts *facts,
                          const contact_surface *surface) {
  relay *r = ctx;
  if (r->watch != NULL && r->watch->ready != NULL)
    r->watch->ready(r->watch->ctx, facts);
  return r->to.ready(r->to.ctx, facts, surface);
}

static status relay_start(void *ctx, const start_report *s) {
  relay *r = ctx;
  return r->to.start(r->to.ctx, s);
}

static status relay_increment(void *ctx, const state *s) {
  relay *r = ctx;
  if (r->watch != NULL && r->watch->increment != NULL)
    PASS(r->watch->increment(r->watch->ctx, s));
  return r->to.increment(r->to.ctx, s);
}

static status relay_between(void *ctx, const state *s) {
  relay *r = ctx;
  return r->to.between(r->to.ctx, s);
}

static void relay_iteration(void *ctx, const solver_step *s) {
  relay *r = ctx;
  r->to.iteration(r->to.ctx, s);
}

static status relay_rejected(void *ctx, const state *s, const char *why) {
  relay *r = ctx;
  return r->to.rejected(r->to.ctx, s, why);
}

static status relay_checkpoint(void *ctx, const run_memory *memory) {
  relay *r = ctx;
  return restart_write(&r->restart, memory);
}

status job_solve(const command *c, job_input *in, const job_watch *watch,
                 archive *from, int *unsettled) {
  static const mesh no_mesh;
  status st = OK;
  output *out = NULL;
  char *files = NULL;
  const output_options options = {
      .dir = c->dir,
      .no_timing = c->no_timing,
      .version = PROTIS_VERSION,
      .kernel = blas_kernel(),
      .threads = c->threads,
      .from = from,
      .n_problem = in->problem != NULL ? in->problem->n : 0,
      .closing = &in->closing,
      .progress = !c->quiet && isatty(STDERR_FILENO)};
  free(in->closing); /* of the pass before */
  in->closing = NULL;
  if (watch == NULL && in->problem == NULL) TRY(restart_files(in, &files));
  TRY(output_open(in->m, in->problem == NULL ? in->msh : &no_mesh, &options,
                  &out));
  relay r = {output_sink(out), watch, {c, in, out, files}};
  history_sink sink = {.ctx = &r,
                       .expect = relay_expect,
                       .ready = relay_ready,
                       .start = relay_start,
                       .increment = relay_increment,
                       .between = relay_between,
                       .iteration = relay_iteration,
                       .rejected = relay_rejected,
                       .checkpoint = watch == NULL ? relay_checkpoint : NULL};
  st = in->problem == NULL
           ? history_continue(in->m, in->msh, effect_table, from, &sink,
                              unsettled)
           : condensed_run(in->m, in->problem, &sink, unsettled);
  if (watch != NULL && watch->finished != NULL)
    st = watch->finished(watch->ctx, st, out);
  status closed = output_close(out, st, *unsettled);
  if (st == OK && closed != ERR_UNSETTLED) st = closed;
  if (st == OK) TRY(message_status(in->m->log, ERR_INTERNAL));
done:
  free(files);
  return st;
}

/* ---- the start from a coarser mesh --------------------------------------- */

/* Keeps the first increment and ends the run. */
static status keep_first(void *to, const state *s) {
  PASS(job_keep_contact(to, s));
  RAISE(ERR_UNSETTLED, "the first increment is all that is needed");
}

/* Without what the start does not depend on. */
static void simplify(model *m) {
  step *s = m->steps;
  s->accuracy.mesh = 0;
  s->accuracy.time = s->accuracy.time_balanced = s->accuracy.theorems = 0;
  s->accuracy.no_solver = 1;
  s->check = CHECK_NONE;
  m->n.goal = 0;
  m->effects &=
      ~(unsigned)(EFFECT_MESH_ERROR | EFFECT_TIME_ERROR | EFFECT_ESTIMATES |
                  EFFECT_REFERENCE | EFFECT_THEORY);
}

/* On the mesh with these sizes, into *to. */
static status solve_first(const command *c, const mesh_sizes *sizes,
                          coarser *to) {
  status st = OK;
  int unsettled = 0;
  job_input other = {0};
  const history_sink sink = {.ctx = to, .increment = keep_first};
  TRY(message_log_new(&other.log));
  TRY(job_read(c, &(job_mesh){.sizes = {*sizes}}, other.log, &other));
  simplify(other.m);
  TRY(history_run(other.m, other.msh, effect_table, &sink, &unsettled));
done:
  job_input_free(&other);
  return st;
}

status job_solve_coarser(const command *c, job_input *in) {
  OWNED double *size = NULL;
  PASS_NEW(size, in->msh->n_node);
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

/* 1: the run gave no answer to measure, or one that did not converge. */
static int has_failed(const watcher *w, status st, int unsettled) {
  return !w->refuted && (st != OK || unsettled > 0);
}

static int is_final(status st) {
  return status_is_request(st) || st == ERR_MEMORY || st == ERR_FILE;
}

/* A run without the rows that are not back; *again: some are now. */
static status try_without(watcher *w, const command *c, job_input *in,
                          int *unsettled, int *again) {
  status st = OK;
  const job_watch watch = {.ctx = w, .increment = see_increment};
  reduction_restore(in->m);
  reduction_leave_out(in->m);
  reduction_free(w->n);
  w->n = NULL;
  TRY(reduction_new(in->m, in->msh, &w->n));
  w->refuted = 0;
  st = job_solve(c, in, &watch, NULL, unsettled);
  *again = !is_final(st) &&
           reduction_take_back(in->m, has_failed(w, st, *unsettled)) > 0;
done:
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
  TRY(reduction_choose(in->m, in->msh));
  while (again && left_out(in->m) > 0)
    st = try_without(&w, c, in, unsettled, &again);
  if (again) {
    reduction_restore(in->m);
    st = job_solve(c, in, NULL, NULL, unsettled);
  }
done:
  reduction_free(w.n);
  reduction_restore(in->m);
  return st;
}
