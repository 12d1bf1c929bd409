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
static void check_forces(const pair *p, const mortar *m, int first_master) {
  const int dim = p->m.dim;
  double *force = calloc((size_t)p->m.n_node, sizeof *force);
  for (int q = 0; q < m->n; ++q)
    for (size_t e = m->to.start[q]; e < m->to.start[q + 1]; ++e)
      force[m->to.master[e]] += m->area[q] * m->to.part[(size_t)dim * e];
  for (int i = 0; i < p->in.n_master; ++i)
    for (int k = 0; k < dim; ++k)
      force[p->m.face[dim * p->master[i] + k]] -=
          face_area(p, p->master[i]) / dim;
  for (int i = first_master; i < p->m.n_node; ++i)
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
        check_forces(&p, m, 0);
        mortar_free(m);
        pair_free(&p);
      }
}
END_TEST

/* ---- rows ---------------------------------------------------------------- */

static double part_of(const mortar *m, int node, int master) {
  for (int q = 0; q < m->n; ++q)
    for (size_t e = m->to.start[q]; e < m->to.start[q + 1]; ++e)
      if (m->node_id[q] == node && m->to.master[e] == master)
        return m->to.part[(size_t)m->to.dim * e];
  return 0;
}

/* One slave edge on two masters: psi = 2 - 3 s and 3 s - 1. */
START_TEST(an_edge_on_two_has_the_parts_of_the_closed_form) {
  pair p = pair_new(2);
  add_line(&p, 1, 1, 0, 1, 0);
  add_line(&p, 0, 2, 0, 1, 0);
  for (int i = 2; i < 5; ++i) p.m.x[2 * i + 1] = -0.25; /* the gap */
  mortar *m = couple(&p);
  const double expected[2][3] = {{0.75, 0.5, -0.25}, {-0.25, 0.5, 0.75}};
  ck_assert_int_eq(m->n, 2);
  for (int j = 0; j < 2; ++j) {
    ck_assert_double_eq_tol(m->area[j], 0.5, 1e-15);
    ck_assert_double_eq_tol(m->normal[2 * j + 1], -1, 1e-15);
    ck_assert_double_eq_tol(m->gap[2 * j], 0, 1e-15);
    ck_assert_double_eq_tol(m->gap[2 * j + 1], -0.25, 1e-15);
    for (int l = 0; l < 3; ++l) {
      ck_assert_double_eq_tol(part_of(m, j, 2 + l), expected[j][l], 1e-15);
      for (size_t c = 0; c < 2; ++c)
        ck_assert_double_eq(m->to.part[6 * (size_t)j + 2 * (size_t)l + c],
                            m->to.part[6 * (size_t)j + 2 * (size_t)l]);
    }
  }
  ck_assert_double_eq_tol(m->size_ratio, 0.5, 1e-15);
  mortar_free(m);
  pair_free(&p);
}
END_TEST

/* Force of a constant pressure on the ring a..b: 2 pi int r phi. */
static double ring_force(double a, double b) {
  return 2 * acos(-1.0) * fabs(b - a) * (2 * a + b) / 6;
}

START_TEST(axisymmetric_faces_are_weighted_with_the_radius) {
  const double pi = acos(-1.0);
  pair p = pair_new(2);
  add_line(&p, 1, 4, 0, 2, 0.5); /* from the axis */
  add_line(&p, 0, 7, 0, 2, 0.5);
  p.in.axisymmetric = 1;
  mortar *m = couple(&p);
  double *force = calloc((size_t)p.m.n_node, sizeof *force);
  ck_assert_int_eq(m->n, 5);
  ck_assert_double_eq_tol(area_sum(m), 4 * pi, 1e-13);
  ck_assert_double_eq_tol(m->slave_area, 4 * pi, 1e-13);
  ck_assert_double_eq_tol(m->master_area, 4 * pi, 1e-13);
  ck_assert_double_eq_tol(m->area[0], ring_force(0, p.m.x[2]), 1e-14);
  check_rows(&p, m, 1e-14);
  for (int q = 0; q < m->n; ++q)
    for (size_t e = m->to.start[q]; e < m->to.start[q + 1]; ++e)
      force[m->to.master[e]] += m->area[q] * m->to.part[2 * e];
  for (int i = 5; i < 13; ++i) {
    const double r = p.m.x[2 * i];
    const double expected = (i > 5 ? ring_force(r, p.m.x[2 * i - 2]) : 0) +
                            (i < 12 ? ring_force(r, p.m.x[2 * i + 2]) : 0);
    ck_assert_double_eq_tol(force[i], expected, 1e-13);
  }
  free(force);
  mortar_free(m);
  pair_free(&p);
}
END_TEST

