/*
 * src/accuracy/theorems: eigenvalues against closed forms, the triangle whose
 * constants are known, bounds and inequality on random problems, and wrong
 * states, which must be told.
 */
#include "accuracy/theorems/theorems.h"
#include "solver/solver.h"
#include "support/contact_case.h"
#include "support/unit.h"

#include <lapacke.h>

enum { PARAM_SIZE = 512 };

static void solve(contact_case *c) {
  double param[PARAM_SIZE / sizeof(double)] = {0.0};
  const solver_ops *ops = solver_find("newton");
  ENDS_BY(contact_solver_free) contact_solver *s = NULL;
  solver_report rep;
  option_defaults(ops->options, param);
  solver_choice choice = {
      .ops = ops, .param = param, .tol = 1e-12, .limit_max_iter = 1000};
  ck_assert_int_eq(contact_solver_new(&choice, &s), OK);
  ck_assert_int_eq(contact_solve(s, &c->cp, NULL, c->u, c->r, &rep), OK);
  ck_assert_int_gt(rep.outcome, 0);
}

/* All nodes on one contact. */
typedef struct looker {
  theorems *t;
  int *id;
  double mu;
  theorems_scene scene;
  theorems_report rep;
} looker;

static void look_at(looker *l, contact_case *c, double mu) {
  *l = (looker){.mu = mu};
  l->id = calloc((size_t)c->cp.n, sizeof *l->id);
  ck_assert_int_eq(theorems_new(&l->t), OK);
  l->scene = (theorems_scene){.cp = &c->cp,
                              .u = c->u,
                              .r = c->r,
                              .n_contact = 1,
                              .contact_id = l->id,
                              .mu = &l->mu,
                              .tol = 1e-10};
}

static const theorems_report *look(looker *l) {
  ck_assert_int_eq(theorems_check(l->t, &l->scene, &l->rep), OK);
  return &l->rep;
}

static void look_away(looker *l) {
  memory_free(l->t);
  free(l->id);
}

/* ---- eigenvalues -------------------------------------------------------- */

/* The chain of n springs: 2 - 2 cos(k pi/(n + 1)). */
static void chain(void *ctx, const double *x, double *y) {
  int n = *(const int *)ctx;
  for (int i = 0; i < n; ++i)
    y[i] = 2.0 * x[i] - (i > 0 ? x[i - 1] : 0.0) - (i + 1 < n ? x[i + 1] : 0.0);
}

/* Eigenvalues 1, 1/2, 1/3, ... */
static void harmonic(void *ctx, const double *x, double *y) {
  int n = *(const int *)ctx;
  for (int i = 0; i < n; ++i) y[i] = x[i] / (1.0 + i);
}

static void nothing(void *ctx, const double *x, double *y) {
  int n = *(const int *)ctx;
  for (int i = 0; i < n; ++i) y[i] = 0.0 * x[i];
}

TEST(largest_eigenvalues_are_those_of_closed_forms) {
  static const int orders[] = {1, 2, 7, 50, DENSE_ORDER, DENSE_ORDER + 1, 700};
  for (size_t k = 0; k < sizeof orders / sizeof *orders; ++k) {
    int n = orders[k];
    double exact = 2.0 - 2.0 * cos(n * acos(-1.0) / (n + 1)), found;
    symmetric_map springs = {n, &n, chain}, row = {n, &n, harmonic};
    symmetric_map zero = {n, &n, nothing};
    ck_assert_int_eq(largest_eigenvalue(&springs, &found), OK);
    ck_assert_double_eq_tol(found, exact, n > DENSE_ORDER ? 4e-3 : 1e-12);
    ck_assert_double_ge(found, exact * (1.0 - 1e-13));
    ck_assert_int_eq(lanczos_largest(&row, &found), OK);
    ck_assert_double_eq_tol(found, 1.0, 1e-9);
    ck_assert_double_ge(found, 1.0 - 1e-13);
    ck_assert_int_eq(lanczos_largest(&springs, &found), OK);
    ck_assert_double_ge(found, exact * (1.0 - 1e-13));
    ck_assert_double_eq_tol(found, exact, n > 160 ? 4e-3 : 1e-12);
    ck_assert_int_eq(largest_eigenvalue(&zero, &found), OK);
    ck_assert_double_eq(found, 0.0);
  }
}

