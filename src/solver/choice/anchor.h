/*
 * A body that contact alone holds, for solvers that need the compliance.
 *
 * The null vectors R of its stiffness, orthonormal, are motions of the whole
 * body. Springs of stiffnesses k on them make a problem any solver takes,
 *
 *   A_s = A + R k R',   f_s = f + R k a,
 *
 * and the place a they are fixed at follows the body, a <- R'u, until they
 * carry nothing: R'(f + r) = k (R'u - a) = 0. These are the multipliers of the
 * equilibrium of the whole body (augmented Lagrangian; Dostal 2009, SMALBE),
 * and the proximal point iteration on its place (Rockafellar 1976): with a
 * given sliding limit it converges if there is an equilibrium. If there is none
 * the body drifts off for ever by the same step.
 */
#ifndef PROTIS_CHOICE_ANCHOR_H
#define PROTIS_CHOICE_ANCHOR_H

#include "solver/solver.h"

typedef struct anchor {
  int made;            /* 1: A_s is there */
  int missing;         /* 1: the null vectors could not be found */
  int m, n_mode;       /* unknowns of an operator; null vectors */
  double *R;           /* [m*n_mode] - */
  double *spring;      /* [n_mode] k, N/m */
  double *A, *W;       /* [m*m] A_s and its inverse, where A has entries */
  contact_operator op; /* A_s, where it is an operator, */
  const contact_operator *of; /* A, */
  double *y;                  /* [m] and its work */
  double *f;                  /* [m] f_s, N */
  double *a,
      *step; /* [n_mode] place of the springs, last move of the body, m */
} anchor;

/* The modes R only, of a problem with its stiffness, if they are not known. */
status anchor_modes(const contact_problem *cp, anchor *an);
/* Make it for the matrix of cp, unless it was tried before. */
status anchor_make(const contact_problem *cp, anchor *an);
void anchor_free(anchor *an); /* all zero afterwards */
/* Its matrix in the place of that of cp; 1: cp has it. */
void anchor_put(const anchor *an, contact_problem *cp);
int anchor_holds(const anchor *an, const contact_problem *cp);

/* Solves a problem with springs as given, from u, r. */
typedef struct anchored_solver {
  status (*solve)(void *ctx, const contact_problem *cp,
                  const solver_control *control, double *u, double *r,
                  solver_report *rep);
  void *ctx;
} anchored_solver;
/* Solve cp by passes of "inner" on problems with springs. rep: iterations of
 * all passes; STOPPED_RAY: the body drifts off. */
status anchor_solve(const anchor *an, const contact_problem *cp,
                    const anchored_solver *inner, const solver_control *control,
                    double *u, double *r, solver_report *rep);

#endif
