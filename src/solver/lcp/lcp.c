/*
 * Complementary pivoting with a reduced inverse (lcp.h).
 *
 * Basic are: the z of the list "var" (z0 is number n), and the w of every row
 * not in the list "row". Both lists have s entries; with P = [M d](row, var)
 * and K = inv(P)
 *
 *   z_var = -K q_row,   w_i = q_i + [M d](i, var) z_var   for the other i.
 *
 * The complement of the variable that left last enters next. A pivot adds,
 * replaces or removes one row and one column of P; K follows by a rank-one
 * change. Lexicographic rule: q is thought of as q + (e, e^2, ...) with an
 * infinitesimal e; only the columns of the inverse that are needed to break
 * ties are formed.
 */
#include "solver/lcp/lcp.h"

#include "base/sparse.h"

#include <cblas.h>
#include <lapacke.h>

/* ---- the plain form of the problem: a dense matrix, covering vector 1 ---- */

typedef struct plain {
  int n;
  const double *M;
  double factor; /* of two: M times factor is of order 1 */
} plain;

static void plain_product(const void *ctx, int n_id, const int *id,
                          const double *x, double *y) {
  const plain *m = ctx;
  size_t n = m->n;
  CLEAR(y, n);
  for (int k = 0; k < n_id; ++k)
    if (x[k] != 0.0)
      cblas_daxpy(m->n, m->factor * x[k], m->M + n * id[k], 1, y, 1);
}

static void plain_row(const void *ctx, int i, int n_id, const int *id,
                      double *row) {
  const plain *m = ctx;
  for (int k = 0; k < n_id; ++k)
    row[k] = m->factor * m->M[i + (size_t)m->n * id[k]];
}

static double plain_residual(int n, const double *M, const double *q,
                             const double *z) {
  double worst = 0.0;
  for (size_t i = 0; i < (size_t)n; ++i) {
    double sum = q[i];
    for (size_t j = 0; j < (size_t)n; ++j) sum += M[i + n * j] * z[j];
    double violation = fabs(fmin(sum, z[i]));
    if (!(violation <= worst)) worst = violation;
  }
  return worst;
}

status lcp_lemke(int n, const double *M, const double *q, int max_pivots,
                 double *z, lcp_report *rep) {
  plain m = {n, M, power_to_one(largest_entry((size_t)n * n, M))};
  *rep = (lcp_report){.outcome = RUNNING};
  OWNED_OF(lcp_work, w, lcp_new(n, n, &w));
  OWNED_NEW(double, d, n);
  for (int i = 0; i < n; ++i) d[i] = 1.0;
  lcp_problem p = {.n = n,
                   .q = q,
                   .d = d,
                   .max_pivots = max_pivots,
                   .product = plain_product,
                   .row = plain_row,
                   .ctx = &m};
  lcp_run(w, &p, rep);
  if (rep->outcome == STOPPED_RAY) {
    lcp_ray(w, z);
  } else {
    lcp_values(w, z);
    for (int i = 0; i < n; ++i) z[i] *= m.factor;
    rep->residual = plain_residual(n, M, q, z);
  }
  return OK;
}

/* Relative to the largest number of the same kind. */
#define TIE 0x1p-42      /* values that count as zero */
#define ROUNDING 0x1p-53 /* rounding error of a product, with K */

struct lcp_work {
  int n, cap, s;    /* n, cap: of the run, of the blocks */
  double *K;        /* [cap*cap] */
  double *P;        /* [cap*cap] for a new inverse */
  double *lapack;   /* [cap] */
  int *swap;        /* [cap] */
  int *var, *row;   /* [cap] columns and rows of P */
  int *at_z, *at_w; /* [n+1], [n] their places, -1: none */
  double *z, *w;    /* [cap] of var; [n] of the rows not in "row" */
  struct {
    int id;              /* k: z_k; -1-k: w_k */
    double *dz, *dw;     /* as z, w: change per unit of the variable */
    double *lz, *lw;     /* the same: one column of the inverse */
  } enter;               /* the entering variable */
  double *gather, *line; /* [cap] */
  double *column;        /* [n] */
  double *q;             /* [n] scaled */
  int *tie;              /* [n+cap] candidates: a < cap: z; cap + i: w_i */
  double *key;           /* [n+cap] */
  double power;          /* of two: q of the problem = power q */
  double size_K;         /* estimate of the largest |K| */
  double z0_start;       /* z0 after the first pivot */
};

/* ---- inverse of the basis, basic variables and their change ------------- */

