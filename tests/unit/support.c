/* src/fem/support.c, pieces.c: free motions by name and by what holds them. */
#include "base/memory.h"
#include "fem/fem.h"
#include "support/scene.h"
#include "support/unit.h"

#include <math.h>
#include <string.h>

#define NOTHING HELD_BY_NOTHING
#define FRICTION HELD_BY_FRICTION
#define CONTACT HELD_BY_CONTACT

typedef struct expected {
  motion_hold held_by;
  const char *text;
} expected;

/* The motions of the scene are those listed, in this order. */
static void motions_are(scene *s, const expected *list) {
  free_motion *found;
  int n, wanted = 0;
  while (list[wanted].text != NULL) ++wanted;
  ck_assert_int_eq(domain_free_motions(&s->d, &n, &found), OK);
  for (int i = 0; i < n && i < wanted; ++i) {
    ck_assert_str_eq(found[i].text, list[i].text);
    ck_assert_int_eq(found[i].held_by, list[i].held_by);
  }
  ck_assert_int_eq(n, wanted);
  memory_free(found);
}

static scene *square(void) {
  return scene_new(make_grid_2d((int[]){3, 2}, (double[]){3, 2}), PLANE_STRAIN,
                   1);
}

static scene *cube(void) {
  return scene_new(make_grid_3d((int[]){2, 2, 2}, (double[]){2, 2, 2}),
                   SOLID_3D, 1);
}

START_TEST(free_square_has_three_motions) {
  scene *s = square();
  motions_are(s, (expected[]){{NOTHING, "translation along x"},
                              {NOTHING, "translation along y"},
                              {NOTHING, "rotation about (1.5, 1)"},
                              {NOTHING, NULL}});
  stiffness *k;
  condensed *c;
  ck_assert_int_eq(stiffness_assemble(&s->d, &k), OK);
  ck_assert_int_eq(condense(k, &s->d, &c), ERR_SINGULAR);
  ck_assert_ptr_null(c);
  ck_assert_ptr_nonnull(strstr(status_message(), "body 1"));
  ck_assert_ptr_nonnull(strstr(status_message(), "translation along x"));
  stiffness_free(k);
  scene_free(s);
}
END_TEST

START_TEST(pinned_square_turns_about_the_pin) {
  scene *s = square();
  scene_fix_node(s, 3, 0);
  scene_fix_node(s, 3, 1);
  motions_are(
      s, (expected[]){{NOTHING, "rotation about (3, 0)"}, {NOTHING, NULL}});
  scene_fix_node(s, 0, 0); /* along the arm: holds nothing */
  motions_are(
      s, (expected[]){{NOTHING, "rotation about (3, 0)"}, {NOTHING, NULL}});
  scene_fix_node(s, 0, 1);
  motions_are(s, (expected[]){{NOTHING, NULL}});
  scene_free(s);
}
END_TEST

START_TEST(square_on_rollers_slides) {
  scene *s = square();
  scene_fix(s, "TOP", 1);
  motions_are(s,
              (expected[]){{NOTHING, "translation along x"}, {NOTHING, NULL}});
  scene_free(s);
}
END_TEST

START_TEST(lying_square_is_held_by_contact_and_friction) {
  scene *s = square();
  scene_contact(s, "BOTTOM", (double[]){0, -1}, 0);
  motions_are(s, (expected[]){{FRICTION, "translation along x"},
                              {CONTACT, "translation along y"},
                              {CONTACT, "rotation about (1.5, 1)"},
                              {NOTHING, NULL}});
  scene_fix(s, "LEFT", 0);
  s->surface.held[1] = 1; /* its foot is a contact node */
  motions_are(s,
              (expected[]){{CONTACT, "translation along y"}, {NOTHING, NULL}});
  scene_free(s);
}
END_TEST

START_TEST(one_contact_node_lets_the_body_turn_about_it) {
  scene *s = square();
  s->m->group[0].n_node = 1;
  s->m->group[0].node_id[0] = 2;
  scene_contact(s, "BODY", (double[]){0, -1}, 0);
  motions_are(s, (expected[]){{NOTHING, "rotation about (2, 0)"},
                              {FRICTION, "translation along x"},
                              {CONTACT, "translation along y"},
                              {NOTHING, NULL}});
  scene_free(s);
}
END_TEST

