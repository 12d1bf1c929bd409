/* The restart file: its origin, and whether a deck may continue from it. */
#include "base/base.h"
#include "base/file.h"
#include "base/number.h"
#include "base/system/blas.h"
#include "base/system/input.h"
#include "mesh/msh/geo.h"
#include "model/keyword/keyword.h"
#include "program/inform.h"
#include "program/job.h"
#include "run/setup/setup.h"

#include <ctype.h>
#include <errno.h>
#include <inttypes.h>
#include <unistd.h>

/* ---- origin -------------------------------------------------------- */

typedef struct identity {
  char version[40], kernel[40];
  int threads, no_timing, step_no;
  unsigned effects;
  uint64_t mesh;
} identity;

/* Nodes, elements and groups in their order. */
static uint64_t mesh_hash(const mesh *s) {
  size_t dim = s->dim;
  uint64_t h = number_hash(HASH_START, s->x, dim * s->n_node * sizeof *s->x);
  h = number_hash(h, s->elem, (dim + 1) * s->n_elem * sizeof *s->elem);
  for (int i = 0; i < s->n_group; ++i)
    h = number_hash(h, s->group[i].node_id,
                    s->group[i].n_node * sizeof *s->group[i].node_id);
  return h;
}

static void identify(const command *c, const job_input *in, identity *id) {
  memset(id, 0, sizeof *id);
  snprintf(id->version, sizeof id->version, "%s", PROTIS_VERSION);
  snprintf(id->kernel, sizeof id->kernel, "%s", blas_kernel());
  id->threads = c->threads;
  id->no_timing = c->no_timing;
  id->effects = in->m->effects;
  id->mesh = mesh_hash(in->msh);
}

/* ---- warnings reported so far -------------------------------------------- */

/* Number of a file of the deck, which another name may lead to, or -1. */
static int file_no(const deck *d, const char *file) {
  for (int i = 0; i < d->n_file; ++i)
    if (strcmp(d->files[i], file) == 0) return i;
  return -1;
}

/* A line each: number, line, column, number of the file, text; file before. */
static status list_warnings(FILE *f, const void *what) {
  const job_input *in = what;
  message_view w;
  for (int k = 0; message_get(in->m->log, k, &w); ++k) {
    const char *file = w.at != NULL && w.at->file != NULL ? w.at->file : "";
    if (w.level == WARNING)
      fprintf(f, "%s\n%d %d %d %d %s\n", file, (int)w.id,
              w.at != NULL ? w.at->line_no : 0,
              w.at != NULL ? w.at->column_no : 0, file_no(in->d, file), w.text);
  }
  return OK;
}

/* That of a card, which knows its line and where it is included from. */
static const place *place_in_deck(const deck *d, const place *at) {
  for (int i = 0; i < d->n_card; ++i) {
    const place *p = &d->cards[i].at;
    if (p->line_no == at->line_no && p->column_no == at->column_no &&
        p->file != NULL && strcmp(p->file, at->file) == 0)
      return p;
  }
  return at;
}

/* Messages of the run so far, so that repeated ones are recognised. */
static status report_warnings(const job_input *in, archive *a) {
  char *end;
  OWNED_OF(char, text, archive_text(a, "warnings", &text));
  for (char *line = text; (end = strchr(line, '\n')) != NULL; line = end + 1) {
    int id, no, used = 0;
    *end = '\0';
    place at = {.file = line};
    line = end + 1;
    if ((end = strchr(line, '\n')) == NULL) break;
    *end = '\0';
    if (sscanf(line, "%d %d %d %d%n", &id, &at.line_no, &at.column_no, &no,
               &used) != 4)
      break;
    if (no >= 0 && no < in->d->n_file) at.file = in->d->files[no];
    message_add(in->m->log, (message_id)id,
                at.file[0] != '\0' ? place_in_deck(in->d, &at) : NULL, "%s",
                line + used + 1);
  }
  return OK;
}

/* ---- writing ------------------------------------------------------------- */

static status file_names(const command *c, const model *m, char **path,
                         char **before) {
  PASS_GET(*path, text_path(c->dir, m->name.job, "rst.h5"));
  PASS_GET(*before, text_path(c->dir, m->name.job, "rst.old.h5"));
  return OK;
}

