/* What goals take from the stress intensity factors of the cracks. */
#ifndef PROTIS_CONTACT_EFFECT_CRACKS_H
#define PROTIS_CONTACT_EFFECT_CRACKS_H

#include "fracture/fracture.h"
#include "run/run.h"

/* The factors of a crack at r->now. */
typedef struct crack_factors {
  int n;
  const fracture_point *points; /* [n] borrowed */
  const fracture_factors *at; /* [n] borrowed until the next ones; NAN: none */
  int is_linear;              /* 1: in displacements and contact forces */
} crack_factors;
/* ERR_MEMORY. */
status cracks_factors(run *r, int crack_id, crack_factors *out);
/* K of a mode, which the point has, as a linear function; after
 * cracks_factors. ERR_MEMORY. */
status cracks_derive(const run *r, int crack_id, int point, int mode,
                     fracture_linear *out);
/* by[dim*n_node]: a derivative by tractions at the lips becomes that by the
 * forces there. */
void cracks_by_forces(const run *r, double *by);

#endif
