/*
 * The decks of the unit square and their runs.
 */
#include "support/square_case.h"

#include "support/unit.h"

job square_run(const square_case *s, int expected) {
  const int contact = strstr(s->model, "*CONTACT") != NULL;
  job j = job_with(
      "square", "tests/regression/mesh/square.geo",
      "*PARAMETER\nN = 2\n*MESH, FILE=square.geo\n*MATERIAL, NAME=M\n"
      "*ELASTIC\n%s\n%s*SOLID SECTION, ELSET=BODY, MATERIAL=M, TYPE=%s\n"
      "%s*STEP\n*STATIC\n%s*PRINT, ELEMENTS, ENERGY, NODES%s\n"
      "*END STEP\n*STEP\n%s*END STEP\n",
      s->elastic, s->law, s->section, s->model, s->load,
      contact ? ", CONTACT" : "", s->visco);
  CK_EXIT(job_run(&j, "--no-timing"), expected, j);
  return j;
}

void square_all_have(const job *j, int k, const char *column, double expected,
                     double tolerance) {
  dat d = job_table(j, "ELEMENTS", k);
  for (int i = 0; i < d.n_row; ++i) {
    double found = dat_at(&d, i, column);
    ck_assert_msg(fabs(found - expected) <= tolerance,
                  "%s of table %d: %.12g, expected %.12g to %g", column, k,
                  found, expected, tolerance);
  }
  dat_free(&d);
}

double square_energy(const job *j, int k, const char *column) {
  dat d = job_table(j, "ENERGY", k);
  double value = dat_at(&d, 0, column);
  dat_free(&d);
  return value;
}
