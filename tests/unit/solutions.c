/*
 * src/accuracy: second solutions, by several solvers and by all combinations
 * of statuses.
 */
#include "accuracy/solutions.h"
#include "solver/solver.h"
#include "support/contact_case.h"
#include "support/unit.h"

static solver_report solve(contact_case *c) {
  ENDS_BY(contact_solver_free) contact_solver *s = NULL;
  solver_report rep;
  solver_choice choice = {.tol = 1e-12};
  ck_assert_int_eq(contact_solver_new(&choice, &s), OK);
  ck_assert_int_eq(contact_solve(s, &c->cp, NULL, c->u, c->r, &rep), OK);
  return rep;
}

static solution_set all_of(contact_case *c) {
  solution_set all = {0};
  solve(c);
  ck_assert_int_eq(solutions_by_statuses(&c->cp, 1e-10, c->u, c->r, &all), OK);
  return all;
}

/* 1 if a state with these displacements is among them. */
static int has_state(const solution_set *s, double u_n, double u_t) {
  for (int i = 0; i < s->n_found; ++i)
    if (fabs(s->found[i].u[0] - u_n) + fabs(s->found[i].u[1] - u_t) < 1e-9)
      return 1;
  return 0;
}

/* Contact frame of the triangle: u_n = -u_y, u_t = u_x. With K u = F: open
 * u = inv(K) F; stick 0; slip u_x = (F_x + mu F_y)/(K_xx + mu K_xy). */
TEST(triangle_has_the_three_solutions) {
  static const double mu[] = {2.0, 3.0};
  for (int k = 0; k < 2; ++k) {
    CONTACT_CASE c = case_triangle(0.3, mu[k], 1.9, -1.0);
    double xx = c.A[3], yy = c.A[0], xy = -c.A[1], det = xx * yy - xy * xy;
    solution_set all = all_of(&c), some = {0};
    solver_report rep = {.outcome = CONVERGED, .solver = "newton"};
    ck_assert_int_eq(solutions_by_solvers(&c.cp, 1e-10, &rep, c.u, c.r, &some),
                     OK);
    const solution_set *set[] = {&all, &some};
    for (int i = 0; i < 2; ++i) {
      ck_assert_int_eq(set[i]->n_found, 3);
      ck_assert(has_state(set[i], 0.0, 0.0));
      ck_assert(
          has_state(set[i], -(-xx - 1.9 * xy) / det, (1.9 * yy + xy) / det));
      ck_assert(has_state(set[i], 0.0, (1.9 - mu[k]) / (xx + mu[k] * xy)));
    }
    ck_assert_int_eq(all.n_pattern, 4);
    solution_set_free(&all);
    solution_set_free(&some);
  }
}

/* Little friction: one solution, that of the solver, whatever the labels. */
TEST(small_friction_has_one_solution) {
  int sliding = 0;
  for (int k = 0; k < 60; ++k) {
    CONTACT_CASE c =
        case_any(2, 1 + k % 6, 0.1, k / 2 % 2, (unsigned long long)(300 + k));
    if (k % 3 == 0) c.cp.B = NULL;
    for (int i = 0; i < c.cp.n; ++i) c.g0[i] = k % 3 == 0 ? 0.2 : 0.0;
    solution_set all = all_of(&c);
    ck_assert_msg(all.n_found == 1, "problem %d: %d solutions", k, all.n_found);
    ck_assert_int_ge(all.found[0].facts.patterns, 1);
    ck_assert_double_lt(all.found[0].facts.residual, 1e-11);
    contact_status is[6];
    int n[3] = {0};
    contact_classify(&c.cp, all.found[0].u, all.found[0].r, is);
    for (int i = 0; i < c.cp.n; ++i) ++n[is[i]];
    ck_assert_int_eq(all.found[0].facts.n_stick, n[CONTACT_STICK]);
    ck_assert_int_eq(all.found[0].facts.n_slip, n[CONTACT_SLIP]);
    ck_assert_int_eq(all.found[0].facts.n_open, n[CONTACT_OPEN]);
    sliding += n[CONTACT_SLIP];
    solution_set_free(&all);
  }
  ck_assert_int_gt(sliding, 5);
}

/* Each state found holds all conditions; what several solvers find is there;
 * their number is odd, as the degree of the problem is one. */
