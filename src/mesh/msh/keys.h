/*
 * Ids by key, a hash table that grows. Inside src/mesh/msh only.
 */
#ifndef PROTIS_MSH_KEYS_H
#define PROTIS_MSH_KEYS_H

#include "base/status.h"

#include <stddef.h>
#include <stdint.h>

typedef struct key_table {
  int n;         /* keys */
  size_t n_slot; /* power of two, or 0 */
  uint64_t *key; /* [n_slot] */
  int *id;       /* [n_slot] id + 1, 0: empty */
} key_table;

uint64_t table_key(int upper, long lower);        /* two 32-bit numbers */
int table_find(const key_table *t, uint64_t key); /* id or -1 */
/* The id of the key; a new key gets the id "n" of before. */
status table_add(key_table *t, uint64_t key, int *id);

#endif
