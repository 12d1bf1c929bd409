/* src/solver: the options of the rows. What every row must do with its
 * defaults is tested in solver.c. */
#include "contact/force_set.h"
#include "solver/solver.h"
#include "support/contact_case.h"
#include "support/unit.h"

enum { PARAM_SIZE = 512 };

typedef struct variant {
  const char *solver, *option, *value;
} variant;
static const variant variants[] = {{"sor", "SWEEP", "BACKWARD"},
                                   {"sor", "SWEEP", "SYMMETRIC"},
                                   {"sor", "FRICTION", "FIXED_POINT"},
                                   {"sor", "OMEGA", "1.2"},
                                   {"lemke", "FACETS", "16"},
                                   {"aitken", "ACCELERATION", "ANDERSON"},
                                   {"aitken", "ACCELERATION", "NONE"},
                                   {"pcg", "PRECONDITIONER", "DIAGONAL"},
                                   {"lagrange", "ACCELERATION", "NONE"},
                                   {"auglag", "VARIANT", "UZAWA"}};
enum { VARIANTS = sizeof variants / sizeof *variants };

static void set_param(const variant *v, double *param) {
  const solver_ops *ops = solver_find(v->solver);
  char why[160];
  ck_assert_ptr_nonnull(ops);
  ck_assert(ops->param_size <= PARAM_SIZE);
  option_defaults(ops->options, param);
  if (v->option == NULL) return;
  const option *row = option_find(ops->options, v->option);
  ck_assert_ptr_nonnull(row);
  ck_assert_int_eq(option_read(row, v->value, param, why, sizeof why), 0);
}

/* Solve from zero. */
static solver_report solve_by(const variant *v, contact_case *c, double tol) {
  double param[PARAM_SIZE / sizeof(double)] = {0.0};
  ENDS_BY(contact_solver_free) contact_solver *s = NULL;
  solver_report rep;
  set_param(v, param);
  solver_choice choice = {
      .ops = solver_find(v->solver), .param = param, .tol = tol};
  memset(c->u, 0, (size_t)c->cp.m * sizeof *c->u);
  memset(c->r, 0, (size_t)c->cp.m * sizeof *c->r);
  ck_assert_int_eq(contact_solver_new(&choice, &s), OK);
  ck_assert_int_eq(contact_solve(s, &c->cp, NULL, c->u, c->r, &rep), OK);
  return rep;
}

static const variant newton = {"newton", NULL, NULL};

/* Every variant against Newton; returns how many problems were solved. */
static void must_agree(contact_case *c, int k, int conditions) {
  size_t m = (size_t)c->cp.m;
  double *u = calloc(m, sizeof *u), size = 0.0;
  ck_assert_int_eq(solve_by(&newton, c, 1e-12).outcome, CONVERGED);
  memcpy(u, c->u, m * sizeof *u);
  for (size_t j = 0; j < m; ++j) size = fmax(size, fabs(u[j]));
  for (int i = 0; i < VARIANTS; ++i) {
    const variant *v = &variants[i];
    solver_report rep = solve_by(v, c, 1e-11);
    ck_assert_msg(rep.outcome == CONVERGED, "%s %s: problem %d: %s", v->solver,
                  v->value, k, outcome_text(rep.outcome));
    for (size_t j = 0; j < m; ++j)
      ck_assert_msg(fabs(c->u[j] - u[j]) <= 1e-8 * size,
                    "%s %s: problem %d: apart by %g", v->solver, v->value, k,
                    fabs(c->u[j] - u[j]) / size);
    if (conditions) ck_assert_double_lt(case_violation(c, c->u, c->r), 1e-9);
  }
  free(u);
}

TEST(variants_agree_on_random_problems) {
  static const double mus[] = {0.0, 0.1, 0.3, 0.5};
  for (int k = 0; k < 120; ++k) {
    CONTACT_CASE c = case_any(2 + k % 2, 1 + k % 17, mus[k / 2 % 4], k / 8 % 2,
                              (unsigned long long)(900 + k));
    must_agree(&c, k, 1);
  }
}

/* Tresca friction, also where nothing pushes. */
TEST(variants_agree_with_a_given_limit) {
  for (int k = 0; k < 40; ++k) {
    CONTACT_CASE c = case_any(2 + k % 2, 1 + k % 11, 0.5, k / 2 % 2,
                              (unsigned long long)(1300 + k));
    for (int i = 0; i < c.cp.n; ++i) c.g0[i] = 0.1 * (i % 4);
    c.cp.B = NULL;
    must_agree(&c, k, 1);
  }
}

