/*
 * Augmented Lagrangian of Alart and Curnier (1991; CPR98, 3.3). With
 * x = u - o the displacement from the gap and the stick position and
 *
 *   F(z) = (min(z_n, 0), P_g(z_t)),   z = lambda - rho x,
 *
 * P_g the projection on the disc |.| <= g, contact with friction is
 *
 *   A u - f - F = 0,   lambda = F,   g = g0 - B F_n.
 *
 * VARIANT=NEWTON: generalised Newton method for both equations at once. The
 * first is linear, so lambda = A u - f is put into the second,
 *
 *   Phi(u) = A u - f - F(A u - f - rho x) = 0,
 *   (A - F'(A - rho)) du = -Phi,
 *
 * F' with the limit following the pressure. Rows of closed and of sticking
 * unknowns hold rho alone and are eliminated. The step is shortened until
 * |Phi| falls. Should it stop, the other variant goes on. Where contact alone
 * holds the body springs on the free unknowns keep it in place, softer as the
 * residual falls (Levenberg, Marquardt).
 *
 * VARIANT=UZAWA: u minimises the augmented Lagrangian for fixed lambda and g,
 *
 *   A u - f - F(lambda - rho x) = 0,
 *
 * a convex function with a continuous gradient, by Newton's method with the
 * matrix A + F' rho and a search along the step for a zero of the slope; then
 * lambda <- F. The error falls by about lmax(A)/rho a multiplier step. The
 * limit is updated around it (CPR98, 2.3).
 *
 * rho is a multiple of the diagonal of A, equal in the tangents of a node.
 *
 * Of an operator the equations of both variants are solved as those of NEWTON
 * (system.h). With F' = s (I - e e') where a node slips, s = g/|z|, those of
 * VARIANT=NEWTON are, multiplied by inv(I - F'),
 *
 *   (A_t + rho s/(1 - s) (I - e e') + e B A_n) du = g e - y - ...,
 *
 * the very step of NEWTON for these states.
 */
#include "base/number.h"
#include "solver/fixed_point.h"
#include "solver/newton/system.h"

#include <cblas.h>
#include <lapacke.h>

enum {
  NEWTON_STEPS = 60, /* of the generalised Newton method */
  SHORTENINGS = 10   /* of one step */
};

static const double SPRING = 0x1p-36; /* -, of the diagonal */
static const double STIFFER = 0x1p-6; /* -, where the residual is above that */

typedef enum { OPEN, CLOSED } contact_state;

typedef struct auglag_work {
  int m;                      /* unknowns */
  unsigned char *part;        /* [m] force_part */
  unsigned char *closed;      /* [m] contact_state of the unknowns that push */
  unsigned char *mode;        /* [n] tangent */
  unsigned char *state;       /* [m] of the step reported last */
  double *origin;             /* [m] m */
  double *diagonal;           /* [m] of A, the mean in a tangent plane, N/m */
  double *lambda, *z, *F, *y; /* [m] N; y = A u - f. Newton: work, work */
  double *du, *dy;            /* [m] step, A du */
  double *bonded;             /* [n] no limit */
  double *e, *share;          /* [m] direction of slip, [n] g/|z| */
  double *K;                  /* [m*m] */
  double power;               /* of two: power*A has a diagonal of order 1 */
  /* hashes of the states of the steps */
  uint64_t seen[NEWTON_STEPS + 1];
  int *pivot, *free_id;      /* [m] */
  struct {                   /* in the place of K, pivot and free_id */
    operated_system *system; /* NULL: A has entries */
    pattern guess;
    double *hold, *b; /* [m] N/m, N */
  } by;
  fixed_point *fixed;
  best_iterate best;
} auglag_work;

typedef struct auglag_run {
  const contact_problem *cp;
  auglag_work *w;
  const solver_control *control;
  double *u, *r;
  double scale, rho; /* N; -, of the diagonal */
  double spring;     /* -, of it, of a step */
  int steps, limit;
  int changes;   /* states changed by the last evaluation */
  int turned;    /* nodes with another state than after the step before */
  int bent;      /* 1: F' of a slipping node moves with z (3-D) */
  int factored;  /* w->K is the factor for the present states */
  int singular;  /* the last matrix needed springs */
  int cycle;     /* the states occurred before in these Newton steps */
  status failed; /* of a step, ERR_MEMORY: the method ends */
} auglag_run;

