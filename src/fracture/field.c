/*
 * Fields in the frame of a place.
 *
 * Around a front of curvature k the auxiliary displacements are those at a
 * straight one in the frame that turns with it. With kk = k / (1 + k x1), and
 * stresses and strains those of the straight front,
 *
 *   d_13 = -u_3 kk, d_33 = u_1 kk, the others as in the plane,
 *   what the strains lack: u_1 kk in 33, -u_3 kk / 2 in 13,
 *   div s = kk (s_11 - s_33, s_12, 2 s_13).
 */
#include "fracture/parts.h"

#include "base/base.h"

/*
 * u_i = sqrt(r / 2 pi) / (2 G) g_i(theta),  c = cos(theta/2), s = sin(theta/2):
 *   I    g = c (kappa - 1 + 2 s^2),   s (kappa + 1 - 2 c^2),   0
 *   II   g = s (kappa + 1 + 2 c^2),  -c (kappa - 1 - 2 s^2),   0
 *   III  g = 0, 0, 4 s
 * g and its derivative.
 */
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
  const double size = sqrt(r / (2.0 * M_PI)) / (2 * G);
  double g[3], slope[3];
  angular(mode, kappa, theta, g, slope);
  for (int i = 0; i < 3; ++i) {
    u[i] = size * g[i];
    d[i][0] = size / r * (cos(theta) * g[i] / 2 - sin(theta) * slope[i]);
    d[i][1] = size / r * (sin(theta) * g[i] / 2 + cos(theta) * slope[i]);
  }
}

void field_turn(const local *at, double in[3][3], field_tensor *out) {
  double half[3][3];
  for (int i = 0; i < 3; ++i)
    for (int c = 0; c < 3; ++c)
      half[i][c] = at->axis[3 * i] * in[0][c] + at->axis[3 * i + 1] * in[1][c] +
                   at->axis[3 * i + 2] * in[2][c];
  for (int i = 0; i < 3; ++i) field_turn_vector(at, half[i], out->of[i]);
}

void field_turn_vector(const local *at, const double in[3], double out[3]) {
  for (int i = 0; i < 3; ++i)
    out[i] = at->axis[3 * i] * in[0] + at->axis[3 * i + 1] * in[1] +
             at->axis[3 * i + 2] * in[2];
}

double field_product(const field_tensor *a, const field_tensor *b) {
  double sum = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) sum += a->of[i][j] * b->of[i][j];
  return sum;
}

static void set_curved(const double u[3], double k, double g[3][2],
                       auxiliary *out) {
  const field_tensor *s = &out->s;
  out->d.of[0][2] = -u[2] * k;
  out->d.of[2][2] = u[0] * k;
  out->X.of[2][2] = k * (g[0][0] - u[0] * k);
  out->X.of[0][2] = out->X.of[2][0] = -k * (g[2][0] - u[2] * k) / 2;
  out->div[0] = k * (s->of[0][0] - s->of[2][2]);
  out->div[1] = k * s->of[0][1];
  out->div[2] = k * 2 * s->of[0][2];
}

void auxiliary_set(const elasticity *x, const local *at, int mode,
                   auxiliary *out) {
  const double lambda = x->G * (3 - x->kappa) / (x->kappa - 1);
  double u[3], g[3][2];
  williams_field(mode, x->kappa, x->G, at->x, u, g);
  memset(out, 0, sizeof *out);
  for (int i = 0; i < 3; ++i)
    for (int l = 0; l < 2; ++l) {
      out->d.of[i][l] = g[i][l];
      out->e.of[i][l] += g[i][l] / 2;
      out->e.of[l][i] += g[i][l] / 2;
    }
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) out->s.of[i][j] = 2 * x->G * out->e.of[i][j];
    out->s.of[i][i] += lambda * (g[0][0] + g[1][1]);
  }
  set_curved(u, at->turn, g, out);
}

/* a_ij b_il, and -trace on the diagonal. */
static void add_flux(const field_tensor *a, const field_tensor *b,
                     field_tensor *P) {
  for (int l = 0; l < 3; ++l)
    for (int j = 0; j < 3; ++j)
      for (int i = 0; i < 3; ++i) P->of[l][j] += a->of[i][j] * b->of[i][l];
}

static void start_flux(double work, field_tensor *P) {
  memset(P, 0, sizeof *P);
  for (int l = 0; l < 3; ++l) P->of[l][l] = -work;
}

void interaction_flux(const field_tensor *s, const field_tensor *d,
                      const auxiliary *x, field_tensor *P) {
  start_flux(field_product(s, &x->e), P);
  add_flux(s, &x->d, P);
  add_flux(&x->s, d, P);
}

void energy_flux(const field_tensor *s, const field_tensor *d, double share,
                 field_tensor *P) {
  start_flux(field_product(s, d) * share, P);
  add_flux(s, d, P);
}
