/*
 * Sorting of ids by 64-bit keys in linear time. Inside src/mesh only.
 */
#ifndef PROTIS_MESH_SORT_H
#define PROTIS_MESH_SORT_H

#include "base/status.h"

#include <stdint.h>

/* Sign of "a stands before b" (-1, 0, 1) for two ids. */
typedef int sort_compare(const void *ctx, int a, int b);

/* Sort key[n] ascending and id[n] with it; ids of equal keys are put in the
 * order of compare, or stay as they were if it is NULL. Memory: one copy. */
status sort_by_key(int n, uint64_t *key, int *id, sort_compare *compare,
                   const void *ctx);
/* Sort plain ids, all >= 0. */
status sort_ids(int n, int *id);
/* Sort a few numbers, as the nodes of an element. */
void sort_few(int n, int *v);

#endif
