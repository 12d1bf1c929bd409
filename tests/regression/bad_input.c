/*
 * Wrong decks, meshes and command lines: each file tests/regression/bad/NAME
 * .cases holds one-edit cases of bad.inp and square.msh, and what the first
 * line on stderr and the exit code must be.
 *
 *   [CARD.PARAMETER] title    what the case is for; [] if for no card
 *   @ file                    the edits below change this file (bad.inp)
 *   > words                   the command line behind "protis" (bad)
 *   -line                     this line is taken away
 *   +line                     put there; "^" and "$" before: start, end of file
 *   ! first line of stderr; absent: there is none
 *   = exit code; behind it how many messages there are, if not one
 */
#include "base/message.h"
#include "model/keyword/keyword.h"
#include "support/job.h"
#include "support/unit.h"

#include <dirent.h>

static const char folder[] = "tests/regression/bad";

enum { LINES = 128, LINE = 1024, FILES = 24, CASES = 800 };

typedef struct bad_case {
  char *title, *line[LINES], *expected, *count;
  int n_line, exit_code;
} bad_case;

/* All cases of one file, or of all files. */
typedef struct bad_cases {
  int n;
  bad_case item[CASES];
} bad_cases;

static char *copy_text(const char *text) {
  char *copy = strdup(text);
  ck_assert_ptr_nonnull(copy);
  return copy;
}

static void read_line(bad_cases *all, char *line) {
  line[strcspn(line, "\n")] = '\0';
  if (line[0] == '[') {
    ck_assert_int_lt(all->n, CASES);
    all->item[all->n++] = (bad_case){.title = copy_text(line)};
  }
  if (all->n == 0 || line[0] == '[' || line[0] == '\0') return;
  bad_case *c = &all->item[all->n - 1];
  if (strncmp(line, "! ", 2) == 0) {
    c->expected = copy_text(line + 2);
  } else if (strncmp(line, "= ", 2) == 0) {
    c->exit_code = atoi(line + 2);
    if (strchr(line + 2, ' ') != NULL)
      c->count = copy_text(strchr(line + 2, ' ') + 1);
  } else {
    ck_assert_int_lt(c->n_line, LINES);
    c->line[c->n_line++] = copy_text(line);
  }
}

static void read_cases(bad_cases *all, const char *name) {
  char line[LINE];
  PRINTED(path, "%s/%s", folder, name);
  FILE *f = fopen(path, "r");
  ck_assert_msg(f != NULL, "%s", path);
  while (fgets(line, sizeof line, f) != NULL) read_line(all, line);
  fclose(f);
}

static void free_cases(bad_cases *all) {
  for (int i = 0; i < all->n; ++i) {
    for (int k = 0; k < all->item[i].n_line; ++k) free(all->item[i].line[k]);
    free(all->item[i].title);
    free(all->item[i].expected);
    free(all->item[i].count);
  }
  all->n = 0;
}

/* ---- edits ------------------------------------------------------------- */

typedef struct text_lines {
  int n;
  char *line[LINES];
} text_lines;

static void read_text(text_lines *t, const char *name) {
  char line[LINE];
  PRINTED(path, "%s/%s", folder, name);
  t->n = 0;
  FILE *f = fopen(path, "r");
  if (f == NULL) return;
  while (fgets(line, sizeof line, f) != NULL) {
    line[strcspn(line, "\n")] = '\0';
    t->line[t->n++] = copy_text(line);
  }
  fclose(f);
}

static void insert_line(text_lines *t, int at, const char *text) {
  ck_assert_int_lt(t->n, LINES);
  memmove(&t->line[at + 1], &t->line[at],
          (size_t)(t->n - at) * sizeof *t->line);
  t->line[at] = copy_text(text);
  ++t->n;
}

static int remove_line(text_lines *t, const bad_case *c, const char *text) {
  int at = 0;
  while (at < t->n && strcmp(t->line[at], text) != 0) ++at;
  ck_assert_msg(at < t->n, "%s: no line '%s'", c->title, text);
  free(t->line[at]);
  --t->n;
  memmove(&t->line[at], &t->line[at + 1],
          (size_t)(t->n - at) * sizeof *t->line);
  return at;
}

