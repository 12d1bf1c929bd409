/*
 * Bytes of a fuzzer as a file in memory, and as choices.
 */
#pragma once

#include <stddef.h>
#include <stdint.h>

/* The bytes under a name of the process with the suffix; overwritten by the
 * next call with it. */
const char *fuzz_file(const char *suffix, const uint8_t *data, size_t size);

/* The bytes in order, zeros after the last. */
typedef struct fuzz_bytes {
  const uint8_t *at;
  size_t left;
} fuzz_bytes;

unsigned fuzz_byte(fuzz_bytes *b);
int fuzz_below(fuzz_bytes *b, int n); /* 0 .. n-1, n < 256                   */
int fuzz_int(fuzz_bytes *b);          /* mostly small, sometimes any         */
double fuzz_real(fuzz_bytes *b);      /* mostly plain, sometimes any bits    */
/* Change bytes of a file of at most 64 kB, three choices for each; 1 if any. */
int fuzz_damage(const char *path, fuzz_bytes *b);
