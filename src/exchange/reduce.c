/*
 * Elimination of v from a global problem M v = H r + f, u = H' v + w:
 *
 *   W = H' inv(M) H,   q = H' inv(M) f + w.
 *
 * M is scaled to a unit diagonal and factored by CHOLMOD; a matrix that is not
 * positive definite or not symmetric gets a dense LU factor if small.
 */
#include "base/base.h"
#include "exchange/parts.h"
#include "mesh/mesh.h"

#include <cblas.h>
#include <cholmod.h>
#include <lapacke.h>

/* ---- a global problem whose M is symmetric and singular: bodies that contact
 * alone holds. Springs s between the contact points and their obstacles hold
 * them, and are taken out again:    M v = H r + f,   y = H'v,   Ms = M + s H
 * H',   Ws = H' inv(Ms) H,   A y = r + inv(Ws) H' inv(Ms) f,   A = inv(Ws) - s
 * I.  A is the stiffness of the contact points, semidefinite. It needs H of
 * full column rank, and H'z != 0 for every motion z without force. */

static const double SPRING_RCOND =
    1e-13; /* -, of Ws, below: H is rank deficient */

/* Mean diagonal of M over that of H H', where both are not zero. */
static double stiffness(const triplets *M, const triplets *H) {
  double sum = 0.0, squares = 0.0;
  for (long k = 0; k < M->n; ++k)
    if (M->row[k] == M->column[k]) sum += M->value[k] / M->rows;
  for (long k = 0; k < H->n; ++k)
    squares += H->value[k] * H->value[k] / H->columns;
  return squares > 0.0 ? sum / squares : 0.0;
}

/* In one triangle if M is. */
status springs_add(const triplets *M, const triplets *H, double *s,
                   triplets *held) {
  *s = stiffness(M, H);
  OWNED int *start = NULL;
  int triangle = triplets_triangle(M);
  OWNED long *entry = NULL;
  long count = M->n;
  PASS(triplets_by_column(H, &start, &entry));
  for (int j = 0; j < H->columns; ++j) {
    long n = start[j + 1] - start[j];
    count += n * n;
  }
  held->rows = held->columns = M->rows;
  PASS_NEW_ALL(OF(held->row, count), OF(held->column, count),
               OF(held->value, count));
  for (; held->n < M->n; ++held->n) {
    held->row[held->n] = M->row[held->n];
    held->column[held->n] = M->column[held->n];
    held->value[held->n] = M->value[held->n];
  }
  for (int j = 0; j < H->columns; ++j)
    for (int a = start[j]; a < start[j + 1]; ++a)
      for (int b = start[j]; b < start[j + 1]; ++b) {
        int row = H->row[entry[a]], column = H->row[entry[b]];
        if (triangle * (column - row) < 0) continue;
        held->row[held->n] = row;
        held->column[held->n] = column;
        held->value[held->n++] = *s * H->value[entry[a]] * H->value[entry[b]];
      }
  return OK;
}

/* inv(W) in place, both triangles; 0: singular. work[3m], iwork[m] */
static int invert(int m, double *W, double *work, int *iwork) {
  double rcond = 0.0;
  double norm = LAPACKE_dlansy_work(LAPACK_COL_MAJOR, '1', 'L', m, W, m, work);
  if (LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'L', m, W, m) != 0) return 0;
  LAPACKE_dpocon_work(LAPACK_COL_MAJOR, 'L', m, W, m, norm, &rcond, work,
                      iwork);
  if (!(rcond > SPRING_RCOND)) return 0;
  if (LAPACKE_dpotri_work(LAPACK_COL_MAJOR, 'L', m, W, m) != 0) return 0;
  for (size_t j = 0; j < (size_t)m; ++j)
    for (size_t i = 0; i < j; ++i) W[i + m * j] = W[j + m * i];
  return 1;
}

