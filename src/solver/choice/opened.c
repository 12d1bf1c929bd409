/* Contact without friction from the closed state (opened.h). */
#include "solver/choice/opened.h"

#include "base/memory.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <string.h>

enum { STEPS = 20, SHARE = 2 };       /* of the nodes: most that open */
static const double MARGIN = 0x1p-46; /* -, of the scale: no change of state */

struct opened {
  tangent_factor by;
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

status opened_new(const contact_problem *cp, const tangent_factor *by,
                  opened **out) {
  status st = OK;
  opened *o = NULL;
  NEW(o, 1);
  o->by = *by;
  o->n = cp->n;
  o->dim = cp->dim;
  o->nt = cp->m - cp->n;
  NEW(o->made, o->n);
  NEW(o->column, cp->n);
  NEW(o->Y, (size_t)o->nt * (size_t)o->n);
  NEW(o->S, (size_t)o->n * (size_t)o->n);
  NEW(o->F, (size_t)o->n * (size_t)o->n);
  NEW(o->v, o->n);
  NEW(o->open, cp->n);
  NEW(o->is_open, cp->n);
  NEW(o->u0, cp->m);
  NEW(o->r0, cp->m);
  NEW(o->du, cp->m);
  NEW(o->dr, cp->m);
  NEW(o->y, o->nt);
  for (int i = 0; i < cp->n; ++i) o->column[i] = -1;
  *out = o;
  o = NULL;
done:
  opened_free(o);
  return st;
}

void opened_free(opened *o) {
  if (o == NULL) return;
  void *const blocks[] = {o->made, o->column, o->Y,       o->S,  o->F,
                          o->v,    o->open,   o->is_open, o->u0, o->r0,
                          o->du,   o->dr,     o->y};
  for (size_t i = 0; i < sizeof blocks / sizeof *blocks; ++i)
    memory_free(blocks[i]);
  memory_free(o);
}

status opened_keep(opened *o, archive *a) {
  size_t capacity = (size_t)o->n;
  PASS(archive_ints(a, "n_made", &o->n_made, 1));
  if (o->n_made < 0 || o->n_made > o->n)
    RAISE(ERR_FILE, "the restart file is damaged: columns have other sizes");
  PASS(archive_ints(a, "made", o->made, capacity));
  PASS(archive_ints(a, "column", o->column, (size_t)o->n));
  PASS(archive_reals(a, "Y", o->Y, (size_t)o->nt * (size_t)o->n_made));
  return archive_reals(a, "S", o->S, capacity * capacity);
}

/* Number i of the tangential unknowns. */
static size_t tangent_dof(const opened *o, int i) {
  return (size_t)(i / (o->dim - 1) * o->dim + 1 + i % (o->dim - 1));
}

/* u_t that carry no force when the others are u: -inv(A_tt) r_t, added. */
static void release_tangents(opened *o, const double *r, double *u) {
  for (int i = 0; i < o->nt; ++i) o->y[i] = -o->by.power * r[tangent_dof(o, i)];
  LAPACKE_dpotrs_work(LAPACK_COL_MAJOR, 'L', o->nt, 1, o->by.L, o->nt, o->y,
                      o->nt);
  for (int i = 0; i < o->nt; ++i) u[tangent_dof(o, i)] += o->y[i];
}

static void close_all(opened *o, const contact_problem *cp) {
  memset(o->u0, 0, (size_t)cp->m * sizeof *o->u0);
  for (int i = 0; i < cp->n; ++i) o->u0[i * cp->dim] = cp->gap[i];
  contact_reaction(cp, o->u0, o->r0);
  release_tangents(o, o->r0, o->u0);
  contact_reaction(cp, o->u0, o->r0);
}

/* ---- columns ------------------------------------------------------------- */

/* Of the open nodes that have none. */
static void make_columns(opened *o, const contact_problem *cp) {
  int first = o->n_made, nt = o->nt, capacity = o->n;
  size_t m = (size_t)cp->m;
  for (int a = 0; a < o->n_open; ++a) {
    if (o->column[o->open[a]] >= 0) continue;
    o->column[o->open[a]] = o->n_made;
    o->made[o->n_made] = o->open[a];
    const double *column = cp->A + m * (size_t)(o->open[a] * o->dim);
    double *to = o->Y + (size_t)nt * (size_t)o->n_made++;
    for (int i = 0; i < nt; ++i)
      to[i] = o->by.power * column[tangent_dof(o, i)];
  }
  int fresh = o->n_made - first;
  if (fresh == 0) return;
  double *Y = o->Y + (size_t)nt * (size_t)first;
  cblas_dtrsm(CblasColMajor, CblasLeft, CblasLower, CblasNoTrans, CblasNonUnit,
              nt, fresh, 1.0, o->by.L, nt, Y, nt);
  for (int b = first; b < o->n_made; ++b)
    for (int a = 0; a < o->n_made; ++a)
      o->S[(size_t)a + (size_t)capacity * (size_t)b] =
          cp->A[(size_t)(o->made[a] * o->dim) +
                m * (size_t)(o->made[b] * o->dim)];
  cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, o->n_made, fresh, nt,
              -1.0 / o->by.power, o->Y, nt, Y, nt, 1.0,
              o->S + (size_t)capacity * (size_t)first, capacity);
  for (int b = first; b < o->n_made; ++b)
    for (int a = 0; a < first; ++a)
      o->S[(size_t)b + (size_t)capacity * (size_t)a] =
          o->S[(size_t)a + (size_t)capacity * (size_t)b];
}

