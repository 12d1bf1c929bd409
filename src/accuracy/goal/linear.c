/*
 * The linearised contact problem (linear.h): a matrix has a factor of M; with
 * an operator, S = A_FF + kappa (I - e e') is solved by its factor, and what
 * friction adds by GMRES (Saad, Schultz 1986) with S as preconditioner:
 *
 *   M  x = b:  (I + e B A_n inv(S)) v = b,  x = inv(S) v
 *   M' w = b:  (I + inv(S) A_Fn B' e) w = inv(S) b
 */
#include "accuracy/goal/linear.h"

#include "base/memory.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <string.h>

enum { DIRECTIONS = 80 };
static const double ENOUGH = 1e-13; /* -, of the right side, left by GMRES */

struct linear_system {
  linear_rows rows;
  double *M;            /* [n_free^2] its factor; NULL: an operator */
  lapack_int *pivot;    /* [n_free] */
  double *b, *Ax;       /* [m] workspace */
  double *v, *zero;     /* [m] of an operator */
  double *added;        /* [dim*m] known_rows.added */
  unsigned char *known; /* [m] */
  int bent;             /* 1: some friction follows pressure */
};

void linear_system_free(linear_system *s) {
  if (s == NULL) return;
  RELEASE(s->M, s->pivot, s->b, s->Ax, s->v, s->zero, s->added, s->known, s);
}

/* ---- rows of friction ---------------------------------------------------- */

void linear_add_friction(const linear_rows *rows, const double *v, double *y) {
  const contact_problem *cp = rows->cp;
  for (int i = 0; cp->B != NULL && i < cp->n; ++i) {
    double sum = 0.0;
    if (!rows->slip[i]) continue;
    for (int k = cp->B->start[i]; k < cp->B->start[i + 1]; ++k)
      if (rows->closed[cp->B->col[k]])
        sum += cp->B->val[k] * v[cp->B->col[k] * cp->dim];
    for (int t = i * cp->dim + 1; t < (i + 1) * cp->dim; ++t)
      if (rows->place[t] >= 0) y[t] += rows->e[t] * sum;
  }
}

void linear_spread_friction(const linear_rows *rows, double *w) {
  const contact_problem *cp = rows->cp;
  for (int i = 0; i < cp->n && cp->B != NULL; ++i) {
    double along = 0.0;
    if (!rows->slip[i]) continue;
    for (int t = i * cp->dim + 1; t < (i + 1) * cp->dim; ++t)
      if (rows->place[t] >= 0) along += rows->e[t] * w[t];
    for (int k = cp->B->start[i]; k < cp->B->start[i + 1]; ++k)
      if (rows->closed[cp->B->col[k]])
        w[cp->B->col[k] * cp->dim] += cp->B->val[k] * along;
  }
}

void linear_add_turn(const linear_rows *rows, const double *v, double *y) {
  const contact_problem *cp = rows->cp;
  for (int i = 0; cp->dim == 3 && i < cp->n; ++i) {
    const int t = 3 * i + 1;
    if (!rows->slip[i]) continue;
    for (int a = t; a < t + 2; ++a)
      for (int b = t; b < t + 2; ++b)
        if (rows->place[a] >= 0 && rows->place[b] >= 0)
          y[a] += rows->kappa[i] * ((a == b) - rows->e[a] * rows->e[b]) * v[b];
  }
}

/* ---- a matrix ------------------------------------------------------------ */

/* Row of M of a sliding unknown: e B A_n. */
static void add_slip(linear_system *s, int dof) {
  const linear_rows *rows = &s->rows;
  const contact_problem *cp = rows->cp;
  const int i = dof / cp->dim, n = rows->n_free;
  double *row = s->M + rows->place[dof];
  for (int k = cp->B == NULL ? 0 : cp->B->start[i];
       cp->B != NULL && k < cp->B->start[i + 1]; ++k) {
    const int j = cp->B->col[k];
    if (!rows->closed[j]) continue;
    const double *column =
        cp->A + (size_t)(j * cp->dim) * (size_t)cp->m; /* A is symmetric */
    for (int b = 0; b < n; ++b)
      row[(size_t)n * (size_t)b] +=
          rows->e[dof] * cp->B->val[k] * column[rows->free_id[b]];
  }
}

/* The columns of M of what a sliding unknown in space turns. */
static void add_turn(linear_system *s, int dof) {
  const linear_rows *rows = &s->rows;
  const size_t n = (size_t)rows->n_free;
  const int i = dof / 3;
  for (int t = 3 * i + 1; t < 3 * i + 3; ++t)
    if (rows->place[t] >= 0)
      s->M[(size_t)rows->place[dof] + n * (size_t)rows->place[t]] +=
          rows->kappa[i] * ((t == dof) - rows->e[dof] * rows->e[t]);
}

