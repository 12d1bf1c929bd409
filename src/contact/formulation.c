/*
 * The velocity form of an increment (CPR98, problem N3, 3.38-3.39): the unknown
 * is the displacement du of the increment itself,
 *
 *   A du = R + r,  R = f - A u_old    residual of the last equilibrium under
 *                                     the new load
 *   du in K:       du_n <= gap - u_old_n
 *   |r_t| <= g, slip against du_t = d           d: step of the obstacle, else 0
 *
 * with the sliding limit g = g0 + B p of the total forces, as in N2. Solved in
 * these variables and added to u_old.
 */
#include "contact/formulation.h"

#include "base/base.h"

#include <cblas.h>
#include <lapacke.h>

/*
 * Given normal forces F at some nodes in the place of the unilateral conditions
 * (CPR98, 3.19-3.20, problem D3). There u_n is free and r_n = -F known, so that
 * these normals (g) are condensed out of the rest (c):
 *
 *   A' = A_cc - A_cg inv(A_gg) A_gc
 *   f' = f_c  - A_cg inv(A_gg) (f_g - F)
 *   u_g = inv(A_gg) (f_g - F - A_gc u_c)
 *
 * The rows of g stay in their places without any coupling, below a gap that
 * they do not reach. Friction there is against g0 + B p with p = F known.
 */

struct velocity_form {
  double *u_old;          /* [m] the last equilibrium, m */
  double *R;              /* [m] residual, N */
  double *gap, *side, *d; /* [n], [n*(dim-1)] twice: bounds and step of the
                             obstacle (of a held unknown: of its support), m */
  double *du;             /* [m] the unknown, m */
  double *rounding;       /* [n] of R, N */
};

status velocity_form_new(const contact_problem *cp, velocity_form **out) {
  int tangents = cp->n * (cp->dim - 1);
  MAKES(velocity_form, v, out);
  PASS_NEW_ALL(OF(v->u_old, cp->m), OF(v->R, cp->m), OF(v->gap, cp->n),
               OF(v->side, tangents), OF(v->d, tangents), OF(v->du, cp->m),
               OF(v->rounding, cp->n));
  return OK;
}

double *velocity_form_old(velocity_form *v) { return v->u_old; }

/* Its position of stick: zero, unless the obstacle or the support moves. */
static void set_stick(velocity_form *v, const contact_problem *cp) {
  for (int i = 0; i < cp->n; ++i)
    for (int a = 1; a < cp->dim; ++a) {
      int s = (cp->dim - 1) * i + a - 1;
      v->d[s] = cp->ut0[s] - v->u_old[cp->dim * i + a];
    }
}

void velocity_form_set(velocity_form *v, const contact_problem *cp,
                       const double *force, contact_problem *out, double **u) {
  contact_apply(cp, v->u_old, v->R);
  contact_roundings(cp, v->u_old, force, v->rounding);
  for (int k = 0; k < cp->m; ++k) {
    v->R[k] = cp->f[k] - v->R[k];
    if (fabs(v->R[k]) <= v->rounding[k / cp->dim]) v->R[k] = 0.0;
  }
  for (int i = 0; i < cp->n; ++i) {
    v->gap[i] = cp->gap[i] - v->u_old[cp->dim * i];
    for (int a = 1; a < cp->dim && cp->side_gap != NULL; ++a) {
      int s = (cp->dim - 1) * i + a - 1;
      v->side[s] = cp->side_gap[s] - v->u_old[cp->dim * i + a];
    }
  }
  if (cp->ut0 != NULL) set_stick(v, cp);
  for (int k = 0; k < cp->m; ++k) v->du[k] = (*u)[k] - v->u_old[k];
  *out = *cp;
  out->f = v->R;
  out->gap = v->gap;
  if (cp->ut0 != NULL) out->ut0 = v->d;
  if (cp->side_gap != NULL) out->side_gap = v->side;
  *u = v->du;
}

