/*
 * The message log: messages are stored with copies of their places and printed
 * in the order of the input. A limited number of each severity is stored.
 */
#include "base/message.h"

#include "base/memory.h"
#include "base/text.h"

#include <stdarg.h>
#include <stdlib.h>

enum {
  KEPT = 100,       /* messages stored of each severity */
  TEXT_SIZE = 1024, /* longest text of one message */
  SHOWN = 120       /* most characters of a source line */
};

typedef struct message {
  message_id id;
  severity level;
  place *at;  /* copy with its chain, owned; NULL: no place */
  char *text; /* owned */
  int rank;   /* of the outermost file, by first mention */
} message;

struct message_log {
  int n, capacity;
  message *items;
  int count[3]; /* by severity, those not stored included */
  int n_file, file_capacity;
  char **files; /* outermost files in the order of their first message */
  int no_memory;
};

typedef struct manual_entry {
  int number;
  severity level;
  const char *title, *remedy;
} manual_entry;

#define MANUAL_ENTRY(number, level, title, remedy) \
  {number, level, title, remedy},
static const manual_entry manual[] = {MESSAGE_LIST(MANUAL_ENTRY)};
enum { MANUAL_SIZE = sizeof manual / sizeof *manual };

static const manual_entry *find_entry(int number) {
  for (int i = 0; i < MANUAL_SIZE; ++i)
    if (manual[i].number == number) return &manual[i];
  return NULL;
}

static const char *severity_word(severity s) {
  static const char *const words[] = {"note", "warning", "error"};
  return words[s];
}

static size_t text_bytes(const char *text) {
  return text != NULL ? strlen(text) + 1 : 0;
}

/* Copy a text to *end, which moves past it. */
static const char *put_text(const char *text, char **end) {
  size_t bytes = text_bytes(text);
  char *copy = *end;
  if (text == NULL) return NULL;
  memcpy(copy, text, bytes);
  *end += bytes;
  return copy;
}

static const char *line_of(const place *p) {
  return p->hidden ? NULL : p->line;
}

/* Copy of a place, its chain and its texts in one block; NULL if refused. */
static place *place_copy(const place *at) {
  size_t n = 0, bytes = 0;
  for (const place *p = at; p != NULL; p = p->from, ++n)
    bytes += sizeof *p + text_bytes(p->file) + text_bytes(line_of(p));
  place *copy = memory_new(1, bytes);
  if (copy == NULL) return NULL;
  char *end = (char *)(copy + n);
  for (size_t i = 0; i < n; ++i, at = at->from) {
    copy[i] = *at;
    copy[i].file = put_text(at->file, &end);
    copy[i].line = put_text(line_of(at), &end);
    copy[i].from = i + 1 < n ? &copy[i + 1] : NULL;
  }
  return copy;
}

status message_log_new(message_log **log) {
  PASS_NEW(*log, 1);
  return OK;
}

/* Place in the outermost file; NULL if the message has no file. */
static const place *outermost(const place *p) {
  while (p != NULL && p->from != NULL) p = p->from;
  return p;
}

static status file_rank(message_log *log, const place *at, int *rank) {
  const place *root = outermost(at);
  const char *file = root != NULL && root->file != NULL ? root->file : "";
  for (*rank = 0; *rank < log->n_file; ++*rank)
    if (strcmp(log->files[*rank], file) == 0) return OK;
  PASS_GROW(log->files, log->n_file, log->file_capacity);
  PASS_GET(log->files[log->n_file], memory_text(file));
  ++log->n_file;
  return OK;
}

static status keep(message_log *log, const message *m) {
  PASS_GROW(log->items, log->n, log->capacity);
  message *item = &log->items[log->n];
  *item = *m;
  PASS(file_rank(log, m->at, &item->rank));
  ++log->n;
  return OK;
}

int message_wanted(const message_log *log) { return log->count[ERROR] < KEPT; }

void message_memory(message_log *log) { log->no_memory = 1; }

static int same_place(const place *a, const place *b) {
  static const place none;
  if (a == NULL) a = &none;
  if (b == NULL) b = &none;
  if (a->line_no != b->line_no || a->column_no != b->column_no) return 0;
  if (a->file == NULL || b->file == NULL) return a->file == b->file;
  return strcmp(a->file, b->file) == 0;
}

static int is_there(const message_log *log, const message *m, const place *at,
                    const char *text) {
  for (int i = 0; i < log->n; ++i)
    if (log->items[i].id == m->id && same_place(log->items[i].at, at) &&
        strcmp(log->items[i].text, text) == 0)
      return 1;
  return 0;
}