status springs_condense(const triplets *M, const triplets *H, const double *f,
                        double *A, double *load, int *usable) {
  OWNED double *q = NULL, *work = NULL;
  double s = 0.0;
  OWNED int *iwork = NULL;
  int m = H->columns;
  PASS_NEW_ALL(OF(q, m), OF(work, 3 * m), OF(iwork, m));
  OWNED_PARTS(triplets, held, springs_add(M, H, &s, &held));
  PASS(reduce_global(&held, H, f, A, q, usable));
  *usable = *usable && s > 0.0 && invert(m, A, work, iwork);
  if (!*usable) return OK;
  cblas_dsymv(CblasColMajor, CblasLower, m, 1.0, A, m, q, 1, 0.0, load, 1);
  for (size_t i = 0; i < (size_t)m; ++i) A[i * ((size_t)m + 1)] -= s;
  return OK;
}

/* ---- equality constraints of FCLIB eliminated:    V'r + R l + s = 0,   u = W
 * r + V l + q,   l = -R+ (V'r + s):   W <- W - V R+ V',   q <- q - V R+ s.  R
 * may be unsymmetric, or singular where constraints repeat one another (then l
 * is not unique, u is); constraints that contradict one another are refused. */

static const double REPEATED_RCOND = 1e-12; /* -, below: repeated */
static const double CONSISTENT = 1e-8;      /* -, of the right-hand side */

typedef struct elimination {
  double *R, *X, *rhs; /* [p*p], [p*(m+1)]: least squares for [V' s] */
  double *spread;      /* [p] */
} elimination;

static status elimination_new(int m, const constraints *c, elimination *a) {
  size_t p = c->p, all = p * ((size_t)m + 1);
  PASS_NEW(a->R, p * p);
  PASS_NEW_REALS(all, &a->X, &a->rhs);
  PASS_NEW(a->spread, p);
  COPY(a->R, c->R, p * p);
  for (size_t k = 0; k < p; ++k) {
    for (size_t i = 0; i < (size_t)m; ++i) a->X[k + p * i] = c->V[i + m * k];
    a->X[k + p * m] = c->s[k];
  }
  COPY(a->rhs, a->X, all);
  return OK;
}

/* |R X - [V' s]| of the largest entry, relative. */
static double contradiction(int m, const constraints *c, elimination *a) {
  size_t all = c->p * ((size_t)m + 1);
  const double size = largest_entry(all, a->rhs);
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, c->p, m + 1, c->p,
              -1.0, c->R, c->p, a->X, c->p, 1.0, a->rhs, c->p);
  const double defect = largest_entry(all, a->rhs);
  return size > 0.0 ? defect / size : 0.0;
}

status constraints_eliminate(const char *path, int m, const constraints *c,
                             double *W, double *q) {
  elimination a = {0};
  lapack_int rank = 0, info;
  if (c->p == 0) return OK;
  SCRATCH;
  PASS(elimination_new(m, c, &a));
  info = LAPACKE_dgelsd(LAPACK_COL_MAJOR, c->p, c->p, m + 1, a.R, c->p, a.X,
                        c->p, a.spread, REPEATED_RCOND, &rank);
  if (info != 0)
    RAISE(info == LAPACK_WORK_MEMORY_ERROR ? ERR_MEMORY : ERR_SINGULAR,
          "%s: the equality constraints cannot be eliminated", path);
  if (!(contradiction(m, c, &a) <= CONSISTENT))
    RAISE(ERR_SINGULAR,
          "%s: the equality constraints contradict one another: of %d only %d "
          "are independent",
          path, c->p, (int)rank);
  cblas_dgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, m, m, c->p, -1.0, c->V,
              m, a.X, c->p, 1.0, W, m);
  cblas_dgemv(CblasColMajor, CblasNoTrans, m, c->p, -1.0, c->V, m,
              a.X + (size_t)c->p * m, 1, 1.0, q, 1);
  return OK;
}

enum { BLOCK = 32, MOST_DENSE = 6000 };
static const double ASYMMETRY = 1e-10; /* -, of the largest entry */
static const double RCOND = 1e-14;     /* -, below: singular */
static const double DEFINITE = 1e-12;  /* -, below: not positive definite */

/* ---- M as a sparse matrix, scaled ---------------------------------------- */

