/*
 * The raw mesh under construction: its tables, and what the sections add.
 */
#include "mesh/msh/msh.h"

#include "base/memory.h"
#include "mesh/msh/raw_mesh.h"

#include <string.h>

/* ---- open addressing, at most half of the slots in use ------------------- */

uint64_t table_key(int upper, long lower) {
  return (uint64_t)(uint32_t)upper << 32 | (uint32_t)lower;
}

/* The slot of the key, or the empty one where it belongs. */
static size_t slot_of(const key_table *t, uint64_t key) {
  uint64_t spread = key * 0x9E3779B97F4A7C15u;
  size_t s = (size_t)(spread ^ spread >> 32) & (t->n_slot - 1);
  while (t->id[s] != 0 && t->key[s] != key) s = (s + 1) & (t->n_slot - 1);
  return s;
}

int table_find(const key_table *t, uint64_t key) {
  return t->n_slot == 0 ? -1 : t->id[slot_of(t, key)] - 1;
}

void table_free(key_table *t) {
  RELEASE(t->key, t->id);
  *t = (key_table){0};
}

static status grow(key_table *t) {
  status st = OK;
  key_table more = {.n = t->n, .n_slot = t->n_slot == 0 ? 16 : 2 * t->n_slot};
  NEW(more.key, more.n_slot);
  NEW(more.id, more.n_slot);
  for (size_t i = 0; i < t->n_slot; ++i) {
    if (t->id[i] == 0) continue;
    size_t s = slot_of(&more, t->key[i]);
    more.key[s] = t->key[i];
    more.id[s] = t->id[i];
  }
  key_table swapped = *t;
  *t = more;
  more = swapped;
done:
  table_free(&more);
  return st;
}

status table_add(key_table *t, uint64_t key, int *id) {
  if (2 * (size_t)(t->n + 1) > t->n_slot) PASS(grow(t));
  size_t s = slot_of(t, key);
  if (t->id[s] == 0) {
    t->key[s] = key;
    t->id[s] = ++t->n;
  }
  *id = t->id[s] - 1;
  return OK;
}

/* ---- release of a raw mesh ----------------------------------------------- */

void raw_free(raw_mesh *raw) {
  if (raw == NULL) return;
  for (int i = 0; i < raw->n_block; ++i) {
    RELEASE(raw->block[i].type_name, raw->block[i].physical, raw->block[i].no,
            raw->block[i].node);
  }
  for (int i = 0; i < raw->n_group; ++i) memory_free(raw->group[i].name);
  for (int i = 0; i < raw->n_warning; ++i) memory_free(raw->warning[i]);
  RELEASE(raw->block, raw->group, raw->warning, raw->node_no, raw->xyz, raw);
}

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

const element_type *msh_type(int type) {
  int n = (int)(sizeof types / sizeof *types);
  return type > 0 && type < n ? &types[type] : NULL;
}

/* ---- what the sections add ----------------------------------------------- */

status msh_add_group(msh *m, int dim, int tag) {
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
  memcpy(b->physical, physical, (size_t)n_physical * sizeof *physical);
  b->n_physical = n_physical;
  b->type_name = memory_text(t->name);
  if (b->type_name == NULL) RAISE(ERR_MEMORY, "memory exhausted: %s", t->name);
  return OK;
}

status msh_block(msh *m, int type, int tag, int n_physical, const int *physical,
                 int *block) {
  int n = m->blocks.n;
  *block = -1;
  if (n_physical == 0) return OK;
  PASS(table_add(&m->blocks, table_key(type, tag), block));
  if (*block < n) return OK;
  return new_block(m, *block, type, tag, n_physical, physical);
}

status msh_add_element(msh *m, int block, size_t no, size_t **node) {
  raw_block *b = &m->raw->block[block];
  if (b->n >= m->fill[block].capacity) {
    size_t capacity = b->n < 4 ? 4 : 2 * b->n, per = b->n_per;
    void *more = memory_resize(b->no, b->n, capacity, sizeof *b->no);
    if (more == NULL) RAISE(ERR_MEMORY, "memory exhausted: element numbers");
    b->no = more;
    more = memory_resize(b->node, per * b->n, per * capacity, sizeof *b->node);
    if (more == NULL) RAISE(ERR_MEMORY, "memory exhausted: elements");
    b->node = more;
    m->fill[block].capacity = capacity;
  }
  b->no[b->n] = no;
  *node = b->node + b->n_per * b->n++;
  return OK;
}

status msh_new_nodes(msh *m, size_t n) {
  raw_mesh *raw = m->raw;
  raw->n_node = n;
  PASS_NEW(raw->node_no, n);
  PASS_NEW(raw->xyz, 3 * n);
  return OK;
}
