/*
 * The front: edges (2-D: nodes) of the crack round which all elements hang
 * together.
 */
#include "mesh/crack/opening.h"
#include "mesh/sort.h"

#include "base/memory.h"

#include <string.h>

typedef struct front_edge {
  int face;    /* of the crack */
  int node[2]; /* along the front; 2-D: [0] */
} front_edge;

typedef struct edge_list {
  int n, capacity;
  front_edge *edge;
} edge_list;

static int holds(const mesh *m, const int *v, const int *edge) {
  int found = 0;
  for (int k = 0; k < m->dim; ++k)
    for (int i = 0; i < m->dim - 1; ++i) found += v[k] == edge[i];
  return found == m->dim - 1;
}

/* From a lip round the edge through all elements to the next side that is cut
 * or on the boundary. */
static int last_side(const opening *o, int lip, const int *edge) {
  const int per = o->m->dim + 1;
  int at = lip, v[3];
  for (;;) {
    int first = at - at % per, other = first;
    for (;; ++other) {
      faces_side(o->m, o->elem[first / per], other - first, v);
      if (other != at && holds(o->m, v, edge)) break;
    }
    if (o->across[other] < 0) return other;
    at = o->across[other];
  }
}

/* An edge is at the front if the way round it ends on the other lip. Edges run
 * as the nodes of the plus lip. */
static status gather_edges(const opening *o, int crack, edge_list *list) {
  const mesh *m = o->m;
  const mesh_crack *c = &o->crack[crack];
  for (int i = 0; i < c->n; ++i) {
    int face = o->first[crack] + i;
    const int *lip = o->lip + 2 * face, *v = face_nodes(m, c->plus[i]);
    int above = o->sign[face] > 0 ? lip[1] : lip[0];
    for (int k = 0; k < m->dim; ++k) {
      const int edge[2] = {v[k], v[(k + 1) % m->dim]};
      if (last_side(o, above, edge) != lip[0] + lip[1] - above) continue;
      PASS_GROW(list->edge, list->n, list->capacity);
      list->edge[list->n++] = (front_edge){i, {edge[0], edge[1]}};
    }
  }
  return OK;
}

/* next[n]: the edge that goes on where one ends, -1: none, or several; last[n]
 * 1: nothing comes before. */
static status link_edges(const edge_list *list, int *next, char *is_first) {
  OWNED uint64_t *key = NULL;
  OWNED int *end = NULL;
  const int n = 2 * list->n;
  PASS_NEW(key, n);
  PASS_NEW(end, n);
  for (int i = 0; i < n; ++i) {
    key[i] = (uint64_t)list->edge[i / 2].node[i % 2];
    end[i] = i;
  }
  for (int i = 0; i < list->n; ++i) {
    next[i] = -1;
    is_first[i] = 1;
  }
  PASS(sort_by_key(n, key, end, NULL, NULL));
  for (int i = 0, after; i < n; i = after) {
    for (after = i + 1; after < n && key[after] == key[i];) ++after;
    if (after != i + 2 || end[i] % 2 == end[i + 1] % 2) continue;
    int comes = end[i] % 2 == 1 ? end[i] : end[i + 1];
    int goes = end[i] + end[i + 1] - comes;
    next[comes / 2] = goes / 2;
    is_first[goes / 2] = 0;
  }
  return OK;
}

static void add_node(mesh_crack *c, int *n, int node, int face) {
  c->front_node[*n] = node;
  c->front_face[(*n)++] = face;
}

/* From one edge to the end of its chain, or once round. */
static void follow(const edge_list *list, int from, const int *next,
                   char *is_done, mesh_crack *c) {
  int n = c->front_start[c->n_front], i = from, last = from;
  for (; i >= 0 && !is_done[i]; i = next[i]) {
    add_node(c, &n, list->edge[i].node[0], list->edge[i].face);
    is_done[i] = 1;
    last = i;
  }
  add_node(c, &n, list->edge[last].node[1], -1);
  c->front_start[++c->n_front] = n;
}

static status chain_edges(const edge_list *list, mesh_crack *c) {
  OWNED int *next = NULL;
  OWNED char *is_first = NULL, *is_done = NULL;
  PASS_NEW(next, list->n);
  PASS_NEW(is_first, list->n);
  PASS_NEW(is_done, list->n);
  PASS(link_edges(list, next, is_first));
  for (int i = 0; i < list->n; ++i)
    if (is_first[i]) follow(list, i, next, is_done, c);
  for (int i = 0; i < list->n; ++i)
    if (!is_done[i]) follow(list, i, next, is_done, c);
  return OK;
}

static status find_front(const opening *o, int crack) {
  mesh_crack *c = &o->crack[crack];
  OWNED front_edge *edge = NULL;
  edge_list list = {0};
  status st = gather_edges(o, crack, &list);
  edge = list.edge;
  PASS(st);
  PASS_NEW(c->front_start, list.n + 1);
  PASS_NEW(c->front_node, 2 * list.n);
  PASS_NEW(c->front_face, 2 * list.n);
  if (o->m->dim == 3) return chain_edges(&list, c);
  for (int i = 0; i < list.n; ++i) {
    add_node(c, &c->n_front, list.edge[i].node[0], list.edge[i].face);
    c->front_start[c->n_front] = c->n_front;
  }
  return OK;
}

status fronts_find(opening *o) {
  for (int k = 0; k < o->n; ++k) PASS(find_front(o, k));
  return OK;
}
