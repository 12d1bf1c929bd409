/* Other form and normal form (form.h). */
#include "solver/choice/form.h"

#include "base/memory.h"
#include "solver/newton/dense.h"

#include <cblas.h>
#include <lapacke.h>
#include <stdio.h>
#include <string.h>

static const double SYMMETRIC = 0x1p-40; /* -, of the largest diagonal */
static const double OWN_SHARE = 0.5; /* of the tolerance, in the normal form */

static void multiply(size_t size, double a, double *M) {
  for (size_t i = 0; i < size; ++i) M[i] *= a;
}

int form_invert(int m, dense *d) {
  size_t size = (size_t)m * (size_t)m;
  double power = dense_power(m, d->a);
  d->n = m;
  d->full = !dense_is_symmetric(m, d->a, SYMMETRIC / power);
  multiply(size, power, d->a);
  if (!dense_factor(d, 1) || !dense_invert(d)) return 0;
  multiply(size, power, d->a);
  return 1;
}

status other_form_make(const contact_problem *cp, other_form *o) {
  status st = OK;
  dense d = {0};
  int m = cp->m;
  const double *M = cp->A != NULL ? cp->A : cp->W;
  if (o->matrix != NULL || o->missing) goto done;
  o->missing = cp->floating;
  if (o->missing) goto done;
  NEW(o->load, m);
  TRY(dense_new(m, &d));
  memcpy(d.a, M, (size_t)m * (size_t)m * sizeof *M);
  o->missing = !form_invert(m, &d);
  if (o->missing) goto done;
  o->matrix = d.a;
  d.a = NULL;
done:
  dense_free(&d);
  return st;
}

void other_form_free(other_form *o) {
  RELEASE(o->matrix, o->load);
  *o = (other_form){0};
}

/* ---- normal form --------------------------------------------------------- */

int normal_form_applies(const contact_problem *cp) {
  return cp->g0 == NULL && cp->side_gap == NULL && cp->held == NULL &&
         !cp->floating && cp->dim > 1 && cp->A != NULL;
}

void normal_form_free(normal_form *nf) {
  if (nf->work != NULL) newton_solver.release(nf->work);
  opened_free(nf->opened);
  double *const arrays[] = {nf->L, nf->Y, nf->S, nf->f, nf->u, nf->r, nf->y};
  for (size_t i = 0; i < sizeof arrays / sizeof *arrays; ++i)
    memory_free(arrays[i]);
  *nf = (normal_form){0};
}

/* Unknown number i of the tangential ones. */
static size_t tangent_dof(int dim, int i) {
  return (size_t)(i / (dim - 1) * dim + 1 + i % (dim - 1));
}

/* L of the lower triangle; 0: not positive definite. Where A is not symmetric
 * the result does not solve the problem, which the residual shows. */
static int factor_tangents(normal_form *nf, const contact_problem *cp) {
  int nt = cp->m - cp->n, d = cp->dim;
  size_t m = (size_t)cp->m;
  nf->power = dense_power(cp->m, cp->A);
  for (int j = 0; j < nt; ++j) {
    const double *column = cp->A + m * tangent_dof(d, j);
    for (int i = j; i < nt; ++i)
      nf->L[(size_t)i + (size_t)nt * (size_t)j] =
          nf->power * column[tangent_dof(d, i)];
  }
  return LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'L', nt, nf->L, nt) == 0;
}

/* Y and S. */
static void condense_tangents(normal_form *nf, const contact_problem *cp) {
  int n = cp->n, nt = cp->m - n, d = cp->dim;
  size_t m = (size_t)cp->m;
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
  dense_mirror(n, nf->S);
}

static status factor(normal_form *nf, const contact_problem *cp) {
  size_t nt = (size_t)(cp->m - cp->n);
  if (nf->L != NULL) return OK;
  PASS_NEW(nf->L, nt * nt);
  PASS_NEW(nf->y, cp->m);
  nf->missing = !factor_tangents(nf, cp);
  return OK;
}

static status condense_form(normal_form *nf, const contact_problem *cp) {
  size_t n = (size_t)cp->n, nt = (size_t)cp->m - n;
  if (nf->S != NULL) return OK;
  PASS_NEW(nf->S, n * n);
  PASS_NEW(nf->Y, nt * n);
  PASS_NEW(nf->f, n);
  PASS_NEW(nf->u, n);
  PASS_NEW(nf->r, n);
  condense_tangents(nf, cp);
  return OK;
}

/* f of the problem in S; y = inv(L) f_t is stored for settle. */
static void set_load(normal_form *nf, const contact_problem *cp) {
  int n = cp->n, nt = cp->m - n, d = cp->dim;
  for (int i = 0; i < n; ++i) nf->f[i] = cp->f[i * d];
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
  there = nf->opened != NULL;
  TRY(archive_ints(a, "opened", &there, 1));
  if (there) TRY(opened_keep(nf->opened, a));
done:
  archive_leave(a);
  return st;
}

/* Open the group of the saved data; *there = 1: the named array exists. */
static status remember(const normal_form *nf, const char *name, int *there) {
  *there = 0;
  if (nf->from == NULL) return OK;
  archive_go(nf->from, nf->group);
  return archive_ints(nf->from, name, there, 1);
}

status normal_form_opened(normal_form *nf, const contact_problem *cp,
                          const solver_control *control, double *u, double *r,
                          solver_report *rep) {
  status st = OK;
  int there = 0;
  *rep = (solver_report){.outcome = STOPPED_UNFIT};
  if (!nf->missing) TRY(factor(nf, cp));
  if (nf->missing) goto done;
  if (nf->opened == NULL) {
    tangent_factor by = {nf->L, nf->power};
    TRY(opened_new(cp, &by, &nf->opened));
    TRY(remember(nf, "opened", &there));
    if (there) TRY(opened_keep(nf->opened, nf->from));
  }
  opened_solve(nf->opened, cp, control, u, r, rep);
done:
  if (nf->from != NULL) archive_go(nf->from, "");
  return st;
}

status normal_form_solve(normal_form *nf, const contact_problem *cp,
                         const solver_control *control, double *u, double *r,
                         solver_report *rep) {
  status st = OK;
  double param[8] = {0.0};
  int there = 0;
  *rep = (solver_report){.outcome = RUNNING, .solver = "newton"};
  if (!nf->missing) TRY(factor(nf, cp));
  if (nf->missing) goto done;
  TRY(condense_form(nf, cp));
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
    TRY(remember(nf, "work", &there));
    if (there) TRY(newton_solver.keep(nf->work, nf->from));
  }
  TRY(newton_solver.solve(&own, param, nf->work, &tighter, nf->u, nf->r, rep));
  rep->solver = "newton";
  if (rep->outcome == CONVERGED) settle(nf, cp, u, r);
done:
  if (nf->from != NULL) archive_go(nf->from, "");
  return st;
}