/* ---- the triangle ------------------------------------------------------- */

TEST(triangle_has_its_constants) {
  static const struct {
    double mu, fx, fy;
    mu_regime regime;
    int slides;
  } rows[] = {{0.5, -1.0, 0.3, MU_UNDER, 1},    {0.83, -1.0, 0.3, MU_UNDER, 1},
              {0.84, -1.0, 0.3, MU_BETWEEN, 1}, {1.0, -1.0, 0.3, MU_BETWEEN, 1},
              {1.0, 0.0, -1.0, MU_FREE, 0},     {0.5, 0.0, -1.0, MU_UNDER, 0}};
  for (size_t k = 0; k < sizeof rows / sizeof *rows; ++k) {
    CONTACT_CASE c = case_triangle(0.3, rows[k].mu, rows[k].fx, rows[k].fy);
    const double *K = c.A;
    double exact = sqrt(K[0] * K[3] - K[1] * K[2]) / K[0];
    looker l;
    solve(&c);
    look_at(&l, &c, rows[k].mu);
    const theorems_report *t = look(&l);
    ck_assert_int_eq(t->n_contact, 1);
    ck_assert_double_eq_tol(exact, 0.8315, 5e-5);
    ck_assert_double_eq_tol(t->contacts[0].limit, exact, 1e-12);
    ck_assert_double_eq_tol(t->contacts[0].factor, rows[k].mu / exact, 1e-12);
    if (rows[k].slides) {
      ck_assert_double_eq_tol(t->contacts[0].rate, rows[k].mu / 1.8, 1e-10);
      ck_assert_double_eq_tol(t->contacts[0].suggested, 1.8, 1e-9);
    } else {
      ck_assert_double_eq(t->contacts[0].rate, 0.0);
    }
    ck_assert_int_eq(t->contacts[0].regime, rows[k].regime);
    ck_assert_int_eq(t->total.why == NULL, rows[k].regime == MU_UNDER);
    ck_assert_int_eq(t->violated, 0);
    look_away(&l);
  }
}

/* mu = 3: slip u_t = 1.90666 r = (-1/4, 1/12) solves, and does not contract. */
TEST(above_the_critical_mu_it_does_not_contract) {
  CONTACT_CASE c = case_triangle(0.3, 3.0, 1.9, -1.0);
  looker l;
  look_at(&l, &c, 3.0);
  double s = c.f[1] > 0.0 ? 1.0 : -1.0; /* the tangent's sign along x */
  c.u[0] = 0.0;
  c.u[1] = s * 1.9066666666666667;
  c.r[0] = -1.0 / 12.0;
  c.r[1] = -s * 0.25;
  const theorems_report *t = look(&l);
  ck_assert_int_eq(t->contacts[0].regime, MU_ABOVE);
  ck_assert_double_eq_tol(t->contacts[0].rate, 3.0 / 1.8, 1e-9);
  ck_assert_int_eq(t->inequality_violated, 0);
  look_away(&l);
}

/* ---- constants of any B ------------------------------------------------- */

/* Largest of sum (B dp)_i |dv_t,i| over |dv| |dr|_* by climbing from random
 * starts: never above q, and most of it. */
