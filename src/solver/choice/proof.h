/*
 * Proof that a contact problem has no solution: an inequality that is checked
 * after a method has failed. Without it the failure proves nothing.
 *
 * The direction of friction follows the slip, so that only what holds for all
 * forces within their limits is a proof. With
 *
 *   c_k = v_n,k + sum_i B_ik |v_t,i|,   h = sum_i g0_i |v_t,i|
 *
 * (at a second obstacle c = v of that unknown), all c <= 0, the contact forces
 * do at least -h on v: r'v >= -h.
 *
 * Stiffness:   A v = 0 and f'v > h. No forces balance the load, since
 *              f'v + r'v = u'A v = 0.
 * Compliance:  v = W'l, l >= 0 on the unknowns with a bound b and 0 else, and
 *              l'(q - b) > h. No forces keep the bodies out of their
 *              obstacles, since l'u = v'r + l'q > l'b.
 */
#ifndef PROTIS_CHOICE_PROOF_H
#define PROTIS_CHOICE_PROOF_H

#include "solver/choice/anchor.h"

/* 1: v[m] (l[m] of a compliance) is a proof; workspace[3*m]. */
int proof_holds(const contact_problem *cp, const double *v, double *workspace);

/*
 * Search for a proof. Stiffness: among the motions of the whole body, by the
 * forces nearest to balance, so that a proof is found if there is one, to
 * rounding. Compliance: by complementary pivoting without friction. an: modes
 * of the matrix, made if need be. Errors: ERR_MEMORY.
 */
status proof_find(const contact_problem *cp, anchor *an, int *proved);

#endif
