/*
 * Least significant digit first, 11 bits at a time; digits that are the same in
 * all keys are skipped. Runs of equal keys by qsort_r.
 */
#define _GNU_SOURCE /* qsort_r */
#include "mesh/sort.h"

#include "base/base.h"

enum { DIGIT_BITS = 11, DIGITS = 1 << DIGIT_BITS, FEW = 128 };

static void insertion(int n, sort_item *item) {
  for (int i = 1, j; i < n; ++i) {
    const sort_item x = item[i];
    for (j = i; j > 0 && item[j - 1].key > x.key; --j) item[j] = item[j - 1];
    item[j] = x;
  }
}

/* One pass from one array to another; 0 if nothing would move. */
static int pass(int n, int shift, const sort_item *from, sort_item *to) {
  int start[DIGITS] = {0};
  for (int i = 0; i < n; ++i) ++start[(from[i].key >> shift) & (DIGITS - 1)];
  if (start[(from[0].key >> shift) & (DIGITS - 1)] == n) return 0;
  for (int d = 0, sum = 0; d < DIGITS; ++d) {
    int count = start[d];
    start[d] = sum;
    sum += count;
  }
  for (int i = 0; i < n; ++i)
    to[start[(from[i].key >> shift) & (DIGITS - 1)]++] = from[i];
  return 1;
}

static status radix(int n, sort_item *item) {
  sort_item *from = item;
  OWNED_NEW(sort_item, other, n);
  for (int shift = 0; shift < 64; shift += DIGIT_BITS) {
    sort_item *to = from == item ? other : item;
    if (pass(n, shift, from, to)) from = to;
  }
  if (from != item) COPY(item, from, n);
  return OK;
}

int sort_run_end(int n, const sort_item *item, int i) {
  int end = i + 1;
  while (end < n && item[end].key == item[i].key) ++end;
  return end;
}

typedef struct ties {
  sort_compare *compare;
  const void *ctx;
} ties;

static int by_ties(const void *a, const void *b, void *ctx) {
  const ties *t = ctx;
  return t->compare(t->ctx, ((const sort_item *)a)->id,
                    ((const sort_item *)b)->id);
}

status sort_items(int n, sort_item *item, sort_compare *compare,
                  const void *ctx) {
  if (n <= FEW)
    insertion(n, item);
  else
    PASS(radix(n, item));
  for (int i = 0, end; compare != NULL && i < n; i = end) {
    end = sort_run_end(n, item, i);
    if (end - i > 1)
      qsort_r(item + i, end - i, sizeof *item, by_ties, &(ties){compare, ctx});
  }
  return OK;
}

status sort_ids(int n, int *id) {
  OWNED_NEW(sort_item, item, n);
  for (int i = 0; i < n; ++i) item[i] = (sort_item){(uint64_t)id[i], id[i]};
  PASS(sort_items(n, item, NULL, NULL));
  for (int i = 0; i < n; ++i) id[i] = item[i].id;
  return OK;
}

void sort_few(int n, int *v) {
  for (int i = 1; i < n; ++i)
    for (int j = i; j > 0 && v[j - 1] > v[j]; --j) {
      int t = v[j];
      v[j] = v[j - 1];
      v[j - 1] = t;
    }
}
