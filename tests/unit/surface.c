/* src/contact/surface.c on boundary meshes made by hand: closed forms of areas,
 * normals and gaps, corners, fixed nodes and every message. */
#include "support/faces.h"
#include "support/formula.h"
#include "support/unit.h"

TEST(areas_of_a_polyline_are_half_sums_times_thickness) {
  FACE_SCENE c;
  faces_begin(&c, 2);
  static const double x[][2] = {{0, 0}, {3, 4}, {3, 6}, {11, 12}};
  for (int i = 0; i < 4; ++i) faces_node(&c, x[i][0], x[i][1], 0);
  for (int i = 0; i < 3; ++i) faces_face(&c, i, i + 1, 0);
  c.weight[0] = c.weight[1] = 2;
  c.weight[2] = 0.5;
  faces_contact(&c, "FOOT", 0, 3);
  ck_assert_int_eq(faces_build(&c), OK);
  static const double area[] = {5, 5 + 2, 2 + 2.5, 2.5};
  for (int i = 0; i < 4; ++i) ck_assert_double_eq(c.s->area[i], area[i]);
  ck_assert_uint_eq(c.s->node_no[3], 1003);
}

/* Only faces of the group count: the rest of the boundary has no share. */
TEST(faces_outside_the_group_have_no_share) {
  FACE_SCENE c;
  faces_flat_bottom(&c, 4);
  faces_contact(&c, "FOOT", 1, 3);
  ck_assert_int_eq(faces_build(&c), OK);
  ck_assert_int_eq(c.s->n, 3);
  ck_assert_int_eq(c.s->node_id[0], 1);
  ck_assert_double_eq(c.s->area[0], 0.125);
  ck_assert_double_eq(faces_area(c.s), 0.5);
}

/* Simpson's rule is exact for the quadratic phi(s) 2 pi r(s). */
static double ring_share(double r0, double r1, double length, int end) {
  double pi = acos(-1), middle = 0.5 * 2 * pi * 0.5 * (r0 + r1);
  return length / 6 * (4 * middle + 2 * pi * (end ? r1 : r0));
}

TEST(axisymmetric_areas_are_integrals_around_the_axis) {
  FACE_SCENE c;
  double pi = acos(-1);
  faces_begin(&c, 2);
  c.in.axisymmetric = 1;
  faces_node(&c, 0, 0, 0);
  faces_node(&c, 3, 4, 0);
  faces_node(&c, 4, 4, 0);
  faces_face(&c, 0, 1, 0);
  faces_face(&c, 1, 2, 0);
  faces_contact(&c, "FOOT", 0, 2);
  ck_assert_int_eq(faces_build(&c), OK);
  double cone = ring_share(0, 3, 5, 1), ring = ring_share(3, 4, 1, 0);
  ck_assert_double_eq_tol(c.s->area[0], ring_share(0, 3, 5, 0), 1e-12);
  ck_assert_double_eq_tol(c.s->area[1], cone + ring, 1e-12);
  ck_assert_double_eq_tol(c.s->area[2], ring_share(3, 4, 1, 1), 1e-12);
  ck_assert_double_eq_tol(faces_area(c.s), pi * 3 * 5 + pi * (16 - 9), 1e-12);
  double nx = cone * 0.8, ny = -cone * 0.6 - ring, l = hypot(nx, ny);
  ck_assert_double_eq_tol(c.s->frame[4], nx / l, 1e-14);
  ck_assert_double_eq_tol(c.s->frame[5], ny / l, 1e-14);
}

/* Regular polygon: normals are radial, by symmetry. */
TEST(normals_of_a_circle_are_radial) {
  enum { K = 48 };
  FACE_SCENE c;
  double pi = acos(-1), shift = 1e4;
  faces_begin(&c, 2);
  for (int i = 0; i < K; ++i)
    faces_node(&c, shift + cos(2 * pi * i / K), -shift + sin(2 * pi * i / K),
               0);
  for (int i = 0; i < K; ++i) faces_face(&c, i, (i + 1) % K, 0);
  faces_contact(&c, "DISC", 0, K);
  ck_assert_int_eq(faces_build(&c), OK);
  ck_assert_int_eq(c.s->n, K);
  for (int i = 0; i < K; ++i) {
    const double *f = &c.s->frame[4 * i];
    ck_assert_double_eq_tol(f[0], cos(2 * pi * i / K), 1e-10);
    ck_assert_double_eq_tol(f[1], sin(2 * pi * i / K), 1e-10);
    ck_assert(f[2] == -f[1] && f[3] == f[0]);
  }
  ck_assert_double_eq_tol(faces_area(c.s), 2 * K * sin(pi / K), 1e-9);
}