/* ---- the augmented forces F(z), the states of the nodes they stand for, and
 * the residual of (u, F). */

/* rho of an unknown, N/m. */
static double auglag_rho(const auglag_run *s, int dof) {
  return s->rho * s->w->diagonal[dof];
}

/* F in the tangent plane of a node. */
static void tangent_force(auglag_run *s, int node_id) {
  const contact_problem *cp = s->cp;
  auglag_work *w = s->w;
  double size = 0.0, g = contact_node_limit(cp, w->F, node_id);
  tangent now = FREE;
  for (int dof = node_id * cp->dim + 1; dof < (node_id + 1) * cp->dim; ++dof)
    if (w->part[dof] == IN_DISC) size += w->z[dof] * w->z[dof];
  size = sqrt(size);
  if (g > 0.0) now = size > g ? SLIP : STICK;
  w->share[node_id] = now == FREE ? 0.0 : now == SLIP ? g / size : 1.0;
  for (int dof = node_id * cp->dim + 1; dof < (node_id + 1) * cp->dim; ++dof) {
    if (w->part[dof] != IN_DISC) continue;
    double e = size > 0.0 ? w->z[dof] / size : 0.0;
    w->F[dof] = w->share[node_id] * w->z[dof];
    if (now == SLIP && e * w->e[dof] < 0.0) ++s->changes;
    w->e[dof] = e;
  }
  s->changes += now != w->mode[node_id];
  s->bent = s->bent || (now == SLIP && cp->dim == 3);
  w->mode[node_id] = (unsigned char)now;
}

/* z, F and the states from base (lambda, or y) and u. */
static void auglag_evaluate(auglag_run *s, const double *base) {
  const contact_problem *cp = s->cp;
  auglag_work *w = s->w;
  s->changes = s->bent = 0;
  for (int dof = 0; dof < cp->m; ++dof) {
    w->F[dof] = 0.0;
    if (w->part[dof] == NO_FORCE) continue;
    w->z[dof] = base[dof] - auglag_rho(s, dof) * (s->u[dof] - w->origin[dof]);
    if (w->part[dof] != PUSH) continue;
    contact_state now = w->z[dof] < 0.0 ? CLOSED : OPEN;
    if (now == CLOSED) w->F[dof] = w->z[dof];
    s->changes += now != w->closed[dof];
    w->closed[dof] = (unsigned char)now;
  }
  for (int i = 0; i < cp->n && cp->g0 != NULL; ++i) tangent_force(s, i);
  if (s->changes > 0 || s->bent) s->factored = 0;
}

/* 1: an unknown in the tangent plane of a node that slips. */
static int auglag_slips(const auglag_run *s, int dof) {
  return s->w->part[dof] == IN_DISC && s->w->mode[dof / s->cp->dim] == SLIP;
}

/* 1: F of the unknown is z. */
static int auglag_is_fixed(const auglag_run *s, int dof) {
  if (s->w->part[dof] == PUSH) return s->w->closed[dof] == CLOSED;
  return s->w->part[dof] == IN_DISC && s->w->mode[dof / s->cp->dim] == STICK;
}

/* share (I - e e') of a slipping node, entry of two of its unknowns. */
static double auglag_turning(const auglag_run *s, int a, int b) {
  const auglag_work *w = s->w;
  if (s->cp->dim == 2 || !auglag_slips(s, a) || !auglag_slips(s, b)) return 0.0;
  return w->share[a / s->cp->dim] * ((a == b) - w->e[a] * w->e[b]);
}

/* The nodes whose state differs from that after the step before, w->state;
 * take: the states go there. */
