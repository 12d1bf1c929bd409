/*
 * Small jobs for runs that are killed, starved and disturbed: a few dozen nodes
 * and increments, every kind of result file, a restart file.
 */
#pragma once

#include "support/job.h"

/* A block in the plane, pressed and moved to and fro by its top; "cards" stand
 * among the requests of output of the first step. */
job small_flat(double mu, const char *cards, const char *method);
/* A block in space, pressed, sheared and turned aside. */
job small_solid(double mu, const char *cards, const char *method);
/* A Maxwell block that is pressed and then flows; its method is the integrator,
 * as in "INTEGRATOR=MIDPOINT". */
job small_creep(double mu, const char *cards, const char *method);
