/* src/deck on hostile input: mutated decks, refused memory, large decks. */
#include "support/decks.h"
#include "support/points.h"
#include "support/unit.h"

static const char seed_deck[] =
    "*HEADING\nBlock <N>\n*PARAMETER\nN = 32\nH = 1/<N> ** size\n"
    "*MESH, FILE=\"block <N>.geo\", SCALE=\"<H>*2\"\n*ELASTIC\n130.D3, 0.2\n"
    "*LEGACY, FORMAT=(A4,2(I3,1X),F6.2)\n*BOUNDARY\nTOP   1   2   100\n"
    "*SOLVER, METHOD=SOR,\n  OMEGA=1.5\n*DSLOAD\nTOP, P, \"sin(x)*if(t<1,"
    "t,<H>)\"\nLEFT, P, -<H>,\n 3\n*INCLUDE, INPUT=b.inp\n*END STEP\n";

/* Read every value of a deck in every way. */
static void use_values(read_deck *r) {
  const double x[3] = {1, 2, 3};
  for (int i = 0; i < r->d->n_card; ++i)
    for (int k = 0; k < r->d->cards[i].n_record; ++k) {
      const record *row = &r->d->cards[i].records[k];
      for (int j = 0; j < row->n_field; ++j) {
        quantity q;
        double real;
        int whole;
        if (deck_quantity(r->d, &row->fields[j], NULL, r->log, &q) == 0)
          (void)quantity_value(&q, x, 1);
        (void)deck_real(&row->fields[j], r->log, &real);
        (void)deck_int(&row->fields[j], r->log, &whole);
        ck_assert_ptr_nonnull(deck_path(r->d, &row->fields[j]));
      }
    }
}

TEST(mutated_decks_do_no_harm) {
  static const char alphabet[] = "*,\"<>=()NHx1.E+-^\n\r\t \0\xff";
  char content[2 * sizeof seed_deck];
  unsigned state = 2463534242u;
  size_t before = memory_in_use();
  decks_enter();
  decks_write("b.inp", "4,5\n*PARAMETER\nM=<N>+1\n");
  for (int i = 0; i < points_number(2000, 1.0); ++i) {
    size_t n = sizeof seed_deck - 1;
    memcpy(content, seed_deck, n);
    for (int k = 0; k < 1 + i % 7; ++k) {
      state = state * 1664525u + 1013904223u;
      size_t at = (state >> 8) % n;
      char c = alphabet[(state >> 3) % (sizeof alphabet - 1)];
      if ((state >> 28) % 3 == 0 && n > 1)
        memmove(content + at, content + at + 1, --n - at);
      else
        content[at] = c;
    }
    decks_write_bytes("a.inp", content, n);
    read_deck r = decks_read("a.inp", 0, NULL);
    ck_assert_int_eq(r.st, OK);
    use_values(&r);
    decks_done(&r);
  }
  ck_assert_uint_eq(memory_in_use(), before);
  decks_leave();
}

TEST(a_refused_request_leaves_nothing_behind) {
  static const char *const defines[] = {"Q=2"};
  size_t before = memory_in_use();
  decks_enter();
  decks_write("a.inp", seed_deck);
  decks_write("b.inp", "4,5\n*PARAMETER\nM=<N>+1\nW=<nn>+foo\n");
  for (long k = 1, refused = 1; refused; ++k) {
    message_log *log;
    deck *d;
    ck_assert_int_eq(message_log_new(&log), OK);
    long start = memory_requests();
    memory_refuse(k, 0);
    status st = deck_read("a.inp", 1, defines, log, &d);
    refused = k <= memory_requests() - start;
    memory_refuse(0, 0);
    status all = st != OK ? st : message_status(log, ERR_DECK);
    if (refused)
      ck_assert_int_eq(all, ERR_MEMORY);
    else
      ck_assert_int_eq(st, OK);
    ck_assert_int_eq(d != NULL, st == OK);
    memory_free(d);
    memory_free(log);
    ck_assert_uint_eq(memory_in_use(), before);
  }
  memory_free(NULL);
  decks_leave();
}

enum { BYTES_PER_BYTE = 120 };

/* What is kept of a deck is at most a field (64 bytes) and its text for every
 * comma; a time that grew with the square would be seen as hours. */
TEST(large_decks_take_time_and_room_in_proportion) {
  static const char *const lines[] = {
      "1,2,3,4,5,6,7,8,",    "<N>,<M>,<nope>",       "*A, B=1, B=2, C=<N>",
      "*PARAMETER\nA=1+1+1", "*LEGACY, FORMAT=(I5)", "\"x+\",\"1",
      "<<<<<<<<<<<<<<<<<<<", "*A,B,C,D,E,F,G,H,I,"};
  const size_t size = (size_t)(getenv("PROTIS_POINTS") == NULL ? 1 : 8) << 19;
  decks_enter();
  for (size_t i = 0; i < sizeof lines / sizeof *lines; ++i) {
    FILE *f = fopen("a.inp", "w");
    fputs("*PARAMETER\nN=1, M=2\n*X\n", f);
    for (size_t n = 0; n < size; n += strlen(lines[i]) + 1)
      fprintf(f, "%s\n", lines[i]);
    fclose(f);
    read_deck r = decks_read("a.inp", 0, NULL);
    ck_assert_int_eq(r.st, OK);
    ck_assert_uint_lt(memory_in_use(), BYTES_PER_BYTE * size);
    decks_done(&r);
  }
  decks_leave();
}

UNIT_MAIN("deck_hostile")
