/* METHOD=AUTO, forms of a problem, what is kept from problem to problem. */
#include "solver/choice/choice.h"
#include "solver/solver.h"
#include "support/contact_case.h"
#include "support/folder.h"
#include "support/planted.h"
#include "support/solver_rows.h"
#include "support/unit.h"

/* A frictionless problem in stiffness form (form 0) or compliance form. */
static solver_report solve_form(contact_case *c, int form) {
  if (form == 0) return solve_by(NULL, c, 1e-12, c->u, c->r);
  size_t m = (size_t)c->cp.m;
  contact_problem given = c->cp;
  FREED double *W = calloc(m * m, sizeof *W), *q = calloc(m, sizeof *q);
  ck_assert(case_inverse(c->cp.m, c->A, W));
  contact_product(c->cp.m, W, c->f, q);
  c->cp.A = NULL;
  c->cp.W = W;
  c->cp.f = q;
  solver_report rep = solve_by(NULL, c, 1e-12, c->u, c->r);
  c->cp = given;
  return rep;
}

TEST(frictionless_problems_are_solved_in_both_forms) {
  for (int k = 0; k < 40; ++k) {
    CONTACT_CASE c =
        case_any(2 + k % 2, 3 + k, 0.0, k / 2 % 2, (unsigned long long)k);
    for (int form = 0; form < 2; ++form) {
      case_cold(&c);
      solver_report rep = solve_form(&c, form);
      ck_assert_msg(rep.outcome == CONVERGED, "%d, form %d: %s", k, form,
                    outcome_text(rep.outcome));
      double v = case_violation(&c, c.u, c.r);
      ck_assert_msg(v < 1e-9, "%d, form %d: violation %g", k, form, v);
    }
  }
}

/* Loads, stick positions, friction and Tresca limits change, A stays: the
 * answers are those of solvers that know nothing of the problems before. */
TEST(what_is_kept_changes_no_answer) {
  unsigned long long seed = 12345;
  for (int k = 0; k < 12; ++k) {
    int dim = 2 + k % 2;
    CONTACT_CASE c = case_any(dim, 12, 0.3, k / 2 % 2, 100u + (unsigned)k);
    solver_choice choice = {.tol = 1e-12};
    ENDS_BY(contact_solver_free) contact_solver *s = NULL;
    FREED double *u = calloc((size_t)c.cp.m, sizeof *u),
                 *r = calloc((size_t)c.cp.m, sizeof *r);
    ck_assert_int_eq(contact_solver_new(&choice, &s), OK);
    for (int step = 0; step < 8; ++step) {
      solver_report rep;
      for (int i = 0; i < c.cp.m; ++i)
        c.f[i] += 0.3 * (case_random(&seed) - 0.5);
      for (int i = 0; i < c.cp.n; ++i) {
        c.B->val[i] = step < 3 ? 0.3 : 0.2;
        c.g0[i] = step == 5 ? 0.1 : 0.0;
      }
      c.cp.B = step == 5 ? NULL : c.B;
      ck_assert_int_eq(contact_solve(s, &c.cp, NULL, c.u, c.r, &rep), OK);
      ck_assert_int_eq(rep.outcome, CONVERGED);
      ck_assert_double_lt(case_violation(&c, c.u, c.r), 1e-9);
      memset(u, 0, (size_t)c.cp.m * sizeof *u);
      memset(r, 0, (size_t)c.cp.m * sizeof *r);
      ck_assert_int_eq(solve_by(NULL, &c, 1e-12, u, r).outcome, CONVERGED);
      for (int i = 0; i < c.cp.m; ++i)
        ck_assert_double_eq_tol(c.r[i], r[i], 1e-8);
    }
  }
}

/* Without friction: nodes open and close with the load, what was made for them
 * stays; the answers are those of NEWTON, which starts again, of all unknowns
 * and of the normal ones. */