status restart_write(void *ctx, run *r) {
  const restart_writer *w = ctx;
  ENDS_BY(archive_free) archive *a = NULL;
  identity id;
  OWNED char *path = NULL, *before = NULL, *text = NULL, *reported = NULL;
  PASS(file_names(w->c, w->in->m, &path, &before));
  PASS(text_made(&text, w->in->m, model_echo));
  PASS(text_made(&reported, w->in, list_warnings));
  identify(w->c, w->in, &id);
  id.step_no = r->at.step_id + 1;
  PASS(archive_new(&a));
  if (w->c->no_timing) archive_leave_out_cpu(a);
  PASS(archive_bytes(a, "identity", &id, sizeof id));
  PASS(archive_bytes(a, "deck", text, strlen(text) + 1));
  PASS(archive_bytes(a, "warnings", reported, strlen(reported)));
  PASS(archive_bytes(a, "files", w->files, strlen(w->files)));
  PASS(output_keep(w->out, a));
  PASS(run_keep(r, a));
  return archive_write(a, path, before);
}

/* ---- files the deck names ------------------------------------------------ */

/* Length and checksum (FNV-1a over words) of what stands in a file. */
static status add_content(const char *name, const char *path, FILE *out) {
  const char *why = NULL;
  uint64_t part[1024], bytes = 0, h = HASH_START;
  size_t n;
  FILE *f ENDS_BY(file_leave) = input_stream(path, &why);
  if (f == NULL) { /* reported by the card that needs it, with its line */
    fprintf(out, ", FILE=%s, not read\n", name);
    return OK;
  }
  do {
    memset(part, 0, sizeof part);
    n = fread(part, 1, sizeof part, f);
    for (size_t i = 0; 8 * i < n; ++i) h = (h ^ part[i]) * 1099511628211u;
    bytes += n;
  } while (n == sizeof part);
  if (ferror(f)) return text_failed(path, "read", errno);
  fprintf(out, ", FILE=%s, %" PRIu64 " bytes, checksum %016" PRIx64 "\n", name,
          bytes, h);
  return OK;
}

/* Files that a .geo includes, by names as seen from its folder. */
static status add_geometry(const char *path, FILE *out) {
  geo_text g ENDS_BY(geo_free) = {0};
  PASS(geo_read(path, &g));
  const char *slash = strrchr(path, '/');
  size_t folder = slash != NULL ? slash - path + 1 : 0;
  for (int i = 1; i < g.n_file; ++i) {
    size_t pass = strncmp(g.file[i], path, folder) == 0 ? folder : 0;
    fprintf(out, "0 *MESH");
    PASS(add_content(g.file[i] + pass, g.file[i], out));
  }
  return OK;
}

/* A line for each card that names one, with its step. */
static status add_files(FILE *out, const void *what) {
  const job_input *in = what;
  int step_no = 0;
  for (EACH(const card, c, in->d->cards, in->d->n_card)) {
    const parameter *file = card_parameter(c, "FILE");
    if (strcmp(c->name, "STEP") == 0) ++step_no;
    if (file == NULL || !file->has_value) continue;
    const char *path;
    PASS_GET(path, deck_path(in->d, &file->value));
    fprintf(out, "%d *%s", step_no, c->name);
    PASS(add_content(file->value.text, path, out));
    if (strcmp(c->name, "MESH") == 0 && mesh_is_program(path))
      PASS(add_geometry(path, out));
  }
  return OK;
}

status restart_files(const job_input *in, char **text) {
  return text_made(text, in, add_files);
}

/* The decks are the same up to that step: so are the cards of these lines. */
static status compare_files(const char *was, const char *is, int step_no) {
  while (*was != '\0' && *is != '\0' && atoi(was) <= step_no) {
    size_t n = strcspn(was, "\n"), m = strcspn(is, "\n");
    size_t from = strcspn(was, " "), name = n;
    if (n == m && memcmp(was, is, n) == 0) {
      was += n + 1;
      is += n + 1;
      continue;
    }
    for (int comma = 0; comma < 2; ++comma)
      while (name > from && was[--name] != ',') continue;
    RAISE(
        ERR_DECK,
        "--restart: another file than when the run was started:%.*s: has other "
        "contents; put the earlier one back, or start the run without "
        "--restart",
        (int)(name - from), was + from);
  }
  return OK;
}

