/* src/contact/mortar: coupling of two surfaces. Expected values: closed forms,
 * properties of the method, and quadrature and polygons made here. */
#include "support/two_surfaces.h"
#include "support/unit.h"

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

static double area_sum(const mortar *m) {
  double sum = 0;
  for (int q = 0; q < m->n; ++q) sum += m->area[q];
  return sum;
}

/* Row sums 1; P x = x on a plane: the gap vectors vanish but for rounding. */
static void check_rows(const pair *p, const mortar *m, double far) {
  const int dim = p->m.dim;
  for (int q = 0; q < m->n; ++q) {
    ck_assert_double_eq_tol(two_part_sum(m, q), 1, 1e-13);
    for (int c = 0; c < dim; ++c)
      ck_assert_double_eq_tol(m->gap[dim * q + c], 0, far);
  }
}

/* Plane surfaces that cover each other, a constant pressure: its resultant on
 * the slave, and its moment about the origin, are those of the master's area.
 */
static void check_resultant(const pair *p, const mortar *m) {
  const int dim = p->m.dim;
  double area = 0, first[3] = {0};
  for (int q = 0; q < m->n; ++q) {
    area += m->area[q];
    for (int c = 0; c < dim; ++c)
      first[c] += m->area[q] * m->lever[dim * q + c];
  }
  for (int i = 0; i < p->in.n_master; ++i) {
    const int face = p->master[i];
    area -= face_area(p, face);
    for (int k = 0; k < dim * dim; ++k)
      first[k % dim] -= face_area(p, face) / dim *
                        p->m.x[dim * p->m.face[dim * face + k / dim] + k % dim];
  }
  ck_assert_double_eq_tol(area, 0, 1e-13);
  for (int c = 0; c < dim; ++c) ck_assert_double_eq_tol(first[c], 0, 1e-13);
}

/* The same: sum_j P_jl D_j = int phi_l, the forces on the master; D_j is what
 * the area is without that of neighbours. */
static void check_forces(const pair *p, const mortar *m, int first_master) {
  const int dim = p->m.dim;
  FREED double *force = calloc((size_t)p->m.n_node, sizeof *force);
  for (int q = 0; q < m->n; ++q)
    for (size_t e = m->to.start[q]; e < m->to.start[q + 1]; ++e)
      force[m->to.master[e]] +=
          m->area[q] / m->share[q] * m->to.part[(size_t)dim * e];
  for (int i = 0; i < p->in.n_master; ++i)
    for (int k = 0; k < dim; ++k)
      force[p->m.face[dim * p->master[i] + k]] -=
          face_area(p, p->master[i]) / dim;
  for (int i = first_master; i < p->m.n_node; ++i)
    ck_assert_double_eq_tol(force[i], 0, 1e-14);
  check_resultant(p, m);
}

static pair plane_pair(int dim, int n_slave, int n_master, double jitter) {
  pair p = two_new(dim);
  if (dim == 2) {
    two_add_line(&p, 1, n_slave, 0, 1, jitter);
    two_add_line(&p, 0, n_master, 0, 1, jitter);
  } else {
    two_add_square(&p, 1, n_slave, 0, 1, jitter);
    two_add_square(&p, 0, n_master, 0, 1, jitter);
  }
  return p;
}

TEST(planes_reproduce_linear_fields_and_constant_pressure) {
  static const int sizes[][2] = {{1, 1}, {3, 31}, {5, 7},
                                 {8, 8}, {16, 9}, {12, 13}};
  for (int dim = 2; dim <= 3; ++dim)
    for (int s = 0; s < 6; ++s)
      for (int turn = 0; turn < 8; ++turn) {
        OWN_PAIR p =
            plane_pair(dim, sizes[s][0], sizes[s][1], turn % 2 ? 0.4 : 0);
        double R[9], by[3] = {0.3 * turn, -0.2, 0.1};
        rotation(R, 0.9 * turn, 0.5 * turn, dim);
        move(&p, R, by);
        OWNED mortar *m = two_couple(&p);
        ck_assert_int_eq(m->n, dim == 2
                                   ? sizes[s][0] + 1
                                   : (sizes[s][0] + 1) * (sizes[s][0] + 1));
        ck_assert_double_eq_tol(area_sum(m), 1, 1e-13);
        ck_assert_double_eq_tol(m->covered, 1, 1e-13);
        check_rows(&p, m, 1e-13);
        check_forces(&p, m, 0);
      }
}

