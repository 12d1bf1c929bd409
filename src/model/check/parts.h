/*
 * The parts of model_check: groups and contacts (contacts.c), loads and initial
 * conditions (loads.c), values of expressions (values.c), increments against
 * the laws (increments.c), the goals (goals.c). Errors go to the
 * log; a status is of memory. Private to src/model/check.
 */
#ifndef PROTIS_CHECK_PARTS_H
#define PROTIS_CHECK_PARTS_H

#include "model/check/check.h"

/* ---- values.c ---- */

/* Id of a group, or -1 and an error with the nearest name. */
int check_group(const model *m, const mesh *msh, const char *name,
                const place *at);
/* The same, of a wanted dimension. */
int check_group_of(const model *m, const mesh *msh, const char *name, int dim,
                   const place *at);

/* ---- pairs.c ---- */

/* Surfaces of *CONTACT PAIR and *TIE, and their slaves. After check_steps.
 * ERR_MEMORY. */
status check_pairs(model *m, const mesh *msh);

/* ---- loads.c ---- */

/* Groups and components. */
void check_initials(model *m, const mesh *msh);
/* The loads and tables of all steps, each card once. */
void check_steps(model *m, const mesh *msh);
/* The fields of FILE= of *TEMPERATURE, each read once. */
status check_fields(model *m, const mesh *msh);

/* ---- values.c ---- */

/* Where each step begins and ends, what the expressions give is a number; in
 * between it is checked when needed. */
void check_values(const model *m, const mesh *msh);
/* Two groups that share nodes prescribe the same displacement there. */
status check_agreement(const model *m, const mesh *msh, int step_id);

/* ---- increments.c ---- */

/* Increments of *VISCO steps against the laws that do not change. */
status check_visco(const model *m);

/* ---- no_effect.c ---- */

/* Warnings of input without effect. */
void check_no_effect(const model *m, const mesh *msh);

/* ---- goals.c ---- */

/* Their groups and points. */
void check_goals(model *m, const mesh *msh);

#endif
