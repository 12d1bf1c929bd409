/*
 * Kernels of the nonlocal average: R(p)(x) = integral of w(|x - y|) p(y) over
 * the contact surface, w = c k(r/rho) for r < rho and 0 beyond (CPR98, 2.7).
 * The integral of w over the whole line (plane) is 1. One row per kernel.
 */
#ifndef PROTIS_AVERAGE_KERNEL_H
#define PROTIS_AVERAGE_KERNEL_H

/* clang-format off */
#define KERNEL_LIST(X)                                                       \
  X(BUMP,     bump,     "exp(rho^2/(r^2 - rho^2)), smooth of any order")     \
  X(CONE,     cone,     "1 - r/rho")                                         \
  X(PARABOLA, parabola, "1 - r^2/rho^2")                                     \
  X(WENDLAND, wendland, "(1 - r/rho)^4 (1 + 4 r/rho), twice differentiable") \
  X(CONSTANT, constant, "1: the mean over the disc of radius rho")
/* clang-format on */

#define KERNEL_ENUM(name, function, help) KERNEL_##name,
typedef enum { KERNEL_LIST(KERNEL_ENUM) KERNEL_COUNT } kernel;
#define KERNEL_WORD(name, function, help) "|" #name
/* The names joined by |, for an option. */
#define KERNEL_WORDS (("" KERNEL_LIST(KERNEL_WORD)) + 1)
#define KERNEL_TEXT(name, function, help) "; " #name " " help
/* "; NAME formula" of each, for its help. */
#define KERNEL_HELP KERNEL_LIST(KERNEL_TEXT)

typedef struct mollifier {
  double (*profile)(double s2); /* k as a function of (r/rho)^2 < 1 */
  double radius;                /* rho, m */
  double scale;                 /* c, 1/m (line) or 1/m2 (surface) */
} mollifier;

/* k of radius rho > 0, normalised over the line (dim 1) or plane (dim 2). */
mollifier mollifier_make(kernel k, double radius, int dim);
/* w at the squared distance r2, 1/m^dim. */
double mollifier_value(const mollifier *m, double r2);

/* Integrals of the kernel around a point against the P1 functions of a face. */

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
