/* Springs that hold a body while its contact forces are found (choice.h). */
#include "solver/choice/choice.h"

#include <cblas.h>
#include <lapacke.h>

enum {
  MODES = 6, /* of a body in space; 3 in the plane */
  PASSES = 200,
  LATE = 3,     /* passes at the tolerance, for the resultant */
  DRIFT = 3,    /* passes with the same move */
  PATIENCE = 20 /* passes without a lower residual */
};
static const double NULL_PIVOT = 0x1p-44; /* -, times m: of the largest pivot */
static const double ROUNDING = 0x1p-48;   /* -, times m: of the mean diagonal */
static const double SOFT = 0x1p-5;        /* -, k of the mean diagonal over n */
static const double FINEST = 0.1; /* -, of the tolerance: enough for a pass */
static const double COARSEST = 1e-3; /* -, tolerance of a pass */
static const double FINER = 1e-2;    /* -, of the residual, or of no progress */
static const double FARTHEST = 0x1p6; /* -, moves ahead */
static const double STEADY = 0x1p-7;  /* -, of a step of a drift */

void anchor_free(anchor *an) {
  RELEASE(an->R, an->spring, an->A, an->W, an->f, an->a, an->step, an->at,
          an->move, an->y);
  *an = (anchor){0};
}

/* ---- the modes ----------------------------------------------------------- */

/* R orthonormal, by Gram and Schmidt, twice for rounding. */
static void orthonormalise(int m, int n, double *R) {
  for (int j = 0; j < n; ++j) {
    double *v = R + (size_t)j * m;
    for (int k = 0; k < 2 * j; ++k) {
      const double *q = R + (size_t)(k % j) * m;
      cblas_daxpy(m, -cblas_ddot(m, q, 1, v, 1), q, 1, v, 1);
    }
    cblas_dscal(m, 1.0 / cblas_dnrm2(m, v, 1), v, 1);
  }
}

/* stiffness[m]: the mean diagonal of the body; of all bodies where it is
 * rounding, as that of a free body with one contact node. */
static status find_stiffness(const contact_problem *cp, double *stiffness) {
  const contact_bodies *b = cp->bodies;
  double all = 0.0;
  OWNED_NEW(double, sum, b == NULL ? 1 : b->n);
  OWNED_NEW(int, count, b == NULL ? 1 : b->n);
  for (int i = 0; i < cp->m; ++i) {
    const int of = b == NULL ? 0 : b->of[i / cp->dim];
    sum[of] += contact_diagonal(cp, i) / cp->m;
    all += contact_diagonal(cp, i) / cp->m;
    ++count[of];
  }
  for (int i = 0; i < cp->m; ++i) {
    const int of = b == NULL ? 0 : b->of[i / cp->dim];
    const double own = sum[of] * cp->m / count[of];
    stiffness[i] = own > cp->m * ROUNDING * all ? own : all;
  }
  return OK;
}

/* The motions that the operator knows. */
static status known_modes(const contact_problem *cp, anchor *an) {
  const size_t size = (size_t)cp->m * cp->op->n_kernel;
  an->n_mode = cp->op->n_kernel;
  PASS_NEW_ALL(OF(an->R, size), OF(an->a, an->n_mode), OF(an->step, an->n_mode),
               OF(an->at, an->n_mode), OF(an->move, an->n_mode));
  if (size > 0) COPY(an->R, cp->op->kernel, size);
  return OK;
}

status anchor_modes(const contact_problem *cp, anchor *an) {
  OWNED int *pivot = NULL;
  int m = cp->m, rank = 0;
  OWNED double *work = NULL, *L = NULL, *scale = NULL;
  const size_t size = (size_t)m * m;
  if (an->R != NULL) return OK;
  if (cp->op != NULL) return known_modes(cp, an);
  PASS_NEW_ALL(OF(pivot, m), OF(work, 2 * m), OF(scale, m), OF(L, size));
  COPY(L, cp->A, size);
  /* Pivots of a soft body are no rounding of those of a stiff one. */
  PASS(find_stiffness(cp, work));
  form_apply_scale(m, form_scale(m, work, scale), scale, L);
  LAPACKE_dpstrf_work(LAPACK_COL_MAJOR, 'L', m, L, m, pivot, &rank,
                      m * NULL_PIVOT, work);
  an->n_mode = m - rank;
  PASS_NEW_ALL(OF(an->R, m * an->n_mode), OF(an->a, an->n_mode),
               OF(an->step, an->n_mode), OF(an->at, an->n_mode),
               OF(an->move, an->n_mode));
  dense_null(m, rank, L, pivot, work, an->R);
  for (int i = 0; i < m * an->n_mode; ++i) an->R[i] *= scale[i % m];
  orthonormalise(m, an->n_mode, an->R);
  return OK;
}