TEST(factor_bounds_what_friction_can_do) {
  for (int k = 0; k < 12; ++k) {
    int dim = 2 + k % 2, n = 3 + k / 2, m = dim * n;
    CONTACT_CASE c = case_any(dim, n, 0.4, k / 2 % 2, 4100ull + (unsigned)k);
    if (k % 4 > 1) case_average(&c, 2, 0.4);
    solve(&c);
    looker l;
    look_at(&l, &c, 0.4);
    double q = look(&l)->contacts[0].factor, worst = 0.0;
    double W[30 * 30], x[30], y[30], z[30];
    ck_assert(m <= 30 && case_inverse(m, c.A, W));
    unsigned long long seed = 3 + (unsigned)k;
    for (int trial = 0; trial < 4000; ++trial) {
      double vv = 0.0, rr = 0.0, sum = 0.0;
      for (int i = 0; i < m; ++i) {
        y[i] = case_random(&seed) - 0.5;
        z[i] = case_random(&seed) - 0.5;
      }
      contact_product(m, c.A, y, x);
      for (int i = 0; i < m; ++i) vv += y[i] * x[i];
      contact_product(m, W, z, x);
      for (int i = 0; i < m; ++i) rr += z[i] * x[i];
      for (int i = 0; i < n; ++i) {
        double g = 0.0, t = 0.0;
        for (int e = c.B->start[i]; e < c.B->start[i + 1]; ++e)
          g += c.B->val[e] * z[dim * c.B->col[e]];
        for (int a = 1; a < dim; ++a) t = hypot(t, y[dim * i + a]);
        sum += fabs(g) * t;
      }
      worst = fmax(worst, sum / sqrt(vv * rr));
    }
    ck_assert_double_le(worst, q);
    ck_assert_double_gt(worst, 0.05 * q);
    look_away(&l);
  }
}

/* The largest eigenvalue of M[n*n], which is destroyed. */
static double largest_of(int n, double *M) {
  double w[30];
  ck_assert_int_eq(LAPACKE_dsyev(LAPACK_COL_MAJOR, 'N', 'L', n, M, n, w), 0);
  return w[n - 1];
}

/* Limits by the pressure of neighbours: B A_nn B' and inv(A)_tt entry by entry,
 * q the root of the product of their largest eigenvalues. */
TEST(factor_is_that_of_the_matrices) {
  for (int dim = 2; dim < 4; ++dim) {
    enum { N = 5 };
    const int m = dim * N, tangents = (dim - 1) * N;
    double W[15 * 15], B[N * N] = {0.0}, nn[N * N] = {0.0}, tt[10 * 10];
    CONTACT_CASE c = case_any(dim, N, 0.4, 0, 4200ull + (unsigned)dim);
    theorems_contact found = {0};
    energy_norm e;
    case_average(&c, 2, 0.4);
    c.B->val[0] = 0.7; /* not symmetric */
    ck_assert(case_inverse(m, c.A, W));
    for (int i = 0; i < N; ++i)
      for (int k = c.B->start[i]; k < c.B->start[i + 1]; ++k)
        B[i + N * c.B->col[k]] = c.B->val[k];
    for (int k = 0; k < N * N * N * N; ++k) {
      const int i = k % N, j = k / N % N, a = k / (N * N) % N,
                b = k / (N * N * N);
      nn[i + N * j] += B[i + N * a] * c.A[dim * a + m * dim * b] * B[j + N * b];
    }
    for (int i = 0; i < tangents; ++i)
      for (int j = 0; j < tangents; ++j) {
        const int at = i + i / (dim - 1) + 1, to = j + j / (dim - 1) + 1;
        tt[i + tangents * j] = W[at + m * to];
      }
    ck_assert_int_eq(energy_norm_new(m, c.A, &e), OK);
    ck_assert_int_eq(friction_constants(&c.cp, &e, 1, &found), OK);
    const double exact = sqrt(largest_of(N, nn) * largest_of(tangents, tt));
    ck_assert_double_eq_tol(found.factor, exact, 1e-11 * exact);
    energy_norm_free(&e);
  }
}

