/*
 * The assembled stiffness: lower triangle of the node graph, one dense block
 * per pair of neighbours, contact nodes in their frame. Private to src/fem.
 */
#pragma once

#include "fem/fem.h"

/*
 * Change of basis u = T v for nodes that move with others:
 * the relative displacement of a contact node of a pair takes the place of its
 * own, that of a tied node is zero. For node j with masters l
 *
 *   u_j = v_j + sum_l C_jl u_l,   C_jl = sum_c b_c part_lc f_c',
 *
 * f_c row c of its frame, b_c column c of the inverse, v_j = sum_c b_c w_c.
 * Masters may have masters; here u_j is in terms of v alone. Global components.
 */
typedef struct coupled_part {
  int node;
  double block[9]; /* T_jl [dim*dim] column major, - */
} coupled_part;

typedef struct coupling {
  int dim, n_node, n;
  int *of;            /* [n_node] row of a node or -1 */
  int *node;          /* [n] of the rows, masters before those that need them */
  size_t *start;      /* [n+1] parts of row q: start[q] .. start[q+1] */
  coupled_part *part; /* [start[n]] other nodes, each once a row */
} coupling;

/* *out is new (memory_free), NULL if no node moves with others. ERR_MESH:
 * nodes that move with each other in a circle. */
status coupling_new(const domain *d, coupling **out);
/* F <- T'F, [dim*n_node]: what acts on a node acts on its masters too. */
void coupling_load(const coupling *c, double *F);
/* v <- T v, [dim*n_node]. */
void coupling_move(const coupling *c, double *v);

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
