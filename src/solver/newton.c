/*
 * Semismooth Newton method of the natural map (Alart, Curnier 1991) written as
 * a primal-dual active set (Hueber, Stadler, Wohlmuth 2008).
 *
 * Each step guesses the state of every unknown and solves one linear system in
 * the unknowns that are free under the guess:
 *   closed      u_n = gap             known
 *   open        r_n = 0               A u - f = 0
 *   stick       u_t = ut0             known
 *   slip        r_t = g e - kappa (I - e e') (u_t - ut0),  g = g0 - B r_n
 * with e the direction of z = r_t - c (u_t - ut0) and kappa = c g/(|z| - g),
 * the exact derivative of the projection on the disc; in 2-D e = +-1. Without
 * B in it the system is symmetric (Cholesky), else LU. c is the diagonal of A.
 *
 * The guess for the next step is read off the solution. A pattern that comes
 * back, or no progress, starts the method anew from another guess; on small
 * problems then one state is changed at a time, the least index first (Murty),
 * which ends for every P-matrix. A singular system (nothing holds the body
 * under the guess) is made regular by weak springs for the step; if the final
 * pattern is singular, that is the verdict.
 */
#include "base/memory.h"
#include "solver/solver.h"

#include <cblas.h>
#include <float.h>
#include <lapacke.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

typedef struct newton {
  int steps; /* of one attempt; 0: chosen by the program                     */
} newton;

/* clang-format off */
static const option newton_options[] = {
  OPTION_INT(newton, steps, "STEPS", 0, 10000, "0", "-",
             "steps of one attempt; 0: chosen by the program"),
  OPTION_END
};
/* clang-format on */

enum {
  HISTORY = 64,    /* patterns remembered                                   */
  FULL_STEPS = 40, /* of an attempt                                         */
  PATIENCE = 25,   /* steps without a lower residual                        */
  SMALL = 400,     /* unknowns: a step costs next to nothing                */
  MANY_STEPS = 100 /* of an attempt that makes part of the changes          */
};
static const uint64_t DICE_START = 88172645463325252u;
static const double STATE_MARGIN = 0x1p-46; /* -, of the scale: no change of
                                               state below the rounding      */
static const double WARM_SLIP = 0x1p-20; /* -, of g: counts as slipping at the
                                            start                            */
static const double SINGULAR_RCOND = 1e-13;
static const double SPRING = 0x1p-36; /* -, of the diagonal                  */

typedef enum { FREE, STICK, SLIP } tangent;

typedef struct newton_work {
  int m, n, dim, symmetric;
  double power; /* of two: A*power has a diagonal of order 1           */
  double *K;    /* [m*m] matrix of the step, times power               */
  double *rhs;  /* [m]                                               */
  double *raw;  /* [m] A u - f, N                                      */
  double *best_u, *best_r; /* [m] lowest residual                             */
  double *c;         /* [n] mean tangential diagonal, N/m                   */
  double *kappa, *g; /* [n] N/m, N                                          */
  double *e;         /* [n*(dim-1)] direction of the friction force         */
  unsigned char *closed; /* [m] normal or side bound active */
  unsigned char *mode;  /* [n] tangent                                        */
  int *free_id, *place; /* [m] free unknowns; their place, -1: known */
  int *pivot, *iwork;   /* [m]                                               */
  double *work; /* [4m] for the condition                              */
  uint64_t seen[HISTORY]; /* hashes of the patterns of the attempt           */
} newton_work;

static void newton_release(void *work) {
  newton_work *w = work;
  if (w == NULL) return;
  memory_free(w->K);
  memory_free(w->rhs);
  memory_free(w->raw);
  memory_free(w->best_u);
  memory_free(w->best_r);
  memory_free(w->c);
  memory_free(w->kappa);
  memory_free(w->g);
  memory_free(w->e);
  memory_free(w->closed);
  memory_free(w->mode);
  memory_free(w->free_id);
  memory_free(w->place);
  memory_free(w->pivot);
  memory_free(w->iwork);
  memory_free(w->work);
  memory_free(w);
}

/* 1: A equals its transpose but for rounding. */
static int is_symmetric(int m, const double *A, double largest) {
  for (size_t j = 0; j < (size_t)m; ++j)
    for (size_t i = 0; i < j; ++i)
      if (fabs(A[i + (size_t)m * j] - A[j + (size_t)m * i]) > 0x1p-40 * largest)
        return 0;
  return 1;
}