TEST(opened_nodes_are_kept_and_change_no_answer) {
  unsigned long long seed = 77;
  for (int k = 0; k < 8; ++k) {
    CONTACT_CASE c = case_any(2 + k % 2, 20, 0.0, 0, 300u + (unsigned)k);
    solver_control control = {.tol = 1e-12},
                   once = {.tol = 1e-12, .max_iter = 1};
    normal_form nf = {0};
    int limited = 0;
    FREED double *u = calloc((size_t)c.cp.m, sizeof *u),
                 *r = calloc((size_t)c.cp.m, sizeof *r);
    c.cp.g0 = c.cp.ut0 = NULL;
    c.cp.B = NULL;
    for (int step = 0; step < 6; ++step) {
      solver_report rep;
      for (int i = 0; i < c.cp.m; ++i) c.f[i] += case_random(&seed) - 0.5;
      memcpy(u, c.u, (size_t)c.cp.m * sizeof *u);
      ck_assert_int_eq(normal_form_opened(&nf, &c.cp, &once, c.u, c.r, &rep),
                       OK);
      ck_assert_int_le(rep.iterations, 1);
      limited += rep.outcome != CONVERGED;
      if (rep.outcome != CONVERGED)
        ck_assert_mem_eq(u, c.u, (size_t)c.cp.m * sizeof *u);
      ck_assert_int_eq(normal_form_opened(&nf, &c.cp, &control, c.u, c.r, &rep),
                       OK);
      ck_assert_int_eq(rep.outcome, CONVERGED);
      for (int normal = 0; normal < 2; ++normal) {
        memset(u, 0, (size_t)c.cp.m * sizeof *u);
        memset(r, 0, (size_t)c.cp.m * sizeof *r);
        if (normal)
          ck_assert_int_eq(normal_form_solve(&nf, &c.cp, &control, u, r, &rep),
                           OK);
        else
          rep = solve_by(&newton_solver, &c, 1e-12, u, r);
        ck_assert_int_eq(rep.outcome, CONVERGED);
        for (int i = 0; i < c.cp.m; ++i) {
          ck_assert_double_eq_tol(c.r[i], r[i], 1e-9);
          ck_assert_double_eq_tol(c.u[i], u[i], 1e-9);
        }
      }
    }
    ck_assert_int_gt(limited, 0);
    normal_form_free(&nf);
  }
}

/* What was put into an archive, read from a file; takes it over. */
static archive *through_a_file(archive *a) {
  FOLDER(folder);
  PRINTED(path, "%s/work", folder);
  PRINTED(before, "%s/before", folder);
  ck_assert_msg(archive_write(a, path, before) == OK, "%s", status_message());
  archive_free(&a);
  ck_assert_int_eq(archive_read(path, &a), OK);
  return a;
}

/* The workspace of METHOD=AUTO (kind 0), or of the normal form by the nodes
 * that are opened (1) or whole (2). */
typedef struct workspace {
  contact_solver *s;
  normal_form nf;
} workspace;

static void keep_work(workspace *w, int kind, archive *a) {
  ck_assert_int_eq(
      kind == 0 ? contact_solver_keep(w->s, a) : normal_form_keep(&w->nf, a),
      OK);
}

static solver_report solve_in(workspace *w, int kind, const contact_problem *cp,
                              double *u, double *r) {
  const solver_control control = {.tol = 1e-10};
  solver_report rep;
  status st;
  if (kind == 0)
    st = contact_solve(w->s, cp, NULL, u, r, &rep);
  else
    st = (kind == 1 ? normal_form_opened : normal_form_solve)(
        &w->nf, cp, &control, u, r, &rep);
  ck_assert_int_eq(st, OK);
  return rep;
}

static void release_work(workspace *w) {
  contact_solver_free(&w->s);
  normal_form_free(&w->nf);
}

/* Saved before each of a series of loads, another goes on from the file to the
 * same bits. */
