#include "support/stack.h"

#include "base/base.h"

static void *get(size_t n, size_t size) {
  void *p = calloc(n + 1, size);
  if (p == NULL) abort();
  return p;
}

/* Nodes of the lower or upper side of a block. */
static int lower_side(const stack *k, int b) { return k->first[b]; }

static int upper_side(const stack *k, int b) {
  return k->first[b + 1] - k->cells[b] - 1;
}

static mesh *make_mesh(stack *k, double gap) {
  mesh *all = NULL;
  for (int b = 0; b < k->n_block; ++b) {
    mesh *one = make_grid_2d((int[]){k->cells[b], 2}, (double[]){1, 1});
    mesh *both =
        b == 0 ? one : grid_join(all, one, (double[]){0, b * (1 + gap)});
    if (both == NULL) abort();
    k->first[b + 1] = both->n_node;
    if (b > 0) {
      memory_free(all);
      memory_free(one);
    }
    all = both;
  }
  return all;
}

/* Contact with outward normal (0, normal) on nodes of a side. */
static void add_contact(stack *k, int node, int n, double normal) {
  mesh_group *g = &k->s->m->group[0];
  g->n_node = n;
  for (int i = 0; i < n; ++i) g->node_id[i] = node + i;
  scene_contact(k->s, "BODY", (double[]){0, normal}, 0);
}

/* Two nodes of a side of n cells and their parts at x; the same node twice,
 * once with nothing, where x is at a node. */
static void link(node_links *to, int row, int side, int n, double x) {
  const double along = x * n;
  const int left = along >= n - 1 ? n - 1 : (int)along;
  for (int e = 0; e < 2; ++e) {
    const size_t at = to->start[row] + (size_t)e;
    to->master[at] = side + left + e;
    for (int c = 0; c < 2; ++c)
      to->part[2 * at + (size_t)c] = e == 0 ? 1 - (along - left) : along - left;
  }
  to->start[row + 1] = to->start[row] + 2;
}

static void links_new(node_links *to, int n) {
  to->dim = 2;
  to->n = n;
  to->start = get((size_t)n + 1, sizeof *to->start);
  to->master = get(2 * (size_t)n, sizeof *to->master);
  to->part = get(4 * (size_t)n, sizeof *to->part);
}

static int block_of(const stack *k, int node) {
  int b = 0;
  while (node >= k->first[b + 1]) ++b;
  return b;
}

static void add_pairs(stack *k, const char *joints) {
  contact_surface *f = &k->s->surface;
  links_new(&k->pair, f->n);
  for (int q = 0; q < f->n; ++q) {
    const int i = f->node_id[q], b = block_of(k, i);
    const double x = k->s->m->x[2 * i];
    k->pair.start[q + 1] = k->pair.start[q];
    if (f->frame[4 * q + 1] > 0)
      link(&k->pair, q, lower_side(k, b + 1), k->cells[b + 1], x);
    else if (joints[b] == 'P')
      link(&k->pair, q, upper_side(k, b - 1), k->cells[b - 1], x);
  }
  f->master = &k->pair;
}

static void add_ties(stack *k, const char *joints) {
  tie_set *t = &k->ties;
  for (int b = 1; b < k->n_block; ++b)
    if (joints[b] == 'T') t->n += k->cells[b] + 1;
  if (t->n == 0) return;
  t->node_id = get((size_t)t->n, sizeof *t->node_id);
  links_new(&t->to, t->n);
  for (int b = 1, q = 0; b < k->n_block; ++b)
    for (int i = 0; joints[b] == 'T' && i <= k->cells[b]; ++i, ++q) {
      t->node_id[q] = lower_side(k, b) + i;
      link(&t->to, q, upper_side(k, b - 1), k->cells[b - 1],
           k->s->m->x[2 * t->node_id[q]]);
    }
  k->s->d.ties = t;
}

stack *stack_new(const char *joints, const int *cells, double gap) {
  stack *k = get(1, sizeof *k);
  k->n_block = (int)strlen(joints);
  memcpy(k->cells, cells, (size_t)k->n_block * sizeof *cells);
  k->s = scene_new(make_mesh(k, gap), PLANE_STRAIN, 1);
  for (int b = 0; b < k->n_block; ++b)
    if (joints[b] == 'M')
      add_contact(k, upper_side(k, b - 1), k->cells[b - 1] + 1, 1);
    else if (joints[b] == 'P' || joints[b] == 'O')
      add_contact(k, lower_side(k, b), k->cells[b] + 1, -1);
  if (strpbrk(joints, "PM") != NULL) add_pairs(k, joints);
  add_ties(k, joints);
  return k;
}

static void links_free(node_links *l) {
  free(l->start);
  free(l->master);
  free(l->part);
}

void stack_free(stack *k) {
  links_free(&k->pair);
  links_free(&k->ties.to);
  free(k->ties.node_id);
  scene_free(k->s);
  free(k);
}

void stack_fix(stack *k, int c) {
  for (int i = 0; i <= k->cells[0]; ++i) scene_fix_node(k->s, i, c);
}
