/*
 * contact_solve: one solver or AUTO on a problem, in a suitable form, with data
 * of the matrix reused (solver/solver.h).
 */
#include "solver/choice/choice.h"

#include "base/memory.h"
#include "base/timer.h"
#include "solver/choice/polish.h"
#include "solver/choice/proof.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { TIGHTER = 3 };                /* tolerances tried on another form */
static const double OWN_SHARE = 0.5; /* of the tolerance, in that form */

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

/* A (or W) has changed: discard factors. */
static void forget_factors(contact_solver *s) {
  for (int i = 0; i <= N_SOLVER; ++i) {
    const solver_ops *ops = i < N_SOLVER ? solver_list[i] : s->choice.ops;
    if (s->work[i] != NULL) ops->release(s->work[i]);
    s->work[i] = NULL;
  }
  fixed_point_free(s->fixed);
  friction_path_free(s->path);
  s->fixed = NULL;
  s->path = NULL;
  other_form_free(&s->other);
  s->inverse_wanted = 0;
  normal_form_free(&s->normal);
  anchor_free(&s->held);
  contact_bodies_free(s->bodies);
  s->bodies = NULL;
  RELEASE(s->best_u, s->best_r);
  s->best_u = s->best_r = NULL;
  s->A = s->W = NULL;
  s->m = s->n = -1;
  s->from = NULL;
}

void contact_solver_free(contact_solver *s) {
  if (s == NULL) return;
  forget_factors(s);
  RELEASE(s->param, s);
}

void contact_solver_tolerance(contact_solver *s, double tol) {
  s->choice.tol = tol;
}

const char *contact_solver_log(const contact_solver *s) { return s->log; }

static int fits(const contact_solver *s, const contact_problem *cp) {
  return s->A == cp->A && s->W == cp->W && s->m == cp->m && s->n == cp->n &&
         s->best_u != NULL;
}

static status fit(contact_solver *s, const contact_problem *cp) {
  status st = OK;
  if (fits(s, cp)) goto done;
  archive *from = s->best_u == NULL ? s->from : NULL;
  forget_factors(s);
  s->from = from;
  if (from != NULL) {
    archive_go(from, s->group);
    st = normal_form_keep(&s->normal, from);
    archive_go(from, "");
    TRY(st);
  }
  TRY(contact_bodies_new(cp, &s->bodies));
  NEW(s->best_u, cp->m);
  NEW(s->best_r, cp->m);
  s->A = cp->A;
  s->W = cp->W;
  s->m = cp->m;
  s->n = cp->n;
done:
  return st;
}

/* ---- saved data ------------------------------------------------- */

static status keep_work(const contact_solver *s, int row, archive *a) {
  status st = OK;
  char name[20];
  const solver_ops *ops = row < N_SOLVER ? solver_list[row] : s->choice.ops;
  if (s->work[row] == NULL || ops->keep == NULL) return OK;
  snprintf(name, sizeof name, "work%d", row);
  archive_enter(a, name);
  st = ops->keep(s->work[row], a);
  archive_leave(a);
  return st;
}

status contact_solver_keep(contact_solver *s, archive *a) {
  if (archive_reads(a)) {
    forget_factors(s);
    s->from = a;
    snprintf(s->group, sizeof s->group, "%s", archive_group(a));
    return OK;
  }
  int there = 0;
  for (int i = 0; i <= N_SOLVER; ++i) {
    PASS(keep_work(s, i, a));
    if (s->work[i] != NULL) there |= 1 << i;
  }
  PASS(archive_ints(a, "works", &there, 1));
  return normal_form_keep(&s->normal, a);
}

/* A new workspace reads its saved data. */
static status remember(contact_solver *s, int row) {
  status st = OK;
  int there = 0;
  if (s->from == NULL) return OK;
  archive_go(s->from, s->group);
  TRY(archive_ints(s->from, "works", &there, 1));
  if (there >> row & 1) TRY(keep_work(s, row, s->from));
done:
  archive_go(s->from, "");
  return st;
}

/* ---- one attempt --------------------------------------------------------- */

