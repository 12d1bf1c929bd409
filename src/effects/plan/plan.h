/*
 * The effect plan: what a run computes and writes, which card or fact of the
 * deck calls for it, on how many nodes or elements, and the share of the CPU
 * seconds it is expected to take; after the run what it took, from the stages
 * that belong to it.
 *
 * Shares are of all that follows the mesh: deck, mesh and what gmsh takes are
 * not part of them.
 */
#ifndef PROTIS_PLAN_PLAN_H
#define PROTIS_PLAN_PLAN_H

#include "base/timer.h"
#include "model/model.h"

#include <stdio.h>

/* What the expected work is told from, all known before anything is solved. */
typedef struct plan_sizes {
  int dim, ns, is_flat; /* is_flat: plane or axisymmetric                     */
  double nodes, elements, unknowns; /* unknowns: of the body                  */
  double contact, tangents; /* nodes, tangential unknowns of the contact      */
  double flowing, heated, loaded; /* elements: inelastic, thermal, body force */
  double increments; /* of all steps as the deck has them; of a step with a
                        tolerance at most ADAPTED                             */
  double shown;      /* increments that the output at hand shows              */
  int flows_linearly; /* all laws have a constant Jacobian                    */
  double equilibria; /* contact problems solved on the way                    */
  double factors;    /* matrices factored                                     */
} plan_sizes;

typedef struct plan_row {
  const char *name; /* of the effect                                          */
  char of[80];      /* the group or law it is about, or ""                    */
  int on;
  char why[240];    /* card with file:line, or the fact                      */
  double items;     /* of these it works on; 0: none                         */
  const char *kind; /* "nodes", "elements", "unknowns", "rows"; NULL: none   */
  double calls;     /* of its first stage expected; < 0: not foreseen        */
  double work;      /* expected, operations (work.c)                         */
  double share;     /* of the work of all rows, -                            */
  int n_stage;      /* 0: part of another effect, named by "within"          */
  stage stages[8];  /* whose costs are its own                               */
  const char *within; /* or NULL                                              */
} plan_row;

typedef struct effect_plan {
  int n;
  plan_row *rows; /* [n] owned                                                */
  plan_sizes sizes;
} effect_plan;

/* msh NULL: a condensed problem from a file, of n contacts. *out is new. */
status plan_new(const model *m, const mesh *msh, int n, effect_plan **out);
void plan_free(effect_plan *p); /* accepts NULL */

/* Bytes that a run holds at most beside the mesh, from the sizes alone; nodes:
 * of the contact that are condensed, or < 0: all. msh NULL: as in plan_new. */
typedef struct plan_bytes {
  double factor, contact, rest;
} plan_bytes;
status plan_memory(const model *m, const mesh *msh, double nodes,
                   plan_bytes *b);

/* The plan as a table; lead before each line. */
void plan_print(const effect_plan *p, const char *lead, FILE *f);
/* After the run: calls, and with "cost" CPU seconds, share and bytes beside
 * what was expected. */
void plan_print_cost(const effect_plan *p, int cost, FILE *f);

/* What a row has cost so far: calls of its first stage, the rest of all. */
stage_cost plan_cost(const plan_row *r);
/* CPU seconds of all rows so far. */
double plan_cpu(const effect_plan *p);

/* work.c: expected operations and calls of a row, from the sizes. */
typedef struct effect_work {
  double calls, operations;
} effect_work;
effect_work work_of(const char *row, const plan_sizes *s, double items);
/* Of the factor of the stiffness: multiplications and additions; entries. */
double work_factor_flops(const plan_sizes *s);
double work_factor_entries(const plan_sizes *s);

#endif
