/*
 * Lines of a deck. Physical lines of its files: blank and comment lines are
 * skipped. Logical lines: comments cut, lines that end in a comma joined with
 * the next, cut into pieces at commas.
 */
#include "base/base.h"
#include "base/system/input.h"
#include "deck/reader.h"

#include <errno.h>
#include <sys/stat.h>

enum { BLOCK = 1 << 16 };

struct source {
  source *below; /* the file that includes this one, or NULL */
  const char *file;
  const place *from; /* of the *INCLUDE, or NULL */
  FILE *stream;
  dev_t device; /* with inode: which file it is */
  ino_t inode;
  int n_block, at; /* bytes in the block, next one */
  int line_no, held, ended, depth;
  int hidden; /* no card at its start: messages show nothing */
  int begun;
  physical line;
  char text[LINE_MAX_BYTES + 1]; /* as in the file */
  /* as it is read: text_shown */
  char shown[4 * LINE_MAX_BYTES + 1];
  char block[BLOCK];
};

int source_hidden(const source *s) { return s->hidden; }

place source_place(const source *s, int line_no, int column, const char *line) {
  return (place){s->file, line_no, column, line, s->from, s->hidden};
}

void source_pop(source **top) {
  source *s = *top;
  if (s == NULL) return;
  *top = s->below;
  if (s->stream != NULL) fclose(s->stream);
  memory_free(s);
}

/* Next byte, or EOF. */
static int next_byte(source *s) {
  if (s->at == s->n_block) {
    s->n_block = (int)fread(s->block, 1, BLOCK, s->stream);
    s->at = 0;
    if (s->n_block == 0) return EOF;
  }
  return (unsigned char)s->block[s->at++];
}

/* LF, CR and CR LF end a line. */
static int ends_line(source *s, int c) {
  if (c == '\r') {
    int next = next_byte(s);
    if (next != '\n' && next != EOF) --s->at;
    return 1;
  }
  return c == '\n';
}

typedef enum { GOT_LINE, GOT_LONG, GOT_NUL, GOT_END } got;

/* One line into s->text. After GOT_LONG the rest of the line is consumed. */
static got read_line(source *s) {
  int n = 0, c, too_long = 0;
  ++s->line_no;
  while ((c = next_byte(s)) != EOF) {
    s->text[n] = '\0';
    if (ends_line(s, c)) return too_long ? GOT_LONG : GOT_LINE;
    if (c == '\0') return GOT_NUL;
    if (n == LINE_MAX_BYTES)
      too_long = 1;
    else
      s->text[n++] = (char)c;
  }
  s->ended = 1;
  s->text[n] = '\0';
  return too_long ? GOT_LONG : n > 0 ? GOT_LINE : GOT_END;
}

static int is_empty_or_comment(const char *p) {
  while (is_blank(*p)) ++p;
  return *p == '\0' || (p[0] == '*' && p[1] == '*');
}

/* *NAME, and then a comma or the end: the start of a deck. */
static int is_card(const char *p) {
  while (is_blank(*p)) ++p;
  if (p[0] != '*' || !is_name_start(p[1])) return 0;
  for (++p; is_name_part(*p) || is_blank(*p) || *p == '-';) ++p;
  return *p == '\0' || *p == ',';
}

static void report(source *s, message_log *log, got what) {
  place at;
  if (what == GOT_NUL) {
    at = source_place(s, s->line_no, (int)strlen(s->text) + 1, s->shown);
    message_add(log, P1013, &at, "NUL byte: the file is not plain text");
    s->ended = 1;
  } else if (what == GOT_LONG) {
    at = source_place(s, s->line_no, LINE_MAX_BYTES + 1, s->shown);
    message_add(log, P1014, &at, "line of more than %d characters",
                LINE_MAX_BYTES);
  }
}