static const double DRIFT = 0x1p-48; /* defect that requires a correction */

/* to[n] = [M d](:, var) x. While z0 is basic it stands first in var. */
static void lcp_expand(lcp_work *w, const lcp_problem *p, const double *x,
                       double *to) {
  int z0 = w->at_z[w->n], s = w->s;
  if (z0 < 0) {
    p->product(p->ctx, s, w->var, x, to);
    return;
  }
  p->product(p->ctx, s - 1, w->var + 1, x + 1, to);
  cblas_daxpy(w->n, x[0], p->d, 1, to, 1);
}

/* to[s] = [M d](i, var) */
static void lcp_row_of(const lcp_work *w, const lcp_problem *p, int i,
                       double *to) {
  int skip = w->at_z[w->n] < 0 ? 0 : 1;
  if (skip) to[0] = p->d[i];
  p->row(p->ctx, i, w->s - skip, w->var + skip, to + skip);
}

/* to[s] = K x[s] */
static void lcp_apply_inverse(const lcp_work *w, const double *x, double *to) {
  cblas_dgemv(CblasColMajor, CblasNoTrans, w->s, w->s, 1.0, w->K, w->cap, x, 1,
              0.0, to, 1);
}

static double lcp_largest(int n, const double *x) {
  return n > 0 ? fabs(x[cblas_idamax(n, x, 1)]) : 0.0;
}

/* z = -K q_row, w = q + M z, with one correction of the defect of the rows.
 * Returns the relative defect before. */
static double lcp_refresh(lcp_work *w, const lcp_problem *p) {
  double defect = 0.0, size = 0.0;
  for (int b = 0; b < w->s; ++b) w->gather[b] = -w->q[w->row[b]];
  lcp_apply_inverse(w, w->gather, w->z);
  for (int pass = 0; pass < 2; ++pass) {
    lcp_expand(w, p, w->z, w->w);
    defect = 0.0;
    size = fmax(1.0, lcp_largest(w->s, w->z));
    for (int b = 0; b < w->s; ++b) {
      w->gather[b] = w->w[w->row[b]] + w->q[w->row[b]];
      defect = fmax(defect, fabs(w->gather[b]));
    }
    if (pass == 1) break;
    lcp_apply_inverse(w, w->gather, w->line);
    for (int a = 0; a < w->s; ++a) w->z[a] -= w->line[a];
  }
  cblas_daxpy(w->n, 1.0, w->q, 1, w->w, 1);
  for (int b = 0; b < w->s; ++b) w->w[w->row[b]] = 0.0;
  w->size_K = 0.0;
  for (int b = 0; b < w->s; ++b)
    w->size_K = fmax(w->size_K, lcp_largest(w->s, w->K + (size_t)b * w->cap));
  return defect / size;
}

/* A new inverse; 0: P is singular. */
static int lcp_invert(lcp_work *w, const lcp_problem *p) {
  int s = w->s;
  if (s == 0) return 1;
  for (int b = 0; b < s; ++b) {
    lcp_row_of(w, p, w->row[b], w->line);
    cblas_dcopy(s, w->line, 1, w->P + b, w->cap);
  }
  if (LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, s, s, w->P, w->cap, w->swap) != 0)
    return 0;
  if (LAPACKE_dgetri_work(LAPACK_COL_MAJOR, s, w->P, w->cap, w->swap, w->lapack,
                          w->cap) != 0)
    return 0;
  double *old = w->K;
  w->K = w->P;
  w->P = old;
  return 1;
}

/* Direction of all basic variables for the entering one, corrected once if the
 * inverse has drifted; returns the relative defect before. */
static double lcp_direction(lcp_work *w, const lcp_problem *p) {
  int s = w->s, k = w->enter.id, enters_z = k >= 0;
  double defect = 0.0, first = 0.0, size = 1.0, one = 1.0;
  if (enters_z) {
    p->product(p->ctx, 1, &k, &one, w->column);
    for (int b = 0; b < s; ++b) w->gather[b] = -w->column[w->row[b]];
    lcp_apply_inverse(w, w->gather, w->enter.dz);
  } else {
    COPY(w->enter.dz, w->K + (size_t)w->at_w[-1 - k] * w->cap, s);
  }
  for (int pass = 0; pass < 2; ++pass) {
    lcp_expand(w, p, w->enter.dz, w->enter.dw);
    if (enters_z) cblas_daxpy(w->n, 1.0, w->column, 1, w->enter.dw, 1);
    if (!enters_z) w->enter.dw[-1 - k] -= 1.0;
    defect = 0.0;
    size = fmax(1.0, lcp_largest(s, w->enter.dz));
    for (int b = 0; b < s; ++b) {
      w->gather[b] = w->enter.dw[w->row[b]];
      if (!(fabs(w->gather[b]) <= defect)) defect = fabs(w->gather[b]);
    }
    if (pass == 0) first = defect / size;
    if (pass == 1 || defect <= DRIFT * size) break;
    lcp_apply_inverse(w, w->gather, w->line);
    for (int a = 0; a < s; ++a) w->enter.dz[a] -= w->line[a];
  }
  for (int b = 0; b < s; ++b) w->enter.dw[w->row[b]] = 0.0;
  return first;
}

