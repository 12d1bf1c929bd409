/*
 * The summary of the run: data of each increment for the end of the listing and
 * JOB.json, saved for a restart and read back.
 *
 * JOB.rst.inc: each summary is written once: a restart file names the bytes
 * that count for it, so that its own size does not grow with the increments. A
 * record: increment_summary without pointers, its reasons (text ended by NUL,
 * where there is one), its solutions.
 */
#include "output/writers.h"

#include "base/base.h"

#include <errno.h>

static status open_file(output *o, const saved_end *end) {
  OWNED_GET(char, path, text_path(o->o.dir, o->m->name.job, "rst.inc"));
  o->saved.end.checksum = end == NULL ? HASH_START : end->checksum;
  if (end == NULL) return text_open(&o->saved.file, path, 0);
  return text_reopen(&o->saved.file, path, 0, end->length);
}

/* ---- writing ------------------------------------------------------------- */

/* The reasons of an increment. */
enum { REASONS = 3 };

static void reasons_of(increment_summary *s, const char **why[REASONS]) {
  why[0] = &s->error.why;
  why[1] = &s->mesh_error.why;
  why[2] = &s->time_error.why;
}

static void append(saved_increments *to, const void *data, size_t n) {
  to->end.checksum = number_hash(to->end.checksum, data, n);
  fwrite(data, 1, n, to->file.f); /* checked by text_sync */
}

static void append_increment(output *o, const increment_summary *from) {
  increment_summary s = *from;
  const char **why[REASONS], *text[REASONS];
  reasons_of(&s, why);
  for (int k = 0; k < REASONS; ++k) {
    text[k] = *why[k];
    *why[k] = (const char *)(size_t)(text[k] != NULL);
  }
  s.solutions = NULL;
  s.theorems = (theorems_report){0}; /* such a run starts again (restart.c) */
  if (o->o.no_timing) {
    s.error.cpu = s.mesh_error.cpu = s.time_error.cpu = 0.0;
    s.exact.cpu = s.balance.saved_cpu = 0.0;
  }
  append(&o->saved, &s, sizeof s);
  for (int k = 0; k < REASONS; ++k)
    if (text[k] != NULL) append(&o->saved, text[k], strlen(text[k]) + 1);
  if (s.n_solution > 0)
    append(&o->saved, from->solutions, s.n_solution * sizeof *from->solutions);
}

/* Append the summaries of all increments since the last call to JOB.rst.inc,
 * which the first call makes, and synchronise it. ERR_FILE. */
static status saved_append(output *o, saved_end *end) {
  saved_increments *s = &o->saved;
  if (s->file.f == NULL) PASS(open_file(o, NULL));
  while (s->n < o->run.n_increment)
    append_increment(o, &o->run.increments[s->n++]);
  PASS(text_sync(&s->file, &s->end.length));
  *end = s->end;
  return OK;
}

/* ---- reading ------------------------------------------------------------- */

typedef struct reader {
  char *at, *end; /* what is left */
} reader;

/* The next n bytes, NULL: so many are not left. */
static char *take(reader *r, size_t n) {
  char *at = r->at;
  if (n > (size_t)(r->end - r->at)) return NULL;
  r->at += n;
  return at;
}

/* The next text. */
static const char *take_text(reader *r) {
  const char *nul = memchr(r->at, '\0', r->end - r->at);
  return nul == NULL ? NULL : take(r, nul + 1 - r->at);
}

static status damaged(const output *o) {
  return status_fail(ERR_FILE, __func__, __LINE__,
                     "--restart: %s is damaged: its beginning is not what was "
                     "saved; start the run without --restart",
                     o->saved.file.path);
}

static status take_increment(const output *o, reader *r, increment_summary *s) {
  const char **why[REASONS], *bytes = take(r, sizeof *s);
  if (bytes == NULL) return damaged(o);
  memcpy(s, bytes, sizeof *s);
  s->solutions = NULL;
  reasons_of(s, why);
  for (int k = 0; k < REASONS; ++k)
    if (*why[k] != NULL && (*why[k] = take_text(r)) == NULL) return damaged(o);
  if (s->n_solution <= 0) return OK;
  const size_t n = s->n_solution * sizeof *s->solutions;
  const char *solutions = take(r, n);
  if (solutions == NULL) return damaged(o);
  PASS_NEW(s->solutions, s->n_solution);
  memcpy(s->solutions, solutions, n);
  return OK;
}

