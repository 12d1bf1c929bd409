/*
 * src/effects/goal/jumps.c, between.c: what goals lack by corners and by forces
 * between the nodes, on surfaces made here, against their closed forms.
 */
#include "effects/goal/parts.h"
#include "support/formula.h"
#include "support/grid.h"
#include "support/unit.h"

enum { MOST = 12 };

/* Contact nodes are those of the floor, which come first in the mesh. */
typedef struct floor_run {
  run r;
  model m;
  contact contact[1];
  step step[1];
  contact_pair pair[1];
  contact_surface s;
  friction_limit limit;
  int node_id[MOST], contact_id[MOST], section[2 * MOST];
  unsigned char fixed[8 * MOST], held[2 * MOST];
  double E[2 * 16], area[MOST], frame[4 * MOST], gap[MOST], slip[MOST];
  double rc[2 * MOST], g0[MOST];
  contact_status status[MOST];
} floor_run;

static const double YOUNG = 1000, NU = 0.3;

static void set_elastic(double young, double *E) {
  const double a = young / ((1 + NU) * (1 - 2 * NU));
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) E[4 * i + j] = a * (i == j ? 1 - NU : NU);
  E[15] = 0.5 * young / (1 + NU);
}

/* n edges, the first ones 1, 2, 1, 2 .. long; pressed by a force 1 at nodes of
 * area 0.5, the friction 0. */
static void floor_new(floor_run *f, int n) {
  *f = (floor_run){0};
  mesh *m = make_grid_2d((int[]){n, 1}, (double[]){n, 1.0});
  for (int i = 0; i <= n; ++i) m->x[2 * i] = m->x[2 * (n + 1 + i)] = i + i / 2;
  f->r = (run){.m = &f->m, .msh = m, .step = f->step, .surface = &f->s};
  f->m = (model){.dim = 2, .contacts = f->contact, .steps = f->step};
  f->m.n.contact = f->m.n.step = 1;
  f->s = (contact_surface){.dim = 2,
                           .n = n + 1,
                           .node_id = f->node_id,
                           .contact_id = f->contact_id,
                           .x = m->x,
                           .area = f->area,
                           .frame = f->frame,
                           .held = f->held};
  for (int k = 0; k < m->n_group; ++k)
    if (strcmp(m->group[k].name, "BOTTOM") == 0) f->pair->group = &m->group[k];
  f->r.faces.pairs = f->pair;
  f->r.nodes.n = n + 1;
  f->r.body.d = (domain){.mesh = m,
                         .ns = 4,
                         .section_id = f->section,
                         .fixed = f->fixed,
                         .E = f->E};
  set_elastic(YOUNG, f->E);
  set_elastic(3 * YOUNG, f->E + 16);
  f->r.problem.gap = f->gap;
  f->r.result.contact = f->status;
  f->r.result.slip = f->slip;
  f->r.now.rc = f->rc;
  for (int q = 0; q <= n; ++q) {
    f->node_id[q] = q;
    f->area[q] = 0.5;
    f->rc[2 * q] = -1.0;
    f->status[q] = CONTACT_STICK;
    f->frame[4 * q + 1] = -1.0;
    f->frame[4 * q + 2] = 1.0;
  }
}

static void floor_end(floor_run *f) { memory_free((mesh *)f->r.msh); }

/* ---- loads that meet ----------------------------------------------------- */

TEST(loads_of_one_stress_are_not_torn) {
  static const double stress[2][2] = {{3.0, 0.7}, {0.7, -2.0}};
  const double n[] = {0.6, 0.8}, m[] = {-0.28, 0.96};
  for (int k = 0; k < 2; ++k) {
    const double scale = k == 0 ? 1.0 : 1e-9;
    side_load p = {.pressure = 5.0 * scale}, q = {.pressure = -4.0 * scale};
    for (int i = 0; i < 2; ++i) {
      p.traction[i] = p.pressure * n[i] +
                      scale * (stress[i][0] * n[0] + stress[i][1] * n[1]);
      q.traction[i] = q.pressure * m[i] +
                      scale * (stress[i][0] * m[0] + stress[i][1] * m[1]);
    }
    ck_assert(!goal_is_torn(2, &p, n, &q, m, 0));
    ck_assert(!goal_is_torn(2, &q, m, &p, n, 0));
    q.traction[0] += 1e-4 * scale;
    ck_assert(goal_is_torn(2, &p, n, &q, m, 0));
    ck_assert(goal_is_torn(2, &p, n, &q, m, 1));
    ck_assert(!goal_is_torn(2, &p, n, &p, m, 1));
  }
}

