/* src/fem/support.c, pieces: free motions by name and by what holds them. */
#include "fem/fem.h"
#include "support/scene.h"
#include "support/stack.h"
#include "support/unit.h"

#define NOTHING HELD_BY_NOTHING
#define FRICTION HELD_BY_FRICTION
#define CONTACT HELD_BY_CONTACT

typedef struct expected {
  motion_hold held_by;
  const char *text;
} expected;

/* The motions of the scene are those listed, in this order. */
static void motions_are(scene *s, const expected *list) {
  OWNED free_motion *found = NULL;
  int n, n_free, wanted = 0;
  while (list[wanted].text != NULL) ++wanted;
  ck_assert_int_eq(
      domain_free_motions(&s->d, HELD_BY_CONTACT, &n_free, &n, &found), OK);
  for (int i = 0; i < n && i < wanted; ++i) {
    ck_assert_str_eq(found[i].text, list[i].text);
    ck_assert_int_eq(found[i].held_by, list[i].held_by);
  }
  ck_assert_int_eq(n, wanted);
  /* Those that nothing, or no friction, resists come first: asked for alone. */
  OWNED free_motion *unheld = NULL;
  int n_unheld, first = 0;
  while (first < n && found[first].held_by <= HELD_BY_TANGENTS) ++first;
  ck_assert_int_eq(n_free, n);
  ck_assert_int_eq(
      domain_free_motions(&s->d, HELD_BY_TANGENTS, &n_free, &n_unheld, &unheld),
      OK);
  ck_assert_int_eq(n_free, n);
  ck_assert_int_eq(n_unheld, first);
  for (int i = 0; i < first; ++i)
    ck_assert_str_eq(unheld[i].text, found[i].text);
}

static scene *square(void) {
  return scene_new(make_grid_2d((int[]){3, 2}, (double[]){3, 2}), PLANE_STRAIN,
                   1);
}

static scene *cube(void) {
  return scene_new(make_grid_3d((int[]){2, 2, 2}, (double[]){2, 2, 2}),
                   SOLID_3D, 1);
}

TEST(free_square_has_three_motions) {
  SCENE *s = square();
  motions_are(s, (expected[]){{NOTHING, "translation along x"},
                              {NOTHING, "translation along y"},
                              {NOTHING, "rotation about (1.5, 1)"},
                              {NOTHING, NULL}});
  OWNED stiffness *k = NULL;
  condensed *c;
  ck_assert_int_eq(stiffness_assemble(&s->d, &k), OK);
  ck_assert_int_eq(condense(k, &s->d, &c), ERR_SINGULAR);
  ck_assert_ptr_null(c);
  ck_assert_ptr_nonnull(strstr(status_message(), "body 1"));
}

TEST(pinned_square_turns_about_the_pin) {
  SCENE *s = square();
  scene_fix_node(s, 3, 0);
  scene_fix_node(s, 3, 1);
  motions_are(
      s, (expected[]){{NOTHING, "rotation about (3, 0)"}, {NOTHING, NULL}});
  scene_fix_node(s, 0, 0); /* along the arm: holds nothing */
  motions_are(
      s, (expected[]){{NOTHING, "rotation about (3, 0)"}, {NOTHING, NULL}});
  scene_fix_node(s, 0, 1);
  motions_are(s, (expected[]){{NOTHING, NULL}});
}

TEST(square_on_rollers_slides) {
  SCENE *s = square();
  scene_fix(s, "TOP", 1);
  motions_are(s,
              (expected[]){{NOTHING, "translation along x"}, {NOTHING, NULL}});
}

TEST(lying_square_is_held_by_contact_and_friction) {
  SCENE *s = square();
  scene_contact(s, "BOTTOM", (double[]){0, -1}, 0);
  motions_are(s, (expected[]){{FRICTION, "translation along x"},
                              {CONTACT, "translation along y"},
                              {CONTACT, "rotation about (1.5, 1)"},
                              {NOTHING, NULL}});
  scene_fix(s, "LEFT", 0);
  s->surface.held[1] = 1; /* its foot is a contact node */
  motions_are(s,
              (expected[]){{CONTACT, "translation along y"}, {NOTHING, NULL}});
}

