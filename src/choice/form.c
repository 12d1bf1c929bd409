/* Other form and normal form (form.h). */
#include "choice/form.h"

#include "base/memory.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { TILE = 32 };
static const double INVERSE_RCOND = 1e-13; /* -, below: no inverse            */
static const double SUSPECT = 0x1p-20; /* -, smallest over largest pivot      */
static const double SYMMETRIC = 0x1p-40; /* -, of the largest diagonal      */
static const double OWN_SHARE = 0.5; /* of the tolerance, in the normal form  */

/* The upper triangle from the lower. */
static void mirror(size_t m, double *M) {
  for (size_t j0 = 0; j0 < m; j0 += TILE)
    for (size_t i0 = j0; i0 < m; i0 += TILE)
      for (size_t j = j0; j < m && j < j0 + TILE; ++j)
        for (size_t i = i0 > j ? i0 : j + 1; i < m && i < i0 + TILE; ++i)
          M[j + m * i] = M[i + m * j];
}

static int is_symmetric(size_t m, const double *M) {
  double largest = 0.0, apart = 0.0;
  for (size_t i = 0; i < m; ++i) largest = fmax(largest, M[i + m * i]);
  for (size_t j0 = 0; j0 < m; j0 += TILE)
    for (size_t i0 = j0; i0 < m; i0 += TILE)
      for (size_t j = j0; j < m && j < j0 + TILE; ++j)
        for (size_t i = i0 > j ? i0 : j + 1; i < m && i < i0 + TILE; ++i)
          apart = fmax(apart, fabs(M[i + m * j] - M[j + m * i]));
  return apart <= SYMMETRIC * largest;
}

double form_power(size_t m, const double *M) {
  double largest = 0.0;
  int exponent = 0;
  for (size_t i = 0; i < m; ++i) largest = fmax(largest, M[i + m * i]);
  if (largest > 0.0 && largest < HUGE_VAL) frexp(largest, &exponent);
  return ldexp(1.0, -exponent);
}

static void multiply(size_t size, double a, double *M) {
  for (size_t i = 0; i < size; ++i) M[i] *= a;
}

/* 1: the pivots of the factor leave doubt, and so does the condition. */
static int is_singular(int m, const double *L, double norm, double *work,
                       int *iwork) {
  double least = HUGE_VAL, most = 0.0, rcond = 0.0;
  for (size_t i = 0; i < (size_t)m; ++i) {
    least = fmin(least, L[i + (size_t)m * i]);
    most = fmax(most, L[i + (size_t)m * i]);
  }
  if (least * least > SUSPECT * most * most) return 0;
  LAPACKE_dpocon_work(LAPACK_COL_MAJOR, 'L', m, L, m, norm, &rcond, work,
                      iwork);
  return !(rcond > INVERSE_RCOND);
}

int form_invert(int m, double *M, double *work, int *iwork) {
  size_t size = (size_t)m * (size_t)m;
  double power = form_power((size_t)m, M);
  multiply(size, power, M);
  double norm = LAPACKE_dlansy_work(LAPACK_COL_MAJOR, '1', 'L', m, M, m, work);
  if (LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'L', m, M, m) != 0) return 0;
  if (is_singular(m, M, norm, work, iwork)) return 0;
  if (LAPACKE_dpotri_work(LAPACK_COL_MAJOR, 'L', m, M, m) != 0) return 0;
  mirror((size_t)m, M);
  multiply(size, power, M);
  return 1;
}

/* inv(M) in place by LU; 0: singular to rounding. pivot, iwork [m], work [4m]
 */
static int invert_any(int m, double *M, double *work, int *pivot, int *iwork) {
  double rcond = 0.0;
  double norm = LAPACKE_dlange_work(LAPACK_COL_MAJOR, '1', m, m, M, m, work);
  if (LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, m, m, M, m, pivot) != 0) return 0;
  LAPACKE_dgecon_work(LAPACK_COL_MAJOR, '1', m, M, m, norm, &rcond, work,
                      iwork);
  if (!(rcond > INVERSE_RCOND)) return 0;
  return LAPACKE_dgetri_work(LAPACK_COL_MAJOR, m, M, m, pivot, work, 4 * m) ==
         0;
}

