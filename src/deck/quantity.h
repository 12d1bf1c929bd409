/*
 * Values of the deck that may vary: a number or an expression of x y z t,
 * times a piecewise linear table.
 */
#ifndef PROTIS_DECK_QUANTITY_H
#define PROTIS_DECK_QUANTITY_H

#include "deck/expression.h"

enum { TABLE_X, TABLE_Y, TABLE_Z, TABLE_T };

/* Pairs (at, value), linear between, constant outside; or an expression. */
typedef struct value_table {
  int variable;              /* TABLE_X..TABLE_T */
  int n;                     /* pairs */
  double *at, *value;        /* [n] at ascending */
  const expression *formula; /* used if n == 0; NULL: 1 */
} value_table;

/* Value of the table at a point and time. */
double table_value(const value_table *p, const double x[3], double t);

typedef struct quantity {
  double number;
  const expression *formula; /* NULL: the number counts; borrowed */
  const value_table *factor; /* multiplies; NULL: 1; borrowed */
  double factor_start;       /* time at which the factor's time is zero, s */
} quantity;

double quantity_value(const quantity *q, const double x[3], double t);
/* Bits of expression_variables that the quantity depends on. */
unsigned quantity_variables(const quantity *q);

#endif