/* ---- which variable leaves the basis: the first to vanish, ties by the
 * lexicographic rule. */

static const double SMALL = 0x1p-38;   /* no pivot below */
static const double UNEQUAL = 0x1p-26; /* pivots of tied rows not considered */
static const double MOST_NOISE =
    0x1p-28; /* larger values are not taken for rounding */

/* What counts as zero, of each kind (z0, z, w): values, changes. */
typedef struct sizes {
  double value[3], change[3];
} sizes;

static int kind_of(const lcp_work *w, int candidate) {
  if (candidate >= w->cap) return 2;
  return w->var[candidate] == w->n ? 0 : 1;
}

static double value_of(const lcp_work *w, int candidate) {
  double x = candidate < w->cap ? w->z[candidate] : w->w[candidate - w->cap];
  return x > 0.0 ? x : 0.0;
}

static double change_of(const lcp_work *w, int candidate) {
  return candidate < w->cap ? w->enter.dz[candidate]
                            : w->enter.dw[candidate - w->cap];
}

/* Bound of zero against "size": a share of it, or the rounding error. */
static double lcp_zero(double share, double size, double noise) {
  return fmax(share * size, fmin(noise, MOST_NOISE * size));
}

static sizes measure(const lcp_work *w) {
  double value[3] = {w->z0_start, 0.0, 1.0}, change[3];
  sizes k;
  for (int a = 0; a < w->s; ++a) {
    int kind = kind_of(w, a);
    value[kind] = fmax(value[kind], fabs(w->z[a]));
  }
  value[2] = fmax(value[2], lcp_largest(w->n, w->w));
  double moved =
      fmax(lcp_largest(w->s, w->enter.dz), w->enter.id >= 0 ? 1.0 : 0.0);
  change[0] = change[1] = moved;
  change[2] = fmax(lcp_largest(w->n, w->enter.dw), moved);
  double noise = ROUNDING * w->size_K;
  for (int i = 0; i < 3; ++i) {
    k.value[i] = lcp_zero(TIE, value[i], noise * fmax(1.0, value[1]));
    k.change[i] = lcp_zero(SMALL, change[i], noise * moved);
  }
  return k;
}

/* List the rows that reach zero first. Returns how many; *step. */
static int first_to_vanish(lcp_work *w, const sizes *k, double *step) {
  int n_candidate = 0, n_tie = 0;
  double pivot[3] = {0.0, 0.0, 0.0};
  *step = HUGE_VAL;
  for (int c = 0; c < w->cap + w->n; ++c) {
    if (c < w->cap ? c >= w->s : w->at_w[c - w->cap] >= 0) continue;
    double change = change_of(w, c);
    if (!(change < -k->change[kind_of(w, c)])) continue;
    w->tie[n_candidate++] = c;
    *step = fmin(*step, value_of(w, c) / -change);
  }
  for (int i = 0; i < n_candidate; ++i) {
    int c = w->tie[i], kind = kind_of(w, c);
    double left = value_of(w, c) + change_of(w, c) * *step;
    if (left > k->value[kind]) continue;
    pivot[kind] = fmax(pivot[kind], -change_of(w, c));
    w->tie[n_tie++] = c;
  }
  n_candidate = n_tie;
  n_tie = 0;
  for (int i = 0; i < n_candidate; ++i) {
    int c = w->tie[i];
    if (-change_of(w, c) >= UNEQUAL * pivot[kind_of(w, c)]) w->tie[n_tie++] = c;
  }
  return n_tie;
}

