/*
 * The manual against the program: every chapter prints, every command in it
 * runs, every card has an example and these are decks that run, version and
 * examples are those of the sources.
 */
#include "support/job.h"
#include "support/unit.h"

#include <glob.h>
#include <unistd.h>

enum { TEXT = 2048 };

static char *source(const char *path) {
  PRINTED(copy, "%s", path);
  char *dot = strrchr(copy, '.');
  *dot = '\0';
  job j = {.dir = "."};
  ck_assert_uint_lt(strlen(copy), sizeof j.dir);
  char *slash = strrchr(copy, '/');
  if (slash != NULL) {
    *slash = '\0';
    snprintf(j.dir, sizeof j.dir, "%.63s", copy);
  }
  snprintf(j.name, sizeof j.name, "%.31s", slash == NULL ? copy : slash + 1);
  char *text = job_file(&j, dot + 1);
  ck_assert_msg(text != NULL, "%s: not there", path);
  return text;
}

static int count(const char *text, const char *word) {
  int n = 0;
  for (; (text = strstr(text, word)) != NULL; ++text) ++n;
  return n;
}

/* Run in the folder; check fails if the exit code is another. */
static void expect(job *j, const char *command, int code) {
  int found = job_shell(j, command);
  ck_assert_msg(found == code, "%s: exit %d: %s%s", command, found, j->text,
                j->errors);
}

TEST(every_chapter_of_the_sources_prints) {
  char command[TEXT], row[80];
  glob_t files;
  JOB j = job_begin("manual"), list = job_begin("list");
  ck_assert_int_eq(glob("src/manual/*.md", 0, NULL, &files), 0);
  expect(&list, "protis --manual", 0);
  ck_assert_int_eq(count(list.text, "\n"), (int)files.gl_pathc + 1);
  for (size_t i = 0; i < files.gl_pathc; ++i) {
    FREED char *text = source(files.gl_pathv[i]);
    const char *name = strrchr(files.gl_pathv[i], '/') + 1;
    snprintf(command, sizeof command, "protis --manual %.*s",
             (int)strcspn(name, "."), name);
    expect(&j, command, 0);
    ck_assert_msg(strncmp(j.text, text, strlen(text)) == 0, "%s", command);
    snprintf(row, sizeof row, "\n  %.*s ", (int)strcspn(name, "."), name);
    ck_assert_msg(strstr(list.text, row) != NULL, "no row of %s", name);
  }
  expect(&j, "protis --manual nothing", 2);
  ck_assert_ptr_nonnull(strstr(j.errors, "there is no chapter nothing"));
  ck_assert_ptr_nonnull(strstr(j.errors, "\n  tutorial "));
  globfree(&files);
}

/* With a blank, a comma or a semicolon behind it. */
TEST(every_folder_of_the_sources_has_its_place) {
  glob_t folders;
  FREED char *text = source("src/manual/effects.md");
  const char *from = strstr(text, "## How the sources are ordered");
  ck_assert_ptr_nonnull(from);
  ck_assert_int_eq(glob("src/*/*/", 0, NULL, &folders), 0);
  for (size_t i = 0; i < folders.gl_pathc; ++i) {
    char *path = folders.gl_pathv[i], *name;
    path[strlen(path) - 1] = '\0';
    name = strrchr(path, '/') + 1;
    if (strcmp(name, "pictures") == 0) continue;
    const char *at = from;
    do {
      at = strstr(at + 1, name);
      ck_assert_msg(at != NULL, "no %s", path);
    } while (strchr(" \n", at[-1]) == NULL ||
             strchr(" ,;\n", at[strlen(name)]) == NULL);
  }
  globfree(&folders);
}

TEST(every_card_has_an_example) {
  JOB j = job_begin("manual"), cards = job_begin("cards");
  expect(&j, "protis --manual deck", 0);
  expect(&cards, "protis --keywords", 0);
  ck_assert_int_gt(count(cards.text, "\n*"), 30);
  ck_assert_int_eq(count(j.text, "\nFor example\n"),
                   1 + count(cards.text, "\n*"));
}

/* Each form of them, as the help writes it. */
TEST(lines_of_loads_begin_with_their_group) {
  static const char *const cards[] = {"BOUNDARY", "CLOAD", "DLOAD", "DSLOAD",
                                      "TEMPERATURE"};
  for (size_t i = 0; i < sizeof cards / sizeof *cards; ++i) {
    JOB j = job_begin("cards");
    PRINTED(command, "protis --keywords %s", cards[i]);
    expect(&j, command, 0);
    const char *line = strstr(j.text, "data lines: ");
    ck_assert_ptr_nonnull(line);
    for (line += 12; line != NULL; line = strstr(line, "; ")) {
      if (*line == ';') line += 2;
      if (strncmp(line, "or ", 3) == 0) line += 3;
      if (strncmp(line, "with FILE= ", 11) == 0) line += 11;
      ck_assert_msg(strncmp(line, "group", 5) == 0, "%s: %s", cards[i], line);
    }
  }
}

