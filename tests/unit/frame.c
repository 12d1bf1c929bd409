/* src/contact/frame.c: orthonormal and oblique frames, fixed directions. */
#include "contact/parts.h"
#include "support/unit.h"

static double entry(int dim, const double *frame, const double *basis, int r,
                    int a) {
  double s = 0;
  for (int c = 0; c < dim; ++c) s += frame[dim * r + c] * basis[dim * a + c];
  return s;
}

/* frame times basis is the unit matrix. */
static void expect_inverse(int dim, const double *frame, const double *basis) {
  for (int r = 0; r < dim; ++r)
    for (int a = 0; a < dim; ++a)
      ck_assert_double_eq_tol(entry(dim, frame, basis, r, a), r == a, 1e-13);
}

static double volume(const double *m) {
  return m[0] * (m[4] * m[8] - m[5] * m[7]) -
         m[1] * (m[3] * m[8] - m[5] * m[6]) +
         m[2] * (m[3] * m[7] - m[4] * m[6]);
}

TEST(one_normal_gives_a_right_handed_orthonormal_frame) {
  unsigned char held[3];
  for (int k = 0; k < 400; ++k) {
    double polar = 0.05 * k, around = 0.37 * k, frame[9], basis[9];
    frame[0] = cos(polar);
    frame[1] = sin(polar) * cos(around);
    frame[2] = sin(polar) * sin(around);
    ck_assert_int_eq(frame_complete(3, 1, 0, frame, held), 0);
    frame_invert(3, 1, frame, basis);
    expect_inverse(3, frame, basis);
    ck_assert_double_eq_tol(volume(frame), 1, 1e-13);
    ck_assert_int_eq(held[0] + held[1] + held[2], 0);
  }
}

TEST(tangent_of_the_plane_is_the_normal_turned_left) {
  double frame[4] = {0, -1};
  unsigned char held[2];
  ck_assert_int_eq(frame_complete(2, 1, 0, frame, held), 0);
  ck_assert_double_eq(frame[2], 1);
  ck_assert_double_eq(frame[3], 0);
}

TEST(fixed_components_leave_the_normal_and_become_tangents) {
  for (unsigned fixed = 1; fixed < 7; ++fixed) {
    double frame[9] = {0.48, -0.6, 0.64};
    unsigned char held[3];
    ck_assert(frame_project(3, fixed, frame) > 0.4);
    ck_assert_int_eq(frame_complete(3, 1, fixed, frame, held), 0);
    ck_assert_int_eq(held[0], 0);
    unsigned found = 0;
    for (int row = 1; row < 3; ++row)
      for (int c = 0; c < 3; ++c)
        if (held[row] && fabs(frame[3 * row + c]) == 1) found |= 1u << c;
    ck_assert_uint_eq(found, fixed);
    for (int c = 0; c < 3; ++c)
      if (fixed >> c & 1) ck_assert(frame[c] == 0);
    expect_inverse(3, frame, frame);
    ck_assert_double_eq_tol(volume(frame), 1, 1e-13);
  }
}

TEST(what_is_left_of_a_fixed_normal_is_measured) {
  double v[3] = {3e-30, 0, 4e-30}, w[2] = {0, 5}, zero[2] = {0, 0};
  ck_assert_double_eq_tol(frame_project(3, 4, v), 0.6, 1e-15);
  ck_assert_double_eq(v[0], 1);
  ck_assert_double_eq(v[2], 0);
  ck_assert_double_eq(frame_project(2, 2, w), 0);
  ck_assert_double_eq(frame_project(2, 0, zero), 0);
}

TEST(corner_frames_are_inverted) {
  double two[4] = {0.6, -0.8, 0, 1}, basis[9];
  double edge[9] = {0, -1, 0, 0.8, 0, -0.6};
  double corner[9] = {0, -1, 0, 0.8, 0, -0.6, 0.36, 0.48, 0.8};
  unsigned char held[3];
  ck_assert_int_eq(frame_complete(2, 2, 0, two, held), 0);
  frame_invert(2, 0, two, basis);
  expect_inverse(2, two, basis);
  ck_assert_int_eq(frame_complete(3, 2, 0, edge, held), 0);
  frame_invert(3, 0, edge, basis);
  expect_inverse(3, edge, basis);
  ck_assert_double_eq_tol(hypot(edge[6], edge[8]), 1, 1e-15);
  ck_assert_int_eq(frame_complete(3, 3, 0, corner, held), 0);
  frame_invert(3, 0, corner, basis);
  expect_inverse(3, corner, basis);
}

TEST(edge_along_a_fixed_axis_is_held_along_it) {
  double edge[9] = {0, -1, 0, 0.6, 0.8, 0};
  unsigned char held[3];
  ck_assert_int_eq(frame_complete(3, 2, 4, edge, held), 0);
  ck_assert_int_eq(held[2], 1);
  ck_assert_double_eq(fabs(edge[8]), 1);
}

TEST(dependent_normals_are_refused) {
  double same[4] = {0, 1, 0, 1}, opposite[9] = {0, 0, 1, 0, 0, -1};
  double flat[9] = {1, 0, 0, 0, 1, 0, 0.6, 0.8, 0};
  double caught[9] = {0, 1, 0, 0, -1, 0};
  unsigned char held[3];
  ck_assert_int_eq(frame_complete(2, 2, 0, same, held), -1);
  ck_assert_int_eq(frame_complete(3, 2, 0, opposite, held), -1);
  ck_assert_int_eq(frame_complete(3, 3, 0, flat, held), -1);
  ck_assert_int_eq(frame_complete(3, 2, 5, caught, held), -1);
}

/* Faces from x = 0, lengths in the ratio "grow", on a parabola or a slope. */
TEST(parabola_bends_at_its_axis_a_slope_does_not) {
  static const double grow[] = {0.25, 1.0, 4.0};
  for (int k = 0; k < 6; ++k) {
    double x[10] = {0.0}, n[3], h = 0.1;
    int face[8], id[4];
    for (int i = 0; i < 4; ++i, h *= grow[k / 2]) {
      x[2 * i + 2] = x[2 * i] + h;
      x[2 * i + 3] = 0.1 * (k % 2 ? x[2 * i + 2] : pow(x[2 * i + 2], 2));
      face[2 * i] = i, face[2 * i + 1] = i + 1, id[i] = i;
    }
    const mesh m = {.dim = 2, .n_node = 5, .x = x, .n_face = 4, .face = face};
    const mesh_group g = {.dim = 1, .n_item = 4, .item_id = id};
    mesh_face_normal(&m, 0, n);
    ck_assert_int_eq(mirrors_bend(&m, &g, 0, 1, n), k % 2 == 0);
    ck_assert_int_eq(mirrors_bend(&m, &g, 0, 3, n), 0);
  }
}

UNIT_MAIN("frame")
