/* src/solver/lcp.c, lemke.c: complementary pivoting. */
#include "solver/lcp/lcp.h"
#include "solver/pivoting/lemke.h"
#include "solver/solver.h"
#include "support/contact_case.h"
#include "support/unit.h"

/* ---- plain problems ------------------------------------------------------ */

enum { MOST = 12 };

/* Largest violation of z >= 0, w >= 0, z w = 0 over max |q|. */
static double violation(int n, const double *M, const double *q,
                        const double *z) {
  double worst = 0.0, size = 1e-300;
  for (int i = 0; i < n; ++i) {
    double w = q[i];
    for (int j = 0; j < n; ++j) w += M[i + n * j] * z[j];
    size = fmax(size, fabs(q[i]));
    worst = fmax(worst, fmax(-w, -z[i]));
    worst = fmax(worst, fmin(fabs(w), fabs(z[i])));
  }
  return worst / size;
}

/* Gaussian elimination with row exchange; 0: singular. A[n][n+1] */
static int eliminate(int n, double A[MOST][MOST + 1]) {
  for (int k = 0; k < n; ++k) {
    int best = k;
    for (int i = k; i < n; ++i)
      if (fabs(A[i][k]) > fabs(A[best][k])) best = i;
    if (fabs(A[best][k]) < 1e-11) return 0;
    for (int j = 0; j <= n; ++j) {
      double t = A[k][j];
      A[k][j] = A[best][j];
      A[best][j] = t;
    }
    for (int i = 0; i < n; ++i) {
      if (i == k) continue;
      double l = A[i][k] / A[k][k];
      for (int j = k; j <= n; ++j) A[i][j] -= l * A[k][j];
    }
  }
  return 1;
}

/* All sets of basic z tried. Returns the number of solutions found with a
 * regular basis; the first one in z. */
static int enumerate(int n, const double *M, const double *q, double *z) {
  int found = 0;
  for (int set = 0; set < 1 << n; ++set) {
    int id[MOST], k = 0, good = 1;
    double A[MOST][MOST + 1], x[MOST] = {0.0};
    for (int i = 0; i < n; ++i)
      if (set >> i & 1) id[k++] = i;
    for (int a = 0; a < k; ++a) {
      for (int b = 0; b < k; ++b) A[a][b] = M[id[a] + n * id[b]];
      A[a][k] = -q[id[a]];
    }
    if (!eliminate(k, A)) continue;
    for (int a = 0; a < k; ++a) {
      x[id[a]] = A[a][k] / A[a][a];
      good = good && x[id[a]] > -1e-9;
    }
    if (good && violation(n, M, q, x) < 1e-8 && found++ == 0)
      memcpy(z, x, (size_t)n * sizeof *z);
  }
  return found;
}

TEST(murty_matrix_takes_four_pivots) {
  const double M[] = {1, 0, 2, 2, 1, 0, 0, 2, 1}, q[] = {-1, -1, -1};
  double z[3];
  lcp_report rep;
  ck_assert_int_eq(lcp_lemke(3, M, q, 0, z, &rep), OK);
  ck_assert_int_eq(rep.outcome, CONVERGED);
  for (int i = 0; i < 3; ++i) ck_assert_double_eq_tol(z[i], 1.0 / 3.0, 1e-15);
  ck_assert_int_eq(rep.pivots, 4);
}

TEST(exponential_example_takes_two_to_the_n_pivots) {
  for (int n = 4; n <= 10; n += n == 4 ? 4 : 2) {
    double M[100] = {0.0}, q[10], z[10];
    lcp_report rep;
    for (int i = 0; i < n; ++i) {
      q[i] = -1.0;
      M[i + n * i] = 1.0;
      for (int j = 0; j < i; ++j) M[i + n * j] = 2.0;
    }
    ck_assert_int_eq(lcp_lemke(n, M, q, 0, z, &rep), OK);
    ck_assert_int_eq(rep.outcome, CONVERGED);
    ck_assert_int_eq(rep.pivots, 1 << n);
    ck_assert(rep.residual < 1e-14);
    ck_assert_int_eq(lcp_lemke(n, M, q, 10, z, &rep), OK);
    ck_assert_int_eq(rep.outcome, STOPPED_ITERATIONS);
    ck_assert_int_eq(rep.pivots, 10);
  }
}

