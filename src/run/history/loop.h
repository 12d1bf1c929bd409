/* The loop over increments, shared by the files of this folder only. */
#pragma once

#include "model/course.h"
#include "run/history/history.h"
#include "run/run.h"

/* history.c: r->now is an increment of the run: checked, reported, made r->old.
 *   attempt       1: not cut
 *   increment_no  within the step, from 1; 0: the start
 *   last          1: it ends the step
 *   cpu           of the process when it began, s */
status loop_accept(run *r, int attempt, int increment_no, int last, double cpu);
/* It is not: reported with the reason. */
status loop_reject(run *r, int attempt, int increment_no, const char *why);
/* 1: one of these tables (bits PRINT_*) shows the increment that ends at t. */
int table_is_due(const step *s, int tables, double t, int increment_no,
                 int last);
int table_is_due_now(const run *r, int tables); /* of r->now, or a shadow */
/* 1 if a shorter increment may converge where this attempt did not: the solver
 * does not stagnate, or at a lower residual than before, after an increment
 * that converged. Where there is no equilibrium increments grow. */
int loop_cut_helps(const run *r);
/* Reports that there is no equilibrium: ERR_SINGULAR. */
status loop_no_equilibrium(run *r);
/* 1 if no load acts at the start of the step that did not act before, and
 * nothing ends; r->now has the loads of then. */
int loop_starts_smoothly(const run *r);
/* From r->old to r->now at t by the procedure of the step, or that of an
 * effect; the first alone. */
status loop_solve(run *r, double t);
status loop_solve_once(run *r, double t);
/* tables.c: the end of an increment that the program has chosen to end at t:
 * there, or at a point of a table of the loads, supports, temperatures,
 * obstacles or contacts in force, before one of them differs from what the
 * increment sees of it by more than a share, -, of its largest magnitude in
 * the step. */
double loop_end(const run *r, double t, double share);
/* turns.c: the middle of the increment from t0 to t, and the times at which
 * what acts on the body turns between; *all = 0: they are more than the list
 * has places for. Writes to r->now. */
status loop_turns(run *r, double t0, double t, turn_list *list, int *all);
/* Between two attempts: the checkpoint that is due; ends the run if asked. */
status loop_pause(run *r);

/* The loads now over the largest of the step, at most 1. */
double share_of_step(const run *r);
/* rounding.c: the rounding error of r->now, whose energies are known.
 * ERR_SINGULAR: no correct digit. */
status rounding_find(run *r);
/* Contact forces that may be below the rounding of the motion: contact_hidden,
 * own forces by the stresses next to the node. */
status rounding_hidden(const run *r, double *part);
/* *hides = 1: the stresses, or the strains too, of the body are no more than
 * the rounding of its motion. */
status rounding_hides_stresses(const run *r, int *hides);
status rounding_hides_strains(const run *r, int *hides);
/* Energy that the elasticity would give the strains of a body whose law flows,
 * J; 0: it has none, or no more than the rounding of its motion. */
double rounding_strain_left(const run *r);
/* What gaps, differences of coordinates, have as rounding, m. */
double rounding_of_gaps(const run *r);
/* Rounding of the forces that this motion takes times the motion, J. */
double rounding_of_works(const run *r);
/* 1: no load acts on it either, contact forces are no more than that, and its
 * supports do not strain it (gaps that close with no other force have their
 * rounding too); or contact carries the load straight, and strains are rounding
 * of both, of the motion, or left by the solver. After rounding_find. */
int rounding_is_all(const run *r);

/* estimate.c: errors at r->now into r->errors.error, mesh_error, if required.
 */
status estimate_increment(run *r);
/* Of a copy of the run at a time within the increment: that of the mesh. */
status estimate_within(run *copy);
/* Those of solver and mesh alone, from r->now.u; read r->errors.evaluated. */
status estimate_evaluate(run *r);
