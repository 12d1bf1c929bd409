/*
 * Relaxation with projection, node after node (CPR98, 2.3 and 3.3): each visit
 * solves the contact problem of one node exactly (local.h) with the others
 * held, and moves on by the factor omega.
 *
 * Stiffness form: the unknown is u, r = A u - f is carried along with the
 * columns of A. Compliance form (A not known): the unknown is r, and
 * u = W r + q is carried along with the columns of W. Both see the same
 * problem of a node,  K x = b + r,  K = A_ii or inv(W_ii),  b = K x - r.
 */
#include "base/memory.h"
#include "solver/fixed_point.h"
#include "solver/local.h"
#include "solver/solver.h"

#include <cblas.h>
#include <math.h>
#include <string.h>

typedef struct sor {
  double omega; /* relaxation factor, -; 0: chosen by the program            */
  int sweep;    /* sweep_order                                             */
  int friction; /* friction_way                                            */
} sor;

typedef enum { SWEEP_FORWARD, SWEEP_BACKWARD, SWEEP_SYMMETRIC } sweep_order;
typedef enum { FRICTION_DIRECT, FRICTION_FIXED_POINT } friction_way;

/* clang-format off */
static const option sor_options[] = {
  OPTION_REAL(sor, omega, "OMEGA", 0, 1.999, "0", "-",
              "relaxation factor; 0: chosen by the program"),
  OPTION_CHOICE(sor, sweep, "SWEEP", "FORWARD|BACKWARD|SYMMETRIC", "FORWARD",
                "order in which the nodes are visited"),
  OPTION_CHOICE(sor, friction, "FRICTION", "DIRECT|FIXED_POINT", "DIRECT",
                "sliding limit updated in the sweep, or around Tresca passes"),
  OPTION_END
};
/* clang-format on */

enum {
  SWEEPS = 20000, /* default limit                                         */
  CHECK = 10,     /* sweeps from one check of the residual to the next     */
  PATIENCE = 30   /* checks without a lower residual before a cure         */
};
static const double PROGRESS = 0.9; /* a lower residual is lower by this      */

typedef struct sor_work {
  int m, n;
  double *K;               /* [dim*dim*n] stiffness of each node, N/m         */
  local_state *state;      /* [n] state found at the last visit              */
  double *best_u, *best_r; /* [m] lowest residual so far                     */
  fixed_point *fixed;      /* for FRICTION_FIXED_POINT                        */
} sor_work;

static void sor_release(void *work) {
  sor_work *w = work;
  if (w == NULL) return;
  memory_free(w->K);
  memory_free(w->state);
  memory_free(w->best_u);
  memory_free(w->best_r);
  fixed_point_free(w->fixed);
  memory_free(w);
}

/* Inverse of a d*d block by elimination with complete symmetric pivoting left
 * out: the block is positive definite, else a share of "lift" is added to its
 * diagonal (the iteration then keeps its fixed point). */
static void invert_block(int d, const double *block, double lift, double *K) {
  double M[9];
  memcpy(M, block, (size_t)(d * d) * sizeof *M);
  for (int k = 0; k < d; ++k)
    if (!(M[k + d * k] > 0x1p-30 * lift)) M[k + d * k] += 0x1p-20 * lift;
  for (int k = 0; k < d; ++k) {
    double pivot = M[k + d * k];
    if (!(pivot > 0x1p-40 * lift)) pivot = 0x1p-20 * lift;
    M[k + d * k] = 1.0;
    for (int j = 0; j < d; ++j) M[k + d * j] /= pivot;
    for (int i = 0; i < d; ++i) {
      if (i == k) continue;
      double l = M[i + d * k];
      M[i + d * k] = 0.0;
      for (int j = 0; j < d; ++j) M[i + d * j] -= l * M[k + d * j];
    }
  }
  for (int i = 0; i < d; ++i)
    for (int j = 0; j < d; ++j)
      K[i + d * j] = 0.5 * (M[i + d * j] + M[j + d * i]);
}

