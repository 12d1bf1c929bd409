/*
 * A global problem  M v = H r + f,  u = H' v + w  without v:
 *
 *   W = H' inv(M) H,   q = H' inv(M) f + w.
 *
 * M is scaled to a unit diagonal and factored by CHOLMOD; what is not positive
 * definite or not symmetric can go to a dense LU factor, if it is small enough.
 */
#include "base/memory.h"
#include "exchange/parts.h"

#include <cholmod.h>
#include <lapacke.h>
#include <math.h>
#include <string.h>

enum { BLOCK = 32, MOST_DENSE = 6000 };
static const double ASYMMETRY = 1e-10; /* -, of the largest entry             */
static const double RCOND = 1e-14;     /* -, below: singular                  */
static const double DEFINITE = 1e-12;  /* -, below: not positive definite     */

/* ---- M as a sparse matrix, scaled -----------------------------------------
 */

typedef struct reduction {
  cholmod_common cm;
  cholmod_sparse *M; /* upper triangle of the scaled symmetric part          */
  cholmod_factor *L;
  double *scale; /* [rows] 1/sqrt(diagonal)                                  */
  int n;
} reduction;

static status no_memory(void) {
  return status_fail(ERR_MEMORY, __func__, __LINE__,
                     "memory exhausted: condensation of a global problem");
}

/* 0: a diagonal entry is not positive. */
static int make_scale(const triplets *M, double *scale) {
  for (long k = 0; k < M->n; ++k)
    if (M->row[k] == M->column[k]) scale[M->row[k]] += M->value[k];
  for (int i = 0; i < M->rows; ++i) {
    if (!(scale[i] > 0.0)) return 0;
    scale[i] = 1.0 / sqrt(scale[i]);
  }
  return 1;
}

/* All entries of the scaled M, both triangles, repeated ones added. */
static cholmod_sparse *assemble(reduction *s, const triplets *M, int mirror) {
  size_t n = (size_t)M->rows, most = (size_t)M->n * (mirror ? 2 : 1);
  cholmod_triplet *t =
      cholmod_allocate_triplet(n, n, most, 0, CHOLMOD_REAL, &s->cm);
  if (t == NULL) return NULL;
  int *row = t->i, *column = t->j;
  double *x = t->x;
  for (long k = 0; k < M->n; ++k) {
    int i = M->row[k], j = M->column[k];
    double value = M->value[k] * s->scale[i] * s->scale[j];
    const int times = mirror && i != j ? 2 : 1;
    for (int turn = 0; turn < times; ++turn) {
      row[t->nnz] = turn ? j : i;
      column[t->nnz] = turn ? i : j;
      x[t->nnz++] = value;
    }
  }
  cholmod_sparse *all = cholmod_triplet_to_sparse(t, 0, &s->cm);
  cholmod_free_triplet(&t, &s->cm);
  return all;
}

/* The symmetric part into s->M; *symmetric = 0 if it is not all. */
static status symmetric_part(reduction *s, const triplets *M, int *symmetric) {
  status st = OK;
  double half[2] = {0.5, 0.0}, minus[2] = {-0.5, 0.0};
  cholmod_sparse *all = assemble(s, M, triplets_triangle(M) != 0),
                 *turned = NULL;
  cholmod_sparse *skew = NULL, *mean = NULL;
  if (all != NULL) turned = cholmod_transpose(all, 1, &s->cm);
  if (turned != NULL) {
    skew = cholmod_add(all, turned, half, minus, 1, 0, &s->cm);
    mean = cholmod_add(all, turned, half, half, 1, 1, &s->cm);
  }
  if (skew == NULL || mean == NULL) TRY(no_memory());
  *symmetric = cholmod_norm_sparse(skew, 1, &s->cm) <=
               ASYMMETRY * cholmod_norm_sparse(mean, 1, &s->cm);
  s->M = cholmod_copy(mean, 1, 1, &s->cm);
  if (s->M == NULL) TRY(no_memory());
done:
  cholmod_free_sparse(&all, &s->cm);
  cholmod_free_sparse(&turned, &s->cm);
  cholmod_free_sparse(&skew, &s->cm);
  cholmod_free_sparse(&mean, &s->cm);
  return st;
}

/* *usable: M is symmetric and positive definite to rounding. */
static status factorise(reduction *s, const triplets *M, int *usable) {
  *usable = 0;
  PASS_NEW(s->scale, M->rows);
  if (!make_scale(M, s->scale)) return OK;
  int symmetric = 0;
  PASS(symmetric_part(s, M, &symmetric));
  if (!symmetric) return OK;
  s->L = cholmod_analyze(s->M, &s->cm);
  if (s->L == NULL) PASS(no_memory());
  cholmod_factorize(s->M, s->L, &s->cm);
  if (s->cm.status < 0) PASS(no_memory());
  *usable =
      s->cm.status == CHOLMOD_OK && cholmod_rcond(s->L, &s->cm) > DEFINITE;
  return OK;
}

/* ---- H and f as columns ----------------------------------------------------
 */

/* Column k of (H, f), k = H->columns for f, added into x[rows]. "start" and
 * "entry" list the entries of H column by column. */
typedef struct columns {
  const triplets *H;
  const double *f;
  int *start;  /* [H->columns + 1]                                           */
  long *entry; /* [H->n]                                                     */
} columns;

static status columns_new(const triplets *H, const double *f, columns *c) {
  c->H = H;
  c->f = f;
  return triplets_by_column(H, &c->start, &c->entry);
}

static void columns_free(columns *c) { RELEASE(c->start, c->entry); }