static status newton_setup(const contact_problem *cp, const void *par,
                           void **work) {
  status st = OK;
  newton_work *w = NULL;
  size_t m = (size_t)cp->m;
  (void)par;
  NEW(w, 1);
  w->m = cp->m;
  w->n = cp->n;
  w->dim = cp->dim;
  NEW(w->K, m * m);
  NEW(w->rhs, m);
  NEW(w->raw, m);
  NEW(w->best_u, m);
  NEW(w->best_r, m);
  NEW(w->c, cp->n);
  NEW(w->kappa, cp->n);
  NEW(w->g, cp->n);
  NEW(w->e, cp->n * (cp->dim - 1));
  NEW(w->closed, m);
  NEW(w->mode, cp->n);
  NEW(w->free_id, m);
  NEW(w->place, m);
  NEW(w->pivot, m);
  NEW(w->iwork, m);
  NEW(w->work, 4 * m);
  double largest = 0.0;
  for (size_t i = 0; i < m; ++i) largest = fmax(largest, cp->A[i * m + i]);
  int exponent = 0;
  if (largest > 0.0 && largest < HUGE_VAL) frexp(largest, &exponent);
  w->power = ldexp(1.0, -exponent);
  w->symmetric = is_symmetric(cp->m, cp->A, largest);
  for (int i = 0; i < cp->n; ++i) {
    for (int k = 1; k < cp->dim; ++k) {
      size_t dof = (size_t)(i * cp->dim + k);
      w->c[i] += cp->A[dof * m + dof] / (cp->dim - 1);
    }
  }
  *work = w;
  w = NULL;
done:
  newton_release(w);
  return st;
}

/* ---- a run ------------------------------------------------------------- */

typedef struct run {
  const contact_problem *cp;
  newton_work *w;
  const solver_control *control;
  double *u, *r;
  double scale, best; /* N; lowest residual, -                               */
  int n_free, steps;  /* of the linear system; made so far                   */
  int singular;       /* the last system needed springs                      */
  int careful;        /* one state changed at a time, the least index first  */
  uint64_t dice;      /* not 0: each change is made or put off at random     */
} run;

static int held(const contact_problem *cp, int dof) {
  return cp->held != NULL && cp->held[dof];
}

static double bound_of(const contact_problem *cp, int dof) {
  int node_id = dof / cp->dim, k = dof % cp->dim;
  if (k == 0) return cp->gap[node_id];
  if (cp->side_gap == NULL) return HUGE_VAL;
  return cp->side_gap[node_id * (cp->dim - 1) + k - 1];
}

static double stick_of(const contact_problem *cp, int dof) {
  int node_id = dof / cp->dim, k = dof % cp->dim;
  return cp->ut0 == NULL ? 0.0 : cp->ut0[node_id * (cp->dim - 1) + k - 1];
}

static int has_side(const contact_problem *cp, int node_id) {
  for (int k = 1; k < cp->dim; ++k)
    if (bound_of(cp, node_id * cp->dim + k) < HUGE_VAL) return 1;
  return 0;
}

/* Slip of a node in the directions friction acts in, m. */
static void slip_of(const run *s, int node_id, double *slip) {
  slip[1] = 0.0;
  for (int k = 1; k < s->cp->dim; ++k) {
    int dof = node_id * s->cp->dim + k;
    slip[k - 1] = held(s->cp, dof) ? 0.0 : s->u[dof] - stick_of(s->cp, dof);
  }
}

/* ---- the linear system ------------------------------------------------- */

/* Put the known unknowns in place and list the free ones. */
static void set_known(run *s) {
  const contact_problem *cp = s->cp;
  newton_work *w = s->w;
  s->n_free = 0;
  for (int dof = 0; dof < cp->m; ++dof) {
    int node_id = dof / cp->dim, known = 1;
    if (held(cp, dof))
      s->u[dof] = cp->f[dof] / cp->A[(size_t)dof * (size_t)cp->m + (size_t)dof];
    else if (w->closed[dof])
      s->u[dof] = bound_of(cp, dof);
    else if (dof % cp->dim > 0 && w->mode[node_id] == STICK)
      s->u[dof] = stick_of(cp, dof);
    else
      known = 0;
    w->place[dof] = known ? -1 : s->n_free;
    if (!known) w->free_id[s->n_free++] = dof;
  }
}

