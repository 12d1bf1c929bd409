/*
 * The inverse of the basis, the values of the basic variables and their change
 * (lcp.c): formed by it, and put right once by the rows themselves.
 */
#include "solver/lcp/parts.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <string.h>

static const double DRIFT = 0x1p-48; /* defect that calls for a correction  */

void lcp_expand(lcp_work *w, const lcp_problem *p, const double *x,
                double *to) {
  int z0 = w->at_z[w->n], s = w->s;
  if (z0 < 0) {
    p->product(p->ctx, s, w->var, x, to);
    return;
  }
  p->product(p->ctx, s - 1, w->var + 1, x + 1, to);
  cblas_daxpy(w->n, x[0], p->d, 1, to, 1);
}

void lcp_row_of(const lcp_work *w, const lcp_problem *p, int i, double *to) {
  int skip = w->at_z[w->n] < 0 ? 0 : 1;
  if (skip) to[0] = p->d[i];
  p->row(p->ctx, i, w->s - skip, w->var + skip, to + skip);
}

void lcp_apply_inverse(const lcp_work *w, const double *x, double *to) {
  cblas_dgemv(CblasColMajor, CblasNoTrans, w->s, w->s, 1.0, w->K, w->cap, x, 1,
              0.0, to, 1);
}

double lcp_largest(int n, const double *x) {
  return n > 0 ? fabs(x[cblas_idamax(n, x, 1)]) : 0.0;
}

static void measure_inverse(lcp_work *w) {
  w->size_K = 0.0;
  for (int b = 0; b < w->s; ++b)
    w->size_K =
        fmax(w->size_K, lcp_largest(w->s, w->K + (size_t)b * (size_t)w->cap));
}

double lcp_refresh(lcp_work *w, const lcp_problem *p) {
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
  measure_inverse(w);
  return defect / size;
}

int lcp_invert(lcp_work *w, const lcp_problem *p, lcp_report *rep) {
  int s = w->s;
  ++rep->factorings;
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

double lcp_direction(lcp_work *w, const lcp_problem *p) {
  int s = w->s, k = w->entering, enters_z = k >= 0;
  double defect = 0.0, first = 0.0, size = 1.0, one = 1.0;
  if (enters_z) {
    p->product(p->ctx, 1, &k, &one, w->column);
    for (int b = 0; b < s; ++b) w->gather[b] = -w->column[w->row[b]];
    lcp_apply_inverse(w, w->gather, w->dz);
  } else {
    memcpy(w->dz, w->K + (size_t)w->at_w[-1 - k] * (size_t)w->cap,
           (size_t)s * sizeof *w->dz);
  }
  for (int pass = 0; pass < 2; ++pass) {
    lcp_expand(w, p, w->dz, w->dw);
    if (enters_z) cblas_daxpy(w->n, 1.0, w->column, 1, w->dw, 1);
    if (!enters_z) w->dw[-1 - k] -= 1.0;
    defect = 0.0;
    size = fmax(1.0, lcp_largest(s, w->dz));
    for (int b = 0; b < s; ++b) {
      w->gather[b] = w->dw[w->row[b]];
      if (!(fabs(w->gather[b]) <= defect)) defect = fabs(w->gather[b]);
    }
    if (pass == 0) first = defect / size;
    if (pass == 1 || defect <= DRIFT * size) break;
    lcp_apply_inverse(w, w->gather, w->line);
    for (int a = 0; a < s; ++a) w->dz[a] -= w->line[a];
  }
  for (int b = 0; b < s; ++b) w->dw[w->row[b]] = 0.0;
  return first;
}