TEST(one_contact_node_lets_the_body_turn_about_it) {
  SCENE *s = square();
  s->m->group[0].n_node = 1;
  s->m->group[0].node_id[0] = 2;
  scene_contact(s, "BODY", (double[]){0, -1}, 0);
  motions_are(s, (expected[]){{NOTHING, "rotation about (2, 0)"},
                              {FRICTION, "translation along x"},
                              {CONTACT, "translation along y"},
                              {NOTHING, NULL}});
}

/* Normals through one point: only friction resists the turn about it. */
TEST(cap_in_a_socket_turns_by_its_centre) {
  SCENE *s = square();
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
}

TEST(second_obstacle_counts_as_contact_not_friction) {
  SCENE *s = square();
  scene_contact(s, "BOTTOM", (double[]){0, -1}, 0);
  s->surface.side_id[0] = 1; /* the corner also stands against a wall */
  motions_are(s, (expected[]){{CONTACT, "translation along x"},
                              {CONTACT, "translation along y"},
                              {CONTACT, "rotation about (1.5, 1)"},
                              {NOTHING, NULL}});
}

TEST(turned_body_moves_along_its_axis) {
  SCENE *s =
      scene_new(make_grid_2d((int[]){3, 2}, (double[]){3, 2}), AXISYMMETRIC, 1);
  motions_are(s,
              (expected[]){{NOTHING, "translation along y"}, {NOTHING, NULL}});
  scene_fix_node(s, 5, 0);
  motions_are(s,
              (expected[]){{NOTHING, "translation along y"}, {NOTHING, NULL}});
  scene_fix_node(s, 5, 1);
  motions_are(s, (expected[]){{NOTHING, NULL}});
}

TEST(cube_on_an_edge_turns_about_it) {
  SCENE *s = cube();
  for (int i = 0; i < 3; ++i)
    for (int c = 0; c < 3; ++c) scene_fix_node(s, i, c);
  motions_are(s, (expected[]){{NOTHING, "rotation about x through (1, 0, 0)"},
                              {NOTHING, NULL}});
  scene_fix_node(s, 26, 1);
  motions_are(s, (expected[]){{NOTHING, NULL}});
}

TEST(lying_cube_has_three_motions_of_friction_and_three_of_contact) {
  SCENE *s = cube();
  scene_contact(s, "FRONT", (double[]){0, 0, -1}, 0);
  motions_are(s, (expected[]){{FRICTION, "translation along x"},
                              {FRICTION, "translation along y"},
                              {FRICTION, "rotation about z through (1, 1, 1)"},
                              {CONTACT, "translation along z"},
                              {CONTACT, "rotation about x through (1, 1, 1)"},
                              {CONTACT, "rotation about y through (1, 1, 1)"},
                              {NOTHING, NULL}});
}

/* Normals across the velocities of a screw leave just this motion. */
TEST(thread_lets_the_body_screw) {
  SCENE *s = cube();
  scene_contact(s, "BODY", (double[]){1, 0, 0}, 0);
  for (int q = 0; q < s->surface.n; ++q) {
    const double *x = s->surface.x + 3 * q;
    const double v[3] = {-(x[1] - 1), x[0] - 1, 0.2};
    const double across = sqrt(v[1] * v[1] + v[2] * v[2]);
    scene_frame(s, q,
                (double[]){0, v[2] / across, -v[1] / across, 1, 0, 0, 0,
                           v[1] / across, v[2] / across});
  }
  OWNED free_motion *list = NULL;
  int n, n_free;
  ck_assert_int_eq(
      domain_free_motions(&s->d, HELD_BY_CONTACT, &n_free, &n, &list), OK);
  ck_assert_int_eq(n, 6);
  int screws = 0;
  for (int i = 0; i < n; ++i)
    screws +=
        list[i].held_by == HELD_BY_FRICTION &&
        strcmp(list[i].text, "screw motion about z through (1, 1, 1)") == 0;
  ck_assert_int_eq(screws, 1);
}

