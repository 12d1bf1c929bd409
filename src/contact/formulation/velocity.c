/*
 * The velocity form of an increment (CPR98, problem N3, 3.38-3.39): the unknown
 * is the displacement du of the increment itself,
 *
 *   A du = R + r,  R = f - A u_old    residual of the last equilibrium under
 *                                     the new load
 *   du in K:       du_n <= gap - u_old_n
 *   |r_t| <= g, slip against du_t = d           d: step of the obstacle, else 0
 *
 * with the sliding limit g = g0 + B p of the total forces, as in N2. Solved in
 * these variables and added to u_old.
 */
#include "contact/formulation/form.h"

#include "base/memory.h"

struct velocity_form {
  double *u_old;          /* [m] the last equilibrium, m */
  double *R;              /* [m] residual, N */
  double *gap, *side, *d; /* [n], [n*(dim-1)] twice: bounds and step of the
                             obstacle (of a held unknown: of its support), m */
  double *du;             /* [m] the unknown, m */
};

status velocity_form_new(const contact_problem *cp, velocity_form **out) {
  status st = OK;
  velocity_form *v = NULL;
  int tangents = cp->n * (cp->dim - 1);
  NEW(v, 1);
  NEW(v->u_old, cp->m);
  NEW(v->R, cp->m);
  NEW(v->gap, cp->n);
  NEW(v->side, tangents);
  NEW(v->d, tangents);
  NEW(v->du, cp->m);
  *out = v;
  v = NULL;
done:
  velocity_form_free(v);
  return st;
}

void velocity_form_free(velocity_form *v) {
  if (v == NULL) return;
  RELEASE(v->u_old, v->R, v->gap, v->side, v->d, v->du, v);
}

double *velocity_form_old(velocity_form *v) { return v->u_old; }

/* The convex set of the increment. */
static void set_bounds(velocity_form *v, const contact_problem *cp) {
  for (int i = 0; i < cp->n; ++i) {
    v->gap[i] = cp->gap[i] - v->u_old[cp->dim * i];
    for (int a = 1; a < cp->dim && cp->side_gap != NULL; ++a) {
      int s = (cp->dim - 1) * i + a - 1;
      v->side[s] = cp->side_gap[s] - v->u_old[cp->dim * i + a];
    }
  }
}

/* Its position of stick: zero, unless the obstacle or the support moves. */
static void set_stick(velocity_form *v, const contact_problem *cp) {
  for (int i = 0; i < cp->n; ++i)
    for (int a = 1; a < cp->dim; ++a) {
      int s = (cp->dim - 1) * i + a - 1;
      v->d[s] = cp->ut0[s] - v->u_old[cp->dim * i + a];
    }
}

void velocity_form_set(velocity_form *v, const contact_problem *cp,
                       contact_problem *out, double **u) {
  contact_product(cp->m, cp->A, v->u_old, v->R);
  for (int k = 0; k < cp->m; ++k) v->R[k] = cp->f[k] - v->R[k];
  set_bounds(v, cp);
  if (cp->ut0 != NULL) set_stick(v, cp);
  for (int k = 0; k < cp->m; ++k) v->du[k] = (*u)[k] - v->u_old[k];
  *out = *cp;
  out->f = v->R;
  out->gap = v->gap;
  if (cp->ut0 != NULL) out->ut0 = v->d;
  if (cp->side_gap != NULL) out->side_gap = v->side;
  *u = v->du;
}

/* u_old + du; on a bound or at stick without the rounding of the sum. */
static double sum_of(const velocity_form *v, const contact_problem *cp, int i,
                     int a) {
  int s = (cp->dim - 1) * i + a - 1;
  double du = v->du[cp->dim * i + a], sum = v->u_old[cp->dim * i + a] + du;
  if (a == 0) return du == v->gap[i] ? cp->gap[i] : sum;
  if (cp->side_gap != NULL && du == v->side[s]) return cp->side_gap[s];
  if (cp->ut0 != NULL && du == v->d[s]) return cp->ut0[s];
  return sum;
}

void velocity_form_apply(const velocity_form *v, const contact_problem *cp,
                         double *u) {
  for (int i = 0; i < cp->n; ++i)
    for (int a = 0; a < cp->dim; ++a) u[cp->dim * i + a] = sum_of(v, cp, i, a);
}
