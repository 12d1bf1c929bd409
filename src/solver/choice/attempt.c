/*
 * One attempt of contact_solve: one solver on a problem, in a form it can use,
 * with the loop that the problem requires (choice.h).
 */
#include "solver/choice/choice.h"

#include "base/base.h"

#include <strings.h>

enum { TIGHTER = 3 };                /* tolerances tried on another form */
static const double OWN_SHARE = 0.5; /* of the tolerance, in that form */

#define SOLVER_ROW(name) &name##_solver,
const solver_ops *const solver_list[] = {SOLVER_LIST(SOLVER_ROW) NULL};

const solver_ops *solver_find(const char *name) {
  for (int i = 0; solver_list[i] != NULL; ++i)
    if (strcasecmp(solver_list[i]->name, name) == 0) return solver_list[i];
  return NULL;
}

const char *solver_family(const char *name) {
  const solver_ops *ops = name == NULL ? NULL : solver_find(name);
  return ops == NULL ? "direct" : ops->family;
}

status attempt_archive(const contact_solver *s, int row, archive *a) {
  if (s->work[row] == NULL || solver_list[row]->keep == NULL) return OK;
  IN_GROUP(a, text_of("work%d", row));
  return solver_list[row]->keep(s->work[row], a);
}

/* A new workspace reads its saved data. */
static status remember(contact_solver *s, int row) {
  status st = OK;
  int there = 0;
  if (s->from == NULL) return OK;
  archive_go(s->from, s->group);
  TRY(archive_ints(s->from, "works", &there, 1));
  if (there >> row & 1) TRY(attempt_archive(s, row, s->from));
done:
  archive_go(s->from, "");
  return st;
}

/* The problem with springs on the motions of the whole body. */
static status suit_by_springs(contact_solver *s, const contact_problem *cp,
                              contact_problem *out, const char **why) {
  PASS(anchor_make(cp, &s->held));
  if (!s->held.missing) anchor_put(&s->held, out);
  if (s->held.missing)
    *why = "needs the compliance, but the stiffness is nearly singular";
  return OK;
}

static int lacks_stiffness(const contact_solver *s, const contact_problem *cp,
                           const solver_ops *ops) {
  int does = (ops->handles & REGULAR_COMPLIANCE) && !s->inverse_wanted;
  return (ops->handles & NEEDS_STIFFNESS) && !contact_has_stiffness(cp) &&
         !does;
}

static status make_full(contact_solver *s, const contact_problem *cp) {
  if (s->full != NULL) return OK;
  PASS_NEW(s->full, (size_t)cp->m * cp->m);
  contact_dense(cp, s->full);
  return OK;
}

/* All of a compliance given in blocks, for the others. */
static status fill_up(contact_solver *s, contact_problem *cp) {
  if (cp->blocks == NULL) return OK;
  if (s->full == NULL)
    PASS(memory_require((double)cp->m * cp->m * sizeof *s->full,
                        "the compliance of a method that needs all of it"));
  PASS(make_full(s, cp));
  cp->W = s->full;
  cp->blocks = NULL;
  return OK;
}

/* The entries of a stiffness that is an operator, for a method that needs them:
 * where the others have failed. */
static status form_entries(contact_solver *s, contact_problem *cp,
                           const solver_ops *ops, const char **why) {
  const double m = cp->m;
  if (cp->op == NULL || ops->entries == NULL) return OK;
  if (s->full == NULL && m * m * sizeof *s->full > memory_left()) {
    *why = "needs the entries of the condensed stiffness, which do not fit";
    return OK;
  }
  PASS(make_full(s, cp));
  cp->A = s->full;
  cp->op = NULL;
  return OK;
}

/* 1: it takes a semidefinite stiffness. */
static int floats(const contact_problem *cp, const solver_ops *ops) {
  const unsigned needs =
      cp->op != NULL ? SOLVES_FLOATING | FLOATS_BY_OPERATOR : SOLVES_FLOATING;
  return (ops->handles & needs) != 0;
}

/* The problem in a form the solver can use; *why stays NULL, or there is
 * none. */
