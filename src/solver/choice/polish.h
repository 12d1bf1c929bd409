/*
 * Final correction of a solution: pressed nodes lie on the obstacle, and, in
 * 3-D, friction is opposite to the slip.
 *
 * The residual measures forces: in a body soft in bending, as a strip of
 * slivers, nodes may penetrate far, compared with its displacements, at a
 * negligible force. Methods that approach the bounds leave them there.
 *
 * The residual bounds the errors of forces and displacements. Where a node has
 * slipped by little, s << |u|, an error d of u still turns the direction of its
 * slip by d/|s|, and friction is not opposite to it although both are exact to
 * the tolerance. Sweeps of relaxation solve each node exactly with the others
 * held, slip and friction opposed: one or two of them suffice on a solution.
 */
#ifndef PROTIS_CHOICE_POLISH_H
#define PROTIS_CHOICE_POLISH_H

#include "contact/contact.h"

/* Deviation of friction from the direction opposite to the slip: the largest
 * over the nodes of min(c |s|, |r_t + |r_t| s/|s||), s = u_t - ut0, c the
 * stiffness of the node, over contact_scale. -; 0 in the plane, where the
 * residual bounds it. */
double slip_misdirection(const contact_problem *cp, const double *u,
                         const double *r);
/*
 * Reduce it to tol, or as far as a few sweeps do, at most "most" if that is
 * less, while the residual stays at tol. u[m], r[m]: a solution with that
 * residual, unchanged where the sweeps do not improve it. *sweeps: number made.
 */
status polish_slip(const contact_problem *cp, double tol, int most, double *u,
                   double *r, int *sweeps);

/*
 * Move pressed and sticking nodes exactly to their bounds, if the residual
 * stays at tol; otherwise u[m], r[m] are unchanged. scale: contact_scale;
 * *residual: updated if the solution is changed.
 */
status polish_touch(const contact_problem *cp, double scale, double tol,
                    double *u, double *r, double *residual);

#endif
