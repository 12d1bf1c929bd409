/*
 * Fixed columns: a Fortran format is unrolled into columns, which cut a line
 * into the fields of a record. Groups are unrolled with a stack of their own;
 * each repetition of a group must use columns, so that the work is bounded.
 */
#include "base/base.h"
#include "deck/reader.h"

enum { GROUP_MAX = 8, COUNT_MAX = 1000000 };

typedef struct column_field {
  char kind; /* I, F (also E, D, G) or A */
  int start, width, decimals;
} column_field;

struct format {
  int n, capacity;
  column_field *fields; /* [n] */
  int width;            /* columns in all */
};

typedef struct group {
  const char *start; /* behind the parenthesis */
  int left;          /* repetitions left */
  int width;         /* columns used when this repetition began */
} group;

typedef struct unroller {
  format *f;
  const char *text, *p;
  int n_group;
  group groups[GROUP_MAX];
} unroller;

static void skip(unroller *u) {
  while (is_blank(*u->p)) ++u->p;
}

/* Whole number at u->p, or "absent" if there is none. */
static int read_count(unroller *u, int absent) {
  int n = 0;
  skip(u);
  if (*u->p < '0' || *u->p > '9') return absent;
  for (; *u->p >= '0' && *u->p <= '9'; ++u->p)
    if (n < COUNT_MAX) n = 10 * n + (*u->p - '0');
  skip(u);
  return n;
}

/* Behind the width: .d of a real, .m of an integer, Ee of an exponent. */
static int read_decimals(unroller *u, char letter) {
  int decimals = 0;
  if (*u->p == '.' && letter != 'A') {
    ++u->p;
    decimals = read_count(u, 0);
  }
  if (upper_case(*u->p) == 'E' && strchr("EDG", letter) != NULL) {
    ++u->p;
    (void)read_count(u, 0);
  }
  return letter == 'I' ? 0 : decimals;
}

static status add_fields(unroller *u, const column_field *c, int count) {
  format *f = u->f;
  for (int i = 0; i < count; ++i) {
    if (c->width > FORMAT_MAX - f->width)
      RAISE(ERR_DECK, "more than %d columns", FORMAT_MAX);
    if (c->kind != 'X') {
      PASS_GROW(f->fields, f->n, f->capacity);
      f->fields[f->n] = *c;
      f->fields[f->n++].start = f->width;
    }
    f->width += c->width;
  }
  return OK;
}

static status read_item(unroller *u, int count) {
  char letter = upper_case(*u->p);
  column_field c = {letter, 0, 1, 0};
  if (letter == '\0' || strchr("IFEDGAX", letter) == NULL)
    RAISE(ERR_DECK, "I, F, E, D, G, A or X expected at character %d",
          (int)(u->p - u->text) + 1);
  ++u->p;
  if (letter != 'X') {
    c.width = read_count(u, 0);
    if (c.width < 1) RAISE(ERR_DECK, "%c without a width", letter);
    c.decimals = read_decimals(u, letter);
    if (c.decimals > FORMAT_MAX) c.decimals = FORMAT_MAX;
    if (letter != 'I' && letter != 'A') c.kind = 'F';
  }
  return add_fields(u, &c, count);
}

static status open_group(unroller *u, int count) {
  if (u->n_group == GROUP_MAX)
    RAISE(ERR_DECK, "groups more than %d deep", GROUP_MAX);
  ++u->p;
  u->groups[u->n_group++] = (group){u->p, count - 1, u->f->width};
  return OK;
}

/* At a closing parenthesis: repeat the group, or continue after it. */
static status close_group(unroller *u) {
  group *g = &u->groups[u->n_group - 1];
  if (u->f->width == g->width) RAISE(ERR_DECK, "a group without columns");
  ++u->p;
  if (g->left > 0) {
    --g->left;
    g->width = u->f->width;
    u->p = g->start;
  } else {
    --u->n_group;
  }
  return OK;
}

/* From an item to behind the comma or parenthesis that follows it. */
static status read_next(unroller *u) {
  int count = read_count(u, 1);
  if (count < 1) RAISE(ERR_DECK, "a repeat count of zero");
  if (*u->p == '(') {
    PASS(open_group(u, count));
    return OK;
  }
  PASS(read_item(u, count));
  for (skip(u); *u->p == ')' && u->n_group > 0; skip(u)) {
    int groups = u->n_group;
    PASS(close_group(u));
    if (u->n_group == groups) return OK; /* once more */
  }
  if (u->n_group == 0) return OK;
  if (*u->p == '\0') RAISE(ERR_DECK, "')' missing at the end");
  if (*u->p != ',')
    RAISE(ERR_DECK, "a comma is missing at character %d",
          (int)(u->p - u->text) + 1);
  ++u->p;
  return OK;
}

