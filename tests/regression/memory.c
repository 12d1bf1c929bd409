/*
 * Memory is expected: a run that would need more than there is ends at once
 * with exit code 5 and says what to do; what is expected is what a run takes.
 */
#include "support/job.h"
#include "support/unit.h"

#include <sys/resource.h>

static void must_be_refused(const job *j, int code, const char *whose) {
  ck_assert_msg(code == 5, "exit %d: %s", code, j->errors);
  ck_assert_ptr_nonnull(strstr(j->errors, "MB of memory, and "));
  ck_assert_ptr_nonnull(strstr(j->errors, whose));
  ck_assert_ptr_nonnull(strstr(j->errors, "--max-memory MB"));
}

TEST(limit_by_hand_is_obeyed) {
  static const char deck[] = "input/block_shear_3d/block_shear_3d";
  JOB j = job_begin("block_shear_3d");
  must_be_refused(&j, job_run_deck(&j, deck, "-D N=16 --max-memory 10"),
                  "--max-memory leaves ");
  ck_assert_int_eq(job_run_deck(&j, deck, "--max-memory 1"), 5);
  ck_assert_ptr_nonnull(strstr(
      j.errors, "protis: the memory that --max-memory leaves is too little"));
  ck_assert_ptr_nonnull(strstr(j.errors, "\nprotis: in "));
  ck_assert_int_eq(job_run_deck(&j, deck, "-D N=16 --max-memory 10 --check"),
                   0);
  ck_assert_ptr_nonnull(strstr(j.text, "the run would be refused"));
  ck_assert_int_eq(job_run_deck(&j, deck, "-D N=4 --max-memory 400"), 0);
}

/* The limit of the process, unless a greater one is set by hand: a .msh, so
 * that no library has to fit in. */
TEST(limit_of_the_process_is_seen) {
  struct rlimit old, less;
  job j = job_begin("job");
  job_write(&j, "job.txt", "9000\n");
  job_write(&j, "job.inp",
            "*CONDENSED PROBLEM, FILE=job.txt\n*STEP\n*STATIC\n*END STEP\n");
  PRINTED(command, "truncate -s 200M '%s/job.txt'", j.dir);
  ck_assert_int_eq(system(command), 0);
  ck_assert_int_eq(getrlimit(RLIMIT_AS, &old), 0);
  less = old;
  less.rlim_cur = (rlim_t)2000 << 20;
  ck_assert_int_eq(setrlimit(RLIMIT_AS, &less), 0);
  int code = job_run(&j, ""), other = job_run(&j, "--max-memory 1E5");
  setrlimit(RLIMIT_AS, &old);
  ck_assert_msg(other != 0 && code == 5, "exits %d and %d", code, other);
  must_be_refused(&j, job_run(&j, "--max-memory 2000"), "--max-memory leaves");
  job_end(&j);
}

/* Sum of the numbers of the line "memory" of --check, bytes. */
static double expected(const job *j) {
  double factor, contact, rest;
  const char *line = strstr(j->text, "\nmemory ");
  ck_assert_ptr_nonnull(line);
  ck_assert_int_eq(sscanf(line,
                          "\nmemory about %lf MB for the factor, %lf MB for "
                          "the contact, %lf MB for the rest",
                          &factor, &contact, &rest),
                   3);
  return 1e6 * (factor + contact + rest);
}

TEST(runs_take_what_is_expected) {
  static const char *const rows[][3] = {
      {"greco/greco", "greco", "-D N=64"},
      {"block_shear_3d/block_shear_3d", "block_shear_3d", "-D N=8"},
      {"torsion_sphere_3d/torsion_sphere_3d", "torsion_sphere_3d", "-D NC=4"},
      {"creep_block/creep_block", "creep_block", "-D N=64"},
      {"lee_radok/lee_radok", "lee_radok", "-D NC=20"}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
    JOB j = job_begin(rows[i][1]);
    PRINTED(deck, "input/%s", rows[i][0]);
    PRINTED(words, "%s --check", rows[i][2]);
    ck_assert_int_eq(job_run_deck(&j, deck, words), 0);
    double most = expected(&j);
    ck_assert_int_eq(job_run_deck(&j, deck, rows[i][2]), 0);
    double taken = job_told(&j, "peak_bytes");
    ck_assert_msg(taken <= most && most <= 2.5 * taken,
                  "%s: expected %.3g, taken %.3g", deck, most, taken);
  }
}

/* Bytes that the run holds at most, in increments of 1/n. */
static double held(const char *material, const char *law, const char *card,
                   const char *second, int n) {
  JOB j = job_with(
      "held", "input/creep_block/creep_block.geo",
      "*PARAMETER\nN = 8\n*MESH, FILE=creep_block.geo\n"
      "*MATERIAL, NAME=M\n*ELASTIC\n130.D3, 0.2\n%s"
      "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
      "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0., 0.\n0., 1., 0.\n"
      "MOVE, \"2e-2*t\", \"1e-2*sin(t)\", 0.\n"
      "*CONTACT, NAME=C, GROUP=CONTACT, OBSTACLE=O\n"
      "*FRICTION, CONTACT=C, LAW=%s\n\"0.4 + 0.01*t\"\n%s"
      "*GOAL, NAME=E, QUANTITY=ENERGY\n"
      "*GOAL, NAME=N, QUANTITY=FORCE, CONTACT=C\n"
      "*GOAL, NAME=P, QUANTITY=PRESSURE, CONTACT=C\n"
      "*GOAL, NAME=W, QUANTITY=FRICTION WORK\n"
      "*STEP\n*QUASISTATIC\n%.17g, 1.\n*BOUNDARY\nSYMMETRY, 1\n*DSLOAD\n"
      "TOP, P, 50.\nLEFT, P, \"150*sin(2*t)\"\n"
      "*ACCURACY, MESH=YES, TIME=YES, THEORY=YES\n*PRINT, CONTACT, NODES, "
      "ELEMENTS, REACTIONS, TOTALS, ENERGY, ZONES, LOOP, GOALS\n*OUTPUT\n"
      "*END STEP\n*STEP\n%s\n%.17g, 1.\n*END STEP\n",
      material, law, card, 1.0 / n, second, 1.0 / n);
  CK_EXIT(job_run(&j, ""), 0, j);
  return job_told(&j, "peak_bytes");
}

/* But for the summary of each increment, which is smaller than two vectors. */
TEST(more_increments_hold_no_more) {
  static const char *const rows[][4] = {
      {"", "COULOMB", "", "*QUASISTATIC, FORM=VELOCITY"},
      {"*EXPANSION\n1.2E-5\n*INELASTIC, LAW=NORTON\n1E-10, 3.\n",
       "NONLOCAL, RADIUS=8., ZONE=CONTACT",
       "*WEAR, CONTACT=C, COEFFICIENT=1E-6\n",
       "*VISCO, INTEGRATOR=THETA, THETA=0.8"}};
  for (int k = 0; k < 2; ++k) {
    const char *const *row = rows[k];
    const double few = held(row[0], row[1], row[2], row[3], 4);
    const double more = held(row[0], row[1], row[2], row[3], 16);
    ck_assert_double_le(more - few, 24 * 1500);
  }
}

UNIT_MAIN("memory")
