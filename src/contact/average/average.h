/*
 * The nonlocal average of the contact pressure as a sparse matrix.
 *
 *   R(p)(x_i) = sum_j G_ij p_j,   p_j nodal values of a P1 pressure,
 *
 * p being zero outside of the patch (CPR98, 2.7). With l_i the integral of the
 * P1 function phi_i over the patch and g_ij the integral of w(|x_i - y|) phi_j,
 *
 *   l_i G_ij = 1/2 (l_i g_ij + l_j g_ji)  (i != j),
 *   G_ii     = W_i - sum of the others,
 *
 * so that l_i G_ij is symmetric and a constant pressure p gives W_i p exactly.
 * W_i is 1 where the disc of radius rho around x_i lies in the patch, and the
 * part of the kernel's mass found in the patch where it does not. Both g_ij and
 * W_i are integrals of the kernel itself. Where the pairs of a node would
 * exceed its mass they are reduced to it, so that no entry is negative and all
 * change continuously with the radius.
 *
 * Where p_j acts on a part of the faces of node j alone (a slave node at the
 * edge of its master), G_ij is times that part.
 *
 * A node without another node within rho has its own pressure (G_ii = 1): where
 * the mesh is coarser than rho, friction is local.
 */
#pragma once

#include "base/sparse.h"

/*
 * Kernels w = c k(r/rho) for r < rho and 0 beyond. The integral of w over the
 * whole line (plane) is 1. One row per kernel.
 */
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

/* Part of a contact surface; the arrays are the caller's. */
typedef struct average_patch {
  int dim;          /* 2: lines in the plane; 3: triangles */
  int axisymmetric; /* 1: the lines turn around the axis x[0] = 0 */
  int n_node, n_face;
  const double *x;             /* [dim*n_node] m */
  const int *face;             /* [dim*n_face] nodes */
  const unsigned char *active; /* [n_node] 0: no contact node, p = 0 there */
  const double *part;          /* [n_node] of its faces where p_j acts, 0 to 1,
                                  -; NULL: 1 */
} average_patch;

/* A plane x[axis] = least or largest of the patch behind which the surface
 * goes on as its mirror image. */
typedef enum { MIRROR_NONE, MIRROR_MIN, MIRROR_MAX } average_mirror;

typedef struct average_rule {
  kernel kernel;
  double radius;            /* rho, m */
  int normalized;           /* 1: G_ij / W_i: a constant pressure is kept at
                               edges too */
  int geodesic;             /* 1: distance along the lines (plane only), else
                               straight */
  average_mirror mirror[3]; /* by axis; not with geodesic, nor of the radius */
} average_rule;

/* What was found, for messages. */
typedef struct average_facts {
  double longest; /* edge of the patch, m */
  int n_active;   /* nodes that carry pressure */
  int n_coarse;   /* of these, with an edge longer than radius/4 */
  int n_local;    /* of these, without another node within the radius */
} average_facts;

/*
 * G [n_node*n_node], rows and columns of nodes that are not active empty.
 * Time: number of pairs, and n log n for the search. ERR_MEMORY.
 */
status average_build(const average_patch *patch, const average_rule *rule,
                     sparse_rows *out, average_facts *facts);
