/*
 * The adjoint of a contact problem at its solution (goal.h), by the linear
 * system of the problem linearised there, and its transpose:
 *
 *   M = A_FF + e B A_nF + kappa (I - e e')   (the last two on slip)
 *
 * on the free unknowns F, e the direction of the friction force. A matrix has a
 * factor of M; with an operator, S = A_FF + kappa (I - e e') is solved by its
 * factor, friction by GMRES (Saad, Schultz 1986) with S as preconditioner:
 *
 *   M  x = b:  (I + e B A_n inv(S)) v = b,  x = inv(S) v
 *   M' w = b:  (I + inv(S) A_Fn B' e) w = inv(S) b
 */
#include "accuracy/goal/goal.h"

#include "accuracy/accuracy.h"
#include "solver/newton/dense.h"

#include <cblas.h>
#include <lapacke.h>

enum { DIRECTIONS = 80 };
static const double ENOUGH = 1e-13; /* -, of the right side, left by GMRES */

typedef struct linear_system {
  const linear_states *rows; /* borrowed */
  double *M;                 /* [n_free^2] its factor; NULL: an operator */
  lapack_int *pivot;         /* [n_free] */
  double *b, *Ax;            /* [m] workspace */
  double *v, *zero;          /* [m] of an operator */
  int bent;                  /* 1: some friction follows pressure */
} linear_system;

/* ---- rows of friction ---------------------------------------------------- */

