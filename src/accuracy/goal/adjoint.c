/* The adjoint of a contact problem at its solution (goal.h). */
#include "accuracy/goal/goal.h"

#include "accuracy/accuracy.h"
#include "accuracy/goal/linear.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

struct contact_adjoint {
  const contact_problem *cp;
  const double *u, *r;          /* [m] borrowed */
  int n_free, *free_id, *place; /* [m] free unknowns; their place or -1 */
  unsigned char *closed, *slip; /* [n] */
  double *e;        /* [m] direction of the friction force on slip */
  double *kappa;    /* [n] N/m */
  linear_rows rows; /* of all these */
  linear_system *linear;
  double *w, *x, *Ax; /* [m] w of goal.h; workspace */
  double *stick;      /* [m] derivative by the positions of stick */
};

void contact_adjoint_free(contact_adjoint *a) {
  if (a == NULL) return;
  linear_system_free(a->linear);
  RELEASE(a->free_id, a->place, a->closed, a->slip, a->e, a->kappa, a->w, a->x,
          a->Ax, a->stick, a);
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
  NEW_REALS(cp->m, &a->w, &a->x, &a->Ax, &a->stick);
  set_states(a);
  a->rows = (linear_rows){cp,        a->n_free, a->free_id, a->place,
                          a->closed, a->slip,   a->e,       a->kappa};
  TRY(linear_system_new(&a->rows, &a->linear));
  if (a->linear == NULL) goto done;
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

/* 1: it is held by friction where it sticks. */
static int sticks(const contact_adjoint *a, int dof) {
  return dof % a->cp->dim > 0 && a->place[dof] < 0 &&
         !contact_held(a->cp, dof) && !(contact_bound(a->cp, dof) < HUGE_VAL);
}

/* What each equation that (u, r) misses adds to J: that of equilibrium by y,
 * u = bound by the rest of the adjoint equation, the law of a force by w. */
static double misses(const contact_adjoint *a, const double *j,
                     const double *y) {
  const contact_problem *cp = a->cp;
  double sum = 0.0;
  contact_apply(cp, a->u, a->x);
  for (int k = 0; k < cp->m; ++k) {
    const int i = k / cp->dim, tangent = k % cp->dim > 0;
    if (contact_held(cp, k)) continue;
    sum += y[k] * (cp->f[k] + a->r[k] - a->x[k]);
    if (a->place[k] < 0)
      sum += (j[k] - a->Ax[k]) *
             ((sticks(a, k) ? contact_stick(cp, k) : contact_bound(cp, k)) -
              a->u[k]);
    else if (tangent && a->slip[i])
      sum += a->w[k] * (friction_of(a, k) - a->r[k]);
    else
      sum -= a->w[k] * a->r[k];
  }
  return sum;
}

/* Where a node sticks, the rest of the adjoint equation; in space slip turns
 * with it. */
static void set_stick(contact_adjoint *a, const double *j) {
  const contact_problem *cp = a->cp;
  memset(a->stick, 0, (size_t)cp->m * sizeof *a->stick);
  linear_add_turn(&a->rows, a->w, a->stick);
  for (int k = 0; k < cp->m; ++k)
    if (sticks(a, k)) a->stick[k] = j[k] - a->Ax[k];
}

const double *contact_adjoint_stick(const contact_adjoint *a) {
  return a->stick;
}

status contact_adjoint_solve(contact_adjoint *a, const double *j,
                             const double *psi, double *y, double *solver) {
  const contact_problem *cp = a->cp;
  for (int k = 0; k < cp->m; ++k) a->x[k] = carries(a, k) ? psi[k] : 0.0;
  contact_apply(cp, a->x, a->Ax);
  for (int k = 0; k < cp->m; ++k) y[k] = -a->x[k];
  for (int k = 0; k < cp->m; ++k)
    a->x[k] = a->place[k] < 0 ? 0.0 : j[k] + a->Ax[k];
  PASS(linear_solve_transposed(a->linear, a->x, a->w));
  for (int k = 0; k < cp->m; ++k) y[k] += a->w[k];
  contact_apply(cp, y, a->Ax);
  *solver = misses(a, j, y);
  set_stick(a, j);
  return OK;
}

status contact_adjoint_change(contact_adjoint *a, const double *df,
                              const double *stick, double *du) {
  const contact_problem *cp = a->cp;
  for (int k = 0; k < cp->m; ++k) {
    a->x[k] = df[k];
    du[k] = sticks(a, k) ? stick[k] : 0.0;
  }
  linear_add_friction(&a->rows, df, a->x);
  linear_add_turn(&a->rows, stick, a->x);
  return linear_solve(a->linear, a->x, du);
}
