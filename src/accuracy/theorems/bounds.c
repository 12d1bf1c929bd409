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

/* A contact problem with part of its sliding limit and of its normal forces
 * given (theorems.h). */

static int is_given(const unsigned char *given, int i) {
  return given != NULL && given[i];
}

/* Entries of B that are left out become part of g0. */
static status freeze_limit(const contact_problem *cp, const double *r,
                           const unsigned char *keep_row,
                           const unsigned char *given, frozen_problem *out) {
  const sparse_rows *B = cp->B;
  COPY(out->g0, cp->g0, cp->n);
  if (B == NULL) return OK;
  out->B = (sparse_rows){B->n, B->start, B->col, NULL};
  PASS_NEW(out->B.val, B->start[B->n]);
  for (int i = 0; i < cp->n; ++i)
    for (int e = B->start[i]; e < B->start[i + 1]; ++e) {
      int j = B->col[e];
      int keep = (keep_row == NULL || keep_row[i]) && !is_given(given, j);
      if (keep)
        out->B.val[e] = B->val[e];
      else
        out->g0[i] += B->val[e] * fmax(0.0, -r[cp->dim * j]);
    }
  out->cp.B = &out->B;
  return OK;
}

status frozen_new(const contact_problem *cp, const double *r,
                  const unsigned char *keep_row, const unsigned char *given,
                  frozen_problem *out) {
  *out = (frozen_problem){.cp = *cp};
  PASS_NEW(out->f, cp->m);
  PASS_NEW_REALS(cp->n, &out->gap, &out->g0);
  PASS_NEW(out->r, cp->m);
  COPY(out->f, cp->f, cp->m);
  COPY(out->r, r, cp->m);
  for (int i = 0; i < cp->n; ++i) {
    int k = cp->dim * i;
    out->gap[i] = is_given(given, i) ? HUGE_VAL : cp->gap[i];
    if (!is_given(given, i)) continue;
    out->f[k] += r[k];
    out->r[k] = 0.0;
  }
  if (cp->g0 != NULL) {
    PASS(freeze_limit(cp, r, keep_row, given, out));
    out->cp.g0 = out->g0;
  }
  out->cp.f = out->f;
  out->cp.gap = out->gap;
  return OK;
}

/* ---- The fixed point of Theorem 3.2 of CPR98: rate and constants
 * (theorems.h). */

enum { PASSES = 120 };
static const double STEADY =
    1e-7; /* -, change of the factor from pass to pass */

status theorems_path_rate(const stress_map *map, double *rate) {
  double last = 0.0, first = 0.0;
  int calm = 0;
  *rate = 0.0;
  PASS(map->apply(map->ctx, &first));
  for (int k = 0; k < PASSES && calm < 3 && first > 0.0; ++k) {
    PASS(map->apply(map->ctx, rate));
    calm = fabs(*rate - last) <= STEADY * *rate ? calm + 1 : 0;
    last = *rate;
  }
  return OK;
}

double theorems_passes(double x) {
  double low = floor(x), high = 4.0 + ceil(3.0 * x);
  if (!(high < 1e15)) return HUGE_VAL;
  while (high - low > 1.0) { /* the terms grow until k = x, then fall */
    double middle = floor(0.5 * (low + high));
    if (middle * log(x) - lgamma(middle + 1.0) < 0.0) /* log(x^k/k!) */
      high = middle;
    else
      low = middle;
  }
  return high;
}

static const double ROUNDING = 1e-8; /* -, of the larger norm */

status state_before_keep(const contact_problem *cp, const double *u,
                         const double *r, state_before *b) {
  size_t m = cp->m, n = cp->n;
  if (b->u == NULL) {
    PASS_NEW_REALS(m, &b->u, &b->r, &b->f, &b->gap);
    PASS_NEW(b->g, n);
  }
  COPY(b->u, u, m);
  COPY(b->r, r, m);
  COPY(b->f, cp->f, m);
  for (int k = 0; k < cp->m; ++k) b->gap[k] = contact_bound(cp, k);
  contact_limit(cp, r, b->g);
  b->known = 1;
  return OK;
}

void state_before_free(state_before *b) {
  RELEASE(b->u, b->r, b->f, b->gap, b->g);
  *b = (state_before){0};
}

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
  OWNED double *w = NULL, *z = NULL, *load = NULL;
  double limit = 0.0;
  PASS_NEW_REALS(cp->m, &w, &z, &load);
  COPY(z, u, cp->m);
  COPY(load, cp->f, cp->m);
  for (int k = 0; k < cp->m; ++k)
    if (!contact_held(cp, k)) w[k] = fmin(contact_bound(cp, k), 0.0);
  for (int i = 0; i < cp->n && cp->g0 != NULL; ++i)
    limit = hypot(limit, cp->g0[i]);
  shift(cp, e, w, z, load);
  compare(all, e, z, load, limit, 0.0, b);
  return OK;
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
    for (int k = row_begin(B, i); k < row_end(B, i); ++k) {
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
  OWNED double *e = NULL, *z = NULL, *load = NULL;
  double limit = limit_change(cp, before);
  double whole = energy_norm_dual(n, cp->f);
  if (!(limit < HUGE_VAL)) {
    b->why = "friction ends at some nodes";
    return OK;
  }
  PASS_NEW_REALS(cp->m, &e, &z, &load);
  for (int k = 0; k < cp->m; ++k) {
    int known = before->known > 0;
    e[k] = moved(cp, before, k);
    z[k] = u[k] - (known ? before->u[k] : 0.0);
    load[k] = cp->f[k] - (known ? before->f[k] : 0.0);
  }
  shift(cp, n, e, z, load);
  compare(all, n, z, load, limit, whole, b);
  return OK;
}
