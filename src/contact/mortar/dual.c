/*
 * Let q_i be orthonormal affine functions on the covered part O and x_j the
 * corners of the face. Affine functions are reproduced by the kernel
 * sum q_i(x) q_i(y), so that
 *   psi_j(y) = d_j sum_i q_i(x_j) q_i(y),   d_j = int_O phi_j,
 * fulfils int psi_j phi_k = d_j phi_k(x_j) = d_j delta_jk, and
 * sum_j psi_j(y) = int_O sum_i q_i(x) q_i(y) dx = 1. No matrix of the P1
 * functions is inverted, which on a small part of a face are nearly dependent.
 *
 * If a node z carries no multiplier, psi of the others are sought in the space
 * of h_k = phi_k + phi_z / (number kept), whose sum is 1 as well: the constant
 * for one kept node; for two, a and b, 1 and t = phi_a - phi_b.
 */
#include "contact/mortar/dual.h"

#include <math.h>
#include <string.h>

/* An affine function c[0] + c[1] x + c[2] y. */
typedef struct affine {
  double c[3];
} affine;

static double value(int dim, const affine *f, const double *at) {
  double sum = f->c[0];
  for (int i = 1; i < dim; ++i) sum += f->c[i] * at[i - 1];
  return sum;
}

static double product(int dim, const affine *f, const affine *g, int n,
                      const sample *p) {
  double sum = 0.0;
  for (int k = 0; k < n; ++k)
    sum +=
        p[k].weight * value(dim, f, p[k].offset) * value(dim, g, p[k].offset);
  return sum;
}

/* q[dim] orthonormal for the points, by Gram and Schmidt, each projection
 * twice; 0 where the points (a needle) do not tell one more function. */
static void orthonormal(int dim, int n, const sample *p, affine *q) {
  static const double dependent = 1e-14; /* rounding */
  for (int i = 0; i < dim; ++i) {
    q[i] = (affine){.c[0] = i == 0, .c[1] = i == 1, .c[2] = i == 2};
    const double before = sqrt(product(dim, &q[i], &q[i], n, p));
    for (int k = 0; k < 2 * i; ++k) {
      const affine *known = &q[k % i];
      const double part = product(dim, known, &q[i], n, p);
      for (int c = 0; c < dim; ++c) q[i].c[c] -= part * known->c[c];
    }
    const double length = sqrt(product(dim, &q[i], &q[i], n, p));
    const double scale = length > dependent * before ? 1 / length : 0;
    for (int c = 0; c < dim; ++c) q[i].c[c] *= scale;
  }
}

static void keep_all(int dim, const cell *corner, int n, sample *p,
                     const double *d) {
  affine q[3];
  orthonormal(dim, n, p, q);
  for (int k = 0; k < n; ++k)
    for (int i = 0; i < dim; ++i) {
      const double here = value(dim, &q[i], p[k].offset);
      for (int j = 0; j < dim; ++j)
        p[k].psi[j] += d[j] * value(dim, &q[i], corner->at[j]) * here;
    }
}

/* The gradient of phi_k of a triangle. */
static void gradient(const cell *c, int k, double *g) {
  const double *a = c->at[(k + 1) % 3], *b = c->at[(k + 2) % 3];
  const double *o = c->at[k];
  const double twice =
      (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
  g[0] = (a[1] - b[1]) / twice;
  g[1] = (b[0] - a[0]) / twice;
}

/* psi_a = 1/2 + .. of two kept nodes a, b of a triangle: psi = u + v (t - mean
 * of t) with int psi_a phi_b = 0, int psi_a phi_a = d_a. */
static void keep_two(const cell *corner, int a, int b, int n, sample *p,
                     const double *d) {
  double ga[2], gb[2], mean = 0.0, total = 0.0, sa = 0.0, sb = 0.0;
  affine t = {{0}};
  gradient(corner, a, ga);
  gradient(corner, b, gb);
  for (int c = 0; c < 2; ++c) t.c[c + 1] = ga[c] - gb[c];
  for (int k = 0; k < n; ++k) {
    mean += p[k].weight * value(3, &t, p[k].offset);
    total += p[k].weight;
  }
  t.c[0] = -mean / total;
  for (int k = 0; k < n; ++k) {
    const double here = p[k].weight * value(3, &t, p[k].offset);
    sa += here * p[k].phi[a];
    sb += here * p[k].phi[b];
  }
  const double determinant = d[b] * sa - d[a] * sb;
  for (int k = 0; k < n; ++k) {
    const double here = value(3, &t, p[k].offset);
    p[k].psi[a] = d[a] * (d[b] * here - sb) / determinant;
    p[k].psi[b] = 1 - p[k].psi[a];
  }
}

void dual_basis(int dim, const cell *corner, const int *kept, int n,
                sample *points, double *d) {
  int node[3] = {0}, n_kept = 0;
  for (int j = 0; j < dim; ++j) {
    if (kept[j]) node[n_kept++] = j;
    d[j] = 0.0;
    for (int k = 0; k < n; ++k) d[j] += points[k].weight * points[k].phi[j];
  }
  for (int k = 0; k < n; ++k) memset(points[k].psi, 0, sizeof points[k].psi);
  if (n_kept == dim)
    keep_all(dim, corner, n, points, d);
  else if (n_kept == 2)
    keep_two(corner, node[0], node[1], n, points, d);
  else
    for (int k = 0; k < n && n_kept == 1; ++k) points[k].psi[node[0]] = 1;
}
