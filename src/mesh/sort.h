/* Sorting of ids by 64-bit keys in linear time. Inside src/mesh only. */
#pragma once

#include "base/status.h"

#include <stdint.h>

typedef struct sort_item {
  uint64_t key;
  int id;
} sort_item;

/* Sign of "a stands before b" (-1, 0, 1) for two ids. */
typedef int sort_compare(const void *ctx, int a, int b);

/* Key of two ids. */
static inline uint64_t sort_key(int first, int second) {
  return (uint64_t)first << 32 | (uint64_t)second;
}
/* Sort item[n] by ascending keys; those of equal keys in the order of compare,
 * or as they were if it is NULL. Memory: one copy. */
status sort_items(int n, sort_item *item, sort_compare *compare,
                  const void *ctx);
/* One past the last item with the key of item i of n. */
int sort_run_end(int n, const sort_item *item, int i);
/* Sort plain ids, all >= 0. */
status sort_ids(int n, int *id);
/* Sort a few numbers, as the nodes of an element. */
void sort_few(int n, int *v);