TEST(examples_of_the_cards_run_without_a_warning) {
  glob_t files;
  JOB j = job_begin("pattern");
  ck_assert_int_eq(glob("src/manual/pattern*", 0, NULL, &files), 0);
  for (size_t i = 0; i < files.gl_pathc; ++i) job_copy(&j, files.gl_pathv[i]);
  globfree(&files);
  expect(&j, "protis pattern --quiet", 0);
  ck_assert_str_eq(j.errors, "");
  expect(&j, "protis pattern_problem --quiet", 0);
  ck_assert_str_eq(j.errors, "");
}

/* Chapters whose fenced blocks are commands; those of the tutorial, which draw,
 * run in tests/tools/pictures.py. */
static const char *const commands[] = {"results", "batch", "trouble", "abaqus"};
enum { COMMANDS = sizeof commands / sizeof *commands };

TESTS(every_command_runs, COMMANDS) {
  char cwd[TEXT / 4];
  JOB j = job_begin("manual");
  ck_assert_ptr_nonnull(getcwd(cwd, sizeof cwd));
  PRINTED(command, "'%s/tools/run_manual' '%s/src/manual/%s.md' .", cwd, cwd,
          commands[_i]);
  expect(&j, command, 0);
  ck_assert_int_gt(count(j.text, "line "), 0);
}

TEST(version_is_the_newest_of_the_changes) {
  char version[100], name[TEXT];
  JOB j = job_begin("version");
  FREED char *changes = source("src/manual/changes.md"),
             *readme = source("README.md"),
             *package = source("tools/python/pyproject.toml");
  const char *at = strstr(changes, "\n## ");
  ck_assert_int_eq(sscanf(at, "\n## %99s", version), 1);
  for (int i = 0; i < 2; ++i) {
    expect(&j, i == 0 ? "protis --version" : "protis -V", 0);
    snprintf(name, sizeof name, "protis %s (commit ", version);
    ck_assert_msg(strncmp(j.text, name, strlen(name)) == 0, "%s", j.text);
  }
  snprintf(name, sizeof name, "Protis %s,", version);
  ck_assert_msg(strstr(readme, name) != NULL, "README.md: no '%s'", name);
  snprintf(name, sizeof name, "\nversion = \"%s\"\n", version);
  ck_assert_msg(strstr(package, name) != NULL, "pyproject.toml: no '%s'", name);
}

TEST(every_example_is_copied_and_nothing_overwritten) {
  char name[64], command[TEXT], cwd[TEXT / 4];
  int n = 0;
  glob_t folders;
  JOB list = job_begin("list");
  ck_assert_ptr_nonnull(getcwd(cwd, sizeof cwd));
  expect(&list, "protis --list examples", 0);
  ck_assert_int_eq(glob("input/*", 0, NULL, &folders), 0);
  for (const char *p = list.text; sscanf(p, "%63s", name) == 1; ++n) {
    if (strcmp(name, "protis") == 0) break;
    JOB j = job_begin(name);
    snprintf(command, sizeof command, "protis --example %s", name);
    expect(&j, command, 0);
    snprintf(command, sizeof command,
             "for f in *.inp *.geo; do cmp $f '%s/input/%s/'$f || exit 1; done",
             cwd, name);
    expect(&j, command, 0);
    snprintf(command, sizeof command,
             "echo mine > %s.inp; rm *.geo; protis --example %s", name, name);
    expect(&j, command, 4);
    FREED char *text = job_file(&j, "inp");
    ck_assert_str_eq(text, "mine\n");
    ck_assert_int_eq(job_has(&j, "geo"), 0);
    p = strchr(p, '\n') + 1;
  }
  ck_assert_int_eq(n, (int)folders.gl_pathc);
  globfree(&folders);
  expect(&list, "protis --example grecco", 2);
  ck_assert_ptr_nonnull(strstr(list.errors, "did you mean greco?"));
}

/* A short cylinder on a floor under a pressure and a friction that follow the
 * place. */
