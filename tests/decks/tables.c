#include "decks/tables.h"

#include "base/base.h"

static const char *const kinds[TABLES] = {"CONTACT",  "TOTALS",    "NODES",
                                          "ELEMENTS", "REACTIONS", "ENERGY"};

static void *grow(void *p, size_t n, size_t size) {
  p = realloc(p, n * size);
  if (p == NULL) abort();
  return p;
}

/* "force/length^2*time" */
static void read_unit(const char *text, double unit[3]) {
  static const char *const base[] = {"length", "force", "time"};
  double sign = 1;
  memset(unit, 0, 3 * sizeof *unit);
  while (*text != '\0') {
    double power = 1;
    int k = -1;
    for (int b = 0; b < 3; ++b)
      if (strncmp(text, base[b], strlen(base[b])) == 0) k = b;
    text += k < 0 ? 1 : strlen(base[k]);
    if (*text == '^') power = strtod(text + 1, (char **)&text);
    if (k >= 0) unit[k] += sign * power;
    if (*text == '/') sign = -1;
  }
}

static void read_header(char *line, table *t) {
  char *save = NULL, *word = strtok_r(line + 1, " \n", &save);
  for (; word != NULL && t->n_col < COLUMNS_;
       word = strtok_r(NULL, " \n", &save)) {
    char *unit = strchr(word, '[');
    if (unit != NULL) read_unit(unit + 1, t->unit[t->n_col]);
    if (unit != NULL) *unit = '\0';
    snprintf(t->name[t->n_col++], sizeof *t->name, "%.23s", word);
  }
}

static double read_cell(const char *cell) {
  static const char *const words[] = {"OPEN", "SLIP", "STICK"};
  for (int i = 0; i < 3; ++i)
    if (strcmp(cell, words[i]) == 0) return i;
  char *end;
  double value = strtod(cell, &end);
  return *end == '\0' ? value : NAN;
}

static void read_row(char *line, table *t) {
  size_t at = (size_t)(t->n_row++ * t->n_col);
  t->value = grow(t->value, at + (size_t)t->n_col, sizeof *t->value);
  char *save = NULL, *word = strtok_r(line, " \n", &save);
  for (int c = 0; c < t->n_col; ++c) {
    t->value[at + (size_t)c] = word == NULL ? NAN : read_cell(word);
    if (word != NULL) word = strtok_r(NULL, " \n", &save);
  }
}

/* The table that a line "# step 1 increment 2 time 0.5 table NODES" opens. */
static table *open_table(tables *all, const char *line) {
  snapshot s = {0};
  char kind[24];
  if (sscanf(line, "# step %d increment %d time %lf table %23s", &s.step,
             &s.increment, &s.t, kind) != 4)
    return NULL;
  snapshot *last = all->n > 0 ? &all->at[all->n - 1] : NULL;
  if (last == NULL || last->step != s.step || last->increment != s.increment) {
    all->at = grow(all->at, (size_t)++all->n, sizeof *all->at);
    last = &all->at[all->n - 1];
    *last = s;
  }
  for (int k = 0; k < TABLES; ++k)
    if (strcmp(kinds[k], kind) == 0) return &last->of[k];
  return NULL;
}

tables tables_read(const job *j) {
  enum { LINE = 8192 };
  static char line[LINE];
  tables all = {0};
  char path[200];
  table *t = NULL;
  snprintf(path, sizeof path, "%s/%s.dat", j->dir, j->name);
  FILE *f = fopen(path, "r");
  while (f != NULL && fgets(line, LINE, f) != NULL) {
    if (strncmp(line, "# step ", 7) == 0)
      t = open_table(&all, line);
    else if (t != NULL && line[0] == '#')
      read_header(line, t);
    else if (t != NULL && line[0] != '\n')
      read_row(line, t);
  }
  if (f != NULL) fclose(f);
  return all;
}

void tables_free(tables *all) {
  for (int i = 0; i < all->n; ++i)
    for (int k = 0; k < TABLES; ++k) free(all->at[i].of[k].value);
  free(all->at);
  *all = (tables){0};
}

int table_column(const table *t, const char *name) {
  for (int c = 0; c < t->n_col; ++c)
    if (strcmp(t->name[c], name) == 0) return c;
  return -1;
}

double table_at(const table *t, int row, int col) {
  return t->value[row * t->n_col + col];
}

int *table_rows(const table *t, int most) {
  int *row = grow(NULL, (size_t)most + 2, sizeof *row);
  for (int i = 0; i <= most; ++i) row[i] = -1;
  for (int i = 0; i < t->n_row; ++i) {
    double no = table_at(t, i, 0);
    if (no >= 0 && no <= most) row[(int)no] = i;
  }
  return row;
}
