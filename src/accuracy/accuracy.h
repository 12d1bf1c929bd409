/* Error of a solution of the contact solver, and uniqueness of the solution. */
#pragma once

#include "contact/contact.h"

/* The matrix M of a problem (A, or W if A is NULL) by its inverse. */
typedef struct inverse_energy {
  void *ctx;
  /* *square = d' inv(M) d, d[m] */
  status (*square)(void *ctx, const double *d, double *square);
  double condition;       /* of M scaled to a unit diagonal, -; for the
                             rounding */
  const double *diagonal; /* [m] or NULL: the condition is that of a matrix with
                             this diagonal, whose inverse holds inv(M) */
  int n_kernel;           /* motions without energy: M is semidefinite */
  const double *kernel;   /* [m*n_kernel], borrowed */
  /* Compliance form: the same problem in stiffness form, borrowed, for the rate
   * of Coulomb friction; NULL: not known */
  const contact_problem *stiffness;
} inverse_energy;

typedef struct solver_error {
  double norm;     /* bound of |u - u*|_A (|r - r*|_W if A is NULL), square root
                      of an energy; NAN: there is none */
  double rate;     /* contraction of the sliding limit, -; 0: no Coulomb
                      friction */
  const char *why; /* NULL, or why there is no bound */
} solver_error;

/* Rates measured last, with their states of the unknowns, to avoid repeated
 * measurements. All zero: none. */
enum { KNOWN_RATES = 2 };
typedef struct known_rate {
  int m, n;
  signed char *state;       /* [m*KNOWN_RATES] owned; the last used one first */
  double rate[KNOWN_RATES]; /* [n] */
} known_rate;
/* A or B have changed: discard them. Accepts NULL. */
void known_rate_forget(known_rate *k);

/*
 * Bound of the distance of (u, r) from the solution (u*, r*) in the energy
 * norm (algebra.c). Given limit: guaranteed. Coulomb friction: by the
 * contraction rate measured at (u, r); none where the rate is 1 or more, or
 * where the stiffness is not known. Errors: ERR_MEMORY, those of inverse.
 * "known" (or NULL) is read and kept up to date.
 */
status solver_error_bound(const contact_problem *cp,
                          const inverse_energy *inverse, const double *u,
                          const double *r, known_rate *known,
                          solver_error *error);

/*
 * Contraction of the fixed point on the sliding limit (CPR98, 2.3) linearised
 * at (u, r), measured in the energy norm; 0 where nothing slides, HUGE_VAL if
 * nothing holds the sliding body. Stiffness form; known or NULL as above.
 * Errors: ERR_MEMORY.
 */
status contraction_rate(const contact_problem *cp, const double *u,
                        const double *r, known_rate *known, double *rate);

/*
 * The asymptotic contraction of the same map, *rate: that of a fixed point near
 * (u, r); at most contraction_rate, no bound.
 */
status contraction_limit(const contact_problem *cp, const double *u,
                         const double *r, double *rate);

/*
 * The contact linearised at (u, r): the states closed, stick and slip persist.
 * Friction of a sliding node acts along e and, in space, turns with its slip
 * by kappa (I - e e'), kappa = g/|slip|.
 */
typedef struct linear_states {
  const contact_problem *cp; /* borrowed */
  int n_free, n_slip, n_closed;
  int *free_id, *place;         /* [m] unknowns that can move; place among them,
                                   or -1 */
  unsigned char *closed, *slip; /* [n] */
  double *e;                    /* [m] direction of friction on slip */
  double *kappa;                /* [n] N/m */
  unsigned char *known;         /* known_rows of an operator */
  double *added;
} linear_states;
/* out: all-zero; rests as of contact_stops. ERR_MEMORY. */
status linear_states_new(const contact_problem *cp, const double *u,
                         const double *r, int rests, linear_states *out);
/* 1: no pivot of the factor[n_free^2] of a matrix of the free unknowns, by LU
 * or Cholesky, is rounding. */
int linear_is_regular(const linear_states *s, const double *factor,
                      int cholesky);
/* Entry of kappa (I - e e') of two tangents of one sliding node, N/m. */
double linear_turn(const linear_states *s, int a, int b);
/* The factor of the operator for these states; it keeps one, so again before
 * each use. ERR_MEMORY. */
status linear_set_rows(const linear_states *s, int *singular);

/*
 * Changes of the contact linearised at (u, r), its limit being given (cp->B is
 * not read). cp is borrowed.
 */
typedef struct linear_contact linear_contact;
/* *out is NULL if nothing holds the free unknowns. ERR_MEMORY. */
status linear_contact_new(const contact_problem *cp, const double *u,
                          const double *r, linear_contact **out);
/* du[m] of a change df[m] of the load, N. */
status linear_contact_move(linear_contact *c, const double *df, double *du);

/* inverse_energy of a dense matrix M[m*m] by its Cholesky factor, for problems
 * without another inverse. *out is new (memory_free), NULL if M is not
 * symmetric and positive semidefinite. */
typedef struct dense_inverse dense_inverse;
status dense_inverse_new(int m, const double *M, dense_inverse **out);
inverse_energy dense_inverse_energy(dense_inverse *d);
/* N[m*m] = inv(M); *done = 0: M is semidefinite. */
void dense_inverse_fill(dense_inverse *d, double *N, int *done);
/* v = inv(M) x; of a semidefinite M the v that leaves n_kernel unknowns at 0,
 * whose force then balances x. v[m] may be x. */
void dense_inverse_solve(dense_inverse *d, const double *x, double *v);

/* Admissible pair: displacement v, contact force q related by its laws. */
typedef struct pair {
  double *v, *q;         /* [m] m, N */
  double *d, *t;         /* [m] defect of the equation; workspace */
  double *rounding;      /* [m] what rounding can have put into d */
  unsigned char *slides; /* [n] |q_t| = g */
} pair;

status pair_new(int n, int m, pair *p);
/* v and q from a solution (u, r) by one step of the natural map; rounding. */
void pair_set(const contact_problem *cp, const double *u, const double *r,
              pair *p);

/*
 * Where the stiffness is singular: change q, on the nodes that are closed or
 * stick and with the limit that follows on those that slide, until d is in
 * equilibrium for the motions without energy. *done = 0: not possible with
 * admissible forces. Errors: ERR_MEMORY.
 */
status pair_balance(const contact_problem *cp, const inverse_energy *inverse,
                    pair *p, int *done);

/* Stiffness of a node along its normal and in its tangent plane, N/m. */
typedef struct node_stiffness {
  double n, t;
} node_stiffness;
node_stiffness accuracy_stiffness(const contact_problem *cp, int node_id);
/* 1: friction can act on the unknown: tangential, not held, no side bound. */
int accuracy_rubs(const contact_problem *cp, int dof);