TEST(units_of_length_change_nothing) {
  static const double unit[] = {1e-9, 1e9, 25.4};
  for (int q = 0; q < 3; ++q) {
    SCENE *s = cube();
    OWNED free_motion *list = NULL;
    int n, n_free;
    for (int i = 0; i < 3 * s->m->n_node; ++i) s->m->x[i] *= unit[q];
    scene_fix(s, "LEFT", 0);
    scene_fix(s, "BOTTOM", 1);
    ck_assert_int_eq(
        domain_free_motions(&s->d, HELD_BY_CONTACT, &n_free, &n, &list), OK);
    ck_assert_int_eq(n, 1);
    ck_assert_str_eq(list[0].text, "translation along z");
  }
}

TEST(second_body_is_named) {
  OWNED mesh *a = make_grid_2d((int[]){2, 2}, (double[]){1, 1});
  SCENE *s = scene_new(grid_join(a, a, (double[]){2, 0}), PLANE_STRAIN, 1);
  OWNED free_motion *list = NULL;
  int n, n_free;
  for (int i = 0; i < 9; ++i) scene_fix_node(s, i, i % 2);
  scene_fix_node(s, 9, 0);
  scene_fix_node(s, 9, 1);
  ck_assert_int_eq(
      domain_free_motions(&s->d, HELD_BY_CONTACT, &n_free, &n, &list), OK);
  ck_assert_int_eq(n, 1);
  ck_assert_int_eq(list[0].body_id, 1);
  ck_assert_uint_eq(list[0].elem_no, 9);
  ck_assert_str_eq(list[0].text, "rotation about (2, 0)");
}

/* Two squares that share one corner: a hinge, one body, two pieces. */
TEST(piece_on_a_hinge_is_found) {
  OWNED mesh *a = make_grid_2d((int[]){2, 2}, (double[]){1, 1});
  mesh *m = grid_join(a, a, (double[]){1, 1});
  for (int k = 3 * a->n_elem; k < 3 * m->n_elem; ++k)
    if (m->elem[k] == 9) m->elem[k] = 8;
  SCENE *s = scene_new(m, PLANE_STRAIN, 1);
  for (int i = 0; i < 3; ++i)
    for (int c = 0; c < 2; ++c) scene_fix_node(s, i, c);
  OWNED free_motion *list = NULL;
  int n, n_free;
  ck_assert_int_eq(
      domain_free_motions(&s->d, HELD_BY_CONTACT, &n_free, &n, &list), OK);
  ck_assert_int_eq(n, 1);
  ck_assert_int_eq(list[0].body_id, 0);
  ck_assert_uint_eq(list[0].elem_no, 9);
  ck_assert_str_eq(list[0].text, "rotation about (1, 1)");
  scene_fix_node(s, 17, 0);
  motions_are(s, (expected[]){{NOTHING, NULL}});
}

/* Squares joined at corners along a diagonal. */
static scene *chain(int n) {
  OWNED mesh *one = make_grid_2d((int[]){1, 1}, (double[]){1, 1});
  mesh *m = make_grid_2d((int[]){1, 1}, (double[]){1, 1});
  for (int b = 1; b < n; ++b) {
    mesh *more = grid_join(m, one, (double[]){b, b});
    for (int k = 3 * m->n_elem; k < 3 * more->n_elem; ++k)
      if (more->elem[k] == 4 * b) more->elem[k] = 4 * b - 1;
    memory_free(m);
    m = more;
  }
  return scene_new(m, PLANE_STRAIN, 1);
}

/* Each piece turns on its own. A pin at the far end takes a turn away where it
 * is in line with all hinges (it resists along the line at most in the second
 * order), else two. */
