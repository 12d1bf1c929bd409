/*
 * The table of solvers, the verdict, and AUTO: a chain of solvers on the same
 * problem, each from a cold start after the first (solver.h).
 */
#include "solver/solver.h"

#include "base/memory.h"
#include "base/timer.h"
#include "solver/fixed_point.h"

#include <lapacke.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#define SOLVER_ROW(name) &name##_solver,
const solver_ops *const solver_list[] = {SOLVER_LIST(SOLVER_ROW) NULL};

#define SOLVER_COUNT_ONE(name) +1
enum { N_SOLVER = 0 SOLVER_LIST(SOLVER_COUNT_ONE), LOG_SIZE = 512 };
static const double INVERSE_RCOND = 1e-13; /* -, below: no other form        */

/* The order in which AUTO tries: solver, and how it is driven. */
typedef enum { PLAIN, ALONG_PATH } drive;
static const struct {
  const solver_ops *ops;
  drive how;
  int compliance; /* 1: only where no stiffness is given                     */
} auto_chain[] = {{&newton_solver, PLAIN, 0}, {&newton_solver, ALONG_PATH, 0},
                  {&pcg_solver, PLAIN, 1},    {&lagrange_solver, PLAIN, 1},
                  {&sor_solver, PLAIN, 0},    {&lemke_solver, PLAIN, 0}};

const solver_ops *solver_find(const char *name) {
  for (int i = 0; solver_list[i] != NULL; ++i)
    if (strcasecmp(solver_list[i]->name, name) == 0) return solver_list[i];
  return NULL;
}

/* ---- what the solvers share
 * ------------------------------------------------*/

double solver_mismatch(const contact_problem *cp, double scale, const double *u,
                       const double *r) {
  double worst = contact_mismatch(cp, u, r);
  if (isnan(worst) || isnan(scale)) return NAN;
  if (scale > 0.0) return worst / scale;
  return worst > 0.0 ? HUGE_VAL : 0.0;
}

void solver_tell(const solver_control *control, const char *solver,
                 int iteration, double residual) {
  const solver_listener *l = control->listener;
  if (l == NULL || l->step == NULL) return;
  solver_step step = {.solver = solver,
                      .iteration = iteration,
                      .limit_update = control->limit_update,
                      .residual = residual,
                      .limit_change = NAN,
                      .status_changes = -1};
  l->step(l->ctx, &step);
}

status best_iterate_new(int m, best_iterate *best) {
  status st = OK;
  best->residual = HUGE_VAL;
  NEW(best->u, m);
  NEW(best->r, m);
done:
  return st;
}

void best_iterate_free(best_iterate *best) {
  memory_free(best->u);
  memory_free(best->r);
  best->u = best->r = NULL;
}

void solver_keep_best(best_iterate *best, int m, double residual,
                      const double *u, const double *r) {
  if (!(residual < best->residual)) return;
  best->residual = residual;
  memcpy(best->u, u, (size_t)m * sizeof *u);
  memcpy(best->r, r, (size_t)m * sizeof *r);
}

void solver_take_best(const best_iterate *best, int m, double *u, double *r) {
  if (!(best->residual < HUGE_VAL)) return;
  memcpy(u, best->u, (size_t)m * sizeof *u);
  memcpy(r, best->r, (size_t)m * sizeof *r);
}

struct contact_solver {
  solver_choice choice;
  char log[LOG_SIZE];
  /* What belongs to one matrix. */
  const double *A, *W; /* it came with, borrowed; as seen */
  int m, n;
  void *work[N_SOLVER + 1]; /* of solver_list, last of a solver that is not in
                               it; NULL: not set up */
  void *param; /* defaults of the chain member at work                     */
  size_t param_size;
  fixed_point *fixed;
  friction_path *path;
  int path_room;     /* entries of B it was made for                       */
  double *other;     /* [m*m] the form made from the one given, or NULL     */
  double *load;      /* [m] load in that form                             */
  int other_missing; /* 1: it does not exist                               */
  double *best_u, *best_r; /* [m] of the attempt with the lowest residual */
};

