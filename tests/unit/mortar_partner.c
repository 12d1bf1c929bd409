/* src/contact/mortar/partner.c: which faces of two surfaces meet, where several
 * are one behind the other. */
#include "support/two_surfaces.h"
#include "support/unit.h"

/* A circle of n edges; outward: the body is inside. */
static void add_circle(pair *p, int of_slave, int n, double r, double turn,
                       int outward) {
  const int first = p->m.n_node;
  const double pi = acos(-1.0);
  for (int i = 0; i < n; ++i)
    two_add_node(p, r * cos(2 * pi * i / n + turn),
                 r * sin(2 * pi * i / n + turn), 0);
  for (int i = 0; i < n; ++i) {
    const int a = first + i, b = first + (i + 1) % n;
    two_add_face(p, of_slave, outward ? (int[]){a, b} : (int[]){b, a});
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
TEST(rings_have_no_partner_on_the_far_side) {
  for (int inner = 0; inner < 2; ++inner) {
    OWN_PAIR p = two_new(2);
    add_circle(&p, inner, 60, 1, 0, 0);
    add_circle(&p, inner, 60, 1.2, 0, 1);
    add_circle(&p, !inner, 71, 1.25, 0.02, 0);
    add_circle(&p, !inner, 71, 1.5, 0, 1);
    OWNED mortar *m = two_couple(&p);
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
  }
}

/* The outline of a plate x0..x1, y0..y1 in n by 1 edges. */
static void add_plate(pair *p, int of_slave, int n, const double *box) {
  const int first = p->m.n_node;
  for (int i = 0; i <= n; ++i)
    two_add_node(p, box[0] + (box[1] - box[0]) * i / n, box[2], 0);
  for (int i = n; i >= 0; --i)
    two_add_node(p, box[0] + (box[1] - box[0]) * i / n, box[3], 0);
  for (int i = 0; i < 2 * n + 2; ++i)
    two_add_face(p, of_slave,
                 (int[]){first + i, first + (i + 1) % (2 * n + 2)});
}

/* A stack of thin plates, thinner than their faces are long, the second from
 * below as slave; it overhangs. */
TEST(plates_see_the_next_plate_and_not_what_is_behind) {
  OWN_PAIR p = two_new(2);
  add_plate(&p, 1, 7, (double[]){0, 2, 1.10, 1.15});
  add_plate(&p, 0, 6, (double[]){0, 1, 1.00, 1.05});
  add_plate(&p, 0, 5, (double[]){0, 2, 1.20, 1.25});
  add_plate(&p, 0, 4, (double[]){0, 2, 1.30, 1.35});
  OWNED mortar *m = two_couple(&p);
  ck_assert_double_eq_tol(m->covered, 3, 1e-12);
  for (int q = 0; q < m->n; ++q) {
    const int top = m->node_id[q] >= 8;
    ck_assert_double_eq_tol(m->gap[2 * q + 1], top ? 0.05 : -0.05, 1e-13);
    ck_assert_double_eq_tol(m->normal[2 * q + 1], top ? 1 : -1, 1e-13);
  }
}

/* Masters one behind the other in space: the nearer, smaller one hides the
 * middle of the other. A node has the gap of one of them, and all of the nearer
 * is met. */
TEST(the_nearest_of_two_masters_is_the_partner) {
  OWN_PAIR p = two_new(3);
  two_add_square(&p, 1, 8, 0, 1, 0);
  int first = p.m.n_node;
  two_add_square(&p, 0, 4, 0, 1, 0);
  for (int i = first; i < p.m.n_node; ++i) p.m.x[3 * i + 2] = -0.4;
  first = p.m.n_node;
  two_add_square(&p, 0, 2, 0.2, 0.7, 0);
  for (int i = first; i < p.m.n_node; ++i) p.m.x[3 * i + 2] = -0.1;
  OWNED mortar *m = two_couple(&p);
  double near = 0.0, far = 0.0;
  for (int q = 0; q < m->n; ++q) {
    const double gap = m->gap[3 * q + 2];
    ck_assert_double_eq_tol(gap, gap > -0.25 ? -0.1 : -0.4, 1e-13);
    if (gap > -0.25)
      near += m->area[q];
    else
      far += m->area[q];
    ck_assert_double_eq_tol(two_part_sum(m, q), 1, 1e-13);
  }
  ck_assert_double_eq_tol(near, 0.25, 1e-13);
  ck_assert_double_gt(far, 0.2);
  ck_assert_double_eq_tol(near + far, m->covered, 1e-13);
}

/* A step below 0.1 % of a face is a mean of both heights. */
TEST(slight_steps_are_no_steps) {
  for (int k = 0; k < 2; ++k) {
    OWN_PAIR p = two_new(2);
    add_plate(&p, 1, 10, (double[]){0, 1, 1, 2});
    add_plate(&p, 0, 1, (double[]){0, 0.45, 0, 1});
    add_plate(&p, 0, 1, (double[]){0.45, 1, 0, k ? 0.9998 : 0.99995});
    OWNED mortar *m = two_couple(&p);
    ck_assert_int_eq(m->n, 11);
    ck_assert_double_eq_tol(m->covered, k ? 0.85 : 1.0, 1e-12);
  }
}

/* A slit of 0.04 between a side and a steeper one: that its edge is higher by
 * so much the bend of a curve may make, or a step alone. */
TEST(bend_across_a_slit_is_no_step) {
  static const struct {
    double slope[2], higher;
    int is_step;
  } cases[] = {{{0, 0.1}, 0.006, 0},
               {{0, 0.1}, 0.0085, 1},
               {{0.577, 1.732}, 0.02 * (0.577 + 1.732), 0}};
  for (int k = 0; k < 3; ++k) {
    OWN_PAIR p = two_new(2);
    two_add_line(&p, 1, 20, -1, 1, 0);
    for (int side = 0; side < 2; ++side) {
      const double rise = 0.48 * cases[k].slope[side], x = 0.02 + 0.48 * side;
      const double y = -0.5 + side * cases[k].higher;
      const int a =
          two_add_node(&p, side ? 0.02 : -0.5, side ? y : y - rise, 0);
      const int b = two_add_node(&p, side ? x : -0.02, side ? y + rise : y, 0);
      two_add_face(&p, 0, (int[]){b, a});
    }
    OWNED mortar *m = two_couple(&p);
    if (cases[k].is_step)
      ck_assert_double_lt(m->covered, 0.9);
    else
      ck_assert_double_eq_tol(m->covered, 0.96, 1e-12);
  }
}

/* The same in space, where a face of an area of 1/128 has a size of 0.088. */
TEST(slight_steps_in_space_are_no_steps) {
  for (int k = 0; k < 2; ++k) {
    OWN_PAIR p = two_new(3);
    two_add_square(&p, 1, 8, 0, 1, 0);
    int first = p.m.n_node;
    two_add_square(&p, 0, 4, 0, 1, 0);
    for (int i = first; i < p.m.n_node; ++i) p.m.x[3 * i + 2] = -0.4;
    first = p.m.n_node;
    two_add_square(&p, 0, 2, 0.2, 0.7, 0);
    for (int i = first; i < p.m.n_node; ++i)
      p.m.x[3 * i + 2] = -0.4 + (k ? 1.5e-4 : 5e-5);
    OWNED mortar *m = two_couple(&p);
    if (k == 0)
      ck_assert_double_eq_tol(m->covered, 1, 1e-12);
    else
      ck_assert_double_lt(m->covered, 0.9);
  }
}

/* A step is measured by the largest face round the node and along the mean of
 * their normals: 5e-4 is less than 0.1 % of 0.8, not of 0.2; the normal of a
 * corner between a level face and one of 60 degrees makes 9.2e-4 of 8e-4, less
 * than 0.1 % of the length 1 of the level one. */
TEST(all_faces_of_a_node_measure_its_step) {
  static const struct {
    double x[3][2], higher;
    int first; /* node of the first face */
  } cases[] = {{{{0, 0}, {0.8, 0}, {1, 0}}, 5e-4, 0},
               {{{0, 0}, {0.8, 0}, {1, 0}}, 5e-4, 1},
               {{{0, 0}, {1, 0}, {1.2, 0.346}}, 8e-4, 0},
               {{{0, 0}, {1, 0}, {1.2, 0.346}}, 8e-4, 1}};
  for (int k = 0; k < 4; ++k) {
    OWN_PAIR p = two_new(2);
    for (int i = 2; i >= 0; --i)
      two_add_node(&p, cases[k].x[i][0], cases[k].x[i][1], 0);
    for (int i = 0; i < 2; ++i) {
      const int left = 2 - (i + cases[k].first) % 2;
      two_add_face(&p, 1, (int[]){left, left - 1});
    }
    for (int i = 0; i < 2; ++i) {
      const double y = -0.3 + i * cases[k].higher;
      const int left = two_add_node(&p, 0.5 * i, y, 0);
      two_add_face(&p, 0, (int[]){two_add_node(&p, 0.5 + 0.5 * i, y, 0), left});
    }
    OWNED mortar *m = two_couple(&p);
    ck_assert_double_eq_tol(m->covered, 1, 1e-12);
  }
}

/* Three treads, the middle one a single face: a face that has left the lowest
 * by the first edge, at 0.52, still has the middle one, which those round the
 * second edge, at 0.68, leave. */
TEST(each_face_leaves_what_is_beyond_its_own_step) {
  static const double x[4] = {0, 0.52, 0.68, 1}, y[3] = {-0.3, -0.2, -0.1};
  OWN_PAIR p = two_new(2);
  two_add_line(&p, 1, 20, 0, 1, 0);
  for (int i = 0; i < 3; ++i) {
    const int a = two_add_node(&p, x[i], y[i], 0);
    two_add_face(&p, 0, (int[]){two_add_node(&p, x[i + 1], y[i], 0), a});
  }
  OWNED mortar *m = two_couple(&p);
  ck_assert_double_eq_tol(m->covered, 1 - 0.07 - 0.08, 1e-12);
}

/* An overlap of the bodies, here of several faces, is a negative gap. Their
 * sides, level or not, are no partners of each other. */
TEST(overlapping_bodies_are_partners) {
  for (int k = 0; k < 3; ++k) {
    const double by = 0.003 * (k - 1);
    OWN_PAIR p = two_new(2);
    add_plate(&p, 1, 40, (double[]){0, 1, -0.1, 1});
    add_plate(&p, 0, 50, (double[]){by, 1 - by, -1, 0});
    OWNED mortar *m = two_couple(&p);
    ck_assert_double_eq_tol(m->covered, k == 2 ? 0.994 : 1, 1e-13);
    for (int q = 0; q < m->n; ++q) {
      ck_assert_int_le(m->node_id[q], 40);
      ck_assert_double_eq_tol(m->gap[2 * q + 1], 0.1, 1e-13);
      ck_assert_double_eq_tol(m->normal[2 * q + 1], -1, 1e-13);
    }
  }
}

TEST(surfaces_with_nothing_in_common_have_no_rows) {
  pair away = two_new(2), same = two_new(2), far = two_new(2);
  two_add_line(&away, 1, 3, 0, 1, 0);
  two_add_line(&away, 0, 3, 1, 2, 0); /* they meet at a point */
  two_add_line(&same, 1, 3, 0, 1, 0);
  two_add_line(&same, 1, 3, 0, 1, 0); /* normals alike */
  same.in.n_slave = 3;
  same.in.n_master = 3;
  for (int i = 0; i < 3; ++i) same.master[i] = 3 + i;
  two_add_line(&far, 1, 3, 0, 1, 0);
  two_add_line(&far, 0, 3, 0, 1, 0);
  for (int i = 4; i < 8; ++i) far.m.x[2 * i + 1] = -1.1;
  pair *all[3] = {&away, &same, &far};
  for (int i = 0; i < 3; ++i) {
    OWNED mortar *m = two_couple(all[i]);
    ck_assert_int_eq(m->n, 0);
    ck_assert_int_eq(m->n_uncovered, 4);
    ck_assert_uint_eq(m->to.start[0], 0);
    ck_assert_double_eq(m->covered, 0);
    ck_assert_double_eq(m->size_ratio, 0);
    two_free(all[i]);
  }
}

/* Two masters that are not joined, one before the other: together they cover
 * less than the slave. */
TEST(masters_apart_hide_each_other) {
  OWN_PAIR p = two_new(2);
  two_add_line(&p, 1, 1, 0, 1, 0);
  for (int k = 0; k < 2; ++k) {
    const int first = p.m.n_node;
    two_add_line(&p, 0, 1, 0.3, 0.7, 0);
    for (int i = first; i < p.m.n_node; ++i)
      p.m.x[2 * i + 1] = k == 0 ? -0.3 : -0.1;
  }
  OWNED mortar *m = two_couple(&p);
  ck_assert_int_eq(m->n, 2);
  ck_assert_double_eq_tol(m->covered, 0.4, 1e-15);
  for (int q = 0; q < 2; ++q)
    ck_assert_double_eq_tol(m->gap[2 * q + 1], -0.1, 1e-14);
}

/* Nothing is a partner beyond the diagonal of the master, 1.02 long, wherever
 * the surfaces are. */
TEST(partners_are_within_the_extent_of_the_surfaces) {
  for (int k = 0; k < 6; ++k) {
    OWN_PAIR p = two_new(2);
    const int above = k % 2;
    const double slope = 0.2, middle = hypot(1, slope) * (above ? 1.01 : 0.99);
    two_add_line(&p, 1, 1, 0, 1, 0);
    two_add_line(&p, 0, 1, 0, 1, 0);
    for (int i = 2; i < 4; ++i)
      p.m.x[2 * i + 1] = -middle + slope * (0.5 - p.m.x[2 * i]);
    for (int i = 0; i < 8; ++i) p.m.x[i] += 8 * (k / 2 - 1);
    OWNED mortar *m = two_couple(&p);
    ck_assert_double_eq_tol(m->covered, !above, 1e-15);
  }
}

/* A master inside a plate of thickness 0.15 is the partner of its lower side
 * down to half of it. */
TEST(bodies_overlap_by_half_the_slave) {
  for (int above = 0; above < 2; ++above) {
    OWN_PAIR p = two_new(2);
    const double depth = 0.075 * (above ? 1.01 : 0.99);
    add_plate(&p, 1, 8, (double[]){0, 1, 0, 0.15});
    add_plate(&p, 0, 5, (double[]){-0.5, 1.5, depth - 1, depth});
    OWNED mortar *m = two_couple(&p);
    double below = 0;
    for (int q = 0; q < m->n; ++q)
      if (m->node_id[q] > 0 && m->node_id[q] < 8 &&
          m->normal[2 * q + 1] < -0.99)
        below += m->area[q];
    ck_assert_double_eq_tol(below, above ? 0 : 7.0 / 8, 1e-13);
  }
}

/* Of a folded master, which covers less than the slave, the fold on top. */
TEST(folds_hide_what_is_below) {
  static const double x[4][2] = {
      {0.3, -0.1}, {0, -0.12}, {0.3, -0.2}, {0, -0.4}};
  OWN_PAIR p = two_new(2);
  two_add_line(&p, 1, 1, 0, 1, 0);
  for (int i = 0; i < 4; ++i) two_add_node(&p, x[i][0], x[i][1], 0);
  for (int i = 2; i < 5; ++i) two_add_face(&p, 0, (int[]){i, i + 1});
  OWNED mortar *m = two_couple(&p);
  ck_assert_double_eq_tol(m->covered, 0.3, 1e-15);
}

/* A face of both surfaces does not hide itself, overlapping or apart. */
TEST(faces_of_both_surfaces_are_partners) {
  for (int overlap = 0; overlap < 2; ++overlap) {
    OWN_PAIR p = two_new(2);
    two_add_line(&p, 1, 1, 0, 1, 0);
    two_add_line(&p, 0, 1, 0, 1, 0);
    for (int i = 2; i < 4; ++i) p.m.x[2 * i + 1] = overlap ? 0.05 : -0.05;
    p.slave[p.in.n_slave++] = p.master[0];
    OWNED mortar *m = two_couple(&p);
    ck_assert_double_eq_tol(m->covered, 1, 1e-15);
  }
}

/* A plate 0.4 thick of four layers of elements, at rest half as thick: a master
 * inside it is a partner, across layers too; its back and one behind that are
 * none. */
TEST(masters_behind_the_back_are_no_partners) {
  static const struct {
    double height;
    int is;
  } cases[] = {{0.05, 1}, {0.15, 1}, {0.38, 1}, {0.4, 0}, {0.45, 0}, {0.7, 0}};
  enum { LAYERS = 4 };
  for (int k = 0; k < 6; ++k) {
    int elem[6 * LAYERS], face_elem[2] = {0, -1};
    double now[2 * (2 * LAYERS + 4)];
    OWN_PAIR p = two_new(2);
    for (int i = 0; i <= LAYERS; ++i) {
      const int a = two_add_node(&p, 0, 0.1 * i, 0);
      const int b = two_add_node(&p, 1, 0.1 * i, 0);
      if (i < LAYERS)
        memcpy(elem + 6 * i, (int[]){a, b, b + 2, a, b + 2, a + 2},
               6 * sizeof *elem);
    }
    two_add_face(&p, 1, (int[]){0, 1});
    int master[2] = {2 * LAYERS + 1, 2 * LAYERS};
    for (int i = 0; i < 2 && cases[k].height != 0.4; ++i)
      master[i] = two_add_node(&p, 1 - i, cases[k].height, 0);
    two_add_face(&p, 0, master);
    p.m.n_elem = 2 * LAYERS;
    p.m.elem = elem;
    p.m.face_elem = face_elem;
    memcpy(now, p.m.x, sizeof now);
    for (int i = 0; i < p.m.n_node; ++i) p.m.x[2 * i + 1] *= 0.5;
    p.in.x = now;
    p.in.flat = 1;
    OWNED mortar *m = two_couple(&p);
    ck_assert_double_eq_tol(m->covered, cases[k].is, 1e-12);
  }
}

UNIT_MAIN("mortar_partner")