TESTS(chain_of_pieces_turns_at_every_hinge, 3) {
  enum { PIECES = 20 };
  static const int pin[] = {-1, 4 * PIECES - 1, 4 * PIECES - 2};
  SCENE *s = chain(PIECES);
  OWNED free_motion *list = NULL;
  int n, n_free;
  for (int c = 0; c < 2; ++c) {
    scene_fix_node(s, 0, c);
    scene_fix_node(s, 1, c);
    if (_i > 0) scene_fix_node(s, pin[_i], c);
  }
  ck_assert_int_eq(
      domain_free_motions(&s->d, HELD_BY_CONTACT, &n_free, &n, &list), OK);
  ck_assert_int_eq(n, PIECES - 1 - _i);
  for (int i = 0; i < n; ++i) {
    ck_assert_int_eq(list[i].held_by, HELD_BY_NOTHING);
    ck_assert_int_eq(list[i].body_id, 0);
  }
}

typedef struct joined {
  motion_hold held_by;
  int set_id, body_id;
  const char *text;
} joined;

static void joined_motions_are(const stack *k, const joined *list) {
  OWNED free_motion *found = NULL;
  int n, n_free, wanted = 0;
  while (list[wanted].text != NULL) ++wanted;
  ck_assert_int_eq(
      domain_free_motions(&k->s->d, HELD_BY_CONTACT, &n_free, &n, &found), OK);
  for (int i = 0; i < n && i < wanted; ++i) {
    ck_assert_str_eq(found[i].text, list[i].text);
    ck_assert_int_eq(found[i].held_by, list[i].held_by);
    ck_assert_int_eq(found[i].set_id, list[i].set_id);
    ck_assert_int_eq(found[i].body_id, list[i].body_id);
  }
  ck_assert_int_eq(n, wanted);
}

/* Sides that match and others; either side is the slave. */
static const int sides[][3] = {{3, 3, 3}, {2, 3, 4}, {5, 2, 3}};

TESTS(pair_with_a_supported_body_holds_like_an_obstacle, 6) {
  static const char *const joints[] = {"-P", "-M"};
  stack *k = stack_new(joints[_i % 2], sides[_i / 2], 0);
  stack_fix(k, 0);
  stack_fix(k, 1);
  joined_motions_are(k, (joined[]){{FRICTION, 1, 1, "translation along x"},
                                   {CONTACT, 1, 1, "translation along y"},
                                   {CONTACT, 1, 1, "rotation about (0.5, 1.5)"},
                                   {NOTHING, 0, 0, NULL}});
  stack_free(k);
}

/* Nothing resists what both do together, whatever the gap between them. */
TESTS(pair_of_free_bodies_moves_as_one, 6) {
  static const char *const joints[] = {"-P", "-M"};
  for (int gap = 0; gap < 2; ++gap) {
    stack *k = stack_new(joints[_i % 2], sides[_i / 2], gap / 64.0);
    OWNED free_motion *list = NULL;
    int n, n_free, of[HELD_BY_CONTACT + 1] = {0};
    ck_assert_int_eq(
        domain_free_motions(&k->s->d, HELD_BY_CONTACT, &n_free, &n, &list), OK);
    ck_assert_int_eq(n, 6);
    for (int i = 0; i < n; ++i) {
      ck_assert_int_eq(list[i].set_id, 0);
      ++of[list[i].held_by];
    }
    ck_assert_int_eq(of[HELD_BY_NOTHING], 3);
    ck_assert_int_eq(of[HELD_BY_FRICTION], 1);
    ck_assert_int_eq(of[HELD_BY_CONTACT], 2);
    ck_assert_str_eq(list[0].text, "translation along x");
    ck_assert_str_eq(list[1].text, "translation along y");
    /* about the centre of the first, so that the second moves more */
    ck_assert_str_eq(list[2].text, "rotation about (0.5, 0.5)");
    ck_assert_int_eq(list[2].body_id, 1);
    stack_free(k);
  }
}

