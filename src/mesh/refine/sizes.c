/*
 * The elements of a mesh in a binary tree of boxes, halved until few elements
 * meet one.
 */
#include "mesh/refine/parts.h"

#include "base/base.h"
#include "base/box_tree.h"

static const double LEAST = 0x1p-40, WIDER = 4.0; /* -, of the mesh; - */

struct size_grid {
  refine_sizes s;
  box_tree tree; /* of the elements */
  int *found;    /* [n_elem] */
};

status size_grid_new(const refine_sizes *s, size_grid **out) {
  const int n = s->dim + 1;
  MAKES(size_grid, g, out);
  g->s = *s;
  PASS_NEW(g->found, s->n_elem);
  OWNED_NEW(double, x, ((size_t)s->dim * n * s->n_elem));
  for (int k = 0; k < n * s->n_elem; ++k)
    COPY(x + (size_t)s->dim * k, s->x + (size_t)s->dim * s->elem[k], s->dim);
  return box_tree_new(s->dim, s->n_elem, n, x, &g->tree);
}

/* Six times the volume of corners p[4], or twice the area of p[3]. */
static double measure_of(int dim, const double *const *p) {
  double e[3][3];
  for (int k = 0; k < dim; ++k) vector_of(dim, p[0], p[k + 1], e[k]);
  return determinant(dim, e);
}

/* Barycentric coordinates of x in an element; returns the least. */
static double coordinates(const refine_sizes *s, int elem, const double *x,
                          double *phi) {
  const int *v = s->elem + (s->dim + 1) * elem;
  const double *p[4];
  double least = HUGE_VAL;
  for (int a = 0; a <= s->dim; ++a) p[a] = s->x + s->dim * v[a];
  const double whole = measure_of(s->dim, p);
  for (int a = 0; a <= s->dim; ++a) {
    const double *own = p[a];
    p[a] = x;
    phi[a] = measure_of(s->dim, p) / whole;
    p[a] = own;
    least = fmin(least, phi[a]);
  }
  return least;
}

/* The elements next to x, ascending: g->found; their number. */
static int find_near(const size_grid *g, const double *x) {
  int n = 0;
  if (g->tree.n == 0) return 0;
  double r = LEAST * distance_of(g->s.dim, g->tree.box, g->tree.box + g->s.dim);
  for (; n == 0 && r > 0.0 && r < HUGE_VAL; r *= WIDER)
    n = box_tree_near(&g->tree, x, r, g->found);
  qsort(g->found, n, sizeof *g->found, number_order);
  return n;
}

double size_grid_at(const size_grid *g, const double *x) {
  const refine_sizes *s = &g->s;
  double phi[4], best = -HUGE_VAL, size = HUGE_VAL;
  const int n = find_near(g, x);
  for (int i = 0; i < n; ++i) {
    const int *v = s->elem + (s->dim + 1) * g->found[i];
    const double least = coordinates(s, g->found[i], x, phi);
    double sum = 0.0, parts = 0.0;
    if (!(least > best)) continue;
    best = least;
    for (int a = 0; a <= s->dim; ++a) {
      sum += fmax(phi[a], 0.0) * s->at[v[a]];
      parts += fmax(phi[a], 0.0);
    }
    size = sum / parts;
  }
  return size;
}
