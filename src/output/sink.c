/*
 * The sink of history_run: writes into the open files. JOB.sta is written last:
 * an increment in it is in all files.
 */
#include "output/open.h"

#include "base/memory.h"
#include "base/timer.h"

#include <stdio.h>
#include <time.h>

enum { XDMF_PAUSE = 1 };               /* s */
static const double XDMF_SHARE = 0.02; /* of the CPU time at most */

job job_of(const output *o) {
  return (job){o->m, o->msh, &o->o, &o->run, o->plan};
}

/* Wall clock, s; only its differences count. */
static double clock_now(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* The text is written again each time, so not more than once in XDMF_PAUSE
 * seconds, and not above its share of the run except the last time: the cost
 * stays small however long it grows. */
status output_show_records(output *o, int all) {
  hdf5_shape shape;
  if (o->h5 == NULL) return OK;
  hdf5_shape_of(o->h5, &shape);
  if (shape.n_record == o->n_xdmf) return OK;
  double now = clock_now();
  if (!all && o->n_xdmf > 0 && now < o->xdmf_at + XDMF_PAUSE) return OK;
  double cpu = timer_cpu();
  if (!all && o->xdmf_cpu > XDMF_SHARE * cpu) return OK;
  PASS(xdmf_write(&shape, o->xdmf));
  o->xdmf_cpu += timer_cpu() - cpu;
  o->n_xdmf = shape.n_record;
  o->xdmf_at = now;
  return OK;
}

/* Repeated when a step has other supports. After a restart the facts are those
 * of before, with the same elimination. */
static status sink_ready(void *ctx, const setup_facts *facts,
                         const contact_surface *surface) {
  output *o = ctx;
  job j = job_of(o);
  (void)surface;
  if (!o->run.facts_known) o->began_at = clock_now();
  o->run.facts_known = 1;
  if (o->quiet) {
    o->run.facts.info.ordering = facts->info.ordering;
    o->quiet = 0;
    return OK;
  }
  o->run.facts = *facts;
  timer_enter(STAGE_LISTING);
  status st = listing_ready(&j, &o->lst);
  timer_leave(STAGE_LISTING);
  return st;
}

static status sink_start(void *ctx, const start_report *report) {
  output *o = ctx;
  job j = job_of(o);
  return listing_start(&j, report, &o->lst);
}

static status write_fields(output *o, const state *s) {
  status st = OK;
  if (o->h5 == NULL) return OK;
  timer_enter(STAGE_HDF5);
  st = hdf5_increment(o->h5, s);
  if (st == OK) st = output_show_records(o, 0);
  timer_leave(STAGE_HDF5);
  return st;
}

/* The condensed problem, where required; that of a failed attempt without
 * solution is replaced when the increment is solved. */
static status write_condensed(output *o, const state *s) {
  status st = OK;
  const step *now = &o->m->steps[s->step_no - 1];
  char name[512], text[200];
  char *path = NULL;
  if (s->contacts.problem == NULL ||
      !frequency_shows(now->output.condensed, s->increment_no, s->end_of_step))
    return OK;
  timer_enter(STAGE_FCLIB);
  snprintf(name, sizeof name, "%s_condensed_%05d", o->m->name.job,
           o->run.n_increment + 1);
  snprintf(text, sizeof text, "Protis %s: step %d, increment %d, time %.9g",
           o->o.version != NULL ? o->o.version : "", s->step_no,
           s->increment_no, s->t);
  path = text_path(o->o.dir, name, "h5");
  if (path == NULL) FAIL(ERR_MEMORY, "memory exhausted: name of a file");
  TRY(fclib_write(s->contacts.problem, s->settled ? s->contacts.uc : NULL,
                  s->contacts.rc, o->m->name.title, text, path));
done:
  memory_free(path);
  timer_leave(STAGE_FCLIB);
  return st;
}

static status write_tables(output *o, const state *s) {
  status st = OK;
  job j = job_of(o);
  timer_enter(STAGE_LISTING);
  TRY(tabular_increment(o->dat, s));
  TRY(listing_increment(&j, s, &o->lst));
  cvg_end(o->run.n_increment + 1, o->attempt, s, &o->cvg);
  TRY(text_check(&o->cvg));
  TRY(output_remember(o, s));
  TRY(sta_line(&o->o, s, NULL, &o->sta));
done:
  timer_leave(STAGE_LISTING);
  return st;
}

/* Ten times a second at most: a terminal is slow. */
static void show_progress(output *o, const state *s) {
  if (!o->progress) return;
  const double now = clock_now();
  ++o->n_done;
  if (o->n_done > 1 && now < o->shown_at + 0.1) return;
  o->shown_at = now;
  progress_show(o->m, s, now - o->began_at, o->n_done);
}

static status sink_increment(void *ctx, const state *s) {
  output *o = ctx;
  PASS(write_fields(o, s));
  PASS(write_condensed(o, s));
  PASS(write_tables(o, s));
  o->attempt = 1;
  show_progress(o, s);
  return OK;
}

static status sink_between(void *ctx, const state *s) {
  status st = OK;
  output *o = ctx;
  timer_enter(STAGE_LISTING);
  TRY(tabular_increment(o->dat, s));
  TRY(listing_between(s, &o->lst));
done:
  timer_leave(STAGE_LISTING);
  return st;
}

static void sink_iteration(void *ctx, const solver_step *s) {
  output *o = ctx;
  cvg_line(&o->o, (cvg_place){o->run.n_increment + 1, o->attempt}, s, &o->cvg);
}

static status sink_rejected(void *ctx, const state *s, const char *why) {
  status st = OK;
  output *o = ctx;
  cvg_end(o->run.n_increment + 1, o->attempt, s, &o->cvg);
  ++o->run.n_rejected;
  ++o->attempt;
  timer_enter(STAGE_LISTING);
  TRY(text_check(&o->cvg));
  TRY(listing_rejected(s, why, &o->lst));
  TRY(sta_line(&o->o, s, why, &o->sta));
  TRY(write_condensed(o, s));
done:
  timer_leave(STAGE_LISTING);
  return st;
}

history_sink output_sink(output *o) {
  return (history_sink){.ctx = o,
                        .ready = sink_ready,
                        .start = sink_start,
                        .increment = sink_increment,
                        .between = sink_between,
                        .iteration = sink_iteration,
                        .rejected = sink_rejected};
}
