/*
 * mesh_open: which faces are cut, what is on their sides, and the fans of
 * elements round each node.
 */
#include "mesh/crack/opening.h"
#include "mesh/sort.h"

#include "base/memory.h"

#include <string.h>

static void release(opening *o) {
  RELEASE(o->group_id, o->first, o->face, o->lip, o->sign, o->on_crack, o->elem,
          o->place, o->across, o->node, o->copy_of);
}

/* ---- the faces ----------------------------------------------------------- */

/* owner[n_face] of the mesh: the crack of a face, counted from 1. */
static void take_group(opening *o, int crack, int *owner) {
  const mesh *m = o->m;
  const mesh_group *g = o->cut[crack].group;
  const place *at = o->cut[crack].at;
  faults outer = {0}, twice = {0};
  for (int i = 0; i < g->n_item; ++i) {
    int f = g->item_id[i];
    if (m->face_other[f] < 0) {
      opening_note(o, f, &outer);
    } else if (owner[f] > 0) {
      opening_note(o, f, &twice);
    } else {
      owner[f] = crack + 1;
      o->face[o->n_face++] = f;
    }
  }
  if (outer.n > 0)
    message_add(o->log, P3050, at,
                "crack along %s: %d face(s) lie on the boundary, of element %s",
                g->name, outer.n, outer.text);
  if (twice.n > 0)
    message_add(o->log, P3051, at,
                "crack along %s: %d face(s) belong to another crack, of "
                "element %s",
                g->name, twice.n, twice.text);
}

static int has_dimension(const opening *o, int crack) {
  static const char *const words[] = {"points", "curves", "surfaces",
                                      "volumes"};
  const mesh_group *g = o->cut[crack].group;
  int dim = o->m->dim;
  if (g->dim == dim - 1) return 1;
  message_add(o->log, P2022, o->cut[crack].at,
              "crack along %s: the group is made of %s; %s are needed in %d-D",
              g->name, words[g->dim], words[dim - 1], dim);
  return 0;
}

static status take_faces(opening *o) {
  const mesh *m = o->m;
  OWNED int *owner = NULL;
  int most = 0;
  for (int k = 0; k < o->n; ++k) most += o->cut[k].group->n_item;
  PASS_NEW(owner, m->n_face);
  PASS_NEW(o->group_id, o->n);
  PASS_NEW(o->first, o->n + 1);
  PASS_NEW(o->face, most);
  for (int k = 0; k < o->n; ++k) {
    o->group_id[k] = (int)(o->cut[k].group - m->group);
    if (has_dimension(o, k)) take_group(o, k, owner);
    o->first[k + 1] = o->n_face;
  }
  return opening_check(o);
}

/* ---- the elements round them --------------------------------------------- */

static status gather_elements(opening *o) {
  const mesh *m = o->m;
  PASS_NEW(o->on_crack, m->n_node);
  PASS_NEW(o->place, m->n_elem);
  for (int i = 0; i < o->n_face; ++i)
    for (int k = 0; k < m->dim; ++k)
      o->on_crack[face_nodes(m, o->face[i])[k]] = 1;
  for (int e = 0; e < m->n_elem; ++e) {
    const int *v = elem_nodes(m, e);
    int near = 0;
    for (int k = 0; k <= m->dim; ++k) near |= o->on_crack[v[k]];
    o->place[e] = near ? o->n_elem++ : -1;
  }
  PASS_NEW(o->elem, o->n_elem);
  for (int e = 0; e < m->n_elem; ++e)
    if (o->place[e] >= 0) o->elem[o->place[e]] = e;
  return OK;
}

/* Ascending nodes of a side of a near element. */
static void side_nodes(const opening *o, int side, int *v) {
  const int per = o->m->dim + 1;
  faces_side(o->m, o->elem[side / per], side % per, v);
  sort_few(o->m->dim, v);
}

static int by_third_node(const void *ctx, int a, int b) {
  int v[3] = {0}, w[3] = {0};
  side_nodes(ctx, a, v);
  side_nodes(ctx, b, w);
  return (v[2] > w[2]) - (v[2] < w[2]);
}

/* Sides with the same nodes are one face: no face has more than two. */
static status pair_sides(opening *o) {
  OWNED uint64_t *key = NULL;
  OWNED int *side = NULL;
  const int dim = o->m->dim, n_side = (dim + 1) * o->n_elem;
  int n = 0, v[3], w[3];
  PASS_NEW(key, n_side);
  PASS_NEW(side, n_side);
  PASS_NEW(o->across, n_side);
  for (int s = 0; s < n_side; ++s) {
    o->across[s] = -1;
    side_nodes(o, s, v);
    int touches = 0;
    for (int k = 0; k < dim; ++k) touches |= o->on_crack[v[k]];
    if (!touches) continue;
    key[n] = (uint64_t)v[0] << 32 | (uint64_t)v[1];
    side[n++] = s;
  }
  PASS(sort_by_key(n, key, side, dim == 3 ? by_third_node : NULL, o));
  for (int i = 1; i < n; ++i) {
    if (key[i] != key[i - 1]) continue;
    side_nodes(o, side[i - 1], v);
    side_nodes(o, side[i], w);
    if (memcmp(v, w, (size_t)dim * sizeof *v) != 0) continue;
    o->across[side[i - 1]] = side[i];
    o->across[side[i]] = side[i - 1];
  }
  return OK;
}