/* Keep the tied rows whose entry in the column of e^(j+1) is least. */
static int split_ties(lcp_work *w, const lcp_problem *p, int j, int n_tie) {
  int b = w->at_w[j], kept = 0, any_w = 0;
  double least = HUGE_VAL, noise = 0.0, size_z, size_w;
  if (b < 0) { /* a unit column */
    for (int i = 0; i < n_tie; ++i)
      if (w->tie[i] != w->cap + j) w->tie[kept++] = w->tie[i];
    return kept > 0 ? kept : n_tie;
  }
  for (int a = 0; a < w->s; ++a) w->enter.lz[a] = -w->K[a + (size_t)b * w->cap];
  for (int i = 0; i < n_tie; ++i) any_w = any_w || w->tie[i] >= w->cap;
  size_w = size_z = lcp_largest(w->s, w->enter.lz);
  if (any_w) {
    lcp_expand(w, p, w->enter.lz, w->enter.lw);
    size_w = fmax(size_w, lcp_largest(w->n, w->enter.lw));
  }
  for (int i = 0; i < n_tie; ++i) {
    int c = w->tie[i], is_w = c >= w->cap;
    double entry = is_w ? w->enter.lw[c - w->cap] : w->enter.lz[c];
    w->key[i] = entry / -change_of(w, c);
    least = fmin(least, w->key[i]);
    noise = fmax(noise, (is_w ? size_w : size_z) / -change_of(w, c));
  }
  for (int i = 0; i < n_tie; ++i)
    if (w->key[i] <= least + TIE * noise) w->tie[kept++] = w->tie[i];
  return kept;
}

/* Candidate that leaves, -1: none (a ray). z0 has priority: the problem is then
 * solved. */
static int lcp_leaving(lcp_work *w, const lcp_problem *p, double *step) {
  sizes k = measure(w);
  int n_tie = first_to_vanish(w, &k, step);
  if (n_tie == 0) return -1;
  for (int i = 0; i < n_tie; ++i)
    if (kind_of(w, w->tie[i]) == 0) return w->tie[i];
  for (int j = 0; j < w->n && n_tie > 1; ++j)
    n_tie = split_ties(w, p, j, n_tie);
  return w->tie[0];
}

/* ---- one change of basis: a row, a column or both of P are added, removed or
 * replaced, and its inverse follows by a change of rank one. */

/* gather = (row i of P) K */
static void row_times_inverse(lcp_work *w, const lcp_problem *p, int i) {
  lcp_row_of(w, p, i, w->line);
  cblas_dgemv(CblasColMajor, CblasTrans, w->s, w->s, 1.0, w->K, w->cap, w->line,
              1, 0.0, w->gather, 1);
}

static void rank_one(lcp_work *w, double factor, const double *x,
                     const double *y) {
  double change = fabs(factor) * lcp_largest(w->s, x) * lcp_largest(w->s, y);
  w->size_K = fmax(w->size_K, change);
  cblas_dger(CblasColMajor, w->s, w->s, factor, x, 1, y, 1, w->K, w->cap);
}

/* z_k enters, w_j leaves: P gets a row and a column. */
static void border(lcp_work *w, const lcp_problem *p, int k, int j) {
  int s = w->s;
  size_t ld = w->cap, last = s;
  double pivot = w->enter.dw[j];
  row_times_inverse(w, p, j);
  rank_one(w, -1.0 / pivot, w->enter.dz, w->gather);
  for (size_t a = 0; a < last; ++a) {
    w->K[a + last * ld] = w->enter.dz[a] / pivot;
    w->K[last + a * ld] = -w->gather[a] / pivot;
  }
  w->K[last + last * ld] = 1.0 / pivot;
  double edge =
      fmax(1.0, fmax(lcp_largest(s, w->enter.dz), lcp_largest(s, w->gather)));
  w->size_K = fmax(w->size_K, edge / fabs(pivot));
  w->var[s] = k;
  w->row[s] = j;
  w->at_z[k] = w->at_w[j] = s;
  ++w->s;
}

/* z_k enters for the z at place a. */
static void replace_column(lcp_work *w, int k, int a) {
  double pivot = -w->enter.dz[a];
  cblas_dcopy(w->s, w->K + a, w->cap, w->gather, 1);
  for (int i = 0; i < w->s; ++i) w->line[i] = -w->enter.dz[i];
  w->line[a] -= 1.0;
  rank_one(w, -1.0 / pivot, w->line, w->gather);
  w->at_z[w->var[a]] = -1;
  w->var[a] = k;
  w->at_z[k] = a;
}

