/*
 * The adjoint of a contact problem at its solution (goal.h).
 */
#include "accuracy/goal/goal.h"

#include "accuracy/accuracy.h"
#include "base/memory.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <string.h>

struct contact_adjoint {
  const contact_problem *cp;
  const double *u, *r;          /* [m] borrowed */
  int n_free, *free_id, *place; /* [m] free unknowns; their place or -1 */
  unsigned char *closed, *slip; /* [n] */
  double *e;          /* [m] direction of the friction force on slip */
  double *kappa;      /* [n] N/m */
  double *M;          /* [n_free^2] its factor */
  lapack_int *pivot;  /* [n_free] */
  double *w, *x, *Ax; /* [m] w of goal.h; workspace */
};

void contact_adjoint_free(contact_adjoint *a) {
  if (a == NULL) return;
  RELEASE(a->free_id, a->place, a->closed, a->slip, a->e, a->kappa, a->M,
          a->pivot, a->w, a->x, a->Ax, a);
}

/* Friction of node i: slip, e, kappa. */
static void set_friction(contact_adjoint *a, int i) {
  const contact_problem *cp = a->cp;
  const int first = i * cp->dim;
  const double g = contact_node_limit(cp, a->r, i);
  const double c = accuracy_stiffness(cp, i).t;
  double size = 0.0;
  for (int dof = first + 1; dof < first + cp->dim; ++dof) {
    if (!accuracy_rubs(cp, dof)) continue;
    a->e[dof] = a->r[dof] - c * (a->u[dof] - contact_stick(cp, dof));
    size = hypot(size, a->e[dof]);
  }
  a->slip[i] = size > g && g > 0.0;
  for (int dof = first + 1; dof < first + cp->dim; ++dof)
    a->e[dof] = a->slip[i] ? a->e[dof] / size : 0.0;
  if (a->slip[i]) a->kappa[i] = c * g / (size - g);
}

/* 1: the unknown can move. */
static int is_free(const contact_adjoint *a, int dof) {
  const contact_problem *cp = a->cp;
  const int i = dof / cp->dim;
  const double bound = contact_bound(cp, dof);
  if (contact_held(cp, dof)) return 0;
  if (bound < HUGE_VAL) {
    const node_stiffness c = accuracy_stiffness(cp, i);
    const double step = dof % cp->dim == 0 ? c.n : c.t;
    return !(a->r[dof] - step * (a->u[dof] - bound) < 0.0);
  }
  if (!accuracy_rubs(cp, dof)) return 1;
  return a->slip[i] || contact_node_limit(cp, a->r, i) == 0.0;
}

static void set_states(contact_adjoint *a) {
  const contact_problem *cp = a->cp;
  for (int i = 0; i < cp->n; ++i) set_friction(a, i);
  for (int dof = 0; dof < cp->m; ++dof) {
    const int moves = is_free(a, dof);
    a->place[dof] = moves ? a->n_free : -1;
    if (moves) a->free_id[a->n_free++] = dof;
    if (dof % cp->dim == 0) a->closed[dof / cp->dim] = !moves;
  }
}

/* Row of M of a sliding unknown: e B A_n + kappa (I - e e'). */
static void add_slip(contact_adjoint *a, int dof) {
  const contact_problem *cp = a->cp;
  const int i = dof / cp->dim, n = a->n_free;
  double *row = a->M + a->place[dof];
  for (int k = cp->B == NULL ? 0 : cp->B->start[i];
       cp->B != NULL && k < cp->B->start[i + 1]; ++k) {
    const int j = cp->B->col[k];
    if (!a->closed[j]) continue;
    const double *column =
        cp->A + (size_t)(j * cp->dim) * (size_t)cp->m; /* A is symmetric */
    for (int b = 0; b < n; ++b)
      row[(size_t)n * (size_t)b] +=
          a->e[dof] * cp->B->val[k] * column[a->free_id[b]];
  }
  for (int t = i * cp->dim + 1; cp->dim == 3 && t < (i + 1) * cp->dim; ++t)
    if (a->place[t] >= 0)
      row[(size_t)n * (size_t)a->place[t]] +=
          a->kappa[i] * ((t == dof) - a->e[dof] * a->e[t]);
}

/* 0: singular. */
static int factor(contact_adjoint *a) {
  const contact_problem *cp = a->cp;
  const size_t n = (size_t)a->n_free;
  for (size_t b = 0; b < n; ++b) {
    const double *column = cp->A + (size_t)cp->m * (size_t)a->free_id[b];
    for (size_t k = 0; k < n; ++k) a->M[k + n * b] = column[a->free_id[k]];
  }
  for (int k = 0; k < a->n_free; ++k) {
    const int dof = a->free_id[k];
    if (dof % cp->dim > 0 && a->slip[dof / cp->dim]) add_slip(a, dof);
  }
  return n == 0 || LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, a->n_free, a->n_free,
                                       a->M, a->n_free, a->pivot) == 0;
}

