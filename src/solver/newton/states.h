/*
 * The guess of the states of a run of Newton's method: from the forces and
 * displacements of the last step, and enforced exactly in the forces
 * (newton.c).
 */
#ifndef PROTIS_NEWTON_STATES_H
#define PROTIS_NEWTON_STATES_H

#include "solver/newton/system.h"

#include <stdint.h>

typedef struct states {
  const contact_problem *cp;
  pattern guess;
  double *u;        /* [m] of the caller, m */
  double *r;        /* [m] of the caller, N */
  double *raw;      /* [m] A u - f, N; compliance form: W r + q, m */
  double *k;        /* [m] stiffness of each unknown alone, N/m */
  double *c;        /* [n] mean of them in the tangent plane, N/m */
  double *g;        /* [n] sliding limits, N */
  double *rounding; /* [n] of the forces of each node, N */
  int careful;      /* one state changed at a time, the least index first */
  uint64_t dice;    /* not 0: each change is made or postponed at random */
} states;

/* Arrays for a matrix. */
status states_new(const contact_problem *cp, states *s);
void states_free(states *s);
/* r from raw with the conditions of the guess enforced exactly: no force where
 * open, |r_t| = g where slipping; compliance form: u from raw, no gap where
 * closed, no slip where stuck. */
void states_clean(const states *s);
/* The next guess from (u, r); returns the number of states that would change;
 * some may be postponed. fresh: there is no guess before. */
int states_next(states *s, int fresh);
/* Every node closed, every node with friction sticks. */
void states_all_stick(states *s);
/* FNV-1a over the pattern. */
uint64_t states_hash(const states *s);

#endif