/* Limit under the guess, linear in the forces of the closed nodes, N. */
static double linear_limit(const run *s, int node_id) {
  const contact_problem *cp = s->cp;
  double g = cp->g0[node_id];
  if (cp->B == NULL) return g;
  for (int k = cp->B->start[node_id]; k < cp->B->start[node_id + 1]; ++k) {
    int dof = cp->B->col[k] * cp->dim;
    if (s->w->closed[dof]) g -= cp->B->val[k] * s->w->raw[dof];
  }
  return g;
}

/* Right side: minus what each free row misses at the present u. */
static void fill_rhs(run *s) {
  newton_work *w = s->w;
  int dim = s->cp->dim;
  for (int i = 0; i < s->n_free; ++i) w->rhs[i] = -w->raw[w->free_id[i]];
  for (int node_id = 0; node_id < s->cp->n; ++node_id) {
    if (w->mode[node_id] != SLIP) continue;
    const double *e = w->e + node_id * (dim - 1);
    double slip[2], along = 0.0, g = linear_limit(s, node_id);
    slip_of(s, node_id, slip);
    for (int k = 0; k < dim - 1; ++k) along += e[k] * slip[k];
    for (int k = 0; k < dim - 1; ++k) {
      int i = w->place[node_id * dim + 1 + k];
      if (i < 0) continue;
      w->rhs[i] += g * e[k] - w->kappa[node_id] * (slip[k] - along * e[k]);
    }
  }
  for (int i = 0; i < s->n_free; ++i) w->rhs[i] *= w->power;
}

/* 1: the guess couples friction to pressure: the matrix is not symmetric. */
static int coupled(const run *s) {
  const sparse_rows *B = s->cp->B;
  if (!s->w->symmetric) return 1;
  if (B == NULL) return 0;
  for (int i = 0; i < s->cp->n; ++i)
    for (int k = B->start[i]; s->w->mode[i] == SLIP && k < B->start[i + 1]; ++k)
      if (B->val[k] != 0.0 && s->w->closed[B->col[k] * s->cp->dim]) return 1;
  return 0;
}

/* Rows of slipping nodes in one column of K: e (B A_n) of the closed nodes. */
static void add_limit_rows(const run *s, const double *column, double *to) {
  const newton_work *w = s->w;
  const sparse_rows *B = s->cp->B;
  int dim = s->cp->dim;
  for (int node_id = 0; node_id < s->cp->n; ++node_id) {
    if (w->mode[node_id] != SLIP) continue;
    double sum = 0.0;
    for (int k = B->start[node_id]; k < B->start[node_id + 1]; ++k)
      if (w->closed[B->col[k] * dim])
        sum += B->val[k] * column[B->col[k] * dim];
    for (int k = 0; k < dim - 1; ++k) {
      int i = w->place[node_id * dim + 1 + k];
      if (i >= 0) to[i] += w->power * w->e[node_id * (dim - 1) + k] * sum;
    }
  }
}

/* kappa (I - e e') of the slipping nodes (3-D). */
static void add_turning(const run *s) {
  const newton_work *w = s->w;
  size_t ld = (size_t)s->n_free;
  for (int node_id = 0; node_id < s->cp->n && s->cp->dim == 3; ++node_id) {
    if (w->mode[node_id] != SLIP) continue;
    const double *e = w->e + 2 * node_id;
    for (int a = 0; a < 2; ++a)
      for (int b = 0; b < 2; ++b) {
        int i = w->place[3 * node_id + 1 + a],
            j = w->place[3 * node_id + 1 + b];
        if (i < 0 || j < 0) continue;
        w->K[(size_t)i + ld * (size_t)j] +=
            w->power * w->kappa[node_id] * ((a == b ? 1.0 : 0.0) - e[a] * e[b]);
      }
  }
}

static void fill_matrix(run *s, int full, double spring) {
  const newton_work *w = s->w;
  size_t ld = (size_t)s->n_free, m = (size_t)s->cp->m;
  for (size_t j = 0; j < ld; ++j) {
    const double *column = s->cp->A + m * (size_t)w->free_id[j];
    double *to = w->K + ld * j;
    for (size_t i = full ? 0 : j; i < ld; ++i)
      to[i] = w->power * column[w->free_id[i]];
    to[j] += spring * to[j];
    if (full && s->cp->B != NULL) add_limit_rows(s, column, to);
  }
  add_turning(s);
}