/* ---- rows ---------------------------------------------------------------- */

static double part_of(const mortar *m, int node, int master) {
  for (int q = 0; q < m->n; ++q)
    for (size_t e = m->to.start[q]; e < m->to.start[q + 1]; ++e)
      if (m->node_id[q] == node && m->to.master[e] == master)
        return m->to.part[(size_t)m->to.dim * e];
  return 0;
}

/* One slave edge on two masters: psi = 2 - 3 s and 3 s - 1. */
TEST(an_edge_on_two_has_the_parts_of_the_closed_form) {
  OWN_PAIR p = two_new(2);
  two_add_line(&p, 1, 1, 0, 1, 0);
  two_add_line(&p, 0, 2, 0, 1, 0);
  for (int i = 2; i < 5; ++i) p.m.x[2 * i + 1] = -0.25; /* the gap */
  OWNED mortar *m = two_couple(&p);
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
}

/* Force of a constant pressure on the ring a..b: 2 pi int r phi. */
static double ring_force(double a, double b) {
  return 2 * acos(-1.0) * fabs(b - a) * (2 * a + b) / 6;
}

TEST(axisymmetric_faces_are_weighted_with_the_radius) {
  const double pi = acos(-1.0);
  OWN_PAIR p = two_new(2);
  two_add_line(&p, 1, 4, 0, 2, 0.5); /* from the axis */
  two_add_line(&p, 0, 7, 0, 2, 0.5);
  p.in.axisymmetric = 1;
  OWNED mortar *m = two_couple(&p);
  FREED double *force = calloc((size_t)p.m.n_node, sizeof *force);
  ck_assert_int_eq(m->n, 5);
  ck_assert_double_eq_tol(area_sum(m), 4 * pi, 1e-13);
  ck_assert_double_eq_tol(m->area[0], ring_force(0, p.m.x[2]), 1e-14);
  check_rows(&p, m, 1e-14);
  for (int q = 0; q < m->n; ++q)
    for (size_t e = m->to.start[q]; e < m->to.start[q + 1]; ++e)
      force[m->to.master[e]] += m->area[q] / m->share[q] * m->to.part[2 * e];
  for (int i = 5; i < 13; ++i) {
    const double r = p.m.x[2 * i];
    const double expected = (i > 5 ? ring_force(r, p.m.x[2 * i - 2]) : 0) +
                            (i < 12 ? ring_force(r, p.m.x[2 * i + 2]) : 0);
    ck_assert_double_eq_tol(force[i], expected, 1e-13);
  }
}

TEST(thickness_weighs_areas_and_not_parts) {
  OWN_PAIR p = plane_pair(2, 3, 4, 0), t = plane_pair(2, 3, 4, 0);
  for (int i = 0; i < 7; ++i) t.weight[i] = 2.5;
  OWNED mortar *a = two_couple(&p), *b = two_couple(&t);
  ck_assert_int_eq(a->n, b->n);
  for (int q = 0; q < a->n; ++q)
    ck_assert_double_eq_tol(b->area[q], 2.5 * a->area[q], 1e-15);
  for (size_t e = 0; e < a->to.start[a->n]; ++e)
    ck_assert_double_eq_tol(a->to.part[2 * e], b->to.part[2 * e], 1e-15);
}

/* A slave of thickness 2 on masters of 1 and 3: 1 on the left half, 2 on the
 * right one, at the face across the step too; whole where it is covered. */
