/*
 * Fill-reducing orders of a node graph. Private to src/fem.
 */
#pragma once

#include "fem/stiffness.h"

#include <cholmod.h>
#include <stddef.h>

/* Symmetric graph, both directions stored, no loops. */
typedef struct graph {
  int n;         /* nodes */
  size_t *start; /* [n+1] */
  int *next;     /* [start[n]] */
} graph;

/* The graph of the nodes with unknowns; g is new. */
status graph_of_unknowns(const stiffness *k, graph *g);
void graph_release(graph *g);

typedef enum { ORDER_CUTS, ORDER_METIS, ORDER_AMD } order_method;
/* Order node[0..n) in place by one method. */
status order_by(order_method method, const graph *g, int dim, const double *x,
                int n, int *node, cholmod_common *cm);
/* Operations and entries of a Cholesky factor in an order, one unknown per
 * node: of all columns, of those that marked nodes reach, of their own. */
typedef struct order_cost {
  double flops, entries;
  double reached_flops, reached_entries, marked_entries;
} order_cost;
/* mark[g->n] 1: marked. ERR_MEMORY. */
status order_cost_of(const graph *g, int n, const int *node,
                     const unsigned char *mark, cholmod_common *cm,
                     order_cost *cost);
/*
 * Order node[0..n) in place (the interior of one body); neighbours outside the
 * list are ignored. x[dim*g->n] coordinates. "name" says which order was taken.
 * Nodes that follow later (contact) are the caller's.
 */
status order_nodes(const graph *g, int dim, const double *x, int n, int *node,
                   cholmod_common *cm, const char **name);
