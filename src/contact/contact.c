/*
 * The contact problem: reactions, sliding limit, status, and the one residual
 * all solvers are judged by (contact.h).
 *
 * No function allocates: products with the matrix run over blocks of CHUNK
 * rows and columns kept on the stack.
 */
#include "contact/contact.h"

#include <cblas.h>
#include <math.h>

enum { CHUNK = 64 };
static const double ROUNDING_FLOOR = 0x1p-14; /* -, contact_scale             */
static const double STATUS_MARGIN = 0x1p-30;  /* -, of the force scale        */

/* The larger of two, NaN if one is. */
static double larger(double a, double b) {
  if (isnan(a)) return a;
  return b <= a ? a : b;
}

static double length(int n, const double *x) {
  double sum = 0.0;
  for (int k = 0; k < n; ++k) sum += x[k] * x[k];
  return sqrt(sum);
}

void contact_product(int m, const double *M, const double *x, double *y) {
  if (m == 0) return;
  cblas_dgemv(CblasColMajor, CblasNoTrans, m, m, 1.0, M, m, x, 1, 0.0, y, 1);
}

void contact_reaction(const contact_problem *cp, const double *u, double *r) {
  contact_product(cp->m, cp->A, u, r);
  for (int i = 0; i < cp->m; ++i) r[i] -= cp->f[i];
}

double contact_node_limit(const contact_problem *cp, const double *r,
                          int node_id) {
  if (cp->g0 == NULL) return 0.0;
  double g = cp->g0[node_id];
  if (cp->B != NULL)
    for (int k = cp->B->start[node_id]; k < cp->B->start[node_id + 1]; ++k) {
      double p = -r[(size_t)cp->B->col[k] * (size_t)cp->dim];
      if (p > 0.0 || isnan(p)) g += cp->B->val[k] * p;
    }
  return g > 0.0 || isnan(g) ? g : 0.0;
}

void contact_limit(const contact_problem *cp, const double *r, double *g) {
  for (int i = 0; i < cp->n; ++i) g[i] = contact_node_limit(cp, r, i);
}

int contact_held(const contact_problem *cp, int dof) {
  return cp->held != NULL && cp->held[dof];
}

double contact_bound(const contact_problem *cp, int dof) {
  int node_id = dof / cp->dim, k = dof % cp->dim;
  if (k == 0) return cp->gap[node_id];
  if (cp->side_gap == NULL) return HUGE_VAL;
  return cp->side_gap[node_id * (cp->dim - 1) + k - 1];
}

double contact_stick(const contact_problem *cp, int dof) {
  int node_id = dof / cp->dim, k = dof % cp->dim;
  return cp->ut0 == NULL ? 0.0 : cp->ut0[node_id * (cp->dim - 1) + k - 1];
}

/* ---- steps of the natural map ------------------------------------------ */

static double diagonal(const contact_problem *cp, int dof) {
  const double *M = cp->A != NULL ? cp->A : cp->W;
  return M[(size_t)dof * (size_t)cp->m + (size_t)dof];
}

static double largest_diagonal(const contact_problem *cp) {
  double d = 0.0;
  for (int i = 0; i < cp->m; ++i) d = larger(d, fabs(diagonal(cp, i)));
  return d;
}

/* Stiffness of a node along its normal and in its tangent plane, N/m, and the
 * factor that turns a force into the unit of the residual (1, or m/N). */
typedef struct node_step {
  double c_n, c_t, unit_n, unit_t;
} node_step;

static node_step step_of(const contact_problem *cp, int node_id,
                         double reference) {
  int first = node_id * cp->dim, counted = 0;
  double normal = diagonal(cp, first), tangential = 0.0;
  for (int k = 1; k < cp->dim; ++k)
    if (!contact_held(cp, first + k)) {
      tangential += diagonal(cp, first + k);
      ++counted;
    }
  if (counted > 0) tangential /= counted;
  if (!(normal > 0.0)) normal = reference;
  if (!(tangential > 0.0)) tangential = reference;
  if (cp->A != NULL) return (node_step){normal, tangential, 1.0, 1.0};
  return (node_step){1.0 / normal, 1.0 / tangential, normal, tangential};
}

/* ---- scale ------------------------------------------------------------- */

/* Displacement of reference of one unknown, m: see contact_scale. */
static double reference_position(const contact_problem *cp, int dof,
                                 int closed) {
  if (contact_held(cp, dof)) return cp->f[dof] / diagonal(cp, dof);
  double bound = contact_bound(cp, dof);
  if (dof % cp->dim > 0 && !(bound < HUGE_VAL)) return contact_stick(cp, dof);
  return closed ? bound : fmin(bound, 0.0);
}

