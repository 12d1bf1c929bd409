/*
 * src/solver/local.c: the contact problem of one node, against its conditions
 * (local.h): random stiffness with normal and tangents coupled, friction below
 * the limit of uniqueness, starts near to the answer and far from it.
 */
#include "solver/local.h"

#include "support/contact_case.h"
#include "support/unit.h"

static double centred(unsigned long long *seed) {
  return 2.0 * case_random(seed) - 1.0;
}

/* K = G G' + 1; at a distance from gap and stick position of "far". */
static local_problem any_problem(int dim, double far,
                                 unsigned long long *seed) {
  local_problem lp = {.dim = dim};
  double G[9];
  for (int i = 0; i < dim * dim; ++i) G[i] = centred(seed);
  for (int i = 0; i < dim; ++i)
    for (int j = 0; j < dim; ++j) {
      lp.K[i + dim * j] = i == j;
      for (int k = 0; k < dim; ++k)
        lp.K[i + dim * j] += G[i + dim * k] * G[j + dim * k];
    }
  for (int i = 0; i < dim; ++i) {
    lp.b[i] = 3.0 * centred(seed);
    lp.at[i] = (i == 0 ? 1.0 : far) * centred(seed);
    lp.bound[i] = i == 0 ? 0.0 : HUGE_VAL;
  }
  lp.g0 = case_random(seed) < 0.5 ? 0.0 : case_random(seed);
  lp.mu = 0.3 * case_random(seed);
  return lp;
}

/* K d = b + r; returns what is rounding of the largest force. x = at + d. */
static double check_balance(const local_problem *lp, const double *d,
                            const double *r, int no, double *x) {
  double size = 0.0;
  for (int i = 0; i < lp->dim; ++i) {
    double defect = -lp->b[i] - r[i];
    x[i] = lp->at[i] + d[i];
    for (int j = 0; j < lp->dim; ++j) {
      defect += lp->K[i + lp->dim * j] * d[j];
      size = fmax(size, fabs(lp->K[i + lp->dim * j] * d[j]));
    }
    size = fmax(size, fabs(lp->b[i]));
    ck_assert_msg(fabs(defect) <= 1e-14 * size, "%d: defect %g", no, defect);
  }
  return 1e-14 * size;
}

/* Where the state says so: forces to rounding of the largest. */
static void check(const local_problem *lp, local_state is, const double *d,
                  const double *r, int no) {
  double x[3], g = lp->g0 - lp->mu * r[0], slip = 0.0, force = 0.0;
  const double tol = check_balance(lp, d, r, no, x);
  for (int i = 1; i < lp->dim; ++i) {
    slip = hypot(slip, x[i]);
    force = hypot(force, r[i]);
  }
  ck_assert_msg(r[0] <= tol && x[0] <= tol, "%d: r %g, x %g", no, r[0], x[0]);
  ck_assert_msg(r[0] == 0.0 || fabs(x[0]) <= tol, "%d: x %g", no, x[0]);
  ck_assert_msg(force <= g + tol, "%d: %g, limit %g", no, force, g);
  if (is == LOCAL_STICK) ck_assert_msg(slip <= tol, "%d: slip %g", no, slip);
  if (slip <= tol) return;
  for (int i = 1; i < lp->dim; ++i)
    ck_assert_msg(fabs(r[i] + g * x[i] / slip) <= tol, "%d: %g, not %g", no,
                  r[i], -g * x[i] / slip);
}

TEST(node_meets_its_conditions) {
  static const double far[] = {1.0, 1e-3, 10.0, 1e4, 1e8};
  unsigned long long seed = 3;
  int found[3] = {0};
  for (int k = 0; k < 6000; ++k) {
    double d[3], r[3];
    local_problem lp = any_problem(2 + k % 2, far[k / 2 % 5], &seed);
    const local_state is = local_solve(&lp, (local_state)(k / 10 % 3), d, r);
    ++found[is];
    check(&lp, is, d, r, k);
  }
  for (int i = 0; i < 3; ++i) ck_assert_int_gt(found[i], 100);
}

