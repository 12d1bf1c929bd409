/*
 * Orders of the node graph: nested dissection by cuts at coordinates (2-D) or
 * METIS (3-D, and 2-D bodies whose shape the cuts do not suit).
 *
 * A cut halves a set of nodes at the median of one coordinate; the separator
 * is the part of one half next to the other. A. George, SIAM J. Numer. Anal.
 * 10 (1973) for the fill; measured against METIS and AMD in tests/bench.
 */
#include "fem/ordering.h"

#include "base/base.h"

enum { LEAF = 24, LARGE_BODY = 200000, LARGE_PARTS = 16 };

/* Sum of the cubes of the separators over n^1.5: about 2 on a square, less on a
 * strip. Above this limit METIS is used. */
static const double work_limit = 5;

status graph_of_unknowns(const stiffness *k, graph *g) {
  OWNED size_t *at = NULL;
  g->n = k->n_node;
  PASS_NEW_ALL(OF(g->start, k->n_node + 1), OF(at, k->n_node + 1));
  for (int pass = 0; pass < 2; ++pass) {
    for (int j = 0; j < k->n_node; ++j)
      for (size_t p = k->start[j] + 1; k->free[j] && p < k->start[j + 1]; ++p) {
        const int i = k->row[p];
        if (k->free[i] == 0) continue;
        if (pass == 1) {
          g->next[at[i]] = j;
          g->next[at[j]] = i;
        }
        ++at[i];
        ++at[j];
      }
    if (pass == 1) break;
    for (int i = 0; i < k->n_node; ++i) {
      g->start[i + 1] = g->start[i] + at[i];
      at[i] = g->start[i];
    }
    PASS_NEW(g->next, g->start[k->n_node]);
  }
  return OK;
}

void graph_release(graph *g) { RELEASE(g->start, g->next); }

typedef struct dissection {
  const graph *g;
  int dim;
  const double *x; /* [dim*g->n] */
  int n;           /* nodes of the body */
  int *side;       /* [g->n] stamp of the half a node is in, 0: none */
  int stamp;
  int *spare;  /* [n] */
  double work; /* sum of the cubes of the separators */
} dissection;

/* Axes x y z; in 2-D two more directions, x + y and x - y. */
enum { DIAGONAL = 2, DIRECTIONS_2D = 4 };

static double coordinate(const dissection *w, int node, int axis) {
  const double *x = w->x + (size_t)w->dim * node;
  if (w->dim == 3 || axis < DIAGONAL) return x[axis];
  return axis == DIAGONAL ? x[0] + x[1] : x[0] - x[1];
}

/* The axis along which the nodes extend most. */
static int longest_axis(const dissection *w, int n, const int *node) {
  int best = 0;
  double most = -1;
  for (int a = 0; a < w->dim; ++a) {
    double low = coordinate(w, node[0], a), high = low;
    for (int i = 1; i < n; ++i) {
      const double c = coordinate(w, node[i], a);
      if (c < low) low = c;
      if (c > high) high = c;
    }
    if (high - low > most) {
      most = high - low;
      best = a;
    }
  }
  return best;
}

/* Does node a stand before b: by the coordinate, then the others, then id. */
static int before(const dissection *w, int axis, int a, int b) {
  for (int k = 0; k < w->dim; ++k) {
    const int c = k == 0 ? axis : (axis + k) % w->dim;
    const double xa = coordinate(w, a, c), xb = coordinate(w, b, c);
    if (xa != xb) return xa < xb;
  }
  return a < b;
}

static void swap(int *a, int *b) {
  const int t = *a;
  *a = *b;
  *b = t;
}

/* Quickselect: the half of smaller ones comes first. */
static void split_at(const dissection *w, int axis, int half, int n,
                     int *node) {
  int low = 0, high = n - 1;
  while (low < high) {
    const int middle = low + (high - low) / 2;
    if (before(w, axis, node[middle], node[low]))
      swap(&node[middle], &node[low]);
    if (before(w, axis, node[high], node[low])) swap(&node[high], &node[low]);
    if (before(w, axis, node[high], node[middle]))
      swap(&node[high], &node[middle]);
    const int pivot = node[middle];
    int i = low, j = high;
    while (i <= j) {
      while (before(w, axis, node[i], pivot)) ++i;
      while (before(w, axis, pivot, node[j])) --j;
      if (i <= j) swap(&node[i++], &node[j--]);
    }
    if (half <= j)
      high = j;
    else if (half >= i)
      low = i;
    else
      return;
  }
}

static int touches(const dissection *w, int node, int stamp) {
  for (size_t p = w->g->start[node]; p < w->g->start[node + 1]; ++p)
    if (w->side[w->g->next[p]] == stamp) return 1;
  return 0;
}

/* Nodes of the half "from" that touch the other move to its end; the number
 * of those that stay. */
