/*
 * Whether a contact problem with friction has more than one solution: several
 * methods from several starts, or all combinations of statuses.
 */
#pragma once

#include "solver/solver.h"

typedef struct solution_facts {
  double residual; /* contact_residual, - */
  double distance; /* |u - u_first|_A over the larger norm of the two, - */
  int n_open, n_slip, n_stick;
  /* u_n, u_t1 over the nodes, m */
  double lowest[2], highest[2];
  int patterns; /* attempts or status combinations that found it */
  int joined;   /* number (from 1) of another solution: all states between the
                   two are solutions as well; 0: none */
} solution_facts;

typedef struct solution {
  double *u, *r;          /* [m] contact frame, m, N; owned */
  contact_status *status; /* [n] owned */
  solution_facts facts;
} solution;

/* One solver from one start. */
typedef struct solution_attempt {
  const char *solver, *family, *start;
  outcome outcome;
  double residual;
  int solution_no; /* from 1; 0: none */
} solution_attempt;

typedef struct solution_set {
  int n; /* nodes of the problem */
  int n_found, cap_found;
  solution *found; /* [n_found] owned; first that of the run, if any */
  int n_attempt, cap_attempt;
  solution_attempt *attempts; /* [n_attempt] owned */
  long n_pattern;             /* status combinations tried; 0: not enumerated */
  int n_undecided;            /* singular ones with solutions of unknown
                                 extent */
} solution_set;

/* 1: found by more than the first method: by a solver of another family, or the
 * enumeration. */
int solution_set_confirmed(const solution_set *s);
void solution_set_free(solution_set *s); /* accepts NULL, all zero */
/*
 * Add (u, r) if it is a solution to "tol" and not yet there; *no its number
 * from 1, 0: it is none. "r" may differ from A u - f by rounding.
 */
status solution_set_add(const contact_problem *cp, double tol, const double *u,
                        const double *r, solution_set *s, int *no);

/*
 * second.c: solvers of other families, each from several starts, in addition to
 * the solution (u, r) of "report". Any form of problem. Errors: ERR_MEMORY.
 */
status solutions_by_solvers(const contact_problem *cp, double tol,
                            const solver_report *report, const double *u,
                            const double *r, solution_set *out);

enum { ENUMERATED_NODES = 10 };
/*
 * enumerate.c: all status combinations of a problem in 2-D with at most
 * ENUMERATED_NODES nodes; (u, r) is the solution of the run. ERR_DECK, with the
 * reason in the record: the problem is larger or of another kind.
 */
status solutions_can_try(int dim, int n, int corner); /* the same of its size */
status solutions_by_statuses(const contact_problem *cp, double tol,
                             const double *u, const double *r,
                             solution_set *out);
