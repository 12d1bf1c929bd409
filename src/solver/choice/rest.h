/*
 * The place of a body that no force holds.
 *
 * Where motions R_c of whole bodies move neither a pressed node along its
 * normal nor one that friction may hold along its tangent, the equilibrium
 * u + R_c q is one for every q that leaves the gaps open. Of these places the
 * body has the one nearest to the last equilibrium, over all nodes:
 *
 *   min |u + R q - u_old|^2,   u_n + (R_c q)_n <= gap.
 */
#pragma once

#include "contact/contact.h"
#include "fem/fem.h"

/* All is borrowed. */
typedef struct rest_scene {
  const contact_problem *cp;
  condensed *c; /* of which cp has its matrix */
  size_t n_dof;
  const double *F;         /* [n_dof] forces without those of contact, N */
  const double *old, *now; /* [n_dof] last equilibrium, this one, m */
  const double *before;    /* [m] largest force of the last one, N; or NULL */
  double tol;              /* of the solver, -, of the load of a body */
} rest_scene;

/* The solution u[m] with the forces f[m] is put there; *moved 1: u has changed.
 * Motions that F works on are left. ERR_MEMORY. */
status rest_find(const rest_scene *at, double *u, const double *f, int *moved);