static int auglag_turned(auglag_run *s, int take) {
  auglag_work *w = s->w;
  int dim = s->cp->dim, turned = 0;
  for (int node_id = 0; node_id < s->cp->n; ++node_id) {
    int differs = 0;
    for (int dof = node_id * dim; dof < (node_id + 1) * dim; ++dof) {
      int sign = auglag_slips(s, dof) && w->e[dof] > 0.0;
      unsigned char now =
          (unsigned char)(w->closed[dof] | w->mode[node_id] << 1 | sign << 3);
      differs = differs || now != w->state[dof];
      if (take) w->state[dof] = now;
    }
    turned += differs;
  }
  return turned;
}

/* Residual of (u, F), reported; the best iterate is stored. */
static double auglag_check(auglag_run *s) {
  auglag_work *w = s->w;
  double residual = contact_mismatch(s->cp, s->scale, s->u, w->F, w->y);
  solver_keep_best(&w->best, s->cp->m, residual, s->u, w->F);
  solver_report_states(s->control, "auglag", s->steps, residual, s->turned,
                       s->cycle);
  return residual;
}

/* u += a du, y += a dy */
static void auglag_move(auglag_run *s, double a) {
  cblas_daxpy(s->cp->m, a, s->w->du, 1, s->u, 1);
  cblas_daxpy(s->cp->m, a, s->w->dy, 1, s->w->y, 1);
}

/* ---- steps of an operator ------------------------------------------------ */

static const double STIFFEST = 0x1p20; /* -, of rho: slip that hardly turns */

/* Node i slips with this share of its turning stiffness rho. */
static void put_slip(auglag_run *s, int i, double turning) {
  const int dim = s->cp->dim, first = i * dim + 1;
  pattern *p = &s->w->by.guess;
  p->mode[i] = SLIP;
  p->kappa[i] = auglag_rho(s, first) * fmin(turning, STIFFEST);
  for (int k = 0; k < dim - 1; ++k)
    p->e[i * (dim - 1) + k] =
        auglag_slips(s, first + k) ? s->w->e[first + k] : 0;
}

/* du and dy; 0: ERR_MEMORY, in s->failed. */
static int operated_direction(auglag_run *s, const double *hold) {
  auglag_work *w = s->w;
  const operated_rows rows = {&w->by.guess, hold, w->by.b};
  s->failed = operated_system_direction(w->by.system, s->cp, &rows, w->du,
                                        w->dy, &s->singular);
  return s->failed == OK;
}

/* ---- VARIANT=NEWTON: the generalised Newton method for both equations at
 * once. */

static const double RHO_NEWTON = 0x1p-2; /* -, of diag A */
static const double DESCENT = 1e-4;      /* -, share of the slope */
static const double LEVEL = 0x1p-40;     /* -, of |Phi|^2: none */
enum { MEMORY = 4 /* steps |Phi| is compared with */ };

/* Row of (A - F'(A - rho)) d of a free unknown; v = A d, d[m]. */
static double newton_row(const auglag_run *s, int row, const double *v,
                         const double *d) {
  const contact_problem *cp = s->cp;
  int node_id = row / cp->dim, first = node_id * cp->dim;
  double value = v[row];
  if (!auglag_slips(s, row)) return value;
  for (int b = first + 1; b < first + cp->dim; ++b)
    value -= auglag_turning(s, row, b) * (v[b] - auglag_rho(s, b) * d[b]);
  if (cp->B == NULL) return value;
  for (int k = cp->B->start[node_id]; k < cp->B->start[node_id + 1]; ++k) {
    int n = cp->B->col[k] * cp->dim;
    if (s->w->closed[n] == CLOSED)
      value += s->w->e[row] * cp->B->val[k] * (v[n] - auglag_rho(s, n) * d[n]);
  }
  return value;
}

/* The unknowns fixed by the states go into du, the others are listed; returns
 * their number. */
static int known_steps(auglag_run *s) {
  auglag_work *w = s->w;
  int n = 0;
  for (int dof = 0; dof < s->cp->m; ++dof) {
    w->du[dof] = 0.0;
    if (auglag_is_fixed(s, dof))
      w->du[dof] = (w->F[dof] - w->y[dof]) / auglag_rho(s, dof);
    else
      w->free_id[n++] = dof;
  }
  return n;
}

/* Rows and columns of the n free unknowns, times power, springs where contact
 * alone holds the body; returns the number of rows that slip. */
