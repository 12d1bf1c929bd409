/*
 * The rows of the effects, of all their files.
 */
#include "effects/rows.h"

#define EFFECT_PLACE(name) &name##_effect,
const effect_ops *const effect_table[] = {EFFECT_ROWS(EFFECT_PLACE) NULL};