/* The matrix on which the active-set Newton method cycles. */
TEST(newton_cycle_matrix_takes_three_pivots) {
  const double M[] = {3, 2, 0, -1, 1, -3, 1, 1, 1}, q[] = {2, -3, -1};
  double z[3];
  lcp_report rep;
  ck_assert_int_eq(lcp_lemke(3, M, q, 0, z, &rep), OK);
  ck_assert_int_eq(rep.outcome, CONVERGED);
  ck_assert_int_eq(rep.pivots, 3);
  ck_assert(z[0] == 0.0);
  ck_assert_double_eq_tol(z[1], 0.5, 1e-15);
  ck_assert_double_eq_tol(z[2], 2.5, 1e-15);
}

/* k rows of numbers in [-2, 2], integers on request. */
static int random_rows(int n, int whole, unsigned long long *seed,
                       double G[MOST][MOST]) {
  int k = 1 + (int)(case_random(seed) * n);
  for (int i = 0; i < MOST; ++i)
    for (int j = 0; j < MOST; ++j) {
      G[i][j] = 4.0 * case_random(seed) - 2.0;
      if (whole) G[i][j] = round(G[i][j]);
    }
  return k;
}

/* kind 0: M = G'G with G [k*n] of small integers (semidefinite, many ties);
 * 1: G'G + skew + I; 2: random P-matrix (strictly diagonally dominant);
 * 3: skew-symmetric integers plus a semidefinite part. */
static void random_lcp(int kind, int n, unsigned long long *seed, double *M,
                       double *q) {
  double G[MOST][MOST];
  int k = random_rows(n, kind != 1 && kind != 2, seed, G);
  for (int i = 0; i < n; ++i) {
    q[i] = 4.0 * case_random(seed) - 2.5;
    if (kind != 1) q[i] = round(q[i]);
    for (int j = 0; j < n; ++j) {
      double sum = 0.0, skew = i < j ? G[i][j] : i > j ? -G[j][i] : 0.0;
      for (int a = 0; a < k; ++a) sum += G[a][i] * G[a][j];
      if (kind == 2) sum = i == j ? 2.1 * n : G[i][j];
      M[i + n * j] =
          sum + (kind == 1 || kind == 3 ? skew : 0.0) + (kind == 1 && i == j);
    }
  }
}

TEST(random_problems_agree_with_enumeration) {
  unsigned long long seed = 20240229;
  int solved = 0, rays = 0;
  for (int t = 0; t < 2000; ++t) {
    double M[64], q[8], z[8], x[8];
    int n = 1 + t % 8, kind = t / 8 % 4;
    lcp_report rep;
    random_lcp(kind, n, &seed, M, q);
    ck_assert_int_eq(lcp_lemke(n, M, q, 0, z, &rep), OK);
    int found = enumerate(n, M, q, x);
    if (rep.outcome == CONVERGED) {
      ck_assert_msg(violation(n, M, q, z) < 1e-11, "%d: %g", t,
                    violation(n, M, q, z));
      ck_assert_msg(found > 0, "%d", t);
      for (int i = 0; (kind == 1 || kind == 2) && i < n; ++i)
        ck_assert_double_eq_tol(z[i], x[i], 1e-10);
      ++solved;
      continue;
    }
    /* M is positive semidefinite in the wide sense: the ray is a proof */
    double qy = 0.0, size = 0.0;
    ck_assert_msg(rep.outcome == STOPPED_RAY, "%d: %d", t, rep.outcome);
    ck_assert_msg(found == 0, "%d: ray, but %d solutions", t, found);
    for (int i = 0; i < n; ++i) size = fmax(size, z[i]);
    for (int i = 0; i < n; ++i) {
      double sum = 0.0;
      for (int j = 0; j < n; ++j) sum += M[j + n * i] * z[j];
      ck_assert(z[i] >= 0.0 && sum <= 1e-10 * size);
      qy += q[i] * z[i];
    }
    ck_assert_msg(qy < -1e-6 * size, "%d: q'y = %g", t, qy);
    ++rays;
  }
  ck_assert_int_gt(solved, 1200);
  ck_assert_int_gt(rays, 100);
}

