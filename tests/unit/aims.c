/*
 * src/program/aims.c: the sizes that targets of *GOAL require, on a regular
 * mesh whose elements have all the same product of errors. An error of second
 * order becomes that part of itself by elements of the root of it.
 */
#include "program/job.h"
#include "support/grid.h"
#include "support/unit.h"

/* Passes with this result, the target is 1: lengths over those of the mesh, at
 * a corner, 2 where none is required; the product of its element is "more"
 * times that of others, each. */
static double ratio_at(const goal_result *result, int passes, double each,
                       double more) {
  goal_card goal = {.quantity = GOAL_FORCE, .target = 1.0};
  model m = {.n.goal = 1, .accuracy.goals = &goal};
  OWNED mesh *msh = make_grid_2d((int[]){4, 4}, (double[]){1.0, 1.0});
  FREED double *product = calloc((size_t)msh->n_elem, sizeof *product);
  FREED double *size = calloc((size_t)msh->n_node, sizeof *size);
  FREED double *length = calloc((size_t)msh->n_node, sizeof *length);
  OWNED aims *a = NULL;
  for (int k = 0; k < msh->n_elem; ++k) {
    const int *v = msh->elem + 3 * k;
    product[k] = v[0] == 0 || v[1] == 0 || v[2] == 0 ? each * more : each;
  }
  ck_assert_int_eq(aims_new(&m, 0, &a), OK);
  for (int k = 0; k < passes; ++k) {
    goal_result of = *result;
    if (more == 0.0) of.error *= passes - k;
    state s = {.errors = {.n_goal = 1, .goals = &of, .goal_products = product}};
    ck_assert_int_eq(aims_begin(a, msh), OK);
    aims_see(a, msh, &s);
    aims_evaluate(a, &m);
  }
  space_lengths(msh, length);
  for (int i = 0; i < msh->n_node; ++i) size[i] = 2.0 * length[i];
  ck_assert_int_eq(aims_sizes(a, &m, msh, NULL, size), OK);
  for (int i = 1; i < msh->n_node && more > 0.0; ++i)
    ck_assert_double_eq_tol(size[i], size[0], 1e-12);
  return size[0] / length[0];
}

static double ratio_of(const goal_result *result, int passes) {
  return ratio_at(result, passes, 0.3, 1.0);
}

/* |error| + band, the error of the solver, and 0.93 of the target in the place
 * of it. What is at the ends of contact counts twice where that alone misses
 * the target; more than ten times off the way is halved. Without an estimate
 * half of the error. No length becomes less than a quarter, a tenth where the
 * elements' errors become at most eight times smaller. */
TEST(sizes_follow_the_errors_of_a_goal) {
  static const struct {
    goal_verdict verdict;
    double error, band, solver, part;
  } rows[] = {{GOAL_RELIABLE, -3.0, 1.0, 0.0, 0.93 / 4.0},
              {GOAL_RELIABLE, 2.0, 1.0, -1.0, 0.93 / 4.0},
              {GOAL_RELIABLE, 20.0, 20.0, 0.0, 0.93 / 40.0},
              {GOAL_CONTACT_END, 3.0, 1.0, 0.0, 0.93 / 4.0},
              {GOAL_CONTACT_END, 0.5, 0.3, 0.0, 0.93 / 1.6},
              {GOAL_CONTACT_END, 20.0, 20.0, 0.0, 0.15247950681976907},
              {GOAL_SUPPORT_END, 20.0, 20.0, 0.0, 0.15247950681976907},
              {GOAL_FEW_NODES, 20.0, 20.0, 0.0, 0.5},
              {GOAL_RELIABLE, 0.4, 0.1, 0.0, 1.0}};
  for (int k = 0; k < 9; ++k) {
    const goal_result r = {.value = 100.0,
                           .error = rows[k].error,
                           .band = rows[k].band,
                           .solver = rows[k].solver,
                           .verdict = rows[k].verdict};
    /* The second in vain aims at half of that. */
    for (int passes = 1; passes <= 2; ++passes) {
      const double all = sqrt(rows[k].part / passes);
      ck_assert_double_eq_tol(ratio_of(&r, passes),
                              fmax(all, 8.0 * all < 1.0 ? 0.25 : 0.1), 1e-12);
    }
  }
}

/* The gap alone is in error: what elements have is rounding. */
TEST(products_of_rounding_require_no_sizes) {
  const goal_result r = {.value = 100.0, .error = 3.0};
  ck_assert_double_eq_tol(ratio_at(&r, 1, 1e-12, 1.0), 2.0, 1e-12);
  ck_assert_double_lt(ratio_at(&r, 1, 1e-6, 1.0), 1.0);
}

/* Elements without an error become larger, but not in a mesh of the passes
 * whose error is below twice the target. */
TEST(near_the_target_nothing_becomes_coarser) {
  goal_result r = {.value = 100.0, .error = 1.5};
  ck_assert_double_ge(ratio_at(&r, 1, 0.3, 0.0), 1.1);
  ck_assert_double_eq_tol(ratio_at(&r, 2, 0.3, 0.0), 1.0, 1e-12);
  r.error = 2.0;
  ck_assert_double_ge(ratio_at(&r, 2, 0.3, 0.0), 1.04);
}

/* A factor whose allowed error is 1 of 100 uses no element shorter than 0.03
 * times the radius of its domain, whatever its own size; at most a tenth. */
