/* The matrix of a guess of the states, and its factor (parts.h). */
#include "newton/parts.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <string.h>

static const double SINGULAR_RCOND = 1e-13;
static const double SUSPECT = 0x1p-20; /* -, smallest over largest pivot      */
static const double SPRING = 0x1p-36;  /* -, of the diagonal                  */

/* In blocks, for the cache. */
int newton_is_symmetric(const newton_system *s) {
  size_t m = (size_t)s->m;
  const double *A = s->cp->A;
  double worst = 0.0;
  for (size_t j0 = 0; j0 < m; j0 += CHUNK)
    for (size_t i0 = 0; i0 <= j0; i0 += CHUNK)
      for (size_t j = j0; j < m && j < j0 + CHUNK; ++j)
        for (size_t i = i0; i < j && i < i0 + CHUNK; ++i)
          worst = fmax(worst, fabs(A[i + m * j] - A[j + m * i]));
  return worst * s->power <= 0x1p-41;
}

/* ---- the matrix ---------------------------------------------------------- */

/* 1: under the guess friction of the node follows pressure: M has no symmetry.
 */
static int couples(const newton_system *s, const pattern *p, int node_id) {
  const sparse_rows *B = s->cp->B;
  if (p->mode[node_id] != SLIP) return 0;
  for (int k = B == NULL ? 0 : B->start[node_id];
       B != NULL && k < B->start[node_id + 1]; ++k)
    if (B->val[k] != 0.0 && p->closed[B->col[k] * s->cp->dim]) return 1;
  return 0;
}

int newton_bends(const newton_system *s, const pattern *p, int node_id) {
  if (s->cp->dim == 3) return p->mode[node_id] == SLIP;
  return couples(s, p, node_id);
}

int newton_needs_lu(const newton_system *s, const pattern *p) {
  int full = !s->symmetric;
  for (int i = 0; i < s->cp->n && !full; ++i) full = couples(s, p, i);
  return full;
}

void newton_limit_rows(const newton_system *s, const pattern *p,
                       const double *column, double *to) {
  const sparse_rows *B = s->cp->B;
  int dim = s->cp->dim;
  for (int node_id = 0; B != NULL && node_id < s->cp->n; ++node_id) {
    if (p->mode[node_id] != SLIP) continue;
    double sum = 0.0;
    for (int k = B->start[node_id]; k < B->start[node_id + 1]; ++k)
      if (p->closed[B->col[k] * dim])
        sum += B->val[k] * column[B->col[k] * dim];
    for (int k = 0; k < dim - 1; ++k) {
      int i = p->place[node_id * dim + 1 + k];
      if (i >= 0) to[i] += s->power * p->e[node_id * (dim - 1) + k] * sum;
    }
  }
}

/* Entry (a, b) of kappa (I - e e') of a slipping node, times power. */
static double turning(const newton_system *s, const pattern *p, int node_id,
                      int a, int b) {
  const double *e = p->e + 2 * node_id;
  return s->power * p->kappa[node_id] * ((a == b ? 1.0 : 0.0) - e[a] * e[b]);
}

static void fill(newton_system *s, double spring) {
  const pattern *p = &s->base;
  size_t ld = (size_t)p->n_free, m = (size_t)s->m;
  for (size_t j = 0; j < ld; ++j) {
    const double *column = s->cp->A + m * (size_t)p->free_id[j];
    double *to = s->K + ld * j;
    for (size_t i = s->full ? 0 : j; i < ld; ++i)
      to[i] = s->power * column[p->free_id[i]];
    to[j] += spring * to[j];
    if (s->full) newton_limit_rows(s, p, column, to);
  }
  for (int node_id = 0; s->cp->dim == 3 && node_id < s->cp->n; ++node_id) {
    if (p->mode[node_id] != SLIP) continue;
    for (int a = 0; a < 2; ++a)
      for (int b = 0; b < 2; ++b) {
        int i = p->place[3 * node_id + 1 + a],
            j = p->place[3 * node_id + 1 + b];
        if (i >= 0 && j >= 0)
          s->K[(size_t)i + ld * (size_t)j] += turning(s, p, node_id, a, b);
      }
  }
}

