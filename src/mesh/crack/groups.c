/*
 * Groups of an opened mesh: their nodes, the groups of the lips, and the faces
 * of the crack in its own group; the errors that are found in faces.
 */
#include "mesh/crack/opening.h"
#include "mesh/sort.h"

#include "base/memory.h"

#include <stdio.h>
#include <string.h>

status opening_check(const opening *o) {
  int n = message_count(o->log, ERROR) - o->errors;
  if (n > 0) RAISE(ERR_MESH, "the cracks are not valid: %d error(s)", n);
  return OK;
}

void opening_note(const opening *o, int face_id, faults *bad) {
  const mesh *m = o->m;
  const int *v = face_nodes(m, face_id);
  double x[3] = {0.0, 0.0, 0.0};
  for (int i = 0; i < m->dim; ++i)
    for (int k = 0; k < m->dim; ++k) x[k] += node_x(m, v[i])[k] / m->dim;
  fault_at(bad, m->dim, m->elem_no[m->face_elem[face_id]], x);
}

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
    const int *v = g->dim == m->dim ? elem_nodes(m, g->item_id[i])
                                    : face_nodes(m, g->item_id[i]);
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
  static const char *const kind[] = {"points", "curves"};
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
  memcpy(node, f->list, (size_t)f->n * sizeof *node);
  memory_free(g->node_id);
  g->node_id = node;
  g->n_node = f->n;
  PASS(sort_ids(f->n, node));
  if (copied > 0)
    message_add(o->log, P3055, o->cut[0].at,
                "group %s of %s has %d node(s) on a crack, and now all of "
                "their copies",
                g->name, kind[g->dim], copied);
  return OK;
}

/* ---- lips ---------------------------------------------------------------- */

/* Group "NAME+" or "NAME-" behind the others; its nodes are filled later. */
static status add_lip(opening *o, int crack, const char *sign,
                      const int *face) {
  mesh *m = o->m;
  const char *base = m->group[o->group_id[crack]].name;
  const mesh_crack *c = &o->crack[crack];
  OWNED char *name = NULL;
  size_t length = strlen(base) + strlen(sign) + 1;
  int tag = 0;
  PASS_NEW(name, length);
  snprintf(name, length, "%s%s", base, sign);
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
  memcpy(g->item_id, face, (size_t)c->n * sizeof *face);
  return sort_ids(c->n, g->item_id);
}

/* The crack's own group: both lips. */
static status take_lips(opening *o, int crack) {
  mesh_group *g = &o->m->group[o->group_id[crack]];
  const mesh_crack *c = &o->crack[crack];
  int *item;
  PASS_NEW(item, 2 * c->n);
  memcpy(item, c->plus, (size_t)c->n * sizeof *item);
  memcpy(item + c->n, c->minus, (size_t)c->n * sizeof *item);
  memory_free(g->item_id);
  g->item_id = item;
  g->n_item = 2 * c->n;
  return sort_ids(g->n_item, item);
}

status groups_open(opening *o) {
  mesh *m = o->m;
  OWNED char *mark = NULL;
  OWNED int *list = NULL;
  size_t old = (size_t)m->n_group;
  PASS_NEW(mark, m->n_node);
  PASS_NEW(list, m->n_node);
  mesh_group *group =
      memory_resize(m->group, old, old + 2 * (size_t)o->n, sizeof *group);
  if (group == NULL) RAISE(ERR_MEMORY, "memory exhausted: groups of the lips");
  m->group = group;
  for (int k = 0; k < o->n; ++k) {
    PASS(take_lips(o, k));
    PASS(add_lip(o, k, "+", o->crack[k].plus));
    PASS(add_lip(o, k, "-", o->crack[k].minus));
  }
  filling f = {mark, list, 0};
  for (int i = 0; i < m->n_group; ++i) PASS(fill_nodes(o, &m->group[i], &f));
  return opening_check(o);
}
