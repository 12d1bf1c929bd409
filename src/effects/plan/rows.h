/*
 * What the rows of the plan are made of; for the files of this folder only.
 */
#ifndef PROTIS_PLAN_ROWS_H
#define PROTIS_PLAN_ROWS_H

#include "effects/plan/plan.h"

/* asked.c: the card that asks for it (table: a bit PRINT_* or 0), or why there
 * is none, into why; 1: it is on. */
typedef enum {
  ASKED_ALWAYS,
  ASKED_TABLE,
  ASKED_FIELDS,
  ASKED_CONDENSED,
  ASKED_RESTART,
  ASKED_VELOCITY,
  ASKED_CHECK
} asked_kind;
int asked(asked_kind kind, const model *m, int table, char *why, size_t size);

/* items.c: nodes, elements or rows that an effect works on, *n. */
typedef enum {
  OF_ELEMENTS,
  OF_NODES,
  OF_CONTACT,
  OF_TANGENTS,
  OF_FRICTION,
  OF_AVERAGE,
  OF_GIVEN,
  OF_HEATED,
  OF_LOADED,
  OF_HELD,
  OF_CONTACTS,
  OF_ONE
} items_kind;
status items_of(items_kind kind, const model *m, const mesh *msh,
                const plan_sizes *s, double *n);
/* Nodes that a set of contacts has, each once; "is" NULL: all contacts. */
status items_contact_nodes(const model *m, const mesh *msh,
                           int (*is)(const friction_rule *rule), double *n);
/* Displacements that supports hold in the first step, and their nodes. */
status items_held_unknowns(const model *m, const mesh *msh, double *unknowns,
                           double *nodes);
/* Material of a section; one without anything if it has none. */
const material *plan_material(const model *m, int section_id);

/* sizes.c: all but "shown" and "flowing"; msh and n as in plan_new. */
status sizes_find(const model *m, const mesh *msh, int n, plan_sizes *s);
/* Increments that all steps show: in a table, or 0: in any table or field. */
double sizes_shown(const model *m, int table);

#endif
