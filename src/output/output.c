/*
 * The open job: all files, and the sink that history_run tells. JOB.sta is
 * written last: an increment that stands there stands in all files.
 */
#include "base/memory.h"
#include "base/timer.h"
#include "output/writers.h"

#include <errno.h>
#include <math.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

enum { XDMF_PAUSE = 1 };

struct output {
  const model *m;
  const mesh *msh;
  output_options o;
  char *json, *xdmf;
  text_file lst, sta, cvg;
  tabular *dat;
  hdf5_file *h5;
  run_summary run;
  effect_plan *plan;
  int n_xdmf; /* records named in JOB.xdmf                                  */
  double xdmf_at; /* when, s                                                 */
  int attempt; /* of the increment now tried                                 */
  int progress;
  int quiet; /* 1: the first facts stand in the listing already               */
  increment_summary *kept; /* [n_increment] of output_keep                   */
  solution_facts *facts;   /* all their solutions                            */
  char *whys; /* lines: the reasons in increments, or of output_keep          */
};

static job job_of(const output *o) {
  return (job){o->m, o->msh, &o->o, &o->run, o->plan};
}

/* ---- the summary of the run ------------------------------------------- */

/* The larger; NaN wins, so that it is seen. */
static double worse(double a, double b) { return isnan(a) || a >= b ? a : b; }

/* The facts of what CHECK= found. */
static status remember_solutions(const solution_set *set,
                                 increment_summary *i) {
  status st = OK;
  if (set == NULL) goto done;
  NEW(i->solutions, set->n_found);
  i->n_solution = set->n_found;
  i->checked = 1;
  for (int k = 0; k < set->n_found; ++k) i->solutions[k] = set->found[k].facts;
done:
  return st;
}

static status remember_theory(const theory_report *t, increment_summary *i) {
  status st = OK;
  theory_contact *own = NULL;
  i->theory = *t;
  i->theory.contacts = NULL;
  i->theory.n_contact = 0;
  if (t->n_contact == 0) goto done;
  NEW(own, t->n_contact);
  memcpy(own, t->contacts, (size_t)t->n_contact * sizeof *own);
  i->theory.contacts = own;
  i->theory.n_contact = t->n_contact;
done:
  return st;
}

static status remember(output *o, const state *s) {
  status st = OK;
  run_summary *run = &o->run;
  GROW(run->increments, run->n_increment, run->capacity);
  increment_summary *i = &run->increments[run->n_increment++];
  *i = (increment_summary){.step_no = s->step_no,
                           .increment_no = s->increment_no,
                           .total_no = s->total_no,
                           .attempt = s->attempt,
                           .t = s->t,
                           .dt = s->dt,
                           .n_open = s->n_open,
                           .n_slip = s->n_slip,
                           .n_stick = s->n_stick,
                           .iterations = s->report.iterations,
                           .settled = s->settled,
                           .outcome = s->report.outcome,
                           .residual = s->report.residual,
                           .error = s->error,
                           .mesh_error = s->mesh_error,
                           .time_error = s->time_error,
                           .truth = s->truth,
                           .balance = s->balance,
                           .jumps = s->jumps,
                           .jump_t = s->jump_t,
                           .defect = energy_defect_relative(&s->energy)};
  if (s->surface != NULL)
    run->residual_worst = worse(run->residual_worst, s->report.residual);
  run->defect_worst = worse(run->defect_worst, fabs(i->defect));
  if (s->flow != NULL) run->tally = *s->flow->tally;
  TRY(remember_solutions(s->solutions, i));
  TRY(remember_theory(&s->theory, i));
  if (!s->settled) ++run->n_unsettled;
done:
  return st;
}

/* ---- what the loop tells ---------------------------------------------- */

