/*
 * The velocity form of an increment (CPR98, problem N3, 3.38-3.39): the unknown
 * is the displacement du of the increment itself,
 *
 *   A du = R + r,            R = f - A u_old    residual of the last
 * equilibrium du in K:  du_n <= gap - u_old_n             under the new load
 *   |r_t| <= g, slip against du_t = d           d: step of the obstacle, else 0
 *
 * with the sliding limit g = g0 + B p of the total forces, as in N2. Solved in
 * these variables and added to u_old.
 */
#include "history/run.h"

#include "base/memory.h"
#include "base/timer.h"

#include <string.h>

struct velocity {
  double *R; /* [m] residual, N                                   */
  double *gap, *side, *d; /* [n], [n*(dim-1)] twice: bounds and step of the
                            obstacle (of a held unknown: of its support), m   */
  double *du; /* [m] the unknown, m                                */
};

static status velocity_new(const run *r, velocity **out) {
  status st = OK;
  velocity *v = NULL;
  int tangents = r->n * (r->msh->dim - 1);
  NEW(v, 1);
  *out = v;
  NEW(v->R, r->n_c);
  NEW(v->gap, r->n);
  NEW(v->side, tangents);
  NEW(v->d, tangents);
  NEW(v->du, r->n_c);
done:
  return st;
}

void velocity_free(velocity *v) {
  if (v == NULL) return;
  memory_free(v->R);
  memory_free(v->gap);
  memory_free(v->side);
  memory_free(v->d);
  memory_free(v->du);
  memory_free(v);
}

/* R = f - A u_old */
static void set_residual(const run *r, velocity *v) {
  contact_product(r->n_c, r->cp.A, r->old.uc, v->R);
  for (int k = 0; k < r->n_c; ++k) v->R[k] = r->f[k] - v->R[k];
}

/* The convex set of the increment and its position of stick. */
static void set_bounds(const run *r, velocity *v) {
  int dim = r->msh->dim;
  for (int i = 0; i < r->n; ++i) {
    v->gap[i] = r->cp.gap[i] - r->old.uc[dim * i];
    for (int a = 1; a < dim; ++a) {
      int k = dim * i + a, s = (dim - 1) * i + a - 1;
      v->side[s] = r->side_gap[s] - r->old.uc[k];
      if (r->ut0 == NULL) continue;
      v->d[s] = r->surface->held[k] ? r->ut0[s] - r->old.uc[k]
                                    : r->now.motion[k] - r->old.motion[k];
    }
  }
}

status velocity_problem(run *r, contact_problem *cp, double **du) {
  status st = OK;
  timer_enter(STAGE_VELOCITY);
  if (r->velocity == NULL) TRY(velocity_new(r, &r->velocity));
  velocity *v = r->velocity;
  set_residual(r, v);
  set_bounds(r, v);
  memset(v->du, 0, (size_t)r->n_c * sizeof *v->du);
  *cp = r->cp;
  cp->f = v->R;
  cp->gap = v->gap;
  if (cp->ut0 != NULL) cp->ut0 = v->d;
  if (cp->side_gap != NULL) cp->side_gap = v->side;
  *du = v->du;
done:
  timer_leave(STAGE_VELOCITY);
  return st;
}

void velocity_apply(run *r) {
  const velocity *v = r->velocity;
  const contact_problem *cp = &r->cp;
  int dim = r->msh->dim;
  for (int i = 0; i < r->n; ++i)
    for (int a = 0; a < dim; ++a) {
      int k = dim * i + a, s = (dim - 1) * i + a - 1;
      double u = r->old.uc[k] + v->du[k];
      /* On a bound it stays on it, without the rounding of the sum. */
      if (a == 0 && v->du[k] == v->gap[i]) u = cp->gap[i];
      if (a > 0 && cp->side_gap != NULL && v->du[k] == v->side[s])
        u = cp->side_gap[s];
      else if (a > 0 && cp->ut0 != NULL && v->du[k] == v->d[s])
        u = cp->ut0[s];
      r->now.uc[k] = u;
    }
}