TEST(normals_and_areas_of_an_octahedron) {
  face_scene c;
  double pi = acos(-1);
  faces_begin(&c, 3);
  for (int k = 0; k < 4; ++k)
    faces_node(&c, 2 * cos(k * pi / 2), 2 * sin(k * pi / 2), 0);
  int top = faces_node(&c, 0, 0, 2), low = faces_node(&c, 0, 0, -2);
  for (int k = 0; k < 4; ++k) {
    faces_face(&c, k, (k + 1) % 4, top);
    faces_face(&c, (k + 1) % 4, k, low);
  }
  faces_contact(&c, "BALL", 0, 8);
  ck_assert_int_eq(faces_build(&c), OK);
  double face = sqrt(3) / 4 * 8;
  for (int i = 0; i < 6; ++i) {
    ck_assert_double_eq_tol(c.s->area[i], 4 * face / 3, 1e-13);
    for (int k = 0; k < 3; ++k)
      ck_assert_double_eq_tol(c.s->frame[9 * i + k], c.s->x[3 * i + k] / 2,
                              1e-15);
  }
  faces_end(&c);
}

/* A tilted plane cut into unequal triangles has one normal, far from the
 * origin too. */
TEST(plane_has_one_normal_whatever_its_triangles) {
  enum { K = 9 };
  FACE_SCENE c;
  faces_begin(&c, 3);
  for (int j = 0; j < K; ++j)
    for (int i = 0; i < K; ++i) {
      double a = 1e5 + i * i, b = 0.3 * j + 0.02 * i * j;
      faces_node(&c, 0.6 * a, b, 0.8 * a);
    }
  for (int j = 0; j + 1 < K; ++j)
    for (int i = 0; i + 1 < K; ++i) {
      int p = K * j + i;
      faces_face(&c, p, p + 1, p + K + 1);
      faces_face(&c, p, p + K + 1, p + K);
    }
  faces_contact(&c, "SLOPE", 0, c.m.n_face);
  ck_assert_int_eq(faces_build(&c), OK);
  for (int i = 0; i < c.s->n; ++i) {
    ck_assert_double_eq_tol(c.s->frame[9 * i], -0.8, 1e-9);
    ck_assert_double_eq_tol(c.s->frame[9 * i + 1], 0, 1e-9);
    ck_assert_double_eq_tol(c.s->frame[9 * i + 2], 0.6, 1e-9);
  }
}

/* A square of two triangles: a third of either is that of the tied corner. */
TEST(area_of_a_tied_corner_is_shared_by_the_others) {
  static const double area[] = {0.25, 0.5, 0.25};
  int tied = 0;
  size_t start[2] = {0, 0};
  FACE_SCENE c;
  faces_begin(&c, 3);
  for (int i = 0; i < 4; ++i) faces_node(&c, i % 3 > 0, i > 1, 0);
  faces_face(&c, 0, 1, 2);
  faces_face(&c, 0, 2, 3);
  faces_contact(&c, "LID", 0, 2);
  c.in.ties = &(tie_set){1, &tied, {.dim = 3, .n = 1, .start = start}, NULL};
  ck_assert_int_eq(faces_build(&c), OK);
  ck_assert_int_eq(c.s->n, 3);
  for (int i = 0; i < 3; ++i)
    ck_assert_double_eq_tol(c.s->area[i], area[i], 1e-15);
}

TEST(fixed_direction_is_held_as_tangent) {
  FACE_SCENE c;
  faces_flat_bottom(&c, 4);
  c.x[2 * 4 + 1] = 0.1;
  c.fixed[4] = c.fixed[faces_node(&c, 1, 1, 0)] = 1;
  faces_contact(&c, "FOOT", 0, 4);
  ck_assert_int_eq(faces_build(&c), OK);
  const double x = 0.1 / hypot(0.1, 0.25), y = -2.5 * x; /* of its face */
  const double both[] = {x, y, 1, 0, 0, 1 / y, 1, -x / y};
  for (int k = 0; k < 8; ++k)
    ck_assert_double_eq_tol((k < 4 ? c.s->frame : c.s->basis)[16 + k % 4],
                            both[k], 1e-15);
  for (int i = 0; i < c.s->n; ++i) {
    ck_assert_int_eq(c.s->held[2 * i], 0);
    ck_assert_int_eq(c.s->held[2 * i + 1], i == 4);
  }
  ck_assert_int_eq(faces_said(&c, "P4"), 0);
}

