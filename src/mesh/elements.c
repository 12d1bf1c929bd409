/* Elements: kinds, corners, orientation, order, and those listed twice. */
#include "base/base.h"
#include "mesh/build.h"
#include "mesh/sort.h"

/* An element whose measure is below this part of (longest edge)^dim is flat:
 * far below any usable sliver, far above rounding. */
static const double flat = 1e-12;

/* Type of the one kind of element of a dimension that is read: P1. */
static int first_order_type(int dim) {
  static const int type[] = {15, 1, 2, 4};
  return type[dim];
}

/* Quadrangle, hexahedron, prism, pyramid; other types are of higher order. */
static int wrong_shape(int type) {
  return type == 3 || type == 5 || type == 6 || type == 7;
}

/* Its name, or its number. */
static const char *group_of(const raw_mesh *raw, const raw_block *b,
                            char tag[16]) {
  snprintf(tag, 16, "%d", b->physical[0]);
  for (int i = 0; i < raw->n_group; ++i)
    if (raw->group[i].dim == b->dim && raw->group[i].tag == b->physical[0] &&
        raw->group[i].name[0] != '\0')
      return raw->group[i].name;
  return tag;
}

/* One message for each type, at its first block. */
static status check_types(builder *b) {
  const raw_mesh *raw = b->raw;
  for (int i = 0; i < raw->n_block; ++i) {
    const raw_block *p = &raw->block[i];
    if (p->dim >= 0 && p->dim < 4 && p->type == first_order_type(p->dim) &&
        p->n_per == (size_t)(p->dim + 1))
      continue;
    size_t n = 0;
    int first = i;
    for (int j = 0; j < raw->n_block; ++j) {
      if (raw->block[j].type != p->type) continue;
      n += raw->block[j].n;
      if (j < first) first = j;
    }
    if (first < i) continue;
    char tag[16];
    const char *group = group_of(raw, p, tag);
    message_add(b->log, wrong_shape(p->type) ? P3020 : P3021, b->at,
                "%zu element(s) of type \"%s\"; the first is no. %zu in group "
                "\"%s\"",
                n, p->type_name, p->no[0], group);
  }
  return build_check(b);
}

/* Count top and low elements and where each block starts among them. */
static status count_items(builder *b) {
  size_t top = 0, low = 0;
  for (int i = 0; i < b->raw->n_block; ++i) {
    const raw_block *p = &b->raw->block[i];
    size_t *n = p->dim == b->m->dim ? &top : &low;
    if (p->dim < b->m->dim - 1) continue;
    if (*n <= MAX_ITEMS) b->first[i] = (int)*n;
    *n += p->n;
  }
  if (top > MAX_ITEMS || low > MAX_ITEMS || b->raw->n_node > MAX_ITEMS) {
    message_add(b->log, P3027, b->at, "%zu nodes, %zu elements, %zu faces",
                b->raw->n_node, top, low);
    PASS(build_check(b));
  }
  b->n_top = (int)top;
  b->n_low = (int)low;
  return OK;
}

static void gather_block(builder *b, int block, faults *unknown) {
  const raw_block *p = &b->raw->block[block];
  int *corner = b->corner + p->n_per * b->first[block];
  for (size_t i = 0; i < p->n_per * p->n; ++i) {
    int r = nodes_find(b, p->node[i]);
    corner[i] = r < 0 ? 0 : r;
    if (r >= 0)
      b->node_id[r] = 0;
    else
      fault_add(unknown, "node %zu of element %zu", p->node[i],
                p->no[i / p->n_per]);
  }
}

/* Corners of the top elements as raw nodes; node_id marks the used ones. */
status elements_gather(builder *b) {
  faults unknown = {0};
  PASS(check_types(b));
  PASS(count_items(b));
  PASS(nodes_index(b));
  PASS_NEW(b->node_id, b->raw->n_node);
  for (size_t i = 0; i < b->raw->n_node; ++i) b->node_id[i] = -1;
  PASS_NEW(b->corner, (size_t)(b->m->dim + 1) * b->n_top);
  for (int i = 0; i < b->raw->n_block; ++i)
    if (b->raw->block[i].dim == b->m->dim) gather_block(b, i, &unknown);
  if (unknown.n > 0)
    message_add(b->log, P3025, b->at, "%d corner(s) are missing: %s", unknown.n,
                unknown.text);
  return build_check(b);
}

/* Determinant of the edges from corner 0, and the longest edge. */
static double measure(const mesh *m, const int *v, double *longest) {
  double d[3][3], top = 0.0;
  size_t dim = m->dim;
  for (size_t i = 0; i <= dim; ++i)
    for (size_t j = 0; j < i; ++j) {
      const double *x = m->x + dim * v[i], *y = m->x + dim * (size_t)v[j];
      double square = 0.0;
      for (size_t k = 0; k < dim; ++k) {
        double e = x[k] - y[k];
        if (j == 0) d[i - 1][k] = e;
        square += e * e;
      }
      top = fmax(top, square);
    }
  *longest = sqrt(top);
  return determinant(m->dim, d);
}