TEST(large_random_problems_are_solved) {
  unsigned long long seed = 7;
  for (int n = 50; n <= 200; n += 50) {
    FREED double *M = calloc((size_t)(n * n), sizeof *M);
    FREED double *G = calloc((size_t)(n * n), sizeof *G);
    FREED double *q = calloc((size_t)n, sizeof *q),
                 *z = calloc((size_t)n, sizeof *z);
    lcp_report rep;
    for (int i = 0; i < n * n; ++i) G[i] = case_random(&seed) - 0.5;
    for (int i = 0; i < n; ++i) {
      q[i] = case_random(&seed) - 0.7;
      for (int j = 0; j < n; ++j)
        for (int k = 0; k < n; ++k) M[i + n * j] += G[i + n * k] * G[j + n * k];
    }
    ck_assert_int_eq(lcp_lemke(n, M, q, 0, z, &rep), OK);
    ck_assert_int_eq(rep.outcome, CONVERGED);
    ck_assert_msg(violation(n, M, q, z) < 1e-11, "n = %d", n);
  }
}

/* ---- contact ------------------------------------------------------------- */

/* Solve by LEMKE alone, without the wrapper. */
static solver_report solve_direct(const contact_case *c, int max_iter,
                                  double *motion) {
  double param[8] = {0.0};
  solver_control control = {.tol = 1e-11, .max_iter = max_iter};
  solver_report rep;
  OWNED void *work = NULL;
  ck_assert(lemke_solver.param_size <= sizeof param);
  ck_assert_int_eq(solver_set_up(&lemke_solver, &c->cp, param, &work), OK);
  ck_assert_int_eq(
      lemke_solver.solve(&c->cp, param, work, &control, c->u, c->r, &rep), OK);
  const double *ray = lemke_ray(work);
  ck_assert_int_eq(ray != NULL, rep.outcome == STOPPED_RAY);
  if (ray != NULL && motion != NULL)
    memcpy(motion, ray, (size_t)c->cp.m * sizeof *motion);
  return rep;
}

static void must_solve(const contact_case *c, double tol, const char *what,
                       int k) {
  solver_report rep = solve_direct(c, 0, NULL);
  ck_assert_msg(rep.outcome == CONVERGED, "%s %d: %s", what, k,
                outcome_text(rep.outcome));
  double bad = case_violation(c, c->u, c->r);
  ck_assert_msg(bad <= tol, "%s %d: violation %g", what, k, bad);
}

TEST(plane_problems_are_exact_for_any_friction) {
  static const double mus[] = {0.0, 0.1, 0.5, 1.0, 2.0, 20.0, 1e4};
  for (int k = 0; k < 1050; ++k) {
    CONTACT_CASE c =
        case_any(2, 1 + k % 30, mus[k % 7], k % 2, (unsigned long long)k + 77);
    must_solve(&c, k % 7 == 6 ? 1e-10 : 1e-12, "problem", k);
  }
}

TEST(space_problems_are_corrected_to_the_exact_cone) {
  static const double mus[] = {0.0, 0.1, 0.3, 0.5};
  for (int k = 0; k < 100; ++k) {
    CONTACT_CASE c = case_any(3, 1 + k % 20, mus[k % 4], k / 4 % 2,
                              (unsigned long long)k + 177);
    must_solve(&c, 1e-9, "problem", k);
  }
}

