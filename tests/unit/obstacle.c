/* src/contact/obstacle.c: the gap against points made on the obstacle. */
#include "contact/obstacle.h"
#include "support/formula.h"
#include "support/unit.h"

static double random_part(void) {
  static unsigned long long state = 88172645463325252ull;
  state ^= state << 13;
  state ^= state >> 7;
  state ^= state << 17;
  return (double)(state >> 11) / 9007199254740992.0 * 2 - 1;
}

static void random_unit(int dim, double *v) {
  double s;
  do {
    s = 0;
    for (int c = 0; c < 3; ++c) {
      v[c] = c < dim ? random_part() : 0.0;
      s += v[c] * v[c];
    }
  } while (s < 0.01 || s > 1);
  for (int c = 0; c < 3; ++c) v[c] /= sqrt(s);
}

/* Start from a point q of the obstacle, whose normal towards the body is w, and
 * step back by s along n: the gap at q - s n is s. */
static void expect_gap(const obstacle *o, int dim, const double *q,
                       const double *n, double s) {
  double x[3];
  for (int c = 0; c < 3; ++c) x[c] = q[c] - s * n[c];
  ck_assert_double_eq_tol(obstacle_gap(o, dim, x, n, 0), s, 1e-11);
}

TEST(plane_is_met_where_it_was_left) {
  for (int k = 0; k < 500; ++k) {
    int dim = 2 + k % 2;
    obstacle o = {.shape = OBSTACLE_PLANE};
    double n[3], q[3], a[3];
    random_unit(dim, o.direction);
    random_unit(dim, n);
    double facing = dot(3, n, o.direction);
    if (fabs(facing) < 0.1) continue;
    for (int c = 0; c < dim; ++c) {
      o.point[c] = 3 * random_part();
      a[c] = random_part();
    }
    for (int c = dim; c < 3; ++c) a[c] = 0;
    double off = dot(3, a, o.direction);
    for (int c = 0; c < 3; ++c) q[c] = o.point[c] + a[c] - off * o.direction[c];
    if (facing < 0)
      expect_gap(&o, dim, q, n, 2 * random_part());
    else
      ck_assert(obstacle_gap(&o, dim, q, n, 0) == HUGE_VAL);
  }
}

/* Normal of the circle at q = centre + radius w towards the body is w outside,
 * -w inside. */
static void round_case(int k) {
  int dim = 2 + k % 2;
  obstacle o = {.shape = k % 3 == 0 ? OBSTACLE_CYLINDER : OBSTACLE_SPHERE,
                .inside = k / 2 % 2,
                .radius = 2 + random_part()};
  double n[3], q[3], w[3];
  random_unit(3, o.direction);
  random_unit(dim, n);
  random_unit(dim, w);
  double slide = 0;
  if (dim == 3 && o.shape == OBSTACLE_CYLINDER) {
    double along = dot(3, w, o.direction);
    for (int c = 0; c < 3; ++c) w[c] -= along * o.direction[c];
    double length = sqrt(dot(3, w, w));
    for (int c = 0; c < 3; ++c) w[c] /= length;
    slide = random_part();
  }
  for (int c = 0; c < 3; ++c) {
    o.point[c] = c < dim ? random_part() : 0.0;
    q[c] = o.point[c] + o.radius * w[c] + slide * o.direction[c];
  }
  double facing = (o.inside ? -1 : 1) * dot(3, n, w);
  if (facing > -0.2) return;
  expect_gap(&o, dim, q, n, 0.3 * fabs(random_part()));
  expect_gap(&o, dim, q, n, -0.1 * fabs(random_part()));
}

TEST(circle_and_sphere_are_met_where_they_were_left) {
  for (int k = 0; k < 2000; ++k) round_case(k);
}

TEST(gap_of_a_disc_above_a_cylinder_by_hand) {
  obstacle o = {.shape = OBSTACLE_CYLINDER, .radius = 5, .point = {0, -5, 0}};
  double down[3] = {0, -1, 0}, up[3] = {0, 1, 0};
  double x[3] = {3, 1, 0}, inside[3] = {3, -2, 0}, beyond[3] = {5.5, 1, 0};
  ck_assert_double_eq_tol(obstacle_gap(&o, 2, x, down, 0), 2, 1e-14);
  ck_assert_double_eq_tol(obstacle_gap(&o, 2, inside, down, 0), -1, 1e-14);
  ck_assert(obstacle_gap(&o, 2, beyond, down, 0) == HUGE_VAL);
  ck_assert(obstacle_gap(&o, 2, x, up, 0) == HUGE_VAL);
  o.inside = 1;
  double in_bore[3] = {3, -6, 0};
  ck_assert_double_eq_tol(obstacle_gap(&o, 2, in_bore, down, 0), 3, 1e-14);
  ck_assert_double_eq_tol(obstacle_gap(&o, 2, in_bore, up, 0), 5, 1e-14);
  ck_assert(obstacle_gap(&o, 2, x, down, 0) == HUGE_VAL);
  ck_assert_double_eq_tol(obstacle_gap(&o, 2, x, up, 0), -2, 1e-14);
}

