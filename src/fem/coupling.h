/*
 * Change of basis u = T v for nodes that move with others (contact/links.h):
 * the relative displacement of a contact node of a pair takes the place of its
 * own, that of a tied node is zero. For node j with masters l
 *
 *   u_j = v_j + sum_l C_jl u_l,   C_jl = sum_c b_c part_lc f_c',
 *
 * f_c row c of its frame, b_c column c of the inverse, v_j = sum_c b_c w_c.
 * Masters may have masters; here u_j is in terms of v alone. Global components.
 * Private to src/fem.
 */
#ifndef PROTIS_FEM_COUPLING_H
#define PROTIS_FEM_COUPLING_H

#include "fem/fem.h"

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

/* *out is new (coupling_free), NULL if no node moves with others. ERR_MESH:
 * nodes that move with each other in a circle. */
status coupling_new(const domain *d, coupling **out);
void coupling_free(coupling *c); /* accepts NULL */
/* F <- T'F, [dim*n_node]: what acts on a node acts on its masters too. */
void coupling_load(const coupling *c, double *F);
/* v <- T v, [dim*n_node]. */
void coupling_move(const coupling *c, double *v);

#endif
