/* Least distance programming; Lawson, Hanson 1974, 23.4 (rest.h). */
#include "solver/choice/rest.h"

#include "solver/lcp/lcp_solve.h"

#include <cblas.h>
#include <lapacke.h>

static const double FREE = 0x1p-36; /* -, square of what moves with a motion */
static const double MARGIN = 0x1p-40;   /* -, of the gaps, and of the motion */
static const double BALANCED = 0x1p-30; /* -, of the work of the loads */
static const double REAL = 0x1p-10;     /* -, of the scale: never hidden */

typedef struct rest {
  const rest_scene *at;
  const contact_problem *cp;
  double *u;             /* [m] of the problem */
  const double *f;       /* [m] forces */
  int m, k;              /* unknowns; motions that no force opposes */
  unsigned char *forced; /* [m] 1: a force acts, or friction may */
  double *V;             /* [m*k] R_c */
  double *W;             /* [n_dof*k] R */
  double *L;             /* [k*k] Cholesky factor of W'W */
  double *q, *x;         /* [k] factors; x = L'(q - those without obstacles) */
} rest;

/* ---- motions that no force opposes --------------------------------------- */

static int body_of(const contact_problem *cp, int node) {
  return cp->bodies == NULL ? 0 : cp->bodies->of[node];
}

/* Forces are none that the rounding, or the tolerance of the solver, hides:
 * what that leaves at all nodes of a body may be held by the force of one. */
static status find_forced(rest *s) {
  const contact_problem *cp = s->cp;
  const double *before = s->at->before; /* the velocity form solves for less */
  const double most = fmax(1.0, REAL / s->at->tol);
  OWNED double *own = NULL, *load = NULL, *sum = NULL;
  PASS_NEW_REALS(cp->n, &own, &load, &sum); /* as many bodies, at most */
  PASS_NEW(s->forced, s->m);
  contact_errors(cp, s->at->tol, s->u, s->f, own);
  for (int i = 0; i < s->m && before != NULL; ++i) {
    double *largest = &load[body_of(cp, i / cp->dim)];
    *largest = fmax(*largest, fabs(before[i]));
  }
  for (int k = 0; k < cp->n; ++k) {
    own[k] = fmax(own[k], s->at->tol * load[body_of(cp, k)]);
    sum[body_of(cp, k)] += own[k];
  }
  for (int i = 0; i < s->m; ++i) {
    const int node = i / cp->dim;
    const int bounded = contact_bound(cp, i) < HUGE_VAL;
    const double noise = fmin(sum[body_of(cp, node)], most * own[node]);
    s->forced[i] =
        fabs(s->f[i]) > noise || (!bounded && cp->g0 != NULL &&
                                  contact_node_limit(cp, s->f, node) > noise);
  }
  return OK;
}

/* V = Q N, N the null vectors of the forced rows of Q[m*n]. */
static status find_motions(rest *s, const double *Q, int n) {
  OWNED double *M = NULL, *value = NULL;
  PASS_NEW_ALL(OF(M, n * n), OF(value, n));
  for (int i = 0; i < s->m; ++i)
    if (s->forced[i])
      cblas_dsyr(CblasColMajor, CblasLower, n, 1.0, Q + i, s->m, M, n);
  if (LAPACKE_dsyevd(LAPACK_COL_MAJOR, 'V', 'L', n, M, n, value) != 0)
    return OK;
  while (s->k < n && value[s->k] <= FREE) ++s->k;
  if (s->k == 0) return OK;
  PASS_NEW(s->V, s->m * s->k);
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, s->m, s->k, n, 1.0, Q,
              s->m, M, n, 0.0, s->V, s->m);
  return OK;
}

/* W: what u of all nodes is more where that of the contact is V more. */
static status find_fields(rest *s) {
  OWNED double *moved = NULL;
  const double most =
      fmax(largest_entry(s->m, s->u), largest_entry(s->at->n_dof, s->at->now));
  const double unit = 1.0 / power_to_one(most);
  PASS_NEW_ALL(OF(moved, s->m), OF(s->W, s->at->n_dof * s->k));
  for (int j = 0; j < s->k; ++j) {
    double *W = s->W + s->at->n_dof * j;
    COPY(moved, s->u, s->m);
    cblas_daxpy(s->m, unit, s->V + (size_t)s->m * j, 1, moved, 1);
    PASS(condense_recover(s->at->c, moved, W));
    for (size_t i = 0; i < s->at->n_dof; ++i)
      W[i] = (W[i] - s->at->now[i]) / unit;
  }
  return OK;
}

/* 1: the forces of the nodes do work on a motion. */
static int is_loaded(const rest *s) {
  const size_t n = s->at->n_dof;
  for (int j = 0; j < s->k; ++j) {
    const double *W = s->W + n * j, most = largest_entry(n, W);
    const size_t dim = s->cp->dim;
    double work = 0.0, load = 0.0;
    for (size_t i = 0; i < n; i += dim) { /* the nodes that move */
      if (!(largest_entry(dim, W + i) > BALANCED * most)) continue;
      work += cblas_ddot((int)dim, W + i, 1, s->at->F + i, 1);
      load += cblas_dasum((int)dim, s->at->F + i, 1);
    }
    if (fabs(work) > BALANCED * most * load) return 1;
  }
  return 0;
}

