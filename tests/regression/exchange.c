/*
 * Discrete problems: written by one run and read by another, made here in the
 * layout of FCLIB, plain LCPs; their verdicts.
 */
#include "solver/solver.h"
#include "support/contact_case.h"
#include "support/fclib_file.h"
#include "support/job.h"
#include "support/unit.h"

#include <unistd.h>

static const char *in_folder(const job *j, const char *file) {
  static char path[256];
  snprintf(path, sizeof path, "%s/%s", j->dir, file);
  return path;
}

static double *take(const job *j, const char *file, const char *name, int *n) {
  double *x = fclib_take(in_folder(j, file), name, n);
  ck_assert_msg(x != NULL, "%s: no %s", file, name);
  return x;
}

static double largest(int n, const double *x) {
  double most = 0.0;
  for (int k = 0; k < n; ++k) most = fmax(most, fabs(x[k]));
  return most;
}

/* ---- round trip ---- */

static void compare(const job *j, const char *one, const char *other,
                    const char *name) {
  int n, n_other;
  FREED double *a = take(j, one, name, &n), *b = take(j, other, name, &n_other);
  ck_assert_int_eq(n, n_other);
  ck_assert_int_gt(n, 0);
  double scale = largest(n, a);
  ck_assert_msg(scale > 0.0, "%s: %s is zero", one, name);
  for (int k = 0; k < n; ++k)
    ck_assert_msg(fabs(a[k] - b[k]) <= 1e-10 * scale, "%s[%d]: %.15g, %.15g",
                  name, k, a[k], b[k]);
}

/* The file by itself: its solution solves its problem. Rows of W are columns
 * of the array, which the check transposes: W is symmetric. */
static void check_file(const job *j, const char *file, int dim) {
  int m, n, k;
  double *W = take(j, file, "/fclib_local/W/x", &k);
  double *q = take(j, file, "/fclib_local/vectors/q", &m);
  double *mu = take(j, file, "/fclib_local/vectors/mu", &n);
  double *u = take(j, file, "/solution/u", &k);
  double *r = take(j, file, "/solution/r", &k);
  ck_assert_int_eq(m, dim * n);
  ck_assert_double_le(fclib_violation(dim, n, W, q, mu, u, r), 1e-9);
  ck_assert_double_gt(largest(m, r), 0.0);
  free(W), free(q), free(mu), free(u), free(r);
}

/* Sums of gaps, slip and forces: a file has its nodes in another order. Slip in
 * space only, where no node of the scene is held; carried: nodes that slide
 * with their supports, whose friction is in no condensed problem. */
static void compare_tables(const dat *a, const dat *b, int carried) {
  static const char *const name[] = {"gap",  "slip_1", "slip_2", "f_n",
                                     "f_t1", "f_t2",   "f_t",    "limit"};
  int compared = 0;
  ck_assert_int_eq(a->n_row, b->n_row);
  for (size_t k = 0; k < sizeof name / sizeof *name; ++k) {
    if (!dat_has(a, name[k]) || !dat_has(b, name[k])) continue;
    if (carried > 0 && strcmp(name[k], "f_t") == 0) continue;
    ++compared;
    double scale = fmax(dat_max(a, name[k]), dat_max(a, k < 3 ? "u_n" : "f_n"));
    ck_assert_msg(
        fabs(dat_sum(a, name[k]) - dat_sum(b, name[k])) <= 1e-8 * scale,
        "%s: %g, %g", name[k], dat_sum(a, name[k]), dat_sum(b, name[k]));
  }
  ck_assert_int_ge(compared, 2);
}

/* The second increment of a deck, solved again from its file. */
static void round_trip(job *j, const char *solver, int carried) {
  static const char *const counted[] = {"open", "slip", "stick"};
  double count[3];
  for (int c = 0; c < 3; ++c) count[c] = job_told(j, counted[c]);
  count[1] -= carried;
  count[2] += carried;
  DAT was = job_table(j, "CONTACT", -1);
  job_write(j, "back.inp",
            "*CONDENSED PROBLEM, FILE=%s_condensed_00002.h5\n*STEP\n"
            "*SOLVER, TOL=1e-13%s\n*OUTPUT, CONDENSED=FCLIB\n*PRINT, CONTACT\n"
            "*END STEP\n",
            j->name, solver);
  char name[32];
  PRINTED(first, "%s_condensed_00002.h5", j->name);
  strcpy(name, j->name);
  strcpy(j->name, "back");
  ck_assert_msg(job_run(j, "") == 0, "%s", j->errors);
  for (int c = 0; c < 3; ++c)
    ck_assert_double_eq(job_told(j, counted[c]), count[c]);
  DAT now = job_table(j, "CONTACT", -1);
  compare_tables(&was, &now, carried);
  strcpy(j->name, name);
  compare(j, first, "back_condensed_00001.h5", "/solution/u");
  compare(j, first, "back_condensed_00001.h5", "/solution/r");
}