/* All bytes up to the end into o->saved.read. */
static status read_file(output *o, size_t n) {
  FILE *f = o->saved.file.f;
  PASS_NEW(o->saved.read, n + 1);
  errno = 0;
  rewind(f);
  if (fread(o->saved.read, 1, n, f) != n || fseek(f, 0, SEEK_END) != 0)
    return text_failed(o->saved.file.path, "read", errno);
  return OK;
}

/* o->run.increments of a file; what follows is cut. ERR_FILE: damaged. */
static status saved_read(output *o, const saved_end *end) {
  run_summary *run = &o->run;
  const size_t n = end->length;
  const int count = run->n_increment;
  run->n_increment = 0; /* those that "release" may look at */
  PASS(open_file(o, end));
  PASS(read_file(o, n));
  if (number_hash(HASH_START, o->saved.read, n) != end->checksum)
    return damaged(o);
  reader r = {o->saved.read, o->saved.read + n};
  PASS_NEW(run->increments, count);
  run->capacity = count;
  for (int i = 0; i < count; ++i) {
    run->n_increment = i + 1;
    PASS(take_increment(o, &r, &run->increments[i]));
  }
  o->saved.n = count;
  return OK;
}

const column *job_end_column(const model *m, column_walk *w) {
  const column *c;
  do c = column_next(w);
  while (c != NULL && (c->of != PER_CONTACT || c->form == AS_WORD ||
                       !(c->tables & PRINT_TOTALS) || !column_visible(c, m)));
  return c;
}

size_t job_end_size(const model *m) {
  size_t n = 0;
  for (column_walk w = columns_of(PER_CONTACT); job_end_column(m, &w) != NULL;)
    ++n;
  return 2 + n * m->n.contact;
}

/* The contacts of the last increment so far of the step. */
static void remember_contacts(output *o, const state *s) {
  const view v = {o->m, o->msh, s};
  double *to = o->run.ends + (s->step_no - 1) * job_end_size(o->m);
  *to++ = s->increment_no;
  *to++ = s->t;
  for (int i = 0; i < o->m->n.contact; ++i) {
    const column *c;
    for (column_walk w = columns_of(PER_CONTACT);
         (c = job_end_column(o->m, &w)) != NULL;)
      *to++ = column_ready(c, s) ? c->value(&v, i, c->part) : NAN;
    if (s->contacts.totals != NULL)
      o->run.penetration_worst = job_worse(o->run.penetration_worst,
                                           s->contacts.totals[i].penetration);
  }
}

/* The facts of what CHECK= found. */
static status remember_solutions(const solution_set *set,
                                 increment_summary *i) {
  if (set == NULL) return OK;
  PASS_NEW(i->solutions, set->n_found);
  i->n_solution = set->n_found;
  i->checked = 1;
  for (int k = 0; k < set->n_found; ++k) i->solutions[k] = set->found[k].facts;
  return OK;
}

static status remember_theory(const theorems_report *t, increment_summary *i) {
  theorems_contact *own = NULL;
  i->theorems = *t;
  i->theorems.contacts = NULL;
  i->theorems.n_contact = 0;
  if (t->n_contact == 0) return OK;
  PASS_NEW(own, t->n_contact);
  COPY(own, t->contacts, t->n_contact);
  i->theorems.contacts = own;
  i->theorems.n_contact = t->n_contact;
  return OK;
}

status output_remember(output *o, const state *s) {
  run_summary *run = &o->run;
  ADDED(increment_summary, i, run->increments, run->n_increment, run->capacity);
  *i = (increment_summary){.step_no = s->step_no,
                           .increment_no = s->increment_no,
                           .attempt = s->attempt,
                           .t = s->t,
                           .dt = s->dt,
                           .count.open = s->contacts.n_open,
                           .count.slip = s->contacts.n_slip,
                           .count.stick = s->contacts.n_stick,
                           .iterations = s->report.iterations,
                           .settled = s->settled,
                           .after_miss = s->errors.after_miss,
                           .outcome = s->report.outcome,
                           .residual = s->report.residual,
                           .error = s->errors.error,
                           .rounding = s->errors.rounding,
                           .mesh_error = s->errors.mesh_error,
                           .time_error = s->errors.time_error,
                           .exact = s->errors.exact,
                           .balance = s->errors.balance,
                           .jumps = s->errors.jumps,
                           .jump_t = s->errors.jump_t,
                           .defect = energy_defect_relative(&s->energy)};
  if (s->contacts.surface != NULL)
    run->residual_worst = job_worse(run->residual_worst, s->report.residual);
  run->defect_worst = job_worse(run->defect_worst, fabs(i->defect));
  if (s->body.flow != NULL) run->tally = *s->body.flow->tally;
  PASS(remember_solutions(s->errors.solutions, i));
  PASS(remember_theory(&s->errors.theorems, i));
  remember_contacts(o, s);
  if (s->errors.goals != NULL)
    COPY(run->goals + (s->step_no - 1) * s->errors.n_goal, s->errors.goals,
         s->errors.n_goal);
  if (!s->settled) ++run->n_unsettled;
  return OK;
}

