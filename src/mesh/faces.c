/*
 * Faces of the groups: one id for each set of nodes, turned outward from the
 * element they bound, with the element on the other side; elements that
 * overlap.
 */
#include "mesh/build.h"
#include "mesh/sort.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

typedef struct face_list {
  int dim;
  int *low;     /* [dim*n_low] mesh nodes ascending, -1: not in the mesh     */
  size_t *no;   /* [n_low] number in the file                                */
  int *start;   /* [n_node+1] faces whose lowest node is i                   */
  int *corner;  /* [dim*n_face] ascending                                    */
  int *example; /* [n_face] a low element of the face                        */
} face_list;

static void release(face_list *f) {
  memory_free(f->low);
  memory_free(f->no);
  memory_free(f->start);
  memory_free(f->corner);
  memory_free(f->example);
}

static void sort_corners(int *v, int n) {
  for (int i = 1; i < n; ++i)
    for (int j = i; j > 0 && v[j - 1] > v[j]; --j) {
      int t = v[j];
      v[j] = v[j - 1];
      v[j - 1] = t;
    }
}

/* By the third corner, then by place in the file; the key holds two. */
static int by_corners(const void *ctx, int a, int b) {
  const face_list *f = ctx;
  if (f->dim == 3) {
    int v = f->low[3 * (size_t)a + 2], w = f->low[3 * (size_t)b + 2];
    if (v != w) return v < w ? -1 : 1;
  }
  return (f->no[a] > f->no[b]) - (f->no[a] < f->no[b]);
}

static void find_centre(const builder *b, const raw_block *p, size_t i,
                        double *x) {
  memset(x, 0, 3 * sizeof *x);
  for (size_t k = 0; k < p->n_per; ++k) {
    int r = nodes_find(b, p->node[p->n_per * i + k]);
    for (size_t d = 0; d < 3 && r >= 0; ++d)
      x[d] += b->raw->xyz[3 * (size_t)r + d] * b->scale / (double)p->n_per;
  }
}

/* Number and place of low element j, for a message. */
static void tell(const builder *b, int j, culprits *bad) {
  int i = 0;
  while (b->raw->block[i].dim != b->m->dim - 1 || j < b->first[i] ||
         (size_t)(j - b->first[i]) >= b->raw->block[i].n)
    ++i;
  const raw_block *p = &b->raw->block[i];
  size_t item = (size_t)(j - b->first[i]);
  double x[3];
  find_centre(b, p, item, x);
  culprit_at(bad, b->m->dim, p->no[item], x);
}

/* Corners as mesh nodes; faces with nodes outside of the mesh go to bad. */
static status gather(builder *b, face_list *f, culprits *bad) {
  status st = OK;
  size_t dim = (size_t)f->dim;
  NEW(f->low, dim * (size_t)b->n_low);
  NEW(f->no, b->n_low);
  for (int i = 0; i < b->raw->n_block; ++i) {
    const raw_block *p = &b->raw->block[i];
    if (p->dim != f->dim - 1) continue;
    memcpy(f->no + b->first[i], p->no, p->n * sizeof *f->no);
    int *v = f->low + dim * (size_t)b->first[i];
    for (size_t j = 0; j < dim * p->n; ++j) {
      int r = nodes_find(b, p->node[j]);
      v[j] = r < 0 ? -1 : b->node_id[r];
    }
  }
  for (int j = 0; j < b->n_low; ++j) {
    int *v = f->low + dim * (size_t)j;
    sort_corners(v, f->dim);
    if (v[0] < 0) tell(b, j, bad);
  }
done:
  return st;
}