/* A node with a limit of its own, one with mu; the first is the softer. */
TEST(tangent_counts_given_limits_if_told) {
  CONTACT_CASE c = case_new(2, 2, 0.3);
  theorems_contact with = {0}, without = {0};
  energy_norm e;
  const double diagonal[] = {8, 0.5, 2, 4};
  for (int k = 0; k < 4; ++k) c.A[5 * k] = diagonal[k];
  c.B->val[0] = 0.0;
  c.g0[0] = 1.0;
  ck_assert_int_eq(energy_norm_new(4, c.A, &e), OK);
  ck_assert_int_eq(friction_constants(&c.cp, &e, 1, &with), OK);
  ck_assert_int_eq(friction_constants(&c.cp, &e, 0, &without), OK);
  ck_assert_double_eq_tol(with.tangent, 2.0, 1e-12);
  ck_assert_double_eq_tol(without.tangent, 0.25, 1e-12);
  /* The pressure of the first moves no limit. */
  ck_assert_double_eq_tol(without.normal, 2.0, 1e-12);
  unsigned char held[4] = {0, 1, 0, 0};
  c.cp.held = held;
  ck_assert_int_eq(friction_constants(&c.cp, &e, 1, &with), OK);
  ck_assert_double_eq_tol(with.tangent, 0.25, 1e-12);
  energy_norm_free(&e);
}

/* ---- bounds ------------------------------------------------------------- */

static void scale_friction(contact_case *c, double factor) {
  for (int e = 0; e < c->B->start[c->cp.n]; ++e) c->B->val[e] *= factor;
}

/* Increments under random loads, gaps that move and obstacles that drift. */
TEST(bounds_hold_under_the_guaranteed_limit) {
  int checked = 0;
  for (int k = 0; k < 60; ++k) {
    int dim = 2 + k % 2, n = 1 + k % 9;
    double share = k % 3 == 0 ? 0.95 : 0.5;
    CONTACT_CASE c = case_any(dim, n, 0.3, k / 2 % 2, 5200ull + (unsigned)k);
    unsigned long long seed = 91 + (unsigned)k;
    looker l;
    if (k % 5 == 4) case_average(&c, 2, 0.3);
    look_at(&l, &c, 0.3);
    l.mu *= share / look(&l)->contacts[0].factor;
    scale_friction(&c, share / l.rep.contacts[0].factor);
    look_away(&l);
    look_at(&l, &c, l.mu);
    for (int i = 0; i < c.cp.m; ++i) c.f[i] *= k % 4 == 3 ? 1e-3 : 1.0;
    for (int step = 0; step < 6; ++step) {
      solve(&c);
      const theorems_report *t = look(&l);
      ck_assert_double_eq_tol(t->contacts[0].factor, share, 1e-9);
      ck_assert_ptr_null(t->total.why);
      ck_assert_ptr_null(t->change.why);
      ck_assert_msg(!t->total.violated && !t->change.violated,
                    "case %d step %d: %g <= %g, %g <= %g", k, step,
                    t->total.left, t->total.right, t->change.left,
                    t->change.right);
      ck_assert_double_ge(t->inequality, -1e-10);
      checked += t->change.left > 0.1 * t->change.right;
      for (int i = 0; i < n; ++i)
        for (int a = 1; a < dim; ++a)
          c.ut0[(dim - 1) * i + a - 1] =
              c.u[dim * i + a] + (step == 3 ? 20.0 : 0.0);
      for (int i = 0; i < n && step == 4; ++i) c.gap[i] -= 0.05;
      for (int i = 0; i < c.cp.m; ++i)
        c.f[i] += 0.3 * (case_random(&seed) - 0.5);
    }
    look_away(&l);
  }
  ck_assert_int_gt(checked, 60); /* they are not idle */
}

/* Two nodes with A = diag(4, 4, 9, 9), q = 1/2, lmax(inv(A)_tt) = 4, limits of
 * their own; the second begins in its obstacle. From the state before, the gap
 * of the first opens by 1/4, the second is to stick at 1/4 from its place. */