/* 1-norm of the matrix of the step. */
static double matrix_norm(const run *s, int full) {
  int n = s->n_free;
  if (full)
    return LAPACKE_dlange_work(LAPACK_COL_MAJOR, '1', n, n, s->w->K, n,
                               s->w->work);
  return LAPACKE_dlansy_work(LAPACK_COL_MAJOR, '1', 'L', n, s->w->K, n,
                             s->w->work);
}

/* Factor K in place; 1: singular to rounding. The condition is asked for only
 * where the matrix can be singular without a fault of the data. */
static int factor(run *s, int full) {
  newton_work *w = s->w;
  int n = s->n_free, doubt = full || s->cp->floating;
  double rcond = 1.0, norm = doubt ? matrix_norm(s, full) : 0.0;
  int info =
      full ? LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, n, n, w->K, n, w->pivot)
           : LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'L', n, w->K, n);
  if (info != 0) return 1;
  if (!doubt) return 0;
  if (full)
    LAPACKE_dgecon_work(LAPACK_COL_MAJOR, '1', n, w->K, n, norm, &rcond,
                        w->work, w->iwork);
  else
    LAPACKE_dpocon_work(LAPACK_COL_MAJOR, 'L', n, w->K, n, norm, &rcond,
                        w->work, w->iwork);
  return !(rcond > SINGULAR_RCOND);
}

/* Solve the system of the guess; u is moved, raw = A u - f. */
static void linear_step(run *s) {
  newton_work *w = s->w;
  set_known(s);
  contact_reaction(s->cp, s->u, w->raw);
  s->singular = 0;
  if (s->n_free == 0) return;
  int n = s->n_free, full = coupled(s);
  fill_rhs(s);
  fill_matrix(s, full, 0.0);
  if (factor(s, full)) {
    s->singular = 1;
    full = 1;
    fill_matrix(s, full, SPRING);
    LAPACKE_dgetrf_work(LAPACK_COL_MAJOR, n, n, w->K, n, w->pivot);
  }
  if (full)
    LAPACKE_dgetrs_work(LAPACK_COL_MAJOR, 'N', n, 1, w->K, n, w->pivot, w->rhs,
                        n);
  else
    LAPACKE_dpotrs_work(LAPACK_COL_MAJOR, 'L', n, 1, w->K, n, w->rhs, n);
  for (int i = 0; i < n; ++i) s->u[w->free_id[i]] += w->rhs[i];
  contact_reaction(s->cp, s->u, w->raw);
}

/* |r_t| = g at a slipping node: the force along e is set to the limit, or,
 * where a small error of the pressure makes a large one of the limit (mu > 1),
 * the pressure to the force. */
static void clean_slip(const run *s, int node_id) {
  const contact_problem *cp = s->cp;
  double *r = s->r + node_id * cp->dim, size = 0.0, mu = 0.0;
  for (int k = 1; k < cp->dim; ++k)
    if (!held(cp, node_id * cp->dim + k)) size += r[k] * r[k];
  size = sqrt(size);
  double g = contact_node_limit(cp, s->r, node_id);
  for (int k = cp->B != NULL ? cp->B->start[node_id] : 0;
       cp->B != NULL && k < cp->B->start[node_id + 1]; ++k)
    if (cp->B->col[k] == node_id) mu = cp->B->val[k];
  if (mu > 1.0 && s->w->closed[node_id * cp->dim] && r[0] < 0.0) {
    double p = -r[0] + (size - g) / mu;
    if (p > 0.0) r[0] = -p;
    return;
  }
  for (int k = 1; k < cp->dim && size > 0.0; ++k)
    if (!held(cp, node_id * cp->dim + k)) r[k] *= g / size;
}

/* r from raw with what the state fixes put in exactly: no force where open,
 * |r_t| = g where slipping. Returns the largest change made, N: the defect of
 * the linear solution. */
static double clean_reaction(run *s) {
  const contact_problem *cp = s->cp;
  newton_work *w = s->w;
  double worst = 0.0;
  memcpy(s->r, w->raw, (size_t)cp->m * sizeof *s->r);
  for (int dof = 0; dof < cp->m; ++dof) {
    int k = dof % cp->dim;
    int none = !w->closed[dof] && (k == 0 || w->mode[dof / cp->dim] == FREE);
    if (none || held(cp, dof)) s->r[dof] = 0.0;
  }
  for (int node_id = 0; node_id < cp->n; ++node_id)
    if (w->mode[node_id] == SLIP) clean_slip(s, node_id);
  for (int dof = 0; dof < cp->m; ++dof) {
    double d = fabs(s->r[dof] - w->raw[dof]);
    if (!(d <= worst)) worst = d;
  }
  return worst;
}