/* Unit square on a floor, pressed and pushed; held at its top or by contact
 * alone, then no compliance exists. */
static job run_square(const char *support, const char *law) {
  job j = job_with(
      "square", "tests/regression/mesh/square.geo",
      "*PARAMETER\nN = 6\n*MESH, FILE=square.geo\n"
      "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
      "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
      "*OBSTACLE, NAME=O, TYPE=PLANE\n0., -0.0005\n0.001, 1.\n"
      "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n%s"
      "*STEP\n*QUASISTATIC\n0.5, 1.\n*BOUNDARY\n%s"
      "*DSLOAD\nTOP, P, 10.\nLEFT, P, 4.\n"
      "*SOLVER, TOL=1e-13\n"
      "*OUTPUT, HDF5=NO, CONDENSED=FCLIB\n*PRINT, CONTACT\n*END STEP\n",
      law, support);
  CK_EXIT(job_run(&j, ""), 0, j);
  return j;
}

#define COULOMB "*FRICTION, CONTACT=C, LAW=COULOMB\n0.02\n"

/* Solved to a percent, the bound of the error is over r' W r / 2. */
static void check_bound(job *j, const char *file) {
  int m, k;
  double energy = 0.0, *W = take(j, file, "/fclib_local/W/x", &k);
  double *r = take(j, file, "/solution/r", &m);
  for (int a = 0; a < m; ++a)
    for (int b = 0; b < m; ++b) energy += 0.5 * r[a] * W[a + m * b] * r[b];
  job_write(j, "rough.inp",
            "*CONDENSED PROBLEM, FILE=%s\n*STEP\n*ACCURACY\n"
            "*SOLVER, METHOD=SOR, TOL=1E-2\n*END STEP\n",
            file);
  strcpy(j->name, "rough");
  ck_assert_msg(job_run(j, "") == 0, "%s", j->errors);
  double bound = job_told(j, "solver_error_energy");
  ck_assert_double_gt(bound, 0);
  ck_assert_double_eq_tol(
      job_told(j, "solver_error_percent") / (100 * sqrt(bound / energy)), 1,
      0.1);
  free(W), free(r);
}

/* The forces of a file are those of the table at the same nodes. */
static void check_nodes(const job *j, const char *file) {
  int n, m;
  double *no = take(j, file, "/node_no", &n),
         *r = take(j, file, "/solution/r", &m);
  DAT t = job_table(j, "CONTACT", -1);
  ck_assert(n == t.n_row && m == 2 * n);
  for (int i = 0; i < n; ++i)
    ck_assert_double_eq_tol(
        dat_at(&t, dat_row_near(&t, "node_no", no[i]), "f_n"), r[2 * i], 1e-12);
  free(no), free(r);
}

TEST(problem_written_and_read_has_the_same_solution) {
  job j = run_square("LEFT, 1, 1, 0.001\nTOP, 2, 2, -0.004\n", COULOMB);
  check_file(&j, "square_condensed_00002.h5", 2);
  check_nodes(&j, "square_condensed_00002.h5");
  round_trip(&j, "", 1);
  check_bound(&j, "square_condensed_00002.h5");
  job_end(&j);
  j = run_square("RIGHT, 1\n", COULOMB); /* its corner node is held          */
  round_trip(&j, "", 0);
  job_end(&j);
  j = run_square("RIGHT, 1\nRIGHT, 2\n", "");
  check_file(&j, "square_condensed_00002.h5", 2);
  round_trip(&j, ", METHOD=SOR", 0);
  job_end(&j);
}

TEST(problem_of_three_dimensions_comes_back) {
  JOB j = job_with(
      "block", "input/block_shear_3d/block_shear_3d.geo",
      "*MESH, FILE=block_shear_3d.geo\n"
      "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
      "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
      "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
      "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n" COULOMB
      "*STEP\n*QUASISTATIC\n0.5, 1.\n*BOUNDARY\n"
      "TOP, 1, 1, 0.012\nTOP, 2, 2, 0.004\nTOP, 3, 3, -0.02\n"
      "*SOLVER, TOL=1e-13\n"
      "*OUTPUT, HDF5=NO, CONDENSED=FCLIB\n*PRINT, CONTACT\n*END STEP\n");
  job_write(&j, "block_condensed_00003.h5", "of an earlier run");
  ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
  ck_assert_int_ne(access(in_folder(&j, "block_condensed_00003.h5"), F_OK), 0);
  check_file(&j, "block_condensed_00002.h5", 3);
  round_trip(&j, "", 0);
}

