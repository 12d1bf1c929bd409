/*
 * The condensed stiffness as an operator: two factors of the whole matrix of
 * the unknowns, in an order that is free to take contact unknowns anywhere. In
 * one all contact unknowns are known (the interior alone), the other follows
 * the rows that are known at the time. Private to src/fem.
 */
#ifndef PROTIS_FEM_OPERATOR_H
#define PROTIS_FEM_OPERATOR_H

#include "contact/operator.h"
#include "fem/factor.h"
#include "fem/rigid.h"

typedef enum { NO_FACTOR, OF_ALL, OF_ROWS } rows_factored;

typedef struct sparse_operator {
  contact_operator seen; /* what the contact problem has of it */
  const stiffness *k;    /* borrowed, like the next three */
  const rigid_motions *rigid;
  cholmod_common *cm;
  const unsigned char *pinned; /* [m] with springs where no row is known */
  body_factor f;               /* its L: of the rows known at the time */
  cholmod_factor *inner;
  long *number;          /* [dim*n_node] of the unknowns, -1 */
  size_t *unknown;       /* [m] dim*node + component of a row */
  unsigned char *all;    /* [m] 1 */
  unsigned char *held;   /* [m] 1: prescribed, no unknown */
  unsigned char *known;  /* [m] of f.L */
  double *added;         /* [rows*m] of f.L */
  rows_factored state;   /* of f.L: all rows, with springs, or those known */
  double *v, *w, *sizes; /* [dim*n_node] */
  double *diagonal;      /* [m] N/m, what seen has */
  double *y;             /* [dim*n_node] inv(K_ii) of the load last condensed */
  double *room;          /* [2*m] likewise */
  int *body;             /* [m/rows] likewise */
} sparse_operator;

/* What it is made of, all borrowed until sparse_operator_free but held and
 * body. */
typedef struct operator_data {
  const stiffness *k;
  const double *x;           /* [dim*n_node] coordinates */
  const whole_order *order;  /* NULL: found here */
  const unsigned char *held; /* [m] 1: a prescribed row */
  const int *body;           /* [m/rows] of each contact node */
  int n_body;
  const unsigned char *pinned; /* [m] with springs where no row is known, or
                                  NULL */
  const rigid_motions *rigid;
  cholmod_common *cm;
} operator_data;
/* Order, number and factor: the matrix of all rows, then the interior; *out
 * also on failure, for sparse_operator_free. ERR_SINGULAR: (*out)->f.bad_node;
 * ERR_MEMORY. */
status sparse_operator_new(const operator_data *d, const char **ordering,
                           sparse_operator **out);
void sparse_operator_free(sparse_operator *o); /* accepts NULL */
/* f_c[m] of forces load[dim*n_node] at the unknowns; inv(K_ii) load_i is
 * stored. */
void sparse_operator_forward(sparse_operator *o, const double *load,
                             double *f_c);
/* u[dim*n_node] at the unknowns from u_c[m] and what is stored. */
void sparse_operator_back(sparse_operator *o, const double *u_c, double *u);
/* u += inv(K_ii) load_i at the unknowns of the interior. */
void sparse_operator_interior(sparse_operator *o, const double *load,
                              double *u);
/* The factor of all rows, with springs. ERR_SINGULAR, ERR_MEMORY. */
status sparse_operator_all_rows(sparse_operator *o);

#endif
