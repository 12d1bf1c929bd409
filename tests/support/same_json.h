/*
 * Whether JOB.json of two runs tells the same.
 */
#pragma once

#include "support/job.h"

#include <stddef.h>

/* Two runs in units that differ by powers of two: 1, all is the same but powers
 * of two in the numbers, and texts with numbers; else "where" tells. */
int same_json_bits(const job *a, const job *b, char *where, size_t size);
/* Values and errors of goals and of the mesh, to "tol" of each and "least". */
int same_json_errors(const job *a, const job *b, double tol, double least,
                     char *where, size_t size);