static char *axisymmetric_run(const char *parameters, const char *pressure,
                              const char *friction) {
  JOB j =
      job_with("ring", "input/relaxing_seal/relaxing_seal.geo",
               "%s*MESH, FILE=relaxing_seal.geo\n"
               "*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*SOLID SECTION, "
               "ELSET=RING, MATERIAL=M, TYPE=CAX3\n*OBSTACLE, NAME=O, "
               "TYPE=CONFORMING\n*CONTACT, NAME=C, GROUP=SEAT, OBSTACLE=O\n"
               "*FRICTION, CONTACT=C, LAW=COULOMB%s\n*STEP\n*STATIC\n*DSLOAD\n"
               "LIP, P, %s\n*PRINT, CONTACT\n*END STEP\n",
               parameters, friction, pressure);
  ck_assert_msg(job_run(&j, "--quiet") == 0, "%s: %s", pressure, j.errors);
  return job_file(&j, "dat");
}

TEST(an_installed_program_works_and_is_removed) {
  static const char *const there[] = {
      "usr/bin/protis", "usr/share/man/man1/protis.1",
      "usr/share/protis/tools/compare",
      "usr/share/protis/tools/pictures/body.py",
      "usr/share/protis/examples/greco/greco.geo"};
  char cwd[TEXT / 4], command[TEXT];
  const char *program = getenv("PROTIS");
  JOB j = job_begin("install");
  if (program == NULL) program = "build/release/protis";
  const char *end = strrchr(program, '/'), *build = end;
  while (build > program && build[-1] != '/') --build;
  ck_assert_ptr_nonnull(getcwd(cwd, sizeof cwd));
  for (int i = 0; i < 2; ++i) {
    snprintf(command, sizeof command,
             "d=$PWD && cd '%s' && MAKEFLAGS= make -s BUILD=%.*s PREFIX=/usr "
             "DESTDIR=$d/staged %s",
             cwd, (int)(end - build), build,
             i == 0 ? "install-files" : "uninstall");
    expect(&j, command, 0);
    for (size_t k = 0; k < sizeof there / sizeof *there; ++k) {
      snprintf(command, sizeof command, "test %s -e staged/%s",
               i == 0 ? "" : "!", there[k]);
      expect(&j, command, 0);
    }
    if (i == 1) break;
    expect(&j,
           "PATH=$PWD/staged/usr/bin:$PATH && protis --example greco && "
           "protis greco --quiet && cmp greco.inp "
           "staged/usr/share/protis/examples/greco/greco.inp && "
           "staged/usr/share/protis/tools/compare greco.dat greco.dat",
           0);
    expect(&j,
           "bash -c '. staged/usr/share/bash-completion/completions/protis && "
           "COMP_WORDS=(protis --keywords SOLID) COMP_CWORD=2 && _protis && "
           "test \"${COMPREPLY[0]}\" = \"SOLID SECTION\"'",
           0);
  }
  expect(&j, "test -z \"$(find staged -type f)\"", 0);
}

TEST(axisymmetric_expressions_know_r_and_z) {
  static const char *const same[][5] = {
      {"*PARAMETER\nS = 3.\n", "\"<S>*x + y\"", "\n\"0.02*x + 0.1*y\"",
       "\"<S>*r + z\"", "\n\"0.02*r + 0.1*Z\""},
      {"", "5.", ", TABLE=Y\n-1., 0.1, 1., 0.3", "5.",
       ", TABLE=Z\n-1., 0.1, 1., 0.3"},
      {"*PARAMETER\nR = 4.\n", "\"<R>*x\"", "\n0.3", "\"R*x\"", "\n0.3"}};
  for (size_t i = 0; i < sizeof same / sizeof *same; ++i) {
    const char *const *s = same[i];
    FREED char *old = axisymmetric_run(s[0], s[1], s[2]);
    FREED char *new = axisymmetric_run(s[0], s[3], s[4]);
    ck_assert_str_eq(old, new);
  }
}

TEST(columns_are_listed_by_table) {
  JOB j = job_begin("list");
  expect(&j, "protis --list columns", 0);
  ck_assert_ptr_nonnull(strstr(j.text, "\nCONTACT: "));
  ck_assert_ptr_nonnull(
      strstr(j.text, "\n  pressure           force/length^2 "));
}

TEST(every_list_is_found_by_a_word_near_it) {
  static const char *const kinds[] = {"solvers",     "materials", "friction",
                                      "integrators", "columns",   "examples"};
  JOB j = job_begin("list");
  for (size_t i = 0; i < sizeof kinds / sizeof *kinds; ++i) {
    PRINTED(line, "protis --list x%s", kinds[i]);
    PRINTED(near, "did you mean %s?", kinds[i]);
    expect(&j, line, 2);
    ck_assert_msg(strstr(j.errors, near) != NULL, "%s", j.errors);
  }
}

UNIT_MAIN("manual")
