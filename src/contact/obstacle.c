/*
 * Distance from a point to a rigid obstacle along a line, after point and line
 * are turned and shifted back to where the obstacle started.
 *
 *   PLANE             (x + s n - p).N = 0
 *   CYLINDER, SPHERE  |y + s m|^2 = R^2, with y = x - p and m = n, in 3-D for a
 *                     cylinder both without their part along the axis
 */
#include "contact/obstacle.h"

#include "base/base.h"

/* Sine of the angle between line and plane (or line and axis) below which the
 * line does not meet the obstacle. */
static const double grazing_sine = 1e-6;

enum { TIME_VARIABLE = 8 };

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

/* |y|^2 - R^2, whose digits of a large circle that an axis meets near y are
 * kept: its largest component and R are taken off each other first. */
static double power_of(int dim, const double *y, double radius) {
  double rest = 0;
  int most = 0;
  for (int c = 1; c < dim; ++c)
    if (fabs(y[c]) > fabs(y[most])) most = c;
  for (int c = 0; c < dim; ++c)
    if (c != most) rest += y[c] * y[c];
  return (fabs(y[most]) - radius) * (fabs(y[most]) + radius) + rest;
}

/* a - b less what is rounded of it (Knuth 1997, 4.2.2). */
static double lost_of(double a, double b) {
  const double s = a - b, back = s - a;
  return (a - (s - back)) - (b + back);
}

/* lost[3]: what y was rounded by. */
static double round_gap(const obstacle *o, int dim, const double *y,
                        const double *lost, const double *n) {
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
  return circle_gap(
      dot(dim, m, m), dot(dim, across, m),
      power_of(dim, across, o->radius) + 2.0 * dot(dim, across, lost),
      o->inside);
}

void obstacle_motion(const obstacle *o, double t, double *d) {
  for (int c = 0; c < 3; ++c) d[c] = quantity_value(&o->motion[c], o->point, t);
}

double obstacle_angle(const obstacle *o, double t) {
  return o->turns ? quantity_value(&o->angle, o->point, t) : 0;
}

/* v = R(a, angle) v (Rodrigues). */
static void turn(const double *a, double angle, double *v) {
  double across[3], sine = sin(angle), half = sin(angle / 2);
  double along = dot(3, a, v) * 2 * half * half;
  cross(a, v, across);
  for (int c = 0; c < 3; ++c)
    v[c] = cos(angle) * v[c] + sine * across[c] + along * a[c];
}

double obstacle_tilt(const obstacle *o, double t) {
  double n[3] = {o->direction[0], o->direction[1], o->direction[2]}, c[3];
  if (o->shape != OBSTACLE_PLANE || !o->turns) return 0;
  turn(o->axis, obstacle_angle(o, t) - obstacle_angle(o, 0), n);
  cross(n, o->direction, c);
  return atan2(sqrt(dot(3, c, c)), dot(3, n, o->direction));
}

/* Displacement D[3] at time t of the point of the obstacle that is then at x,
 * and n[3] turned back with it to where it started. */
static void turn_back(const obstacle *o, const double *x, double t, double *D,
                      double *n) {
  double angle = obstacle_angle(o, t), arm[3], start[3];
  for (int c = 0; c < 3; ++c) arm[c] = start[c] = x[c] - D[c] - o->pivot[c];
  turn(o->axis, -angle, start);
  turn(o->axis, -angle, n);
  for (int c = 0; c < 3; ++c) D[c] += arm[c] - start[c];
}

/* Direction v[3] from y = x - point to a shape where it started; its length. */
static double direction_to_shape(const obstacle *o, int dim, const double *y,
                                 double *v) {
  int round = o->shape != OBSTACLE_PLANE;
  double axis = 0, sign = round && !o->inside ? -1 : 1;
  for (int c = 0; c < dim; ++c) v[c] = round ? y[c] : -o->direction[c];
  if (o->shape == OBSTACLE_CYLINDER && dim == 3) axis = dot(3, v, o->direction);
  for (int c = 0; c < dim; ++c) v[c] = sign * (v[c] - axis * o->direction[c]);
  return sqrt(dot(dim, v, v));
}