/* u_old + du; on a bound or at stick without the rounding of the sum. */
static double sum_of(const velocity_form *v, const contact_problem *cp, int i,
                     int a) {
  int s = (cp->dim - 1) * i + a - 1;
  double du = v->du[cp->dim * i + a], sum = v->u_old[cp->dim * i + a] + du;
  if (a == 0) return du == v->gap[i] ? cp->gap[i] : sum;
  if (cp->side_gap != NULL && du == v->side[s]) return cp->side_gap[s];
  if (cp->ut0 != NULL && du == v->d[s]) return cp->ut0[s];
  return sum;
}

void velocity_form_apply(const velocity_form *v, const contact_problem *cp,
                         double *u) {
  for (int i = 0; i < cp->n; ++i)
    for (int a = 0; a < cp->dim; ++a) u[cp->dim * i + a] = sum_of(v, cp, i, a);
}

static const double SINGULAR = 1e-12; /* -, pivot over diagonal: not held */

struct given_form {
  int n, m, dim;
  int *node;       /* [n] */
  double *A;       /* [m*m] A', diagonal in the rows of g */
  double *L;       /* [n*n] Cholesky factor of A_gg, lower */
  double *Y;       /* [n*m] inv(L) A_gc, zero in the columns of g */
  double *f, *gap; /* [m], [number of nodes] */
  double *met;     /* [number of nodes] gaps closed at g by the solution, m */
  double *y;       /* [n] inv(L) (f_g - F) */
  double *force;   /* [n] F, N */
  double *g0;      /* [number of nodes] N */
  double *mu;      /* entries of B without those of g; n_entry allocated */
  int n_entry;
  unsigned char *is; /* [number of nodes] 1: of g */
  sparse_rows B;     /* borrows start and col of the problem's */
};

static status new_arrays(const contact_problem *cp, given_form *g) {
  size_t n = g->n, m = cp->m;
  PASS_NEW_ALL(OF(g->node, n), OF(g->A, m * m), OF(g->L, n * n),
               OF(g->Y, n * m), OF(g->f, m), OF(g->gap, cp->n),
               OF(g->met, cp->n), OF(g->y, n), OF(g->force, n),
               OF(g->g0, cp->n), OF(g->is, cp->n));
  return OK;
}

static size_t normal(const given_form *g, int k) {
  return (size_t)g->dim * g->node[k];
}

/* L L' = A_gg */
static status factorise(const contact_problem *cp, given_form *g) {
  size_t n = g->n, m = cp->m;
  for (size_t j = 0; j < n; ++j)
    for (size_t i = 0; i < n; ++i)
      g->L[i + n * j] = cp->A[normal(g, (int)i) + m * normal(g, (int)j)];
  int info = LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'L', g->n, g->L, g->n);
  for (size_t i = 0; i < n && info == 0; ++i) {
    double pivot = g->L[i + n * i], whole = cp->A[normal(g, (int)i) * (m + 1)];
    if (!(pivot * pivot > SINGULAR * whole)) info = 1;
  }
  if (info != 0)
    RAISE(ERR_SINGULAR, "nothing holds the body against given normal forces");
  return OK;
}

/* Y = inv(L) A_gc and A' = A - Y'Y, diagonal in the rows of g. */
static void condense_normals(const contact_problem *cp, given_form *g) {
  size_t n = g->n, m = cp->m;
  for (size_t j = 0; j < m; ++j)
    for (size_t k = 0; k < n; ++k)
      g->Y[k + n * j] = cp->A[normal(g, (int)k) + m * j];
  for (size_t k = 0; k < n; ++k) CLEAR(g->Y + n * normal(g, (int)k), n);
  cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasNoTrans, CblasNonUnit,
              g->n, cp->m, 1.0, g->L, g->n, g->Y, g->n);
  COPY(g->A, cp->A, m * m);
  cblas_dsyrk(CblasColMajor, CblasLower, CblasTrans, cp->m, g->n, -1.0, g->Y,
              g->n, 1.0, g->A, cp->m);
  for (size_t k = 0; k < n; ++k) {
    size_t row = normal(g, (int)k);
    double own = cp->A[row * (m + 1)];
    for (size_t j = 0; j < m; ++j) g->A[row + m * j] = g->A[j + m * row] = 0.0;
    g->A[row * (m + 1)] = own;
  }
  for (size_t j = 0; j < m; ++j)
    for (size_t i = 0; i < j; ++i) g->A[i + m * j] = g->A[j + m * i];
}