/* Their difference counts against each of their parts alone. */
TEST(loads_are_torn_by_their_own_size) {
  const double n[] = {0.6, 0.8};
  for (int part = 0; part < 3; ++part)
    for (int k = 0; k < 2; ++k) {
      side_load p = {0}, q = {0};
      double *of[] = {&p.pressure, &p.traction[0], &p.traction[1]};
      double *to[] = {&q.pressure, &q.traction[0], &q.traction[1]};
      *of[part] = 1.0;
      *to[part] = 1.0 + (k == 0 ? 1e-7 : 1e-5);
      ck_assert_int_eq(goal_is_torn(2, &p, n, &q, n, 1), k);
    }
}

/* ---- corners of the gap -------------------------------------------------- */

typedef struct corner_case {
  double slope[MOST]; /* of the gap on edges of the first, n */
  int node;           /* of the corner; -1: none */
  double turn;        /* of the slope there */
  int mirrored, open; /* 1: a plane of symmetry at node 0; this node is open */
  int section;        /* of the elements */
  int is_pair;
} corner_case;

static void set_corner(const corner_case *c, floor_run *f) {
  floor_new(f, 8);
  f->gap[0] = 0.7;
  for (int i = 0; i < 8; ++i)
    f->gap[i + 1] =
        f->gap[i] + c->slope[i] * (f->s.x[2 * i + 2] - f->s.x[2 * i]);
  for (int e = 0; e < f->r.msh->n_elem; ++e) f->section[e] = c->section;
  if (c->mirrored) f->fixed[0] = f->fixed[2 * 9] = f->held[1] = 1;
  if (c->open > 0) f->status[c->open] = CONTACT_OPEN;
  f->contact->is_pair = c->is_pair;
  f->area[3] = 0.25; /* the largest pressure is 4 */
}

static void check_corner(const corner_case *c) {
  floor_run f;
  int where[2 * MOST];
  double corner[MOST] = {0.0}, most;
  set_corner(c, &f);
  for (int i = 0; i < f.r.msh->n_node; ++i) where[i] = i < 9 ? i : -1;
  ck_assert_int_eq(goal_corners(&f.r, where, corner), OK);
  const double young = c->section == 0 ? YOUNG : 3 * YOUNG;
  const double size = young / (1 - NU * NU) / (2 * M_PI) * c->turn / 4.0;
  for (int q = 0; q < 9; ++q) {
    const double is = q == c->node ? size : 0.0;
    ck_assert_double_eq_tol(corner[q], is, 1e-9 * size + 1e-12);
  }
  for (int k = 0; k < 2 && c->node >= 0; ++k) {
    const double x[] = {f.s.x[2 * c->node] + 0.5, f.s.x[2 * c->node + 1]};
    ck_assert_int_eq(goal_sharpest(&f.r, 0, x, k == 0 ? 0.4 : 0.6, &most), OK);
    const double is = k == 0 || size < GOAL_CORNER ? 0.0 : size;
    ck_assert_double_eq_tol(most, is, 1e-9 * size);
  }
  floor_end(&f);
}

