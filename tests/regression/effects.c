/*
 * The effect plan: the same before a run and in its listing, in JSON, off where
 * nothing calls for an effect, and what is expected against what is counted.
 */
#include "support/block_file.h"
#include "support/job.h"
#include "support/unit.h"

/* A block, pressed and pushed, with further cards in its model and step. */
static job block(const char *model, const char *step, const char *words) {
  job j = job_begin("block");
  block_file_write(&j, (int[]){8, 8}, (double[]){40.0, 40.0}, 0);
  job_write(&j, "block.inp",
            "*PARAMETER\nMU = 0.5\nDT = 0.25\n*MESH, FILE=block.msh\n"
            "*MATERIAL, NAME=STEEL\n*ELASTIC\n130.D3, 0.2\n%s"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=STEEL, TYPE=CPE3\n"
            "*OBSTACLE, NAME=FLOOR, TYPE=CONFORMING\n"
            "*CONTACT, NAME=FOOT, GROUP=CONTACT, OBSTACLE=FLOOR\n"
            "*FRICTION, CONTACT=FOOT, LAW=COULOMB\n<MU>\n"
            "*STEP\n*QUASISTATIC\n<DT>, 1.0\n*BOUNDARY\nSYMMETRY, 1, 1\n"
            "*DSLOAD\nTOP, P, 50.\nLEFT, P, 20.\n%s*END STEP\n",
            model, step);
  CK_EXIT(job_run(&j, words), 0, j);
  return j;
}

static const char bare[] = "*ACCURACY, SOLVER=NO, MESH=NO\n*OUTPUT, HDF5=NO\n";

/* The line of an effect below a heading of the listing; caller frees. */
static char *effect_line(const job *j, const char *heading,
                         const char *effect) {
  char key[80], *text = job_file(j, "lst");
  snprintf(key, sizeof key, "\n%s\n", heading);
  char *at = strstr(text, key);
  ck_assert_msg(at != NULL, "no %s", heading);
  snprintf(key, sizeof key, "\n  %-26s ", effect);
  at = strstr(at, key);
  ck_assert_msg(at != NULL, "no effect '%s'", effect);
  char *line = strndup(at + 1, strcspn(at + 1, "\n"));
  free(text);
  return line;
}

static int is_on(const job *j, const char *effect) {
  FREED char *line = effect_line(j, "EFFECTS", effect);
  int on = strncmp(line + 29, "on ", 3) == 0;
  ck_assert(on || strncmp(line + 29, "off", 3) == 0);
  return on;
}

TEST(check_prints_the_plan_of_the_listing) {
  JOB a = block("", bare, ""), b = block("", bare, "--check");
  FREED char *listing = job_file(&a, "lst");
  char *from = strstr(b.text, "effects\n"), *to;
  ck_assert_ptr_nonnull(from);
  from = strchr(from, '\n') + 1;
  to = strstr(from, "listing, .sta");
  ck_assert_ptr_nonnull(to);
  to[strcspn(to, "\n") + 1] = '\0';
  ck_assert_msg(strstr(listing, from) != NULL, "%s", from);
}

/* An effect is named with the card that requires it, file and line. */
TEST(plan_names_file_and_line) {
  JOB j = block("", bare, "--check");
  ck_assert_ptr_nonnull(
      strstr(j.text, "*FRICTION, LAW=COULOMB on contact FOOT, block.inp:11\n"));
  ck_assert_ptr_nonnull(strstr(j.text, "*CONTACT, NAME=FOOT, block.inp:10\n"));
  ck_assert_ptr_nonnull(strstr(j.text, " 9 nodes "));
}

/* Not of nodes that are loaded: 9 on the side that is held. */
TEST(reactions_are_of_supports_alone) {
  JOB j = block("", "*PRINT, REACTIONS\n", "");
  DAT r = job_table(&j, "REACTIONS", -1);
  ck_assert_int_eq(r.n_row, 9);
  for (int i = 0; i < r.n_row; ++i)
    ck_assert_double_eq(dat_at(&r, i, "x"), 40.0);
}

/* A step that asks for nothing, and the beginning of the next, to line 26. */
#define LATER                                                         \
  "*SOLVER\n*ACCURACY, MESH=NO\n*OUTPUT, HDF5=NO\n*END STEP\n*STEP\n" \
  "*STATIC\n"

