/*
 * A run that is interrupted or killed and then gone on with, against the run
 * that was not: all files equal, byte by byte. The points of interruption are
 * counted in increments or writes (the run is traced), so that nothing depends
 * on time.
 */
#include "support/folder.h"
#include "support/small_job.h"
#include "support/traced.h"
#include "support/unit.h"

#include <hdf5.h>
#include <signal.h>
#include <sys/stat.h>

static const char *const nothing[] = {NULL, NULL};

/* The job is given the signal at that change of a file (0: never); *changes or
 * NULL. Exit code. */
static int run_until(job *j, const char *const *words, int at, int signal_no,
                     int *changes) {
  traced t = {.action = TRACE_SIGNAL, .at = at, .number = signal_no};
  int code = traced_run(j, words, &t);
  *changes = t.changes;
  return code;
}

/* Interrupted when that line of JOB.sta is written, of which each attempt at an
 * increment has one. */
static void stop_at(job *j, int line) {
  enum { BEFORE = 4 }; /* removed twice, opened, its heading written */
  traced t = {.action = TRACE_SIGNAL,
              .at = BEFORE + line,
              .number = SIGINT,
              .of = ".sta"};
  CK_EXIT(traced_run(j, nothing, &t), 130, *j);
  FREED char *sta = job_file(j, "sta");
  for (const char *at = sta; (at = strchr(at, '\n')) != NULL; ++at) --line;
  ck_assert_int_eq(line, -1); /* it has a heading */
}

/* Not interrupted. */
static void run_whole(job *j) { CK_EXIT(traced_run(j, nothing, NULL), 0, *j); }

/* All files of the results are equal, byte by byte. */
static void same_files(const job *a, const job *b, const char *what) {
  const char *file = traced_difference(a, b);
  ck_assert_msg(file == NULL, "%s: .%s differs", what, file);
}

/* ---- tests -------------------------------------------------------------- */

/* To the same exit code. */
static void goes_on(job *j, int code, const char *what) {
  int is = job_run(j, "--restart --no-timing");
  ck_assert_msg(is == code, "%s: exit %d, not %d: %s", what, is, code,
                j->errors);
}

/* ---- refused ------------------------------------------------------------ */

static void refused(job *j, int code, const char *why) {
  int is = job_run(j, "--restart --no-timing");
  ck_assert_msg(is == code && strstr(j->errors, why) != NULL,
                "exit %d, not %d: %s; not: %s", is, code, j->errors, why);
}

/* The deck with one text in the place of another. */
static void edit(const job *j, const char *from, const char *to) {
  char *deck = job_file(j, "inp"), *at = strstr(deck, from), file[40];
  ck_assert_ptr_nonnull(at);
  *at = '\0';
  snprintf(file, sizeof file, "%s.inp", j->name);
  job_write(j, file, "%s%s%s", deck, to, at + strlen(from));
  free(deck);
}

/* So many degrees at each node, and more at the first. */
static void write_field(const job *j, const char *file, int degrees) {
  char text[8192];
  int n = 200, used = 0;
  for (int i = 1; i <= n; ++i)
    used += snprintf(text + used, sizeof text - (size_t)used, "%d %d\n", i,
                     degrees + (i == 1));
  job_write(j, file,
            "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$NodeData\n1\n\"T\"\n1\n"
            "0.0\n3\n0\n1\n%d\n%s$EndNodeData\n",
            n, text);
}

static int same_bytes(const job *a, const job *b, const char *suffix) {
  PRINTED(line, "cmp -s '%s/%s.%s' '%s/%s.%s'", a->dir, a->name, suffix, b->dir,
          b->name, suffix);
  return system(line) == 0;
}

/* A block whose run is stopped after so many increments. */
static job stopped_at(int line) {
  job j = small_flat(0.4, "", "AUTO");
  stop_at(&j, line);
  return j;
}

