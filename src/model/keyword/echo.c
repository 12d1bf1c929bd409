/* What the keyword table prints: the deck with all defaults, and the help. */
#include "base/base.h"
#include "model/keyword/keyword.h"

#include <ctype.h>
#include <strings.h>

enum { WIDTH = 78, TEXT = 512 };

/* 1 if a text that is no expression must be quoted to be read back. */
static int needs_quotes(const char *text) {
  size_t n = strlen(text);
  return strpbrk(text, ",=") != NULL || strstr(text, "**") != NULL ||
         (n > 0 && (text[0] == ' ' || text[n - 1] == ' '));
}

/* Folder of the file a value stands in, from that of the deck on: the echo
 * has no includes, and names of files are relative to where they stand. */
static int folder_beyond(const model *m, const field *value,
                         const char **from) {
  const char *deck_end = strrchr(m->deck->file, '/');
  const char *end =
      value->at.file == NULL ? NULL : strrchr(value->at.file, '/');
  size_t skip = deck_end == NULL ? 0 : (size_t)(deck_end - m->deck->file) + 1;
  *from = "";
  if (end == NULL || value->text[0] == '/') return 0;
  if (strncmp(value->at.file, m->deck->file, skip) != 0) skip = 0;
  *from = value->at.file + skip;
  return end + 1 > *from ? (int)(end + 1 - *from) : 0;
}

/* One parameter with its comma, on a line of its own if it is long. */
static void echo_option(const model *m, const card *c, const option *o,
                        const void *param, int *column, FILE *out) {
  char value[TEXT];
  const char *text = value, *folder = "", *quote = "";
  const parameter *given = card_parameter(c, o->name);
  int n = 0;
  option_write(o, param, value, sizeof value);
  if (o->type == OPT_NAME) { /* of any length */
    text = *(const char *const *)((const char *)param + o->offset);
    if (text == NULL || text[0] == '\0') return;
    if (given != NULL && strcmp(o->name, "FILE") == 0)
      n = folder_beyond(m, &given->value, &folder);
    if (needs_quotes(text)) quote = "\"";
  }
  int length =
      (int)(strlen(o->name) + strlen(text) + 2 * strlen(quote)) + n + 1;
  int breaks = *column + 2 + length > WIDTH;
  fputs(breaks ? ",\n    " : ", ", out);
  *column = (breaks ? 4 : *column + 2) + length;
  fprintf(out, "%s=%s%.*s%s%s", o->name, quote, n, folder, text, quote);
}

/* Options that are absent and have no value are left out. */
static void echo_options(const model *m, const card *c, const option *table,
                         const void *param, int *column, FILE *out) {
  for (const option *o = table; o != NULL && o->name != NULL; ++o) {
    int absent = card_parameter(c, o->name) == NULL;
    if (absent &&
        (o->initial == NULL || strcmp(o->initial, OPTION_ABSENT) == 0))
      continue;
    echo_option(m, c, o, param, column, out);
  }
}

static void echo_record(const card *c, const record *line, FILE *out) {
  if (strcmp(c->name, "HEADING") == 0) {
    fprintf(out, "%s\n", line->raw);
    return;
  }
  int column = 0;
  for (int k = 0; k < line->n_field; ++k) {
    const field *f = &line->fields[k];
    int length = (int)strlen(f->text) + 3;
    if (k > 0 && column + length > WIDTH) {
      fputs(",\n", out);
      column = 0;
    } else if (k > 0) {
      fputs(", ", out);
    }
    int quoted = f->quoted || needs_quotes(f->text);
    fprintf(out, quoted ? "\"%s\"" : "%s", f->text);
    column += length;
  }
  fputc('\n', out);
}

static void echo_card(const model *m, const card *c, FILE *out) {
  card_options param;
  _Alignas(16) char plugin_param[PARAM_SIZE];
  const keyword *row = keyword_find(c->name);
  if (row == NULL || (row->where & LANGUAGE)) return;
  reading r = {.m = (model *)m, .card = c, .material_id = -1};
  keyword_parameters(row, &r, &param, plugin_param);
  int column = fprintf(out, "*%s", c->name);
  echo_options(m, c, row->options, &param, &column, out);
  if (row->names != NULL)
    echo_options(m, c, row->names(&r).options, plugin_param, &column, out);
  fputc('\n', out);
  for (int i = 0; i < c->n_record; ++i) echo_record(c, &c->records[i], out);
}

/* 1 if an expression of the text, which stands in quotes, has the name. */
static int has_name(const char *text, const char *name) {
  size_t n = strlen(name);
  int quoted = 0;
  for (const char *p = text; *p != '\0';) {
    size_t k = 0;
    while (isalnum((unsigned char)p[k]) || p[k] == '_') ++k;
    if (quoted && k == n && strncasecmp(p, name, n) == 0) return 1;
    if (k == 0) quoted = *p == '\n' ? 0 : quoted ^ (*p == '"');
    p += k > 0 ? k : 1;
  }
  return 0;
}

static status echo_cards(FILE *out, const void *of) {
  const model *m = of;
  for (int i = 0; i < m->deck->n_card; ++i)
    echo_card(m, &m->deck->cards[i], out);
  return OK;
}

status model_echo(FILE *out, const void *of) {
  const deck *d = ((const model *)of)->deck;
  OWNED_OF(char, cards, text_made(&cards, of, echo_cards));
  /* Names are replaced by their values, except in expressions and the .geo. */
  int any = 0;
  for (int i = 0; i < d->n_symbol; ++i) {
    const symbol *s = &d->symbols[i];
    if (!s->in_geometry && !has_name(cards, s->name)) continue;
    if (!any) fputs("*PARAMETER\n", out);
    any = 1;
    fprintf(out, "%s = %.17g\n", s->typed, s->value);
  }
  fputs(cards, out);
  return OK;
}

static const char *where_text(unsigned where) {
  if (where & LANGUAGE) return "anywhere";
  if (where & IN_MATERIAL) return "after *MATERIAL";
  if ((where & (IN_STEP | IN_MODEL)) == (IN_STEP | IN_MODEL))
    return "before the steps or in a step";
  return where & IN_STEP ? "in a step" : "before the first *STEP";
}

static void print_keyword(const keyword *k, FILE *out) {
  fprintf(out, "*%s  (%s)\n  ", k->name, where_text(k->where));
  text_wrap(out, k->help, 2);
  option_print(k->options, out);
  if (k->names != NULL)
    fputs("  and the options of what it names: protis --list\n", out);
  if (k->data[0] == '\0') return;
  fputs("  data lines: ", out);
  text_wrap(out, k->data, 14);
}

int keywords_print(const char *name, FILE *out) {
  char upper[80];
  if (name == NULL) {
    for (const keyword *k = keyword_table; k->name != NULL; ++k) {
      fprintf(out, "*%-20s ", k->name);
      text_wrap(out, k->help, 22);
    }
    return 1;
  }
  if (name[0] == '*') ++name;
  snprintf(upper, sizeof upper, "%s", name);
  for (char *p = upper; *p != '\0'; ++p) *p = (char)toupper((unsigned char)*p);
  const keyword *k = keyword_find(upper);
  if (k == NULL) return 0;
  print_keyword(k, out);
  return 1;
}
