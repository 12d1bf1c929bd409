/*
 * $Nodes and $Elements of version 2.2: one line, or one record, each; the first
 * tag of an element is its group, the second its entity; an element of several
 * groups is listed once for each.
 *
 * $Entities, $Nodes and $Elements of version 4.1. Entities know their groups,
 * nodes and elements come in blocks on an entity. Partitions have a list of
 * entities of their own.
 */
#include "base/memory.h"
#include "mesh/msh/msh.h"

#include <stdlib.h>

static status find_type(const scan *s, int type, const element_type **out) {
  *out = msh_type(type);
  if (*out != NULL) return OK;
  return scan_fail(s,
                   "elements of type %d are not known; linear triangles "
                   "and tetrahedra are read",
                   type);
}

/* ---- version 2.2 --------------------------------------------------------- */

/* A number above zero; 4 bytes in binary files. */
static status read_record_no(scan *s, size_t *no) {
  int four;
  if (!s->binary)
    PASS(scan_size(s, no));
  else {
    PASS(scan_int(s, &four));
    *no = four > 0 ? (size_t)four : 0;
  }
  if (*no == 0) return scan_fail(s, "a number is not above zero");
  return OK;
}

/* The count on the line after the name. */
static status read_count(scan *s, size_t *n) {
  PASS(scan_size(s, n));
  PASS(scan_line(s));
  scan_start_binary(s);
  return OK;
}

status msh2_nodes(msh *m) {
  scan *s = &m->s;
  size_t n;
  PASS(read_count(s, &n));
  PASS(scan_fits(s, n, sizeof "1 0 0 0", 28, "nodes"));
  PASS(msh_new_nodes(m, n));
  for (size_t i = 0; i < n; ++i) {
    PASS(read_record_no(s, &m->raw->node_no[i]));
    for (size_t k = 0; k < 3; ++k) PASS(scan_real(s, &m->raw->xyz[3 * i + k]));
    PASS(scan_line(s));
  }
  return scan_end(s, "Nodes", "its nodes");
}

/* An entity that has elements counts once. */
static status count_entity(msh *m, int dim, int tag) {
  int id, n = m->entities.n;
  PASS(table_add(&m->entities, table_key(dim, tag), &id));
  if (id == n) ++m->raw->n_entity[dim];
  return OK;
}

typedef struct element_head { /* of elements that follow each other */
  int type, n_tag;
  int entity, physical; /* of the element before; its block */
  int block;
} element_head;

/* The block of an element, mostly that of the one before. */
static status find_block(msh *m, element_head *h, int physical, int entity) {
  int dim = msh_type(h->type)->dim;
  if (entity != h->entity) PASS(count_entity(m, dim, entity));
  if (physical != h->physical) {
    if (physical != 0) PASS(msh_add_group(m, dim, physical));
    PASS(msh_block(m, h->type, physical, physical != 0, &physical, &h->block));
  }
  h->entity = entity;
  h->physical = physical;
  return OK;
}

static status check_head(scan *s, const element_head *h) {
  const element_type *t;
  PASS(find_type(s, h->type, &t));
  if (h->n_tag < 0) return scan_fail(s, "a number of tags below zero");
  return OK;
}

/* Tags and nodes. Groups of negative number are those of turned elements. */
static status read_element(msh *m, element_head *h, size_t no) {
  scan *s = &m->s;
  int tag, own[2] = {0, 0};
  size_t *node = NULL, unused;
  for (int i = 0; i < h->n_tag; ++i) {
    PASS(scan_int(s, &tag));
    if (i < 2) own[i] = tag;
  }
  if (own[0] < 0) own[0] = own[0] > -INT32_MAX ? -own[0] : INT32_MAX;
  PASS(find_block(m, h, own[0], own[1]));
  if (h->block >= 0)
    PASS(msh_add_element(m, h->block, no, &node));
  else
    ++m->n_loose[msh_type(h->type)->dim];
  for (int i = 0; i < msh_type(h->type)->n_node; ++i)
    PASS(read_record_no(s, node != NULL ? &node[i] : &unused));
  return OK;
}

static const element_head none = {0, 0, -1, -1, -1};

static status read_lines(msh *m, size_t n) {
  scan *s = &m->s;
  element_head h = none;
  for (size_t i = 0, no; i < n; ++i) {
    int type = h.type;
    PASS(read_record_no(s, &no));
    PASS(scan_int(s, &h.type));
    PASS(scan_int(s, &h.n_tag));
    PASS(check_head(s, &h));
    if (h.type != type) h.entity = h.physical = -1;
    PASS(read_element(m, &h, no));
    PASS(scan_line(s));
  }
  return OK;
}

