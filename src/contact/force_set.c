/* Admissible forces (force_set.h). */
#include "contact/force_set.h"

#include "base/base.h"

#include <cblas.h>

enum {
  SHARPENINGS = 4,  /* of the bound of the spectrum */
  POWER_STEPS = 12, /* of the estimate of its end */
  SAMPLES = 8       /* of the estimate of its mean */
};
static const double SURE = 2.0;   /* -, times an estimate: a bound */
static const double SPARSE = 0.1; /* -, share of entries that are not zero */
static const double NOTHING = 0x1p-40; /* -, diagonal over its column */

static double largest_of_column(const contact_problem *cp, int dof) {
  const sparse_blocks *b = cp->blocks;
  const size_t d = cp->dim, m = cp->m;
  double most = 0.0;
  if (cp->op != NULL) return 0.0;
  if (b == NULL) {
    const double *column = cp->W + m * dof;
    return fabs(column[cblas_idamax(cp->m, column, 1)]);
  }
  for (int k = b->start[dof / cp->dim]; k < b->start[dof / cp->dim + 1]; ++k)
    most = fmax(most, largest_entry(d, b->val + d * (d * k + dof % d)));
  return most;
}

/* W_ii; of an operator what its diagonal bounds. */
static double own_compliance(const contact_problem *cp, int dof) {
  if (cp->op != NULL) return 1.0 / contact_diagonal(cp, dof);
  if (cp->blocks != NULL) return contact_diagonal(cp, dof);
  return cp->W[(size_t)dof * (cp->m + 1)];
}

/* D: 1/W_ii, equal in the tangents of a node, so that discs stay discs; of the
 * largest where W_ii is rounding of the other entries of its column: bodies
 * may differ by any power of ten. */
static void scaling(const contact_problem *cp, double *D) {
  int d = cp->dim;
  double largest = 0.0;
  for (int i = 0; i < cp->m; ++i) {
    const double own = own_compliance(cp, i);
    D[i] = own > NOTHING * largest_of_column(cp, i) ? own : 0.0;
    largest = fmax(largest, D[i]);
  }
  for (int i = 0; i < cp->n; ++i) {
    double mean = 0.0;
    for (int k = 1; k < d; ++k) mean += D[i * d + k] / (d - 1);
    for (int k = 1; k < d; ++k)
      if (!contact_held(cp, i * d + k)) D[i * d + k] = mean;
  }
  for (int i = 0; i < cp->m; ++i) D[i] = 1.0 / (D[i] > 0.0 ? D[i] : largest);
}

/* Upper bound of the spectrum of D W by steps of the power method on |D W|
 * (Collatz and Wielandt: the largest ratio bounds it). v, z [m]. */
static double spectrum_bound(const contact_problem *cp, const double *D,
                             double *v, double *z) {
  size_t m = cp->m;
  double bound = HUGE_VAL;
  for (size_t i = 0; i < m; ++i) v[i] = 1.0;
  for (int k = 0; k < SHARPENINGS; ++k) {
    double ratio = 0.0;
    if (cp->blocks != NULL) sparse_blocks_bound(cp->blocks, v, z);
    if (cp->blocks == NULL) CLEAR(z, m);
    for (size_t j = 0; j < m && cp->blocks == NULL; ++j)
      for (size_t i = 0; i < m; ++i) z[i] += fabs(cp->W[i + m * j]) * v[j];
    for (size_t i = 0; i < m; ++i) {
      z[i] *= D[i];
      ratio = fmax(ratio, z[i] / v[i]);
    }
    bound = fmin(bound, ratio);
    for (size_t i = 0; i < m; ++i) v[i] = fmax(z[i] / ratio, 0x1p-20);
  }
  return bound;
}

static int is_symmetric(int m, const double *M) {
  size_t n = m;
  for (size_t j = 0; j < n; ++j)
    for (size_t i = 0; i < j; ++i)
      if (!(fabs(M[i + n * j] - M[j + n * i]) <=
            0x1p-36 * (fabs(M[i + n * i]) + fabs(M[j + n * j]))))
        return 0;
  return 1;
}

static size_t entries(const contact_problem *cp) {
  size_t size = (size_t)cp->m * cp->m, count = 0;
  for (size_t k = 0; k < size; ++k) count += cp->W[k] != 0.0;
  return count;
}

