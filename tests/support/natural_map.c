/* Measure of an answer (natural_map.h). */
#include "support/natural_map.h"

#include <math.h>

/* Force that brings dof to x, at the node's own stiffness.                  */
static double step_of(const contact_problem *cp, int dof) {
  double mean = 0.0;
  int first = dof / cp->dim * cp->dim;
  if (dof == first) mean = contact_diagonal(cp, dof);
  for (int k = 1; dof > first && k < cp->dim; ++k)
    mean += contact_diagonal(cp, first + k) / (cp->dim - 1);
  return cp->A != NULL ? mean : mean > 0.0 ? 1.0 / mean : 1.0;
}

double natural_map(const contact_problem *cp, double *u, double *r) {
  double worst = 0.0, size = 0.0;
  if (cp->A != NULL)
    contact_reaction(cp, u, r);
  else
    contact_apply(cp, r, u);
  for (int i = 0; cp->A == NULL && i < cp->m; ++i) u[i] += cp->f[i];
  for (int i = 0; i < cp->n; ++i) {
    int first = i * cp->dim;
    double c = step_of(cp, first), z[3], length = 0.0, error = 0.0;
    double load = cp->A != NULL ? -cp->f[first] : cp->f[first] - cp->gap[i];
    size = fmax(size, fmax(fabs(r[first]), cp->A != NULL ? load : c * load));
    z[0] = fmin(0.0, r[first] - c * (u[first] - cp->gap[i]));
    for (int k = 1; k < cp->dim; ++k) {
      z[k] = r[first + k] - step_of(cp, first + k) *
                                (u[first + k] - contact_stick(cp, first + k));
      length = hypot(length, z[k]);
    }
    double g = contact_node_limit(cp, r, i);
    for (int k = 1; k < cp->dim && length > g; ++k) z[k] *= g / length;
    for (int k = 0; k < cp->dim; ++k)
      error = fmax(error, fabs(r[first + k] - z[k]));
    worst = fmax(worst, error);
  }
  return worst > 0.0 ? worst / size : 0.0;
}