START_TEST(thickness_weighs_areas_and_not_parts) {
  pair p = plane_pair(2, 3, 4, 0), t = plane_pair(2, 3, 4, 0);
  for (int i = 0; i < 7; ++i) t.weight[i] = 2.5;
  mortar *a = couple(&p), *b = couple(&t);
  ck_assert_int_eq(a->n, b->n);
  for (int q = 0; q < a->n; ++q)
    ck_assert_double_eq_tol(b->area[q], 2.5 * a->area[q], 1e-15);
  for (size_t e = 0; e < a->to.start[a->n]; ++e)
    ck_assert_double_eq_tol(a->to.part[2 * e], b->to.part[2 * e], 1e-15);
  mortar_free(a);
  mortar_free(b);
  pair_free(&p);
  pair_free(&t);
}
END_TEST

/* ---- nodes without multiplier -------------------------------------------- */

/* A constant pressure gives the masters of a line int phi_l over the part
 * from..to, whatever nodes are left out there. */
static void check_line_forces(const pair *p, const mortar *m, double from,
                              double to) {
  double *force = calloc((size_t)p->m.n_node, sizeof *force);
  for (int q = 0; q < m->n; ++q)
    for (size_t e = m->to.start[q]; e < m->to.start[q + 1]; ++e)
      force[m->to.master[e]] += m->area[q] * m->to.part[2 * e];
  for (int i = 0; i < p->in.n_master; ++i) {
    const int *v = p->m.face + 2 * p->master[i];
    const double b = p->m.x[2 * v[0]], a = p->m.x[2 * v[1]];
    const double low = fmax(a, from), high = fmin(b, to);
    if (high <= low) continue;
    const double part = (0.5 * (low + high) - a) / (b - a);
    force[v[0]] -= part * (high - low);
    force[v[1]] -= (1 - part) * (high - low);
  }
  for (int i = 0; i < p->in.n_master; ++i)
    for (int k = 0; k < 2; ++k)
      ck_assert_double_eq_tol(force[p->m.face[2 * p->master[i] + k]], 0, 1e-14);
  free(force);
}

/* Slave edges of 0.2 on 0..1, masters from -1 to "end". */
static pair overhanging(double end) {
  pair p = pair_new(2);
  add_line(&p, 1, 5, 0, 1, 0);
  add_line(&p, 0, 9, -1, end, 0.5);
  return p;
}

START_TEST(nodes_of_partly_covered_edges_have_the_covered_area) {
  pair p = overhanging(0.5); /* the third edge by half */
  mortar *m = couple(&p);
  const double area[4] = {0.1, 0.2, 0.1 + 0.075, 0.025};
  ck_assert_int_eq(m->n, 4);
  for (int q = 0; q < 4; ++q) {
    ck_assert_int_eq(m->node_id[q], q);
    ck_assert_double_eq_tol(m->area[q], area[q], 1e-15);
  }
  ck_assert_int_eq(m->n_uncovered, 2);
  ck_assert_int_eq(m->n_scant, 0);
  ck_assert_double_eq_tol(m->covered, 0.5, 1e-15);
  ck_assert_double_eq_tol(m->slave_area, 1, 1e-15);
  ck_assert_double_eq_tol(m->master_area, 1.5, 1e-15);
  check_rows(&p, m, 1e-14);
  check_line_forces(&p, m, 0, 0.5);
  mortar_free(m);
  pair_free(&p);
}
END_TEST

/* Node 3 at 0.6 has 0.5 s^2/0.2 of the covered 0.4..0.4+s, of 0.2. */
START_TEST(nodes_covered_by_less_than_a_hundredth_are_left_out) {
  const double limit = sqrt(2 * 0.2 * 0.01 * 0.2);
  for (int above = 0; above < 2; ++above) {
    pair p = overhanging(0.4 + limit * (above ? 1.01 : 0.99));
    mortar *m = couple(&p);
    ck_assert_int_eq(m->n, above ? 4 : 3);
    ck_assert_int_eq(m->n_scant, !above);
    ck_assert_int_eq(m->scant_node, above ? -1 : 3);
    ck_assert_int_eq(m->n_uncovered, 2);
    check_rows(&p, m, 1e-13);
    check_line_forces(&p, m, 0, p.m.x[2 * 15]);
    /* The node left out is among the masters of its neighbour. */
    ck_assert_int_eq(part_of(m, 2, 3) < -1e-4, !above);
    mortar_free(m);
    pair_free(&p);
  }
}
END_TEST

