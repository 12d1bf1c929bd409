/*
 * JOB.rst.inc: the summaries of the increments, which the end of a run needs
 * and a restart must have. Each is written once: a restart file names the bytes
 * that count for it, so that its own size does not grow with the increments.
 *
 * A record: increment_summary without pointers, its reasons (text ended by NUL,
 * where there is one), its solutions.
 */
#include "output/open.h"

#include "base/memory.h"

#include <errno.h>
#include <string.h>

static const uint64_t EMPTY = 14695981039346656037u; /* FNV-1a */

static uint64_t add_bytes(uint64_t h, const void *data, size_t n) {
  const unsigned char *at = data;
  for (size_t i = 0; i < n; ++i) h = (h ^ at[i]) * 1099511628211u;
  return h;
}

static status open_file(output *o, const saved_end *end) {
  OWNED char *path = text_path(o->o.dir, o->m->name.job, "rst.inc");
  if (path == NULL) RAISE(ERR_MEMORY, "memory exhausted: name of a file");
  o->saved.end.checksum = end == NULL ? EMPTY : end->checksum;
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

/* They differ from run to run. */
static void leave_out_cpu(increment_summary *s) {
  s->error.cpu = s->mesh_error.cpu = s->time_error.cpu = 0.0;
  s->exact.cpu = s->balance.saved_cpu = 0.0;
}

static void append(saved_increments *to, const void *data, size_t n) {
  to->end.checksum = add_bytes(to->end.checksum, data, n);
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
  if (o->o.no_timing) leave_out_cpu(&s);
  append(&o->saved, &s, sizeof s);
  for (int k = 0; k < REASONS; ++k)
    if (text[k] != NULL) append(&o->saved, text[k], strlen(text[k]) + 1);
  if (s.n_solution > 0)
    append(&o->saved, from->solutions,
           (size_t)s.n_solution * sizeof *from->solutions);
}

status saved_append(output *o, saved_end *end) {
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
  const char *nul = memchr(r->at, '\0', (size_t)(r->end - r->at));
  return nul == NULL ? NULL : take(r, (size_t)(nul + 1 - r->at));
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
  const size_t n = (size_t)s->n_solution * sizeof *s->solutions;
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

status saved_read(output *o, const saved_end *end) {
  run_summary *run = &o->run;
  const size_t n = (size_t)end->length;
  const int count = run->n_increment;
  run->n_increment = 0; /* those that "release" may look at */
  PASS(open_file(o, end));
  PASS(read_file(o, n));
  if (add_bytes(EMPTY, o->saved.read, n) != end->checksum) return damaged(o);
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
