/*
 * Entry of a libFuzzer program (make fuzz): any bytes; a broken promise of the
 * code under test ends in abort().
 */
#pragma once

#include <stddef.h>
#include <stdint.h>

/* One input of the fuzzer; always 0. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
/* What HDF5 leaves behind on damaged files is not ours. */
const char *__lsan_default_suppressions(void);