/* The side of an element that is this face. */
static int side_of(const opening *o, int elem, int face_id) {
  const mesh *m = o->m;
  const int first = (m->dim + 1) * o->place[elem];
  int face[3], v[3], s = first - 1;
  memcpy(face, face_nodes(m, face_id), (size_t)m->dim * sizeof *face);
  sort_few(m->dim, face);
  do side_nodes(o, ++s, v);
  while (s < first + m->dim &&
         memcmp(v, face, (size_t)m->dim * sizeof *v) != 0);
  return s;
}

static status cut_sides(opening *o) {
  const mesh *m = o->m;
  PASS_NEW(o->lip, 2 * o->n_face);
  for (int i = 0; i < o->n_face; ++i) {
    int f = o->face[i], *lip = o->lip + 2 * i;
    lip[0] = side_of(o, m->face_elem[f], f);
    lip[1] = side_of(o, m->face_other[f], f);
    o->across[lip[0]] = o->across[lip[1]] = -1;
  }
  return OK;
}

/* ---- fans ---------------------------------------------------------------- */

/* The corner of the element of a side at which it has the node. */
static int corner_at(const opening *o, int side, int node) {
  const int per = o->m->dim + 1, first = side - side % per;
  const int *v = elem_nodes(o->m, o->elem[side / per]);
  int k = 0;
  while (v[k] != node) ++k;
  return first + k;
}

/* Corners on both sides of a face that is not cut belong together. */
static void join_corners(const opening *o, int *fan) {
  const int n_side = (o->m->dim + 1) * o->n_elem;
  int v[3];
  for (int s = 0; s < n_side; ++s) {
    int t = o->across[s];
    if (t < s) continue;
    side_nodes(o, s, v);
    for (int k = 0; k < o->m->dim; ++k)
      if (o->on_crack[v[k]])
        forest_join(fan, corner_at(o, s, v[k]), corner_at(o, t, v[k]));
  }
}

/* The root of a fan is its lowest corner: that of the first fan of a node keeps
 * it. */
static status find_fans(opening *o) {
  const mesh *m = o->m;
  const int per = m->dim + 1, n_corner = per * o->n_elem;
  OWNED int *fan = NULL;
  OWNED char *kept = NULL;
  int n = 0;
  PASS_NEW(fan, n_corner);
  PASS_NEW(kept, m->n_node);
  PASS_NEW(o->node, n_corner);
  for (int c = 0; c < n_corner; ++c) fan[c] = c;
  join_corners(o, fan);
  for (int c = 0; c < n_corner; ++c) n += forest_root(fan, c) == c;
  PASS_NEW(o->copy_of, n);
  for (int c = 0; c < n_corner; ++c) {
    int v = elem_nodes(m, o->elem[c / per])[c % per];
    if (!o->on_crack[v]) {
      o->node[c] = -1;
    } else if (fan[c] != c) {
      o->node[c] = o->node[forest_root(fan, c)];
    } else if (!kept[v]) {
      kept[v] = 1;
      o->node[c] = v;
    } else {
      o->node[c] = m->n_node + o->n_copy;
      o->copy_of[o->n_copy++] = v;
    }
  }
  return OK;
}

/* 1: a node of the face has a copy on one side of it. */
static int is_open(const opening *o, int i) {
  const mesh *m = o->m;
  const int *v = face_nodes(m, o->face[i]), *lip = o->lip + 2 * i;
  for (int k = 0; k < m->dim; ++k)
    if (o->node[corner_at(o, lip[0], v[k])] !=
        o->node[corner_at(o, lip[1], v[k])])
      return 1;
  return 0;
}

/* Faces from "from" to "to" that are open stay in the list, behind the first
 * "n" faces; returns their number with these. */
static int keep_open(opening *o, int crack, int from, int to, int n) {
  const mesh_cut *cut = &o->cut[crack];
  faults closed = {0};
  int before = n;
  for (int i = from; i < to; ++i) {
    int lip[2] = {o->lip[2 * i], o->lip[2 * i + 1]};
    if (is_open(o, i)) {
      o->face[n] = o->face[i];
      memcpy(o->lip + 2 * n++, lip, sizeof lip);
      continue;
    }
    o->across[lip[0]] = lip[1];
    o->across[lip[1]] = lip[0];
    opening_note(o, o->face[i], &closed);
  }
  if (n == before)
    message_add(o->log, P3052, cut->at,
                "crack along %s: all nodes are at its front, none opens",
                cut->group->name);
  else if (closed.n > 0)
    message_add(o->log, P3054, cut->at,
                "crack along %s: %d face(s) have all nodes on the front, of "
                "element %s",
                cut->group->name, closed.n, closed.text);
  return n;
}

/* The fans stay the same without the faces that do not open. */
static void leave_closed(opening *o) {
  int from = 0, n = 0;
  for (int k = 0; k < o->n; ++k) {
    int to = o->first[k + 1];
    n = keep_open(o, k, from, to, n);
    from = to;
    o->first[k + 1] = n;
  }
  o->n_face = n;
}

status mesh_open(mesh *m, int n, const mesh_cut *cut, message_log *log,
                 mesh_crack *crack) {
  status st = OK;
  opening o = {.m = m, .n = n, .cut = cut, .log = log, .crack = crack};
  if (n == 0) return OK;
  o.errors = message_count(log, ERROR);
  for (int k = 0; k < n; ++k) crack[k] = (mesh_crack){0};
  TRY(take_faces(&o));
  TRY(gather_elements(&o));
  TRY(pair_sides(&o));
  TRY(cut_sides(&o));
  TRY(find_fans(&o));
  leave_closed(&o);
  TRY(lips_orient(&o));
  TRY(opening_check(&o));
  TRY(lips_store(&o));
  TRY(groups_open(&o));
  TRY(fronts_find(&o));
done:
  release(&o);
  return st;
}
