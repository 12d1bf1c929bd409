/* Rectangles and boxes; every block comes from base/memory.h. */
#include "support/grid.h"

#include "base/base.h"

static const char *const side_names[] = {"LEFT", "RIGHT", "BOTTOM",
                                         "TOP",  "FRONT", "BACK"};

static mesh *new_mesh(int dim, int n_node, int n_elem, int n_face,
                      int n_group) {
  mesh *m = memory_new(1, sizeof *m);
  if (m == NULL) return NULL;
  OWNS(m);
  m->dim = dim;
  m->n_node = n_node;
  m->n_elem = n_elem;
  m->n_face = n_face;
  m->n_group = n_group;
  m->x = memory_new((size_t)(dim * n_node), sizeof *m->x);
  m->node_no = memory_new((size_t)n_node, sizeof *m->node_no);
  m->elem = memory_new((size_t)((dim + 1) * n_elem), sizeof *m->elem);
  m->elem_no = memory_new((size_t)n_elem, sizeof *m->elem_no);
  m->face = memory_new((size_t)(dim * n_face), sizeof *m->face);
  m->face_elem = memory_new((size_t)n_face, sizeof *m->face_elem);
  m->face_other = memory_new((size_t)n_face, sizeof *m->face_other);
  m->group = memory_new((size_t)n_group, sizeof *m->group);
  if (m->x && m->node_no && m->elem && m->elem_no && m->face && m->face_elem &&
      m->face_other && m->group) {
    for (int i = 0; i < n_node; ++i) m->node_no[i] = (size_t)i + 1;
    for (int e = 0; e < n_elem; ++e) m->elem_no[e] = (size_t)e + 1;
    for (int f = 0; f < n_face; ++f) m->face_other[f] = -1;
    return m;
  }
  memory_free(m);
  return NULL;
}

static void set_size(mesh *m) {
  for (int d = 0; d < m->dim; ++d) {
    double low = m->x[d], high = m->x[d];
    for (int i = 0; i < m->n_node; ++i) {
      low = fmin(low, m->x[m->dim * i + d]);
      high = fmax(high, m->x[m->dim * i + d]);
    }
    m->size = fmax(m->size, high - low);
  }
}

/* Items and the nodes they use; items of dimension group dim + 1 nodes. */
static int set_group(mesh *m, int id, const char *name, int first_item,
                     int n_item) {
  mesh_group *g = &m->group[id];
  OWNS(m);
  const int body = id == 0, per = body ? m->dim + 1 : m->dim;
  const int *nodes = body ? m->elem : m->face;
  unsigned char *used = memory_new((size_t)m->n_node, 1);
  g->name = memory_text(name);
  g->dim = body ? m->dim : m->dim - 1;
  g->tag = id + 1;
  g->n_item = n_item;
  g->item_id = memory_new((size_t)n_item, sizeof *g->item_id);
  if (used == NULL || g->name == NULL || g->item_id == NULL) {
    memory_free(used);
    return 0;
  }
  for (int i = 0; i < n_item; ++i) {
    g->item_id[i] = first_item + i;
    for (int k = 0; k < per; ++k) {
      int node = nodes[per * (first_item + i) + k];
      g->n_node += !used[node];
      used[node] = 1;
    }
  }
  g->node_id = memory_new((size_t)g->n_node, sizeof *g->node_id);
  if (g->node_id != NULL)
    for (int i = 0, k = 0; i < m->n_node; ++i)
      if (used[i]) g->node_id[k++] = i;
  memory_free(used);
  return g->node_id != NULL;
}

static int same_plane(const mesh *m, const int *nodes, int axis, double value) {
  for (int k = 0; k < m->dim; ++k)
    if (m->x[m->dim * nodes[k] + axis] != value) return 0;
  return 1;
}