/* y[m] += e B v_n of the closed normals of v[m], at the sliding unknowns. */
static void linear_add_friction(const linear_states *rows, const double *v,
                                double *y) {
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

/* w_n += B' (e.w_t) on the closed normals of w[m], of its sliding unknowns. */
static void linear_spread_friction(const linear_states *rows, double *w) {
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

/* y[m] += kappa (I - e e') v at the sliding unknowns, in space. */
static void linear_add_turn(const linear_states *rows, const double *v,
                            double *y) {
  const contact_problem *cp = rows->cp;
  for (int i = 0; cp->dim == 3 && i < cp->n; ++i) {
    const int t = 3 * i + 1;
    if (!rows->slip[i]) continue;
    for (int a = t; a < t + 2; ++a)
      for (int b = t; b < t + 2; ++b)
        if (rows->place[a] >= 0 && rows->place[b] >= 0)
          y[a] += linear_turn(rows, a, b) * v[b];
  }
}

/* ---- a matrix ------------------------------------------------------------ */

/* Row of M of a sliding unknown: e B A_n. */
static void add_slip(linear_system *s, int dof) {
  const linear_states *rows = s->rows;
  const contact_problem *cp = rows->cp;
  const int i = dof / cp->dim, n = rows->n_free;
  double *row = s->M + rows->place[dof];
  for (int k = row_begin(cp->B, i); k < row_end(cp->B, i); ++k) {
    const int j = cp->B->col[k];
    if (!rows->closed[j]) continue;
    const double *column =
        cp->A + (size_t)(j * cp->dim) * cp->m; /* A is symmetric */
    for (int b = 0; b < n; ++b)
      row[(size_t)n * b] +=
          rows->e[dof] * cp->B->val[k] * column[rows->free_id[b]];
  }
}

static status factor(linear_system *s, int *singular) {
  const linear_states *rows = s->rows;
  const contact_problem *cp = rows->cp;
  const size_t n = rows->n_free;
  PASS_NEW_ALL(OF(s->pivot, n), OF(s->M, n * n));
  for (size_t b = 0; b < n; ++b) {
    const double *column = cp->A + (size_t)cp->m * rows->free_id[b];
    for (size_t k = 0; k < n; ++k) s->M[k + n * b] = column[rows->free_id[k]];
  }
  for (int k = 0; k < rows->n_free; ++k) {
    const int dof = rows->free_id[k];
    if (dof % cp->dim == 0 || !rows->slip[dof / cp->dim]) continue;
    add_slip(s, dof);
    if (cp->dim == 3) {
      /* The columns of M of what a sliding unknown in space turns. */
      const int i = dof / 3;
      for (int t = 3 * i + 1; t < 3 * i + 3; ++t)
        if (rows->place[t] >= 0)
          s->M[rows->place[dof] + n * rows->place[t]] +=
              linear_turn(rows, dof, t);
    }
  }
  if (n > 0)
    LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, rows->n_free, rows->n_free, s->M,
                        rows->n_free, s->pivot);
  *singular = !linear_is_regular(rows, s->M, 0);
  return OK;
}

static void solve_factored(linear_system *s, char how, const double *b,
                           double *x) {
  const linear_states *rows = s->rows;
  const int n = rows->n_free;
  for (int k = 0; k < n; ++k) s->b[k] = b[rows->free_id[k]];
  if (n > 0)
    LAPACKE_dgetrs_work(LAPACK_COL_MAJOR, how, n, 1, s->M, n, s->pivot, s->b,
                        n);
  for (int k = 0; k < n; ++k) x[rows->free_id[k]] = s->b[k];
}

/* ---- an operator --------------------------------------------------------- */

/* y = (I + e B A_n inv(S)) v, or (I + inv(S) A_Fn B' e) v. */
static void precondition(linear_system *s, int transposed, const double *v,
                         double *y) {
  const linear_states *rows = s->rows;
  const contact_operator *op = rows->cp->op;
  if (transposed) {
    COPY(s->v, v, rows->cp->m);
    linear_spread_friction(rows, s->v);
    op->solve(op->ctx, s->zero, s->v, s->Ax);
    for (int k = 0; k < rows->cp->m; ++k)
      y[k] = rows->place[k] < 0 ? 0.0 : v[k] - s->v[k];
    return;
  }
  CLEAR(s->v, rows->cp->m);
  op->solve(op->ctx, v, s->v, s->Ax);
  COPY(y, v, rows->cp->m);
  linear_add_friction(rows, s->Ax, y);
}

/* Column j of H[(DIRECTIONS+1)*] by w against the directions V, which becomes
 * the next one. */
static void orthogonalise(int m, int j, double *V, double *h) {
  double *w = V + (size_t)m * (j + 1);
  for (int pass = 0; pass < 2; ++pass)
    for (int i = 0; i <= j; ++i) {
      const double *v = V + (size_t)m * i;
      const double along = cblas_ddot(m, v, 1, w, 1);
      h[i] += along;
      cblas_daxpy(m, -along, v, 1, w, 1);
    }
  h[j + 1] = cblas_dnrm2(m, w, 1);
  if (h[j + 1] > 0.0) cblas_dscal(m, 1.0 / h[j + 1], w, 1);
}

/* x[m] of the preconditioned system by its right side x[m]. */
static status gmres(linear_system *s, int transposed, double *x) {
  const int m = s->rows->cp->m;
  const double size = cblas_dnrm2(m, x, 1);
  double H[DIRECTIONS * (DIRECTIONS + 1)] = {0.0};
  double c[DIRECTIONS], t[DIRECTIONS], g[DIRECTIONS + 1] = {size};
  double left = size, *h = H;
  int n = 0;
  if (!(size > 0.0)) return OK;
  OWNED_NEW(double, V, ((size_t)m * (DIRECTIONS + 1)));
  for (int k = 0; k < m; ++k) V[k] = x[k] / size;
  for (; n < DIRECTIONS && left > ENOUGH * size; h += DIRECTIONS + 1) {
    double *v = V + (size_t)m * n;
    precondition(s, transposed, v, v + m);
    orthogonalise(m, n, V, h);
    left = dense_rotate(n, h, c, t, g);
    ++n;
  }
  cblas_dtrsv(CblasColMajor, CblasUpper, CblasNoTrans, CblasNonUnit, n, H,
              DIRECTIONS + 1, g, 1);
  cblas_dgemv(CblasColMajor, CblasNoTrans, m, n, 1.0, V, m, g, 1, 0.0, x, 1);
  return OK;
}

/* The free rows of b[m] less friction of the known x: by S, then GMRES. */
static status solve_operated(linear_system *s, const double *b, double *x) {
  const linear_states *rows = s->rows;
  const contact_operator *op = rows->cp->op;
  double *known = x;
  op->solve(op->ctx, b, known, s->Ax);
  if (!s->bent) return OK;
  CLEAR(s->b, rows->cp->m);
  linear_add_friction(rows, s->Ax, s->b);
  PASS(gmres(s, 0, s->b));
  CLEAR(s->v, rows->cp->m);
  op->solve(op->ctx, s->b, s->v, s->Ax);
  for (int k = 0; k < rows->cp->m; ++k)
    if (rows->place[k] >= 0) x[k] -= s->v[k];
  return OK;
}

static status transpose_operated(linear_system *s, const double *b, double *w) {
  const linear_states *rows = s->rows;
  const contact_operator *op = rows->cp->op;
  CLEAR(w, rows->cp->m);
  op->solve(op->ctx, b, w, s->Ax);
  return s->bent ? gmres(s, 1, w) : OK;
}

/* ---- both ---------------------------------------------------------------- */

static int is_bent(const linear_states *rows) {
  for (int i = 0; rows->cp->B != NULL && i < rows->cp->n; ++i)
    if (rows->slip[i]) return 1;
  return 0;
}

/* *out is new; NULL if M is singular. ERR_MEMORY. */
static status linear_system_new(const linear_states *rows,
                                linear_system **out) {
  const size_t m = rows->cp->m;
  int singular = 0;
  MAKES(linear_system, s, out);
  s->rows = rows;
  s->bent = is_bent(rows);
  PASS_NEW_REALS(m, &s->b, &s->Ax);
  if (rows->cp->A != NULL) {
    PASS(factor(s, &singular));
  } else {
    PASS_NEW_REALS(m, &s->v, &s->zero);
    PASS(linear_set_rows(rows, &singular));
  }
  if (!singular) return OK;
  memory_free(s);
  *out = NULL;
  return OK;
}

/* x[m], at the known unknowns as given: (A + e B A_n + kappa ..) x = b at the
 * free ones, b[m]. ERR_MEMORY. */
static status linear_solve(linear_system *s, const double *b, double *x) {
  const linear_states *rows = s->rows;
  const int m = rows->cp->m;
  if (s->M == NULL) return solve_operated(s, b, x);
  OWNED_NEW(double, rest, m);
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

/* w[m]: M' w = b at the free unknowns, B' (e.w_t) on closed normals, else 0.
 * ERR_MEMORY. */
static status linear_solve_transposed(linear_system *s, const double *b,
                                      double *w) {
  CLEAR(w, s->rows->cp->m);
  if (s->M == NULL)
    PASS(transpose_operated(s, b, w));
  else
    solve_factored(s, 'T', b, w);
  linear_spread_friction(s->rows, w);
  return OK;
}

struct contact_adjoint {
  const contact_problem *cp;
  const double *u, *r; /* [m] borrowed */
  linear_states rows;
  linear_system *linear;
  double *w, *x, *Ax; /* [m] w of goal.h; workspace */
  double *stick;      /* [m] derivative by the positions of stick */
};

status contact_adjoint_new(const contact_problem *cp, const double *u,
                           const double *r, contact_adjoint **out) {
  MAKES(contact_adjoint, a, out);
  a->cp = cp;
  a->u = u;
  a->r = r;
  PASS_NEW_REALS(cp->m, &a->w, &a->x, &a->Ax, &a->stick);
  PASS(linear_states_new(cp, u, r, 1, &a->rows));
  PASS(linear_system_new(&a->rows, &a->linear));
  if (a->linear != NULL) return OK;
  memory_free(a);
  *out = NULL;
  return OK;
}

/* 1: the force at the unknown can change with the solution. */
static int carries(const contact_adjoint *a, int dof) {
  const contact_problem *cp = a->cp;
  if (contact_held(cp, dof)) return 0;
  return a->rows.place[dof] < 0 ||
         (dof % cp->dim > 0 && a->rows.slip[dof / cp->dim]);
}

/* Force of friction on a sliding unknown by its slip, N: opposite to it. */
static double friction_of(const contact_adjoint *a, int dof) {
  const contact_problem *cp = a->cp;
  const int i = dof / cp->dim;
  double size = 0.0;
  for (int t = i * cp->dim + 1; t < (i + 1) * cp->dim; ++t)
    if (accuracy_rubs(cp, t))
      size = hypot(size, a->u[t] - contact_stick(cp, t));
  if (!(size > 0.0)) return a->r[dof];
  return contact_node_limit(cp, a->r, i) *
         (contact_stick(cp, dof) - a->u[dof]) / size;
}

/* 1: it is held by friction where it sticks. */
static int sticks(const contact_adjoint *a, int dof) {
  return dof % a->cp->dim > 0 && a->rows.place[dof] < 0 &&
         !contact_held(a->cp, dof) && !(contact_bound(a->cp, dof) < HUGE_VAL);
}

/* What each equation that (u, r) misses adds to J: that of equilibrium by y,
 * u = bound by the rest of the adjoint equation, the law of a force by w. */
static double misses(const contact_adjoint *a, const double *j,
                     const double *y) {
  const contact_problem *cp = a->cp;
  double sum = 0.0;
  contact_apply(cp, a->u, a->x);
  for (int k = 0; k < cp->m; ++k) {
    const int i = k / cp->dim, tangent = k % cp->dim > 0;
    if (contact_held(cp, k)) continue;
    sum += y[k] * (cp->f[k] + a->r[k] - a->x[k]);
    if (a->rows.place[k] < 0)
      sum += (j[k] - a->Ax[k]) *
             ((sticks(a, k) ? contact_stick(cp, k) : contact_bound(cp, k)) -
              a->u[k]);
    else if (tangent && a->rows.slip[i])
      sum += a->w[k] * (friction_of(a, k) - a->r[k]);
    else
      sum -= a->w[k] * a->r[k];
  }
  return sum;
}

const double *contact_adjoint_stick(const contact_adjoint *a) {
  return a->stick;
}

status contact_adjoint_solve(contact_adjoint *a, const double *j,
                             const double *psi, double *y, double *solver) {
  const contact_problem *cp = a->cp;
  for (int k = 0; k < cp->m; ++k) a->x[k] = carries(a, k) ? psi[k] : 0.0;
  contact_apply(cp, a->x, a->Ax);
  for (int k = 0; k < cp->m; ++k) y[k] = -a->x[k];
  for (int k = 0; k < cp->m; ++k)
    a->x[k] = a->rows.place[k] < 0 ? 0.0 : j[k] + a->Ax[k];
  PASS(linear_solve_transposed(a->linear, a->x, a->w));
  for (int k = 0; k < cp->m; ++k) y[k] += a->w[k];
  contact_apply(cp, y, a->Ax);
  *solver = misses(a, j, y);
  /* Where a node sticks, the rest of the adjoint equation; in space slip turns
   * with it. */
  CLEAR(a->stick, cp->m);
  linear_add_turn(&a->rows, a->w, a->stick);
  for (int k = 0; k < cp->m; ++k)
    if (sticks(a, k)) a->stick[k] = j[k] - a->Ax[k];
  return OK;
}

status contact_adjoint_change(contact_adjoint *a, const double *df,
                              const double *stick, double *du) {
  for (int k = 0; k < a->cp->m; ++k) {
    a->x[k] = df[k];
    du[k] = sticks(a, k) ? stick[k] : 0.0;
  }
  linear_add_friction(&a->rows, df, a->x);
  linear_add_turn(&a->rows, stick, a->x);
  return linear_solve(a->linear, a->x, du);
}
