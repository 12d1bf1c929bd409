/* Cholesky factors of which parts change (supernodal.h). */
#include "fem/supernodal/supernodal.h"

#include "base/base.h"

#include <cblas.h>
#include <lapacke.h>

enum {
  FEW_COLUMNS = 16,   /* BLAS costs more than it saves */
  FEW_PRODUCTS = 2048 /* of an update, likewise */
};

static int n_row(const supernodal *s, int q) {
  return (int)(s->start[q + 1] - s->start[q]);
}

static int n_column(const supernodal *s, int q) {
  return (int)(s->first[q + 1] - s->first[q]);
}

static const SuiteSparse_long *rows_of(const supernodal *s, int q) {
  return s->row + s->start[q];
}

size_t supernodal_entries(const supernodal *s, int supernode) {
  return (size_t)n_row(s, supernode) * n_column(s, supernode);
}

/* Supernodes of the columns and those they update first. */
static status link_up(supernodal *s) {
  PASS_NEW_ALL(OF(s->of, s->n), OF(s->parent, s->count));
  for (int q = 0; q < s->count; ++q)
    for (long c = s->first[q]; c < s->first[q + 1]; ++c) s->of[c] = q;
  for (int q = 0; q < s->count; ++q)
    s->parent[q] = n_row(s, q) > n_column(s, q)
                       ? s->of[rows_of(s, q)[n_column(s, q)]]
                       : -1;
  return OK;
}

status supernodal_new(const cholmod_factor *L, supernodal **out) {
  int most = 0;
  MAKES(supernodal, s, out);
  s->n = (int)L->n;
  s->count = (int)L->nsuper;
  s->first = L->super;
  s->start = L->pi;
  s->row = L->s;
  PASS(link_up(s));
  PASS_NEW_ALL(OF(s->head, s->count), OF(s->next, s->count),
               OF(s->done, s->count), OF(s->place, s->n),
               OF(s->product, L->maxcsize));
  for (int q = 0; q < s->count; ++q)
    most = n_row(s, q) > most ? n_row(s, q) : most;
  PASS_NEW_ALL(OF(s->relative, most), OF(s->below, most));
  return OK;
}

status supernodal_restrict(const supernodal *s, const int *number,
                           supernodal **out) {
  supernodal *r = NULL;
  const size_t count = s->count, rows = s->start[count];
  SuiteSparse_long n_rows = 0, *first = NULL;
  PASS_NEW(r, 1);
  *r = *s;
  r->n = 0;
  *out = r;
  OWNS(r);
  PASS_NEW(first, 2 * (count + 1) + rows);
  SuiteSparse_long *start = first + count + 1, *row = start + count + 1;
  for (size_t q = 0; q < count; ++q) {
    first[q] = r->n;
    start[q] = n_rows;
    for (long c = s->first[q]; c < s->first[q + 1]; ++c) r->n += number[c] >= 0;
    for (long i = s->start[q]; i < s->start[q + 1] && r->n > first[q]; ++i)
      if (number[s->row[i]] >= 0) row[n_rows++] = number[s->row[i]];
  }
  first[count] = r->n;
  start[count] = n_rows;
  r->first = first;
  r->start = start;
  r->row = row;
  return link_up(r);
}

/* ---- supernodes of few columns ------------------------------------------- */

typedef struct split {
  SuiteSparse_long count, *first, *start, *at, *row; /* as L has them */
  SuiteSparse_long n_row, n_entry;
} split;

/* The parts of supernode q: counted, and stored where there is room. */
static void split_one(const cholmod_factor *L, size_t q, int most, split *p) {
  const SuiteSparse_long *first = L->super, *start = L->pi, *row = L->s;
  const SuiteSparse_long columns = first[q + 1] - first[q];
  const SuiteSparse_long rows = start[q + 1] - start[q];
  const SuiteSparse_long parts = (columns + most - 1) / most;
  for (SuiteSparse_long k = 0; k < parts; ++k) {
    const SuiteSparse_long from = columns * k / parts;
    const SuiteSparse_long to = columns * (k + 1) / parts;
    if (p->row != NULL) {
      p->first[p->count] = first[q] + from;
      p->start[p->count] = p->n_row;
      p->at[p->count] = p->n_entry;
      COPY(p->row + p->n_row, row + start[q] + from, rows - from);
    }
    ++p->count;
    p->n_row += rows - from;
    p->n_entry += (rows - from) * (to - from);
  }
}

