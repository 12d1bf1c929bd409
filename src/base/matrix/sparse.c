/* A sparse matrix of square blocks (sparse.h). */
#include "base/base.h"
#include "base/sparse.h"

typedef struct entries {
  long n;
  const int *row, *col;
  const double *val;
} entries;

/* Places of the blocks and of those across, column by column, with repeats. */
typedef struct places {
  int *start; /* [n+1] */
  int *row;   /* [start[n]] */
} places;

static void count(int *start, int column) { ++start[column + 2]; }

static void put(places *p, int row, int column) {
  p->row[p->start[column + 1]++] = row;
}

static status places_new(int dim, int n, const entries *e, places *p) {
  PASS_NEW_ALL(OF(p->start, n + 2), OF(p->row, 2 * e->n + n));
  for (long k = 0; k < e->n; ++k) {
    if (e->val[k] == 0.0) continue;
    count(p->start, e->col[k] / dim);
    count(p->start, e->row[k] / dim);
  }
  for (int i = 0; i < n; ++i) count(p->start, i);
  for (int i = 0; i < n; ++i) p->start[i + 2] += p->start[i + 1];
  for (long k = 0; k < e->n; ++k) {
    if (e->val[k] == 0.0) continue;
    put(p, e->row[k] / dim, e->col[k] / dim);
    put(p, e->col[k] / dim, e->row[k] / dim);
  }
  for (int i = 0; i < n; ++i) put(p, i, i);
  return OK;
}

/* Each place once: in the order of the columns every row is put into the
 * column of its own number, which makes the rows ascend. */
static status set_pattern(sparse_blocks *b, const places *p) {
  OWNED int *last = NULL, *next = NULL;
  PASS_NEW_ALL(OF(last, b->n), OF(next, b->n));
  for (int i = 0; i < b->n; ++i) last[i] = -1;
  for (int j = 0; j < b->n; ++j)
    for (int k = p->start[j]; k < p->start[j + 1]; ++k) {
      if (last[p->row[k]] == j) continue;
      last[p->row[k]] = j;
      ++b->start[p->row[k] + 1];
    }
  for (int j = 0; j < b->n; ++j) {
    b->start[j + 1] += b->start[j];
    next[j] = b->start[j];
    last[j] = -1;
  }
  PASS_NEW_ALL(OF(b->row, b->start[b->n]), OF(b->mate, b->start[b->n]),
               OF(b->own, b->n),
               OF(b->val, (size_t)b->start[b->n] * (b->dim * b->dim)));
  for (int j = 0; j < b->n; ++j)
    for (int k = p->start[j]; k < p->start[j + 1]; ++k) {
      int i = p->row[k];
      if (last[i] == j) continue;
      last[i] = j;
      b->row[next[i]++] = j;
    }
  COPY(next, b->start, b->n);
  for (int j = 0; j < b->n; ++j)
    for (int k = b->start[j]; k < b->start[j + 1]; ++k) {
      b->mate[k] = next[b->row[k]]++;
      if (b->row[k] == j) b->own[j] = k;
    }
  return OK;
}

/* Place of the block (i, j), which is there. */
static int place_of(const sparse_blocks *b, int i, int j) {
  int low = b->start[j], high = b->start[j + 1] - 1;
  while (low < high) {
    int middle = low + (high - low) / 2;
    if (b->row[middle] < i)
      low = middle + 1;
    else
      high = middle;
  }
  return low;
}

static double *block(const sparse_blocks *b, int place) {
  return b->val + (size_t)place * (b->dim * b->dim);
}

status sparse_blocks_new(int dim, int n, long count_given, const int *row,
                         const int *col, const double *val,
                         sparse_blocks **out) {
  const entries e = {count_given, row, col, val};
  MAKES(sparse_blocks, b, out);
  b->dim = dim;
  b->n = n;
  PASS_NEW(b->start, n + 1);
  OWNED_PARTS(places, p, places_new(dim, n, &e, &p));
  PASS(set_pattern(b, &p));
  for (long k = 0; k < e.n; ++k) {
    if (val[k] == 0.0) continue;
    int place = place_of(b, row[k] / dim, col[k] / dim);
    block(b, place)[row[k] % dim + dim * (col[k] % dim)] += val[k];
  }
  return OK;
}

void sparse_blocks_add(const sparse_blocks *b, int j, const double *x,
                       double *y) {
  const double *B = block(b, b->start[j]);
  int d = b->dim;
  for (int k = b->start[j]; k < b->start[j + 1]; ++k, B += d * d) {
    double *to = y + b->row[k] * d;
    if (d == 3) {
      double y0 = B[0] * x[0] + B[3] * x[1] + B[6] * x[2];
      double y1 = B[1] * x[0] + B[4] * x[1] + B[7] * x[2];
      double y2 = B[2] * x[0] + B[5] * x[1] + B[8] * x[2];
      to[0] += y0;
      to[1] += y1;
      to[2] += y2;
      continue;
    }
    for (int c = 0; c < d; ++c)
      for (int r = 0; r < d; ++r) to[r] += B[r + d * c] * x[c];
  }
}

void sparse_blocks_product(const sparse_blocks *b, const double *x, double *y) {
  CLEAR(y, b->n * b->dim);
  for (int j = 0; j < b->n; ++j)
    if (!is_zero(b->dim, x + j * b->dim))
      sparse_blocks_add(b, j, x + j * b->dim, y);
}

void sparse_blocks_bound(const sparse_blocks *b, const double *x, double *y) {
  int d = b->dim;
  CLEAR(y, b->n * d);
  for (int j = 0; j < b->n; ++j)
    for (int k = b->start[j]; k < b->start[j + 1]; ++k)
      for (int e = 0; e < d * d; ++e)
        y[b->row[k] * d + e % d] += fabs(block(b, k)[e]) * x[j * d + e / d];
}

void sparse_blocks_row(const sparse_blocks *b, int i, const double *x,
                       double *y) {
  int d = b->dim;
  CLEAR(y, d);
  for (int k = b->start[i]; k < b->start[i + 1]; ++k) {
    const double *B = block(b, b->mate[k]), *from = x + b->row[k] * d;
    for (int e = 0; e < d * d; ++e) y[e % d] += B[e] * from[e / d];
  }
}

status sparse_blocks_rows(const sparse_blocks *b, sparse_rows *rows) {
  int d = b->dim, m = b->n * d, count_all = 0;
  size_t all = (size_t)b->start[b->n] * (d * d);
  for (size_t k = 0; k < all; ++k) count_all += b->val[k] != 0.0;
  PASS_NEW_ALL(OF(rows->start, m + 1), OF(rows->col, count_all),
               OF(rows->val, count_all));
  rows->n = m;
  for (int i = 0; i < m; ++i) {
    int at = rows->start[i];
    for (int k = b->start[i / d]; k < b->start[i / d + 1]; ++k)
      for (int c = 0; c < d; ++c) {
        double value = block(b, b->mate[k])[i % d + d * c];
        if (value == 0.0) continue;
        rows->col[at] = b->row[k] * d + c;
        rows->val[at++] = value;
      }
    rows->start[i + 1] = at;
  }
  return OK;
}

void sparse_blocks_dense(const sparse_blocks *b, double *M) {
  int d = b->dim;
  size_t m = b->n * d;
  CLEAR(M, m * m);
  for (int j = 0; j < b->n; ++j)
    for (int k = b->start[j]; k < b->start[j + 1]; ++k)
      for (int e = 0; e < d * d; ++e)
        M[b->row[k] * d + e % d + m * (j * d + e / d)] = block(b, k)[e];
}
