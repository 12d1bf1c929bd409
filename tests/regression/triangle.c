/*
 * One triangle with two clamped vertices and the third on a rigid plane: every
 * solution is known in closed form, up to three of them above the critical
 * friction. K = area [(lambda + G) g g' + G |g|^2 I], g = grad of the P1
 * function of the free vertex.
 */
#include "solver/solver.h"
#include "support/job.h"
#include "support/traced.h"
#include "support/unit.h"

#include <signal.h>

const int job_without_fields = 1;

static const char mesh_text[] =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n4\n"
    "0 1 \"CLAMPED\"\n0 2 \"TIP\"\n1 3 \"FOOT\"\n2 4 \"BODY\"\n"
    "$EndPhysicalNames\n$Nodes\n3\n1 -1 1 0\n2 1 3 0\n3 0 0 0\n$EndNodes\n"
    "$Elements\n5\n1 15 2 1 1 1\n2 15 2 1 2 2\n3 15 2 2 3 3\n"
    "4 1 2 3 1 1 3\n5 2 2 4 1 3 2 1\n$EndElements\n";

static job run_checked(double mu, double fx, double fy, const char *method,
                       const char *check, int *code) {
  job j = job_begin("triangle");
  job_write(&j, "triangle.msh", "%s", mesh_text);
  job_write(&j, "triangle.inp",
            "*MESH, FILE=triangle.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1., 0.3\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\n"
            "*CONTACT, NAME=C, GROUP=FOOT, OBSTACLE=O, NORMAL=OBSTACLE\n"
            "*FRICTION, CONTACT=C, LAW=COULOMB\n%.17g\n*STEP\n*STATIC\n"
            "*BOUNDARY\nCLAMPED, 1, 2\n*CLOAD\nTIP, 1, %.17g\nTIP, 2, %.17g\n"
            "*SOLVER, METHOD=%s%s\n*PRINT, CONTACT, NODES\n*END STEP\n",
            mu, fx, fy, method, check);
  *code = job_run(&j, "");
  return j;
}

static job run_triangle(double mu, double fx, double fy, const char *method,
                        int *code) {
  return run_checked(mu, fx, fy, method, "", code);
}

/* K of the free vertex (0,0) with the others at (-1,1), (1,3): area 2,
 * g = (2, -2) / 4 ... from the closed form of the gradient. */
static void stiffness_of(double K[2][2]) {
  double area = 2.0,
         g[2] = {(1.0 - 3.0) / (2 * area), (1.0 - -1.0) / (2 * area)};
  double G = 1 / 2.6, lambda = 0.3 / (1.3 * 0.4),
         g2 = g[0] * g[0] + g[1] * g[1];
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b)
      K[a][b] = area * ((lambda + G) * g[a] * g[b] + (a == b ? G * g2 : 0.0));
}

/* Solution number "which" (0 free, 1 stick, 2 slip to the right, 3 slip to the
 * left) if it satisfies all conditions; u[2] displacement, r[2] force of the
 * plane on the body. */
static int solution(double mu, const double F[2], int which, double u[2],
                    double r[2]) {
  double K[2][2], det;
  stiffness_of(K);
  u[0] = u[1] = r[0] = r[1] = 0.0;
  if (which == 0) {
    det = K[0][0] * K[1][1] - K[0][1] * K[1][0];
    u[0] = (K[1][1] * F[0] - K[0][1] * F[1]) / det;
    u[1] = (K[0][0] * F[1] - K[1][0] * F[0]) / det;
    return u[1] >= 0.0;
  }
  if (which == 1) {
    r[0] = -F[0];
    r[1] = -F[1];
    return r[1] >= 0.0 && fabs(r[0]) <= mu * r[1];
  }
  /* K u = F + r, u_y = 0, r_x = -s mu r_y with s the direction of slip. */
  double s = which == 2 ? 1.0 : -1.0;
  u[0] = (F[0] + s * mu * F[1]) / (K[0][0] + s * mu * K[1][0]);
  r[1] = K[1][0] * u[0] - F[1];
  r[0] = -s * mu * r[1];
  return r[1] >= 0.0 && s * u[0] >= 0.0;
}

/* Number of the solution that the run found, or -1. */
static int found_solution(const job *j, double mu, const double F[2]) {
  DAT n = job_table(j, "NODES", -1), c = job_table(j, "CONTACT", -1);
  ck_assert_int_eq(c.n_row, 1);
  int tip = dat_row_near(&n, "y", 0.0), found = -1;
  for (int k = 0; k < 4; ++k) {
    double u[2], r[2];
    if (!solution(mu, F, k, u, r)) continue;
    double error = fabs(dat_at(&n, tip, "u_x") - u[0]) +
                   fabs(dat_at(&n, tip, "u_y") - u[1]) +
                   fabs(dat_at(&c, 0, "f_x") - r[0]) +
                   fabs(dat_at(&c, 0, "f_y") - r[1]);
    if (error < 1e-9) found = k;
  }
  return found;
}

