/*
 * The linear system of one step of the methods of Newton's kind (system.h)
 * where the stiffness is an operator. The symmetric part of its matrix, without
 * the friction that follows pressure, is factored for the rows of the guess;
 * GMRES (Saad, Schultz 1986) preconditioned by it from the right adds the
 * friction, which has rows at the slipping nodes only.
 */
#ifndef PROTIS_NEWTON_OPERATED_H
#define PROTIS_NEWTON_OPERATED_H

#include "solver/newton/system.h"

typedef struct operated_system operated_system;
status operated_system_new(const contact_problem *cp, operated_system **out);
void operated_system_free(operated_system *s); /* accepts NULL */
/* No step before on the same rows. */
void operated_system_fit(operated_system *s);
/* newton_system_step. *singular 1: weak springs held the body. ERR_MEMORY. */
status operated_system_step(operated_system *s, const contact_problem *cp,
                            pattern *p, double *u, double *raw, int *singular);
/* du[m], Adu[m] = A du: the known rows of the guess p (place < 0) as du has
 * them, at the others
 *   (A + hold + kappa (I - e e') + e B A_n) du = b,
 * hold[m] on the diagonal (N/m; NULL: none), the next in slipping nodes alone,
 * A_n rows of closed unknowns. *singular 1: weak springs held the body.
 * ERR_MEMORY. */
typedef struct operated_rows {
  const pattern *p;
  const double *hold, *b;
} operated_rows;
status operated_system_direction(operated_system *s, const contact_problem *cp,
                                 const operated_rows *rows, double *du,
                                 double *Adu, int *singular);
/* newton_system_work. */
linear_work operated_system_work(const operated_system *s,
                                 const contact_problem *cp);
/* 1: raw of the last step is a sum over steps, not the reaction of u. Accepts
 * NULL. */
int operated_system_sums(const operated_system *s);
/* 1: another step on the same rows may mend the last, which was solved to a few
 * digits. Accepts NULL. */
int operated_system_refresh(operated_system *s);

#endif