/* The card that counts, of several. */
TEST(plan_names_the_reason) {
  static const struct {
    const char *step, *words; /* the cards of the step from line 21 on */
    const char *effect, *reason;
  } rows[] = {
      {"", "-D MU=0", "tangential unknowns",
       "mu = 0: only normals are condensed"},
      {"*SOLVER, CHECK=YES\n", "-D MU=0", "tangential unknowns",
       "*SOLVER, CHECK=, block.inp:21"},
      {"*ACCURACY, THEORY=YES\n", "-D MU=0", "tangential unknowns",
       "*ACCURACY, THEORY=YES, block.inp:21"},
      {"*ACCURACY, THEORY=YES\n*SOLVER, CHECK=YES\n"
       "*OUTPUT, CONDENSED=FCLIB\n",
       "-D MU=0", "tangential unknowns",
       "*OUTPUT, CONDENSED=FCLIB, block.inp:23"},
      {"", "", "fields in JOB.h5", "default; *OUTPUT, HDF5=NO leaves them out"},
      {"*OUTPUT, HDF5=NO\n", "", "fields in JOB.h5", "*OUTPUT, HDF5=NO"},
      {"*OUTPUT, HDF5=NO\n*END STEP\n*STEP\n*STATIC\n*OUTPUT\n", "",
       "fields in JOB.h5", "*OUTPUT, block.inp:25"},
      {"*DLOAD\nBODY, BX, 1.\n", "", "body forces",
       "*DLOAD on group BODY, block.inp:22"},
      {"*DLOAD\nBODY, BX, 1.\n" LATER "*DLOAD\nBODY, BX, 2.\nBODY, BY, 1.\n",
       "", "body forces", "  256 elements "},
      {"", "", "body forces", "no *DLOAD card"},
      {"*OUTPUT, HDF5=NO\n*ACCURACY, MESH=NO\n", "", "stresses",
       "no output requires them"},
      {"*OUTPUT, HDF5=NO\n*PRINT, NODES\n*PRINT, ELEMENTS\n", "", "stresses",
       "*PRINT, block.inp:23"},
      {"*BOUNDARY\nTOP, 2, 2, -1E-3\n", "", "reactions",
       "work of the support TOP, block.inp:22, that moves or is released"},
      {LATER "*SOLVER, CHECK=YES\n", "", "second solutions, jumps",
       "*SOLVER, CHECK=, block.inp:27"},
      {LATER, "", "second solutions, jumps",
       "friction in *QUASISTATIC of block.inp:13 may jump"},
      {LATER "*ACCURACY, TIME=YES\n", "", "error of steps",
       "*ACCURACY, TIME=YES, block.inp:27"},
      {LATER "*ACCURACY, MESH=YES\n", "", "error of mesh",
       "*ACCURACY, MESH=YES, block.inp:27"},
      {LATER "*ACCURACY, THEORY=YES\n", "", "theory checks",
       "*ACCURACY, THEORY=YES, block.inp:27"},
      {LATER "*SOLVER, TOL=BALANCED\n", "", "error of mesh",
       "*SOLVER, TOL=BALANCED, block.inp:27"},
      {LATER "*RESTART\n", "", "restart", "*RESTART, block.inp:27"},
      {LATER "*OUTPUT, CONDENSED=FCLIB\n", "", "condensed problems",
       "*OUTPUT, CONDENSED=FCLIB, block.inp:27"},
      {"*END STEP\n*STEP\n*QUASISTATIC, FORM=VELOCITY\n1., 1.\n", "",
       "velocity form", "*QUASISTATIC, FORM=VELOCITY of block.inp:22"},
      {LATER "*PRINT, ZONES\n", "", "table of zones",
       "*PRINT, ZONES, block.inp:27"},
      {LATER "*DLOAD\nBODY, BX, 1.\n", "", "body forces",
       "*DLOAD on group BODY, block.inp:28"}};
  for (size_t i = 0; i < sizeof rows / sizeof *rows; ++i) {
    PRINTED(words, "--check %s", rows[i].words);
    JOB j = block("", rows[i].step, words);
    PRINTED(name, "\n  %s  ", rows[i].effect);
    const char *at = strstr(j.text, name);
    ck_assert_msg(at != NULL, "%s", rows[i].effect);
    FREED char *line = strndup(at + 1, strcspn(at + 1, "\n"));
    ck_assert_msg(strstr(line, rows[i].reason) != NULL, "%s\n%s",
                  rows[i].reason, line);
  }
}

/* Calls and bytes of an effect in the closing table, whose lines end with
 * calls, seconds, bytes; its line. */
static char *cost_of(const job *j, const char *effect, long *calls,
                     long *bytes) {
  char *line = effect_line(j, "COST OF THE EFFECTS", effect);
  const char *word[3] = {"", "", ""}, *at = line + 32;
  while (*at != '\0') {
    at += strspn(at, " ");
    word[0] = word[1];
    word[1] = word[2];
    word[2] = at;
    at += strcspn(at, " ");
  }
  *calls = strtol(word[0], NULL, 10);
  *bytes = strtol(word[2], NULL, 10);
  return line;
}

