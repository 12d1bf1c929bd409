/*
 * Logical lines: comments cut, lines that end in a comma joined with the next,
 * cut into pieces at commas.
 */
#include "base/memory.h"
#include "deck/reader.h"

#include <string.h>

void logical_free(logical *l) { RELEASE(l->all.text, l->segments); }

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

typedef struct scan {
  int end;        /* bytes before the comment, blanks cut */
  int open_quote; /* byte of a quote that is not closed, or -1 */
  int power;      /* byte of a doubtful **, or -1 */
} scan;

static scan scan_line(const reader *r, const physical *line, line_kind kind) {
  scan s = {line->length, -1, -1};
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
                       store_text(r->d, line->text, (size_t)line->length));
  if (s->at.line == NULL) RAISE(ERR_MEMORY, "memory exhausted: line");
  ++l->n_segment;
  return buffer_add(&l->all, line->text, (size_t)end);
}

/* Append one physical line; *goes_on: it ends in a comma. */
static status add_line(reader *r, const physical *line, line_kind kind,
                       int *goes_on) {
  scan s = scan_line(r, line, kind);
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
      if (next != NULL) source_hold(r->top);
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
  const char *text = trim(l->all.text + from, (size_t)(i - from), &length);
  p.start = (int)(text - l->all.text);
  p.length = (int)length;
  if (length == 0) p.start = i;
  return p;
}