/* The layout has no place for a given sliding limit. */
TEST(what_cannot_be_written_is_refused) {
  JOB j = job_with("square", "tests/regression/mesh/square.geo",
                   "*PARAMETER\nN = 2\n*MESH, FILE=square.geo\n"
                   "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
                   "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
                   "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"
                   "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
                   "*FRICTION, CONTACT=C, LAW=TRESCA\n1.\n"
                   "*STEP\n*STATIC\n*BOUNDARY\nTOP, 1, 2, -0.001\n"
                   "*OUTPUT, CONDENSED=FCLIB\n*END STEP\n");
  ck_assert_int_eq(job_run(&j, ""), 2);
  ck_assert_ptr_nonnull(strstr(j.errors, "CONDENSED=FCLIB"));
}

/* ---- a rigid block ---- */

enum { FEET = 8, MASS = 6 };

/* Block 2 x 1 x 1 on a floor; FEET contacts, two at each corner, so that W has
 * rank 6 of 24. Velocities v at the centre, order x y z and rotations; one time
 * step: M v = H r + f, f = weight and a push P along x at height "h". */
typedef struct rigid {
  double M[MASS * MASS], H[MASS * 3 * FEET], f[MASS], w[3 * FEET], mu[FEET];
  double W[9 * FEET * FEET], q[3 * FEET];
} rigid;

static const double WEIGHT = 10.0;

static void rigid_make(rigid *b, double push, double height, double mu) {
  static const double inertia[MASS] = {2.0, 2.0, 2.0, 0.3, 0.8, 0.9};
  memset(b, 0, sizeof *b);
  for (int k = 0; k < MASS; ++k) b->M[k + MASS * k] = inertia[k];
  b->f[0] = push;
  b->f[2] = -WEIGHT;
  b->f[4] = push * (height - 0.5); /* about y, from the centre                */
  for (int i = 0; i < FEET; ++i) {
    double x = i & 1 ? 1.0 : -1.0, y = i & 2 ? 0.5 : -0.5, z = -0.5;
    /* v of the foot = v + omega x (x, y, z); N = z, T1 = x, T2 = y. */
    double *N = b->H + MASS * 3 * i, *T1 = N + MASS, *T2 = T1 + MASS;
    N[2] = 1.0, N[3] = y, N[4] = -x;
    T1[0] = 1.0, T1[4] = z, T1[5] = -y;
    T2[1] = 1.0, T2[3] = -z, T2[5] = x;
    b->mu[i] = mu;
  }
  int m = 3 * FEET;
  for (int i = 0; i < m; ++i)
    for (int k = 0; k < MASS; ++k) {
      b->q[i] += b->H[k + MASS * i] * b->f[k] / inertia[k];
      for (int j = 0; j < m; ++j)
        b->W[i + m * j] += b->H[k + MASS * i] * b->H[k + MASS * j] / inertia[k];
    }
}

static int solve_file(job *j, const char *solver) {
  job_write(j, "read.inp",
            "*CONDENSED PROBLEM, FILE=problem.h5\n*STEP\n*SOLVER, TOL=1e-8%s\n"
            "*OUTPUT, CONDENSED=FCLIB\n*END STEP\n",
            solver);
  return job_run(j, "");
}

/* Resultant of the feet in the directions of v. */
static void resultant(const rigid *b, const double *r, double sum[MASS]) {
  for (int k = 0; k < MASS; ++k) {
    sum[k] = 0.0;
    for (int i = 0; i < 3 * FEET; ++i) sum[k] += b->H[k + MASS * i] * r[i];
  }
}

/* push below mu WEIGHT: the floor carries all of it. Above: it slips, and the
 * floor carries mu WEIGHT; low enough not to tip. */
static void check_rigid(job *j, const rigid *b, double push, double mu,
                        double height) {
  int m;
  double sum[MASS];
  FREED double *r = take(j, "read_condensed_00001.h5", "/solution/r", &m);
  FREED double *u = take(j, "read_condensed_00001.h5", "/solution/u", &m);
  ck_assert_double_le(fclib_violation(3, FEET, b->W, b->q, b->mu, u, r), 1e-7);
  resultant(b, r, sum);
  double held = fmin(push, mu * WEIGHT);
  ck_assert_double_eq_tol(sum[0], -held, 1e-6);
  ck_assert_double_eq_tol(sum[2], WEIGHT, 1e-6);
  ck_assert_double_eq_tol(sum[4], -push * (height - 0.5), 1e-6);
  for (int i = 0; i < FEET; ++i)
    ck_assert_double_eq_tol(u[3 * i + 1], (push - held) / 2.0, 1e-6);
}

