/*
 * The rows of the effects, and which of them a model requires.
 */
#include "effects/rows.h"

#define EFFECT_PLACE(name) &name##_effect,
const effect_ops *const effect_table[] = {EFFECT_ROWS(EFFECT_PLACE) NULL};

unsigned effects_required(const model *m) {
  unsigned bits = 0;
  for (int k = 0; effect_table[k] != NULL; ++k)
    if (effect_table[k]->bit != NO_BIT && effect_table[k]->required(m, NULL))
      bits |= 1u << effect_table[k]->bit;
  return bits;
}

const char *effect_name(int bit) {
  int k = 0;
  while (effect_table[k]->bit != bit) ++k;
  return effect_table[k]->name;
}

const effect_ops *effect_of_column(const column *c) {
  for (int k = 0; effect_table[k] != NULL; ++k) {
    const effect_ops *e = effect_table[k];
    if (c >= e->columns && c < e->columns + e->n_column) return e;
  }
  return NULL;
}

const effect_ops *effect_of_table(int bit) {
  int k = 0;
  while (effect_table[k]->table.bit != bit) ++k;
  return effect_table[k];
}

stage effect_stage(const effect_ops *e) {
  int k = 0;
  if (e->own != 0) return e->own;
  while (effect_table[k] != e) ++k;
  return timer_own_stage(k, e->name);
}