/* A_s and its inverse. */
static status hold(const contact_problem *cp, anchor *an) {
  ENDS_BY(dense_free) dense d = {0};
  int m = cp->m, good = 0;
  size_t size = (size_t)m * m;
  PASS(dense_new(m, &d));
  COPY(an->A, cp->A, size);
  for (int k = 0; k < an->n_mode; ++k) {
    const double *v = an->R + (size_t)k * m;
    cblas_dger(CblasColMajor, m, m, an->spring[k], v, 1, v, 1, an->A, m);
  }
  COPY(d.a, an->A, size);
  PASS(form_invert(m, &d, &good));
  an->missing = !good;
  COPY(an->W, d.a, size);
  return OK;
}

/* Of each motion by the stiffness of the bodies that it moves, which may differ
 * by powers of ten. */
static status choose_springs(const contact_problem *cp, anchor *an) {
  OWNED double *stiffness = NULL;
  PASS_NEW_ALL(OF(stiffness, cp->m), OF(an->spring, an->n_mode));
  PASS(find_stiffness(cp, stiffness));
  for (int k = 0; k < an->n_mode; ++k) {
    const double *v = an->R + (size_t)k * cp->m;
    for (int i = 0; i < cp->m; ++i) an->spring[k] += v[i] * v[i] * stiffness[i];
    an->spring[k] *= SOFT / cp->n;
  }
  return OK;
}

/* ---- A_s of an operator: A R = 0 and R'R = I, so
 *
 *   inv(A_s) b = (I - R R') y + R inv(k) R'b,   A y = (I - R R') b,
 *
 * for any y; the operator finds one, as this load has no resultant. ----------
 */

static double *mode_of(const anchor *an, int m, int k) {
  return an->R + (size_t)m * k;
}

/* Au += R k R'u. */
static void held_apply(void *ctx, const double *u, double *Au, double *size) {
  const anchor *an = ctx;
  an->of->apply(an->of->ctx, u, Au, size);
  for (int k = 0; k < an->n_mode; ++k) {
    const double *v = mode_of(an, an->m, k);
    cblas_daxpy(an->m, an->spring[k] * cblas_ddot(an->m, v, 1, u, 1), v, 1, Au,
                1);
  }
}

static status held_rows(void *ctx, const known_rows *rows, int *singular) {
  const anchor *an = ctx;
  return an->of->set_rows(an->of->ctx, rows, singular);
}

static void held_solve(void *ctx, const double *b, double *x, double *Ax) {
  const anchor *an = ctx;
  const int m = an->m;
  COPY(an->y, b, m);
  for (int k = 0; k < an->n_mode; ++k) {
    const double *v = mode_of(an, m, k);
    cblas_daxpy(m, -cblas_ddot(m, v, 1, an->y, 1), v, 1, an->y, 1);
  }
  an->of->solve(an->of->ctx, an->y, x, Ax);
  for (int k = 0; k < an->n_mode; ++k) {
    const double *v = mode_of(an, m, k);
    const double load = cblas_ddot(m, v, 1, b, 1);
    cblas_daxpy(m, load / an->spring[k] - cblas_ddot(m, v, 1, x, 1), v, 1, x,
                1);
    cblas_daxpy(m, load, v, 1, Ax, 1);
  }
}

/* Products with all rows free alone. */
static status hold_operator(const contact_problem *cp, anchor *an) {
  PASS_NEW(an->y, cp->m);
  an->m = cp->m;
  an->of = cp->op;
  an->op = (contact_operator){.ctx = an,
                              .diagonal = cp->op->diagonal,
                              .body = cp->op->body,
                              .n_body = cp->op->n_body,
                              .workspace = cp->op->workspace,
                              .apply = held_apply,
                              .set_rows = held_rows,
                              .solve = held_solve};
  return OK;
}

