/*
 * The contact problem of a single node, in either form, solved directly: each
 * state is a linear system, slip in space one in its direction e,
 *
 *   P u + Q r = c,      P = A, Q = -I, c = f,  or  P = I, Q = -W, c = q,
 *   closed  u_t = ut0 + s e,  r_n = -p,  r_t = -(g0 + mu p) e
 *   open    u_t = ut0 + s e,  r_n = 0,   r_t = -g0 e
 *
 * three equations in (s, p) or (s, u_n): their determinant, a trigonometric
 * polynomial of degree 3, vanishes at the directions of slip. The matrix may be
 * semidefinite or unsymmetric, mu of any size.
 */
#pragma once

#include "contact/contact.h"

/*
 * cp->n = 1. Of the solutions to tol one with the status of the start (u, r)
 * comes back in u[m], r[m], the nearest in u (in r if the compliance is given),
 * else the nearest of all; its contact_residual in *residual. 0: none found, u
 * and r are as before.
 */
int single_solve(const contact_problem *cp, double scale, double tol, double *u,
                 double *r, double *residual);