/* Given limits, limits that other nodes bring, and all at once. */
TEST(given_and_shared_limits_are_solved) {
  for (int k = 0; k < 300; ++k) {
    unsigned long long seed = (unsigned long long)k + 5;
    int n = 2 + k % 12;
    CONTACT_CASE c = case_any(2, n, 0.3, k % 2, seed);
    for (int i = 0; i < n; ++i) c.g0[i] = case_random(&seed);
    if (k % 3 == 0) c.cp.B = NULL;
    if (k % 3 == 1)
      for (int i = 0; i < n; ++i) c.B->col[i] = (i + 1) % n;
    must_solve(&c, 1e-12, "problem", k);
  }
}

/* Node i decoupled: its tangential unknown is prescribed. */
static void hold(contact_case *c, unsigned char *held, int dof) {
  int m = c->cp.m;
  for (int j = 0; j < m; ++j)
    if (j != dof) c->A[dof + m * j] = c->A[j + m * dof] = 0.0;
  held[dof] = 1;
  c->f[dof] = 0.3 * c->A[dof + m * dof];
}

TEST(held_sided_and_smooth_nodes_agree_with_newton) {
  for (int k = 0; k < 200; ++k) {
    int dim = 2 + k % 2, n = 4 + k % 9, m = dim * n;
    CONTACT_CASE c = case_any(dim, n, 0.2, k / 2 % 2, (unsigned long long)k);
    FREED unsigned char *held = calloc((size_t)m, 1);
    double *u = calloc((size_t)m, sizeof *u), param[8] = {0.0};
    c.side_gap = calloc((size_t)(m - n), sizeof *c.side_gap);
    for (int i = 0; i < m - n; ++i) c.side_gap[i] = HUGE_VAL;
    c.side_gap[dim - 1] = 0.05;                     /* node 1 touches a wall */
    for (int i = 1; i <= 2; ++i) c.B->val[i] = 0.0; /* node 2 is smooth */
    hold(&c, held, 3 * dim + 1);
    c.cp.side_gap = c.side_gap;
    c.cp.held = held;
    ck_assert_int_eq(solve_direct(&c, 0, NULL).outcome, CONVERGED);
    ck_assert(contact_residual(&c.cp, c.u, c.r) <= 1e-11);
    ck_assert_double_eq_tol(c.u[3 * dim + 1], 0.3, 1e-15);
    ck_assert(c.r[3 * dim + 1] == 0.0);
    memcpy(u, c.u, (size_t)m * sizeof *u);
    solver_choice choice = {
        .ops = solver_find("newton"), .param = param, .tol = 1e-12};
    ENDS_BY(contact_solver_free) contact_solver *s = NULL;
    solver_report rep;
    ck_assert_int_eq(contact_solver_new(&choice, &s), OK);
    memset(c.u, 0, (size_t)m * sizeof *u);
    memset(c.r, 0, (size_t)m * sizeof *u);
    ck_assert_int_eq(contact_solve(s, &c.cp, NULL, c.u, c.r, &rep), OK);
    double apart = 0.0, size = 0.0;
    for (int i = 0; i < m; ++i) {
      apart = fmax(apart, fabs(u[i] - c.u[i]));
      size = fmax(size, fabs(u[i]));
    }
    if (rep.outcome == CONVERGED)
      ck_assert_msg(apart <= 1e-9 * size, "%d: apart by %g", k, apart / size);
    free(u);
  }
}

/* ---- one triangle -------------------------------------------------------- */

/* Corner C of the clamped triangle A = (-1,1), B = (1,3), E = 1, nu = 0.3;
 * F in the axes x (tangent), y (into the body). */
