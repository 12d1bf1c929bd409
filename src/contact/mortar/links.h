/*
 * Nodes that move with others: the relative displacement of a node takes the
 * place of its own. Row q belongs to one node, component c of it is
 *   w_c = F_c . (u(node) - sum part_c u(master)),
 * F_c the row of its frame (the unit vector c where it has none). The parts of
 * a component sum to 1, or all are 0: then w_c = F_c . u(node).
 * Mortar method with dual basis: Wohlmuth, Acta Numerica 20 (2011).
 */
#ifndef PROTIS_MORTAR_LINKS_H
#define PROTIS_MORTAR_LINKS_H

#include <stddef.h>

typedef struct node_links {
  int dim, n;    /* 2 or 3; rows */
  size_t *start; /* [n+1] masters of row q: start[q] .. start[q+1] */
  int *master;   /* [start[n]] mesh nodes */
  double *part;  /* [dim*start[n]] of each component, - */
} node_links;

/* Nodes of *TIE: w = 0, but a component whose parts are 0 is that of a
 * support. */
typedef struct tie_set {
  int n;
  int *node_id;  /* [n] ascending, none a contact node */
  node_links to; /* row q: node_id[q] */
} tie_set;

void links_release(node_links *l); /* accepts all-zero */
/* What acts on tied nodes goes to their masters, but for components of
 * supports: F[dim*n_node]. No node may be tied to itself, by any way. */
void ties_share(const tie_set *t, double *F);

#endif
