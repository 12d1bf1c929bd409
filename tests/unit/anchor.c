/*
 * Bodies that contact alone holds, by every row: solvers that need the
 * compliance get the problem with springs on the motions of the body. What the
 * obstacle carries follows from statics.
 */
#include "solver/choice/choice.h"

#include "support/operated_case.h"
#include "support/solver_rows.h"
#include "support/unit.h"

enum { NODES = 12, MODES = 6 };

/* ---- a truss in space on a floor -----------------------------------------
 */

/* NODES joints near z = 0, every two joined by a bar: nothing resists the six
 * motions of a rigid body. Unknowns (-z, x, y) of a joint. x[3*NODES] */
static contact_case truss(double mu, double *x) {
  contact_case c = case_new(3, NODES, mu);
  unsigned long long seed = 99;
  int m = c.cp.m;
  for (int i = 0; i < NODES; ++i) {
    x[3 * i] = i % 4 + 0.3 * case_random(&seed);
    x[3 * i + 1] = i / 4 + 0.3 * case_random(&seed);
    x[3 * i + 2] = 0.4 * case_random(&seed);
  }
  for (int i = 0; i < NODES; ++i)
    for (int j = 0; j < i; ++j) {
      double e[3], length = 0.0;
      for (int k = 0; k < 3; ++k) {
        double d = x[3 * i + k] - x[3 * j + k];
        e[k == 2 ? 0 : k + 1] = k == 2 ? -d : d;
        length += d * d;
      }
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b) {
          double s = e[a] * e[b] / length;
          c.A[3 * i + a + m * (3 * i + b)] += s;
          c.A[3 * j + a + m * (3 * j + b)] += s;
          c.A[3 * i + a + m * (3 * j + b)] -= s;
          c.A[3 * j + a + m * (3 * i + b)] -= s;
        }
    }
  c.cp.floating = 1;
  return c;
}

/* Force and moment about the origin of the forces a[3*NODES], (-z, x, y). */
static void resultant(const double *x, const double *a, double sum[6]) {
  memset(sum, 0, 6 * sizeof *sum);
  for (int i = 0; i < NODES; ++i) {
    const double *p = x + 3 * i;
    double F[3] = {a[3 * i + 1], a[3 * i + 2], -a[3 * i]};
    for (int k = 0; k < 3; ++k) {
      int k1 = (k + 1) % 3, k2 = (k + 2) % 3;
      sum[k] += F[k];
      sum[3 + k] += p[k1] * F[k2] - p[k2] * F[k1];
    }
  }
}

/* Weight and a push of 0.2 of it along x + y, friction 0.5: the floor carries
 * both, and their moments. */
static void stand(int by_products) {
  double x[3 * NODES], load[6], floor_force[6];
  CONTACT_CASE c = truss(0.5, x);
  for (int i = 0; i < NODES; ++i) {
    c.f[3 * i] = 1.0;
    c.f[3 * i + 1] = c.f[3 * i + 2] = 0.2 / sqrt(2.0);
    c.gap[i] = 0.01 * i;
  }
  resultant(x, c.f, load);
  operated_case *o = by_products ? operated_new(&c) : NULL;
  EACH_SOLVER(i, ops) {
    if (o != NULL && ops != NULL && ops->entries != NULL) continue;
    case_cold(&c);
    solver_report rep = solve_by(ops, &c, 1e-11, c.u, c.r);
    ck_assert_msg(rep.outcome == CONVERGED, "%s: %s", row_name(ops),
                  outcome_text(rep.outcome));
    resultant(x, c.r, floor_force);
    for (int k = 0; k < 6; ++k)
      ck_assert_msg(fabs(load[k] + floor_force[k]) <= 1e-9 * NODES,
                    "%s: %d: %g", row_name(ops), k, load[k] + floor_force[k]);
    ck_assert_double_le(case_violation(&c, c.u, c.r), 1e-9);
  }
  if (o != NULL) operated_free(o, &c);
}

TEST(truss_stands_by_statics) { stand(0); }

TEST(truss_stands_by_products_alone) { stand(1); }

