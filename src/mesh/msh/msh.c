/*
 * Reader of .msh files: the sections of the versions 2.2 and 4.1 become blocks
 * of elements, groups and nodes of a raw mesh.
 *
 * $Nodes, or $ParametricNodes with their places on curves and surfaces, and
 * $Elements of version 2.2: one line, or one record, each; the first
 * tag of an element is its group, the second its entity; an element of several
 * groups is listed once for each.
 *
 * $Entities, $Nodes and $Elements of version 4.1. Entities know their groups,
 * nodes and elements come in blocks on an entity. Partitions have a list of
 * entities of their own; what parts them is in no group.
 */
#include "base/base.h"
#include "mesh/msh/raw_mesh.h"
#include "mesh/msh/scan.h"

typedef struct element_type { /* of gmsh, its number is the row */
  int dim, n_node;
  const char *name;
} element_type;
typedef struct msh_name { /* of $PhysicalNames */
  const char *text;       /* in the data of the scan */
  size_t length;
} msh_name;

typedef struct msh_entity { /* of $Entities */
  int n_physical;
  size_t first; /* in physical */
} msh_entity;

typedef struct msh_fill { /* of a block */
  size_t capacity;        /* elements allocated */
  int tag;                /* its entity, in version 2.2 its group */
} msh_fill;

typedef struct msh {
  scan s;
  raw_mesh *raw;
  /* ids by dimension and tag */
  key_table names, groups, entities, blocks;
  int names_capacity, groups_capacity, entities_capacity, blocks_capacity,
      fills_capacity;
  msh_name *name;     /* [names.n] */
  msh_entity *entity; /* [entities.n], of version 4.1 */
  int *physical;      /* [n_physical] groups of the entities */
  int n_physical, physical_capacity;
  msh_fill *fill;    /* [blocks.n] */
  size_t n_loose[4]; /* elements in no group by dimension */
  int has_nodes, has_entities, has_elements;
} msh;

/* clang-format off */
static const element_type types[] = {
  {0, 0, NULL},
  {1, 2, "Line 2"},          {2, 3, "Triangle 3"},
  {2, 4, "Quadrilateral 4"}, {3, 4, "Tetrahedron 4"},
  {3, 8, "Hexahedron 8"},    {3, 6, "Prism 6"},
  {3, 5, "Pyramid 5"},       {1, 3, "Line 3"},
  {2, 6, "Triangle 6"},      {2, 9, "Quadrilateral 9"},
  {3, 10, "Tetrahedron 10"}, {3, 27, "Hexahedron 27"},
  {3, 18, "Prism 18"},       {3, 14, "Pyramid 14"},
  {0, 1, "Point"},           {2, 8, "Quadrilateral 8"},
  {3, 20, "Hexahedron 20"},  {3, 15, "Prism 15"},
  {3, 13, "Pyramid 13"},     {2, 9, "Triangle 9"},
  {2, 10, "Triangle 10"},    {2, 12, "Triangle 12"},
  {2, 15, "Triangle 15"},    {2, 15, "Triangle 15I"},
  {2, 21, "Triangle 21"},    {1, 4, "Line 4"},
  {1, 5, "Line 5"},          {1, 6, "Line 6"},
  {3, 20, "Tetrahedron 20"}, {3, 35, "Tetrahedron 35"},
  {3, 56, "Tetrahedron 56"},
};
/* clang-format on */

/* NULL: a number that is none, or of order above 5. */
static const element_type *msh_type(int type) {
  int n = (int)(sizeof types / sizeof *types);
  return type > 0 && type < n ? &types[type] : NULL;
}

/* ---- what the sections add ----------------------------------------------- */

/* A group some entity or element belongs to. */
static status msh_add_group(msh *m, int dim, int tag) {
  int id, n = m->groups.n;
  PASS(table_add(&m->groups, table_key(dim, tag), &id));
  if (id < n) return OK;
  PASS_GROW(m->raw->group, id, m->groups_capacity);
  m->raw->group[id] = (raw_group){dim, tag, NULL};
  m->raw->n_group = id + 1;
  return OK;
}