/* A point that has passed the middle of a circle: how far it has come. */
TEST(gap_of_a_deep_point_is_back_to_where_it_entered) {
  const obstacle o = {.shape = OBSTACLE_CYLINDER, .radius = 1};
  const double down[2] = {0, -1};
  for (int k = -1; k <= 1; ++k) {
    const double x[2] = {0, 0.5 * k};
    ck_assert_double_eq_tol(obstacle_gap(&o, 2, x, down, 0), 0.5 * k - 1,
                            1e-15);
  }
}

/* By any of what may depend on time. */
TEST(obstacle_that_depends_on_time_moves) {
  for (int k = 0; k < 6; ++k) {
    obstacle o = {.shape = OBSTACLE_GAP, .turns = 1};
    quantity *q[] = {&o.motion[2], &o.angle, &o.gap};
    formula_compile(q[k / 2], k % 2 ? "t" : "x");
    ck_assert_int_eq(obstacle_moves(&o), k % 2);
    formula_release(q[k / 2]);
  }
}

TEST(line_along_the_axis_misses_the_cylinder) {
  obstacle o = {
      .shape = OBSTACLE_CYLINDER, .radius = 1, .direction = {0, 0, 1}};
  double x[3] = {2, 0, 0}, n[3] = {0, 0, -1}, slant[3] = {-0.6, 0, 0.8};
  ck_assert(obstacle_gap(&o, 3, x, n, 0) == HUGE_VAL);
  ck_assert_double_eq_tol(obstacle_gap(&o, 3, x, slant, 0), 1 / 0.6, 1e-14);
}

/* A tiny gap next to a radius 1e9 times larger keeps its digits. */
TEST(flat_sphere_keeps_the_digits_of_the_gap) {
  obstacle o = {.shape = OBSTACLE_SPHERE, .radius = 1048576};
  o.point[1] = -1048576;
  double down[3] = {0, -1, 0}, x[3] = {0, 0x1p-20, 0};
  ck_assert_double_eq_tol(obstacle_gap(&o, 2, x, down, 0), 0x1p-20, 1e-15);
}

/* Above (1, 0) a circle of radius R that touches (0, 0) is R - sqrt(R^2 - 1)
 * away, which is 1/(2 R) to 16 digits. */
TEST(flat_circle_keeps_the_digits_of_the_gap) {
  static const double radius[] = {1e8, 1e10, 0x1p40};
  for (int k = 0; k < 3; ++k)
    for (int axis = 0; axis < 3; ++axis) {
      obstacle o = {.shape = axis == 2 ? OBSTACLE_SPHERE : OBSTACLE_CYLINDER,
                    .radius = radius[k]};
      double x[3] = {0.0}, n[3] = {0.0};
      o.point[axis] = -radius[k];
      x[(axis + 1) % (axis == 2 ? 3 : 2)] = 1.0;
      n[axis] = -1.0;
      ck_assert_double_eq_tol(
          obstacle_gap(&o, axis == 2 ? 3 : 2, x, n, 0) * 2.0 * radius[k], 1.0,
          1e-12);
      /* The body, or the circle by as much, has come nearer. */
      x[axis] = -1e-5;
      x[(axis + 1) % (axis == 2 ? 3 : 2)] = 0.0;
      ck_assert_double_eq_tol(obstacle_gap(&o, axis == 2 ? 3 : 2, x, n, 0),
                              -1e-5, 1e-19);
    }
}

