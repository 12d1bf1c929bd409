/* src/contact/mortar: coupling of two surfaces. Expected values: closed forms,
 * properties of the method, and quadrature and polygons made here. */
#include "contact/mortar/mortar.h"
#include "base/memory.h"
#include "support/unit.h"

#include <math.h>
#include <string.h>

/* Two surfaces without bodies behind them: faces of one mesh. */
typedef struct pair {
  mesh m;
  mortar_input in;
  int *slave, *master;
  double *weight;
  unsigned char *dropped;
} pair;

enum { MOST_NODES = 4000, MOST_FACES = 8000 };

static pair pair_new(int dim) {
  pair p = {.m.dim = dim};
  p.m.x = calloc(3 * MOST_NODES, sizeof *p.m.x);
  p.m.face = calloc(3 * MOST_FACES, sizeof *p.m.face);
  p.slave = calloc(MOST_FACES, sizeof *p.slave);
  p.master = calloc(MOST_FACES, sizeof *p.master);
  p.weight = calloc(MOST_FACES, sizeof *p.weight);
  p.dropped = calloc(MOST_NODES, 1);
  for (int i = 0; i < MOST_FACES; ++i) p.weight[i] = 1;
  return p;
}

static void pair_free(pair *p) {
  free(p->m.x);
  free(p->m.face);
  free(p->slave);
  free(p->master);
  free(p->weight);
  free(p->dropped);
}

static mortar *couple(pair *p) {
  mortar *out = NULL;
  p->in.mesh = &p->m;
  p->in.slave = p->slave;
  p->in.master = p->master;
  p->in.x = p->m.x;
  p->in.face_weight = p->weight;
  p->in.dropped = p->dropped;
  ck_assert_int_eq(mortar_couple(&p->in, &out), OK);
  return out;
}

static void add_face(pair *p, int of_slave, const int *node) {
  memcpy(p->m.face + p->m.dim * p->m.n_face, node,
         (size_t)p->m.dim * sizeof *node);
  if (of_slave)
    p->slave[p->in.n_slave++] = p->m.n_face++;
  else
    p->master[p->in.n_master++] = p->m.n_face++;
}

static int add_node(pair *p, double x, double y, double z) {
  double *at = p->m.x + p->m.dim * p->m.n_node;
  at[0] = x;
  at[1] = y;
  if (p->m.dim == 3) at[2] = z;
  return p->m.n_node++;
}

static unsigned seed = 1;

static double noise(void) {
  seed = seed * 1103515245u + 12345u;
  return ((seed >> 8) & 0xffff) / 65535.0 - 0.5;
}

/* n edges on y = 0 from x0 to x1, inner nodes moved by part jitter of an edge;
 * the slave is above (normal down). */
static void add_line(pair *p, int of_slave, int n, double x0, double x1,
                     double jitter) {
  const int first = p->m.n_node;
  for (int i = 0; i <= n; ++i)
    add_node(p, x0 + (x1 - x0) * (i + (i % n == 0 ? 0 : jitter * noise())) / n,
             0, 0);
  for (int i = 0; i < n; ++i)
    add_face(p, of_slave,
             of_slave ? (int[]){first + i, first + i + 1}
                      : (int[]){first + i + 1, first + i});
}

/* n x n squares of two triangles each on z = 0 over [x0, x1]^2. */
static void add_square(pair *p, int of_slave, int n, double x0, double x1,
                       double jitter) {
  const int first = p->m.n_node;
  const double h = (x1 - x0) / n;
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i)
      add_node(p, x0 + h * (i + (i % n == 0 ? 0 : jitter * noise())),
               x0 + h * (j + (j % n == 0 ? 0 : jitter * noise())), 0);
  for (int k = 0; k < n * n; ++k) {
    const int a = first + k / n * (n + 1) + k % n, b = a + 1, c = a + n + 2,
              d = a + n + 1;
    const int up[2][3] = {{a, b, c}, {a, c, d}};
    for (int t = 0; t < 2; ++t)
      add_face(p, of_slave,
               of_slave ? (int[]){up[t][0], up[t][2], up[t][1]} : up[t]);
  }
}

/* x -> place + R x, R a rotation. */
static void move(pair *p, const double R[9], const double *by) {
  for (int i = 0; i < p->m.n_node; ++i) {
    double *x = p->m.x + p->m.dim * i, y[3] = {0};
    for (int r = 0; r < p->m.dim; ++r) {
      y[r] = by[r];
      for (int c = 0; c < p->m.dim; ++c) y[r] += R[3 * r + c] * x[c];
    }
    memcpy(x, y, (size_t)p->m.dim * sizeof *x);
  }
}

