/*
 * Cholesky factors of sparse matrices of one pattern, of which parts change:
 * left-looking by supernodes (Ng, Peyton 1993) on the symbolic factor of
 * CHOLMOD. Only the supernodes that a change reaches are made again, in the
 * order of a whole factor, so that the result has its bits.
 *
 * The columns of supernode s stand in x[s], those of L from their diagonal
 * block down, with as many rows as the supernode has.
 */
#pragma once

#include "base/status.h"

#include <cholmod.h>

typedef struct supernodal {
  int n, count;                  /* columns; supernodes */
  const SuiteSparse_long *first; /* [count+1] column; borrowed, as the next */
  const SuiteSparse_long *start; /* [count+1] of the rows of one */
  const SuiteSparse_long *row;   /* positions, ascending, its own first */
  int *of;                       /* [n] supernode of a column */
  int *parent;                   /* [count] -1: none */
  int *head, *next;              /* [count] lists of those that update one */
  int *done;                     /* [count] rows of one that are used up */
  int *place;                    /* [n] of a row in the present supernode */
  int *relative;                 /* [most rows] of the rows of another */
  double *product;               /* [largest update] */
  double *below;                 /* [most rows] of a solve */
} supernodal;

/* Supernodes of some columns and all that follow from them. */
typedef struct supernodal_part {
  int n, *list; /* ascending */
} supernodal_part;

/* Supernodes of a symbolic factor with more than so many columns become
 * several, for CHOLMOD too: nearly all the zeros above their diagonal and most
 * of the largest update are saved. 0: no memory. */
int supernodal_split(cholmod_factor *L, int most, cholmod_common *cm);
/* L: symbolic, borrowed. ERR_MEMORY. */
status supernodal_new(const cholmod_factor *L, supernodal **out);
/* The supernodes without the rows and columns whose number[n] is negative; the
 * others are numbered ascending. *out is new and uses the workspace of s.
 * ERR_MEMORY. */
status supernodal_restrict(const supernodal *s, const int *number,
                           supernodal **out);
/* Entries of the columns of a supernode. */
size_t supernodal_entries(const supernodal *s, int supernode);
/* mark[count]: those above one with a mark get it too. */
void supernodal_close(const supernodal *s, unsigned char *mark);
/* part->list[count] of those with a mark. */
void supernodal_list(const supernodal *s, const unsigned char *mark,
                     supernodal_part *part);

/* Writes the entries of the matrix in the columns of a supernode into x, zero
 * before: rows by place[row]. */
typedef void supernodal_fill(void *ctx, int supernode, const int *place,
                             double *x);
/* The columns x[count] of the supernodes with a mark. Returns the first column
 * without a positive pivot, or -1. */
int supernodal_factor(supernodal *s, const unsigned char *mark,
                      supernodal_fill *fill, void *ctx, double *const *x);
/* v[n] = inv(L) v, zero where the part has no columns. */
void supernodal_forward(const supernodal *s, double *const *x,
                        const supernodal_part *part, double *v);
/* v[n] = inv(L') v at the columns of the part; others are not read. */
void supernodal_back(const supernodal *s, double *const *x,
                     const supernodal_part *part, double *v);
