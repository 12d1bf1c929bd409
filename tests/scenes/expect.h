/*
 * What is expected of a run, as text. Tests are separated by ";":
 *
 *   TABLE[.k] COLUMN [@X=value] = VALUE [or VALUE ...] ~ TOLERANCE
 *   FILE has WORDS        FILE lacks WORDS
 *
 * TABLE is one of *PRINT, k its block (absent: the last). Every row is tested,
 * or with @ the row whose column X is nearest. COLUMN with + in front is the
 * sum, with ^ the largest magnitude. VALUE is an expression of x, y, z of the
 * row; the tolerance is absolute; VALUE may also be "<" or ">" and a bound.
 * FILE is errors, lst, sta, json, cvg or dat.
 */
#pragma once

#include "support/job.h"

enum { WHY = 400 };

/* 1 if all hold; else why[WHY] tells the first that does not. */
int expect_all(const job *j, const char *tests, char *why);
/* Contact laws of the last table CONTACT: no pull, no penetration, one of the
 * two zero, tangential force within its limit. */
int expect_laws(const job *j, char *why);