/* One tangent prescribed, one node in a corner; by forces, W = inv(A), too,
 * and one of them alone. */
TEST(variants_agree_on_held_and_cornered_nodes) {
  for (int k = 0; k < 24; ++k) {
    int dim = 2 + k % 2, n = 4 + k % 5, m = dim * n;
    CONTACT_CASE c = case_any(dim, n, 0.4, 0, (unsigned long long)(1500 + k));
    unsigned char held[64] = {0};
    double side[64];
    int dof = dim + 1, corner = 2 * (dim - 1);
    held[dof] = 1;
    for (int j = 0; j < m; ++j)
      if (j != dof) c.A[dof + m * j] = c.A[j + m * dof] = 0.0;
    for (int j = 0; j < n * (dim - 1); ++j) side[j] = HUGE_VAL;
    side[corner] = 0.02;
    c.f[2 * dim + 1] = k % 4 < 2 ? 3.0 : -3.0;
    c.g0[2] = c.B->val[2] = 0.0;
    c.cp.held = held;
    c.cp.side_gap = side;
    must_agree(&c, k, 0);
    ck_assert_double_eq_tol(c.u[dof], c.f[dof] / c.A[dof + m * dof], 1e-9);
    static const variant sor = {"sor", NULL, NULL};
    double W[24 * 24], q[24], exact[24];
    memcpy(exact, c.u, (size_t)m * sizeof *exact);
    ck_assert(case_inverse(m, c.A, W));
    contact_product(m, W, c.f, q);
    c.cp.W = W;
    c.cp.A = NULL;
    c.cp.f = q;
    for (int of = 0; of < 3; ++of) {
      c.cp.held = of < 2 ? held : NULL;
      c.cp.side_gap = of != 1 ? side : NULL;
      ck_assert_int_eq(solve_by(&sor, &c, 1e-11).outcome, CONVERGED);
      for (int i = 0; i < m && of == 0; ++i)
        ck_assert_double_eq_tol(c.u[i], exact[i], 1e-7);
    }
  }
}

/* Only the floor holds the block: the pressures add up to the load on it. */
TEST(floating_block_is_held_by_its_floor) {
  case_block_data d = {
      .columns = 10, .layers = 6, .nu = 0.3, .mu = 0.5, .top = {0.02, -0.2}};
  CONTACT_CASE c = case_block(&d);
  ck_assert(c.cp.floating);
  must_agree(&c, 0, 1);
  double push = 0.0;
  for (int i = 0; i < c.cp.n; ++i) push -= c.r[2 * i];
  ck_assert_double_eq_tol(push, 0.2 * d.columns, 1e-9);
}

/* The compliance alone is known. */
TEST(compliance_form_gives_the_same_forces) {
  for (int k = 0; k < 12; ++k) {
    CONTACT_CASE c =
        case_any(2 + k % 2, 8, 0.3, 0, (unsigned long long)(1700 + k));
    size_t m = (size_t)c.cp.m;
    FREED double *W = calloc(m * m, sizeof *W), *q = calloc(m, sizeof *q),
                 *r = calloc(m, sizeof *r);
    ck_assert(case_inverse(c.cp.m, c.A, W));
    ck_assert_int_eq(solve_by(&newton, &c, 1e-12).outcome, CONVERGED);
    memcpy(r, c.r, m * sizeof *r);
    contact_product(c.cp.m, W, c.f, q);
    c.cp.W = W;
    c.cp.A = NULL;
    c.cp.f = q;
    for (int i = 0; i < VARIANTS; ++i) {
      ck_assert_int_eq(solve_by(&variants[i], &c, 1e-11).outcome, CONVERGED);
      for (size_t j = 0; j < m; ++j)
        ck_assert_double_eq_tol(c.r[j], r[j], 1e-8);
    }
  }
}

/* The compliance is known to a part in a million only: displacements of forces
 * satisfy the stiffness to the square of that. */
