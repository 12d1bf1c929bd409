/*
 * Observed orders of the integrators of inelastic strains, a table by laws: a
 * block that creeps under pressure on a floor it slides on (creep_case.h), from
 * three increments that are halved. EXPONENTIAL is for constant linear laws.
 */
#include "support/creep_case.h"
#include "support/unit.h"

#include <math.h>
#include <stdio.h>

static const struct {
  const char *name, *card;
  int linear;
} laws[] = {{"MAXWELL", "*INELASTIC, LAW=MAXWELL, TYPE=DEVIATORIC\n2.\n", 1},
            {"ZENER", "*INELASTIC, LAW=ZENER\n1000., 2000.\n", 1},
            {"BURGERS", "*INELASTIC, LAW=BURGERS\n4000., 2000., 4000.\n", 1},
            {"PRONY", "*INELASTIC, LAW=PRONY\n0.5, 0.1, 2.\n0.2, 0., 5.\n", 1},
            {"NORTON", "*INELASTIC, LAW=NORTON\n2.E-6, 3.\n", 0}};
enum { N_LAW = sizeof laws / sizeof *laws };

static const struct {
  const char *integrator;
  int order, linear_only;
} rows[] = {{"EULER", 1, 0},      {"HEUN", 2, 0},
            {"RK4", 4, 0},        {"THETA, THETA=0.75", 1, 0},
            {"MIDPOINT", 2, 0},   {"BACKWARD", 1, 0},
            {"EXPONENTIAL", 2, 1}};
enum { N_ROW = sizeof rows / sizeof *rows };

START_TEST(orders) {
  int wrong = 0;
  printf("%-18s", "order of");
  for (int k = 0; k < N_LAW; ++k) printf(" %9s", laws[k].name);
  printf("  expected\n");
  for (int i = 0; i < N_ROW; ++i) {
    /* Order 1 takes longer to show. */
    const int n = rows[i].order == 1 ? 32 : 8;
    printf("%-18s", rows[i].integrator);
    for (int k = 0; k < N_LAW; ++k) {
      if (rows[i].linear_only && !laws[k].linear) {
        printf(" %9s", "-");
        continue;
      }
      double order = creep_case_order(laws[k].card, rows[i].integrator, n);
      printf(" %9.3f", order);
      wrong += !(fabs(order - rows[i].order) <= 0.1);
    }
    printf("  %8d\n", rows[i].order);
    fflush(stdout);
  }
  ck_assert_msg(wrong == 0, "%d orders are not within 0.1", wrong);
}
END_TEST

UNIT_MAIN("integrators", orders)
