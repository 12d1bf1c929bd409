/*
 * The table of kernels and their normalisation.
 */
#include "contact/average/kernel.h"

#include "contact/average/gauss.h"

#include <math.h>

enum { PANELS = 64 }; /* of [0, 1] for the normalisation: exact to rounding */

static double bump(double s2) { return exp(1.0 / (s2 - 1.0)); }

static double cone(double s2) { return 1.0 - sqrt(s2); }

static double parabola(double s2) { return 1.0 - s2; }

static double wendland(double s2) {
  double s = sqrt(s2), a = 1.0 - s;
  return a * a * a * a * (1.0 + 4.0 * s);
}

static double constant(double s2) {
  (void)s2;
  return 1.0;
}

#define KERNEL_PROFILE(name, function, help) function,
static double (*const profiles[])(double) = {KERNEL_LIST(KERNEL_PROFILE)};

/* Integral of k(s) over [-1, 1], or of k(|s|) over the unit disc. */
static double unit_mass(double (*profile)(double), int dim) {
  double sum = 0.0;
  for (int p = 0; p < PANELS; ++p)
    for (int g = 0; g < GAUSS_FINE; ++g) {
      double s = (p + gauss_fine[g].at) / PANELS;
      sum += gauss_fine[g].weight / PANELS * profile(s * s) *
             (dim == 1 ? 2.0 : 2.0 * acos(-1.0) * s);
    }
  return sum;
}

mollifier mollifier_make(kernel k, double radius, int dim) {
  double unit = dim == 1 ? radius : radius * radius;
  return (mollifier){.profile = profiles[k],
                     .radius = radius,
                     .scale = 1.0 / (unit * unit_mass(profiles[k], dim))};
}

double mollifier_value(const mollifier *m, double r2) {
  double s2 = r2 / (m->radius * m->radius);
  return s2 < 1.0 ? m->scale * m->profile(s2) : 0.0;
}