TEST(lengths_times_a_power_of_two_scale_every_bit) {
  for (int k = 0; k < 300; ++k) {
    int dim = 2 + k % 2, power = k % 81 - 40;
    obstacle a = {.shape = OBSTACLE_PLANE + k % 3, .inside = k % 2}, b;
    double n[3], x[3], far[3];
    random_unit(dim, a.direction);
    random_unit(dim, n);
    a.radius = 1 + fabs(random_part());
    b = a;
    b.radius = ldexp(a.radius, power);
    for (int c = 0; c < 3; ++c) {
      a.point[c] = random_part();
      a.motion[c].number = random_part();
      x[c] = 2 * random_part();
      b.point[c] = ldexp(a.point[c], power);
      b.motion[c].number = ldexp(a.motion[c].number, power);
      far[c] = ldexp(x[c], power);
    }
    double gap = obstacle_gap(&a, dim, x, n, 0);
    ck_assert(obstacle_gap(&b, dim, far, n, 0) == ldexp(gap, power));
  }
}

/* Straight to the obstacle the gap is the distance, and the shortest. */
TEST(normal_of_the_obstacle_is_the_shortest_way_to_it) {
  for (int k = 0; k < 600; ++k) {
    int dim = 2 + k % 2;
    obstacle o = {.shape = OBSTACLE_PLANE + k % 3, .radius = 1};
    double n[3] = {0, 0, 0}, x[3], other[3];
    o.inside = k / 6 % 2;
    random_unit(dim, o.direction);
    random_unit(dim, x);
    for (int c = 0; c < 3; ++c) {
      o.point[c] = c < dim ? random_part() : 0;
      o.motion[c].number = c < dim ? random_part() : 0;
      x[c] = o.point[c] + o.motion[c].number + (o.inside ? 0.7 : 4.2) * x[c];
    }
    ck_assert_int_eq(obstacle_normal(&o, dim, x, n), 1);
    ck_assert_double_eq_tol(dot(3, n, n), 1, 1e-14);
    double distance = obstacle_gap(&o, dim, x, n, 0);
    ck_assert(fabs(distance) < 10);
    if (distance < 0) continue;
    for (int j = 0; j < 20; ++j) {
      random_unit(dim, other);
      ck_assert(fabs(obstacle_gap(&o, dim, x, other, 0)) > distance - 1e-12);
    }
  }
}

TEST(shapes_without_a_normal_leave_it_alone) {
  obstacle o = {.shape = OBSTACLE_CONFORMING};
  double x[3] = {0, 0, 0}, n[3] = {0.6, 0.8, 0};
  ck_assert_int_eq(obstacle_normal(&o, 2, x, n), 0);
  o.shape = OBSTACLE_GAP;
  ck_assert_int_eq(obstacle_normal(&o, 2, x, n), 0);
  o.shape = OBSTACLE_SPHERE;
  o.radius = 1;
  ck_assert_int_eq(obstacle_normal(&o, 2, x, n), 0);
  ck_assert(n[0] == 0.6 && n[1] == 0.8);
}

TEST(obstacle_shifts_with_time) {
  obstacle o = {.shape = OBSTACLE_PLANE, .direction = {0, 1, 0}};
  double down[3] = {0, -1, 0}, x[3] = {7, 2, 0};
  ck_assert_int_eq(obstacle_moves(&o), 0);
  formula_compile(&o.motion[1], "0.25*t");
  ck_assert_int_eq(obstacle_moves(&o), 1);
  ck_assert_double_eq(obstacle_gap(&o, 2, x, down, 4), 1);
  o.shape = OBSTACLE_CONFORMING;
  ck_assert_double_eq(obstacle_gap(&o, 2, x, down, 0), 0);
  ck_assert_double_eq(obstacle_gap(&o, 2, x, down, 4), -1);
  formula_release(&o.motion[1]);
}

/* v = R(a, angle) v by the matrix cos I + sin [a] + (1 - cos) a a'. */
static void rotate(const double *a, double angle, double *v) {
  double w[3], along = dot(3, a, v), k = 1 - cos(angle);
  for (int c = 0; c < 3; ++c) {
    int d = (c + 1) % 3, e = (c + 2) % 3;
    w[c] = cos(angle) * v[c] + sin(angle) * (a[d] * v[e] - a[e] * v[d]) +
           k * along * a[c];
  }
  for (int c = 0; c < 3; ++c) v[c] = w[c];
}

static void any_turn(int dim, obstacle *o) {
  static const double up[3] = {0, 0, 1};
  o->turns = 1;
  o->angle.number = 7 * random_part();
  for (int c = 0; c < dim; ++c) {
    o->pivot[c] = random_part();
    o->motion[c].number = random_part();
  }
  for (int c = 0; c < 3; ++c) o->axis[c] = up[c];
  if (dim == 3) random_unit(3, o->axis);
}