/* The problem with springs on the motions of the whole body. */
static status suit_by_springs(contact_solver *s, const contact_problem *cp,
                              contact_problem *out, const char **why) {
  PASS(anchor_make(cp, &s->held));
  out->A = s->held.A;
  out->W = s->held.W;
  if (s->held.missing)
    *why = "needs the compliance, but the stiffness is nearly singular";
  return OK;
}

static int lacks_stiffness(const contact_solver *s, const contact_problem *cp,
                           const solver_ops *ops) {
  int does = (ops->handles & REGULAR_COMPLIANCE) && !s->inverse_wanted;
  return (ops->handles & NEEDS_STIFFNESS) && cp->A == NULL && !does;
}

/* The problem in a form the solver can use; NULL, or why there is none. */
static status suit(contact_solver *s, const contact_problem *cp,
                   const solver_ops *ops, contact_problem *out,
                   const char **why) {
  status st = OK;
  *out = *cp;
  *why = NULL;
  int stiffness = lacks_stiffness(s, cp, ops);
  int compliance = (ops->handles & NEEDS_COMPLIANCE) && cp->W == NULL;
  if (cp->dim == 3 && !(ops->handles & SOLVES_3D)) {
    *why = "solves problems in the plane only";
    goto done;
  }
  if (cp->floating && !(ops->handles & SOLVES_FLOATING)) {
    TRY(suit_by_springs(s, cp, out, why));
    goto done;
  }
  if (!stiffness && !compliance) goto done;
  TRY(other_form_make(cp, &s->other));
  if (s->other.matrix == NULL && stiffness) {
    *why = "needs the stiffness, but the compliance is singular";
  } else if (s->other.matrix == NULL) {
    TRY(suit_by_springs(s, cp, out, why));
  } else if (stiffness) {
    contact_product(cp->m, s->other.matrix, cp->f, s->other.load);
    out->A = s->other.matrix;
    out->f = s->other.load;
  } else {
    out->W = s->other.matrix;
  }
done:
  return st;
}

static int row_of(const solver_ops *ops) {
  int row = 0;
  while (row < N_SOLVER && solver_list[row] != ops) ++row;
  return row;
}

