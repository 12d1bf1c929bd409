/*
 * libFuzzer: any text as an expression. What compiles is evaluated; what does
 * not is refused inside the text; nothing stays allocated.
 */
#include "base/memory.h"
#include "deck/expression.h"
#include "support/fuzz.h"

#include <stdlib.h>
#include <string.h>

static int symbol(const void *ctx, const char *name, double *value) {
  *value = 3;
  return name[0] == 'H';
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  const double x[3] = {1, -2, 0.5};
  char *text = malloc(size + 1);
  expression *e;
  int column;
  memcpy(text, data, size);
  text[size] = '\0';
  status st = expression_compile(text, symbol, NULL, &e, &column);
  if (st == OK) {
    (void)expression_value(e, x, 0.25);
    if (expression_variables(e) > 15) abort();
  } else if (e != NULL || column < 0 || (size_t)column > strlen(text)) {
    abort();
  }
  memory_free(e);
  if (memory_in_use() != 0) abort();
  free(text);
  return 0;
}
