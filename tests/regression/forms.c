/*
 * The forms of one quasistatic problem (CPR98): increments in the displacement
 * (N2) and in its change (N3), and one static problem (P2). Where theory says
 * that they have one answer, they must give it.
 */
#include "solver/solver.h"
#include "support/job.h"
#include "support/unit.h"

#include <glob.h>

const int job_without_fields = 1;

enum { LINE = 512 };

/* Copy of a deck in the folder of the job: each *QUASISTATIC in the form asked
 * for, the displacements printed at the end of each step. The number of those.
 */
static int write_in_form(const job *j, const char *path, const char *form) {
  char line[LINE];
  int steps = 0;
  PRINTED(copy, "%s/%s.inp", j->dir, j->name);
  FILE *from = fopen(path, "r"), *to = fopen(copy, "w");
  ck_assert_ptr_nonnull(from);
  ck_assert_ptr_nonnull(to);
  while (fgets(line, sizeof line, from) != NULL) {
    if (strncmp(line, "*OUTPUT", 7) == 0) continue;
    int here = strncmp(line, "*QUASISTATIC", 12) == 0;
    steps += here;
    if (strncmp(line, "*END STEP", 9) == 0)
      fputs("*PRINT, NODES, FREQUENCY=0\n*OUTPUT, HDF5=NO\n", to);
    if (here)
      fprintf(to, "*QUASISTATIC, FORM=%s\n", form);
    else
      fputs(line, to);
  }
  fclose(from);
  ck_assert_int_eq(fclose(to), 0);
  return steps;
}

/* The displacements printed by two runs, over their largest. */
static void compare_nodes(const job *a, const job *b, int n, double tol) {
  static const char *const names[] = {"u_x", "u_y", "u_z", "u_r"};
  for (int k = 0; k < n; ++k) {
    DAT p = job_table(a, "NODES", k), q = job_table(b, "NODES", k);
    double scale = 0.0;
    for (int c = 0; c < 4; ++c)
      if (dat_has(&p, names[c])) scale = fmax(scale, dat_max(&p, names[c]));
    ck_assert_double_gt(scale, 0.0);
    ck_assert_int_eq(p.n_row, q.n_row);
    ck_assert_int_eq(p.n_col, q.n_col);
    for (int c = 0; c < 4; ++c)
      for (int i = 0; i < p.n_row && dat_has(&p, names[c]); ++i) {
        double miss = dat_at(&p, i, names[c]) - dat_at(&q, i, names[c]);
        ck_assert_msg(fabs(miss) <= tol * scale,
                      "%s, block %d, row %d: %s differs by %.3g of the largest",
                      a->name, k, i, names[c], miss / scale);
      }
  }
}

/* Blocks of the displacements in JOB.dat. */
static int count_blocks(const job *j) {
  int n = 0;
  char *text = job_file(j, "dat"), *at = text;
  ck_assert_ptr_nonnull(text);
  while ((at = strstr(at, " table NODES")) != NULL) {
    ++n;
    ++at;
  }
  free(text);
  return n;
}

/* One deck in a folder with its mesh. */
static job run_in_form(const char *path, const char *form, int *steps) {
  const char *name = strrchr(path, '/') + 1;
  char words[LINE];
  job j = job_begin("");
  snprintf(j.name, sizeof j.name, "%.*s", (int)(strlen(name) - 4), name);
  job_copy_meshes(&j, path);
  *steps = write_in_form(&j, path, form);
  if (*steps == 0) return j;
  job_coarsen(path, words, sizeof words);
  int code = job_run(&j, words);
  ck_assert_msg(code == 0, "%s, %s: exit %d: %s", path, form, code, j.errors);
  return j;
}

/* Also those that come later: every deck of input/ with a quasistatic step. */
TEST(both_forms_agree_on_every_example) {
  glob_t decks;
  int compared = 0;
  ck_assert_int_eq(glob("input/*/*.inp", 0, NULL, &decks), 0);
  for (size_t i = 0; i < decks.gl_pathc; ++i) {
    int steps = 0;
    JOB a = run_in_form(decks.gl_pathv[i], "DISPLACEMENT", &steps);
    if (steps > 0) {
      JOB b = run_in_form(decks.gl_pathv[i], "VELOCITY", &steps);
      ck_assert_int_eq(job_stage(&a, "velocity form", NULL), 0);
      ck_assert_int_gt(job_stage(&b, "velocity form", NULL), 0);
      compare_nodes(&a, &b, count_blocks(&a), 1e-8);
      ++compared;
    }
  }
  globfree(&decks);
  ck_assert_int_ge(compared, 5);
}

/* Unit square pushed from the side, held on the right; the obstacle moves. */
static job run_square(const char *solver, const char *procedure,
                      const char *move, const char *loads) {
  job j = job_with("square", "tests/regression/mesh/square.geo",
                   "*PARAMETER\nN = 6\n*MESH, FILE=square.geo\n"
                   "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.2\n"
                   "*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
                   "*OBSTACLE, NAME=O, TYPE=PLANE\n0., 0.\n0., 1.\n%s"
                   "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
                   "*FRICTION, CONTACT=C, LAW=COULOMB\n0.6\n"
                   "*STEP\n%s*BOUNDARY\nRIGHT, 1, 2\n%s*SOLVER, METHOD=%s\n"
                   "*PRINT, NODES\n*END STEP\n",
                   move, procedure, loads, solver);
  int code = job_run(&j, "");
  ck_assert_msg(code == 0, "%s: exit %d: %s", solver, code, j.errors);
  return j;
}

