/*
 * Fields of the tip of a crack in a plane: Williams, J. Appl. Mech. 24 (1957).
 * Inside src/fracture.
 */
#ifndef PROTIS_FRACTURE_WILLIAMS_H
#define PROTIS_FRACTURE_WILLIAMS_H

/*
 * Displacement u[3] and its gradient d[i][l] = du_i/dx_l of K = 1 in a mode
 * (0 .. 2), at x1 ahead of the tip and x2 above the crack; on the lips x2 is
 * +0.0 above and -0.0 below.
 *
 *   kappa  3 - 4 nu (plane strain), (3 - nu)/(1 + nu) (plane stress)
 *   G      shear modulus, Pa
 */
void williams_field(int mode, double kappa, double G, const double x[2],
                    double u[3], double d[3][2]);

#endif