TEST(rigid_block_obeys_statics) {
  static const double push[] = {2.0, 4.5, 0.0}, mu[] = {0.4, 0.3, 0.4};
  const double height = 0.2;
  FREED rigid *b = malloc(sizeof *b);
  for (int k = 0; k < 3; ++k)
    for (int global = 0; global <= 1; ++global) {
      JOB j = job_begin("read");
      rigid_make(b, push[k], height, mu[k]);
      const fclib_global_data g = {3,    FEET, MASS, b->M,
                                   b->H, b->f, b->w, b->mu};
      if (global)
        fclib_global(in_folder(&j, "problem.h5"), STORE_TRIPLET, &g);
      else
        fclib_local(in_folder(&j, "problem.h5"), STORE_ROWS, 3, FEET, b->W,
                    b->q, b->mu);
      int code = solve_file(&j, "");
      ck_assert_msg(code == 0, "push %g, mu %g: exit %d: %s", push[k], mu[k],
                    code, j.errors);
      check_rigid(&j, b, push[k], mu[k], height);
    }
}

/* Two masses 2 that move by v = (f + r) / 2, u = v + w: the first is pressed
 * with 10 - 2 and slides against mu 8 = 0.4, the second stays off. */
TEST(slip_and_gap_are_those_of_the_moved_obstacle) {
  double M[36] = {0}, H[36] = {0};
  const double f[6] = {-10, 0, 0, 1, 0.4, 0}, w[6] = {1, 0.3, 0.4, 1, 0, -0.5};
  const double mu[2] = {0.05, 0.05}, u[6] = {0, 0.18, 0.24, 1.5, 0.2, -0.5};
  for (int i = 0; i < 6; ++i) {
    M[7 * i] = 2.0;
    H[7 * i] = 1.0;
  }
  const fclib_global_data g = {3, 2, 6, M, H, f, w, mu};
  JOB j = job_begin("read");
  fclib_global(in_folder(&j, "problem.h5"), STORE_TRIPLET, &g);
  job_write(&j, "read.inp",
            "*CONDENSED PROBLEM, FILE=problem.h5\n*STEP\n*SOLVER, TOL=1e-12\n"
            "*PRINT, CONTACT\n*END STEP\n");
  CK_EXIT(job_run(&j, ""), 0, j);
  DAT c = job_table(&j, "CONTACT", -1);
  ck_assert_int_eq(c.n_row, 2);
  for (int i = 0; i < 2; ++i) {
    ck_assert_double_eq_tol(dat_at(&c, i, "gap"), u[3 * i], 1e-9);
    ck_assert_double_eq_tol(dat_at(&c, i, "slip_1"), u[3 * i + 1], 1e-9);
    ck_assert_double_eq_tol(dat_at(&c, i, "slip_2"), u[3 * i + 2], 1e-9);
  }
  ck_assert_double_eq_tol(dat_at(&c, 0, "f_n"), 8, 1e-9);
  ck_assert_double_eq_tol(dat_at(&c, 0, "f_t1"), -0.24, 1e-9);
  ck_assert_double_eq_tol(dat_at(&c, 0, "f_t2"), -0.32, 1e-9);
}

enum { STOREYS = 20, JOINTS = 4 * STOREYS, FREE = 6 * STOREYS };

/* A tower of unit cubes, four contacts between two of them, pushed at the top:
 * W of rank 120 of 240. It sticks: the floor carries the whole weight. */
TEST(tower_of_blocks_stands) {
  static const double inertia[6] = {1.0, 1.0, 1.0, 0.17, 0.17, 0.17};
  const double weight = 0.01, push = 0.0005;
  int m = 3 * JOINTS, n;
  double *M = calloc(FREE * FREE, sizeof *M);
  double *H = calloc((size_t)(FREE * m), sizeof *H);
  double *W = calloc((size_t)(m * m), sizeof *W), f[FREE] = {0};
  double w[3 * JOINTS] = {0}, q[3 * JOINTS] = {0}, mu[JOINTS];
  for (int k = 0; k < FREE; ++k) M[k + FREE * k] = inertia[k % 6];
  for (int b = 0; b < STOREYS; ++b) f[6 * b + 2] = -weight;
  f[6 * (STOREYS - 1)] = push;
  for (int i = 0; i < JOINTS; ++i) {
    mu[i] = 0.5;
    for (int below = 0; below <= (i >= 4); ++below) {
      double x = i & 1 ? 0.5 : -0.5, y = i & 2 ? 0.5 : -0.5;
      double s = below ? -1.0 : 1.0, z = below ? 0.5 : -0.5;
      double *N = H + FREE * 3 * i + 6 * (i / 4 - below);
      double *T1 = N + FREE, *T2 = T1 + FREE;
      N[2] = s, N[3] = s * y, N[4] = -s * x;
      T1[0] = s, T1[4] = s * z, T1[5] = -s * y;
      T2[1] = s, T2[3] = -s * z, T2[5] = s * x;
    }
  }
  for (int i = 0; i < m; ++i)
    for (int k = 0; k < FREE; ++k) {
      double h = H[k + FREE * i] / inertia[k % 6];
      q[i] += h * f[k];
      for (int c = 0; c < m && h != 0.0; ++c)
        W[i + m * c] += h * H[k + FREE * c];
    }
  const fclib_global_data g = {3, JOINTS, FREE, M, H, f, w, mu};
  JOB j = job_begin("read");
  fclib_global(in_folder(&j, "problem.h5"), STORE_COLUMNS, &g);
  ck_assert_msg(solve_file(&j, "") == 0, "%s", j.errors);
  double *r = take(&j, "read_condensed_00001.h5", "/solution/r", &n);
  double *u = take(&j, "read_condensed_00001.h5", "/solution/u", &n);
  ck_assert_double_le(fclib_violation(3, JOINTS, W, q, mu, u, r), 1e-7);
  double sum = 0.0, side = 0.0;
  for (int i = 0; i < 4; ++i) sum += r[3 * i], side += r[3 * i + 1];
  ck_assert_double_eq_tol(sum, STOREYS * weight, 1e-7);
  ck_assert_double_eq_tol(side, -push, 1e-7);
  free(r), free(u), free(M), free(H), free(W);
}