static status factor(linear_system *s, int *singular) {
  const linear_rows *rows = &s->rows;
  const contact_problem *cp = rows->cp;
  const size_t n = (size_t)rows->n_free;
  PASS_NEW(s->pivot, n);
  PASS_NEW(s->M, n * n);
  for (size_t b = 0; b < n; ++b) {
    const double *column = cp->A + (size_t)cp->m * (size_t)rows->free_id[b];
    for (size_t k = 0; k < n; ++k) s->M[k + n * b] = column[rows->free_id[k]];
  }
  for (int k = 0; k < rows->n_free; ++k) {
    const int dof = rows->free_id[k];
    if (dof % cp->dim == 0 || !rows->slip[dof / cp->dim]) continue;
    add_slip(s, dof);
    if (cp->dim == 3) add_turn(s, dof);
  }
  *singular =
      n > 0 && LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, rows->n_free, rows->n_free,
                                   s->M, rows->n_free, s->pivot) != 0;
  return OK;
}

static void solve_factored(linear_system *s, char how, const double *b,
                           double *x) {
  const linear_rows *rows = &s->rows;
  const int n = rows->n_free;
  for (int k = 0; k < n; ++k) s->b[k] = b[rows->free_id[k]];
  if (n > 0)
    LAPACKE_dgetrs_work(LAPACK_COL_MAJOR, how, n, 1, s->M, n, s->pivot, s->b,
                        n);
  for (int k = 0; k < n; ++k) x[rows->free_id[k]] = s->b[k];
}

/* ---- an operator --------------------------------------------------------- */

static status set_rows(linear_system *s, int *singular) {
  const linear_rows *rows = &s->rows;
  const contact_problem *cp = rows->cp;
  const known_rows known = {s->known, s->added};
  for (int k = 0; k < cp->m; ++k) s->known[k] = rows->place[k] < 0;
  for (int i = 0; cp->dim == 3 && i < cp->n; ++i)
    for (int a = 0; a < 2 && rows->slip[i]; ++a)
      for (int b = 0; b < 2; ++b) {
        const int t = 3 * i + 1;
        s->added[9 * i + 3 * (1 + a) + 1 + b] =
            rows->kappa[i] * ((a == b) - rows->e[t + a] * rows->e[t + b]);
      }
  return cp->op->set_rows(cp->op->ctx, &known, singular);
}

/* y = (I + e B A_n inv(S)) v, or (I + inv(S) A_Fn B' e) v. */
static void precondition(linear_system *s, int transposed, const double *v,
                         double *y) {
  const linear_rows *rows = &s->rows;
  const contact_operator *op = rows->cp->op;
  const size_t bytes = (size_t)rows->cp->m * sizeof *y;
  if (transposed) {
    memcpy(s->v, v, bytes);
    linear_spread_friction(rows, s->v);
    op->solve(op->ctx, s->zero, s->v, s->Ax);
    for (int k = 0; k < rows->cp->m; ++k)
      y[k] = rows->place[k] < 0 ? 0.0 : v[k] - s->v[k];
    return;
  }
  memset(s->v, 0, bytes);
  op->solve(op->ctx, v, s->v, s->Ax);
  memcpy(y, v, bytes);
  linear_add_friction(rows, s->Ax, y);
}

/* Column j of H[(DIRECTIONS+1)*] by w against the directions V, which becomes
 * the next one. */
static void orthogonalise(int m, int j, double *V, double *h) {
  double *w = V + (size_t)m * (size_t)(j + 1);
  for (int pass = 0; pass < 2; ++pass)
    for (int i = 0; i <= j; ++i) {
      const double *v = V + (size_t)m * (size_t)i;
      const double along = cblas_ddot(m, v, 1, w, 1);
      h[i] += along;
      cblas_daxpy(m, -along, v, 1, w, 1);
    }
  h[j + 1] = cblas_dnrm2(m, w, 1);
  if (h[j + 1] > 0.0) cblas_dscal(m, 1.0 / h[j + 1], w, 1);
}

/* The rotations c, s so far and one more on column h; returns what is left of
 * the right side g. */
static double rotate(int j, double *h, double *c, double *s, double *g) {
  for (int i = 0; i < j; ++i) cblas_drot(1, h + i, 1, h + i + 1, 1, c[i], s[i]);
  double a = h[j], b = h[j + 1];
  cblas_drotg(&a, &b, c + j, s + j);
  h[j] = a;
  h[j + 1] = g[j + 1] = 0.0;
  cblas_drot(1, g + j, 1, g + j + 1, 1, c[j], s[j]);
  return fabs(g[j + 1]);
}

