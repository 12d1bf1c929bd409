/* Forces freed in a kept factor (forces.h). */
#include "solver/newton/forces.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <string.h>

enum {
  READ = 8
}; /* solves whose arithmetic takes as long as reading the
      factor                                                 */

/* 1: the forces of a slipping node are unknowns of the base. */
static int slip_in_base(const compliance_system *s, int node_id) {
  int first = node_id * s->cp->dim;
  for (int k = 1; k < s->cp->dim; ++k)
    if (!contact_held(s->cp, first + k) && s->in_base[first + k] < 0) return 0;
  return 1;
}

static int base_has_all(const compliance_system *s) {
  for (int i = 0; i < s->n; ++i)
    if (!s->list[i].turns && s->in_base[s->list[i].dof] < 0) return 0;
  for (int i = 0; i < s->cp->n; ++i)
    if (s->p->mode[i] == SLIP && !slip_in_base(s, i)) return 0;
  return 1;
}

/* Mark the plain unknowns of the guess in y. */
static void mark(compliance_system *s) {
  memset(s->y, 0, (size_t)s->n_base * sizeof *s->y);
  for (int i = 0; i < s->n; ++i)
    if (!s->list[i].turns) s->y[s->in_base[s->list[i].dof]] = 1.0;
}

double freed_cost(compliance_system *s) {
  double fresh = 0.0, n = s->n_base;
  if (s->n_base == 0 || !base_has_all(s)) return HUGE_VAL;
  mark(s);
  s->n_freed = 0;
  for (int a = 0; a < s->n_base; ++a) {
    if (s->y[a] != 0.0) continue;
    if (s->n_freed == s->room) return HUGE_VAL;
    s->freed[s->n_freed++] = a;
    fresh += s->column[a] < 0;
  }
  double columns = s->n_column + fresh, k = s->n_freed;
  if (columns > s->room) return HUGE_VAL;
  return 2.0 * n * n * (fresh + 1.0 + READ) + 2.0 * n * columns +
         2.0 / 3.0 * k * k * k;
}

static void make_columns(compliance_system *s) {
  size_t n = (size_t)s->n_base;
  int first = s->n_column;
  for (int c = 0; c < s->n_freed; ++c) {
    int a = s->freed[c];
    if (s->column[a] >= 0) continue;
    s->column[a] = s->n_column++;
    double *x = s->X + n * (size_t)s->column[a];
    memset(x, 0, n * sizeof *x);
    x[a] = 1.0;
  }
  dense_solve(&s->K, s->n_column - first, s->X + n * (size_t)first, s->n_base);
}

/* Direction of friction at a slipping node, the first of its two rows in 3-D:
 * what the forces y miss of the limit. */
static double on_limit(const compliance_system *s, int node_id,
                       const double *y) {
  const sparse_rows *B = s->cp->B;
  int dim = s->cp->dim, first = node_id * dim + 1;
  double sum = 0.0;
  for (int k = 0; k < dim - 1; ++k)
    if (s->in_base[first + k] >= 0)
      sum += s->p->e[node_id * (dim - 1) + k] * y[s->in_base[first + k]];
  for (int k = B == NULL ? 0 : B->start[node_id];
       B != NULL && k < B->start[node_id + 1]; ++k)
    if (s->place[B->col[k]] >= 0)
      sum += B->val[k] * y[s->in_base[B->col[k] * dim]];
  return sum;
}

/* The second row: the force across over its stiffness. */
static double across(const compliance_system *s, int node_id, const double *y) {
  const unknown *d = &s->list[s->turn[node_id]];
  double sum = 0.0;
  for (int k = 0; k < 2; ++k) sum += d->d[k] * y[s->in_base[d->dof + k]];
  return sum * s->power / s->p->kappa[node_id];
}

/* What the row of a freed force takes of forces y. */
static double row_of(const compliance_system *s, int a, const double *y) {
  int dof = s->base[a], dim = s->cp->dim, node_id = dof / dim;
  if (dof % dim == 0 || s->p->mode[node_id] != SLIP) return y[a];
  if (s->turn[node_id] < 0 || dof % dim == 1) return on_limit(s, node_id, y);
  return across(s, node_id, y);
}

/* What it takes of the displacement of another freed one. */
static double displacement_part(const compliance_system *s, int a, int other) {
  int dof = s->base[a], node_id = dof / s->cp->dim;
  if (s->turn[node_id] < 0 || dof % 3 != 2) return 0.0;
  const unknown *d = &s->list[s->turn[node_id]];
  int k = s->base[other] - d->dof;
  return k == 0 || k == 1 ? d->d[k] : 0.0;
}

static void small_system(compliance_system *s) {
  size_t n = (size_t)s->n_base, k = (size_t)s->n_freed;
  for (size_t i = 0; i < k; ++i) {
    int a = s->freed[i], node_id = s->base[a] / s->cp->dim;
    int second = s->turn[node_id] >= 0 && s->base[a] % 3 == 2;
    for (size_t j = 0; j < k; ++j) {
      const double *X = s->X + n * (size_t)s->column[s->freed[j]];
      s->C[i + k * j] = row_of(s, a, X) + displacement_part(s, a, s->freed[j]);
    }
    s->z[i] = (second ? s->x[s->turn[node_id]] : 0.0) - row_of(s, a, s->y);
  }
}

int freed_solve(compliance_system *s) {
  int k = s->n_freed;
  make_columns(s);
  memset(s->y, 0, (size_t)s->n_base * sizeof *s->y);
  for (int i = 0; i < s->n; ++i)
    if (!s->list[i].turns) s->y[s->in_base[s->list[i].dof]] = s->x[i];
  dense_solve(&s->K, 1, s->y, s->n_base);
  if (k > 0) {
    small_system(s);
    if (LAPACKE_dgesv_work(LAPACK_COL_MAJOR, k, 1, s->C, k, s->pivot, s->z,
                           k) != 0)
      return 0;
    for (int c = 0; c < k; ++c)
      cblas_daxpy(s->n_base, s->z[c],
                  s->X + (size_t)s->n_base * (size_t)s->column[s->freed[c]], 1,
                  s->y, 1);
  }
  for (int i = 0; i < s->n; ++i) {
    const unknown *a = &s->list[i];
    s->x[i] = a->turns ? a->d[0] * s->y[s->in_base[a->dof]] +
                             a->d[1] * s->y[s->in_base[a->dof + 1]]
                       : s->y[s->in_base[a->dof]];
  }
  return 1;
}