/* ---- states ------------------------------------------------------------ */

/* A node slips: direction and turning stiffness from z. */
static void set_slip(newton_work *w, int node_id, const double *z, double size,
                     double g) {
  int tangents = w->dim - 1;
  w->mode[node_id] = SLIP;
  for (int k = 0; k < tangents; ++k) w->e[node_id * tangents + k] = z[k] / size;
  double c = w->c[node_id];
  w->kappa[node_id] = size - g > 0x1p-20 * g ? c * g / (size - g) : 0x1p20 * c;
}

/* State of friction from z = r_t - c slip; the state before decides ties. */
static void friction_state(run *s, int node_id, int fresh) {
  newton_work *w = s->w;
  int tangents = w->dim - 1, first = node_id * w->dim + 1;
  tangent before = fresh ? FREE : (tangent)w->mode[node_id];
  double slip[2], z[2], size = 0.0, along = 0.0;
  double g = w->g[node_id] = contact_node_limit(s->cp, s->r, node_id);
  double margin = STATE_MARGIN * s->scale;
  slip_of(s, node_id, slip);
  for (int k = 0; k < tangents; ++k) {
    double force = held(s->cp, first + k) ? 0.0 : s->r[first + k];
    z[k] = before == STICK ? force : force - w->c[node_id] * slip[k];
    size += z[k] * z[k];
    along += w->e[node_id * tangents + k] * slip[k];
  }
  size = sqrt(size);
  if (!(g > 0.0)) {
    w->mode[node_id] = FREE;
    return;
  }
  if (before == SLIP && tangents == 1 && along * w->c[node_id] <= margin)
    return;
  w->mode[node_id] = STICK;
  if (before == SLIP && along * w->c[node_id] > margin) return;
  if (fresh ? size < g * (1.0 - WARM_SLIP) : size <= g + margin) return;
  if (size > 0.0) set_slip(w, node_id, z, size, g);
}

/* Normal or side unknown: 1 closed. */
static int closed_state(run *s, int dof, int fresh) {
  size_t at = (size_t)dof * (size_t)s->cp->m + (size_t)dof;
  double over = s->cp->A[at] * (s->u[dof] - bound_of(s->cp, dof));
  double margin = STATE_MARGIN * s->scale;
  if (fresh) return s->r[dof] < 0.0 || over >= 0.0;
  if (s->w->closed[dof]) return s->r[dof] <= margin;
  return over > margin;
}

/* Friction of a node under the guess, to take a change back. */
typedef struct node_friction {
  unsigned char mode;
  double e[2], kappa;
} node_friction;

static node_friction friction_of(const newton_work *w, int node_id) {
  node_friction f = {.mode = w->mode[node_id], .kappa = w->kappa[node_id]};
  for (int k = 0; k < w->dim - 1; ++k)
    f.e[k] = w->e[node_id * (w->dim - 1) + k];
  return f;
}

static void restore_friction(newton_work *w, int node_id,
                             const node_friction *f) {
  w->mode[node_id] = f->mode;
  w->kappa[node_id] = f->kappa;
  for (int k = 0; k < w->dim - 1; ++k)
    w->e[node_id * (w->dim - 1) + k] = f->e[k];
}

/* 1: put this change off. Reproducible: the dice start at the same number. */
static int put_off(run *s, int changes) {
  if (s->careful) return changes > 0;
  if (s->dice == 0) return 0;
  s->dice ^= s->dice << 13;
  s->dice ^= s->dice >> 7;
  s->dice ^= s->dice << 17;
  return (int)(s->dice >> 60 & 1u);
}

/* Read the next guess off (u, r); returns the number of states that would
 * change; some may be put off. */
