/*
 * Least significant digit first, 11 bits at a time; digits that are the same in
 * all keys are skipped. Runs of equal keys by qsort_r.
 */
#define _GNU_SOURCE /* qsort_r */
#include "mesh/sort.h"

#include "base/memory.h"

#include <stdlib.h>

enum { DIGIT_BITS = 11, DIGITS = 1 << DIGIT_BITS, FEW = 128 };

static void insertion(int n, uint64_t *key, int *id) {
  for (int i = 1; i < n; ++i) {
    uint64_t k = key[i];
    int v = id[i], j = i;
    for (; j > 0 && key[j - 1] > k; --j) {
      key[j] = key[j - 1];
      id[j] = id[j - 1];
    }
    key[j] = k;
    id[j] = v;
  }
}

/* One pass from (key, id) to (to_key, to_id); 0 if nothing would move. */
static int pass(int n, int shift, const uint64_t *key, const int *id,
                uint64_t *to_key, int *to_id) {
  int start[DIGITS] = {0};
  for (int i = 0; i < n; ++i) ++start[(key[i] >> shift) & (DIGITS - 1)];
  if (start[(key[0] >> shift) & (DIGITS - 1)] == n) return 0;
  for (int d = 0, sum = 0; d < DIGITS; ++d) {
    int count = start[d];
    start[d] = sum;
    sum += count;
  }
  for (int i = 0; i < n; ++i) {
    int to = start[(key[i] >> shift) & (DIGITS - 1)]++;
    to_key[to] = key[i];
    to_id[to] = id[i];
  }
  return 1;
}

static status radix(int n, uint64_t *key, int *id) {
  OWNED uint64_t *other_key = NULL;
  uint64_t *from_key = key;
  OWNED int *other_id = NULL;
  int *from_id = id;
  PASS_NEW(other_key, n);
  PASS_NEW(other_id, n);
  for (int shift = 0; shift < 64; shift += DIGIT_BITS) {
    uint64_t *to_key = from_key == key ? other_key : key;
    int *to_id = from_id == id ? other_id : id;
    if (!pass(n, shift, from_key, from_id, to_key, to_id)) continue;
    from_key = to_key;
    from_id = to_id;
  }
  for (int i = 0; i < n && from_key != key; ++i) {
    key[i] = from_key[i];
    id[i] = from_id[i];
  }
  return OK;
}

typedef struct ties {
  sort_compare *compare;
  const void *ctx;
} ties;

static int by_ties(const void *a, const void *b, void *ctx) {
  const ties *t = ctx;
  return t->compare(t->ctx, *(const int *)a, *(const int *)b);
}

status sort_by_key(int n, uint64_t *key, int *id, sort_compare *compare,
                   const void *ctx) {
  if (n <= FEW)
    insertion(n, key, id);
  else
    PASS(radix(n, key, id));
  for (int i = 0, end; compare != NULL && i < n; i = end) {
    for (end = i + 1; end < n && key[end] == key[i];) ++end;
    if (end - i > 1)
      qsort_r(id + i, (size_t)(end - i), sizeof *id, by_ties,
              &(ties){compare, ctx});
  }
  return OK;
}

status sort_ids(int n, int *id) {
  OWNED uint64_t *key = NULL;
  PASS_NEW(key, n);
  for (int i = 0; i < n; ++i) key[i] = (uint64_t)id[i];
  return sort_by_key(n, key, id, NULL, NULL);
}

void sort_few(int n, int *v) {
  for (int i = 1; i < n; ++i)
    for (int j = i; j > 0 && v[j - 1] > v[j]; --j) {
      int t = v[j];
      v[j] = v[j - 1];
      v[j - 1] = t;
    }
}
