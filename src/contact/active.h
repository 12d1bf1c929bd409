/*
 * Active contact nodes: those whose gap may close in a step. The others are
 * left out of the contact problem, as free interior nodes without force, while
 * none of them penetrates; otherwise more are taken.
 */
#pragma once

#include "contact/contact.h"

typedef struct active_nodes {
  double distance; /* gaps up to it may close, m */
  int passes;      /* times that it was too short */
  int n_in, *in;   /* [n_in] active nodes, ascending; NULL: all, n_in 0 */
} active_nodes;

void active_free(active_nodes *x); /* all nodes again */
/* Nodes of the contact problem, of n. */
int active_count(const active_nodes *x, int n);
/* Choose from gap[n], m: the nearest node if none is within x->distance; all
 * where that are most. ERR_MEMORY. */
status active_choose(active_nodes *x, int n, const double *gap);
/* 1: a node that was left out is beyond its gap; u_n[stride*n], m. */
int active_too_few(const active_nodes *x, int n, const double *gap,
                   const double *u_n, int stride);
/* These and all nodes within a longer distance; all nodes after a few times, or
 * if "all". ERR_MEMORY. */
status active_extend(active_nodes *x, int n, const double *gap,
                     const double *u_n, int stride, int all);
/* Arrays for the nodal data of a problem. */
typedef struct active_part {
  double *gap, *ut0, *g0; /* [n], [n*(dim-1)], [n] */
  unsigned char *held;    /* [n*dim] */
  sparse_rows B;          /* [n*n] one entry a row at most */
} active_part;
/* For n nodes of dim unknowns; frictionless with dim 1. ERR_MEMORY. */
status active_part_new(int n, int dim, active_part *out);
void active_part_free(active_part *p); /* accepts all-zero */
/* Nodal data of *cp for the active nodes into part, and *cp to point to it; the
 * limits are those of local friction: B has its diagonal only. */
void active_cut(const active_nodes *x, active_part *part, contact_problem *cp);
/* Values a[n_in] of the active nodes to a[n], in place; others zero. */
void active_spread(const active_nodes *x, int n, double *a);
/* 1: the same nodes. */
int active_is_same(const active_nodes *a, const active_nodes *b);
