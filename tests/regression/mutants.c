/*
 * Decks with one edit: a character, word, field or line deleted, doubled or
 * exchanged with its neighbour. Each is read and checked against a mesh, in a
 * process of its own: no signal, no hang, no defect of the program, and a
 * status that fits the messages.
 *
 *   MUTANTS=20000 MUTANT_SEED=7 mutants    many instead of the few of the tests
 */
#include "effects/rows.h"
#include "model/check/check.h"
#include "model/keyword/keyword.h"
#include "run/history/history.h"
#include "support/folder.h"
#include "support/grid.h"
#include "support/points.h"
#include "support/unit.h"

#include <glob.h>
#include <sys/wait.h>
#include <unistd.h>

enum { DECKS = 64, SECONDS = 60, QUICK = 600, ACCEPTED = 100 };

typedef struct deck_texts {
  int n;
  char *text[DECKS], *path[DECKS];
} deck_texts;

static unsigned long long next_random(unsigned long long *dice) {
  *dice ^= *dice << 13;
  *dice ^= *dice >> 7;
  *dice ^= *dice << 17;
  return *dice;
}

static size_t below(size_t n, unsigned long long *dice) {
  return n == 0 ? 0 : (size_t)(next_random(dice) % n);
}

static unsigned long long setting(const char *name, unsigned long long usual) {
  const char *text = getenv(name);
  return text == NULL ? usual : strtoull(text, NULL, 10);
}

static char *read_all(const char *path) {
  FILE *f = fopen(path, "rb");
  ck_assert_msg(f != NULL, "%s", path);
  fseek(f, 0, SEEK_END);
  size_t size = (size_t)ftell(f);
  rewind(f);
  char *text = calloc(size + 1, 1);
  ck_assert_uint_eq(fread(text, 1, size, f), size);
  fclose(f);
  return text;
}

static void read_decks(deck_texts *d, const char *pattern) {
  glob_t found;
  ck_assert_int_eq(glob(pattern, 0, NULL, &found), 0);
  for (size_t i = 0; i < found.gl_pathc; ++i) {
    ck_assert_int_lt(d->n, DECKS);
    d->path[d->n] = strdup(found.gl_pathv[i]);
    d->text[d->n++] = read_all(found.gl_pathv[i]);
  }
  globfree(&found);
}

static void free_decks(deck_texts *d) {
  for (int i = 0; i < d->n; ++i) {
    free(d->text[i]);
    free(d->path[i]);
  }
}

/* ---- edits ------------------------------------------------------------- */

typedef struct range {
  size_t from, to;
} range;

/* The piece of text around a byte that ends at one of these characters. */
static range piece_at(const char *text, size_t byte, const char *ends) {
  range r = {byte, byte};
  while (r.from > 0 && strchr(ends, text[r.from - 1]) == NULL) --r.from;
  while (text[r.to] != '\0' && strchr(ends, text[r.to]) == NULL) ++r.to;
  return r;
}

static range pick(const char *text, int what, unsigned long long *dice) {
  size_t byte = below(strlen(text), dice);
  switch (what) {
    case 0:
      return (range){byte, byte + 1};
    case 1:
      return piece_at(text, byte, " ,=\n");
    case 2:
      return piece_at(text, byte, ",\n");
    default: {
      range r = piece_at(text, byte, "\n");
      if (text[r.to] == '\n') ++r.to;
      return r;
    }
  }
}

/* Text with one edit; the caller frees it. */
static char *mutate(const char *text, unsigned long long *dice) {
  size_t n = strlen(text);
  int what = (int)below(4, dice), how = (int)below(4, dice);
  range a = pick(text, what, dice), b = pick(text, what, dice);
  size_t la = a.to - a.from, lb = b.to - b.from;
  char *out = calloc(2 * n + 8, 1);
  ck_assert_ptr_nonnull(out);
  if (how == 0 || b.from < a.to) { /* delete                                 */
    sprintf(out, "%.*s%s", (int)a.from, text, text + a.to);
  } else if (how == 1) { /* double                                           */
    sprintf(out, "%.*s%s", (int)a.to, text, text + a.from);
  } else if (how == 2) { /* exchange                                         */
    sprintf(out, "%.*s%.*s%.*s%.*s%s", (int)a.from, text, (int)lb,
            text + b.from, (int)(b.from - a.to), text + a.to, (int)la,
            text + a.from, text + b.to);
  } else { /* put the one in the place of the other                          */
    sprintf(out, "%.*s%.*s%s", (int)a.from, text, (int)lb, text + b.from,
            text + a.to);
  }
  return out;
}

/* ---- what the program does with one ------------------------------------ */

/* A grid with the group names of the examples, so that decks get far. */
static mesh *example_mesh(int dim) {
  static const int n[] = {2, 2, 2};
  static const double length[] = {1.0, 1.0, 1.0};
  return dim == 2 ? make_grid_2d(n, length) : make_grid_3d(n, length);
}