/* Without friction; each obstacle may be out of reach. */
TEST(node_at_several_obstacles_meets_its_conditions) {
  unsigned long long seed = 5;
  int closed[8] = {0};
  for (int k = 0; k < 2000; ++k) {
    double d[3], r[3], x[3];
    unsigned is_closed = 0;
    local_problem lp = any_problem(2 + k % 2, 1.0, &seed);
    lp.g0 = lp.mu = 0.0;
    lp.bounded = 1;
    for (int i = 1; i < lp.dim; ++i)
      if (k / 2 % 4 != i) lp.bound[i] = centred(&seed);
    const local_state is = local_solve(&lp, (local_state)(k / 8 % 3), d, r);
    const double tol = check_balance(&lp, d, r, k, x);
    for (int i = 0; i < lp.dim; ++i) {
      const double over = x[i] - lp.bound[i];
      ck_assert_msg(r[i] <= tol && over <= tol, "%d: r[%d] %g, over %g", k, i,
                    r[i], over);
      ck_assert_msg(r[i] == 0.0 || fabs(over) <= tol, "%d: open %d, r %g", k, i,
                    r[i]);
      is_closed |= (unsigned)(r[i] != 0.0) << i;
    }
    ck_assert_int_eq(is, is_closed & 1u ? LOCAL_SLIP : LOCAL_OPEN);
    ++closed[is_closed];
  }
  for (int i = 0; i < 8; ++i) ck_assert_int_gt(closed[i], 20);
}

/* Two nodes that springs of 1 N/m along both axes join, without a support. */
static contact_case pair_of_nodes(double mu) {
  contact_case c = case_new(2, 2, mu);
  for (int i = 0; i < 4; ++i) {
    c.A[5 * i] = 1.0;
    c.A[(i + 2) % 4 + 4 * i] = -1.0;
    c.gap[i / 2] = 1000.0;
  }
  c.cp.floating = 1;
  return c;
}

/* Sweeps that gave up: the load carries the pair to the obstacle, along it or
 * away from it. */
TEST(body_before_an_obstacle_does_not_drift_off) {
  static const double load[3][2] = {{1, 0.1}, {0, 1}, {-1, 0.1}};
  for (int k = 0; k < 3; ++k) {
    CONTACT_CASE c = pair_of_nodes(0.0);
    const best_iterate none = {.residual = HUGE_VAL};
    solver_report rep = {.outcome = STOPPED_STAGNATION};
    node_blocks *blocks;
    double work[4];
    c.f[0] = load[k][0];
    c.f[1] = load[k][1];
    ck_assert_int_eq(node_blocks_new(&c.cp, &blocks), OK);
    relaxation s = {&c.cp, blocks, .u = c.u, .r = c.r, .omega = 1.0};
    relaxation_start(&s);
    relaxation_refresh(&s);
    relaxation_end(&s, &none, work, &rep);
    ck_assert_int_eq(rep.outcome, k == 0 ? STOPPED_STAGNATION : STOPPED_RAY);
    memory_free(blocks);
  }
}

/* A step of the pair in the plane of the motion, its gaps and stick positions;
 * steps to the nearest, 0: none. */
static const struct {
  double d[2], gap[2], stick[2];
  int steps;
} flights[] = {{{1, 0}, {9, 6}, {0, 0}, 6},    {{-1, 0}, {9, 6}, {0, 0}, 0},
               {{0, 1}, {9, 6}, {8, 5}, 5},    {{0, 1}, {9, 6}, {-8, -5}, 0},
               {{0, -1}, {9, 6}, {-4, -7}, 4}, {{0, -2}, {9, 6}, {-14, 5}, 7},
               {{1, 2}, {9, 3}, {16, 40}, 3}};

/* Straight on to the first obstacle or the first position of stick ahead. */
TEST(body_flies_to_what_is_next) {
  for (size_t k = 0; k < sizeof flights / sizeof *flights; ++k) {
    CONTACT_CASE c = pair_of_nodes(1.0);
    const double *d = flights[k].d;
    const int steps = flights[k].steps;
    const double from[] = {2 - d[0], 2 - d[1], 2 - d[0], 2 - d[1]};
    node_blocks *blocks;
    ck_assert_int_eq(node_blocks_new(&c.cp, &blocks), OK);
    c.g0[0] = c.g0[1] = 1.0;
    for (int i = 0; i < 4; ++i) {
      c.u[i] = 2;
      c.gap[i / 2] = 2 + flights[k].gap[i / 2];
      c.ut0[i / 2] = 2 + flights[k].stick[i / 2];
      c.f[i] = d[i % 2];
    }
    relaxation s = {&c.cp, blocks, .u = c.u, .r = c.r, .omega = 1.0};
    relaxation_start(&s);
    ck_assert_int_eq(relaxation_fly(&s, from), steps > 0 ? 2 : 0);
    for (int i = 0; i < 4; ++i) ck_assert(c.u[i] == 2 + steps * d[i % 2]);
    memory_free(blocks);
  }
}

UNIT_MAIN("local")
