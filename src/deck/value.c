/*
 * Names of *PARAMETER and -D: definition, and replacement of <NAME>. Fields of
 * a line, and their values: numbers, quantities, names of files.
 */
#include "base/base.h"
#include "base/option.h"
#include "deck/reader.h"

enum { ADVICE_MAX = 2000 }; /* names searched for the nearest */

int deck_symbol(const void *deck_, const char *name, double *value) {
  const symbol *s = symbol_use(deck_, name, strlen(name));
  if (s != NULL) *value = s->value;
  return s != NULL;
}

/* A .geo distinguishes upper and lower case. */
static status keep_spelling(deck *d, symbol *s, const char *name, size_t n) {
  PASS_GET(s->typed, store_text(d, name, n));
  return OK;
}

enum { ADVICE_SIZE = 128 };

/* "; did you mean NAME?", the name between two marks, or nothing. */
static void advise(const deck *d, const message_log *log, const char *name,
                   const char *marks, char advice[ADVICE_SIZE]) {
  const char *near = NULL;
  advice[0] = '\0';
  const int n = d->n_symbol < ADVICE_MAX ? d->n_symbol : ADVICE_MAX;
  if (message_wanted(log))
    near = nearest_word(name, candidate_name, NAMES(d->symbols, n));
  if (near != NULL)
    snprintf(advice, ADVICE_SIZE, "; did you mean %.1s%s%s?", marks, near,
             *marks != '\0' ? marks + 1 : "");
}

/* Message of an expression that did not compile (the record says why), with
 * the nearest name. "column" is that of the error in text, from 0; the place
 * moves there if the line has the text as it is from byte "start" on. */
static void report_expression(const deck *d, message_log *log, const place *at,
                              const char *text, int start, int column) {
  static const char unknown[] = "unknown name ";
  const char *why = status_message();
  char advice[ADVICE_SIZE] = "";
  place there = *at;
  if (start >= 0 && at->line != NULL && (size_t)start <= strlen(at->line) &&
      strncmp(at->line + start, text, strlen(text)) == 0)
    there.column_no = start + column + 1;
  if (strncmp(why, unknown, sizeof unknown - 1) == 0)
    advise(d, log, why + sizeof unknown - 1, "", advice);
  const char *near = strstr(why, "; did you mean ");
  const int n = near != NULL ? (int)(near - why) : 300;
  message_add(log, P1022, &there, "%.*s in expression '%.200s'%s%s", n, why,
              text, near != NULL ? near : "", advice);
}

/* Length of a name between < and >, or 0. */
static size_t name_in_brackets(const char *p, const char *end) {
  const char *q = p + 1;
  if (q >= end || !is_name_start(*q)) return 0;
  while (q < end && is_name_part(*q)) ++q;
  return q < end && *q == '>' ? q - p - 1 : 0;
}

/* In an expression 0<x>1 is a comparison. */
static int left_alone(replacing how, const char *name, size_t n) {
  if (how == REPLACE_LENIENT) return 1;
  return how == REPLACE_EXPRESSION && n == 1 &&
         strchr("XYZT", upper_case(*name)) != NULL;
}

static status add_value(buffer *b, double value, replacing how) {
  char digits[NUMBER_TEXT_SIZE];
  const char *p = digits;
  number_text(value, digits);
  int in_parentheses = how == REPLACE_EXPRESSION && *p == '-';
  if (how != REPLACE_EXPRESSION && *p == '-' && b->n == 1 &&
      (b->text[0] == '-' || b->text[0] == '+')) {
    p += b->text[0] == '-'; /* - of a negative value */
    b->n = 0;
  }
  if (in_parentheses) PASS(buffer_add(b, "(", 1));
  PASS(buffer_add(b, p, strlen(p)));
  if (in_parentheses) PASS(buffer_add(b, ")", 1));
  return OK;
}

/* Value of <NAME>; unknown: 1 after the message, so that no other follows. */
static status add_named(reader *r, const char *name, size_t n, replacing how,
                        const place *at) {
  const symbol *s = symbol_use(r->d, name, n);
  if (s == NULL && left_alone(how, name, n)) {
    PASS(buffer_add(&r->scratch, name - 1, n + 2));
  } else if (s == NULL) {
    const char *unknown = store_name(r->d, name, n);
    if (unknown == NULL) RAISE(ERR_MEMORY, "memory exhausted: name");
    char advice[ADVICE_SIZE];
    advise(r->d, r->log, unknown, "<>", advice);
    message_add(r->log, P1020, at, "unknown name <%s>%s", unknown, advice);
    PASS(buffer_add(&r->scratch, "1", 1));
  } else {
    PASS(add_value(&r->scratch, s->value, how));
  }
  return OK;
}