/* The null vectors are the six motions of a rigid body, and orthonormal. */
TEST(modes_are_the_rigid_motions) {
  double x[3 * NODES], y[3 * NODES];
  CONTACT_CASE c = truss(0.5, x);
  anchor an = {0};
  ck_assert_int_eq(anchor_make(&c.cp, &an), OK);
  ck_assert_int_eq(an.missing, 0);
  ck_assert_int_eq(an.n_mode, MODES);
  for (int a = 0; a < MODES; ++a) {
    const double *v = an.R + 3 * NODES * a;
    contact_product(3 * NODES, c.A, v, y);
    for (int i = 0; i < 3 * NODES; ++i) ck_assert_double_le(fabs(y[i]), 1e-13);
    for (int b = 0; b < MODES; ++b) {
      double sum = a == b ? -1.0 : 0.0;
      for (int i = 0; i < 3 * NODES; ++i) sum += v[i] * an.R[3 * NODES * b + i];
      ck_assert_double_le(fabs(sum), 1e-14);
    }
  }
  anchor_free(&an);
}

/* The springs of an operator: a solve is the inverse of a product. */
TEST(springs_of_an_operator_are_in_its_inverse) {
  enum { M = 3 * NODES };
  double x[M], b[M], u[M], Au[M], Ax[M];
  CONTACT_CASE c = truss(0.5, x);
  operated_case *o = operated_new(&c);
  const known_rows none = {0};
  unsigned long long seed = 7;
  anchor an = {0};
  int singular = 1;
  ck_assert_int_eq(anchor_make(&c.cp, &an), OK);
  ck_assert_int_eq(an.missing, 0);
  for (int i = 0; i < M; ++i) b[i] = case_random(&seed) - 0.4;
  ck_assert_int_eq(an.op.set_rows(an.op.ctx, &none, &singular), OK);
  an.op.solve(an.op.ctx, b, u, Au);
  an.op.apply(an.op.ctx, u, Ax, NULL);
  for (int i = 0; i < M; ++i) {
    ck_assert_double_eq_tol(Ax[i], b[i], 1e-11);
    ck_assert_double_eq_tol(Au[i], b[i], 1e-11);
  }
  anchor_free(&an);
  operated_free(o, &c);
}

/* ---- a block on a floor --------------------------------------------------
 */

static contact_case block(double mu, double push, double shear) {
  case_block_data d = {.columns = 16,
                       .layers = 8,
                       .nu = 0.2,
                       .mu = mu,
                       .top = {shear * 1e-3, -push * 1e-3}};
  return case_block(&d);
}

/* Two blocks side by side, one pushed along the floor: six motions. */
TEST(two_bodies_stand_apart) {
  CONTACT_CASE one = block(0.4, 1.0, 0.1), two = case_new(2, 34, 0.4);
  int m = one.cp.m;
  for (int j = 0; j < 2 * m; ++j) {
    two.f[j] = (j / m == 0 || j % 2 == 0) * one.f[j % m];
    for (int i = 0; i < 2 * m; ++i)
      if (i / m == j / m)
        two.A[i + 2 * m * j] = one.A[i % m + m * (j % m)] * (1 + i / m);
  }
  two.cp.floating = 1;
  EACH_SOLVER(i, ops) {
    case_cold(&two);
    solver_report rep = solve_by(ops, &two, 1e-10, two.u, two.r);
    ck_assert_msg(rep.outcome == CONVERGED, "%s", row_name(ops));
    for (int k = 0; k < 4; ++k) {
      static const double force[] = {-0.016, -0.0016, -0.016, 0.0};
      double sum = 0.0;
      for (int j = 0; j < m; j += 2) sum += two.r[k / 2 * m + j + k % 2];
      ck_assert_double_eq_tol(sum, force[k], 1e-11);
    }
  }
}

/* The floor lies far below (30: four thousand times the compression) and is
 * hollow, or is level and the block is pushed: the weight arrives there. */
