/*
 * Complementary pivoting with a reduced inverse (lcp.h).
 *
 * Basic are: the z of the list "var" (z0 is number n), and the w of every row
 * not in the list "row". Both lists have s entries; with P = [M d](row, var)
 * and K = inv(P)
 *
 *   z_var = -K q_row,   w_i = q_i + [M d](i, var) z_var   for the other i.
 *
 * The variable that left last names the next one to enter, its complement. A
 * pivot adds, replaces or removes one row and one column of P; K follows by a
 * rank-one change. Lexicographic rule: q is thought of as q + (e, e^2, ...)
 * with an infinitesimal e; only the columns of the inverse that are needed to
 * tell the tied rows apart are formed.
 *
 * basis.c has the inverse, leaving.c the rule, pivot.c the change of basis,
 * plain.c the form with a dense matrix.
 */
#include "solver/lcp/lcp.h"

#include "base/memory.h"
#include "solver/lcp/parts.h"

#include <cblas.h>
#include <math.h>
#include <string.h>

static const double SPOILT = 0x1p-38;   /* defect that calls for an inverse  */
static const double NEAR_END = 0x1p-30; /* share of z0 that is made exact    */
enum { REFRESH = 16 /* pivots from one new start of the values to the next */ };

void lcp_free(lcp_work *w) {
  if (w == NULL) return;
  RELEASE(w->K, w->P, w->lapack, w->swap, w->var, w->row, w->at_z, w->at_w,
          w->z, w->w, w->dz, w->dw, w->lz, w->lw, w->gather, w->line, w->column,
          w->q, w->tie, w->key, w);
}

status lcp_new(int n, int rank, lcp_work **out) {
  status st = OK;
  lcp_work *w = NULL;
  NEW(w, 1);
  int cap = w->cap = (rank < n ? rank : n) + 2;
  w->n = n;
  NEW(w->K, (size_t)cap * (size_t)cap);
  NEW(w->P, (size_t)cap * (size_t)cap);
  NEW(w->lapack, cap);
  NEW(w->swap, cap);
  NEW(w->var, cap);
  NEW(w->row, cap);
  NEW(w->at_z, n + 1);
  NEW(w->at_w, n);
  NEW(w->z, cap);
  NEW(w->w, n);
  NEW(w->dz, cap);
  NEW(w->dw, n);
  NEW(w->lz, cap);
  NEW(w->lw, n);
  NEW(w->gather, cap);
  NEW(w->line, cap);
  NEW(w->column, n);
  NEW(w->q, n);
  NEW(w->tie, n + cap);
  NEW(w->key, n + cap);
  *out = w;
  w = NULL;
done:
  lcp_free(w);
  return st;
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
  w->entering = row;
}

/* A new inverse and values from it; RUNNING, or CONVERGED if they show that
 * z0 is zero (a degenerate end: z0 stays basic). */
static outcome renew(lcp_work *w, const lcp_problem *p, lcp_report *rep) {
  if (!lcp_invert(w, p, rep)) return STOPPED_SINGULAR;
  lcp_refresh(w, p);
  double noise = ROUNDING * w->size_K * fmax(1.0, lcp_largest(w->s, w->z));
  double zero = lcp_zero(TIE, w->z0_start, noise);
  return w->at_z[w->n] >= 0 && w->z[0] > zero ? RUNNING : CONVERGED;
}

/* One pivot; RUNNING: go on. *age: pivots since the last new inverse. */
static outcome advance(lcp_work *w, const lcp_problem *p, lcp_report *rep,
                       int *age) {
  double step, defect = lcp_direction(w, p);
  if (isnan(defect)) return STOPPED_NAN;
  int c = *age == 0 || defect <= SPOILT ? lcp_leaving(w, p, &step) : -1;
  if (c < 0 && *age == 0) return STOPPED_RAY;
  if (c < 0) {
    *age = 0;
    return renew(w, p, rep);
  }
  lcp_pivot(w, p, c, step);
  ++rep->pivots;
  ++*age;
  int done = w->at_z[w->n] < 0;
  if (p->each != NULL)
    p->each(p->ctx, rep->pivots, done ? 0.0 : w->z[0] * w->power);
  if (done || w->z[0] <= NEAR_END * w->z0_start) {
    *age = 0;
    return renew(w, p, rep);
  }
  if (*age % REFRESH == 0) lcp_refresh(w, p);
  return RUNNING;
}

void lcp_run(lcp_work *w, const lcp_problem *p, lcp_report *rep) {
  int limit = p->max_pivots, age = 0;
  if (limit <= 0) limit = 50 * p->n > 5000 ? 50 * p->n : 5000;
  rep->pivots = rep->factorings = 0;
  rep->outcome = CONVERGED;
  int row = start(w, p);
  for (int i = 0; i < w->n; ++i)
    if (!isfinite(w->q[i])) rep->outcome = STOPPED_NAN;
  if (row < 0 || rep->outcome != CONVERGED) return;
  bring_in_z0(w, p, row);
  rep->outcome = RUNNING;
  rep->pivots = 1;
  if (p->each != NULL) p->each(p->ctx, 1, w->z[0] * w->power);
  while (rep->outcome == RUNNING) {
    if (rep->pivots >= limit)
      rep->outcome = STOPPED_ITERATIONS;
    else
      rep->outcome = advance(w, p, rep, &age);
  }
}

void lcp_values(const lcp_work *w, double *z) {
  memset(z, 0, (size_t)w->n * sizeof *z);
  for (int a = 0; a < w->s; ++a)
    if (w->var[a] < w->n && w->z[a] > 0.0) z[w->var[a]] = w->z[a] * w->power;
}

double lcp_ray(const lcp_work *w, double *y) {
  double y0 = 0.0;
  memset(y, 0, (size_t)w->n * sizeof *y);
  for (int a = 0; a < w->s; ++a) {
    if (w->var[a] == w->n)
      y0 = w->dz[a];
    else
      y[w->var[a]] = fmax(w->dz[a], 0.0);
  }
  if (w->entering >= 0 && w->entering < w->n) y[w->entering] = 1.0;
  return y0;
}

int lcp_row_is_tight(const lcp_work *w, int i) { return w->at_w[i] >= 0; }

void lcp_correction(lcp_work *w, const double *defect, double *dz) {
  memset(dz, 0, (size_t)w->n * sizeof *dz);
  for (int b = 0; b < w->s; ++b) w->gather[b] = -defect[w->row[b]];
  lcp_apply_inverse(w, w->gather, w->line);
  for (int a = 0; a < w->s; ++a)
    if (w->var[a] < w->n) dz[w->var[a]] = w->line[a];
}