/* The loop around the solver that the problem and the drive require. */
static status drive_one(contact_solver *s, const contact_problem *cp,
                        const attempt *a, const solver_control *control,
                        double *u, double *r, solver_report *rep) {
  status st = OK;
  inner_solver inner = {a->ops, a->param, s->work[row_of(a->ops)]};
  if (a->how == ALONG_PATH) {
    int entries = cp->B->start[cp->n];
    if (s->path == NULL || s->path_capacity < entries) {
      friction_path_free(s->path);
      s->path = NULL;
      TRY(friction_path_new(cp, &s->path));
      s->path_capacity = entries;
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

/* Append to the log. */
static void log_unfit(contact_solver *s, const char *name, const char *why) {
  size_t used = strlen(s->log);
  snprintf(s->log + used, LOG_SIZE - used, "%s%s: %s", used > 0 ? ", " : "",
           name, why);
}

/* An attempt on the given problem. */
typedef struct drive_call {
  contact_solver *s;
  const attempt *a;
  const contact_problem *given;
} drive_call;

static status drive_anchored(void *ctx, const contact_problem *cp,
                             const solver_control *control, double *u,
                             double *r, solver_report *rep) {
  const drive_call *x = ctx;
  return drive_one(x->s, cp, x->a, control, u, r, rep);
}

/* 1: a method found the compliance, or its part for a guess of the states,
 * singular: the inverse decides which. */
static int wants_inverse(contact_solver *s, const contact_problem *cp,
                         const attempt *a, const solver_report *rep) {
  int row = row_of(a->ops);
  if (rep->outcome != STOPPED_SINGULAR || cp->A != NULL ||
      !(a->ops->handles & REGULAR_COMPLIANCE) || s->inverse_wanted)
    return 0;
  a->ops->release(s->work[row]);
  s->work[row] = NULL;
  s->inverse_wanted = 1;
  return a->max_iter == 0 || a->max_iter > rep->iterations;
}

/* The attempt on the problem in the form "own". */
static status drive_form(drive_call *x, const contact_problem *own,
                         const solver_control *control, double *u, double *r,
                         solver_report *rep) {
  anchored_solver inner = {drive_anchored, x};
  if (own->A != NULL && own->A == x->s->held.A)
    return anchor_solve(&x->s->held, x->given, &inner, control, u, r, rep);
  return drive_one(x->s, own, x->a, control, u, r, rep);
}

/* The residual of the stiffness form can be below the tolerance where that of
 * the given compliance is slightly above: the solver continues with a tighter
 * tolerance. */
static status drive_until_met(drive_call *x, const contact_problem *own,
                              solver_control control, double *u, double *r,
                              solver_report *rep) {
  status st = OK;
  double tol = control.tol;
  int made = 0;
  for (int k = 0; k < TIGHTER; ++k) {
    TRY(drive_form(x, own, &control, u, r, rep));
    made += rep->iterations;
    rep->iterations = made;
    if (x->given->A != NULL || own->A == NULL || rep->outcome != CONVERGED)
      break;
    double residual = contact_residual(x->given, u, r);
    if (!(residual > tol)) break;
    control.tol *= OWN_SHARE * tol / residual;
    if (control.max_iter > 0) control.max_iter = x->a->max_iter - made;
    if (x->a->max_iter > 0 && control.max_iter <= 0) break;
  }
done:
  return st;
}

static int is_number(const contact_problem *cp, const double *u,
                     const double *r) {
  for (int i = 0; i < cp->m; ++i)
    if (!isfinite(u[i]) || !isfinite(r[i])) return 0;
  return 1;
}

status attempt_run(contact_solver *s, const contact_problem *cp,
                   const attempt *a, const solver_listener *listener, double *u,
                   double *r, solver_report *rep) {
  status st = OK;
  contact_problem own;
  const char *why = NULL;
  int row = row_of(a->ops);
  solver_control control = {.tol = s->choice.tol,
                            .max_iter = a->max_iter,
                            .limit_max_iter = s->choice.limit_max_iter,
                            .listener = listener};
  *rep = (solver_report){.outcome = STOPPED_UNFIT};
  TRY(suit(s, cp, a->ops, &own, &why));
  if (why != NULL) {
    log_unfit(s, a->ops->name, why);
    goto done;
  }
  if (own.A == cp->A && own.W == cp->W) control.scale = s->scale;
  if (s->work[row] == NULL) {
    TRY(a->ops->setup(&own, a->param, &s->work[row]));
    TRY(remember(s, row));
  }
  drive_call x = {s, a, cp};
  TRY(drive_until_met(&x, &own, control, u, r, rep));
  if (!is_number(cp, u, r)) { /* of the method, as the data are numbers     */
    cold_start(cp, u, r);
    rep->outcome = STOPPED_NAN;
  }
  if (wants_inverse(s, cp, a, rep)) {
    attempt again = *a;
    if (a->max_iter > 0) again.max_iter -= rep->iterations;
    cold_start(cp, u, r);
    TRY(attempt_run(s, cp, &again, listener, u, r, rep));
  }
done:
  rep->solver = a->ops->name;
  return st;
}

void attempt_check(const contact_solver *s, const contact_problem *cp,
                   const double *u, const double *r, solver_report *rep) {
  rep->residual = contact_residual_at(cp, s->scale, u, r);
  if (isnan(rep->residual))
    rep->outcome = STOPPED_NAN;
  else if (rep->residual <= s->choice.tol)
    rep->outcome = CONVERGED;
  else if (rep->outcome >= 0)
    rep->outcome = STOPPED_STAGNATION;
}

status attempt_prove(contact_solver *s, const contact_problem *cp,
                     solver_report *rep) {
  if (rep->outcome >= 0 || !isfinite(rep->residual)) return OK;
  if (!s->sought) PASS(proof_find(cp, &s->held, &s->proved));
  s->sought = 1;
  if (s->proved)
    rep->outcome = STOPPED_RAY;
  else if (rep->outcome == STOPPED_RAY)
    rep->outcome = STOPPED_STAGNATION;
  return OK;
}

/* Cold start: stick, no penetration; r = A u - f. */
void cold_start(const contact_problem *cp, double *u, double *r) {
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

/* 1: a compliance whose nodes do not reach their obstacles without forces. */
static int stays_clear(const contact_problem *cp) {
  if (cp->A != NULL) return 0;
  for (int dof = 0; dof < cp->m; ++dof)
    if (cp->f[dof] > contact_bound(cp, dof)) return 0;
  for (int i = 0; i < cp->n && cp->g0 != NULL; ++i)
    if (cp->g0[i] > 0.0) return 0;
  return 1;
}

/* 1: the solution is known without a solver: no node, no load, start solves, no
 * node reaches its obstacle. */
static int known_answer(const contact_solver *s, const contact_problem *cp,
                        double *u, double *r, solver_report *rep) {
  double tol = s->choice.tol, scale = s->scale;
  *rep = (solver_report){.outcome = CONVERGED, .solver = "none"};
  if (cp->m == 0) return 1;
  rep->residual = contact_residual_at(cp, scale, u, r);
  if (rep->residual <= tol) return 1;
  if (stays_clear(cp)) {
    cold_start(cp, u, r);
    rep->residual = contact_residual_at(cp, scale, u, r);
    return rep->residual <= tol;
  }
  if (scale == 0.0) {
    memset(u, 0, (size_t)cp->m * sizeof *u);
    memset(r, 0, (size_t)cp->m * sizeof *r);
    rep->residual = contact_residual_at(cp, scale, u, r);
    return rep->residual <= tol;
  }
  if (isnan(rep->residual)) {
    cold_start(cp, u, r);
    rep->residual = contact_residual_at(cp, scale, u, r);
  }
  if (isnan(rep->residual) || !(scale < HUGE_VAL)) {
    rep->outcome = STOPPED_NAN;
    return 1;
  }
  return 0;
}

/* The final correction, within the iterations allowed. */
static status polish(const contact_solver *s, const contact_problem *cp,
                     double *u, double *r, solver_report *rep) {
  double tol = s->choice.tol;
  int sweeps = 0, asked = s->choice.max_iter;
  int most = asked > 0 ? asked - rep->iterations : INT_MAX;
  PASS(polish_touch(cp, s->scale, tol, u, r, &rep->residual));
  PASS(polish_slip(cp, tol, most, u, r, &sweeps));
  rep->iterations += sweeps;
  if (sweeps > 0) rep->residual = contact_residual_at(cp, s->scale, u, r);
  return OK;
}

const contact_bodies *contact_solver_bodies(const contact_solver *s,
                                            const contact_problem *cp) {
  return s != NULL && fits(s, cp) ? s->bodies : NULL;
}

static status solve_apart(contact_solver *s, const contact_problem *cp,
                          const solver_listener *listener, double *u, double *r,
                          solver_report *rep) {
  status st = OK;
  s->scale = contact_scale(cp);
  if (known_answer(s, cp, u, r, rep)) goto done;
  if (s->choice.ops == NULL) {
    TRY(auto_solve(s, cp, listener, u, r, rep));
  } else {
    attempt a = {s->choice.ops, s->choice.param, PLAIN, s->choice.max_iter};
    TRY(attempt_run(s, cp, &a, listener, u, r, rep));
    attempt_check(s, cp, u, r, rep);
    TRY(attempt_prove(s, cp, rep));
  }
  /* A NaN of a method says nothing about the problem. */
  if (isfinite(rep->residual) &&
      (rep->outcome == STOPPED_NAN || rep->outcome == STOPPED_SINGULAR))
    rep->outcome = STOPPED_STAGNATION;
  if (rep->outcome == CONVERGED) TRY(polish(s, cp, u, r, rep));
done:
  return st;
}

status contact_solve(contact_solver *s, const contact_problem *cp,
                     const solver_listener *listener, double *u, double *r,
                     solver_report *rep) {
  status st = OK;
  double start = timer_cpu();
  contact_problem apart = *cp;
  s->log[0] = '\0';
  s->sought = s->proved = 0;
  *rep = (solver_report){.outcome = RUNNING};
  TRY(fit(s, cp));
  if (cp->bodies == NULL) apart.bodies = s->bodies;
  TRY(solve_apart(s, &apart, listener, u, r, rep));
done:
  rep->cpu = timer_cpu() - start;
  return st;
}
