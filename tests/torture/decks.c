/*
 * Random decks that combine effects (tests/decks): each is run, its answer
 * judged by what the test recomputes from the tables, and compared with that
 * of the same deck with two threads, in other units, numbered again, along
 * other axes, by another method, and stopped in its middle and gone on with.
 *
 * DECKS=count,first: how many, from which seed on; DECKS_KEEP=1: what is lost
 * stays in its folder.
 */
#include "decks/twin.h"
#include "support/points.h"
#include "support/unit.h"

typedef struct tally {
  points judged, twin[TWINS], restart;
  long refused, other, touching, slipping, sticking;
} tally;

static void lose(points *p, const random_deck *d, const char *what) {
  points_lose(p, "deck %llu (DECKS=1,%llu): %.250s", d->seed, d->seed, what);
}

/* 1: all that is recomputed agrees. */
static int check_answer(tally *t, const random_deck *d, const job *j,
                        const tables *all) {
  char *sta = job_file(j, "sta"), what[400];
  judgement q;
  judge(d, all, sta, &q);
  free(sta);
  t->touching += q.touching;
  t->slipping += q.slipping;
  t->sticking += q.sticking;
  for (int k = 0; k < CHECKS; ++k) {
    if (q.worst[k] <= 1) continue;
    snprintf(what, sizeof what, "%s is %.3g tolerances off: %s", check_name[k],
             q.worst[k], q.where[k]);
    lose(&t->judged, d, what);
    return 0;
  }
  return 1;
}

/* With which twins a deck is compared: none; in units of powers of two, which
 * leave all bits of decks without powers and exponentials, and numbered again;
 * all. */
typedef enum { ALONE, BITS, ALL_TWINS } extent;

static void check_twins(tally *t, const random_deck *d, const job *j,
                        const tables *all, extent of) {
  char what[400];
  for (int k = 0; k < TWINS; ++k) {
    if (of == BITS && k != POWERS && k != NUMBERS) continue;
    if (k == TURNS && (d->kind == AXISYMMETRIC_ || d->averaged)) continue;
    twin_answer answer = twin_check(d, (twin_kind)k, j, all, what);
    points_try(&t->twin[k]);
    t->refused += answer == TWIN_REFUSED;
    t->other += answer == TWIN_OTHER;
    if (answer == TWIN_OTHER)
      printf("deck %llu: another answer by %s: %s\n", d->seed, twin_name[k],
             what);
    if (answer == TWIN_LOST) lose(&t->twin[k], d, what);
  }
  if (of == BITS) return;
  points_try(&t->restart);
  if (!twin_restart(d, what)) lose(&t->restart, d, what);
}

static void check_deck(tally *t, unsigned long long seed, extent of) {
  random_deck d;
  const deck_text how = {.units = {1, 1, 1}};
  job j = job_begin("deck");
  deck_draw(seed, &d);
  deck_write(&d, &how, &j);
  setenv("GUARD_EDGES", "1", 1); /* tests/preload/guard.c */
  int code = twin_run(&j, ""), good = code == 0;
  unsetenv("GUARD_EDGES");
  tables all = tables_read(&j);
  points_try(&t->judged);
  const char *error = j.errors == NULL ? "" : strstr(j.errors, "error");
  PRINTED(what, "exit %d: %.300s", code, error == NULL ? j.errors : error);
  /* hardening by strain is stiff where there is next to none */
  if (code == 2 && strstr(what, "nor in 2^29 parts") != NULL)
    ++t->refused;
  else if (code != 0)
    lose(&t->judged, &d, what);
  else
    good = check_answer(t, &d, &j, &all);
  if (good && of != ALONE) check_twins(t, &d, &j, &all, of);
  if (!good && getenv("DECKS_KEEP") != NULL)
    printf("deck %llu is kept in %s\n", seed, j.dir);
  else
    job_end(&j);
  tables_free(&all);
  deck_release(&d);
  fflush(stdout);
}

/* The random decks: the first, and how many. */
static long asked(unsigned long long *first) {
  const char *text = getenv("DECKS");
  long count = points_number(3, 0.075);
  *first = getenv("PROTIS_POINTS") == NULL ? 270 : 0;
  if (text != NULL) sscanf(text, "%ld,%llu", &count, first);
  return count;
}

/* check counts the microseconds of a test in 31 bits. */
static int parts(void) {
  unsigned long long first;
  return 1 + (int)(asked(&first) / 500);
}

TESTS(random_decks_hold, parts()) {
  static const char *const kind[TWINS] = {
      "random decks, 2 threads",  "random decks, units 2^k",
      "random decks, units 1000", "random decks, numbered again",
      "random decks, turned",     "random decks, other methods"};
  unsigned long long first;
  const long count = asked(&first);
  const int others = _i == 0 && getenv("DECKS") == NULL;
  tally t = {.judged.kind = "random decks, judged",
             .restart.kind = "random decks, restarts"};
  for (int k = 0; k < TWINS; ++k) t.twin[k].kind = kind[k];
  /* Laws, thermal strains and one body, whose energies are judged. */
  static const unsigned long long alone[] = {315, 316, 320, 344};
  for (size_t k = 0; others && k < sizeof alone / sizeof *alone; ++k)
    check_deck(&t, alone[k], ALONE);
  static const unsigned long long exact[] = {9,  23, 24, 32, 39, 69,
                                             71, 76, 79, 81, 89, 91};
  for (size_t k = 0; others && k < sizeof exact / sizeof *exact; ++k)
    check_deck(&t, exact[k], BITS);
  for (long k = _i; k < count; k += parts())
    check_deck(&t, first + (unsigned long long)k, ALL_TWINS);
  printf(
      "methods that gave up: %ld; other answers: %ld; contact nodes: %ld "
      "slip, %ld stick\n",
      t.refused, t.other, t.slipping, t.sticking);
  points_end(&t.judged);
  for (int k = 0; k < TWINS; ++k) points_end(&t.twin[k]);
  points_end(&t.restart);
}

UNIT_MAIN_FOR("decks", 100 * UNIT_SECONDS)
