/*
 * *GOAL under prescribed displacements, and next to ends of supports, against
 * limits of six meshes, each with four times the elements of the one before.
 */
#include "scenes/mesh.h"
#include "support/job.h"
#include "support/unit.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define PLANE "PLANE\n0., 0.\n0., 1."
#define ENERGY "*GOAL, NAME=E, QUANTITY=ENERGY\n"
#define NORMAL "*GOAL, NAME=N, QUANTITY=FORCE, CONTACT=C\n"
#define PRESSED "*STEP\n*STATIC\n*BOUNDARY\nTOP, 1\nTOP, 2, 2, -0.01\n"
#define CLAMPED "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1, 2\n*DSLOAD\nTOP, P, 10.\n"

/* A body of these words (scenes/mesh.h) with contact cards. */
static job of_body(const char *words, const char *cards) {
  const mesh_change change = {.scale = 1.0};
  char path[200];
  int *number = NULL;
  job j = job_begin("block");
  snprintf(path, sizeof path, "%s/block.msh", j.dir);
  FILE *f = fopen(path, "w");
  ck_assert_ptr_nonnull(f);
  ck_assert(scene_mesh_write(f, words, &change, &number));
  fclose(f);
  free(number);
  job_write(&j, "block.inp",
            "*MESH, FILE=block.msh\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=%s*PRINT, GOALS\n*END STEP\n",
            cards);
  const int code = job_run(&j, "");
  ck_assert_msg(code == 0, "exit %d: %s", code, j.errors);
  return j;
}

#define CONTACT "\n*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"

/* A block of 2 x 1 with n x n squares on an obstacle. */
static job of_block(int n, const char *on, const char *cards) {
  char words[40], all[800];
  snprintf(words, sizeof words, "rect %d %d 2 1 alternate", n, n);
  snprintf(all, sizeof all, "%s" CONTACT "%s", on, cards);
  return of_body(words, all);
}

/* The first goal: its estimate is from "least" to "most" of its error, which is
 * in the band, and the band at most "wide" of the error. */
static void check(const job *j, double exact, double least, double most,
                  double wide) {
  dat t = job_table(j, "GOALS", -1);
  const double is = exact - dat_at(&t, 0, "value");
  const double told = dat_at(&t, 0, "error"), band = dat_at(&t, 0, "band");
  ck_assert_msg(told / is > least && told / is < most,
                "error %g, estimate %g of it", is, told / is);
  ck_assert_msg(fabs(is - told) <= band && band <= wide * fabs(is),
                "error %g, estimate %g, band %g", is, told, band);
  dat_free(&t);
}

