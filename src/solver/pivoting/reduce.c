/*
 * The matrix of the unknowns kept: the tangents without friction eliminated,
 * node by node scaled.
 */
#include "solver/pivoting/parts.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <string.h>

static const double SINGULAR = 1e-13; /* -, of the largest eigenvalue         */

static void gather(const lemke_run *s, int n_row, const int *row, int n_col,
                   const int *col, double *to) {
  for (int j = 0; j < n_col; ++j) {
    const double *from = s->M + (size_t)col[j] * (size_t)s->cp->m;
    double *column = to + (size_t)j * (size_t)n_row;
    for (int i = 0; i < n_row; ++i) column[i] = from[row[i]];
  }
}

/* inner = inv(A_FF); 0: singular. */
static int invert_free(lemke_run *s) {
  lemke_work *w = s->w;
  int n = w->n_free;
  gather(s, n, w->free_id, n, w->free_id, w->inner);
  return LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, n, n, w->inner, n, w->pivot) ==
             0 &&
         LAPACKE_dgetri_work(LAPACK_COL_MAJOR, n, w->inner, n, w->pivot,
                             w->work, 4 * w->m) == 0;
}

/* inner = pseudo-inverse of A_FF: motions that nothing resists stay out. */
static int pseudo_invert_free(lemke_run *s) {
  lemke_work *w = s->w;
  int n = w->n_free;
  size_t ld = (size_t)n;
  gather(s, n, w->free_id, n, w->free_id, w->spare);
  if (LAPACKE_dsyev_work(LAPACK_COL_MAJOR, 'V', 'L', n, w->spare, n, w->t,
                         w->work, 4 * w->m + 4) != 0)
    return 0;
  memset(w->inner, 0, ld * ld * sizeof *w->inner);
  for (size_t k = 0; k < ld; ++k)
    if (w->t[k] > SINGULAR * w->t[n - 1])
      cblas_dger(CblasColMajor, n, n, 1.0 / w->t[k], w->spare + k * ld, 1,
                 w->spare + k * ld, 1, w->inner, n);
  return 1;
}

int lemke_reduce(lemke_run *s) {
  lemke_work *w = s->w;
  int nk = w->n_kept, nf = w->n_free;
  gather(s, nk, w->kept, nk, w->kept, w->S);
  if (!lemke_is_stiff(s)) w->n_free = nf = 0;
  if (nf == 0) return 1;
  if (!(s->cp->floating ? pseudo_invert_free(s) : invert_free(s))) return 0;
  double *X = w->inner + (size_t)nf * (size_t)nf;
  for (int j = 0; j < nk; ++j) {
    gather(s, nf, w->free_id, 1, &w->kept[j], w->t);
    contact_product(nf, w->inner, w->t, X + (size_t)j * (size_t)nf);
  }
  for (int k = 0; k < nf; ++k) {
    gather(s, nk, w->kept, 1, &w->free_id[k], w->t);
    cblas_dger(CblasColMajor, nk, nk, -1.0, w->t, 1, X + k, nf, w->S, nk);
  }
  return 1;
}

void lemke_scale(lemke_run *s) {
  lemke_work *w = s->w;
  int dim = s->cp->dim, nk = w->n_kept, top = 0;
  double largest = 0.0;
  for (int i = 0; i < s->cp->n; ++i) w->D[i] = 0.0;
  for (int i = 0; i < nk; ++i) {
    double a = w->S[(size_t)i * (size_t)nk + (size_t)i];
    double *D = w->D + w->kept[i] / dim;
    *D = fmax(*D, a);
    largest = fmax(largest, a);
  }
  if (largest > 0.0 && largest < HUGE_VAL) frexp(largest, &top);
  w->unit = ldexp(1.0, -top);
  for (int i = 0; i < s->cp->n; ++i) {
    int exponent = top;
    if (w->D[i] > 0x1p-60 * largest) frexp(w->D[i], &exponent);
    w->D[i] = ldexp(1.0, (top - exponent) / 2);
  }
  for (int j = 0; j < nk; ++j)
    for (int i = 0; i < nk; ++i)
      w->S[(size_t)j * (size_t)nk + (size_t)i] *=
          w->unit * w->D[w->kept[i] / dim] * w->D[w->kept[j] / dim];
}
