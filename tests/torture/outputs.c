/*
 * What decks require besides their solution: every example and every hard scene
 * with other tables, fields and error estimates. The run ends as it does with
 * those of the deck, and its increments are the same to the last bit.
 */
#include "scenes/scenes.h"
#include "support/asked.h"
#include "support/points.h"
#include "support/unit.h"

#include <glob.h>

/* An example (its path) or a scene. */
typedef struct source {
  const char *path;
  const scene_row *scene;
} source;

static const char *name_of(const source *s) {
  return s->path != NULL ? s->path : s->scene->name;
}

/* The deck in a new folder with its meshes; caller frees the text. */
static char *prepare(const source *s, job *j) {
  char *text = NULL;
  if (s->path == NULL) {
    *j = job_begin("scene");
    text = malloc(SCENE_DECK);
    ck_assert_ptr_nonnull(text);
    scene_prepare(s->scene, j, text);
    return text;
  }
  PRINTED(name, "%s", strrchr(s->path, '/') + 1);
  *strrchr(name, '.') = '\0';
  *j = job_begin(name);
  job_copy_meshes(j, s->path);
  job_copy(j, s->path);
  text = job_file(j, "inp");
  ck_assert_ptr_nonnull(text);
  return text;
}

static int run_source(const source *s, const asked *a, job *j, char **deck) {
  char name[40], words[200] = "";
  *deck = prepare(s, j);
  FREED char *text = a == NULL ? NULL : asked_deck(*deck, a);
  snprintf(name, sizeof name, "%s.inp", j->name);
  job_write(j, name, "%s", text == NULL ? *deck : text);
  if (s->path != NULL) job_coarsen(s->path, words, sizeof words);
  strcat(words, " --no-timing --quiet");
  return job_run(j, words);
}

/* NULL, or what is wrong with a run. Estimates may find what a plain run does
 * not: that a tolerance is missed, or that the matrix has no inverse. */
static const char *fault(const asked *a, const char *deck, int code,
                         const char *answer, int found, const char *other) {
  const int more = a->accuracy != NULL && (found == 1 || found == 6);
  if (found != code && !more) return "exit code";
  if (found != code || answer == NULL || !asked_keeps(deck, a)) return NULL;
  return other != NULL && strcmp(answer, other) == 0 ? NULL : "another answer";
}

static void try_requests(points *t, const source *s, int first, int n) {
  job whole, j;
  char *deck, *again, text[200];
  const int code = run_source(s, NULL, &whole, &deck);
  FREED char *answer = asked_answer(&whole);
  for (int k = 0; k < n; ++k) {
    const long at = points_spread(k, n, asked_count()) + first;
    const asked a = asked_number((int)(at % asked_count()));
    const int found = run_source(s, &a, &j, &again);
    FREED char *other = asked_answer(&j);
    const char *wrong = fault(&a, deck, code, answer, found, other);
    points_try(t);
    asked_text(&a, text);
    if (wrong != NULL)
      points_lose(t, "%s: %s: %s: exit %d, else %d: %.200s", name_of(s), text,
                  wrong, found, code, j.errors);
    free(again);
    job_end(&j);
  }
  free(deck);
  job_end(&whole);
}

/* n points over all sources: some of them, or each more than once. */
static void try_sources(points *t, long n, int n_source, const source *s) {
  const int each = n > n_source ? (int)(n / n_source) : 1;
  const int tried = n > n_source ? n_source : (int)n;
  for (int k = 0; k < tried; ++k) {
    const int at = (int)points_spread(k, tried, n_source) - 1;
    try_requests(t, &s[at], 5 * at, each);
  }
  points_end(t);
}

TEST(examples_without_outputs) {
  points t = {.kind = "outputs off, examples"};
  glob_t files;
  ck_assert_int_eq(glob("input/*/*.inp", 0, NULL, &files), 0);
  source *s = calloc(files.gl_pathc, sizeof *s);
  ck_assert_ptr_nonnull(s);
  for (size_t i = 0; i < files.gl_pathc; ++i) s[i].path = files.gl_pathv[i];
  try_sources(&t, points_number(2, 0.02), (int)files.gl_pathc, s);
  free(s);
  globfree(&files);
}

TEST(scenes_without_outputs) {
  points t = {.kind = "outputs off, scenes"};
  static const scene_row *row[SCENES];
  static source s[SCENES];
  const int n_row = scenes_list(0, row);
  int n = 0;
  for (int i = 0; i < n_row; ++i)
    if (!(row[i]->flags & LARGE)) s[n++].scene = row[i];
  try_sources(&t, points_number(4, 0.05), n, s);
}

UNIT_MAIN_FOR("outputs", 100 * UNIT_SECONDS)