status compliance_rows(const contact_problem *cp, sparse_rows *rows) {
  if (cp->blocks != NULL) return sparse_blocks_rows(cp->blocks, rows);
  size_t m = cp->m, count = entries(cp);
  OWNED int *at = NULL;
  PASS_NEW_ALL(OF(at, m), OF(rows->start, m + 1), OF(rows->col, count),
               OF(rows->val, count));
  rows->n = cp->m;
  for (size_t j = 0; j < m; ++j)
    for (size_t i = 0; i < m; ++i)
      rows->start[i + 1] += cp->W[i + m * j] != 0.0;
  for (size_t i = 0; i < m; ++i) {
    rows->start[i + 1] += rows->start[i];
    at[i] = rows->start[i];
  }
  for (size_t j = 0; j < m; ++j)
    for (size_t i = 0; i < m; ++i) {
      double value = cp->W[i + m * j];
      if (value == 0.0) continue;
      rows->col[at[i]] = (int)j;
      rows->val[at[i]++] = value;
    }
  return OK;
}

static unsigned next_random(unsigned seed) {
  return seed * 1664525u + 1013904223u;
}

double force_set_spectrum(const force_set *s, double *v, double *z) {
  const int m = s->cp->m;
  double largest = 0.0;
  unsigned seed = 1;
  for (int i = 0; i < m; ++i) {
    seed = next_random(seed);
    v[i] = s->D[i] * (1.0 + 0x1p-32 * seed);
  }
  for (int k = 0; k < POWER_STEPS; ++k) {
    double top = 0.0, bottom = 0.0;
    force_set_product(s, v, z);
    for (int i = 0; i < m; ++i) {
      top += v[i] * z[i];
      bottom += v[i] * v[i] / s->D[i];
    }
    if (!(bottom > 0.0) || !(top > 0.0)) break;
    largest = fmax(largest, top / bottom);
    for (int i = 0; i < m; ++i) v[i] = bottom / top * s->D[i] * z[i];
  }
  return largest;
}

/* Mean of D_i W_ii, by vectors of random signs (Hutchinson 1989). Roots are
 * taken of ratios: of a D in another unit they would round otherwise. */
static double mean_of_spectrum(const force_set *s, double *v, double *z) {
  const int m = s->cp->m;
  double sum = 0.0, largest = 0.0;
  unsigned seed = 1;
  for (int i = 0; i < m; ++i) largest = fmax(largest, s->D[i]);
  for (int k = 0; k < SAMPLES; ++k) {
    for (int i = 0; i < m; ++i) {
      seed = next_random(seed);
      v[i] = seed >> 31 ? sqrt(s->D[i] / largest) : -sqrt(s->D[i] / largest);
    }
    force_set_product(s, v, z);
    for (int i = 0; i < m; ++i) sum += v[i] * z[i] / m;
  }
  return largest * sum / SAMPLES;
}

status force_set_new(const contact_problem *cp, force_set **out) {
  OWNED double *v = NULL;
  MAKES(force_set, s, out);
  PASS_NEW_REALS(cp->m, &s->D, &s->origin, &s->load, &s->defect);
  PASS_NEW_ALL(OF(s->part, cp->m), OF(s->rim, cp->n), OF(v, 2 * cp->m));
  scaling(cp, s->D);
  if (cp->op != NULL) {
    /* D and the step where there are no entries: those of D W_ii that are not
     * the mean are below 1 too, as PROXIMAL wants them. */
    PASS_NEW(s->image, cp->m);
    PASS(force_set_fit(s, cp));
    const double mean = mean_of_spectrum(s, v, v + cp->m);
    for (int i = 0; i < cp->m && mean > 0.0; ++i) s->D[i] /= SURE * mean;
    const double largest = force_set_spectrum(s, v, v + cp->m);
    s->step = largest > 0.0 ? 1.0 / (SURE * largest) : 0.0;
  } else {
    s->symmetric = cp->blocks == NULL && is_symmetric(cp->m, cp->W);
    if (cp->blocks != NULL || (double)entries(cp) <= SPARSE * cp->m * cp->m)
      PASS(compliance_rows(cp, &s->rows));
    s->step = 1.0 / spectrum_bound(cp, s->D, v, v + cp->m);
  }
  return OK;
}

static void sparse_product(const sparse_rows *rows, const double *x,
                           double *y) {
  for (int i = 0; i < rows->n; ++i) {
    double sum = 0.0;
    for (int k = rows->start[i]; k < rows->start[i + 1]; ++k)
      sum += rows->val[k] * x[rows->col[k]];
    y[i] = sum;
  }
}

