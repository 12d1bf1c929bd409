/* src/contact/contact.c */
#include "contact/contact.h"
#include "contact/formulation.h"
#include "contact/active.h"
#include "support/contact_case.h"
#include "support/planted.h"
#include "support/unit.h"

/* One node, K = diag(kn, kt), pushed by fn onto the floor and sheared by ft. */
static contact_case one_node(double kn, double kt, double mu) {
  contact_case c = case_new(2, 1, mu);
  c.A[0] = kn;
  c.A[3] = kt;
  return c;
}

TEST(residual_is_zero_for_solved_node) {
  CONTACT_CASE c = one_node(4.0, 2.0, 0.5);
  /* stick */
  c.f[0] = 8.0;
  c.f[1] = 3.0;
  double u[2] = {0.0, 0.0}, r[2] = {-8.0, -3.0};
  ck_assert(contact_residual(&c.cp, u, r) == 0.0);
  /* slip: r_t = -mu p = -4, u_t = (5 - 4)/2 */
  c.f[1] = 5.0;
  u[1] = 0.5;
  r[1] = -4.0;
  ck_assert(contact_residual(&c.cp, u, r) == 0.0);
  /* open */
  c.f[0] = -8.0;
  u[0] = -2.0;
  u[1] = 2.5;
  r[0] = r[1] = 0.0;
  ck_assert(contact_residual(&c.cp, u, r) == 0.0);
}

/* The last of any number of nodes counts, what stands behind it does not. */
TEST(residual_is_that_of_all_nodes) {
  enum { MOST = 140, BEHIND = 2 * MOST };
  for (int n = 1; n <= MOST; ++n) {
    CONTACT_CASE c = case_new(2, BEHIND, 0.5);
    double u[2 * BEHIND], r[2 * BEHIND];
    for (int i = 0; i < 2 * BEHIND; ++i) {
      u[i] = 0.0;
      r[i] = i >= 2 * n ? NAN : i % 2 == 0 ? -8.0 : 0.0;
      c.f[i] = -r[i];
    }
    c.cp.n = n;
    c.cp.m = 2 * n;
    for (int i = 0; i < 2 * n; ++i) c.A[i * (2 * n + 1)] = 4.0;
    ck_assert_msg(contact_residual(&c.cp, u, r) == 0.0, "%d nodes", n);
    r[2 * n - 2] = -7.2;
    ck_assert_double_eq_tol(contact_residual(&c.cp, u, r), 0.1, 1e-13);
  }
}

TEST(each_broken_condition_shows_by_its_size) {
  CONTACT_CASE c = one_node(4.0, 2.0, 0.5);
  c.f[0] = 8.0;
  c.f[1] = 5.0; /* scale 8; exact: u = (0, 0.5), r = (-8, -4)                */
  double tol = 1e-13;
  double tension_u[2] = {2.5, 2.5}, tension_r[2] = {2.0, 0.0};
  ck_assert_double_ge_tol(contact_residual(&c.cp, tension_u, tension_r), 0.25,
                          tol);
  double over_u[2] = {0.1, 0.5}, over_r[2] = {-7.6, -4.0};
  ck_assert_double_eq_tol(contact_residual(&c.cp, over_u, over_r), 0.05, tol);
  double strong_u[2] = {0.0, 0.0}, strong_r[2] = {-8.0, -5.0};
  ck_assert_double_eq_tol(contact_residual(&c.cp, strong_u, strong_r), 0.125,
                          tol);
  double wrong_way_u[2] = {0.0, 4.5}, wrong_way_r[2] = {-8.0, 4.0};
  ck_assert_double_eq_tol(contact_residual(&c.cp, wrong_way_u, wrong_way_r),
                          1.0, tol);
  double apart_u[2] = {0.0, 0.5}, apart_r[2] = {-8.8, -4.4};
  ck_assert_double_eq_tol(contact_residual(&c.cp, apart_u, apart_r), 0.1, tol);
}

TEST(scale_is_above_rounding_of_loads_and_of_the_way) {
  CONTACT_CASE c = one_node(4.0, 2.0, 0.5);
  c.f[0] = 1e-9;
  c.gap[0] = 1.0;
  ck_assert(contact_scale(&c.cp) == 1e-9);
  /* what the load becomes */
  c.cp.load = 3.0;
  ck_assert(contact_scale(&c.cp) == 0x1p-14 * 3.0);
  c.cp.load = 0.0;
  /* forces below the rounding of the way through the gap are nothing */
  c.f[0] = 4.0;
  double u[2] = {1.0, 0.0}, r[2] = {3e-14, 0.0};
  ck_assert(contact_residual(&c.cp, u, r) == 0.0);
  r[0] = 3e-10;
  ck_assert_double_ge(contact_residual(&c.cp, u, r), 7e-11);
}

