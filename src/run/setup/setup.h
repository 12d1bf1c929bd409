/* Setting a run up: once, for each step, and from an archive. */
#pragma once

#include "run/run.h"

/* adjust.c: moves the slave nodes of the pairs and ties with ADJUST=YES. Before
 * the run. ERR_DECK with an error in the log: an element is turned inside out;
 * ERR_MEMORY. */
status setup_adjust(model *m, mesh *msh);

/* circles.c, once ties and surface are made: ERR_DECK with an error in the log
 * if their nodes move with each other in a circle; ERR_MEMORY. */
status setup_check_circles(const run *r);

/* facing.c: p->group, of the contact p with an obstacle, becomes a new group of
 * its faces that face the obstacle at time 0, without those on the axis of
 * symmetry; a warning where contact acts along the mean of faces that meet at
 * an edge. */
status setup_facing(const run *r, contact_pair *p);

/* flow.c: the start of the points whose law flows, after strains_new: what the
 * deck does not give of inelastic strains and the units that make them.
 * ERR_DECK with an error in the log: they do not agree; a temperature of a
 * *VISCO step is not above the absolute zero of a law. ERR_MEMORY. */
status setup_flow(const run *r);

/* setup.c */
/* weight[n_face], new: thickness of the elements at the faces, m. */
status setup_face_weights(const model *m, const mesh *msh, double **weight);
status run_new(run *r, const effect_ops *const *effects);
void run_free(run *r);

/* prepare.c: rigid motions that the supports of r->step leave free, nothing
 * solved: *list is new (memory_free), NULL if there are none. ERR_SINGULAR with
 * the list if nothing at all resists one. */
status run_motions(run *r, int *n, free_motion **list);
/* ERR_SINGULAR likewise, of the current surface; *n_free: how many there are.
 */
status run_check_supports(const run *r, int *n_free);

/* The largest nodal load at the ends of r->step, which begins with r->old.F, to
 * r->loads.largest; ERR_DECK, of prescribed displacements ERR_SINGULAR: squares
 * leave the range of the numbers. Writes to r->now.F. */
status run_check_range(run *r);

/* Contact nodes that the problems of r->step have at least; 0: not known. */
int run_least_nodes(const run *r);

/* surface.c: the surface of r->body.fixed, with or without the old state. */
status run_build_surface(run *r);
void run_free_surface(run *r);

/* The nodes of *TIE under r->body.fixed, before the surface. */
status run_build_ties(run *r);
void run_free_ties(run *r);

/* prepare.c: surface, stiffness, condensed matrix and solver for r->step. */
status run_prepare(run *r);

/* keep.c: the state an increment starts from that does not follow from the
 * matrices, to an archive, or, after run_prepare, from it. */
status run_keep(run *r, archive *a);
/* r->loads.start alone; r->body.choice. */
status run_keep_start(run *r, archive *a);
status run_keep_choice(run *r, archive *a);
