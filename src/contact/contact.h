/*
 * The discrete contact problem on the condensed unknowns (CPR98, problems N1
 * and N2 reduced to Gamma_3), the one structure every solver works on.
 *
 *   A u = f + r,
 *   u_n <= gap,  r_n <= 0,  r_n (u_n - gap) = 0,            (unilateral)
 *   |r_t| <= g,  r_t = -g (u_t - ut0)/|u_t - ut0| on slip,   (friction)
 *   g = g0 + B p,  p = -r_n.                                 (sliding limit)
 *
 * Unknowns are node by node n, t1[, t2]; dense matrices are column major.
 * With g affine in p, Tresca (B = NULL), local (B diagonal) and nonlocal
 * Coulomb friction are one problem.
 */
#ifndef PROTIS_CONTACT_CONTACT_H
#define PROTIS_CONTACT_CONTACT_H

#include "base/sparse.h"
#include "base/status.h"

typedef struct contact_problem {
  int dim, n, m;     /* 2 or 3; contact nodes; m = dim*n unknowns           */
  const double *A;   /* [m*m] condensed stiffness, N/m, symmetric, positive
                        (semi)definite; NULL: only the compliance is known  */
  const double *W;   /* [m*m] compliance, m/N; NULL until asked for. Given
                        alone (A NULL) it may be semidefinite and slightly
                        unsymmetric                                         */
  const double *f;   /* [m] condensed load, N; with A NULL: q = W f, m      */
  const double *gap; /* [n] normal gap of the undeformed body, m            */
  const double *ut0; /* [n*(dim-1)] position of stick: tangential
                        displacement at increment start, plus the obstacle's
                        motion since, m; NULL: frictionless                 */
  const double *g0;  /* [n] sliding limit without pressure, N; NULL:
                        frictionless (then B and ut0 are NULL too)          */
  const sparse_rows *B; /* [n*n], -; NULL: g = g0 (Tresca); rows of mu        */
  const double *side_gap;    /* [n*(dim-1)] or NULL: bounds u_t from above where
                          the node touches a second (third) frictionless
                          obstacle, HUGE_VAL elsewhere; such nodes have g = 0 */
  const unsigned char *held; /* [m] or NULL: 1: a tangential unknown that is
                          prescribed. Its row of A is decoupled (A_ii u_i =
                          f_i), friction acts in the other direction only   */
  int floating; /* A is singular: contact alone holds the body         */
  double load;  /* N, what loads grow to: forces that are nothing beside their
                   rounding are nothing (contact_scale); 0: not known    */
} contact_problem;

typedef enum { CONTACT_OPEN, CONTACT_SLIP, CONTACT_STICK } contact_status;

/* r = A u - f, N. r[m]. Stiffness form only. */
void contact_reaction(const contact_problem *cp, const double *u, double *r);
/* g[n] = max(0, g0 + B p) of the normal forces r[m], N. */
void contact_limit(const contact_problem *cp, const double *r, double *g);
/* Status of each node from u and r; a node without limit (g = 0) that touches
 * slips. status[n]. */
void contact_classify(const contact_problem *cp, const double *u,
                      const double *r, contact_status *status);
/*
 * Force scale of the problem, N (displacement scale, m, if A is NULL): how
 * large the forces of its solution are to be expected, from the data alone.
 *
 *   F = min over d of max(|f - A d|_max, 2^-14 (|f| + diag(A) |d|)_max)
 *
 * where d is one of two displacements the solution is measured from: stick
 * positions ut0 with the initial penetration taken back, d_n = min(gap, 0), or
 * with every gap closed, d_n = gap. If f = A d, u = d without any contact force
 * is a solution: a load that only carries the body along with its obstacle
 * (f and A u large, r small) does not make F large. The second term keeps F
 * above the rounding of the first; 2^-14 "load" is the least.
 * Compliance form: D = max(|q_t - ut0|, q_n - gap), at least 2^-14 |q|_max.
 */
double contact_scale(const contact_problem *cp);
/*
 * The same at displacements u: at least 2^-14 of diag(A) times what the nodes
 * have gone of their gaps. A body that falls through a gap under next to no
 * load has forces that rounding of A u hides: they are right to that.
 */
double contact_scale_at(const contact_problem *cp, double scale,
                        const double *u);
/*
 * Largest part over the nodes of the natural map, N (m if A is NULL), without
 * the equation A u = f + r:
 *   normal      max(r_n, c (u_n - gap)),
 *   tangential  r_t - P_g(r_t - c (u_t - ut0)),  P_g projects on the disc
 * |.|<=g with c = A_nn, and the mean of the tangential diagonal of the node;
 * the compliance form takes c = 1/W and multiplies by W. NaN if anything is
 * NaN.
 */
double contact_mismatch(const contact_problem *cp, const double *u,
                        const double *r);
/*
 * How far (u, r) is from a solution: the larger of contact_mismatch and of
 * |A u - f - r|_max (|u - W r - q|_max), over contact_scale_at. No unit: a
 * change of units by factors 2^k leaves every bit. A residual of 1e-10 is an
 * error of the nodal forces of about 1e-10 of the largest. NaN if anything is
 * NaN; 0 for f = 0, gap >= 0, u = r = 0; HUGE_VAL if the scale is zero and (u,
 * r) is not a solution.
 */
double contact_residual(const contact_problem *cp, const double *u,
                        const double *r);
/* The same where contact_scale is known: it costs two products. */
double contact_residual_at(const contact_problem *cp, double scale,
                           const double *u, const double *r);
/* Single unknowns: 1 if prescribed; the bound from above (gap, or side_gap;
 * HUGE_VAL: none), m; the position of stick, m, of a tangential unknown. */
int contact_held(const contact_problem *cp, int dof);
double contact_bound(const contact_problem *cp, int dof);
double contact_stick(const contact_problem *cp, int dof);
/* 1: the node touches a second obstacle. */
int contact_has_side(const contact_problem *cp, int node_id);
/* y = M x, M[m*m] column major. */
void contact_product(int m, const double *M, const double *x, double *y);
/* Sliding limit of one node, N. */
double contact_node_limit(const contact_problem *cp, const double *r,
                          int node_id);

#endif