/* Sort the low elements and give every set of corners one id. */
static status number_faces(builder *b, face_list *f) {
  status st = OK;
  mesh *m = b->m;
  uint64_t *key = NULL;
  int *id = NULL;
  size_t dim = (size_t)f->dim, bytes = dim * sizeof(int);
  NEW(key, b->n_low);
  NEW(id, b->n_low);
  NEW(b->face_of_low, b->n_low);
  NEW(f->corner, dim * (size_t)b->n_low);
  NEW(f->example, b->n_low);
  int n = 0;
  for (int j = 0; j < b->n_low; ++j) {
    const int *v = f->low + dim * (size_t)j;
    b->face_of_low[j] = -1;
    if (v[0] < 0) continue;
    key[n] = (uint64_t)v[0] << 32 | (uint64_t)v[1];
    id[n++] = j;
  }
  TRY(sort_by_key(n, key, id, by_corners, f));
  for (int i = 0; i < n; ++i) {
    const int *v = f->low + dim * (size_t)id[i];
    int last = m->n_face - 1;
    if (last < 0 || memcmp(f->corner + dim * (size_t)last, v, bytes) != 0) {
      memcpy(f->corner + dim * (size_t)++last, v, bytes);
      f->example[m->n_face++] = id[i];
    }
    b->face_of_low[id[i]] = last;
  }
  if (m->n_face < n)
    message_add(b->log, P3031, b->at, "%d face(s) are listed more than once",
                n - m->n_face);
done:
  memory_free(key);
  memory_free(id);
  return st;
}

/* The face with these ascending corners, or -1. */
static int find_face(const face_list *f, const int *v) {
  for (int i = f->start[v[0]]; i < f->start[v[0] + 1]; ++i)
    if (memcmp(f->corner + (size_t)f->dim * (size_t)i, v,
               (size_t)f->dim * sizeof(int)) == 0)
      return i;
  return -1;
}

void faces_side(const mesh *m, int elem, int side, int *v) {
  /* clang-format off */
  static const int side_2d[3][2] = {{0, 1}, {1, 2}, {2, 0}};
  static const int side_3d[4][3] = {{1, 2, 3}, {0, 3, 2}, {0, 1, 3}, {0, 2, 1}};
  /* clang-format on */
  const int *w = m->elem + (size_t)(m->dim + 1) * (size_t)elem;
  if (m->dim == 2) {
    for (int k = 0; k < 2; ++k) v[k] = w[side_2d[side][k]];
    return;
  }
  int s[3], k = 0;
  for (int i = 0; i < 3; ++i) {
    s[i] = w[side_3d[side][i]];
    if (s[i] < s[k]) k = i;
  }
  for (int i = 0; i < 3; ++i) v[i] = s[(k + i) % 3];
}

/* One side of an element. */
static void meet(mesh *m, face_list *f, int elem, int side) {
  size_t dim = (size_t)f->dim;
  int outward[3], v[3];
  faces_side(m, elem, side, outward);
  memcpy(v, outward, dim * sizeof *v);
  sort_corners(v, f->dim);
  int face = find_face(f, v);
  if (face < 0) return;
  if (m->face_elem[face] >= 0) {
    m->face_other[face] = elem;
    return;
  }
  memcpy(m->face + dim * (size_t)face, outward, dim * sizeof(int));
  m->face_elem[face] = elem;
}

static status find_elements(builder *b, face_list *f) {
  status st = OK;
  mesh *m = b->m;
  size_t dim = (size_t)f->dim;
  NEW(m->face, dim * (size_t)m->n_face);
  NEW(m->face_elem, m->n_face);
  NEW(m->face_other, m->n_face);
  NEW(f->start, m->n_node + 1);
  for (int i = 0; i < m->n_face; ++i) {
    m->face_elem[i] = m->face_other[i] = -1;
    ++f->start[f->corner[dim * (size_t)i] + 1];
  }
  for (int i = 0; i < m->n_node; ++i) f->start[i + 1] += f->start[i];
  for (int e = 0; e < m->n_elem; ++e)
    for (int side = 0; side <= m->dim; ++side) meet(m, f, e, side);
done:
  return st;
}

