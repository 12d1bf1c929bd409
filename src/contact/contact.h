/*
 * The discrete contact problem on the condensed unknowns (CPR98, problems N1
 * and N2 reduced to Gamma_3), the structure that every solver works on.
 *
 *   A u = f + r,
 *   u_n <= gap,  r_n <= 0,  r_n (u_n - gap) = 0,            (unilateral)
 *   |r_t| <= g,  r_t = -g (u_t - ut0)/|u_t - ut0| on slip,   (friction)
 *   g = g0 + B p,  p = -r_n.                                 (sliding limit)
 *
 * Unknowns are node by node n, t1[, t2]; dense matrices are column major. With
 * g affine in p, Tresca (B = NULL), local (B diagonal) and nonlocal Coulomb
 * friction are one problem.
 */
#pragma once

#include "base/sparse.h"
#include "contact/operator.h"

/* Nodes that the matrix joins, through others too, are of one body. */
typedef struct body_size {
  double load;         /* largest load, N */
  double contact;      /* largest contact force, N */
  double rounding;     /* of it, the largest over the nodes, N */
  double displacement; /* largest of both over the stiffness of its node, m */
  double fallen;       /* largest c_n times the part of its gap that a node has
                          moved, N */
  double carried;      /* largest sqrt(k) |u|, or |r|/sqrt(k), sqrt(N m);
                          within reach */
  double reach;        /* the same of positions that follow from the data */
  double bent;         /* the same of u without rigid motions */
  double root;         /* largest sqrt(k), sqrt(N/m) */
  double position;     /* largest bound, or place of stick, m */
  double forces;       /* the larger of load and contact, N */
  double drift;        /* rounding of what is carried beyond reach, sqrt(N m) */
  double least;        /* scale of forces to come, or after a fall, N */
} body_size;
typedef struct contact_bodies {
  int n;
  int *of;               /* [nodes] body of each */
  body_size *size;       /* [n] workspace of the residual */
  double *bent;          /* [2*unknowns] the same */
  struct measured *node; /* [nodes] the same */
  const void **matrix;   /* [4] the same: what is in node follows from it */
} contact_bodies;

#define CONTACT_NO_LEVER 0x1p-44 /* -, of a motion: rounding */

typedef struct contact_problem {
  int dim, n, m; /* 2 or 3; contact nodes; m = dim*n unknowns */
  /* [m*m] condensed stiffness, N/m, symmetric, positive (semi)definite; NULL:
   * given as op, or only the compliance is known. */
  const double *A;
  const contact_operator *op; /* in the place of A, or NULL */
  /* [m*m] compliance, m/N; NULL until needed. Given alone (A, op NULL) it may
   * be semidefinite and slightly unsymmetric. */
  const double *W;
  /* The compliance in the place of W where most of it is zero, or NULL. */
  const sparse_blocks *blocks;
  const double *f;        /* [m] condensed load, N; with A NULL: q = W f, m */
  const double *f_load;   /* [m] f without the motion of supports, N; NULL: f */
  const double *gap;      /* [n] normal gap of the undeformed body, m */
  const double *ut0;      /* [n*(dim-1)] position of stick: tangential
                             displacement at increment start, plus the
                             obstacle's motion since, m; NULL: frictionless */
  const double *g0;       /* [n] sliding limit without pressure, N; NULL:
                             frictionless (then B and ut0 are NULL too) */
  const sparse_rows *B;   /* [n*n], -; NULL: g = g0 (Tresca); rows of mu */
  const double *side_gap; /* [n*(dim-1)] or NULL: bounds u_t from above where
                             the node touches a second (third) frictionless
                             obstacle, HUGE_VAL elsewhere; such nodes have g
                             = 0 */
  /* [m] or NULL: 1: a tangential unknown that is prescribed. Its row of A is
   * decoupled (A_ii u_i = f_i), friction acts in the other direction only */
  const unsigned char *held;
  /* NULL: not known; by contact_bodies_new */
  const contact_bodies *bodies;
  int floating;         /* A is singular: contact alone holds the body */
  int n_motion;         /* of its rigid motions; 0: not known */
  const double *motion; /* [m*n_motion] orthonormal, or NULL */
  double load;  /* N, final size of the loads: forces below its rounding are
                   zero (contact_scale); 0: not known */
  double moved; /* m, of the last equilibrium: a body that floats may be as
                   far from its place at time 0; 0: not known */
} contact_problem;