/* With one end dropped the other has psi = 1 on the last edge: its pressure is
 * constant there. P to the dropped node: - int phi_z. */
START_TEST(dropped_nodes_leave_their_part_to_the_neighbours) {
  pair p = pair_new(2);
  add_line(&p, 1, 2, 0, 2, 0);
  add_line(&p, 0, 3, 0, 2, 0.5);
  p.dropped[2] = p.dropped[4] = 1; /* a master is not concerned */
  mortar *m = couple(&p);
  ck_assert_int_eq(m->n, 2);
  ck_assert_int_eq(m->n_dropped, 1);
  ck_assert_double_eq_tol(m->area[1], 1, 1e-15);
  ck_assert_double_eq_tol(part_of(m, 1, 2), -0.5, 1e-15);
  check_rows(&p, m, 1e-14);
  check_line_forces(&p, m, 0, 2);
  mortar_free(m);
  p.dropped[0] = p.dropped[1] = 1;
  m = couple(&p);
  ck_assert_int_eq(m->n, 0);
  ck_assert_int_eq(m->n_bare, 2);
  ck_assert_double_eq_tol(m->covered, 2, 1e-15);
  mortar_free(m);
  pair_free(&p);
}
END_TEST

START_TEST(dropped_nodes_in_space_keep_linear_fields_and_forces) {
  for (int t = 0; t < 8; ++t) {
    pair p = plane_pair(3, 4, 5, 0.4);
    double R[9];
    rotation(R, t, 0.4 * t, 3);
    move(&p, R, (double[]){0, 0, 0});
    int n = 0;
    for (int i = 0; i < 25; ++i) n += p.dropped[i] = noise() > 0.1;
    mortar *m = couple(&p);
    ck_assert_int_eq(m->n, 25 - n);
    ck_assert_int_eq(m->n_dropped, n);
    check_rows(&p, m, 1e-13);
    if (m->n_bare == 0) check_forces(&p, m, 25);
    mortar_free(m);
    pair_free(&p);
  }
}
END_TEST

/* ---- lips, tips ---------------------------------------------------------- */

/* Lips on y = 0 from 0 to 1 whose nodes coincide; they meet at both tips. */
START_TEST(matching_lips_move_with_their_copies) {
  enum { N = 9 };
  for (int t = 0; t < 5; ++t) {
    pair p = pair_new(2);
    double R[9];
    seed = 5;
    add_line(&p, 1, N, 0, 1, 0.5);
    seed = 5;
    add_line(&p, 0, N, 0, 1, 0.5);
    for (int i = 0; i < 2 * p.m.n_face; ++i) {
      if (p.m.face[i] == N + 1) p.m.face[i] = 0;
      if (p.m.face[i] == 2 * N + 1) p.m.face[i] = N;
    }
    rotation(R, 0.7 * t, 0, 2);
    move(&p, R, (double[]){10.0 * t, 3, 0});
    mortar *m = couple(&p);
    ck_assert_int_eq(m->n, N - 1);
    ck_assert_int_eq(m->n_dropped, 2);
    for (int q = 0; q < m->n; ++q) {
      ck_assert_uint_eq(m->to.start[q], (size_t)q);
      ck_assert_int_eq(m->to.master[q], m->node_id[q] + N + 1);
      ck_assert_double_eq_tol(m->to.part[2 * q], 1, 1e-13);
    }
    mortar_free(m);
    pair_free(&p);
  }
}
END_TEST

/* ---- partners ------------------------------------------------------------ */

/* A circle of n edges; outward: the body is inside. */
static void add_circle(pair *p, int of_slave, int n, double r, double turn,
                       int outward) {
  const int first = p->m.n_node;
  const double pi = acos(-1.0);
  for (int i = 0; i < n; ++i)
    add_node(p, r * cos(2 * pi * i / n + turn), r * sin(2 * pi * i / n + turn),
             0);
  for (int i = 0; i < n; ++i) {
    const int a = first + i, b = first + (i + 1) % n;
    add_face(p, of_slave, outward ? (int[]){a, b} : (int[]){b, a});
  }
}

