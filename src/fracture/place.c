/* Coordinates that follow the front, and quadrature on lips that end at it. */
#include "fracture/parts.h"

#include <math.h>
#include <string.h>

void place_of(const mesh *m, int node, double x[3]) {
  x[2] = 0;
  memcpy(x, m->x + (size_t)m->dim * (size_t)node, (size_t)m->dim * sizeof *x);
}

/* The front is a circle of curvature k through the point, its centre behind it
 * for k > 0: with (y1, y3) in its plane, k times the vector from the centre is
 * (a, b) = (1 + k y1, k y3), and rho - 1/k is free of 1/k. */
void locate(const fracture_point *p, const double x[3], local *at) {
  const double *e1 = p->frame, *e3 = p->frame + 6, k = p->curvature;
  double y[3] = {0, 0, 0};
  for (int i = 0; i < 3; ++i)
    for (int c = 0; c < 3; ++c)
      y[i] += p->frame[3 * i + c] * (x[c] - p->origin[c]);
  const double a = 1 + k * y[0], b = k * y[2], h = hypot(a, b);
  at->x[0] = (2 * y[0] + k * (y[0] * y[0] + y[2] * y[2])) / (h + 1);
  at->x[1] = y[1];
  at->s = fabs(b) > 0 ? y[2] * (atan2(b, a) / b) : y[2];
  at->turn = k / h;
  memcpy(at->axis, p->frame, sizeof at->axis);
  for (int c = 0; c < 3; ++c) {
    at->axis[c] = (a * e1[c] + b * e3[c]) / h;
    at->axis[6 + c] = (a * e3[c] - b * e1[c]) / h;
  }
}

/* Gauss, on [0, 1]. */
enum { GAUSS = 4 };
static const double gauss_at[GAUSS] = {0.06943184420297371, 0.33000947820757187,
                                       0.6699905217924281, 0.9305681557970263};
static const double gauss_part[GAUSS] = {
    0.17392742256872692, 0.32607257743127307, 0.32607257743127307,
    0.17392742256872692};

/* Corners by their distance from the front. */
static void order_corners(int n, const double *behind, int *at) {
  for (int i = 0; i <= n; ++i) {
    int k = i;
    for (; k > 0 && behind[at[k - 1]] > behind[i]; --k) at[k] = at[k - 1];
    at[k] = i;
  }
}

/* From the nearest corner, xi = sigma^2 towards the opposite edge and eta =
 * tau^2 along it, away from its nearer end: the distance is xi (or xi eta)
 * where one corner (two) are at the front. */
int lip_rule(int n, const double *behind, rule_point *to) {
  int at[3], count = 0;
  order_corners(n, behind, at);
  for (int i = 0; i < GAUSS; ++i)
    for (int k = 0; k < (n == 2 ? GAUSS : 1); ++k) {
      const double sigma = gauss_at[i], tau = n == 2 ? gauss_at[k] : 0;
      const double xi = sigma * sigma, eta = tau * tau;
      rule_point *p = &to[count++];
      memset(p->phi, 0, sizeof p->phi);
      p->part = gauss_part[i] * 2 * sigma;
      if (n == 2) p->part *= gauss_part[k] * 2 * tau * 2 * xi;
      p->phi[at[0]] = 1 - xi;
      p->phi[at[1]] = xi * (1 - eta);
      if (n == 2) p->phi[at[2]] = xi * eta;
    }
  return count;
}

double fracture_corner(int dim) {
  return dim == 2 ? 2.0 / 3.0 : 0.58541019662496845446;
}
