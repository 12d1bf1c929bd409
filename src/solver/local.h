/*
 * The contact problem of one node with the others held: the exact projections
 * that the relaxation methods share.
 *
 *   K d = b + r,   x = at + d = (u_n - gap, u_t - ut0),
 *   x_n <= 0, r_n <= 0, x_n r_n = 0,
 *   |r_t| <= g, r_t = -g x_t/|x_t| on slip,   g = max(0, g0 - mu r_n),
 *
 * K symmetric positive definite. It is posed in the step d of the node: d and r
 * do not lose digits to a large distance to the gap or to the stick position.
 */
#pragma once

#include "solver/solver.h"

#include <stdint.h>

typedef struct local_problem {
  int dim;         /* 1, 2 or 3: unknowns, the normal one first */
  double K[9];     /* [dim*dim] N/m */
  double b[3];     /* [dim] less the force at d = 0, N */
  double at[3];    /* [dim] x at d = 0, m */
  double g0, mu;   /* sliding limit without pressure, N; its growth with -r_n */
  double bound[3]; /* [dim] upper bounds of x, m; bound[0] = 0; HUGE_VAL in a
                      tangent unless bounded = 1 */
  int bounded;     /* 1: a second obstacle; frictionless */
} local_problem;

typedef enum { LOCAL_OPEN, LOCAL_STICK, LOCAL_SLIP } local_state;

/*
 * Solve it; "before" is the state tried first (with large mu a node can have
 * several solutions). d[dim], r[dim] receive the solution, exact to rounding:
 * closed form in 2-D, one safeguarded root in 3-D (the disc, no facets).
 * Returns the state found. If no state fits (possible only by rounding, or for
 * mu beyond the local limit) the one with the least violation is returned.
 */
local_state local_solve(const local_problem *lp, local_state before, double *d,
                        double *r);

/*
 * Relaxation: the nodes visited in turn, each solved exactly with the others
 * held. Stiffness form: the unknown is u, r = A u - f is carried along with
 * the columns of A. Compliance form (A not known): the unknown is r, and
 * u = W r + q is carried along with the columns of W. Both see the same
 * problem of a node, K = A_ii or inv(W_ii), b = -r.
 */
typedef struct node_blocks node_blocks; /* what belongs to one matrix */
status node_blocks_new(const contact_problem *cp, node_blocks **out);

typedef struct relaxation {
  const contact_problem *cp;
  node_blocks *blocks;
  double *u, *r; /* [m] the iterate */
  double omega;  /* over-relaxation factor, - */
  double change; /* sum of K (du)^2 of the sweep, N m */
  int turned;    /* nodes whose state changed in the sweep */
} relaxation;

/* The patterns of states after the last sweeps. */
enum { PATTERNS = 64 };
typedef struct state_watch {
  uint64_t seen[PATTERNS]; /* a ring */
  int n;                   /* patterns seen */
} state_watch;
/* Record the pattern. 1: it occurred before, with another one in between. */
int state_watch_returns(state_watch *w, const relaxation *s);

/* State of each node at the start, from u and r. */
void relaxation_start(const relaxation *s);
/* Compute r = A u - f, or u = W r + q, again. */
void relaxation_refresh(const relaxation *s);
void relaxation_sweep(relaxation *s, int backward);
/* After a sweep from from[m] that turned no node: each body that contact alone
 * holds and that the load carries to its obstacles, or an obstacle to where it
 * sticks, by a small step a sweep is moved there at once, when the strain of
 * the step is rounding or its forces are no larger than the load. 2: one was
 * moved, and r is that of u; 1: one waits for that. */
int relaxation_fly(relaxation *s, const double *from);
/* After the last sweep: the best iterate into u and r, its residual and the
 * outcome, STOPPED_RAY where the sweeps stopped for a body that contact alone
 * holds and that drifts off. work[m]: work. */
void relaxation_end(relaxation *s, const best_iterate *best, double *work,
                    solver_report *rep);
