#include "support/sums.h"

#include <check.h>
#include <ctype.h>
#include <hdf5.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LINE = 8192, COLUMNS = 64, DEPTH = 16 };

/* A sum is exact to ROUNDING of its largest number, or to MARGIN times what
 * other kernels make of it. */
#define ROUNDING 1e-8
#define MARGIN 30.0

/* Of a row, where blanks are '_', and of a column, key or dataset. */
static int same_name(const char *row, const char *name) {
  while (*row != '\0' && (*row == *name || (*row == '_' && *name == ' ')))
    ++row, ++name;
  return *row == *name;
}

static sum_row *find(sums *s, const char *name) {
  for (int i = s->n - 1; i >= 0; --i)
    if (same_name(s->row[i].name, name)) return &s->row[i];
  if (s->n == s->capacity) {
    s->capacity = 2 * s->capacity + 64;
    s->row = realloc(s->row, (size_t)s->capacity * sizeof *s->row);
    ck_assert_ptr_nonnull(s->row);
  }
  sum_row *row = &s->row[s->n++];
  *row = (sum_row){0};
  ck_assert_uint_lt(strlen(name), sizeof row->name);
  for (size_t i = 0; name[i] != '\0'; ++i)
    row->name[i] = name[i] == ' ' ? '_' : name[i];
  return row;
}

/* Weights between 1 and 2 that do not repeat. What is no number counts as 0. */
static void add(sum_row *row, double value) {
  const double turns = 0.6180339887498949 * (double)row->count;
  const double weight = 1.0 + (turns - floor(turns));
  ++row->count;
  if (!isfinite(value)) return;
  row->total += weight * value;
  row->largest = fmax(row->largest, fabs(value));
}

static double read_letters(const char *from, const char *to) {
  double value = 0.0;
  for (; from < to; ++from)
    value = fmod(31.0 * value + (unsigned char)*from, 997.0);
  return value;
}

/* Words, of a status or of a contact, count by their letters. */
static double read_word(const char *word) {
  char *end;
  double value = strtod(word, &end);
  return *end == '\0' ? value : read_letters(word, strchr(word, '\0'));
}

/* Columns of a block of JOB.dat: its heading names the table, the next line
 * the columns. */
static int read_heading(sums *s, char *line, const char *table, int *column) {
  int n = 0;
  char name[sizeof s->row->name];
  for (char *word = strtok(line + 1, " \t\n"); word != NULL;
       word = strtok(NULL, " \t\n")) {
    word[strcspn(word, "[")] = '\0';
    snprintf(name, sizeof name, "%s.%s", table, word);
    ck_assert_int_lt(n, COLUMNS);
    column[n++] = (int)(find(s, name) - s->row);
  }
  return n;
}

/* Blocks with a heading each, or one with the name "whole". */
static void read_tables(sums *s, char *text, const char *whole) {
  char table[64], *save = NULL;
  int column[COLUMNS], n = 0;
  snprintf(table, sizeof table, "%s", whole);
  for (char *line = strtok_r(text, "\n", &save); line != NULL;
       line = strtok_r(NULL, "\n", &save)) {
    const char *kind =
        strncmp(line, "# step ", 7) == 0 ? strstr(line, " table ") : NULL;
    if (kind != NULL)
      snprintf(table, sizeof table, "%s", kind + 7);
    else if (line[0] == '#')
      n = read_heading(s, line, table, column);
    else {
      char *rest = line, *word;
      for (int k = 0; (word = strsep(&rest, " \t")) != NULL;)
        if (*word != '\0' && k < n) add(&s->row[column[k++]], read_word(word));
    }
  }
}

/* The lines of JOB.lst under a heading. */
static void read_section(sums *s, char *text, const char *heading) {
  char key[32];
  snprintf(key, sizeof key, "\n%s\n", heading);
  char *at = strstr(text, key);
  ck_assert_msg(at != NULL, "no %s", heading);
  snprintf(key, sizeof key, "lst.%s", heading);
  const int row = (int)(find(s, key) - s->row);
  for (char *end; *++at != '\n'; at = end) {
    end = strchr(at, '\n');
    *end = '\0';
    add(&s->row[row], read_word(at));
    *end = '\n';
  }
}

