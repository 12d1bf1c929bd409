/*
 * Formulations of the contact problem: in the displacement of an increment
 * (CPR98, problem N3) and with given normal forces (problem D3). Each is again
 * a contact problem for any solver; its solution is transformed back.
 */
#pragma once

#include "contact/contact.h"

typedef struct velocity_form velocity_form;
/* Allocates for problems of the size of cp. */
status velocity_form_new(const contact_problem *cp, velocity_form **out);
/* [m] m: set to u_old before velocity_form_set. */
double *velocity_form_old(velocity_form *v);
/*
 * cp in the unknown du = u - u_old. *u[m]: the start value of u in, that of du
 * out; force[m]: that of the contact forces, N. *out borrows from v and cp. A
 * load on du that is rounding of the motion so far is none.
 */
void velocity_form_set(velocity_form *v, const contact_problem *cp,
                       const double *force, contact_problem *out, double **u);
/* u[m] = u_old + du; cp as given to velocity_form_set. */
void velocity_form_apply(const velocity_form *v, const contact_problem *cp,
                         double *u);

typedef struct given_form given_form;
/*
 * The normal unknowns of node[0..n) condensed out of cp->A. ERR_SINGULAR if
 * nothing but these forces holds the body along them; ERR_MEMORY. The nodes are
 * copied, cp->A is borrowed.
 */
status given_form_new(const contact_problem *cp, int n, const int *node,
                      given_form **out);
/*
 * cp with the forces force[n] >= 0 (N, pushing into the body) in the place of
 * the unilateral conditions: in *out the normal unknowns of the nodes are
 * uncoupled from all others, at 0 below a gap of "reach" > 0, m, and the
 * sliding limit includes their pressure. u, r [m]: start values, made to fit.
 * *out borrows from g and cp. ERR_MEMORY.
 */
status given_form_set(given_form *g, const contact_problem *cp,
                      const double *force, double reach, double *u, double *r,
                      contact_problem *out);
/*
 * From the solution u, r of that problem to that of cp: the normal
 * displacements of the nodes, and -force. cp->gap then points to gaps (borrowed
 * from g) that are closed at these nodes, so that (u, r) solves cp itself.
 */
void given_form_apply(given_form *g, contact_problem *cp, double *u, double *r);
/* To a motion u[m] without force: the normal displacements of the nodes. */
void given_form_move(given_form *g, double *u);