/* ---- random problems, every solver ---- */

/* W = b b' + d I with an unsymmetric part of the size "skew". */
static void random_local(int m, double d, double skew, double *W, double *q,
                         unsigned long long *seed) {
  FREED double *b = malloc(sizeof *b * (size_t)(m * m));
  for (int k = 0; k < m * m; ++k) b[k] = 2.0 * case_random(seed) - 1.0;
  for (int i = 0; i < m; ++i) {
    q[i] = 2.0 * case_random(seed) - 1.3;
    for (int j = 0; j < m; ++j) {
      double sum = i == j ? d : skew * (case_random(seed) - 0.5);
      for (int k = 0; k < m; ++k) sum += b[i + m * k] * b[j + m * k] / m;
      W[i + m * j] = sum;
    }
  }
}

/* One problem by one solver: solved, or honestly not. Returns 1 if solved. */
static int solve_random(int dim, int n, const char *solver, double skew,
                        unsigned long long seed) {
  int m = dim * n, k, solved = 0;
  double *W = malloc(sizeof *W * (size_t)(m * m));
  double *q = malloc(sizeof *q * (size_t)m),
         *mu = malloc(sizeof *mu * (size_t)n);
  random_local(m, 0.3, skew, W, q, &seed);
  for (int i = 0; i < n; ++i) mu[i] = 0.8 * case_random(&seed);
  JOB j = job_begin("read");
  fclib_local(in_folder(&j, "problem.h5"), STORE_ROWS, dim, n, W, q, mu);
  int code = solve_file(&j, solver);
  ck_assert_msg(code == 0 || code == 1 || code == 6, "%s: exit %d: %s", solver,
                code, j.errors);
  if (code == 0) {
    FREED double *r = take(&j, "read_condensed_00001.h5", "/solution/r", &k);
    double *u = take(&j, "read_condensed_00001.h5", "/solution/u", &k);
    double miss = fclib_violation(dim, n, W, q, mu, u, r);
    ck_assert_msg(miss <= 1e-7, "%s claims a violation of %g", solver, miss);
    solved = 1;
    free(u);
  }
  free(W), free(q), free(mu);
  return solved;
}

TEST(every_solver_is_honest_on_problems_from_files) {
  char method[80];
  for (int k = 0; solver_list[k] != NULL; ++k) {
    int solved = 0;
    snprintf(method, sizeof method, ", METHOD=%s", solver_list[k]->name);
    for (int dim = 2; dim <= 3; ++dim)
      solved += solve_random(dim, 10, method, 0.0, 21);
    ck_assert_msg(solved > 0, "%s solves neither", solver_list[k]->name);
  }
}

TEST(auto_solves_unsymmetric_problems) {
  for (int dim = 2; dim <= 3; ++dim)
    for (unsigned long long seed = 1; seed <= 4; ++seed)
      ck_assert_msg(solve_random(dim, 20, "", 1e-3, seed), "%d-D, seed %llu",
                    dim, seed);
}

/* ---- linear complementarity problems ---- */

typedef struct lcp {
  int n;
  double *M, *q; /* by rows                                                   */
} lcp;

static lcp lcp_new_case(int n) {
  return (lcp){n, calloc((size_t)(n * n), sizeof(double)),
               calloc((size_t)n, sizeof(double))};
}