static contact_case corner(double mu, double fx, double fy) {
  contact_case c = case_new(2, 1, mu);
  double diagonal = 45.0 / 52.0, coupling = -25.0 / 52.0;
  c.A[0] = c.A[3] = diagonal;
  c.A[1] = c.A[2] = -coupling; /* the outward normal is -y */
  c.f[0] = -fy;
  c.f[1] = fx;
  return c;
}

TEST(corner_of_a_triangle_takes_a_listed_solution) {
  static const struct {
    double mu, fx, fy;
    int n;
    double found[3][3]; /* u_t, r_t, normal force                            */
  } load[] = {
      {1, 0, -1, 1, {{0, 0, 1}}},
      {1, -1, .3, 1, {{-.9657142857, .1642857143, .1642857143}}},
      {1, 1.9, -1, 1, {{2.2471428571, 0, 0}}},
      {2, 1.9, -1, 3, {{2.2471428571, 0, 0}, {0, -1.9, 1}, {1.04, -1, .5}}},
      {3,
       1.9,
       -1,
       3,
       {{2.2471428571, 0, 0}, {0, -1.9, 1}, {1.9066666667, -.25, .0833333333}}},
      {1, 1, .01, 1, {{NAN, 0, 0}}},
  };
  for (size_t k = 0; k < sizeof load / sizeof *load; ++k) {
    CONTACT_CASE c = corner(load[k].mu, load[k].fx, load[k].fy);
    must_solve(&c, 1e-14, "load", (int)k);
    int hit = 0;
    for (int i = 0; i < load[k].n; ++i) {
      const double *x = load[k].found[i];
      hit += (isnan(x[0]) || fabs(c.u[1] - x[0]) < 1e-9) &&
             fabs(c.r[1] - x[1]) < 1e-9 && fabs(-c.r[0] - x[2]) < 1e-9;
    }
    ck_assert_msg(hit == 1, "load %zu: u_t %.10g r_t %.10g N %.10g", k, c.u[1],
                  c.r[1], -c.r[0]);
  }
}

/* ---- blocks -------------------------------------------------------------- */

TEST(pressed_block_of_equal_nodes_is_exact) {
  for (int mu = 0; mu < 2; ++mu) {
    case_block_data d = {
        .columns = 40, .layers = 10, .clamped = 1, .mu = 0.3 * mu};
    CONTACT_CASE c = case_block(&d);
    for (int i = 0; i < c.cp.n; ++i) {
      c.f[2 * i] = i == 0 || i == 40 ? 0.5 : 1.0; /* pushed at the contact */
      c.gap[i] = 0.0;
    }
    must_solve(&c, 1e-13, "closed", mu);
    for (int i = 0; i < c.cp.n; ++i) ck_assert(c.u[2 * i] == 0.0);
    /* pulled: all open at once */
    for (int i = 0; i < c.cp.m; ++i) c.f[i] *= -1.0;
    must_solve(&c, 1e-12, "open", mu);
    for (int i = 0; i < c.cp.n; ++i) ck_assert(c.r[2 * i] == 0.0);
    /* in equilibrium without force: nothing to decide, everything tied */
    for (int i = 0; i < c.cp.n; ++i) c.gap[i] = 0.25;
    for (int i = 0; i < c.cp.m; ++i) {
      c.f[i] = 0.0;
      for (int j = 0; j < c.cp.m; j += 2) c.f[i] += c.A[i + c.cp.m * j] * 0.25;
    }
    ck_assert_int_ge(solve_direct(&c, 0, NULL).outcome, CONVERGED);
    for (int i = 0; i < c.cp.n; ++i)
      ck_assert_double_eq_tol(c.u[2 * i], 0.25, 1e-13);
  }
}

