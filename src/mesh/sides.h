/* Sides of elements at the same face. Inside src/mesh only. */
#pragma once

#include "mesh/mesh.h"
#include "mesh/sort.h"

typedef struct side_list {
  int n;           /* sides */
  int *start;      /* [n_node+2] */
  sort_item *side; /* [n] id of mesh_side_nodes; last bit of the key: turn */
} side_list;

/* The sides [n] at a face that several elements have. */
typedef void sides_met(void *ctx, int n, const sort_item *side);
/* *s (sides_free): those without an element behind; met, or NULL, is called for
 * each of the other faces. ERR_MEMORY. */
status sides_outside(const mesh *m, sides_met *met, void *ctx, side_list *s);
void sides_free(side_list *s);
