/*
 * Tables of the columns as text: a header with the units, a record a line.
 */
#include "base/text.h"
#include "output/columns/columns.h"

#include <string.h>

enum { COLUMNS = sizeof((table *)0)->col / sizeof(column *) };

static int larger(int a, int b) { return a > b ? a : b; }

static void cell_name(const column *c, const model *m, char *text,
                      size_t size) {
  char unit[80];
  column_unit(c->unit, m, unit, sizeof unit);
  snprintf(text, size, "%s[%s]", c->name, unit);
}

/* Sign, point, E and three digits of the exponent: digits + 8. */
static int cell_width(const column *c, const model *m, int digits) {
  char name[160];
  cell_name(c, m, name, sizeof name);
  int width = c->form == AS_REAL ? digits + 8 : 11;
  return larger(width, (int)strlen(name)) + 1;
}

void table_choose(table *t, entity of, unsigned print_bit, const view *v,
                  int digits) {
  t->n = 0;
  t->of = of;
  t->digits = digits;
  const column *c;
  for (column_walk w = columns_of(of);
       (c = column_next(&w)) != NULL && c->of == of;) {
    if ((c->tables & print_bit) == 0) continue;
    if (!column_visible(c, v->m) || !column_ready(c, v->s)) continue;
    if (t->n == COLUMNS) break;
    t->width[t->n] = cell_width(c, v->m, digits);
    t->col[t->n++] = c;
  }
}

void table_header(const table *t, const model *m, const char *lead, FILE *f) {
  fputs(lead, f);
  for (int k = 0; k < t->n; ++k) {
    char name[160];
    cell_name(t->col[k], m, name, sizeof name);
    text_cell(f, name, t->width[k]);
  }
  fputc('\n', f);
}

static void row_cell(const table *t, int k, const view *v, int id, FILE *f) {
  const column *c = t->col[k];
  char text[NUMBER_SIZE], word[160];
  if (c->form == AS_WORD) {
    text_word(word, sizeof word, c->word(v, id));
    text_cell(f, word, t->width[k]);
    return;
  }
  double value = c->value(v, id, c->part);
  if (c->form == AS_COUNT)
    snprintf(text, sizeof text, "%.0f", value);
  else
    text_number(text, value, t->digits);
  text_cell(f, text, t->width[k]);
}

void table_row(const table *t, const view *v, int id, FILE *f) {
  fputc(' ', f);
  for (int k = 0; k < t->n; ++k) row_cell(t, k, v, id, f);
  fputc('\n', f);
}
