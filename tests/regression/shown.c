/*
 * What is shown of texts from outside: no control character reaches terminal,
 * listing, tables, JSON, XDMF or HDF5, and nothing of a file that *INCLUDE
 * names but that is no deck.
 */
#include "support/job.h"
#include "support/unit.h"

/* ESC, C1 as UTF-8 and as a byte, a mark of direction, Latin-1, DEL; what stays
 * is the e with its accent. */
#define WILD "a\033[31mb\302\233c\233d\342\200\256e\351f\177g\303\251"
#define TAME "a\\x1B[31mb\\xC2\\x9Bc\\x9Bd\\xE2\\x80\\xAEe\\xE9f\\x7Fg\303\251"

static void must_be_tame(const char *text, const char *where) {
  for (const char *p = text; p != NULL && *p != '\0'; ++p) {
    unsigned char c = (unsigned char)*p;
    ck_assert_msg(c >= ' ' || c == '\n' || c == '\t', "%s: byte %u: %.80s",
                  where, c, p);
    ck_assert_msg(c < 0x7F || c == 0303 || c == 0251, "%s: byte %u: %.80s",
                  where, c, p > text + 20 ? p - 20 : text);
  }
}

static void files_must_be_tame(const job *j) {
  static const char *const texts[] = {"lst", "sta",  "cvg",
                                      "dat", "json", "xdmf"};
  for (size_t i = 0; i < sizeof texts / sizeof *texts; ++i) {
    FREED char *text = job_file(j, texts[i]);
    ck_assert_ptr_nonnull(text);
    must_be_tame(text, texts[i]);
  }
}

/* The square with a group of that name and a deck of that heading, contact,
 * obstacle, amplitude, step and file. */
static job wild_job(const char *more) {
  job j = job_begin("wild");
  job_copy(&j, "tests/regression/bad/square.msh");
  PRINTED(command,
          "cd '%s' && sed 's/\"BOTTOM\"/\"" WILD "\"/' square.msh > '" WILD
          ".msh'",
          j.dir);
  ck_assert_int_eq(system(command), 0);
  job_write(&j, "wild.inp",
            "*HEADING\n" WILD "\n*MESH, FILE=" WILD
            ".msh\n"
            "*MATERIAL, NAME=M" WILD
            "\n*ELASTIC\n1000., 0.3\n"
            "*SOLID SECTION, ELSET=BODY, MATERIAL=M" WILD
            "\n"
            "*OBSTACLE, NAME=O" WILD
            ", TYPE=CONFORMING\n"
            "*CONTACT, NAME=C" WILD ", GROUP=" WILD ", OBSTACLE=O" WILD
            "\n"
            "*FRICTION, LAW=COULOMB, CONTACT=C" WILD "\n0.3\n*STEP, NAME=S" WILD
            "\n"
            "*QUASISTATIC\n0.5, 1.\n*BOUNDARY\nLEFT, 1, 1\n"
            "*DSLOAD\nTOP, P, 5.\n%s*PRINT, CONTACT, TOTALS\n"
            "*PRINT, NODES, GROUP=" WILD "\n*OUTPUT\n*END STEP\n",
            more);
  return j;
}

TEST(results_show_no_control_character) {
  JOB j = wild_job("");
  CK_EXIT(job_run(&j, ""), 0, j);
  files_must_be_tame(&j);
  FREED char *lst = job_file(&j, "lst"), *json = job_file(&j, "json");
  ck_assert_ptr_nonnull(strstr(lst, TAME));
  ck_assert_ptr_nonnull(strstr(json, "a\\\\x1B[31mb\\\\xC2\\\\x9Bc"));
  ck_assert_int_eq(job_run(&j, "--check"), 0);
  must_be_tame(j.text, "--check");
  ck_assert_ptr_nonnull(strstr(j.text, TAME));
}

TEST(messages_show_no_control_character) {
  static const char *const wrong[] = {
      "*" WILD ", " WILD "=" WILD "\n", "*DSLOAD\nX" WILD ", P, 1.\n",
      "*DSLOAD\nTOP, " WILD ", 1.\n",   "*DSLOAD\nTOP, P, \"" WILD "\"\n",
      "*INCLUDE, INPUT=" WILD "\n",     "*TEMPERATURE, FILE=" WILD "\nBODY\n",
      "*SOLVER, METHOD=" WILD "\n",     "*DSLOAD\nTOP, P, <" WILD ">\n",
      "*DSLOAD\nTOP, P, 1., " WILD "\n"};
  for (size_t i = 0; i < sizeof wrong / sizeof *wrong; ++i) {
    JOB j = wild_job(wrong[i]);
    int code = job_run(&j, "");
    ck_assert_msg(code >= 2 && code <= 4, "%s: exit %d", wrong[i], code);
    must_be_tame(j.errors, wrong[i]);
    ck_assert_ptr_nonnull(strstr(j.errors, "[31m"));
  }
}

