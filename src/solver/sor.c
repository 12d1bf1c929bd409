/*
 * Relaxation with projection, node after node (CPR98, 2.3 and 3.3): each visit
 * solves the contact problem of one node exactly (local.h) with the others
 * held, with over-relaxation by the factor omega.
 *
 * Stiffness form: the unknown is u, r = A u - f is carried along with the
 * columns of A. Compliance form (A not known): the unknown is r, and u = W r +
 * q is carried along with the columns of W. Both see the same
 * problem of a node,  K d = b + r,  K = A_ii or inv(W_ii),  b = -r now.
 */
#include "solver/fixed_point.h"
#include "solver/local.h"

typedef struct sor {
  double omega; /* relaxation factor, -; 0: chosen by the program */
  int sweep;    /* sweep_order */
  int friction; /* friction_update */
} sor;

typedef enum { SWEEP_FORWARD, SWEEP_BACKWARD, SWEEP_SYMMETRIC } sweep_order;
typedef enum { FRICTION_DIRECT, FRICTION_FIXED_POINT } friction_update;

OPTIONS(sor_options,
        OPTION_REAL(sor, omega, "OMEGA", 0, 1.999, "0", "-",
                    "relaxation factor; 0: chosen by the program"),
        OPTION_CHOICE(sor, sweep, "SWEEP", "FORWARD|BACKWARD|SYMMETRIC",
                      "FORWARD", "order in which the nodes are visited"),
        OPTION_CHOICE(
            sor, friction, "FRICTION", "DIRECT|FIXED_POINT", "DIRECT",
            "sliding limit updated in the sweep, or around Tresca passes"));

enum {
  SWEEPS = 20000, /* default limit */
  CHECK = 10,     /* sweeps from one check of the residual to the next */
  PATIENCE = 30   /* checks without a lower residual before a remedy */
};

typedef struct sor_work {
  node_blocks *blocks;
  best_iterate best;
  double *before;     /* [m] u before a sweep that is checked; work */
  fixed_point *fixed; /* for FRICTION_FIXED_POINT */
} sor_work;

static status sor_setup(const contact_problem *cp, const void *par,
                        void *work) {
  sor_work *w = work;
  const sor *p = par;
  PASS(node_blocks_new(cp, &w->blocks));
  PASS(best_iterate_new(cp->m, &w->best));
  PASS_NEW(w->before, cp->m);
  if (p->friction == FRICTION_FIXED_POINT)
    PASS(fixed_point_new(cp->n, &w->fixed));
  return OK;
}

/* ---- control ----------------------------------------------------------- */

/* State of the sweeps: factor, order, progress. */
typedef struct course {
  double omega_cap;   /* upper limit of the program's choice */
  best_iterate *kept; /* lowest residual */
  double mark;        /* residual at the last progress */
  double last_change; /* of the check before */
  int since;          /* checks since the last progress */
  int order, chosen;  /* sweep_order; 1: omega by the program */
  state_watch watch;
  int turned, returns; /* since the last check: nodes that changed their state,
                          repeated patterns */
  int circling;        /* checks since the last progress with such patterns */
  double *before;      /* [m] u before a sweep that is checked */
} course;

/* Largest factor that converged with friction updated in the sweep. */
static double omega_limit(const contact_problem *cp) {
  double mu = largest_row_sum(cp->B, cp->n);
  return mu == 0.0 ? 1.95 : mu <= 0.3 ? 1.8 : mu <= 0.6 ? 1.65 : 1.4;
}

/* Factor from the observed rate of convergence (Young's relation between the
 * rates of relaxation and of Jacobi's method). */
