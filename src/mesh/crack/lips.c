/*
 * Both lips of each face: which is above, and the nodes, elements and faces of
 * the opened mesh.
 */
#include "mesh/crack/opening.h"
#include "mesh/sort.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

/* ---- which side is which ------------------------------------------------- */

/* A mean normal has a part along an axis if it is not below this, -. */
static const double no_part = 1e-6;

typedef struct walk { /* over one crack; edges (2-D: nodes) are dim * i + k of
                         face i */
  opening *o;
  int first, n; /* its faces are first .. first + n */
  int *beyond;  /* [dim*n] edge of the one neighbour there, -1: none or more */
  int *list;    /* [n] faces in the order of the walk */
} walk;

/* The node where edge k starts. */
static int start_of(const walk *w, int edge) {
  const mesh *m = w->o->m;
  return face_nodes(m, w->o->face[w->first + edge / m->dim])[edge % m->dim];
}

/* Neighbours across edges that two faces of the crack have in common. */
static status find_neighbours(walk *w) {
  const int dim = w->o->m->dim, n = dim * w->n;
  OWNED uint64_t *key = NULL;
  OWNED int *edge = NULL;
  PASS_NEW(key, n);
  PASS_NEW(edge, n);
  for (int i = 0; i < n; ++i) {
    int next = dim == 2 ? i : i - i % 3 + (i % 3 + 1) % 3;
    int v[2] = {start_of(w, i), start_of(w, next)};
    sort_few(2, v);
    key[i] = (uint64_t)v[0] << 32 | (uint64_t)v[1];
    edge[i] = i;
    w->beyond[i] = -1;
  }
  PASS(sort_by_key(n, key, edge, NULL, NULL));
  for (int i = 0, end; i < n; i = end) {
    for (end = i + 1; end < n && key[end] == key[i];) ++end;
    if (end != i + 2) continue;
    w->beyond[edge[i]] = edge[i + 1];
    w->beyond[edge[i + 1]] = edge[i];
  }
  return OK;
}

/* Faces turned alike: one line goes on from the first to the second node, two
 * triangles have their common edge in opposite directions. */
static int turned_alike(const walk *w, int a, int b) {
  return w->o->m->dim == 2 ? a % 2 != b % 2 : start_of(w, a) != start_of(w, b);
}

/* From face list[from] over its piece, all signs relative to the first; returns
 * the end of the piece in list. 0 signs: not reached yet. */
static int walk_piece(walk *w, int from, faults *bad) {
  const int dim = w->o->m->dim;
  signed char *sign = w->o->sign + w->first;
  int n = from + 1;
  for (int i = from; i < n; ++i)
    for (int k = 0; k < dim; ++k) {
      int face = w->list[i], a = dim * face + k, b = w->beyond[a];
      if (b < 0) continue;
      signed char want = turned_alike(w, a, b) ? sign[face] : -sign[face];
      if (sign[b / dim] == 0) {
        sign[b / dim] = want;
        w->list[n++] = b / dim;
      } else if (sign[b / dim] != want) {
        opening_note(w->o, w->o->face[w->first + b / dim], bad);
      }
    }
  return n;
}

/* Minus to plus points to the upper end of the last axis in which the mean
 * normal has a part. */
static void turn_up(walk *w, int from, int to) {
  const mesh *m = w->o->m;
  signed char *sign = w->o->sign + w->first;
  double sum[3] = {0.0, 0.0, 0.0}, total = 0.0, normal[3];
  for (int i = from; i < to; ++i) {
    int face = w->list[i];
    double size = mesh_face_normal(m, w->o->face[w->first + face], normal);
    for (int k = 0; k < m->dim; ++k) sum[k] += sign[face] * normal[k] * size;
    total += size;
  }
  int k = m->dim - 1;
  while (k > 0 && fabs(sum[k]) < no_part * total) --k;
  if (sum[k] >= -no_part * total) return;
  for (int i = from; i < to; ++i)
    sign[w->list[i]] = (signed char)-sign[w->list[i]];
}

static status orient_crack(opening *o, int crack) {
  OWNED int *beyond = NULL, *list = NULL;
  const int first = o->first[crack], n = o->first[crack + 1] - first;
  faults bad = {0};
  PASS_NEW(beyond, o->m->dim * n);
  PASS_NEW(list, n);
  walk w = {o, first, n, beyond, list};
  PASS(find_neighbours(&w));
  for (int i = 0, end = 0; i < n; ++i) {
    if (o->sign[first + i] != 0) continue;
    int from = end;
    o->sign[first + i] = 1;
    list[from] = i;
    end = walk_piece(&w, from, &bad);
    turn_up(&w, from, end);
  }
  if (bad.n > 0)
    message_add(o->log, P3053, o->cut[crack].at,
                "crack along %s: above and below cannot be told apart at %d "
                "face(s), of element %s",
                o->cut[crack].group->name, bad.n, bad.text);
  return OK;
}

