/*
 * Sizes for a new mesh from the errors of the elements of an old one. An
 * element made smaller by the factor r has r^(-dim) parts with the error
 * eta r together (P1: order 1 in the energy norm). The fewest elements with
 * sum (eta r)^2 = target^2 have
 *
 *   r = c eta^(-2/(2+dim)),   c^2 = target^2 / sum eta^(2 dim/(2+dim))
 *
 * (Zienkiewicz, Zhu 1992; the optimum of a sum under one condition). A pass
 * changes no length by more than a factor of four (ten, if the error is within
 * a factor of eight of the target: the mesh that reaches it), and sizes grow
 * slowly from node to node, so that gmsh can follow them.
 */
#include "accuracy/space.h"

#include "base/memory.h"

#include <math.h>

static const double FINEST = 0.25, COARSEST = 2.0; /* -, in one pass */
/* Near the target the errors determine all sizes of the last mesh. */
static const double REACH = 8.0, FINEST_LAST = 0.1; /* - */
static const double GROWTH = 0.4; /* -, change of the size over a distance */
enum { SWEEPS = 20 };

/* Length of the edge of a regular element of the same measure. */
static double element_length(const mesh *m, int elem_id) {
  double measure = mesh_elem_measure(m, elem_id);
  return m->dim == 2 ? sqrt(measure * 4.0 / sqrt(3.0))
                     : cbrt(measure * 6.0 * sqrt(2.0));
}

/* c of the head of this file. */
static double common_factor(const mesh *m, const double *eta, double target) {
  double sum = 0.0, power = 2.0 * m->dim / (2.0 + m->dim);
  for (int e = 0; e < m->n_elem; ++e) sum += pow(eta[e], power);
  return sum > 0.0 ? target / sqrt(sum) : HUGE_VAL;
}

static double finest(const mesh *m, const double *eta, double target) {
  double sum = 0.0;
  for (int e = 0; e < m->n_elem; ++e) sum += eta[e] * eta[e];
  return sqrt(sum) <= REACH * target ? FINEST_LAST : FINEST;
}

/* The smallest size required by the elements round a node. */
static void sizes_at_nodes(const mesh *m, const double *eta, double target,
                           double *size) {
  double c = common_factor(m, eta, target), least = finest(m, eta, target);
  for (int i = 0; i < m->n_node; ++i) size[i] = HUGE_VAL;
  for (int e = 0; e < m->n_elem; ++e) {
    double r = eta[e] > 0.0 ? c * pow(eta[e], -2.0 / (2.0 + m->dim)) : COARSEST;
    double h = element_length(m, e) * fmin(fmax(r, least), COARSEST);
    for (int a = 0; a <= m->dim; ++a) {
      double *at = &size[m->elem[(m->dim + 1) * e + a]];
      *at = fmin(*at, h);
    }
  }
}

static double distance(const mesh *m, int a, int b) {
  double sum = 0.0;
  for (int c = 0; c < m->dim; ++c) {
    double d = m->x[m->dim * a + c] - m->x[m->dim * b + c];
    sum += d * d;
  }
  return sqrt(sum);
}

/* One sweep over the edges; 1 if a size changed. */
static int limit_growth(const mesh *m, double *size) {
  int changed = 0;
  for (int e = 0; e < m->n_elem; ++e)
    for (int a = 0; a <= m->dim; ++a)
      for (int b = 0; b <= m->dim; ++b) {
        int i = m->elem[(m->dim + 1) * e + a];
        int j = m->elem[(m->dim + 1) * e + b];
        double most = size[j] + GROWTH * distance(m, i, j);
        if (!(size[i] > most)) continue;
        size[i] = most;
        changed = 1;
      }
  return changed;
}

void space_sizes(const mesh *m, const double *eta, double target,
                 double *size) {
  sizes_at_nodes(m, eta, target, size);
  for (int k = 0; k < SWEEPS && limit_growth(m, size); ++k) continue;
}