static int has_verdict(const job *j, const char *goal, const char *word) {
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

/* By supports alone the energy of a mesh is too large, by loads too small; by
 * both, and along supports that bend, by a part of each. */
START_TEST(energies_by_loads_and_by_supports) {
  static const struct {
    const char *on, *step;
    double exact, wide;
  } rows[] = {
      {PLANE, PRESSED, 0.11559331, 4.0},
      {PLANE, CLAMPED, 0.079099874, 2.0},
      {PLANE,
       "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1\nRIGHT, 1\n"
       "TOP, 2, 2, \"-0.01*(1+0.5*cos(pi*x/2))\"\n",
       0.14957821, 3.0},
      {PLANE,
       "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1\nTOP, 2, 2, -0.005\n"
       "RIGHT, 1, 1, 0.002\n*DLOAD\nBODY, BX, \"40*sin(2*x)\"\n",
       0.19257777, 1.0},
      {"GAP\n\"0.01*x^2\"",
       "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1\nRIGHT, 1\nTOP, 2, 2, -0.005\n",
       0.0065382663, 3.0}};
  for (int k = 0; k < 5; ++k) {
    char cards[400];
    snprintf(cards, sizeof cards, ENERGY "%s", rows[k].step);
    job j = of_block(16, rows[k].on, cards);
    check(&j, rows[k].exact, 0.6, 1.3, rows[k].wide);
    job_end(&j);
  }
}
END_TEST

/* Next to the corners of a clamp stresses are infinite, and at the edge of a
 * roller in a straight side; not where it has all of the side. */
START_TEST(ends_of_supports_are_not_reliable) {
  job j = of_block(8, PLANE, NORMAL ENERGY PRESSED);
  ck_assert(has_verdict(&j, "N", "support_end"));
  ck_assert(has_verdict(&j, "E", "support_end"));
  check(&j, 23.118663, 0.3, 1.0, 3.0);
  job_end(&j);
  j = of_block(
      8, PLANE,
      "*GOAL, NAME=U, QUANTITY=DISPLACEMENT, COMPONENT=1\n2., 1.\n" CLAMPED);
  ck_assert(has_verdict(&j, "U", "support_end"));
  check(&j, 0.0070721533, 0.3, 1.0, 3.0);
  job_end(&j);
  j = of_block(16, PLANE,
               ENERGY
               "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1\n*DSLOAD\n"
               "TOP, P, \"10*(1+cos(pi*x/2))\"\n");
  ck_assert(has_verdict(&j, "E", "reliable"));
  check(&j, 0.13444394, 0.8, 1.2, 0.5);
  job_end(&j);
}
END_TEST

/* The same along the edges of a cube. */
START_TEST(ends_of_supports_in_space) {
  static const char on[] = "PLANE\n0., 0., 0.\n0., 0., 1." CONTACT NORMAL;
  static const char *const hold[] = {"TOP, 1, 2\n", "LEFT, 1\nFRONT, 2\n"};
  for (int k = 0; k < 2; ++k) {
    char cards[400];
    snprintf(cards, sizeof cards,
             "%s*STEP\n*STATIC\n*BOUNDARY\nTOP, 3, 3, -0.01\n%s", on, hold[k]);
    job j = of_body("box 4 4 4 1 1 1", cards);
    ck_assert(has_verdict(&j, "N", k == 0 ? "support_end" : "reliable"));
    if (k == 0) check(&j, 10.3045, 0.3, 1.0, 3.0);
    job_end(&j);
  }
}
END_TEST

/* All of the base slips, at 0.5 whatever the pressure: the force is 1. A node
 * that a support holds has a part of it, which along the normal is lost. */
START_TEST(nodes_of_supports_have_a_part_of_the_force) {
  static const char *const hold[] = {
      "LEFT, 2, 2, -0.002\n", "LEFT, 1, 1, 0.05\n", "CORNER, 1, 1, 0.05\n", ""};
  for (int k = 0; k < 4; ++k) {
    char cards[500];
    snprintf(cards, sizeof cards,
             "*FRICTION, CONTACT=C, LAW=TRESCA\n0.5\n"
             "*GOAL, NAME=T, QUANTITY=FORCE, CONTACT=C, COMPONENT=TANGENT\n"
             "*STEP\n*QUASISTATIC\n1., 1.\n*BOUNDARY\nTOP, 1, 1, 0.05\n"
             "TOP, 2, 2, -0.01\n%s",
             hold[k]);
    job j = of_block(8, "GAP\n\"-0.005\"", cards);
    dat t = job_table(&j, "GOALS", -1);
    const double off = -1.0 - dat_at(&t, 0, "corrected");
    const double band = dat_at(&t, 0, "band");
    ck_assert_msg(fabs(off) <= band, "row %d: %g off, band %g", k, off, band);
    ck_assert_int_eq(has_verdict(&j, "T", "reliable"), k > 0);
    ck_assert(k == 0 ? band > 0.01 : band < 1e-12 && band > 1e-14);
    dat_free(&t);
    job_end(&j);
  }
}
END_TEST

/* Where a coarse mesh sticks, and a sum whose terms cancel. */
START_TEST(zeros_are_not_exact) {
  job j = of_block(8, PLANE,
                   "*FRICTION, CONTACT=C, LAW=COULOMB\n5.\n"
                   "*GOAL, NAME=W, QUANTITY=FRICTION WORK\n"
                   "*STEP\n*QUASISTATIC\n1., 1.\n*BOUNDARY\nLEFT, 1\n"
                   "*DSLOAD\nTOP, P, 10.\n");
  ck_assert(has_verdict(&j, "W", "no_slip"));
  job_end(&j);
  j = of_block(
      8, PLANE,
      "*GOAL, NAME=S, QUANTITY=STRESS, COMPONENT=XX, GROUP=BODY\n" CLAMPED);
  dat t = job_table(&j, "GOALS", -1);
  ck_assert_double_le(fabs(dat_at(&t, 0, "corrected")), dat_at(&t, 0, "band"));
  dat_free(&t);
  job_end(&j);
}
END_TEST

UNIT_MAIN("goals_supports", nodes_of_supports_have_a_part_of_the_force,
          zeros_are_not_exact, energies_by_loads_and_by_supports,
          ends_of_supports_are_not_reliable, ends_of_supports_in_space)