static void swap(int *a, int *b) {
  int t = *a;
  *a = *b;
  *b = t;
}

/* Less than any usable sliver, far above the rounding of coordinates. */
static int is_flat(const mesh *m, const int *v, double far, double *det) {
  double edge;
  *det = measure(m, v, &edge);
  const double face = m->dim == 2 ? edge : edge * edge;
  return fabs(*det) <= fmax(flat * edge, 16.0 * DBL_EPSILON * far) * face;
}

static const raw_block *block_of(const builder *b, int e) {
  int i = 0;
  while (b->raw->block[i].dim != b->m->dim || e < b->first[i] ||
         (size_t)(e - b->first[i]) >= b->raw->block[i].n)
    ++i;
  return &b->raw->block[i];
}

/* Of an element. */
static const raw_block *home_of(const builder *b, int elem) {
  int top = 0;
  while (b->elem_of_top[top] != elem) ++top;
  return block_of(b, top);
}

/* The corner opposite to the longest side of a triangle. */
static int middle_of(const mesh *m, const int *v) {
  int best = 0;
  double most = -1.0;
  for (int k = 0; k < 3; ++k) {
    const double *x = m->x + 2 * v[(k + 1) % 3], *y = m->x + 2 * v[(k + 2) % 3];
    const double length = hypot(x[0] - y[0], x[1] - y[1]);
    if (length <= most) continue;
    most = length;
    best = k;
  }
  return best;
}

static int has_corner(const int *v, int node) {
  return v[0] == node || v[1] == node || v[2] == node;
}

/* gmsh leaves triangles between three nodes of a straight line that it embeds:
 * the one beyond the longest side of triangle e is cut in two at its middle
 * corner, if neither half is flat, and e becomes one of them. 1: done. */
static int cut_beyond(builder *b, int e, double far) {
  const mesh *m = b->m;
  int *v = mesh_elem_nodes(m, e), t = 0, half[2][3];
  const int k = middle_of(m, v);
  const int o = v[k], p = v[(k + 1) % 3], q = v[(k + 2) % 3];
  double det;
  for (; t < m->n_elem; ++t)
    if (t != e && has_corner(mesh_elem_nodes(m, t), p) &&
        has_corner(mesh_elem_nodes(m, t), q))
      break;
  if (t == m->n_elem || home_of(b, t) != home_of(b, e)) return 0;
  int *w = mesh_elem_nodes(m, t);
  for (int i = 0; i < 3; ++i) {
    half[0][i] = w[i] == q ? o : w[i];
    half[1][i] = w[i] == p ? o : w[i];
  }
  if (is_flat(m, half[0], far, &det) || is_flat(m, half[1], far, &det))
    return 0;
  memcpy(v, half[0], sizeof half[0]);
  memcpy(w, half[1], sizeof half[1]);
  return 1;
}

/* Several of them may lie on each other; all are cut, or none. */
static status cut_flat(builder *b, double far) {
  mesh *m = b->m;
  const size_t n = 3 * (size_t)m->n_elem;
  OWNED int *was = NULL;
  double det;
  int left = 0;
  for (int cut = 1; cut > 0;) {
    cut = left = 0;
    for (int e = 0; e < m->n_elem; ++e) {
      if (!is_flat(m, mesh_elem_nodes(m, e), far, &det)) continue;
      ++left;
      if (was == NULL) {
        PASS_NEW(was, n);
        COPY(was, m->elem, n);
      }
      cut += cut_beyond(b, e, far);
    }
  }
  if (left > 0) COPY(m->elem, was, n);
  return OK;
}

static void report_flat(const builder *b, const faults *bad) {
  message_add(b->log, P3022, b->at, "%d element(s) have no %s: %s", bad->n,
              b->m->dim == 2 ? "area" : "volume", bad->text);
}

/* 1: areas and volumes, and what they are divided by, are numbers. */
static int in_range(const builder *b, double far) {
  const double root = b->m->dim == 2 ? far : far * sqrt(far);
  if (far == 0.0) return 1; /* the elements are flat */
  if (root >= 1.0 / NUMBER_MOST && root <= NUMBER_MOST) return 1;
  message_add(b->log, P3022, b->at,
              "the coordinates, up to %g, are out of range: %s are no numbers "
              "above 0; use other units",
              far, b->m->dim == 2 ? "areas" : "volumes");
  return 0;
}

