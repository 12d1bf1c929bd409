/*
 * The files of a job: their names, of which none may be one that the deck
 * reads; opened, new or those that a run continues; the sink of history_run,
 * which writes into them; closed. JOB.sta is written last: an increment in it
 * is in all files.
 */
#include "output/writers.h"

#include "base/base.h"
#include "base/file.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

/* JOB.stop is removed only if it was made during the run. The first N_OLD of
 * an earlier run must not be taken for results of this one, the first N_END of
 * the part before a restart not for those of the whole; the first N_RESULT are
 * results. In the order in which they go: what JOB.sta tells stands in JOB.h5
 * at every moment. */
enum { N_END = 4, N_OLD = 11, N_RESULT = 12 };
/* clang-format off */
static const char *const results[] = {
    "json", "xdmf", "body.xdmf", "contact.xdmf", "rst.h5", "rst.old.h5",
    "rst.inc", "sta", "cvg", "dat", "h5", "lst", "lock", "h5.tmp", "xdmf.tmp",
    "json.tmp", "rst.h5.tmp", "body.xdmf.tmp", "contact.xdmf.tmp"};
/* clang-format on */

static const char middle[] = "_condensed_";

static status spare(const deck *d, const char *path) {
  PASS(file_may_go(path));
  for (int i = 0; i < d->n_input; ++i) {
    int same = file_same(d->inputs[i], path);
    if (same < 0) PASS(text_failed(path, "inspect", errno));
    if (same)
      RAISE(
          ERR_DECK,
          "%s is the file %s that the deck reads: the results would overwrite "
          "it; name the deck or the file otherwise, or use -o",
          path, d->inputs[i]);
  }
  return OK;
}

/* The increment of a file of that name; 0: it is none of a condensed problem
 * of the job. */
static long increment_of(const char *name, const char *job_name) {
  const size_t n = strlen(job_name), k = sizeof middle - 1;
  if (strncmp(name, job_name, n) != 0 || strncmp(name + n, middle, k) != 0 ||
      !isdigit((unsigned char)name[n + k]))
    return 0;
  char *end = NULL;
  const long number = strtol(name + n + k, &end, 10);
  return strcmp(end, ".h5") == 0 || strcmp(end, ".h5.tmp") == 0 ? number : 0;
}

static void close_folder(DIR **folder) {
  if (*folder != NULL) closedir(*folder);
}

static status spare_it(const model *m, const char *path, const char *to) {
  return spare(m->deck, path);
}

static status clear_it(const model *m, const char *path, const char *to) {
  return file_clear(path);
}

static status drop_it(const model *m, const char *path, const char *to) {
  unlink(path);
  return OK;
}

/* Into the folder "to". */
static status move_it(const model *m, const char *path, const char *to) {
  const char *const name = strrchr(path, '/') + 1;
  OWNED_NEW(char, moved, strlen(to) + strlen(name) + 2);
  sprintf(moved, "%s/%s", to, name);
  PASS(file_clear(moved));
  if (rename(path, moved) != 0 && errno != ENOENT)
    PASS(text_failed(path, "move", errno));
  return OK;
}

typedef status deal(const model *m, const char *path, const char *to);

/* All files of condensed problems of increments after that one. */
static status each_condensed(const model *m, const char *dir, int after,
                             deal *with, const char *to) {
  DIR *folder ENDS_BY(close_folder) = opendir(dir);
  if (folder == NULL && (errno == ENOENT || errno == ENOTDIR)) return OK;
  if (folder == NULL) return text_failed(dir, "read", errno);
  for (struct dirent *e; (e = readdir(folder)) != NULL;) {
    if (increment_of(e->d_name, m->name.job) <= after) continue;
    OWNED_NEW(char, path, strlen(dir) + strlen(e->d_name) + 2);
    sprintf(path, "%s/%s", dir, e->d_name);
    PASS(with(m, path, to));
  }
  return OK;
}

/* The first n kinds of results. */
static status each_result(const model *m, const char *dir, size_t n, deal *with,
                          const char *to) {
  for (size_t k = 0; k < n; ++k) {
    OWNED_GET(char, path, text_path(dir, m->name.job, results[k]));
    PASS(with(m, path, to));
  }
  return each_condensed(m, dir, 0, with, to);
}