/* ---- every row of the plan, every stage ---------------------------------- */

/* The next line of a table of the listing at *at: its name, as padded to width;
 * 0 at the end of the table. */
static int next_row(const char **at, int width, char *name) {
  const char *end = strchr(*at, '\n');
  if (end == NULL || end == *at) return 0;
  ck_assert_int_gt(end - *at, 2 + width);
  snprintf(name, 80, "%.*s", width, *at + 2);
  for (int k = width; k > 0 && name[k - 1] == ' '; --k) name[k - 1] = '\0';
  *at = end + 1;
  return 1;
}

/* The first row of a table, below its heading, the line under it and that of
 * the columns. */
static const char *first_row(const char *text, const char *heading) {
  PRINTED(key, "\n%s\n", heading);
  const char *at = strstr(text, key);
  ck_assert_msg(at != NULL, "no %s", heading);
  for (int k = 0; k < 4; ++k) at = strchr(at, '\n') + 1;
  return at;
}

/* What is off has neither calls nor bytes; no stage runs but those named. */
static void check_off(const job *j, const char *const *stages) {
  char *text = job_file(j, "lst"), name[80];
  int rows = 0;
  for (const char *at = first_row(text, "COST OF THE EFFECTS");
       next_row(&at, 26, name); ++rows) {
    long calls, bytes;
    FREED char *line = cost_of(j, name, &calls, &bytes);
    if (strncmp(line + 29, "off", 3) == 0)
      ck_assert_msg(calls == 0 && bytes == 0, "%s", line);
  }
  ck_assert_int_gt(rows, 30);
  rows = 0;
  for (const char *at = first_row(text, "COST"); next_row(&at, 28, name);
       ++rows) {
    long bytes;
    int runs = strcmp(name, "all") == 0;
    for (int k = 0; stages[k] != NULL; ++k)
      runs |= strcmp(name, stages[k]) == 0;
    ck_assert_msg(runs || (job_stage(j, name, &bytes) == 0 && bytes == 0),
                  "stage '%s' runs", name);
  }
  ck_assert_int_gt(rows, 40);
  free(text);
}

#define ALWAYS                                                  \
  "deck and model", "mesh", "stiffness assembly",               \
      "ordering and symbolic factor", "factorisation", "loads", \
      "interior solves", "energies", "listing, .sta, .cvg"
#define TOUCHING "contact surface", "condensed stiffness", "contact solver"

/* One increment of a smooth block, then a path of a rough one. */
TEST(no_stage_runs_uncalled) {
  static const char *const smooth[] = {ALWAYS, TOUCHING, NULL};
  static const char *const rough[] = {ALWAYS,
                                      TOUCHING,
                                      "sliding limit",
                                      "history of slip",
                                      "second solutions, jumps",
                                      NULL};
  job j = block("", bare, "-D MU=0 -D DT=1");
  check_off(&j, smooth);
  job_end(&j);
  j = block("", bare, "");
  check_off(&j, rough);
  job_end(&j);
}

/* 1: a row of that name, a group behind it or not, is on and called. */
static int is_called(const job *j, const char *effect) {
  char *text = job_file(j, "lst"), name[80];
  int called = 0;
  for (const char *at = first_row(text, "COST OF THE EFFECTS");
       next_row(&at, 26, name);) {
    long calls, bytes;
    if (strncmp(name, effect, strlen(effect)) != 0) continue;
    FREED char *line = cost_of(j, name, &calls, &bytes);
    called |= strncmp(line + 29, "on ", 3) == 0 &&
              (calls > 0 || strstr(line, "part of") != NULL);
  }
  free(text);
  return called;
}

static job two_blocks(void) {
  job j =
      job_with("pair", "tests/regression/mesh/pair.geo",
               "*MESH, FILE=pair.geo\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n"
               "*SOLID SECTION, ELSET=LOWER, MATERIAL=M\n"
               "*SOLID SECTION, ELSET=UPPER, MATERIAL=M\n"
               "*CONTACT PAIR, NAME=P\nUNDER, OVER\n*STEP\n*STATIC\n"
               "*BOUNDARY\nBOTTOM, 2\nLEFT, 1\n*DSLOAD\nTOP, P, 1.\n"
               "*PRINT, SIF\n*END STEP\n");
  ck_assert_msg(job_run(&j, "") == 0, "%s", j.errors);
  return j;
}

