/*
 * Problems of many bodies whose answer is planted, given as a compliance in
 * sparse blocks, and a natural map that shares nothing with the program.
 */
#pragma once

#include "contact/contact.h"

typedef enum {
  PLANTED_REGULAR,
  PLANTED_SINGULAR,
  PLANTED_SCALED,
  PLANTED_CROWDED /* all contacts between two bodies: no block is zero        */
} planted_kind;

/* n contacts between neighbours in a row of bodies, W = H inv(M) H' with fewer
 * columns than rows but for PLANTED_REGULAR; masses over 8 decades with
 * PLANTED_SCALED. A third each of the contacts are open, slip and stick. */
typedef struct planted {
  contact_problem cp; /* points to the arrays below                          */
  double *W, *q;      /* [m*m] column major, [m]                             */
  double *gap, *ut0, *g0;
  sparse_rows *B;
  sparse_blocks *blocks;
  double *u, *r; /* [m] for the answer                                       */
} planted;

planted planted_new(planted_kind kind, int dim, int n, double mu,
                    unsigned long long seed);
void planted_free(planted *p);
/* Natural map of the forces r and of u = W r + q, each node in the steps of its
 * own diagonal, over the forces its displacements without contact would take;
 * the largest |u - (W r + q)| in the same measure. */
double planted_map(const planted *p, const double *u, const double *r);