static const corner_case corners[] = {
    {{1, 1, 1, 1, 3, 3, 3, 3}, 4, 2.0, 0, 0, 0, 0},
    {{1, 1, 1, 1, 3, 3, 3, 3}, 4, 2.0, 0, 0, 1, 0},
    {{1, 1, 1, 1, 3, 3, 3, 3}, -1, 0, 0, 4, 0, 0},
    {{1, 1, 1, 1, 3, 3, 3, 3}, -1, 0, 0, 3, 0, 0},
    {{1, 1, 1, 1, 3, 3, 3, 3}, -1, 0, 0, 5, 0, 0},
    {{1, 1, 1, 1, 3, 3, 3, 3}, 4, 2.0, 0, 2, 0, 0},
    {{1, 1, 1, 1, 3, 3, 3, 3}, -1, 0, 0, 0, 0, 1},
    /* A gap that opens less has none, a corner of 0.0001 is no sharp one. */
    {{1, 1, 1, 1, 1.0001, 1.0001, 1.0001, 1.0001}, 4, 1e-4, 0, 0, 0, 0},
    /* An end that is not held, and one that the image goes on behind. */
    {{1, 1, 1, 1, 1, 1, 1, 1}, -1, 0, 0, 0, 0, 0},
    {{1, 1, 1, 1, 1, 1, 1, 1}, 0, 2.0, 1, 0, 0, 0},
    {{1, 1, 1.8, 1.8, 1.8, 1.8, 1.8, 1.8}, -1, 0, 1, 0, 0, 0},
    /* Bends of 1 and -1 at the nodes two edges away, where 3 * 0.65 are less
     * than twice the corner and 3 * 0.7 are not. */
    {{0, 0, -0.325, -0.325, 0.675, 0.675, 1, 1}, 4, 1, 0, 0, 0, 0},
    {{0, 0, -0.35, -0.35, 0.65, 0.65, 1, 1}, -1, 0, 0, 0, 0, 0},
    /* Gaps that bend at all nodes, to the ends. */
    {{0, 1, 0, 1, 0, 1, 0, 1}, -1, 0, 0, 0, 0, 0},
    {{0, 1, 2, 3, 4, 5, 6, 7}, -1, 0, 0, 0, 0, 0},
};

TESTS(corners_press_by_what_the_gap_turns, sizeof corners / sizeof *corners) {
  check_corner(&corners[_i]);
}

/* Of two corners the sharper, whichever is first. */
TEST(sharpest_corner_is_the_largest) {
  static const corner_case two[] = {{.slope = {1, 1, 3, 3, 3, 3, 4, 4}},
                                    {.slope = {1, 1, 2, 2, 2, 2, 4, 4}}};
  for (int k = 0; k < 2; ++k) {
    floor_run f;
    double most;
    set_corner(&two[k], &f);
    ck_assert_int_eq(goal_sharpest(&f.r, 0, f.s.x, 20.0, &most), OK);
    ck_assert_double_eq_tol(
        most, 2.0 * YOUNG / (1 - NU * NU) / (2 * M_PI) / 4.0, 1e-9);
    floor_end(&f);
  }
}

/* Held by the face that stands on it, along the normal of that. */
TEST(planes_of_symmetry_are_held_faces) {
  static const struct {
    int node, above, held, is;
  } cases[] = {
      {1, 1, 1, 1}, {1, 0, 1, 0}, {0, 1, 1, 0}, {2, 2, 1, 0}, {1, 1, 0, 0}};
  for (size_t k = 0; k < sizeof cases / sizeof *cases; ++k) {
    floor_run f;
    floor_new(&f, 2);
    for (int c = 0; c < 2; ++c) {
      f.fixed[c] = cases[k].node >> c & 1;
      f.fixed[2 * 3 + c] = cases[k].above >> c & 1;
    }
    f.held[1] = (unsigned char)cases[k].held;
    ck_assert_int_eq(goal_is_mirrored(&f.r, 0), cases[k].is);
    ck_assert_int_eq(goal_is_mirrored(&f.r, 1), 0);
    f.r.faces.input.axisymmetric = 1;
    for (int q = 0; q < 3; ++q)
      ck_assert_int_eq(goal_is_mirrored(&f.r, q), q == 0);
    floor_end(&f);
  }
}

/* ---- between the nodes --------------------------------------------------- */

TEST(points_of_an_edge_lie_on_its_arc) {
  const double turn = 0.3, a[] = {sin(turn), cos(turn)}, b[] = {-a[0], a[1]};
  const double out[] = {0.0, 1.0 - a[1]}, none[] = {0.0, 0.0};
  double x[3];
  for (int k = 0; k <= GOAL_PIECES; ++k) {
    goal_point_of(2, a, b, out, k, x);
    ck_assert_double_eq_tol(x[0], a[0] * (1 - 2.0 * k / GOAL_PIECES), 1e-15);
    ck_assert_double_eq_tol(hypot(x[0], x[1]), 1.0, 1e-14);
    goal_point_of(2, a, b, none, k, x);
    ck_assert_double_eq_tol(x[1], a[1], 1e-15);
  }
}