static status sor_setup(const contact_problem *cp, const void *par,
                        void **work) {
  status st = OK;
  sor_work *w = NULL;
  const sor *p = par;
  const double *M = cp->A != NULL ? cp->A : cp->W;
  int d = cp->dim;
  NEW(w, 1);
  w->m = cp->m;
  w->n = cp->n;
  NEW(w->K, cp->n * d * d);
  NEW(w->state, cp->n);
  NEW(w->best_u, cp->m);
  NEW(w->best_r, cp->m);
  if (p->friction == FRICTION_FIXED_POINT)
    TRY(fixed_point_new(cp->n, &w->fixed));
  double lift = 0.0;
  for (size_t i = 0; i < (size_t)cp->m; ++i)
    lift = fmax(lift, M[i * (size_t)cp->m + i]);
  for (int node_id = 0; node_id < cp->n; ++node_id) {
    double block[9], *K = w->K + node_id * d * d;
    size_t first = (size_t)(node_id * d);
    for (int j = 0; j < d; ++j)
      for (int i = 0; i < d; ++i)
        block[i + d * j] =
            M[first + (size_t)i + (first + (size_t)j) * (size_t)cp->m];
    if (cp->A != NULL)
      memcpy(K, block, (size_t)(d * d) * sizeof *K);
    else
      invert_block(d, block, lift, K);
  }
  *work = w;
  w = NULL;
done:
  sor_release(w);
  return st;
}

/* ---- one visit ------------------------------------------------------------
 */

/* A run: the problem, the iterate, the factor. */
typedef struct run {
  const contact_problem *cp;
  sor_work *w;
  double *u, *r, omega;
  double change; /* sum of K (du)^2 of the sweep, N m                        */
} run;

static int held(const contact_problem *cp, int dof) {
  return cp->held != NULL && cp->held[dof];
}

/* Where x = 0 of a node is: gap and stick position, m. */
static double origin(const contact_problem *cp, int node_id, int k) {
  if (k == 0) return cp->gap[node_id];
  return cp->ut0 == NULL ? 0.0 : cp->ut0[node_id * (cp->dim - 1) + k - 1];
}

/* The problem of a node: unknowns not held, listed in id[]; x[] now. */
static void local_of(const run *s, int node_id, local_problem *lp, int *id,
                     double *x) {
  const contact_problem *cp = s->cp;
  const double *K = s->w->K + node_id * cp->dim * cp->dim;
  int first = node_id * cp->dim;
  lp->dim = lp->bounded = 0;
  for (int k = 0; k < cp->dim; ++k) {
    if (held(cp, first + k)) continue;
    double bound = HUGE_VAL;
    if (k > 0 && cp->side_gap != NULL)
      bound = cp->side_gap[node_id * (cp->dim - 1) + k - 1];
    id[lp->dim] = k;
    x[lp->dim] = s->u[first + k] - origin(cp, node_id, k);
    lp->bound[lp->dim] = k == 0 ? 0.0 : bound - origin(cp, node_id, k);
    if (bound < HUGE_VAL) lp->bounded = 1;
    ++lp->dim;
  }
  for (int i = 0; i < lp->dim; ++i) {
    lp->b[i] = -s->r[first + id[i]];
    for (int j = 0; j < lp->dim; ++j) {
      lp->K[i + lp->dim * j] = K[id[i] + cp->dim * id[j]];
      lp->b[i] += lp->K[i + lp->dim * j] * x[j];
    }
  }
  lp->g0 = cp->g0 == NULL ? 0.0 : cp->g0[node_id];
  lp->mu = 0.0;
  if (cp->B == NULL) return;
  for (int k = cp->B->start[node_id]; k < cp->B->start[node_id + 1]; ++k) {
    int j = cp->B->col[k];
    double p = -s->r[(size_t)j * (size_t)cp->dim];
    if (j == node_id)
      lp->mu = cp->B->val[k];
    else if (p > 0.0)
      lp->g0 += cp->B->val[k] * p;
  }
}

