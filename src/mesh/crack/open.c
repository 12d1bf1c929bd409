/*
 * Opening of a mesh: which faces are cut, what is on their sides, the fans of
 * elements round each node; the lips, their groups and the front.
 *
 * "Near" elements have a node of a crack. Their sides and corners are numbered
 * per * place + k with per = dim + 1, place the one in "elem" and k the side or
 * corner of the element.
 */
#include "base/base.h"
#include "mesh/build.h"
#include "mesh/crack/crack.h"
#include "mesh/sort.h"

typedef struct opening {
  mesh *m;             /* borrowed */
  int n;               /* cracks */
  const mesh_cut *cut; /* [n] borrowed, its groups until they are changed */
  message_log *log;    /* borrowed */
  int errors;          /* of the log before */
  mesh_crack *crack;   /* [n] borrowed */
  int *group_id;       /* [n] */
  int n_face;
  int *first;        /* [n+1] faces of each crack */
  int *face;         /* [n_face] face ids */
  int *lip;          /* [2*n_face] sides in face_elem and face_other */
  signed char *sign; /* [n_face] 1: face_elem is below, -1: above */
  char *on_crack;    /* [n_node] 1: node of a crack */
  int n_elem;        /* near elements */
  int *elem;         /* [n_elem] ascending */
  int *place;        /* [n_elem of the mesh] in elem; -1 */
  int *across;       /* [per*n_elem] side behind a side; -1: end or crack */
  int *node;         /* [per*n_elem] of a corner, opened; -1: no crack */
  int n_copy;
  int *copy_of; /* [n_copy] */
} opening;

static void release(opening *o) {
  RELEASE(o->group_id, o->first, o->face, o->lip, o->sign, o->on_crack, o->elem,
          o->place, o->across, o->node, o->copy_of);
}

static status opening_check(const opening *o) {
  int n = message_count(o->log, ERROR) - o->errors;
  if (n > 0) RAISE(ERR_MESH, "the cracks are not valid: %d error(s)", n);
  return OK;
}

/* Add element and centre of a face to a message. */
static void opening_note(const opening *o, int face_id, faults *bad) {
  const mesh *m = o->m;
  double x[3];
  fault_centre(m, m->dim, mesh_face_nodes(m, face_id), x);
  fault_at(bad, m->dim, m->elem_no[m->face_elem[face_id]], x);
}

/* 1: one of n nodes is on a crack. */
static int near_crack(const opening *o, int n, const int *v) {
  int near = 0;
  for (int k = 0; k < n; ++k) near |= o->on_crack[v[k]];
  return near;
}