status anchor_make(const contact_problem *cp, anchor *an) {
  size_t m = cp->m;
  if (an->missing || an->made) return OK;
  an->missing = !contact_has_stiffness(cp) || cp->n == 0;
  if (an->missing) return OK;
  PASS_NEW(an->f, m);
  PASS(anchor_modes(cp, an));
  PASS(choose_springs(cp, an));
  an->made = 1;
  if (cp->op != NULL) return hold_operator(cp, an);
  PASS_NEW_ALL(OF(an->A, m * m), OF(an->W, m * m));
  return hold(cp, an);
}

int anchor_holds(const anchor *an, const contact_problem *cp) {
  return (cp->A != NULL && cp->A == an->A) || cp->op == &an->op;
}

void anchor_put(const anchor *an, contact_problem *cp) {
  cp->A = an->A;
  cp->W = an->W;
  cp->op = an->of != NULL ? &an->op : NULL;
}

/* ---- the passes ---------------------------------------------------------- */

typedef struct passes {
  const anchor *an;
  const contact_problem *cp;
  double load;       /* largest |f|, N */
  double lowest;     /* residual at the last progress */
  int since, steady; /* passes since; with the same move */
  int closed;        /* 1: has been moved onto its obstacles */
  int late;          /* passes at the tolerance */
  int ahead;         /* 1: the springs are not where the body is */
} passes;

/* The place of the body, R'u. */
static void place(const anchor *an, int m, const double *u, double *a) {
  for (int k = 0; k < an->n_mode; ++k)
    a[k] = cblas_ddot(m, an->R + (size_t)k * m, 1, u, 1);
}

/* The last move of unknown i, m. */
static double move_of(const passes *p, int i) {
  double d = 0.0;
  for (int k = 0; k < p->an->n_mode; ++k)
    d += p->an->step[k] * p->an->R[i + (size_t)p->cp->m * k];
  return d;
}

/* Distance from u to the nearest bound over the last move; at least 1, 1 if it
 * leads to none. */
static double moves_to_bound(const passes *p, const double *u) {
  double moves = HUGE_VAL, most = 0.0;
  for (int i = 0; i < p->cp->m; ++i) most = fmax(most, fabs(move_of(p, i)));
  for (int i = 0; i < p->cp->m; ++i) {
    double d = move_of(p, i), bound = contact_bound(p->cp, i);
    if (bound < HUGE_VAL && d > STEADY * most)
      moves = fmin(moves, (bound - u[i]) / d);
  }
  return moves > 1.0 && moves < HUGE_VAL ? moves : 1.0;
}

/* The place nearest to all gaps closed and all nodes where they stick. */
static void close_gaps(passes *p) {
  double *d = p->an->f;
  for (int i = 0; i < p->cp->m; ++i) {
    double bound = contact_bound(p->cp, i);
    d[i] = bound < HUGE_VAL ? bound : contact_stick(p->cp, i);
  }
  place(p->an, p->cp->m, d, p->an->a);
}

/* A body in free motion to an obstacle is moved onto it, the next time onto the
 * first bound it meets. */
static void fly(passes *p, const double *u) {
  double moves = moves_to_bound(p, u);
  if (!(moves > 1.0)) return;
  if (!p->closed) close_gaps(p);
  for (int k = 0; k < p->an->n_mode && p->closed; ++k)
    p->an->a[k] += (moves - 1.0) * p->an->step[k];
  p->closed = 1;
}

/* The springs follow the body. Of one that creeps they go ahead, by Aitken's
 * process (aitken.c), every other pass; farther each time that it moves by the
 * same. */
static void follow(passes *p, const double *u) {
  const anchor *an = p->an;
  double apart = 0.0, size = 0.0, along = 0.0;
  for (int k = 0; k < an->n_mode; ++k) {
    double at = cblas_ddot(p->cp->m, an->R + (size_t)k * p->cp->m, 1, u, 1);
    double step = at - an->a[k], turn = step - an->step[k];
    apart += turn * turn;
    along += turn * step;
    size += step * step;
    an->step[k] = step;
    an->move[k] = at - an->at[k];
    an->a[k] = an->at[k] = at;
  }
  p->steady = sqrt(apart) <= STEADY * sqrt(size) ? p->steady + 1 : 0;
  p->ahead = p->since > 1 && !p->ahead && apart > 0.0;
  const double share =
      p->steady > 0 ? -ldexp(1.0, p->steady) : fmax(along / apart, -FARTHEST);
  for (int k = 0; k < an->n_mode && p->ahead; ++k)
    an->a[k] -= share * an->move[k];
}

