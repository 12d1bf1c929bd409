/* Stress across sides of the body that nothing holds or touches. */
#pragma once

#include "run/run.h"

typedef struct free_sides {
  int n, *side; /* [n] of mesh_border */
} free_sides;

/* Of what r->result.stress has there more or less than loads give, over the
 * elements behind, J: all of it is error. ERR_MEMORY. */
status free_sides_energy(const run *r, const free_sides *s, double *energy);