/* ---- which cards may change ---------------------------------------------- */

/* One card of an echo: "*NAME ... " up to the next one. */
typedef struct echo_card {
  const char *text;
  size_t length; /* 0: the end */
  int step_no;   /* 0: before the first step */
} echo_card;

/* Cards that start a line with a star; data lines never do. */
static void next_card(echo_card *c) {
  c->text += c->length;
  c->length = strlen(c->text);
  const char *end = strstr(c->text, "\n*");
  if (end != NULL) c->length = end + 1 - c->text;
  if (strncmp(c->text, "*STEP", 5) == 0) ++c->step_no;
}

static int is_named(const echo_card *c, const char *name) {
  size_t n = strlen(name);
  return strncmp(c->text + 1, name, n) == 0 &&
         (c->text[n + 1] == ',' || c->text[n + 1] == '\n');
}

/* 1: the card may be another one, or not be there. */
static int is_free(const echo_card *c, int step_no) {
  static const char *const names[] = {"BOUNDARY", "DSLOAD",      "DLOAD",
                                      "CLOAD",    "TEMPERATURE", "SOLVER",
                                      "ACCURACY", "PRINT",       "OUTPUT"};
  if (c->length == 0) return 0;
  if (is_named(c, "RESTART")) return 1;
  if (c->step_no <= step_no) return 0;
  for (size_t k = 0; k < sizeof names / sizeof *names; ++k)
    if (is_named(c, names[k])) return 1;
  return 0;
}

static void next_bound(echo_card *c, int step_no) {
  do next_card(c);
  while (is_free(c, step_no));
}

/* The first line of a card. */
static void first_line(const echo_card *c, char text[100]) {
  const char *from = c->length > 0 ? c->text : "the end of the deck";
  const size_t n = strcspn(from, "\n");
  snprintf(text, 100, "%.*s", n < 90 ? (int)n : 90, from);
}

/* Length of the number without sign at the start of a text, or 0. */
static size_t number_length(const char *text) {
  size_t n = strspn(text, "0123456789.");
  if (n == 0 || text[n] == '\0' || strchr("eEdD", text[n]) == NULL) return n;
  const size_t sign = text[n + 1] == '+' || text[n + 1] == '-';
  const size_t digits = strspn(text + n + 1 + sign, "0123456789");
  return digits > 0 ? n + 1 + sign + digits : n;
}

/* Two numbers of one value. Digits alone may be part of a name: as text. */
static int is_same_number(const char *a, size_t n, const char *b, size_t m) {
  double x, y;
  char one[64], other[64];
  if (n == 0 || m == 0 || n >= sizeof one || m >= sizeof other) return 0;
  snprintf(one, sizeof one, "%.*s", (int)n, a);
  snprintf(other, sizeof other, "%.*s", (int)m, b);
  if (strpbrk(one, ".eEdD") == NULL && strpbrk(other, ".eEdD") == NULL)
    return 0;
  return number_real(one, &x) == NULL && number_real(other, &y) == NULL &&
         x == y;
}

/* The same but for how numbers are spelled, and where a line goes on. */
static int is_same_card(const echo_card *one, const echo_card *other) {
  const char *a = one->text, *b = other->text;
  for (int in_name = 0; a < one->text + one->length;) {
    const size_t n = in_name ? 0 : number_length(a);
    const size_t m = in_name ? 0 : number_length(b);
    if (is_same_number(a, n, b, m)) {
      a += n;
      b += m;
      continue;
    }
    if (*a != *b) return 0;
    const int goes_on = *a == ',';
    in_name = isalnum((unsigned char)*a) || *a == '_' || *a == '.';
    a += 1 + (goes_on ? strspn(a + 1, " \n") : 0);
    b += 1 + (goes_on ? strspn(b + 1, " \n") : 0);
  }
  return b == other->text + other->length;
}

static status compare_decks(const char *was, const char *is, int step_no) {
  echo_card a = {was, 0, 0}, b = {is, 0, 0};
  char before[100], now[100], where[40] = "";
  do {
    next_bound(&a, step_no);
    next_bound(&b, step_no);
    if (is_same_card(&a, &b)) continue;
    first_line(&a, before);
    first_line(&b, now);
    if (a.step_no > 0) snprintf(where, sizeof where, "step %d, ", a.step_no);
    RAISE(ERR_DECK,
          "--restart: the deck has changed: %s%s%s%s; only loads, outputs and "
          "the solver of the steps after step %d may change",
          where, before,
          strcmp(before, now) == 0 ? " has other data" : " is now ",
          strcmp(before, now) == 0 ? "" : now, step_no);
  } while (a.length > 0);
  return OK;
}