/* Go on past the solution x of the node by omega - 1 times the way from old,
 * if the state stayed and the kink of friction is not crossed. */
static void relax(const run *s, const local_problem *lp, local_state now,
                  const double *old, double *x) {
  double further[3], dot = 0.0, more = s->omega - 1.0;
  int first = now == LOCAL_OPEN ? 0 : 1;
  if (lp->bounded || now == LOCAL_STICK) return;
  for (int k = 1; k < lp->dim; ++k) {
    further[k] = x[k] + more * (x[k] - old[k]);
    dot += further[k] * x[k];
  }
  if (first == 0) x[0] = fmin(0.0, x[0] + more * (x[0] - old[0]));
  if ((lp->g0 != 0.0 || lp->mu != 0.0) && !(dot > 0.0) &&
      !(now == LOCAL_OPEN && lp->g0 == 0.0))
    return;
  for (int k = 1; k < lp->dim; ++k) x[k] = further[k];
}

/* The same for the forces, back onto their cone. */
static void relax_forces(const run *s, const local_problem *lp,
                         const double *old, double *r) {
  double size = 0.0, more = s->omega - 1.0;
  if (lp->bounded) return;
  r[0] = fmin(0.0, r[0] + more * (r[0] - old[0]));
  double g = fmax(0.0, lp->g0 - lp->mu * r[0]);
  for (int k = 1; k < lp->dim; ++k) {
    r[k] += more * (r[k] - old[k]);
    size += r[k] * r[k];
  }
  size = sqrt(size);
  for (int k = 1; k < lp->dim && size > g; ++k) r[k] *= g / size;
}

static void visit(run *s, int node_id) {
  const contact_problem *cp = s->cp;
  const double *M = cp->A != NULL ? cp->A : cp->W;
  local_problem lp;
  int id[3] = {0, 0, 0}, moved = 0;
  size_t first = (size_t)(node_id * cp->dim), m = (size_t)cp->m;
  double old[3], x[3], r[3], step[3] = {0.0, 0.0, 0.0};
  local_of(s, node_id, &lp, id, old);
  local_state before = s->w->state[node_id];
  local_state now = local_solve(&lp, before, x, r);
  s->w->state[node_id] = now;
  if (cp->A != NULL && now == before) relax(s, &lp, now, old, x);
  if (cp->A == NULL) {
    double force[3] = {0.0, 0.0, 0.0};
    for (int k = 0; k < lp.dim; ++k) force[k] = s->r[first + (size_t)id[k]];
    if (now == before) relax_forces(s, &lp, force, r);
    for (int k = 0; k < lp.dim; ++k) step[id[k]] = r[k] - force[k];
  } else {
    for (int k = 0; k < lp.dim; ++k) step[id[k]] = x[k] - old[k];
    for (int k = 1; k < cp->dim; ++k)
      if (held(cp, node_id * cp->dim + k))
        step[k] = -s->r[first + (size_t)k] /
                  M[(first + (size_t)k) * m + first + (size_t)k];
  }
  double *unknown = cp->A != NULL ? s->u : s->r;
  for (int k = 0; k < cp->dim; ++k) {
    double weight = M[(first + (size_t)k) * m + first + (size_t)k];
    moved = moved || step[k] != 0.0;
    unknown[first + (size_t)k] += step[k];
    s->change += weight * step[k] * step[k];
  }
  if (moved)
    cblas_dgemv(CblasColMajor, CblasNoTrans, cp->m, cp->dim, 1.0, M + first * m,
                cp->m, step, 1, 1.0, cp->A != NULL ? s->r : s->u, 1);
}

static void sweep(run *s, int backward) {
  s->change = 0.0;
  for (int i = 0; i < s->cp->n; ++i) visit(s, backward ? s->cp->n - 1 - i : i);
}

/* Carry u and r anew: r = A u - f, or u = W r + q. */
static void refresh(const run *s) {
  if (s->cp->A != NULL) {
    contact_reaction(s->cp, s->u, s->r);
    return;
  }
  contact_product(s->cp->m, s->cp->W, s->r, s->u);
  for (int i = 0; i < s->cp->m; ++i) s->u[i] += s->cp->f[i];
}