static int keep_inner(dissection *w, int n, int *node, int other) {
  int kept = 0, moved = 0;
  for (int i = 0; i < n; ++i)
    if (touches(w, node[i], other))
      w->spare[moved++] = node[i];
    else
      node[kept++] = node[i];
  COPY(node + kept, w->spare, moved);
  return kept;
}

static int count_touching(const dissection *w, int n, const int *node,
                          int other) {
  int count = 0;
  for (int i = 0; i < n; ++i) count += touches(w, node[i], other);
  return count;
}

/* A leaf is swept along its longer side. */
static void sort_leaf(const dissection *w, int n, int *node) {
  if (n < 2) return;
  const int axis = longest_axis(w, n, node);
  for (int i = 1; i < n; ++i) {
    const int moved = node[i];
    int j = i;
    for (; j > 0 && before(w, axis, moved, node[j - 1]); --j)
      node[j] = node[j - 1];
    node[j] = moved;
  }
}

typedef struct cut {
  int half, left, right; /* nodes before the cut; stamps of the halves */
  int at_left, at_right; /* nodes of each half that touch the other */
} cut;

/* Halve node[0..n) across an axis. */
static cut halve(dissection *w, int axis, int n, int *node) {
  cut c = {.half = n / 2, .left = w->stamp + 1, .right = w->stamp + 2};
  w->stamp += 2;
  split_at(w, axis, c.half, n, node);
  for (int i = 0; i < n; ++i) w->side[node[i]] = i < c.half ? c.left : c.right;
  c.at_left = count_touching(w, c.half, node, c.right);
  c.at_right = count_touching(w, n - c.half, node + c.half, c.left);
  return c;
}

/* The large parts of a large plane body are cut where the separator is
 * shortest (a quarter fewer operations on unstructured meshes, which pays from
 * LARGE_BODY nodes on), all others across their length. */
static cut best_cut(dissection *w, int n, int *node) {
  int best = 0, shortest = n;
  if (w->dim == 3 || w->n < LARGE_BODY || n < w->n / LARGE_PARTS)
    return halve(w, longest_axis(w, n, node), n, node);
  for (int axis = 0; axis < DIRECTIONS_2D; ++axis) {
    const cut c = halve(w, axis, n, node);
    const int size = c.at_left < c.at_right ? c.at_left : c.at_right;
    if (size < shortest) {
      shortest = size;
      best = axis;
    }
  }
  return halve(w, best, n, node);
}

/* Order node[0..n): left part, right part, separator. */
static void dissect(dissection *w, int n, int *node) {
  if (n <= LEAF) {
    sort_leaf(w, n, node);
    return;
  }
  const cut c = best_cut(w, n, node);
  const int half = c.half;
  int n_left = half, n_right = n - half;
  if (c.at_left < c.at_right) {
    n_left = keep_inner(w, half, node, c.right);
    COPY(w->spare, node + n_left, (half - n_left));
    memmove(node + n_left, node + half, n_right * sizeof *node);
    COPY(node + n_left + n_right, w->spare, half - n_left);
  } else {
    n_right = keep_inner(w, n - half, node + half, c.left);
  }
  const double size = n - n_left - n_right;
  w->work += size * size * size;
  dissect(w, n_left, node);
  dissect(w, n_right, node + n_left);
}

static status order_by_cuts(const graph *g, int dim, const double *x, int n,
                            int *node, double *work) {
  OWNED int *side = NULL, *spare = NULL;
  PASS_NEW_ALL(OF(side, g->n), OF(spare, n));
  dissection w = {
      .g = g, .dim = dim, .x = x, .n = n, .side = side, .spare = spare};
  dissect(&w, n, node);
  *work = w.work;
  return OK;
}

/* Pattern of the graph among node[0..n), upper triangle, new. */
static status graph_pattern(const graph *g, int n, const int *node,
                            cholmod_common *cm, cholmod_sparse **out) {
  size_t edges = 0;
  OWNED_NEW(int, order, g->n);
  for (int i = 0; i < n; ++i) order[node[i]] = i + 1;
  for (int i = 0; i < n; ++i)
    for (size_t p = g->start[node[i]]; p < g->start[node[i] + 1]; ++p)
      edges += order[g->next[p]] > i + 1;
  cholmod_sparse *a = *out =
      cholmod_l_allocate_sparse(n, n, edges, 0, 1, -1, CHOLMOD_PATTERN, cm);
  if (a == NULL) RAISE(ERR_MEMORY, "memory exhausted: graph of %d nodes", n);
  SuiteSparse_long *start = a->p, *row = a->i, k = 0;
  for (int i = 0; i < n; ++i) {
    for (size_t p = g->start[node[i]]; p < g->start[node[i] + 1]; ++p)
      if (order[g->next[p]] > i + 1) row[k++] = order[g->next[p]] - 1;
    start[i + 1] = k;
  }
  return OK;
}