static int newton_matrix(auglag_run *s, int n) {
  const contact_problem *cp = s->cp;
  auglag_work *w = s->w;
  double *unit = w->z;
  int slipping = 0;
  CLEAR(unit, cp->m);
  for (int j = 0; j < n; ++j) {
    const double *column = cp->A + (size_t)cp->m * w->free_id[j];
    double *to = w->K + (size_t)n * j;
    for (int i = 0; i < n; ++i) to[i] = w->power * column[w->free_id[i]];
    slipping += auglag_slips(s, w->free_id[j]);
  }
  for (int j = 0; j < n && slipping > 0; ++j) {
    int dof = w->free_id[j];
    const double *column = cp->A + (size_t)cp->m * dof;
    unit[dof] = 1.0;
    for (int i = 0; i < n; ++i)
      if (auglag_slips(s, w->free_id[i]))
        w->K[i + (size_t)n * j] =
            w->power * newton_row(s, w->free_id[i], column, unit);
    unit[dof] = 0.0;
  }
  for (int i = 0; cp->floating && i < n; ++i)
    w->K[i * ((size_t)n + 1)] +=
        w->power * s->spring * w->diagonal[w->free_id[i]];
  return slipping;
}

/* The same of an operator. */
static int newton_operated(auglag_run *s) {
  const contact_problem *cp = s->cp;
  auglag_work *w = s->w;
  pattern *p = &w->by.guess;
  for (int dof = 0; dof < cp->m; ++dof)
    p->closed[dof] = w->part[dof] == PUSH && w->closed[dof] == CLOSED;
  for (int i = 0; i < cp->n; ++i) {
    p->mode[i] = w->mode[i];
    if (w->mode[i] == SLIP) put_slip(s, i, w->share[i] / (1.0 - w->share[i]));
  }
  newton_list_known(cp, p, s->u, w->du);
  newton_load(cp, p, 1.0, s->u, w->y, w->by.b);
  for (int dof = 0; dof < cp->m; ++dof)
    w->by.hold[dof] = p->place[dof] < 0 ? 0.0 : s->spring * w->diagonal[dof];
  return operated_direction(s, cp->floating ? w->by.hold : NULL);
}

/* du of a Newton step; 0: the matrix is singular. */
static int newton_direction(auglag_run *s) {
  const contact_problem *cp = s->cp;
  auglag_work *w = s->w;
  if (cp->op != NULL) return newton_operated(s);
  int n = known_steps(s), info = 0;
  contact_product(cp->m, cp->A, w->du, w->dy);
  for (int i = 0; i < n; ++i) {
    int dof = w->free_id[i];
    w->lambda[i] =
        w->power * (w->F[dof] - w->y[dof] - newton_row(s, dof, w->dy, w->du));
  }
  if (n > 0 && newton_matrix(s, n) > 0)
    info = LAPACKE_dgesv_work(LAPACK_COL_MAJOR, n, 1, w->K, n, w->pivot,
                              w->lambda, n);
  else if (n > 0)
    info =
        LAPACKE_dposv_work(LAPACK_COL_MAJOR, 'L', n, 1, w->K, n, w->lambda, n);
  if (info != 0) return 0;
  for (int i = 0; i < n; ++i) w->du[w->free_id[i]] = w->lambda[i];
  contact_product(cp->m, cp->A, w->du, w->dy);
  return 1;
}

/* |Phi|^2 in the metric of the diagonal, N m. */
static double merit(const auglag_run *s) {
  const auglag_work *w = s->w;
  double sum = 0.0;
  for (int i = 0; i < s->cp->m; ++i) {
    double d = w->y[i] - w->F[i];
    if (d != 0.0) sum += d * d / w->diagonal[i];
  }
  return sum;
}

/* 1: a step of this length brings |Phi| below the reference; or leaves it there
 * with all states, as a rigid motion does of a body held by contact alone. */
static int step_is_accepted(auglag_run *s, double a, double now,
                            double reference) {
  if (now <= (1.0 - DESCENT * a) * reference) return 1;
  return s->cp->floating && now <= (1.0 + LEVEL) * reference &&
         auglag_turned(s, 0) == 0;
}