status symbols_replace(reader *r, const char *text, size_t n, replacing how,
                       const place *at, const char **out) {
  const char *p = text, *end = text + n;
  const char *open = n > 0 ? memchr(p, '<', n) : NULL;
  r->scratch.n = 0;
  while (open != NULL) {
    size_t length = name_in_brackets(open, end);
    size_t before = open - p + (length == 0);
    PASS(buffer_add(&r->scratch, p, before));
    p += before;
    if (length > 0) {
      place there = *at;
      there.column_no += (int)(open - text);
      PASS(add_named(r, open + 1, length, how, &there));
      p = open + length + 2;
    }
    open = p < end ? memchr(p, '<', end - p) : NULL;
  }
  PASS(buffer_add(&r->scratch, p, end - p));
  *out = store_text(r->d, r->scratch.text, (size_t)r->scratch.n);
  if (*out == NULL) RAISE(ERR_MEMORY, "memory exhausted: text");
  return OK;
}

typedef enum { NO_EXPRESSION, VARIES, NOT_FINITE, CONSTANT } evaluated;

/* What a text is, with its value if that is a constant; no expression: the
 * record says why, *column where. ERR_MEMORY. */
static status evaluate(const deck *d, const char *text, evaluated *what,
                       double *value, int *column) {
  const double origin[3] = {0, 0, 0};
  expression *e = NULL;
  status st = expression_compile(text, deck_symbol, d, &e, column);
  *what = NO_EXPRESSION;
  if (st == ERR_DECK) return OK;
  PASS(st);
  const int varies = expression_variables(e) != 0;
  *value = varies ? 0.0 : expression_value(e, origin, 0);
  *what = varies ? VARIES : isfinite(*value) ? CONSTANT : NOT_FINITE;
  memory_free(e);
  return OK;
}

/* Value of an expression that must not depend on place and time; 1 after a
 * message. "start": byte of the text in the line, for the column. */
static status constant_value(reader *r, const char *text, int start,
                             const place *at, double *value) {
  evaluated what;
  int column;
  PASS(evaluate(r->d, text, &what, value, &column));
  if (what == CONSTANT) return OK;
  *value = 1;
  if (what == NO_EXPRESSION)
    report_expression(r->d, r->log, at, text, start, column);
  else if (what == VARIES)
    message_add(r->log, P1022, at,
                "'%.200s' depends on x, y, z or t; a parameter of that name "
                "is written <NAME>",
                text);
  else
    message_add(r->log, P1023, at, "'%.200s' is not finite", text);
  return OK;
}

typedef struct definition {
  const char *name, *value;
  size_t n_name, n_value;
  int quoted; /* the value stood in quotes */
} definition;

/* The value part of NAME = VALUE: an expression. */
static status definition_value(reader *r, const definition *def,
                               const place *at, double *value) {
  const char *replaced, *raw = store_text(r->d, def->value, def->n_value);
  if (raw == NULL) RAISE(ERR_MEMORY, "memory exhausted: definition");
  if (!def->quoted && strchr(raw, '.') != NULL && number_bare_exponent(raw)) {
    message_add(r->log, P1036, at,
                "'%s' is a sum and a number with exponent; write E before the "
                "exponent, or a blank before the sign of a sum",
                raw);
    return OK;
  }
  PASS(symbols_replace(r, def->value, def->n_value, REPLACE_EXPRESSION, at,
                       &replaced));
  return constant_value(r, replaced, at->column_no - 1, at, value);
}

/* Cut NAME = VALUE; NULL, or what is wrong. */
static const char *cut_definition(const char *text, size_t n, definition *d) {
  const char *end = text + n, *equals = n > 0 ? memchr(text, '=', n) : NULL;
  if (equals == NULL) return "NAME = VALUE expected";
  d->name = trim(text, equals - text, &d->n_name);
  d->value = trim(equals + 1, end - equals - 1, &d->n_value);
  d->quoted = 0;
  if (d->n_name == 0) return "no name before the equals sign";
  for (size_t i = 0; i < d->n_name; ++i)
    if (!is_name_part(d->name[i]) || !is_name_start(d->name[0]))
      return "a name is a letter followed by letters, digits and underscores";
  if (d->n_value > 0 && d->value[0] == '=') return "one equals sign expected";
  if (d->n_value > 1 && d->value[0] == '"' && d->value[d->n_value - 1] == '"') {
    d->quoted = 1;
    ++d->value;
    d->n_value -= 2;
  }
  d->value = trim(d->value, d->n_value, &d->n_value);
  return d->n_value == 0 ? "no value after the equals sign" : NULL;
}