/* Held unknowns have their own stiffness alone. */
static void solve_operator(const force_set *s, const double *r, double *u) {
  const contact_problem *cp = s->cp;
  for (int i = 0; i < cp->m; ++i)
    if (contact_held(cp, i)) u[i] = r[i] / contact_diagonal(cp, i);
  cp->op->solve(cp->op->ctx, r, u, s->image);
}

void force_set_product(const force_set *s, const double *r, double *u) {
  int m = s->cp->m;
  if (s->cp->op != NULL)
    solve_operator(s, r, u);
  else if (s->rows.start != NULL)
    sparse_product(&s->rows, r, u);
  else if (s->symmetric)
    cblas_dsymv(CblasColMajor, CblasLower, m, 1.0, s->cp->W, m, r, 1, 0.0, u,
                1);
  else
    contact_product(m, s->cp->W, r, u);
}

void force_set_displacement(const force_set *s, const double *r, double *u) {
  const contact_problem *cp = s->cp;
  if (!contact_has_stiffness(cp)) {
    force_set_product(s, r, u);
    cblas_daxpy(cp->m, 1.0, cp->f, 1, u, 1);
    return;
  }
  for (int i = 0; i < cp->m; ++i) s->load[i] = r[i] + cp->f[i];
  force_set_product(s, s->load, u);
  contact_apply(cp, u, s->defect);
  for (int i = 0; i < cp->m; ++i) s->defect[i] = s->load[i] - s->defect[i];
  force_set_product(s, s->defect, s->load);
  cblas_daxpy(cp->m, 1.0, s->load, 1, u, 1);
}

void force_parts(const contact_problem *cp, unsigned char *part,
                 double *origin) {
  for (int i = 0; i < cp->n; ++i) {
    int first = i * cp->dim, t = i * (cp->dim - 1) - 1;
    int disc = cp->g0 != NULL && (cp->B != NULL || cp->g0[i] > 0.0);
    part[first] = PUSH;
    origin[first] = cp->gap[i];
    for (int k = 1; k < cp->dim; ++k) {
      double side = cp->side_gap == NULL ? HUGE_VAL : cp->side_gap[t + k];
      part[first + k] = NO_FORCE;
      origin[first + k] = 0.0;
      if (contact_held(cp, first + k)) continue;
      if (side < HUGE_VAL) {
        part[first + k] = PUSH;
        origin[first + k] = side;
      } else if (disc) {
        part[first + k] = IN_DISC;
        origin[first + k] = cp->ut0 == NULL ? 0.0 : cp->ut0[t + k];
      }
    }
  }
}

status force_set_fit(force_set *s, const contact_problem *cp) {
  const known_rows none = {0};
  int singular;
  s->cp = cp;
  force_parts(cp, s->part, s->origin);
  for (int i = 0; i < cp->n; ++i) s->rim[i] = 0;
  return cp->op == NULL ? OK : cp->op->set_rows(cp->op->ctx, &none, &singular);
}

/* Force into the tangent disc of a node; margin: relative depth at which a
 * force counts as lying on the rim. */
static void project_disc(const force_set *s, int node_id, double margin,
                         double *r) {
  const contact_problem *cp = s->cp;
  const unsigned char *kind = s->part + node_id * cp->dim;
  double size = 0.0, g = cp->g0 == NULL ? 0.0 : cp->g0[node_id];
  double *t = r + node_id * cp->dim;
  for (int k = 1; k < cp->dim; ++k)
    if (kind[k] == IN_DISC) size += t[k] * t[k];
  size = sqrt(size);
  s->rim[node_id] = size > 0.0 && size >= g * (1.0 - margin);
  if (!s->rim[node_id]) return;
  for (int k = 1; k < cp->dim; ++k)
    if (kind[k] == IN_DISC) t[k] *= g / size;
}

void force_set_project(const force_set *s, double margin, double *r) {
  for (int dof = 0; dof < s->cp->m; ++dof) {
    force_part kind = (force_part)s->part[dof];
    if (kind == NO_FORCE || (kind == PUSH && r[dof] > 0.0)) r[dof] = 0.0;
  }
  for (int i = 0; i < s->cp->n; ++i) project_disc(s, i, margin, r);
}
