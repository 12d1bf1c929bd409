/*
 * src/effects/errors/sides.c: normals of the surface that the faces of a mesh
 * stand for.
 */
#include "effects/shared.h"
#include "support/grid.h"
#include "support/unit.h"

enum { NODES = 6, X = 1, Y = 2 };

/* Its floor is two chords, 1 and 2 long, of slopes a and b; its ends are
 * upright. */
typedef struct floor_case {
  double a, b;
  unsigned char held[NODES]; /* X, Y; nodes 0 to 2 are those of the floor */
  int node;
  double slope; /* whose normal it has, as on face 1 */
} floor_case;

static void check_normal(const floor_case *f) {
  OWNED mesh *m = make_grid_2d((int[]){2, 1}, (double[]){3.0, 3.0});
  unsigned char fixed[2 * NODES];
  run r = {.msh = m};
  smooth_faces rings;
  double own[3] = {0.0}, n[3];
  const double way[] = {0.0, f->a, f->b};
  for (int i = 1; i < 3; ++i)
    for (int c = 0; c < 2; ++c)
      m->x[2 * i + c] =
          m->x[2 * i + c - 2] + i * (c == 0 ? cos(way[i]) : sin(way[i]));
  m->x[2 * 5] = m->x[2 * 2];
  for (int k = 0; k < 2 * NODES; ++k) fixed[k] = f->held[k / 2] >> k % 2 & 1;
  r.body.d.fixed = fixed;
  ck_assert_int_eq(smooth_faces_new(m, &rings), OK);
  own[0] = sin(f->b);
  own[1] = -cos(f->b);
  smooth_normal(&r, &rings, f->node, own, n);
  ck_assert_double_eq_tol(n[0], sin(f->slope), 1e-14);
  ck_assert_double_eq_tol(n[1], -cos(f->slope), 1e-14);
  RELEASE(rings.start, rings.face);
}

TEST(smooth_normals_are_means_but_at_corners) {
  const double a = 0.1, b = 0.3;
  /* Of two normals, as on a circle: that of half the length counts twice. */
  const double mean = atan2(2 * sin(a) + sin(b), 2 * cos(a) + cos(b));
  check_normal(&(floor_case){a, b, {0}, 1, mean});
  check_normal(&(floor_case){-0.4, b, {0}, 1, b});
  check_normal(&(floor_case){a, b, {0}, 2, b});
}

/* Of planes that hold the end along their normals, unless the surface meets
 * them at an edge. */
TEST(smooth_normals_lie_in_planes_of_symmetry) {
  const double b = 0.2;
  check_normal(&(floor_case){b, b, {[2] = X, [5] = X}, 2, 0.0});
  check_normal(&(floor_case){b, 0.3, {[2] = X, [5] = X}, 2, 0.3});
  check_normal(&(floor_case){b, b, {[2] = X | Y, [5] = X}, 2, 0.0});
  check_normal(&(floor_case){b, b, {[2] = X | Y, [5] = X | Y}, 2, b});
  /* Neither face is held along its normal. */
  check_normal(&(floor_case){b, b, {[1] = X, [2] = X | Y, [5] = Y}, 2, b});
}

UNIT_MAIN("smooth")
