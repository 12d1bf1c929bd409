/*
 * The linear system of one step of Newton's method (newton.c): rows of the
 * unknowns that are free under a guess of the states, the others known.
 *
 *   known       du_i = 0 (the value is in u)
 *   free        A_i du = -(A u - f)_i
 *   slipping    (A_t + e B A_n) du + kappa (I - e e') du_t = b_t
 *
 * together M du = b. A factor is reused while that costs less than a new one:
 * with M0 the matrix factored and K the rows in which M differs, X = inv(M0)
 * E_K gives the step of M from a small system,
 *
 *   du = x0 + X z,   M0 x0 = b without K,   (M_K X) z = b_K - M_K x0,
 *
 * so a few changed states cost a few solves, from step to step and from one
 * problem on the same A to the next. Where that would cost more than a new
 * factor, a new factor is made: of M, or, with few slipping nodes, of the
 * symmetric matrix without their friction (Cholesky), friction being an update.
 */
#pragma once

#include "solver/solver.h"
#include "contact/force_set.h"

#include <stdint.h>

typedef enum { FREE, STICK, SLIP } tangent;

/* A guess of the states. */
typedef struct pattern {
  unsigned char *closed; /* [m] 1: normal or side bound active */
  unsigned char *mode;   /* [n] tangent */
  double *e;             /* [n*(dim-1)] direction of the friction force, - */
  double *kappa;         /* [n] turning stiffness, N/m */
  int *free_id, *place;  /* [m] free unknowns; their place, -1: known */
  int n_free;
} pattern;
/* kappa (I - e e') of a slipping node in space, entry (a, b). */
static inline double pattern_turning(const pattern *p, int node, int a, int b) {
  const double *e = p->e + 2 * node;
  return p->kappa[node] * ((a == b) - e[a] * e[b]);
}
status pattern_new(int dim, int n, pattern *p);

typedef struct newton_system newton_system;
status newton_system_new(const contact_problem *cp, newton_system **out);
/* Set the problem to be solved next, with the same A; borrowed. */
void newton_system_fit(newton_system *s, const contact_problem *cp);
/* A known value is put into u, then u is moved by the step of the guess p, of
 * which the free unknowns are listed; raw = A u - f. Returns 1 if the system is
 * singular (weak springs then held the body). */
int newton_system_step(newton_system *s, pattern *p, double *u, double *raw);
/* Unknowns, entries, solves of the last step. */
linear_work newton_system_work(const newton_system *s);
/* Save or read the factor and its exchanged rows. */
status newton_system_keep(newton_system *s, archive *a);
/* 1: the last step came from an updated factor, which is discarded for the
 * next. Accepts NULL. */
int newton_system_refresh(newton_system *s);

/* The known unknowns of the guess and the free ones are listed; du[m]: what
 * takes u to the known values. Returns how many it moves. */
int newton_list_known(const contact_problem *cp, pattern *p, const double *u,
                      double *du);
/* They are put into u. */
void newton_take_known(const contact_problem *cp, const pattern *p, double *u);
/* b[m], times power: minus the residual of each free row at the present u.
 * Returns the largest. */
double newton_load(const contact_problem *cp, const pattern *p, double power,
                   const double *u, const double *raw, double *b);
/* Slip of a node in the directions friction acts in, slip[2], m. */
void newton_slip(const contact_problem *cp, const double *u, int node_id,
                 double *slip);

/*
 * The guess of the states of a run of Newton's method: from the forces and
 * displacements of the last step, and enforced exactly in the forces
 * (newton.c).
 */
typedef struct states {
  const contact_problem *cp;
  pattern guess;
  double *u;        /* [m] of the caller, m */
  double *r;        /* [m] of the caller, N */
  double *raw;      /* [m] A u - f, N; compliance form: W r + q, m */
  double *k;        /* [m] stiffness of each unknown alone, N/m */
  double *c;        /* [n] mean of them in the tangent plane, N/m */
  double *g;        /* [n] sliding limits, N */
  double *rounding; /* [n] of the forces of each node, N */
  int careful;      /* one state changed at a time, the least index first */
  uint64_t dice;    /* not 0: each change is made or postponed at random */
} states;

/* Arrays for a matrix. */
status states_new(const contact_problem *cp, states *s);
/* r from raw with the conditions of the guess enforced exactly: no force where
 * open, |r_t| = g where slipping; compliance form: u from raw, no gap where
 * closed, no slip where stuck. */
void states_clean(const states *s);
/* The next guess from (u, r); returns the number of states that would change;
 * some may be postponed. fresh: there is no guess before. */
