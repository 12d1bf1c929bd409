/*
 * Constants of *ELASTIC that depend on temperature.
 */
#ifndef PROTIS_MATERIAL_TABLE_H
#define PROTIS_MATERIAL_TABLE_H

#include "deck/deck.h"
#include "material/material.h"

/* Constants over the temperature: linear between, constant outside. */
typedef struct elastic_constants {
  double temperature;
  double constant[ELASTIC_MAX]; /* Pa, - */
} elastic_constants;
typedef struct elastic_table {
  elastic_type type;
  int n_constant;
  int n;                  /* sets; 0: none is valid, 1: the same everywhere */
  elastic_constants *set; /* [n] their temperatures ascend, owned */
  double relaxed[2];      /* parts of G and K that the sets are without: those
                             of elastic_at are whole, - */
} elastic_table;
/* From the data lines of a card: the constants of a set over any number of
 * lines, then its temperature (may be left out if there is one set). Errors go
 * to the log (n = 0 if a set is not whole); ERR_MEMORY. */
status elastic_table_read(const card *c, elastic_type type,
                          const char *material_name, message_log *log,
                          elastic_table *table);
/* elastic_matrix() of the constants at a temperature. */
const char *elastic_at(const elastic_table *t, double temperature, double C[36],
                       char *text, int text_size);
/* The sets of E, nu are what is left after the parts relaxed[2] of G and K have
 * relaxed. */
void elastic_table_relaxed(elastic_table *t, const double relaxed[2]);
/* Largest value of constant number i in any set. */
double elastic_table_most(const elastic_table *t, int i);
void elastic_table_free(elastic_table *t); /* accepts all-zero */

#endif
