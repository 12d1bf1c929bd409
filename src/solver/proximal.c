/*
 * Proximal point iteration on the forces of contact, for a compliance that may
 * be semidefinite or unsymmetric (Rockafellar 1976; Alart, Curnier 1991). With
 * x = W r + q - o the displacement from the gap or stick position, D the
 * inverse diagonal of W, c the centre of the pass and a its share,
 *
 *   z = r - s (D x + a (r - c)),
 *   F_n = r_n - min(z_n, 0),      F_t = r_t - P_g(z_t),   g = g0 + B p,
 *
 * P_g the projection on the disc |.| <= g. A pass finds r with F = 0 roughly,
 * by Newton's method with the exact derivative; r is the next centre. At r = c
 * F does not depend on a, and F = 0 is the contact problem. The share makes up
 * for what W lacks where forces are not unique or its unsymmetric part turns
 * them; it falls as long as passes are easy and rises where they are not. A
 * step may raise |F| above its last value but not above the largest of the last
 * ones. The stretch s > 0 changes none of the solutions, but the way to them.
 */
#include "base/memory.h"
#include "solver/local.h"
#include "solver/solver.h"

#include <cblas.h>
#include <lapacke.h>
#include <math.h>
#include <string.h>

static const option proximal_options[] = {OPTION_END};

enum {
  STEPS = 5600,   /* Newton steps, all trials                                */
  TRIAL = 1400,   /* of a trial                                              */
  TRIALS = 4,     /* one after the other                                     */
  PASS = 40,      /* of a pass                                               */
  EASY = 5,       /* a pass with so few: the share falls                     */
  HARD = 15,      /*           with more: it rises                           */
  PATIENCE = 100, /* passes without a lower residual                         */
  MEMORY = 8,     /* last values a step is compared with                     */
  HALVINGS = 10   /* of a step                                               */
};
static const double PASS_GAIN = 0x1p-7;    /* |F|^2 a pass shall leave, -     */
static const double SLOPE = 0x1p-12;       /* of the descent asked for, -     */
static const double LEAST_SHARE = 0x1p-40; /* -                               */
static const double MOST_SHARE = 0x1p10;

/* How the trials go: stretch s, share a at the start. The last starts with all
 * gaps closed (start_closed; its stretch is 1). */
static const struct {
  double stretch, share;
} way[TRIALS] = {{1.0, 0x1p-7}, {4.0, 0x1p-7}, {4.0, 0x1p-10}, {1.0, 0x1p-20}};

typedef struct proximal_work {
  force_set *set;
  best_iterate best;
  double *J;             /* [m*m]                                             */
  double *x, *F, *d, *z; /* [m]                                               */
  double *start, *centre; /* [m] force at the start; of the pass              */
  int *pivot; /* [m]                                               */
} proximal_work;

static void proximal_release(void *work) {
  proximal_work *w = work;
  if (w == NULL) return;
  force_set_free(w->set);
  best_iterate_free(&w->best);
  void *const blocks[] = {w->J, w->x,     w->F,      w->d,
                          w->z, w->start, w->centre, w->pivot};
  for (size_t k = 0; k < sizeof blocks / sizeof *blocks; ++k)
    memory_free(blocks[k]);
  memory_free(w);
}

static status proximal_setup(const contact_problem *cp, const void *par,
                             void **work) {
  status st = OK;
  proximal_work *w = NULL;
  size_t m = (size_t)cp->m;
  (void)par;
  NEW(w, 1);
  TRY(force_set_new(cp, &w->set));
  TRY(best_iterate_new(cp->m, &w->best));
  NEW(w->J, m * m);
  NEW(w->x, m);
  NEW(w->F, m);
  NEW(w->d, m);
  NEW(w->z, m);
  NEW(w->start, m);
  NEW(w->centre, m);
  NEW(w->pivot, m);
  *work = w;
  w = NULL;
done:
  proximal_release(w);
  return st;
}

typedef struct run {
  const contact_problem *cp;
  proximal_work *w;
  const solver_control *control;
  double *u, *r;
  double scale;          /* contact_scale                                     */
  double stretch, share; /* s and a                                           */
  int steps;
} run;

/* ---- the equations --------------------------------------------------------
 */

/* Length of z in the tangents of a node where friction acts; their number. */
static double tangent_length(const run *s, int node_id, int *count) {
  double sum = 0.0;
  *count = 0;
  for (int k = 1; k < s->cp->dim; ++k) {
    int dof = node_id * s->cp->dim + k;
    if (s->w->set->part[dof] != IN_DISC) continue;
    sum += s->w->z[dof] * s->w->z[dof];
    ++*count;
  }
  return sqrt(sum);
}

