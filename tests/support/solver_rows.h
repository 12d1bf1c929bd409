/*
 * The rows of the solver table, and AUTO after the last, for tests that loop
 * over them: a new row is tested without a new line.
 */
#pragma once

#include "solver/solver.h"
#include "support/contact_case.h"

enum { PARAM_SIZE = 512 }; /* bytes, room for the options of a row            */

/* Row i; AUTO (NULL) after the last. 0: no more. */
int solver_row(int i, const solver_ops **ops);
/* EACH_SOLVER(i, ops) {...}: for each row i. */
#define EACH_SOLVER(i, ops) \
  const solver_ops *ops;    \
  for (int i = 0; solver_row(i, &ops); ++i)
const char *row_name(const solver_ops *ops);
/* 1: the row takes problems of this kind. */
int row_handles(const solver_ops *ops, const contact_problem *cp);
/* Solve by one row with its default options, from u, r. */
solver_report solve_by(const solver_ops *ops, const contact_case *c, double tol,
                       double *u, double *r);
/* Set an option in param[PARAM_SIZE]. */
void set_option(const solver_ops *ops, void *param, const char *name,
                const char *text);
/* Start values zero. */
void case_cold(contact_case *c);
/* Every row that takes the problem, from a cold start, must solve it and
 * satisfy the conditions to "bad"; the answer of AUTO is left in c. */
void all_rows_solve(contact_case *c, const char *what, double bad);