int obstacle_normal(const obstacle *o, int dim, const double *x, double *n) {
  double d[3], y[3] = {0, 0, 0}, v[3] = {0, 0, 0}, unused[3] = {0, 0, 0};
  if (o->shape == OBSTACLE_CONFORMING || o->shape == OBSTACLE_GAP) return 0;
  for (int c = 0; c < dim; ++c) y[c] = x[c];
  obstacle_motion(o, 0, d);
  if (o->turns) turn_back(o, y, 0, d, unused);
  for (int c = 0; c < dim; ++c) y[c] = x[c] - d[c] - o->point[c];
  double length = direction_to_shape(o, dim, y, v);
  if (!(length > 0)) return 0;
  if (o->turns) turn(o->axis, obstacle_angle(o, 0), v);
  for (int c = 0; c < dim; ++c) n[c] = v[c] / length;
  return 1;
}

double obstacle_lean(const obstacle *o, int dim, const double *x,
                     const double *normal) {
  double n[3];
  if (!obstacle_normal(o, dim, x, n)) return 0;
  return acos(fmax(-1, fmin(1, dot(dim, n, normal))));
}

int obstacle_moves(const obstacle *o) {
  unsigned variables = 0;
  for (int c = 0; c < 3; ++c) variables |= quantity_variables(&o->motion[c]);
  if (o->turns) variables |= quantity_variables(&o->angle);
  if (o->shape == OBSTACLE_GAP) variables |= quantity_variables(&o->gap);
  return (variables & TIME_VARIABLE) != 0;
}

double obstacle_gap(const obstacle *o, int dim, const double *x,
                    const double *n, double t) {
  double d[3], y[3], lost[3], point[3] = {0, 0, 0};
  double at[3] = {0, 0, 0}, m[3] = {0, 0, 0};
  for (int c = 0; c < dim; ++c) at[c] = x[c], m[c] = n[c];
  obstacle_motion(o, t, d);
  if (o->turns) turn_back(o, at, t, d, m);
  double along = dot(dim, n, d);
  for (int c = 0; c < 3; ++c) {
    y[c] = at[c] - d[c] - o->point[c];
    lost[c] = lost_of(at[c] - d[c], o->point[c]);
  }
  for (int c = 0; c < dim; ++c) point[c] = x[c] - (d[c] - along * n[c]);
  if (o->shape == OBSTACLE_CONFORMING) return along;
  if (o->shape == OBSTACLE_PLANE) return plane_gap(o, dim, y, m);
  return o->shape == OBSTACLE_GAP ? quantity_value(&o->gap, point, t) + along
                                  : round_gap(o, dim, y, lost, m);
}

/* arm[3] from the axis to the point where x meets the obstacle at time t. */
static void find_arm(const obstacle *o, int dim, const double *x,
                     const double *n, double t, double *arm) {
  double d[3], gap = obstacle_gap(o, dim, x, n, t);
  if (!isfinite(gap)) gap = 0;
  obstacle_motion(o, t, d);
  for (int c = 0; c < 3; ++c) arm[c] = -d[c] - o->pivot[c];
  for (int c = 0; c < dim; ++c) arm[c] += x[c] + gap * n[c];
}

void obstacle_drift(const obstacle *o, int dim, const double *x,
                    const double *n, double t0, double t, double *d) {
  double start[3], arm[3], end[3], advance[3];
  obstacle_motion(o, t0, start);
  obstacle_motion(o, t, d);
  for (int c = 0; c < 3; ++c) d[c] -= start[c];
  double angle = obstacle_angle(o, t) - obstacle_angle(o, t0);
  if (angle == 0) return;
  find_arm(o, dim, x, n, t0, arm);
  find_arm(o, dim, x, n, t, end);
  for (int c = 0; c < 3; ++c) arm[c] = 0.5 * (arm[c] + end[c]);
  cross(o->axis, arm, advance);
  for (int c = 0; c < 3; ++c) d[c] += angle * advance[c];
}
