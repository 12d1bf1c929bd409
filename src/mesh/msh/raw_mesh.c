/* Release of a raw mesh; tables of ids. */
#include "mesh/msh/raw_mesh.h"

#include "base/memory.h"

/* Open addressing, at most half of the slots in use. */

uint64_t table_key(int upper, long lower) {
  return (uint64_t)(uint32_t)upper << 32 | (uint32_t)lower;
}

/* The slot of the key, or the empty one where it belongs. */
static size_t slot_of(const key_table *t, uint64_t key) {
  uint64_t spread = key * 0x9E3779B97F4A7C15u;
  size_t s = (spread ^ spread >> 32) & (t->n_slot - 1);
  while (t->id[s] != 0 && t->key[s] != key) s = (s + 1) & (t->n_slot - 1);
  return s;
}

int table_find(const key_table *t, uint64_t key) {
  return t->n_slot == 0 ? -1 : t->id[slot_of(t, key)] - 1;
}

void table_free(key_table *t) {
  RELEASE(t->key, t->id);
  *t = (key_table){0};
}

static status grow(key_table *t) {
  ENDS_BY(table_free)
  key_table more = {.n = t->n, .n_slot = t->n_slot == 0 ? 16 : 2 * t->n_slot};
  PASS_NEW_ALL(OF(more.key, more.n_slot), OF(more.id, more.n_slot));
  for (size_t i = 0; i < t->n_slot; ++i) {
    if (t->id[i] == 0) continue;
    size_t s = slot_of(&more, t->key[i]);
    more.key[s] = t->key[i];
    more.id[s] = t->id[i];
  }
  key_table swapped = *t;
  *t = more;
  more = swapped;
  return OK;
}

status table_add(key_table *t, uint64_t key, int *id) {
  if (2 * (size_t)(t->n + 1) > t->n_slot) PASS(grow(t));
  size_t s = slot_of(t, key);
  if (t->id[s] == 0) {
    t->key[s] = key;
    t->id[s] = ++t->n;
  }
  *id = t->id[s] - 1;
  return OK;
}