TEST(bodies_touch_over_the_smaller_thickness) {
  for (int n = 2; n <= 5; ++n) {
    OWN_PAIR p = two_new(2);
    two_add_line(&p, 1, n, 0, 1, 0);
    two_add_line(&p, 0, 2, 0, 1, 0);
    for (int k = 0; k < p.m.n_face; ++k) p.weight[k] = 2;
    p.weight[p.master[0]] = 1;
    p.weight[p.master[1]] = 3;
    OWNED mortar *m = two_couple(&p);
    const int low = m->area[0] < m->area[n] ? 0 : n;
    ck_assert_double_eq_tol(area_sum(m), 0.5 * 1 + 0.5 * 2, 1e-13);
    ck_assert_double_eq_tol(m->area[low], 1 * 0.5 / n, 1e-13);
    ck_assert_double_eq_tol(m->area[n - low], 2 * 0.5 / n, 1e-13);
    for (int q = 0; q <= n && n % 2 == 0; ++q)
      ck_assert_double_eq_tol(m->whole[q], m->area[q], 1e-13);
  }
}

/* ---- nodes without multiplier -------------------------------------------- */

/* A constant pressure gives the masters of a line int phi_l over the part
 * from..to, whatever nodes are left out there. */
static void check_line_forces(const pair *p, const mortar *m, double from,
                              double to) {
  FREED double *force = calloc((size_t)p->m.n_node, sizeof *force);
  for (int q = 0; q < m->n; ++q)
    for (size_t e = m->to.start[q]; e < m->to.start[q + 1]; ++e)
      force[m->to.master[e]] += m->area[q] / m->share[q] * m->to.part[2 * e];
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
}

/* Slave edges of 0.2 on 0..1, masters from -1 to "end". */
static pair overhanging(double end) {
  pair p = two_new(2);
  two_add_line(&p, 1, 5, 0, 1, 0);
  two_add_line(&p, 0, 9, -1, end, 0.5);
  return p;
}

TEST(nodes_of_partly_covered_edges_have_the_covered_area) {
  OWN_PAIR p = overhanging(0.5); /* the third edge by half */
  OWNED mortar *m = two_couple(&p);
  const double area[4] = {0.1, 0.2, 0.1 + 0.075, 0.025};
  ck_assert_int_eq(m->n, 4);
  for (int q = 0; q < 4; ++q) {
    ck_assert_int_eq(m->node_id[q], q);
    ck_assert_double_eq_tol(m->area[q], area[q], 1e-15);
  }
  ck_assert_int_eq(m->n_uncovered, 2);
  ck_assert_int_eq(m->n_scant, 0);
  ck_assert_double_eq_tol(m->covered, 0.5, 1e-15);
  check_rows(&p, m, 1e-14);
  check_line_forces(&p, m, 0, 0.5);
}

/* Node 3 at 0.6 has 0.5 s^2/0.2 of the covered 0.4..0.4+s, of 0.2. */
TEST(nodes_covered_by_less_than_a_hundredth_are_left_out) {
  const double limit = sqrt(2 * 0.2 * 0.01 * 0.2);
  for (int above = 0; above < 2; ++above) {
    OWN_PAIR p = overhanging(0.4 + limit * (above ? 1.01 : 0.99));
    OWNED mortar *m = two_couple(&p);
    ck_assert_int_eq(m->n, above ? 4 : 3);
    ck_assert_int_eq(m->n_scant, !above);
    ck_assert_int_eq(m->n_uncovered, 2);
    check_rows(&p, m, 1e-13);
    check_line_forces(&p, m, 0, p.m.x[2 * 15]);
    /* The node left out is among the masters of its neighbour. */
    ck_assert_int_eq(part_of(m, 2, 3) < -1e-4, !above);
    double masters = 0; /* their sizes over the covered part */
    for (int i = 0; i < p.in.n_master; ++i) {
      const int *v = p.m.face + 2 * p.master[i];
      const double to = p.m.x[2 * v[0]], from = p.m.x[2 * v[1]];
      masters += fmax(0, to - fmax(from, 0)) * (to - from);
    }
    ck_assert_double_eq_tol(m->size_ratio, masters / (0.2 * p.m.x[2 * 15]),
                            1e-12);
  }
}

/* With one end dropped the other has psi = 1 on the last edge: its pressure is
 * constant there. P to the dropped node: - int phi_z. */
