/*
 * Solvers of the contact problem: one file and one row in SOLVER_LIST each. A
 * solver works on one contact_problem; contact_solve adds the fixed point on
 * the sliding limit where the solver handles Tresca friction only (CPR98, 2.3),
 * the check by contact_residual, the fallback chain of AUTO.
 */
#pragma once

#include "base/archive/archive.h"
#include "base/option.h"
#include "contact/contact.h"

typedef struct solver_report {
  outcome outcome;
  int iterations;     /* sweeps, pivots or steps */
  int limit_updates;  /* passes of the fixed point on g */
  double rate;        /* contraction of the fixed point, -; 0: not used */
  double residual;    /* contact_residual(), - */
  double cpu;         /* s */
  const char *solver; /* the method that converged */
} solver_report;

/* The linear system of an iteration; unknowns 0: none, or not told. */
typedef struct linear_work {
  double unknowns; /* of the matrix */
  double entries;  /* of the factor in use */
  int solves;      /* with the factor */
  double cpu;      /* s */
} linear_work;

/* One line per iteration, for .cvg; NULL: no listener. */
typedef struct solver_step {
  const char *solver;
  int iteration, limit_update;
  double residual;     /* the error measure of the method, -; NAN: none */
  double limit_change; /* change of the sliding limit, relative; NAN: none */
  int status_changes;  /* nodes; -1: unknown */
  int cycle;           /* 1: a status pattern was repeated */
  linear_work linear;
} solver_step;
typedef struct solver_listener {
  void (*step)(void *ctx, const solver_step *s);
  void *ctx;
} solver_listener;

/* Sweeps go on while their rate, observed over "every" of them, predicts the
 * answer within "most". */
typedef struct sweep_promise {
  int every;
  double most;
  int from;            /* sweep of the last look */
  double before, best; /* lowest residual there, now; 0: none yet */
} sweep_promise;
/* After sweep k: 1: go on. p NULL: always. */
int solver_promises(sweep_promise *p, int k, double residual, double tol);

/* Control parameters of every solver, besides its own options. */
typedef struct solver_control {
  double tol;                      /* wanted contact_residual, - */
  int max_iter;                    /* 0: the solver's own limit */
  int limit_max_iter;              /* passes of a fixed point on g; 0: 200 */
  double scale;                    /* contact_scale; 0: not known */
  int no_restart;                  /* 1: stop rather than start again from
                                      another guess */
  int limit_update;                /* pass now running, for the listener */
  sweep_promise *promise;          /* of sweeps; or NULL */
  const solver_listener *listener; /* or NULL */
} solver_control;

enum {
  SOLVES_TRESCA = 1,
  SOLVES_COULOMB = 2, /* g = g0 + B p directly */
  SOLVES_3D = 4,
  NEEDS_STIFFNESS = 8,
  NEEDS_COMPLIANCE = 16,
  SOLVES_FLOATING = 32,    /* works with a semidefinite A */
  REGULAR_COMPLIANCE = 64, /* instead of the stiffness a compliance that has an
                              inverse, which need not be made */
  SPARSE_COMPLIANCE = 128, /* the compliance in blocks */
  FLOATS_BY_OPERATOR = 256 /* with a semidefinite A that is an operator */
};

typedef struct solver_ops {
  const char *name;    /* METHOD= in lower case; what the manual tells
                          of it stands in src/manual/methods.txt */
  const char *family;  /* kind of method: two of one family share their
                          weaknesses */
  unsigned handles;    /* bits above */
  const char *entries; /* the method and why it needs the entries of
                          A; NULL: an operator (contact/operator.h)
                          suffices */
  size_t param_size, work_size;
  const option *options;
  /* Once per matrix; par: [param_size]; work: the private state, [work_size]
   * zeroed (solver_set_up), and the owner of all that is requested here. */
  status (*setup)(const contact_problem *cp, const void *par, void *work);
  /* u[m] start value, then solution; r[m] start value, then reaction. */
  status (*solve)(const contact_problem *cp, const void *par, void *work,
                  const solver_control *control, double *u, double *r,
                  solver_report *rep);
  /* Save or read the data of the workspace that persist from one solve to the
   * next and do not follow from the matrix; NULL: none. */
  status (*keep)(void *work, archive *a);
} solver_ops;

