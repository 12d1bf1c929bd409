/*
 * Reader of .msh files: the sections of the versions 2.2 and 4.1 become blocks
 * of elements, groups and nodes of a raw mesh. Inside src/mesh/msh only.
 */
#ifndef PROTIS_MSH_MSH_H
#define PROTIS_MSH_MSH_H

#include "mesh/msh/keys.h"
#include "mesh/msh/raw_mesh.h"
#include "mesh/msh/scan.h"

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
