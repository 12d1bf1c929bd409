/*
 * The border of a mesh, and elements that overlap: two on one side of a face,
 * or two that intersect.
 *
 * How many elements lie over a point changes only across sides on the boundary
 * once no face has two elements on one side. So where elements overlap anywhere
 * an element that owns such a side overlaps another of them, or one piece of
 * the boundary lies wholly inside of other elements: the cost is that of the
 * boundary.
 */
#include "base/base.h"
#include "base/box_tree.h"
#include "mesh/build.h"
#include "mesh/sort.h"

/* ---- sides of elements at the same face ---------------------------------- */

typedef struct side_list {
  int n;           /* sides */
  int *start;      /* [n_node+2] */
  sort_item *side; /* [n] id of mesh_side_nodes; last bit of the key: turn */
} side_list;

static void sides_free(side_list *s) { RELEASE(s->start, s->side); }

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
    two_lowest(n, m->elem + (size_t)n * e, low);
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

typedef struct meeting {
  const mesh *m;
  faults bad;
} meeting;

/* The sides [n] of elements at one face. */
static void check_face(meeting *t, int n, const sort_item *side) {
  const mesh *m = t->m;
  int first[2] = {-1, -1}, v[3];
  for (int i = 0; i < n; ++i) {
    int turn = side[i].key & 1;
    if (first[turn] < 0) {
      first[turn] = side[i].id;
      continue;
    }
    double x[3];
    mesh_side_nodes(m, side[i].id, v);
    fault_centre(m, m->dim, v, x);
    fault_pair(&t->bad, m->dim, m->elem_no[first[turn] / (m->dim + 1)],
               m->elem_no[side[i].id / (m->dim + 1)], x);
    return;
  }
}

/* *s (sides_free): those without an element behind; the other faces are checked
 * unless met is NULL. ERR_MEMORY. */
static status sides_outside(const mesh *m, meeting *met, side_list *s) {
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
        check_face(met, next - j, side);
    }
  }
  return OK;
}

status mesh_border(const mesh *m, int *n, int **side) {
  ENDS_BY(sides_free) side_list s = {0};
  PASS(sides_outside(m, NULL, &s));
  *n = s.n;
  PASS_NEW(*side, s.n);
  for (int i = 0; i < s.n; ++i) (*side)[i] = s.side[i].id;
  return OK;
}

static status check_sides(const builder *b, side_list *s) {
  meeting t = {.m = b->m};
  PASS(sides_outside(b->m, &t, s));
  if (t.bad.n > 0)
    message_add(b->log, P3032, b->at,
                "%d face(s) have two elements on one side: %s", t.bad.n,
                t.bad.text);
  return build_check(b);
}

/* ---- two elements -------------------------------------------------------- */

/* Elements that enter each other by less than this part of their width touch:
 * coordinates are written with few digits, -. */
static const double touching = 1e-6;

typedef struct pair { /* two elements over the size of the mesh */
  int n;              /* corners of each */
  double x[2][4][3];  /* from the first corner of the first; 0 for z in 2-D */
  double far;         /* largest coordinate of the mesh */
} pair;

static void load_pair(const mesh *m, int a, int b, pair *p) {
  const int id[2] = {a, b};
  size_t dim = m->dim;
  double scale = 1.0 / m->size; /* products stay in range in any unit */
  const double *from = m->x + dim * m->elem[(dim + 1) * a];
  p->n = m->dim + 1;
  memset(p->x, 0, sizeof p->x);
  for (int i = 0; i < 2; ++i)
    for (size_t k = 0; k <= dim; ++k) {
      int v = m->elem[(dim + 1) * id[i] + k];
      for (size_t d = 0; d < dim; ++d)
        p->x[i][k][d] = (m->x[dim * v + d] - from[d]) * scale;
    }
}

static void edge(const pair *p, int i, int from, int to, double *d) {
  vector_of(3, p->x[i][from], p->x[i][to], d);
}

/* Whether the elements lie side by side along a x b. An axis along which one of
 * them is below rounding decides nothing. */
static int apart(const pair *p, const double *a, const double *b) {
  double lo[2], hi[2], axis[3];
  cross(a, b, axis);
  for (int i = 0; i < 2; ++i) {
    lo[i] = hi[i] = dot(3, axis, p->x[i][0]);
    for (int k = 1; k < p->n; ++k) {
      double at = dot(3, axis, p->x[i][k]);
      if (at < lo[i]) lo[i] = at;
      if (at > hi[i]) hi[i] = at;
    }
  }
  double deep = fmin(hi[0] - lo[1], hi[1] - lo[0]);
  double width = fmin(hi[0] - lo[0], hi[1] - lo[1]);
  double noise =
      64.0 * DBL_EPSILON * sqrt(dot(3, a, a) * dot(3, b, b)) * p->far;
  return width > noise && deep <= touching * width + noise;
}