/* Numbers that the updates and the solves take at most, and the parts in the
 * place of the supernodes; of[n] is overwritten. */
static void take_parts(cholmod_factor *L, const split *p,
                       SuiteSparse_long *of) {
  L->maxcsize = L->maxesize = 0;
  for (SuiteSparse_long q = 0; q < p->count; ++q)
    for (SuiteSparse_long c = p->first[q]; c < p->first[q + 1]; ++c) of[c] = q;
  for (SuiteSparse_long q = 0; q < p->count; ++q) {
    const SuiteSparse_long own = p->first[q + 1] - p->first[q];
    const SuiteSparse_long end = p->start[q + 1];
    const size_t below = end - p->start[q] - own;
    if (below > L->maxesize) L->maxesize = below;
    for (SuiteSparse_long i = p->start[q] + own, to; i < end; i = to) {
      for (to = i; to < end && of[p->row[to]] == of[p->row[i]];) ++to;
      const size_t size = (end - i) * (to - i);
      if (size > L->maxcsize) L->maxcsize = size;
    }
  }
  L->super = p->first;
  L->pi = p->start;
  L->px = p->at;
  L->s = p->row;
  L->nsuper = p->count;
  L->ssize = p->n_row;
  L->xsize = p->n_entry;
}

static void free_parts(const split *p, cholmod_common *cm) {
  const size_t n = p->count + 1, size = sizeof *p->row;
  cholmod_l_free(n, size, p->first, cm);
  cholmod_l_free(n, size, p->start, cm);
  cholmod_l_free(n, size, p->at, cm);
  cholmod_l_free(p->n_row, size, p->row, cm);
}

int supernodal_split(cholmod_factor *L, int most, cholmod_common *cm) {
  split p = {0},
        old = {(SuiteSparse_long)L->nsuper, L->super, L->pi, L->px, L->s,
               (SuiteSparse_long)L->ssize,  0};
  const size_t size = sizeof *p.row;
  for (size_t q = 0; q < L->nsuper; ++q) split_one(L, q, most, &p);
  if (p.count == old.count) return 1;
  const SuiteSparse_long count = p.count, rows = p.n_row;
  SuiteSparse_long *of = cholmod_l_malloc(L->n, size, cm);
  p.first = cholmod_l_malloc((size_t)p.count + 1, size, cm);
  p.start = cholmod_l_malloc((size_t)p.count + 1, size, cm);
  p.at = cholmod_l_malloc((size_t)p.count + 1, size, cm);
  p.row = cholmod_l_malloc(p.n_row, size, cm);
  const int fits = cm->status == CHOLMOD_OK;
  if (fits) {
    p.count = p.n_row = p.n_entry = 0;
    for (size_t q = 0; q < L->nsuper; ++q) split_one(L, q, most, &p);
    p.first[p.count] = (SuiteSparse_long)L->n;
    p.start[p.count] = p.n_row;
    p.at[p.count] = p.n_entry;
    take_parts(L, &p, of);
  }
  cholmod_l_free(L->n, size, of, cm);
  p.count = count;
  p.n_row = rows;
  free_parts(fits ? &old : &p, cm);
  return fits;
}

void supernodal_close(const supernodal *s, unsigned char *mark) {
  for (int q = 0; q < s->count; ++q)
    if (mark[q] && s->parent[q] >= 0) mark[s->parent[q]] = 1;
}

void supernodal_list(const supernodal *s, const unsigned char *mark,
                     supernodal_part *part) {
  part->n = 0;
  for (int q = 0; q < s->count; ++q)
    if (mark[q]) part->list[part->n++] = q;
}

/* ---- factor -------------------------------------------------------------- */

