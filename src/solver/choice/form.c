/* Other form and normal form (choice.h). */
#include "solver/choice/choice.h"

#include <cblas.h>
#include <lapacke.h>

/* ---- Contact without friction from the closed state --------------------- */

static const double SYMMETRIC = 0x1p-40; /* -, of the largest diagonal */
static const double NOISE = 0x1p-48; /* -, times m: of it, may be rounding */
static const double OWN_SHARE = 0.5; /* of the tolerance, in the normal form */

double form_scale(int m, const double *diagonal, double *scale) {
  double largest = 0.0;
  int first = 0;
  for (int i = 0; i < m; ++i) largest = fmax(largest, diagonal[i]);
  frexp(largest, &first);
  for (int i = 0; i < m; ++i) {
    int power = 0;
    frexp(fmax(diagonal[i], m * NOISE * largest), &power);
    scale[i] = ldexp(1.0, (first - power) / 2);
  }
  return ldexp(1.0, -first);
}

void form_apply_scale(int m, double power, const double *scale, double *M) {
  const size_t n = m;
  for (size_t j = 0; j < n; ++j) cblas_dscal(m, power * scale[j], M + n * j, 1);
  for (size_t i = 0; i < n; ++i)
    if (scale[i] != 1.0) cblas_dscal(m, scale[i], M + i, m);
}

status form_invert(int m, dense *d, int *good) {
  OWNED_NEW(double, scale, m);
  d->n = m;
  for (int i = 0; i < m; ++i) d->work[i] = d->a[(size_t)i * (m + 1)];
  const double power = form_scale(m, d->work, scale);
  d->full = !dense_is_symmetric(m, d->a, SYMMETRIC / power);
  form_apply_scale(m, power, scale, d->a);
  *good = dense_factor(d, 1) && dense_invert(d);
  if (*good) form_apply_scale(m, power, scale, d->a);
  return OK;
}

status other_form_make(const contact_problem *cp, other_form *o) {
  ENDS_BY(dense_free) dense d = {0};
  int m = cp->m, good = 0;
  if (o->matrix != NULL || o->missing) return OK;
  o->missing = cp->floating;
  if (o->missing) return OK;
  PASS_NEW(o->load, m);
  PASS(dense_new(m, &d));
  contact_dense(cp, d.a);
  PASS(form_invert(m, &d, &good));
  o->missing = !good;
  if (o->missing) return OK;
  o->matrix = d.a;
  d.a = NULL;
  return OK;
}

/*
 * Contact without friction from the state with every node closed.
 *
 * With v = u_n - gap and r0 the normal forces of the closed state, the normal
 * form is S v = r - r0: v = 0 where closed, r = 0 where open. Only the
 * part S_EE of the nodes E that have been open is made, from columns inv(L)
 * A_tE that are kept while the matrix is unchanged; the forces of the others
 * follow from a product with A. Guess and correction as in NEWTON (primal-dual
 * active set).
 */
/* Unknown number i of the tangential ones. */
static size_t tangent_dof(int dim, int i) {
  return i / (dim - 1) * dim + 1 + i % (dim - 1);
}

enum { STEPS = 20, SHARE = 2 };       /* of the nodes: most that open */
static const double MARGIN = 0x1p-46; /* -, of the scale: no change of state */

struct opened {
  const double *L; /* [nt*nt] borrowed: A_tt = L L'/power */
  double power;    /* of two */
  int n, nt, dim;
  int n_made, *made;      /* [n] nodes with a column */
  int *column;            /* [n] of a node, or -1 */
  double *Y;              /* [nt*n] inv(L) power A_t,made */
  double *S;              /* [n*n] of the nodes made */
  double *F, *v;          /* [n*n], [n] of the open nodes */
  int n_open, *open;      /* [n] */
  unsigned char *is_open; /* [n] */
  double *u0, *r0;        /* [m] every node closed */
  double *du, *dr;        /* [m] from there */
  double *y;              /* [nt] */
};

