/* src/solver: rigid bodies, whose compliance is semidefinite, also with an
 * unsymmetric part. Forces are not unique: judged by the conditions alone. */
#include "support/fclib_file.h"
#include "support/rigid_scene.h"
#include "support/solver_rows.h"
#include "support/unit.h"

static const double TOL = 1e-8;
/* Violation that a claim of TOL may have. The angle between slip and force and
 * the slip are counted apart, their product is what the residual holds small.
 */
static const double FAIR = 1e-5;

/* 1: solved; a claim must hold. */
static int solves(const solver_ops *ops, const rigid_scene *s, const char *what,
                  unsigned long long seed) {
  CONTACT_CASE c = rigid_case(s);
  solver_report rep = solve_by(ops, &c, TOL, c.u, c.r);
  int solved = rep.outcome == CONVERGED;
  double bad = solved ? rigid_violation(s, &c) : 0.0;
  ck_assert_msg(bad <= FAIR,
                "%s: %s, %d-D, seed %llu: claims a violation of %g",
                row_name(ops), what, s->dim, seed, bad);
  ck_assert_msg(solved || ops != NULL, "%s, %d-D, %d contacts, seed %llu: %s",
                what, s->dim, s->n, seed, outcome_text(rep.outcome));
  return solved;
}

TEST(auto_solves_rigid_bodies_at_rest_and_in_motion) {
  static const double mu[] = {0.0, 0.3, 0.8};
  static const int sizes[] = {3, 10, 16};
  for (int k = 0; k < 36 * RIGID_KINDS; ++k) {
    rigid_kind kind = (rigid_kind)(k / 36);
    unsigned long long seed = 1u + (unsigned)(k / 18 % 2);
    RIGID_SCENE s =
        rigid_new(kind, 2 + k % 2, sizes[k / 2 % 3], mu[k / 6 % 3], seed);
    solves(NULL, &s, rigid_name(kind), seed);
  }
}

TEST(rows_claim_nothing_wrong_on_rigid_bodies) {
  const solver_ops *ops;
  for (int k = 0; k < 4 * RIGID_KINDS; ++k) {
    rigid_kind kind = (rigid_kind)(k / 4);
    RIGID_SCENE s = rigid_new(kind, 2 + k % 2, 4, k % 4 < 2 ? 0.3 : 0.7, 11);
    int solved = 0;
    for (int i = 0; solver_row(i, &ops); ++i)
      solved += solves(ops, &s, rigid_name(kind), 11);
    ck_assert_int_ge(solved, 3);
  }
}

/* An unsymmetric part of a thousandth of W, of the same rank: W (I + e S W). */
TEST(auto_solves_unsymmetric_rigid_bodies) {
  for (int k = 0; k < 6 * RIGID_KINDS; ++k) {
    rigid_kind kind = (rigid_kind)(k / 6);
    unsigned long long seed = 31u + (unsigned)k;
    RIGID_SCENE s = rigid_new(kind, 2 + k % 2, 3, 0.3, seed);
    size_t m = (size_t)s.m;
    FREED double *SW = calloc(m * m, sizeof *SW),
                 *more = calloc(m * m, sizeof *more);
    double size = 0.0, large = 0.0;
    for (size_t i = 0; i < m; ++i)
      for (size_t j = 0; j < i; ++j) {
        double e = case_random(&seed) - 0.5;
        for (size_t l = 0; l < m; ++l) {
          SW[i + m * l] += e * s.W[j + m * l];
          SW[j + m * l] -= e * s.W[i + m * l];
        }
      }
    for (size_t l = 0; l < m; ++l)
      contact_product(s.m, s.W, SW + m * l, more + m * l);
    for (size_t i = 0; i < m * m; ++i) {
      size = fmax(size, fabs(s.W[i]));
      large = fmax(large, fabs(more[i]));
    }
    for (size_t i = 0; i < m * m; ++i) s.W[i] += 1e-3 * size / large * more[i];
    solves(NULL, &s, rigid_name(kind), 31u + (unsigned)k);
  }
}

UNIT_MAIN("rigid_bodies")