TEST(bounds_are_those_of_their_formulas) {
  CONTACT_CASE c = case_new(2, 2, 0.3);
  const theorems_contact all = {.factor = 0.5, .tangent = 4.0};
  double u[] = {0.5, 1, -0.5, 2}, far[4], before_u[] = {0.25, 0.5, -0.5, 1},
         r[] = {-2, 0, -4, 0}, before_f[] = {1, 4, 3, 6},
         before_gap[] = {0.75, HUGE_VAL, -0.5, HUGE_VAL}, g[] = {2, 5};
  const state_before before = {1, before_u, r, before_f, before_gap, g};
  theorems_bound b = {0};
  energy_norm e;
  for (int k = 0; k < 4; ++k) c.A[5 * k] = k < 2 ? 4 : 9;
  COPY(c.f, ((double[]){2, 4, 3, 6}), 4);
  COPY(c.gap, ((double[]){1, -0.5}), 2);
  COPY(c.g0, ((double[]){3, 4}), 2);
  COPY(c.ut0, ((double[]){0.5, 1.25}), 2);
  ck_assert_int_eq(energy_norm_new(4, c.A, &e), OK);
  ck_assert_int_eq(bound_total(&c.cp, u, &all, &e, &b), OK);
  ck_assert_double_eq_tol(b.left, sqrt(41.0), 1e-12);
  ck_assert_double_eq_tol(b.right, 2 * (sqrt(15.25) + 5 * 2), 1e-12);
  ck_assert_int_eq(bound_change(&c.cp, u, &before, &all, &e, &b), OK);
  ck_assert_double_eq_tol(b.left, sqrt(6.0625), 1e-12);
  ck_assert_double_eq_tol(b.right, 2 * (0.75 + sqrt(1.6 * 1.6 + 0.04) * 2),
                          1e-12);
  /* Friction that ends: its node is in no constant. */
  c.g0[1] = c.B->val[1] = 0;
  ck_assert_int_eq(bound_change(&c.cp, u, &before, &all, &e, &b), OK);
  ck_assert_ptr_nonnull(b.why);
  /* Rounding of large loads is no violation. */
  c.g0[0] = c.B->val[0] = 0;
  for (int k = 0; k < 4; ++k) {
    far[k] = 1e12 * (1 + 1e-10);
    c.f[k] = 1e12 * c.A[5 * k];
  }
  const theorems_contact none = {.factor = 0};
  c.gap[1] = 1;
  ck_assert_int_eq(bound_total(&c.cp, far, &none, &e, &b), OK);
  ck_assert_int_eq(b.violated, 0);
  energy_norm_free(&e);
}

/* Two contacts of a node each, whose normal force falls by mu A_nt/A_tt times
 * its limit; each row is of its own, and new with matrix or friction. */
