/*
 * The linear system of one step of Newton's method (newton.c) where only the
 * compliance is known: the unknowns are the unknown forces of a guess of the
 * states, u = W r + q.
 *
 *   open    r_n = 0                      known
 *   closed  u_n = gap                    unknown r_n
 *   stick   u_t = ut0                    unknown r_t
 *   slip    r_t = g e + s d,  g = g0 - B r_n,  d normal to e
 *           d.(u_t - ut0) + s/kappa = 0  unknown s, in 3-D
 *
 * The system is the smaller, the fewer nodes are closed and the more slip. No
 * inverse of W is made; W may be unsymmetric.
 */
#ifndef PROTIS_NEWTON_COMPLIANCE_H
#define PROTIS_NEWTON_COMPLIANCE_H

#include "solver/newton/system.h"

typedef struct compliance_system compliance_system;
status compliance_system_new(const contact_problem *cp,
                             compliance_system **out);
void compliance_system_free(compliance_system *s); /* accepts NULL */
/* raw = W r + q */
void compliance_displace(const contact_problem *cp, const double *r,
                         double *raw);
/* r becomes the forces of the guess p, raw = W r + q. Returns 1 if the system
 * is singular: r and raw are then undefined. */
int compliance_system_step(compliance_system *s, const contact_problem *cp,
                           const pattern *p, double *r, double *raw);

#endif