/* Binary: heads of type, number and tags before elements of one kind. */
static status read_records(msh *m, size_t n) {
  scan *s = &m->s;
  for (size_t done_so_far = 0; done_so_far < n;) {
    element_head h = none;
    int follow;
    size_t no;
    PASS(scan_int(s, &h.type));
    PASS(scan_int(s, &follow));
    PASS(scan_int(s, &h.n_tag));
    PASS(check_head(s, &h));
    if (follow <= 0 || (size_t)follow > n - done_so_far)
      return scan_fail(s, "%d elements follow where %zu of %zu are left",
                       follow, n - done_so_far, n);
    for (int i = 0; i < follow; ++i) {
      PASS(read_record_no(s, &no));
      PASS(read_element(m, &h, no));
    }
    done_so_far += (size_t)follow;
  }
  return OK;
}

status msh2_elements(msh *m) {
  scan *s = &m->s;
  size_t n;
  PASS(read_count(s, &n));
  PASS(scan_fits(s, n, sizeof "1 1 0 1", 8, "elements"));
  PASS(s->binary ? read_records(m, n) : read_lines(m, n));
  return scan_end(s, "Elements", "its elements");
}

/* ---- version 4.1 --------------------------------------------------------- */

enum { ENTITY_TEXT = 16, ENTITY_BINARY = 4 + 24 + 8 };

/* Skip n numbers of 4 bytes. */
static status pass_ints(scan *s, size_t n) {
  int unused;
  PASS(scan_fits(s, n, 2, 4, "tags"));
  for (size_t i = 0; i < n; ++i) PASS(scan_int(s, &unused));
  return OK;
}

static status pass_list(scan *s) {
  size_t n;
  PASS(scan_size(s, &n));
  return pass_ints(s, n);
}

/* The groups of an entity; a negative number turns the entity. */
static status read_groups(msh *m, int dim, msh_entity *e) {
  scan *s = &m->s;
  size_t n;
  int tag;
  PASS(scan_size(s, &n));
  PASS(scan_fits(s, n, 2, 4, "groups"));
  e->first = (size_t)m->n_physical;
  for (size_t i = 0; i < n; ++i) {
    PASS(scan_int(s, &tag));
    if (tag == 0 || tag == INT32_MIN)
      return scan_fail(s, "a group has the number %d", tag);
    PASS_GROW(m->physical, m->n_physical, m->physical_capacity);
    m->physical[m->n_physical++] = abs(tag);
    PASS(msh_add_group(m, dim, abs(tag)));
  }
  e->n_physical = (int)n;
  return OK;
}

/* Tag, bounding box, groups, entities that bound it. */
static status read_entity(msh *m, int dim, int partitioned) {
  scan *s = &m->s;
  int tag, id, n = m->entities.n;
  msh_entity e = {0};
  double box;
  PASS(scan_int(s, &tag));
  if (partitioned) {
    PASS(pass_ints(s, 2)); /* dimension and tag of the whole */
    PASS(pass_list(s));
  }
  for (int i = 0; i < (dim == 0 ? 3 : 6); ++i) PASS(scan_real(s, &box));
  PASS(read_groups(m, dim, &e));
  if (dim > 0) PASS(pass_list(s));
  PASS(scan_line(s));
  PASS(table_add(&m->entities, table_key(dim, tag), &id));
  if (id < n)
    return scan_fail(s, "the entity %d of dimension %d is listed twice", tag,
                     dim);
  PASS_GROW(m->entity, id, m->entities_capacity);
  m->entity[id] = e;
  ++m->raw->n_entity[dim];
  return OK;
}

/* Number of partitions, then ghost entities: two numbers each. */
static status pass_partitions(scan *s) {
  size_t n;
  PASS(scan_size(s, &n));
  PASS(scan_line(s));
  PASS(scan_size(s, &n));
  PASS(scan_fits(s, n, 4, 8, "ghost entities"));
  PASS(scan_line(s));
  for (size_t i = 0; i < n; ++i) {
    PASS(pass_ints(s, 2));
    PASS(scan_line(s));
  }
  return OK;
}

status msh4_entities(msh *m, int partitioned) {
  scan *s = &m->s;
  size_t n[4];
  if (m->has_elements)
    return scan_fail(s, "entities are to stand before $Elements");
  m->has_entities = 1;
  scan_start_binary(s);
  if (partitioned) PASS(pass_partitions(s));
  for (int dim = 0; dim < 4; ++dim) PASS(scan_size(s, &n[dim]));
  PASS(scan_line(s));
  for (int dim = 0; dim < 4; ++dim) {
    PASS(scan_fits(s, n[dim], ENTITY_TEXT / 2, ENTITY_BINARY, "entities"));
    for (size_t i = 0; i < n[dim]; ++i) PASS(read_entity(m, dim, partitioned));
  }
  return scan_end(s, partitioned ? "PartitionedEntities" : "Entities",
                  "its entities");
}

typedef struct totals { /* first line of $Nodes and $Elements */
  size_t n_block, n, lowest, highest;
} totals;

static status read_totals(scan *s, totals *t) {
  scan_start_binary(s);
  PASS(scan_size(s, &t->n_block));
  PASS(scan_size(s, &t->n));
  PASS(scan_size(s, &t->lowest));
  PASS(scan_size(s, &t->highest));
  return scan_line(s);
}

