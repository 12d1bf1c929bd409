/*
 * src/effects/plan/sizes.c: entries and operations of the factor foreseen from
 * the number of unknowns besides those that CHOLMOD counts for blocks in the
 * plane and in space, the contact last.
 */
#include "fem/fem.h"
#include "effects/plan/plan.h"
#include "support/pressed_block.h"
#include "support/unit.h"

#include <math.h>

/* Segments on the floor of a square; elements along the edges of a cube. */
static const struct {
  int dim, nodes, layers;
} blocks[] = {{2, 17, 16}, {2, 65, 64},  {2, 257, 256}, {2, 257, 64},
              {3, 81, 8},  {3, 169, 12}, {3, 361, 18},  {3, 625, 12}};

START_TEST(factor_has_the_size_that_was_foreseen) {
  for (size_t k = 0; k < sizeof blocks / sizeof *blocks; ++k) {
    pressed_block b;
    int dim = blocks[k].dim;
    pressed_block_new(&b, dim, blocks[k].nodes, blocks[k].layers);
    condense_info has = condensed_info(b.c);
    plan_sizes s = {
        .dim = dim, .is_flat = dim == 2, .unknowns = (double)has.unknowns};
    double entries = (double)has.factor_entries / work_factor_entries(&s);
    double flops = has.flops / work_factor_flops(&s);
    ck_assert_msg(entries > 0.5 && entries < 2, "%d-D, %ld: entries %g", dim,
                  has.unknowns, entries);
    ck_assert_msg(flops > 0.5 && flops < 2, "%d-D, %ld: flops %g", dim,
                  has.unknowns, flops);
    pressed_block_free(&b);
  }
}
END_TEST

UNIT_MAIN("work", factor_has_the_size_that_was_foreseen)
