/*
 * Contact nodes within reach: those whose gap a step may close. The others are
 * left out of the contact problem, as free nodes of the interior without force,
 * as long as none of them comes beyond its gap: then more are taken.
 */
#ifndef PROTIS_CONTACT_REACH_H
#define PROTIS_CONTACT_REACH_H

#include "contact/contact.h"

typedef struct contact_reach {
  double way;    /* gaps up to it may close, m */
  int passes;    /* times that it was too short */
  int n_in, *in; /* [n_in] nodes within reach, ascending; NULL: all, n_in 0 */
} contact_reach;

void reach_free(contact_reach *x); /* all nodes again */
/* Nodes of the contact problem, of n. */
int reach_count(const contact_reach *x, int n);
/* Choose from gap[n], m: the nearest node if none is within x->way; all where
 * that are most. ERR_MEMORY. */
status reach_choose(contact_reach *x, int n, const double *gap);
/* 1: a node that was left out is beyond its gap; u_n[stride*n], m. */
int reach_misses(const contact_reach *x, int n, const double *gap,
                 const double *u_n, int stride);
/* Those and others within a longer way, beside those before; all after a few
 * times, or if asked for. ERR_MEMORY. */
status reach_extend(contact_reach *x, int n, const double *gap,
                    const double *u_n, int stride, int all);
/* Room for what a problem says of its nodes. */
typedef struct reach_part {
  double *gap, *ut0, *g0; /* [n], [n*(dim-1)], [n] */
  unsigned char *held;    /* [n*dim] */
  sparse_rows B;          /* [n*n] one entry a row at most */
} reach_part;
/* For n nodes of dim unknowns; frictionless with dim 1. ERR_MEMORY. */
status reach_part_new(int n, int dim, reach_part *out);
void reach_part_free(reach_part *p); /* accepts all-zero */
/* What *cp says of all nodes into room, and *cp to point to it, for those
 * within reach alone; limits are of local friction: B has its diagonal only. */
void reach_cut(const contact_reach *x, reach_part *room, contact_problem *cp);
/* Values a[n_in] of the nodes within reach to a[n], in place; others zero. */
void reach_spread(const contact_reach *x, int n, double *a);
/* 1: the same nodes. */
int reach_is_same(const contact_reach *a, const contact_reach *b);

#endif
