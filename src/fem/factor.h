/*
 * One sparse Cholesky factor per body, contact unknowns ordered last, and what
 * is read off it. Private to src/fem.
 *
 * The matrix is scaled by 2^-exponent so that its largest diagonal entry lies
 * in [0.5, 1): moduli times any power of two give the same factor bit by bit.
 */
#pragma once

#include "fem/ordering.h"

typedef struct body_factor {
  int n_node, n_inner, n_own;
  int *node;                   /* [n_node] in elimination order: n_inner of the
                                  interior, then those with condensed unknowns;
                                  a node with both stands in both places, the
                                  first n_own once */
  int bad_node;                /* where the factor broke down, for the
                                  message */
  long n, nc;                  /* unknowns; contact ones among them */
  long *unknown;               /* [n] dim*node + component of position p in the
                                  factor */
  long *contact_at;            /* [nc] positions of the contact unknowns,
                                  ascending */
  int *contact_id;             /* [nc] their rows in A */
  int *rank;                   /* [n - contact_at[0]] rank of a position among
                                  them or -1 */
  int exponent;                /* see above */
  double flops;                /* of the factorisation */
  int whole;                   /* 1: contact unknowns anywhere in the order,
                                  nc = 0 */
  const unsigned char *pinned; /* [m] contact unknowns whose diagonal entry is
                                  doubled in the factor, borrowed; NULL: none */
  cholmod_factor *L;
  cholmod_dense *y;    /* [n] stored forward solve */
  cholmod_dense *work; /* [L->maxesize] */
} body_factor;

/* Number the unknowns of f->node (set by the caller): sets n, nc and
 * number[dim*n_node], -1 where prescribed. */
void body_factor_number(const stiffness *k, body_factor *f, long *number);
/* Symbolic factor and places of the unknowns in it. f->exponent too.
 * ERR_SINGULAR, ERR_MEMORY. */
status body_factor_analyse(const stiffness *k, const long *number,
                           cholmod_common *cm, body_factor *f);
/* Build the matrix, f->pinned included, and factor it. ERR_SINGULAR,
 * ERR_MEMORY. */
status body_factor_build(const stiffness *k, const long *number,
                         cholmod_common *cm, body_factor *f);
/* Spring of the unknown dim*node + component in the scaled matrix, 0: none. */
double body_factor_spring(const stiffness *k, const body_factor *f,
                          long unknown);
/* f->bad_node and ERR_SINGULAR: the factor ends at a node. */
status body_factor_broke(body_factor *f, int node);
void body_factor_release(body_factor *f, cholmod_common *cm);
/* Put the body's part of the condensed stiffness, without the pins, into A[m*m]
 * (zero there). */
status body_factor_condense(const stiffness *k, const body_factor *f, int m,
                            double *A);
/* Copy the upper triangle of A[n*n] to the lower one. */
void symmetric_fill(size_t n, double *A);
/* y = L^-1 P load, stored; the body's rows of f_c[m]. load[dim*n_node]. */
status body_factor_forward(body_factor *f, const double *load, double *f_c,
                           cholmod_common *cm);
/* Least pivot over its diagonal entry: -, 1 for a diagonal matrix. */
double body_factor_least_pivot(const stiffness *k, const body_factor *f);
/* u[dim*n_node] at the body's unknowns from u_c[m] and the stored y. */
status body_factor_back(const body_factor *f, const double *u_c, double *u,
                        cholmod_common *cm);
/* u += inv(K_ii) load_i at the interior unknowns; load[dim*n_node]. */
status body_factor_interior(const body_factor *f, const double *load, double *u,
                            cholmod_common *cm);
/* *square += d' inv(K) d for forces d[m] on the contact unknowns, which come
 * last in the factor: d' inv(A) d = |inv(L_cc) d|^2. Pins that hold only the
 * rigid motions of a body carry no force where d is in equilibrium: then the
 * same. */
status body_factor_energy(const body_factor *f, const double *d,
                          double *square);
/* w = inv(K) d at the unknowns of the body for forces d[dim*n_node] on them,
 * and *square += d' w. */
status body_factor_solve(const body_factor *f, const double *d, double *w,
                         double *square, cholmod_common *cm);
/* Estimate of the condition number of the matrix factored, scaled to a unit
 * diagonal. ERR_MEMORY. */
status body_factor_condition(const stiffness *k, const body_factor *f,
                             cholmod_common *cm, double *condition);