TEST(block_falls_to_its_floor) {
  static const double far[] = {0.0, 1.0, 30.0};
  const solver_ops *ops;
  for (int k = 0; k < 6; ++k) {
    CONTACT_CASE c = block(0.4, 1.0, k < 3 ? 0.0 : 0.1);
    for (int i = 0; i < c.cp.n; ++i)
      c.gap[i] = far[k % 3] + (k < 3 ? 2e-5 * (i - 8) * (i - 8) : 0.0);
    for (int i = 0; solver_row(i, &ops); ++i) {
      case_cold(&c);
      solver_report rep = solve_by(ops, &c, 1e-9, c.u, c.r);
      ck_assert_int_ne(rep.outcome, STOPPED_RAY);
      if (ops != NULL && (ops->handles & SOLVES_FLOATING) &&
          rep.outcome != CONVERGED)
        continue; /* a start so far off is too much for some */
      ck_assert_msg(rep.outcome == CONVERGED, "%s: gap %g: %s", row_name(ops),
                    far[k % 3], outcome_text(rep.outcome));
      double push = 0.0;
      for (int j = 0; j < c.cp.n; ++j) push -= c.r[2 * j];
      ck_assert_double_eq_tol(push, 0.016, 1e-7 * 0.016);
    }
  }
}

/* Lifted, pushed too hard, tipped: a ray, after few passes. */
TEST(drift_is_told_as_a_ray) {
  static const struct {
    double mu, push, shear;
  } hopeless[] = {{0.3, -1, 0}, {0, 1, 0.1}, {0.3, 1, 0.4}, {3, 1, 1.2}};
  const solver_ops *ops;
  for (int k = 0; k < 4; ++k) {
    CONTACT_CASE c = block(hopeless[k].mu, hopeless[k].push, hopeless[k].shear);
    for (int i = 0; solver_row(i, &ops); ++i) {
      if (ops == NULL || (ops->handles & SOLVES_FLOATING)) continue;
      case_cold(&c);
      solver_report rep = solve_by(ops, &c, 1e-10, c.u, c.r);
      ck_assert_msg(rep.outcome == STOPPED_RAY, "%s: %d: %s", ops->name, k,
                    outcome_text(rep.outcome));
    }
  }
}

/* On the floor and far above it. */
TEST(factors_of_two_change_no_bit) {
  EACH_SOLVER(i, ops)
  for (int far = 0; far < 2; ++far) {
    if (ops == NULL || (ops->handles & SOLVES_FLOATING)) continue;
    CONTACT_CASE c = block(0.3, 1.0, 0.2), d = block(0.3, 1.0, 0.2);
    for (int j = 0; j < c.cp.n; ++j) c.gap[j] = d.gap[j] = 30.0 * far;
    case_units(&d, -13, 28);
    case_cold(&c);
    case_cold(&d);
    solver_report one = solve_by(ops, &c, 1e-9, c.u, c.r);
    solver_report two = solve_by(ops, &d, 1e-9, d.u, d.r);
    ck_assert_int_eq(one.iterations, two.iterations);
    for (int j = 0; j < c.cp.m; ++j)
      ck_assert(d.u[j] == ldexp(c.u[j], -13) && d.r[j] == ldexp(c.r[j], 28));
  }
}

TEST(refused_memory_is_given_back) {
  CONTACT_CASE c = block(0.3, 1.0, 0.1);
  double param[PARAM_SIZE / sizeof(double)] = {0.0};
  solver_choice choice = {
      .ops = solver_find("pcg"), .param = param, .tol = 1e-9};
  size_t before = memory_in_use();
  status st = ERR_MEMORY;
  option_defaults(choice.ops->options, param);
  for (int k = 1; st == ERR_MEMORY && k < 1000; ++k) {
    contact_solver *s = NULL;
    solver_report rep;
    case_cold(&c);
    memory_refuse(k, 0);
    st = contact_solver_new(&choice, &s);
    if (st == OK) st = contact_solve(s, &c.cp, NULL, c.u, c.r, &rep);
    memory_refuse(0, 0);
    contact_solver_free(&s);
    ck_assert(st == OK || st == ERR_MEMORY);
    ck_assert_uint_eq(memory_in_use(), before);
  }
  ck_assert_int_eq(st, OK);
}

UNIT_MAIN("anchor")
