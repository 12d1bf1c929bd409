/*
 * What the files of friction share.
 */
#ifndef PROTIS_CONTACT_EFFECT_FRICTION_H
#define PROTIS_CONTACT_EFFECT_FRICTION_H

#include "run/run.h"

/* friction.c: the limit of the nodes at the time posed last. */
const friction_limit *friction_limit_of(const run *r);

/* nonlocal.c: [n*n] - of a contact whose law has an average. */
const sparse_rows *nonlocal_average(const run *r, int contact_id);

#endif