/* ---- control
 * ---------------------------------------------------------------*/

/* How the sweeps go: factor, order, progress. */
typedef struct course {
  double omega_cap;   /* the program's choice stays below                   */
  double best;        /* lowest residual                                    */
  double mark;        /* residual at the last progress                      */
  double last_change; /* of the check before                                */
  int since;          /* checks since the last progress                     */
  int cures;          /* cures tried                                        */
  int order, chosen;  /* sweep_order; 1: omega by the program               */
} course;

/* Largest factor that friction updated in the sweep was seen to bear. */
static double omega_limit(const contact_problem *cp) {
  double mu = 0.0;
  for (int i = 0; cp->B != NULL && i < cp->n; ++i) {
    double sum = 0.0;
    for (int k = cp->B->start[i]; k < cp->B->start[i + 1]; ++k)
      sum += cp->B->val[k];
    mu = fmax(mu, sum);
  }
  return mu == 0.0 ? 1.95 : mu <= 0.3 ? 1.8 : mu <= 0.6 ? 1.65 : 1.4;
}

/* Factor from the observed rate of convergence (Young's relation between the
 * rates of relaxation and of Jacobi's method). */
static void choose_omega(run *s, course *c) {
  double ratio = c->last_change > 0.0 ? s->change / c->last_change : 0.0;
  c->last_change = s->change;
  if (!c->chosen || !(ratio > 0.0 && ratio < 1.0)) return;
  double rate = pow(ratio, 0.5 / CHECK), omega = s->omega;
  if (rate <= omega - 1.0) return;
  double jacobi =
      (rate + omega - 1.0) * (rate + omega - 1.0) / (rate * omega * omega);
  if (!(jacobi < 1.0)) return;
  double wanted = 2.0 / (1.0 + sqrt(1.0 - jacobi));
  if (wanted > omega) s->omega = fmin(wanted, c->omega_cap);
}

/* No progress for long: less relaxation, then another order, then damping.
 * 0: nothing left. */
static int cure(run *s, course *c) {
  c->since = 0;
  c->mark = HUGE_VAL;
  c->last_change = 0.0;
  ++c->cures;
  if (s->omega > 1.05) {
    s->omega = 1.0 + 0.5 * (s->omega - 1.0);
    c->omega_cap = s->omega;
    return 1;
  }
  c->omega_cap = 1.0;
  c->chosen = 0;
  if (c->order != SWEEP_SYMMETRIC) {
    c->order = SWEEP_SYMMETRIC;
    s->omega = 1.0;
    return 1;
  }
  s->omega *= 0.6;
  return s->omega > 0.2;
}

static void tell(const solver_control *control, int iteration,
                 double residual) {
  const solver_listener *l = control->listener;
  if (l == NULL || l->step == NULL) return;
  solver_step step = {.solver = "sor",
                      .iteration = iteration,
                      .limit_update = control->limit_update,
                      .residual = residual,
                      .limit_change = NAN,
                      .status_changes = -1};
  l->step(l->ctx, &step);
}

/* The residual with u and r carried anew; keeps the best. */
static double check(run *s, course *c, double scale) {
  refresh(s);
  double worst = contact_mismatch(s->cp, s->u, s->r);
  double residual = scale > 0.0 ? worst / scale : worst > 0.0 ? HUGE_VAL : 0.0;
  if (residual < c->best) {
    c->best = residual;
    memcpy(s->w->best_u, s->u, (size_t)s->cp->m * sizeof *s->u);
    memcpy(s->w->best_r, s->r, (size_t)s->cp->m * sizeof *s->r);
  }
  if (residual < PROGRESS * c->mark) {
    c->mark = residual;
    c->since = 0;
  } else {
    ++c->since;
  }
  return residual;
}