static int next_states(run *s, int fresh) {
  const contact_problem *cp = s->cp;
  newton_work *w = s->w;
  int changes = 0;
  for (int node_id = 0; node_id < cp->n; ++node_id) {
    int sided = has_side(cp, node_id);
    for (int k = 0; k < (sided ? cp->dim : 1); ++k) {
      int dof = node_id * cp->dim + k;
      if (k > 0 && !(bound_of(cp, dof) < HUGE_VAL)) continue;
      unsigned char now = (unsigned char)closed_state(s, dof, fresh);
      if (now == w->closed[dof]) continue;
      if (!put_off(s, changes++)) w->closed[dof] = now;
    }
    if (cp->g0 == NULL || sided) continue;
    node_friction before = friction_of(w, node_id);
    friction_state(s, node_id, fresh);
    if (w->mode[node_id] == before.mode) continue;
    if (put_off(s, changes++)) restore_friction(w, node_id, &before);
  }
  return changes;
}

static void all_stick(run *s) {
  const contact_problem *cp = s->cp;
  memset(s->w->closed, 0, (size_t)cp->m);
  for (int i = 0; i < cp->n; ++i) {
    s->w->closed[i * cp->dim] = 1;
    s->w->mode[i] =
        cp->g0 != NULL && !has_side(cp, i) ? (unsigned char)STICK : FREE;
  }
}

/* FNV-1a over the pattern. */
static uint64_t pattern_hash(const run *s) {
  uint64_t h = 1469598103934665603u;
  for (int i = 0; i < s->cp->m; ++i) h = (h ^ s->w->closed[i]) * 1099511628211u;
  for (int i = 0; i < s->cp->n; ++i) {
    uint64_t sign =
        s->w->mode[i] == SLIP && s->w->e[i * (s->cp->dim - 1)] > 0.0 ? 4u : 0u;
    h = (h ^ (s->w->mode[i] | sign)) * 1099511628211u;
  }
  return h;
}

/* ---- attempts ---------------------------------------------------------- */

static void tell(const run *s, double residual, int changes, int cycle) {
  const solver_listener *l = s->control->listener;
  if (l == NULL || l->step == NULL) return;
  solver_step step = {.solver = "newton",
                      .iteration = s->steps,
                      .limit_update = s->control->limit_update,
                      .residual = residual,
                      .limit_change = NAN,
                      .status_changes = changes,
                      .cycle = cycle};
  l->step(l->ctx, &step);
}

static double residual_of(run *s) {
  double defect = clean_reaction(s);
  double worst = contact_mismatch(s->cp, s->u, s->r);
  if (isnan(defect) || isnan(worst)) return NAN;
  if (defect > worst) worst = defect;
  if (s->scale > 0.0) return worst / s->scale;
  return worst > 0.0 ? HUGE_VAL : 0.0;
}

static void keep_best(run *s, double residual) {
  if (!(residual < s->best)) return;
  s->best = residual;
  memcpy(s->w->best_u, s->u, (size_t)s->cp->m * sizeof *s->u);
  memcpy(s->w->best_r, s->r, (size_t)s->cp->m * sizeof *s->r);
}

/* 1: the pattern has been met in this attempt. */
static int met_before(run *s, int step) {
  uint64_t h = pattern_hash(s);
  int met = 0;
  for (int j = 0; j < step && j < HISTORY; ++j) met = met || s->w->seen[j] == h;
  s->w->seen[step % HISTORY] = h;
  return met;
}

/* How an attempt goes. */
typedef struct course {
  double lowest;      /* residual, -                                      */
  int at, best_at;    /* this step, the one of the lowest residual        */
  int changes, cycle; /* states that would change; pattern met before     */
  int settled;        /* the step before was within the tolerance         */
} course;

/* 1: solved, and a further step would change nothing or little. */
static int solved(const run *s, course *c, double residual) {
  int within = residual <= s->control->tol;
  int rests = c->changes == 0 || c->settled || residual <= 0x1p-43;
  c->settled = within;
  return within && rests;
}

/* RUNNING, or why the attempt ends without a solution. */
static outcome verdict(const run *s, course *c, double residual) {
  int full = !s->careful && s->dice == 0, plane = s->cp->dim == 2;
  if (residual < 0.99 * c->lowest) {
    c->lowest = residual;
    c->best_at = c->at;
  }
  int stays =
      c->changes == 0 && (plane || (full && c->at - c->best_at > PATIENCE));
  if (stays) return s->singular ? STOPPED_RAY : STOPPED_STAGNATION;
  if (plane && c->cycle && s->dice == 0) return STOPPED_CYCLE;
  if (full && c->at - c->best_at > PATIENCE) return STOPPED_STAGNATION;
  return RUNNING;
}

