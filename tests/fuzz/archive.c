/*
 * libFuzzer: restart files. Arrays of any names, kinds and lengths are written;
 * then, by the first byte, they come back as they were, bytes of the file are
 * changed or its end is missing: it is refused, or all arrays are as they were;
 * or other arrays are asked for: refused, or there.
 */
#include "base/archive/archive.h"
#include "base/memory.h"
#include "support/fuzz.h"
#include "support/fuzz_file.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { ARRAYS = 6, MOST = 40 };

typedef struct arrays {
  int n;
  int kind[ARRAYS], length[ARRAYS];
  char name[ARRAYS][16];
  double real[ARRAYS][MOST];
  int whole[ARRAYS][MOST];
} arrays;

static void choose(arrays *a, fuzz_bytes *b) {
  memset(a, 0, sizeof *a);
  a->n = fuzz_below(b, ARRAYS + 1);
  for (int i = 0; i < a->n; ++i) {
    a->kind[i] = fuzz_below(b, 3);
    a->length[i] = fuzz_below(b, MOST);
    snprintf(a->name[i], sizeof a->name[i], "%c%d", 'a' + fuzz_below(b, 3), i);
    for (int k = 0; k < a->length[i]; ++k) {
      a->real[i][k] = fuzz_real(b);
      a->whole[i][k] = fuzz_int(b);
    }
  }
}

/* To the archive or, if it reads, from it into the same place. */
static status serve(archive *at, arrays *a) {
  status st = OK;
  for (int i = 0; i < a->n && st == OK; ++i) {
    size_t n = (size_t)a->length[i];
    if (i % 2 == 1) archive_enter(at, "group");
    if (a->kind[i] == 0) st = archive_reals(at, a->name[i], a->real[i], n);
    if (a->kind[i] == 1) st = archive_ints(at, a->name[i], a->whole[i], n);
    if (a->kind[i] == 2) st = archive_bytes(at, a->name[i], a->real[i], n);
    if (i % 2 == 1) archive_leave(&at);
  }
  return st;
}

static void write_file(arrays *a, const char *path, const char *before) {
  archive *out;
  if (archive_new(&out) != OK || serve(out, a) != OK ||
      archive_write(out, path, before) != OK)
    abort();
  archive_free(&out);
}

/* 1: bytes are gone. */
static int cut(const char *path, fuzz_bytes *b) {
  FILE *f = fopen(path, "rb");
  if (f == NULL) abort();
  fseek(f, 0, SEEK_END);
  long size = ftell(f), left = size * fuzz_below(b, 256) / 255;
  fclose(f);
  if (truncate(path, left) != 0) abort();
  return left < size;
}

enum { AS_IS, DAMAGED, CUT, OTHER, WAYS };

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
  static arrays a, back, other;
  char before[80], path[80];
  fuzz_bytes b = {data, size};
  archive *in = NULL;
  int way = fuzz_below(&b, WAYS), changed = 0;
  snprintf(before, sizeof before, "%s", fuzz_file("rst.old.h5", NULL, 0));
  snprintf(path, sizeof path, "%s", fuzz_file("rst.h5", NULL, 0));
  choose(&a, &b);
  write_file(&a, path, before);
  if (way == DAMAGED) changed = fuzz_damage(path, &b);
  if (way == CUT) changed = cut(path, &b);
  status st = archive_read(path, &in);
  if (!changed && st != OK) abort();
  back = a;
  if (st == OK) st = serve(in, &back);
  if (!changed && st != OK) abort();
  if (st == OK && memcmp(&a, &back, sizeof a) != 0) abort();
  if (way == OTHER) {
    choose(&other, &b);
    if (serve(in, &other) != OK) status_clear();
  }
  archive_free(&in);
  status_clear();
  if (memory_in_use() != 0) abort();
  return 0;
}