static void write_text(const job *j, const char *name, text_lines *t) {
  PRINTED(path, "%s/%s", j->dir, name);
  FILE *f = fopen(path, "w");
  ck_assert_ptr_nonnull(f);
  for (int i = 0; i < t->n; ++i) {
    fprintf(f, "%s\n", t->line[i]);
    free(t->line[i]);
  }
  fclose(f);
}

/* Edit the files of a case into the folder; its command line. */
static const char *prepare(const job *j, const bad_case *c) {
  const char *file = "bad.inp", *words = "bad";
  text_lines t;
  int at;
  read_text(&t, file);
  at = t.n;
  for (int k = 0; k < c->n_line; ++k) {
    const char *line = c->line[k];
    if (line[0] == '@') {
      write_text(j, file, &t);
      file = line + 2;
      read_text(&t, file);
      at = t.n;
    } else if (line[0] == '>') {
      words = line[1] == '\0' ? "" : line + 2;
    } else if (line[0] == '-') {
      at = remove_line(&t, c, line + 1);
    } else if (line[0] == '+') {
      insert_line(&t, at++, line + 1);
    } else {
      at = line[0] == '^' ? 0 : t.n;
    }
  }
  write_text(j, file, &t);
  return words;
}

/* ---- runs -------------------------------------------------------------- */

static job begin_run(void) {
  static const char *const meshes[] = {"square.msh", "cube.msh"};
  job j = job_begin("");
  for (size_t i = 0; i < 2; ++i) {
    text_lines t;
    read_text(&t, meshes[i]);
    write_text(&j, meshes[i], &t);
  }
  return j;
}

/* The number of every message that a run has shown. */
typedef struct seen {
  unsigned char number[10000];
} seen;

static void note_numbers(seen *s, const char *errors) {
  for (const char *p = errors; (p = strstr(p, " P")) != NULL; ++p) {
    int n = 0, length = 0;
    if (sscanf(p, " P%4d%n", &n, &length) == 1 && p[length] == ':')
      s->number[n] = 1;
  }
}

/* 1 if the run of a case ends as expected; else it is told. */
/* 1: a whole line of the text. */
static int has_line(const char *text, const char *line) {
  size_t n = strlen(line);
  for (; text != NULL; text = strchr(text, '\n')) {
    text += *text == '\n';
    if (strncmp(text, line, n) == 0 && (text[n] == '\n' || text[n] == '\0'))
      return 1;
  }
  return 0;
}

/* A line tells how many messages there are, where they have numbers. */
static int is_counted(const bad_case *c, const char *errors) {
  const char *wanted = c->count;
  if (wanted == NULL) wanted = c->exit_code != 0 ? "1 error" : "1 warning";
  const size_t n = strlen(wanted);
  for (const char *p = errors; p != NULL; p = strchr(p, '\n')) {
    p += *p == '\n';
    const size_t digits = strspn(p, "0123456789");
    if (digits == 0 || (strncmp(p + digits, " error", 6) != 0 &&
                        strncmp(p + digits, " warning", 8) != 0))
      continue;
    return strncmp(p, wanted, n) == 0 && strchr(";\n", p[n]) != NULL;
  }
  return c->count == NULL;
}

static int run_case(const bad_case *c, const char *more, seen *s) {
  JOB j = begin_run();
  PRINTED(words, "%s%s", prepare(&j, c), more);
  int code = job_run(&j, words);
  note_numbers(s, j.errors);
  int good = code == c->exit_code &&
             (c->expected == NULL ? j.errors[0] == '\0'
                                  : has_line(j.errors, c->expected)) &&
             (more[0] != '\0' || is_counted(c, j.errors));
  if (!good)
    fprintf(stderr, "%s%s\n  expected %d: %s\n  found    %d: %s\n", c->title,
            more, c->exit_code, c->expected == NULL ? "" : c->expected, code,
            j.errors);
  return good;
}

/* ---- what the cases cover ---------------------------------------------- */