/* Steps from the present guess until solved, settled, cycling or "limit". */
static outcome attempt(run *s, int limit) {
  course c = {.lowest = HUGE_VAL};
  int allowed = s->control->max_iter;
  for (c.at = 0; c.at < limit; ++c.at) {
    if (allowed > 0 && s->steps >= allowed) break;
    c.cycle = met_before(s, c.at);
    linear_step(s);
    ++s->steps;
    double residual = residual_of(s);
    if (isnan(residual)) return STOPPED_NAN;
    keep_best(s, residual);
    c.changes = next_states(s, 0);
    tell(s, residual, c.changes, c.cycle);
    if (solved(s, &c, residual)) return CONVERGED;
    outcome o = verdict(s, &c, residual);
    if (o != RUNNING) return o;
  }
  return STOPPED_ITERATIONS;
}

/* Go on from the state with the lowest residual. */
static void return_to_best(run *s) {
  if (!(s->best < HUGE_VAL)) return;
  memcpy(s->u, s->w->best_u, (size_t)s->cp->m * sizeof *s->u);
  memcpy(s->r, s->w->best_r, (size_t)s->cp->m * sizeof *s->r);
  next_states(s, 1);
}

/* 1: nothing to add. Without B the problem is convex: a ray is a proof. */
static int final(const run *s, outcome o) {
  return o == CONVERGED || o == STOPPED_NAN ||
         (o == STOPPED_RAY && s->cp->B == NULL);
}

/* Attempts one after the other; a verdict of an attempt with all changes made
 * (no equilibrium, cycle) counts more than one of those after it. */
static outcome newton_run(run *s, const newton *p) {
  int limit = p->steps > 0 ? p->steps : FULL_STEPS;
  int many = s->cp->m <= SMALL ? MANY_STEPS : limit;
  next_states(s, 1);
  outcome o = attempt(s, limit), first = o;
  if (s->control->no_restart || final(s, o)) return o;
  all_stick(s);
  o = first = attempt(s, limit);
  if (o == STOPPED_RAY || final(s, o)) return o;
  return_to_best(s);
  s->dice = DICE_START;
  o = attempt(s, many);
  s->dice = 0;
  if (final(s, o)) return o;
  return_to_best(s);
  s->careful = 1;
  o = attempt(s, many);
  return final(s, o) ? o : first;
}

static status newton_solve(const contact_problem *cp, const void *par,
                           void *work, const solver_control *control, double *u,
                           double *r, solver_report *rep) {
  newton_work *w = work;
  run s = {.cp = cp,
           .w = w,
           .control = control,
           .u = u,
           .r = r,
           .scale = contact_scale(cp),
           .best = HUGE_VAL};
  *rep = (solver_report){.outcome = RUNNING};
  memset(w->closed, 0, (size_t)cp->m);
  memset(w->mode, FREE, (size_t)cp->n);
  rep->outcome = newton_run(&s, par);
  rep->iterations = s.steps;
  rep->residual = s.best;
  if (s.best < HUGE_VAL) {
    memcpy(u, w->best_u, (size_t)cp->m * sizeof *u);
    memcpy(r, w->best_r, (size_t)cp->m * sizeof *r);
  }
  return OK;
}

/* clang-format off */
const solver_ops newton_solver = {
  .name = "newton",
  .reference = "Alart, Curnier 1991; Hueber, Stadler, Wohlmuth 2008",
  .help =
    "Semismooth Newton method on the natural map of contact and friction,\n"
    "written as a primal-dual active set. Each step guesses which nodes are\n"
    "open, stick or slip, solves one dense linear system in the displacements\n"
    "that are free under the guess, and corrects the guess. Friction follows\n"
    "the pressure inside the step; in 3-D the slip turns with the exact\n"
    "derivative of the friction disc. Typically 5 to 15 steps from a cold and\n"
    "2 to 4 from a warm start, to full accuracy, whatever the size. If a\n"
    "pattern of states comes back the method starts anew from another guess.\n"
    "The first choice for all but very large problems and large friction.",
  .handles = SOLVES_TRESCA | SOLVES_COULOMB | SOLVES_3D | NEEDS_STIFFNESS |
             SOLVES_FLOATING,
  .param_size = sizeof(newton),
  .options = newton_options,
  .setup = newton_setup,
  .solve = newton_solve,
  .release = newton_release
};
/* clang-format on */
