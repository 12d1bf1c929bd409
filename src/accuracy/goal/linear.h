/*
 * The linear system of the contact problem linearised at a solution, and its
 * transpose, of a matrix or an operator:
 *
 *   M = A_FF + e B A_nF + kappa (I - e e')   (the last two on slip)
 *
 * on the free unknowns F, e the direction of the friction force. Private to
 * src/accuracy/goal.
 */
#ifndef PROTIS_GOAL_LINEAR_H
#define PROTIS_GOAL_LINEAR_H

#include "contact/contact.h"

/* What each unknown does; all is borrowed. */
typedef struct linear_rows {
  const contact_problem *cp;
  int n_free;
  const int *free_id, *place; /* [n_free], [m] place among them, or -1 */
  const unsigned char *closed, *slip; /* [n] */
  const double *e;                    /* [m] direction of friction on slip */
  const double *kappa;                /* [n] N/m */
} linear_rows;

/* y[m] += e B v_n of the closed normals of v[m], at the sliding unknowns. */
void linear_add_friction(const linear_rows *rows, const double *v, double *y);
/* w_n += B' (e.w_t) on the closed normals of w[m], of its sliding unknowns. */
void linear_spread_friction(const linear_rows *rows, double *w);
/* y[m] += kappa (I - e e') v at the sliding unknowns, in space. */
void linear_add_turn(const linear_rows *rows, const double *v, double *y);

typedef struct linear_system linear_system;
/* *out is new; NULL if M is singular. ERR_MEMORY. */
status linear_system_new(const linear_rows *rows, linear_system **out);
void linear_system_free(linear_system *s); /* accepts NULL */
/* x[m], at the known unknowns as given: (A + e B A_n + kappa ..) x = b at the
 * free ones, b[m]. ERR_MEMORY. */
status linear_solve(linear_system *s, const double *b, double *x);
/* w[m]: M' w = b at the free unknowns, B' (e.w_t) on closed normals, else 0.
 * ERR_MEMORY. */
status linear_solve_transposed(linear_system *s, const double *b, double *w);

#endif