static const char *const methods[] = {"AUTO", "NEWTON", "SOR"};

TEST(closed_form_agrees_with_the_published_numbers) {
  double K[2][2], u[2], r[2];
  stiffness_of(K);
  ck_assert_double_eq_tol(K[0][0], 0.8653846154, 1e-10);
  ck_assert_double_eq_tol(K[0][1], -0.4807692308, 1e-10);
  ck_assert(solution(1.0, (double[]){-1, 0.3}, 3, u, r));
  ck_assert_double_eq_tol(u[0], -0.9657142857, 1e-9);
  ck_assert_double_eq_tol(r[1], 0.1642857143, 1e-9);
  ck_assert(solution(2.0, (double[]){1.9, -1}, 2, u, r));
  ck_assert_double_eq_tol(u[0], 1.04, 1e-9);
}

TEST(unique_solution_is_found) {
  static const double F[][2] = {{0, -1},    {-1, 0.3},   {1.9, -1}, {1, 0.01},
                                {-0.5, -1}, {0.2, -0.3}, {0, 0}};
  static const double mu[] = {0.0, 0.3, 1.0, 1.7};
  for (size_t s = 0; s < 3; ++s)
    for (size_t k = 0; k < sizeof F / sizeof *F; ++k)
      for (size_t m = 0; m < 4; ++m) {
        int code;
        JOB j = run_triangle(mu[m], F[k][0], F[k][1], methods[s], &code);
        ck_assert_msg(code == 0, "exit %d: %s", code, j.errors);
        ck_assert_msg(found_solution(&j, mu[m], F[k]) >= 0,
                      "%s, mu %g, F (%g, %g)", methods[s], mu[m], F[k][0],
                      F[k][1]);
      }
}

/* Above mu = 1.8 one of the solutions, or an honest refusal; never another
 * state. AUTO must answer. */
TEST(one_of_several_solutions_is_found) {
  static const double mu[] = {2.0, 3.0, 10.0}, F[] = {1.9, -1.0};
  for (size_t s = 0; s < 3; ++s)
    for (size_t m = 0; m < 3; ++m) {
      int code;
      JOB j = run_triangle(mu[m], F[0], F[1], methods[s], &code);
      if (s == 0) ck_assert_int_eq(code, 0);
      if (code == 0) ck_assert_int_ge(found_solution(&j, mu[m], F), 0);
    }
}

/* Numbers u_t_lowest of the solutions in JOB.json, and their count. */
static int listed_solutions(const job *j, double *u_t, double *u_n) {
  FREED char *json = job_file(j, "json");
  const char *at = strstr(json, "\"solutions\": [");
  int n = 0;
  ck_assert_ptr_nonnull(at);
  while ((at = strstr(at, "\"u_n_lowest\": ")) != NULL) {
    u_n[n] = atof(at + strlen("\"u_n_lowest\": "));
    at = strstr(at, "\"u_t_lowest\": ");
    u_t[n++] = atof(at + strlen("\"u_t_lowest\": "));
  }
  return n;
}

/* The values of the node in the listing, which has as many digits, and its
 * forces within the law. */
static void check_values(const job *j, double mu, int n, const double *u_t,
                         const double *u_n) {
  FREED char *lst = job_file(j, "lst");
  const char *at = lst;
  for (int i = 0; i < n; ++i) {
    char word[16];
    double v[4];
    at = strstr(at, "node_no status");
    ck_assert_ptr_nonnull(at);
    at = strchr(at, '\n');
    ck_assert_int_eq(sscanf(at, "%*d %15s %lf %lf %lf %lf", word, &v[0], &v[1],
                            &v[2], &v[3]),
                     5);
    ck_assert_double_eq_tol(v[0], u_n[i], 1e-4 * fabs(u_n[i]) + 1e-15);
    ck_assert_double_eq_tol(v[1], u_t[i], 1e-4 * fabs(u_t[i]) + 1e-15);
    ck_assert_double_le(fabs(v[3]), (mu + 1e-3) * v[2]);
    ck_assert_int_eq(strcmp(word, "OPEN") == 0, v[2] == 0.0);
  }
}

/* All three solutions, or the only one, by both ways of looking for them. With
 * NORMAL=OBSTACLE u_n = -u_y, u_t = u_x up to the sign of the tangent. */
