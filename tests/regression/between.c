/*
 * Tables at a time within an increment, of every effect with a state of its
 * own: those of an increment that ends there; the run goes on as without them.
 */
#include "support/block_file.h"
#include "support/job.h"
#include "support/unit.h"

const int job_without_fields = 1;

#define SOLID "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
#define BLOCK "*MESH, FILE=block.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
#define FLOOR                            \
  "*OBSTACLE, NAME=O, TYPE=CONFORMING\n" \
  "*CONTACT, NAME=C, GROUP=CONTACT, OBSTACLE=O\n*FRICTION, CONTACT=C, LAW="
#define PUSHED                                                   \
  "*STEP\n*QUASISTATIC\n%s, 1.\n*SOLVER, TOL=1E-13\n*BOUNDARY\n" \
  "SYMMETRY, 1, 1, \"-0.02*sin(3*t)\"\n*DSLOAD\nTOP, P, \"2+x-t\"\n"

static const char *const decks[] = {
    BLOCK SOLID FLOOR "COULOMB\n\"0.3+0.2*t\"\n" PUSHED,
    BLOCK SOLID FLOOR "TRESCA\n\"0.3+0.2*t\"\n" PUSHED,
    BLOCK SOLID FLOOR "NONLOCAL, RADIUS=2.\n\"0.3+0.2*t\"\n" PUSHED,
    BLOCK SOLID FLOOR
    "COULOMB\n0.3\n*CONTACT FORCE, CONTACT=C\n\"2+x+t\"\n" PUSHED
    "TOP, TY, 0.\n*BOUNDARY\nTOP, 2\n",
    BLOCK SOLID FLOOR
    "COULOMB\n\"0.3+0.2*t\"\n"
    "*GOAL, NAME=F, QUANTITY=FORCE, CONTACT=C, COMPONENT=1\n"
    "*GOAL, NAME=W, QUANTITY=FRICTION WORK\n" PUSHED,
    "*PARAMETER\nN = 10\nANGLE = 30.\n*MESH, FILE=crack.geo\n*MATERIAL, "
    "NAME=M\n*ELASTIC\n1000., 0.3\n"
    "*SOLID SECTION, ELSET=PLATE, MATERIAL=M\n*CRACK, NAME=C, GROUP=LINE\n"
    "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n*STEP\n*QUASISTATIC\n%s, 1.\n"
    "*SOLVER, TOL=1E-13\n*BOUNDARY\nPIN, 1, 2\nEND, 2\n*DSLOAD\n"
    "TOP, P, \"sin(3*t)\"\nBOTTOM, P, \"sin(3*t)\"\n"};

/* In increments of the length "dt"; between: tables at times of their own, but
 * of the energies. */
static job run(const char *deck, const char *dt, int between) {
  job j = job_begin("block");
  PRINTED(text, deck, dt);
  block_file_write(&j, (int[]){8, 4}, (double[]){8.0, 4.0}, 0);
  job_copy(&j, "input/crack/crack.geo");
  job_write(&j, "block.inp",
            "*TIME POINTS, NAME=T\n0.1, 0.6\n%s"
            "*ACCURACY, MESH=NO\n*PRINT, ENERGY\n*PRINT, CONTACT, "
            "TOTALS%s%s\n*END STEP\n",
            text,
            strstr(deck, "GOAL") != NULL    ? ", GOALS"
            : strstr(deck, "CRACK") != NULL ? ", SIF"
                                            : "",
            between ? ", TIME POINTS=T" : "");
  CK_EXIT(job_run(&j, ""), 0, j);
  return j;
}

static void compare(const job *a, const job *b, const char *table, int block) {
  DAT x = job_table(a, table, block), y = job_table(b, table, block);
  ck_assert(x.n_row == y.n_row && x.n_col == y.n_col);
  for (int c = 0; c < x.n_col; ++c) {
    if (strstr(x.name[c], "defect") != NULL ||
        strstr(x.name[c], "solver") != NULL)
      continue;
    const double most = dat_max(&x, x.name[c]);
    for (int i = 0; i < x.n_row; ++i) {
      const double is = dat_at(&x, i, x.name[c]),
                   was = dat_at(&y, i, x.name[c]);
      ck_assert_msg(isnan(is) || fabs(was - is) <= 1e-7 * most,
                    "%s %d, row %d: %s %.12g, without %.12g", table, block, i,
                    x.name[c], is, was);
    }
  }
}

TESTS(tables_within_an_increment, sizeof decks / sizeof *decks) {
  static const char *const tables[] = {"CONTACT", "TOTALS", "GOALS", "SIF"};
  JOB a = run(decks[_i], "0.25", 1), b = run(decks[_i], "0.25", 0);
  JOB first = run(decks[_i], "0.1", 0);
  for (int block = 0; block < 4; ++block) compare(&a, &b, "ENERGY", block);
  for (int k = 0; k < 4; ++k)
    if (k < 2 || strstr(decks[_i], k == 2 ? "GOAL" : "CRACK") != NULL)
      compare(&a, &first, tables[k], 0);
}

UNIT_MAIN_FOR("between", 10 * UNIT_SECONDS)