/* All but the name of the ordering. */
static status keep_setup(setup_facts *f, archive *a) {
  condense_info *i = &f->info;
  PASS(archive_bytes(a, "unknowns", &i->unknowns, sizeof i->unknowns));
  PASS(archive_bytes(a, "contact_unknowns", &i->contact_unknowns,
                     sizeof i->contact_unknowns));
  PASS(archive_bytes(a, "factor_entries", &i->factor_entries,
                     sizeof i->factor_entries));
  PASS(archive_ints(a, "bodies", &i->bodies, 1));
  PASS(archive_reals(a, "flops", &i->flops, 1));
  PASS(archive_bytes(a, "bytes", &i->bytes, sizeof i->bytes));
  PASS(archive_reals(a, "condition", &f->condition, 1));
  PASS(archive_reals(a, "digits", &f->digits, 1));
  PASS(archive_ints(a, "floating", &f->floating, 1));
  PASS(archive_ints(a, "n_contact_node", &f->n_contact_node, 1));
  PASS(archive_ints(a, "n_left_out", &f->n_left_out, 1));
  return archive_reals(a, "average_entries", &f->average_entries, 1);
}

/* Common part of writing and reading. */
static status keep_counts(output *o, archive *a, file_ends *ends) {
  run_summary *run = &o->run;
  PASS(archive_bytes(a, "ends", ends, sizeof *ends));
  PASS(keep_setup(&run->facts, a));
  PASS(archive_ints(a, "attempt", &o->attempt, 1));
  PASS(archive_ints(a, "increments", &run->n_increment, 1));
  PASS(archive_ints(a, "rejected", &run->n_rejected, 1));
  PASS(archive_ints(a, "unsettled", &run->n_unsettled, 1));
  PASS(archive_reals(a, "residual_worst", &run->residual_worst, 1));
  PASS(archive_reals(a, "defect_worst", &run->defect_worst, 1));
  PASS(archive_reals(a, "penetration_worst", &run->penetration_worst, 1));
  return archive_bytes(a, "tally", &run->tally, sizeof run->tally);
}

/* Without seconds, which differ from run to run. */
static status keep_goals(output *o, archive *a, size_t steps) {
  const size_t n = steps * o->m->n.goal;
  for (size_t i = 0; i < n; ++i) {
    goal_result *g = &o->run.goals[i];
    const double cpu = g->cpu;
    g->cpu = 0.0;
    status st = archive_bytes(a, text_of("goal%zu", i), g, sizeof *g);
    g->cpu = cpu;
    if (st != OK) return st;
  }
  return OK;
}

/* The steps so far, written or read. */
static status keep_ends(output *o, archive *a) {
  const int n = o->run.n_increment;
  const size_t steps = n > 0 ? o->run.increments[n - 1].step_no : 0;
  PASS(archive_reals(a, "contact_ends", o->run.ends,
                     steps * job_end_size(o->m)));
  return keep_goals(o, a, steps);
}

status output_keep(output *o, archive *a) {
  file_ends ends;
  memset(&ends, 0, sizeof ends);
  IN_GROUP(a, "output");
  PASS(text_sync(&o->lst, &ends.lst));
  PASS(text_sync(&o->sta, &ends.sta));
  PASS(text_sync(&o->cvg, &ends.cvg));
  PASS(tabular_sync(o->dat, &ends.dat));
  ends.has_h5 = o->h5 != NULL;
  PASS(hdf5_sync(o->h5, &ends.h5));
  PASS(saved_append(o, &ends.increments));
  PASS(keep_counts(o, a, &ends));
  return keep_ends(o, a);
}

status output_read(output *o, archive *a, file_ends *ends) {
  PASS(keep_counts(o, a, ends));
  PASS(saved_read(o, &ends->increments));
  return keep_ends(o, a);
}
