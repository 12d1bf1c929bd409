/*
 * THE table of effects: a row of what a run computes and writes is a line here
 * and NAME_effect in a file of its own. Plan, run, outputs and columns go
 * through them in this order.
 */
#pragma once

#include "run/effect.h"

/* clang-format off */
#define EFFECT_ROWS(X) \
  X(finite_elements) X(unilateral_contact) X(pairs) X(moving_obstacle) \
  X(friction) X(tangents) X(nonlocal) X(given_forces) X(slip_history) \
  X(wear) X(velocity) X(initial_state) X(inelastic) X(thermal) \
  X(body_forces) X(stresses) X(reactions) X(second_solutions) X(theorems) \
  X(mesh_error) X(time_error) X(solver_error) X(closed_form) X(goals) \
  X(contact_table) X(totals_table) X(nodes_table) X(elements_table) \
  X(energy_table) X(reactions_table) X(zones) X(loops) X(cracks) X(fields) \
  X(condensed_problems) X(restart) X(listing) X(balance) X(nested) \
  X(warnings)
/* clang-format on */

#define EFFECT_ROW(name) extern const effect_ops name##_effect;
EFFECT_ROWS(EFFECT_ROW)

/* NULL ends. */
extern const effect_ops *const effect_table[];

/* Bits EFFECT_* of those that the model requires. */
unsigned effects_required(const model *m);
const char *effect_name(int bit);
/* The effect whose column it is, or NULL. */
const effect_ops *effect_of_column(const column *c);
/* The effect whose table it is, PRINT_*. */
const effect_ops *effect_of_table(int bit);
stage effect_stage(const effect_ops *e);