TEST(saved_work_goes_on_to_the_same_bits) {
  enum { FEW = 48, MANY = 150, MOST = 2 * MANY };
  unsigned long long seed = 4321;
  const solver_choice choice = {.tol = 1e-10};
  for (int k = 0; k < 18; ++k) {
    const int kind = k % 3, auto_mu = k / 6 % 3;
    CONTACT_CASE c =
        case_any(2 + k % 2, k % 6 == 2 ? MANY : FEW,
                 kind == 0 ? 0.2 * auto_mu : 0.0, 0, 500u + (unsigned)k);
    const size_t bytes = (size_t)c.cp.m * sizeof(double);
    workspace w[2] = {{0}, {0}};
    if (auto_mu == 0 || kind > 0) c.cp.g0 = c.cp.ut0 = NULL, c.cp.B = NULL;
    ck_assert_int_eq(contact_solver_new(&choice, &w[0].s), OK);
    for (int step = 0; step < 5; ++step) {
      double u[2][MOST], r[2][MOST];
      solver_report rep[2];
      archive *a = NULL;
      for (int i = 0; i < c.cp.m; ++i)
        c.f[i] += (step % 2 ? 0.01 : 1.0) * (case_random(&seed) - 0.5);
      ck_assert_int_eq(contact_solver_new(&choice, &w[1].s), OK);
      ck_assert_int_eq(archive_new(&a), OK);
      keep_work(&w[0], kind, a);
      a = through_a_file(a);
      keep_work(&w[1], kind, a);
      for (int to = 0; to < 2; ++to) {
        memcpy(u[to], c.u, bytes);
        memcpy(r[to], c.r, bytes);
        rep[to] = solve_in(&w[to], kind, &c.cp, u[to], r[to]);
      }
      ck_assert_msg(rep[0].iterations == rep[1].iterations &&
                        memcmp(u[0], u[1], bytes) == 0 &&
                        memcmp(r[0], r[1], bytes) == 0,
                    "problem %d, step %d: %d iterations, not %d", k, step,
                    rep[1].iterations, rep[0].iterations);
      memcpy(c.u, u[0], bytes);
      memcpy(c.r, r[0], bytes);
      release_work(&w[1]);
      archive_free(&a);
    }
    release_work(&w[0]);
  }
}

/* A method that cannot treat a problem says so at once, and why: the stiffness
 * of a compliance of rank 1. */
TEST(unfit_method_is_named_with_the_reason) {
  CONTACT_CASE c = case_any(2, 6, 0.5, 0, 5);
  FREED double *W = calloc(12 * 12, sizeof *W);
  int unfit = 0;
  for (int j = 0; j < 12 * 12; ++j) W[j] = 1.0;
  c.cp.A = NULL;
  c.cp.W = W;
  EACH_SOLVER(i, ops) {
    double param[PARAM_SIZE / sizeof(double)] = {0.0};
    solver_choice choice = {.ops = ops, .param = param, .tol = 1e-10};
    ENDS_BY(contact_solver_free) contact_solver *s = NULL;
    solver_report rep;
    if (ops == NULL || !(ops->handles & NEEDS_STIFFNESS)) continue;
    option_defaults(ops->options, param);
    ck_assert_int_eq(contact_solver_new(&choice, &s), OK);
    case_cold(&c);
    ck_assert_int_eq(contact_solve(s, &c.cp, NULL, c.u, c.r, &rep), OK);
    ck_assert_int_eq(rep.outcome, STOPPED_UNFIT);
    ck_assert_int_eq(rep.iterations, 0);
    const char *said = strstr(contact_solver_log(s), ops->name);
    ck_assert_ptr_nonnull(said);
    ck_assert_ptr_nonnull(strstr(said, "the compliance is singular"));
    ++unfit;
  }
  ck_assert_int_ge(unfit, 1);
}

/* A method that works on the stiffness is judged by the compliance given: it
 * goes on until that residual is met too, for any tolerance. */
TEST(tolerance_is_met_in_the_form_given) {
  static const double tols[] = {1e-2, 1e-3, 1e-5, 1e-7, 1e-9};
  const solver_ops *ops;
  for (int k = 0; k < 100; ++k) {
    CONTACT_CASE c = case_any(3, 1 + k % 5, 0.3, 0, (unsigned long long)k);
    int m = c.cp.m;
    FREED double *W = calloc((size_t)(m * m), sizeof *W),
                 *q = calloc(30, sizeof *q);
    ck_assert(case_inverse(m, c.A, W));
    contact_product(m, W, c.f, q);
    c.cp.A = NULL;
    c.cp.W = W;
    c.cp.f = q;
    for (int i = 0; solver_row(i, &ops); ++i) {
      if (ops == NULL || !(ops->handles & NEEDS_STIFFNESS)) continue;
      case_cold(&c);
      solver_report rep = solve_by(ops, &c, tols[k % 5], c.u, c.r);
      ck_assert_msg(rep.outcome == CONVERGED, "%s: problem %d: %g", ops->name,
                    k, rep.residual);
    }
  }
}