/* The keys that lead to a value, "effects.expected_calls"; lists count as
 * their owner. */
typedef struct keys {
  char name[DEPTH][48];
  int depth;
} keys;

static void add_key(sums *s, const keys *k, double value) {
  char name[DEPTH * 49] = "json";
  for (int i = 1; i <= k->depth; ++i)
    if (k->name[i][0] != '\0') {
      strcat(name, ".");
      strcat(name, k->name[i]);
    }
  add(find(s, name), value);
}

/* One word of JSON at "at": a bracket, a text, a number, true or false; where
 * the next begins. */
static const char *read_json(sums *s, keys *k, const char *at) {
  size_t n = strcspn(at, ",:]}\n ");
  if (*at == '"') {
    const char *end = at + 1;
    while (*end != '"') end += *end == '\\' ? 2 : 1;
    if (end[1] == ':')
      snprintf(k->name[k->depth], sizeof k->name[0], "%.*s",
               (int)(end - at) - 1, at + 1);
    else
      add_key(s, k, read_letters(at + 1, end));
    return end + 1;
  }
  if (*at == '{' || *at == '[') {
    ck_assert_int_lt(++k->depth, DEPTH);
    k->name[k->depth][0] = '\0';
    return at + 1;
  }
  if (*at == '}' || *at == ']') --k->depth;
  if (n == 0) return at + 1;
  add_key(s, k, *at == 't' ? 1.0 : *at == 'f' ? 0.0 : strtod(at, NULL));
  return at + n;
}

/* Datasets of numbers; the records of a field under one name. */
static herr_t read_dataset(hid_t file, const char *path, const H5O_info_t *o,
                           void *to) {
  sums *s = to;
  char name[sizeof s->row->name] = "h5:";
  if (o->type != H5O_TYPE_DATASET) return 0;
  snprintf(name + 3, sizeof name - 3, "%s", path);
  char *last = strrchr(name, '/');
  if (last != NULL && isdigit((unsigned char)last[1])) *last = '\0';
  hid_t set = H5Dopen2(file, path, H5P_DEFAULT), space = H5Dget_space(set);
  hid_t type = H5Dget_type(set);
  H5T_class_t class = H5Tget_class(type);
  hssize_t n = H5Sget_simple_extent_npoints(space);
  if (n > 0 && (class == H5T_INTEGER || class == H5T_FLOAT)) {
    double *x = malloc((size_t)n * sizeof *x);
    ck_assert_ptr_nonnull(x);
    ck_assert_int_ge(
        H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, x), 0);
    sum_row *row = find(s, name);
    for (hssize_t i = 0; i < n; ++i) add(row, x[i]);
    free(x);
  }
  H5Tclose(type);
  H5Sclose(space);
  H5Dclose(set);
  return 0;
}

static void read_fields(sums *s, const job *j) {
  char path[128];
  if (!job_has(j, "h5")) return;
  snprintf(path, sizeof path, "%s/%s.h5", j->dir, j->name);
  hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  ck_assert_msg(file >= 0, "%s cannot be read", path);
  ck_assert_int_ge(H5Ovisit(file, H5_INDEX_NAME, H5_ITER_INC, read_dataset, s),
                   0);
  H5Fclose(file);
}

/* Counts of iterations and the error of the solver hang on rounding more than
 * results do. */
static int is_loose(const char *name) {
  static const char *const words[] = {"iter",      "sweep",       "solves",
                                      "sta.error", "calls",       "products",
                                      "refactor",  "solver_error"};
  for (size_t i = 0; i < sizeof words / sizeof *words; ++i)
    if (strstr(name, words[i]) != NULL) return 1;
  return 0;
}

/* What another machine, or another hour, gives otherwise; what is rounding
 * alone. */
static int is_left_out(const char *name) {
  static const char *const words[] = {
      "seconds",      "bytes",  "memory",       "peak_",  "json.threads",
      "json.version", "kernel", "improve_next", "defect", "residual"};
  for (size_t i = 0; i < sizeof words / sizeof *words; ++i)
    if (strstr(name, words[i]) != NULL) return 1;
  return strstr(name, "cpu") != NULL && strstr(name, "expected") == NULL;
}