/* Resultant the springs carried in the last pass, over the load. */
static double carried(const passes *p) {
  double sum = 0.0;
  for (int k = 0; k < p->an->n_mode; ++k)
    sum += pow(p->an->spring[k] * p->an->step[k], 2);
  return sum > 0.0 ? sqrt(sum * p->cp->m) / p->load : 0.0;
}

/* Largest work of friction against the last move, N m. */
static double friction_against(const passes *p, const double *r) {
  const contact_problem *cp = p->cp;
  double sum = 0.0;
  for (int i = 0; i < cp->n; ++i) {
    double slip = 0.0;
    for (int k = 1; k < cp->dim; ++k)
      slip = hypot(slip, move_of(p, i * cp->dim + k));
    sum += contact_node_limit(cp, r, i) * slip;
  }
  return sum;
}

/* 1: no obstacle stops the last move, and the load does more work on it than
 * friction. */
static int drifts(const passes *p, const double *r) {
  double work = 0.0, into = 0.0, most = 0.0;
  for (int i = 0; i < p->cp->m; ++i) {
    double d = move_of(p, i);
    work += p->cp->f[i] * d;
    most = fmax(most, fabs(d));
    if (contact_bound(p->cp, i) < HUGE_VAL) into = fmax(into, d);
  }
  double held = friction_against(p, r);
  return into <= STEADY * most && work > 0.0 && work >= (1.0 - STEADY) * held;
}

/* RUNNING: another pass. */
static outcome check(passes *p, double tol, const double *r, solver_report *rep,
                     outcome inner) {
  if (isnan(rep->residual)) return STOPPED_NAN;
  if (rep->residual <= tol && (carried(p) <= tol || ++p->late > LATE))
    return CONVERGED;
  ++p->since;
  if (solver_progresses(&p->lowest, rep->residual)) p->since = 0;
  if (inner == STOPPED_ITERATIONS && p->since > 0) return inner;
  if (p->steady >= DRIFT && p->since >= DRIFT && drifts(p, r))
    return STOPPED_RAY;
  if (p->since <= PATIENCE) return RUNNING;
  return inner < 0 ? inner : STOPPED_STAGNATION;
}

/* The problem with springs at a. */
static contact_problem anchored(const passes *p) {
  const anchor *an = p->an;
  contact_problem own = *p->cp;
  COPY(an->f, p->cp->f, own.m);
  for (int k = 0; k < an->n_mode; ++k)
    cblas_daxpy(own.m, an->spring[k] * p->an->a[k], an->R + (size_t)k * own.m,
                1, an->f, 1);
  anchor_put(an, &own);
  own.f = an->f;
  own.floating = 0;
  return own;
}

status anchor_solve(const anchor *an, const contact_problem *cp,
                    const anchored_solver *inner, const solver_control *control,
                    double *u, double *r, solver_report *rep) {
  passes p = {.an = an, .cp = cp, .lowest = HUGE_VAL};
  solver_control own = *control;
  *rep = (solver_report){.outcome = RUNNING, .residual = 1.0};
  place(an, cp->m, u, an->a);
  COPY(an->at, an->a, an->n_mode);
  CLEAR(an->step, an->n_mode);
  p.load = largest_entry(cp->m, cp->f);
  for (int k = 0; k < PASSES && rep->outcome == RUNNING; ++k) {
    solver_report pass;
    contact_problem held = anchored(&p);
    if (control->max_iter > 0)
      own.max_iter = control->max_iter - rep->iterations;
    /* Of a body without a load any residual is large. */
    own.tol = fmax(
        FINEST * control->tol,
        fmin(p.since > 0 ? FINER * own.tol : COARSEST, FINER * rep->residual));
    PASS(inner->solve(inner->ctx, &held, &own, u, r, &pass));
    own.no_restart = control->no_restart || pass.outcome < 0;
    rep->iterations += pass.iterations;
    rep->limit_updates += pass.limit_updates;
    rep->rate = pass.rate;
    rep->residual = contact_residual(cp, u, r);
    follow(&p, u);
    rep->outcome = check(&p, control->tol, r, rep, pass.outcome);
    if (rep->outcome == RUNNING && p.steady > 0) fly(&p, u);
    if (rep->outcome == RUNNING && control->max_iter > 0 &&
        rep->iterations >= control->max_iter)
      rep->outcome = STOPPED_ITERATIONS;
  }
  if (rep->outcome == RUNNING) rep->outcome = STOPPED_ITERATIONS;
  return OK;
}
