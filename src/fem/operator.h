/*
 * The condensed stiffness as an operator: two factors of the whole matrix of
 * the unknowns, in an order that is free to take contact unknowns anywhere. In
 * one all contact unknowns are known (the interior alone), the other follows
 * the rows that are known at the time. Private to src/fem.
 */
#pragma once

#include "fem/factor.h"
#include "fem/rigid.h"
#include "fem/supernodal/supernodal.h"

/* A block of the stiffness and the other node of it, or its column. */
typedef struct block_at {
  size_t block;
  int node;
} block_at;

/* Blocks by what they belong to. */
typedef struct block_lists {
  size_t *start; /* [n+1] */
  block_at *item;
} block_lists;

/* What a factor follows: the rows that are known, what is added to others, and
 * whether there are springs. */
typedef struct row_state {
  unsigned char *known; /* [m] */
  double *added;        /* [rows*m] N/m */
  int springs;
} row_state;

typedef struct sparse_operator {
  contact_operator seen; /* what the contact problem has of it */
  const stiffness *k;    /* borrowed, like the next three */
  const rigid_motions *rigid;
  cholmod_common *cm;
  const unsigned char *pinned; /* [m] with springs where no row is known */
  body_factor f;               /* its L: of the rows known at the time */
  supernodal *s, *interior;    /* interior: without the contact unknowns */
  int *inside;         /* [unknowns] place in the interior, -1: in contact */
  block_lists columns; /* of a supernode: with their column */
  block_lists touched; /* of a contact node: with the other node */
  struct {
    supernodal_part all, contact, response; /* of the contact and above */
    unsigned char *mark;                    /* [supernodes] workspace */
    unsigned char *touches;                 /* [supernodes] 1: in contact */
    int *node; /* [n] contact nodes of the response, n: their number */
    int n;
  } part;
  double **x;     /* [supernodes] columns of f.L */
  double **inner; /* [supernodes] of the interior's factor: shared with x
                     where no contact unknown has part in them */
  double *own;    /* those that are not */
  size_t n_own;   /* entries of them */
  row_state rows; /* of f.L */
  enum { NO_FACTOR, BROKEN, FACTORED } state; /* BROKEN: but for the interior */
  long *number;        /* [dim*n_node] place in the factor, -1 */
  size_t *unknown;     /* [m] dim*node + component of a row */
  unsigned char *held; /* [m] 1: prescribed, no unknown */
  struct {
    double *v, *z; /* [unknowns] by place, [interior] by place inside */
    double *y;     /* [unknowns] inv(K_ii) of the load last condensed */
  } work;
  double *diagonal;  /* [m] N/m, what seen has */
  double *workspace; /* [2*m] what seen has, as the next */
  int *body;         /* [m/rows] */
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
/* The rows that the factor follows; made again for them on reading. */
status sparse_operator_keep(sparse_operator *o, archive *a);