static status opened_new(const contact_problem *cp, const normal_form *nf,
                         opened **out) {
  MAKES(opened, o, out);
  o->L = nf->L;
  o->power = nf->power;
  o->n = cp->n;
  o->dim = cp->dim;
  o->nt = cp->m - cp->n;
  PASS_NEW_ALL(OF(o->made, o->n), OF(o->column, cp->n),
               OF(o->Y, (size_t)o->nt * o->n), OF(o->S, (size_t)o->n * o->n),
               OF(o->F, (size_t)o->n * o->n), OF(o->v, o->n),
               OF(o->open, cp->n), OF(o->is_open, cp->n), OF(o->u0, cp->m),
               OF(o->r0, cp->m), OF(o->du, cp->m), OF(o->dr, cp->m),
               OF(o->y, o->nt));
  for (int i = 0; i < cp->n; ++i) o->column[i] = -1;
  return OK;
}

/* The columns made so far, saved or read. */
static status opened_keep(opened *o, archive *a) {
  size_t capacity = o->n;
  PASS(archive_ints(a, "n_made", &o->n_made, 1));
  if (o->n_made < 0 || o->n_made > o->n)
    RAISE(ERR_FILE, "the restart file is damaged: columns have other sizes");
  PASS(archive_ints(a, "made", o->made, capacity));
  PASS(archive_ints(a, "column", o->column, o->n));
  PASS(archive_reals(a, "Y", o->Y, (size_t)o->nt * o->n_made));
  return archive_reals(a, "S", o->S, capacity * capacity);
}

/* u_t that carry no force when the others are u: -inv(A_tt) r_t, added. */
static void release_tangents(opened *o, const double *r, double *u) {
  for (int i = 0; i < o->nt; ++i)
    o->y[i] = -o->power * r[tangent_dof(o->dim, i)];
  LAPACKE_dpotrs_work(LAPACK_COL_MAJOR, 'L', o->nt, 1, o->L, o->nt, o->y,
                      o->nt);
  for (int i = 0; i < o->nt; ++i) u[tangent_dof(o->dim, i)] += o->y[i];
}

/* ---- columns ------------------------------------------------------------- */

/* Of the open nodes that have none. */
static void make_columns(opened *o, const contact_problem *cp) {
  int first = o->n_made, nt = o->nt, capacity = o->n;
  size_t m = cp->m;
  for (int a = 0; a < o->n_open; ++a) {
    if (o->column[o->open[a]] >= 0) continue;
    o->column[o->open[a]] = o->n_made;
    o->made[o->n_made] = o->open[a];
    const double *column = cp->A + m * (o->open[a] * o->dim);
    double *to = o->Y + (size_t)nt * o->n_made++;
    for (int i = 0; i < nt; ++i)
      to[i] = o->power * column[tangent_dof(o->dim, i)];
  }
  int fresh = o->n_made - first;
  if (fresh == 0) return;
  double *Y = o->Y + (size_t)nt * first;
  cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasNoTrans, CblasNonUnit,
              nt, fresh, 1.0, o->L, nt, Y, nt);
  for (int b = first; b < o->n_made; ++b)
    for (int a = 0; a < o->n_made; ++a)
      o->S[a + (size_t)capacity * b] =
          cp->A[o->made[a] * o->dim + m * (o->made[b] * o->dim)];
  cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, o->n_made, fresh, nt,
              -1.0 / o->power, o->Y, nt, Y, nt, 1.0,
              o->S + (size_t)capacity * first, capacity);
  for (int b = first; b < o->n_made; ++b)
    for (int a = 0; a < first; ++a)
      o->S[b + (size_t)capacity * a] = o->S[a + (size_t)capacity * b];
}

/* ---- steps --------------------------------------------------------------- */

/* v of the open nodes, S_OO v = -r0; 0: S is not definite. */
static int open_up(opened *o) {
  int n = o->n_open;
  for (int b = 0; b < n; ++b) {
    const double *column = o->S + (size_t)o->n * o->column[o->open[b]];
    for (int a = b; a < n; ++a)
      o->F[a + (size_t)n * b] = o->power * column[o->column[o->open[a]]];
    o->v[b] = -o->power * o->r0[o->open[b] * o->dim];
  }
  if (n == 0) return 1;
  if (LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'L', n, o->F, n) != 0) return 0;
  LAPACKE_dpotrs_work(LAPACK_COL_MAJOR, 'L', n, 1, o->F, n, o->v, n);
  return 1;
}