/* Two springs of 4 and 4e-8 N/m pressed by 1 and 1e-12 N: the force of the weak
 * one misses a tenth, whatever the loads of the other come to. */
TEST(weak_body_is_judged_by_its_own_loads) {
  CONTACT_CASE c = case_new(2, 2, 0.0);
  const double load[2] = {1.0, 1e-12}, spring[2] = {4.0, 4e-8};
  double u[4] = {0}, r[4] = {0};
  for (int i = 0; i < 2; ++i) {
    c.A[10 * i] = c.A[10 * i + 5] = spring[i];
    c.f[2 * i] = load[i];
    r[2 * i] = -load[i];
  }
  c.cp.load = 1.0;
  ck_assert(contact_residual(&c.cp, u, r) == 0.0);
  r[2] *= 0.9;
  ck_assert_double_eq_tol(contact_residual(&c.cp, u, r), 0.1, 1e-3);
}

/* Two nodes on a spring of 4, in weak springs. */
static contact_case free_body(double spring) {
  contact_case c = case_new(2, 2, 0.0);
  c.A[0] = c.A[10] = 4.0 + spring;
  c.A[2] = c.A[8] = -4.0;
  return c;
}

/* A force of 1e-12 on a body that is on its way to, or from its obstacle: it
 * counts over 2^-14 of the force that the shorter of way and gap makes. */
TEST(free_fall_through_a_gap_is_in_the_scale) {
  static const double way[] = {0.5, -1.0}, gap[] = {2.0, -0.25};
  for (int k = 0; k < 2; ++k) {
    CONTACT_CASE c = free_body(0.0);
    const double u[4] = {way[k], 0, way[k], 0}, r[4] = {0};
    const double least = 0x1p-14 * 4 * fmin(fabs(way[k]), fabs(gap[k]));
    c.gap[0] = c.gap[1] = gap[k];
    c.f[0] = 1e-12;
    ck_assert_double_eq_tol(contact_residual(&c.cp, u, r), 1e-12 / least,
                            0.05e-12 / least);
  }
}

/* Far from its obstacle by a weak load: a drift, but not where that is no rigid
 * motion, nor where the body has been. */
TEST(soft_body_does_not_drift) {
  static const double along[4] = {0, M_SQRT1_2, 0, M_SQRT1_2};
  for (int known = 0; known < 3; ++known) {
    CONTACT_CASE c = free_body(0x1p-20);
    const double u[4] = {-1, 0, -1, 0}, r[4] = {0};
    c.f[0] = c.f[2] = -0x1p-20;
    c.cp.floating = 1;
    c.cp.motion = along;
    c.cp.n_motion = known == 1;
    c.cp.moved = known == 2;
    ck_assert((contact_residual(&c.cp, u, r) > 0.0) == !known);
    /* Without an obstacle; what stands before the positions of stick is not
     * one of the normal. */
    double stick[] = {2.0, 0.0, 0.0};
    c.gap[0] = c.gap[1] = HUGE_VAL;
    c.cp.ut0 = stick + 1;
    ck_assert((contact_residual(&c.cp, u, r) > 0.0) == !known);
  }
}

/* A free body that lies on its obstacle: the load that is left of 1 N is
 * rounding, and so is what it presses. */
TEST(rounding_of_the_loads_is_no_load) {
  CONTACT_CASE c = free_body(0.0);
  const double u[4] = {-0.25, 0.0, -0.25, 0.0}, r[4] = {-1e-16, 0.0, 0.0, 0.0};
  contact_status state[2];
  c.gap[0] = c.gap[1] = -0.25;
  c.f[0] = 1e-16;
  for (int known = 0; known < 2; ++known) {
    c.cp.load = known;
    contact_classify(&c.cp, u, r, state);
    ck_assert_int_eq(state[0], known ? CONTACT_OPEN : CONTACT_SLIP);
    ck_assert(contact_hidden(&c.cp, u, r, NULL) == 0.0 || !known);
  }
}

/* A body that nothing presses, moved with its stiff support: forces within the
 * rounding of its stiff node are that of the soft one, too. */