status source_next(source *s, message_log *log, const physical **line) {
  *line = &s->line;
  if (s->held) {
    s->held = 0;
    return OK;
  }
  while (!s->ended) {
    got what = read_line(s);
    s->line.length = (int)text_shown(s->shown, sizeof s->shown, s->text);
    report(s, log, what);
    if (what == GOT_LINE && !is_empty_or_comment(s->shown)) {
      s->line.text = s->shown;
      s->line.line_no = s->line_no;
      /* A file included first may be any file, unless it starts with a card. */
      if (!s->begun) s->hidden = s->from != NULL && !is_card(s->shown);
      s->begun = 1;
      return OK;
    }
  }
  if (ferror(s->stream)) {
    place at = source_place(s, s->line_no, 0, NULL);
    message_add(log, P1001, &at, "reading stopped: %s", strerror(errno));
    clearerr(s->stream);
  }
  *line = NULL;
  return OK;
}

/* Is the file just opened one that is still being read? */
static int is_open_already(const source *s) {
  for (const source *p = s->below; p != NULL; p = p->below)
    if (p->device == s->device && p->inode == s->inode) return 1;
  return 0;
}

/* Open and check; 0, or -1 after a message. */
static int open_stream(source *s, const char *file, message_log *log,
                       const place *at) {
  struct stat info;
  place whole = {.file = s->file};
  const char *why = NULL;
  s->stream = input_stream(file, &why);
  int known = s->stream != NULL && fstat(fileno(s->stream), &info) == 0;
  if (s->stream != NULL && !known) why = strerror(errno);
  if (!known) {
    message_add(log, P1001, at != NULL ? at : &whole, "cannot read %s: %s",
                s->file, why);
    return -1;
  }
  /* A byte order mark at the start of the file is skipped. */
  if (next_byte(s) != EOF) --s->at;
  if (s->n_block - s->at >= 3 &&
      memcmp(s->block + s->at, "\xEF\xBB\xBF", 3) == 0)
    s->at += 3;
  s->device = info.st_dev;
  s->inode = info.st_ino;
  if (is_open_already(s)) {
    message_add(log, P1017, at, "%s includes itself", s->file);
    return -1;
  }
  if (s->depth > INCLUDE_DEPTH) {
    message_add(log, P1018, at, "includes more than %d deep", INCLUDE_DEPTH);
    return -1;
  }
  return 0;
}

static status note_file(deck *d, const char *file) {
  PASS_GROW(d->files, d->n_file, d->own->file_capacity);
  d->files[d->n_file++] = file;
  return OK;
}

status deck_input(deck *d, const char *path) {
  for (int i = 0; i < d->n_input; ++i)
    if (strcmp(d->inputs[i], path) == 0) return OK;
  OWNS(d);
  PASS_GROW(d->inputs, d->n_input, d->own->input_capacity);
  d->inputs[d->n_input++] = path;
  return OK;
}

status source_open(deck *d, message_log *log, const char *file, const place *at,
                   source **top) {
  status st = OK;
  source *s = NULL;
  NEW(s, 1);
  s->below = *top;
  s->depth = *top != NULL ? (*top)->depth + 1 : 0;
  s->hidden = at != NULL;
  size_t size = 4 * strlen(file) + 1;
  char *shown = store_new(d, size, 1);
  if (shown == NULL) FAIL(ERR_MEMORY, "memory exhausted: name of a file");
  text_shown(shown, size, file);
  s->file = shown;
  if (at == NULL)
    TRY(deck_input(d, file));
  else if ((s->from = store_place(d, at)) == NULL)
    FAIL(ERR_MEMORY, "memory exhausted: place of a file");
  if (open_stream(s, file, log, at) != 0) goto done;
  TRY(note_file(d, s->file));
  *top = s;
  s = NULL;
done:
  if (s != NULL) source_pop(&s);
  return st;
}

/* ---- logical lines ------------------------------------------------------ */

place logical_place(const logical *l, int byte) {
  int low = 0, high = l->n_segment;
  while (high - low > 1) {
    int middle = (low + high) / 2;
    if (l->segments[middle].start <= byte)
      low = middle;
    else
      high = middle;
  }
  place at = l->segments[low].at;
  at.column_no = byte - l->segments[low].start + 1;
  return at;
}

/* Does ** under *PARAMETER look like a power? Behind a blank it is a comment,
 * unless what follows could be an exponent. */
