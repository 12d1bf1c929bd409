/*
 * $Nodes and $Elements of version 2.2: one line, or one record, each. The
 * first tag of an element is its group, the second its entity; an element of
 * several groups is listed once for each.
 */
#include "mesh/msh/msh.h"

#include "base/memory.h"

/* A number above zero; 4 bytes in binary files. */
static status read_no(scan *s, size_t *no) {
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
    PASS(read_no(s, &m->raw->node_no[i]));
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

typedef struct element_head { /* of elements that follow each other          */
  int type, n_tag;
  int entity, physical; /* of the element before; its block                  */
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
  if (msh_type(h->type) == NULL)
    return scan_fail(s,
                     "elements of type %d are not known; linear triangles "
                     "and tetrahedra are read",
                     h->type);
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
    PASS(read_no(s, node != NULL ? &node[i] : &unused));
  return OK;
}

static const element_head none = {0, 0, -1, -1, -1};

static status read_lines(msh *m, size_t n) {
  scan *s = &m->s;
  element_head h = none;
  for (size_t i = 0, no; i < n; ++i) {
    int type = h.type;
    PASS(read_no(s, &no));
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
      PASS(read_no(s, &no));
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
