/*
 * Expressions of x, y, z and t, compiled once to reverse Polish notation.
 *
 * Operators + - * / ^ (right associative), unary -, comparisons < <= > >= ==
 * != and & | (1 or 0), parentheses, "a ? b : c" spelled if(a, b, c); functions
 * sin cos tan asin acos atan atan2 sinh cosh tanh exp log log10 sqrt abs sign
 * min max floor ceil mod step; constant pi. Numbers as in number.h. Names are
 * not case sensitive. An unknown name is an error, never zero.
 */
#pragma once

#include "base/status.h"

typedef struct expression expression;

/* Names other than x y z t and pi; return 1 and the value if known. */
typedef int symbol_value_fn(const void *ctx, const char *name, double *value);

/* ERR_DECK if the text is no expression: *column (from 0) is where, and the
 * status record says what is wrong there. ERR_MEMORY. */
status expression_compile(const char *text, symbol_value_fn *symbol,
                          const void *ctx, expression **out, int *column);
/* The same with other names, upper case, in place of X, Y, Z and T; a variable
 * may have several, joined by |, or none, "". */
status expression_compile_in(const char *text, const char *const names[4],
                             symbol_value_fn *symbol, const void *ctx,
                             expression **out, int *column);
/* x[3] coordinates, length; t time. The result can be NaN or infinite (log of a
 * negative number): the caller checks it. */
double expression_value(const expression *e, const double x[3], double t);
/* Bits 1 x, 2 y, 4 z, 8 t: the variables that occur. */
unsigned expression_variables(const expression *e);

/*
 * Values of the deck that may vary: a number or an expression of x y z t, times
 * a piecewise linear table.
 */
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