/* Told again when a step has other supports. */
static status sink_ready(void *ctx, const setup_facts *facts,
                         const contact_surface *surface) {
  output *o = ctx;
  job j = job_of(o);
  (void)surface;
  o->run.facts = *facts;
  o->run.facts_known = 1;
  if (o->quiet) {
    o->quiet = 0;
    return OK;
  }
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

/* Wall clock, s; only its differences count. */
static double clock_now(void) {
  struct timespec now;
  clock_gettime(CLOCK_MONOTONIC, &now);
  return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* The text is written anew each time, so not more than once in XDMF_PAUSE
 * seconds: the cost stays small however long it grows. */
static status show_records(output *o, int all) {
  status st = OK;
  hdf5_shape shape;
  if (o->h5 == NULL) return OK;
  hdf5_shape_of(o->h5, &shape);
  if (shape.n_record == o->n_xdmf) return OK;
  double now = clock_now();
  if (!all && o->n_xdmf > 0 && now < o->xdmf_at + XDMF_PAUSE) return OK;
  TRY(xdmf_write(&shape, o->xdmf));
  o->n_xdmf = shape.n_record;
  o->xdmf_at = now;
done:
  return st;
}

static status write_fields(output *o, const state *s) {
  status st = OK;
  if (o->h5 == NULL) return OK;
  timer_enter(STAGE_HDF5);
  st = hdf5_increment(o->h5, s);
  if (st == OK) st = show_records(o, 0);
  timer_leave(STAGE_HDF5);
  return st;
}

static int same_file(const char *a, const char *b) {
  struct stat one, other;
  if (a == NULL || stat(a, &one) != 0 || stat(b, &other) != 0) return 0;
  return one.st_dev == other.st_dev && one.st_ino == other.st_ino;
}

/* A file the deck reads is no result: it must stay. */
static status spare_input(const output *o, const char *path) {
  status st = OK;
  const model *m = o->m;
  static const char advice[] =
      "the results would overwrite its file; name the deck or the file "
      "otherwise, or use -o";
  if (same_file(m->problem_file, path))
    FAIL(ERR_DECK, "deck line %d: *CONDENSED PROBLEM, FILE=%s: %s",
         m->problem_at.line_no, m->problem_file, advice);
  if (same_file(m->start.file, path))
    FAIL(ERR_DECK, "deck line %d: *INITIAL CONDITIONS, FILE=%s: %s",
         m->start.file_at.line_no, m->start.file, advice);
done:
  return st;
}

/* The condensed problem, where asked for; of an attempt that failed without a
 * solution, replaced when the increment is mended. */
static status write_condensed(output *o, const state *s) {
  status st = OK;
  const step *now = &o->m->steps[s->step_no - 1];
  char name[512], text[200];
  char *path = NULL;
  if (s->problem == NULL || !frequency_shows(now->condensed_frequency,
                                             s->increment_no, s->end_of_step))
    return OK;
  timer_enter(STAGE_FCLIB);
  snprintf(name, sizeof name, "%s_condensed_%05d", o->m->job,
           o->run.n_increment + 1);
  snprintf(text, sizeof text, "Protis %s: step %d, increment %d, time %.9g",
           o->o.version != NULL ? o->o.version : "", s->step_no,
           s->increment_no, s->t);
  path = text_path(o->o.dir, name, "h5");
  if (path == NULL) FAIL(ERR_MEMORY, "memory exhausted: name of a file");
  TRY(spare_input(o, path));
  TRY(fclib_write(s->problem, s->settled ? s->uc : NULL, s->rc, o->m->title,
                  text, path));
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
  TRY(remember(o, s));
  TRY(sta_line(&o->o, s, NULL, &o->sta));
done:
  timer_leave(STAGE_LISTING);
  return st;
}

static status sink_increment(void *ctx, const state *s) {
  status st = OK;
  output *o = ctx;
  TRY(write_fields(o, s));
  TRY(write_condensed(o, s));
  TRY(write_tables(o, s));
  o->attempt = 1;
  if (o->progress) progress_show(s);
done:
  return st;
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
  cvg_line(o->run.n_increment + 1, o->attempt, s, &o->cvg);
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

/* ---- files of an earlier run ------------------------------------------- */

static void release(output *o) {
  plan_free(o->plan);
  memory_free(o->json);
  memory_free(o->xdmf);
  for (int i = 0; i < o->run.n_increment; ++i) {
    memory_free(o->run.increments[i].solutions);
    memory_free((void *)o->run.increments[i].theory.contacts);
  }
  memory_free(o->run.increments);
  memory_free(o->kept);
  memory_free(o->facts);
  memory_free(o->whys);
  memory_free(o);
}

/* What an earlier run left must not be taken for a result of this one. */
static status remove_old(const output *o, const char *suffix) {
  status st = OK;
  char *path = text_path(o->o.dir, o->m->job, suffix);
  if (path == NULL) FAIL(ERR_MEMORY, "memory exhausted: name of a file");
  if (unlink(path) != 0 && errno != ENOENT)
    TRY(text_failed(path, "remove the earlier", errno));
done:
  memory_free(path);
  return st;
}

static status spare_suffix(const output *o, const char *suffix) {
  status st = OK;
  char *path = text_path(o->o.dir, o->m->job, suffix);
  if (path == NULL) FAIL(ERR_MEMORY, "memory exhausted: name of a file");
  TRY(spare_input(o, path));
done:
  memory_free(path);
  return st;
}

/* length: of the file to go on with; -1: a new one. */
static status open_text(const output *o, const char *suffix, long length,
                        text_file *t) {
  status st = OK;
  char *path = text_path(o->o.dir, o->m->job, suffix);
  if (path == NULL) FAIL(ERR_MEMORY, "memory exhausted: name of a file");
  if (length < 0)
    TRY(text_open(t, path, 1));
  else
    TRY(text_reopen(t, path, 1, length));
done:
  memory_free(path);
  return st;
}

/* ---- what the files are gone on with from -------------------------------- */

/* Lengths of the text files, bytes, -1: there is none; rows of JOB.h5. */
typedef struct file_ends {
  long lst, sta, cvg, dat;
  int has_h5;
  hdf5_count h5;
} file_ends;

/* Number of a reason among the lines of o->whys, from 1; a new one is added;
 * 0: no reason. */
static size_t why_no(output *o, size_t *used, const char *why) {
  size_t no = 1, length = why == NULL ? 0 : strlen(why);
  if (why == NULL) return 0;
  for (char *line = o->whys; *line != '\0'; ++no) {
    char *end = strchr(line, '\n');
    if ((size_t)(end - line) == length && memcmp(line, why, length) == 0)
      return no;
    line = end + 1;
  }
  memcpy(o->whys + *used, why, length);
  o->whys[*used + length] = '\n';
  *used += length + 1;
  return no;
}

static size_t room_for(const char *why) {
  return why == NULL ? 0 : strlen(why) + 1;
}

/* A pointer in a file: the number of what it points to. */
static const char *as_pointer(size_t no) { return (const char *)no; }

/* The increments with numbers in the place of pointers. */
static status copy_increments(output *o, size_t *used, int *n_fact) {
  status st = OK;
  const run_summary *run = &o->run;
  size_t room = 1;
  memory_free(o->kept);
  memory_free(o->facts);
  memory_free(o->whys);
  o->kept = NULL;
  o->facts = NULL;
  o->whys = NULL;
  for (int i = 0; i < run->n_increment; ++i) {
    const increment_summary *s = &run->increments[i];
    room += room_for(s->error.why) + room_for(s->mesh_error.why) +
            room_for(s->time_error.why);
    *n_fact += s->n_solution;
  }
  NEW(o->kept, run->n_increment);
  NEW(o->facts, *n_fact);
  NEW(o->whys, room);
  *n_fact = 0;
  for (int i = 0; i < run->n_increment; ++i) {
    increment_summary *s = &o->kept[i];
    *s = run->increments[i];
    s->error.why = as_pointer(why_no(o, used, s->error.why));
    s->mesh_error.why = as_pointer(why_no(o, used, s->mesh_error.why));
    s->time_error.why = as_pointer(why_no(o, used, s->time_error.why));
    for (int k = 0; k < s->n_solution; ++k)
      o->facts[(*n_fact)++] = s->solutions[k];
    s->solutions = NULL;
  }
done:
  return st;
}

/* What both ways have in common. */
static status keep_counts(output *o, archive *a, file_ends *ends) {
  status st = OK;
  run_summary *run = &o->run;
  TRY(archive_bytes(a, "ends", ends, sizeof *ends));
  TRY(archive_ints(a, "attempt", &o->attempt, 1));
  TRY(archive_ints(a, "increments", &run->n_increment, 1));
  TRY(archive_ints(a, "rejected", &run->n_rejected, 1));
  TRY(archive_ints(a, "unsettled", &run->n_unsettled, 1));
  TRY(archive_reals(a, "residual_worst", &run->residual_worst, 1));
  TRY(archive_reals(a, "defect_worst", &run->defect_worst, 1));
done:
  return st;
}

static status keep_increments(output *o, archive *a) {
  status st = OK;
  size_t used = 0, n = (size_t)o->run.n_increment;
  int n_fact = 0;
  TRY(copy_increments(o, &used, &n_fact));
  TRY(archive_bytes(a, "summary", o->kept, n * sizeof *o->kept));
  TRY(archive_bytes(a, "whys", o->whys, used));
  TRY(archive_bytes(a, "solutions", o->facts,
                    (size_t)n_fact * sizeof *o->facts));
done:
  return st;
}

status output_keep(output *o, archive *a) {
  status st = OK;
  file_ends ends;
  memset(&ends, 0, sizeof ends);
  archive_enter(a, "output");
  TRY(text_sync(&o->lst, &ends.lst));
  TRY(text_sync(&o->sta, &ends.sta));
  TRY(text_sync(&o->cvg, &ends.cvg));
  TRY(tabular_sync(o->dat, &ends.dat));
  ends.has_h5 = o->h5 != NULL;
  TRY(hdf5_sync(o->h5, &ends.h5));
  TRY(keep_counts(o, a, &ends));
  TRY(keep_increments(o, a));
done:
  archive_leave(a);
  return st;
}

/* The reason of a number; the lines are ended by NUL here. */
static const char *why_of(const output *o, const char *as_number) {
  size_t no = (size_t)as_number;
  const char *line = o->whys;
  if (no == 0 || line == NULL) return NULL;
  for (; no > 1 && *line != '\0'; --no) line += strlen(line) + 1;
  return line;
}

static status read_reasons(output *o, archive *a) {
  status st = OK;
  size_t n = archive_length(a, "whys");
  if (n == 0) goto done;
  NEW(o->whys, n + 1);
  TRY(archive_bytes(a, "whys", o->whys, n));
  for (size_t i = 0; i < n; ++i)
    if (o->whys[i] == '\n') o->whys[i] = '\0';
done:
  return st;
}

static status read_increments(output *o, archive *a) {
  status st = OK;
  run_summary *run = &o->run;
  size_t n = (size_t)run->n_increment, n_fact = 0, next = 0;
  NEW(run->increments, n);
  run->capacity = run->n_increment;
  TRY(archive_bytes(a, "summary", run->increments,
                    n * sizeof *run->increments));
  TRY(read_reasons(o, a));
  n_fact = archive_length(a, "solutions") / sizeof *o->facts;
  NEW(o->facts, n_fact);
  TRY(archive_bytes(a, "solutions", o->facts, n_fact * sizeof *o->facts));
  for (size_t i = 0; i < n; ++i) {
    increment_summary *s = &run->increments[i];
    s->error.why = why_of(o, s->error.why);
    s->mesh_error.why = why_of(o, s->mesh_error.why);
    s->time_error.why = why_of(o, s->time_error.why);
    if (s->n_solution <= 0) continue;
    NEW(s->solutions, s->n_solution);
    for (int k = 0; k < s->n_solution && next < n_fact; ++k)
      s->solutions[k] = o->facts[next++];
  }
done:
  return st;
}

/* ---- open and close --------------------------------------------------- */

static status open_hdf5(output *o, const hdf5_count *before) {
  if (!model_writes_fields(o->m)) return OK;
  timer_enter(STAGE_HDF5);
  status st = hdf5_open(o->m, o->msh, &o->o, before, &o->h5);
  timer_leave(STAGE_HDF5);
  return st;
}

static status open_new(output *o) {
  status st = OK;
  job j = job_of(o);
  static const char *const old[] = {"h5", "xdmf", "json", "rst.h5",
                                    "rst.old.h5"};
  TRY(open_text(o, "lst", -1, &o->lst));
  TRY(open_text(o, "sta", -1, &o->sta));
  TRY(open_text(o, "cvg", -1, &o->cvg));
  for (size_t k = 0; k < sizeof old / sizeof *old; ++k)
    TRY(remove_old(o, old[k]));
  TRY(tabular_open(o->m, o->msh, o->o.dir, -1, &o->dat));
  if (o->dat == NULL) TRY(remove_old(o, "dat"));
  TRY(sta_header(&o->o, &o->sta));
  cvg_header(&o->cvg);
  TRY(text_check(&o->cvg));
  TRY(listing_open(&j, &o->lst));
  TRY(open_hdf5(o, NULL));
done:
  return st;
}

static status open_earlier(output *o) {
  status st = OK;
  archive *a = o->o.from;
  file_ends ends;
  archive_enter(a, "output");
  TRY(keep_counts(o, a, &ends));
  TRY(read_increments(o, a));
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
  status st = OK;
  static const char *const results[] = {"lst",    "sta",        "cvg",    "dat",
                                        "h5",     "xdmf",       "json",   "tmp",
                                        "rst.h5", "rst.old.h5", "rst.tmp"};
  for (size_t k = 0; k < sizeof results / sizeof *results; ++k)
    TRY(spare_suffix(o, results[k]));
  o->json = text_path(o->o.dir, o->m->job, "json");
  o->xdmf = text_path(o->o.dir, o->m->job, "xdmf");
  if (o->json == NULL || o->xdmf == NULL)
    FAIL(ERR_MEMORY, "memory exhausted: name of a file");
  TRY(o->o.from == NULL ? open_new(o) : open_earlier(o));
done:
  return st;
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
  TRY(plan_new(m, m->has_problem ? NULL : msh, opt->n_problem, &o->plan));
  TRY(open_all(o));
  *out = o;
done:
  if (st != OK && o != NULL) {
    text_close(&o->lst);
    text_close(&o->sta);
    text_close(&o->cvg);
    tabular_close(o->dat);
    release(o);
  }
  return st;
}

/* The first failure is the one told; the files after it are closed as well. */
static void first_of(status *kept, char *message, size_t size, status st) {
  if (st == OK || *kept != OK) return;
  *kept = st;
  snprintf(message, size, "%s", status_message());
}

static status verdict_of(status run, int unsettled) {
  return run == OK && unsettled > 0 ? ERR_UNSETTLED : run;
}

void output_passes(output *o, double target, int n, const pass_row *rows,
                   const pass_row *forecast, const char *why) {
  o->run.passes = (pass_table){target, n, rows, forecast, why};
}

status output_close(output *o, status run, int unsettled) {
  char message[2048] = "";
  status kept = OK;
  if (o == NULL) return verdict_of(run, unsettled);
  job j = job_of(o);
  if (o->progress) progress_line("");
  first_of(&kept, message, sizeof message, run);
  first_of(&kept, message, sizeof message, show_records(o, 1));
  first_of(&kept, message, sizeof message, hdf5_close(o->h5, kept == OK));
  first_of(&kept, message, sizeof message, tabular_close(o->dat));
  first_of(&kept, message, sizeof message, text_close(&o->cvg));
  first_of(&kept, message, sizeof message, text_close(&o->sta));
  o->run.message = message;
  o->run.verdict = verdict_of(kept, unsettled);
  first_of(&kept, message, sizeof message, listing_verdict(&j, &o->lst));
  first_of(&kept, message, sizeof message, text_close(&o->lst));
  o->run.verdict = verdict_of(kept, unsettled);
  first_of(&kept, message, sizeof message, json_write(&j, o->json));
  release(o);
  if (kept != OK) return status_fail(kept, __func__, __LINE__, "%s", message);
  return verdict_of(OK, unsettled);
}
