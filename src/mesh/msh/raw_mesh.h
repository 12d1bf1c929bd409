/*
 * The mesh as a file or gmsh gives it, before its contents are checked: numbers
 * of the file, elements by entity and type, three coordinates.
 */
#pragma once

#include "base/status.h"

#include <stddef.h>
#include <stdint.h>

typedef struct raw_block { /* elements of one type on one entity */
  int dim;                 /* of the entity */
  int type;                /* number of gmsh: 1 line, 2 triangle, 4 tet, ... */
  char *type_name;         /* "Triangle 3", "Quadrilateral 4", ... */
  int n_physical;          /* physical groups the entity belongs to, > 0 */
  int *physical;           /* [n_physical] their tags */
  size_t n;                /* elements */
  size_t n_per;            /* nodes of each */
  size_t *no;              /* [n] element numbers */
  size_t *node;            /* [n_per*n] node numbers */
} raw_block;

typedef struct raw_group { /* physical group */
  int dim, tag;
  char *name; /* "" if it has none */
} raw_group;

typedef struct raw_mesh {
  size_t n_node;
  size_t *node_no; /* [n_node] */
  double *xyz;     /* [3*n_node] */
  int n_block, n_group, n_warning;
  raw_block *block;
  raw_group *group;
  char **warning;  /* [n_warning] texts of gmsh */
  int n_entity[4]; /* geometric entities by dimension */
  size_t n_loose;  /* elements of the highest dimension in no group */
  int meets;       /* as in mesh_source */
  int made;        /* 1: by gmsh from a .geo: centres of arcs are nodes of it */
} raw_mesh;

/* Read a .msh: data only, every number checked. ERR_MESH with file and line in
 * the record if it is damaged; ERR_FILE, ERR_MEMORY. */
status msh_read(const char *file, raw_mesh **out);

/* Its nodes alone, none where it has no $Nodes; ERR_DECK if it is damaged. */
status msh_read_nodes(const char *file, raw_mesh **out);

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
