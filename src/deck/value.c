/*
 * Fields of a line, and their values: numbers, quantities, names of files.
 */
#include "base/memory.h"
#include "base/number.h"
#include "base/text.h"
#include "deck/reader.h"

#include <math.h>
#include <string.h>

static int report_number(const field *f, message_log *log, message_id id,
                         const char *kind, const char *why) {
  if (*f->text == '\0')
    message_add(log, P1037, &f->at, "empty field, %s expected", kind);
  else if (f->quoted)
    message_add(log, id, &f->at,
                "not %s: '%.200s' (no expression of a constant value)", kind,
                f->text);
  else if (strncmp(why, "not", 3) == 0)
    message_add(log, id, &f->at, "%s: '%.200s'", why, f->text);
  else
    message_add(log, id, &f->at, "not %s: '%.200s' (%s)", kind, f->text, why);
  return -1;
}

int deck_real(const field *f, message_log *log, double *out) {
  const char *why = number_real(f->text, out);
  if (why == NULL) return 0;
  return report_number(f, log, P1024, "a number", why);
}

int deck_int(const field *f, message_log *log, int *out) {
  const char *why = number_int(f->text, out);
  if (why == NULL) return 0;
  return report_number(f, log, P1025, "an integer", why);
}

/* Compile; the deck owns the expression. */
static status compile(deck *d, const char *text, const char *const names[4],
                      const expression **out, int *column) {
  struct deck_text *own = d->own;
  expression *e = NULL;
  *column = -1;
  PASS_GROW(own->expressions, own->n_expression, own->expression_capacity);
  PASS(expression_compile_in(text, names, deck_symbol, d, &e, column));
  own->expressions[own->n_expression++] = e;
  *out = e;
  return OK;
}

/* Byte of the text behind the opening quote in its line, from 0. */
static int text_start(const field *f) {
  const char *p = f->at.line;
  if (p == NULL || f->at.column_no < 1) return -1;
  int i = f->at.column_no;
  while (i < (int)strlen(p) && is_blank(p[i])) ++i;
  return i;
}

int deck_formula(deck *d, const field *f, const char *const names[4],
                 message_log *log, const expression **out) {
  int column;
  *out = NULL;
  if (*f->text == '\0')
    return report_number(f, log, P1024, "a number or an expression", "empty");
  status st = compile(d, f->text, names, out, &column);
  if (st == OK) return 0;
  if (st == ERR_MEMORY)
    message_memory(log);
  else
    report_expression(d, log, &f->at, f->text, text_start(f), column);
  return -1;
}

int deck_quantity(deck *d, const field *f, const char *const names[4],
                  message_log *log, quantity *out) {
  static const char *const plain[] = {"X", "Y", "Z", "T"};
  const double origin[3] = {0, 0, 0};
  *out = (quantity){.number = 0};
  if (!f->quoted) return deck_real(f, log, &out->number);
  if (names == NULL) names = plain;
  if (deck_formula(d, f, names, log, &out->formula) != 0) return -1;
  if (expression_variables(out->formula) != 0) return 0;
  out->number = expression_value(out->formula, origin, 0);
  out->formula = NULL;
  if (isfinite(out->number)) return 0;
  message_add(log, P1023, &f->at, "'%.200s' is not finite", f->text);
  return -1;
}

const char *deck_path(deck *d, const field *f) {
  const char *slash = f->at.file != NULL ? strrchr(f->at.file, '/') : NULL;
  size_t folder = slash != NULL ? (size_t)(slash - f->at.file) + 1 : 0;
  size_t n = strlen(f->text);
  if (f->text[0] == '/') folder = 0;
  char *path = store_new(d, folder + n + 1, 1);
  if (path == NULL) return NULL;
  if (folder > 0) memcpy(path, f->at.file, folder);
  memcpy(path + folder, f->text, n + 1);
  text_plain(path);
  return deck_input(d, path) == OK ? path : NULL;
}

status deck_input_copy(deck *d, const char *path) {
  char *text = store_new(d, strlen(path) + 1, 1);
  if (text == NULL) RAISE(ERR_MEMORY, "memory exhausted: name of a file");
  strcpy(text, path);
  return deck_input(d, text);
}

/* ---- fields of a line ---------------------------------------------------- */

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
  GET(f->text, store_text(r->d, digits, strlen(digits)));
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