/* A = G G' of half the rank plus 1e-8, mu = 2, in space; the load moves the
 * nodes by order one. */
static contact_case weak_case(int n, unsigned long long seed) {
  contact_case c = case_any(3, n, 2.0, 0, seed);
  int m = c.cp.m, rank = m / 2 + 1;
  unsigned long long state = 2685821657736338717u * (seed + 1u);
  double *G = calloc((size_t)(m * rank), sizeof *G), u[18];
  for (int i = 0; i < m * rank; ++i) G[i] = case_random(&state) - 0.5;
  for (int i = 0; i < m; ++i)
    for (int j = 0; j < m; ++j) {
      double sum = i == j ? 1e-8 : 0.0;
      for (int k = 0; k < rank; ++k) sum += G[i + m * k] * G[j + m * k];
      c.A[i + m * j] = sum;
    }
  for (int i = 0; i < m; ++i) u[i] = case_random(&state) - 0.3;
  contact_product(m, c.A, u, c.f);
  free(G);
  return c;
}

/* Nearly singular, large friction: what the first methods leave. */
TEST(last_method_solves_what_the_others_leave) {
  static const int hard[] = {869, 946, 1672, 2253, 2644};
  for (size_t k = 0; k < sizeof hard / sizeof *hard; ++k) {
    CONTACT_CASE c = weak_case(1 + hard[k] % 6, (unsigned long long)hard[k]);
    solver_report rep = solve_by(NULL, &c, 1e-8, c.u, c.r);
    ck_assert_msg(rep.outcome == CONVERGED, "%d: %s", hard[k],
                  outcome_text(rep.outcome));
    ck_assert_double_le(case_violation(&c, c.u, c.r), 1e-6);
  }
}

/* MAX_ITER bounds all that a method does: restarts and shares of friction. */
TEST(limit_holds_for_all_attempts_together) {
  const solver_ops *const rows[] = {&newton_solver, &auglag_solver,
                                    &sor_solver};
  CONTACT_CASE c = case_published(64, 20.0);
  for (int i = 0; i < 3; ++i)
    for (int limit = 1; limit <= 61; limit += 20) {
      case_cold(&c);
      double param[PARAM_SIZE / sizeof(double)] = {0.0};
      solver_choice choice = {
          .ops = rows[i], .param = param, .tol = 1e-14, .max_iter = limit};
      ENDS_BY(contact_solver_free) contact_solver *s = NULL;
      solver_report rep;
      option_defaults(rows[i]->options, param);
      ck_assert_int_eq(contact_solver_new(&choice, &s), OK);
      ck_assert_int_eq(contact_solve(s, &c.cp, NULL, c.u, c.r, &rep), OK);
      ck_assert_msg(rep.iterations <= limit, "%s: %d of %d", rows[i]->name,
                    rep.iterations, limit);
    }
}

/* The log of AUTO with so many iterations for each method. */
static void tried(const contact_problem *cp, double *u, double *r, int most,
                  solver_report *rep, char text[512]) {
  solver_choice choice = {.tol = 1e-10, .max_iter = most};
  ENDS_BY(contact_solver_free) contact_solver *s = NULL;
  memset(r, 0, sizeof *r * (size_t)cp->m);
  memcpy(u, cp->f, sizeof *u * (size_t)cp->m);
  ck_assert_int_eq(contact_solver_new(&choice, &s), OK);
  ck_assert_int_eq(contact_solve(s, cp, NULL, u, r, rep), OK);
  snprintf(text, 512, "%s", contact_solver_log(s));
}

/* The first methods that were tried are these. */
static void expect_order(const char *text, const char *const names[]) {
  const char *at = text;
  for (int i = 0; names[i] != NULL; ++i) {
    size_t length = strlen(names[i]);
    ck_assert_msg(strncmp(at, names[i], length) == 0 && at[length] == ':',
                  "%s is not in its place: %s", names[i], text);
    at = strstr(at, ", ");
    at = at == NULL ? "" : at + 2;
  }
}

