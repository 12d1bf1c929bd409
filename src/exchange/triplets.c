/*
 * The matrix group of FCLIB: nzmax, m (rows), n (columns), nz, p, i, x.
 * nz >= 0   triplets: p = columns, i = rows, nz of them (nzmax may be more)
 * nz = -1   by columns: p[n+1] starts of the columns, i = rows
 * nz = -2   by rows: p[m+1] starts of the rows, i = columns
 * Indices count from 0.
 */
#include "base/base.h"
#include "exchange/parts.h"

enum { NAME = 240, BY_COLUMN = -1, BY_ROW = -2 };

typedef struct arrays {
  const hdf5_source *s;
  const char *group;
  int nz;
  long n_p, n_i, n_x; /* items in the file */
  int *p, *i;         /* borrowed */
} arrays;

static const char *name_of(char text[NAME], const char *group,
                           const char *item) {
  snprintf(text, NAME, "%s/%s", group, item);
  return text;
}

static status group_int(const hdf5_source *s, const char *group,
                        const char *item, int *value) {
  char name[NAME];
  return source_int(s, name_of(name, group, item), value);
}

static status too_short(const arrays *a, const char *item, long have,
                        long want) {
  if (have < want)
    RAISE(ERR_DECK, "%s: %s/%s has %ld items, expected %ld", a->s->path,
          a->group, item, have, want);
  return OK;
}

/* The starts of n lines ascend from 0; *entries = the last one. */
static status check_starts(const arrays *a, int n, long *entries) {
  *entries = 0;
  if (n == 0 && a->n_p == 0) return OK;
  PASS(too_short(a, "p", a->n_p, (long)n + 1));
  if (a->p[0] != 0)
    RAISE(ERR_DECK, "%s: %s/p starts with %d, expected 0", a->s->path, a->group,
          a->p[0]);
  for (int k = 0; k < n; ++k)
    if (a->p[k + 1] < a->p[k])
      RAISE(ERR_DECK, "%s: %s/p descends at item %d", a->s->path, a->group,
            k + 1);
  *entries = a->p[n];
  return OK;
}

static status check_index(const arrays *a, const char *item, const int *index,
                          long n, int limit) {
  for (long k = 0; k < n; ++k)
    if (index[k] < 0 || index[k] >= limit)
      RAISE(ERR_DECK, "%s: %s/%s, item %ld = %d outside 0 to %d", a->s->path,
            a->group, item, k, index[k], limit - 1);
  return OK;
}

/* Lines of a compressed matrix written out, one index per entry. */
static void expand(const int *start, int n, int *line) {
  for (int k = 0; k < n; ++k)
    for (int e = start[k]; e < start[k + 1]; ++e) line[e] = k;
}

/* The lines of the entries: t->row or t->column. */
static status fill(const arrays *a, triplets *t, int **line) {
  int compressed = a->nz < 0;
  int lines = a->nz == BY_ROW ? t->rows : t->columns;
  int limit = a->nz == BY_ROW ? t->columns : t->rows;
  t->n = a->nz;
  if (compressed) PASS(check_starts(a, lines, &t->n));
  PASS(too_short(a, "i", a->n_i, t->n));
  PASS(too_short(a, "x", a->n_x, t->n));
  PASS(check_index(a, "i", a->i, t->n, limit));
  if (!compressed) {
    PASS(too_short(a, "p", a->n_p, t->n));
    PASS(check_index(a, "p", a->p, t->n, lines));
  }
  PASS_NEW(*line, t->n);
  if (compressed && a->n_p > 0)
    expand(a->p, lines, *line);
  else if (t->n > 0)
    COPY(*line, a->p, t->n);
  return OK;
}

status triplets_size(const hdf5_source *s, const char *group, triplets *t) {
  if (!source_has(s, group))
    RAISE(ERR_DECK, "%s: there is no group %s", s->path, group);
  PASS(group_int(s, group, "m", &t->rows));
  PASS(group_int(s, group, "n", &t->columns));
  if (t->rows < 0 || t->columns < 0)
    RAISE(ERR_DECK, "%s: %s is %d x %d", s->path, group, t->rows, t->columns);
  return OK;
}

status triplets_read(const hdf5_source *s, const char *group, triplets *t) {
  const long most = MOST_ITEMS;
  char name[NAME];
  arrays a = {.s = s, .group = group};
  PASS(triplets_size(s, group, t));
  PASS(group_int(s, group, "nz", &a.nz));
  if (a.nz < BY_ROW)
    RAISE(ERR_DECK, "%s: %s/nz = %d; expected a number of entries, -1 or -2",
          s->path, group, a.nz);
  /* Those of a matrix without entries may be missing. */
  int **i = a.nz == BY_ROW ? &t->column : &t->row;
  OWNED_OF(int, p,
           source_ints(s, name_of(name, group, "p"), 1, most, &a.n_p, &p));
  PASS(source_ints(s, name_of(name, group, "i"), 1, most, &a.n_i, i));
  PASS(source_reals(s, name_of(name, group, "x"), 1, most, &a.n_x, &t->value));
  a.p = p;
  a.i = *i;
  return fill(&a, t, a.nz == BY_ROW ? &t->row : &t->column);
}

void triplets_dense(const triplets *t, double *a) {
  for (long k = 0; k < t->n; ++k)
    a[t->row[k] + (size_t)t->rows * t->column[k]] += t->value[k];
}

status triplets_by_column(const triplets *t, int **start, long **entry) {
  PASS_NEW_ALL(OF(*start, t->columns + 2), OF(*entry, t->n));
  for (long k = 0; k < t->n; ++k) ++(*start)[t->column[k] + 2];
  for (int j = 0; j <= t->columns; ++j) (*start)[j + 1] += (*start)[j];
  for (long k = 0; k < t->n; ++k) (*entry)[(*start)[t->column[k] + 1]++] = k;
  return OK;
}

int triplets_triangle(const triplets *t) {
  int lower = 0, upper = 0;
  for (long k = 0; k < t->n; ++k)
    if (t->value[k] != 0.0) {
      lower |= t->row[k] > t->column[k];
      upper |= t->row[k] < t->column[k];
    }
  return upper - lower;
}