int states_next(states *s, int fresh);
/* Every node closed, every node with friction sticks. */
void states_all_stick(states *s);
/* Equal patterns have equal ones. */
uint64_t states_hash(const states *s);

/*
 * The linear system of one step of Newton's method (newton.c) where only the
 * compliance is known: the unknowns are the unknown forces of a guess of the
 * states, u = W r + q.
 *
 *   open    r_n = 0                      known
 *   closed  u_n = gap                    unknown r_n
 *   stick   u_t = ut0                    unknown r_t
 *   slip    r_t = g e + s d,  g = g0 - B r_n,  d normal to e
 *           d.(u_t - ut0) + s/kappa = 0  unknown s, in 3-D
 *
 * The system is the smaller, the fewer nodes are closed and the more slip. No
 * inverse of W is made; W may be unsymmetric.
 */
typedef struct compliance_system compliance_system;
status compliance_system_new(const contact_problem *cp,
                             compliance_system **out);
/* raw = W r + q */
void compliance_displace(const contact_problem *cp, const double *r,
                         double *raw);
/* r becomes the forces of the guess p, raw = W r + q. Returns 1 if the system
 * is singular: r and raw are then undefined. */
int compliance_system_step(compliance_system *s, const contact_problem *cp,
                           const pattern *p, double *r, double *raw);

/*
 * The linear system of one step of the methods of Newton's kind (system.h)
 * where the stiffness is an operator. The symmetric part of its matrix, without
 * the friction that follows pressure, is factored for the rows of the guess;
 * GMRES (Saad, Schultz 1986) preconditioned by it from the right adds the
 * friction, which has rows at the slipping nodes only.
 */

typedef struct operated_system operated_system;
status operated_system_new(const contact_problem *cp, operated_system **out);
/* No step before on the same rows. */
void operated_system_fit(operated_system *s);
/* newton_system_step. *singular 1: weak springs held the body. ERR_MEMORY. */
status operated_system_step(operated_system *s, const contact_problem *cp,
                            pattern *p, double *u, double *raw, int *singular);
/* du[m], Adu[m] = A du: the known rows of the guess p (place < 0) as du has
 * them, at the others
 *   (A + hold + kappa (I - e e') + e B A_n) du = b,
 * hold[m] on the diagonal (N/m; NULL: none), the next in slipping nodes alone,
 * A_n rows of closed unknowns. *singular 1: weak springs held the body.
 * ERR_MEMORY. */
typedef struct operated_rows {
  const pattern *p;
  const double *hold, *b;
} operated_rows;
status operated_system_direction(operated_system *s, const contact_problem *cp,
                                 const operated_rows *rows, double *du,
                                 double *Adu, int *singular);
/* newton_system_work. */
linear_work operated_system_work(const operated_system *s,
                                 const contact_problem *cp);
/* 1: raw of the last step is a sum over steps, not the reaction of u. Accepts
 * NULL. */
int operated_system_sums(const operated_system *s);
/* 1: another step on the same rows may mend the last, which was solved to a few
 * digits. Accepts NULL. */
int operated_system_refresh(operated_system *s);

/*
 * The matrix of a step of Newton's method on the forces (proximal.c), row by
 * row:
 *
 *   J_i = e_i                                         nothing acts on unknown i
 *   J_i = e_i - sum_j c_ij (e_j (1 - a) - D_j W_j) + ...            the others
 *
 * with rows W_j of the compliance. Unknowns of the first kind are eliminated;
 * what is left is sparse where W is, and then factored by UMFPACK, else by
 * LAPACK.
 */

typedef struct step_matrix step_matrix;
/* set: borrowed. */
status step_matrix_new(const contact_problem *cp, const force_set *set,
                       step_matrix **out);
/* A new matrix: acts[m], 0: row i is e_i; d[m] the right side, kept by the
 * caller until the solve. */
void step_matrix_begin(step_matrix *s, const unsigned char *acts,
                       const double *d);
/* Into the current row: value in column j; share times row j of W. */
void step_matrix_add(step_matrix *s, int j, double value);
void step_matrix_add_row(step_matrix *s, int j, double share);
/* It is row i (with acts[i], in ascending order); the next one is empty.
 * Errors: ERR_MEMORY. */
status step_matrix_put(step_matrix *s, int i);
/* d <- inv(J) d; *singular = 1: not found. Errors: ERR_MEMORY. */
status step_matrix_solve(step_matrix *s, double *d, int *singular);
