/*
 * *EFFECTS, MODE=AUTO, TOL=: effects that the deck requires are left out where
 * they do not matter, and that is proved with the answer found without them.
 *
 * A sign before the run chooses what to try, from the deck alone. During the
 * run each increment adds to a bound of what the effect would have changed, in
 * the energy norm of the solution (measure.c has the estimates), and to the
 * largest stress it would have made in one element, over the largest contact
 * pressure or stress. The solution is accepted if the first is below SHARE *
 * TOL and the second below TOL at every increment; else the run is repeated
 * with that effect, until all bounds hold.
 */
#pragma once

#include "run/history/history.h"

/* Part of TOL that the bound in the energy norm may have: pressures of single
 * nodes change by more than the norm. */
extern const double reduction_share; /* - */

/* Candidates: m->omitted. */
status reduction_choose(model *m, const mesh *msh);
/* Leave the rows out that are not back, their bounds zero: m->effects. */
void reduction_leave_out(model *m);
/* All effects back in; m->omitted remains as the record of the trials. */
void reduction_restore(model *m);

typedef struct reduction reduction; /* sums of the bounds */
status reduction_new(const model *m, const mesh *msh, reduction **out);
/* An accepted increment into the rows[m->n_omitted] of m. */
status reduction_measure(reduction *n, const state *s, omitted *rows);
/* 1: a row is already above the tolerance; the run can end. */
int reduction_refuted(const model *m);
/* Restore those above the tolerance or never measured; with "all" all, as the
 * run without them was not solved. Their number. */
int reduction_take_back(model *m, int all);