status contact_solver_new(const solver_choice *choice, contact_solver **out) {
  status st = OK;
  contact_solver *s = NULL;
  size_t size = 1;
  NEW(s, 1);
  s->choice = *choice;
  for (int i = 0; solver_list[i] != NULL; ++i)
    if (solver_list[i]->param_size > size) size = solver_list[i]->param_size;
  s->param = memory_new(1, size);
  s->param_size = size;
  if (s->param == NULL)
    FAIL(ERR_MEMORY, "memory exhausted: %zu bytes for solver options", size);
  *out = s;
  s = NULL;
done:
  contact_solver_free(s);
  return st;
}

void contact_solver_reset(contact_solver *s) {
  for (int i = 0; i <= N_SOLVER; ++i) {
    const solver_ops *ops = i < N_SOLVER ? solver_list[i] : s->choice.ops;
    if (s->work[i] != NULL) ops->release(s->work[i]);
    s->work[i] = NULL;
  }
  fixed_point_free(s->fixed);
  friction_path_free(s->path);
  s->fixed = NULL;
  s->path = NULL;
  memory_free(s->other);
  memory_free(s->load);
  memory_free(s->best_u);
  memory_free(s->best_r);
  s->other = s->load = s->best_u = s->best_r = NULL;
  s->other_missing = 0;
  s->A = s->W = NULL;
  s->m = s->n = -1;
}

void contact_solver_free(contact_solver *s) {
  if (s == NULL) return;
  contact_solver_reset(s);
  memory_free(s->param);
  memory_free(s);
}

const char *contact_solver_log(const contact_solver *s) { return s->log; }

static status fit(contact_solver *s, const contact_problem *cp) {
  status st = OK;
  if (s->A == cp->A && s->W == cp->W && s->m == cp->m && s->n == cp->n &&
      s->best_u != NULL)
    goto done;
  contact_solver_reset(s);
  NEW(s->best_u, cp->m);
  NEW(s->best_r, cp->m);
  NEW(s->load, cp->m);
  s->A = cp->A;
  s->W = cp->W;
  s->m = cp->m;
  s->n = cp->n;
done:
  return st;
}

/* ---- the other form ---------------------------------------------------- */

/* inv(M) into out[m*m]; 0: singular to rounding. pivot, iwork [m], work [4m] */
static int invert(int m, const double *M, double *out, int *pivot,
                  double *work) {
  double rcond = 0.0;
  memcpy(out, M, (size_t)m * (size_t)m * sizeof *out);
  double norm = LAPACKE_dlange_work(LAPACK_COL_MAJOR, '1', m, m, out, m, work);
  if (LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, m, m, out, m, pivot) != 0) return 0;
  LAPACKE_dgecon_work(LAPACK_COL_MAJOR, '1', m, out, m, norm, &rcond, work,
                      pivot + m);
  if (!(rcond > INVERSE_RCOND)) return 0;
  return LAPACKE_dgetri_work(LAPACK_COL_MAJOR, m, out, m, pivot, work, 4 * m) ==
         0;
}

static status make_other(contact_solver *s, const contact_problem *cp) {
  status st = OK;
  int *pivot = NULL;
  double *work = NULL;
  if (s->other != NULL || s->other_missing) goto done;
  if (cp->floating) {
    s->other_missing = 1;
    goto done;
  }
  NEW(pivot, 2 * cp->m);
  NEW(work, 4 * cp->m);
  NEW(s->other, (size_t)cp->m * (size_t)cp->m);
  if (!invert(cp->m, cp->A != NULL ? cp->A : cp->W, s->other, pivot, work)) {
    memory_free(s->other);
    s->other = NULL;
    s->other_missing = 1;
  }
done:
  memory_free(pivot);
  memory_free(work);
  return st;
}

/* The problem in a form the solver can use. *possible = 0: there is none. */
static status suit(contact_solver *s, const contact_problem *cp,
                   const solver_ops *ops, contact_problem *out, int *possible) {
  status st = OK;
  *out = *cp;
  *possible = 0;
  if (cp->dim == 3 && !(ops->handles & SOLVES_3D)) goto done;
  if (cp->floating && !(ops->handles & SOLVES_FLOATING)) goto done;
  if ((ops->handles & NEEDS_STIFFNESS) && cp->A == NULL) {
    TRY(make_other(s, cp));
    if (s->other == NULL) goto done;
    contact_product(cp->m, s->other, cp->f, s->load);
    out->A = s->other;
    out->f = s->load;
  }
  if ((ops->handles & NEEDS_COMPLIANCE) && cp->W == NULL) {
    TRY(make_other(s, cp));
    if (s->other == NULL) goto done;
    out->W = s->other;
  }
  *possible = 1;
done:
  return st;
}