/* A number in the limits of the first line. */
static status read_no(scan *s, const totals *t, size_t *no) {
  PASS(scan_size(s, no));
  if (*no == 0 || *no < t->lowest || *no > t->highest)
    return scan_fail(s,
                     "number %zu is outside of %zu to %zu, the limits of "
                     "the section",
                     *no, t->lowest, t->highest);
  return OK;
}

/* Three numbers of a block, and how many items it has of those left. */
static status read_head(scan *s, int head[3], size_t left, size_t *n) {
  for (int i = 0; i < 3; ++i) PASS(scan_int(s, &head[i]));
  PASS(scan_size(s, n));
  if (head[0] < 0 || head[0] > 3)
    return scan_fail(s, "a block of dimension %d", head[0]);
  if (*n > left)
    return scan_fail(s, "a block of %zu where %zu of the section are left", *n,
                     left);
  return scan_line(s);
}

/* All blocks are read: the sum of their items must be the number of the first
 * line. */
static status check_total(const scan *s, size_t left, const char *what) {
  return left == 0
             ? OK
             : scan_fail(s,
                         "the blocks of the section have %zu %s less than "
                         "its first line says",
                         left, what);
}

/* Numbers, then coordinates and, on curves and surfaces, parameters. */
static status read_node_block(msh *m, const totals *t, size_t *left) {
  scan *s = &m->s;
  int head[3]; /* dimension, tag, 1 with parameters */
  size_t n, at = m->raw->n_node - *left;
  double unused;
  PASS(read_head(s, head, *left, &n));
  for (size_t i = 0; i < n; ++i) {
    PASS(read_no(s, t, &m->raw->node_no[at + i]));
    PASS(scan_line(s));
  }
  for (size_t i = 0; i < n; ++i) {
    for (size_t k = 0; k < 3; ++k)
      PASS(scan_real(s, &m->raw->xyz[3 * (at + i) + k]));
    for (int k = 0; head[2] != 0 && k < head[0]; ++k)
      PASS(scan_real(s, &unused));
    PASS(scan_line(s));
  }
  *left -= n;
  return OK;
}

status msh4_nodes(msh *m) {
  scan *s = &m->s;
  totals t;
  PASS(read_totals(s, &t));
  PASS(scan_fits(s, t.n, sizeof "1\n0 0 0", 32, "nodes"));
  PASS(scan_fits(s, t.n_block, sizeof "0 1 0 0", 20, "blocks"));
  PASS(msh_new_nodes(m, t.n));
  for (size_t i = 0; i < t.n_block; ++i) PASS(read_node_block(m, &t, &t.n));
  PASS(check_total(s, t.n, "nodes"));
  return scan_end(s, "Nodes", "its blocks");
}

/* The groups of the entity that a block of elements lies on. */
static status find_entity(const msh *m, const int head[3], msh_entity *e) {
  int id = table_find(&m->entities, table_key(head[0], head[1]));
  *e = id >= 0 ? m->entity[id] : (msh_entity){0};
  if (id < 0 && m->has_entities)
    return scan_fail(&m->s,
                     "elements lie on the entity %d of dimension %d, "
                     "which $Entities does not list",
                     head[1], head[0]);
  const element_type *t;
  PASS(find_type(&m->s, head[2], &t));
  if (t->dim != head[0])
    return scan_fail(&m->s, "elements \"%s\" on an entity of dimension %d",
                     t->name, head[0]);
  return OK;
}

static status read_element_block(msh *m, const totals *t, size_t *left) {
  scan *s = &m->s;
  int head[3], block; /* dimension, tag, type */
  size_t n, no, unused;
  msh_entity e;
  PASS(read_head(s, head, *left, &n));
  PASS(find_entity(m, head, &e));
  *left -= n;
  if (n == 0) return OK;
  PASS(msh_block(m, head[2], head[1], e.n_physical, m->physical + e.first,
                 &block));
  if (block < 0) m->n_loose[head[0]] += n;
  for (size_t i = 0; i < n; ++i) {
    size_t *node = NULL;
    PASS(read_no(s, t, &no));
    if (block >= 0) PASS(msh_add_element(m, block, no, &node));
    for (int k = 0; k < msh_type(head[2])->n_node; ++k)
      PASS(scan_size(s, node != NULL ? &node[k] : &unused));
    PASS(scan_line(s));
  }
  return OK;
}

status msh4_elements(msh *m) {
  scan *s = &m->s;
  totals t;
  PASS(read_totals(s, &t));
  PASS(scan_fits(s, t.n, sizeof "1 1", 16, "elements"));
  PASS(scan_fits(s, t.n_block, sizeof "0 1 15 0", 20, "blocks"));
  for (size_t i = 0; i < t.n_block; ++i) PASS(read_element_block(m, &t, &t.n));
  PASS(check_total(s, t.n, "elements"));
  return scan_end(s, "Elements", "its blocks");
}