/* METIS without memory returns arbitrary numbers, and CHOLMOD accepts them. */
static int is_permutation(const SuiteSparse_long *perm, int n, int *seen) {
  CLEAR(seen, n);
  for (int i = 0; i < n; ++i) {
    if (perm[i] < 0 || perm[i] >= n || seen[perm[i]]) return 0;
    seen[perm[i]] = 1;
  }
  return 1;
}

static status order_by_pattern(order_method method, const graph *g, int n,
                               int *node, cholmod_common *cm) {
  cholmod_sparse *a = NULL;
  OWNED_NEW(SuiteSparse_long, perm, n);
  OWNED_NEW(int, old, n);
  PASS(graph_pattern(g, n, node, cm, &a));
  const int ordered = method == ORDER_METIS
                          ? cholmod_l_metis(a, NULL, 0, 0, perm, cm)
                          : cholmod_l_amd(a, NULL, 0, perm, cm);
  cholmod_l_free_sparse(&a, cm);
  if (!ordered || !is_permutation(perm, n, old))
    RAISE(ERR_MEMORY, "memory exhausted: order of %d nodes", n);
  COPY(old, node, n);
  for (int i = 0; i < n; ++i) node[i] = old[perm[i]];
  return OK;
}

status order_by(order_method method, const graph *g, int dim, const double *x,
                int n, int *node, cholmod_common *cm) {
  double work = 0;
  return method == ORDER_CUTS ? order_by_cuts(g, dim, x, n, node, &work)
                              : order_by_pattern(method, g, n, node, cm);
}

/* 1: a node is marked or next to one. */
static int is_near(const graph *g, int node, const unsigned char *mark) {
  if (mark[node]) return 1;
  for (size_t p = g->start[node]; p < g->start[node + 1]; ++p)
    if (mark[g->next[p]]) return 1;
  return 0;
}

/* The columns above those that are reached are too. */
static void add_reached(int n, const int *node, const unsigned char *mark,
                        const SuiteSparse_long *parent,
                        const SuiteSparse_long *count, unsigned char *reached,
                        order_cost *cost) {
  for (int q = 0; q < n; ++q) {
    if (!reached[q]) continue;
    if (parent[q] >= 0) reached[parent[q]] = 1;
    if (mark[node[q]]) cost->marked_entries += (double)count[q];
    cost->reached_entries += (double)count[q];
    cost->reached_flops += (double)count[q] * (double)count[q];
  }
}

status order_cost_of(const graph *g, int n, const int *node,
                     const unsigned char *mark, cholmod_common *cm,
                     order_cost *cost) {
  cholmod_sparse *a = NULL;
  const size_t size = n;
  OWNED_NEW(SuiteSparse_long, w, 6 * size);
  OWNED_NEW(unsigned char, reached, n);
  *cost = (order_cost){0};
  PASS(graph_pattern(g, n, node, cm, &a));
  for (int i = 0; i < n; ++i) w[i] = i;
  const int counted = cholmod_l_analyze_ordering(
      a, CHOLMOD_GIVEN, w, NULL, 0, w + size, w + 2 * size, w + 3 * size,
      w + 4 * size, w + 5 * size, cm);
  cholmod_l_free_sparse(&a, cm);
  if (!counted) RAISE(ERR_MEMORY, "memory exhausted: count of %d nodes", n);
  cost->flops = cm->fl;
  cost->entries = cm->lnz;
  for (int q = 0; mark != NULL && q < n; ++q)
    reached[q] = (unsigned char)is_near(g, node[q], mark);
  if (mark != NULL)
    add_reached(n, node, mark, w + size, w + 3 * size, reached, cost);
  return OK;
}

/* Both orders, the cheaper by its count: node[] holds that of the cuts. */
static status compare_with_metis(const graph *g, int n, int *node,
                                 cholmod_common *cm, const char **name) {
  order_cost cuts, metis;
  OWNED_NEW(int, other, n);
  COPY(other, node, n);
  PASS(order_by_pattern(ORDER_METIS, g, n, other, cm));
  PASS(order_cost_of(g, n, node, NULL, cm, &cuts));
  PASS(order_cost_of(g, n, other, NULL, cm, &metis));
  if (metis.flops < cuts.flops) {
    COPY(node, other, n);
    *name = "METIS";
  }
  return OK;
}

status order_nodes(const graph *g, int dim, const double *x, int n, int *node,
                   cholmod_common *cm, const char **name) {
  double work = 0;
  if (n <= LEAF) {
    *name = "natural";
  } else if (dim == 3) {
    *name = "METIS";
    PASS(order_by_pattern(ORDER_METIS, g, n, node, cm));
  } else {
    *name = "coordinate cuts";
    PASS(order_by_cuts(g, dim, x, n, node, &work));
    if (work > work_limit * n * sqrt(n))
      PASS(compare_with_metis(g, n, node, cm, name));
  }
  return OK;
}