/* Push, then let go half of it: part of the slip stays. Every method. */
TEST(both_forms_agree_with_every_method) {
  static const char loads[] =
      "*DSLOAD\nTOP, P, \"5*min(1, 2*t)\"\nLEFT, P, \"15*(1-abs(2*t-1))\"\n";
  static const char move[] = "MOVE, \"2e-3*t^2\", \"1e-3*t\"\n";
  for (int k = 0; solver_list[k] != NULL; ++k) {
    const char *name = solver_list[k]->name;
    JOB a = run_square(name, "*QUASISTATIC\n0.25, 1.\n", move, loads);
    JOB b = run_square(name, "*QUASISTATIC, FORM=VELOCITY\n0.25, 1.\n", move,
                       loads);
    compare_nodes(&a, &b, 4, 1e-8);
  }
}

/* Starts that are not the last equilibrium: in the air the answer without
 * contact, then a touch at the end of an increment; the line through the last
 * two states. The slip counts from the equilibrium all the same. */
TEST(both_forms_agree_from_other_starts) {
  static const struct {
    const char *solver, *move, *loads;
  } row[] = {
      {"AUTO", "MOVE, 0., \"0.02*(t-0.5)\"\n",
       "*DSLOAD\nTOP, TX, \"5*t\"\nTOP, P, \"5*max(0, t-0.5)\"\n"},
      {"AUTO", "", "RIGHT, 1, 1, -0.2\nRIGHT, 2, 2, \"max(0, 1-2*t)\"\n"},
      {"AUTO, TOL=BALANCED\n*ACCURACY, MESH=YES, TIME=YES", "",
       "RIGHT, 1, 1, -0.02\nRIGHT, 2, 2, \"-0.02*min(1, 3*t)\"\n"}};
  for (size_t k = 0; k < sizeof row / sizeof *row; ++k) {
    JOB a = run_square(row[k].solver, "*QUASISTATIC\n0.125, 1.\n", row[k].move,
                       row[k].loads);
    JOB b =
        run_square(row[k].solver, "*QUASISTATIC, FORM=VELOCITY\n0.125, 1.\n",
                   row[k].move, row[k].loads);
    compare_nodes(&a, &b, 8, 1e-8);
  }
}

/* The lower of two blocks is let go in the second step: its nodes at the wall
 * join those of the upper one. */
static job run_wall(const char *form) {
  job j =
      job_with("wall", "tests/regression/mesh/pair.geo",
               "*PARAMETER\nN = 8\nM = 2\n*MESH, FILE=pair.geo\n"
               "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.2\n"
               "*SOLID SECTION, ELSET=LOWER, MATERIAL=M\n"
               "*SOLID SECTION, ELSET=UPPER, MATERIAL=M\n"
               "*OBSTACLE, NAME=W, TYPE=CONFORMING\n"
               "*CONTACT, NAME=C, GROUP=LEFT, OBSTACLE=W\n"
               "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n"
               "*STEP\n*QUASISTATIC, FORM=%s\n0.5, 1.\n*BOUNDARY\nLOWER, 1, 2\n"
               "TOP, 2\n*DSLOAD\nRIGHT, P, 5.\nRIGHT, TY, 1.\n*PRINT, NODES\n"
               "*END STEP\n*STEP\n*QUASISTATIC, FORM=%s\n0.5, 1.\n"
               "*BOUNDARY, OP=NEW\nBOTTOM, 2\nTOP, 2\n*DSLOAD\nRIGHT, TY, 2.\n"
               "*END STEP\n",
               form, form);
  int code = job_run(&j, "");
  ck_assert_msg(code == 0, "%s: exit %d: %s", form, code, j.errors);
  return j;
}

TEST(both_forms_agree_when_contact_nodes_join) {
  JOB a = run_wall("DISPLACEMENT"), b = run_wall("VELOCITY");
  compare_nodes(&a, &b, 4, 1e-8);
}

/* A load that grows in proportion: one static problem, or increments. */
TEST(proportional_load_needs_no_path) {
  static const char loads[] = "*DSLOAD\nTOP, P, 5.\nLEFT, P, 15.\n";
  static const char *const procedures[] = {
      "*QUASISTATIC\n0.1, 1.\n", "*QUASISTATIC, FORM=VELOCITY\n0.1, 1.\n"};
  JOB one = run_square("AUTO", "*STATIC\n", "", loads);
  DAT p = job_table(&one, "NODES", -1);
  double scale = dat_max(&p, "u_x");
  for (int k = 0; k < 2; ++k) {
    JOB j = run_square("AUTO", procedures[k], "", loads);
    DAT q = job_table(&j, "NODES", -1);
    for (int i = 0; i < p.n_row; ++i) {
      ck_assert_double_eq_tol(dat_at(&p, i, "u_x"), dat_at(&q, i, "u_x"),
                              1e-8 * scale);
      ck_assert_double_eq_tol(dat_at(&p, i, "u_y"), dat_at(&q, i, "u_y"),
                              1e-8 * scale);
    }
  }
}

UNIT_MAIN("forms")
