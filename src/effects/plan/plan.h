/*
 * The effect plan: what a run computes and writes, which card or fact of the
 * deck calls for it, on how many nodes or elements, and the share of the CPU
 * seconds it is expected to take; after the run what it took, from the stages
 * that belong to it.
 *
 * Shares are of all that follows the mesh: deck, mesh and what gmsh takes are
 * not part of them.
 */
#pragma once

#include "run/effect.h"

#include <stdio.h>

/* Input of the expected work, all known before anything is solved. */
struct plan_sizes {
  const model *m;
  const mesh *msh;                  /* NULL: a condensed problem from a file */
  int dim, ns, is_flat;             /* is_flat: plane or axisymmetric */
  double nodes, elements, unknowns; /* unknowns: of the body */
  double contact, tangents;         /* nodes, tangential unknowns */
  double friction, averages;        /* contact nodes with such a rule */
  double held;                      /* nodes with a support */
  double increments;                /* of all steps of the deck, ADAPTED at most
                                       of one with a tolerance */
  double shown;                     /* of them, by any table or field */
  int flows_linearly;               /* all laws have a constant Jacobian */
  double equilibria;                /* contact problems solved on the way */
  double factors;                   /* matrices factored */
};

/* Expected of a row: operations of about a nanosecond of one core (sizes.c). */
struct effect_work {
  double items;     /* that it works on */
  const char *kind; /* "nodes", "elements", "unknowns", "rows"; NULL: none */
  double calls;     /* of its first stage; < 0: not estimated */
  double operations;
};

typedef struct plan_row {
  const char *name; /* of the effect */
  char of[80];      /* the group or law it is about, or "" */
  int on;
  char why[240];      /* card with file:line, or the fact */
  effect_work work;   /* all zero: off */
  double share;       /* of the work of all rows, - */
  int n_stage;        /* 0: part of another effect, named by "within" */
  stage stages[8];    /* whose costs are its own */
  const char *within; /* or NULL */
} plan_row;

typedef struct effect_plan {
  int n;
  plan_row *rows; /* [n] owned */
  plan_sizes sizes;
} effect_plan;

/* msh NULL: a condensed problem from a file, of n contacts. *out is new. */
status plan_new(const model *m, const mesh *msh, int n, effect_plan **out);
/* After model_check: the error of the mesh that no card requires is left out
 * where it is expected to take more than PLAN_CHEAP of the run. */
#define PLAN_CHEAP 0.05
status plan_leave_out(model *m, const mesh *msh);

/* Bytes that a run holds at most besides the mesh, from the sizes alone; nodes:
 * of the contact that are condensed, or < 0: all; choice NULL: DENSE. msh NULL:
 * as in plan_new. */
typedef struct plan_bytes {
  double factor, contact, rest;
} plan_bytes;
status plan_memory(const model *m, const mesh *msh, double nodes,
                   const stiffness_choice *choice, plan_bytes *b);
/* ERR_MEMORY: n contact nodes would need more than the available memory. */
status plan_expect(const model *m, const mesh *msh, int n,
                   const stiffness_choice *choice);

/* The plan as a table; lead before each line. */
void plan_print(const effect_plan *p, const char *lead, FILE *f);
/* After the run: calls, and with "cost" CPU seconds, share and bytes next to
 * the expected ones. */
void plan_print_cost(const effect_plan *p, int cost, FILE *f);

/* Cost of a row so far: calls of its first stage, the rest of all. */
stage_cost plan_cost(const plan_row *r);
/* CPU seconds of all rows so far. */
double plan_cpu(const effect_plan *p);

/* The first rule that "is"; "none": there is no such rule. */
int plan_requires_rule(const model *m, int (*is)(const friction_rule *rule),
                       const char *none, const reason *why);
/* Material of a section; one without anything if it has none. */
const material *plan_material(const model *m, int section_id);
/* Elements of a section. */
double plan_section_elements(const plan_sizes *s, int section_id);
/* Increments that all steps show: in a table, or 0: in any table or field. */
double plan_shown(const model *m, int table);
/* "on", with the reason as by snprintf. */
int plan_says(int on, const reason *why, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* 1, with what requires it and its place. */
int plan_at(const reason *why, const place *at, const char *format, ...)
    __attribute__((format(printf, 3, 4)));
/* An estimate of *ACCURACY that the first step that "is" requires. */
int plan_requires_accuracy(const model *m, const char *word,
                           int (*is)(const step *s), const reason *why);
/* 1: some *PRINT has the table. */
int plan_requires_table(const model *m, int table, const reason *why);
/* Rows of a table of "all": all of whose requests name a group, the largest. */
double plan_rows(const plan_sizes *s, int table, double all);
effect_work plan_table(const plan_sizes *s, int table, double all);
/* Operations of all tables and fields. */
double plan_output(const plan_sizes *s);
double plan_contact_unknowns(const plan_sizes *s);
double plan_element_work(const plan_sizes *s); /* a pass over one */
/* Condensed matrix of n unknowns, and the problems solved with it. */
double plan_contact_work(const plan_sizes *s, double n);
/* Of the factor of the stiffness: multiplications and additions; entries. */
double work_factor_flops(const plan_sizes *s);
double work_factor_entries(const plan_sizes *s);
/* sizes.c: the increments, body and contact of a model; msh, n: plan_new. */
status plan_sizes_find(const model *m, const mesh *msh, int n, plan_sizes *s);

enum { PLAN_STEPS = 5 };                   /* of Newton's method a problem */
enum { PLAN_SPARSE = 4, PLAN_DENSE = 10 }; /* flops an operation */