/* Shorten the step until |Phi| is below the largest of the last ones. */
static double shorten(auglag_run *s, double reference) {
  double a = 1.0, now;
  auglag_move(s, 1.0);
  auglag_evaluate(s, s->w->y);
  now = merit(s);
  for (int k = 0; k < SHORTENINGS; ++k) {
    if (step_is_accepted(s, a, now, reference)) break;
    auglag_move(s, -0.5 * a);
    a *= 0.5;
    auglag_evaluate(s, s->w->y);
    now = merit(s);
  }
  return now;
}

/* 1: the states changed in step k, and occurred before. */
static int met_before(const auglag_run *s, int k) {
  auglag_work *w = s->w;
  const uint64_t h = number_hash(HASH_START, w->state, s->cp->m);
  int met = 0;
  for (int j = 0; j + 1 < k; ++j) met = met || w->seen[j] == h;
  w->seen[k] = h;
  return met && s->turned > 0;
}

/* From u to CONVERGED, or why it stopped. */
static outcome auglag_newton(auglag_run *s) {
  auglag_work *w = s->w;
  int met = 0;
  double past[MEMORY], residual;
  s->rho = RHO_NEWTON;
  contact_reaction(s->cp, s->u, w->y);
  auglag_evaluate(s, w->y);
  for (int k = 0; k < MEMORY; ++k) past[k] = merit(s);
  for (int k = 0;; ++k) {
    s->turned = auglag_turned(s, 1);
    s->cycle = met_before(s, k);
    met += s->cycle;
    residual = auglag_check(s);
    if (isnan(residual)) return STOPPED_NAN;
    if (residual <= s->control->tol) return CONVERGED;
    if (s->steps >= s->limit) return STOPPED_ITERATIONS;
    if (k == NEWTON_STEPS)
      return 2 * met > k ? STOPPED_CYCLE : STOPPED_ITERATIONS;
    ++s->steps;
    s->spring = fmax(SPRING, fmin(STIFFER, residual));
    if (!newton_direction(s)) return STOPPED_SINGULAR;
    double reference = past[0];
    for (int i = 1; i < MEMORY; ++i) reference = fmax(reference, past[i]);
    past[k % MEMORY] = shorten(s, reference);
    contact_reaction(s->cp, s->u, w->y);
    auglag_evaluate(s, w->y);
  }
}

/* From u, then from stick without a gap: a body that contact alone holds may
 * have slid off its floor on the way. */
static outcome newton_attempts(auglag_run *s) {
  const outcome first = auglag_newton(s);
  if (first == CONVERGED || first == STOPPED_NAN || s->failed != OK ||
      s->control->no_restart || s->steps >= s->limit)
    return first;
  for (int i = 0; i < s->cp->m; ++i)
    if (s->w->part[i] != NO_FORCE) s->u[i] = s->w->origin[i];
  const outcome second = auglag_newton(s);
  return second == CONVERGED ? second : first;
}

/* ---- VARIANT=UZAWA: displacement and multiplier in turn ------------------ */

static const double RHO_UZAWA = 0x1p4; /* -, of diag A */
static const double START_TOL = 1e-3;  /* -, of pressures for a first limit */
static const double FLATTER = 0.5;     /* -, slope that ends a search */

enum {
  INNER_STEPS = 60, /* Newton steps of one multiplier step */
  PATIENCE = 20     /* multiplier steps without a lower residual */
};

/* Cholesky factor of power (A + F' rho); springs where the body is free. */
static int uzawa_factor(auglag_run *s) {
  const contact_problem *cp = s->cp;
  auglag_work *w = s->w;
  size_t m = cp->m;
  for (int attempt = 0; attempt < 2; ++attempt) {
    COPY(w->K, cp->A, m * m);
    for (int dof = 0; dof < cp->m; ++dof) {
      double *column = w->K + m * dof;
      if (auglag_is_fixed(s, dof)) column[dof] += auglag_rho(s, dof);
      if (attempt > 0) column[dof] += SPRING * w->diagonal[dof];
      int end = (dof / cp->dim + 1) * cp->dim;
      for (int b = dof; auglag_slips(s, dof) && b < end; ++b)
        column[b] += auglag_rho(s, dof) * auglag_turning(s, dof, b);
    }
    for (size_t i = 0; i < m * m; ++i) w->K[i] *= w->power;
    s->singular = attempt;
    if (LAPACKE_dpotrf_work(LAPACK_COL_MAJOR, 'L', cp->m, w->K, cp->m) == 0) {
      s->factored = 1;
      return 1;
    }
  }
  return 0;
}