static int run_lcp(job *j, const lcp *p, const char *solver) {
  size_t size = 64 + 30 * (size_t)(p->n * (p->n + 1)), used = 0;
  FREED char *text = malloc(size);
  used += (size_t)sprintf(text, "%d\n", p->n);
  for (int k = 0; k < p->n * p->n; ++k)
    used += (size_t)sprintf(text + used, "%.17g%c", p->M[k],
                            (k + 1) % p->n == 0 ? '\n' : ' ');
  for (int k = 0; k < p->n; ++k)
    used += (size_t)sprintf(text + used, "%.17g\n", p->q[k]);
  job_write(j, "lcp.txt", "%s", text);
  job_write(j, "lcp.inp",
            "*CONDENSED PROBLEM, FILE=lcp.txt, TYPE=LCP\n*STEP\n"
            "*SOLVER, TOL=1e-8%s\n*END STEP\n",
            solver);
  return job_run(j, "");
}

/* Largest violation by the table of the run, in units of q. */
static double lcp_violation(const job *j, const lcp *p) {
  double worst = 0.0, scale = largest(p->n, p->q);
  int open = 0;
  DAT t = job_table(j, "CONTACT", 0);
  ck_assert_int_eq(t.n_row, p->n);
  for (int i = 0; i < p->n; ++i) {
    double w = p->q[i], z = dat_at(&t, i, "z");
    for (int k = 0; k < p->n; ++k) w += p->M[p->n * i + k] * dat_at(&t, k, "z");
    worst = fmax(worst, fabs(w - dat_at(&t, i, "w")));
    worst = fmax(worst, fabs(fmin(w, z)));
    open += z == 0.0;
  }
  ck_assert(job_told(j, "open") == open);
  return worst / scale;
}

static void check_lcp(lcp *p, const char *what) {
  JOB j = job_begin("lcp");
  int code = run_lcp(&j, p, "");
  ck_assert_msg(code == 0, "%s: exit %d: %s", what, code, j.errors);
  double miss = lcp_violation(&j, p);
  ck_assert_msg(miss <= 1e-8, "%s: violation %g", what, miss);
  free(p->M);
  free(p->q);
}

/* Ties at every pivot; first-index rules cycle. The solution is 1/3 each. */
TEST(tie_case_of_murty_is_solved) {
  lcp p = lcp_new_case(3);
  JOB j = job_begin("lcp");
  for (int i = 0; i < 3; ++i) {
    p.M[3 * i + i] = 1.0;
    p.M[3 * i + (i + 1) % 3] = 2.0;
    p.q[i] = -1.0;
  }
  for (int k = 0; k < 2; ++k) {
    ck_assert_int_eq(run_lcp(&j, &p, k ? ", METHOD=LEMKE" : ""), 0);
    DAT t = job_table(&j, "CONTACT", 0);
    for (int i = 0; i < 3; ++i)
      ck_assert_double_eq_tol(dat_at(&t, i, "z"), 1.0 / 3.0, 1e-14);
  }
  free(p.M);
  free(p.q);
}

/* Lower triangle of twos: the plain method takes 2^n pivots. */
TEST(exponential_case_is_solved) {
  static const int sizes[] = {4, 12, 60, 200};
  for (size_t k = 0; k < sizeof sizes / sizeof *sizes; ++k) {
    lcp p = lcp_new_case(sizes[k]);
    for (int i = 0; i < p.n; ++i) {
      p.q[i] = -1.0;
      for (int c = 0; c <= i; ++c) p.M[p.n * i + c] = c < i ? 2.0 : 1.0;
    }
    check_lcp(&p, "exponential");
  }
}

/* M = b b' of half the rank (and a skew part): semidefinite, with a solution by
 * construction. Rows and columns scaled over twelve decades. */
TEST(semidefinite_case_is_solved) {
  for (unsigned long long seed = 1; seed <= 12; ++seed) {
    unsigned long long s = seed;
    int n = seed % 3 == 0 ? 100 : 20, half = n / 2;
    lcp p = lcp_new_case(n);
    FREED double *b = malloc(sizeof *b * (size_t)(n * half)),
                 *d = malloc(sizeof *d * (size_t)n);
    for (int k = 0; k < n * half; ++k) b[k] = 2.0 * case_random(&s) - 1.0;
    for (int i = 0; i < n; ++i)
      d[i] = seed % 4 == 0 ? pow(10.0, 4.0 * case_random(&s) - 2.0) : 1.0;
    for (int i = 0; i < n; ++i)
      for (int c = 0; c <= i; ++c) {
        double sum = 0.0,
               skew = seed % 2 && c < i ? case_random(&s) - 0.5 : 0.0;
        for (int k = 0; k < half; ++k) sum += b[i * half + k] * b[c * half + k];
        p.M[n * i + c] = d[i] * d[c] * (sum + skew);
        p.M[n * c + i] = d[i] * d[c] * (sum - skew);
      }
    for (int i = 0; i < n; ++i) {
      double z = fmax(case_random(&s) - 0.5, 0.0) / d[i];
      p.q[i] += z > 0.0 ? 0.0 : d[i] * case_random(&s);
      for (int r = 0; r < n; ++r) p.q[r] -= p.M[n * r + i] * z;
    }
    check_lcp(&p, "semidefinite");
  }
}