/* w at place b enters, w_j leaves. */
static void replace_row(lcp_work *w, const lcp_problem *p, int b, int j) {
  double pivot = w->enter.dw[j];
  row_times_inverse(w, p, j);
  w->gather[b] -= 1.0;
  rank_one(w, -1.0 / pivot, w->enter.dz, w->gather);
  w->at_w[w->row[b]] = -1;
  w->row[b] = j;
  w->at_w[j] = b;
}

static void swap_columns(lcp_work *w, int a, int b) {
  if (a == b) return;
  cblas_dswap(w->s, w->K + a, w->cap, w->K + b, w->cap);
  int v = w->var[a];
  double z = w->z[a];
  w->var[a] = w->var[b];
  w->var[b] = v;
  w->z[a] = w->z[b];
  w->z[b] = z;
  w->at_z[w->var[a]] = a;
  w->at_z[w->var[b]] = b;
}

/* The w at place b enters, the z at place a leaves: P loses both. */
static void shrink(lcp_work *w, int b, int a) {
  int last = w->s - 1;
  size_t ld = w->cap;
  double pivot = w->enter.dz[a];
  cblas_dcopy(w->s, w->K + a, w->cap, w->gather, 1);
  COPY(w->line, w->K + b * ld, w->s);
  rank_one(w, -1.0 / pivot, w->line, w->gather);
  swap_columns(w, a, last);
  w->at_w[w->row[b]] = -1;
  if (b != last) {
    COPY(w->K + b * ld, w->K + last * ld, last);
    w->row[b] = w->row[last];
    w->at_w[w->row[b]] = b;
  }
  w->at_z[w->var[last]] = -1;
  w->s = last;
}

/* One change of basis: c leaves after "step". Sets the next entering one. */
static void lcp_pivot(lcp_work *w, const lcp_problem *p, int c, double step) {
  int k = w->enter.id, out = c < w->cap ? w->var[c] : -1 - (c - w->cap);
  int old_s = w->s;
  cblas_daxpy(w->s, step, w->enter.dz, 1, w->z, 1);
  cblas_daxpy(w->n, step, w->enter.dw, 1, w->w, 1);
  if (k >= 0 && out < 0) {
    border(w, p, k, -1 - out);
    w->z[old_s] = step;
    w->w[-1 - out] = 0.0;
  } else if (k >= 0) {
    replace_column(w, k, c);
    w->z[c] = step;
  } else if (out < 0) {
    replace_row(w, p, w->at_w[-1 - k], -1 - out);
    w->w[-1 - k] = step;
    w->w[-1 - out] = 0.0;
  } else {
    shrink(w, w->at_w[-1 - k], c);
    w->w[-1 - k] = step;
  }
  w->enter.id = -1 - out; /* the complement */
}

static const double SPOILT = 0x1p-38;   /* defect that requires a new inverse */
static const double NEAR_END = 0x1p-30; /* share of z0 that is made exact */
enum { REFRESH = 16 /* pivots from one new start of the values to the next */ };

status lcp_new(int n, int rank, lcp_work **out) {
  MAKES(lcp_work, w, out);
  int cap = w->cap = (rank < n ? rank : n) + 2;
  w->n = n;
  PASS_NEW_ALL(OF(w->K, (size_t)cap * cap), OF(w->P, (size_t)cap * cap),
               OF(w->lapack, cap), OF(w->swap, cap), OF(w->var, cap),
               OF(w->row, cap), OF(w->at_z, n + 1), OF(w->at_w, n),
               OF(w->z, cap), OF(w->w, n), OF(w->enter.dz, cap),
               OF(w->enter.dw, n), OF(w->enter.lz, cap), OF(w->enter.lw, n),
               OF(w->gather, cap), OF(w->line, cap), OF(w->column, n),
               OF(w->q, n), OF(w->tie, n + cap), OF(w->key, n + cap));
  return OK;
}

/* Nothing basic but w. The lexicographic first row: the last of the least. */
static int start(lcp_work *w, const lcp_problem *p) {
  w->n = p->n;
  double size = lcp_largest(w->n, p->q), least = 0.0;
  int exponent = 0, row = -1;
  if (size > 0.0) frexp(size, &exponent);
  w->power = ldexp(1.0, exponent);
  w->s = 0;
  for (int i = 0; i < w->n; ++i) {
    w->at_z[i] = w->at_w[i] = -1;
    w->w[i] = w->q[i] = p->q[i] / w->power;
    if (p->d[i] > 0.0) least = fmin(least, w->q[i] / p->d[i]);
  }
  w->at_z[w->n] = -1;
  for (int i = 0; i < w->n && least < 0.0; ++i)
    if (p->d[i] > 0.0 && w->q[i] / p->d[i] <= least * (1.0 - TIE)) row = i;
  return row;
}

