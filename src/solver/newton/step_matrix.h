/*
 * The matrix of a step of Newton's method on the forces (proximal.c), row by
 * row:
 *
 *   J_i = e_i                                         nothing acts on unknown i
 *   J_i = e_i - sum_j c_ij (e_j (1 - a) - D_j W_j) + ...            the others
 *
 * with rows W_j of the compliance. Unknowns of the first kind are eliminated;
 * what is left is sparse where W is, and then factored by UMFPACK, else by
 * LAPACK.
 */
#ifndef PROTIS_NEWTON_STEP_MATRIX_H
#define PROTIS_NEWTON_STEP_MATRIX_H

#include "contact/force_set.h"

typedef struct step_matrix step_matrix;
/* set: borrowed. */
status step_matrix_new(const contact_problem *cp, const force_set *set,
                       step_matrix **out);
void step_matrix_free(step_matrix *s); /* accepts NULL */
/* A new matrix: acts[m], 0: row i is e_i; d[m] the right side, kept by the
 * caller until the solve. */
void step_matrix_begin(step_matrix *s, const unsigned char *acts,
                       const double *d);
/* Into the current row: value in column j; share times row j of W. */
void step_matrix_add(step_matrix *s, int j, double value);
void step_matrix_add_row(step_matrix *s, int j, double share);
/* It is row i (with acts[i], in ascending order); the next one is empty.
 * Errors: ERR_MEMORY. */
status step_matrix_put(step_matrix *s, int i);
/* d <- inv(J) d; *singular = 1: not found. Errors: ERR_MEMORY. */
status step_matrix_solve(step_matrix *s, double *d, int *singular);

#endif
