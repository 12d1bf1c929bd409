/*
 * Logical lines: comments cut, lines that end in a comma joined with the next,
 * cut into pieces at commas; fields from pieces.
 */
#include "base/memory.h"
#include "base/number.h"
#include "deck/reader.h"

#include <math.h>
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
  return n > 0 && (p[n] == '(' || symbols_have(r->d, name));
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

/* Take the quotes off; what is wrong with them is reported. */
static int take_quotes(reader *r, piece *p) {
  const char *text = r->line.all.text + p->start;
  const char *end = text + p->length, *quote;
  quote = p->length > 0 ? memchr(text, '"', (size_t)p->length) : NULL;
  if (quote == NULL) return 0;
  const char *after = NULL;
  if (quote == text) {
    const char *close = memchr(text + 1, '"', (size_t)(p->length - 1));
    after = close != NULL ? close + 1 : end;
    p->length = (int)((close != NULL ? close : end) - text) - 1;
    ++p->start;
  }
  if (quote != text || after != end) {
    const char *wrong = quote != text ? quote : after;
    place at = logical_place(&r->line, (int)(wrong - r->line.all.text));
    message_add(r->log, P1012, &at, "text next to a quoted value");
  }
  return quote == text;
}

static int is_name_alone(const char *text) {
  if (!is_name_start(*text)) return 0;
  while (is_name_part(*text)) ++text;
  return *text == '\0';
}

/* A quoted field without variables becomes the digits of its value; *valid:
 * it is an expression at all. */
static status settle_constant(reader *r, field *f, int *valid) {
  status st = OK;
  expression *e = NULL;
  int column;
  const double origin[3] = {0, 0, 0};
  char digits[NUMBER_TEXT_SIZE];
  st = expression_compile(f->text, deck_symbol, r->d, &e, &column);
  if (st == ERR_DECK) st = OK; /* reported by the caller that needs a value */
  TRY(st);
  *valid = e != NULL;
  if (e == NULL || expression_variables(e) != 0) goto done;
  double value = expression_value(e, origin, 0);
  if (!isfinite(value)) goto done;
  number_text(value, digits);
  f->text = store_text(r->d, digits, strlen(digits));
  if (f->text == NULL) FAIL(ERR_MEMORY, "memory exhausted: field");
done:
  expression_free(e);
  return st;
}

/* <NAME>+3 with a number put in would be read as mantissa and exponent. */
static void check_exponent(reader *r, const char *raw, const field *f) {
  if (strchr(raw, '<') == NULL || !number_bare_exponent(f->text)) return;
  message_add(r->log, P1036, &f->at,
              "'%s' becomes '%s', a number with exponent", raw, f->text);
}

/* Text in quotes: an expression, or on a card also a name with commas. */
static status read_quoted(reader *r, const char *text, size_t n, int on_card,
                          const place *at, field *out) {
  int valid = 0;
  PASS(symbols_replace(r, text, n, REPLACE_EXPRESSION, at, &out->text));
  if (!(on_card && is_name_alone(out->text)))
    PASS(settle_constant(r, out, &valid));
  if (on_card && !valid)
    PASS(symbols_replace(r, text, n, REPLACE_LENIENT, at, &out->text));
  return OK;
}

static status read_plain(reader *r, const char *text, size_t n, const place *at,
                         field *out) {
  PASS(symbols_replace(r, text, n, REPLACE_PLAIN, at, &out->text));
  if (n > 0 && memchr(text, '<', n) != NULL) {
    const char *raw = store_text(r->d, text, n);
    if (raw == NULL) RAISE(ERR_MEMORY, "memory exhausted: field");
    check_exponent(r, raw, out);
  }
  return OK;
}

status field_read(reader *r, piece p, int on_card, field *out) {
  size_t n;
  out->at = logical_place(&r->line, p.start);
  out->quoted = take_quotes(r, &p);
  const char *text = trim(r->line.all.text + p.start, (size_t)p.length, &n);
  place inside = logical_place(&r->line, (int)(text - r->line.all.text));
  return out->quoted ? read_quoted(r, text, n, on_card, &inside, out)
                     : read_plain(r, text, n, &inside, out);
}