/* w_1 = -1 - z_2, w_2 = z_1 + 1: no z >= 0 makes w_1 >= 0. */
TEST(case_without_solution_ends_with_six) {
  lcp p = lcp_new_case(2);
  p.M[1] = -1.0;
  p.M[2] = 1.0;
  p.q[0] = -1.0;
  p.q[1] = 1.0;
  JOB j = job_begin("lcp");
  ck_assert_int_eq(run_lcp(&j, &p, ""), 6);
  ck_assert_ptr_nonnull(strstr(j.errors, "no solution"));
  ck_assert_int_eq(run_lcp(&j, &p, ", METHOD=SOR"), 2);
  ck_assert_ptr_nonnull(strstr(j.errors, "METHOD=sor"));
  free(p.M);
  free(p.q);
}

/* ---- verdicts and the deck ---- */

/* A pull that contact cannot hold: u = q + W r with W = 0 and q_N < 0. */
TEST(contact_without_solution_ends_with_six) {
  const double W[4] = {0.0, 0.0, 0.0, 1.0}, q[2] = {-1.0, 0.0}, mu[1] = {0.2};
  JOB j = job_begin("read");
  fclib_local(in_folder(&j, "problem.h5"), STORE_ROWS, 2, 1, W, q, mu);
  const int code = solve_file(&j, "");
  ck_assert_msg(code == 6 || code == 1, "exit %d: %s", code, j.errors);
}

TEST(effect_plan_has_no_mesh) {
  const double W[4] = {2.0, 0.0, 0.0, 1.0}, q[2] = {-1.0, 0.5}, mu[1] = {0.0};
  JOB j = job_begin("read");
  fclib_local(in_folder(&j, "problem.h5"), STORE_COLUMNS, 2, 1, W, q, mu);
  ck_assert_msg(solve_file(&j, "") == 0, "%s", j.errors);
  FREED char *lst = job_file(&j, "lst");
  ck_assert_ptr_nonnull(strstr(lst, "finite elements            off"));
  ck_assert_ptr_nonnull(strstr(lst, "friction                   off"));
  static const char *const stages[] = {"mesh  ", "stiffness assembly",
                                       "factorisation", "condensed stiffness",
                                       "sliding limit"};
  for (size_t k = 0; k < sizeof stages / sizeof *stages; ++k) {
    const char *at = strstr(strstr(lst, "COST\n"), stages[k]);
    ck_assert_ptr_nonnull(at);
    long calls = 1, bytes = 1;
    double cpu;
    ck_assert_int_eq(sscanf(at + 28, "%ld %lf %ld", &calls, &cpu, &bytes), 3);
    ck_assert_int_eq(calls, 0);
    ck_assert_int_eq(bytes, 0);
  }
  DAT t = job_table(&j, "CONTACT", 0); /* without being asked                 */
  ck_assert_double_eq_tol(dat_at(&t, 0, "f_n"), 0.5, 1e-12);
  ck_assert_double_eq_tol(dat_at(&t, 0, "u_t"), 0.5, 1e-12);
  ck_assert_int_eq(job_run(&j, "--check"), 0);
}

/* It factors the matrix: only where *ACCURACY asks for it. */
TEST(error_is_bound_on_request) {
  static const char *const cards[] = {
      "", "*ACCURACY\n", "*ACCURACY, SOLVER=NO\n", "*ACCURACY, MESH=YES\n"};
  const double W[4] = {2.0, 0.0, 0.0, 1.0}, q[2] = {-1.0, 0.5}, mu[1] = {0.1};
  for (int k = 0; k < 4; ++k) {
    JOB j = job_begin("read");
    fclib_local(in_folder(&j, "problem.h5"), STORE_COLUMNS, 2, 1, W, q, mu);
    job_write(&j, "read.inp",
              "*CONDENSED PROBLEM, FILE=problem.h5\n*STEP\n%s*END STEP\n",
              cards[k]);
    ck_assert_int_eq(job_run(&j, ""), k == 3 ? 2 : 0);
    if (k == 3) ck_assert_ptr_nonnull(strstr(j.errors, "P2034"));
    if (k < 3) {
      FREED char *lst = job_file(&j, "lst");
      const char *at = strstr(lst, "error of solver");
      ck_assert_ptr_nonnull(at);
      ck_assert_int_eq(strncmp(at + 27, "on", 2) == 0, k == 1);
    }
  }
}