TEST(command_line_shows_no_control_character) {
  static const char *const words[] = {
      "--keywords '" WILD "'", "'--x" WILD "'",   "--list '" WILD "'",
      "-D '" WILD "'",         "-D '" WILD "=1'", "-o '/dev/null/" WILD "'"};
  for (size_t i = 0; i < sizeof words / sizeof *words; ++i) {
    JOB j = wild_job("");
    ck_assert_int_ne(job_run(&j, words[i]), 0);
    must_be_tame(j.errors, words[i]);
    ck_assert_ptr_nonnull(strstr(j.errors, "[31m"));
  }
}

/* The name of the deck is that of the results. */
TEST(name_of_a_job_shows_no_control_character) {
  JOB j = wild_job("");
  char command[600];
  snprintf(command, sizeof command,
           "cd '%s' && cp wild.inp '" WILD ".inp' && '%s' '" WILD
           ".inp' -o out > said 2>&1 && ls out >> said && "
           "cat out/*.lst out/*.json out/*.xdmf out/*.sta >> said",
           j.dir, getenv("PROTIS"));
  ck_assert_int_eq(system(command), 0);
  snprintf(j.name, sizeof j.name, "said");
  snprintf(command, sizeof command, "mv '%s/said' '%s/said.txt'", j.dir, j.dir);
  ck_assert_int_eq(system(command), 0);
  FREED char *text = job_file(&j, "txt");
  must_be_tame(text, "job");
  ck_assert_ptr_nonnull(strstr(text, TAME ".lst"));
}

/* Files that lie about a machine. */
static const char *const files[] = {
    "root:x:0:0:sesame:/root:/bin/sh\nsesame:x:1:1::/:/bin/false\n",
    "# comment\n127.0.0.1 sesame localhost\n",
    "-----BEGIN OPENSSH PRIVATE KEY-----\nsesame\nAAAA+sesame==\n",
    "sesame\n",
    "user = sesame\npassword = 12\n",
    "{\"token\": \"sesame\"}\n",
    "1, sesame, sesame\n",
    "*sesame\n",
    "* * * * * root sesame\n",
    "*HEAD*, sesame\n",
    "sesame, 1, 2\n",
    "\n\n   \n** x\nsesame sesame\n"};

/* Below every kind of card, as data, text or a definition. */
static const char *const above[] = {"",
                                    "*HEADING\n",
                                    "*PARAMETER\n",
                                    "*ELASTIC\n",
                                    "*BOUNDARY\n",
                                    "*STEP\n*STATIC\n*DSLOAD\n",
                                    "*AMPLITUDE, NAME=A\n",
                                    "*LEGACY, FORMAT=(10A8)\n*BOUNDARY\n",
                                    "*END STEP\n"};

TEST(include_shows_nothing_of_what_is_no_deck) {
  for (size_t i = 0; i < sizeof files / sizeof *files; ++i)
    for (size_t k = 0; k < sizeof above / sizeof *above; ++k) {
      JOB j = job_begin("job");
      job_copy(&j, "tests/regression/bad/square.msh");
      job_write(&j, "secret", "%s", files[i]);
      job_write(&j, "job.inp",
                "*HEADING\nA square\n*MESH, FILE=square.msh\n"
                "*MATERIAL, NAME=M\n%s*INCLUDE, INPUT=secret\n"
                "*ELASTIC\n1., 0.\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n"
                "*STEP\n*STATIC\n*BOUNDARY\nLEFT, 1, 2\n*OUTPUT, HDF5=NO\n"
                "*END STEP\n",
                above[k]);
      int code = job_run(&j, "");
      ck_assert_msg(code < 7, "exit %d: %s", code, j.errors);
      ck_assert_msg(strstr(j.errors, "sesame") == NULL &&
                        strstr(j.errors, "SESAME") == NULL,
                    "%s below %s: %s", files[i], above[k], j.errors);
      ck_assert_ptr_null(strstr(j.text, "sesame"));
      FREED char *lst = job_file(&j, "lst");
      if (lst != NULL) ck_assert_ptr_null(strstr(lst, "sesame"));
    }
}

/* A deck in parts is shown, and so is the place in data without a card. */
TEST(include_shows_a_deck) {
  JOB j = job_begin("job");
  job_write(&j, "part.inc", "*ELASTIC\n1., x\n");
  job_write(&j, "job.inp", "*MATERIAL, NAME=M\n*INCLUDE, INPUT=part.inc\n");
  ck_assert_int_eq(job_run(&j, ""), 2);
  ck_assert_ptr_nonnull(strstr(j.errors, "part.inc:2:5: error P1024"));
  ck_assert_ptr_nonnull(strstr(j.errors, "2 | 1., x"));
  job_write(&j, "part.inc", "1., x\n");
  job_write(&j, "job.inp",
            "*MATERIAL, NAME=M\n*ELASTIC\n*INCLUDE, INPUT=part.inc\n");
  ck_assert_int_eq(job_run(&j, ""), 2);
  ck_assert_ptr_nonnull(strstr(j.errors, "part.inc:1:5: error P1024: not a "));
  ck_assert_ptr_null(strstr(j.errors, "1., x"));
}

UNIT_MAIN("shown")