TEST(displacements_are_refined_by_the_stiffness) {
  for (int k = 0; k < 6; ++k) {
    CONTACT_CASE c =
        case_any(2 + k % 2, 6, 0.3, 0, (unsigned long long)(2300 + k));
    const size_t m = (size_t)c.cp.m;
    double *W = calloc(m * m, sizeof *W), *u = calloc(m, sizeof *u),
           *Au = calloc(m, sizeof *Au), most = 0.0, scale = 0.0;
    OWNED force_set *s = NULL;
    ck_assert(case_inverse(c.cp.m, c.A, W));
    for (size_t i = 0; i < m * m; ++i) W[i] *= 1.0 + 1e-6;
    for (size_t i = 0; i < m; ++i) c.r[i] = sin(1.0 + (double)i);
    c.cp.W = W;
    ck_assert_int_eq(force_set_new(&c.cp, &s), OK);
    ck_assert_int_eq(force_set_fit(s, &c.cp), OK);
    force_set_displacement(s, c.r, u);
    contact_product(c.cp.m, c.A, u, Au);
    for (size_t i = 0; i < m; ++i) {
      most = fmax(most, fabs(Au[i] - c.f[i] - c.r[i]));
      scale = fmax(scale, fabs(c.f[i] + c.r[i]));
    }
    ck_assert_double_le(most, 1e-10 * scale);
    free(W);
    free(u);
    free(Au);
  }
}

/* What each acceleration is for. */
TEST(accelerations_save_steps) {
  static const variant pairs[][2] = {
      {{"aitken", "ACCELERATION", "AITKEN"},
       {"aitken", "ACCELERATION", "NONE"}},
      {{"aitken", "ACCELERATION", "ANDERSON"},
       {"aitken", "ACCELERATION", "AITKEN"}},
      {{"pcg", "PRECONDITIONER", "FACE"},
       {"pcg", "PRECONDITIONER", "DIAGONAL"}},
      {{"lagrange", "ACCELERATION", "NESTEROV"},
       {"lagrange", "ACCELERATION", "NONE"}},
      {{"auglag", "VARIANT", "NEWTON"}, {"auglag", "VARIANT", "UZAWA"}}};
  case_block_data d = {.columns = 64,
                       .layers = 64,
                       .clamped = 1,
                       .nu = 0.3,
                       .mu = 0.3,
                       .top = {0.0, -0.1},
                       .left = {0.05, -0.1}};
  CONTACT_CASE c = case_block(&d);
  for (size_t i = 0; i < sizeof pairs / sizeof *pairs; ++i) {
    solver_report fast = solve_by(&pairs[i][0], &c, 1e-8);
    ck_assert_int_eq(fast.outcome, CONVERGED);
    solver_report slow = solve_by(&pairs[i][1], &c, 1e-8);
    ck_assert_int_eq(slow.outcome, CONVERGED);
    ck_assert_msg(2 * fast.iterations <= slow.iterations, "%s %s: %d, %s: %d",
                  pairs[i][0].solver, pairs[i][0].value, fast.iterations,
                  pairs[i][1].value, slow.iterations);
  }
}

/* Each option of the sweeps does what its name says. */
TEST(options_of_sor_have_an_effect) {
  static const variant ways[] = {
      {"sor", NULL, NULL},           {"sor", "SWEEP", "BACKWARD"},
      {"sor", "SWEEP", "SYMMETRIC"}, {"sor", "OMEGA", "1"},
      {"sor", "OMEGA", "1.4"},       {"sor", "FRICTION", "FIXED_POINT"}};
  enum { WAYS = sizeof ways / sizeof *ways };
  case_block_data d = {.columns = 60,
                       .layers = 20,
                       .clamped = 1,
                       .nu = 0.3,
                       .mu = 0.3,
                       .left = {0.1, 0.0}};
  CONTACT_CASE c = case_block(&d);
  solver_report rep[WAYS];
  for (int i = 0; i < c.cp.n; ++i) c.f[2 * i] += 0.05;
  for (int i = 0; i < WAYS; ++i) {
    rep[i] = solve_by(&ways[i], &c, 1e-9);
    ck_assert_msg(rep[i].outcome == CONVERGED, "%d", i);
    for (int j = 0; j < i && i < WAYS - 1; ++j)
      ck_assert_msg(rep[i].iterations != rep[j].iterations, "%d and %d", i, j);
    ck_assert_int_eq(rep[i].limit_updates > 1, i == WAYS - 1);
  }
  ck_assert_int_lt(rep[4].iterations, rep[3].iterations); /* omega pays       */
}

/* 200 nodes numbered along the slip or against it: sweeps that follow the
 * numbers were seen to go in circles. */