/* Turn every element to positive orientation; flat ones are reported. */
static status orient(builder *b) {
  mesh *m = b->m;
  faults bad = {0};
  int n = m->dim + 1;
  double far = largest_entry((size_t)m->dim * m->n_node, m->x), det;
  if (!in_range(b, far)) return build_check(b);
  if (m->dim == 2) PASS(cut_flat(b, far));
  for (int e = 0; e < m->n_elem; ++e) {
    int *v = mesh_elem_nodes(m, e);
    const int is_bad = is_flat(m, v, far, &det);
    if (det < 0.0) swap(&v[n - 2], &v[n - 1]);
    if (!is_bad) continue;
    double centre[3];
    fault_centre(m, n, v, centre);
    fault_at(&bad, m->dim, m->elem_no[e], centre);
  }
  if (bad.n > 0) report_flat(b, &bad);
  return build_check(b);
}

typedef struct top_list { /* top elements, corners ascending mesh nodes */
  int n_corner;
  const int *corner;
  const size_t *no;
} top_list;

static int same_corners(const top_list *t, int a, int b) {
  size_t n = t->n_corner;
  return memcmp(t->corner + n * a, t->corner + n * b, n * sizeof(int)) == 0;
}

/* The key holds the first two corners: by the others, then by number. */
static int by_corners(const void *ctx, int a, int b) {
  const top_list *t = ctx;
  const int *v = t->corner + (size_t)t->n_corner * a;
  const int *w = t->corner + (size_t)t->n_corner * b;
  for (int k = 2; k < t->n_corner; ++k)
    if (v[k] != w[k]) return v[k] < w[k] ? -1 : 1;
  return (t->no[a] > t->no[b]) - (t->no[a] < t->no[b]);
}

/* Corners become mesh nodes in ascending order; number and key of each. */
static void fill_keys(builder *b, size_t *no, sort_item *item) {
  int n = b->m->dim + 1;
  for (int i = 0; i < b->raw->n_block; ++i) {
    const raw_block *p = &b->raw->block[i];
    if (p->dim == b->m->dim) COPY(no + b->first[i], p->no, p->n);
  }
  for (int e = 0; e < b->n_top; ++e) {
    int *v = b->corner + (size_t)n * e;
    for (int k = 0; k < n; ++k) v[k] = b->node_id[v[k]];
    sort_few(n, v);
    item[e] = (sort_item){sort_key(v[0], v[1]), e};
  }
}

static int share_a_group(const raw_block *p, const raw_block *q) {
  for (int i = 0; i < p->n_physical; ++i)
    for (int j = 0; j < q->n_physical; ++j)
      if (p->physical[i] == q->physical[j]) return 1;
  return 0;
}

/* Version 2.2 lists an element once for each of its groups. */
static status check_repeated(builder *b, const top_list *t,
                             const sort_item *item) {
  faults bad = {0};
  for (int i = 1; i < b->n_top; ++i)
    for (int j = i; j > 0; --j) {
      const int one = item[j - 1].id, two = item[i].id;
      if (!same_corners(t, one, two)) break;
      if (!share_a_group(block_of(b, one), block_of(b, two))) continue;
      fault_add(&bad, "%zu and %zu", t->no[one], t->no[two]);
      break;
    }
  if (bad.n > 0)
    message_add(b->log, P3028, b->at,
                "%d element(s) have the nodes of another one of their group: "
                "%s",
                bad.n, bad.text);
  return build_check(b);
}

/* Sorted top elements to the mesh, each set of corners once. */
static status store_elements(builder *b, const top_list *t,
                             const sort_item *item) {
  mesh *m = b->m;
  size_t n = t->n_corner;
  PASS_NEW_ALL(OF(m->elem, n * b->n_top), OF(m->elem_no, b->n_top));
  for (int i = 0; i < b->n_top; ++i) {
    const int id = item[i].id;
    if (i == 0 || !same_corners(t, item[i - 1].id, id)) {
      COPY(m->elem + n * m->n_elem, t->corner + n * id, n);
      m->elem_no[m->n_elem++] = t->no[id];
    }
    b->elem_of_top[id] = m->n_elem - 1;
  }
  if (m->n_elem < b->n_top)
    message_add(b->log, P3026, b->at, "%d element(s) are listed more than once",
                b->n_top - m->n_elem);
  return OK;
}

status elements_finish(builder *b) {
  OWNED_NEW(sort_item, item, b->n_top);
  OWNED_NEW(size_t, no, b->n_top);
  PASS_NEW(b->elem_of_top, b->n_top);
  fill_keys(b, no, item);
  top_list t = {b->m->dim + 1, b->corner, no};
  PASS(sort_items(b->n_top, item, by_corners, &t));
  PASS(check_repeated(b, &t, item));
  PASS(store_elements(b, &t, item));
  PASS(numbers_check(b, "element", b->n_top, no, b->elem_of_top));
  return orient(b);
}