/* du and dy of the factor. */
static int uzawa_dense(auglag_run *s) {
  const contact_problem *cp = s->cp;
  auglag_work *w = s->w;
  if (!s->factored && !uzawa_factor(s)) return 0;
  for (int i = 0; i < cp->m; ++i) w->du[i] = w->power * (w->F[i] - w->y[i]);
  LAPACKE_dpotrs_work(LAPACK_COL_MAJOR, 'L', cp->m, 1, w->K, cp->m, w->du,
                      cp->m);
  contact_product(cp->m, cp->A, w->du, w->dy);
  return 1;
}

/* The same of an operator: no row known. */
static int uzawa_operated(auglag_run *s) {
  const contact_problem *cp = s->cp;
  auglag_work *w = s->w;
  for (int i = 0; i < cp->n; ++i) {
    w->by.guess.mode[i] = FREE;
    if (w->mode[i] == SLIP) put_slip(s, i, w->share[i]);
  }
  for (int dof = 0; dof < cp->m; ++dof) {
    const double left = w->F[dof] - w->y[dof];
    w->by.guess.closed[dof] = 0;
    w->by.guess.place[dof] = dof;
    w->by.hold[dof] = auglag_is_fixed(s, dof) ? auglag_rho(s, dof) : 0.0;
    w->by.b[dof] = left;
    w->du[dof] = contact_held(cp, dof) ? left / contact_diagonal(cp, dof) : 0.0;
  }
  return operated_direction(s, w->by.hold);
}

/* Slope of the augmented Lagrangian along du at the present u, N m. */
static double slope(auglag_run *s) {
  double sum = 0.0;
  auglag_evaluate(s, s->w->lambda);
  for (int i = 0; i < s->cp->m; ++i)
    sum += s->w->du[i] * (s->w->y[i] - s->w->F[i]);
  return sum;
}

/* Move along du to where the slope is small: the whole step, or less. */
static void search(auglag_run *s) {
  double low = 0.0, high = 1.0, at = 1.0, first = slope(s);
  auglag_move(s, 1.0);
  double now = slope(s), low_slope = first, high_slope = now;
  for (int k = 0; k < SHORTENINGS && now > FLATTER * fabs(first); ++k) {
    double next = low + (high - low) * low_slope / (low_slope - high_slope);
    next = fmax(next, low + 0.1 * (high - low));
    next = fmin(next, high - 0.1 * (high - low));
    auglag_move(s, next - at);
    at = next;
    now = slope(s);
    if (now > 0.0) {
      high = at;
      high_slope = now;
    } else {
      low = at;
      low_slope = now;
      if (now >= -FLATTER * fabs(first)) break;
    }
  }
}

/* |lambda - F| and |A u - f - F|, the largest, N. */
static void defects(const auglag_run *s, double *multiplier, double *balance) {
  const auglag_work *w = s->w;
  *multiplier = *balance = 0.0;
  for (int i = 0; i < s->cp->m; ++i) {
    *multiplier = fmax(*multiplier, fabs(w->lambda[i] - w->F[i]));
    *balance = fmax(*balance, fabs(w->y[i] - w->F[i]));
  }
}