static int looks_like_power(const reader *r, const char *text, int at) {
  char name[32];
  size_t n = 0;
  const char *p = text + at + 2;
  if (at > 0 && !is_blank(text[at - 1]) && text[at - 1] != ',') return 1;
  while (is_blank(*p)) ++p;
  if (*p != '\0' && strchr("0123456789.(<", *p) != NULL) return 1;
  while (n + 1 < sizeof name && is_name_part(p[n])) {
    name[n] = p[n];
    ++n;
  }
  name[n] = '\0';
  return n > 0 &&
         (p[n] == '(' || symbol_find(r->d, name, strlen(name)) != NULL);
}

typedef struct content {
  int end;        /* bytes before the comment, blanks cut */
  int open_quote; /* byte of a quote that is not closed, or -1 */
  int power;      /* byte of a doubtful **, or -1 */
} content;

static content scan_line(const reader *r, const physical *line,
                         line_kind kind) {
  content s = {line->length, -1, -1};
  for (int i = 0; i < line->length; ++i) {
    const char *p = line->text + i;
    if (*p == '"') {
      s.open_quote = s.open_quote < 0 ? i : -1;
    } else if (s.open_quote < 0 && p[0] == '*' && p[1] == '*') {
      if (kind == LINE_DEFINITION && looks_like_power(r, line->text, i))
        s.power = i;
      s.end = i;
      break;
    }
  }
  while (s.end > 0 && is_blank(line->text[s.end - 1])) --s.end;
  return s;
}

static status add_segment(reader *r, const physical *line, int end) {
  logical *l = &r->line;
  PASS_GROW(l->segments, l->n_segment, l->segment_capacity);
  segment *s = &l->segments[l->n_segment];
  s->start = l->all.n;
  s->at = source_place(r->top, line->line_no, 0,
                       store_text(r->d, line->text, line->length));
  if (s->at.line == NULL) RAISE(ERR_MEMORY, "memory exhausted: line");
  ++l->n_segment;
  return buffer_add(&l->all, line->text, end);
}

/* Append one physical line; *goes_on: it ends in a comma. */
static status add_line(reader *r, const physical *line, line_kind kind,
                       int *goes_on) {
  content s = scan_line(r, line, kind);
  int start = r->line.all.n;
  PASS(add_segment(r, line, s.end));
  *goes_on = s.open_quote < 0 && s.end > 0 && line->text[s.end - 1] == ',';
  if (s.open_quote >= 0) {
    place at = logical_place(&r->line, start + s.open_quote);
    message_add(r->log, P1011, &at, "quote not closed");
  }
  if (s.power >= 0) {
    place at = logical_place(&r->line, start + s.power);
    message_add(r->log, P1035, &at,
                "** starts a comment; a power is written ^");
  }
  return OK;
}

static char first_character(const char *p) {
  while (is_blank(*p)) ++p;
  return *p;
}

status logical_read(reader *r, const physical *first, line_kind kind) {
  logical *l = &r->line;
  int goes_on, is_card = first_character(first->text) == '*';
  l->all.n = 0;
  l->n_segment = 0;
  PASS(add_line(r, first, kind, &goes_on));
  while (goes_on) {
    const physical *next;
    PASS(source_next(r->top, r->log, &next));
    if (next == NULL || first_character(next->text) == '*') {
      place at = logical_place(l, l->all.n - 1);
      if (next != NULL) r->top->held = 1;
      if (is_card)
        message_add(r->log, P1016, &at,
                    "the card ends in a comma and does not go on");
      break;
    }
    PASS(add_line(r, next, kind, &goes_on));
  }
  return OK;
}

piece logical_piece(const logical *l, int from, int nested) {
  int i = from, depth = 0, quoted = 0;
  for (; i < l->all.n; ++i) {
    char c = l->all.text[i];
    if (c == '"') quoted = !quoted;
    if (quoted) continue;
    if (c == ',' && depth == 0) break;
    if (nested && c == '(') ++depth;
    if (nested && c == ')' && depth > 0) --depth;
  }
  size_t length;
  piece p = {.next = i < l->all.n ? i + 1 : -1};
  const char *text = trim(l->all.text + from, i - from, &length);
  p.start = (int)(text - l->all.text);
  p.length = (int)length;
  if (length == 0) p.start = i;
  return p;
}