/* ---- reading ------------------------------------------------------------- */

static status check_identity(const identity *was, const identity *is,
                             const char *path) {
  if (strcmp(was->version, is->version) != 0)
    RAISE(ERR_FILE, "%s was written by Protis %s, this is %s", path,
          was->version, is->version);
  if (was->mesh != is->mesh)
    RAISE(ERR_FILE, "%s was written with another mesh", path);
  if (was->no_timing != is->no_timing)
    RAISE(ERR_DECK, "--restart: the run was started %s --no-timing",
          was->no_timing ? "with" : "without");
  if (was->effects != is->effects)
    RAISE(ERR_DECK,
          "--restart: the deck now requires other effects (see --check) than "
          "the run was started with");
  if (was->threads != is->threads || strcmp(was->kernel, is->kernel) != 0)
    fprintf(stderr,
            "protis: warning: the run was started with %d thread%s and kernel "
            "%s, this is %d and %s: last digits may differ\n",
            was->threads, was->threads == 1 ? "" : "s", was->kernel,
            is->threads, is->kernel);
  return OK;
}

static status check_files(const job_input *in, archive *a, int step_no) {
  OWNED char *was = NULL, *is = NULL;
  PASS(archive_text(a, "files", &was));
  PASS(restart_files(in, &is));
  return compare_files(was, is, step_no);
}

static status check_job(const command *c, const job_input *in, archive *a,
                        const char *path) {
  identity was, is;
  OWNED char *text = NULL, *now = NULL;
  PASS(archive_bytes(a, "identity", &was, sizeof was));
  PASS(archive_text(a, "deck", &text));
  PASS(text_made(&now, in->m, model_echo));
  identify(c, in, &is);
  PASS(compare_decks(text, now, was.step_no));
  PASS(check_files(in, a, was.step_no));
  return check_identity(&was, &is, path);
}

/* JOB.rst.h5, or the one before it if that cannot be read. */
static status read_either(const char *path, const char *before, archive **a) {
  char why[512];
  status st = archive_read(path, a);
  if (st != ERR_FILE) return st;
  snprintf(why, sizeof why, "%s", status_message());
  archive_free(a);
  if (archive_read(before, a) == OK) {
    fprintf(stderr, "protis: warning: %s; the run goes on from %s\n", why,
            before);
    return OK;
  }
  return status_fail(st, __func__, __LINE__, "--restart: %s", why);
}

/* A run that ended before its first increment has none. */
static int is_none(const char *path, const char *before) {
  if (access(path, F_OK) == 0 || errno != ENOENT) return 0;
  if (access(before, F_OK) == 0 || errno != ENOENT) return 0;
  fprintf(stderr,
          "protis: warning: --restart: there is no %s; the run begins at its "
          "start\n",
          path);
  return 1;
}

/* ERR_DECK: the whole run is needed. */
static status check_fits(const job_input *in) {
  if (in->problem != NULL)
    RAISE(ERR_DECK,
          "--restart: *CONDENSED PROBLEM is one increment, there is "
          "nothing to go on with");
  if (model_has_target(in->m))
    RAISE(ERR_DECK,
          "--restart: TARGET= makes passes of the whole "
          "run; such a job starts at its beginning");
  for (int i = 0; i < in->m->n.step; ++i)
    if (in->m->steps[i].accuracy.theorems)
      RAISE(ERR_DECK,
            "--restart: the theorems of *ACCURACY are checked over a "
            "whole run; such a job starts at its beginning");
  return OK;
}

status restart_read(const command *c, const job_input *in, archive **out) {
  OWNED char *path = NULL, *before = NULL;
  *out = NULL;
  PASS(check_fits(in));
  PASS(file_names(c, in->m, &path, &before));
  if (is_none(path, before)) return OK;
  PASS(read_either(path, before, out));
  PASS(check_job(c, in, *out, path));
  return report_warnings(in, *out);
}