/* The end of an arc at x = 1: smooth across a plane of symmetry, all of whose
 * nodes are held, two at least; else it leans as its face. */
TEST(held_end_of_an_arc_leans_without_symmetry) {
  const double pi = acos(-1);
  for (int other = 0; other < 3; ++other) { /* none, free, held */
    FACE_SCENE c;
    faces_begin(&c, 2);
    for (int i = -4; i <= 0; ++i)
      faces_node(&c, 1 + sin(i * pi / 12), 1 - cos(i * pi / 12), 0);
    for (int i = 0; i < 4; ++i) faces_face(&c, i, i + 1, 0);
    if (other > 0) c.fixed[faces_node(&c, 1, 2, 0)] = other > 1;
    c.fixed[4] = 1;
    faces_contact(&c, "ARC", 0, 4);
    ck_assert_int_eq(faces_build(&c), OK);
    ck_assert_double_eq_tol(c.s->frame[16], other > 1 ? 0 : -sin(pi / 24),
                            1e-15);
  }
}

TEST(nodes_fixed_along_the_normal_are_left_out_and_named) {
  FACE_SCENE c;
  faces_flat_bottom(&c, 4);
  c.x[2 * 2 + 1] = 1e-9;
  c.fixed[0] = 2;
  c.fixed[2] = 2;
  c.fixed[4] = 3;
  faces_contact(&c, "FOOT", 0, 4);
  ck_assert_int_eq(faces_build(&c), OK);
  ck_assert_int_eq(c.s->n, 2);
  ck_assert_int_eq(c.s->node_id[0], 1);
  ck_assert_int_eq(c.s->node_id[1], 3);
  ck_assert_int_eq(message_count(c.log, WARNING), 1);
  ck_assert_int_eq(faces_said(&c, "P4002"), 1);
  ck_assert_int_eq(faces_said(&c, "3, the first is node 1000 at (0, 0)"), 1);
}

TEST(gap_is_measured_along_the_normal_of_the_node) {
  FACE_SCENE c;
  faces_flat_bottom(&c, 8);
  faces_contact(&c, "FOOT", 0, 8);
  c.support[0] = (obstacle){.name = "ROLL",
                            .shape = OBSTACLE_CYLINDER,
                            .radius = 2,
                            .point = {0.25, -2.125, 0}};
  ck_assert_int_eq(faces_build(&c), OK);
  for (int i = 0; i < c.s->n; ++i) {
    double a = c.s->x[2 * i] - 0.25;
    ck_assert_double_eq_tol(c.s->gap0[i], 2.125 - sqrt(4 - a * a), 1e-15);
  }
}

TEST(nodes_out_of_reach_are_left_out_with_a_note) {
  FACE_SCENE c;
  faces_flat_bottom(&c, 8);
  faces_contact(&c, "FOOT", 0, 8);
  c.support[0] = (obstacle){.name = "BALL",
                            .shape = OBSTACLE_SPHERE,
                            .radius = 0.3,
                            .point = {0.5, -0.3, 0}};
  ck_assert_int_eq(faces_build(&c), OK);
  ck_assert_int_eq(c.s->n, 5);
  ck_assert_int_eq(message_count(c.log, NOTE), 1);
  ck_assert_int_eq(faces_said(&c, "4 of its nodes"), 1);
}

TEST(contact_that_reaches_nothing_is_an_error) {
  FACE_SCENE c;
  faces_flat_bottom(&c, 4);
  faces_contact(&c, "FOOT", 0, 4);
  c.support[0].shape = OBSTACLE_PLANE;
  c.support[0].direction[1] = -1;
  ck_assert_int_eq(faces_build(&c), ERR_DECK);
  ck_assert_int_eq(faces_said(&c, "P4010"), 1);
}

TEST(penetration_is_told_with_the_deepest_node) {
  FACE_SCENE c;
  faces_flat_bottom(&c, 4);
  c.x[2 * 3 + 1] = -0.25;
  c.x[2 * 1 + 1] = -0.125;
  faces_contact(&c, "FOOT", 0, 4);
  c.support[0].shape = OBSTACLE_PLANE;
  c.support[0].direction[1] = 1;
  ck_assert_int_eq(faces_build(&c), OK);
  ck_assert_int_eq(c.s->n, 5);
  ck_assert(c.s->gap0[3] < -0.2);
  ck_assert_int_eq(faces_said(&c, "P4004"), 1);
  ck_assert_int_eq(faces_said(&c, "node 1003"), 1);
}

