/* The loop over steps and increments. */
#pragma once

#include "exchange/exchange.h"
#include "run/effect.h"

/*
 * Run all steps with the effects (a table that NULL ends) that the model
 * requires. *unsettled counts the increments that did not converge to their
 * tolerance at the smallest dt. Errors: ERR_SINGULAR (no equilibrium), those of
 * interrupt_asked, which ends the run between two attempts, those of the sink,
 * ERR_MEMORY.
 */
status history_run(const model *m, const mesh *msh,
                   const effect_ops *const *effects, const history_sink *sink,
                   int *unsettled);
/* The same from a checkpoint of an equal model on (from NULL: from the start):
 * bit for bit the run that was not interrupted. Borrowed; ERR_FILE if it does
 * not fit. */
status history_continue(const model *m, const mesh *msh,
                        const effect_ops *const *effects, archive *from,
                        const history_sink *sink, int *unsettled);

/*
 * A problem without a mesh (*CONDENSED PROBLEM): one solve, passed on as one
 * increment. The state has the unknowns in the signs of contact.h, of a plain
 * LCP w in uc and z in rc. Errors: as history_run.
 */
status condensed_run(const model *m, const exchange_problem *p,
                     const history_sink *sink, int *unsettled);

/* The reported bound, for a solution of that energy, J. */
void error_bound_set(const solver_error *found, double energy, error_bound *e);
/* Its part of the increments before, -. */
double error_bound_before(const error_bound *e);
/* 1: what the increment adds to it, or what rounding hides of contact forces,
 * is above 10 % of the energy norm of an answer under full loads, of which
 * "share" act now: an answer that does not count as one. */
int error_bound_doubts(const error_bound *e, double share);
/* The reason where the matrix has no inverse. */
extern const char *const error_bound_indefinite;

/* Other solutions than (u, r), which a solver reports so, into *out, if the
 * step requires them. ERR_DECK: CHECK=ALL is not possible. */
status check_problem(const step *s, const contact_problem *cp,
                     const solver_report *report, const double *u,
                     const double *r, solution_set *out);

/* The same before anything is solved, of at least n contact nodes; corner: one
 * of them touches two obstacles. */
status check_possible(const step *s, int dim, int n, int corner);

/* All steps, nothing solved (ahead.c): supports, contact surfaces, and what the
 * effects tell of them. Errors are in the log or name their place: those that
 * the run would end with, ERR_DECK, ERR_SINGULAR; ERR_MEMORY. */
status history_check(const model *m, const mesh *msh,
                     const effect_ops *const *effects);

/* All steps, nothing solved: ERR_DECK, ERR_SINGULAR where the run would end
 * because loads, moduli or displacements leave the range of the numbers;
 * ERR_MEMORY. */
status history_ranges(const model *m, const mesh *msh,
                      const effect_ops *const *effects);

/* How the first step would know the condensed stiffness, nothing solved. */
status history_stiffness(const model *m, const mesh *msh,
                         const effect_ops *const *effects,
                         stiffness_choice *choice);

/* Rigid motions that the supports of a step leave free, nothing solved: *list
 * is new (memory_free), NULL if there are none. ERR_SINGULAR with the list if
 * nothing at all resists one; the log tells which. */
status history_motions(const model *m, const mesh *msh,
                       const effect_ops *const *effects, int step_id, int *n,
                       free_motion **list);
