/*
 * What a model may require besides equilibrium: an effect is one file of
 * src/effects and one row of effect_table. The run calls the hooks of the
 * active effects, in the order of the table:
 *
 *   create -> (begin_step -> (pose -> solve -> found)* -> accept)*
 *
 * Effects that the model does not require are not in the list: nothing of them
 * is allocated, called or counted. Its stage of the timer, its rows in the plan
 * and in COST OF THE EFFECTS, its part of the restart and its columns follow
 * from the row. Any hook may be NULL.
 */
#pragma once

#include "base/timer.h"
#include "run/state.h"

/*
 * A column of the tables and fields: its name, its tables and the function that
 * evaluates it in an accepted increment.
 */
typedef enum {
  PER_INCREMENT,
  PER_CONTACT_NODE,
  PER_CONTACT,
  PER_NODE,
  PER_ELEMENT,
  PER_ZONE,
  PER_TIP,
  PER_GOAL
} entity;

/* Scenes differ in dimension and in the names of the components. */
enum {
  SCENE_PLANE = 1, /* x, y */
  SCENE_AXI = 2,   /* r, z */
  SCENE_SOLID = 4, /* x, y, z */
  SCENE_LCP = 8,   /* a plain LCP from a file: rows */
  SCENE_FLAT = SCENE_PLANE | SCENE_AXI,
  SCENE_ALL = SCENE_FLAT | SCENE_SOLID
};

/* Arrays of struct state a column reads; without them it is left out. */
enum {
  NEEDS_STRAIN = 1,
  NEEDS_STRESS = 2,
  NEEDS_REACTION = 4,
  NEEDS_SURFACE = 8,
  NEEDS_LIMIT = 16,
  NEEDS_TOTALS = 32,
  NEEDS_PLACE = 64, /* a surface with coordinates, normals, areas */
  NEEDS_DISTANCE = 128,
  NEEDS_TORQUE = 256, /* some contact has an axis */
  NEEDS_ELEM_ERROR = 2048,
  NEEDS_FLOW = 4096,    /* elements whose law flows */
  NEEDS_ALPHA = 8192,   /* that many internal variables */
  NEEDS_SEVERAL = 16384 /* more than one contact */
};

/* Input of a value function. */
typedef struct view {
  const model *m;
  const mesh *msh;
  const state *s;
} view;

/* Motion of contact node id along row a over that of its row, -: next to the
 * tip of a crack, which does not open, the row is a mean with it. */
static inline double view_opening(const view *v, int id, int a) {
  const contact_surface *s = v->s->contacts.surface;
  if (s->share == NULL || !v->m->contacts[s->contact_id[id]].is_crack) return 1;
  return surface_share(s, id, a);
}

typedef enum { AS_REAL, AS_COUNT, AS_WORD } column_form;

/* Of "tables": bits of PRINT_*; above them the place of an effect's column. */
enum { COLUMN_PLACE = 24, COLUMN_TABLES = (1 << COLUMN_PLACE) - 1 };

typedef struct column {
  const char *name; /* header of the table */
  const char *unit; /* "length", "force/length^2", "s", "-" for none */
  entity of;
  column_form form;
  unsigned tables;   /* bits PRINT_* of its tables; 0: none; and AT of
                        column_row.h */
  unsigned effects;  /* shown only if the model has them all */
  unsigned scenes;   /* bits SCENE_* */
  unsigned needs;    /* bits NEEDS_* */
  const char *field; /* dataset of JOB.h5; NULL: none (mesh data, words) */
  int part;          /* component: handed to value, place in the dataset */
  double (*value)(const view *v, int id, int part);
  /* AS_WORD; else NULL */
  const char *(*word)(const view *v, int id);
  const char *help;
} column;

struct run;
typedef struct plan_sizes plan_sizes;   /* src/effects/plan/plan.h */
typedef struct effect_work effect_work; /* the same */

enum { EFFECT_STAGES = 7, NO_BIT = -1 };

/* State of the effect in a copy of the run, which solves a state within the
 * increment: that of the run, with which the copy poses but accepts nothing; a
 * new one; a new one with the same bytes; or that of the hook "copy". */
typedef enum { COPY_BORROWS, COPY_IS_NEW, COPY_IS_EQUAL } effect_copy;