TEST(dropped_nodes_leave_their_part_to_the_neighbours) {
  OWN_PAIR p = two_new(2);
  two_add_line(&p, 1, 2, 0, 2, 0);
  two_add_line(&p, 0, 3, 0, 2, 0.5);
  p.dropped[2] = p.dropped[4] = 1; /* a master is not concerned */
  mortar *m = two_couple(&p);
  ck_assert_int_eq(m->n, 2);
  ck_assert_int_eq(m->n_dropped, 1);
  ck_assert_double_eq_tol(m->area[1], 1.5, 1e-15);
  ck_assert_double_eq_tol(part_of(m, 1, 2), -0.5, 1e-15);
  check_rows(&p, m, 1e-14);
  check_line_forces(&p, m, 0, 2);
  ck_assert_double_eq(m->share[0], 1);
  ck_assert_double_eq_tol(m->share[1], 1.5, 1e-15);
  ck_assert_double_eq_tol(m->lever[2], (1 + 0.5 * 2) / 1.5, 1e-15);
  memory_free(m);
  p.dropped[0] = p.dropped[1] = 1;
  m = two_couple(&p);
  ck_assert_int_eq(m->n, 0);
  ck_assert_int_eq(m->n_bare, 2);
  ck_assert_double_eq_tol(m->covered, 2, 1e-15);
  memory_free(m);
}

TEST(dropped_nodes_in_space_keep_linear_fields_and_forces) {
  for (int t = 0; t < 8; ++t) {
    OWN_PAIR p = plane_pair(3, 4, 5, 0.4);
    double R[9];
    rotation(R, t, 0.4 * t, 3);
    move(&p, R, (double[]){0, 0, 0});
    int n = 0;
    for (int i = 0; i < 25; ++i) n += p.dropped[i] = two_noise() > 0.1;
    OWNED mortar *m = two_couple(&p);
    ck_assert_int_eq(m->n, 25 - n);
    ck_assert_int_eq(m->n_dropped, n);
    check_rows(&p, m, 1e-13);
    if (m->n_bare == 0) check_forces(&p, m, 25);
  }
}

/* ---- lips, tips ---------------------------------------------------------- */

/* Lips on y = 0 from 0 to 1 whose nodes coincide; they meet at both tips. */
TEST(matching_lips_move_with_their_copies) {
  enum { N = 9 };
  for (int t = 0; t < 5; ++t) {
    OWN_PAIR p = two_new(2);
    double R[9];
    two_seed(5);
    two_add_line(&p, 1, N, 0, 1, 0.5);
    two_seed(5);
    two_add_line(&p, 0, N, 0, 1, 0.5);
    for (int i = 0; i < 2 * p.m.n_face; ++i) {
      if (p.m.face[i] == N + 1) p.m.face[i] = 0;
      if (p.m.face[i] == 2 * N + 1) p.m.face[i] = N;
    }
    rotation(R, 0.7 * t, 0, 2);
    move(&p, R, (double[]){10.0 * t, 3, 0});
    OWNED mortar *m = two_couple(&p);
    ck_assert_int_eq(m->n, N - 1);
    ck_assert_int_eq(m->n_dropped, 2);
    for (int q = 0; q < m->n; ++q) {
      ck_assert_uint_eq(m->to.start[q], (size_t)q);
      ck_assert_int_eq(m->to.master[q], m->node_id[q] + N + 1);
      ck_assert_double_eq_tol(m->to.part[2 * q], 1, 1e-13);
    }
  }
}

/* ---- curved surfaces ----------------------------------------------------- */

/* The places of a plane pair on a circle or sphere of radius 2, or on two
 * planes: a V, also of two edges in all, or an end of one edge. */
static void bend(pair *p, int kinked) {
  const int dim = p->m.dim;
  for (int i = 0; i < p->m.n_node; ++i) {
    double *x = p->m.x + dim * i, *z = x + dim - 1;
    if (kinked) {
      *z = 0.2 * (kinked == 2 ? fmax(0, x[0] - 0.75) : fabs(x[0] - 0.5));
      continue;
    }
    double square = 4;
    for (int c = 0; c < dim - 1; ++c) square -= (x[c] - 0.5) * (x[c] - 0.5);
    *z = -sqrt(square);
  }
}

