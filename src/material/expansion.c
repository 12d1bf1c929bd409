/*
 * Thermal strain from a table of secant coefficients, as Abaqus defines it:
 *   e = alpha(T) (T - zero) - alpha(T0) (T0 - zero)
 * so that the body at its initial temperature T0 has none, whatever "zero".
 */
#include "material/material.h"

/* The tables of deck/quantity.h know the temperature as their variable t. */
static double secant(const value_table *alpha, double T) {
  static const double origin[3];
  return table_value(alpha, origin, T);
}

void expansion_strain(const expansion *x, double T, double T0, double e[3]) {
  for (int c = 0; c < 3; ++c) {
    const value_table *alpha = &x->alpha[x->type == EXPANSION_ORTHO ? c : 0];
    e[c] =
        secant(alpha, T) * (T - x->zero) - secant(alpha, T0) * (T0 - x->zero);
  }
}
