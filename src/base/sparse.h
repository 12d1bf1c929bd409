/*
 * A sparse matrix by rows, and a vector that has all entries.
 */
#ifndef PROTIS_BASE_SPARSE_H
#define PROTIS_BASE_SPARSE_H

#include "base/memory.h"

#include <math.h>
#include <stddef.h>

typedef struct sparse_rows {
  int n;       /* rows */
  int *start;  /* [n+1] */
  int *col;    /* [start[n]] ascending in a row */
  double *val; /* [start[n]] */
} sparse_rows;

/* Frees the arrays and leaves all zero; accepts all-zero. */
static inline void sparse_free(sparse_rows *rows) {
  memory_free(rows->start);
  memory_free(rows->col);
  memory_free(rows->val);
  *rows = (sparse_rows){0};
}

/* Largest |v_i| of v[n]; 0 for n = 0. NaN is passed over. */
static inline double largest_entry(size_t n, const double *v) {
  double most = 0.0;
  for (size_t i = 0; i < n; ++i) most = fmax(most, fabs(v[i]));
  return most;
}

#endif