TEST(rounding_of_a_body_is_that_of_its_stiff_nodes) {
  CONTACT_CASE c = free_body(0.0);
  const double u[4] = {0.25, 0.0, 0.25, 0.0}, r[4] = {-1e-11, 0.0, -1e-11, 0.0};
  contact_status state[2];
  c.gap[0] = c.gap[1] = 0.25;
  c.A[0] = 4e4;
  c.A[5] = c.A[15] = 4.0;
  c.cp.load = 1.0;
  contact_classify(&c.cp, u, r, state);
  ck_assert(state[0] == CONTACT_OPEN && state[1] == CONTACT_OPEN);
  c.gap[0] = c.gap[1] = 1.0;
  ck_assert_double_eq(contact_hidden(&c.cp, u, r, NULL), 0.0);
}

TEST(scale_is_of_the_problem) {
  CONTACT_CASE c = one_node(4.0, 2.0, 0.5);
  ck_assert(contact_scale(&c.cp) == 0.0);
  double u[2] = {0.0, 0.0}, r[2] = {0.0, 0.0};
  ck_assert(contact_residual(&c.cp, u, r) == 0.0);
  u[1] = 1e-300;
  ck_assert(contact_residual(&c.cp, u, r) > 1.0);
  /* initial penetration alone */
  c.gap[0] = -0.25;
  ck_assert(contact_scale(&c.cp) == 1.0);
  /* moved stick position alone */
  c.gap[0] = 0.0;
  c.ut0[0] = 3.0;
  ck_assert(contact_scale(&c.cp) == 6.0);
  /* a load that only carries the body along with the obstacle: force 1e-3 */
  c.f[1] = 6.0 + 1e-3;
  ck_assert_double_eq_tol(contact_scale(&c.cp), 1e-3, 1e-12);
  c.f[1] = 6.0; /* nothing but rounding left                                  */
  ck_assert(contact_scale(&c.cp) == 0x1p-14 * 12.0);
  /* held 3 along the floor, which takes 3 off the load of 8 */
  const unsigned char held[2] = {0, 1};
  c.cp.held = held;
  c.A[1] = c.A[2] = 1.0;
  c.f[0] = 8.0;
  ck_assert(contact_scale(&c.cp) == 5.0);
  /* of a compliance the way to the moved stick position */
  c.cp.held = NULL;
  c.cp.W = c.A;
  c.cp.A = NULL;
  c.f[0] = 0.5;
  ck_assert(contact_scale(&c.cp) == 6.0 - 3.0);
}

TEST(stiffness_of_tangents_and_of_a_motion) {
  CONTACT_CASE c = case_new(3, 1, 0.5);
  unsigned char held[3] = {0, 0, 0};
  const double v[3] = {0.0, 0.0, 10.0};
  c.A[0] = 4.0;
  c.A[4] = 2.0;
  ck_assert_double_eq_tol(contact_resistance(&c.cp, v, 1e-10),
                          3.0 * DBL_EPSILON / 1e-10 * 4.0 * 10.0, 1e-16);
  c.A[8] = 3.0;
  ck_assert(contact_resistance(&c.cp, v, 1e-10) == 30.0);
  c.cp.held = held;
  ck_assert(contact_tangent_diagonal(&c.cp, 0, 7.0) == 2.5);
  held[1] = 1;
  ck_assert(contact_tangent_diagonal(&c.cp, 0, 7.0) == 3.0);
  held[2] = 1;
  ck_assert(contact_tangent_diagonal(&c.cp, 0, 7.0) == 7.0);
}

TEST(closed_gap_counts_where_it_is_nearer) {
  CONTACT_CASE c = one_node(4.0, 2.0, 0.0);
  c.gap[0] = 1.0;
  c.f[0] = 4.0 + 0.01; /* brings it to the obstacle and pushes with 0.01     */
  ck_assert_double_eq_tol(contact_scale(&c.cp), 0.01, 1e-12);
  c.gap[0] = 1000.0; /* out of reach                                         */
  ck_assert(contact_scale(&c.cp) == 4.01);
}

TEST(nan_anywhere_gives_nan) {
  CONTACT_CASE c = case_any(3, 3, 0.5, 0, 5);
  double *all[] = {c.A, c.f, c.gap, c.ut0, c.g0, c.B->val, c.u, c.r};
  for (size_t k = 0; k < sizeof all / sizeof *all; ++k) {
    c.r[0] = -1.0; /* so that mu matters                                     */
    double old = all[k][0];
    ck_assert(!isnan(contact_residual(&c.cp, c.u, c.r)));
    all[k][0] = NAN;
    ck_assert_msg(isnan(contact_residual(&c.cp, c.u, c.r)), "array %zu", k);
    all[k][0] = old;
  }
}

