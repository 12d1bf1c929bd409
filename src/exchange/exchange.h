/*
 * Discrete problems from files, in the place of a mesh: contact problems in the
 * layout of FCLIB (HDF5) and linear complementarity problems as text.
 *
 * FCLIB (local)   u = W r + q,   per contact (N, T1[, T2])
 *                 0 <= u_N, 0 <= r_N, u_N r_N = 0, Coulomb's law with mu r_N
 * FCLIB (global)  M v = H r + f,  u = H' v + w
 *                 condensed here: W = H' inv(M) H,  q = H' inv(M) f + w,
 *                 or to a stiffness if M is singular (springs.c)
 * Equality constraints are eliminated: (local)  u = W r + V l + q,
 * V'r + R l + s = 0;  (global)  M v = H r + G l + f,  G'v + b = 0.
 *
 * There u_N is the remaining gap and r_N >= 0 pushes; here (contact.h) u_n is
 * positive towards the obstacle and r_n <= 0 pushes: the normal components of u
 * and r change their sign, the tangential ones stay.
 *
 * LCP as text: n, the matrix by rows, q; blanks, commas or line ends between
 * the numbers, # starts a comment.  w = q + M z,  w >= 0, z >= 0, w'z = 0.
 */
#pragma once

#include "base/message.h"
#include "contact/contact.h"

typedef enum {
  EXCHANGE_BY_CONTENT = -1,
  EXCHANGE_FCLIB,
  EXCHANGE_LCP
} exchange_type;

typedef struct exchange_problem {
  int dim;               /* 2 or 3; 1: a plain LCP */
  int n, m;              /* contacts; unknowns dim*n */
  int unknowns;          /* n of M of a global problem; else m */
  const char *form;      /* "FCLIB, local", ... for the listing */
  contact_problem cp;    /* dim 2 or 3; borrows the arrays below */
  double *matrix;        /* [m*m] W (A if the global M is singular); LCP: M;
                            NULL: W in blocks */
  sparse_blocks *blocks; /* W where most of it is zero; or NULL */
  double *load;          /* [m] W f (f); LCP: q */
  double *gap, *ut0;     /* [n], [n*(dim-1)] */
  double *g0;            /* [n] zero */
  sparse_rows B;         /* diagonal, mu */
} exchange_problem;

/*
 * Read it. ERR_FILE: cannot be opened or read, no HDF5 file; ERR_DECK: its
 * contents are no problem (missing, wrong sizes, not finite); both with an
 * error in the log that names file and dataset. ERR_SINGULAR: M of a global
 * problem cannot be inverted. *out is NULL on failure.
 */
status exchange_read(const char *path, exchange_type type, const place *at,
                     message_log *log, exchange_problem **out);