/* Largest |f - A d| over the rows from first, rows <= CHUNK, N. */
static double load_of_rows(const contact_problem *cp, int first, int rows,
                           int closed) {
  double y[CHUNK], d[CHUNK], worst = 0.0;
  size_t m = (size_t)cp->m;
  for (int i = 0; i < rows; ++i) y[i] = cp->f[first + i];
  for (int j0 = 0; j0 < cp->m; j0 += CHUNK) {
    int cols = cp->m - j0 < CHUNK ? cp->m - j0 : CHUNK, zero = 1;
    for (int j = 0; j < cols; ++j) {
      d[j] = reference_position(cp, j0 + j, closed);
      zero = zero && d[j] == 0.0;
    }
    if (zero) continue;
    cblas_dgemv(CblasColMajor, CblasNoTrans, rows, cols, -1.0,
                cp->A + first + m * (size_t)j0, cp->m, d, 1, 1.0, y, 1);
  }
  for (int i = 0; i < rows; ++i)
    if (!contact_held(cp, first + i)) worst = larger(worst, fabs(y[i]));
  return worst;
}

static double force_scale(const contact_problem *cp, int closed) {
  double load = 0.0, terms = 0.0;
  for (int i = 0; i < cp->m; ++i) {
    double d = reference_position(cp, i, closed);
    if (!contact_held(cp, i))
      terms = larger(terms, fabs(cp->f[i]) + fabs(diagonal(cp, i) * d));
  }
  if (!(terms < HUGE_VAL)) return terms;
  for (int i = 0; i < cp->m; i += CHUNK)
    load = larger(
        load,
        load_of_rows(cp, i, cp->m - i < CHUNK ? cp->m - i : CHUNK, closed));
  return larger(load, ROUNDING_FLOOR * terms);
}

static int any_gap(const contact_problem *cp) {
  for (int i = 0; i < cp->m; ++i)
    if (reference_position(cp, i, 1) != reference_position(cp, i, 0)) return 1;
  return 0;
}

static double displacement_scale(const contact_problem *cp) {
  double scale = 0.0;
  for (int i = 0; i < cp->m; ++i) {
    double q = cp->f[i];
    scale = larger(scale, ROUNDING_FLOOR * fabs(q));
    if (i % cp->dim > 0 && cp->g0 != NULL)
      scale = larger(scale, fabs(q - contact_stick(cp, i)));
    else if (contact_bound(cp, i) < HUGE_VAL)
      scale = larger(scale, q - contact_bound(cp, i));
  }
  return scale;
}

double contact_scale(const contact_problem *cp) {
  if (cp->A == NULL) return displacement_scale(cp);
  double scale = force_scale(cp, 0);
  if (any_gap(cp)) {
    double closed = force_scale(cp, 1);
    if (closed < scale || isnan(closed)) scale = closed;
  }
  return larger(scale, ROUNDING_FLOOR * cp->load);
}

double contact_scale_at(const contact_problem *cp, double scale,
                        const double *u) {
  if (cp->A == NULL) return scale;
  for (int i = 0; i < cp->n; ++i) {
    const int dof = i * cp->dim;
    const double way = fmin(fabs(u[dof]), fabs(cp->gap[i]));
    scale = larger(scale, ROUNDING_FLOOR * diagonal(cp, dof) * way);
  }
  return scale;
}

/* ---- residual ---------------------------------------------------------- */

/* Part of a node in the tangent plane that friction acts in, in N:
 * |r_t - P_g(r_t - c (u_t - ut0))|. */
static double friction_mismatch(const contact_problem *cp, const double *u,
                                const double *r, int node_id, double c) {
  double z[2], e[2], g = contact_node_limit(cp, r, node_id);
  int first = node_id * cp->dim, n = 0;
  for (int k = 1; k < cp->dim; ++k) {
    if (contact_held(cp, first + k)) continue;
    e[n] = r[first + k];
    z[n] = e[n] - c * (u[first + k] - contact_stick(cp, first + k));
    ++n;
  }
  double size = length(n, z), shrink = size <= g ? 1.0 : g / size;
  for (int k = 0; k < n; ++k) e[k] -= shrink * z[k];
  return length(n, e);
}

int contact_has_side(const contact_problem *cp, int node_id) {
  for (int k = 1; k < cp->dim; ++k)
    if (contact_bound(cp, node_id * cp->dim + k) < HUGE_VAL) return 1;
  return 0;
}