TEST(factors_of_two_leave_every_bit) {
  for (int seed = 1; seed < 40; ++seed) {
    CONTACT_CASE c = case_any(2 + seed % 2, 1 + seed, 0.7, seed % 2,
                              (unsigned long long)seed);
    unsigned long long s = 77u + (unsigned long long)seed;
    int m = c.cp.m, n = c.cp.n;
    for (int i = 0; i < m; ++i) {
      c.u[i] = case_random(&s) - 0.5;
      c.r[i] = case_random(&s) - 0.7;
    }
    double before = contact_residual(&c.cp, c.u, c.r);
    for (int i = 0; i < m * m; ++i) c.A[i] *= 0x1p+41;
    for (int i = 0; i < m; ++i) c.f[i] *= 0x1p+24;
    for (int i = 0; i < m; ++i) c.r[i] *= 0x1p+24;
    for (int i = 0; i < m; ++i) c.u[i] *= 0x1p-17;
    for (int i = 0; i < n; ++i) c.gap[i] *= 0x1p-17;
    for (int i = 0; i < m - n; ++i) c.ut0[i] *= 0x1p-17;
    ck_assert(contact_residual(&c.cp, c.u, c.r) == before);
    ck_assert(before > 0.0);
  }
}

TEST(disc_is_exact_at_any_angle) {
  CONTACT_CASE c = case_new(3, 1, 0.25);
  for (int i = 0; i < 9; i += 4) c.A[i] = 2.0;
  for (int degree = 0; degree < 360; degree += 7) {
    double a = degree * acos(-1.0) / 180.0;
    c.f[0] = 8.0;
    c.f[1] = 5.0 * cos(a);
    c.f[2] = 5.0 * sin(a);
    double u[3] = {0.0, 1.5 * cos(a), 1.5 * sin(a)};
    double r[3] = {-8.0, -2.0 * cos(a), -2.0 * sin(a)};
    ck_assert(contact_residual(&c.cp, u, r) < 1e-15);
    r[1] *= 1.01;
    r[2] *= 1.01;
    u[1] = (c.f[1] + r[1]) / 2.0;
    u[2] = (c.f[2] + r[2]) / 2.0;
    ck_assert_double_eq_tol(contact_residual(&c.cp, u, r), 0.02 / 8.0, 1e-12);
  }
}

TEST(compliance_form_measures_the_same_state) {
  CONTACT_CASE c = one_node(0.25, 0.5, 0.5); /* the inverse of diag(4, 2)    */
  c.cp.W = c.A;
  c.cp.A = NULL;
  c.f[0] = 2.0; /* q = W f, f = (8, 5)                                        */
  c.f[1] = 2.5;
  double u[2] = {0.0, 0.5}, r[2] = {-8.0, -4.0};
  ck_assert(contact_residual(&c.cp, u, r) == 0.0);
  r[1] = -4.4; /* W_tt dr = 0.2, scale q_t = 2.5                              */
  ck_assert_double_eq_tol(contact_residual(&c.cp, u, r), 0.2 / 2.5, 1e-13);
  /* a gap of 1: pressed by 4, 0.4 of friction is a tenth of that             */
  c.gap[0] = u[0] = 1.0;
  r[0] = -4.0;
  r[1] = -2.0;
  u[1] = 1.5;
  ck_assert(contact_residual(&c.cp, u, r) == 0.0);
  r[1] = -2.4;
  ck_assert_double_eq_tol(contact_residual(&c.cp, u, r), 0.1, 1e-13);
}

TEST(statuses_of_a_row_of_nodes) {
  CONTACT_CASE c = case_new(2, 4, 0.5);
  for (int i = 0; i < 8; ++i) c.A[i + 8 * i] = 2.0;
  double f[8] = {-1, 1, 4, 1, 4, 3, 0, 0};
  memcpy(c.f, f, sizeof f);
  double u[8] = {-0.5, 0.5, 0, 0, 0, 0.5, 0, 0};
  double r[8] = {0, 0, -4, -1, -4, -2, 0, 0};
  contact_status s[4];
  ck_assert(contact_residual(&c.cp, u, r) == 0.0);
  contact_classify(&c.cp, u, r, s);
  ck_assert_int_eq(s[0], CONTACT_OPEN);
  ck_assert_int_eq(s[1], CONTACT_STICK);
  ck_assert_int_eq(s[2], CONTACT_SLIP);
  ck_assert_int_eq(s[3], CONTACT_OPEN); /* touches without force             */
  static const unsigned char known[8] = {0, 0, 1, 1, 1, 0, 0, 0};
  unsigned char stopped[8];
  double force[8];
  r[6] = -1e-18;
  contact_stops(&c.cp, u, r, 1, force, stopped);
  ck_assert_mem_eq(stopped, known, sizeof known);
  ck_assert(force[4] == -4.0 && force[6] == 0.0);
}