TEST(changed_decks_are_refused_by_card) {
  JOB j = stopped_at(2);
  edit(&j, "130.D3", "131.D3");
  refused(&j, 2, "changed: *ELASTIC, TYPE=ISO has other data; only");
  edit(&j, "131.D3", "130.D3");
  edit(&j, "TOP, 2, 2, -0.02", "TOP, 2, 2, -0.03");
  refused(&j, 2, "changed: step 1, *BOUNDARY, OP=MOD has other data; only");
  edit(&j, "TOP, 2, 2, -0.03", "TOP, 2, 2, -0.02");
  edit(&j, "*END STEP\n*STEP", "*END STEP\n*STEP\n*STATIC\n*END STEP\n*STEP");
  refused(
      &j, 2,
      "changed: step 2, *QUASISTATIC, FORM=DISPLACEMENT is now *STATIC; only");
  edit(&j, "*STATIC\n*END STEP\n*STEP\n", "");
  edit(&j, "N = 8", "N = 9");
  refused(&j, 2, "changed: *PARAMETER has other data; only");
  edit(&j, "N = 9", "N = 8");
  char *deck = job_file(&j, "inp"), file[40];
  snprintf(file, sizeof file, "%s.inp", j.name);
  job_write(&j, file, "%s*STEP\n*STATIC\n*END STEP\n", deck);
  refused(&j, 2, "the end of the deck is now *STEP; only");
  job_write(&j, file, "%s", deck);
  free(deck);
  ck_assert_int_eq(job_run(&j, "--restart"), 2); /* --no-timing is missing */
  ck_assert_ptr_nonnull(strstr(j.errors, "--no-timing"));
  edit(&j, "TOP, 1, 1, -0.01", "TOP, 1, 1, -0.015"); /* of a later step */
  goes_on(&j, 0, "later load");
}

/* But a change of a value, of a name or of what is an expression is one. */
TEST(numbers_may_be_spelled_otherwise) {
  static const struct {
    const char *from, *to;
    int same;
  } edits[] = {{"130.D3, 0.2\n", "1.3E+05, .20\n", 1},
               {"0.4\n*STEP", "\"0.4 + 0.*x\"\n*STEP", 0},
               {"CONFORMING", "CONFORMING, SIDE=OUTSIDE", 1},
               {"GROUP=CONTACT, OBSTACLE=O", "OBSTACLE=O,group = CONTACT", 1},
               {"TOP, 1, 1, 0.02", "TOP,1 ,1,2E-2", 1},
               {"-0.02", "0.02", 0},
               {"-0.02", "-0.02000000000000001", 0},
               {"0.25, 1.\n*B", "0.25, 1.0000000000000000000000\n*B", 1},
               {"2, 2, -0.02", "1, 2, -0.02", 0},
               {"1.3E+05, .20", "1.3E+02, .20", 0}};
  JOB j = stopped_at(2);
  for (size_t k = 0; k < sizeof edits / sizeof *edits; ++k) {
    edit(&j, edits[k].from, edits[k].to);
    if (!edits[k].same) refused(&j, 2, "the deck has changed");
    if (!edits[k].same) edit(&j, edits[k].to, edits[k].from);
  }
  goes_on(&j, 0, "numbers spelled otherwise");
}

/* Output and solver of a step to come, requests for restart files anywhere; of
 * the step in progress they may not change, nor may effects come or go. */
TEST(later_steps_may_change) {
  JOB j = stopped_at(1);
  edit(&j, "*PRINT, CONTACT, LOOP", "*PRINT, CONTACT");
  refused(&j, 2, "step 1, *PRINT");
  edit(&j, "*PRINT, CONTACT", "*PRINT, CONTACT, LOOP");
  edit(&j, "METHOD=AUTO", "METHOD=SOR");
  refused(&j, 2, "step 1, *SOLVER");
  edit(&j, "METHOD=SOR", "METHOD=AUTO");
  edit(&j, "COULOMB\n0.4", "COULOMB\n0.5");
  refused(&j, 2, "*FRICTION");
  edit(&j, "COULOMB\n0.5", "COULOMB\n0.4");
  edit(&j, "TOP, 1, 1, -0.01\n",
       "TOP, 1, 1, -0.01\n*SOLVER, METHOD=SOR\n*PRINT, CONTACT, LOOP\n"
       "*RESTART\n");
  goes_on(&j, 0, "solver and output of a later step");
  char *lst = job_file(&j, "lst"), *again = strstr(lst, "DECK OF THE RESTART");
  ck_assert_ptr_nonnull(again);
  ck_assert_ptr_nonnull(strstr(again, "METHOD=SOR"));
  free(lst);
  ck_assert(job_has(&j, "rst.h5"));
}

/* Adapted increments come back to lengths of before but for the rounding of the
 * times; a run that goes on takes them for the same ones too. */
TEST(adapted_increments_go_on) {
  const char *words = "INTEGRATOR=MIDPOINT, TOLERANCE=1E-4";
  job both[2];
  for (int k = 0; k < 2; ++k) {
    both[k] = small_creep(0.1, "", words);
    edit(&both[k], "MAXWELL\n4.\n", "NORTON\n1E-8, 3.\n");
    edit(&both[k], "0.5, 4.\n*ACCURACY, TIME=YES\n", "0.1, 2.\n");
  }
  run_whole(&both[0]);
  stop_at(&both[1], 14);
  goes_on(&both[1], 0, words);
  same_files(&both[0], &both[1], words);
  for (int k = 0; k < 2; ++k) job_end(&both[k]);
}

