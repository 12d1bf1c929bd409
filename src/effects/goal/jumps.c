/*
 * Loads of sides that meet. The tractions t, t' of two sides with the normals
 * n, n' belong to one stress where t.n' = t'.n, on a smooth side where t = t'.
 * Elsewhere the stress is another from each direction, or infinite as the
 * logarithm of the distance, and recovered gradients miss it: where a load
 * ends, where a shear ends in a corner.
 */
#include "base/base.h"
#include "effects/goal/parts.h"

/* Beyond rounding. */
static const double SAME = 1e-6; /* -, of the tractions */

/* Its traction along m[dim], on a side with the normal n[dim]. */
static double along(int dim, const side_load *p, const double *n,
                    const double *m) {
  return dot(dim, p->traction, m) - p->pressure * dot(dim, n, m);
}

int goal_is_torn(int dim, const side_load *p, const double *n,
                 const side_load *q, const double *m, int smooth) {
  double jump = 0.0, size = hypot(p->pressure, q->pressure);
  for (int c = 0; c < dim; ++c) {
    size = hypot(size, hypot(p->traction[c], q->traction[c]));
    jump = hypot(jump, p->traction[c] - q->traction[c]);
  }
  jump = smooth ? hypot(jump, p->pressure - q->pressure)
                : fabs(along(dim, p, n, m) - along(dim, q, m, n));
  return jump > SAME * size;
}