/* The masters of each node are near to it. */
static void check_near(const pair *p, const mortar *m, double far) {
  const int dim = p->m.dim;
  for (int q = 0; q < m->n; ++q)
    for (size_t e = m->to.start[q]; e < m->to.start[q + 1]; ++e) {
      const double *a = p->m.x + dim * m->node_id[q];
      const double *b = p->m.x + dim * m->to.master[e];
      double sum = 0;
      for (int c = 0; c < dim; ++c) sum += (a[c] - b[c]) * (a[c] - b[c]);
      ck_assert_double_le(sqrt(sum), far);
    }
}

/* Rings r = 1..1.2 and 1.25..1.5 with both surfaces in the groups, either one
 * as the slave: the inner surface of the inner ring has no partner. */
START_TEST(rings_have_no_partner_on_the_far_side) {
  for (int inner = 0; inner < 2; ++inner) {
    pair p = pair_new(2);
    add_circle(&p, inner, 60, 1, 0, 0);
    add_circle(&p, inner, 60, 1.2, 0, 1);
    add_circle(&p, !inner, 71, 1.25, 0.02, 0);
    add_circle(&p, !inner, 71, 1.5, 0, 1);
    mortar *m = couple(&p);
    ck_assert_int_eq(m->n, inner ? 60 : 71);
    check_near(&p, m, 0.3);
    for (int q = 0; q < m->n; ++q) {
      const double *x = p.m.x + 2 * m->node_id[q], *n = m->normal + 2 * q;
      const double r = hypot(x[0], x[1]), way = inner ? 1 : -1;
      ck_assert_double_eq_tol(r, inner ? 1.2 : 1.25, 1e-12);
      for (int c = 0; c < 2; ++c)
        ck_assert_double_eq_tol(n[c], way * x[c] / r, 2e-3);
      /* 0.05 but for the heights of the chords */
      ck_assert_double_eq_tol(n[0] * m->gap[2 * q] + n[1] * m->gap[2 * q + 1],
                              0.05, 4e-3);
    }
    mortar_free(m);
    pair_free(&p);
  }
}
END_TEST

/* The outline of a plate x0..x1, y0..y1 in n by 1 edges. */
static void add_plate(pair *p, int of_slave, int n, const double *box) {
  const int first = p->m.n_node;
  for (int i = 0; i <= n; ++i)
    add_node(p, box[0] + (box[1] - box[0]) * i / n, box[2], 0);
  for (int i = n; i >= 0; --i)
    add_node(p, box[0] + (box[1] - box[0]) * i / n, box[3], 0);
  for (int i = 0; i < 2 * n + 2; ++i)
    add_face(p, of_slave, (int[]){first + i, first + (i + 1) % (2 * n + 2)});
}

/* A stack of thin plates, thinner than their faces are long, the second from
 * below as slave; it overhangs. */
START_TEST(plates_see_the_next_plate_and_not_what_is_behind) {
  pair p = pair_new(2);
  add_plate(&p, 1, 7, (double[]){0, 2, 1.10, 1.15});
  add_plate(&p, 0, 6, (double[]){0, 1, 1.00, 1.05});
  add_plate(&p, 0, 5, (double[]){0, 2, 1.20, 1.25});
  add_plate(&p, 0, 4, (double[]){0, 2, 1.30, 1.35});
  mortar *m = couple(&p);
  ck_assert_double_eq_tol(m->covered, 3, 1e-12);
  for (int q = 0; q < m->n; ++q) {
    const int top = m->node_id[q] >= 8;
    ck_assert_double_eq_tol(m->gap[2 * q + 1], top ? 0.05 : -0.05, 1e-13);
    ck_assert_double_eq_tol(m->normal[2 * q + 1], top ? 1 : -1, 1e-13);
  }
  mortar_free(m);
  pair_free(&p);
}
END_TEST

/* Masters one behind the other in space: the nearer, smaller one hides the
 * middle of the other. */