static double largest_gap(const mortar *m) {
  double most = 0;
  for (int q = 0; q < m->n; ++q) {
    double gap = 0;
    for (int c = 0; c < m->to.dim; ++c)
      gap += m->gap[m->to.dim * q + c] * m->normal[m->to.dim * q + c];
    most = fmax(most, fabs(gap));
  }
  return most;
}

/* Two meshes of one curve have no gap where their faces are h^2/8R apart; those
 * of two planes none at all. */
TEST(gaps_are_those_of_the_curve) {
  static const int size[][2] = {{8, 12}, {4, 8}, {4, 8}, {2, 4}};
  for (int dim = 2; dim <= 3; ++dim)
    for (int kinked = 0; kinked < 6 - dim; ++kinked)
      for (int flat = 0; flat < 2; ++flat) {
        OWN_PAIR p = plane_pair(dim, size[kinked][0], size[kinked][1],
                                dim == 2 && !kinked ? 0.3 : 0);
        bend(&p, kinked);
        p.in.flat = flat;
        OWNED mortar *m = two_couple(&p);
        const double apart = largest_gap(m), facets = 1.0 / 64 / 16;
        if (kinked)
          ck_assert_double_le(apart, 1e-14);
        else if (flat)
          ck_assert_double_ge(apart, 0.2 * facets);
        else
          ck_assert_double_le(apart, 0.02 * facets);
      }
}

static double gap_of(pair *p, int q, int flat) {
  p->in.flat = flat;
  OWNED mortar *m = two_couple(p);
  const int dim = m->to.dim;
  double gap = 0;
  for (int c = 0; c < dim; ++c)
    gap += m->gap[dim * q + c] * m->normal[dim * q + c];
  return gap;
}

/* s = h^2/8R is the height of an arc over its edge from the axis, a part t
 * along it 4 s t (1 - t), and psi = 3 - 4 t of the node on the axis: its mean
 * with the radius is 6/5 s. */
TEST(arc_at_the_axis_has_the_mean_of_the_closed_form) {
  const double h = 1.0 / 8, R = 2;
  pair p = two_new(2);
  two_add_line(&p, 1, 8, 0, 1, 0);
  for (int i = 0; i <= 8; ++i) p.m.x[2 * i + 1] = pow(p.m.x[2 * i], 2) / 2 / R;
  two_add_line(&p, 0, 1, 0, 2, 0);
  p.in.axisymmetric = 1;
  const double beyond = gap_of(&p, 0, 1) - gap_of(&p, 0, 0);
  ck_assert_double_eq_tol(beyond / (h * h / 8 / R), 1.2, 0.01);
  two_free(&p);
}

static void turn_corners(pair *p) {
  for (int f = 0; f < p->in.n_slave + p->in.n_master; ++f) {
    int *v = p->m.face + 3 * f, first = v[0];
    v[0] = v[1];
    v[1] = v[2];
    v[2] = first;
  }
}

/* But for the quadrature of curves that are no polynomials over a face. */
TEST(gaps_of_a_sphere_do_not_hang_on_the_order_of_corners) {
  OWN_PAIR p = plane_pair(3, 3, 5, 0.3);
  bend(&p, 0);
  for (int q = 0; q < 16; ++q) {
    const double gap = gap_of(&p, q, 0);
    turn_corners(&p);
    ck_assert_double_eq_tol(gap_of(&p, q, 0), gap, 1e-10);
  }
}

/* The slave is inside of the master. */
static void add_inside_out(pair *p, int of_slave, int a, int b, int c) {
  const int in_space = p->m.dim == 3;
  two_add_face(p, of_slave,
               !of_slave  ? (int[]){a, b, c}
               : in_space ? (int[]){a, c, b}
                          : (int[]){b, a});
}

static void at_eighth(int dim, int n, int i, int j, double *x) {
  const double turn = acos(0) * i / n;
  x[0] = dim == 3 ? i : i > 0 ? sin(turn) : 0;
  x[1] = dim == 3 ? n - i - j : i < n ? cos(turn) : 0;
  x[2] = j;
  make_unit(3, x);
}

/* An eighth of a sphere in n rows, or a quarter of a circle in n edges, between
 * planes of symmetry: bits of their nodes. */
