/*
 * Contacts of rigid bodies, more of them than the bodies can move, so that the
 * compliance is semidefinite: boxes, towers, walls, arches and heaps at rest,
 * pushed or thrown about, with W as it is and with an unsymmetric part of 1e-3.
 * AUTO solves all of the first; of the second, which need not have a solution,
 * at most one in fifty is left. No claim is wrong.
 */
#include "support/rigid_scene.h"
#include "support/solver_rows.h"
#include "support/unit.h"

/* Violation of a claim to 1e-8; 1.9e-8 at most. */
static const double MISSES = 1e-7;

static int is_solved(const rigid_scene *s) {
  CONTACT_CASE c = rigid_case(s);
  memcpy(c.u, c.f, (size_t)s->m * sizeof *c.u);
  solver_report rep = solve_by(NULL, &c, 1e-8, c.u, c.r);
  int solved = rep.outcome == CONVERGED;
  double bad = solved ? rigid_violation(s, &c) : 0.0;
  ck_assert_msg(bad <= MISSES, "claims a violation of %g", bad);
  return solved;
}

/* _i: the kind of scene */
TESTS(scenes_of_rigid_bodies_are_solved, RIGID_KINDS) {
  static const int sizes[] = {1, 3, 8, 15};
  static const double mus[] = {0.0, 0.3, 1.0};
  rigid_kind kind = (rigid_kind)_i;
  int per = kind == RIGID_HEAP ? 4 : 1, tried = 0, missed = 0;
  for (size_t k = 0; k < sizeof sizes / sizeof *sizes; ++k)
    for (size_t a = 0; a < sizeof mus / sizeof *mus; ++a)
      for (int way = 0; way < 12; ++way) {
        int dim = 2 + way % 2, disturbed = way / 2 % 2;
        unsigned long long seed = 1 + (unsigned)way / 4;
        RIGID_SCENE s = rigid_new(kind, dim, per * sizes[k], mus[a], seed);
        if (disturbed) rigid_disturb(&s, 1e-3, seed);
        int solved = is_solved(&s);
        ck_assert_msg(solved || disturbed,
                      "%s, %d-D, size %d, mu %g, seed %llu: not solved",
                      rigid_name(kind), dim, per * sizes[k], mus[a], seed);
        tried += disturbed;
        missed += !solved;
      }
  ck_assert_msg(missed * 100 <= 2 * tried, "%s: %d of %d not solved",
                rigid_name(kind), missed, tried);
}

UNIT_MAIN_FOR("rigid", 10 * UNIT_SECONDS)
