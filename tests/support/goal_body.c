/* Decks with *GOAL (goal_body.h). */
#include "support/goal_body.h"

#include "support/unit.h"

void body_write_mesh(const job *j, const char *words,
                     const mesh_change *change) {
  char path[200];
  int *number = NULL;
  snprintf(path, sizeof path, "%s/block.msh", j->dir);
  FILE *f = fopen(path, "w");
  ck_assert_ptr_nonnull(f);
  ck_assert(scene_mesh_write(f, words, change, &number));
  fclose(f);
  free(number);
}

job body_of_type(const char *type, const char *words, const char *cards) {
  const mesh_change change = {.scale = 1.0};
  job j = job_begin("block");
  body_write_mesh(&j, words, &change);
  job_write(&j, "block.inp",
            "*MESH, FILE=block.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M%s\n"
            "*OBSTACLE, NAME=O, TYPE=%s*PRINT, GOALS\n*END STEP\n",
            type, cards);
  CK_EXIT(job_run(&j, ""), 0, j);
  return j;
}

job body_of(const char *words, const char *cards) {
  return body_of_type("", words, cards);
}

job body_of_block(int n, const char *on, const char *cards) {
  char words[40], all[800];
  snprintf(words, sizeof words, "rect %d %d 2 1 alternate", n, n);
  snprintf(all, sizeof all, "%s" CONTACT "%s", on, cards);
  return body_of(words, all);
}

void goal_check_row(const job *j, int row, double exact, double least,
                    double most, double wide) {
  dat t = job_table(j, "GOALS", -1);
  const double is = exact - dat_at(&t, row, "value");
  const double told = dat_at(&t, row, "error"), band = dat_at(&t, row, "band");
  ck_assert_msg(told / is > least && told / is < most,
                "error %g, estimate %g of it", is, told / is);
  ck_assert_msg(fabs(is - told) <= band && band <= wide * fabs(is),
                "error %g, estimate %g, band %g", is, told, band);
  dat_free(&t);
}

void goal_check(const job *j, double exact, double least, double most,
                double wide) {
  goal_check_row(j, 0, exact, least, most, wide);
}

int goal_has_verdict(const job *j, const char *goal, const char *word) {
  char wanted[80], *json = job_file(j, "json");
  snprintf(wanted, sizeof wanted, "\"goal\": \"%s\"", goal);
  char *at = strstr(json, wanted);
  ck_assert_msg(at != NULL, "no %s", wanted);
  *strchr(at, '}') = '\0';
  snprintf(wanted, sizeof wanted, "\"verdict\": \"%s\"", word);
  const int has = strstr(at, wanted) != NULL;
  free(json);
  return has;
}
