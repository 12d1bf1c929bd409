/*
 * libFuzzer: any bytes as a deck, read with a definition from the command
 * line; every field is used as number, quantity and name of a file, and all
 * messages are printed. Nothing stays allocated.
 */
#include "base/memory.h"
#include "deck/deck.h"
#include "support/fuzz.h"
#include "support/fuzz_file.h"

#include <stdlib.h>

static void use_field(deck *d, const field *f, message_log *log) {
  const double x[3] = {1, 2, 3};
  quantity q;
  double real;
  int whole;
  if (deck_quantity(d, f, NULL, log, &q) == 0) (void)quantity_value(&q, x, 1);
  (void)deck_real(f, log, &real);
  (void)deck_int(f, log, &whole);
  if (deck_path(d, f) == NULL) abort();
}

static void use_deck(deck *d, message_log *log) {
  for (int i = 0; i < d->n_card; ++i) {
    const card *c = &d->cards[i];
    for (int k = 0; k < c->n_parameter; ++k)
      use_field(d, &c->parameters[k].value, log);
    for (int k = 0; k < c->n_record; ++k)
      for (int j = 0; j < c->records[k].n_field; ++j)
        use_field(d, &c->records[k].fields[j], log);
  }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  static FILE *sink;
  static const char *const defines[] = {"Q=2*3", "H=0.5"};
  message_log *log;
  deck *d;
  if (sink == NULL) sink = fopen("/dev/null", "w");
  if (message_log_new(&log) != OK) abort();
  if (deck_read(fuzz_file("inp", data, size), 2, defines, log, &d) != OK)
    abort();
  use_deck(d, log);
  message_print(log, sink);
  message_list(log, WARNING, sink);
  memory_free(d);
  memory_free(log);
  if (memory_in_use() != 0) abort();
  return 0;
}
