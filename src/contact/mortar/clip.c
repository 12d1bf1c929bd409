/*
 * A convex polygon is cut by one line after another (Sutherland, Hodgman, Comm.
 * ACM 17, 1974) and parted into triangles from its first corner.
 */
#include "contact/mortar/clip.h"

#include "base/base.h"

/* Corners of a polygon: six of two triangles, and what rounding adds where one
 * of them is seen from its edge. */
enum { MOST = CLIP_CELLS + 2 };

typedef struct polygon {
  int n;
  double at[MOST][2];
} polygon;

/* Twice the area of a, b, c in the plane, > 0 if counterclockwise. */
static double turn(const double *a, const double *b, const double *c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static double *node_place(int dim, const double *x, int node, double *at) {
  memcpy(at, x + (size_t)dim * node, dim * sizeof *at);
  return at;
}

/* Coordinates of x in the plane. */
static void into_plane(const facet *f, const double *x, double *y) {
  double d[3];
  vector_of(f->dim, f->origin, x, d);
  for (int a = 0; a < f->dim - 1; ++a) y[a] = dot(f->dim, f->axis[a], d);
}

/* Frame from the edges u, v of a triangle. */
static int frame_of_triangle(facet *f, const double *u, const double *v) {
  static const double flat = 1e-14; /* area over the square of the longest edge:
                                       rounding */
  double w[3];
  cross(u, v, f->normal);
  vector_of(3, u, v, w);
  const double longest = fmax(fmax(dot(3, u, u), dot(3, v, v)), dot(3, w, w));
  f->measure = 0.5 * norm(3, f->normal);
  if (!(f->measure > flat * longest)) return -1;
  memcpy(f->axis[0], u, sizeof w);
  if (!(make_unit(3, f->axis[0]) > 0 && make_unit(3, f->normal) > 0)) return -1;
  cross(f->normal, f->axis[0], f->axis[1]);
  return 0;
}

int facet_set(int dim, const int *node, const double *x, facet *f) {
  double p[3], edge[2][3];
  f->dim = dim;
  node_place(dim, x, node[0], f->origin);
  for (int k = 1; k < dim; ++k) {
    node_place(dim, x, node[k], p);
    for (int c = 0; c < dim; ++c) edge[k - 1][c] = p[c] - f->origin[c];
  }
  if (dim == 2) {
    f->measure = hypot(edge[0][0], edge[0][1]);
    if (!(f->measure > 0)) return -1;
    for (int c = 0; c < 2; ++c) f->axis[0][c] = edge[0][c] / f->measure;
    f->normal[0] = f->axis[0][1];
    f->normal[1] = -f->axis[0][0];
  } else if (frame_of_triangle(f, edge[0], edge[1]) != 0) {
    return -1;
  }
  for (int k = 0; k < dim; ++k)
    into_plane(f, node_place(dim, x, node[k], p), f->in_plane.at[k]);
  return 0;
}

void facet_project(const facet *f, const int *node, const double *x,
                   shadow *s) {
  for (int k = 0; k < f->dim; ++k) {
    double p[3];
    into_plane(f, node_place(f->dim, x, node[k], p), s->in_plane.at[k]);
    for (int c = 0; c < f->dim; ++c) p[c] -= f->origin[c];
    s->height[k] = dot(f->dim, f->normal, p);
  }
  s->measure = cell_measure(f->dim, &s->in_plane);
}

double cell_measure(int dim, const cell *c) {
  return dim == 2 ? fabs(c->at[1][0] - c->at[0][0])
                  : 0.5 * fabs(turn(c->at[0], c->at[1], c->at[2]));
}

void cell_functions(int dim, const cell *c, const double *y, double *phi) {
  if (dim == 2) {
    const double length = c->at[1][0] - c->at[0][0];
    phi[0] = (c->at[1][0] - y[0]) / length;
    phi[1] = (y[0] - c->at[0][0]) / length;
    return;
  }
  const double twice = turn(c->at[0], c->at[1], c->at[2]);
  for (int k = 0; k < 3; ++k)
    phi[k] = turn(c->at[(k + 1) % 3], c->at[(k + 2) % 3], y) / twice;
}

/* Split p by the line a, b: what lies to its left, to its right. */
static void split(const polygon *p, const double *a, const double *b,
                  polygon *left, polygon *right) {
  left->n = right->n = 0;
  for (int i = 0; i < p->n; ++i) {
    const double *v = p->at[i], *w = p->at[(i + 1) % p->n];
    const double dv = turn(a, b, v), dw = turn(a, b, w);
    if (dv >= 0) memcpy(left->at[left->n++], v, sizeof left->at[0]);
    if (dv <= 0) memcpy(right->at[right->n++], v, sizeof right->at[0]);
    if ((dv > 0 && dw < 0) || (dv < 0 && dw > 0)) {
      const double s = dv / (dv - dw);
      double *l = left->at[left->n++], *r = right->at[right->n++];
      for (int c = 0; c < 2; ++c) l[c] = r[c] = v[c] + s * (w[c] - v[c]);
    }
  }
}

static int triangles_of(const polygon *p, cell *out) {
  for (int i = 2; i < p->n; ++i) {
    memcpy(out[i - 2].at[0], p->at[0], sizeof p->at[0]);
    memcpy(out[i - 2].at[1], p->at[i - 1], sizeof p->at[0]);
    memcpy(out[i - 2].at[2], p->at[i], sizeof p->at[0]);
  }
  return p->n > 2 ? p->n - 2 : 0;
}

/* Corners a, b of side k of b so that the cell is on its left. */
static void side_of(const cell *c, int k, const double **a, const double **b) {
  const int next = (k + 1) % 3;
  const int is_left = turn(c->at[0], c->at[1], c->at[2]) > 0;
  *a = c->at[is_left ? k : next];
  *b = c->at[is_left ? next : k];
}

static int add_segment(double low, double high, cell *out) {
  if (!(high > low)) return 0;
  out->at[0][0] = low;
  out->at[1][0] = high;
  return 1;
}

static double low_end(const cell *c) { return fmin(c->at[0][0], c->at[1][0]); }

static double high_end(const cell *c) { return fmax(c->at[0][0], c->at[1][0]); }

/* The common part of triangles a, b; a without it to rest, *n cells, unless
 * that is NULL. */
static polygon common(const cell *a, const cell *b, cell *rest, int *n) {
  polygon p = {.n = 3}, left, right;
  memcpy(p.at, a->at, sizeof a->at);
  for (int k = 0; k < 3 && p.n > 2; ++k) {
    const double *from, *to;
    side_of(b, k, &from, &to);
    split(&p, from, to, &left, &right);
    if (rest != NULL) *n += triangles_of(&right, rest + *n);
    p = left;
  }
  return p;
}

int cell_common(int dim, const cell *a, const cell *b, cell *out) {
  if (dim == 2)
    return add_segment(fmax(low_end(a), low_end(b)),
                       fmin(high_end(a), high_end(b)), out);
  const polygon p = common(a, b, NULL, NULL);
  return triangles_of(&p, out);
}

int cell_without(int dim, const cell *a, const cell *b, cell *out) {
  int n = 0;
  if (dim == 3) {
    common(a, b, out, &n);
    return n;
  }
  n += add_segment(low_end(a), fmin(high_end(a), low_end(b)), out);
  return n + add_segment(fmax(low_end(a), high_end(b)), high_end(a), out + n);
}

/*
 * The dual basis. Let q_i be orthonormal affine functions on the covered part O
 * and x_j the corners of the face. Affine functions are reproduced by the
 * kernel sum q_i(x) q_i(y), so that psi_j(y) = d_j sum_i q_i(x_j) q_i(y),   d_j
 * = int_O phi_j, fulfils int psi_j phi_k = d_j phi_k(x_j) = d_j delta_jk, and
 * sum_j psi_j(y) = int_O sum_i q_i(x) q_i(y) dx = 1. No matrix of the P1
 * functions is inverted, which on a small part of a face are nearly dependent.
 *
 * If a node z carries no multiplier, psi of the others are sought in the space
 * of h_k = phi_k + phi_z / (number kept), whose sum is 1 as well: the constant
 * for one kept node; for two, a and b, 1 and t = phi_a - phi_b.
 */

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
  const double twice = turn(c->at[k], a, b);
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
