/*
 * Whether the supports of a body strain it: their displacements, as given, are
 * compared with the nearest rigid motion of the body. What is left of them is
 * found in long double, so that it is none of a rigid motion but the rounding
 * of the data. The strains of the solution cannot tell: where the motion is far
 * above them they are rounding.
 */
#include "base/memory.h"
#include "base/sparse.h"
#include "run/history/loop.h"

#include <float.h>
#include <math.h>

enum { MODES = 6, COLUMNS = MODES + 1 };

/* One condition for each prescribed component, gathered by Givens rotations in
 * a triangle; its last column is the displacement, m. */
typedef struct motion_fit {
  long double row[MODES][COLUMNS];
  long double left; /* sum of the squares of what no motion gives, m^2 */
  double most;      /* largest displacement, m */
  long n;           /* conditions */
} motion_fit;

/* Displacement of component c at x in the motions: w, t of u = t + w x x. */
static void set_row(kinematics kind, const double *x, int c,
                    long double row[COLUMNS]) {
  for (int k = 0; k < COLUMNS; ++k) row[k] = 0;
  if (kind == AXISYMMETRIC) {
    row[0] = c == 1;
  } else if (kind == SOLID_3D) {
    row[(c + 1) % 3] = x[(c + 2) % 3];
    row[(c + 2) % 3] = -(long double)x[(c + 1) % 3];
    row[3 + c] = 1;
  } else {
    row[0] = c == 0 ? -x[1] : x[0];
    row[1 + c] = 1;
  }
}

static void add_row(motion_fit *f, long double row[COLUMNS]) {
  ++f->n;
  f->most = fmax(f->most, fabs((double)row[MODES]));
  for (int k = 0; k < MODES; ++k) {
    long double *to = f->row[k];
    if (row[k] == 0) continue;
    const long double h = hypotl(to[k], row[k]), c = to[k] / h, s = row[k] / h;
    for (int j = k; j < COLUMNS; ++j) {
      const long double a = to[j], b = row[j];
      to[j] = c * a + s * b;
      row[j] = c * b - s * a;
    }
  }
  f->left += row[MODES] * row[MODES];
}

/* Body of each node, and their number. */
static status find_bodies(const run *r, int *body, int *n) {
  const mesh *m = r->msh;
  OWNED int *of = NULL;
  PASS_NEW(of, m->n_elem);
  PASS(mesh_bodies(m, n, of));
  for (int e = 0; e < m->n_elem; ++e)
    for (int a = 0; a <= m->dim; ++a)
      body[m->elem[(m->dim + 1) * e + a]] = of[e];
  return OK;
}

status supports_strain(const run *r, int *strained) {
  const mesh *m = r->msh;
  const int dim = m->dim;
  OWNED int *body = NULL;
  OWNED motion_fit *fit = NULL;
  int n = 0;
  PASS_NEW(body, m->n_node);
  PASS(find_bodies(r, body, &n));
  PASS_NEW(fit, n);
  for (size_t q = 0; q < r->n_dof; ++q) {
    const size_t i = q / (size_t)dim;
    long double row[COLUMNS];
    if (!r->body.fixed[q]) continue;
    set_row(r->body.d.kin[0], m->x + (size_t)dim * i, (int)(q % (size_t)dim),
            row);
    row[MODES] = r->loads.ud[q];
    add_row(&fit[body[i]], row);
  }
  *strained = 0;
  for (int b = 0; b < n; ++b) {
    const double least = DBL_EPSILON * fit[b].most;
    if (fit[b].left > (double)fit[b].n * least * least) *strained = 1;
  }
  return OK;
}