typedef struct reduction {
  cholmod_common cm;
  cholmod_sparse *M; /* upper triangle of the scaled symmetric part */
  cholmod_factor *L;
  double *scale; /* [rows] 1/sqrt(diagonal) */
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
  size_t n = M->rows, most = (size_t)M->n * (mirror ? 2 : 1);
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

/* ---- H and f as columns -------------------------------------------------- */

/* Column k of (H, f), k = H->columns for f, added into x[rows]. "start" and
 * "entry" list the entries of H column by column. */
typedef struct columns {
  const triplets *H;
  const double *f;
  int *start;  /* [H->columns + 1] */
  long *entry; /* [H->n] */
} columns;

static status columns_new(const triplets *H, const double *f, columns *c) {
  c->H = H;
  c->f = f;
  return triplets_by_column(H, &c->start, &c->entry);
}

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
  return k == c->H->columns ? q : W + (size_t)c->H->columns * k;
}

/* ---- Cholesky or LU ------------------------------------------------------ */

/* x <- inv(M) x. */
static status solve_scaled(reduction *s, double *x) {
  cholmod_dense b = {.nrow = s->n,
                     .ncol = 1,
                     .nzmax = s->n,
                     .d = s->n,
                     .x = x,
                     .xtype = CHOLMOD_REAL,
                     .dtype = CHOLMOD_DOUBLE};
  for (int i = 0; i < s->n; ++i) x[i] *= s->scale[i];
  cholmod_dense *y = cholmod_solve(CHOLMOD_A, s->L, &b, &s->cm);
  if (y == NULL) PASS(no_memory());
  for (int i = 0; i < s->n; ++i) x[i] = s->scale[i] * ((double *)y->x)[i];
  cholmod_free_dense(&y, &s->cm);
  return OK;
}

static status reduce_block(reduction *s, const columns *c, int first, int count,
                           double *W, double *q) {
  status st = OK;
  size_t n = s->n;
  cholmod_dense *X = NULL;
  cholmod_dense *B = cholmod_zeros(n, count, CHOLMOD_REAL, &s->cm);
  if (B == NULL) TRY(no_memory());
  for (int k = 0; k < count; ++k) {
    double *b = (double *)B->x + n * k;
    put_column(c, first + k, b);
    for (int i = 0; i < s->n; ++i) b[i] *= s->scale[i];
  }
  X = cholmod_solve(CHOLMOD_A, s->L, B, &s->cm);
  if (X == NULL) TRY(no_memory());
  for (int k = 0; k < count; ++k) {
    double *x = (double *)X->x + n * k;
    for (int i = 0; i < s->n; ++i) x[i] *= s->scale[i];
    take_column(c, x, target(c, first + k, W, q));
  }
done:
  cholmod_free_dense(&B, &s->cm);
  cholmod_free_dense(&X, &s->cm);
  return st;
}

static void symmetrise(int m, double *W) {
  size_t n = m;
  for (size_t j = 0; j < n; ++j)
    for (size_t i = 0; i < j; ++i)
      W[i + n * j] = W[j + n * i] = 0.5 * (W[i + n * j] + W[j + n * i]);
}

static status reduce_dense(const triplets *M, const columns *c, double *W,
                           double *q, int *singular) {
  int n = M->rows, mirror = triplets_triangle(M) != 0;
  size_t size = (size_t)n * n;
  OWNED double *a = NULL, *work = NULL, *x = NULL;
  double rcond = 0.0;
  *singular = 1;
  OWNED_NEW(int, pivot, 2 * (size_t)n);
  PASS_NEW_ALL(OF(a, size), OF(work, 4 * (size_t)n), OF(x, n));
  triplets_dense(M, a);
  for (long k = 0; k < M->n && mirror; ++k)
    if (M->row[k] != M->column[k])
      a[M->column[k] + (size_t)n * M->row[k]] += M->value[k];
  double norm = LAPACKE_dlange_work(LAPACK_COL_MAJOR, '1', n, n, a, n, work);
  if (LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, n, n, a, n, pivot) != 0) return OK;
  LAPACKE_dgecon_work(LAPACK_COL_MAJOR, '1', n, a, n, norm, &rcond, work,
                      pivot + n);
  if (!(rcond > RCOND)) return OK;
  *singular = 0;
  for (int k = 0; k <= c->H->columns; ++k) {
    CLEAR(x, n);
    put_column(c, k, x);
    LAPACKE_dgetrs_work(LAPACK_COL_MAJOR, 'N', n, 1, a, n, pivot, x, n);
    take_column(c, x, target(c, k, W, q));
  }
  return OK;
}

