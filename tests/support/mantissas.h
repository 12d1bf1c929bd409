/*
 * Two runs in units that differ by powers of two: the same bits in all files.
 */
#pragma once

#include "support/job.h"

#include <stddef.h>

/* 1: both JOB.json are the same but for powers of two in their numbers and for
 * texts with numbers; else "where" tells. */
int mantissas_are_same(const job *a, const job *b, char *where, size_t size);
