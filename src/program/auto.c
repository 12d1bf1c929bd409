/*
 * The run without some effects, with its checks, and the decision.
 */
#include "program/auto.h"

#include "effects/reduction/reduction.h"

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
static int has_failed(const watcher *w, status run, int unsettled) {
  return !w->refuted && (run != OK || unsettled > 0);
}

static int is_final(status run) {
  return status_is_request(run) || run == ERR_MEMORY || run == ERR_FILE;
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

status auto_solve_job(const command *c, job_input *in, int *unsettled) {
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