TEST(rows_of_contacts_are_their_own) {
  CONTACT_CASE c = case_new(2, 2, 0.5);
  looker l;
  const double A[2][3] = {{4, 1, 5}, {4, 2, 5}}, mu[2] = {0.5, 0.5};
  for (int i = 0; i < 2; ++i) {
    double *at = c.A + 10 * i;
    at[0] = A[i][0];
    at[1] = at[4] = A[i][1];
    at[5] = A[i][2];
    c.u[2 * i + 1] = 1;
    c.r[2 * i] = -1;
    c.r[2 * i + 1] = -0.5;
    c.f[2 * i] = A[i][1] + 1;
    c.f[2 * i + 1] = A[i][2] + 0.5;
  }
  look_at(&l, &c, 0.5);
  l.id[1] = 1;
  l.scene.n_contact = 2;
  l.scene.mu = mu;
  l.scene.alone = 1;
  const theorems_report *t = look(&l);
  ck_assert_int_eq(t->n_contact, 3);
  ck_assert_double_eq_tol(t->contacts[0].rate, 0.1, 1e-6);
  ck_assert_double_eq_tol(t->contacts[1].rate, 0.2, 1e-6);
  ck_assert_double_eq_tol(t->contacts[2].rate, 0.2, 1e-6);
  ck_assert_double_eq_tol(t->contacts[0].tangent, 4.0 / 19, 1e-12);
  ck_assert_double_eq_tol(t->contacts[1].tangent, 0.25, 1e-12);
  ck_assert_str_eq(t->change.why, "no increment");
  const double factor = t->contacts[0].factor;
  c.B->val[0] = 0.25;
  ck_assert_double_eq_tol(look(&l)->contacts[0].factor, factor / 2, 1e-12);
  for (int k = 0; k < 16; ++k) c.A[k] *= 2;
  ck_assert_double_eq_tol(look(&l)->contacts[0].normal, 8, 1e-12);
  c.B->val[0] = c.B->val[1] = 0;
  ck_assert_int_eq(look(&l)->n_contact, 0);
  look_away(&l);
}

/* A map with the eigenvalues 0.9 and 0.5, far from the larger at first. */
static status two_rates(void *ctx, double *size) {
  double *v = ctx;
  const double length = hypot(v[0], v[1]);
  v[0] *= 0.9 / length;
  v[1] *= 0.5 / length;
  *size = hypot(v[0], v[1]);
  return OK;
}

TEST(rate_of_a_map_is_the_largest) {
  double v[2] = {1, 100}, rate;
  const stress_map map = {v, two_rates};
  ck_assert_int_eq(theorems_path_rate(&map, &rate), OK);
  ck_assert_double_eq_tol(rate, 0.9, 1e-6);
}

/* x^k/k!: 10^24/24! = 1.61, 10^25/25! = 0.64. */
TEST(passes_are_the_least) {
  static const double x[] = {0, 0.5, 1, 2, 10}, passes[] = {1, 1, 2, 4, 25};
  for (int k = 0; k < 5; ++k)
    ck_assert_double_eq(theorems_passes(x[k]), passes[k]);
}

/* q = 5, then 1, of increments of 1 with theta = 1/2: L = 10 counts until the
 * next step, 20^52/52! = 0.56. */
TEST(fastest_rate_of_a_step_counts) {
  static const double bound[] = {5, 1, 1}, span[] = {1, 2, 1},
                      passes[] = {25, 52, 4};
  theorems *t = NULL;
  ck_assert_int_eq(theorems_new(&t), OK);
  for (int k = 0; k < 3; ++k) {
    theorems_path p = {.bound = bound[k]};
    theorems_path_learn(t, 0.5, 1, span[k], &p);
    ck_assert_double_eq(p.passes, passes[k]);
    ck_assert_double_eq_tol(p.longest, 1 / bound[k], 1e-15);
  }
  memory_free(t);
}

/* An answer that is too large, or moves too far, violates them. */
TEST(wrong_answers_violate_the_bounds) {
  CONTACT_CASE c = case_any(2, 5, 0.05, 0, 61);
  looker l;
  look_at(&l, &c, 0.05);
  for (int i = 0; i < 5; ++i) c.ut0[i] = 0.0;
  solve(&c);
  ck_assert_int_eq(look(&l)->violated, 0);
  /* From nothing the change is the whole. */
  ck_assert_double_eq_tol(l.rep.change.left, l.rep.total.left,
                          1e-12 * l.rep.total.left);
  ck_assert_double_eq_tol(l.rep.change.right, l.rep.total.right,
                          1e-12 * l.rep.total.right);
  double far = 1.1 * l.rep.total.right / l.rep.total.left;
  for (int i = 0; i < 5; ++i) c.ut0[i] = c.u[2 * i + 1];
  ck_assert_int_eq(look(&l)->change.violated, 0); /* nothing has changed */
  ck_assert_double_eq(l.rep.change.left, 0.0);
  l.scene.tol = 1;
  for (int i = 0; i < 10; ++i) c.u[i] *= 1.0 + 1e-4;
  ck_assert_int_eq(look(&l)->change.violated, 1);
  ck_assert_int_eq(l.rep.inequality_violated, 0);
  ck_assert_int_eq(l.rep.violated, 1);
  l.scene.tol = 1e-10;
  ck_assert_int_eq(look(&l)->inequality_violated, 1);
  for (int i = 0; i < 10; ++i) c.u[i] *= far;
  ck_assert_int_eq(look(&l)->total.violated, 1);
  ck_assert_int_eq(l.rep.violated, 1);
  look_away(&l);
}