/* y[n] += sum of k columns of a, each times what it has in its row 0. */
static void add_columns(int n, int k, const double *restrict a, size_t lead,
                        double *restrict y) {
  int c = 0;
  for (; c + 4 <= k; c += 4) {
    const double *a0 = a + lead * c, *a1 = a0 + lead, *a2 = a1 + lead,
                 *a3 = a2 + lead;
    const double f0 = a0[0], f1 = a1[0], f2 = a2[0], f3 = a3[0];
    for (int i = 0; i < n; ++i)
      y[i] += a0[i] * f0 + a1[i] * f1 + a2[i] * f2 + a3[i] * f3;
  }
  for (; c < k; ++c) {
    const double *a0 = a + lead * c, f0 = a0[0];
    for (int i = 0; i < n; ++i) y[i] += a0[i] * f0;
  }
}

/* out[rows*columns], lower part: a a' of the first "columns" of a[rows*k]. */
static void multiply(int rows, int columns, int k, const double *a, int lead,
                     double *out) {
  const size_t ld = rows;
  if ((double)rows * columns * k <= FEW_PRODUCTS) {
    CLEAR(out, ld * columns);
    for (int j = 0; j < columns; ++j)
      add_columns(rows - j, k, a + j, lead, out + (ld + 1) * j);
    return;
  }
  cblas_dsyrk(CblasColMajor, CblasLower, CblasNoTrans, columns, k, 1.0, a, lead,
              0.0, out, rows);
  if (rows > columns)
    cblas_dgemm(CblasColMajor, CblasNoTrans, CblasTrans, rows - columns,
                columns, k, 1.0, a + columns, lead, a, lead, 0.0, out + columns,
                rows);
}

/* x[q] less what supernode d, which is done, has in its columns. */
static void subtract(supernodal *s, int q, int d, int inside,
                     double *const *x) {
  const int from = s->done[d], rows = n_row(s, d) - from;
  const SuiteSparse_long *row = rows_of(s, d) + from;
  const size_t lead = n_row(s, q);
  int *relative = s->relative;
  multiply(rows, inside, n_column(s, d), x[d] + from, n_row(s, d), s->product);
  for (int i = 0; i < rows; ++i) relative[i] = s->place[row[i]];
  for (int j = 0; j < inside; ++j) {
    double *to = x[q] + lead * relative[j];
    const double *product = s->product + (size_t)rows * j;
    for (int i = j; i < rows; ++i) to[relative[i]] -= product[i];
  }
}

/* d updates next the supernode of its first row that is left. */
static void pass_on(supernodal *s, int d) {
  if (s->done[d] >= n_row(s, d)) return;
  const int to = s->of[rows_of(s, d)[s->done[d]]];
  s->next[d] = s->head[to];
  s->head[to] = d;
}

/* Cholesky factor of the diagonal block and the rows below it; the first column
 * without a positive pivot, or -1. */
static int eliminate_few(int rows, int columns, double *x) {
  const size_t lead = rows;
  for (int j = 0; j < columns; ++j) {
    double *own = x + (lead + 1) * j;
    const int n = rows - j;
    for (int c = 0; c < j; ++c) {
      const double *a = x + lead * c + j, f = a[0];
      for (int i = 0; i < n; ++i) own[i] -= a[i] * f;
    }
    if (!(own[0] > 0.0)) return j;
    const double root = sqrt(own[0]), part = 1.0 / root;
    own[0] = root;
    for (int i = 1; i < n; ++i) own[i] *= part;
  }
  return -1;
}

static int eliminate(int rows, int columns, double *x) {
  if (columns <= FEW_COLUMNS) return eliminate_few(rows, columns, x);
  const int bad =
      (int)LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'L', columns, x, rows);
  if (bad != 0) return bad - 1;
  if (rows > columns)
    cblas_dtrsm(CblasColMajor, CblasRight, CblasLower, CblasTrans, CblasNonUnit,
                rows - columns, columns, 1.0, x, rows, x + columns, rows);
  return -1;
}

/* The supernodes below q have updated it. */
static void use_up(supernodal *s, int q, int renew, double *const *x) {
  for (int d = s->head[q], next; d >= 0; d = next) {
    /* Of supernode d from row "from" on, those within q: their number. */
    const SuiteSparse_long *row = rows_of(s, d);
    int to = s->done[d];
    while (to < n_row(s, d) && row[to] < s->first[q + 1]) ++to;
    const int inside = to - s->done[d];
    next = s->next[d];
    if (renew) subtract(s, q, d, inside, x);
    s->done[d] += inside;
    pass_on(s, d);
  }
}

