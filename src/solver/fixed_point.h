/*
 * Fixed point on the sliding limit around a solver of Tresca problems
 * (CPR98, 2.3): g <- G(g) = g0 + B p, p the pressure forces of the solution
 * with limit g. A contraction for small friction; its rate is measured.
 */
#ifndef PROTIS_SOLVER_FIXED_POINT_H
#define PROTIS_SOLVER_FIXED_POINT_H

#include "solver/solver.h"

typedef struct fixed_point fixed_point;

status fixed_point_new(int n, fixed_point **out); /* for n contact nodes     */
void fixed_point_free(fixed_point *fp);           /* accepts NULL            */
/*
 * Solve cp (with B) by passes of "inner" on problems without B. Passes:
 * control->limit_max_iter, 200 if 0. rep: iterations of all passes, passes,
 * rate = largest |G(g_k) - G(g_k-1)| / |g_k - g_k-1| of the last passes.
 * Anderson mixing speeds it up; a mixed step that does not lower the residual
 * is taken back and a plain, then a shorter one made.
 */
status fixed_point_solve(fixed_point *fp, const contact_problem *cp,
                         const solver_ops *inner, const void *par, void *work,
                         const solver_control *control, double *u, double *r,
                         solver_report *rep);

#endif
