/*
 * Sparse matrices, by rows and by square blocks, and a vector that has all
 * entries.
 */
#pragma once

#include "base/memory.h"
#include "base/vector.h"

#include <stddef.h>

typedef struct sparse_rows {
  int n;       /* rows */
  int *start;  /* [n+1] */
  int *col;    /* [start[n]] ascending in a row */
  double *val; /* [start[n]] */
} sparse_rows;

/* Entries of row i: row_begin to row_end - 1, none of NULL or all-zero rows;
 * their sum. */
static inline int row_begin(const sparse_rows *rows, int i) {
  return rows == NULL || rows->start == NULL ? 0 : rows->start[i];
}
static inline int row_end(const sparse_rows *rows, int i) {
  return rows == NULL || rows->start == NULL ? 0 : rows->start[i + 1];
}
static inline double row_sum(const sparse_rows *rows, int i) {
  double sum = 0.0;
  for (int k = row_begin(rows, i); k < row_end(rows, i); ++k)
    sum += rows->val[k];
  return sum;
}
/* The largest of n rows. */
static inline double largest_row_sum(const sparse_rows *rows, int n) {
  double most = 0.0;
  for (int i = 0; i < n; ++i) most = fmax(most, row_sum(rows, i));
  return most;
}

/* Frees the arrays and leaves all zero; accepts all-zero. */
static inline void sparse_free(sparse_rows *rows) {
  memory_free(rows->start);
  memory_free(rows->col);
  memory_free(rows->val);
  *rows = (sparse_rows){0};
}

/*
 * A square matrix of dim*dim blocks by columns of blocks. With the place (a, b)
 * there is (b, a), and all (a, a), zero or not.
 */
typedef struct sparse_blocks {
  int dim, n;  /* 1 to 3; blocks in a row */
  int *start;  /* [n+1] of each column of blocks */
  int *row;    /* [start[n]] row of the block, ascending in a column */
  int *mate;   /* [start[n]] place of the block across the diagonal */
  int *own;    /* [n] place of the block on it */
  double *val; /* [start[n]*dim*dim] the blocks, column major */
} sparse_blocks;

/* From entries in any order; those of one place add up, zeros are left out. */
status sparse_blocks_new(int dim, int n, long entries, const int *row,
                         const int *col, const double *val,
                         sparse_blocks **out);
/* The block (i, i), [dim*dim]. */
static inline const double *sparse_blocks_own(const sparse_blocks *b, int i) {
  return b->val + (size_t)b->own[i] * (size_t)(b->dim * b->dim);
}
/* y += B e x, e the column j of blocks: x[dim], y[dim*n]. */
void sparse_blocks_add(const sparse_blocks *b, int j, const double *x,
                       double *y);
/* y = B x; y[dim*n] = |B| x. */
void sparse_blocks_product(const sparse_blocks *b, const double *x, double *y);
void sparse_blocks_bound(const sparse_blocks *b, const double *x, double *y);
/* y[dim] = row i of blocks of B x. */
void sparse_blocks_row(const sparse_blocks *b, int i, const double *x,
                       double *y);
/* The rows of the entries that are not zero. */
status sparse_blocks_rows(const sparse_blocks *b, sparse_rows *rows);
/* All entries into M[m*m], m = dim*n, column major. */
void sparse_blocks_dense(const sparse_blocks *b, double *M);
