/* Physical groups: names and dimension before, contents after the rest. */
#include "mesh/build.h"
#include "mesh/sort.h"

#include "base/memory.h"
#include "base/text.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char *const kind[] = {"point", "curve", "surface", "volume"};

/* The group's name as it may be shown, or its tag as text. */
static status copy_name(const raw_group *g, const char **name) {
  char tag[16], *shown = NULL;
  snprintf(tag, sizeof tag, "%d", g->tag);
  const char *text = g->name[0] != '\0' ? g->name : tag;
  size_t size = 4 * strlen(text) + 1;
  PASS_NEW(shown, size);
  text_shown(shown, size, text);
  *name = shown;
  return OK;
}

static int block_in_group(const raw_block *p, int dim, int tag) {
  if (p->dim != dim) return 0;
  for (int i = 0; i < p->n_physical; ++i)
    if (p->physical[i] == tag) return 1;
  return 0;
}

static void check_empty(const builder *b, const mesh_group *g) {
  for (int i = 0; i < b->raw->n_block; ++i)
    if (block_in_group(&b->raw->block[i], g->dim, g->tag)) return;
  message_add(b->log, P3013, b->at,
              "physical %s \"%s\" (number %d) holds no element", kind[g->dim],
              g->name, g->tag);
}

static int by_name(const void *p, const void *q) {
  const mesh_group *a = *(const mesh_group *const *)p,
                   *b = *(const mesh_group *const *)q;
  int order = strcmp(a->name, b->name);
  if (order != 0) return order;
  if (a->dim != b->dim) return a->dim - b->dim;
  return (a->tag > b->tag) - (a->tag < b->tag);
}

static status check_names(const builder *b) {
  const mesh *m = b->m;
  OWNED const mesh_group **sorted = NULL;
  PASS_NEW(sorted, m->n_group);
  for (int i = 0; i < m->n_group; ++i) sorted[i] = &m->group[i];
  qsort(sorted, (size_t)m->n_group, sizeof *sorted, by_name);
  for (int i = 1; i < m->n_group; ++i) {
    const mesh_group *a = sorted[i - 1], *g = sorted[i];
    if (strcmp(a->name, g->name) == 0)
      message_add(b->log, P3012, b->at,
                  "\"%s\" names the physical %s %d and the physical %s %d",
                  a->name, kind[a->dim], a->tag, kind[g->dim], g->tag);
  }
  return OK;
}

static void tell_no_group(const builder *b) {
  const int *n = b->raw->n_entity;
  if (b->raw->n_group == 0)
    message_add(b->log, P3010, b->at,
                "the mesh has %d point(s), %d curve(s), %d surface(s), %d "
                "volume(s), but no physical group",
                n[0], n[1], n[2], n[3]);
  else
    message_add(b->log, P3011, b->at,
                "the %d physical group(s) name points or curves only; the mesh "
                "has %d surface(s) and %d volume(s)",
                b->raw->n_group, n[2], n[3]);
}

status groups_check(builder *b) {
  mesh *m = b->m;
  PASS_NEW(m->group, b->raw->n_group);
  for (int i = 0; i < b->raw->n_group; ++i) {
    const raw_group *g = &b->raw->group[i];
    if (g->dim < 0 || g->dim > 3)
      RAISE(ERR_MESH, "physical group of dimension %d", g->dim);
    m->group[i] = (mesh_group){.dim = g->dim, .tag = g->tag};
    m->n_group = i + 1;
    PASS(copy_name(g, &m->group[i].name));
    if (g->dim > m->dim) m->dim = g->dim;
  }
  if (m->dim < 2) {
    tell_no_group(b);
    PASS(build_check(b));
  }
  PASS(check_names(b));
  for (int i = 0; i < m->n_group; ++i) check_empty(b, &m->group[i]);
  return build_check(b);
}

typedef struct filling { /* marks are all 0 between two groups */
  char *node_mark;       /* [n_node] */
  char *item_mark;       /* [max of n_elem, n_face] */
  int *node, *item;      /* lists of the current group */
  int n_node, n_item;
} filling;

static void add(char *mark, int *list, int *n, int id) {
  if (mark[id]) return;
  mark[id] = 1;
  list[(*n)++] = id;
}

/* Elements or faces of a block, and their nodes. */
static void add_items(const builder *b, int block, filling *f) {
  const mesh *m = b->m;
  const raw_block *p = &b->raw->block[block];
  int top = p->dim == m->dim;
  size_t n = p->n_per;
  for (size_t i = 0; i < p->n; ++i) {
    size_t raw_item = (size_t)b->first[block] + i;
    int id = top ? b->elem_of_top[raw_item] : b->face_of_low[raw_item];
    const int *v = (top ? m->elem : m->face) + n * (size_t)id;
    if (f->item_mark[id]) continue;
    add(f->item_mark, f->item, &f->n_item, id);
    for (size_t k = 0; k < n; ++k) add(f->node_mark, f->node, &f->n_node, v[k]);
  }
}

/* Nodes of a block of points or, in 3-D, of curves. */
static void add_nodes(const builder *b, const raw_block *p, filling *f,
                      faults *outside) {
  for (size_t i = 0; i < p->n_per * p->n; ++i) {
    int r = nodes_find(b, p->node[i]);
    int id = r < 0 ? -1 : b->node_id[r];
    if (id >= 0)
      add(f->node_mark, f->node, &f->n_node, id);
    else
      fault_add(outside, "%zu", p->node[i]);
  }
}

static status take_list(int n, const int *list, char *mark, int **out) {
  for (int i = 0; i < n; ++i) mark[list[i]] = 0;
  PASS_NEW(*out, n);
  memcpy(*out, list, (size_t)n * sizeof **out);
  return sort_ids(n, *out);
}

static status fill_group(builder *b, mesh_group *g, filling *f) {
  faults outside = {0};
  f->n_node = f->n_item = 0;
  for (int i = 0; i < b->raw->n_block; ++i) {
    const raw_block *p = &b->raw->block[i];
    if (!block_in_group(p, g->dim, g->tag)) continue;
    if (g->dim >= b->m->dim - 1)
      add_items(b, i, f);
    else
      add_nodes(b, p, f, &outside);
  }
  g->n_node = f->n_node;
  g->n_item = f->n_item;
  PASS(take_list(f->n_node, f->node, f->node_mark, &g->node_id));
  if (g->dim >= b->m->dim - 1)
    PASS(take_list(f->n_item, f->item, f->item_mark, &g->item_id));
  if (outside.n > 0)
    message_add(b->log, P3033, b->at,
                "physical %s \"%s\": %d node(s) in no element of the mesh: %s",
                kind[g->dim], g->name, outside.n, outside.text);
  return OK;
}

status groups_fill(builder *b) {
  status st = OK;
  mesh *m = b->m;
  filling f = {0};
  int n_item = m->n_elem > m->n_face ? m->n_elem : m->n_face;
  NEW_ALL(OF(f.node_mark, m->n_node), OF(f.item_mark, n_item),
          OF(f.node, m->n_node), OF(f.item, n_item));
  for (int i = 0; i < m->n_group; ++i) TRY(fill_group(b, &m->group[i], &f));
  TRY(build_check(b));
done:
  RELEASE(f.node_mark, f.item_mark, f.node, f.item);
  return st;
}