/* Minimise over u. */
static outcome minimise(auglag_run *s) {
  const contact_problem *cp = s->cp;
  auglag_work *w = s->w;
  double multiplier, balance;
  auglag_evaluate(s, w->lambda);
  for (int k = 0;; ++k) {
    s->turned = auglag_turned(s, 1);
    double residual = auglag_check(s);
    if (isnan(residual)) return STOPPED_NAN;
    if (residual <= s->control->tol) return CONVERGED;
    if (s->steps >= s->limit) return STOPPED_ITERATIONS;
    defects(s, &multiplier, &balance);
    if (k > 0 && (balance <= 0.01 * multiplier ||
                  balance <= 0.1 * s->control->tol * s->scale))
      return RUNNING;
    if (k >= INNER_STEPS) return s->singular ? STOPPED_RAY : RUNNING;
    ++s->steps;
    if (!(cp->op != NULL ? uzawa_operated(s) : uzawa_dense(s)))
      return STOPPED_SINGULAR;
    search(s);
    contact_reaction(cp, s->u, w->y);
    auglag_evaluate(s, w->lambda);
  }
}

/* The same from u and r, for a limit that does not follow the pressure. */
static outcome auglag_uzawa(auglag_run *s) {
  auglag_work *w = s->w;
  double mark = HUGE_VAL;
  int since = 0;
  outcome o;
  s->rho = RHO_UZAWA;
  s->cycle = 0;
  s->factored = 0;
  COPY(w->lambda, s->r, s->cp->m);
  contact_reaction(s->cp, s->u, w->y);
  while ((o = minimise(s)) == RUNNING) {
    COPY(w->lambda, w->F, s->cp->m);
    ++since;
    if (solver_progresses(&mark, w->best.residual)) since = 0;
    if (since > PATIENCE) return s->singular ? STOPPED_RAY : STOPPED_STAGNATION;
  }
  return o;
}

/* u and r of the problem without slip: pressures for the first limit. */
static void auglag_start_bonded(auglag_run *s) {
  const contact_problem *cp = s->cp;
  contact_problem bonded = *cp;
  for (int i = 0; i < cp->n; ++i) {
    if (contact_node_limit(cp, s->r, i) > 0.0) return;
    s->w->bonded[i] = HUGE_VAL;
  }
  bonded.B = NULL;
  bonded.g0 = s->w->bonded;
  auglag_run start = *s;
  solver_control coarse = *s->control;
  coarse.tol = fmax(coarse.tol, START_TOL);
  start.cp = &bonded;
  start.control = &coarse;
  s->w->best.residual = HUGE_VAL;
  auglag_uzawa(&start);
  s->steps = start.steps;
  s->failed = start.failed;
  solver_take_best(&s->w->best, cp->m, s->u, s->r);
}

typedef struct auglag {
  int variant; /* variant_kind */
} auglag;

typedef enum { BY_NEWTON, BY_UZAWA } variant_kind;

OPTIONS(
    auglag_options,
    OPTION_CHOICE(auglag, variant, "VARIANT", "NEWTON|UZAWA", "NEWTON",
                  "both equations at once, or multiplier after displacement"));

static const double SOFT = 0x1p-20; /* -, of the stiffness: none */

enum { UZAWA_STEPS = 1000 /* Newton steps of all multiplier steps */ };

/* Of A, also where a rigid motion makes it zero. */
static void take_diagonal(const contact_problem *cp, double *diagonal) {
  size_t m = cp->m;
  int d = cp->dim;
  double largest = 0.0;
  for (size_t i = 0; i < m; ++i) {
    diagonal[i] = contact_diagonal(cp, (int)i);
    largest = fmax(largest, diagonal[i]);
  }
  for (int i = 0; i < cp->n; ++i) {
    double mean = 0.0, *own = diagonal + i * d;
    for (int k = 1; k < d; ++k) mean += own[k] / (d - 1);
    for (int k = 1; k < d; ++k) own[k] = mean;
    double least = SOFT * fmax(fmax(own[0], mean), SOFT * largest);
    for (int k = 0; k < d; ++k) own[k] = fmax(own[k], least);
  }
}

/* Workspace of the matrix of a step. */
static status new_matrix(const contact_problem *cp, auglag_work *w) {
  const size_t m = cp->m;
  if (cp->op != NULL) {
    PASS(operated_system_new(cp, &w->by.system));
    PASS(pattern_new(cp->dim, cp->n, &w->by.guess));
    PASS_NEW_ALL(OF(w->by.hold, m), OF(w->by.b, m));
    return OK;
  }
  PASS_NEW_ALL(OF(w->K, m * m), OF(w->pivot, m), OF(w->free_id, m));
  return OK;
}