static void bring_in_z0(lcp_work *w, const lcp_problem *p, int row) {
  double z0 = -w->q[row] / p->d[row];
  w->s = 1;
  w->var[0] = w->n;
  w->row[0] = row;
  w->at_z[w->n] = w->at_w[row] = 0;
  w->K[0] = w->size_K = 1.0 / p->d[row];
  w->z[0] = w->z0_start = z0;
  cblas_daxpy(w->n, z0, p->d, 1, w->w, 1);
  w->w[row] = 0.0;
  w->enter.id = row;
}

/* A new inverse and values from it; RUNNING, or CONVERGED if they show that
 * z0 is zero (a degenerate end: z0 stays basic). */
static outcome renew(lcp_work *w, const lcp_problem *p) {
  if (!lcp_invert(w, p)) return STOPPED_SINGULAR;
  lcp_refresh(w, p);
  double noise = ROUNDING * w->size_K * fmax(1.0, lcp_largest(w->s, w->z));
  double zero = lcp_zero(TIE, w->z0_start, noise);
  return w->at_z[w->n] >= 0 && w->z[0] > zero ? RUNNING : CONVERGED;
}

/* One pivot; RUNNING: continue. *age: pivots since the last new inverse. */
static outcome advance(lcp_work *w, const lcp_problem *p, lcp_report *rep,
                       int *age) {
  double step, defect = lcp_direction(w, p);
  if (isnan(defect)) return STOPPED_NAN;
  int c = *age == 0 || defect <= SPOILT ? lcp_leaving(w, p, &step) : -1;
  if (c < 0 && *age == 0) return STOPPED_RAY;
  if (c < 0) {
    *age = 0;
    return renew(w, p);
  }
  lcp_pivot(w, p, c, step);
  ++rep->pivots;
  ++*age;
  int done = w->at_z[w->n] < 0;
  if (p->each != NULL)
    p->each(p->ctx, rep->pivots, done ? 0.0 : w->z[0] * w->power);
  if (done || w->z[0] <= NEAR_END * w->z0_start) {
    *age = 0;
    return renew(w, p);
  }
  if (*age % REFRESH == 0) lcp_refresh(w, p);
  return RUNNING;
}

void lcp_run(lcp_work *w, const lcp_problem *p, lcp_report *rep) {
  int limit = p->max_pivots, age = 0;
  if (limit <= 0) limit = 50 * p->n > 5000 ? 50 * p->n : 5000;
  rep->pivots = 0;
  rep->outcome = CONVERGED;
  int row = start(w, p);
  for (int i = 0; i < w->n; ++i)
    if (!isfinite(w->q[i])) rep->outcome = STOPPED_NAN;
  if (row < 0 || rep->outcome != CONVERGED) return;
  bring_in_z0(w, p, row);
  rep->outcome = RUNNING;
  rep->pivots = 1;
  if (p->each != NULL) p->each(p->ctx, 1, w->z[0] * w->power);
  while (rep->outcome == RUNNING)
    if (rep->pivots >= limit)
      rep->outcome = STOPPED_ITERATIONS;
    else
      rep->outcome = advance(w, p, rep, &age);
}

void lcp_values(const lcp_work *w, double *z) {
  CLEAR(z, w->n);
  for (int a = 0; a < w->s; ++a)
    if (w->var[a] < w->n && w->z[a] > 0.0) z[w->var[a]] = w->z[a] * w->power;
}

double lcp_ray(const lcp_work *w, double *y) {
  double y0 = 0.0;
  CLEAR(y, w->n);
  for (int a = 0; a < w->s; ++a)
    if (w->var[a] == w->n)
      y0 = w->enter.dz[a];
    else
      y[w->var[a]] = fmax(w->enter.dz[a], 0.0);
  if (w->enter.id >= 0 && w->enter.id < w->n) y[w->enter.id] = 1.0;
  return y0;
}

int lcp_row_is_tight(const lcp_work *w, int i) { return w->at_w[i] >= 0; }

void lcp_correction(lcp_work *w, const double *defect, double *dz) {
  CLEAR(dz, w->n);
  for (int b = 0; b < w->s; ++b) w->gather[b] = -defect[w->row[b]];
  lcp_apply_inverse(w, w->gather, w->line);
  for (int a = 0; a < w->s; ++a)
    if (w->var[a] < w->n) dz[w->var[a]] = w->line[a];
}