TEST(long_row_of_slipping_nodes_is_solved) {
  for (int against = 0; against <= 1; ++against) {
    case_block_data d = {
        .columns = unit_whole() ? 199 : 99, .layers = 40, .symmetric = 1};
    d.nu = 0.3;
    d.mu = 0.3;
    d.top[1] = -0.002;
    d.left[0] = 0.006;
    CONTACT_CASE c = case_block(&d);
    if (against) { /* mirrored: the same problem from the other end           */
      int m = c.cp.m;
      double *A = malloc(sizeof *A * (size_t)(m * m)), f[400];
      unsigned char held[400];
      for (int i = 0; i < m; ++i) {
        int a = m - 2 - i + 2 * (i % 2);
        f[i] = c.f[a] * (i % 2 ? -1.0 : 1.0);
        held[i] = c.held[a];
        for (int j = 0; j < m; ++j) {
          int b = m - 2 - j + 2 * (j % 2);
          A[i + m * j] = c.A[a + m * b] * (i % 2 == j % 2 ? 1.0 : -1.0);
        }
      }
      memcpy(c.A, A, sizeof *A * (size_t)(m * m));
      memcpy(c.f, f, sizeof *f * (size_t)m);
      memcpy(c.held, held, sizeof *held * (size_t)m);
      free(A);
    }
    static const variant ways[] = {{"sor", NULL, NULL},
                                   {"sor", "SWEEP", "BACKWARD"},
                                   {"aitken", NULL, NULL}};
    for (size_t i = 0; i < sizeof ways / sizeof *ways; ++i) {
      ck_assert_int_eq(solve_by(&ways[i], &c, 1e-8).outcome, CONVERGED);
      ck_assert_double_lt(case_violation(&c, c.u, c.r), 1e-8);
    }
  }
}

static void hear_cycle(void *ctx, const solver_step *s) {
  ck_assert_int_ge(s->status_changes, 0);
  *(int *)ctx += s->cycle;
}

/* Steep friction: a few problems send the sweeps round in circles; small
 * friction none, whatever the tolerance: below the rounding nothing is left to
 * miss. */
TEST(cycle_is_told_from_stagnation) {
  static const char *const names[] = {"sor", "aitken"};
  for (int a = 0; a < 2; ++a) {
    const solver_ops *ops = solver_find(names[a]);
    int cycles = 0;
    double param[PARAM_SIZE / sizeof(double)] = {0.0};
    option_defaults(ops->options, param);
    for (int k = 0; k < 200; ++k)
      for (int rounding = 0; rounding <= (k < 8); ++rounding) {
        CONTACT_CASE c =
            case_any(2 + k % 2, 2 + k % 6, rounding ? 0.2 : 4.0 + k % 5 * 4,
                     k / 2 % 2, (unsigned long long)(7000 + k));
        int heard = 0;
        solver_listener listener = {hear_cycle, &heard};
        solver_control control = {.tol = rounding ? 1e-25 : 1e-10,
                                  .listener = &listener};
        solver_report rep;
        OWNED void *work = NULL;
        ck_assert_int_eq(solver_set_up(ops, &c.cp, param, &work), OK);
        ck_assert_int_eq(
            ops->solve(&c.cp, param, work, &control, c.u, c.r, &rep), OK);
        if (rounding) ck_assert_int_eq(rep.outcome, CONVERGED);
        if (rep.outcome == STOPPED_CYCLE) ck_assert_int_gt(heard, 10);
        cycles += rep.outcome == STOPPED_CYCLE;
      }
    ck_assert_msg(cycles > 0, "%s: %d", names[a], cycles);
  }
}

/* What the listener hears of AUGLAG. */
typedef struct heard {
  int cycles, changes; /* patterns that came back; changes of states in all   */
  int passes;          /* on the sliding limit: the other variant at work     */
} heard;

static void hear_states(void *ctx, const solver_step *s) {
  heard *h = ctx;
  if (s->limit_update > 0) ++h->passes;
  if (s->limit_update > 0 || s->status_changes < 0) return;
  h->changes += s->status_changes;
  h->cycles += s->cycle;
  if (s->cycle) ck_assert_int_gt(s->status_changes, 0);
}

static outcome run_auglag(contact_case *c, double tol, int passes, heard *h) {
  double param[PARAM_SIZE / sizeof(double)] = {0.0};
  solver_listener listener = {hear_states, h};
  solver_control control = {
      .tol = tol, .limit_max_iter = passes, .listener = &listener};
  solver_report rep;
  OWNED void *work = NULL;
  size_t bytes = (size_t)c->cp.m * sizeof *c->u;
  *h = (heard){0};
  memset(c->u, 0, bytes);
  memset(c->r, 0, bytes);
  option_defaults(auglag_solver.options, param);
  ck_assert_int_eq(solver_set_up(&auglag_solver, &c->cp, param, &work), OK);
  ck_assert_int_eq(
      auglag_solver.solve(&c->cp, param, work, &control, c->u, c->r, &rep), OK);
  return rep.outcome;
}