/* The text that is shown; of a hidden file only the kind of message. */
static void make_text(const manual_entry *entry, const place *at,
                      const char *format, va_list args, char out[TEXT_SIZE]) {
  char text[TEXT_SIZE];
  if (at != NULL && at->hidden && entry != NULL) {
    snprintf(out, TEXT_SIZE,
             "%s; nothing of this file is shown, as it does not start with a "
             "card",
             entry->title);
    return;
  }
  int length = vsnprintf(text, sizeof text, format, args);
  if (length >= TEXT_SIZE) memcpy(text + TEXT_SIZE - 4, "...", 4);
  text_shown(out, TEXT_SIZE, text);
}

void message_add(message_log *log, message_id id, const place *at,
                 const char *format, ...) {
  char text[TEXT_SIZE];
  const manual_entry *entry = find_entry((int)id);
  message m = {id, entry != NULL ? entry->level : ERROR, NULL, NULL, 0};
  if (log->count[m.level] >= KEPT) {
    ++log->count[m.level];
    return;
  }
  va_list args;
  va_start(args, format);
  make_text(entry, at, format, args, text);
  va_end(args);
  if (m.level < ERROR && is_there(log, &m, at, text)) return;
  ++log->count[m.level];
  OWNS(log);
  m.text = memory_text(text);
  if (at != NULL) m.at = place_copy(at);
  if (m.text == NULL || (at != NULL && m.at == NULL) || keep(log, &m) != OK) {
    RELEASE(m.at, m.text);
    log->no_memory = 1;
  }
}

int message_count(const message_log *log, severity s) { return log->count[s]; }

message_mark message_now(const message_log *log) {
  message_mark now = {.n = log->n};
  COPY(now.count, log->count, 3);
  return now;
}

void message_forget(message_log *log, message_mark since) {
  while (log->n > since.n) {
    --log->n;
    RELEASE(log->items[log->n].at, log->items[log->n].text);
  }
  COPY(log->count, since.count, 3);
}

void message_take(message_log *log, const message_log *from) {
  for (EACH(const message, m, from->items, from->n))
    message_add(log, m->id, m->at, "%s", m->text);
}

int message_get(const message_log *log, int k, message_view *out) {
  if (k >= log->n) return 0;
  const message *m = &log->items[k];
  *out = (message_view){m->id, m->level, m->at, m->text};
  return 1;
}

static int chain_length(const place *p) {
  int n = 0;
  for (; p != NULL; p = p->from) ++n;
  return n;
}

/* Where the input that holds "p" was entered, "up" levels above it. */
static const place *climb(const place *p, int up) {
  for (; up > 0; --up) p = p->from;
  return p;
}

/* In the order in which the input is read: outermost lines first. */
static int compare_places(const place *a, const place *b) {
  int n = chain_length(a), m = chain_length(b);
  for (int level = 1; level <= n && level <= m; ++level) {
    const place *p = climb(a, n - level), *q = climb(b, m - level);
    if (p->line_no != q->line_no) return p->line_no < q->line_no ? -1 : 1;
    if (level == n && level == m && p->column_no != q->column_no)
      return p->column_no < q->column_no ? -1 : 1;
  }
  return n == m ? 0 : n < m ? -1 : 1;
}

static int compare_messages(const void *x, const void *y) {
  const message *a = *(const message *const *)x;
  const message *b = *(const message *const *)y;
  if (a->rank != b->rank) return a->rank < b->rank ? -1 : 1;
  int order = compare_places(a->at, b->at);
  if (order != 0) return order;
  if (a->level != b->level) return a->level > b->level ? -1 : 1;
  return a < b ? -1 : a > b; /* in the order in which they were added */
}

/* Messages in order into sorted[]; without memory as they were added. */
static const message **sorted_messages(const message_log *log) {
  const message **sorted = memory_new(log->n, sizeof *sorted);
  if (sorted == NULL) return NULL;
  for (int i = 0; i < log->n; ++i) sorted[i] = &log->items[i];
  qsort(sorted, log->n, sizeof *sorted, compare_messages);
  return sorted;
}

static void print_place(const place *at, FILE *out) {
  if (at == NULL || at->file == NULL) return;
  text_put(out, at->file);
  fputc(':', out);
  if (at->line_no > 0) fprintf(out, "%d:", at->line_no);
  if (at->line_no > 0 && at->column_no > 0) fprintf(out, "%d:", at->column_no);
  fputc(' ', out);
}

static int is_continuation_byte(char c) { return ((unsigned char)c >> 6) == 2; }

/* Part of a long line with the column: first byte, one past the last. */
static void visible_part(const char *line, int column, int *first, int *last) {
  int length = (int)strlen(line);
  *first = column > SHOWN / 2 ? column - SHOWN / 2 : 0;
  if (*first + SHOWN > length) *first = length > SHOWN ? length - SHOWN : 0;
  while (*first > 0 && is_continuation_byte(line[*first])) --*first;
  *last = *first + SHOWN < length ? *first + SHOWN : length;
}

/* A caret under a column of the part that starts at "first". A tab is kept,
 * and a character of several bytes takes one column. */