static outcome sweeps(run *s, course *c, const solver_control *control,
                      solver_report *rep) {
  int limit = control->max_iter > 0 ? control->max_iter : SWEEPS;
  double scale = contact_scale(s->cp);
  refresh(s);
  for (int k = 1; k <= limit; ++k) {
    rep->iterations = k;
    sweep(s, c->order == SWEEP_BACKWARD ||
                 (c->order == SWEEP_SYMMETRIC && k % 2 == 0));
    if (k % CHECK != 0 && k != limit && (k > 8 || (k & (k - 1)) != 0)) continue;
    double residual = check(s, c, scale);
    tell(control, k, residual);
    if (isnan(residual)) return STOPPED_NAN;
    if (residual <= control->tol) return CONVERGED;
    if (k % CHECK == 0) choose_omega(s, c);
    if (c->since > PATIENCE && !cure(s, c)) return STOPPED_STAGNATION;
  }
  return STOPPED_ITERATIONS;
}

/* State of each node at the start, from u and r. */
static void start_states(const run *s) {
  const contact_problem *cp = s->cp;
  for (int i = 0; i < cp->n; ++i) {
    int first = i * cp->dim;
    double slip = 0.0;
    for (int k = 1; k < cp->dim; ++k)
      slip += fabs(s->u[first + k] - origin(cp, i, k));
    s->w->state[i] = s->u[first] < cp->gap[i] ? LOCAL_OPEN
                     : slip > 0.0             ? LOCAL_SLIP
                                              : LOCAL_STICK;
  }
}

static status sor_solve(const contact_problem *cp, const void *par, void *work,
                        const solver_control *control, double *u, double *r,
                        solver_report *rep) {
  status st = OK;
  const sor *p = par;
  sor_work *w = work;
  if (cp->B != NULL && w->fixed != NULL) {
    TRY(fixed_point_solve(w->fixed, cp, &sor_solver, par, work, control, u, r,
                          rep));
    goto done;
  }
  run s = {cp, w, u, r, p->omega > 0.0 ? p->omega : 1.0, 0.0};
  course c = {.omega_cap = omega_limit(cp),
              .best = HUGE_VAL,
              .mark = HUGE_VAL,
              .order = p->sweep,
              .chosen = !(p->omega > 0.0)};
  *rep = (solver_report){.outcome = RUNNING};
  start_states(&s);
  rep->outcome = sweeps(&s, &c, control, rep);
  rep->residual = c.best;
  if (c.best < HUGE_VAL) {
    memcpy(u, w->best_u, (size_t)cp->m * sizeof *u);
    memcpy(r, w->best_r, (size_t)cp->m * sizeof *r);
  }
done:
  return st;
}

/* clang-format off */
const solver_ops sor_solver = {
  .name = "sor",
  .reference = "CPR98, 2.3 and 3.3; Jourdan, Alart, Jean 1998",
  .help =
    "Projected successive over-relaxation. The nodes are visited one after\n"
    "the other; each visit solves the contact problem of the node exactly\n"
    "with all others held (closed form in 2-D, the true friction disc in 3-D)\n"
    "and goes on by the factor OMEGA. With FRICTION=DIRECT the sliding limit\n"
    "follows the pressure within the sweep; with FRICTION=FIXED_POINT Tresca\n"
    "problems are solved and the limit is updated around them (CPR98, 2.3),\n"
    "which contracts for small friction only. Without OMEGA the program\n"
    "chooses it from the observed rate and takes it back when the residual\n"
    "stops falling: with friction in the sweep large factors do not converge.\n"
    "If a sweep order cycles, the order is changed, then the steps damped.\n"
    "Costs one product with the matrix a sweep, and many sweeps: choose it\n"
    "when the direct methods fail, when the compliance alone is known or is\n"
    "singular, or for a few digits of a large problem.",
  .handles = SOLVES_TRESCA | SOLVES_COULOMB | SOLVES_3D | SOLVES_FLOATING,
  .param_size = sizeof(sor),
  .options = sor_options,
  .setup = sor_setup,
  .solve = sor_solve,
  .release = sor_release
};
/* clang-format on */