static void reduction_begin(reduction *s) {
  cholmod_start(&s->cm);
  s->cm.print = 0;
  s->cm.final_ll = 1; /* LL' finds what is not positive definite */
  s->cm.quick_return_if_not_posdef = 1;
}

static void reduction_end(reduction *s) {
  memory_free(s->scale);
  cholmod_free_sparse(&s->M, &s->cm);
  cholmod_free_factor(&s->L, &s->cm);
  cholmod_finish(&s->cm);
}

status reduce_global(const triplets *M, const triplets *H, const double *f,
                     double *W, double *q, int *usable) {
  ENDS_BY(reduction_end) reduction s = {.n = M->rows};
  *usable = 1;
  reduction_begin(&s);
  if (M->rows == 0) return OK;
  OWNED_PARTS(columns, c, columns_new(H, f, &c));
  PASS(factorise(&s, M, usable));
  if (*usable) {
    int all = c.H->columns + 1;
    for (int k = 0; k < all; k += BLOCK)
      PASS(reduce_block(&s, &c, k, all - k < BLOCK ? all - k : BLOCK, W, q));
    symmetrise(c.H->columns, W);
  }
  return OK;
}

/* ---- bodies apart -----------------------------------------------------------
 *
 * The rows of M fall into sets without entries between them, a body each, and
 * W = sum H_s' inv(M_s) H_s. Solutions of all sets share one right side: its
 * part in a set is that of one of the columns with entries there.
 */

typedef struct row_sets {
  int n, most;  /* sets; columns of the set that has most of them */
  int *of;      /* [rows] set of a row */
  int *start;   /* [n+1] */
  int *column;  /* [start[n]] columns of each set */
  int *current; /* [n] that of the right side; -1: none left */
} row_sets;

static status join_rows(const triplets *M, row_sets *t) {
  OWNED int *parent = NULL, *number = NULL;
  PASS_NEW_ALL(OF(parent, M->rows), OF(number, M->rows));
  for (int i = 0; i < M->rows; ++i) {
    parent[i] = i;
    number[i] = -1;
  }
  for (long k = 0; k < M->n; ++k)
    if (M->value[k] != 0.0) forest_join(parent, M->row[k], M->column[k]);
  for (int i = 0; i < M->rows; ++i) {
    int *at = &number[forest_root(parent, i)];
    if (*at < 0) *at = t->n++;
    t->of[i] = *at;
  }
  return OK;
}

/* Columns of the sets: counted (t->column NULL) or put. */
static void count_columns(const columns *c, row_sets *t) {
  for (int s = 0; s < t->n; ++s) t->current[s] = -1;
  for (int j = 0; j < c->H->columns; ++j)
    for (int e = c->start[j]; e < c->start[j + 1]; ++e) {
      const int s = t->of[c->H->row[c->entry[e]]];
      if (t->current[s] == j) continue;
      t->current[s] = j;
      if (t->column != NULL) t->column[t->start[s + 1]] = j;
      ++t->start[s + (t->column == NULL ? 2 : 1)];
    }
}

static status row_sets_new(const triplets *M, const columns *c, row_sets *t) {
  PASS_NEW(t->of, M->rows);
  PASS(join_rows(M, t));
  PASS_NEW_ALL(OF(t->start, t->n + 2), OF(t->current, t->n));
  count_columns(c, t);
  for (int s = 0; s < t->n; ++s) {
    if (t->start[s + 2] > t->most) t->most = t->start[s + 2];
    t->start[s + 2] += t->start[s + 1];
  }
  PASS_NEW(t->column, t->start[t->n + 1]);
  count_columns(c, t);
  return OK;
}

