/*
 * u_i = sqrt(r / 2 pi) / (2 G) g_i(theta),  c = cos(theta/2), s = sin(theta/2):
 *   I    g = c (kappa - 1 + 2 s^2),   s (kappa + 1 - 2 c^2),   0
 *   II   g = s (kappa + 1 + 2 c^2),  -c (kappa - 1 - 2 s^2),   0
 *   III  g = 0, 0, 4 s
 */
#include "fracture/williams.h"

#include <math.h>

static const double two_pi = 6.283185307179586476925286766559;

/* g and its derivative. */
static void angular(int mode, double kappa, double theta, double g[3],
                    double slope[3]) {
  const double c = cos(theta / 2), s = sin(theta / 2);
  for (int i = 0; i < 3; ++i) g[i] = slope[i] = 0;
  switch (mode) {
    case 0:
      g[0] = c * (kappa - 1 + 2 * s * s);
      g[1] = s * (kappa + 1 - 2 * c * c);
      slope[0] = -s * (kappa - 1 + 2 * s * s) / 2 + 2 * s * c * c;
      slope[1] = c * (kappa + 1 - 2 * c * c) / 2 + 2 * s * s * c;
      return;
    case 1:
      g[0] = s * (kappa + 1 + 2 * c * c);
      g[1] = -c * (kappa - 1 - 2 * s * s);
      slope[0] = c * (kappa + 1 + 2 * c * c) / 2 - 2 * s * s * c;
      slope[1] = s * (kappa - 1 - 2 * s * s) / 2 + 2 * s * c * c;
      return;
    default:
      g[2] = 4 * s;
      slope[2] = 2 * c;
  }
}

void williams_field(int mode, double kappa, double G, const double x[2],
                    double u[3], double d[3][2]) {
  const double r = hypot(x[0], x[1]), theta = atan2(x[1], x[0]);
  const double size = sqrt(r / two_pi) / (2 * G);
  double g[3], slope[3];
  angular(mode, kappa, theta, g, slope);
  for (int i = 0; i < 3; ++i) {
    u[i] = size * g[i];
    d[i][0] = size / r * (cos(theta) * g[i] / 2 - sin(theta) * slope[i]);
    d[i][1] = size / r * (sin(theta) * g[i] / 2 + cos(theta) * slope[i]);
  }
}