static status new_block(msh *m, int id, int type, int tag, int n_physical,
                        const int *physical) {
  const element_type *t = msh_type(type);
  PASS_GROW(m->raw->block, id, m->blocks_capacity);
  PASS_GROW(m->fill, id, m->fills_capacity);
  m->fill[id] = (msh_fill){0, tag};
  m->raw->n_block = id + 1;
  raw_block *b = &m->raw->block[id];
  *b = (raw_block){.dim = t->dim, .type = type, .n_per = (size_t)t->n_node};
  PASS_NEW(b->physical, n_physical);
  COPY(b->physical, physical, n_physical);
  b->n_physical = n_physical;
  PASS_GET(b->type_name, memory_text(t->name));
  return OK;
}

/* The block of the elements of a type on an entity (in version 2.2: in a
 * group) with these groups; *block = -1 for no group. */
static status msh_block(msh *m, int type, int tag, int n_physical,
                        const int *physical, int *block) {
  int n = m->blocks.n;
  *block = -1;
  if (n_physical == 0) return OK;
  PASS(table_add(&m->blocks, table_key(type, tag), block));
  if (*block < n) return OK;
  return new_block(m, *block, type, tag, n_physical, physical);
}

/* One more element of the block: its nodes are to be filled in. */
static status msh_add_element(msh *m, int block, size_t no, size_t **node) {
  raw_block *b = &m->raw->block[block];
  if (b->n >= m->fill[block].capacity) {
    size_t capacity = b->n < 4 ? 4 : 2 * b->n, per = b->n_per;
    PASS_RESIZE(b->no, b->n, capacity);
    PASS_RESIZE(b->node, per * b->n, per * capacity);
    m->fill[block].capacity = capacity;
  }
  b->no[b->n] = no;
  *node = b->node + b->n_per * b->n++;
  return OK;
}

static status msh_new_nodes(msh *m, size_t n) {
  raw_mesh *raw = m->raw;
  raw->n_node = n;
  PASS_NEW_ALL(OF(raw->node_no, n), OF(raw->xyz, 3 * n));
  return OK;
}

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

/* Dimension and tag of the entity of a node, and its place on curves and
 * surfaces. */
static status pass_place(scan *s) {
  int dim, tag;
  double place;
  PASS(scan_int(s, &dim));
  PASS(scan_int(s, &tag));
  for (int i = 0; i < dim && dim < 3; ++i) PASS(scan_real(s, &place));
  return OK;
}

static status msh2_nodes(msh *m, const char *name) {
  const int has_places = strcmp(name, "ParametricNodes") == 0;
  scan *s = &m->s;
  size_t n;
  PASS(read_count(s, &n));
  PASS(scan_fits(s, n, sizeof "1 0 0 0", 28, "nodes"));
  PASS(msh_new_nodes(m, n));
  for (size_t i = 0; i < n; ++i) {
    PASS(read_record_no(s, &m->raw->node_no[i]));
    for (size_t k = 0; k < 3; ++k) PASS(scan_real(s, &m->raw->xyz[3 * i + k]));
    if (has_places) PASS(pass_place(s));
    PASS(scan_line(s));
  }
  return scan_end(s, name, "its nodes");
}

typedef struct element_head { /* of elements that follow each other */
  int type, n_tag;
  int entity, physical; /* of the element before; its block */
  int block;
} element_head;

/* The block of an element, mostly that of the one before. */
static status find_block(msh *m, element_head *h, int physical, int entity) {
  int dim = msh_type(h->type)->dim;
  if (entity != h->entity) {
    /* An entity that has elements counts once. */
    int id, n = m->entities.n;
    PASS(table_add(&m->entities, table_key(dim, entity), &id));
    if (id == n) ++m->raw->n_entity[dim];
  }
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
    done_so_far += follow;
  }
  return OK;
}