TEST(all_solutions_are_listed) {
  static const double mu[] = {1.0, 1.7, 2.0, 3.0}, F[] = {1.9, -1.0};
  static const char *const checks[] = {", CHECK=ALL", ", CHECK=YES"};
  for (size_t m = 0; m < 4; ++m)
    for (size_t c = 0; c < 2; ++c) {
      double u_t[8], u_n[8], u[2], r[2];
      int code, expected = 0, found = 0;
      JOB j = run_checked(mu[m], F[0], F[1], "AUTO", checks[c], &code);
      ck_assert_int_eq(code, 0);
      int n = listed_solutions(&j, u_t, u_n);
      for (int k = 0; k < 4; ++k) {
        if (!solution(mu[m], F, k, u, r)) continue;
        ++expected;
        for (int i = 0; i < n; ++i)
          found += fabs(fabs(u_t[i]) - fabs(u[0])) + fabs(u_n[i] + u[1]) < 1e-9;
      }
      ck_assert_int_eq(expected, mu[m] > 1.8 ? 3 : 1);
      ck_assert_int_eq(n, expected);
      ck_assert_int_eq(found, expected);
      if (c == 0) check_values(&j, mu[m], n, u_t, u_n);
      FREED char *sta = job_file(&j, "sta");
      ck_assert_int_eq(strstr(sta, "OK SOLUTIONS=3\n") != NULL, expected == 3);
      ck_assert_ptr_null(strstr(sta, "UNCONFIRMED"));
    }
}

static job pushed_by(double mu, const char *times, const char *solver) {
  job j = job_begin("triangle");
  job_write(&j, "triangle.msh", "%s", mesh_text);
  job_write(&j, "triangle.inp",
            "*MESH, FILE=triangle.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1., 0.3\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\n"
            "*CONTACT, NAME=C, GROUP=FOOT, OBSTACLE=O, NORMAL=OBSTACLE\n"
            "*FRICTION, CONTACT=C, LAW=COULOMB\n%g\n"
            "*STEP\n*QUASISTATIC\n1., 1.\n*BOUNDARY\nCLAMPED, 1, 2\n"
            "*CLOAD\nTIP, 2, -1.\n*END STEP\n"
            "*STEP\n*QUASISTATIC\n%s\n*CLOAD\nTIP, 1, 3.3\n%s"
            "*END STEP\n",
            mu, times, solver);
  return j;
}

static job pushed(double mu) { return pushed_by(mu, "0.05, 1.", ""); }

/* Pressed by 1, then pushed: with mu = 2 the vertex sticks until the push is 2
 * and finds no other state near then; with mu = 1.7 it slides and opens. */
TEST(jump_of_the_equilibrium_is_told) {
  static const double mu[] = {1.0, 1.7, 2.0, 3.0};
  for (int k = 0; k < 4; ++k) {
    int jumps = mu[k] > 1.8;
    JOB j = pushed(mu[k]);
    ck_assert_int_eq(job_run(&j, ""), 0);
    FREED char *sta = job_file(&j, "sta"), *lst = job_file(&j, "lst"),
               *json = job_file(&j, "json");
    ck_assert_int_eq(strstr(sta, "OK JUMP\n") != NULL, jumps);
    ck_assert_int_eq(strstr(lst, "  JUMP: no path of equilibria") != NULL,
                     jumps);
    const char *at = strstr(json, "\"jump_time\": ");
    ck_assert_int_eq(at != NULL, jumps);
    if (jumps)
      ck_assert_double_eq_tol(atof(at + strlen("\"jump_time\": ")),
                              1.0 + mu[k] / 3.3, 1e-4);
  }
}

/* Share of the motion of an increment to the push f that the jump from stick at
 * the push 2 to the free state has, %: free, 2 J = F' inv(K) F. */
static double jump_share(double f) {
  double motion[2];
  for (int k = 0; k < 2; ++k) {
    const double F[2] = {k == 0 ? 2 : f, -1};
    double u[2], r[2];
    ck_assert(solution(2, F, 0, u, r));
    motion[k] = sqrt(F[0] * u[0] + F[1] * u[1]);
  }
  return 100 * motion[0] / motion[1];
}

/* Loads of that problem above a plane lower by "gap": those that bring the
 * vertex there besides. */
static void write_lowered(const job *j, const char *method, double dt,
                          double gap) {
  double K[2][2];
  stiffness_of(K);
  const double x = -K[0][1] * gap, y = -1 - K[1][1] * gap;
  job_write(j, "triangle.msh", "%s", mesh_text);
  job_write(j, "triangle.inp",
            "*MESH, FILE=triangle.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1., 0.3\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=PLANE\n0., %g\n0., 1.\n"
            "*CONTACT, NAME=C, GROUP=FOOT, OBSTACLE=O, NORMAL=OBSTACLE\n"
            "*FRICTION, CONTACT=C, LAW=COULOMB\n2.\n"
            "*STEP\n*QUASISTATIC\n1., 1.\n*SOLVER, METHOD=%s\n"
            "*BOUNDARY\nCLAMPED, 1, 2\n*CLOAD\nTIP, 1, %.17g\n"
            "TIP, 2, %.17g\n*END STEP\n"
            "*STEP\n*QUASISTATIC\n%g, 6.\n*CLOAD\nTIP, 1, %.17g\n*END STEP\n",
            -gap, method, x, y, dt, 4.8 + x);
}