/* Of a parabola itself, and of a wave without an integral. */
TEST(parabolas_have_the_integral) {
  enum { N = GOAL_PIECES };
  double d[N + 1], rough;
  for (int k = 0; k <= N; ++k) d[k] = 3 - 0.5 * k - 7.0 * k * (N - k) / (N * N);
  goal_take_line(d);
  ck_assert_double_eq_tol(goal_parabola(d, &rough), -7.0 / 4.0, 1e-14);
  ck_assert_double_eq_tol(rough, 0.0, 1e-14);
  for (int k = 0; k <= N; ++k) d[k] = sin(2 * M_PI * k / N);
  ck_assert_double_eq_tol(goal_parabola(d, &rough), 0.0, 1e-14);
  /* sum |sin(2 pi k/N)| = 2/tan(pi/N) */
  ck_assert_double_eq_tol(rough, 1.5 / N * 2 / tan(M_PI / N), 1e-14);
}

/* An arc of 2 * turn with one pressure and one friction along it. */
TEST(tractions_follow_the_arc) {
  const double turn = 0.2, p = 2.0, t = 0.6, w = 0.3, h = 0.01;
  for (int k = 0; k < 4; ++k) {
    floor_run f;
    double y[2 * MOST] = {0.0}, z[2 * MOST] = {0.0}, sum[2];
    floor_new(&f, 2);
    contact_edge e = {.a = 0,
                      .b = 1,
                      .closed = k != 1,
                      .stuck = k == 2,
                      .out = {0.0, -h},
                      .weight = w,
                      .other = {k == 3 ? 1 : -1, -1}};
    const goal_surface s = {.n_edge = 1, .edge = &e};
    const double spin[] = {0.0, 0.0, 1.0};
    for (int q = 0; q < 2; ++q) {
      const double at = q == 0 ? -turn : turn;
      const double frame[] = {sin(at), -cos(at), cos(at), sin(at)};
      COPY(f.frame + 4 * q, frame, 4);
      f.rc[2 * q] = -p * f.area[q];
      f.rc[2 * q + 1] = t * f.area[q];
      f.g0[q] = 1.0;
      y[2 * q + 1] = 1.0;
      y[2 * q] = z[2 * q] = 5.0;
    }
    f.limit.g0 = f.g0;
    f.r.problem.limit = &f.limit;
    ck_assert_int_eq(goal_work_between(&f.r, &s, y, z, spin, sum, sum + 1), OK);
    /* spin x out = (h, 0). */
    const double normal = p * (1 - cos(turn));
    const double along = t * (5 * (1 - cos(turn)) + h);
    const double turned = k % 2 == 1 ? 0.0 : normal + (k == 0) * along;
    const double longer = (k == 0) * t * 4 * h * h * 5 * cos(turn);
    ck_assert_double_eq_tol(sum[0], w * turned, 1e-15);
    ck_assert_double_eq_tol(sum[1], w * longer, 1e-15);
    floor_end(&f);
  }
}

/*
 * Friction of a limit 1 + x^2 and more on an edge of length 1: the integral of
 * x^2 - x is -1/6, and that of x (x - 1/2) (x - 1), which is no parabola, 0.
 */
TEST(values_between_the_nodes_are_those_of_the_formula) {
  floor_run f;
  double z[2 * MOST] = {0.0}, F[2 * MOST] = {0.0}, sum, size = 0.0;
  floor_new(&f, 3);
  contact_edge e[] = {{.a = 0, .b = 1, .weight = 2.0 / 3.0, .other = {-1, -1}},
                      {.a = 1, .b = 2, .weight = 9.0, .other = {-1, -1}},
                      {.a = 1, .b = 3, .weight = 9.0, .other = {0, 0}},
                      {.a = 2, .b = 3, .weight = 9.0, .other = {-1, -1}}};
  const goal_surface s = {.n_edge = 4, .edge = e};
  f.contact->friction.law = &tresca_friction;
  formula_compile(&f.contact->friction.card.value, "1+x^2+x*(x-0.5)*(x-1)");
  for (int k = 0; k < GOAL_PIECES; ++k) {
    const double x = (double)k / GOAL_PIECES;
    size += fabs(x * (x - 0.5) * (x - 1.0)) / GOAL_PIECES;
  }
  for (int way = 1; way >= -1; way -= 2) {
    for (int q = 0; q < 4; ++q) {
      f.status[q] = q == 2 ? CONTACT_STICK : CONTACT_SLIP;
      f.rc[2 * q + 1] = (1 + q) * f.area[q];
      z[2 * q] = way * 3.0;
      z[2 * q + 1] = 7.0;
    }
    ck_assert_int_eq(goal_value_between(&f.r, &s, z, &sum), OK);
    ck_assert_double_eq_tol(sum, way * -3.0 / 6.0, 1e-14);
    ck_assert_int_eq(goal_add_doubts(&f.r, &s, z, F, NULL, &sum), OK);
    ck_assert_double_eq_tol(sum, 3.0 * size, 1e-14);
  }
  formula_release(&f.contact->friction.card.value);
  floor_end(&f);
}