START_TEST(the_nearest_of_two_masters_is_the_partner) {
  pair p = pair_new(3);
  add_square(&p, 1, 3, 0, 1, 0);
  add_square(&p, 0, 4, 0, 1, 0);
  for (int i = 16; i < p.m.n_node; ++i) p.m.x[3 * i + 2] = -0.4;
  const int first = p.m.n_node;
  add_square(&p, 0, 2, 0.2, 0.7, 0);
  for (int i = first; i < p.m.n_node; ++i) p.m.x[3 * i + 2] = -0.1;
  mortar *m = couple(&p);
  double sum = 0;
  ck_assert_int_eq(m->n, 16);
  ck_assert_double_eq_tol(m->covered, 1, 1e-13);
  for (int q = 0; q < 16; ++q) {
    sum += m->area[q] * m->gap[3 * q + 2];
    ck_assert_double_eq_tol(part_sum(m, q), 1, 1e-13);
  }
  ck_assert_double_eq_tol(sum, -0.4 * 0.75 - 0.1 * 0.25, 1e-13);
  mortar_free(m);
  pair_free(&p);
}
END_TEST

/* An overlap of the bodies, here of several faces, is a negative gap. Their
 * sides, level or not, are no partners of each other. */
START_TEST(overlapping_bodies_are_partners) {
  for (int k = 0; k < 3; ++k) {
    const double by = 0.003 * (k - 1);
    pair p = pair_new(2);
    add_plate(&p, 1, 40, (double[]){0, 1, -0.1, 1});
    add_plate(&p, 0, 50, (double[]){by, 1 - by, -1, 0});
    mortar *m = couple(&p);
    ck_assert_double_eq_tol(m->covered, k == 2 ? 0.994 : 1, 1e-13);
    for (int q = 0; q < m->n; ++q) {
      ck_assert_int_le(m->node_id[q], 40);
      ck_assert_double_eq_tol(m->gap[2 * q + 1], 0.1, 1e-13);
      ck_assert_double_eq_tol(m->normal[2 * q + 1], -1, 1e-13);
    }
    mortar_free(m);
    pair_free(&p);
  }
}
END_TEST

START_TEST(surfaces_with_nothing_in_common_have_no_rows) {
  pair away = pair_new(2), same = pair_new(2), far = pair_new(2);
  add_line(&away, 1, 3, 0, 1, 0);
  add_line(&away, 0, 3, 1, 2, 0); /* they meet at a point */
  add_line(&same, 1, 3, 0, 1, 0);
  add_line(&same, 1, 3, 0, 1, 0); /* normals alike */
  same.in.n_slave = 3;
  same.in.n_master = 3;
  for (int i = 0; i < 3; ++i) same.master[i] = 3 + i;
  add_line(&far, 1, 3, 0, 1, 0);
  add_line(&far, 0, 3, 0, 1, 0);
  for (int i = 4; i < 8; ++i) far.m.x[2 * i + 1] = -1.1;
  pair *all[3] = {&away, &same, &far};
  for (int i = 0; i < 3; ++i) {
    mortar *m = couple(all[i]);
    ck_assert_int_eq(m->n, 0);
    ck_assert_int_eq(m->n_uncovered, 4);
    ck_assert_uint_eq(m->to.start[0], 0);
    ck_assert_double_eq(m->covered, 0);
    ck_assert_double_eq(m->size_ratio, 0);
    mortar_free(m);
    pair_free(all[i]);
  }
}
END_TEST

/* ---- normals, places, units ---------------------------------------------- */

/* Slave at an angle to the master: the mean is half way. */
START_TEST(normals_are_the_mean_of_both_sides_or_those_of_the_slave) {
  for (int slave = 0; slave < 2; ++slave) {
    pair p = plane_pair(2, 4, 6, 0);
    const double angle = 0.1;
    for (int i = 0; i < 5; ++i) p.m.x[2 * i + 1] = tan(angle) * p.m.x[2 * i];
    p.in.slave_normal = slave;
    mortar *m = couple(&p);
    ck_assert_int_eq(m->n, 5);
    for (int q = 0; q < m->n; ++q) {
      const double a = slave ? angle : angle / 2;
      ck_assert_double_eq_tol(m->normal[2 * q], sin(a), 1e-14);
      ck_assert_double_eq_tol(m->normal[2 * q + 1], -cos(a), 1e-14);
    }
    mortar_free(m);
    pair_free(&p);
  }
}
END_TEST