static status auglag_setup(const contact_problem *cp, const void *par,
                           void *work) {
  auglag_work *w = work;
  size_t m = cp->m;
  w->m = cp->m;
  PASS_NEW_REALS(m, &w->origin, &w->diagonal, &w->lambda, &w->z, &w->F, &w->y,
                 &w->du, &w->dy, &w->e);
  PASS_NEW_ALL(OF(w->part, m), OF(w->closed, m), OF(w->mode, cp->n),
               OF(w->state, m), OF(w->share, cp->n), OF(w->bonded, cp->n));
  PASS(new_matrix(cp, w));
  PASS(fixed_point_new(cp->n, &w->fixed));
  PASS(best_iterate_new(cp->m, &w->best));
  take_diagonal(cp, w->diagonal);
  w->power = power_to_one(largest_entry(m, w->diagonal));
  return OK;
}

/* The other variant, the limit updated around it. */
static status follow_limit(auglag_run *s, solver_report *rep) {
  static const auglag uzawa = {BY_UZAWA};
  inner_solver self = {&auglag_solver, &uzawa, s->w};
  solver_control rest = *s->control;
  int bounded = s->control->max_iter > 0;
  if (!bounded || s->steps < s->limit) auglag_start_bonded(s);
  PASS(s->failed);
  rest.max_iter = bounded ? s->limit - s->steps : 0;
  int before = s->steps;
  rep->outcome = STOPPED_ITERATIONS;
  rep->iterations = before;
  if (bounded && rest.max_iter == 0) return OK;
  PASS(fixed_point_solve(s->w->fixed, s->cp, &self, &rest, s->u, s->r, rep));
  rep->iterations += before;
  return OK;
}

/* 1: the other variant ended without progress: the cycle of the first one is
 * the better reason. */
static int made_no_progress(const solver_control *control,
                            const solver_report *rep) {
  int bounded = control->max_iter > 0 && rep->iterations >= control->max_iter;
  return rep->outcome == STOPPED_STAGNATION ||
         (rep->outcome == STOPPED_ITERATIONS && !bounded);
}

static status auglag_solve(const contact_problem *cp, const void *par,
                           void *work, const solver_control *control, double *u,
                           double *r, solver_report *rep) {
  const auglag *p = par;
  auglag_work *w = work;
  auglag_run s = {
      .cp = cp,
      .w = w,
      .control = control,
      .u = u,
      .r = r,
      .scale = contact_scale(cp),
      .limit = control->max_iter > 0 ? control->max_iter : UZAWA_STEPS};
  *rep = (solver_report){.outcome = RUNNING};
  w->best.residual = HUGE_VAL;
  force_parts(cp, w->part, w->origin);
  if (w->by.system != NULL) operated_system_fit(w->by.system);
  if (p->variant == BY_NEWTON) rep->outcome = newton_attempts(&s);
  int done_well = rep->outcome == CONVERGED || rep->outcome == STOPPED_NAN;
  int cycled = rep->outcome == STOPPED_CYCLE;
  PASS(s.failed);
  if (!done_well && cp->B == NULL) rep->outcome = auglag_uzawa(&s);
  rep->iterations = s.steps;
  rep->residual = solver_take_best(&w->best, cp->m, u, r);
  PASS(s.failed);
  if (!done_well && cp->B != NULL) PASS(follow_limit(&s, rep));
  if (cycled && made_no_progress(control, rep)) rep->outcome = STOPPED_CYCLE;
  return OK;
}

/* Changes of state are counted against the step before. */
static status auglag_keep(void *work, archive *a) {
  auglag_work *w = work;
  return archive_bytes(a, "state", w->state, w->m);
}

const solver_ops auglag_solver = {SOLVER_OF(auglag), .family = "multipliers",
                                  .handles = SOLVES_TRESCA | SOLVES_COULOMB |
                                             SOLVES_3D | NEEDS_STIFFNESS |
                                             SOLVES_FLOATING,
                                  .keep = auglag_keep};