static void print_caret(const char *line, int first, int column, FILE *out) {
  fprintf(out, "%8s | %s", "", first > 0 ? "   " : "");
  for (int i = first; i < column; ++i)
    if (!is_continuation_byte(line[i]))
      fputc(line[i] == '\t' ? '\t' : ' ', out);
  fputs("^\n", out);
}

static void print_source(const place *at, FILE *out) {
  if (at == NULL || at->line == NULL || at->line_no <= 0) return;
  int first, last, column = at->column_no - 1;
  visible_part(at->line, column, &first, &last);
  fprintf(out, "%8d | %s", at->line_no, first > 0 ? "..." : "");
  /* A line of a deck is in the shown form already, others may be not. */
  char piece[PIECE_SIZE];
  const char *p = at->line + first;
  while (p < at->line + last && text_piece(&p, piece) > 0) fputs(piece, out);
  fprintf(out, "%s\n", at->line[last] != '\0' ? "..." : "");
  if (column >= 0 && column <= last) print_caret(at->line, first, column, out);
}

static void print_message(const message *m, FILE *out) {
  print_place(m->at, out);
  fprintf(out, "%s P%04d: %s\n", severity_word(m->level), (int)m->id, m->text);
  print_source(m->at, out);
  if (m->at == NULL) return;
  for (const place *p = m->at->from; p != NULL; p = p->from) {
    fprintf(out, "%8s   included from ", "");
    text_put(out, p->file);
    fprintf(out, ":%d\n", p->line_no);
  }
}

static void print_count(int n, const char *word, const char *before,
                        FILE *out) {
  fprintf(out, "%s%d %s%s", before, n, word, n == 1 ? "" : "s");
  if (n > KEPT) fprintf(out, " (%d shown)", KEPT);
}

static const message *first_error(const message *const *sorted, int n) {
  for (int i = 0; i < n; ++i)
    if (sorted[i]->level == ERROR) return sorted[i];
  return NULL;
}

/* first: the error whose manual entry is named, or NULL. */
static void print_totals(const message_log *log, const message *first,
                         FILE *out) {
  int errors = log->count[ERROR], warnings = log->count[WARNING];
  if (errors > 0) print_count(errors, "error", "", out);
  if (warnings > 0)
    print_count(warnings, "warning", errors > 0 ? ", " : "", out);
  if (errors > 0 && first != NULL)
    fprintf(out, "; protis --explain P%04d says what to do", (int)first->id);
  if (errors + warnings > 0) fputc('\n', out);
}

void message_print(const message_log *log, FILE *out) {
  const message **sorted = sorted_messages(log);
  for (int i = 0; i < log->n; ++i)
    print_message(sorted != NULL ? sorted[i] : &log->items[i], out);
  print_totals(log, sorted != NULL ? first_error(sorted, log->n) : NULL, out);
  memory_free(sorted);
}

/* Name of a file without its folders. */
static const char *base_name(const char *file) {
  const char *slash = strrchr(file, '/');
  return slash != NULL ? slash + 1 : file;
}

void message_list(const message_log *log, severity s, FILE *out) {
  const message **sorted = sorted_messages(log);
  for (int i = 0; i < log->n; ++i) {
    const message *m = sorted != NULL ? sorted[i] : &log->items[i];
    if (m->level != s) continue;
    if (m->at != NULL) {
      place short_place = *m->at;
      if (short_place.file != NULL)
        short_place.file = base_name(short_place.file);
      print_place(&short_place, out);
    }
    fprintf(out, "%s P%04d: %s\n", severity_word(s), (int)m->id, m->text);
  }
  memory_free(sorted);
}

static void print_entry(const manual_entry *e, FILE *out) {
  fprintf(out, "P%04d %s: %s\n", e->number, severity_word(e->level), e->title);
  fputs("    ", out);
  text_wrap(out, e->remedy, 4);
}

/* Number of "P1003", "p1003" or "1003"; 0 if it is none. */
static int entry_number(const char *text) {
  int number = 0;
  if (*text == 'P' || *text == 'p') ++text;
  for (int i = 0; i < 4; ++i) {
    if (text[i] < '0' || text[i] > '9') return 0;
    number = 10 * number + (text[i] - '0');
  }
  return text[4] == '\0' ? number : 0;
}

int message_explain(const char *number, FILE *out) {
  if (number == NULL) {
    for (int i = 0; i < MANUAL_SIZE; ++i) print_entry(&manual[i], out);
    return 1;
  }
  const manual_entry *e = find_entry(entry_number(number));
  if (e == NULL) return 0;
  print_entry(e, out);
  return 1;
}

status message_status(const message_log *log, status code) {
  int n = log->count[ERROR];
  if (log->no_memory) RAISE(ERR_MEMORY, "memory exhausted by messages");
  if (n > 0) RAISE(code, "%d error%s in the input", n, n == 1 ? "" : "s");
  return OK;
}