int supernodal_factor(supernodal *s, const unsigned char *mark,
                      supernodal_fill *fill, void *ctx, double *const *x) {
  for (int q = 0; q < s->count; ++q) s->head[q] = -1;
  for (int q = 0; q < s->count; ++q) {
    if (mark[q]) {
      const SuiteSparse_long *row = rows_of(s, q);
      CLEAR(x[q], supernodal_entries(s, q));
      for (int i = 0; i < n_row(s, q); ++i) s->place[row[i]] = i;
      fill(ctx, q, s->place, x[q]);
    }
    use_up(s, q, mark[q], x);
    if (mark[q]) {
      const int bad = eliminate(n_row(s, q), n_column(s, q), x[q]);
      if (bad >= 0) return (int)s->first[q] + bad;
    }
    s->done[q] = n_column(s, q);
    pass_on(s, q);
  }
  return -1;
}

/* ---- solves -------------------------------------------------------------- */

/* own[columns] = inv of the diagonal block, below[rows] the rest times it. */
static void forward_few(int rows, int columns, const double *x, double *own,
                        double *restrict below) {
  CLEAR(below, rows);
  for (int c = 0; c < columns; ++c) {
    const double *restrict a = x + (size_t)(rows + columns) * c;
    const double f = own[c] /= a[c];
    for (int r = c + 1; r < columns; ++r) own[r] -= a[r] * f;
    for (int r = 0; r < rows; ++r) below[r] += a[columns + r] * f;
  }
}

void supernodal_forward(const supernodal *s, double *const *x,
                        const supernodal_part *part, double *v) {
  for (int t = 0; t < part->n; ++t) {
    const int q = part->list[t], columns = n_column(s, q);
    const int lead = n_row(s, q), rows = lead - columns;
    const SuiteSparse_long *row = rows_of(s, q) + columns;
    double *own = v + s->first[q];
    if (is_zero(columns, own)) continue;
    if (columns <= FEW_COLUMNS) {
      forward_few(rows, columns, x[q], own, s->below);
    } else {
      cblas_dtrsv(CblasColMajor, CblasLower, CblasNoTrans, CblasNonUnit,
                  columns, x[q], lead, own, 1);
      if (rows > 0)
        cblas_dgemv(CblasColMajor, CblasNoTrans, rows, columns, 1.0,
                    x[q] + columns, lead, own, 1, 0.0, s->below, 1);
    }
    for (int r = 0; r < rows; ++r) v[row[r]] -= s->below[r];
  }
}

/* own[columns] = inv of the transposed block, own less what "below" adds. */
static void back_few(int rows, int columns, const double *x, double *own,
                     const double *below) {
  for (int c = columns - 1; c >= 0; --c) {
    const double *a = x + (size_t)(rows + columns) * c;
    double sum[4] = {own[c]};
    int r = 0;
    for (int k = c + 1; k < columns; ++k) sum[0] -= a[k] * own[k];
    for (; r + 4 <= rows; r += 4)
      for (int k = 0; k < 4; ++k) sum[k] -= a[columns + r + k] * below[r + k];
    for (; r < rows; ++r) sum[0] -= a[columns + r] * below[r];
    own[c] = ((sum[0] + sum[1]) + (sum[2] + sum[3])) / a[c];
  }
}

void supernodal_back(const supernodal *s, double *const *x,
                     const supernodal_part *part, double *v) {
  for (int t = part->n - 1; t >= 0; --t) {
    const int q = part->list[t], columns = n_column(s, q);
    const int lead = n_row(s, q), rows = lead - columns;
    const SuiteSparse_long *row = rows_of(s, q) + columns;
    double *own = v + s->first[q];
    for (int r = 0; r < rows; ++r) s->below[r] = v[row[r]];
    if (columns <= FEW_COLUMNS) {
      back_few(rows, columns, x[q], own, s->below);
      continue;
    }
    if (rows > 0)
      cblas_dgemv(CblasColMajor, CblasTrans, rows, columns, -1.0,
                  x[q] + columns, lead, s->below, 1, 1.0, own, 1);
    cblas_dtrsv(CblasColMajor, CblasLower, CblasTrans, CblasNonUnit, columns,
                x[q], lead, own, 1);
  }
}