static void check_same(const mortar *a, const mortar *b, double length,
                       double area) {
  ck_assert_int_eq(a->n, b->n);
  for (int q = 0; q < a->n; ++q) {
    ck_assert_int_eq(a->node_id[q], b->node_id[q]);
    ck_assert_uint_eq(a->to.start[q + 1], b->to.start[q + 1]);
    ck_assert_double_eq_tol(a->area[q], b->area[q] / area, 1e-12);
  }
  for (int i = 0; i < a->to.dim * a->n; ++i)
    ck_assert_double_eq_tol(a->gap[i], b->gap[i] / length, 1e-12);
  for (size_t e = 0; e < a->to.start[a->n]; ++e) {
    ck_assert_int_eq(a->to.master[e], b->to.master[e]);
    ck_assert_double_eq_tol(a->to.part[(size_t)a->to.dim * e],
                            b->to.part[(size_t)a->to.dim * e], 1e-12);
  }
}

/* A bowl on a bowl. */
static pair bowls(void) {
  pair p = plane_pair(3, 5, 6, 0.4);
  for (int i = 0; i < p.m.n_node; ++i) {
    double *x = p.m.x + 3 * i;
    x[2] = 0.3 * (pow(x[0] - 0.5, 2) + x[1] * x[1]) - (i < 36 ? 0 : 0.01);
  }
  return p;
}

START_TEST(units_change_nothing) {
  static const double units[] = {1e-9, 1e9, 25.4};
  pair p = bowls();
  mortar *a = couple(&p);
  for (int k = 0; k < 3; ++k) {
    pair s = bowls();
    memcpy(s.m.x, p.m.x, (size_t)(3 * p.m.n_node) * sizeof *s.m.x);
    for (int i = 0; i < 3 * s.m.n_node; ++i) s.m.x[i] *= units[k];
    mortar *b = couple(&s);
    check_same(a, b, units[k], units[k] * units[k]);
    mortar_free(b);
    pair_free(&s);
  }
  mortar_free(a);
  pair_free(&p);
}
END_TEST

/* Nodes at displaced places: as if the mesh were there. */
START_TEST(places_are_those_given) {
  pair p = bowls();
  double *x = calloc((size_t)(3 * p.m.n_node), sizeof *x);
  memcpy(x, p.m.x, (size_t)(3 * p.m.n_node) * sizeof *x);
  mortar *a = couple(&p), *b = NULL;
  memset(p.m.x, 0, (size_t)(3 * p.m.n_node) * sizeof *x);
  p.in.x = x;
  ck_assert_int_eq(mortar_couple(&p.in, &b), OK);
  check_same(a, b, 1, 1);
  mortar_free(a);
  mortar_free(b);
  free(x);
  pair_free(&p);
}
END_TEST

START_TEST(refused_memory_is_an_error_without_leak) {
  pair p = bowls();
  mortar_free(couple(&p));
  const size_t before = memory_in_use();
  const long start = memory_requests();
  mortar_free(couple(&p));
  const long n = memory_requests() - start;
  for (long k = 1; k <= n; ++k) {
    mortar *m = NULL;
    memory_refuse(k, 0);
    ck_assert_int_eq(mortar_couple(&p.in, &m), ERR_MEMORY);
    memory_refuse(0, 0);
    ck_assert_ptr_null(m);
    ck_assert_uint_eq(memory_in_use(), before);
  }
  pair_free(&p);
}
END_TEST

UNIT_MAIN("mortar", planes_reproduce_linear_fields_and_constant_pressure,
          an_edge_on_two_has_the_parts_of_the_closed_form,
          axisymmetric_faces_are_weighted_with_the_radius,
          thickness_weighs_areas_and_not_parts,
          nodes_of_partly_covered_edges_have_the_covered_area,
          nodes_covered_by_less_than_a_hundredth_are_left_out,
          dropped_nodes_leave_their_part_to_the_neighbours,
          dropped_nodes_in_space_keep_linear_fields_and_forces,
          matching_lips_move_with_their_copies,
          rings_have_no_partner_on_the_far_side,
          plates_see_the_next_plate_and_not_what_is_behind,
          the_nearest_of_two_masters_is_the_partner,
          overlapping_bodies_are_partners,
          surfaces_with_nothing_in_common_have_no_rows,
          normals_are_the_mean_of_both_sides_or_those_of_the_slave,
          units_change_nothing, places_are_those_given,
          refused_memory_is_an_error_without_leak)
