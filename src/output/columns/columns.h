/*
 * The columns of all tables and fields, and tables as text.
 *
 * Adding a column is one row in the table of its entity (columns.c for the
 * increments, nodes and contacts) or of its effect (src/effects): the
 * tables of JOB.dat and of the listing, the fields and histories of JOB.h5 and
 * JOB.xdmf, and the tests loop over them.
 */
#pragma once

#include "run/effect.h"

#include <stdio.h>

unsigned scene_of(const model *m);
/* All columns, entity after entity; all-zero before the first, NULL behind the
 * last. */
typedef struct column_walk {
  int part, at, effect, k;
} column_walk;
const column *column_next(column_walk *w);
/* Before the first of an entity. */
column_walk columns_of(entity of);

/* 1: the model shows the column at all. */
int column_visible(const column *c, const model *m);
/* 1: the arrays it reads are there. */
int column_ready(const column *c, const state *s);
/* Number of items of its entity. */
int column_items(const column *c, const view *v);
/* The defect over the largest of the energies so far; 0: nothing moved yet. */
double energy_defect_relative(const energies *e);

/* Columns of a table that the model and the state have. */
typedef struct table {
  int n;
  entity of;
  const column *col[64];
  int width[64];
  int digits; /* after the point */
} table;
void table_choose(table *t, entity of, unsigned print_bit, const view *v,
                  int digits);
/* The header with "lead" before it ("#", " "), and one record. */
void table_header(const table *t, const model *m, const char *lead, FILE *f);
void table_row(const table *t, const view *v, int id, FILE *f);
