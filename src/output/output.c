/*
 * Opening and closing the files of a job: new ones, or those that a run
 * continues.
 */
#include "output/open.h"

#include "base/file.h"
#include "base/memory.h"
#include "base/timer.h"

#include <stdio.h>
#include <string.h>
#include <unistd.h>

static void release(output *o) {
  plan_free(o->plan);
  RELEASE(o->json, o->xdmf);
  for (int i = 0; i < o->run.n_increment; ++i) {
    RELEASE(o->run.increments[i].solutions,
            (void *)o->run.increments[i].theorems.contacts);
  }
  RELEASE(o->run.ends, o->run.goals, o->run.increments, o->saved.read, o);
}

/* Files of an earlier run must not be taken for results of this one. */
static status remove_old(const output *o, const char *suffix) {
  status st = OK;
  char *path = text_path(o->o.dir, o->m->name.job, suffix);
  if (path == NULL) FAIL(ERR_MEMORY, "memory exhausted: name of a file");
  TRY(file_clear(path));
done:
  memory_free(path);
  return st;
}

/* length: of the file to continue; -1: a new one. */
static status open_text(const output *o, const char *suffix, long length,
                        text_file *t) {
  status st = OK;
  char *path = text_path(o->o.dir, o->m->name.job, suffix);
  if (path == NULL) FAIL(ERR_MEMORY, "memory exhausted: name of a file");
  if (length < 0)
    TRY(text_open(t, path, 1));
  else
    TRY(text_reopen(t, path, 1, length));
done:
  memory_free(path);
  return st;
}

static status open_hdf5(output *o, const hdf5_count *before) {
  if (!model_writes_fields(o->m)) return OK;
  timer_enter(STAGE_HDF5);
  status st = hdf5_open(o->m, o->msh, &o->o, before, &o->h5);
  timer_leave(STAGE_HDF5);
  return st;
}

static status open_new(output *o) {
  job j = job_of(o);
  static const char *const old[] = {"h5",           "xdmf",   "json",
                                    "body.xdmf",    "rst.h5", "rst.old.h5",
                                    "contact.xdmf", "rst.inc"};
  PASS(open_text(o, "lst", -1, &o->lst));
  PASS(open_text(o, "sta", -1, &o->sta));
  PASS(open_text(o, "cvg", -1, &o->cvg));
  for (size_t k = 0; k < sizeof old / sizeof *old; ++k)
    PASS(remove_old(o, old[k]));
  PASS(tabular_open(o->m, o->msh, o->o.dir, -1, &o->dat));
  if (o->dat == NULL) PASS(remove_old(o, "dat"));
  PASS(sta_header(&o->o, &o->sta));
  cvg_header(&o->o, &o->cvg);
  PASS(text_check(&o->cvg));
  PASS(listing_open(&j, &o->lst));
  return open_hdf5(o, NULL);
}

static status open_earlier(output *o) {
  status st = OK;
  archive *a = o->o.from;
  file_ends ends;
  archive_enter(a, "output");
  TRY(output_read(o, a, &ends));
  o->quiet = 1;
  TRY(open_text(o, "lst", ends.lst, &o->lst));
  TRY(open_text(o, "sta", ends.sta, &o->sta));
  TRY(open_text(o, "cvg", ends.cvg, &o->cvg));
  TRY(tabular_open(o->m, o->msh, o->o.dir, ends.dat, &o->dat));
  TRY(open_hdf5(o, ends.has_h5 ? &ends.h5 : NULL));
done:
  if (o->run.increments == NULL) o->run.n_increment = 0;
  archive_leave(a);
  return st;
}

static status open_all(output *o) {
  o->json = text_path(o->o.dir, o->m->name.job, "json");
  o->xdmf = text_path(o->o.dir, o->m->name.job, "xdmf");
  if (o->json == NULL || o->xdmf == NULL)
    RAISE(ERR_MEMORY, "memory exhausted: name of a file");
  return o->o.from == NULL ? open_new(o) : open_earlier(o);
}