/* Each row of the plan is on in one of these decks, and called there. */
TEST(every_effect_is_called_for) {
  static const char *const decks[][2] = {
      {"*EXPANSION\n1.2D-5\n*DENSITY\n7.8D-9\n",
       "*TEMPERATURE\nBODY, 10.\n*DLOAD\nBODY, GRAV, 9810., 0., -1.\n"
       "*PRINT, CONTACT, TOTALS, NODES, ELEMENTS, ENERGY, REACTIONS, ZONES, "
       "LOOP\n*ACCURACY, MESH=YES, TIME=YES, THEORY=YES\n*RESTART\n"
       "*OUTPUT, CONDENSED=FCLIB\n"},
      {"*INELASTIC, LAW=MAXWELL\n4.\n"
       "*INITIAL CONDITIONS, TYPE=DISPLACEMENT\nBODY, 1, 0.\n",
       "*FRICTION, CONTACT=FOOT, LAW=NONLOCAL, RADIUS=10.\n0.3\n"
       "*SOLVER, CHECK=YES\n*END STEP\n*STEP\n*VISCO, INTEGRATOR=MIDPOINT\n"
       "0.5, 1.\n*END STEP\n*STEP\n*QUASISTATIC, FORM=VELOCITY\n0.5, 1.\n"},
      {"*REFERENCE\nu_x, 0.\nu_y, 0.\n"
       "*OBSTACLE, NAME=LID, TYPE=CONFORMING\nMOVE, \"t\", 0.\n"
       "*CONTACT, NAME=TOP, GROUP=TOP, OBSTACLE=LID\n"
       "*CONTACT FORCE, CONTACT=TOP\n50.\n"
       "*GOAL, NAME=E, QUANTITY=ENERGY\n"
       "*WEAR, CONTACT=TOP, COEFFICIENT=1.E-9\n",
       ""}};
  enum { BLOCKS = sizeof decks / sizeof *decks, DECKS = BLOCKS + 1 };
  job j[DECKS];
  for (int k = 0; k < BLOCKS; ++k) j[k] = block(decks[k][0], decks[k][1], "");
  j[BLOCKS] = two_blocks();
  char *text = job_file(&j[0], "lst"), name[80];
  for (const char *at = first_row(text, "COST OF THE EFFECTS");
       next_row(&at, 26, name);) {
    int called = 0;
    for (int k = 0; k < DECKS; ++k) called |= is_called(&j[k], name);
    ck_assert_msg(called, "'%s' is on in no deck", name);
  }
  free(text);
  for (int k = 0; k < DECKS; ++k) job_end(&j[k]);
}

/* Largest difference of a column of the tables CONTACT of two runs over the
 * largest entry of its kind (one kind: lengths, forces, pressures). */
static double apart(const job *a, const job *b, const char *const *names) {
  double most = 0.0, size = 0.0;
  DAT x = job_table(a, "CONTACT", -1), y = job_table(b, "CONTACT", -1);
  ck_assert_int_eq(x.n_row, y.n_row);
  for (; *names != NULL; ++names)
    for (int k = 0; k < x.n_row; ++k) {
      most = fmax(most, fabs(dat_at(&x, k, *names) - dat_at(&y, k, *names)));
      size = fmax(size, fabs(dat_at(&x, k, *names)));
    }
  return most / size;
}

/* Without friction only normals are condensed; the same deck with its condensed
 * problems written has all unknowns, and the same answer. */
TEST(no_friction_no_tangential_unknown) {
  static const char *const lengths[] = {"u_n", "u_t", "gap", NULL};
  static const char *const forces[] = {"f_n", "f_t", NULL};
  static const char *const steps[] = {"*PRINT, CONTACT\n",
                                      "*PRINT, CONTACT\n"
                                      "*OUTPUT, CONDENSED=FCLIB\n"};
  job j[2];
  for (int k = 0; k < 2; ++k) j[k] = block("", steps[k], "-D MU=0");
  long calls, bytes;
  FREED char *line = cost_of(&j[0], "tangential unknowns", &calls, &bytes);
  ck_assert_msg(!is_on(&j[0], "tangential unknowns"), "%s", line);
  ck_assert_msg(calls == 0 && bytes == 0, "%s", line);
  ck_assert(is_on(&j[1], "tangential unknowns"));
  ck_assert_double_eq(job_told(&j[0], "contact_unknowns"), 9.0);
  ck_assert_double_eq(job_told(&j[1], "contact_unknowns"), 18.0);
  ck_assert_double_le(apart(&j[0], &j[1], lengths), 1e-12);
  ck_assert_double_le(apart(&j[0], &j[1], forces), 1e-12);
  for (int k = 0; k < 2; ++k) job_end(&j[k]);
}