/* x[m] of the preconditioned system by its right side x[m]. */
static status gmres(linear_system *s, int transposed, double *x) {
  const int m = s->rows.cp->m;
  const double size = cblas_dnrm2(m, x, 1);
  double H[DIRECTIONS * (DIRECTIONS + 1)] = {0.0};
  double c[DIRECTIONS], t[DIRECTIONS], g[DIRECTIONS + 1] = {size};
  double left = size, *h = H;
  OWNED double *V = NULL;
  int n = 0;
  if (!(size > 0.0)) return OK;
  PASS_NEW(V, (size_t)m * (DIRECTIONS + 1));
  for (int k = 0; k < m; ++k) V[k] = x[k] / size;
  for (; n < DIRECTIONS && left > ENOUGH * size; h += DIRECTIONS + 1) {
    double *v = V + (size_t)m * (size_t)n;
    precondition(s, transposed, v, v + m);
    orthogonalise(m, n, V, h);
    left = rotate(n, h, c, t, g);
    ++n;
  }
  cblas_dtrsv(CblasColMajor, CblasUpper, CblasNoTrans, CblasNonUnit, n, H,
              DIRECTIONS + 1, g, 1);
  cblas_dgemv(CblasColMajor, CblasNoTrans, m, n, 1.0, V, m, g, 1, 0.0, x, 1);
  return OK;
}

/* The free rows of b[m] less those of friction of the known x: by S, then by
 * GMRES. */
static status solve_operated(linear_system *s, const double *b, double *x) {
  const linear_rows *rows = &s->rows;
  const contact_operator *op = rows->cp->op;
  const size_t bytes = (size_t)rows->cp->m * sizeof *x;
  double *known = x;
  op->solve(op->ctx, b, known, s->Ax);
  if (!s->bent) return OK;
  memset(s->b, 0, bytes);
  linear_add_friction(rows, s->Ax, s->b);
  PASS(gmres(s, 0, s->b));
  memset(s->v, 0, bytes);
  op->solve(op->ctx, s->b, s->v, s->Ax);
  for (int k = 0; k < rows->cp->m; ++k)
    if (rows->place[k] >= 0) x[k] -= s->v[k];
  return OK;
}

static status transpose_operated(linear_system *s, const double *b, double *w) {
  const linear_rows *rows = &s->rows;
  const contact_operator *op = rows->cp->op;
  memset(w, 0, (size_t)rows->cp->m * sizeof *w);
  op->solve(op->ctx, b, w, s->Ax);
  return s->bent ? gmres(s, 1, w) : OK;
}

/* ---- both ---------------------------------------------------------------- */

static int is_bent(const linear_rows *rows) {
  for (int i = 0; rows->cp->B != NULL && i < rows->cp->n; ++i)
    if (rows->slip[i]) return 1;
  return 0;
}

status linear_system_new(const linear_rows *rows, linear_system **out) {
  status st = OK;
  const size_t m = (size_t)rows->cp->m;
  int singular = 0;
  linear_system *s = NULL;
  *out = NULL;
  NEW(s, 1);
  s->rows = *rows;
  s->bent = is_bent(rows);
  NEW_REALS(m, &s->b, &s->Ax);
  if (rows->cp->A != NULL) {
    TRY(factor(s, &singular));
  } else {
    NEW_REALS(m, &s->v, &s->zero);
    NEW(s->added, (size_t)rows->cp->dim * m);
    NEW(s->known, m);
    TRY(set_rows(s, &singular));
  }
  if (singular) goto done;
  *out = s;
  s = NULL;
done:
  linear_system_free(s);
  return st;
}

status linear_solve(linear_system *s, const double *b, double *x) {
  const linear_rows *rows = &s->rows;
  const int m = rows->cp->m;
  OWNED double *rest = NULL;
  if (s->M == NULL) return solve_operated(s, b, x);
  PASS_NEW(rest, m);
  for (int k = 0; k < m; ++k)
    if (rows->place[k] >= 0) x[k] = 0.0;
  contact_apply(rows->cp, x, s->Ax);
  for (int k = 0; k < m; ++k) s->Ax[k] = -s->Ax[k];
  cblas_daxpy(m, 1.0, b, 1, rest, 1);
  cblas_daxpy(m, 1.0, s->Ax, 1, rest, 1);
  linear_add_friction(rows, s->Ax, rest);
  solve_factored(s, 'N', rest, x);
  return OK;
}

status linear_solve_transposed(linear_system *s, const double *b, double *w) {
  memset(w, 0, (size_t)s->rows.cp->m * sizeof *w);
  if (s->M == NULL)
    PASS(transpose_operated(s, b, w));
  else
    solve_factored(s, 'T', b, w);
  linear_spread_friction(&s->rows, w);
  return OK;
}