/* Two cubes whose nodes match, the lower one held. */
TEST(cube_on_a_cube_is_held_like_on_the_ground) {
  enum { N = 9 };
  OWNED mesh *a = make_grid_3d((int[]){2, 2, 2}, (double[]){2, 2, 2});
  SCENE *s = scene_new(grid_join(a, a, (double[]){0, 0, 2}), SOLID_3D, 1);
  size_t start[N + 1];
  int master[N];
  double part[3 * N];
  node_links to = {3, N, start, master, part};
  for (int i = 0; i < N; ++i) {
    for (int c = 0; c < 3; ++c) scene_fix_node(s, i, c);
    s->m->group[0].node_id[i] = a->n_node + i;
    start[i] = (size_t)i;
    master[i] = a->n_node - N + i;
  }
  start[N] = N;
  for (int i = 0; i < 3 * N; ++i) part[i] = 1;
  s->m->group[0].n_node = N;
  scene_contact(s, "BODY", (double[]){0, 0, -1}, 0);
  s->surface.master = &to;
  motions_are(s, (expected[]){{FRICTION, "translation along x"},
                              {FRICTION, "translation along y"},
                              {FRICTION, "rotation about z through (1, 1, 3)"},
                              {CONTACT, "translation along z"},
                              {CONTACT, "rotation about x through (1, 1, 3)"},
                              {CONTACT, "rotation about y through (1, 1, 3)"},
                              {NOTHING, NULL}});
}

/* As of the lips of a crack; the parts sum to 1 but for rounding. */
TEST(pair_within_a_body_holds_nothing) {
  enum { N = 4 };
  SCENE *s = square();
  size_t start[N + 1];
  int master[3 * N];
  double part[6 * N];
  node_links to = {2, N, start, master, part};
  scene_contact(s, "BOTTOM", (double[]){0, -1}, 0);
  for (int q = 0; q <= N; ++q) start[q] = 3 * (size_t)q;
  for (int e = 0; e < 3 * N; ++e) {
    master[e] = s->m->n_node - 1 - e % 3;
    part[2 * e] = part[2 * e + 1] = (double[]){0.7, 0.2, 0.1}[e % 3];
  }
  s->surface.master = &to;
  motions_are(s, (expected[]){{NOTHING, "translation along x"},
                              {NOTHING, "translation along y"},
                              {NOTHING, "rotation about (1.5, 1)"},
                              {NOTHING, NULL}});
}

TESTS(bodies_of_a_pair_on_rollers_slide_together, 3) {
  stack *k = stack_new("-P", sides[_i], 0);
  stack_fix(k, 1);
  joined_motions_are(k, (joined[]){{NOTHING, 0, 0, "translation along x"},
                                   {FRICTION, 0, 0, "translation along x"},
                                   {CONTACT, 0, 1, "translation along y"},
                                   {CONTACT, 0, 1, "rotation about (0.5, 1.5)"},
                                   {NOTHING, 0, 0, NULL}});
  stack_free(k);
}

TESTS(tied_body_is_held_with_its_partner, 3) {
  for (int gap = 0; gap < 2; ++gap) {
    stack *k = stack_new("-TT", sides[_i], gap / 64.0);
    joined_motions_are(k,
                       (joined[]){{NOTHING, 0, 0, "translation along x"},
                                  {NOTHING, 0, 0, "translation along y"},
                                  {NOTHING, 0, 2, "rotation about (0.5, 0.5)"},
                                  {NOTHING, 0, 0, NULL}});
    stack_fix(k, 0);
    stack_fix(k, 1);
    joined_motions_are(k, (joined[]){{NOTHING, 0, 0, NULL}});
    stack_free(k);
  }
}