/* Friction within the rounding, over the limit of the node, not less than what
 * is called none; over the given force where that is larger. */
TEST(hidden_friction_is_a_part_of_the_limit) {
  static const double mu[] = {1e-12, 0.5, 2.0}, part[] = {0x1p-30, 0.5, 1.0};
  const double u[2] = {0.0, 1e-17}, r[2] = {-8.0, 0.0}, own = 16.0;
  for (int k = 0; k < 3; ++k) {
    CONTACT_CASE c = one_node(4.0, 2.0, mu[k]);
    const double want = 2e-17 / (part[k] * 8.0);
    c.f[0] = 8.0;
    ck_assert_double_eq_tol(contact_hidden(&c.cp, u, r, NULL) / want, 1, 1e-12);
    ck_assert_double_eq_tol(contact_hidden(&c.cp, u, r, &own) / want, 0.5,
                            1e-12);
  }
}

/* Of open nodes, and where they pull; not tangential forces of a given limit,
 * nor what presses a closed node. */
TEST(forces_of_rounding_are_dropped) {
  CONTACT_CASE c = case_new(2, 5, 0.5);
  for (int i = 0; i < 10; ++i) c.A[i + 10 * i] = 2.0;
  const double f[10] = {-1, 1, 4, 1, -2, 3, 0, 1, -2}, u[10] = {-0.5, 0.5};
  double r[10] = {-1e-17, -1e-17, -4, -1e-17, 1e-17, -2, -1e-17, 0, 1e-3};
  memcpy(c.f, f, sizeof f);
  contact_drop_roundings(&c.cp, u, r);
  static const double left[10] = {0, 0, -4, -1e-17, 0, -2, -1e-17, 0, 1e-3};
  ck_assert_mem_eq(r, left, sizeof r);
}

/* At its limit a node sticks as long as it has not moved. */
TEST(node_at_its_limit_sticks_until_it_moves) {
  static const double slip[] = {0.0, 1e-12, 1e-6};
  CONTACT_CASE c = one_node(4.0, 2.0, 0.5);
  for (int k = 0; k < 3; ++k) {
    double u[2] = {0.0, slip[k]}, r[2] = {-8.0, -4.0};
    contact_status s;
    c.f[0] = 8.0;
    c.f[1] = 4.0 + 2.0 * slip[k];
    contact_classify(&c.cp, u, r, &s);
    ck_assert_int_eq(s, k < 2 ? CONTACT_STICK : CONTACT_SLIP);
  }
}

TEST(second_obstacle_bounds_the_tangent) {
  CONTACT_CASE c = one_node(4.0, 2.0, 0.0);
  double side[1] = {0.5};
  c.cp.side_gap = side;
  c.f[0] = 8.0;
  c.f[1] = 3.0; /* would move 1.5                                             */
  double u[2] = {0.0, 0.5}, r[2] = {-8.0, -2.0};
  ck_assert(contact_residual(&c.cp, u, r) == 0.0);
  double through_u[2] = {0.0, 1.5}, through_r[2] = {-8.0, 0.0};
  ck_assert_double_eq_tol(contact_residual(&c.cp, through_u, through_r), 0.25,
                          1e-13);
}

TEST(held_tangent_takes_no_friction) {
  CONTACT_CASE c = one_node(4.0, 2.0, 0.5);
  unsigned char held[2] = {0, 1};
  c.cp.held = held;
  c.f[0] = 8.0;
  c.f[1] = 2e6; /* prescribed displacement 1e6                               */
  double u[2] = {0.0, 1e6}, r[2] = {-8.0, 0.0};
  ck_assert(contact_scale(&c.cp) == 8.0);
  ck_assert(contact_residual(&c.cp, u, r) == 0.0);
}