sums sums_of(const job *j) {
  sums s = {0};
  keys k = {.depth = 0};
  char *tables = job_file(j, "dat"), *json = job_file(j, "json");
  char *lst = job_file(j, "lst"), *sta = job_file(j, "sta");
  ck_assert_msg(json != NULL, "%s has no JSON", j->name);
  if (tables != NULL) read_tables(&s, tables, "");
  read_tables(&s, sta, "sta");
  read_section(&s, lst, "MODEL");
  read_section(&s, lst, "EQUATIONS");
  for (const char *at = json; *at != '\0';) at = read_json(&s, &k, at);
  read_fields(&s, j);
  free(tables);
  free(json);
  free(lst);
  free(sta);
  int n = s.n;
  s.n = 0;
  for (int i = 0; i < n; ++i)
    if (!is_left_out(s.row[i].name)) s.row[s.n++] = s.row[i];
  for (int i = 0; i < s.n; ++i)
    s.row[i].tolerance =
        (is_loose(s.row[i].name) ? 0.2 : ROUNDING) * s.row[i].largest;
  return s;
}

void sums_free(sums *s) {
  free(s->row);
  *s = (sums){0};
}

void sums_spread(sums *a, const sums *b) {
  ck_assert_int_eq(a->n, b->n);
  for (int i = 0; i < a->n; ++i) {
    sum_row *row = &a->row[i];
    ck_assert_str_eq(row->name, b->row[i].name);
    ck_assert_msg(row->count == b->row[i].count || is_loose(row->name),
                  "%s: %ld numbers, elsewhere %ld", row->name, row->count,
                  b->row[i].count);
    row->tolerance =
        fmax(row->tolerance, MARGIN * fabs(row->total - b->row[i].total));
  }
}

void sums_write(const sums *s, const char *path) {
  FILE *file = fopen(path, "w");
  ck_assert_msg(file != NULL, "%s cannot be written", path);
  fprintf(file, "# name, count, weighted sum, tolerance: make sums-update\n");
  for (int i = 0; i < s->n; ++i)
    fprintf(file, "%s %ld %.16g %.1e\n", s->row[i].name, s->row[i].count,
            s->row[i].total, s->row[i].tolerance);
  ck_assert_int_eq(fclose(file), 0);
}

/* What is wrong with a line of the file, to "text"; 1: something is. */
static int differs(const sums *s, int i, const sum_row *wanted, char *text,
                   size_t size) {
  const sum_row *found = i < s->n ? &s->row[i] : NULL;
  if (found == NULL || strcmp(found->name, wanted->name) != 0)
    snprintf(text, size, "%s: in its place %s", wanted->name,
             found == NULL ? "nothing" : found->name);
  else if (found->count != wanted->count && !is_loose(found->name))
    snprintf(text, size, "%s: %ld numbers, were %ld", wanted->name,
             found->count, wanted->count);
  else if (fabs(found->total - wanted->total) > wanted->tolerance)
    snprintf(text, size, "%s: sum %.12g, was %.12g to %.1e", wanted->name,
             found->total, wanted->total, wanted->tolerance);
  else
    return 0;
  return 1;
}

void sums_check(const sums *s, const char *path) {
  char line[LINE], text[320], all[2048] = "";
  int n = 0, bad = 0;
  FILE *file = fopen(path, "r");
  ck_assert_msg(file != NULL, "%s cannot be read", path);
  while (fgets(line, sizeof line, file) != NULL) {
    sum_row wanted = {0};
    if (line[0] == '#') continue;
    ck_assert_msg(sscanf(line, "%111s %ld %lf %lf", wanted.name, &wanted.count,
                         &wanted.total, &wanted.tolerance) == 4,
                  "%s: '%s'", path, line);
    if (differs(s, n++, &wanted, text, sizeof text) && bad++ < 5)
      snprintf(all + strlen(all), sizeof all - strlen(all), "\n  %s", text);
  }
  fclose(file);
  ck_assert_msg(bad == 0 && n == s->n,
                "%s: %d of %d sums differ, %d found; wanted so: make "
                "sums-update%s",
                path, bad, n, s->n, all);
}