/* 1: a plane along a side of element i separates them. */
static int side_parts(const pair *p, int i) {
  static const double z[3] = {0.0, 0.0, 1.0};
  double a[3], b[3];
  for (int k = 0; k < p->n; ++k) {
    edge(p, i, k, (k + 1) % p->n, a);
    edge(p, i, k, (k + 2) % p->n, b);
    if (apart(p, a, p->n == 3 ? z : b)) return 1;
  }
  return 0;
}

/* Separating axes: normals of the sides, in space those of two edges too. */
static int intersect(const mesh *m, double far, int e, int f) {
  static const int ends[6][2] = {{0, 1}, {0, 2}, {0, 3},
                                 {1, 2}, {1, 3}, {2, 3}};
  pair p = {.far = far};
  double a[3], b[3];
  load_pair(m, e, f, &p);
  if (side_parts(&p, 0) || side_parts(&p, 1)) return 0;
  for (int i = 0; i < 6 && m->dim == 3; ++i)
    for (int j = 0; j < 6; ++j) {
      edge(&p, 0, ends[i][0], ends[i][1], a);
      edge(&p, 1, ends[j][0], ends[j][1], b);
      if (apart(&p, a, b)) return 0;
    }
  return 1;
}

/* Elements on both sides of a face are known to lie apart. */
static int share_a_side(const mesh *m, int e, int f) {
  size_t n = (size_t)m->dim + 1;
  const int *v = m->elem + n * e, *w = m->elem + n * f;
  size_t common = 0;
  for (size_t i = 0; i < n; ++i)
    for (size_t j = 0; j < n; ++j) common += v[i] == w[j];
  return common + 1 == n;
}

/* ---- which elements overlap ---------------------------------------------- */

typedef struct search {
  const builder *b;
  int n, *elem;       /* [n] ascending: those in the tree */
  box_tree tree;      /* of their boxes */
  int *found;         /* [n] */
  double far;         /* largest coordinate over the size of the mesh */
  int *body;          /* [n_elem] when it is needed */
  int e;              /* the element that is compared */
  faults same, other; /* in one body or group; what may be two bodies */
} search;

/* Of x and the side of the first element across from its corner i. */
static double corner_volume(const pair *p, int i, const double *x) {
  double d[3][3];
  int n = 0;
  for (int k = 0; k < p->n; ++k)
    if (k != i) vector_of(3, x, p->x[0][k], d[n++]);
  return determinant(n, d);
}

/* 1: the centre of element f lies in element e. Where bodies touch along a
 * curve, elements enter each other by its sag alone. */
static int holds_centre(const mesh *m, int e, int f) {
  pair p;
  double centre[3] = {0.0, 0.0, 0.0};
  load_pair(m, e, f, &p);
  for (int i = 0; i < p.n; ++i)
    for (int k = 0; k < 3; ++k) centre[k] += p.x[1][i][k] / p.n;
  for (int i = 0; i < p.n; ++i) {
    double whole = corner_volume(&p, i, p.x[0][i]);
    if (!(corner_volume(&p, i, centre) * whole > 0.0)) return 0;
  }
  return 1;
}

/* Elements of one body, or of one group and not by a sag. */
static status belong_together(search *s, int f, int *together) {
  const mesh *m = s->b->m;
  int n_body;
  if (s->body == NULL) {
    PASS_NEW(s->body, m->n_elem);
    PASS(mesh_bodies(m, &n_body, s->body));
  }
  *together = s->body[s->e] == s->body[f];
  if (*together || !(holds_centre(m, s->e, f) || holds_centre(m, f, s->e)))
    return OK;
  for (int i = 0; i < m->n_group && !*together; ++i) {
    const mesh_group *g = &m->group[i];
    *together = g->dim == m->dim &&
                number_find(s->e, g->item_id, g->n_item) >= 0 &&
                number_find(f, g->item_id, g->n_item) >= 0;
  }
  return OK;
}

static status compare(search *s, int f) {
  const mesh *m = s->b->m;
  double x[3];
  int e = s->e, together = 0;
  if (s->same.n > SHOWN || e == f || share_a_side(m, e, f) ||
      !intersect(m, s->far, e, f))
    return OK;
  PASS(belong_together(s, f, &together));
  fault_centre(m, m->dim + 1, mesh_elem_nodes(m, e), x);
  fault_pair(together ? &s->same : &s->other, m->dim, m->elem_no[e],
             m->elem_no[f], x);
  return OK;
}

/* What has a volume in common with the box of element e. */
static box_beam beam_of(const mesh *m, int e) {
  box_beam b = {.n_slab = m->dim};
  const int *v = mesh_elem_nodes(m, e);
  for (int c = 0; c < m->dim; ++c) {
    b.axis[c][c] = 1.0;
    b.low[c] = b.high[c] = mesh_node_x(m, v[0])[c];
    for (int k = 1; k <= m->dim; ++k) {
      b.low[c] = fmin(b.low[c], mesh_node_x(m, v[k])[c]);
      b.high[c] = fmax(b.high[c], mesh_node_x(m, v[k])[c]);
    }
    b.low[c] = nextafter(b.low[c], HUGE_VAL);
    b.high[c] = nextafter(b.high[c], -HUGE_VAL);
  }
  return b;
}

