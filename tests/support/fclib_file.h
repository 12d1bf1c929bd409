/*
 * Files in the layout of FCLIB for the tests, written and read back without
 * the program, and a check of a solution in the convention of that layout.
 */
#pragma once

#include <hdf5.h>

enum { STORE_TRIPLET = 0, STORE_COLUMNS = -1, STORE_ROWS = -2 };

/* A new file; datasets and the groups above them; every failure ends the test.
 */
hid_t fclib_begin(const char *path);
void fclib_end(hid_t file);
void fclib_int(hid_t file, const char *name, int value);
void fclib_ints(hid_t file, const char *name, int n, const int *value);
void fclib_reals(hid_t file, const char *name, int n, const double *value);
/* Matrix group of the nonzero entries of a[rows*columns], column major.
 * Triplets come in reverse order, the first one split in two halves, nzmax
 * larger than nz. */
void fclib_matrix(hid_t file, const char *group, int store, int rows,
                  int columns, const double *a);
/* A whole local problem; a whole global one, both matrices stored so. */
void fclib_local(const char *path, int store, int dim, int n, const double *W,
                 const double *q, const double *mu);
typedef struct fclib_global_data {
  int dim, n, n_v;     /* contacts, rows of M                                 */
  const double *M, *H; /* [n_v*n_v], [n_v*dim*n] column major                 */
  const double *f, *w, *mu;
} fclib_global_data;
void fclib_global(const char *path, int store, const fclib_global_data *g);
/* A dataset (caller frees) and its number of items; NULL if it is not there. */
double *fclib_take(const char *path, const char *name, int *n);

/*
 * Largest violation by (u, r), relative to the largest of |q|: u = W r + q,
 * signs, complementarity, the cone, the slip rule. W column major; forces count
 * with the largest |W|.
 */
double fclib_violation(int dim, int n, const double *W, const double *q,
                       const double *mu, const double *u, const double *r);