/* The same obstacle, made where the rotation and the shift bring it. */
static obstacle brought(int dim, const obstacle *o) {
  obstacle b = *o;
  double arm[3];
  b.turns = 0;
  for (int c = 0; c < 3; ++c) arm[c] = o->point[c] - o->pivot[c];
  rotate(o->axis, o->angle.number, arm);
  rotate(o->axis, o->angle.number, b.direction);
  for (int c = 0; c < dim; ++c) b.point[c] = o->pivot[c] + arm[c];
  return b;
}

TEST(turned_obstacle_is_the_one_made_there) {
  for (int k = 0; k < 600; ++k) {
    int dim = 2 + k % 2;
    obstacle o = {.shape = OBSTACLE_PLANE + k % 3, .radius = 2};
    double n[3], x[3], normal[3] = {0, 0, 0}, expected[3] = {0, 0, 0};
    any_turn(dim, &o);
    random_unit(dim, o.direction);
    random_unit(dim, n);
    for (int c = 0; c < 3; ++c) {
      o.point[c] = c < dim ? random_part() : 0;
      x[c] = c < dim ? 4 * random_part() : 0;
    }
    obstacle b = brought(dim, &o);
    double gap = obstacle_gap(&b, dim, x, n, 0);
    if (gap < 40)
      ck_assert_double_eq_tol(obstacle_gap(&o, dim, x, n, 0), gap, 1e-10);
    ck_assert_int_eq(obstacle_normal(&o, dim, x, normal), 1);
    ck_assert_int_eq(obstacle_normal(&b, dim, x, expected), 1);
    for (int c = 0; c < dim; ++c)
      ck_assert_double_eq_tol(normal[c], expected[c], 1e-10);
  }
}

/* Turned about the normal by a quarter, x y becomes that of the point (y, -x);
 * tilted by a small angle, the conforming obstacle rises by angle times arm. */
TEST(given_gap_turns_about_the_normal_and_tilts_a_little) {
  obstacle o = {.shape = OBSTACLE_GAP, .turns = 1, .pivot = {1, 2, 0}};
  double down[3] = {0, 0, -1}, x[3] = {4, 7, 0};
  o.axis[2] = 1;
  o.angle.number = acos(-1.0) / 2;
  OWNED expression *e = NULL;
  int column;
  ck_assert_int_eq(expression_compile("x + 10*y", NULL, NULL, &e, &column), OK);
  o.gap.formula = e;
  /* From the pivot (3, 5), a quarter back: (5, -3), so the point (6, -1). */
  ck_assert_double_eq_tol(obstacle_gap(&o, 3, x, down, 0), 6 - 10, 1e-13);
  obstacle c = {.shape = OBSTACLE_CONFORMING, .turns = 1, .axis = {0, 1, 0}};
  for (int k = 0; k < 2; ++k) { /* the height of its arm */
    const double angle = c.angle.number = k ? 0.3 : 1e-6;
    x[2] = 2 * k;
    ck_assert_double_eq_tol(obstacle_gap(&c, 3, x, down, 0),
                            4 * sin(angle) - x[2] * (1 - cos(angle)), 1e-14);
  }
}

/* A roller about its own axis passes by radius times angle, however far and in
 * however many parts it turns; a plane that turns passes in circles. */
