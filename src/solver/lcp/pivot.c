/*
 * One change of basis: a row, a column or both of P come, go or are replaced,
 * and its inverse follows by a change of rank one (lcp.c).
 */
#include "solver/lcp/parts.h"

#include <cblas.h>
#include <math.h>
#include <string.h>

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
  size_t ld = (size_t)w->cap, last = (size_t)s;
  double pivot = w->dw[j];
  row_times_inverse(w, p, j);
  rank_one(w, -1.0 / pivot, w->dz, w->gather);
  for (size_t a = 0; a < last; ++a) {
    w->K[a + last * ld] = w->dz[a] / pivot;
    w->K[last + a * ld] = -w->gather[a] / pivot;
  }
  w->K[last + last * ld] = 1.0 / pivot;
  double edge =
      fmax(1.0, fmax(lcp_largest(s, w->dz), lcp_largest(s, w->gather)));
  w->size_K = fmax(w->size_K, edge / fabs(pivot));
  w->var[s] = k;
  w->row[s] = j;
  w->at_z[k] = w->at_w[j] = s;
  ++w->s;
}

/* z_k enters for the z at place a. */
static void replace_column(lcp_work *w, int k, int a) {
  double pivot = -w->dz[a];
  cblas_dcopy(w->s, w->K + a, w->cap, w->gather, 1);
  for (int i = 0; i < w->s; ++i) w->line[i] = -w->dz[i];
  w->line[a] -= 1.0;
  rank_one(w, -1.0 / pivot, w->line, w->gather);
  w->at_z[w->var[a]] = -1;
  w->var[a] = k;
  w->at_z[k] = a;
}

/* w at place b enters, w_j leaves. */
static void replace_row(lcp_work *w, const lcp_problem *p, int b, int j) {
  double pivot = w->dw[j];
  row_times_inverse(w, p, j);
  w->gather[b] -= 1.0;
  rank_one(w, -1.0 / pivot, w->dz, w->gather);
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
  size_t ld = (size_t)w->cap;
  double pivot = w->dz[a];
  cblas_dcopy(w->s, w->K + a, w->cap, w->gather, 1);
  memcpy(w->line, w->K + (size_t)b * ld, (size_t)w->s * sizeof *w->line);
  rank_one(w, -1.0 / pivot, w->line, w->gather);
  swap_columns(w, a, last);
  w->at_w[w->row[b]] = -1;
  if (b != last) {
    memcpy(w->K + (size_t)b * ld, w->K + (size_t)last * ld,
           (size_t)last * sizeof *w->K);
    w->row[b] = w->row[last];
    w->at_w[w->row[b]] = b;
  }
  w->at_z[w->var[last]] = -1;
  w->s = last;
}

void lcp_pivot(lcp_work *w, const lcp_problem *p, int c, double step) {
  int k = w->entering, out = c < w->cap ? w->var[c] : -1 - (c - w->cap);
  int old_s = w->s;
  cblas_daxpy(w->s, step, w->dz, 1, w->z, 1);
  cblas_daxpy(w->n, step, w->dw, 1, w->w, 1);
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
  w->entering = -1 - out; /* the complement */
}