/* du, dr of v. */
static void displace(opened *o, const contact_problem *cp) {
  size_t m = cp->m, bytes = m * sizeof *o->du;
  memset(o->du, 0, bytes);
  memset(o->dr, 0, bytes);
  if (o->n_open == 0) return;
  for (int a = 0; a < o->n_open; ++a) {
    size_t dof = o->open[a] * o->dim;
    o->du[dof] = o->v[a];
    cblas_daxpy(cp->m, o->v[a], cp->A + m * dof, 1, o->dr, 1);
  }
  release_tangents(o, o->dr, o->du);
  contact_product(cp->m, cp->A, o->du, o->dr);
}

/* The next guess; returns the number of changes, *worst: the largest violation,
 * N. */
static int next_states(opened *o, const contact_problem *cp, double margin,
                       double *worst) {
  int changes = 0;
  *worst = 0.0;
  for (int i = 0; i < o->n; ++i) {
    size_t dof = i * o->dim;
    double wrong = o->is_open[i] ? contact_diagonal(cp, (int)dof) * o->du[dof]
                                 : o->r0[dof] + o->dr[dof];
    *worst = fmax(*worst, wrong);
    if (!(wrong > margin)) continue;
    o->is_open[i] = !o->is_open[i];
    ++changes;
  }
  return changes;
}

static void begin(opened *o, const contact_problem *cp, const double *u,
                  const double *r) {
  for (int i = 0; i < cp->n; ++i) {
    size_t dof = i * cp->dim;
    double over = contact_diagonal(cp, (int)dof) * (u[dof] - cp->gap[i]);
    o->is_open[i] = !(r[dof] <= over) && !(r[dof] == 0.0 && u[dof] == 0.0);
  }
}

/* The solution into u, r; tensile forces are set to zero. */
static void finish(const opened *o, const contact_problem *cp, double *u,
                   double *r) {
  CLEAR(r, cp->m);
  for (int i = 0; i < cp->m; ++i) u[i] = o->u0[i] + o->du[i];
  for (int i = 0; i < cp->n; ++i)
    if (!o->is_open[i])
      r[i * cp->dim] = fmin(o->r0[i * cp->dim] + o->dr[i * cp->dim], 0.0);
}

/* Solve from the states of u[m], r[m], both zero: all closed. rep->outcome
 * CONVERGED, or STOPPED_UNFIT: the guesses do not converge; u, r are then
 * unchanged. */
static void opened_solve(opened *o, const contact_problem *cp,
                         const solver_control *control, double *u, double *r,
                         solver_report *rep) {
  double scale = contact_scale(cp), worst = 0.0;
  double margin = solver_few_digits(control->tol) ? 0.5 * control->tol : MARGIN;
  *rep =
      (solver_report){.outcome = STOPPED_UNFIT, .solver = newton_solver.name};
  begin(o, cp, u, r);
  CLEAR(o->u0, cp->m);
  for (int i = 0; i < cp->n; ++i) o->u0[i * cp->dim] = cp->gap[i];
  contact_reaction(cp, o->u0, o->r0);
  release_tangents(o, o->r0, o->u0);
  contact_reaction(cp, o->u0, o->r0);
  int asked = control->max_iter, most = STEPS;
  if (asked > 0 && asked < most) most = asked;
  while (rep->iterations < most) {
    o->n_open = 0;
    for (int i = 0; i < o->n; ++i)
      if (o->is_open[i]) o->open[o->n_open++] = i;
    make_columns(o, cp);
    if (!open_up(o)) return;
    displace(o, cp);
    int changes = next_states(o, cp, margin * scale, &worst);
    ++rep->iterations;
    solver_report_states(control, rep->solver, rep->iterations,
                         scale > 0.0 ? worst / scale : 0.0, changes, 0);
    if (isnan(worst)) return;
    if (changes > 0) continue;
    finish(o, cp, u, r);
    rep->outcome = CONVERGED;
    return;
  }
}

/* ---- normal form --------------------------------------------------------- */