/* An obstacle far away, a body far away: the forces count, not the way. */
TEST(what_only_carries_is_not_in_the_scale) {
  CONTACT_CASE c = one_node(4.0, 2.0, 0.5);
  c.f[0] = 8.0;
  c.ut0[0] = 0x1p+30;
  double u[2] = {0.0, 2.0}, r[2] = {-8.0, 4.0};
  ck_assert(contact_residual(&c.cp, u, r) == 0.0);
  u[1] = 1.99; /* 0.5 % of friction missing                                   */
  r[1] = 3.98;
  ck_assert_double_eq_tol(contact_residual(&c.cp, u, r), 0.02 / 8.0, 1e-12);
  double load[2] = {8.0, 0.0};
  c.cp.f_load = load;
  c.ut0[0] = 0.0;
  c.f[1] = 2.0 * 0x1p+30; /* carried by its support                           */
  u[1] = 0x1p+30 - 2.0;
  r[1] = -4.0;
  ck_assert(contact_residual(&c.cp, u, r) == 0.0);
  u[1] = 0x1p+30 - 1.0;
  r[1] = -2.0;
  ck_assert_double_eq_tol(contact_residual(&c.cp, u, r), 2.0 / 8.0, 1e-4);
}

/* A million times the load, the stiffness, the compliance of the other. */
TEST(bodies_are_measured_apart) {
  for (int form = 0; form < 3; ++form) {
    CONTACT_CASE c = case_new(2, 2, 0.5);
    double stiff = form == 0 ? 1.0 : 1e6, heavy = form == 0 ? 1e6 : 1.0;
    for (int i = 0; i < 4; ++i) c.A[5 * i] = i < 2 ? stiff : 1.0;
    double f[4] = {8 * heavy, 5 * heavy, 8, 5};
    double u[4] = {0, heavy / stiff, 0, 1},
           r[4] = {-8 * heavy, -4 * heavy, -8, -4};
    int wrong = form == 0 ? 2 : 0; /* the light, the stiff one                */
    memcpy(c.f, f, sizeof f);
    if (form == 2) {
      c.cp.W = c.A;
      c.cp.A = NULL;
      for (int i = 0; i < 4; ++i) {
        c.A[5 * i] = 1.0 / c.A[5 * i];
        c.f[i] *= c.A[5 * i];
      }
    }
    ck_assert_double_le(contact_residual(&c.cp, u, r), 1e-13);
    r[wrong] *= 1.01; /* 1 % of its normal force                              */
    ck_assert_double_ge(contact_residual(&c.cp, u, r), 0.009);
  }
}

/* Two nodes of one body, the first a million times stiffer. What a node misses
 * counts against the forces of the body, but not against more than what its
 * own stiffness times the largest motion of the body makes. */
TEST(unlike_nodes_of_a_body_are_measured_apart) {
  for (int k = 0; k < 4; ++k) {
    CONTACT_CASE c = case_new(2, 2, 0.5);
    const int compliance = k / 2, soft_moves = k % 2;
    const double soft = soft_moves ? 1.0 : 1e-6; /* its forces               */
    const int wrong = soft_moves ? 0 : 2;
    const double force[2] = {1.0, soft};
    double u[4] = {0, 1e-6, 0, soft};
    double r[4] = {-8, -4, -8 * soft, -4 * soft};
    for (int i = 0; i < 4; ++i) c.A[5 * i] = i < 2 ? 1e6 : 1.0;
    for (int i = 0; i < 2; ++i)
      c.A[i + 4 * (i + 2)] = c.A[i + 2 + 4 * i] = 1e-4;
    if (compliance) {
      ck_assert(case_inverse(4, c.A, c.A));
      c.cp.W = c.A;
      c.cp.A = NULL;
    }
    const double *x = compliance ? r : u, *y = compliance ? u : r;
    contact_product(4, c.A, x, c.f);
    for (int i = 0; i < 4; ++i)
      c.f[i] = compliance ? y[i] - c.f[i] : c.f[i] - y[i];
    ck_assert_double_le(contact_residual(&c.cp, u, r), 1e-9);
    r[wrong] *= 1.01; /* 1 % of its normal force                             */
    ck_assert_double_ge(contact_residual(&c.cp, u, r), 0.009);
    ck_assert_double_le(contact_residual(&c.cp, u, r), 0.04 / force[wrong / 2]);
  }
}