/* F at r; returns its size in the metric of inv(D), squared. */
static double evaluate(run *s) {
  const contact_problem *cp = s->cp;
  proximal_work *w = s->w;
  const force_set *set = w->set;
  double sum = 0.0;
  int count;
  force_set_displacement(set, s->r, s->u);
  for (int i = 0; i < cp->m; ++i) {
    w->x[i] = s->u[i] - set->origin[i];
    w->z[i] = s->r[i] - s->stretch * (set->D[i] * w->x[i] +
                                      s->share * (s->r[i] - w->centre[i]));
    w->F[i] = s->r[i] - (set->part[i] == PUSH ? fmin(w->z[i], 0.0) : 0.0);
  }
  for (int i = 0; i < cp->n; ++i) {
    double length = tangent_length(s, i, &count);
    if (count == 0) continue;
    double g = contact_node_limit(cp, s->r, i);
    double share = length <= g ? 1.0 : g / length;
    for (int k = 1; k < cp->dim; ++k) {
      int dof = i * cp->dim + k;
      if (set->part[dof] == IN_DISC) w->F[dof] = s->r[dof] - share * w->z[dof];
    }
  }
  for (int i = 0; i < cp->m; ++i) sum += w->F[i] * w->F[i] / set->D[i];
  return sum;
}

/* Row i of J: the unit row less "share" times that of z_j. */
static void add_row(const run *s, int i, int j, double share) {
  const force_set *set = s->w->set;
  int m = s->cp->m;
  cblas_daxpy(m, share * s->stretch * set->D[j], s->cp->W + j, m, s->w->J + i,
              m);
  s->w->J[(size_t)i + (size_t)m * (size_t)j] -=
      share * (1.0 - s->stretch * s->share);
}

/* The rows of the tangents of a node that slips: g e turns with z and grows
 * with the pressures. */
static void add_slip(const run *s, int node_id, double length) {
  const contact_problem *cp = s->cp;
  const proximal_work *w = s->w;
  double g = contact_node_limit(cp, s->r, node_id);
  int first = node_id * cp->dim;
  for (int a = 1; a < cp->dim; ++a) {
    if (w->set->part[first + a] != IN_DISC) continue;
    double e_a = w->z[first + a] / length;
    for (int b = 1; b < cp->dim; ++b) {
      if (w->set->part[first + b] != IN_DISC) continue;
      double e_b = w->z[first + b] / length;
      add_row(s, first + a, first + b,
              g / length * ((a == b ? 1.0 : 0.0) - e_a * e_b));
    }
    for (int k = cp->B == NULL ? 0 : cp->B->start[node_id];
         cp->B != NULL && k < cp->B->start[node_id + 1]; ++k) {
      size_t normal = (size_t)cp->B->col[k] * (size_t)cp->dim;
      if (s->r[normal] < 0.0 || w->z[normal] < 0.0)
        w->J[(size_t)(first + a) + (size_t)cp->m * normal] +=
            cp->B->val[k] * e_a;
    }
  }
}

static void fill_matrix(const run *s) {
  const contact_problem *cp = s->cp;
  const proximal_work *w = s->w;
  size_t m = (size_t)cp->m;
  int count;
  memset(w->J, 0, m * m * sizeof *w->J);
  for (int i = 0; i < cp->m; ++i) {
    w->J[(size_t)i * (m + 1)] = 1.0;
    if (w->set->part[i] == PUSH && w->z[i] < 0.0) add_row(s, i, i, 1.0);
  }
  for (int i = 0; i < cp->n; ++i) {
    double length = tangent_length(s, i, &count);
    int sticks = length <= contact_node_limit(cp, s->r, i);
    if (count > 0 && !sticks) add_slip(s, i, length);
    for (int k = 1; k < cp->dim && sticks; ++k)
      if (w->set->part[i * cp->dim + k] == IN_DISC)
        add_row(s, i * cp->dim + k, i * cp->dim + k, 1.0);
  }
}

/* ---- steps ----------------------------------------------------------------
 */

/* Along d, shortened while |F|^2 is above "bound"; the last try stays. */
static double search(run *s, double bound) {
  double t = 1.0, taken = 0.0, value = HUGE_VAL;
  for (int k = 0; k < HALVINGS; ++k, t *= 0.5) {
    cblas_daxpy(s->cp->m, t - taken, s->w->d, 1, s->r, 1);
    taken = t;
    value = evaluate(s);
    if (value <= bound * (1.0 - SLOPE * t)) break;
  }
  return value;
}

/* One step of Newton's method; NAN if there is none. */
static double newton_step(run *s, double bound) {
  proximal_work *w = s->w;
  int m = s->cp->m;
  fill_matrix(s);
  for (int i = 0; i < m; ++i) w->d[i] = -w->F[i];
  ++s->steps;
  if (LAPACKE_dgesv_work(LAPACK_COL_MAJOR, m, 1, w->J, m, w->pivot, w->d, m) !=
      0)
    return NAN;
  return search(s, bound);
}

/* From the centre, where |F|^2 = value, until PASS_GAIN of it is left. Returns
 * the steps; more than PASS: not found. */
static int pass(run *s, double value) {
  double last[MEMORY], wanted = PASS_GAIN * value;
  for (int k = 0; k < MEMORY; ++k) last[k] = value;
  for (int k = 0; k < PASS; ++k) {
    double bound = 0.0;
    for (int i = 0; i < MEMORY; ++i) bound = fmax(bound, last[i]);
    value = newton_step(s, bound);
    if (isnan(value)) break;
    if (value <= wanted) return k + 1;
    last[k % MEMORY] = value;
  }
  return PASS + 1;
}

