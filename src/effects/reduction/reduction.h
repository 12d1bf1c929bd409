/*
 * *EFFECTS, MODE=AUTO, TOL=: effects that the deck calls for are left out where
 * they do not matter, and that is proved with the answer found without them.
 *
 * A sign before the run chooses what to try, from the deck alone. During the
 * run each increment adds to a bound of what the effect would have changed, in
 * the energy norm of the solution (measure.c has the estimates), and to the
 * largest stress it would have made in one element, over the largest contact
 * pressure or stress. The answer counts if the first is below SHARE * TOL and
 * the second below TOL at every increment; else the run is made again with that
 * effect, until what is left out holds.
 */
#ifndef PROTIS_REDUCTION_REDUCTION_H
#define PROTIS_REDUCTION_REDUCTION_H

#include "run/history/history.h"

/* Part of TOL that the bound in the energy norm may have: pressures of single
 * nodes change by more than the norm. */
extern const double reduction_share; /* - */

/* What to try without: m->neglected. */
status reduction_choose(model *m, const mesh *msh);
/* Leave the rows out that are not back, their bounds zero: m->effects. */
void reduction_leave_out(model *m);
/* Everything back in; m->neglected stays as the account of what was tried. */
void reduction_restore(model *m);

typedef struct reduction reduction; /* what the bounds are summed up from */
status reduction_new(const model *m, const mesh *msh, reduction **out);
void reduction_free(reduction *n); /* accepts NULL */
/* An accepted increment into the rows[m->n_neglected] of m. */
status reduction_measure(reduction *n, const state *s, neglected *rows);
/* 1: a row is above the tolerance already; the run need not go on. */
int reduction_refuted(const model *m);
/* Take those back that are above the tolerance or never were measured; with
 * "all" all, the run without them not being solved. How many. */
int reduction_take_back(model *m, int all);

#endif
