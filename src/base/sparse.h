/*
 * A sparse matrix by rows, and a vector that has all entries.
 */
#ifndef PROTIS_BASE_SPARSE_H
#define PROTIS_BASE_SPARSE_H

#include <stddef.h>

typedef struct sparse_rows {
  int n;       /* rows                                                       */
  int *start;  /* [n+1]                                                      */
  int *col;    /* [start[n]] ascending in a row                              */
  double *val; /* [start[n]]                                                 */
} sparse_rows;

/* Frees the arrays and leaves all zero; accepts all-zero. */
void sparse_free(sparse_rows *rows);

/* Largest |v_i| of v[n]; 0 for n = 0. NaN is passed over. */
double largest_entry(size_t n, const double *v);

#endif