/* A loose tolerance on nodes that are bound to each other: the bound of the
 * error is beyond a tenth of the energy norm. */
TEST(error_in_doubt_is_no_solution) {
  enum { N = 12, M = 2 * N };
  double W[M * M], q[M], mu[N];
  for (int i = 0; i < M; ++i) {
    q[i] = i % 2 == 0 ? -1.0 : 0.3;
    for (int k = 0; k < M; ++k)
      W[i + M * k] = i % 2 != k % 2 ? 0.0 : (i == k ? 0.05 : 0.0) + 1.0;
  }
  for (int i = 0; i < N; ++i) mu[i] = 0.2;
  for (int k = 0; k < 2; ++k) {
    JOB j = job_begin("read");
    fclib_local(in_folder(&j, "problem.h5"), STORE_COLUMNS, 2, N, W, q, mu);
    job_write(&j, "read.inp",
              "*CONDENSED PROBLEM, FILE=problem.h5\n*STEP\n"
              "*SOLVER, METHOD=%s\n*ACCURACY\n*END STEP\n",
              k == 0 ? "AUTO" : "SOR, TOL=0.05");
    const int code = job_run(&j, "");
    FREED char *sta = job_file(&j, "sta");
    ck_assert_msg(code == k, "exit %d: %s%s", code, j.errors, sta);
    ck_assert_int_eq(strstr(sta, "UNSETTLED BOUND") != NULL, k == 1);
  }
}

TEST(no_contact_is_solved) {
  JOB j = job_begin("read");
  fclib_local(in_folder(&j, "problem.h5"), STORE_ROWS, 3, 0, NULL, NULL, NULL);
  ck_assert_msg(solve_file(&j, "") == 0, "%s", j.errors);
}

TEST(deck_errors_have_a_line) {
  static const struct {
    const char *text, *message;
    int code;
  } wrong[] = {
      {"*CONDENSED PROBLEM, FILE=none.h5\n", "P5001", 4},
      {"*CONDENSED PROBLEM, FILE=read.inp, TYPE=FCLIB\n", "P5001", 4},
      {"*CONDENSED PROBLEM, FILE=read.inp\n", "P5002", 2},
      {"*CONDENSED PROBLEM\n", "P2005", 2},
      {"*CONDENSED PROBLEM, FILE=a, TYPE=X\n", "P2004", 2},
      {"*CONDENSED PROBLEM, FILE=a\n*CONDENSED PROBLEM, FILE=a\n", "P2011", 2},
      {"*CONDENSED PROBLEM, FILE=a\n*MESH, FILE=b.msh\n", "P2034", 2},
      {"*CONDENSED PROBLEM, FILE=a\n*STEP\n*STATIC\n*DSLOAD\nA, P, 1.\n"
       "*END STEP\n",
       "P2034", 2},
      {"*CONDENSED PROBLEM, FILE=a\n*STEP\n*PRINT, NODES\n*END STEP\n", "P2034",
       2},
      {"*CONDENSED PROBLEM, FILE=a\n*STEP\n*END STEP\n*STEP\n*END STEP\n",
       "P2034", 2}};
  for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k) {
    JOB j = job_with("read", NULL, "%s", wrong[k].text);
    int code = job_run(&j, "");
    ck_assert_msg(code == wrong[k].code, "%s: exit %d: %s", wrong[k].text, code,
                  j.errors);
    ck_assert_msg(strstr(j.errors, wrong[k].message) != NULL, "%s", j.errors);
    ck_assert_ptr_nonnull(strstr(j.errors, "read.inp:"));
  }
}

/* Names that the run gives to its results. */
TEST(file_of_the_problem_is_not_overwritten) {
  static const char *const names[] = {"read.dat", "read.h5", "read.json",
                                      "read_condensed_00001.h5"};
  const double W[4] = {2.0, 0.0, 0.0, 1.0}, q[2] = {-1.0, 0.5}, mu[1] = {0.0};
  for (size_t k = 0; k < sizeof names / sizeof *names; ++k) {
    int n;
    JOB j = job_begin("read");
    fclib_local(in_folder(&j, names[k]), STORE_ROWS, 2, 1, W, q, mu);
    job_write(&j, "read.inp",
              "*CONDENSED PROBLEM, FILE=%s\n*STEP\n"
              "*OUTPUT, CONDENSED=FCLIB\n*END STEP\n",
              names[k]);
    ck_assert_int_eq(job_run(&j, ""), 2);
    ck_assert_ptr_nonnull(strstr(j.errors, names[k]));
    FREED double *x =
        fclib_take(in_folder(&j, names[k]), "/fclib_local/W/x", &n);
    ck_assert_ptr_nonnull(x);
  }
}

UNIT_MAIN("exchange")
