/*
 * Setting a run up: once, for each step, and from an archive.
 */
#ifndef PROTIS_SETUP_SETUP_H
#define PROTIS_SETUP_SETUP_H

#include "run/run.h"

/* setup.c */
status run_new(run *r, const effect_ops *const *effects);
void run_free(run *r);

/* supports.c: rigid motions that the supports of r->step leave free, nothing
 * solved: *list is new (memory_free), NULL if there are none. ERR_SINGULAR with
 * the list if nothing at all resists one. */
status run_motions(run *r, int *n, free_motion **list);
/* The same of the surface at hand; *n: those that contact alone holds. */
status run_check_supports(const run *r, int *n);

/* surface.c: the surface of r->body.fixed, with what the old one knew; without.
 */
status run_build_surface(run *r);
void run_free_surface(run *r);

/* prepare.c: surface, stiffness, condensed matrix and solver for r->step. */
status run_prepare(run *r);

/* keep.c: all that an increment starts from and the matrices do not tell, named
 * for an archive: kept, or, after run_prepare, filled. */
status run_keep(run *r, archive *a);

#endif