typedef enum { CONTACT_OPEN, CONTACT_SLIP, CONTACT_STICK } contact_status;

/* 1: the problem is in displacements, A u = f + r; 0: in forces. */
static inline int contact_has_stiffness(const contact_problem *cp) {
  return cp->A != NULL || cp->op != NULL;
}
/* A, or W where that alone is known; NULL if the stiffness is an operator. */
static inline const double *contact_matrix(const contact_problem *cp) {
  return contact_has_stiffness(cp) ? cp->A : cp->W;
}

/* The parts of a problem that its matrix couples weakly or not at all. */
status contact_bodies_new(const contact_problem *cp, contact_bodies **out);

/* y[m] = A x, or W x where that alone is known. */
void contact_apply(const contact_problem *cp, const double *x, double *y);
/* y[m] += A e x, or W e x, e the columns of a node, x[dim]. */
void contact_add_columns(const contact_problem *cp, int node_id,
                         const double *x, double *y);
/* A column of A or W. column[m] */
void contact_column(const contact_problem *cp, int dof, double *column);
/* The block of a node on the diagonal of A or W, block[dim*dim]. */
void contact_block(const contact_problem *cp, int node_id, double *block);
/* All of A or W into M[m*m]; of an operator by m products. */
void contact_dense(const contact_problem *cp, double *M);
/* r = A u - f, N. r[m]. Stiffness form only. */
void contact_reaction(const contact_problem *cp, const double *u, double *r);
/* g[n] = max(0, g0 + B p) of the normal forces r[m], N. */
void contact_limit(const contact_problem *cp, const double *r, double *g);
/* Forces r[m] of open nodes that are rounding become 0. */
void contact_drop_roundings(const contact_problem *cp, const double *u,
                            double *r);
/* Status of each node from u and r; a node without limit (g = 0) that touches
 * slips. status[n]. */
void contact_classify(const contact_problem *cp, const double *u,
                      const double *r, contact_status *status);
/* stopped[m]: 1: an unknown whose obstacle is met, or that sticks, as
 * contact_classify says of nodes; rests 0: a node at its limit slips, at rest
 * too. force[m] or NULL: r without the rounding of open nodes. */
void contact_stops(const contact_problem *cp, const double *u, const double *r,
                   int rests, double *force, unsigned char *stopped);
/*
 * Force scale of the problem, N (displacement scale, m, if A is NULL): an upper
 * estimate of the forces of its solution, from the data alone.
 *
 *   F = min over d of max(|f - A d|_max, 2^-14 (|f| + diag(A) |d|)_max)
 *
 * where d is one of two displacements the solution is measured from: stick
 * positions ut0 with the initial penetration taken back, d_n = min(gap, 0), or
 * with every gap closed, d_n = gap. If f = A d, u = d without any contact force
 * is a solution: a load that only carries the body along with its obstacle (f
 * and A u large, r small) does not make F large. The second term keeps F above
 * the rounding of the first; 2^-14 "load" is the least. Compliance form: D =
 * max(|q_t - ut0|, q_n - gap), at least 2^-14 |q|_max.
 */
double contact_scale(const contact_problem *cp);
/*
 * How far (u, r) is from a solution: the largest over the nodes of e/s, where e
 * is an error in N of
 *   normal      r_n - min(0, r_n - c (u_n - gap)),
 *   tangential  r_t - P_g(r_t - c (u_t - ut0)),  P_g projects on the disc
 *               |.| <= g,
 *   equation    A u - f - r,  or c (W r + q - u),
 * c = A_nn and the mean of the tangential diagonal of the node, or 1/W of them.
 * With F the largest load or projected force of the body the node belongs to,
 * and D the largest of those forces over k, k the larger c of its node,
 *   s = min(F, k D, contact_scale)
 * (c times contact_scale in the compliance form): the error is small against
 * the forces of the body, and the displacement it causes against those they
 * cause. A rigid motion of the body, in f, A u and c ut0, does not enter s; the
 * rounding of a row with such terms, 2^-47 of |f_i| + sqrt(k_i) max_j sqrt(k_j)
 * |u_j|, is subtracted from e. s is at least 2^-14 of cp->load, times the
 * forces of the body over those of the one with the largest, and of c times the
 * part of its gap that a node has moved: after a free fall through the gap
 * forces are below the rounding of A u. Loads of a body: f_load, in the
 * compliance form the force that holds a single node at its gap.
 *
 * Bodies are determined where cp->bodies is NULL; the functions below then take
 * all nodes as one.
 *
 * No unit: a change of units by factors 2^k leaves every bit. NaN if anything
 * is NaN; 0 for f = 0, gap >= 0, u = r = 0; HUGE_VAL if s is zero and (u, r) is
 * not a solution.
 */