static void echo_nowhere(const model *m) {
  FILE *out = fopen("/dev/null", "w");
  if (out == NULL) return;
  model_echo(out, m);
  fclose(out);
}

/* Everything short of solving; what --check does. */
static status check_deck(const char *path, message_log *log, mesh *msh) {
  OWNED deck *d = NULL;
  OWNED model *m = NULL;
  OWNED free_motion *list = NULL;
  int n;
  status st = deck_read(path, 0, NULL, log, &d);
  if (st == OK || st == ERR_DECK) st = model_from_deck(d, log, &m);
  if (st == OK && m->problem.file == NULL)
    st = model_check(m, msh, effects_required);
  if (st == OK && m->problem.file == NULL) {
    st = history_motions(m, msh, effect_table, 0, &n, &list);
    echo_nowhere(m);
  }
  return st;
}

/* Exit code of the child: 0 if refused and ACCEPTED if not, where status and
 * messages agree. */
static int judge(const char *path, int dim) {
  OWNED message_log *log = NULL;
  OWNED mesh *msh = example_mesh(dim);
  if (message_log_new(&log) != OK) return 1;
  status st = check_deck(path, log, msh);
  FILE *out = fopen("/dev/null", "w");
  message_print(log, out);
  fclose(out);
  int errors = message_count(log, ERROR) > 0;
  if (st == ERR_INTERNAL || st == ERR_MEMORY) return 2;
  if (st == OK && errors) return 3;
  if (st != OK && !errors) return 4;
  return st == OK ? ACCEPTED : 0;
}

static int run_child(const char *path, int dim) {
  fflush(NULL);
  pid_t child = fork();
  if (child == 0) {
    alarm(SECONDS);
    _exit(judge(path, dim));
  }
  int how = 0;
  waitpid(child, &how, 0);
  return WIFEXITED(how) ? WEXITSTATUS(how) : 1000 + WTERMSIG(how);
}

static int run_mutant(const deck_texts *d, int which, const char *text,
                      int dim) {
  char folder[64];
  PRINTED(path, "%s/mutant.inp", folder_new(folder));
  FILE *f = fopen(path, "w");
  ck_assert_msg(f != NULL, "%s", path);
  fputs(text, f);
  fclose(f);
  int code = run_child(path, dim);
  folder_remove(folder);
  if (code != 0 && code != ACCEPTED)
    fprintf(stderr, "---- %s: %d\n%s----\n", d->path[which], code, text);
  return code;
}

/* The groups of the grids instead of those of the example. */
static char *with_grid_groups(const char *text) {
  static const char *const names[][2] = {
      {"ELSET=DISC", "ELSET=BODY"},   {"GROUP=CONTACT", "GROUP=BOTTOM"},
      {"GROUP=FOOT", "GROUP=BOTTOM"}, {"GROUP=HEAD", "GROUP=TOP"},
      {"\nSYMMETRY,", "\nLEFT,"},     {"\nAXIS,", "\nLEFT,"},
      {"\nPRESS,", "\nTOP,"},         {"\nHEAD,", "\nTOP,"}};
  char *out = calloc(2 * strlen(text) + 1, 1), *to = out;
  while (*text != '\0') {
    size_t i = 0, n = sizeof names / sizeof *names;
    while (i < n && strncmp(text, names[i][0], strlen(names[i][0])) != 0) ++i;
    if (i < n) {
      to += sprintf(to, "%s", names[i][1]);
      text += strlen(names[i][0]);
    } else {
      *to++ = *text++;
    }
  }
  return out;
}

TEST(no_edit_makes_the_program_fail) {
  deck_texts d = {.n = 0};
  unsigned long long dice = setting("MUTANT_SEED", 20240229);
  long number = (long)setting("MUTANTS", QUICK);
  long accepted = 0, failed = 0;
  read_decks(&d, "input/*/*.inp");
  read_decks(&d, "tests/regression/bad/bad.inp");
  ck_assert_int_ge(d.n, 8);
  for (long k = 0; k < number && failed < 5; ++k) {
    int which = (int)below((size_t)d.n, &dice);
    int dim = strstr(d.path[which], "3d") != NULL ? 3 : 2;
    FREED char *base = with_grid_groups(d.text[which]);
    FREED char *text = mutate(base, &dice);
    int code = run_mutant(&d, which, text, dim);
    accepted += code == ACCEPTED;
    failed += code != 0 && code != ACCEPTED;
  }
  free_decks(&d);
  ck_assert_int_eq(failed, 0);
  /* Enough of both kinds reach the end. */
  ck_assert_int_gt(accepted, number / 20);
  ck_assert_int_lt(accepted, number - number / 20);
  points_end(&(points){.kind = "edited decks", .tried = number});
}

UNIT_MAIN("mutants")