/* What follows from the name of a method: its structs NAME, NAME_work, options
 * and functions. */
#define SOLVER_OF(NAME)                                                        \
  .name = #NAME, .param_size = sizeof(NAME), .work_size = sizeof(NAME##_work), \
  .options = NAME##_options, .setup = NAME##_setup, .solve = NAME##_solve

/* The first row of a family stands for it. */
#define SOLVER_LIST(X) \
  X(newton) X(lemke) X(sor) X(pcg) X(auglag) X(aitken) X(lagrange) X(proximal)
#define SOLVER_EXTERN(name) extern const solver_ops name##_solver;
SOLVER_LIST(SOLVER_EXTERN)
extern const solver_ops *const solver_list[];    /* NULL at the end */
const solver_ops *solver_find(const char *name); /* case ignored; or NULL */
/* Family of the solver of that name; "direct" if none was needed (NULL too). */
const char *solver_family(const char *name);

/* ---- functions common to the solvers ---- */

/* A new workspace (memory_free); *work is NULL after a failure. */
status solver_set_up(const solver_ops *ops, const contact_problem *cp,
                     const void *par, void **work);

/* 1: the tolerance is so loose (TOL=BALANCED) that an iterate within it is
 * accepted, even where one more step would be exact. */
int solver_few_digits(double tol);
/* 1: a residual below nine tenths of that of the last progress, *mark. */
int solver_progresses(double *mark, double residual);
/* To the listener, with the pass of the limit. */
void solver_report_all(const solver_control *control, const solver_step *s);
void solver_report_step(const solver_control *control, const char *solver,
                        int iteration, double residual);
/* The same with the nodes that changed their state, and whether a pattern of
 * states was repeated. */
void solver_report_states(const solver_control *control, const char *solver,
                          int iteration, double residual, int changes,
                          int cycle);
/* The iterate with the lowest residual. */
typedef struct best_iterate {
  double residual; /* -; HUGE_VAL: none yet */
  double *u, *r;   /* [m] */
} best_iterate;
status best_iterate_new(int m, best_iterate *best);
void solver_keep_best(best_iterate *best, int m, double residual,
                      const double *u, const double *r);
/* Copy it to u, r if there is one; its residual. */
double solver_take_best(const best_iterate *best, int m, double *u, double *r);

/* How the solver knows the condensed stiffness: by the expected cost, its
 * entries, or products and solves (contact/operator.h). */
typedef enum {
  STIFFNESS_AUTO,
  STIFFNESS_DENSE,
  STIFFNESS_FACTOR
} stiffness_kind;

/* The choice of the deck: one solver, or AUTO (ops NULL). */
typedef struct solver_choice {
  const solver_ops *ops; /* NULL: AUTO */
  const void *param;     /* [ops->param_size], NULL for AUTO */
  double tol;            /* - */
  int max_iter;          /* of the solver; 0: its own limit */
  int limit_max_iter;    /* passes of the fixed point */
  int stiffness;         /* stiffness_kind */
  double max_memory;     /* MB that STIFFNESS=AUTO keeps below; 0: not said */
} solver_choice;

/* Workspace that persists while A is unchanged. */
typedef struct contact_solver contact_solver;
status contact_solver_new(const solver_choice *choice, contact_solver **out);
void contact_solver_free(contact_solver **s);
/* Replace the tolerance of the choice. */
void contact_solver_tolerance(contact_solver *s, double tol);
/*
 * Solve cp from the start values u[m], r[m]. rep->outcome > 0 only if
 * contact_residual, recomputed from the returned u and r, is at most tol.
 * Errors: ERR_MEMORY; ERR_SINGULAR never (read rep->outcome).
 */
status contact_solve(contact_solver *s, const contact_problem *cp,
                     const solver_listener *listener, double *u, double *r,
                     solver_report *rep);
/* Data of the solver that persist from solve to solve: saved, or read for the
 * next solve; a is then borrowed, in its present group, until a reset. */
status contact_solver_keep(contact_solver *s, archive *a);
/* The bodies of a problem with the matrix solved last; else NULL. Borrowed. */
const contact_bodies *contact_solver_bodies(const contact_solver *s,
                                            const contact_problem *cp);
/* The methods tried, "newton: cycle, sor: converged"; "" if only one. */
const char *contact_solver_log(const contact_solver *s);
