/*
 * A sparse matrix by rows.
 */
#ifndef PROTIS_BASE_SPARSE_H
#define PROTIS_BASE_SPARSE_H

typedef struct sparse_rows {
  int n;       /* rows                                                       */
  int *start;  /* [n+1]                                                      */
  int *col;    /* [start[n]] ascending in a row                              */
  double *val; /* [start[n]]                                                 */
} sparse_rows;

/* Frees the arrays and leaves all zero; accepts all-zero. */
void sparse_free(sparse_rows *rows);

#endif