TEST(elements_at_a_tip_are_as_long_as_the_target_can_use) {
  goal_result r = {.value = 0.5, .error = 40.0, .size = 100.0};
  const double least = ratio_of(&r, 1);
  const double length = sqrt(4.0 / sqrt(3.0) / 32.0);
  r.radius = 0.8 * length / 0.03;
  ck_assert_double_lt(least, 0.7);
  ck_assert_double_eq_tol(ratio_of(&r, 1), 0.8, 1e-12);
  r.size = 1.0;
  r.radius = 8.0 * length;
  ck_assert_double_eq_tol(ratio_of(&r, 1), 0.8, 1e-12);
  r.size = 0.0;
  ck_assert_double_eq_tol(ratio_of(&r, 1), least, 1e-12);
}

/* Without an estimate elements round the closed nodes of the contact, here one
 * of contact 0, or round its nearest node, become half as long; with one that
 * needs no sizes they stay. */
TEST(zones_without_an_estimate_become_finer) {
  int node_id[] = {0, 12, 24}, contact_id[] = {0, 1, 1};
  const double gap[] = {0.0, 0.2, -1e-18};
  const contact_status is[] = {CONTACT_STICK, CONTACT_OPEN, CONTACT_OPEN};
  const contact_surface surface = {
      .dim = 2, .n = 3, .node_id = node_id, .contact_id = contact_id};
  OWNED mesh *msh = make_grid_2d((int[]){4, 4}, (double[]){1.0, 1.0});
  FREED double *product = calloc((size_t)msh->n_elem, sizeof *product);
  FREED double *length = calloc((size_t)msh->n_node, sizeof *length);
  FREED double *size = calloc((size_t)msh->n_node, sizeof *size);
  space_lengths(msh, length);
  for (int of = -1; of < 3; ++of) {
    const int near = of == 1 ? 24 : of == 2 ? -1 : 0;
    goal_card goal = {
        .quantity = GOAL_WIDTH, .target = 1.0, .contact_id = of % 2};
    const model m = {.n.goal = 1, .accuracy.goals = &goal};
    const goal_result found = {
        .value = NAN, .verdict = of == 2 ? GOAL_RELIABLE : GOAL_FEW_NODES};
    const state s = {
        .contacts = {.surface = &surface, .contact = is, .gap = gap},
        .errors = {.n_goal = 1, .goals = &found, .goal_products = product}};
    OWNED aims *a = NULL;
    ck_assert_int_eq(aims_new(&m, 0, &a), OK);
    ck_assert_int_eq(aims_begin(a, msh), OK);
    aims_see(a, msh, &s);
    aims_evaluate(a, &m);
    for (int i = 0; i < msh->n_node; ++i) size[i] = 2.0 * length[i];
    ck_assert_int_eq(aims_sizes(a, &m, msh, NULL, size), OK);
    for (int i = 0; i < msh->n_node; ++i) {
      int beside = 0;
      for (int k = 0; k < 9 * msh->n_elem; ++k) {
        const int *v = msh->elem + k / 9 * 3;
        beside |= v[k % 3] == i && v[k / 3 % 3] == near;
      }
      ck_assert_double_eq(size[i], (beside ? 0.5 : 2.0) * length[i]);
    }
  }
}

/* The pass after which goals stand still, 0: none of n, on meshes of cells[k]
 * squares with nodes that slip and stick. */
static int still_after(int n, const int *cells, const int *slip,
                       const int *stick, double error) {
  goal_card goal = {.quantity = GOAL_FORCE, .target = 1.0};
  const model m = {.n.goal = 1, .accuracy.goals = &goal};
  const goal_result found = {
      .value = 9.0,
      .error = error,
      .verdict = isnan(error) ? GOAL_FEW_NODES : GOAL_RELIABLE};
  OWNED aims *a = NULL;
  int still = 0;
  ck_assert_int_eq(aims_new(&m, 0, &a), OK);
  for (int k = 0; k < n && !still; ++k) {
    OWNED mesh *msh = make_grid_2d((int[]){cells[k], 1}, (double[]){1.0, 1.0});
    FREED double *product = calloc((size_t)msh->n_elem, sizeof *product);
    const state s = {
        .contacts = {.n_slip = slip[k], .n_stick = stick[k]},
        .errors = {.n_goal = 1, .goals = &found, .goal_products = product}};
    ck_assert_int_eq(aims_begin(a, msh), OK);
    aims_see(a, msh, &s);
    aims_evaluate(a, &m);
    if (aims_stand_still(a)) still = k + 1;
  }
  return still;
}

/* An error that stays ends it on three times the nodes, in two passes. Where
 * none is known four passes do, unless half as many nodes more are closed than
 * in all passes before. */
TEST(goals_stand_still_where_passes_gain_nothing) {
  static const int one[] = {1, 1, 1, 1, 1, 1}, none[] = {0, 0, 0, 0, 0, 0};
  static const int more[] = {2, 3, 5, 8, 12, 18},
                   few[] = {5, 7, 10, 14, 20, 29}, back[] = {9, 2, 9, 2, 9, 2};
  static const int cells[] = {1, 3, 5, 7, 9, 11}, near[] = {5, 6, 7, 8, 9, 10};
  ck_assert_int_eq(still_after(6, cells, one, none, 3.0), 3);
  ck_assert_int_eq(still_after(6, near, one, none, 3.0), 5);
  ck_assert_int_eq(still_after(6, cells, one, none, NAN), 5);
  ck_assert_int_eq(still_after(6, cells, one, one, NAN), 5);
  ck_assert_int_eq(still_after(6, cells, none, none, NAN), 4);
  ck_assert_int_eq(still_after(6, cells, more, none, NAN), 0);
  ck_assert_int_eq(still_after(6, cells, none, more, NAN), 0);
  ck_assert_int_eq(still_after(6, cells, few, none, NAN), 5);
  ck_assert_int_eq(still_after(6, cells, back, none, NAN), 5);
}

UNIT_MAIN("aims")
