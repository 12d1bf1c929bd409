/*
 * All tables of a JOB.dat, read in one pass.
 */
#pragma once

#include "support/job.h"

enum { COLUMNS_ = 64 };

typedef enum {
  T_CONTACT,
  T_TOTALS,
  T_NODES,
  T_ELEMENTS,
  T_REACTIONS,
  T_ENERGY,
  TABLES
} table_kind;

typedef struct table {
  int n_row, n_col;
  char name[COLUMNS_][24];
  double unit[COLUMNS_][3]; /* exponents of length, force, time             */
  double *value;            /* words: OPEN, SLIP, STICK 0, 1, 2, else NaN   */
} table;

/* One equilibrium. */
typedef struct snapshot {
  int step, increment; /* from 1                                            */
  double t;
  table of[TABLES]; /* n_col 0: not printed                              */
} snapshot;

typedef struct tables {
  int n;
  snapshot *at; /* [n]                                                      */
} tables;

/* n = 0 without a file. */
tables tables_read(const job *j);
void tables_free(tables *t);
int table_column(const table *t, const char *name); /* -1: absent             */
double table_at(const table *t, int row, int col);
/* Row of each number of the first column, [most + 1], -1 where absent. */
int *table_rows(const table *t, int most);