TEST(rounding_is_no_penetration) {
  FACE_SCENE c;
  faces_flat_bottom(&c, 4);
  c.x[2 * 3 + 1] = -1e-16;
  faces_contact(&c, "FOOT", 0, 4);
  c.support[0].shape = OBSTACLE_PLANE;
  c.support[0].direction[1] = 1;
  ck_assert_int_eq(faces_build(&c), OK);
  ck_assert_int_eq(faces_said(&c, "P4"), 0);
}

TEST(gap_that_is_no_number_names_the_node) {
  FACE_SCENE c;
  faces_flat_bottom(&c, 4);
  faces_contact(&c, "FOOT", 0, 4);
  c.support[0].shape = OBSTACLE_GAP;
  formula_compile(&c.support[0].gap, "sqrt(0.9 - x)");
  ck_assert_int_eq(faces_build(&c), ERR_DECK);
  ck_assert_int_eq(faces_said(&c, "P4007"), 1);
  ck_assert_int_eq(faces_said(&c, "node 1004 at (1, 0)"), 1);
  formula_release(&c.support[0].gap);
}

TEST(gap_that_ends_to_be_a_number_stops_the_run) {
  FACE_SCENE c;
  double gap[5];
  faces_flat_bottom(&c, 4);
  faces_contact(&c, "FOOT", 0, 4);
  c.support[0].shape = OBSTACLE_GAP;
  formula_compile(&c.support[0].gap, "sqrt(1 + x - t)");
  ck_assert_int_eq(faces_build(&c), OK);
  ck_assert_int_eq(surface_gap(c.s, &c.in, 0.5, gap, NULL), OK);
  ck_assert_double_eq_tol(gap[4], sqrt(1.5), 1e-15);
  ck_assert_int_eq(surface_gap(c.s, &c.in, 1.1, gap, NULL), ERR_DECK);
  ck_assert_ptr_nonnull(strstr(status_message(), "node 1000"));
  formula_release(&c.support[0].gap);
}

/* A plane of slope 3/4 that moves by (t, t/2): the gap along (0, -1) changes by
 * 3/4 t - t/2, the obstacle passes the node by t along x. */
TEST(moving_plane_changes_gap_and_place_of_stick) {
  FACE_SCENE c;
  double gap[5], motion[10] = {0};
  faces_flat_bottom(&c, 4);
  faces_contact(&c, "FOOT", 0, 4);
  c.support[0] = (obstacle){.name = "RAMP",
                            .shape = OBSTACLE_PLANE,
                            .direction = {-0.6, 0.8, 0},
                            .point = {1, -0.5, 0}};
  formula_compile(&c.support[0].motion[0], "t + 4");
  formula_compile(&c.support[0].motion[1], "t/2 + 3");
  ck_assert_int_eq(faces_build(&c), OK);
  ck_assert_int_eq(surface_gap(c.s, &c.in, 0.5, gap, NULL), OK);
  surface_drift(c.s, &c.in, 0, 0.5, motion);
  for (int i = 0; i < 5; ++i) {
    double shift = 0.75 * 0.5 - 0.25;
    ck_assert_double_eq_tol(gap[i], c.s->gap0[i] + shift, 1e-14);
    ck_assert_double_eq_tol(c.s->gap0[i], 0.5 + 0.75 * (1 - c.s->x[2 * i]),
                            1e-14);
    ck_assert_double_eq_tol(motion[2 * i], -0.25, 1e-15);
    ck_assert_double_eq_tol(motion[2 * i + 1], 0.5, 1e-15);
  }
  formula_release(&c.support[0].motion[0]);
  formula_release(&c.support[0].motion[1]);
}

