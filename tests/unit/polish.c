/* The last touch of an answer: slip too short for the residual to see. */
#include "solver/choice/choice.h"

#include "support/solver_rows.h"
#include "support/unit.h"

static const double TOL = 1e-11;   /* residual of the answers             */
static const double SHORT = 1e-8;  /* slip of the first node, of |u| ~ 1  */
static const double ASIDE = 1e-13; /* of u, far below TOL                 */
static const double ANGLE = 0.6;   /* angle of its slip, rad              */
enum { NODES = 6, M = 3 * NODES };

/* A random problem with an answer made up: all nodes touch with a pressure of
 * 1, the first slips by SHORT under the angle ANGLE, the others stick. */
static contact_case short_slip(double *u, double *r) {
  contact_case c = case_any(3, NODES, 0.5, 0, 11);
  for (int i = 0; i < M; ++i) {
    int node_id = i / 3, k = i % 3;
    double slips = node_id == 0 ? 1.0 : 0.2;
    double e = k == 1 ? cos(ANGLE) : sin(ANGLE);
    u[i] = k == 0 ? c.gap[node_id] : 0.0;
    if (k > 0 && node_id == 0) u[i] = SHORT * e;
    r[i] = k == 0 ? -1.0 : -0.5 * slips * e;
    if (k > 0) c.ut0[2 * node_id + k - 1] = 0.0;
  }
  contact_product(M, c.A, u, c.f);
  for (int i = 0; i < M; ++i) c.f[i] -= r[i];
  return c;
}

static double angle_of(const double *a) { return atan2(a[2], a[1]); }

/* The slip is off by ASIDE across its direction, SHORT/ASIDE of a radian, at a
 * residual below the tolerance: the touch finds the direction. */
TEST(short_slip_gets_its_direction) {
  double u[M], r[M];
  CONTACT_CASE c = short_slip(u, r);
  int sweeps = 0;
  u[1] -= ASIDE * sin(ANGLE);
  u[2] += ASIDE * cos(ANGLE);
  contact_reaction(&c.cp, u, r);
  ck_assert_double_le(contact_residual(&c.cp, u, r), 0.1 * TOL);
  ck_assert_double_gt(fabs(angle_of(u) - ANGLE), 0.9 * ASIDE / SHORT);
  ck_assert_double_gt(slip_misdirection(&c.cp, u, r), 10 * TOL);
  for (int k = 1; k < 3; ++k) { /* one tangent alone has no direction to miss */
    unsigned char held[M] = {0};
    held[k] = 1;
    c.cp.held = held;
    ck_assert(slip_misdirection(&c.cp, u, r) == 0);
    c.cp.held = NULL;
  }
  ck_assert_int_eq(polish_slip(&c.cp, TOL, 0, u, r, &sweeps), OK);
  ck_assert_int_eq(sweeps, 0);
  ck_assert_int_eq(polish_slip(&c.cp, TOL, 20, u, r, &sweeps), OK);
  ck_assert_int_ge(sweeps, 1);
  ck_assert_double_le(slip_misdirection(&c.cp, u, r), TOL);
  ck_assert_double_le(contact_residual(&c.cp, u, r), TOL);
  double size = hypot(r[1], r[2]);
  ck_assert_double_le(fabs(u[1] * r[2] - u[2] * r[1]), 1e-10 * SHORT * size);
}

/* A better direction that misses the tolerance of the forces is not taken. */
TEST(state_beyond_the_tolerance_is_left) {
  double u[M], r[M], kept[M];
  CONTACT_CASE c = short_slip(u, r);
  int sweeps = 0;
  u[1] = SHORT * cos(ANGLE + 0.5);
  u[2] = SHORT * sin(ANGLE + 0.5);
  u[M - 3] -= 0.1 * SHORT;
  contact_reaction(&c.cp, u, r);
  memcpy(kept, u, sizeof u);
  ck_assert_int_eq(polish_slip(&c.cp, TOL, 1, u, r, &sweeps), OK);
  ck_assert_int_eq(sweeps, 1);
  ck_assert_mem_eq(kept, u, sizeof u);
}

/* Sticking nodes entered the obstacle and slid by no more than the residual can
 * see: they are put back, and only then; the one that slips stays, also that
 * before a wall, which has no friction, and the last, which is open, keeps no
 * force. */