/* ---- steps --------------------------------------------------------------- */

/* v of the open nodes, S_OO v = -r0; 0: S is not definite. */
static int open_up(opened *o) {
  int n = o->n_open;
  for (int b = 0; b < n; ++b) {
    const double *column = o->S + (size_t)o->n * (size_t)o->column[o->open[b]];
    for (int a = b; a < n; ++a)
      o->F[(size_t)a + (size_t)n * (size_t)b] =
          o->by.power * column[o->column[o->open[a]]];
    o->v[b] = -o->by.power * o->r0[o->open[b] * o->dim];
  }
  if (n == 0) return 1;
  if (LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'L', n, o->F, n) != 0) return 0;
  LAPACKE_dpotrs_work(LAPACK_COL_MAJOR, 'L', n, 1, o->F, n, o->v, n);
  return 1;
}

/* du, dr of v. */
static void displace(opened *o, const contact_problem *cp) {
  size_t m = (size_t)cp->m, bytes = m * sizeof *o->du;
  memset(o->du, 0, bytes);
  memset(o->dr, 0, bytes);
  if (o->n_open == 0) return;
  for (int a = 0; a < o->n_open; ++a) {
    size_t dof = (size_t)(o->open[a] * o->dim);
    o->du[dof] = o->v[a];
    cblas_daxpy(cp->m, o->v[a], cp->A + m * dof, 1, o->dr, 1);
  }
  release_tangents(o, o->dr, o->du);
  contact_product(cp->m, cp->A, o->du, o->dr);
}

/* The next guess; returns the number of changes, *worst: the largest violation,
 * N.
 */
static int next_states(opened *o, const contact_problem *cp, double margin,
                       double *worst) {
  int changes = 0;
  *worst = 0.0;
  for (int i = 0; i < o->n; ++i) {
    size_t dof = (size_t)(i * o->dim);
    double wrong = o->is_open[i] ? cp->A[dof * (size_t)cp->m + dof] * o->du[dof]
                                 : o->r0[dof] + o->dr[dof];
    *worst = fmax(*worst, wrong);
    if (!(wrong > margin)) continue;
    o->is_open[i] = !o->is_open[i];
    ++changes;
  }
  return changes;
}

static void list_open(opened *o) {
  o->n_open = 0;
  for (int i = 0; i < o->n; ++i)
    if (o->is_open[i]) o->open[o->n_open++] = i;
}

static void begin(opened *o, const contact_problem *cp, const double *u,
                  const double *r) {
  for (int i = 0; i < cp->n; ++i) {
    size_t dof = (size_t)(i * cp->dim);
    double over = cp->A[dof * (size_t)cp->m + dof] * (u[dof] - cp->gap[i]);
    o->is_open[i] = !(r[dof] <= over) && !(r[dof] == 0.0 && u[dof] == 0.0);
  }
}

/* The solution into u, r; tensile forces are set to zero. */
static void finish(const opened *o, const contact_problem *cp, double *u,
                   double *r) {
  memset(r, 0, (size_t)cp->m * sizeof *r);
  for (int i = 0; i < cp->m; ++i) u[i] = o->u0[i] + o->du[i];
  for (int i = 0; i < cp->n; ++i)
    if (!o->is_open[i])
      r[i * cp->dim] = fmin(o->r0[i * cp->dim] + o->dr[i * cp->dim], 0.0);
}

void opened_solve(opened *o, const contact_problem *cp,
                  const solver_control *control, double *u, double *r,
                  solver_report *rep) {
  double scale = contact_scale(cp), worst = 0.0;
  double margin = solver_few_digits(control->tol) ? 0.5 * control->tol : MARGIN;
  *rep =
      (solver_report){.outcome = STOPPED_UNFIT, .solver = newton_solver.name};
  begin(o, cp, u, r);
  close_all(o, cp);
  int asked = control->max_iter, most = STEPS;
  if (asked > 0 && asked < most) most = asked;
  while (rep->iterations < most) {
    list_open(o);
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
