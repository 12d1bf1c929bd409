/*
 * Rigid obstacles: conforming (gap 0 everywhere), plane, cylinder, sphere, or a
 * gap given as an expression; each may move by an amplitude.
 */
#ifndef PROTIS_CONTACT_OBSTACLE_H
#define PROTIS_CONTACT_OBSTACLE_H

#include "deck/quantity.h"

typedef enum {
  OBSTACLE_CONFORMING, /* follows the body: gap 0                             */
  OBSTACLE_PLANE,      /* point, outward normal (towards the body)            */
  OBSTACLE_CYLINDER,   /* point of the axis, direction (3-D), radius          */
  OBSTACLE_SPHERE,     /* centre, radius                                      */
  OBSTACLE_GAP         /* gap along the normal as an expression of x y z t    */
} obstacle_shape;
#define OBSTACLE_SHAPES "CONFORMING|PLANE|CYLINDER|SPHERE|GAP"

typedef struct obstacle {
  const char *name;
  int shape;  /* obstacle_shape                                      */
  int inside; /* 1: the body is inside the cylinder or sphere        */
  double point[3], direction[3], radius; /* m; direction of unit length       */
  quantity gap;       /* OBSTACLE_GAP                                        */
  quantity motion[3]; /* displacement of the obstacle at time t, m           */
} obstacle;

/*
 * Distance s from x along the unit vector n to the obstacle at time t, negative
 * if x is inside it; HUGE_VAL if the line does not meet it (a plane met from
 * behind or at a grazing angle, a sphere that is missed); NaN if an expression
 * is.  dim 2: a cylinder or sphere is a circle in the plane of the model, also
 * in an axisymmetric one (a sphere about the axis, else a ring).
 *
 * An obstacle only shifts, by d(t): CONFORMING gives n.d, GAP the expression
 * at the point that d has brought beside x, x - d + (n.d) n, plus n.d.
 */
double obstacle_gap(const obstacle *o, int dim, const double *x,
                    const double *n, double t);
/* Direction n[dim] from x straight to a plane, cylinder or sphere at time 0
 * (the outward normal of a body that touches it there); 0, and n as it was, for
 * the other shapes, which have no normal of their own, and at a centre. */
int obstacle_normal(const obstacle *o, int dim, const double *x, double *n);
/* Shift d[3] of the obstacle at time t, m. */
void obstacle_motion(const obstacle *o, double t, double *d);
/* 1 if the gap can change with time. */
int obstacle_moves(const obstacle *o);

#endif