status output_open(const model *m, const mesh *msh, const output_options *opt,
                   output **out) {
  status st = OK;
  output *o = NULL;
  *out = NULL;
  NEW(o, 1);
  o->m = m;
  o->msh = msh;
  o->o = *opt;
  o->attempt = 1;
  o->run.message = "";
  o->progress = opt->progress && isatty(STDERR_FILENO);
  NEW(o->run.ends, (size_t)m->n.step * job_end_size(m));
  if (m->n.goal > 0) NEW(o->run.goals, m->n.step * m->n.goal);
  TRY(plan_new(m, m->problem.given ? NULL : msh, opt->n_problem, &o->plan));
  TRY(open_all(o));
  *out = o;
done:
  if (st != OK && o != NULL) {
    text_close(&o->saved.file);
    text_close(&o->lst);
    text_close(&o->sta);
    text_close(&o->cvg);
    tabular_close(o->dat);
    release(o);
  }
  return st;
}

/* The first failure is reported; the files after it are closed as well. */
static void first_of(status *kept, char *message, size_t size, status st) {
  if (st == OK || *kept != OK) return;
  *kept = st;
  snprintf(message, size, "%s", status_message());
}

static status verdict_of(status run, int unsettled) {
  return run == OK && unsettled > 0 ? ERR_UNSETTLED : run;
}

void output_passes(output *o, const pass_table *passes) {
  o->run.passes = *passes;
}

/* The last record, once more in files of one grid. */
static status write_last(const output *o) {
  static const char *const names[] = {"body.xdmf", "contact.xdmf"};
  hdf5_shape shape;
  if (o->h5 == NULL) return OK;
  hdf5_shape_of(o->h5, &shape);
  for (int k = 0; k < 2; ++k) {
    OWNED char *path = text_path(o->o.dir, o->m->name.job, names[k]);
    if (path == NULL) RAISE(ERR_MEMORY, "memory exhausted: name of a file");
    PASS(xdmf_write_last(&shape, k, path));
  }
  return OK;
}

/* Without memory there are none. */
static void make_closing(const output *o) {
  const job j = job_of(o);
  char *path = text_path(o->o.dir, o->m->name.job, "lst"), **to = o->o.closing;
  size_t size = 0;
  FILE *f = to != NULL && o->progress ? open_memstream(to, &size) : NULL;
  if (f != NULL && path != NULL) {
    char files[4096];
    snprintf(files, sizeof files, "%s .sta .cvg%s%s .json", path,
             o->dat != NULL ? " .dat" : "", o->h5 != NULL ? " .h5 .xdmf" : "");
    closing_lines(&j, files, f);
  }
  if (f != NULL) text_memory_end(f, to);
  memory_free(path);
}

status output_close(output *o, status run, int unsettled) {
  char message[2048] = "";
  status kept = OK;
  if (o == NULL) return verdict_of(run, unsettled);
  job j = job_of(o);
  if (o->progress) progress_line("");
  first_of(&kept, message, sizeof message, run);
  first_of(&kept, message, sizeof message, output_show_records(o, 1));
  first_of(&kept, message, sizeof message, write_last(o));
  first_of(&kept, message, sizeof message, hdf5_close(o->h5, kept == OK));
  first_of(&kept, message, sizeof message, tabular_close(o->dat));
  first_of(&kept, message, sizeof message, text_close(&o->saved.file));
  first_of(&kept, message, sizeof message, text_close(&o->cvg));
  first_of(&kept, message, sizeof message, text_close(&o->sta));
  o->run.message = message;
  o->run.verdict = verdict_of(kept, unsettled);
  first_of(&kept, message, sizeof message, listing_verdict(&j, &o->lst));
  first_of(&kept, message, sizeof message, text_close(&o->lst));
  o->run.verdict = verdict_of(kept, unsettled);
  first_of(&kept, message, sizeof message, json_write(&j, o->json));
  o->run.verdict = verdict_of(kept, unsettled);
  make_closing(o);
  release(o);
  if (kept != OK) return status_fail(kept, __func__, __LINE__, "%s", message);
  return verdict_of(OK, unsettled);
}