/* A slope on a level plane: along the normal of the body, and straight down. */
TEST(normal_is_that_of_the_obstacle_if_asked_for) {
  for (int of_obstacle = 0; of_obstacle < 2; ++of_obstacle) {
    FACE_SCENE c;
    faces_begin(&c, 2);
    faces_node(&c, 0, 1, 0);
    faces_node(&c, 4, 4, 0);
    faces_face(&c, 0, 1, 0);
    faces_contact(&c, "SLOPE", 0, 1);
    c.support[0].shape = OBSTACLE_PLANE;
    c.support[0].direction[1] = 1;
    c.pair[0].obstacle_normal = of_obstacle;
    ck_assert_int_eq(faces_build(&c), OK);
    double down = of_obstacle ? 1 : 0.8;
    ck_assert_double_eq_tol(c.s->frame[1], -down, 1e-15);
    ck_assert_double_eq_tol(c.s->gap0[1], 4 / down, 1e-14);
    ck_assert_double_eq(c.s->area[0], 2.5);
  }
}

/* A ball that rolls below the body: nodes it does not reach yet stay. */
TEST(nodes_that_a_moving_obstacle_may_reach_stay) {
  FACE_SCENE c;
  double gap[9];
  faces_flat_bottom(&c, 8);
  faces_contact(&c, "FOOT", 0, 8);
  c.support[0] = (obstacle){.name = "BALL",
                            .shape = OBSTACLE_SPHERE,
                            .radius = 0.25,
                            .point = {0, -0.25, 0}};
  formula_compile(&c.support[0].motion[0], "t");
  ck_assert_int_eq(faces_build(&c), OK);
  ck_assert_int_eq(c.s->n, 9);
  ck_assert_int_eq(faces_said(&c, "P4"), 0);
  ck_assert_int_eq(surface_gap(c.s, &c.in, 1, gap, NULL), OK);
  ck_assert_double_eq(gap[8], 0);
  ck_assert_double_eq(gap[0], SURFACE_UNMET * c.m.size);
  formula_release(&c.support[0].motion[0]);
}

TEST(groups_that_are_no_boundary_are_refused) {
  FACE_SCENE c;
  faces_flat_bottom(&c, 4);
  faces_contact(&c, "FOOT", 0, 2);
  faces_contact(&c, "BODY", 2, 4);
  c.face_other[1] = 7;
  c.group[1].dim = 2;
  ck_assert_int_eq(faces_build(&c), ERR_DECK);
  ck_assert_int_eq(faces_said(&c, "P4001"), 2);
}

/* The faces of both sides of a fin, cut in three and in six, cancel but for
 * rounding at the node in their middle. */
TEST(fin_without_thickness_has_no_normal) {
  const double tilt[2][3] = {{0.6, 0.48, 0.64}, {-0.8, 0.36, 0.48}};
  const double at[3][2] = {{1.1, 0.3}, {-0.7, 0.9}, {-0.2, -1.3}};
  FACE_SCENE c;
  faces_begin(&c, 3);
  faces_node(&c, 0, 0, 0);
  for (int k = 0; k < 6; ++k) {
    double x[3];
    for (int d = 0; d < 3; ++d) {
      x[d] = 0;
      for (int e = 0; e < 2; ++e)
        x[d] += 0.5 * tilt[e][d] * (at[k / 2][e] + at[(k + 1) / 2 % 3][e]);
    }
    faces_node(&c, x[0], x[1], x[2]);
  }
  for (int k = 0; k < 6; k += 2) faces_face(&c, 0, 1 + k, 1 + (k + 2) % 6);
  for (int k = 0; k < 6; ++k) faces_face(&c, 0, 1 + (k + 1) % 6, 1 + k);
  faces_contact(&c, "FIN", 0, 9);
  ck_assert_int_eq(faces_build(&c), ERR_DECK);
  ck_assert_int_eq(faces_said(&c, "no outward normal at node 1000"), 1);
}

/* A disc in a bush, its segments of angles 2a and 2b in turn: the mean normal
 * of a node is orthogonal to the line through its neighbours, b - a off the
 * radius. */
TEST(turned_normals_of_a_disc_in_a_bush_are_told) {
  enum { K = 24 };
  const double pi = acos(-1);
  for (int of_obstacle = 0; of_obstacle < 2; ++of_obstacle)
    for (int uneven = 0; uneven < 2; ++uneven) {
      FACE_SCENE c;
      double off = uneven * 0.0625 * pi / K;
      faces_begin(&c, 2);
      for (int i = 0; i < K; ++i) {
        double angle = 2 * pi * i / K + off * (i % 2 ? 1 : -1);
        faces_node(&c, cos(angle), sin(angle), 0);
      }
      for (int i = 0; i < K; ++i) faces_face(&c, i, (i + 1) % K, 0);
      faces_contact(&c, "DISC", 0, K);
      c.support[0] = (obstacle){
          .name = "BUSH", .shape = OBSTACLE_CYLINDER, .inside = 1, .radius = 1};
      c.pair[0].obstacle_normal = of_obstacle;
      ck_assert_int_eq(faces_build(&c), OK);
      PRINTED(text, "up to %.2g rad", 2 * off);
      ck_assert_int_eq(faces_said(&c, text), uneven && !of_obstacle);
      ck_assert_int_eq(faces_said(&c, "P4018"), uneven && !of_obstacle);
    }
}