/* Yields within an increment, whose stages are then not stable. */
static job yielding(void) {
  job j = small_creep(0.1, "", "INTEGRATOR=HEUN, SUBSTEPS=AUTO");
  edit(&j, "MAXWELL\n4.\n", "PERZYNA\n200., 1.E4, 1.E4\n");
  edit(&j, "*ACCURACY, TIME=YES\n", "*DSLOAD\nLEFT, P, 400.\n");
  return j;
}

/* Stopped after the first attempt that was not stable: the next is cut. */
TEST(unstable_attempt_is_not_made_twice) {
  int line = 0;
  JOB whole = yielding(), j = yielding();
  run_whole(&whole);
  FREED char *sta = job_file(&whole, "sta");
  const char *cut = strstr(sta, "CUT UNSTABLE");
  ck_assert_ptr_nonnull(cut);
  while (cut > sta) line += *--cut == '\n';
  stop_at(&j, line);
  FREED char *stopped = job_file(&j, "sta");
  ck_assert(strncmp(stopped, sta, strlen(stopped)) == 0);
  ck_assert_ptr_nonnull(strstr(stopped, "CUT UNSTABLE"));
  goes_on(&j, 0, "yielding");
  same_files(&whole, &j, "yielding");
}

static job adapted_factors(void) {
  job j = small_creep(0.1, "*SOLVER, STIFFNESS=FACTOR\n",
                      "INTEGRATOR=BACKWARD, TOLERANCE=3E-3");
  edit(&j, "MAXWELL\n4.\n",
       "KELVIN, TYPE=DEVIATORIC\n65.E3, 52.E3\n108.E3, 182.E3\n");
  edit(&j, "0.5, 4.\n*ACCURACY, TIME=YES\n", "0.25, 1.\n");
  return j;
}

/* So do the rows that the factors of their matrices follow. */
TEST(factors_of_adapted_increments_go_on) {
  static const int stops[] = {1, 7, 9};
  JOB one = adapted_factors();
  run_whole(&one);
  for (int k = 0; k < 3; ++k) {
    JOB j = adapted_factors();
    stop_at(&j, stops[k]);
    goes_on(&j, 0, "adapted");
    same_files(&one, &j, "adapted");
  }
}

/* A block that comes down through the air, with tolerances of its own. */
static job falling(void) {
  job j =
      small_flat(0.4, "", "SOR, TOL=BALANCED\n*ACCURACY, MESH=YES, TIME=YES");
  edit(&j, "TYPE=CONFORMING", "TYPE=PLANE\n0., -0.01\n0., 1.");
  return j;
}

/* The path beside the run goes on with the tolerance that was chosen last. */
TEST(chosen_tolerance_goes_on) {
  static const int stops[] = {1, 2, 5};
  JOB whole = falling();
  run_whole(&whole);
  for (int k = 0; k < 3; ++k) {
    JOB j = falling();
    stop_at(&j, stops[k]);
    goes_on(&j, 0, "falling");
    same_files(&whole, &j, "falling");
  }
}

/* The path beside the run goes on with the motion of the obstacle there. */
TEST(path_on_a_moving_obstacle_goes_on) {
  job both[2];
  for (int k = 0; k < 2; ++k) {
    both[k] = small_flat(0.4, "", "SOR\n*ACCURACY, TIME=YES");
    edit(&both[k], "TYPE=CONFORMING",
         "TYPE=PLANE\n0., 0.\n0., 1.\nMOVE, \"1e-3*t^2\", 0.");
  }
  run_whole(&both[0]);
  stop_at(&both[1], 3);
  goes_on(&both[1], 0, "moving");
  same_files(&both[0], &both[1], "moving");
  for (int k = 0; k < 2; ++k) job_end(&both[k]);
}

/* Steps that creep, and one between without an estimate in time: the errors of
 * the others add up; the loads of the second and of the third. */
static job stepwise(double mu, const char *const *load) {
  job j = small_creep(mu, "", "INTEGRATOR=EULER");
  PRINTED(steps,
          "*ACCURACY, TIME=YES\n*END STEP\n*STEP\n*VISCO, INTEGRATOR=HEUN\n"
          "0.5, 1.\n*DSLOAD\nTOP, P, %s\n*END STEP\n*STEP\n*STATIC\n1.\n%s"
          "*ACCURACY, TIME=NO\n*END STEP\n*STEP\n*VISCO, INTEGRATOR=HEUN\n"
          "0.5, 1.\n*ACCURACY, TIME=YES\n",
          load[0], load[1]);
  edit(&j, "*ACCURACY, TIME=YES\n", steps);
  edit(&j, "0.5, 4.", "0.5, 1.");
  edit(&j, "MAXWELL\n4.\n", "NORTON\n1E-10, 3.\n");
  edit(&j, "MATERIAL=M\n*OBS", "MATERIAL=M, TYPE=CPS3\n*OBS");
  return j;
}