/* ---- one solver -------------------------------------------------------- */

/* A solver, its parameters, how it is driven. */
typedef struct attempt {
  const solver_ops *ops;
  const void *param;
  drive how;
} attempt;

static int row_of(const solver_ops *ops) {
  int row = 0;
  while (row < N_SOLVER && solver_list[row] != ops) ++row;
  return row;
}

/* The loop around the solver that the problem and the drive ask for. */
static status drive_one(contact_solver *s, const contact_problem *cp,
                        const attempt *a, const solver_control *control,
                        double *u, double *r, solver_report *rep) {
  status st = OK;
  inner_solver inner = {a->ops, a->param, s->work[row_of(a->ops)]};
  if (a->how == ALONG_PATH) {
    int room = cp->B->start[cp->n];
    if (s->path == NULL || s->path_room < room) {
      friction_path_free(s->path);
      s->path = NULL;
      TRY(friction_path_new(cp, &s->path));
      s->path_room = room;
    }
    TRY(friction_path_solve(s->path, cp, &inner, control, u, r, rep));
  } else if (cp->B != NULL && !(a->ops->handles & SOLVES_COULOMB)) {
    if (s->fixed == NULL) TRY(fixed_point_new(cp->n, &s->fixed));
    TRY(fixed_point_solve(s->fixed, cp, &inner, control, u, r, rep));
  } else {
    TRY(a->ops->solve(cp, a->param, inner.work, control, u, r, rep));
  }
done:
  return st;
}

static status run_one(contact_solver *s, const contact_problem *cp,
                      const attempt *a, const solver_listener *listener,
                      double *u, double *r, solver_report *rep) {
  status st = OK;
  contact_problem own;
  int possible = 0, row = row_of(a->ops);
  solver_control control = {.tol = s->choice.tol,
                            .max_iter = s->choice.max_iter,
                            .limit_max_iter = s->choice.limit_max_iter,
                            .listener = listener};
  *rep = (solver_report){.outcome = STOPPED_SINGULAR};
  TRY(suit(s, cp, a->ops, &own, &possible));
  if (!possible) goto done;
  if (s->work[row] == NULL) TRY(a->ops->setup(&own, a->param, &s->work[row]));
  TRY(drive_one(s, &own, a, &control, u, r, rep));
done:
  rep->solver = a->ops->name;
  return st;
}

/* The verdict: only the residual of the given problem counts. */
static void judge(const contact_problem *cp, double tol, const double *u,
                  const double *r, solver_report *rep) {
  rep->residual = contact_residual(cp, u, r);
  if (isnan(rep->residual))
    rep->outcome = STOPPED_NAN;
  else if (rep->residual <= tol)
    rep->outcome = CONVERGED;
  else if (rep->outcome >= 0)
    rep->outcome = STOPPED_STAGNATION;
}

/* Start without any knowledge: stick, no penetration; r = A u - f. */
static void cold_start(const contact_problem *cp, double *u, double *r) {
  if (cp->A == NULL) {
    memset(r, 0, (size_t)cp->m * sizeof *r);
    memcpy(u, cp->f, (size_t)cp->m * sizeof *u);
    return;
  }
  for (int dof = 0; dof < cp->m; ++dof) {
    int node_id = dof / cp->dim, k = dof % cp->dim - 1;
    if (k < 0)
      u[dof] = fmin(cp->gap[node_id], 0.0);
    else
      u[dof] = cp->ut0 == NULL ? 0.0 : cp->ut0[node_id * (cp->dim - 1) + k];
  }
  contact_reaction(cp, u, r);
}

/* ---- AUTO -------------------------------------------------------------- */

static void note(contact_solver *s, const solver_report *rep, drive how) {
  size_t used = strlen(s->log);
  snprintf(s->log + used, LOG_SIZE - used, "%s%s%s: %s", used > 0 ? ", " : "",
           rep->solver, how == ALONG_PATH ? " along a friction path" : "",
           outcome_text(rep->outcome));
}

/* How much a failure says; a singular compliance says nothing. */
static int weight(const contact_problem *cp, outcome o) {
  if (o == STOPPED_RAY) return 2;
  return o == STOPPED_SINGULAR && cp->A != NULL;
}

