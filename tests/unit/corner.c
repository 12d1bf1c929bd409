/* src/contact/surface.c where a node is in several contacts: corners, obstacles
 * side by side and below one another. */
#include "contact/friction.h"
#include "support/faces.h"
#include "support/formula.h"
#include "support/unit.h"

TEST(corner_on_two_obstacles_has_both_normals) {
  FACE_SCENE c;
  faces_two_sides(&c);
  c.support[1] = (obstacle){
      .name = "GROUND", .shape = OBSTACLE_PLANE, .direction = {0, 1, 0}};
  c.support[1].point[1] = -0.5;
  ck_assert_int_eq(faces_build(&c), OK);
  ck_assert_int_eq(c.s->n, 5);
  static const double frame[] = {-1, 0, 0, -1};
  for (int i = 0; i < 5; ++i) {
    ck_assert_int_eq(c.s->contact_id[i], i > 2);
    ck_assert_int_eq(c.s->side_id[i], i == 2 ? 1 : -1);
    ck_assert_int_eq(surface_is_corner(c.s, i), i == 2);
  }
  for (int k = 0; k < 4; ++k) {
    ck_assert_double_eq(c.s->frame[8 + k], frame[k]);
    ck_assert_double_eq(c.s->basis[8 + k], frame[k]);
  }
  ck_assert_double_eq(c.s->area[2], 0.25);
  double gap[5], side[5];
  ck_assert_int_eq(surface_gap(c.s, &c.in, 0, gap, side), OK);
  ck_assert_double_eq(gap[2], 0);
  ck_assert_double_eq(side[2], 0.5);
  ck_assert_double_eq(gap[3], 0.5);
  ck_assert(side[1] == HUGE_VAL && side[3] == HUGE_VAL);
  double t[2]; /* across the first normal, whatever the second */
  c.s->frame[10] = 0.6, c.s->frame[11] = -0.8;
  surface_tangent(c.s, 2, 1, t);
  ck_assert(t[0] == 0 && t[1] == -1);
  ck_assert_int_eq(faces_said(&c, "P4"), 0);
}

/* The normal force of a corner is that of its first contact, whose averages of
 * the pressure have it alone. */
TEST(corner_presses_in_its_first_contact) {
  const friction_ops *law = &nonlocal_friction;
  char why[160];
  FREED void *param = calloc(1, law->param_size);
  const friction_card card = {.param = param};
  FACE_SCENE c;
  option_defaults(law->options, param);
  ck_assert_int_eq(option_read(option_find(law->options, "RADIUS"), "10.",
                               param, why, sizeof why),
                   0);
  faces_two_sides(&c);
  ck_assert_int_eq(faces_build(&c), OK);
  for (int id = 0; id < 2; ++id) {
    sparse_rows G = {.n = 0};
    int n = 0;
    ck_assert_int_eq(
        law->average(&card, c.s, &c.in, id, &c.pair[id].at, c.log, &G), OK);
    for (int e = 0; e < G.start[G.n]; ++e) n += G.col[e] == 2;
    ck_assert_int_eq(n, id == 0 ? 3 : 0);
    sparse_free(&G);
  }
}

TEST(corner_with_friction_is_warned_about_once) {
  FACE_SCENE c;
  faces_two_sides(&c);
  c.pair[1].friction = 1;
  ck_assert_int_eq(faces_build(&c), OK);
  ck_assert_int_eq(faces_said(&c, "P4005"), 1);
  ck_assert_int_eq(faces_said(&c, "node 1002"), 1);
}

/* A corner whose wall direction is fixed stays on the floor alone. */
TEST(fixed_side_of_a_corner_is_dropped) {
  FACE_SCENE c;
  faces_two_sides(&c);
  c.fixed[2] = 1;
  ck_assert_int_eq(faces_build(&c), OK);
  ck_assert_int_eq(c.s->contact_id[2], 1);
  ck_assert_int_eq(c.s->side_id[2], -1);
  ck_assert_int_eq(c.s->held[5], 1);
  ck_assert_double_eq(c.s->area[2], 0.125);
  ck_assert_int_eq(faces_said(&c, "P4002"), 1);
}

/* One obstacle, one smooth surface: its parts share the node in between, with
 * the mean of their normals by area, (-0.1, -0.5). */
TEST(contacts_side_by_side_on_one_obstacle_are_one_surface) {
  const double length = hypot(0.25, 0.1);
  FACE_SCENE c;
  faces_flat_bottom(&c, 4);
  c.x[1] = 0.1;
  faces_contact(&c, "LEFT", 0, 1);
  faces_contact(&c, "RIGHT", 1, 4);
  c.pair[1].support = c.pair[0].support;
  c.pair[0].friction = c.pair[1].friction = 1;
  ck_assert_int_eq(faces_build(&c), OK);
  ck_assert_int_eq(c.s->n, 5);
  ck_assert_int_eq(c.s->contact_id[1], 0);
  ck_assert_int_eq(c.s->side_id[1], -1);
  ck_assert_double_eq_tol(c.s->area[1], 0.125 + length / 2, 1e-15);
  ck_assert_double_eq_tol(faces_area(c.s), 0.75 + length, 1e-15);
  ck_assert_double_eq_tol(c.s->frame[4], -sqrt(1.0 / 26), 1e-15);
  ck_assert_double_eq_tol(c.s->frame[5], -sqrt(25.0 / 26), 1e-15);
  ck_assert_int_eq(faces_said(&c, "P4"), 0);
}

