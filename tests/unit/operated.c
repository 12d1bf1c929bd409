/*
 * The methods on a stiffness known by products and solves (operated_case.h),
 * next to unit/conformance: options, held unknowns, the order of AUTO, refused
 * memory.
 */
#include "support/operated_case.h"
#include "support/solver_rows.h"
#include "support/unit.h"

/* A method with an option of it, or without. */
typedef struct variant {
  const char *solver, *option, *value;
} variant;
static const variant variants[] = {{"newton", NULL, NULL},
                                   {"auglag", "VARIANT", "NEWTON"},
                                   {"auglag", "VARIANT", "UZAWA"},
                                   {"proximal", NULL, NULL},
                                   {"pcg", "PRECONDITIONER", "FACE"},
                                   {"pcg", "PRECONDITIONER", "DIAGONAL"},
                                   {"lagrange", "ACCELERATION", "NESTEROV"},
                                   {"lagrange", "ACCELERATION", "NONE"},
                                   {NULL, NULL, NULL}};
enum { VARIANTS = sizeof variants / sizeof *variants };

/* From u, r; what was tried in log[1024], or NULL. */
static status solve(const variant *v, contact_case *c, int max_iter,
                    solver_report *rep, char *log) {
  double param[PARAM_SIZE / sizeof(double)] = {0.0};
  ENDS_BY(contact_solver_free) contact_solver *s = NULL;
  solver_choice choice = {
      .ops = v->solver != NULL ? solver_find(v->solver) : NULL,
      .param = param,
      .tol = 1e-11,
      .max_iter = max_iter};
  if (choice.ops != NULL) option_defaults(choice.ops->options, param);
  if (v->option != NULL) set_option(choice.ops, param, v->option, v->value);
  status st = contact_solver_new(&choice, &s);
  if (st == OK) st = contact_solve(s, &c->cp, NULL, c->u, c->r, rep);
  if (st == OK && log != NULL) snprintf(log, 1024, "%s", contact_solver_log(s));
  return st;
}

/* A symmetric half of a block, whose last contact node is held along x. */
static contact_case half_block(double mu) {
  const case_block_data d = {.columns = 12,
                             .layers = 6,
                             .symmetric = 1,
                             .nu = 0.3,
                             .mu = mu,
                             .top = {0, -1e-3},
                             .left = {1.2e-3, 0}};
  return case_block(&d);
}

/* The held unknown is moved by its own row, by 1e-3. */
TESTS(held_unknowns_are_solved_for_alone, VARIANTS) {
  CONTACT_CASE c = half_block(0.4);
  solver_report rep;
  int held = -1;
  for (int i = 0; i < c.cp.m; ++i)
    if (contact_held(&c.cp, i)) held = i;
  ck_assert_int_ge(held, 0);
  c.f[held] = 1e-3 * c.A[held * (c.cp.m + 1)];
  operated_case *o = operated_new(&c);
  case_cold(&c);
  ck_assert_int_eq(solve(&variants[_i], &c, 0, &rep, NULL), OK);
  ck_assert_int_eq(rep.outcome, CONVERGED);
  ck_assert_double_eq_tol(c.u[held], 1e-3, 1e-13);
  ck_assert_double_le(case_violation(&c, c.u, c.r), 1e-9);
  operated_free(o, &c);
}

/* Nodes that do not touch have no force, not even rounding. */
static void open_nodes_are_free(const contact_case *c) {
  for (int i = 0; i < c->cp.n; ++i)
    if (c->u[i * c->cp.dim] < c->gap[i] - 1e-6)
      for (int k = 0; k < c->cp.dim; ++k)
        ck_assert(c->r[i * c->cp.dim + k] == 0.0);
}

/* In space, where slip turns, and in the plane; from a cold start, and for
 * another load from the answer. */
