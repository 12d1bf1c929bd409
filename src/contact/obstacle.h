/*
 * Rigid obstacles: conforming (gap 0 everywhere), plane, cylinder, sphere, or a
 * gap given as an expression; each may move by an amplitude.
 *
 * The point X of the obstacle is at time t at
 *   x = c + R(a, angle(t)) (X - c) + d(t),
 * R the finite rotation by "angle" about the axis a through the pivot c, d the
 * shift: the axis is carried along by d. Displacements of the body are small:
 * normals and tangents stay those of the body (or of the obstacle) at time 0,
 * the gap is measured along them to the obstacle as it lies at t, and what
 * passes a node tangentially is the surface of the obstacle, velocity
 *   v = d' + angle' a x (y - c - d)
 * at the point y where the normal of the node meets it.
 */
#pragma once

#include "deck/expression.h"

typedef enum {
  OBSTACLE_CONFORMING, /* follows the body: gap 0 */
  OBSTACLE_PLANE,      /* point, outward normal (towards the body) */
  OBSTACLE_CYLINDER,   /* point of the axis, direction (3-D), radius */
  OBSTACLE_SPHERE,     /* centre, radius */
  OBSTACLE_GAP         /* gap along the normal as an expression of x y z t */
} obstacle_shape;
#define OBSTACLE_SHAPES "CONFORMING|PLANE|CYLINDER|SPHERE|GAP"

typedef struct obstacle {
  const char *name;
  int shape;  /* obstacle_shape */
  int inside; /* 1: the body is inside the cylinder or sphere */
  /* m; direction of unit length */
  double point[3], direction[3], radius;
  quantity gap;             /* OBSTACLE_GAP */
  quantity motion[3];       /* d: shift of the obstacle at time t, m */
  int turns;                /* 1: it has a rotation */
  double pivot[3], axis[3]; /* c, m; a of unit length, in 2-D (0, 0, +-1) */
  quantity angle;           /* at time t, rad */
} obstacle;

/*
 * Distance s from x along the unit vector n to the obstacle at time t, negative
 * if x is inside it; HUGE_VAL if the line does not meet it (a plane met from
 * behind or at a grazing angle, a sphere that the line does not meet); NaN if
 * an expression
 * is.  dim 2: a cylinder or sphere is a circle in the plane of the model, also
 * in an axisymmetric one (a sphere about the axis, else a ring).
 *
 * With D the displacement of the point of the obstacle that is at x at time t,
 * CONFORMING gives n.D, GAP the expression at x - D + (n.D) n, plus n.D: exact
 * for a shift and for a rotation about n, of first order in an angle that tilts
 * the obstacle.
 */
double obstacle_gap(const obstacle *o, int dim, const double *x,
                    const double *n, double t);
/* Direction n[dim] from x straight to a plane, cylinder or sphere at time 0
 * (the outward normal of a body that touches it there); 0, and n as it was, for
 * the other shapes, which have no normal of their own, and at a centre. */
int obstacle_normal(const obstacle *o, int dim, const double *x, double *n);
/* Angle of a unit vector to that direction, rad; 0: other shapes, centre. */
double obstacle_lean(const obstacle *o, int dim, const double *x,
                     const double *normal);
/* Shift d[3] of the obstacle at time t, m. */
void obstacle_motion(const obstacle *o, double t, double *d);
/* Its angle at time t, rad; 0 without a rotation. */
double obstacle_angle(const obstacle *o, double t);
/* Angle between the normals of a PLANE at times 0 and t, rad; 0 for other
 * shapes. */
double obstacle_tilt(const obstacle *o, double t);
/*
 * Displacement d[3] of the surface of the obstacle at the point where the line
 * from x along n meets it (x itself if it does not), from time t0 to t, m: v
 * over the interval by the trapezoidal rule in the arm y - c - d, exact if the
 * arm changes linearly with the angle.
 */
void obstacle_drift(const obstacle *o, int dim, const double *x,
                    const double *n, double t0, double t, double *d);
/* 1 if the gap can change with time. */
int obstacle_moves(const obstacle *o);