/* All that intersect element e, from that one of the tree on. */
static status find(search *s, int e, int from) {
  const box_beam beam = beam_of(s->b->m, e);
  const int n = box_tree_along(&s->tree, &beam, s->found);
  qsort(s->found, n, sizeof *s->found, number_order);
  s->e = e;
  for (int i = 0; i < n; ++i)
    if (s->found[i] >= from) PASS(compare(s, s->elem[s->found[i]]));
  return OK;
}

static status start_list(search *s, int n) {
  RELEASE(s->elem, s->found, s->tree.item, s->tree.of, s->tree.box);
  s->n = 0;
  PASS_NEW_ALL(OF(s->elem, n), OF(s->found, n));
  return OK;
}

static status grow_tree(search *s) {
  const mesh *m = s->b->m;
  const int dim = m->dim, n = dim + 1;
  OWNED_NEW(double, x, ((size_t)dim * n * s->n));
  for (int k = 0; k < n * s->n; ++k)
    COPY(x + (size_t)dim * k,
         mesh_node_x(m, mesh_elem_nodes(m, s->elem[k / n])[k % n]), dim);
  return box_tree_new(dim, s->n, n, x, &s->tree);
}

/* Elements that own a side of the boundary, with each other. */
static status check_skin(search *s, const char *is_skin) {
  int n = 0;
  for (int e = 0; e < s->b->m->n_elem; ++e) n += is_skin[e];
  PASS(start_list(s, n));
  for (int e = 0; e < s->b->m->n_elem; ++e)
    if (is_skin[e]) s->elem[s->n++] = e;
  PASS(grow_tree(s));
  for (int i = 0; i < n; ++i) PASS(find(s, s->elem[i], i + 1));
  return OK;
}

/* One side of each piece of the boundary, -1 for the others. A piece goes on
 * across edges (2-D: nodes) that two sides have in common. */
static status find_pieces(const mesh *m, const side_list *sides, int *piece) {
  int v[3], n = m->dim * sides->n;
  OWNED_NEW(sort_item, item, n);
  for (int i = 0; i < n; ++i) {
    int side = i / m->dim, k = i % m->dim;
    mesh_side_nodes(m, sides->side[side].id, v);
    int a = v[k], c = m->dim == 2 ? a : v[(k + 1) % 3];
    item[i] = (sort_item){a < c ? sort_key(a, c) : sort_key(c, a), side};
  }
  PASS(sort_items(n, item, NULL, NULL));
  for (int i = 0; i < sides->n; ++i) piece[i] = i;
  for (int i = 0, end; i < n; i = end) {
    end = sort_run_end(n, item, i);
    if (end == i + 2) forest_join(piece, item[i].id, item[i + 1].id);
  }
  for (int i = sides->n; i-- > 0;)
    if (piece[i] != i) piece[i] = -1;
  return OK;
}

/* One element of each piece of the boundary with the interior elements. */
static status check_inside(search *s, const side_list *sides,
                           const char *is_skin) {
  const mesh *m = s->b->m;
  OWNED_NEW(int, piece, sides->n);
  PASS(find_pieces(m, sides, piece));
  PASS(start_list(s, sides->n));
  for (int i = 0; i < sides->n; ++i)
    if (piece[i] >= 0) s->elem[s->n++] = sides->side[i].id / (m->dim + 1);
  if (s->n < 2) return OK; /* one closed surface bounds them all */
  PASS(grow_tree(s));
  for (int e = 0; e < m->n_elem; ++e)
    if (!is_skin[e]) PASS(find(s, e, 0));
  return OK;
}

static status check_skins(const builder *b, const side_list *sides) {
  const mesh *m = b->m;
  OWNED_NEW(search, s, 1);
  OWNS(s);
  s->b = b;
  for (size_t i = 0; i < (size_t)m->dim * m->n_node; ++i)
    s->far = fmax(s->far, fabs(m->x[i]) / m->size);
  OWNED_NEW(char, is_skin, m->n_elem);
  for (int i = 0; i < sides->n; ++i)
    is_skin[sides->side[i].id / (m->dim + 1)] = 1;
  PASS(check_skin(s, is_skin));
  PASS(check_inside(s, sides, is_skin));
  if (s->other.n > 0 && !b->raw->meets)
    message_add(b->log, P3043, b->at, "elements of two bodies overlap: %s",
                s->other.text);
  if (s->same.n > 0)
    message_add(b->log, P3034, b->at, "elements overlap: %s", s->same.text);
  return build_check(b);
}

status overlap_check(builder *b) {
  ENDS_BY(sides_free) side_list s = {0};
  PASS(check_sides(b, &s));
  return check_skins(b, &s);
}
