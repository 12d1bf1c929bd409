/* Sides of elements at the same face (sides.h). */
#include "mesh/sides.h"

#include "base/memory.h"

void sides_free(side_list *s) { RELEASE(s->start, s->side); }

/* The lowest corner stands in all sides of an element but one, whose lowest is
 * the second one. */
static void two_lowest(int n, const int *w, int low[2]) {
  low[0] = w[0] < w[1] ? w[0] : w[1];
  low[1] = w[0] < w[1] ? w[1] : w[0];
  for (int i = 2; i < n; ++i) {
    int other = w[i] < low[0] ? low[0] : w[i];
    if (w[i] < low[0]) low[0] = w[i];
    if (other < low[1]) low[1] = other;
  }
}

/* Two elements on both sides of a face have opposite orientations of it: last
 * bit. */
static uint64_t side_key(int dim, const int *v) {
  int a = v[dim - 2], c = v[dim - 1], turn = a < c;
  uint64_t low = (uint64_t)(turn ? a : c), high = (uint64_t)(turn ? c : a);
  return (dim == 2 ? 0 : low << 32) | high << 1 | (uint64_t)turn;
}

static status gather_sides(const mesh *m, side_list *s) {
  const int n = m->dim + 1;
  int v[3], low[2];
  s->n = n * m->n_elem;
  PASS_NEW_ALL(OF(s->start, m->n_node + 2), OF(s->side, s->n));
  for (int e = 0; e < m->n_elem; ++e) {
    two_lowest(n, m->elem + (size_t)n * (size_t)e, low);
    s->start[low[0] + 2] += m->dim;
    ++s->start[low[1] + 2];
  }
  for (int i = 1; i < m->n_node; ++i) s->start[i + 1] += s->start[i];
  for (int e = 0; e < m->n_elem; ++e)
    for (int side = 0; side < n; ++side) {
      mesh_side_nodes(m, n * e + side, v);
      int to = s->start[(m->dim == 2 && v[1] < v[0] ? v[1] : v[0]) + 1]++;
      s->side[to] = (sort_item){side_key(m->dim, v), n * e + side};
    }
  return OK;
}

status sides_outside(const mesh *m, sides_met *met, void *ctx, side_list *s) {
  PASS(gather_sides(m, s));
  s->n = 0;
  for (int i = 0; i < m->n_node; ++i) {
    int end = s->start[i + 1];
    PASS(sort_items(end - s->start[i], s->side + s->start[i], NULL, NULL));
    for (int j = s->start[i], next; j < end; j = next) {
      const sort_item *side = &s->side[j];
      for (next = j + 1; next < end && s->side[next].key / 2 == side->key / 2;)
        ++next;
      if (next == j + 1)
        s->side[s->n++] = *side;
      else if (met != NULL)
        met(ctx, next - j, side);
    }
  }
  return OK;
}

status mesh_border(const mesh *m, int *n, int **side) {
  ENDS_BY(sides_free) side_list s = {0};
  PASS(sides_outside(m, NULL, NULL, &s));
  *n = s.n;
  PASS_NEW(*side, s.n);
  for (int i = 0; i < s.n; ++i) (*side)[i] = s.side[i].id;
  return OK;
}
