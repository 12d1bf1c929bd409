/* What the readers of this folder share. Private to src/exchange. */
#pragma once

#include "base/archive/dataset.h"
#include "exchange/exchange.h"

/* Largest number of unknowns of a dense matrix. */
enum { MOST_UNKNOWNS = 30000 };
/* ERR_MEMORY: not enough memory for the matrices of a problem of m unknowns,
 * its own and those of a solver; checked before they are read. */
status require_problem_memory(double m);

/* Entries in the order of the file; repeated ones add up. */
typedef struct triplets {
  int rows, columns;
  long n;
  int *row, *column; /* [n] */
  double *value;     /* [n] */
} triplets;

/* Rows and columns alone. */
status triplets_size(const hdf5_source *s, const char *group, triplets *t);
/* GROUP/m, n, nz, p, i, x: triplet, by columns (CSC) or by rows (CSR). */
status triplets_read(const hdf5_source *s, const char *group, triplets *t);
/* Dense, column major with leading dimension t->rows, into zeroed a. */
void triplets_dense(const triplets *t, double *a);
/* Numbers of the entries, column by column: those of column j are entry[k],
 * start[j] <= k < start[j + 1]. */
status triplets_by_column(const triplets *t, int **start, long **entry);
/* 1, -1: only the upper, the lower triangle is stored; 0: both or none. */
int triplets_triangle(const triplets *t);

/* p is all zero before; release it on failure too. */
status fclib_read(const char *path, exchange_problem *p);

/* V'r + R l + s = 0 with u = W r + V l + q. */
typedef struct constraints {
  int p;     /* how many */
  double *V; /* [m*p] column major */
  double *R; /* [p*p] */
  double *s; /* [p] */
} constraints;
/* W[m*m], q[m] without l. ERR_SINGULAR: they contradict one another. */
status constraints_eliminate(const char *path, int m, const constraints *c,
                             double *W, double *q);

/*
 * W[m*m] = H' inv(M) H (symmetric) and q[m] = H' inv(M) f + w, both given
 * zeroed and with w; M symmetric or one triangle of it. *usable = 0: M is not
 * symmetric and positive definite, nothing is done.
 */
status reduce_global(const triplets *M, const triplets *H, const double *f,
                     double *W, double *q, int *usable);
/*
 * Entries of the same W (any order, those of one place add up) where M falls
 * into bodies that share few contacts: *usable = 0 also where they may be more
 * than "share" of m*m. W all zero before, freed by the caller.
 */
status reduce_bodies(const triplets *M, const triplets *H, const double *f,
                     double share, triplets *W, double *q, int *usable);
/* The same for any M of moderate size. "path" for messages. ERR_SINGULAR: M
 * cannot be inverted, or is too large. */
status reduce_any(const char *path, const triplets *M, const triplets *H,
                  const double *f, double *W, double *q);

/* M + s H H' into *held; s >= 0 from the diagonals. */
status springs_add(const triplets *M, const triplets *H, double *s,
                   triplets *held);
/* A[m*m], load[m] of a singular M; *usable = 0: not possible. */
status springs_condense(const triplets *M, const triplets *H, const double *f,
                        double *A, double *load, int *usable);
