/*
 * libFuzzer: any text as a number. What is accepted must be finite and come
 * back exactly after writing.
 */
#include "base/number.h"
#include "support/fuzz.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  char *text = malloc(size + 1), written[NUMBER_TEXT_SIZE];
  double x, back;
  int n;
  memcpy(text, data, size);
  text[size] = '\0';
  if (number_real(text, &x) == NULL) {
    if (!isfinite(x)) abort();
    number_text(x, written);
    if (number_real(written, &back) != NULL || back != x) abort();
    if (number_int(text, &n) == NULL && (double)n != x) abort();
  }
  (void)number_bare_exponent(text);
  free(text);
  return 0;
}