status other_form_make(const contact_problem *cp, other_form *o) {
  status st = OK;
  int *pivot = NULL, m = cp->m;
  double *work = NULL;
  const double *M = cp->A != NULL ? cp->A : cp->W;
  size_t size = (size_t)m * (size_t)m;
  if (o->matrix != NULL || o->missing) goto done;
  o->missing = cp->floating;
  if (o->missing) goto done;
  NEW(o->load, m);
  NEW(pivot, 2 * m);
  NEW(work, 4 * m);
  NEW(o->matrix, size);
  memcpy(o->matrix, M, size * sizeof *M);
  o->missing = is_symmetric((size_t)m, M)
                   ? !form_invert(m, o->matrix, work, pivot)
                   : !invert_any(m, o->matrix, work, pivot, pivot + m);
  if (o->missing) {
    memory_free(o->matrix);
    o->matrix = NULL;
  }
done:
  memory_free(pivot);
  memory_free(work);
  return st;
}

void other_form_free(other_form *o) {
  memory_free(o->matrix);
  memory_free(o->load);
  *o = (other_form){0};
}

/* ---- normal form --------------------------------------------------------- */

int normal_form_applies(const contact_problem *cp) {
  return cp->g0 == NULL && cp->side_gap == NULL && cp->held == NULL &&
         !cp->floating && cp->dim > 1;
}

void normal_form_free(normal_form *nf) {
  if (nf->work != NULL) newton_solver.release(nf->work);
  double *const arrays[] = {nf->L, nf->Y, nf->S,   nf->f,
                            nf->u, nf->r, nf->gap, nf->y};
  for (size_t i = 0; i < sizeof arrays / sizeof *arrays; ++i)
    memory_free(arrays[i]);
  *nf = (normal_form){0};
}

/* Unknown number i of the tangential ones. */
static size_t tangent_dof(int dim, int i) {
  return (size_t)(i / (dim - 1) * dim + 1 + i % (dim - 1));
}

/* S of a stiffness; 0: it is not symmetric, or A_tt not positive definite. */
static int condense_stiffness(normal_form *nf, const contact_problem *cp) {
  int n = cp->n, nt = cp->m - n, d = cp->dim;
  size_t m = (size_t)cp->m;
  if (!is_symmetric(m, cp->A)) return 0;
  nf->power = form_power(m, cp->A);
  for (int j = 0; j < nt; ++j) {
    const double *column = cp->A + m * tangent_dof(d, j);
    for (int i = j; i < nt; ++i)
      nf->L[(size_t)i + (size_t)nt * (size_t)j] =
          nf->power * column[tangent_dof(d, i)];
  }
  if (LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'L', nt, nf->L, nt) != 0) return 0;
  for (int j = 0; j < n; ++j) {
    const double *column = cp->A + m * (size_t)(j * d);
    for (int i = 0; i < nt; ++i)
      nf->Y[(size_t)i + (size_t)nt * (size_t)j] =
          nf->power * column[tangent_dof(d, i)];
    for (int i = 0; i < n; ++i)
      nf->S[(size_t)i + (size_t)n * (size_t)j] = column[i * d];
  }
  cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasNoTrans, CblasNonUnit,
              nt, n, 1.0, nf->L, nt, nf->Y, nt);
  cblas_dsyrk(CblasColMajor, CblasLower, CblasTrans, n, nt, -1.0 / nf->power,
              nf->Y, nt, 1.0, nf->S, n);
  mirror((size_t)n, nf->S);
  return 1;
}

/* S of a compliance: inv(W_nn); 0: W_nn is not positive definite. work [3n],
 * iwork [n] */
static int invert_compliance(normal_form *nf, const contact_problem *cp,
                             double *work, int *iwork) {
  size_t n = (size_t)cp->n, m = (size_t)cp->m, d = (size_t)cp->dim;
  for (size_t j = 0; j < n; ++j)
    for (size_t i = 0; i < n; ++i) nf->S[i + n * j] = cp->W[i * d + m * j * d];
  if (!is_symmetric(n, nf->S)) return 0;
  return form_invert(cp->n, nf->S, work, iwork);
}

static status set_up(normal_form *nf, const contact_problem *cp) {
  status st = OK;
  size_t n = (size_t)cp->n, nt = (size_t)cp->m - n;
  double *work = NULL;
  int *iwork = NULL;
  NEW(nf->S, n * n);
  NEW(nf->f, n);
  NEW(nf->u, n);
  NEW(nf->r, n);
  NEW(nf->gap, n);
  NEW(nf->y, cp->m);
  NEW(work, 3 * n);
  NEW(iwork, n);
  if (cp->A != NULL) {
    NEW(nf->L, nt * nt);
    NEW(nf->Y, nt * n);
    nf->missing = !condense_stiffness(nf, cp);
  } else {
    nf->missing = !invert_compliance(nf, cp, work, iwork);
  }
done:
  memory_free(work);
  memory_free(iwork);
  return st;
}

