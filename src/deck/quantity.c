/*
 * Quantities: number or expression, times a piecewise linear table.
 */
#include "deck/quantity.h"

#include <stddef.h>

double table_value(const value_table *p, const double x[3], double t) {
  if (p->n == 0)
    return p->formula == NULL ? 1.0 : expression_value(p->formula, x, t);
  double s = p->variable == TABLE_T ? t : x[p->variable];
  if (s <= p->at[0]) return p->value[0];
  int last = p->n - 1;
  if (s >= p->at[last]) return p->value[last];
  int low = 0, high = last;
  while (high - low > 1) {
    int middle = (low + high) / 2;
    if (p->at[middle] <= s)
      low = middle;
    else
      high = middle;
  }
  double w = (s - p->at[low]) / (p->at[high] - p->at[low]);
  return (1.0 - w) * p->value[low] + w * p->value[high];
}

double quantity_value(const quantity *q, const double x[3], double t) {
  double v =
      q->formula == NULL ? q->number : expression_value(q->formula, x, t);
  if (q->factor == NULL) return v;
  return v * table_value(q->factor, x, t - q->factor_start);
}

static unsigned table_variables(const value_table *p) {
  if (p->n > 0) return 1u << p->variable;
  return p->formula == NULL ? 0u : expression_variables(p->formula);
}

unsigned quantity_variables(const quantity *q) {
  unsigned v = q->formula == NULL ? 0u : expression_variables(q->formula);
  return q->factor == NULL ? v : v | table_variables(q->factor);
}
