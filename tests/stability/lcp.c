/*
 * Plain complementarity problems of 3 to 200 unknowns, all families: those with
 * a solution are solved, those without are proved to have none, and no claim is
 * wrong.
 */
#include "solver/lcp/lcp_solve.h"
#include "support/lcp_case.h"
#include "support/points.h"
#include "support/unit.h"

enum { SEEDS = 10 };

static outcome solve(lcp_case *c) {
  const lcp_control control = {.tol = 1e-8};
  lcp_data p = {c->n, c->M, c->q};
  lcp_verdict v;
  ck_assert_int_eq(lcp_solve(&p, &control, c->z, c->w, &v), OK);
  double bad = v.outcome == CONVERGED ? lcp_violation(c, c->z) : 0.0;
  ck_assert_msg(bad <= 1e-8, "claims a violation of %g", bad);
  return v.outcome;
}

/* _i: the family */
TESTS(family_ends_as_it_must, LCP_FAMILIES) {
  static const int sizes[] = {3, 6, 12, 25, 50, 100, 200};
  lcp_family family = (lcp_family)_i;
  int solved = 0, tried = 0;
  for (size_t k = 0; k < sizeof sizes / sizeof *sizes; ++k)
    for (unsigned long long seed = 1; seed <= SEEDS; ++seed) {
      /* planted solutions of large indefinite problems cannot be looked for */
      int hard = family >= LCP_INDEFINITE && family < LCP_INFEASIBLE;
      if (hard && sizes[k] > 25) continue;
      LCP_CASE c = lcp_make(family, sizes[k], seed);
      outcome o = solve(&c), want = CONVERGED;
      if (family >= LCP_INFEASIBLE) want = STOPPED_RAY;
      if (hard) ck_assert_int_ne(o, STOPPED_RAY);
      ck_assert_msg(hard || o == want, "%s, n = %d, seed %llu: %s",
                    lcp_name(family), c.n, seed, outcome_text(o));
      solved += o == want;
      ++tried;
    }
  ck_assert_msg(solved * 10 >= tried * 9, "%s: %d of %d", lcp_name(family),
                solved, tried);
  points_end(&(points){.kind = "complementarity problems", .tried = tried});
}

UNIT_MAIN_FOR("lcp", 10 * UNIT_SECONDS)
