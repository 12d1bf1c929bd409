/*
 * Integrals of the kernel around a point against the P1 functions of a face.
 * Inside src/contact/average only.
 */
#ifndef PROTIS_AVERAGE_FACE_H
#define PROTIS_AVERAGE_FACE_H

#include "contact/average/kernel.h"

/*
 * weight[k] = integral over the face of w(|x - y|) phi_k(y), - , over the part
 * nearer than reach <= radius. The line a, b is one of a plane body, or, for
 * face_ring, turned once around the axis r = 0 (then x and y stand for circles:
 * the integral over y's circle seen from one point of x's).
 */
void face_line(const mollifier *m, double reach, const double *corner,
               const double *x, double weight[2]);
void face_ring(const mollifier *m, double reach, const double *corner,
               const double *x, double weight[2]);
/* Corners [9], x[3]. */
void face_triangle(const mollifier *m, const double *corner, const double *x,
                   double weight[3]);
/* Distance of x[dim] from the segment a, b, and from a face, m. */
double face_segment_distance(int dim, const double *a, const double *b,
                             const double *x);
double face_distance(int dim, const double *corner, const double *x);

#endif