/* ---- the inequality ----------------------------------------------------- */

TEST(inequality_tells_wrong_states) {
  for (int k = 0; k < 20; ++k) {
    int dim = 2 + k % 2, fields;
    CONTACT_CASE c =
        case_any(dim, 1 + k % 7, 0.4, k / 2 % 2, 6300ull + (unsigned)k);
    double least, size = 0.0;
    solve(&c);
    ck_assert_int_eq(inequality_least(&c.cp, c.u, &least, &fields), OK);
    ck_assert_double_ge(least, -1e-11);
    ck_assert_int_ge(fields, 32 + 80 * c.cp.n);
    for (int i = 0; i < c.cp.m; ++i)
      size =
          fmax(size, fmax(fabs(c.u[i]), fabs(c.f[i]) / c.A[i * (c.cp.m + 1)]));
    for (int i = 0; i < c.cp.m; ++i)
      for (int way = -1; way < 2; way += 2) {
        double before = c.u[i];
        c.u[i] += way * 1e-4 * size;
        ck_assert_int_eq(inequality_least(&c.cp, c.u, &least, &fields), OK);
        c.u[i] = before;
        ck_assert_msg(least < -1e-10, "case %d unknown %d %+d: %g", k, i, way,
                      least);
      }
  }
}

/* The force of a support that holds a node along the plane does no work. A node
 * deep in its obstacle misses by all of the energy of its displacement, less
 * what it begins with. */
TEST(inequality_of_a_held_node_and_of_a_deep_one) {
  CONTACT_CASE c = case_new(2, 1, 0.0);
  unsigned char held[2] = {0, 1};
  double least;
  int fields;
  c.A[0] = c.A[3] = 4;
  c.f[1] = 3;
  c.cp.held = held;
  ck_assert_int_eq(inequality_least(&c.cp, c.u, &least, &fields), OK);
  ck_assert_double_ge(least, 0.0);
  c.f[1] = 0;
  for (int k = 0; k < 2; ++k) {
    c.gap[0] = k ? -3 : 0;
    c.u[0] = k ? -2 : 1;
    ck_assert_int_eq(inequality_least(&c.cp, c.u, &least, &fields), OK);
    ck_assert_double_eq_tol(least, -1, 1e-12);
  }
}

TEST(inequality_of_no_number_is_not_met) {
  CONTACT_CASE c = case_any(2, 3, 0.4, 0, 5);
  double least;
  int fields;
  solve(&c);
  c.u[2] = NAN;
  ck_assert_int_eq(inequality_least(&c.cp, c.u, &least, &fields), OK);
  ck_assert(!(least >= -1.0));
}

/* A body that nothing loads is pushed out of its obstacle: forces that are
 * rounding of its motion tell nothing, others do. */
