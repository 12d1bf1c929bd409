/*
 * Distance from a point to a rigid obstacle along a line.
 *
 *   PLANE             (x + s n - p).N = 0
 *   CYLINDER, SPHERE  |y + s m|^2 = R^2, with y = x - p and m = n, in 3-D for a
 *                     cylinder both without their part along the axis
 */
#include "contact/obstacle.h"

#include <math.h>

/* Sine of the angle between line and plane (or line and axis) below which the
 * line does not meet the obstacle. */
static const double grazing_sine = 1e-6;

enum { TIME_VARIABLE = 8 };

static double dot(int dim, const double *a, const double *b) {
  double s = 0;
  for (int c = 0; c < dim; ++c) s += a[c] * b[c];
  return s;
}

static double plane_gap(const obstacle *o, int dim, const double *y,
                        const double *n) {
  double approach = -dot(dim, n, o->direction);
  return approach < grazing_sine ? HUGE_VAL
                                 : dot(dim, y, o->direction) / approach;
}

/*
 * Root of a s^2 + 2 b s + c = 0 where the line enters (outside) or leaves
 * (inside) the circle, in the form without cancellation. A point on the wrong
 * side of the circle (outside: c < 0) has passed it and gets s < 0.
 */
static double circle_gap(double a, double b, double c, int inside) {
  double discriminant = b * b - a * c;
  if (isnan(discriminant)) return NAN;
  if (a < grazing_sine * grazing_sine || discriminant < 0) return HUGE_VAL;
  double root = sqrt(discriminant);
  if (inside) {
    if (b > 0) return -c / (b + root);
    return c > 0 ? HUGE_VAL : (root - b) / a;
  }
  if (b < 0) return c / (root - b);
  return c < 0 ? -(b + root) / a : HUGE_VAL;
}

static double round_gap(const obstacle *o, int dim, const double *y,
                        const double *n) {
  double across[3] = {0, 0, 0}, m[3] = {0, 0, 0};
  double y_axis = 0, n_axis = 0;
  if (o->shape == OBSTACLE_CYLINDER && dim == 3) {
    y_axis = dot(3, y, o->direction);
    n_axis = dot(3, n, o->direction);
  }
  for (int c = 0; c < dim; ++c) {
    across[c] = y[c] - y_axis * o->direction[c];
    m[c] = n[c] - n_axis * o->direction[c];
  }
  double distance = sqrt(dot(dim, across, across));
  return circle_gap(dot(dim, m, m), dot(dim, across, m),
                    (distance - o->radius) * (distance + o->radius), o->inside);
}

void obstacle_motion(const obstacle *o, double t, double *d) {
  for (int c = 0; c < 3; ++c) d[c] = quantity_value(&o->motion[c], o->point, t);
}

int obstacle_normal(const obstacle *o, int dim, const double *x, double *n) {
  int round = o->shape == OBSTACLE_CYLINDER || o->shape == OBSTACLE_SPHERE;
  double axis = 0, length = 0, d[3], v[3] = {0, 0, 0};
  if (!round && o->shape != OBSTACLE_PLANE) return 0;
  obstacle_motion(o, 0, d);
  for (int c = 0; c < dim; ++c)
    v[c] = round ? x[c] - d[c] - o->point[c] : -o->direction[c];
  if (o->shape == OBSTACLE_CYLINDER && dim == 3) axis = dot(3, v, o->direction);
  for (int c = 0; c < dim; ++c) v[c] -= axis * o->direction[c];
  length = sqrt(dot(dim, v, v));
  if (!(length > 0)) return 0;
  if (round && !o->inside) length = -length;
  for (int c = 0; c < dim; ++c) n[c] = v[c] / length;
  return 1;
}

int obstacle_moves(const obstacle *o) {
  unsigned variables = 0;
  for (int c = 0; c < 3; ++c) variables |= quantity_variables(&o->motion[c]);
  if (o->shape == OBSTACLE_GAP) variables |= quantity_variables(&o->gap);
  return (variables & TIME_VARIABLE) != 0;
}

double obstacle_gap(const obstacle *o, int dim, const double *x,
                    const double *n, double t) {
  double d[3], y[3] = {0, 0, 0}, beside[3] = {0, 0, 0};
  obstacle_motion(o, t, d);
  double along = dot(dim, n, d);
  for (int c = 0; c < dim; ++c) {
    y[c] = x[c] - d[c] - o->point[c];
    beside[c] = x[c] - (d[c] - along * n[c]);
  }
  switch ((obstacle_shape)o->shape) {
    case OBSTACLE_CONFORMING:
      return along;
    case OBSTACLE_PLANE:
      return plane_gap(o, dim, y, n);
    case OBSTACLE_CYLINDER:
    case OBSTACLE_SPHERE:
      return round_gap(o, dim, y, n);
    case OBSTACLE_GAP:
      return quantity_value(&o->gap, beside, t) + along;
  }
  return NAN;
}