static void choose_omega(relaxation *s, course *c) {
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

/* No progress for long: less relaxation, then another order, then damping. 0:
 * no remedy left. */
static int cure(relaxation *s, course *c) {
  c->since = c->circling = 0;
  c->mark = HUGE_VAL;
  c->last_change = 0.0;
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

/* The residual with u and r computed again; stores the best. */
static double check(relaxation *s, course *c, double scale) {
  relaxation_refresh(s);
  double residual = contact_mismatch(s->cp, scale, s->u, s->r, NULL);
  solver_keep_best(c->kept, s->cp->m, residual, s->u, s->r);
  if (solver_progresses(&c->mark, residual)) {
    c->since = c->circling = 0;
  } else {
    ++c->since;
    c->circling += c->returns > 0;
  }
  return residual;
}

/* Every CHECK sweeps, and after 1, 2, 4 and 8. */
static int is_checked(int k) {
  return k % CHECK == 0 || (k <= 8 && (k & (k - 1)) == 0);
}

/* The factor is unchanged during a free motion to the obstacles. */
static void steer(relaxation *s, course *c, int k) {
  int flies = relaxation_fly(s, c->before);
  if (flies > 1) c->since = c->circling = 0;
  if (flies)
    c->last_change = 0.0;
  else if (k % CHECK == 0)
    choose_omega(s, c);
}

static outcome sweeps(relaxation *s, course *c, const solver_control *control,
                      solver_report *rep) {
  int limit = control->max_iter > 0 ? control->max_iter : SWEEPS;
  double scale = contact_scale(s->cp);
  relaxation_refresh(s);
  for (int k = 1; k <= limit; ++k) {
    rep->iterations = k;
    if (is_checked(k)) COPY(c->before, s->u, s->cp->m);
    relaxation_sweep(s, c->order == SWEEP_BACKWARD ||
                            (c->order == SWEEP_SYMMETRIC && k % 2 == 0));
    c->turned += s->turned;
    c->returns += state_watch_returns(&c->watch, s);
    if (!is_checked(k) && k != limit) continue;
    double residual = check(s, c, scale);
    solver_report_states(control, "sor", k, residual, c->turned,
                         c->returns > 0);
    c->turned = c->returns = 0;
    if (isnan(residual)) return STOPPED_NAN;
    if (residual <= control->tol) return CONVERGED;
    if (!solver_promises(control->promise, k, residual, control->tol))
      return STOPPED_ITERATIONS;
    steer(s, c, k);
    if (c->since <= PATIENCE) continue;
    int circles = 2 * c->circling > c->since;
    if (!cure(s, c)) return circles ? STOPPED_CYCLE : STOPPED_STAGNATION;
  }
  return STOPPED_ITERATIONS;
}

static status sor_solve(const contact_problem *cp, const void *par, void *work,
                        const solver_control *control, double *u, double *r,
                        solver_report *rep) {
  const sor *p = par;
  sor_work *w = work;
  if (cp->B != NULL && w->fixed != NULL) {
    inner_solver self = {&sor_solver, par, work};
    PASS(fixed_point_solve(w->fixed, cp, &self, control, u, r, rep));
    return OK;
  }
  relaxation s = {.cp = cp,
                  .blocks = w->blocks,
                  .u = u,
                  .r = r,
                  .omega = p->omega > 0.0 ? p->omega : 1.0};
  w->best.residual = HUGE_VAL;
  course c = {.omega_cap = omega_limit(cp),
              .kept = &w->best,
              .before = w->before,
              .mark = HUGE_VAL,
              .order = p->sweep,
              .chosen = contact_has_stiffness(cp) && !(p->omega > 0.0)};
  *rep = (solver_report){.outcome = RUNNING};
  relaxation_start(&s);
  rep->outcome = sweeps(&s, &c, control, rep);
  relaxation_end(&s, &w->best, w->before, rep);
  return OK;
}

const solver_ops sor_solver = {
    SOLVER_OF(sor), .family = "relaxation",
    .handles = SOLVES_TRESCA | SOLVES_COULOMB | SOLVES_3D | SOLVES_FLOATING |
               SPARSE_COMPLIANCE,
    .entries = "METHOD=SOR, which relaxes row by row,"};
