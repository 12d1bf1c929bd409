/*
 * The assembled stiffness: lower triangle of the node graph, one dense block
 * per pair of neighbours, contact nodes in their frame. Private to src/fem.
 */
#ifndef PROTIS_FEM_STIFFNESS_H
#define PROTIS_FEM_STIFFNESS_H

#include "fem/coupling.h"

struct stiffness {
  int dim, n_node;
  int rows;             /* condensed unknowns of a contact node: 1 or dim */
  int n_row;            /* of them all */
  size_t *start;        /* [n_node+1] first block of column j */
  int *row;             /* [start[n_node]] node i >= j; the diagonal comes
                           first */
  double *block;        /* [dim*dim*start[n_node]] K_ij, column major, N/m */
  unsigned char *free;  /* [n_node] bit c: local component c is unknown */
  int *contact;         /* [n_node] id of the contact node or -1 */
  int *first_row;       /* [n_node] its first condensed unknown or -1 */
  size_t *coupling;     /* [n_coupling] blocks next to a prescribed component */
  int *coupling_column; /* [n_coupling] their columns */
  size_t n_coupling;
  coupling *moved; /* nodes that move with others, NULL: none */
};

/* Row of the condensed matrix of component c of node i, -1: of the interior. */
int contact_row(const stiffness *k, int i, int c);

#endif