/* Those of stresses; of strains that stay without stress; none where the loads
 * turn too often. */
TEST(paths_of_steps_go_on) {
  static const char *const loads[][2] = {
      {"80.", ""},
      {"\"10*t^3\"", "*DSLOAD\nTOP, P, 0.\nLEFT, P, 0.\n"},
      {"\"80+sin(50*t)\"", "*DSLOAD\nTOP, P, 80.\n"}};
  static const int stops[][3] = {{5, 7, 8}, {8, 9}, {9}};
  for (int i = 0; i < 3; ++i) {
    JOB whole = stepwise(i == 1 ? 0.0 : 0.1, loads[i]);
    run_whole(&whole);
    ck_assert_int_eq(isnan(job_told(&whole, "time_error_percent")), i == 2);
    for (int k = 0; k < 3 && stops[i][k] > 0; ++k) {
      JOB j = stepwise(i == 1 ? 0.0 : 0.1, loads[i]);
      stop_at(&j, stops[i][k]);
      goes_on(&j, 0, loads[i][0]);
      same_files(&whole, &j, "steps");
    }
  }
}

/* What friction remembers of errors, of which a goal that wears has none, the
 * solutions that CHECK= finds, and what is worn off. */
TEST(errors_of_goals_go_on) {
  static const char *const cards[] = {
      "*GOAL, NAME=F, QUANTITY=FORCE, CONTACT=C, COMPONENT=1\n"
      "*GOAL, NAME=W, QUANTITY=FRICTION WORK\n*STEP",
      "*WEAR, CONTACT=C, COEFFICIENT=1e-9\n*STEP"};
  static const char *const tables[] = {"*PRINT, GOALS\n", "*PRINT, WEAR\n"};
  for (int i = 0; i < 2; ++i) {
    job both[2];
    for (int k = 0; k < 2; ++k) {
      both[k] = small_flat(0.25, tables[i], "NEWTON, CHECK=YES");
      edit(&both[k], "*STEP", cards[i]);
    }
    run_whole(&both[0]);
    stop_at(&both[1], 6);
    goes_on(&both[1], 0, cards[i]);
    same_files(&both[0], &both[1], cards[i]);
    for (int k = 0; k < 2; ++k) job_end(&both[k]);
  }
}

/* A stiffness that is an operator: its factors are made again. */
TEST(factor_goes_on) {
  static const char *const methods[] = {"AUTO", "AUGLAG", "PROXIMAL", "PCG",
                                        "LAGRANGE"};
  for (size_t m = 0; m < sizeof methods / sizeof *methods; ++m) {
    job both[2];
    PRINTED(choice, "%s, STIFFNESS=FACTOR", methods[m]);
    for (int k = 0; k < 2; ++k) both[k] = small_flat(0.4, "", choice);
    run_whole(&both[0]);
    stop_at(&both[1], 3);
    goes_on(&both[1], 0, methods[m]);
    same_files(&both[0], &both[1], methods[m]);
    for (int k = 0; k < 2; ++k) job_end(&both[k]);
  }
}

/* A strip of so many cells in three steps, their *SOLVER cards and supports;
 * its law and what integrates it, or "". */
static job strip(int cells, const char *const solver[2],
                 const char *const supports[2], const char *law,
                 const char *scheme) {
  const char *kind = law[0] != '\0' ? "*VISCO" : "*QUASISTATIC";
  job j = job_begin("strip");
  job_write(&j, "strip.geo",
            "Point(1) = {0, 0, 0};\n"
            "b[] = Extrude {1, 0, 0} { Point{1}; Layers{%d}; };\n"
            "s[] = Extrude {0, 0.01, 0} { Line{b[1]}; Layers{3}; };\n"
            "Physical Curve(\"BOTTOM\") = {b[1]};\n"
            "Physical Curve(\"TOP\") = {s[0]};\n"
            "Physical Curve(\"END\") = {s[2]};\n"
            "Physical Surface(\"BODY\") = {s[1]};\n",
            cells);
  job_write(&j, "strip.inp",
            "*MESH, FILE=strip.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
            "%s*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
            "*OBSTACLE, NAME=O, TYPE=GAP\n\"1e-5*(1 - cos(40*x))\"\n"
            "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
            "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n*STEP\n%s%s\n"
            "0.25, 1.\n*BOUNDARY\nTOP, 1, 1, 0.\nTOP, 2, 2, -5e-5\n"
            "*SOLVER%s\n*PRINT, CONTACT\n*OUTPUT, HDF5=NO\n*END STEP\n"
            "*STEP\n%s%s\n0.25, 1.\n*BOUNDARY\nTOP, 1, 1, 4e-5\n%s"
            "*SOLVER%s\n*END STEP\n*STEP\n%s%s\n0.25, 1.\n"
            "*BOUNDARY\nTOP, 1, 1, 5e-5\n%s*END STEP\n",
            law, kind, scheme, solver[0], kind, scheme, supports[0], solver[1],
            kind, scheme, supports[1]);
  return j;
}