/* Normals through one point: only friction resists the turn about it. */
START_TEST(cap_in_a_socket_turns_by_its_centre) {
  scene *s = square();
  scene_contact(s, "BOTTOM", (double[]){0, -1}, 0);
  for (int q = 0; q < s->surface.n; ++q) {
    const double *x = s->surface.x + 2 * q, dx = x[0] - 1, dy = x[1] - 5;
    const double r = sqrt(dx * dx + dy * dy);
    scene_frame(s, q, (double[]){dx / r, dy / r, -dy / r, dx / r});
  }
  motions_are(s, (expected[]){{FRICTION, "rotation about (1, 5)"},
                              {CONTACT, "translation along x"},
                              {CONTACT, "translation along y"},
                              {NOTHING, NULL}});
  scene_free(s);
}
END_TEST

START_TEST(second_obstacle_counts_as_contact_not_friction) {
  scene *s = square();
  scene_contact(s, "BOTTOM", (double[]){0, -1}, 0);
  s->surface.side_id[0] = 1; /* the corner also stands against a wall */
  motions_are(s, (expected[]){{CONTACT, "translation along x"},
                              {CONTACT, "translation along y"},
                              {CONTACT, "rotation about (1.5, 1)"},
                              {NOTHING, NULL}});
  scene_free(s);
}
END_TEST

START_TEST(turned_body_moves_along_its_axis) {
  scene *s =
      scene_new(make_grid_2d((int[]){3, 2}, (double[]){3, 2}), AXISYMMETRIC, 1);
  motions_are(s,
              (expected[]){{NOTHING, "translation along y"}, {NOTHING, NULL}});
  scene_fix_node(s, 5, 0);
  motions_are(s,
              (expected[]){{NOTHING, "translation along y"}, {NOTHING, NULL}});
  scene_fix_node(s, 5, 1);
  motions_are(s, (expected[]){{NOTHING, NULL}});
  scene_free(s);
}
END_TEST

START_TEST(cube_on_an_edge_turns_about_it) {
  scene *s = cube();
  for (int i = 0; i < 3; ++i)
    for (int c = 0; c < 3; ++c) scene_fix_node(s, i, c);
  motions_are(s, (expected[]){{NOTHING, "rotation about x through (1, 0, 0)"},
                              {NOTHING, NULL}});
  scene_fix_node(s, 26, 1);
  motions_are(s, (expected[]){{NOTHING, NULL}});
  scene_free(s);
}
END_TEST

START_TEST(lying_cube_has_three_motions_of_friction_and_three_of_contact) {
  scene *s = cube();
  scene_contact(s, "FRONT", (double[]){0, 0, -1}, 0);
  motions_are(s, (expected[]){{FRICTION, "translation along x"},
                              {FRICTION, "translation along y"},
                              {FRICTION, "rotation about z through (1, 1, 1)"},
                              {CONTACT, "translation along z"},
                              {CONTACT, "rotation about x through (1, 1, 1)"},
                              {CONTACT, "rotation about y through (1, 1, 1)"},
                              {NOTHING, NULL}});
  scene_free(s);
}
END_TEST

/* Normals across the velocities of a screw leave just this motion. */
START_TEST(thread_lets_the_body_screw) {
  scene *s = cube();
  scene_contact(s, "BODY", (double[]){1, 0, 0}, 0);
  for (int q = 0; q < s->surface.n; ++q) {
    const double *x = s->surface.x + 3 * q;
    const double v[3] = {-(x[1] - 1), x[0] - 1, 0.2};
    const double across = sqrt(v[1] * v[1] + v[2] * v[2]);
    scene_frame(s, q,
                (double[]){0, v[2] / across, -v[1] / across, 1, 0, 0, 0,
                           v[1] / across, v[2] / across});
  }
  free_motion *list;
  int n;
  ck_assert_int_eq(domain_free_motions(&s->d, &n, &list), OK);
  ck_assert_int_eq(n, 6);
  int screws = 0;
  for (int i = 0; i < n; ++i)
    screws +=
        list[i].held_by == HELD_BY_FRICTION &&
        strcmp(list[i].text, "screw motion about z through (1, 1, 1)") == 0;
  ck_assert_int_eq(screws, 1);
  memory_free(list);
  scene_free(s);
}
END_TEST

