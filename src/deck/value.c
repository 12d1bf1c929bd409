/*
 * Values of fields: numbers, quantities, names of files.
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