int normal_form_applies(const contact_problem *cp) {
  return cp->g0 == NULL && cp->side_gap == NULL && cp->held == NULL &&
         !cp->floating && cp->dim > 1 && cp->A != NULL;
}

void normal_form_free(normal_form *nf) {
  RELEASE(nf->work, nf->opened, nf->L, nf->Y, nf->S, nf->f, nf->u, nf->r,
          nf->y);
  *nf = (normal_form){0};
}

/* L of the lower triangle; 0: not positive definite. Where A is not symmetric
 * the result does not solve the problem, which the residual shows. */
static int factor_tangents(normal_form *nf, const contact_problem *cp) {
  int nt = cp->m - cp->n, d = cp->dim;
  size_t m = cp->m;
  nf->power = dense_power(cp->m, cp->A);
  for (int j = 0; j < nt; ++j) {
    const double *column = cp->A + m * tangent_dof(d, j);
    for (int i = j; i < nt; ++i)
      nf->L[i + (size_t)nt * j] = nf->power * column[tangent_dof(d, i)];
  }
  return LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'L', nt, nf->L, nt) == 0;
}

/* Y and S. */
static void condense_tangents(normal_form *nf, const contact_problem *cp) {
  int n = cp->n, nt = cp->m - n, d = cp->dim;
  size_t m = cp->m;
  for (int j = 0; j < n; ++j) {
    const double *column = cp->A + m * (j * d);
    for (int i = 0; i < nt; ++i)
      nf->Y[i + (size_t)nt * j] = nf->power * column[tangent_dof(d, i)];
    for (int i = 0; i < n; ++i) nf->S[i + (size_t)n * j] = column[i * d];
  }
  cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasNoTrans, CblasNonUnit,
              nt, n, 1.0, nf->L, nt, nf->Y, nt);
  cblas_dsyrk(CblasColMajor, CblasLower, CblasTrans, n, nt, -1.0 / nf->power,
              nf->Y, nt, 1.0, nf->S, n);
  dense_mirror(n, nf->S);
}

static status factor(normal_form *nf, const contact_problem *cp) {
  size_t nt = cp->m - cp->n;
  if (nf->L != NULL) return OK;
  PASS_NEW_ALL(OF(nf->L, nt * nt), OF(nf->y, cp->m));
  nf->missing = !factor_tangents(nf, cp);
  return OK;
}

static status condense_form(normal_form *nf, const contact_problem *cp) {
  size_t n = cp->n, nt = cp->m - n;
  if (nf->S != NULL) return OK;
  PASS_NEW_ALL(OF(nf->S, n * n), OF(nf->Y, nt * n), OF(nf->f, n), OF(nf->u, n),
               OF(nf->r, n));
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
  CLEAR(r, cp->m);
  for (int i = 0; i < n; ++i) r[i * d] = nf->r[i];
  cblas_dgemv(CblasColMajor, CblasNoTrans, nt, n, -1.0, nf->Y, nt, nf->u, 1,
              1.0, nf->y, 1);
  cblas_dtrsv(CblasColMajor, CblasLower, CblasTrans, CblasNonUnit, nt, nf->L,
              nt, nf->y, 1);
  for (int i = 0; i < n; ++i) u[i * d] = nf->u[i];
  for (int i = 0; i < nt; ++i) u[tangent_dof(d, i)] = nf->y[i];
}

status normal_form_keep(normal_form *nf, archive *a) {
  IN_GROUP(a, "normal");
  PASS(archive_ints(a, "wanted", &nf->wanted, 1));
  if (archive_reads(a)) {
    nf->from = a;
    snprintf(nf->group, sizeof nf->group, "%s", archive_group(a));
    return OK;
  }
  int there = nf->work != NULL;
  PASS(archive_ints(a, "work", &there, 1));
  if (there) PASS(newton_solver.keep(nf->work, a));
  there = nf->opened != NULL;
  PASS(archive_ints(a, "opened", &there, 1));
  return there ? opened_keep(nf->opened, a) : OK;
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
    TRY(opened_new(cp, nf, &nf->opened));
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
    TRY(solver_set_up(&newton_solver, &own, param, &nf->work));
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
