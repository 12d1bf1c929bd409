/*
 * Macros for the rows of all tables of columns; for the files that hold such a
 * table. Signs as in the manual: pressure p = -r_n/area >= 0, forces are those
 * of the obstacle on the body, so f_n = -r_n >= 0 presses, and f_t is opposite
 * to the slip.
 */
#pragma once

#include "run/effect.h"

/* A value is one expression of the view v, the item id and the component. */
#define VALUE(name, expression)                         \
  static double name(const view *v, int id, int part) { \
    return (double)(expression);                        \
  }

/* A word, of the view v and the item id. */
#define WORD_OF(name, expression) \
  static const char *name(const view *v, int id) { return expression; }

/* Place of a component in an array of "stride" components an item. */
static inline size_t at(int stride, int id, int part) {
  return (size_t)stride * (size_t)id + (size_t)part;
}

/* OPEN, SLIP, STICK */
static inline const char *status_word(unsigned k) {
  static const char *const words[] = {"OPEN", "SLIP", "STICK"};
  return k < 3 ? words[k] : "?";
}

/* clang-format off */
/* Needs an effect, also in a build without it. */
#define ON(effect) (1u << EFFECT_BIT_##effect)
#define C ON(CONTACT)
#define F (ON(CONTACT) | ON(FRICTION))
#define INC   PER_INCREMENT, AS_REAL
#define CART (SCENE_PLANE | SCENE_SOLID)
#define ANY SCENE_ALL, 0
#define PA "force/length^2"
#define J "force*length"
#define COLUMNS(table) ((int)(sizeof table / sizeof *table))
/* In a row of the effects, which has them. */
#define COLUMNS_OF(table) .columns = table, .n_column = COLUMNS(table)
/* Components of a vector: x, y in the plane; r, z about an axis; x, y, z. */
#define VECTOR(prefix, unit, of, tables, effects, needs, field, value, help)   \
  {prefix "x", unit, of, tables, effects, CART, needs, field, 0, value, NULL,  \
   help},                                                                      \
  {prefix "r", unit, of, tables, effects, SCENE_AXI, needs, field, 0, value,   \
   NULL, help},                                                                \
  {prefix "y", unit, of, tables, effects, CART, needs, field, 1, value, NULL,  \
   help},                                                                      \
  {prefix "z", unit, of, tables, effects, SCENE_AXI, needs, field, 1, value,   \
   NULL, help},                                                                \
  {prefix "z", unit, of, tables, effects, SCENE_SOLID, needs, field, 2, value, \
   NULL, help}
/* A row: name, unit, entity and form, tables, effects, scenes, needs, field,
 * part, value, word, help. */
/* Place k, from 0, of the columns of the effects in the list of an entity; AT
 * with the tables of a column of an effect: where it stands, else place 0. */
#define OF_EFFECTS(k) {"", NULL, INC, 0, 0, 0, 0, NULL, k, NULL, NULL, NULL}
#define AT(k) ((unsigned)(k) << COLUMN_PLACE)
#define NO_COLUMN {NULL, NULL, INC, 0, 0, 0, 0, NULL, 0, NULL, NULL, NULL}
/* clang-format on */
