/*
 * src/effects/plan: what a row has cost; entries and operations of the factor
 * expected from the number of unknowns besides those that CHOLMOD counts for
 * blocks in the plane and in space, the contact last.
 */
#include "effects/plan/plan.h"
#include "fem/fem.h"
#include "support/pressed_block.h"
#include "support/text_model.h"
#include "support/unit.h"

/* Segments on the floor of a square; elements along the edges of a cube. */
static const struct {
  int dim, nodes, layers, is_large;
} blocks[] = {{2, 17, 16, 0},  {2, 65, 64, 0}, {2, 257, 256, 1},
              {2, 257, 64, 0}, {3, 81, 8, 0},  {3, 169, 12, 0},
              {3, 361, 18, 1}, {3, 625, 12, 1}};

TEST(factor_has_the_size_that_was_expected) {
  for (size_t k = 0; k < sizeof blocks / sizeof *blocks; ++k) {
    if (blocks[k].is_large && !unit_whole()) continue;
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

static void request(stage s, size_t n) {
  timer_enter(s);
  memory_free(memory_new(n, 1));
  timer_leave(s);
}

/* Two stages of a row, the first entered twice. */
TEST(cost_of_a_row_is_that_of_its_stages) {
  const plan_row row = {.n_stage = 2, .stages = {STAGE_LOAD, STAGE_BODY}};
  timer_reset();
  request(STAGE_LOAD, 3000);
  request(STAGE_BODY, 500);
  request(STAGE_LOAD, 1000);
  request(STAGE_FACTOR, 10000);
  const stage_cost one = timer_cost(STAGE_LOAD), two = timer_cost(STAGE_BODY);
  const stage_cost c = plan_cost(&row);
  ck_assert_int_eq(c.calls, 2);
  ck_assert_uint_eq(c.bytes, 4500);
  ck_assert_double_eq(c.cpu, one.cpu + two.cpu);
}

#define CARDS                                                         \
  "*MESH, FILE=none.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"   \
  "*DENSITY\n2.5\n*EXPANSION\n1E-5\n*INELASTIC, LAW=MAXWELL\n2.\n"    \
  "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"                          \
  "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nBODY, 20.\n"                \
  "*OBSTACLE, NAME=O, TYPE=CONFORMING\n"                              \
  "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"                      \
  "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n"                          \
  "*STEP\n*VISCO, INTEGRATOR=BACKWARD\n0.5, 10.\n*BOUNDARY\nTOP, 1, " \
  "2\n*TEMPERATURE\n"                                                 \
  "BODY, 30.\n*DSLOAD\nRIGHT, P, 1.\n*ACCURACY, MESH=YES, TIME=YES\n" \
  "*PRINT, CONTACT, NODES, ELEMENTS, REACTIONS, TOTALS, ENERGY\n*END STEP\n"

/* Sixteen times the elements: of each row more operations, of one that works
 * on all nodes or elements in proportion, but for files. */
TEST(work_grows_with_the_mesh) {
  enum { FINE = 4 };
  text_model s[2];
  effect_plan *p[2];
  for (int k = 0; k < 2; ++k) {
    const int n = k == 0 ? 8 : FINE * 8;
    s[k] = text_model_read(CARDS,
                           make_grid_2d((int[]){n, n}, (double[]){1.0, 1.0}));
    ck_assert_int_eq(s[k].st, OK);
    ck_assert_int_eq(plan_new(s[k].m, s[k].msh, 0, &p[k]), OK);
  }
  ck_assert_int_eq(p[0]->n, p[1]->n);
  for (int i = 0; i < p[0]->n; ++i) {
    const plan_row *a = &p[0]->rows[i], *b = &p[1]->rows[i];
    const double more = a->work.items > 0.0 ? b->work.items / a->work.items : 1;
    ck_assert_int_eq(a->on, b->on);
    ck_assert_msg(a->work.operations >= 0.0 && isfinite(b->work.operations),
                  "%s: %g", a->name, a->work.operations);
    ck_assert_msg(b->work.operations >= a->work.operations, "%s: %g, %g",
                  a->name, a->work.operations, b->work.operations);
    if (more > FINE * FINE / 2.0 && a->work.calls >= 0.0)
      ck_assert_msg(b->work.operations > 0.5 * more * a->work.operations,
                    "%s: %g times", a->name,
                    b->work.operations / a->work.operations);
  }
  for (int k = 0; k < 2; ++k) {
    memory_free(p[k]);
    text_model_close(&s[k]);
  }
}

UNIT_MAIN("work")
