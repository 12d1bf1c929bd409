/*
 * src/solver/newton/proximal.c: contacts of rigid bodies whose compliance is
 * semidefinite, also disturbed so that it is unsymmetric.
 */
#include "support/rigid_scene.h"
#include "support/solver_rows.h"
#include "support/unit.h"

#include <malloc.h>

static const double TOL = 1e-8;
static const double MISSES = 1e-7; /* violation of a claim */

static void must_solve(const solver_ops *ops, const rigid_scene *s) {
  CONTACT_CASE c = rigid_case(s);
  memcpy(c.u, c.f, (size_t)s->m * sizeof *c.u);
  solver_report rep = solve_by(ops, &c, TOL, c.u, c.r);
  ck_assert_msg(rep.outcome == CONVERGED, "%s: %s, residual %g", row_name(ops),
                outcome_text(rep.outcome), rep.residual);
  ck_assert_double_le(rigid_violation(s, &c), MISSES);
}

/* Those that the other links of AUTO do not solve. */
TESTS(unsymmetric_compliance_is_solved, 5) {
  static const struct {
    rigid_kind kind;
    int size;
    double mu;
    unsigned long long seed;
  } hard[] = {{RIGID_TOWER, 3, 1.0, 1},
              {RIGID_TOWER, 10, 0.6, 6},
              {RIGID_WALL, 10, 0.6, 6},
              {RIGID_ARCH, 8, 1.0, 1},
              {RIGID_BOX, 10, 1.5, 4}};
  RIGID_SCENE s =
      rigid_new(hard[_i].kind, 3, hard[_i].size, hard[_i].mu, hard[_i].seed);
  rigid_disturb(&s, 1e-3, hard[_i].seed);
  must_solve(&proximal_solver, &s);
  must_solve(NULL, &s);
}

TESTS(semidefinite_compliance_is_solved, RIGID_KINDS) {
  for (int dim = 2; dim <= 3; ++dim)
    for (unsigned long long seed = 1; seed <= 3; ++seed) {
      RIGID_SCENE s = rigid_new((rigid_kind)_i, dim, 6, 0.5, seed);
      must_solve(&proximal_solver, &s);
    }
}

/* Nine in ten entries of W are zero: products by rows, factors of UMFPACK, of
 * which nothing stays. */
TESTS(sparse_compliance_is_solved, 3) {
  rigid_kind kind = _i == 0 ? RIGID_TOWER : RIGID_HEAP;
  RIGID_SCENE s = rigid_new(kind, 3, _i == 0 ? 45 : 60, 0.5, 2);
  int filled = 0;
  for (int k = 0; k < s.m * s.m; ++k) filled += s.W[k] != 0.0;
  ck_assert_int_lt(10 * filled, s.m * s.m);
  if (_i == 2) rigid_disturb(&s, 1e-3, 2);
  /* The C library keeps small blocks back; the factors of a solution lost would
   * be 60 kB and more. */
  size_t used[4];
  for (int k = 0; k < 4; ++k) {
    must_solve(&proximal_solver, &s);
    used[k] = mallinfo2().uordblks;
  }
  ck_assert_uint_lt(used[3], used[2] + 20000);
  must_solve(NULL, &s);
}

UNIT_MAIN("proximal")