void newton_row(const newton_system *s, const pattern *p, int dof, double *to) {
  const contact_problem *cp = s->cp;
  const sparse_rows *B = cp->B;
  int m = s->m, step = s->symmetric ? 1 : m, node_id = dof / cp->dim,
      tangents = cp->dim - 1, k = dof % cp->dim - 1;
  size_t stride = s->symmetric ? (size_t)m : 1u;
  memset(to, 0, (size_t)m * sizeof *to);
  cblas_daxpy(m, s->power, cp->A + stride * (size_t)dof, step, to, 1);
  if (k < 0 || p->mode[node_id] != SLIP) return;
  for (int j = B == NULL ? 0 : B->start[node_id];
       B != NULL && j < B->start[node_id + 1]; ++j) {
    int n = B->col[j] * cp->dim;
    double a = s->power * p->e[node_id * tangents + k] * B->val[j];
    if (p->closed[n])
      cblas_daxpy(m, a, cp->A + stride * (size_t)n, step, to, 1);
  }
  for (int a = 0; tangents == 2 && a < 2; ++a)
    to[node_id * 3 + 1 + a] += turning(s, p, node_id, k, a);
}

/* ---- new factor ---------------------------------------------------------- */

double newton_cost(int n, int full) {
  double size = n;
  return (full ? 2.0 : 1.0) / 3.0 * size * size * size + READ * size * size;
}

/* 1: the pivots leave doubt, and the condition says singular. */
static int is_singular(newton_system *s, double norm) {
  size_t n = (size_t)s->base.n_free;
  double least = HUGE_VAL, most = 0.0, rcond = 1.0;
  for (size_t i = 0; i < n; ++i) {
    double pivot = fabs(s->K[i + n * i]);
    least = fmin(least, pivot);
    most = fmax(most, pivot);
  }
  if (!s->full) {
    least *= least;
    most *= most;
  }
  if (least > SUSPECT * most) return 0;
  if (s->full)
    LAPACKE_dgecon_work(LAPACK_COL_MAJOR, '1', (int)n, s->K, (int)n, norm,
                        &rcond, s->work, s->iwork);
  else
    LAPACKE_dpocon_work(LAPACK_COL_MAJOR, 'L', (int)n, s->K, (int)n, norm,
                        &rcond, s->work, s->iwork);
  return !(rcond > SINGULAR_RCOND);
}

static double matrix_norm(newton_system *s) {
  int n = s->base.n_free;
  return s->full ? LAPACKE_dlange_work(LAPACK_COL_MAJOR, '1', n, n, s->K, n,
                                       s->work)
                 : LAPACKE_dlansy_work(LAPACK_COL_MAJOR, '1', 'L', n, s->K, n,
                                       s->work);
}

/* The condition is asked for only where the matrix can be singular without a
 * fault of the data. */
int newton_factor(newton_system *s) {
  int n = s->base.n_free, doubt = s->full || s->cp->floating;
  fill(s, 0.0);
  double norm = doubt ? matrix_norm(s) : 0.0;
  int info =
      s->full ? LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, n, n, s->K, n, s->pivot)
              : LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'L', n, s->K, n);
  return info == 0 && !(doubt && is_singular(s, norm));
}

void newton_back(const newton_system *s, int n_rhs, double *x) {
  int n = s->base.n_free;
  if (n == 0 || n_rhs == 0) return;
  if (s->full)
    LAPACKE_dgetrs_work(LAPACK_COL_MAJOR, 'N', n, n_rhs, s->K, n, s->pivot, x,
                        s->m);
  else
    LAPACKE_dpotrs_work(LAPACK_COL_MAJOR, 'L', n, n_rhs, s->K, n, x, s->m);
}

void newton_expand(const newton_system *s, double *x) {
  for (int dof = s->m - 1; dof >= 0; --dof) {
    int i = s->base.place[dof];
    x[dof] = i >= 0 ? x[i] : 0.0;
  }
}

void newton_plain_step(newton_system *s) {
  for (int i = 0; i < s->base.n_free; ++i) s->du[i] = s->b[s->base.free_id[i]];
  newton_back(s, 1, s->du);
  newton_expand(s, s->du);
}

void newton_begin(newton_system *s, const pattern *p, int full) {
  pattern_copy(s->cp->dim, s->cp->n, p, &s->base);
  s->full = full;
  s->spent = 0.0;
  s->n_column = 0;
  for (int i = 0; i < s->m; ++i) s->column[i] = -1;
}

void newton_spring_step(newton_system *s, const pattern *p) {
  int n = p->n_free;
  newton_begin(s, p, 1);
  fill(s, SPRING);
  LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, n, n, s->K, n, s->pivot);
  newton_plain_step(s);
  s->has_base = 0;
}
