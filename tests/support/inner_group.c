#include "support/inner_group.h"

#include "base/base.h"

static void *must(void *p) {
  if (p == NULL) abort();
  return p;
}

static mesh_group *new_group(mesh *m, const char *name, int dim) {
  size_t n = (size_t)m->n_group;
  m->group = must(memory_resize(m->group, n, n + 1, sizeof *m->group));
  mesh_group *g = &m->group[m->n_group++];
  *g = (mesh_group){.dim = dim, .tag = m->n_group};
  g->name = must(memory_text(name));
  return g;
}

static int same_nodes(int dim, const int *v, const int *w) {
  int same = 0;
  for (int i = 0; i < dim; ++i)
    for (int k = 0; k < dim; ++k) same += v[i] == w[k];
  return same == dim;
}

static int find_face(const mesh *m, const int *v) {
  for (int f = 0; f < m->n_face; ++f)
    if (same_nodes(m->dim, v, m->face + m->dim * f)) return f;
  return -1;
}

/* The side of an element across from a corner, outward; in 3-D the lowest node
 * first, as in meshes that are read. */
static void side_nodes(const mesh *m, int elem, int corner, int *v) {
  static const int of_triangle[3][2] = {{1, 2}, {2, 0}, {0, 1}};
  static const int of_tetra[4][3] = {
      {1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  const int *w = m->elem + (m->dim + 1) * elem;
  int s[3], low = 0;
  for (int k = 0; k < m->dim; ++k) {
    s[k] = w[m->dim == 2 ? of_triangle[corner][k] : of_tetra[corner][k]];
    if (m->dim == 3 && s[k] < s[low]) low = k;
  }
  for (int k = 0; k < m->dim; ++k) v[k] = s[(low + k) % m->dim];
}

/* The face with these nodes, new on the first element that has it. */
static int face_at(mesh *m, int elem, const int *v) {
  size_t n = (size_t)m->n_face, dim = (size_t)m->dim;
  int f = find_face(m, v);
  if (f >= 0) {
    if (m->face_elem[f] != elem) m->face_other[f] = elem;
    return f;
  }
  m->face = must(memory_resize(m->face, dim * n, dim * (n + 1), sizeof(int)));
  m->face_elem = must(memory_resize(m->face_elem, n, n + 1, sizeof(int)));
  m->face_other = must(memory_resize(m->face_other, n, n + 1, sizeof(int)));
  memcpy(m->face + dim * n, v, dim * sizeof *v);
  m->face_elem[n] = elem;
  m->face_other[n] = -1;
  return m->n_face++;
}

static int ascending(const void *p, const void *q) {
  return *(const int *)p - *(const int *)q;
}

/* Sorted, each once. */
static int *sorted(int *n, const int *list) {
  int *out = must(memory_new((size_t)*n, sizeof *out)), k = 0;
  memcpy(out, list, (size_t)*n * sizeof *out);
  qsort(out, (size_t)*n, sizeof *out, ascending);
  for (int i = 0; i < *n; ++i)
    if (i == 0 || out[i] != out[i - 1]) out[k++] = out[i];
  *n = k;
  return out;
}

void add_side_group(mesh *m, const char *name, take_side *take) {
  OWNS(m);
  mesh_group *g = new_group(m, name, m->dim - 1);
  const size_t most = (size_t)((m->dim + 1) * m->n_elem);
  int *item = must(memory_new(most, sizeof *item)), n = 0, v[3];
  for (int e = 0; e < m->n_elem; ++e)
    for (int k = 0; k <= m->dim; ++k) {
      side_nodes(m, e, k, v);
      if (take(m, v)) item[n++] = face_at(m, e, v);
    }
  g->n_item = n;
  g->item_id = sorted(&g->n_item, item);
  memory_free(item);
  int *node = must(memory_new((size_t)(m->dim * g->n_item), sizeof *node));
  for (int i = 0; i < g->n_item; ++i)
    memcpy(node + m->dim * i, m->face + m->dim * g->item_id[i],
           (size_t)m->dim * sizeof *node);
  g->n_node = m->dim * g->n_item;
  g->node_id = sorted(&g->n_node, node);
  memory_free(node);
}

void add_node_group(mesh *m, const char *name, int n, const int *node) {
  OWNS(m);
  mesh_group *g = new_group(m, name, 0);
  g->n_node = n;
  g->node_id = sorted(&g->n_node, node);
}