static status msh2_elements(msh *m) {
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
  e->first = m->n_physical;
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
  int tag, id, of = dim, n = m->entities.n;
  msh_entity e = {0};
  double box;
  PASS(scan_int(s, &tag));
  if (partitioned) {
    PASS(scan_int(s, &of)); /* dimension and tag of the whole */
    PASS(pass_ints(s, 1));
    PASS(pass_list(s));
  }
  for (int i = 0; i < (dim == 0 ? 3 : 6); ++i) PASS(scan_real(s, &box));
  PASS(of == dim ? read_groups(m, dim, &e) : pass_list(s));
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

static status msh4_entities(msh *m, int partitioned) {
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
                         "the blocks of the section lack %zu of the %s that "
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

static status msh4_nodes(msh *m) {
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

static status msh4_elements(msh *m) {
  scan *s = &m->s;
  totals t;
  PASS(read_totals(s, &t));
  PASS(scan_fits(s, t.n, sizeof "1 1", 16, "elements"));
  PASS(scan_fits(s, t.n_block, sizeof "0 1 15 0", 20, "blocks"));
  for (size_t i = 0; i < t.n_block; ++i) PASS(read_element_block(m, &t, &t.n));
  PASS(check_total(s, t.n, "elements"));
  return scan_end(s, "Elements", "its blocks");
}

/* ---- names --------------------------------------------------------------- */

/* Lines 'dimension tag "name"'. */
static status read_names(msh *m) {
  scan *s = &m->s;
  size_t n;
  int dim, tag, id;
  PASS(scan_size(s, &n));
  PASS(scan_line(s));
  PASS(scan_fits(s, n, sizeof "1 1 \"\"", 1, "names"));
  for (size_t i = 0; i < n; ++i) {
    msh_name name;
    PASS(scan_int(s, &dim));
    PASS(scan_int(s, &tag));
    PASS(scan_quoted(s, &name.text, &name.length));
    if (table_find(&m->names, table_key(dim, tag)) >= 0)
      return scan_fail(s, "the group %d of dimension %d is named twice", tag,
                       dim);
    PASS(scan_line(s));
    PASS(table_add(&m->names, table_key(dim, tag), &id));
    PASS_GROW(m->name, id, m->names_capacity);
    m->name[id] = name;
  }
  return scan_end(s, "PhysicalNames", "its names");
}

static int by_dim_and_tag(const void *p, const void *q) {
  const raw_group *a = p, *b = q;
  if (a->dim != b->dim) return a->dim - b->dim;
  return (a->tag > b->tag) - (a->tag < b->tag);
}

/* ---- blocks -------------------------------------------------------------- */

typedef struct block_order {
  int dim, tag, type, id;
} block_order;

static int by_entity(const void *p, const void *q) {
  const block_order *a = p, *b = q;
  if (a->dim != b->dim) return a->dim - b->dim;
  if (a->tag != b->tag) return a->tag < b->tag ? -1 : 1;
  return a->type - b->type;
}

/* The order in which the entities are numbered, not that of the file. */
static status finish_blocks(msh *m) {
  raw_mesh *raw = m->raw;
  OWNED_NEW(block_order, order, raw->n_block);
  OWNED_NEW(raw_block, sorted, raw->n_block);
  for (int i = 0; i < raw->n_block; ++i)
    order[i] =
        (block_order){raw->block[i].dim, m->fill[i].tag, raw->block[i].type, i};
  qsort(order, raw->n_block, sizeof *order, by_entity);
  for (int i = 0; i < raw->n_block; ++i) sorted[i] = raw->block[order[i].id];
  memory_free(raw->block);
  raw->block = sorted;
  sorted = NULL;
  int top = raw->n_group > 0 ? raw->group[raw->n_group - 1].dim : -1;
  if (top >= 2) raw->n_loose = m->n_loose[top];
  return OK;
}

/* ---- the file ------------------------------------------------------------ */

/* Each of these sections is read once. */
static status once(const msh *m, int *has, const char *name) {
  if (*has) return scan_fail(&m->s, "$%s is given twice", name);
  *has = 1;
  return OK;
}

static int has_nodes(const char *name) {
  return strcmp(name, "Nodes") == 0 || strcmp(name, "ParametricNodes") == 0;
}

static status read_section(msh *m, const char *name) {
  int is_4 = m->s.version > 4.0;
  if (strcmp(name, "PhysicalNames") == 0) {
    PASS(read_names(m));
  } else if (has_nodes(name)) {
    PASS(once(m, &m->has_nodes, name));
    PASS(is_4 ? msh4_nodes(m) : msh2_nodes(m, name));
  } else if (strcmp(name, "Elements") == 0) {
    PASS(once(m, &m->has_elements, name));
    PASS(is_4 ? msh4_elements(m) : msh2_elements(m));
  } else if (is_4 && strcmp(name, "Entities") == 0) {
    PASS(once(m, &m->has_entities, name));
    PASS(msh4_entities(m, 0));
  } else if (is_4 && strcmp(name, "PartitionedEntities") == 0) {
    PASS(msh4_entities(m, 1));
  } else {
    PASS(scan_skip(&m->s, name));
  }
  return OK;
}

static status read_sections(msh *m) {
  char name[SCAN_NAME];
  for (;;) {
    PASS(scan_section(&m->s, name));
    if (name[0] == '\0') break;
    if (m->s.version == 0.0 && strcmp(name, "Comments") != 0)
      return scan_fail(&m->s, "$MeshFormat is to stand before $%s", name);
    PASS(read_section(m, name));
  }
  if (!m->has_nodes || !m->has_elements)
    return scan_fail(&m->s, "the file ends without $%s: it is cut short",
                     m->has_nodes ? "Elements" : "Nodes");
  if (m->s.version > 4.0 && !m->has_entities)
    return scan_fail(&m->s,
                     "the file has no $Entities, which says what "
                     "belongs to the groups: write version 2.2");
  return OK;
}

static void release(msh *m) {
  scan_close(&m->s);
  table_free(&m->names);
  table_free(&m->groups);
  table_free(&m->entities);
  table_free(&m->blocks);
  RELEASE(m->name, m->entity, m->physical, m->fill);
}

status msh_read_nodes(const char *file, raw_mesh **out) {
  ENDS_BY(release) msh m = {0};
  char name[SCAN_NAME];
  *out = NULL;
  PASS(scan_open(&m.s, file, ERR_DECK));
  PASS_NEW(*out, 1);
  m.raw = *out;
  OWNS(m.raw);
  for (;;) {
    PASS(scan_section(&m.s, name));
    if (name[0] == '\0') return OK;
    if (has_nodes(name))
      PASS(read_section(&m, name));
    else
      PASS(scan_skip(&m.s, name));
  }
}

status msh_read(const char *file, raw_mesh **out) {
  ENDS_BY(release) msh m = {0};
  *out = NULL;
  PASS(scan_open(&m.s, file, ERR_MESH));
  PASS_NEW(*out, 1);
  m.raw = *out;
  OWNS(m.raw);
  PASS(read_sections(&m));
  raw_mesh *raw = m.raw;
  if (raw->n_group > 0)
    qsort(raw->group, raw->n_group, sizeof *raw->group, by_dim_and_tag);
  for (EACH(raw_group, g, raw->group, raw->n_group)) {
    int id = table_find(&m.names, table_key(g->dim, g->tag));
    size_t n = id >= 0 ? m.name[id].length : 0;
    PASS_NEW(g->name, n + 1);
    if (n > 0) memcpy(g->name, m.name[id].text, n);
  }
  return finish_blocks(&m);
}