/* Interrupted in the second step; chosen: of the first and a later one. */
static void check_kinds(int cells, const char *const solver[2],
                        const char *const supports[2],
                        const char *const chosen[2]) {
  job both[2];
  for (int k = 0; k < 2; ++k) both[k] = strip(cells, solver, supports, "", "");
  run_whole(&both[0]);
  stop_at(&both[1], 7);
  FREED char *listing = job_file(&both[0], "lst");
  const char *first = strstr(listing, chosen[0]);
  ck_assert_ptr_nonnull(first);
  ck_assert_ptr_nonnull(strstr(first, chosen[1]));
  FREED char *status_file = job_file(&both[1], "sta");
  ck_assert_ptr_nonnull(strstr(status_file, "\n     2     1 "));
  ck_assert_ptr_null(strstr(status_file, "\n     3     1 "));
  goes_on(&both[1], 0, "strip");
  same_files(&both[0], &both[1], "strip");
  for (int k = 0; k < 2; ++k) job_end(&both[k]);
}

/* The kind of stiffness is that of the step, not of the one before it. */
TEST(kind_of_stiffness_goes_on) {
  check_kinds(
      300, (const char *const[]){", STIFFNESS=DENSE", ""},
      (const char *const[]){"", ""},
      (const char *const[]){"DENSE  STIFFNESS of", "FACTOR  it is expected"});
}

/* Tangents of the points that are those of the last solve, as nothing flows:
 * the factor of Newton, which the next contact changes in a few rows, too. */
TEST(factor_of_tangents_goes_on) {
  job both[2];
  static const char *const none[] = {"", ""};
  for (int k = 0; k < 2; ++k)
    both[k] = strip(40, none, none, "*INELASTIC, LAW=PERZYNA\n1e6, 50.\n",
                    ", INTEGRATOR=BACKWARD");
  run_whole(&both[0]);
  stop_at(&both[1], 11);
  goes_on(&both[1], 0, "tangents");
  same_files(&both[0], &both[1], "tangents");
  for (int k = 0; k < 2; ++k) job_end(&both[k]);
}

/* Other supports: a new choice, by the systems and solves so far, without which
 * it would be DENSE. */
TEST(observed_work_goes_on) {
  check_kinds(150, (const char *const[]){", STIFFNESS=FACTOR", ""},
              (const char *const[]){"END, 1, 1, 4e-5\n", "END, 2, 2, -5e-5\n"},
              (const char *const[]){"FACTOR  STIFFNESS of",
                                    "FACTOR  it is expected to be faster, by"});
}

/* A load that grows from next to nothing and falls again, far below what moves
 * the block to the floor: rounding counts against the largest load of the step,
 * and energies and stresses against the largest so far. */
static job light(void) {
  job j =
      job_with("light", "tests/regression/mesh/square.geo",
               "*PARAMETER\nN = 4\n*MESH, FILE=square.geo\n*MATERIAL, NAME=M\n"
               "*ELASTIC\n1000., 0.3\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
               "*OBSTACLE, NAME=O, TYPE=PLANE\n0., -1.\n0., 1.\n"
               "*CONTACT, NAME=C, GROUP=BOTTOM, OBSTACLE=O\n"
               "*FRICTION, CONTACT=C, LAW=COULOMB\n0.3\n*STEP\n*QUASISTATIC\n"
               "0.1, 1.\n*BOUNDARY\nLEFT, 1\n*DSLOAD\nTOP, P, 3E-10\n"
               "*PRINT, TOTALS\n*OUTPUT\n*END STEP\n*STEP\n*QUASISTATIC\n"
               "0.2, 1.\n*DSLOAD\nTOP, P, \"3E-10*(2.01 - t)\"\n*END STEP\n");
  return j;
}

