/*
 * The targets of *GOAL in the passes of target.c: errors against what is
 * allowed, the sizes of the next mesh.
 */
#ifndef PROTIS_AIMS_H
#define PROTIS_AIMS_H

#include "output/listing/job.h"

typedef struct aims aims;

/* *out is new; NULL: there are no goals. Those with a target count, or all, for
 * a forecast. ERR_MEMORY. */
status aims_new(const model *m, int all, aims **out);
int aims_count(const aims *a); /* 1: some goal counts; NULL: none */
void aims_free(aims *a);       /* accepts NULL */

/* Of a pass, in this order: before its increments; after each of them; after
 * the last one. All accept NULL. */
status aims_begin(aims *a, const mesh *msh);
void aims_see(aims *a, const mesh *msh, const state *s);
void aims_evaluate(aims *a, const model *m);

/* Of the last pass; NULL: nothing is wanted. 1: all targets are reached. */
int aims_are_met(const aims *a, const model *m);
/* Why no mesh can reach them, or "". */
void aims_check(const aims *a, const model *m, char *why, size_t size);
/* 1: the meshes of the last two passes brought the goals no nearer. */
int aims_stand_still(const aims *a);
/* Largest error of the contact solver over that share of what is allowed, -. */
double aims_solver(const aims *a, const model *m, double share);
/* size[n_node] of the next mesh made smaller where a goal requires that;
 * eta[n_elem]: errors of the elements in the energy norm, or NULL. ERR_MEMORY.
 */
status aims_sizes(aims *a, const model *m, const mesh *msh, const double *eta,
                  double *size);
/* In the place of the targets: the errors shall fall to that part. */
void aims_ask(aims *a, double part);
/* Elements that goal i alone needs for its error, over those of the mesh of the
 * last pass, -. ERR_MEMORY. */
status aims_share(const aims *a, const mesh *msh, int i, double *share);
/* The goals that require it, after "mesh"; 0: none. */
size_t aims_name(const aims *a, const model *m, char *text, size_t size);

/* [n*n_goal] of the passes so far; NULL of NULL. */
const pass_goal *aims_rows(const aims *a);

#endif