status output_spare(const model *m, const char *dir) {
  enum { ALL = sizeof results / sizeof *results };
  if (m->deck == NULL) return OK;
  OWNED_GET(char, aside, text_path(dir, m->name.job, "pass"));
  if (access(aside, F_OK) == 0)
    PASS(each_result(m, aside, N_RESULT, spare_it, NULL));
  return each_result(m, dir, ALL, spare_it, NULL);
}

status output_set_aside(const model *m, const char *dir) {
  OWNED_GET(char, aside, text_path(dir, m->name.job, "pass"));
  if (mkdir(aside, 0777) != 0 && errno != EEXIST)
    PASS(text_failed(aside, "make", errno));
  return each_result(m, dir, N_RESULT, move_it, aside);
}

void output_drop_aside(const model *m, const char *dir) {
  char *aside = text_path(dir, m->name.job, "pass");
  if (aside != NULL && access(aside, F_OK) == 0) {
    (void)each_result(m, aside, N_RESULT, drop_it, NULL);
    rmdir(aside); /* it stays where somebody keeps files there */
  }
  memory_free(aside);
}

enum { XDMF_PAUSE = 1 };               /* s */
static const double XDMF_SHARE = 0.02; /* of the CPU time at most */

/* Wall clock, s; only its differences count. */
static double clock_now(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* JOB.xdmf with the records so far; "all": even if it was written just before.
 * The text is written again each time, so not more than once in XDMF_PAUSE
 * seconds, and not above its share of the run except the last time: the cost
 * stays small however long it grows. */
static status show_records(output *o, int all) {
  if (o->h5 == NULL || hdf5_records(o->h5) == o->n_xdmf) return OK;
  double now = clock_now();
  if (!all && o->n_xdmf > 0 && now < o->xdmf_at + XDMF_PAUSE) return OK;
  double cpu = timer_cpu();
  if (!all && o->xdmf_cpu > XDMF_SHARE * cpu) return OK;
  PASS(xdmf_write(o->h5, o->xdmf));
  o->xdmf_cpu += timer_cpu() - cpu;
  o->n_xdmf = hdf5_records(o->h5);
  o->xdmf_at = now;
  return OK;
}

/* Repeated when a step has other supports. After a restart the facts are those
 * of before, with the same elimination. */
static status sink_ready(void *ctx, const setup_facts *facts,
                         const contact_surface *surface) {
  output *o = ctx;
  if (o->o.first.ready != NULL)
    PASS(o->o.first.ready(o->o.first.ctx, facts, surface));
  if (!o->run.facts_known) o->began_at = clock_now();
  o->run.facts_known = 1;
  if (o->quiet) {
    o->run.facts.info.ordering = facts->info.ordering;
    o->quiet = 0;
    return OK;
  }
  o->run.facts = *facts;
  TIMED(STAGE_LISTING);
  return listing_ready(&o->job, &o->lst);
}

static status sink_expect(void *ctx, int n_node,
                          const stiffness_choice *choice) {
  const output *o = ctx;
  return plan_expect(o->m, o->msh, n_node, choice);
}

static status sink_checkpoint(void *ctx, struct run *r) {
  const output *o = ctx;
  return o->o.first.checkpoint(o->o.first.ctx, r);
}

static status sink_start(void *ctx, const start_report *report) {
  output *o = ctx;
  return listing_start(&o->job, report, &o->lst);
}

static status write_fields(output *o, const state *s) {
  if (o->h5 == NULL) return OK;
  TIMED(STAGE_HDF5);
  PASS(hdf5_increment(o->h5, s));
  return show_records(o, 0);
}

/* The condensed problem, where required; that of a failed attempt without
 * solution is replaced when the increment is solved. */
static status write_condensed(output *o, const state *s) {
  const step *now = &o->m->steps[s->step_no - 1];
  char name[512], text[200];
  if (s->contacts.problem == NULL ||
      !frequency_shows(now->output.condensed, s->increment_no, s->end_of_step))
    return OK;
  TIMED(STAGE_FCLIB);
  snprintf(name, sizeof name, "%s_condensed_%05d", o->m->name.job,
           o->run.n_increment + 1);
  snprintf(text, sizeof text, "Protis %s: step %d, increment %d, time %.9g",
           o->o.version != NULL ? o->o.version : "", s->step_no,
           s->increment_no, s->t);
  OWNED_GET(char, path, text_path(o->o.dir, name, "h5"));
  return fclib_write(s->contacts.problem, s->contacts.surface->node_no,
                     s->settled ? s->contacts.uc : NULL, s->contacts.rc,
                     o->m->name.title, text, path);
}

static status write_tables(output *o, const state *s) {
  TIMED(STAGE_LISTING);
  PASS(tabular_increment(o->dat, s));
  PASS(listing_increment(&o->job, s, &o->lst));
  cvg_end(o->run.n_increment + 1, o->attempt, s, &o->cvg);
  PASS(text_check(&o->cvg));
  PASS(output_remember(o, s));
  return sta_line(&o->o, s, NULL, &o->sta);
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
  if (o->o.first.increment != NULL)
    PASS(o->o.first.increment(o->o.first.ctx, s));
  PASS(write_fields(o, s));
  PASS(write_condensed(o, s));
  PASS(write_tables(o, s));
  o->attempt = 1;
  show_progress(o, s);
  return OK;
}

static status sink_between(void *ctx, const state *s) {
  output *o = ctx;
  TIMED(STAGE_LISTING);
  PASS(tabular_increment(o->dat, s));
  return listing_between(s, &o->lst);
}

static void sink_iteration(void *ctx, const solver_step *s) {
  output *o = ctx;
  cvg_line(&o->o, (cvg_place){o->run.n_increment + 1, o->attempt}, s, &o->cvg);
}

static status sink_rejected(void *ctx, const state *s, const char *why) {
  output *o = ctx;
  cvg_end(o->run.n_increment + 1, o->attempt, s, &o->cvg);
  ++o->run.n_rejected;
  ++o->attempt;
  TIMED(STAGE_LISTING);
  PASS(text_check(&o->cvg));
  PASS(listing_rejected(s, why, &o->lst));
  PASS(sta_line(&o->o, s, why, &o->sta));
  return write_condensed(o, s);
}

history_sink output_sink(output *o) {
  return (history_sink){
      .ctx = o,
      .expect = sink_expect,
      .checkpoint = o->o.first.checkpoint != NULL ? sink_checkpoint : NULL,
      .ready = sink_ready,
      .start = sink_start,
      .increment = sink_increment,
      .between = sink_between,
      .iteration = sink_iteration,
      .rejected = sink_rejected};
}

static void release(output *o) {
  RELEASE(o->plan, o->json, o->xdmf);
  for (int i = 0; o->run.increments != NULL && i < o->run.n_increment; ++i)
    RELEASE(o->run.increments[i].solutions,
            (void *)o->run.increments[i].theorems.contacts);
  RELEASE(o->run.ends, o->run.goals, o->run.increments, o->saved.read, o);
}

static status remove_old(const output *o, const char *suffix) {
  OWNED_GET(char, path, text_path(o->o.dir, o->m->name.job, suffix));
  return file_clear(path);
}

/* length: of the file to continue; -1: a new one. Iterations are seen as they
 * end, else what belongs together. */
static status open_text(const output *o, const char *suffix, long length,
                        text_file *t) {
  const int by_line = t == &o->cvg;
  OWNED_GET(char, path, text_path(o->o.dir, o->m->name.job, suffix));
  return length < 0 ? text_open(t, path, by_line)
                    : text_reopen(t, path, by_line, length);
}

static status open_hdf5(output *o, const hdf5_count *before) {
  if (!model_writes_fields(o->m)) return OK;
  TIMED(STAGE_HDF5);
  return hdf5_open(o->m, o->msh, &o->o, before, &o->h5);
}

static status open_new(output *o) {
  PASS(open_text(o, "lst", -1, &o->lst));
  for (int k = 0; k < N_OLD; ++k) PASS(remove_old(o, results[k]));
  PASS(open_text(o, "sta", -1, &o->sta));
  PASS(open_text(o, "cvg", -1, &o->cvg));
  PASS(each_condensed(o->m, o->o.dir, 0, clear_it, NULL));
  PASS(tabular_open(o->m, o->msh, o->o.dir, -1, &o->dat));
  if (o->dat == NULL) PASS(remove_old(o, "dat"));
  PASS(sta_header(&o->o, &o->sta));
  cvg_header(&o->o, &o->cvg);
  PASS(text_check(&o->cvg));
  PASS(listing_open(&o->job, &o->lst));
  return open_hdf5(o, NULL);
}

static status open_earlier(output *o) {
  archive *a = o->o.from;
  file_ends ends;
  OWNED char *was = NULL;
  PASS(archive_text(a, "deck", &was));
  IN_GROUP(a, "output");
  PASS(output_read(o, a, &ends));
  o->quiet = 1;
  for (int k = 0; k < N_END; ++k) PASS(remove_old(o, results[k]));
  PASS(open_text(o, "lst", ends.lst, &o->lst));
  PASS(listing_again(&o->job, was, &o->lst));
  PASS(open_text(o, "sta", ends.sta, &o->sta));
  PASS(open_text(o, "cvg", ends.cvg, &o->cvg));
  PASS(tabular_open(o->m, o->msh, o->o.dir, ends.dat, &o->dat));
  PASS(each_condensed(o->m, o->o.dir, o->run.n_increment, clear_it, NULL));
  return open_hdf5(o, ends.has_h5 ? &ends.h5 : NULL);
}

static status open_all(output *o) {
  PASS_GET(o->json, text_path(o->o.dir, o->m->name.job, "json"));
  PASS_GET(o->xdmf, text_path(o->o.dir, o->m->name.job, "xdmf"));
  PASS_NEW(o->run.ends, o->m->n.step * job_end_size(o->m));
  if (o->m->n.goal > 0) PASS_NEW(o->run.goals, o->m->n.step * o->m->n.goal);
  PASS(plan_new(o->m, o->m->problem.given ? NULL : o->msh, o->o.n_problem,
                &o->plan));
  o->job = (job){o->m, o->msh, &o->o, &o->run, o->plan};
  return o->o.from == NULL ? open_new(o) : open_earlier(o);
}

status output_open(const model *m, const mesh *msh, const output_options *opt,
                   output **out) {
  output *o;
  *out = NULL;
  PASS_NEW(o, 1);
  o->m = m;
  o->msh = msh;
  o->o = *opt;
  o->attempt = 1;
  o->run.message = "";
  o->progress = opt->progress && isatty(STDERR_FILENO);
  const status st = open_all(o);
  if (st == OK) {
    *out = o;
  } else {
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
  for (int k = 0; k < 2 && o->h5 != NULL; ++k) {
    OWNED_GET(char, path, text_path(o->o.dir, o->m->name.job, names[k]));
    PASS(xdmf_write_last(o->h5, k, path));
  }
  return OK;
}

/* Without memory there are none. */
static void make_closing(const output *o) {
  char *path = text_path(o->o.dir, o->m->name.job, "lst"), **to = o->o.closing;
  size_t size = 0;
  FILE *f = to != NULL && o->progress ? open_memstream(to, &size) : NULL;
  if (f != NULL && path != NULL) {
    char files[4096];
    snprintf(files, sizeof files, "%s .sta .cvg%s%s .json", path,
             o->dat != NULL ? " .dat" : "", o->h5 != NULL ? " .h5 .xdmf" : "");
    closing_lines(&o->job, files, f);
  }
  if (f != NULL) text_memory_end(f, to);
  memory_free(path);
}

/* None rather than that of another outcome. */
static status write_json(const output *o) {
  const status st = json_write(&o->job, o->json);
  if (st != OK) unlink(o->json);
  return st;
}

status output_close(output *o, status run, int unsettled) {
  char message[2048] = "";
  status kept = OK;
  if (o == NULL) return verdict_of(run, unsettled);
  if (o->progress) progress_line("");
  first_of(&kept, message, sizeof message, run);
  first_of(&kept, message, sizeof message, show_records(o, 1));
  first_of(&kept, message, sizeof message, write_last(o));
  first_of(&kept, message, sizeof message, hdf5_close(o->h5, kept == OK));
  first_of(&kept, message, sizeof message, tabular_close(o->dat));
  first_of(&kept, message, sizeof message, text_close(&o->saved.file));
  first_of(&kept, message, sizeof message, text_close(&o->cvg));
  first_of(&kept, message, sizeof message, text_close(&o->sta));
  o->run.message = message;
  first_of(&kept, message, sizeof message, listing_summary(&o->job, &o->lst));
  o->run.verdict = verdict_of(kept, unsettled);
  first_of(&kept, message, sizeof message, write_json(o));
  const status told = o->run.verdict = verdict_of(kept, unsettled);
  first_of(&kept, message, sizeof message, listing_end(&o->job, &o->lst));
  first_of(&kept, message, sizeof message, text_close(&o->lst));
  o->run.verdict = verdict_of(kept, unsettled);
  if (o->run.verdict != told) write_json(o);
  make_closing(o);
  release(o);
  if (kept != OK) return status_fail(kept, __func__, __LINE__, "%s", message);
  return verdict_of(OK, unsettled);
}
