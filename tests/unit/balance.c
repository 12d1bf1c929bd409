/*
 * src/accuracy/balance.c: forces on a body that contact alone holds, brought
 * into balance with a defect. The motions of the block follow from its
 * geometry: nodes at x = 0, 1, 2, ... on y = 0, unknowns -y and x.
 */
#include "accuracy/accuracy.h"
#include "solver/solver.h"
#include "support/contact_case.h"
#include "support/solver_rows.h"
#include "support/unit.h"

enum { COLUMNS = 12, NODES = COLUMNS + 1, M = 2 * NODES };

/* A block pressed and sheared, solved; given: its limits are frozen. */
static contact_case lying(double shear, int given) {
  case_block_data d = {.columns = COLUMNS,
                       .layers = 6,
                       .nu = 0.2,
                       .mu = 0.3,
                       .top = {shear * 1e-3, -1e-3}};
  contact_case c = case_block(&d);
  ck_assert_int_eq(solve_by(NULL, &c, 1e-12, c.u, c.r).outcome, CONVERGED);
  if (!given) return c;
  contact_limit(&c.cp, c.r, c.g0);
  c.cp.B = NULL;
  return c;
}

typedef struct scene {
  contact_case c;
  dense_inverse *dense;
  inverse_energy inverse;
  pair p;
} scene;

static scene scene_new(double shear, int given) {
  scene s = {.c = lying(shear, given)};
  ck_assert_int_eq(dense_inverse_new(M, s.c.A, &s.dense), OK);
  ck_assert_ptr_nonnull(s.dense);
  s.inverse = dense_inverse_energy(s.dense);
  ck_assert_int_eq(s.inverse.n_kernel, 3);
  ck_assert_int_eq(pair_new(NODES, M, &s.p), OK);
  pair_set(&s.c.cp, s.c.u, s.c.r, &s.p);
  return s;
}

static void scene_free(scene *s) {
  RELEASE(s->p.v, s->p.q, s->p.d, s->p.t, s->p.rounding, s->p.slides);
  memory_free(s->dense);
  case_free(&s->c);
}

/* Largest resultant of d: force down, force along x, moment. */
static double resultant(const double *d) {
  double down = 0.0, along = 0.0, moment = 0.0;
  for (int i = 0; i < NODES; ++i) {
    down += d[2 * i];
    along += d[2 * i + 1];
    moment += i * d[2 * i] / COLUMNS;
  }
  return fmax(fabs(down), fmax(fabs(along), fabs(moment)));
}

/* A random defect, up to "size" on an unknown. */
static void disturb(scene *s, double size, unsigned long long seed) {
  seed = seed * 2654435761u + 99;
  for (int i = 0; i < M; ++i)
    s->p.d[i] = size * (2.0 * case_random(&seed) - 1.0);
}

/* The forces take up the resultant of the defect, no more and no less, and stay
 * within the laws of contact: pressure, open nodes, the disc, slip at its rim.
 */
static void check_balance(scene *s, double size) {
  const contact_problem *cp = &s->c.cp;
  double sum[M], q[M];
  int done = 0;
  memcpy(q, s->p.q, sizeof q);
  for (int i = 0; i < M; ++i) sum[i] = s->p.q[i] + s->p.d[i];
  ck_assert_double_gt(resultant(s->p.d), 0.1 * size);
  ck_assert_int_eq(pair_balance(cp, &s->inverse, &s->p, &done), OK);
  ck_assert_int_eq(done, 1);
  ck_assert_double_le(resultant(s->p.d), 1e-12 * size + 1e-17);
  for (int i = 0; i < M; ++i)
    ck_assert_double_le(fabs(s->p.q[i] + s->p.d[i] - sum[i]), 1e-17);
  for (int i = 0; i < NODES; ++i) {
    double g = contact_node_limit(cp, s->p.q, i), t = fabs(s->p.q[2 * i + 1]);
    ck_assert_double_le(s->p.q[2 * i], 0.0);
    if (q[2 * i] == 0.0) ck_assert(s->p.q[2 * i] == 0.0);
    ck_assert_double_le(t, g + 1e-17);
    if (s->p.slides[i]) ck_assert_double_eq_tol(t, g, 1e-17);
  }
}