/* Right side k of all sets into b[rows]. */
static void put_parts(const columns *c, row_sets *t, int k, double *b) {
  for (int s = 0; s < t->n; ++s)
    t->current[s] =
        t->start[s] + k < t->start[s + 1] ? t->column[t->start[s] + k] : -1;
  for (long e = 0; e < c->H->n; ++e)
    if (c->H->column[e] == t->current[t->of[c->H->row[e]]])
      b[c->H->row[e]] += c->H->value[e];
}

/* Their entries of W from x[rows] = inv(M) b, half of each across the diagonal:
 * W becomes symmetric. */
static status take_parts(const columns *c, const row_sets *t, const double *x,
                         triplets *W, long capacity) {
  for (long e = 0; e < c->H->n; ++e) {
    const int i = c->H->column[e], j = t->current[t->of[c->H->row[e]]];
    const double half = 0.5 * c->H->value[e] * x[c->H->row[e]];
    if (j < 0 || half == 0.0) continue;
    if (W->n + 2 > capacity) RAISE(ERR_INTERNAL, "more entries than counted");
    for (int turn = 0; turn < 2; ++turn) {
      W->row[W->n] = turn ? j : i;
      W->column[W->n] = turn ? i : j;
      W->value[W->n++] = half;
    }
  }
  return OK;
}

/* Entries take_parts has at most. */
static double count_parts(const columns *c, const row_sets *t) {
  double n = 0.0;
  for (long e = 0; e < c->H->n; ++e) {
    const int s = t->of[c->H->row[e]];
    n += 2.0 * (t->start[s + 1] - t->start[s]);
  }
  return n;
}

static status solve_parts(reduction *s, const columns *c, row_sets *t,
                          long capacity, triplets *W) {
  OWNED_NEW(double, x, s->n);
  PASS_NEW_ALL(OF(W->row, capacity), OF(W->column, capacity),
               OF(W->value, capacity));
  for (int k = 0; k < t->most; ++k) {
    CLEAR(x, s->n);
    put_parts(c, t, k, x);
    PASS(solve_scaled(s, x));
    PASS(take_parts(c, t, x, W, capacity));
  }
  return OK;
}

status reduce_bodies(const triplets *M, const triplets *H, const double *f,
                     double share, triplets *W, double *q, int *usable) {
  ENDS_BY(reduction_end) reduction s = {.n = M->rows};
  double entries;
  const double m = H->columns;
  *usable = 0;
  W->rows = W->columns = H->columns;
  reduction_begin(&s);
  if (M->rows == 0) return OK;
  OWNED_PARTS(columns, c, columns_new(H, f, &c));
  OWNED_PARTS(row_sets, t, row_sets_new(M, &c, &t));
  entries = count_parts(&c, &t);
  if (entries > share * m * m) return OK;
  PASS(factorise(&s, M, usable));
  if (!*usable) return OK;
  PASS(solve_parts(&s, &c, &t, (long)entries, W));
  OWNED_NEW(double, x, s.n);
  put_column(&c, H->columns, x);
  PASS(solve_scaled(&s, x));
  take_column(&c, x, q);
  return OK;
}

status reduce_any(const char *path, const triplets *M, const triplets *H,
                  const double *f, double *W, double *q) {
  int singular = 0;
  if (M->rows > MOST_DENSE)
    RAISE(ERR_SINGULAR,
          "%s: /fclib_global/M is not symmetric and positive definite, and too "
          "large (%d) for a dense LU factor",
          path, M->rows);
  OWNED_PARTS(columns, c, columns_new(H, f, &c));
  PASS(reduce_dense(M, &c, W, q, &singular));
  if (singular)
    RAISE(ERR_SINGULAR,
          "%s: /fclib_global/M is singular: v cannot be eliminated", path);
  return OK;
}

status require_problem_memory(double m) {
  enum { MATRICES = 5 };
  return memory_require(MATRICES * m * m * sizeof(double), "the problem");
}
