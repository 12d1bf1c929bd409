/*
 * Loops around a solver that change the sliding limit.
 *
 * Fixed point around a solver of Tresca problems (CPR98, 2.3):
 * g <- G(g) = g0 + B p, p the pressure forces of the solution with limit g. A
 * contraction for small friction; its rate is measured.
 *
 * Friction path around any solver: the problem with the limit share*(g0 + B p)
 * is followed from a small share to 1, each solution the start of the next. For
 * large friction, where a solver fails from a cold start.
 */
#pragma once

#include "solver/solver.h"

/* The solver inside a loop, set up for the matrix. */
typedef struct inner_solver {
  const solver_ops *ops;
  const void *par;
  void *work;
} inner_solver;

typedef struct fixed_point fixed_point;

status fixed_point_new(int n, fixed_point **out); /* for n contact nodes */
/*
 * Solve cp (with B) by passes of inner on problems without B. Passes:
 * control->limit_max_iter, 200 if 0; iterations of all passes: at most
 * control->max_iter. rep: iterations of all passes, passes, rate = |G(g_k) -
 * G(g_k-1)| / |g_k - g_k-1| of the last two passes. Where that is slow,
 * Anderson mixing speeds it up; a mixed step that raises |G(g) - g| is rejected
 * and a plain one made, and plain steps that raise it again and again are
 * shortened.
 */
status fixed_point_solve(fixed_point *fp, const contact_problem *cp,
                         const inner_solver *inner,
                         const solver_control *control, double *u, double *r,
                         solver_report *rep);

typedef struct friction_path friction_path;

status friction_path_new(const contact_problem *cp, friction_path **out);
/* u[m], r[m]: start of the first problem, then the solution. If a share cannot
 * be reached from the last one even by short steps, its outcome is returned,
 * with u and r of the last share solved. cp: as in friction_path_new but for
 * the values. control->max_iter bounds the iterations of all shares. */
status friction_path_solve(friction_path *path, const contact_problem *cp,
                           const inner_solver *inner,
                           const solver_control *control, double *u, double *r,
                           solver_report *rep);