/* owner[n_face] of the mesh: the crack of a face, counted from 1. */
static void take_group(opening *o, int crack, int *owner) {
  const mesh_group *g = o->cut[crack].group;
  const place *at = o->cut[crack].at;
  faults outer = {0}, twice = {0};
  for (int i = 0; i < g->n_item; ++i) {
    int f = g->item_id[i];
    if (o->m->face_other[f] < 0) {
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
  const mesh_group *g = o->cut[crack].group;
  int dim = o->m->dim;
  if (g->dim == dim - 1) return 1;
  message_add(o->log, P2022, o->cut[crack].at,
              "crack along %s: the group is made of %s; %s are needed in %d-D",
              g->name, mesh_words[g->dim], mesh_words[dim - 1], dim);
  return 0;
}

static status take_faces(opening *o) {
  OWNED int *owner = NULL;
  int most = 0;
  for (int k = 0; k < o->n; ++k) most += o->cut[k].group->n_item;
  PASS_NEW_ALL(OF(owner, o->m->n_face), OF(o->group_id, o->n),
               OF(o->first, o->n + 1), OF(o->face, most));
  for (int k = 0; k < o->n; ++k) {
    o->group_id[k] = (int)(o->cut[k].group - o->m->group);
    if (has_dimension(o, k)) take_group(o, k, owner);
    o->first[k + 1] = o->n_face;
  }
  return opening_check(o);
}

static status gather_elements(opening *o) {
  const mesh *m = o->m;
  PASS_NEW_ALL(OF(o->on_crack, m->n_node), OF(o->place, m->n_elem));
  for (int i = 0; i < o->n_face; ++i)
    for (int k = 0; k < m->dim; ++k)
      o->on_crack[mesh_face_nodes(m, o->face[i])[k]] = 1;
  for (int e = 0; e < m->n_elem; ++e) {
    o->place[e] =
        near_crack(o, m->dim + 1, mesh_elem_nodes(m, e)) ? o->n_elem++ : -1;
  }
  PASS_NEW(o->elem, o->n_elem);
  for (int e = 0; e < m->n_elem; ++e)
    if (o->place[e] >= 0) o->elem[o->place[e]] = e;
  return OK;
}

/* Ascending nodes of a side of a near element. */
static void side_nodes(const opening *o, int side, int *v) {
  const int per = o->m->dim + 1;
  mesh_side_nodes(o->m, per * o->elem[side / per] + side % per, v);
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
  OWNED sort_item *side = NULL;
  const int dim = o->m->dim, n_side = (dim + 1) * o->n_elem;
  int n = 0, v[3], w[3];
  PASS_NEW_ALL(OF(side, n_side), OF(o->across, n_side));
  for (int s = 0; s < n_side; ++s) {
    o->across[s] = -1;
    side_nodes(o, s, v);
    if (!near_crack(o, dim, v)) continue;
    side[n++] = (sort_item){sort_key(v[0], v[1]), s};
  }
  PASS(sort_items(n, side, dim == 3 ? by_third_node : NULL, o));
  for (int i = 1; i < n; ++i) {
    const int one = side[i - 1].id, two = side[i].id;
    if (side[i].key != side[i - 1].key) continue;
    side_nodes(o, one, v);
    side_nodes(o, two, w);
    if (memcmp(v, w, dim * sizeof *v) != 0) continue;
    o->across[one] = two;
    o->across[two] = one;
  }
  return OK;
}

/* The side of an element that is this face. */
static int side_of(const opening *o, int elem, int face_id) {
  const mesh *m = o->m;
  const int first = (m->dim + 1) * o->place[elem];
  int face[3], v[3], s = first - 1;
  COPY(face, mesh_face_nodes(m, face_id), m->dim);
  sort_few(m->dim, face);
  do side_nodes(o, ++s, v);
  while (s < first + m->dim && memcmp(v, face, m->dim * sizeof *v) != 0);
  return s;
}

static status cut_sides(opening *o) {
  PASS_NEW(o->lip, 2 * o->n_face);
  for (int i = 0; i < o->n_face; ++i) {
    int f = o->face[i], *lip = o->lip + 2 * i;
    lip[0] = side_of(o, o->m->face_elem[f], f);
    lip[1] = side_of(o, o->m->face_other[f], f);
    o->across[lip[0]] = o->across[lip[1]] = -1;
  }
  return OK;
}

/* The corner of the element of a side at which it has the node. */
static int corner_at(const opening *o, int side, int node) {
  const int per = o->m->dim + 1, first = side - side % per;
  const int *v = mesh_elem_nodes(o->m, o->elem[side / per]);
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

/* The root of a fan is its lowest corner: the first of a node keeps it. */
static status find_fans(opening *o) {
  const mesh *m = o->m;
  const int per = m->dim + 1, n_corner = per * o->n_elem;
  OWNED int *fan = NULL;
  OWNED char *kept = NULL;
  int n = 0;
  PASS_NEW_ALL(OF(fan, n_corner), OF(kept, m->n_node), OF(o->node, n_corner));
  for (int c = 0; c < n_corner; ++c) fan[c] = c;
  join_corners(o, fan);
  for (int c = 0; c < n_corner; ++c) n += forest_root(fan, c) == c;
  PASS_NEW(o->copy_of, n);
  for (int c = 0; c < n_corner; ++c) {
    int v = mesh_elem_nodes(m, o->elem[c / per])[c % per];
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
  const int *v = mesh_face_nodes(o->m, o->face[i]), *lip = o->lip + 2 * i;
  int open = 0;
  for (int k = 0; k < o->m->dim; ++k)
    open |= o->node[corner_at(o, lip[0], v[k])] !=
            o->node[corner_at(o, lip[1], v[k])];
  return open;
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

/* ---- which side is which ------------------------------------------------- */

/* A mean normal has a part along an axis if it is not below this, -. */
static const double no_part = 1e-6;

typedef struct walk { /* over one crack; edge k of face i: dim * i + k */
  opening *o;
  int first, n; /* its faces are first .. first + n */
  int *beyond;  /* [dim*n] edge of the one neighbour there, -1: none or more */
  int *list;    /* [n] faces in the order of the walk */
} walk;

/* The node where edge k starts. */
static int start_of(const walk *w, int edge) {
  const mesh *m = w->o->m;
  return mesh_face_nodes(m,
                         w->o->face[w->first + edge / m->dim])[edge % m->dim];
}

/* Neighbours across edges that two faces of the crack have in common; *branch:
 * a node of an edge of more, -1: there is none. */
static status find_neighbours(walk *w, int *branch) {
  const int dim = w->o->m->dim, n = dim * w->n;
  OWNED_NEW(sort_item, edge, n);
  for (int i = 0; i < n; ++i) {
    int next = dim == 2 ? i : i - i % 3 + (i % 3 + 1) % 3;
    int v[2] = {start_of(w, i), start_of(w, next)};
    sort_few(2, v);
    edge[i] = (sort_item){sort_key(v[0], v[1]), i};
    w->beyond[i] = -1;
  }
  PASS(sort_items(n, edge, NULL, NULL));
  for (int i = 0, end; i < n; i = end) {
    end = sort_run_end(n, edge, i);
    if (end > i + 2) *branch = start_of(w, edge[i].id);
    if (end != i + 2) continue;
    w->beyond[edge[i].id] = edge[i + 1].id;
    w->beyond[edge[i + 1].id] = edge[i].id;
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

/* Minus to plus points up along the last axis of the mean normal. */
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
  PASS_NEW_ALL(OF(beyond, o->m->dim * n), OF(list, n));
  walk w = {o, first, n, beyond, list};
  int branch = -1;
  PASS(find_neighbours(&w, &branch));
  if (branch >= 0)
    message_add(
        o->log, P3056, o->cut[crack].at,
        "crack along %s branches at node %zu: where it closes, pressures "
        "there have one normal for all branches: a *CRACK for each",
        o->cut[crack].group->name, o->m->node_no[branch]);
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

/* ---- the opened mesh ----------------------------------------------------- */

static status add_nodes(opening *o) {
  mesh *m = o->m;
  const size_t dim = m->dim, old = m->n_node;
  const size_t n = old + o->n_copy;
  size_t last = 0;
  for (size_t i = 0; i < old; ++i)
    if (m->node_no[i] > last) last = m->node_no[i];
  PASS_RESIZE(m->x, dim * old, dim * n);
  PASS_RESIZE(m->node_no, old, n);
  PASS_NEW(m->origin, n);
  for (size_t i = 0; i < n; ++i) m->origin[i] = (int)i;
  for (size_t i = old; i < n; ++i) {
    int from = o->copy_of[i - old];
    COPY(m->x + dim * i, mesh_node_x(m, from), dim);
    m->node_no[i] = last + 1 + (i - old);
    m->origin[i] = from;
  }
  m->n_node = (int)n;
  return OK;
}

/* The lowest node of a triangle stands first. */
static void lowest_first(int *v) {
  const int old[3] = {v[0], v[1], v[2]};
  int k = v[1] < v[0] ? 1 : 0;
  if (v[2] < v[k]) k = 2;
  for (int i = 0; i < 3; ++i) v[i] = old[(k + i) % 3];
}

/* The nodes of a face as its element now has them. */
static void follow_element(const opening *o, int face_id) {
  const mesh *m = o->m;
  const int first = (m->dim + 1) * o->place[m->face_elem[face_id]];
  int *v = mesh_face_nodes(m, face_id);
  for (int k = 0; k < m->dim; ++k) {
    if (!o->on_crack[v[k]]) continue;
    const int *w = mesh_elem_nodes(m, m->face_elem[face_id]);
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
  const int *v = mesh_face_nodes(m, f);
  int *w = mesh_face_nodes(m, g);
  COPY(w, v, m->dim);
  w[m->dim - 2] = v[m->dim - 1];
  w[m->dim - 1] = v[m->dim - 2];
  m->face_elem[g] = m->face_other[f];
  m->face_other[f] = m->face_other[g] = -1;
  *plus = o->sign[i] > 0 ? g : f;
  *minus = o->sign[i] > 0 ? f : g;
}

static status add_faces(opening *o) {
  mesh *m = o->m;
  const size_t dim = m->dim, old = m->n_face;
  const size_t n = old + o->n_face;
  PASS_RESIZE(m->face, dim * old, dim * n);
  PASS_RESIZE(m->face_elem, old, n);
  PASS_RESIZE(m->face_other, old, n);
  for (int k = 0; k < o->n; ++k) {
    mesh_crack *c = &o->crack[k];
    c->n = o->first[k + 1] - o->first[k];
    PASS_NEW_ALL(OF(c->plus, c->n), OF(c->minus, c->n));
    for (int i = 0; i < c->n; ++i)
      part_lips(o, o->first[k] + i, &c->plus[i], &c->minus[i]);
  }
  return OK;
}

static status lips_store(opening *o) {
  mesh *m = o->m;
  const int per = m->dim + 1;
  PASS(add_faces(o));
  for (int f = 0; f < m->n_face; ++f)
    if (near_crack(o, m->dim, mesh_face_nodes(m, f))) follow_element(o, f);
  PASS(add_nodes(o));
  for (int c = 0; c < per * o->n_elem; ++c)
    if (o->node[c] >= 0)
      mesh_elem_nodes(m, o->elem[c / per])[c % per] = o->node[c];
  return OK;
}

/* ---- groups ------------------------------------------------------------- */

typedef struct filling {
  char *mark; /* [n_node] all 0 between two groups */
  int *list;  /* [n_node] */
  int n;
} filling;

static void add(filling *f, int node) {
  if (f->mark[node]) return;
  f->mark[node] = 1;
  f->list[f->n++] = node;
}

/* The nodes of the group that are on a crack, of elements or faces. */
static void add_items(const opening *o, const mesh_group *g, filling *f) {
  const mesh *m = o->m;
  for (int i = 0; i < g->n_item; ++i) {
    const int *v = g->dim == m->dim ? mesh_elem_nodes(m, g->item_id[i])
                                    : mesh_face_nodes(m, g->item_id[i]);
    for (int k = 0; k <= g->dim; ++k)
      if (o->on_crack[m->origin[v[k]]]) add(f, v[k]);
  }
}

/* A group of nodes: all copies of those it has. Returns the nodes it had that
 * got any. */
static int add_copies(const opening *o, const mesh_group *g, filling *f) {
  const mesh *m = o->m;
  int n = 0;
  for (int i = 0; i < g->n_node; ++i)
    if (o->on_crack[g->node_id[i]]) add(f, g->node_id[i]);
  for (int i = m->n_node - o->n_copy; i < m->n_node; ++i) {
    char *seen = &f->mark[m->origin[i]];
    if (*seen == 0) continue;
    n += *seen == 1;
    *seen = 2;
    add(f, i);
  }
  return n;
}

static status fill_nodes(const opening *o, mesh_group *g, filling *f) {
  int *node, copied = 0;
  f->n = 0;
  if (g->dim >= o->m->dim - 1)
    add_items(o, g, f);
  else
    copied = add_copies(o, g, f);
  for (int i = 0; i < g->n_node; ++i)
    if (!o->on_crack[g->node_id[i]]) add(f, g->node_id[i]);
  for (int i = 0; i < f->n; ++i) f->mark[f->list[i]] = 0;
  PASS_NEW(node, f->n);
  COPY(node, f->list, f->n);
  memory_free(g->node_id);
  g->node_id = node;
  g->n_node = f->n;
  PASS(sort_ids(f->n, node));
  if (copied > 0)
    message_add(o->log, P3055, o->cut[0].at,
                "group %s of %s has %d node(s) on a crack, and now all of "
                "their copies",
                g->name, mesh_words[g->dim], copied);
  return OK;
}

/* Group "NAME+" or "NAME-" behind the others; its nodes are filled later. */
static status add_lip(opening *o, int crack, char sign, const int *face) {
  mesh *m = o->m;
  const char *base = m->group[o->group_id[crack]].name;
  const mesh_crack *c = &o->crack[crack];
  size_t length = strlen(base) + 2;
  int tag = 0;
  OWNED_NEW(char, name, length);
  snprintf(name, length, "%s%c", base, sign);
  if (mesh_find_group(m, name) != NULL)
    message_add(o->log, P3012, o->cut[crack].at,
                "\"%s\" names a group of the mesh and a lip of the crack along "
                "%s",
                name, base);
  for (int i = 0; i < m->n_group; ++i)
    if (m->group[i].dim == m->dim - 1 && m->group[i].tag > tag)
      tag = m->group[i].tag;
  mesh_group *g = &m->group[m->n_group];
  *g = (mesh_group){.dim = m->dim - 1, .tag = tag + 1};
  PASS_NEW(g->item_id, c->n);
  g->name = name;
  name = NULL;
  g->n_item = c->n;
  ++m->n_group;
  COPY(g->item_id, face, c->n);
  return sort_ids(c->n, g->item_id);
}

/* The crack's own group: both lips. */
static status take_lips(opening *o, int crack) {
  mesh_group *g = &o->m->group[o->group_id[crack]];
  const mesh_crack *c = &o->crack[crack];
  int *item;
  PASS_NEW(item, 2 * c->n);
  COPY(item, c->plus, c->n);
  COPY(item + c->n, c->minus, c->n);
  memory_free(g->item_id);
  g->item_id = item;
  g->n_item = 2 * c->n;
  return sort_ids(g->n_item, item);
}

static status groups_open(opening *o) {
  mesh *m = o->m;
  size_t old = m->n_group;
  OWNED_NEW(char, mark, m->n_node);
  OWNED_NEW(int, list, m->n_node);
  PASS_RESIZE(m->group, old, old + 2 * (size_t)o->n);
  for (int k = 0; k < o->n; ++k) {
    PASS(take_lips(o, k));
    PASS(add_lip(o, k, '+', o->crack[k].plus));
    PASS(add_lip(o, k, '-', o->crack[k].minus));
  }
  filling f = {mark, list, 0};
  for (int i = 0; i < m->n_group; ++i) PASS(fill_nodes(o, &m->group[i], &f));
  return opening_check(o);
}

/* ---- the front: edges (2-D: nodes) round which all elements hang together */

typedef struct front_edge {
  int face;    /* of the crack */
  int node[2]; /* along the front; 2-D: [0] */
} front_edge;

typedef struct edge_list {
  int n;
  const front_edge *edge;
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
      mesh_side_nodes(o->m, per * o->elem[first / per] + other - first, v);
      if (other != at && holds(o->m, v, edge)) break;
    }
    if (o->across[other] < 0) return other;
    at = o->across[other];
  }
}

/* An edge is at the front if the way round it ends on the other lip. Edges run
 * as the nodes of the plus lip. */
static int gather_edges(const opening *o, int crack, front_edge *list) {
  const mesh *m = o->m;
  const mesh_crack *c = &o->crack[crack];
  int n = 0;
  for (int i = 0; i < c->n; ++i) {
    int face = o->first[crack] + i;
    const int *lip = o->lip + 2 * face, *v = mesh_face_nodes(m, c->plus[i]);
    int above = o->sign[face] > 0 ? lip[1] : lip[0];
    for (int k = 0; k < m->dim; ++k) {
      const int edge[2] = {v[k], v[(k + 1) % m->dim]};
      if (last_side(o, above, edge) == lip[0] + lip[1] - above)
        list[n++] = (front_edge){i, {edge[0], edge[1]}};
    }
  }
  return n;
}

/* next[n]: the edge that goes on where one ends, -1: none, or several; last[n]
 * 1: nothing comes before. */
static status link_edges(const edge_list *list, int *next, char *is_first) {
  const int n = 2 * list->n;
  OWNED_NEW(sort_item, end, n);
  for (int i = 0; i < n; ++i)
    end[i] = (sort_item){(uint64_t)list->edge[i / 2].node[i % 2], i};
  for (int i = 0; i < list->n; ++i) {
    next[i] = -1;
    is_first[i] = 1;
  }
  PASS(sort_items(n, end, NULL, NULL));
  for (int i = 0, after; i < n; i = after) {
    const int one = end[i].id, two = i + 1 < n ? end[i + 1].id : 0;
    after = sort_run_end(n, end, i);
    if (after != i + 2 || one % 2 == two % 2) continue;
    int comes = one % 2 == 1 ? one : two, goes = one + two - comes;
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
  PASS_NEW_ALL(OF(next, list->n), OF(is_first, list->n), OF(is_done, list->n));
  PASS(link_edges(list, next, is_first));
  for (int closed = 0; closed < 2; ++closed)
    for (int i = 0; i < list->n; ++i)
      if (closed ? !is_done[i] : is_first[i]) follow(list, i, next, is_done, c);
  return OK;
}

static status find_front(const opening *o, int crack) {
  mesh_crack *c = &o->crack[crack];
  OWNED_NEW(front_edge, edge, o->m->dim * c->n);
  const edge_list list = {gather_edges(o, crack, edge), edge};
  PASS_NEW_ALL(OF(c->front_start, list.n + 1), OF(c->front_node, 2 * list.n),
               OF(c->front_face, 2 * list.n));
  if (o->m->dim == 3) return chain_edges(&list, c);
  for (int i = 0; i < list.n; ++i) {
    add_node(c, &c->n_front, list.edge[i].node[0], list.edge[i].face);
    c->front_start[c->n_front] = c->n_front;
  }
  return OK;
}

status mesh_open(mesh *m, int n, const mesh_cut *cut, message_log *log,
                 mesh_crack *crack) {
  ENDS_BY(release)
  opening o = {.m = m, .n = n, .cut = cut, .log = log, .crack = crack};
  if (n == 0) return OK;
  OWNS(m);
  o.errors = message_count(log, ERROR);
  for (int k = 0; k < n; ++k) crack[k] = (mesh_crack){0};
  PASS(take_faces(&o));
  PASS(gather_elements(&o));
  PASS(pair_sides(&o));
  PASS(cut_sides(&o));
  PASS(find_fans(&o));
  leave_closed(&o);
  PASS_NEW(o.sign, o.n_face);
  for (int k = 0; k < o.n; ++k) PASS(orient_crack(&o, k));
  PASS(opening_check(&o));
  PASS(lips_store(&o));
  PASS(groups_open(&o));
  for (int k = 0; k < o.n; ++k) PASS(find_front(&o, k));
  return OK;
}