/* Which of two failures says more: no equilibrium, then singular, then the
 * lower residual. */
static int says_more(const contact_problem *cp, const solver_report *a,
                     const solver_report *b) {
  int ra = weight(cp, a->outcome), rb = weight(cp, b->outcome);
  if (ra != rb) return ra > rb;
  return !(a->residual >= b->residual);
}

/* 1 if a link of the chain does not apply: a friction path without Coulomb
 * friction, a method for problems of which only the compliance is known. */
static int is_skipped(const contact_problem *cp, int i) {
  if (auto_chain[i].how == ALONG_PATH && cp->B == NULL) return 1;
  return auto_chain[i].compliance && cp->A != NULL;
}

/* 1 if no other link is needed: an answer, a proof, or numbers beyond help. */
static int is_final(const contact_problem *cp, outcome o) {
  int proved = o == STOPPED_RAY && cp->B == NULL;
  return proved || o == CONVERGED || o == STOPPED_NAN;
}

static status run_chain(contact_solver *s, const contact_problem *cp,
                        const solver_listener *listener, double *u, double *r,
                        solver_report *rep) {
  status st = OK;
  size_t bytes = (size_t)cp->m * sizeof *u;
  int n = (int)(sizeof auto_chain / sizeof *auto_chain), iterations = 0;
  solver_report best = {.outcome = RUNNING};
  for (int i = 0; i < n; ++i) {
    attempt a = {auto_chain[i].ops, s->param, auto_chain[i].how};
    if (is_skipped(cp, i)) continue;
    memset(s->param, 0, s->param_size);
    option_defaults(a.ops->options, s->param);
    if (i > 0) cold_start(cp, u, r);
    TRY(run_one(s, cp, &a, listener, u, r, rep));
    iterations += rep->iterations;
    judge(cp, s->choice.tol, u, r, rep);
    if (i > 0 || rep->outcome != CONVERGED) note(s, rep, a.how);
    if (best.outcome == RUNNING || rep->outcome == CONVERGED ||
        says_more(cp, rep, &best)) {
      best = *rep;
      memcpy(s->best_u, u, bytes);
      memcpy(s->best_r, r, bytes);
    }
    if (is_final(cp, rep->outcome)) break;
  }
  memcpy(u, s->best_u, bytes);
  memcpy(r, s->best_r, bytes);
  *rep = best;
  rep->iterations = iterations;
done:
  return st;
}

/* 1: the answer is known without a solver: no node, no load, start solves. */
static int known_answer(const contact_problem *cp, double tol, double *u,
                        double *r, solver_report *rep) {
  *rep = (solver_report){.outcome = CONVERGED, .solver = "none"};
  if (cp->m == 0) return 1;
  rep->residual = contact_residual(cp, u, r);
  if (rep->residual <= tol) return 1;
  double scale = contact_scale(cp);
  if (scale == 0.0) {
    memset(u, 0, (size_t)cp->m * sizeof *u);
    memset(r, 0, (size_t)cp->m * sizeof *r);
    rep->residual = contact_residual(cp, u, r);
    return rep->residual <= tol;
  }
  if (isnan(rep->residual)) {
    cold_start(cp, u, r);
    rep->residual = contact_residual(cp, u, r);
  }
  if (isnan(rep->residual) || !(scale < HUGE_VAL)) {
    rep->outcome = STOPPED_NAN;
    return 1;
  }
  return 0;
}

status contact_solve(contact_solver *s, const contact_problem *cp,
                     const solver_listener *listener, double *u, double *r,
                     solver_report *rep) {
  status st = OK;
  double start = timer_cpu();
  s->log[0] = '\0';
  *rep = (solver_report){.outcome = RUNNING};
  if (known_answer(cp, s->choice.tol, u, r, rep)) goto done;
  TRY(fit(s, cp));
  if (s->choice.ops == NULL) {
    TRY(run_chain(s, cp, listener, u, r, rep));
  } else {
    attempt a = {s->choice.ops, s->choice.param, PLAIN};
    TRY(run_one(s, cp, &a, listener, u, r, rep));
    judge(cp, s->choice.tol, u, r, rep);
  }
done:
  rep->cpu = timer_cpu() - start;
  return st;
}