TESTS(body_on_a_tied_one_that_is_held_is_a_set_alone, 3) {
  stack *k = stack_new("-TP", sides[_i], 0);
  stack_fix(k, 0);
  stack_fix(k, 1);
  joined_motions_are(k, (joined[]){{FRICTION, 2, 2, "translation along x"},
                                   {CONTACT, 2, 2, "translation along y"},
                                   {CONTACT, 2, 2, "rotation about (0.5, 2.5)"},
                                   {NOTHING, 0, 0, NULL}});
  stack_free(k);
}

TESTS(stack_of_three_is_one_set_held_by_contact, 3) {
  stack *k = stack_new("OPP", sides[_i], 0);
  joined_motions_are(k, (joined[]){{FRICTION, 0, 0, "translation along x"},
                                   {FRICTION, 0, 1, "translation along x"},
                                   {FRICTION, 0, 2, "translation along x"},
                                   {CONTACT, 0, 0, "translation along y"},
                                   {CONTACT, 0, 1, "translation along y"},
                                   {CONTACT, 0, 2, "translation along y"},
                                   {CONTACT, 0, 0, "rotation about (0.5, 0.5)"},
                                   {CONTACT, 0, 1, "rotation about (0.5, 1.5)"},
                                   {CONTACT, 0, 2, "rotation about (0.5, 2.5)"},
                                   {NOTHING, 0, 0, NULL}});
  stack_free(k);
}

/* The body in the middle has nothing but its neighbours. */
TESTS(body_without_a_joint_below_is_named, 3) {
  stack *k = stack_new("O-P", sides[_i], 0.25);
  OWNED free_motion *list = NULL;
  int n, n_free;
  stack_fix(k, 0);
  for (int q = 0; q <= k->cells[0]; ++q) k->s->surface.held[2 * q + 1] = 1;
  ck_assert_int_eq(
      domain_free_motions(&k->s->d, HELD_BY_CONTACT, &n_free, &n, &list), OK);
  ck_assert_int_eq(n, 2 + 6);
  for (int i = 0; i < n; ++i) {
    ck_assert_int_eq(list[i].set_id, i < 2 ? 0 : 1);
    ck_assert_int_eq(list[i].held_by == HELD_BY_NOTHING, i >= 2 && i < 5);
  }
  stack_free(k);
}

/* Node 0 alone joins the two, by a tie or by contact; they slide over each
 * other, or turn about it. */
TESTS(bodies_joined_at_the_first_node_alone_are_one_set, 2) {
  OWNED mesh *a = make_grid_2d((int[]){2, 2}, (double[]){1, 1});
  SCENE *s = scene_new(grid_join(a, a, (double[]){-1, -1}), PLANE_STRAIN, 1);
  int at[] = {0}, above[] = {17};
  double part[] = {1, 1};
  node_links to = {2, 1, (size_t[]){0, 1}, above, part};
  const tie_set ties = {1, at, to, NULL};
  OWNED free_motion *list = NULL;
  int n, n_free;
  if (_i == 0) s->d.ties = &ties;
  if (_i == 1) {
    s->m->group[0].n_node = 1;
    s->m->group[0].node_id[0] = 0;
    scene_contact(s, "BODY", (double[]){0, -1}, 0);
    s->surface.master = &to;
  }
  ck_assert_int_eq(
      domain_free_motions(&s->d, HELD_BY_CONTACT, &n_free, &n, &list), OK);
  ck_assert_int_eq(n, _i == 0 ? 4 : 6);
  for (int i = 0; i < n; ++i) {
    ck_assert_int_eq(list[i].set_id, 0);
    ck_assert_int_eq(list[i].held_by, i < 4    ? HELD_BY_NOTHING
                                      : i == 4 ? HELD_BY_FRICTION
                                               : HELD_BY_CONTACT);
  }
}

TEST(every_refused_request_is_survived) {
  stack *k = stack_new("OTP", sides[1], 0);
  scene *s = k->s;
  free_motion *list;
  int n, n_free;
  UNIT_REFUSED(1,
               domain_free_motions(&s->d, HELD_BY_CONTACT, &n_free, &n, &list),
               memory_free(list));
  stack_free(k);
}

UNIT_MAIN("support")