static status suit(contact_solver *s, const contact_problem *cp,
                   const solver_ops *ops, contact_problem *out,
                   const char **why) {
  contact_problem formed = *cp;
  PASS(form_entries(s, &formed, ops, why));
  cp = &formed;
  *out = *cp;
  if (*why != NULL) return OK;
  int stiffness = lacks_stiffness(s, cp, ops);
  int compliance = (ops->handles & NEEDS_COMPLIANCE) && cp->W == NULL &&
                   cp->blocks == NULL && cp->op == NULL;
  if (cp->floating && !floats(cp, ops)) return suit_by_springs(s, cp, out, why);
  if (!stiffness && !compliance) {
    if (!(ops->handles & SPARSE_COMPLIANCE)) PASS(fill_up(s, out));
    return OK;
  }
  PASS(other_form_make(cp, &s->other));
  if (s->other.matrix == NULL && stiffness) {
    *why = "needs the stiffness, but the compliance is singular";
  } else if (s->other.matrix == NULL) {
    PASS(suit_by_springs(s, cp, out, why));
  } else if (stiffness) {
    contact_product(cp->m, s->other.matrix, cp->f, s->other.load);
    out->A = s->other.matrix;
    out->blocks = NULL;
    out->f = s->other.load;
  } else {
    out->W = s->other.matrix;
  }
  return OK;
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
  inner_solver inner = {a->ops, a->param, s->work[row_of(a->ops)]};
  if (a->how == ALONG_PATH) {
    int entries = cp->B->start[cp->n];
    if (s->path == NULL || s->path_capacity < entries) {
      FORGET(s->path);
      PASS(friction_path_new(cp, &s->path));
      s->path_capacity = entries;
    }
    PASS(friction_path_solve(s->path, cp, &inner, control, u, r, rep));
  } else if (cp->B != NULL && !(a->ops->handles & SOLVES_COULOMB)) {
    if (s->fixed == NULL) PASS(fixed_point_new(cp->n, &s->fixed));
    PASS(fixed_point_solve(s->fixed, cp, &inner, control, u, r, rep));
  } else {
    PASS(a->ops->solve(cp, a->param, inner.work, control, u, r, rep));
  }
  return OK;
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

/* 1: the method chosen found the compliance, or its part for a guess of the
 * states, singular: the inverse decides which. AUTO has others. */
static int wants_inverse(contact_solver *s, const contact_problem *cp,
                         const attempt *a, const solver_report *rep) {
  int row = row_of(a->ops);
  if (s->choice.ops == NULL || rep->outcome != STOPPED_SINGULAR ||
      contact_has_stiffness(cp) || !(a->ops->handles & REGULAR_COMPLIANCE) ||
      s->inverse_wanted)
    return 0;
  FORGET(s->work[row]);
  s->inverse_wanted = 1;
  return a->max_iter == 0 || a->max_iter > rep->iterations;
}

/* The attempt on the problem in the form "own". */
static status drive_form(drive_call *x, const contact_problem *own,
                         const solver_control *control, double *u, double *r,
                         solver_report *rep) {
  anchored_solver inner = {drive_anchored, x};
  if (anchor_holds(&x->s->held, own))
    return anchor_solve(&x->s->held, x->given, &inner, control, u, r, rep);
  return drive_one(x->s, own, x->a, control, u, r, rep);
}

/* The residual of the stiffness form can be below the tolerance where that of
 * the given compliance is slightly above: the solver continues with a tighter
 * tolerance. */
static status drive_until_met(drive_call *x, const contact_problem *own,
                              solver_control control, double *u, double *r,
                              solver_report *rep) {
  double tol = control.tol;
  int made = 0;
  for (int k = 0; k < TIGHTER; ++k) {
    PASS(drive_form(x, own, &control, u, r, rep));
    made += rep->iterations;
    rep->iterations = made;
    if (contact_has_stiffness(x->given) || !contact_has_stiffness(own) ||
        rep->outcome != CONVERGED)
      break;
    double residual = contact_residual(x->given, u, r);
    if (!(residual > tol)) break;
    control.tol *= OWN_SHARE * tol / residual;
    if (control.max_iter > 0) control.max_iter = x->a->max_iter - made;
    if (x->a->max_iter > 0 && control.max_iter <= 0) break;
  }
  return OK;
}

static int is_number(const contact_problem *cp, const double *u,
                     const double *r) {
  for (int i = 0; i < cp->m; ++i)
    if (!isfinite(u[i]) || !isfinite(r[i])) return 0;
  return 1;
}

status attempt_run(contact_solver *s, const contact_problem *cp,
                   const attempt *a, double *u, double *r, solver_report *rep) {
  status st = OK;
  contact_problem own;
  const char *why = NULL;
  int row = row_of(a->ops);
  solver_control control = {.tol = s->choice.tol,
                            .max_iter = a->max_iter,
                            .limit_max_iter = s->choice.limit_max_iter,
                            .listener = s->listener,
                            .promise = a->promise};
  *rep = (solver_report){.outcome = STOPPED_UNFIT};
  if (cp->dim == 3 && !(a->ops->handles & SOLVES_3D))
    why = "solves problems in the plane only";
  else
    TRY(suit(s, cp, a->ops, &own, &why));
  if (why != NULL) {
    text_add(s->log, LOG_SIZE, "%s%s: %s", s->log[0] != '\0' ? ", " : "",
             a->ops->name, why);
    goto done;
  }
  if (own.A == cp->A && own.op == cp->op && own.W == cp->W)
    control.scale = s->scale;
  if (s->work[row] == NULL) {
    TRY(solver_set_up(a->ops, &own, a->param, &s->work[row]));
    TRY(remember(s, row));
  }
  drive_call x = {s, a, cp};
  TRY(drive_until_met(&x, &own, control, u, r, rep));
  if (!is_number(cp, u, r)) { /* of the method, as the data are numbers */
    cold_start(cp, u, r);
    rep->outcome = STOPPED_NAN;
  }
  if (wants_inverse(s, cp, a, rep)) {
    attempt again = *a;
    if (a->max_iter > 0) again.max_iter -= rep->iterations;
    cold_start(cp, u, r);
    TRY(attempt_run(s, cp, &again, u, r, rep));
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
  if (!s->sought && !is_large_sparse(cp))
    PASS(proof_find(cp, &s->held, &s->proved));
  s->sought = 1;
  if (s->proved)
    rep->outcome = STOPPED_RAY;
  else if (rep->outcome == STOPPED_RAY)
    rep->outcome = STOPPED_STAGNATION;
  return OK;
}

/* Cold start: stick, no penetration; r = A u - f. */
void cold_start(const contact_problem *cp, double *u, double *r) {
  if (!contact_has_stiffness(cp)) {
    CLEAR(r, cp->m);
    COPY(u, cp->f, cp->m);
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