TEST(surface_passes_by_angle_times_arm) {
  obstacle o = {.shape = OBSTACLE_CYLINDER,
                .radius = 5,
                .point = {1, -5, 0},
                .pivot = {1, -5, 0},
                .axis = {0, 0, 1},
                .turns = 1};
  double down[3] = {0, -1, 0}, x[3] = {1, 0.25, 0}, d[3];
  o.angle.number = 1;
  obstacle_drift(&o, 2, x, down, 0, 9, d);
  ck_assert(d[0] == 0 && d[1] == 0 && d[2] == 0);
  formula_compile(&o.angle, "-3*t");
  formula_compile(&o.motion[1], "t/100");
  ck_assert_int_eq(obstacle_moves(&o), 1);
  obstacle_drift(&o, 2, x, down, 2, 7, d);
  ck_assert_double_eq_tol(d[0], 3 * 5 * 5, 1e-12);
  ck_assert_double_eq_tol(d[1], 0.05, 1e-14);
  obstacle p = {.shape = OBSTACLE_PLANE, .direction = {0, 0, 1}, .turns = 1};
  p.axis[0] = 1;
  p.angle.formula = o.angle.formula;
  ck_assert_double_eq_tol(obstacle_tilt(&p, 0.25), 0.75, 1e-14);
  OWNED expression *late = NULL;
  int column;
  ck_assert_int_eq(expression_compile("1+t", NULL, NULL, &late, &column), OK);
  p.angle.formula = late;
  ck_assert_double_eq_tol(obstacle_tilt(&p, 0.25), 0.25, 1e-14);
  p.angle.formula = o.angle.formula;
  ck_assert_double_eq(obstacle_tilt(&o, 0.25), 0);
  p.axis[0] = 0;
  double low[3] = {0, 0, -1}, y[3] = {3, 4, 1};
  p.axis[2] = 1;
  ck_assert_double_eq(obstacle_tilt(&p, 0.25), 0);
  obstacle_drift(&p, 3, y, low, 0, 2, d);
  ck_assert_double_eq_tol(d[0], 4 * 6, 1e-12);
  ck_assert_double_eq_tol(d[1], -3 * 6, 1e-12);
  ck_assert_double_eq(d[2], 0);
  formula_release(&o.angle);
  formula_release(&o.motion[1]);
}

/* Moved and turned at once, along and about an axis across the surface: the
 * arm from the axis changes in proportion to the time, so that the way is that
 * of the velocity integrated, and two half steps make one. */
TEST(surface_that_moves_and_turns_passes_by_its_velocity) {
  obstacle o = {.shape = OBSTACLE_PLANE,
                .direction = {0, 0, 1},
                .pivot = {0.5, -0.25, 0},
                .axis = {0, 0, 1},
                .turns = 1};
  const double low[3] = {0, 0, -1}, x[3] = {3, 4, 1}, s = 0.3, t = 1.9;
  double d[3], half[2][3];
  formula_compile(&o.angle, "0.7*t");
  formula_compile(&o.motion[0], "0.4*t");
  formula_compile(&o.motion[1], "-0.9*t");
  obstacle_drift(&o, 3, x, low, s, t, d);
  obstacle_drift(&o, 3, x, low, s, 0.5 * (s + t), half[0]);
  obstacle_drift(&o, 3, x, low, 0.5 * (s + t), t, half[1]);
  for (int c = 0; c < 3; ++c)
    ck_assert_double_eq_tol(d[c], half[0][c] + half[1][c], 1e-13);
  /* v = (0.4, -0.9) + 0.7 (-(y - y_axis), x - x_axis) */
  const double squares = 0.5 * (t * t - s * s);
  ck_assert_double_eq_tol(
      d[0], 0.4 * (t - s) - 0.7 * ((4 + 0.25) * (t - s) + 0.9 * squares),
      1e-13);
  ck_assert_double_eq_tol(
      d[1], -0.9 * (t - s) + 0.7 * ((3 - 0.5) * (t - s) - 0.4 * squares),
      1e-13);
  formula_release(&o.angle);
  formula_release(&o.motion[0]);
  formula_release(&o.motion[1]);
}

/* A parabola that moves sideways is the parabola about its new apex. */
TEST(given_gap_is_that_of_the_point_now_opposite) {
  obstacle o = {.shape = OBSTACLE_GAP};
  double down[3] = {0, -1, 0}, x[3] = {3, 0, 0};
  formula_compile(&o.gap, "x*x/20");
  ck_assert_int_eq(obstacle_moves(&o), 0);
  ck_assert_double_eq_tol(obstacle_gap(&o, 2, x, down, 0), 0.45, 1e-15);
  formula_compile(&o.motion[0], "t");
  quantity sideways = o.motion[0];
  o.motion[1].number = -0.5;
  ck_assert_double_eq_tol(obstacle_gap(&o, 2, x, down, 2), 0.55, 1e-15);
  double slant[3] = {0.6, -0.8, 0};
  o.motion[0].formula = NULL;
  o.motion[0].number = 2 * 0.6;
  o.motion[1].number = 2 * -0.8;
  ck_assert_double_eq_tol(obstacle_gap(&o, 2, x, slant, 0), 2.45, 1e-14);
  formula_release(&o.gap);
  formula_compile(&o.gap, "log(-1-x*x)");
  ck_assert(isnan(obstacle_gap(&o, 2, x, down, 0)));
  formula_release(&o.gap);
  formula_release(&sideways);
}

UNIT_MAIN("obstacle")