static void add_eighth(pair *p, int of_slave, int n, unsigned char *planes) {
  const int dim = p->m.dim, rows = dim == 3 ? n : 0;
  for (int j = 0; j <= rows; ++j)
    for (int i = 0; i <= n - j; ++i) {
      double x[3];
      at_eighth(dim, n, i, j, x);
      const int at = two_add_node(p, x[0], x[1], x[2]);
      for (int c = 0; c < dim; ++c)
        planes[at] |= (unsigned char)((x[c] == 0) << c);
    }
  for (int j = 0, a = p->m.n_node - (n + 1) * (rows + 2) / 2; j <= rows; ++j)
    for (int i = 0; i <= n - j; ++i, ++a) {
      const int up = a + n - j + 1;
      if (i + j < n && j < n) add_inside_out(p, of_slave, a, a + 1, up);
      if (dim == 3 && i + j + 1 < n)
        add_inside_out(p, of_slave, a + 1, up + 1, up);
    }
}

/* Nodes in planes of symmetry are fitted as those inside: of a circle, whose
 * curvature is one, as without the planes. */
TEST(gaps_at_planes_of_symmetry_are_those_of_the_whole) {
  for (int dim = 2; dim <= 3; ++dim) {
    OWN_PAIR p = two_new(dim);
    double apart[2];
    unsigned char planes[400] = {0};
    add_eighth(&p, 1, 8, planes);
    add_eighth(&p, 0, 6, planes);
    for (int known = 0; known < 2; ++known) {
      p.in.mirrored = known ? planes : NULL;
      OWNED mortar *m = two_couple(&p);
      apart[known] = largest_gap(m);
    }
    ck_assert_double_le(apart[1], (dim == 2 ? 1.01 : 0.4) * apart[0]);
  }
}

/* A coarse mesh of a circle and a fine one, 24 of its faces on each: what is
 * left of h^2/8R, 0.034, is of the next order, alpha^4 with alpha = pi/12 half
 * the angle of a face. */
TEST(gaps_of_a_coarse_circle_are_small_of_the_next_order) {
  const double next = pow(acos(0) / 6, 4);
  for (int of_slave = 0; of_slave < 2; ++of_slave) {
    OWN_PAIR p = two_new(2);
    double mean = 0;
    unsigned char planes[400] = {0};
    add_eighth(&p, 1, of_slave ? 3 : 72, planes);
    add_eighth(&p, 0, of_slave ? 72 : 3, planes);
    p.in.mirrored = planes;
    OWNED mortar *m = two_couple(&p);
    for (int q = 0; q < m->n; ++q)
      mean += dot(2, m->gap + 2 * q, m->normal + 2 * q) / m->n;
    ck_assert_double_le(fabs(mean), 0.03 * next);
    ck_assert_double_le(largest_gap(m), 0.04 * next);
  }
}

/* ---- normals, places, units ---------------------------------------------- */

/* Slave at an angle to the master: the mean is half way. */
TEST(normals_are_the_mean_of_both_sides_or_those_of_the_slave) {
  for (int slave = 0; slave < 2; ++slave) {
    OWN_PAIR p = plane_pair(2, 4, 6, 0);
    const double angle = 0.1;
    for (int i = 0; i < 5; ++i) p.m.x[2 * i + 1] = tan(angle) * p.m.x[2 * i];
    p.in.slave_normal = slave;
    OWNED mortar *m = two_couple(&p);
    ck_assert_int_eq(m->n, 5);
    for (int q = 0; q < m->n; ++q) {
      const double a = slave ? angle : angle / 2;
      ck_assert_double_eq_tol(m->normal[2 * q], sin(a), 1e-14);
      ck_assert_double_eq_tol(m->normal[2 * q + 1], -cos(a), 1e-14);
    }
  }
}

/* The normal of a node left out is, among the masters, the opposite of its own:
 * with P = -1 for it, the sum is twice the normal of the others and that of the
 * slave. */
