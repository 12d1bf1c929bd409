/* Rigid motions of one piece. Private to src/fem. */
#ifndef PROTIS_FEM_MODES_H
#define PROTIS_FEM_MODES_H

#include <stddef.h>

/* Motion of a piece: u(x) = t + w x p, p = (x - centre)/size, as rotations and
 * translations (2-D: w, tx, ty; axisymmetric: ty; 3-D: wx, wy, wz, tx, ..). */
typedef struct rigid_modes {
  int dim, modes; /* coefficients per piece: 3, 1 or 6 */
  double centre[3], size;
} rigid_modes;

/* Coefficients of the displacement along "direction" at x: row[modes]. */
void modes_row(const rigid_modes *r, const double *x, const double *direction,
               double *row);
/* The motion y[modes] about the centre and with the size of another, "to". */
void modes_move(const rigid_modes *from, const rigid_modes *to, double *y);
/* Name the motion v[modes]: "translation along x", "rotation about (1, 2)". */
void modes_text(const rigid_modes *at, const double *v, char *text,
                size_t size);

#endif
