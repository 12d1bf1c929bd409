/*
 * (3.9) and (3.10) of CPR98 in the energy norm (theorems.h).
 *
 * With w = 0 (or the initial penetration) as test field in S_i^n and
 * |ut0| - |u_t - ut0| <= |u_t|:
 *   |u|^2 <= (f, u) + sum (B p)_i |u_t,i| + sum g0_i |u_t,i|,
 * and |r|_* = |u - inv(A) f|. With v + e, v the state before, in S_i^n and
 * u - e in S_(i-1)^n, the same follows for z = du - e:
 *   |z|^2 <= (df - A e, z) + sum |dg_i| |z_t,i|.
 * Both give |z| <= (|load|_* + c)/(1 - q).
 */
#include "accuracy/theorems/theorems.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

static const double ROUNDING = 1e-8; /* -, of the larger norm */

/* ---- the previous state ------------------------------------------------- */

status state_before_keep(const contact_problem *cp, const double *u,
                         const double *r, state_before *b) {
  size_t m = (size_t)cp->m, n = (size_t)cp->n;
  if (b->u == NULL) {
    PASS_NEW(b->u, m);
    PASS_NEW(b->r, m);
    PASS_NEW(b->f, m);
    PASS_NEW(b->gap, m);
    PASS_NEW(b->g, n);
  }
  memcpy(b->u, u, m * sizeof *u);
  memcpy(b->r, r, m * sizeof *r);
  memcpy(b->f, cp->f, m * sizeof *b->f);
  for (int k = 0; k < cp->m; ++k) b->gap[k] = contact_bound(cp, k);
  contact_limit(cp, r, b->g);
  b->known = 1;
  return OK;
}

void state_before_free(state_before *b) {
  RELEASE(b->u, b->r, b->f, b->gap, b->g);
  *b = (state_before){0};
}

/* ---- the bounds ---------------------------------------------------------- */

/* load less A e, and z less e, in place; workspace in the norm. */
static void shift(const contact_problem *cp, energy_norm *n, const double *e,
                  double *z, double *load) {
  contact_product(cp->m, cp->A, e, n->x);
  for (int k = 0; k < cp->m; ++k) {
    z[k] -= e[k];
    load[k] -= n->x[k];
  }
}

static void compare(const theorems_contact *all, energy_norm *e,
                    const double *z, const double *load, double limit,
                    double scale, theorems_bound *b) {
  b->left = energy_norm_of(e, z);
  b->right = energy_norm_dual(e, load);
  scale = fmax(scale, fmax(b->left, b->right));
  if (limit > 0.0) b->right += limit * sqrt(all->tangent);
  b->right /= 1.0 - all->factor;
  b->violated = !(b->left <= b->right + ROUNDING * scale);
}

status bound_total(const contact_problem *cp, const double *u,
                   const theorems_contact *all, energy_norm *e,
                   theorems_bound *b) {
  status st = OK;
  double *w = NULL, *z = NULL, *load = NULL, limit = 0.0;
  NEW(w, cp->m);
  NEW(z, cp->m);
  NEW(load, cp->m);
  memcpy(z, u, (size_t)cp->m * sizeof *z);
  memcpy(load, cp->f, (size_t)cp->m * sizeof *load);
  for (int k = 0; k < cp->m; ++k)
    if (!contact_held(cp, k)) w[k] = fmin(contact_bound(cp, k), 0.0);
  for (int i = 0; i < cp->n && cp->g0 != NULL; ++i)
    limit = hypot(limit, cp->g0[i]);
  shift(cp, e, w, z, load);
  compare(all, e, z, load, limit, 0.0, b);
done:
  RELEASE(w, z, load);
  return st;
}

/* e of one unknown: how its bound or its position of stick has moved. */
static double moved(const contact_problem *cp, const state_before *before,
                    int dof) {
  double v = before->known > 0 ? before->u[dof] : 0.0;
  double now = contact_bound(cp, dof);
  if (contact_held(cp, dof)) return 0.0;
  if (now < HUGE_VAL) {
    if (before->known > 0 && before->gap[dof] < HUGE_VAL)
      return now - before->gap[dof];
    return fmin(now - v, 0.0);
  }
  if (dof % cp->dim == 0 || cp->ut0 == NULL) return 0.0;
  return contact_stick(cp, dof) - v;
}

/* |dg| that no change of pressure explains; HUGE_VAL: a node whose friction is
 * not among those of the constant "tangent". */
static double limit_change(const contact_problem *cp,
                           const state_before *before) {
  double sum = 0.0;
  for (int i = 0; i < cp->n && cp->g0 != NULL; ++i) {
    const sparse_rows *B = cp->B;
    double g = cp->g0[i], rows = 0.0, old = 0.0;
    for (int k = B == NULL ? 0 : B->start[i]; B != NULL && k < B->start[i + 1];
         ++k) {
      int dof = cp->dim * B->col[k];
      rows += fabs(B->val[k]);
      if (before->known > 0) g += B->val[k] * fmax(0.0, -before->r[dof]);
    }
    if (before->known > 0) old = before->g[i];
    if (g != old && rows == 0.0 && cp->g0[i] == 0.0) return HUGE_VAL;
    sum = hypot(sum, g - old);
  }
  return sum;
}

status bound_change(const contact_problem *cp, const double *u,
                    const state_before *before, const theorems_contact *all,
                    energy_norm *n, theorems_bound *b) {
  status st = OK;
  double *e = NULL, *z = NULL, *load = NULL;
  double limit = limit_change(cp, before);
  double whole = energy_norm_dual(n, cp->f);
  if (!(limit < HUGE_VAL)) {
    b->why = "friction ends at some nodes";
    goto done;
  }
  NEW(e, cp->m);
  NEW(z, cp->m);
  NEW(load, cp->m);
  for (int k = 0; k < cp->m; ++k) {
    int known = before->known > 0;
    e[k] = moved(cp, before, k);
    z[k] = u[k] - (known ? before->u[k] : 0.0);
    load[k] = cp->f[k] - (known ? before->f[k] : 0.0);
  }
  shift(cp, n, e, z, load);
  compare(all, n, z, load, limit, whole, b);
done:
  RELEASE(e, z, load);
  return st;
}