START_TEST(units_of_length_change_nothing) {
  static const double unit[] = {1e-9, 1e9, 25.4};
  for (int q = 0; q < 3; ++q) {
    scene *s = cube();
    free_motion *list;
    int n;
    for (int i = 0; i < 3 * s->m->n_node; ++i) s->m->x[i] *= unit[q];
    scene_fix(s, "LEFT", 0);
    scene_fix(s, "BOTTOM", 1);
    ck_assert_int_eq(domain_free_motions(&s->d, &n, &list), OK);
    ck_assert_int_eq(n, 1);
    ck_assert_str_eq(list[0].text, "translation along z");
    memory_free(list);
    scene_free(s);
  }
}
END_TEST

START_TEST(second_body_is_named) {
  mesh *a = make_grid_2d((int[]){2, 2}, (double[]){1, 1});
  scene *s = scene_new(grid_join(a, a, (double[]){2, 0}), PLANE_STRAIN, 1);
  free_motion *list;
  int n;
  for (int i = 0; i < 9; ++i) scene_fix_node(s, i, i % 2);
  scene_fix_node(s, 9, 0);
  scene_fix_node(s, 9, 1);
  ck_assert_int_eq(domain_free_motions(&s->d, &n, &list), OK);
  ck_assert_int_eq(n, 1);
  ck_assert_int_eq(list[0].body_id, 1);
  ck_assert_uint_eq(list[0].elem_no, 9);
  ck_assert_str_eq(list[0].text, "rotation about (2, 0)");
  memory_free(list);
  mesh_free(a);
  scene_free(s);
}
END_TEST

/* Two squares that share one corner: a hinge, one body, two pieces. */
START_TEST(piece_on_a_hinge_is_found) {
  mesh *a = make_grid_2d((int[]){2, 2}, (double[]){1, 1});
  mesh *m = grid_join(a, a, (double[]){1, 1});
  for (int k = 3 * a->n_elem; k < 3 * m->n_elem; ++k)
    if (m->elem[k] == 9) m->elem[k] = 8;
  scene *s = scene_new(m, PLANE_STRAIN, 1);
  for (int i = 0; i < 3; ++i)
    for (int c = 0; c < 2; ++c) scene_fix_node(s, i, c);
  free_motion *list;
  int n;
  ck_assert_int_eq(domain_free_motions(&s->d, &n, &list), OK);
  ck_assert_int_eq(n, 1);
  ck_assert_int_eq(list[0].body_id, 0);
  ck_assert_uint_eq(list[0].elem_no, 9);
  ck_assert_str_eq(list[0].text, "rotation about (1, 1)");
  memory_free(list);
  scene_fix_node(s, 17, 0);
  motions_are(s, (expected[]){{NOTHING, NULL}});
  mesh_free(a);
  scene_free(s);
}
END_TEST

START_TEST(every_refused_request_is_survived) {
  scene *s = cube();
  scene_contact(s, "FRONT", (double[]){0, 0, -1}, 0);
  const size_t before = memory_in_use();
  for (long r = 1;; ++r) {
    free_motion *list;
    int n;
    const long seen = memory_requests();
    memory_refuse(r, 0);
    const status st = domain_free_motions(&s->d, &n, &list);
    memory_refuse(0, 0);
    const int reached = memory_requests() - seen >= r;
    ck_assert_int_eq(st, reached ? ERR_MEMORY : OK);
    memory_free(list);
    ck_assert_uint_eq(memory_in_use(), before);
    if (!reached) break;
  }
  scene_free(s);
}
END_TEST

UNIT_MAIN("support", free_square_has_three_motions,
          pinned_square_turns_about_the_pin, square_on_rollers_slides,
          lying_square_is_held_by_contact_and_friction,
          one_contact_node_lets_the_body_turn_about_it,
          cap_in_a_socket_turns_by_its_centre,
          second_obstacle_counts_as_contact_not_friction,
          turned_body_moves_along_its_axis, cube_on_an_edge_turns_about_it,
          lying_cube_has_three_motions_of_friction_and_three_of_contact,
          thread_lets_the_body_screw, units_of_length_change_nothing,
          second_body_is_named, piece_on_a_hinge_is_found,
          every_refused_request_is_survived)
