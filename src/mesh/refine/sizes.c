/*
 * Elements in a binary tree of boxes, halved until few meet one.
 */
#include "mesh/refine/parts.h"

#include "base/base.h"

enum { FEW = 12, DEEPEST = 48 };
static const double SHARED = 1.6; /* -, elements of both halves over those of
                                     the whole, or halving is in vain */

typedef struct box {
  int axis;    /* along which it is halved; -1: it is not */
  double cut;  /* there, m */
  int part[2]; /* the boxes below and above */
  int n;
  int *elem; /* [n] that may meet it; NULL where it is halved */
} box;

struct size_grid {
  refine_sizes s;
  int n, cap;
  box *item; /* [n] 0 is the whole */
};

/* Least and largest coordinate of an element along an axis. */
static void range_of(const refine_sizes *s, int elem, int axis, double *range) {
  const int *v = s->elem + (s->dim + 1) * elem;
  range[0] = HUGE_VAL;
  range[1] = -HUGE_VAL;
  for (int a = 0; a <= s->dim; ++a) {
    range[0] = fmin(range[0], s->x[s->dim * v[a] + axis]);
    range[1] = fmax(range[1], s->x[s->dim * v[a] + axis]);
  }
}

/* Elements of a list below (side 0) or above a cut; to NULL: only counts. */
static int choose(const size_grid *g, const box *from, int side, int *to) {
  int n = 0;
  for (int i = 0; i < from->n; ++i) {
    double range[2];
    range_of(&g->s, from->elem[i], from->axis, range);
    if (side == 0 ? range[0] > from->cut : range[1] < from->cut) continue;
    if (to != NULL) to[n] = from->elem[i];
    ++n;
  }
  return n;
}

/* low, high [3]: of the box. */
static status halve(size_grid *g, int id, const double *low, const double *high,
                    int depth) {
  box from = g->item[id];
  from.axis = 0;
  for (int c = 1; c < g->s.dim; ++c)
    if (high[c] - low[c] > high[from.axis] - low[from.axis]) from.axis = c;
  from.cut = 0.5 * (low[from.axis] + high[from.axis]);
  const int n[2] = {choose(g, &from, 0, NULL), choose(g, &from, 1, NULL)};
  if (from.n <= FEW || depth == DEEPEST || n[0] + n[1] > SHARED * from.n)
    return OK;
  for (int side = 0; side < 2; ++side) {
    box part = {.axis = -1};
    double bound[2][3];
    memcpy(bound[0], low, sizeof bound[0]);
    memcpy(bound[1], high, sizeof bound[1]);
    bound[!side][from.axis] = from.cut;
    PASS_GROW(g->item, g->n, g->cap);
    from.part[side] = g->n;
    part.n = n[side];
    g->item[g->n] = part;
    PASS_NEW(g->item[g->n].elem, part.n);
    choose(g, &from, side, g->item[g->n++].elem);
    PASS(halve(g, from.part[side], bound[0], bound[1], depth + 1));
  }
  memory_free(from.elem);
  from.elem = NULL;
  g->item[id] = from;
  return OK;
}

static status build(size_grid *g) {
  const refine_sizes *s = &g->s;
  double low[3] = {0.0}, high[3] = {0.0};
  for (int c = 0; c < s->dim; ++c) {
    low[c] = high[c] = s->x[c];
    for (int i = 0; i < s->n_node; ++i) {
      low[c] = fmin(low[c], s->x[s->dim * i + c]);
      high[c] = fmax(high[c], s->x[s->dim * i + c]);
    }
  }
  PASS_GROW(g->item, g->n, g->cap);
  g->item[0] = (box){.axis = -1, .n = s->n_elem};
  g->n = 1;
  PASS_NEW(g->item[0].elem, s->n_elem);
  for (int e = 0; e < s->n_elem; ++e) g->item[0].elem[e] = e;
  return halve(g, 0, low, high, 0);
}

status size_grid_new(const refine_sizes *s, size_grid **out) {
  MAKES(size_grid, g, out);
  g->s = *s;
  return build(g);
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

/* That of the nearest node. */
static double size_near(const refine_sizes *s, const double *x) {
  double best = HUGE_VAL, size = HUGE_VAL;
  for (int i = 0; i < s->n_node; ++i) {
    double square = 0.0;
    for (int c = 0; c < s->dim; ++c)
      square += (s->x[s->dim * i + c] - x[c]) * (s->x[s->dim * i + c] - x[c]);
    if (!(square < best)) continue;
    best = square;
    size = s->at[i];
  }
  return size;
}

double size_grid_at(const size_grid *g, const double *x) {
  const refine_sizes *s = &g->s;
  double phi[4], best = -HUGE_VAL, size = HUGE_VAL;
  const box *b = g->item;
  while (b->axis >= 0) b = &g->item[b->part[x[b->axis] > b->cut]];
  for (int i = 0; i < b->n; ++i) {
    const int *v = s->elem + (s->dim + 1) * b->elem[i];
    const double least = coordinates(s, b->elem[i], x, phi);
    double sum = 0.0, parts = 0.0;
    if (!(least > best)) continue;
    best = least;
    for (int a = 0; a <= s->dim; ++a) {
      sum += fmax(phi[a], 0.0) * s->at[v[a]];
      parts += fmax(phi[a], 0.0);
    }
    size = sum / parts;
  }
  return b->n > 0 ? size : size_near(s, x);
}
