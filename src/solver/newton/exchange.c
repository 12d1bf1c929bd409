/* Rows exchanged in a kept factor (system.h, parts.h). */
#include "solver/newton/parts.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <string.h>

static const double DRIFT = 0x1p-3; /* -, change of a slip direction or turning
                                       stiffness the base bears (3-D)         */

/* 1: the node slips in another direction than in the base; in 3-D a small
 * change is borne. */
static int turned(const newton_system *s, const pattern *p, int dof) {
  int node_id = dof / s->cp->dim, tangents = s->cp->dim - 1;
  double change = 0.0, now = p->kappa[node_id], old = s->base.kappa[node_id];
  for (int k = node_id * tangents; k < (node_id + 1) * tangents; ++k)
    change = fmax(change, fabs(p->e[k] - s->base.e[k]));
  if (tangents == 1) return change != 0.0;
  double stiffness = s->cp->A[(size_t)dof * (size_t)s->m + (size_t)dof];
  return change > DRIFT || fabs(now - old) > DRIFT * (stiffness + old);
}

/* 1: the row of the unknown in the base is the one under the guess. */
static int same_row(const newton_system *s, const pattern *p, int dof) {
  const pattern *base = &s->base;
  const sparse_rows *B = s->cp->B;
  int node_id = dof / s->cp->dim;
  int free_now = p->place[dof] >= 0;
  if (free_now != (base->place[dof] >= 0)) return 0;
  if (!free_now || dof % s->cp->dim == 0) return 1;
  int now = newton_bends(s, p, node_id),
      before = newton_bends(s, base, node_id);
  if (!now || !before) return now == before;
  if (turned(s, p, dof)) return 0;
  for (int k = B == NULL ? 0 : B->start[node_id];
       B != NULL && k < B->start[node_id + 1]; ++k) {
    int n = B->col[k] * s->cp->dim;
    if (p->closed[n] != base->closed[n]) return 0;
  }
  return 1;
}

double newton_list_changes(newton_system *s, const pattern *p) {
  double fresh = 0.0, equations = 0.0, n = s->base.n_free, m = s->m;
  s->n_changed = 0;
  for (int dof = 0; dof < s->m; ++dof) {
    if (same_row(s, p, dof)) continue;
    s->changed[s->n_changed++] = dof;
    fresh += s->column[dof] < 0;
    equations += p->place[dof] >= 0;
  }
  double columns = s->n_column + fresh, k = s->n_changed;
  if (columns > s->room) return HUGE_VAL;
  return 2.0 * n * n * (fresh + 1.0 + READ) + 2.0 * m * equations * columns +
         2.0 / 3.0 * k * k * k;
}

/* Columns of X for the rows that have none. */
static void make_columns(newton_system *s) {
  size_t m = (size_t)s->m;
  const pattern *p = &s->base;
  int first = s->n_column;
  for (int a = 0; a < s->n_changed; ++a) {
    int dof = s->changed[a];
    if (s->column[dof] >= 0) continue;
    s->column[dof] = s->n_column++;
    double *x = s->X + m * (size_t)s->column[dof];
    memset(x, 0, m * sizeof *x);
    if (p->place[dof] >= 0) {
      x[p->place[dof]] = 1.0;
      continue;
    }
    const double *column = s->cp->A + m * (size_t)dof;
    for (int i = 0; i < p->n_free; ++i) x[i] = s->power * column[p->free_id[i]];
    if (s->K.full) newton_limit_rows(s, p, column, x);
    for (int i = 0; i < p->n_free; ++i) x[i] = -x[i];
  }
  newton_back(s, s->n_column - first, s->X + m * (size_t)first);
  for (int c = first; c < s->n_column; ++c)
    newton_expand(s, s->X + m * (size_t)c);
  for (int a = 0; a < s->n_changed; ++a) {
    int dof = s->changed[a];
    if (s->column[dof] >= first && p->place[dof] < 0)
      s->X[m * (size_t)s->column[dof] + (size_t)dof] = 1.0;
  }
}

/* Rows a .. a + n of the small system, all of them equations. id: places among
 * the changed. */
static void equation_rows(newton_system *s, const pattern *p, int n,
                          const int *id) {
  int k = s->n_changed;
  for (int i = 0; i < n; ++i)
    newton_row(s, p, s->changed[id[i]], s->rows + (size_t)i * (size_t)s->m);
  cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, n, s->n_column, s->m,
              1.0, s->rows, s->m, s->X, s->m, 0.0, s->product, CHUNK);
  for (int i = 0; i < n; ++i) {
    for (int b = 0; b < k; ++b)
      s->C[(size_t)id[i] + (size_t)k * (size_t)b] =
          s->product[i + CHUNK * s->column[s->changed[b]]];
    s->z[id[i]] =
        s->b[s->changed[id[i]]] -
        cblas_ddot(s->m, s->rows + (size_t)i * (size_t)s->m, 1, s->x, 1);
  }
}

/* The small system: matrix C, right side z. */
static void small_system(newton_system *s, const pattern *p) {
  int id[CHUNK], n = 0, k = s->n_changed;
  for (int a = 0; a < k; ++a) {
    int dof = s->changed[a];
    if (p->place[dof] >= 0) {
      id[n++] = a;
    } else {
      for (int b = 0; b < k; ++b)
        s->C[(size_t)a + (size_t)k * (size_t)b] =
            s->X[(size_t)s->m * (size_t)s->column[s->changed[b]] + (size_t)dof];
      s->z[a] = -s->x[dof];
    }
    if (n == CHUNK) {
      equation_rows(s, p, n, id);
      n = 0;
    }
  }
  if (n > 0) equation_rows(s, p, n, id);
}

int newton_exchange(newton_system *s, const pattern *p) {
  int k = s->n_changed;
  make_columns(s);
  memcpy(s->x, s->b, (size_t)s->m * sizeof *s->x);
  for (int a = 0; a < k; ++a) s->x[s->changed[a]] = 0.0;
  for (int i = 0; i < s->base.n_free; ++i) s->du[i] = s->x[s->base.free_id[i]];
  newton_back(s, 1, s->du);
  newton_expand(s, s->du);
  if (k == 0) return 1;
  memcpy(s->x, s->du, (size_t)s->m * sizeof *s->x);
  small_system(s, p);
  if (LAPACKE_dgesv_work(LAPACK_COL_MAJOR, k, 1, s->C, k, s->small_pivot, s->z,
                         k) != 0)
    return 0;
  memset(s->weight, 0, (size_t)s->n_column * sizeof *s->weight);
  for (int a = 0; a < k; ++a) s->weight[s->column[s->changed[a]]] = s->z[a];
  cblas_dgemv(CblasColMajor, CblasNoTrans, s->m, s->n_column, 1.0, s->X, s->m,
              s->weight, 1, 1.0, s->du, 1);
  for (int dof = 0; dof < s->m; ++dof)
    if (p->place[dof] < 0) s->du[dof] = 0.0;
  return 1;
}