/* A floating block: forces of the resultants given, on its lower nodes. */
static contact_case loaded_block(double mu, double down, double right,
                                 double at) {
  case_block_data d = {.columns = 16, .layers = 8, .nu = 0.3, .mu = mu};
  contact_case c = case_block(&d);
  /* pressure a + b x of the resultant and the moment asked for */
  double s0 = 0.0, s1 = 0.0, s2 = 0.0;
  for (int i = 0; i <= 16; ++i) {
    double x = i / 16.0 - 0.5;
    s0 += 1.0;
    s1 += x;
    s2 += x * x;
  }
  double b = (at * down * s0 - s1 * down) / (s2 * s0 - s1 * s1);
  double a = (down - b * s1) / s0;
  for (int i = 0; i <= 16; ++i) {
    double x = i / 16.0 - 0.5;
    c.f[2 * i] = a + b * x;
    c.f[2 * i + 1] = right / 17.0;
  }
  return c;
}

/* The motion that ends the search: no elastic force, no penetration, and the
 * load does work on it. */
static void check_motion(const contact_case *c, const double *v) {
  double size = 0.0, force = 0.0, work = 0.0;
  for (int i = 0; i < c->cp.m; ++i) size = fmax(size, fabs(v[i]));
  ck_assert(size > 0.0);
  for (int i = 0; i < c->cp.m; ++i) {
    double sum = 0.0;
    for (int j = 0; j < c->cp.m; ++j) sum += c->A[i + c->cp.m * j] * v[j];
    force = fmax(force, fabs(sum));
    work += c->f[i] * v[i];
    if (i % 2 == 0) ck_assert(v[i] <= 1e-10 * size);
  }
  ck_assert_msg(force < 1e-9 * size, "force %g", force / size);
  ck_assert_msg(work > 0.0, "work %g", work);
}

TEST(floating_block_rests_or_ends_in_a_motion) {
  static const struct {
    double mu, down, right, at;
    int rests;
  } load[] = {
      {0.3, 1, 0, 0, 1},     {0.3, 1, 0.1, 0.2, 1}, {0.3, 1, 0.29, 0, 1},
      {0.3, 1, 0.31, 0, 0},  {0.3, 1, 0, 0.49, 1},  {0.3, 1, 0, 0.51, 0},
      {0.3, -1, 0, 0, 0},    {0.0, 1, 0, 0.2, 1},   {0.0, 1, 0.1, 0, 0},
      {0.0, 1, 0, -0.52, 0}, {1.0, 1, -0.9, 0, 1},  {1.0, 1, -1.1, 0, 0},
  };
  for (size_t k = 0; k < sizeof load / sizeof *load; ++k) {
    double v[34], push = 0.0;
    CONTACT_CASE c =
        loaded_block(load[k].mu, load[k].down, load[k].right, load[k].at);
    solver_report rep = solve_direct(&c, 0, v);
    ck_assert_msg(rep.outcome == (load[k].rests ? CONVERGED : STOPPED_RAY),
                  "load %zu: %s", k, outcome_text(rep.outcome));
    if (load[k].rests) {
      double bad = case_violation(&c, c.u, c.r);
      ck_assert_msg(bad < 1e-11, "load %zu: %g", k, bad);
      for (int i = 0; i < c.cp.n; ++i) push -= c.r[2 * i];
      ck_assert_double_eq_tol(push, 1.0, 1e-10);
    } else {
      check_motion(&c, v);
    }
  }
}

TEST(limit_of_pivots_stops_the_solver) {
  CONTACT_CASE c = case_any(2, 30, 0.3, 0, 3);
  solver_report rep = solve_direct(&c, 3, NULL);
  ck_assert_int_eq(rep.outcome, STOPPED_ITERATIONS);
  ck_assert_int_eq(rep.iterations, 3);
}

