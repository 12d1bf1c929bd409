/*
 * What newton_system is made of: the matrix of a guess and its factor
 * (matrix.c), rows exchanged in a kept factor (exchange.c), the choice between
 * the two (system.c).
 */
#ifndef PROTIS_NEWTON_PARTS_H
#define PROTIS_NEWTON_PARTS_H

#include "solver/newton/dense.h"
#include "solver/newton/system.h"

#include <stdint.h>

enum {
  CHUNK = 32, /* rows gathered at a time                                      */
  READ = 8    /* solves whose arithmetic takes as long as reading the factor  */
};

struct newton_system {
  const contact_problem *cp; /* of the last fit                              */
  size_t n_node;
  int m, symmetric; /* symmetric: -1: not yet looked at                      */
  double power; /* of two: A*power has a diagonal of order 1                  */
  dense K;      /* factor of the base                                         */
  pattern base; /* what it was made for                                       */
  int has_base;
  uint64_t friction;  /* hash of B in it                                     */
  double spent;       /* on updates of the base, operations                  */
  int updated;        /* the last step came from an update                   */
  int room, n_column; /* columns of X: most, made                            */
  int *column;        /* [m] of X, -1: not made                              */
  double *X;          /* [m*room] inv(M0) e_j                                */
  double *C;          /* [room*room] small system                            */
  double *rows;       /* [m*CHUNK]                                           */
  double *product;    /* [CHUNK*room]                                        */
  int n_changed;      /* rows in which the guess differs from the base       */
  int *changed;       /* [m]                                                 */
  double *b, *x, *du; /* [m]                                                 */
  double *z, *weight; /* [room], [room]                                      */
  int *small_pivot;   /* [room]                                            */
};

/* ---- matrix.c ---- */

/* 1: the guess puts friction into the rows of the node. */
int newton_bends(const newton_system *s, const pattern *p, int node_id);
/* 1: M needs LU under the guess. */
int newton_needs_lu(const newton_system *s, const pattern *p);
/* Rows of slipping nodes in one column of M: e (B A_n) of the closed nodes is
 * added; column[m] of A, to[n_free]. */
void newton_limit_rows(const newton_system *s, const pattern *p,
                       const double *column, double *to);
/* Row of a free unknown under the guess, all columns, times power. to[m] */
void newton_row(const newton_system *s, const pattern *p, int dof, double *to);
/* Operations of a new factor. */
double newton_cost(int n, int full);
/* The guess becomes the base, without a factor yet. */
void newton_begin(newton_system *s, const pattern *p, int full);
/* Factor of the base; 0: singular to rounding. */
int newton_factor(newton_system *s);
/* x[n_free, n_rhs], distance m, from the right sides, by the factor. */
void newton_back(const newton_system *s, int n_rhs, double *x);
/* From the free unknowns of the base to all, in place; x[m]. */
void newton_expand(const newton_system *s, double *x);
/* du of the base's own matrix. */
void newton_plain_step(newton_system *s);
/* du with springs, where the system is singular; leaves no base. */
void newton_spring_step(newton_system *s, const pattern *p);

/* ---- exchange.c ---- */

/* List the rows in which the guess differs from the base; returns what an
 * update costs, operations. */
double newton_list_changes(newton_system *s, const pattern *p);
/* du by exchange of the listed rows; 0: the small system is singular. */
int newton_exchange(newton_system *s, const pattern *p);

#endif
