/*
 * Other forms of a problem, more suitable for a solver.
 *
 * The other form: stiffness from compliance, or the reverse, by an inverse that
 * is made once per matrix.
 *
 * The normal form of a problem without friction: the tangential unknowns, which
 * carry no force, are eliminated once per matrix,
 *   S = A_nn - A_nt inv(A_tt) A_tn,
 * and contact is solved in the n normal unknowns.
 */
#ifndef PROTIS_CHOICE_FORM_H
#define PROTIS_CHOICE_FORM_H

#include "solver/newton/dense.h"
#include "solver/solver.h"

/* Powers of two, one of them returned, that bring the diagonal of p S M S near
 * one, S = diag(scale[m]), but for what may be rounding of the largest; a
 * factor of M that is a power of two changes p alone. */
double form_scale(int m, const double *diagonal, double *scale);
/* M <- p S M S */
void form_apply_scale(int m, double power, const double *scale, double *M);
/* inv(M) in place of d->a = M[m*m], scaled so; *good 0: singular to rounding, M
 * is lost. */
status form_invert(int m, dense *d, int *good);

typedef struct other_form {
  double *matrix; /* [m*m] inverse of the one given, or NULL */
  double *load;   /* [m] load in that form */
  int missing;    /* 1: it does not exist */
} other_form;
/* Make it, unless it was tried before. */
status other_form_make(const contact_problem *cp, other_form *o);
void other_form_free(other_form *o); /* all zero afterwards */

typedef struct opened opened;

typedef struct normal_form {
  int missing;       /* 1: it does not exist */
  int wanted;        /* problems so far that would have used it */
  double power;      /* of two: power A has a diagonal of order 1 */
  double *L;         /* [nt*nt] Cholesky factor of power A_tt */
  double *Y;         /* [nt*n] inv(L) power A_tn */
  double *S;         /* [n*n] */
  double *f, *u, *r; /* [n] of the problem in S */
  opened *opened;    /* without S */
  double *y;         /* [m] work */
  void *work;        /* of the solver */
  archive *from;     /* borrowed: saved data for the workspace; or NULL */
  char group[80];    /* in it */
} normal_form;
/* Data saved from problem to problem; as contact_solver_keep. */
status normal_form_keep(normal_form *nf, archive *a);
/* 1: stiffness known, no friction, no second obstacle, nothing held, matrix
 * not singular. */
int normal_form_applies(const contact_problem *cp);
/* Solve from the closed state by the factor of the tangents. */
status normal_form_opened(normal_form *nf, const contact_problem *cp,
                          const solver_control *control, double *u, double *r,
                          solver_report *rep);
/* Solve by Newton's method from u[m], r[m]. rep as from a solver; RUNNING if
 * the form does not exist (u, r untouched). */
status normal_form_solve(normal_form *nf, const contact_problem *cp,
                         const solver_control *control, double *u, double *r,
                         solver_report *rep);
void normal_form_free(normal_form *nf); /* all zero afterwards */

#endif