status lips_orient(opening *o) {
  PASS_NEW(o->sign, o->n_face);
  for (int k = 0; k < o->n; ++k) PASS(orient_crack(o, k));
  return OK;
}

/* ---- the opened mesh ----------------------------------------------------- */

static status add_nodes(opening *o) {
  mesh *m = o->m;
  const size_t dim = (size_t)m->dim, old = (size_t)m->n_node;
  const size_t n = old + (size_t)o->n_copy;
  size_t last = 0;
  void *grown;
  for (size_t i = 0; i < old; ++i)
    if (m->node_no[i] > last) last = m->node_no[i];
#define RESIZE(array, per, from, to)                                          \
  do {                                                                        \
    grown =                                                                   \
        memory_resize(array, (per) * (from), (per) * (to), sizeof *(array));  \
    if (grown == NULL) RAISE(ERR_MEMORY, "memory exhausted: an opened mesh"); \
    (array) = grown;                                                          \
  } while (0)
  RESIZE(m->x, dim, old, n);
  RESIZE(m->node_no, 1, old, n);
  PASS_NEW(m->origin, n);
  for (size_t i = 0; i < n; ++i) m->origin[i] = (int)i;
  for (size_t i = old; i < n; ++i) {
    int from = o->copy_of[i - old];
    memcpy(m->x + dim * i, node_x(m, from), dim * sizeof *m->x);
    m->node_no[i] = last + 1 + (i - old);
    m->origin[i] = from;
  }
  m->n_node = (int)n;
  return OK;
}

/* The lowest node of a triangle stands first. */
static void lowest_first(int *v) {
  while (v[0] > v[1] || v[0] > v[2]) {
    int t = v[0];
    v[0] = v[1];
    v[1] = v[2];
    v[2] = t;
  }
}

/* The nodes of a face as its element now has them. */
static void follow_element(const opening *o, int face_id) {
  const mesh *m = o->m;
  const int first = (m->dim + 1) * o->place[m->face_elem[face_id]];
  int *v = face_nodes(m, face_id);
  for (int k = 0; k < m->dim; ++k) {
    if (!o->on_crack[v[k]]) continue;
    const int *w = elem_nodes(m, m->face_elem[face_id]);
    int c = 0;
    while (w[c] != v[k]) ++c;
    v[k] = o->node[first + c];
  }
  if (m->dim == 3) lowest_first(v);
}

/* Face i of the cracks becomes two. */
static void part_lips(opening *o, int i, int *plus, int *minus) {
  mesh *m = o->m;
  const int f = o->face[i], g = m->n_face++;
  const int *v = face_nodes(m, f);
  int *w = face_nodes(m, g);
  memcpy(w, v, (size_t)m->dim * sizeof *w);
  w[m->dim - 2] = v[m->dim - 1];
  w[m->dim - 1] = v[m->dim - 2];
  m->face_elem[g] = m->face_other[f];
  m->face_other[f] = m->face_other[g] = -1;
  *plus = o->sign[i] > 0 ? g : f;
  *minus = o->sign[i] > 0 ? f : g;
}

static status add_faces(opening *o) {
  mesh *m = o->m;
  const size_t dim = (size_t)m->dim, old = (size_t)m->n_face;
  const size_t n = old + (size_t)o->n_face;
  void *grown;
  RESIZE(m->face, dim, old, n);
  RESIZE(m->face_elem, 1, old, n);
  RESIZE(m->face_other, 1, old, n);
  for (int k = 0; k < o->n; ++k) {
    mesh_crack *c = &o->crack[k];
    c->n = o->first[k + 1] - o->first[k];
    PASS_NEW(c->plus, c->n);
    PASS_NEW(c->minus, c->n);
    for (int i = 0; i < c->n; ++i)
      part_lips(o, o->first[k] + i, &c->plus[i], &c->minus[i]);
  }
  return OK;
}

static int near_crack(const opening *o, const int *v) {
  int near = 0;
  for (int k = 0; k < o->m->dim; ++k) near |= o->on_crack[v[k]];
  return near;
}

status lips_store(opening *o) {
  mesh *m = o->m;
  const int per = m->dim + 1;
  PASS(add_faces(o));
  for (int f = 0; f < m->n_face; ++f)
    if (near_crack(o, face_nodes(m, f))) follow_element(o, f);
  PASS(add_nodes(o));
  for (int c = 0; c < per * o->n_elem; ++c)
    if (o->node[c] >= 0) elem_nodes(m, o->elem[c / per])[c % per] = o->node[c];
  return OK;
}