static void put_column(const columns *c, int k, double *x) {
  if (k == c->H->columns) {
    for (int i = 0; i < c->H->rows; ++i) x[i] += c->f[i];
    return;
  }
  for (int e = c->start[k]; e < c->start[k + 1]; ++e)
    x[c->H->row[c->entry[e]]] += c->H->value[c->entry[e]];
}

/* Column k of H' X, from column x of X = inv(M) (H, f). */
static void take_column(const columns *c, const double *x, double *y) {
  for (long e = 0; e < c->H->n; ++e)
    y[c->H->column[e]] += c->H->value[e] * x[c->H->row[e]];
}

static double *target(const columns *c, int k, double *W, double *q) {
  return k == c->H->columns ? q : W + (size_t)c->H->columns * (size_t)k;
}

/* ---- the two ways ---------------------------------------------------------
 */

static status reduce_block(reduction *s, const columns *c, int first, int count,
                           double *W, double *q) {
  status st = OK;
  size_t n = (size_t)s->n;
  cholmod_dense *X = NULL;
  cholmod_dense *B = cholmod_zeros(n, (size_t)count, CHOLMOD_REAL, &s->cm);
  if (B == NULL) TRY(no_memory());
  for (int k = 0; k < count; ++k) {
    double *b = (double *)B->x + n * (size_t)k;
    put_column(c, first + k, b);
    for (int i = 0; i < s->n; ++i) b[i] *= s->scale[i];
  }
  X = cholmod_solve(CHOLMOD_A, s->L, B, &s->cm);
  if (X == NULL) TRY(no_memory());
  for (int k = 0; k < count; ++k) {
    double *x = (double *)X->x + n * (size_t)k;
    for (int i = 0; i < s->n; ++i) x[i] *= s->scale[i];
    take_column(c, x, target(c, first + k, W, q));
  }
done:
  cholmod_free_dense(&B, &s->cm);
  cholmod_free_dense(&X, &s->cm);
  return st;
}

static void symmetrise(int m, double *W) {
  size_t n = (size_t)m;
  for (size_t j = 0; j < n; ++j)
    for (size_t i = 0; i < j; ++i)
      W[i + n * j] = W[j + n * i] = 0.5 * (W[i + n * j] + W[j + n * i]);
}

static status reduce_sparse(reduction *s, const columns *c, double *W,
                            double *q) {
  int all = c->H->columns + 1;
  for (int k = 0; k < all; k += BLOCK)
    PASS(reduce_block(s, c, k, all - k < BLOCK ? all - k : BLOCK, W, q));
  symmetrise(c->H->columns, W);
  return OK;
}

static status reduce_dense(const triplets *M, const columns *c, double *W,
                           double *q, int *singular) {
  int n = M->rows, mirror = triplets_triangle(M) != 0;
  size_t size = (size_t)n * (size_t)n;
  OWNED double *a = NULL, *work = NULL, *x = NULL;
  double rcond = 0.0;
  OWNED int *pivot = NULL;
  *singular = 1;
  PASS_NEW(a, size);
  PASS_NEW(work, 4 * (size_t)n);
  PASS_NEW(pivot, 2 * (size_t)n);
  PASS_NEW(x, n);
  triplets_dense(M, a);
  for (long k = 0; k < M->n && mirror; ++k)
    if (M->row[k] != M->column[k])
      a[(size_t)M->column[k] + (size_t)n * (size_t)M->row[k]] += M->value[k];
  double norm = LAPACKE_dlange_work(LAPACK_COL_MAJOR, '1', n, n, a, n, work);
  if (LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, n, n, a, n, pivot) != 0) return OK;
  LAPACKE_dgecon_work(LAPACK_COL_MAJOR, '1', n, a, n, norm, &rcond, work,
                      pivot + n);
  if (!(rcond > RCOND)) return OK;
  *singular = 0;
  for (int k = 0; k <= c->H->columns; ++k) {
    memset(x, 0, (size_t)n * sizeof *x);
    put_column(c, k, x);
    LAPACKE_dgetrs_work(LAPACK_COL_MAJOR, 'N', n, 1, a, n, pivot, x, n);
    take_column(c, x, target(c, k, W, q));
  }
  return OK;
}

status reduce_global(const triplets *M, const triplets *H, const double *f,
                     double *W, double *q, int *usable) {
  status st = OK;
  reduction s = {.n = M->rows};
  columns c = {0};
  *usable = 1;
  cholmod_start(&s.cm);
  s.cm.print = 0;
  s.cm.final_ll = 1; /* LL' finds what is not positive definite       */
  s.cm.quick_return_if_not_posdef = 1;
  if (M->rows == 0) goto done;
  TRY(columns_new(H, f, &c));
  TRY(factorise(&s, M, usable));
  if (*usable) TRY(reduce_sparse(&s, &c, W, q));
done:
  columns_free(&c);
  memory_free(s.scale);
  cholmod_free_sparse(&s.M, &s.cm);
  cholmod_free_factor(&s.L, &s.cm);
  cholmod_finish(&s.cm);
  return st;
}

status reduce_any(const char *path, const triplets *M, const triplets *H,
                  const double *f, double *W, double *q) {
  status st = OK;
  columns c = {0};
  int singular = 0;
  if (M->rows > MOST_DENSE)
    FAIL(ERR_SINGULAR,
         "%s: /fclib_global/M is not symmetric and positive definite, and too "
         "large (%d) for another way",
         path, M->rows);
  TRY(columns_new(H, f, &c));
  TRY(reduce_dense(M, &c, W, q, &singular));
  if (singular)
    FAIL(ERR_SINGULAR,
         "%s: /fclib_global/M is singular: v cannot be eliminated", path);
done:
  columns_free(&c);
  return st;
}