TEST(parallel_normals_on_two_moving_obstacles_are_an_error) {
  FACE_SCENE c;
  faces_flat_bottom(&c, 4);
  faces_contact(&c, "LEFT", 0, 1);
  faces_contact(&c, "RIGHT", 1, 4);
  formula_compile(&c.support[1].motion[1], "t");
  ck_assert_int_eq(faces_build(&c), ERR_DECK);
  ck_assert_ptr_null(c.s);
  ck_assert_int_eq(faces_said(&c, "P4006"), 1);
  ck_assert_int_eq(faces_said(&c, "node 1001"), 1);
  formula_release(&c.support[1].motion[1]);
}

TEST(obstacles_side_by_side_share_a_node) {
  FACE_SCENE c;
  faces_flat_bottom(&c, 4);
  faces_contact(&c, "LEFT", 0, 1);
  faces_contact(&c, "RIGHT", 1, 4);
  c.group[1].tag = 1;
  ck_assert_int_eq(faces_build(&c), OK);
  ck_assert_int_eq(c.s->contact_id[1], 0);
  ck_assert_int_eq(c.s->side_id[1], -1);
  ck_assert_double_eq(c.s->area[1], 0.25);
  ck_assert_double_eq_tol(faces_area(c.s), 1, 1e-15);
  ck_assert_int_eq(faces_said(&c, "P4"), 0);
}

/* Two slopes below one group, which meet at x = 1/2. */
TEST(of_two_obstacles_at_rest_the_nearer_counts) {
  static const double gap[] = {0, 0.1875, 0.375, 0.1875, 0};
  FACE_SCENE c;
  faces_flat_bottom(&c, 4);
  faces_contact(&c, "LEFT", 0, 4);
  faces_contact(&c, "RIGHT", 0, 4);
  c.support[0] = (obstacle){
      .name = "LEFT", .shape = OBSTACLE_PLANE, .direction = {0.6, 0.8, 0}};
  c.support[1] = (obstacle){.name = "RIGHT",
                            .shape = OBSTACLE_PLANE,
                            .direction = {-0.6, 0.8, 0},
                            .point = {1, 0, 0}};
  ck_assert_int_eq(faces_build(&c), OK);
  for (int i = 0; i < 5; ++i) {
    ck_assert_int_eq(c.s->contact_id[i], i > 2);
    ck_assert_double_eq_tol(c.s->gap0[i], gap[i], 1e-15);
  }
  ck_assert_double_eq_tol(faces_area(c.s), 1, 1e-15);
  ck_assert_int_eq(faces_said(&c, "P4006"), 0);
}

/* The tip of a wedge in a groove, held across it, is on both sides. */
TEST(tip_that_is_held_across_a_groove_stands_in_it) {
  FACE_SCENE c;
  faces_begin(&c, 2);
  faces_node(&c, -1, 1, 0);
  faces_node(&c, 0, 0, 0);
  faces_node(&c, 1, 1, 0);
  for (int i = 0; i < 2; ++i) faces_face(&c, i, i + 1, 0);
  faces_contact(&c, "LEFT", 0, 1);
  faces_contact(&c, "RIGHT", 1, 2);
  c.group[1].tag = 1;
  c.fixed[1] = 1;
  ck_assert_int_eq(faces_build(&c), OK);
  ck_assert_int_eq(c.s->side_id[1], -1);
  ck_assert_double_eq_tol(c.s->frame[4], 0, 1e-15);
  ck_assert_double_eq_tol(c.s->frame[5], -1, 1e-15);
  ck_assert_double_eq_tol(c.s->area[1], sqrt(2), 1e-15);
}

/* A slab between two rollers that come nearer, its whole surface in contact
 * with both: each side is with the roller that it faces. */
