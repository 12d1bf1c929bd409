/* The fixed point of Theorem 3.2 of CPR98: rate and constants (theorems.h). */
#include "accuracy/theorems/theorems.h"

#include <math.h>

enum { PASSES = 120 };
static const double STEADY =
    1e-7; /* -, change of the factor from pass to pass */

status theorems_path_rate(const stress_map *map, double *rate) {
  double last = 0.0, first = 0.0;
  int calm = 0;
  *rate = 0.0;
  PASS(map->apply(map->ctx, &first));
  for (int k = 0; k < PASSES && calm < 3 && first > 0.0; ++k) {
    PASS(map->apply(map->ctx, rate));
    if (!(*rate > 0.0)) break;
    calm = fabs(*rate - last) <= STEADY * *rate ? calm + 1 : 0;
    last = *rate;
  }
  return OK;
}

/* log(x^k/k!) */
static double log_term(double x, double k) {
  return k * log(x) - lgamma(k + 1.0);
}

double theorems_passes(double x) {
  double low = floor(x), high = 4.0 + ceil(3.0 * x);
  if (x < 1.0) return 1.0;
  if (!(high < 1e15)) return HUGE_VAL;
  while (high - low > 1.0) { /* the terms grow until k = x, then fall */
    double middle = floor(0.5 * (low + high));
    if (log_term(x, middle) < 0.0)
      high = middle;
    else
      low = middle;
  }
  return high;
}
