/*
 * Difference between the solution of an increment and the closed form of
 * *REFERENCE: the true error, in the norms of the estimates.
 */
#pragma once

#include "fem/fem.h"
#include "model/model.h"

/* Relative to the norm of the closed form, -; NAN: not available. */
typedef struct true_error {
  int asked;
  double energy;       /* of the stresses, integral of s' inv(E) s; without
                          stresses in the card of E times all the strain */
  double displacement; /* L2 */
  double stress;       /* L2, all components of the tensor */
  double pressure;     /* L2 on the contact surface, of nodal values */
  double cpu;          /* s, CPU time for it so far */
} true_error;

/* A solution at time t. */
typedef struct answer_fields {
  double t;             /* s */
  const double *u;      /* [dim*n_node] m */
  const double *stress; /* [ns*n_elem] Pa; NULL if the card has no stress */
  const double *rc;     /* [dim*n] forces of the contact frame, N */
} answer_fields;

/* All parts of *REFERENCE into out->energy .. pressure. ERR_DECK: a value of
 * the closed form is not finite (the record says where); ERR_MEMORY. */
status exact_error_find(const closed_form *ref, const domain *d,
                        const answer_fields *a, true_error *out);