/* Two edges of weight 1 on which J changes by 2 t, or by nothing. */
static double doubt(const double *t, const double *slip, int lips, int stuck,
                    double rough, double *product) {
  floor_run f;
  double z[2 * MOST] = {0.0}, F[2 * MOST] = {0.0}, sum;
  floor_new(&f, 2);
  contact_edge e[2];
  for (int k = 0; k < 2; ++k)
    e[k] = (contact_edge){.a = k,
                          .b = k + 1,
                          .closed = k == 0,
                          .stuck = stuck,
                          .rough = rough,
                          .weight = 1.0,
                          .other = {lips ? 0 : -1, -1}};
  for (int q = 0; q < 3; ++q) {
    f.status[q] = slip[q] > 0.0 ? CONTACT_SLIP : CONTACT_STICK;
    f.slip[q] = slip[q];
    f.rc[2 * q + 1] = t[q] * f.area[q];
    z[2 * q] = 2.0;
    z[2 * q + 1] = 9.0;
    F[2 * q] = 9.0;
    F[2 * q + 1] = 1.0 + q;
  }
  const goal_surface s = {.n_edge = 2, .edge = e};
  CLEAR(product, 4);
  ck_assert_int_eq(goal_add_doubts(&f.r, &s, z, F, product, &sum), OK);
  floor_end(&f);
  return sum;
}

TEST(friction_that_turns_back_is_doubted) {
  double of[4];
  const double even[] = {1.0, 1.0, 1.0};
  /* Half of (t + t') z, and half of that more in the plane. */
  ck_assert_double_eq_tol(doubt((double[]){1, -3, -3}, even, 0, 0, 0, of), 6.0,
                          1e-14);
  ck_assert_double_eq_tol(of[0] + of[1] + of[2] + of[3], 6.0, 1e-14);
  ck_assert_double_eq_tol(doubt((double[]){1, -3, 5}, even, 0, 0, 0, of),
                          6.0 + 12.0, 1e-14);
  ck_assert_double_eq(doubt((double[]){1, -3, -3}, even, 1, 0, 0, of), 0.0);
  ck_assert_double_eq(doubt((double[]){1, -3, -3}, even, 0, 1, 0, of), 0.0);
  ck_assert_double_eq(doubt((double[]){1, 3, 3}, even, 0, 0, 0, of), 0.0);
}

/* Where slip falls to less than twice of what it rises by on both sides. */
TEST(friction_that_may_stop_is_doubted) {
  const double t[] = {1, 3, 5};
  double of[4];
  ck_assert_double_eq_tol(doubt(t, (double[]){1, 0.63, 1}, 0, 0, 0, of),
                          6.0 + 12.0, 1e-14);
  ck_assert_double_eq_tol(doubt(t, (double[]){1, 0.63, 0.7}, 0, 0, 0, of),
                          6.0 + 12.0, 1e-14);
  ck_assert_double_eq(doubt(t, (double[]){1, 0.7, 1}, 0, 0, 0, of), 0.0);
  ck_assert_double_eq(doubt(t, (double[]){1, 0.63, 0.55}, 0, 0, 0, of), 0.0);
  ck_assert_double_eq_tol(doubt(t, (double[]){1, 0.63, 0}, 0, 0, 0, of), 0.0,
                          1e-14);
  ck_assert_double_eq_tol(doubt(t, (double[]){0.1, 1, 1.5}, 0, 0, 0, of), 6.0,
                          1e-14);
}

/* A gap that is 0.1 rougher than its parabola moves the adjoint force along the
 * normal, 1 and 2, over an area of 0.5; not where the edge is open. */
TEST(rough_gaps_are_doubted) {
  double of[4];
  const double t[] = {1, 1, 1}, slip[] = {0, 0, 0};
  ck_assert_double_eq_tol(doubt(t, slip, 0, 0, 0.1, of),
                          0.5 * 0.1 * (1 + 2) / 0.5, 1e-14);
}

UNIT_MAIN("goal_surface")