/* Any may be NULL. The stage of the effect is entered around those marked T. */
typedef struct effect_hooks {
  /* *own is new and not NULL, or has been made with the size of the row and is
   * the owner of what is requested here; freed also after a failure. */
  status (*create)(struct run *r, void **own);
  /* 0: initial, accept, show, rewrite have nothing to do at this increment, and
   * are not counted. */
  int (*due)(const struct run *r);
  /* Nothing is solved yet: r->step with its surface, r->loads.start where it is
   * known, else NaN: what of it the run could not solve. */
  status (*check)(struct run *r, void *own);
  /* A step begins, its supports are checked: what is made of r->surface. */
  status (*prepare)(struct run *r, void *own);
  /* Output to the listing before the first increment. */
  void (*describe)(const struct run *r, const void *own, setup_facts *f);
  /* T: r->step has a surface, a matrix, and a solver for its contact. */
  status (*begin_step)(struct run *r, void *own);
  /* T: the increments of a step begin; not where a run goes on within it. */
  status (*start)(struct run *r, void *own);
  /* T: the initial displacements are r->old, posed in r->problem.cp. */
  status (*initial)(struct run *r, void *own);
  /* T: *made = 1: it has made all increments of the step, with a grid of its
   * own. */
  status (*make_step)(struct run *r, void *own, int *made);
  /* T: an attempt at the increment that ends at t begins; r->now may be written
   * to. */
  status (*attempt)(struct run *r, void *own, double t);
  /* T: *made = 1: it has solved the increment that ends at t into r->now. */
  status (*solve)(struct run *r, void *own, double t, int *made);
  /* T: the loads of time t are in r->now.F: what else acts then. */
  status (*load)(struct run *r, void *own, double t);
  /* T: gaps and condensed load of time t are set: what it changes. */
  status (*pose)(struct run *r, void *own, double t);
  /* T: *cp as the solver takes it; u, force [cp->m]: start values, made to fit;
   * *u may be put elsewhere. */
  status (*rewrite)(struct run *r, void *own, contact_problem *cp, double **u,
                    double *force);
  /* From the solution of the rewritten problem to that of cp, into u, force. */
  void (*restore)(struct run *r, void *own, contact_problem *cp, double *u,
                  double *force);
  /* T: r->now is an equilibrium; *again = 1: the problem has changed. */
  status (*found)(struct run *r, void *own, int *again);
  /* T: the increment that ends at t has been solved and will be taken; r->now
   * may be solved again. */
  status (*examine)(struct run *r, void *own, double t);
  /* T: the errors of r->now into r->errors, finally or at an attempt. */
  status (*estimate)(struct run *r, void *own);
  /* T: r->now is an increment of the run, r->old what it started from. */
  status (*accept)(struct run *r, void *own);
  /* Its outputs besides its columns. */
  void (*show)(const void *own, state *s);
  /* The run is complete. */
  void (*end)(struct run *r, void *own);
  /* The contact surface is released, and what depends on it. */
  void (*forget)(struct run *r, void *own);
  /* Both ways, in a group of its own. */
  status (*keep)(struct run *r, void *own, archive *a);
  /* *out: the state for "copy" of the run, of the size of the row. */
  status (*copy)(const struct run *r, const void *own, struct run *copy,
                 void **out);
} effect_hooks;

/* A text to be written; NULL: not needed. */
typedef struct reason {
  char *text;
  size_t size;
} reason;

typedef struct effect_ops {
  const char *name;
  size_t size; /* of the state, zeroed: bytes times count; 0: of "create" */
  size_t (*count)(const struct run *r); /* NULL: 1 */
  effect_copy copy_as;
  int bit; /* EFFECT_BIT_... of the result of required in m->effects, for other
              files; or NO_BIT */
  /* 1: the model requires it; the card or fact that does, or why none does. */
  int (*required)(const model *m, const reason *why);
  /* Work expected before anything is solved; NULL: no row in the plan. */
  effect_work (*expected)(const plan_sizes *s);
  /* Of the hooks; 0: one of its name is made; STAGE_NONE: not timed. */
  stage own;
  stage more[EFFECT_STAGES]; /* of run and outputs that count as it, 0 ends */
  const char *within;        /* the effect that it is part of; no stage then */
  int shadow;                /* 1: stages entered inside a hook are part of
                                it */
  int inside;                /* 1: the hooks enter the stage themselves, where
                                it has work */

  int sums_up; /* 1: what it does adds up over the increments, also without
                  slip or inelastic strains before */
  /* 1: it may move or load contact nodes independently of the loads and
   * supports at the ends of a step. */
  int far;

  /* 1: gives the element strains without stress; NULL: none. */
  int (*strains)(const model *m, int elem_id);

  effect_hooks on;
  struct {     /* *PRINT, of its own; all-zero: none */
    int bit;   /* PRINT_* */
    entity of; /* its rows */
  } table;
  const column *columns; /* [n_column] */
  int n_column;
  int of_state; /* 1: they read struct state alone, also of *CONDENSED PROBLEM,
                   which makes no effects */
  size_t items; /* of the state: the int that counts rows of its own table */
} effect_ops;

/* The table of effects (src/effects/rows.h) is passed in by the caller. */
int effect_is_on(const effect_ops *e, const model *m);

/* The active effects of a run. */
enum { EFFECTS_MOST = 40 };
typedef struct effect_list effect_list;
struct effect_list {
  int n;
  struct {
    const effect_ops *ops;
    stage stage;
    void *state;
    int borrowed; /* 1: of another run */
  } on[EFFECTS_MOST];
};
/* NULL: not on. */
void *effect_state(const effect_list *list, const effect_ops *e);