/* The share for the next pass. */
static double next_share(double share, int steps) {
  double factor = 1.0;
  if (steps <= EASY) factor = 0.25;
  if (steps > HARD) factor = 2.0;
  if (steps > PASS) factor = 8.0;
  return fmax(LEAST_SHARE, fmin(MOST_SHARE, factor * share));
}

/* The forces that close every gap and let nothing slip, for limits so large
 * that no step from zero leads there. */
static void start_closed(run *s) {
  proximal_work *w = s->w;
  int m = s->cp->m;
  memset(s->r, 0, (size_t)m * sizeof *s->r);
  memset(w->centre, 0, (size_t)m * sizeof *w->centre);
  memset(w->J, 0, (size_t)m * (size_t)m * sizeof *w->J);
  evaluate(s);
  for (int i = 0; i < m; ++i) {
    w->d[i] = w->set->part[i] == NO_FORCE ? 0.0 : -w->set->D[i] * w->x[i];
    w->J[(size_t)i * (size_t)(m + 1)] = 1.0;
    if (w->set->part[i] != NO_FORCE) add_row(s, i, i, 1.0);
  }
  if (LAPACKE_dgesv_work(LAPACK_COL_MAJOR, m, 1, w->J, m, w->pivot, w->d, m) ==
      0)
    memcpy(s->r, w->d, (size_t)m * sizeof *s->r);
}

/* Passes from the start forces. */
static outcome trial(run *s, int limit, int closed) {
  proximal_work *w = s->w;
  size_t bytes = (size_t)s->cp->m * sizeof *s->r;
  double lowest = HUGE_VAL;
  if (closed)
    start_closed(s);
  else
    memcpy(s->r, w->start, bytes);
  for (int idle = 0; idle < PATIENCE; ++idle) {
    memcpy(w->centre, s->r, bytes);
    double value = evaluate(s);
    double residual = solver_mismatch(s->cp, s->scale, s->u, s->r);
    solver_keep_best(&w->best, s->cp->m, residual, s->u, s->r);
    solver_tell(s->control, "proximal", s->steps, residual);
    if (isnan(residual)) return STOPPED_NAN;
    if (residual <= s->control->tol) return CONVERGED;
    if (residual < 0.9 * lowest) {
      lowest = residual;
      idle = 0;
    }
    if (s->steps >= limit) return STOPPED_ITERATIONS;
    int steps = pass(s, value);
    if (steps > PASS) memcpy(s->r, w->centre, bytes);
    s->share = next_share(s->share, steps);
  }
  return STOPPED_STAGNATION;
}

static status proximal_solve(const contact_problem *cp, const void *par,
                             void *work, const solver_control *control,
                             double *u, double *r, solver_report *rep) {
  proximal_work *w = work;
  run s = {.cp = cp, .w = w, .control = control, .u = u, .r = r};
  int limit = control->max_iter > 0 ? control->max_iter : STEPS;
  (void)par;
  s.scale = contact_scale(cp);
  *rep = (solver_report){.outcome = RUNNING};
  w->best.residual = HUGE_VAL;
  force_set_fit(w->set, cp);
  memcpy(w->start, r, (size_t)cp->m * sizeof *r);
  for (int k = 0; k < TRIALS && rep->outcome != CONVERGED; ++k) {
    if (s.steps >= limit && k > 0) break;
    int until = s.steps + TRIAL;
    s.stretch = way[k].stretch;
    s.share = way[k].share;
    rep->outcome = trial(&s, until < limit ? until : limit, k == TRIALS - 1);
    if (rep->outcome == STOPPED_NAN) break;
  }
  if (rep->outcome == STOPPED_ITERATIONS && s.steps < limit)
    rep->outcome = STOPPED_STAGNATION;
  rep->iterations = s.steps;
  rep->residual = w->best.residual;
  solver_take_best(&w->best, cp->m, u, r);
  return OK;
}

/* clang-format off */
const solver_ops proximal_solver = {
  .name = "proximal",
  .family = "Newton",
  .reference = "Rockafellar 1976; Alart, Curnier 1991",
  .help =
    "Proximal point iteration on the forces of contact, with the compliance:\n"
    "each pass solves the equations of Alart and Curnier, friction with the\n"
    "limit that follows the pressure, for a compliance made regular by a\n"
    "share of its diagonal about the forces of the last pass. The share falls\n"
    "as the passes succeed. Needs no stiffness: the compliance may be\n"
    "semidefinite, with more contacts than bodies can move, and unsymmetric.\n"
    "A step is a dense factorisation, a pass 2 to 20 steps. Choose it for\n"
    "problems from files where the sweeps and PCG stop short of the\n"
    "tolerance; for a body on its contact surface NEWTON is faster.",
  .handles = SOLVES_TRESCA | SOLVES_COULOMB | SOLVES_3D | NEEDS_COMPLIANCE,
  .param_size = 0,
  .options = proximal_options,
  .setup = proximal_setup,
  .solve = proximal_solve,
  .release = proximal_release
};
/* clang-format on */