TEST(held_nodes_lie_on_the_obstacle) {
  double u[M], r[M];
  CONTACT_CASE c = short_slip(u, r);
  enum { OPEN = M - 3, WALL = M - 6 };
  double side[2 * NODES];
  for (int i = 0; i < 2 * NODES; ++i) side[i] = i == 8 ? 1 : HUGE_VAL;
  c.cp.side_gap = side;
  u[WALL + 1] = u[WALL + 2] = 0.01;
  memset(r + WALL + 1, 0, 2 * sizeof *r);
  u[OPEN] -= 1;
  memset(r + OPEN, 0, 3 * sizeof *r);
  contact_product(M, c.A, u, c.f);
  for (int i = 0; i < M; ++i) c.f[i] -= r[i];
  double residual = -1, scale = contact_scale(&c.cp);
  ck_assert_int_eq(polish_touch(&c.cp, scale, TOL, u, r, &residual), OK);
  ck_assert(residual == -1);
  u[0] += 1e-3 * TOL;
  for (int i = 3; i < OPEN; ++i) u[i] += 1e-3 * TOL * (i % 2 == 0 ? 1 : -1);
  contact_reaction(&c.cp, u, r);
  memset(r + OPEN, 0, 3 * sizeof *r);
  ck_assert_double_le(contact_residual(&c.cp, u, r), TOL);
  ck_assert_int_eq(polish_touch(&c.cp, scale, TOL, u, r, &residual), OK);
  ck_assert(residual == contact_residual(&c.cp, u, r));
  ck_assert_double_le(residual, TOL);
  residual = -1;
  for (int k = 0; k < 3; ++k) ck_assert(r[OPEN + k] == 0);
  for (int i = 0; i < NODES - 1; ++i) {
    ck_assert(u[3 * i] == c.gap[i]);
    if (3 * i != WALL)
      ck_assert(u[3 * i + 1] == (i == 0 ? SHORT * cos(ANGLE) : 0));
  }
  /* one that misses the tolerance itself is left alone */
  double kept = u[1] += 1e6 * TOL;
  u[3] += 1e-3 * TOL;
  ck_assert_int_eq(polish_touch(&c.cp, scale, TOL, u, r, &residual), OK);
  ck_assert(residual == -1);
  ck_assert(u[1] == kept && u[3] != c.gap[1]);
}

/* An exact answer is left as it is, in the plane any. */
TEST(exact_answer_is_left_alone) {
  double u[M], r[M], kept[M];
  CONTACT_CASE c = short_slip(u, r), plane = case_any(2, NODES, 0.5, 0, 3);
  int sweeps = 1;
  memcpy(kept, u, sizeof u);
  ck_assert_double_le(slip_misdirection(&c.cp, u, r), TOL);
  ck_assert_int_eq(polish_slip(&c.cp, TOL, 20, u, r, &sweeps), OK);
  ck_assert_int_eq(sweeps, 0);
  ck_assert_int_eq(memcmp(kept, u, sizeof u), 0);
  ck_assert(slip_misdirection(&plane.cp, plane.u, plane.r) == 0.0);
}

/* What every row hands out, in both forms; the compliance form rounds u to
 * 2^-52 of the largest and the direction to that over the slip. */
TEST(rows_hand_out_the_direction) {
  double u[M], r[M], W[M * M], q[M];
  CONTACT_CASE c = short_slip(u, r);
  const solver_ops *ops;
  ck_assert(case_inverse(M, c.A, W));
  contact_product(M, W, c.f, q);
  for (int form = 0; form < 2; ++form) {
    c.cp.W = form == 0 ? NULL : W;
    c.cp.A = form == 0 ? c.A : NULL;
    c.cp.f = form == 0 ? c.f : q;
    for (int i = 0; solver_row(i, &ops); ++i) {
      case_cold(&c);
      solver_report rep = solve_by(ops, &c, TOL, c.u, c.r);
      ck_assert_msg(rep.outcome == CONVERGED, "%s", row_name(ops));
      double bad = slip_misdirection(&c.cp, c.u, c.r);
      ck_assert_msg(bad <= (form == 0 ? TOL : 4 * 0x1p-52 / SHORT), "%s: %g",
                    row_name(ops), bad);
      ck_assert_double_eq_tol(rep.residual, contact_residual(&c.cp, c.u, c.r),
                              1e-14);
    }
  }
}

UNIT_MAIN("polish")