TEST(forces_take_up_the_resultant) {
  static const double shears[] = {0.0, 0.1, 0.2, 0.28};
  int slid = 0, open = 0;
  for (int k = 0; k < 32; ++k) {
    scene s = scene_new(shears[k % 4], k / 4 % 2);
    double size = k / 8 % 2 == 0 ? 1e-7 : 1e-12;
    disturb(&s, size, (unsigned)k);
    for (int i = 0; i < NODES; ++i) {
      slid += s.p.slides[i];
      open += s.p.q[2 * i] == 0.0;
    }
    check_balance(&s, size);
    scene_free(&s);
  }
  ck_assert_int_gt(slid, 0);
  ck_assert_int_gt(open, 0);
}

/* More than the pressures can take up, or than friction can at nodes that
 * stick (0.3 of the pressures, which sum up to 0.012): said, not done. */
TEST(too_large_a_resultant_is_refused) {
  for (int way = 0; way < 2; ++way) {
    scene s = scene_new(0.0, 0);
    int done = 1;
    for (int i = 0; i < M; ++i) s.p.d[i] = i % 2 == way ? 0.012 / NODES : 0.0;
    if (way == 0) s.p.d[0] += 0.012;
    ck_assert_int_eq(pair_balance(&s.c.cp, &s.inverse, &s.p, &done), OK);
    ck_assert_int_eq(done, 0);
    scene_free(&s);
  }
}

/* At rest after slip: friction is at its limit to rounding. */
TEST(forces_at_their_limit_follow_it) {
  for (unsigned k = 0; k < 8; ++k) {
    scene s = scene_new(0.28, 0);
    for (int i = 0; i < NODES; ++i) s.c.ut0[i] = s.c.u[2 * i + 1];
    pair_set(&s.c.cp, s.c.u, s.c.r, &s.p);
    disturb(&s, 1e-9, k);
    check_balance(&s, 1e-9);
    scene_free(&s);
  }
}

/* No node touches: nothing can balance anything. */
TEST(open_body_cannot_be_balanced) {
  scene s = scene_new(0.1, 0);
  int done = 1;
  memset(s.p.q, 0, M * sizeof *s.p.q);
  memset(s.p.slides, 0, NODES);
  disturb(&s, 1e-9, 5);
  ck_assert_int_eq(pair_balance(&s.c.cp, &s.inverse, &s.p, &done), OK);
  ck_assert_int_eq(done, 0);
  scene_free(&s);
}

/* No force has a lever against the motion but by rounding, or none is there at
 * all: what is left of the resultant is rounding as well, and changes none. */
TEST(resultant_of_rounding_needs_no_forces) {
  for (int k = 0; k < 2; ++k) {
    scene s = scene_new(0.0, 1);
    double along[M], q[M];
    int done = 0;
    for (int i = 0; i < M; ++i) along[i] = i % 2 == 1 ? 1.0 : 1e-17 * (i + 1);
    s.inverse.n_kernel = 1;
    s.inverse.kernel = along;
    for (int i = 0; i < NODES; ++i) s.c.g0[i] = s.p.q[2 * i + 1] = 0.0;
    if (k == 1) memset(s.p.q, 0, sizeof q);
    memcpy(q, s.p.q, sizeof q);
    disturb(&s, 1e-20, 5);
    ck_assert_int_eq(pair_balance(&s.c.cp, &s.inverse, &s.p, &done), OK);
    ck_assert_int_eq(done, 1);
    ck_assert_int_eq(memcmp(q, s.p.q, sizeof q), 0);
    scene_free(&s);
  }
}

/* Without friction no force acts along the floor: the pressures of two nodes
 * balance the rest of a defect, whatever motions are mixed in the kernel, and
 * none that pulls there. */
TEST(motion_without_forces_leaves_the_others) {
  for (int pulls = 0; pulls < 2; ++pulls) {
    scene s = scene_new(0.0, 1);
    int done = 1;
    disturb(&s, 1e-9, 5);
    for (int i = 0; i < NODES; ++i) {
      s.c.g0[i] = s.p.q[2 * i + 1] = 0.0;
      if (i != 1 && i != NODES - 2) s.p.q[2 * i] = 0.0;
      if (!pulls) s.p.d[2 * i + 1] = 0.0;
    }
    if (pulls)
      ck_assert_int_eq(pair_balance(&s.c.cp, &s.inverse, &s.p, &done), OK);
    else
      check_balance(&s, 1e-9);
    ck_assert_int_eq(done, !pulls);
    scene_free(&s);
  }
}

UNIT_MAIN("balance")