/* ---- the nearest place --------------------------------------------------- */

/* q without obstacles; 0: the motions are not independent. */
static int find_free(rest *s) {
  const int n = (int)s->at->n_dof, k = s->k;
  cblas_dsyrk(CblasColMajor, CblasLower, CblasTrans, k, n, 1.0, s->W, n, 0.0,
              s->L, k);
  for (int j = 0; j < k; ++j) {
    const double *W = s->W + s->at->n_dof * j;
    s->q[j] =
        cblas_ddot(n, W, 1, s->at->old, 1) - cblas_ddot(n, W, 1, s->at->now, 1);
  }
  if (LAPACKE_dpotrf(LAPACK_COL_MAJOR, 'L', k, s->L, k) != 0) return 0;
  return LAPACKE_dpotrs(LAPACK_COL_MAJOR, 'L', k, 1, s->L, k, s->q, k) == 0;
}

/* The bound of unknown i as a plane in the space of x: its normal side[k] of
 * length 1, and how far q leads beyond it, m; -HUGE_VAL: there is none, or no
 * motion moves the unknown. */
static double beyond(const rest *s, int i, double *side) {
  const double bound = contact_bound(s->cp, i);
  if (s->forced[i] || !(bound < HUGE_VAL)) return -HUGE_VAL;
  for (int j = 0; j < s->k; ++j) side[j] = -s->V[i + s->m * j];
  cblas_dtrsv(CblasColMajor, CblasLower, CblasNoTrans, CblasNonUnit, s->k, s->L,
              s->k, side, 1);
  const double lever = cblas_dnrm2(s->k, side, 1);
  if (!(lever > MARGIN)) return -HUGE_VAL;
  cblas_dscal(s->k, 1.0 / lever, side, 1);
  return (cblas_ddot(s->k, s->V + i, s->m, s->q, 1) -
          fmax(0.0, bound - s->u[i])) /
         lever;
}

/* The column that does the most work on the rest, into "next"; 0: none. */
static int next_column(const rest *s, double unit, const double *left,
                       double *side, double *next) {
  double most = 0.0;
  for (int i = 0; i < s->m; ++i) {
    /* What pushes back, and how far the bound is crossed, over "unit". */
    side[s->k] = beyond(s, i, side) / unit;
    if (!(side[s->k] > -HUGE_VAL)) continue;
    const double work = cblas_ddot(s->k + 1, side, 1, left, 1);
    if (!(work > MARGIN * cblas_dnrm2(s->k + 1, side, 1)) || work <= most)
      continue;
    most = work;
    COPY(next, side, (s->k + 1));
  }
  return most > 0.0;
}

/* q <- the nearest that no bound forbids. */
static status keep_out(rest *s) {
  nonnegative sum;
  double unit = 0.0;
  const int k = s->k;
  OWNED_NEW(double, side, k + 1);
  for (int i = 0; i < s->m; ++i) unit = fmax(unit, beyond(s, i, side));
  if (!(unit > 0.0)) return OK;
  PASS(nonnegative_new(k + 1, &sum));
  sum.b[k] = 1.0;
  nonnegative_begin(&sum);
  for (double *next; (next = nonnegative_next(&sum)) != NULL;)
    if (!next_column(s, unit, sum.rest, side, next) || !nonnegative_take(&sum))
      break;
  for (int j = 0; j < k; ++j) s->x[j] = -unit * sum.rest[j] / sum.rest[k];
  cblas_dtrsv(CblasColMajor, CblasLower, CblasTrans, CblasNonUnit, k, s->L, k,
              s->x, 1);
  for (int j = 0; j < k; ++j) s->q[j] += s->x[j];
  return OK;
}

status rest_find(const rest_scene *at, double *u, const double *f, int *moved) {
  SCRATCH;
  rest s = {.at = at, .cp = at->cp, .u = u, .f = f, .m = at->cp->m};
  const double *Q;
  const int n = condensed_motions(at->c, &Q);
  *moved = 0;
  if (n == 0) return OK;
  PASS(find_forced(&s));
  PASS(find_motions(&s, Q, n));
  if (s.k == 0) return OK;
  PASS(find_fields(&s));
  if (is_loaded(&s)) return OK;
  PASS_NEW_ALL(OF(s.L, s.k * s.k), OF(s.q, s.k), OF(s.x, s.k));
  if (!find_free(&s)) return OK;
  PASS(keep_out(&s));
  /* Moves the bodies; what touches then lies on the obstacle. */
  cblas_dgemv(CblasColMajor, CblasNoTrans, s.m, s.k, 1.0, s.V, s.m, s.q, 1, 1.0,
              s.u, 1);
  for (int i = 0; i < s.m; ++i)
    if (!s.forced[i]) s.u[i] = fmin(s.u[i], contact_bound(s.cp, i));
  *moved = 1;
  return OK;
}
