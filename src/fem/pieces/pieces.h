/*
 * Bodies and their rigid pieces. Elements that share a face move as one rigid
 * piece when nothing is strained; pieces that share less (a vertex, in 3-D an
 * edge) form one body with a hinge. Private to src/fem.
 */
#pragma once

#include "mesh/mesh.h"

typedef struct pieces {
  int n_body, n_piece;
  int *piece;      /* [n_elem] piece of the element */
  int *body;       /* [n_piece] body of the piece, ascending */
  int *piece_elem; /* [n_piece] its first element */
  size_t *start;   /* [n_node+1] elements round the node */
  int *elem;       /* [start[n_node]] */
} pieces;

/* Fill p. */
status pieces_find(const mesh *m, pieces *p);
void pieces_release(pieces *p); /* accepts an all-zero object */
