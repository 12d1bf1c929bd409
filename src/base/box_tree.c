/*
 * Node k of the tree has the children 2k+1 and 2k+2; each holds half of the
 * items of its parent, parted at the median along the longest side.
 */
#include "base/box_tree.h"

#include "base/base.h"

enum { LEAF = 4, DEEPEST = 32 };

/* Part of the items that a node holds. */
typedef struct range {
  size_t node;
  int first, count;
} range;

static double middle(const box_tree *t, int item, int axis) {
  const double *b = t->of + 2 * (size_t)t->dim * item;
  return b[axis] + b[t->dim + axis];
}

/* Order item[first..last] so that those before place k are not beyond it. */
static void part_at(box_tree *t, int axis, int first, int last, int k) {
  while (first < last) {
    double pivot = middle(t, t->item[first + (last - first) / 2], axis);
    int i = first, j = last;
    while (i <= j) {
      while (middle(t, t->item[i], axis) < pivot) ++i;
      while (middle(t, t->item[j], axis) > pivot) --j;
      if (i > j) break;
      int swap = t->item[i];
      t->item[i++] = t->item[j];
      t->item[j--] = swap;
    }
    if (k <= j)
      last = j;
    else if (k >= i)
      first = i;
    else
      return;
  }
}

static void widen(int dim, double *box, const double *by) {
  for (int c = 0; c < dim; ++c) {
    box[c] = fmin(box[c], by[c]);
    box[dim + c] = fmax(box[dim + c], by[dim + c]);
  }
}

static void build(box_tree *t, range r) {
  size_t size = 2 * (size_t)t->dim;
  double *box = t->box + size * r.node;
  int axis = 0;
  COPY(box, t->of + size * t->item[r.first], size);
  for (int i = 1; i < r.count; ++i)
    widen(t->dim, box, t->of + size * t->item[r.first + i]);
  if (r.count <= LEAF) return;
  for (int c = 1; c < t->dim; ++c)
    if (box[t->dim + c] - box[c] > box[t->dim + axis] - box[axis]) axis = c;
  int half = r.count / 2;
  part_at(t, axis, r.first, r.first + r.count - 1, r.first + half);
  build(t, (range){2 * r.node + 1, r.first, half});
  build(t, (range){2 * r.node + 2, r.first + half, r.count - half});
}

static size_t node_count(int n) {
  size_t nodes = 1;
  for (; n > LEAF; n -= n / 2) nodes = 2 * nodes + 1;
  return nodes;
}

/* Box of one item. */
static void surround(int dim, int corners, const double *x, double *box) {
  for (int k = 0; k < corners; ++k)
    for (int c = 0; c < dim; ++c) {
      double at = x[dim * k + c];
      box[c] = k == 0 ? at : fmin(box[c], at);
      box[dim + c] = k == 0 ? at : fmax(box[dim + c], at);
    }
}

status box_tree_new(int dim, int n, int corners, const double *x,
                    box_tree *out) {
  size_t size = 2 * (size_t)dim;
  memset(out, 0, sizeof *out);
  out->dim = dim;
  out->n = n;
  PASS_NEW_ALL(OF(out->item, n), OF(out->of, size * n),
               OF(out->box, size * node_count(n)));
  for (int i = 0; i < n; ++i) {
    out->item[i] = i;
    surround(dim, corners, x + (size_t)(dim * corners) * i, out->of + size * i);
  }
  if (n > 0) build(out, (range){0, 0, n});
  return OK;
}

static int is_near(int dim, const double *box, const double *x, double r) {
  double sum = 0.0;
  for (int c = 0; c < dim; ++c) {
    const double below = box[c] - x[c], above = x[c] - box[dim + c];
    const double d = below > 0.0 ? below : above > 0.0 ? above : 0.0;
    sum += d * d;
  }
  return sum < r * r;
}

static int is_along(int dim, const double *box, const box_beam *beam) {
  for (int k = 0; k < beam->n_slab; ++k) {
    double least = 0.0, most = 0.0;
    for (int c = 0; c < dim; ++c) {
      const double a = beam->axis[k][c];
      least += a * box[a > 0 ? c : dim + c];
      most += a * box[a > 0 ? dim + c : c];
    }
    if (least > beam->high[k] || most < beam->low[k]) return 0;
  }
  return 1;
}

/* What is searched for: a ball, or a beam if it is not NULL. */
typedef struct query {
  const double *x;
  double r;
  const box_beam *beam;
} query;

static int is_wanted(int dim, const double *box, const query *q) {
  return q->beam != NULL ? is_along(dim, box, q->beam)
                         : is_near(dim, box, q->x, q->r);
}

static inline int search(const box_tree *t, const query *q, int *found) {
  size_t size = 2 * (size_t)t->dim;
  range open[DEEPEST + 2];
  int n_open = 0, n = 0;
  if (t->n > 0) open[n_open++] = (range){0, 0, t->n};
  while (n_open > 0) {
    range a = open[--n_open];
    if (!is_wanted(t->dim, t->box + size * a.node, q)) continue;
    if (a.count > LEAF) {
      int half = a.count / 2;
      open[n_open++] = (range){2 * a.node + 1, a.first, half};
      open[n_open++] = (range){2 * a.node + 2, a.first + half, a.count - half};
      continue;
    }
    for (int i = 0; i < a.count; ++i) {
      int item = t->item[a.first + i];
      if (is_wanted(t->dim, t->of + size * item, q)) found[n++] = item;
    }
  }
  return n;
}

int box_tree_near(const box_tree *t, const double *x, double r, int *found) {
  return search(t, &(query){.x = x, .r = r}, found);
}

int box_tree_along(const box_tree *t, const box_beam *beam, int *found) {
  return search(t, &(query){.beam = beam}, found);
}
