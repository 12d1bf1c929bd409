/*
 * Weighted sums of every number a run writes into JOB.dat, JOB.json and JOB.h5:
 * one for each column of a table, each key and each dataset (its increments
 * together). One changed number changes a sum. A file of sums holds a line
 *
 *   name count sum tolerance
 *
 * each; tolerance is absolute, in the unit of the numbers.
 */
#pragma once

#include "support/job.h"

typedef struct sum_row {
  char name[112];
  long count;
  double total, largest, tolerance;
} sum_row;

typedef struct sums {
  sum_row *row; /* [n] in the order of their first numbers */
  int n, capacity;
} sums;

/* Of a run in the folder; check fails if a file cannot be read. */
sums sums_of(const job *j);
void sums_free(sums *s);
/* Widen the tolerances of a by the distance of b, the sums of the same run with
 * other kernels of the libraries. */
void sums_spread(sums *a, const sums *b);
void sums_write(const sums *s, const char *path);
/* Check fails, naming the numbers that differ, if s is not what the file
 * holds. */
void sums_check(const sums *s, const char *path);