/* A plane below the end of a flat bottom leans by 0.005 rad, which a node held
 * along the bottom does not see. */
TEST(held_node_sees_no_turned_normal) {
  for (int held = 0; held < 2; ++held) {
    FACE_SCENE c;
    faces_flat_bottom(&c, 2);
    c.fixed[2] = held > 0;
    faces_contact(&c, "FOOT", 0, 2);
    c.support[0] = (obstacle){.name = "SLOPE",
                              .shape = OBSTACLE_PLANE,
                              .point = {1, 0, 0},
                              .direction = {-sin(0.005), cos(0.005), 0}};
    ck_assert_int_eq(faces_build(&c), OK);
    ck_assert_int_eq(faces_said(&c, "up to 0.005 rad"), !held);
    ck_assert_int_eq(faces_said(&c, "P4018"), !held);
  }
}

TEST(sphere_off_the_axis_is_refused) {
  FACE_SCENE c;
  faces_flat_bottom(&c, 4);
  c.in.axisymmetric = 1;
  faces_contact(&c, "FOOT", 0, 4);
  c.support[0] = (obstacle){.name = "BALL",
                            .shape = OBSTACLE_SPHERE,
                            .radius = 2,
                            .point = {0.1, -2, 0}};
  ck_assert_int_eq(faces_build(&c), ERR_DECK);
  ck_assert_int_eq(faces_said(&c, "P4009"), 1);
}

/* A curved patch and a sphere, all lengths times 2^power. */
static void curved_patch(face_scene *c, int power) {
  faces_begin(c, 3);
  for (int j = 0; j < 4; ++j)
    for (int i = 0; i < 4; ++i)
      faces_node(c, ldexp(0.3 * i - 0.4, power), ldexp(0.2 * j - 0.3, power),
                 ldexp(0.01 * (i * i + 2 * j * j), power));
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i) {
      int p = 4 * j + i;
      faces_face(c, p, p + 5, p + 1);
      faces_face(c, p, p + 4, p + 5);
    }
  c->m.size = ldexp(1, power);
  faces_contact(c, "PATCH", 0, c->m.n_face);
  c->support[0] = (obstacle){
      .name = "BALL", .shape = OBSTACLE_SPHERE, .radius = ldexp(3, power)};
  c->support[0].point[2] = ldexp(-3.1, power);
  ck_assert_int_eq(faces_build(c), OK);
}

TEST(lengths_times_a_power_of_two_scale_every_bit) {
  static const int powers[] = {-40, -3, 40};
  face_scene a, b;
  curved_patch(&a, 0);
  for (int p = 0; p < 3; ++p) {
    curved_patch(&b, powers[p]);
    ck_assert_int_eq(b.s->n, 16);
    for (int i = 0; i < 16; ++i) {
      ck_assert(b.s->gap0[i] == ldexp(a.s->gap0[i], powers[p]));
      ck_assert(b.s->area[i] == ldexp(a.s->area[i], 2 * powers[p]));
    }
    for (int k = 0; k < 9 * 16; ++k) ck_assert(b.s->frame[k] == a.s->frame[k]);
    faces_end(&b);
  }
  faces_end(&a);
}

TEST(refused_memory_is_reported_and_given_back) {
  long k = 0;
  for (status st = ERR_MEMORY; st != OK;) {
    face_scene c;
    faces_two_sides(&c);
    c.pair[1].friction = 1;
    size_t before = memory_in_use();
    memory_refuse(++k, 0);
    st = faces_build(&c);
    memory_refuse(0, 0);
    ck_assert(st == OK || st == ERR_MEMORY);
    ck_assert_int_eq(st == OK, c.s != NULL);
    if (st != OK && message_count(c.log, WARNING) == 0)
      ck_assert_uint_eq(memory_in_use(), before);
    faces_end(&c);
    ck_assert_uint_le(memory_in_use(), before);
  }
  ck_assert_int_gt(k, 14);
}

UNIT_MAIN("surface")
