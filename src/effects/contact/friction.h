/* What friction takes from the nonlocal average. */
#ifndef PROTIS_CONTACT_EFFECT_FRICTION_H
#define PROTIS_CONTACT_EFFECT_FRICTION_H

#include "run/run.h"

/* nonlocal.c: [n*n] - of a contact whose law has an average. */
const sparse_rows *nonlocal_average(const run *r, int contact_id);

#endif