status contact_adjoint_new(const contact_problem *cp, const double *u,
                           const double *r, contact_adjoint **out) {
  status st = OK;
  contact_adjoint *a = NULL;
  *out = NULL;
  NEW(a, 1);
  a->cp = cp;
  a->u = u;
  a->r = r;
  NEW(a->free_id, cp->m);
  NEW(a->place, cp->m);
  NEW(a->closed, cp->n);
  NEW(a->slip, cp->n);
  NEW(a->e, cp->m);
  NEW(a->kappa, cp->n);
  NEW(a->w, cp->m);
  NEW(a->x, cp->m);
  NEW(a->Ax, cp->m);
  set_states(a);
  NEW(a->pivot, a->n_free);
  NEW(a->M, (size_t)a->n_free * (size_t)a->n_free);
  if (!factor(a)) goto done;
  *out = a;
  a = NULL;
done:
  contact_adjoint_free(a);
  return st;
}

/* 1: the force at the unknown can change with the solution. */
static int carries(const contact_adjoint *a, int dof) {
  const contact_problem *cp = a->cp;
  if (contact_held(cp, dof)) return 0;
  return a->place[dof] < 0 || (dof % cp->dim > 0 && a->slip[dof / cp->dim]);
}

/* w of the closed nodes from that of the sliding ones. */
static void spread_slip(contact_adjoint *a) {
  const contact_problem *cp = a->cp;
  for (int i = 0; i < cp->n && cp->B != NULL; ++i) {
    double along = 0.0;
    if (!a->slip[i]) continue;
    for (int t = i * cp->dim + 1; t < (i + 1) * cp->dim; ++t)
      if (a->place[t] >= 0) along += a->e[t] * a->w[t];
    for (int k = cp->B->start[i]; k < cp->B->start[i + 1]; ++k)
      if (a->closed[cp->B->col[k]])
        a->w[cp->B->col[k] * cp->dim] += cp->B->val[k] * along;
  }
}

/* Force of friction on a sliding unknown by its slip, N: opposite to it. */
static double friction_of(const contact_adjoint *a, int dof) {
  const contact_problem *cp = a->cp;
  const int i = dof / cp->dim;
  double size = 0.0;
  for (int t = i * cp->dim + 1; t < (i + 1) * cp->dim; ++t)
    if (accuracy_rubs(cp, t))
      size = hypot(size, a->u[t] - contact_stick(cp, t));
  if (!(size > 0.0)) return a->r[dof];
  return contact_node_limit(cp, a->r, i) *
         (contact_stick(cp, dof) - a->u[dof]) / size;
}

/* What each equation that (u, r) misses adds to J: that of equilibrium by y,
 * u = bound by the rest of the adjoint equation, the law of a force by w. */
static double misses(const contact_adjoint *a, const double *j,
                     const double *y) {
  const contact_problem *cp = a->cp;
  double sum = 0.0;
  contact_product(cp->m, cp->A, a->u, a->x);
  contact_product(cp->m, cp->A, y, a->Ax);
  for (int k = 0; k < cp->m; ++k) {
    const int i = k / cp->dim, tangent = k % cp->dim > 0;
    const int sticks = tangent && !(contact_bound(cp, k) < HUGE_VAL);
    if (contact_held(cp, k)) continue;
    sum += y[k] * (cp->f[k] + a->r[k] - a->x[k]);
    if (a->place[k] < 0)
      sum += (j[k] - a->Ax[k]) *
             ((sticks ? contact_stick(cp, k) : contact_bound(cp, k)) - a->u[k]);
    else if (tangent && a->slip[i])
      sum += a->w[k] * (friction_of(a, k) - a->r[k]);
    else
      sum -= a->w[k] * a->r[k];
  }
  return sum;
}

void contact_adjoint_solve(contact_adjoint *a, const double *j,
                           const double *psi, double *y, double *solver) {
  const contact_problem *cp = a->cp;
  for (int k = 0; k < cp->m; ++k) a->x[k] = carries(a, k) ? psi[k] : 0.0;
  contact_product(cp->m, cp->A, a->x, a->Ax);
  for (int k = 0; k < cp->m; ++k) y[k] = -a->x[k];
  memset(a->w, 0, (size_t)cp->m * sizeof *a->w);
  for (int k = 0; k < a->n_free; ++k)
    a->x[k] = j[a->free_id[k]] + a->Ax[a->free_id[k]];
  if (a->n_free > 0)
    LAPACKE_dgetrs_work(LAPACK_COL_MAJOR, 'T', a->n_free, 1, a->M, a->n_free,
                        a->pivot, a->x, a->n_free);
  for (int k = 0; k < a->n_free; ++k) a->w[a->free_id[k]] = a->x[k];
  spread_slip(a);
  for (int k = 0; k < cp->m; ++k) y[k] += a->w[k];
  *solver = misses(a, j, y);
}