status format_read(const char *text, format **out) {
  MAKES(format, f, out);
  unroller u = {.text = text, .p = text, .f = f};
  skip(&u);
  if (*u.p != '(') RAISE(ERR_DECK, "'(' expected at the start");
  PASS(open_group(&u, 1));
  while (u.n_group > 0) PASS(read_next(&u));
  skip(&u);
  if (*u.p != '\0') RAISE(ERR_DECK, "text after the last ')'");
  return OK;
}

/* Text of a column field within the line, blanks cut. */
static const char *cut_column(const column_field *c, const physical *line,
                              size_t *length) {
  *length = 0;
  if (c->start >= line->length) return line->text + line->length;
  int rest = line->length - c->start;
  return trim(line->text + c->start, rest < c->width ? rest : c->width, length);
}

/* Put the point of Fw.d into digits that have none. */
static status add_point(buffer *b, const char *text, int decimals) {
  size_t sign = *text == '+' || *text == '-';
  size_t n = strspn(text + sign, "0123456789");
  size_t d = decimals, whole = n > d ? n - d : 0;
  b->n = 0;
  PASS(buffer_add(b, text, sign + whole));
  PASS(buffer_add(b, ".", 1));
  for (size_t zeros = n < d ? d - n : 0; zeros > 0; --zeros)
    PASS(buffer_add(b, "0", 1));
  return buffer_add(b, text + sign + whole, strlen(text + sign + whole));
}

static status take_scratch(reader *r, field *f) {
  PASS_GET(f->text, store_text(r->d, r->scratch.text, r->scratch.n));
  return OK;
}

/* Check a numeric column field; a real without point gets that of Fw.d, an
 * exponent without letter its E. */
static status settle_number(reader *r, const column_field *c, field *f,
                            int named) {
  double real;
  int whole;
  const char *wrong = c->kind == 'I' ? number_int(f->text, &whole)
                                     : number_column(f->text, &real);
  if (wrong != NULL) {
    message_add(r->log, P1028, &f->at, "%s in columns %d-%d: '%.200s'", wrong,
                c->start + 1, c->start + c->width, f->text);
    f->text = "1"; /* no message follows from it */
    return OK;
  }
  if (c->kind == 'F' && !named && c->decimals > 0 &&
      strchr(f->text, '.') == NULL) {
    PASS(add_point(&r->scratch, f->text, c->decimals));
    PASS(take_scratch(r, f));
  }
  if (c->kind == 'F' && number_bare_exponent(f->text)) {
    /* Put E before the sign of an exponent. */
    const size_t n = 1 + strcspn(f->text + 1, "+-");
    r->scratch.n = 0;
    PASS(buffer_add(&r->scratch, f->text, n));
    PASS(buffer_add(&r->scratch, "E", 1));
    PASS(buffer_add(&r->scratch, f->text + n, strlen(f->text + n)));
    PASS(take_scratch(r, f));
  }
  return OK;
}

static status read_column(reader *r, const column_field *c,
                          const physical *line, const place *whole, field *f) {
  size_t length;
  const char *text = cut_column(c, line, &length);
  f->at = *whole;
  f->at.column_no = (int)(length > 0 ? text - line->text : c->start) + 1;
  if (length == 0) {
    f->text = c->kind == 'A' ? "" : "0";
    return OK;
  }
  PASS(symbols_replace(r, text, length, REPLACE_PLAIN, &f->at, &f->text));
  if (c->kind != 'A')
    PASS(settle_number(r, c, f, memchr(text, '<', length) != NULL));
  return OK;
}

/* Number of fields up to the last one that is filled; at least 1. */
static int filled_fields(const format *f, const physical *line) {
  int n = f->n;
  size_t length = 0;
  for (; n > 1; --n) {
    (void)cut_column(&f->fields[n - 1], line, &length);
    if (length > 0) break;
  }
  return n;
}

static void check_rest(reader *r, const format *f, const physical *line,
                       const place *whole) {
  place at = *whole;
  const char *tab = memchr(line->text, '\t', line->length);
  if (tab != NULL) {
    at.column_no = (int)(tab - line->text) + 1;
    message_add(r->log, P1029, &at, "a tab in fixed columns");
  }
  if (line->length <= f->width || r->excess_seen) return;
  size_t length;
  const char *rest =
      trim(line->text + f->width, line->length - f->width, &length);
  if (length == 0) return;
  at.column_no = (int)(rest - line->text) + 1;
  message_add(r->log, P1030, &at, "text after column %d is not read", f->width);
  r->excess_seen = 1;
}

status format_record(reader *r, const format *f, const physical *line,
                     record *out) {
  out->n_field = filled_fields(f, line);
  PASS_GET(out->fields, store_new(r->d, out->n_field, sizeof *out->fields));
  check_rest(r, f, line, &out->at);
  for (int i = 0; i < out->n_field; ++i)
    PASS(read_column(r, &f->fields[i], line, &out->at, &out->fields[i]));
  return OK;
}
