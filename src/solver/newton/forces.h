/*
 * What compliance_system is made of: the unknown forces of a guess and their
 * matrix (compliance.c), forces freed in a kept factor (freed.c).
 *
 * A factor without slip in it is kept as the base, of the plain forces N. Where
 * a later guess frees some of them, C, by opening or slip, the displacements of
 * C become unknowns z, and with X = inv(W_NN) E_C the change of the forces is
 *
 *   dr = x0 + X z,   W_NN x0 = b without C,
 *
 * z from what the guess asks of the forces of C: none where open, on the limit
 * where slipping. These rows have few entries; X is kept.
 */
#ifndef PROTIS_NEWTON_FORCES_H
#define PROTIS_NEWTON_FORCES_H

#include "solver/newton/compliance.h"
#include "solver/newton/dense.h"

/* An unknown force: of one degree of freedom, or along d in the tangent plane
 * of a slipping node. */
typedef struct unknown {
  int dof;     /* of d: the first tangent                                     */
  int turns;   /* 1: along d                                                  */
  double d[2]; /* -; {1, 0} of a single one                                   */
} unknown;

struct compliance_system {
  const contact_problem *cp; /* of this step                                  */
  const pattern *p;          /* of this step                                  */
  double power;              /* of two: W*power has a diagonal of order 1     */
  unknown *list;             /* [m]                                           */
  int *dof;                  /* [m] of each                                   */
  int *place;                /* [n] of the normal force in the list, or -1    */
  int *turn;                 /* [n] of the unknown along d, or -1             */
  int n, n_turn;             /* unknowns; of them along d                     */
  dense K;                   /* their matrix, times power; factor of the base */
  double *x, *y;             /* [m]                                           */
  int n_base;                /* unknowns of the base, 0: none                 */
  int *base, *in_base;       /* [m], [m] its unknowns; their place, -1: not   */
  double spent;              /* on freed forces since it was made, operations */
  int room, n_column;        /* columns of X: most, made                      */
  int *column;               /* [m] of X, of unknowns of the base, -1: none   */
  double *X;                 /* [m*room]                                      */
  int n_freed, *freed;       /* [room] unknowns of the base                   */
  double *C, *z;             /* [room*room], [room] small system              */
  int *pivot;                /* [room]                                        */
};

/* List what the guess frees; the operations of a step with it, or HUGE_VAL if
 * there is no base or the guess asks for forces that are not in it. */
double freed_cost(compliance_system *s);
/* x, by place in the list, from the right sides to the change of the forces.
 * 0: the small system is singular. */
int freed_solve(compliance_system *s);

#endif
