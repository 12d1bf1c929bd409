/*
 * Parts of contact_solve (solver/solver.h): one attempt with one solver in a
 * form it can use, and AUTO, the choice among them.
 */
#pragma once

#include "solver/fixed_point.h"
#include "solver/newton/dense.h"

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
  double *a, *step;  /* [n_mode] place of the springs, what the body moved from
                        them last, m */
  double *at, *move; /* [n_mode] last place of the body, its move there, m */
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

#define SOLVER_COUNT_ONE(name) +1
enum { N_SOLVER = 0 SOLVER_LIST(SOLVER_COUNT_ONE), LOG_SIZE = 1024 };

struct contact_solver {
  solver_choice choice;
  char log[LOG_SIZE];
  /* What belongs to one matrix. */
  contact_problem last;     /* whose matrix it is; borrowed, all-zero: none */
  void *work[N_SOLVER + 1]; /* of solver_list, last of a solver that is not in
                               it, never saved; NULL: not set up */
  void *param;              /* defaults of the current method of the chain */
  size_t param_size;
  fixed_point *fixed;
  friction_path *path;
  int path_capacity; /* entries of B allocated */
  other_form other;
  double *full;       /* [m*m] of the blocks, or NULL */
  int inverse_wanted; /* 1: the compliance alone did not suffice */
  anchor held;        /* springs for a body that contact alone holds */
  normal_form normal;
  contact_bodies *bodies;
  double *best_u, *best_r; /* [m] of the attempt with the lowest residual */
  double scale;            /* contact_scale of the problem being solved */
  const solver_listener *listener; /* of it; or NULL */
  int sought, proved;              /* a proof that it has no solution */
  archive *from;                   /* borrowed: saved data; or NULL */
  char group[80];                  /* in it */
};

/* WHILE_PROMISING: AUTO alone, sweeps whose rate is watched. */
typedef enum { PLAIN, ALONG_PATH, WHILE_PROMISING } drive;

/* A solver, its parameters, the loop around it. */
typedef struct attempt {
  const solver_ops *ops;
  const void *param;
  drive how;
  int max_iter;           /* 0: the solver's own limit */
  sweep_promise *promise; /* of sweeps; or NULL */
} attempt;

/* Save or read the data of the workspace of a row of solver_list. */
status attempt_archive(const contact_solver *s, int row, archive *a);
/* One attempt with one solver. STOPPED_UNFIT: it cannot treat the problem, the
 * log says why. rep->outcome and residual are those of the solver. */
status attempt_run(contact_solver *s, const contact_problem *cp,
                   const attempt *a, double *u, double *r, solver_report *rep);
/* The final outcome: only the residual of the given problem counts. */
void attempt_check(const contact_solver *s, const contact_problem *cp,
                   const double *u, const double *r, solver_report *rep);
/* After a failure: STOPPED_RAY if it is proved that there is no solution
 * (proof.c), and only then; of a large sparse compliance none is sought. */
status attempt_prove(contact_solver *s, const contact_problem *cp,
                     solver_report *rep);
/* Cold start: stick, no penetration; r = A u - f. */
void cold_start(const contact_problem *cp, double *u, double *r);

enum { MOST_FULL = 5000 }; /* m of a sparse compliance of which all is made */
static inline int is_large_sparse(const contact_problem *cp) {
  return cp->blocks != NULL && cp->m > MOST_FULL;
}

/* METHOD=AUTO (auto.c), as contact_solve. */
status auto_solve(contact_solver *s, const contact_problem *cp, double *u,
                  double *r, solver_report *rep);

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

/* 1: v[m] (l[m] of a compliance) is a proof; workspace[3*m]. */
int proof_holds(const contact_problem *cp, const double *v, double *workspace);

/*
 * Search for a proof. Stiffness: among the motions of the whole body, by the
 * forces nearest to balance, so that a proof is found if there is one, to
 * rounding. Compliance: by complementary pivoting without friction. an: modes
 * of the matrix, made if need be. Errors: ERR_MEMORY.
 */
status proof_find(const contact_problem *cp, anchor *an, int *proved);

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