double contact_residual(const contact_problem *cp, const double *u,
                        const double *r);
/* The same with a known contact_scale, which costs two products. */
double contact_residual_at(const contact_problem *cp, double scale,
                           const double *u, const double *r);
/* The same of an iterate whose defect of the equation is r - raw, raw[m] = A u
 * - f (u - raw, raw[m] = W r + q); raw NULL: zero. It costs no product. */
double contact_mismatch(const contact_problem *cp, double scale,
                        const double *u, const double *r, const double *raw);
/* Bound of the rounding of the forces of each node, N. rounding[n]. */
void contact_roundings(const contact_problem *cp, const double *u,
                       const double *r, double *rounding);
/* The same with what a residual of tol leaves. error[n]. */
void contact_errors(const contact_problem *cp, double tol, const double *u,
                    const double *r, double *error);
/* Residual of the natural map within these roundings, the largest over the
 * nodes, over F, the largest load or contact force of the body or own[n] (NULL:
 * none), N; of friction over the share of F that the limit of the node is of
 * its normal force, -. Bodies without load whose contact forces are rounding
 * are left out. */
double contact_hidden(const contact_problem *cp, const double *u,
                      const double *r, const double *own);
/* Single unknowns: 1 if prescribed; the bound from above (gap, or side_gap;
 * HUGE_VAL: none), m; the position of stick, m, of a tangential unknown. */
static inline int contact_held(const contact_problem *cp, int dof) {
  return cp->held != NULL && cp->held[dof];
}
static inline double contact_bound(const contact_problem *cp, int dof) {
  int node_id = dof / cp->dim, k = dof % cp->dim;
  if (k == 0) return cp->gap[node_id];
  if (cp->side_gap == NULL) return HUGE_VAL;
  return cp->side_gap[node_id * (cp->dim - 1) + k - 1];
}

static inline double contact_stick(const contact_problem *cp, int dof) {
  if (cp->ut0 == NULL) return 0.0;
  const int node_id = dof / cp->dim, k = dof % cp->dim;
  return k > 0 ? cp->ut0[node_id * (cp->dim - 1) + k - 1] : 0.0;
}
/* Slip |u_t - ut0| of a node along what is not held, m. */
double contact_slip_of(const contact_problem *cp, const double *u, int node_id);
/* 1: the node touches a second obstacle. */
static inline int contact_has_side(const contact_problem *cp, int node_id) {
  if (cp->side_gap == NULL) return 0;
  for (int k = 1; k < cp->dim; ++k)
    if (contact_bound(cp, node_id * cp->dim + k) < HUGE_VAL) return 1;
  return 0;
}
/* Diagonal of A (of an operator: of the stiffness it is condensed from), or of
 * W where that alone is known. */
double contact_diagonal(const contact_problem *cp, int dof);
/* Largest force that a motion v[m] would cause by one unknown alone, N, and so
 * much that "share" of it is not below the rounding of A v: a motion whose
 * forces are within that share is free. */
double contact_resistance(const contact_problem *cp, const double *v,
                          double share);
/* Its mean over the tangents of a node that are not held, or "none". */
double contact_tangent_diagonal(const contact_problem *cp, int node_id,
                                double none);
/* y = M x, M[m*m] column major. */
void contact_product(int m, const double *M, const double *x, double *y);
/* Sliding limit of one node, N. */
static inline double contact_node_limit(const contact_problem *cp,
                                        const double *r, int node_id) {
  if (cp->g0 == NULL) return 0.0;
  double g = cp->g0[node_id];
  if (cp->B != NULL)
    for (int k = cp->B->start[node_id]; k < cp->B->start[node_id + 1]; ++k) {
      double p = -r[(size_t)cp->B->col[k] * cp->dim];
      if (p > 0.0 || isnan(p)) g += cp->B->val[k] * p;
    }
  return g > 0.0 || isnan(g) ? g : 0.0;
}