TEST(of_two_obstacles_that_behind_the_body_is_none) {
  static const double radius[] = {2.9, 0.52}, away[] = {3, 0.2};
  for (int near = 0; near < 2; ++near) {
    FACE_SCENE c;
    faces_begin(&c, 2);
    for (int i = 0; i < 4; ++i) faces_node(&c, i == 1 || i == 2, i / 2, 0);
    faces_face(&c, 0, 1, 0);
    faces_face(&c, 2, 3, 0);
    faces_contact(&c, "FOOT", 0, 2);
    faces_contact(&c, "HEAD", 0, 2);
    for (int k = 0; k < 2; ++k) {
      c.support[k] =
          (obstacle){.name = k ? "ABOVE" : "BELOW",
                     .shape = OBSTACLE_CYLINDER,
                     .radius = radius[near],
                     .point = {0.5, k ? 1 + away[near] : -away[near], 0}};
      formula_compile(&c.support[k].motion[1], k ? "-t" : "t");
    }
    ck_assert_int_eq(faces_build(&c), OK);
    ck_assert_int_eq(c.s->n, 4);
    for (int i = 0; i < 4; ++i) {
      ck_assert_int_eq(c.s->contact_id[i], i / 2);
      ck_assert_int_eq(c.s->side_id[i], -1);
      ck_assert_double_eq_tol(
          c.s->gap0[i], away[near] - sqrt(radius[near] * radius[near] - 0.25),
          1e-14);
    }
    ck_assert_int_eq(faces_said(&c, "2 of its nodes"), 2);
    for (int k = 0; k < 2; ++k) formula_release(&c.support[k].motion[1]);
  }
}

/* Not a second contact that adds nothing. */
TEST(faces_twice_at_one_place_are_an_error) {
  FACE_SCENE c;
  faces_flat_bottom(&c, 4);
  faces_contact(&c, "FOOT", 0, 4);
  faces_contact(&c, "TOES", 0, 4);
  ck_assert_int_eq(faces_build(&c), ERR_DECK);
  ck_assert_int_eq(faces_said(&c, "P4006"), 1);
  ck_assert_int_eq(faces_said(&c, "at 5 nodes, the first is node 1000"), 1);
  ck_assert_int_eq(faces_said(&c, "P4010"), 0);
}

/* Corner of a box on three obstacles, one in two contacts; edges on two. */
TEST(cube_corner_stands_on_three_obstacles) {
  face_scene c;
  faces_begin(&c, 3);
  int o = faces_node(&c, 0, 0, 0), x = faces_node(&c, 1, 0, 0);
  int y = faces_node(&c, 0, 1, 0), z = faces_node(&c, 0, 0, 0.5);
  int m = faces_node(&c, 0.5, 0.5, 0);
  faces_face(&c, o, z, y);
  faces_face(&c, o, x, z);
  faces_face(&c, o, y, m);
  faces_face(&c, o, m, x);
  static const char *const name[] = {"X", "Y", "Z", "ZX"};
  for (int k = 0; k < 4; ++k) faces_contact(&c, name[k], k, k + 1);
  c.pair[3].support = c.pair[2].support;
  ck_assert_int_eq(faces_build(&c), OK);
  ck_assert_int_eq(c.s->n, 5);
  for (int k = 0; k < 9; ++k)
    ck_assert_double_eq(c.s->frame[k], k % 4 == 0 ? -1 : 0);
  ck_assert(c.s->side_id[0] == 1 && c.s->side_id[1] == 2);
  ck_assert_int_eq(c.s->contact_id[x], 1);
  ck_assert(c.s->side_id[2 * x] == 3 && c.s->side_id[2 * x + 1] == -1);
  ck_assert_double_eq(fabs(c.s->frame[9 * x + 6]), 1);
  ck_assert_double_eq_tol(c.s->area[0], 0.25 / 3, 1e-16);
  ck_assert_double_eq_tol(c.s->side_area[1], 0.5 / 3, 1e-16);
  faces_end(&c);
}

/* At a corner each row moves with its own obstacle. */
TEST(corner_moves_with_both_obstacles) {
  FACE_SCENE c;
  double gap[5], side[5], motion[10] = {0};
  faces_two_sides(&c);
  formula_compile(&c.support[0].motion[0], "-3*t");
  formula_compile(&c.support[1].motion[1], "2*t");
  ck_assert_int_eq(faces_build(&c), OK);
  ck_assert_int_eq(surface_gap(c.s, &c.in, 0.5, gap, side), OK);
  surface_drift(c.s, &c.in, 0, 0.5, motion);
  ck_assert_double_eq(gap[2], 1.5);
  ck_assert_double_eq(side[2], -1);
  ck_assert_double_eq(motion[4], 1.5);
  ck_assert_double_eq(motion[5], -1);
  formula_release(&c.support[0].motion[0]);
  formula_release(&c.support[1].motion[1]);
}

/* A plane that turns passes a side by the arm to where the normal of the side
 * meets it: straight below the corner, 1 from the pivot. */
TEST(side_of_a_corner_moves_where_its_own_normal_meets) {
  FACE_SCENE c;
  double motion[10] = {0};
  faces_two_sides(&c);
  c.support[1] = (obstacle){.name = "GROUND",
                            .shape = OBSTACLE_PLANE,
                            .point = {0, -0.5, 0},
                            .direction = {0, 1, 0},
                            .turns = 1,
                            .pivot = {1, -0.5, 0},
                            .axis = {0, 0, 1}};
  formula_compile(&c.support[1].angle, "-t");
  ck_assert_int_eq(faces_build(&c), OK);
  surface_drift(c.s, &c.in, 0, 0.25, motion);
  ck_assert_double_eq(motion[5], -0.25);
  formula_release(&c.support[1].angle);
}

UNIT_MAIN("corner")