/* The face of element e opposite to its vertex "apex", normal outward. */
static void opposite_face(const mesh *m, int e, int apex, int *nodes) {
  static const int of_triangle[3][2] = {{1, 2}, {2, 0}, {0, 1}};
  static const int of_tetra[4][3] = {
      {1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  for (int k = 0; k < m->dim; ++k)
    nodes[k] = m->elem[(m->dim + 1) * e + (m->dim == 2 ? of_triangle[apex][k]
                                                       : of_tetra[apex][k])];
}

static mesh *with_sides(mesh *m, const double *length) {
  int n_face = 0, done = set_group(m, 0, "BODY", 0, m->n_elem);
  for (int side = 0; done && side < 2 * m->dim; ++side) {
    int first = n_face;
    for (int e = 0; e < m->n_elem; ++e)
      for (int a = 0; a <= m->dim; ++a) {
        int nodes[3];
        opposite_face(m, e, a, nodes);
        if (!same_plane(m, nodes, side / 2, side % 2 ? length[side / 2] : 0))
          continue;
        memcpy(m->face + m->dim * n_face, nodes,
               (size_t)m->dim * sizeof *nodes);
        m->face_elem[n_face++] = e;
      }
    done = set_group(m, side + 1, side_names[side], first, n_face - first);
  }
  if (done) return m;
  memory_free(m);
  return NULL;
}

mesh *make_grid_2d(const int n[2], const double length[2]) {
  const int row = n[0] + 1;
  mesh *m =
      new_mesh(2, row * (n[1] + 1), 2 * n[0] * n[1], 2 * (n[0] + n[1]), 5);
  if (m == NULL) return NULL;
  for (int j = 0, i = 0; j <= n[1]; ++j)
    for (int k = 0; k <= n[0]; ++k, ++i) {
      m->x[2 * i] = k == n[0] ? length[0] : length[0] * k / n[0];
      m->x[2 * i + 1] = j == n[1] ? length[1] : length[1] * j / n[1];
    }
  for (int j = 0, e = 0; j < n[1]; ++j)
    for (int k = 0; k < n[0]; ++k, e += 2) {
      int a = j * row + k, b = a + 1, c = b + row, d = a + row;
      const int even[] = {a, b, c, a, c, d}, odd[] = {a, b, d, b, c, d};
      memcpy(m->elem + 3 * e, (j + k) % 2 ? odd : even, sizeof even);
    }
  set_size(m);
  return with_sides(m, length);
}

/* The six tetrahedra of a cell round its diagonal 0-7 (corner bits x y z). */
static void cell_tetrahedra(const int corner[8], int *elem) {
  static const int walk[6][4] = {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7},
                                 {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}};
  for (int t = 0; t < 6; ++t)
    for (int k = 0; k < 4; ++k) elem[4 * t + k] = corner[walk[t][k]];
}

mesh *make_grid_3d(const int n[3], const double length[3]) {
  const int row = n[0] + 1, plane = row * (n[1] + 1);
  mesh *m = new_mesh(3, plane * (n[2] + 1), 6 * n[0] * n[1] * n[2],
                     4 * (n[0] * n[1] + n[1] * n[2] + n[2] * n[0]), 7);
  if (m == NULL) return NULL;
  for (int i = 0; i < m->n_node; ++i) {
    const int at[3] = {i % row, i / row % (n[1] + 1), i / plane};
    for (int d = 0; d < 3; ++d)
      m->x[3 * i + d] = at[d] == n[d] ? length[d] : length[d] * at[d] / n[d];
  }
  for (int c = 0; c < n[0] * n[1] * n[2]; ++c) {
    int corner[8];
    int first = c % n[0] + c / n[0] % n[1] * row + c / (n[0] * n[1]) * plane;
    for (int b = 0; b < 8; ++b)
      corner[b] = first + (b & 1) + (b >> 1 & 1) * row + (b >> 2) * plane;
    cell_tetrahedra(corner, m->elem + 24 * c);
  }
  set_size(m);
  return with_sides(m, length);
}

mesh *grid_join(const mesh *a, const mesh *b, const double *shift) {
  const int per = a->dim + 1;
  mesh *m =
      new_mesh(a->dim, a->n_node + b->n_node, a->n_elem + b->n_elem, 0, 1);
  if (m == NULL) return NULL;
  memcpy(m->x, a->x, (size_t)(a->dim * a->n_node) * sizeof *m->x);
  for (int i = 0; i < m->dim * b->n_node; ++i)
    m->x[m->dim * a->n_node + i] = b->x[i] + shift[i % m->dim];
  memcpy(m->elem, a->elem, (size_t)(per * a->n_elem) * sizeof *m->elem);
  for (int i = 0; i < per * b->n_elem; ++i)
    m->elem[per * a->n_elem + i] = b->elem[i] + a->n_node;
  set_size(m);
  if (set_group(m, 0, "BODY", 0, m->n_elem)) return m;
  memory_free(m);
  return NULL;
}
