/*
 * A contact problem whose stiffness is an operator, made of its entries: for
 * tests of the methods that work by products and solves.
 */
#pragma once

#include "contact/operator.h"
#include "support/contact_case.h"

typedef struct operated_case {
  contact_operator op;
  contact_problem of; /* with A                                               */
  contact_bodies *bodies;
  unsigned char *known; /* [m]                                                */
  double *M, *y;        /* [m*m] factor of the free rows; [m]                 */
  double *diagonal, *workspace, *kernel;
  double power; /* of two, over the diagonal                                  */
  int pin[6]; /* unknowns with springs where no row is known                  */
} operated_case;

/* c->cp has the operator in the place of A, whose diagonal is said to be larger
 * than it is; also of a body that contact alone holds. */
operated_case *operated_new(contact_case *c);
void operated_free(operated_case *o, contact_case *c); /* A as before */
