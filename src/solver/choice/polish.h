/*
 * Last touch of an answer: pressed nodes lie on the obstacle, and, in space,
 * friction points against the slip.
 *
 * The residual is of forces: of a body that is soft to bending, as a strip of
 * slivers, nodes may be far into the obstacle, measured by its displacements,
 * at no force to speak of. Methods that approach the bounds leave them there.
 *
 * The residual bounds the errors of forces and displacements. Where a node has
 * slipped by little, s << |u|, an error d of u still turns the direction of its
 * slip by d/|s|, and friction does not point against it although both are exact
 * to the tolerance. Sweeps of relaxation solve each node exactly with the
 * others held, slip and friction opposed: one or two of them suffice on an
 * answer.
 */
#ifndef PROTIS_CHOICE_POLISH_H
#define PROTIS_CHOICE_POLISH_H

#include "contact/contact.h"

/* How far friction is from pointing against the slip: the largest over the
 * nodes of min(c |s|, |r_t + |r_t| s/|s||), s = u_t - ut0, c the stiffness of
 * the node, over contact_scale. -; 0 in the plane, where the residual bounds
 * it. */
double slip_misdirection(const contact_problem *cp, const double *u,
                         const double *r);
/*
 * Bring it down to tol, or as far as a few sweeps do, at most "most" if that is
 * less, while the residual stays at tol. u[m], r[m]: an answer with that
 * residual, which stays where the sweeps do not better it. *sweeps: made.
 */
status polish_slip(const contact_problem *cp, double tol, int most, double *u,
                   double *r, int *sweeps);

/*
 * Put the nodes that are pressed or stick exactly where the obstacle has them,
 * if the residual stays at tol; u[m], r[m] are else left as they are. scale:
 * contact_scale; *residual: becomes that of the answer if it is changed.
 */
status polish_touch(const contact_problem *cp, double scale, double tol,
                    double *u, double *r, double *residual);

#endif
