#include "support/crack_fields.h"

#include "base/base.h"

#include <complex.h>

typedef double complex number;

/* ---- a tip -----------------------------------------------------------------
 */

/* Muskhelishvili: 2 G (u1 + i u2) = kappa phi(z) - phi(conj z)
 * - (z - conj z) conj phi'(z), phi = (K_I - i K_II) sqrt(z / 2 pi). */
void tip_displacement(const void *field, const double *y, int side, double *u) {
  const tip_field *f = field;
  const int up = f->dim - 1;
  const double ahead = y[0] - f->tip[0];
  double above = y[up] - f->tip[1];
  if (fabs(above) < 1e-9) above = copysign(0.0, side);
  const number z = CMPLX(ahead, above), A = CMPLX(f->K[0], -f->K[1]);
  number w = 0;
  if (cabs(z) > 1e-9) {
    const number root = csqrt(z / (2 * M_PI));
    const number slope = A / (2 * csqrt(2 * M_PI * z));
    w = f->kappa * A * root - A * conj(root) - (z - conj(z)) * conj(slope);
    if (f->dim == 3) u[1] = -2 * f->K[2] / f->G * cimag(root);
  }
  /* e_22 of a stress 22 alone that acts in plane strain, e_11 with it. */
  const double nu = (3 - f->kappa) / 4;
  u[0] = creal(w) / (2 * f->G) - nu * f->stress[0] / (2 * f->G) * ahead +
         f->stress[1] / f->G * above;
  u[up] = cimag(w) / (2 * f->G) + (1 - nu) * f->stress[0] / (2 * f->G) * above;
}

void tip_traction(const void *field, const double *y, int side, double *t) {
  const tip_field *f = field;
  t[0] = f->stress[1];
  t[f->dim - 1] = f->stress[0];
}

/* ---- a disc ----------------------------------------------------------------
 */

/*
 * Harmonic functions of rho and zeta = z + i, R = sqrt(rho^2 + zeta^2), each
 * the derivative along z of the next, and their derivatives along rho: 1/R, L =
 * ln(R + zeta), zeta L - R, (zeta^2/2 - rho^2/4) L - 3/4 zeta R, (zeta^3/6 -
 * rho^2 zeta/4) L + (rho^2/9 - 11/36 zeta^2) R
 */
typedef struct family {
  number at[5], slope[5];
} family;

static family functions(double rho, double z) {
  family f;
  number zeta = CMPLX(z, 1), R = csqrt(rho * rho + zeta * zeta);
  if (creal(R) < 0 || (creal(R) == 0 && cimag(R) < 0)) R = -R;
  const number L = clog(R + zeta), q = zeta * zeta / 2 - rho * rho / 4;
  const number c = zeta * zeta * zeta / 6 - rho * rho * zeta / 4;
  const number e = rho * rho / 9 - 11 * zeta * zeta / 36;
  f.at[0] = 1 / R;
  f.slope[0] = -rho / (R * R * R);
  f.at[1] = L;
  f.slope[1] = rho / (R * (R + zeta));
  f.at[2] = zeta * L - R;
  f.slope[2] = -rho / (R + zeta);
  f.at[3] = q * L - 0.75 * zeta * R;
  f.slope[3] = -rho / 2 * L + q * f.slope[1] - 0.75 * zeta * rho / R;
  f.at[4] = c * L + e * R;
  f.slope[4] =
      -rho * zeta / 2 * L + c * f.slope[1] + 2 * rho / 9 * R + e * rho / R;
  return f;
}

/* A potential psi with what is needed of it: along z once and twice, along rho,
 * and along both. */
typedef struct potential {
  double z, zz, r, rz;
} potential;

/* On z = 0: psi_z = -sqrt(1 - rho^2) inside, 0 outside. */
static potential opened(const family *f) {
  return (potential){cimag(f->at[2]) - creal(f->at[1]),
                     cimag(f->at[1]) - creal(f->at[0]),
                     cimag(f->slope[3]) - creal(f->slope[2]),
                     cimag(f->slope[2]) - creal(f->slope[1])};
}

/* On z = 0: psi = -(1 - rho^2)^(3/2) / 3 inside, 0 outside. */
static potential sheared(const family *f) {
#define SHEARED(part, k) \
  (3 * cimag(f->part[k]) - 3 * creal(f->part[k - 1]) - cimag(f->part[k - 2]))
  return (potential){SHEARED(at, 3), SHEARED(at, 2), SHEARED(slope, 4),
                     SHEARED(slope, 3)};
}

/* On z = 0: psi_z = 0 inside, -acos(1 / rho) outside. */
static potential outside(const family *f) {
  return (potential){cimag(f->at[1]) - M_PI / 2, cimag(f->at[0]),
                     cimag(f->slope[2]), cimag(f->slope[1])};
}

/* Axes along the radius and around. */
static void axes(const double *y, double *rho, double e[2]) {
  *rho = hypot(y[0], y[1]);
  e[0] = *rho > 0 ? y[0] / *rho : 1;
  e[1] = *rho > 0 ? y[1] / *rho : 0;
}

/* Opened: no shear stress on z = 0; sheared: no normal stress there. */
void disc_displacement(const void *field, const double *y, int side,
                       double *u) {
  const disc_field *d = field;
  double rho, e[2], radial = 0, around = 0, z = fabs(y[2]);
  axes(y, &rho, e);
  if (fabs(rho - 1) < 1e-7 && z < 1e-9) rho = 1 - 1e-9; /* 1/R */
  const family f = functions(rho, z);
  if (d->mode == 0 || d->mode == 3) {
    const potential p = d->mode == 0 ? opened(&f) : outside(&f);
    radial = ((1 - 2 * d->nu) * p.r + z * p.rz) / (2 * d->G);
    u[2] = side * (-2 * (1 - d->nu) * p.z + z * p.zz) / (2 * d->G);
  } else {
    const potential p = sheared(&f);
    if (d->mode == 1) {
      radial = side * (2 * (1 - d->nu) * p.r + z * p.rz) / (2 * d->G);
      u[2] = (-(1 - 2 * d->nu) * p.z + z * p.zz) / (2 * d->G);
    } else {
      around = -side * p.r / d->G;
    }
  }
  u[0] = radial * e[0] - around * e[1];
  u[1] = radial * e[1] + around * e[0];
}

void disc_traction(const void *field, const double *y, int side, double *t) {
  const disc_field *d = field;
  double rho, e[2];
  axes(y, &rho, e);
  if (rho > 1 - 1e-9) return;
  const family f = functions(rho, 0);
  const potential p = sheared(&f);
  if (d->mode == 0) t[2] = -M_PI / 2;
  if (d->mode == 1) t[0] = p.rz * e[0], t[1] = p.rz * e[1];
  if (d->mode == 2) t[0] = p.rz * e[1], t[1] = -p.rz * e[0];
}

answer ask(const crack_scene *s) {
  answer a;
  a.at = scene_factors(s, &a.n, &a.point);
  return a;
}

void drop(answer *a) {
  free(a->at);
  free(a->point);
}