static void warn_of_variable(reader *r, const symbol *s, const place *at) {
  if (strcmp(s->name, "PI") != 0 &&
      (s->name[1] != '\0' || strchr("XYZT", s->name[0]) == NULL))
    return;
  message_add(r->log, P1034, at,
              "%s keeps its own meaning in expressions; the value is <%s>",
              s->name, s->name);
}

static status define_piece(reader *r, piece p) {
  const char *text = r->line.all.text;
  definition def;
  double value = 1;
  place at = logical_place(&r->line, p.start);
  const char *wrong = cut_definition(text + p.start, p.length, &def);
  if (wrong != NULL) {
    message_add(r->log, P1019, &at, "%s", wrong);
    return OK;
  }
  symbol *s = symbol_find(r->d, def.name, def.n_name);
  if (s != NULL && s->at.file != NULL) {
    message_add(r->log, P1021, &at, "%s is defined already, in %s:%d", s->name,
                s->at.file, s->at.line_no);
    return OK;
  }
  place value_at = logical_place(&r->line, (int)(def.value - text));
  PASS(definition_value(r, &def, &value_at, &value));
  if (s == NULL) PASS(symbol_add(r->d, def.name, def.n_name, &s));
  PASS(keep_spelling(r->d, s, def.name, def.n_name));
  if (!s->overridden) s->value = value;
  s->at = at;
  warn_of_variable(r, s, &at);
  return OK;
}

status symbols_define(reader *r) {
  piece p = {.next = 0};
  while (p.next >= 0) {
    p = logical_piece(&r->line, p.next, 1);
    if (p.length == 0 && p.next < 0) break;
    PASS(define_piece(r, p));
  }
  return OK;
}

status symbols_from_command(reader *r, const char *define) {
  definition def;
  double value = 1;
  const place at = {.file = "command line"};
  const char *wrong = cut_definition(define, strlen(define), &def);
  symbol *s = NULL;
  if (wrong == NULL) s = symbol_find(r->d, def.name, def.n_name);
  if (s != NULL) wrong = "the name is defined already";
  if (wrong != NULL) {
    message_add(r->log, P1026, &at, "-D %.200s: %s", define, wrong);
    return OK;
  }
  PASS(definition_value(r, &def, &at, &value));
  PASS(symbol_add(r->d, def.name, def.n_name, &s));
  PASS(keep_spelling(r->d, s, def.name, def.n_name));
  s->value = value;
  s->overridden = 1;
  warn_of_variable(r, s, &at);
  return OK;
}

/* ---- values ------------------------------------------------------------- */

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
static status compile_owned(deck *d, const char *text,
                            const char *const names[4], const expression **out,
                            int *column) {
  expression *e = NULL;
  *column = -1;
  OWNS(d);
  PASS(expression_compile_in(text, names, deck_symbol, d, &e, column));
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
  status st = compile_owned(d, f->text, names, out, &column);
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
  quote = p->length > 0 ? memchr(text, '"', p->length) : NULL;
  if (quote == NULL) return 0;
  const char *after = NULL;
  if (quote == text) {
    const char *close = memchr(text + 1, '"', p->length - 1);
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
 * it is an expression at all. What is wrong is reported by the caller that
 * needs a value. */
static status settle_constant(reader *r, field *f, int *valid) {
  evaluated what;
  int column;
  double value;
  char digits[NUMBER_TEXT_SIZE];
  PASS(evaluate(r->d, f->text, &what, &value, &column));
  *valid = what != NO_EXPRESSION;
  if (what != CONSTANT) return OK;
  number_text(value, digits);
  PASS_GET(f->text, store_text(r->d, digits, strlen(digits)));
  return OK;
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
  const char *text = trim(r->line.all.text + p.start, p.length, &n);
  place inside = logical_place(&r->line, (int)(text - r->line.all.text));
  return out->quoted ? read_quoted(r, text, n, on_card, &inside, out)
                     : read_plain(r, text, n, &inside, out);
}
