/*
 * Bytes of a fuzzer as a file and as choices.
 */
#include "support/fuzz_file.h"

#include "base/base.h"
#include "support/fuzz.h"

#include <unistd.h>

const char *__lsan_default_suppressions(void) { return "leak:libhdf5"; }

const char *fuzz_file(const char *suffix, const uint8_t *data, size_t size) {
  static char name[64];
  snprintf(name, sizeof name, "/dev/shm/protis_fuzz_%d.%s", (int)getpid(),
           suffix);
  FILE *f = fopen(name, "wb");
  if (f == NULL || fwrite(data, 1, size, f) != size) abort();
  fclose(f);
  return name;
}

unsigned fuzz_byte(fuzz_bytes *b) {
  if (b->left == 0) return 0;
  --b->left;
  return *b->at++;
}

int fuzz_below(fuzz_bytes *b, int n) { return (int)fuzz_byte(b) % n; }

/* Any bits of so many bytes. */
static void fill(fuzz_bytes *b, void *to, size_t size) {
  unsigned char *p = to;
  for (size_t i = 0; i < size; ++i) p[i] = (unsigned char)fuzz_byte(b);
}

int fuzz_int(fuzz_bytes *b) {
  int any = (int)fuzz_byte(b);
  if (any < 250) return any % 50 - 5;
  fill(b, &any, sizeof any);
  return any;
}

double fuzz_real(fuzz_bytes *b) {
  double any = (double)fuzz_byte(b);
  if (any < 250) return (any - 100) / 16;
  fill(b, &any, sizeof any);
  return any;
}

int fuzz_damage(const char *path, fuzz_bytes *b) {
  int changed = 0;
  FILE *f = fopen(path, "r+b");
  if (f == NULL) abort();
  fseek(f, 0, SEEK_END);
  long size = ftell(f);
  while (b->left >= 3) {
    long at = (long)(fuzz_byte(b) << 8 | fuzz_byte(b)) % size;
    fseek(f, at, SEEK_SET);
    int old = fgetc(f), flip = (int)fuzz_byte(b);
    fseek(f, at, SEEK_SET);
    fputc(old ^ flip, f);
    changed |= flip != 0;
  }
  fclose(f);
  return changed;
}