TEST(sparse_methods_come_in_the_order_of_their_cost) {
  static const struct {
    planted_kind kind;
    const char *names[5];
  } cases[] = {
      {PLANTED_SINGULAR, {"aitken", "proximal", "pcg", "newton", NULL}},
      {PLANTED_CROWDED, {"aitken", "pcg", "proximal", "newton", NULL}}};
  for (int k = 0; k < 2; ++k) {
    char text[512];
    solver_report rep;
    planted p = planted_new(cases[k].kind, 3, 30, 0.3, 1);
    tried(&p.cp, p.u, p.r, 1, &rep, text);
    ck_assert_int_lt(rep.outcome, 0);
    expect_order(text, cases[k].names);
    planted_free(&p);
  }
}

/* Sweeps end where their rate promises no answer, and are told. */
TEST(sweeps_without_promise_are_left_and_told) {
  int left = 0;
  for (unsigned long long k = 0; k < 8; ++k) {
    char text[512];
    solver_report rep;
    int made = 0, allowed = 0;
    planted p = planted_new(PLANTED_SCALED, 3, 45, 0.7, k);
    tried(&p.cp, p.u, p.r, 0, &rep, text);
    ck_assert_int_eq(rep.outcome, CONVERGED);
    ck_assert_double_le(planted_map(&p, p.u, p.r), 1e-8);
    if (sscanf(text, "aitken: limit of iterations (%d of %d allowed)", &made,
               &allowed) == 2)
      left += made < allowed;
    planted_free(&p);
  }
  ck_assert_int_ge(left, 2);
}

/* Sweeps take a part of the time of NEWTON, of NEWTON along a friction path
 * most of all, which a singular compliance would need. */
TEST(few_contacts_are_solved_by_sweeps) {
  int swept = 0;
  for (unsigned long long k = 0; k < 24; ++k) {
    char text[512];
    solver_report rep;
    planted p = planted_new(PLANTED_SINGULAR, 3, 1 + (int)k % 8, 0.3, k);
    p.cp.blocks = NULL;
    p.cp.W = p.W;
    tried(&p.cp, p.u, p.r, 0, &rep, text);
    ck_assert_int_eq(rep.outcome, CONVERGED);
    ck_assert_double_le(planted_map(&p, p.u, p.r), 1e-8);
    swept += strcmp(rep.solver, "sor") == 0;
    planted_free(&p);
  }
  ck_assert_int_ge(swept, 8);
}

/* The residual of one iteration of a method, NULL: each of AUTO. */
static double after_one(const contact_case *c, const solver_ops *ops) {
  solver_choice choice = {.ops = ops, .tol = 1e-14, .max_iter = 1};
  unsigned char param[PARAM_SIZE] = {0};
  ENDS_BY(contact_solver_free) contact_solver *s = NULL;
  solver_report rep;
  if (ops != NULL) option_defaults(ops->options, param);
  choice.param = param;
  cold_start(&c->cp, c->u, c->r);
  ck_assert_int_eq(contact_solver_new(&choice, &s), OK);
  ck_assert_int_eq(contact_solve(s, &c->cp, NULL, c->u, c->r, &rep), OK);
  ck_assert_int_eq(rep.outcome, STOPPED_ITERATIONS);
  ck_assert_double_eq(rep.residual, contact_residual(&c->cp, c->u, c->r));
  return rep.residual;
}

/* Where no method succeeds the answer is the best of all, told as it is. */
TEST(best_of_the_failures_is_the_answer) {
  int differ = 0;
  for (unsigned long long k = 0; k < 6; ++k) {
    CONTACT_CASE c = case_any(2, 12, 0.3, 0, 500u + k);
    const double sweep = after_one(&c, &sor_solver),
                 step = after_one(&c, &newton_solver);
    ck_assert_double_le(after_one(&c, NULL), fmin(sweep, step) * (1 + 1e-9));
    differ += fmax(sweep, step) > 1.5 * fmin(sweep, step);
  }
  ck_assert_int_gt(differ, 2);
}

UNIT_MAIN("choice")