TEST(largest_loads_and_energies_go_on) {
  static const int stops[] = {1, 2, 12};
  JOB whole = light();
  int code = traced_run(&whole, nothing, NULL);
  ck_assert_int_le(code, 1); /* the first forces are told to be in doubt     */
  FREED char *lst = job_file(&whole, "lst");
  ck_assert_ptr_nonnull(strstr(lst, "\n  rounding: "));
  for (int k = 0; k < 3; ++k) {
    JOB j = light();
    stop_at(&j, stops[k]);
    goes_on(&j, code, "light");
    same_files(&whole, &j, "light");
  }
}

/* A block that slips on, with another material and another second step. */
static job sliding(const char *material, const char *second) {
  job j = small_flat(0.1, "", "AUTO");
  edit(&j, "130.D3, 0.2\n", material);
  edit(&j, "*END STEP\n*STEP\n*QUASISTATIC\n0.25, 1.\n", second);
  edit(&j, "TOP, 1, 1, -0.01",
       "TOP, 1, 1, 0.06\n*END STEP\n*STEP\n*VISCO, INTEGRATOR=BACKWARD\n"
       "0.25, 0.25\n");
  return j;
}

/* The rate of contraction that is known for the statuses belongs to a matrix:
 * moduli that change, tangents that stay. */
TEST(known_rate_goes_on) {
  static const char *const body[][2] = {
      {"130.D3, 0.2, 0.\n65.D3, 0.3, 500.\n*EXPANSION\n1.2E-7\n"
       "*INELASTIC, LAW=MAXWELL\n4.\n",
       "*END STEP\n*STEP\n*QUASISTATIC\n0.25, 1.\n"
       "*TEMPERATURE\nBODY, \"100*(t-1)\"\n"},
      {"130.D3, 0.2\n*INELASTIC, LAW=BINGHAM\n1E6, 1.\n",
       "*END STEP\n*STEP\n*VISCO, INTEGRATOR=BACKWARD\n0.25, 1.\n"}};
  for (int i = 0; i < 2; ++i) {
    JOB whole = sliding(body[i][0], body[i][1]);
    run_whole(&whole);
    for (int line = 5; line < 8; line += 2) {
      JOB j = sliding(body[i][0], body[i][1]);
      stop_at(&j, line);
      goes_on(&j, 0, body[i][1]);
      same_files(&whole, &j, body[i][1]);
    }
  }
}

/* Killed, gone on with and killed again: what the second restart file tells of
 * increments was read from the first. */
TEST(killed_twice_goes_on) {
  int all, changes;
  const char *words = "INTEGRATOR=MIDPOINT";
  const char *const again[] = {"--restart", NULL};
  JOB whole = small_creep(1.0, "*RESTART\n", words);
  JOB j = small_creep(1.0, "*RESTART\n", words);
  ck_assert_int_eq(run_until(&whole, nothing, 0, 0, &all), 0);
  run_until(&j, nothing, 12 * all / 25, SIGKILL, &changes);
  run_until(&j, again, 3 * all / 8, SIGKILL, &changes);
  goes_on(&j, 0, words);
  same_files(&whole, &j, words);
}

/* Stopped before any increment. */
TEST(run_without_a_file_begins_anew) {
  int changes;
  JOB whole = small_flat(0.4, "*RESTART\n", "AUTO");
  JOB j = small_flat(0.4, "*RESTART\n", "AUTO");
  run_whole(&whole);
  ck_assert_int_eq(run_until(&j, nothing, 9, SIGTERM, &changes), 143);
  ck_assert(!job_has(&j, "rst.h5"));
  goes_on(&j, 0, "from nothing");
  ck_assert_ptr_nonnull(
      strstr(j.errors, "block.rst.h5; the run begins at its start"));
  same_files(&whole, &j, "from nothing");
}

/* Files under the names of before: temperatures of the step in progress, and of
 * one to come; the mesh, of a file that gmsh finds. */