/* Whichever of two nodes comes first. */
TEST(nodes_of_which_one_feels_the_other_are_a_body) {
  for (int k = 0; k < 2; ++k) {
    CONTACT_CASE c = case_new(2, 2, 0.5);
    OWNED contact_bodies *b = NULL;
    for (int i = 0; i < 4; ++i) c.A[5 * i] = 1;
    c.A[k == 0 ? 2 : 8] = 0.5;
    ck_assert_int_eq(contact_bodies_new(&c.cp, &b), OK);
    ck_assert_int_eq(b->n, 1);
  }
}

/* Bodies and residual of any u, r from the blocks and from all entries. */
TEST(blocks_give_the_residual_of_all_entries) {
  for (int k = 0; k < 12; ++k) {
    unsigned long long seed = 31u + (unsigned)k;
    planted p = planted_new((planted_kind)(k % 4), 2 + k / 4 % 2, 9, 0.4, seed);
    contact_problem all = p.cp;
    OWNED contact_bodies *one = NULL, *two = NULL;
    all.W = p.W;
    all.blocks = NULL;
    ck_assert_int_eq(contact_bodies_new(&p.cp, &one), OK);
    ck_assert_int_eq(contact_bodies_new(&all, &two), OK);
    ck_assert_int_eq(one->n, two->n);
    for (int i = 0; i < p.cp.n; ++i)
      for (int j = 0; j < i; ++j)
        ck_assert((one->of[i] == one->of[j]) == (two->of[i] == two->of[j]));
    for (int i = 0; i < p.cp.n; ++i) {
      const int dim = p.cp.dim;
      double block[9];
      contact_block(&p.cp, i, block);
      for (int e = 0; e < dim * dim; ++e) {
        const int row = dim * i + e % dim, column = dim * i + e / dim;
        ck_assert_double_eq(block[e], p.W[row + p.cp.m * column]);
      }
    }
    for (int j = 0; j < p.cp.m; ++j) {
      double column[64];
      contact_column(&p.cp, j, column);
      for (int i = 0; i < p.cp.m; ++i)
        ck_assert_double_eq(column[i], p.W[i + p.cp.m * j]);
    }
    for (int i = 0; i < p.cp.m; ++i)
      p.u[i] += (k % 3 == 0 ? 0.0 : case_random(&seed)) * p.W[0];
    double have = contact_residual(&p.cp, p.u, p.r);
    double want = contact_residual(&all, p.u, p.r);
    ck_assert_double_le(fabs(have - want), 1e-12 * fmax(1.0, want));
    ck_assert((want > 1e-6) == (k % 3 > 0));
    planted_free(&p);
  }
}

/* Every value is its own place in the whole problem. */
TEST(active_nodes_take_their_own_data) {
  enum { N = 6, IN = 2 };
  const double gap[N] = {9, 1, 8, 7, 2, 6};
  const int in[IN] = {1, 4};
  for (int dim = 2; dim <= 3; ++dim) {
    CONTACT_CASE c = case_new(dim, N, 0.5);
    active_nodes x = {.distance = 3.0};
    active_part part;
    memcpy(c.gap, gap, sizeof gap);
    unsigned char held[3 * N];
    for (int k = 0; k < dim * N; ++k) held[k] = (unsigned char)k;
    for (int k = 0; k < (dim - 1) * N; ++k) c.ut0[k] = 10 + k;
    for (int i = 0; i < N; ++i) c.g0[i] = c.B->val[i] = 100 + i;
    c.cp.held = held;
    ck_assert_int_eq(active_choose(&x, N, c.gap), OK);
    ck_assert_int_eq(active_count(&x, N), IN);
    ck_assert_int_eq(active_part_new(IN, dim, &part), OK);
    active_cut(&x, &part, &c.cp);
    for (int k = 0; k < IN; ++k) {
      ck_assert_double_eq(c.cp.gap[k], gap[in[k]]);
      ck_assert_double_eq(c.cp.g0[k], 100 + in[k]);
      ck_assert_double_eq(c.cp.B->val[c.cp.B->start[k]], 100 + in[k]);
      for (int a = 0; a < dim; ++a)
        ck_assert_int_eq(c.cp.held[dim * k + a], dim * in[k] + a);
      for (int a = 0; a < dim - 1; ++a)
        ck_assert_double_eq(c.cp.ut0[(dim - 1) * k + a],
                            10 + (dim - 1) * in[k] + a);
    }
    active_part_free(&part);
    active_free(&x);
  }
}

/* Two nodes whose normals move as one, to the last digits: no given forces have
 * an answer. Of stiffer normals they have. */