status given_form_new(const contact_problem *cp, int n, const int *node,
                      given_form **out) {
  MAKES(given_form, g, out);
  g->n = n;
  g->m = cp->m;
  g->dim = cp->dim;
  PASS(new_arrays(cp, g));
  for (int k = 0; k < n; ++k) {
    g->node[k] = node[k];
    g->is[node[k]] = 1;
  }
  PASS(factorise(cp, g));
  condense_normals(cp, g);
  return OK;
}

/* g0 and B with the known pressures of B in g0; B NULL if none is left. */
static status set_limit(given_form *g, const contact_problem *cp,
                        contact_problem *out) {
  OWNS(g);
  const sparse_rows *B = cp->B;
  int left = 0;
  if (B == NULL) return OK;
  if (g->n_entry < B->start[cp->n]) {
    FORGET(g->mu);
    g->n_entry = B->start[cp->n];
    PASS_NEW(g->mu, g->n_entry);
  }
  /* The gaps are not in use yet: the array stores the forces by node. */
  CLEAR(g->gap, cp->n);
  for (int k = 0; k < g->n; ++k) g->gap[g->node[k]] = g->force[k];
  for (int i = 0; i < cp->n; ++i) {
    g->g0[i] = cp->g0[i];
    for (int e = B->start[i]; e < B->start[i + 1]; ++e) {
      int known = g->is[B->col[e]];
      if (known) g->g0[i] += B->val[e] * g->gap[B->col[e]];
      g->mu[e] = known ? 0.0 : B->val[e];
      left += g->mu[e] != 0.0;
    }
  }
  g->B = *B;
  g->B.val = g->mu;
  out->g0 = g->g0;
  out->B = left > 0 ? &g->B : NULL;
  return OK;
}

status given_form_set(given_form *g, const contact_problem *cp,
                      const double *force, double reach, double *u, double *r,
                      contact_problem *out) {
  *out = *cp;
  COPY(g->force, force, g->n);
  PASS(set_limit(g, cp, out));
  COPY(g->gap, cp->gap, cp->n);
  COPY(g->f, cp->f, cp->m);
  for (int k = 0; k < g->n; ++k) {
    size_t row = normal(g, k);
    g->y[k] = cp->f[row] - force[k];
    g->gap[g->node[k]] = reach;
    u[row] = r[row] = 0.0;
  }
  cblas_dtrsv(CblasColMajor, CblasLower, CblasNoTrans, CblasNonUnit, g->n, g->L,
              g->n, g->y, 1);
  cblas_dgemv(CblasColMajor, CblasTrans, g->n, cp->m, -1.0, g->Y, g->n, g->y, 1,
              1.0, g->f, 1);
  for (int k = 0; k < g->n; ++k) g->f[normal(g, k)] = 0.0;
  out->A = g->A;
  out->f = g->f;
  out->gap = g->gap;
  return OK;
}

/* u of the normals, inv(L') (y - Y u). */
static void put_normals(given_form *g, double *u) {
  cblas_dgemv(CblasColMajor, CblasNoTrans, g->n, g->m, -1.0, g->Y, g->n, u, 1,
              1.0, g->y, 1);
  cblas_dtrsv(CblasColMajor, CblasLower, CblasTrans, CblasNonUnit, g->n, g->L,
              g->n, g->y, 1);
  for (int k = 0; k < g->n; ++k) u[normal(g, k)] = g->y[k];
}

void given_form_move(given_form *g, double *u) {
  CLEAR(g->y, g->n);
  put_normals(g, u);
}

void given_form_apply(given_form *g, contact_problem *cp, double *u,
                      double *r) {
  put_normals(g, u);
  memmove(g->met, cp->gap, cp->n * sizeof *g->met);
  for (int k = 0; k < g->n; ++k) {
    g->met[g->node[k]] = g->y[k];
    r[normal(g, k)] = -g->force[k];
  }
  cp->gap = g->met;
}
