/*
 * What METHOD=AUGLAG is made of: the augmented forces and the states of the
 * nodes (forces.c), the two variants (generalised.c, uzawa.c). The equations
 * stand in auglag.c. Private to src/solver/augmented.
 */
#ifndef PROTIS_AUGMENTED_PARTS_H
#define PROTIS_AUGMENTED_PARTS_H

#include "contact/force/force_set.h"
#include "solver/fixed_point.h"
#include "solver/local.h"
#include "solver/solver.h"

#include <stdint.h>

enum {
  NEWTON_STEPS = 60, /* of the generalised Newton method                      */
  SHORTENINGS = 10   /* of one step                                           */
};

typedef enum { OPEN, CLOSED } contact_state;

typedef enum { FREE, STICK, SLIP } tangent;

typedef struct auglag_work {
  int m;                 /* unknowns                                        */
  unsigned char *part;   /* [m] force_part                                   */
  unsigned char *closed; /* [m] contact_state of the unknowns that push      */
  unsigned char *mode;   /* [n] tangent                                      */
  unsigned char *state;  /* [m] of the step told last                        */
  double *origin;        /* [m] m                                            */
  double *diagonal;      /* [m] of A, the mean in a tangent plane, N/m       */
  double *lambda, *z, *F, *y; /* [m] N; y = A u - f. Newton: work, work    */
  double *du, *dy;   /* [m] step, A du                                   */
  double *bonded;    /* [n] no limit                                     */
  double *e, *share; /* [m] direction of slip, [n] g/|z|                 */
  double *K;         /* [m*m]                                            */
  double power;      /* of two: power*A has a diagonal of order 1         */
  uint64_t seen[NEWTON_STEPS + 1]; /* hashes of the states of the steps     */
  int *pivot, *free_id; /* [m]                                              */
  fixed_point *fixed;
  best_iterate best;
} auglag_work;

typedef struct auglag_run {
  const contact_problem *cp;
  auglag_work *w;
  const solver_control *control;
  double *u, *r;
  double scale, rho; /* N; -, of the diagonal                                */
  int steps, limit;
  int changes;  /* states changed by the last evaluation                      */
  int turned;   /* nodes with another state than after the step before        */
  int bent;     /* 1: F' of a slipping node moves with z (3-D)                */
  int factored; /* w->K is the factor for the present states                 */
  int singular; /* the last matrix needed springs                            */
  int cycle;    /* the states were met before in these Newton steps          */
} auglag_run;

/* ---- forces.c ---- */

/* rho of an unknown, N/m. */
double auglag_rho(const auglag_run *s, int dof);
/* z, F and the states from base (lambda, or y) and u. */
void auglag_evaluate(auglag_run *s, const double *base);
/* 1: an unknown in the tangent plane of a node that slips. */
int auglag_slips(const auglag_run *s, int dof);
/* 1: F of the unknown is z. */
int auglag_is_fixed(const auglag_run *s, int dof);
/* share (I - e e') of a slipping node, entry of two of its unknowns. */
double auglag_turning(const auglag_run *s, int a, int b);
/* The states after a step into w->state; counts the nodes that differ from the
 * step before. */
void auglag_take_states(auglag_run *s);
/* Residual of (u, F), told and kept. */
double auglag_judge(auglag_run *s);
/* u += a du, y += a dy */
void auglag_move(auglag_run *s, double a);

/* ---- generalised.c ---- */

/* From u to CONVERGED, or why it stopped. */
outcome auglag_newton(auglag_run *s);

/* ---- uzawa.c ---- */

/* The same from u and r, for a limit that does not follow the pressure. */
outcome auglag_uzawa(auglag_run *s);
/* u and r of the problem without slip: pressures for the first limit. */
void auglag_start_bonded(auglag_run *s);

#endif