/* f of the problem in S; y = inv(L) f_t is kept for settle. */
static void set_load(normal_form *nf, const contact_problem *cp) {
  int n = cp->n, nt = cp->m - n, d = cp->dim;
  for (int i = 0; i < n; ++i) nf->f[i] = cp->f[i * d];
  if (cp->A == NULL) {
    memcpy(nf->y, nf->f, (size_t)n * sizeof *nf->y);
    contact_product(n, nf->S, nf->y, nf->f);
    return;
  }
  for (int i = 0; i < nt; ++i) nf->y[i] = nf->power * cp->f[tangent_dof(d, i)];
  cblas_dtrsv(CblasColMajor, CblasLower, CblasNoTrans, CblasNonUnit, nt, nf->L,
              nt, nf->y, 1);
  cblas_dgemv(CblasColMajor, CblasTrans, nt, n, -1.0 / nf->power, nf->Y, nt,
              nf->y, 1, 1.0, nf->f, 1);
}

/* All unknowns from the normal ones. */
static void settle(const normal_form *nf, const contact_problem *cp, double *u,
                   double *r) {
  int n = cp->n, nt = cp->m - n, d = cp->dim;
  memset(r, 0, (size_t)cp->m * sizeof *r);
  for (int i = 0; i < n; ++i) r[i * d] = nf->r[i];
  if (cp->A == NULL) {
    contact_product(cp->m, cp->W, r, u);
    cblas_daxpy(cp->m, 1.0, cp->f, 1, u, 1);
    return;
  }
  cblas_dgemv(CblasColMajor, CblasNoTrans, nt, n, -1.0, nf->Y, nt, nf->u, 1,
              1.0, nf->y, 1);
  cblas_dtrsv(CblasColMajor, CblasLower, CblasTrans, CblasNonUnit, nt, nf->L,
              nt, nf->y, 1);
  for (int i = 0; i < n; ++i) u[i * d] = nf->u[i];
  for (int i = 0; i < nt; ++i) u[tangent_dof(d, i)] = nf->y[i];
}

status normal_form_keep(normal_form *nf, archive *a) {
  status st = OK;
  archive_enter(a, "normal");
  TRY(archive_ints(a, "wanted", &nf->wanted, 1));
  if (archive_reads(a)) {
    nf->from = a;
    snprintf(nf->group, sizeof nf->group, "%s", archive_group(a));
    goto done;
  }
  int there = nf->work != NULL;
  TRY(archive_ints(a, "work", &there, 1));
  if (there) TRY(newton_solver.keep(nf->work, a));
done:
  archive_leave(a);
  return st;
}

/* A work that is new takes over what it is to remember. */
static status remember(normal_form *nf) {
  status st = OK;
  int there = 0;
  if (nf->from == NULL) return OK;
  archive_go(nf->from, nf->group);
  TRY(archive_ints(nf->from, "work", &there, 1));
  if (there) TRY(newton_solver.keep(nf->work, nf->from));
done:
  archive_go(nf->from, "");
  return st;
}

status normal_form_solve(normal_form *nf, const contact_problem *cp,
                         const solver_control *control, double *u, double *r,
                         solver_report *rep) {
  status st = OK;
  double param[8] = {0.0};
  *rep = (solver_report){.outcome = RUNNING, .solver = "newton"};
  if (nf->S == NULL && !nf->missing) TRY(set_up(nf, cp));
  if (nf->missing) goto done;
  contact_problem own = {
      .dim = 1, .n = cp->n, .m = cp->n, .A = nf->S, .f = nf->f, .gap = cp->gap};
  solver_control tighter = *control;
  tighter.tol *= OWN_SHARE;
  set_load(nf, cp);
  for (int i = 0; i < cp->n; ++i) {
    nf->u[i] = u[i * cp->dim];
    nf->r[i] = r[i * cp->dim];
  }
  option_defaults(newton_solver.options, param);
  if (nf->work == NULL) {
    TRY(newton_solver.setup(&own, param, &nf->work));
    TRY(remember(nf));
  }
  TRY(newton_solver.solve(&own, param, nf->work, &tighter, nf->u, nf->r, rep));
  rep->solver = "newton";
  if (rep->outcome == CONVERGED) settle(nf, cp, u, r);
done:
  return st;
}
