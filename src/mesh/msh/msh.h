/*
 * Reader of .msh files: the sections of the versions 2.2 and 4.1 become blocks
 * of elements, groups and nodes of a raw mesh. Inside src/mesh/msh, but for the
 * table of ids.
 */
#ifndef PROTIS_MSH_MSH_H
#define PROTIS_MSH_MSH_H

#include "mesh/msh/raw_mesh.h"
#include "mesh/msh/scan.h"

#include <stdint.h>

/* Ids by key, a hash table that grows. */
typedef struct key_table {
  int n;         /* keys */
  size_t n_slot; /* power of two, or 0 */
  uint64_t *key; /* [n_slot] */
  int *id;       /* [n_slot] id + 1, 0: empty */
} key_table;

uint64_t table_key(int upper, long lower);        /* two 32-bit numbers */
int table_find(const key_table *t, uint64_t key); /* id or -1 */
/* The id of the key; a new key gets the id "n" of before. */
status table_add(key_table *t, uint64_t key, int *id);
void table_free(key_table *t);

typedef struct element_type { /* of gmsh, its number is the row */
  int dim, n_node;
  const char *name;
} element_type;
/* NULL: a number that is none, or of order above 5. */
const element_type *msh_type(int type);

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

/* Sections after their first line. */
status msh2_nodes(msh *m);
status msh2_elements(msh *m);
status msh4_entities(msh *m, int partitioned);
status msh4_nodes(msh *m);
status msh4_elements(msh *m);

/* A group some entity or element belongs to. */
status msh_add_group(msh *m, int dim, int tag);
/* The block of the elements of a type on an entity (in version 2.2: in a
 * group) with these groups; *block = -1 for no group. */
status msh_block(msh *m, int type, int tag, int n_physical, const int *physical,
                 int *block);
/* One more element of the block: its nodes are to be filled in. */
status msh_add_element(msh *m, int block, size_t no, size_t **node);
/* Allocate the nodes, once. */
status msh_new_nodes(msh *m, size_t n);

#endif
