/*
 * Equilibrium of a body that contact alone holds: its stiffness has motions R
 * without energy, and the energy of d is finite only if R' d = 0. The forces
 * change by dq = Z y, Z = W R with the forces themselves as weights (so that
 * they keep their sign), on sliding nodes by the limit of the new pressure; R'
 * Z y = R' d.
 */
#include "accuracy/accuracy.h"

#include "base/memory.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <string.h>

/* Largest change of the force of an unknown, N; 0: it is given. */
static double slack(const contact_problem *cp, const pair *p, int dof) {
  int i = dof / cp->dim;
  if (contact_bound(cp, dof) < HUGE_VAL) return -p->q[dof];
  if (!accuracy_rubs(cp, dof) || p->slides[i]) return 0.0;
  double g = contact_node_limit(cp, p->q, i), size = 0.0;
  for (int k = 1; k < cp->dim; ++k) size = hypot(size, p->q[i * cp->dim + k]);
  return fmax(g - size, 0.0);
}

/* Change of q_t on sliding nodes with the limit, in one column z[m]. */
static void follow_limit(const contact_problem *cp, const pair *p, double *z) {
  for (int i = 0; i < cp->n && cp->B != NULL; ++i) {
    double change = 0.0, g = contact_node_limit(cp, p->q, i);
    if (!p->slides[i] || !(g > 0.0)) continue;
    for (int k = cp->B->start[i]; k < cp->B->start[i + 1]; ++k)
      change -= cp->B->val[k] * z[cp->B->col[k] * cp->dim];
    for (int k = 1; k < cp->dim; ++k) {
      int dof = i * cp->dim + k;
      if (accuracy_rubs(cp, dof)) z[dof] = change * (p->q[dof] / g);
    }
  }
}

/* 1: the changed forces are admissible. */
static int admissible(const contact_problem *cp, const pair *p) {
  for (int i = 0; i < cp->n; ++i) {
    double size = 0.0, g = contact_node_limit(cp, p->q, i);
    for (int k = 0; k < cp->dim; ++k) {
      int dof = i * cp->dim + k;
      if (contact_bound(cp, dof) < HUGE_VAL && !(p->q[dof] <= 0.0)) return 0;
      if (accuracy_rubs(cp, dof)) size = hypot(size, p->q[dof]);
    }
    if (!p->slides[i] && size > g) return 0;
  }
  return 1;
}

static const double NO_LEVER = 0x1p-44; /* -, condition that is rounding   */

/* y of G y = b in place of b[k]; 0: some motion has no force against it, or
 * only one with a lever arm of rounding. root[k], pivot[k] are workspace. */
static int solve_balance(int k, double *G, double *b, double *root,
                         int *pivot) {
  double norm, condition = 0.0;
  for (int a = 0; a < k; ++a) {
    root[a] = 1.0 / sqrt(fabs(G[a + k * a]));
    if (!(root[a] < HUGE_VAL)) return 0;
  }
  for (int c = 0; c < k; ++c)
    for (int a = 0; a < k; ++a) G[a + k * c] *= root[a] * root[c];
  norm = LAPACKE_dlange(LAPACK_COL_MAJOR, '1', k, k, G, k);
  if (LAPACKE_dgetrf(LAPACK_COL_MAJOR, k, k, G, k, pivot) != 0) return 0;
  LAPACKE_dgecon(LAPACK_COL_MAJOR, '1', k, G, k, norm, &condition);
  if (!(condition > NO_LEVER)) return 0;
  for (int a = 0; a < k; ++a) b[a] *= root[a];
  LAPACKE_dgetrs(LAPACK_COL_MAJOR, 'N', k, 1, G, k, pivot, b, k);
  for (int a = 0; a < k; ++a) b[a] *= root[a];
  return 1;
}

status pair_balance(const contact_problem *cp, const inverse_energy *inverse,
                    pair *p, int *done) {
  int m = cp->m, k = inverse->n_kernel;
  OWNED double *Z = NULL, *G = NULL, *y = NULL, *root = NULL;
  OWNED int *pivot = NULL;
  *done = 0;
  if (cblas_dasum(m, p->d, 1) == 0.0) {
    *done = 1;
    return OK;
  }
  PASS_NEW(Z, (size_t)m * (size_t)k);
  PASS_NEW(G, (size_t)k * (size_t)k);
  PASS_NEW(y, k);
  PASS_NEW(root, k);
  PASS_NEW(pivot, k);
  for (int c = 0; c < k; ++c) {
    double *z = Z + (size_t)m * (size_t)c;
    for (int dof = 0; dof < m; ++dof)
      z[dof] = slack(cp, p, dof) *
               inverse->kernel[(size_t)m * (size_t)c + (size_t)dof];
    follow_limit(cp, p, z);
  }
  cblas_dgemm(CblasColMajor, CblasTrans, CblasNoTrans, k, k, m, 1.0,
              inverse->kernel, m, Z, m, 0.0, G, k);
  cblas_dgemv(CblasColMajor, CblasTrans, m, k, 1.0, inverse->kernel, m, p->d, 1,
              0.0, y, 1);
  if (!solve_balance(k, G, y, root, pivot)) return OK;
  cblas_dgemv(CblasColMajor, CblasNoTrans, m, k, 1.0, Z, m, y, 1, 0.0, p->t, 1);
  for (int dof = 0; dof < m; ++dof) {
    p->q[dof] += p->t[dof];
    p->d[dof] -= p->t[dof];
  }
  *done = admissible(cp, p);
  return OK;
}