/* Frictionless node: no force along a free tangent, unilateral where a second
 * obstacle bounds it; in N. */
static double side_mismatch(const contact_problem *cp, const double *u,
                            const double *r, int node_id, double c) {
  double worst = 0.0;
  for (int k = 1; k < cp->dim; ++k) {
    int dof = node_id * cp->dim + k;
    double bound = contact_bound(cp, dof);
    double part = fabs(r[dof]);
    if (bound < HUGE_VAL) part = fabs(larger(r[dof], c * (u[dof] - bound)));
    worst = larger(worst, part);
  }
  return worst;
}

double contact_mismatch(const contact_problem *cp, const double *u,
                        const double *r) {
  double worst = 0.0, reference = largest_diagonal(cp);
  for (int i = 0; i < cp->n; ++i) {
    int first = i * cp->dim;
    node_step s = step_of(cp, i, reference);
    double normal = larger(r[first], s.c_n * (u[first] - cp->gap[i]));
    worst = larger(worst, s.unit_n * fabs(normal));
    double tangential = contact_has_side(cp, i)
                            ? side_mismatch(cp, u, r, i, s.c_t)
                            : friction_mismatch(cp, u, r, i, s.c_t);
    worst = larger(worst, s.unit_t * tangential);
    for (int k = 1; k < cp->dim; ++k)
      if (contact_held(cp, first + k))
        worst = larger(worst, s.unit_t * fabs(r[first + k]));
  }
  return worst;
}

/* |A u - f - r|_max, or |W r + q - u|_max. */
static double equation_defect(const contact_problem *cp, const double *u,
                              const double *r) {
  const double *M = cp->A != NULL ? cp->A : cp->W;
  const double *x = cp->A != NULL ? u : r, *y = cp->A != NULL ? r : u;
  double sign = cp->A != NULL ? 1.0 : -1.0, worst = 0.0;
  int zero = cblas_dasum(cp->m, x, 1) == 0.0;
  for (int i0 = 0; i0 < cp->m; i0 += CHUNK) {
    int rows = cp->m - i0 < CHUNK ? cp->m - i0 : CHUNK;
    double d[CHUNK];
    for (int i = 0; i < rows; ++i) d[i] = y[i0 + i] + sign * cp->f[i0 + i];
    if (zero)
      cblas_dscal(rows, -1.0, d, 1);
    else
      cblas_dgemv(CblasColMajor, CblasNoTrans, rows, cp->m, 1.0, M + i0, cp->m,
                  x, 1, -1.0, d, 1);
    for (int i = 0; i < rows; ++i) worst = larger(worst, fabs(d[i]));
  }
  return worst;
}

double contact_residual_at(const contact_problem *cp, double scale,
                           const double *u, const double *r) {
  double worst = contact_mismatch(cp, u, r);
  worst = larger(worst, equation_defect(cp, u, r));
  scale = contact_scale_at(cp, scale, u);
  if (isnan(worst) || isnan(scale)) return NAN;
  if (scale > 0.0) return worst / scale;
  return worst > 0.0 ? HUGE_VAL : 0.0;
}

double contact_residual(const contact_problem *cp, const double *u,
                        const double *r) {
  return contact_residual_at(cp, contact_scale(cp), u, r);
}

/* ---- status ------------------------------------------------------------ */

/* |r_t - c (u_t - ut0)| in the directions friction acts in, N. */
static double trial_friction(const contact_problem *cp, const double *u,
                             const double *r, int node_id, double c) {
  double z[2] = {0.0, 0.0};
  int first = node_id * cp->dim;
  for (int k = 1; k < cp->dim; ++k)
    if (!contact_held(cp, first + k))
      z[k - 1] =
          r[first + k] - c * (u[first + k] - contact_stick(cp, first + k));
  return length(2, z);
}

void contact_classify(const contact_problem *cp, const double *u,
                      const double *r, contact_status *state) {
  double reference = largest_diagonal(cp);
  double margin = STATUS_MARGIN * contact_scale(cp);
  for (int i = 0; i < cp->n; ++i) {
    int first = i * cp->dim;
    node_step s = step_of(cp, i, reference);
    double push = s.c_n * (u[first] - cp->gap[i]) - r[first];
    double g = contact_node_limit(cp, r, i);
    double trial = trial_friction(cp, u, r, i, s.c_t);
    if (!(s.unit_n * push > margin))
      state[i] = CONTACT_OPEN;
    else if (g == 0.0 || s.unit_t * (trial - g) > margin)
      state[i] = CONTACT_SLIP;
    else
      state[i] = CONTACT_STICK;
  }
}
