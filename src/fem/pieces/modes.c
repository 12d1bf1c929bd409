#include "fem/pieces/modes.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

void modes_row(const rigid_modes *r, const double *x, const double *direction,
               double *row) {
  double p[3], *v = row;
  for (int c = 0; c < r->dim; ++c) p[c] = (x[c] - r->centre[c]) / r->size;
  if (r->modes == 1) {
    row[0] = direction[1];
  } else if (r->dim == 2) {
    *v++ = p[0] * direction[1] - p[1] * direction[0];
    memcpy(v, direction, 2 * sizeof *v);
  } else {
    for (int c = 0; c < 3; ++c) {
      const int i = (c + 1) % 3, j = (c + 2) % 3;
      *v++ = p[i] * direction[j] - p[j] * direction[i];
    }
    memcpy(v, direction, 3 * sizeof *v);
  }
}

void modes_move(const rigid_modes *from, const rigid_modes *to, double *y) {
  const double turn = to->size / from->size;
  double e[3];
  if (from->modes == 1) return;
  for (int c = 0; c < from->dim; ++c)
    e[c] = (to->centre[c] - from->centre[c]) / from->size;
  if (from->dim == 2) {
    y[1] -= y[0] * e[1];
    y[2] += y[0] * e[0];
    y[0] *= turn;
    return;
  }
  for (int c = 0; c < 3; ++c) {
    const int i = (c + 1) % 3, j = (c + 2) % 3;
    y[3 + c] += y[i] * e[j] - y[j] * e[i];
  }
  for (int c = 0; c < 3; ++c) y[c] *= turn;
}

/* "x" or "(0.6, 0.8, 0)" for a direction; "(1, 2)" for a point. */
static void write_vector(int dim, const double *v, int direction, char *text,
                         size_t size) {
  double most = 0, norm = 0;
  int at = 0, single = direction;
  for (int c = 0; c < dim; ++c) {
    norm += v[c] * v[c];
    if (fabs(v[c]) > most) {
      most = fabs(v[c]);
      at = c;
    }
  }
  for (int c = 0; c < dim; ++c)
    if (c != at && fabs(v[c]) > 1e-6 * most) single = 0;
  if (single) {
    snprintf(text, size, "%c", "xyz"[at]);
    return;
  }
  size_t used = 0;
  for (int c = 0; c < dim && used < size; ++c)
    used += (size_t)snprintf(text + used, size - used, "%s%.6g",
                             c == 0 ? "(" : ", ",
                             direction ? v[c] / sqrt(norm) : v[c]);
  if (used < size) snprintf(text + used, size - used, ")");
}

/* A coordinate from one relative to centre and size. */
static double to_coordinate(const rigid_modes *at, int c, double relative) {
  const double x = at->centre[c] + at->size * relative;
  return fabs(x) < 1e-9 * at->size ? 0 : x;
}

static void write_rotation_3d(const rigid_modes *at, const double *w,
                              const double *t, char *text, size_t size) {
  char axis[64], through[64];
  double ww = 0, tw = 0, point[3];
  for (int c = 0; c < 3; ++c) {
    ww += w[c] * w[c];
    tw += t[c] * w[c];
  }
  for (int c = 0; c < 3; ++c) {
    const int i = (c + 1) % 3, j = (c + 2) % 3;
    point[c] = to_coordinate(at, c, (w[i] * t[j] - w[j] * t[i]) / ww);
  }
  write_vector(3, w, 1, axis, sizeof axis);
  write_vector(3, point, 0, through, sizeof through);
  snprintf(text, size, "%s about %s through %s",
           fabs(tw) > 1e-6 * ww ? "screw motion" : "rotation", axis, through);
}

void modes_text(const rigid_modes *at, const double *v, char *text,
                size_t size) {
  const int dim = at->dim;
  char vector[64];
  if (at->modes == 1) {
    snprintf(text, size, "translation along y");
  } else if (dim == 2 && fabs(v[0]) > 1e-6 * hypot(v[1], v[2])) {
    const double point[2] = {to_coordinate(at, 0, -v[2] / v[0]),
                             to_coordinate(at, 1, v[1] / v[0])};
    write_vector(2, point, 0, vector, sizeof vector);
    snprintf(text, size, "rotation about %s", vector);
  } else if (dim == 3 &&
             v[0] * v[0] + v[1] * v[1] + v[2] * v[2] >
                 1e-12 * (v[3] * v[3] + v[4] * v[4] + v[5] * v[5])) {
    write_rotation_3d(at, v, v + 3, text, size);
  } else {
    write_vector(dim, v + (dim == 2 ? 1 : 3), 1, vector, sizeof vector);
    snprintf(text, size, "translation along %s", vector);
  }
}