TEST(normals_beside_a_node_left_out_are_the_mean_too) {
  const double angle = 0.2, s[2] = {sin(angle), -cos(angle)};
  OWN_PAIR p = two_new(2);
  two_add_line(&p, 1, 1, 0, 1, 0);
  two_add_line(&p, 0, 1, -0.5, 1.5, 0);
  p.m.x[3] = tan(angle); /* the right end of the slave */
  p.dropped[1] = 1;
  OWNED mortar *m = two_couple(&p);
  ck_assert_int_eq(m->n, 1);
  const double z = part_of(m, 0, 1);
  const double other[2] = {-z * s[0], 1 - z - z * s[1]};
  const double length = hypot(other[0], other[1]);
  const double n[2] = {s[0] - other[0] / length, s[1] - other[1] / length};
  ck_assert_double_eq_tol(z, -1, 1e-14);
  for (int c = 0; c < 2; ++c)
    ck_assert_double_eq_tol(m->normal[c], n[c] / hypot(n[0], n[1]), 1e-14);
}

/* Where the coordinates are a million sizes of the faces, and those of both
 * sides differ in the last digit, small parts are rounding; without them a row
 * is that of the copy alone, and 1. */
TEST(rows_sum_to_one_far_from_the_origin) {
  for (int dim = 2; dim <= 3; ++dim) {
    OWN_PAIR p = plane_pair(dim, 8, 8, 0);
    double R[9], by[3] = {1e5, -2e5, 1.5e5};
    rotation(R, 0.7, 0.3, dim);
    move(&p, R, by);
    for (int i = dim * p.m.n_node / 2; i < dim * p.m.n_node; ++i)
      p.m.x[i] = nextafter(p.m.x[i], i % 3 == 0 ? HUGE_VAL : -HUGE_VAL);
    OWNED mortar *m = two_couple(&p);
    ck_assert_int_eq(m->n, dim == 2 ? 9 : 81);
    for (int q = 0; q < m->n; ++q) {
      ck_assert_uint_eq(m->to.start[q + 1] - m->to.start[q], 1);
      ck_assert_double_eq_tol(two_part_sum(m, q), 1, 1e-14);
    }
  }
}

/* The mean of a master face is three slave faces long, whatever the unit. */
TEST(ratio_of_the_sizes_has_no_unit) {
  for (int k = 0; k < 2; ++k) {
    OWN_PAIR p = two_new(2);
    two_add_line(&p, 1, 6, 0, k ? 1e3 : 1, 0);
    two_add_line(&p, 0, 2, 0, k ? 1e3 : 1, 0);
    OWNED mortar *m = two_couple(&p);
    ck_assert_double_eq_tol(m->size_ratio, 3, 1e-13);
  }
}

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

TEST(units_change_nothing) {
  static const double units[] = {1e-9, 1e9, 25.4};
  OWN_PAIR p = bowls();
  OWNED mortar *a = two_couple(&p);
  for (int k = 0; k < 3; ++k) {
    OWN_PAIR s = bowls();
    memcpy(s.m.x, p.m.x, (size_t)(3 * p.m.n_node) * sizeof *s.m.x);
    for (int i = 0; i < 3 * s.m.n_node; ++i) s.m.x[i] *= units[k];
    OWNED mortar *b = two_couple(&s);
    check_same(a, b, units[k], units[k] * units[k]);
  }
}

/* Nodes at displaced places: as if the mesh were there. */
TEST(places_are_those_given) {
  OWN_PAIR p = bowls();
  p.in.flat = 1; /* curves are those of the mesh at rest */
  FREED double *x = calloc((size_t)(3 * p.m.n_node), sizeof *x);
  memcpy(x, p.m.x, (size_t)(3 * p.m.n_node) * sizeof *x);
  OWNED mortar *a = two_couple(&p), *b = NULL;
  memset(p.m.x, 0, (size_t)(3 * p.m.n_node) * sizeof *x);
  p.in.x = x;
  ck_assert_int_eq(mortar_couple(&p.in, &b), OK);
  check_same(a, b, 1, 1);
}

TEST(refused_memory_is_an_error_without_leak) {
  OWN_PAIR p = bowls();
  memory_free(two_couple(&p));
  mortar *m;
  UNIT_REFUSED(0, mortar_couple(&p.in, &m), memory_free(m));
}

UNIT_MAIN("mortar")