TESTS(variants_solve, VARIANTS) {
  for (int k = 0; k < 4; ++k) {
    CONTACT_CASE c = case_any(2 + k % 2, 9, 0.3, k / 2, 700u + (unsigned)k);
    solver_report rep;
    operated_case *o = operated_new(&c);
    for (int load = 0; load < 2; ++load) {
      ck_assert_int_eq(solve(&variants[_i], &c, 0, &rep, NULL), OK);
      ck_assert_int_eq(rep.outcome, CONVERGED);
      ck_assert_double_le(case_violation(&c, c.u, c.r), 1e-9);
      open_nodes_are_free(&c);
      for (int i = 0; i < c.cp.m; ++i) c.f[i] *= i % 2 ? 1.3 : 0.8;
    }
    operated_free(o, &c);
  }
}

/* Of Newton's kind: friction follows pressure in a step, so there are not many.
 */
TESTS(steps_are_as_many_as_by_the_entries, 4) {
  for (int k = 0; k < 6; ++k) {
    CONTACT_CASE c = case_any(2 + k % 2, 20, 0.8, k / 2 % 2, 60u + (unsigned)k);
    solver_report dense, sparse;
    case_cold(&c);
    ck_assert_int_eq(solve(&variants[_i], &c, 0, &dense, NULL), OK);
    operated_case *o = operated_new(&c);
    case_cold(&c);
    ck_assert_int_eq(solve(&variants[_i], &c, 0, &sparse, NULL), OK);
    ck_assert_int_le(10 * sparse.iterations, 11 * dense.iterations + 30);
    operated_free(o, &c);
  }
}

/* A unit of force and one of length: A by 2^41, f by 2^28. */
TESTS(factors_of_two_change_no_bit, VARIANTS) {
  for (int k = 0; k < 2; ++k) {
    CONTACT_CASE c = case_any(2 + k, 9, 0.3, 0, 80u),
                 d = case_any(2 + k, 9, 0.3, 0, 80u);
    solver_report one, two;
    const int m = c.cp.m;
    for (int j = 0; j < m * m; ++j) d.A[j] = ldexp(c.A[j], 41);
    for (int j = 0; j < m; ++j) d.f[j] = ldexp(c.f[j], 28);
    for (int j = 0; j < c.cp.n; ++j) d.gap[j] = ldexp(c.gap[j], -13);
    for (int j = 0; j < m - c.cp.n; ++j) d.ut0[j] = ldexp(c.ut0[j], -13);
    operated_case *o = operated_new(&c), *q = operated_new(&d);
    ck_assert_int_eq(solve(&variants[_i], &c, 0, &one, NULL), OK);
    ck_assert_int_eq(solve(&variants[_i], &d, 0, &two, NULL), OK);
    ck_assert_int_eq(one.iterations, two.iterations);
    for (int j = 0; j < m; ++j)
      ck_assert(d.u[j] == ldexp(c.u[j], -13) && d.r[j] == ldexp(c.r[j], 28));
    operated_free(o, &c);
    operated_free(q, &d);
  }
}

/* Those that need no entries come first. */
TEST(entries_are_formed_last) {
  static const char *const order[] = {
      "newton: ", "newton along", "auglag: ", "proximal: ", "pcg: ", "sor: "};
  char log[1024];
  CONTACT_CASE c = case_any(3, 12, 1.5, 0, 41);
  operated_case *o = operated_new(&c);
  solver_report rep;
  const char *at = log;
  case_cold(&c);
  ck_assert_int_eq(solve(&variants[VARIANTS - 1], &c, 1, &rep, log), OK);
  for (size_t i = 0; i < sizeof order / sizeof *order; ++i) {
    at = strstr(at, order[i]);
    ck_assert_msg(at != NULL, "%s not in its place: %s", order[i], log);
  }
  operated_free(o, &c);
}

TESTS(refused_memory_is_given_back, VARIANTS) {
  CONTACT_CASE c = half_block(0.4);
  operated_case *o = operated_new(&c);
  status st = ERR_MEMORY;
  for (long k = 1; st != OK; ++k) {
    const size_t before = memory_in_use();
    solver_report rep;
    case_cold(&c);
    memory_refuse(k, 0);
    st = solve(&variants[_i], &c, 0, &rep, NULL);
    memory_refuse(0, 0);
    status_clear();
    ck_assert(st == OK || st == ERR_MEMORY);
    ck_assert_uint_eq(memory_in_use(), before);
  }
  operated_free(o, &c);
}

UNIT_MAIN("operated")