/* What the cases are for: "[CARD.PARAMETER]" or "[CARD]". */
static int is_covered(const bad_cases *all, const char *of_card,
                      const char *of_parameter) {
  char tag[128];
  size_t length = (size_t)snprintf(tag, sizeof tag,
                                   of_parameter == NULL ? "[%s" : "[%s.%s]",
                                   of_card, of_parameter);
  for (int i = 0; i < all->n; ++i) {
    const char *title = all->item[i].title;
    if (strncmp(title, tag, length) != 0) continue;
    if (of_parameter != NULL || title[length] == ']' || title[length] == '.')
      return 1;
  }
  return 0;
}

/* The case of a parameter must have its name in an edit or in the answer. */
static int speaks_of(const bad_case *c, const char *word) {
  for (int k = 0; k < c->n_line; ++k)
    if (strstr(c->line[k], word) != NULL) return 1;
  return c->expected != NULL && strstr(c->expected, word) != NULL;
}

static void check_tags(const bad_cases *all) {
  for (int i = 0; i < all->n; ++i) {
    char *dot;
    PRINTED(tag, "%s", all->item[i].title + 1);
    tag[strcspn(tag, "]")] = '\0';
    if (tag[0] == '\0') continue;
    if ((dot = strchr(tag, '.')) != NULL) {
      *dot = '\0';
      ck_assert_msg(speaks_of(&all->item[i], dot + 1), "%s",
                    all->item[i].title);
    }
    ck_assert_msg(keyword_find(tag) != NULL, "%s: no such card",
                  all->item[i].title);
  }
}

static const char *const error_files[] = {
    "language.cases", "law.cases",  "model.cases",  "contact.cases",
    "step.cases",     "mesh.cases", "command.cases"};

static void read_error_files(bad_cases *all) {
  for (size_t i = 0; i < sizeof error_files / sizeof *error_files; ++i)
    read_cases(all, error_files[i]);
}

TEST(every_card_and_parameter_has_a_case) {
  static bad_cases all;
  int missing = 0;
  read_error_files(&all);
  ck_assert_int_ge(all.n, 300);
  check_tags(&all);
  for (const keyword *k = keyword_table; k->name != NULL; ++k) {
    if (!is_covered(&all, k->name, NULL))
      ++missing, fprintf(stderr, "*%s\n", k->name);
    for (const option *o = k->options; o != NULL && o->name != NULL; ++o)
      if (!is_covered(&all, k->name, o->name))
        ++missing, fprintf(stderr, "*%s, %s=\n", k->name, o->name);
  }
  ck_assert_msg(missing == 0, "%d cards and parameters without a case",
                missing);
  free_cases(&all);
}

TEST(folder_holds_no_other_cases) {
  int n = 0;
  DIR *dir = opendir(folder);
  ck_assert_ptr_nonnull(dir);
  for (struct dirent *e; (e = readdir(dir)) != NULL;)
    n += strstr(e->d_name, ".cases") != NULL;
  closedir(dir);
  ck_assert_int_eq(n, (int)(sizeof error_files / sizeof *error_files) + 1);
}

/* Messages that need a mesh no lines of text can hold or that gmsh is the
 * first to refuse, a crack, two bodies, or name nodes that move alike;
 * tests/unit/mesh_errors.c, open.c and tests/regression/pairs.c, pair_update.c,
 * cracks.c and floating.c have them. */
static const int not_by_cases[] = {3004, 3005, 3025, 3027, 3050, 3051, 3052,
                                   3053, 3054, 3055, 3056, 4024, 4025, 4026,
                                   4027, 4028, 4029, 4030, 4031, 4032, 4033,
                                   4034, 4035, 4036, 4038, 4040, 4042, 4043};

static void check_messages(const seen *s) {
#define MESSAGE_NUMBER(number, level, title, remedy) number,
  static const int numbers[] = {MESSAGE_LIST(MESSAGE_NUMBER)};
  int missing = 0;
  for (size_t i = 0; i < sizeof numbers / sizeof *numbers; ++i) {
    int excused = s->number[numbers[i]];
    for (size_t k = 0; k < sizeof not_by_cases / sizeof *not_by_cases; ++k)
      excused |= not_by_cases[k] == numbers[i];
    if (!excused)
      ++missing, fprintf(stderr, "P%04d is shown by no case\n", numbers[i]);
  }
  ck_assert_msg(missing == 0, "%d messages are shown by no case", missing);
}

