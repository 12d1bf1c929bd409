#pragma once

#include "contact/contact.h"

/* Natural map of the forces r (of u where the stiffness is known), the other
 * recomputed, over the largest force or load. */
double natural_map(const contact_problem *cp, double *u, double *r);
