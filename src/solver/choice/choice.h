/*
 * Parts of contact_solve (solver/solver.h): one attempt with one solver in a
 * form it can use, and AUTO, the choice among them.
 */
#ifndef PROTIS_CHOICE_CHOICE_H
#define PROTIS_CHOICE_CHOICE_H

#include "solver/choice/anchor.h"
#include "solver/choice/form.h"
#include "solver/fixed_point.h"
#include "solver/solver.h"

#define SOLVER_COUNT_ONE(name) +1
enum { N_SOLVER = 0 SOLVER_LIST(SOLVER_COUNT_ONE), LOG_SIZE = 1024 };

struct contact_solver {
  solver_choice choice;
  char log[LOG_SIZE];
  /* What belongs to one matrix. */
  contact_problem last;     /* whose matrix it is; borrowed, all-zero: none */
  void *work[N_SOLVER + 1]; /* of solver_list, last of a solver that is not in
                               it; NULL: not set up */
  void *param;              /* defaults of the current method of the chain */
  size_t param_size;
  fixed_point *fixed;
  friction_path *path;
  int path_capacity; /* entries of B allocated */
  other_form other;
  double *full;       /* [m*m] of the blocks, or NULL */
  int inverse_wanted; /* 1: the compliance alone did not suffice */
  anchor held;        /* springs for a body that contact alone holds */
  normal_form normal;
  contact_bodies *bodies;
  double *best_u, *best_r; /* [m] of the attempt with the lowest residual */
  double scale;            /* contact_scale of the problem being solved */
  int sought, proved;      /* a proof that it has no solution */
  archive *from;           /* borrowed: saved data for the workspaces; or
                              NULL */
  char group[80];          /* in it */
};

/* WHILE_PROMISING: AUTO alone, sweeps whose rate is watched. */
typedef enum { PLAIN, ALONG_PATH, WHILE_PROMISING } drive;

/* A solver, its parameters, the loop around it. */
typedef struct attempt {
  const solver_ops *ops;
  const void *param;
  drive how;
  int max_iter;           /* 0: the solver's own limit */
  sweep_promise *promise; /* of sweeps; or NULL */
} attempt;

/* Save or read the data of the workspace of a row of solver_list. */
status attempt_archive(const contact_solver *s, int row, archive *a);
/* One attempt with one solver. STOPPED_UNFIT: it cannot treat the problem, the
 * log says why. rep->outcome and residual are those of the solver. */
status attempt_run(contact_solver *s, const contact_problem *cp,
                   const attempt *a, const solver_listener *listener, double *u,
                   double *r, solver_report *rep);
/* The final outcome: only the residual of the given problem counts. */
void attempt_check(const contact_solver *s, const contact_problem *cp,
                   const double *u, const double *r, solver_report *rep);
/* After a failure: STOPPED_RAY if it is proved that there is no solution
 * (proof.h), and only then; of a large sparse compliance none is sought. */
status attempt_prove(contact_solver *s, const contact_problem *cp,
                     solver_report *rep);
/* Cold start: stick, no penetration; r = A u - f. */
void cold_start(const contact_problem *cp, double *u, double *r);

enum { MOST_FULL = 5000 }; /* m of a sparse compliance of which all is made */
static inline int is_large_sparse(const contact_problem *cp) {
  return cp->blocks != NULL && cp->m > MOST_FULL;
}

/* METHOD=AUTO (auto.c), as contact_solve. */
status auto_solve(contact_solver *s, const contact_problem *cp,
                  const solver_listener *listener, double *u, double *r,
                  solver_report *rep);

#endif