/* Nodes stay that once were taken; after two distances all are. */
TEST(active_nodes_become_more) {
  enum { N = 5 };
  static const double gap[N] = {200, 1, 100, 300, 400};
  static const double u_n[3][N] = {{0, 0, 101}, {0}, {0}};
  static const int count[3] = {2, 2, N};
  active_nodes x = {.distance = 0.5};
  ck_assert_int_eq(active_choose(&x, N, gap), OK);
  ck_assert(x.n_in == 1 && x.in[0] == 1); /* the nearest */
  for (int k = 0; k < 3; ++k) {
    ck_assert_int_eq(active_too_few(&x, N, gap, u_n[k], 1), k == 0);
    ck_assert_int_eq(active_extend(&x, N, gap, u_n[k], 1, 0), OK);
    ck_assert_int_eq(active_count(&x, N), count[k]);
  }
  active_free(&x);
}

/* From 1 to 1e-17, the place of a bound or of stick: there to the last bit. The
 * load that is left is 0.5 and rounding. */
TEST(increment_ends_on_its_bounds) {
  const double place = 1e-17, force[2] = {0.0, 0.0};
  for (int side = 0; side < 2; ++side) {
    CONTACT_CASE c = one_node(4.0, 2.0, 0.5);
    OWNED velocity_form *v = NULL;
    contact_problem left;
    double u[2] = {place, place}, *start = u;
    c.gap[0] = place;
    c.ut0[0] = side ? 5.0 : place;
    c.cp.side_gap = side ? &place : NULL;
    c.f[0] = 4.0 * (1.0 + DBL_EPSILON);
    c.f[1] = 2.5;
    ck_assert_int_eq(velocity_form_new(&c.cp, &v), OK);
    velocity_form_old(v)[0] = velocity_form_old(v)[1] = 1.0;
    velocity_form_set(v, &c.cp, force, &left, &start);
    ck_assert(left.f[0] == 0.0 && left.f[1] == 0.5);
    ck_assert(left.gap[0] == -1.0 && left.ut0[0] == (side ? 4.0 : -1.0));
    ck_assert(side ? left.side_gap[0] == -1.0 : left.side_gap == NULL);
    ck_assert(start[0] == -1.0 && start[1] == -1.0);
    velocity_form_apply(v, &c.cp, u);
    ck_assert(u[0] == place && u[1] == place);
  }
}

/* Limits by the pressures of three nodes, two of them given: 1 + 2 + 6. */
TEST(given_pressures_are_in_the_limits) {
  int start[4] = {0, 3, 6, 9}, column[9];
  double part[9], u[6], r[6];
  const int known[2] = {1, 2};
  const double force[2] = {10.0, 20.0};
  for (int e = 0; e < 9; ++e) {
    column[e] = e % 3;
    part[e] = 0.1 * (e % 3 + 1);
  }
  const sparse_rows all = {.n = 3, .start = start, .col = column, .val = part};
  CONTACT_CASE c = case_new(2, 3, 0.5);
  contact_problem out;
  OWNED given_form *g = NULL;
  for (int i = 0; i < 6; ++i) c.A[7 * i] = 2.0;
  for (int i = 0; i < 3; ++i) c.g0[i] = 1.0;
  c.cp.B = &all;
  ck_assert_int_eq(given_form_new(&c.cp, 2, known, &g), OK);
  ck_assert_int_eq(given_form_set(g, &c.cp, force, 9.0, u, r, &out), OK);
  for (int i = 0; i < 3; ++i) ck_assert_double_eq_tol(out.g0[i], 9.0, 1e-14);
  for (int e = 0; e < 9; ++e)
    ck_assert(out.B->val[e] == (e % 3 > 0 ? 0.0 : 0.1));
}

TEST(normals_that_move_as_one_carry_no_given_forces) {
  static const int node[] = {0, 1};
  for (int k = 0; k < 2; ++k) {
    CONTACT_CASE c = case_new(2, 2, 0.3);
    OWNED given_form *g = NULL;
    c.A[0] = c.A[5] = c.A[15] = 1.0;
    c.A[2] = c.A[8] = -0.75;
    c.A[10] = 0.75 * 0.75 * (1.0 + (k == 0 ? 0x1p-50 : 0x1p-20));
    const status st = given_form_new(&c.cp, 2, node, &g);
    ck_assert_int_eq(st, k == 0 ? ERR_SINGULAR : OK);
    if (k == 0)
      ck_assert_str_eq(status_message(),
                       "nothing holds the body against given normal forces");
  }
}

UNIT_MAIN("contact")
