/*
 * The contact problem: reactions, sliding limit, scale (contact.h).
 *
 * No function allocates: products with the matrix run over blocks of CHUNK
 * rows and columns kept on the stack.
 */
#include "base/base.h"
#include "contact/parts.h"

#include <cblas.h>

static const double ROUNDING_FLOOR = 0x1p-14; /* -, contact_scale */

void contact_product(int m, const double *M, const double *x, double *y) {
  if (m == 0) return;
  cblas_dgemv(CblasColMajor, CblasNoTrans, m, m, 1.0, M, m, x, 1, 0.0, y, 1);
}

void contact_apply(const contact_problem *cp, const double *x, double *y) {
  if (is_zero(cp->m, x))
    CLEAR(y, cp->m);
  else if (cp->op != NULL)
    cp->op->apply(cp->op->ctx, x, y, NULL);
  else if (cp->blocks != NULL)
    sparse_blocks_product(cp->blocks, x, y);
  else
    contact_product(cp->m, contact_matrix(cp), x, y);
}

void contact_add_columns(const contact_problem *cp, int node_id,
                         const double *x, double *y) {
  if (cp->blocks != NULL)
    sparse_blocks_add(cp->blocks, node_id, x, y);
  else
    cblas_dgemv(CblasColMajor, CblasNoTrans, cp->m, cp->dim, 1.0,
                contact_matrix(cp) + (size_t)(node_id * cp->dim) * cp->m, cp->m,
                x, 1, 1.0, y, 1);
}

void contact_column(const contact_problem *cp, int dof, double *column) {
  double e[3] = {0.0, 0.0, 0.0};
  e[dof % cp->dim] = 1.0;
  CLEAR(column, cp->m);
  contact_add_columns(cp, dof / cp->dim, e, column);
}

void contact_block(const contact_problem *cp, int node_id, double *block) {
  const int d = cp->dim;
  const size_t m = cp->m, first = node_id * d * (m + 1);
  if (cp->blocks != NULL) {
    COPY(block, sparse_blocks_own(cp->blocks, node_id), d * d);
    return;
  }
  for (int j = 0; j < d; ++j)
    COPY(block + d * j, contact_matrix(cp) + first + m * j, d);
}

/* Column by column; symmetric to the last bit. */
static void form_entries(const contact_problem *cp, double *M) {
  const size_t m = cp->m;
  double *e = cp->op->workspace;
  CLEAR(e, m);
  for (size_t j = 0; j < m; ++j) {
    e[j] = 1.0;
    contact_apply(cp, e, M + m * j);
    e[j] = 0.0;
  }
  for (size_t j = 0; j < m; ++j)
    for (size_t i = 0; i < j; ++i)
      M[i + m * j] = M[j + m * i] = 0.5 * (M[i + m * j] + M[j + m * i]);
}

void contact_dense(const contact_problem *cp, double *M) {
  if (cp->op != NULL)
    form_entries(cp, M);
  else if (cp->blocks != NULL)
    sparse_blocks_dense(cp->blocks, M);
  else
    COPY(M, contact_matrix(cp), (size_t)cp->m * cp->m);
}

void contact_reaction(const contact_problem *cp, const double *u, double *r) {
  contact_apply(cp, u, r);
  for (int i = 0; i < cp->m; ++i) r[i] -= cp->f[i];
}

void contact_limit(const contact_problem *cp, const double *r, double *g) {
  for (int i = 0; i < cp->n; ++i) g[i] = contact_node_limit(cp, r, i);
}

double contact_slip_of(const contact_problem *cp, const double *u,
                       int node_id) {
  double slip = 0.0;
  for (int k = 1; k < cp->dim; ++k) {
    int dof = node_id * cp->dim + k;
    if (!contact_held(cp, dof))
      slip = hypot(slip, u[dof] - contact_stick(cp, dof));
  }
  return slip;
}

/* ---- stiffness of a node ----------------------------------------------- */

double contact_diagonal(const contact_problem *cp, int dof) {
  if (cp->op != NULL) return cp->op->diagonal[dof];
  if (cp->blocks != NULL)
    return sparse_blocks_own(cp->blocks,
                             dof / cp->dim)[dof % cp->dim * (1 + cp->dim)];
  return contact_matrix(cp)[(size_t)dof * cp->m + dof];
}