TEST(files_are_in_the_seal) {
  static const char *const names[] = {"first.msh", "second.msh"};
  JOB j = small_flat(0.4, "*TEMPERATURE, FILE=first.msh\nBODY\n", "AUTO");
  edit(&j, "130.D3, 0.2", "130.D3, 0.2\n*EXPANSION\n1.E-5");
  edit(&j, "*BOUNDARY\nTOP, 1, 1, -0.01",
       "*TEMPERATURE, FILE=second.msh\nBODY\n*BOUNDARY\nTOP, 1, 1, -0.01");
  edit(&j, "FILE=greco.geo", "FILE=outer.geo");
  job_write(&j, "outer.geo", "Merge StrCat(\"greco\", \".geo\");\n");
  FREED char *block = file_read("input/greco/greco.geo", NULL);
  for (int k = 0; k < 2; ++k) write_field(&j, names[k], 20);
  stop_at(&j, 1);
  write_field(&j, names[0], 21);
  refused(&j, 2, "*TEMPERATURE, FILE=first.msh");
  write_field(&j, names[0], 20);
  job_write(&j, "greco.geo", "%s\nDilate {{0, 0, 0}, 2} { Surface{1}; }\n",
            block);
  refused(&j, 4, "with another mesh");
  job_write(&j, "greco.geo", "%s", block);
  write_field(&j, names[1], 21);
  goes_on(&j, 0, "a file of a later step");
}

/* Equal runs write equal restart files. */
TEST(restart_files_are_equal) {
  JOB a = small_creep(1.0, "*RESTART\n", "INTEGRATOR=MIDPOINT");
  JOB b = small_creep(1.0, "*RESTART\n", "INTEGRATOR=MIDPOINT");
  ck_assert_int_eq(job_run(&a, "--no-timing"), 0);
  ck_assert_int_eq(job_run(&b, "--no-timing"), 0);
  ck_assert_msg(same_bytes(&a, &b, "rst.h5"), "rst.h5");
  ck_assert_msg(same_bytes(&a, &b, "rst.old.h5"), "rst.old.h5");
  ck_assert_msg(same_bytes(&a, &b, "rst.inc"), "rst.inc");
}

/* Bytes of a result. */
static long bytes_of(const job *j, const char *suffix) {
  struct stat of;
  PRINTED(path, "%s/%s.%s", j->dir, j->name, suffix);
  ck_assert_msg(stat(path, &of) == 0, "%s", path);
  return (long)of.st_size;
}

/* What is written at each increment does not grow with their number. */
TEST(restart_file_does_not_grow) {
  long whole[2], added[2];
  for (int k = 0; k < 2; ++k) {
    JOB j = small_flat(0.4, "*RESTART\n", "SOR");
    if (k == 1) edit(&j, "0.25, 1.", "0.01, 1.");
    ck_assert_int_eq(job_run(&j, "--no-timing"), 0);
    whole[k] = bytes_of(&j, "rst.h5");
    added[k] = bytes_of(&j, "rst.inc");
  }
  ck_assert_int_eq(whole[1], whole[0]);
  ck_assert_int_gt(added[1], 4 * added[0]);
}

/* The restart file as it is now; another may take its name. */
static hid_t kept_by(const job *j) {
  PRINTED(path, "%s/%s.rst.h5", j->dir, j->name);
  hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
  ck_assert_msg(file >= 0, "%s", path);
  return file;
}

/* The bytes of an array, to be freed; NULL: there is none. */
static unsigned char *array_of(hid_t file, const char *name, size_t *bytes) {
  hid_t set = H5Dopen2(file, name, H5P_DEFAULT);
  if (set < 0) return NULL;
  hid_t type = H5Dget_type(set);
  *bytes = (size_t)H5Dget_storage_size(set);
  unsigned char *data = calloc(*bytes + 1, 1);
  ck_assert(H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0);
  H5Tclose(type);
  H5Dclose(set);
  return data;
}

/* Every array is there twice, but for calls of stages. */
static void same_arrays(hid_t a, hid_t b, int scene) {
  size_t n, m;
  FREED char *list = (char *)array_of(a, "/list", &n);
  int found = 0;
  for (char *line = list; *line != '\0'; line = strchr(line, '\n') + 1) {
    char name[240];
    ck_assert_int_eq(sscanf(line, "%*d %*u %231[^\n]", name), 1);
    if (strcmp(name, "run/costs") == 0) continue;
    memmove(name + 6, name, strlen(name) + 1);
    memcpy(name, "/data/", 6);
    FREED unsigned char *x = array_of(a, name, &n), *y = array_of(b, name, &m);
    ck_assert_msg(x != NULL && y != NULL && n == m && memcmp(x, y, n) == 0,
                  "scene %d: %s", scene, name);
    ++found;
  }
  ck_assert_int_gt(found, 10);
}

/* Stopped, gone on with and stopped again before its next increment: what was
 * read is what is written. */
