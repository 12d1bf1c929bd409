/* The matrix of a guess of the states, and its factor (parts.h). */
#include "solver/newton/parts.h"

#include <cblas.h>
#include <string.h>

static const double SPRING = 0x1p-36; /* -, of the diagonal                   */

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
    double *to = s->K.a + ld * j;
    for (size_t i = s->K.full ? 0 : j; i < ld; ++i)
      to[i] = s->power * column[p->free_id[i]];
    to[j] += spring * to[j];
    if (s->K.full) newton_limit_rows(s, p, column, to);
  }
  for (int node_id = 0; s->cp->dim == 3 && node_id < s->cp->n; ++node_id) {
    if (p->mode[node_id] != SLIP) continue;
    for (int a = 0; a < 2; ++a)
      for (int b = 0; b < 2; ++b) {
        int i = p->place[3 * node_id + 1 + a],
            j = p->place[3 * node_id + 1 + b];
        if (i >= 0 && j >= 0)
          s->K.a[(size_t)i + ld * (size_t)j] += turning(s, p, node_id, a, b);
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

/* The condition is asked for only where the matrix can be singular without a
 * fault of the data. */
int newton_factor(newton_system *s) {
  fill(s, 0.0);
  return dense_factor(&s->K, s->K.full || s->cp->floating);
}

void newton_back(const newton_system *s, int n_rhs, double *x) {
  dense_solve(&s->K, n_rhs, x, s->m);
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
  s->K.n = p->n_free;
  s->K.full = full;
  s->spent = 0.0;
  s->n_column = 0;
  for (int i = 0; i < s->m; ++i) s->column[i] = -1;
}

void newton_spring_step(newton_system *s, const pattern *p) {
  newton_begin(s, p, 1);
  fill(s, SPRING);
  dense_factor(&s->K, 0);
  newton_plain_step(s);
  s->has_base = 0;
}