double contact_largest_diagonal(const contact_problem *cp) {
  double d = 0.0;
  for (int i = 0; i < cp->m; ++i) d = larger(d, fabs(contact_diagonal(cp, i)));
  return d;
}

double contact_resistance(const contact_problem *cp, const double *v,
                          double share) {
  const double least =
      cp->m * DBL_EPSILON / share * contact_largest_diagonal(cp);
  double force = 0.0;
  for (int i = 0; i < cp->m; ++i)
    force = fmax(force, fmax(contact_diagonal(cp, i), least) * fabs(v[i]));
  return force;
}

double contact_tangent_diagonal(const contact_problem *cp, int node_id,
                                double none) {
  int first = node_id * cp->dim, counted = 0;
  double sum = 0.0;
  for (int k = 1; k < cp->dim; ++k)
    if (!contact_held(cp, first + k)) {
      sum += contact_diagonal(cp, first + k);
      ++counted;
    }
  return counted > 0 ? sum / counted : none;
}

node_step contact_step(const contact_problem *cp, int node_id,
                       double largest_diagonal) {
  double n = contact_diagonal(cp, node_id * cp->dim);
  double t = contact_tangent_diagonal(cp, node_id, 0.0);
  /* Where no force moves anything, any step serves. */
  if (!(largest_diagonal > 0.0)) largest_diagonal = 1.0;
  if (!(n > 0.0)) n = largest_diagonal;
  if (!(t > 0.0)) t = largest_diagonal;
  if (contact_has_stiffness(cp)) return (node_step){n, t};
  return (node_step){1.0 / n, 1.0 / t};
}

/* ---- scale ------------------------------------------------------------- */

/* Displacement of reference of one unknown, m: see contact_scale. */
static double reference_position(const contact_problem *cp, int dof,
                                 int closed) {
  if (contact_held(cp, dof)) return cp->f[dof] / contact_diagonal(cp, dof);
  double bound = contact_bound(cp, dof);
  if (dof % cp->dim > 0 && !(bound < HUGE_VAL)) return contact_stick(cp, dof);
  return closed ? bound : fmin(bound, 0.0);
}

/* Largest |f - A d| of all rows, N. */
static double load_of_operator(const contact_problem *cp, int closed) {
  double worst = 0.0, *d = cp->op->workspace, *Ad = cp->op->workspace + cp->m;
  for (int i = 0; i < cp->m; ++i) d[i] = reference_position(cp, i, closed);
  contact_apply(cp, d, Ad);
  for (int i = 0; i < cp->m; ++i)
    if (!contact_held(cp, i)) worst = larger(worst, fabs(cp->f[i] - Ad[i]));
  return worst;
}

/* Largest |f - A d| over the rows from first, rows <= CHUNK, N. */
static double load_of_rows(const contact_problem *cp, int first, int rows,
                           int closed) {
  double y[CHUNK], d[CHUNK], worst = 0.0;
  size_t m = cp->m;
  for (int i = 0; i < rows; ++i) y[i] = cp->f[first + i];
  for (int j0 = 0; j0 < cp->m; j0 += CHUNK) {
    int cols = cp->m - j0 < CHUNK ? cp->m - j0 : CHUNK, zero = 1;
    for (int j = 0; j < cols; ++j) {
      d[j] = reference_position(cp, j0 + j, closed);
      zero = zero && d[j] == 0.0;
    }
    if (zero) continue;
    cblas_dgemv(CblasColMajor, CblasNoTrans, rows, cols, -1.0,
                cp->A + first + m * j0, cp->m, d, 1, 1.0, y, 1);
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
      terms = larger(terms, fabs(cp->f[i]) + fabs(contact_diagonal(cp, i) * d));
  }
  if (!(terms < HUGE_VAL)) return terms;
  if (cp->op != NULL) load = load_of_operator(cp, closed);
  for (int i = 0; cp->op == NULL && i < cp->m; i += CHUNK)
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
  if (!contact_has_stiffness(cp)) return displacement_scale(cp);
  double scale = force_scale(cp, 0);
  if (any_gap(cp)) {
    double closed = force_scale(cp, 1);
    if (closed < scale || isnan(closed)) scale = closed;
  }
  return larger(scale, ROUNDING_FLOOR * cp->load);
}