static int run_file(const char *name, int is_error, seen *s) {
  static bad_cases all;
  int failed = 0;
  all.n = 0;
  read_cases(&all, name);
  ck_assert_int_gt(all.n, 10);
  for (int i = 0; i < all.n; ++i) {
    const bad_case *c = &all.item[i];
    ck_assert_msg((c->exit_code != 0) == is_error, "%s: exit %d", c->title,
                  c->exit_code);
    failed += !run_case(c, "", s);
  }
  free_cases(&all);
  return failed;
}

/* A file that is no text at all. */
typedef struct no_deck {
  const char *bytes;
  int n, repeat; /* the bytes are written that often                         */
  const char *expected;
} no_deck;

static const no_deck no_decks[] = {
    {"", 0, 1, "bad.inp: error P1002: no card in the file"},
    {"\n", 1, 1000, "bad.inp: error P1002: no card in the file"},
    {"*\0H\0E\0A\0", 8, 100,
     "bad.inp:1:2: error P1013: NUL byte: the file is not plain text"},
    {"\377\376*\0", 4, 1,
     "bad.inp:1:4: error P1013: NUL byte: the file is not plain text"},
    {"\211HDF\r\n\032\n", 8, 1,
     "bad.inp:1:1: error P1015: data before the first card"},
    {"\177ELF\2\1\1", 7, 600,
     "bad.inp:1:4097: error P1014: line of more than 4096 characters"},
    {"*MESH ", 6, 700,
     "bad.inp:1:4097: error P1014: line of more than 4096 characters"},
    {"*", 1, 100000,
     "bad.inp:1:4097: error P1014: line of more than 4096 characters"},
    {"\"", 1, 3, "bad.inp:1:1: error P1015: data before the first card"}};

static int run_no_decks(seen *s) {
  int failed = 0;
  for (size_t i = 0; i < sizeof no_decks / sizeof *no_decks; ++i) {
    const no_deck *d = &no_decks[i];
    JOB j = job_begin("bad");
    PRINTED(path, "%s/bad.inp", j.dir);
    FILE *f = fopen(path, "w");
    for (int k = 0; k < d->repeat; ++k) fwrite(d->bytes, 1, (size_t)d->n, f);
    fclose(f);
    int code = job_run(&j, "");
    note_numbers(s, j.errors);
    j.errors[strcspn(j.errors, "\n")] = '\0';
    if (code != 2 || strcmp(j.errors, d->expected) != 0) {
      ++failed;
      fprintf(stderr, "no deck %zu: exit %d: %s\n", i, code, j.errors);
    }
  }
  return failed;
}

TEST(every_case_ends_with_its_message_and_exit_code) {
  static seen s;
  int failed = run_no_decks(&s) + run_file("warning.cases", 0, &s);
  for (size_t i = 0; i < sizeof error_files / sizeof *error_files; ++i)
    failed += run_file(error_files[i], 1, &s);
  ck_assert_msg(failed == 0, "%d cases failed", failed);
  check_messages(&s);
}

/* --check finds what the run finds but for P4..., which arise in it. */
TEST(check_alone_says_the_same) {
  static const char *const files[] = {"contact.cases", "warning.cases"};
  static bad_cases all;
  static seen s;
  int failed = 0;
  for (size_t i = 0; i < sizeof files / sizeof *files; ++i)
    read_cases(&all, files[i]);
  for (int i = 0; i < all.n; ++i)
    if (all.item[i].expected == NULL ||
        strstr(all.item[i].expected, " P4") == NULL)
      failed += !run_case(&all.item[i], " --check", &s);
  free_cases(&all);
  ck_assert_msg(failed == 0, "%d cases failed", failed);
}

UNIT_MAIN("bad_input")
