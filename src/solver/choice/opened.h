/*
 * Contact without friction from the state with every node closed.
 *
 * With v = u_n - gap and r0 the normal forces of the closed state, the normal
 * form (form.h) is S v = r - r0: v = 0 where closed, r = 0 where open. Only the
 * part S_EE of the nodes E that have been open is made, from columns inv(L)
 * A_tE that are kept while the matrix is unchanged; the forces of the others
 * follow from a product with A. Guess and correction as in NEWTON (primal-dual
 * active set).
 */
#ifndef PROTIS_CHOICE_OPENED_H
#define PROTIS_CHOICE_OPENED_H

#include "solver/solver.h"

/* A_tt = L L'/power, borrowed. */
typedef struct tangent_factor {
  const double *L; /* [nt*nt] */
  double power;    /* of two */
} tangent_factor;

typedef struct opened opened;
status opened_new(const contact_problem *cp, const tangent_factor *by,
                  opened **out);
void opened_free(opened *o); /* accepts NULL */
/* The columns made so far, saved or read. */
status opened_keep(opened *o, archive *a);
/* Solve from the states of u[m], r[m], both zero: all closed. rep->outcome
 * CONVERGED, or STOPPED_UNFIT: the guesses do not converge; u, r are then
 * unchanged. */
void opened_solve(opened *o, const contact_problem *cp,
                  const solver_control *control, double *u, double *r,
                  solver_report *rep);

#endif