/* Factors 2^k on forces and lengths: the same pivots, the same bits. */
TEST(powers_of_two_change_no_bit) {
  for (int k = 0; k < 60; ++k) {
    int dim = 2 + k % 2, n = 3 + k % 11, e = k % 4 < 2 ? 41 : -37;
    double F = k % 3 == 0 ? 1.0 : ldexp(1.0, e),
           L = ldexp(1.0, 3 * (k % 5) - 7);
    CONTACT_CASE a = case_any(dim, n, 0.3 * (k % 3), k / 2 % 2, 9);
    CONTACT_CASE b = case_any(dim, n, 0.3 * (k % 3), k / 2 % 2, 9);
    for (int i = 0; i < a.cp.m * a.cp.m; ++i) b.A[i] *= F / L;
    for (int i = 0; i < a.cp.m; ++i) b.f[i] *= F;
    for (int i = 0; i < n; ++i) b.gap[i] *= L;
    for (int i = 0; i < n * (dim - 1); ++i) b.ut0[i] *= L;
    solver_report ra = solve_direct(&a, 0, NULL),
                  rb = solve_direct(&b, 0, NULL);
    ck_assert_int_eq(ra.outcome, rb.outcome);
    ck_assert_int_eq(ra.iterations, rb.iterations);
    for (int i = 0; i < a.cp.m; ++i) {
      ck_assert_msg(b.u[i] == a.u[i] * L, "%d: u[%d] %a %a", k, i, a.u[i],
                    b.u[i] / L);
      ck_assert(b.r[i] == a.r[i] * F);
    }
  }
}

/* ---- compliance alone ---------------------------------------------------- */

TEST(compliance_form_gives_the_same_answer) {
  static const double mus[] = {0.0, 0.2, 0.6};
  for (int k = 0; k < 120; ++k) {
    int dim = 2 + k % 2, n = 1 + k % 10, m = dim * n;
    CONTACT_CASE c =
        case_any(dim, n, mus[k % 3], k / 2 % 2, (unsigned long long)k + 31);
    double *W = calloc((size_t)(m * m), sizeof *W), param[8] = {0.0};
    FREED double *q = calloc((size_t)m, sizeof *q),
                 *u = calloc((size_t)m, sizeof *u);
    double *r = calloc((size_t)m, sizeof *r), apart = 0.0, size = 0.0;
    must_solve(&c, 1e-9, "stiffness", k);
    ck_assert(case_inverse(m, c.A, W));
    contact_product(m, W, c.f, q);
    contact_problem soft = c.cp;
    soft.A = NULL;
    soft.W = W;
    soft.f = q;
    solver_choice choice = {.ops = &lemke_solver, .param = param, .tol = 1e-10};
    ENDS_BY(contact_solver_free) contact_solver *s = NULL;
    solver_report rep;
    ck_assert_int_eq(contact_solver_new(&choice, &s), OK);
    ck_assert_int_eq(contact_solve(s, &soft, NULL, u, r, &rep), OK);
    ck_assert_msg(rep.outcome == CONVERGED, "%d: %s, residual %g", k,
                  outcome_text(rep.outcome), rep.residual);
    for (int i = 0; i < m; ++i) {
      apart = fmax(apart, fabs(u[i] - c.u[i]));
      size = fmax(size, fabs(c.u[i]));
    }
    ck_assert_msg(apart <= 1e-8 * size, "%d: apart by %g", k, apart / size);
    free(W);
    free(r);
  }
}

/* ---- memory -------------------------------------------------------------- */

TEST(every_refused_request_is_reported_without_loss) {
  CONTACT_CASE c = case_any(3, 4, 0.3, 0, 3);
  double M[16] = {2, 1, 0, 0, 1, 2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, z[4];
  double q[4] = {-1, -1, -1, -1}, param[8] = {0.0};
  lcp_report rep;
  void *work;
  UNIT_REFUSED(21, solver_set_up(&lemke_solver, &c.cp, param, &work),
               ck_assert((work == NULL) == refused);
               memory_free(work));
  UNIT_REFUSED(1, lcp_lemke(4, M, q, 0, z, &rep), );
}

UNIT_MAIN("lemke")
