/*
 * Data of a run for the listing and JOB.json: options, increments, passes,
 * sizes, error budget.
 */
#pragma once

#include "run/history/history.h"
#include "effects/plan/plan.h"
#include "output/columns/columns.h"
#include "base/text.h"

typedef struct output_options {
  const char *dir;     /* folder of the results; NULL or "": the current one */
  int no_timing;       /* leave out the cost columns */
  char **closing;      /* lines for the end on a terminal, for free(); or
                          NULL */
  int progress;        /* a line on the terminal, if stderr is one */
  const char *version; /* of the program, for the results; NULL: "" */
  const char *kernel;  /* BLAS kernel, for the results; NULL: "" */
  int threads;         /* threads of the run, for the results */
  archive *from;       /* continue the files of an earlier run; NULL: new
                          ones */
  int n_problem;       /* contacts of a *CONDENSED PROBLEM */
  history_sink first;  /* called before the writers; of its functions
                          checkpoint, ready, increment, each may be NULL */
} output_options;

/* A pass towards TARGET= of *ACCURACY or *GOAL. */
enum { MAX_PASS_ROWS = 20 };
typedef struct pass_row {
  double unknowns;
  double mesh, time, solver, total; /* %, estimated errors */
  double cpu;                       /* s, of the pass */
  char change[80];                  /* what the next pass has changed, "" */
} pass_row;

/* A goal after a pass, in its unit. */
typedef struct pass_goal {
  goal_result found;
  double off;     /* |error| + band + |solver|; aims.c */
  double allowed; /* its target */
} pass_goal;

typedef struct increment_summary {
  int step_no, increment_no, attempt;
  double t, dt;
  struct {
    int open, slip, stick;
  } count;
  int iterations, settled, after_miss, outcome;
  double residual, defect;
  error_bound error;
  rounding_loss rounding;
  int jumps; /* 1: the equilibrium jumps, at jump_t, s */
  double jump_t;
  int checked, n_solution;   /* by CHECK= of *SOLVER */
  solution_facts *solutions; /* [n_solution] owned */
  error_share mesh_error, time_error;
  true_error exact;
  balance_report balance;
  theorems_report theorems; /* its contacts are owned */
} increment_summary;

typedef struct pass_table {
  double target; /* % of the energy norm; 0: goals alone */
  int n;         /* 0: no target */
  const pass_row *rows, *forecast;
  const pass_goal *goals; /* [n*n_goal]; NULL: there are none */
  const char *why;        /* the target is missed, or "" */
} pass_table;

typedef struct run_summary {
  pass_table passes;
  int facts_known;
  setup_facts facts;
  int n_increment, capacity, n_rejected, n_unsettled;
  increment_summary *increments;       /* [n_increment] */
  double residual_worst, defect_worst; /* - ; the defect relative */
  double penetration_worst;            /* m, of all contact nodes */
  double *ends;                        /* [n_step * job_end_size] owned: see
                                          job_end_column */
  goal_result *goals;                  /* [n_step*n_goal] owned: at the last
                                          increment so far of each step */
  flow_tally tally;                    /* points with a threshold */
  status verdict;
  const char *message; /* of a failed run, or "" */
} run_summary;

/* One line of the error budget: what, its last and largest estimate, CPU
 * seconds of the stages that determine it, and of its estimate. */
typedef struct budget_row {
  const char *name, *json;
  double last, worst;        /* %, of the energy norm; NAN: unknown */
  double reached, estimated; /* s */
} budget_row;
enum { BUDGET_ROWS = 4 };

typedef struct job {
  const model *m;
  const mesh *msh;
  const output_options *o;
  const run_summary *run;
  const effect_plan *plan; /* of the effects */
} job;

/* The numbers of the table TOTALS that the model has, one after another: for
 * each step run_summary.ends has the number (0: none) and the time of its last
 * increment so far, then contact by contact the values of these columns. */
const column *job_end_column(const model *m, column_walk *w);
/* The larger; NaN, an increment without estimate, stays: it is seen. */
double job_worse(double a, double b);
/* Numbers of a step there. */
size_t job_end_size(const model *m);
/* goals.c: goal "id" at the last increment so far of the last step that has
 * one; NULL: none. */
const goal_result *job_goal(const job *j, int id);
/* passes.c: the errors of all goals after pass number "pass" of "goals" as
 * columns, and their heads. The error of one, % of its value. */
void passes_goal_heads(const model *m, FILE *f);
void passes_goals(const model *m, const pass_goal *goals, int pass, FILE *f);
double pass_goal_percent(const pass_goal *g);
/* One sentence: the error to improve next, and what that costs; "": none is
 * known. */
enum { ADVICE_SIZE = 320 };
void job_advice(const job *j, char *text, size_t size);
/* The estimates there are; number of rows. */
int job_budget(const job *j, budget_row rows[BUDGET_ROWS]);
/* Saving by TOL=BALANCED in all increments with an estimate. */
typedef struct balance_sum {
  int asked;
  double iterations, saved_iterations, saved_cpu; /* made; about; s */
} balance_sum;
balance_sum job_balance(const job *j);
/* Increments that dt of the deck would make in the steps with TIME=BALANCED; 0:
 * there is none. Those made in them. */
double job_increments_of_deck(const job *j, int *made);
/* Sum of the estimates over the true error, last increment; NAN: unknown. */
double job_effectivity(const job *j);

/* Sizes of model and equations for listing and JSON, NULL ends; returns the
 * number of those of the model, which come first. */
typedef struct size_row {
  const char *name;
  double value;
} size_row;
enum { SIZE_ROWS = 20 };
int job_sizes(const job *j, size_row rows[SIZE_ROWS]);

/* JOB.lst, block by block. ERR_FILE if it cannot be written. */

/* Deck, model, effects. */
status listing_open(const job *j, text_file *lst);
/* The deck again where a restart has another than "was", its echo. */
status listing_again(const job *j, const char *was, text_file *lst);
/* The equations, once they are factored. */
status listing_ready(const job *j, text_file *lst);
/* An initial state that is given. */
status listing_start(const job *j, const start_report *s, text_file *lst);
/* An increment taken; tables at a time within one; an attempt cut. */
status listing_increment(const job *j, const state *s, text_file *lst);
status listing_between(const state *s, text_file *lst);
status listing_rejected(const state *s, const char *why, text_file *lst);
/* Warnings, accuracy, cost. */
status listing_summary(const job *j, text_file *lst);
/* The exit code, in one piece: all of it or nothing. */
status listing_end(const job *j, text_file *lst);

/* budget.c, for the files of this folder: the goals of an increment; at the end
 * budget of the errors, goals, what to improve, passes. */
void listing_goals_now(const job *j, const state *s, FILE *f);
void listing_accuracy(const job *j, FILE *f);