status faces_finish(builder *b) {
  status st = OK;
  face_list f = {.dim = b->m->dim};
  culprits alone = {0};
  TRY(gather(b, &f, &alone));
  TRY(number_faces(b, &f));
  TRY(numbers_check(b, "face", b->n_low, f.no, b->face_of_low));
  TRY(find_elements(b, &f));
  for (int i = 0; i < b->m->n_face; ++i)
    if (b->m->face_elem[i] < 0) tell(b, f.example[i], &alone);
  if (alone.n > 0)
    message_add(b->log, P3030, b->at, "%d face(s) bound no element: %s",
                alone.n, alone.text);
  TRY(build_check(b));
done:
  release(&f);
  return st;
}

/* ---- elements that overlap ----------------------------------------------- */

/* Two are on one side of a face, they fill more than the full angle round a
 * node, or a side on the boundary runs from one of its nodes into an element
 * of that node. Bodies without common nodes may penetrate each other. */

/* Angles up to this part of the full one are rounding, -. */
static const double rounding = 1e-6;

static double dot(int n, const double *a, const double *b) {
  double sum = 0.0;
  for (int k = 0; k < n; ++k) sum += a[k] * b[k];
  return sum;
}

static void cross(const double *a, const double *b, double *c) {
  for (int k = 0; k < 3; ++k)
    c[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

/* Between two nodes, over the size of the mesh: products stay in range in any
 * unit. */
static void edge(const mesh *m, int from, int to, double *d) {
  const double *x = m->x + (size_t)m->dim * (size_t)from,
               *y = m->x + (size_t)m->dim * (size_t)to;
  double scale = 1.0 / m->size;
  for (int k = 0; k < m->dim; ++k) d[k] = (y[k] - x[k]) * scale;
}

static double norm(int n, const double *d) { return sqrt(dot(n, d, d)); }

static void direction(const mesh *m, int from, int to, double *d) {
  edge(m, from, to, d);
  double length = norm(m->dim, d);
  for (int k = 0; k < m->dim; ++k) d[k] /= length;
}

/* ---- angles round a node ------------------------------------------------- */

/* Angle of the element at its corner i over the full one; in space the solid
 * angle (van Oosterom and Strackee 1983). */
static double share_of_angle(const mesh *m, const int *v, int i) {
  double d[3][3], c[3];
  for (int k = 1; k <= m->dim; ++k)
    edge(m, v[i], v[(i + k) % (m->dim + 1)], d[k - 1]);
  if (m->dim == 2) {
    double across = d[0][0] * d[1][1] - d[0][1] * d[1][0];
    return atan2(fabs(across), dot(2, d[0], d[1])) / (2.0 * acos(-1.0));
  }
  cross(d[1], d[2], c);
  double p = norm(3, d[0]), q = norm(3, d[1]), r = norm(3, d[2]);
  double below = p * q * r + dot(3, d[0], d[1]) * r + dot(3, d[1], d[2]) * p +
                 dot(3, d[2], d[0]) * q;
  return atan2(fabs(dot(3, d[0], c)), below) / (2.0 * acos(-1.0));
}

static status tell_nodes(const builder *b, const double *share) {
  const mesh *m = b->m;
  culprits bad = {0};
  for (int i = 0; i < m->n_node; ++i)
    if (share[i] > 1.0 + rounding)
      culprit_at(&bad, m->dim, m->node_no[i],
                 m->x + (size_t)m->dim * (size_t)i);
  if (bad.n > 0)
    message_add(b->log, P3034, b->at,
                "the elements round %d node(s) overlap: %s", bad.n, bad.text);
  return build_check(b);
}

static status check_angles(const builder *b, double *share) {
  const mesh *m = b->m;
  size_t n = (size_t)m->dim + 1;
  for (int e = 0; e < m->n_elem; ++e)
    for (int i = 0; i <= m->dim; ++i) {
      const int *v = m->elem + n * (size_t)e;
      share[v[i]] += share_of_angle(m, v, i);
    }
  return tell_nodes(b, share);
}

/* ---- both sides of a face ------------------------------------------------ */

typedef struct side_list {
  int n;         /* sides of elements; after check_sides, on the boundary   */
  int *start;    /* [n_node+2] sides whose lowest node is i                 */
  uint64_t *key; /* [n] the other nodes                                     */
  int *id;       /* [n] (dim+1) * element + side                            */
} side_list;

static void side_nodes(const mesh *m, int id, int *v) {
  faces_side(m, id / (m->dim + 1), id % (m->dim + 1), v);
}

static int lowest(const mesh *m, const int *v) {
  return m->dim == 2 && v[1] < v[0] ? v[1] : v[0];
}

/* Two elements on both sides of a face turn it in opposite ways. */
static int turn(const mesh *m, int id) {
  int v[3];
  side_nodes(m, id, v);
  return v[m->dim - 2] < v[m->dim - 1];
}

static status gather_sides(const mesh *m, side_list *s) {
  status st = OK;
  int v[3];
  s->n = (m->dim + 1) * m->n_elem;
  NEW(s->start, m->n_node + 2);
  NEW(s->key, s->n);
  NEW(s->id, s->n);
  for (int i = 0; i < s->n; ++i) {
    side_nodes(m, i, v);
    ++s->start[lowest(m, v) + 2];
  }
  for (int i = 1; i < m->n_node; ++i) s->start[i + 1] += s->start[i];
  for (int i = 0; i < s->n; ++i) {
    side_nodes(m, i, v);
    int to = s->start[lowest(m, v) + 1]++;
    int a = v[m->dim - 2], c = v[m->dim - 1];
    uint64_t low = (uint64_t)(a < c ? a : c), high = (uint64_t)(a < c ? c : a);
    s->key[to] = m->dim == 2 ? high : low << 32 | high;
    s->id[to] = i;
  }
done:
  return st;
}

/* The sides [n] of elements at one face. */
static void check_face(const mesh *m, const int *id, int n, culprits *bad) {
  int first[2] = {-1, -1}, v[3];
  for (int i = 0; i < n; ++i) {
    int t = turn(m, id[i]);
    if (first[t] < 0) {
      first[t] = id[i];
      continue;
    }
    double x[3] = {0.0, 0.0, 0.0};
    side_nodes(m, id[i], v);
    for (int j = 0; j < m->dim; ++j)
      for (int k = 0; k < m->dim; ++k)
        x[k] += m->x[(size_t)m->dim * (size_t)v[j] + (size_t)k] / m->dim;
    size_t one = m->elem_no[first[t] / (m->dim + 1)],
           two = m->elem_no[id[i] / (m->dim + 1)];
    if (m->dim == 2)
      culprit_add(bad, "%zu and %zu at (%.6g, %.6g)", one, two, x[0], x[1]);
    else
      culprit_add(bad, "%zu and %zu at (%.6g, %.6g, %.6g)", one, two, x[0],
                  x[1], x[2]);
    return;
  }
}

/* What stays in the list are the sides without an element behind. */
static status check_sides(const builder *b, side_list *s) {
  status st = OK;
  const mesh *m = b->m;
  culprits bad = {0};
  s->n = 0;
  for (int i = 0; i < m->n_node; ++i) {
    int end = s->start[i + 1];
    TRY(sort_by_key(end - s->start[i], s->key + s->start[i],
                    s->id + s->start[i], NULL, NULL));
    for (int j = s->start[i], next; j < end; j = next) {
      for (next = j + 1; next < end && s->key[next] == s->key[j];) ++next;
      if (next == j + 1)
        s->id[s->n++] = s->id[j];
      else
        check_face(m, s->id + j, next - j, &bad);
    }
  }
  if (bad.n > 0)
    message_add(b->log, P3032, b->at,
                "%d face(s) have two elements on one side: %s", bad.n,
                bad.text);
  TRY(build_check(b));
done:
  return st;
}

/* ---- sides inside of elements -------------------------------------------- */

typedef struct fans { /* elements round the nodes of the boundary            */
  int *start;         /* [n_node+2]                                          */
  int *elem;
} fans;

static status gather_fans(const mesh *m, const side_list *s, fans *f) {
  status st = OK;
  char *on_boundary = NULL;
  int v[3], n = (m->dim + 1) * m->n_elem;
  NEW(on_boundary, m->n_node);
  NEW(f->start, m->n_node + 2);
  for (int i = 0; i < s->n; ++i) {
    side_nodes(m, s->id[i], v);
    for (int k = 0; k < m->dim; ++k) on_boundary[v[k]] = 1;
  }
  for (int i = 0; i < n; ++i)
    if (on_boundary[m->elem[i]]) ++f->start[m->elem[i] + 2];
  for (int i = 1; i <= m->n_node; ++i) f->start[i + 1] += f->start[i];
  NEW(f->elem, f->start[m->n_node + 1]);
  for (int i = 0; i < n; ++i)
    if (on_boundary[m->elem[i]])
      f->elem[f->start[m->elem[i] + 1]++] = i / (m->dim + 1);
done:
  memory_free(on_boundary);
  return st;
}

/* Whether d, from a node of the element, points between its edges there. */
static int points_into(const mesh *m, int elem, int node, const double *d) {
  const int *v = m->elem + (size_t)(m->dim + 1) * (size_t)elem;
  double e[3][3], c[3];
  int i = 0;
  while (v[i] != node) ++i;
  for (int k = 1; k <= m->dim; ++k)
    edge(m, node, v[(i + k) % (m->dim + 1)], e[k - 1]);
  if (m->dim == 2)
    return e[0][0] * d[1] - e[0][1] * d[0] > rounding * norm(2, e[0]) &&
           d[0] * e[1][1] - d[1] * e[1][0] > rounding * norm(2, e[1]);
  for (int k = 0; k < 3; ++k) {
    cross(e[(k + 1) % 3], e[(k + 2) % 3], c);
    double above = dot(3, c, d), length = norm(3, c);
    if (dot(3, c, e[k]) < 0.0) above = -above;
    if (above <= rounding * length) return 0;
  }
  return 1;
}

/* From corner k of the side along an edge and, in 3-D, between both edges;
 * the other edge belongs to the next side of the boundary. */
static int runs_inside(const mesh *m, const fans *f, const int *v, int k) {
  double d[3], other[3];
  direction(m, v[k], v[(k + 1) % m->dim], d);
  direction(m, v[k], v[(k + m->dim - 1) % m->dim], other);
  for (int j = 0; j < m->dim; ++j) other[j] += d[j];
  for (int i = f->start[v[k]]; i < f->start[v[k] + 1]; ++i)
    if (points_into(m, f->elem[i], v[k], d) ||
        points_into(m, f->elem[i], v[k], other))
      return 1;
  return 0;
}

static status check_boundary(const builder *b, const side_list *s,
                             double *share) {
  status st = OK;
  const mesh *m = b->m;
  fans f = {0};
  TRY(gather_fans(m, s, &f));
  for (int i = 0; i < s->n; ++i) {
    int v[3];
    side_nodes(m, s->id[i], v);
    for (int k = 0; k < m->dim; ++k)
      if (runs_inside(m, &f, v, k)) share[v[k]] = 2.0;
  }
  TRY(tell_nodes(b, share));
done:
  memory_free(f.start);
  memory_free(f.elem);
  return st;
}

status overlap_check(builder *b) {
  status st = OK;
  side_list s = {0};
  double *share = NULL;
  NEW(share, b->m->n_node);
  TRY(gather_sides(b->m, &s));
  TRY(check_sides(b, &s));
  TRY(check_angles(b, share));
  TRY(check_boundary(b, &s, share));
done:
  memory_free(share);
  memory_free(s.start);
  memory_free(s.key);
  memory_free(s.id);
  return st;
}