static double told_share(const job *j) {
  char *lst = job_file(j, "lst"), *at = strstr(lst, "the state changes by ");
  ck_assert_ptr_nonnull(at);
  double share = atof(at + strlen("the state changes by "));
  free(lst);
  return share;
}

static void check_jump(const char *method, double dt, double gap,
                       int may_miss) {
  JOB j = job_begin("triangle");
  write_lowered(&j, method, dt, gap);
  const int code = job_run(&j, "");
  ck_assert_msg(code == 0 || (code == 1 && may_miss), "%d", code);
  FREED char *json = job_file(&j, "json");
  const char *at = strstr(json, "\"jump_time\": ");
  ck_assert_ptr_nonnull(at);
  ck_assert_double_eq_tol(atof(at + strlen("\"jump_time\": ")), 3.5, 1e-4);
  ck_assert_ptr_null(strstr(at + 1, "\"jump_time\": "));
  if (code == 0 && dt >= 1.0)
    ck_assert_double_eq_tol(told_share(&j), jump_share(dt > 5.0 ? 4.8 : 2.4),
                            0.6);
}

/* The same with mu = 2: the push is 2 at 3.5, whatever the increment, the gap,
 * the method and the tolerance, also where the method does not find the state
 * after it. */
TEST(jump_is_found_in_any_increment_by_any_method) {
  static const double dt[] = {6.0, 3.0, 1.0, 0.1};
  const solver_ops *ops = NULL;
  for (int i = 0; i == 0 || ops != NULL; ++i) {
    ops = solver_list[i];
    for (int k = 0; k < 4; ++k)
      if (k % 2 == 0 || ops == NULL || i % 2 == 1)
        check_jump(ops == NULL ? "AUTO" : ops->name, dt[k], i % 3 == 1 ? 2 : 0,
                   ops != NULL);
  }
  check_jump("AUTO, TOL=BALANCED", 1.0, 0.0, 0);
  check_jump("AUTO, STIFFNESS=FACTOR", 3.0, 0.0, 0);
}

/* After increments that missed by little the jump is told, at the push of 2;
 * after one far from equilibrium none is: it would be at another time. */
TEST(jump_is_told_after_states_near_equilibrium) {
  for (int k = 0; k < 2; ++k) {
    JOB j = pushed_by(2, "0.25, 1., 0.25",
                      k ? "*SOLVER, METHOD=LAGRANGE, MAX_ITER=15\n"
                        : "*SOLVER, METHOD=LAGRANGE, MAX_ITER=1\n");
    ck_assert_int_eq(job_run(&j, ""), 1);
    FREED char *json = job_file(&j, "json");
    const char *at = strstr(json, "\"jump_time\": ");
    ck_assert_int_eq(at != NULL, k);
    if (k)
      ck_assert_double_eq_tol(atof(at + strlen("\"jump_time\": ")), 1 + 2 / 3.3,
                              1e-4);
  }
}

/* An increment that missed is tried again in halves, with TIME=BALANCED too. */
TEST(missed_increment_is_halved) {
  JOB j = pushed_by(1, "0.5, 1.",
                    "*SOLVER, METHOD=LAGRANGE, MAX_ITER=3\n"
                    "*ACCURACY, TIME=BALANCED\n");
  ck_assert_int_eq(job_run(&j, ""), 1);
  FREED char *sta = job_file(&j, "sta");
  const char *again = strstr(sta, "\n     2     1   2 ");
  ck_assert_ptr_nonnull(again);
  ck_assert_int_eq(strncmp(again + 18, "1.2500E+000 2.5000E-001", 23), 0);
}

/* A run that goes on just before the jump tells it as one that was not stopped.
 */
TEST(jump_is_told_by_a_run_that_goes_on) {
  static const char *const none[] = {NULL};
  traced t = {.action = TRACE_COUNT};
  JOB whole = pushed(2);
  ck_assert_int_eq(traced_run(&whole, none, &t), 0);
  const int all = t.changes;
  for (int k = 0; k < 3; ++k) {
    JOB j = pushed(2);
    t = (traced){
        .action = TRACE_SIGNAL, .at = all * (24 + k) / 42, .number = SIGINT};
    ck_assert_int_eq(traced_run(&j, none, &t), 130);
    CK_EXIT(job_run(&j, "--restart --no-timing"), 0, j);
    const char *file = traced_difference(&whole, &j);
    ck_assert_msg(file == NULL, "stopped at %d: .%s differs", k, file);
  }
}

UNIT_MAIN("triangle")