/* A block between smooth walls, pressed from above in two steps: by symmetry
 * nothing rubs. One pass of the solver an increment, and one factor in all,
 * whatever the method. */
TEST(nothing_rubs_no_loop_one_factor) {
  static const char *const methods[] = {"AUTO", "NEWTON", "SOR", "AUGLAG"};
  for (size_t k = 0; k < sizeof methods / sizeof *methods; ++k) {
    PRINTED(step,
            "*BOUNDARY\nLEFT, 1, 1\n*SOLVER, METHOD=%s\n*END STEP\n*STEP\n"
            "*QUASISTATIC\n<DT>, 1.0\n*DSLOAD\nTOP, P, 70.\n",
            methods[k]);
    JOB j = block("", step, "");
    char *text = job_file(&j, "json"), *at = text;
    int increments = 0;
    for (; (at = strstr(at, "\"iterations\": ")) != NULL; ++at, ++increments)
      ck_assert_msg(strtol(strchr(at, ':') + 1, NULL, 10) <= 1, "%s: %.20s",
                    methods[k], at);
    ck_assert_int_ge(increments, 8);
    ck_assert_int_eq(job_stage(&j, "factorisation", NULL), 1);
    ck_assert_int_eq(job_stage(&j, "condensed stiffness", NULL), 1);
    free(text);
  }
}

/* JSON: calls expected and counted of the effects that tell both. */
TEST(calls_are_as_expected) {
  static const char *const files[] = {"", "*PRINT, CONTACT, TOTALS\n"};
  for (size_t k = 0; k < 2; ++k) {
    JOB j = block("", files[k], "");
    char *text = job_file(&j, "json"), *at = text;
    int compared = 0;
    double sum = 0.0;
    while ((at = strstr(at, "\"expected_cpu_percent\": ")) != NULL) {
      double expected, counted;
      char *end = strchr(at, '}'), *calls = strstr(at, "\"expected_calls\": ");
      sum += strtod(strchr(at, ':') + 1, NULL);
      at = end;
      if (calls == NULL || calls > end) continue;
      expected = strtod(strchr(calls, ':') + 1, NULL);
      calls = strstr(calls, "\"calls\": ");
      counted = strtod(strchr(calls, ':') + 1, NULL);
      ck_assert_msg(expected == counted, "%.60s", calls - 60);
      ++compared;
    }
    ck_assert_int_gt(compared, 5);
    ck_assert_double_eq_tol(sum, 100.0, 1e-9);
    free(text);
  }
}

/* JSON: the rows of each table, of all or of a group, are those written. */
TEST(rows_are_as_expected) {
  static const char *const requests[] = {
      "*PRINT, CONTACT, TOTALS, NODES, ELEMENTS, ENERGY, REACTIONS, LOOP\n",
      "*PRINT, NODES, GROUP=TOP\n*PRINT, ELEMENTS, GROUP=BODY\n"};
  static const char *const tables[][2] = {{"nodes", "NODES"},
                                          {"elements", "ELEMENTS"},
                                          {"contact nodes", "CONTACT"},
                                          {"resultants", "TOTALS"},
                                          {"energies", "ENERGY"},
                                          {"reactions", "REACTIONS"},
                                          {"loops", "LOOP"}};
  for (int k = 0; k < 2; ++k) {
    JOB j = block("", requests[k], "");
    char *text = job_file(&j, "json"), key[60];
    for (int i = 0; i < (k == 0 ? 7 : 2); ++i) {
      DAT t = job_table(&j, tables[i][1], -1);
      snprintf(key, sizeof key, "\"table of %s\"", tables[i][0]);
      const char *at = strstr(strstr(text, key), "\"rows\": ");
      ck_assert_msg(strtol(strchr(at, ':') + 1, NULL, 10) == t.n_row,
                    "%s: %d, %.16s", tables[i][1], t.n_row, at);
    }
    free(text);
  }
}

/* Without the cost columns two runs give the same bytes. */
TEST(no_timing_leaves_calls_alone) {
  JOB a = block("", bare, "--no-timing"), b = block("", bare, "--no-timing");
  FREED char *line =
      effect_line(&a, "COST OF THE EFFECTS", "unilateral contact");
  double share;
  long expected, calls;
  char rest;
  ck_assert_int_eq(
      sscanf(line + 32, "%lf %ld %ld %c", &share, &expected, &calls, &rest), 3);
  ck_assert_int_eq(calls, 4);
  FREED char *one = job_file(&a, "lst"), *two = job_file(&b, "lst");
  ck_assert_str_eq(one, two);
}

UNIT_MAIN("effects")
