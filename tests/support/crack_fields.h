/*
 * Displacements round cracks in closed form, in complex functions; the crack is
 * in the plane where the last coordinate is 0 (2-D: y, 3-D: z).
 */
#pragma once

#include "support/crack_scene.h"

/* The tip or straight front at x = tip[0], at the height tip[1]; 3-D: the front
 * runs along y. */
typedef struct tip_field {
  int dim;
  double K[3], kappa, G, tip[2];
  double stress[2]; /* constant normal and shear stress on the crack plane, of
                       which the displacement is linear (plane strain or 3-D:
                       kappa = 3 - 4 nu) */
} tip_field;
void tip_displacement(const void *field, const double *y, int side, double *u);
void tip_traction(const void *field, const double *y, int side, double *t);

/*
 * A penny-shaped crack of radius 1, the lips loaded so that
 *   mode 0: pressure pi/2, K_I = sqrt(pi)
 *   mode 1: shear along the radius, linear in it, K_II = sqrt(pi)
 *   mode 2: shear around the axis, linear in the radius, K_III = sqrt(pi)
 * all round the front; and, without tractions, the plane of z = 0 cracked
 * outside the radius 1:
 *   mode 3: pulled apart, K_I = sqrt(pi)
 */
typedef struct disc_field {
  int mode;
  double nu, G;
} disc_field;
void disc_displacement(const void *field, const double *y, int side, double *u);
void disc_traction(const void *field, const double *y, int side, double *t);

/* Results at the points of one scene. */
typedef struct answer {
  int n;
  fracture_point *point;
  fracture_factors *at;
} answer;
answer ask(const crack_scene *s);
void drop(answer *a);