TEST(enumeration_finds_what_solvers_find) {
  int several = 0;
  for (int k = 0; k < 200; ++k) {
    CONTACT_CASE c =
        case_any(2, 1 + k % 5, 6.0, k / 2 % 2, (unsigned long long)(700 + k));
    solver_report rep = solve(&c);
    solution_set all = all_of(&c), some = {0};
    ck_assert_int_eq(solutions_by_solvers(&c.cp, 1e-10, &rep, c.u, c.r, &some),
                     OK);
    ck_assert_int_ge(all.n_found, some.n_found);
    for (int i = 0; i < all.n_found; ++i)
      ck_assert_double_lt(case_violation(&c, all.found[i].u, all.found[i].r),
                          1e-8);
    several += all.n_found > 1;
    ck_assert_int_eq(all.n_found % 2, 1);
    int found = all.n_found;
    for (int i = 0; i < some.n_found; ++i) {
      int no;
      ck_assert_int_eq(solution_set_add(&c.cp, 1e-10, some.found[i].u,
                                        some.found[i].r, &all, &no),
                       OK);
      ck_assert_int_le(no, found);
    }
    solution_set_free(&all);
    solution_set_free(&some);
  }
  ck_assert_int_gt(several, 5);
}

TEST(ten_nodes_are_enumerated) {
  CONTACT_CASE c = case_any(2, 10, 0.3, 1, 5);
  solution_set all = all_of(&c);
  ck_assert_int_eq(all.n_pattern, 1l << 20);
  ck_assert_int_ge(all.n_found, 1);
  solution_set_free(&all);
}

TEST(larger_problems_are_refused) {
  for (int dim = 2; dim <= 3; ++dim) {
    CONTACT_CASE c = case_any(dim, dim == 2 ? 11 : 2, 0.3, 0, 5);
    solution_set all = {0};
    ck_assert_int_eq(solutions_by_statuses(&c.cp, 1e-10, c.u, c.r, &all),
                     ERR_DECK);
    ck_assert_ptr_nonnull(strstr(status_message(), "10 contact nodes in 2-D"));
    solution_set_free(&all);
  }
}

/* By solvers: one solution, which is confirmed. */
static solution_set only_solution(contact_case *c) {
  solver_report rep = solve(c);
  solution_set some = {0};
  ck_assert_int_eq(solutions_by_solvers(&c->cp, 1e-10, &rep, c->u, c->r, &some),
                   OK);
  ck_assert_int_eq(some.n_found, 1);
  ck_assert(solution_set_confirmed(&some));
  return some;
}

/* The answer of one solver is confirmed by another family only. */
TEST(one_family_alone_confirms_nothing) {
  CONTACT_CASE c = case_any(2, 4, 0.2, 0, 11);
  solution_set some = only_solution(&c);
  for (int k = 0; k < some.n_attempt; ++k)
    if (strcmp(some.attempts[k].family, some.attempts[0].family) != 0)
      some.attempts[k].solution_no = 0;
  ck_assert(!solution_set_confirmed(&some));
  solution_set_free(&some);
  ck_assert(!solution_set_confirmed(&some));
}

/* Without tangents the problem is convex: one solution from every start. */
TEST(normal_unknowns_alone_have_one_solution) {
  CONTACT_CASE c = case_any(1, 6, 0.0, 0, 12);
  solution_set some = only_solution(&c);
  solution_set_free(&some);
}

/* What a run that did not converge stopped with is no solution. */
TEST(last_iterate_confirms_nothing) {
  CONTACT_CASE c = case_any(2, 4, 0.2, 0, 11);
  solver_report rep = solve(&c);
  solution_set some = {0};
  c.u[0] += 1e-3;
  rep.outcome = STOPPED_STAGNATION;
  ck_assert_int_eq(solutions_by_solvers(&c.cp, 1e-10, &rep, c.u, c.r, &some),
                   OK);
  ck_assert_int_eq(some.n_found, 1);
  ck_assert_int_eq(some.attempts[0].solution_no, 0);
  ck_assert_int_eq(some.attempts[0].outcome, STOPPED_STAGNATION);
  ck_assert_int_eq(some.attempts[1].solution_no, 1);
  solution_set_free(&some);
}

/* One solver of each family of the table, supports or none. */
TEST(every_family_is_tried_once) {
  for (int floating = 0; floating < 2; ++floating) {
    case_block_data d = {.columns = 4,
                         .layers = 2,
                         .clamped = !floating,
                         .nu = 0.3,
                         .mu = 0.2,
                         .top = {0.01, -0.2}};
    CONTACT_CASE c = case_block(&d);
    solver_report rep = solve(&c);
    solution_set some = {0};
    ck_assert_int_eq(solutions_by_solvers(&c.cp, 1e-10, &rep, c.u, c.r, &some),
                     OK);
    for (int i = 0; solver_list[i] != NULL; ++i) {
      const solver_ops *ops = solver_list[i];
      int own = 0, others = 0;
      for (int k = 1; k < some.n_attempt; ++k) {
        const solution_attempt *a = &some.attempts[k];
        own += strcmp(a->solver, ops->name) == 0;
        others += strcmp(a->solver, ops->name) != 0 &&
                  strcmp(a->family, ops->family) == 0;
      }
      ck_assert_msg(own + others == 4 && own * others == 0, "%s: %d, %d",
                    ops->name, own, others);
    }
    solution_set_free(&some);
  }
}

UNIT_MAIN("solutions")