TEST(inequality_of_rounding_alone_is_met) {
  double A[16] = {1e3, 0, -1e3, 0, 0, 1e3, 0, 0, -1e3, 0, 1e3, 0, 0, 0, 0, 1e3};
  double f[4] = {1e-17, 0, 4e-18, 0}, u[4] = {-5e-5, 0, -5e-5, 0};
  double gap[2] = {-5e-5, 1e-2}, least;
  int fields;
  const contact_problem cp = {
      .dim = 2, .n = 2, .m = 4, .A = A, .f = f, .gap = gap, .floating = 1};
  ck_assert_int_eq(inequality_least(&cp, u, &least, &fields), OK);
  ck_assert_double_ge(least, -1e-10);
  f[2] = 1e-10;
  ck_assert_int_eq(inequality_least(&cp, u, &least, &fields), OK);
  ck_assert_double_lt(least, -1e-3);
}

/* ---- parts -------------------------------------------------------------- */

/* A problem with its limit frozen has the same limit and the same solution. */
TEST(frozen_problems_have_the_same_solution) {
  for (int k = 0; k < 10; ++k) {
    CONTACT_CASE c = case_any(2 + k % 2, 6, 0.4, 0, 7400ull + (unsigned)k);
    unsigned char keep[6] = {1, 0, 1, 1, 0, 0}, given[6] = {0, 1, 0, 1, 0, 0};
    double least;
    int fields;
    frozen_problem p;
    for (int i = 0; i < 6; ++i) c.g0[i] = 0.01 * i;
    solve(&c);
    for (int with = 0; with < 2; ++with) {
      OWNED char *parts = memory_new(1, 1);
      OWNS(parts);
      ck_assert_int_eq(frozen_new(&c.cp, c.r, keep, with ? given : NULL, &p),
                       OK);
      for (int i = 0; i < 6; ++i)
        ck_assert_double_eq_tol(contact_node_limit(&p.cp, p.r, i),
                                contact_node_limit(&c.cp, c.r, i), 1e-13);
      ck_assert_double_le(contact_residual(&p.cp, c.u, p.r), 1e-11);
      ck_assert_double_eq(p.B.val[p.B.start[1]], 0.0);
      ck_assert_double_eq(p.gap[1], with ? HUGE_VAL : c.gap[1]);
      ck_assert_int_eq(inequality_least(&p.cp, c.u, &least, &fields), OK);
      ck_assert_double_ge(least, -1e-11);
    }
  }
}

/* A block on its floor: u_t has no energy-free part, loads have no norm. */
TEST(block_held_by_contact_has_a_limit_and_no_bounds) {
  case_block_data d = {.columns = 4,
                       .layers = 4,
                       .symmetric = 1,
                       .nu = 0.2,
                       .mu = 0.05,
                       .top = {0, -1}};
  contact_case c = case_block(&d);
  looker l;
  solve(&c);
  look_at(&l, &c, 0.05);
  const theorems_report *t = look(&l);
  ck_assert_int_eq(t->contacts[0].regime, MU_UNDER);
  ck_assert_ptr_nonnull(t->total.why);
  ck_assert_int_eq(t->violated, 0);
  look_away(&l);
  case_free(&c);
  d.symmetric = 0; /* friction alone resists sliding */
  c = case_block(&d);
  solve(&c);
  look_at(&l, &c, 0.05);
  ck_assert(isinf(look(&l)->contacts[0].factor));
  ck_assert_double_eq(l.rep.contacts[0].limit, 0.0);
  look_away(&l);
  case_free(&c);
}

TEST(refused_memory_is_told_and_returned) {
  CONTACT_CASE c = case_any(3, 4, 0.2, 0, 8);
  solve(&c);
  size_t before = memory_in_use();
  for (int k = 1;; ++k) {
    looker l;
    look_at(&l, &c, 0.2);
    memory_refuse(k, 0);
    status st = theorems_check(l.t, &l.scene, &l.rep);
    memory_refuse(0, 0);
    look_away(&l);
    ck_assert_uint_eq(memory_in_use(), before);
    if (st == OK) {
      ck_assert_int_gt(k, 10);
      break;
    }
    ck_assert_int_eq(st, ERR_MEMORY);
  }
}

UNIT_MAIN("theory")