TEST(what_is_read_is_written_again) {
  static const char *const again[] = {"--restart", NULL};
  static const char changed[] = "130.D3, 0.2\n*EXPANSION\n1.2E-7\n";
  static const char second[] =
      "*END STEP\n*STEP\n*QUASISTATIC\n0.25, 1.\n"
      "*ACCURACY, TIME=YES, MESH=YES\n";
  static const int stops[][2] = {{1, 5}, {2, 6}, {4, 10}, {2, 6}};
  int changes;
  for (int scene = 0; scene < 4; ++scene)
    for (int k = 0; k < 2; ++k) {
      JOB j = scene == 0   ? small_flat(0.4, "", "AUTO")
              : scene == 1 ? small_creep(1.0, "", "INTEGRATOR=MIDPOINT")
              : scene == 2 ? light()
                           : sliding(changed, second);
      stop_at(&j, stops[scene][k]);
      hid_t first = kept_by(&j);
      ck_assert_int_eq(run_until(&j, again, 9, SIGINT, &changes), 130);
      hid_t then = kept_by(&j);
      same_arrays(first, then, scene);
      H5Fclose(first);
      H5Fclose(then);
    }
}

/* The last increment but not the first has converged; at the end of such a run
 * there is nothing left to do. */
TEST(missed_tolerance_goes_on) {
  JOB j = small_flat(1.0, "*RESTART\n", "SOR, MAX_ITER=1");
  edit(&j, "0.25, 1.\n*BOUNDARY\nTOP, 2, 2, -0.02\nTOP, 1, 1, 0.02\n",
       "1., 1.\n*BOUNDARY\nSYMMETRY, 1\n*DSLOAD\nTOP, P, 50.\nLEFT, P, 150.\n");
  edit(&j, "0.25, 1.\n*BOUNDARY\nTOP, 1, 1, -0.01\n",
       "1., 1.\n*SOLVER, METHOD=AUTO\n");
  edit(&j, "COULOMB\n1\n", "COULOMB\n\"if(t < 0.5, 0.9, 1)\"\n");
  ck_assert_int_eq(job_run(&j, "--no-timing"), 1);
  goes_on(&j, 1, "a tolerance missed");
  FREED char *lst = job_file(&j, "lst");
  ck_assert_ptr_nonnull(strstr(lst, "jumps at t = 0.5 from 0.9 to 1"));
  ck_assert_ptr_nonnull(strstr(lst, "violated most at"));
}

TEST(some_jobs_start_anew) {
  JOB j = stopped_at(1);
  edit(&j, "TOP, 1, 1, -0.01\n", "TOP, 1, 1, -0.01\n*ACCURACY, THEORY=YES\n");
  refused(&j, 2, "theorems");
  edit(&j, "*ACCURACY, THEORY=YES", "*ACCURACY, TARGET=5.");
  refused(&j, 2, "TARGET=");
}

/* Flip a byte in the middle of a file of the folder. */
static void damage(const job *j, const char *suffix) {
  PRINTED(path, "%s/%s.%s", j->dir, j->name, suffix);
  FILE *f = fopen(path, "r+b");
  ck_assert_ptr_nonnull(f);
  fseek(f, 0, SEEK_END);
  long middle = ftell(f) / 2;
  for (int k = 0; k < 64; ++k) {
    fseek(f, middle + k, SEEK_SET);
    int c = fgetc(f);
    fseek(f, middle + k, SEEK_SET);
    fputc(c ^ 0x55, f);
  }
  fclose(f);
}

TEST(damaged_files_are_refused) {
  int changes, all;
  JOB whole = small_flat(0.4, "*RESTART\n", "AUTO");
  JOB j = small_flat(0.4, "*RESTART\n", "AUTO");
  run_until(&whole, nothing, 0, 0, &all);
  ck_assert_int_eq(run_until(&j, nothing, all * 2 / 3, SIGKILL, &changes),
                   KILLED);
  damage(&j, "rst.h5");
  goes_on(&j, 0, "from the file before");
  ck_assert_ptr_nonnull(strstr(j.errors, "warning"));
  ck_assert_ptr_nonnull(strstr(j.errors, "rst.old.h5"));
  same_files(&whole, &j, "from the file before");
  job_write(&j, "block.dat", "short");
  refused(&j, 4, "block.dat is shorter");
  ck_assert(!job_has(&j, "json"));
  damage(&j, "rst.inc");
  refused(&j, 4, "rst.inc is damaged");
  job_write(&j, "block.rst.inc", "short");
  refused(&j, 4, "rst.inc is shorter");
  damage(&j, "rst.h5");
  damage(&j, "rst.old.h5");
  refused(&j, 4, "damaged");
  job_write(&j, "block.rst.h5", "Protis restart, layout 2\n7 0\nolder");
  refused(&j, 4, "layout of another version");
  job_write(&j, "block.rst.h5", "no HDF5\n");
  refused(&j, 4, "no restart file of Protis");
}

UNIT_MAIN("restart")