static void rotation(double R[9], double a, double b, int dim) {
  const double ca = cos(a), sa = sin(a), cb = cos(b), sb = sin(b);
  const double flat[9] = {ca, -sa, 0, sa, ca, 0, 0, 0, 1};
  const double space[9] = {ca,       -sa * cb, sa * sb, sa, ca * cb,
                           -ca * sb, 0,        sb,      cb};
  memcpy(R, dim == 2 ? flat : space, sizeof flat);
}

/* Area of a face, and its share at a node. */
static double face_area(const pair *p, int face) {
  double n[3];
  return mesh_face_normal(&p->m, face, n);
}

static double part_sum(const mortar *m, int q) {
  double sum = 0;
  for (size_t e = m->to.start[q]; e < m->to.start[q + 1]; ++e)
    sum += m->to.part[(size_t)m->to.dim * e];
  return sum;
}

static double area_sum(const mortar *m) {
  double sum = 0;
  for (int q = 0; q < m->n; ++q) sum += m->area[q];
  return sum;
}

/* Row sums 1; P x = x on a plane: the gap vectors vanish but for rounding. */
static void check_rows(const pair *p, const mortar *m, double far) {
  const int dim = p->m.dim;
  for (int q = 0; q < m->n; ++q) {
    ck_assert_double_eq_tol(part_sum(m, q), 1, 1e-13);
    for (int c = 0; c < dim; ++c)
      ck_assert_double_eq_tol(m->gap[dim * q + c], 0, far);
  }
}

/* Plane surfaces that cover each other: sum_j P_jl D_j = int phi_l, the forces
 * of a constant pressure on the master. */
static void check_forces(const pair *p, const mortar *m) {
  const int dim = p->m.dim;
  double *force = calloc((size_t)p->m.n_node, sizeof *force);
  for (int q = 0; q < m->n; ++q)
    for (size_t e = m->to.start[q]; e < m->to.start[q + 1]; ++e)
      force[m->to.master[e]] += m->area[q] * m->to.part[(size_t)dim * e];
  for (int i = 0; i < p->in.n_master; ++i)
    for (int k = 0; k < dim; ++k)
      force[p->m.face[dim * p->master[i] + k]] -=
          face_area(p, p->master[i]) / dim;
  for (int i = 0; i < p->m.n_node; ++i)
    ck_assert_double_eq_tol(force[i], 0, 1e-14);
  free(force);
}

static pair plane_pair(int dim, int n_slave, int n_master, double jitter) {
  pair p = pair_new(dim);
  if (dim == 2) {
    add_line(&p, 1, n_slave, 0, 1, jitter);
    add_line(&p, 0, n_master, 0, 1, jitter);
  } else {
    add_square(&p, 1, n_slave, 0, 1, jitter);
    add_square(&p, 0, n_master, 0, 1, jitter);
  }
  return p;
}

START_TEST(planes_reproduce_linear_fields_and_constant_pressure) {
  static const int sizes[][2] = {{1, 1}, {3, 31}, {5, 7},
                                 {8, 8}, {16, 9}, {12, 13}};
  for (int dim = 2; dim <= 3; ++dim)
    for (int s = 0; s < 6; ++s)
      for (int turn = 0; turn < 8; ++turn) {
        pair p = plane_pair(dim, sizes[s][0], sizes[s][1], turn % 2 ? 0.4 : 0);
        double R[9], by[3] = {0.3 * turn, -0.2, 0.1};
        rotation(R, 0.9 * turn, 0.5 * turn, dim);
        move(&p, R, by);
        mortar *m = couple(&p);
        ck_assert_int_eq(m->n, dim == 2
                                   ? sizes[s][0] + 1
                                   : (sizes[s][0] + 1) * (sizes[s][0] + 1));
        ck_assert_double_eq_tol(area_sum(m), 1, 1e-13);
        ck_assert_double_eq_tol(m->covered, 1, 1e-13);
        check_rows(&p, m, 1e-13);
        check_forces(&p, m);
        mortar_free(m);
        pair_free(&p);
      }
}
END_TEST

UNIT_MAIN("mortar", planes_reproduce_linear_fields_and_constant_pressure)
