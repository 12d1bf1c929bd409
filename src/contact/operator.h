/*
 * The condensed stiffness A of a contact problem by products and solves, where
 * its entries are not formed: A = K_cc - K_ci inv(K_ii) K_ic of a body with
 * unknowns c in contact and i in the interior.
 */
#pragma once

#include "base/status.h"

/* A guess of the states: unknowns whose displacement is given, and stiffness
 * that slip adds. */
typedef struct known_rows {
  const unsigned char *known; /* [m] 1: given; NULL: none */
  const double *added;        /* [dim*m] to the row of unknown i: dim entries in
                                 the columns of its node, symmetric, N/m; NULL:
                                 none */
} known_rows;

typedef struct contact_operator {
  void *ctx;
  const double *diagonal; /* [m] of K_cc, N/m: not below that of A */
  const int *body;        /* [n] connected set of elements of each node */
  int n_body;
  const double *kernel; /* [m*n_kernel] orthonormal motions without energy */
  int n_kernel;
  double *workspace;        /* [2*m] of the contact problem */
  double unknowns, entries; /* of the matrix that is factored; of its factor */
  /* Au[m] = A u; size[m], or NULL: the sums of the magnitudes of its terms. */
  void (*apply)(void *ctx, const double *u, double *Au, double *size);
  /* Factor for solve; *singular 1: to rounding. ERR_MEMORY. */
  status (*set_rows)(void *ctx, const known_rows *rows, int *singular);
  /* x[m], at the known rows as given, of (A + added) x = b at the others; Ax[m]
   * = A x at all rows. */
  void (*solve)(void *ctx, const double *b, double *x, double *Ax);
  /* Rows at[m] 1 of which response is wanted, until set_rows. */
  void (*set_response)(void *ctx, const unsigned char *at);
  /* x and Ax as of solve, known rows at 0, at the contact nodes of those rows
   * alone: cheaper where they and the forces b[m] are few. */
  void (*response)(void *ctx, const double *b, double *x, double *Ax);
} contact_operator;
