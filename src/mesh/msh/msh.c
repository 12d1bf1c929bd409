/*
 * The sections in turn, then their common data: blocks by dimension and tag,
 * groups with their names.
 */
#include "mesh/msh/msh.h"

#include "base/memory.h"
#include "mesh/msh/raw_mesh.h"

#include <stdlib.h>
#include <string.h>

/* ---- names --------------------------------------------------------------- */

/* Lines 'dimension tag "name"'. */
static status read_names(msh *m) {
  status st = OK;
  scan *s = &m->s;
  size_t n;
  int dim, tag, id;
  TRY(scan_size(s, &n));
  TRY(scan_line(s));
  TRY(scan_fits(s, n, sizeof "1 1 \"\"", 1, "names"));
  for (size_t i = 0; i < n; ++i) {
    msh_name name;
    TRY(scan_int(s, &dim));
    TRY(scan_int(s, &tag));
    TRY(scan_quoted(s, &name.text, &name.length));
    if (table_find(&m->names, table_key(dim, tag)) >= 0) {
      st =
          scan_fail(s, "the group %d of dimension %d is named twice", tag, dim);
      goto done;
    }
    TRY(scan_line(s));
    TRY(table_add(&m->names, table_key(dim, tag), &id));
    GROW(m->name, id, m->names_capacity);
    m->name[id] = name;
  }
  TRY(scan_end(s, "PhysicalNames", "its names"));
done:
  return st;
}

static int by_dim_and_tag(const void *p, const void *q) {
  const raw_group *a = p, *b = q;
  if (a->dim != b->dim) return a->dim - b->dim;
  return (a->tag > b->tag) - (a->tag < b->tag);
}

static status finish_groups(msh *m) {
  raw_mesh *raw = m->raw;
  if (raw->n_group > 0)
    qsort(raw->group, (size_t)raw->n_group, sizeof *raw->group, by_dim_and_tag);
  for (int i = 0; i < raw->n_group; ++i) {
    raw_group *g = &raw->group[i];
    int id = table_find(&m->names, table_key(g->dim, g->tag));
    size_t n = id >= 0 ? m->name[id].length : 0;
    PASS_NEW(g->name, n + 1);
    if (n > 0) memcpy(g->name, m->name[id].text, n);
  }
  return OK;
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
  OWNED block_order *order = NULL;
  OWNED raw_block *sorted = NULL;
  PASS_NEW(order, raw->n_block);
  PASS_NEW(sorted, raw->n_block);
  for (int i = 0; i < raw->n_block; ++i)
    order[i] =
        (block_order){raw->block[i].dim, m->fill[i].tag, raw->block[i].type, i};
  qsort(order, (size_t)raw->n_block, sizeof *order, by_entity);
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

static status read_section(msh *m, const char *name) {
  int is_4 = m->s.version > 4.0;
  if (strcmp(name, "PhysicalNames") == 0) {
    PASS(read_names(m));
  } else if (strcmp(name, "Nodes") == 0) {
    PASS(once(m, &m->has_nodes, name));
    PASS(is_4 ? msh4_nodes(m) : msh2_nodes(m));
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

status msh_read(const char *file, raw_mesh **out) {
  status st = OK;
  msh m = {0};
  *out = NULL;
  TRY(scan_open(&m.s, file, ERR_MESH));
  NEW(m.raw, 1);
  TRY(read_sections(&m));
  TRY(finish_groups(&m));
  TRY(finish_blocks(&m));
done:
  release(&m);
  if (st != OK)
    raw_free(m.raw);
  else
    *out = m.raw;
  return st;
}