/* Steep friction sends the Newton steps of AUGLAG round in circles on a few
 * problems: told at the step, mended by the other variant, and the verdict
 * where that cannot end either (one pass of its sliding limit). */
TEST(auglag_tells_states_that_come_back) {
  int cycling = 0, changes = 0;
  for (int k = 0; k < 100; ++k) {
    CONTACT_CASE c = case_any(2 + k % 2, 2 + k % 6, 4.0 + k % 5 * 4, k / 2 % 2,
                              (unsigned long long)(7000 + k));
    heard h;
    ck_assert_int_eq(run_auglag(&c, 1e-10, 0, &h), CONVERGED);
    if (h.passes > 0) {
      ck_assert_int_gt(h.cycles, 20);
      if (cycling++ < 2)
        ck_assert_int_eq(run_auglag(&c, 1e-10, 1, &h), STOPPED_CYCLE);
    }
  }
  ck_assert_int_gt(cycling, 0);
  for (int k = 0; k < 20; ++k) {
    CONTACT_CASE c = case_any(2, 10 + k, 0.2, 0, (unsigned long long)k);
    heard h;
    ck_assert_int_eq(run_auglag(&c, 1e-10, 0, &h), CONVERGED);
    ck_assert_int_eq(h.cycles + h.passes, 0);
    changes += h.changes;
    if (k < 4) ck_assert_int_ne(run_auglag(&c, 1e-25, 0, &h), STOPPED_CYCLE);
  }
  ck_assert_int_gt(changes, 20);
}

TEST(variants_keep_their_bits_under_factors_of_two) {
  static const int powers[][2] = {{41, 0}, {-33, 3}, {0, 13}, {7, -21}};
  for (int k = 0; k < 16; ++k)
    for (int i = 0; i < VARIANTS; ++i) {
      CONTACT_CASE c = case_any(2 + k % 2, 2 + k, k % 3 ? 0.4 : 0.0, k / 2 % 2,
                                (unsigned long long)(1900 + k));
      CONTACT_CASE d = case_any(2 + k % 2, 2 + k, k % 3 ? 0.4 : 0.0, k / 2 % 2,
                                (unsigned long long)(1900 + k));
      int m = c.cp.m, n = c.cp.n, a = powers[k % 4][0], b = powers[k % 4][1];
      for (int j = 0; j < m * m; ++j) d.A[j] = ldexp(c.A[j], a);
      for (int j = 0; j < m; ++j) d.f[j] = ldexp(c.f[j], a + b);
      for (int j = 0; j < n; ++j) d.gap[j] = ldexp(c.gap[j], b);
      for (int j = 0; j < m - n; ++j) d.ut0[j] = ldexp(c.ut0[j], b);
      solver_report one = solve_by(&variants[i], &c, 1e-9);
      solver_report two = solve_by(&variants[i], &d, 1e-9);
      ck_assert_int_eq(one.iterations, two.iterations);
      for (int j = 0; j < m; ++j)
        ck_assert_msg(d.u[j] == ldexp(c.u[j], b), "%s %s: problem %d",
                      variants[i].solver, variants[i].value, k);
    }
}

TEST(refused_memory_is_given_back) {
  for (int i = 0; i < VARIANTS; ++i)
    for (int dim = 2; dim <= 3; ++dim) {
      CONTACT_CASE c = case_any(dim, 6, 0.3, 0, 2100);
      double param[PARAM_SIZE / sizeof(double)] = {0.0};
      set_param(&variants[i], param);
      solver_choice choice = {
          .ops = solver_find(variants[i].solver), .param = param, .tol = 1e-9};
      size_t before = memory_in_use();
      status st = ERR_MEMORY;
      int k = 0;
      for (k = 1; st == ERR_MEMORY && k < 1000; ++k) {
        contact_solver *s = NULL;
        solver_report rep;
        memory_refuse(k, 0);
        st = contact_solver_new(&choice, &s);
        if (st == OK) st = contact_solve(s, &c.cp, NULL, c.u, c.r, &rep);
        memory_refuse(0, 0);
        contact_solver_free(&s);
        ck_assert(st == OK || st == ERR_MEMORY);
        ck_assert_uint_eq(memory_in_use(), before);
      }
      ck_assert_int_eq(st, OK);
      ck_assert_int_gt(k, 8);
    }
}

UNIT_MAIN("methods")
